//! Options of fits.

use std::num::NonZero;
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::parallel::all_cores;

/// The way in which a system is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// All ways; the best result by the measures is kept.
    #[default]
    Auto,
    /// Copies of the shape that cover it, refined on the attractor.
    Collage,
}

impl Method {
    /// All methods, in the order of their names in help texts.
    pub const ALL: [Self; 2] = [Self::Auto, Self::Collage];

    /// Returns the name of the method.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Collage => "collage",
        }
    }

    /// Returns a description of the method, as a help text.
    #[must_use]
    pub fn described(self) -> &'static str {
        match self {
            Self::Auto => "All methods, of which the best result is kept",
            Self::Collage => "Copies of the shape that cover it, refined on the attractor",
        }
    }
}

/// Options of a fit.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FitOptions {
    /// The method; all of them by default.
    pub method: Method,
    /// Smallest and largest number of maps, of which the least description length chooses; 2 to 8 by default.
    pub maps: RangeInclusive<usize>,
    /// Whether all maps are similarities; false by default.
    pub similar: bool,
    /// Number of condensation disks; 0 by default.
    pub disks: usize,
    /// Number of evaluations of candidates for each number of maps, approximately; 20,000 by default.
    pub effort: usize,
    /// Seed of random numbers; 0 by default.
    pub seed: u64,
    /// Number of threads; that of the machine's cores by default. Results do not depend on it.
    pub threads: NonZero<usize>,
    /// A flag that ends the work with an error when it is set.
    pub cancel: Option<Arc<AtomicBool>>,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            maps: 2..=8,
            similar: false,
            disks: 0,
            effort: 20_000,
            seed: 0,
            threads: all_cores(),
            cancel: None,
        }
    }
}

setters!(FitOptions {
    method: Method,
    maps: RangeInclusive<usize>,
    similar: bool,
    disks: usize,
    effort: usize,
    seed: u64,
    threads: NonZero<usize>,
    cancel: Option<Arc<AtomicBool>>,
});
