//! Scopes: the names that an expression may use, and errors for unknown names.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::functions::{FUNCTIONS, Function};
use super::lex::PARTS;
use super::program::Op;
use super::{ExpressionError, Range};
use crate::diagnostic::{MAX_CANDIDATES, listed, nearest};

/// A constant of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Constant {
    /// Ratio of the circumference of a circle to its diameter.
    Pi,
    /// Golden ratio.
    Phi,
    /// Base of natural logarithms.
    E,
}

impl Constant {
    /// Returns the double next to the value.
    pub(super) fn value(self) -> f64 {
        match self {
            Self::Pi => std::f64::consts::PI,
            Self::Phi => 1.618_033_988_749_895,
            Self::E => std::f64::consts::E,
        }
    }
}

const CONSTANTS: [(&str, Constant); 3] = [
    ("pi", Constant::Pi),
    ("phi", Constant::Phi),
    ("e", Constant::E),
];

const KEYWORDS: [&str; 5] = ["and", "or", "not", "true", "false"];

/// Returns whether a name is reserved by the language: a constant, a function, a distribution or a
/// keyword.
#[must_use]
pub fn is_reserved(name: &str) -> bool {
    KEYWORDS.contains(&name) || constant(name).is_some() || Function::find(name).is_some()
}

/// Returns the constant `pi`, `phi` (the golden ratio, 1.618…) or `e`.
pub(super) fn constant(name: &str) -> Option<Constant> {
    let found = CONSTANTS.iter().find(|(known, _)| *known == name);
    found.map(|(_, constant)| *constant)
}

/// The names that an expression may use in addition to those of the language.
///
/// A [reserved](is_reserved) name keeps its meaning even if it is added here.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scope {
    names: BTreeMap<String, Named>,
    /// Scope in which names that are absent here are looked up.
    enclosing: Option<Arc<Scope>>,
    /// Whether all other names denote unknown values.
    open: bool,
}

/// Slot of unknown values. No list of slots is that long, hence the slot reads as NaN.
pub(super) const UNKNOWN: usize = usize::MAX;

/// Meaning of a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Named {
    /// A constant, with the operation that gives it in full.
    Constant(f64, Op),
    Slot(usize),
}

impl Scope {
    /// Creates a scope without names.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates a scope with all names of another one, which is shared and not copied.
    #[must_use]
    pub fn inside(enclosing: &Arc<Self>) -> Self {
        Self {
            names: BTreeMap::new(),
            enclosing: Some(Arc::clone(enclosing)),
            open: enclosing.open,
        }
    }

    /// Adds a name for a value, replacing a previous meaning.
    pub fn constant(&mut self, name: &str, value: f64) {
        let named = Named::Constant(value, Op::Constant(value));
        self.names.insert(name.to_owned(), named);
    }

    /// Adds a name for a parameter, by its index in [`Metadata::numbers`](crate::metadata::Metadata).
    pub(crate) fn parameter(&mut self, name: &str, value: f64, number: usize) {
        let named = Named::Constant(value, Op::Parameter(number));
        self.names.insert(name.to_owned(), named);
    }

    /// Adds a name for the value at index `slot` of the argument of
    /// [`Program::eval`](super::Program::eval), replacing a previous meaning.
    pub fn variable(&mut self, name: &str, slot: usize) {
        self.names.insert(name.to_owned(), Named::Slot(slot));
    }

    /// Adds a name whose value is unknown, so that values that depend on it cause no diagnostics.
    pub fn unknown_value(&mut self, name: &str) {
        self.variable(name, UNKNOWN);
    }

    /// Lets every other name denote an unknown value.
    pub fn accept_any_name(&mut self) {
        self.open = true;
    }

    /// Returns whether the name has been added, here or in an enclosing scope.
    #[must_use]
    pub fn contains(&self, name: &str) -> bool {
        self.own(name).is_some()
    }

    fn own(&self, name: &str) -> Option<Named> {
        let enclosed = || self.enclosing.as_ref().and_then(|scope| scope.own(name));
        self.names.get(name).copied().or_else(enclosed)
    }

    pub(super) fn get(&self, name: &str) -> Option<Named> {
        constant(name)
            .map(|constant| Named::Constant(constant.value(), Op::Named(constant)))
            .or_else(|| self.own(name))
            .or(self.open.then_some(Named::Slot(UNKNOWN)))
    }

    /// Returns the real part (0) or the imaginary part (1) of a name. A real number is its real part.
    pub(super) fn part(&self, name: &str, part: usize) -> Option<Named> {
        let whole = || {
            let whole = self.get(name)?;
            Some(match part {
                0 => whole,
                _ => Named::Constant(0.0, Op::Constant(0.0)),
            })
        };
        self.get(&format!("{name}{}", PARTS[part])).or_else(whole)
    }

    /// Returns the error of an unknown name. A similar name is searched if `suggests`.
    pub(super) fn unknown(
        &self,
        name: &str,
        range: Range<usize>,
        suggests: bool,
    ) -> ExpressionError {
        let [real, imaginary] = PARTS.map(|part| format!("{name}{part}"));
        if self.contains(&real) {
            let message = format!("'{name}' is a complex number, and a real one is needed here");
            let hint = format!("{real} and {imaginary} are its parts");
            return ExpressionError::new(range, message).hint(hint);
        }
        let mut wholes = PARTS.iter().filter_map(|part| name.strip_suffix(part));
        if let Some(whole) = wholes.find(|whole| self.contains(whole)) {
            let message = format!("'{whole}' is a real number, which has no parts");
            return ExpressionError::new(range, message).hint(format!("write {whole}"));
        }
        let scopes = std::iter::successors(Some(self), |scope| scope.enclosing.as_deref());
        // The first names of all scopes together are among the first ones of each.
        let own: BTreeSet<&str> = scopes
            .flat_map(|scope| scope.names.keys().map(String::as_str).take(MAX_CANDIDATES))
            .collect();
        let constants = CONSTANTS.iter().map(|(name, _)| *name);
        let own = own.into_iter().take(MAX_CANDIDATES);
        let known: Vec<&str> = own.chain(constants).collect();
        let words = KEYWORDS.iter().copied();
        let functions = FUNCTIONS.iter().map(|function| function.name);
        let candidates = known.iter().copied().chain(words).chain(functions);
        let nearest = suggests.then(|| nearest(name, candidates)).flatten();
        let hint = nearest.map_or_else(
            || format!("what can be used here: {}", listed(known.iter().copied())),
            |nearest| format!("did you mean '{nearest}'?"),
        );
        ExpressionError::new(range, format!("unknown name '{name}'")).hint(hint)
    }
}
