//! Decides whether a system contracts, by bounds of the joint spectral radius of its maps' linear parts.

use std::cmp::Ordering;

use super::{AffineMap, Ifs};
use crate::digraph::loop_of_largest_mean;
use crate::geometry::Linear;
use crate::work;

/// Default limit of the number of products that are formed.
const MAX_PRODUCTS: usize = 100_000;

/// [Work](work) of a product that is formed.
const PRODUCT: usize = 16;

/// Tolerance of comparisons with 1, and of two factors that count as equal.
const ROUNDING: f64 = 1e-12;

/// Relative gain of the lower bound below which a product is not extended.
const SHARE: f64 = 1e-3;

/// Verdict on the contraction of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The system contracts and has one attractor.
    Contracts,
    /// The system does not contract: iterated, the product [`Contraction::word`] does not shrink.
    Diverges,
    /// Products of up to [`Contraction::length`] maps do not decide.
    Undecided,
}

/// Bounds of the joint spectral radius of the maps' linear parts: the least factor such that long products,
/// as far as the digraph admits them, shrink by it with every map.
///
/// The radius is below 1 if and only if the system contracts. A system may contract although single maps of
/// it do not, and may diverge although all of them do.
#[derive(Clone, Debug, PartialEq)]
pub struct Contraction {
    /// Conclusion from the bounds, to within 1e-12.
    pub verdict: Verdict,
    /// Lower bound of the radius: the spectral radius of [`Contraction::word`], to the power 1 / its length.
    pub lower: f64,
    /// Upper bound of the radius: in a norm that was found, every long product falls into pieces, each of
    /// which shrinks by this factor with every map.
    pub upper: f64,
    /// The product that gives the lower bound, in the order in which its maps are applied; the first map may
    /// follow the last. Where the system diverges, no shorter product of at most [`length`](Self::length) maps does so. Empty where all products that
    /// were formed and can be repeated are nilpotent.
    pub word: Vec<usize>,
    /// Length of the longest products that the bounds account for: all products of up to this many maps were
    /// formed, or need not be.
    pub length: u32,
}

impl<M: AffineMap> Ifs<M> {
    /// Determines whether the system contracts, from at most 100 000 products (see
    /// [`Ifs::contraction_within`]) and, if they do not decide, from the ratios of the maps, if a digraph restricts
    /// their order, and from the convex hulls of a disc's images under all products of a length.
    #[must_use]
    pub fn contraction(&self) -> Contraction {
        let (linear, successors) = self.linear();
        Contraction::of::<M>(&linear, successors)
    }

    /// Determines whether the system contracts, from at most `products` products. Single maps are always
    /// formed.
    ///
    /// The algorithm is branch and bound (Gripenberg, "Computing the joint spectral radius", 1996),
    /// restricted to the words that the digraph admits, in an ellipsoidal norm in which the maps stretch
    /// little. The spectral radius of a product that can be repeated bounds from below, norms bound from
    /// above, and a product of which some beginning shrinks below the lower bound is not extended.
    #[must_use]
    pub fn contraction_within(&self, products: usize) -> Contraction {
        let (linear, successors) = self.linear();
        Contraction::within::<M>(&linear, successors, products)
    }

    /// Returns the linear parts, and for each map the maps that may follow it, in ascending order; `None` if
    /// any map may follow any.
    fn linear(&self) -> (Vec<M::Linear>, Option<Vec<Vec<usize>>>) {
        let linear = self.maps().iter().map(|map| map.affine.linear());
        let mut successors = self.successors();
        for list in successors.iter_mut().flatten() {
            list.sort_unstable();
        }
        (linear.collect(), successors)
    }
}

impl Contraction {
    /// Determines whether linear maps contract. `successors` lists the maps that may follow each; with `None`
    /// any map may follow any.
    pub(crate) fn of<M: AffineMap>(
        linear: &[M::Linear],
        successors: Option<Vec<Vec<usize>>>,
    ) -> Self {
        let mut contraction = Self::within::<M>(linear, successors.clone(), MAX_PRODUCTS);
        if let (Verdict::Undecided, Some(lists)) = (contraction.verdict, &successors) {
            contraction.decide_by_ratios(linear, lists);
        }
        if contraction.verdict == Verdict::Undecided {
            let mut images = Vec::new();
            match successors {
                Some(lists) => {
                    images.resize(linear.len(), Vec::new());
                    for (map, successors) in lists.iter().enumerate() {
                        for &next in successors {
                            images[next].push((linear[next], map));
                        }
                    }
                }
                None => images.push(linear.iter().map(|&linear| (linear, 0)).collect()),
            }
            if let Some((length, stretch)) = M::shrinking(&images) {
                let factor = libm::pow(stretch, 1.0 / f64::from(length));
                contraction.verdict = Verdict::Contracts;
                contraction.upper = contraction.upper.min(factor).max(contraction.lower);
                contraction.length = contraction.length.max(length);
            }
        }
        contraction
    }

