//! Linear fractals: grown from production rules, drawn and measured.
//!
//! A *production rule* (Kaandorp, "Interactive generation of fractal objects", CWI report CS-R8706,
//! 1987) has three components: an *initiator*, an array of *generators* and a *base element*. In each
//! step every fertile element is replaced by a smaller copy of a generator. Iterated function systems,
//! object instancing and L-systems compile to the same graph.
//!
//! [`Fractal`] is the front door:
//!
//! ```
//! # fn main() -> Result<(), kfrac::Error> {
//! use kfrac::Fractal;
//!
//! let tree = Fractal::named("pythagoras")?.set("angle", 30.0)?.steps(8);
//! let svg: String = tree.svg()?;
//! let png: Vec<u8> = tree.png(600)?;
//! assert_eq!(tree.elements()?.count(), 766);
//! assert!((tree.dimension()?.value - 2.0).abs() < 0.05);
//!
//! let mine = Fractal::parse("
//! initiator: segment
//! generator: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]
//! ")?;
//! println!("{:.4}", mine.dimension()?.value);
//! # Ok(())
//! # }
//! ```
//!
//! | for | see |
//! |---|---|
//! | parameters, a family of curves | [`Fractal::set`] |
//! | elements one by one, tables | [`Fractal::elements`], [`Fractal::write`] |
//! | raw pixels, frames of a film, cancelling | [`Fractal::pixels`], [`Fractal::frames`], [`Fractal::cancel`] |
//! | all elements in memory, column by column | [`Fractal::columns`] |
//! | points of random iteration, pixel by pixel | [`Fractal::histogram`] |
//! | pictures of parts without a limit of magnification | [`Fractal::zoom`] |
//! | wallpapers and friezes | [`Fractal::repeat`] |
//! | the way to another fractal | [`Fractal::toward`], [`tween`] |
//! | sizes before drawing, extent, dimension | [`Fractal::forecast`], [`Fractal::estimate`], [`Fractal::bounds`], [`Fractal::dimension`] |
//! | all of these at once, distance of two fractals | [`Fractal::info`], [`Fractal::compare`] |
//! | the file with values of its parameters | [`Fractal::yaml`] |
//! | sets in space: camera and shading, elements, extent | [`Fractal::space`], [`Fractal::elements_in_space`], [`Fractal::bounds_in_space`] |
//! | mistakes in a file, with their places | [`Error::diagnostics`] |
//! | the format of files, and their keys | [`document`] |
//! | names in the library | [`catalogue`] |
//! | a system whose attractor is a picture | [`fit`](fit()) |
//! | maps of the parameters of a system | [`family`] |
//! | data sets of pictures with labels | [`dataset`] |
//! | rules made by a program | [`build`] |
//! | a change of a file that keeps its comments and layout | [`edit`] |
//!
//! Everything that the front door does is done by the rooms behind it, which are public as far as programs
//! need them: to measure pictures and points ([`measure`]), to compute distances and
//! skeletons in pictures ([`morphology`]), to visit elements without an iterator ([`grow`]), or
//! to draw into memory with all options ([`render`]).
//!
//! # Features
//!
//! | feature | by default | purpose |
//! |---|---|---|
//! | `cli` | yes | the command line; enables all features below |
//! | `studio` | yes | the studio, a page in the browser; enables `cli` |
//! | `jpeg` | with `cli` | JPEG, besides PNG, among the pictures that are measured |
//! | `meshes` | with `cli` | meshes from files as sets in space |
//! | `simd` | with `cli` | vectors of AVX2 and AVX-512 where the processor has them: the same points and pictures, sooner |
//! | `snippets` | with `cli` | lines of the file in messages about its mistakes |
//! | `tables` | with `cli` | tables of points in CSV that are measured |
//! | `threemf` | with `cli` | scenes as 3MF files |
//!
//! With `default-features = false` the library draws, measures and converts, has fewer than 45 dependencies, none
//! of which concerns terminals, signals or temporary files, and compiles for `wasm32-unknown-unknown`. There, it
//! runs in one thread, and files exist only in the embedded library.
//!
//! # Stages
//!
//! ```text
//!  library/*.yaml, a user's file, a program (build)
//!     │  document   the file as written, with places; parents and components inlined
//!     ▼
//!  the document of its kind, with metadata that all kinds have
//!     │  resolve    names looked up, expressions compiled, everything checked
//!     ▼
//!  model            a rule, a system of maps, a structure of objects or an L-system, validated
//!     │  compile    dependence on age and index becomes more objects
//!     ▼
//!  Graph            objects that instance each other: forecast
//!     ├── extent    boxes, hulls, radii and limit sets, with nothing drawn
//!     ├── measure   dimensions, exact and by boxes; distances
//!     ├── convert   the same set as a file of another kind
//!     │  grow       a depth-first walk, shared between threads
//!     ▼
//!  elements, in order, streamed
//!     ├── render    pictures: SVG, PNG, PDF; plots: DXF, HP-GL, G-code; scenes and meshes in space; estimate: their sizes
//!     ├── figure    figures: the rule itself, approximants side by side, differences
//!     └── export    tables of elements and points: CSV, JSON, PLY
//! ```
//!
//! Graphs, walks, forecasts, bounds and draws are generic over the [`Frame`](geometry::Frame) of an element; the
//! frame of the plane, with lines and curves as outlines, is the default. Rules, iterated function systems,
//! structures and L-systems lie in the plane or in [space](geometry::Frame3), where `render` draws them by an exact
//! descent into depth buffers, or as polygons and lines of visible faces.
//!
//! The ground that all stages share are points and frames ([`geometry`]), [`expression`]s, values [as
//! written](Written), random draws by [`Path`], [`Count`]s, [`Kind`]s, [`Metadata`], groups of isometries ([`symmetry`]) and
//! pictures of [`Bits`]. No room imports one above it.
//!
//! The model of an iterated function system is [`ifs`]; its measure, its contraction, its connectedness and fractal
//! interpolation are worked out on it without a graph, and [`family`] makes maps of its parameters. A set that is
//! another fractal is grown when its file is resolved: the model holds what it draws. All such sets of a file share a budget of
//! the `work` that is counted on a thread.
//!
//! Random iteration, the [`chaos`] game, is a way of its own: from affine maps to histograms, or to the
//! nearest points in space, which `render` turns into pictures.
//!
//! Windows of any size are [`zoom`]ed into: a descent in long numbers, between `graph` and `grow`, finds
//! the elements about a point, as a graph of its own that is drawn like any other.
//!
//! Each stage builds on the ones above it. `render`, `export` and `measure` do not depend on each other;
//! [`morphology`] erodes and dilates pictures of bits and computes their skeletons, and stands beside the stages.
//! [`import`] reads pictures and tables of points to be measured, and files of other programs, which become
//! files of kfrac. Figures are drawn on the surfaces of `render`, and have all its formats. A model that a
//! program [`build`]s is written as a file and read as such. The [`catalogue`] resolves names, mistakes in
//! files are [`diagnostic`]s, numbers in files are [`expression`]s, and work is shared between threads. One
//! thread walks down to subtrees of some thousand elements, any thread walks over these, and results, text
//! included, are put together in order: the bytes do not depend on the number of threads.
//!
#![doc = include_str!("glossary.md")]

