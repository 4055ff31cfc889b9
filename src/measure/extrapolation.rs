//! Dimensions of pictures: a power is told from what pens and coarse boxes add to it.
//!
//! The mean number of boxes of side s that meet a set is N(s) = A s^-D + B s^-d + 1: the power that
//! is looked for, those of rims and of what pieces share, and the last box (of a convex shape, after
//! Steiner, N = a / s² + p / s + 1; of a curve of four similar parts, whose neighbours share a box,
//! N(s) − 1 = 4 (N(3 s) − 1)). A pen of a width of w more pixels than one makes all of the set larger,
//! N(s) of the set being the area at s − w; how wide it may be, the picture's thickness bounds.
//!
//! The residuals of such a model, such as the waves of a self-similar set, are correlated between
//! neighbouring sizes: they are an autoregression of the first order in ln s, of a size that is told
//! from the data, but no less than some hundredth; it may be larger for coarse boxes, of which a few hold
//! the whole set. D is the mean over all models by their likelihood, and its error their spread: where
//! slopes drift, other powers explain them as well, and the error is large.
//!
//! No power stands for a length of the set itself, as the distance between turns of a spiral is: its
//! counts are those of a curve below, and those of an area above. Models are fitted to several ranges for
//! that reason, up to a quarter of the long side or to less of it, and D is the mean over these as well. The
//! counts that a range leaves out are told by no model, but for some hundredths, and are the less likely for
//! it; neighbouring ones go together, and count in part only (averages over ranges: Jay & Neil 2021).

use super::raster::Mean;
use super::regression::Estimate;

/// Dimensions that are tried: so many steps from 0 to that of the plane.
const STEPS: u16 = 400;
const STEP: f64 = 2.0 / STEPS as f64;

/// Exponents d of what is added.
const ADDED: std::ops::Range<i32> = 0..14;
const ADDED_STEP: f64 = 0.15;

/// The least difference D − d.
const APART: f64 = 0.03;

/// The least coefficient of the added power, as a share of the main one at the coarsest size.
const MOST_TAKEN: f64 = -0.9;
/// The least share of the main power in the count at the finest size.
const LEAST_SHARE: f64 = 0.7;

/// The finest boxes in pixels, and the coarsest of every range as a part of the long side.
const FINEST: f64 = 3.0;
const COARSEST: [f64; RANGES] = [0.015625, 0.03125, 0.0625, 0.125, LARGEST];
const LARGEST: f64 = 0.25;
const RANGES: usize = 5;

/// The relative error with which counts that a range leaves out are taken to be known.
const LEFT_OUT: f64 = 0.03;

/// The part of the logarithm of a range's likelihood that counts: neighbouring sizes go together.
const COUNTED: f64 = 0.3;

/// Of so many sizes, a dimension can be told.
const LEAST_SIZES: usize = 5;

/// The natural logarithm of sizes over which what is left goes together.
const TOGETHER: f64 = 1.0;

/// By how much more coarse boxes are off than those of middle sizes.
const ROUGH: [f64; 2] = [3.0, 9.0];

/// An error that is always left: that of the steps.
const LEAST_ERROR: f64 = 0.003;

/// Sets of a larger thickness are filled: no pen has drawn their lines.
const FILLED: f64 = 4.5;

/// The prior distribution.
struct Belief {
    /// Widths of the pen beyond a pixel.
    pens: Vec<f64>,
    finest: f64,
    /// The least part of the counts that a model leaves.
    left: f64,
    /// How much likelier D = 2 is than an interval of D with a length of 1.
    whole: f64,
}

