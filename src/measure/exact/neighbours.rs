//! Neighbour maps: the relative positions of neighbouring pieces.
//!
//! For two pieces f_u(K_a) and f_v(K_b) of one generation the map h = f_u⁻¹ f_v is the position of the second
//! relative to the first. Their pieces in the next generation have the maps f_i⁻¹ h f_j; where the balls
//! around two pieces do not meet, neither do those of their descendants. In a system of finite type finitely
//! many maps remain, and their graph determines the pieces that touch or coincide (Bandt & Graf 1992, Bandt &
//! Mesing 2009).

use std::collections::HashMap;

use glam::{DAffine3, DVec3};

use super::Effort;
use super::balls::Balls;
use super::sizes::{Generations, Piece, Step};

/// Two pieces, with the map of the second relative to the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) first: Piece,
    pub(super) second: Piece,
    pub(super) map: DAffine3,
}

/// Successor of a pair: the pair of the first piece's step i and the second piece's step j.
#[derive(Clone, Copy, Debug)]
pub(super) struct Successor {
    pub(super) steps: [u32; 2],
    pub(super) pair: u32,
}

/// All pairs of pieces whose balls meet, up to the end of the search.
#[derive(Debug)]
pub(super) struct Neighbours {
    pub(super) pairs: Vec<Pair>,
    /// Successors of each pair; empty for pieces that coincide.
    pub(super) next: Vec<Vec<Successor>>,
    /// Pairs of steps i ≠ j of one piece, by set.
    pub(super) siblings: Vec<Vec<Successor>>,
    /// Whether the two pieces of each pair are equal.
    pub(super) coincide: Vec<bool>,
    pub(super) end: End,
}

/// Result of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// All pairs were found.
    Complete,
    /// The search reached the limit of pairs, or of work.
    Capped,
    /// Two maps were neither equal nor apart.
    TooClose,
}

const MAX_PAIRS: usize = 20_000;
const MAX_WORK: usize = 6_000_000;

/// Difference of entries below which maps are equal: rounding causes about 1e-13.
const EQUAL: f64 = 1e-7;

/// Difference of entries below which maps that are not equal cannot be distinguished. The size of sets is
/// about 1.
const APART: f64 = 1e-4;

/// Pairs by number, with an index by their maps.
#[derive(Default)]
pub(super) struct Register {
    pairs: Vec<Pair>,
    cells: HashMap<(Piece, Piece, i64), Vec<u32>>,
    /// Whether two maps were neither equal nor apart.
    pub(super) too_close: bool,
}

impl Register {
    /// Returns the number of a pair, and whether it is new.
    pub(super) fn number(&mut self, pair: Pair) -> (u32, bool) {
        // Maps with a distance below `APART` lie in neighbouring cells of this coordinate.
        const CELL: f64 = 16.0 * APART;
        let position = coordinate(&pair.map) / CELL;
        let cell = floor(position);
        let beside = if position - position.floor() < 0.5 {
            cell - 1
        } else {
            cell + 1
        };
        for cell in [cell, beside] {
            let known = self.cells.get(&(pair.first, pair.second, cell));
            for &number in known.into_iter().flatten() {
                let apart = distance(&pair.map, &self.pairs[number as usize].map);
                if apart < EQUAL {
                    return (number, false);
                }
                self.too_close |= apart < APART;
            }
        }
        let number = u32::try_from(self.pairs.len()).unwrap_or(u32::MAX);
        self.pairs.push(pair);
        let cell = self.cells.entry((pair.first, pair.second, cell));
        cell.or_default().push(number);
        (number, true)
    }
}

/// Returns a linear function of a map's entries, with coefficients for which it differs between different
/// maps in general; its Lipschitz constant is below 5.
fn coordinate(map: &DAffine3) -> f64 {
    let weights = DVec3::new(0.577_215_664_9, 0.261_497_212_8, 0.915_965_594_2);
    let linear = map.matrix3;
    weights.dot(map.translation)
        + 0.8123 * weights.dot(linear.x_axis)
        + 0.4967 * weights.dot(linear.y_axis)
        + 0.3331 * weights.dot(linear.z_axis)
}

