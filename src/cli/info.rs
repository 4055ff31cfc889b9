//! `kfrac info`: what a rule is, and how large its steps are.

use std::fmt::Write as _;

use serde::Serialize;

use crate::catalogue::Catalogue;
use crate::geometry::Bounds;
use crate::graph::{Count, Graph, Level};
use crate::grow::{Growth, extent};
use crate::measure::similarity_dimension;
use crate::rule::Parameter;
use crate::wording;

use super::rule::{Loaded, RuleArguments};
use super::{Failure, help, output, steps};

/// Says what a rule is: parameters, sizes of its steps, bounds, dimension
///
/// The sizes of the steps are told without growing them, wherever the rule allows it: numbers of
/// elements, of those that are fertile and of fractals, and the length.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// The last step of the forecast [default: what the rule says]
    #[arg(long, short, value_name = "N", value_parser = steps::parse, allow_negative_numbers = true)]
    steps: Option<u32>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

const MORE: &str = "\
Examples:
  kfrac info dragon
      Says what the rule is
  kfrac info koch --steps 40
      Tells the size of steps that nobody could grow
  kfrac info pythagoras --set angle=30 --json
      For another program
";

/// Beyond this, the numbers alone would fill a disk.
const MOST_STEPS: u32 = 10_000;

#[derive(Serialize)]
struct Info<'a> {
    name: &'a str,
    kind: &'static str,
    space: u32,
    title: Option<&'a str>,
    params: serde_json::Map<String, serde_json::Value>,
    random: bool,
    regular: bool,
    steps: u32,
    #[serde(serialize_with = "decimals")]
    elements: Option<Vec<Count>>,
    #[serde(serialize_with = "decimals")]
    fertile: Option<Vec<Count>>,
    #[serde(serialize_with = "decimals")]
    fractals: Option<Vec<Count>>,
    length: Option<Vec<Option<f64>>>,
    area: Option<Vec<Option<f64>>>,
    bounds: Option<Corners>,
    limit_bounds: Option<Corners>,
    dimension: Dimension,
}

#[derive(Serialize)]
struct Corners {
    #[serde(serialize_with = "coordinates")]
    min: [f64; 2],
    #[serde(serialize_with = "coordinates")]
    max: [f64; 2],
}

#[derive(Serialize)]
struct Dimension {
    similarity: Option<f64>,
    note: Option<String>,
}

/// Decimal strings: the numbers may be larger than those of JSON's readers.
fn decimals<S: serde::Serializer>(
    counts: &Option<Vec<Count>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match counts {
        Some(counts) => serializer.collect_seq(counts.iter().map(Count::to_string)),
        None => serializer.serialize_none(),
    }
}

/// Whole numbers without a fraction, as in the tables.
fn coordinates<S: serde::Serializer>(point: &[f64; 2], serializer: S) -> Result<S::Ok, S::Error> {
    point.map(|value| number(value + 0.0)).serialize(serializer)
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
    let steps = steps::choose(arguments.steps, &loaded)?;
    if steps > MOST_STEPS {
        let message = format!("info tells the sizes of no more than {MOST_STEPS} steps");
        return Err(Failure::Usage(message));
    }
    let graph = loaded.compile(steps)?;
    let info = info(&loaded, &graph, steps);
    let text = if arguments.json {
        format!(
            "{}\n",
            serde_json::to_string_pretty(&info).map_err(anyhow::Error::from)?
        )
    } else {
        described(&loaded, &info)
    };
    Ok(output::print(&text)?)
}

fn info<'a>(loaded: &'a Loaded, graph: &Graph, steps: u32) -> Info<'a> {
    let levels = levels(graph, steps);
    let counts = |count: fn(&Level) -> &Count| {
        levels
            .as_ref()
            .map(|levels| levels.iter().map(count).cloned().collect())
    };
    // A measure that one step does not have, none has; a step beyond a double's range has none.
    let measures = |measure: fn(&Level) -> Option<f64>| {
        let levels = levels.as_ref()?;
        levels
            .iter()
            .all(|level| measure(level).is_some())
            .then(|| {
                levels
                    .iter()
                    .map(|level| measure(level).filter(|value| value.is_finite()))
                    .collect()
            })
    };
    let similarity = similarity_dimension(graph);
    let params = loaded.rule.parameters().iter();
    Info {
        name: &loaded.name,
        kind: "rule",
        space: 2,
        title: loaded.rule.description().title.as_deref(),
        params: params
            .map(|parameter| (parameter.name.clone(), number(parameter.value)))
            .collect(),
        random: graph.draws(),
        regular: graph.is_regular(),
        steps,
        elements: counts(|level| &level.elements),
        fertile: counts(|level| &level.fertile),
        fractals: counts(|level| &level.fractals),
        length: measures(|level| level.length),
        area: measures(|level| level.area),
        bounds: bounds(graph, steps).as_ref().map(corners),
        limit_bounds: graph.limit_bounds().as_ref().map(corners),
        dimension: Dimension {
            similarity: similarity.value,
            note: similarity.note,
        },
    }
}

