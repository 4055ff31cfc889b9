//! Compilation of a rule to its graph: dependence on the moment is resolved into more objects.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::draws::Path;
use crate::expression::Dependence;
use crate::fast_hash::FastMap;
use crate::geometry::Point;
use crate::rule::{ElementContext, Part, Placement, Rule, RuleFrame, Selection};

use super::growing;
use super::state::{Class, Dependences, ElementState};
use crate::graph::{Alternative, CompileError, Graph, Object, Replacement, Successor};

/// Limit of the number of objects; beyond it the index is counted in walks instead of being resolved.
const MAX_OBJECTS: usize = 200_000;

/// Limit of the number of instances, with the same consequence.
const MAX_INSTANCES: usize = 2_000_000;
/// Limit of the work, with the same consequence: conditions that are tried, and counts of elements that
/// are carried along.
const MAX_WORK: usize = 20_000_000;

/// Limit of the number of objects up to which a graph is resolved for more steps than were requested.
const SOON: usize = 4_096;

impl<F: RuleFrame> Graph<F> {
    /// Compiles a rule to its graph, resolved for at least `steps` steps.
    ///
    /// # Errors
    ///
    /// If a generator yields points that are not finite within these steps.
    pub fn compile(rule: &Arc<Rule<F>>, steps: u32) -> Result<Self, CompileError> {
        Ok(growing::of_rule(rule, Self::whole(rule, steps)?))
    }

    /// Compiles a rule without the growth of a step.
    fn whole(rule: &Arc<Rule<F>>, steps: u32) -> Result<Self, CompileError> {
        let dependences = Dependences::of(rule);
        if !dependences.index_is_free {
            match Compiler::new(rule, dependences, steps).run() {
                Err(Stop::Irregular) => {}
                Err(Stop::Error(error)) => return Err(error),
                Ok(graph) => return Ok(graph),
            }
        }
        match Compiler::new(rule, Dependences::counted(), steps).run() {
            Ok(graph) => Ok(graph),
            Err(Stop::Error(error)) => Err(error),
            Err(Stop::Irregular) => unreachable!("counted rules have one object a class"),
        }
    }
}

/// Reason why a compilation stops.
enum Stop {
    /// The index cannot be resolved, or only with too much work.
    Irregular,
    Error(CompileError),
}

struct Compiler<'r, F: RuleFrame> {
    rule: &'r Arc<Rule<F>>,
    depends: Dependences,
    steps: u32,
    kinds: BTreeMap<Option<usize>, usize>,
    numbers: FastMap<(Class, ElementState), usize>,
    /// Class and state of every object, in the order of their numbers.
    keys: Vec<(Class, ElementState)>,
    objects: Vec<Object<F>>,
    /// Numbers of behaviours, by fertility, named generator and state.
    behaviours: FastMap<(bool, Option<usize>, ElementState), usize>,
    /// Replacements of behaviours, as far as known.
    replacements: FastMap<usize, Replacement<F>>,
    /// Number of instances and amount of work so far.
    instances: usize,
    work: usize,
    /// Replacement matrix modulo m for an age and step: one column for each kind.
    columns: FastMap<(u32, u32), Vec<Vec<u32>>>,
}

impl<'r, F: RuleFrame> Compiler<'r, F> {
    fn new(rule: &'r Arc<Rule<F>>, depends: Dependences, steps: u32) -> Self {
        // Kind 0 contains the infertile elements; other kinds differ in the selection of their generator.
        let mut kinds = BTreeMap::new();
        let listed = rule
            .initiator()
            .elements
            .iter()
            .chain(rule.generators().iter().flat_map(|g| g.elements()));
        for element in listed.filter(|element| element.fertile) {
            let next = kinds.len() + 1;
            kinds.entry(element.generator).or_insert(next);
        }
        Self {
            rule,
            depends,
            steps,
            kinds,
            numbers: FastMap::default(),
            keys: Vec::new(),
            objects: Vec::new(),
            behaviours: FastMap::default(),
            replacements: FastMap::default(),
            instances: 0,
            work: 0,
            columns: FastMap::default(),
        }
    }

