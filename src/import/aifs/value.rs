//! Values of AIFS expressions: numbers, lists, maps, and unions of maps of sets.

use crate::diagnostic::{Diagnostic, Place};

use super::affine::Affine;
use super::syntax::Parsed;

/// Largest number of maps in a union.
const MAX_TERMS: usize = 20_000;

/// Message about a map in the definition of the dimension.
pub(super) const NO_DIMENSION: &str = "a map where the number of dimensions is expected";

/// Value of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value<'a> {
    Number(f64),
    List(Vec<Value<'a>>),
    /// A union, with one term for a map.
    Union(Vec<Term<'a>>),
}

/// A map, or the image of a set under it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Term<'a> {
    pub(super) map: Affine,
    /// Name of the set.
    pub(super) set: Option<&'a str>,
    /// Place at which the term is refused.
    pub(super) place: Place,
}

/// Returns a mistake at a place.
pub(super) fn wrong<T>(message: impl Into<String>, place: &Place) -> Parsed<T> {
    Err(Box::new(Diagnostic::error(message).at(place)))
}

/// Returns a mistake at a place, with a remedy.
pub(super) fn wrong_with<T>(
    message: impl Into<String>,
    place: &Place,
    hint: impl Into<String>,
) -> Parsed<T> {
    Err(Box::new(Diagnostic::error(message).at(place).hint(hint)))
}

impl<'a> Value<'a> {
    /// Returns the number; an error if this is something else.
    pub(super) fn number(&self, place: &Place) -> Parsed<f64> {
        match self {
            Self::Number(number) => Ok(*number),
            other => wrong(
                format!("{} where a number is expected", other.noun()),
                place,
            ),
        }
    }

    /// Returns the number if it is whole.
    pub(super) fn whole(&self, place: &Place) -> Parsed<i32> {
        let number = self.number(place)?;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "casts from floats saturate"
        )]
        let whole = number as i32;
        match f64::from(whole) == number {
            true => Ok(whole),
            false => wrong(format!("{number} where a whole number is expected"), place),
        }
    }

    /// Returns the numbers of a list.
    pub(super) fn numbers(&self, place: &Place) -> Parsed<Vec<f64>> {
        match self {
            Self::List(items) => items.iter().map(|item| item.number(place)).collect(),
            other => wrong(format!("{} where a list is expected", other.noun()), place),
        }
    }

    /// Returns the value as a union: a number x is the map x I, and a list of n or n² numbers a translation or a matrix.
    pub(super) fn terms(self, dimension: usize, place: &Place) -> Parsed<Vec<Term<'a>>> {
        let map = match self {
            Self::Union(terms) => return Ok(terms),
            _ if dimension == 0 => return wrong(NO_DIMENSION, place),
            Self::Number(factor) => Affine::scaling(dimension, factor),
            Self::List(_) => {
                let numbers = self.numbers(place)?;
                match numbers.len() {
                    length if length == dimension => Affine::translation(numbers),
                    length if length == dimension * dimension => Affine::linear(dimension, numbers),
                    length => {
                        let square = dimension * dimension;
                        return wrong_with(
                            format!("a list of {length} numbers is no map"),
                            place,
                            format!(
                                "with $dim={dimension}, a translation has {dimension} numbers and a matrix {square}"
                            ),
                        );
                    }
                }
            }
        };
        Ok(vec![Term {
            map,
            set: None,
            place: place.clone(),
        }])
    }

    /// Returns the value as a single map.
    pub(super) fn map(self, dimension: usize, place: &Place) -> Parsed<Affine> {
        let noun = self.noun();
        let mut terms = self.terms(dimension, place)?;
        match (terms.pop(), terms.is_empty()) {
            (Some(Term { map, set: None, .. }), true) => Ok(map),
            _ => wrong(format!("{noun} where a map is expected"), place),
        }
    }

    /// Returns whether the value is a list that stands for a translation, which sums would not add to a map.
    pub(super) fn is_translation(&self, dimension: usize) -> bool {
        matches!(self, Self::List(items) if items.len() == dimension)
    }

    fn noun(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::List(_) => "a list",
            Self::Union(terms) => match &terms[..] {
                [Term { set: None, .. }] => "a map",
                [] => "the empty set",
                terms if terms.iter().any(|term| term.set.is_some()) => "a set",
                _ => "a union of maps",
            },
        }
    }
}

/// Returns the maps of one union after those of another; errors are reported at a place.
pub(super) fn composed<'a>(
    first: &[Term<'a>],
    then: &[Term<'a>],
    place: &Place,
) -> Parsed<Vec<Term<'a>>> {
    if then.iter().any(|term| term.set.is_some()) && !first.is_empty() {
        let hint = "a set is the last factor of a product";
        return wrong_with("a set is not a map", place, hint);
    }
    if first.len().saturating_mul(then.len()) > MAX_TERMS {
        return wrong(format!("this has more than {MAX_TERMS} maps"), place);
    }
    // A single factor of many terms is not at fault.
    let is_common = then.len() == 1 && first.len() > 1;
    let pairs = then
        .iter()
        .flat_map(|then| first.iter().map(move |first| (then, first)));
    let terms = pairs.map(|(then, first)| Term {
        map: then.map.after(&first.map),
        set: first.set,
        place: if is_common { &first.place } else { &then.place }.clone(),
    });
    Ok(terms.collect())
}

/// Returns the union of two unions.
pub(super) fn united<'a>(mut all: Vec<Term<'a>>, more: Vec<Term<'a>>) -> Parsed<Vec<Term<'a>>> {
    all.extend(more);
    match all.last() {
        Some(last) if all.len() > MAX_TERMS => {
            wrong(format!("this has more than {MAX_TERMS} maps"), &last.place)
        }
        _ => Ok(all),
    }
}
