//! Depth maps: the nearest depth of every pixel of a picture in space.

use std::io;
use std::ops::Range;

use crate::geometry::DVec3;

use super::TILE_SIZE;
use super::buffer::{SAMPLES, STEPS, TILE};
use super::camera::{Placement, Projection};
use super::solid::depth_of;

/// Depth of a pixel that shows nothing, of 24 bits.
pub(super) const NOTHING: u32 = (1 << 24) - 1;

/// Depths of the pixels of a picture: those of the nearest point that each shows.
#[derive(Clone, Debug)]
pub struct DepthMap {
    /// The low 16 bits of depths in multiples of 2⁻²² of the range, from the near end.
    low: Vec<u16>,
    /// Their high 8 bits.
    high: Vec<u8>,
    placement: Placement,
}

/// Depths of the pixels of a row.
#[derive(Clone, Copy)]
pub(super) struct DepthRow<'a> {
    low: &'a [u16],
    high: &'a [u8],
}

impl<'a> DepthRow<'a> {
    /// Returns the depths of a range of columns.
    pub(super) fn part(self, columns: Range<usize>) -> Self {
        Self {
            low: &self.low[columns.clone()],
            high: &self.high[columns],
        }
    }

    /// Returns the depths in steps, or [`NOTHING`].
    #[inline]
    pub(super) fn iter(self) -> impl ExactSizeIterator<Item = u32> + 'a {
        let parts = self.low.iter().zip(self.high);
        parts.map(|(low, high)| u32::from(*low) | u32::from(*high) << 16)
    }
}

impl DepthMap {
    /// Creates a map that shows nothing.
    pub(super) fn new(placement: &Placement) -> Self {
        let [width, height] = placement.size;
        let count = width as usize * height as usize;
        let (low, high) = parts(None);
        Self {
            low: vec![low; count],
            high: vec![high; count],
            placement: *placement,
        }
    }

    /// Creates a map of depths in rows.
    pub(super) fn of(placement: &Placement, depths: impl Iterator<Item = Option<u32>>) -> Self {
        let (low, high) = depths.map(parts).unzip();
        Self {
            low,
            high,
            placement: *placement,
        }
    }

    /// Adds the depths of the keys of a tile's pixels.
    pub(super) fn add(&mut self, at: [u32; 2], keys: &[u32]) {
        let [width, height] = self.placement.size;
        let [left, top] = at.map(|at| at * TILE_SIZE);
        let columns = TILE_SIZE.min(width - left) as usize;
        for row in 0..TILE_SIZE.min(height - top) as usize {
            let start = (top as usize + row) * width as usize + left as usize;
            let from = &keys[row * TILE..row * TILE + columns];
            let range = start..start + columns;
            let to = { self.low[range.clone()].iter_mut() }.zip(&mut self.high[range]);
            for ((low, high), key) in to.zip(from) {
                (*low, *high) = parts(depth_of(*key));
            }
        }
    }

    /// Returns the width and the height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.placement.size
    }

    /// Returns the depth of a pixel, counted from the upper left corner: 0 at the nearest point of the set, 1 at its
    /// farthest, measured along the direction of view. `None` if the pixel shows nothing, or lies outside.
    #[must_use]
    pub fn depth(&self, [x, y]: [u32; 2]) -> Option<f64> {
        let depth = self.steps(x as usize, y as usize)?;
        Some(f64::from(depth) / STEPS)
    }

    fn steps(&self, x: usize, y: usize) -> Option<u32> {
        let [width, height] = self.placement.size.map(|side| side as usize);
        if x >= width || y >= height {
            return None;
        }
        let at = y * width + x;
        let depth = u32::from(self.low[at]) | u32::from(self.high[at]) << 16;
        (depth != NOTHING).then_some(depth)
    }

    /// Returns the depths of a row.
    pub(super) fn row(&self, y: usize) -> DepthRow<'_> {
        let width = self.placement.size[0] as usize;
        self.all().part(y * width..(y + 1) * width)
    }

    fn all(&self) -> DepthRow<'_> {
        DepthRow {
            low: &self.low,
            high: &self.high,
        }
    }

    /// Returns the point that a pixel shows, in view coordinates: x to the right, y upwards, z towards the viewer;
    /// `None` if it shows nothing.
    pub(super) fn point(&self, x: usize, y: usize) -> Option<DVec3> {
        let depth = self.steps(x, y)?;
        let [far, near] = self.placement.range;
        let z = near - f64::from(depth) / STEPS * (near - far);
        let [right, down] = self.ray([x, y]);
        Some(match self.placement.projection {
            Projection::Parallel => DVec3::new(right, -down, z),
            Projection::Central { .. } => DVec3::new(-z * right, z * down, z),
        })
    }

    /// Returns the place of a pixel to the right and downwards, in a picture in perspective at distance 1.
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    pub(super) fn ray(&self, pixel: [usize; 2]) -> [f64; 2] {
        let place = pixel.map(|at| (at as f64 + 0.5) * SAMPLES as f64);
        match self.placement.projection {
            Projection::Parallel => place,
            Projection::Central { focus, middle } => {
                [0, 1].map(|axis| (place[axis] - middle[axis]) / focus)
            }
        }
    }

    /// Returns the placement of the picture.
    pub(super) fn placement(&self) -> &Placement {
        &self.placement
    }

    /// Writes the map as a PNG of grey levels of 16 bits: 65535 at the nearest point of the set, falling linearly to 1
    /// at its farthest, and 0 where nothing is shown.
    ///
    /// # Errors
    ///
    /// If `out` fails.
    pub fn write(&self, out: &mut impl io::Write) -> io::Result<()> {
        let [width, height] = self.placement.size;
        let grey = |depth: u32| match depth {
            NOTHING => 0,
            depth => grey(f64::from(depth) / STEPS),
        };
        let greys = self.all().iter().map(grey);
        let bytes: Vec<u8> = greys.flat_map(u16::to_be_bytes).collect();
        // The encoder does not pass on why writing to `out` fails, so it writes to memory.
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, width, height);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Sixteen);
        let mut writer = encoder.write_header().map_err(io::Error::other)?;
        writer.write_image_data(&bytes).map_err(io::Error::other)?;
        writer.finish().map_err(io::Error::other)?;
        out.write_all(&png)
    }
}

/// Returns the low and the high bits of a depth.
#[expect(clippy::cast_possible_truncation, reason = "the bits are divided")]
fn parts(depth: Option<u32>) -> (u16, u8) {
    let depth = depth.unwrap_or(NOTHING);
    (depth as u16, (depth >> 16) as u8)
}

/// Returns the grey level of a depth from 0, the nearest, to 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is in range"
)]
fn grey(depth: f64) -> u16 {
    (65535.0 - depth * 65534.0).round() as u16
}
