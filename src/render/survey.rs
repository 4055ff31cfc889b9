use std::convert::Infallible;

use crate::geometry::Bounds;
use crate::graph::{Graph, Object};
use crate::grow::{Element, Enter, Fractal, Subtree, Visitor};
use crate::style::{Cap, Join, Style, Width};

use super::sight::Sight;
use super::{Classes, WIDTHS_AN_OCTAVE};

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
    /// Whether there was a walk to learn it.
    pub(super) walked: bool,
    /// The number of steps that are needed: more would change nothing.
    pub(super) steps: u32,
    sight: Sight,
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
            walked: false,
            steps: 0,
            sight: Sight::unbounded(),
            fractal: Fractal::default(),
            used: classes.all().map(|_| false).collect(),
            classes,
        }
    }

    /// A survey of what can be seen.
    #[must_use]
    pub(super) fn of_what_is_in(self, sight: Sight) -> Self {
        Self { sight, ..self }
    }

    /// What can be seen.
    pub(super) fn sight(&self) -> &Sight {
        &self.sight
    }

    /// What was walked over.
    pub(super) fn graph(&self) -> &'g Graph {
        self.graph
    }

    /// How it is drawn.
    pub(super) fn style(&self) -> &'g Style {
        self.style
    }

    /// The classes of colour, now that everything has been seen, and those that are to be painted.
    #[must_use]
    pub fn classes(&self) -> (Classes, Vec<u64>) {
        let classes = self.classes.after_survey(self.fractals, self.largest_index);
        if classes.need_no_survey() {
            let used = classes.all().zip(&self.used).filter(|(_, used)| **used);
            return (classes, used.map(|(class, _)| class).collect());
        }
        (classes, classes.all().collect())
    }

    pub(super) fn is_stroked(&self, object: &Object) -> bool {
        let base_element = &self.graph.base_elements()[object.base_element];
        !base_element.is_closed() || self.style.outlines_polygons()
    }

    /// How far the stroke of an object reaches beyond its outline, as a multiple of its length,
    /// where its width is relative.
    pub(super) fn pad(&self, object: &Object) -> f64 {
        match self.style.width {
            Width::Relative(width) if self.is_stroked(object) => {
                width * self.graph.unit() * relative_overhang(self.style)
            }
            _ => 0.0,
        }
    }

    /// The class of a value, where that is known without a survey.
    pub(super) fn class_of(&self, value: u64) -> u64 {
        self.classes.of_value(value)
    }

    /// Something visible is in a class.
    pub(super) fn use_class(&mut self, class: u64) {
        let used = usize::try_from(class).ok();
        if let Some(used) = used.and_then(|class| self.used.get_mut(class)) {
            *used = true;
        }
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
pub(super) fn overhang(style: &Style) -> f64 {
    let cap = if style.cap == Cap::Square {
        std::f64::consts::FRAC_1_SQRT_2
    } else {
        0.5
    };
    // SVG's limit of a mitre's length is four times the width.
    let join = if style.join == Join::Miter { 2.0 } else { 0.5 };
    f64::max(cap, join)
}

/// The same for widths that are relative: what is drawn may be a little wider than they say.
pub(super) fn relative_overhang(style: &Style) -> f64 {
    libm::exp2(0.5 / WIDTHS_AN_OCTAVE) * overhang(style)
}

impl Visitor for Survey<'_> {
    type Error = Infallible;

    fn takes_runs(&self) -> bool {
        !self.sight.cuts()
    }

    fn begin(&mut self, fractal: Fractal) -> Result<(), Infallible> {
        self.fractal = fractal;
        self.fractals += 1;
        Ok(())
    }

    #[inline]
    fn enter(&mut self, subtree: &Subtree) -> Enter {
        let enter = self.sight.enter(subtree);
        // What is skipped must still be asked about: in the last step it would be drawn.
        if enter != Enter::Keep {
            self.steps = self.steps.max(subtree.born + 1);
        }
        enter
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.elements += 1;
        self.largest_index = self.largest_index.max(element.index);
        let object = &self.graph.objects()[element.object];
        if object.visible {
            let class = self.classes.of(element, &self.fractal, self.graph);
            self.use_class(class);
            let base_element = &self.graph.base_elements()[object.base_element];
            self.strokes |= self.is_stroked(object);
            let pad = self.pad(object) * element.frame.stretch();
            base_element.add_to(&mut self.bounds, &element.frame.map, pad);
        }
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}
