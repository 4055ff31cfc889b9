//! The growth of the mass about a measure's points with the size of balls: its moments.
//!
//! With the mass M of the ball of radius ε about a point of the measure, the mean of M^(q − 1) over all
//! points scales as ε^((q − 1) D_q) (Hentschel & Procaccia 1983; Pawelzik & Schuster 1987). Boxes of a grid
//! that are hardly met have small masses, which make sums of negative orders worthless. Balls about points of
//! the measure avoid this: they are enlarged boxes in the sense of Riedi (1995).
//!
//! Masses follow from the graph: the set is divided into *pieces*, copies that are small compared with a
//! ball, and the mass of a piece counts at its centre. Pieces are divided repeatedly, together with the
//! copies near them. Where there are too many, some represent the others (*splitting*: Kahn & Harris 1951).
//! These are spread evenly over the set, and chosen with a probability that grows with a piece's share of any
//! of the sums; the masses of their balls remain as exact.

use std::num::NonZero;

use crate::geometry::Point;
use crate::measure::regression::Reading;
use crate::measure::space::Space;
use crate::measure::statistics::{differences, mean, readings};
use crate::parallel::map;
use crate::saturating::real;

use super::{Cascade, LimitCopy, merge};

/// Maximum radius of a piece, relative to that of a ball. The resulting blur of the balls is the same at all
/// sizes.
const SMALL: f64 = 1.0;

/// Number of copies of one size that are examined; more for orders below 0, which depend on rare pieces.
const FOLLOWED_COPIES: [usize; 2] = [1 << 14, 1 << 15];

/// Minimum number of pieces that are divided. As long as there are fewer, sums are over all pieces.
const FOLLOWED: usize = 1 << 4;

/// Maximum number of copies of one size, and of all sizes, that are examined: where too many overlap, the
/// descent ends.
const MAX_COPIES: usize = 1 << 19;
const MAX_OF_ALL: usize = 3 << 19;

/// Number of distances between pieces that cost as much as examining a copy.
const DISTANCES: usize = 8;

/// Number of sizes, in the plane and in space, at which pieces are chosen before the first that is measured: in
/// space, the pieces of a set in its largest balls are too many.
const AHEAD: [u8; 2] = [0, 2];

/// Size of the smallest balls, as a fraction of the extent: doubles still resolve six digits of them.
const FINEST: f64 = 1.0 / (1u64 << 28) as f64;

/// Number of copies near each other from which equal ones are joined.
const MANY: usize = 64;

/// Entropies of several orders at several sizes.
pub(in crate::measure) struct Moments {
    /// Sizes, from the largest on.
    pub(in crate::measure) sizes: Vec<f64>,
    /// Entropies by series, size and order.
    entropies: Vec<Vec<Vec<f64>>>,
}

impl Moments {
    /// Computes the entropies in balls from about half the extent on, each smaller than those before by the
    /// factor `base`, as far as masses can be computed. The sizes of several series are spread evenly between
    /// one size and the next: oscillations that are periodic in the logarithm of the size cancel in their
    /// mean.
    pub(in crate::measure) fn of<M: Space>(
        cascade: &Cascade<M>,
        orders: &[f64],
        base: f64,
        series: NonZero<usize>,
        threads: NonZero<usize>,
    ) -> Self {
        let extent = cascade.set.bounds().size().max_element();
        let first = extent / 2.0;
        let sizes = std::iter::successors(Some(first), |size| Some(size / base));
        let sizes: Vec<f64> = sizes.take_while(|size| *size > FINEST * extent).collect();
        let parts = (0..series.get()).map(|number| real(number) / real(series.get()));
        let parts: Vec<f64> = parts.collect();
        let entropies = map(&parts, threads.get(), |_, &part| {
            let size = first * libm::pow(base, -part);
            let ahead = libm::pow(base, AHEAD[M::Point::DIMENSION - 2].into());
            let mut descent = Descent::new(cascade, orders, size / 2.0 * ahead, part);
            for _ in 0..AHEAD[M::Point::DIMENSION - 2] {
                descent.go_down(base);
            }
            let mut entropies = Vec::new();
            for number in 0..sizes.len() {
                if number > 0 {
                    descent.go_down(base);
                }
                match descent.entropies() {
                    Some(found) => entropies.push(found),
                    None => break,
                }
            }
            entropies
        });
        let found = entropies.iter().map(Vec::len).min().unwrap_or_default();
        let mean_part = libm::pow(base, -mean(&parts));
        let sizes = sizes[..found].iter().map(|size| size * mean_part);
        Self {
            sizes: sizes.collect(),
            entropies,
        }
    }

