//! Errors of the definition of an iterated function system, and the checks that find all of them.

use std::collections::HashMap;

use super::{AffineMap, Definition, Edge};

/// Owner of a weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightOwner {
    /// The map with this index.
    Map(usize),
    /// The edge with this index.
    Edge(usize),
    /// The condensation set with this index.
    Condensation(usize),
}

impl std::fmt::Display for WeightOwner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Map(number) => write!(f, "map {}", number + 1),
            Self::Edge(number) => write!(f, "edge {}", number + 1),
            Self::Condensation(number) => write!(f, "condensation set {}", number + 1),
        }
    }
}

/// An error in the definition of a system. Indices count from 0 in fields, from 1 in messages.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IfsError {
    /// There are no maps.
    #[error("a system needs at least one map")]
    NoMaps,
    /// A coefficient of a map is not finite.
    #[error("map {} is not finite", .map + 1)]
    MapNotFinite {
        /// Index of the map.
        map: usize,
    },
    /// A weight is zero, negative or not finite.
    #[error("{of} has the weight {weight}; weights are positive numbers")]
    Weight {
        /// Owner of the weight.
        of: WeightOwner,
        /// The weight.
        weight: f64,
    },
    /// A map has no weight although others have one.
    #[error("map {} has no weight; all maps have one, or none", .map + 1)]
    WeightMissing {
        /// Index of the map.
        map: usize,
    },
    /// An edge starts or ends at a map that does not exist.
    #[error("edge {} names map {}, but there are only {maps}", .edge + 1, .map + 1)]
    NoSuchMap {
        /// Index of the edge.
        edge: usize,
        /// The index that the edge names.
        map: usize,
        /// The number of maps.
        maps: usize,
    },
    /// An edge is listed twice.
    #[error("edge {} is the same as edge {}", .edge + 1, .first + 1)]
    EdgeTwice {
        /// Index of the second edge.
        edge: usize,
        /// Index of the first edge.
        first: usize,
    },
    /// No edge leads to a map.
    #[error("no edge leads to map {}, so it is never applied", .map + 1)]
    NothingEnters {
        /// Index of the map.
        map: usize,
    },
    /// No edge leads away from a map.
    #[error("no edge leads away from map {}, so nothing can follow it", .map + 1)]
    NothingLeaves {
        /// Index of the map.
        map: usize,
    },
    /// A condensation set is not finite, has no extent, or is closed and has no area.
    #[error("condensation set {} has no extent", .condensation + 1)]
    NoExtent {
        /// Index of the condensation set.
        condensation: usize,
    },
    /// The initial set is a point that is not finite.
    #[error("the initial set is not finite")]
    InitialNotFinite,
}

/// Returns all errors of a definition, in the order maps, edges, condensation sets, initial set.
pub(super) fn check<M: AffineMap>(definition: &Definition<M>) -> Vec<IfsError> {
    let mut errors = Vec::new();
    let maps = &definition.maps;
    if maps.is_empty() {
        errors.push(IfsError::NoMaps);
    }
    let some_weigh = maps.iter().any(|map| map.weight.is_some());
    for (number, map) in maps.iter().enumerate() {
        if !map.affine.is_finite() {
            errors.push(IfsError::MapNotFinite { map: number });
        }
        if some_weigh && map.weight.is_none() {
            errors.push(IfsError::WeightMissing { map: number });
        }
        errors.extend(check_weight(map.weight, WeightOwner::Map(number)));
    }
    if let Some(edges) = &definition.edges {
        errors.extend(check_edges(edges, maps.len()));
    }
    for (number, set) in definition.condensation.iter().enumerate() {
        if !M::has_extent(&set.shape) {
            errors.push(IfsError::NoExtent {
                condensation: number,
            });
        }
        errors.extend(check_weight(set.weight, WeightOwner::Condensation(number)));
    }
    let initial = definition.initial.as_ref();
    if initial.is_some_and(|set| !M::is_bounded(set)) {
        errors.push(IfsError::InitialNotFinite);
    }
    errors
}

fn check_weight(weight: Option<f64>, of: WeightOwner) -> Option<IfsError> {
    let weight = weight?;
    let good = weight > 0.0 && weight.is_finite();
    (!good).then_some(IfsError::Weight { of, weight })
}

fn check_edges(edges: &[Edge], maps: usize) -> Vec<IfsError> {
    let mut errors = Vec::new();
    let (mut entered, mut left) = (vec![false; maps], vec![false; maps]);
    let mut known = HashMap::new();
    for (number, edge) in edges.iter().enumerate() {
        for (map, met) in [(edge.from, &mut left), (edge.to, &mut entered)] {
            match met.get_mut(map) {
                Some(met) => *met = true,
                None => errors.push(IfsError::NoSuchMap {
                    edge: number,
                    map,
                    maps,
                }),
            }
        }
        let first = *known.entry((edge.from, edge.to)).or_insert(number);
        if first != number {
            errors.push(IfsError::EdgeTwice {
                edge: number,
                first,
            });
        }
        errors.extend(check_weight(edge.weight, WeightOwner::Edge(number)));
    }
    for map in 0..maps {
        if !entered[map] {
            errors.push(IfsError::NothingEnters { map });
        }
        if !left[map] {
            errors.push(IfsError::NothingLeaves { map });
        }
    }
    errors
}
