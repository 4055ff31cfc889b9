//! Estimates the size of an SVG or a PNG, and the time that drawing it takes, before anything is grown.
//!
//! Path data are whole hundredths of a pixel, written as differences. A side of ℓ hundredths that runs in any
//! direction has
//!
//! - 1 + Σ (2/π) arccos(10^k / ℓ) digits a coordinate, over the k ≥ 1 with 10^k < ℓ, and a sign or a space
//!   before each;
//! - the probability (4ℓ − ℓ²)/π, for ℓ below 1, to end in another hundredth than it starts (Buffon's needle
//!   on a square grid); sides that do not are not written at all.
//!
//! The lengths of an object's elements are taken to be distributed log-normally, with their true mean and
//! mean square. From 1,000 elements on, the estimate of an SVG's size is within a factor of 1.5 for the rules
//! of the library.
//!
//! A PNG takes a byte for about every thousand pixels of one colour, the maximum that its compression makes
//! of runs, and about three bytes for every pixel of an edge between two colours.

use std::cell::{Cell, OnceCell};
use std::f64::consts::{FRAC_2_PI, PI};

use crate::geometry::{Bounds, DVec2};
use crate::graph::{Forecast, Graph, Population};
use crate::render::{self, Canvas, Options};
use crate::rule::{BaseElement, Piece};
use crate::style::{ColorBy, ColorProperty, Width};

/// Cost of drawing an approximant: sizes of the files and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeEstimate {
    /// Size of the SVG in bytes.
    pub svg_bytes: f64,
    /// Size of a PNG in bytes, within a factor of about 3. Much less is needed where lines lie over each
    /// other, shapes lie side by side, or edges run along rows and columns.
    pub png_bytes: f64,
    /// Time to make the SVG, in seconds: a guess within a factor of about 3, for one processor of 2026.
    pub seconds: f64,
}

/// Units of path data per pixel.
const FINE: f64 = 100.0;

/// Elements per second that one processor of 2026 walks over singly (`WALK`) and by blocks (`BLOCKS`), and
/// bytes per second that it writes (`TEXT`).
const WALK: f64 = 1.5e7;
const BLOCKS: f64 = 1e8;
const TEXT: f64 = 2.5e8;

/// Cost of passing over a block without elements of the class that is being drawn, relative to walking over
/// it.
const PASSED: f64 = 0.02;

/// Pixels of one colour per byte of a PNG, and bytes per pixel of an edge.
const RUN: f64 = 1_000.0;
const EDGE: f64 = 2.8;
/// Widest stroke, in pixels, that counts as one edge; wider ones have two.
const THIN: f64 = 3.0;

/// Bytes of an SVG document without paths: its tags, its labels and the attributes of its groups.
const DOCUMENT: f64 = 1_000.0;
/// Bytes of the tag of a path, and of one with a width of its own.
const PATH: f64 = 14.0;
const WIDE_PATH: f64 = 34.0;

/// Estimates the bytes of an SVG of nested instances by writing one of at most 32 steps to a counter. Returns
/// `None` where the file cannot be made, or not with little work: if symbols instance more than 2²⁰ elements and symbols, or
/// if more than 20,000 elements would have to be grown. `bounds` returns the box of an approximant without strokes, about, by
/// its step.
#[must_use]
pub fn instanced_bytes(
    graph: &Graph,
    options: &Options,
    steps: u32,
    bounds: &dyn Fn(u32) -> Option<Bounds>,
) -> Option<f64> {
    /// Beyond twice this number of steps, the size is extrapolated linearly from the last `SPAN` steps.
    const SPAN: u32 = 16;
    let [before, known] = [steps.min(SPAN), steps.min(2 * SPAN)];
    let written = |steps| instanced_bytes_written(graph, options, steps, bounds);
    let bytes = written(known)?;
    if known == steps {
        return Some(bytes);
    }
    let a_step = (bytes - written(before)?) / f64::from(SPAN);
    Some(bytes + a_step * f64::from(steps - known))
}

fn instanced_bytes_written(
    graph: &Graph,
    options: &Options,
    steps: u32,
    bounds: &dyn Fn(u32) -> Option<Bounds>,
) -> Option<f64> {
    let length = render::instanced_length(graph, options, steps, bounds)?;
    #[expect(clippy::cast_precision_loss, reason = "an estimate")]
    Some(DOCUMENT + length as f64)
}

/// Maximum number of sides of a base element of which estimates are made, each of which stands for as many others.
const SIDES: usize = 256;

/// Maximum number of sides for which the estimates of one estimator are made: those of the base elements of all populations.
const MAX_WORK: usize = 1 << 20;

/// Estimates the cost of pictures of a graph.
///
/// The work of all estimates together is bounded: beyond, none is made.
pub struct Estimator<'a> {
    graph: &'a Graph,
    options: &'a Options,
    /// Sides of the base elements, by number, as far as they were asked for.
    outlines: Vec<OnceCell<Sides>>,
    /// Number of sides for which estimates have been made.
    work: Cell<usize>,
}

