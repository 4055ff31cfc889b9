//! The limit sets of variables as unions of smaller copies of each other.

use std::collections::BTreeMap;

use crate::geometry::DVec2;

use super::NoGrowth;
use super::alike::Sets;
use super::budget::Budget;
use super::growth::{Growth, Steps};
use super::number::{Complex, Numbers};
use super::polynomial::SAME;
use super::turns::{Reader, Reading, STEP, Turned, Variable};

/// Limit of the number of sets.
const MAX_SETS: usize = 1 << 10;

/// Difference that is attributed to rounding to doubles.
pub(super) const ROUNDING: f64 = 1e-10;

/// Map of a set into another.
pub(super) trait SetMap: Clone {
    /// Points of the sets.
    type Point: Clone;

    /// Returns the image of the origin.
    fn place(&self) -> &Self::Point;

    /// Returns the image of a point.
    fn image(&self, point: &Self::Point) -> Self::Point;

    /// Returns whether the maps are equal, to rounding to doubles.
    fn is_near(&self, other: &Self) -> bool;

    /// Returns the binary logarithm of the factor by which it shrinks or grows sets.
    fn log2(&self) -> f64;

    /// Returns whether two points are equal.
    fn meet(a: &Self::Point, b: &Self::Point) -> bool;

    /// Returns whether a point is the origin.
    fn is_zero(point: &Self::Point) -> bool;
}

/// Similarity z ↦ `place` + `factor` z, or `place` + `factor` z̄ if it is mirrored.
#[derive(Clone, Debug)]
pub(super) struct Similarity {
    pub(super) place: Complex,
    pub(super) factor: Complex,
    pub(super) mirrored: bool,
}

impl Similarity {
    /// Returns the coefficients in doubles.
    pub(super) fn near(&self) -> [DVec2; 2] {
        [self.place.near(0), self.factor.near(0)]
    }
}

impl SetMap for Similarity {
    type Point = Complex;

    fn place(&self) -> &Complex {
        &self.place
    }

    fn image(&self, point: &Complex) -> Complex {
        let point = match self.mirrored {
            true => &point.conjugate(),
            false => point,
        };
        &self.place + &(&self.factor * point)
    }

    fn is_near(&self, other: &Self) -> bool {
        let mut numbers = self.near().into_iter().zip(other.near());
        self.mirrored == other.mirrored
            && numbers.all(|(a, b)| a.distance(b) <= ROUNDING * (1.0 + a.length()))
    }

    fn log2(&self) -> f64 {
        self.factor.log2()
    }

    fn meet(a: &Complex, b: &Complex) -> bool {
        Self::is_zero(&(a - b))
    }

    fn is_zero(point: &Complex) -> bool {
        point.log2() <= SAME
    }
}

/// Image of a set.
#[derive(Clone, Debug)]
pub(super) struct Piece<M = Similarity> {
    pub(super) set: usize,
    pub(super) map: M,
}

impl<M: SetMap> Piece<M> {
    /// Returns whether a piece is the image of a set of the same class by the same map.
    pub(super) fn is_same(&self, other: &Self, classes: &[usize]) -> bool {
        classes[self.set] == classes[other.set] && self.map.is_near(&other.map)
    }
}

/// Set of a variable at a step of the period.
#[derive(Debug)]
pub(super) struct Set<M: SetMap = Similarity> {
    pub(super) pieces: Vec<Piece<M>>,
    /// Displacement of the variable, if it decides any place.
    pub(super) way: Option<M::Point>,
    /// Whether it is the line of one step, which is kept.
    pub(super) is_line: bool,
}

/// Sets and the pieces of the axiom.
pub(super) struct Pieces<M: SetMap = Similarity> {
    pub(super) axiom: Vec<Piece<M>>,
    pub(super) sets: Vec<Set<M>>,
}

