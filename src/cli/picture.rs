//! Options of pictures, which override the style and view of a rule.

use std::fmt;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::metadata::Metadata;
use crate::render::Unit;
use crate::style::{Blend, Cap, ColorBy, Colour, Join, Named, Palette, Style, View};

use super::Failure;
use super::length::{Length, StrokeWidth};
use super::palette::{self, PaletteParser};

/// Options of pictures.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Picture")]
pub(super) struct PictureArguments {
    /// Window that is shown, in the rule's units: lower left corner, width, height
    ///
    /// Elements outside of it are not grown, unless elements are drawn at random or have to be counted: for
    /// the rule, or for --color-by index and fractal.
    #[arg(long, value_name = "X,Y,W,H", value_parser = window, allow_hyphen_values = true)]
    view: Option<[f64; 4]>,
    /// Colour of strokes, in CSS notation: teal, #3b7ea1, rgb(59, 126, 161); or none
    ///
    /// Closed shapes are filled with this colour. If --fill, --color-by or the file gives them another fill,
    /// they are outlined with it.
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    stroke: Option<Ink>,
    /// Width of strokes in pixels, as a length (0.3mm), or relative to the element's length (10%)
    #[arg(long, value_name = "W", value_parser = StrokeWidth::parse)]
    pub(super) stroke_width: Option<StrokeWidth>,
    /// Fill colour of closed shapes
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    fill: Option<Ink>,
    /// Shape of the ends of lines
    #[arg(long, value_parser = named::<Cap>())]
    cap: Option<Cap>,
    /// Shape of the corners of lines
    #[arg(long, value_parser = named::<Join>())]
    join: Option<Join>,
    /// Mixing of elements that overlap
    ///
    /// `joined`: those of one colour are one area. With the others, each is drawn by itself: `normal` on top, `multiply` darker, `add`
    /// and `screen` lighter. Has no effect on plots, on nested instances and on tones.
    #[arg(long, value_parser = named::<Blend>())]
    blend: Option<Blend>,
    /// Margin around the picture in pixels, or as a length (10mm, 0.5in) [default: 4 % of the long side; none around a
    /// window and in plots]
    #[arg(long, value_name = "PX", value_parser = Length::parse)]
    margin: Option<Length>,
    /// Background colour, or none [default: white in PNG and PDF]
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    background: Option<Ink>,
    /// Property that the colours of the palette distinguish
    #[arg(long, value_name = "WHAT", value_parser = color_by())]
    color_by: Option<ColorBy>,
    /// Palette of --color-by: a name, colours as '#fff,teal,#013', or a file .map, .gpl, .ugr or .cpt
    ///
    /// Files are those of Fractint, GIMP, Ultra Fractal (the first gradient) and GMT.
    #[arg(long, value_name = "PALETTE", value_parser = PaletteParser)]
    palette: Option<Palette>,
    /// Takes the palette from a picture: its eight most frequent colours, from dark to light
    #[arg(long, value_name = "PICTURE", value_parser = palette::from_picture, conflicts_with = "palette")]
    #[arg(value_hint = clap::ValueHint::FilePath)]
    palette_from: Option<Palette>,
    /// Values of the first and the last colour: steps, ages, degrees, lengths or coordinates, as 0..8 [default: those of the picture]
    ///
    /// Applies to --color-by step, age, angle, length, x, y and distance. Lengths and coordinates are in the rule's units.
    #[arg(long, value_name = "FIRST..LAST", value_parser = ColorRange::parse, allow_hyphen_values = true)]
    color_range: Option<ColorRange>,
}

impl PictureArguments {
    /// Returns the style of the rule with the options applied.
    pub(super) fn style(&self, metadata: &Metadata) -> Style {
        self.style_in(metadata, Unit::Pixel)
    }

