//! `kfrac map`: maps of the parameters of a system.

use std::fmt::Write as _;
use std::io::Write;
use std::num::NonZero;
use std::path::PathBuf;
#[cfg(feature = "studio")]
use std::sync::Arc;
use std::time::Instant;

use anyhow::anyhow;
use clap::ValueHint;

use crate::catalogue::Catalogue;
#[cfg(feature = "studio")]
use crate::diagnostic::Source;
use crate::family::{
    Family, FamilyError, MapOptions, ParameterMap, ParameterPlane, ParameterRange, PlaneError,
    PlaneValue, Property,
};
use crate::ifs::ConnectednessSearch;
use crate::parallel::all_cores;
use crate::render::{self, Size};
use crate::style::{Named, Palette};

use super::family::Ranges;
#[cfg(feature = "studio")]
use super::held::{self, Held};
use super::labels::labels;
use super::palette::PaletteParser;
use super::rule::{Loaded, RuleArguments};
use super::{Failure, format, growth, help, length, number, output, picture, readable, text};

/// Draws a map of one or two parameters of a system
///
/// Every pixel is a value of a complex parameter or of two real ones, or every column one of a real parameter. Its colour
/// shows whether the attractor is connected, its similarity dimension, or its area. A smaller range magnifies a part of a map.
///
/// The system lies in the plane, has no condensation sets and is not recurrent. A path that is found in a map is followed
/// by `kfrac animate` and `kfrac sheet`: --set 's=[0.3,0.5]..[0.6,0.3]', lists of values, and circles.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Range of a parameter, as angle=0..90, or s=[-1,-1]..[1,1] for a complex one
    ///
    /// Two real parameters have a range each, the first of which runs to the right and the second up.
    #[arg(long, required = true, value_name = "NAME=FROM..TO", value_parser = super::family::ranges)]
    over: Vec<Ranges>,
    /// Property of the attractor that is shown
    ///
    /// connected: the number of maps in the compositions by which the attractor is certified to be disconnected; pixels
    /// without a certificate are dark, and those where a theorem states that the attractor is connected less dark.
    /// dimension: the similarity dimension of similarities, with overlaps counted; the Hausdorff dimension is at most as
    /// large. area: an upper bound of the area, by a cover of boxes.
    #[arg(long, value_parser = picture::named::<Property>(), default_value = "connected")]
    of: Property,
    /// Depth of the search: the largest number of maps in compositions for connected [default: 32], the number of
    /// divisions of a square into four for area [default: 6]
    #[arg(long, value_name = "N", value_parser = number::whole("a depth", 1..=ConnectednessSearch::MAX_DEPTH))]
    depth: Option<u32>,
    /// Output file, .png or .csv, or - for standard output [default: NAME-map.png]
    ///
    /// A table has a row for each pixel, with its values of the parameters, x and y, and a number, or one of not-certified,
    /// connected, undecided, no-similarity, does-not-contract and no-system.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Output format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<Format>())]
    format: Option<Format>,
    /// Long side of the map in pixels, or WIDTHxHEIGHT [default: 512; 128 for area, which takes longer]
    #[arg(long, value_name = "SIZE", value_parser = length::size)]
    size: Option<Size>,
    /// Palette of the numbers
    #[arg(long, value_name = "PALETTE", value_parser = PaletteParser, default_value = "inferno")]
    palette: Palette,
    /// Number of threads [default: the number of cores]
    ///
    /// The output does not depend on it.
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// Suppresses all messages except errors
    #[arg(long, short)]
    quiet: bool,
}

const MORE: &str = "\
Examples:
  kfrac map complex-pair --over 's=[-1,-1]..[1,1]'
      Draws the Mandelbrot set for pairs of maps, into complex-pair-map.png
  kfrac map complex-pair --over 's=[0.55,0.1]..[0.65,0.2]' --depth 60 --size 300 -o part.png
      Magnifies a part of its boundary
  kfrac map complex-pair --over 's=[-0.7,-0.7]..[0.7,0.7]' --of dimension -o dimension.png
      Draws the similarity dimension
  kfrac map complex-pair --over 's=[0.4,0]..[0.7,0.3]' --of area --depth 5 --size 32 -o area.png
      Draws an upper bound of the area
  kfrac map complex-pair --over s.re=0..1 --set s.im=0 --size 100x1 -o line.csv
      Lists a line in the plane
";

/// Formats of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Png,
    Csv,
}

