//! How the mass about a measure's points grows with the size of balls: its moments.
//!
//! With the mass M of the ball of a size ε about a point of the measure, the mean of M^(q − 1) over all
//! points goes with ε^((q − 1) D_q) (Hentschel & Procaccia 1983; Pawelzik & Schuster 1987). Balls about
//! points of the measure are never hardly met, as some boxes of a grid always are, whose small masses make
//! sums of negative orders worthless: they are enlarged boxes in the sense of Riedi (1995).
//!
//! Masses come from the graph: the set falls into *pieces*, copies that are small beside a ball, and a
//! piece has its mass where its centre is. Pieces are divided again and again, and what lies near them
//! with them. Where there are too many, some stand for the others (*splitting*: Kahn & Harris 1951),
//! evenly spread over the set, and the more likely the more a piece adds to any of the sums; what their balls hold
//! is as exact as ever.

use std::num::NonZero;

use crate::geometry::DVec2;
use crate::measure::cover::{deviation, mean, on_all};
use crate::measure::regression::Reading;

use super::{Cascade, Placed};

/// Pieces have no larger radii, as parts of a ball's. What smears balls like this is the same at all sizes.
const SMALL: f64 = 1.0;

/// Copies of one size that are looked at, and the least number of pieces that are divided. As long as
/// there are fewer, sums are over all.
const FOLLOWED_COPIES: usize = 1 << 17;
const FOLLOWED: usize = 1 << 6;

/// Copies of one size, and of all, that may be looked at: where too many lie over each other, the descent
/// ends.
const MOST_COPIES: usize = 1 << 21;
const MOST_OF_ALL: usize = 3 << 21;

/// Distances from pieces to others are that much cheaper than a copy.
const DISTANCES: usize = 8;

/// Smaller balls are not used: doubles still tell six digits of them.
const FINEST: f64 = 1.0 / (1u64 << 28) as f64;

/// Of so many copies near each other, some may be the same.
const MANY: usize = 64;

/// The entropies of some orders at some sizes.
pub(in crate::measure) struct Moments {
    /// From the largest on.
    pub(in crate::measure) sizes: Vec<f64>,
    /// By series, size and order.
    entropies: Vec<Vec<Vec<f64>>>,
}

impl Moments {
    /// Of balls of about half the extent on, each `base` times smaller than those before, as far as
    /// masses can be told, in several series: between one size and the next, theirs are spread evenly,
    /// so that what comes back with the size evens out on their mean.
    pub(in crate::measure) fn of(
        cascade: &Cascade,
        orders: &[f64],
        base: f64,
        series: NonZero<usize>,
        threads: NonZero<usize>,
    ) -> Self {
        let extent = cascade.set.bounds().size().max_element();
        let first = extent / 2.0;
        let sizes = std::iter::successors(Some(first), |size| Some(size / base));
        let sizes: Vec<f64> = sizes.take_while(|size| *size > FINEST * extent).collect();
        #[expect(clippy::cast_precision_loss, reason = "series are few")]
        let parts = (0..series.get()).map(|number| number as f64 / series.get() as f64);
        let parts: Vec<f64> = parts.collect();
        let entropies = on_all(&parts, threads, |_, &part| {
            let size = first * libm::pow(base, -part);
            let mut descent = Descent::new(cascade, orders, size / 2.0, part);
            let mut entropies = Vec::new();
            for number in 0..sizes.len() {
                if number > 0 {
                    descent.go_down(base);
                }
                match descent.entropies() {
                    Some(told) => entropies.push(told),
                    None => break,
                }
            }
            entropies
        });
        let told = entropies.iter().map(Vec::len).min().unwrap_or_default();
        let mean_part = libm::pow(base, -mean(&parts));
        let sizes = sizes[..told].iter().map(|size| size * mean_part);
        Self {
            sizes: sizes.collect(),
            entropies,
        }
    }

