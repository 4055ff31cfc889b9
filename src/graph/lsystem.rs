//! From an L-system to its graph.

use std::collections::BTreeMap;

use crate::diagnostic::Diagnostic;
use crate::geometry::{Bounds, DVec2};
use crate::instancing::Tint;
use crate::lsystem::{Drawing, LSystem, Placed, RewriteError};
use crate::rule::BaseElement;

use super::{Chain, CompileError, Graph, Instance, Object, Replacement};

impl Graph {
    /// Compiles an L-system to a graph whose initiator is what the turtle draws after so many steps: the
    /// coordinates are the turtle's.
    ///
    /// # Errors
    ///
    /// If there are more elements than are allowed, or if numbers are not finite.
    pub fn of_lsystem(
        system: &LSystem,
        steps: u32,
        seed: u64,
        most_elements: u64,
    ) -> Result<Self, CompileError> {
        let word = system.word(steps, seed, most_elements)?;
        let drawing = system.draw(&word);
        let mut strings = Strings::new(system);
        let initiator = strings.of_string(&drawing)?;
        let mut bounds = Bounds::EMPTY;
        for instance in &initiator.instances {
            let base_element = strings.objects[instance.object].base_element;
            strings.base_elements[base_element].add_to(&mut bounds, &instance.frame.map, 0.0);
        }
        let mut graph = Self {
            rule: None,
            base_elements: strings.base_elements.into(),
            origins: 0,
            tints: strings.objects.iter().any(|object| object.tint.is_some()),
            objects: strings.objects,
            initiator,
            depth: None,
            regular: true,
            counts_index: false,
            draws: !system.is_deterministic(),
            seeds: false,
            affine: false,
            unit: 1.0,
            middle: DVec2::ZERO,
        };
        if !bounds.is_empty() {
            graph.middle = (bounds.min() + bounds.max()) / 2.0;
        }
        Ok(graph)
    }
}

impl LSystem {
    /// The error as a mistake in the file that the system was read from.
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

/// Makes objects of what turtles draw: one for every base element and colour.
struct Strings<'s> {
    system: &'s LSystem,
    base_elements: Vec<BaseElement>,
    objects: Vec<Object>,
    numbers: BTreeMap<(usize, Option<i64>), usize>,
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

    /// What a turtle drew, as elements that are kept.
    fn of_string(&mut self, drawing: &Drawing) -> Result<Chain, CompileError> {
        let first = self.base_elements.len();
        self.base_elements.extend(drawing.polygons.iter().cloned());
        let mut instances = Vec::with_capacity(drawing.elements.len());
        for (position, placed) in (0..).zip(&drawing.elements) {
            if !placed.frame.map.is_finite() {
                return Err(CompileError::TooFar);
            }
            let base_element = placed.polygon.map_or(0, |number| first + number);
            instances.push(Instance {
                frame: placed.frame,
                length: placed.frame.length(),
                joined: placed.joined,
                position,
                object: self.object(placed, base_element),
            });
        }
        Ok(Chain {
            instances,
            meets_frame: [false; 2],
        })
    }

    fn object(&mut self, placed: &Placed, base_element: usize) -> usize {
        let colour = self.system.has_colours().then_some(placed.colour);
        let made = self.objects.len();
        let number = *self.numbers.entry((base_element, colour)).or_insert(made);
        if number == made {
            let palette = &self.system.heading.style.palette;
            self.objects.push(Object {
                base_element,
                visible: true,
                origin: None,
                last_map: None,
                tint: colour.map(|index| Tint {
                    colour: palette.entry(index),
                    alpha: 1.0,
                }),
                behaviour: 0,
                replacement: Replacement::Kept,
            });
        }
        number
    }
}
