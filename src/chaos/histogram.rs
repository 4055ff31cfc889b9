//! Counts of the points of random iteration, by pixel and class.

use crate::geometry::DAffine2;

use super::tally::Counter;

/// A part of the plane, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HistogramWindow {
    /// Map from the plane to pixels, which run right and down from the upper left corner.
    pub to_pixels: DAffine2,
    /// Width and height in pixels, 1 to 2²² each.
    pub size: [u32; 2],
}

/// Number of points of walks in each pixel of a window, for each class of points. Counts saturate at 2³² − 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Histogram {
    size: [u32; 2],
    classes: usize,
    points: u64,
    /// Pixels of every class, each class followed by a bin for points outside.
    counts: Vec<u32>,
}

impl Histogram {
    pub(super) fn new(size: [u32; 2], classes: usize, points: u64, counts: Vec<u32>) -> Self {
        Self {
            size,
            classes,
            points,
            counts,
        }
    }

    /// Returns the width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the number of classes.
    #[must_use]
    pub fn classes(&self) -> usize {
        self.classes
    }

    /// Returns the counts of a class, row by row from the upper left corner; empty if there is no such class.
    #[must_use]
    pub fn counts(&self, class: usize) -> &[u32] {
        let stride = self.counts.len() / self.classes;
        let bins = self.counts.chunks_exact(stride).nth(class);
        bins.map_or(&[], |bins| &bins[..stride - 1])
    }

    /// Returns the number of points, including those outside.
    #[must_use]
    pub fn points(&self) -> u64 {
        self.points
    }

    /// Returns the number of points in the window; a count that has saturated counts as 2³² − 1.
    #[must_use]
    pub fn inside(&self) -> u64 {
        let classes = (0..self.classes).map(|class| self.counts(class));
        classes.flatten().map(|&count| u64::from(count)).sum()
    }
}

/// Counters of the pixels of every class.
pub(super) struct Counts(pub(super) Vec<u32>);

impl Counter for Counts {
    /// Number of a bin.
    type Spot = u32;

    #[inline(always)]
    fn add(&mut self, bins: &[u32]) {
        for &bin in bins {
            if let Some(count) = self.0.get_mut(bin as usize) {
                *count += 1;
            }
        }
    }

    fn merge(&mut self, other: Self) {
        for (all, count) in self.0.iter_mut().zip(other.0) {
            *all = all.saturating_add(count);
        }
    }
}
