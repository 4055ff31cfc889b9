//! Pictures of elements: goal, options, notes and summary.

use std::io::Write;
use std::path::Path;

use crate::fractal::Goal;
use crate::geometry::Homothety;
use crate::graph::{Graph, Object};
use crate::grow::Progress;
use crate::model::Model;
use crate::render::{self, Canvas, Format, Labels, Picture, RenderError, Size, Unit};
use crate::style::{ColorBy, Named, Style};
use crate::zoom::check_model;

use super::super::labels::labels;
use super::super::length::Paper;
use super::super::rule::Loaded;
use super::super::{Failure, growth, length, light, output, readable};
use super::plan::ShownPart;
use super::{Arguments, plot, svg, zoom};
use crate::fractal::Copies;

/// Seconds that one core of 2026 takes to draw a pixel in a band, within a factor of about 3.
const SECONDS_A_PIXEL: f64 = 1.3e-8;

/// Picture of elements to be drawn.
pub(super) struct Drawing<'a> {
    pub(super) arguments: &'a Arguments,
    pub(super) loaded: Loaded,
    format: Format,
    shown: &'a ShownPart,
    pub(super) goal: Goal,
    pub(super) path: &'a Path,
    copies: Option<Copies>,
}

impl<'a> Drawing<'a> {
    /// Returns the picture of a rule; an error if there is nothing to zoom into, or it cannot be compiled.
    pub(super) fn new(
        arguments: &'a Arguments,
        loaded: Loaded,
        format: Format,
        shown: &'a ShownPart,
        path: &'a Path,
    ) -> Result<Self, Failure> {
        let loaded = loaded.grown(&arguments.growth);
        let (steps, detail) = (arguments.steps(), arguments.detail);
        let (loaded, goal) = match shown {
            ShownPart::Zoom(_) => {
                let loaded = match steps {
                    Some(_) => loaded,
                    None => loaded.led(Model::of_zoom),
                };
                check_model(&loaded.model).map_err(|error| output::explain(error.into(), path))?;
                // The zoom finds windows of any size in numbers of sufficient precision, in the coordinates
                // of the file.
                let loaded = loaded.within(Homothety::IDENTITY).turned(None);
                (loaded, Goal::zoomed(steps, detail))
            }
            ShownPart::Nested => {
                let goal = Goal::whole(steps, &loaded)?;
                (loaded, goal)
            }
            ShownPart::Window => {
                let loaded = match (steps, detail) {
                    (None, Some(_)) => loaded.led(Model::of_detail),
                    _ => loaded,
                };
                let goal = Goal::asked(steps, detail, &loaded)?;
                (loaded, goal)
            }
        };
        let copies = arguments.copies(&loaded, goal)?;
        let loaded = loaded.with_copies(copies.clone());
        Ok(Self {
            arguments,
            loaded,
            format,
            shown,
            goal,
            path,
            copies,
        })
    }

    /// Writes the picture; returns a summary and the number of bytes. If it `is_light`, it is the nearest one
    /// that browsers show at once.
    pub(super) fn write(&self, is_light: bool) -> Result<(String, u64), Failure> {
        let Self {
            arguments,
            loaded,
            goal,
            path,
            ..
        } = self;
        let graph = loaded.compile_for(goal.steps(), self.style().color_by)?;
        let options = self.options(*goal, graph.place());
        if let Goal::Steps(steps, None) = *goal
            && !is_light
            && options.view.window.is_none()
            && matches!(self.shown, ShownPart::Window)
        {
            (arguments.growth).check_picture(steps, &graph, loaded, &options)?;
        }
        let place = *graph.place();
        let surveys = matches!(self.shown, ShownPart::Window);
        if let Some((held, _)) = arguments.growth.survey().filter(|_| surveys) {
            held.done().estimate = growth::png_estimate(&graph, *goal, &options);
            let picture = self
                .surveyed(graph)
                .map_err(|error| arguments.growth.explain(error, loaded, path))?;
            held.note_picture(&picture, Some(&place));
            held.done().provenance = Some(options.labels.provenance);
            return Ok((summary(&picture, arguments.size.unit), 0));
        }
        self.note_beforehand(&graph, &options);
        let ((picture, drawn), bytes) = arguments.write_picture(path, |out, progress| {
            let explain = |error| arguments.growth.explain(error, loaded, path);
            if is_light {
                return self.draw_light(graph, progress, out);
            }
            let picture = self.draw(*goal, graph, None, progress, out);
            Ok((picture.map_err(explain)?, *goal))
        })?;
        let growth = &arguments.growth;
        let warning = picture.instanced.as_ref().and_then(svg::warning);
        let pens =
            { picture.plotted.as_ref() }.and_then(|plotted| arguments.plot.note_of_pens(plotted));
        let empty = { picture.empty.as_ref() }.map(|empty| zoom::nothing(&loaded.name, empty));
        let lighter = (drawn != *goal).then(|| goal.note_of_lighter(drawn));
        let each_pen = picture
            .plotted
            .as_ref()
            .map(plot::of_pens)
            .unwrap_or_default();
        let notes = [warning, pens].into_iter().flatten().chain(each_pen);
        for note in notes.chain([empty, lighter].into_iter().flatten()) {
            growth.note(&note);
        }
        if let Some(held) = &growth.held {
            held.note_picture(&picture, Some(&place));
        }
        let reached = drawn.reached(&loaded.name, picture.steps);
        let summary = summary(&picture, arguments.size.unit);
        Ok((format!("{reached}, {summary}"), bytes))
    }

