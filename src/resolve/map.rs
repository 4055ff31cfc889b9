//! Resolution of affine maps.

use crate::document::{LinearDocument, MapDocument};
use crate::expression::{Affine, Arithmetic, Program, Symbols};

use super::Resolver;

impl<K> Resolver<K> {
    /// Resolves an affine map, whose numbers are constants. Reports mistakes and returns `None`.
    pub(super) fn affine(&mut self, document: &MapDocument) -> Option<Affine<Program>> {
        let linear = document.linear.as_ref().and_then(|it| self.linear(it));
        let shift = document.shift.as_ref().map(|it| self.point(it));
        let fixed = document.fixed.as_ref().map(|it| self.point(it));
        let linear = linear?;
        Some(match (shift, fixed) {
            (_, Some(fixed)) => linear.about(&mut Symbols, &fixed?),
            (Some(shift), None) => linear.moved_to(shift?),
            (None, None) => linear,
        })
    }

    fn linear(&mut self, document: &LinearDocument) -> Option<Affine<Program>> {
        match document {
            LinearDocument::Matrix([first, second]) => {
                let (first, second) = (self.point(first), self.point(second));
                // The document has rows, the map has columns.
                let ([a, c], [b, d]) = (first?, second?);
                Some(Affine::linear(&mut Symbols, [[a, b], [c, d]]))
            }
            LinearDocument::Axes { scale, rotate } => {
                let scale = self.numbers(scale.each_ref());
                let rotate = match rotate {
                    Some(rotate) => self.numbers(rotate.each_ref()),
                    None => Some([0.0; 2].map(Program::constant)),
                };
                let (scale, rotate) = (scale?, rotate?);
                let turns = rotate.map(|angle| Symbols.turn(&angle));
                Some(Affine::turned_axes(&mut Symbols, &scale, turns.each_ref()))
            }
            // Maps of space are resolved where systems are.
            LinearDocument::MatrixInSpace(_) | LinearDocument::AxesInSpace { .. } => None,
            LinearDocument::Complex { times, conjugate } => {
                let times = self.point(times)?;
                Some(Affine::complex(&mut Symbols, times, *conjugate))
            }
        }
    }
}
