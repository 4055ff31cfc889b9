//! `kfrac animate`: films of families, of growth, of zooms, and of turns in space.

mod endless;
mod file;
mod fit;
mod forecast;
mod frames;
mod passed;
mod plan;
mod target;
mod timeline;
mod vector;
mod video;

use std::num::NonZero;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use clap::ValueHint;

use crate::catalogue::Catalogue;
use crate::diagnostic::Source;
use crate::document::Document;
use crate::film::Rate;

use super::exchanged::ExchangedComponents;
use super::family::Assignment;
use super::growth::{self, Seeds};
#[cfg(feature = "studio")]
use super::held;
use super::held::Held;
#[cfg(feature = "studio")]
use super::input;
use super::length::Paper;
use super::rule::{Loaded, RuleArguments};
use super::steps::Several;
use super::{Failure, help, length, number, picture, rule, steps, text, tween};
use crate::figure::sheet::CellView;
pub(super) use file::mistakes;
use passed::{FrameOptions, Given};
use plan::Zooms;
use target::Format;
use timeline::Keys;

pub(crate) use timeline::Ease;
pub(super) use timeline::Moment;

/// Draws a film: a family of fractals, growth, a zoom, or a turn in space
///
/// Without options, it is the film that the file describes by `animation`. Every frame is the picture that `kfrac grow` draws with the values of its moment. Ranges such as angle=10..80 and lists
/// such as angle=10,80,40 change in the course of the film, any number of them together. The output file appears complete
/// or not at all, and its bytes do not depend on the number of threads.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    /// Rule file, name of a rule in the library, or - for standard input
    #[arg(value_name = "RULE")]
    rule: PathBuf,
    /// Output file, or - for standard output [default: NAME.gif]
    ///
    /// .gif, .png or .apng for an animated PNG, .y4m for other encoders, .mp4 and .webm by the program ffmpeg if it
    /// is installed. In an .svg the lines of one drawing move, up to 20,000 elements in all frames together; with
    /// --svg instanced there is no such limit. Browsers that animate paths by CSS show it, as Chromium does. A name
    /// with a number, as film-%04d.png, is a PNG for each frame; those of the plane that exist already, drawn by an
    /// equal command, are kept.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Output format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<Format>())]
    format: Option<Format>,
    /// Sets a parameter of the rule, or changes it; may be given several times
    ///
    /// As angle=30, angle=10..80, angle=10,80,40, s=[0,0.5]..[0.5,0.5], or s=circle([0,0],0.7) for a complex parameter that
    /// moves once around a circle.
    #[arg(long, value_name = "NAME=VALUE", value_parser = super::family::assignment)]
    set: Vec<Assignment>,
    /// Number of steps, or several as 0..6, between which the fractal grows
    ///
    /// The elements of a step move from those that they replace to their places.
    #[arg(long, short, value_name = "STEPS", value_parser = steps::parse_several, allow_hyphen_values = true)]
    steps: Option<Several>,
    /// Changes from step to step at once
    #[arg(long, requires = "steps")]
    cuts: bool,
    /// Leads from the rule to another one of its kind
    ///
    /// Generators, elements, maps, objects and instances correspond to each other by their order; one that has no
    /// counterpart grows out of a point.
    #[arg(long, value_name = "RULE2", help_heading = "Tween")]
    to: Option<PathBuf>,
    /// Draws the picture line by line, as a pen does
    #[arg(long)]
    draw: bool,
    /// Seed of random draws, or several as 1..24, each for an equal part of the film
    #[arg(long, value_name = "S", default_value = "0", value_parser = growth::parse_seeds)]
    seed: Seeds,
    /// Magnification, from one to another as 1..1e100, or loop: the period of the address --at, which repeats exactly
    #[arg(long, value_name = "ZOOM", value_parser = Zooms::parse)]
    zoom: Option<Zooms>,
    /// Degrees by which a set of the plane is turned, as 0..360
    #[arg(long, value_name = "DEGREES", value_parser = Keys::parse, allow_hyphen_values = true)]
    turn: Option<Keys>,
    /// Azimuth and elevation in degrees from which a set in space is seen, as 0..360,25
    #[arg(long, value_name = "AZ,EL", value_parser = timeline::direction, allow_hyphen_values = true)]
    from: Option<[Keys; 2]>,
    /// Number of frames in which something changes [default: 60, or the number of seeds]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of frames", 1..=100_000_u32))]
    frames: Option<u32>,
    /// Frames a second
    #[arg(long, value_name = "F", default_value = "30", value_parser = timeline::rate)]
    fps: Rate,
    /// The first frame follows the last one: a range such as angle=0..360 has no last value, a list returns to its first
    #[arg(long = "loop", conflicts_with = "bounce")]
    is_loop: bool,
    /// The second half of the film goes back
    #[arg(long)]
    bounce: bool,
    /// Number of further frames for which the first and the last one, with --bounce the one at the turn, are kept, each
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = number::whole("a number of frames", 0..=10_000_u32))]
    hold: u32,
    /// Course of time between key frames [default: in-out, or linear with --loop, --zoom and --seed]
    #[arg(long, value_parser = picture::named::<Ease>())]
    ease: Option<Ease>,
    /// Passes through the key frames of a list on a smooth curve, without rest
    #[arg(long)]
    smooth: bool,
    /// Part of the plane that is shown: what all frames need, or each frame its own
    #[arg(long, value_parser = picture::named::<CellView>(), default_value = "all")]
    fit: CellView,
    /// Shows the film once, not without end
    #[arg(long)]
    once: bool,
    /// Numbers of the frames to draw, from 0, of a film in PNGs: 30..40
    #[arg(long, value_name = "FRAMES", value_parser = steps::parse_several)]
    only: Option<Several>,
    /// Long side of the frames in pixels, or WIDTHxHEIGHT
    #[arg(long, value_name = "SIZE", default_value = "640", value_parser = length::paper, help_heading = "Picture")]
    size: Paper,
    /// Number of threads, each of which draws a frame [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// Suppresses all messages except errors
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    others: FrameOptions,
    /// Flag that ends a film that is drawn within the program.
    #[arg(skip)]
    held: Option<Arc<Held>>,
}

