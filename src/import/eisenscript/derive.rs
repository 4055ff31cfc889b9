//! Derivation of a program, generation by generation as Structure Synth builds it.
//!
//! All calls of a generation are carried out before those that they make, and a primitive is drawn in the generation after
//! its call. Before a generation begins, the numbers of generations and of objects, and that of waiting calls, are held
//! against their limits. A rule with `md n` is applied n times on each path of calls; then its successor is applied in its
//! place, and the count begins anew.
//!
//! A *state* is an alternative with the counts on which its content depends. States are shared between all calls, except
//! those whose content is drawn at random: each call has its own. One that draws a mesh without a transformation depends on
//! the last transformation before it.

use std::collections::{BTreeMap, BTreeSet};

use crate::random::Pcg;
use crate::style::Colour;

use super::mesh::{Passage, Passages};
use super::program::{Alternative, Primitive, Program, TOP, Target};

/// Largest number of states.
const MAX_STATES: usize = 12_000;

/// Number of further states, of calls with few generations left.
const MORE_STATES: usize = 4000;

/// Largest number of calls in states.
const MAX_CALLS: usize = 60_000;

/// Largest number of calls in states, where each is written for itself because some are drawn at random.
const MAX_DRAWN_CALLS: usize = 8000;

/// Largest number of generations.
const MAX_GENERATIONS: u32 = 10_000;

/// Largest number of calls that are looked at in all generations.
const MAX_LOOKS: usize = 20_000_000;

/// An alternative, and what its content depends on.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct State {
    pub(super) alternative: usize,
    /// Numbers of times that alternatives are still applied, where they differ from those at the beginning.
    pub(super) left: BTreeMap<usize, u32>,
    /// Absolute colour, as red, green, blue and alpha.
    pub(super) colour: Option<[u8; 4]>,
    /// Number of a state whose content is drawn at random.
    pub(super) serial: Option<usize>,
    /// Number of the last passage before it, if it draws a mesh by it.
    pub(super) passage: Option<usize>,
}

/// A call in the content of a state.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Call {
    /// Number of the action of the alternative.
    pub(super) action: usize,
    /// Number of times that each loop is applied, in a single copy; `None` for all copies.
    pub(super) times: Option<Vec<u32>>,
    pub(super) callee: Callee,
    /// Absolute colour of the callee.
    pub(super) colour: Option<[u8; 4]>,
}

/// State or primitive that is called.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Callee {
    State(usize),
    Primitive(Primitive),
    /// Mesh along a passage.
    Mesh(usize),
    /// Rule that has ended without a successor, whose call takes up room all the same.
    Nothing,
}

/// A derivation that is too large.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooLarge;

/// End of a derivation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// No calls are left.
    Complete,
    /// The number of generations is the largest one.
    Generations(u32),
    /// There are enough objects or calls after so many generations.
    Objects(u32),
    /// After so many generations, another one would draw too much at random.
    Draws(u32),
}

pub(super) struct Derivation<'a> {
    pub(super) program: &'a Program,
    pub(super) states: Vec<State>,
    known: BTreeMap<State, usize>,
    contents: Vec<Option<Vec<Call>>>,
    pub(super) passages: Passages,
    /// Number of calls in all contents.
    size: usize,
    /// Largest numbers of states and of calls.
    most: [usize; 2],
    /// Alternatives that each one leads to.
    reached: Vec<Vec<bool>>,
    /// Whether the content of an alternative depends on draws.
    is_random: Vec<bool>,
    /// Whether the content of an alternative depends on the passage before it.
    looks_back: Vec<bool>,
    /// Rules that have been drawn from.
    pub(super) drawn: BTreeSet<usize>,
    /// Numbers of generations after which nothing is left, as far as they are known: `u32::MAX` without an end.
    heights: Vec<Option<u32>>,
    /// Numbers of generations after which the first primitive is drawn: `u32::MAX` without one.
    firsts: Vec<Option<u32>>,
    random: Pcg,
}

