//! The systems that a walk follows.

use crate::geometry::{DAffine2, DMat2, DVec2};

use super::Shape;
use super::alias::AliasTable;
use super::random::Scalar;

/// What a step of the walk may do.
#[derive(Clone, Debug, PartialEq)]
pub enum Map {
    /// The point is moved by an affine map.
    Affine(DAffine2),
    /// The point is forgotten, and a new one drawn from a *condensation set*: the set-valued map
    /// whose image of any point is that set (Demko, Hodges & Naylor 1985, section 3.5).
    Condensation(Shape),
}

/// An iterated function system with weights, recurrent or not.
///
/// All weights are positive and finite, all maps finite, and from every map every other one can
/// follow, be it by others in between. The walk has a start on the attractor.
#[derive(Clone, Debug)]
pub struct System {
    maps: Vec<Map>,
    /// A row of weights for what may follow a map, one row a map; the last row is for the first step.
    rows: Vec<Vec<f64>>,
    is_recurrent: bool,
    start: Start,
}

/// A point of the attractor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) point: DVec2,
    /// The map that has led to it.
    pub(super) last: usize,
}

/// What is wrong with a system. Maps are numbered from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SystemError {
    /// There is no map.
    #[error("there is no map")]
    NoMaps,
    /// A map has coordinates that are not finite.
    #[error("map {map} is not finite")]
    NotFinite {
        /// The map.
        map: usize,
    },
    /// A map's weight is not a positive number.
    #[error("the weight {weight} of map {map} is not a positive number")]
    Weight {
        /// The map.
        map: usize,
        /// Its weight.
        weight: f64,
    },
    /// The weights of what may follow are not a square of as many rows as there are maps.
    #[error("there are {maps} maps, but the transitions are not {maps} rows of {maps} weights")]
    NotSquare {
        /// The number of maps.
        maps: usize,
    },
    /// The weight of a transition is negative or not finite.
    #[error(
        "the weight {weight} of the transition from map {from} to map {to} is not a number from 0"
    )]
    Transition {
        /// The map that comes first.
        from: usize,
        /// The map that follows.
        to: usize,
        /// The weight.
        weight: f64,
    },
    /// The walk can lead from one map to another, but never back.
    #[error(
        "map {to} never comes after map {from}, not even by others: the walk would not come back"
    )]
    OneWay {
        /// The map that the walk can leave for good,
        from: usize,
        /// and the one that it does not reach.
        to: usize,
    },
    /// No map, applied again and again, brings points together.
    #[error("no map contracts")]
    Expands,
}

impl System {
    /// A system in which any map may follow, with its weight.
    ///
    /// # Errors
    ///
    /// If there are no maps, if a map or a weight is not what it should be, or if no map contracts.
    pub fn new(maps: Vec<(Map, f64)>) -> Result<Self, SystemError> {
        Self::of(maps, None)
    }

    /// A recurrent system (Barnsley, Elton & Hardin 1989): `transitions[i][j]` is the weight with
    /// which map j follows after map i, 0 where it may not. In terms of sets, A_j is the union of
    /// the f_j(A_i) over all i that j may follow. The maps' own weights are for the first step of
    /// walks from given starts.
    ///
    /// # Errors
    ///
    /// As of [`new`](Self::new); or if there is not a weight from 0 for every transition, if some
    /// map does not come after another, or if no cycle of maps contracts.
    pub fn recurrent(
        maps: Vec<(Map, f64)>,
        transitions: Vec<Vec<f64>>,
    ) -> Result<Self, SystemError> {
        Self::of(maps, Some(transitions))
    }

    fn of(maps: Vec<(Map, f64)>, transitions: Option<Vec<Vec<f64>>>) -> Result<Self, SystemError> {
        let (maps, weights): (Vec<_>, Vec<_>) = maps.into_iter().unzip();
        check(&maps, &weights)?;
        let is_recurrent = transitions.is_some();
        let mut rows = match transitions {
            Some(rows) => {
                check_transitions(&rows, maps.len())?;
                rows
            }
            None => vec![weights.clone(); maps.len()],
        };
        let start = start(&maps, &rows).ok_or(SystemError::Expands)?;
        rows.push(weights);
        Ok(Self {
            maps,
            rows,
            is_recurrent,
            start,
        })
    }

