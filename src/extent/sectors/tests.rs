//! Compares sectors with all images, one by one.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use proptest::collection::vec;
use proptest::prelude::*;

use super::{FEW, MANY, Sectors, Whole};
use crate::geometry::{DVec2, convex_hull};

fn direction(degrees: f64) -> DVec2 {
    DVec2::from_angle(degrees.to_radians())
}

/// Returns the largest x·u over points.
fn farthest(points: &[DVec2], along: DVec2) -> f64 {
    let reached = points.iter().map(|point| point.dot(along));
    reached.fold(f64::NEG_INFINITY, f64::max)
}

fn numbers(images: &[Vec<DVec2>]) -> Vec<u32> {
    (0..).take(images.len()).collect()
}

proptest! {
    #[test]
    fn the_farthest_image_contends(
        corners in vec(vec((-1.0..1.0, -1.0..1.0), 1..4), MANY..200),
        angles in vec(0.0..360.0_f64, 40),
    ) {
        let points = corners.iter().map(|image| image.iter().map(|it| DVec2::from(*it)).collect());
        let images: Vec<Vec<DVec2>> = points.collect();
        let hull = convex_hull(images.concat(), 0.0);
        let reach = |number: u32, along| farthest(&images[number as usize], along);
        let whole = Whole { corners: &hull, within: 0.0, reach: &reach, at_most: &reach };
        let sectors = Sectors::of(numbers(&images), &whole);
        let anywhere = sectors.anywhere(&whole);
        let axes = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
        for along in angles.into_iter().map(direction).chain(axes) {
            let contenders = sectors.along(along, &whole).unwrap();
            prop_assert!(contenders.is_sorted());
            let most = farthest(&hull, along);
            for number in numbers(&images) {
                if reach(number, along) >= most {
                    prop_assert!(contenders.contains(&number) && anywhere.contains(&number));
                }
            }
        }
    }
}

#[test]
fn sectors_are_halved_until_few_contend() {
    let images: Vec<Vec<DVec2>> = (0..3600)
        .map(|it| vec![direction(f64::from(it) / 10.0)])
        .collect();
    let inside = (0..3600).map(|it| vec![0.5 * direction(f64::from(it) / 10.0)]);
    let images: Vec<Vec<DVec2>> = images.into_iter().chain(inside).collect();
    let hull = convex_hull(images.concat(), 0.0);
    let reach = |number: u32, along| farthest(&images[number as usize], along);
    let whole = Whole {
        corners: &hull,
        within: 0.0,
        reach: &reach,
        at_most: &reach,
    };
    let sectors = Sectors::of(numbers(&images), &whole);
    for degrees in [0.0, 17.23, 90.0, 180.0, 245.05, 270.0, 359.99] {
        let contenders = sectors.along(direction(degrees), &whole).unwrap();
        assert!((1..=FEW).contains(&contenders.len()), "{contenders:?}");
    }
    assert!(sectors.anywhere(&whole).iter().all(|number| *number < 3600));
    assert!(sectors.along(DVec2::NAN, &whole).is_none());
}

#[test]
fn images_whose_reach_is_unknown_contend() {
    let images: Vec<Vec<DVec2>> = (0..MANY).map(|it| vec![direction(it as f64)]).collect();
    let hull = convex_hull(images.concat(), 0.0);
    let reach = |number: u32, along| match number {
        20 => f64::NAN,
        _ => farthest(&images[number as usize], along),
    };
    let whole = Whole {
        corners: &hull,
        within: 0.0,
        reach: &reach,
        at_most: &reach,
    };
    let sectors = Sectors::of(numbers(&images), &whole);
    for degrees in [0.0, 45.0, 190.0] {
        assert!(
            sectors
                .along(direction(degrees), &whole)
                .unwrap()
                .contains(&20)
        );
    }
}
