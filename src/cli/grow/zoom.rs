//! `--zoom` and `--at`: magnified parts of a rule.

use std::fmt::Write as _;

use crate::render::{Empty, NearestPoint, ZoomTarget};
use crate::zoom::{Address, Factor};

use super::super::{Failure, readable};

/// Options of zooms.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Picture")]
pub(super) struct ZoomArguments {
    /// Magnifies the neighbourhood of the point given by --at, or in space by --look-at: 250, 1e1000, 3^5000
    ///
    /// In the plane, all visible elements are grown, as with --detail, which sets their smallest size (1 pixel by default).
    /// A zoom of 1 has the scale of the whole picture, or of the window of the rule. The zoom is limited only by the time
    /// that it takes; in space, to 1e5 by the depths of the pixels.
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    zoom: Option<Factor>,
    /// Centre of the zoom: an address (a list of positions) such as 0.2.(1), or a point X,Y with any number of digits
    ///
    /// The first position is that of an element in the initiator or of an object in a scene; for a system of
    /// maps, it is 0. Each further position is that of an element in the generator (in the order of the file,
    /// from 0, across all parts), of a map, or of a line in the word of an L-system. Positions in brackets
    /// are repeated without end; shells require such an address in quotes.
    #[arg(long, value_name = "ADDRESS", allow_hyphen_values = true)]
    at: Option<Address>,
}

impl ZoomArguments {
    /// Returns whether a zoom is requested.
    pub(super) fn is_asked(&self) -> bool {
        self.zoom.is_some() || self.at.is_some()
    }

    /// Returns whether a centre is given.
    pub(super) fn has_centre(&self) -> bool {
        self.at.is_some()
    }

    /// Returns the magnification of a set in space.
    pub(super) fn in_space(&self) -> Option<f64> {
        self.zoom.as_ref().map(Factor::to_f64)
    }

    /// Returns the zoom of a set of the plane, if a centre is given: `turn` is the angle in degrees by which it is turned.
    pub(super) fn target(&self, turn: Option<f64>) -> Option<ZoomTarget> {
        Some(ZoomTarget {
            factor: self.zoom.clone().unwrap_or_else(Factor::one),
            at: self.at.clone()?,
            turn: turn.unwrap_or(0.0),
        })
    }

    /// Returns an error for a zoom of a set of the plane without a centre, and for one between steps.
    pub(super) fn check_in_plane(&self, is_between_steps: bool) -> Result<(), Failure> {
        if self.zoom.is_some() && self.at.is_none() {
            let message = "--zoom needs --at: the centre, such as 0.(1) or 0.5,0";
            return Err(Failure::Usage(message.into()));
        }
        if self.is_asked() && is_between_steps {
            let message =
                "--zoom draws whole steps, and --between a part of one: give only one of them";
            return Err(Failure::Usage(message.into()));
        }
        Ok(())
    }

    /// Returns the options that are given, with their values.
    pub(super) fn options(&self) -> impl Iterator<Item = (&'static str, String)> {
        let zoom = self.zoom.as_ref().map(|zoom| ("zoom", zoom.to_string()));
        let at = self.at.as_ref().map(|at| ("at", at.to_string()));
        zoom.into_iter().chain(at)
    }
}

/// Returns the note for a picture that shows nothing.
pub(super) fn nothing(name: &str, empty: &Empty) -> String {
    let short = |value: f64| {
        let value = readable::two_digits(value);
        if (1e-4..1e6).contains(&value) {
            value.to_string()
        } else {
            format!("{value:e}")
        }
    };
    let mut text = format!("note: no part of {name} lies within the window");
    if let Some(NearestPoint { distance, factor }) = empty.nearest {
        let _ = write!(
            text,
            "; the nearest part is about {} from the centre",
            short(distance)
        );
        // Rounding to two digits must not move the nearest part out of the window.
        let factor = 0.95 * factor;
        if factor >= Factor::LEAST {
            let _ = write!(text, ", and --zoom {} shows it", short(factor));
        }
    }
    text
}
