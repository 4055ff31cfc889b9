//! Input of `kfrac dim`: recognises, reads and measures rules, pictures and tables.

use std::io::{self, Cursor, Read};
use std::num::NonZero;
use std::path::Path;

use anyhow::{Context, anyhow};

use crate::catalogue::{Catalogue, open_file};
use crate::diagnostic::Source;
use crate::extent::{Bounded, NoLimit};
use crate::geometry::{DAffine2, DAffine3, HalfSpace};
use crate::graph::{CompileError, Graph};
use crate::grow::Growth;
use crate::ifs::{AffineMap, Ifs};
use crate::import::{PlyError, Raster, Table, TableError, read_ply, read_points};
use crate::measure::exact::{GraphDimensions, Spectrum, dimensions_of_graph};
use crate::measure::{
    BoxCounting, Cascade, Generalised, Grid, LimitSet, Masses, Points, Space, grown,
};
use crate::model::Model;
use crate::parallel::both;

use super::super::Failure;
use super::super::input;
use super::super::pixels::MAX_BYTES;
use super::super::rule::Loaded;
use super::kind::InputKind;
use super::{Arguments, Measured, drawn};

/// Limit of the number of points that are measured of a rule that is grown.
const MAX_POINTS: usize = 1 << 18;

/// Largest number of steps for which graphs without a fixed number of objects are compiled; fewer where the
/// graph would be too large.
const STEPS: [u32; 4] = [64, 20, 12, 6];

/// Returns the graph of a rule and the number of steps for which it is compiled. A word is derived as far as it draws no
/// more elements than are measured.
fn compiled(loaded: &Loaded) -> Result<(Graph, u32), Failure> {
    let at = |steps: u32| Ok((loaded.compile_limit(steps)?, steps));
    let [most, fewer @ ..] = STEPS;
    let tried = at(most).or_else(|error: CompileError| error.deepest().map_or(Err(error), at));
    let fewer = fewer.into_iter();
    let tried = fewer.fold(tried, |tried, steps| tried.or_else(|_| at(steps)));
    tried.map_err(|error| loaded.failure(&error))
}

/// Returns the exact dimensions of a rule's limit.
pub(super) fn exact(loaded: &Loaded) -> Result<GraphDimensions, Failure> {
    Ok(match loaded.limit_in_space()? {
        Some(graph) => dimensions_of_graph(&graph),
        None => dimensions_of_graph(&compiled(loaded)?.0),
    })
}

/// Refuses options without a meaning for a kind of input.
fn check(arguments: &Arguments, kind: InputKind) -> Result<(), Failure> {
    match arguments.without_meaning(kind) {
        Some(reason) => Err(Failure::Usage(reason)),
        None => Ok(()),
    }
}

pub(super) fn measure(arguments: &Arguments, catalogue: &Catalogue) -> Result<Measured, Failure> {
    let path = &arguments.rule;
    let rules = || arguments.rules();
    let is_standard = path == Path::new("-");
    if !is_standard && !path.metadata().is_ok_and(|metadata| !metadata.is_dir()) {
        // The argument may be a name in the library, or nothing.
        check(arguments, InputKind::Rule)?;
        return of_rule(arguments, rules().load(catalogue, arguments.json)?);
    }
    let name = if is_standard {
        "standard input".into()
    } else {
        path.display().to_string()
    };
    let cannot = || format!("{name} cannot be read");
    input::note(path);
    let mut input: Box<dyn Read> = if is_standard {
        Box::new(io::stdin().lock())
    } else {
        Box::new(open_file(path)?)
    };
    let read = |input: &mut dyn Read, most: u64| -> anyhow::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        input
            .take(most)
            .read_to_end(&mut bytes)
            .with_context(cannot)?;
        Ok(bytes)
    };
    let head = read(&mut input, 1 << 12)?;
    let kind = InputKind::of(path, &head);
    check(arguments, kind)?;
    let mut whole = Cursor::new(head).chain(input);
    match kind {
        InputKind::Picture => {
            let bytes = read(&mut whole, MAX_BYTES)?;
            let picture = Raster::read(&bytes, arguments.pixels.channel);
            drop(bytes);
            of_picture(arguments, &name, picture.with_context(|| name.clone())?)
        }
        InputKind::Table => {
            let columns = arguments.columns.as_ref().map(|columns| &columns.0[..]);
            let points = read_points(&mut whole, columns);
            let points = points.map_err(|error| match error {
                TableError::Columns { .. } => anyhow!("{name}: {error}, as in --columns x,y"),
                error => anyhow::Error::new(error).context(name.clone()),
            })?;
            match points {
                Table::Plane(points) => of_points::<DAffine2>(arguments, &name, points),
                Table::Space(points) => of_points::<DAffine3>(arguments, &name, points),
            }
        }
        InputKind::Ply => {
            let points = read_ply(io::BufReader::with_capacity(1 << 16, &mut whole));
            let points = points.map_err(|error: PlyError| anyhow!("{name}: {error}"))?;
            of_points::<DAffine3>(arguments, &name, points)
        }
        InputKind::Rule => {
            let most = u64::try_from(Source::MAX_BYTES).unwrap_or(u64::MAX) + 1;
            let bytes = read(&mut whole, most)?;
            let source = if is_standard {
                Source::read("<stdin>", bytes)?
            } else {
                Source::read_file(path, bytes)?
            };
            let loaded = rules().load_from(&source, catalogue, arguments.json)?;
            of_rule(arguments, loaded)
        }
    }
}

