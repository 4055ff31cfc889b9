//! The turtle: interprets the modules of words as lines, polygons and stamps in the plane or in space.

use std::collections::{BTreeMap, BTreeSet};

use crate::geometry::{Affine as _, Frame2, Point as _};

use super::word::number;
use super::{Action, Axis, Compass, LSystem, TubeLine, TurtleFrame, Word};

/// An element that the turtle draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed<F: TurtleFrame = Frame2> {
    /// Frame of the element. A line runs from the origin to the unit point of the x axis in it; the coordinates of a
    /// polygon are those of a turtle that starts at the origin, heading along the x axis, where the polygon was opened.
    pub frame: F,
    /// Whether the element starts at the end of the preceding one, in the same width and colour.
    pub joined: bool,
    /// Index of the symbol that drew the element; of a polygon, the one that closed it.
    pub symbol: usize,
    /// Width, as a multiple of the turtle's initial width.
    pub width: f64,
    /// Colour index.
    pub colour: i64,
    /// Content of the element.
    pub of: Drawn,
}

impl<F: TurtleFrame> Placed<F> {
    /// Returns the index of the outline in [`Drawing::polygons`], if the element is a polygon.
    #[must_use]
    pub fn polygon(&self) -> Option<usize> {
        match self.of {
            Drawn::Polygon(number) => Some(number),
            Drawn::Line(_) | Drawn::Stamp(_) => None,
        }
    }
}

/// Content of an element that the turtle draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drawn {
    /// A line, with what a tube along it needs.
    Line(TubeLine),
    /// A polygon, by index in [`Drawing::polygons`].
    Polygon(usize),
    /// A stamp of the system, by index.
    Stamp(usize),
}

/// All elements that a turtle draws.
#[derive(Clone, Debug)]
pub struct Drawing<F: TurtleFrame = Frame2> {
    /// The elements, in drawing order.
    pub elements: Vec<Placed<F>>,
    /// Distinct outlines of polygons.
    pub polygons: Vec<F::BaseElement>,
    /// Indices of the polygons without extent, which are not visible: all vertices lie in one place or, in space, on one
    /// line.
    pub empty: BTreeSet<usize>,
}

impl<F: TurtleFrame> Default for Drawing<F> {
    fn default() -> Self {
        Self {
            elements: Vec::new(),
            polygons: Vec::new(),
            empty: BTreeSet::new(),
        }
    }
}

/// TurtleState of the turtle, which brackets save and restore.
#[derive(Clone, Copy, Debug)]
struct TurtleState<F: TurtleFrame> {
    place: F::Point,
    heading: F::Heading,
    /// Second heading.
    other: F::Heading,
    mirrored: bool,
    /// Length of a step.
    step: f64,
    width: f64,
    colour: i64,
    /// Width at the end of the line that ends here, if there is one in this branch.
    tip: Option<f64>,
    /// Whether the turtle has turned since the last line.
    is_bent: bool,
}

/// A polygon that has not been closed.
struct OpenPolygon<F: TurtleFrame> {
    state: TurtleState<F>,
    vertices: Vec<F::Point>,
    /// The number of saved states at its start.
    depth: usize,
    /// The least number of saved states since.
    min_depth: usize,
}

/// An interpreter that reads modules one by one and draws.
pub(crate) struct Turtle<'s, F: TurtleFrame = Frame2> {
    system: &'s F::System,
    words: &'s LSystem,
    compass: Compass,
    state: TurtleState<F>,
    saved: Vec<TurtleState<F>>,
    open: Vec<OpenPolygon<F>>,
    /// The number of states that were saved where the branch was cut off, if it was.
    cut: Option<usize>,
    /// Modules since the outermost polygon was opened: symbols, and the bits of arguments.
    inside: (Vec<u32>, Vec<u64>),
    /// Elements drawn and not yet taken, and the outlines of all polygons.
    pub(crate) drawing: Drawing<F>,
    /// Width and colour of the preceding element.
    last: Option<(f64, i64)>,
    /// Whether the turtle stands at the end of the preceding line.
    is_down: bool,
    /// Number of polygons that the present module has closed.
    closed: u32,
    /// Indices of outlines by the modules that draw them, and the number of polygons that the last of these closed before.
    known: BTreeMap<(Vec<u32>, Vec<u64>, u32), usize>,
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

