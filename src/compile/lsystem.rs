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

mod chords;
mod effects;
mod far;
mod kinds;
mod levels;
mod limit;
mod long;
mod paint;
mod reader;
mod similar;
mod state;
mod words;
mod work;
mod worn;

pub(crate) use chords::Chords;

use std::collections::{BTreeMap, BTreeSet};

use crate::diagnostic::Diagnostic;
use crate::geometry::{Affine as _, Bounds, Frame3, Outline as _};
use crate::instancing::Thickness;
use crate::lsystem::{
    Drawing, Drawn, GrowingTurtle, LSystem, LSystemInSpace, NoGrowth, Placed, RewriteError,
    TubePart, Turtle, TurtleFrame,
};
use crate::rule::{GrowthStart, RuleFrame as _};
use crate::style::Tube;
use crate::tween::Growing;

use self::effects::Effects;
use self::levels::{Levels, levels};
use self::limit::Limit;
use crate::graph::{Chain, CompileError, Graph, Instance, Object, Replacement};

impl Graph {
    /// Compiles an L-system for a number of steps: by edge rewriting, otherwise to objects by module and
    /// level, otherwise from the elements that the turtle draws of the derived word. The graph of a system that stands for
    /// its limit set has that set, or the reason why there is none.
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
        if system.in_limit {
            match Limit::of(system, 0).and_then(|limit| limit.graph()) {
                Ok(graph) => return Ok(graph),
                Err(reason) => {
                    let words = LSystem {
                        in_limit: false,
                        ..system.clone()
                    };
                    let graph = Self::of_lsystem(&words, steps, seed, max_elements)?;
                    return Ok(Self {
                        no_limit: Some(reason.into()),
                        ..graph
                    });
                }
            }
        }
        let levels = || {
            let effects = Effects::of_system(system, steps)?;
            Self::of_levels(effects, steps)
        };
        match (Self::of_edges(system), system.growing) {
            (Ok(graph), Some(growing @ Growing { share, .. })) => Ok(graph
                .growing(growing, move |_, frame, _| {
                    frame.grown(GrowthStart::Chord, share)
                })),
            (Ok(graph), None) => Ok(graph),
            (Err(NotCompiled), None) => levels().or_else(|NotCompiled| {
                let derived = Self::of_derived_word(system, steps, seed, max_elements);
                derived.map_err(|error| large(system, steps, error))
            }),
            (Err(NotCompiled), Some(_)) => Self::of_derived_word(system, steps, seed, max_elements),
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
        derived(system, (steps, seed, max_elements), None).map(|(graph, _)| graph)
    }
}

/// Returns the graph whose initiator consists of the elements that the turtle draws of a word, with its base elements;
/// the word is given by its step, the seed, and the largest number of elements. Lines are tubes if these are given.
fn derived<F: TurtleFrame>(
    system: &F::System,
    (steps, seed, max_elements): (u32, u64, u64),
    tube: Option<Tube>,
) -> Result<Levels<F>, CompileError> {
    let words = F::words(system);
    let mut strings = Strings::<F>::new(words, tube);
    let mut instances = Vec::new();
    let mut place = |placed: &Placed<F>| strings.place(placed, &mut instances);
    let polygons = match words.growing {
        Some(growing) if growing.steps == steps && steps > 0 => {
            let mut turtle = GrowingTurtle::<F>::new(system, growing.share);
            turtle.read(system, (steps, seed, max_elements), place)?;
            let Drawing {
                polygons, empty, ..
            } = turtle.after.drawing;
            (polygons, empty)
        }
        _ => {
            let mut turtle = Turtle::<F>::new(system);
            words.read(steps, seed, max_elements, |symbol, arguments| {
                turtle.read(symbol, arguments);
                turtle.drawing.elements.drain(..).for_each(|it| place(&it));
            })?;
            let Drawing {
                polygons, empty, ..
            } = turtle.drawing;
            (polygons, empty)
        }
    };
    for (position, instance) in (0..).zip(&mut instances) {
        instance.position = position;
        if !instance.frame.map().is_finite() {
            return Err(CompileError::TooFar);
        }
    }
    let base_elements = strings.base_elements(F::stamps(system), polygons);
    let outlines = F::outlines(&base_elements);
    let initiator = Chain::loose(instances);
    let mut bounds = Bounds::EMPTY;
    for instance in &initiator.instances {
        let base_element = strings.objects[instance.object].base_element;
        outlines[base_element].add_to(&mut bounds, &instance.frame, 0.0);
    }
    let mut graph = Graph {
        tints: words.has_colours(),
        draws: !words.is_deterministic(),
        affine: tube.is_some(),
        only: Some(steps),
        ..Graph::of(strings.objects, outlines, vec![initiator])
    };
    graph.find_widths();
    if !bounds.is_empty() {
        graph.middle = bounds.centre();
    }
    Ok((graph, base_elements))
}