/// Measures a rule: its limit set, or the approximant of `--steps`.
pub(super) fn of_rule(arguments: &Arguments, loaded: Loaded) -> Result<Measured, Failure> {
    let loaded = &loaded.seeded(arguments.seed).listing(MAX_POINTS as u64);
    if let Some(steps) = arguments.steps {
        return drawn::measure(arguments, loaded, steps);
    }
    let measured = Measured {
        set: "the limit set of the fertile elements".into(),
        exact: Some(exact(loaded)?),
        is_exact: arguments.exact,
        ..Measured::of_loaded(loaded)
    };
    if let Some(graph) = loaded.limit_in_space()? {
        let weighted = match &loaded.model {
            Model::IfsInSpace(system) => Some(system.ifs()),
            _ => None,
        };
        return Ok(match LimitSet::of(&graph) {
            Ok(set) if arguments.slice.is_some() => of_slice(arguments, &set, measured)?,
            Ok(set) => of_limit(arguments, &set, &graph, weighted, measured),
            Err(_) if arguments.exact => measured,
            Err(error) => measured.without(&error),
        });
    }
    only_in_space(arguments)?;
    let (graph, steps) = compiled(loaded)?;
    let weighted = match &loaded.model {
        Model::Ifs(system) => Some(system.ifs()),
        _ => None,
    };
    let mut measured = match LimitSet::of(&graph) {
        Ok(set) => of_limit(arguments, &set, &graph, weighted, measured),
        Err(_) if arguments.exact => measured,
        Err(NoLimit::Draws | NoLimit::CountsIndex | NoLimit::Endless | NoLimit::Words(_)) => {
            of_growth(arguments, &graph, steps, measured)?
        }
        Err(error) => measured.without(&error),
    };
    if measured.counting.boxes.is_empty() && !arguments.exact {
        let remedy = "--steps N measures an approximant as it is drawn";
        measured.warnings.push(remedy.into());
    }
    Ok(measured)
}

/// Checks that no slice of a set in the plane is asked for.
fn only_in_space(arguments: &Arguments) -> Result<(), Failure> {
    let message = "--slice: slices are those of limit sets in space";
    match arguments.slice {
        Some(_) => Err(Failure::Usage(message.into())),
        None => Ok(()),
    }
}

/// Measures the slice of a limit set in space.
fn of_slice(
    arguments: &Arguments,
    set: &LimitSet<DAffine3>,
    mut measured: Measured,
) -> Result<Measured, Failure> {
    let Some(HalfSpace { normal, distance }) = arguments.slice else {
        return Ok(measured);
    };
    whole(arguments.base, "slices")?;
    let slice = set.slice(normal, distance).map_err(|[low, high]| {
        anyhow!(
            "the slice misses the limit set, on which {normal} · x is from {low:.6} to {high:.6}"
        )
    })?;
    let [x, y, z] = normal.to_array();
    measured.exact = None;
    measured.set = format!(
        "the slice ({x}, {y}, {z}) · (x, y, z) = {distance} of the limit set, by layers of cubes"
    );
    let threads = arguments.threads();
    measured.counting = BoxCounting::of_slice(&slice, arguments.base, arguments.grids, threads);
    if measured.counting.boxes.is_empty() && measured.counting.estimate.is_none() {
        let reason =
            "nothing is measured: the slice meets nothing of the set, or too many copies overlap";
        measured.warnings.push(reason.into());
        return Ok(measured);
    }
    if let Some((squares, side)) = slice.squares() {
        let (orders, grids) = (&arguments.orders, Grid::spread(arguments.grids));
        let counted = measured.counting.estimate;
        let spectrum = Generalised::of_pixels(&squares, counted, orders, &grids, threads);
        measured.report(spectrum.into_iter().map(|it| it.enlarged(side)).collect());
        measured.measure = Some("squares");
        let lacunarity = Masses::of_pixels(&squares, [0; 2]).lacunarity().into_iter();
        measured.lacunarity = lacunarity.map(|it| it.enlarged(side)).collect();
    }
    Ok(measured)
}

