//! The embedded library.

use kfrac::catalogue::{Catalogue, Shelf};
use pyo3::prelude::*;

use crate::results::named;
use crate::work::quick;

/// Lists the fractals of the library.
///
/// Parameters
/// ----------
/// tag : str, optional
///     Lists only those with this tag, such as `plant` or `dragon`.
/// kind : str, optional
///     Lists only those of a kind: `rule`, `ifs`, `instancing` or `lsystem`.
///
/// Returns
/// -------
/// list of Entry
///     Named tuples of name, kind, title, tags and source, sorted by kind and name. `load` reads them by name.
#[pyfunction]
#[pyo3(signature = (*, tag=None, kind=None))]
pub(crate) fn library<'py>(
    py: Python<'py>,
    tag: Option<&str>,
    kind: Option<&str>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let entries = quick(py, || {
        let catalogue = Catalogue::embedded();
        let is_listed = |shelf: Shelf| {
            Shelf::grown().contains(&shelf) && kind.is_none_or(|kind| shelf.kind() == kind)
        };
        let entries = catalogue.entries().into_iter();
        let entries = entries.filter(|entry| is_listed(entry.shelf)).map(|entry| {
            let description = catalogue.description(&entry);
            (entry, description)
        });
        Ok(entries
            .filter(|(_, it)| tag.is_none_or(|tag| it.tags.iter().any(|own| own == tag)))
            .collect::<Vec<_>>())
    })?;
    let listed = entries.iter().map(|(entry, it)| {
        let values = (
            &entry.name,
            entry.shelf.kind(),
            &it.title,
            &it.tags,
            &it.source,
        );
        named(py, "Entry", values)
    });
    listed.collect()
}
