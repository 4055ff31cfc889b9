//! Layout of a picture: prepass, canvas and number of steps.

use crate::extent::Limits;
use crate::geometry::Bounds;
use crate::graph::Graph;
use crate::grow::Growth;
use crate::style::{View, Width};

use super::canvas::{Canvas, NoRoom, Size};
use super::culling::{Culling, NEARLY};
use super::error::{NoDetail, RenderError};
use super::options::{Detail, Options};
use super::paint::overhang;
use super::picture::{Empty, Picture};
use super::plot::Plotted;
use super::prepass::Prepass;
use super::scene::Scene;
use super::short_cuts::ShortCut;

/// Cutoff length of the first estimate, as a fraction of the initiator's longest element.
const FIRST_LOOK: f64 = 1.0 / 8.0;

/// Maximum number of further estimates, each finer by that fraction, while nothing is visible.
const MAX_LOOKS: u32 = 4;

/// Maximum number of iterations. The detail determines the bounding box, which determines the scale and
/// thereby the length of the detail.
const MAX_ROUNDS: u32 = 8;

/// Result of the prepass.
pub(crate) struct Layout<'a> {
    pub(crate) prepass: Prepass<'a>,
    pub(super) canvas: Canvas,
    /// Growth, of as many steps as a detail takes.
    pub(crate) growth: Growth<'a>,
}

/// State of the prepass.
struct Surveyor<'a> {
    graph: &'a Graph,
    growth: Growth<'a>,
    options: &'a Options,
    /// Limit of steps.
    limit: u32,
    /// Number of elements of discarded prepasses.
    elements: u64,
    /// Radii of the objects' subtrees, computed on first use.
    reaches: Option<Vec<f64>>,
}

