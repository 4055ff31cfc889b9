//! Resolution of metadata, which files of all kinds have.

use crate::document::{MetadataDocument, Setting, WrittenNumber};
use crate::metadata::{MAX_STEPS, Metadata};

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
            style: document.style.clone(),
            view: document.view,
            space: document.space.clone(),
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

    fn dimension(&mut self, number: Option<&WrittenNumber>) -> Option<f64> {
        self.constant(number?)
    }
}
