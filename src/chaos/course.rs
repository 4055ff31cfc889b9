//! The walks of a chaos game, divided into waves for threads.

use crate::geometry::Point;
use crate::ifs::PointOf;

use super::alias::AliasTable;
use super::random::{LANES, Scalar};
use super::system::{Map, WeightedMaps};
use super::walked::{Sample, Walked};
use super::{ClassBy, Game, Start};

/// Steps of a walker that starts on the attractor, before another one starts: few enough for all threads to
/// have walks, and enough that the warm-up takes little.
const STEPS: u64 = 1 << 15;

/// Steps of a walker that starts on the attractor before its points count. All walkers start at one point:
/// they must forget it, and must have the longest history of maps that classes may require.
pub(super) const WARM_UP: u32 = 256;

/// Steps of the walk that estimates rounding errors.
const PILOT: u32 = 10_000;

/// Rounding error, in pixels, up to which single precision is used.
const FINE: f64 = 1.0 / 64.0;

/// All walks of a game, in the coordinates of a window. A *wave* consists of [`LANES`] walkers side by side; it has its own random
/// numbers, and waves can be walked in any order.
pub(super) struct Course<'a, M: Walked> {
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

impl<'a, M: Walked> Course<'a, M> {
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
        course.is_double = course.rounding() * scale > FINE;
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

    /// Returns a bound of the error of a point by single precision, in the window, estimated along a walk.
    fn rounding(&self) -> f64 {
        let unit = f64::from(f32::EPSILON) / 2.0;
        let mut random = Scalar::new(0, 0);
        let start = self.system.start();
        let mut last = start.last;
        let mut point = self.to_window.apply(start.point);
        let mut error = PointOf::<M>::ZERO;
        let mut worst = 0.0f64;
        for _ in 0..PILOT {
            last = self
                .choice
                .choose(self.system.state_after(last), random.word());
            match (&self.maps[last], &self.system.maps()[last]) {
                (Some(map), _) => {
                    let spread = map.abs();
                    // Products, sums, and the rounding of the coefficients.
                    let terms = spread.apply(point.abs());
                    error = spread.apply_vector(error) + terms * (M::ROUNDINGS * unit);
                    point = map.apply(point);
                }
                (None, Map::Condensation(shape)) => {
                    point = self.to_window.apply(shape.sample(&mut random));
                    error = point.abs() * unit;
                }
                (None, Map::Affine(_)) => unreachable!("affine maps have one of the window"),
            }
            worst = worst.max(error.max_element());
        }
        // NaN counts as the largest error.
        if error.is_finite() {
            worst
        } else {
            f64::INFINITY
        }
    }
}