impl Pieces {
    /// Returns the sets that the approximants approach.
    pub(super) fn of(
        reader: &Reader<'_>,
        steps: &Steps,
        growth: &Growth,
        numbers: &mut Numbers,
    ) -> Result<Self, NoGrowth> {
        let mut finder = Finder {
            steps,
            growth,
            numbers,
            budget: &reader.budget,
            names: SetNumbers::default(),
            sets: Vec::new(),
        };
        let mut axioms = Vec::new();
        for phase in 0..growth.period {
            let reading = reader.read(
                &reader.kinds.axiom,
                Some(steps.effects(steps.first + phase)),
            )?;
            axioms.push(finder.pieces(&reading, phase, None)?);
        }
        finder.finish()?;
        let sets = finder.sets;
        let pieces = Self {
            axiom: Vec::new(),
            sets,
        };
        let budget = &reader.budget;
        let classes = pieces.classes(budget)?;
        let alike = Sets::of(&pieces.sets, &axioms, budget)?;
        // The number of different sets divides that of the steps of the period.
        let is_cycle = |cycle: usize| -> Result<bool, NoGrowth> {
            if !axioms.len().is_multiple_of(cycle) {
                return Ok(false);
            }
            for later in cycle..axioms.len() {
                if !alike.are_alike(later % cycle, later)? {
                    return Ok(false);
                }
            }
            Ok(true)
        };
        let mut cycle = 1;
        while cycle < axioms.len() && !is_cycle(cycle)? {
            cycle += 1;
        }
        if cycle > 1 {
            let cycle = u32::try_from(cycle).unwrap_or(u32::MAX);
            return Err(NoGrowth::Alternates(cycle));
        }
        let axiom = axioms.swap_remove(0);
        if !pieces.contracts() {
            return Err(NoGrowth::Slow);
        }
        let pieces = Self { axiom, ..pieces }.merged(&classes, budget)?;
        pieces.without_points(budget)
    }
}

impl<M: SetMap> Pieces<M> {
    /// Returns whether the product of the factors of every cycle of sets is smaller than 1.
    pub(super) fn contracts(&self) -> bool {
        // The longest logarithm of a product that leads to a set does not rise after as many factors as there are sets.
        let mut longest = vec![0.0; self.sets.len()];
        let logarithms = self.sets.iter().map(|set| -> Vec<(usize, f64)> {
            let pieces = set.pieces.iter();
            pieces.map(|it| (it.set, it.map.log2())).collect()
        });
        let logarithms: Vec<_> = logarithms.collect();
        for _ in 0..=self.sets.len() {
            let mut rises = false;
            for (number, pieces) in logarithms.iter().enumerate() {
                for &(piece, logarithm) in pieces {
                    let product: f64 = longest[number] + logarithm + 2.0 * ROUNDING;
                    if product > longest[piece] + ROUNDING {
                        longest[piece] = product;
                        rises = true;
                    }
                }
            }
            if !rises {
                return true;
            }
        }
        false
    }

    /// Returns the classes of sets that consist of the same pieces (Hopcroft 1971), by the first of each.
    pub(super) fn classes(&self, budget: &Budget) -> Result<Vec<usize>, NoGrowth> {
        let kind = |set: &Set<M>| usize::from(set.is_line);
        let mut classes: Vec<usize> = self.sets.iter().map(kind).collect();
        loop {
            let mut firsts: Vec<usize> = Vec::new();
            let is_same = |a: usize, b: usize| -> Result<bool, NoGrowth> {
                let [one, other] = [a, b].map(|it| &self.sets[it].pieces);
                if classes[a] != classes[b] || one.len() != other.len() {
                    return Ok(false);
                }
                for (one, other) in one.iter().zip(other) {
                    budget.spend(1)?;
                    if !one.is_same(other, &classes) {
                        return Ok(false);
                    }
                }
                Ok(true)
            };
            let mut next = Vec::new();
            for number in 0..self.sets.len() {
                let mut first = None;
                for &other in &firsts {
                    if is_same(other, number)? {
                        first = Some(other);
                        break;
                    }
                }
                if first.is_none() {
                    firsts.push(number);
                }
                next.push(first.unwrap_or(number));
            }
            if next == classes {
                return Ok(classes);
            }
            classes = next;
        }
    }

