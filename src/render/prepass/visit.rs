//! Visits of elements and runs by a prepass.

use std::convert::Infallible;

use crate::geometry::Bounds;
use crate::grow::{Element, Enter, FractalInfo, Run, Subtree, Visitor};
use crate::render::frame_colours::length;

use super::{Prepass, joined, span};

impl Prepass<'_> {
    /// Adds a run as a whole; returns `false` if its box and its objects do not determine all that matters of a window. Strokes
    /// may extend the box by other lengths than those of the elements, and elements beyond the range of numbers are not
    /// looked for: both matter only where the box decides what is shown.
    fn add_whole(&mut self, run: &Run<'_>) -> bool {
        let Some(shown) = self.shown.filter(|_| !self.needs_lengths()) else {
            return false;
        };
        let visible = |number: &usize| Some(&self.graph.objects()[*number]).filter(|it| it.visible);
        let objects = run.objects().iter().filter_map(visible);
        let values = objects
            .clone()
            .map(|object| self.classes.value_of_all(object));
        let Some(values) = values.collect::<Option<Vec<_>>>() else {
            return false;
        };
        let mut own = Bounds::EMPTY;
        run.add_to(&mut own);
        let is_met = self.is_met || own.is_empty() || shown.contains(&own);
        let Some(last) = run.last().filter(|_| is_met) else {
            return false;
        };
        self.elements += run.count();
        if self.goes_on {
            self.last_index = Some(last.index);
        } else {
            self.largest_index = self.largest_index.max(last.index);
        }
        if own.is_empty() {
            return true;
        }
        self.is_met = true;
        self.strokes |= objects.clone().any(|object| self.is_stroked(object));
        if !self.is_bounded {
            let pads = objects.map(|object| self.pad(object));
            let pad = pads.fold(0.0, f64::max) * run.frame().stretch();
            let padded = Bounds::new(own.min() - pad, own.max() + pad);
            self.bounds.add_all(&padded);
        }
        values.into_iter().for_each(|value| self.use_value(value));
        true
    }
}

impl Visitor for Prepass<'_> {
    type Error = Infallible;

    fn takes_runs(&self) -> bool {
        true
    }

    fn longest_run(&self) -> u64 {
        span(self.graph)
    }

    fn cuts(&self) -> Option<f64> {
        self.culling.shortest()
    }

    fn go_on(&mut self, fractal: FractalInfo) {
        self.fractal = fractal;
        self.goes_on = true;
    }

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
        self.fractal = fractal;
        self.goes_on = false;
        self.fractals += 1;
        Ok(())
    }

    #[inline]
    fn enter(&mut self, subtree: &Subtree) -> Enter {
        let enter = self.culling.enter(subtree);
        // Skipped elements count, too: without a further step they would be drawn.
        if enter != Enter::Keep {
            self.steps = self.steps.max(subtree.born + 1);
        }
        enter
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.elements += 1;
        // Roots may be born later than any element that is replaced.
        self.steps = self.steps.max(element.born);
        if self.goes_on {
            self.last_index = Some(element.index);
        } else {
            self.largest_index = self.largest_index.max(element.index);
        }
        let object = &self.graph.objects()[element.object];
        if object.visible {
            let fractal = self.fractal;
            self.use_value_of(element, &fractal);
            self.strokes |= self.is_stroked(object);
            self.is_beyond |= !element.frame.is_in_range();
            if self.needs_lengths() {
                self.lengths = joined(self.lengths, [length(element); 2]);
            }
            if !self.is_bounded {
                let base_element = &self.graph.base_elements()[object.base_element];
                let pad = self.pad(object) * element.frame.stretch();
                match &self.shown {
                    Some(shown) if !self.is_met => {
                        let mut own = Bounds::EMPTY;
                        base_element.add_to(&mut own, &element.frame, pad);
                        self.is_met = shown.meets(&own);
                        self.bounds.add_all(&own);
                    }
                    _ => base_element.add_to(&mut self.bounds, &element.frame, pad),
                }
            }
        }
        Ok(())
    }

    fn run(&mut self, run: &Run<'_>) -> Result<(), Infallible> {
        self.steps = self.steps.max(run.settled());
        if self.add_whole(run) {
            return Ok(());
        }
        let mut elements = run.elements();
        elements.try_for_each(|element| self.element(&element))
    }
}
