//! Compares the boxes of limit sets with random iteration and with iteration of polygons.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use proptest::collection::vec;
use proptest::prelude::*;

use crate::geometry::{Bounds, DAffine2, DMat2, DVec2, convex_hull, thinned};
use crate::graph::Graph;
use crate::ifs::{Definition, Edge, Ifs, Map, System, Verdict};
use crate::metadata::Metadata;
use crate::saturating::{real, whole};

/// Maps, and for each the maps that may follow it.
struct Maps {
    all: Vec<DAffine2>,
    followers: Vec<Vec<usize>>,
}

impl Maps {
    /// Creates a system in which any map may follow any.
    fn free(all: Vec<DAffine2>) -> Self {
        let followers = vec![(0..all.len()).collect(); all.len()];
        Self { all, followers }
    }

    fn scale(&mut self, factor: f64) {
        self.all.iter_mut().for_each(|map| map.matrix2 *= factor);
    }

    fn system(&self) -> System {
        let is_free = { &self.followers }
            .iter()
            .all(|it| it.len() == self.all.len());
        let followers = self.followers.iter().enumerate();
        let edges = followers.flat_map(|(from, all)| {
            all.iter().map(move |&to| Edge {
                from,
                to,
                weight: None,
            })
        });
        let ifs = Ifs::new(Definition {
            maps: self.all.iter().copied().map(Map::new).collect(),
            edges: (!is_free).then(|| edges.collect()),
            ..Definition::default()
        });
        let ifs = ifs.unwrap();
        System {
            metadata: Metadata::default(),
            contraction: ifs.contraction_within(10_000),
            ifs,
            written: Vec::new(),
            chained: false,
            interpolates: false,
            growing: None,
        }
    }

    /// Returns the box of polygons to which all maps are applied `rounds` times, each to the maps that it
    /// may follow: they converge to the hull of the limit set as fast as the maps contract.
    fn iterated(&self, rounds: usize) -> Bounds {
        let mut hulls = vec![vec![DVec2::ZERO]; self.all.len()];
        let mut size = 0.0;
        for _ in 0..rounds {
            let mut images = vec![Vec::new(); self.all.len()];
            for (hull, followers) in hulls.iter().zip(&self.followers) {
                for &map in followers {
                    let image = hull.iter().map(|it| self.all[map].transform_point2(*it));
                    images[map].extend(image);
                }
            }
            let next = images.into_iter();
            hulls = next
                .map(|it| thinned(&convex_hull(it, 0.0), 1e-12 * size))
                .collect();
            size = boxed(&hulls).size().max_element();
        }
        boxed(&hulls)
    }

    /// Asserts that a box contains points of random iteration, and that iterated polygons touch its
    /// sides.
    fn assert_box(&self, bounds: &Bounds, rounds: usize) {
        let size = bounds.size().max_element();
        let (mut map, mut point, mut state) = (0, DVec2::ZERO, 1u64);
        for number in 0..rounds + 10_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let followers = &self.followers[map];
            map = followers[(state >> 33) as usize % followers.len()];
            point = self.all[map].transform_point2(point);
            if number > rounds {
                let beyond = (bounds.min() - point).max(point - bounds.max());
                assert!(
                    beyond.max_element() <= 1e-9 * size,
                    "{point} is beyond {bounds:?} of {:?}",
                    self.all
                );
            }
        }
        let found = self.iterated(rounds);
        let off = (found.min() - bounds.min())
            .abs()
            .max((found.max() - bounds.max()).abs());
        assert!(
            off.max_element() <= 1e-9 * size,
            "{bounds:?}, not {found:?}, of {:?}",
            self.all
        );
    }
}

fn boxed(hulls: &[Vec<DVec2>]) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    hulls.iter().flatten().for_each(|point| bounds.add(*point));
    bounds
}

#[test]
fn a_system_that_contracts_slowly_has_a_box() {
    let map = |[a, b, c, d]: [f64; 4], shift: [f64; 2]| {
        DAffine2::from_mat2_translation(DMat2::from_cols_array(&[a, c, b, d]), shift.into())
    };
    let maps = Maps::free(vec![
        map([-0.65, -0.38, -0.44, 0.58], [-0.77, 0.72]),
        map([0.93, 0.0, 0.48, -0.995], [-0.27, 0.67]),
    ]);
    let bounds = Graph::of_system(&maps.system()).limit_bounds().unwrap();
    maps.assert_box(&bounds, 4500);
    // The fixed point of the second map is the leftmost point.
    assert!((bounds.min().x + 0.27 / 0.07).abs() < 1e-9);
}

#[test]
fn a_digraph_of_many_maps_has_a_box() {
    let count = 60;
    let map = |number: usize| {
        let degrees = real(number * 77);
        let shift = DVec2::new(real(number % 17), real(number % 13));
        let ratio = 0.2 + real(number % 7) / 20.0;
        DAffine2::from_scale_angle_translation(DVec2::splat(ratio), degrees.to_radians(), shift)
    };
    let mut maps = Maps::free((0..count).map(map).collect());
    for (from, followers) in maps.followers.iter_mut().enumerate() {
        *followers = (0..40)
            .map(|step| (from * 7 + step * 61 + 1) % count)
            .collect();
        followers.sort_unstable();
        followers.dedup();
        assert_eq!(followers.len(), 40);
    }
    let bounds = Graph::of_system(&maps.system()).limit_bounds().unwrap();
    maps.assert_box(&bounds, 60);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_systems_that_contract_slowly_have_boxes(
        matrices in vec(vec(-1.0..1.0f64, 4), 2..5),
        shifts in vec(vec(-1.0..1.0f64, 2), 4),
        ways in prop::option::of(vec(vec(any::<bool>(), 4), 4)),
        radius in prop::sample::select(vec![0.9, 0.97, 0.985]),
    ) {
        let maps = matrices.iter().zip(&shifts).map(|(matrix, shift)| {
            DAffine2::from_mat2_translation(DMat2::from_cols_slice(matrix), DVec2::from_slice(shift))
        });
        let mut maps = Maps::free(maps.collect());
        if let Some(ways) = ways {
            // The next map may always follow, which makes the digraph strongly connected.
            let next = |from: usize| (from + 1) % matrices.len();
            for (from, followers) in maps.followers.iter_mut().enumerate() {
                followers.retain(|&to| ways[from][to] || to == next(from));
            }
        }
        // Scales the maps such that the lower bound of their contraction is `radius`.
        maps.scale(0.1);
        let slow = maps.system().contraction.lower;
        prop_assume!(slow > 1e-3);
        maps.scale(radius / slow);
        let system = maps.system();
        prop_assume!(system.contraction.verdict == Verdict::Contracts);
        let bounds = Graph::of_system(&system).limit_bounds();
        prop_assert!(bounds.is_some(), "{:?} have no box", maps.all);
        maps.assert_box(&bounds.unwrap(), whole(26.0 / (1.0 - radius)));
    }
}