    /// Decides by the repeated product of largest ratio, which may be long: all products of similarities are decided. The
    /// spectral radius of a product is at least the product of the maps' [mean ratios](Linear::mean_ratio), and at most that
    /// of their stretches.
    fn decide_by_ratios<L: Linear>(&mut self, linear: &[L], successors: &[Vec<usize>]) {
        let largest = |ratio: fn(&L) -> f64| {
            let logarithms: Vec<f64> = linear.iter().map(|map| libm::log(ratio(map))).collect();
            loop_of_largest_mean(&logarithms, successors)
        };
        let Some(found) = largest(L::mean_ratio) else {
            return;
        };
        let factor = libm::exp(found.mean);
        if factor >= 1.0 - ROUNDING {
            let mut word = found.vertices;
            let start = least_rotation(&word);
            word.rotate_left(start);
            self.verdict = Verdict::Diverges;
            self.lower = factor.max(self.lower);
            self.upper = self.upper.max(self.lower);
            self.word = word;
            return;
        }
        let most = largest(L::stretch).map(|found| libm::exp(found.most));
        if let Some(upper) = most.filter(|most| *most < 1.0 - ROUNDING / 2.0) {
            self.verdict = Verdict::Contracts;
            self.upper = self.upper.min(upper).max(self.lower);
        }
    }

    /// Determines the same from at most `products` products. The lists of successors are in ascending order.
    fn within<M: AffineMap>(
        linear: &[M::Linear],
        successors: Option<Vec<Vec<usize>>>,
        products: usize,
    ) -> Self {
        let search = Search {
            all: (0..linear.len()).collect(),
            matrices: [M::in_best_coordinates(linear), linear.to_vec()],
            successors,
        };
        search.run(products)
    }
}

struct Search<L> {
    /// The linear maps in the coordinates of the norm and in the given ones.
    matrices: [Vec<L>; 2],
    all: Vec<usize>,
    /// The maps that may follow each, in ascending order.
    successors: Option<Vec<Vec<usize>>>,
}

/// A product that is extended by further maps.
#[derive(Clone, Copy)]
struct Product<L> {
    /// Matrices of the product in the coordinates of the norm and in the given ones, where eigenvalues keep
    /// more digits; both are to be multiplied by 2 to the power `exponent`.
    matrices: [L; 2],
    exponent: i32,
    /// The least value of norm to the power 1 / length over the product's beginnings.
    factor: f64,
    first: usize,
    last: usize,
    /// Index in the list of followed products of the product that is one map shorter.
    beginning: Option<usize>,
}

impl<L> Product<L> {
    /// Returns `size` · 2^`exponent` to the power 1 / length, where `size` is a norm or spectral radius of
    /// the scaled matrix.
    fn root(&self, size: f64, length: u32) -> f64 {
        if length == 1 {
            return libm::scalbn(size, self.exponent);
        }
        let logarithm = libm::log(size) + f64::from(self.exponent) * std::f64::consts::LN_2;
        libm::exp(logarithm / f64::from(length))
    }
}

/// The closed product with the largest spectral radius, to the power 1 / length, so far.
#[derive(Default)]
struct Best {
    factor: f64,
    last: usize,
    beginning: Option<usize>,
}