    /// Returns the readings of a regression for the order with an index; sizes at which an entropy is not
    /// finite are left out.
    pub(in crate::measure) fn readings(&self, order: usize) -> Vec<Reading> {
        let by_series = |size: usize| -> Vec<f64> {
            let entropies = self.entropies.iter();
            entropies.map(|sizes| sizes[size][order]).collect()
        };
        let all = self.sizes.iter().enumerate();
        let all = all.map(|(number, &size)| (size, by_series(number)));
        readings(all, |logs, last| {
            let growth: Vec<f64> = differences(logs, last).collect();
            [mean(logs), mean(&growth)]
        })
    }
}

/// A copy and its mass.
type Massive<M> = (LimitCopy<M>, f64);

/// A piece, on a scale on which balls have the radius 1.
struct MassPiece<M> {
    copy: LimitCopy<M>,
    /// Copies that a ball about any point of the piece may contain, including the piece itself.
    near: Vec<Massive<M>>,
    /// Logarithms of the mass of the piece, and of the mass of the ball about its centre.
    logs: [f64; 2],
    /// Logarithm of the number of pieces that it represents.
    weight: f64,
}

/// A small copy, with its mass, its centre of mass, and a disc that holds it.
struct Small<M: Space> {
    copy: LimitCopy<M>,
    mass: f64,
    centre: M::Point,
    middle: M::Point,
    radius: f64,
}

/// The pieces of the present size, and the effort that they took.
struct Descent<'c, M: Space> {
    cascade: &'c Cascade<M>,
    orders: &'c [f64],
    pieces: Vec<MassPiece<M>>,
    /// Offset of the pieces that are chosen next, from 0 to 1.
    place: f64,
    /// Number of copies that were examined for the pieces of this size, and of larger pieces that were
    /// divided.
    looked_at: usize,
    divided: usize,
    /// Number of copies that were examined for all larger sizes.
    before: usize,
}

impl<'c, M: Space> Descent<'c, M> {
    fn new(cascade: &'c Cascade<M>, orders: &'c [f64], radius: f64, place: f64) -> Self {
        let start = cascade.set.start.iter().zip(&cascade.start);
        let near = start.map(|(copy, &mass)| {
            let mut copy = *copy;
            copy.grow(1.0 / radius);
            (copy, mass)
        });
        let mut descent = Self {
            cascade,
            orders,
            pieces: Vec::new(),
            place,
            looked_at: 0,
            divided: 1,
            before: 0,
        };
        let near: Vec<Massive<M>> = near.collect();
        let all = descent.small(near.clone(), |_, _| true);
        let smaller = descent.small(near, |_, _| true);
        descent.pieces = descent.with_near(&smaller, &all, 0.0);
        descent
    }

    /// Returns −ln (mean of M^(q − 1)) / (q − 1) for every order q, and the mean of −ln M for order 1.
    /// Returns `None` where too many copies overlap.
    fn entropies(&self) -> Option<Vec<f64>> {
        let all = self.before + self.looked_at;
        if self.looked_at > MAX_COPIES || all > MAX_OF_ALL || self.pieces.is_empty() {
            return None;
        }
        let mass = log_sum(self.pieces.iter().map(|piece| piece.share(1.0)));
        let of = |&order: &f64| {
            let power = order - 1.0;
            if power.abs() < 1e-9 {
                let logs = self.pieces.iter();
                let logs = logs.map(|it| libm::exp(it.share(1.0) - mass) * it.logs[1]);
                return -logs.sum::<f64>();
            }
            let sum = log_sum(self.pieces.iter().map(|piece| piece.share(order)));
            (mass - sum) / power
        };
        Some(self.orders.iter().map(of).collect())
    }

    /// Continues with balls smaller by the factor `base`.
    fn go_down(&mut self, base: f64) {
        if self.looked_at > MAX_COPIES {
            self.pieces.clear();
            return;
        }
        self.choose();
        self.before += self.looked_at;
        self.looked_at = 0;
        self.divided = self.pieces.len();
        let mut pieces = Vec::new();
        for mut piece in std::mem::take(&mut self.pieces) {
            piece.copy.grow(base);
            piece.near.iter_mut().for_each(|(copy, _)| copy.grow(base));
            let (middle, radius) = self.disc(&piece.copy);
            let mass = libm::exp(piece.logs[0]);
            let smaller = self.small(vec![(piece.copy, mass)], |_, _| true);
            let near = self.small(piece.near, |at, reach| {
                squared(at - middle) <= (radius + reach + 1.0) * (radius + reach + 1.0)
            });
            let weight = piece.weight;
            pieces.append(&mut self.with_near(&smaller, &near, weight));
            if self.looked_at > MAX_COPIES {
                break;
            }
        }
        self.pieces = pieces;
    }

