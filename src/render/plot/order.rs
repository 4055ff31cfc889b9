//! Order of strokes with short movements of the raised pen.

use crate::geometry::DVec2;

use super::points::{Point, vector};
use super::strokes::{Strokes, is_closed};
use super::tree::Tree;

/// Stroke with its direction or start.
#[derive(Clone, Copy)]
pub(super) struct Turn {
    pub(super) stroke: usize,
    pub(super) traversal: Traversal,
}

/// Direction or start of a stroke.
#[derive(Clone, Copy)]
pub(super) enum Traversal {
    Forwards,
    Backwards,
    /// From a vertex of a closed stroke.
    From(usize),
}

/// Order of strokes, with the distance that the raised pen is moved between strokes.
pub(super) struct Order {
    pub(super) turns: Vec<Turn>,
    pub(super) travel: f64,
}

/// Maximum number of strokes that an exchange reverses.
const REACH: usize = 50;

/// Maximum number of passes over all strokes.
const ROUNDS: usize = 10;

impl Order {
    /// Returns the order in which strokes are given.
    pub(super) fn as_drawn(strokes: &Strokes, places: &[[i32; 2]]) -> Self {
        let turns = (0..strokes.len()).map(|stroke| Turn {
            stroke,
            traversal: Traversal::Forwards,
        });
        Self::of(turns.collect(), strokes, places)
    }

    fn of(turns: Vec<Turn>, strokes: &Strokes, places: &[[i32; 2]]) -> Self {
        let ends = |turn: &Turn| ends(turn, strokes, places);
        let mut at = None;
        let mut travel = 0.0;
        for [from, to] in turns.iter().map(ends) {
            travel += at.map_or(0.0, |at: DVec2| at.distance(from));
            at = Some(to);
        }
        Self { turns, travel }
    }

    /// Improves the order. Starting from the given order and from the nearest-neighbour order (to either end
    /// of a stroke, or to any vertex of a closed one), parts of the order are reversed where that shortens it
    /// (2-opt, Croes 1958); the shorter result is returned.
    pub(super) fn shortened(self, strokes: &Strokes, places: &[[i32; 2]]) -> Self {
        let nearest = Self::of(by_nearest(strokes, places), strokes, places);
        let better = [self, nearest].map(|order| exchanged(order, strokes, places));
        let [drawn, nearest] = better;
        if nearest.travel < drawn.travel {
            nearest
        } else {
            drawn
        }
    }
}

/// Returns the start and the end of a stroke.
fn ends(turn: &Turn, strokes: &Strokes, places: &[[i32; 2]]) -> [DVec2; 2] {
    let stroke = strokes.get(turn.stroke);
    let place = |vertex: usize| vector(places[stroke[vertex] as usize]);
    let last = stroke.len() - 1;
    match turn.traversal {
        Traversal::Forwards => [place(0), place(last)],
        Traversal::Backwards => [place(last), place(0)],
        Traversal::From(vertex) => [place(vertex); 2],
    }
}

/// Returns the nearest-neighbour order.
fn by_nearest(strokes: &Strokes, places: &[[i32; 2]]) -> Vec<Turn> {
    let doors = |stroke: &[Point]| {
        let last = stroke.len() - 1;
        let vertices = if is_closed(stroke) {
            0..last
        } else {
            0..last + 1
        };
        let step = if is_closed(stroke) { 1 } else { last };
        vertices.step_by(step)
    };
    let mut all = Vec::new();
    let mut owners = Vec::new();
    for (number, stroke) in strokes.iter().enumerate() {
        for vertex in doors(stroke) {
            let item = u32::try_from(owners.len()).unwrap_or(u32::MAX);
            all.push((places[stroke[vertex] as usize], item));
            owners.push((number, vertex));
        }
    }
    let firsts: Vec<_> = owners
        .chunk_by(|a, b| a.0 == b.0)
        .scan(0, |sum, owned| {
            let first = *sum;
            *sum += owned.len();
            Some(first)
        })
        .collect();
    let mut tree = Tree::new(all);
    tree.fill();
    let mut turns = Vec::with_capacity(strokes.len());
    let mut at = DVec2::ZERO;
    while let Some((_, item)) = tree.nearest(at) {
        let (number, vertex) = owners[item as usize];
        let stroke = strokes.get(number);
        let traversal = match vertex {
            vertex if is_closed(stroke) => Traversal::From(vertex),
            0 => Traversal::Forwards,
            _ => Traversal::Backwards,
        };
        let turn = Turn {
            stroke: number,
            traversal,
        };
        turns.push(turn);
        at = ends(&turn, strokes, places)[1];
        for (item, vertex) in (firsts[number]..).zip(doors(stroke)) {
            let item = u32::try_from(item).unwrap_or(u32::MAX);
            tree.remove(places[stroke[vertex] as usize], item);
        }
    }
    turns
}

/// Reverses parts of the order while that shortens it, within bounds.
fn exchanged(order: Order, strokes: &Strokes, places: &[[i32; 2]]) -> Order {
    let mut turns = order.turns;
    let mut lines: Vec<_> = turns
        .iter()
        .map(|turn| ends(turn, strokes, places))
        .collect();
    for _ in 0..ROUNDS {
        let mut is_better = false;
        for first in 0..lines.len() {
            let before = first.checked_sub(1).map(|before| lines[before][1]);
            let to = |at: DVec2| before.map_or(0.0, |before| before.distance(at));
            for last in first..lines.len().min(first + REACH) {
                let [begin, end] = [lines[first][0], lines[last][1]];
                let next = lines.get(last + 1).map(|line| line[0]);
                let on = |from: DVec2| next.map_or(0.0, |next| from.distance(next));
                let gain = to(begin) + on(end) - to(end) - on(begin);
                // A gain beyond rounding ensures that the loop terminates.
                if gain > 1e-3 {
                    is_better = true;
                    lines[first..=last].reverse();
                    lines[first..=last]
                        .iter_mut()
                        .for_each(|ends| ends.reverse());
                    turns[first..=last].reverse();
                    turns[first..=last].iter_mut().for_each(Turn::turn);
                }
            }
        }
        if !is_better {
            break;
        }
    }
    Order::of(turns, strokes, places)
}

impl Turn {
    fn turn(&mut self) {
        self.traversal = match self.traversal {
            Traversal::Forwards => Traversal::Backwards,
            Traversal::Backwards => Traversal::Forwards,
            from @ Traversal::From(_) => from,
        };
    }
}
