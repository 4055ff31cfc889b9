//! Grows a rule of the library and writes it as SVG to standard output.
//!
//!     cargo run --locked --example grow_svg -- dragon 10 > dragon.svg

use std::error::Error;
use std::io::{self, Write};

use kfrac::Fractal;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "pythagoras".into());
    let steps = arguments.next().map_or(Ok(8), |steps| steps.parse())?;
    let svg = Fractal::named(&name)?.steps(steps).size(800).svg()?;
    io::stdout().write_all(svg.as_bytes())?;
    Ok(())
}
