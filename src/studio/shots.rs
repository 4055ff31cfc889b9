//! Pictures that a session asks for: whole, moved by a hand, and drafts of them while it moves.

use std::sync::Arc;

use crate::diagnostic::Source;

use super::answer::Refusal;
use super::drawing::{Drawn, Shot};
use super::good::Good;
use super::look::Look;
use super::numbers::Numbers;
use super::session::{Key, Session};
use super::view::{Gesture, View};

/// Quality of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Quality {
    /// As `grow` draws it.
    Full,
    /// While a hand moves: to the pixel, and with no more elements than are drawn at once.
    Draft,
}

/// Number of elements up to which a draft is drawn, which follows the time that drafts take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace(u64);

impl Default for Pace {
    fn default() -> Self {
        Self(Self::MOST)
    }
}

impl Pace {
    const LEAST: u64 = 1_000;
    const MOST: u64 = 400_000;
    /// Seconds of a draft above which the next one is smaller, and below which it may be larger. Between them lies the factor
    /// from one step to the next.
    const SECONDS: [f64; 2] = [0.010, 0.002];

    /// Takes note of a draft.
    fn note(&mut self, elements: u64, seconds: f64) {
        let [slow, quick] = Self::SECONDS;
        if seconds > slow {
            self.0 = (self.0.min(elements) / 2).max(Self::LEAST);
        } else if seconds < quick {
            self.0 = (self.0 * 2).min(Self::MOST);
        }
    }
}

/// Length in pixels below which elements of a draft are not replaced.
const DRAFT_DETAIL: f64 = 1.0;

impl Session {
    /// Applies a gesture to the view.
    pub(super) fn gesture(&mut self, gesture: &Gesture) -> Result<(), Refusal> {
        gesture.check()?;
        let nothing = || Refusal::wrong("there is no picture to move");
        if self.good()?.is_in_space {
            let sight = self.sight.as_ref().ok_or_else(nothing)?;
            return sight.moved(gesture, &mut self.look);
        }
        let turn = self.look.turn();
        let view = match (&self.look.view, self.window) {
            (Some(view), _) => view.clone(),
            (None, Some(window)) => View::of(window, turn),
            (None, None) => return Err(nothing()),
        };
        self.look.view = Some(view.moved(gesture, turn)?);
        Ok(())
    }

    /// Shows a window of the plane whole, in a picture of a size: lower left corner, width, height.
    pub(super) fn show(&mut self, window: [f64; 4], size: [u32; 2]) -> Result<(), Refusal> {
        let [x, y, width, height] = window;
        let is_window = window.iter().all(|it| it.is_finite()) && width > 0.0 && height > 0.0;
        if !is_window || self.good()?.is_in_space {
            return Err(Refusal::wrong(
                "a window of the plane has a corner, a width and a height",
            ));
        }
        let [across, down] = size.map(f64::from);
        let wide = width.max(height * across / down);
        let left = x - (wide - width) / 2.0;
        let whole = { self.look.view.as_ref() }.map(|view| view.whole);
        let whole = whole.or(self.window.map(|[_, _, whole, _]| whole));
        let view = View::of([left, y, wide, height], self.look.turn());
        self.look.view = Some(View {
            whole: whole.unwrap_or(wide),
            ..view
        });
        Ok(())
    }

    /// Returns everything that a picture depends on.
    pub(super) fn shot(
        &self,
        look: &Look,
        size: [u32; 2],
        quality: Quality,
    ) -> Result<Shot, Refusal> {
        let good = self.good()?;
        self.shot_of(good, &good.source, look, size, quality)
    }

    /// Returns everything that the picture of a source depends on.
    pub(super) fn shot_of(
        &self,
        good: &Good,
        source: &Arc<Source>,
        look: &Look,
        size: [u32; 2],
        quality: Quality,
    ) -> Result<Shot, Refusal> {
        look.check()?;
        let view = look.view.clone().filter(|_| !good.is_in_space);
        let mut look = look.clone();
        look.steps = match &view {
            Some(view) if look.follows => self.followed(good, &look, view.factor()),
            _ => look.steps,
        };
        if view.as_ref().is_some_and(|view| !view.is_plain()) {
            look.options.remove("margin");
        }
        if quality == Quality::Draft && !good.is_in_space && !look.is_density() {
            self.lighten(good, &mut look, view.is_some());
        }
        Ok(Shot {
            catalogue: self.catalogue.clone(),
            source: Arc::clone(source),
            rule: self.origin.name.clone(),
            look: look.arguments(good.is_in_space),
            turn: look.turn(),
            view,
            size,
            wholes: Arc::clone(&self.wholes),
        })
    }

