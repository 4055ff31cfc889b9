//! `--plot`, `--pens`, `--occlude` and `--hatch`: single strokes for plotters and cutters.

use std::fmt;
use std::num::NonZero;

use crate::render::{Hatch, HatchPattern, Machine, Pens, Plotted, Unit};

/// Limit of the number of pens that are described singly.
const MOST_PENS: usize = 16;

use super::super::length::Length;
use super::super::picture::PictureArguments;
use super::super::readable;

/// Options of plots.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Picture")]
pub(super) struct PlotArguments {
    /// Draws single strokes, for a plotter or a cutter; DXF, HP-GL and G-code always have them
    ///
    /// No edge is drawn twice, strokes whose ends meet are merged, and the strokes are ordered for short
    /// pen-up travel. Filled shapes become outlines that hide what lies under them, and each pen is a layer. All
    /// strokes are held in memory, about 200 bytes per line and 1 kB per filled shape, which --max-elements limits.
    #[arg(long)]
    plot: bool,
    /// Largest number of pens of a plot; similar colours share one
    ///
    /// By default, each colour that --color-by or --palette gives has a pen. The colours of the file have a
    /// pen each if they are no more than eight; otherwise there is one pen for all.
    #[arg(long, value_name = "N", value_parser = pens)]
    pens: Option<NonZero<usize>>,
    /// Whether filled shapes of a plot of the plane hide what lies under them [default: yes]
    ///
    /// Shapes hide by the order of the picture: later elements lie above earlier ones, and fills that are not opaque hide
    /// nothing. `no` draws all outlines.
    #[arg(long, value_name = "YES|NO", value_parser = yes_or_no)]
    occlude: Option<bool>,
    /// Hatches the fills of a plot of the plane: 45deg, 30,120, cross or contour
    ///
    /// Angles are those of parallel lines, counter-clockwise from the horizontal; `cross` stands for 45,135, and `contour` for
    /// lines inside the outlines at equal distances from them. Hatching has the colour of the fill; fills in the colour of the
    /// background, or in white if there is none, stay empty.
    #[arg(long, value_name = "PATTERN", value_parser = pattern)]
    hatch: Option<Pattern>,
    /// Distance of the lines of --hatch [default: 1mm]
    #[arg(long, value_name = "LENGTH", value_parser = spacing)]
    hatch_spacing: Option<Length>,
    /// Speed of drawing with G-code, in millimetres a minute [default: 1500]
    #[arg(long, value_name = "MM", value_parser = feed)]
    feed: Option<f64>,
    /// G-code that raises the pen, or switches a laser off [default: G0 Z5]
    #[arg(long, value_name = "CODE", value_parser = command)]
    pen_up: Option<String>,
    /// G-code that lowers the pen, or switches a laser on [default: G1 Z0]
    #[arg(long, value_name = "CODE", value_parser = command)]
    pen_down: Option<String>,
}

impl PlotArguments {
    /// Returns whether a plot is requested, in any format.
    pub(super) fn is_asked(&self) -> bool {
        self.plot
    }

    /// Returns the options that apply to plots only, and whether they are given.
    pub(super) fn of_plots(&self) -> impl Iterator<Item = (&'static str, bool)> {
        { [("--pens", self.pens.is_some())].into_iter() }.chain(self.of_areas())
    }

    /// Returns the options of filled areas in plots, and whether they are given.
    pub(super) fn of_areas(&self) -> [(&'static str, bool); 3] {
        [
            ("--occlude", self.occlude.is_some()),
            ("--hatch", self.hatch.is_some()),
            ("--hatch-spacing", self.hatch_spacing.is_some()),
        ]
    }

    /// Returns whether a spacing is given without a hatching.
    pub(super) fn lacks_hatch(&self) -> bool {
        self.hatch_spacing.is_some() && self.hatch.is_none()
    }

    /// Returns whether filled shapes hide what lies under them.
    pub(super) fn occludes(&self) -> bool {
        self.occlude.unwrap_or(true)
    }

    /// Returns the hatching of fills, for a picture with a unit.
    pub(super) fn hatch(&self, unit: Unit) -> Option<Hatch> {
        let spacing = self.hatch_spacing.unwrap_or(Length::Millimetres(1.0));
        let pattern = self.hatch.as_ref()?.0.clone();
        Some(Hatch::new(pattern, spacing.count(unit)))
    }

    /// Returns the pens of a plot: one for each colour if colours are requested.
    pub(super) fn pens(&self, picture: &PictureArguments) -> Pens {
        match self.pens {
            Some(most) => Pens::AtMost(most),
            None if picture.asks_for_colours() => Pens::Each,
            None => Pens::Few,
        }
    }

    /// Returns the commands of the machine that reads G-code.
    pub(super) fn machine(&self) -> Machine {
        let mut machine = Machine::default();
        machine.feed = self.feed.unwrap_or(machine.feed);
        for (code, asked) in [
            (&mut machine.pen_up, &self.pen_up),
            (&mut machine.pen_down, &self.pen_down),
        ] {
            code.clone_from(asked.as_ref().unwrap_or(&code.clone()));
        }
        machine
    }

    /// Returns the options that apply to G-code only, and whether they are given.
    pub(super) fn of_machines(&self) -> [(&'static str, bool); 3] {
        [
            ("--feed", self.feed.is_some()),
            ("--pen-up", self.pen_up.is_some()),
            ("--pen-down", self.pen_down.is_some()),
        ]
    }

    /// Returns the options that are given, with their values.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let all = [
            ("plot", self.plot.then(String::new)),
            ("pens", self.pens.map(|pens| pens.to_string())),
            (
                "occlude",
                self.occlude
                    .map(|yes| (if yes { "yes" } else { "no" }).into()),
            ),
            ("hatch", self.hatch.as_ref().map(Pattern::to_string)),
            ("hatch-spacing", self.hatch_spacing.map(|it| it.to_string())),
            ("feed", self.feed.map(|feed| feed.to_string())),
            ("pen-up", self.pen_up.clone()),
            ("pen-down", self.pen_down.clone()),
        ];
        let given = all.into_iter();
        given
            .filter_map(|(name, value)| Some((name, value?)))
            .collect()
    }