impl<'a> Layout<'a> {
    /// Returns the approximant on its canvas.
    pub(super) fn scene(&self) -> Scene<'_> {
        Scene::new(&self.prepass, &self.growth, self.canvas)
    }

    /// Returns the numbers of the picture that is drawn.
    pub(super) fn picture(&self, plotted: Option<Plotted>) -> Picture {
        let prepass = &self.prepass;
        Picture {
            size: self.canvas.size(),
            window: Some(self.canvas.window()),
            steps: self.growth.steps,
            elements: prepass.elements,
            fractals: prepass.fractals,
            is_part: prepass.culling().is_bounded(),
            empty: prepass.shows_nothing().then(Empty::default),
            plotted,
            instanced: None,
            is_limit: false,
        }
    }

    /// Repeats the prepass of a graph until the size of a pixel is known.
    pub(crate) fn find(
        graph: &'a Graph,
        growth: &Growth<'a>,
        options: &'a Options,
    ) -> Result<Self, RenderError> {
        if let Some(detail) = options.detail {
            if graph.counts_index() {
                return Err(NoDetail::CountsIndex.into());
            }
            if detail.decides_steps && graph.is_time_indexed() {
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
        let mut prepass = match (options.view.window, options.detail) {
            (Some(window), _) => surveyor.survey_window(window)?,
            (None, Some(detail)) => surveyor.survey_to(detail.pixels)?,
            (None, None) => surveyor.prepass(Culling::unbounded())?,
        };
        if options.detail.is_some_and(|detail| detail.decides_steps) {
            let fewer = surveyor.growth.steps - surveyor.steps_of_whole(&prepass);
            prepass = prepass.sooner(&surveyor.growth, fewer);
            surveyor.growth.steps -= fewer;
        }
        prepass.short_cuts = options.short_cuts;
        if let Some(progress) = growth.progress {
            progress.expect(surveyor.elements);
        }
        Ok(Self {
            canvas: surveyor.canvas(&prepass)?,
            prepass,
            growth: surveyor.growth,
        })
    }
}

impl<'a> Surveyor<'a> {
    fn prepass(&self, culling: Culling) -> Result<Prepass<'a>, RenderError> {
        let Self { graph, growth, .. } = *self;
        let Options { style, threads, .. } = self.options;
        if !culling.cuts() && self.options.short_cuts.has(ShortCut::Prepass) {
            return Ok(Prepass::of(graph, &growth, style, growth.steps, *threads)?);
        }
        let prepass = Prepass::new(graph, style, growth.steps);
        Ok(prepass.of_what_is_in(culling).walked(&growth, *threads)?)
    }

    fn canvas(&self, prepass: &Prepass<'a>) -> Result<Canvas, RenderError> {
        let Options { view, size, .. } = self.options;
        Ok(Canvas::of([prepass], view, *size)?)
    }

    /// Returns the number of steps after which the whole set is finer than the detail, where the graph determines it, so
    /// that ages and the range of colours do not depend on the window; otherwise, that of the part that was walked.
    fn steps_of_whole(&self, prepass: &Prepass<'a>) -> u32 {
        let shortest = prepass.culling().shortest().filter(|it| *it > 0.0);
        let of_whole = shortest.and_then(|it| self.graph.steps_to(libm::log2(it)));
        let of_whole = of_whole.filter(|steps| *steps <= self.limit);
        of_whole.unwrap_or(prepass.steps)
    }

    /// Returns an error if the detail decides the number of steps and the prepass reached the limit of steps.
    fn check(&self, prepass: &Prepass<'a>) -> Result<(), NoDetail> {
        let steps = self.limit;
        let decides = |detail: Detail| detail.decides_steps;
        if self.options.detail.is_some_and(decides) && prepass.steps >= steps && steps > 0 {
            return Err(NoDetail::TooFewSteps { steps });
        }
        Ok(())
    }

    /// Makes the prepass of the part of the set that lies in a window.
    fn survey_window(&mut self, window: [f64; 4]) -> Result<Prepass<'a>, RenderError> {
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
        let culling = Culling::to_length(graph, shortest);
        let shown = canvas.shown(stroke);
        let links = culling.links(graph, &growth);
        let met = Bounds::new(shown.min() - links, shown.max() + links);
        let prepass = Prepass::new(graph, style, growth.steps)
            .of_what_is_in(culling.clone())
            .with_ranks_of(&growth);
        if let Some(whole) = self.within(&canvas, &bounds, &culling) {
            return Ok(whole.of_what_comes_into(met));
        }
        // Elements within a pixel of the picture contribute to the coverage at its edge.
        let shown = canvas.shown(stroke + 1.0);
        let culling = culling.within(&shown, graph, &growth, style, prepass.counts_ranks());
        let prepass = if culling.cuts() {
            let prepass = prepass.of_what_is_in(culling).of_what_comes_into(met);
            prepass.walked(&growth, *threads)?
        } else {
            let mut prepass = self.prepass(culling)?;
            prepass.steps = growth.steps;
            prepass.of_what_comes_into(met)
        };
        self.check(&prepass)?;
        Ok(prepass)
    }

    /// Returns the prepass of the whole set, of which nothing is culled, if the graph determines it and the set lies in a
    /// window. `start` is the box of the initiator.
    fn within(&self, canvas: &Canvas, start: &Bounds, culling: &Culling) -> Option<Prepass<'a>> {
        let Self { graph, growth, .. } = *self;
        let Options {
            style, short_cuts, ..
        } = self.options;
        // Most windows that show a part only do not show all of the initiator.
        let shown = canvas.shown(0.0);
        if culling.cuts() || !short_cuts.has(ShortCut::Prepass) || !shown.contains(start) {
            return None;
        }
        let mut whole = Prepass::known(graph, &growth, style, growth.steps)?;
        whole.steps = growth.steps;
        Some(whole).filter(|whole| shown.contains(&whole.bounds))
    }

    /// Sets the number of steps that corresponds to a cutoff length, if all elements of a step are equally
    /// long; returns whether they are.
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

    /// Makes the prepass of the set down to a cutoff length, completely or as far as the size of a pixel depends on it.
    fn prepass_down_to(&mut self, shortest: f64) -> Result<Prepass<'a>, RenderError> {
        if !self.step_down_to(shortest) {
            let culling = Culling::to_length(self.graph, shortest);
            let style = &self.options.style;
            let prepass = Prepass::new(self.graph, style, self.growth.steps);
            let reaches = self.reaches.get_or_insert_with(|| prepass.reaches());
            let prepass = prepass.of_what_is_in(culling.clone());
            return match prepass.glimpsed(&self.growth, reaches, Limits::DRAWING) {
                Some(glimpse) => Ok(glimpse),
                None => self.prepass(culling),
            };
        }
        let mut prepass = self.prepass(Culling::unbounded())?;
        prepass.steps = self.growth.steps;
        Ok(prepass)
    }

    /// Completes a prepass.
    fn completed(&self, prepass: Prepass<'a>) -> Result<Prepass<'a>, RenderError> {
        let prepass = if !prepass.is_bounded {
            prepass
        } else if let Some(counted) = prepass.counted(&self.growth)? {
            counted
        } else {
            prepass.walked(&self.growth, self.options.threads)?
        };
        self.check(&prepass)?;
        Ok(prepass)
    }

    /// Makes the prepass of the set down to a detail in pixels.
    fn survey_to(&mut self, pixels: f64) -> Result<Prepass<'a>, RenderError> {
        let start = self.graph.initiator(self.growth.steps).instances.iter();
        let longest = start.map(|instance| instance.length).fold(0.0, f64::max) * self.graph.unit();
        let mut shortest = longest * FIRST_LOOK;
        let mut prepass = self.prepass_down_to(shortest)?;
        for _ in 0..MAX_LOOKS {
            self.check(&prepass)?;
            if !prepass.bounds.is_empty() {
                break;
            }
            shortest *= FIRST_LOOK;
            self.elements += prepass.elements;
            prepass = self.prepass_down_to(shortest)?;
        }
        for round in 1.. {
            self.check(&prepass)?;
            let next = pixels / self.canvas(&prepass)?.scale();
            #[expect(clippy::float_cmp, reason = "the same box gives the same scale")]
            if next == shortest {
                break;
            }
            if round == MAX_ROUNDS {
                prepass = self.completed(prepass)?;
                if next < shortest / 2.0 && prepass.steps < self.limit {
                    return Err(NoDetail::Vanishes.into());
                }
                return Ok(prepass);
            }
            shortest = next;
            self.elements += prepass.elements;
            prepass = self.prepass_down_to(shortest)?;
        }
        self.completed(prepass)
    }
}

impl Canvas {
    /// Creates a canvas that shows the bounding boxes of prepasses at a common scale, or a window.
    pub(crate) fn of<'p>(
        prepasses: impl IntoIterator<Item = &'p Prepass<'p>>,
        view: &View,
        size: Size,
    ) -> Result<Self, NoRoom> {
        let mut all = Bounds::EMPTY;
        let mut overhang = 0.0_f64;
        for prepass in prepasses {
            if view.window.is_none() && prepass.is_beyond {
                return Err(NoRoom::Beyond);
            }
            all.add_all(&prepass.bounds);
            overhang = overhang.max(prepass.overhang());
        }
        let canvas = match view.window {
            Some(window) => Self::of_window(window, view, size)?,
            None => Self::fit(&all, size, view.pad() + overhang)?,
        };
        if !all.is_empty() && !canvas.holds(&all) {
            return Err(NoRoom::TooClose);
        }
        Ok(canvas)
    }
}
