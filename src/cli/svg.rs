//! `--svg`: what an SVG is made of.

use crate::render::Instanced;
use crate::style::Named;
use crate::wording;

use super::picture::named;
use super::text;

/// How an SVG is written.
#[derive(clap::Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct SvgArguments {
    /// What an SVG is made of: every line there is, or nested instances
    ///
    /// With plain, the default, lines are written one by one. With instanced there is a symbol an object
    /// and number of steps, each made of instances of others, so that the file grows with the steps and
    /// not with the elements: --max-elements does not count, and --detail is not needed. Who shows it has
    /// to expand every instance nevertheless: 200,000 of them take a browser some 15 seconds and 2 GB,
    /// 700,000 a minute and 5 GB, and with millions it gives up. Strokes in pixels do not scale with the
    /// picture, which some programs do not know (vector-effect); browsers do.
    #[arg(long, value_name = "KIND", value_parser = named::<Svg>(), default_value = "plain")]
    svg: Svg,
}

/// What an SVG is made of.
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

    /// The option as the command line has it, where it says anything.
    pub(super) fn options(&self) -> Option<(&'static str, String)> {
        self.is_instanced()
            .then(|| ("svg", self.svg.name().to_string()))
    }
}

/// Chromium 156 shows so many within ten seconds, and takes 7 kB of memory for each.
const MANY: f64 = 1e5;
const TOO_MANY: f64 = 1e6;

/// Says that browsers may not come to an end.
pub(super) fn warn(instanced: &Instanced) {
    if instanced.expanded > MANY {
        let outcome = if instanced.expanded > TOO_MANY {
            "and give up with millions"
        } else {
            "which takes them long"
        };
        text::say(&format!(
            "warning: browsers expand every instance, {} of them, {outcome}",
            count(instanced.expanded)
        ));
    }
}

/// What a picture is made of, in words.
pub(super) fn described(instanced: &Instanced) -> String {
    format!(
        "{}, {} when expanded",
        wording::counted(&instanced.symbols.into(), "symbol"),
        count(instanced.expanded)
    )
}

/// A number of any size, to two digits where it is large.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "numbers from 0 to a million"
)]
fn count(number: f64) -> String {
    if number.is_infinite() {
        "more than 1e308".into()
    } else if number < 1e6 {
        wording::grouped(&(number as u64).into())
    } else {
        format!("about {number:.1e}")
    }
}
