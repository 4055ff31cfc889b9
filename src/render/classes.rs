use std::ops::{Range, RangeInclusive};

use crate::graph::{Graph, Object, Replacement};
use crate::grow::{Element, Fractal, Run};
use crate::style::{ColorBy, Colour, Style};

/// Colours that vary continuously are quantised to this many classes at most.
const MOST_CLASSES: u64 = 64;

/// How many of some elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Share {
    All,
    Some,
    None,
}

/// The classes of colour of an approximant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Classes {
    by: ColorBy,
    /// The largest value that is told apart; values start at 0.
    largest: u128,
    /// Where generators or maps are told, how many values come before those of the first: one if something
    /// is drawn that none has made, as the initiator.
    before: u128,
}

impl Classes {
    /// The classes once the numbers of fractals and of elements in the largest one are known.
    pub(super) fn after_survey(self, fractals: u64, largest_index: u128) -> Self {
        let largest = match self.by {
            ColorBy::Fractal => u128::from(fractals).saturating_sub(1),
            ColorBy::Index => largest_index.saturating_sub(1),
            _ => self.largest,
        };
        Self { largest, ..self }
    }

    /// Whether an element's class is known without a survey.
    pub(super) fn need_no_survey(&self) -> bool {
        !matches!(self.by, ColorBy::Fractal | ColorBy::Index)
    }

    /// The classes of approximant `steps` of a graph, as far as they are known without a survey.
    pub(super) fn before_survey(by: ColorBy, graph: &Graph, steps: u32) -> Self {
        let before = u128::from(draws_unmade(by, graph, steps));
        let largest = match by {
            ColorBy::None | ColorBy::Hits | ColorBy::Tint | ColorBy::Fractal | ColorBy::Index => 0,
            ColorBy::Step | ColorBy::Age => u128::from(steps),
            ColorBy::Generator | ColorBy::FirstMap | ColorBy::LastMap => {
                (graph.origins() as u128 + before).saturating_sub(1)
            }
            ColorBy::Direction => 3,
        };
        Self {
            by,
            largest,
            before,
        }
    }

    /// The number of classes, 64 at most.
    #[must_use]
    pub fn count(&self) -> u64 {
        u64::try_from(self.largest).map_or(MOST_CLASSES, |largest| (largest + 1).min(MOST_CLASSES))
    }

    pub(super) fn all(&self) -> Range<u64> {
        0..self.count()
    }

    /// The class of an element, from 0.
    #[inline]
    #[must_use]
    pub fn of(&self, element: &Element, fractal: &Fractal, graph: &Graph) -> u64 {
        self.of_value(self.value(element, fractal, graph))
    }

    /// The class of all elements that are an object, if that tells it.
    pub(super) fn of_object(&self, object: &Object) -> Option<u64> {
        self.value_of_object(object)
            .map(|value| self.of_value(value))
    }

    /// The value of all elements that are an object, likewise.
    pub(super) fn value_of_object(&self, object: &Object) -> Option<u128> {
        let maker = maker(self.by, object)?;
        Some(maker.map_or(0, |number| number as u128 + self.before))
    }

    /// The value of what the colours tell.
    #[inline]
    pub(super) fn value(&self, element: &Element, fractal: &Fractal, graph: &Graph) -> u128 {
        match self.by {
            ColorBy::None | ColorBy::Hits | ColorBy::Tint => 0,
            ColorBy::Step => element.born.into(),
            ColorBy::Age => fractal.age.into(),
            ColorBy::Fractal => fractal.number.into(),
            ColorBy::Index => element.index - 1,
            ColorBy::Generator | ColorBy::FirstMap | ColorBy::LastMap => {
                let object = &graph.objects()[element.object];
                self.value_of_object(object).unwrap_or(0)
            }
            ColorBy::Direction => u128::from(element.frame.direction.number()) - 1,
        }
    }

    /// The steps in which the elements of a class are born; `None` if it may be any.
    pub(super) fn steps(&self, class: u64) -> Option<RangeInclusive<u32>> {
        if self.by != ColorBy::Step {
            return None;
        }
        let first = (0..=self.largest).find(|&step| self.of_value(step) >= class)?;
        let mut steps = (0..=self.largest).rev();
        let last = steps.find(|&step| self.of_value(step) <= class)?;
        Some(u32::try_from(first).ok()?..=u32::try_from(last).ok()?)
    }

    /// How many elements of a run are in a class.
    pub(super) fn share(
        &self,
        run: &Run<'_>,
        fractal: &Fractal,
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
            // Ranks grow along the way.
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

    /// The class of a value of what the colours tell.
    #[inline]
    pub(super) fn of_value(&self, value: u128) -> u64 {
        let most = u128::from(MOST_CLASSES);
        let class = if self.largest < most {
            value
        } else {
            value.saturating_mul(most) / (self.largest + 1)
        };
        u64::try_from(class).unwrap_or(MOST_CLASSES - 1)
    }

    /// The colour of a class.
    #[must_use]
    pub fn colour(&self, class: u64, style: &Style) -> Option<Colour> {
        if !self.by.takes_palette() {
            return None;
        }
        let last = self.count().saturating_sub(1).max(1);
        #[expect(clippy::cast_precision_loss, reason = "no more than 64 classes")]
        Some(style.palette.at(class as f64 / last as f64))
    }

    /// The class of all elements of some ranks from 0, if colours tell them and there is one.
    pub(super) fn of_ranks(&self, ranks: &Range<u128>) -> Option<u64> {
        let class = self.of_value(ranks.start);
        let is_one = self.by == ColorBy::Index && self.of_value(ranks.end) == class;
        is_one.then_some(class)
    }

    /// Whether no element comes after one of a later class.
    pub(super) fn come_in_order(&self, graph: &Graph) -> bool {
        match self.by {
            ColorBy::Fractal => true,
            ColorBy::Index => !graph.seeds,
            _ => false,
        }
    }

    /// Whether all elements of a fractal are of one class.
    #[must_use]
    pub fn keep_fractals_whole(&self) -> bool {
        matches!(
            self.by,
            ColorBy::None | ColorBy::Hits | ColorBy::Tint | ColorBy::Age | ColorBy::Fractal
        )
    }
}

/// The generator or map that has made an object, by number, where colours tell it.
fn maker(by: ColorBy, object: &Object) -> Option<Option<usize>> {
    match by {
        ColorBy::Generator | ColorBy::FirstMap => Some(object.origin),
        ColorBy::LastMap => Some(object.last_map),
        _ => None,
    }
}

/// Whether approximant `steps` of a graph shows something that no generator or map has made: an infertile
/// part of the initiator, or a condensation set.
fn draws_unmade(by: ColorBy, graph: &Graph, steps: u32) -> bool {
    let is_unmade = |object: &Object| object.visible && maker(by, object) == Some(None);
    let start = || graph.initiator(steps).instances.iter();
    let mut kept = graph
        .objects()
        .iter()
        .filter(|object| steps > 0 && matches!(object.replacement, Replacement::Kept));
    kept.any(is_unmade)
        || (steps == 0 && start().any(|instance| is_unmade(&graph.objects()[instance.object])))
}