    fn run(mut self) -> Result<Graph<F>, Stop> {
        let rule = self.rule;
        let state = ElementState {
            length: if self.depends.length {
                1f64.to_bits()
            } else {
                0
            },
            preceding: self.no_elements(),
            ..ElementState::default()
        };
        let lengths = |_: usize| 1.0;
        let objects = self.place(rule.initiator(), None, &state, lengths)?;
        let mut whole = Successor::default();
        let part = Part {
            placement: Placement::Stays,
            ..rule.initiator().clone()
        };
        whole.set(&[part], rule.initiator_points(), &objects);

        // Objects are reached breadth first: the objects of one depth have consecutive numbers.
        let mut resolved = 0;
        let mut depth = 0;
        while resolved < self.objects.len() {
            // Without dependence on time the set of objects closes soon: it is resolved for any number of
            // steps.
            let needed = depth < self.steps;
            if !needed && (self.depends.on_time() || self.objects.len() > SOON) {
                break;
            }
            let reached = self.objects.len();
            while resolved < reached {
                let replacement = match self.replacement(resolved) {
                    Err(Stop::Error(_)) if !needed => break,
                    replacement => replacement?,
                };
                self.objects[resolved].replacement = replacement;
                resolved += 1;
            }
            if resolved < reached {
                break;
            }
            depth += 1;
        }
        let beyond = self.objects.iter().any(Object::is_unresolved);
        let tints = self.objects.iter().any(|object| object.tint.is_some());
        let seeds = rule
            .generators()
            .iter()
            .flat_map(|generator| generator.parts())
            .any(|part| part.placement.seeds());
        Ok(Graph {
            source: Some(Arc::clone(rule) as _),
            origins: rule.generators().len(),
            depth: beyond.then_some(self.steps),
            regular: !self.depends.index_is_free,
            counts_index: self.depends.counts_index,
            draws: rule.is_random(),
            affine: rule.is_affine(),
            seeds,
            tints,
            middle: F::Point::of_coordinates([0.5, 0.0, 0.0]),
            ..Graph::of(
                self.objects,
                F::outlines(rule.base_elements()),
                vec![whole.body],
            )
        })
    }

    fn no_elements(&self) -> Vec<u32> {
        if self.depends.modulus > 1 {
            vec![0; self.kinds.len() + 1]
        } else {
            Vec::new()
        }
    }

    /// Adds to the counts of instances and of work. In graphs that count indices both are bounded by the
    /// length of the file, so there is no limit.
    fn spend(&mut self, instances: usize, work: usize) -> Result<(), Stop> {
        self.instances += instances;
        self.work += work;
        let too_much = self.instances > MAX_INSTANCES || self.work > MAX_WORK;
        if too_much && !self.depends.index_is_free {
            return Err(Stop::Irregular);
        }
        Ok(())
    }

    fn kind(&self, fertile: bool, generator: Option<usize>) -> usize {
        if fertile { self.kinds[&generator] } else { 0 }
    }

    /// Returns the number of an object, which is created if it is new.
    fn object(&mut self, class: Class, state: ElementState) -> Result<usize, Stop> {
        let state = if class.fertile {
            state
        } else {
            ElementState::default()
        };
        if let Some(&number) = self.numbers.get(&(class, state.clone())) {
            return Ok(number);
        }
        let number = self.objects.len();
        if number >= MAX_OBJECTS {
            return Err(Stop::Irregular);
        }
        let behaviours = self.behaviours.len();
        let becomes = (class.fertile, class.generator, state.clone());
        let behaviour = *self.behaviours.entry(becomes).or_insert(behaviours);
        self.objects.push(Object {
            visible: class.visible,
            origin: class.origin,
            tint: class.tint.0,
            index: Self::index(&state, self.depends.modulus),
            behaviour,
            replacement: if class.fertile {
                Replacement::Unresolved
            } else {
                Replacement::Kept
            },
            ..Object::kept(class.base_element)
        });
        self.keys.push((class, state.clone()));
        self.numbers.insert((class, state), number);
        Ok(number)
    }

    /// Returns the objects of a part's elements, by their place in the listing; `first` is the state of
    /// the element that is traversed first.
    fn place(
        &mut self,
        part: &Part,
        origin: Option<usize>,
        first: &ElementState,
        length: impl Fn(usize) -> f64,
    ) -> Result<Vec<usize>, Stop> {
        let count = part.elements.len();
        self.spend(count, count * first.preceding.len())?;
        let mut objects = vec![0; count];
        let mut preceding = first.preceding.clone();
        for turn in 0..count {
            let listed = if first.reversed {
                count - 1 - turn
            } else {
                turn
            };
            let element = &part.elements[listed];
            let mut state = ElementState {
                preceding: preceding.clone(),
                ..first.clone()
            };
            if self.depends.modulus > 1 {
                state.reversed ^= element.direction.is_reversed();
                let kind = self.kind(element.fertile, element.generator);
                preceding[kind] = (preceding[kind] + 1) % self.depends.modulus;
            }
            if self.depends.length {
                state.length = (f64::from_bits(first.length) * length(listed)).to_bits();
            }
            objects[listed] = self.object(Class::of(element, origin), state)?;
        }
        Ok(objects)
    }

