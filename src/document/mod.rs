//! Documents: the content of files as written, with source spans, before names are looked up and
//! expressions are evaluated.
//!
//! [`Document::read`] parses a file, inlines its parents (`extends`) and components, and reads the
//! result into the document of its kind. YAML is not visible outside this module.
//!
//! The reference of files follows; `library/README.md` has it too.
//!
#![doc = include_str!("../../library/README.md")]

mod animation;
mod assemble;
mod data;
mod dataset;
mod density;
mod ifs;
mod instancing;
mod lsystem;
mod mapping;
mod merge;
mod mesh;
mod metadata;
pub mod node;
mod read;
mod reader;
mod repeat;
mod rule;
mod schema;
mod shape;
mod style;
mod symmetry;
mod view;
mod yaml;

pub use animation::FilmOption;
pub use dataset::{
    AcceptDocument, CategoriesDocument, DatasetDocument, Framing, InstancesDocument, Law,
    LawDocument, Mode, PictureDocument, PictureFormat, RandomDocument, SourceDocument,
};
pub use ifs::{
    AlternativeMapsDocument, CondensationDocument, EdgeDocument, FormDocument, FractalDocument,
    IfsDocument, InterpolationDocument, LinearDocument, MapDocument, MapsDocument, MeshDocument,
    Scales, ScatterDocument, ShapeDocument, SolidDocument, TurnDocument, VerticesDocument,
};
pub use instancing::{
    AlternativeDocument, InstanceDocument, InstancingDocument, LevelDocument, MasterDocument,
    ObjectDocument, TransformDocument, UnionDocument,
};
pub use lsystem::{
    ActionDocument, LSystemDocument, ModuleDocument, ProductionDocument, StampDocument,
    SymbolDocument, TropismDocument, WordDocument,
};
pub use metadata::{MetadataDocument, ParameterDocument};
pub(crate) use read::corners_of_solid;
pub use read::{
    BaseElementDocument, CaseDocument, CuboidDocument, DiskDocument, EllipseDocument,
    EllipsoidDocument, InSpace, InitiatorDocument, Listed, MoveDocument, RotateDocument,
    ShaftDocument, SphereDocument, SurfaceDocument, TintDocument,
};
pub use rule::{
    Entry, GeneratorDocument, PartDocument, PieceDocument, RuleDocument, SelectDocument,
    WhichPoints,
};

pub use schema::{schema, schema_of_all};
pub use symmetry::SymmetryDocument;

pub use crate::written::{Written, WrittenNumber, WrittenPoint};

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostics, Place, Source};
use crate::expression::{Expression, PARTS};
use crate::kind::Kind;

use node::{Node, Value};
use read::{KindTable, OfKind, read_metadata};
use reader::Reader;