    /// What a regression uses, of the order of a number; sizes at which an entropy is not finite are
    /// left out.
    pub(in crate::measure) fn readings(&self, order: usize) -> Vec<Reading> {
        let by_series = |size: usize| -> Vec<f64> {
            let entropies = self.entropies.iter();
            entropies.map(|sizes| sizes[size][order]).collect()
        };
        let all = self.sizes.iter().enumerate();
        let all = all.map(|(number, &size)| (size, by_series(number)));
        let finite = |(_, logs): &(f64, Vec<f64>)| logs.iter().all(|log| log.is_finite());
        let all: Vec<(f64, Vec<f64>)> = all.filter(finite).collect();
        let reading = |(number, (size, logs)): (usize, &(f64, Vec<f64>))| {
            let last = &all[number.saturating_sub(1)].1;
            let both = logs.iter().zip(last);
            let growth: Vec<f64> = both.map(|(log, last)| log - last).collect();
            #[expect(clippy::cast_precision_loss, reason = "series are few")]
            let series = logs.len() as f64;
            Reading {
                size: *size,
                log: mean(logs),
                scatter: deviation(logs.iter().copied()),
                growth: mean(&growth),
                growth_error: deviation(growth.into_iter()) / series.sqrt(),
            }
        };
        all.iter().enumerate().map(reading).collect()
    }
}

/// A copy and its mass.
type Massive = (Placed, f64);

/// A piece, on a scale on which balls have the radius 1.
struct Piece {
    copy: Placed,
    /// What a ball about any of its points may hold, the piece itself among it.
    near: Vec<Massive>,
    /// The logarithms of its mass, and of that of the ball about its centre.
    logs: [f64; 2],
    /// The logarithm of the number of pieces that it stands for.
    weight: f64,
}

/// A copy that is small, with its mass, its centre, and a disc that holds it.
struct Small {
    copy: Placed,
    mass: f64,
    centre: DVec2,
    middle: DVec2,
    radius: f64,
}

/// The descent: the pieces of the present size, and the work that they took.
struct Descent<'c> {
    cascade: &'c Cascade,
    orders: &'c [f64],
    pieces: Vec<Piece>,
    /// Where the first of the pieces that are chosen lies, from 0 to 1.
    place: f64,
    /// Copies that were looked at for the pieces of this size, and larger pieces that were divided.
    looked_at: usize,
    divided: usize,
    /// Copies that were looked at for all larger sizes.
    before: usize,
}

impl<'c> Descent<'c> {
    fn new(cascade: &'c Cascade, orders: &'c [f64], radius: f64, place: f64) -> Self {
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
        let near: Vec<Massive> = near.collect();
        let all = descent.small(near.clone(), |_, _| true);
        let smaller = descent.small(near, |_, _| true);
        descent.pieces = descent.with_near(&smaller, &all, 0.0);
        descent
    }

