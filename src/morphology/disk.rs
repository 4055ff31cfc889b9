//! Structuring elements.

use crate::bits::Bits;

use super::shifts::{Both, step};

/// A family of disks that pictures are eroded and dilated by.
///
/// The discrete disk of size r is r D = D ⊕ … ⊕ D, r times; that of size 0 is one pixel (Libeskind-Hadas & Maragos
/// 1987).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DiskFamily {
    /// D is a pixel and its four neighbours: r D are the pixels with |x| + |y| ≤ r.
    Plus,
    /// D is a square of 3 × 3 pixels: r D are the pixels with |x| ≤ r and |y| ≤ r.
    Square,
    /// D is a square of 5 × 5 pixels without its corners, the sum of plus and square: r D are octagons that reach
    /// 2 r pixels to each side.
    Octagon,
    /// The pixels whose centres are at most as far away as the radius.
    #[default]
    Euclid,
}

impl DiskFamily {
    /// All families.
    pub const ALL: [Self; 4] = [Self::Plus, Self::Square, Self::Octagon, Self::Euclid];

    /// Returns the name of the family.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plus => "plus",
            Self::Square => "square",
            Self::Octagon => "octagon",
            Self::Euclid => "euclid",
        }
    }

    /// Returns the number of pixels to which a disk of a size reaches in each direction.
    pub(super) fn reach(self, size: f64) -> usize {
        let size = crate::saturating::whole(size);
        match self {
            Self::Octagon => size.saturating_mul(2),
            _ => size,
        }
    }

    /// Erodes or dilates by the discrete disk D once; what is dilated beyond the picture is cut off.
    ///
    /// `spare` is memory of the same size.
    pub(super) fn once(self, both: Both, bits: &mut Bits, spare: &mut Bits) {
        let (plus, square) = match self {
            Self::Plus => (true, false),
            Self::Square => (false, true),
            Self::Octagon | Self::Euclid => (true, true),
        };
        if plus {
            step(both, false, bits, spare);
            std::mem::swap(bits, spare);
        }
        if square {
            step(both, true, bits, spare);
            std::mem::swap(bits, spare);
        }
    }
}
