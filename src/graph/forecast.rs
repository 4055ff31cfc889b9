//! Forecasts: the sizes of approximants, computed from the graph alone.
//!
//! The numbers of elements of step n are the n-th power of the graph's matrix applied to the initiator;
//! they are computed step by step in natural numbers of any size.

use std::cell::OnceCell;

use crate::count::Count;
use crate::fast_hash::FastMap;
use crate::geometry::{Direction, Frame, Frame2, Outline, Point};
use crate::rule::Placement;

use super::{Alternative, Chain, Graph, Instance, Replacement};

mod levels;
mod outlines;
mod sums;
mod tallies;

use levels::Totals;
use outlines::Outlines;
use sums::{Sums, Tally};
use tallies::Tallies;

/// Size of an approximant.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Number of elements, infertile and invisible ones included.
    pub elements: Count,
    /// Number of fertile elements.
    pub fertile: Count,
    /// Number of fractals that have been started: 1, and one for every seed.
    pub fractals: Count,
    /// Σ |p1 − p0| over all elements, in the graph's units; `None` if it depends on draws, or on more
    /// than the ratios of the maps.
    pub length: Option<f64>,
    /// Enclosed area, in square units, if all outlines are closed: the sum over the outlines, which
    /// counts overlaps once for each outline.
    pub area: Option<f64>,
    /// Enclosed volume in cubic units, in space: the sum over the outlines, which counts overlaps once for each outline. 0 in
    /// the plane.
    pub volume: Option<f64>,
}

/// Sizes of successive approximants, from that of the current step on: approximant 0 at first.
pub struct Forecast<'g, F: Frame = Frame2> {
    graph: &'g Graph<F>,
    /// Whether every successor is a list of fixed maps.
    is_plain: bool,
    /// Whether all maps are similarities.
    is_similar: bool,
    /// Elements of the current approximant, by object.
    population: Tallies,
    fractals: Count,
    step: u32,
    /// Approximate number of elements that were created in the last step next to one of another length,
    /// and the sum of the longer lengths.
    new_lengths: [f64; 2],
    /// Work of the additions so far.
    work: u64,
    /// Totals of objects, if the graph is time-indexed.
    totals: Totals,
    outlines: Outlines,
    /// Signed areas and volumes of the base elements, by number, as far as they were asked for.
    contents: Vec<OnceCell<[f64; 2]>>,
    /// Area enclosed by the closed paths through the end points of elements.
    path_area: f64,
}

/// Elements of one object in an approximant.
///
/// The numbers are rounded, and may exceed the range of a double.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Population {
    /// Number of the object.
    pub object: usize,
    /// Number of elements.
    pub count: f64,
    /// Σ |p1 − p0|, in the graph's units.
    pub length: f64,
    /// Σ |p1 − p0|².
    pub square: f64,
    /// Approximate number of elements that a stroke does not continue from the element before.
    pub apart: f64,
    /// Approximate number of the other elements: those that a stroke continues from an element created in
    /// another step.
    pub parted: f64,
}

/// Limit of the work of a forecast: about a fifth of a second.
const MAX_WORK: u64 = 200_000_000;

/// Work of adding two tallies of small numbers, relative to that of adding 18 digits.
const TALLY: u64 = 200;

/// Returns the work of adding a number to a tally.
fn work(count: &Count) -> u64 {
    TALLY + count.digits() as u64 / 18
}

/// Largest difference of lengths that count as equal, in powers of two.
const SAME_LENGTH: f64 = 1.0 / 16.0;