    /// For every order q, −ln of the mean of M^(q − 1), to the power 1 / (q − 1); of order 1 the mean of
    /// −ln M. `None` where too many copies lie over each other.
    fn entropies(&self) -> Option<Vec<f64>> {
        let all = self.before + self.looked_at;
        if self.looked_at > MOST_COPIES || all > MOST_OF_ALL || self.pieces.is_empty() {
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

    /// Goes on to balls `base` times smaller.
    fn go_down(&mut self, base: f64) {
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
                at.distance_squared(middle) <= (radius + reach + 1.0) * (radius + reach + 1.0)
            });
            let weight = piece.weight;
            pieces.append(&mut self.with_near(&smaller, &near, weight));
            if self.looked_at > MOST_COPIES {
                break;
            }
        }
        self.pieces = pieces;
    }

    /// Keeps some of the pieces, if there are too many: one that adds so much to a sum that no other can
    /// stand for it always, others as likely as they add to the sum of an order for which this is the
    /// most, or their parts will once what lies beside them is farther away than balls reach.
    fn choose(&mut self) {
        let most = self.divided * FOLLOWED_COPIES / self.looked_at.max(1);
        let most = most.max(FOLLOWED);
        if self.pieces.len() <= most {
            return;
        }
        let mut parts = vec![0.0; self.pieces.len()];
        for &order in self.orders.iter().chain(&[0.0, 1.0]) {
            for share in [Piece::share, Piece::own_share] {
                let sum = log_sum(self.pieces.iter().map(|piece| share(piece, order)));
                for (part, piece) in parts.iter_mut().zip(&self.pieces) {
                    *part = f64::max(*part, libm::exp(share(piece, order) - sum));
                }
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "pieces are some thousand")]
        let chances = most as f64 / parts.iter().sum::<f64>();
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

    /// A disc that holds a copy.
    fn disc(&self, copy: &Placed) -> (DVec2, f64) {
        let part = &self.cascade.set.objects[copy.object];
        (
            copy.map.transform_point2(part.middle),
            part.reach * copy.scale,
        )
    }

    /// The small copies that copies are made of, without those whose discs are not kept.
    fn small(&mut self, mut stack: Vec<Massive>, keep: impl Fn(DVec2, f64) -> bool) -> Vec<Small> {
        let cascade = self.cascade;
        let mut small = Vec::new();
        stack.reverse();
        while let Some((copy, mass)) = stack.pop() {
            self.looked_at += 1;
            if self.looked_at > MOST_COPIES {
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
                centre: copy.map.transform_point2(cascade.centres[copy.object]),
                middle,
                radius,
            });
        }
        join(&mut small);
        small
    }

    /// Pieces with what lies near them, of small copies among which they are.
    fn with_near(&mut self, pieces: &[Small], all: &[Small], weight: f64) -> Vec<Piece> {
        self.looked_at += pieces.len() * all.len() / DISTANCES;
        let with_near = |piece: &Small| {
            let mut mass = 0.0;
            let mut near = Vec::new();
            for other in all {
                if other.centre.distance_squared(piece.centre) <= 1.0 {
                    mass += other.mass;
                }
                // Balls of the next size are no larger.
                let reach = other.radius + piece.radius + 1.0;
                if other.middle.distance_squared(piece.middle) <= reach * reach {
                    near.push((other.copy.moved(-piece.centre), other.mass));
                }
            }
            Piece {
                copy: piece.copy.moved(-piece.centre),
                near,
                logs: [piece.mass, mass].map(libm::log),
                weight,
            }
        };
        pieces.iter().map(with_near).collect()
    }
}

/// The golden section never repeats itself.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl Piece {
    /// The logarithm of what it adds to the sum of an order.
    fn share(&self, order: f64) -> f64 {
        let [mass, ball] = self.logs;
        self.weight + mass + (order - 1.0) * ball
    }

    /// The same, as if nothing lay beside it, which becomes true of its inner parts.
    fn own_share(&self, order: f64) -> f64 {
        self.weight + order * self.logs[0]
    }
}

impl Placed {
    /// Becomes so many times as large, about 0.
    fn grow(&mut self, factor: f64) {
        self.map.matrix2 *= factor;
        self.map.translation *= factor;
        self.scale *= factor;
    }

    fn moved(mut self, by: DVec2) -> Self {
        self.map.translation += by;
        self
    }
}

/// The logarithm of a sum of exponentials.
fn log_sum(logs: impl Iterator<Item = f64> + Clone) -> f64 {
    let most = logs.clone().fold(f64::NEG_INFINITY, f64::max);
    most + libm::log(logs.map(|log| libm::exp(log - most)).sum::<f64>())
}

/// Puts copies that are the same together.
fn join(copies: &mut Vec<Small>) {
    const SAME: f64 = 1e-5;
    if copies.len() < MANY {
        return;
    }
    copies.sort_by(|a, b| {
        a.copy
            .map
            .translation
            .x
            .total_cmp(&b.copy.map.translation.x)
    });
    let mut kept: Vec<Small> = Vec::with_capacity(copies.len());
    for small in copies.drain(..) {
        let x = small.copy.map.translation.x;
        let near = kept.iter_mut().rev();
        let mut near = near.take_while(|it| x - it.copy.map.translation.x <= SAME);
        let is_same = |it: &&mut Small| {
            it.copy.object == small.copy.object && it.copy.map.abs_diff_eq(small.copy.map, SAME)
        };
        match near.find(is_same) {
            Some(same) => same.mass += small.mass,
            None => kept.push(small),
        }
    }
    *copies = kept;
}
