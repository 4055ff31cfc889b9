//! Attributes of elements that determine their colours.

use super::Named;

/// Attribute of an element that determines its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ColorBy {
    /// No attribute: all elements have one colour.
    #[default]
    None,
    /// Step in which the element was born.
    Step,
    /// Age of the element's fractal.
    Age,
    /// Number of the element's fractal.
    Fractal,
    /// Rank of the element in its fractal.
    Index,
    /// Generator from which the element comes; the initiator counts as the first class.
    Generator,
    /// Direction of the element.
    Direction,
    /// The map of a system that is applied first (innermost).
    FirstMap,
    /// The map of a system that is applied last (outermost), which shows the tiling.
    LastMap,
    /// Number of hits of a pixel in random iteration. Approximants are drawn in one colour.
    Hits,
    /// Tints of the objects of a structure, or colours that the turtle of an L-system sets.
    Tint,
    /// In space: the height of the normal of a face, from downwards to upwards. In the plane there is one colour.
    Normal,
    /// In the plane: the angle of an element to the x axis, counter-clockwise.
    Angle,
    /// In the plane: the length of an element, by equal ratios.
    Length,
    /// In the plane: the place of an element across the picture.
    X,
    /// In the plane: the place of an element up the picture.
    Y,
    /// In the plane: the distance of an element from the centre of the picture.
    Distance,
}

/// Property that determines the class of an element by colour: all that rooms beside `render::Classes` need to know of a
/// [`ColorBy`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ColorProperty {
    /// There is one class.
    Uniform,
    /// There is one class, and objects have colours of their own.
    Tint,
    Step,
    Age,
    Fractal,
    Index,
    /// The object of the graph.
    Object,
    Direction,
    /// There is one class, and elements have colours of their own by their frames.
    Frame,
}

impl ColorBy {
    /// Returns the property on which the class of an element depends.
    #[inline]
    pub(crate) fn property(self) -> ColorProperty {
        match self {
            Self::None | Self::Hits | Self::Normal => ColorProperty::Uniform,
            Self::Tint => ColorProperty::Tint,
            Self::Step => ColorProperty::Step,
            Self::Age => ColorProperty::Age,
            Self::Fractal => ColorProperty::Fractal,
            Self::Index => ColorProperty::Index,
            Self::Generator | Self::FirstMap | Self::LastMap => ColorProperty::Object,
            Self::Direction => ColorProperty::Direction,
            Self::Angle | Self::Length | Self::X | Self::Y | Self::Distance => ColorProperty::Frame,
        }
    }

    /// Returns the least and the largest coordinate that colours by x or y distinguish in a window: lower left corner, width and
    /// height.
    pub(crate) fn range_across(self, [x, y, width, height]: [f64; 4]) -> Option<[f64; 2]> {
        match self {
            Self::X => Some([x, x + width]),
            Self::Y => Some([y, y + height]),
            _ => None,
        }
    }

    /// Returns whether the colours of elements come from the palette.
    #[must_use]
    pub fn takes_palette(self) -> bool {
        !matches!(
            self.property(),
            ColorProperty::Uniform | ColorProperty::Tint
        )
    }
}

impl Named for ColorBy {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("none", Self::None),
        ("step", Self::Step),
        ("age", Self::Age),
        ("fractal", Self::Fractal),
        ("index", Self::Index),
        ("generator", Self::Generator),
        ("direction", Self::Direction),
        ("first-map", Self::FirstMap),
        ("last-map", Self::LastMap),
        ("hits", Self::Hits),
        ("tint", Self::Tint),
        ("normal", Self::Normal),
        ("angle", Self::Angle),
        ("length", Self::Length),
        ("x", Self::X),
        ("y", Self::Y),
        ("distance", Self::Distance),
    ];
}
