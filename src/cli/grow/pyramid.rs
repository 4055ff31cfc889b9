//! `kfrac grow --tiles`: a picture as a pyramid of tiles, in the Deep Zoom format.
//!
//! A tile is a window of the whole picture of its level, and a pure function of its place: tiles can be drawn by any thread,
//! process or machine, in any order. Lines have the width that they have in a picture of the size of the level.

mod folder;
mod levels;
mod page;
mod work;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicU64;

use anyhow::anyhow;
use clap::ValueHint;

use crate::fractal::Goal;
use crate::graph::Graph;
use crate::render::{self, Canvas, Format, Picture, RenderError, Size};
use crate::style::{ColorBy, Named, View};

use super::super::rule::{Loaded, name_of};
use super::super::shard::Shard;
use super::super::steps::Several;
use super::super::{Failure, number, output, readable};
use super::Arguments;
use super::drawing::Drawing;
use super::plan::ShownPart;

use folder::TileFolder;
use levels::{Pyramid, Tile};
use work::Work;

/// Default side of a tile in pixels.
const SIDE: u32 = 256;

/// Default limit of the number of tiles.
const MAX_TILES: u64 = 1_000_000;

/// Long side in pixels of the picture that is surveyed for the frame of a larger one that is grown to a detail. Its margin
/// has room for the difference.
const MOST_SURVEYED: u32 = 2048;

/// Options of pyramids of tiles.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Tiles")]
pub(super) struct PyramidArguments {
    /// Folder for tiles of a picture at all scales, for viewers of Deep Zoom, in place of a single file
    ///
    /// --size is the size of the deepest level. DIR gets NAME.dzi, the tiles NAME_files/LEVEL/COLUMN_ROW.png, and index.html, a
    /// page that shows them. Tiles that show nothing are not written. With --detail each level is grown to its own scale. The
    /// tiles appear under their name when all are complete; work that was interrupted goes on where it ended.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    tiles: Option<PathBuf>,
    /// Side of a tile in pixels [default: 256]
    #[arg(long, value_name = "PX", value_parser = number::whole("a number of pixels", 64..=4096_u32), requires = "tiles")]
    tile_size: Option<u32>,
    /// Number of pixels by which tiles reach into their neighbours, 0 or 1 [default: 0]
    #[arg(long, value_name = "PX", value_parser = number::whole("a number of pixels", 0..=1_u32), requires = "tiles")]
    overlap: Option<u32>,
    /// Levels to draw, such as 0..12; the others are drawn by other runs
    #[arg(long, value_name = "LEVELS", value_parser = number::several("a level", 0..=31_u32), requires = "tiles")]
    level: Option<Several>,
    /// Part of the tiles to draw, such as 3/64: the third of 64 parts
    ///
    /// Parts fill one folder, at once or one after another; the one that ends last completes it.
    #[arg(long, value_name = "K/N", value_parser = Shard::parse, requires = "tiles")]
    shard: Option<Shard>,
    /// Limit of the number of tiles of a run [default: 1,000,000]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of tiles", 1..=1_000_000_000_u64), requires = "tiles")]
    max_tiles: Option<u64>,
}

impl PyramidArguments {
    /// Returns whether tiles are requested.
    pub(super) fn is_asked(&self) -> bool {
        self.tiles.is_some()
    }

    /// Returns whether only a part of the tiles is drawn.
    pub(super) fn is_part(&self) -> bool {
        self.level.is_some() || self.shard.is_some()
    }

    /// Refuses tiles of a set in space.
    pub(super) fn refuse_in_space(&self, loaded: &Loaded) -> Result<(), Failure> {
        match self.tiles {
            Some(_) => Err(Failure::Usage(format!(
                "--tiles draws sets of the plane, and {} lies in space",
                loaded.name
            ))),
            None => Ok(()),
        }
    }

    /// Returns the options that are given, with their values; the folder is of no consequence.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let tiles = self.tiles.as_ref().map(|_| ("tiles", "tiles".to_owned()));
        let side = self.tile_size.map(|side| ("tile-size", side.to_string()));
        let overlap = self.overlap.map(|pixels| ("overlap", pixels.to_string()));
        tiles.into_iter().chain(side).chain(overlap).collect()
    }

    fn side(&self) -> u32 {
        self.tile_size.unwrap_or(SIDE)
    }

    fn overlap(&self) -> u32 {
        self.overlap.unwrap_or(0)
    }
}

