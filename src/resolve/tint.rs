//! Tints: colours with their coverage, and drifts of colours.

use crate::diagnostic::Place;
use crate::document::TintDocument;
use crate::expression::{Program, Scope};
use crate::instancing::{Drift, Tint};
use crate::style::Colour;

use super::Resolver;

/// Tint with compiled expressions, whose first slot is the level.
pub(super) struct PreparedTint {
    colour: Colour,
    alpha: Program,
    /// Changes of hue, saturation, lightness and opacity.
    drift: [Program; 4],
}

impl<K> Resolver<K> {
    /// Compiles a tint. Reports mistakes in its numbers.
    pub(super) fn tint(&mut self, document: &TintDocument, scope: &Scope) -> PreparedTint {
        let TintDocument {
            hue,
            saturation,
            lightness,
            opacity,
            ..
        } = document;
        let changes = [hue, saturation, lightness, opacity];
        let alpha = match (&document.alpha, document.colour) {
            (Some(alpha), _) => self.program(alpha, scope),
            (None, Some(_)) => Program::constant(1.0),
            (None, None) => Program::constant(0.0),
        };
        let drift = changes.map(|change| match change {
            Some(change) => self.program(change, scope),
            None => Program::constant(0.0),
        });
        PreparedTint {
            colour: document.colour.unwrap_or(Colour::BLACK),
            alpha,
            drift,
        }
    }

    /// Evaluates a tint that may be left out, in the scope of parameters. Reports numbers out of range.
    pub(super) fn constant_tint(
        &mut self,
        document: Option<&TintDocument>,
        place: &Place,
    ) -> Option<Tint> {
        let document = document?;
        let scope = std::mem::take(&mut self.constants);
        let prepared = self.tint(document, &scope);
        self.constants = scope;
        // Unknown numbers have been reported.
        let mut programs = prepared.drift.iter().chain([&prepared.alpha]);
        let is_known = programs.all(|program| program.as_constant().is_some());
        is_known.then(|| self.tint_at(&prepared, &[], place))?
    }

    /// Returns the tint that stands at `place` for the values of the slots. Reports numbers out of range and returns
    /// `None`.
    pub(super) fn tint_at(
        &mut self,
        prepared: &PreparedTint,
        slots: &[f64],
        place: &Place,
    ) -> Option<Tint> {
        let alpha = prepared.alpha.eval(slots);
        if !(0.0..=1.0).contains(&alpha) {
            let message = format!("the alpha of this tint is {alpha}");
            let hint = "it is a number from 0, nothing, to 1, all";
            self.error_with_hint(place, message, hint);
            return None;
        }
        let changes = prepared.drift.each_ref().map(|change| change.eval(slots));
        let [hue, shares @ ..] = changes;
        if !hue.is_finite() {
            let message = format!("the hue of this tint is {hue}");
            self.error_with_hint(place, message, "it is a number of degrees, such as 10");
            return None;
        }
        let named = ["saturation", "lightness", "opacity"].into_iter();
        let mut wrong = named
            .zip(shares)
            .filter(|(_, it)| !(-1.0..=1.0).contains(it));
        if let Some((name, share)) = wrong.next() {
            let message = format!("the {name} of this tint is {share}");
            let hint =
                "it is a number from -1 to 1: the share of the way to 1, or, if negative, to 0";
            self.error_with_hint(place, message, hint);
            return None;
        }
        Some(Tint {
            colour: prepared.colour,
            alpha,
            drift: Drift::of(changes),
        })
    }
}
