//! Evaluation of programs to arbitrary precision, where doubles do not suffice.

use std::str::FromStr;

use dashu_float::round::mode::HalfEven;
use dashu_float::{ConstCache, Context, DBig, FBig, FpError, Repr};
use dashu_int::IBig;
use dashu_int::ops::BitTest;

use super::circle::Circle;
use super::operator::{One, Two};
use super::program::{Arithmetic, Evaluation, Program};
use super::scope::Constant;

type Float = FBig<HalfEven, 2>;
type Computed = Result<dashu_float::round::Rounded<Float>, FpError>;

/// A number to arbitrary precision, with the double that represents it elsewhere.
///
/// Conditions, roundings and remainders are decided by the double, hence in the same way as in
/// programs.
#[derive(Clone, Debug)]
pub(crate) struct Precise {
    near: f64,
    exact: Float,
}

impl Precise {
    /// Returns the exact value of a double; 0 for one that is not finite.
    pub(crate) fn of(near: f64) -> Self {
        let finite = if near.is_finite() { near } else { 0.0 };
        let exact = Float::try_from(finite).unwrap_or(Float::ZERO);
        Self { near, exact }
    }

    #[cfg(test)]
    pub(crate) fn near(&self) -> f64 {
        self.near
    }

    /// Returns the number times 2^`bits`, rounded to an integer.
    pub(crate) fn fixed(&self, bits: usize) -> IBig {
        let shift = isize::try_from(bits).unwrap_or(isize::MAX);
        (self.exact.clone() << shift).to_int().value()
    }
}

/// Converts integers to doubles by their leading bits: multiples of 2^`exponent`, with that exponent.
pub(crate) fn leading<'n>(
    numbers: impl Iterator<Item = &'n IBig> + Clone,
) -> (impl Iterator<Item = f64>, usize) {
    /// Number of bits that are converted.
    const DIGITS: usize = 96;
    let longest = numbers.clone().map(BitTest::bit_len).max();
    let exponent = longest.unwrap_or(0).saturating_sub(DIGITS);
    let leading = numbers.map(move |number| (number >> exponent).to_f64().value());
    (leading, exponent)
}

/// Arithmetic of numbers of a fixed number of bits.
pub(crate) struct Precision {
    bits: usize,
    /// Values of the parameters.
    parameters: Vec<Precise>,
    context: Context<HalfEven>,
    cache: ConstCache,
    circle: Circle,
}

/// Guard bits for the cancellation in differences of nearly equal numbers.
const GUARD: usize = 64;

impl Precision {
    pub(crate) fn new(bits: usize) -> Self {
        Self {
            bits,
            parameters: Vec::new(),
            context: Context::new(bits + GUARD),
            cache: ConstCache::new(),
            circle: Circle::default(),
        }
    }

    /// Evaluates parameters, each of which depends only on those before it, for programs that read them.
    pub(crate) fn set_parameters(&mut self, programs: &[Program]) {
        for program in programs {
            let value = program.evaluate(self, &[]);
            self.parameters.push(value);
        }
    }

    /// Reduces the precision of the following evaluations to `bits`, if that is less than the original
    /// precision.
    pub(crate) fn make_do_with(&mut self, bits: usize) {
        self.context = Context::new(bits.min(self.bits) + GUARD);
    }

    /// Returns the number that a decimal of any length stands for.
    pub(crate) fn digits(&self, text: &str) -> Precise {
        let near = text.parse().unwrap_or(0.0);
        self.of_digits(near, text)
    }

    fn of_digits(&self, near: f64, text: &str) -> Precise {
        let precision = self.context.precision();
        let exact = DBig::from_str(text).map(|decimal| {
            let binary = decimal.with_base_and_precision::<2>(precision).value();
            binary.with_rounding::<HalfEven>()
        });
        match exact {
            Ok(exact) if near.is_finite() => Precise { near, exact },
            _ => Precise::of(near),
        }
    }

    /// Returns the original precision in bits.
    pub(crate) fn bits(&self) -> usize {
        self.bits
    }

    /// Returns the result of a computation, or the exact value of the double if the computation fails,
    /// as at the end of the exponent range.
    fn known(
        &mut self,
        near: f64,
        compute: impl FnOnce(&Context<HalfEven>, &mut ConstCache) -> Computed,
    ) -> Precise {
        if !near.is_finite() {
            return Precise::of(near);
        }
        match compute(&self.context, &mut self.cache).map(|value| value.value()) {
            Ok(exact) if !exact.repr().is_infinite() => Precise { near, exact },
            _ => Precise::of(near),
        }
    }

