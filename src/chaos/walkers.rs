//! The inner loop: walkers side by side, a step at a time.
//!
//! A block of steps is walked before its points are counted: counters are stored to at random, and a
//! processor that meets such stores between the walkers' own loads and stores has to wait.

use crate::geometry::DAffine2;

use super::ClassBy;
use super::alias::AliasTable;
use super::course::Course;
use super::random::{LANES, Lanes, Scalar};
use super::real::Real;
use super::sampler::Sampler;
use super::system::{Map, WeightedMaps};
use super::tally::{Cancelled, Tally};

/// Steps that are walked before they are counted.
const STEPS: usize = 64;

/// The points of a block of steps, as bins of the histogram.
pub(super) type Bins = [[u32; LANES]; STEPS];

/// Walks a wave, in single or double precision.
pub(super) fn walk(course: &Course<'_>, wave: u64, tally: &mut Tally<'_>) -> Result<(), Cancelled> {
    if course.is_double {
        walk_double(course, wave, tally)
    } else {
        walk_single(course, wave, tally)
    }
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets("x86_64+avx2")))]
fn walk_single(course: &Course<'_>, wave: u64, tally: &mut Tally<'_>) -> Result<(), Cancelled> {
    walk_in::<f32>(course, wave, tally)
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets("x86_64+avx2")))]
fn walk_double(course: &Course<'_>, wave: u64, tally: &mut Tally<'_>) -> Result<(), Cancelled> {
    walk_in::<f64>(course, wave, tally)
}

#[inline(always)]
fn walk_in<T: Real>(
    course: &Course<'_>,
    wave: u64,
    tally: &mut Tally<'_>,
) -> Result<(), Cancelled> {
    let maps = course.maps.iter().copied().collect::<Option<Vec<_>>>();
    let is_free = !course.system.is_recurrent();
    match (maps, course.classes) {
        (Some(maps), ClassBy::One) if is_free && maps.len() <= MOST => {
            walk_few::<T, false>(course, wave, maps.len(), tally)
        }
        (Some(maps), ClassBy::Map { ago: 0 }) if is_free && maps.len() <= MOST => {
            walk_few::<T, true>(course, wave, maps.len(), tally)
        }
        _ => run(course, wave, &mut Any::<T>::new(course, wave), tally),
    }
}

/// Maximum number of maps for which all are applied; for more, a look-up is faster.
const MOST: usize = 16;

#[inline(always)]
fn walk_few<T: Real, const BY_LAST: bool>(
    course: &Course<'_>,
    wave: u64,
    maps: usize,
    tally: &mut Tally<'_>,
) -> Result<(), Cancelled> {
    match maps {
        ..=2 => run(course, wave, &mut Few::<T, BY_LAST, 2>::new(course), tally),
        3 => run(course, wave, &mut Few::<T, BY_LAST, 3>::new(course), tally),
        4 => run(course, wave, &mut Few::<T, BY_LAST, 4>::new(course), tally),
        5..=6 => run(course, wave, &mut Few::<T, BY_LAST, 6>::new(course), tally),
        7..=8 => run(course, wave, &mut Few::<T, BY_LAST, 8>::new(course), tally),
        _ => run(
            course,
            wave,
            &mut Few::<T, BY_LAST, MOST>::new(course),
            tally,
        ),
    }
}

/// Positions of walkers, in pixels.
struct Places<T> {
    x: [T; LANES],
    y: [T; LANES],
}

/// Method by which walkers take a step.
trait Walk<T: Real> {
    /// Moves every walker by the map that its random word chooses, and stores the bins of the new positions.
    fn step(&mut self, words: &[u32; LANES], places: &mut Places<T>, bins: &mut [u32; LANES]);
}

#[inline(always)]
fn run<T: Real>(
    course: &Course<'_>,
    wave: u64,
    walk: &mut impl Walk<T>,
    tally: &mut Tally<'_>,
) -> Result<(), Cancelled> {
    let mut places = Places {
        x: [T::ZERO; LANES],
        y: [T::ZERO; LANES],
    };
    for lane in 0..LANES {
        let (point, _) = course.start(wave, lane);
        (places.x[lane], places.y[lane]) = (T::of(point.x), T::of(point.y));
    }
    let mut lanes = Lanes::new(course.seed, wave);
    let mut words = [0; LANES];
    let mut bins: Bins = [[0; LANES]; STEPS];
    for _ in 0..course.warm_up() {
        lanes.draw(&mut words);
        walk.step(&words, &mut places, &mut bins[0]);
    }
    let mut left = course.points_of(wave);
    while left > 0 {
        for bins in &mut bins {
            lanes.draw(&mut words);
            walk.step(&words, &mut places, bins);
        }
        left -= tally.add(&bins, left)?;
    }
    Ok(())
}

/// The pixels of the window.
#[derive(Clone, Copy)]
struct Raster<T> {
    width: T,
    height: T,
    /// Number of pixels in a row, and of all pixels.
    row: u32,
    all: u32,
}

impl<T: Real> Raster<T> {
    fn new(course: &Course<'_>) -> Self {
        let [width, height] = course.window.size;
        Self {
            width: T::of(width.into()),
            height: T::of(height.into()),
            row: width,
            all: width * height,
        }
    }

    /// Returns the bin of a position: its pixel, or the bin for points outside.
    #[inline(always)]
    fn bin(&self, x: T, y: T) -> u32 {
        let is_inside = (x >= T::ZERO) & (x < self.width) & (y >= T::ZERO) & (y < self.height);
        let x = if is_inside { x } else { T::ZERO };
        let y = if is_inside { y } else { T::ZERO };
        let pixel = y.floor().wrapping_mul(self.row).wrapping_add(x.floor());
        if is_inside { pixel } else { self.all }
    }
}

