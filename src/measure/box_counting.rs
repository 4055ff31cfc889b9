//! Box-counting dimensions of limit sets, pictures and points, with the counts that are their evidence.

use std::num::NonZero;

use crate::bits::Bits;
use crate::geometry::Point;
use crate::saturating::{real, whole};

use super::averaging::averaged;
use super::cover::{Grid, Scale};
use super::extrapolation::extrapolated;
use super::limit::{LimitSet, SlicedSet};
use super::raster::{means, own_base, raster_scales, regular, thickness};
use super::regression::{Estimate, Reading, estimate, line};
use super::sample::Sample;
use super::space::Space;
use super::statistics::logarithm;
use super::trend::Trend;

/// Minimum number of boxes of a size that is used: fewer depend only on the position of the grid.
const MIN_BOXES: u64 = 9;

/// Minimum standard error where boxes fit a picture, which its pixels do not improve.
const MIN_ERROR: f64 = 0.001;

/// Box-counting dimension of a set, and its evidence.
#[derive(Clone, Debug, Default)]
pub struct BoxCounting {
    /// The dimension; `None` if there are fewer than three sizes in the range.
    pub estimate: Option<Estimate>,
    /// Drift of local slopes over the finer half of the admissible sizes (of pictures: over all sizes that
    /// are used); `None` if there are too few.
    pub trend: Option<Trend>,
    /// Ratio of each size to the next smaller one; `None` if nothing had to be measured.
    pub base: Option<f64>,
    /// Of pictures: the ratio of sizes for which all local slopes are equal; `None` if there is none.
    pub fitting_base: Option<f64>,
    /// Boxes of every size, from the largest to the smallest.
    pub boxes: Vec<Boxes>,
    /// Of pictures: sides of boxes, and the mean number of boxes that meet the set over all grids, from the
    /// smallest boxes on. The dimension is extrapolated from these where boxes of no base fit a picture.
    pub means: Vec<(f64, f64)>,
}

/// Boxes of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boxes {
    /// Side of a box, in the units of the set.
    pub size: f64,
    /// Number of boxes in the smallest cover that was found, or its estimate from a sample.
    pub count: u64,
    /// Whether the count is estimated from a sample of boxes.
    pub sampled: bool,
    /// Standard deviation of the natural logarithm of the count over all grids.
    pub scatter: f64,
    /// Local slope to the next smaller size; `None` for the smallest.
    pub local_slope: Option<f64>,
    /// Whether the regression uses this size.
    pub used: bool,
}

/// Sizes that a regression may use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Smallest size.
    pub finest: f64,
    /// Largest size.
    pub coarsest: f64,
    /// Minimum count: a few boxes depend only on the position of the grid.
    pub min_boxes: u64,
}

impl BoxCounting {
    /// Returns the result for a single point: dimension 0, with nothing measured.
    #[must_use]
    pub fn of_point() -> Self {
        Self {
            estimate: Some(Estimate {
                value: 0.0,
                std_error: 0.0,
                r_squared: 1.0,
                ..Estimate::default()
            }),
            ..Self::default()
        }
    }

    /// Measures a limit set, with boxes that are each smaller by the factor `base` than those before.
    ///
    /// The default base is the smallest integer up to 8 that is a power of the set's own period, for which
    /// counts do not oscillate with the size, or else 2. Boxes that are too many to be counted are estimated
    /// from a sample of them, down to 10⁻⁹ of the extent, and the sizes that determine the dimension are
    /// weighted by their likelihood. Where a sample does not reach 1/1024 of the extent (1/512 in space; the base is not an
    /// integer, or too many copies overlap), the sizes are those up to half the extent for which the smallest
    /// cover has at least 9 boxes, down to where it has about 130,000, if these are smaller than those of the sample.
    ///
    /// There is no estimate where the sizes span less than one generation of [the smallest
    /// copies](LimitSet::smallest_scale).
    #[must_use]
    pub fn of_limit<M: Space>(
        set: &LimitSet<M>,
        base: Option<f64>,
        grids: &[Grid<M>],
        threads: NonZero<usize>,
    ) -> Self {
        const MAX_BOXES: u64 = 1 << 17;
        const FAR: u32 = 10;
        let fine = libm::exp2(-f64::from(M::FILLED_LEVELS.min(FAR)));
        let most = real(set.space());
        let extent = set.bounds().size().max_element();
        if extent <= 0.0 {
            return Self::of_point();
        }
        let window = Window {
            finest: 0.0,
            coarsest: extent / 2.0,
            min_boxes: MIN_BOXES,
        };
        let base = base.unwrap_or_else(|| whole_power(set.period()));
        let scales = whole_base(base).map(|base| set.sampled_scales(base, grids, threads));
        let finest = |scales: &[Scale]| scales.last().map_or(f64::INFINITY, |it| it.size);
        let sampled = scales.unwrap_or_default();
        let covered = match finest(&sampled) < fine * extent {
            true => Vec::new(),
            false => set.scales(base, MAX_BOXES, grids, threads),
        };
        let counting = match finest(&sampled) < finest(&covered) {
            true => Self::by(&sampled, &window, |readings| averaged(readings, most)),
            false => Self::of(&covered, &window),
        };
        Self {
            estimate: counting.estimate.and_then(|it| set.believed(it)),
            ..counting
        }
    }

