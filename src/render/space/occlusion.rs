//! Ambient occlusion: what is enclosed by its surroundings is darker.

use super::buffer::{SAMPLES, STEPS};
use super::camera::{Placement, Projection};
use super::depth_map::{DepthMap, DepthRow, NOTHING};

/// Columns and rows of the directions to one side of a pixel in which surroundings are looked at; those to the other side
/// are opposite. Multiples of them are pixels, so that what is seen of a plane lies on a line.
const DIRECTIONS: [[isize; 2]; 8] = [
    [1, 0],
    [2, 1],
    [1, 1],
    [1, 2],
    [0, 1],
    [-1, 2],
    [-1, 1],
    [-2, 1],
];

/// Share of the long side of the picture within which surroundings occlude a pixel.
const REACH: f64 = 1.0 / 8.0;

/// Ratio of the distances at which surroundings are looked at.
const RATIO: f64 = 1.7;

/// Openness of the pixels of a picture.
///
/// The share of the surroundings of a pixel that is open, from 0 to 1, by the horizons on both sides of it (Bavoil, Sainz &
/// Dimitrov 2008). The two horizons on a line across a plane cancel, so that a plane is open from any direction of view.
pub(super) struct Occlusion<'a> {
    depths: &'a DepthMap,
    /// Columns and rows to pixels, from near to far, in every direction and then in the opposite one.
    rays: Vec<[Vec<[isize; 2]>; 2]>,
    /// Distance within which surroundings count, in view coordinates at distance 1 of a picture in perspective.
    reach: f64,
}

/// Points that the pixels of a row show, in view coordinates.
struct Row {
    x: Vec<f32>,
    y: Vec<f32>,
    depth: Vec<u32>,
    z: Vec<f32>,
    /// One over the square of the distance within which surroundings count.
    reach: Vec<f32>,
    /// x of the columns in a picture in perspective, at distance 1.
    across: Vec<f32>,
}

/// A row beside another.
struct Beside<'a> {
    depths: DepthRow<'a>,
    /// Columns and rows from the pixels of the row.
    way: [isize; 2],
    /// z of the depth 0, and its change with each step of depth.
    near: f32,
    step: f32,
    /// y of the row in a picture in perspective, at distance 1.
    across: f32,
}

