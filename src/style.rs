//! Styles and views: strokes, fills, colours by class, the visible window, and cameras in space.

mod blend;
mod camera;
mod color_by;
mod density;
mod light;
mod palette;
mod similar;
mod slice;
mod space;

use std::fmt;
use std::sync::LazyLock;

use crate::geometry::{DVec2, DVec3, Homothety};

pub use blend::Blend;
pub use camera::{Camera, CameraError};
pub use color_by::ColorBy;
pub(crate) use color_by::ColorProperty;
pub use density::{DensityView, Iteration, Tone};
pub use light::{Light, Shade};
pub use palette::{Palette, UnknownPalette};
#[cfg(feature = "cli")]
pub(crate) use similar::oklab;
pub(crate) use similar::similar;
pub use slice::Slice;
pub use space::SpaceView;

/// An sRGB colour with opacity: red, green, blue and alpha, each from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Colour([u8; 4]);

impl Colour {
    /// Opaque black.
    pub const BLACK: Self = Self([0, 0, 0, 255]);

    /// Opaque white.
    pub const WHITE: Self = Self([255; 4]);

    /// No colour at all: black without opacity.
    pub const TRANSPARENT: Self = Self([0; 4]);

    /// Creates a colour from red, green, blue and alpha.
    #[must_use]
    pub const fn of_rgba(rgba: [u8; 4]) -> Self {
        Self(rgba)
    }

    /// Creates an opaque grey, from 0 (black) to 255 (white).
    #[must_use]
    pub const fn grey(value: u8) -> Self {
        Self([value, value, value, 255])
    }

    /// Parses a CSS colour: a name, `#3b6`, `#33bb66`, `rgb(…)`, `hsl(…)`, `oklch(…)` and so on.
    /// Returns `None` if the text is not a colour.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let colour = colorgrad::Color::from_html(text)
            .or_else(|_| colorgrad::Color::from_html(without_names(text)))
            .ok()?;
        Some(Self(colour.to_rgba8()))
    }

    /// Returns red, green, blue and alpha.
    #[must_use]
    pub fn rgba(self) -> [u8; 4] {
        self.0
    }

    /// Returns the colour with full opacity.
    #[must_use]
    pub fn opaque(self) -> Self {
        let [red, green, blue, _] = self.0;
        Self([red, green, blue, 255])
    }

    /// Returns the colour with red, green and blue times a share from 0 to 1.
    pub(crate) fn dimmed(self, share: f64) -> Self {
        let [red, green, blue, alpha] = self.0;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "casts from floats saturate"
        )]
        let [red, green, blue] =
            [red, green, blue].map(|part| (f64::from(part) * share).round() as u8);
        Self([red, green, blue, alpha])
    }

    /// Returns the opacity, from 0 to 1.
    #[must_use]
    pub fn opacity(self) -> f64 {
        f64::from(self.0[3]) / 255.0
    }
}

/// The named colours of CSS (W3C, CSS Color Module Level 4, section 6.1) in alphabetical order: names and `#rrggbb`.
static NAMES: LazyLock<Vec<(&str, &str)>> = LazyLock::new(|| {
    let lines = include_str!("style/names.txt").lines();
    lines.filter_map(|line| line.split_once(' ')).collect()
});

/// Length of the longest name of a colour.
const LONGEST_NAME: usize = "lightgoldenrodyellow".len();

/// Returns a named colour as `#rrggbb`.
fn named(name: &str) -> Option<&'static str> {
    if name.is_empty() || name.len() > LONGEST_NAME {
        return None;
    }
    let name = name.to_ascii_lowercase();
    let found = NAMES.binary_search_by_key(&name.as_str(), |(known, _)| known);
    Some(NAMES[found.ok()?].1)
}

/// Replaces the names of CSS colours by their values, in any place: `oklch(from teal l c 0)`.
fn without_names(text: &str) -> String {
    let end = |c: char| !c.is_ascii_alphabetic();
    let words = text.split_inclusive(end).map(|word| {
        let name = word.trim_end_matches(end);
        named(name).unwrap_or(name).to_owned() + &word[name.len()..]
    });
    words.collect()
}

/// Writes `#rrggbb`, without the opacity. The alternate form writes `#rrggbbaa` unless the colour is
/// opaque.
impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [red, green, blue, opacity] = self.0;
        write!(f, "#{red:02x}{green:02x}{blue:02x}")?;
        if f.alternate() && opacity < 255 {
            write!(f, "{opacity:02x}")?;
        }
        Ok(())
    }
}