    /// Measures the slice of a limit set, as [`of_limit`](Self::of_limit) does, with layers of cubes on `grids` grids
    /// that are turned and shifted in its plane. The base is a whole number.
    #[must_use]
    pub fn of_slice(
        slice: &SlicedSet,
        base: Option<f64>,
        grids: NonZero<usize>,
        threads: NonZero<usize>,
    ) -> Self {
        Self::of_limit(slice.set(), base, &SlicedSet::grids(grids), threads)
    }

    /// Measures the set pixels of a picture, with boxes of `base`, base² … pixels.
    ///
    /// The default base is the number whose powers the picture is made of, if there is one (3 for a carpet of
    /// 729² pixels), or else 2. With the number whose powers it is made of, all local slopes are equal, and
    /// are the dimension. Otherwise the dimension is extrapolated from the mean numbers of boxes over all
    /// grids, of 3 pixels (or 1, if the set is filled) up to a quarter of its long side, or up to less where
    /// larger boxes do not continue the trend of smaller ones: these grow as powers whose exponents are the
    /// dimension and those of rims. The width of a pen is taken into account.
    #[must_use]
    pub fn of_pixels(
        pixels: &Bits,
        base: Option<NonZero<usize>>,
        grids: &[Grid],
        threads: NonZero<usize>,
    ) -> Self {
        const TWO: NonZero<usize> = NonZero::<usize>::MIN.saturating_add(1);
        let pixels = pixels.cropped();
        let longest = pixels.width().max(pixels.height());
        if longest <= 1 {
            return Self::of_point();
        }
        let own = own_base(&pixels);
        let base = base.or(own).unwrap_or(TWO);
        let scales = raster_scales(&pixels, base, grids, threads);
        let means = means(&pixels, threads);
        let (longest, base) = (real(longest), real(base.get()));
        let estimate = match regular(&scales) {
            Some((value, away)) => Some(Estimate {
                value,
                std_error: away.max(MIN_ERROR),
                range: [1.0, scales[1].size],
                sizes: scales.len() - 1,
                ..Estimate::default()
            }),
            None => extrapolated(&means, longest, thickness(&pixels, threads)),
        };
        let range = estimate.map_or([0.0; 2], |it| it.range);
        let used = |size: f64| (range[0]..=range[1]).contains(&size);
        let readings = readings(scales.iter().filter(|scale| used(scale.size)));
        let estimate = estimate.map(|estimate| {
            let (r_squared, intercept) = line(&readings, estimate.value);
            Estimate {
                r_squared,
                intercept,
                ..estimate
            }
        });
        let drifting = means.iter().rev().filter(|mean| used(mean.size));
        let drifting: Vec<(f64, f64)> = drifting.map(|mean| (mean.size, mean.boxes)).collect();
        Self {
            estimate,
            trend: match regular(&scales) {
                Some(_) => Trend::of(&readings),
                None => Trend::of(&of_means(&drifting)),
            },
            base: Some(base),
            fitting_base: own.map(|own| real(own.get())),
            boxes: evidence(&scales, |scale| used(scale.size)),
            means: means.iter().map(|mean| (mean.size, mean.boxes)).collect(),
        }
    }

