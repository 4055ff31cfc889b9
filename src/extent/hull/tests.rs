//! Compares hulls of systems of many maps with long iteration.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use proptest::collection::vec;
use proptest::prelude::*;

use crate::extent::{Bounded as _, Fineness, Own};
use crate::geometry::{Bounds, DAffine2, DVec2, Frame2, convex_hull, hausdorff_distance};
use crate::graph::Graph;
use crate::ifs::{Definition, Ifs, Map, System};
use crate::metadata::Metadata;

fn turned(ratio: f64, degrees: f64, at: DVec2) -> DAffine2 {
    DAffine2::from_scale_angle_translation(DVec2::splat(ratio), degrees.to_radians(), at)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn hulls_are_those_of_long_iteration(
        places in vec((0.2..0.8_f64, 0.0..360.0_f64, -1.0..1.0_f64, -1.0..1.0_f64), 40..120),
    ) {
        let place = |(ratio, turn, x, y): &(f64, f64, f64, f64)| turned(*ratio, *turn, DVec2::new(*x, *y));
        let maps: Vec<DAffine2> = places.iter().map(place).collect();
        let ifs = Ifs::new(Definition {
            maps: maps.iter().copied().map(Map::new).collect(),
            ..Definition::default()
        });
        let ifs = ifs.unwrap();
        let system = System {
            metadata: Metadata::default(),
            contraction: ifs.contraction(),
            ifs,
            written: Vec::new(),
            chained: false,
            interpolates: false,
            growing: None,
        };
        let graph = Graph::of_system(&system);
        let own = Own::Outlines(&vec![0.0; graph.objects().len()]);
        let hulls = Frame2::hulls(&graph, &own, Some(&graph.alive(true)), Fineness::COARSE).unwrap();
        let mut iterated = vec![DVec2::ZERO];
        for _ in 0..80 {
            let images = maps.iter().flat_map(|map| iterated.iter().map(|it| map.transform_point2(*it)));
            iterated = convex_hull(images.collect(), 1e-7);
        }
        let mut bounds = Bounds::EMPTY;
        iterated.iter().for_each(|corner| bounds.add(*corner));
        let size = bounds.size().max_element();
        let apart = hausdorff_distance(hulls.corners(0), &iterated);
        prop_assert!(apart < 2e-4 * size, "{apart} of {size}");
        let exactly = 1e-5 * size;
        for degrees in 0..90_u32 {
            let along = DVec2::from_angle(f64::from(4 * degrees).to_radians());
            let reached = iterated.iter().map(|it| it.dot(along)).fold(f64::NEG_INFINITY, f64::max);
            let [most, least] = hulls.along(0, along);
            prop_assert!(least - exactly <= reached && reached <= most + exactly, "{degrees}");
        }
    }
}
