//! Resolution of metadata, which files of all kinds have.

use crate::document::{MetadataDocument, Setting, SymmetryDocument, WrittenNumber};
use crate::expression::Program;
use crate::metadata::{MAX_STEPS, Metadata};
use crate::symmetry::{MOST_TURNS, Symmetry};

use super::{Resolver, numbers, whole_number};

impl<K> Resolver<K> {
    /// Resolves the metadata of a file and adds its parameters to the scope of expressions.
    pub(super) fn metadata(
        &mut self,
        document: &MetadataDocument,
        settings: &[Setting],
    ) -> Metadata {
        self.incomplete = !document.complete;
        let (parameters, numbers) = self.parameters(document, settings);
        if self.incomplete {
            self.constants.accept_any_name();
        }
        let steps = document.steps.as_ref();
        Metadata {
            description: document.description.clone(),
            parameters,
            numbers,
            steps: steps.and_then(|number| self.steps(number)),
            dimension: self.dimension(document.dimension.as_ref()),
            hausdorff_dimension: self.dimension(document.hausdorff_dimension.as_ref()),
            symmetry: { document.symmetry.as_ref() }.and_then(|written| self.symmetry(written)),
            style: document.style.clone(),
            view: document.view,
            space: document.space.clone(),
            density: document.density,
        }
    }

    pub(super) fn steps(&mut self, number: &WrittenNumber) -> Option<u32> {
        let value = self.constant(number)?;
        let whole = whole_number(value, MAX_STEPS);
        if whole.is_none() {
            let message = format!(
                "a number of steps is a whole number from 0 to 1,000,000{}",
                numbers::but(number, value)
            );
            if value > 0.0 && value <= f64::from(MAX_STEPS) {
                let hint = format!("steps: {}", value.trunc());
                self.error_with_hint(&number.place, message, hint);
            } else {
                self.error(&number.place, message);
            }
        }
        whole
    }

    /// Resolves a symmetry group. Reports a mistake and returns `None`.
    fn symmetry(&mut self, document: &SymmetryDocument) -> Option<Symmetry> {
        let rotate = match &document.rotate {
            Some(number) => self.turns(number),
            None => Some(1),
        };
        let centre = match &document.centre {
            Some(centre) => self.point(centre),
            None => Some([0.0; 2].map(Program::constant)),
        };
        let axis = match &document.axis {
            Some(axis) => self.constant_program(axis),
            None => Program::constant(90.0),
        };
        let ([x, y], rotate) = (centre?, rotate?);
        let at = numbers::value(&[x.clone(), y.clone()])?;
        let angle = axis.as_constant()?;
        Some(Symmetry {
            written: [x, y, axis],
            ..Symmetry::new(rotate, document.mirror.then_some(angle), at)
        })
    }

    /// Resolves the number of the rotations of a symmetry. Reports a mistake and returns `None`.
    fn turns(&mut self, number: &WrittenNumber) -> Option<u32> {
        let value = self.constant(number)?;
        let turns = whole_number(value, MOST_TURNS).filter(|&turns| turns > 0);
        if turns.is_none() {
            let message = format!(
                "the number of rotations is a whole number from 1 to {MOST_TURNS}{}",
                numbers::but(number, value)
            );
            let hint = "rotate: 6 repeats the picture at every 60 degrees";
            self.error_with_hint(&number.place, message, hint);
        }
        turns
    }

    fn dimension(&mut self, number: Option<&WrittenNumber>) -> Option<f64> {
        self.constant(number?)
    }
}
