//! The systems that a walk follows.

use crate::digraph::components;
use crate::geometry::{DAffine2, DVec2};
use crate::ifs::{self, Choice, Ifs};

use super::alias::AliasTable;
use super::random::Scalar;
use super::sampler::Sampler;

/// What a step of the walk may do.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Map {
    /// The point is moved by an affine map.
    Affine(DAffine2),
    /// The point is forgotten, and a new one drawn from a *condensation set*: the set-valued map
    /// whose image of any point is that set (Demko, Hodges & Naylor 1985, section 3.5).
    Condensation(Sampler),
}

/// The [walk](ifs::Walk) of an iterated function system, made ready to be walked often.
///
/// The maps of the system come first, then its condensation sets, each of which is a map as well.
/// From every map every other one can follow, be it by others in between, so that walks draw all of
/// the attractor; and there is a point of the attractor to start from.
#[derive(Clone, Debug)]
pub struct System {
    maps: Vec<Map>,
    /// How likely every map is, a row a state of the walk.
    rows: Vec<Vec<f64>>,
    start: Start,
}

/// A point of the attractor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) point: DVec2,
    /// The map that has led to it.
    pub(super) last: usize,
}

/// Why a system cannot be walked. Numbers in values count from 0, in messages from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SystemError {
    /// The walk can lead from one map to another, but never back.
    #[error(
        "map {} never comes after map {}, not even by others: a walk would not draw all of it",
        .to + 1, .from + 1
    )]
    OneWay {
        /// The map that the walk may come to,
        from: usize,
        /// and the one that it does not come to from there.
        to: usize,
    },
    /// No map, applied again and again, brings points together.
    #[error("no map contracts")]
    Expands,
    /// A condensation set has too many corners and crossings.
    #[error("points cannot be drawn from condensation set {}: it has too many corners", .condensation + 1)]
    Corners {
        /// The condensation set.
        condensation: usize,
    },
    /// The table of what may follow what is too large.
    #[error("{maps} maps with a digraph are too many to be chosen from at random")]
    TooMany {
        /// The number of maps and condensation sets.
        maps: usize,
    },
}

/// The most entries of the table of what may follow what.
const MOST_ENTRIES: usize = 1 << 24;

impl System {
    /// The walk of a system.
    ///
    /// # Errors
    ///
    /// If some map does not come after another, if no cycle of maps contracts, or if the system is
    /// larger than can be chosen from.
    pub fn of(ifs: &Ifs) -> Result<Self, SystemError> {
        let affine = ifs.maps().len();
        let walk = ifs.walk();
        let states = walk.states();
        let count = affine + ifs.condensation().len();
        if states.len().saturating_mul(count) > MOST_ENTRIES {
            return Err(SystemError::TooMany { maps: count });
        }
        let targets = states.iter();
        let targets = targets.map(|steps| steps.iter().map(|step| step.to).collect());
        let parts = components(&targets.collect::<Vec<_>>());
        // Edges never lead to parts of higher numbers.
        let [from, to] = [false, true].map(|is_higher| {
            let mut parts = parts.iter();
            parts.position(|&part| (part > 0) == is_higher)
        });
        if let (Some(from), Some(to)) = (from, to) {
            return Err(SystemError::OneWay { from, to });
        }
        let mut maps: Vec<_> = ifs
            .maps()
            .iter()
            .map(|map| Map::Affine(map.affine))
            .collect();
        for (condensation, set) in ifs.condensation().iter().enumerate() {
            let sampler = Sampler::of(&set.shape).ok_or(SystemError::Corners { condensation })?;
            maps.push(Map::Condensation(sampler));
        }
        let mut rows = vec![vec![0.0; count]; states.len()];
        for (row, steps) in rows.iter_mut().zip(states) {
            for step in steps {
                match step.choice {
                    Choice::Map(map) => row[map] = step.probability,
                    Choice::Condensation(set) => row[affine + set] = step.probability,
                }
            }
        }
        if ifs.is_recurrent() && ifs.condensation().is_empty() {
            // The first step of a walk from elsewhere.
            rows.push(ifs.weights().to_vec());
        }
        let start =
            start(ifs, &maps, &targets_of_maps(&rows, affine)).ok_or(SystemError::Expands)?;
        Ok(Self { maps, rows, start })
    }

    /// The maps, the condensation sets last.
    pub(super) fn maps(&self) -> &[Map] {
        &self.maps
    }

    /// The number of maps, condensation sets included.
    #[must_use]
    pub fn classes(&self) -> usize {
        self.maps.len()
    }

    /// How likely every map is in the first state of the walk.
    pub(super) fn probabilities(&self) -> &[f64] {
        &self.rows[0]
    }

    /// Whether what may follow depends on the map before.
    pub(super) fn is_recurrent(&self) -> bool {
        self.rows.len() > 1
    }

    /// The state of the walk after a map, or before the first one, which has the number of maps.
    #[inline]
    pub(super) fn state_after(&self, last: usize) -> usize {
        last.min(self.rows.len() - 1)
    }

