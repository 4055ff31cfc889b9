//! Draws a set in space from several directions, one PNG each, and prints its box.
//!
//!     cargo run --locked --release --example draw_in_space -- icosahedron-flake

#![allow(clippy::print_stdout, reason = "the result is printed")]

use std::error::Error;

use kfrac::Fractal;
use kfrac::render::space::{Camera, Shade, SpaceOptions};

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1);
    let name = name.unwrap_or_else(|| "menger".into());
    let set = Fractal::named(&name)?.size(600);
    println!("{name}: {:?}", set.bounds_in_space()?);
    for (view, from) in Camera::NAMED {
        let camera = Camera::default().from(from);
        let space = SpaceOptions::default()
            .camera(camera)
            .shade(Some(Shade::Both));
        let path = format!("{name}-{view}.png");
        set.clone().space(space).write(&path)?;
        println!("{path}");
    }
    Ok(())
}
