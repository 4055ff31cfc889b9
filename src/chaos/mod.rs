//! Random iteration, the *chaos game*: the attractor of an iterated function system, and the P-balanced
//! measure on it, from random walks (Barnsley & Demko 1985; Demko, Hodges & Naylor 1985).
//!
//! A [`WeightedMaps`] is the walk of an [`Ifs`](crate::ifs::Ifs). At each step a walker is moved by one of its
//! maps, chosen at random, or placed at a random point of a condensation set; the fraction of its steps that
//! end in a part of the plane converges to the measure of that part. The function [`play`] counts the points
//! of walks, pixel by pixel, as a [`Histogram`]; [`RandomPoints`] lists them. In space, [`play_in_space`] draws
//! them as a [`DepthPicture`].
//!
//! Walkers walk side by side, in waves that each have their own random numbers. The result therefore depends
//! neither on the order of waves nor on the number of threads, and is the same on every machine. Walks are
//! computed in single precision as long as that displaces no point by more than 1/64 pixel, by a bound for maps
//! that contract or else by an estimate along a walk; otherwise in double precision.

mod alias;
mod course;
mod depth;
mod few;
mod histogram;
mod lookup;
mod points;
mod random;
mod raster;
mod real;
mod sampler;
mod solids;
mod system;
mod tally;
mod walked;
mod walkers;

pub use depth::{DepthPicture, DepthWindow, Seen, play_in_space};
pub use histogram::{Histogram, HistogramWindow};
pub use points::{RandomPoint, RandomPoints};
pub use system::{SystemError, WeightedMaps};
pub use walked::{ChaosMap, SetSampler};

use std::num::NonZero;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::geometry::{DAffine2, DVec2, Point};
use crate::grow::Progress;
use crate::ifs::PointOf;
use crate::parallel::{all_cores, map};

use self::course::Course;
use self::histogram::Counts;
use self::tally::{Cancelled, Counter, Tally};

/// Start of walks.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Start<P = DVec2> {
    /// On the attractor, and spread over it: all points that are counted lie on it.
    #[default]
    Attractor,
    /// At given points, in turn. The points that a walker passes on its way to the attractor are counted,
    /// except the start itself (Demko, Hodges & Naylor 1985, figure 4.5).
    Points {
        /// Points at which walks start; if empty, walks start on the attractor.
        points: Vec<P>,
        /// Number of steps of a walk. The fewer, the larger is the fraction of points on the way to the
        /// attractor.
        steps: NonZero<u32>,
    },
}

impl<P: Point> Start<P> {
    /// Returns the start of a walk, or `None` if walks start on the attractor.
    fn walk(&self, number: u64) -> Option<P> {
        let Self::Points { points, .. } = self else {
            return None;
        };
        let turn = number.checked_rem(points.len() as u64)?;
        points.get(usize::try_from(turn).ok()?).copied()
    }
}

/// Classification of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ClassBy {
    /// No distinction: one class.
    #[default]
    One,
    /// By the map that was applied some steps ago, one class per map. The last map, 0 steps ago, determines
    /// in which of the tiles f_i(A) of the attractor A a point lies; the one before, in which of the
    /// f_j(f_i(A)) within its tile; and so on. The map that an approximant of n steps applies first is the
    /// one n − 1 steps ago. A walk with fewer steps counts as having applied its first map before.
    Map {
        /// Number of steps ago.
        ago: u8,
    },
}

/// Parameters of a chaos game.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Game<'a, P = DVec2> {
    /// Number of points; by default ten million.
    pub points: u64,
    /// Seed of the random choices; by default 0.
    pub seed: u64,
    /// Start of walks; by default on the attractor.
    pub start: Start<P>,
    /// Classification of points; by default one class.
    pub classes: ClassBy,
    /// Number of threads; by default that of the machine's cores. The result does not depend on it.
    pub threads: NonZero<usize>,
    /// Flag that ends the game soon after it is set.
    pub cancel: Option<&'a AtomicBool>,
    /// Progress of the game, in points.
    pub progress: Option<&'a Progress>,
}

