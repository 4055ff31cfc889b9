//! Planes of parameters, and maps of them.

use std::num::NonZero;
use std::sync::atomic::AtomicBool;

use super::{Family, PlaneValue, Property};
use crate::grow::Progress;
use crate::parallel::{all_cores, for_each, is_cancelled};

use super::property::Evaluator;

/// Largest number of pixels of a map.
const MAX_PIXELS: u64 = 1 << 26;

/// Range of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterRange {
    /// Name of the parameter.
    pub name: String,
    /// Value at the left or lower edge.
    pub from: f64,
    /// Value at the right or upper edge.
    pub to: f64,
}

/// Rectangle of values of two parameters, or strip of values of one, divided into pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterPlane {
    axes: Vec<ParameterRange>,
    size: [u32; 2],
}

/// Error: a plane of parameters or its map cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlaneError {
    /// There are no axes, or more than two.
    #[error("a map has one or two real parameters, or one complex one, not {0} real ones")]
    Axes(usize),
    /// A range is empty or not finite.
    #[error("the range of '{0}' has two ends that differ")]
    Range(String),
    /// Two axes have the same name.
    #[error("'{0}' varies along one axis only")]
    Twice(String),
    /// There are too many pixels.
    #[error("a map has up to {MAX_PIXELS} pixels, not {} x {}", .0[0], .0[1])]
    TooManyPixels([u32; 2]),
    /// The computation was cancelled.
    #[error("the computation was cancelled")]
    Cancelled,
}

impl ParameterPlane {
    /// Creates a plane from one or two axes, the first of which runs to the right and the second up, and width and height
    /// in pixels. With one axis, all rows are equal.
    ///
    /// # Errors
    ///
    /// Returns an error for another number of axes, an empty or infinite range, an axis that is repeated, and more than 67
    /// million pixels or none.
    pub fn new(axes: Vec<ParameterRange>, size: [u32; 2]) -> Result<Self, PlaneError> {
        if !(1..=2).contains(&axes.len()) {
            return Err(PlaneError::Axes(axes.len()));
        }
        for axis in &axes {
            let is_range = axis.from != axis.to && (axis.to - axis.from).is_finite();
            if !is_range {
                return Err(PlaneError::Range(axis.name.clone()));
            }
        }
        if let [first, second] = &axes[..]
            && first.name == second.name
        {
            return Err(PlaneError::Twice(first.name.clone()));
        }
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        if !(1..=MAX_PIXELS).contains(&pixels) {
            return Err(PlaneError::TooManyPixels(size));
        }
        Ok(Self { axes, size })
    }

    /// Returns the axes.
    #[must_use]
    pub fn axes(&self) -> &[ParameterRange] {
        &self.axes
    }

    /// Returns width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the values of the parameters at the centre of a pixel, by its column from the left and its row from the
    /// top. Pixels at the same distance from the middle of a range around 0 have opposite values, to the last bit.
    #[must_use]
    pub fn values(&self, column: u32, row: u32) -> [f64; 2] {
        let [width, height] = self.size;
        let places = [(column, width), (height - 1 - row, height)];
        let mut values = [0.0; 2];
        for ((value, axis), (place, count)) in values.iter_mut().zip(&self.axes).zip(places) {
            let after = f64::from(place) + 0.5;
            let before = f64::from(count) - after;
            *value = (axis.from * before + axis.to * after) / f64::from(count);
        }
        values
    }
}

/// Options of a map.
#[derive(Clone, Copy, Debug)]
pub struct MapOptions<'a> {
    /// Property that is computed.
    pub property: Property,
    /// Depth: see [`Property::depth`].
    pub depth: u32,
    /// Number of threads. The map does not depend on it.
    pub threads: NonZero<usize>,
    /// Counts the pixels.
    pub progress: Option<&'a Progress>,
    /// Flag that cancels the computation.
    pub cancel: Option<&'a AtomicBool>,
}

impl MapOptions<'_> {
    /// Returns the default options for a property: its default depth, and all cores.
    #[must_use]
    pub fn new(property: Property) -> Self {
        Self {
            property,
            depth: property.depth(),
            threads: all_cores(),
            progress: None,
            cancel: None,
        }
    }
}

/// Map of a plane of parameters: a property of the member of a family at each pixel.
#[derive(Clone, Debug)]
pub struct ParameterMap {
    pub(super) plane: ParameterPlane,
    pub(super) property: Property,
    pub(super) depth: u32,
    pub(super) values: Vec<PlaneValue>,
}

impl ParameterMap {
    /// Computes a map. The axes of the plane are the parameters of the family, in their order.
    ///
    /// # Errors
    ///
    /// Returns an error if the number of axes is not that of the family's parameters, or if the computation is cancelled.
    pub fn compute(
        family: &Family,
        plane: &ParameterPlane,
        options: &MapOptions<'_>,
    ) -> Result<Self, PlaneError> {
        let [width, height] = plane.size;
        let count = plane.axes.len();
        if count != family.names().len() {
            return Err(PlaneError::Axes(count));
        }
        // Rows of a strip are equal.
        let rows = if count == 1 { 1 } else { height };
        let mut values = vec![PlaneValue::NoSystem; width as usize * rows as usize];
        if let Some(progress) = options.progress {
            progress.expect(values.len() as u64);
        }
        let parts = (0..rows).zip(values.chunks_mut(width as usize));
        for_each(parts, options.threads.get(), |(row, values)| {
            if is_cancelled(options.cancel) {
                return;
            }
            let mut member = family.member();
            let mut evaluator = Evaluator::new(options.property, options.depth);
            for (column, value) in (0..width).zip(&mut *values) {
                let at = plane.values(column, row);
                if let Some(maps) = member.at(&at[..count]) {
                    *value = evaluator.value(maps);
                }
            }
            if let Some(progress) = options.progress {
                progress.count(values.len() as u64);
            }
        });
        if is_cancelled(options.cancel) {
            return Err(PlaneError::Cancelled);
        }
        if count == 1 {
            values = values.repeat(height as usize);
        }
        Ok(Self {
            plane: plane.clone(),
            property: options.property,
            depth: options.depth,
            values,
        })
    }

    /// Returns the plane.
    #[must_use]
    pub fn plane(&self) -> &ParameterPlane {
        &self.plane
    }

    /// Returns the value at a pixel, by its column from the left and its row from the top.
    ///
    /// # Panics
    ///
    /// Panics outside of the map.
    #[must_use]
    pub fn value(&self, column: u32, row: u32) -> PlaneValue {
        self.values[row as usize * self.plane.size[0] as usize + column as usize]
    }

    /// Returns the values in rows from the top, each from the left.
    #[must_use]
    pub fn values(&self) -> &[PlaneValue] {
        &self.values
    }
}