    /// Returns the sets with one for each class, without pieces that occur twice.
    pub(super) fn merged(self, classes: &[usize], budget: &Budget) -> Result<Self, NoGrowth> {
        let kept: Vec<usize> = (0..classes.len()).filter(|&it| classes[it] == it).collect();
        let number = |set: usize| kept.binary_search(&classes[set]).unwrap_or(0);
        let merged = |pieces: Vec<Piece<M>>| -> Result<Vec<Piece<M>>, NoGrowth> {
            let mut all: Vec<Piece<M>> = Vec::new();
            for piece in pieces {
                budget.spend(all.len())?;
                if !all.iter().any(|it| it.is_same(&piece, classes)) {
                    all.push(piece);
                }
            }
            for piece in &mut all {
                piece.set = number(piece.set);
            }
            Ok(all)
        };
        let sets = self.sets.into_iter().enumerate();
        let sets = sets.filter(|(number, _)| classes[*number] == *number);
        let sets = sets.map(|(_, set)| {
            let pieces = merged(set.pieces)?;
            Ok(Set { pieces, ..set })
        });
        Ok(Self {
            axiom: merged(self.axiom)?,
            sets: sets.collect::<Result<_, NoGrowth>>()?,
        })
    }

    /// Returns the sets without pieces that are points of the pieces beside them: lines of one step vanish if the others
    /// grow.
    pub(super) fn without_points(mut self, budget: &Budget) -> Result<Self, NoGrowth> {
        let points = self.greatest(budget, |set, known| {
            let is_point = |it: &Piece<M>| known[it.set] && M::is_zero(it.map.place());
            !set.is_line && set.pieces.iter().all(is_point)
        })?;
        let is_larger = |it: &&Piece<M>| !points[it.set];
        let starts = self.greatest(budget, |set, known| {
            let starts = |it: &Piece<M>| known[it.set] && M::is_zero(it.map.place());
            set.is_line || set.pieces.iter().filter(is_larger).any(starts)
        })?;
        let last = |it: &Piece<M>| Some(it.map.image(self.sets[it.set].way.as_ref()?));
        let ends = self.greatest(budget, |set, known| {
            let Some(end) = &set.way else { return false };
            set.is_line
                || set.pieces.iter().filter(is_larger).any(|it| {
                    starts[it.set] && M::meet(it.map.place(), end)
                        || known[it.set] && last(it).is_some_and(|last| M::meet(&last, end))
                })
        })?;
        let without = |pieces: &[Piece<M>]| -> Result<Vec<Piece<M>>, NoGrowth> {
            let count = pieces.iter().filter(is_larger).count();
            budget.spend(count * (pieces.len() - count))?;
            let is_met = |point: &Piece<M>| {
                let point = point.map.place();
                pieces.iter().filter(is_larger).any(|it| {
                    starts[it.set] && M::meet(it.map.place(), point)
                        || ends[it.set] && last(it).is_some_and(|last| M::meet(&last, point))
                })
            };
            let left = pieces.iter().filter(|it| !points[it.set] || !is_met(it));
            Ok(left.cloned().collect())
        };
        let axiom = without(&self.axiom)?;
        let pieces = self.sets.iter().map(|set| without(&set.pieces));
        let pieces = pieces.collect::<Result<Vec<_>, _>>()?;
        for (number, (set, pieces)) in self.sets.iter_mut().zip(pieces).enumerate() {
            // A point keeps one piece: itself.
            if !points[number] {
                set.pieces = pieces;
            } else {
                set.pieces.truncate(1);
            }
        }
        Ok(Self { axiom, ..self })
    }

    /// Returns an end of every set other than its start, the origin; `None` for sets that are points.
    pub(super) fn ends(&self) -> Vec<Option<M::Point>> {
        let ends = self.sets.iter().map(|set| {
            let places = set.pieces.iter().map(|piece| piece.map.place());
            let mut all = set.way.iter().chain(places);
            all.find(|end| !M::is_zero(end)).cloned()
        });
        let mut ends: Vec<Option<M::Point>> = ends.collect();
        // A set whose pieces all start where it does has an end of a piece.
        for _ in 0..ends.len() {
            for (number, set) in self.sets.iter().enumerate() {
                let mut inner = { set.pieces.iter() }
                    .filter_map(|piece| Some(piece.map.image(ends[piece.set].as_ref()?)));
                if ends[number].is_none()
                    && let Some(end) = inner.next()
                {
                    ends[number] = Some(end);
                }
            }
        }
        ends
    }

