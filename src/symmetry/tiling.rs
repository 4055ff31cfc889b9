//! Wallpapers and friezes: the copies of a motif under a plane group that meet a window.

use crate::geometry::{Bounds, DAffine2, DMat2, DVec2};

use super::groups::{Definition, Lattice, Position, TilingGroup, position};
use super::linear;

/// Number of parts of the longer period of which the shorter one is a multiple.
const PARTS: f64 = 1024.0;

/// Size of a picture of one period of a hexagonal lattice, whose sides 1 : √3 it approximates to 2·10⁻⁶.
const HEXAGONAL: [u32; 2] = [571, 989];

/// Space above and below a frieze, as a fraction of its height.
const EDGE: f64 = 0.04;

/// Limit of the number of copies.
const MOST: f64 = 20_000.0;

/// Error: more than 20,000 copies meet a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "more than {} copies meet the window; larger cells or a smaller window have fewer",
    MOST
)]
pub struct TooManyCopies;

/// Placement of a motif in the plane under a wallpaper or frieze group.
///
/// The motif keeps its size and its place. Its box is inscribed in a fundamental domain of the group, so that the boxes of
/// copies do not overlap: the cell is the smallest one in which that is possible. Sides of rectangular cells are those of
/// the domain that is the box, the shorter one rounded up to a multiple of 1/1024 of the longer one.
#[derive(Clone, Debug)]
pub struct Tiling {
    motif: Bounds,
    /// Vectors of the lattice as columns; the second one is no period of a frieze.
    vectors: DMat2,
    origin: DVec2,
    is_frieze: bool,
    is_hexagonal: bool,
    positions: Vec<Position>,
}

impl Tiling {
    /// Creates the tiling of a motif with a bounding box. The vectors of its lattice are `scale` times as long as those for
    /// which boxes touch.
    #[must_use]
    pub fn new(group: TilingGroup, motif: &Bounds, scale: f64) -> Self {
        let definition = group.definition();
        let least = motif.size().max_element();
        let least = if least > 0.0 { least } else { 1.0 };
        // A motif without extent across has copies, too.
        let size = motif.size().max(DVec2::splat(least / 64.0));
        let (vectors, middle) = match definition.lattice {
            Lattice::Rectangular | Lattice::Frieze => rectangular(definition, size, scale),
            Lattice::Square => inscribed(definition, DMat2::IDENTITY, size, scale),
            Lattice::Hexagonal => {
                let up = DVec2::new(-0.5, 0.75_f64.sqrt());
                inscribed(definition, DMat2::from_cols(DVec2::X, up), size, scale)
            }
        };
        Self {
            motif: *motif,
            origin: motif.centre() - vectors * middle,
            vectors,
            is_frieze: definition.lattice == Lattice::Frieze,
            is_hexagonal: definition.lattice == Lattice::Hexagonal,
            positions: definition
                .positions
                .iter()
                .map(|text| position(text))
                .collect(),
        }
    }

    /// Returns the vectors of the lattice. The second one of a frieze is no period.
    #[must_use]
    pub fn vectors(&self) -> [DVec2; 2] {
        [self.vectors.x_axis, self.vectors.y_axis]
    }

    /// Returns a window of `count` periods along both axes: its lower left corner, its width and its height. A frieze
    /// has periods along the x axis only, and is shown from its lower to its upper edge, in whole pixels of
    /// [`size`](Self::size).
    #[must_use]
    pub fn window(&self, count: u32) -> [f64; 4] {
        let [a, b] = self.vectors();
        let count = f64::from(count);
        let DVec2 { x, y } = self.origin;
        if self.is_frieze {
            let (middle, height) = self.across();
            let height = (height / self.pixel()).ceil() * self.pixel();
            return [x, middle - height / 2.0, a.x * count, height];
        }
        let rows = if self.is_hexagonal { 2.0 } else { 1.0 };
        [x, y, a.x * count, rows * b.y * count]
    }

