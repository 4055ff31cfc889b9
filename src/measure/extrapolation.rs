//! Dimensions of pictures: a power is separated from the contributions of pens and of coarse boxes.
//!
//! The mean number of boxes of side s that meet a set is N(s) = A s^-D + B s^-d + 1: the power in question,
//! one for rims and for boxes that pieces share, and the last box (of a convex shape, after Steiner, N = a /
//! s² + p / s + 1; of a curve of four similar parts, whose neighbours share a box, N(s) − 1 = 4 (N(3 s) −
//! 1)). A pen that is w pixels wider than one dilates the set: the area N(s) s² of the picture is that of the
//! set at s + w. The width of the pen is bounded by the picture's thickness.
//!
//! The residuals of a model, such as the waves of a self-similar set, are correlated between neighbouring
//! sizes: they are modelled as an autoregression of the first order in ln s, of a magnitude that is estimated
//! from the data, but at least about a hundredth. The magnitude may be larger for coarse boxes, of which a
//! few hold the whole set. D is the mean over all models, weighted by likelihood, and its error their spread:
//! where slopes drift, other powers explain them as well, and the error is large.
//!
//! No power represents a length of the set itself, such as the distance between turns of a spiral: its counts
//! are those of a curve below that length, and those of an area above. For that reason models are fitted to
//! several ranges, up to a quarter of the long side or to less of it, and D is the mean over these as well.
//! The counts that a range leaves out are explained by no model, except to within a few hundredths, which
//! makes the range less likely. Neighbouring counts are correlated, and count in part only (averages over
//! ranges: Jay & Neil 2021).

use crate::saturating::{real, whole};

use super::raster::Mean;
use super::regression::Estimate;

/// Number of steps of the dimensions that are tried, from 0 to that of the plane.
const STEPS: u16 = 400;
const STEP: f64 = 2.0 / STEPS as f64;

/// Exponents d of the added power, in multiples of `ADDED_STEP`.
const ADDED: std::ops::Range<i32> = 0..14;
const ADDED_STEP: f64 = 0.15;

/// Minimum difference D − d.
const APART: f64 = 0.03;

/// Lower bound of the added power, as a share of the main one at the coarsest size.
const MAX_TAKEN: f64 = -0.9;
/// Minimum share of the main power in the count at the finest size.
const MIN_SHARE: f64 = 0.7;

/// Finest boxes in pixels, and the coarsest of every range as a fraction of the long side.
const FINEST: f64 = 3.0;
const COARSEST: [f64; RANGES] = [0.015625, 0.03125, 0.0625, 0.125, LARGEST];
const LARGEST: f64 = 0.25;
const RANGES: usize = 5;

/// Relative error of the counts that a range leaves out.
const LEFT_OUT: f64 = 0.03;

/// Factor of the logarithm of a range's likelihood, which accounts for the correlation of neighbouring sizes.
const COUNTED: f64 = 0.3;

/// Minimum number of sizes of a range.
const MIN_SIZES: usize = 5;

/// Correlation length of the residuals in ln s.
const TOGETHER: f64 = 1.0;

/// Relative magnitudes of the residuals of the coarsest boxes, compared with those of middle sizes.
const ROUGH: [f64; 2] = [3.0, 9.0];

/// Minimum standard error: that of the steps.
const MIN_ERROR: f64 = 0.003;

/// Thickness from which a set is filled, and not made of lines of a pen.
const FILLED: f64 = 4.5;

/// The prior distribution of models.
struct Belief {
    /// Widths of the pen beyond one pixel.
    pens: Vec<f64>,
    finest: f64,
    /// Minimum relative residual of a model.
    left: f64,
    /// Prior probability of D = 2, relative to that of an interval of D with length 1.
    whole: f64,
}

impl Belief {
    /// Returns the prior for the thickness of a picture.
    fn of(thickness: f64) -> Self {
        /// Widths for pixels that are at least half full, for lines of one pixel, and for pixels that hold a
        /// point of the set.
        const NONE: [f64; 3] = [-0.6, -0.3, -0.1];
        if thickness >= FILLED {
            return Self {
                pens: NONE.into_iter().chain([0.1, 0.6]).collect(),
                finest: 1.0,
                left: 0.012,
                whole: 1.0,
            };
        }
        // A pen that is w + 1 pixels wide gives a thickness from w to 1.25 w, which is larger where parts lie
        // close together.
        let widest = thickness.min(3.2);
        let pens = [0.4, 0.6, 0.8, 1.0].map(|part| part * widest);
        let pens = pens.into_iter().filter(|_| widest > 0.12);
        Self {
            pens: NONE.into_iter().chain(pens).collect(),
            finest: FINEST,
            left: 0.006,
            whole: 0.1,
        }
    }
}

/// Transformation of the columns of a regression that removes the correlation of neighbouring entries.
struct Whitened {
    /// Error of every entry, in relative units.
    scale: Vec<f64>,
    /// Correlation of every entry with the next one.
    kept: Vec<f64>,
}