    /// Makes a look that of a draft.
    fn lighten(&self, good: &Good, look: &mut Look, is_part: bool) {
        if look.steps.is_none() && look.detail.is_none() {
            look.steps = self.default_steps(good, self.rough_numbers());
        }
        if look.steps.is_none() && look.detail.is_none() {
            return;
        }
        if let (Some(steps), Some(numbers), false) = (look.steps, self.rough_numbers(), is_part) {
            look.steps = Some(numbers.deepest(steps, self.pace.0));
        }
        look.detail = Some(look.detail.unwrap_or(0.0).max(DRAFT_DETAIL));
    }

    /// Returns the number of steps of a picture that gives none, where it is known.
    fn default_steps(&self, good: &Good, numbers: Option<Arc<Numbers>>) -> Option<u32> {
        match good.is_limit() {
            true => None,
            false => good.own_steps.or_else(|| numbers.map(|it| it.proposed)),
        }
    }

    /// Returns the number of steps at a magnification: elements stay as long in the picture as they are without it.
    fn followed(&self, good: &Good, look: &Look, factor: f64) -> Option<u32> {
        if look.detail.is_some() {
            return look.steps;
        }
        let steps = { look.steps }.or_else(|| self.default_steps(good, self.known_numbers()))?;
        let further = self.known_numbers().and_then(|it| it.further(factor));
        Some(steps.saturating_add(further.unwrap_or(0)).min(1_000_000))
    }

    /// Returns what forecast and dimension depend on.
    pub(super) fn key(&self) -> Key {
        let settings = { self.look.set.iter() }.map(|(name, value)| format!("{name}={value}"));
        (self.good_revision(), settings.collect())
    }

    /// Returns forecast and dimension, if they have been computed.
    pub(super) fn known_numbers(&self) -> Option<Arc<Numbers>> {
        let (key, numbers) = self.numbers.as_ref()?;
        (*key == self.key()).then(|| Arc::clone(numbers))
    }

    /// Returns forecast and dimension of the text, maybe with other values of its parameters.
    fn rough_numbers(&self) -> Option<Arc<Numbers>> {
        let ((revision, _), numbers) = self.numbers.as_ref()?;
        (*revision == self.good_revision()).then(|| Arc::clone(numbers))
    }

    /// Takes note of a draft that has been drawn.
    pub(super) fn note_draft(&mut self, drawn: &Drawn) {
        if let Some(elements) = drawn.elements {
            self.pace.note(elements, drawn.seconds);
        }
    }

    /// Refuses a step of too many elements, where a whole picture is drawn without a detail.
    pub(super) fn check_size(&self, look: &Look) -> Result<(), Refusal> {
        let good = self.good()?;
        let steps = look
            .steps
            .filter(|_| look.detail.is_none() && look.view.is_none());
        let (Some(steps), Some(numbers)) = (steps, self.known_numbers()) else {
            return Ok(());
        };
        if numbers.fits(steps) || look.is_density() || good.is_in_space {
            return Ok(());
        }
        Err(Refusal::wrong(format!(
            "step {steps} has {}, more than are grown here: fewer steps, or the detail of a pixel, draw it",
            numbers.described(steps)
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::Pace;

    #[test]
    fn drafts_settle_where_they_are_quick() {
        // Steps of twice, four and ten times as many elements, a microsecond each.
        for factor in [2_u64, 4, 10] {
            let mut pace = Pace::default();
            let mut drawn = Vec::new();
            for _ in 0..40 {
                let mut deepest = (0..20)
                    .map(|step| factor.pow(step))
                    .filter(|it| *it <= pace.0);
                let elements = deepest.next_back().unwrap();
                pace.note(elements, elements as f64 * 1e-6);
                drawn.push(elements);
            }
            assert!(drawn[20..].iter().all(|it| *it == drawn[39]), "{drawn:?}");
            assert!((1_000..=10_000).contains(&drawn[39]), "{drawn:?}");
        }
    }
}
