//! Constants and functions of AIFS.

use crate::diagnostic::Place;

use super::affine::Affine;
use super::syntax::Parsed;
use super::value::{Term, Value, wrong, wrong_with};

/// Functions that stand for random elements in a search.
const TEMPLATES: [&str; 6] = [
    "$number",
    "$vector",
    "$binary",
    "$semigroup",
    "$real",
    "$integer",
];

/// Returns a constant: `$i` is the identity, `$e` the empty set.
pub(super) fn constant<'a>(name: &str, place: &Place) -> Parsed<Value<'a>> {
    match name {
        "$i" => Ok(Value::Number(1.0)),
        "$e" => Ok(Value::Union(Vec::new())),
        "$pi" => Ok(Value::Number(std::f64::consts::PI)),
        "$" => wrong("lists that generate themselves are not read", place),
        name => wrong(format!("{name} is not defined"), place),
    }
}

/// Returns an element of a list; from the end, at -1 and before.
pub(super) fn element<'a>(list: Value<'a>, at: i32, place: &Place) -> Parsed<Value<'a>> {
    let Value::List(mut items) = list else {
        return wrong("only lists have elements", place);
    };
    let length = items.len();
    let from_start = usize::try_from(at).ok();
    let index = from_start.or_else(|| length.checked_sub(at.unsigned_abs() as usize));
    match index.filter(|index| *index < length) {
        Some(index) => Ok(items.swap_remove(index)),
        None => wrong(
            format!("the list has {length} elements, and none at {at}"),
            place,
        ),
    }
}

/// Returns the value of a function; angles are in radians.
pub(super) fn call<'a>(
    name: &str,
    arguments: Parsed<Vec<Value<'a>>>,
    dimension: usize,
    place: &Place,
) -> Parsed<Value<'a>> {
    if TEMPLATES.contains(&name) {
        return wrong_with(
            format!("{name} is a template: it stands for a map that a search is to find"),
            place,
            "blocks that define all their maps are read",
        );
    }
    let arguments = arguments?;
    if name == "if" {
        return condition(arguments, place);
    }
    let only = || match &arguments[..] {
        [only] => Ok(only),
        others => wrong(
            format!("{name} has one argument, not {}", others.len()),
            place,
        ),
    };
    let numeric = match name {
        "sin" => Some(libm::sin as fn(f64) -> f64),
        "cos" => Some(libm::cos as _),
        "tan" => Some(libm::tan as _),
        "asin" => Some(libm::asin as _),
        "acos" => Some(libm::acos as _),
        "atan" => Some(libm::atan as _),
        "exp" => Some(libm::exp as _),
        "log" => Some(libm::log as _),
        "floor" => Some(libm::floor as _),
        "ceil" => Some(libm::ceil as _),
        "abs" => Some(libm::fabs as _),
        _ => None,
    };
    if let Some(function) = numeric {
        return Ok(Value::Number(function(only()?.number(place)?)));
    }
    let entries = || {
        let numbers = only()?.numbers(place)?;
        match numbers.len() == dimension {
            true => Ok(numbers),
            false => {
                let count = numbers.len();
                let message =
                    format!("with $dim={dimension}, {name} takes {dimension} numbers, not {count}");
                wrong(message, place)
            }
        }
    };
    let matrix = match name {
        "$companion" => companion(&entries()?),
        "$diagonal" => diagonal(&entries()?),
        "$exchange" if arguments.is_empty() => exchange(dimension),
        _ => {
            return wrong_with(
                format!("the function {name} is not read"),
                place,
                "functions are $companion, $diagonal, $exchange, if, abs, sin, cos, tan, asin, acos, atan, exp, log, \
                 floor and ceil",
            );
        }
    };
    Ok(Value::Union(vec![Term {
        map: Affine::linear(dimension, matrix),
        set: None,
        place: place.clone(),
    }]))
}

/// Returns the first value whose condition, the value before it, is positive, or else the last value.
fn condition<'a>(mut arguments: Vec<Value<'a>>, place: &Place) -> Parsed<Value<'a>> {
    if let [only] = &arguments[..] {
        let is_positive = only.number(place)? > 0.0;
        return Ok(Value::Number(f64::from(u8::from(is_positive))));
    }
    if arguments.len().is_multiple_of(2) {
        return wrong(
            "if has a condition, a value for it, and another value",
            place,
        );
    }
    let count = arguments.len();
    for at in (0..count - 1).step_by(2) {
        if arguments[at].number(place)? > 0.0 {
            return Ok(arguments.swap_remove(at + 1));
        }
    }
    Ok(arguments.swap_remove(count - 1))
}

/// Returns the companion matrix of a₀ + a₁ x + … + xⁿ: ones below the diagonal, and -a in the last column.
fn companion(coefficients: &[f64]) -> Vec<f64> {
    let size = coefficients.len();
    matrix(size, |row, column| match column + 1 == size {
        true => -coefficients[row],
        false => f64::from(u8::from(row == column + 1)),
    })
}

fn diagonal(entries: &[f64]) -> Vec<f64> {
    matrix(entries.len(), |row, column| match row == column {
        true => entries[row],
        false => 0.0,
    })
}

fn exchange(size: usize) -> Vec<f64> {
    matrix(size, |row, column| {
        f64::from(u8::from(row + column + 1 == size))
    })
}

fn matrix(size: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let places = (0..size).flat_map(|row| (0..size).map(move |column| (row, column)));
    places.map(|(row, column)| entry(row, column)).collect()
}
