//! `--plot` and `--pens`: single strokes for plotters and cutters.

use std::num::NonZero;

use crate::render::{Pens, Plotted};

use super::super::picture::PictureArguments;
use super::super::readable;

/// Options of plots.
#[derive(clap::Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct PlotArguments {
    /// Draws single strokes, for a plotter or a cutter; DXF files always have them
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

    /// Returns the options that are given, with their values.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let plot = self.plot.then(|| ("plot", String::new()));
        let pens = self.pens.map(|pens| ("pens", pens.to_string()));
        plot.into_iter().chain(pens).collect()
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
