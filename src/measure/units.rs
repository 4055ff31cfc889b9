//! Results of measurements in other units of length.

use super::box_counting::BoxCounting;
use super::mass::Lacunarity;
use super::regression::Estimate;
use super::spectrum::Generalised;

impl Estimate {
    /// Returns the result for the set enlarged by `ratio`.
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
    /// Returns the result for the set enlarged by `ratio`.
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
    /// Returns the result for the set enlarged by `ratio`.
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
    /// Returns the result for the set enlarged by `ratio`.
    #[must_use]
    pub fn enlarged(self, ratio: f64) -> Self {
        Self {
            size: self.size * ratio,
            ..self
        }
    }
}
