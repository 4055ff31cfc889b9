//! Interval arithmetic (Moore 1966): bounds of the values of a program from bounds of its slots.

use std::ops::{Add, Mul, Sub};

use super::degrees;
use super::operator::{One, Two};
use super::program::{Arithmetic, Evaluation, Program};

/// The closed interval from `low` to `high`, either of which may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Interval {
    /// The real line.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Creates an interval from its bounds. Returns [`Interval::ALL`] if they are not in order or one
    /// is NaN.
    #[must_use]
    pub fn new(low: f64, high: f64) -> Self {
        if low <= high {
            Self { low, high }
        } else {
            Self::ALL
        }
    }

    /// Creates the interval of a single number.
    #[must_use]
    pub fn point(value: f64) -> Self {
        Self::new(value, value)
    }

    /// Returns the smallest interval that contains the values; [`Interval::ALL`] if one is NaN or there
    /// are none.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let all = Self {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        let hull = values.iter().fold(all, |hull, &value| Self {
            low: hull.low.min(value),
            high: hull.high.max(value),
        });
        if values.iter().any(|value| value.is_nan()) {
            return Self::ALL;
        }
        Self::new(hull.low, hull.high)
    }

    /// Returns the smallest interval that contains both intervals.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// Returns part `number` of `count` parts of equal width.
    #[must_use]
    pub fn part(self, number: usize, count: usize) -> Self {
        Self::along(self.low, self.high, number, count)
    }

    /// Returns the interval between the ends of part `number` of `count` equal parts of the way from
    /// `from` to `to`, which may be in either order.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "numbers of parts are small")]
    pub fn along(from: f64, to: f64, number: usize, count: usize) -> Self {
        let at = |number: usize| match number as f64 / count as f64 {
            0.0 => from,
            1.0 => to,
            share => from * (1.0 - share) + to * share,
        };
        Self::of(&[at(number), at(number + 1)])
    }

    /// Returns the largest absolute value.
    #[must_use]
    pub fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    fn as_point(self) -> Option<f64> {
        #[expect(clippy::float_cmp, reason = "one number is one number")]
        (self.low == self.high).then_some(self.low)
    }

    fn holds_zero(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    /// Returns the range of a monotonically increasing function that is defined from `least` on.
    fn rising(self, least: f64, function: impl Fn(f64) -> f64) -> Self {
        let [low, high] = [self.low, self.high].map(|end| function(end.max(least)));
        Self::new(low, high)
    }

    fn abs(self) -> Self {
        let least = if self.holds_zero() {
            0.0
        } else {
            self.low.abs().min(self.high.abs())
        };
        Self::new(least, self.magnitude())
    }

    /// Returns the hull of the values at the four corners: the range of a function of two variables
    /// that is monotonic in each.
    fn corners(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        let [a, b] = [self.low, self.high];
        let [c, d] = [other.low, other.high];
        Self::of(&[
            function(a, c),
            function(a, d),
            function(b, c),
            function(b, d),
        ])
    }

    /// Returns the range of the sine over angles in degrees.
    #[must_use]
    pub fn sine(self) -> Self {
        Self::new(self.low - 90.0, self.high - 90.0).cosine()
    }

    /// Returns the range of the cosine over angles in degrees.
    #[must_use]
    pub fn cosine(self) -> Self {
        let peak = |offset: f64| {
            let next = ((self.low - offset) / 360.0).ceil() * 360.0 + offset;
            next <= self.high
        };
        if self.high - self.low >= 360.0 {
            return Self::new(-1.0, 1.0);
        }
        let ends = Self::of(&[degrees::cos(self.low), degrees::cos(self.high)]);
        Self {
            low: if peak(180.0) { -1.0 } else { ends.low },
            high: if peak(0.0) { 1.0 } else { ends.high },
        }
    }

    /// Interprets the interval as a condition: returns whether it holds, if that is known.
    fn truth(self) -> Option<bool> {
        match self.as_point() {
            Some(value) => Some(value != 0.0),
            None => (!self.holds_zero()).then_some(true),
        }
    }

    fn condition(holds: Option<bool>) -> Self {
        match holds {
            Some(holds) => Self::point(f64::from(u8::from(holds))),
            None => Self::new(0.0, 1.0),
        }
    }

    fn less(self, other: Self) -> Option<bool> {
        if self.high < other.low {
            Some(true)
        } else {
            (self.low >= other.high).then_some(false)
        }
    }

    fn power(self, exponent: Self) -> Self {
        let apply = |x, y| Two::Power.apply(x, y);
        let Some(y) = exponent.as_point().filter(|y| y.fract() == 0.0) else {
            // Without an integral exponent, only numbers from 0 on have powers.
            let base = self.rising(0.0, |x| x);
            return base.corners(exponent, apply);
        };
        if y < 0.0 && self.holds_zero() {
            return Self::ALL;
        }
        if y % 2.0 == 0.0 {
            return self.abs().corners(exponent, apply);
        }
        self.corners(exponent, apply)
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::new(self.low - other.high, self.high - other.low)
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        // The bound of a product of 0 with an infinite bound is 0: the values themselves are finite.
        self.corners(other, |a, b| if a == 0.0 || b == 0.0 { 0.0 } else { a * b })
    }
}

