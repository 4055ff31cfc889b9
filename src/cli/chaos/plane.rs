//! Random iteration in the plane: pictures and tables of points.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use anyhow::anyhow;

use crate::chaos::{GameError, Histogram, HistogramWindow, play};
use crate::export;
use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::grow::Progress;
use crate::ifs::System;
use crate::model::Model;
use crate::render;
use crate::render::{
    Canvas, Density, Pixels, RenderError, Shades, Size, density_canvas, density_pixels,
    write_density_with,
};
use crate::style::{ColorBy, Colour, Style, View};
use crate::symmetry::Symmetry;

use super::super::Failure;
use super::super::labels::labels;
use super::super::rule::Loaded;
use super::{DRAWN, GameArguments, RandomIteration};

/// Random iteration in the plane.
pub(in crate::cli) struct PlaneGame<'a> {
    iteration: RandomIteration<'a, DAffine2>,
    /// System in the coordinates of the iteration.
    source: Arc<System>,
    /// Whether hits replace steps, for which the file has a palette.
    is_by_steps: bool,
    view: View,
}

/// Returns the products of isometries with others that are applied before.
fn products(outer: &[DAffine2], inner: &[DAffine2]) -> Vec<DAffine2> {
    let both = outer
        .iter()
        .flat_map(|a| inner.iter().map(move |b| *a * *b));
    both.collect()
}

impl<'a> PlaneGame<'a> {
    /// Returns the game that the options request, in a view in the coordinates of the file. The picture shows the images of
    /// the set under isometries of the file's plane too, if there are any.
    pub(in crate::cli) fn new(
        arguments: GameArguments<'a>,
        loaded: &'a Loaded,
        view: View,
        images: Option<&[DAffine2]>,
    ) -> Result<Self, Failure> {
        let Model::Ifs(source) = &loaded.model else {
            return Err(Failure::Usage(format!(
                "--method chaos needs a system of maps (kind: ifs), and {} is of the kind {}; \
                 without --method it is grown step by step",
                loaded.name,
                loaded.model.kind().name()
            )));
        };
        let GameArguments { chaos, picture, .. } = arguments;
        let place = loaded.place()?;
        let source = source
            .within(&place)
            .map_or_else(|| source.clone(), Arc::new);
        let start = chaos.start(|start| place.origin_of(start.place.truncate()));
        let mut iteration = RandomIteration::new(arguments, loaded, &source, place, start)?;
        let own = source
            .metadata()
            .symmetry
            .as_ref()
            .map(Symmetry::isometries);
        let copies = images.map(|images| {
            let copies = images.iter().map(|copy| place.within(copy));
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
            view,
        })
    }

    /// Returns the canvas that shows the attractor and the ways to it, or the window.
    fn canvas(&self, size: Size) -> Result<Canvas, RenderError> {
        let RandomIteration { system, start, .. } = &self.iteration;
        let render::Options { view, .. } = self.picture_options(size);
        density_canvas(&self.source, system, start, &view, size)
    }

    /// Returns style and view of the picture.
    fn picture_options(&self, size: Size) -> render::Options {
        let RandomIteration {
            arguments, place, ..
        } = &self.iteration;
        let options = render::Options {
            format: render::Format::Png,
            style: arguments.picture.style(self.source.metadata()),
            view: self.view.within(place),
            size,
            ..render::Options::default()
        };
        options.on_paper()
    }

    /// Returns the number of bins across a pixel.
    fn oversample(&self) -> u32 {
        self.iteration.arguments.chaos.oversample.unwrap_or(1)
    }

    /// Returns the hits of the bins of a canvas.
    fn histogram(
        &self,
        canvas: &Canvas,
        progress: Option<&Progress>,
    ) -> Result<Histogram, Failure> {
        let game = self.iteration.game(progress);
        let side = self.oversample();
        let window = HistogramWindow {
            to_pixels: DAffine2::from_scale(DVec2::splat(side.into())) * canvas.to_pixels(),
            size: canvas.size().map(|length| length.saturating_mul(side)),
        };
        let histogram = play(&self.iteration.system, &window, &game).map_err(|error| {
            match error {
                error @ GameError::TooManyBins { .. } => anyhow!(
                    "{error}; use a smaller --size, or --method deterministic, which draws large pictures \
                     in bands"
                ),
                other => anyhow::Error::new(other),
            }
        })?;
        Ok(histogram)
    }