    /// Returns the style of the rule with the options applied, with widths in `unit`.
    pub(super) fn style_in(&self, metadata: &Metadata, unit: Unit) -> Style {
        let own = &metadata.style;
        let width = self.stroke_width.unwrap_or(StrokeWidth::of(own.width));
        Style {
            tube: own.tube,
            stroke: self.stroke.map_or(own.stroke, Ink::colour),
            width: width.width(unit),
            cap: self.cap.unwrap_or(own.cap),
            join: self.join.unwrap_or(own.join),
            blend: self.blend.unwrap_or(own.blend),
            fill: self.fill.map_or(own.fill, Ink::colour),
            background: match self.background {
                Some(ink) => Some(ink.colour().unwrap_or(Colour::TRANSPARENT)),
                None => own.background,
            },
            color_by: match self.color_by {
                Some(color_by) => color_by,
                // An explicit colour takes precedence over a palette that is not explicit.
                None if [self.stroke, self.fill]
                    .iter()
                    .flatten()
                    .any(Ink::is_colour) =>
                {
                    ColorBy::None
                }
                None => own.color_by,
            },
            palette: self.palette().unwrap_or(&own.palette).clone(),
            color_range: self.color_range.map(|it| it.0).or(own.color_range),
        }
    }

    /// Returns the view of the rule with the options applied.
    pub(super) fn view(&self, metadata: &Metadata) -> View {
        self.view_in(metadata, Unit::Pixel)
    }

    /// Returns the view of the rule with the options applied, with the margin in `unit`.
    pub(super) fn view_in(&self, metadata: &Metadata, unit: Unit) -> View {
        let margin = self.margin.or(metadata.view.margin.map(Length::Pixels));
        View {
            window: self.view.or(metadata.view.window),
            margin: margin.map(|margin| margin.count(unit)),
        }
    }

    /// Returns whether a window is given.
    pub(super) fn has_view(&self) -> bool {
        self.view.is_some()
    }

    /// Returns the value of `--color-by`.
    pub(super) fn asked_color_by(&self) -> Option<ColorBy> {
        self.color_by
    }

    /// Returns whether the options ask for colours that distinguish elements.
    pub(super) fn asks_for_colours(&self) -> bool {
        self.color_by.is_some() || self.asks_palette()
    }

    /// Returns the palette that is given.
    fn palette(&self) -> Option<&Palette> {
        self.palette.as_ref().or(self.palette_from.as_ref())
    }

    /// Returns whether a palette is given.
    pub(super) fn asks_palette(&self) -> bool {
        self.palette().is_some()
    }

    /// Returns whether hits are shown in the palette: if either is asked for.
    pub(super) fn shows_hits_by_palette(&self) -> bool {
        self.color_by == Some(ColorBy::Hits) || self.asks_palette()
    }

    /// Returns the single colour of points: that of the options, or else that of the file.
    pub(super) fn ink(&self, metadata: &Metadata) -> Option<Colour> {
        let own = &metadata.style;
        let asked = self.fill.and_then(Ink::colour);
        let asked = asked.or(self.stroke.and_then(Ink::colour));
        asked.or(own.fill).or(own.stroke)
    }

    /// Returns the options that apply to lines only, and whether they are given.
    pub(super) fn of_lines(&self) -> [(&'static str, bool); 4] {
        [
            ("--stroke-width", self.stroke_width.is_some()),
            ("--cap", self.cap.is_some()),
            ("--join", self.join.is_some()),
            ("--blend", self.blend.is_some()),
        ]
    }

    /// Returns an error if colours by hits are asked for, which only random iteration has.
    pub(super) fn refuse_hits(&self) -> Result<(), Failure> {
        match self.color_by {
            Some(ColorBy::Hits) => {
                let message = "--color-by hits counts the hits of pixels: add --method chaos, or --tone log in kfrac grow";
                Err(Failure::Usage(message.into()))
            }
            _ => Ok(()),
        }
    }

    /// Returns the options that are given, with their values.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let mut options = Vec::new();
        let mut option = |name: &'static str, value: Option<String>| {
            options.extend(value.map(|value| (name, value)));
        };
        let colour = |ink: Option<Ink>| ink.map(|ink| ink.to_string());
        option(
            "view",
            self.view
                .map(|view| view.map(|number| number.to_string()).join(",")),
        );
        option("stroke", colour(self.stroke));
        option(
            "stroke-width",
            self.stroke_width.map(|width| width.to_string()),
        );
        option("fill", colour(self.fill));
        option("cap", self.cap.map(|cap| cap.name().into()));
        option("join", self.join.map(|join| join.name().into()));
        option("blend", self.blend.map(|blend| blend.name().into()));
        option("margin", self.margin.map(|margin| margin.to_string()));
        option("background", colour(self.background));
        option("color-by", self.color_by.map(|by| by.name().into()));
        option("palette", self.palette().map(ToString::to_string));
        option(
            "color-range",
            self.color_range.map(|range| range.to_string()),
        );
        options
    }
}