    /// Returns a note if colours share a pen by default.
    pub(super) fn note_of_pens(&self, plotted: &Plotted) -> Option<String> {
        let shares = self.pens.is_none() && plotted.colours > plotted.layers.max(Pens::FEW as u64);
        shares.then(|| {
            format!(
                "note: one pen for all {} colours: --pens {} gives that many, --color-by one for each colour",
                plotted.colours,
                Pens::FEW
            )
        })
    }
}

/// Pattern of a hatching.
#[derive(Clone)]
struct Pattern(HatchPattern);

/// Directions of `--hatch cross`.
const CROSS: [f64; 2] = [45.0, 135.0];

/// Largest number of directions of a hatching.
const MAX_DIRECTIONS: usize = 12;

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            HatchPattern::Lines(angles) => {
                let angles: Vec<_> = angles.iter().map(|angle| format!("{angle}deg")).collect();
                f.write_str(&angles.join(","))
            }
            HatchPattern::Contour => f.write_str("contour"),
        }
    }
}

fn pattern(text: &str) -> Result<Pattern, String> {
    let angle = |text: &str| -> Option<f64> {
        let text = text.trim();
        let text = text.strip_suffix("deg").unwrap_or(text).trim_end();
        text.parse().ok().filter(|angle: &f64| angle.is_finite())
    };
    let pattern = match text.trim() {
        "cross" => HatchPattern::Lines(CROSS.into()),
        "contour" => HatchPattern::Contour,
        angles => {
            let angles: Option<Vec<_>> = angles.split(',').map(angle).collect();
            let angles = angles.filter(|angles| angles.len() <= MAX_DIRECTIONS);
            HatchPattern::Lines(angles.ok_or_else(|| {
                format!("expected up to {MAX_DIRECTIONS} angles such as 45deg or 30,120, or cross, or contour")
            })?)
        }
    };
    Ok(Pattern(pattern))
}

fn spacing(text: &str) -> Result<Length, String> {
    let length = Length::parse(text)?;
    if length.count(Unit::Pixel) < Hatch::LEAST_SPACING {
        return Err(format!(
            "lines of a hatching are at least {} pixels apart: --hatch-spacing 1mm",
            Hatch::LEAST_SPACING
        ));
    }
    Ok(length)
}

fn yes_or_no(text: &str) -> Result<bool, String> {
    match text {
        "yes" => Ok(true),
        "no" => Ok(false),
        _ => Err("expected yes or no".into()),
    }
}

fn pens(text: &str) -> Result<NonZero<usize>, String> {
    text.parse()
        .map_err(|_| "a plot has at least one pen: --pens 3".into())
}

fn feed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(feed) if feed > 0.0 && f64::is_finite(feed) => Ok(feed),
        _ => Err("a speed is a number of millimetres a minute above 0: --feed 1500".into()),
    }
}

/// Parses a line of G-code.
fn command(text: &str) -> Result<String, String> {
    match text.trim() {
        line if !line.is_empty() && line.chars().all(|c| (' '..='~').contains(&c)) => {
            Ok(line.into())
        }
        _ => Err("expected a line of G-code, such as 'M3 S90'".into()),
    }
}

/// Describes the cost of a plot: strokes, layers and pen-up travel.
pub(super) fn described(plotted: &Plotted) -> String {
    let layers = match plotted.layers {
        1 => String::new(),
        layers => format!(" in {}", readable::counted(&layers.into(), "layer")),
    };
    let hidden = match plotted.hidden {
        0 => String::new(),
        edges => format!(
            ", {} hidden in whole or in part",
            readable::counted(&edges.into(), "edge")
        ),
    };
    format!(
        "{}{layers} of {:.0} mm, {:.0} mm from stroke to stroke (as drawn: {:.0} mm){hidden}, {} left out as \
         drawn before",
        readable::counted(&plotted.strokes.into(), "stroke"),
        plotted.drawn,
        plotted.carried,
        plotted.carried_as_drawn,
        readable::counted(&plotted.repeated.into(), "edge"),
    )
}

/// Describes the strokes of each pen, if there are several.
pub(super) fn of_pens(plotted: &Plotted) -> Vec<String> {
    if !(2..=MOST_PENS).contains(&plotted.pens.len()) {
        return Vec::new();
    }
    let pens = (1..).zip(&plotted.pens).map(|(number, pen)| {
        format!(
            "pen {number}, {}: {} of {:.0} mm, {:.0} mm from stroke to stroke",
            pen.colour,
            readable::counted(&pen.strokes.into(), "stroke"),
            pen.drawn,
            pen.carried,
        )
    });
    pens.collect()
}
