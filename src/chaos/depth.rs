//! The chaos game in space: a picture of the nearest points.

use crate::geometry::{DAffine3, DVec3, HalfSpace};

use super::course::Course;
use super::few::Few;
use super::lookup::{self, LookUp};
use super::random::LANES;
use super::real::Real;
use super::tally::{Cancelled, Counter, Tally};
use super::walkers::{Any, Screen, run};
use super::{ClassBy, Game, GameError, MAX_BINS, WeightedMaps, check, count};

/// A view of space, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthWindow<'a> {
    /// Map from space to the coordinates of the view: x to the right, y down, z towards the viewer.
    pub to_window: DAffine3,
    /// Projection of the coordinates of the view to pixels.
    pub seen: Seen,
    /// Least and greatest z of what is shown: the far and the near end.
    pub range: [f64; 2],
    /// Number of steps of depth between both ends, less than 2²².
    pub steps: u32,
    /// Width and height in pixels, 1 to 2²² each.
    pub size: [u32; 2],
    /// Half-spaces in the coordinates of the view, within all of which points are shown.
    pub within: &'a [HalfSpace],
}

/// Projection of the coordinates of a view to pixels, from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// x and y are pixels already.
    Parallel,
    /// A point is seen at `middle` + `focus` · (x, y) / −z, if z is negative.
    Central {
        /// Pixels a unit at distance 1.
        focus: f64,
        /// Pixel of the axis of view.
        middle: [f64; 2],
    },
}

impl DepthWindow<'_> {
    /// Returns the largest number of pixels a unit of the view.
    fn scale(&self) -> f64 {
        match self.seen {
            Seen::Parallel => 1.0,
            Seen::Central { focus, .. } if self.range[1] < 0.0 => focus / -self.range[1],
            Seen::Central { .. } => f64::INFINITY,
        }
    }
}

/// The nearest point of walks in each pixel of a view, and the number of points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DepthPicture {
    size: [u32; 2],
    points: u64,
    nearest: Nearest,
}

impl DepthPicture {
    /// Number of bits of a key below the depth.
    pub const CLASS_BITS: u32 = 10;
    /// Key of a pixel without points.
    pub const EMPTY: u32 = u32::MAX;

    /// Returns the width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the number of points, including those outside.
    #[must_use]
    pub fn points(&self) -> u64 {
        self.points
    }

    /// Returns the keys of the pixels, row by row from the upper left corner: the depth of the nearest point in steps
    /// from the near end, and in the low [`CLASS_BITS`](Self::CLASS_BITS) its class, the smallest of points that are
    /// equally near; [`EMPTY`](Self::EMPTY) where there is no point.
    #[must_use]
    pub fn keys(&self) -> &[u32] {
        let keys = &self.nearest.keys;
        &keys[..keys.len() - 1]
    }

    /// Returns the [keys](Self::keys) and the [hits](Self::hits).
    #[must_use]
    pub fn into_keys_and_hits(self) -> (Vec<u32>, Vec<u32>) {
        let Nearest { mut keys, mut hits } = self.nearest;
        keys.pop();
        hits.pop();
        (keys, hits)
    }

    /// Returns the number of points of every pixel, at any depth; empty if they were not counted. Counts saturate at
    /// 2³² − 1.
    #[must_use]
    pub fn hits(&self) -> &[u32] {
        let hits = &self.nearest.hits;
        &hits[..hits.len().saturating_sub(1)]
    }
}

/// Plays the chaos game in space. If it `counts` hits, the points of every pixel are counted too.
///
/// # Errors
///
/// Returns an error if the window, its map or a start is out of range, or if the game is cancelled.
pub fn play_in_space(
    system: &WeightedMaps<DAffine3>,
    window: &DepthWindow<'_>,
    counts: bool,
    game: &Game<'_, DVec3>,
) -> Result<DepthPicture, GameError> {
    check(window.size, &window.to_window, game)?;
    let size @ [width, height] = window.size;
    let pixels = u64::from(width) * u64::from(height);
    if pixels > MAX_BINS {
        return Err(GameError::TooManyBins { size, classes: 1 });
    }
    let course = Course::new(system, window.to_window, window.scale(), game);
    // The last one is for points outside.
    let bins = width as usize * height as usize + 1;
    let fresh = || Nearest::new(bins, counts);
    if let Some(progress) = game.progress {
        progress.expect(game.points);
    }
    let nearest = count(&course, game, bins, &fresh, |wave, tally| {
        if course.is_double {
            walk_double(&course, window, wave, tally)
        } else {
            walk_single(&course, window, wave, tally)
        }
    })?;
    Ok(DepthPicture {
        size,
        points: game.points,
        nearest,
    })
}

/// Keys and counters of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Nearest {
    pub(super) keys: Vec<u32>,
    /// Empty if hits are not counted.
    pub(super) hits: Vec<u32>,
}