impl Whitened {
    fn new(sizes: &[f64], longest: f64, rough: f64) -> Self {
        let scale = |size: &f64| {
            let coarse = rough * size / (longest * LARGEST);
            libm::sqrt(1.0 + 1.0 / (size * size) + coarse * coarse)
        };
        let kept = |pair: &[f64]| libm::pow(pair[0] / pair[1], 1.0 / TOGETHER);
        Self {
            scale: sizes.iter().map(scale).collect(),
            kept: sizes.windows(2).map(kept).collect(),
        }
    }

    fn column(&self, mut entry: impl FnMut(usize) -> f64) -> Vec<f64> {
        let mut last = 0.0;
        let entries = (0..self.scale.len()).map(|number| {
            let this = entry(number) / self.scale[number];
            let kept = number.checked_sub(1).map_or(0.0, |it| self.kept[it]);
            let rest = (this - kept * last) / libm::sqrt(1.0 - kept * kept);
            last = this;
            rest
        });
        entries.collect()
    }

    /// Returns the logarithm of the determinant of the transformation of the first `entries` entries, up to a
    /// constant.
    fn volume(&self, entries: usize) -> f64 {
        self.scale[..entries]
            .iter()
            .map(|scale| libm::log(*scale))
            .sum()
    }
}

/// Estimates the dimension of a picture from mean counts, from the smallest boxes on. Returns `None` if there
/// are too few.
pub(super) fn extrapolated(means: &[Mean], longest: f64, thickness: f64) -> Option<Estimate> {
    let belief = Belief::of(thickness);
    let used = |mean: &&Mean| mean.size >= belief.finest && mean.size <= longest * LARGEST;
    let means: Vec<Mean> = means.iter().filter(used).copied().collect();
    let up_to = |part: f64| means.partition_point(|mean| mean.size <= longest * part);
    let ends = COARSEST.map(up_to);
    let sizes: Vec<f64> = means.iter().map(|mean| mean.size).collect();
    let mut evidence = ends.map(|_| Vec::new());
    for rough in ROUGH {
        let whitened = Whitened::new(&sizes, longest, rough);
        for &pen in &belief.pens {
            Models::new(&means, ends, pen, &whitened, belief.left).weigh(&mut evidence);
        }
    }
    let ranges: Vec<Range> = std::iter::zip(ends, &evidence)
        .filter_map(|(sizes, evidence)| Range::of(sizes, evidence, belief.whole))
        .collect();
    let sizes = |range: &Range| real(range.sizes);
    let log = |range: &Range| COUNTED * (range.log + sizes(range) * libm::log(LEFT_OUT));
    let best = ranges.iter().map(log).fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = ranges.iter().map(|it| libm::exp(log(it) - best)).collect();
    let all: f64 = weights.iter().sum();
    if all <= 0.0 {
        return None;
    }
    let mean = |of: &dyn Fn(&Range) -> f64| {
        let parts = ranges.iter().zip(&weights);
        parts.map(|(range, weight)| weight * of(range)).sum::<f64>() / all
    };
    let value = mean(&|range| range.mean);
    let spread = mean(&|range| range.variance + (range.mean - value) * (range.mean - value));
    let sizes = whole(mean(&sizes).round());
    Some(Estimate {
        value: value + 0.0,
        std_error: libm::hypot(spread.sqrt(), MIN_ERROR),
        range: [means[0].size, means[sizes - 1].size],
        r_squared: 1.0,
        intercept: 0.0,
        sizes,
    })
}

/// A model of a range: the step of its dimension, and the logarithm of its likelihood.
type Evidence = (u16, f64);

/// Estimate of the dimension from one range of sizes.
struct Range {
    sizes: usize,
    /// Logarithm of the likelihood of the range.
    log: f64,
    mean: f64,
    variance: f64,
}

impl Range {
    /// Returns the estimate from the models of the range; `saturating` is the relative prior of D = 2. Returns
    /// `None` if there is no model.
    fn of(sizes: usize, evidence: &[Evidence], whole: f64) -> Option<Self> {
        /// Logarithm of the likelihood, relative to the best, below which models are ignored.
        const MIN_LOG: f64 = -40.0;
        let best = evidence.iter().map(|it| it.1).max_by(f64::total_cmp)?;
        let mut weights = vec![0.0; usize::from(STEPS) + 1];
        for &(step, log) in evidence.iter().filter(|it| it.1 > best + MIN_LOG) {
            weights[usize::from(step)] += libm::exp(log - best);
        }
        weights[usize::from(STEPS)] *= 1.0 + whole / STEP;
        let all: f64 = weights.iter().sum();
        let mean = |of: &dyn Fn(f64) -> f64| {
            let steps = (0..=STEPS).zip(&weights);
            let terms = steps.map(|(step, weight)| weight * of(f64::from(step) * STEP));
            terms.sum::<f64>() / all
        };
        let value = mean(&|dimension| dimension);
        Some(Self {
            sizes,
            log: best + libm::log(all),
            mean: value,
            variance: mean(&|dimension| (dimension - value) * (dimension - value)),
        })
    }
}