impl Graph<Frame3> {
    /// Compiles an L-system in space for a number of steps: to objects by module and level, otherwise from the elements
    /// that the turtle draws of the derived word. Lines have no width. The graph of a system that stands for its limit set
    /// has that set, or the reason why there is none.
    ///
    /// # Errors
    ///
    /// As for [`Graph::of_derived_word`], if the system cannot be compiled in the first way.
    pub fn of_lsystem_in_space(
        system: &LSystemInSpace,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Self, CompileError> {
        let reason = match system.words.in_limit {
            true => match Self::limit_of_lsystem(system) {
                Ok(graph) => return Ok(graph),
                Err(reason) => Some(reason.into()),
            },
            false => None,
        };
        let (graph, _) = in_space(system, (steps, seed, max_elements), None)?;
        Ok(Self {
            no_limit: reason,
            ..graph
        })
    }

    /// Compiles an L-system in space as it is drawn after a number of steps: lines are tubes if the style asks for them,
    /// and there is an object for each surface. All instances are fixed.
    ///
    /// # Errors
    ///
    /// As for [`of_lsystem_in_space`](Self::of_lsystem_in_space).
    pub(crate) fn drawn_of_lsystem(
        system: &LSystemInSpace,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Self, CompileError> {
        let word = (steps, seed, max_elements);
        let (mut graph, bodies) = match in_space(system, word, system.tube())? {
            (graph, _) if !graph.is_plain() => derived(system, word, system.tube())?,
            compiled => compiled,
        };
        *graph.initiators_mut() = vec![graph.initiator(steps).clone()];
        for object in &mut graph.objects {
            // Only what is left in the last word is drawn.
            object.visible = object.is_kept() || object.is_unresolved();
            if object.is_unresolved() {
                object.replacement = Replacement::Kept;
            }
        }
        Ok(graph.with_surfaces(&bodies))
    }
}

fn in_space(
    system: &LSystemInSpace,
    word: (u32, u64, u64),
    tube: Option<Tube>,
) -> Result<Levels<Frame3>, CompileError> {
    if system.words.growing.is_some() {
        return derived(system, word, tube);
    }
    let effects = Effects::of_system(system, word.0);
    match effects.and_then(|effects| levels(effects, word.0, tube)) {
        Ok(compiled) => Ok(compiled),
        Err(NotCompiled) => {
            let derived = derived(system, word, tube);
            derived.map_err(|error| large(&system.words, word.0, error))
        }
    }
}

/// Returns the error of a word that is derived because no graph is compiled, with the size of the graph if that is the
/// reason.
fn large(words: &LSystem, steps: u32, error: CompileError) -> CompileError {
    match error {
        CompileError::Word(
            word @ (RewriteError::TooLong { .. } | RewriteError::TooMuchWork { .. }),
        ) => match work::excess(words, steps) {
            Some(work) => work::large(words, steps, work, word),
            None => CompileError::Word(word),
        },
        error => error,
    }
}

impl LSystem {
    /// Checks that the words of the system approach a limit set if they are drawn smaller from step to step, without
    /// widths and colours.
    ///
    /// # Errors
    ///
    /// The reason why they do not, or why that is not decided.
    pub fn check_growth(&self) -> Result<(), NoGrowth> {
        Limit::of(self, 0)?.graph().map(|_| ())
    }

    /// Returns why the system is not compiled for a number of steps: neither to a graph, unless it rewrites edges, nor from
    /// its word; `None` if that is not predicted.
    pub(crate) fn too_deep(&self, steps: u32, max_elements: u64) -> Option<CompileError> {
        let work = work::excess(self, steps)?;
        let word = self.unreadable(steps, max_elements)?;
        Some(work::large(self, steps, work, word))
    }

    /// Returns a number of steps, at most `steps`, for which a graph takes little work if there is one.
    pub(crate) fn soon_compiled(&self, steps: u32) -> u32 {
        work::soon(self, steps)
    }

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

impl LSystemInSpace {
    /// Checks that the words of the system approach a limit set, as [`LSystem::check_growth`] does.
    ///
    /// # Errors
    ///
    /// The reason why they do not, or why that is not decided.
    pub fn check_growth(&self) -> Result<(), NoGrowth> {
        Graph::limit_of_lsystem(self).map(drop)
    }
}

/// Failure: a system cannot be compiled, or only to a graph that is too large; it is derived as a string.
#[derive(Clone, Copy, Debug, PartialEq)]
struct NotCompiled;

/// Base element of an object.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Shape {
    Line,
    Stamp(usize),
    Tube(TubePart),
    Polygon(usize),
}

/// Creates objects of the elements that turtles draw: one for every base element, colour and width.
struct Strings<'s, F: TurtleFrame> {
    words: &'s LSystem,
    /// Whether symbols change colours.
    is_coloured: bool,
    tube: Option<Tube>,
    shapes: Vec<Shape>,
    objects: Vec<Object<F>>,
    numbers: BTreeMap<(Shape, Option<i64>, u64), usize>,
}

impl<'s, F: TurtleFrame> Strings<'s, F> {
    fn new(words: &'s LSystem, tube: Option<Tube>) -> Self {
        Self {
            words,
            is_coloured: words.has_colours(),
            tube,
            shapes: Vec::new(),
            objects: Vec::new(),
            numbers: BTreeMap::new(),
        }
    }

