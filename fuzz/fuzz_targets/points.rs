//! Fuzzing of tables of points, as CSV and as PLY: read, and measured as samples.
//!
//! Checks that coordinates are finite, that there are no more points than rows, and that estimates are finite.

#![no_main]

use std::num::NonZero;

use kfrac::geometry::{DAffine2, DAffine3};
use kfrac::import::{Table, read_ply, read_points};
use kfrac::measure::{BoxCounting, Grid, Points, Space};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let columns = ["2", "x"].map(String::from);
    for columns in [None, Some(&columns[..])] {
        match read_points(bytes, columns) {
            Ok(Table::Plane(points)) => {
                assert!(points.iter().all(|point| point.is_finite()));
                measure::<DAffine2>(points, bytes);
            }
            Ok(Table::Space(points)) => {
                assert!(points.iter().all(|point| point.is_finite()));
                measure::<DAffine3>(points, bytes);
            }
            Err(error) => assert!(error.to_string().len() < 1 << 12, "too much is said"),
        }
    }
    match read_ply(bytes) {
        Ok(points) => {
            assert!(points.iter().all(|point| point.is_finite()));
            measure::<DAffine3>(points, bytes);
        }
        Err(error) => assert!(error.to_string().len() < 1 << 12, "too much is said"),
    }
});

fn measure<M: Space>(points: Vec<M::Point>, bytes: &[u8]) {
    assert!(points.len() <= bytes.len(), "more points than bytes");
    let Ok(points) = Points::<M>::new(points) else {
        return;
    };
    let base = NonZero::<usize>::MIN.saturating_add(1);
    let sample = points.sample(base, &[Grid::ALONG], NonZero::<usize>::MIN);
    let counting = BoxCounting::of_sample(&sample, 0.0);
    if let Some(estimate) = counting.estimate {
        assert!(
            estimate.value.is_finite() && estimate.std_error >= 0.0,
            "{estimate:?}"
        );
    }
}
