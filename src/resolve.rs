//! Resolution of documents to validated models: names are looked up, expressions are compiled,
//! everything is checked, and all mistakes are reported together.
//!
//! Consequences of a reported mistake are not reported: expressions that could not be read, and names
//! that a missing file may define, are unknown, as are all values computed from them.

mod family;
mod fractal;
mod ifs;
mod instancing;
mod interpolation;
mod lsystem;
mod map;
mod metadata;
mod numbers;
mod outline;
mod parameters;
mod random;
mod rule;
mod set;
mod space;
mod tint;
mod unused;

pub(crate) use family::VaryingMaps;

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source, did_you_mean};
use crate::document::{Document, KindDocument, MetadataDocument, Setting};
use crate::expression::Scope;
use crate::geometry::{DAffine2, DAffine3, Frame2, Frame3, Solid};
use crate::metadata::Metadata;
use crate::model::Model;
use instancing::OfInstancing;
use rule::OfRule;

/// Number of mistakes after which expressions are not checked further.
const MAX_MISTAKES: usize = 1000;

/// Number of mistakes after which no similar names are searched: only 100 mistakes are shown.
const MAX_SUGGESTIONS: usize = 200;

impl Document {
    /// Reads a file of any kind from a text.
    ///
    /// # Errors
    ///
    /// Returns all mistakes in the text, its parents and its components.
    pub fn read(source: &Arc<Source>, catalogue: &Catalogue) -> Result<Self, Diagnostics> {
        let mut document = Self::parse(source, catalogue)?;
        let mut all = std::mem::take(&mut document.warnings);
        if all.has_errors() {
            // Mistakes in names and values are reported together with those of syntax.
            all.extend(resolve(document.kind(), &[]).err().unwrap_or_default());
            return Err(all.without_repeats());
        }
        document.warnings = all.without_repeats();
        Ok(document)
    }

