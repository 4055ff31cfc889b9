//! The shape of a picture that is to be fitted.

use std::num::NonZero;

use crate::Bits;
use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::morphology::DistanceMap;
use crate::saturating::{real, whole};

use super::FitError;

/// A picture as the set of its pixels that belong to the shape.
///
/// Coordinates are pixels, x to the right and y up, from the lower left corner of the picture: the centre of the
/// pixel in column i and row j (from the top, both from 0) of a picture of height h lies at (i + 0.5, h − j − 0.5).
///
/// Guarantee: at least two pixels belong to the shape, and at least one does not.
#[derive(Clone, Debug)]
pub struct Silhouette {
    bits: Bits,
    points: Vec<DVec2>,
    bounds: Bounds,
    /// Values of the points, if they have any.
    values: Option<Vec<f64>>,
}

/// Limit of the number of pixels of a picture.
const MAX_PIXELS: usize = 1 << 26;
/// Limit of the number of pixels of a side.
const MAX_SIDE: usize = 1 << 15;

impl Silhouette {
    /// Creates the shape of the pixels that are set.
    ///
    /// # Errors
    ///
    /// Returns an error if no pixel is set, only one, or all, or if the picture has more than 2²⁶ pixels,
    /// or more than 2¹⁵ on a side.
    pub fn new(bits: Bits) -> Result<Self, FitError> {
        let [width, height] = [bits.width(), bits.height()];
        if width.saturating_mul(height) > MAX_PIXELS || width.max(height) > MAX_SIDE {
            return Err(FitError::TooLarge { width, height });
        }
        let points: Vec<DVec2> = bits
            .set_boxes()
            .map(|place| centre(place, height))
            .collect();
        match points.len() {
            0 => return Err(FitError::Empty),
            1 => return Err(FitError::OnePixel),
            count if count == width * height => return Err(FitError::Full),
            _ => {}
        }
        let mut bounds = Bounds::EMPTY;
        points.iter().for_each(|&point| bounds.add(point));
        Ok(Self {
            bits,
            points,
            bounds,
            values: None,
        })
    }

    /// Returns the shape with a value of each pixel of the picture, in rows from the top: a measure, which is 0 outside the
    /// shape. The weights of the maps are then fitted to it.
    ///
    /// # Errors
    ///
    /// Returns an error if there are not as many values as pixels, or if all values of the shape are 0.
    pub fn with_values(mut self, values: &[u8]) -> Result<Self, FitError> {
        let [width, height] = self.size();
        if values.len() != width * height {
            return Err(FitError::Values {
                values: values.len(),
                width,
                height,
            });
        }
        let own = self.bits.set_boxes();
        let own: Vec<f64> = own
            .map(|[column, row]| f64::from(values[row * width + column]))
            .collect();
        if own.iter().all(|&value| value == 0.0) {
            return Err(FitError::Empty);
        }
        self.values = Some(own);
        Ok(self)
    }

    /// Returns whether the pixels have values.
    #[must_use]
    pub fn has_values(&self) -> bool {
        self.values.is_some()
    }

    /// Iterates over the centres of the pixels of the shape with their values, 1 where they have none.
    pub(super) fn masses(&self) -> impl Iterator<Item = (DVec2, f64)> {
        let values = self.values.as_deref();
        let value = move |number| values.map_or(1.0, |values: &[f64]| values[number]);
        let points = self.points.iter().enumerate();
        points.map(move |(number, &point)| (point, value(number)))
    }

    /// Returns the shape in a picture without margins, and the shift of its coordinates to those of this one.
    pub(super) fn cropped(&self) -> (Self, DAffine2) {
        let height = self.size()[1];
        let [low, high] = [self.bounds.min() - 0.5, self.bounds.max() + 0.5];
        let size = (high - low).to_array().map(whole);
        let top = height - whole(high.y);
        let corner = [whole(low.x), top].map(usize::cast_signed);
        let points = self.points.iter().map(|&point| point - low).collect();
        let mut bounds = Bounds::EMPTY;
        for corner in [self.bounds.min(), self.bounds.max()] {
            bounds.add(corner - low);
        }
        let cropped = Self {
            bits: self.bits.window(corner, size[0], size[1]),
            points,
            bounds,
            values: self.values.clone(),
        };
        (cropped, DAffine2::from_translation(low))
    }

    /// Returns the shape in a picture of at most `most` pixels along its longer side, whose pixels are those at their centres, and
    /// the factor of its coordinates. A shape of which nothing is left, or no complement, stays as it is.
    #[must_use]
    pub fn reduced(&self, most: usize) -> (Self, f64) {
        let size = self.size();
        let longer = size[0].max(size[1]);
        if longer <= most {
            return (self.clone(), 1.0);
        }
        let factor = real(most) / real(longer);
        let [width, height] = size.map(|side| whole((real(side) * factor).ceil()));
        let bits = Bits::of(width, height, |column, row| {
            let from = centre([column, row], height) / factor;
            let [column, row] = [whole(from.x), whole(real(size[1]) - from.y)];
            from.y <= real(size[1])
                && column < size[0]
                && row < size[1]
                && self.bits.get(column, row)
        });
        match Self::new(bits) {
            Ok(reduced) => (reduced, factor),
            Err(_) => (self.clone(), 1.0),
        }
    }

    /// Returns the pixels, in rows from the top.
    #[must_use]
    pub fn bits(&self) -> &Bits {
        &self.bits
    }

    /// Returns the centres of the pixels that belong to the shape, in rows from the top.
    #[must_use]
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// Returns the box of the centres.
    #[must_use]
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Returns width and height of the picture in pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.bits.width(), self.bits.height()]
    }

    /// Returns half the diagonal of the box of the centres.
    pub(super) fn radius(&self) -> f64 {
        self.bounds.size().length() / 2.0
    }

    /// Returns the middle of the box of the centres.
    pub(super) fn middle(&self) -> DVec2 {
        (self.bounds.min() + self.bounds.max()) / 2.0
    }
}

/// Returns the distances to a set of pixels, with the pixel nearest to each; `None` for an empty set.
pub(super) fn distances(bits: &Bits) -> Option<DistanceMap> {
    DistanceMap::to(bits, NonZero::<usize>::MIN).ok()
}

/// Returns column and row of a pixel from its index along the rows.
pub(super) fn place(index: u32, width: usize) -> [usize; 2] {
    let index = index as usize;
    [index % width, index / width]
}

/// Returns the centre of a pixel in a picture of a height.
#[expect(clippy::cast_precision_loss, reason = "pictures are small")]
pub(super) fn centre([column, row]: [usize; 2], height: usize) -> DVec2 {
    DVec2::new(column as f64 + 0.5, height as f64 - row as f64 - 0.5)
}