/// Width of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Width {
    /// Width in pixels of the picture.
    Pixels(f64),
    /// Width as a multiple of the element's length |p1 − p0|.
    Relative(f64),
}

/// Line cap: the shape of the ends of open paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cap {
    /// A half disk around the end point.
    #[default]
    Round,
    /// A straight edge at the end point.
    Butt,
    /// A straight edge half the stroke's width beyond the end point.
    Square,
}

/// Line join: the shape of the corners of paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Join {
    /// A disk around the corner.
    #[default]
    Round,
    /// A straight edge across the corner.
    Bevel,
    /// A sharp corner, up to a miter limit of four times the stroke's width.
    Miter,
}

/// Enumerations whose variants have names in files and on the command line.
pub trait Named: Sized + Copy + 'static {
    /// All variants with their names.
    const NAMES: &'static [(&'static str, Self)];

    /// Returns the name of the variant.
    #[must_use]
    fn name(self) -> &'static str
    where
        Self: PartialEq,
    {
        let mut names = Self::NAMES.iter();
        names
            .find(|(_, known)| *known == self)
            .map_or("", |(name, _)| name)
    }

    /// Returns the variant of the given name.
    #[must_use]
    fn from_name(name: &str) -> Option<Self> {
        let mut names = Self::NAMES.iter();
        names
            .find(|(known, _)| *known == name)
            .map(|(_, variant)| *variant)
    }
}

impl Named for Cap {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("round", Self::Round),
        ("butt", Self::Butt),
        ("square", Self::Square),
    ];
}

impl Named for Join {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("round", Self::Round),
        ("bevel", Self::Bevel),
        ("miter", Self::Miter),
    ];
}

/// Appearance of elements.
///
/// Open base elements are stroked. Closed base elements are filled with the colour of their class, or
/// with `fill`, or with `stroke`; they are also outlined if `stroke` is given and the fill is another
/// colour. `fill` also fills fractals that consist of one closed path.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Colour of strokes; black if `None`.
    pub stroke: Option<Colour>,
    /// Width of strokes.
    pub width: Width,
    /// Shape of the ends of open paths.
    pub cap: Cap,
    /// Shape of the corners of paths.
    pub join: Join,
    /// Colour of areas.
    pub fill: Option<Colour>,
    /// Colour behind the picture; transparent if `None`.
    pub background: Option<Colour>,
    /// Mixing of elements that overlap.
    pub blend: Blend,
    /// Attribute to which the colours of the palette are assigned.
    pub color_by: ColorBy,
    /// Palette of the classes.
    pub palette: Palette,
    /// Values of the first and of the last colour of the palette, where colours are by step, age, angle, length or place: in degrees
    /// or in the units of the plane. `None` is 0 and the last step or age, a full turn, the lengths of the shortest and the
    /// longest element, or the sides of the picture.
    pub color_range: Option<[f64; 2]>,
    /// Tubes that the lines of a turtle in space are drawn as; lines without a width if `None`.
    pub tube: Option<Tube>,
}

/// Tubes along the lines of a turtle in space: prisms and frusta that join in knobs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tube {
    /// Number of sides.
    pub sides: u32,
    /// Width of a tube where that of the turtle is 1, in the coordinates of the file.
    pub width: f64,
}

impl Tube {
    /// Least and largest number of sides.
    pub const SIDES: [u32; 2] = [3, 48];

    /// Width where none is given.
    pub const WIDTH: f64 = 0.1;
}

impl Style {
    /// Returns the steps or ages of the first and the last colour, if they are given and colours are by either.
    pub(crate) fn range(&self) -> Option<[f64; 2]> {
        let is_by = matches!(
            self.color_by.property(),
            ColorProperty::Step | ColorProperty::Age
        );
        self.color_range.filter(|_| is_by)
    }

    /// Returns the colour of a value, of which the largest that the picture has is `last`.
    pub(crate) fn colour_of_value(&self, value: f64, last: f64) -> Colour {
        let [first, last] = self.range().unwrap_or([0.0, last.max(1.0)]);
        self.palette.at((value - first) / (last - first))
    }

    /// Returns the colour of a face with a unit normal, if colours are by normal.
    pub(crate) fn colour_of_normal(&self, normal: DVec3) -> Option<Colour> {
        let is_asked = self.color_by == ColorBy::Normal;
        is_asked.then(|| self.palette.at(f64::midpoint(normal.y, 1.0)))
    }
}

