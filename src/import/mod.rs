//! Import of external data: fractals in files of other programs, pictures, and tables of points.
//!
//! [`read`] converts the entries of a text to documents. Each entry becomes a document of its own; what would not be
//! the same set is refused at its place in the text, and the other entries are read regardless.

mod aifs;
mod csv;
mod curve;
mod document;
mod eisenscript;
mod fractasketch;
mod fractint;
mod genes;
mod lattice;
mod maps;
mod palette;
mod picture;
#[cfg(feature = "tables")]
mod ply;
#[cfg(feature = "tables")]
mod table;
mod words;

use std::path::Path;
use std::sync::Arc;

use crate::diagnostic::{Diagnostics, Source};
use crate::document::Document;
use crate::style::Named;

pub use csv::{ColumnsError, MapColumns};
#[cfg(feature = "cli")]
pub(crate) use palette::of_picture;
pub use palette::{PaletteError, PaletteFormat, read_palette};
pub use picture::{Channel, PictureError, Raster};
#[cfg(feature = "tables")]
pub use ply::{PlyError, read_ply};
#[cfg(feature = "tables")]
pub use table::{Table, TableError, read_points};

/// Format of a text with fractals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SourceFormat {
    /// L-systems of Fractint: `Name { Angle 6 Axiom F F=F+F--F+F }`.
    LSystems,
    /// Systems of affine maps of Fractint, in the plane or in space: `Name { .5 0 0 .5 0 0 .33 … }`.
    Ifs,
    /// Table of affine maps, one in a row, with commas, semicolons, tabs or blanks between the columns; a text is one
    /// entry.
    Csv,
    /// Systems of maps of IFStile and ifsdb, in the plane or in space: `@` with lines such as `A=(f|g)*A`.
    Aifs,
    /// Curves by edge replacement on the Gaussian and the Eisenstein integers: `Dragon: G 1 0 0 0 0 1 1 0` in each line, or
    /// a JSON list of objects with `name` and `gene`.
    Genes,
    /// Template of the program FractaSketch in its version of D. Loehr: a point, and lines of six types to further points.
    FractaSketch,
    /// Program in EisenScript, the language of Structure Synth: `rule r md 10 { { x 1 rz 5 } r box }`; a text is one entry.
    EisenScript,
}

impl Named for SourceFormat {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("l", Self::LSystems),
        ("ifs", Self::Ifs),
        ("csv", Self::Csv),
        ("aifs", Self::Aifs),
        ("genes", Self::Genes),
        ("fsk", Self::FractaSketch),
        ("eisenscript", Self::EisenScript),
    ];
}

impl SourceFormat {
    /// Returns the format of a file by its extension, in any case; `None` if the extension is not known.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match &extension[..] {
            "tsv" => Some(Self::Csv),
            "es" => Some(Self::EisenScript),
            extension => Self::from_name(extension),
        }
    }

    /// Returns a description of the format, for use in help and messages.
    #[must_use]
    pub fn described(self) -> &'static str {
        match self {
            Self::LSystems => "L-systems of Fractint",
            Self::Ifs => "systems of maps of Fractint",
            Self::Csv => "tables of maps, a map in each row",
            Self::Aifs => "systems of maps of IFStile (AIFS)",
            Self::Genes => "genes of curves, a gene in each line or a JSON list",
            Self::FractaSketch => "templates of FractaSketch",
            Self::EisenScript => "programs of Structure Synth in EisenScript (es)",
        }
    }

    /// Returns an example of an entry, for use in messages.
    #[must_use]
    pub fn example(self) -> &'static str {
        match self {
            Self::LSystems | Self::Ifs => "Name { ... }",
            Self::Csv => "a row of the numbers a b c d e f p",
            Self::Aifs => "a block @ with a set A=(f|g)*A",
            Self::Genes => "a line such as Dragon: G 1 0 0 0 0 1 1 0",
            Self::FractaSketch => "a template of a point x y and lines t x y",
            Self::EisenScript => "a program such as { x 1 } box",
        }
    }
}

/// Options of [`read`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ImportOptions {
    /// Columns of a table of maps; by default those of its header or, without a header, `abcdef` or `abcdefp`, in space
    /// `abcdefghijkl` or `abcdefghijklp`.
    pub columns: Option<MapColumns>,
}

impl ImportOptions {
    /// Sets the columns of tables of maps.
    #[must_use]
    pub fn columns(mut self, columns: MapColumns) -> Self {
        self.columns = Some(columns);
        self
    }
}

/// Result of importing an entry.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Name of the entry in its file.
    pub name: String,
    /// The entry as a document of kfrac; `None` if the conversion failed.
    pub document: Option<Document>,
    /// Diagnostics of parts that could not be read or differ; errors if there is no document.
    pub found: Diagnostics,
}

/// Reads the entries of a text, in its order; the diagnostics report text that belongs to no entry.
#[must_use]
pub fn read(
    source: &Arc<Source>,
    format: SourceFormat,
    options: &ImportOptions,
) -> (Vec<Imported>, Diagnostics) {
    match format {
        SourceFormat::LSystems => fractint::read(source, fractint::lsystem::write),
        SourceFormat::Ifs => fractint::read(source, fractint::maps::write),
        SourceFormat::Csv => csv::read(source, options.columns.as_ref()),
        SourceFormat::Aifs => aifs::read(source),
        SourceFormat::Genes => genes::read(source),
        SourceFormat::FractaSketch => fractasketch::read(source),
        SourceFormat::EisenScript => eisenscript::read(source),
    }
}