fn distance(a: &DAffine3, b: &DAffine3) -> f64 {
    let linear = a.matrix3 - b.matrix3;
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
    let all = columns.into_iter().chain([a.translation - b.translation]);
    all.map(|vector| vector.abs().max_element())
        .fold(0.0, f64::max)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn floor(value: f64) -> i64 {
    value.floor() as i64
}

impl Neighbours {
    /// Finds all pairs of pieces, starting from the steps of every set.
    pub(super) fn of(generations: &Generations, effort: Effort) -> Self {
        let balls = Balls::of(generations.first_steps());
        let mut search = Search {
            generations,
            balls,
            register: Register::default(),
            coincide: Vec::new(),
            work: 0,
            effort,
        };
        let siblings = (0..generations.size())
            .map(|set| {
                let piece = Piece { set, wait: 0 };
                let itself = Pair {
                    first: piece,
                    second: piece,
                    map: DAffine3::IDENTITY,
                };
                search.successors(itself, |i, j| i != j)
            })
            .collect();
        let mut next = Vec::new();
        let end = loop {
            let number = next.len();
            if search.register.too_close {
                break End::TooClose;
            }
            if search.is_capped() {
                break End::Capped;
            }
            let Some(&pair) = search.register.pairs.get(number) else {
                break End::Complete;
            };
            next.push(if search.coincide[number] {
                Vec::new()
            } else {
                search.successors(pair, |_, _| true)
            });
        };
        next.resize(search.register.pairs.len(), Vec::new());
        Self {
            pairs: search.register.pairs,
            next,
            siblings,
            coincide: search.coincide,
            end,
        }
    }

    /// Returns, for every pair, whether it is the start of an infinite path: whether its pieces have a point
    /// in common.
    ///
    /// Precondition: the search is complete.
    pub(super) fn touching(&self) -> Vec<bool> {
        let mut left: Vec<usize> = self.next.iter().map(Vec::len).collect();
        let mut touching = vec![true; self.pairs.len()];
        let before = self.predecessors();
        let ends = |pair: &usize| self.next[*pair].is_empty() && !self.coincide[*pair];
        let mut open: Vec<usize> = (0..touching.len()).filter(ends).collect();
        while let Some(pair) = open.pop() {
            touching[pair] = false;
            for &earlier in &before[pair] {
                left[earlier] -= 1;
                if left[earlier] == 0 {
                    open.push(earlier);
                }
            }
        }
        touching
    }

    /// Returns, for every pair, whether any descendants of its two pieces coincide.
    pub(super) fn sharing(&self) -> Vec<bool> {
        let before = self.predecessors();
        let mut sharing = self.coincide.clone();
        let mut open: Vec<usize> = (0..sharing.len()).filter(|&pair| sharing[pair]).collect();
        while let Some(pair) = open.pop() {
            for &earlier in &before[pair] {
                if !sharing[earlier] {
                    sharing[earlier] = true;
                    open.push(earlier);
                }
            }
        }
        sharing
    }

    fn predecessors(&self) -> Vec<Vec<usize>> {
        let mut before = vec![Vec::new(); self.pairs.len()];
        for (pair, next) in self.next.iter().enumerate() {
            for successor in next {
                before[successor.pair as usize].push(pair);
            }
        }
        before
    }
}

struct Search<'g> {
    generations: &'g Generations,
    balls: Balls,
    register: Register,
    coincide: Vec<bool>,
    work: usize,
    effort: Effort,
}

impl Search<'_> {
    /// Returns whether the search has reached the limit of pairs, or of work.
    fn is_capped(&self) -> bool {
        let pairs = self.register.pairs.len();
        pairs > self.effort.of(MAX_PAIRS) || self.work > self.effort.of(MAX_WORK)
    }

    /// Returns the successors of a pair, by the steps that `keep` accepts: some of them, once the search is capped.
    fn successors(&mut self, pair: Pair, keep: impl Fn(usize, usize) -> bool) -> Vec<Successor> {
        /// Tolerance within which balls are taken to meet, because of rounding.
        const SLACK: f64 = 1e-9;
        let generations = self.generations;
        let size = super::system::ratio(pair.map.matrix3);
        let [firsts, seconds] = [pair.first, pair.second].map(|piece| generations.steps(piece));
        let balls = &self.balls;
        let centre = |step: &Step| step.map.transform_point3(balls.centres[step.piece.set]);
        let reach = |step: &Step| step.ratio * balls.radii[step.piece.set];
        let own: Vec<_> = firsts.iter().map(|s| (centre(s), reach(s))).collect();
        let other: Vec<_> = seconds
            .iter()
            .map(|s| (pair.map.transform_point3(centre(s)), size * reach(s)))
            .collect();
        let mut successors = Vec::new();
        for (i, (a, r)) in own.iter().enumerate() {
            if self.is_capped() {
                break;
            }
            self.work += other.len();
            for (j, (b, s)) in other.iter().enumerate() {
                let apart = (*a - *b).length_squared();
                let reach = (r + s) * (1.0 + SLACK) + SLACK;
                if apart > reach * reach || !keep(i, j) {
                    continue;
                }
                let steps = [i, j].map(|step| u32::try_from(step).unwrap_or(u32::MAX));
                let pair = self.number(&firsts[i], &pair.map, &seconds[j]);
                successors.push(Successor { steps, pair });
                self.work += 16;
            }
        }
        successors
    }

    fn number(&mut self, first: &Step, map: &DAffine3, second: &Step) -> u32 {
        let map = first.inverse * *map * second.map;
        let pair = Pair {
            first: first.piece,
            second: second.piece,
            map,
        };
        let (number, new) = self.register.number(pair);
        if new {
            let off = distance(&map, &DAffine3::IDENTITY);
            let same = pair.first == pair.second;
            self.register.too_close |= same && (EQUAL..APART).contains(&off);
            self.coincide.push(same && off < EQUAL);
        }
        number
    }
}