/// Makes [`KindDocument`] from a table of kinds and their documents.
macro_rules! documents {
    ($($(#[$doc:meta])* $kind:ident($document:ty);)*) => {
        /// The content of a file as written, by kind.
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum KindDocument { $($(#[$doc])* $kind($document),)* }

        impl KindDocument {
            /// Returns the metadata that files of all kinds have.
            #[must_use]
            pub fn metadata(&self) -> &MetadataDocument {
                match self { $(Self::$kind(document) => &document.metadata,)* }
            }

            /// Returns the definition of a kind.
            fn table(kind: Kind) -> &'static KindTable {
                match kind { $(Kind::$kind => <$document>::TABLE,)* }
            }

            /// Returns the kind of the file.
            fn kind(&self) -> Kind {
                match self { $(Self::$kind(_) => Kind::$kind,)* }
            }

            /// Reads a file after preceding stages, whose diagnostics are extended by those of reading.
            fn read_after(
                found: &mut Diagnostics,
                kind: Kind,
                node: &Node,
                complete: bool,
            ) -> Option<Self> {
                let mut reader = Reader::after(found, node);
                let read = Self::read(&mut reader, kind, node, complete);
                found.extend(reader.diagnostics);
                read
            }

            /// Reads a file as [`read_after`](Self::read_after) does, with its repetitions written out.
            fn read_repeated(
                found: &mut Diagnostics,
                kind: Kind,
                node: &Node,
                complete: bool,
            ) -> Option<Self> {
                let all = repeat::written_out(node, found)?;
                let mut read = Self::read_after(found, kind, &all.node, complete)?;
                match &mut read {
                    $(Self::$kind(document) => document.metadata.used_by_ranges = all.used,)*
                }
                Some(read)
            }

            /// Reads a file whose parents and components are inlined. `complete` states that all of them were
            /// found.
            fn read(reader: &mut Reader, kind: Kind, node: &Node, complete: bool) -> Option<Self> {
                let fields = reader.fields(node, Self::table(kind).shape)?;
                let metadata = read_metadata(reader, &fields);
                Some(match kind {
                    $(Kind::$kind => {
                        let mut document = <$document>::read(reader, &fields, metadata);
                        document.metadata.complete = complete && !reader.names_are_missing;
                        Self::$kind(document)
                    })*
                })
            }
        }
    };
}

documents! {
    /// A production rule.
    Rule(RuleDocument);
    /// An iterated function system.
    Ifs(IfsDocument);
    /// A structure of objects that instance each other.
    Instancing(InstancingDocument);
    /// An L-system.
    LSystem(LSystemDocument);
}

/// A file with its parents and components inlined.
#[derive(Clone, Debug)]
pub struct Document {
    node: Node,
    kind: KindDocument,
    /// Whether all parents and components were found.
    complete: bool,
    /// Whether lists of the file have repetitions, whose number may depend on parameters.
    repeats: bool,
    pub(crate) warnings: Diagnostics,
}

impl Document {
    /// Reads a file without resolving it; its warnings contain all mistakes found so far.
    ///
    /// # Errors
    ///
    /// Returns all mistakes if the text is no document of any kind.
    pub(crate) fn parse(source: &Arc<Source>, catalogue: &Catalogue) -> Result<Self, Diagnostics> {
        let mut warnings = Diagnostics::default();
        let assembled = assemble::assemble(source, catalogue, &mut warnings);
        let parsed = assembled.and_then(|(node, kind, complete)| {
            let repeats = repeat::repeats(&node);
            let kind = match repeats {
                true => KindDocument::read_repeated(&mut warnings, kind, &node, complete),
                false => KindDocument::read_after(&mut warnings, kind, &node, complete),
            };
            Some((node, kind?, complete, repeats))
        });
        match parsed {
            Some((node, kind, complete, repeats)) => Ok(Self {
                node,
                kind,
                complete,
                repeats,
                warnings,
            }),
            None => Err(warnings.without_repeats()),
        }
    }

    /// Returns the content for settings of its parameters, if repetitions may depend on them; `None` if it is as written.
    ///
    /// # Errors
    ///
    /// If a repetition has a mistake for these settings.
    pub(crate) fn repeated(
        &self,
        settings: &[Setting],
    ) -> Result<Option<KindDocument>, Diagnostics> {
        if !self.repeats || settings.is_empty() {
            return Ok(None);
        }
        let mut found = Diagnostics::default();
        let node = self.node_with(settings);
        let kind = self.kind.kind();
        match KindDocument::read_repeated(&mut found, kind, &node, self.complete) {
            Some(kind) if !found.has_errors() => Ok(Some(kind)),
            _ => Err(found),
        }
    }

    /// Returns the values of the file, with those of its parents and components.
    #[cfg(feature = "studio")]
    pub(crate) fn node(&self) -> &Node {
        &self.node
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
            _ => None,
        }
    }

    /// Returns the L-system as written; `None` for other kinds.
    #[must_use]
    pub fn lsystem(&self) -> Option<&LSystemDocument> {
        match &self.kind {
            KindDocument::LSystem(system) => Some(system),
            _ => None,
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

    /// Returns the file as [`to_yaml`](Self::to_yaml) does, with other values of its parameters. Settings of parameters that
    /// the file does not have are left out.
    #[must_use]
    pub fn to_yaml_with(&self, settings: &[Setting]) -> String {
        self.node_with(settings).to_yaml()
    }

    /// Returns the values of the file with other values of its parameters.
    fn node_with(&self, settings: &[Setting]) -> Node {
        let mut node = self.node.clone();
        for setting in settings {
            if let Some(value) = node.get_mut("params").and_then(|it| setting.of(it)) {
                value.value = match &setting.written {
                    Some(written) => Value::Text(written.to_string()),
                    None => Value::Number(setting.value),
                };
            }
        }
        node
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

impl Setting {
    /// Returns the value of the parameter among those of a file.
    fn of<'n>(&self, params: &'n mut Node) -> Option<&'n mut Node> {
        let mut parts = PARTS.iter().enumerate();
        let part = parts.find_map(|(part, suffix)| Some((self.name.strip_suffix(suffix)?, part)));
        let (name, part) = match part {
            Some((name, part)) => (name, Some(part)),
            None => (self.name.as_str(), None),
        };
        let mut value = params.get_mut(name)?;
        if let Value::Mapping(_) = value.value {
            value = value.get_mut("value")?;
        }
        let Some(part) = part else { return Some(value) };
        match &mut value.value {
            Value::Sequence(parts) => parts.get_mut(part),
            _ => None,
        }
    }
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
