//! Meshes: the sides between the lower face of the unit cube before a transformation and that after it.

use std::collections::BTreeMap;

use crate::geometry::{DAffine3, DVec3};

use super::program::Program;

/// Corners of the lower face of the cube about the origin, counter-clockwise from above.
const FACE: [DVec3; 4] = [
    DVec3::new(-0.5, -0.5, -0.5),
    DVec3::new(0.5, -0.5, -0.5),
    DVec3::new(0.5, 0.5, -0.5),
    DVec3::new(-0.5, 0.5, -0.5),
];

/// Relative size of what is rounding.
const ROUNDING: f64 = 1e-12;

/// The transformation of a copy of a call.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Passage {
    pub(super) alternative: usize,
    /// Number of the action of the alternative.
    pub(super) action: usize,
    /// Number of times that each loop is applied.
    pub(super) times: Vec<u32>,
}

/// Passages along which there are meshes.
#[derive(Default)]
pub(super) struct Passages {
    all: Vec<Passage>,
    known: BTreeMap<Passage, usize>,
}

impl Passages {
    /// Returns the number of a passage, which is added if it is new.
    pub(super) fn number(&mut self, passage: Passage) -> usize {
        let next = self.all.len();
        *self.known.entry(passage).or_insert_with_key(|passage| {
            self.all.push(passage.clone());
            next
        })
    }

    /// Returns the passage of a number.
    pub(super) fn get(&self, number: usize) -> &Passage {
        &self.all[number]
    }
}

impl Passage {
    /// Returns the map from the cube after the transformation to that before it.
    fn map(&self, program: &Program) -> DAffine3 {
        let loops = &program.alternatives[self.alternative].actions[self.action].loops;
        let motions = loops.iter().zip(&self.times);
        motions.fold(DAffine3::IDENTITY, |all, (it, times)| {
            all * it.motion.power(*times).map()
        })
    }

    /// Returns the sides of the mesh in the coordinates of the cube after the transformation, counter-clockwise from
    /// outside. One that is not plane is divided into triangles, and those without an area are left out.
    pub(super) fn sides(&self, program: &Program) -> Vec<Vec<DVec3>> {
        let back = self.map(program).inverse();
        if !back.is_finite() {
            return Vec::new();
        }
        let sides = (0..4).flat_map(|at: usize| {
            let [from, to] = [FACE[at], FACE[(at + 1) % 4]];
            let [below, beside] = [from, to].map(|it| back.transform_point3(it));
            let [a, b, c] = [beside - below, to - below, from - below];
            let size = a.length().max(b.length()).max(c.length());
            let is_plane = a.cross(b).dot(c).abs() <= ROUNDING * size * size * size;
            let side = vec![below, beside, to, from];
            let triangles = || vec![vec![below, beside, to], vec![below, to, from]];
            if is_plane { vec![side] } else { triangles() }
        });
        sides.filter(|side| has_area(side)).collect()
    }
}

fn has_area(corners: &[DVec3]) -> bool {
    let away: Vec<DVec3> = corners.iter().map(|it| *it - corners[0]).collect();
    let area: DVec3 = { away.windows(2) }.map(|pair| pair[0].cross(pair[1])).sum();
    let size = away
        .iter()
        .map(|it| it.length_squared())
        .fold(0.0, f64::max);
    area.length() > ROUNDING * size
}
