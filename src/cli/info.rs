//! `kfrac info`: describes a rule and forecasts the sizes of its steps.

#[cfg(feature = "studio")]
mod held;
mod numbers;
mod text;
mod turtle;

use serde::Serialize;

use super::readable::{self, decimal};
use crate::catalogue::Catalogue;
use crate::count::Count;
use crate::diagnostic::Diagnostic;
use crate::estimate::{Estimator, SizeEstimate, instanced_bytes};
use crate::extent::Bounded;
use crate::geometry::{Bounds, Homothety, Point};
use crate::graph::{Forecast, Graph, Level};
use crate::measure::exact::{self, Effort, dimensions_of_graph_within};
use crate::measure::similarity_dimension;
use crate::parallel::{all_cores, both};
use crate::render::Options;

use super::dim::hausdorff;
use super::growth::Boxes;
use super::rule::{Loaded, RuleArguments};
use super::structure::StructureInfo;
use super::system::SystemInfo;
use super::{Failure, help, output, steps};
#[cfg(feature = "studio")]
pub(crate) use held::{Described, hold};
use text::described;
use turtle::TurtleInfo;

/// Describes a rule: parameters, sizes of its steps, bounds, dimension
///
/// The sizes of the steps are computed without growing them, wherever the rule allows it: the numbers of
/// elements, fertile elements and fractals, the length, and estimates of the size of an SVG and of the time
/// to draw it.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Last step of the forecast [default: from the rule]
    #[arg(long, short, value_name = "N", value_parser = steps::parse, allow_negative_numbers = true)]
    steps: Option<u32>,
    /// Prints the description as JSON
    ///
    /// Numbers that may be large are decimal strings. svg_bytes and seconds are estimates to two digits for
    /// each step: the size of an SVG in the rule's own style, 1024 pixels large, and the time to draw it; null
    /// where the rule does not determine them, they exceed a double or take too long. steps is at most 10,000;
    /// a warning states where the rule has more. In space, area and volume are the surface and the volume of
    /// all elements: exact unless they overlap or touch. instanced_svg_bytes is the size of the last step with
    /// --svg instanced; null if that is not possible or takes too long. limit_bounds is the bounding box of the
    /// limit set, if there is one. lyapunov_exponent is that of a system of maps that is not known to contract,
    /// or an upper bound of it from products of so many maps; upper is null for minus infinity.
    #[arg(long)]
    json: bool,
}

const MORE: &str = "\
Examples:
  kfrac info dragon
      Describes the rule
  kfrac info koch --steps 40
      Forecasts the sizes of steps that are far too large to grow
  kfrac info pythagoras --set angle=30 --json
      Describes a member of the family, as JSON
";

/// Largest number of steps: beyond, the numbers alone would fill a disk.
const MAX_STEPS: u32 = 10_000;

/// Limit of the number of digits of all counts of a forecast, which are held in memory.
const MAX_DIGITS: usize = 200_000_000;

/// Limit of the number of elements of a word.
pub(super) const MAX_LISTED: u64 = 1_000_000;

#[derive(Serialize)]
struct Info<'a> {
    name: &'a str,
    kind: &'static str,
    space: u32,
    title: Option<&'a str>,
    params: serde_json::Map<String, serde_json::Value>,
    /// Name of the group under which the picture is repeated.
    #[serde(skip_serializing_if = "Option::is_none")]
    symmetry: Option<String>,
    random: bool,
    regular: bool,
    steps: u32,
    #[serde(serialize_with = "numbers::decimals")]
    elements: Option<Vec<Count>>,
    #[serde(serialize_with = "numbers::decimals")]
    fertile: Option<Vec<Count>>,
    #[serde(serialize_with = "numbers::decimals")]
    fractals: Option<Vec<Count>>,
    length: Option<Vec<Option<f64>>>,
    area: Option<Vec<Option<f64>>>,
    /// Volumes of sets in space.
    #[serde(flatten)]
    volume: Option<VolumeInfo>,
    #[serde(serialize_with = "numbers::rounded")]
    svg_bytes: Option<Vec<Option<f64>>>,
    #[serde(serialize_with = "numbers::rounded")]
    seconds: Option<Vec<Option<f64>>>,
    #[serde(serialize_with = "numbers::whole")]
    instanced_svg_bytes: Option<f64>,
    bounds: Option<Corners>,
    limit_bounds: Option<Corners>,
    dimension: Dimension,
    #[serde(flatten)]
    system: Option<SystemInfo>,
    #[serde(flatten)]
    structure: Option<StructureInfo>,
    #[serde(flatten)]
    turtle: Option<TurtleInfo>,
}

