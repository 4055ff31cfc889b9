//! Affine maps in integers of arbitrary length.

use dashu_int::IBig;
use dashu_int::ops::BitTest;

use crate::expression::{AffineOf, Precise, leading};
use crate::geometry::{DAffine2, Direction};

/// Point or vector, in integer multiples of a unit that depends on the context.
pub(super) type Vector = [IBig; 2];

/// Affine map whose numbers are integer multiples of a power of two.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    /// Images of the vectors (1, 0) and (0, 1) under the linear part.
    pub(super) axes: [Vector; 2],
    /// Image of (0, 0).
    pub(super) origin: Vector,
}

impl Fixed {
    /// Returns the identity, in multiples of 2^-`bits`.
    pub(super) fn identity(bits: usize) -> Self {
        let (zero, one) = (|| IBig::ZERO, || IBig::ONE << bits);
        Self {
            axes: [[one(), zero()], [zero(), one()]],
            origin: [zero(), zero()],
        }
    }

    /// Returns a map in multiples of 2^-`bits`.
    pub(super) fn of(map: &AffineOf<Precise>, bits: usize) -> Self {
        let AffineOf { axes, origin } = map.map(|number| number.fixed(bits));
        Self { axes, origin }
    }

    /// Returns the map of an element; see [`Frame2::between`](crate::geometry::Frame2::between).
    pub(super) fn between(from: &Vector, to: &Vector, direction: Direction) -> Self {
        let along = [&to[0] - &from[0], &to[1] - &from[1]];
        let across = [-&along[1], along[0].clone()];
        let minus = |[x, y]: &Vector| [-x, -y];
        let [x, y, _] = direction.reflected();
        let (along, origin) = match x {
            true => (minus(&along), to),
            false => (along, from),
        };
        let across = if y { minus(&across) } else { across };
        Self {
            axes: [along, across],
            origin: origin.clone(),
        }
    }

    /// Returns the image of a vector in multiples of 2^-`bits` under the linear part.
    fn turned(&self, [x, y]: &Vector, bits: usize) -> Vector {
        let [right, up] = &self.axes;
        [0, 1].map(|row| product(&right[row], x, bits) + product(&up[row], y, bits))
    }

    /// Returns the image of a point in multiples of 2^-`bits`.
    pub(super) fn image(&self, point: &Vector, bits: usize) -> Vector {
        let [x, y] = self.turned(point, bits);
        [x + &self.origin[0], y + &self.origin[1]]
    }

    /// Composes this map with an inner one, whose numbers are multiples of 2^-`bits`. For similarities
    /// (`are_similar`) this takes half the work.
    pub(super) fn after(&self, inner: &Self, bits: usize, are_similar: bool) -> Self {
        let [right, up] = &inner.axes;
        let right = self.turned(right, bits);
        let up = if are_similar {
            // The axes have equal lengths, and both maps determine the orientation.
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

    /// Returns whether a similarity reverses orientation.
    fn is_mirrored(&self) -> bool {
        let [[a, b], [c, d]] = &self.axes;
        // (c, d) is (−b, a) or its negative, up to rounding: the larger number decides.
        if a.bit_len() >= b.bit_len() {
            a.sign() != d.sign()
        } else {
            b.sign() == c.sign()
        }
    }

    /// Returns the number of bits of the linear part.
    pub(super) fn bits(&self) -> usize {
        let longest = self.axes.iter().flatten().map(|number| number.bit_len());
        longest.max().unwrap_or(0)
    }

    /// Returns the map in doubles, approximately, as a multiple of 2^`exponent` of its unit, and that
    /// exponent.
    pub(super) fn near(&self) -> (DAffine2, usize) {
        let [right, up] = &self.axes;
        let (near, exponent) = leading([right, up, &self.origin].into_iter().flatten());
        let mut map = [0.0; 6];
        map.iter_mut()
            .zip(near)
            .for_each(|(number, near)| *number = near);
        (DAffine2::from_cols_array(&map), exponent)
    }
}

/// Returns the product of an integer and a number in multiples of 2^-`bits`.
pub(super) fn product(number: &IBig, fraction: &IBig, bits: usize) -> IBig {
    // Digits below the last one of the product need not be computed.
    const SPARE: usize = 64;
    let dropped = bits.saturating_sub(number.bit_len() + SPARE);
    if dropped > SPARE {
        (number * (fraction >> dropped)) >> (bits - dropped)
    } else {
        (number * fraction) >> bits
    }
}
