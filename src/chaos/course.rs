//! The walks of a chaos game, divided into waves for threads.

use crate::geometry::{Linear, Point};
use crate::ifs::PointOf;

use super::alias::AliasTable;
use super::random::{LANES, Scalar};
use super::system::{Map, WeightedMaps};
use super::walked::{ChaosMap, SetSampler};
use super::{ClassBy, Game, Start};

/// Steps of a walker that starts on the attractor, before another one starts: few enough for all threads to
/// have walks, and enough that the warm-up takes little.
const STEPS: u64 = 1 << 15;

/// Steps of a walker that starts on the attractor before its points count. All walkers start at one point:
/// they must forget it, and must have the longest history of maps that classes may require.
pub(super) const WARM_UP: u32 = 256;

/// Steps of the walk that estimates rounding errors.
const PILOT: usize = 1024;

/// Number of steps of that walk between the points whose errors are estimated: a prime, for walks that recur.
const EVERY: usize = 13;

/// Rounding error, in pixels, up to which single precision is used.
const FINE: f64 = 1.0 / 64.0;

/// Unit roundoff of single precision.
const UNIT: f64 = f32::EPSILON as f64 / 2.0;

/// All walks of a game, in the coordinates of a window. A *wave* consists of [`LANES`] walkers side by side; it has its own random
/// numbers, and waves can be walked in any order.
pub(super) struct Course<'a, M: ChaosMap> {
    pub(super) system: &'a WeightedMaps<M>,
    pub(super) choice: AliasTable,
    /// Affine maps as maps of the window to itself.
    pub(super) maps: Vec<Option<M>>,
    /// Map to the coordinates of the window.
    pub(super) to_window: M,
    pub(super) classes: ClassBy,
    pub(super) seed: u64,
    start: &'a Start<PointOf<M>>,
    /// Number of steps of a walker that count.
    steps: u64,
    points: u64,
    /// Whether the errors of single precision would be visible.
    pub(super) is_double: bool,
}

impl<'a, M: ChaosMap> Course<'a, M> {
    /// Creates the walks of a game. `scale` is the largest number of pixels a unit of the window.
    pub(super) fn new(
        system: &'a WeightedMaps<M>,
        to_window: M,
        scale: f64,
        game: &'a Game<'_, PointOf<M>>,
    ) -> Self {
        let inverse = to_window.inverted();
        let maps = system.maps().iter().map(|map| match map {
            Map::Affine(map) => Some(to_window * *map * inverse),
            Map::Condensation(_) => None,
        });
        let mut course = Self {
            system,
            choice: system.choice(),
            maps: maps.collect(),
            to_window,
            classes: game.classes,
            seed: game.seed,
            start: &game.start,
            steps: match &game.start {
                Start::Attractor => STEPS,
                Start::Points { steps, .. } => steps.get().into(),
            },
            points: game.points,
            is_double: false,
        };
        let is_fine = |rounding: f64| rounding * scale <= FINE;
        let bound = course.bound_of_rounding();
        course.is_double = !(bound.is_some_and(is_fine) || is_fine(course.rounding()));
        course
    }

    /// Returns the number of waves.
    pub(super) fn waves(&self) -> u64 {
        self.points.div_ceil(self.points_a_wave())
    }

    /// Returns the number of points of a wave.
    pub(super) fn points_of(&self, wave: u64) -> u64 {
        let all = self.points_a_wave();
        all.min(self.points.saturating_sub(wave.saturating_mul(all)))
    }

    fn points_a_wave(&self) -> u64 {
        self.steps * LANES as u64
    }

    /// Returns the number of steps of a wave that do not count.
    pub(super) fn warm_up(&self) -> u32 {
        match self.start {
            Start::Attractor => WARM_UP,
            Start::Points { .. } => 0,
        }
    }

