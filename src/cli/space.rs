//! Arguments of commands in space.

use crate::geometry::{DVec3, HalfSpace};

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
