//! The directions of a base element, a Klein four-group in the plane and an elementary group of order 8 in space.

use std::ops::Mul;

/// The direction of a base element (Kaandorp 1987, figures 9 and 11).
///
/// Directions are reflections of the unit frame, in which an element runs from (0, 0, 0) to (1, 0, 0). The number of
/// a direction less 1 has a bit for each coordinate: 1 if y, 2 if x, 4 if z is reflected, where x becomes 1 − x.
/// With z = x + iy, those of the plane are τ₁(z) = z, τ₂(z) = z̄, τ₃(z) = 1 − z̄ and τ₄(z) = 1 − z. Directions multiply
/// by the exclusive or of their bits: 2·3 = 4, and each is its own inverse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// 1: the identity.
    #[default]
    Normal,
    /// 2: y is reflected; the element swaps its sides.
    YReflected,
    /// 3: x is reflected; the element keeps its sides and is traversed backwards.
    XReflected,
    /// 4: both are reflected: a half turn; the element swaps its sides and is traversed backwards.
    BothReflected,
    /// 5: z is reflected; the front becomes the back.
    ZReflected,
    /// 6: y and z are reflected: a half turn about the element.
    YZReflected,
    /// 7: x and z are reflected: a half turn about the y axis; the element is traversed backwards.
    XZReflected,
    /// 8: all are reflected; the element is traversed backwards.
    AllReflected,
}

impl Direction {
    /// The eight directions, in the order of their numbers; the first four are those of the plane.
    pub const ALL: [Self; 8] = [
        Self::Normal,
        Self::YReflected,
        Self::XReflected,
        Self::BothReflected,
        Self::ZReflected,
        Self::YZReflected,
        Self::XZReflected,
        Self::AllReflected,
    ];

    /// Returns the direction with a number from 1 to 8, and `None` for other numbers.
    #[must_use]
    pub fn from_number(number: u32) -> Option<Self> {
        let index = usize::try_from(number.checked_sub(1)?).ok()?;
        Self::ALL.get(index).copied()
    }

    /// Returns the number of the direction, 1 to 8.
    #[must_use]
    pub fn number(self) -> u8 {
        self as u8 + 1
    }

    /// Returns the coordinates that are reflected: x, y and z.
    #[must_use]
    pub fn reflected(self) -> [bool; 3] {
        let bits = self as u8;
        [bits & 2 != 0, bits & 1 != 0, bits & 4 != 0]
    }

    /// Returns `true` if τ reverses the sense of rotation (directions 2, 3, 5 and 8).
    #[must_use]
    pub fn is_mirrored(self) -> bool {
        (self as u8).count_ones() % 2 == 1
    }

    /// Returns `true` if children are traversed in reverse order, each backwards (directions 3, 4, 7 and 8).
    #[must_use]
    pub fn is_reversed(self) -> bool {
        self as u8 & 2 != 0
    }
}

impl Mul for Direction {
    type Output = Self;

    #[expect(
        clippy::suspicious_arithmetic_impl,
        reason = "the group is addition without carry of three bits"
    )]
    fn mul(self, other: Self) -> Self {
        Self::ALL[(self as usize) ^ (other as usize)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_multiply_like_reflections_of_the_unit_frame() {
        for first in Direction::ALL {
            assert_eq!(Direction::from_number(first.number().into()), Some(first));
            for second in Direction::ALL {
                let product = first * second;
                let [a, b] = [first.reflected(), second.reflected()];
                let both = [0, 1, 2].map(|axis: usize| a[axis] != b[axis]);
                assert_eq!(product.reflected(), both);
                assert_eq!(
                    product.is_mirrored(),
                    first.is_mirrored() != second.is_mirrored()
                );
            }
        }
        let numbers = |test: fn(Direction) -> bool| {
            let all = Direction::ALL.into_iter().filter(|it| test(*it));
            all.map(Direction::number).collect::<Vec<_>>()
        };
        assert_eq!(numbers(Direction::is_reversed), [3, 4, 7, 8]);
        assert_eq!(numbers(Direction::is_mirrored), [2, 3, 5, 8]);
        assert_eq!(Direction::from_number(9), None);
    }
}