impl One {
    /// Computes the range of the operation. Arguments for which it is not defined are ignored.
    fn range(self, x: Interval) -> Interval {
        if let Some(x) = x.as_point() {
            return Interval::point(self.apply(x));
        }
        let rising = |least| x.rising(least, |x| self.apply(x));
        match self {
            Self::Negate => Interval::point(0.0) - x,
            Self::Not => Interval::condition(x.truth().map(|holds| !holds)),
            Self::Abs => x.abs(),
            Self::Sqrt | Self::Ln | Self::Log2 | Self::Log10 => rising(0.0),
            Self::Cbrt | Self::Sign | Self::Floor | Self::Ceil | Self::Round => {
                rising(f64::NEG_INFINITY)
            }
            Self::Exp | Self::Atan => rising(f64::NEG_INFINITY),
            Self::Cos => x.cosine(),
            Self::Sin => x.sine(),
            Self::Asin => Interval::new(-90.0, 90.0),
            Self::Acos => Interval::new(0.0, 180.0),
            Self::Tan => Interval::ALL,
            Self::Odd | Self::Even => Interval::condition(None),
        }
    }
}

impl Two {
    fn range(self, a: Interval, b: Interval) -> Interval {
        if let (Some(a), Some(b)) = (a.as_point(), b.as_point()) {
            return Interval::point(self.apply(a, b));
        }
        let condition = Interval::condition;
        match self {
            Self::Or => condition(match (a.truth(), b.truth()) {
                (Some(true), _) | (_, Some(true)) => Some(true),
                (Some(false), Some(false)) => Some(false),
                _ => None,
            }),
            Self::And => condition(match (a.truth(), b.truth()) {
                (Some(false), _) | (_, Some(false)) => Some(false),
                (Some(true), Some(true)) => Some(true),
                _ => None,
            }),
            Self::Less => condition(a.less(b)),
            Self::Greater => condition(b.less(a)),
            Self::LessEqual => condition(b.less(a).map(|less| !less)),
            Self::GreaterEqual => condition(a.less(b).map(|less| !less)),
            Self::Equal | Self::NotEqual => {
                let apart = a.high < b.low || b.high < a.low;
                condition(apart.then_some(self == Self::NotEqual))
            }
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide if b.holds_zero() => Interval::ALL,
            Self::Divide => a.corners(b, |a, b| a / b),
            Self::Modulo => Interval::new(b.low.min(0.0), b.high.max(0.0)),
            Self::Power => a.power(b),
            Self::Min | Self::Max => a.corners(b, |a, b| self.apply(a, b)),
            Self::Hypot => a.abs().corners(b.abs(), |a, b| self.apply(a, b)),
            Self::Atan2 => Interval::new(-180.0, 180.0),
        }
    }
}

impl Program {
    /// Computes an interval that contains all values of the program, up to rounding, for slots within
    /// the given intervals. Missing slots may have any value. The interval may be too wide, less so the
    /// narrower the slots are.
    #[must_use]
    pub fn range(&self, slots: &[Interval]) -> Interval {
        self.evaluate(&mut Intervals, slots)
    }
}

