//! How a picture is to be drawn: what the command line says, over what the rule says.

use std::fmt;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::heading::Heading;
use crate::render::Unit;
use crate::style::{Cap, ColorBy, Colour, Join, Named, Palette, Style, View};

use super::Failure;
use super::length::{Length, StrokeWidth};

/// Options of pictures.
#[derive(clap::Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct PictureArguments {
    /// The window that is shown, in the rule's units: lower left corner, width, height
    ///
    /// What lies outside is not grown, unless elements are drawn at random or have to be counted:
    /// for the rule, or for --color-by index and fractal.
    #[arg(long, value_name = "X,Y,W,H", value_parser = window, allow_hyphen_values = true)]
    view: Option<[f64; 4]>,
    /// The colour of strokes, as CSS writes it: teal, #3b7ea1, rgb(59, 126, 161); or none
    ///
    /// Closed shapes are filled with it or, where --fill, --color-by or the file fills them with something
    /// else, outlined.
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    stroke: Option<Ink>,
    /// The width of strokes in pixels, or in millimetres as 0.3mm, or, with a % sign, relative to
    /// the element's length
    #[arg(long, value_name = "W", value_parser = StrokeWidth::parse)]
    pub(super) stroke_width: Option<StrokeWidth>,
    /// The colour inside closed shapes
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    fill: Option<Ink>,
    /// The shape of the ends of lines
    #[arg(long, value_parser = named::<Cap>())]
    cap: Option<Cap>,
    /// The shape of the corners of lines
    #[arg(long, value_parser = named::<Join>())]
    join: Option<Join>,
    /// Pixels left free around the picture, or millimetres as 10mm
    #[arg(long, value_name = "PX", value_parser = Length::parse)]
    margin: Option<Length>,
    /// The colour behind the picture
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    background: Option<Ink>,
    /// What the colours of the palette tell apart
    #[arg(long, value_name = "WHAT", value_parser = color_by())]
    color_by: Option<ColorBy>,
    /// The colours that --color-by takes
    #[arg(long, value_name = "NAME", value_parser = palette())]
    palette: Option<Palette>,
}

impl PictureArguments {
    /// The rule's style with what is asked for.
    pub(super) fn style(&self, heading: &Heading) -> Style {
        self.style_in(heading, Unit::Pixel)
    }

    /// The same, with widths in the units of the picture.
    pub(super) fn style_in(&self, heading: &Heading, unit: Unit) -> Style {
        let own = &heading.style;
        let width = self.stroke_width.unwrap_or(StrokeWidth::of(own.width));
        Style {
            stroke: self.stroke.map_or(own.stroke, Ink::colour),
            width: width.width(unit),
            cap: self.cap.unwrap_or(own.cap),
            join: self.join.unwrap_or(own.join),
            fill: self.fill.map_or(own.fill, Ink::colour),
            background: self.background.map_or(own.background, Ink::colour),
            color_by: match self.color_by {
                Some(color_by) => color_by,
                // A colour that is asked for is not covered by a palette that is not.
                None if [self.stroke, self.fill]
                    .iter()
                    .flatten()
                    .any(Ink::is_colour) =>
                {
                    ColorBy::None
                }
                None => own.color_by,
            },
            palette: self.palette.clone().unwrap_or_else(|| own.palette.clone()),
        }
    }

    /// The rule's view with what is asked for.
    pub(super) fn view(&self, heading: &Heading) -> View {
        self.view_in(heading, Unit::Pixel)
    }

    /// The same, with the margin in the units of the picture.
    pub(super) fn view_in(&self, heading: &Heading, unit: Unit) -> View {
        let margin = self.margin.unwrap_or(Length::Pixels(heading.view.margin));
        View {
            window: self.view.or(heading.view.window),
            margin: margin.count(unit),
        }
    }

    /// Whether a window is asked for.
    pub(super) fn has_view(&self) -> bool {
        self.view.is_some()
    }

    /// What is asked for of the way in which points are coloured.
    pub(super) fn asked_color_by(&self) -> Option<ColorBy> {
        self.color_by
    }

    /// Whether colours that distinguish elements are asked for.
    pub(super) fn asks_for_colours(&self) -> bool {
        self.color_by.is_some() || self.palette.is_some()
    }