    /// Draws to a goal. `most` replaces the limit on the number of elements.
    fn draw(
        &self,
        goal: Goal,
        graph: Graph,
        most: Option<u64>,
        progress: Option<&Progress>,
        mut out: &mut dyn Write,
    ) -> Result<Picture, RenderError> {
        let options = self.options(goal, graph.place());
        goal.reach(
            graph,
            |steps| self.loaded.graph(steps),
            |graph, steps| {
                let growth = &self.arguments.growth;
                let mut growth = growth.drawn_as(&options, steps, progress);
                growth.max_elements = most.unwrap_or(growth.max_elements);
                match &self.shown {
                    ShownPart::Zoom(target) => {
                        let model = &self.loaded.model;
                        render::write_zoomed(model, graph, &growth, &options, target, &mut out)
                    }
                    _ => render::write(graph, &growth, &options, &mut out),
                }
            },
        )
    }

    /// Returns the numbers of the picture without drawing it.
    fn surveyed(&self, graph: Graph) -> Result<Picture, RenderError> {
        let options = self.options(self.goal, graph.place());
        self.goal.reach(
            graph,
            |steps| self.loaded.graph(steps),
            |graph, steps| {
                let growth = self.arguments.growth.drawn_as(&options, steps, None);
                render::survey(graph, &growth, &options)
            },
        )
    }

    /// Draws the light picture that comes nearest to the goal, and returns the goal that was reached.
    fn draw_light(
        &self,
        graph: Graph,
        progress: Option<&Progress>,
        out: &mut dyn Write,
    ) -> Result<(Picture, Goal), Failure> {
        let explain = |error| (self.arguments.growth).explain(error, &self.loaded, self.path);
        let options = self.options(self.goal, graph.place());
        let is_zoomed = matches!(self.shown, ShownPart::Zoom(_));
        let is_part = is_zoomed || options.view.window.is_some();
        let color_by = options.style.color_by;
        let by_steps = matches!(color_by, ColorBy::Step | ColorBy::Age);
        let nearest = light::nearest(self.goal, &graph, is_part, by_steps, |goal| {
            let graph = self.loaded.compile_for(goal.steps(), color_by)?;
            let drafted = light::draft(|out| {
                let most = Some(light::MAX_ELEMENTS);
                let picture = self.draw(goal, graph, most, None, out)?;
                let elements = picture.elements;
                Ok((picture, elements))
            });
            drafted.map_err(explain)
        })?;
        if let Some((drawn, (picture, draft))) = nearest {
            out.write_all(&draft.bytes)
                .map_err(|error| output::failed(error, self.path))?;
            return Ok((picture, drawn));
        }
        let least = match is_zoomed {
            true => self.goal,
            false => Goal::Steps(0, None),
        };
        let graph = self.loaded.compile_for(least.steps(), color_by)?;
        let picture = self.draw(least, graph, None, progress, out);
        Ok((picture.map_err(explain)?, least))
    }

    /// Returns the style of the picture. A zoom counts no elements: a rule that colours by index or fractal
    /// is drawn in one colour, unless the command line asks for that `color_by`.
    pub(super) fn style(&self) -> Style {
        let style = self.full_style();
        match self.lacks_numbers(&style) {
            true => style.in_one_colour(),
            false => style,
        }
    }

    fn full_style(&self) -> Style {
        let Arguments { picture, size, .. } = self.arguments;
        let style = picture.style_in(self.loaded.model.metadata(), size.unit);
        match self.arguments.chaos.tone_of_elements() {
            Some(_) => Style {
                color_by: match picture.shows_hits_by_palette() || style.color_by == ColorBy::Hits {
                    true => ColorBy::Hits,
                    false => ColorBy::None,
                },
                ..style
            },
            None => style,
        }
    }

    /// Returns whether the file colours by index or fractal, which requires counting elements, and a zoom is
    /// drawn for which the command line does not ask for a `color_by`.
    fn lacks_numbers(&self, style: &Style) -> bool {
        matches!(style.color_by, ColorBy::Index | ColorBy::Fractal)
            && matches!(self.shown, ShownPart::Zoom(_))
            && self.arguments.picture.asked_color_by().is_none()
    }