    /// The maps.
    #[must_use]
    pub fn maps(&self) -> &[Map] {
        &self.maps
    }

    /// The weights of the maps that may follow a map.
    pub(super) fn weights_after(&self, map: usize) -> &[f64] {
        &self.rows[map]
    }

    /// Whether what may follow depends on the map before.
    pub(super) fn is_recurrent(&self) -> bool {
        self.is_recurrent
    }

    /// The choice of the next map: a row for every map that was the last, and one for the first step.
    pub(super) fn choice(&self) -> AliasTable {
        AliasTable::of_rows(&self.rows)
    }

    /// A point of the attractor.
    pub(super) fn start(&self) -> Start {
        self.start
    }
}

fn check(maps: &[Map], weights: &[f64]) -> Result<(), SystemError> {
    if maps.is_empty() {
        return Err(SystemError::NoMaps);
    }
    for (map, (kind, &weight)) in maps.iter().zip(weights).enumerate() {
        if let Map::Affine(affine) = kind
            && !affine.is_finite()
        {
            return Err(SystemError::NotFinite { map });
        }
        if !(weight > 0.0 && weight.is_finite()) {
            return Err(SystemError::Weight { map, weight });
        }
    }
    Ok(())
}

fn check_transitions(rows: &[Vec<f64>], maps: usize) -> Result<(), SystemError> {
    if rows.len() != maps || rows.iter().any(|row| row.len() != maps) {
        return Err(SystemError::NotSquare { maps });
    }
    for (from, row) in rows.iter().enumerate() {
        for (to, &weight) in row.iter().enumerate() {
            if !(weight >= 0.0 && weight.is_finite()) {
                return Err(SystemError::Transition { from, to, weight });
            }
        }
    }
    for from in 0..maps {
        let ways = Ways::from(rows, from);
        if let Some(to) = (0..maps).find(|&to| ways.before[to].is_none()) {
            return Err(SystemError::OneWay { from, to });
        }
    }
    Ok(())
}

/// The shortest ways from a map to all others and back to itself.
struct Ways {
    /// The map before each on its way.
    before: Vec<Option<usize>>,
}

impl Ways {
    fn from(rows: &[Vec<f64>], from: usize) -> Self {
        let mut before = vec![None; rows.len()];
        let mut reached = vec![from];
        let mut next = 0;
        while let Some(&map) = reached.get(next) {
            for (to, &weight) in rows[map].iter().enumerate() {
                if weight > 0.0 && before[to].is_none() {
                    before[to] = Some(map);
                    reached.push(to);
                }
            }
            next += 1;
        }
        Self { before }
    }
}

/// A point drawn from a condensation set, or the fixed point of a cycle of maps that contracts.
fn start(maps: &[Map], rows: &[Vec<f64>]) -> Option<Start> {
    let shapes = maps.iter().enumerate().find_map(|(last, map)| match map {
        Map::Condensation(shape) => Some(Start {
            point: shape.draw(&mut Scalar::new(0, 0)),
            last,
        }),
        Map::Affine(_) => None,
    });
    shapes.or_else(|| {
        (0..maps.len()).find_map(|last| {
            let cycle = cycle(maps, &Ways::from(rows, last), last);
            fixed_point(&cycle).map(|point| Start { point, last })
        })
    })
}

/// The product of the maps on the shortest way from a map back to itself.
fn cycle(maps: &[Map], ways: &Ways, last: usize) -> DAffine2 {
    let mut product = DAffine2::IDENTITY;
    let mut at = last;
    loop {
        if let Map::Affine(map) = &maps[at] {
            product *= *map;
        }
        match ways.before[at] {
            Some(before) if before != last => at = before,
            _ => return product,
        }
    }
}

