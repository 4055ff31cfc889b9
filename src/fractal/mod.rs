//! The front door: a fractal from its name, its file or its text to pictures, elements and numbers.
//!
//! A [`Fractal`] is a validated [`Model`] with the options of growing and drawing it. Builder methods set options;
//! the other methods grow it anew for each result.

mod described;
mod distance;
mod error;
mod frames;
mod goal;
mod options;
mod points;
mod repetition;
mod results;
mod scene;
mod space;
mod table;
#[cfg(test)]
mod tests;

use std::num::NonZero;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use crate::catalogue::{Catalogue, Shelf, read_file};
use crate::diagnostic::{Diagnostics, Source};
use crate::document::{Document, Setting};
use crate::geometry::Frame3;
use crate::graph::Graph;
use crate::model::{DrawnInSpace, Model};
use crate::parallel::all_cores;
use crate::render::space::SpaceOptions;
use crate::render::{PngEncoding, Size, ZoomTarget};
use crate::style::{Style, View};

pub use described::Info;
pub use error::Error;
pub use frames::Frames;
#[cfg(feature = "cli")]
pub(crate) use goal::steps_of_graph;
pub use goal::{Goal, proposed_steps};
#[cfg(feature = "cli")]
pub(crate) use repetition::Copies;
pub use repetition::{NoRepetition, Repetition};
pub use results::Dimension;

/// A linear fractal, and the options of growing and drawing it.
///
/// ```
/// # fn main() -> Result<(), kfrac::Error> {
/// let svg = kfrac::Fractal::named("pythagoras")?.set("angle", 30.0)?.steps(8).svg()?;
/// assert!(svg.starts_with("<svg"));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Fractal {
    /// The file as written; `None` for a model that a program has built.
    document: Option<Document>,
    settings: Vec<Setting>,
    model: Model,
    warnings: Diagnostics,
    steps: Option<u32>,
    detail: Option<f64>,
    seed: u64,
    max_elements: u64,
    threads: NonZero<usize>,
    size: Size,
    style: Option<Style>,
    view: Option<View>,
    repetition: Option<Repetition>,
    space: Option<SpaceOptions>,
    zoom: Option<ZoomTarget>,
    png_encoding: PngEncoding,
    cancel: Option<Arc<AtomicBool>>,
    /// The graph of the model in the file's coordinates, once it has been compiled.
    graph: OnceLock<Graph>,
    /// The graph of a model in space, once it has been compiled.
    graph_in_space: OnceLock<Graph<Frame3>>,
    /// The graph of a model in space as it is drawn, once it has been compiled.
    drawn_in_space: OnceLock<DrawnInSpace>,
}

impl From<Model> for Fractal {
    fn from(model: Model) -> Self {
        Self {
            document: None,
            settings: Vec::new(),
            model,
            warnings: Diagnostics::default(),
            steps: None,
            detail: None,
            seed: 0,
            max_elements: Model::MAX_ELEMENTS,
            threads: all_cores(),
            size: Size::Long(1024),
            style: None,
            view: None,
            repetition: None,
            space: None,
            zoom: None,
            png_encoding: PngEncoding::default(),
            cancel: None,
            graph: OnceLock::new(),
            graph_in_space: OnceLock::new(),
            drawn_in_space: OnceLock::new(),
        }
    }
}

impl Fractal {
    /// Returns a fractal of the embedded library; [`catalogue`](crate::catalogue) lists the names.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let koch = kfrac::Fractal::named("koch")?;
    /// assert_eq!(koch.model().metadata().description.title.as_deref(), Some("Koch curve"));
    /// assert!(kfrac::Fractal::named("cock").is_err());
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the library has no fractal of this name; the diagnostic has similar names.
    pub fn named(name: &str) -> Result<Self, Error> {
        let catalogue = Catalogue::embedded();
        let source = catalogue.named(&Shelf::grown(), name)?;
        Self::read(&source, &catalogue)
    }

    /// Reads a file. Names in it that are no files are those of the embedded library.
    ///
    /// ```no_run
    /// # fn main() -> Result<(), kfrac::Error> {
    /// kfrac::Fractal::open("mine.yaml")?.write("mine.svg")?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or is not valid: all mistakes, with their places.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let source = read_file(path.as_ref())?;
        Self::read(&source, &Catalogue::embedded())
    }

    /// Reads the text of a file; [`document`](crate::document) describes files.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let text = "
    /// initiator: segment
    /// generator: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]
    /// ";
    /// let elements = kfrac::Fractal::parse(text)?.steps(5);
    /// assert_eq!(elements.elements()?.count(), 4_usize.pow(5));
    ///
    /// let error = kfrac::Fractal::parse("initiator: segmet").unwrap_err();
    /// assert!(error.to_string().contains("did you mean 'segment'?"));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the text is not valid: all mistakes, with their places.
    pub fn parse(text: &str) -> Result<Self, Error> {
        Self::read(&Source::new("text", text), &Catalogue::embedded())
    }

    /// Reads a source whose names are looked up in a catalogue.
    ///
    /// # Errors
    ///
    /// If the source is not valid: all mistakes, with their places.
    pub fn read(source: &Arc<Source>, catalogue: &Catalogue) -> Result<Self, Error> {
        let document = Document::read(source, catalogue)?;
        let (model, warnings) = document.resolve(&[])?;
        Ok(Self {
            document: Some(document),
            warnings,
            ..Self::from(model)
        })
    }
}
