//! Limits of steps of fractals in space.

use anyhow::anyhow;

use crate::geometry::{DVec3, Frame3, HalfSpace};
use crate::graph::Graph;

use super::Failure;
use super::readable::{counted, grouped};
use super::rule::Loaded;

/// Parses a plane, as its normal and the value on it.
pub(super) fn plane(text: &str) -> Result<HalfSpace, String> {
    let plane = || {
        let (normal, value) = text.split_once('=')?;
        let normal: Result<Vec<f64>, _> = normal.split(',').map(|at| at.trim().parse()).collect();
        let normal: [f64; 3] = normal.ok()?.try_into().ok()?;
        let normal = DVec3::from_array(normal);
        let distance: f64 = value.trim().parse().ok()?;
        normal.try_normalize()?;
        Some(HalfSpace { normal, distance }).filter(|_| distance.is_finite())
    };
    plane().ok_or_else(|| "a plane is its normal and a value, as 1,0,0=0.5".into())
}

/// Returns an error if a step has too many elements.
pub(super) fn check(
    loaded: &Loaded,
    graph: &Graph<Frame3>,
    steps: u32,
    most: u64,
) -> Result<(), Failure> {
    let Err(error) = graph.check_size(steps, most) else {
        return Ok(());
    };
    let count = error.elements.as_ref().map_or_else(
        || "more elements than can be counted".into(),
        |elements| counted(elements, "element"),
    );
    let limit = grouped(&most.into());
    let deepest = match error.deepest {
        Some(step) => format!("{step} is the deepest step within --max-elements {limit}"),
        None => format!("no step is within --max-elements {limit}"),
    };
    Err(anyhow!("step {steps} of {} has {count}; {deepest}", loaded.name).into())
}
