//! Drawing of the tiles of a pyramid, or of a part of them.

use std::io;
use std::num::NonZero;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::graph::Graph;
use crate::parallel::for_each;
use crate::random::Pcg;
use crate::render::{self, Labels, RenderError, Unit};

use super::super::super::shard::Shard;
use super::super::super::{Failure, progress, readable};
use super::super::drawing::Drawing;
use super::folder::{Tally, TileFolder, write_file};
use super::levels::{Pyramid, Tile};

/// Number of tiles from which a note precedes the work.
const MANY: u64 = 1_000;

/// Number of tiles that are drawn for an estimate of the time and the size.
const SAMPLE: u32 = 128;

/// Pyramid that is drawn.
pub(super) struct Work<'a> {
    pub(super) drawing: &'a Drawing<'a>,
    pub(super) options: render::Options,
    pub(super) pyramid: Pyramid,
    pub(super) folder: TileFolder,
    pub(super) shard: Shard,
    pub(super) levels: Vec<u32>,
    /// Number of tiles of this run.
    pub(super) count: u64,
    /// Number of tiles that are done.
    pub(super) done: AtomicU64,
}

/// Reason why tiles are not drawn.
enum Trouble {
    Drawing(RenderError),
    Folder(Failure),
}

impl From<RenderError> for Trouble {
    fn from(error: RenderError) -> Self {
        Self::Drawing(error)
    }
}

impl From<Failure> for Trouble {
    fn from(failure: Failure) -> Self {
        Self::Folder(failure)
    }
}

