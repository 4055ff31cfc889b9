//! Trigonometric functions in degrees, exact where the value is representable, and equal on every
//! machine.
//!
//! Angles are reduced without error modulo 360 and then to an octant before the conversion to radians.
//! Hence multiples of 90 degrees give exactly 0 and ±1, `sin(30)` is 0.5, `sin(45) == cos(45)`,
//! `tan(45)` is 1, and `sin(x) == cos(90 - x)` to the bit wherever `90 - x` is exact. Elsewhere the
//! error is below two units in the last place. The inverse functions invert every integral number of
//! degrees in their range: `asin(sin(17))` is 17.

use std::f64::consts::FRAC_1_SQRT_2;

/// Computes the sine of `x` degrees.
pub(crate) fn sin(x: f64) -> f64 {
    let turn = x % 360.0;
    let (angle, sign) = half_turn(turn.abs());
    let sign = if turn < 0.0 { -sign } else { sign };
    let angle = if angle > 90.0 { 180.0 - angle } else { angle };
    sign * quarter(angle).0 + 0.0
}

/// Computes the cosine of `x` degrees.
pub(crate) fn cos(x: f64) -> f64 {
    let (angle, sign) = half_turn((x % 360.0).abs());
    if angle > 90.0 {
        -sign * quarter(180.0 - angle).1 + 0.0
    } else {
        sign * quarter(angle).1 + 0.0
    }
}

/// Computes the tangent of `x` degrees; infinite at odd multiples of 90.
pub(crate) fn tan(x: f64) -> f64 {
    sin(x) / cos(x) + 0.0
}

/// Turns a vector of the plane by `by` degrees, counter-clockwise.
pub(crate) fn turned([x, y]: [f64; 2], by: f64) -> [f64; 2] {
    if by == 0.0 {
        return [x, y];
    }
    let (sine, cosine) = (sin(by), cos(by));
    [cosine * x - sine * y, sine * x + cosine * y]
}

/// Computes the arc sine in degrees, from -90 to 90; NaN outside -1 to 1.
pub(crate) fn asin(x: f64) -> f64 {
    whole(libm::asin(x).to_degrees(), x, sin)
}

/// Computes the arc cosine in degrees, from 0 to 180; NaN outside -1 to 1.
pub(crate) fn acos(x: f64) -> f64 {
    whole(libm::acos(x).to_degrees(), x, cos)
}

/// Computes the arc tangent in degrees, from -90 to 90.
pub(crate) fn atan(x: f64) -> f64 {
    whole(libm::atan(x).to_degrees(), x, tan)
}

/// Computes the argument of the point (`x`, `y`) in degrees, counter-clockwise from the x axis, above
/// -180 and up to 180; 0 for the origin.
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    if x.is_nan() || y.is_nan() {
        return f64::NAN;
    }
    let angle = if y == 0.0 { 0.0 } else { atan((y / x).abs()) };
    let upper = if x < 0.0 { 180.0 - angle } else { angle };
    if y < 0.0 { -upper } else { upper }
}

/// Reduces an angle from 0 up to 360 to one below 180, with the sign that sine and cosine get.
fn half_turn(angle: f64) -> (f64, f64) {
    if angle >= 180.0 {
        (angle - 180.0, -1.0)
    } else {
        (angle, 1.0)
    }
}

/// Computes sine and cosine of an angle from 0 to 90.
fn quarter(angle: f64) -> (f64, f64) {
    if angle > 45.0 {
        let (sin, cos) = octant(90.0 - angle);
        (cos, sin)
    } else {
        octant(angle)
    }
}

/// Computes sine and cosine of an angle from 0 to 45.
fn octant(angle: f64) -> (f64, f64) {
    if angle == 45.0 {
        (FRAC_1_SQRT_2, FRAC_1_SQRT_2)
    } else if angle == 30.0 {
        (0.5, 3.0_f64.sqrt() / 2.0)
    } else {
        libm::sincos(angle.to_radians())
    }
}

/// Returns the integer nearest to `angle` if `function` maps it exactly to `value`, and `angle`
/// otherwise.
fn whole(angle: f64, value: f64, function: impl Fn(f64) -> f64) -> f64 {
    let nearest = angle.round();
    if function(nearest) == value {
        nearest
    } else {
        angle
    }
}