#[derive(Serialize)]
struct VolumeInfo {
    volume: Option<Vec<Option<f64>>>,
}

#[derive(Serialize)]
pub(super) struct Corners {
    #[serde(serialize_with = "numbers::coordinates")]
    pub(super) min: Vec<f64>,
    #[serde(serialize_with = "numbers::coordinates")]
    pub(super) max: Vec<f64>,
}

impl Corners {
    /// Formats the corners to twelve decimals of `unit`.
    pub(super) fn described(&self, unit: f64) -> String {
        format!("{} to {}", point(&self.min, unit), point(&self.max, unit))
    }
}

#[derive(Serialize)]
struct Dimension {
    similarity: Option<f64>,
    note: Option<String>,
    /// Dimension of the set itself, or its bound, as `kfrac dim` reports it.
    hausdorff: serde_json::Value,
    #[serde(skip)]
    exact: Option<exact::Hausdorff>,
}

impl Dimension {
    /// Returns the lines for the similarity dimension and for the dimension of the set itself.
    fn lines(&self) -> [Option<String>; 2] {
        let similarity = self.similarity.map(|value| {
            let note = self.note.as_ref();
            let note = note.map(|note| format!(" ({note})")).unwrap_or_default();
            format!("similarity dimension {}{note}", decimal(value, 1.0))
        });
        let similarity = similarity.or_else(|| self.note.clone());
        let own = self.exact.as_ref().and_then(|known| {
            let formatted = match (known.value, known.upper_bound) {
                (Some(value), _) => decimal(value, 1.0),
                (None, Some(bound)) => {
                    format!("at most {} ({})", decimal(bound, 1.0), known.method)
                }
                (None, None) => return None,
            };
            let form = known.closed_form.as_ref();
            let form = form.filter(|form| known.value.is_some() && **form != formatted);
            let form = form.map(|form| format!(" = {form}")).unwrap_or_default();
            Some(format!("Hausdorff dimension {formatted}{form}"))
        });
        [Some(similarity.unwrap_or_else(|| "unknown".into())), own]
    }
}

/// Formats a point to twelve decimals of `unit`.
pub(super) fn point(coordinates: &[f64], unit: f64) -> String {
    let written = coordinates.iter().map(|value| decimal(*value, unit));
    format!("[{}]", written.collect::<Vec<_>>().join(", "))
}

#[expect(clippy::cast_possible_truncation, reason = "the value is checked")]
fn number(value: f64) -> serde_json::Value {
    if value.fract() == 0.0 && value.abs() < 9e15 {
        (value as i64).into()
    } else {
        value.into()
    }
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let loaded = arguments.rule.load(catalogue, arguments.json)?;
    let loaded = loaded.listing(MAX_LISTED);
    let (info, unit) = if let Some(graph) = loaded.in_space(arguments.steps)? {
        check_steps(arguments.steps)?;
        let steps = steps::choose_in_space(arguments.steps, &loaded, &graph);
        let steps = forecast_steps(arguments, &loaded, steps);
        let bounds = graph.bounds(steps);
        let limit = loaded.other_limit_in_space(&graph)?;
        let graphs = [&graph, limit.as_ref().unwrap_or(&graph)];
        let own = info(&loaded, graphs, steps, bounds, |_, _| None);
        let surfaces = match loaded.model.rule_in_space() {
            // An element may consist of several surfaces.
            Some(rule) if graph.is_plain() => {
                let surfaces = graph.clone().with_surfaces(rule.base_elements());
                rows(&surfaces, steps, |_, _| None)
            }
            Some(_) => None,
            None => rows(&graph, steps, |_, _| None),
        };
        let surfaces = surfaces.as_deref();
        let info = Info {
            system: SystemInfo::of(&loaded.model, &Homothety::IDENTITY),
            area: { graph.is_similar() }
                .then(|| measures(surfaces, |level| level.area))
                .flatten(),
            volume: Some(VolumeInfo {
                volume: measures(surfaces, |level| level.volume),
            }),
            turtle: TurtleInfo::of(&loaded.model, &graph),
            ..own
        };
        (info, graph.place().ratio())
    } else {
        check_steps(arguments.steps)?;
        let (steps, known) = steps::choose_with_graph(arguments.steps, &loaded)?;
        let most = steps.min(MAX_STEPS);
        let graph = known.map_or_else(|| loaded.compile(most), Ok)?;
        let steps = forecast_steps(arguments, &loaded, steps);
        let limit = loaded.other_limit(&graph, steps)?;
        let info = in_plane(&loaded, &graph, limit.as_ref().unwrap_or(&graph), steps);
        (info, graph.place().ratio())
    };
    output::print_as(arguments.json, &info, || described(&loaded, &info, unit))
}

