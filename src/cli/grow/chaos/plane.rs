//! Random iteration in the plane: pictures and tables of points.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use anyhow::anyhow;

use crate::chaos::{GameError, HistogramWindow, play};
use crate::export;
use crate::fractal::Goal;
use crate::geometry::DAffine2;
use crate::grow::Progress;
use crate::ifs::System;
use crate::model::Model;
use crate::render;
use crate::render::{
    Canvas, Density, RenderError, Shades, Size, density_canvas, write_density_with,
};
use crate::style::{ColorBy, Colour, Style};
use crate::symmetry::Symmetry;

use super::super::super::Failure;
use super::super::super::labels::labels;
use super::super::super::rule::Loaded;
use super::super::Arguments;
use super::super::tile::Tiled;
use super::Iteration;

/// Random iteration in the plane.
pub(in crate::cli::grow) struct PlaneGame<'a> {
    iteration: Iteration<'a, DAffine2>,
    /// System in the coordinates of the iteration.
    source: Arc<System>,
    /// Whether hits replace steps, for which the file has a palette.
    is_by_steps: bool,
    tiled: Option<Tiled>,
}

/// Returns the products of isometries with others that are applied before.
fn products(outer: &[DAffine2], inner: &[DAffine2]) -> Vec<DAffine2> {
    let both = outer
        .iter()
        .flat_map(|a| inner.iter().map(move |b| *a * *b));
    both.collect()
}

impl<'a> PlaneGame<'a> {
    /// Returns the game that the options request.
    pub(in crate::cli::grow) fn new(
        arguments: &'a Arguments,
        loaded: &'a Loaded,
    ) -> Result<Self, Failure> {
        let Model::Ifs(source) = &loaded.model else {
            return Err(Failure::Usage(format!(
                "--method chaos needs a system of maps (kind: ifs), and {} is of the kind {}; \
                 without --method it is grown step by step",
                loaded.name,
                loaded.model.kind().name()
            )));
        };
        let Arguments { chaos, picture, .. } = arguments;
        let place = loaded.place()?;
        let source = source
            .within(&place)
            .map_or_else(|| source.clone(), Arc::new);
        let start = chaos.start(|start| place.origin_of(start.place.truncate()));
        let mut iteration = Iteration::new(arguments, loaded, &source, place, start)?;
        let own = source
            .metadata()
            .symmetry
            .as_ref()
            .map(Symmetry::isometries);
        let tiled = arguments.tiled(loaded, Goal::Detail(1.0))?;
        let copies = tiled.as_ref().map(|tiled| {
            let copies = tiled.images.iter().map(|copy| place.within(copy));
            copies.collect::<Vec<_>>()
        });
        let images = match (copies, own) {
            (Some(copies), Some(own)) => products(&copies, &own),
            (copies, own) => copies.or(own).unwrap_or_default(),
        };
        iteration.system = iteration.system.with_images(images);
        if let Some(start) = chaos.start.iter().find(|start| !start.is_flat) {
            return Err(Failure::Usage(format!(
                "--start {start} lies in space, and {} in the plane: a point is X,Y",
                loaded.name
            )));
        }
        Ok(Self {
            is_by_steps: iteration.color_by == ColorBy::Hits
                && picture.asked_color_by().is_none()
                && !picture.asks_palette()
                && source.metadata().style.color_by == ColorBy::Step,
            iteration,
            source,
            tiled,
        })
    }

    /// Returns the canvas that shows the attractor and the ways to it, or the window.
    fn canvas(&self, size: Size) -> Result<Canvas, RenderError> {
        let Iteration { system, start, .. } = &self.iteration;
        let render::Options { view, .. } = self.picture_options(size);
        density_canvas(&self.source, system, start, &view, size)
    }

    /// Returns style and view of the picture.
    fn picture_options(&self, size: Size) -> render::Options {
        let Iteration {
            arguments, place, ..
        } = &self.iteration;
        let (picture, metadata) = (&arguments.picture, self.source.metadata());
        let mut view = arguments.view(metadata);
        view.window = self
            .tiled
            .as_ref()
            .map(|tiled| tiled.window)
            .or(view.window);
        let options = render::Options {
            format: render::Format::Png,
            style: picture.style(metadata),
            view: view.within(place),
            size,
            ..render::Options::default()
        };
        options.on_paper()
    }

