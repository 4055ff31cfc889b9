//! Pictures, elements and numbers of a fractal.

use std::borrow::Cow;
use std::io::Write;
use std::num::NonZero;
use std::path::Path;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::export;
use crate::extent::{Bounded, bounding_box};
use crate::geometry::{Bounds, Frame};
use crate::graph::{CompileError, Forecast, Graph};
use crate::grow::{Element, Elements, Growth, WalkError};
use crate::measure::exact::dimensions_of_graph;
use crate::measure::{BoxCounting, Grid, LimitSet, Space};
use crate::model::Model;
use crate::output_file::{OutputFile, WriteError};
use crate::parallel::is_cancelled;
use crate::render::space::{pixels_in_space, write_space, write_visible};
use crate::render::{self, Format, Labels, Options, Picture, Pixels, RenderError, Size};
use crate::style::{ColorBy, Colour, Named};

use super::{Error, Fractal, Goal, proposed_steps};

impl Fractal {
    /// Returns the model: a rule, a system of maps, a structure or an L-system.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Returns the warnings about the file: what is valid, and probably not meant.
    #[must_use]
    pub fn warnings(&self) -> &Diagnostics {
        &self.warnings
    }

    /// Returns the approximant as SVG; in space, its visible faces and lines.
    ///
    /// # Errors
    ///
    /// If it cannot be drawn: it has too many elements, or none.
    pub fn svg(&self) -> Result<String, Error> {
        let options = self.options(Format::Svg, self.size)?;
        let mut bytes = Vec::new();
        self.draw(&options, &mut bytes)?;
        // SVG is written as text.
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Returns the approximant as the bytes of a PNG, on white paper unless the style has a background. `size` is the long
    /// side in pixels, or width and height.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let png = kfrac::Fractal::named("gasket")?.steps(6).png(300)?;
    /// assert!(png.starts_with(b"\x89PNG"));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If it cannot be drawn: it has too many elements, or none.
    pub fn png(&self, size: impl Into<Size>) -> Result<Vec<u8>, Error> {
        let options = self.options(Format::Png, size.into())?;
        let mut bytes = Vec::new();
        self.draw(&options, &mut bytes)?;
        Ok(bytes)
    }

    /// Returns the approximant as pixels in memory, transparent unless the style has a background. `size` is the long side
    /// in pixels, or width and height.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let pixels = kfrac::Fractal::named("koch")?.steps(6).pixels((600, 200))?;
    /// assert_eq!(pixels.size(), [600, 200]);
    /// assert_eq!(pixels.premultiplied().len(), 600 * 200 * 4);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If it cannot be drawn: it has too many elements, or none, or the picture is too large for memory.
    pub fn pixels(&self, size: impl Into<Size>) -> Result<Pixels, Error> {
        let options = self.pixel_options(size.into())?;
        if let Some(set) = self.graph_to_draw_in_space(&options)? {
            let cancel = self.cancel.as_deref();
            let space = self.space_options();
            let mut options = options;
            set.colour(&mut options.style);
            options.style.background.get_or_insert(Colour::TRANSPARENT);
            let drawn = pixels_in_space(&set.graph, set.steps, &options, &space, cancel);
            return Ok(drawn?.pixels);
        }
        self.draw_by(&options, |graph, growth, options| match &self.zoom {
            Some(target) => render::pixels_zoomed(&self.model, graph, growth, options, target),
            None => render::pixels(graph, growth, options),
        })
    }

    /// Writes a file: a picture (`svg`, `png`, `pdf`, `dxf`) or a table of elements (`csv`, `json`, `jsonl`,
    /// `ndjson`), by the extension of its name. An existing file is replaced, once the new one is complete. In
    /// space, `svg`, `pdf` and `dxf` hold the visible faces and edges of the approximant, and there are meshes (`stl`, `obj`,
    /// `ply`) and nested instances (`usda`, `glb`, `3mf`, `pov`).
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// # let folder = std::env::temp_dir().join(format!("kfrac-doc-{}", std::process::id()));
    /// # std::fs::create_dir_all(&folder).unwrap();
    /// let dragon = kfrac::Fractal::named("dragon")?.steps(10);
    /// dragon.write(folder.join("dragon.svg"))?;
    /// dragon.write(folder.join("dragon.csv"))?;
    /// # std::fs::remove_dir_all(&folder).unwrap();
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the format is unknown, the approximant cannot be drawn, or the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let extension = path.extension().and_then(|it| it.to_str()).unwrap_or("");
        let extension = extension.to_ascii_lowercase();
        if let Some(format) = Format::from_name(&extension) {
            let options = self.options(format, self.size)?;
            return written(path, |out| self.draw(&options, out).map(|_| ()));
        }
        if let Some(done) = self.write_in_space(path, &extension) {
            return done;
        }
        let format = export::TableFormat::from_name(&extension).ok_or_else(|| {
            let message = format!("'{}' has no format that is known", path.display());
            Diagnostic::error(message).hint(
                "names end in .svg, .png, .pdf, .dxf, .csv, .json, .jsonl or .ndjson, and in space in .stl, .obj, .ply, .usda, \
                 .glb, .3mf or .pov",
            )
        })?;
        if self.model.is_in_space() {
            let graph = self.graph_in_space("it has a table, too")?;
            return self.write_table(path, graph, self.steps_in_space(graph), format);
        }
        self.write_table(path, self.graph()?, self.steps_grown()?, format)
    }