    /// Adds an element that a turtle drew as an instance that is kept; for a tube, one for each of its parts.
    fn place(&mut self, placed: &Placed<F>, instances: &mut Vec<Instance<F>>) {
        let shape = match (placed.of, self.tube) {
            (Drawn::Line(line), Some(tube)) => {
                for (part, stretch) in tube.parts(&line) {
                    let object = self.object(placed, Shape::Tube(part));
                    let frame = placed.frame.stretched(stretch);
                    instances.push(Instance::new(object, frame, 0));
                }
                return;
            }
            (Drawn::Line(_), None) => Shape::Line,
            (Drawn::Polygon(number), _) => Shape::Polygon(number),
            (Drawn::Stamp(number), _) => Shape::Stamp(number),
        };
        instances.push(Instance {
            joined: placed.joined,
            ..Instance::new(self.object(placed, shape), placed.frame, 0)
        });
    }

    fn object(&mut self, placed: &Placed<F>, shape: Shape) -> usize {
        let colour = self.is_coloured.then_some(placed.colour);
        let made = self.objects.len();
        // Tubes have their widths.
        let width = if self.tube.is_some() {
            1.0
        } else {
            placed.width
        };
        let number = *self
            .numbers
            .entry((shape, colour, width.to_bits()))
            .or_insert(made);
        if number == made {
            let palette = &self.words.metadata.style.palette;
            self.shapes.push(shape);
            self.objects.push(Object {
                paint: colour.map(|index| palette.entry(index)),
                thickness: Some(Thickness::Set(width)).filter(|_| width != 1.0),
                ..Object::kept(0)
            });
        }
        number
    }

    /// Returns the base elements, and refers the objects to them: the line, stamps, tubes and polygons.
    fn base_elements(
        &mut self,
        stamps: &[F::BaseElement],
        (polygons, empty): (Vec<F::BaseElement>, BTreeSet<usize>),
    ) -> Vec<F::BaseElement> {
        let mut all = vec![F::line()];
        all.extend_from_slice(stamps);
        let first_polygon = all.len();
        all.extend(polygons);
        let mut tubes = BTreeMap::new();
        for (object, shape) in self.objects.iter_mut().zip(&self.shapes) {
            object.visible &= !matches!(shape, Shape::Polygon(number) if empty.contains(number));
            object.base_element = match (*shape, self.tube) {
                (Shape::Stamp(number), _) => 1 + number,
                (Shape::Polygon(number), _) => first_polygon + number,
                (Shape::Tube(part), Some(tube)) => *tubes.entry(part).or_insert_with(|| {
                    all.push(F::tube_part(tube, part));
                    all.len() - 1
                }),
                (Shape::Line | Shape::Tube(_), _) => 0,
            };
        }
        all
    }
}

#[cfg(test)]
mod tests;