    /// Plays the game, draws it and returns a summary.
    pub(in crate::cli::grow) fn draw(
        &self,
        progress: Option<&Progress>,
        out: &mut impl Write,
        path: &Path,
    ) -> Result<String, Failure> {
        let Iteration {
            arguments, system, ..
        } = &self.iteration;
        let Arguments { chaos, picture, .. } = arguments;
        let size = self
            .tiled
            .as_ref()
            .map_or(arguments.size.size, |tiled| tiled.size);
        let explain = |error: RenderError| self.iteration.explain(error, path);
        let canvas = self.canvas(size).map_err(explain)?;
        let held = self.iteration.arguments.growth.held.as_ref();
        if let Some(held) = held {
            held.note_window(&canvas, &self.iteration.place);
        }
        if held.is_some_and(|held| held.surveys) {
            return Ok(String::new());
        }
        let game = self.iteration.game(progress);
        let window = HistogramWindow {
            to_pixels: canvas.to_pixels(),
            size: canvas.size(),
        };
        let histogram = play(system, &window, &game).map_err(|error| {
            match error {
                error @ GameError::TooManyBins { .. } => anyhow!(
                    "{error}; use a smaller --size, or --method deterministic, which draws large pictures \
                     in bands"
                ),
                other => anyhow::Error::new(other),
            }
        })?;
        let render::Options { style, .. } = self.picture_options(size);
        let density = Density {
            tone: chaos.tone.unwrap_or_default(),
            shades: self.shades(&style, picture.ink(self.source.metadata())),
            background: style.ground(),
            png: arguments.growth.png_encoding(),
        };
        let described = self.iteration.described();
        let mut options = self.iteration.options();
        options.push(("format", "png".into()));
        options.push(("size", size.to_string()));
        options.extend(arguments.tile.options());
        options.extend(picture.options());
        let labels = labels(self.iteration.loaded, &described, "grow", options);
        let spares = arguments.growth.spares();
        write_density_with(&spares, &histogram, &density, &labels, out).map_err(explain)?;
        let inside = match histogram.inside() {
            inside if inside == game.points => String::new(),
            inside => format!(", {} inside", crate::readable::grouped(&inside.into())),
        };
        let [width, height] = canvas.size();
        Ok(format!(
            "{}, {described}{inside}, {width} x {height} pixels",
            self.iteration.loaded.name
        ))
    }

    /// Lists the points as a table and returns a summary.
    pub(in crate::cli::grow) fn list(
        &self,
        format: export::TableFormat,
        progress: Option<&Progress>,
        out: &mut dyn Write,
        path: &Path,
    ) -> Result<String, Failure> {
        self.iteration.list(format, progress, out, path)
    }

    /// Returns the colours of hits, maps or all points in a style.
    fn shades(&self, style: &Style, ink: Option<Colour>) -> Shades {
        let maps = self.source.ifs().maps().len();
        let classes = self.iteration.system.classes();
        match self.iteration.color_by {
            // A palette by steps begins with the largest elements, which are hit most.
            ColorBy::Hits if self.is_by_steps => Shades::Palette(style.palette.clone().reversed()),
            ColorBy::Hits => Shades::Palette(style.palette.clone()),
            ColorBy::FirstMap | ColorBy::LastMap => {
                // As in approximants, the palette begins with condensation sets, if there are any.
                let before = usize::from(classes > maps);
                let last = (maps + before).saturating_sub(1).max(1);
                let place = |class: usize| {
                    let number = if class < maps { class + before } else { 0 };
                    #[expect(clippy::cast_precision_loss, reason = "there are not so many maps")]
                    style.palette.at(number as f64 / last as f64)
                };
                Shades::Classes((0..classes).map(place).collect())
            }
            _ => Shades::Ink(ink.unwrap_or(Colour::BLACK)),
        }
    }
}