    fn write_table<F: export::Listed>(
        &self,
        path: &Path,
        graph: &Graph<F>,
        steps: u32,
        format: export::TableFormat,
    ) -> Result<(), Error> {
        let growth = self.growth(steps);
        written(path, |out| {
            let walked = export::write(graph, &growth, format, self.threads, out);
            walked
                .map(|_| ())
                .map_err(|error| RenderError::from(error).into())
        })
    }

    /// Returns the elements of the approximant, one after another, infertile and invisible ones included. Memory is
    /// proportional to the number of steps.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let koch = kfrac::Fractal::named("koch")?.steps(3);
    /// let mut length = 0.0;
    /// for element in koch.elements()? {
    ///     length += element?.frame.length();
    /// }
    /// assert!((length - (4.0_f64 / 3.0).powi(3)).abs() < 1e-12);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the model cannot be compiled, or lies in space. Items are errors where there are more elements than allowed, or points
    /// that are not finite.
    pub fn elements(
        &self,
    ) -> Result<impl Iterator<Item = Result<Element, Error>> + use<'_>, Error> {
        self.check_cancelled()?;
        self.check_plane("`elements_in_space` returns its elements")?;
        let growth = self.growth(self.steps_grown()?);
        let elements = Elements::of(self.graph()?, &growth);
        Ok(elements.map(|item| item.map(|(_, element)| element).map_err(Error::from)))
    }

    /// Returns the sizes of the approximant as the graph determines them, without growing it; `None` if they depend on
    /// draws, or on the number of all elements before one. The forecast is at the approximant's step.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let koch = kfrac::Fractal::named("koch")?.steps(200);
    /// let elements = koch.forecast()?.expect("koch is regular").elements();
    /// assert_eq!(elements.digits(), 121);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the model cannot be compiled, or lies in space.
    pub fn forecast(&self) -> Result<Option<Forecast<'_>>, Error> {
        self.check_plane("`forecast_in_space` returns its sizes")?;
        Ok(forecast(self.graph()?, self.steps_grown()?))
    }

    /// Returns the box of the approximant in the file's units: from the graph, or else by growing it.
    ///
    /// # Errors
    ///
    /// If the model cannot be compiled, lies in space, or has to be grown and has more elements than allowed.
    pub fn bounds(&self) -> Result<Bounds, Error> {
        self.check_plane("`bounds_in_space` returns its box")?;
        self.bounds_of(self.graph()?, self.steps_grown()?)
    }

    /// Returns the dimension of the limit set, which does not depend on the number of steps: exact where that is decided,
    /// and otherwise measured by boxes, which takes seconds.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let dimension = kfrac::Fractal::named("koch")?.dimension()?;
    /// assert_eq!(dimension.closed_form.as_deref(), Some("log(4)/log(3)"));
    /// assert_eq!(dimension.std_error, None);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If there is no limit set, or none that can be measured.
    pub fn dimension(&self) -> Result<Dimension, Error> {
        const STEPS: u32 = 64;
        self.check_cancelled()?;
        let model = self.model.of_limit();
        if let Some(graph) = model.graph_in_space(STEPS) {
            let graph = graph.map_err(|error| self.model.diagnostic(&error))?;
            return self.dimension_of(&graph);
        }
        let graph = model.compile_normalised(STEPS, self.seed, self.max_elements);
        let graph = graph.map_err(|error| self.model.diagnostic(&error))?;
        self.dimension_of(&graph)
    }

    fn dimension_of<M: Space, F: Bounded<Map = M>>(
        &self,
        graph: &Graph<F>,
    ) -> Result<Dimension, Error> {
        let exact = dimensions_of_graph(graph).dimensions.map(|it| it.hausdorff);
        if let Some(exact) = exact
            && let Some(value) = exact.value
        {
            return Ok(Dimension {
                value,
                std_error: None,
                closed_form: exact.closed_form,
            });
        }
        self.check_cancelled()?;
        let none = |reason: String| Error::NoDimension(reason);
        let set = LimitSet::of(graph).map_err(|error| none(error.to_string()))?;
        let grids = Grid::spread(const { NonZero::new(8).expect("8 is not zero") });
        let counted = BoxCounting::of_limit(&set, None, &grids, self.threads).estimate;
        let estimate = counted.ok_or_else(|| none("too many of its copies overlap".into()))?;
        Ok(Dimension {
            value: estimate.value,
            std_error: Some(estimate.std_error),
            closed_form: None,
        })
    }
}