impl Belief {
    /// By the thickness of a picture.
    fn of(thickness: f64) -> Self {
        /// Of pixels that are half full at least, of lines of one pixel, and of pixels that a point of the
        /// set lies in.
        const NONE: [f64; 3] = [-0.6, -0.3, -0.1];
        if thickness >= FILLED {
            return Self {
                pens: NONE.into_iter().chain([0.1, 0.6]).collect(),
                finest: 1.0,
                left: 0.012,
                whole: 1.0,
            };
        }
        // A pen that is w + 1 pixels wide leaves a thickness from w to 1.25 w, and what lies close
        // together makes it larger.
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

/// Columns of a regression, with what goes together taken out of neighbouring entries.
struct Whitened {
    /// The error of every entry.
    scale: Vec<f64>,
    /// How much of an entry goes on in the next one.
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

    /// The logarithm of the determinant of what is taken out of so many entries, but for a constant.
    fn volume(&self, entries: usize) -> f64 {
        self.scale[..entries]
            .iter()
            .map(|scale| libm::log(*scale))
            .sum()
    }
}

/// The dimension of a picture from mean counts, from the smallest boxes on; none if there are too few.
pub(super) fn extrapolated(means: &[Mean], longest: f64, thickness: f64) -> Option<Estimate> {
    let belief = Belief::of(thickness);
    let used = |mean: &&Mean| mean.size >= belief.finest && mean.size <= longest * LARGEST;
    let means: Vec<Mean> = means.iter().filter(used).copied().collect();
    let up_to = |part: f64| means.partition_point(|mean| mean.size <= longest * part);
    let ends = COARSEST.map(up_to);
    let sizes: Vec<f64> = means.iter().map(|mean| mean.size).collect();
    let mut told = ends.map(|_| Vec::new());
    for rough in ROUGH {
        let whitened = Whitened::new(&sizes, longest, rough);
        for &pen in &belief.pens {
            Models::new(&means, ends, pen, &whitened, belief.left).tell(&mut told);
        }
    }
    let ranges: Vec<Range> = std::iter::zip(ends, &told)
        .filter_map(|(sizes, told)| Range::of(sizes, told, belief.whole))
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "sizes are few")]
    let sizes = |range: &Range| range.sizes as f64;
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
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the number of sizes"
    )]
    let sizes = mean(&sizes).round() as usize;
    Some(Estimate {
        value: value + 0.0,
        std_error: libm::hypot(spread.sqrt(), LEAST_ERROR),
        range: [means[0].size, means[sizes - 1].size],
        r_squared: 1.0,
        intercept: 0.0,
        sizes,
    })
}

/// A model of a range: the step of its dimension, and the logarithm of its likelihood.
type Told = (u16, f64);

/// The estimate of the dimension by a range of sizes.
struct Range {
    sizes: usize,
    /// The logarithm of its likelihood.
    log: f64,
    mean: f64,
    variance: f64,
}

impl Range {
    /// From its models, and how much likelier D = 2 is than an interval; none if there is no model.
    fn of(sizes: usize, told: &[Told], whole: f64) -> Option<Self> {
        /// Less likely models do not count.
        const LEAST_LOG: f64 = -40.0;
        let best = told.iter().map(|it| it.1).max_by(f64::total_cmp)?;
        let mut weights = vec![0.0; usize::from(STEPS) + 1];
        for &(step, log) in told.iter().filter(|it| it.1 > best + LEAST_LOG) {
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
    /// Of every size: the logarithm of the side that the set has been covered by, as a part of the
    /// coarsest, and the count without the last box.
    logs: Vec<f64>,
    counts: Vec<f64>,
    wanted: Vec<f64>,
    /// The number of sizes of every range.
    ends: [usize; RANGES],
    left: f64,
}

/// A second power.
struct Added {
    exponent: f64,
    column: Vec<f64>,
    norms: [f64; RANGES],
    sums: [f64; RANGES],
    /// At the coarsest size of every range, and at the finest.
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

    /// A power by size: without the rest, and at the ends.
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

    /// The last entry of every range that has one.
    fn last(&self, power: &[f64]) -> [f64; RANGES] {
        self.ends
            .map(|end| end.checked_sub(1).map_or(1.0, |last| power[last]))
    }

    /// The inner products of two columns over every range.
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

    /// Adds every model to those of its range.
    fn tell(&self, told: &mut [Vec<Told>; RANGES]) {
        let ranges: Vec<usize> = (0..RANGES)
            .filter(|&it| self.ends[it] >= LEAST_SIZES)
            .collect();
        #[expect(clippy::cast_precision_loss, reason = "sizes are few")]
        let sizes = self.ends.map(|end| end as f64);
        let volumes = self.ends.map(|end| self.whitened.volume(end));
        let log = |range: usize, rest: f64| {
            let left = rest.max(0.0) / sizes[range] + self.left * self.left;
            -sizes[range] / 2.0 * libm::log(left) - volumes[range]
        };
        let added: Vec<Added> = ADDED
            .map(|number| self.added(f64::from(number) * ADDED_STEP))
            .collect();
        // A second power costs as much as its number of choices, and a part of its likelihood.
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
                told[range].push((step, log(range, rest)));
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
                        && more * other.coarse[range] > MOST_TAKEN * part * coarse[range]
                        && share >= LEAST_SHARE * (share + rest);
                    if is_sound {
                        let left = all[range] - part * sum - more * other_sum;
                        told[range].push((step, log(range, left) - price));
                    }
                }
            }
        }
    }
}
