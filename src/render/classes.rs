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
    /// Largest value that is distinguished; values start at 0.
    largest: u128,
    /// If the colour depends on generators or maps: the value of the first one, which is 1 if the approximant
    /// draws elements that none of them has made, such as the initiator, and 0 otherwise.
    before: u128,
    /// Number of classes into which values are quantised if there are more.
    most: u64,
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
        Self {
            by,
            largest,
            before,
            most: match style.range() {
                // A few of many values may have all colours.
                Some(_) => u64::MAX,
                None => MAX_CLASSES,
            },
            lag: graph.lag(),
        }
    }

    /// Returns the number of classes: at most 64, unless the palette has a range.
    #[must_use]
    pub(crate) fn count(&self) -> u64 {
        u64::try_from(self.largest).map_or(self.most, |largest| (largest + 1).min(self.most))
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

    /// Returns the value on which the colour of an element depends.
    #[inline]
    pub(super) fn value(&self, element: &Element, fractal: &FractalInfo, graph: &Graph) -> u128 {
        match self.by.property() {
            ColorProperty::Uniform | ColorProperty::Tint => 0,
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
        let first = (0..=self.largest).find(|&step| self.of_value(step) >= class)?;
        let mut steps = (0..=self.largest).rev();
        let last = steps.find(|&step| self.of_value(step) <= class)?;
        Some(u32::try_from(first).ok()?..=u32::try_from(last).ok()?)
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
        let most = u128::from(self.most);
        let class = if self.largest < most {
            value
        } else {
            value.saturating_mul(most) / (self.largest + 1)
        };
        u64::try_from(class).unwrap_or(self.most - 1)
    }

    /// Returns the colour of a class; `None` if the palette is not used.
    #[must_use]
    pub(crate) fn colour(&self, class: u64, style: &Style) -> Option<Colour> {
        if !self.by.takes_palette() {
            return None;
        }
        let last = self.count() - 1;
        // Quantised values are too many for parts of steps to matter.
        let lag = if u128::from(last) == self.largest {
            self.lag
        } else {
            0.0
        };
        #[expect(clippy::cast_precision_loss, reason = "there are few classes")]
        let (value, most) = (class as f64, last as f64);
        Some(match self.by.property() {
            ColorProperty::Step if class == last => style.colour_of_value(most - lag, most - lag),
            ColorProperty::Step => style.colour_of_value(value, most - lag),
            ColorProperty::Age => style.colour_of_value((value - lag).max(0.0), most - lag),
            _ => style.colour_of_value(value, most),
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
