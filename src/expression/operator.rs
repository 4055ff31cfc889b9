//! Semantics, types and precedence of the operators and functions of one and two arguments.
//!
//! Constant folding and evaluation use the same definitions. Conditions are represented by 1.0 and 0.0.

use super::Type;
use super::degrees;

/// Lowest precedence, that of whole expressions and of parenthesized ones.
pub(super) const LOOSEST: u8 = 1;
pub(super) const NOT: u8 = 3;
const COMPARISON: u8 = 4;
pub(super) const NEGATE: u8 = 7;
pub(super) const POWER: u8 = 8;
/// Highest precedence, of expressions that never need parentheses.
pub(super) const ATOM: u8 = 9;

/// A unary operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum One {
    Negate,
    Not,
    Sqrt,
    Cbrt,
    Abs,
    Sign,
    Floor,
    Ceil,
    Round,
    Exp,
    Ln,
    Log2,
    Log10,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Odd,
    Even,
}

impl One {
    #[inline]
    pub(super) fn apply(self, x: f64) -> f64 {
        match self {
            Self::Negate => -x,
            Self::Not => truth(x == 0.0),
            Self::Sqrt => x.sqrt(),
            Self::Cbrt => libm::cbrt(x),
            Self::Abs => x.abs(),
            Self::Sign if x == 0.0 => 0.0,
            Self::Sign => x.signum(),
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
            Self::Round => x.round(),
            Self::Exp => libm::exp(x),
            Self::Ln => libm::log(x),
            Self::Log2 => libm::log2(x),
            Self::Log10 => libm::log10(x),
            Self::Sin => degrees::sin(x),
            Self::Cos => degrees::cos(x),
            Self::Tan => degrees::tan(x),
            Self::Asin => degrees::asin(x),
            Self::Acos => degrees::acos(x),
            Self::Atan => degrees::atan(x),
            Self::Odd => truth(modulo(x, 2.0) == 1.0),
            Self::Even => truth(modulo(x, 2.0) == 0.0),
        }
    }

    pub(super) fn takes(self) -> Type {
        match self {
            Self::Not => Type::Condition,
            _ => Type::Number,
        }
    }

    pub(super) fn yields(self) -> Type {
        match self {
            Self::Not | Self::Odd | Self::Even => Type::Condition,
            _ => Type::Number,
        }
    }

    /// Returns the precedence of a prefix operator, or [`ATOM`] for a function.
    pub(super) fn precedence(self) -> u8 {
        match self {
            Self::Not => NOT,
            Self::Negate => NEGATE,
            _ => ATOM,
        }
    }
}

/// A binary operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Two {
    Or,
    And,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
    Power,
    Min,
    Max,
    Hypot,
    Atan2,
}

impl Two {
    #[inline]
    pub(super) fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Or => truth(a != 0.0 || b != 0.0),
            Self::And => truth(a != 0.0 && b != 0.0),
            Self::Less => truth(a < b),
            Self::LessEqual => truth(a <= b),
            Self::Greater => truth(a > b),
            Self::GreaterEqual => truth(a >= b),
            Self::Equal => truth(a == b),
            Self::NotEqual => truth(a != b),
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Modulo => modulo(a, b),
            Self::Power => power(a, b),
            // Unlike `f64::min`, these propagate a NaN, which the caller checks for.
            Self::Min if a < b || a.is_nan() => a,
            Self::Max if a > b || a.is_nan() => a,
            Self::Min | Self::Max => b,
            Self::Hypot => libm::hypot(a, b),
            Self::Atan2 => degrees::atan2(a, b),
        }
    }

    pub(super) fn takes(self) -> Type {
        match self {
            Self::Or | Self::And => Type::Condition,
            _ => Type::Number,
        }
    }

    pub(super) fn yields(self) -> Type {
        if self.takes() == Type::Condition || self.is_comparison() {
            Type::Condition
        } else {
            Type::Number
        }
    }

    pub(super) fn is_comparison(self) -> bool {
        self.precedence() == COMPARISON
    }

    /// Returns the precedence of an infix operator, or [`ATOM`] for a function.
    pub(super) fn precedence(self) -> u8 {
        match self {
            Self::Or => LOOSEST,
            Self::And => 2,
            Self::Less
            | Self::LessEqual
            | Self::Greater
            | Self::GreaterEqual
            | Self::Equal
            | Self::NotEqual => COMPARISON,
            Self::Add | Self::Subtract => 5,
            Self::Multiply | Self::Divide | Self::Modulo => 6,
            Self::Power => POWER,
            Self::Min | Self::Max | Self::Hypot | Self::Atan2 => ATOM,
        }
    }

    /// Returns the notation between the operands, with white space.
    pub(super) fn symbol(self) -> &'static str {
        match self {
            Self::Or => " or ",
            Self::And => " and ",
            Self::Less => " < ",
            Self::LessEqual => " <= ",
            Self::Greater => " > ",
            Self::GreaterEqual => " >= ",
            Self::Equal => " == ",
            Self::NotEqual => " != ",
            Self::Add => " + ",
            Self::Subtract => " - ",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Modulo => " % ",
            Self::Power => "^",
            Self::Min | Self::Max | Self::Hypot | Self::Atan2 => ", ",
        }
    }
}

fn truth(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

/// Computes the remainder of `x` modulo `c` with the sign of `c`: `x - c*floor(x/c)`, but rounded at
/// most once.
#[inline]
pub(super) fn modulo(x: f64, c: f64) -> f64 {
    let remainder = if is_small_whole(x) && is_small_whole(c) && c != 0.0 {
        // Exact except for the quotient, which may be off by one; several times as fast as `%`.
        x - nearest_whole(x / c) * c
    } else {
        // The remainder of IEEE numbers is exact, hence equal on every machine.
        x % c
    };
    if remainder != 0.0 && (remainder < 0.0) != (c < 0.0) {
        remainder + c
    } else {
        // Avoids the -0 that negative multiples of `c` would give.
        remainder + 0.0
    }
}

/// Returns whether `x` is an integer of magnitude below 2^50.
fn is_small_whole(x: f64) -> bool {
    x.abs() < 1_125_899_906_842_624.0 && nearest_whole(x) == x
}

/// Rounds `x`, of magnitude below 2^51, to a nearest integer, without a function call, unlike
/// `f64::round`.
fn nearest_whole(x: f64) -> f64 {
    // Doubles from 2^52 to 2^53 are integers; this constant is the middle of that range.
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    (x + WHOLE) - WHOLE
}

/// Computes `x` to the power `y`.
///
/// Integral exponents of magnitude up to 64 use repeated squaring in a fixed order, so that `x^2` is
/// `x*x` to the bit and `x^-n` is `1/x^n`. `x^0.5` is the square root. All other powers are
/// `libm::pow`.
// Inlining would take registers from the loop that evaluates programs.
#[inline(never)]
fn power(x: f64, y: f64) -> f64 {
    if y == 0.5 {
        return x.sqrt();
    }
    if y.fract() != 0.0 || y.abs() > 64.0 {
        return libm::pow(x, y);
    }
    let (mut product, mut square, mut left) = (1.0, x, y.abs());
    while left > 0.0 {
        let half = (left / 2.0).floor();
        if half + half != left {
            product *= square;
        }
        square *= square;
        left = half;
    }
    if y < 0.0 { 1.0 / product } else { product }
}
