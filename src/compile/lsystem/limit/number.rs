//! Sums of roots of unity with dyadic factors: their values in long floating-point numbers, and their residues, which
//! decide whether they are 0.
//!
//! Headings are multiples of 1/q of a turn, so that displacements are elements of the ring Z[ζ, 1/2], ζ = exp(2πi/q). For
//! a prime p ≡ 1 (mod q), the map of ζ to an element of order q of the field of p elements is a homomorphism of the ring,
//! and an element that is not 0 has the residue 0 only if p divides its norm. With one prime near 2⁶¹, that does not
//! happen by chance (Schwartz 1980, "Fast probabilistic algorithms for verification of polynomial identities").

use std::collections::BTreeMap;
use std::ops::{Add, Mul, Sub};

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use dashu_int::IBig;
use dashu_int::ops::BitTest as _;

use crate::expression::Precision;
use crate::geometry::DVec2;
use crate::lsystem::Compass;

use super::prime::Field;

pub(super) type Float = FBig<HalfEven, 2>;

/// Complex number in long floating-point numbers.
#[derive(Clone, Debug)]
pub(super) struct Complex {
    pub(super) re: Float,
    pub(super) im: Float,
}

impl Complex {
    pub(super) fn real(value: f64, bits: usize) -> Self {
        let long = |value: f64| {
            let exact = Float::try_from(value).unwrap_or(Float::ZERO);
            exact.with_precision(bits).value()
        };
        Self {
            re: long(value),
            im: long(0.0),
        }
    }

    pub(super) fn of(value: DVec2, bits: usize) -> Self {
        Self {
            re: Self::real(value.x, bits).re,
            im: Self::real(value.y, bits).re,
        }
    }

    pub(super) fn conjugate(&self) -> Self {
        Self {
            re: self.re.clone(),
            im: -self.im.clone(),
        }
    }

    /// Returns the square of the absolute value.
    pub(super) fn norm(&self) -> Float {
        &self.re * &self.re + &self.im * &self.im
    }

    /// Returns the quotient; 0 if the divisor is 0.
    pub(super) fn over(&self, other: &Self) -> Self {
        let norm = other.norm();
        if norm == Float::ZERO {
            return Self::real(0.0, norm.precision());
        }
        let product = self * &other.conjugate();
        Self {
            re: product.re / &norm,
            im: product.im / norm,
        }
    }

    /// Returns the binary logarithm of the absolute value, approximately; −∞ for 0.
    pub(super) fn log2(&self) -> f64 {
        0.5 * log2(&self.norm())
    }

    /// Returns the number in doubles, divided by 2^`exponent`.
    pub(super) fn near(&self, exponent: isize) -> DVec2 {
        let near = |number: &Float| (number.clone() >> exponent).to_f64().value();
        DVec2::new(near(&self.re), near(&self.im))
    }

    /// Returns the number in multiples of 2^-`bits`.
    pub(super) fn fixed(&self, bits: usize) -> [IBig; 2] {
        let shift = isize::try_from(bits).unwrap_or(isize::MAX);
        [&self.re, &self.im].map(|number| (number.clone() << shift).to_int().value())
    }

    /// Returns the root of a degree that is nearest to a vector, by Newton's method.
    pub(super) fn root(&self, degree: u32, near: DVec2, bits: usize) -> Self {
        let mut root = Self::of(near, bits);
        let degree_less = Self::real(f64::from(degree - 1), bits);
        let whole = Self::real(f64::from(degree), bits);
        let mut right = 40;
        while right < 2 * bits {
            let power = root.power(degree - 1);
            root = (&(&degree_less * &root) + &self.over(&power)).over(&whole);
            right *= 2;
        }
        root
    }

    pub(super) fn power(&self, exponent: u32) -> Self {
        let mut power = Self::real(1.0, self.re.precision());
        for digit in (0..u32::BITS).rev() {
            power = &power * &power;
            if exponent >> digit & 1 == 1 {
                power = &power * self;
            }
        }
        power
    }
}

