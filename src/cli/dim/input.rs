//! What is to be measured: found, read and measured.

use std::fs::File;
use std::io::{self, Cursor, Read};
use std::num::NonZero;
use std::path::Path;
use std::sync::Arc;

use anyhow::Context;

use crate::catalogue::Catalogue;
use crate::diagnostic::Source;
use crate::graph::Graph;
use crate::grow::{Growth, WalkError};
use crate::import::{Channel, Picture, read_points};
use crate::measure::exact::dimensions_of_graph;
use crate::measure::{Bits, BoxCounting, LimitSet, Masses, NoLimit, Points, grown};

use super::super::Failure;
use super::super::rule::Loaded;
use super::super::stop;
use super::{Arguments, Measured};

/// Graphs whose number of objects does not settle are resolved for so many steps.
pub(super) const STEPS: u32 = 64;

/// Files of pictures are no longer than this.
const MOST_BYTES: u64 = 1 << 31;

pub(super) fn measure(arguments: &Arguments, catalogue: &Catalogue) -> Result<Measured, Failure> {
    let path = &arguments.rule;
    let rules = || arguments.rules();
    let is_standard = path == Path::new("-");
    if !is_standard && !path.is_file() {
        // A name of the library, or nothing.
        return of_rule(arguments, &rules().load(catalogue, arguments.json)?);
    }
    let name = if is_standard {
        "standard input".into()
    } else {
        path.display().to_string()
    };
    let cannot = || format!("{name} cannot be read");
    let mut input: Box<dyn Read> = if is_standard {
        Box::new(io::stdin().lock())
    } else {
        Box::new(File::open(path).with_context(cannot)?)
    };
    let mut head = Vec::new();
    input
        .by_ref()
        .take(1 << 12)
        .read_to_end(&mut head)
        .with_context(cannot)?;
    let kind = Kind::of(path, &head);
    let mut whole = Cursor::new(head).chain(input);
    match kind {
        Kind::Picture => {
            let mut bytes = Vec::new();
            whole
                .take(MOST_BYTES)
                .read_to_end(&mut bytes)
                .with_context(cannot)?;
            let picture = Picture::read(&bytes, arguments.channel);
            drop(bytes);
            of_picture(arguments, &name, picture.with_context(|| name.clone())?)
        }
        Kind::Table => {
            let points = read_points(&mut whole, arguments.columns.as_ref());
            of_points(arguments, &name, points.with_context(|| name.clone())?)
        }
        Kind::Rule => {
            let loaded = if is_standard {
                let most = u64::try_from(Source::MOST_BYTES).unwrap_or(u64::MAX) + 1;
                let mut bytes = Vec::new();
                whole
                    .take(most)
                    .read_to_end(&mut bytes)
                    .with_context(cannot)?;
                let source: Arc<Source> = Source::read("<stdin>", bytes)?;
                rules().load_from(&source, catalogue, arguments.json)?
            } else {
                rules().load(catalogue, arguments.json)?
            };
            of_rule(arguments, &loaded)
        }
    }
}

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Rule,
    Picture,
    Table,
}

impl Kind {
    /// By how a file begins, or else by its name: a table's first line has a comma and is no YAML.
    fn of(path: &Path, head: &[u8]) -> Self {
        let extension = path
            .extension()
            .map(|it| it.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            _ if Picture::is_picture(head) => Self::Picture,
            Some("png" | "jpg" | "jpeg") => Self::Picture,
            Some("csv" | "txt") => Self::Table,
            Some("yaml" | "yml" | "json") => Self::Rule,
            _ => {
                let lines = head.split(|&byte| byte == b'\n');
                let first = lines
                    .map(<[u8]>::trim_ascii)
                    .find(|line| !line.is_empty() && !line.starts_with(b"#"));
                let is_row = first.is_some_and(|line| {
                    line.contains(&b',') && !line.iter().any(|byte| b":{[".contains(byte))
                });
                if is_row { Self::Table } else { Self::Rule }
            }
        }
    }
}

fn of_rule(arguments: &Arguments, loaded: &Loaded) -> Result<Measured, Failure> {
    let graph = loaded.compile(STEPS)?;
    let title = loaded.model.heading().description.title.clone();
    let mut measured = Measured {
        name: loaded.name.clone(),
        title: title.unwrap_or_else(|| loaded.name.clone()),
        set: "the limit set of what stays fertile".into(),
        unit: None,
        exact: Some(dimensions_of_graph(&graph)),
        counting: BoxCounting::default(),
        spectrum: Vec::new(),
        lacunarity: Vec::new(),
        warnings: Vec::new(),
    };
    let set = match LimitSet::of(&graph) {
        Ok(set) => set,
        Err(NoLimit::NotFixed | NoLimit::Endless) => return of_growth(arguments, &graph, measured),
        Err(error) => return Ok(measured.without(&error)),
    };
    let (grids, threads) = (arguments.grids(), arguments.threads());
    measured.counting = BoxCounting::of_limit(&set, arguments.base, &grids, threads);
    if measured.counting.boxes.is_empty() {
        return Ok(measured);
    }
    let masses = Masses::of_limit(&set);
    measured.spectrum = masses.spectrum(&arguments.orders, 0.0);
    measured.lacunarity = masses.lacunarity();
    Ok(measured)
}

