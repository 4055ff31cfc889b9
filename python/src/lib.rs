//! Python module `kfrac._kfrac`: fractals, their pictures, elements and numbers, as Python objects and numpy arrays.
//!
//! Everything is a call of the front door of the library, `kfrac::Fractal`. Work runs without the interpreter's lock, ends
//! at an interrupt, and reports mistakes as exceptions; see [`work`]. Types of results are named tuples of `kfrac._results`.

mod arrow;
mod dataset;
mod error;
mod fit;
mod fractal;
mod library;
#[cfg(target_os = "linux")]
mod memory;
mod results;
mod table;
mod work;

use pyo3::prelude::*;

#[cfg(target_os = "linux")]
#[global_allocator]
static MEMORY: memory::HugePages = memory::HugePages;

/// Linear fractals: grown from production rules, drawn and measured.
#[pymodule(gil_used = false)]
mod _kfrac {
    #[pymodule_export]
    use crate::dataset::Dataset;
    #[pymodule_export]
    use crate::error::KfracError;
    #[pymodule_export]
    use crate::fit::fit;
    #[pymodule_export]
    use crate::fractal::{Fractal, load, parse};
    #[pymodule_export]
    use crate::library::library;
    #[pymodule_export]
    use crate::table::Table;
}
