//! Numbers, maps, names and strings as text.

use std::fmt::Write as _;

use crate::geometry::{DAffine2, DVec2};
use crate::rule::{BaseElement, Piece};

/// Ratio to the largest number of a map below which a number is rounding error.
const ROUNDING: f64 = 1e-15;

/// Appends a number with eleven significant digits. Because maps contract, the errors of many levels sum to
/// a few units of the last digit.
fn push_number(text: &mut String, value: f64) {
    let rounded: f64 = format!("{value:.10e}").parse().unwrap_or(value);
    let start = text.len();
    // Writing to a string cannot fail. The addition turns -0 into 0.
    let _ = write!(text, "{}", rounded + 0.0);
    let digits = start + usize::from(text[start..].starts_with('-'));
    if text[digits..].starts_with("0.") {
        text.remove(digits);
    }
}

/// Appends a function call: a name with numbers in brackets.
fn push_call(text: &mut String, name: &str, numbers: &[f64]) {
    text.push_str(name);
    text.push('(');
    for (place, &number) in numbers.iter().enumerate() {
        if place > 0 {
            text.push(' ');
        }
        push_number(text, number);
    }
    text.push(')');
}

/// Smallest ratio of width to length of a map's image: SVG does not draw the contents of a map without
/// inverse. On a picture of some thousand pixels the widening is invisible.
const THINNEST: f64 = 1e-5;

/// Returns the map, widened if it is almost singular.
fn invertible(map: &DAffine2) -> DAffine2 {
    let (x, y) = (map.matrix2.x_axis, map.matrix2.y_axis);
    let longer = if x.length() > y.length() { x } else { y };
    let length = longer.length();
    if length == 0.0 {
        return DAffine2::from_scale_angle_translation(
            DVec2::splat(THINNEST),
            0.0,
            map.translation,
        );
    }
    if map.matrix2.determinant().abs() >= THINNEST * length * length {
        return *map;
    }
    // A map near u vᵀ is widened across u and v.
    let u = longer / length;
    let v = DVec2::new(x.dot(u), y.dot(u)).perp().normalize();
    let across = u.perp() * (THINNEST * length);
    let mut wide = *map;
    wide.matrix2.x_axis += across * v.x;
    wide.matrix2.y_axis += across * v.y;
    wide
}

/// Formats a map as an SVG transform, in the shorter of two forms; empty for the identity.
pub(super) fn transform(map: &DAffine2) -> String {
    let map = &invertible(map);
    let matrix = matrix(map);
    match similarity(map) {
        Some(similarity) if similarity.len() <= matrix.len() => similarity,
        _ => matrix,
    }
}

fn matrix(map: &DAffine2) -> String {
    let all = map.to_cols_array();
    let small = ROUNDING
        * all
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
    let mut text = String::new();
    let cleaned = all.map(|value| if value.abs() <= small { 0.0 } else { value });
    push_call(&mut text, "matrix", &cleaned);
    text
}

/// Formats a similarity as translation, rotation and scale; `None` for other maps.
fn similarity(map: &DAffine2) -> Option<String> {
    let (x, y) = (map.matrix2.x_axis, map.matrix2.y_axis);
    let scale = x.length();
    let mirrored = map.matrix2.determinant() < 0.0;
    let across = if mirrored { -x.perp() } else { x.perp() };
    if (y - across).length() > 1e-12 * scale {
        return None;
    }
    let mut text = String::new();
    let small = ROUNDING * (scale + map.translation.abs().max_element());
    let at = |value: f64| if value.abs() <= small { 0.0 } else { value };
    let DVec2 { x: right, y: up } = map.translation;
    match (at(right), at(up)) {
        (0.0, 0.0) => {}
        (right, 0.0) => push_call(&mut text, "translate", &[right]),
        (right, up) => push_call(&mut text, "translate", &[right, up]),
    }
    let degrees = libm::atan2(x.y, x.x).to_degrees();
    // A deviation of less than 1e-12 from an integer number of degrees is rounding.
    let whole = degrees.round();
    let degrees = if (degrees - whole).abs() < 1e-12 {
        whole
    } else {
        degrees
    };
    let (degrees, scale) = if degrees.abs() == 180.0 {
        (0.0, -scale)
    } else {
        (degrees, scale)
    };
    if degrees != 0.0 {
        push_call(&mut text, "rotate", &[degrees]);
    }
    match (mirrored, scale) {
        (false, 1.0) => {}
        (false, scale) => push_call(&mut text, "scale", &[scale]),
        (true, scale) => push_call(&mut text, "scale", &[scale, -scale]),
    }
    Some(text)
}