impl<'a> Derivation<'a> {
    pub(super) fn new(program: &'a Program, random: Pcg) -> Self {
        let all = 0..program.alternatives.len();
        let reached: Vec<_> = all.map(|it| program.reached([it])).collect();
        let choices = |alternative: &Alternative| {
            let actions = alternative.actions.iter().map(|action| action.target);
            let mut targets = actions.chain(alternative.successor);
            targets.any(|target| program.alternatives_of(target).len() > 1)
        };
        let chooses: Vec<_> = program.alternatives.iter().map(choices).collect();
        let leads = |reached: &Vec<bool>| reached.iter().zip(&chooses).any(|(a, b)| *a && *b);
        let is_random = reached.iter().map(leads).collect();
        let mut derivation = Self {
            program,
            states: Vec::new(),
            known: BTreeMap::new(),
            contents: Vec::new(),
            passages: Passages::default(),
            size: 0,
            most: [MAX_STATES, MAX_CALLS],
            reached,
            is_random,
            looks_back: program.looks_back(),
            drawn: BTreeSet::new(),
            heights: Vec::new(),
            firsts: Vec::new(),
            random,
        };
        if derivation.is_random[TOP] {
            derivation.most[1] = MAX_DRAWN_CALLS;
        }
        derivation.add(State {
            alternative: TOP,
            left: BTreeMap::new(),
            colour: None,
            serial: derivation.is_random[TOP].then_some(0),
            passage: None,
        });
        derivation
    }

    fn add(&mut self, state: State) -> usize {
        let number = self.states.len();
        self.known.insert(state.clone(), number);
        self.states.push(state);
        self.contents.push(None);
        self.heights.push(None);
        self.firsts.push(None);
        number
    }

    /// Returns the number of a state, which is added if it is new.
    pub(super) fn number(&mut self, state: State) -> Result<usize, TooLarge> {
        match self.known.get(&state) {
            Some(number) => Ok(*number),
            None if self.states.len() >= self.most[0] => Err(TooLarge),
            None => Ok(self.add(state)),
        }
    }

    /// Returns the number of times that an alternative is applied from a state on.
    pub(super) fn left(&self, left: &BTreeMap<usize, u32>, alternative: usize) -> Option<u32> {
        let depth = self.program.alternatives[alternative].depth?;
        Some(left.get(&alternative).copied().unwrap_or(depth))
    }

    /// Returns the content of a state.
    pub(super) fn content(&mut self, number: usize) -> Result<&[Call], TooLarge> {
        if self.contents[number].is_none() {
            let content = self.expanded(number)?;
            self.size += content.len();
            self.contents[number] = Some(content);
        }
        Ok(self.contents[number].as_deref().unwrap_or_default())
    }

    fn expanded(&mut self, number: usize) -> Result<Vec<Call>, TooLarge> {
        let state = self.states[number].clone();
        let program = self.program;
        let mut left = state.left.clone();
        if let Some(count) = self.left(&left, state.alternative) {
            left.insert(state.alternative, count.saturating_sub(1));
        }
        let mut calls = Vec::new();
        for (action, written) in program.alternatives[state.alternative]
            .actions
            .iter()
            .enumerate()
        {
            let absolute = { written.loops.iter().rev() }.find_map(|it| it.colouring.absolute);
            let colour = absolute.map(Colour::rgba).or(state.colour);
            let alternatives = program.alternatives_of(written.target);
            let is_drawn =
                alternatives.len() > 1 || alternatives.iter().any(|it| self.is_random[*it]);
            let looks_back = written.target == Target::Mesh
                || alternatives.iter().any(|it| self.looks_back[*it]);
            let counts: Vec<u32> = written.loops.iter().map(|it| it.count).collect();
            let copies = { counts.iter() }.try_fold(1_usize, |all, count| {
                all.checked_mul(usize::try_from(*count).ok()?)
            });
            let is_single = copies == Some(1);
            let mut times = vec![1; counts.len()];
            let passed = |of: &mut Self, times: &[u32]| match written.loops.is_empty() {
                true => state.passage,
                false => looks_back.then(|| {
                    let passage = Passage {
                        alternative: state.alternative,
                        action,
                        times: times.to_vec(),
                    };
                    of.passages.number(passage)
                }),
            };
            if !(is_drawn || looks_back) || is_single {
                let passage = passed(self, &times);
                calls.push(Call {
                    action,
                    times: None,
                    callee: self.callee(written.target, left.clone(), colour, passage)?,
                    colour,
                });
                self.check(calls.len())?;
                continue;
            }
            for _ in 0..copies.ok_or(TooLarge)? {
                let passage = passed(self, &times);
                calls.push(Call {
                    action,
                    times: Some(times.clone()),
                    callee: self.callee(written.target, left.clone(), colour, passage)?,
                    colour,
                });
                self.check(calls.len())?;
                for (time, count) in times.iter_mut().zip(&counts) {
                    *time += 1;
                    if *time <= *count {
                        break;
                    }
                    *time = 1;
                }
            }
        }
        Ok(calls)
    }