    /// Returns the appearance of a picture of a size.
    fn density(&self, size: Size) -> Density {
        let GameArguments {
            chaos,
            picture,
            growth,
            ..
        } = self.iteration.arguments;
        let render::Options { style, .. } = self.picture_options(size);
        Density {
            tone: chaos.tone.unwrap_or_default(),
            gamma: chaos.gamma(),
            oversample: self.oversample(),
            kernel: chaos.kernel.unwrap_or(0.0),
            shades: self.shades(&style, picture.ink(self.source.metadata())),
            background: style.ground(),
            png: growth.png_encoding(),
        }
    }

    /// Returns the game in another view, in the coordinates of the file.
    pub(in crate::cli) fn in_view(self, view: View) -> Self {
        Self { view, ..self }
    }

    /// Describes the points of the picture.
    pub(in crate::cli) fn described(&self) -> String {
        self.iteration.described()
    }

    /// Returns the options of the game, with their values.
    pub(in crate::cli) fn options(&self) -> Vec<(&'static str, String)> {
        self.iteration.options()
    }

    /// Returns the window of a picture of a size, in the coordinates of the file.
    pub(in crate::cli) fn window(&self, size: Size, path: &Path) -> Result<Bounds, Failure> {
        let canvas = self.canvas(size);
        let [x, y, width, height] = canvas
            .map_err(|error| self.iteration.explain(error, path))?
            .window();
        let low = DVec2::new(x, y);
        let place = |point| self.iteration.place.point(point);
        Ok(Bounds::new(
            place(low),
            place(low + DVec2::new(width, height)),
        ))
    }

    /// Plays the game and returns the pixels of a picture.
    pub(in crate::cli) fn pixels(
        &self,
        size: Size,
        progress: Option<&Progress>,
        path: &Path,
    ) -> Result<Pixels, Failure> {
        let explain = |error: RenderError| self.iteration.explain(error, path);
        let canvas = self.canvas(size).map_err(explain)?;
        let histogram = self.histogram(&canvas, progress)?;
        density_pixels(&histogram, &self.density(size)).map_err(explain)
    }

    /// Plays the game, draws it and returns a summary. `given` are the options of the picture that are given, beside those
    /// of all games.
    pub(in crate::cli) fn draw(
        &self,
        size: Size,
        given: Vec<(&'static str, String)>,
        progress: Option<&Progress>,
        out: &mut impl Write,
        path: &Path,
    ) -> Result<String, Failure> {
        let GameArguments {
            growth, picture, ..
        } = self.iteration.arguments;
        let explain = |error: RenderError| self.iteration.explain(error, path);
        let canvas = self.canvas(size).map_err(explain)?;
        let held = growth.held.as_ref();
        if let Some(held) = held {
            held.note_window(&canvas, &self.iteration.place);
        }
        let described = self.iteration.described();
        let mut options = self.iteration.options();
        options.push(("format", "png".into()));
        options.push(("size", size.to_string()));
        options.extend(given);
        options.extend(picture.options());
        let labels = labels(self.iteration.loaded, &described, "grow", options);
        if let Some((held, _)) = growth.survey() {
            held.done().provenance = Some(labels.provenance);
            return Ok(String::new());
        }
        let histogram = self.histogram(&canvas, progress)?;
        let density = self.density(size);
        write_density_with(&growth.spares(), &histogram, &density, &labels, out)
            .map_err(explain)?;
        let inside = match histogram.inside() {
            inside if inside == self.iteration.points(DRAWN) => String::new(),
            inside => format!(", {} inside", crate::readable::grouped(&inside.into())),
        };
        let [width, height] = canvas.size();
        Ok(format!(
            "{}, {described}{inside}, {width} x {height} pixels",
            self.iteration.loaded.name
        ))
    }

    /// Lists the points as a table and returns a summary.
    pub(in crate::cli) fn list(
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
