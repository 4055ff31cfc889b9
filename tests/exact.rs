//! Exact dimensions by neighbour maps, against published values and against counts.

mod extremes;
mod laws;
mod library;
mod measured;
mod spectrum;
mod systems;

use crate::common;
use kfrac::geometry::{DAffine2, DVec2};
use kfrac::measure::exact::{Dimensions, GraphDirectedSystem, dimensions};

/// Returns the map z → ratio · e^{i turn} z + shift, with the turn in degrees; if `reflected`, a reflection
/// in the x axis precedes it.
fn similarity(ratio: f64, turn: f64, reflected: bool, shift: [f64; 2]) -> DAffine2 {
    let turn = DAffine2::from_angle(turn.to_radians());
    let scale = DVec2::new(ratio, if reflected { -ratio } else { ratio });
    DAffine2::from_translation(DVec2::from(shift)) * turn * DAffine2::from_scale(scale)
}

/// Returns the map x → ratio x + shift of the x axis.
fn line(ratio: f64, shift: f64) -> DAffine2 {
    similarity(ratio, 0.0, false, [shift, 0.0])
}

fn of(maps: &[DAffine2]) -> Dimensions {
    let copies = maps.iter().map(|map| (0, 0, *map));
    dimensions(&GraphDirectedSystem::plane(copies).unwrap()).unwrap()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-10
}