/// Returns the binary logarithm of a number, to some 50 bits; −∞ for 0.
pub(super) fn log2(number: &Float) -> f64 {
    if *number == Float::ZERO {
        return f64::NEG_INFINITY;
    }
    let repr = number.repr();
    let length = isize::try_from(repr.significand().bit_len()).unwrap_or(isize::MAX);
    let exponent = repr.exponent() + length;
    let near = (number.clone() >> exponent).to_f64().value();
    #[expect(clippy::cast_precision_loss, reason = "exponents are small")]
    let whole = exponent as f64;
    libm::log2(near.abs()) + whole
}

impl Add for &Complex {
    type Output = Complex;

    fn add(self, other: Self) -> Complex {
        Complex {
            re: &self.re + &other.re,
            im: &self.im + &other.im,
        }
    }
}

impl Sub for &Complex {
    type Output = Complex;

    fn sub(self, other: Self) -> Complex {
        Complex {
            re: &self.re - &other.re,
            im: &self.im - &other.im,
        }
    }
}

impl Mul for &Complex {
    type Output = Complex;

    fn mul(self, other: Self) -> Complex {
        Complex {
            re: &self.re * &other.re - &self.im * &other.im,
            im: &self.re * &other.im + &self.im * &other.re,
        }
    }
}

/// Number with its residue.
#[derive(Clone, Debug)]
pub(super) struct Number {
    residue: u64,
    pub(super) value: Complex,
}

impl Number {
    pub(super) fn is_zero(&self) -> bool {
        self.residue == 0
    }
}

/// Arithmetic of numbers with a precision.
pub(super) struct Numbers {
    compass: Compass,
    field: Field,
    precision: Precision,
    directions: BTreeMap<u64, Number>,
}

impl Numbers {
    /// Creates the arithmetic; `None` if headings are no multiples of one fraction of a turn.
    pub(super) fn new(compass: Compass, bits: usize) -> Option<Self> {
        Some(Self {
            compass,
            field: Field::with_roots(compass.parts())?,
            precision: Precision::new(bits),
            directions: BTreeMap::new(),
        })
    }

    pub(super) fn bits(&self) -> usize {
        self.precision.bits()
    }

    pub(super) fn compass(&self) -> Compass {
        self.compass
    }

    pub(super) fn real(&self, value: f64) -> Number {
        Number {
            residue: self.field.of(value),
            value: Complex::real(value, self.bits()),
        }
    }

    /// Returns the unit vector of a heading.
    pub(super) fn direction(&mut self, heading: u64) -> Number {
        if let Some(known) = self.directions.get(&heading) {
            return known.clone();
        }
        let bits = self.bits();
        let [re, im] = self.precision.direction(self.compass.fraction(heading));
        let long = |number: IBig| {
            let exponent = isize::try_from(bits).unwrap_or(isize::MAX);
            Float::from_parts(number, -exponent)
                .with_precision(bits)
                .value()
        };
        let direction = Number {
            residue: self.field.root(heading),
            value: Complex {
                re: long(re),
                im: long(im),
            },
        };
        self.directions.insert(heading, direction.clone());
        direction
    }

    pub(super) fn plus(&self, a: &Number, b: &Number) -> Number {
        Number {
            residue: self.field.sum(a.residue, b.residue),
            value: &a.value + &b.value,
        }
    }

    pub(super) fn minus(&self, a: &Number, b: &Number) -> Number {
        Number {
            residue: self.field.difference(a.residue, b.residue),
            value: &a.value - &b.value,
        }
    }

    pub(super) fn times(&self, a: &Number, b: &Number) -> Number {
        Number {
            residue: self.field.product(a.residue, b.residue),
            value: &a.value * &b.value,
        }
    }

    pub(super) fn over(&self, a: &Number, b: &Number) -> Number {
        Number {
            residue: self.field.product(a.residue, self.field.inverse(b.residue)),
            value: a.value.over(&b.value),
        }
    }
}
