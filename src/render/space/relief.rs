//! Relief: light on surfaces whose normals are taken from the depths of neighbouring pixels.

use tiny_skia::Pixmap;

use crate::geometry::DVec3;

use super::TILE_SIZE;
use super::buffer::{SAMPLES, STEPS, TILE};
use super::camera::{Camera, CameraError, Placement, Projection};
use super::shade::{self, Light};

/// Depth of a pixel that shows nothing.
const NOTHING: u32 = u32::MAX;

/// Depths of the pixels of a picture, with the light.
pub(super) struct Relief {
    size: [u32; 2],
    depths: Vec<u32>,
    /// Unit vector towards the light, in view coordinates: x to the right, y upwards, z towards the viewer.
    towards: DVec3,
    ambient: f64,
    placement: Placement,
}

impl Relief {
    pub(super) fn new(
        placement: &Placement,
        camera: &Camera,
        light: Light,
    ) -> Result<Self, CameraError> {
        let [width, height] = placement.size;
        Ok(Self {
            size: placement.size,
            depths: vec![NOTHING; width as usize * height as usize],
            towards: camera.rotation()? * light.towards(),
            ambient: light.ambient.clamp(0.0, 1.0),
            placement: *placement,
        })
    }

    /// Adds the depths of a tile.
    pub(super) fn add(&mut self, at: [u32; 2], depths: &[Option<u32>]) {
        let [width, height] = self.size;
        let [left, top] = at.map(|at| at * TILE_SIZE);
        let columns = TILE_SIZE.min(width - left) as usize;
        for row in 0..TILE_SIZE.min(height - top) as usize {
            let start = (top as usize + row) * width as usize + left as usize;
            let from = &depths[row * TILE..row * TILE + columns];
            for (depth, own) in self.depths[start..start + columns].iter_mut().zip(from) {
                *depth = own.unwrap_or(NOTHING);
            }
        }
    }

    /// Multiplies the colours by the intensity of the light.
    pub(super) fn light(&self, pixmap: &mut Pixmap) {
        let width = self.size[0] as usize;
        for (at, pixel) in pixmap.pixels_mut().iter_mut().enumerate() {
            if pixel.alpha() == 0 {
                continue;
            }
            let (x, y) = (at % width, at / width);
            let cosine = self.normal(x, y).dot(self.towards).max(0.0);
            let intensity = self.ambient + (1.0 - self.ambient) * cosine;
            let [red, green, blue, alpha] = shade::parts(*pixel);
            let lit = [red, green, blue].map(|part| part * intensity);
            *pixel = shade::premultiplied([lit[0], lit[1], lit[2], alpha]);
        }
    }

    /// Returns the point that a pixel shows, in view coordinates; `None` if it shows nothing.
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    fn point(&self, x: usize, y: usize) -> Option<DVec3> {
        let [width, height] = self.size.map(|side| side as usize);
        if x >= width || y >= height {
            return None;
        }
        let depth = self.depths[y * width + x];
        if depth == NOTHING {
            return None;
        }
        let [far, near] = self.placement.range;
        let z = near - f64::from(depth) / STEPS * (near - far);
        let [right, down] = [x, y].map(|at| (at as f64 + 0.5) * SAMPLES as f64);
        Some(match self.placement.projection {
            Projection::Parallel => DVec3::new(right, -down, z),
            Projection::Central { focus, middle } => {
                let across = [(right - middle[0]) / focus, (down - middle[1]) / focus];
                DVec3::new(-z * across[0], z * across[1], z)
            }
        })
    }

    /// Returns the normal at a pixel. Of the two neighbours on an axis, the one of the more similar depth counts:
    /// the other may lie beyond an edge.
    fn normal(&self, x: usize, y: usize) -> DVec3 {
        let Some(own) = self.point(x, y) else {
            return DVec3::Z;
        };
        let along = |after: Option<DVec3>, before: Option<DVec3>| {
            let (after, before) = (after.map(|it| it - own), before.map(|it| own - it));
            match (after, before) {
                (Some(a), Some(b)) if a.z.abs() <= b.z.abs() => Some(a),
                (a, None) => a,
                (_, b) => b,
            }
        };
        let right = along(
            self.point(x + 1, y),
            x.checked_sub(1).and_then(|x| self.point(x, y)),
        );
        let up = along(
            y.checked_sub(1).and_then(|y| self.point(x, y)),
            self.point(x, y + 1),
        );
        match (right, up) {
            (Some(right), Some(up)) => right.cross(up).normalize_or(DVec3::Z),
            _ => DVec3::Z,
        }
    }
}