/// What has to be grown to be known, by the draws of a seed.
fn of_growth(
    arguments: &Arguments,
    graph: &Graph,
    mut measured: Measured,
) -> Result<Measured, Failure> {
    const MOST_POINTS: usize = 1 << 20;
    let growth = Growth {
        cancel: Some(stop::flag()),
        seed: arguments.seed,
        ..Growth::steps(STEPS)
    };
    let grown = match grown(graph, &growth, MOST_POINTS) {
        Ok(grown) => grown,
        Err(WalkError::Cancelled) => return Err(Failure::Interrupted),
        Err(error) => return Ok(measured.without(&error)),
    };
    measured.set = format!(
        "{} fertile elements of lengths below {:.3e}, grown with seed {}",
        grown.points.len(),
        grown.detail,
        arguments.seed
    );
    let points = match Points::new(grown.points) {
        Ok(points) => points,
        Err(error) => return Ok(measured.without(&error)),
    };
    let (grids, threads) = (arguments.grids(), arguments.threads());
    measured.counting = BoxCounting::of_grown(&points, grown.detail, &grids, threads);
    let masses = Masses::of_points(&points);
    measured.spectrum = masses.spectrum(&arguments.orders, 4.0 * grown.detail);
    measured.lacunarity = masses.lacunarity();
    Ok(measured)
}

fn of_picture(arguments: &Arguments, name: &str, picture: Picture) -> Result<Measured, Failure> {
    let picture = if arguments.invert {
        picture.inverted()
    } else {
        picture
    };
    let threshold = arguments.threshold.unwrap_or_else(|| picture.otsu());
    let pixels = Bits::of_bytes(&picture.values, picture.width, picture.height, threshold);
    let (set, all) = (pixels.count(), picture.values.len() as u64);
    let quality = match (picture.channel, arguments.invert) {
        (Channel::Darkness, false) => "dark",
        (Channel::Darkness, true) => "light",
        (Channel::Alpha, false) => "opaque",
        (Channel::Alpha, true) => "transparent",
    };
    if set == 0 {
        let message = format!(
            "{name}: no pixel is {quality} (threshold {threshold}): try --invert or --threshold"
        );
        return Err(anyhow::anyhow!(message).into());
    }
    let mut warnings = Vec::new();
    if set > all / 2 && arguments.threshold.is_none() {
        warnings.push(format!(
            "{:.0} % of all pixels are {quality}: with --invert, the others are measured",
            part(set, all)
        ));
    }
    let base = whole(arguments.base)?;
    let counting = BoxCounting::of_pixels(&pixels, base, &arguments.grids(), arguments.threads());
    let finest = counting.estimate.map_or(1.0, |estimate| estimate.range[0]);
    let masses = Masses::of_pixels(&pixels);
    Ok(Measured {
        name: name.into(),
        title: name.into(),
        set: format!(
            "{set} {quality} pixels of {} x {} (threshold {threshold})",
            picture.width, picture.height
        ),
        unit: Some("pixels"),
        exact: None,
        counting,
        spectrum: masses.spectrum(&arguments.orders, finest),
        lacunarity: masses.lacunarity(),
        warnings,
    })
}

#[expect(clippy::cast_precision_loss, reason = "two digits are shown")]
fn part(some: u64, all: u64) -> f64 {
    100.0 * some as f64 / all as f64
}

/// The base for pictures.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "bases are small"
)]
fn whole(base: Option<f64>) -> Result<NonZero<usize>, Failure> {
    let base = base.unwrap_or(2.0);
    let whole = NonZero::new(base as usize).filter(|whole| base.fract() == 0.0 && whole.get() > 1);
    whole.ok_or_else(|| {
        Failure::Usage("--base: boxes of pictures grow by a whole number from 2 on".into())
    })
}

fn of_points(
    arguments: &Arguments,
    name: &str,
    points: Vec<crate::geometry::DVec2>,
) -> Result<Measured, Failure> {
    if arguments.base.is_some_and(|base| base != 2.0) {
        return Err(Failure::Usage("--base: boxes of points grow by 2".into()));
    }
    let count = points.len();
    let mut measured = Measured {
        name: name.into(),
        title: name.into(),
        set: format!("{count} points"),
        unit: None,
        exact: None,
        counting: BoxCounting::default(),
        spectrum: Vec::new(),
        lacunarity: Vec::new(),
        warnings: Vec::new(),
    };
    let points = Points::new(points).with_context(|| name.to_owned())?;
    measured.counting = BoxCounting::of_points(&points, &arguments.grids(), arguments.threads());
    let finest = measured
        .counting
        .estimate
        .map_or(0.0, |estimate| estimate.range[0]);
    let masses = Masses::of_points(&points);
    measured.spectrum = masses.spectrum(&arguments.orders, finest);
    measured.lacunarity = masses.lacunarity();
    Ok(measured)
}
