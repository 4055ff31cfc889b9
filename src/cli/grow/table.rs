//! Elements listed as tables.

use std::path::Path;

use crate::export;
use crate::fractal::Goal;
use crate::graph::Graph;
use crate::render::RenderError;

use super::super::rule::Loaded;
use super::super::{Failure, readable};
use super::{Arguments, drawing};

impl Arguments {
    /// Lists the elements of a step; returns a summary and the number of bytes.
    pub(super) fn list(
        &self,
        loaded: Loaded,
        format: export::TableFormat,
        path: &Path,
    ) -> Result<(String, u64), Failure> {
        let goal = Goal::asked(self.steps(), None, &loaded)?;
        let steps = goal.steps();
        let color_by = self.picture.style(loaded.model.metadata()).color_by;
        let copies = self.copies(&loaded, goal)?;
        let loaded = &loaded.with_copies(copies);
        let graph = loaded.compile_for(steps, color_by)?;
        if let Goal::Steps(..) = goal {
            self.growth.check(steps, &graph, loaded)?;
        }
        let (listed, bytes) = self.list_step(&graph, steps, loaded, format, path)?;
        let step = goal.reached(&loaded.name, steps);
        Ok((format!("{step}, {listed}"), bytes))
    }

    /// Lists the elements of a step of a graph; returns a summary and the number of bytes.
    pub(super) fn list_step<F: export::Listed>(
        &self,
        graph: &Graph<F>,
        steps: u32,
        loaded: &Loaded,
        format: export::TableFormat,
        path: &Path,
    ) -> Result<(String, u64), Failure> {
        let (walked, bytes) = self.growth.write(path, |out, progress| {
            let growth = self.growth.to(steps, progress);
            export::write(graph, &growth, format, self.growth.threads(), out)
                .map_err(|error| self.growth.explain(RenderError::from(error), loaded, path))
        })?;
        let elements = readable::counted(&walked.elements.into(), "element");
        let fractals = drawing::fractals(walked.fractals);
        Ok((format!("{elements}{fractals}"), bytes))
    }
}