    /// Returns the largest class of sets for which a property holds that depends on the class.
    fn greatest(
        &self,
        budget: &Budget,
        holds: impl Fn(&Set<M>, &[bool]) -> bool,
    ) -> Result<Vec<bool>, NoGrowth> {
        let mut known = vec![true; self.sets.len()];
        loop {
            let open = self.sets.iter().zip(&known).filter(|(_, was)| **was);
            budget.spend(open.map(|(set, _)| set.pieces.len()).sum())?;
            let next: Vec<bool> = { self.sets.iter().zip(&known) }
                .map(|(set, was)| *was && holds(set, &known))
                .collect();
            if next == known {
                return Ok(known);
            }
            known = next;
        }
    }
}

/// Numbers of sets by variable and step of the period, in the order in which they are found.
#[derive(Default)]
pub(super) struct SetNumbers {
    numbers: BTreeMap<(Variable, usize), usize>,
    pub(super) found: Vec<(Variable, usize)>,
}

impl SetNumbers {
    /// Returns the number of the set of a variable, which is added if it is new.
    pub(super) fn of(&mut self, variable: Variable, phase: usize) -> Result<usize, NoGrowth> {
        // The line is the same at all steps.
        let phase = if variable == STEP { 0 } else { phase };
        let next = self.found.len();
        if next > MAX_SETS {
            return Err(NoGrowth::Size);
        }
        let number = *self.numbers.entry((variable, phase)).or_insert(next);
        if number == next {
            self.found.push((variable, phase));
        }
        Ok(number)
    }
}

struct Finder<'f> {
    steps: &'f Steps,
    growth: &'f Growth,
    numbers: &'f mut Numbers,
    budget: &'f Budget,
    names: SetNumbers,
    sets: Vec<Set>,
}

impl Finder<'_> {
    /// Returns the pieces of a word whose modules are at a step of the period, divided by a ratio.
    fn pieces(
        &mut self,
        reading: &Reading,
        phase: usize,
        ratio: Option<&Complex>,
    ) -> Result<Vec<Piece>, NoGrowth> {
        // A place takes a product, a scale and a sum; a piece takes two quotients.
        self.budget
            .spend(3 * reading.sums.len() + 8 * reading.parts.len())?;
        let mut pieces = Vec::new();
        let bits = self.numbers.bits();
        let mut places = vec![Complex::real(0.0, bits)];
        for sum in &reading.sums {
            let turned = self.turned(sum);
            // A sum that leads to no part may have terms that decide no place.
            let way = self.growth.ways[phase][sum.of].as_ref();
            let way = way.map(|way| match sum.turn.mirrored {
                true => way.conjugate(),
                false => way.clone(),
            });
            let before = &places[sum.at];
            places.push(way.map_or_else(|| before.clone(), |way| before + &(&turned * &way)));
        }
        for part in &reading.parts {
            let place = &places[part.at];
            let factor = self.turned(part);
            let by = |number: &Complex| match ratio {
                Some(ratio) => number.over(ratio),
                None => number.clone(),
            };
            pieces.push(Piece {
                map: Similarity {
                    place: by(place),
                    factor: by(&factor),
                    mirrored: part.turn.mirrored,
                },
                set: self.names.of(part.of, phase)?,
            });
        }
        Ok(pieces)
    }

    fn turned(&mut self, of: &Turned) -> Complex {
        let direction = self.numbers.direction(of.turn.heading).value;
        let scale = Complex::real(of.turn.scale, self.numbers.bits());
        &direction * &scale
    }

    /// Finds the pieces of all sets.
    fn finish(&mut self) -> Result<(), NoGrowth> {
        let mut done = 0;
        while let Some(&(variable, phase)) = self.names.found.get(done) {
            done += 1;
            let period = self.growth.period;
            let ratio = self.growth.ratio.clone();
            let is_line = variable == STEP && self.growth.is_one;
            let bits = self.numbers.bits();
            let pieces = if is_line {
                Vec::new()
            } else if variable == STEP {
                vec![Piece {
                    set: self.names.of(STEP, 0)?,
                    map: Similarity {
                        place: Complex::real(0.0, bits),
                        factor: Complex::real(1.0, bits).over(&ratio),
                        mirrored: false,
                    },
                }]
            } else {
                let step = if phase == 0 { period } else { phase };
                let reading = self
                    .steps
                    .reading(self.steps.first + step, variable)
                    .clone();
                self.pieces(&reading, step - 1, Some(&ratio))?
            };
            let way = match is_line {
                true => Some(Complex::real(1.0, bits)),
                false => self.growth.ways[phase][variable].clone(),
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
