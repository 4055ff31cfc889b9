//! Area that an attractor covers at most.

use std::ops::RangeInclusive;

use super::connectedness::{Centred, Connectedness, Shrunk};
use crate::geometry::{DAffine2, DVec2};

/// Limit of the number of boxes that are mapped.
const MAX_MAPPED: u64 = 1 << 26;

/// Largest depth: 1024 boxes a side.
const MAX_DEPTH: u32 = 10;

/// Returns an upper bound of the area (Lebesgue measure) of the attractor of maps: the area of a cover by boxes.
///
/// A square about the attractor is divided `depth` times into four, at most ten times. The cover is the largest set of
/// these 4^`depth` boxes in which each meets the image of another or itself; it contains the attractor, and is found by
/// subdivision and selection (Dellnitz & Hohmann, "A subdivision algorithm for the computation of unstable manifolds and
/// global attractors", 1997). An image counts as the box with horizontal and vertical sides about it. For an attractor
/// without area the bound falls to 0 as the depth grows, slowly where its dimension is near 2.
///
/// # Errors
///
/// Returns [`Connectedness::DoesNotContract`] if the system does not contract, and [`Connectedness::Undecided`] if no disc
/// about the attractor is found.
pub fn covered_area(maps: &[DAffine2], depth: u32) -> Result<f64, Connectedness> {
    let mut budget = 1 << 16;
    let centred = Centred::of(&Shrunk::of(maps)?, &mut budget)?;
    let mut cover = Cover::of(&centred);
    for _ in 0..depth.min(MAX_DEPTH) {
        cover.divide();
        while cover.mapped < MAX_MAPPED && cover.select() {}
    }
    let side = 2.0 * centred.radius / f64::from(cover.side);
    let boxes = cover.boxes.iter().map(|is_in| f64::from(u8::from(*is_in)));
    let area = boxes.sum::<f64>() * side * side;
    Ok(area / centred.coordinates.determinant().abs())
}

/// Boxes of a square grid in a square about the origin.
struct Cover<'a> {
    maps: &'a [DAffine2],
    radius: f64,
    /// Margin for rounding errors, in units of the radius.
    margin: f64,
    /// Number of boxes a side.
    side: u32,
    boxes: Vec<bool>,
    /// Number of boxes that have been mapped.
    mapped: u64,
}

impl<'a> Cover<'a> {
    fn of(centred: &'a Centred) -> Self {
        Self {
            maps: &centred.maps,
            radius: centred.radius,
            margin: 1e-9 + centred.error / centred.radius,
            side: 1,
            boxes: vec![true],
            mapped: 0,
        }
    }

    /// Divides each box into four.
    fn divide(&mut self) {
        let (old, side) = (self.side as usize, 2 * self.side as usize);
        let place = |number: usize| number / side / 2 * old + number % side / 2;
        self.boxes = (0..side * side).map(|it| self.boxes[place(it)]).collect();
        self.side *= 2;
    }

    /// Removes the boxes that meet no image of a box. Returns whether there were any.
    fn select(&mut self) -> bool {
        let side = self.side as usize;
        let unit = 2.0 / f64::from(self.side);
        let mut met = vec![false; self.boxes.len()];
        let mut first = 0;
        while let Some(number) = self.boxes[first..].iter().position(|it| *it) {
            let number = first + number;
            first = number + 1;
            let [column, row] = [number % side, number / side].map(|it| self.centre(it));
            for map in self.maps {
                // In units of the radius.
                let shift = map.translation / self.radius;
                let image = map.matrix2 * DVec2::new(column, row) + shift;
                let (x, y) = (map.matrix2.x_axis.abs(), map.matrix2.y_axis.abs());
                let half = (x + y) * (unit / 2.0);
                let rows = self.range(image.y, half.y);
                let columns = self.range(image.x, half.x);
                for row in rows {
                    met[row * side + columns.start()..=row * side + columns.end()].fill(true);
                }
            }
            self.mapped += self.maps.len() as u64;
        }
        let mut has_removed = false;
        for (own, met) in self.boxes.iter_mut().zip(met) {
            has_removed |= *own && !met;
            *own &= met;
        }
        has_removed
    }

    /// Returns the coordinate of the centre of a box, in units of the radius.
    fn centre(&self, number: usize) -> f64 {
        let number = u32::try_from(number).unwrap_or(u32::MAX);
        (2.0 * f64::from(number) + 1.0) / f64::from(self.side) - 1.0
    }

    /// Returns the numbers of the boxes that an interval meets.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "numbers are clamped to the grid"
    )]
    fn range(&self, centre: f64, half: f64) -> RangeInclusive<usize> {
        let half = half + self.margin;
        let most = f64::from(self.side) - 1.0;
        let number = |at: f64| (((at + 1.0) / 2.0 * f64::from(self.side)).floor()).clamp(0.0, most);
        number(centre - half) as usize..=number(centre + half) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DMat2;

    fn toward(corners: &[[f64; 2]], ratio: f64) -> Vec<DAffine2> {
        let linear = DMat2::from_diagonal(DVec2::splat(ratio));
        let map = |corner: &[f64; 2]| {
            DAffine2::from_mat2_translation(linear, (1.0 - ratio) * DVec2::from(*corner))
        };
        corners.iter().map(map).collect()
    }

    #[test]
    fn a_square_has_its_area_and_a_gasket_none() {
        let square = toward(&[[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [3.0, 3.0]], 0.5);
        let gasket = toward(&[[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]], 0.5);
        let areas = |maps: &[DAffine2]| [4, 6, 8].map(|depth| covered_area(maps, depth).unwrap());
        let [rough, finer, finest] = areas(&square);
        assert!(
            rough >= finer && finer >= finest,
            "{rough} {finer} {finest}"
        );
        assert!((9.0..9.6).contains(&finest), "{finest}");
        // Each further division leaves about three quarters of the boxes.
        let [rough, finer, finest] = areas(&gasket);
        assert!(
            rough > 1.6 * finer && finer > 1.6 * finest,
            "{rough} {finer} {finest}"
        );
        let one = [DAffine2::from_mat2(2.0 * DMat2::IDENTITY)];
        assert_eq!(covered_area(&one, 4), Err(Connectedness::DoesNotContract));
    }
}
