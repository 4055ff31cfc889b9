//! Elements of an approximant as a table: numpy arrays and Arrow arrays on one memory.

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_buffer::ScalarBuffer;
use kfrac::export::{Column, Columns};
use numpy::ndarray::ArrayView1;
use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

use crate::arrow;
use crate::work::quick;

/// Values of a column.
pub(crate) enum Values {
    Wholes(ScalarBuffer<i64>),
    Bytes(ScalarBuffer<u8>),
    Reals(ScalarBuffer<f64>),
    /// A byte each, as in numpy.
    Flags(Vec<bool>),
}

/// Elements of an approximant, in order of traversal.
///
/// `table["x0"]` is a column as a read-only numpy array on the memory of the table, without a copy:
///
/// - `x0`, `y0`, `x1`, `y1` (float64): first and last point of traversal, in the file's units; y points up. In space also
///   `z0`, `z1`, and `ux`, `uy`, `uz`: the unit normal.
/// - `fractal`, `age`, `index` (int64): number of the fractal from 0, its age in steps, rank of the element in it from 1.
/// - `fertile`, `visible` (bool): whether it is replaced in the next step, and whether it is drawn.
/// - `direction` (uint8): 1 normal, 2 y reflected, 3 x reflected, 4 both.
/// - `joined` (bool): whether its first point is the last one of the preceding element.
/// - `a` to `f` (float64), for systems and structures: entries of the map, x' = a x + c y + e, y' = b x + d y + f; in space
///   `a` to `l`, column by column.
///
/// `len(table)` is the number of elements, `dict(table)` a mapping of all columns. Readers of Arrow streams (polars, pyarrow,
/// duckdb) take the table itself: `polars.DataFrame(table)`, `pyarrow.table(table)`.
#[pyclass(frozen, module = "kfrac")]
pub(crate) struct Table {
    rows: usize,
    columns: Vec<(&'static str, Values)>,
}

impl Table {
    pub(crate) fn new(columns: Columns) -> Self {
        let rows = columns.rows();
        let columns = columns.into_columns().into_iter();
        let columns = columns.map(|(name, column)| {
            let values = match column {
                Column::Wholes(values) => Values::Wholes(values.into()),
                Column::Bytes(values) => Values::Bytes(values.into()),
                Column::Reals(values) => Values::Reals(values.into()),
                Column::Flags(values) => Values::Flags(values),
                other => unreachable!("{other:?} is no column of elements"),
            };
            (name, values)
        });
        Self {
            rows,
            columns: columns.collect(),
        }
    }

    fn get(&self, name: &str) -> Option<&Values> {
        let mut columns = self.columns.iter();
        let found = columns.find(|(known, _)| *known == name);
        found.map(|(_, values)| values)
    }

    fn reals(&self, name: &str) -> Option<&[f64]> {
        match self.get(name)? {
            Values::Reals(values) => Some(values),
            _ => None,
        }
    }

    fn wholes(&self, name: &str) -> &[i64] {
        match self.get(name) {
            Some(Values::Wholes(values)) => values,
            _ => &[],
        }
    }

    fn flags(&self, name: &str) -> &[bool] {
        match self.get(name) {
            Some(Values::Flags(values)) => values,
            _ => &[],
        }
    }

    /// Returns the chains of visible elements that join: coordinates, point by point, and where each chain begins.
    fn chains(&self) -> (Vec<f64>, usize, Vec<i64>) {
        let axes = [("x0", "x1"), ("y0", "y1"), ("z0", "z1")];
        let axes = axes.map(|(first, last)| Some([self.reals(first)?, self.reals(last)?]));
        let axes: Vec<_> = axes.into_iter().flatten().collect();
        let (visible, joined) = (self.flags("visible"), self.flags("joined"));
        let fractal = self.wholes("fractal");
        let mut points = Vec::new();
        let mut offsets = vec![0];
        let mut count = 0;
        for row in (0..self.rows).filter(|&row| visible[row]) {
            let goes_on =
                row > 0 && visible[row - 1] && joined[row] && fractal[row] == fractal[row - 1];
            if !goes_on {
                if count > 0 {
                    offsets.push(count);
                }
                points.extend(axes.iter().map(|[first, _]| first[row]));
                count += 1;
            }
            points.extend(axes.iter().map(|[_, last]| last[row]));
            count += 1;
        }
        if count > 0 {
            offsets.push(count);
        }
        (points, axes.len(), offsets)
    }
}

/// Returns an array on memory that `owner` keeps alive and never changes.
fn borrowed<'py, T: Element>(values: &[T], owner: &Bound<'py, Table>) -> Bound<'py, PyAny> {
    let view = ArrayView1::from(values);
    // SAFETY: the table is frozen, and its columns are never changed; the array keeps it alive and is made read-only before
    // anything sees it.
    let array = unsafe { PyArray1::borrow_from_array(&view, owner.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    array.into_any()
}

#[pymethods]
impl Table {
    fn __len__(&self) -> usize {
        self.rows
    }

    /// Names of the columns, in order.
    #[getter]
    fn columns(&self) -> Vec<&'static str> {
        self.columns.iter().map(|(name, _)| *name).collect()
    }

    /// Returns the names of the columns, as mappings do.
    fn keys(&self) -> Vec<&'static str> {
        self.columns()
    }

    /// Returns a column as a read-only array of shape (n,) on the memory of the table.
    fn __getitem__<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let table = slf.get();
        match table.get(name) {
            Some(Values::Wholes(values)) => Ok(borrowed(values, slf)),
            Some(Values::Bytes(values)) => Ok(borrowed(values, slf)),
            Some(Values::Reals(values)) => Ok(borrowed(values, slf)),
            Some(Values::Flags(values)) => Ok(borrowed(values, slf)),
            None => {
                let names = table.columns().join(", ");
                let message = format!("there is no column '{name}': {names}");
                Err(PyKeyError::new_err(message))
            }
        }
    }

    fn __repr__(&self) -> String {
        let names = self.columns().join(", ");
        format!("<kfrac.Table: {} elements; {names}>", self.rows)
    }

    /// Exports the table as an Arrow C stream of one batch. Numbers are not copied; truth values are packed to bits. A
    /// requested schema has no effect.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        let stream: FFI_ArrowArrayStream = quick(py, || arrow::stream(&self.columns, self.rows))?;
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    /// Returns the lines that visible elements which join form, as a ragged array.
    ///
    /// Returns
    /// -------
    /// coordinates : array of float64, shape (points, 2), in space (points, 3)
    ///     Points of traversal of all lines, in the file's units; y points up.
    /// offsets : array of int64, shape (lines + 1,)
    ///     Line i has the points `offsets[i]` to `offsets[i + 1] - 1`.
    #[expect(clippy::type_complexity, reason = "a pair of arrays")]
    fn ragged<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<i64>>)> {
        let (points, axes, offsets) = quick(py, || Ok(self.chains()))?;
        let rows = points.len() / axes.max(1);
        let points = points.into_pyarray(py).reshape([rows, axes])?;
        Ok((points, offsets.into_pyarray(py)))
    }

    /// Returns the lines of [`ragged`](Self::ragged) as an array of shapely LineStrings.
    ///
    /// Returns
    /// -------
    /// array of shapely.LineString, shape (lines,)
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     If shapely is not installed.
    fn lines<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let shapely = py.import("shapely")?;
        let kind = shapely.getattr("GeometryType")?.getattr("LINESTRING")?;
        let (points, offsets) = self.ragged(py)?;
        shapely.call_method1("from_ragged_array", (kind, points, (offsets,)))
    }
}