fn check_steps(asked: Option<u32>) -> Result<(), Failure> {
    if asked.is_none_or(|steps| steps <= MAX_STEPS) {
        return Ok(());
    }
    let message = format!("info forecasts no more than {MAX_STEPS} steps");
    Err(Failure::Usage(message))
}

/// Returns the number of steps that are forecast: as many as were asked for, or else those of the rule, unless they are too
/// many, which a warning states.
fn forecast_steps(arguments: &Arguments, loaded: &Loaded, steps: u32) -> u32 {
    if arguments.steps.is_some() || steps <= MAX_STEPS {
        return steps;
    }
    let message = format!("only {MAX_STEPS} of {steps} steps are forecast: more take long");
    let mut warning = Diagnostic::warning(message);
    if let Some(written) = &loaded.document.kind().metadata().steps {
        warning = warning.at(&written.place);
    }
    super::text::print_diagnostics(&warning.into());
    MAX_STEPS
}

/// Collects the description of a set of the plane, with estimates of sizes of files and of times. `limit` is the graph
/// that has the limit set.
fn in_plane<'a>(loaded: &'a Loaded, graph: &Graph, limit: &Graph, steps: u32) -> Info<'a> {
    /// Step after which bounding boxes change little.
    const SETTLED: u32 = 12;
    let boxes = Boxes::of(graph);
    let bounds = boxes.at(steps);
    let last = bounds.or_else(|| boxes.of_fewer(steps));
    let options = Options::of(loaded.model.metadata());
    let estimator = Estimator::new(graph, &options);
    // Every estimate after one that exceeds the range of doubles exceeds it too.
    let mut may_be = true;
    let roughly = |step: u32| {
        let own = Some(step).filter(|_| step < steps.min(SETTLED));
        own.and_then(|step| boxes.known_soon(step)).or(last)
    };
    let estimate = |step: u32, forecast: &Forecast<'_>| {
        let estimate = roughly(step).filter(|_| may_be);
        let estimate = estimate.and_then(|bounds| estimator.at(forecast, &bounds));
        may_be = estimate.is_some();
        estimate
    };
    Info {
        instanced_svg_bytes: instanced_bytes(graph, &options, steps, &roughly)
            .map(readable::two_digits),
        system: SystemInfo::of(&loaded.model, graph.place()),
        ..info(loaded, [graph, limit], steps, bounds, estimate)
    }
}

