//! What a picture shows, on what canvas, after how many steps.

use crate::geometry::Bounds;
use crate::graph::Graph;
use crate::grow::{Growth, WalkError};
use crate::style::Width;

use super::sight::{NEARLY, Sight};
use super::survey::overhang;
use super::{Canvas, Format, Options, RenderError, Survey};

/// Down to what size elements are replaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// Elements shorter than so many pixels are not replaced: they are drawn as their approximant
    /// draws them, and seed nothing. Above 0.
    ///
    /// What leads to seeds that are placed as the initiator is replaced nevertheless.
    pub pixels: f64,
    /// Whether the number of steps that is grown is what this takes, and what growth says is only a
    /// limit.
    pub decides_steps: bool,
}

/// Why a picture has not the detail that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoDetail {
    /// Indices are counted while walking.
    #[error("what replaces an element depends on the number of all those before it")]
    CountsIndex,
    /// Elements do not get smaller.
    #[error("its elements do not get smaller than any length")]
    DoesNotShrink,
    /// Every number of steps is grown out of an initiator of its own.
    #[error("every step of it starts anew, so that the detail cannot tell how many there are")]
    StartsAnew,
    /// All that is drawn shrinks with its elements, and fills the picture as before.
    #[error("all that is drawn gets as small as its elements")]
    Vanishes,
    /// The detail is to decide the number of steps, and is not come to soon enough.
    #[error("{steps} steps are not enough")]
    TooFewSteps {
        /// The number of steps that growth allows.
        steps: u32,
    },
}

/// The first look at what has no known size: elements down to this part of the initiator's longest.
const FIRST_LOOK: f64 = 1.0 / 8.0;

/// If nothing is visible there, so many more looks are taken, each as much closer again.
const MOST_LOOKS: u32 = 4;

/// So many elements are counted by a walk, even where what is covered already need not be grown.
const WORTH_COUNTING: u64 = 1 << 21;

/// The detail changes what is drawn, which changes the scale and so the detail: after so many
/// rounds, the last is good enough.
const MOST_ROUNDS: u32 = 8;

/// What is drawn, and where.
pub(super) struct Layout<'a> {
    pub(super) survey: Survey<'a>,
    pub(super) canvas: Canvas,
    pub(super) growth: Growth<'a>,
}

/// Surveys one after another.
struct Surveyor<'a> {
    graph: &'a Graph,
    growth: Growth<'a>,
    options: &'a Options,
    /// The most steps.
    limit: u32,
    /// The elements of the surveys that have been thrown away.
    elements: u64,
    /// How far what becomes of objects reaches, once it has been asked for.
    reaches: Option<Vec<f64>>,
}

impl<'a> Layout<'a> {
    /// Surveys a graph, as often as it takes to know how large a pixel is.
    pub(super) fn find(
        graph: &'a Graph,
        growth: &Growth<'a>,
        options: &'a Options,
    ) -> Result<Self, RenderError> {
        if let Some(detail) = options.detail {
            if graph.counts_index() {
                return Err(NoDetail::CountsIndex.into());
            }
            if detail.decides_steps && graph.is_levelled() {
                return Err(NoDetail::StartsAnew.into());
            }
            if detail.decides_steps && !graph.shrinks() {
                return Err(NoDetail::DoesNotShrink.into());
            }
        }
        let mut surveyor = Surveyor {
            graph,
            growth: *growth,
            options,
            limit: growth.steps,
            elements: 0,
            reaches: None,
        };
        let mut survey = match (options.view.window, options.detail) {
            (Some(window), _) => surveyor.survey_window(window)?,
            (None, Some(detail)) => surveyor.survey_to(detail.pixels)?,
            (None, None) => surveyor.survey(Sight::unbounded())?,
        };
        if options.detail.is_some_and(|detail| detail.decides_steps) {
            let fewer = surveyor.growth.steps - survey.steps;
            survey = survey.sooner(&surveyor.growth, fewer);
            surveyor.growth.steps -= fewer;
        }
        survey.is_to_detail = options.detail.is_some();
        if let Some(progress) = growth.progress {
            progress.expect(surveyor.elements);
        }
        Ok(Self {
            canvas: surveyor.canvas(&survey)?,
            survey,
            growth: surveyor.growth,
        })
    }
}