/// Measures a limit set.
fn of_limit<M: Space + AffineMap>(
    arguments: &Arguments,
    set: &LimitSet<M>,
    graph: &Graph<M::Frame>,
    weighted: Option<&Ifs<M>>,
    mut measured: Measured,
) -> Measured
where
    M::Frame: Bounded,
{
    if arguments.exact {
        measured.report_measure(arguments, weighted, graph);
        return measured;
    }
    let lacunarity = || {
        let mut masses = M::FINENESS.iter();
        let masses = masses.find_map(|&boxes| Masses::of_limit(set, &Grid::ALONG, boxes));
        masses.map(|it| it.lacunarity()).unwrap_or_default()
    };
    let count = || {
        measured.count(arguments, set);
        if measured.counting.boxes.is_empty() {
            return measured;
        }
        measured.report_measure(arguments, weighted, graph);
        measured
    };
    let (lacunarity, mut measured) = both(arguments.threads().get(), lacunarity, count);
    if measured.counting.boxes.is_empty() {
        return measured;
    }
    measured.lacunarity = lacunarity;
    measured.enlarged(graph.place().ratio())
}

/// Measures a rule whose limit set is known only by growing it, with the random draws of a seed.
fn of_growth(
    arguments: &Arguments,
    graph: &Graph,
    steps: u32,
    mut measured: Measured,
) -> Result<Measured, Failure> {
    let growth = Growth {
        seed: arguments.seed,
        ..Growth::steps(steps)
    };
    let grown = match grown(graph, &growth, MAX_POINTS) {
        Ok(grown) => grown,
        Err(error) => return Ok(measured.without(&error)),
    };
    measured.set = format!(
        "{} fertile elements shorter than {:.3e}, grown with seed {}",
        grown.points.len(),
        grown.detail * graph.place().ratio(),
        arguments.seed
    );
    let points = match Points::<DAffine2>::new(grown.points) {
        Ok(points) => points,
        Err(error) => return Ok(measured.without(&error)),
    };
    let base = whole(arguments.base, "points")?;
    measured.sampled(&points, base, 4.0 * grown.detail, arguments);
    Ok(measured.enlarged(graph.place().ratio()))
}

/// Measures the pixels of a picture that belong to a set.
pub(super) fn of_picture(
    arguments: &Arguments,
    name: &str,
    picture: Raster,
) -> Result<Measured, Failure> {
    only_in_space(arguments)?;
    let set = arguments.pixels.decide(name.into(), picture)?;
    let pixels = set.bits;
    let base = arguments.base.map(|base| whole(Some(base), "pictures"));
    let base = base.transpose()?;
    let (grids, threads) = (Grid::spread(arguments.grids), arguments.threads());
    let counting = BoxCounting::of_pixels(&pixels, base, &grids, threads);
    let mut measured = Measured {
        name: name.into(),
        title: name.into(),
        set: set.description,
        unit: Some("pixels"),
        counting,
        lacunarity: Masses::of_pixels(&pixels, [0; 2]).lacunarity(),
        warnings: set.warning.into_iter().collect(),
        ..Measured::default()
    };
    let orders = &arguments.orders;
    let counted = measured.counting.estimate;
    let spectrum = Generalised::of_pixels(&pixels, counted, orders, &grids, threads);
    measured.report(spectrum);
    Ok(measured)
}

/// Returns the base as a whole number, which boxes that are merged need.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "bases are small"
)]
fn whole(base: Option<f64>, of: &str) -> Result<NonZero<usize>, Failure> {
    let base = base.unwrap_or(2.0);
    let whole = NonZero::new(base as usize).filter(|whole| base.fract() == 0.0 && whole.get() > 1);
    let message = || format!("--base: for {of}, the base is a whole number of at least 2");
    whole.ok_or_else(|| Failure::Usage(message()))
}

fn of_points<M: Space>(
    arguments: &Arguments,
    name: &str,
    points: Vec<M::Point>,
) -> Result<Measured, Failure> {
    only_in_space(arguments)?;
    let base = whole(arguments.base, "points")?;
    let count = points.len();
    let mut measured = Measured {
        name: name.into(),
        title: name.into(),
        set: format!("{count} points"),
        ..Measured::default()
    };
    let points = Points::<M>::new(points).with_context(|| name.to_owned())?;
    measured.sampled(&points, base, 0.0, arguments);
    Ok(measured)
}