/// A dimension of a set.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Dimension {
    /// The Hausdorff dimension where it is exact; the box dimension where it is measured.
    pub value: f64,
    /// The standard error of a measured value; `None` for an exact one.
    pub std_error: Option<f64>,
    /// An equal expression, where one is known.
    pub closed_form: Option<String>,
}

impl Fractal {
    fn compile(&self, steps: u32) -> Result<Graph, CompileError> {
        self.drawn()
            .compile_normalised(steps, self.seed, self.max_elements)
    }

    /// Compiles a graph that has what colours distinguish.
    fn compile_for(&self, steps: u32, color_by: ColorBy) -> Result<Graph, Error> {
        let graph = self
            .drawn()
            .compile_coloured(color_by, || self.compile(steps));
        let graph = graph.map_err(|error| self.invalid(&error))?;
        let message = "it has too many maps and sets for colours by the map that is applied last";
        graph.ok_or_else(|| Diagnostic::error(message).into())
    }

    fn invalid(&self, error: &CompileError) -> Error {
        self.model.diagnostic(error).into()
    }

    /// Returns the model that is drawn.
    fn drawn(&self) -> Cow<'_, Model> {
        match self.steps.is_none() && self.detail.is_some() {
            true => self.model.of_detail(),
            false => Cow::Borrowed(&self.model),
        }
    }

    fn goal(&self) -> Result<Goal, Error> {
        if self.zoom.is_some() {
            return Ok(Goal::zoomed(self.steps, self.detail));
        }
        let compile = |steps| self.compile(steps);
        let goal = Goal::choose(&self.drawn(), self.steps, self.detail, compile);
        goal.map_err(|error| self.invalid(&error))
    }

    /// Returns the number of steps of elements and numbers, which have no pixels.
    pub(super) fn steps_grown(&self) -> Result<u32, Error> {
        let steps = match self.steps {
            Some(steps) => Ok(steps),
            None => proposed_steps(&self.model, |steps| self.compile(steps)),
        };
        steps.map_err(|error| self.invalid(&error))
    }

    /// Returns the graph in the file's coordinates.
    pub(super) fn graph(&self) -> Result<&Graph, Error> {
        if let Some(graph) = self.graph.get() {
            return Ok(graph);
        }
        let steps = self.steps_grown()?;
        let graph = self.model.compile_for(steps, self.seed, self.max_elements);
        let graph = graph.map_err(|error| self.invalid(&error))?;
        Ok(self.graph.get_or_init(|| graph))
    }

    /// Returns the box of approximant `steps` of a graph in the file's coordinates.
    pub(super) fn bounds_of<F: Bounded>(
        &self,
        graph: &Graph<F>,
        steps: u32,
    ) -> Result<Bounds<F::Point>, Error> {
        self.check_cancelled()?;
        match graph.bounds(steps) {
            Some(bounds) => Ok(bounds),
            None => Ok(bounding_box(graph, &self.growth(steps))?),
        }
    }

    pub(super) fn check_cancelled(&self) -> Result<(), Error> {
        if is_cancelled(self.cancel.as_deref()) {
            return Err(WalkError::Cancelled.into());
        }
        Ok(())
    }

    pub(super) fn growth(&self, steps: u32) -> Growth<'_> {
        Growth {
            seed: self.seed,
            max_elements: self.max_elements,
            cancel: self.cancel.as_deref(),
            ..Growth::steps(steps)
        }
    }

    pub(super) fn options(&self, format: Format, size: Size) -> Result<Options, Error> {
        let metadata = self.model.metadata();
        let description = &metadata.description;
        let style = self.style.as_ref().unwrap_or(&metadata.style).clone();
        // A zoom counts no elements.
        let counts = matches!(style.color_by, ColorBy::Index | ColorBy::Fractal);
        let style = match counts && self.zoom.is_some() {
            true => style.in_one_colour(),
            false => style,
        };
        Ok(Options {
            format,
            size,
            style,
            view: self.shown(),
            threads: self.threads,
            png: self.png_encoding,
            detail: match self.model.is_in_space() {
                true => self.detail_in_space(),
                false => self.goal()?.detail(),
            },
            labels: Labels {
                title: description.title.clone().unwrap_or_default(),
                description: description.about.clone().unwrap_or_default(),
                provenance: String::new(),
            },
            ..Options::default()
        }
        .on_paper())
    }

    /// Returns the options of pixels, which have no background but that of the style.
    pub(super) fn pixel_options(&self, size: Size) -> Result<Options, Error> {
        let style = self.style.as_ref().unwrap_or(&self.model.metadata().style);
        let mut options = self.options(Format::Png, size)?;
        options.style.background = style.background;
        Ok(options)
    }

    fn draw(&self, options: &Options, mut out: impl Write) -> Result<Picture, Error> {
        if let Some(set) = self.graph_to_draw_in_space(options)? {
            let mut options = options.clone();
            set.colour(&mut options.style);
            let options = &options;
            if options.format != Format::Png {
                let steps = { set.steps }.unwrap_or_else(|| self.steps_in_space(&set.graph));
                let growth = self.growth(steps);
                return Ok(write_visible(
                    &set.graph,
                    &growth,
                    options,
                    &self.space_options(),
                    &mut out,
                )?);
            }
            let cancel = self.cancel.as_deref();
            return Ok(write_space(
                &set.graph,
                set.steps,
                options,
                &self.space_options(),
                cancel,
                &mut out,
            )?);
        }
        self.draw_by(options, |graph, growth, options| match &self.zoom {
            Some(target) => {
                render::write_zoomed(&self.model, graph, growth, options, target, &mut out)
            }
            None => render::write(graph, growth, options, &mut out),
        })
    }

    /// Draws the approximant of the goal, and its copies if it is repeated. The window is that of the file's coordinates.
    pub(super) fn draw_by<T>(
        &self,
        options: &Options,
        mut draw: impl FnMut(&Graph, &Growth<'_>, &Options) -> Result<T, RenderError>,
    ) -> Result<T, Error> {
        self.check_cancelled()?;
        let goal = self.goal()?;
        let graph = self.compile_for(goal.steps(), options.style.color_by)?;
        let copies = self.copies(&graph, goal, options)?;
        let copied = |graph| { copies.iter() }.fold(graph, |graph, copies| copies.of(graph));
        let options = { copies.iter() }.fold(options.clone(), |all, copies| copies.shown(all));
        let compile = |steps| self.compile(steps).map(copied);
        let drawn = goal.reach(copied(graph), compile, |graph, steps| {
            let options = Options {
                style: options.style.clone().within(graph.place()),
                view: options.view.within(graph.place()),
                ..options.clone()
            };
            draw(graph, &self.growth(steps), &options)
        });
        drawn.map_err(|error| match error {
            RenderError::Walk(WalkError::NotFinite(error)) => self.invalid(&error),
            error => error.into(),
        })
    }
}

/// Returns the forecast of approximant `steps`.
pub(super) fn forecast<F: Frame>(graph: &Graph<F>, steps: u32) -> Option<Forecast<'_, F>> {
    let mut forecast = graph.forecast()?;
    let is_known = (0..steps).all(|_| forecast.advance());
    is_known.then_some(forecast)
}

/// Writes a file by `write`. If that fails, an existing file stays as it is.
pub(super) fn written(
    path: &Path,
    write: impl FnOnce(&mut OutputFile) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut out = OutputFile::create(path)?;
    write(&mut out).map_err(|error| match error {
        Error::Render(RenderError::Io(error)) => {
            let path = path.into();
            WriteError::Io { path, error }.into()
        }
        error => error,
    })?;
    Ok(out.finish()?)
}
