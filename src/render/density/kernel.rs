//! Density estimation with an adaptive kernel: hits are spread the wider, the fewer there are.
//!
//! The radius of the kernel of a pixel with n hits is R n^(-2/5), the curve of flam3's estimator (Suykens & Willems, "Adaptive
//! filtering for progressive Monte Carlo image rendering", 2000). Hits are spread before they are mapped to tones. Weights are
//! whole numbers whose sum is exact, so that no hit is lost and the order of sums is of no consequence.

use crate::parallel::for_each;

/// Weight of a hit.
pub(super) const WEIGHT: u32 = 1 << 16;

/// Number of radii per pixel that are distinguished.
const RADII: f64 = 4.0;

/// Number of rows that a thread spreads at once.
const ROWS: usize = 32;

/// Largest radius in pixels.
pub(super) const MAX_RADIUS: f64 = 64.0;

/// Spreads the hits of pixels in rows. Returns the weights of every pixel, by class, in 1/[`WEIGHT`] of a hit. The kernel of a pixel
/// with one hit has a radius in pixels; that of others depends on the hits of all classes. Beyond the edges of the picture, its
/// content is taken to be mirrored.
pub(super) fn spread(
    [width, height]: [usize; 2],
    classes: &[&[u32]],
    radius: f64,
    threads: usize,
) -> Vec<u64> {
    let kernels = Kernels::new(radius.min(MAX_RADIUS));
    let stride = width * classes.len();
    let mut all = vec![0; stride * height];
    let bands = all.chunks_mut((ROWS * stride).max(1)).enumerate();
    for_each(bands, threads, |(number, band)| {
        let first = number * ROWS;
        let rows = first..first + band.len() / stride;
        let reach = kernels.reach();
        for y in first.saturating_sub(reach)..(rows.end + reach).min(height) {
            for x in 0..width {
                let place = y * width + x;
                let hits: u64 = { classes.iter() }
                    .map(|counts| u64::from(counts[place]))
                    .sum();
                let Some(kernel) = kernels.of(hits) else {
                    continue;
                };
                let pixel = |at: usize, count: usize| mirrored(at, kernel.reach, count);
                for (down, row) in (y..).zip(kernel.rows()) {
                    let Some(to) = pixel(down, height).filter(|to| rows.contains(to)) else {
                        continue;
                    };
                    let own = &mut band[(to - first) * stride..][..stride];
                    for (right, weight) in (x..).zip(row).filter(|(_, weight)| **weight > 0) {
                        let Some(column) = pixel(right, width) else {
                            continue;
                        };
                        let own = &mut own[column * classes.len()..];
                        for (counts, own) in classes.iter().zip(own) {
                            *own += u64::from(counts[place]) * u64::from(*weight);
                        }
                    }
                }
            }
        }
    });
    all
}

/// Returns the pixel at a place that is counted from `reach` pixels before the first; mirrored at the edges.
fn mirrored(place: usize, reach: usize, count: usize) -> Option<usize> {
    let inside = match place.checked_sub(reach) {
        Some(inside) => inside,
        None => reach - place - 1,
    };
    let mirrored = match inside < count {
        true => Some(inside),
        false => (2 * count).checked_sub(inside + 1),
    };
    mirrored.filter(|place| *place < count)
}

/// Kernels by the number of hits.
struct Kernels {
    radius: f64,
    /// By radius, from half a pixel on.
    all: Vec<Kernel>,
}

/// Weights of a square of pixels.
struct Kernel {
    /// Number of pixels on each side of the middle one.
    reach: usize,
    /// In rows; their sum is [`WEIGHT`].
    weights: Vec<u32>,
}

impl Kernels {
    fn new(radius: f64) -> Self {
        let count = number_of(radius) + 1;
        Self {
            radius,
            all: (0..count)
                .map(|number| Kernel::new(radius_of(number)))
                .collect(),
        }
    }

    fn reach(&self) -> usize {
        self.all.last().map_or(0, |kernel| kernel.reach)
    }

    /// Returns the kernel of a pixel; `None` if it has no hits.
    fn of(&self, hits: u64) -> Option<&Kernel> {
        if hits == 0 {
            return None;
        }
        #[expect(clippy::cast_precision_loss, reason = "a radius needs few digits")]
        let radius = self.radius * libm::pow(hits as f64, -0.4);
        self.all.get(number_of(radius))
    }
}

fn radius_of(number: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "there are few radii")]
    let steps = number as f64;
    steps / RADII
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "radii are small and not negative"
)]
fn number_of(radius: f64) -> usize {
    (radius * RADII).round() as usize
}

