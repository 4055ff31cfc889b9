//! The shape at the size at which copies of it are searched.

use crate::Bits;
use crate::geometry::{DAffine2, DVec2};

use super::super::Silhouette;
use super::super::orbit::Level;
use super::super::shape::{distances, place};

/// A shape in cells, with a sample of its cells and the distance of every cell from it.
pub(in crate::fit) struct Ground {
    level: Level,
    /// Centres of cells of the shape, each farthest from those before it.
    points: Vec<DVec2>,
    /// Centres of all cells of the shape.
    cells: Vec<DVec2>,
    distances: Vec<f32>,
    nearest: Vec<DVec2>,
    /// Distance of every cell from the complement of the shape.
    depths: Vec<f32>,
    width: usize,
    height: usize,
    middle: DVec2,
    radius: f64,
}

impl Ground {
    /// Creates the ground of a shape, of at most `side` cells, with a sample of `sample` cells; `None` without cells.
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    pub(in crate::fit) fn new(shape: &Silhouette, side: usize, sample: usize) -> Option<Self> {
        let level = Level::new(shape, side);
        let bits = level.cells();
        let (width, height) = (bits.width(), bits.height());
        let map = distances(bits)?;
        let complement = Bits::of(width, height, |column, row| !bits.get(column, row));
        let depths = distances(&complement)?;
        let depths = depths
            .squared()
            .iter()
            .map(|&square| libm::sqrtf(square as f32) - 0.5);
        let centre = |[column, row]: [usize; 2]| DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        let cells: Vec<DVec2> = bits.set_boxes().map(centre).collect();
        let distances = map
            .squared()
            .iter()
            .map(|&square| libm::sqrtf(square as f32));
        let nearest = map
            .nearest()
            .iter()
            .map(|&index| centre(place(index, width)));
        let there = level.there();
        Some(Self {
            distances: distances.collect(),
            nearest: nearest.collect(),
            depths: depths.collect(),
            points: spread_out(&cells, sample),
            width,
            height,
            middle: there.transform_point2(shape.middle()),
            radius: shape.radius() * level.scale(),
            cells,
            level,
        })
    }

    pub(in crate::fit) fn points(&self) -> &[DVec2] {
        &self.points
    }

    pub(in crate::fit) fn cells(&self) -> &[DVec2] {
        &self.cells
    }

    /// Returns the middle of the shape's box, in cells.
    pub(in crate::fit) fn middle(&self) -> DVec2 {
        self.middle
    }

    /// Returns half the diagonal of the shape's box, in cells.
    pub(in crate::fit) fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the index of the cell of a point, or of the cell nearest to it, and their distance.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "clamped to the cells"
    )]
    fn cell(&self, point: DVec2) -> (usize, f64) {
        let [most_x, most_y] = [self.width as f64 - 0.5, self.height as f64 - 0.5];
        let inside = DVec2::new(point.x.clamp(0.5, most_x), point.y.clamp(0.5, most_y));
        let index = inside.y as usize * self.width + inside.x as usize;
        (index, (point - inside).abs().max_element())
    }

    /// Returns the distance of a point from the shape, in cells, to the accuracy of the cells.
    #[inline]
    pub(in crate::fit) fn distance(&self, point: DVec2) -> f64 {
        let (index, away) = self.cell(point);
        f64::from(self.distances[index]) + away
    }

    /// Returns the radius of the largest disk about a point that lies in the shape, in cells.
    pub(in crate::fit) fn depth(&self, point: DVec2) -> f64 {
        f64::from(self.depths[self.cell(point).0]).max(0.0)
    }

    /// Returns the point of the shape that is nearest to a point: the point itself in a cell of the shape, or else the
    /// centre of the nearest cell.
    #[inline]
    pub(in crate::fit) fn nearest(&self, point: DVec2) -> DVec2 {
        let (index, away) = self.cell(point);
        if away == 0.0 && self.distances[index] == 0.0 {
            point
        } else {
            self.nearest[index]
        }
    }

    /// Returns the number of cells in a pixel along an axis.
    pub(in crate::fit) fn scale(&self) -> f64 {
        self.level.scale()
    }

    /// Returns the map from cells to pixels.
    pub(in crate::fit) fn back(&self) -> &DAffine2 {
        self.level.back()
    }

    /// Returns a map of cells as a map of the picture.
    pub(in crate::fit) fn outward(&self, map: &DAffine2) -> DAffine2 {
        *self.level.back() * *map * *self.level.there()
    }

    /// Returns a map of the picture as a map of cells.
    pub(in crate::fit) fn inward(&self, map: &DAffine2) -> DAffine2 {
        *self.level.there() * *map * *self.level.back()
    }
}

/// Returns up to `count` points, each of which is farthest from those before it; the first is farthest from the mean.
#[expect(clippy::cast_precision_loss, reason = "pictures are small")]
fn spread_out(points: &[DVec2], count: usize) -> Vec<DVec2> {
    // Of many points, every k-th is enough.
    let step = points.len().div_ceil(4096).max(1);
    let some: Vec<DVec2> = points.iter().copied().step_by(step).collect();
    let mean = some.iter().sum::<DVec2>() / some.len() as f64;
    let mut away: Vec<f64> = some.iter().map(|it| it.distance_squared(mean)).collect();
    let mut chosen = Vec::with_capacity(count.min(some.len()));
    while chosen.len() < count.min(some.len()) {
        let farthest = (0..some.len()).max_by(|&a, &b| away[a].total_cmp(&away[b]));
        let Some(farthest) = farthest else { break };
        let point = some[farthest];
        let is_first = chosen.is_empty();
        chosen.push(point);
        for (away, other) in away.iter_mut().zip(&some) {
            let own = other.distance_squared(point);
            *away = if is_first { own } else { away.min(own) };
        }
    }
    chosen
}
