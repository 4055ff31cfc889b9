//! The points of a random walk as an iterator.

use crate::geometry::{DAffine2, DVec2};
use crate::ifs::PointOf;

use super::Start;
use super::alias::AliasTable;
use super::course::WARM_UP;
use super::random::Scalar;
use super::system::{Map, WeightedMaps};
use super::walked::{ChaosMap, SetSampler};

/// A point of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomPoint<P = DVec2> {
    /// Position of the point.
    pub place: P,
    /// Index of the map that led to it, from 0; the condensation sets follow the maps.
    pub map: usize,
}

/// The points of a walk in double precision, without end. [`play`](super::play) counts points; this iterator
/// lists them.
///
/// A walk that starts on the attractor has forgotten the start before its first point. Walks from given
/// starts end after their number of steps, and the next one begins.
#[derive(Clone, Debug)]
pub struct RandomPoints<'a, M: ChaosMap = DAffine2> {
    system: &'a WeightedMaps<M>,
    choice: AliasTable,
    random: Scalar,
    start: &'a Start<PointOf<M>>,
    at: RandomPoint<PointOf<M>>,
    /// Number of steps taken, over all walks.
    taken: u64,
    /// Number of the image that is next.
    image: usize,
}

impl<'a, M: ChaosMap> RandomPoints<'a, M> {
    /// Creates the walk of a system with a seed.
    #[must_use]
    pub fn new(system: &'a WeightedMaps<M>, start: &'a Start<PointOf<M>>, seed: u64) -> Self {
        let first = system.start();
        let mut points = Self {
            system,
            choice: system.choice(),
            random: Scalar::new(seed, 0),
            start,
            at: RandomPoint {
                place: first.point,
                map: first.last,
            },
            taken: 0,
            image: 0,
        };
        if start.walk(0).is_none() {
            for _ in 0..WARM_UP {
                points.advance();
            }
        }
        points
    }

    /// Takes a step, of a walk that begins where the last one has ended.
    fn step(&mut self) {
        if let Start::Points { steps, .. } = self.start
            && self.taken.is_multiple_of(steps.get().into())
            && let Some(place) = self.start.walk(self.taken / u64::from(steps.get()))
        {
            let map = self.system.maps().len();
            self.at = RandomPoint { place, map };
        }
        self.taken += 1;
        self.advance();
    }

    fn advance(&mut self) {
        let state = self.system.state_after(self.at.map);
        let map = self.choice.choose(state, self.random.word());
        let place = match &self.system.maps()[map] {
            Map::Affine(affine) => affine.apply(self.at.place),
            Map::Condensation(shape) => shape.sample(&mut self.random),
        };
        self.at = RandomPoint { place, map };
    }
}

impl<M: ChaosMap> Iterator for RandomPoints<'_, M> {
    type Item = RandomPoint<PointOf<M>>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.image == 0 {
            self.step();
        }
        let images = self.system.images();
        let place = match images.get(self.image) {
            Some(isometry) => isometry.apply(self.at.place),
            None => self.at.place,
        };
        self.image = (self.image + 1) % images.len().max(1);
        Some(RandomPoint { place, ..self.at })
    }
}
