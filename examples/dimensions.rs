//! Measures the limit sets of the whole library by boxes, beside what their dimensions are.
//!
//!     cargo run --release --example dimensions
//!
//! The table is Markdown: the exact dimension, the measured one with two standard errors, whether it
//! is off by more than 0.01, and whether it lies outside its own interval.

#![allow(clippy::print_stdout, reason = "it says what it has found")]

use std::error::Error;
use std::num::NonZero;

use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::diagnostic::Diagnostics;
use kfrac::document::Document;
use kfrac::measure::exact::dimensions_of_graph;
use kfrac::measure::{BoxCounting, Grid, LimitSet};
use kfrac::parallel::all_cores;

fn main() -> Result<(), Box<dyn Error>> {
    let catalogue = Catalogue::embedded();
    let grids = Grid::spread(NonZero::new(8).ok_or("no grids")?);
    let (mut measured, mut close, mut covered) = (0, 0, 0);
    println!("| name | exact | measured | ± 2 s.e. | off | decades | |");
    println!("|---|---|---|---|---|---|---|");
    let grown = [Shelf::Rules, Shelf::Ifs, Shelf::LSystems, Shelf::Instancing];
    let entries = catalogue.entries();
    for entry in entries.iter().filter(|entry| grown.contains(&entry.shelf)) {
        let source = catalogue.rule(&entry.name).map_err(Diagnostics::from)?;
        let (model, _) = Document::read(&source, &catalogue)?.resolve(&[])?;
        // What has to be written out word by word may be too long.
        let Ok(graph) = model.compile(64) else {
            continue;
        };
        let known = dimensions_of_graph(&graph).dimensions;
        let exact = known.and_then(|known| known.hausdorff.value);
        let (Some(exact), Ok(set)) = (exact.filter(|&exact| exact > 0.0), LimitSet::of(&graph))
        else {
            continue;
        };
        let counting = BoxCounting::of_limit(&set, None, &grids, all_cores());
        let Some(estimate) = counting.estimate else {
            continue;
        };
        let off = estimate.value - exact;
        let error = 2.0 * estimate.std_error;
        measured += 1;
        close += usize::from(off.abs() <= 0.01);
        covered += usize::from(off.abs() <= error);
        let says = match (off.abs() <= 0.01, off.abs() <= error) {
            (true, true) => "",
            (false, true) => "far",
            (true, false) => "not covered",
            (false, false) => "far, not covered",
        };
        println!(
            "| {} | {exact:.4} | {:.4} | {error:.4} | {off:+.4} | {:.1} | {says} |",
            entry.name,
            estimate.value,
            estimate.decades(),
        );
    }
    println!(
        "\n{close} of {measured} are off by no more than 0.01, {covered} lie in their interval."
    );
    Ok(())
}
