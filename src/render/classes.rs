use std::convert::Infallible;

use crate::geometry::Bounds;
use crate::graph::Graph;
use crate::grow::{Element, Fractal, Visitor};
use crate::style::{Cap, ColorBy, Colour, Join, Style, Width};

/// Colours that vary continuously are quantised to this many classes at most.
const MOST_CLASSES: u64 = 64;

/// The classes of colour of an approximant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Classes {
    by: ColorBy,
    /// The largest value that is told apart; values start at 0.
    largest: u64,
}

impl Classes {
    /// The classes of approximant `steps` of a graph, as far as they are known without a survey.
    fn before_survey(by: ColorBy, graph: &Graph, steps: u32) -> Self {
        let largest = match by {
            ColorBy::None | ColorBy::Fractal | ColorBy::Index => 0,
            ColorBy::Step | ColorBy::Age => u64::from(steps),
            ColorBy::Generator => graph.rule().generators().len() as u64,
            ColorBy::Direction => 3,
        };
        Self { by, largest }
    }

    /// The number of classes, 64 at most.
    #[must_use]
    pub fn count(&self) -> u64 {
        (self.largest + 1).min(MOST_CLASSES)
    }

    fn all(&self) -> std::ops::Range<u64> {
        0..self.count()
    }

    /// The class of an element, from 0.
    #[inline]
    #[must_use]
    pub fn of(&self, element: &Element, fractal: &Fractal, graph: &Graph) -> u64 {
        let value = match self.by {
            ColorBy::None => return 0,
            ColorBy::Step => u64::from(element.born),
            ColorBy::Age => u64::from(fractal.age),
            ColorBy::Fractal => fractal.number,
            ColorBy::Index => element.index - 1,
            ColorBy::Generator => graph.objects()[element.object]
                .origin
                .map_or(0, |generator| generator as u64 + 1),
            ColorBy::Direction => u64::from(element.frame.direction.number()) - 1,
        };
        if self.largest < MOST_CLASSES {
            value
        } else {
            let wide =
                u128::from(value) * u128::from(MOST_CLASSES) / (u128::from(self.largest) + 1);
            u64::try_from(wide).unwrap_or(MOST_CLASSES - 1)
        }
    }

    /// The colour of a class.
    #[must_use]
    pub fn colour(&self, class: u64, style: &Style) -> Option<Colour> {
        if self.by == ColorBy::None {
            return None;
        }
        let last = self.count().saturating_sub(1).max(1);
        #[expect(clippy::cast_precision_loss, reason = "no more than 64 classes")]
        Some(style.palette.at(class as f64 / last as f64))
    }

    /// Whether all elements of a fractal are of one class.
    #[must_use]
    pub fn keep_fractals_whole(&self) -> bool {
        matches!(self.by, ColorBy::None | ColorBy::Age | ColorBy::Fractal)
    }
}

/// What a walk over an approximant learns before anything is drawn.
#[derive(Clone, Debug)]
pub struct Survey<'g> {
    graph: &'g Graph,
    style: &'g Style,
    /// What is drawn, without strokes of a width in pixels.
    pub bounds: Bounds,
    /// Whether any outline is stroked.
    pub strokes: bool,
    /// The number of elements.
    pub elements: u64,
    /// The number of fractals.
    pub fractals: u64,
    /// The largest rank of an element in its fractal.
    pub largest_index: u64,
    fractal: Fractal,
    classes: Classes,
    /// The classes that something visible is in.
    used: Vec<bool>,
}

impl<'g> Survey<'g> {
    /// A survey that has seen nothing yet.
    #[must_use]
    pub fn new(graph: &'g Graph, style: &'g Style, steps: u32) -> Self {
        let classes = Classes::before_survey(style.color_by, graph, steps);
        Self {
            graph,
            style,
            bounds: Bounds::EMPTY,
            strokes: false,
            elements: 0,
            fractals: 0,
            largest_index: 0,
            fractal: Fractal { number: 0, age: 0 },
            used: classes.all().map(|_| false).collect(),
            classes,
        }
    }

    /// The classes of colour, now that everything has been seen, and those that are to be painted.
    #[must_use]
    pub fn classes(&self) -> (Classes, Vec<u64>) {
        let mut classes = self.classes;
        match classes.by {
            ColorBy::Fractal => classes.largest = self.fractals.saturating_sub(1),
            ColorBy::Index => classes.largest = self.largest_index.saturating_sub(1),
            _ => {
                let used = classes.all().zip(&self.used).filter(|(_, used)| **used);
                return (classes, used.map(|(class, _)| class).collect());
            }
        }
        (classes, classes.all().collect())
    }

    /// The pixels by which strokes of a width in pixels reach beyond their paths.
    #[must_use]
    pub fn overhang(&self) -> f64 {
        match self.style.width {
            Width::Pixels(width) if self.strokes => width * overhang(self.style),
            _ => 0.0,
        }
    }
}

/// How far strokes may reach beyond their paths, as a multiple of their width.
fn overhang(style: &Style) -> f64 {
    let cap = if style.cap == Cap::Square {
        std::f64::consts::FRAC_1_SQRT_2
    } else {
        0.5
    };
    // SVG's limit of a mitre's length is four times the width.
    let join = if style.join == Join::Miter { 2.0 } else { 0.5 };
    f64::max(cap, join)
}

impl Visitor for Survey<'_> {
    type Error = Infallible;

    fn begin(&mut self, fractal: Fractal) -> Result<(), Infallible> {
        self.fractal = fractal;
        self.fractals += 1;
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.elements += 1;
        self.largest_index = self.largest_index.max(element.index);
        let object = &self.graph.objects()[element.object];
        if object.visible {
            if !matches!(self.style.color_by, ColorBy::Fractal | ColorBy::Index) {
                let class = self.classes.of(element, &self.fractal, self.graph);
                if let Some(used) = usize::try_from(class)
                    .ok()
                    .and_then(|class| self.used.get_mut(class))
                {
                    *used = true;
                }
            }
            let base_element = &self.graph.base_elements()[object.base_element];
            let stroked = !base_element.is_closed() || self.style.outlines_polygons();
            let pad = match self.style.width {
                Width::Relative(width) if stroked => {
                    width * element.frame.length() * overhang(self.style)
                }
                _ => 0.0,
            };
            self.strokes |= stroked;
            base_element.add_to(&mut self.bounds, &element.frame.map, pad);
        }
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}