impl<F: Frame> Graph<F> {
    /// Returns the forecast of the approximants, as far as the graph is resolved; `None` if the sizes are
    /// not known without a walk: for irregular rules, and if numbers of elements depend on draws.
    #[must_use]
    pub fn forecast(&self) -> Option<Forecast<'_, F>> {
        self.has_forecast().then(|| Forecast::new(self))
    }

    /// Returns whether the sizes of approximants are known without a walk.
    pub(crate) fn has_forecast(&self) -> bool {
        self.is_regular()
            && self.behaviours().all(|object| match &object.replacement {
                Replacement::Evaluated(alternatives) => self.are_equal(alternatives),
                _ => true,
            })
    }

    /// Returns whether alternatives have equal numbers of children of every behaviour.
    fn are_equal(&self, alternatives: &[Alternative]) -> bool {
        let census = |alternative: &Alternative| {
            let mut body = Vec::new();
            let mut seeds = Vec::new();
            let behaviour = |object: &usize| self.objects[*object].behaviour;
            let mut behaviours = alternative.objects.iter().map(behaviour);
            for part in self.parts(alternative) {
                let behaviours = behaviours.by_ref().take(part.elements.len());
                if part.placement.seeds() {
                    let mut seed: Vec<usize> = behaviours.collect();
                    seed.sort_unstable();
                    seeds.push(seed);
                } else {
                    body.extend(behaviours);
                }
            }
            body.extend(behaviours);
            body.sort_unstable();
            seeds.sort_unstable();
            (body, seeds)
        };
        alternatives
            .windows(2)
            .all(|pair| census(&pair[0]) == census(&pair[1]))
    }
}

/// Returns +1 for directions that keep the left side of the replaced element on the left, −1 for the
/// others.
fn side(direction: Direction) -> f64 {
    if direction.is_mirrored() == direction.is_reversed() {
        1.0
    } else {
        -1.0
    }
}

/// Returns the signed area between a sequence of elements, as straight lines, and the line back to its
/// start; 0 in space.
fn area_under<F: Frame>(instances: &[Instance<F>]) -> f64 {
    let ends = instances.iter().map(|instance| instance.frame.ends());
    let areas = ends.map(|[from, to]| from.triangle(to).unwrap_or(0.0));
    areas.sum()
}

impl<'g, F: Frame> Forecast<'g, F> {
    fn new(graph: &'g Graph<F>) -> Self {
        let mut forecast = Self {
            graph,
            is_plain: graph.is_plain(),
            is_similar: graph.is_similar() && graph.starts_similar(),
            population: Tallies::new(graph.objects.len()),
            fractals: Count::from(graph.initiator(0).count() as u64),
            step: 0,
            new_lengths: [0.0; 2],
            work: 0,
            totals: Totals::default(),
            outlines: graph.outlines(),
            contents: vec![OnceCell::new(); graph.base_elements().len()],
            path_area: { graph.initiator(0).fractals() }
                .map(|fractal| area_under(fractal).abs())
                .sum(),
        };
        let fractals = graph.initiator(0).fractals();
        let instances = fractals.flat_map(|fractal| {
            let orientation = area_under(fractal).signum();
            let numbered = fractal.iter().enumerate();
            numbered.map(move |(number, instance)| (number, instance, orientation))
        });
        for (number, instance, orientation) in instances {
            let square = forecast.square(instance);
            let cube = forecast.cube(instance);
            forecast.add(
                instance.object,
                &Count::from(1u64),
                Sums {
                    apart: if number > 0 && instance.joined {
                        0.0
                    } else {
                        1.0
                    },
                    beside: 0.0,
                    parted: 0.0,
                    length: instance.length,
                    square,
                    signed: square * orientation * side(instance.frame.direction()),
                    root_length: instance.length,
                    root_square: square,
                    cube,
                    root_cube: cube,
                },
            );
        }
        forecast.population.sort();
        forecast
    }

    /// Returns the factor by which an instance changes areas.
    fn square(&self, instance: &Instance<F>) -> f64 {
        if self.graph.affine {
            instance.frame.area()
        } else {
            instance.length * instance.length
        }
    }

    /// Returns the factor by which an instance changes volumes.
    fn cube(&self, instance: &Instance<F>) -> f64 {
        if self.graph.affine {
            instance.frame.volume()
        } else {
            instance.length * instance.length * instance.length
        }
    }

    fn add(&mut self, object: usize, count: &Count, sums: Sums) {
        self.work += work(count);
        let population = self.population.of(object);
        population.count += count;
        population.sums += sums;
    }

    /// Returns the signed area and the volume of an object's base element.
    fn content(&self, object: usize) -> [f64; 2] {
        let number = self.graph.objects[object].base_element;
        let base_element = &self.graph.base_elements()[number];
        let content = || [base_element.signed_area(), base_element.volume()];
        *self.contents[number].get_or_init(content)
    }

