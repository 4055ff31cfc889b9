//! Files as written: what was read, with places, before anything is looked up or evaluated.
//!
//! [`Document::read`] parses a file, puts its parents (`extends`) and components into it, and
//! reads the result into a [`RuleDocument`]. Nothing outside this module sees YAML.

mod assemble;
mod merge;
pub mod node;
mod read;
mod reader;
mod rule;
mod schema;
mod shape;
mod style;
mod unused;
mod yaml;

pub use rule::{
    BaseElementDocument, Entry, GeneratorDocument, InitiatorDocument, Listed, MoveDocument,
    ParameterDocument, PartDocument, PieceDocument, RuleDocument, SelectDocument, WhichPoints,
};

pub use schema::schema;

use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostics, Place, Source};
use crate::expression::Expression;
use crate::rule::Rule;

use node::Node;

/// A value and where it was written.
#[derive(Clone, Debug)]
pub struct Written<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub place: Place,
}

/// A number as written: an expression.
pub type Number = Written<Expression>;

/// A point as written.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its first coordinate, to the right.
    pub x: Number,
    /// Its second coordinate, upwards.
    pub y: Number,
    /// Where it was written.
    pub place: Place,
}

impl Point {
    /// Stands in for a point that could not be read.
    pub(crate) fn unknown(place: &Place) -> Self {
        let unknown = || Written {
            value: Expression::unknown(),
            place: place.clone(),
        };
        Self {
            x: unknown(),
            y: unknown(),
            place: place.clone(),
        }
    }

    /// Whether two points are written the same.
    #[must_use]
    pub fn is_written_like(&self, other: &Self) -> bool {
        self.x.value == other.x.value && self.y.value == other.y.value
    }
}

/// A file with its parents and components put into it.
#[derive(Clone, Debug)]
pub struct Document {
    node: Node,
    rule: RuleDocument,
    warnings: Diagnostics,
}

impl Document {
    /// Reads a rule from a text.
    ///
    /// # Errors
    ///
    /// All that is wrong with the text, its parents and its components.
    pub fn read(source: &Arc<Source>, catalogue: &Catalogue) -> Result<Self, Diagnostics> {
        let mut diagnostics = Diagnostics::default();
        let assembled = assemble::assemble(source, catalogue, &mut diagnostics);
        let Some((node, complete)) = assembled else {
            return Err(diagnostics.without_repeats());
        };
        let Some(rule) = read::read(&node, complete, &mut diagnostics) else {
            return Err(diagnostics.without_repeats());
        };
        if diagnostics.has_errors() {
            // What can be said about names and values is said too.
            let (Ok((_, more)) | Err(more)) = Rule::resolve(&rule, &[]);
            diagnostics.extend(more);
            return Err(diagnostics.without_repeats());
        }
        Ok(Self {
            node,
            rule,
            warnings: diagnostics.without_repeats(),
        })
    }

    /// The rule as written.
    #[must_use]
    pub fn rule(&self) -> &RuleDocument {
        &self.rule
    }

    /// The file with its parents and components inlined, as YAML that reads back as the same.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        self.node.to_yaml()
    }

    /// The validated rule, with parameters set by name, and what is doubtful, but not wrong.
    ///
    /// # Errors
    ///
    /// All that is wrong with it.
    pub fn resolve(&self, settings: &[Setting]) -> Result<(Rule, Diagnostics), Diagnostics> {
        let mut all = self.warnings.clone();
        match Rule::resolve(&self.rule, settings) {
            Ok((rule, doubts)) => {
                all.extend(unused::parameters(&self.rule, self.node.place.source()));
                all.extend(doubts);
                Ok((rule, all.without_repeats()))
            }
            Err(mistakes) => {
                all.extend(mistakes);
                Err(all.without_repeats())
            }
        }
    }
}

/// A parameter's value from outside the file.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The parameter.
    pub name: String,
    /// Its value.
    pub value: f64,
}