impl<L: Linear> Search<L> {
    fn run(&self, budget: usize) -> Contraction {
        let mut formed = 0;
        let mut length = 0;
        let mut best = Best::default();
        // The largest factor of the products that are not extended.
        let mut dropped: f64 = 0.0;
        let mut upper = f64::INFINITY;
        let mut followed: Vec<Product<L>> = Vec::new();
        let mut level = 0..0;
        'lengths: loop {
            let longer = length + 1;
            let mut next = Vec::new();
            let beginnings: Vec<Option<usize>> = match longer {
                1 => vec![None],
                _ => level.clone().map(Some).collect(),
            };
            for beginning in beginnings {
                let before = beginning.map(|index| followed[index]);
                for &map in self.successors(before.map(|product| product.last)) {
                    if formed >= budget && longer > 1 {
                        break 'lengths;
                    }
                    formed += 1;
                    let Some(product) = self.extended(before, beginning, map, longer) else {
                        continue;
                    };
                    if self.may_follow(map, product.first) {
                        best.try_product(&product, longer);
                    }
                    next.push(product);
                }
            }
            length = longer;
            let bound = best.bound();
            let (kept, short): (Vec<Product<L>>, Vec<Product<L>>) =
                next.into_iter().partition(|product| product.factor > bound);
            dropped = largest(dropped, &short);
            upper = largest(dropped, &kept);
            if kept.is_empty() || best.diverges() {
                break;
            }
            level = followed.len()..followed.len() + kept.len();
            followed.extend(kept);
        }
        work::count(PRODUCT * formed);
        let upper = upper.max(best.factor);
        let verdict = if best.diverges() {
            Verdict::Diverges
        } else if upper < 1.0 - ROUNDING / 2.0 {
            Verdict::Contracts
        } else {
            Verdict::Undecided
        };
        Contraction {
            verdict,
            lower: best.factor,
            upper,
            word: best.word(&followed),
            length,
        }
    }

    fn successors(&self, last: Option<usize>) -> &[usize] {
        match (&self.successors, last) {
            (Some(successors), Some(last)) => &successors[last],
            _ => &self.all,
        }
    }

    fn may_follow(&self, last: usize, next: usize) -> bool {
        let successors = self.successors.as_ref();
        successors.is_none_or(|lists| lists[last].binary_search(&next).is_ok())
    }

    /// Returns the product with one more map; `None` if it is zero.
    fn extended(
        &self,
        before: Option<Product<L>>,
        beginning: Option<usize>,
        map: usize,
        length: u32,
    ) -> Option<Product<L>> {
        let before = before.unwrap_or(Product {
            matrices: [L::IDENTITY; 2],
            exponent: 0,
            factor: f64::INFINITY,
            first: map,
            last: map,
            beginning: None,
        });
        let [normed, given] = [0, 1].map(|of| self.matrices[of][map] * before.matrices[of]);
        let size = normed.stretch();
        if size < f64::MIN_POSITIVE {
            return None;
        }
        // Long products leave the range of a double; powers of two take no digits.
        let exponent = if size.is_finite() {
            libm::ilogb(size)
        } else {
            0
        };
        let scale = libm::scalbn(1.0, -exponent);
        let mut product = Product {
            matrices: [normed * scale, given * scale],
            exponent: before.exponent + exponent,
            last: map,
            beginning,
            ..before
        };
        product.factor = product.root(size * scale, length).min(before.factor);
        Some(product)
    }
}

fn largest<L>(least: f64, products: &[Product<L>]) -> f64 {
    products
        .iter()
        .map(|product| product.factor)
        .fold(least, f64::max)
}

impl Best {
    fn try_product<L: Linear>(&mut self, product: &Product<L>, length: u32) {
        let factor = product.root(product.matrices[1].spectral_radius(), length);
        // Of several that are equal but for rounding, the first is kept.
        if factor > self.factor * (1.0 + ROUNDING) {
            *self = Self {
                factor,
                last: product.last,
                beginning: product.beginning,
            };
        }
    }

    fn diverges(&self) -> bool {
        self.factor >= 1.0 - ROUNDING
    }

    /// Returns the factor up to which products are not extended. Products that may diverge always are.
    fn bound(&self) -> f64 {
        let bound = self.factor * (1.0 + SHARE);
        if self.diverges() {
            bound
        } else {
            bound.min(1.0 - ROUNDING)
        }
    }

    /// Returns the best product as the lexicographically least of its rotations.
    fn word<L>(&self, followed: &[Product<L>]) -> Vec<usize> {
        if self.factor == 0.0 {
            return Vec::new();
        }
        let mut word = vec![self.last];
        let mut beginning = self.beginning;
        while let Some(index) = beginning {
            word.push(followed[index].last);
            beginning = followed[index].beginning;
        }
        word.reverse();
        let start = least_rotation(&word);
        word.rotate_left(start);
        word
    }
}

/// Returns where the lexicographically least rotation of a word begins.
///
/// Two places are compared letter by letter. Where the words from them differ after `equal` letters, none of the `equal + 1`
/// places from the one with the larger letter on begins the least rotation: the number of steps is in proportion to the length.
fn least_rotation(word: &[usize]) -> usize {
    let letter = |at: usize| word[at % word.len()];
    let (mut best, mut other, mut equal) = (0, 1, 0);
    while best.max(other) < word.len() && equal < word.len() {
        match letter(best + equal).cmp(&letter(other + equal)) {
            Ordering::Equal => {
                equal += 1;
                continue;
            }
            Ordering::Less => other += equal + 1,
            Ordering::Greater => best += equal + 1,
        }
        if best == other {
            other += 1;
        }
        equal = 0;
    }
    best.min(other)
}

#[cfg(test)]
mod tests {
    use super::least_rotation;

    #[test]
    fn the_least_rotation_is_that_of_all() {
        // All words of up to nine letters of three, and long ones that repeat.
        for length in 1..=9 {
            for number in 0..3_usize.pow(length) {
                let letters = (0..length).map(|at| number / 3_usize.pow(at) % 3);
                let word: Vec<usize> = letters.collect();
                let turned = |by: usize| [&word[by..], &word[..by]].concat();
                let least = (0..word.len()).map(turned).min().unwrap();
                assert_eq!(turned(least_rotation(&word)), least, "{word:?}");
            }
        }
        assert_eq!(least_rotation(&vec![0; 1_000_000]), 0);
        let mut word = vec![1; 1_000_000];
        word[999_999] = 0;
        assert_eq!(least_rotation(&word), 999_999);
    }
}