    /// Returns the start of a walker of a wave, in the window, and the map that led to it: the number of maps
    /// where there was none.
    pub(super) fn start(&self, wave: u64, lane: usize) -> (PointOf<M>, usize) {
        let walk = wave.wrapping_mul(LANES as u64).wrapping_add(lane as u64);
        let (point, last) = match self.start.walk(walk) {
            Some(point) => (point, self.maps.len()),
            None => {
                let start = self.system.start();
                (start.point, start.last)
            }
        };
        (self.to_window.apply(point), last)
    }

    /// Returns a bound of the error of a point by single precision, in the window; `None` if a map does not contract.
    ///
    /// Maps that shorten all vectors by a factor s keep the walk in a ball and shorten errors by s, to which a step adds its
    /// own: together no more than that of one step, divided by 1 − s.
    fn bound_of_rounding(&self) -> Option<f64> {
        let maps: Vec<M> = self.maps.iter().copied().collect::<Option<_>>()?;
        let rest = 1.0 - largest(maps.iter().map(|map| map.linear().stretch()));
        if !(rest > 0.0 && matches!(self.start, Start::Attractor)) {
            return None;
        }
        let start = self.to_window.apply(self.system.start().point);
        let moved = maps.iter().map(|map| (map.apply(start) - start).length());
        let radius = largest(moved) / rest;
        let farthest = start.abs() + PointOf::<M>::splat(radius);
        let terms = maps.iter().map(|map| map.abs().apply(farthest).length());
        let step = largest(terms) * (M::ROUNDINGS * UNIT);
        Some(step / rest)
    }

    /// Returns a bound of the error of a point by single precision, in the window, estimated for some points of a walk: what
    /// each step before has added, taken along by the product of the maps since.
    fn rounding(&self) -> f64 {
        let mut random = Scalar::new(0, 0);
        let start = self.system.start();
        let mut last = start.last;
        let mut point = self.to_window.apply(start.point);
        // The maps of the walk, none for a condensation set, and the error that a step adds.
        let mut steps: Vec<(Option<M>, PointOf<M>)> = Vec::with_capacity(PILOT);
        let mut worst = 0.0f64;
        for number in 1..=PILOT {
            last = self
                .choice
                .choose(self.system.state_after(last), random.word());
            let map = self.maps[last];
            let added = match (map, &self.system.maps()[last]) {
                (Some(map), _) => {
                    // Products, sums, and the rounding of the coefficients.
                    let terms = map.abs().apply(point.abs());
                    point = map.apply(point);
                    terms * (M::ROUNDINGS * UNIT)
                }
                (None, Map::Condensation(shape)) => {
                    point = self.to_window.apply(shape.sample(&mut random));
                    point.abs() * UNIT
                }
                (None, Map::Affine(_)) => unreachable!("affine maps have one of the window"),
            };
            steps.push((map, added));
            let error = match number % EVERY {
                0 => accumulated(&steps),
                _ => added,
            };
            worst = largest([worst].into_iter().chain(error.coordinates()));
        }
        worst
    }
}

/// Returns the largest of numbers that are not negative; NaN counts as infinite.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    let numbers = numbers.map(|number| {
        if number.is_nan() {
            f64::INFINITY
        } else {
            number
        }
    });
    numbers.fold(0.0, f64::max)
}

/// Returns the error at the end of a walk, with the error that each step has added.
fn accumulated<M: ChaosMap>(steps: &[(Option<M>, PointOf<M>)]) -> PointOf<M> {
    /// Part of the sum that what came before may have.
    const NEGLIGIBLE: f64 = 1e-3;
    let mut sum = PointOf::<M>::ZERO;
    let mut since = M::IDENTITY;
    for (map, added) in steps.iter().rev() {
        let own = since.abs().apply_vector(*added);
        sum = sum + own;
        match map {
            Some(map) => since = since * *map,
            // A point that is drawn has no error of those before.
            None => break,
        }
        if since.linear().stretch() < NEGLIGIBLE {
            break;
        }
    }
    sum
}
