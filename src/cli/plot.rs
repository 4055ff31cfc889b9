//! `--plot` and `--pens`: strokes for machines that draw or cut.

use std::num::NonZero;

use crate::render::{Format, Pens, Plotted};
use crate::wording;

use super::Failure;
use super::picture::PictureArguments;
use super::text;

/// How a plot is made.
#[derive(clap::Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct PlotArguments {
    /// Draws single strokes, for a plotter or a cutter; a DXF always is
    ///
    /// Nothing is drawn twice, strokes whose ends meet become one, and the pen is carried over short
    /// ways. Outlines of what is filled are strokes, and each pen is a layer. This takes memory:
    /// up to some 200 bytes an element, so that --max-elements bounds it.
    #[arg(long)]
    plot: bool,
    /// The most pens of a plot; colours that are alike share one
    ///
    /// Without it, each colour that --color-by or --palette gives has a pen, and so have those of the
    /// file if they are no more than eight; else there is one pen for all.
    #[arg(long, value_name = "N", value_parser = pens)]
    pens: Option<NonZero<usize>>,
}

impl PlotArguments {
    /// Whether a picture in any format is to be a plot.
    pub(super) fn is_asked(&self) -> bool {
        self.plot
    }

    /// Refuses what is of plots where no plot is made: in no picture, or in one of a format that is
    /// not always a plot.
    pub(super) fn refuse(&self, format: Option<Format>) -> Result<(), Failure> {
        let message = if self.plot && format.is_none() {
            "--plot is of pictures, and a table is none"
        } else if self.pens.is_some() && !self.plot && format != Some(Format::Dxf) {
            "--pens is of plots: give --plot too, or write a .dxf"
        } else {
            return Ok(());
        };
        Err(Failure::Usage(message.into()))
    }

    /// The pens of a plot: of colours that are asked for each has one.
    pub(super) fn pens(&self, picture: &PictureArguments) -> Pens {
        match self.pens {
            Some(most) => Pens::AtMost(most),
            None if picture.asks_for_colours() => Pens::Each,
            None => Pens::Few,
        }
    }

    /// The options as the command line has them.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let plot = self.plot.then(|| ("plot", String::new()));
        let pens = self.pens.map(|pens| ("pens", pens.to_string()));
        plot.into_iter().chain(pens).collect()
    }

    /// Says that colours share a pen, where nobody has asked for that.
    pub(super) fn tell_of_pens(&self, plotted: &Plotted) {
        if self.pens.is_none() && plotted.colours > plotted.layers.max(Pens::FEW as u64) {
            text::say(&format!(
                "note: one pen for all {} colours: --pens {} gives as many, --color-by one for each",
                plotted.colours,
                Pens::FEW
            ));
        }
    }
}

fn pens(text: &str) -> Result<NonZero<usize>, String> {
    text.parse()
        .map_err(|_| "a plot has one pen or more: --pens 3".into())
}

/// Describes the cost of a plot: strokes, layers and pen-up travel.
pub(super) fn described(plotted: &Plotted) -> String {
    let layers = match plotted.layers {
        1 => String::new(),
        layers => format!(" in {}", wording::counted(&layers.into(), "layer")),
    };
    format!(
        "{}{layers} of {:.0} mm, {:.0} mm from stroke to stroke (as drawn: {:.0} mm), {} left out as \
         drawn before",
        wording::counted(&plotted.strokes.into(), "stroke"),
        plotted.drawn,
        plotted.carried,
        plotted.carried_as_drawn,
        wording::counted(&plotted.repeated.into(), "edge"),
    )
}
