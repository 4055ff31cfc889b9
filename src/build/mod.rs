//! Builders for rules, systems and structures defined in a program.
//!
//! [`RuleBuilder`], [`SystemBuilder`] and [`StructureBuilder`] have a method for every key of a file of
//! their kind. A builder writes a file, which is read like any other: a program can express what a file
//! can express, the same checks apply, and a diagnostic shows the line of the generated file.
//! `library/README.md` describes the keys.
//!
//! A number is an `f64`, an `i32`, or an expression as text, such as `"sqrt(3)/6"`, of parameters,
//! random variables and `i`, `age`, `step` and `length`. Numbers that are not finite are reported with
//! all other mistakes when the file is read; -0.0 becomes 0. Two points are the same point if both are
//! written alike, as equal numbers or equal texts.
//!
//! The Koch curve:
//!
//! ```
//! use std::sync::Arc;
//!
//! use kfrac::build::RuleBuilder;
//! use kfrac::graph::Graph;
//!
//! let height = f64::sqrt(3.0) / 6.0;
//! let side = [(0.0, 0.0), (1.0 / 3.0, 0.0), (0.5, height), (2.0 / 3.0, 0.0), (1.0, 0.0)];
//! let rule = RuleBuilder::new([(0, 0), (1, 0)])
//!     .generator("side", side)
//!     .build()?;
//! let graph = Graph::compile(&Arc::new(rule), 5)?;
//! assert!(graph.check_size(5, 4u64.pow(5)).is_ok());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Trees on the sides of a triangle, whose walls are infertile and whose roofs have a random tilt:
//!
//! ```
//! use kfrac::build::{ElementBuilder, ElementsBuilder, GeneratorBuilder, MoveBuilder, RuleBuilder};
//! use kfrac::Parameter;
//! use kfrac::rule::Placement;
//!
//! let roof = ElementsBuilder::new()
//!     .point((0, 0))
//!     .element(ElementBuilder::to((0, 1)).fertile(false))
//!     .point(("1/2", "3/2"))
//!     .point((1, 1))
//!     .element(ElementBuilder::to((1, 0)).fertile(false));
//! let swaying = GeneratorBuilder::new()
//!     .random("tilt", "uniform(-sway, sway)")
//!     .moves(MoveBuilder::new().rotate("tilt").about((0.5, 1)).points([2]))
//!     .part(Placement::Stays, roof);
//! let triangle = ElementsBuilder::from([(0, 0), (1, 0), (0, 1)]).closed(true);
//! let document = RuleBuilder::new(triangle)
//!     .parameter(Parameter { min: Some(0.0), ..Parameter::new("sway", 20.0) })
//!     .generator("roof", swaying)
//!     .document()?;
//! println!("{}", document.to_yaml());
//! let (model, doubts) = document.resolve(&[])?;
//! assert!(model.rule().is_some_and(|rule| rule.is_random()) && doubts.is_empty());
//! # Ok::<(), kfrac::diagnostic::Diagnostics>(())
//! ```
//!
//! A tree of two maps with a condensation set as its stem, and the same tree as an instancing
//! structure:
//!
//! ```
//! use kfrac::build::{InstanceBuilder, MapBuilder, SetBuilder, StructureBuilder, SystemBuilder, UnionBuilder};
//! use kfrac::graph::Graph;
//!
//! let stem = SetBuilder::segment((0, 0), (0, 1));
//! let system = SystemBuilder::new()
//!     .map(MapBuilder::scale(0.6).rotate(40).translate((0, 1)))
//!     .map(MapBuilder::scale(0.6).rotate(-40).translate((0, 1)))
//!     .condensation(stem.clone())
//!     .build()?;
//! let twig = |angle| InstanceBuilder::of("tree").scale(0.6).rotate(angle).translate((0, 1));
//! let tree = UnionBuilder::new().with(stem).with(twig(40)).with(twig(-40));
//! let structure = StructureBuilder::new(InstanceBuilder::of("tree"))
//!     .object("tree", tree)
//!     .build()?;
//! let boxes = [Graph::of_system(&system), Graph::of_structure(&structure)]
//!     .map(|graph| graph.limit_bounds().unwrap());
//! assert!((boxes[0].size() - boxes[1].size()).length() < 1e-9);
//! # Ok::<(), kfrac::diagnostic::Diagnostics>(())
//! ```

mod elements;
mod generator;
mod map;
mod metadata;
mod number;
mod set;
mod structure;
mod system;
pub(crate) mod written;

pub use elements::{ElementBuilder, ElementsBuilder};
pub use generator::{GeneratorBuilder, MoveBuilder};
pub use map::MapBuilder;
pub use number::{NumberText, PointText};
pub use set::SetBuilder;
pub use structure::{InstanceBuilder, StructureBuilder, UnionBuilder};
pub use system::SystemBuilder;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::document::Document;
use crate::document::node::{Node, Value};
use crate::metadata::{Description, Parameter};
use crate::model::Model;
use crate::rule::{BaseElement, Rule};
use crate::style::{Style, View};

