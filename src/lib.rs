//! Linear fractals: grown from production rules, drawn and measured.
//!
//! A *production rule* (Kaandorp, "Interactive generation of fractal objects", CWI report CS-R8706,
//! 1987) has three components: an *initiator*, an array of *generators* and a *base element*. Step
//! by step every fertile element is replaced by a smaller copy of a generator.
//!
//! # The way of the data
//!
//! ```text
//!  library/*.yaml, a user's file, a program (build)
//!     │  document   what was written, with places in the file; parents and components put in
//!     ▼
//!  the document of its kind, under a heading that all kinds have
//!     │  resolve    names looked up, expressions compiled, everything checked
//!     ▼
//!  model            a rule, a system of maps, a structure of objects or an L-system, validated
//!     │  graph      dependence on the moment becomes more objects
//!     ▼
//!  Graph            objects that instance each other: forecast, bounds
//!     ├── measure   dimensions: exactly where they can be, and by boxes; distances
//!     ├── convert   the same set as a file of another kind
//!     │  grow       a depth-first walk, shared between threads
//!     ▼
//!  elements, in order, streamed
//!     ├── render    pictures: SVG, PNG, PDF; plots, DXF; estimate: how large they will be
//!     ├── figure    figures: the rule itself, approximants side by side, differences
//!     └── export    tables: CSV, JSON
//! ```
//!
//! The model of an iterated function system is [`ifs`]; its measure, its contraction and fractal
//! interpolation are worked out on it without a graph. A set that is another fractal is grown when its
//! file is resolved: the model holds what it draws.
//!
//! Random iteration, the [`chaos`] game, is a way of its own: from affine maps to histograms, which
//! `render` turns into pictures.
//!
//! What is as small as one likes is [`zoom`]ed into: a descent in long numbers, between `graph` and
//! `grow`, finds what lies about a point, as a graph of its own that is drawn as any other.
//!
//! Each stage builds on the ones above it. `render`, `export` and `measure` do not know each other
//! (what is measured beside graphs, pictures and tables of points, is read by [`import`], and so are
//! files of other programs, which become files of ours);
//! figures are drawn on the surfaces of `render`, so they come in all its formats; [`cli`] uses what
//! is public here and nothing else. What a program [`build`]s is written as a file and read as such.
//! Names and files are the [`catalogue`]'s work, mistakes in files are [`diagnostic`]s, numbers in
//! files are [`expression`]s, and [`parallel`] shares work between threads. One thread walks down to
//! subtrees of some thousand elements, any thread walks over these, and what comes of them, text
//! included, is put together in order: the bytes do not depend on the number of threads.

pub mod build;
pub mod catalogue;
pub mod chaos;
pub mod cli;
pub mod convert;
pub mod diagnostic;
mod digraph;
pub mod document;
pub mod estimate;
pub mod export;
pub mod expression;
pub mod figure;
pub mod geometry;
pub mod graph;
pub mod grow;
pub mod heading;
pub mod ifs;
pub mod import;
pub mod instancing;
pub mod lsystem;
pub mod measure;
mod mix;
pub mod model;
pub mod parallel;
pub mod render;
mod resolve;
pub mod rule;
pub mod style;
mod whole;
mod wording;
pub mod zoom;

/// Random rules for the tests of several modules.
#[cfg(test)]
#[path = "../tests/laws/rules.rs"]
mod random_rules;

/// The programs of the README are tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