impl Nearest {
    /// Creates empty pixels; if it `counts` hits, with counters.
    pub(super) fn new(bins: usize, counts: bool) -> Self {
        Self {
            keys: vec![DepthPicture::EMPTY; bins],
            hits: if counts { vec![0; bins] } else { Vec::new() },
        }
    }
}

/// Pixel and key of a point.
#[derive(Clone, Copy, Default)]
pub(super) struct Spot {
    pixel: u32,
    key: u32,
}

impl Counter for Nearest {
    type Spot = Spot;

    #[inline(always)]
    fn add(&mut self, spots: &[Spot]) {
        for spot in spots {
            // A branch would be mispredicted while a picture fills.
            if let Some(key) = self.keys.get_mut(spot.pixel as usize) {
                *key = spot.key.min(*key);
            }
        }
        if !self.hits.is_empty() {
            for spot in spots {
                if let Some(hits) = self.hits.get_mut(spot.pixel as usize) {
                    *hits += 1;
                }
            }
        }
    }

    fn merge(&mut self, other: Self) {
        for (all, key) in self.keys.iter_mut().zip(other.keys) {
            *all = (*all).min(key);
        }
        for (all, hits) in self.hits.iter_mut().zip(other.hits) {
            *all = all.saturating_add(hits);
        }
    }
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
pub(super) fn walk_single(
    course: &Course<'_, DAffine3>,
    window: &DepthWindow<'_>,
    wave: u64,
    tally: &mut Tally<'_, Nearest>,
) -> Result<(), Cancelled> {
    #[cfg(all(feature = "simd", target_arch = "x86_64"))]
    multiversion::target::match_target! {
        "x86_64+avx512f" => {
            let look_up = |table: &_, places: &_| lookup::by_permutation(table, places);
            return walk_in::<f32, true>(course, window, wave, tally, look_up);
        }
        _ => {}
    }
    #[allow(unreachable_code, reason = "of processors with AVX-512")]
    walk_in::<f32, false>(course, window, wave, tally, lookup::one_by_one)
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
pub(super) fn walk_double(
    course: &Course<'_, DAffine3>,
    window: &DepthWindow<'_>,
    wave: u64,
    tally: &mut Tally<'_, Nearest>,
) -> Result<(), Cancelled> {
    walk_in::<f64, false>(course, window, wave, tally, lookup::one_by_one)
}

/// Walks a wave in one precision; looking up is `FAST` if it takes less time than walks by arbitrary maps do.
#[inline(always)]
fn walk_in<T: Real, const FAST: bool>(
    course: &Course<'_, DAffine3>,
    window: &DepthWindow<'_>,
    wave: u64,
    tally: &mut Tally<'_, Nearest>,
    look_up: impl LookUp,
) -> Result<(), Cancelled> {
    let is_free = !course.system.is_recurrent()
        && course.maps.iter().all(Option::is_some)
        && matches!(course.classes, ClassBy::One | ClassBy::Map { ago: 0 });
    let cuts = cuts_of::<T>(window);
    let lens = Lens::new(window, &cuts);
    if is_free && let Some(mut few) = Few::<_, _, true>::new(course, lens, look_up) {
        run(course, wave, &mut few, tally)
    } else if is_free
        && FAST
        && let Some(mut few) = Few::<_, _, false>::new(course, lens, look_up)
    {
        run(course, wave, &mut few, tally)
    } else if is_free {
        let mut any = Any::<_, _, true>::new(course, wave, lens);
        run(course, wave, &mut any, tally)
    } else {
        let mut any = Any::<_, _, false>::new(course, wave, lens);
        run(course, wave, &mut any, tally)
    }
}

/// Returns the normals and distances of the half-spaces of a window.
pub(super) fn cuts_of<T: Real>(window: &DepthWindow<'_>) -> Vec<[T; 4]> {
    let cuts = window.within.iter().map(|cut| {
        let [x, y, z] = cut.normal.to_array();
        [x, y, z, cut.distance].map(T::of)
    });
    cuts.collect()
}

/// An affine map: its columns, each completed by a zero.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(super) struct Affine3<T>([[T; 4]; 4]);

/// The pixels and depths of a view.
#[derive(Clone, Copy)]
pub(super) struct Lens<'a, T> {
    /// Normals and distances of half-spaces.
    cuts: &'a [[T; 4]],
    size: [T; 2],
    /// Number of pixels in a row, and of all pixels.
    row: u32,
    all: u32,
    near: T,
    /// Steps of depth a unit, and their number.
    steep: T,
    steps: T,
    /// Focus and middle of a central projection.
    central: Option<(T, [T; 2])>,
}

impl<'a, T: Real> Lens<'a, T> {
    pub(super) fn new(window: &DepthWindow<'_>, cuts: &'a [[T; 4]]) -> Self {
        let [width, height] = window.size;
        let [far, near] = window.range;
        let range = near - far;
        let steps = f64::from(window.steps);
        Self {
            cuts,
            size: window.size.map(|side| T::of(side.into())),
            row: width,
            all: width * height,
            near: T::of(near),
            steep: T::of(if range > 0.0 { steps / range } else { 0.0 }),
            steps: T::of(steps),
            central: match window.seen {
                Seen::Parallel => None,
                Seen::Central { focus, middle } => Some((T::of(focus), middle.map(T::of))),
            },
        }
    }

