//! Options of fits.

use std::num::NonZero;
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::parallel::all_cores;

use crate::geometry::DAffine2;

use super::cma::Budget;
use super::{BranchPoints, FitProgress};

/// The way in which a system is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// By the skeleton if branch points are given, or else by all methods: the result with the shortest description is
    /// kept. An exact collage ends the search.
    #[default]
    Auto,
    /// Copies of the shape that cover it, refined on the attractor.
    Collage,
    /// Copies at the branch points of the skeleton, with maximal disks for the rest (Libeskind-Hadas & Maragos 1987).
    Skeleton,
    /// Systems whose invariant measure has the moments of the picture, refined on the attractor (Vrscay & Roehrig 1989).
    Moments,
}

impl Method {
    /// All methods, in the order of their names in help texts.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Skeleton, Self::Collage, Self::Moments];

    /// Returns the name of the method.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Collage => "collage",
            Self::Skeleton => "skeleton",
            Self::Moments => "moments",
        }
    }

    /// Returns a description of the method, as a help text.
    #[must_use]
    pub fn described(self) -> &'static str {
        match self {
            Self::Auto => {
                "By the skeleton if branch points are given, or else the best result of all methods"
            }
            Self::Collage => "Copies of the shape that cover it, refined on the attractor",
            Self::Skeleton => "Copies at branch points of the skeleton, and disks for the rest",
            Self::Moments => "Systems with the moments of the picture, refined on the attractor",
        }
    }
}

/// Options of a fit.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FitOptions {
    /// The method.
    pub method: Method,
    /// Smallest and largest number of maps, of which the least description length chooses; 2 to 8 by default.
    pub maps: RangeInclusive<usize>,
    /// Whether all maps are similarities; false by default.
    pub similar: bool,
    /// Number of condensation disks, 0 by default; by the skeleton, the largest number, or with 0 as many as are needed.
    pub disks: usize,
    /// Branch points of the skeleton that are known; none by default.
    pub branch_points: BranchPoints,
    /// Number of evaluations of candidates for each number of maps, approximately; 20,000 by default.
    pub effort: usize,
    /// Seed of random numbers; 0 by default.
    pub seed: u64,
    /// Number of threads; that of the machine's cores by default. Results do not depend on it.
    pub threads: NonZero<usize>,
    /// A flag that ends the work with an error when it is set.
    pub cancel: Option<Arc<AtomicBool>>,
    /// A flag that ends the search when it is set, with the best system so far, once there is one.
    pub stop: Option<Arc<AtomicBool>>,
    /// Progress to be reported; none by default.
    pub progress: Option<Arc<FitProgress>>,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            maps: 2..=8,
            similar: false,
            disks: 0,
            branch_points: BranchPoints::default(),
            effort: 20_000,
            seed: 0,
            threads: all_cores(),
            cancel: None,
            stop: None,
            progress: None,
        }
    }
}

setters!(FitOptions {
    method: Method,
    maps: RangeInclusive<usize>,
    similar: bool,
    disks: usize,
    branch_points: BranchPoints,
    effort: usize,
    seed: u64,
    threads: NonZero<usize>,
    cancel: Option<Arc<AtomicBool>>,
    stop: Option<Arc<AtomicBool>>,
    progress: Option<Arc<FitProgress>>,
});

impl FitOptions {
    /// Returns the budget of a search that these options may end.
    pub(super) fn budget(&self, evaluations: usize) -> Budget<'_> {
        Budget {
            evaluations,
            flags: [self.cancel.as_deref(), self.stop.as_deref()],
        }
    }

    /// Returns the options with branch points moved by a map.
    pub(super) fn moved(&self, there: &DAffine2) -> Self {
        self.clone().branch_points(BranchPoints {
            centre: { self.branch_points.centre }.map(|point| there.transform_point2(point)),
            branches: { self.branch_points.branches.iter() }
                .map(|&point| there.transform_point2(point))
                .collect(),
        })
    }
}