impl Work<'_> {
    /// Reports the number of tiles beforehand, if there are many, with estimates of the time and the size from some of them,
    /// which are drawn and remain. Of work that goes on, the time is not estimated.
    pub(super) fn announce(&self, graph: Graph) -> Result<(), Failure> {
        let growth = &self.drawing.arguments.growth;
        if growth.quiet || self.count < MANY {
            return Ok(());
        }
        let sample = self.sample();
        let mut drawn_before = sample.iter().map(|tile| self.folder.written(*tile));
        let goes_on = drawn_before.any(|bytes| bytes.is_some());
        let start = Instant::now();
        let describe = || format!("{SAMPLE} tiles for an estimate");
        let drawn = self.reach(graph, describe, |graph, steps| {
            let mut levels: Vec<u32> = sample.iter().map(|tile| tile.level).collect();
            levels.dedup();
            for level in levels {
                self.folder.make_level(level)?;
            }
            self.draw_all(sample.iter().copied(), SAMPLE.into(), graph, steps)
        })?;
        #[expect(clippy::cast_precision_loss, reason = "an estimate")]
        let (all, bytes) = (self.count as f64 / sample.len() as f64, drawn.bytes as f64);
        let time = match goes_on {
            true => String::new(),
            false => {
                let seconds = all * start.elapsed().as_secs_f64();
                format!(", in about {}", readable::duration(seconds))
            }
        };
        growth.note(&format!(
            "note: up to {} of {} pixels are drawn{time}, to about {}",
            readable::counted(&self.count.into(), "tile"),
            self.pyramid.side(),
            readable::rough_bytes(all * bytes),
        ));
        Ok(())
    }

    /// Returns tiles of this run in order, one at random from each of [`SAMPLE`] parts of equal size.
    fn sample(&self) -> Vec<Tile> {
        let mut random = Pcg::new(0, u64::from(self.shard.number));
        let one = |number: u32| {
            let place = (f64::from(number) + random.unit()) / f64::from(SAMPLE);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_precision_loss,
                clippy::cast_sign_loss,
                reason = "it is below the number of tiles"
            )]
            let mut place = (place * self.count as f64) as u64;
            for &level in &self.levels {
                let own = self.pyramid.count_of_part(level, self.shard);
                if place < own {
                    return Some(self.pyramid.tile_of_part(level, self.shard, place));
                }
                place -= own;
            }
            None
        };
        (0..SAMPLE).filter_map(one).collect()
    }

    /// Draws the tiles of all levels, as far as they are not drawn yet.
    pub(super) fn run(&self, graph: Graph) -> Result<(), Failure> {
        let describe = || {
            let done = self.done.load(Ordering::Relaxed);
            let count = readable::counted(&self.count.into(), "tile");
            format!("{} of {count}", readable::grouped(&done.into()))
        };
        self.reach(graph, describe, |graph, steps| {
            self.done.store(0, Ordering::Relaxed);
            let mut levels = self.levels.iter();
            levels.try_for_each(|level| self.draw_level(*level, graph, steps))
        })
    }

    /// Draws with a graph for as many steps as the goal needs, and shows what `describe` returns meanwhile.
    fn reach<T>(
        &self,
        graph: Graph,
        describe: impl Fn() -> String + Sync,
        mut draw: impl FnMut(&Graph, u32) -> Result<T, Trouble>,
    ) -> Result<T, Failure> {
        let drawing = self.drawing;
        let mut failure = None;
        let drawn = progress::watched_as(!drawing.arguments.growth.quiet, describe, || {
            let compile = |steps| drawing.loaded.graph(steps);
            drawing.goal.reach(graph, compile, |graph, steps| {
                draw(graph, steps).map_err(|trouble| match trouble {
                    Trouble::Drawing(error) => error,
                    Trouble::Folder(other) => {
                        failure = Some(other);
                        RenderError::Io(io::ErrorKind::Other.into())
                    }
                })
            })
        });
        match failure {
            Some(failure) => Err(failure),
            None => drawn.map_err(|error| drawing.explain(error)),
        }
    }

    /// Draws the part of a level that belongs to this run.
    fn draw_level(&self, level: u32, graph: &Graph, steps: u32) -> Result<(), Trouble> {
        let own = self.pyramid.count_of_part(level, self.shard);
        if self.folder.done(level, self.shard)?.is_some() {
            self.done.fetch_add(own, Ordering::Relaxed);
            return Ok(());
        }
        self.folder.make_level(level)?;
        let tiles = (0..own).map(|tile| self.pyramid.tile_of_part(level, self.shard, tile));
        let tally = self.draw_all(tiles, own, graph, steps)?;
        Ok(self.folder.note(level, self.shard, &tally)?)
    }

    /// Draws tiles of a known number.
    fn draw_all(
        &self,
        tiles: impl Iterator<Item = Tile> + Send,
        count: u64,
        graph: &Graph,
        steps: u32,
    ) -> Result<Tally, Trouble> {
        let threads = self.options.threads;
        // A few tiles are drawn by all threads together.
        let (outer, inner) = match count < threads.get() as u64 {
            true => (1, threads),
            false => (threads.get(), NonZero::<usize>::MIN),
        };
        let tally = Mutex::new(Tally::default());
        let trouble = Mutex::new(None);
        let is_over = AtomicBool::new(false);
        for_each(
            tiles.take_while(|_| !is_over.load(Ordering::Relaxed)),
            outer,
            |tile| {
                match self.draw(tile, graph, steps, inner) {
                    Ok(more) => *tally.lock().unwrap_or_else(PoisonError::into_inner) += more,
                    Err(error) => {
                        is_over.store(true, Ordering::Relaxed);
                        let mut trouble = trouble.lock().unwrap_or_else(PoisonError::into_inner);
                        trouble.get_or_insert(error);
                    }
                }
                self.done.fetch_add(1, Ordering::Relaxed);
            },
        );
        match trouble.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(trouble) => Err(trouble),
            None => Ok(tally.into_inner().unwrap_or_else(PoisonError::into_inner)),
        }
    }

    /// Draws a tile, unless it is there.
    fn draw(
        &self,
        tile: Tile,
        graph: &Graph,
        steps: u32,
        threads: NonZero<usize>,
    ) -> Result<Tally, Trouble> {
        let mut tally = Tally::default();
        if let Some(bytes) = self.folder.written(tile) {
            (tally.written, tally.bytes) = (1, bytes);
            return Ok(tally);
        }
        let (view, size) = self.pyramid.place(tile);
        let options = render::Options {
            view,
            size,
            threads,
            labels: Labels::default(),
            unit: Unit::Pixel,
            ..self.options.clone()
        };
        let growth = self
            .drawing
            .arguments
            .growth
            .drawn_as(&options, steps, None);
        let pixels = render::pixels(graph, &growth, &options)?;
        if pixels.are_blank(options.style.background) {
            tally.empty = 1;
            return Ok(tally);
        }
        let png = pixels.into_png(options.png)?;
        write_file(&self.folder.tile(tile), &png)?;
        (tally.written, tally.bytes) = (1, png.len() as u64);
        Ok(tally)
    }

    /// Returns the numbers of the tiles of this run.
    pub(super) fn tally(&self) -> Result<Tally, Failure> {
        let mut all = Tally::default();
        for level in &self.levels {
            all += self.folder.done(*level, self.shard)?.unwrap_or_default();
        }
        Ok(all)
    }
}