    /// Measures points as a sample of a set, with boxes of at least the side `finest`.
    ///
    /// Sizes are used that are at most half the extent and whose smallest cover has at least 4 boxes, as long
    /// as half of the points would miss no more than 8 % of the boxes.
    #[must_use]
    pub fn of_sample(sample: &Sample, finest: f64) -> Self {
        let sizes = sample.sizes();
        let enough = &sizes[..sample.enough()];
        let window = Window {
            finest: finest.max(enough.last().copied().unwrap_or(f64::INFINITY)),
            coarsest: sizes.first().copied().unwrap_or_default(),
            min_boxes: 4,
        };
        Self::by(&sample.scales(), &window, |readings| {
            averaged(readings, real(sample.dimension)).or_else(|| estimate(readings))
        })
    }

    /// Measures the slope of ln count on ln (1 / size) over all sizes in a window, weighted by the agreement
    /// of the grids.
    #[must_use]
    pub fn of(scales: &[Scale], window: &Window) -> Self {
        Self::by(scales, window, estimate)
    }

    fn by(
        scales: &[Scale],
        window: &Window,
        estimate: impl Fn(&[Reading]) -> Option<Estimate>,
    ) -> Self {
        const SLACK: f64 = 1.0 + 1e-6;
        let used = |scale: &Scale| {
            scale.size * SLACK >= window.finest
                && scale.size <= window.coarsest * SLACK
                && scale.count >= window.min_boxes
        };
        let readings = readings(scales.iter().filter(|scale| used(scale)));
        let finer = &readings[readings.len() / 2..];
        let trend = Trend::of(finer);
        let estimate = estimate(&readings).map(|estimate| match trend {
            Some(trend) if trend.is_significant() => estimate.drifting(trend.over(finer)),
            _ => estimate,
        });
        let [finest, coarsest] = estimate.map_or([0.0, f64::INFINITY], |it| it.range);
        let is_inside = |size: f64| (finest..=coarsest).contains(&size);
        Self {
            estimate,
            trend,
            base: scales
                .windows(2)
                .next()
                .map(|pair| pair[0].size / pair[1].size),
            fitting_base: None,
            boxes: evidence(scales, |scale| used(scale) && is_inside(scale.size)),
            means: Vec::new(),
        }
    }
}

/// Returns the readings of a regression, one for each size.
fn readings<'a>(scales: impl Iterator<Item = &'a Scale>) -> Vec<Reading> {
    let reading = |scale: &Scale| Reading {
        size: scale.size,
        log: logarithm(scale.count),
        scatter: scale.scatter,
        growth: scale.growth,
        growth_error: scale.growth_error,
    };
    scales.map(reading).collect()
}

/// Returns the readings of mean counts, from the largest size on.
fn of_means(means: &[(f64, f64)]) -> Vec<Reading> {
    let reading = |(number, &(size, boxes)): (usize, &(f64, f64))| Reading {
        size,
        log: libm::log(boxes),
        scatter: 0.0,
        growth: libm::log(boxes / means[number.saturating_sub(1)].1),
        growth_error: 0.0,
    };
    means.iter().enumerate().map(reading).collect()
}

/// Returns the boxes of every size, with local slopes.
fn evidence(scales: &[Scale], used: impl Fn(&Scale) -> bool) -> Vec<Boxes> {
    let boxes = scales.iter().enumerate().map(|(number, scale)| Boxes {
        size: scale.size,
        count: scale.count,
        sampled: scale.sampled,
        scatter: scale.scatter,
        local_slope: scales.get(number + 1).map(|finer| scale.slope_to(finer)),
        used: used(scale),
    });
    boxes.collect()
}

/// Returns the smallest integer up to 8 that is a power of the period, or 2 if there is none.
pub(super) fn whole_power(period: Option<f64>) -> f64 {
    const LARGEST: f64 = 8.5;
    const TOLERANCE: f64 = 1e-9;
    let powers = period.into_iter().flat_map(|period| {
        let powers = std::iter::successors(Some(period), move |power| Some(power * period));
        powers.take_while(|power| *power < LARGEST)
    });
    let mut whole = powers.filter(|power| (power - power.round()).abs() < TOLERANCE * power);
    whole.next().map_or(2.0, f64::round)
}

/// Returns the base if it is an integer larger than 1.
fn whole_base(base: f64) -> Option<NonZero<usize>> {
    NonZero::new(whole(base)).filter(|whole| base.fract() == 0.0 && whole.get() > 1)
}
