//! Sheets of sets in space.

use std::time::Instant;

use anyhow::anyhow;

use crate::figure::sheet::{SpaceCell, write_in_space};
use crate::model::{self, DrawnInSpace};
use crate::render::{self, Format};
use crate::style::{Named, Style};

use super::super::labels::labels_of_rules;
use super::super::steps::{self, Several};
use super::super::{Failure, output, readable};
use super::contents::Contents;
use super::{Arguments, DrawnSheet};

impl Arguments {
    /// Draws every step of every individual from every direction.
    pub(super) fn draw_in_space(&self, contents: Contents, start: Instant) -> Result<(), Failure> {
        let first = contents.first();
        self.refuse_of_plane(&first.name)?;
        let individuals = &contents.individuals;
        let given = self.steps.as_ref().map(Several::largest);
        let mut counts = Vec::new();
        for individual in individuals {
            let graph = individual.loaded.in_space(given)?;
            let name = &individual.loaded.name;
            counts.push(graph.ok_or_else(|| anyhow!("{name} lies in the plane"))?);
        }
        let has_views = self.space.views(&first.model.space_view()).len() > 1;
        let mut styles: Vec<Style> = { contents.rules().into_iter() }
            .map(|loaded| self.picture.style(loaded.model.metadata()))
            .collect();
        let mut drawn: Vec<(usize, Option<u32>, DrawnInSpace)> = Vec::new();
        for (number, individual) in individuals.iter().enumerate() {
            let loaded = &individual.loaded;
            let steps: Vec<Option<u32>> = match &self.steps {
                Some(steps) => steps.as_slice().iter().copied().map(Some).collect(),
                None if individuals.len() > 1 || has_views => vec![loaded.model.metadata().steps],
                None => {
                    let last = steps::choose_in_space(None, loaded, &counts[number]);
                    (0..=last.min(steps::MAX_CELLS - 1)).map(Some).collect()
                }
            };
            let by = model::for_pixels(styles[individual.rule].color_by);
            for step in steps {
                drawn.push((number, step, loaded.drawn_in_space(step, by)?));
            }
        }
        for (number, _, own) in &drawn {
            own.colour(&mut styles[individuals[*number].rule]);
        }
        let mut cells = Vec::new();
        let mut most_views = 1;
        for (number, step, own) in &drawn {
            let individual = &individuals[*number];
            let views = self.space.views(&individual.loaded.model.space_view());
            most_views = views.len().max(most_views);
            let count = step.and_then(|step| counts[*number].check_size(step, u64::MAX).ok());
            let count = count.flatten().map_or_else(String::new, |count| {
                format!(": {}", readable::counted(&count.into(), "element"))
            });
            for (view, space) in &views {
                let step = step.map(|step| format!("step {step}"));
                let view = Some(view.clone()).filter(|_| views.len() > 1);
                let names = individual.names.iter().cloned().chain(step).chain(view);
                cells.push(SpaceCell {
                    caption: names.collect::<Vec<_>>().join(", ") + &count,
                    graph: &own.graph,
                    steps: own.steps,
                    space: space.clone(),
                    style: &styles[individual.rule],
                });
            }
        }
        // All individuals of a rule have the same steps.
        let of_first = drawn.iter().filter(|(number, ..)| *number == 0);
        let of_first: Vec<u32> = of_first.filter_map(|(_, step, _)| *step).collect();
        let is_common = self.further.is_empty() || self.steps.is_some();
        let steps = Several::new(of_first).filter(|_| is_common);
        let options = self.options_in_space(&contents, steps.as_ref(), &styles[0]);
        let columns = self.columns.or(contents.columns(most_views));
        let path = self.path("png");
        let (written, bytes) = output::write(&path, self.growth.quiet, |mut out, _| {
            write_in_space(&cells, columns, &options, None, &mut out)
                .map_err(|error| output::explain(error, &path))
        })?;
        let drawn = DrawnSheet {
            written,
            cells: cells.len(),
            step: steps.as_ref().map_or(0, Several::largest),
            path,
            bytes,
        };
        let count = readable::counted(&drawn.cells.into(), "picture");
        let names: Vec<_> = contents.rules().iter().map(|it| it.name.clone()).collect();
        self.report_drawn(&drawn, &format!("{count} of {}", names.join(", ")), start);
        Ok(())
    }

    fn options_in_space(
        &self,
        contents: &Contents,
        steps: Option<&Several>,
        style: &Style,
    ) -> render::Options {
        let first = contents.first();
        let mut options = contents.options(steps);
        options.extend(self.growth.options());
        options.extend(self.options_of_sheet());
        options.extend(self.space.options());
        render::Options {
            format: Format::Png,
            style: style.clone(),
            view: self.picture.view(first.model.metadata()),
            size: self.size,
            threads: self.growth.threads(),
            labels: labels_of_rules(&contents.rules(), "A sheet", "sheet", options),
            ..render::Options::default()
        }
    }

    /// Refuses formats and options that sets in space do not have.
    fn refuse_of_plane(&self, name: &str) -> Result<(), Failure> {
        let asked = self.format_of_pixels()?;
        if asked != Format::Png {
            let asked = asked.name();
            let message = format!("{name} lies in space, and is drawn as .png, not as .{asked}");
            return Err(Failure::Usage(message));
        }
        let of_plane = [
            ("--view", self.picture.has_view()),
            ("--fit", self.fit.is_some()),
            ("--detail", self.detail.is_some()),
        ];
        for (option, is_asked) in self.picture.of_lines().into_iter().chain(of_plane) {
            if is_asked {
                let message = format!("{name} lies in space, and {option} is for the plane");
                return Err(Failure::Usage(message));
            }
        }
        Ok(())
    }
}