    /// Computes cosine and sine of a fraction of a turn, in multiples of 2^-bits.
    pub(crate) fn direction(&mut self, [numerator, denominator]: [u128; 2]) -> [IBig; 2] {
        let [above, below] = [numerator * 360, denominator].map(Float::from);
        let angle = self.context.div(above.repr(), below.repr());
        let exact = angle.map_or(Float::ZERO, |angle| angle.value());
        #[expect(clippy::cast_precision_loss, reason = "it stands for the exact one")]
        let near = (numerator * 360) as f64 / denominator as f64;
        self.turn(&Precise { near, exact })
            .map(|number| number.fixed(self.bits))
    }

    fn power(&mut self, near: f64, a: &Precise, b: &Precise) -> Precise {
        const MOST: f64 = 1e6;
        let (base, exponent) = (a.exact.repr(), b.exact.repr());
        if b.near.fract() == 0.0 && b.near.abs() <= MOST {
            let whole = Precise::of(b.near).fixed(0);
            return self.known(near, |context, _| context.powi(base, whole));
        }
        if b.near == 0.5 {
            return self.known(near, |context, _| context.sqrt(base));
        }
        self.known(near, |context, cache| {
            context.powf(base, exponent, Some(cache))
        })
    }
}

impl Arithmetic for Precision {
    type Number = Precise;

    /// Interprets a double as the shortest decimal that rounds to it: 0.1 is exactly one tenth.
    fn decimal(&mut self, near: f64) -> Precise {
        self.of_digits(near, &near.to_string())
    }

    fn one(&mut self, operation: One, x: &Precise) -> Precise {
        let near = operation.apply(x.near);
        let of: &Repr<2> = x.exact.repr();
        match operation {
            One::Negate => Precise {
                near,
                exact: -x.exact.clone(),
            },
            One::Abs if x.near < 0.0 => Precise {
                near,
                exact: -x.exact.clone(),
            },
            One::Abs => x.clone(),
            One::Sqrt => self.known(near, |context, _| context.sqrt(of)),
            One::Cbrt => self.known(near, |context, _| context.cbrt(of)),
            One::Exp => self.known(near, |context, cache| context.exp(of, Some(cache))),
            One::Ln => self.known(near, |context, cache| context.ln(of, Some(cache))),
            One::Log2 => self.known(near, |context, cache| context.log2(of, Some(cache))),
            One::Log10 => self.known(near, |context, cache| context.log10(of, Some(cache))),
            One::Sin | One::Cos => {
                let bits = self.context.precision();
                let cache = &mut self.cache;
                if let Some(pair) = self.circle.sine_cosine(x.near, &x.exact, bits, cache) {
                    let [sine, cosine] = pair;
                    let is_sine = operation == One::Sin;
                    let exact = if is_sine { sine } else { cosine };
                    return Precise { near, exact };
                }
                self.known(near, |context, cache| match operation {
                    One::Sin => context.sin_unit(of, 360, Some(cache)),
                    _ => context.cos_unit(of, 360, Some(cache)),
                })
            }
            One::Tan => self.known(near, |context, cache| {
                context.tan_unit(of, 360, Some(cache))
            }),
            One::Asin => self.known(near, |context, cache| {
                context.asin_unit(of, 360, Some(cache))
            }),
            One::Acos => self.known(near, |context, cache| {
                context.acos_unit(of, 360, Some(cache))
            }),
            One::Atan => self.known(near, |context, cache| {
                context.atan_unit(of, 360, Some(cache))
            }),
            One::Not | One::Sign | One::Floor | One::Ceil | One::Round | One::Odd | One::Even => {
                Precise::of(near)
            }
        }
    }

    fn two(&mut self, operation: Two, a: &Precise, b: &Precise) -> Precise {
        let near = operation.apply(a.near, b.near);
        let (left, right) = (a.exact.repr(), b.exact.repr());
        match operation {
            Two::Add => self.known(near, |context, _| context.add(left, right)),
            Two::Subtract => self.known(near, |context, _| context.sub(left, right)),
            Two::Multiply => self.known(near, |context, _| context.mul(left, right)),
            Two::Divide => self.known(near, |context, _| context.div(left, right)),
            Two::Modulo => {
                let times = Precise::of(((a.near - near) / b.near).round());
                let whole = self.two(Two::Multiply, &times, b);
                let rest = self.two(Two::Subtract, a, &whole);
                Precise { near, ..rest }
            }
            Two::Power => self.power(near, a, b),
            Two::Min | Two::Max if near.to_bits() == a.near.to_bits() => a.clone(),
            Two::Min | Two::Max => b.clone(),
            Two::Hypot => self.known(near, |context, _| context.hypot(left, right)),
            Two::Atan2 => self.known(near, |context, cache| {
                context.atan2_unit(left, right, 360, Some(cache))
            }),
            Two::Or
            | Two::And
            | Two::Less
            | Two::LessEqual
            | Two::Greater
            | Two::GreaterEqual
            | Two::Equal
            | Two::NotEqual => Precise::of(near),
        }
    }
}

