//! Limit sets of L-systems in space.
//!
//! Sets and their maps follow from [growth] as in the plane. Where all displacements turn from step to step by one rotation,
//! the sets are turned back, so that those of all steps may be equal.

mod alike;
mod growth;

use std::sync::Arc;

use crate::geometry::{DAffine3, DMat3, DVec3, Direction, Frame3, Solid};
use crate::graph::{Chain, Graph, Instance, Object, Replacement};
use crate::lsystem::{Compass, Heading3, LSystemInSpace, NoGrowth, TurtleFrame as _};

use self::alike::Sets;
use self::growth::{Growth, linear, rotation, turned};
use super::budget::Budget;
use super::growth::Steps;
use super::pieces::{Piece, Pieces, ROUNDING, Set, SetMap, SetNumbers};
use super::turns::{Reader, Reading, STEP};
use super::{Kinds, MAX_CLOSED};

impl SetMap for DAffine3 {
    type Point = DVec3;

    fn place(&self) -> &DVec3 {
        &self.translation
    }

    fn image(&self, point: &DVec3) -> DVec3 {
        self.transform_point3(*point)
    }

    fn is_near(&self, other: &Self) -> bool {
        let near = |a: DVec3, b: DVec3| a.distance(b) <= ROUNDING * (1.0 + a.length());
        near(self.translation, other.translation)
            && (0..3).all(|axis| near(self.matrix3.col(axis), other.matrix3.col(axis)))
    }

    fn log2(&self) -> f64 {
        self.matrix3.x_axis.length().log2()
    }

    fn meet(a: &DVec3, b: &DVec3) -> bool {
        Self::is_zero(&(*a - *b))
    }

    fn is_zero(point: &DVec3) -> bool {
        point.length() <= ROUNDING
    }
}

struct Finder<'f> {
    steps: &'f Steps<Frame3>,
    growth: &'f Growth,
    compass: Compass,
    budget: &'f Budget,
    names: SetNumbers,
    sets: Vec<Set<DAffine3>>,
}

impl Finder<'_> {
    /// Returns the pieces of a word whose modules are at a step of the period, divided by a ratio, in coordinates that are
    /// turned back by a rotation.
    fn pieces(
        &mut self,
        reading: &Reading<Heading3>,
        phase: usize,
        ratio: f64,
        back: DMat3,
    ) -> Result<Vec<Piece<DAffine3>>, NoGrowth> {
        self.budget
            .spend(reading.sums.len() + reading.parts.len())?;
        let mut places = vec![DVec3::ZERO];
        for sum in &reading.sums {
            // A sum that leads to no part may have terms that decide no place.
            let way = self.growth.ways[phase][sum.of].unwrap_or(DVec3::ZERO);
            places.push(places[sum.at] + turned(self.compass, sum, way));
        }
        let mut pieces = Vec::new();
        for part in &reading.parts {
            let inner = match part.of {
                STEP => DMat3::IDENTITY,
                _ => self.growth.turns[phase],
            };
            let linear = back * linear(self.compass, part) * inner * ratio.recip();
            let place = back * places[part.at] / ratio;
            pieces.push(Piece {
                map: DAffine3::from_mat3_translation(linear, place),
                set: self.names.of(part.of, phase)?,
            });
        }
        Ok(pieces)
    }

    /// Finds the pieces of all sets.
    fn finish(&mut self) -> Result<(), NoGrowth> {
        let mut done = 0;
        while let Some(&(variable, phase)) = self.names.found.get(done) {
            done += 1;
            let Growth {
                period,
                ratio,
                is_one,
                ..
            } = *self.growth;
            let turn = match phase {
                0 => self.growth.turn,
                _ => self.growth.turns[phase],
            };
            let is_line = variable == STEP && is_one;
            let pieces = if is_line {
                Vec::new()
            } else if variable == STEP {
                vec![Piece {
                    set: self.names.of(STEP, 0)?,
                    map: DAffine3::from_scale(DVec3::splat(ratio.recip())),
                }]
            } else {
                let step = if phase == 0 { period } else { phase };
                let steps = self.steps;
                let reading = steps.reading(steps.first + step, variable);
                self.pieces(reading, step - 1, ratio, turn.transpose())?
            };
            let way = match is_line {
                true => Some(DVec3::X),
                false => {
                    let back = self.growth.turns[phase].transpose();
                    self.growth.ways[phase][variable].map(|way| back * way)
                }
            };
            self.sets.push(Set {
                pieces,
                way,
                is_line,
            });
        }
        Ok(())
    }
}

