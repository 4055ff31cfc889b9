//! Documents: the content of files as written, with source spans, before names are looked up and
//! expressions are evaluated.
//!
//! [`Document::read`] parses a file, inlines its parents (`extends`) and components, and reads the
//! result into the document of its kind. YAML is not visible outside this module.

mod assemble;
mod data;
mod ifs;
mod instancing;
mod lsystem;
mod merge;
mod metadata;
pub mod node;
mod read;
mod reader;
mod rule;
mod schema;
mod shape;
mod style;
mod yaml;

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
pub use metadata::{MetadataDocument, ParameterDocument};
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

/// A value with its source span.
#[derive(Clone, Debug)]
pub struct Written<T> {
    /// The value.
    pub value: T,
    /// Source span of the value.
    pub place: Place,
}

/// A number as written: an expression.
pub type Number = Written<Expression>;

/// A point as written.
#[derive(Clone, Debug)]
pub struct Point {
    /// First coordinate, to the right.
    pub x: Number,
    /// Second coordinate, upwards.
    pub y: Number,
    /// Source span of the point.
    pub place: Place,
}

impl Point {
    /// Returns a placeholder for a point that cannot be read.
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

    /// Returns (0, 0) for a point that is left out.
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

    /// Returns a complex parameter of the given name as a point.
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

    /// Returns the name of the complex parameter if the point is written as one.
    pub(crate) fn name(&self) -> Option<&str> {
        let names = self.x.value.names();
        let (name, _) = names.first()?;
        let name = name.strip_suffix(PARTS[0])?;
        (self.place.text() == name).then(|| self.place.text())
    }

    /// Returns whether the expressions of both coordinates are written alike.
    #[must_use]
    pub fn is_written_like(&self, other: &Self) -> bool {
        self.x.value == other.x.value && self.y.value == other.y.value
    }
}

/// The content of a file as written, by kind.
#[derive(Clone, Debug)]
#[non_exhaustive]
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
    /// Returns the metadata that files of all kinds have.
    #[must_use]
    pub fn metadata(&self) -> &MetadataDocument {
        match self {
            Self::Rule(rule) => &rule.heading,
            Self::Ifs(ifs) => &ifs.heading,
            Self::Instancing(structure) => &structure.heading,
            Self::LSystem(system) => &system.heading,
        }
    }
}

/// A file with its parents and components inlined.
#[derive(Clone, Debug)]
pub struct Document {
    node: Node,
    kind: KindDocument,
    warnings: Diagnostics,
}

impl Document {
    /// Reads a file of any kind from a text.
    ///
    /// # Errors
    ///
    /// Returns all mistakes in the text, its parents and its components.
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
            // Mistakes in names and values are reported together with those of syntax.
            diagnostics.extend(resolve::resolve(&kind, &[]).err().unwrap_or_default());
            return Err(diagnostics.without_repeats());
        }
        Ok(Self {
            node,
            kind,
            warnings: diagnostics.without_repeats(),
        })
    }

    /// Returns the content as written.
    #[must_use]
    pub fn kind(&self) -> &KindDocument {
        &self.kind
    }

    /// Returns the metadata that files of all kinds have.
    #[must_use]
    pub fn metadata(&self) -> &MetadataDocument {
        self.kind.metadata()
    }

    /// Returns the production rule as written; `None` for other kinds.
    #[must_use]
    pub fn rule(&self) -> Option<&RuleDocument> {
        match &self.kind {
            KindDocument::Rule(rule) => Some(rule),
            KindDocument::Ifs(_) | KindDocument::Instancing(_) | KindDocument::LSystem(_) => None,
        }
    }

    /// Returns the paths of the files from which the document was read: its own, and those of its
    /// parents, components and data. Embedded files and texts that are not files are listed by their
    /// names.
    #[must_use]
    pub fn paths(&self) -> BTreeSet<&Path> {
        let mut paths = BTreeSet::new();
        self.node.add_paths(&mut paths);
        paths
    }

    /// Returns the file with its parents and components inlined, as YAML that reads back as an equal
    /// document.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        self.node.to_yaml()
    }

    /// Resolves the document with the given parameters and returns the validated model with all
    /// warnings.
    ///
    /// # Errors
    ///
    /// Returns all mistakes and warnings if the document or a setting is invalid.
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

/// A parameter value from outside the file.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Name of the parameter.
    pub name: String,
    /// Value of the parameter.
    pub value: f64,
    /// The value as written, if that expression has more digits than `value`.
    pub written: Option<Expression>,
    /// Source span of the value, if it is written in a file.
    pub place: Option<Place>,
}

impl From<(&str, f64)> for Setting {
    fn from((name, value): (&str, f64)) -> Self {
        Self {
            name: name.into(),
            value,
            written: None,
            place: None,
        }
    }
}
