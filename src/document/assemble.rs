//! Inlining of parents, components, data and other fractals into a file, which makes it self-contained.

mod fractals;
mod parameters;
mod stamps;

use std::sync::Arc;

use crate::catalogue::{Catalogue, Shelf, is_same_file};
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source, listed, nearest};
use crate::kind::Kind;

use super::KindDocument;
use super::data;
use super::merge::{Entries, merge};
use super::mesh;
use super::node::{Key, Node, Value};
use super::read::{DESCRIPTION, check_description};
use super::shape::{Form, Shape};
use super::yaml::{Budget, Size};

/// Maximum length of a chain of parents.
const MAX_PARENTS: usize = 32;
/// Number of missing components after which no more are looked up, and the file is not read further.
const MAX_MISSING: usize = 100;

/// Inlines everything that the file in `source` names. Returns the result, its kind, and whether all
/// names were resolved, or `None` if the text cannot be read as a file of any kind, or too many names are unknown.
pub(super) fn assemble(
    source: &Arc<Source>,
    catalogue: &Catalogue,
    diagnostics: &mut Diagnostics,
) -> Option<(Node, Kind, bool)> {
    let node = Node::parse_with(source, diagnostics)?;
    let mut fractals = 0;
    assemble_within(&[], &mut fractals, source, node, catalogue, diagnostics)
}

/// Assembles a file that other files name as a set. `around` lists these files, the outermost first;
/// `fractals` counts the fractals that have been inlined into the outermost one.
fn assemble_within(
    around: &[Arc<Source>],
    fractals: &mut usize,
    source: &Arc<Source>,
    node: Node,
    catalogue: &Catalogue,
    diagnostics: &mut Diagnostics,
) -> Option<(Node, Kind, bool)> {
    let mut assembly = Assembly {
        catalogue,
        diagnostics,
        around,
        fractals,
        chain: vec![Arc::clone(source)],
        parameters: Vec::new(),
        components: Vec::new(),
        missing: 0,
        budget: Budget::default(),
        too_large: false,
        generation: 0,
        complete: true,
        kind: None,
        extending: None,
    };
    let (place, mut entries) = assembly.extended(node)?;
    for (_, node) in &entries {
        assembly.budget.own(Size::of(node));
    }
    let kind = assembly.kind.unwrap_or(Kind::Rule);
    if kind == Kind::LSystem {
        stamps::add(&mut entries);
    }
    assembly.inline_all(&mut entries, KindDocument::table(kind).shape);
    if assembly.missing >= MAX_MISSING {
        return None;
    }
    assembly.hoist_parameters(&mut entries);
    assembly.inline_data(&mut entries);
    let complete = assembly.complete;
    let value = Value::Mapping(entries);
    Some((Node { place, value }, kind, complete))
}

struct Assembly<'a> {
    catalogue: &'a Catalogue,
    diagnostics: &'a mut Diagnostics,
    /// The files that name this one as a set, the outermost first.
    around: &'a [Arc<Source>],
    /// Number of fractals inlined so far into the outermost file, nested ones included.
    fractals: &'a mut usize,
    /// The file, its parent, and so on. The index of a file in this list is its generation.
    chain: Vec<Arc<Source>>,
    /// The files' own parameters, with their generations.
    parameters: Vec<(usize, Key)>,
    /// The components that have been looked up.
    components: Vec<Component>,
    /// Number of components and fractals that were not found.
    missing: usize,
    /// Size of the file including its components.
    budget: Budget,
    /// Whether the limit of the size has been exceeded.
    too_large: bool,
    /// Generation of the file whose components are being inlined.
    generation: usize,
    /// Whether all names have been resolved.
    complete: bool,
    /// Kind of the file, which its parents must share.
    kind: Option<Kind>,
    /// Place of the `extends` key's value while the parent is read.
    extending: Option<Place>,
}

