//! Words as the turtle reads them at a step: where each part starts and how it is turned, given the turns of all modules
//! one step before.

use crate::expression::Program;
use crate::geometry::Frame2;
use crate::lsystem::{Action, Axis, Compass, TurtleFrame};

use super::super::kinds::Kinds;
use super::NoGrowth;
use super::budget::Budget;

/// Direction of the turtle relative to an earlier one, with the length of its steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn<H = u64> {
    pub(super) heading: H,
    pub(super) mirrored: bool,
    /// Length of its steps; negative if they go backwards.
    pub(super) scale: f64,
}

impl<H: Copy> Turn<H> {
    /// Returns no turn, of turtles of the plane or of space.
    pub(super) fn none<F: TurtleFrame<Heading = H>>() -> Self {
        Self {
            heading: F::AHEAD,
            mirrored: false,
            scale: 1.0,
        }
    }

    fn then<F: TurtleFrame<Heading = H>>(self, compass: Compass, next: Self) -> Self {
        Self {
            heading: F::after_turn(compass, self.heading, next.heading, self.mirrored),
            mirrored: self.mirrored ^ next.mirrored,
            scale: self.scale * next.scale,
        }
    }
}

/// Units of the displacements and drawings of words: lines of one step, or modules that are replaced.
///
/// [`STEP`](Self::STEP) is the line, and the others follow in the order of their kinds.
pub(super) type Variable = usize;

/// Number of the line of one step among the variables.
pub(super) const STEP: Variable = 0;

/// Variable that is turned, at the end of a sum of displacements.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turned<H = u64> {
    pub(super) of: Variable,
    /// Number of the sum before it: of its place.
    pub(super) at: usize,
    pub(super) turn: Turn<H>,
}

/// Drawing of a word.
#[derive(Clone, Debug)]
pub(super) struct Reading<H = u64> {
    /// Last terms of all sums but the first, which is 0.
    pub(super) sums: Vec<Turned<H>>,
    /// Parts that are drawn.
    pub(super) parts: Vec<Turned<H>>,
    /// Number of the sum that is the place after the word.
    pub(super) end: usize,
    /// Direction after the word.
    pub(super) turn: Turn<H>,
}

impl<H> Reading<H> {
    /// Iterates over the terms of a sum, from the last to the first.
    pub(super) fn terms(&self, mut sum: usize) -> impl Iterator<Item = &Turned<H>> {
        std::iter::from_fn(move || {
            let last = &self.sums[sum.checked_sub(1)?];
            sum = last.at;
            Some(last)
        })
    }

    /// Iterates over the terms of the sums at which parts are drawn, each once.
    pub(super) fn terms_of_parts(&self) -> impl Iterator<Item = &Turned<H>> {
        let mut is_place = vec![false; self.sums.len() + 1];
        self.parts.iter().for_each(|part| is_place[part.at] = true);
        // A sum is that of an earlier one and a term.
        let sums = self.sums.iter().enumerate().rev();
        sums.filter_map(move |(before, last)| {
            let is_term = is_place[before + 1];
            is_place[last.at] |= is_term;
            is_term.then_some(last)
        })
    }
}

/// Directions after all variables at a step, and whether they draw.
pub(super) type Effects<H = u64> = Vec<(Turn<H>, bool)>;

/// Reader of the words of a system.
pub(super) struct Reader<'s, F: TurtleFrame = Frame2> {
    pub(super) system: &'s F::System,
    pub(super) compass: Compass,
    pub(super) kinds: &'s Kinds,
    /// Kinds that are replaced, in order.
    pub(super) fertile: Vec<usize>,
    /// Variables by kind, of those that are replaced.
    variables: Vec<Option<Variable>>,
    /// Work that is left.
    pub(super) budget: Budget,
}

impl<'s, F: TurtleFrame> Reader<'s, F> {
    pub(super) fn new(system: &'s F::System, kinds: &'s Kinds) -> Self {
        let all = 0..kinds.all.len();
        let fertile: Vec<usize> = all.filter(|&kind| kinds.all[kind].is_fertile()).collect();
        let variable = |kind: usize| fertile.binary_search(&kind).ok().map(|place| place + 1);
        Self {
            system,
            compass: Compass::of(F::words(system)),
            kinds,
            variables: (0..kinds.all.len()).map(variable).collect(),
            fertile,
            budget: Budget::new(),
        }
    }

