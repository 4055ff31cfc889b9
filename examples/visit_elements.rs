//! Visits the elements of an approximant in order, without storing them, and prints the turns of a curve.
//!
//!     cargo run --example visit_elements

#![allow(clippy::print_stdout, reason = "it says what it has found")]

use std::convert::Infallible;
use std::error::Error;

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::geometry::DVec2;
use kfrac::grow::{Element, Fractal, Growth, Visitor, walk};

/// Visitor that writes L for every left turn and R for every right turn.
#[derive(Default)]
struct Turns {
    heading: Option<DVec2>,
    word: String,
}

impl Visitor for Turns {
    type Error = Infallible;

    fn begin(&mut self, _: Fractal) -> Result<(), Infallible> {
        self.heading = None;
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        let [from, to] = element.frame.ends();
        let heading = to - from;
        if let Some(before) = self.heading.replace(heading) {
            self.word.push(if before.perp_dot(heading) > 0.0 {
                'L'
            } else {
                'R'
            });
        }
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let text = "
initiator: segment
generators:
  left: [[0, 0], [1/2, 1/2], [1, 0]]
  right: [[0, 0], [1/2, -1/2], [1, 0]]
select: {by_index: [left, right]}
";
    let source = Source::new("dragon", text);
    let (model, _warnings) = Document::read(&source, &Catalogue::embedded())?.resolve(&[])?;
    let graph = model.compile(5)?;
    let mut turns = Turns::default();
    let walked = walk(&graph, &Growth::steps(5), &mut turns)?;
    println!("{} elements, turns {}", walked.elements, turns.word);
    Ok(())
}