    /// The choice of the next map, a row a state.
    pub(super) fn choice(&self) -> AliasTable {
        AliasTable::of_rows(&self.rows)
    }

    /// A point of the attractor.
    pub(super) fn start(&self) -> Start {
        self.start
    }
}

/// The affine maps that may follow each.
fn targets_of_maps(rows: &[Vec<f64>], affine: usize) -> Vec<Vec<usize>> {
    let rows = (0..affine).map(|map| &rows[map.min(rows.len() - 1)]);
    let targets = rows.map(|row| (0..affine).filter(|&to| row[to] > 0.0).collect());
    targets.collect()
}

/// A point drawn from a condensation set, or the fixed point of a cycle of maps that contracts.
fn start(ifs: &Ifs, maps: &[Map], targets: &[Vec<usize>]) -> Option<Start> {
    let drawn = maps.iter().enumerate().find_map(|(last, map)| match map {
        Map::Condensation(shape) => Some(Start {
            point: shape.draw(&mut Scalar::new(0, 0)),
            last,
        }),
        Map::Affine(_) => None,
    });
    drawn.or_else(|| {
        (0..targets.len()).find_map(|last| {
            let product = ifs::Map::new(ifs.composition(&cycle(targets, last)?));
            let point = product.fixed_point().filter(|_| product.contracts())?;
            Some(Start { point, last })
        })
    })
}

/// The maps on the shortest way from a map back to itself, which comes last.
fn cycle(targets: &[Vec<usize>], last: usize) -> Option<Vec<usize>> {
    let mut before = vec![None; targets.len()];
    let mut reached = vec![last];
    let mut next = 0;
    while before[last].is_none() {
        let map = *reached.get(next)?;
        for &to in &targets[map] {
            if before[to].is_none() {
                before[to] = Some(map);
                reached.push(to);
            }
        }
        next += 1;
    }
    let mut cycle = vec![last];
    let mut at = before[last]?;
    while at != last {
        cycle.push(at);
        at = before[at]?;
    }
    cycle.reverse();
    Some(cycle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::{Definition, Edge};

    fn scaled(factor: f64, x: f64) -> ifs::Map {
        let shift = DVec2::new(x, 0.0);
        let affine = DAffine2::from_scale_angle_translation(DVec2::splat(factor), 0.0, shift);
        ifs::Map::new(affine)
    }

    fn cantor() -> Vec<ifs::Map> {
        vec![scaled(1.0 / 3.0, 0.0), scaled(1.0 / 3.0, 2.0 / 3.0)]
    }

    fn system(maps: Vec<ifs::Map>, edges: Option<&[[usize; 2]]>) -> Result<System, SystemError> {
        let edge = |&[from, to]: &[usize; 2]| Edge {
            from,
            to,
            weight: None,
        };
        let definition = Definition {
            maps,
            edges: edges.map(|edges| edges.iter().map(edge).collect()),
            ..Definition::default()
        };
        System::of(&Ifs::new(definition).unwrap())
    }

    #[test]
    fn the_start_lies_on_the_attractor() {
        let start = system(cantor(), None).unwrap().start();
        assert_eq!((start.point, start.last), (DVec2::ZERO, 0));
        // Only in turn: the last map is the first one, so it is f(g(f(g(…)))) = 1/4.
        let start = system(cantor(), Some(&[[0, 1], [1, 0]])).unwrap().start();
        assert!((start.point.x - 0.25).abs() < 1e-15);
        assert_eq!(start.last, 0);
    }

    /// Of three maps in turn, the fixed point takes the one before last first.
    #[test]
    fn cycles_are_applied_in_their_order() {
        let maps = vec![scaled(0.5, 0.0), scaled(0.5, 1.0), scaled(0.5, 10.0)];
        let start = system(maps, Some(&[[0, 1], [1, 2], [2, 0]])).unwrap();
        let x = start.start().point.x;
        assert_eq!(x, ((x * 0.5 + 1.0) * 0.5 + 10.0) * 0.5);
    }

    #[test]
    fn maps_that_expand_alone_are_left_alone() {
        let both = vec![scaled(1.5, 1.0), scaled(0.5, 1.0)];
        assert_eq!(system(both, None).unwrap().start().last, 1);
        let expands = system(vec![scaled(1.0, 1.0), scaled(-2.0, 1.0)], None);
        assert_eq!(expands.unwrap_err(), SystemError::Expands);
    }

    #[test]
    fn walks_that_do_not_come_back_are_refused() {
        let one_way = system(cantor(), Some(&[[0, 0], [0, 1], [1, 1]]));
        assert_eq!(one_way.unwrap_err(), SystemError::OneWay { from: 1, to: 0 });
        let apart = system(cantor(), Some(&[[0, 0], [1, 1]]));
        assert!(matches!(apart.unwrap_err(), SystemError::OneWay { .. }));
    }
}
