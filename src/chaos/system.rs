//! Systems of maps and condensation sets, prepared for random walks.

use crate::digraph::components;
use crate::geometry::DAffine2;
use crate::ifs::{self, Choice, Ifs, PointOf};

use super::alias::AliasTable;
use super::random::Scalar;
use super::walked::{ChaosMap, SetSampler};

/// A step of the walk.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Map<M: ChaosMap> {
    /// Moves the point by an affine map.
    Affine(M),
    /// Replaces the point by one drawn from a *condensation set*: the set-valued map whose image of any point
    /// is that set (Demko, Hodges & Naylor 1985, section 3.5).
    Condensation(M::Sampler),
}

/// The [walk](ifs::Walk) of an iterated function system, prepared for many walkers.
///
/// The maps of the system come first, then its condensation sets, each of which is a map as well. Every map
/// can follow every other one, possibly with others in between, and walks therefore draw all of the
/// attractor. There is a point of the attractor to start from.
#[derive(Clone, Debug)]
pub struct WeightedMaps<M: ChaosMap = DAffine2> {
    maps: Vec<Map<M>>,
    /// Probability of every map, one row per state of the walk.
    rows: Vec<Vec<f64>>,
    start: Start<PointOf<M>>,
    /// Isometries whose images of every point are counted as well, the identity first; empty for none.
    images: Vec<M>,
}

/// A point of the attractor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start<P> {
    pub(super) point: P,
    /// Index of the map that led to it.
    pub(super) last: usize,
}

/// Reason why a system cannot be walked. Indices in values count from 0, in messages from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SystemError {
    /// The walk can lead from one map to another, but never back.
    #[error(
        "map {} never comes after map {}, not even by others: a walk would not draw all of it",
        .to + 1, .from + 1
    )]
    OneWay {
        /// Map that the walk can reach.
        from: usize,
        /// Map that the walk cannot reach from there.
        to: usize,
    },
    /// No map has a shortest cycle back to itself that contracts.
    #[error("no map contracts")]
    Expands,
    /// A condensation set has too many corners and crossings, or faces.
    #[error("points cannot be drawn from condensation set {}: it has too many corners", .condensation + 1)]
    Corners {
        /// Index of the condensation set.
        condensation: usize,
    },
    /// The table of transition probabilities is too large.
    #[error("{maps} maps with a digraph are too many to be chosen from at random")]
    TooMany {
        /// Number of maps and condensation sets.
        maps: usize,
    },
}

/// Maximum number of entries of the table of transition probabilities.
const MAX_ENTRIES: usize = 1 << 24;

