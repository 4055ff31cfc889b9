//! The inverse problem: a system of maps whose attractor is a picture.
//!
//! A [`Silhouette`] is the set of the pixels of a picture; a [`Candidate`] has affine maps and condensation disks.
//! [`fit`] searches the candidate whose [attractor](Candidate::attractor) is closest to the shape.
//!
//! [`Method::Collage`] searches *collages* (Barnsley, Ervin, Hardin & Lancaster, "Solution of an inverse problem for
//! fractals and other sets", 1986): similar copies of the shape that lie inside it are enumerated, those that cover it
//! together are chosen by exchange, the maps are improved by least squares on pairs of nearest points, and the best
//! candidates are refined on their attractors by CMA-ES.
//!
//! [`Method::Skeleton`] is the method of Libeskind-Hadas & Maragos (1987) without a person who points: copies at branch
//! points of the skeleton, and maximal disks. It suits shapes whose copies have a body, such as islands and leaves.
//!
//! [`Method::Moments`] begins with systems whose invariant measure has the moments of the picture (Vrscay & Roehrig 1989).

mod attractor;
mod bits;
mod candidate;
mod certificate;
mod cma;
mod collage;
mod density;
mod error;
mod file;
mod image;
mod methods;
mod moments;
mod options;
mod orbit;
mod progress;
mod refine;
mod report;
mod score;
mod shape;
mod skeleton;
mod snap;
mod symmetry;

pub use attractor::Attractor;
pub use candidate::{Candidate, Disk};
pub use certificate::Certificate;
pub use density::FittedWeights;
pub use error::FitError;
pub use image::CollageError;
pub use options::{FitOptions, Method};
pub use progress::{BestSoFar, FitProgress};
pub use report::ReportError;
pub use score::Score;
pub use shape::Silhouette;
pub use skeleton::BranchPoints;

use crate::geometry::DAffine2;
use crate::measure::exact::{Effort, GraphDirectedSystem, Hausdorff, dimensions_within};

/// A system that was fitted to a shape, with its measures.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fit {
    /// The system.
    pub candidate: Candidate,
    /// Distances and overlaps of the attractor, wherever it lies, and the shape.
    pub score: Score,
    /// Whether the attractor's picture is the shape's: see [`Attractor::is`].
    pub exact: bool,
    /// The method by which it was found.
    pub method: Method,
    /// Number of bits of all numbers of the system, if each has as few as lower the intersection over union by at most
    /// 0.005.
    pub bits: u64,
    /// The collage theorem's bound.
    pub certificate: Certificate,
    /// Dimension of the attractor as far as it is known exactly; `None` if a map does not contract.
    pub dimension: Option<Hausdorff>,
    /// Weights of the maps and the distance of their measure from the picture's, if the shape [has
    /// values](Silhouette::with_values).
    pub density: Option<FittedWeights>,
    /// Description length in bits: 10 for each number, and 6 for each cell in which attractor and shape differ by more
    /// than a cell, of at most 160 along a side.
    pub description: f64,
    /// Results of the other methods that [`Method::Auto`] tried, shortest description first.
    pub others: Vec<Rival>,
    /// Number of candidates that were evaluated.
    pub evaluations: usize,
}

/// The result of a method that another one surpassed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rival {
    /// The method.
    pub method: Method,
    /// Its candidate.
    pub candidate: Candidate,
    /// Its measures.
    pub score: Score,
    /// Its description length in bits.
    pub description: f64,
}

/// Fits a system of maps to a shape.
///
/// The result depends on the shape, the options and the seed alone, and not on the number of threads.
///
/// ```
/// use kfrac::fit::{Candidate, FitOptions, Silhouette};
/// use kfrac::geometry::{DMat2, DVec2};
/// use kfrac::ifs::about;
///
/// // A picture of Sierpiński's gasket.
/// let half = DMat2::from_diagonal(DVec2::splat(0.5));
/// let corners = [(2.0, 2.0), (62.0, 2.0), (32.0, 54.0)];
/// let gasket = Candidate::of_maps(corners.map(|(x, y)| about(half, DVec2::new(x, y))).into());
/// let picture = gasket.attractor([64, 56], None)?.pixels;
///
/// let shape = Silhouette::new(picture)?;
/// let options = FitOptions::default().maps(3..=3).effort(2000);
/// let fit = kfrac::fit(&shape, &options)?;
/// assert!(fit.score.iou > 0.9);
/// println!("{}", fit.yaml(&shape, "gasket.png"));
/// # Ok::<(), kfrac::fit::FitError>(())
/// ```
///
/// # Errors
///
/// Returns an error if the number of maps is not from 2 to 32, if [`Method::Skeleton`] finds no copies, or if the work is
/// cancelled.
pub fn fit(shape: &Silhouette, options: &FitOptions) -> Result<Fit, FitError> {
    let (least, most) = (*options.maps.start(), *options.maps.end());
    if least < 2 || most > 32 || least > most {
        return Err(FitError::Maps(if least < 2 { least } else { most }));
    }
    // Margins change nothing: pictures that are moved have maps that are moved.
    let (cropped, there) = shape.cropped();
    let options = options.moved(&there.inverse());
    let (found, evaluations) = methods::found(&cropped, &options)?;
    let cancel = options.cancel.as_deref();
    let measured = found
        .into_iter()
        .map(|it| it.measured(shape, &there, cancel));
    let mut others: Vec<(Rival, bool)> = measured.collect::<Result<_, _>>()?;
    // The shortest description of a picture that has a part of the shape.
    let best = { others.iter() }.position(|(rival, _)| rival.score.iou > 0.0);
    let (best, exact) = others.remove(best.unwrap_or(0));
    // Branch points that are given keep their order.
    let candidate = match options.branch_points.branches.is_empty() {
        true => best.candidate.ordered(shape.middle()),
        false => best.candidate,
    };
    Ok(Fit {
        score: best.score,
        exact,
        bits: bits::of(shape, &candidate, cancel)?,
        certificate: Certificate::new(shape, &candidate),
        dimension: dimension(&candidate),
        density: FittedWeights::of(shape, &candidate),
        candidate,
        method: best.method,
        description: best.description,
        others: others.into_iter().map(|(rival, _)| rival).collect(),
        evaluations,
    })
}

/// Returns the dimension of a candidate's attractor.
fn dimension(candidate: &Candidate) -> Option<Hausdorff> {
    let copies = candidate.maps.iter().map(|map: &DAffine2| (0, 0, *map));
    let system = GraphDirectedSystem::plane(copies)?;
    let of_maps = dimensions_within(&system, Effort::Full)?.hausdorff;
    if candidate.disks.is_empty() {
        return Some(of_maps);
    }
    Some(Hausdorff {
        value: Some(2.0),
        closed_form: Some("2".into()),
        upper_bound: Some(2.0),
        method: "the disks have an area".into(),
        ..of_maps
    })
}

impl Fit {
    /// Returns the number of bits divided by the number of pixels of the picture.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    pub fn bits_per_pixel(&self, shape: &Silhouette) -> f64 {
        let [width, height] = shape.size();
        self.bits as f64 / (width * height) as f64
    }

    /// Describes the dimension in words: its value and closed form, or its bound; `None` if there is none.
    #[must_use]
    pub fn dimension_in_words(&self) -> Option<String> {
        self.dimension.as_ref().map(file::described)
    }

    /// Returns by how many bits the description of the best other method is longer; `None` if there is none.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        let best = self.others.first()?;
        Some(best.description - self.description)
    }
}
