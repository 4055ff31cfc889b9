//! `--plot` and `--pens`: single strokes for plotters and cutters.

use std::num::NonZero;

use crate::render::{Machine, Pens, Plotted};

/// Limit of the number of pens that are described singly.
const MOST_PENS: usize = 16;

use super::super::picture::PictureArguments;
use super::super::readable;

/// Options of plots.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Picture")]
pub(super) struct PlotArguments {
    /// Draws single strokes, for a plotter or a cutter; DXF, HP-GL and G-code always have them
    ///
    /// No edge is drawn twice, strokes whose ends meet are merged, and the strokes are ordered for short
    /// pen-up travel. Filled shapes become outlines, and each pen is a layer. All strokes are held in memory,
    /// up to about 200 bytes per element, which --max-elements limits.
    #[arg(long)]
    plot: bool,
    /// Largest number of pens of a plot; similar colours share one
    ///
    /// By default, each colour that --color-by or --palette gives has a pen. The colours of the file have a
    /// pen each if they are no more than eight; otherwise there is one pen for all.
    #[arg(long, value_name = "N", value_parser = pens)]
    pens: Option<NonZero<usize>>,
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

    /// Returns whether a number of pens is given.
    pub(super) fn has_pens(&self) -> bool {
        self.pens.is_some()
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
    format!(
        "{}{layers} of {:.0} mm, {:.0} mm from stroke to stroke (as drawn: {:.0} mm), {} left out as \
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