/// Draws the tiles of a set in the plane. Returns the path of the page, or that of a folder that is not complete yet, with a
/// summary and the number of bytes.
pub(super) fn write(
    arguments: &Arguments,
    loaded: Loaded,
) -> Result<(PathBuf, String, u64), Failure> {
    let asked = &arguments.pyramid;
    let place = asked.tiles.as_deref().unwrap_or(Path::new("."));
    let name = name_of(&arguments.rule.rule).to_string_lossy();
    let drawing = Drawing::new(arguments, loaded, Format::Png, &ShownPart::Window, place)?;
    let graph = drawing.graph()?;
    let mut options = drawing.options(drawing.goal, graph.place());
    drawing.check_tiles(&graph, &options)?;
    let canvas = drawing.frame_of_tiles(&graph, &options)?;
    // Tiles have the colours of the whole.
    let range = options.style.color_by.range_across(canvas.window());
    options.style.color_range = options.style.color_range.or(range);
    let pyramid = Pyramid::new(canvas, asked.side(), asked.overlap());
    let deepest = pyramid.deepest();
    let mut levels: Vec<u32> = match &asked.level {
        Some(levels) => levels.as_slice().to_vec(),
        None => (0..=deepest).collect(),
    };
    levels.sort_unstable();
    levels.dedup();
    if let Some(level) = levels.iter().find(|level| **level > deepest) {
        let [width, height] = canvas.size();
        return Err(Failure::Usage(format!(
            "--level {level}: {width} x {height} pixels have the levels 0 to {deepest}"
        )));
    }
    drawing.check_first(&graph, &options, &pyramid)?;
    let shard = asked.shard.unwrap_or(Shard::ALL);
    let of_levels = levels.iter();
    let count = of_levels
        .map(|level| pyramid.count_of_part(*level, shard))
        .sum();
    check_count(asked, &pyramid, count)?;
    let description = page::description(&pyramid, &options.labels.provenance)?;
    let work = Work {
        drawing: &drawing,
        folder: TileFolder::new(place, &name, description),
        options,
        pyramid,
        shard,
        levels,
        count,
        done: AtomicU64::new(0),
    };
    output::make_folder(place)?;
    if !work.folder.begin()? {
        let page = page::write(place, &name, &work.pyramid, &work.options)?;
        return Ok((page, "complete already".into(), 0));
    }
    work.announce(graph.clone())?;
    work.run(graph)?;
    let Some(tally) = work.folder.finish(deepest)? else {
        let summary = format!(
            "part {} of {} of the levels {}; the page is written when all are done",
            shard.number,
            shard.count,
            asked
                .level
                .as_ref()
                .map_or_else(|| format!("0..{deepest}"), Several::to_string)
        );
        return Ok((
            work.folder.unfinished().into(),
            summary,
            work.tally()?.bytes,
        ));
    };
    let page = page::write(place, &name, &work.pyramid, &work.options)?;
    let [width, height] = canvas.size();
    let summary = format!(
        "{} of {}, {width} x {height} pixels, {} and {} empty ones in {}",
        drawing.goal.described(),
        drawing.loaded.name,
        readable::counted(&tally.written.into(), "tile"),
        readable::grouped(&tally.empty.into()),
        readable::counted(&u64::from(deepest + 1).into(), "level"),
    );
    Ok((page, summary, tally.bytes))
}

/// Returns an error if a run draws too many tiles.
fn check_count(asked: &PyramidArguments, pyramid: &Pyramid, count: u64) -> Result<(), Failure> {
    let most = asked.max_tiles.unwrap_or(MAX_TILES);
    if count <= most {
        return Ok(());
    }
    let [width, height] = pyramid.size(pyramid.deepest());
    Err(anyhow!(
        "{width} x {height} pixels take {}, and {} is the limit; --max-tiles allows more, a larger --tile-size takes fewer, and \
         --shard divides them",
        readable::counted(&count.into(), "tile"),
        readable::grouped(&most.into())
    )
    .into())
}