const MORE: &str = "\
Examples:
  kfrac animate pythagoras --set angle=20..70 --bounce -o sway.gif
      Bends the Pythagoras tree to and fro
  kfrac animate complex-pair --set 's=circle([0,0],0.72)' --loop --frames 120 -o orbit.png
      Leads a complex parameter around a circle, as an animated PNG without end
  kfrac animate koch-snowflake --steps 0..5 --frames 150 -o grow.gif
      Grows the snowflake, step by step
  kfrac animate koch --zoom loop --at '0.(1)' --detail 0.5 -o endless.gif
      Magnifies a curve without end
  kfrac animate koch --zoom 1..1e100 --at '0.(1)' --frames 900 -o deep.mp4
      Magnifies it by a factor of 1e100, by ffmpeg
  kfrac animate random-tree --seed 1..24 --fps 4 -o trees.gif
      Shows 24 individuals of a random tree
  kfrac animate menger --from 0..360,25 --loop -o turn.gif
      Turns a set in space
  kfrac animate koch --to levy --steps 6 --bounce -o tween.gif
      Leads from a curve to another one and back
  kfrac animate dragon --draw --steps 8 -o draw.gif
      Draws a curve from its start to its end
  kfrac animate pythagoras --set angle=20..70 -o - | ffmpeg -i - -pix_fmt yuv420p sway.mp4
      Pipes the frames to an encoder, with its own options
  kfrac animate pythagoras --set angle=20..70 --only 30..40 -o sway-%04d.png
      Draws eleven frames, each into a file
";

/// Draws a film of a text as `kfrac animate` with the arguments does; returns a summary.
#[cfg(feature = "studio")]
pub(crate) fn hold(
    arguments: &[String],
    source: &Arc<Source>,
    catalogue: &Catalogue,
    held: Arc<Held>,
) -> Result<String, Failure> {
    let mut arguments: Arguments = held::parsed("animate", arguments)?;
    (arguments.held, arguments.quiet) = (Some(held), true);
    arguments.write(source, catalogue)
}

/// Returns the names and values of the parameters that `kfrac animate` with the arguments sets in every frame.
#[cfg(feature = "studio")]
pub(crate) fn values(
    arguments: &[String],
    source: &Arc<Source>,
    catalogue: &Catalogue,
) -> Result<Vec<Vec<(String, String)>>, Failure> {
    let given: Arguments = held::parsed("animate", arguments)?;
    let arguments = given.completed(&input::document(source, catalogue)?)?;
    let arguments = arguments.unwrap_or(given);
    let timeline = plan::timeline(&arguments);
    timeline.check()?;
    let tracks = || arguments.set.iter().flat_map(Assignment::tracks);
    let values = |number: u32| {
        let moment = timeline.moment(number);
        let written = tracks().map(|track| track.at(&moment));
        let pairs = written.map(|it| {
            it.split_once('=')
                .map(|(a, b)| (a.to_owned(), b.to_owned()))
        });
        pairs.flatten().collect()
    };
    Ok((0..timeline.count()).map(values).collect())
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    let source = rule::open(&arguments.rule, catalogue)?;
    let report = arguments.write(&source, catalogue)?;
    if !arguments.quiet {
        text::print_message(&format!("{report}, {:.2} s", start.elapsed().as_secs_f64()));
    }
    Ok(())
}

impl Arguments {
    /// Returns the arguments with the options of the file.
    fn completed(&self, document: &Document) -> Result<Option<Self>, Failure> {
        let completed = file::complete(self, document)?;
        Ok(completed.map(|completed| Self {
            held: self.held.clone(),
            quiet: self.quiet,
            ..completed
        }))
    }

    /// Writes the film of a text, and describes what has been written.
    fn write(&self, source: &Arc<Source>, catalogue: &Catalogue) -> Result<String, Failure> {
        let named = RuleArguments {
            rule: self.rule.clone(),
            set: Vec::new(),
            omit: Vec::new(),
            components: ExchangedComponents::default(),
        };
        let mut loaded: Loaded = named.load_from(source, catalogue, self.quiet)?;
        let completed = self.completed(&loaded.document)?;
        let arguments = completed.as_ref().unwrap_or(self);
        let other = { arguments.to.as_ref() }.map(|to| tween::load(to, catalogue, arguments.quiet));
        let other = other.transpose()?;
        let half_way = { other.as_ref() }.map(|other| plan::half_way(arguments, &loaded, other));
        let half_way = half_way.transpose()?;
        loaded.beside = other.into_iter().map(|it| (it.name, it.document)).collect();
        let default = named.file("", "gif");
        let path = arguments.output.as_ref().unwrap_or(&default);
        let format = Format::of(arguments, path)?;
        let is_vector = format == Some(Format::Svg);
        if arguments.others.gives("svg") && !is_vector {
            let message = "--svg applies to SVG only: write a .svg";
            return Err(Failure::Usage(message.into()));
        }
        let film = plan::film(arguments, &loaded, half_way, catalogue, path)?;
        if !arguments.quiet && !is_vector {
            let note = forecast::note(&film, format)?;
            note.iter().for_each(|note| text::print_message(note));
        }
        target::write(arguments, film, &loaded, format, path)
    }
}