impl Default for Style {
    fn default() -> Self {
        Self {
            stroke: None,
            width: Width::Pixels(1.5),
            cap: Cap::Round,
            join: Join::Round,
            fill: None,
            background: None,
            blend: Blend::default(),
            color_by: ColorBy::None,
            palette: Palette::default(),
            color_range: None,
            tube: None,
        }
    }
}

impl Style {
    /// Returns the colour of open base elements.
    #[must_use]
    pub fn lines(&self) -> Colour {
        self.stroke.unwrap_or(Colour::BLACK)
    }

    /// Returns the fill colour of closed base elements without a class.
    #[must_use]
    pub fn polygons(&self) -> Colour {
        self.fill.unwrap_or_else(|| self.lines())
    }

    /// Returns the style with [`ColorBy::None`], where strokes have the middle colour of the palette
    /// unless both `stroke` and `fill` are given. The fill is kept.
    #[must_use]
    pub fn in_one_colour(self) -> Self {
        let colour = self.palette.at(0.5);
        Self {
            stroke: self.stroke.filter(|_| self.fill.is_some()).or(Some(colour)),
            color_by: ColorBy::None,
            ..self
        }
    }

    /// Returns the style in the coordinates that the homothety maps to those of this style.
    #[must_use]
    pub(crate) fn within(self, place: &Homothety) -> Self {
        let within = |end: f64| match self.color_by {
            ColorBy::X => place.origin_of(DVec2::new(end, 0.0)).x,
            ColorBy::Y => place.origin_of(DVec2::new(0.0, end)).y,
            ColorBy::Length | ColorBy::Distance => end / place.ratio(),
            _ => end,
        };
        Self {
            color_range: self.color_range.map(|range| range.map(within)),
            ..self
        }
    }

    /// Returns the background, unless it is [transparent](Colour::TRANSPARENT).
    #[must_use]
    pub fn ground(&self) -> Option<Colour> {
        self.background.filter(|colour| colour.opacity() > 0.0)
    }

    /// Returns whether the style leaves all colours open, so that everything is black.
    pub(crate) fn has_default_ink(&self) -> bool {
        let has_colours = self.color_by.takes_palette() || self.color_by == ColorBy::Tint;
        self.stroke.is_none() && self.fill.is_none() && !has_colours
    }

    /// Returns whether closed base elements are outlined in addition to their fill.
    #[must_use]
    pub fn outlines_polygons(&self) -> bool {
        let is_filled = self.fill.is_some() || self.color_by.takes_palette();
        is_filled && self.stroke.is_some()
    }
}

/// The part of the plane that is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// Window in the rule's units: x and y of the lower left corner, width, height. `None` shows
    /// everything.
    pub window: Option<[f64; 4]>,
    /// Margin in pixels around the drawing, strokes included. `None` leaves it to the picture: see
    /// [`Options::on_paper`](crate::render::Options::on_paper).
    pub margin: Option<f64>,
}

impl View {
    /// Returns the margin in pixels; 0 if it is left to the picture.
    pub(crate) fn pad(&self) -> f64 {
        self.margin.unwrap_or_default()
    }

    /// Returns the view in the coordinates that the homothety maps to those of this view.
    #[must_use]
    pub fn within(self, place: &Homothety) -> Self {
        Self {
            window: self.window.map(|window| place.origin_of_window(window)),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Colour;

    #[test]
    fn names_are_those_of_css() {
        for (text, rgba) in [
            ("teal", [0, 128, 128, 255]),
            ("RebeccaPurple", [102, 51, 153, 255]),
            ("lightslategrey", [119, 136, 153, 255]),
            ("tan", [210, 180, 140, 255]),
            ("transparent", [0; 4]),
            ("3b6", [51, 187, 102, 255]),
            ("rgb(from teal g b r / 0.2)", [128, 128, 0, 51]),
            ("rgb(from RGB(from Gray r g 0) b g r)", [0, 128, 128, 255]),
        ] {
            assert_eq!(Colour::parse(text).map(Colour::rgba), Some(rgba), "{text}");
        }
        for text in [
            "",
            "teal teal",
            "tael",
            "#teal",
            "rgb(teal)",
            "currentcolor",
        ] {
            assert_eq!(Colour::parse(text), None, "{text}");
        }
    }
}
