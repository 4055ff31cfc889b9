//! Compilation of an L-system to its graph.
//!
//! A module derived for some steps has the same *effect* on the turtle wherever the turtle meets it: it
//! moves, turns, reflects and scales the turtle, changes the attributes of its lines, and draws. Effects
//! follow from the bottom up: those of a module with n steps left from those of the modules of its
//! successor with n - 1. Headings are exact fractions of a turn, and lengths have separate exponents.
//!
//! Objects are modules with the number of steps that are left ([levels]); where all levels are similar,
//! one object represents them ([similar], edge rewriting). For random productions, the positions within a
//! word are computed from its path ([words]). Systems with contexts, and systems whose graphs would be
//! too large, are derived as strings.

mod effects;
mod far;
mod kinds;
mod levels;
mod long;
mod paint;
mod reader;
mod similar;
mod state;
mod words;

pub(crate) use similar::Chords;

use std::collections::BTreeMap;

use crate::diagnostic::Diagnostic;
use crate::geometry::Bounds;
use crate::instancing::Thickness;
use crate::lsystem::{LSystem, Placed, RewriteError, Turtle};
use crate::rule::BaseElement;

use self::effects::Effects;
use crate::graph::{Chain, CompileError, Graph, Instance, Object};

impl Graph {
    /// Compiles an L-system for a number of steps: by edge rewriting, otherwise to objects by module and
    /// level, otherwise from the elements that the turtle draws of the derived word.
    ///
    /// # Errors
    ///
    /// As for [`Graph::of_derived_word`], if the system cannot be compiled in the other ways.
    pub fn of_lsystem(
        system: &LSystem,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Self, CompileError> {
        let levels = |NotCompiled| {
            let effects = Effects::of_system(system, steps)?;
            Self::of_levels(effects, steps)
        };
        match Self::of_edges(system).or_else(levels) {
            Ok(graph) => Ok(graph),
            Err(NotCompiled) => Self::of_derived_word(system, steps, seed, max_elements),
        }
    }

    /// Compiles an L-system to a graph whose initiator consists of the elements that the turtle draws
    /// after `steps` steps, in the coordinates of the turtle.
    ///
    /// # Errors
    ///
    /// If there are more than `max_elements` elements, or if numbers are not finite.
    pub fn of_derived_word(
        system: &LSystem,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Self, CompileError> {
        let mut turtle = Turtle::new(system);
        let mut strings = Strings::new(system);
        let mut instances = Vec::new();
        system.read(steps, seed, max_elements, |symbol, arguments| {
            turtle.read(symbol, arguments);
            let drawn = turtle.drawing.elements.drain(..);
            instances.extend(drawn.map(|placed| strings.instance(&placed)));
        })?;
        for (position, instance) in (0..).zip(&mut instances) {
            instance.position = position;
            if !instance.frame.is_finite() {
                return Err(CompileError::TooFar);
            }
        }
        strings.base_elements.extend(turtle.drawing.polygons);
        let initiator = Chain::loose(instances);
        let mut bounds = Bounds::EMPTY;
        for instance in &initiator.instances {
            let base_element = strings.objects[instance.object].base_element;
            strings.base_elements[base_element].add_to(&mut bounds, &instance.frame, 0.0);
        }
        let mut graph = Self {
            tints: system.has_colours(),
            draws: !system.is_deterministic(),
            ..Self::of(strings.objects, strings.base_elements, vec![initiator])
        };
        graph.find_widths();
        if !bounds.is_empty() {
            graph.middle = bounds.centre();
        }
        Ok(graph)
    }
}

impl LSystem {
    /// Converts the error to a diagnostic of the file from which the system was read.
    pub(crate) fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        let diagnostic = Diagnostic::error(error.to_string());
        match error {
            CompileError::Word(RewriteError::NotFinite { production, .. }) => diagnostic
                .at(&self.productions[*production].origin.0)
                .hint("a condition keeps a module as it is: A(x) : x != 0 -> A(1/x)"),
            _ => diagnostic,
        }
    }
}

/// Failure: a system cannot be compiled, or only to a graph that is too large; it is derived as a string.
#[derive(Clone, Copy, Debug, PartialEq)]
struct NotCompiled;

/// Creates objects of the elements that turtles draw: one for every base element, colour and width.
struct Strings<'s> {
    system: &'s LSystem,
    base_elements: Vec<BaseElement>,
    objects: Vec<Object>,
    numbers: BTreeMap<(usize, Option<i64>, u64), usize>,
}

impl<'s> Strings<'s> {
    fn new(system: &'s LSystem) -> Self {
        Self {
            system,
            base_elements: vec![BaseElement::line()],
            objects: Vec::new(),
            numbers: BTreeMap::new(),
        }
    }

    /// Returns an element that a turtle drew as an instance that is kept.
    fn instance(&mut self, placed: &Placed) -> Instance {
        // Base element 0 is the line; polygons follow.
        let base_element = placed.polygon.map_or(0, |number| number + 1);
        Instance {
            joined: placed.joined,
            ..Instance::new(self.object(placed, base_element), placed.frame, 0)
        }
    }

    fn object(&mut self, placed: &Placed, base_element: usize) -> usize {
        let colour = self.system.has_colours().then_some(placed.colour);
        let made = self.objects.len();
        let key = (base_element, colour, placed.width.to_bits());
        let number = *self.numbers.entry(key).or_insert(made);
        if number == made {
            let palette = &self.system.metadata.style.palette;
            self.objects.push(Object {
                paint: colour.map(|index| palette.entry(index)),
                thickness: Some(Thickness::Set(placed.width)).filter(|_| placed.width != 1.0),
                ..Object::kept(base_element)
            });
        }
        number
    }
}

#[cfg(test)]
mod tests;