impl<M: ChaosMap> WeightedMaps<M> {
    /// Prepares the walk of a system.
    ///
    /// # Errors
    ///
    /// Returns an error if a map cannot follow another, if no shortest cycle from a map back to itself
    /// contracts, if a condensation set has too many corners, or if the table of transition probabilities is
    /// too large.
    pub fn of(ifs: &Ifs<M>) -> Result<Self, SystemError> {
        let affine = ifs.maps().len();
        let walk = ifs.walk();
        let states = walk.states();
        let count = affine + ifs.condensation().len();
        if states.len().saturating_mul(count) > MAX_ENTRIES {
            return Err(SystemError::TooMany { maps: count });
        }
        let targets = states.iter();
        let targets = targets.map(|steps| steps.iter().map(|step| step.to).collect());
        let parts = components(&targets.collect::<Vec<_>>());
        // Edges never lead to components of higher numbers.
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
            let sampler =
                M::Sampler::of_set(&set.shape).ok_or(SystemError::Corners { condensation })?;
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
            // Weights for the first step of a walk from a given start.
            rows.push(ifs.weights().to_vec());
        }
        let start =
            start(ifs, &maps, &targets_of_maps(&rows, affine)).ok_or(SystemError::Expands)?;
        Ok(Self {
            maps,
            rows,
            start,
            images: Vec::new(),
        })
    }

    /// Replaces the points of the walk by their images under isometries, of which the first is the identity: an equal
    /// share of all points for each image, which is that of the same walk.
    #[must_use]
    pub fn with_images(self, images: Vec<M>) -> Self {
        Self { images, ..self }
    }

    /// Returns the isometries whose images of the walk are counted; empty for the walk alone.
    pub(super) fn images(&self) -> &[M] {
        &self.images
    }

    /// Returns the maps, followed by the condensation sets.
    pub(super) fn maps(&self) -> &[Map<M>] {
        &self.maps
    }

    /// Returns the number of maps, including condensation sets.
    #[must_use]
    pub fn classes(&self) -> usize {
        self.maps.len()
    }

    /// Returns the probability of every map in the first state of the walk.
    pub(super) fn probabilities(&self) -> &[f64] {
        &self.rows[0]
    }

    /// Returns `true` if the probabilities depend on the previous map.
    pub(super) fn is_recurrent(&self) -> bool {
        self.rows.len() > 1
    }

    /// Returns the state of the walk after a map, or before the first one, for which `last` is the number of
    /// maps.
    #[inline]
    pub(super) fn state_after(&self, last: usize) -> usize {
        last.min(self.rows.len() - 1)
    }

    /// Returns the table for the choice of the next map, one row per state.
    pub(super) fn choice(&self) -> AliasTable {
        AliasTable::of_rows(&self.rows)
    }

    /// Returns a point of the attractor.
    pub(super) fn start(&self) -> Start<PointOf<M>> {
        self.start
    }
}

/// Returns the affine maps that may follow each affine map.
fn targets_of_maps(rows: &[Vec<f64>], affine: usize) -> Vec<Vec<usize>> {
    let rows = (0..affine).map(|map| &rows[map.min(rows.len() - 1)]);
    let targets = rows.map(|row| (0..affine).filter(|&to| row[to] > 0.0).collect());
    targets.collect()
}

/// Returns a point drawn from a condensation set, or the fixed point of a contracting cycle of maps.
fn start<M: ChaosMap>(
    ifs: &Ifs<M>,
    maps: &[Map<M>],
    targets: &[Vec<usize>],
) -> Option<Start<PointOf<M>>> {
    let drawn = maps.iter().enumerate().find_map(|(last, map)| match map {
        Map::Condensation(shape) => Some(Start {
            point: shape.sample(&mut Scalar::new(0, 0)),
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

/// Returns the maps on the shortest path from a map back to itself, which comes last.
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
    use crate::geometry::DVec2;
    use crate::ifs::{Definition, Edge};

    fn scaled(factor: f64, x: f64) -> ifs::Map {
        let shift = DVec2::new(x, 0.0);
        let affine = DAffine2::from_scale_angle_translation(DVec2::splat(factor), 0.0, shift);
        ifs::Map::new(affine)
    }

    fn cantor() -> Vec<ifs::Map> {
        vec![scaled(1.0 / 3.0, 0.0), scaled(1.0 / 3.0, 2.0 / 3.0)]
    }

    fn system(
        maps: Vec<ifs::Map>,
        edges: Option<&[[usize; 2]]>,
    ) -> Result<WeightedMaps, SystemError> {
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
        WeightedMaps::of(&Ifs::new(definition).unwrap())
    }

    #[test]
    fn the_start_lies_on_the_attractor() {
        let start = system(cantor(), None).unwrap().start();
        assert_eq!((start.point, start.last), (DVec2::ZERO, 0));
        // The maps alternate: the last map applied is the first one, and the point is f(g(f(g(…)))) = 1/4.
        let start = system(cantor(), Some(&[[0, 1], [1, 0]])).unwrap().start();
        assert!((start.point.x - 0.25).abs() < 1e-15);
        assert_eq!(start.last, 0);
    }

    /// For a cycle of three maps, the order in which the fixed point applies them matters.
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