    fn check(&self, more: usize) -> Result<(), TooLarge> {
        match self.size + more > self.most[1] {
            true => Err(TooLarge),
            false => Ok(()),
        }
    }

    /// Returns what a call leads to.
    fn callee(
        &mut self,
        mut target: Target,
        mut left: BTreeMap<usize, u32>,
        colour: Option<[u8; 4]>,
        passage: Option<usize>,
    ) -> Result<Callee, TooLarge> {
        loop {
            let rule = match target {
                Target::Mesh => {
                    // Nothing lies before the first state, and some passages lead nowhere.
                    let sides = |it| self.passages.get(it).sides(self.program);
                    let passage = passage.filter(|it| !sides(*it).is_empty());
                    return Ok(passage.map_or(Callee::Nothing, Callee::Mesh));
                }
                Target::Primitive(primitive) => return Ok(Callee::Primitive(primitive)),
                Target::Rule(rule) => rule,
            };
            let Some(alternative) = self.choice(rule) else {
                return Ok(Callee::Nothing);
            };
            if self.left(&left, alternative) == Some(0) {
                left.remove(&alternative);
                match self.program.alternatives[alternative].successor {
                    Some(successor) => target = successor,
                    None => return Ok(Callee::Nothing),
                }
                continue;
            }
            let reached = &self.reached[alternative];
            left.retain(|counted, count| {
                reached[*counted] && self.program.alternatives[*counted].depth != Some(*count)
            });
            let serial = self.is_random[alternative].then_some(self.states.len());
            let state = State {
                alternative,
                left,
                colour,
                serial,
                passage: passage.filter(|_| self.looks_back[alternative]),
            };
            return Ok(Callee::State(self.number(state)?));
        }
    }

    /// Chooses an alternative of a rule by their weights.
    fn choice(&mut self, rule: usize) -> Option<usize> {
        let alternatives = &self.program.rules[rule].alternatives;
        if let [] | [_] = alternatives[..] {
            return alternatives.first().copied();
        }
        self.drawn.insert(rule);
        let weight = |it: &usize| self.program.alternatives[*it].weight;
        let mut rest = self.random.unit() * alternatives.iter().map(weight).sum::<f64>();
        let chosen = alternatives.iter().find(|it| {
            rest -= weight(it);
            rest < 0.0
        });
        chosen.or(alternatives.first()).copied()
    }

    /// Builds the generations, and returns how they end.
    pub(super) fn build(&mut self) -> Result<End, TooLarge> {
        let end = self.generations();
        self.most = [MAX_STATES + MORE_STATES, 2 * MAX_CALLS];
        end
    }

