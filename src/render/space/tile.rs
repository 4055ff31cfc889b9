//! Tiles of a picture in space, each of which is drawn by one thread.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::geometry::HalfSpace;
use crate::style::Colour;

use super::TILE_SIZE;
use super::buffer::{Buffer, SAMPLES, SIDE, TILE};
use super::camera::Placement;
use super::descent::Descent;
use super::roots::Roots;
use super::shade::{self, Inks};
use super::solid::{Depths, View};

/// Piece of work: a tile of the picture.
pub(super) struct Tile<'a> {
    pub(super) scene: &'a Scene<'a>,
    /// Column and row of the tile.
    pub(super) at: [u32; 2],
    /// Instances of the initiator that may be seen in the row.
    pub(super) start: Arc<[usize]>,
    /// Number of solids that were drawn.
    pub(super) drawn: u64,
    /// Greatest number of steps of a solid that was drawn.
    pub(super) deepest: u32,
    /// Colours of the pixels, in rows, if the scene has inks.
    colours: Vec<PremultipliedColorU8>,
    /// Nearest keys of the pixels.
    pub(super) keys: Vec<u32>,
}

/// Memory with which a thread draws a tile.
struct Workspace {
    buffer: Buffer,
    descent: Descent,
}

/// Memory that is reused from tile to tile: of as many tiles as are drawn at once.
#[derive(Default)]
pub(super) struct Workspaces(Mutex<Vec<Workspace>>);

impl Workspaces {
    fn spares(&self) -> MutexGuard<'_, Vec<Workspace>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn take(&self) -> Workspace {
        let spare = self.spares().pop();
        spare.unwrap_or_else(|| Workspace {
            buffer: Buffer::new(),
            descent: Descent::default(),
        })
    }

    fn put(&self, workspace: Workspace) {
        self.spares().push(workspace);
    }
}

/// State that all tiles share.
pub(super) struct Scene<'a> {
    pub(super) roots: Roots<'a>,
    pub(super) cuts: Vec<HalfSpace>,
    pub(super) placement: Placement,
    pub(super) workspaces: Workspaces,
    /// Inks, if colours are seen.
    pub(super) inks: Option<Inks>,
    pub(super) cancel: Option<&'a AtomicBool>,
}

impl Scene<'_> {
    pub(super) fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|it| it.load(Ordering::Relaxed))
    }

    /// Returns the view of the tile in a column and a row.
    pub(super) fn view(&self, at: [u32; 2]) -> View<'_> {
        #[expect(clippy::cast_precision_loss, reason = "a tile has few samples")]
        let side = SIDE as f64;
        View {
            projection: self.placement.projection,
            depths: Depths::new(self.placement.range),
            cuts: &self.cuts,
            corner: at.map(|tile| f64::from(tile) * side),
        }
    }
}

impl<'a> Tile<'a> {
    /// Creates a tile to be drawn.
    pub(super) fn of(scene: &'a Scene<'a>) -> Self {
        Self {
            scene,
            at: [0, 0],
            start: Arc::default(),
            drawn: 0,
            deepest: 0,
            colours: Vec::new(),
            keys: Vec::new(),
        }
    }

    pub(super) fn draw(&mut self) {
        self.colours.clear();
        self.keys.clear();
        (self.drawn, self.deepest) = (0, 0);
        if self.scene.is_cancelled() {
            return;
        }
        let mut workspace = self.scene.workspaces.take();
        self.draw_with(&mut workspace);
        self.scene.workspaces.put(workspace);
    }

    fn draw_with(&mut self, Workspace { buffer, descent }: &mut Workspace) {
        let Scene { roots, inks, .. } = self.scene;
        let view = self.scene.view(self.at);
        buffer.clear();
        (descent.drawn, descent.deepest) = (0, 0);
        descent.run(roots, &view, buffer, &self.start);
        (self.drawn, self.deepest) = (descent.drawn, descent.deepest);
        let Some(inks) = inks else {
            for y in 0..TILE {
                let rows = buffer.rows_of_pixels(y);
                let pixels = (0..TILE).map(|x| shade::nearest(shade::samples(rows, x)));
                self.keys.extend(pixels);
            }
            return;
        };
        let is_tinted = roots.finds_colours();
        if is_tinted {
            descent.tints.settle(buffer);
        }
        for y in 0..TILE {
            let tints: Option<[&[Colour]; SAMPLES]> =
                is_tinted.then(|| std::array::from_fn(|row| descent.tints.row(y * SAMPLES + row)));
            let rows = buffer.rows_of_pixels(y);
            for x in 0..TILE {
                let samples = shade::samples(rows, x);
                let tints = tints.map(|rows| shade::samples(rows, x));
                let (colour, key) = inks.pixel(samples, tints);
                self.colours.push(shade::premultiplied(colour));
                self.keys.push(key);
            }
        }
    }

    /// Copies the pixels into the picture.
    pub(super) fn copy(&self, pixmap: &mut Pixmap) {
        let [width, height] = [pixmap.width(), pixmap.height()];
        let [left, top] = self.at.map(|at| at * TILE_SIZE);
        let columns = TILE_SIZE.min(width - left) as usize;
        let pixels: &mut [PremultipliedColorU8] = pixmap.pixels_mut();
        for row in 0..TILE_SIZE.min(height - top) as usize {
            let start = (top as usize + row) * width as usize + left as usize;
            let colours = &self.colours[row * TILE..row * TILE + columns];
            pixels[start..start + columns].copy_from_slice(colours);
        }
    }
}
