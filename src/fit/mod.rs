//! The inverse problem: a system of maps whose attractor is a picture.
//!
//! A [`Shape`] is the set of the pixels of a picture; a [`Candidate`] has affine maps and condensation disks. [`fit`]
//! searches the candidate whose [attractor](Candidate::attractor) is closest to the shape.
//!
//! The search is that of *collages* (Barnsley, Ervin, Hardin & Lancaster, "Solution of an inverse problem for fractals
//! and other sets", 1986): similar copies of the shape that lie inside it are enumerated, those that cover it together
//! are chosen by exchange, the maps are improved by least squares on pairs of nearest points, and the best candidates
//! are refined on their attractors by CMA-ES.

mod attractor;
mod bits;
mod candidate;
mod certificate;
mod cma;
mod collage;
mod error;
mod file;
mod options;
mod orbit;
mod refine;
mod report;
mod score;
mod shape;
mod snap;
mod symmetry;

pub use attractor::Attractor;
pub use candidate::{Candidate, Disk};
pub use certificate::Certificate;
pub use error::FitError;
pub use options::{FitOptions, Method};
pub use report::ReportError;
pub use score::Score;
pub use shape::Shape;

use collage::{Collage, Form};
use refine::Refined;

/// A system that was fitted to a shape, with its measures.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fit {
    /// The system.
    pub candidate: Candidate,
    /// Distances and overlaps of the attractor and the shape.
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
    /// Number of candidates that were evaluated.
    pub evaluations: usize,
}

/// Fits a system of maps to a shape.
///
/// The result depends on the shape, the options and the seed alone, and not on the number of threads.
///
/// ```
/// use kfrac::fit::{Candidate, FitOptions, Shape};
/// use kfrac::geometry::{DMat2, DVec2};
/// use kfrac::ifs::about;
///
/// // A picture of Sierpiński's gasket.
/// let half = DMat2::from_diagonal(DVec2::splat(0.5));
/// let corners = [(2.0, 2.0), (62.0, 2.0), (32.0, 54.0)];
/// let gasket = Candidate::of_maps(corners.map(|(x, y)| about(half, DVec2::new(x, y))).into());
/// let picture = gasket.attractor([64, 56], None)?.pixels;
///
/// let shape = Shape::new(picture)?;
/// let options = FitOptions::default().maps(3..=3).effort(2000);
/// let fit = kfrac::fit(&shape, &options)?;
/// assert!(fit.score.iou > 0.9);
/// println!("{}", fit.yaml(&shape, "gasket.png"));
/// # Ok::<(), kfrac::fit::FitError>(())
/// ```
///
/// # Errors
///
/// Returns an error if the number of maps is not from 2 to 32, or if the work is cancelled.
pub fn fit(shape: &Shape, options: &FitOptions) -> Result<Fit, FitError> {
    let (least, most) = (*options.maps.start(), *options.maps.end());
    if least < 2 || most > 32 || least > most {
        return Err(FitError::Maps(if least < 2 { least } else { most }));
    }
    let collage = Collage::new(shape, options)?;
    let all = collage.search()?;
    let cancel = options.cancel.as_deref();
    let mut found = all[0].clone();
    let mut attractor = found.candidate.attractor(shape.size(), cancel)?;
    let iou = |drawn: &Attractor| score::iou(shape.bits(), &drawn.pixels);
    let before = iou(&attractor);
    let is_similar = |it: &&Refined| it.form == Form::Similar && it.candidate.disks.is_empty();
    if let Some(similar) = all.iter().find(is_similar) {
        let simple =
            symmetry::simplified(&similar.candidate, &symmetry::symmetries(collage.ground()));
        let mut snapped = snap::snap(shape, collage.fine(), &simple, before, cancel)?;
        let is_exact = |it: &(Candidate, Attractor)| it.1.is(shape.bits());
        if simple != similar.candidate && !snapped.as_ref().is_some_and(is_exact) {
            let other = snap::snap(shape, collage.fine(), &similar.candidate, before, cancel)?;
            snapped = other.or(snapped);
        }
        if let Some((candidate, drawn)) = snapped {
            found = Refined {
                candidate,
                ..similar.clone()
            };
            attractor = drawn;
        }
    }
    Ok(Fit {
        score: Score::new(shape.bits(), &attractor.pixels),
        exact: attractor.is(shape.bits()),
        method: Method::Collage,
        bits: bits::of(shape, &found.candidate, found.form),
        certificate: Certificate::new(shape, &found.candidate),
        candidate: found.candidate,
        evaluations: collage.evaluations(),
    })
}

impl Fit {
    /// Returns the number of bits divided by the number of pixels of the picture.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    pub fn bits_per_pixel(&self, shape: &Shape) -> f64 {
        let [width, height] = shape.size();
        self.bits as f64 / (width * height) as f64
    }
}