/// A component that a rule names.
struct Component {
    shelf: Shelf,
    name: String,
    /// Place of its first use.
    place: Place,
    /// Greatest generation among the files that name it: that of the oldest ancestor.
    generation: usize,
    /// The component without its parameters; `None` if it was not found.
    node: Option<Node>,
    parameters: Entries,
}

impl Assembly<'_> {
    fn parse(&mut self, source: &Arc<Source>) -> Option<Node> {
        Node::parse_with(source, self.diagnostics)
    }

    fn error(&mut self, place: &Place, message: String, hint: &str) {
        self.diagnostics
            .push(Diagnostic::error(message).at(place).hint(hint));
    }

    /// Returns the entries of a single file. Misspelt keys are replaced by the intended ones, and
    /// unknown keys are dropped; both are reported.
    fn entries(&mut self, node: Node) -> Option<(Place, Entries)> {
        let Value::Mapping(entries) = node.value else {
            let message = format!("a rule is needed here, this is {}", node.kind());
            self.error(
                &node.place,
                message,
                KindDocument::table(Kind::Rule).shape.hint,
            );
            return None;
        };
        let kind = self.kind_of(&entries)?;
        let keys = entries.iter().map(|(key, _)| key);
        let meant = KindDocument::table(kind)
            .shape
            .meant(keys, |diagnostic| self.diagnostics.push(diagnostic));
        let mut known = Vec::new();
        for (name, (mut key, value)) in meant.into_iter().zip(entries) {
            if let Some(name) = name {
                if let ("params", Value::Mapping(params)) = (name, &value.value) {
                    let generation = self.chain.len() - 1;
                    let keys = params.iter().map(|(key, _)| (generation, key.clone()));
                    self.parameters.extend(keys);
                }
                key.name = name.into();
                known.push((key, value));
            } else if matches!(value.value, Value::Mapping(_)) {
                self.complete = false;
            }
        }
        Some((node.place, known))
    }

    /// Returns the kind of the file, and reports a kind that differs from that of the file that extends
    /// it.
    fn kind_of(&mut self, entries: &Entries) -> Option<Kind> {
        let written = entries.iter().find(|(key, _)| key.name == "kind");
        let written_kind = match written {
            None => Kind::Rule,
            Some((_, node)) => {
                let known = match &node.value {
                    Value::Text(name) => Kind::named(name),
                    _ => None,
                };
                if known.is_none() {
                    let message = format!("kind '{}' is not known", node.place.text());
                    let names = listed(Kind::ALL.into_iter().map(Kind::name));
                    let hint = format!("the kinds are: {names}; without `kind` it is a rule");
                    self.error(&node.place, message, &hint);
                }
                // The keys of a file of unknown kind cannot be checked.
                known.or_else(|| {
                    Kind::named(nearest(node.place.text(), Kind::ALL.map(Kind::name))?)
                })?
            }
        };
        match self.kind {
            Some(kind) if kind != written_kind => {
                let place = self.extending.clone()?;
                let message = format!(
                    "this is of kind '{}', not '{}'",
                    written_kind.name(),
                    kind.name()
                );
                let hint = format!(
                    "a file extends one of its own kind: kind: {}",
                    written_kind.name()
                );
                self.error(&place, message, &hint);
                None
            }
            _ => {
                self.kind = Some(written_kind);
                Some(written_kind)
            }
        }
    }

    /// Returns the entries of a file merged with those of its parents.
    fn extended(&mut self, node: Node) -> Option<(Place, Entries)> {
        let (place, mut entries) = self.entries(node)?;
        let Some(index) = entries.iter().position(|(key, _)| key.name == "extends") else {
            return Some((place, entries));
        };
        let (_, parent) = entries.remove(index);
        let parents = self.parent(&parent).unwrap_or_else(|| {
            self.complete = false;
            let kind = self.kind.unwrap_or(Kind::Rule);
            match Node::made(KindDocument::table(kind).stand_in, &parent.place).value {
                Value::Mapping(entries) => entries,
                _ => Vec::new(),
            }
        });
        merge(&mut entries, parents);
        Some((place, entries))
    }

    /// Reads the parent that a node names and returns its entries, merged with those of its own
    /// parents.
    fn parent(&mut self, parent: &Node) -> Option<Entries> {
        let Value::Text(name) = &parent.value else {
            let message = format!(
                "the name of a rule is needed here, this is {}",
                parent.kind()
            );
            self.error(&parent.place, message, "extends: koch");
            return None;
        };
        let found = match self.catalogue.parent(name, &self.chain) {
            Ok(found) => found,
            Err(error) => {
                self.diagnostics.push(error.at(&parent.place));
                return None;
            }
        };
        if self.chain.iter().any(|source| is_same_file(source, &found)) {
            let names = self.chain.iter().map(|source| source.name());
            let names: Vec<_> = names.chain([found.name()]).collect();
            let hint = format!("each extends the next: {}", names.join(", "));
            self.error(&parent.place, format!("'{name}' extends itself"), &hint);
            return None;
        }
        if self.chain.len() > MAX_PARENTS {
            let message = format!("more than {MAX_PARENTS} rules extend each other");
            self.error(&parent.place, message, "write the rule out");
            return None;
        }
        self.chain.push(Arc::clone(&found));
        self.extending = Some(parent.place.clone());
        let node = self.parse(&found)?;
        Some(self.extended(node)?.1)
    }

    /// Replaces names of components and of fractals by what they name, where the table of keys has such
    /// names.
    fn inline_all(&mut self, entries: &mut Entries, shape: &'static Shape) {
        for (key, node) in entries {
            let written_in = |rule: &Arc<Source>| Arc::ptr_eq(rule, key.place.source());
            self.generation = self.chain.iter().position(written_in).unwrap_or(0);
            self.inline_key(key, node, shape);
        }
    }

    fn inline_key(&mut self, key: &Key, node: &mut Node, shape: &'static Shape) {
        if let Some(member) = shape.members().find(|member| member.name == key.name) {
            self.inline(node, &member.holds);
        }
    }

    fn inline(&mut self, node: &mut Node, form: &'static Form) {
        match (form, &mut node.value) {
            (Form::File(shelf), Value::Text(_)) if Shelf::COMPONENTS.contains(shelf) => {
                self.component(node, *shelf);
            }
            (Form::Grown, Value::Text(_) | Value::Mapping(_)) => self.inline_fractal(node),
            (Form::MeshFile, Value::Text(name)) => {
                let read = self.catalogue.bytes(name, &node.place, mesh::MAX_BYTES);
                let read = read.and_then(|(path, bytes)| {
                    let place = Place::new(&Source::new(path.to_string_lossy(), ""), 0..0);
                    mesh::read(&path, &bytes, &place)
                });
                match read {
                    Ok(mesh) => *node = mesh,
                    Err(error) => {
                        self.diagnostics.push(error.at(&node.place));
                        self.complete = false;
                        node.value = Value::Text(String::new());
                    }
                }
            }
            (Form::Either(forms), _) => forms.iter().for_each(|form| self.inline(node, form)),
            (Form::List(form, ..), Value::Sequence(entries)) => {
                entries.iter_mut().for_each(|node| self.inline(node, form));
            }
            (Form::Names(form, _), Value::Mapping(entries)) => {
                let entries = entries.iter_mut();
                entries.for_each(|(_, node)| self.inline(node, form));
            }
            (Form::Mapping(shape), Value::Mapping(entries)) => {
                let entries = entries.iter_mut();
                entries.for_each(|(key, node)| self.inline_key(key, node, shape));
            }
            _ => {}
        }
    }

    /// Replaces the name of a data file under `interpolate` by the points in it.
    fn inline_data(&mut self, entries: &mut Entries) {
        let mut interpolation = { entries.iter_mut() }.filter(|(key, _)| key.name == "interpolate");
        let Some((_, interpolation)) = interpolation.next() else {
            return;
        };
        let pieces = match interpolation.get("scale").map(|node| &node.value) {
            Some(Value::Sequence(scales)) => scales.len().max(2),
            _ => 2,
        };
        let Some(points) = interpolation.get_mut("points") else {
            return;
        };
        let Value::Text(name) = &points.value else {
            return;
        };
        let found = self.catalogue.data(name, &points.place);
        let found = found.map_err(|error| error.at(&points.place));
        *points = found
            .and_then(|source| data::read(&source))
            .unwrap_or_else(|error| {
                self.diagnostics.push(error);
                self.complete = false;
                // Valid points as a placeholder, which cause no further diagnostics.
                let all: Vec<_> = (0..=pieces).map(|x| format!("[{x}, {}]", x % 2)).collect();
                Node::made(&format!("[{}]", all.join(", ")), &points.place)
            });
    }

    /// Replaces the name of a component by the component, or by a placeholder if it cannot be found.
    fn component(&mut self, node: &mut Node, shelf: Shelf) {
        let Value::Text(name) = &node.value else {
            return;
        };
        let generation = self.generation;
        let known = self
            .components
            .iter_mut()
            .find(|known| known.shelf == shelf && known.name == *name);
        let component = match known {
            Some(known) => {
                known.generation = known.generation.max(generation);
                known.node.clone()
            }
            // The file is not read further.
            None if self.missing >= MAX_MISSING => return,
            None => {
                let found = self.find(name, shelf, &node.place);
                self.missing += usize::from(found.is_none());
                let (component, parameters) = found.unzip();
                self.components.push(Component {
                    shelf,
                    name: name.clone(),
                    place: node.place.clone(),
                    generation,
                    node: component.clone(),
                    parameters: parameters.unwrap_or_default(),
                });
                component
            }
        };
        let component = component.filter(|component| self.has_room(component, &node.place));
        *node = component.unwrap_or_else(|| {
            self.complete = false;
            let key = match shelf {
                Shelf::BaseElements => "points",
                _ => "elements",
            };
            Node::made(&format!("{{{key}: [[0, 0], [0.5, 0]]}}"), &node.place)
        });
    }

    /// Returns whether the size limit admits another component. Exceeding the limit is reported once.
    fn has_room(&mut self, component: &Node, place: &Place) -> bool {
        if self.too_large {
            return false;
        }
        let room = self.budget.component(Size::of(component), place);
        if let Err(error) = room {
            self.diagnostics.push(error);
            self.too_large = true;
        }
        !self.too_large
    }

    /// Reads a component by name. Returns the component without its metadata, and its parameters.
    fn find(&mut self, name: &str, shelf: Shelf, place: &Place) -> Option<(Node, Entries)> {
        let source = match self.catalogue.component(shelf, name) {
            Ok(source) => source,
            Err(error) => {
                self.diagnostics.push(error.at(place));
                return None;
            }
        };
        let mut component = self.parse(&source)?;
        let mut parameters = Vec::new();
        match &mut component.value {
            Value::Mapping(entries) => {
                if let Some(index) = entries.iter().position(|(key, _)| key.name == "params") {
                    parameters = self.component_parameters(entries.remove(index).1);
                }
                let is_description =
                    |key: &Key| DESCRIPTION.iter().any(|known| known.name == key.name);
                let (description, rest) = std::mem::take(entries)
                    .into_iter()
                    .partition(|(key, _)| is_description(key));
                *entries = rest;
                let description = Node {
                    place: component.place.clone(),
                    value: Value::Mapping(description),
                };
                check_description(&description, self.diagnostics);
            }
            Value::Sequence(_) => {}
            _ => {
                let message = format!("this is no {} but {}", shelf.noun(), component.kind());
                let hint = "`kfrac list` shows what the library has";
                self.error(&component.place, message, hint);
                return None;
            }
        }
        Some((component, parameters))
    }

    fn component_parameters(&mut self, params: Node) -> Entries {
        let kind = params.kind();
        if let Value::Mapping(params) = params.value {
            return params;
        }
        self.complete = false;
        let message = format!("a mapping of parameters is needed here, this is {kind}");
        self.error(&params.place, message, "params: {angle: 45}");
        Vec::new()
    }
}