impl<'a> Surveyor<'a> {
    fn survey(&self, sight: Sight) -> Result<Survey<'a>, RenderError> {
        let Self { graph, growth, .. } = *self;
        let Options { style, threads, .. } = self.options;
        if !sight.cuts() {
            return Ok(Survey::of(graph, &growth, style, growth.steps, *threads)?);
        }
        let survey = Survey::new(graph, style, growth.steps);
        Ok(survey.of_what_is_in(sight).walked(&growth, *threads)?)
    }

    fn canvas(&self, survey: &Survey<'a>) -> Result<Canvas, RenderError> {
        let Options { view, size, .. } = self.options;
        Ok(Canvas::of(std::slice::from_ref(survey), view, *size)?)
    }

    /// Refuses a survey that has met the limit of steps where there should be none.
    fn check(&self, survey: &Survey<'a>) -> Result<(), NoDetail> {
        let steps = self.limit;
        let decides = |detail: Detail| detail.decides_steps;
        if self.options.detail.is_some_and(decides) && survey.steps >= steps && steps > 0 {
            return Err(NoDetail::TooFewSteps { steps });
        }
        Ok(())
    }

    /// Surveys what lies in a window.
    fn survey_window(&mut self, window: [f64; 4]) -> Result<Survey<'a>, RenderError> {
        let Options {
            style,
            view,
            threads,
            ..
        } = self.options;
        let canvas = Canvas::of_window(window, view, self.options.size)?;
        let start = self.graph.initiator(self.growth.steps).instances.iter();
        let mut bounds = Bounds::EMPTY;
        start
            .flat_map(|instance| instance.frame.ends())
            .for_each(|end| bounds.add(end));
        canvas.check_precision(&bounds)?;
        let shortest = match self.options.detail {
            Some(detail) => detail.pixels / canvas.scale(),
            None => 0.0,
        };
        let stroke = match style.width {
            Width::Pixels(width) => width * self.graph.widest().unwrap_or(1.0) * overhang(style),
            Width::Relative(_) => 0.0,
        };
        let shortest = if shortest > 0.0 && self.step_down_to(shortest) {
            0.0
        } else {
            shortest
        };
        let Self { graph, growth, .. } = *self;
        let sight = Sight::to_length(graph, shortest);
        let shown = canvas.shown(stroke);
        let links = sight.links(graph, &growth);
        let met = Bounds::new(shown.min() - links, shown.max() + links);
        let survey = Survey::new(graph, style, growth.steps)
            .of_what_is_in(sight.clone())
            .with_ranks_of(&growth);
        // What comes near a pixel tinges it.
        let shown = canvas.shown(stroke + 1.0);
        let sight = sight.within(&shown, graph, &growth, style, survey.counts_ranks());
        let survey = if sight.cuts() {
            let survey = survey.of_what_is_in(sight).of_what_comes_into(met);
            survey.walked(&growth, *threads)?
        } else {
            let mut survey = self.survey(sight)?;
            survey.steps = growth.steps;
            survey.of_what_comes_into(met)
        };
        self.check(&survey)?;
        Ok(survey)
    }

    /// If all elements of a step are equally long, so that a number of steps says the same as a length:
    /// grows by that number.
    fn step_down_to(&mut self, shortest: f64) -> bool {
        let Some([mut length, ratio]) = self.graph.even_lengths() else {
            return false;
        };
        let shortest = shortest * NEARLY;
        self.growth.steps = 0;
        while length >= shortest && self.growth.steps < self.limit {
            length *= ratio;
            self.growth.steps += 1;
        }
        true
    }

    /// Looks at everything down to elements of a length: a survey, or as much of one as it takes to
    /// know how large a pixel is.
    fn look_down_to(&mut self, shortest: f64) -> Result<Survey<'a>, RenderError> {
        if !self.step_down_to(shortest) {
            let sight = Sight::to_length(self.graph, shortest);
            let style = &self.options.style;
            let survey = Survey::new(self.graph, style, self.growth.steps);
            let reaches = self.reaches.get_or_insert_with(|| survey.reaches());
            let survey = survey.of_what_is_in(sight.clone());
            return match survey.glimpsed(&self.growth, reaches) {
                Some(glimpse) => Ok(glimpse),
                None => self.survey(sight),
            };
        }
        let mut survey = self.survey(Sight::unbounded())?;
        survey.steps = self.growth.steps;
        Ok(survey)
    }

    /// Learns the rest of what has been looked at.
    fn completed(&self, survey: Survey<'a>) -> Result<Survey<'a>, RenderError> {
        let survey = if survey.is_bounded {
            self.counted(survey)?
        } else {
            survey
        };
        self.check(&survey)?;
        Ok(survey)
    }

    /// Counts what there is to draw; or some of it, if there is more and what is covered already need not
    /// be grown. What is visited then is limited while it is drawn.
    fn counted(&self, survey: Survey<'a>) -> Result<Survey<'a>, RenderError> {
        let Options {
            threads,
            format,
            plot,
            ..
        } = *self.options;
        let hides = format == Format::Png && !plot && survey.may_hide();
        let limited = |most_elements: u64| Growth {
            most_elements,
            ..self.growth
        };
        let most = self.growth.most_elements;
        if let Some(counted) = survey.counted(&limited(if hides { u64::MAX } else { most }))? {
            return Ok(counted);
        }
        let uncounted = survey.uncounted(WORTH_COUNTING);
        match uncounted.filter(|_| hides && most > WORTH_COUNTING) {
            None => Ok(survey.walked(&self.growth, threads)?),
            Some(uncounted) => match survey.walked(&limited(WORTH_COUNTING), threads) {
                Err(WalkError::TooManyElements { .. }) => Ok(uncounted),
                walked => Ok(walked?),
            },
        }
    }

    /// Surveys everything down to elements of a number of pixels.
    fn survey_to(&mut self, pixels: f64) -> Result<Survey<'a>, RenderError> {
        let start = self.graph.initiator(self.growth.steps).instances.iter();
        let longest = start.map(|instance| instance.length).fold(0.0, f64::max) * self.graph.unit();
        let mut shortest = longest * FIRST_LOOK;
        let mut survey = self.look_down_to(shortest)?;
        for _ in 0..MOST_LOOKS {
            self.check(&survey)?;
            if !survey.bounds.is_empty() {
                break;
            }
            shortest *= FIRST_LOOK;
            self.elements += survey.elements;
            survey = self.look_down_to(shortest)?;
        }
        for round in 1.. {
            self.check(&survey)?;
            let next = pixels / self.canvas(&survey)?.scale();
            #[expect(clippy::float_cmp, reason = "the same box gives the same scale")]
            if next == shortest {
                break;
            }
            if round == MOST_ROUNDS {
                survey = self.completed(survey)?;
                if next < shortest / 2.0 && survey.steps < self.limit {
                    return Err(NoDetail::Vanishes.into());
                }
                return Ok(survey);
            }
            shortest = next;
            self.elements += survey.elements;
            survey = self.look_down_to(shortest)?;
        }
        self.completed(survey)
    }
}