impl Measured {
    /// Returns the result for a rule of which nothing is measured yet.
    pub(super) fn of_loaded(loaded: &Loaded) -> Self {
        let title = loaded.model.metadata().description.title.clone();
        Self {
            name: loaded.name.clone(),
            title: title.unwrap_or_else(|| loaded.name.clone()),
            ..Self::default()
        }
    }

    /// Returns the results for the set enlarged by `ratio`.
    pub(super) fn enlarged(mut self, ratio: f64) -> Self {
        if ratio == 1.0 {
            return self;
        }
        self.counting = self.counting.enlarged(ratio);
        let spectrum = self.spectrum.into_iter().map(|it| it.enlarged(ratio));
        self.spectrum = spectrum.collect();
        let lacunarity = self.lacunarity.into_iter().map(|it| it.enlarged(ratio));
        self.lacunarity = lacunarity.collect();
        self
    }

    /// Sets the spectrum. For order 0, the result of box counting is used.
    fn report(&mut self, spectrum: Vec<Generalised>) {
        let formatted = |it: Generalised| match it.order {
            0.0 => Generalised::of_boxes(&self.counting),
            _ => it,
        };
        self.spectrum = spectrum.into_iter().map(formatted).collect();
        Generalised::fall(&mut self.spectrum);
    }

    /// Counts the boxes of a limit set.
    fn count<M: Space>(&mut self, arguments: &Arguments, set: &LimitSet<M>) {
        let (grids, threads) = (Grid::spread(arguments.grids), arguments.threads());
        self.counting = BoxCounting::of_limit(set, arguments.base, &grids, threads);
        if self.counting.estimate.is_some() {
            return;
        }
        let sizes = self.counting.boxes.iter().map(|row| row.size);
        let [finest, coarsest] = [
            sizes.clone().fold(f64::INFINITY, f64::min),
            sizes.fold(0.0, f64::max),
        ];
        let scale = set.smallest_scale();
        if self.counting.boxes.is_empty() {
            let reason = "nothing is measured: too many copies overlap";
            self.warnings.push(reason.into());
        } else if finest > scale * coarsest {
            let reason = format!(
                "no dimension is measured: the sizes span less than one generation of the smallest copies, whose scale is \
                 {scale:.3e}"
            );
            self.warnings.push(reason);
        }
    }

    /// Sets the spectrum of the measure on the limit set of a rule: the measure given by the weights of a
    /// system, or else the natural one.
    fn report_measure<M: Space + AffineMap>(
        &mut self,
        arguments: &Arguments,
        ifs: Option<&Ifs<M>>,
        graph: &Graph<M::Frame>,
    ) where
        M::Frame: Bounded,
    {
        let weighted = ifs.filter(|ifs| ifs.has_weights());
        let by_weights = weighted.and_then(|ifs| Some((ifs, Cascade::of_weights(ifs)?)));
        if weighted.is_some() && by_weights.is_none() {
            let reason = "the weights do not determine a unique measure: the limit of random iteration depends on its \
                          start; the spectrum is that of the natural measure";
            self.warnings.push(reason.into());
        }
        let cascade = match by_weights {
            Some((ifs, cascade)) => {
                self.measure = Some("weights");
                self.spectrum_known = Spectrum::of_weights(ifs);
                cascade
            }
            None => {
                let Some(cascade) = Cascade::natural(graph) else {
                    return;
                };
                self.measure = Some("natural");
                let exact = self.exact.as_ref();
                let dimensions = exact.and_then(|exact| exact.dimensions.as_ref());
                self.spectrum_known = dimensions.and_then(Spectrum::natural);
                cascade
            }
        };
        let (orders, base, series) = (&arguments.orders, arguments.base, arguments.grids);
        self.spectrum = match arguments.exact {
            false => Generalised::of_measure(&cascade, orders, base, series, arguments.threads()),
            true if self.spectrum_known.is_none() => Vec::new(),
            true => orders
                .iter()
                .map(|&order| Generalised::unmeasured(order))
                .collect(),
        };
    }

    /// Measures points as a sample of a set, with boxes that are at least `finest`.
    fn sampled<M: Space>(
        &mut self,
        points: &Points<M>,
        base: NonZero<usize>,
        finest: f64,
        arguments: &Arguments,
    ) {
        let sample = points.sample(base, &Grid::spread(arguments.grids), arguments.threads());
        self.counting = BoxCounting::of_sample(&sample, finest);
        self.report(Generalised::of_sample(&sample, &arguments.orders, finest));
        self.lacunarity = Masses::of_points(points).lacunarity();
    }
}
