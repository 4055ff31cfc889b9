//! Conversion between kinds of linear fractals.
//!
//! A model is decomposed into the objects of its instancing graph and their instances, which are written as a
//! document of another kind: a rule of fertile elements is a system of maps, its visible infertile elements
//! are condensation sets, and a recurrent system is a structure of objects (Hart 1992, section 3.3). Every
//! result has been read back.
//!
//! The *limit set* is preserved, to rounding; on request every approximant is preserved too. Closed outlines
//! belong to it with the area that they enclose. Weights, tints and the order of traversal are not part of
//! the set and are dropped where the other kind has no equivalent.

mod convertible;
mod copies;
mod ifs;
mod instancing;
mod lsystem;
mod number;
mod refusal;
mod rule;
mod shape;
mod structure;

pub use refusal::Refusal;

use std::borrow::Cow;

use crate::build::written::{self, Entries};
use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostics, Source};
use crate::document::Document;
use crate::document::node::{Node, Value};
use crate::extent::NoLimit;
use crate::geometry::{DAffine2, DAffine3};
use crate::graph::{CompileError, Graph};
use crate::grow::Growth;
use crate::metadata::Metadata;
use crate::model::{DrawnError, Kind, Model};
use crate::style::ColorBy;

use structure::Structure;

/// Property that a conversion preserves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keeps {
    /// The limit set.
    #[default]
    Limit,
    /// The limit set and every approximant.
    Approximants,
}

impl Keeps {
    /// Returns the initial set; where approximants are kept, it must not be refused.
    fn initial<T>(self, initial: Option<Result<T, Refusal>>) -> Result<Option<T>, Refusal> {
        match initial {
            Some(Err(refusal)) if self == Self::Approximants => Err(refusal),
            initial => Ok(initial.and_then(Result::ok)),
        }
    }
}

/// An error in a conversion.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConvertError {
    /// The other kind cannot express the model.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// A generator has a point that is not finite.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A model in space cannot be drawn.
    #[error(transparent)]
    Drawn(#[from] DrawnError),
    /// The document that was written cannot be read back.
    #[error("what it becomes cannot be read back: {}", first_message(.0))]
    NotReadBack(Diagnostics),
}

fn first_message(diagnostics: &Diagnostics) -> String {
    let mut all = diagnostics.iter();
    all.next()
        .map_or_else(String::new, |first| first.message().to_owned())
}

/// Step that graphs are compiled for; where the objects of a rule are complete after fewer steps, more change
/// nothing.
const STEPS: u32 = 64;

/// Step at which an L-system is converted if its steps differ in kind and its file does not specify one.
const DEEPEST: u32 = 12;
/// Limit of the number of elements at that step.
const MAX_ELEMENTS: u64 = 20_000;

/// Converts a model to a document of another kind.
///
/// Numbers are exact: those of the document are read as the same doubles.
///
/// # Errors
///
/// Returns an error if the other kind cannot express the model, or if the model has no limit set.
pub fn convert(model: &Model, to: Kind, keeps: Keeps) -> Result<Document, ConvertError> {
    if model.kind() == to {
        return Err(Refusal::SameKind(to).into());
    }
    let limit = match keeps {
        Keeps::Limit => model.of_zoom(),
        Keeps::Approximants => Cow::Borrowed(model),
    };
    let model = &*limit;
    let mut metadata = model.metadata().clone();
    if model.kind() == Kind::LSystem {
        // The tubes of lines are sets.
        metadata.style.tube = None;
    }
    if let Cow::Owned(_) = limit {
        // The steps of the limit set are others.
        metadata.steps = None;
    }
    if model.is_in_space() {
        return read_back(&metadata, to, in_space(model, to, keeps)?);
    }
    let steps = steps(model);
    let graph = model.compile_listed(steps, 0, Model::MAX_LISTED)?;
    // A time-indexed structure has no limit set, but is finite after its steps.
    let ends = graph.is_time_indexed() && graph.is_plain() && to == Kind::Instancing;
    if !ends {
        if let Model::LSystem(system) = model {
            system
                .check_growth()
                .map_err(|reason| Refusal::from(NoLimit::from(reason)))?;
        }
        graph.limit().map_err(Refusal::from)?;
    }
    if let (Model::Ifs(system), Keeps::Approximants) = (model, keeps)
        && system.ifs().initial().is_some_and(|set| set.count() > 1)
    {
        let what = "its initial set is of several lines, and there it would be a single one";
        return Err(Refusal::Steps(what).into());
    }
    let structure = match model {
        Model::Ifs(system) if keeps == Keeps::Limit => {
            let shapes = graph.base_elements().to_vec();
            Structure::of_ifs(system.ifs(), shapes)
        }
        Model::Instancing(own) => {
            let objects = Graph::canonical_objects(own).into_iter();
            let name = |object: usize| own.objects()[object].name.clone();
            let names: Vec<_> = objects
                .map(|it| it.map_or_else(String::new, name))
                .collect();
            Structure::of_graph(&graph, steps, keeps, &names)?
        }
        _ => Structure::of_graph(&graph, steps, keeps, &[])?,
    };
    read_back(&metadata, to, (writer(to).1)(&structure, keeps)?)
}