impl Kernel {
    /// Makes the kernel of Epanechnikov, 1 − (distance/radius)², sampled at the centres of pixels.
    fn new(radius: f64) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "radii are small"
        )]
        let reach = (radius.ceil() as usize).saturating_sub(1);
        let side = 2 * reach + 1;
        let height = |place: usize| {
            #[expect(clippy::cast_precision_loss, reason = "kernels are small")]
            let [x, y] = [place % side, place / side].map(|at| at as f64 - reach as f64);
            let share = (x * x + y * y) / (radius * radius);
            if x == 0.0 && y == 0.0 {
                1.0
            } else {
                (1.0 - share).max(0.0)
            }
        };
        let heights: Vec<f64> = (0..side * side).map(height).collect();
        let sum: f64 = heights.iter().sum();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "shares of a weight"
        )]
        let mut weights: Vec<u32> = { heights.iter() }
            .map(|height| (height / sum * f64::from(WEIGHT)) as u32)
            .collect();
        // The middle takes what was rounded off.
        let lost = WEIGHT - weights.iter().sum::<u32>();
        weights[side * side / 2] += lost;
        Self { reach, weights }
    }

    fn rows(&self) -> impl Iterator<Item = &[u32]> {
        self.weights.chunks_exact(2 * self.reach + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Catalogue;
    use crate::chaos::{Game, Histogram, HistogramWindow, WeightedMaps, play};
    use crate::diagnostic::Source;
    use crate::document::Document;
    use crate::geometry::{DAffine2, DVec2};
    use crate::model::Model;

    #[test]
    fn no_hit_is_lost() {
        let size = [23, 29];
        let counts: Vec<u32> = (0..23 * 29)
            .map(|place| place * 7919 % 5 * (place % 3))
            .collect();
        let others: Vec<u32> = counts.iter().rev().copied().collect();
        let expected: u64 = counts.iter().map(|count| u64::from(*count)).sum();
        for radius in [0.3, 0.4, 1.0, 3.3, 9.0, 16.0] {
            let one = spread(size, &[&counts, &others], radius, 1);
            for class in 0..2 {
                let sum: u64 = one.iter().skip(class).step_by(2).sum();
                assert_eq!(sum, expected * u64::from(WEIGHT), "{radius}");
            }
            assert_eq!(
                spread(size, &[&counts, &others], radius, 3),
                one,
                "{radius}"
            );
        }
    }

    #[test]
    fn many_hits_stay_and_few_are_spread() {
        let mut counts = vec![0; 41 * 41];
        let middle = 20 * 41 + 20;
        counts[middle] = 100_000;
        let many = spread([41; 2], &[&counts], 9.0, 2);
        assert_eq!(many[middle], 100_000 * u64::from(WEIGHT));
        counts[middle] = 1;
        let one = spread([41; 2], &[&counts], 9.0, 2);
        assert!(one[middle] < u64::from(WEIGHT) / 100);
        let square = |place: u32| {
            let [x, y] = [place % 41, place / 41].map(|at| f64::from(at) - 20.0);
            x * x + y * y
        };
        let weight = |place: u32| f64::from(u32::try_from(one[place as usize]).unwrap());
        assert!((0..41 * 41).all(|place| (weight(place) > 0.0) == (square(place) < 81.0)));
        // The variance of a kernel of radius R about an axis is R²/6.
        let moments = (0..41 * 41).map(|place| square(place) / 2.0 * weight(place));
        let variance = moments.sum::<f64>() / f64::from(WEIGHT);
        assert!((variance - 81.0 / 6.0).abs() < 0.1, "{variance}");
    }

    /// Number of pixels on a side.
    const SIDE: usize = 64;

    /// Nine maps of the square [0, 2]², whose measure has the density h(x) h(y): the hat h rises from 0 to 1 at 1 and falls to 0 at
    /// 2, as h(x) = h(2x)/2 + h(2x − 1) + h(2x − 2)/2 (de Rham).
    fn hat(points: u64) -> Histogram {
        let text = "kind: ifs\nmaps:\n  - {for: {a: 0..2, b: 0..2}, scale: 1/2, translate: [a/2, b/2], \
                    weight: (1 + a*(2 - a))*(1 + b*(2 - b))}\n";
        let source = Source::new("hat.yaml", text);
        let document = Document::read(&source, &Catalogue::embedded()).unwrap();
        let Model::Ifs(system) = document.resolve(&[]).unwrap().0 else {
            panic!();
        };
        let side = u32::try_from(SIDE).unwrap();
        let window = HistogramWindow {
            to_pixels: DAffine2::from_scale(DVec2::splat(f64::from(side) / 2.0)),
            size: [side; 2],
        };
        let game = Game {
            points,
            ..Game::default()
        };
        play(&WeightedMaps::of(system.ifs()).unwrap(), &window, &game).unwrap()
    }

    /// Estimates from few points are held against the density.
    #[test]
    fn few_points_come_closer_to_a_smooth_density() {
        let few = hat(20_000);
        let counts = few.counts(0);
        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        let share = |place: usize| {
            let middle = (place as f64 + 0.5) * 2.0 / SIDE as f64;
            (1.0 - (middle - 1.0).abs()) * 2.0 / SIDE as f64
        };
        let error = |weights: &[u64], unit: f64| -> f64 {
            #[expect(clippy::cast_precision_loss, reason = "small numbers")]
            let off = (0..SIDE * SIDE).map(|place| {
                let found = weights[place] as f64 / unit / few.inside() as f64;
                (found - share(place % SIDE) * share(place / SIDE)).abs()
            });
            off.sum()
        };
        let raw: Vec<u64> = counts.iter().map(|hits| u64::from(*hits)).collect();
        let spread = spread([SIDE; 2], &[counts], 6.0, 2);
        let (without, with) = (error(&raw, 1.0), error(&spread, WEIGHT.into()));
        assert!(
            without > 0.25 && with < 0.6 * without,
            "{with} of {without}"
        );
    }

    #[test]
    fn even_hits_stay_even() {
        let counts = vec![3; 40 * 30];
        let even = spread([40, 30], &[&counts], 9.0, 2);
        assert!(even.iter().all(|weight| *weight == 3 * u64::from(WEIGHT)));
    }
}
