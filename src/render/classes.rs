//! Classes of elements by colour.

use std::ops::{Range, RangeInclusive};

use crate::geometry::Frame;
use crate::graph::{Graph, Object, Replacement};
use crate::grow::{Element, FractalInfo, Run};
use crate::style::{ColorBy, ColorProperty, Colour, Style};

/// Maximum number of classes into which values are quantised.
const MAX_CLASSES: u64 = 64;

/// Portion of a run's elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Share {
    All,
    Some,
    None,
}

/// Classes of the elements of an approximant by colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Classes {
    by: ColorBy,
    /// Least value that is distinguished from larger ones.
    least: u128,
    /// Largest value that is distinguished from smaller ones.
    largest: u128,
    /// Largest step or age.
    end: u32,
    /// If the colour depends on generators or maps: the value of the first one, which is 1 if the approximant
    /// draws elements that none of them has made, such as the initiator, and 0 otherwise.
    before: u128,
    /// Share of the last step that has not grown yet, in which the colours of what it brings change as well.
    lag: f64,
}

impl Classes {
    /// Returns the classes for known numbers of fractals and of elements in the largest fractal.
    pub(super) fn after_survey(self, fractals: u64, largest_index: u128) -> Self {
        let largest = match self.by {
            ColorBy::Fractal => u128::from(fractals).saturating_sub(1),
            ColorBy::Index => largest_index.saturating_sub(1),
            _ => self.largest,
        };
        Self { largest, ..self }
    }

    /// Returns whether classes are known without a prepass.
    pub(super) fn need_no_survey(&self) -> bool {
        !matches!(self.by, ColorBy::Fractal | ColorBy::Index)
    }

    /// Returns the classes of approximant `steps` of a graph, as far as they are known without a prepass.
    pub(super) fn before_survey<F: Frame>(style: &Style, graph: &Graph<F>, steps: u32) -> Self {
        let by = style.color_by;
        let before = u128::from(draws_unmade(by, graph, steps));
        let largest = match by.property() {
            ColorProperty::Step | ColorProperty::Age => u128::from(steps),
            ColorProperty::Object => (graph.origins() as u128 + before).saturating_sub(1),
            ColorProperty::Direction => 3,
            _ => 0,
        };
        let [least, largest] = match style.range() {
            Some(range) => distinguished(range, steps).map(u128::from),
            None => [0, largest],
        };
        Self {
            by,
            least,
            largest,
            end: steps,
            before,
            lag: graph.lag(),
        }
    }

    /// Returns the number of classes, at most 64.
    #[must_use]
    pub(crate) fn count(&self) -> u64 {
        let values = self.largest - self.least;
        u64::try_from(values).map_or(MAX_CLASSES, |values| {
            values.saturating_add(1).min(MAX_CLASSES)
        })
    }

    pub(super) fn all(&self) -> Range<u64> {
        0..self.count()
    }

    /// Returns the class of an element, from 0.
    #[inline]
    #[must_use]
    pub(crate) fn of(&self, element: &Element, fractal: &FractalInfo, graph: &Graph) -> u64 {
        self.of_value(self.value(element, fractal, graph))
    }

    /// Returns the class of all elements of an object, if the object determines it.
    pub(super) fn of_object<F: Frame>(&self, object: &Object<F>) -> Option<u64> {
        self.value_of_object(object)
            .map(|value| self.of_value(value))
    }

    /// Returns the value of all elements of an object, if the object determines it.
    pub(super) fn value_of_object<F: Frame>(&self, object: &Object<F>) -> Option<u128> {
        let maker = maker(self.by, object)?;
        Some(maker.map_or(0, |number| number as u128 + self.before))
    }

    /// Returns the value on which the colours of all elements of an object depend, if they depend on the object at most.
    pub(super) fn value_of_all<F: Frame>(&self, object: &Object<F>) -> Option<u128> {
        match self.by.property() {
            ColorProperty::Uniform | ColorProperty::Tint | ColorProperty::Frame => Some(0),
            _ => self.value_of_object(object),
        }
    }

    /// Returns the value on which the colour of an element depends.
    #[inline]
    pub(super) fn value(&self, element: &Element, fractal: &FractalInfo, graph: &Graph) -> u128 {
        match self.by.property() {
            ColorProperty::Uniform | ColorProperty::Tint | ColorProperty::Frame => 0,
            ColorProperty::Step => element.born.into(),
            ColorProperty::Age => fractal.age.into(),
            ColorProperty::Fractal => fractal.number.into(),
            ColorProperty::Index => element.index - 1,
            ColorProperty::Object => {
                let object = &graph.objects()[element.object];
                self.value_of_object(object).unwrap_or(0)
            }
            ColorProperty::Direction => u128::from(element.frame.direction().number()) - 1,
        }
    }

    /// Returns the steps in which the elements of a class are born; `None` if classes do not depend on steps.
    pub(super) fn steps(&self, class: u64) -> Option<RangeInclusive<u32>> {
        (self.by == ColorBy::Step).then(|| self.values(class))?
    }

    /// Returns the ages of the fractals whose elements are of a class; `None` if they may be any.
    pub(super) fn ages(&self, class: u64) -> Option<RangeInclusive<u32>> {
        (self.by == ColorBy::Age).then(|| self.values(class))?
    }