#[macro_use]
mod setters;

mod bits;
pub mod build;
pub mod catalogue;
pub mod chaos;
#[cfg(feature = "cli")]
pub mod cli;
mod compile;
pub mod convert;
mod count;
pub mod dataset;
pub mod diagnostic;
mod digraph;
pub mod document;
mod draws;
pub mod edit;
pub mod estimate;
pub mod export;
pub mod expression;
pub mod extent;
pub mod family;
mod fast_hash;
pub mod figure;
#[cfg(feature = "cli")]
mod film;
pub mod fit;
mod fractal;
pub mod geometry;
pub mod graph;
pub mod grow;
pub mod ifs;
pub mod import;
pub mod instancing;
mod kind;
pub mod lsystem;
pub mod measure;
mod metadata;
pub mod model;
pub mod morphology;
mod morton;
mod output_file;
mod parallel;
mod priority;
mod random;
mod readable;
pub mod render;
mod resolve;
pub mod rule;
mod saturating;
#[cfg(feature = "studio")]
pub mod studio;
pub mod style;
pub mod symmetry;
pub mod tween;
mod work;
mod written;
pub mod zoom;

pub use bits::Bits;
pub use count::Count;
pub use draws::{Corner, Distribution, Path, Variable};
pub use fit::fit;
pub use fractal::{
    Dimension, Error, Fractal, Frames, Goal, Info, NoRepetition, Repetition, proposed_steps,
};
pub use grow::Element;
pub use kind::Kind;
pub use metadata::{Description, Metadata, Parameter};
pub use output_file::WriteError;
pub use render::{Pixels, PngEncoding, Size};
pub use style::{Style, View};
pub use symmetry::Symmetry;
pub use written::{Written, WrittenNumber, WrittenPoint};

/// Random rules for the tests of several modules.
#[cfg(test)]
#[path = "../tests/laws/rules.rs"]
mod random_rules;

/// The programs of the README are tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
