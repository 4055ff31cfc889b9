//! Drawing of a picture to a goal, and the summary that is printed for it.

use std::io::Write;
use std::path::Path;

use super::super::readable;
use crate::graph::Graph;
use crate::grow::{Progress, Walked};
use crate::render::{self, Empty, Instanced, Plotted, RenderError, Unit, ZoomTarget};
use crate::style::ColorBy;

use super::super::rule::Loaded;
use super::super::{Failure, length, light, output, plot, svg};
use super::Arguments;
use crate::fractal::Goal;

/// Picture to be drawn, with its options.
pub(super) struct Pictured<'a> {
    pub(super) arguments: &'a Arguments,
    pub(super) loaded: &'a Loaded,
    pub(super) format: render::Format,
    pub(super) look: Option<&'a ZoomTarget>,
    pub(super) path: &'a Path,
}

impl Pictured<'_> {
    /// Draws to a goal. `most` replaces the limit on the number of elements.
    pub(super) fn draw(
        &self,
        goal: Goal,
        graph: Graph,
        most: Option<u64>,
        progress: Option<&Progress>,
        mut out: &mut dyn Write,
    ) -> Result<Wrote, RenderError> {
        let Self {
            arguments, loaded, ..
        } = self;
        let options = arguments.options(loaded, goal, self.format, graph.place());
        goal.reach(
            graph,
            |steps| loaded.graph(steps),
            |graph, steps| {
                let mut growth = arguments.growth.drawn_as(&options, steps, progress);
                growth.most_elements = most.unwrap_or(growth.most_elements);
                let written = match self.look {
                    None => render::write(graph, &growth, &options, &mut out),
                    Some(look) => {
                        let source = loaded.source();
                        render::write_zoomed(&source, graph, &growth, &options, look, &mut out)
                    }
                };
                written.map(Wrote::from)
            },
        )
    }

    /// Draws the light picture that comes nearest to a goal, and returns the goal that was reached.
    pub(super) fn draw_light(
        &self,
        goal: Goal,
        graph: Graph,
        progress: Option<&Progress>,
        out: &mut dyn Write,
    ) -> Result<(Wrote, Goal), Failure> {
        let Self {
            arguments, loaded, ..
        } = self;
        let explain = |error| arguments.growth.explain(error, loaded, self.path);
        let options = arguments.options(loaded, goal, self.format, graph.place());
        let is_part = self.look.is_some() || options.view.window.is_some();
        let color_by = options.style.color_by;
        let by_steps = matches!(color_by, ColorBy::Step | ColorBy::Age);
        let nearest = light::nearest(goal, &graph, is_part, by_steps, |goal| {
            let graph = loaded.compile_for(goal.steps(), color_by)?;
            let drafted = light::draft(|out| {
                let most = Some(light::MOST_ELEMENTS);
                let wrote = self.draw(goal, graph, most, None, out)?;
                let elements = wrote.elements;
                Ok((wrote, elements))
            });
            drafted.map_err(explain)
        })?;
        match nearest {
            Some((drawn, (wrote, draft))) => {
                out.write_all(&draft.bytes)
                    .map_err(|error| output::failed(error, self.path))?;
                Ok((wrote, drawn))
            }
            None => {
                let least = if self.look.is_some() {
                    goal
                } else {
                    Goal::Steps(0, None)
                };
                let graph = loaded.compile_for(least.steps(), color_by)?;
                let wrote = self.draw(least, graph, None, progress, out);
                Ok((wrote.map_err(explain)?, least))
            }
        }
    }
}

/// Size and contents of a file that has been written.
pub(super) struct Wrote {
    pub(super) steps: u32,
    pub(super) elements: u64,
    /// Whether the number of elements is a lower bound.
    pub(super) has_more: bool,
    pub(super) fractals: u64,
    pub(super) pixels: Option<[u32; 2]>,
    pub(super) plotted: Option<Plotted>,
    pub(super) instanced: Option<Instanced>,
    /// Whether the limit set is drawn instead of its elements.
    pub(super) is_limit: bool,
    /// Whether elements outside the window may be missing from the count.
    pub(super) is_part: bool,
    pub(super) empty: Option<Empty>,
}

impl From<render::Picture> for Wrote {
    fn from(picture: render::Picture) -> Self {
        Self {
            steps: picture.steps,
            elements: picture.elements,
            has_more: picture.has_more,
            fractals: picture.fractals,
            pixels: Some(picture.size),
            plotted: picture.plotted,
            instanced: picture.instanced,
            is_limit: picture.is_limit,
            is_part: picture.is_part,
            empty: picture.empty,
        }
    }
}

impl Wrote {
    pub(super) fn table(walked: Walked, steps: u32) -> Self {
        Self {
            steps,
            elements: walked.elements,
            has_more: false,
            fractals: walked.fractals,
            pixels: None,
            plotted: None,
            instanced: None,
            is_limit: false,
            is_part: false,
            empty: None,
        }
    }

    pub(super) fn summary(&self, unit: Unit) -> String {
        let mut summary = match &self.instanced {
            Some(instanced) => svg::described(instanced),
            None if self.is_limit => {
                let marks = readable::counted(&self.elements.into(), "mark");
                format!("its limit by {marks}")
            }
            None => readable::counted(&self.elements.into(), "element"),
        };
        if self.has_more {
            summary.insert_str(0, "more than ");
        }
        if self.is_part {
            summary.push_str(" visited");
        }
        if self.fractals > 1 && self.instanced.is_none() {
            summary.push_str(" in ");
            summary.push_str(&readable::counted(&self.fractals.into(), "fractal"));
        }
        if let Some(size) = self.pixels {
            summary.push_str(&format!(", {}", length::described(size, unit)));
        }
        if let Some(plotted) = &self.plotted {
            summary.push_str(&format!(", {}", plot::described(plotted)));
        }
        summary
    }
}
