//! From files as written to validated models: names are looked up, expressions compiled,
//! everything is checked, and all that is wrong is said at once.
//!
//! Nothing is said of what depends on a mistake that has been reported: expressions that could not
//! be read and names that may belong to what was not found are unknown, and so is all that is
//! computed from them.

mod fractal;
mod heading;
mod ifs;
mod instancing;
mod interpolation;
mod lsystem;
mod map;
mod numbers;
mod outline;
mod parameters;
mod rule;
mod set;
mod unused;

use std::collections::HashSet;

use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use crate::document::{HeadingDocument, KindDocument, Setting};
use crate::expression::Scope;
use crate::heading::Heading;
use crate::model::Model;

pub(crate) use parameters::order as order_of_parameters;

/// Behind this many mistakes no more are looked for.
const MOST_MISTAKES: usize = 1000;

/// Numbers of steps beyond this are refused.
pub(crate) const MOST_STEPS: u32 = 1_000_000;

/// Validates a file as written, with parameters set from outside.
///
/// # Errors
///
/// All that is wrong with it. What is only doubtful comes with the model.
pub(crate) fn resolve(
    document: &KindDocument,
    settings: &[Setting],
) -> Result<(Model, Diagnostics), Diagnostics> {
    match document {
        KindDocument::Rule(document) => {
            resolved(&document.heading, settings, |resolver, heading| {
                Some(Model::Rule(resolver.rule(document, heading).into()))
            })
        }
        KindDocument::Ifs(document) => {
            resolved(&document.heading, settings, |resolver, heading| {
                let system = resolver.system(document, heading)?;
                Some(Model::Ifs(system.into()))
            })
        }
        KindDocument::Instancing(document) => {
            resolved(&document.heading, settings, |resolver, heading| {
                let structure = resolver.structure(document, heading)?;
                Some(Model::Instancing(structure.into()))
            })
        }
        KindDocument::LSystem(document) => {
            resolved(&document.heading, settings, |resolver, heading| {
                let system = resolver.lsystem(document, heading)?;
                Some(Model::LSystem(system.into()))
            })
        }
    }
}

/// What a kind of file comes to, with what is doubtful; or else all that is wrong with it.
fn resolved<K: Default>(
    document: &HeadingDocument,
    settings: &[Setting],
    model: impl FnOnce(&mut Resolver<K>, Heading) -> Option<Model>,
) -> Result<(Model, Diagnostics), Diagnostics> {
    let mut resolver = Resolver::<K>::default();
    let heading = resolver.heading(document, settings);
    let model = model(&mut resolver, heading);
    let model = match model {
        Some(model) if !resolver.diagnostics.has_errors() => model,
        _ => return Err(resolver.diagnostics),
    };
    let mut doubts = Diagnostics::default();
    doubts.extend(unused::parameters(document, &resolver.used));
    doubts.extend(resolver.diagnostics);
    Ok((model, doubts))
}

/// What is known while a file is resolved, with what only its kind has.
#[derive(Default)]
struct Resolver<K> {
    diagnostics: Diagnostics,
    /// How many of them are errors.
    mistakes: usize,
    /// The file's parameters.
    constants: Scope,
    /// The names that expressions use.
    used: HashSet<String>,
    /// Whether a parent or a component is missing, which may have other names.
    incomplete: bool,
    /// The lines, curves and sides of sets that are fractals.
    pieces: usize,
    kind: K,
}

impl<K> Resolver<K> {
    fn error(&mut self, place: &Place, message: impl Into<String>) {
        self.mistakes += 1;
        self.diagnostics.push(Diagnostic::error(message).at(place));
    }

    fn error_with_hint(
        &mut self,
        place: &Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.mistakes += 1;
        self.diagnostics
            .push(Diagnostic::error(message).at(place).hint(hint));
    }
}

/// A value as a whole number from 0 to `most`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is checked"
)]
fn whole_number(value: f64, most: u32) -> Option<u32> {
    (value >= 0.0 && value <= f64::from(most) && value.fract() == 0.0).then_some(value as u32)
}
