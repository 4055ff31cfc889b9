//! Grows a rule of the library and writes it as SVG to standard output.
//!
//!     cargo run --example grow_svg -- dragon 10 > dragon.svg

use std::error::Error;
use std::io;

use kfrac::catalogue::Catalogue;
use kfrac::document::Document;
use kfrac::grow::Growth;
use kfrac::render::{self, Options, Size};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "pythagoras".into());
    let steps = arguments.next().map_or(Ok(8), |steps| steps.parse())?;

    let catalogue = Catalogue::embedded();
    let source = catalogue
        .rule(&name)
        .map_err(|error| error.message().to_owned())?;
    let (model, _warnings) = Document::read(&source, &catalogue)?.resolve(&[])?;
    let graph = model.compile(steps)?;
    let options = Options {
        size: Size::Long(800),
        ..Options::of(model.heading())
    };
    let out = &mut io::BufWriter::new(io::stdout().lock());
    render::write(&graph, &Growth::steps(steps), &options, out)?;
    Ok(())
}
