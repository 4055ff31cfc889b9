//! Parameters as the command line writes them.

use crate::expression::{Expression, ExpressionError, PARTS, Scope};
use crate::family::ParameterRange;

use super::{Assignment, ParameterPart, Ranges, Values};

/// Parses `NAME=VALUE`, `NAME=VALUE,VALUE`, `NAME=VALUE..VALUE` or `NAME=circle([RE,IM],RADIUS)`; a value is a formula, of
/// complex numbers too, or `[RE,IM]`.
pub(in crate::cli) fn assignment(text: &str) -> Result<Assignment, String> {
    let (name, written) = text.split_once('=').ok_or("write NAME=VALUE")?;
    let (name, written) = (name.trim().to_owned(), written.trim());
    let parts = match written.strip_prefix("circle(") {
        Some(inside) => circle(&name, inside)?,
        None if written.starts_with('[') => complex(&name, written)?,
        None => formulas(&name, written)?,
    };
    Ok(Assignment { name, parts })
}

/// Parses formulas: one, several separated by commas, or two with `..` between them. Complex ones have two parts.
fn formulas(name: &str, written: &str) -> Result<Vec<ParameterPart>, String> {
    let whole = Expression::parse(written);
    let (texts, is_range) = match (&whole, written.split_once("..")) {
        // A comma may belong to a function.
        (Ok(_), _) => (vec![written], false),
        (_, Some((first, last))) => (vec![first, last], true),
        (_, None) => (written.split(',').collect(), false),
    };
    let read: Result<Vec<_>, _> = texts.into_iter().map(Expression::parse).collect();
    let formulas = match (read, whole) {
        (Ok(formulas), _) => formulas,
        (Err(_), Err(error)) if !is_range => return Err(described(error)),
        (Err(error), _) => return Err(described(error)),
    };
    if !formulas.iter().any(|it| it.is_complex(&|_| false)) {
        return Ok(vec![part(name.to_owned(), formulas, is_range)?]);
    }
    let mut sides = [Vec::new(), Vec::new()];
    for formula in &formulas {
        let halves = formula.complex_parts(&mut 0).map_err(described)?;
        for (side, half) in sides.iter_mut().zip(halves) {
            side.push(half);
        }
    }
    both(name, sides, is_range)
}

/// Returns the values of formulas of a real parameter, or of one of the two parts of a complex one.
fn part(name: String, formulas: Vec<Expression>, is_range: bool) -> Result<ParameterPart, String> {
    let all: Result<Vec<f64>, String> = formulas.iter().map(value_of).collect();
    let all = all?;
    let (values, written) = match all[..] {
        [one] => (Values::One(one), formulas.into_iter().next()),
        [first, last] if is_range => (Values::Range([first, last]), None),
        _ => (Values::Several(all), None),
    };
    Ok(ParameterPart {
        name,
        values,
        written,
    })
}

/// Returns both parts of a complex parameter.
fn both(
    name: &str,
    sides: [Vec<Expression>; 2],
    is_range: bool,
) -> Result<Vec<ParameterPart>, String> {
    let sides = PARTS.into_iter().zip(sides);
    sides
        .map(|(suffix, side)| part(format!("{name}{suffix}"), side, is_range))
        .collect()
}

/// Parses complex values: `[RE,IM]`, several separated by commas, or two with `..` between them.
fn complex(name: &str, written: &str) -> Result<Vec<ParameterPart>, String> {
    const FORMS: &str =
        "a complex value is written [RE,IM], several are [RE,IM],[RE,IM] or [RE,IM]..[RE,IM]";
    let mut sides = [Vec::new(), Vec::new()];
    let (mut rest, mut is_range) = (written, false);
    loop {
        let (inside, after) = rest
            .strip_prefix('[')
            .and_then(|rest| rest.split_once(']'))
            .ok_or(FORMS)?;
        // A comma may belong to a function.
        let mut commas = inside.match_indices(',');
        let halves = commas.find_map(|(at, _)| {
            let real = Expression::parse(&inside[..at]).ok()?;
            let imaginary = Expression::parse(&inside[at + 1..]).ok()?;
            Some([real, imaginary])
        });
        for (side, half) in sides.iter_mut().zip(halves.ok_or(FORMS)?) {
            side.push(half);
        }
        let after = after.trim_start();
        if after.is_empty() {
            break;
        }
        let next = match after.strip_prefix("..") {
            Some(next) if sides[0].len() == 1 => {
                is_range = true;
                Some(next)
            }
            _ => after.strip_prefix(',').filter(|_| !is_range),
        };
        rest = next.ok_or(FORMS)?.trim_start();
    }
    both(name, sides, is_range)
}

/// Parses a circle of complex values, after `circle(`.
fn circle(name: &str, inside: &str) -> Result<Vec<ParameterPart>, String> {
    const FORM: &str = "a circle of complex values is written circle([RE,IM],RADIUS)";
    let (centre, radius) = inside
        .strip_suffix(')')
        .and_then(|inside| inside.rsplit_once(','))
        .ok_or(FORM)?;
    let radius = value(radius.trim())?;
    let centre = complex(name, centre.trim())?;
    let parts = centre.into_iter().enumerate();
    let part = |(number, part): (usize, ParameterPart)| match part.values {
        Values::One(centre) => Ok(ParameterPart {
            values: Values::Circle(centre, radius, number == 1),
            written: None,
            ..part
        }),
        _ => Err(FORM.to_owned()),
    };
    parts.map(part).collect()
}

/// Parses `NAME=FROM..TO` or `NAME=[RE,IM]..[RE,IM]`.
pub(in crate::cli) fn ranges(text: &str) -> Result<Ranges, String> {
    let Assignment { name, parts } = assignment(text)?;
    let axis = |part: ParameterPart| match part.values {
        Values::Range([from, to]) if from != to => Ok(ParameterRange {
            name: part.name,
            from,
            to,
        }),
        Values::Range(_) => Err(format!("the range of '{}' is empty", part.name)),
        _ => Err("write NAME=FROM..TO, or NAME=[RE,IM]..[RE,IM] for a complex parameter".into()),
    };
    let axes = parts.into_iter().map(axis).collect::<Result<_, _>>()?;
    let written = text.to_owned();
    Ok(Ranges {
        written,
        name,
        axes,
    })
}

pub(crate) fn value(text: &str) -> Result<f64, String> {
    value_of(&Expression::parse(text).map_err(described)?)
}

fn value_of(formula: &Expression) -> Result<f64, String> {
    let program = formula.compile(&Scope::new()).map_err(described)?;
    match program.as_constant() {
        Some(value) if value.is_finite() => Ok(value),
        _ => Err("the value is not finite".into()),
    }
}

fn described(error: ExpressionError) -> String {
    match error.hint {
        Some(hint) => format!("{} ({hint})", error.message),
        None => error.message,
    }
}
