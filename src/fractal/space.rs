//! Results of a fractal in space.

use crate::geometry::{Bounds, DVec3, Frame3};
use crate::graph::{Forecast, Graph};
use crate::grow::{Element, Elements};
use crate::model::{DrawnError, DrawnInSpace, Model, for_pixels};
use crate::render::space::{DepthMap, Shade, SpaceOptions, pixels_in_space};
use crate::render::{Detail, Format, NoRoom, Options, RenderError, Size};

use super::goal::steps_of_graph;
use super::results::forecast;
use super::{Error, Fractal};

impl Fractal {
    /// Returns the box of the approximant of a set in space, in the file's units. x points to the right, y up and z
    /// towards the viewer.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let sponge = kfrac::Fractal::named("menger")?.steps(4);
    /// assert!(sponge.model().is_in_space());
    /// assert_eq!(sponge.bounds_in_space()?.max().to_array(), [1.0, 1.0, 1.0]);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If it lies in the plane, or its maps do not contract and it has more elements than allowed.
    pub fn bounds_in_space(&self) -> Result<Bounds<DVec3>, Error> {
        let graph = self.graph_in_space("`bounds` returns its box")?;
        self.bounds_of(graph, self.steps_in_space(graph))
    }

    /// Returns the sizes of the approximant of a set in space, as [`forecast`](Self::forecast) does in the plane.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let sponge = kfrac::Fractal::named("menger")?.steps(30);
    /// let cubes = sponge.forecast_in_space()?.expect("menger is regular").elements();
    /// assert_eq!(cubes.digits(), 40);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If it lies in the plane.
    pub fn forecast_in_space(&self) -> Result<Option<Forecast<'_, Frame3>>, Error> {
        let graph = self.graph_in_space("`forecast` returns its sizes")?;
        Ok(forecast(graph, self.steps_in_space(graph)))
    }

    /// Returns the elements of the approximant of a set in space, as [`elements`](Self::elements) does in the plane.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let sponge = kfrac::Fractal::named("menger")?.steps(2);
    /// let mut volume = 0.0;
    /// for element in sponge.elements_in_space()? {
    ///     volume += element?.frame.map().matrix3.determinant();
    /// }
    /// assert!((volume - (20.0_f64 / 27.0).powi(2)).abs() < 1e-12);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If it lies in the plane. Items are errors where there are more elements than allowed.
    pub fn elements_in_space(
        &self,
    ) -> Result<impl Iterator<Item = Result<Element<Frame3>, Error>> + use<'_>, Error> {
        self.check_cancelled()?;
        let graph = self.graph_in_space("`elements` returns its elements")?;
        let elements = Elements::of(graph, &self.growth(self.steps_in_space(graph)));
        Ok(elements.map(|item| item.map(|(_, element)| element).map_err(Error::from)))
    }

    /// Returns the depths of the pixels of [`png`](Self::png) for a set in space. `size` is the long side in pixels, or
    /// width and height.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let depths = kfrac::Fractal::named("menger")?.steps(3).depth_map((64, 48))?;
    /// assert_eq!(depths.size(), [64, 48]);
    /// assert_eq!(depths.depth([0, 0]), None);
    /// assert!(depths.depth([32, 24]).is_some_and(|depth| depth < 0.5));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If it lies in the plane, or cannot be drawn.
    pub fn depth_map(&self, size: impl Into<Size>) -> Result<DepthMap, Error> {
        let set = self.drawn_in_space("all of its points have the same depth")?;
        let options = self.options(Format::Png, size.into())?;
        let space = self
            .space_options()
            .shade(Some(Shade::None))
            .occlusion(false);
        let drawn = pixels_in_space(
            &set.graph,
            set.steps,
            &options,
            &space.keeps_depths(true),
            self.cancel.as_deref(),
        )?;
        let depths = drawn.depths.ok_or(RenderError::from(NoRoom::Nothing));
        Ok(depths?)
    }

    /// Refuses a set in space; `instead` states what it has.
    pub(super) fn check_plane(&self, instead: &'static str) -> Result<(), Error> {
        match self.model.is_in_space() {
            true => Err(Error::InSpace(instead)),
            false => Ok(()),
        }
    }

    /// Returns the graph of a set in space; `instead` states what a set of the plane has.
    pub(super) fn graph_in_space(&self, instead: &'static str) -> Result<&Graph<Frame3>, Error> {
        if let Some(graph) = self.graph_in_space.get() {
            return Ok(graph);
        }
        let steps = self.resolved_steps_in_space();
        let graph = { &self.model }.graph_in_space_for(steps, self.seed, self.max_elements);
        let graph = graph.ok_or(Error::InPlane(instead))?;
        let graph = graph.map_err(|error| self.model.diagnostic(&error))?;
        Ok(self.graph_in_space.get_or_init(|| graph))
    }

    /// Returns the number of steps for which graphs in space are resolved.
    fn resolved_steps_in_space(&self) -> u32 {
        self.model.resolved_steps_in_space(self.steps)
    }

    /// Returns the graph of a set in space as it is drawn; `instead` states what a set of the plane has.
    pub(super) fn drawn_in_space(&self, instead: &'static str) -> Result<&DrawnInSpace, Error> {
        if let Some(drawn) = self.drawn_in_space.get() {
            return Ok(drawn);
        }
        let growth = self.growth(self.resolved_steps_in_space());
        let steps = self.steps_drawn_in_space();
        let style = { self.style.as_ref() }.unwrap_or(&self.model.metadata().style);
        let by = for_pixels(style.color_by);
        let drawn = self.model.drawn_in_space(steps, &growth, by);
        let drawn = drawn.ok_or(Error::InPlane(instead))?;
        let drawn = drawn.map_err(|error| Self::not_drawn(&self.model, error))?;
        Ok(self.drawn_in_space.get_or_init(|| drawn))
    }

    pub(super) fn not_drawn(model: &Model, error: DrawnError) -> Error {
        match error {
            DrawnError::Compile(error) => model.diagnostic(&error).into(),
            DrawnError::Walk(error) => error.into(),
        }
    }

    /// Returns the graph of a set in space for a picture, and `None` for a set of the plane.
    pub(super) fn graph_to_draw_in_space(
        &self,
        options: &Options,
    ) -> Result<Option<&DrawnInSpace>, Error> {
        if !self.model.is_in_space() {
            return Ok(None);
        }
        self.check_cancelled()?;
        if options.view.window.is_some() {
            return Err(Error::InSpace(
                "its camera has a point to look at, and no window",
            ));
        }
        if self.zoom.is_some() {
            return Err(Error::InSpace(
                "its camera has a zoom, and no address to look at",
            ));
        }
        if self.repetition.is_some() {
            return Err(Error::InSpace("wallpapers and friezes lie in the plane"));
        }
        self.drawn_in_space("it has windows").map(Some)
    }

    /// Returns the number of steps of elements and numbers, which have no pixels.
    pub(super) fn steps_in_space(&self, graph: &Graph<Frame3>) -> u32 {
        self.steps
            .unwrap_or_else(|| steps_of_graph(&self.model, graph))
    }

    /// Returns the number of steps of a picture; `None` for the limit set.
    pub(super) fn steps_drawn_in_space(&self) -> Option<u32> {
        { &self.model }.drawn_steps_in_space(self.steps, self.detail.is_some())
    }

    /// Returns the options of pictures in space: those of the file, unless others are set.
    pub(super) fn space_options(&self) -> SpaceOptions {
        let own = || SpaceOptions::from(&self.model.space_view());
        self.space.clone().unwrap_or_else(own)
    }

    pub(super) fn detail_in_space(&self) -> Option<Detail> {
        self.detail.map(|pixels| Detail {
            pixels,
            decides_steps: self.steps_drawn_in_space().is_none(),
        })
    }
}
