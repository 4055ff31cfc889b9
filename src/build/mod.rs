//! Rules, systems and structures that are written in a program instead of a file.
//!
//! A [`RuleBuilder`], a [`SystemBuilder`] or a [`StructureBuilder`] has a method for every key of a file
//! of its kind and writes the file that says the same. That file is read like any other: whatever a file can say can be said here, every mistake
//! is found by the same checks, and a message shows the line of the file that it is about. The
//! meaning of the keys is that of `library/README.md`.
//!
//! Numbers are `f64`, `i32`, or text: an expression such as `"sqrt(3)/6"`, of parameters, drawn
//! variables and `i`, `age`, `step` and `length`. A number that is not finite is a mistake, which
//! is reported with all others when the rule is built; -0.0 is 0. Two points are one where both
//! are written alike, so take the same numbers, or the same texts, for both.
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
//! Trees on the sides of a triangle. Their walls stay as they are, and their roofs sway:
//!
//! ```
//! use kfrac::build::{Element, Elements, Generator, Move, RuleBuilder};
//! use kfrac::heading::Parameter;
//! use kfrac::rule::Placement;
//!
//! let roof = Elements::new()
//!     .point((0, 0))
//!     .element(Element::to((0, 1)).fertile(false))
//!     .point(("1/2", "3/2"))
//!     .point((1, 1))
//!     .element(Element::to((1, 0)).fertile(false));
//! let swaying = Generator::new()
//!     .random("tilt", "uniform(-sway, sway)")
//!     .moves(Move::new().rotate("tilt").about((0.5, 1)).points([2]))
//!     .part(Placement::Stays, roof);
//! let triangle = Elements::from([(0, 0), (1, 0), (0, 1)]).closed(true);
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
//! A tree of two maps, with a stem that is drawn at every level, and the same as objects:
//!
//! ```
//! use kfrac::build::{Instance, Map, Set, StructureBuilder, SystemBuilder, Union};
//! use kfrac::graph::Graph;
//!
//! let stem = Set::segment((0, 0), (0, 1));
//! let system = SystemBuilder::new()
//!     .map(Map::scale(0.6).rotate(40).shift((0, 1)))
//!     .map(Map::scale(0.6).rotate(-40).shift((0, 1)))
//!     .condensation(stem.clone())
//!     .build()?;
//! let twig = |angle| Instance::of("tree").scale(0.6).rotate(angle).translate((0, 1));
//! let tree = Union::new().with(stem).with(twig(40)).with(twig(-40));
//! let structure = StructureBuilder::new(Instance::of("tree"))
//!     .object("tree", tree)
//!     .build()?;
//! let boxes = [Graph::of_system(&system), Graph::of_structure(&structure)]
//!     .map(|graph| graph.limit_bounds().unwrap());
//! assert!((boxes[0].size() - boxes[1].size()).length() < 1e-9);
//! # Ok::<(), kfrac::diagnostic::Diagnostics>(())
//! ```

mod elements;
mod generator;
mod heading;
mod map;
mod number;
mod set;
mod structure;
mod system;
pub(crate) mod written;

pub use elements::{Element, Elements};
pub use generator::{Generator, Move};
pub use map::Map;
pub use number::{Number, Point};
pub use set::Set;
pub use structure::{Instance, StructureBuilder, Union};
pub use system::SystemBuilder;

use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostics, Source};
use crate::document::Document;
use crate::document::node::{Node, Value};
use crate::heading::{Description, Parameter};
use crate::model::Model;
use crate::rule::{BaseElement, Rule};
use crate::style::{Style, View};

use heading::of_all_kinds;
use written::Entries;

/// What messages call what was built.
const NAME: &str = "(built)";

/// Writes a production rule. What is said twice counts as said last, except that every generator
/// and every parameter has a name of its own.
#[derive(Clone, Debug)]
#[must_use = "a rule is made by `build` or `document`"]
pub struct RuleBuilder {
    entries: Entries,
    parameters: Entries,
    generators: Entries,
}

impl RuleBuilder {
    /// A rule that starts from an initiator, and has no generator yet.
    pub fn new(initiator: impl Into<Elements>) -> Self {
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

    /// Adds a generator. If there are several, a selection says which one replaces an element, or
    /// every fertile element [does](Element::generator).
    pub fn generator(self, name: impl Into<String>, generator: impl Into<Generator>) -> Self {
        Self {
            generators: self.generators.add(name, generator.into().value()),
            ..self
        }
    }

    /// Element i of a fractal takes entry (i − 1) mod m of the m names of generators.
    pub fn select_by_index(self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        let names = names.into_iter().map(|name| Value::Text(name.into()));
        let by_index = Entries::default().set("by_index", written::sequence(names));
        self.set("select", by_index.value())
    }

    /// Generators are drawn, each as often as its weight says.
    pub fn select_at_random(
        self,
        weights: impl IntoIterator<Item = (impl Into<String>, impl Into<Number>)>,
    ) -> Self {
        let weights = weights.into_iter();
        let weights = weights.fold(Entries::default(), |all, (name, weight)| {
            all.add(name, weight.into().0)
        });
        let at_random = Entries::default().set("at_random", weights.value());
        self.set("select", at_random.value())
    }

    /// The generator of the first condition that holds, such as `("age >= 3", "seed")`, or the one
    /// for all other cases.
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

    /// The base element of all elements that have [none of their own](Element::base_element); a
    /// line if nothing is said.
    pub fn base_element(self, base_element: &BaseElement) -> Self {
        self.set("base_element", written::base_element(base_element))
    }

    of_all_kinds!();

    /// The rule as a file that has been read: to be saved as YAML, to be resolved with other values
    /// of its parameters, or with what is doubtful in it.
    ///
    /// # Errors
    ///
    /// What is wrong, as [`Document::read`] tells it.
    pub fn document(&self) -> Result<Document, Diagnostics> {
        read(
            &self.entries,
            &[
                ("params", &self.parameters),
                ("generators", &self.generators),
            ],
        )
    }

    /// The validated rule.
    ///
    /// # Errors
    ///
    /// All that is wrong with it: no element in a list, no generator or one that is not there, a
    /// number that is not finite, an expression that cannot be read, and so on.
    pub fn build(&self) -> Result<Rule, Diagnostics> {
        let rule = resolved(&self.document()?)?.into_rule();
        Ok(Arc::unwrap_or_clone(rule.unwrap_or_else(|| {
            unreachable!("what is built says no other kind")
        })))
    }
}

/// The file that has these entries, and names under some keys.
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

/// What a file that was built comes to.
fn resolved(document: &Document) -> Result<Model, Diagnostics> {
    let (model, _doubts) = document.resolve(&[])?;
    Ok(model)
}
