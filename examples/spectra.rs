//! Measures the spectra D_q of the whole library and compares them with the exact ones where these are known.
//!
//!     cargo run --locked --release --example spectra
//!
//! The table is Markdown: the exact dimension, which is that of all orders of a natural measure, and for
//! every order the deviation of the measured value with its standard error. A star marks deviations of more
//! than 0.03 or three standard errors.

#![allow(clippy::print_stdout, reason = "it says what it has found")]

use std::error::Error;
use std::num::NonZero;

use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::diagnostic::Diagnostics;
use kfrac::document::Document;
use kfrac::measure::exact::{Spectrum, dimensions_of_graph};
use kfrac::measure::{Cascade, Generalised};
use kfrac::render::Options;

const ORDERS: [f64; 8] = [-2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0];

fn main() -> Result<(), Box<dyn Error>> {
    let catalogue = Catalogue::embedded();
    let series = NonZero::new(8).ok_or("no series")?;
    let (mut measured, mut close) = (0, 0);
    let orders = ORDERS.map(|order| format!(" D_{order} |"));
    println!("| name | exact |{}", orders.concat());
    println!("|---|---|{}", "---|".repeat(ORDERS.len()));
    let grown = [Shelf::RULES, Shelf::IFS, Shelf::LSYSTEMS, Shelf::INSTANCING];
    let entries = catalogue.entries();
    for entry in entries.iter().filter(|entry| grown.contains(&entry.shelf)) {
        let source = catalogue.rule(&entry.name).map_err(Diagnostics::from)?;
        let (model, _) = Document::read(&source, &catalogue)?.resolve(&[])?;
        // L-systems whose words have to be written out may exceed the limits.
        let Ok(graph) = model.compile(64) else {
            continue;
        };
        let known = dimensions_of_graph(&graph).dimensions;
        let known = known.as_ref().and_then(Spectrum::natural);
        let (Some(known), Some(measure)) = (known, Cascade::natural(&graph)) else {
            continue;
        };
        if known.at(0.0) == 0.0 {
            continue;
        }
        let spectrum =
            Generalised::of_measure(&measure, &ORDERS, None, series, Options::default().threads);
        let mut is_close = true;
        let cell = |it: &Generalised| {
            let Some(estimate) = it.estimate else {
                is_close = false;
                return " - |".to_owned();
            };
            let off = estimate.value - known.at(it.order);
            let is_near = off.abs() <= 0.03 && off.abs() <= 3.0 * estimate.std_error;
            is_close &= is_near;
            let star = if is_near { "" } else { " *" };
            format!(" {off:+.4} ± {:.4}{star} |", estimate.std_error)
        };
        let cells: Vec<String> = spectrum.iter().map(cell).collect();
        measured += 1;
        close += usize::from(is_close);
        println!(
            "| {} | {:.4} |{}",
            entry.name,
            known.at(0.0),
            cells.concat()
        );
    }
    println!("\n{close} of {measured} lie within 0.03 and three standard errors for all orders.");
    Ok(())
}