    /// Returns the area of an object's base element if it is closed and drawn, otherwise 0.
    fn own_area(&self, object: usize) -> f64 {
        let drawn = self.graph.drawn(object);
        let [area, _] = match drawn.is_some_and(Outline::is_closed) {
            true => self.content(object),
            false => [0.0; 2],
        };
        area.abs()
    }

    /// Returns the volume of an object's base element if it is drawn, otherwise 0.
    fn own_volume(&self, object: usize) -> f64 {
        let [_, volume] = match self.graph.drawn(object) {
            Some(_) => self.content(object),
            None => [0.0; 2],
        };
        volume
    }

    /// Returns the number of the current approximant.
    #[must_use]
    pub fn step(&self) -> u32 {
        self.step
    }

    /// Returns the number of fractals of the current approximant.
    #[must_use]
    pub fn fractals(&self) -> &Count {
        &self.fractals
    }

    /// Returns the approximate number of elements that were created in the last step next to one of
    /// another length, and the sum of the longer lengths.
    #[must_use]
    pub fn new_lengths(&self) -> [f64; 2] {
        self.new_lengths
    }

    /// Returns the number of elements of the current approximant.
    #[must_use]
    pub fn elements(&self) -> Count {
        self.population.iter().map(|(_, tally)| &tally.count).sum()
    }

    /// Returns the size of the current approximant.
    #[must_use]
    pub fn level(&self) -> Level {
        let plain = self.is_plain;
        let all = || self.population.iter();
        let fertile = all().filter(|(object, _)| self.graph.is_fertile(*object));
        let area = |(object, tally): (usize, &Tally)| tally.sums.square * self.own_area(object);
        let volume = |(object, tally): (usize, &Tally)| tally.sums.cube * self.own_volume(object);
        let bulge = |(object, tally): (usize, &Tally)| {
            let [area, _] = self.content(object);
            tally.sums.signed * area
        };
        Level {
            elements: self.elements(),
            fertile: fertile.map(|(_, tally)| &tally.count).sum(),
            fractals: self.fractals.clone(),
            length: (plain && self.is_similar)
                // The sum of no numbers would be -0.
                .then(|| all().fold(0.0, |length, (_, tally)| length + tally.sums.length)),
            area: match self.outlines {
                Outlines::ClosedElements if plain && self.scales_areas() => {
                    Some(all().map(area).sum())
                }
                Outlines::ClosedPaths if plain => {
                    Some((self.path_area + all().map(bulge).sum::<f64>()).abs())
                }
                _ => None,
            },
            volume: (plain && self.outlines == Outlines::ClosedElements)
                .then(|| all().map(volume).fold(0.0, |sum, volume| sum + volume)),
        }
    }

    /// Returns whether maps change all areas by one factor: in space, only similarities do.
    fn scales_areas(&self) -> bool {
        let is_plane = F::Point::ZERO.triangle(F::Point::ZERO).is_some();
        is_plane || self.is_similar
    }

    /// Iterates over the elements of the current approximant, by object; `None` if they depend on draws.
    pub fn populations(&self) -> Option<impl Iterator<Item = Population>> {
        let populations = self.population.iter().map(|(object, tally)| Population {
            object,
            count: tally.count.to_f64(),
            length: tally.sums.length,
            square: tally.sums.square,
            apart: tally.sums.apart,
            parted: tally.sums.parted,
        });
        self.is_plain.then_some(populations)
    }

    /// Returns whether every object of the current approximant is resolved, as [`Forecast::advance`]
    /// requires.
    fn is_resolved(&self) -> bool {
        let mut objects = self.population.iter();
        !objects.any(|(number, _)| self.graph.objects[number].is_unresolved())
    }

    /// Takes the tallies of the current approximant, with those of fertile objects of one behaviour
    /// merged.
    fn standing_by_behaviour(&mut self) -> Vec<(usize, Tally)> {
        let mut places = FastMap::default();
        let mut merged: Vec<(usize, Tally)> = Vec::new();
        for (number, tally) in self.population.take() {
            let next = merged.len();
            let behaviour = self.graph.objects[number].behaviour;
            let place = match self.graph.is_fertile(number) {
                true => *places.entry(behaviour).or_insert(next),
                false => next,
            };
            match merged.get_mut(place) {
                Some((_, known)) => {
                    known.count += &tally.count;
                    known.sums += tally.sums;
                }
                None => merged.push((number, tally)),
            }
        }
        merged
    }