impl<'s, F: TurtleFrame> Turtle<'s, F> {
    pub(crate) fn new(system: &'s F::System) -> Self {
        let words = F::words(system);
        let compass = Compass::of(words);
        let heading = F::start(system, compass);
        Self {
            system,
            words,
            compass,
            state: TurtleState {
                place: F::Point::ZERO,
                heading,
                other: heading,
                mirrored: false,
                step: words.length,
                width: 1.0,
                colour: 0,
                tip: None,
                is_bent: false,
            },
            saved: Vec::new(),
            open: Vec::new(),
            cut: None,
            inside: (Vec::new(), Vec::new()),
            drawing: Drawing::default(),
            last: None,
            is_down: false,
            closed: 0,
            known: BTreeMap::new(),
        }
    }

    /// Returns the place of the turtle.
    pub(super) fn place(&self) -> F::Point {
        self.state.place
    }

    /// Returns the place of the turtle, and that after a step ahead.
    pub(crate) fn pose(&self) -> [F::Point; 2] {
        let TurtleState {
            place,
            heading,
            mirrored,
            step,
            ..
        } = self.state;
        let ahead = F::outward(self.compass, heading, mirrored, F::Point::AXES[0]);
        [place, place + ahead * step]
    }

    /// Performs the actions of the next module of a word.
    pub(crate) fn read(&mut self, symbol: usize, arguments: &[f64]) {
        self.closed = 0;
        for action in &self.words.symbols[symbol].meaning {
            if self.stays(action) {
                self.act(action, symbol, arguments);
            }
        }
        if !self.open.is_empty() {
            self.remember(symbol, arguments);
        }
    }