/// Values of the first and the last colour of the palette.
#[derive(Clone, Copy)]
struct ColorRange([f64; 2]);

impl ColorRange {
    fn parse(text: &str) -> Result<Self, String> {
        let ends = text.split_once("..").map(|(first, last)| [first, last]);
        let ends = ends.and_then(|ends| {
            let [first, last] =
                ends.map(|end| end.trim().parse::<f64>().ok().filter(|it| it.is_finite()));
            Some([first?, last?])
        });
        match ends {
            Some([first, last]) if first < last => Ok(Self([first, last])),
            _ => Err("expected two numbers, the smaller one first, as in 0..8".into()),
        }
    }
}

impl fmt::Display for ColorRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, last] = self.0;
        write!(f, "{first}..{last}")
    }
}

fn window(text: &str) -> Result<[f64; 4], String> {
    let numbers: Result<Vec<f64>, _> = text
        .split(',')
        .map(|number| number.trim().parse())
        .collect();
    match numbers.map(<[f64; 4]>::try_from) {
        Ok(Ok(window))
            if window.iter().all(|number| number.is_finite())
                && window[2] > 0.0
                && window[3] > 0.0 =>
        {
            Ok(window)
        }
        _ => Err("a window is X,Y,W,H: lower left corner, width and height above 0".into()),
    }
}

/// Parses a number of pixels greater than 0.
pub(super) fn pixels(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(pixels) if pixels.is_finite() && pixels > 0.0 => Ok(pixels),
        _ => Err("expected a number of pixels above 0".into()),
    }
}

/// Colour, or the absence of one, that replaces a colour of the style.
#[derive(Clone, Copy)]
pub(super) struct Ink(Option<Colour>);

impl Ink {
    /// Returns the colour, or `None` for `none`.
    pub(super) fn colour(self) -> Option<Colour> {
        self.0
    }

    fn is_colour(&self) -> bool {
        self.0.is_some()
    }
}

impl fmt::Display for Ink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(colour) => write!(f, "{colour:#}"),
            None => f.write_str("none"),
        }
    }
}

/// Parses a colour, or `none`, in the notation of rule files.
pub(super) fn ink(text: &str) -> Result<Ink, String> {
    if text == "none" {
        return Ok(Ink(None));
    }
    let colour = Colour::parse(text).ok_or_else(|| {
        "write a colour as CSS does: teal, #3b7ea1, rgb(59, 126, 161); or none".to_owned()
    })?;
    Ok(Ink(Some(colour)))
}

/// Returns a parser for the names of an enumeration.
pub(super) fn named<T: Named + Send + Sync>() -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(T::NAMES.iter().map(|(name, _)| *name))
        .try_map(|name| T::from_name(&name).ok_or("unknown"))
}

fn color_by() -> impl TypedValueParser<Value = ColorBy> {
    let values = ColorBy::NAMES.iter().map(|(name, by)| {
        PossibleValue::new(*name).help(match by {
            ColorBy::None => "Nothing: --stroke and --fill apply",
            ColorBy::Step => "The step in which the element was created",
            ColorBy::Age => "The age of the element's fractal, in steps",
            ColorBy::Fractal => "The element's fractal, in order of creation",
            ColorBy::Index => "The element's index in its fractal",
            ColorBy::Generator => "The generator that the element comes from",
            ColorBy::Direction => "The element's direction",
            ColorBy::FirstMap => "The map that is applied first, the innermost",
            ColorBy::LastMap => "The map that is applied last: the tiling",
            ColorBy::Hits => "The number of hits of random iteration per pixel",
            ColorBy::Tint => "The tints of the objects of a structure",
            ColorBy::Angle => "In the plane, the angle of the element to the x axis",
            ColorBy::Length => "In the plane, the length of the element, by equal ratios",
            ColorBy::X => "In the plane, the place of the element, from left to right",
            ColorBy::Y => "In the plane, the place of the element, from bottom to top",
            ColorBy::Distance => "In the plane, the distance of the element from the centre of the picture",
            ColorBy::Normal => "In space, the height of the normal: from faces that look down to those that look up",
        })
    });
    PossibleValuesParser::new(values).try_map(|name| ColorBy::from_name(&name).ok_or("unknown"))
}
