//! The inner loop: walkers side by side, a step at a time.
//!
//! A block of steps is walked before its points are counted: counters are stored to at random, and a
//! processor that meets such stores between the walkers' own loads and stores has to wait.

use crate::ifs::PointOf;

use super::ClassBy;
use super::alias::AliasTable;
use super::course::Course;
use super::random::{LANES, Lanes, Scalar};
use super::system::{Map, WeightedMaps};
use super::tally::{Cancelled, Counter, Tally};
use super::walked::{ChaosMap, SetSampler};

/// Steps that are walked before they are counted.
const STEPS: usize = 64;

/// Method by which the walkers of a wave take a step.
pub(super) trait Walk<M: ChaosMap, C: Counter> {
    /// Places a walker.
    fn put(&mut self, lane: usize, point: PointOf<M>);

    /// Moves every walker by the map that its random word chooses, and stores where the new positions are
    /// counted.
    fn step(&mut self, words: &[u32; LANES], spots: &mut [C::Spot; LANES]);
}

/// Walks a wave.
#[inline(always)]
pub(super) fn run<M: ChaosMap, C: Counter>(
    course: &Course<'_, M>,
    wave: u64,
    walk: &mut impl Walk<M, C>,
    tally: &mut Tally<'_, C>,
) -> Result<(), Cancelled> {
    for lane in 0..LANES {
        walk.put(lane, course.start(wave, lane).0);
    }
    let mut lanes = Lanes::new(course.seed, wave);
    let mut words = [0; LANES];
    let mut block = [[C::Spot::default(); LANES]; STEPS];
    for _ in 0..course.warm_up() {
        lanes.draw(&mut words);
        walk.step(&words, &mut block[0]);
    }
    let mut left = course.points_of(wave);
    while left > 0 {
        for spots in &mut block {
            lanes.draw(&mut words);
            walk.step(&words, spots);
        }
        left -= tally.add(block.as_flattened(), left)?;
    }
    Ok(())
}

/// Maps, positions and pictures in the numbers of walkers.
pub(super) trait Screen<M: ChaosMap> {
    /// Counters of points.
    type Counter: Counter;
    /// An affine map.
    type Matrix: Copy;
    /// Positions of all walkers.
    type Places;

    /// Returns an affine map.
    fn matrix(map: &M) -> Self::Matrix;

    /// Returns the positions of walkers that all are at the origin.
    fn places() -> Self::Places;

    /// Places a walker.
    fn put(places: &mut Self::Places, lane: usize, point: PointOf<M>);

    /// Moves a walker by a map.
    fn advance(places: &mut Self::Places, lane: usize, matrix: &Self::Matrix);

    /// Stores where walkers are counted, with their classes.
    fn spots(
        &self,
        places: &Self::Places,
        classes: &[u32; LANES],
        spots: &mut [<Self::Counter as Counter>::Spot; LANES],
    );
}

/// Arbitrary systems, whose maps are looked up. If a walk `IS_FREE`, all maps are affine, any of them may follow any,
/// and classes are at most those of the last map.
pub(super) struct Any<'a, M: ChaosMap, S: Screen<M>, const IS_FREE: bool> {
    screen: S,
    places: S::Places,
    system: &'a WeightedMaps<M>,
    choice: &'a AliasTable,
    maps: Vec<S::Matrix>,
    /// Condensation sets, by map.
    shapes: Vec<Option<&'a M::Sampler>>,
    to_window: M,
    random: Scalar,
    /// Previous map of each walker.
    last: [u32; LANES],
    past: Past,
    has_classes: bool,
}

impl<'a, M: ChaosMap, S: Screen<M>, const IS_FREE: bool> Any<'a, M, S, IS_FREE> {
    pub(super) fn new(course: &'a Course<'_, M>, wave: u64, screen: S) -> Self {
        let maps = course.maps.iter();
        let shapes = course.system.maps().iter().map(|map| match map {
            Map::Affine(_) => None,
            Map::Condensation(shape) => Some(shape),
        });
        #[expect(
            clippy::cast_possible_truncation,
            reason = "there are not so many maps"
        )]
        let last: [u32; LANES] = std::array::from_fn(|lane| course.start(wave, lane).1 as u32);
        let ago = match course.classes {
            ClassBy::One => 0,
            ClassBy::Map { ago } => ago,
        };
        Self {
            screen,
            places: S::places(),
            system: course.system,
            choice: &course.choice,
            maps: maps
                .map(|map| S::matrix(map.as_ref().unwrap_or(&M::IDENTITY)))
                .collect(),
            shapes: shapes.collect(),
            to_window: course.to_window,
            random: Scalar::new(course.seed, wave),
            last,
            past: Past::new(ago, last),
            has_classes: course.classes != ClassBy::One,
        }
    }

    /// Applies a map that a random word chooses to a walker, and returns it.
    #[inline(always)]
    fn advance(&mut self, lane: usize, word: u32) -> u32 {
        let last = self.last[lane] as usize;
        let state = if IS_FREE {
            0
        } else {
            self.system.state_after(last)
        };
        let map = self.choice.choose(state, word);
        S::advance(&mut self.places, lane, &self.maps[map]);
        if !IS_FREE {
            if let Some(shape) = self.shapes[map] {
                let point = self.to_window.apply(shape.sample(&mut self.random));
                S::put(&mut self.places, lane, point);
            }
            if last == self.maps.len() {
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "there are not so many maps"
                )]
                self.past.begin(lane, map as u32);
            }
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "there are not so many maps"
        )]
        {
            map as u32
        }
    }
}

impl<M: ChaosMap, S: Screen<M>, const IS_FREE: bool> Walk<M, S::Counter>
    for Any<'_, M, S, IS_FREE>
{
    fn put(&mut self, lane: usize, point: PointOf<M>) {
        S::put(&mut self.places, lane, point);
    }

    #[inline(always)]
    fn step(&mut self, words: &[u32; LANES], spots: &mut [<S::Counter as Counter>::Spot; LANES]) {
        let now = if IS_FREE { 0 } else { self.past.advance() };
        for (lane, &word) in words.iter().enumerate() {
            self.last[lane] = self.advance(lane, word);
        }
        let mut classes = if IS_FREE {
            self.last
        } else {
            self.past.add(now, &self.last)
        };
        if !self.has_classes {
            classes = [0; LANES];
        }
        self.screen.spots(&self.places, &classes, spots);
    }
}

/// Ring buffer of the maps that walkers applied in recent steps.
struct Past {
    maps: Vec<[u32; LANES]>,
    now: usize,
}

impl Past {
    fn new(ago: u8, last: [u32; LANES]) -> Self {
        Self {
            maps: vec![last; usize::from(ago) + 1],
            now: 0,
        }
    }

    /// Advances to the next step, and returns its place in the ring.
    #[inline(always)]
    fn advance(&mut self) -> usize {
        self.now = if self.now + 1 < self.maps.len() {
            self.now + 1
        } else {
            0
        };
        self.now
    }

    /// Starts a new walk: its first map counts as all previous ones.
    #[cold]
    fn begin(&mut self, lane: usize, map: u32) {
        self.maps.iter_mut().for_each(|maps| maps[lane] = map);
    }

    /// Stores the maps of a step, and returns those of the oldest one.
    #[inline(always)]
    fn add(&mut self, now: usize, maps: &[u32; LANES]) -> [u32; LANES] {
        self.maps[now] = *maps;
        let oldest = if now + 1 < self.maps.len() {
            now + 1
        } else {
            0
        };
        self.maps[oldest]
    }
}