    fn generations(&mut self) -> Result<End, TooLarge> {
        let settings = &self.program.settings;
        let (generations, most) = (settings.generations, settings.objects);
        let mut waiting = BTreeMap::from([(0_usize, 1_u64)]);
        let (mut primitives, mut nothing) = (0_u64, 0_u64);
        let (mut objects, mut generation, mut looks) = (0_u64, 0, 0_usize);
        loop {
            let others = primitives.saturating_add(nothing);
            let calls = { waiting.values() }.fold(others, |all, count| all.saturating_add(*count));
            if calls == 0 {
                return Ok(End::Complete);
            } else if generation == generations {
                return Ok(End::Generations(generation));
            } else if objects >= most || calls >= most {
                return Ok(End::Objects(generation));
            } else if generation == MAX_GENERATIONS {
                return Err(TooLarge);
            }
            for state in waiting.keys() {
                match self.content(*state).map(<[Call]>::len) {
                    Ok(calls) => looks += 1 + calls,
                    Err(TooLarge) if generation > 1 && self.is_random[TOP] => {
                        return Ok(End::Draws(generation));
                    }
                    Err(TooLarge) => return Err(TooLarge),
                }
            }
            if looks > MAX_LOOKS {
                return Err(TooLarge);
            }
            objects = objects.saturating_add(primitives);
            (primitives, nothing) = (0, 0);
            let mut next = BTreeMap::new();
            for (state, count) in waiting {
                let actions = &self.program.alternatives[self.states[state].alternative].actions;
                for call in self.contents[state].iter().flatten() {
                    let loops = actions[call.action].loops.iter();
                    let copies = match call.times {
                        Some(_) => count,
                        None => loops.fold(count, |all, it| all.saturating_mul(it.count.into())),
                    };
                    let all = match call.callee {
                        Callee::State(state) => next.entry(state).or_insert(0_u64),
                        Callee::Primitive(_) | Callee::Mesh(_) => &mut primitives,
                        Callee::Nothing => &mut nothing,
                    };
                    *all = all.saturating_add(copies);
                }
            }
            waiting = next;
            generation += 1;
        }
    }

    /// Returns the number of generations after which nothing is left of a state; `u32::MAX` if it has no end, or if what it
    /// draws has not been drawn.
    pub(super) fn height(&mut self, number: usize) -> Result<u32, TooLarge> {
        // States on the way from the first one, with the next of their calls and the height so far.
        let mut way = vec![(number, 0, 1_u32)];
        let mut is_on_way = BTreeSet::from([number]);
        loop {
            let Some((state, next, height)) = way.last().copied() else {
                return Ok(self.heights[number].unwrap_or(u32::MAX));
            };
            if let Some(known) = self.heights[state] {
                way.pop();
                is_on_way.remove(&state);
                if let Some((_, _, height)) = way.last_mut() {
                    *height = (*height).max(known.saturating_add(1));
                }
                continue;
            }
            let is_open = self.states[state].serial.is_some() && self.contents[state].is_none();
            let call = match is_open {
                true => None,
                false => self.content(state)?.get(next).map(|call| call.callee),
            };
            let last = way.len() - 1;
            way[last].1 += 1;
            match call {
                _ if is_open => self.heights[state] = Some(u32::MAX),
                None => self.heights[state] = Some(height),
                Some(Callee::State(callee)) if is_on_way.contains(&callee) => {
                    self.heights[state] = Some(u32::MAX);
                }
                Some(Callee::State(callee)) => {
                    way.push((callee, 0, 1));
                    is_on_way.insert(callee);
                }
                Some(Callee::Primitive(_) | Callee::Mesh(_) | Callee::Nothing) => {
                    way[last].2 = height.max(2)
                }
            }
        }
    }

    /// Returns the number of generations after which a state draws its first primitive; `u32::MAX` if it draws none.
    pub(super) fn first(&mut self, number: usize) -> Result<u32, TooLarge> {
        if let Some(known) = self.firsts[number] {
            return Ok(known);
        }
        // States with those that call them.
        let mut seen = BTreeMap::from([(number, None)]);
        let mut generation = vec![number];
        while !generation.is_empty() {
            let mut next = Vec::new();
            for state in generation {
                if self.states[state].serial.is_some() && self.contents[state].is_none() {
                    continue;
                }
                for call in self.content(state)? {
                    match call.callee {
                        Callee::Primitive(_) | Callee::Mesh(_) => {
                            // All states on a shortest way are known with it.
                            let mut way = Some(state);
                            let mut first = 2;
                            while let Some(state) = way {
                                self.firsts[state] = Some(first);
                                first += 1;
                                way = seen[&state];
                            }
                            return Ok(first - 1);
                        }
                        Callee::State(callee) if !seen.contains_key(&callee) => {
                            seen.insert(callee, Some(state));
                            next.push(callee);
                        }
                        Callee::State(_) | Callee::Nothing => {}
                    }
                }
            }
            generation = next;
        }
        for state in seen.into_keys() {
            self.firsts[state] = Some(u32::MAX);
        }
        Ok(u32::MAX)
    }
}