/// The box of an approximant: from the graph, or else by a walk that is not too long.
fn bounds(graph: &Graph, steps: u32) -> Option<Bounds> {
    const MOST_ELEMENTS: u64 = 1_000_000;
    let growth = Growth {
        most_elements: MOST_ELEMENTS,
        ..Growth::steps(steps)
    };
    let walked = || {
        let small = !graph.draws() && graph.check_size(steps, MOST_ELEMENTS).is_ok();
        let bounds = small.then(|| extent(graph, &growth).ok()).flatten();
        bounds.filter(Bounds::is_finite)
    };
    graph.bounds(steps).or_else(walked)
}

fn levels(graph: &Graph, steps: u32) -> Option<Vec<Level>> {
    let mut forecast = graph.forecast()?;
    let mut levels = vec![forecast.level()];
    for _ in 0..steps {
        if !forecast.advance() {
            return None;
        }
        levels.push(forecast.level());
    }
    Some(levels)
}

fn corners(bounds: &Bounds) -> Corners {
    Corners {
        min: bounds.min().to_array(),
        max: bounds.max().to_array(),
    }
}

/// For people.
fn described(loaded: &Loaded, info: &Info<'_>) -> String {
    let mut text = String::new();
    let rule = &loaded.rule;
    let description = rule.description();
    let mut line = |label: &str, value: &str| {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{label:<12}{value}");
    };
    line("name", info.name);
    if let Some(title) = &description.title {
        line("title", title);
    }
    if let Some(about) = &description.about {
        line("about", about.trim());
    }
    if let Some(source) = &description.source {
        line("source", source.trim());
    }
    if !description.tags.is_empty() {
        line("tags", &description.tags.join(", "));
    }
    for parameter in rule.parameters() {
        line("parameter", &parameter_line(parameter));
    }
    let names: Vec<_> = rule
        .generators()
        .iter()
        .map(crate::rule::Generator::name)
        .collect();
    if names.len() > 1 {
        line("generators", &names.join(", "));
    }
    line("random", if info.random { "yes" } else { "no" });
    line(
        "regular",
        if info.regular {
            "yes"
        } else {
            "no: the walk counts indices"
        },
    );
    let dimension = match (info.dimension.similarity, &info.dimension.note) {
        (Some(value), Some(note)) => format!("{} ({note})", decimal(value)),
        (Some(value), None) => decimal(value),
        (None, note) => note.clone().unwrap_or_else(|| "unknown".into()),
    };
    line("dimension", &dimension);
    let corners = |corners: &Corners| {
        let [[a, b], [c, d]] = [corners.min, corners.max].map(|corner| corner.map(decimal));
        format!("[{a}, {b}] to [{c}, {d}]")
    };
    if let Some(bounds) = &info.bounds {
        line(
            "bounds",
            &format!("{} at step {}", corners(bounds), info.steps),
        );
    }
    if let Some(bounds) = &info.limit_bounds {
        line("", &format!("{} in the limit", corners(bounds)));
    }
    text.push('\n');
    match &info.elements {
        Some(elements) => text.push_str(&table(info, elements)),
        None => text.push_str("How large its steps are is not known before they are grown.\n"),
    }
    text
}

/// Twelve decimals, without zeros at the end.
fn decimal(value: f64) -> String {
    let text = format!("{value:.12}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}

fn parameter_line(parameter: &Parameter) -> String {
    let mut line = format!("{} = {}", parameter.name, parameter.value);
    match (parameter.min, parameter.max) {
        (Some(min), Some(max)) => line.push_str(&format!(", from {min} to {max}")),
        (Some(min), None) => line.push_str(&format!(", at least {min}")),
        (None, Some(max)) => line.push_str(&format!(", at most {max}")),
        (None, None) => {}
    }
    if let Some(about) = &parameter.about {
        line.push_str(&format!(": {}", about.trim()));
    }
    line
}

/// The forecast, a row a step; long numbers are given by their size.
fn table(info: &Info<'_>, elements: &[Count]) -> String {
    let mut rows = vec![["step", "elements", "fertile", "fractals", "length"].map(String::from)];
    for step in 0..elements.len() {
        let at = |column: &Option<Vec<Count>>| {
            column
                .as_ref()
                .map_or("-".into(), |column| wording::grouped(&column[step]))
        };
        let length = info.length.as_ref().and_then(|lengths| lengths[step]);
        rows.push([
            step.to_string(),
            wording::grouped(&elements[step]),
            at(&info.fertile),
            at(&info.fractals),
            length.map_or("-".into(), |length| format!("{length:.6}")),
        ]);
    }
    let widths: Vec<_> = (0..5)
        .map(|column| rows.iter().map(|row| row[column].len()).max().unwrap_or(0))
        .collect();
    let mut table = String::new();
    for row in &rows {
        let cells: Vec<_> = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:>width$}"))
            .collect();
        table.push_str(&cells.join("  "));
        table.push('\n');
    }
    table
}
