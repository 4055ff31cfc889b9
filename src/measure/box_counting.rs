use std::num::NonZero;

use super::bits::Bits;
use super::cover::{Grid, Scale};
use super::limit::LimitSet;
use super::points::Points;
use super::raster::raster_scales;
use super::regression::{Estimate, Reading, estimate};

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
    /// The number of boxes in the least cover that was found.
    pub count: u64,
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
    /// The largest count: where there are more boxes, the data do not fill them.
    pub most_boxes: u64,
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
    /// Without a base, it is the set's own period, so that its counts do not swing with the size (or
    /// 2, if it has none or one above 4). Used are sizes up to half the extent at which the least
    /// cover has 9 boxes or more, down to where it has some 130,000.
    #[must_use]
    pub fn of_limit(
        set: &LimitSet,
        base: Option<f64>,
        grids: &[Grid],
        threads: NonZero<usize>,
    ) -> Self {
        const LARGEST_PERIOD: f64 = 4.0;
        const MOST_BOXES: u64 = 1 << 17;
        let extent = set.bounds().size().max_element();
        if extent <= 0.0 {
            return Self::of_point();
        }
        let own = || set.period().filter(|&period| period <= LARGEST_PERIOD);
        let base = base.or_else(own).unwrap_or(2.0);
        let window = Window {
            finest: 0.0,
            coarsest: extent / 2.0,
            least_boxes: 9,
            most_boxes: u64::MAX,
        };
        Self::of(&set.scales(base, MOST_BOXES, grids, threads), &window)
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
            most_boxes: u64::MAX,
        };
        Self::of(&raster_scales(pixels, base, grids, threads), &window)
    }

    /// Measures points, with boxes whose sides are the extent divided by powers of two.
    ///
    /// Used are boxes of which at least 8 make the extent, as long as there are 8 points a box.
    #[must_use]
    pub fn of_points(points: &Points, grids: &[Grid], threads: NonZero<usize>) -> Self {
        let window = Window {
            finest: 0.0,
            coarsest: points.bounds().size().max_element() / 8.0,
            least_boxes: 1,
            most_boxes: points.most_boxes(),
        };
        Self::of(&points.scales(grids, threads), &window)
    }

    /// Measures points that lie no farther than `detail` from a set, as near all of it.
    ///
    /// Used are boxes of which at least 8 make the extent, and that are at least 4 details large.
    #[must_use]
    pub fn of_grown(points: &Points, detail: f64, grids: &[Grid], threads: NonZero<usize>) -> Self {
        let window = Window {
            finest: 4.0 * detail,
            coarsest: points.bounds().size().max_element() / 8.0,
            least_boxes: 1,
            most_boxes: u64::MAX,
        };
        Self::of(&points.scales(grids, threads), &window)
    }

    /// Measures the slope of ln count on ln (1 / size), weighted by how well grids agree, over all
    /// sizes in a window.
    #[must_use]
    pub fn of(scales: &[Scale], window: &Window) -> Self {
        const SLACK: f64 = 1.0 + 1e-6;
        let log = |scale: &Scale| {
            #[expect(clippy::cast_precision_loss, reason = "a logarithm is rounded")]
            libm::log(scale.count.max(1) as f64)
        };
        let used = |scale: &Scale| {
            scale.size * SLACK >= window.finest
                && scale.size <= window.coarsest * SLACK
                && (window.least_boxes..=window.most_boxes).contains(&scale.count)
        };
        let readings = scales
            .iter()
            .filter(|scale| used(scale))
            .map(|scale| Reading {
                size: scale.size,
                log: log(scale),
                scatter: scale.scatter,
            });
        let readings: Vec<_> = readings.collect();
        let boxes = scales.iter().enumerate().map(|(number, scale)| Boxes {
            size: scale.size,
            count: scale.count,
            scatter: scale.scatter,
            local_slope: scales
                .get(number + 1)
                .map(|finer| (log(finer) - log(scale)) / libm::log(scale.size / finer.size)),
            used: used(scale),
        });
        Self {
            estimate: estimate(&readings),
            boxes: boxes.collect(),
        }
    }
}