/// Collects the description from the graph and the graph that has the limit set.
fn info<'a, F: Bounded>(
    loaded: &'a Loaded,
    [graph, limit]: [&Graph<F>; 2],
    steps: u32,
    bounds: Option<Bounds<F::Point>>,
    estimate: impl FnMut(u32, &Forecast<'_, F>) -> Option<SizeEstimate>,
) -> Info<'a> {
    // Both take long where there are many objects. Exact dimensions of random rules may need many integrals.
    let exact = || (!limit.draws()).then(|| dimensions_of_graph_within(limit, Effort::Quick));
    let sizes = || (rows(graph, steps, estimate), limit.limit_bounds());
    let (exact, (rows, limit_bounds)) = both(all_cores().get(), exact, sizes);
    let exact = exact.and_then(|known| known.dimensions);
    let measures = |measure| measures(rows.as_deref(), measure);
    let estimates = |part: fn(&SizeEstimate) -> f64| {
        let rows = rows.as_ref().filter(|rows| rows[0].estimate.is_some())?;
        let estimates = rows.iter().map(|row| row.estimate.as_ref().map(part));
        Some(estimates.collect())
    };
    let place = graph.place();
    let length = in_units(measures(|level| level.length), &[place.ratio()]);
    let area = in_units(measures(|level| level.area), &[place.ratio(); 2]);
    let svg_bytes = estimates(|estimate| estimate.svg_bytes);
    let seconds = estimates(|estimate| estimate.seconds);
    let [elements, fertile, fractals] = rows.map_or([const { None }; 3], |rows| {
        let mut counts = [const { Vec::new() }; 3];
        for ForecastRow { level, .. } in rows {
            counts[0].push(level.elements);
            counts[1].push(level.fertile);
            counts[2].push(level.fractals);
        }
        counts.map(Some)
    });
    let similarity = similarity_dimension(limit);
    let metadata = loaded.model.metadata();
    let params = metadata.parameters.iter();
    Info {
        name: &loaded.name,
        kind: loaded.model.kind().name(),
        space: if F::Point::DIMENSION == 2 { 2 } else { 3 },
        title: metadata.description.title.as_deref(),
        params: params
            .map(|parameter| (parameter.name.clone(), number(parameter.value)))
            .collect(),
        symmetry: metadata.symmetry.as_ref().map(ToString::to_string),
        random: graph.draws(),
        regular: graph.is_regular(),
        steps,
        elements,
        fertile,
        fractals,
        length,
        area,
        volume: None,
        svg_bytes,
        seconds,
        instanced_svg_bytes: None,
        bounds: bounds.map(|bounds| corners(&place.bounds(&bounds))),
        limit_bounds: limit_bounds.map(|bounds| corners(&place.bounds(&bounds))),
        dimension: Dimension {
            similarity: similarity.value,
            note: similarity.note,
            hausdorff: hausdorff(exact.as_ref()),
            exact: exact.map(|known| known.hausdorff),
        },
        system: None,
        structure: StructureInfo::of(&loaded.model),
        turtle: None,
    }
}

/// Returns a measure of all steps, with `None` where it exceeds the range of doubles; `None` if a step lacks it.
fn measures(
    rows: Option<&[ForecastRow]>,
    measure: fn(&Level) -> Option<f64>,
) -> Option<Vec<Option<f64>>> {
    let all: Option<Vec<_>> = rows?.iter().map(|row| measure(&row.level)).collect();
    let finite = |value: f64| Some(value).filter(|value| value.is_finite());
    Some(all?.into_iter().map(finite).collect())
}

/// Multiplies measures by all factors; a result beyond the range of doubles becomes `None`.
fn in_units(measures: Option<Vec<Option<f64>>>, factors: &[f64]) -> Option<Vec<Option<f64>>> {
    let formatted = |value: f64| {
        let value = factors.iter().fold(value, |value, factor| value * factor);
        Some(value).filter(|value| value.is_finite())
    };
    Some(
        measures?
            .into_iter()
            .map(|it| it.and_then(formatted))
            .collect(),
    )
}

/// Forecast of an approximant.
struct ForecastRow {
    level: Level,
    estimate: Option<SizeEstimate>,
}

/// Returns the forecast of all steps, with estimates; `None` if it takes too long, or if its numbers have very many digits.
fn rows<F: Bounded>(
    graph: &Graph<F>,
    steps: u32,
    mut estimate: impl FnMut(u32, &Forecast<'_, F>) -> Option<SizeEstimate>,
) -> Option<Vec<ForecastRow>> {
    if graph.is_of_one_step() {
        return None;
    }
    let mut forecast = graph.forecast()?;
    let mut rows = Vec::new();
    let mut digits = 0;
    for step in 0..=steps {
        if step > 0 && !forecast.advance() {
            return None;
        }
        let level = forecast.level();
        let counts = [&level.elements, &level.fertile, &level.fractals];
        digits += counts.map(Count::digits).into_iter().sum::<usize>();
        if digits > MAX_DIGITS {
            return None;
        }
        let estimate = estimate(step, &forecast);
        rows.push(ForecastRow { level, estimate });
    }
    Some(rows)
}

pub(super) fn corners<P: Point>(bounds: &Bounds<P>) -> Corners {
    let far = bounds.min().abs().max(bounds.max().abs()).max_element();
    // Coordinates that are less than the rounding error of the others are zero.
    let rounded = |value: f64| {
        if value.abs() <= f64::EPSILON * far {
            0.0
        } else {
            value
        }
    };
    let corner = |point: P| point.map(rounded).coordinates()[..P::DIMENSION].to_vec();
    Corners {
        min: corner(bounds.min()),
        max: corner(bounds.max()),
    }
}