use metadata::of_all_kinds;
use written::Entries;

/// Name of the generated file in messages.
const NAME: &str = "(built)";

/// Builder of a production rule. Setting a key again replaces its value. Names of generators and
/// parameters must be unique.
#[derive(Clone, Debug)]
#[must_use = "a rule is made by `build` or `document`"]
pub struct RuleBuilder {
    entries: Entries,
    parameters: Entries,
    generators: Entries,
}

impl RuleBuilder {
    /// Creates a rule with an initiator, but without generators.
    pub fn new(initiator: impl Into<ElementsBuilder>) -> Self {
        Self {
            entries: Entries::default().set("initiator", initiator.into().value()),
            parameters: Entries::default(),
            generators: Entries::default(),
        }
    }

    fn set(self, key: &str, value: Value) -> Self {
        Self {
            entries: self.entries.set(key, value),
            ..self
        }
    }

    /// Adds a generator. If there are several, either a selection or [every fertile
    /// element](ElementBuilder::generator) names the generator that replaces an element.
    pub fn generator(
        self,
        name: impl Into<String>,
        generator: impl Into<GeneratorBuilder>,
    ) -> Self {
        Self {
            generators: self.generators.add(name, generator.into().value()),
            ..self
        }
    }

    /// Selects generators by index: element i of a fractal takes entry (i − 1) mod m of the m names.
    pub fn select_by_index(self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        let names = names.into_iter().map(|name| Value::Text(name.into()));
        let by_index = Entries::default().set("by_index", written::sequence(names));
        self.set("select", by_index.value())
    }

    /// Selects generators at random, with probabilities proportional to the weights.
    pub fn select_at_random(
        self,
        weights: impl IntoIterator<Item = (impl Into<String>, impl Into<NumberText>)>,
    ) -> Self {
        let weights = weights.into_iter();
        let weights = weights.fold(Entries::default(), |all, (name, weight)| {
            all.add(name, weight.into().0)
        });
        let at_random = Entries::default().set("at_random", weights.value());
        self.set("select", at_random.value())
    }

    /// Selects the generator of the first condition that holds, such as `("age >= 3", "seed")`, and
    /// `otherwise` if none holds.
    pub fn select_first(
        self,
        cases: impl IntoIterator<Item = (impl Into<String>, impl Into<String>)>,
        otherwise: impl Into<String>,
    ) -> Self {
        let case = |name: String| Entries::default().set("use", Value::Text(name));
        let cases = cases.into_iter().map(|(condition, name)| {
            let when = Value::Text(condition.into());
            case(name.into()).set("when", when).value()
        });
        let otherwise = case(otherwise.into()).value();
        self.set("select", written::sequence(cases.chain([otherwise])))
    }

    /// Sets the base element of all elements without [their own](ElementBuilder::base_element). The default is
    /// a line.
    pub fn base_element(self, base_element: &BaseElement) -> Self {
        self.set("base_element", written::base_element(base_element))
    }

    of_all_kinds!();

    /// Returns the rule as a document, which can be written as YAML or resolved with other parameter
    /// values, and which reports warnings.
    ///
    /// # Errors
    ///
    /// Returns all mistakes that [`Document::read`] finds.
    pub fn document(&self) -> Result<Document, Diagnostics> {
        read(
            &self.entries,
            &[
                ("params", &self.parameters),
                ("generators", &self.generators),
            ],
        )
    }

    /// Returns the validated rule.
    ///
    /// # Errors
    ///
    /// Returns all mistakes: an empty list of elements, a missing or unknown generator, a number that
    /// is not finite, an invalid expression, and so on.
    pub fn build(&self) -> Result<Rule, Diagnostics> {
        built(&self.document()?)
    }
}

/// Writes a file from entries and from named mappings, of which empty ones are omitted, and reads it.
fn read(entries: &Entries, named: &[(&str, &Entries)]) -> Result<Document, Diagnostics> {
    let mut entries = entries.clone();
    for (key, named) in named {
        if !named.is_empty() {
            entries = entries.set(key, (*named).clone().value());
        }
    }
    let text = Node::from(entries.value()).to_yaml();
    Document::read(&Source::new(NAME, text), &Catalogue::embedded())
}

/// Resolves a built document as a model of its kind, and discards the warnings.
fn built<M: TryFrom<Model, Error = Model>>(document: &Document) -> Result<M, Diagnostics> {
    let (model, _warnings) = document.resolve(&[])?;
    M::try_from(model).map_err(|model| {
        let message = format!("this is {}", model.kind().full_name());
        Diagnostic::error(message).into()
    })
}