/// Sides of a base element, or a sample of them.
struct Sides {
    /// Lengths of the lines, and of the three sides of the control polygons of curves, as multiples of the element's length.
    all: Vec<Side>,
    /// Number of sides for which each stands.
    weight: f64,
    /// Length of the outline; curves count as their chords.
    around: f64,
    /// Number of sides, those of control polygons included, and 1 for the element.
    work: usize,
}

/// Lengths of the sides of a piece.
#[derive(Clone, Copy)]
enum Side {
    Line(f64),
    Cubic([f64; 3]),
}

impl Side {
    fn longest(self) -> f64 {
        match self {
            Self::Line(length) => length,
            Self::Cubic(sides) => sides.into_iter().fold(0.0, f64::max),
        }
    }
}

impl Sides {
    /// Measures the sides of a base element. Of many sides in the order of their lengths, some at equal distances are kept.
    fn of(base_element: &BaseElement) -> Self {
        let mut pen = base_element.start();
        let mut around = 0.0;
        let mut all = Vec::with_capacity(base_element.pieces().len());
        for piece in base_element.pieces() {
            let side = |point: DVec2| (point - pen).length();
            around += side(piece.end());
            all.push(match *piece {
                Piece::Line(end) => Side::Line(side(end)),
                Piece::Cubic(a, b, end) => Side::Cubic([a, b, end].map(side)),
            });
            pen = piece.end();
        }
        // The letter that closes a path draws its last line.
        if base_element.is_closed() && matches!(all.last(), Some(Side::Line(_))) {
            all.pop();
        }
        let mut weight = 1.0;
        if all.len() > SIDES {
            all.sort_by(|a, b| a.longest().total_cmp(&b.longest()));
            #[expect(clippy::cast_precision_loss, reason = "an estimate")]
            {
                weight = all.len() as f64 / SIDES as f64;
            }
            let middle = |place: usize| all[(2 * place + 1) * all.len() / (2 * SIDES)];
            all = (0..SIDES).map(middle).collect();
        }
        let sides = all.iter().map(|side| match side {
            Side::Line(_) => 1,
            Side::Cubic(_) => 3,
        });
        Self {
            work: 1 + sides.sum::<usize>(),
            all,
            weight,
            around,
        }
    }
}

impl<'a> Estimator<'a> {
    /// Creates an estimator of pictures that are made with these options.
    #[must_use]
    pub fn new(graph: &'a Graph, options: &'a Options) -> Self {
        Self {
            graph,
            options,
            outlines: graph
                .base_elements()
                .iter()
                .map(|_| OnceCell::new())
                .collect(),
            work: Cell::new(0),
        }
    }

    /// Returns the sides of an object's base element; `None` if it is not drawn.
    fn sides(&self, object: usize) -> Option<&Sides> {
        let base_element = self.graph.drawn(object)?;
        let number = self.graph.objects()[object].base_element;
        Some(self.outlines[number].get_or_init(|| Sides::of(base_element)))
    }

    /// Estimates the cost of an approximant whose box, without strokes, is known approximately.
    ///
    /// Returns `None` where lengths depend on draws, where the canvas has no room for a picture, where numbers exceed the
    /// range of a double, or where this and the estimates before take much work: more than 2²⁰ sides of the base elements of
    /// all objects, of which at most 256 count for each.
    #[must_use]
    pub fn at(&self, forecast: &Forecast<'_>, bounds: &Bounds) -> Option<SizeEstimate> {
        let view = &self.options.view;
        let shown = view.window.map_or(*bounds, |[x, y, width, height]| {
            let corner = DVec2::new(x, y);
            Bounds::new(corner, corner + DVec2::new(width, height))
        });
        let canvas = Canvas::fit(&shown, self.options.size, view.pad()).ok()?;
        let work = forecast.populations()?.map(|population| {
            let sides = self.sides(population.object);
            sides.map_or(1, |sides| sides.work)
        });
        let work = self.work.get() + work.sum::<usize>();
        if work > MAX_WORK {
            return None;
        }
        self.work.set(work);
        let populations = forecast.populations()?;
        let fractals = forecast.fractals().to_f64();
        let mut bytes = DOCUMENT + PATH * fractals;
        if let Width::Relative(width) = self.options.style.width {
            let [count, length] = forecast.new_lengths();
            // All widths below a hundredth of a pixel are written alike.
            if width * length * canvas.scale() * FINE > count {
                bytes += WIDE_PATH * count;
            }
        }
        let (mut elements, mut outlines) = (0.0, 0.0);
        for population in populations {
            if !population.count.is_finite() {
                return None;
            }
            elements += population.count;
            if let Some(sides) = self.sides(population.object) {
                bytes += self.population(&population, sides, &canvas);
                outlines += population.length * canvas.scale() * sides.around;
            }
        }
        let classes = self.classes(forecast.step(), fractals);
        let walk = if !self.graph.counts_index() {
            (1.0 + PASSED * classes) / BLOCKS
        } else {
            // The prepass is a walk as well.
            (1.0 + classes) / WALK
        };
        let seconds = elements * walk + bytes / TEXT;
        let known = bytes.is_finite() && seconds.is_finite();
        known.then_some(SizeEstimate {
            svg_bytes: bytes,
            png_bytes: self.png(&canvas, outlines),
            seconds,
        })
    }

