//! Results as Python objects: named tuples, and whole numbers of any size.

use kfrac::{Count, Size};
use pyo3::call::PyCallArgs;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyInt;

/// Makes a named tuple of `kfrac._results`.
pub(crate) fn named<'py>(
    py: Python<'py>,
    name: &str,
    values: impl PyCallArgs<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import("kfrac._results")?.getattr(name)?.call1(values)
}

/// Digits that Python converts from a text at once, whatever its limit is.
const DIGITS: usize = 600;

/// Returns a count as a Python number.
pub(crate) fn whole<'py>(py: Python<'py>, count: &Count) -> PyResult<Bound<'py, PyAny>> {
    if let Some(small) = count.to_u64() {
        return Ok(small.into_pyobject(py)?.into_any());
    }
    let digits = count.to_string();
    let (first, rest) = digits.split_at(digits.len() % DIGITS);
    let number = |text: &str| py.get_type::<PyInt>().call1((text,));
    let shift = number("10")?.pow(DIGITS, py.None())?;
    let mut value = number(if first.is_empty() { "0" } else { first })?;
    let chunks = (0..rest.len()).step_by(DIGITS);
    for chunk in chunks.map(|start| &rest[start..start + DIGITS]) {
        value = value.mul(&shift)?.add(number(chunk)?)?;
    }
    Ok(value)
}

/// Size of a picture: the long side, or width and height.
#[derive(FromPyObject)]
pub(crate) enum SizeArgument {
    /// Long side in pixels.
    Long(u32),
    /// Width and height in pixels.
    Exactly((u32, u32)),
}

impl SizeArgument {
    /// Returns the size, none of whose sides is 0.
    pub(crate) fn size(&self) -> PyResult<Size> {
        let (size, least) = match *self {
            Self::Long(side) => (Size::Long(side), side),
            Self::Exactly((width, height)) => (Size::Exactly(width, height), width.min(height)),
        };
        match least {
            0 => Err(PyValueError::new_err("a size is at least 1 pixel")),
            _ => Ok(size),
        }
    }
}
