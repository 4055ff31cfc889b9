//! Random iteration of a fractal that is a system of maps.

use std::sync::Arc;

use crate::chaos::{Game, Histogram, HistogramWindow, Start, WeightedMaps, play};
use crate::diagnostic::Diagnostic;
use crate::graph::CompileError;
use crate::model::Model;
use crate::render::{Size, density_canvas};
use crate::style::View;
use crate::symmetry::Symmetry;

use super::{Error, Fractal};

impl Fractal {
    /// Returns the number of hits of every pixel by the points of random iteration. `size` is the long side in pixels, or
    /// width and height. The pixels cover the [`view`](Self::view) that is set, or the window of the file, or else the box of
    /// the attractor without a margin.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let fern = kfrac::Fractal::named("barnsley-fern")?.histogram(100_000, 200)?;
    /// assert_eq!(fern.inside(), 100_000);
    /// assert_eq!(fern.size().into_iter().max(), Some(200));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If it is no system of maps of the plane, if points cannot be drawn from it at random, or if the histogram is too
    /// large for memory.
    pub fn histogram(&self, points: u64, size: impl Into<Size>) -> Result<Histogram, Error> {
        self.check_plane("random iteration counts points in the pixels of the plane")?;
        self.check_cancelled()?;
        let Model::Ifs(source) = &self.model else {
            let message = format!(
                "random iteration is for systems of maps, and this is {}",
                self.model.kind().noun()
            );
            let hint = "`pixels` draws fractals of all kinds";
            return Err(Diagnostic::error(message).hint(hint).into());
        };
        let place = self.model.place();
        let place = place.map_err(|error| self.model.diagnostic(&CompileError::from(error)))?;
        let source = source
            .within(&place)
            .map_or_else(|| Arc::clone(source), Arc::new);
        let system = WeightedMaps::of(source.ifs())?;
        let images = source.metadata().symmetry.iter().map(Symmetry::isometries);
        let system = system.with_images(images.flatten().collect());
        let own = View {
            margin: Some(0.0),
            ..source.metadata().view
        };
        let view = self.view.unwrap_or(own).within(&place);
        let canvas = density_canvas(&source, &system, &Start::Attractor, &view, size.into())?;
        let window = HistogramWindow {
            to_pixels: canvas.to_pixels(),
            size: canvas.size(),
        };
        let game = Game {
            points,
            seed: self.seed,
            threads: self.threads,
            cancel: self.cancel.as_deref(),
            ..Game::default()
        };
        Ok(play(&system, &window, &game)?)
    }
}