    /// Returns the pixels and the depths of points in pixels. Every line is for all lanes at once, so that it can be
    /// vectorised.
    #[inline(always)]
    fn pixels_and_depths(&self, [x, y, z]: &[[T; LANES]; 3]) -> [[u32; LANES]; 2] {
        let [width, height] = self.size;
        let mut pixels = [0; LANES];
        for lane in 0..LANES {
            let (x, y) = (x[lane], y[lane]);
            let is_inside = (x >= T::ZERO) & (x < width) & (y >= T::ZERO) & (y < height);
            let x = if is_inside { x } else { T::ZERO };
            let y = if is_inside { y } else { T::ZERO };
            let pixel = y.floor().wrapping_mul(self.row).wrapping_add(x.floor());
            pixels[lane] = if is_inside { pixel } else { self.all };
        }
        let mut depths = [0; LANES];
        for lane in 0..LANES {
            let depth = (self.near - z[lane]) * self.steep;
            let depth = if depth > T::ZERO { depth } else { T::ZERO };
            let depth = if depth < self.steps {
                depth
            } else {
                self.steps
            };
            depths[lane] = depth.floor();
        }
        [pixels, depths]
    }
}

impl<T: Real> Screen<DAffine3> for Lens<'_, T> {
    type Counter = Nearest;
    type Matrix = Affine3<T>;
    /// Coordinates, each completed by a zero.
    type Places = [[T; 4]; LANES];

    fn matrix(map: &DAffine3) -> Affine3<T> {
        let linear = &map.matrix3;
        let columns = [linear.x_axis, linear.y_axis, linear.z_axis, map.translation];
        Affine3(columns.map(|column| completed(column)))
    }

    fn places() -> Self::Places {
        [[T::ZERO; 4]; LANES]
    }

    fn put(places: &mut Self::Places, lane: usize, point: DVec3) {
        places[lane] = completed(point);
    }

    #[inline(always)]
    fn advance(places: &mut Self::Places, lane: usize, Affine3(columns): &Affine3<T>) {
        let [x, y, z, _] = places[lane];
        places[lane] = std::array::from_fn(|row| {
            columns[0][row] * x + columns[1][row] * y + columns[2][row] * z + columns[3][row]
        });
    }

    #[inline(always)]
    fn spots(&self, places: &Self::Places, classes: &[u32; LANES], spots: &mut [Spot; LANES]) {
        let mut seen = [[T::ZERO; LANES]; 3];
        for lane in 0..LANES {
            for axis in 0..3 {
                seen[axis][lane] = places[lane][axis];
            }
        }
        self.see(seen, classes, spots);
    }
}

impl<T: Real> Lens<'_, T> {
    /// Stores the pixels and the keys of points, which are given by their coordinates.
    #[inline(always)]
    pub(super) fn see(
        &self,
        mut seen: [[T; LANES]; 3],
        classes: &[u32; LANES],
        spots: &mut [Spot; LANES],
    ) {
        const MOST: u32 = (1 << DepthPicture::CLASS_BITS) - 1;
        let mut is_cut_off = [false; LANES];
        for [across, down, towards, distance] in self.cuts {
            let [x, y, z] = &seen;
            for lane in 0..LANES {
                let along = *across * x[lane] + *down * y[lane] + *towards * z[lane];
                is_cut_off[lane] |= along > *distance;
            }
        }
        if let Some((focus, middle)) = self.central {
            let [x, y, z] = &mut seen;
            for lane in 0..LANES {
                // Nothing behind the viewer is seen: there, the scale is negative.
                let scale = focus / (T::ZERO - z[lane]);
                let is_ahead = scale > T::ZERO;
                let at = middle[0] + x[lane] * scale;
                x[lane] = if is_ahead { at } else { T::ZERO - T::WHOLE };
                y[lane] = middle[1] + y[lane] * scale;
            }
        }
        let [mut pixels, depths] = self.pixels_and_depths(&seen);
        if !self.cuts.is_empty() {
            for lane in 0..LANES {
                pixels[lane] = if is_cut_off[lane] {
                    self.all
                } else {
                    pixels[lane]
                };
            }
        }
        for lane in 0..LANES {
            spots[lane] = Spot {
                pixel: pixels[lane],
                key: depths[lane] << DepthPicture::CLASS_BITS | classes[lane].min(MOST),
            };
        }
    }
}

fn completed<T: Real>(vector: DVec3) -> [T; 4] {
    [T::of(vector.x), T::of(vector.y), T::of(vector.z), T::ZERO]
}
