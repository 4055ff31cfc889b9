//! Data sets of pictures with labels.

use std::num::NonZero;
use std::path::PathBuf;
use std::sync::Arc;

use kfrac::catalogue::Catalogue;
use kfrac::dataset::{DatasetError, Example, Maps};
use kfrac::diagnostic::Source;
use numpy::{IntoPyArray, PyArray1, PyArrayMethods};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::error::Failure;
use crate::work::{long, quick};

/// Data set of pictures with labels: a file of the kind `dataset`.
///
/// A picture is a pure function of the file and its number: it is the same on every machine, in any process and in any order.
/// `dataset[i]` is a pair of an array of uint8, shape (size, size) or (size, size, 3), rows from the top, and the number of
/// the category, as torch's DataLoader takes it. Pictures of a category follow each other. A data set can be pickled.
#[pyclass(frozen, module = "kfrac.data")]
pub(crate) struct Dataset {
    set: Arc<kfrac::dataset::Dataset>,
    name: String,
}

impl From<DatasetError> for Failure {
    fn from(error: DatasetError) -> Self {
        match error {
            DatasetError::Invalid(diagnostics) => Self::Diagnostics(diagnostics),
            error => Self::of(error),
        }
    }
}

impl Dataset {
    fn read(
        py: Python<'_>,
        name: String,
        read: impl FnOnce() -> Result<kfrac::dataset::Dataset, DatasetError> + Send,
    ) -> PyResult<Self> {
        let set = Arc::new(quick(py, || Ok(read()?))?);
        Ok(Self { set, name })
    }

    /// Returns a number of a picture, counted from the end if it is negative.
    fn index(&self, index: i64) -> PyResult<u64> {
        let len = self.set.len();
        let from_end = index.checked_add_unsigned(len).unwrap_or(-1);
        let found = u64::try_from(if index < 0 { from_end } else { index }).ok();
        found.filter(|found| *found < len).ok_or_else(|| {
            PyIndexError::new_err(format!(
                "there is no picture {index}: the data set has {len}"
            ))
        })
    }

    fn example(&self, py: Python<'_>, index: i64) -> PyResult<Example> {
        let index = self.index(index)?;
        quick(py, || Ok(self.set.example(index)?))
    }

    /// Returns the shape of a picture.
    fn shape(&self) -> Vec<usize> {
        let side = self.set.size() as usize;
        match self.set.channels() {
            1 => vec![side, side],
            channels => vec![side, side, channels.into()],
        }
    }
}

