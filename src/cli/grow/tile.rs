//! `kfrac grow --tile`: wallpapers and friezes of a picture.

use crate::extent::bounding_box;
use crate::fractal::Goal;
use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::graph::{CompileError, Graph};
use crate::grow::Growth;
use crate::model::Model;
use crate::render::{Canvas, NoRoom, Size};
use crate::style::{Named, View};
use crate::symmetry::{Tiling, TilingGroup};

use super::super::rule::Loaded;
use super::super::{Failure, number, picture};
use super::Arguments;

/// Options of tilings.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Tiling")]
pub(super) struct TileArguments {
    /// Wallpaper or frieze group under which the picture is repeated without end
    ///
    /// The set keeps its size, and its box is inscribed in a fundamental domain of the group: boxes of copies touch and do
    /// not overlap. Without --size and --view, the picture is one period of about 1024 pixels, whose opposite edges
    /// continue each other.
    #[arg(long, value_name = "GROUP", value_parser = picture::named::<TilingGroup>())]
    tile: Option<TilingGroup>,
    /// With --tile: factor of the distance of copies; below 1 they may overlap [default: 1]
    #[arg(long, value_name = "FACTOR", value_parser = factor, requires = "tile")]
    cell: Option<f64>,
    /// With --tile: number of periods that the picture shows along both axes [default: 1]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of periods", 1..=100_u32), requires = "tile")]
    repeat: Option<u32>,
}

/// Parses the factor of a cell.
fn factor(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok();
    let factor = factor.filter(|factor: &f64| (0.01..=1000.0).contains(factor));
    factor.ok_or_else(|| "expected a factor from 0.01 to 1000".into())
}

/// Copies of a set in a window.
#[derive(Clone, Debug)]
pub(super) struct Tiled {
    /// Window that the picture shows, and its size, where they are not given.
    pub(super) window: [f64; 4],
    pub(super) size: Size,
    /// Isometries of the copies, in the coordinates of the file.
    pub(super) images: Vec<DAffine2>,
}

impl TileArguments {
    /// Returns whether a tiling is requested.
    pub(super) fn is_asked(&self) -> bool {
        self.tile.is_some()
    }

    /// Refuses a tiling of a set in space.
    pub(super) fn refuse_in_space(&self, loaded: &Loaded) -> Result<(), Failure> {
        match self.tile {
            Some(_) => Err(Failure::Usage(format!(
                "--tile repeats sets of the plane, and {} lies in space",
                loaded.name
            ))),
            None => Ok(()),
        }
    }

    /// Returns the options that are given, with their values.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let tile = self.tile.map(|group| ("tile", group.name().to_owned()));
        let cell = self.cell.map(|factor| ("cell", factor.to_string()));
        let repeat = self.repeat.map(|count| ("repeat", count.to_string()));
        tile.into_iter().chain(cell).chain(repeat).collect()
    }

    /// Returns the copies of a set that a picture of a view and a size shows; `None` if no tiling is requested. `graph` is
    /// that of the set, whose box is the one after a number of steps or, without it, that of the limit set. Random sets are
    /// drawn with `seed`.
    pub(super) fn tiled(
        &self,
        graph: &Graph,
        (steps, seed): (Option<u32>, u64),
        view: &View,
        size: Size,
    ) -> Result<Option<Tiled>, Failure> {
        let Some(group) = self.tile else {
            return Ok(None);
        };
        let motif = match steps {
            Some(steps) => extent(graph, steps, seed),
            None => graph
                .limit_bounds()
                .or_else(|| extent(graph, DEEPEST, seed)),
        };
        let motif = motif.map(|motif| graph.place().bounds(&motif));
        let is_right = |motif: &Bounds| !motif.is_empty() && motif.is_finite();
        let Some(motif) = motif.filter(is_right) else {
            return Err(explained(NoRoom::Nothing));
        };
        let tiling = Tiling::new(group, &motif, self.cell.unwrap_or(1.0));
        let window = view.window;
        let size = match (size, window) {
            (size, None) if size == Size::default() => {
                let [width, height] = tiling.size();
                Size::Exactly(width, height)
            }
            (size, _) => size,
        };
        let window = window.unwrap_or_else(|| tiling.window(self.repeat.unwrap_or(1)));
        let view = View {
            margin: view.margin.or(Some(0.0)),
            ..*view
        };
        let canvas = Canvas::of_window(window, &view, size).map_err(explained)?;
        let [width, height] = canvas.size().map(f64::from);
        let back = canvas.to_pixels().inverse();
        let mut shown = Bounds::EMPTY;
        for corner in [DVec2::ZERO, DVec2::new(width, height)] {
            shown.add(back.transform_point2(corner));
        }
        let images = tiling.isometries(&shown).map_err(anyhow::Error::new)?;
        if !graph.has_room_for_images(images.len() as u64, Model::MAX_LISTED) {
            return Err(anyhow::Error::new(CompileError::TooManyImages {
                group: group.name().into(),
                most: Model::MAX_LISTED,
            })
            .into());
        }
        Ok(Some(Tiled {
            window,
            size,
            images,
        }))
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

fn explained(error: NoRoom) -> Failure {
    anyhow::Error::new(error).into()
}

impl Arguments {
    /// Returns the copies of a set in the picture, if they are asked for.
    pub(super) fn tiled(&self, loaded: &Loaded, goal: Goal) -> Result<Option<Tiled>, Failure> {
        if !self.tile.is_asked() {
            return Ok(None);
        }
        let steps = match goal {
            Goal::Steps(steps, _) => Some(steps),
            Goal::Detail(_) => None,
        };
        let graph = loaded.compile(goal.steps())?;
        let view = self.view(loaded.model.metadata());
        let growth = (steps, self.growth.seed.first());
        self.tile.tiled(&graph, growth, &view, self.size.size)
    }
}
