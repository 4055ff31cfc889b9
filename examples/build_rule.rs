//! Builds a rule in code and writes it as SVG to standard output: regular polygons of regular
//! polygons, one in every corner, as large as possible without overlap.
//!
//!     cargo run --locked --example build_rule -- 7 > heptagons.svg

use std::error::Error;
use std::io::{self, Write};
use std::sync::Arc;

use kfrac::Fractal;
use kfrac::build::{ElementBuilder, ElementsBuilder, RuleBuilder};
use kfrac::geometry::DVec2;
use kfrac::model::Model;
use kfrac::rule::{BaseElement, Piece, Rule};

/// Returns the rule for polygons with `sides` sides, the first of which runs from (0, 0) to (1, 0).
fn polygons(sides: u32) -> Result<Rule, Box<dyn Error>> {
    let turn = |corners: u32| {
        let angle = std::f64::consts::TAU * f64::from(corners) / f64::from(sides);
        DVec2::from_angle(angle)
    };
    let mut corners = vec![DVec2::ZERO];
    for side in 1..sides {
        corners.push(corners[corners.len() - 1] + turn(side - 1));
    }
    // Neighbours touch where 1 = 2r (1 + cos 360°/n + cos 2·360°/n + …), up to right angles.
    let cosines: f64 = (1..=sides / 4).map(|corner| turn(corner).x).sum();
    let ratio = 0.5 / (1.0 + cosines);

    let outline = corners.iter().skip(1).map(|&corner| Piece::Line(corner));
    let polygon =
        BaseElement::new(DVec2::ZERO, outline.collect(), true).ok_or("a polygon needs corners")?;
    let mut copies = ElementsBuilder::new();
    for &corner in &corners {
        let from = corner * (1.0 - ratio);
        copies = copies.element(ElementBuilder::to(from + DVec2::X * ratio).from(from));
    }
    let rule = RuleBuilder::new([(0, 0), (1, 0)])
        .base_element(&polygon)
        .generator("copies", copies.connected(false))
        .build()?;
    Ok(rule)
}

fn main() -> Result<(), Box<dyn Error>> {
    let sides = std::env::args()
        .nth(1)
        .map_or(Ok(7), |sides| sides.parse())?;
    if !(3..=12).contains(&sides) {
        return Err("from 3 to 12 sides".into());
    }
    let rule = polygons(sides)?;
    let svg = Fractal::from(Model::Rule(Arc::new(rule)))
        .steps(4)
        .size(800)
        .svg()?;
    io::stdout().write_all(svg.as_bytes())?;
    Ok(())
}
