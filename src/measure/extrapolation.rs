//! Dimensions of pictures: a power is told from what pens and coarse boxes add to it.
//!
//! The mean number of boxes of side s that meet a set is N(s) = A s^-D + B s^-d + 1: the power that
//! is looked for, those of rims and of what pieces share, and the last box (of a convex shape, after
//! Steiner, N = a / s² + p / s + 1; of a curve of four similar parts, whose neighbours share a box,
//! N(s) − 1 = 4 (N(3 s) − 1)). A pen of a width of w more pixels than one makes all of the set larger,
//! N(s) of the set being the area at s − w; how wide it may be, the picture's thickness bounds.
//!
//! What such a model leaves, such as the waves of a set that repeats itself, goes together at
//! neighbouring sizes: it is an autoregression of the first order in ln s, of a size that is told
//! from the data, but no less than some hundredth; it may be larger for coarse boxes, of which a few hold
//! the whole set. D is the mean over all models by their likelihood, and its error their spread: where
//! slopes drift, other powers explain them as well, and the error is large.

use super::raster::Mean;
use super::regression::Estimate;

/// Dimensions that are tried: so many steps from 0 to that of the plane.
const STEPS: i32 = 400;
const STEP: f64 = 2.0 / STEPS as f64;

/// Exponents d of what is added.
const ADDED: std::ops::Range<i32> = 0..14;
const ADDED_STEP: f64 = 0.15;

/// How far d is below D at least.
const APART: f64 = 0.03;

/// What is added is at most so much of the power at the coarsest size, where it is taken away, and
/// leaves it so much of the count at the finest size.
const MOST_TAKEN: f64 = -0.9;
const LEAST_SHARE: f64 = 0.5;

/// The finest boxes in pixels, and the coarsest as a part of the long side.
const FINEST: f64 = 3.0;
const COARSEST: f64 = 0.25;

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

/// What is believed before counts are looked at.
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
            left: 0.008,
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
            let coarse = rough * size / (longest * COARSEST);
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

    /// The logarithm of the determinant of what is taken out, but for a constant.
    fn volume(&self) -> f64 {
        self.scale.iter().map(|scale| libm::log(*scale)).sum()
    }
}

/// The dimension of a picture from mean counts, from the smallest boxes on; none if there are too few.
pub(super) fn extrapolated(means: &[Mean], longest: f64, thickness: f64) -> Option<Estimate> {
    let belief = Belief::of(thickness);
    let used = |mean: &&Mean| mean.size >= belief.finest && mean.size <= longest * COARSEST;
    let means: Vec<Mean> = means.iter().filter(used).copied().collect();
    if means.len() < LEAST_SIZES {
        return None;
    }
    let sizes: Vec<f64> = means.iter().map(|mean| mean.size).collect();
    let mut likelihoods: Vec<(i32, f64)> = Vec::new();
    for rough in ROUGH {
        let whitened = Whitened::new(&sizes, longest, rough);
        for &pen in &belief.pens {
            let mut models = Models::new(&means, pen, &whitened, belief.left);
            models.tell(&mut likelihoods);
        }
    }
    let best = likelihoods.iter().map(|it| it.1);
    let best = best.fold(f64::NEG_INFINITY, f64::max);
    let mean = |of: &dyn Fn(f64) -> f64| {
        let (mut sum, mut all) = (0.0, 0.0);
        for &(step, log) in &likelihoods {
            let prior = if step == STEPS {
                1.0 + belief.whole / STEP
            } else {
                1.0
            };
            let weight = prior * libm::exp(log - best);
            sum += weight * of(f64::from(step) * STEP);
            all += weight;
        }
        sum / all
    };
    let value = mean(&|dimension| dimension);
    let spread = mean(&|dimension| (dimension - value) * (dimension - value));
    Some(Estimate {
        value: value + 0.0,
        std_error: libm::hypot(spread.sqrt(), LEAST_ERROR),
        range: [sizes[0], sizes[sizes.len() - 1]],
        r_squared: 1.0,
        intercept: 0.0,
        sizes: sizes.len(),
    })
}

/// All models with one pen.
struct Models<'a> {
    whitened: &'a Whitened,
    /// Of every size: the logarithm of the side that the set has been covered by, as a part of the
    /// coarsest, and the count without the last box.
    logs: Vec<f64>,
    counts: Vec<f64>,
    wanted: Vec<f64>,
    left: f64,
}

impl<'a> Models<'a> {
    fn new(means: &[Mean], pen: f64, whitened: &'a Whitened, left: f64) -> Self {
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
            left,
        }
    }

    fn power(&self, exponent: f64) -> Vec<f64> {
        self.whitened
            .column(|number| libm::exp(-exponent * self.logs[number]) / self.counts[number])
    }

    /// Adds the logarithm of the likelihood of every model, with the step of its dimension.
    fn tell(&mut self, likelihoods: &mut Vec<(i32, f64)>) {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        #[expect(clippy::cast_precision_loss, reason = "sizes are few")]
        let sizes = self.wanted.len() as f64;
        let volume = self.whitened.volume();
        let log = |rest: f64| {
            let left = rest.max(0.0) / sizes + self.left * self.left;
            -sizes / 2.0 * libm::log(left) - volume
        };
        let added: Vec<(f64, Vec<f64>)> = ADDED
            .map(|number| f64::from(number) * ADDED_STEP)
            .map(|exponent| (exponent, self.power(exponent)))
            .collect();
        // A second power costs as much as its number of choices, and a part of its likelihood.
        let price = 3.0 + libm::log(f64::from(ADDED.end));
        let all = dot(&self.wanted, &self.wanted);
        let finest = -self.logs[0];
        for step in 1..=STEPS {
            let dimension = f64::from(step) * STEP;
            let main = self.power(dimension);
            let (norm, sum) = (dot(&main, &main), dot(&main, &self.wanted));
            likelihoods.push((step, log(all - sum * sum / norm)));
            for (exponent, other) in &added {
                if dimension - exponent < APART {
                    break;
                }
                let (other_norm, both) = (dot(other, other), dot(&main, other));
                let other_sum = dot(other, &self.wanted);
                let determinant = norm * other_norm - both * both;
                let part = (sum * other_norm - other_sum * both) / determinant;
                let more = (other_sum * norm - sum * both) / determinant;
                let share = part * libm::exp(dimension * finest);
                let rest = more * libm::exp(exponent * finest);
                let is_sound =
                    part > 0.0 && more > MOST_TAKEN * part && share >= LEAST_SHARE * (share + rest);
                if is_sound {
                    let left = all - part * sum - more * other_sum;
                    likelihoods.push((step, log(left) - price));
                }
            }
        }
    }
}
