use std::num::NonZero;

use super::averaging::averaged;
use super::bits::Bits;
use super::cover::{Grid, Scale};
use super::limit::LimitSet;
use super::raster::raster_scales;
use super::regression::{Estimate, Reading, estimate};
use super::sample::Sample;

/// No set of the plane has a larger dimension.
pub(super) const PLANE: f64 = 2.0;

/// Fewer boxes tell nothing but where they lie.
const LEAST_BOXES: u64 = 9;

/// A box-counting dimension, and its evidence.
#[derive(Clone, Debug, Default)]
pub struct BoxCounting {
    /// The dimension; none if there are fewer than three sizes in the range.
    pub estimate: Option<Estimate>,
    /// The boxes of every size, from the largest to the smallest.
    pub boxes: Vec<Boxes>,
}

/// The boxes of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boxes {
    /// The side of a box, in the units of the set.
    pub size: f64,
    /// The number of boxes in the least cover that was found, or what a sample tells it to be.
    pub count: u64,
    /// Whether the count comes from a sample of boxes.
    pub sampled: bool,
    /// The standard deviation of the logarithm of the count among grids.
    pub scatter: f64,
    /// The slope to the next smaller size; none for the smallest.
    pub local_slope: Option<f64>,
    /// Whether the regression uses this size.
    pub used: bool,
}

/// What sizes a regression may use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The smallest size.
    pub finest: f64,
    /// The largest size.
    pub coarsest: f64,
    /// The least count: a few boxes tell nothing but where they lie.
    pub least_boxes: u64,
}

impl BoxCounting {
    /// That of a single point: 0, with nothing to be measured.
    #[must_use]
    pub fn of_point() -> Self {
        Self {
            estimate: Some(Estimate {
                value: 0.0,
                std_error: 0.0,
                range: [0.0; 2],
                r_squared: 1.0,
                intercept: 0.0,
                sizes: 0,
            }),
            boxes: Vec::new(),
        }
    }

    /// Measures a limit set, with boxes that are each `base` times smaller than those before.
    ///
    /// Without a base, it is the least whole number up to 8 that is a power of the set's own period,
    /// so that its counts do not swing with the size, or 2. Boxes that are too many to be counted are
    /// told by a sample of them, down to 10⁻⁹ of the extent; which sizes tell the dimension, their
    /// likelihood decides. Where a sample does not come as far as counting (the base is not whole, or
    /// too many copies lie over each other), the sizes are those up to half the extent at which the
    /// least cover has 9 boxes or more, down to where it has some 130,000.
    #[must_use]
    pub fn of_limit(
        set: &LimitSet,
        base: Option<f64>,
        grids: &[Grid],
        threads: NonZero<usize>,
    ) -> Self {
        const MOST_BOXES: u64 = 1 << 17;
        const FINE: f64 = 1.0 / 16_384.0;
        let extent = set.bounds().size().max_element();
        if extent <= 0.0 {
            return Self::of_point();
        }
        let window = Window {
            finest: 0.0,
            coarsest: extent / 2.0,
            least_boxes: LEAST_BOXES,
        };
        let base = base.unwrap_or_else(|| whole_power(set.period()));
        let scales = whole(base).map(|base| set.sampled_scales(base, grids, threads));
        let comes_far =
            |scales: &Vec<Scale>| scales.last().is_some_and(|it| it.size < FINE * extent);
        match scales.filter(comes_far) {
            Some(scales) => Self::by(&scales, &window, |readings| averaged(readings, PLANE)),
            None => Self::of(&set.scales(base, MOST_BOXES, grids, threads), &window),
        }
    }

    /// Measures the set pixels of a picture, with boxes of `base`, base² … pixels.
    ///
    /// Used are boxes of at least 4 pixels, of which at least 8 make the long side of the picture.
    #[must_use]
    pub fn of_pixels(
        pixels: &Bits,
        base: NonZero<usize>,
        grids: &[Grid],
        threads: NonZero<usize>,
    ) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "pictures are smaller than that")]
        let longest = pixels.width().max(pixels.height()) as f64;
        let window = Window {
            finest: 4.0,
            coarsest: longest / 8.0,
            least_boxes: 1,
        };
        Self::of(&raster_scales(pixels, base, grids, threads), &window)
    }

    /// Measures points as a sample of a set, with boxes that are at least `finest`.
    ///
    /// Used are boxes that are at most half the extent, of which the least cover has 4 or more, as long
    /// as half of the points would miss no more than one in 12 of them.
    #[must_use]
    pub fn of_sample(sample: &Sample, finest: f64) -> Self {
        let sizes = sample.sizes();
        let enough = &sizes[..sample.enough()];
        let window = Window {
            finest: finest.max(enough.last().copied().unwrap_or(f64::INFINITY)),
            coarsest: sizes.first().copied().unwrap_or_default(),
            least_boxes: 4,
        };
        Self::by(&sample.scales(), &window, |readings| {
            averaged(readings, PLANE).or_else(|| estimate(readings))
        })
    }

    /// Measures the slope of ln count on ln (1 / size), weighted by how well grids agree, over all
    /// sizes in a window.
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
        let log = |scale: &Scale| {
            #[expect(clippy::cast_precision_loss, reason = "a logarithm is rounded")]
            libm::log(scale.count.max(1) as f64)
        };
        let used = |scale: &Scale| {
            scale.size * SLACK >= window.finest
                && scale.size <= window.coarsest * SLACK
                && scale.count >= window.least_boxes
        };
        let readings = scales
            .iter()
            .filter(|scale| used(scale))
            .map(|scale| Reading {
                size: scale.size,
                log: log(scale),
                scatter: scale.scatter,
                growth: scale.growth,
                growth_error: scale.growth_error,
            });
        let estimate = estimate(&readings.collect::<Vec<_>>());
        let [finest, coarsest] = estimate.map_or([0.0, f64::INFINITY], |it| it.range);
        let boxes = scales.iter().enumerate().map(|(number, scale)| Boxes {
            size: scale.size,
            count: scale.count,
            sampled: scale.sampled,
            scatter: scale.scatter,
            local_slope: scales
                .get(number + 1)
                .map(|finer| (log(finer) - log(scale)) / libm::log(scale.size / finer.size)),
            used: used(scale) && (finest..=coarsest).contains(&scale.size),
        });
        Self {
            estimate,
            boxes: boxes.collect(),
        }
    }
}

/// The least whole number that is a power of a period, if there is one that is not too large, or 2.
fn whole_power(period: Option<f64>) -> f64 {
    const LARGEST: f64 = 8.5;
    const TOLERANCE: f64 = 1e-9;
    let powers = period.into_iter().flat_map(|period| {
        let powers = std::iter::successors(Some(period), move |power| Some(power * period));
        powers.take_while(|power| *power < LARGEST)
    });
    let mut whole = powers.filter(|power| (power - power.round()).abs() < TOLERANCE * power);
    whole.next().map_or(2.0, f64::round)
}

/// A base that is a whole number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "bases are small"
)]
fn whole(base: f64) -> Option<NonZero<usize>> {
    NonZero::new(base as usize).filter(|whole| base.fract() == 0.0 && whole.get() > 1)
}
