//! `--zoom` and `--at`: small parts of a rule, drawn large.

use std::fmt::Write as _;

use crate::render::{Empty, Look, Nearest};
use crate::wording;
use crate::zoom::{Address, Factor, Source};

use super::Failure;
use super::rule::Loaded;

/// What of a rule is drawn, and how large.
#[derive(clap::Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct ZoomArguments {
    /// Draws what lies about the point of --at so much larger: 250, 1e1000, 3^5000
    ///
    /// Everything that can be seen is grown, as with --detail, which says down to what size (1 pixel
    /// unless given). A zoom of 1 is as large as the whole picture, or as the window that the rule
    /// proposes; there is no largest one but for the time that it takes.
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    zoom: Option<Factor>,
    /// The point in the middle: positions on the way to it, such as 0.2.(1), or X,Y
    ///
    /// The first position is that of an element in the initiator, or of an object in a scene; for a
    /// system of maps it is 0. Each of the others is the position, in what replaces the element, as
    /// listed and from 0 across all parts, or the map's, or the line's in the word of an L-system. What stands in brackets is
    /// repeated for ever; shells want such an address in quotes.
    #[arg(long, value_name = "ADDRESS", allow_hyphen_values = true)]
    at: Option<Address>,
}

impl ZoomArguments {
    /// Whether a part is to be drawn.
    pub(super) fn is_asked(&self) -> bool {
        self.zoom.is_some() || self.at.is_some()
    }

    /// What is to be looked at, if that is asked for.
    pub(super) fn look(&self, has_view: bool) -> Result<Option<Look>, Failure> {
        let usage = |message: &str| Err(Failure::Usage(message.into()));
        let look = match (&self.zoom, &self.at) {
            (None, None) => return Ok(None),
            (Some(_), None) => {
                return usage("--zoom needs --at: the point in the middle, such as 0.(1) or 0.5,0");
            }
            (factor, Some(at)) => Look {
                factor: factor.clone().unwrap_or_else(Factor::one),
                at: at.clone(),
            },
        };
        if has_view {
            return usage(
                "--zoom and --at say what is shown, and so does --view: give one of them",
            );
        }
        Ok(Some(look))
    }

    /// The options as the command line has them.
    pub(super) fn options(&self) -> impl Iterator<Item = (&'static str, String)> {
        let zoom = self.zoom.as_ref().map(|zoom| ("zoom", zoom.to_string()));
        let at = self.at.as_ref().map(|at| ("at", at.to_string()));
        zoom.into_iter().chain(at)
    }
}

impl Loaded {
    /// The model with the file that says its numbers.
    pub(super) fn source(&self) -> Source<'_> {
        Source {
            document: &self.document,
            settings: &self.settings,
            model: &self.model,
            omitted: &self.omitted,
        }
    }
}

/// What is said of a picture that shows nothing.
pub(super) fn nothing(name: &str, empty: &Empty) -> String {
    let short = |value: f64| {
        let value = wording::two_digits(value);
        if (1e-4..1e6).contains(&value) {
            value.to_string()
        } else {
            format!("{value:e}")
        }
    };
    let mut text = format!("note: nothing of {name} lies within the window");
    if let Some(Nearest { distance, factor }) = empty.nearest {
        let _ = write!(
            text,
            "; the nearest of it is about {} from the middle",
            short(distance)
        );
        // Two digits are not to lead back past the edge.
        let factor = 0.95 * factor;
        if factor >= Factor::LEAST {
            let _ = write!(text, ", and --zoom {} shows that", short(factor));
        }
    }
    text
}