impl Named for Format {
    const NAMES: &'static [(&'static str, Self)] = &[("png", Self::Png), ("csv", Self::Csv)];
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let loaded = arguments.rule.load(catalogue, arguments.quiet)?;
    let plane = arguments.plane(&loaded)?;
    let family = arguments.family(&loaded, &plane)?;
    let default = arguments.rule.file("-map", format.name());
    let path = arguments.output.as_ref().unwrap_or(&default);
    let (map, bytes) = output::write(path, arguments.quiet, |out, progress| {
        let options = MapOptions {
            progress,
            ..arguments.map_options()
        };
        let map = ParameterMap::compute(&family, &plane, &options).map_err(usage)?;
        match format {
            Format::Csv => write_table(&map, out).map_err(|error| output::failed(error, path))?,
            Format::Png => {
                let options = arguments.options(&loaded);
                let written = map.pixels(&arguments.palette).write(&options, out);
                written.map_err(|error| output::explain(error, path))?;
            }
        }
        Ok(map)
    })?;
    if !arguments.quiet {
        let [width, height] = plane.size();
        text::print_message(&format!(
            "{}: {} over {}, {width} x {height} pixels, {}, {:.2} s",
            output::called(path),
            arguments.of.name(),
            arguments.names(),
            readable::bytes(bytes),
            start.elapsed().as_secs_f64(),
        ));
        for line in arguments.legend(&map, format) {
            text::print_message(&line);
        }
    }
    Ok(())
}

/// Draws a map of a text as `kfrac map` with the arguments does, as a PNG in memory.
#[cfg(feature = "studio")]
pub(crate) fn hold(
    arguments: &[String],
    source: &Arc<Source>,
    catalogue: &Catalogue,
    held: &Held,
) -> Result<(), Failure> {
    let arguments: Arguments = held::parsed("map", arguments)?;
    let loaded = arguments.rule.load_from(source, catalogue, true)?;
    let plane = arguments.plane(&loaded)?;
    let family = arguments.family(&loaded, &plane)?;
    let options = MapOptions {
        cancel: Some(&held.cancel),
        ..arguments.map_options()
    };
    let map = ParameterMap::compute(&family, &plane, &options).map_err(usage)?;
    let pixels = map.pixels(&arguments.palette);
    held.done().bytes = pixels.into_png(held.png).map_err(anyhow::Error::new)?;
    Ok(())
}

fn usage(error: PlaneError) -> Failure {
    Failure::Usage(error.to_string())
}

/// Writes a row for each pixel, from the upper left.
fn write_table(map: &ParameterMap, out: &mut impl Write) -> std::io::Result<()> {
    let [width, height] = map.plane().size();
    let has_two = map.plane().axes().len() == 2;
    out.write_all(if has_two {
        b"x,y,value\n"
    } else {
        b"x,value\n"
    })?;
    // Rows of a strip are equal.
    for row in 0..if has_two { height } else { 1 } {
        for column in 0..width {
            let [x, y] = map.plane().values(column, row);
            let value = map.value(column, row);
            match has_two {
                true => writeln!(out, "{x},{y},{value}")?,
                false => writeln!(out, "{x},{value}")?,
            }
        }
    }
    Ok(())
}

impl Arguments {
    fn depth(&self) -> u32 {
        self.depth.unwrap_or(self.of.depth())
    }

    fn size(&self) -> Size {
        let default = if self.of == Property::Area { 128 } else { 512 };
        self.size.unwrap_or(Size::Long(default))
    }