#[pymethods]
impl Dataset {
    /// Reads the file of a data set.
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let name = path.display().to_string();
        Self::read(py, name, || kfrac::dataset::Dataset::open(&path))
    }

    /// Reads the text of a data set. Paths in it are relative to the folder of `name`.
    #[staticmethod]
    #[pyo3(signature = (text, name="dataset.yaml"))]
    fn parse(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        Self::read(py, name.to_owned(), || {
            kfrac::dataset::Dataset::read(&Source::new(name, text), &Catalogue::embedded())
        })
    }

    fn __len__(&self) -> PyResult<usize> {
        Ok(usize::try_from(self.set.len())?)
    }

    /// Number of categories.
    #[getter]
    fn categories(&self) -> u32 {
        self.set.categories()
    }

    /// Number of pictures of a category.
    #[getter]
    fn instances(&self) -> u32 {
        self.set.instances()
    }

    /// Side of a picture in pixels.
    #[getter]
    fn size(&self) -> u32 {
        self.set.size()
    }

    /// Text of the file.
    #[getter]
    fn text(&self) -> &str {
        self.set.text()
    }

    fn __getitem__<'py>(&self, py: Python<'py>, index: i64) -> PyResult<(Bound<'py, PyAny>, u32)> {
        let example = self.example(py, index)?;
        let pixels: Bound<'py, PyArray1<u8>> = example.picture.into_bytes().into_pyarray(py);
        Ok((pixels.reshape(self.shape())?.into_any(), example.category))
    }

    /// Returns pictures by their numbers, as torch's DataLoader asks for those of a batch.
    fn __getitems__<'py>(
        &self,
        py: Python<'py>,
        indices: Vec<i64>,
    ) -> PyResult<Vec<(Bound<'py, PyAny>, u32)>> {
        indices
            .into_iter()
            .map(|index| self.__getitem__(py, index))
            .collect()
    }

    /// Returns a picture as the bytes of a PNG, as `kfrac dataset` writes it.
    fn png<'py>(&self, py: Python<'py>, index: i64) -> PyResult<Bound<'py, PyBytes>> {
        let index = self.index(index)?;
        let png = quick(py, || Ok(self.set.example(index)?.picture.into_png()))?;
        Ok(PyBytes::new(py, &png))
    }

    /// Returns the values that a picture was drawn with, without drawing it.
    ///
    /// Returns
    /// -------
    /// dict
    ///     `category`, `name` of the category, `instance`; `maps`, rows a, b, c, d, e, f and weight with x' = a x + b y + e,
    ///     y' = c x + d y + f, or in space the matrix row by row, the image of the origin and the weight (empty for other
    ///     fractals); `parameters` of the file; `flip`: 0 none, 1 from top to bottom, 2 from left to right, 3 both; `from`,
    ///     azimuth and elevation of the viewer in degrees, or None in the plane; `dimension`, exact or None.
    fn label<'py>(&self, py: Python<'py>, index: i64) -> PyResult<Bound<'py, PyDict>> {
        let index = self.index(index)?;
        let (label, dimension, name, (category, instance)) = quick(py, || {
            let label = self.set.label(index)?;
            let place = self.set.place(index)?;
            let of = self.set.category(place.0)?;
            let dimension = match &label.maps {
                None => of.dimension().and_then(|it| it.value),
                Some(_) => label.dimension().and_then(|it| it.value),
            };
            Ok((label, dimension, of.name(), place))
        })?;
        let all = PyDict::new(py);
        all.set_item("category", category)?;
        all.set_item("name", name)?;
        all.set_item("instance", instance)?;
        all.set_item(
            "maps",
            label.maps.as_ref().map(Maps::rows).unwrap_or_default(),
        )?;
        let parameters = PyDict::new(py);
        for (name, value) in label.parameters {
            parameters.set_item(name, value)?;
        }
        all.set_item("parameters", parameters)?;
        all.set_item("flip", label.flip)?;
        all.set_item("from", label.from)?;
        all.set_item("dimension", dimension)?;
        Ok(all)
    }

    /// Returns the name of a category, which is drawn for it if its systems are random.
    fn category(&self, py: Python<'_>, number: u32) -> PyResult<String> {
        if number >= self.set.categories() {
            return Err(PyIndexError::new_err(format!(
                "there is no category {number}"
            )));
        }
        quick(py, || Ok(self.set.category(number)?.name().to_owned()))
    }

    /// Returns the first picture, and the one after the last, of part `number` (from 1) of `count` parts.
    fn shard(&self, number: u32, count: u32) -> PyResult<(u64, u64)> {
        if number == 0 || number > count {
            return Err(PyIndexError::new_err(format!(
                "there is no part {number} of {count}"
            )));
        }
        let range = self.set.shard(number, count);
        Ok((range.start, range.end))
    }

    /// Draws the pictures from `start` to before `stop`.
    ///
    /// Parameters
    /// ----------
    /// start, stop : int
    /// threads : int, optional
    ///     Number of threads; by default that of the machine's cores. The result does not depend on it.
    ///
    /// Returns
    /// -------
    /// pictures : array of uint8, shape (stop - start, size, size) or (stop - start, size, size, 3)
    /// categories : array of int64, shape (stop - start,)
    #[pyo3(signature = (start, stop, *, threads=None))]
    fn render<'py>(
        &self,
        py: Python<'py>,
        start: u64,
        stop: u64,
        threads: Option<NonZero<usize>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyArray1<i64>>)> {
        let cores = || std::thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN);
        let threads = threads.unwrap_or_else(cores);
        let set = Arc::clone(&self.set);
        let batch = long(py, move |cancel| {
            Ok(set.render(start..stop, threads, Some(&cancel))?)
        })?;
        let mut shape = vec![batch.categories.len()];
        shape.extend(self.shape());
        let pictures = batch.bytes.into_pyarray(py).reshape(shape)?;
        let categories: Vec<i64> = batch.categories.into_iter().map(i64::from).collect();
        Ok((pictures.into_any(), categories.into_pyarray(py)))
    }

    fn __repr__(&self) -> String {
        let Self { set, name } = self;
        let (categories, instances) = (set.categories(), set.instances());
        format!("<kfrac.data.Dataset '{name}': {categories} categories of {instances} pictures>")
    }

    /// Pickles the data set as its text.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (&str, &str))> {
        let parse = py
            .import("kfrac.data")?
            .getattr("Dataset")?
            .getattr("parse")?;
        Ok((parse, (self.set.text(), &self.name)))
    }
}