setters!(Game<'a, P> {
    points: u64,
    seed: u64,
    start: Start<P>,
    classes: ClassBy,
    threads: NonZero<usize>,
    cancel: Option<&'a AtomicBool>,
    progress: Option<&'a Progress>,
});

impl<P> Default for Game<'_, P> {
    fn default() -> Self {
        Self {
            points: 10_000_000,
            seed: 0,
            start: Start::Attractor,
            classes: ClassBy::default(),
            threads: all_cores(),
            cancel: None,
            progress: None,
        }
    }
}

/// Reason why a game has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GameError {
    /// The histogram is larger than the limit of memory.
    #[error(
        "{0} x {1} pixels take more than {most} counters, with one for each class ({classes})",
        size[0], size[1], most = MAX_BINS
    )]
    TooManyBins {
        /// Width and height in pixels.
        size: [u32; 2],
        /// Number of classes.
        classes: usize,
    },
    /// The window has no pixel, more than 2²² on a side, or a map without a finite inverse.
    #[error("the window is empty or flat, or what it shows is too large or too small for numbers")]
    Window,
    /// A start is not finite.
    #[error("start {start} is not finite")]
    Start {
        /// Index of the start, from 0.
        start: usize,
    },
    /// The game was cancelled.
    #[error("interrupted")]
    Cancelled,
}

/// Maximum number of counters, without those for points outside: one gibibyte per thread.
const MAX_BINS: u64 = 1 << 28;

/// Maximum number of counters of all threads together.
const MAX_BINS_OF_THREADS: u64 = 1 << 29;

/// Maximum side of a window.
const MAX_PIXELS: u32 = 1 << 22;

/// Plays the chaos game.
///
/// # Errors
///
/// Returns an error if the window, its map, the histogram or a start is out of range, or if the game is
/// cancelled.
pub fn play(
    system: &WeightedMaps,
    window: &HistogramWindow,
    game: &Game<'_>,
) -> Result<Histogram, GameError> {
    check(window.size, &window.to_pixels, game)?;
    let classes = match game.classes {
        ClassBy::One => 1,
        ClassBy::Map { .. } => system.classes(),
    };
    let size @ [width, height] = window.size;
    let pixels = u64::from(width) * u64::from(height);
    if pixels.saturating_mul(classes as u64) > MAX_BINS {
        return Err(GameError::TooManyBins { size, classes });
    }
    if let Some(progress) = game.progress {
        progress.expect(game.points);
    }
    // Every class has a bin for points outside.
    let bins = (width as usize * height as usize + 1) * classes;
    let play = |isometry: DAffine2, game: &Game<'_>| {
        let course = Course::new(system, window.to_pixels * isometry, 1.0, game);
        let fresh = || Counts(vec![0; bins]);
        count(&course, game, bins, &fresh, |wave, tally| {
            raster::walk(&course, size, wave, tally)
        })
    };
    let (first, others) = match system.images() {
        [] => (DAffine2::IDENTITY, &[][..]),
        [first, others @ ..] => (*first, others),
    };
    let order = others.len() as u64 + 1;
    // The first images have the points that are left over.
    let share = |image: u64| Game {
        points: game.points / order + u64::from(image < game.points % order),
        ..game.clone()
    };
    let mut counts = play(first, &share(0))?;
    for (&isometry, image) in others.iter().zip(1..) {
        counts.merge(play(isometry, &share(image))?);
    }
    Ok(Histogram::new(size, classes, game.points, counts.0))
}