    /// Keeps some of the pieces, if there are too many. The probability of a piece is proportional to its
    /// largest share of the sum of any order, at present or as if it were isolated, as its parts will be in
    /// smaller balls. Pieces whose share is so large that no other can represent them are always kept.
    fn choose(&mut self) {
        let needs_rare = self.orders.iter().any(|order| *order < 0.0);
        let work = FOLLOWED_COPIES[usize::from(needs_rare)];
        let most = (self.divided * work / self.looked_at.max(1)).max(FOLLOWED);
        if self.pieces.len() <= most {
            return;
        }
        let mut parts = vec![0.0; self.pieces.len()];
        for &order in self.orders.iter().chain(&[0.0, 1.0]) {
            for share in [MassPiece::share, MassPiece::own_share] {
                let sum = log_sum(self.pieces.iter().map(|piece| share(piece, order)));
                for (part, piece) in parts.iter_mut().zip(&self.pieces) {
                    *part = f64::max(*part, libm::exp(share(piece, order) - sum));
                }
            }
        }
        let chances = real(most) / parts.iter().sum::<f64>();
        let mut passed = self.place;
        self.place = (self.place + GOLDEN).fract();
        let mut parts = parts.into_iter();
        self.pieces.retain_mut(|piece| {
            let chance = f64::min(1.0, parts.next().unwrap_or(0.0) * chances);
            let before = passed.floor();
            passed += chance;
            piece.weight -= libm::log(chance);
            chance >= 1.0 || passed.floor() > before
        });
    }

    /// Returns a disc that holds a copy.
    fn disc(&self, copy: &LimitCopy<M>) -> (M::Point, f64) {
        let part = &self.cascade.set.objects[copy.object];
        (copy.map.apply(part.middle), part.reach * copy.scale)
    }

    /// Returns the small copies that copies are made of, without those whose discs `keep` rejects.
    fn small(
        &mut self,
        mut stack: Vec<Massive<M>>,
        keep: impl Fn(M::Point, f64) -> bool,
    ) -> Vec<Small<M>> {
        let cascade = self.cascade;
        let mut small = Vec::new();
        stack.reverse();
        while let Some((copy, mass)) = stack.pop() {
            self.looked_at += 1;
            if self.looked_at > MAX_COPIES {
                break;
            }
            let (middle, radius) = self.disc(&copy);
            if !keep(middle, radius) {
                continue;
            }
            if radius > SMALL {
                let part = &cascade.set.objects[copy.object];
                let inner = part.children.iter().zip(&cascade.shares[copy.object]);
                let inner = inner.rev();
                stack.extend(inner.map(|(inner, share)| (copy.compose(inner), mass * share)));
                continue;
            }
            small.push(Small {
                copy,
                mass,
                centre: copy.map.apply(cascade.centres[copy.object]),
                middle,
                radius,
            });
        }
        if small.len() >= MANY {
            merge(&mut small, |it| &it.copy, |same, it| same.mass += it.mass);
        }
        small
    }

    /// Returns pieces with the copies near them; `all` contains the pieces.
    fn with_near(
        &mut self,
        pieces: &[Small<M>],
        all: &[Small<M>],
        weight: f64,
    ) -> Vec<MassPiece<M>> {
        self.looked_at += pieces.len() * all.len() / DISTANCES;
        if self.looked_at > MAX_COPIES {
            return Vec::new();
        }
        let with_near = |piece: &Small<M>| {
            let mut mass = 0.0;
            let mut near = Vec::with_capacity(all.len());
            for other in all {
                if squared(other.centre - piece.centre) <= 1.0 {
                    mass += other.mass;
                }
                // Balls of the next size are not larger.
                let reach = other.radius + piece.radius + 1.0;
                if squared(other.middle - piece.middle) <= reach * reach {
                    near.push((other.copy.moved(-piece.centre), other.mass));
                }
            }
            MassPiece {
                copy: piece.copy.moved(-piece.centre),
                near,
                logs: [piece.mass, mass].map(libm::log),
                weight,
            }
        };
        pieces.iter().map(with_near).collect()
    }
}

/// The golden section, whose multiples do not repeat modulo 1.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl<M> MassPiece<M> {
    /// Returns the logarithm of the piece's term in the sum of an order.
    fn share(&self, order: f64) -> f64 {
        let [mass, ball] = self.logs;
        self.weight + mass + (order - 1.0) * ball
    }

    /// Returns the logarithm of the piece's term as if it were isolated, which its inner parts become.
    fn own_share(&self, order: f64) -> f64 {
        self.weight + order * self.logs[0]
    }
}

/// Returns the square of a vector's length.
fn squared<P: Point>(vector: P) -> f64 {
    vector.dot(vector)
}

/// Returns the logarithm of a sum of exponentials.
fn log_sum(logs: impl Iterator<Item = f64> + Clone) -> f64 {
    let most = logs.clone().fold(f64::NEG_INFINITY, f64::max);
    most + libm::log(logs.map(|log| libm::exp(log - most)).sum::<f64>())
}
