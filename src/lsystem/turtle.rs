//! The turtle: interprets the modules of words as lines and polygons in the plane.

use std::collections::BTreeMap;

use crate::geometry::{DVec2, Direction, Frame2};
use crate::rule::{BaseElement, Piece};

use super::word::number;
use super::{Action, Compass, LSystem, Word};

/// An element that the turtle draws: a line or a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Frame of the element. A line runs from (0, 0) to (1, 0) in it; a polygon's coordinates are those of a
    /// turtle that starts at (0, 0), heading right, where the polygon was opened.
    pub frame: Frame2,
    /// Whether the element starts at the end of the preceding one, in the same width and colour.
    pub joined: bool,
    /// Index of the symbol that drew the element; of a polygon, the one that closed it.
    pub symbol: usize,
    /// Width, as a multiple of the turtle's initial width.
    pub width: f64,
    /// Colour index.
    pub colour: i64,
    /// Index of the outline in [`Drawing::polygons`], if the element is a polygon.
    pub polygon: Option<usize>,
}

/// All elements that a turtle draws.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// The elements, in drawing order.
    pub elements: Vec<Placed>,
    /// Distinct outlines of polygons.
    pub polygons: Vec<BaseElement>,
}

/// State of the turtle, which brackets save and restore.
#[derive(Clone, Copy, Debug)]
struct TurtleState {
    place: DVec2,
    heading: u64,
    /// Second heading.
    other: u64,
    mirrored: bool,
    /// Length of a step.
    step: f64,
    width: f64,
    colour: i64,
}

impl TurtleState {
    fn direction(&self) -> Direction {
        if self.mirrored {
            Direction::YReflected
        } else {
            Direction::Normal
        }
    }
}

/// A polygon that has not been closed.
struct OpenPolygon {
    state: TurtleState,
    vertices: Vec<DVec2>,
    /// The number of saved states at its start.
    depth: usize,
    /// The least number of saved states since.
    min_depth: usize,
}

/// An interpreter that reads modules one by one and draws.
pub(crate) struct Turtle<'s> {
    system: &'s LSystem,
    compass: Compass,
    state: TurtleState,
    saved: Vec<TurtleState>,
    open: Vec<OpenPolygon>,
    /// Modules since the outermost polygon was opened: symbols, and the bits of arguments.
    inside: (Vec<u32>, Vec<u64>),
    /// Elements drawn and not yet taken, and the outlines of all polygons.
    pub(crate) drawing: Drawing,
    /// Width and colour of the preceding element.
    last: Option<(f64, i64)>,
    /// Whether the turtle stands at the end of the preceding line.
    is_down: bool,
    /// Indices of outlines by the modules that draw them.
    known: BTreeMap<(Vec<u32>, Vec<u64>), usize>,
}

impl LSystem {
    /// Returns the turtle's drawing of a word. A line of length 0 is not an element, nor is a polygon with
    /// fewer than three vertices or with steps of length 0.
    #[must_use]
    pub fn draw(&self, word: &Word) -> Drawing {
        let mut turtle = Turtle::new(self);
        for (symbol, arguments) in word.modules(self) {
            turtle.read(symbol, arguments);
        }
        turtle.drawing
    }
}

impl LSystem {
    /// Returns the colour index nearest to a value, saturating.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "casts from floats saturate"
    )]
    pub(crate) fn colour(value: f64) -> i64 {
        value.round() as i64
    }
}

impl<'s> Turtle<'s> {
    pub(crate) fn new(system: &'s LSystem) -> Self {
        let compass = Compass::of(system);
        let heading = compass.of_degrees(system.start);
        Self {
            system,
            compass,
            state: TurtleState {
                place: DVec2::ZERO,
                heading,
                other: heading,
                mirrored: false,
                step: system.length,
                width: 1.0,
                colour: 0,
            },
            saved: Vec::new(),
            open: Vec::new(),
            inside: (Vec::new(), Vec::new()),
            drawing: Drawing::default(),
            last: None,
            is_down: false,
            known: BTreeMap::new(),
        }
    }

    /// Performs the actions of the next module of a word.
    pub(crate) fn read(&mut self, symbol: usize, arguments: &[f64]) {
        for action in &self.system.symbols[symbol].meaning {
            self.act(action, symbol, arguments);
        }
        if !self.open.is_empty() {
            self.remember(symbol, arguments);
        }
    }

    fn remember(&mut self, symbol: usize, arguments: &[f64]) {
        self.inside.0.push(number(symbol));
        let bits = arguments.iter().map(|value| value.to_bits());
        self.inside.1.extend(bits);
    }