    /// Whether a palette is asked for.
    pub(super) fn asks_palette(&self) -> bool {
        self.palette.is_some()
    }

    /// The one colour of points: what is asked for comes before what the file has.
    pub(super) fn ink(&self, heading: &Heading) -> Option<Colour> {
        let own = &heading.style;
        let asked = self.fill.and_then(Ink::colour);
        let asked = asked.or(self.stroke.and_then(Ink::colour));
        asked.or(own.fill).or(own.stroke)
    }

    /// Whether anything is asked for that only lines have.
    pub(super) fn asks_lines(&self) -> bool {
        self.stroke_width.is_some() || self.cap.is_some() || self.join.is_some()
    }

    /// Refuses colours that only random iteration has.
    pub(super) fn refuse_hits(&self) -> Result<(), Failure> {
        match self.color_by {
            Some(ColorBy::Hits) => {
                let message = "--color-by hits counts points of random iteration: kfrac grow with \
                               --method chaos has them";
                Err(Failure::Usage(message.into()))
            }
            _ => Ok(()),
        }
    }

    /// Refuses what only lines have.
    pub(super) fn refuse_lines(&self) -> Result<(), Failure> {
        let asked = [
            ("--stroke-width", self.stroke_width.is_some()),
            ("--cap", self.cap.is_some()),
            ("--join", self.join.is_some()),
        ];
        match asked.into_iter().find(|(_, is_asked)| *is_asked) {
            Some((option, _)) => Err(Failure::Usage(format!(
                "{option} is of lines, and --method chaos draws points"
            ))),
            None => Ok(()),
        }
    }

    /// The options as the command line has them, each with its value.
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
        option("margin", self.margin.map(|margin| margin.to_string()));
        option("background", colour(self.background));
        option("color-by", self.color_by.map(|by| by.name().into()));
        option(
            "palette",
            self.palette.as_ref().map(|palette| palette.name().into()),
        );
        options
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

/// Reads a number of pixels that is more than none.
pub(super) fn pixels(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(pixels) if pixels.is_finite() && pixels > 0.0 => Ok(pixels),
        _ => Err("this is a number of pixels above 0".into()),
    }
}

/// A colour, or none, in place of one that a rule's own style has.
#[derive(Clone, Copy)]
pub(super) struct Ink(Option<Colour>);

impl Ink {
    /// The colour, if it is one.
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

/// Reads a colour, or `none`, as files have them.
pub(super) fn ink(text: &str) -> Result<Ink, String> {
    if text == "none" {
        return Ok(Ink(None));
    }
    let colour = Colour::parse(text).ok_or_else(|| {
        "write a colour as CSS does: teal, #3b7ea1, rgb(59, 126, 161); or none".to_owned()
    })?;
    Ok(Ink(Some(colour)))
}

/// Reads one of the names of an enumeration.
pub(super) fn named<T: Named + Send + Sync>() -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(T::NAMES.iter().map(|(name, _)| *name))
        .try_map(|name| T::from_name(&name).ok_or("unknown"))
}

fn color_by() -> impl TypedValueParser<Value = ColorBy> {
    let values = ColorBy::NAMES.iter().map(|(name, by)| {
        PossibleValue::new(*name).help(match by {
            ColorBy::None => "Nothing: all is of the colours of --stroke and --fill",
            ColorBy::Step => "The step in which an element was born",
            ColorBy::Age => "The age of the element's fractal, in steps",
            ColorBy::Fractal => "The element's fractal, in the order of their birth",
            ColorBy::Index => "The element's place in its fractal",
            ColorBy::Generator => "The generator that an element comes from",
            ColorBy::Direction => "The element's direction",
            ColorBy::FirstMap => "The map of a system that is applied first, the innermost one",
            ColorBy::LastMap => "The map of a system that is applied last: the tiling",
            ColorBy::Hits => "How often random iteration comes to a pixel",
            ColorBy::Tint => "What the objects of a structure are tinted with",
        })
    });
    PossibleValuesParser::new(values).try_map(|name| ColorBy::from_name(&name).ok_or("unknown"))
}

fn palette() -> impl TypedValueParser<Value = Palette> {
    PossibleValuesParser::new(Palette::names()).try_map(|name| Palette::named(&name))
}
