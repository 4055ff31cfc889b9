//! Colours and widths as parts of the identity of objects.

use crate::geometry::Frame;
use crate::graph::Object;
use crate::instancing::Thickness;
use crate::style::Palette;

use super::state::StrokeAttributes;

/// Colour of an object, and its change of stroke widths or a width that is set.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Paint {
    pub(super) colour: i64,
    /// Bits of the width, and whether it is set rather than multiplied.
    thickness: (u64, bool),
}

impl Paint {
    /// Returns the paint of an object with stroke attributes relative to an earlier colour. `palette` is that of a system
    /// whose symbols change colours.
    pub(super) fn of(
        palette: Option<&Palette>,
        attributes: StrokeAttributes,
        earlier: i64,
    ) -> Self {
        let (width, sets) = match attributes.width {
            Thickness::Times(width) => (width, false),
            Thickness::Set(width) => (width, true),
        };
        let mut colour = 0;
        if let Some(palette) = palette {
            let colours = i64::try_from(palette.entries()).unwrap_or(i64::MAX);
            colour = attributes.colour.from(earlier).rem_euclid(colours);
        }
        Self {
            colour,
            thickness: (width.to_bits(), sets),
        }
    }

    /// Returns an object with this paint that is never replaced.
    pub(super) fn object<F: Frame>(
        self,
        palette: Option<&Palette>,
        base_element: usize,
    ) -> Object<F> {
        let width = f64::from_bits(self.thickness.0);
        Object {
            paint: palette.map(|palette| palette.entry(self.colour)),
            thickness: if self.thickness.1 {
                Some(Thickness::Set(width))
            } else {
                Some(Thickness::Times(width)).filter(|_| width != 1.0)
            },
            ..Object::kept(base_element)
        }
    }
}
