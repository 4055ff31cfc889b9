//! Files as written: what was read, with places, before anything is looked up or evaluated.
//!
//! [`Document::read`] parses a file, puts its parents (`extends`) and components into it, and
//! reads the result into the document of its kind. Nothing outside this module sees YAML.

mod assemble;
mod data;
mod heading;
mod ifs;
mod instancing;
mod lsystem;
mod merge;
pub mod node;
mod read;
mod reader;
mod rule;
mod schema;
mod shape;
mod style;
mod yaml;

pub use heading::{HeadingDocument, ParameterDocument};
pub use ifs::{
    CondensationDocument, EdgeDocument, EllipseDocument, FormDocument, FractalDocument,
    IfsDocument, InterpolationDocument, LinearDocument, MapDocument, MapsDocument, Scales,
    ShapeDocument,
};
pub use instancing::{
    InstanceDocument, InstancingDocument, LevelDocument, MasterDocument, ObjectDocument,
    TintDocument, TransformDocument, UnionDocument,
};
pub use lsystem::{
    ActionDocument, LSystemDocument, ModuleDocument, ProductionDocument, SymbolDocument,
    WordDocument,
};
pub use rule::{
    BaseElementDocument, Entry, GeneratorDocument, InitiatorDocument, Listed, MoveDocument,
    PartDocument, PieceDocument, RuleDocument, SelectDocument, WhichPoints,
};

pub use schema::{schema, schema_of_all};

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostics, Place, Source};
use crate::expression::{Expression, PARTS};
use crate::model::Model;
use crate::resolve;

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

    /// (0, 0), where a point was left out.
    pub(crate) fn origin(place: &Place) -> Self {
        let zero = || Written {
            value: Expression::number(0.0),
            place: place.clone(),
        };
        Self {
            x: zero(),
            y: zero(),
            place: place.clone(),
        }
    }

    /// A complex number by its name.
    pub(crate) fn named(name: &str, place: &Place) -> Self {
        let part = |part: &str| Written {
            value: Expression::parse(&format!("{name}{part}"))
                .unwrap_or_else(|_| Expression::unknown()),
            place: place.clone(),
        };
        let [x, y] = PARTS.map(part);
        Self {
            x,
            y,
            place: place.clone(),
        }
    }

    /// The name of the complex number that it is, if it is written as one.
    pub(crate) fn name(&self) -> Option<&str> {
        let names = self.x.value.names();
        let (name, _) = names.first()?;
        let name = name.strip_suffix(PARTS[0])?;
        (self.place.text() == name).then(|| self.place.text())
    }

    /// Whether two points are written the same.
    #[must_use]
    pub fn is_written_like(&self, other: &Self) -> bool {
        self.x.value == other.x.value && self.y.value == other.y.value
    }
}

/// What a file of some kind says, as it is written.
#[derive(Clone, Debug)]
pub enum KindDocument {
    /// A production rule.
    Rule(RuleDocument),
    /// An iterated function system.
    Ifs(IfsDocument),
    /// A structure of objects that instance each other.
    Instancing(InstancingDocument),
    /// An L-system.
    LSystem(LSystemDocument),
}

impl KindDocument {
    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &HeadingDocument {
        match self {
            Self::Rule(rule) => &rule.heading,
            Self::Ifs(ifs) => &ifs.heading,
            Self::Instancing(structure) => &structure.heading,
            Self::LSystem(system) => &system.heading,
        }
    }
}

/// A file with its parents and components put into it.
#[derive(Clone, Debug)]
pub struct Document {
    node: Node,
    kind: KindDocument,
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
        let Some((node, kind, complete)) = assembled else {
            return Err(diagnostics.without_repeats());
        };
        let Some(kind) = read::read(kind, &node, complete, &mut diagnostics) else {
            return Err(diagnostics.without_repeats());
        };
        if diagnostics.has_errors() {
            // What is wrong with names and values is said too.
            diagnostics.extend(resolve::resolve(&kind, &[]).err().unwrap_or_default());
            return Err(diagnostics.without_repeats());
        }
        Ok(Self {
            node,
            kind,
            warnings: diagnostics.without_repeats(),
        })
    }

    /// What the file says.
    #[must_use]
    pub fn kind(&self) -> &KindDocument {
        &self.kind
    }

    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &HeadingDocument {
        self.kind.heading()
    }

    /// The rule as written, if it is one.
    #[must_use]
    pub fn rule(&self) -> Option<&RuleDocument> {
        match &self.kind {
            KindDocument::Rule(rule) => Some(rule),
            KindDocument::Ifs(_) | KindDocument::Instancing(_) | KindDocument::LSystem(_) => None,
        }
    }

    /// The files that it comes from, by name: its own, and those of its parents, its components and
    /// its data. Texts that are no files, and embedded ones, are named in the same way.
    #[must_use]
    pub fn paths(&self) -> BTreeSet<&Path> {
        let mut paths = BTreeSet::new();
        self.node.add_paths(&mut paths);
        paths
    }

    /// The file with its parents and components inlined, as YAML that reads back as the same.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        self.node.to_yaml()
    }

    /// The validated model, with parameters set by name, and what is doubtful, but not wrong.
    ///
    /// # Errors
    ///
    /// All that is wrong with it.
    pub fn resolve(&self, settings: &[Setting]) -> Result<(Model, Diagnostics), Diagnostics> {
        let mut all = self.warnings.clone();
        match resolve::resolve(&self.kind, settings) {
            Ok((model, doubts)) => {
                all.extend(doubts);
                Ok((model, all.without_repeats()))
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
    /// How the value is written, where that tells more of its digits.
    pub written: Option<Expression>,
    /// Where the value is written, if that is in a file.
    pub place: Option<Place>,
}