/// Walks all waves of a game; `walk` walks one. `bins` is the number of counters of a thread.
fn count<M: ChaosMap, C: Counter>(
    course: &Course<'_, M>,
    game: &Game<'_, PointOf<M>>,
    bins: usize,
    fresh: &(dyn Fn() -> C + Sync),
    walk: impl Fn(u64, &mut Tally<'_, C>) -> Result<(), Cancelled> + Sync,
) -> Result<C, GameError> {
    let all = Mutex::new(None);
    let next = AtomicU64::new(0);
    let walk = || {
        let mut tally = Tally::new(fresh, &all, game.progress, game.cancel);
        loop {
            let wave = next.fetch_add(1, Ordering::Relaxed);
            if wave >= course.waves() {
                tally.finish();
                return Ok(());
            }
            walk(wave, &mut tally)?;
        }
    };
    let threads = (game.threads.get() as u64)
        .min(MAX_BINS_OF_THREADS / bins as u64)
        .min(course.waves())
        .max(1);
    let threads = usize::try_from(threads).unwrap_or(1);
    let walked = map(&vec![(); threads], threads, |_, ()| walk());
    let walked: Result<(), Cancelled> = walked.into_iter().collect();
    walked.map_err(|Cancelled| GameError::Cancelled)?;
    let all = all.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(all.unwrap_or_else(fresh))
}

fn check<M: ChaosMap>(
    size: [u32; 2],
    to_window: &M,
    game: &Game<'_, PointOf<M>>,
) -> Result<(), GameError> {
    let sides = 1..=MAX_PIXELS;
    if !size.iter().all(|side| sides.contains(side)) || !to_window.inverted().is_finite() {
        return Err(GameError::Window);
    }
    if let Start::Points { points, .. } = &game.start
        && let Some(start) = points.iter().position(|point| !point.is_finite())
    {
        return Err(GameError::Start { start });
    }
    Ok(())
}

/// Largest number of points that can be requested.
const MAX_POINTS: u64 = 1_000_000_000_000;

/// Parses a number of points with an optional suffix k, M or G: `500k`, `10M`.
///
/// # Errors
///
/// Returns a message if the text is no whole number from 1 to 10¹².
pub fn points_of_text(text: &str) -> Result<u64, String> {
    let (number, factor) = match text.char_indices().next_back() {
        Some((end, 'k')) => (&text[..end], 1e3),
        Some((end, 'M')) => (&text[..end], 1e6),
        Some((end, 'G')) => (&text[..end], 1e9),
        _ => (text, 1.0),
    };
    let points = number.parse::<f64>().map(|number| number * factor);
    match points {
        #[expect(clippy::cast_precision_loss, reason = "the limit is exact")]
        Ok(points) if points > MAX_POINTS as f64 && points.is_finite() => {
            Err("too many points: the limit is 1000G".into())
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number within the limit"
        )]
        Ok(points) if points >= 1.0 && points.fract() == 0.0 => Ok(points as u64),
        _ => Err("a number of points is a whole number from 1, such as 500k, 10M or 2G".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DMat2;
    use crate::ifs::{Definition, Edge, Ifs, Map};

    /// The fern: steep, slow to contract, and with maps of all kinds.
    fn fern() -> WeightedMaps {
        let table = [
            [0.0, 0.0, 0.0, 0.16, 0.0, 0.0, 0.01],
            [0.85, 0.04, -0.04, 0.85, 0.0, 1.6, 0.85],
            [0.2, -0.26, 0.23, 0.22, 0.0, 1.6, 0.07],
            [-0.15, 0.28, 0.26, 0.24, 0.0, 0.44, 0.07],
        ];
        let maps = table.map(|[a, b, c, d, e, f, weight]| {
            Map::new(DAffine2::from_cols_array(&[a, c, b, d, e, f])).weighing(weight)
        });
        let definition = Definition {
            maps: maps.into(),
            ..Definition::default()
        };
        WeightedMaps::of(&Ifs::new(definition).unwrap()).unwrap()
    }

    fn window(side: u32, scale: f64) -> HistogramWindow {
        let matrix = DMat2::from_diagonal(DVec2::new(scale, -scale));
        HistogramWindow {
            to_pixels: DAffine2::from_mat2_translation(matrix, DVec2::new(5.1, 10.1) * scale),
            size: [side; 2],
        }
    }

    /// Counts one wave, in single or in double precision.
    fn counts(window: &HistogramWindow, classes: ClassBy, is_double: bool) -> Vec<u32> {
        let (system, all) = (fern(), Mutex::new(None));
        let game = Game {
            points: 400_000,
            classes,
            ..Game::default()
        };
        let mut course = Course::new(&system, window.to_pixels, 1.0, &game);
        course.is_double = is_double;
        let [width, height] = window.size;
        let bins = 4 * (width * height + 1) as usize;
        let fresh = || Counts(vec![0; bins]);
        let mut tally = Tally::new(&fresh, &all, None, None);
        raster::walk(&course, window.size, 0, &mut tally).unwrap();
        tally.finish();
        all.into_inner().unwrap().unwrap().0
    }

    /// In the same walk few points differ in their pixel: those within the error of an edge.
    #[test]
    fn single_precision_is_enough_where_it_is_used() {
        for (side, most) in [(256, 0.000_5), (1024, 0.002)] {
            let window = window(side, f64::from(side) / 10.2);
            let classes = ClassBy::One;
            let game = Game::default();
            assert!(!Course::new(&fern(), window.to_pixels, 1.0, &game).is_double);
            let [single, double] = [false, true].map(|double| counts(&window, classes, double));
            let differ: u64 = single
                .iter()
                .zip(&double)
                .map(|(a, b)| u64::from(a.abs_diff(*b)))
                .sum();
            assert!(differ as f64 / 800_000.0 < most, "{side}: {differ}");
        }
    }

    #[test]
    fn double_precision_is_taken_where_it_matters() {
        for (side, scale, is_double) in [
            (1024, 100.0, false),
            (4096, 400.0, false),
            (8192, 800.0, false),
            (16_384, 1600.0, true),
            // A small part, much enlarged.
            (512, 1e5, true),
        ] {
            let window = window(side, scale);
            let game = Game::default();
            let course_is_double = Course::new(&fern(), window.to_pixels, 1.0, &game).is_double;
            assert_eq!(course_is_double, is_double, "{side}");
        }
    }

    /// Maps that alternate, of which only one enlarges the error.
    #[test]
    fn errors_of_every_other_step_are_seen() {
        let map = |scale: f64, shift: f64| {
            let matrix = DMat2::from_diagonal(DVec2::splat(scale));
            Map::new(DAffine2::from_mat2_translation(matrix, DVec2::splat(shift)))
        };
        let edge = |from, to| Edge {
            from,
            to,
            weight: None,
        };
        let definition = Definition {
            maps: vec![map(1e4, 300.0), map(1e-5, 500.0)],
            edges: Some(vec![edge(0, 1), edge(1, 0)]),
            ..Definition::default()
        };
        let system = WeightedMaps::of(&Ifs::new(definition).unwrap()).unwrap();
        let game = Game::default();
        assert!(Course::new(&system, DAffine2::IDENTITY, 1.0, &game).is_double);
    }

    /// Applying all maps and selecting one gives the same measure as looking maps up.
    #[test]
    fn both_ways_to_walk_have_one_measure() {
        let window = window(16, 1.6);
        let few = counts(&window, ClassBy::One, false);
        let by_map = counts(&window, ClassBy::Map { ago: 0 }, false);
        let classes: Vec<_> = by_map.chunks_exact(16 * 16 + 1).collect();
        for pixel in 0..256 {
            let any: u32 = classes.iter().map(|counts| counts[pixel]).sum();
            let expected = f64::from(few[pixel]);
            // Both counts vary, and points come in runs.
            let error = 16.0 * (expected + 10.0).sqrt();
            assert!(
                (f64::from(any) - expected).abs() < error,
                "{pixel} {any} {expected}"
            );
        }
    }

    #[test]
    fn points_are_counted_in_thousands_millions_and_milliards() {
        for (text, number) in [
            ("1", 1),
            ("500k", 500_000),
            ("2.5M", 2_500_000),
            ("1e7", 10_000_000),
            ("1000G", MAX_POINTS),
        ] {
            assert_eq!(points_of_text(text), Ok(number), "{text}");
        }
        for text in [
            "", "0", "-1", "0.5", "k", "M", "10m", "NaN", "inf", "1001G", "1é",
        ] {
            assert!(points_of_text(text).is_err(), "{text}");
        }
    }
}