/// Formats the path data of an outline.
pub(super) fn outline(base_element: &BaseElement) -> String {
    let mut text = String::new();
    let mut points = |letter: char, points: &[DVec2]| {
        text.push(letter);
        for (place, coordinate) in points.iter().flat_map(|at| at.to_array()).enumerate() {
            if place > 0 {
                text.push(' ');
            }
            push_number(&mut text, coordinate);
        }
    };
    points('M', &[base_element.start()]);
    let mut pieces = base_element.pieces();
    if let ([rest @ .., Piece::Line(_)], true) = (pieces, base_element.is_closed()) {
        pieces = rest;
    }
    for piece in pieces {
        match *piece {
            Piece::Line(end) => points('L', &[end]),
            Piece::Cubic(a, b, end) => points('C', &[a, b, end]),
        }
    }
    if base_element.is_closed() {
        text.push('Z');
    }
    text
}

/// Formats the path data of a straight line.
pub(super) fn line(from: DVec2, to: DVec2) -> String {
    let mut text = String::from("M");
    for (place, coordinate) in [from.x, from.y, to.x, to.y].into_iter().enumerate() {
        if place > 0 {
            text.push(' ');
        }
        push_number(&mut text, coordinate);
    }
    text
}

/// Returns a name of letters for a number: a to z, aa, ab and so on.
pub(super) fn name(mut number: u64) -> String {
    let mut letters = Vec::new();
    loop {
        letters.push(b"abcdefghijklmnopqrstuvwxyz"[(number % 26) as usize]);
        number /= 26;
        if number == 0 {
            break;
        }
        number -= 1;
    }
    letters.iter().rev().copied().map(char::from).collect()
}

/// Returns a text as a string in double quotes, as in C, of one line; other control characters are left out.
pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            '\n' => quoted.push_str("\\n"),
            '\r' => quoted.push_str("\\r"),
            '\t' => quoted.push_str("\\t"),
            _ if letter.is_control() => {}
            _ => quoted.push(letter),
        }
    }
    quoted + "\""
}

/// Returns numbers in brackets, with commas between them.
pub(super) fn list(brackets: [char; 2], numbers: &[f64]) -> String {
    let mut text = String::from(brackets[0]);
    for (place, &number) in numbers.iter().enumerate() {
        if place > 0 {
            text.push(',');
        }
        // Writing to a string cannot fail. The addition turns -0 into 0.
        let _ = write!(text, "{}", number + 0.0);
    }
    text.push(brackets[1]);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Direction, Frame2};

    #[test]
    fn maps_are_short_and_precise() {
        let similar = |from: [f64; 2], to: [f64; 2], direction| {
            transform(Frame2::between(from.into(), to.into(), direction).map())
        };
        let third = 1.0 / 3.0;
        let normal = Direction::Normal;
        assert_eq!(
            similar([0.0, 0.0], [third, 0.0], normal),
            "scale(.33333333333)"
        );
        let up = [0.5, libm::sqrt(3.0) / 6.0];
        assert_eq!(
            similar([third, 0.0], up, normal),
            "translate(.33333333333)rotate(60)scale(.33333333333)"
        );
        assert_eq!(
            similar([0.0, 0.0], [0.5, 0.0], Direction::YReflected),
            "scale(.5 -.5)"
        );
        assert_eq!(
            similar([0.0, 0.0], [0.5, 0.0], Direction::BothReflected),
            "translate(.5)scale(-.5)"
        );
        assert_eq!(similar([0.0, 0.0], [1.0, 0.0], normal), "");
        let sheared = DAffine2::from_cols_array(&[0.5, 0.0, 0.25, 1e-17, -1e-12, 3.0]);
        assert_eq!(
            transform(&sheared),
            "matrix(.5 -.0000022360679775 .25 .000004472135955 -.000000000001 3)"
        );
        let flat = DAffine2::from_cols_array(&[0.0, 0.0, 0.0, 0.16, 0.0, 0.0]);
        assert_eq!(transform(&flat), "matrix(.0000016 0 0 .16 0 0)");
    }

    #[test]
    fn names_are_all_different() {
        let names: Vec<_> = [0, 25, 26, 51, 52, 701, 702].map(name).into();
        assert_eq!(names, ["a", "z", "aa", "az", "ba", "zz", "aaa"]);
    }
}