/// The coefficients of an affine map.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Affine<T> {
    a: T,
    b: T,
    c: T,
    d: T,
    e: T,
    f: T,
}

impl<T: Real> Affine<T> {
    fn of(map: &DAffine2) -> Self {
        let [a, c, b, d, e, f] = map.to_cols_array().map(T::of);
        Self { a, b, c, d, e, f }
    }

    #[inline(always)]
    fn apply(&self, x: T, y: T) -> [T; 2] {
        [
            self.a * x + self.b * y + self.e,
            self.c * x + self.d * y + self.f,
        ]
    }
}

/// A few affine maps, any of which may follow: all are applied, and one result is selected.
struct Few<T, const BY_LAST: bool, const N: usize> {
    raster: Raster<T>,
    maps: [Affine<T>; N],
    /// First bin of the class of each map, if classes are distinguished by the last map.
    classes: [u32; N],
    /// A map is selected if the word is not below its own threshold, but below the next one's.
    thresholds: [u32; N],
}

impl<T: Real, const BY_LAST: bool, const N: usize> Few<T, BY_LAST, N> {
    fn new(course: &Course<'_>) -> Self {
        let weights = course.system.probabilities();
        let total: f64 = weights.iter().sum();
        let mut classes = [0; N];
        let mut below = 0.0;
        let mut thresholds = [0; N];
        let mut maps = [Affine::of(&DAffine2::IDENTITY); N];
        for place in 0..N {
            // Where there are fewer maps, the last one is repeated.
            let map = place.min(weights.len() - 1);
            if let Some(affine) = &course.maps[map] {
                maps[place] = Affine::of(affine);
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "few maps, and a part of all words; casts saturate"
            )]
            {
                classes[place] = map as u32 * course.stride;
                thresholds[place] = (below / total * 2f64.powi(32)) as u32;
            }
            below += weights.get(place).unwrap_or(&0.0);
        }
        Self {
            raster: Raster::new(course),
            maps,
            classes,
            thresholds,
        }
    }
}

impl<T: Real, const BY_LAST: bool, const N: usize> Walk<T> for Few<T, BY_LAST, N> {
    #[inline(always)]
    fn step(&mut self, words: &[u32; LANES], places: &mut Places<T>, bins: &mut [u32; LANES]) {
        let Self {
            raster,
            maps,
            classes,
            thresholds,
        } = *self;
        for lane in 0..LANES {
            let (x, y, word) = (places.x[lane], places.y[lane], words[lane]);
            let [mut next_x, mut next_y] = maps[0].apply(x, y);
            let mut class = 0;
            for place in 1..N {
                let [new_x, new_y] = maps[place].apply(x, y);
                let is_taken = word >= thresholds[place];
                next_x = if is_taken { new_x } else { next_x };
                next_y = if is_taken { new_y } else { next_y };
                if BY_LAST {
                    class = if is_taken { classes[place] } else { class };
                }
            }
            places.x[lane] = next_x;
            places.y[lane] = next_y;
            let bin = raster.bin(next_x, next_y);
            bins[lane] = if BY_LAST {
                bin.wrapping_add(class)
            } else {
                bin
            };
        }
    }
}

/// Arbitrary systems, whose maps are looked up.
struct Any<'a, T> {
    raster: Raster<T>,
    system: &'a WeightedMaps,
    choice: &'a AliasTable,
    maps: Vec<Affine<T>>,
    /// Condensation sets, by map.
    shapes: Vec<Option<&'a Sampler>>,
    to_pixels: DAffine2,
    random: Scalar,
    /// Previous map of each walker.
    last: [u32; LANES],
    past: Past,
    /// Number of bins of a class; 0 if there is one class only.
    stride: u32,
}

impl<'a, T: Real> Any<'a, T> {
    fn new(course: &'a Course<'_>, wave: u64) -> Self {
        let identity = DAffine2::IDENTITY;
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
        let (ago, stride) = match course.classes {
            ClassBy::One => (0, 0),
            ClassBy::Map { ago } => (ago, course.stride),
        };
        Self {
            raster: Raster::new(course),
            system: course.system,
            choice: &course.choice,
            maps: maps
                .map(|map| Affine::of(map.as_ref().unwrap_or(&identity)))
                .collect(),
            shapes: shapes.collect(),
            to_pixels: course.window.to_pixels,
            random: Scalar::new(course.seed, wave),
            last,
            past: Past::new(ago, last),
            stride,
        }
    }
}

impl<T: Real> Walk<T> for Any<'_, T> {
    #[inline(always)]
    fn step(&mut self, words: &[u32; LANES], places: &mut Places<T>, bins: &mut [u32; LANES]) {
        let now = self.past.advance();
        for (lane, &word) in words.iter().enumerate() {
            let last = self.last[lane] as usize;
            let map = self.choice.choose(self.system.state_after(last), word);
            let [mut x, mut y] = self.maps[map].apply(places.x[lane], places.y[lane]);
            if let Some(shape) = self.shapes[map] {
                let point = self
                    .to_pixels
                    .transform_point2(shape.draw(&mut self.random));
                (x, y) = (T::of(point.x), T::of(point.y));
            }
            (places.x[lane], places.y[lane]) = (x, y);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "there are not so many maps"
            )]
            {
                self.last[lane] = map as u32;
            }
            if last == self.maps.len() {
                self.past.begin(lane, self.last[lane]);
            }
        }
        let class = self.past.add(now, &self.last);
        for lane in 0..LANES {
            let bin = self.raster.bin(places.x[lane], places.y[lane]);
            bins[lane] = bin.wrapping_add(class[lane].wrapping_mul(self.stride));
        }
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
