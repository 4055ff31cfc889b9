//! What has been measured, in units of another size.

use super::box_counting::BoxCounting;
use super::mass::Lacunarity;
use super::regression::Estimate;
use super::spectrum::Generalised;

impl Estimate {
    /// The same for a set that is so many times as large.
    #[must_use]
    pub fn enlarged(self, ratio: f64) -> Self {
        Self {
            range: self.range.map(|size| size * ratio),
            intercept: self.intercept + self.value * libm::log(ratio),
            ..self
        }
    }
}

impl BoxCounting {
    /// The same for a set that is so many times as large.
    #[must_use]
    pub fn enlarged(mut self, ratio: f64) -> Self {
        self.estimate = self.estimate.map(|estimate| estimate.enlarged(ratio));
        for boxes in &mut self.boxes {
            boxes.size *= ratio;
        }
        self
    }
}

impl Generalised {
    /// The same for a set that is so many times as large.
    #[must_use]
    pub fn enlarged(mut self, ratio: f64) -> Self {
        self.estimate = self.estimate.map(|estimate| estimate.enlarged(ratio));
        for (size, _) in &mut self.entropies {
            *size *= ratio;
        }
        self
    }
}

impl Lacunarity {
    /// The same for a set that is so many times as large.
    #[must_use]
    pub fn enlarged(self, ratio: f64) -> Self {
        Self {
            size: self.size * ratio,
            ..self
        }
    }
}