/// Returns the number of steps for which a model is compiled.
fn steps(model: &Model) -> u32 {
    match model.as_kind().deepest(DEEPEST, MAX_ELEMENTS) {
        Some(deepest) => model.metadata().steps.unwrap_or(deepest),
        None => STEPS,
    }
}

/// Converts a model in space to the keys of another kind.
fn in_space(model: &Model, to: Kind, keeps: Keeps) -> Result<Entries, ConvertError> {
    let write: Writer<DAffine3> = match to {
        Kind::Ifs => ifs::write,
        Kind::Instancing => instancing::write,
        Kind::Rule | Kind::LSystem => return Err(Refusal::InSpace(to).into()),
    };
    let steps = steps(model);
    let Some(graph) = model.graph_in_space(steps) else {
        return Err(CompileError::InSpace.into());
    };
    let graph = graph?;
    let ends = graph.is_time_indexed() || graph.depth().is_some();
    let ends = ends && graph.is_plain() && to == Kind::Instancing;
    if !ends {
        if let Model::LSystemInSpace(system) = model {
            system
                .check_growth()
                .map_err(|reason| Refusal::from(NoLimit::from(reason)))?;
        }
        graph.limit().map_err(Refusal::from)?;
    }
    let structure = match model {
        Model::IfsInSpace(system) if keeps == Keeps::Limit => {
            Structure::of_ifs(system.ifs(), graph.base_elements().to_vec())
        }
        _ => {
            // Elements have an instance for each of their surfaces, and lines may be tubes.
            let (growth, limited) = (Growth::steps(steps), ends.then_some(steps));
            let drawn = model.drawn_in_space(limited, &growth, ColorBy::None);
            let graph = drawn.transpose()?.map_or(graph, |drawn| drawn.graph);
            Structure::of_graph(&graph, steps, keeps, &[])?
        }
    };
    let space = Entries::default().set("space", number::value(3.0));
    Ok(space.and(write(&structure, keeps)?))
}

/// Returns the document of the keys of a kind, which is read back.
fn read_back(metadata: &Metadata, to: Kind, own: Entries) -> Result<Document, ConvertError> {
    let text = Node::from(headed(metadata, to, own).value()).to_yaml();
    let read = Document::read(&Source::new("(converted)", text), &Catalogue::embedded());
    let document = read.map_err(ConvertError::NotReadBack)?;
    match document.resolve(&[]) {
        Ok(_) => Ok(document),
        Err(diagnostics) => Err(ConvertError::NotReadBack(diagnostics)),
    }
}

/// Writes the keys of a kind.
type Writer<M = DAffine2> = fn(&Structure<M>, Keeps) -> Result<Entries, Refusal>;

/// Returns the description and the writer of a kind as the target of conversions.
fn writer(to: Kind) -> (&'static str, Writer) {
    match to {
        Kind::Rule => (
            "A production rule; all maps must be similarities",
            rule::write,
        ),
        Kind::Ifs => (
            "An iterated function system, recurrent where necessary",
            ifs::write,
        ),
        Kind::Instancing => ("Objects that instance each other", instancing::write),
        Kind::LSystem => ("An L-system, whose symbols draw lines", lsystem::write),
    }
}

/// Returns a description of a kind as the target of conversions, as a help text.
#[must_use]
pub fn described(to: Kind) -> &'static str {
    writer(to).0
}

/// Returns the entries of a document: description, content, dimensions, style and view.
fn headed(metadata: &Metadata, kind: Kind, own: Entries) -> Entries {
    let number = |value: f64| number::value(value);
    let kind = Entries::default().set("kind", Value::Text(kind.name().into()));
    let entries = written::description(kind, &metadata.description)
        .and(own)
        .set_some("steps", metadata.steps.map(|steps| number(steps.into())))
        .set_some("dimension", metadata.dimension.map(number))
        .set_some(
            "hausdorff_dimension",
            metadata.hausdorff_dimension.map(number),
        );
    let (style, view, density) = (
        written::style(&metadata.style),
        written::view(&metadata.view).and(written::space_view(&metadata.space)),
        written::density(&metadata.density),
    );
    let some = |entries: Entries| (!entries.is_empty()).then(|| entries.value());
    entries
        .set_some(
            "symmetry",
            metadata.symmetry.as_ref().map(written::symmetry),
        )
        .set_some("style", some(style))
        .set_some("view", some(view))
        .set_some("density", some(density))
}