impl Drawing<'_> {
    fn graph(&self) -> Result<Graph, Failure> {
        let color_by = self.style().color_by;
        self.loaded.compile_for(self.goal.steps(), color_by)
    }

    /// Returns an error if tiles do not show the same as the picture, or if a step has too many elements.
    fn check_tiles(&self, graph: &Graph, options: &render::Options) -> Result<(), Failure> {
        let color_by = options.style.color_by;
        if matches!(self.goal, Goal::Detail(_)) && matches!(color_by, ColorBy::Step | ColorBy::Age)
        {
            return Err(Failure::Usage(format!(
                "--color-by {} distinguishes steps, whose number differs from tile to tile if --detail decides it: give --steps too, \
                 or --color-by none",
                color_by.name()
            )));
        }
        let has_range = options.style.color_range.is_some();
        if color_by == ColorBy::Distance || color_by == ColorBy::Length && !has_range {
            return Err(Failure::Usage(format!(
                "--color-by {} depends on the whole picture, and a tile is drawn by itself: use angle, x or y{}",
                color_by.name(),
                match color_by {
                    ColorBy::Length =>
                        ", or give the lengths of the first and the last colour, as --color-range 0.01..1",
                    _ => "",
                }
            )));
        }
        if let Goal::Steps(steps, None) = self.goal {
            let growth = &self.arguments.growth;
            growth.check_picture(steps, graph, &self.loaded, options)?;
        }
        Ok(())
    }

    /// Returns the canvas of the picture at the deepest level.
    fn frame_of_tiles(&self, graph: &Graph, options: &render::Options) -> Result<Canvas, Failure> {
        let failed = |error| self.explain(error);
        if let Some(window) = options.view.window {
            let canvas = Canvas::of_window(window, &options.view, options.size);
            return canvas.map_err(|error| failed(error.into()));
        }
        let long = options.size.long_side();
        let share = match self.goal {
            Goal::Detail(_) => (f64::from(MOST_SURVEYED) / long).min(1.0),
            Goal::Steps(..) => 1.0,
        };
        let mut surveyed = options.clone();
        if share < 1.0 {
            surveyed.size = scaled(options.size, share);
            surveyed.view.margin = options.view.margin.map(|margin| margin * share);
        }
        let picture = self.survey(graph, &surveyed)?;
        let view = View {
            window: picture.window,
            margin: Some(0.0),
        };
        let Some(window) = view.window else {
            return Err(failed(render::NoRoom::Infinite.into()));
        };
        let size = match options.size {
            Size::Long(_) if share >= 1.0 => Size::Exactly(picture.size[0], picture.size[1]),
            size => size,
        };
        Canvas::of_window(window, &view, size).map_err(|error| failed(error.into()))
    }

    /// Returns an error if the first tile of the deepest level cannot be drawn, for reasons that hold for all of them.
    fn check_first(
        &self,
        graph: &Graph,
        options: &render::Options,
        pyramid: &Pyramid,
    ) -> Result<(), Failure> {
        let level = pyramid.deepest();
        let first = Tile {
            level,
            column: 0,
            row: 0,
        };
        let (view, size) = pyramid.place(first);
        let options = options.clone().view(view).size(size);
        self.survey(graph, &options).map(|_| ())
    }

    /// Returns the numbers of a picture without drawing it.
    fn survey(&self, graph: &Graph, options: &render::Options) -> Result<Picture, Failure> {
        let compile = |steps| self.loaded.graph(steps);
        let draw = |graph: &Graph, steps: u32| {
            let growth = self.arguments.growth.drawn_as(options, steps, None);
            render::survey(graph, &growth, options)
        };
        let picture = self.goal.reach(graph.clone(), compile, draw);
        picture.map_err(|error| self.explain(error))
    }

    fn explain(&self, error: RenderError) -> Failure {
        let growth = &self.arguments.growth;
        growth.explain(error, &self.loaded, self.path)
    }
}

/// Returns a share of a size, at least a pixel.
fn scaled(size: Size, share: f64) -> Size {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the share is at most 1"
    )]
    let part = |side: u32| ((f64::from(side) * share).round() as u32).max(1);
    match size {
        Size::Long(side) => Size::Long(part(side)),
        Size::Exactly(width, height) => Size::Exactly(part(width), part(height)),
    }
}