    /// Prints notes about colours that are left out, the estimated time and size of a picture in bands, and
    /// options without effect.
    fn note_beforehand(&self, graph: &Graph, options: &render::Options) {
        if self.lacks_numbers(&self.full_style()) {
            self.arguments.growth.note(
                "note: drawn in one colour, because elements far from the window are not counted",
            );
        }
        if self.format == Format::Png && !options.plot {
            self.note_bands(graph, options);
        }
        let is_filled = |object: &Object| graph.base_elements()[object.base_element].is_closed();
        let mut drawn = graph.objects().iter().filter(|object| object.visible);
        let has_lines = options.plot
            || self.format.is_plot()
            || options.style.outlines_polygons()
            || drawn.any(|object| !is_filled(object));
        let mut asked = self.arguments.picture.of_lines().into_iter();
        if asked.any(|(_, is_asked)| is_asked) && !has_lines {
            self.arguments.growth.note(&format!(
                "note: {} is drawn as filled shapes, and --stroke-width, --cap and --join apply to lines \
                 only; --stroke and --fill together outline the shapes",
                self.loaded.name
            ));
        }
    }

    fn note_bands(&self, graph: &Graph, options: &render::Options) {
        let most = match options.size {
            Size::Long(side) => u64::from(side).pow(2),
            Size::Exactly(width, height) => u64::from(width) * u64::from(height),
        };
        if most <= options.in_one_piece {
            return;
        }
        let view = &options.view;
        let canvas = match view.window {
            Some(window) => Canvas::of_window(window, view, options.size).ok(),
            None => growth::Boxes::of(graph)
                .roughly_at(self.goal.steps())
                .and_then(|bounds| Canvas::fit(&bounds, options.size, view.pad()).ok()),
        };
        let Some([width, height]) = canvas.map(|canvas| canvas.size()) else {
            return;
        };
        if u64::from(width) * u64::from(height) > options.in_one_piece {
            let estimate = growth::png_estimate(graph, self.goal, options);
            let bytes = estimate.map_or_else(String::new, |estimate| {
                format!(", to about {}", readable::rough_bytes(estimate.png_bytes))
            });
            let pixels = f64::from(width) * f64::from(height);
            self.arguments.growth.note(&format!(
                "note: {width} x {height} pixels are drawn in bands, in about {}{bytes}",
                readable::duration(pixels * SECONDS_A_PIXEL)
            ));
        }
    }

    /// Returns the options of the picture, with the labels that describe it in its file. `place` maps the
    /// coordinates of the graph to those of the rule.
    pub(super) fn options(&self, goal: Goal, place: &Homothety) -> render::Options {
        let Arguments {
            growth,
            plot,
            svg,
            size,
            zoom,
            picture,
            ..
        } = self.arguments;
        let mut options = goal.options();
        options.extend(growth.options());
        if self.format != Format::Svg {
            options.push(("format", self.format.name().into()));
        }
        options.extend(plot.options());
        options.extend(svg.options());
        options.push(("size", size.to_string()));
        options.extend(zoom.options());
        options.extend(self.arguments.own_options());
        options.extend(picture.options());
        let tone = self.arguments.chaos.tone_of_elements();
        options.extend(self.arguments.chaos.tones());
        let Paper { mut size, unit } = *size;
        let mut view = self.arguments.view(self.loaded.model.metadata());
        if let Some(copies) = &self.copies {
            (view.window, size) = (Some(copies.window), copies.size);
        }
        render::Options {
            format: self.format,
            style: self.style().within(place),
            view: view.within(place),
            size,
            unit,
            plot: plot.is_asked(),
            pens: plot.pens(picture),
            occlude: plot.occludes(),
            hatch: plot.hatch(unit),
            tone,
            gamma: self.arguments.chaos.gamma(),
            machine: plot.machine(),
            instanced: matches!(self.shown, ShownPart::Nested),
            threads: growth.threads(),
            drawn: self.arguments.drawn.unwrap_or(1.0),
            png: growth.png_encoding(),
            spares: growth.spares(),
            detail: goal.detail_in(unit),
            // Pixels without an encoding have no labels.
            labels: match growth.png_encoding().raw {
                true => Labels::default(),
                false => labels(&self.loaded, &goal.described(), "grow", options),
            },
            ..render::Options::default()
        }
        .on_paper()
    }
}

/// Describes the contents and the size of a picture.
fn summary(picture: &Picture, unit: Unit) -> String {
    let mut summary = match &picture.instanced {
        Some(instanced) => svg::described(instanced),
        None if picture.is_limit => {
            let marks = readable::counted(&picture.elements.into(), "mark");
            format!("its limit by {marks}")
        }
        None => readable::counted(&picture.elements.into(), "element"),
    };
    if picture.is_part {
        summary.push_str(" visited");
    }
    if picture.instanced.is_none() {
        summary.push_str(&fractals(picture.fractals));
    }
    summary.push_str(&format!(", {}", length::described(picture.size, unit)));
    if let Some(plotted) = &picture.plotted {
        summary.push_str(&format!(", {}", plot::described(plotted)));
    }
    summary
}

/// Describes the number of fractals that elements belong to, if there are several.
pub(super) fn fractals(count: u64) -> String {
    match count {
        0 | 1 => String::new(),
        _ => format!(" in {}", readable::counted(&count.into(), "fractal")),
    }
}
