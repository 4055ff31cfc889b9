use std::convert::Infallible;
use std::num::NonZero;
use std::sync::Arc;

use crate::graph::Graph;
use crate::grow::{Growth, WalkError, walk_with};
use crate::parallel::Team;
use crate::style::{ColorBy, Colour, Style, Width};

use super::painter::Painter;
use super::sight::Sight;
use super::sketch::Sketcher;
use super::surface::{Pen, Surface};
use super::{Canvas, Classes, Drawing, RenderError, Survey};

/// An approximant on its canvas.
pub(crate) struct Scene<'a> {
    pub(super) graph: &'a Graph,
    growth: &'a Growth<'a>,
    pub(super) style: &'a Style,
    pub(super) canvas: Canvas,
    pub(super) sight: Sight,
    pub(super) classes: Classes,
    passes: Vec<Pass>,
    /// The number of elements.
    elements: u64,
    /// Whether closed paths are filled as they are stroked.
    pub(super) fills_strokes: bool,
}

/// What one walk paints.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Pass {
    /// The areas of fractals that are closed chains, under everything else.
    Areas,
    /// The elements of a class.
    Class(u64),
}

impl<'a> Scene<'a> {
    /// What a survey has seen, on a canvas.
    pub(crate) fn new(survey: &Survey<'a>, growth: &'a Growth<'a>, canvas: Canvas) -> Self {
        let (graph, style) = (survey.graph(), survey.style());
        let (classes, painted) = survey.classes();
        // One path for both, where stroke and colour never change along a fractal.
        let together = graph.draws_closed_paths()
            && matches!(style.width, Width::Pixels(_))
            && graph.widest().is_none()
            && classes.keep_fractals_whole();
        let areas = (style.fill.is_some() && !together).then_some(Pass::Areas);
        let painted = painted.into_iter().map(Pass::Class);
        let passes: Vec<_> = areas.into_iter().chain(painted).collect();
        if let Some(progress) = growth.progress {
            // The survey, and a walk for everything that is painted apart.
            let walks = u64::from(survey.walked) + passes.len() as u64;
            progress.expect(survey.elements * walks);
        }
        Self {
            graph,
            growth,
            style,
            canvas,
            sight: survey.sight().clone(),
            classes,
            passes,
            elements: survey.elements,
            fills_strokes: together && style.fill.is_some(),
        }
    }
}

impl Drawing for Scene<'_> {
    fn size(&self) -> [u32; 2] {
        self.canvas.size()
    }

    fn background(&self) -> Option<Colour> {
        self.style.background
    }

    fn pen(&self) -> Pen {
        super::pen(self.style)
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError> {
        let tells_index = self.style.color_by == ColorBy::Index;
        // Ranks that are not known before need one pair of eyes.
        let is_whole = tells_index && (self.sight.cuts() || !self.graph.is_plain());
        let span = (!is_whole).then_some(if tells_index { LONG_SPAN } else { SPAN });
        for &pass in &self.passes {
            let mut painter = Painter::new(self, pass, surface);
            let comb = painter.comb().map(Arc::new);
            let fresh = || Sketcher::new(self, pass, comb.clone());
            let walked = walk_with(
                team,
                self.graph,
                self.growth,
                span,
                fresh,
                |sketcher, seam| {
                    let painted = painter.paint_span(&sketcher.sketch, seam);
                    sketcher.clear();
                    painted
                },
            )?;
            painter.finish()?;
            if let Some(progress) = self.growth.progress {
                // What a pass leaves out is done with it.
                progress.count(self.elements.saturating_sub(walked.elements));
            }
        }
        Ok(())
    }
}

/// Sketches are about so many elements; where colours run along, most of them stay empty.
const SPAN: u64 = 1 << 12;
const LONG_SPAN: u64 = 1 << 14;

impl<'a> Survey<'a> {
    /// What the graph tells of an approximant, or a walk over it where it does not. Colours that
    /// tell steps span `steps` of them.
    pub(crate) fn of(
        graph: &'a Graph,
        growth: &Growth<'_>,
        style: &'a Style,
        steps: u32,
        threads: NonZero<usize>,
    ) -> Result<Self, WalkError<Infallible>> {
        match Self::known(graph, growth, style, steps) {
            Some(known) => Ok(known),
            None => Self::new(graph, style, steps).walked(growth, threads),
        }
    }
}
