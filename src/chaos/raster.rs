//! Walkers of the plane, and the pixels that count them.

use crate::geometry::{DAffine2, DVec2};

use super::ClassBy;
use super::course::Course;
use super::histogram::Counts;
use super::random::LANES;
use super::real::Real;
use super::tally::{Cancelled, Tally};
use super::walkers::{Any, Screen, Walk, run};

/// Walks a wave, in single or double precision, on a window of a width and a height.
pub(super) fn walk(
    course: &Course<'_, DAffine2>,
    size: [u32; 2],
    wave: u64,
    tally: &mut Tally<'_, Counts>,
) -> Result<(), Cancelled> {
    if course.is_double {
        walk_double(course, size, wave, tally)
    } else {
        walk_single(course, size, wave, tally)
    }
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
fn walk_single(
    course: &Course<'_, DAffine2>,
    size: [u32; 2],
    wave: u64,
    tally: &mut Tally<'_, Counts>,
) -> Result<(), Cancelled> {
    walk_in::<f32>(course, size, wave, tally)
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
fn walk_double(
    course: &Course<'_, DAffine2>,
    size: [u32; 2],
    wave: u64,
    tally: &mut Tally<'_, Counts>,
) -> Result<(), Cancelled> {
    walk_in::<f64>(course, size, wave, tally)
}

#[inline(always)]
fn walk_in<T: Real>(
    course: &Course<'_, DAffine2>,
    size: [u32; 2],
    wave: u64,
    tally: &mut Tally<'_, Counts>,
) -> Result<(), Cancelled> {
    let maps = course.maps.iter().copied().collect::<Option<Vec<_>>>();
    let is_free = !course.system.is_recurrent();
    let raster = Raster::<T>::new(size);
    match (maps, course.classes) {
        (Some(maps), ClassBy::One) if is_free && maps.len() <= MOST => {
            walk_few::<T, false>(course, raster, wave, maps.len(), tally)
        }
        (Some(maps), ClassBy::Map { ago: 0 }) if is_free && maps.len() <= MOST => {
            walk_few::<T, true>(course, raster, wave, maps.len(), tally)
        }
        _ => {
            let mut walk = Any::<_, _, false>::new(course, wave, raster);
            run(course, wave, &mut walk, tally)
        }
    }
}

/// Maximum number of maps for which all are applied; for more, a look-up is faster.
const MOST: usize = 16;

#[inline(always)]
fn walk_few<T: Real, const BY_LAST: bool>(
    course: &Course<'_, DAffine2>,
    raster: Raster<T>,
    wave: u64,
    maps: usize,
    tally: &mut Tally<'_, Counts>,
) -> Result<(), Cancelled> {
    macro_rules! few {
        ($count:expr) => {
            run(
                course,
                wave,
                &mut Few::<T, BY_LAST, $count>::new(course, raster),
                tally,
            )
        };
    }
    match maps {
        ..=2 => few!(2),
        3 => few!(3),
        4 => few!(4),
        5..=6 => few!(6),
        7..=8 => few!(8),
        _ => few!(MOST),
    }
}

/// Positions of walkers, in pixels.
pub(super) struct Places<T> {
    x: [T; LANES],
    y: [T; LANES],
}

/// The pixels of the window.
#[derive(Clone, Copy)]
pub(super) struct Raster<T> {
    width: T,
    height: T,
    /// Number of pixels in a row, and of all pixels.
    row: u32,
    all: u32,
}

impl<T: Real> Raster<T> {
    fn new([width, height]: [u32; 2]) -> Self {
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
pub(super) struct Affine<T> {
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

impl<T: Real> Screen<DAffine2> for Raster<T> {
    type Counter = Counts;
    type Matrix = Affine<T>;
    type Places = Places<T>;

    fn matrix(map: &DAffine2) -> Affine<T> {
        Affine::of(map)
    }

    fn places() -> Places<T> {
        Places {
            x: [T::ZERO; LANES],
            y: [T::ZERO; LANES],
        }
    }

    fn put(places: &mut Places<T>, lane: usize, point: DVec2) {
        (places.x[lane], places.y[lane]) = (T::of(point.x), T::of(point.y));
    }

    #[inline(always)]
    fn advance(places: &mut Places<T>, lane: usize, matrix: &Affine<T>) {
        [places.x[lane], places.y[lane]] = matrix.apply(places.x[lane], places.y[lane]);
    }

    #[inline(always)]
    fn spots(&self, places: &Places<T>, classes: &[u32; LANES], bins: &mut [u32; LANES]) {
        let stride = self.all + 1;
        for lane in 0..LANES {
            let bin = self.bin(places.x[lane], places.y[lane]);
            bins[lane] = bin.wrapping_add(classes[lane].wrapping_mul(stride));
        }
    }
}

/// A few affine maps, any of which may follow: all are applied, and one result is selected.
struct Few<T, const BY_LAST: bool, const N: usize> {
    raster: Raster<T>,
    places: Places<T>,
    maps: [Affine<T>; N],
    /// First bin of the class of each map, if classes are distinguished by the last map.
    classes: [u32; N],
    /// A map is selected if the word is not below its own threshold, but below the next one's.
    thresholds: [u32; N],
}

impl<T: Real, const BY_LAST: bool, const N: usize> Few<T, BY_LAST, N> {
    fn new(course: &Course<'_, DAffine2>, raster: Raster<T>) -> Self {
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
                classes[place] = map as u32 * (raster.all + 1);
                thresholds[place] = (below / total * 2f64.powi(32)) as u32;
            }
            below += weights.get(place).unwrap_or(&0.0);
        }
        Self {
            raster,
            places: Raster::places(),
            maps,
            classes,
            thresholds,
        }
    }
}

impl<T: Real, const BY_LAST: bool, const N: usize> Walk<DAffine2, Counts> for Few<T, BY_LAST, N> {
    fn put(&mut self, lane: usize, point: DVec2) {
        Raster::put(&mut self.places, lane, point);
    }

    #[inline(always)]
    fn step(&mut self, words: &[u32; LANES], bins: &mut [u32; LANES]) {
        let Self {
            raster,
            ref mut places,
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
