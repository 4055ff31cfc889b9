//! Resolution of moves.

use std::sync::Arc;

use crate::document::{GeneratorDocument, MoveDocument, WhichPoints, WrittenPoint};
use crate::expression::{Program, Scope};

use super::{OfRule, ResolvedFrame};
use crate::resolve::{Resolver, whole_number};
use crate::rule::Move;

/// Maximum number of moves of a generator: each takes time in every replacement.
const MAX_MOVES: usize = 1000;

/// Lists of points that several moves share.
struct MovedPoints {
    all: Arc<[usize]>,
    inner: Arc<[usize]>,
}

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    /// Resolves the moves of a generator with `count` points; `inner` are the numbers of the points
    /// that are not ends of it.
    pub(super) fn moves(
        &mut self,
        document: &GeneratorDocument,
        scope: &Scope,
        count: usize,
        inner: Vec<usize>,
    ) -> Vec<Move<F>> {
        if let Some(moving) = document.moves.get(MAX_MOVES) {
            let message = format!(
                "a generator has 1,000 moves at most, this one has {}",
                document.moves.len()
            );
            let hint = "one move can scale, turn and shift any number of points";
            self.error_with_hint(&moving.place, message, hint);
        }
        let shared = MovedPoints {
            all: (0..count).collect(),
            inner: inner.into(),
        };
        let moves = document.moves.iter().take(MAX_MOVES);
        moves
            .map(|moving| self.moving(moving, scope, &shared))
            .collect()
    }

    fn moving(&mut self, document: &MoveDocument, scope: &Scope, shared: &MovedPoints) -> Move<F> {
        let shift = document.translate.as_ref().or(document.shift.as_ref());
        if let (Some(_), Some(shift)) = (&document.translate, &document.shift) {
            let message = "`shift` is another name of `translate`";
            self.error_with_hint(&shift.place, message, "write one of them");
        }
        let mut vector = |point: Option<&WrittenPoint>| match point {
            Some(point) => F::point_in(self, point, scope),
            None => F::splat(&Program::constant(0.0)),
        };
        let (shift, about) = (vector(shift), vector(document.about.as_ref()));
        let scale = F::factors(self, document.scale.as_deref().unwrap_or_default(), scope);
        let rotate = F::turns(self, document, scope);
        let points = match &document.points {
            WhichPoints::All => Arc::clone(&shared.all),
            WhichPoints::Inner => Arc::clone(&shared.inner),
            WhichPoints::Numbers(numbers) => {
                let mut points = Vec::new();
                for number in numbers {
                    let Some(value) = self.constant(number) else {
                        continue;
                    };
                    let largest = shared.all.last().copied().unwrap_or_default();
                    let largest = u32::try_from(largest).unwrap_or(u32::MAX);
                    match whole_number(value, largest) {
                        Some(point) => points.push(point as usize),
                        None => {
                            let message = format!(
                                "there is no point {value}: points are numbered 0 to {largest}"
                            );
                            self.error(&number.place, message);
                        }
                    }
                }
                points.into()
            }
        };
        Move {
            rotate,
            scale,
            shift,
            about,
            points,
            normals: Arc::default(),
        }
    }
}
