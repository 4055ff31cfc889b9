//! Filled subpaths. Subpaths within the limits are covered as polygons, one by one; those of very many
//! vertices form a region. tiny-skia fills large outlines of few vertices, which it does quickly.

use std::sync::Arc;

use crate::render::paint::Position;

use super::Png;
use super::chunk::Command;
use super::coverage::{MAX_CORNERS, has_room};

/// Number of vertices of a region above which it is covered before the path ends.
const MANY_VERTICES: usize = 1 << 20;

impl Png<'_, '_> {
    /// Ends the current subpath, which is covered if it is within the limits.
    pub(super) fn end_ring(&mut self) {
        if self.ring.is_empty() {
            return;
        }
        if has_room(&self.ring) {
            self.chunk.polygon(&self.ring);
            self.ring.clear();
            return;
        }
        let mut vertices = self.ring.drain(..);
        if let Some(start) = vertices.next() {
            self.outline.move_to(start);
        }
        vertices.for_each(|vertex| self.outline.line_to(vertex));
        self.outline.close(&mut self.part.pixmap);
    }

    /// Adds vertices to the current subpath.
    #[inline]
    pub(super) fn ring_to(&mut self, to: impl ExactSizeIterator<Item = Position>) {
        if !self.ring.is_empty() {
            if to.len() <= MAX_CORNERS - self.ring.len() {
                self.ring.extend(to);
                return;
            }
            // The subpath becomes an outline of the region.
            let mut vertices = self.ring.drain(..);
            if let Some(start) = vertices.next() {
                self.region.move_to(start);
            }
            vertices.for_each(|vertex| self.region.line_to(vertex));
        }
        to.for_each(|to| self.region.line_to(to));
    }

    /// Closes an outline of the region, and covers the region if it is large.
    pub(super) fn close_region(&mut self) {
        self.region.close();
        if self.region.vertices() > MANY_VERTICES {
            self.cover_region();
        }
    }

    /// Covers the region.
    pub(super) fn cover_region(&mut self) {
        if self.region.is_empty() {
            return;
        }
        let region = Arc::new(self.region.take());
        for rows in region.pieces() {
            if !self.chunk.is_empty() {
                self.next_chunk();
            }
            self.chunk
                .list
                .push(Command::Region(Arc::clone(&region), rows));
        }
    }
}
