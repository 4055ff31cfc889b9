//! Sheets of sets in space.

use std::path::Path;
use std::time::Instant;

use anyhow::anyhow;

use crate::figure::sheet::{SpaceCell, write_in_space};
use crate::geometry::Frame3;
use crate::graph::Graph;
use crate::model::{self, DrawnInSpace};
use crate::render::{self, Format};
use crate::style::Named;

use super::super::labels::labels;
use super::super::rule::Member;
use super::super::{Failure, format, output, readable, steps};
use super::{Arguments, DrawnSheet, caption};

impl Arguments {
    /// Draws every step of every member of a family from every direction.
    pub(super) fn draw_in_space(&self, family: &[Member], start: Instant) -> Result<(), Failure> {
        let (_, first) = &family[0];
        self.refuse_of_plane(&first.name)?;
        let views = self.space.views(&first.model.space_view());
        let most = self.steps.as_ref().map(super::Several::largest);
        let graphs = family.iter().map(|(settings, loaded)| {
            let graph = loaded.in_space(most)?;
            let graph = graph.ok_or_else(|| anyhow!("{} lies in the plane", loaded.name))?;
            Ok((caption(settings), graph))
        });
        let graphs: Vec<(String, Graph<Frame3>)> = graphs.collect::<Result<_, Failure>>()?;
        let all: Vec<Option<u32>> = match &self.steps {
            Some(steps) => steps.as_slice().iter().copied().map(Some).collect(),
            None if graphs.len() > 1 || views.len() > 1 => vec![first.model.metadata().steps],
            None => {
                let last = steps::choose_in_space(None, first, &graphs[0].1);
                (0..=last.min(steps::MAX_CELLS - 1)).map(Some).collect()
            }
        };
        let mut options = self.options_in_space(family, &all);
        let by = model::for_pixels(options.style.color_by);
        let drawn = { family.iter() }
            .flat_map(|(_, loaded)| { all.iter() }.map(|step| loaded.drawn_in_space(*step, by)));
        let drawn: Vec<DrawnInSpace> = drawn.collect::<Result<_, Failure>>()?;
        let mut cells = Vec::new();
        for (number, (member, graph)) in graphs.iter().enumerate() {
            for (own, step) in drawn[number * all.len()..].iter().zip(&all) {
                let count = step.and_then(|step| graph.check_size(step, u64::MAX).ok());
                let count = count.flatten().map_or_else(String::new, |count| {
                    format!(": {}", readable::counted(&count.into(), "element"))
                });
                for (view, space) in &views {
                    let parts = [
                        Some(member.clone()).filter(|it| !it.is_empty()),
                        step.map(|step| format!("step {step}")),
                        Some(view.clone()).filter(|_| views.len() > 1),
                    ];
                    let name: Vec<String> = parts.into_iter().flatten().collect();
                    cells.push(SpaceCell {
                        caption: name.join(", ") + &count,
                        graph: &own.graph,
                        steps: own.steps,
                        space: space.clone(),
                    });
                }
            }
        }
        { drawn.iter() }.for_each(|drawn| drawn.colour(&mut options.style));
        let default = self.rule.file("-sheet", "png");
        let path = self.output.as_ref().unwrap_or(&default);
        let (written, bytes) = output::write(path, self.growth.quiet, |mut out, _| {
            write_in_space(&cells, self.columns, &options, None, &mut out)
                .map_err(|error| output::explain(error, path))
        })?;
        let drawn = DrawnSheet {
            written,
            cells: cells.len(),
            step: all.iter().flatten().copied().max().unwrap_or_default(),
            path: path.clone(),
            bytes,
        };
        let count = readable::counted(&drawn.cells.into(), "picture");
        self.report(&drawn, &format!("{count} of {}", first.name), start);
        Ok(())
    }

    fn options_in_space(&self, family: &[Member], all: &[Option<u32>]) -> render::Options {
        let (swept, first) = &family[0];
        let metadata = first.model.metadata();
        let swept = swept.iter().enumerate().map(|(number, setting)| {
            let values = family.iter().map(|(all, _)| all[number].value.to_string());
            let values: Vec<_> = values.collect();
            ("set", format!("{}={}", setting.name, values.join(",")))
        });
        let mut options: Vec<(&'static str, String)> = swept.collect();
        let steps: Vec<_> = all.iter().flatten().map(u32::to_string).collect();
        if !steps.is_empty() {
            options.push(("steps", steps.join(",")));
        }
        options.push(("size", self.size.to_string()));
        options.extend(self.columns.map(|columns| ("columns", columns.to_string())));
        options.extend(self.picture.options());
        options.extend(self.space.options());
        render::Options {
            format: Format::Png,
            style: self.picture.style(metadata),
            view: self.picture.view(metadata),
            size: self.size,
            threads: self.growth.threads(),
            labels: labels(first, "A sheet", "sheet", options),
            ..render::Options::default()
        }
    }

    /// Refuses formats and options that sets in space do not have.
    fn refuse_of_plane(&self, name: &str) -> Result<(), Failure> {
        let path = self.output.as_deref();
        let path = path.filter(|path| *path != Path::new("-"));
        let asked = match (self.format, path) {
            (None, None) => Format::Png,
            (asked, path) => format::choose(asked, path)?,
        };
        if asked != Format::Png {
            let asked = asked.name();
            let message = format!("{name} lies in space, and is drawn as .png, not as .{asked}");
            return Err(Failure::Usage(message));
        }
        let view = ("--view", self.picture.has_view());
        for (option, is_asked) in self.picture.of_lines().into_iter().chain([view]) {
            if is_asked {
                let message = format!("{name} lies in space, and {option} is for the plane");
                return Err(Failure::Usage(message));
            }
        }
        Ok(())
    }
}
