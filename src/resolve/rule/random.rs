//! Resolution of random variables and of moves.

use std::sync::Arc;

use crate::document::{GeneratorDocument, MoveDocument, WhichPoints, WrittenNumber, WrittenPoint};
use crate::expression::{Program, Scope, Type, is_name, is_reserved};

use super::{OfRule, ResolvedFrame};
use crate::draws::{Distribution, Variable};
use crate::resolve::{Resolver, whole_number};
use crate::rule::{ElementContext, Move};

/// Maximum number of moves of a generator: each takes time in every replacement.
const MAX_MOVES: usize = 1000;

/// Name of the distribution of a draw for each edge.
pub(super) const BY_EDGE: &str = "by_edge";

/// Lists of points that several moves share.
struct MovedPoints {
    all: Arc<[usize]>,
    inner: Arc<[usize]>,
}

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    pub(super) fn variables(
        &mut self,
        document: &GeneratorDocument,
        scope: &mut Scope,
    ) -> Vec<Variable> {
        let mut variables: Vec<Variable> = Vec::new();
        for (name, number) in &document.random {
            if !is_name(&name.value) {
                let message = format!("'{}' cannot be a variable's name", name.value);
                self.error_with_hint(
                    &name.place,
                    message,
                    "a name has letters, digits and _, and begins with a letter",
                );
            }
            let made = match number.value.as_call() {
                Some((BY_EDGE, [inner])) => {
                    if F::DIRECTIONS == 4 {
                        let message = "draws belong to edges of surfaces, in space only";
                        self.error_with_hint(&number.place, message, "write `space: 3` at the top");
                    }
                    let inner = WrittenNumber {
                        value: inner.clone(),
                        place: number.place.clone(),
                    };
                    let distribution = self.distribution(&inner, scope);
                    Variable::by_edge(&name.value, &distribution).into()
                }
                _ => {
                    let distribution = self.distribution(number, scope);
                    vec![Variable::new(&name.value, distribution)]
                }
            };
            for variable in made {
                let name_of = variable.name();
                if is_reserved(name_of) || scope.contains(name_of) {
                    let message = format!("'{name_of}' already has a meaning here");
                    let hint = "give the variable another name";
                    self.error_with_hint(&name.place, message, hint);
                }
                let slot = ElementContext::NAMES.len() + variables.len();
                scope.variable(name_of, slot);
                variables.push(variable);
            }
        }
        variables
    }

    fn distribution(&mut self, number: &WrittenNumber, scope: &Scope) -> Distribution {
        let hint = "uniform(a, b), normal(mean, deviation) or choice(a, b, ...)";
        if number.value.is_unknown() {
            return Distribution::Choice(vec![Program::unknown()]);
        }
        let Some((name, arguments)) = number.value.as_call() else {
            self.error_with_hint(&number.place, "a distribution is needed here", hint);
            return Distribution::Choice(vec![Program::unknown()]);
        };
        let programs: Vec<_> = arguments
            .iter()
            .map(|argument| self.part(number, argument, Type::Number, scope))
            .collect();
        match (name, programs.as_slice()) {
            ("uniform", [low, high]) => Distribution::Uniform(low.clone(), high.clone()),
            ("normal", [mean, deviation]) => {
                if deviation.as_constant().is_some_and(|value| value < 0.0) {
                    self.error(&number.place, "a standard deviation cannot be negative");
                }
                Distribution::Normal(mean.clone(), deviation.clone())
            }
            ("choice", [_, ..]) => Distribution::Choice(programs),
            _ => {
                let message = format!("{name} does not take {} values", programs.len());
                self.error_with_hint(&number.place, message, hint);
                Distribution::Choice(vec![Program::constant(0.0)])
            }
        }
    }

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
