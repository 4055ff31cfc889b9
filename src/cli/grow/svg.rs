//! `--svg`: plain and instanced SVG files.

use crate::render::Instanced;
use crate::style::Named;

use super::super::picture::named;
use super::super::readable;

/// Option of SVG files.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Picture")]
pub(super) struct SvgArguments {
    /// Structure of an SVG: every single line, or nested instances
    ///
    /// With plain, the default, lines are written one by one. With instanced, there is a symbol for each
    /// object and number of steps, which consists of instances of other symbols. The size of the file grows
    /// with the steps and not with the elements: --max-elements does not apply, and --detail is not needed.
    /// Viewers still have to expand every instance: 200,000 instances take a browser about 15 seconds and 2
    /// GB, 700,000 a minute and 5 GB, and millions make it give up. Strokes in pixels do not scale with the
    /// picture (vector-effect), which browsers support and some programs do not.
    #[arg(long, value_name = "KIND", value_parser = named::<Svg>(), default_value = "plain")]
    svg: Svg,
}

/// Structure of an SVG.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Svg {
    Plain,
    Instanced,
}

impl Named for Svg {
    const NAMES: &'static [(&'static str, Self)] =
        &[("plain", Self::Plain), ("instanced", Self::Instanced)];
}

impl SvgArguments {
    pub(super) fn is_instanced(&self) -> bool {
        self.svg == Svg::Instanced
    }

    /// Returns the option with its value, unless it has the default.
    pub(super) fn options(&self) -> Option<(&'static str, String)> {
        self.is_instanced()
            .then(|| ("svg", self.svg.name().to_string()))
    }
}

/// Number of instances that Chromium 156 shows within ten seconds, at 7 kB of memory each; [`TOO_MANY`] make
/// it give up.
const MANY: f64 = 1e5;
const TOO_MANY: f64 = 1e6;

/// Returns a warning if browsers may not be able to show the picture.
pub(super) fn warning(instanced: &Instanced) -> Option<String> {
    (instanced.expanded > MANY).then(|| {
        let outcome = if instanced.expanded > TOO_MANY {
            "and give up on millions"
        } else {
            "which takes a long time"
        };
        format!(
            "warning: browsers expand every instance, {} of them, {outcome}",
            count(instanced.expanded)
        )
    })
}

/// Formats the numbers of symbols and instances.
pub(super) fn described(instanced: &Instanced) -> String {
    format!(
        "{}, {} when expanded",
        readable::counted(&instanced.symbols.into(), "symbol"),
        count(instanced.expanded)
    )
}

/// Formats a number of any size, with two digits if it is large.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "numbers from 0 to a million"
)]
fn count(number: f64) -> String {
    if number.is_infinite() {
        "more than 1e308".into()
    } else if number < 1e6 {
        readable::grouped(&(number as u64).into())
    } else {
        format!("about {number:.1e}")
    }
}
