//! Wallpapers and friezes of a set: its copies in a window.

use std::ops::RangeInclusive;

use crate::extent::bounding_box;
use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::graph::{CompileError, Graph};
use crate::grow::Growth;
use crate::model::Model;
use crate::render::{Canvas, NoRoom, Options, Size};
use crate::style::{Named, View};
use crate::symmetry::{Tiling, TilingGroup, TooManyCopies};

use super::{Error, Fractal, Goal};

/// Repetition of a set of the plane under a wallpaper or frieze group.
///
/// The set keeps its size, and its box is inscribed in a fundamental domain of the group: see [`Tiling`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repetition {
    group: TilingGroup,
    cell: f64,
    periods: u32,
}

/// Reason why a set is not repeated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NoRepetition {
    /// The factor of the distance of copies is out of range.
    #[error("the distance of copies has a factor from {} to {}", Repetition::CELLS.start(), Repetition::CELLS.end())]
    Cell,
    /// The set has no box, or the picture no room.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// Too many copies meet the window.
    #[error(transparent)]
    TooManyCopies(#[from] TooManyCopies),
    /// The copies have too many elements to begin with.
    #[error(transparent)]
    TooLarge(#[from] CompileError),
}

/// Copies of a set in a picture.
#[derive(Clone, Debug)]
pub(crate) struct Copies {
    /// Window that the picture shows, and its size, where they are not given.
    pub(crate) window: [f64; 4],
    pub(crate) size: Size,
    /// Isometries of the copies, in the coordinates of the file.
    pub(crate) images: Vec<DAffine2>,
}

impl From<TilingGroup> for Repetition {
    fn from(group: TilingGroup) -> Self {
        Self {
            group,
            cell: 1.0,
            periods: 1,
        }
    }
}

impl Repetition {
    /// Range of factors of the distance of copies.
    pub const CELLS: RangeInclusive<f64> = 0.01..=1000.0;

    /// Sets the factor of the distance of copies, 1 by default; below 1 they may overlap. Pictures with one out of
    /// [range](Self::CELLS) are refused.
    #[must_use]
    pub fn cell(self, factor: f64) -> Self {
        Self {
            cell: factor,
            ..self
        }
    }

    /// Sets the number of periods that a picture without a window shows along both axes, 1 by default and at least. Pictures
    /// of more than 20,000 copies are refused.
    #[must_use]
    pub fn periods(self, count: u32) -> Self {
        Self {
            periods: count.max(1),
            ..self
        }
    }

    /// Returns the copies of a set that a picture of a view and a size shows. `graph` is that of the set, whose box is the one
    /// after a number of steps or, without it, that of the limit set. Random sets are drawn with `seed`. A picture of the
    /// default size without a window is one of the period, about as large, whose opposite edges continue each other.
    pub(crate) fn copies(
        &self,
        graph: &Graph,
        (steps, seed): (Option<u32>, u64),
        view: &View,
        size: Size,
    ) -> Result<Copies, NoRepetition> {
        if !Self::CELLS.contains(&self.cell) {
            return Err(NoRepetition::Cell);
        }
        let motif = match steps {
            Some(steps) => extent(graph, steps, seed),
            None => graph
                .limit_bounds()
                .or_else(|| extent(graph, DEEPEST, seed)),
        };
        let motif = motif.map(|motif| graph.place().bounds(&motif));
        let is_right = |motif: &Bounds| !motif.is_empty() && motif.is_finite();
        let motif = motif.filter(is_right).ok_or(NoRoom::Nothing)?;
        let tiling = Tiling::new(self.group, &motif, self.cell);
        let window = view.window;
        let size = match (size, window) {
            (size, None) if size == Size::default() => {
                let [width, height] = tiling.size();
                Size::Exactly(width, height)
            }
            (size, _) => size,
        };
        let window = window.unwrap_or_else(|| tiling.window(self.periods));
        let view = View {
            margin: view.margin.or(Some(0.0)),
            ..*view
        };
        let canvas = Canvas::of_window(window, &view, size)?;
        let [width, height] = canvas.size().map(f64::from);
        let back = canvas.to_pixels().inverse();
        let mut shown = Bounds::EMPTY;
        for corner in [DVec2::ZERO, DVec2::new(width, height)] {
            shown.add(back.transform_point2(corner));
        }
        let images = tiling.isometries(&shown)?;
        if !graph.has_room_for_images(images.len() as u64, Model::MAX_LISTED) {
            let group = self.group.name().into();
            let most = Model::MAX_LISTED;
            return Err(CompileError::TooManyImages { group, most }.into());
        }
        Ok(Copies {
            window,
            size,
            images,
        })
    }
}

impl Copies {
    /// Replaces what is grown by its copies.
    pub(crate) fn of(&self, graph: Graph) -> Graph {
        let place = *graph.place();
        let images: Vec<_> = { self.images.iter() }
            .map(|image| place.within(image))
            .collect();
        graph.with_images(&images)
    }

    /// Returns options of the picture that shows the copies.
    pub(super) fn shown(&self, options: Options) -> Options {
        Options {
            view: View {
                window: Some(self.window),
                ..options.view
            },
            size: self.size,
            ..options
        }
    }
}

impl Fractal {
    /// Returns the view of pictures. That of a file shows its set, and none of the copies, which have no margin around them.
    pub(super) fn shown(&self) -> View {
        if self.repeated().is_none() {
            return self.view.unwrap_or(self.model.metadata().view);
        }
        let view = self.view.unwrap_or_default();
        View {
            margin: view.margin.or(Some(0.0)),
            ..view
        }
    }

    /// Returns how pictures are repeated; a zoom draws no copies.
    fn repeated(&self) -> Option<Repetition> {
        self.repetition.filter(|_| self.zoom.is_none())
    }

    /// Returns the copies that a picture shows, if the set is repeated. `graph` is that of the set for the goal.
    pub(super) fn copies(
        &self,
        graph: &Graph,
        goal: Goal,
        options: &Options,
    ) -> Result<Option<Copies>, Error> {
        let Some(repetition) = self.repeated() else {
            return Ok(None);
        };
        let steps = match goal {
            Goal::Steps(steps, _) => Some(steps),
            Goal::Detail(_) => None,
        };
        let growth = (steps, self.seed);
        Ok(Some(repetition.copies(
            graph,
            growth,
            &options.view,
            options.size,
        )?))
    }
}

/// Number of steps after which a set without a box of its limit is measured.
const DEEPEST: u32 = 12;

/// Limit of the number of elements from which a box is found.
const MEASURED: u64 = 1_000_000;

/// Returns the box of an approximant or, if it has too many elements to be grown for it, of an earlier one.
fn extent(graph: &Graph, steps: u32, seed: u64) -> Option<Bounds> {
    let walked = || {
        (0..=steps).rev().find_map(|steps| {
            let growth = Growth {
                seed,
                max_elements: MEASURED,
                ..Growth::steps(steps)
            };
            graph.check_size(steps, MEASURED).ok()?;
            bounding_box(graph, &growth).ok()
        })
    };
    graph.bounds(steps).or_else(walked)
}