/// All models with one pen.
struct Models<'a> {
    whitened: &'a Whitened,
    /// For every size: the logarithm of the side by which the set is covered, relative to the coarsest, and
    /// the count of the set itself.
    logs: Vec<f64>,
    counts: Vec<f64>,
    wanted: Vec<f64>,
    /// Number of sizes of every range.
    ends: [usize; RANGES],
    left: f64,
}

/// A second power.
struct Added {
    exponent: f64,
    column: Vec<f64>,
    norms: [f64; RANGES],
    sums: [f64; RANGES],
    /// Values at the coarsest size of every range, and at the finest.
    coarse: [f64; RANGES],
    fine: f64,
}

impl<'a> Models<'a> {
    fn new(
        means: &[Mean],
        ends: [usize; RANGES],
        pen: f64,
        whitened: &'a Whitened,
        left: f64,
    ) -> Self {
        let side = |mean: &Mean| mean.size + pen;
        let coarsest = means.last().map_or(1.0, side);
        let count = |mean: &Mean| {
            let part = mean.size / side(mean);
            mean.boxes * part * part
        };
        let counts: Vec<f64> = means.iter().map(count).collect();
        let wanted = whitened.column(|number| (counts[number] - 1.0) / counts[number]);
        Self {
            whitened,
            logs: means
                .iter()
                .map(|mean| libm::log(side(mean) / coarsest))
                .collect(),
            counts,
            wanted,
            ends,
            left,
        }
    }

    /// Returns the power of the side for every size, relative to the coarsest.
    fn power(&self, exponent: f64) -> Vec<f64> {
        self.logs
            .iter()
            .map(|log| libm::exp(-exponent * log))
            .collect()
    }

    fn column(&self, power: &[f64]) -> Vec<f64> {
        self.whitened
            .column(|number| power[number] / self.counts[number])
    }

    /// Returns the last entry of every range that has one.
    fn last(&self, power: &[f64]) -> [f64; RANGES] {
        self.ends
            .map(|end| end.checked_sub(1).map_or(1.0, |last| power[last]))
    }

    /// Returns the inner products of two columns over every range.
    fn products(&self, a: &[f64], b: &[f64]) -> [f64; RANGES] {
        let (mut from, mut sum) = (0, 0.0);
        self.ends.map(|end| {
            let entries = a[from..end].iter().zip(&b[from..end]);
            sum += entries.map(|(a, b)| a * b).sum::<f64>();
            from = end;
            sum
        })
    }

    fn added(&self, exponent: f64) -> Added {
        let power = self.power(exponent);
        let column = self.column(&power);
        Added {
            exponent,
            norms: self.products(&column, &column),
            sums: self.products(&column, &self.wanted),
            coarse: self.last(&power),
            fine: power.first().copied().unwrap_or(1.0),
            column,
        }
    }

    /// Appends every model to those of its range.
    fn weigh(&self, evidence: &mut [Vec<Evidence>; RANGES]) {
        let ranges: Vec<usize> = (0..RANGES)
            .filter(|&it| self.ends[it] >= MIN_SIZES)
            .collect();
        let sizes = self.ends.map(real);
        let volumes = self.ends.map(|end| self.whitened.volume(end));
        let log = |range: usize, rest: f64| {
            let left = rest.max(0.0) / sizes[range] + self.left * self.left;
            -sizes[range] / 2.0 * libm::log(left) - volumes[range]
        };
        let added: Vec<Added> = ADDED
            .map(|number| self.added(f64::from(number) * ADDED_STEP))
            .collect();
        // A second power is penalised by the number of its choices, and by a constant.
        let price = 3.0 + libm::log(f64::from(ADDED.end));
        let all = self.products(&self.wanted, &self.wanted);
        for step in 1..=STEPS {
            let dimension = f64::from(step) * STEP;
            let power = self.power(dimension);
            let (coarse, fine) = (self.last(&power), power.first().copied().unwrap_or(1.0));
            let main = self.column(&power);
            let norms = self.products(&main, &main);
            let sums = self.products(&main, &self.wanted);
            for &range in &ranges {
                let rest = all[range] - sums[range] * sums[range] / norms[range];
                evidence[range].push((step, log(range, rest)));
            }
            for other in &added {
                if dimension - other.exponent < APART {
                    break;
                }
                let both = self.products(&main, &other.column);
                for &range in &ranges {
                    let (norm, sum, both) = (norms[range], sums[range], both[range]);
                    let (other_norm, other_sum) = (other.norms[range], other.sums[range]);
                    let determinant = norm * other_norm - both * both;
                    let part = (sum * other_norm - other_sum * both) / determinant;
                    let more = (other_sum * norm - sum * both) / determinant;
                    let (share, rest) = (part * fine, more * other.fine);
                    let is_sound = part > 0.0
                        && more * other.coarse[range] > MAX_TAKEN * part * coarse[range]
                        && share >= MIN_SHARE * (share + rest);
                    if is_sound {
                        let left = all[range] - part * sum - more * other_sum;
                        evidence[range].push((step, log(range, left) - price));
                    }
                }
            }
        }
    }
}