impl Pieces<DAffine3> {
    fn in_space(
        reader: &Reader<'_, Frame3>,
        steps: &Steps<Frame3>,
        growth: &Growth,
    ) -> Result<Self, NoGrowth> {
        let mut finder = Finder {
            steps,
            growth,
            compass: reader.compass,
            budget: &reader.budget,
            names: SetNumbers::default(),
            sets: Vec::new(),
        };
        let mut axioms = Vec::new();
        for phase in 0..growth.period {
            let effects = steps.effects(steps.first + phase);
            let reading = reader.read(&reader.kinds.axiom, Some(effects))?;
            axioms.push(finder.pieces(&reading, phase, 1.0, growth.turns[phase].transpose())?);
        }
        finder.finish()?;
        // Lines are points beside displacements that grow.
        let line = finder.names.found.iter().position(|it| it.0 == STEP);
        let point = line.filter(|_| !growth.is_one);
        let sets = finder.sets;
        let mut pieces = Self {
            axiom: Vec::new(),
            sets,
        };
        let budget = &reader.budget;
        let classes = pieces.classes(budget)?;
        let alike = Sets {
            all: &pieces.sets,
            point,
            budget,
        };
        for later in &axioms {
            if !alike.are_alike(&axioms[0], later)? {
                let period = u32::try_from(growth.period).unwrap_or(u32::MAX);
                return Err(NoGrowth::Alternates(period));
            }
        }
        pieces.axiom = axioms.swap_remove(0);
        if !pieces.contracts() {
            return Err(NoGrowth::Slow);
        }
        pieces.merged(&classes, budget)?.without_points(budget)
    }
}

impl Graph<Frame3> {
    /// Returns the graph that has the limit set of an L-system in space.
    ///
    /// # Errors
    ///
    /// The reason why the system has no limit set, or why that is not decided.
    pub(crate) fn limit_of_lsystem(system: &LSystemInSpace) -> Result<Self, NoGrowth> {
        let words = &system.words;
        super::check(words)?;
        if let Some(reason) = system.walked() {
            return Err(NoGrowth::Walked(reason));
        }
        let kinds = Kinds::of(words, u32::MAX, MAX_CLOSED).map_err(|_| NoGrowth::Arguments)?;
        let reader: Reader<'_, Frame3> = Reader::new(system, &kinds);
        if reader.compass.parts() == 0 {
            // Sums of angles are not exact.
            return Err(NoGrowth::Turns);
        }
        let steps = Steps::of(&reader)?;
        let growth = Growth::of(&steps, &reader)?;
        let pieces = Pieces::in_space(&reader, &steps, &growth)?;
        if pieces.axiom.is_empty() {
            return Err(NoGrowth::Empty);
        }
        let ends = pieces.ends();
        let mut lines = pieces.axiom.iter();
        let (first, end) = lines
            .find_map(|piece| Some((piece, ends[piece.set]?)))
            .ok_or(NoGrowth::Points)?;
        // The first piece is as long as a step, in the direction of the turtle.
        let mut start =
            Frame3::start(system, reader.compass).rotation(reader.compass) * words.length();
        if !growth.is_one {
            let chord = first.map.image(&end) - first.map.translation;
            let turn = rotation(&[chord], &[first.map.matrix3.x_axis]);
            let turn = turn.unwrap_or(DMat3::IDENTITY);
            start *= turn * chord.length().recip();
        }
        let ends = ends.into_iter().map(|end| end.unwrap_or(DVec3::X));
        let lines: Vec<Solid> = ends.map(|end| Solid::hull(&[DVec3::ZERO, end])).collect();
        let chain = |pieces: &[Piece<DAffine3>], before: DMat3| {
            let instances = pieces.iter().zip(0..).map(|(piece, position)| {
                let map = DAffine3::from_mat3(before) * piece.map;
                let direction = match map.matrix3.determinant() < 0.0 {
                    true => Direction::YReflected,
                    false => Direction::Normal,
                };
                Instance::new(piece.set, Frame3::new(map, direction), position)
            });
            Chain::loose(instances.collect())
        };
        let sets = pieces.sets.iter().enumerate();
        let objects = sets.map(|(number, set)| Object {
            behaviour: number,
            replacement: match set.is_line {
                true => Replacement::Kept,
                false => {
                    let chain = chain(&set.pieces, DMat3::IDENTITY);
                    Replacement::Fixed(Arc::new(chain.into()))
                }
            },
            ..Object::kept(number)
        });
        let axiom = chain(&pieces.axiom, start);
        let graph = Self::of(objects.collect(), lines, vec![axiom]);
        match graph.contracts() {
            true => Ok(graph),
            false => Err(NoGrowth::Slow),
        }
    }
}