impl<'a> Occlusion<'a> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "pictures are small"
    )]
    pub(super) fn new(depths: &'a DepthMap) -> Self {
        let Placement {
            size: [width, height],
            projection,
            ..
        } = depths.placement();
        let pixels = (f64::from(*width.max(height)) * REACH).max(2.0);
        let ray = |direction: [isize; 2], side: isize| {
            let away = direction.map(|part| part as f64);
            let most = pixels / away[0].hypot(away[1]);
            let distances = std::iter::successors(Some(1.0), |away| Some(away * RATIO));
            let distances = distances.take_while(|away| *away <= most.max(1.0));
            let at = |away: f64| direction.map(|part| side * part * away.round() as isize);
            distances.map(at).collect::<Vec<_>>()
        };
        Self {
            depths,
            rays: DIRECTIONS
                .map(|direction| [1, -1].map(|side| ray(direction, side)))
                .to_vec(),
            reach: pixels * SAMPLES as f64
                / match projection {
                    Projection::Parallel => 1.0,
                    Projection::Central { focus, .. } => *focus,
                },
        }
    }

    /// Returns the openness of the pixels of a row.
    #[expect(clippy::cast_precision_loss, reason = "there are few rays")]
    pub(super) fn row(&self, y: usize) -> Vec<f32> {
        let row = self.own(y);
        let width = row.depth.len();
        let mut hidden = vec![0.0; width];
        let mut horizons = [vec![0.0; width], vec![0.0; width]];
        for rays in &self.rays {
            for (horizon, ray) in horizons.iter_mut().zip(rays) {
                horizon.fill(-1.0);
                for way in ray {
                    let Some(beside) = self.beside(y, *way) else {
                        continue;
                    };
                    match self.depths.placement().projection {
                        Projection::Parallel => raise::<false>(horizon, &row, &beside),
                        Projection::Central { .. } => raise::<true>(horizon, &row, &beside),
                    }
                }
            }
            let [one, other] = &horizons;
            for (hidden, (one, other)) in hidden.iter_mut().zip(one.iter().zip(other)) {
                *hidden += ((one + other) / 2.0_f32).clamp(0.0, 1.0);
            }
        }
        let share = 1.0 / self.rays.len() as f32;
        hidden.iter().map(|hidden| 1.0 - hidden * share).collect()
    }

    /// Returns what the pixels of a row show.
    #[expect(clippy::cast_possible_truncation, reason = "horizons are rough")]
    fn own(&self, y: usize) -> Row {
        let depth: Vec<u32> = self.depths.row(y).iter().collect();
        let points = (0..depth.len()).map(|x| self.depths.point(x, y).unwrap_or_default());
        let points: Vec<_> = points.collect();
        let columns = (0..depth.len()).map(|x| self.depths.ray([x, y])[0] as f32);
        let reach = |z: f64| match self.depths.placement().projection {
            Projection::Parallel => self.reach,
            Projection::Central { .. } => -z * self.reach,
        };
        Row {
            x: points.iter().map(|point| point.x as f32).collect(),
            y: points.iter().map(|point| point.y as f32).collect(),
            z: points.iter().map(|point| point.z as f32).collect(),
            reach: { points.iter() }
                .map(|point| reach(point.z).powi(-2) as f32)
                .collect(),
            depth,
            across: columns.collect(),
        }
    }

    /// Returns the row that lies some columns and rows away; `None` if it lies outside.
    #[expect(clippy::cast_possible_truncation, reason = "horizons are rough")]
    fn beside(&self, y: usize, way: [isize; 2]) -> Option<Beside<'_>> {
        let y = y.checked_add_signed(way[1])?;
        let [far, near] = self.depths.placement().range;
        (y < self.depths.placement().size[1] as usize).then(|| Beside {
            depths: self.depths.row(y),
            way,
            near: near as f32,
            step: ((near - far) / STEPS) as f32,
            across: self.depths.ray([0, y])[1] as f32,
        })
    }
}

/// Raises horizons, the sines of the greatest heights of what is seen, by the pixels that lie beside those of a row; what is
/// far before a pixel does not count.
#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
#[expect(
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    reason = "depths have 22 bits, and pictures are small"
)]
fn raise<const CENTRAL: bool>(horizon: &mut [f32], row: &Row, beside: &Beside<'_>) {
    let width = horizon.len();
    let [right, down] = beside.way;
    let first = right.min(0).unsigned_abs().min(width);
    let there = right.max(0).unsigned_abs().min(width);
    let count = width - first.max(there);
    let [own, there] = [first..first + count, there..there + count];
    let horizon = &mut horizon[own.clone()];
    let (xs, ys, zs) = (
        &row.x[own.clone()],
        &row.y[own.clone()],
        &row.z[own.clone()],
    );
    let (reach, own) = (&row.reach[own.clone()], &row.depth[own]);
    let (across, depths) = (&row.across[there.clone()], beside.depths.part(there));
    let side = [right, -down].map(|way| way as f32 * SAMPLES as f32);
    for (at, depth) in depths.iter().enumerate() {
        let [x, y, z] = if CENTRAL {
            let z = beside.near - depth as i32 as f32 * beside.step;
            [
                -z * across[at] - xs[at],
                z * beside.across - ys[at],
                z - zs[at],
            ]
        } else {
            let z = own[at].wrapping_sub(depth) as i32 as f32 * beside.step;
            [side[0], side[1], z]
        };
        let square = x * x + y * y + z * z;
        let near = square * reach[at];
        let weight = 1.0 - near * near;
        let height = (z / square.sqrt() + 1.0) * weight - 1.0;
        let counts = depth != NOTHING && weight > 0.0 && height > horizon[at];
        horizon[at] = if counts { height } else { horizon[at] };
    }
}