    /// Returns the size, in pixels, of a picture of [one period](Self::window) whose opposite edges continue each other. Its
    /// long side has about 1024 pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        if self.is_hexagonal {
            return HEXAGONAL;
        }
        let [_, _, width, height] = self.window(1);
        let pixel = match self.is_frieze {
            true => self.pixel(),
            false => width.max(height) / PARTS,
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number of parts of about the long side"
        )]
        let pixels = |side: f64| (side / pixel).round().max(1.0) as u32;
        [pixels(width), pixels(height)]
    }

    /// Returns the side of a pixel, of which a frieze has a whole number along a period and about 1024 along its longer side.
    fn pixel(&self) -> f64 {
        let (_, height) = self.across();
        let period = self.vectors.x_axis.x;
        period / (PARTS * (period / height).min(1.0)).floor().max(1.0)
    }

    /// Returns the middle of a frieze and its height with the space above and below.
    fn across(&self) -> (f64, f64) {
        let isometries = self
            .positions
            .iter()
            .map(|position| self.isometry(position, DVec2::ZERO));
        let mut all = Bounds::EMPTY;
        for image in isometries.map(|isometry| image(&isometry, &self.motif)) {
            all.add(image.min());
            all.add(image.max());
        }
        let height = all.size().y.max(self.vectors.x_axis.x / 64.0);
        (all.centre().y, height * (1.0 + 2.0 * EDGE))
    }

    /// Returns the isometries under which the image of the motif's box, with a quarter of its size around it, meets a window.
    ///
    /// # Errors
    ///
    /// If there are more than 20,000.
    pub fn isometries(&self, window: &Bounds) -> Result<Vec<DAffine2>, TooManyCopies> {
        let back = self.vectors.inverse();
        let mut all = Vec::new();
        for position in &self.positions {
            let first = self.isometry(position, DVec2::ZERO);
            let image = image(&first, &self.motif);
            let pad = image.size() / 4.0;
            let [low, high] = [image.min() - pad, image.max() + pad];
            // Translations that lead the image into the window lie in a rectangle.
            let [from, to] = [window.min() - high, window.max() - low];
            let corners = [from, to, DVec2::new(from.x, to.y), DVec2::new(to.x, from.y)];
            let corners = corners.map(|corner| back * corner);
            let least = corners.into_iter().fold(corners[0], DVec2::min).ceil();
            let most = corners.into_iter().fold(corners[0], DVec2::max).floor();
            let (least, most) = match self.is_frieze {
                true => (DVec2::new(least.x, 0.0), DVec2::new(most.x, 0.0)),
                false => (least, most),
            };
            let count = (most - least + 1.0).max(DVec2::ZERO);
            let count = count.x * count.y;
            if count.is_nan() || count > MOST {
                return Err(TooManyCopies);
            }
            let mut across = least.y;
            while across <= most.y {
                let mut along = least.x;
                while along <= most.x {
                    let steps = DVec2::new(along, across);
                    let shift = self.vectors * steps;
                    if shift.cmpge(from).all() && shift.cmple(to).all() {
                        all.push(self.isometry(position, steps));
                    }
                    along += 1.0;
                }
                across += 1.0;
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        match all.len() as f64 <= MOST {
            true => Ok(all),
            false => Err(TooManyCopies),
        }
    }

    /// Returns the isometry of a general position, with a translation by integral multiples of the vectors.
    fn isometry(&self, &(rows, shift): &Position, steps: DVec2) -> DAffine2 {
        let [[a, b], [c, d]] = rows;
        let matrix = DMat2::from_cols(DVec2::new(a, c), DVec2::new(b, d));
        // The image of the x axis is at a multiple of 30 degrees.
        let along = self.vectors * matrix.x_axis;
        let turn = (libm::atan2(along.y, along.x).to_degrees() / 30.0).round() * 30.0;
        let linear = linear(turn, matrix.determinant());
        let shift = self.vectors * (steps + DVec2::from_array(shift));
        let centre = self.origin - linear * self.origin;
        DAffine2::from_mat2_translation(linear, centre + shift)
    }
}

/// Returns the bounding box of the image of a box.
fn image(isometry: &DAffine2, motif: &Bounds) -> Bounds {
    let [low, high] = [motif.min(), motif.max()];
    let mut all = Bounds::EMPTY;
    for corner in [
        low,
        high,
        DVec2::new(low.x, high.y),
        DVec2::new(high.x, low.y),
    ] {
        all.add(isometry.transform_point2(corner));
    }
    all
}

/// Rounds the shorter of two lengths up to a multiple of a 1024th of the longer one.
fn in_parts(a: f64, b: f64) -> (f64, f64) {
    let part = a.max(b) / PARTS;
    // Rounding does not add a part.
    let up = |length: f64| (length / part - 1e-9).ceil() * part;
    if a < b { (up(a), b) } else { (a, up(b)) }
}

/// Returns the vectors of the lattice whose domain, a rectangle, is a box of some size, and the middle of the domain in
/// multiples of them.
fn rectangular(definition: &Definition, size: DVec2, scale: f64) -> (DMat2, DVec2) {
    let [low, high] = [definition.domain[0], definition.domain[2]].map(DVec2::from_array);
    let share = high - low;
    let (width, height) = (scale * size.x / share.x, scale * size.y / share.y);
    if definition.lattice == Lattice::Frieze {
        // The domain has no end, so that the vector across has any length: the box lies at the axis, or on it.
        let vectors = DMat2::from_diagonal(DVec2::new(width, size.y));
        let middle = if low.y < 0.0 { 0.0 } else { scale / 2.0 };
        return (vectors, DVec2::new(f64::midpoint(low.x, high.x), middle));
    }
    let (width, height) = in_parts(width, height);
    (
        DMat2::from_diagonal(DVec2::new(width, height)),
        (low + high) / 2.0,
    )
}

/// Returns the vectors of the smallest lattice, similar to a given one, in whose domain a box of some size lies, times a
/// scale, and the place of the middle of the box in multiples of them.
///
/// The middle and the scale are a linear program: the box lies inside of every side. Its optimum is one of the points where three
/// sides meet the box; of several, their mean is taken.
fn inscribed(definition: &Definition, shape: DMat2, size: DVec2, scale: f64) -> (DMat2, DVec2) {
    let corners: Vec<DVec2> = { definition.domain.iter() }
        .map(|&corner| shape * DVec2::from_array(corner))
        .collect();
    let next = corners.iter().cycle().skip(1);
    // The inside of a side with the normal n is where n · x + h ≤ d s, for the middle x, the scale s, and the box's reach h.
    let sides: Vec<(DVec2, f64, f64)> = { corners.iter().zip(next) }
        .map(|(&from, &to)| {
            let normal = -(to - from).perp().normalize();
            (normal, normal.abs().dot(size / 2.0), normal.dot(from))
        })
        .collect();
    let mut best: Vec<(f64, DVec2)> = Vec::new();
    for first in 0..sides.len() {
        for second in 0..first {
            for third in 0..second {
                let [a, b, c] = [sides[first], sides[second], sides[third]];
                let Some((s, middle)) = meeting([a, b, c]) else {
                    continue;
                };
                let is_inside = |&(normal, reach, distance): &(DVec2, f64, f64)| {
                    normal.dot(middle) + reach <= distance * s + 1e-9 * s
                };
                if s > 0.0 && sides.iter().all(is_inside) {
                    best.push((s, middle));
                }
            }
        }
    }
    let least = best.iter().map(|(s, _)| *s).fold(f64::INFINITY, f64::min);
    best.retain(|(s, _)| *s <= least * (1.0 + 1e-9));
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let count = best.len() as f64;
    let middle = best.iter().map(|(_, middle)| *middle).sum::<DVec2>() / count;
    let back = shape.inverse();
    (shape * (least * scale), back * (middle / least))
}

/// Returns the scale and the middle at which a box touches three sides; `None` if no or any scale would do.
fn meeting(sides: [(DVec2, f64, f64); 3]) -> Option<(f64, DVec2)> {
    // n · x − d s = −h, by Cramer's rule.
    let rows = sides.map(|(normal, reach, distance)| ([normal.x, normal.y, -distance], -reach));
    let determinant = |columns: [usize; 3]| {
        let at = |row: usize, column: usize| match columns[column] {
            3 => rows[row].1,
            known => rows[row].0[known],
        };
        let minor = |a: usize, b: usize| at(1, a) * at(2, b) - at(1, b) * at(2, a);
        at(0, 0) * minor(1, 2) - at(0, 1) * minor(0, 2) + at(0, 2) * minor(0, 1)
    };
    let whole = determinant([0, 1, 2]);
    if whole.abs() < 1e-12 {
        return None;
    }
    let [x, y, s] = [[3, 1, 2], [0, 3, 2], [0, 1, 3]].map(|columns| determinant(columns) / whole);
    Some((s, DVec2::new(x, y)))
}

#[cfg(test)]
mod tests;