impl Evaluation for Precision {
    const UNFOLDED: bool = true;

    fn unknown(&mut self) -> Precise {
        Precise::of(f64::NAN)
    }

    fn named(&mut self, constant: Constant) -> Precise {
        let near = constant.value();
        match constant {
            Constant::Pi => Precise {
                near,
                exact: self.context.pi(Some(&mut self.cache)).value(),
            },
            Constant::E => self.known(near, |context, cache| {
                context.exp(Float::ONE.repr(), Some(cache))
            }),
            Constant::Phi => {
                let root = self.two(Two::Power, &Precise::of(5.0), &Precise::of(0.5));
                let sum = self.two(Two::Add, &root, &Precise::of(1.0));
                let ratio = self.two(Two::Divide, &sum, &Precise::of(2.0));
                Precise { near, ..ratio }
            }
        }
    }

    fn parameter(&mut self, number: usize) -> Precise {
        let value = self.parameters.get(number).cloned();
        value.unwrap_or_else(|| self.unknown())
    }

    fn select(&mut self, condition: &Precise, [then, otherwise]: [&Precise; 2]) -> Precise {
        let chosen = if condition.near == 0.0 {
            otherwise
        } else {
            then
        };
        chosen.clone()
    }
}

#[cfg(test)]
mod tests {
    use dashu_int::ops::BitTest;

    use super::{Precise, Precision};
    use crate::expression::{Expression, Scope};

    /// Evaluates a text to 300 bits, for a slot `x`.
    fn value(text: &str) -> Precise {
        let mut scope = Scope::new();
        scope.variable("x", 0);
        let program = Expression::parse(text).unwrap().compile(&scope).unwrap();
        program.evaluate(&mut Precision::new(300), &[Precise::of(0.1)])
    }

    #[test]
    fn what_is_nothing_is_nothing_to_all_bits() {
        for text in [
            "1/3*3 - 1",
            "0.1*3 - 0.3",
            "sqrt(3)^2 - 3",
            "5^0.5 - sqrt(5)",
            "2^(1/3) - cbrt(2)",
            "phi^2 - phi - 1",
            "ln(e) - 1",
            "exp(ln(7)) - 7",
            "log2(8) - 3 + log10(100) - 2",
            "sin(10)^2 + cos(10)^2 - 1",
            "sin(60) - sqrt(3)/2",
            "tan(45) - 1",
            "atan(tan(33)) - 33",
            "asin(sin(17)) + acos(cos(19)) - 36",
            "atan2(1, sqrt(3)) - 30",
            "hypot(3, 4) - 5",
            "cos(36) - phi/2",
            "7/3 % 1 - 1/3",
            "min(1/3, 1/2) - abs(-1/3)",
            "if(1/3 < 0.34, 1/3, 1) - 1/3",
            "sin(30) - 1/2 + pi - 180*pi/180",
        ] {
            let left = value(text).fixed(300).bit_len();
            assert!(left < 24, "{text}: {left} bits");
        }
        // A bound name has the exact value of its double, not that of its decimal notation.
        assert!(value("x - 0.1").fixed(300).bit_len() > 200);
    }

    #[test]
    fn what_doubles_say_is_said_to_all_bits() {
        for text in [
            "sqrt(2) + ln(3) - pi/e",
            "floor(7.5) + ceil(1/3) + round(2.5) + sign(-3)",
            "if(odd(3) and not even(3), 2^-0.3, 0)",
            "-2^2 + 3 % -2 + max(1, 2, 3)",
            "acos(1/3)*asin(-1/3)*exp(-1/2)",
        ] {
            let program = Expression::parse(text).unwrap();
            let double = program.compile(&Scope::new()).unwrap().eval(&[]);
            let exact = value(text);
            assert_eq!(exact.near.to_bits(), double.to_bits(), "{text}");
            let apart = (exact.exact.to_f64().value() - double).abs();
            assert!(apart <= 1e-14 * double.abs(), "{text}: {apart}");
        }
    }

    #[test]
    fn what_has_no_value_is_what_doubles_say() {
        for text in ["1/(x - x)", "ln(x - x)", "10^(10^(3000*x))", "sqrt(0 - x)"] {
            assert!(!value(text).near.is_finite(), "{text}");
        }
    }
}
