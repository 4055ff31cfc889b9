//! `kfrac count`: counts the elements of a step by growing it.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use super::readable::{decimal, grouped};
use crate::catalogue::Catalogue;
use crate::geometry::{BEYOND, Frame, Point};
use crate::graph::Graph;
use crate::grow::{Counted, count};

use super::growth::GrowthArguments;
use super::info::{Corners, corners};
use super::rule::{Loaded, RuleArguments};
use super::{Failure, help, output, progress, steps};

/// Grows a rule and counts its elements, without drawing
///
/// Places every element and reports the number of elements, of fertile elements and of fractals, the sum of
/// the lengths, and the bounding box of what is drawn, without strokes. `kfrac info` computes the same
/// numbers without growing the rule; `count` is an independent check.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Number of steps: how often fertile elements are replaced [default: from the rule]
    ///
    /// If the rule gives no number, the default is the deepest step up to 12 with no more than 20,000
    /// elements.
    #[arg(long, short, value_name = "N", value_parser = steps::parse, allow_negative_numbers = true)]
    steps: Option<u32>,
    #[command(flatten)]
    growth: GrowthArguments,
    /// Prints the result as JSON
    ///
    /// Counts are decimal strings; bounds are null if nothing is visible.
    #[arg(long)]
    json: bool,
}

const MORE: &str = "\
Examples:
  kfrac count koch --steps 12
      Counts the 16,777,216 elements of step 12
  kfrac count random-tree --seed 7 --json
      Prints the counts of a random tree as JSON
  kfrac count dragon --steps 30 --max-elements 2000000000
      Counts up to two billion elements, in a second or two
";

#[derive(Serialize)]
struct CountReport<'a> {
    name: &'a str,
    steps: u32,
    elements: String,
    fertile: String,
    fractals: String,
    /// `null` in JSON if it exceeds the range of doubles.
    length: f64,
    bounds: Option<Corners>,
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let Arguments { rule, growth, .. } = arguments;
    growth.refuse_several_seeds()?;
    let loaded = rule.load(catalogue, growth.quiet)?.grown(growth);
    if let Some(graph) = loaded.in_space(arguments.steps)? {
        let steps = steps::choose_in_space(arguments.steps, &loaded, &graph);
        growth.check(steps, &graph, &loaded)?;
        return arguments.count(&loaded, &graph, steps);
    }
    let steps = steps::choose(arguments.steps, &loaded)?;
    let graph = loaded.compile(steps)?;
    growth.check(steps, &graph, &loaded)?;
    arguments.count(&loaded, &graph, steps)
}

impl Arguments {
    /// Counts the elements of a step and prints the result.
    fn count<F: Frame>(
        &self,
        loaded: &Loaded,
        graph: &Graph<F>,
        steps: u32,
    ) -> Result<(), Failure> {
        let growth = &self.growth;
        let found = progress::watched(!growth.quiet, |progress| {
            let limits = growth.to(steps, progress);
            if let Some(progress) = progress
                && let Ok(Some(elements)) = graph.check_size(steps, limits.max_elements)
            {
                progress.expect(elements);
            }
            count(graph, &limits, growth.threads())
        });
        let found = found.map_err(|error| growth.explain(error.into(), loaded, Path::new("-")))?;
        if !found.length.is_finite() {
            let message = format!("step {steps} of {}: {BEYOND}", loaded.name);
            return Err(anyhow::anyhow!(message).into());
        }
        let place = graph.place();
        let found = Counted {
            length: found.length * place.ratio(),
            bounds: place.bounds(&found.bounds),
            ..found
        };
        let text = if self.json {
            let mut text = serde_json::to_string_pretty(&json(&found, loaded, steps))
                .map_err(anyhow::Error::new)?;
            text.push('\n');
            text
        } else {
            text(&found, place.ratio())
        };
        Ok(output::print(&text)?)
    }
}

fn json<'a, P: Point>(found: &Counted<P>, loaded: &'a Loaded, steps: u32) -> CountReport<'a> {
    let bounds = Some(&found.bounds).filter(|bounds| !bounds.is_empty());
    CountReport {
        name: &loaded.name,
        steps,
        elements: found.walked.elements.to_string(),
        fertile: found.fertile.to_string(),
        fractals: found.walked.fractals.to_string(),
        length: found.length,
        bounds: bounds.map(corners),
    }
}

fn text<P: Point>(found: &Counted<P>, unit: f64) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name:<9} {value}");
    };
    line("elements", &grouped(&found.walked.elements.into()));
    line("fertile", &grouped(&found.fertile.into()));
    line("fractals", &grouped(&found.walked.fractals.into()));
    line("length", &decimal(found.length, unit));
    if !found.bounds.is_empty() {
        line("bounds", &corners(&found.bounds).described(unit));
    }
    text
}