    fn map_options(&self) -> MapOptions<'static> {
        MapOptions {
            depth: self.depth(),
            threads: self.threads.unwrap_or_else(all_cores),
            ..MapOptions::new(self.of)
        }
    }

    /// Returns the names of the parameters.
    fn names(&self) -> String {
        let names: Vec<_> = self.over.iter().map(|it| it.name.as_str()).collect();
        names.join(" and ")
    }

    /// Returns the plane of parameters: with square pixels for a complex parameter.
    fn plane(&self, loaded: &Loaded) -> Result<ParameterPlane, Failure> {
        const STRIP: u32 = 8;
        if self.depth.is_some_and(|depth| depth > MAX_DIVISIONS) && self.of == Property::Area {
            let message = format!("--depth of an area is at most {MAX_DIVISIONS}");
            return Err(Failure::Usage(message));
        }
        let axes = self.over.iter().flat_map(|it| it.axes.clone());
        let axes: Vec<ParameterRange> = axes.collect();
        let size = match (self.size(), &axes[..]) {
            (Size::Exactly(width, height), _) => [width, height],
            (Size::Long(side), [_]) => [side, (side / STRIP).max(1)],
            (Size::Long(side), [x, y]) if self.over.len() == 1 => {
                let [width, height] = [x, y].map(|axis| (axis.to - axis.from).abs());
                let long = width.max(height);
                [width, height].map(|own| scaled(side, own / long))
            }
            (Size::Long(side), _) => [side, side],
        };
        for axis in &axes {
            check_limits(axis, loaded)?;
        }
        ParameterPlane::new(axes, size).map_err(usage)
    }

    fn family(&self, loaded: &Loaded, plane: &ParameterPlane) -> Result<Family, Failure> {
        let names: Vec<String> = plane.axes().iter().map(|it| it.name.clone()).collect();
        let family = Family::of(&loaded.document, &loaded.settings, &names);
        let family = family.map_err(|error| match error {
            FamilyError::Mistakes(mistakes) => Failure::File(mistakes),
            error @ FamilyError::NoParameter { .. } => {
                Failure::Usage(format!("--over: {}: {error}", loaded.name))
            }
            error => anyhow!("{}: {error}", loaded.name).into(),
        })?;
        let omitted = loaded.omitted.iter().map(|number| *number as usize - 1);
        Ok(family.omitting(&omitted.collect::<Vec<_>>()))
    }

    fn options(&self, loaded: &Loaded) -> render::Options {
        let over = self.over.iter();
        let mut options: Vec<_> = over.map(|it| ("over", it.written.clone())).collect();
        options.push(("of", self.of.name().into()));
        options.extend(self.depth.map(|depth| ("depth", depth.to_string())));
        options.push(("size", self.size().to_string()));
        options.push(("palette", self.palette.to_string()));
        let shown = format!("Map of {} ({})", self.names(), self.of.name());
        render::Options {
            labels: labels(loaded, &shown, "map", options),
            ..render::Options::default()
        }
    }

    /// Returns the legend, a line for each kind of value with its share of the pixels.
    fn legend(&self, map: &ParameterMap, format: Format) -> Vec<String> {
        let legend = map.legend();
        #[expect(clippy::cast_precision_loss, reason = "a share is rounded anyway")]
        let share = |count: u64| 100.0 * count as f64 / map.values().len() as f64;
        let depth = self.depth();
        let mut lines = Vec::new();
        if let Some([least, most]) = legend.range {
            let [from, to] = [least, most].map(|it| readable::measure(it, 1.0));
            let meaning = match self.of {
                Property::Connected => {
                    format!("disconnected, certified by compositions of {least} to {most} maps")
                }
                Property::Dimension if most > 2.0 => {
                    format!("similarity dimension from {from} to {to}, coloured up to 2")
                }
                Property::Dimension => format!("similarity dimension from {from} to {to}"),
                Property::Area => format!("area at most from {from} to {to}"),
            };
            lines.push((legend.numbers, meaning, self.palette.to_string()));
        }
        for entry in legend.others {
            let meaning = match entry.value {
                PlaneValue::Number(_) => continue,
                PlaneValue::Connected => "connected, by a theorem".into(),
                PlaneValue::NotCertified => {
                    format!("not certified to be disconnected by compositions of {depth} maps")
                }
                PlaneValue::Undecided => "undecided within the budget of a pixel".into(),
                PlaneValue::NotSimilar => "a map is no similarity".into(),
                PlaneValue::DoesNotContract => "the system does not contract".into(),
                PlaneValue::NoSystem => "the file admits no system".into(),
            };
            let [red, green, blue, _] = entry.colour.rgba();
            let colour = format!("#{red:02x}{green:02x}{blue:02x}");
            lines.push((entry.count, meaning, colour));
        }
        let line = |(count, meaning, colour): (u64, String, String)| {
            let mut line = format!("{:5.1} %  {meaning}", share(count));
            if format == Format::Png {
                // Writing to a string does not fail.
                let _ = write!(line, " ({colour})");
            }
            line
        };
        lines.into_iter().map(line).collect()
    }
}

/// Largest number of divisions of a square.
const MAX_DIVISIONS: u32 = 10;

/// Returns a share of a side, at least a pixel.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the share is from 0 to 1"
)]
fn scaled(side: u32, share: f64) -> u32 {
    ((f64::from(side) * share).round() as u32).max(1)
}

/// Returns an error if an axis exceeds the limits of its parameter.
fn check_limits(axis: &ParameterRange, loaded: &Loaded) -> Result<(), Failure> {
    let parameters = &loaded.model.metadata().parameters;
    let Some(parameter) = parameters.iter().find(|it| it.name == axis.name) else {
        return Ok(());
    };
    let (from, to) = (axis.from.min(axis.to), axis.from.max(axis.to));
    let limits = match (parameter.min, parameter.max) {
        (Some(min), _) if from < min => format!("its least value is {min}"),
        (_, Some(max)) if to > max => format!("its largest value is {max}"),
        _ => return Ok(()),
    };
    let message = format!("--over {}={}..{}: {limits}", axis.name, axis.from, axis.to);
    Err(Failure::Usage(message))
}