    /// Returns the index of an element in a state, up to a multiple of the modulus.
    fn index(state: &ElementState, modulus: u32) -> u32 {
        state.preceding.iter().sum::<u32>() % modulus + 1
    }

    /// Returns the values that expressions see of an element in a state; `index` represents all indices
    /// that are equal to it modulo m.
    fn moment(state: &ElementState, index: u32) -> ElementContext {
        ElementContext {
            index: f64::from(index),
            age: f64::from(state.age),
            step: f64::from(state.step),
            length: f64::from_bits(state.length),
        }
    }

    /// Returns the number of conditions that are evaluated to find the generator of an element; long ones count as several.
    fn conditions(&self, generator: Option<usize>) -> usize {
        let programs = self.rule.selection().programs();
        match generator {
            Some(_) => 1,
            None => 1 + programs.map(|program| 1 + program.work()).sum::<usize>(),
        }
    }

    /// Returns the generators that may replace an element.
    fn candidates(&self, generator: Option<usize>, moment: &ElementContext) -> Vec<usize> {
        if let Some(named) = generator {
            return vec![named];
        }
        let selection = self.rule.selection();
        let undecided = match selection {
            Selection::AtRandom(_) => true,
            Selection::ByCondition { .. } => {
                self.depends.index_is_free
                    || !self.depends.length
                        && selection.programs().any(|condition| {
                            condition.dependence(ElementContext::LENGTH) != Dependence::None
                        })
            }
            Selection::ByIndex(_) => self.depends.index_is_free,
            Selection::Always(_) => false,
        };
        if undecided {
            selection.candidates()
        } else {
            vec![selection.select(moment, Path::of_seed(0))]
        }
    }

    fn replacement(&mut self, number: usize) -> Result<Replacement<F>, Stop> {
        let behaviour = self.objects[number].behaviour;
        if let Some(known) = self.replacements.get(&behaviour) {
            return Ok(known.clone());
        }
        let replacement = self.new_replacement(number)?;
        self.replacements.insert(behaviour, replacement.clone());
        Ok(replacement)
    }

    fn new_replacement(&mut self, number: usize) -> Result<Replacement<F>, Stop> {
        let (class, state) = self.keys[number].clone();
        if !class.fertile {
            return Ok(Replacement::Kept);
        }
        self.spend(0, self.conditions(class.generator))?;
        let modulus = self.depends.modulus;
        let index = Self::index(&state, modulus);
        let moment = Self::moment(&state, index);
        let candidates = self.candidates(class.generator, &moment);
        let body = ElementState {
            age: if self.depends.age { state.age + 1 } else { 0 },
            step: if self.depends.step { state.step + 1 } else { 0 },
            preceding: self.advanced(&state)?,
            ..state.clone()
        };
        let seed = ElementState {
            age: 0,
            preceding: self.no_elements(),
            ..body.clone()
        };
        let decided = candidates.len() == 1;
        let mut alternatives = Vec::new();
        for generator in candidates {
            let rule = self.rule;
            let listed = &rule.generators()[generator];
            let points = self.fixed_points(generator, &moment)?;
            let length = |part: &Part, index: usize| {
                let element = &part.elements[index];
                let [from, to] = [element.from, element.to].map(|number| points[number]);
                (to - from).length()
            };
            let mut next = body.clone();
            // Parts that stay follow each other in the order of traversal.
            let mut order: Vec<usize> = (0..listed.parts().len()).collect();
            if state.reversed {
                order.reverse();
            }
            let mut of_parts = vec![Vec::new(); order.len()];
            for part_number in order {
                let part = &listed.parts()[part_number];
                let mut first = if part.placement.seeds() {
                    seed.clone()
                } else {
                    next.clone()
                };
                if part.placement == Placement::SeedsAsInitiator {
                    first.reversed = false;
                    if self.depends.length {
                        first.length = 1f64.to_bits();
                    }
                }
                of_parts[part_number] =
                    self.place(part, Some(generator), &first, |index| length(part, index))?;
                if !part.placement.seeds() && modulus > 1 {
                    for element in &part.elements {
                        let kind = self.kind(element.fertile, element.generator);
                        next.preceding[kind] = (next.preceding[kind] + 1) % modulus;
                    }
                }
            }
            let objects: Vec<usize> = of_parts.into_iter().flatten().collect();
            if decided && self.is_fixed(generator) {
                let mut successor = Successor::default();
                successor.set(listed.parts(), &points, &objects);
                return Ok(Replacement::Fixed(Arc::new(successor)));
            }
            alternatives.push(Alternative { generator, objects });
        }
        Ok(Replacement::Evaluated(alternatives.into()))
    }

