//! Resolution of affine maps.

use crate::document::{LinearDocument, MapDocument};
use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::ifs::{about, axes, complex, complex_conjugate};

use super::Resolver;

impl<K> Resolver<K> {
    /// Resolves an affine map. Reports mistakes and returns `None`.
    pub(super) fn affine(&mut self, document: &MapDocument) -> Option<DAffine2> {
        let linear = document.linear.as_ref().and_then(|it| self.linear(it));
        let shift = document.shift.as_ref().map(|it| self.constant_point(it));
        let fixed = document.fixed.as_ref().map(|it| self.constant_point(it));
        let linear = linear?;
        Some(match (shift, fixed) {
            (_, Some(fixed)) => about(linear, fixed?),
            (Some(shift), None) => DAffine2::from_mat2_translation(linear, shift?),
            (None, None) => DAffine2::from_mat2_translation(linear, DVec2::ZERO),
        })
    }

    fn linear(&mut self, document: &LinearDocument) -> Option<DMat2> {
        match document {
            LinearDocument::Matrix([first, second]) => {
                let (first, second) = (self.constant_point(first), self.constant_point(second));
                // The document has rows, the matrix has columns.
                Some(DMat2::from_cols(first?, second?).transpose())
            }
            LinearDocument::Axes { scale, rotate } => {
                let scale = self.numbers(scale);
                let rotate = match rotate {
                    Some(rotate) => self.numbers(rotate),
                    None => Some([0.0; 2]),
                };
                Some(axes(scale?.into(), rotate?.into()))
            }
            LinearDocument::Complex { times, conjugate } => {
                let map = if *conjugate {
                    complex_conjugate
                } else {
                    complex
                };
                Some(map(self.constant_point(times)?, DVec2::ZERO).matrix2)
            }
        }
    }
}
