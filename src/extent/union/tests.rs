//! Compares hulls of many images with hulls of all their points.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use proptest::collection::vec;
use proptest::prelude::*;

use super::{Landmarks, Union};
use crate::geometry::{DAffine2, DVec2, convex_hull, hausdorff_distance};

fn turned(ratio: f64, degrees: f64, at: DVec2) -> DAffine2 {
    DAffine2::from_scale_angle_translation(DVec2::splat(ratio), degrees.to_radians(), at)
}

fn regular(corners: u32, radius: f64) -> Vec<DVec2> {
    let turn = std::f64::consts::TAU / f64::from(corners);
    let corner = |number| radius * DVec2::from_angle(turn * f64::from(number));
    convex_hull((0..corners).map(corner).collect(), 0.0)
}

/// Returns the distance of a hull to within `tolerance` from the hull of all points, and the allowed one.
fn apart(
    points: &[DVec2],
    images: &[(DAffine2, usize)],
    polygons: &[Vec<DVec2>],
    tolerance: f64,
) -> [f64; 2] {
    let landmarks = Landmarks::of_all(polygons);
    let union = Union {
        points,
        images,
        polygons,
        landmarks: &landmarks,
    };
    let hull = union.hull(tolerance);
    let all = images.iter().flat_map(|(map, polygon)| {
        polygons[*polygon]
            .iter()
            .map(|it| map.transform_point2(*it))
    });
    let all = convex_hull(all.chain(points.iter().copied()).collect(), 0.0);
    assert!(
        hull.corners.iter().all(|corner| all.contains(corner)),
        "corners are points"
    );
    assert!(hull.work > 0);
    [hausdorff_distance(&hull.corners, &all), hull.lost]
}

#[test]
fn hulls_of_many_images_are_close() {
    let polygons = [regular(32, 1.0), regular(3, 2.0)];
    let places = (0..5000_u32).map(|it| DVec2::new(f64::from(it % 71), f64::from(it % 83)));
    let images = places
        .zip(0..)
        .map(|(at, it)| (turned(0.3, f64::from(it), at), it as usize % 2));
    let images: Vec<_> = images.collect();
    for tolerance in [1e-9, 1e-3, 0.0] {
        let [apart, lost] = apart(&[DVec2::new(-5.0, 40.0)], &images, &polygons, tolerance);
        assert!(apart <= lost && lost < 2e-3, "{apart} {lost}");
    }
}

#[test]
fn flat_and_single_hulls_are_exact() {
    let along = |it: u32| {
        (
            turned(1e-3, 0.0, DVec2::new(f64::from(it), f64::from(it))),
            0,
        )
    };
    let images: Vec<_> = (0..100).map(along).collect();
    let [apart_of_line, _] = apart(&[], &images, &[vec![DVec2::ZERO]], 0.0);
    assert_eq!(apart_of_line, 0.0);
    let [apart_of_point, _] = apart(&[], &vec![images[7]; 50], &[vec![DVec2::ONE]], 0.0);
    assert_eq!(apart_of_point, 0.0);
    let union = Union {
        points: &[],
        images: &images,
        polygons: &[Vec::new()],
        landmarks: &Landmarks::of_all(&[Vec::new()]),
    };
    assert!(union.hull(0.0).corners.is_empty());
}

proptest! {
    #[test]
    fn hulls_are_within_the_tolerance(
        places in vec((0.01..2.0_f64, 0.0..360.0_f64, -5.0..5.0_f64, -5.0..5.0_f64), 32..150),
        corners in 1..40_u32,
        tolerance in 1e-6..0.5_f64,
    ) {
        let place = |(ratio, turn, x, y): &(f64, f64, f64, f64)| {
            (turned(*ratio, *turn, DVec2::new(*x, *y)), 0)
        };
        let images: Vec<_> = places.iter().map(place).collect();
        let [apart, lost] = apart(&[], &images, &[regular(corners, 1.0)], tolerance);
        prop_assert!(lost == tolerance && apart <= tolerance + 1e-12, "{apart} {lost}");
    }
}
