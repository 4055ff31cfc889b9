//! The walks of random iteration, divided among threads.

use crate::geometry::{DAffine2, DVec2};

use super::alias::AliasTable;
use super::random::{LANES, Scalar};
use super::system::{Map, System};
use super::{ClassBy, Game, Start, Window};

/// Steps of a walker that starts on the attractor, before another one starts: enough walks for all
/// threads, and long enough that the warm-up takes little.
const STEPS: u64 = 1 << 15;

/// Steps that such a walker takes before its points count: the walkers all start at one point, and
/// must forget it, and know all their past that may be asked for.
pub(super) const WARM_UP: u32 = 256;

/// Steps of the walk that tells how large rounding errors become.
const PILOT: u32 = 10_000;

/// Rounding errors of so many pixels do no harm.
const FINE: f64 = 1.0 / 64.0;

/// All walks of a game, in pixels. A *wave* is what [`LANES`] walkers walk side by side; it has its
/// own random numbers, so waves can be walked in any order.
pub(super) struct Course<'a> {
    pub(super) system: &'a System,
    pub(super) choice: AliasTable,
    /// The affine maps as maps from pixels to pixels.
    pub(super) maps: Vec<Option<DAffine2>>,
    pub(super) window: &'a Window,
    /// The bins of a class: its pixels, and one for what lies outside.
    pub(super) stride: u32,
    pub(super) classes: ClassBy,
    pub(super) seed: u64,
    start: &'a Start,
    /// Steps of a walker that count.
    steps: u64,
    points: u64,
    /// Whether single precision would show.
    pub(super) is_double: bool,
}

impl<'a> Course<'a> {
    pub(super) fn new(system: &'a System, window: &'a Window, game: &'a Game<'_>) -> Self {
        let inverse = window.to_pixels.inverse();
        let maps = system.maps().iter().map(|map| match map {
            Map::Affine(map) => Some(window.to_pixels * *map * inverse),
            Map::Condensation(_) => None,
        });
        let [width, height] = window.size;
        let mut course = Self {
            system,
            choice: system.choice(),
            maps: maps.collect(),
            window,
            stride: width * height + 1,
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
        course.is_double = course.rounding() > FINE;
        course
    }

    /// The number of waves.
    pub(super) fn waves(&self) -> u64 {
        self.points.div_ceil(self.points_a_wave())
    }

    /// The number of points of a wave.
    pub(super) fn points_of(&self, wave: u64) -> u64 {
        let all = self.points_a_wave();
        all.min(self.points.saturating_sub(wave.saturating_mul(all)))
    }

    fn points_a_wave(&self) -> u64 {
        self.steps * LANES as u64
    }

    /// The steps of a wave that do not count.
    pub(super) fn warm_up(&self) -> u32 {
        match self.start {
            Start::Attractor => WARM_UP,
            Start::Points { .. } => 0,
        }
    }

    /// Where a walker of a wave starts, in pixels, and after which map: the number of maps where
    /// there has been none.
    pub(super) fn start(&self, wave: u64, lane: usize) -> (DVec2, usize) {
        let walk = wave.wrapping_mul(LANES as u64).wrapping_add(lane as u64);
        let (point, last) = match self.start.walk(walk) {
            Some(point) => (point, self.maps.len()),
            None => {
                let start = self.system.start();
                (start.point, start.last)
            }
        };
        (self.window.to_pixels.transform_point2(point), last)
    }

    /// A bound for the error of a point in pixels, by single precision, along a walk.
    fn rounding(&self) -> f64 {
        let unit = f64::from(f32::EPSILON) / 2.0;
        let mut random = Scalar::new(0, 0);
        let start = self.system.start();
        let mut last = start.last;
        let mut point = self.window.to_pixels.transform_point2(start.point);
        let mut error = DVec2::ZERO;
        let mut worst = 0.0f64;
        for _ in 0..PILOT {
            last = self
                .choice
                .choose(self.system.state_after(last), random.word());
            match (&self.maps[last], &self.system.maps()[last]) {
                (Some(map), _) => {
                    let matrix = map.matrix2.abs();
                    // Two products, two sums, and the coefficients themselves.
                    let terms = matrix * point.abs() + map.translation.abs();
                    error = matrix * error + 4.0 * unit * terms;
                    point = map.transform_point2(point);
                }
                (None, Map::Condensation(shape)) => {
                    point = self
                        .window
                        .to_pixels
                        .transform_point2(shape.draw(&mut random));
                    error = unit * point.abs();
                }
                (None, Map::Affine(_)) => unreachable!("affine maps have one in pixels"),
            }
            worst = worst.max(error.max_element());
        }
        // Not a number counts as worst.
        if error.is_finite() {
            worst
        } else {
            f64::INFINITY
        }
    }
}
