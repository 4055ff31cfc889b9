//! Surfaces of pixels, which take more than paths.

use std::sync::Arc;

use crate::render::paint::{Paint, Position};

use super::coverage::{SegmentBatch, Sprite, SpritePaint};

/// Sprite, and the pixel on which it is put.
#[derive(Clone, Debug)]
pub(crate) struct PlacedSprite {
    pub(in crate::render) sprite: Arc<Sprite>,
    pub(in crate::render) pixel: [i64; 2],
}

/// Surface of pixels.
pub(crate) trait Raster {
    /// Draws polygons of `sides` vertices each, within a path, up to the first one that is to be drawn as a
    /// subpath. Their vertices may be equal. Returns the number of those that are drawn.
    fn polygons(&mut self, vertices: &[Position], sides: usize) -> usize;

    /// Returns whether segment batches may be put in paths that are stroked with this paint.
    fn takes_batches(&self, paint: &Paint) -> bool;
    /// Draws segment batches, within such a path.
    fn batches(&mut self, batches: &[SegmentBatch]);

    /// Returns the paint of sprites that may be put in paths with this paint, if there is one. Pixels that they
    /// cover repeatedly are covered once.
    fn sprite_paint(&mut self, paint: &Paint) -> Option<SpritePaint>;
    /// Draws sprites, within such a path.
    fn sprites(&mut self, sprites: &[PlacedSprite]);
}