    fn act(&mut self, action: &Action, symbol: usize, arguments: &[f64]) {
        let state = &mut self.state;
        match action {
            Action::Draw(steps) => self.draw(steps.eval(arguments), symbol),
            Action::Move(steps) => {
                self.go(steps.eval(arguments));
                self.vertex();
                self.is_down = false;
            }
            Action::Glide(steps) => {
                self.go(steps.eval(arguments));
                self.is_down = false;
            }
            Action::Turn(angle) => {
                let turn = self.compass.of_degrees(angle.eval(arguments));
                let turn = if state.mirrored {
                    self.compass.back(turn)
                } else {
                    turn
                };
                state.heading = self.compass.sum(state.heading, turn);
            }
            Action::Rotate(angle) => {
                let turn = self.compass.of_degrees(angle.eval(arguments));
                state.heading = self.compass.sum(state.heading, turn);
            }
            Action::Swap => std::mem::swap(&mut state.heading, &mut state.other),
            Action::Push => self.saved.push(*state),
            Action::Pop => {
                // Words are balanced.
                if let Some(saved) = self.saved.pop() {
                    self.state = saved;
                }
                if let Some(open) = self.open.last_mut() {
                    open.min_depth = open.min_depth.min(self.saved.len());
                }
                self.is_down = false;
            }
            Action::Reflect => state.mirrored = !state.mirrored,
            Action::Scale(factor) => state.step *= factor.eval(arguments),
            Action::Width(factor) => state.width *= factor.eval(arguments).max(0.0),
            Action::SetWidth(width) => state.width = width.eval(arguments).max(0.0),
            Action::SetColour(colour) => state.colour = LSystem::colour(colour.eval(arguments)),
            Action::ShiftColour(by) => {
                state.colour = state
                    .colour
                    .saturating_add(LSystem::colour(by.eval(arguments)));
            }
            Action::Open => {
                if self.open.is_empty() {
                    self.inside.0.clear();
                    self.inside.1.clear();
                }
                self.open.push(OpenPolygon {
                    state: *state,
                    vertices: Vec::new(),
                    depth: self.saved.len(),
                    min_depth: self.saved.len(),
                });
            }
            Action::Close => self.close(symbol, arguments),
            Action::Vertex => self.vertex(),
        }
    }

    /// Moves forward by a number of steps.
    fn go(&mut self, steps: f64) {
        let along = self.compass.direction(self.state.heading);
        self.state.place += along * (steps * self.state.step);
    }

    fn vertex(&mut self) {
        if let Some(open) = self.open.last_mut() {
            open.vertices.push(self.state.place);
        }
    }

    fn draw(&mut self, steps: f64, symbol: usize) {
        let from = self.state.place;
        self.go(steps);
        if !self.open.is_empty() {
            return self.vertex();
        }
        if steps * self.state.step == 0.0 {
            return;
        }
        let TurtleState { width, colour, .. } = self.state;
        let alike = self.last == Some((width, colour));
        self.last = Some((width, colour));
        let direction = self.state.direction();
        self.drawing.elements.push(Placed {
            frame: Frame2::between(from, self.state.place, direction),
            joined: self.is_down && alike,
            symbol,
            width,
            colour,
            polygon: None,
        });
        self.is_down = true;
    }

    /// Ends the polygon that was begun last.
    fn close(&mut self, symbol: usize, arguments: &[f64]) {
        let Some(open) = self.open.pop() else {
            return;
        };
        if let Some(outer) = self.open.last_mut() {
            outer.min_depth = outer.min_depth.min(open.min_depth);
        }
        let TurtleState { place, step, .. } = open.state;
        let along = self.compass.direction(open.state.heading) * step;
        let direction = open.state.direction();
        let frame = Frame2::between(place, place + along, direction);
        if open.vertices.len() < 3 || step == 0.0 {
            return;
        }
        let number = self.drawing.polygons.len();
        let mut made = number;
        // A polygon across the end of an outer bracket depends on more than the modules inside it.
        let is_local = open.min_depth == open.depth && !self.system.depends_on_the_way();
        if self.open.is_empty() && is_local {
            self.remember(symbol, arguments);
            made = *self.known.entry(self.inside.clone()).or_insert(number);
        }
        if made == number {
            let inverse = frame.map().inverse();
            let mut vertices = open.vertices.iter().map(|v| inverse.transform_point2(*v));
            let start = vertices.next().unwrap_or(DVec2::ZERO);
            let pieces = vertices.map(Piece::Line).collect();
            let outline = BaseElement::new(start, pieces, true);
            // A polygon of no extent keeps its index and is drawn as a line.
            let outline = outline.unwrap_or_else(BaseElement::line);
            self.drawing.polygons.push(outline);
        }
        let TurtleState { width, colour, .. } = open.state;
        self.last = Some((width, colour));
        self.drawing.elements.push(Placed {
            frame,
            joined: false,
            symbol,
            width,
            colour,
            polygon: Some(made),
        });
        self.is_down = false;
    }
}