    /// Returns whether the points of a generator are equal for all elements in one state.
    fn is_fixed(&self, generator: usize) -> bool {
        let listed = &self.rule.generators()[generator];
        !listed.is_random()
            && listed.programs().all(|program| {
                let none = |slot| program.dependence(slot) == Dependence::None;
                (self.depends.age || none(ElementContext::AGE))
                    && (self.depends.step || none(ElementContext::STEP))
                    && (self.depends.length || none(ElementContext::LENGTH))
                    && (!self.depends.counts_index || none(ElementContext::INDEX))
            })
    }

    /// Returns the points of a generator that does not depend on the element; zeros for a generator that
    /// draws or that is evaluated for each element.
    fn fixed_points(
        &self,
        generator: usize,
        moment: &ElementContext,
    ) -> Result<Vec<F::Point>, Stop> {
        let listed = &self.rule.generators()[generator];
        let mut points = vec![F::Point::ZERO; listed.points.len()];
        if self.is_fixed(generator) {
            listed.evaluate(moment, Path::of_seed(0), &mut Vec::new(), &mut points);
            if !points.iter().all(|point| point.is_finite()) {
                return Err(Stop::Error(CompileError::not_finite(listed.name(), moment)));
            }
        }
        Ok(points)
    }

    /// Returns the counts of elements before the first child of an element in a state: the replacement
    /// matrix applied to the counts before the element.
    fn advanced(&mut self, state: &ElementState) -> Result<Vec<u32>, Stop> {
        let modulus = self.depends.modulus;
        if modulus == 1 {
            return Ok(Vec::new());
        }
        self.spend(0, state.preceding.len() * state.preceding.len())?;
        let when = (state.age, state.step);
        if !self.columns.contains_key(&when) {
            let columns = self.replacement_matrix(state)?;
            self.columns.insert(when, columns);
        }
        let columns = &self.columns[&when];
        let mut advanced = vec![0; state.preceding.len()];
        for (column, &count) in columns.iter().zip(&state.preceding) {
            for (sum, entry) in advanced.iter_mut().zip(column) {
                *sum = (*sum + entry * count) % modulus;
            }
        }
        Ok(advanced)
    }

    /// Returns the replacement matrix modulo m: one column for each kind, with the numbers of children
    /// that stay by kind.
    ///
    /// The compilation is irregular if the possible generators of an element differ in these numbers.
    fn replacement_matrix(&mut self, state: &ElementState) -> Result<Vec<Vec<u32>>, Stop> {
        let modulus = self.depends.modulus;
        let size = self.kinds.len() + 1;
        self.spend(0, size * size)?;
        let mut columns = vec![vec![0; size]; size];
        columns[0][0] = 1;
        for (names, kind) in self.kinds.clone() {
            let mut known: Option<Vec<u32>> = None;
            for index in 1..=modulus {
                self.spend(0, self.conditions(names))?;
                for generator in self.candidates(names, &Self::moment(state, index)) {
                    let rule = self.rule;
                    let listed = &rule.generators()[generator];
                    self.spend(0, size + listed.elements().count())?;
                    let mut column = vec![0; size];
                    let parts = listed.parts();
                    for part in parts.iter().filter(|part| !part.placement.seeds()) {
                        for element in &part.elements {
                            let kind = self.kind(element.fertile, element.generator);
                            column[kind] = (column[kind] + 1) % modulus;
                        }
                    }
                    if known.as_ref().is_some_and(|known| *known != column) {
                        return Err(Stop::Irregular);
                    }
                    known = Some(column);
                }
            }
            columns[kind] = known.unwrap_or_else(|| vec![0; size]);
        }
        Ok(columns)
    }
}