    /// Returns the values of a class, in steps.
    fn values(&self, class: u64) -> Option<RangeInclusive<u32>> {
        let of_step = |step: u32| self.of_value(step.into());
        let first = (0..=self.end).find(|&step| of_step(step) >= class)?;
        let last = (0..=self.end).rev().find(|&step| of_step(step) <= class)?;
        Some(first..=last)
    }

    /// Returns the portion of a run's elements that is in a class.
    pub(super) fn share(
        &self,
        run: &Run<'_>,
        fractal: &FractalInfo,
        graph: &Graph,
        class: u64,
    ) -> Share {
        if let Some(steps) = self.steps(class) {
            return match run.count_born_in(&steps) {
                0 => Share::None,
                count if count == run.count() => Share::All,
                _ => Share::Some,
            };
        }
        let of = |element: Element| self.of(&element, fractal, graph);
        let mut classes = run.elements_in_place().map(of);
        let mut ends = run.elements_in_place().map(of);
        let (Some(first), last) = (ends.next(), ends.next_back()) else {
            return Share::None;
        };
        let last = last.unwrap_or(first);
        let (all, any) = match self.by {
            _ if self.keep_fractals_whole() => (first == class, first == class),
            // Ranks increase along a run.
            ColorBy::Index => (
                first == class && last == class,
                (first..=last).contains(&class),
            ),
            _ if first == class => (classes.all(|of| of == class), true),
            _ => (false, classes.any(|of| of == class)),
        };
        match (all, any) {
            (true, _) => Share::All,
            (false, true) => Share::Some,
            (false, false) => Share::None,
        }
    }

    /// Returns the class of a value.
    #[inline]
    pub(super) fn of_value(&self, value: u128) -> u64 {
        let most = u128::from(MAX_CLASSES);
        let [value, values] =
            [value.clamp(self.least, self.largest), self.largest].map(|it| it - self.least);
        let class = if values < most {
            value
        } else {
            value.saturating_mul(most) / (values + 1)
        };
        u64::try_from(class).unwrap_or(MAX_CLASSES - 1)
    }

    /// Returns the colour of a class; `None` if the palette is not used.
    #[must_use]
    pub(crate) fn colour(&self, class: u64, style: &Style) -> Option<Colour> {
        if !self.by.takes_palette() || self.by.property() == ColorProperty::Frame {
            return None;
        }
        let last_class = self.count() - 1;
        let values = self.largest - self.least;
        #[expect(clippy::cast_precision_loss, reason = "colours need few digits")]
        let [least, last, step] = [
            self.least as f64,
            self.largest as f64,
            values as f64 / last_class.max(1) as f64,
        ];
        #[expect(clippy::cast_precision_loss, reason = "there are few classes")]
        let value = least + class as f64 * step;
        let is_newest = class == last_class && self.largest == u128::from(self.end);
        Some(match self.by.property() {
            ColorProperty::Step if is_newest => {
                style.colour_of_value(last - self.lag, last - self.lag)
            }
            ColorProperty::Step => style.colour_of_value(value, last - self.lag),
            ColorProperty::Age => {
                style.colour_of_value((value - self.lag).max(0.0), last - self.lag)
            }
            _ => style.colour_of_value(value, last),
        })
    }

    /// Returns whether classes never decrease in the order of a walk.
    pub(super) fn come_in_order(&self, graph: &Graph) -> bool {
        match self.by {
            ColorBy::Fractal => true,
            ColorBy::Index => !graph.has_fractals(),
            _ => false,
        }
    }

    /// Returns whether all elements of a fractal are in one class.
    #[must_use]
    pub(crate) fn keep_fractals_whole(&self) -> bool {
        use ColorProperty::{Age, Fractal, Tint, Uniform};
        matches!(self.by.property(), Uniform | Tint | Age | Fractal)
    }
}

/// Returns the least and the largest step or age that a range of colours distinguishes, of those from 0 to `end`.
fn distinguished([first, last]: [f64; 2], end: u32) -> [u32; 2] {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts to integers saturate"
    )]
    let [first, last] = [first.floor() as u32, last.ceil() as u32].map(|step| step.min(end));
    [first, last.max(first)]
}

/// Returns the number of the generator or map that made an object, if the colour depends on it.
fn maker<F: Frame>(by: ColorBy, object: &Object<F>) -> Option<Option<usize>> {
    match by {
        ColorBy::Generator | ColorBy::FirstMap => Some(object.origin),
        ColorBy::LastMap => Some(object.last_map),
        _ => None,
    }
}

/// Returns whether approximant `steps` of a graph draws an element that no generator or map has made: an
/// infertile part of the initiator, or a condensation set.
fn draws_unmade<F: Frame>(by: ColorBy, graph: &Graph<F>, steps: u32) -> bool {
    let is_unmade = |object: &Object<F>| object.visible && maker(by, object) == Some(None);
    let start = || graph.initiator(steps).instances.iter();
    let mut kept = graph
        .objects()
        .iter()
        .filter(|object| steps > 0 && matches!(object.replacement, Replacement::Kept));
    kept.any(is_unmade)
        || (steps == 0 && start().any(|instance| is_unmade(&graph.objects()[instance.object])))
}
