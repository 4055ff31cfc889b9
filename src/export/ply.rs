//! Points of random iteration in space as a PLY file, with colours and normals.

use std::io::{self, Write};
use std::sync::atomic::AtomicBool;

use crate::chaos::RandomPoint;
use crate::geometry::{BEYOND, Bounds, DVec3};
use crate::grow::{Progress, WalkError};
use crate::parallel::is_cancelled;
use crate::style::Colour;

/// Points between two checks for cancellation.
const MANY: u64 = 1 << 12;

/// Cells along a side of the grid.
const SIDE: usize = 96;

/// Cells to each side over which densities are averaged.
const REACH: usize = 2;

/// Normals of a cloud of points, from its density.
///
/// Points are counted in 96³ cells of their box, and the counts averaged over 5³ cells. The normal at a point is the
/// direction in which that density, interpolated between cells, falls fastest (the gradient shading of Levoy 1988):
/// a normal of the relief of the cloud, which points outwards and depends on no view. It is wrong for what is finer
/// than the cells. Where the density is the same all around, the normal points away from the middle of the box.
#[derive(Clone, Debug)]
pub struct Relief {
    corner: DVec3,
    /// Cells a unit.
    scale: f64,
    density: Vec<f32>,
}

impl Relief {
    /// Creates the normals of points in a box. Points outside count as if they were on its edge.
    #[must_use]
    pub fn of(bounds: &Bounds<DVec3>, points: impl Iterator<Item = DVec3>) -> Self {
        let longest = bounds.size().max_element();
        // Beyond the box there is room for averages.
        let cells = (SIDE - 4 * REACH) as f32;
        let scale = if longest > 0.0 {
            f64::from(cells) / longest
        } else {
            1.0
        };
        let middle = bounds.min() + bounds.size() / 2.0;
        let mut surface = Self {
            corner: middle - DVec3::splat(SIDE as f64 / 2.0 / scale),
            scale,
            density: vec![0.0; SIDE * SIDE * SIDE],
        };
        for point in points {
            let cell = surface.cells(point).map(index);
            surface.density[number(cell)] += 1.0;
        }
        for axis in 0..3 {
            surface.average(axis);
        }
        surface
    }

    /// Returns the position of a point, in cells.
    fn cells(&self, point: DVec3) -> [f64; 3] {
        ((point - self.corner) * self.scale).to_array()
    }

    /// Averages along an axis.
    fn average(&mut self, axis: usize) {
        let step = [1, SIDE, SIDE * SIDE][axis];
        let mut line = [0.0; SIDE];
        for start in 0..SIDE * SIDE {
            let (low, high) = (start % step, start / step);
            let first = high * step * SIDE + low;
            for (place, value) in line.iter_mut().enumerate() {
                *value = self.density[first + place * step];
            }
            for place in 0..SIDE {
                let near = place.saturating_sub(REACH)..(place + REACH + 1).min(SIDE);
                self.density[first + place * step] = line[near].iter().sum();
            }
        }
    }

    /// Returns the density at a position in cells, interpolated linearly.
    fn density(&self, at: [f64; 3]) -> f64 {
        let low = at.map(|at| index(at - 0.5));
        let share: [f64; 3] =
            std::array::from_fn(|axis| (at[axis] - 0.5 - low[axis] as f64).clamp(0.0, 1.0));
        let mut sum = 0.0;
        for corner in 0..8usize {
            let mut weight = 1.0;
            let mut cell = low;
            for axis in 0..3 {
                let is_high = corner >> axis & 1;
                cell[axis] = (cell[axis] + is_high).min(SIDE - 1);
                weight *= if is_high == 1 {
                    share[axis]
                } else {
                    1.0 - share[axis]
                };
            }
            sum += weight * f64::from(self.density[number(cell)]);
        }
        sum
    }

    /// Returns the unit normal at a point.
    #[must_use]
    pub fn normal(&self, point: DVec3) -> DVec3 {
        let at = self.cells(point);
        let falls = |axis: usize| {
            let (mut before, mut after) = (at, at);
            before[axis] -= 1.0;
            after[axis] += 1.0;
            self.density(before) - self.density(after)
        };
        let gradient = DVec3::new(falls(0), falls(1), falls(2));
        let away = DVec3::from_array(at) - DVec3::splat(SIDE as f64 / 2.0);
        gradient
            .try_normalize()
            .unwrap_or_else(|| away.normalize_or(DVec3::Z))
    }
}

/// Returns the cell of a coordinate.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is clamped"
)]
fn index(at: f64) -> usize {
    at.floor().clamp(0.0, (SIDE - 1) as f64) as usize
}

fn number([x, y, z]: [usize; 3]) -> usize {
    (z * SIDE + y) * SIDE + x
}

/// Writes `count` points as a binary PLY file, in their order: their coordinates and normals in single precision, and
/// the colour that `colour` gives them.
///
/// # Errors
///
/// Returns an error if the walk is cancelled, if a coordinate is beyond the range of single precision, or if `out`
/// fails.
pub fn write_ply(
    mut points: impl Iterator<Item = RandomPoint<DVec3>>,
    count: u64,
    surface: &Relief,
    mut colour: impl FnMut(&RandomPoint<DVec3>) -> Colour,
    cancel: Option<&AtomicBool>,
    progress: Option<&Progress>,
    out: &mut impl Write,
) -> Result<(), WalkError<io::Error>> {
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment kfrac {}\nelement vertex {count}\n\
         property float x\nproperty float y\nproperty float z\n\
         property float nx\nproperty float ny\nproperty float nz\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
        env!("CARGO_PKG_VERSION"),
    )
    .map_err(WalkError::Visitor)?;
    for number in 1..=count {
        let Some(point) = points.next() else { break };
        if number.is_multiple_of(MANY) {
            if is_cancelled(cancel) {
                return Err(WalkError::Cancelled);
            }
            if let Some(progress) = progress {
                progress.count(MANY);
            }
        }
        let vectors = [point.place, surface.normal(point.place)];
        let mut bytes = [0; 27];
        for (value, place) in vectors
            .iter()
            .flat_map(|vector| vector.to_array())
            .zip((0..).step_by(4))
        {
            #[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
            // Adding zero turns −0 into 0.
            let value = (value + 0.0) as f32;
            if !value.is_finite() {
                let error = io::Error::new(io::ErrorKind::InvalidData, BEYOND);
                return Err(WalkError::Visitor(error));
            }
            bytes[place..place + 4].copy_from_slice(&value.to_le_bytes());
        }
        bytes[24..].copy_from_slice(&colour(&point).rgba()[..3]);
        out.write_all(&bytes).map_err(WalkError::Visitor)?;
    }
    Ok(())
}