/// Arithmetic of intervals.
struct Intervals;

impl Arithmetic for Intervals {
    type Number = Interval;

    fn decimal(&mut self, value: f64) -> Interval {
        Interval::point(value)
    }

    fn one(&mut self, operation: One, x: &Interval) -> Interval {
        operation.range(*x)
    }

    fn two(&mut self, operation: Two, a: &Interval, b: &Interval) -> Interval {
        operation.range(*a, *b)
    }
}

impl Evaluation for Intervals {
    fn unknown(&mut self) -> Interval {
        Interval::ALL
    }

    fn select(&mut self, condition: &Interval, [then, otherwise]: [&Interval; 2]) -> Interval {
        match condition.truth() {
            Some(true) => *then,
            Some(false) => *otherwise,
            None => then.or(*otherwise),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::expression::{Expression, Scope};

    const TEXTS: [&str; 20] = [
        "x*y - x^2 + 3",
        "x^3/(1 + y^2) + x^-2",
        "hypot(x, y)^0.7",
        "sin(50*x) + cos(40*y)*tan(20)",
        "cos(100*x)^2*sin(y)",
        "sqrt(abs(x)) + cbrt(y)",
        "if(x < y, x, 2*y)",
        "if(x >= y and not y > 1, sin(x), cos(y))",
        "if(x <= 0 or x != y, floor(x), ceil(y))",
        "min(x, y, 1)*max(x, -y)",
        "exp(x) - log(1 + abs(y)) + atan(x)",
        "atan2(y, x) + round(x) + sign(y)",
        "asin(x/5) + acos(y/5)",
        "x % 2 + y % (x^2 + 1)",
        "(x % 3)/9 + 2^y",
        "x/y",
        "tan(30*x)",
        "-x - -y",
        "log2(x) + log10(y)",
        "if(odd(x), 1, y)",
    ];

    proptest! {
        #[test]
        fn values_lie_in_the_range(
            text in proptest::sample::select(&TEXTS[..]),
            (x, y) in (-3.0..3.0f64, -3.0..3.0f64),
            (wide, high) in (0.0..2.0f64, 0.0..2.0f64),
            (left, down) in (0.0..1.0f64, 0.0..1.0f64),
            whole in any::<bool>(),
        ) {
            let [x, y] = if whole { [x.round(), y.round()] } else { [x, y] };
            let mut scope = Scope::new();
            scope.variable("x", 0);
            scope.variable("y", 1);
            let program = Expression::parse(text).unwrap().compile(&scope).unwrap();
            let slots = [
                Interval::new(x - left * wide, x + (1.0 - left) * wide),
                Interval::new(y - down * high, y + (1.0 - down) * high),
            ];
            let range = program.range(&slots);
            let value = program.eval(&[x, y]);
            let slack = 1e-12 * (1.0 + value.abs());
            let held = range.low - slack <= value && value <= range.high + slack;
            prop_assert!(held || value.is_nan(), "{text} = {value} is not in {range:?}");
        }
    }

    #[test]
    fn ranges_are_tight_where_each_slot_occurs_once() {
        let range = |text: &str, low: f64, high: f64| {
            let mut scope = Scope::new();
            scope.variable("x", 0);
            let program = Expression::parse(text).unwrap().compile(&scope).unwrap();
            let range = program.range(&[Interval::new(low, high)]);
            [range.low, range.high]
        };
        assert_eq!(range("sin(x)", 30.0, 135.0), [0.5, 1.0]);
        assert_eq!(range("cos(x)", 90.0, 300.0), [-1.0, 0.5]);
        assert_eq!(range("cos(x)", -400.0, 400.0), [-1.0, 1.0]);
        assert_eq!(range("x^2", -1.0, 3.0), [0.0, 9.0]);
        assert_eq!(range("1/x", 2.0, 4.0), [0.25, 0.5]);
        assert_eq!(range("1/x", -1.0, 4.0), [f64::NEG_INFINITY, f64::INFINITY]);
        assert_eq!(range("0*x", f64::NEG_INFINITY, f64::INFINITY), [0.0, 0.0]);
        assert_eq!(range("sqrt(x)", -1.0, 4.0), [0.0, 2.0]);
    }
}
