//! Systems of maps for pictures.

use std::num::NonZero;
use std::ops::RangeInclusive;

use kfrac::Bits;
use kfrac::fit::{FitOptions, Method, Silhouette};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::Failure;
use crate::fractal::Fractal;
use crate::results::named;
use crate::work::long;

/// Number of maps: one number, or the least and the largest.
#[derive(FromPyObject)]
pub(crate) enum Maps {
    /// That many.
    One(usize),
    /// From the first to the second.
    Range((usize, usize)),
}

impl Maps {
    fn range(&self) -> RangeInclusive<usize> {
        match *self {
            Self::One(maps) => maps..=maps,
            Self::Range((least, most)) => least..=most,
        }
    }
}

/// Fits a system of maps whose attractor is a picture.
///
/// Parameters
/// ----------
/// picture : array of bool, shape (height, width)
///     True for the pixels of the shape, in rows from the top: `grey < 128`, for example.
/// maps : int or (int, int)
///     Number of maps, or its least and largest value, of which the shortest description chooses.
/// method : {"auto", "collage", "skeleton", "moments"}
///     How the system is found.
/// similar : bool
///     Whether all maps are similarities.
/// effort : int
///     Number of candidates that are evaluated for each number of maps, approximately.
/// seed : int
///     Seed of random numbers. Results depend on it, and not on the number of threads.
/// threads : int, optional
///     Number of threads; by default that of the machine's cores.
///
/// Returns
/// -------
/// Fit
///     Named tuple: `fractal`, whose unit is a pixel; `iou`, intersection over union of attractor and shape; `hausdorff`,
///     their Hausdorff distance in pixels; `exact`, whether the pictures are the same; `method`, by which it was found.
///
/// Raises
/// ------
/// KfracError
///     If the picture has no shape, or the options are out of range.
#[pyfunction]
#[pyo3(signature = (picture, *, maps=Maps::Range((2, 8)), method="auto", similar=false, effort=20_000, seed=0, threads=None))]
#[expect(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn fit<'py>(
    py: Python<'py>,
    picture: PyReadonlyArray2<'py, bool>,
    maps: Maps,
    method: &str,
    similar: bool,
    effort: usize,
    seed: u64,
    threads: Option<NonZero<usize>>,
) -> PyResult<Bound<'py, PyAny>> {
    let known = Method::ALL.into_iter().find(|it| it.name() == method);
    let known = known.ok_or_else(|| {
        let names = Method::ALL.map(Method::name).join(", ");
        PyValueError::new_err(format!("there is no method '{method}': {names}"))
    })?;
    let (height, width) = (picture.shape()[0], picture.shape()[1]);
    let pixels = picture.as_array();
    let bits = Bits::of(width, height, |column, row| pixels[[row, column]]);
    let options = FitOptions::default()
        .maps(maps.range())
        .method(known)
        .similar(similar)
        .effort(effort)
        .seed(seed);
    let options = match threads {
        Some(threads) => options.threads(threads),
        None => options,
    };
    let (fit, yaml) = long(py, move |cancel| {
        let shape = Silhouette::new(bits).map_err(Failure::of)?;
        let fit = kfrac::fit(&shape, &options.cancel(Some(cancel))).map_err(Failure::of)?;
        let yaml = fit.yaml(&shape, "picture");
        Ok((fit, yaml))
    })?;
    let fractal = Fractal::read_text(py, &yaml)?;
    let score = &fit.score;
    let values = (
        fractal,
        score.iou,
        score.hausdorff,
        fit.exact,
        fit.method.name(),
    );
    named(py, "Fit", values)
}