    /// Reads the words that replace all variables, whose modules have effects.
    pub(super) fn replaced(
        &self,
        effects: &Effects<F::Heading>,
    ) -> Result<Vec<Reading<F::Heading>>, NoGrowth> {
        let word = |kind: &usize| &self.kinds.all[*kind].alternatives[0].word;
        let readings = self
            .fertile
            .iter()
            .map(|kind| self.read(word(kind), Some(effects)));
        readings.collect()
    }

    /// Reads all variables as modules that are not replaced.
    pub(super) fn kept(&self) -> Result<Vec<Reading<F::Heading>>, NoGrowth> {
        let readings = self.fertile.iter().map(|kind| self.read(&[*kind], None));
        readings.collect()
    }

    /// Reads a word whose modules have effects, or are not replaced.
    pub(super) fn read(
        &self,
        word: &[usize],
        effects: Option<&Effects<F::Heading>>,
    ) -> Result<Reading<F::Heading>, NoGrowth> {
        self.budget.spend(word.len())?;
        let mut reading = Reading {
            sums: Vec::new(),
            parts: Vec::new(),
            end: 0,
            turn: Turn::none::<F>(),
        };
        let mut saved = Vec::new();
        for &kind in word {
            match (self.variables[kind], effects) {
                (Some(variable), Some(effects)) => {
                    let (turn, draws) = effects[variable];
                    self.go(&mut reading, variable, 1.0, draws);
                    reading.turn = reading.turn.then::<F>(self.compass, turn);
                }
                _ => self.act(kind, &mut reading, &mut saved)?,
            }
        }
        Ok(reading)
    }

    /// Goes ahead by a variable.
    fn go(&self, reading: &mut Reading<F::Heading>, of: Variable, steps: f64, draws: bool) {
        let turned = Turned {
            of,
            at: reading.end,
            turn: Turn {
                scale: reading.turn.scale * steps,
                ..reading.turn
            },
        };
        if draws && turned.turn.scale != 0.0 {
            reading.parts.push(turned);
        }
        reading.sums.push(turned);
        reading.end = reading.sums.len();
    }

    /// Applies the actions of a module that is not replaced.
    fn act(
        &self,
        kind: usize,
        reading: &mut Reading<F::Heading>,
        saved: &mut Vec<(usize, Turn<F::Heading>)>,
    ) -> Result<(), NoGrowth> {
        let of = &self.kinds.all[kind];
        let turn = |axis: Axis, angle: &Program, reading: &mut Reading<F::Heading>| {
            let turn = Turn {
                heading: F::turn(self.compass, axis, angle.eval(&of.arguments)),
                ..Turn::none::<F>()
            };
            reading.turn = reading.turn.then::<F>(self.compass, turn);
        };
        let meaning = &F::words(self.system).symbols()[of.symbol].meaning;
        self.budget.spend(meaning.len())?;
        for action in meaning {
            match action {
                Action::Draw(steps) => {
                    self.go(reading, STEP, steps.eval(&of.arguments), true);
                }
                Action::Move(steps) | Action::Glide(steps) => {
                    self.go(reading, STEP, steps.eval(&of.arguments), false);
                }
                Action::Turn(angle) => turn(Axis::Up, angle, reading),
                Action::Pitch(angle) => turn(Axis::Left, angle, reading),
                Action::Roll(angle) => turn(Axis::Heading, angle, reading),
                Action::Reflect => reading.turn.mirrored ^= true,
                Action::Scale(factor) => reading.turn.scale *= factor.eval(&of.arguments),
                Action::Push => saved.push((reading.end, reading.turn)),
                Action::Pop => {
                    if let Some(state) = saved.pop() {
                        (reading.end, reading.turn) = state;
                    }
                }
                action if action.changes_appearance() => {}
                _ => return Err(NoGrowth::Actions),
            }
        }
        if reading.turn.scale.is_finite() && reading.turn.scale != 0.0 {
            Ok(())
        } else {
            Err(NoGrowth::Actions)
        }
    }
}