    /// Estimates the bytes of a PNG with outlines of a total length in pixels.
    fn png(&self, canvas: &Canvas, outlines: f64) -> f64 {
        let [width, height] = canvas.size().map(f64::from);
        let edges = match self.options.style.width {
            Width::Pixels(width) if width > THIN => 2.0,
            _ => 1.0,
        };
        // A pixel takes three bytes where there are many colours, else one; where edges run along rows and
        // columns, three compress as well as one.
        let [bytes, edges] = match self.options.style.color_by {
            ColorBy::None => [1.0, EDGE * edges],
            _ => [3.0, 2.0 * EDGE * edges],
        };
        let pixels = width * height;
        bytes * pixels / RUN + (edges * outlines).min(bytes * pixels)
    }

    /// Returns the number of classes of colour, each of which takes a walk; at most 64.
    fn classes(&self, step: u32, fractals: f64) -> f64 {
        let classes = match self.options.style.color_by.property() {
            ColorProperty::Uniform | ColorProperty::Tint | ColorProperty::Frame => 1.0,
            ColorProperty::Fractal => fractals,
            ColorProperty::Index => 64.0,
            ColorProperty::Step | ColorProperty::Age => f64::from(step) + 1.0,
            ColorProperty::Object => 1.0 + self.graph.origins() as f64,
            ColorProperty::Direction => 4.0,
        };
        classes.min(64.0)
    }

    /// Estimates the bytes that the elements of one object take.
    fn population(&self, population: &Population, sides: &Sides, canvas: &Canvas) -> f64 {
        if population.count == 0.0 {
            return 0.0;
        }
        let number = self.graph.objects()[population.object].base_element;
        let is_closed = self.graph.base_elements()[number].is_closed();
        // Elements of different colours are drawn in different walks.
        let parted = match self.options.style.color_by {
            ColorBy::Step => population.parted,
            _ => 0.0,
        };
        let apart = ((population.apart + parted) / population.count).min(1.0);
        let mean = population.length / population.count;
        let variance = libm::log(population.square / population.count / (mean * mean)).max(0.0);
        // Gauss–Hermite quadrature with three nodes.
        let deviations = [(-3.0f64.sqrt(), 1.0), (0.0, 4.0), (3.0f64.sqrt(), 1.0)];
        let sum = deviations.iter().map(|(deviation, weight)| {
            let length = mean * libm::exp(deviation * variance.sqrt() - variance / 2.0);
            let length = length * canvas.scale() * FINE;
            weight * element(sides, is_closed, length, apart, canvas)
        });
        population.count * sum.sum::<f64>() / 6.0
    }
}

/// Estimates the bytes of an element of a length in hundredths of a pixel; `apart` is the probability that a
/// new line begins with it.
fn element(sides: &Sides, is_closed: bool, length: f64, apart: f64, canvas: &Canvas) -> f64 {
    let [width, height] = canvas.size().map(f64::from);
    // M, two numbers, a space, and the letter of the next command.
    let start = 3.5 + digits_below(width * FINE) + digits_below(height * FINE);
    let own = if is_closed {
        start + 1.0
    } else {
        apart * start
    };
    let bytes = |side: &Side| match *side {
        Side::Line(side) => moves(side * length) * pair(side * length),
        Side::Cubic(sides) => {
            let sides = sides.map(|side| side * length);
            let longest = sides.into_iter().fold(0.0, f64::max);
            moves(longest) * sides.map(pair).iter().sum::<f64>()
        }
    };
    let drawn = sides.all.iter().map(bytes).sum::<f64>();
    own + sides.weight * drawn
}

/// Returns the probability that a side of a length ends in another hundredth of a pixel than it starts.
fn moves(length: f64) -> f64 {
    if length < 1.0 {
        length * (4.0 - length) / PI
    } else {
        1.0
    }
}

/// Returns the expected bytes of the two differences along a side.
fn pair(length: f64) -> f64 {
    let mut digits = 1.0;
    let mut power = 10.0;
    while power < length {
        digits += FRAC_2_PI * libm::acos(power / length);
        power *= 10.0;
    }
    2.0 * (digits + 1.0)
}

/// Returns the mean number of digits of the numbers from 0 to `largest`.
fn digits_below(largest: f64) -> f64 {
    let mut digits = 1.0;
    let mut power = 10.0;
    while power < largest {
        digits += 1.0 - power / largest;
        power *= 10.0;
    }
    digits
}