    /// Resolves the document with the given parameters and returns the validated model with all
    /// warnings.
    ///
    /// # Errors
    ///
    /// Returns all mistakes and warnings if the document or a setting is invalid.
    pub fn resolve(&self, settings: &[Setting]) -> Result<(Model, Diagnostics), Diagnostics> {
        let mut all = self.warnings.clone();
        let repeated = self.repeated(settings)?;
        match resolve(repeated.as_ref().unwrap_or(self.kind()), settings) {
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

/// Validates a document, with parameters set from outside, and returns the model with warnings.
///
/// # Errors
///
/// Returns all mistakes and warnings if there is a mistake.
fn resolve(
    document: &KindDocument,
    settings: &[Setting],
) -> Result<(Model, Diagnostics), Diagnostics> {
    match document {
        KindDocument::Ifs(document) if document.is_random() => resolve(
            &KindDocument::Instancing(ifs::structure(document)),
            settings,
        ),
        KindDocument::Rule(document) if document.is_in_space => {
            resolved(&document.metadata, settings, |to, metadata| {
                Some({ to as &mut Resolver<OfRule<Frame3>> }.rule(document, metadata))
            })
        }
        KindDocument::Rule(document) => resolved(&document.metadata, settings, |to, metadata| {
            Some({ to as &mut Resolver<OfRule<Frame2>> }.rule(document, metadata))
        }),
        KindDocument::Ifs(document) if document.is_in_space => {
            resolved(&document.metadata, settings, |to, metadata| {
                to.system::<DAffine3, 3>(document, metadata)
            })
        }
        KindDocument::Ifs(document) => resolved(&document.metadata, settings, |to, metadata| {
            to.system::<DAffine2, 2>(document, metadata)
        }),
        KindDocument::Instancing(document) if document.is_in_space => {
            resolved(&document.metadata, settings, |to, metadata| {
                { to as &mut Resolver<OfInstancing<DAffine3>> }.structure(document, metadata)
            })
        }
        KindDocument::Instancing(document) => {
            resolved(&document.metadata, settings, |to, metadata| {
                { to as &mut Resolver<OfInstancing<DAffine2>> }.structure(document, metadata)
            })
        }
        KindDocument::LSystem(document) if document.is_in_space => {
            resolved(&document.metadata, settings, |to, metadata| {
                to.lsystem_in_space(document, metadata)
            })
        }
        KindDocument::LSystem(document) => {
            resolved(&document.metadata, settings, |to, metadata| {
                to.lsystem_in_plane(document, metadata)
            })
        }
    }
}

/// Resolves the metadata and the model, and adds warnings of unused parameters.
fn resolved<K: Default, M: Into<Model>>(
    document: &MetadataDocument,
    settings: &[Setting],
    model: impl FnOnce(&mut Resolver<K>, Metadata) -> Option<M>,
) -> Result<(Model, Diagnostics), Diagnostics> {
    let mut resolver = Resolver::<K>::default();
    let metadata = resolver.metadata(document, settings);
    resolver
        .used
        .extend(document.used_by_ranges.iter().cloned());
    let model = model(&mut resolver, metadata);
    let model = match model {
        Some(model) if !resolver.diagnostics.has_errors() => model.into(),
        _ => return Err(resolver.diagnostics),
    };
    let mut doubts = Diagnostics::default();
    doubts.extend(unused::parameters(document, &resolver.used));
    if model.metadata().style.tube.is_some() && !matches!(model, Model::LSystemInSpace(_)) {
        let warning = Diagnostic::warning("`tube` has an effect on L-systems in space only");
        let hint = "it makes tubes of the lines of their turtles";
        doubts.push(warning.at(&document.place.first_line()).hint(hint));
    }
    doubts.extend(resolver.diagnostics);
    Ok((model, doubts))
}

/// State of the resolution of a file, with the state `kind` that is specific to the kind of file.
#[derive(Default)]
struct Resolver<K> {
    diagnostics: Diagnostics,
    /// Number of errors.
    mistakes: usize,
    /// Parameters of the file.
    constants: Scope,
    /// Names that expressions use.
    used: HashSet<String>,
    /// Names of random variables, which some expressions may not use.
    random: HashSet<String>,
    /// Whether a parent or a component is missing. Unknown names may be defined there.
    incomplete: bool,
    /// Whether parameters are variables, so that numbers need not be constants.
    varies: bool,
    /// Number of lines, curves and sides in all sets that are fractals.
    pieces: usize,
    /// Number of convex pieces of all polygons in space.
    triangles: usize,
    /// Solids that are written as names.
    solids: HashMap<String, Solid>,
    /// [Work](crate::work) of growing all sets that are fractals.
    work: u64,
    /// Work of the set that took most of it, and its place.
    costliest: Option<(u64, Place)>,
    kind: K,
}

impl<K> Resolver<K> {
    fn error(&mut self, place: &Place, message: impl Into<String>) {
        self.mistakes += 1;
        self.diagnostics.push(Diagnostic::error(message).at(place));
    }

    fn error_with_hint(
        &mut self,
        place: &Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.mistakes += 1;
        self.diagnostics
            .push(Diagnostic::error(message).at(place).hint(hint));
    }

    /// Returns a suggestion for a misspelt name, unless there are too many mistakes to show another.
    fn suggestion<'n>(
        &self,
        name: &str,
        candidates: impl IntoIterator<Item = &'n str>,
    ) -> Option<String> {
        if self.mistakes >= MAX_SUGGESTIONS {
            return None;
        }
        did_you_mean(name, candidates)
    }

    fn warn(&mut self, place: &Place, message: impl Into<String>, hint: &str) {
        self.diagnostics
            .push(Diagnostic::warning(message).at(place).hint(hint));
    }
}

/// Returns a value as an integer from 0 to `most`; `None` if it is not one.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is checked"
)]
fn whole_number(value: f64, most: u32) -> Option<u32> {
    (value >= 0.0 && value <= f64::from(most) && value.fract() == 0.0).then_some(value as u32)
}
