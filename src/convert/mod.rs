//! From one way of writing a linear fractal to another.
//!
//! A model is taken apart into the objects of its graph and the instances in their place, which are
//! written as a file of another kind: a rule of fertile elements is a system of maps, its visible
//! infertile elements are condensation sets, and a recurrent system is a structure of objects (Hart
//! 1992, section 3.3). What is written has been read back.
//!
//! The *limit set* stays the same, to rounding; on request every approximant does as well. Closed
//! outlines belong to it with what they enclose. Weights, tints and the order of traversal are not
//! part of the set and are left behind where the other kind has nothing like them.

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

use crate::build::written::{self, Entries};
use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostics, Source};
use crate::document::Document;
use crate::document::node::{Node, Value};
use crate::graph::{CompileError, Graph};
use crate::heading::Heading;
use crate::model::{Kind, Model};

use structure::Structure;

/// What a conversion keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keeps {
    /// The limit set.
    #[default]
    Limit,
    /// The limit set, and what every approximant draws.
    Approximants,
}

/// Why a model is not converted.
#[derive(Debug, thiserror::Error)]
pub enum ConvertError {
    /// The other kind has no way to write it.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// A generator has a point that is not finite.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// What was written is no file of its kind.
    #[error("what it becomes cannot be read back: {}", first_message(.0))]
    NotReadBack(Diagnostics),
}

fn first_message(diagnostics: &Diagnostics) -> String {
    let mut all = diagnostics.iter();
    all.next()
        .map_or_else(String::new, |first| first.message().to_owned())
}

/// Steps that graphs are compiled for: those of rules whose objects are soon all known need no more.
const STEPS: u32 = 64;

/// L-systems whose steps differ in kind are converted as they are after some steps: so many unless they say,
/// if there are no more elements than this.
const DEEPEST: u32 = 12;
const MOST_ELEMENTS: u64 = 20_000;

/// Writes a model as a file of another kind.
///
/// Numbers are exact: those of the file read as the same doubles.
///
/// # Errors
///
/// If the kind has no way to write it, or if the model has no limit set.
pub fn convert(model: &Model, to: Kind, keeps: Keeps) -> Result<Document, ConvertError> {
    if model.kind() == to {
        return Err(Refusal::SameKind(to).into());
    }
    let steps = match model {
        Model::LSystem(system) => {
            let own = model.heading().steps;
            own.unwrap_or_else(|| system.deepest(DEEPEST, MOST_ELEMENTS))
        }
        _ => STEPS,
    };
    let graph = model.compile(steps)?;
    // What knows how many steps are to come has no limit set, but is as it is after them.
    let ends = graph.is_levelled() && graph.is_plain() && to == Kind::Instancing;
    if !ends {
        graph.check_limit_set().map_err(Refusal::from)?;
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
    let own = match to {
        Kind::Ifs => ifs::write(&structure, keeps)?,
        Kind::Instancing => instancing::write(&structure, keeps)?,
        Kind::Rule => rule::write(&structure)?,
        Kind::LSystem => lsystem::write(&structure, keeps)?,
    };
    let text = Node::from(headed(model.heading(), to, own).value()).to_yaml();
    let read = Document::read(&Source::new("(converted)", text), &Catalogue::embedded());
    let document = read.map_err(ConvertError::NotReadBack)?;
    match document.resolve(&[]) {
        Ok(_) => Ok(document),
        Err(diagnostics) => Err(ConvertError::NotReadBack(diagnostics)),
    }
}

/// The file: what it says of itself, the objects, and how it likes to be drawn.
fn headed(heading: &Heading, kind: Kind, own: Entries) -> Entries {
    let number = |value: f64| number::value(value);
    let kind = Entries::default().set("kind", Value::Text(kind.name().into()));
    let entries = written::description(kind, &heading.description)
        .and(own)
        .set_some("steps", heading.steps.map(|steps| number(steps.into())))
        .set_some("dimension", heading.dimension.map(number))
        .set_some(
            "hausdorff_dimension",
            heading.hausdorff_dimension.map(number),
        );
    let (style, view) = (written::style(&heading.style), written::view(&heading.view));
    let some = |entries: Entries| (!entries.is_empty()).then(|| entries.value());
    entries
        .set_some("style", some(style))
        .set_some("view", some(view))
}
