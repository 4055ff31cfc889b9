//! Affine maps in whole numbers: as exact as they are long.

use dashu_int::IBig;
use dashu_int::ops::BitTest;

use crate::geometry::{DAffine2, DVec2, Direction};

/// A point or a vector, in whole multiples of a unit that the context tells.
pub(super) type Vector = [IBig; 2];

/// A map whose numbers are whole multiples of a power of two.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    /// Where (1, 0) and (0, 1) go, seen from where (0, 0) goes.
    pub(super) axes: [Vector; 2],
    /// Where (0, 0) goes.
    pub(super) origin: Vector,
}

impl Fixed {
    /// The map that changes nothing, in multiples of 2^-`bits`.
    pub(super) fn identity(bits: usize) -> Self {
        let (zero, one) = (|| IBig::ZERO, || IBig::ONE << bits);
        Self {
            axes: [[one(), zero()], [zero(), one()]],
            origin: [zero(), zero()],
        }
    }

    /// A rotation by an angle whose cosine and sine are given.
    pub(super) fn rotation([cosine, sine]: Vector, bits: usize) -> Self {
        Self {
            axes: [[cosine.clone(), sine.clone()], [-sine, cosine]],
            ..Self::identity(bits)
        }
    }

    /// As [`Frame::between`](crate::geometry::Frame::between).
    pub(super) fn between(from: &Vector, to: &Vector, direction: Direction) -> Self {
        let along = [&to[0] - &from[0], &to[1] - &from[1]];
        let across = [-&along[1], along[0].clone()];
        let minus = |[x, y]: &Vector| [-x, -y];
        let (axes, origin) = match direction {
            Direction::Normal => ([along, across], from),
            Direction::YReflected => ([along, minus(&across)], from),
            Direction::XReflected => ([minus(&along), across], to),
            Direction::BothReflected => ([minus(&along), minus(&across)], to),
        };
        Self {
            axes,
            origin: origin.clone(),
        }
    }

    /// What the linear part does to a vector in multiples of 2^-`bits`.
    fn turned(&self, [x, y]: &Vector, bits: usize) -> Vector {
        let [right, up] = &self.axes;
        [0, 1].map(|row| product(&right[row], x, bits) + product(&up[row], y, bits))
    }

    /// Where a point in multiples of 2^-`bits` goes.
    pub(super) fn image(&self, point: &Vector, bits: usize) -> Vector {
        let [x, y] = self.turned(point, bits);
        [x + &self.origin[0], y + &self.origin[1]]
    }

    /// This map after an inner one, whose numbers are multiples of 2^-`bits`. Similarities have half
    /// the work.
    pub(super) fn after(&self, inner: &Self, bits: usize, are_similar: bool) -> Self {
        let [right, up] = &inner.axes;
        let right = self.turned(right, bits);
        let up = if are_similar {
            // The axes are as long as each other; whether they keep the sense of rotation is told by
            // both maps.
            let across = [-&right[1], right[0].clone()];
            if self.is_mirrored() == inner.is_mirrored() {
                across
            } else {
                [-&across[0], -&across[1]]
            }
        } else {
            self.turned(up, bits)
        };
        Self {
            axes: [right, up],
            origin: self.image(&inner.origin, bits),
        }
    }

    /// Whether a similarity reverses the sense of rotation.
    fn is_mirrored(&self) -> bool {
        let [[a, b], [c, d]] = &self.axes;
        // (c, d) is (−b, a) or its opposite, give or take rounding: the larger number tells.
        if a.bit_len() >= b.bit_len() {
            a.sign() != d.sign()
        } else {
            b.sign() == c.sign()
        }
    }

    /// How long the numbers of its linear part are.
    pub(super) fn bits(&self) -> usize {
        let longest = self.axes.iter().flatten().map(|number| number.bit_len());
        longest.max().unwrap_or(0)
    }

    /// About the map in doubles, as a multiple of 2^`exponent` of its unit.
    pub(super) fn near(&self) -> (DAffine2, usize) {
        let [[a, b], [c, d]] = &self.axes;
        let [e, f] = &self.origin;
        let all = [a, b, c, d, e, f];
        let longest = all.map(|number| number.bit_len()).into_iter().max();
        let exponent = longest.unwrap_or(0).saturating_sub(DIGITS);
        let [a, b, c, d, e, f] = all.map(|number| double(&(number >> exponent)));
        let (right, up) = (DVec2::new(a, b), DVec2::new(c, d));
        (DAffine2::from_cols(right, up, DVec2::new(e, f)), exponent)
    }
}

/// Bits that are looked at for a double.
const DIGITS: usize = 96;

/// A number that is no longer than doubles reach.
pub(super) fn double(number: &IBig) -> f64 {
    number.to_f64().value()
}

/// A number times one in multiples of 2^-`bits`.
pub(super) fn product(number: &IBig, fraction: &IBig, bits: usize) -> IBig {
    // What is below the last digit of the product need not be worked out.
    const SPARE: usize = 64;
    let dropped = bits.saturating_sub(number.bit_len() + SPARE);
    if dropped > SPARE {
        (number * (fraction >> dropped)) >> (bits - dropped)
    } else {
        (number * fraction) >> bits
    }
}
