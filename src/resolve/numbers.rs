//! Compilation of expressions in a scope.

use crate::diagnostic::Place;
use crate::document::{WrittenNumber, WrittenPoint};
use crate::expression::{Expression, ExpressionError, Program, Scope, Type};
use crate::geometry::DVec2;
use crate::rule::ElementContext;

use super::{MAX_MISTAKES, MAX_SUGGESTIONS, Resolver, whole_number};

impl<K> Resolver<K> {
    /// Compiles a number in a scope. Reports a mistake and returns an unknown program.
    pub(super) fn program(&mut self, number: &WrittenNumber, scope: &Scope) -> Program {
        self.part(number, &number.value, Type::Number, scope)
    }

    /// Compiles a weight in a scope. Reports a mistake, and a constant below 0.
    pub(super) fn weight(&mut self, number: &WrittenNumber, scope: &Scope) -> Program {
        let weight = self.program(number, scope);
        if weight.as_constant().is_some_and(|value| value < 0.0) {
            self.error(&number.place, "a weight cannot be negative");
        }
        weight
    }

    /// Compiles a condition in a scope. Reports a mistake and returns an unknown program.
    pub(super) fn condition(&mut self, number: &WrittenNumber, scope: &Scope) -> Program {
        self.part(number, &number.value, Type::Condition, scope)
    }

    /// Compiles a part of an expression. Reports a mistake and returns an unknown program.
    pub(super) fn part(
        &mut self,
        whole: &WrittenNumber,
        part: &Expression,
        result: Type,
        scope: &Scope,
    ) -> Program {
        if part.is_unknown() || self.mistakes >= MAX_MISTAKES {
            return Program::unknown();
        }
        let names = part.names().into_iter();
        self.used.extend(names.map(|(name, _)| name.to_owned()));
        let suggestions = MAX_SUGGESTIONS.saturating_sub(self.mistakes);
        let program = part.compiled(result, scope, suggestions);
        program.unwrap_or_else(|mistakes| {
            for mistake in mistakes {
                self.mistake(whole, mistake);
            }
            Program::unknown()
        })
    }

    fn mistake(&mut self, number: &WrittenNumber, mut mistake: ExpressionError) {
        let place = within(number, mistake.range.clone());
        if ElementContext::NAMES.contains(&place.text()) {
            mistake.hint = Some("it is known in generators and in conditions, but not here".into());
        }
        if self.random.contains(place.text()) {
            mistake.hint = Some("it is drawn at random, and not known here".into());
        }
        self.mistakes += 1;
        self.diagnostics.push(mistake.at(&place));
    }

    /// Evaluates a number in the scope of parameters. Returns `None` if its value is unknown.
    pub(super) fn constant(&mut self, number: &WrittenNumber) -> Option<f64> {
        self.constant_program(number).as_constant()
    }

    /// Evaluates a number that may be left out. Returns `None` if its value is unknown.
    pub(super) fn optional(&mut self, number: Option<&WrittenNumber>) -> Option<Option<f64>> {
        number.map_or(Some(None), |number| self.constant(number).map(Some))
    }

    /// Evaluates a seed, 0 where it is left out. Reports a mistake and returns `None`.
    pub(super) fn seed(&mut self, number: Option<&WrittenNumber>) -> Option<u32> {
        let Some(number) = number else {
            return Some(0);
        };
        let value = self.constant(number)?;
        let whole = whole_number(value, u32::MAX);
        if whole.is_none() {
            let message = format!("a seed is a whole number from 0, not {value}");
            self.error(&number.place, message);
        }
        whole
    }

    /// Compiles a number in the scope of parameters. The program is a constant if its value is known.
    pub(super) fn constant_program(&mut self, number: &WrittenNumber) -> Program {
        let scope = std::mem::take(&mut self.constants);
        let program = self.program(number, &scope);
        self.constants = scope;
        program
    }

    /// Evaluates a point in the scope of parameters. Returns `None` if a coordinate is unknown.
    pub(super) fn constant_point(&mut self, point: &WrittenPoint) -> Option<DVec2> {
        value(&self.point(point)?)
    }

    /// Compiles points in the scope of parameters. Returns `None` if a coordinate is unknown.
    pub(super) fn points(&mut self, points: &[WrittenPoint]) -> Option<Vec<[Program; 2]>> {
        let points: Vec<_> = points.iter().map(|point| self.point(point)).collect();
        points.into_iter().collect()
    }

    /// Compiles a point in the scope of parameters. Returns `None` if a coordinate is unknown.
    pub(super) fn point(&mut self, point: &WrittenPoint) -> Option<[Program; 2]> {
        self.numbers([&point.x, &point.y])
    }

    /// Compiles two numbers in the scope of parameters. Returns `None` if one is unknown.
    pub(super) fn numbers(&mut self, numbers: [&WrittenNumber; 2]) -> Option<[Program; 2]> {
        let programs = numbers.map(|number| self.constant_program(number));
        let are_known = self.varies || programs.iter().all(|it| it.as_constant().is_some());
        are_known.then_some(programs)
    }
}

/// Returns the value of a point if its coordinates are constants.
pub(super) fn value([x, y]: &[Program; 2]) -> Option<DVec2> {
    Some(DVec2::new(x.as_constant()?, y.as_constant()?))
}

/// Returns the values of points; NaN for one whose coordinates are not constants.
pub(super) fn values(points: &[[Program; 2]]) -> Vec<DVec2> {
    let values = points.iter().map(value);
    values.map(|it| it.unwrap_or(DVec2::NAN)).collect()
}

/// Returns the place of a part of a number, or of the whole number if its notation differs from its
/// text, as with escapes or several lines.
pub(super) fn within(number: &WrittenNumber, range: std::ops::Range<usize>) -> Place {
    let same = |read: Expression| read == number.value && read.range() == number.value.range();
    if Expression::parse(number.place.text()).is_ok_and(same) {
        number.place.within(range)
    } else {
        number.place.clone()
    }
}

/// Returns `, this is 7` for a number that is written as a formula, and nothing for a plain number.
pub(super) fn but(number: &WrittenNumber, value: f64) -> String {
    if number.place.text().parse() == Ok(value) {
        String::new()
    } else {
        format!(", this is {value}")
    }
}
