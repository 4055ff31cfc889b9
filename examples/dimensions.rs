//! Measures the limit sets of the whole library by box counting and compares the results with their known
//! dimensions.
//!
//!     cargo run --locked --release --example dimensions
//!
//! The table is Markdown: the exact dimension, or else the one that the file states, the measured one with
//! its standard error, the deviation in standard errors, and whether local slopes drift. Sets with equal box
//! counts at all sizes counted are copies of each other, and enter the summary once. Names of entries as
//! arguments restrict the table to them.

#![allow(clippy::print_stdout, reason = "it says what it has found")]

use std::error::Error;
use std::num::NonZero;

use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::diagnostic::Diagnostics;
use kfrac::document::Document;
use kfrac::measure::exact::dimensions_of_graph;
use kfrac::measure::{BoxCounting, Grid, LimitSet};
use kfrac::render::Options;

fn main() -> Result<(), Box<dyn Error>> {
    let catalogue = Catalogue::embedded();
    let grids = Grid::spread(NonZero::new(8).ok_or("no grids")?);
    let only: Vec<String> = std::env::args().skip(1).collect();
    let mut seen: Vec<Vec<u64>> = Vec::new();
    let (mut offs, mut errors, mut scores) = (Vec::new(), Vec::new(), Vec::new());
    println!("| name | dimension | measured | s.e. | off | off / s.e. | decades | |");
    println!("|---|---|---|---|---|---|---|---|");
    let grown = [Shelf::RULES, Shelf::IFS, Shelf::LSYSTEMS, Shelf::INSTANCING];
    let entries = catalogue.entries();
    let wanted = |name: &String| only.is_empty() || only.contains(name);
    let entries = entries
        .iter()
        .filter(|entry| grown.contains(&entry.shelf) && wanted(&entry.name));
    for entry in entries {
        let source = catalogue.rule(&entry.name).map_err(Diagnostics::from)?;
        let (model, _) = Document::read(&source, &catalogue)?.resolve(&[])?;
        // L-systems whose words have to be written out may exceed the limits.
        let Ok(graph) = model.compile(64) else {
            continue;
        };
        let known = dimensions_of_graph(&graph).dimensions;
        let exact = known.and_then(|known| known.hausdorff.value);
        let heading = model.metadata();
        let exact = exact.or(heading.hausdorff_dimension).or(heading.dimension);
        let (Some(exact), Ok(set)) = (exact.filter(|&exact| exact > 0.0), LimitSet::of(&graph))
        else {
            continue;
        };
        let counting = BoxCounting::of_limit(&set, None, &grids, Options::default().threads);
        let Some(estimate) = counting.estimate.filter(|estimate| estimate.sizes > 0) else {
            continue;
        };
        let counted = counting.boxes.iter().filter(|boxes| !boxes.sampled);
        let counts: Vec<u64> = counted.map(|boxes| boxes.count).collect();
        let off = estimate.value - exact;
        let score = off / estimate.std_error;
        let is_copy = seen.contains(&counts);
        let mut says = Vec::new();
        if is_copy {
            says.push("copy");
        } else {
            seen.push(counts);
            offs.push(off.abs());
            errors.push(estimate.std_error);
            scores.push(score.abs());
        }
        says.extend((off.abs() > 0.01).then_some("far"));
        says.extend((score.abs() > 2.0).then_some("not covered"));
        let drifts = counting.trend.is_some_and(|trend| trend.is_significant());
        says.extend(drifts.then_some("drifts"));
        println!(
            "| {} | {exact:.4} | {:.4} | {:.4} | {off:+.4} | {score:+.1} | {:.1} | {} |",
            entry.name,
            estimate.value,
            estimate.std_error,
            estimate.decades(),
            says.join(", "),
        );
    }
    errors.sort_by(f64::total_cmp);
    let within = |values: &[f64], most: f64| values.iter().filter(|it| **it <= most).count();
    println!(
        "\nOf {} sets, {} are off by no more than 0.01, {} lie within two standard errors and {} within three; \
         the median standard error is {:.4}.",
        offs.len(),
        within(&offs, 0.01),
        within(&scores, 2.0),
        within(&scores, 3.0),
        errors.get(errors.len() / 2).copied().unwrap_or_default(),
    );
    Ok(())
}
