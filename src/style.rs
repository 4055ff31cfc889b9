//! How elements are drawn: strokes, fills, colours by class.

mod palette;

use std::fmt;

use crate::geometry::Homothety;

pub use palette::{Palette, UnknownPalette};

/// A colour: red, green, blue and opacity, 0 to 255 each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour([u8; 4]);

impl Colour {
    /// Black.
    pub const BLACK: Self = Self([0, 0, 0, 255]);

    /// Red, green, blue and opacity.
    #[must_use]
    pub const fn of_rgba(rgba: [u8; 4]) -> Self {
        Self(rgba)
    }

    /// A grey from 0, black, to 255, white.
    #[must_use]
    pub const fn grey(value: u8) -> Self {
        Self([value, value, value, 255])
    }

    /// Reads a colour as CSS writes it: a name, `#3b6`, `#33bb66`, `rgb(…)`, `hsl(…)`, `oklch(…)` ….
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        colorgrad::Color::from_html(text)
            .ok()
            .map(|colour| Self(colour.to_rgba8()))
    }

    /// Red, green, blue and opacity.
    #[must_use]
    pub fn rgba(self) -> [u8; 4] {
        self.0
    }

    /// The colour without its transparency.
    #[must_use]
    pub fn opaque(self) -> Self {
        let [red, green, blue, _] = self.0;
        Self([red, green, blue, 255])
    }

    /// The opacity, from 0 to 1.
    #[must_use]
    pub fn opacity(self) -> f64 {
        f64::from(self.0[3]) / 255.0
    }
}

/// As `#rrggbb`; the opacity is left out. The alternate form is `#rrggbbaa` where that matters.
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

/// The width of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Width {
    /// In pixels of the picture.
    Pixels(f64),
    /// As a multiple of the element's length |p1 − p0|.
    Relative(f64),
}

/// The ends of open paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cap {
    /// A half disk.
    #[default]
    Round,
    /// Cut off at the end point.
    Butt,
    /// Half a stroke's width longer.
    Square,
}

/// The corners of paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Join {
    /// A disk.
    #[default]
    Round,
    /// Cut off.
    Bevel,
    /// Pointed, up to four times the stroke's width.
    Miter,
}

/// What an element's colour tells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorBy {
    /// Nothing: one colour for all.
    #[default]
    None,
    /// The step of its birth.
    Step,
    /// The age of its fractal.
    Age,
    /// The number of its fractal.
    Fractal,
    /// Its rank in its fractal.
    Index,
    /// The generator that it comes from (the initiator first).
    Generator,
    /// Its direction.
    Direction,
    /// The map of a system that is applied first, the innermost one.
    FirstMap,
    /// The map of a system that is applied last, the outermost one: the tiling.
    LastMap,
    /// How often random iteration comes to a pixel. Approximants are of one colour for all.
    Hits,
    /// Nothing, but what the objects of a structure tint.
    Tint,
}

impl ColorBy {
    /// Whether elements have the palette's colours.
    #[must_use]
    pub fn takes_palette(self) -> bool {
        !matches!(self, Self::None | Self::Hits | Self::Tint)
    }
}

/// The names of the variants of an enumeration, as files and the command line write them.
pub trait Named: Sized + Copy + 'static {
    /// Every variant with its name.
    const NAMES: &'static [(&'static str, Self)];

    /// The variant's name.
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

    /// The variant with a name.
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
    ];
}

/// How elements are drawn.
///
/// Open base elements are stroked. Closed ones are filled with the colour of their class, or with
/// `fill`, or with `stroke`; they are outlined where `stroke` is given and they are filled with
/// something else.
/// `fill` also fills fractals that are one closed path.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// The colour of strokes; black if none is given.
    pub stroke: Option<Colour>,
    /// Their width.
    pub width: Width,
    /// The ends of open paths.
    pub cap: Cap,
    /// The corners of paths.
    pub join: Join,
    /// The colour of areas.
    pub fill: Option<Colour>,
    /// The colour behind everything; transparent if none is given.
    pub background: Option<Colour>,
    /// What the colours of the palette tell.
    pub color_by: ColorBy,
    /// The colours that classes get.
    pub palette: Palette,
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
            color_by: ColorBy::None,
            palette: Palette::default(),
        }
    }
}

impl Style {
    /// The colour of open base elements.
    #[must_use]
    pub fn lines(&self) -> Colour {
        self.stroke.unwrap_or(Colour::BLACK)
    }

    /// The colour that closed base elements are filled with.
    #[must_use]
    pub fn polygons(&self) -> Colour {
        self.fill.unwrap_or_else(|| self.lines())
    }

    /// The same with the middle colour of the palette for all, whatever colours tell.
    #[must_use]
    pub fn in_one_colour(self) -> Self {
        let colour = self.palette.at(0.5);
        Self {
            stroke: self.stroke.filter(|_| self.fill.is_some()).or(Some(colour)),
            color_by: ColorBy::None,
            ..self
        }
    }

    /// Whether closed base elements get an outline beside their fill.
    #[must_use]
    pub fn outlines_polygons(&self) -> bool {
        let is_filled = self.fill.is_some() || self.color_by.takes_palette();
        is_filled && self.stroke.is_some()
    }
}

/// What part of the plane is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// A window in the rule's units: lower left corner, width, height; everything if none is given.
    pub window: Option<[f64; 4]>,
    /// Pixels left free around what is drawn, strokes included.
    pub margin: f64,
}

impl View {
    /// Returns the view in the coordinates that a homothety maps to its own.
    #[must_use]
    pub fn within(self, place: &Homothety) -> Self {
        Self {
            window: self.window.map(|window| place.origin_of_window(window)),
            ..self
        }
    }
}