    /// Advances to the next approximant. Returns `false`, without effect, if the graph is not resolved
    /// further, or if the forecast so far took about a fifth of a second: numbers of a million digits, or of as many objects.
    pub fn advance(&mut self) -> bool {
        if self.work > MAX_WORK {
            return false;
        }
        if self.graph.is_time_indexed() {
            return self.advance_level();
        }
        if !self.is_resolved() {
            return false;
        }
        let graph = self.graph;
        self.new_lengths = [0.0; 2];
        for (number, mut tally) in self.standing_by_behaviour() {
            tally.sums.parted += std::mem::take(&mut tally.sums.beside);
            match &graph.objects[number].replacement {
                Replacement::Fixed(successor) => {
                    self.path_area += tally.sums.signed * area_under(&successor.body.instances);
                    let count = tally.count.to_f64();
                    let mut parent = tally.sums;
                    if successor.body.meets_frame != [true; 2] {
                        parent.apart = count;
                        parent.parted = 0.0;
                    }
                    self.add_chain(&tally.count, parent, &successor.body);
                    for seed in &successor.seeds {
                        self.fractals += &tally.count;
                        let area = area_under(&seed.chain.instances);
                        let orientation = if area < 0.0 { -1.0 } else { 1.0 };
                        let mut parent = tally.sums;
                        if seed.placement == Placement::SeedsAsInitiator {
                            parent.length = parent.root_length;
                            parent.square = parent.root_square;
                            parent.cube = parent.root_cube;
                        }
                        self.path_area += parent.square * area.abs();
                        parent.signed = orientation * parent.square;
                        parent.apart = count;
                        parent.parted = 0.0;
                        self.add_chain(&tally.count, parent, &seed.chain);
                    }
                }
                Replacement::Evaluated(alternatives) => {
                    let alternative = &alternatives[0];
                    let parts = graph.parts(alternative);
                    for _ in parts.iter().filter(|part| part.placement.seeds()) {
                        self.fractals += &tally.count;
                    }
                    for &object in &alternative.objects {
                        self.add(object, &tally.count, Sums::default());
                    }
                }
                Replacement::Kept | Replacement::Unresolved => {
                    self.add(number, &tally.count, tally.sums)
                }
            }
        }
        self.population.sort();
        self.look();
        self.step += 1;
        true
    }

    /// Adds the work of looking at all tallies, as a level and an estimate do, to that of the additions.
    fn look(&mut self) {
        let tallies = self.population.iter();
        self.work += tallies.map(|(_, tally)| work(&tally.count)).sum::<u64>();
    }

    /// Adds the elements of a chain that replaces elements, or that they seed.
    fn add_chain(&mut self, number: &Count, parent: Sums, chain: &Chain<F>) {
        let count = number.to_f64();
        let Some(mut before) = chain.instances.last() else {
            return;
        };
        for (index, instance) in chain.instances.iter().enumerate() {
            let is_first = index == 0;
            let joins = !is_first && instance.joined;
            let other =
                self.graph.is_fertile(before.object) != self.graph.is_fertile(instance.object);
            if libm::log2(instance.length / before.length).abs() > SAME_LENGTH {
                let longer = instance.length.max(before.length);
                self.new_lengths[0] += count;
                self.new_lengths[1] += parent.length * longer;
            }
            before = instance;
            let square = self.square(instance);
            let cube = self.cube(instance);
            let sums = Sums {
                apart: match (is_first, joins) {
                    (true, _) => parent.apart,
                    (_, true) => 0.0,
                    _ => count,
                },
                beside: if joins && other { count } else { 0.0 },
                parted: if is_first { parent.parted } else { 0.0 },
                length: parent.length * instance.length,
                square: parent.square * square,
                cube: parent.cube * cube,
                signed: side(instance.frame.direction()) * parent.signed * square,
                ..parent
            };
            self.add(instance.object, number, sums);
        }
    }
}