/// The fixed point of a map under which all points come together.
fn fixed_point(map: &DAffine2) -> Option<DVec2> {
    let matrix = map.matrix2;
    let (half_trace, determinant) = (
        (matrix.x_axis.x + matrix.y_axis.y) / 2.0,
        matrix.determinant(),
    );
    let discriminant = half_trace * half_trace - determinant;
    let radius = if discriminant < 0.0 {
        determinant.sqrt()
    } else {
        half_trace.abs() + discriminant.sqrt()
    };
    let point = (DMat2::IDENTITY - matrix).inverse() * map.translation;
    (radius < 1.0 && point.is_finite()).then_some(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scaled(factor: f64, x: f64) -> (Map, f64) {
        let shift = DVec2::new(x, 0.0);
        let map = DAffine2::from_scale_angle_translation(DVec2::splat(factor), 0.0, shift);
        (Map::Affine(map), 1.0)
    }

    fn cantor() -> Vec<(Map, f64)> {
        vec![scaled(1.0 / 3.0, 0.0), scaled(1.0 / 3.0, 2.0 / 3.0)]
    }

    #[test]
    fn the_start_lies_on_the_attractor() {
        let start = System::new(cantor()).unwrap().start();
        assert_eq!((start.point, start.last), (DVec2::ZERO, 0));
        // Only in turn: the last map is the first one, so it is f(g(f(g(…)))) = 1/4.
        let turns = vec![vec![0.0, 1.0], vec![1.0, 0.0]];
        let start = System::recurrent(cantor(), turns).unwrap().start();
        assert!((start.point.x - 0.25).abs() < 1e-15);
        assert_eq!(start.last, 0);
    }

    /// Of three maps in turn, the fixed point takes the one before last first.
    #[test]
    fn cycles_are_applied_in_their_order() {
        let maps = vec![scaled(0.5, 0.0), scaled(0.5, 1.0), scaled(0.5, 10.0)];
        let turns = vec![
            vec![0.0, 1.0, 0.0],
            vec![0.0, 0.0, 1.0],
            vec![1.0, 0.0, 0.0],
        ];
        let start = System::recurrent(maps, turns).unwrap().start();
        let x = start.point.x;
        let after = |x: f64| x * 0.5;
        assert_eq!(x, after(after(after(x) + 1.0) + 10.0));
    }

    #[test]
    fn maps_that_expand_alone_are_left_alone() {
        let both = vec![scaled(1.5, 1.0), scaled(0.5, 1.0)];
        assert_eq!(System::new(both).unwrap().start().last, 1);
        let expands = System::new(vec![scaled(1.0, 1.0), scaled(-2.0, 1.0)]);
        assert_eq!(expands.unwrap_err(), SystemError::Expands);
    }

    #[test]
    fn bad_systems_are_refused() {
        assert_eq!(System::new(vec![]).unwrap_err(), SystemError::NoMaps);
        let bad = System::new(vec![scaled(f64::NAN, 0.0)]).unwrap_err();
        assert_eq!(bad, SystemError::NotFinite { map: 0 });
        for weight in [0.0, -1.0, f64::INFINITY] {
            let mut maps = cantor();
            maps[1].1 = weight;
            let refused = System::new(maps).unwrap_err();
            assert_eq!(refused, SystemError::Weight { map: 1, weight });
        }
        let recurrent = |rows: Vec<Vec<f64>>| System::recurrent(cantor(), rows).unwrap_err();
        let square = SystemError::NotSquare { maps: 2 };
        assert_eq!(recurrent(vec![vec![1.0, 1.0]]), square);
        assert_eq!(recurrent(vec![vec![1.0], vec![1.0, 1.0]]), square);
        assert_eq!(
            recurrent(vec![vec![1.0, -1.0], vec![1.0, 1.0]]),
            SystemError::Transition {
                from: 0,
                to: 1,
                weight: -1.0
            }
        );
        assert_eq!(
            recurrent(vec![vec![0.0, 1.0], vec![0.0, 1.0]]),
            SystemError::OneWay { from: 0, to: 0 }
        );
        assert_eq!(
            recurrent(vec![vec![1.0, 1.0], vec![0.0, 1.0]]),
            SystemError::OneWay { from: 1, to: 0 }
        );
    }
}
