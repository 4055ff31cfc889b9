//! The four directions of a base element, a Klein four-group under multiplication.

use std::ops::Mul;

/// The direction of a base element (Kaandorp 1987, figures 9 and 11).
///
/// Directions are reflections of the unit frame, in which an element runs from (0, 0) to (1, 0); with z = x +
/// iy they are τ₁(z) = z, τ₂(z) = z̄, τ₃(z) = 1 − z̄ and τ₄(z) = 1 − z. Directions multiply like the Klein
/// four-group: 2·3 = 4, and each is its own inverse.
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
}

impl Direction {
    /// The four directions, in the order of their numbers.
    pub const ALL: [Self; 4] = [
        Self::Normal,
        Self::YReflected,
        Self::XReflected,
        Self::BothReflected,
    ];

    /// Returns the direction with a number from 1 to 4, and `None` for other numbers.
    #[must_use]
    pub fn from_number(number: u32) -> Option<Self> {
        let index = usize::try_from(number.checked_sub(1)?).ok()?;
        Self::ALL.get(index).copied()
    }

    /// Returns the number of the direction, 1 to 4.
    #[must_use]
    pub fn number(self) -> u8 {
        self as u8 + 1
    }

    /// Returns `true` if τ reverses the sense of rotation (directions 2 and 3).
    #[must_use]
    pub fn is_mirrored(self) -> bool {
        matches!(self, Self::YReflected | Self::XReflected)
    }

    /// Returns `true` if children are traversed in reverse order, each backwards (directions 3 and 4).
    #[must_use]
    pub fn is_reversed(self) -> bool {
        matches!(self, Self::XReflected | Self::BothReflected)
    }
}

impl Mul for Direction {
    type Output = Self;

    #[expect(
        clippy::suspicious_arithmetic_impl,
        reason = "the Klein four-group is addition without carry of two bits"
    )]
    fn mul(self, other: Self) -> Self {
        Self::ALL[(self as usize) ^ (other as usize)]
    }
}