    /// Returns whether an action belongs to no branch that is cut off. The closing bracket of such a branch ends it.
    fn stays(&mut self, action: &Action) -> bool {
        let Some(depth) = self.cut else {
            return true;
        };
        match action {
            Action::Push => self.saved.push(self.state),
            Action::Pop if self.saved.len() == depth => {
                self.cut = None;
                return true;
            }
            Action::Pop => {
                self.saved.pop();
            }
            _ => {}
        }
        false
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
            Action::Turn(angle) => self.turn(Axis::Up, angle.eval(arguments)),
            Action::Pitch(angle) => self.turn(Axis::Left, angle.eval(arguments)),
            Action::Roll(angle) => self.turn(Axis::Heading, angle.eval(arguments)),
            Action::Rotate(angle) => {
                let turn = F::turn(self.compass, Axis::Up, angle.eval(arguments));
                state.heading = F::after_turn(self.compass, state.heading, turn, false);
                state.is_bent = true;
            }
            Action::Level => state.heading = F::levelled(self.compass, state.heading),
            Action::Swap => {
                std::mem::swap(&mut state.heading, &mut state.other);
                state.is_bent = true;
            }
            Action::Push => {
                self.saved.push(*state);
                // A branch begins with a width of its own.
                state.tip = None;
            }
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
            Action::Cut => self.cut = Some(self.saved.len()),
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
            Action::Stamp(number, size) => {
                let size = size.eval(arguments) * self.state.step;
                if size != 0.0 {
                    let state = self.state;
                    let frame = self.frame(&state, self.ahead(&state, size));
                    self.put(frame, Drawn::Stamp(*number), symbol, &state);
                }
            }
        }
    }

    /// Turns about an axis by an angle in degrees.
    fn turn(&mut self, axis: Axis, angle: f64) {
        let turn = F::turn(self.compass, axis, angle);
        let TurtleState {
            heading, mirrored, ..
        } = self.state;
        self.state.heading = F::after_turn(self.compass, heading, turn, mirrored);
        // A roll leaves a line straight.
        self.state.is_bent |= axis != Axis::Heading && angle != 0.0;
    }

    /// Returns the vector of a length along the heading of a state.
    fn ahead(&self, state: &TurtleState<F>, length: f64) -> F::Point {
        let ahead = F::Point::AXES[0];
        F::outward(self.compass, state.heading, state.mirrored, ahead) * length
    }

    /// Returns the frame of an element that runs along a vector from the place of a state.
    fn frame(&self, state: &TurtleState<F>, along: F::Point) -> F {
        F::along(
            self.compass,
            state.heading,
            state.mirrored,
            state.place,
            along,
        )
    }

    /// Moves forward by a number of steps.
    fn go(&mut self, steps: f64) {
        let way = self.ahead(&self.state, steps * self.state.step);
        self.state.place = self.state.place + way;
        self.state.tip = None;
    }

    fn vertex(&mut self) {
        if let Some(open) = self.open.last_mut() {
            open.vertices.push(self.state.place);
        }
    }

    fn draw(&mut self, steps: f64, symbol: usize) {
        let start = self.state;
        self.go(steps);
        let bent = F::bent(self.system, self.compass, start.heading);
        let is_bent = bent != start.heading;
        self.state.heading = bent;
        if !self.open.is_empty() {
            self.is_down = false;
            return self.vertex();
        }
        let length = (steps * start.step).abs();
        if length == 0.0 {
            self.state.tip = start.tip;
            return;
        }
        let TurtleState { width, colour, .. } = start;
        let alike = self.last == Some((width, colour));
        self.last = Some((width, colour));
        let along = self.state.place - start.place;
        let line = TubeLine {
            length,
            widths: [start.tip.unwrap_or(width), width],
            is_bent: start.is_bent,
        };
        self.drawing.elements.push(Placed {
            frame: self.frame(&start, along),
            joined: self.is_down && alike,
            symbol,
            width,
            colour,
            of: Drawn::Line(line),
        });
        self.state.tip = Some(width);
        self.state.is_bent = is_bent;
        self.is_down = true;
    }

    /// Draws an element that no line joins.
    fn put(&mut self, frame: F, of: Drawn, symbol: usize, state: &TurtleState<F>) {
        let TurtleState { width, colour, .. } = *state;
        self.last = Some((width, colour));
        self.drawing.elements.push(Placed {
            frame,
            joined: false,
            symbol,
            width,
            colour,
            of,
        });
        self.is_down = false;
    }

    /// Ends the polygon that was begun last.
    fn close(&mut self, symbol: usize, arguments: &[f64]) {
        let Some(open) = self.open.pop() else {
            return;
        };
        if let Some(outer) = self.open.last_mut() {
            outer.min_depth = outer.min_depth.min(open.min_depth);
        }
        let step = open.state.step;
        if open.vertices.len() < 3 || step == 0.0 {
            return;
        }
        let frame = self.frame(&open.state, self.ahead(&open.state, step));
        let number = self.drawing.polygons.len();
        let mut made = number;
        // A polygon across the end of an outer bracket depends on more than the modules inside it.
        let is_local = open.min_depth == open.depth && !F::depends_on_the_way(self.system);
        if self.open.is_empty() && is_local {
            self.remember(symbol, arguments);
            let (symbols, arguments) = self.inside.clone();
            let key = (symbols, arguments, self.closed);
            made = *self.known.entry(key).or_insert(number);
        }
        if made == number {
            let inverse = frame.map().inverse();
            let vertices = open.vertices.iter().map(|v| inverse.apply(*v));
            let outline = F::polygon(&vertices.collect::<Vec<_>>());
            if outline.is_none() {
                self.drawing.empty.insert(number);
            }
            // A polygon without extent keeps its index.
            self.drawing.polygons.push(outline.unwrap_or_else(F::line));
        }
        self.closed += 1;
        self.put(frame, Drawn::Polygon(made), symbol, &open.state);
    }
}
