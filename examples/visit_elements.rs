//! Iterates over the elements of an approximant in order, without holding them: the turns of a curve.
//!
//!     cargo run --locked --example visit_elements

#![allow(clippy::print_stdout, reason = "the result is printed")]

use std::error::Error;

use kfrac::Fractal;
use kfrac::geometry::DVec2;

fn main() -> Result<(), Box<dyn Error>> {
    let text = "
initiator: segment
generators:
  left: [[0, 0], [1/2, 1/2], [1, 0]]
  right: [[0, 0], [1/2, -1/2], [1, 0]]
select: {by_index: [left, right]}
";
    let dragon = Fractal::parse(text)?.steps(5);
    let mut heading: Option<DVec2> = None;
    let mut turns = String::new();
    for element in dragon.elements()? {
        let [from, to] = element?.frame.ends();
        if let Some(before) = heading.replace(to - from) {
            let is_left = before.perp_dot(to - from) > 0.0;
            turns.push(if is_left { 'L' } else { 'R' });
        }
    }
    println!("{} elements, turns {turns}", turns.len() + 1);
    Ok(())
}
