//! Resolution of instancing structures. Objects with levels are expanded to one object for each level
//! that the scene reaches.

mod content;
mod loops;
mod maps;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::diagnostic::{Place, listed};
use crate::document::{
    InstanceDocument, InstancingDocument, LevelDocument, MasterDocument, ObjectDocument,
    ShapeDocument, TransformDocument, UnionDocument,
};
use crate::draws::Variable;
use crate::expression::{Program, Scope};
use crate::instancing::{FIRST, Instancing, LinearForm, ObjectDefinition};
use crate::metadata::Metadata;
use crate::style::ColorBy;

use super::Resolver;
use super::tint::PreparedTint;
pub(super) use maps::StructureMap;

/// Maximum number of objects after the expansion of levels.
const MAX_OBJECTS: usize = 20_000;

/// Maximum number of instances in all objects, where sides of shapes and long formulas count as well.
const MAX_INSTANCES: usize = 250_000;

/// [Work](Program::work) of formulas that takes as long as an instance.
const SHORT: usize = 16;

/// State that is specific to structures.
pub(super) struct OfInstancing<M: StructureMap> {
    /// The unions of the objects as written.
    unions: Vec<Union<M>>,
    /// The names of all objects.
    written: BTreeSet<String>,
    /// The definitions of each name.
    names: BTreeMap<String, Definitions>,
    /// The objects that have been reached: the index of the union, and the level.
    reached: Vec<(usize, Option<f64>)>,
    numbers: BTreeMap<(usize, u64), usize>,
    is_too_many: bool,
    /// Number of instances and of the sides of shapes among them, with the work of long formulas.
    size: usize,
    /// Parameters of the file.
    constants: Arc<Scope>,
    /// Random variables of the transforms of instances.
    variables: Arc<[Variable]>,
}

impl<M: StructureMap> Default for OfInstancing<M> {
    fn default() -> Self {
        Self {
            unions: Vec::new(),
            written: BTreeSet::new(),
            names: BTreeMap::new(),
            reached: Vec::new(),
            numbers: BTreeMap::new(),
            is_too_many: false,
            size: 0,
            constants: Arc::default(),
            variables: Arc::default(),
        }
    }
}

/// The objects that share a name, as indices of their unions.
#[derive(Default)]
struct Definitions {
    plain: Option<usize>,
    /// Objects of single levels, by the bits of the level.
    levels: BTreeMap<u64, usize>,
    any: Option<usize>,
}

impl Definitions {
    fn has_levels(&self) -> bool {
        self.any.is_some() || !self.levels.is_empty()
    }
}

/// A union with compiled expressions, whose first slot is the level; random variables follow.
struct Union<M: StructureMap> {
    name: String,
    instances: Vec<Prepared<M>>,
    alternatives: Vec<PreparedAlternative>,
    /// Source span, if there are alternatives.
    place: Option<Place>,
    transforms: Arc<[M::Written]>,
}

/// Alternative of an object that is drawn at random, with a number of its instances.
struct PreparedAlternative {
    weight: Option<Program>,
    count: usize,
}

/// Names that the formulas of a union may use.
struct UnionScope {
    /// The level, in slot 0.
    fixed: Scope,
    /// The level, and the random variables in the slots that follow.
    drawn: Scope,
}

struct Prepared<M: StructureMap> {
    master: Option<PreparedMaster<M>>,
    transforms: Arc<[M::Written]>,
    /// Number of instances with short formulas that take as long to evaluate as the formulas of the transforms do.
    work: usize,
    forms: Arc<[LinearForm]>,
    tint: Option<Box<PreparedTint>>,
    place: Place,
}

enum PreparedMaster<M: StructureMap> {
    Shape(Box<M::Set>),
    Object {
        name: String,
        level: Option<Program>,
        place: Place,
    },
}

/// Returns the form of the linear part of a transform.
fn form(transform: &TransformDocument) -> LinearForm {
    match transform {
        TransformDocument::Rotate(_)
        | TransformDocument::Turns(_)
        | TransformDocument::Translate(_)
        | TransformDocument::TranslateBack(_) => LinearForm::Rotation,
        TransformDocument::Scale(_) | TransformDocument::ScaleInSpace(_) => LinearForm::Scaling,
        TransformDocument::Matrix(_)
        | TransformDocument::MatrixInSpace(_)
        | TransformDocument::Linear(_) => LinearForm::Any,
    }
}

/// Returns a key that identifies a level. 0 and -0 have the same key.
fn bits(level: f64) -> u64 {
    (level + 0.0).to_bits()
}

impl<M: StructureMap> Resolver<OfInstancing<M>> {
    /// Resolves the structure. Reports mistakes and returns `None`.
    pub(super) fn structure(
        &mut self,
        document: &InstancingDocument,
        metadata: Metadata,
    ) -> Option<Instancing<M>> {
        let names = document.objects.iter().map(|object| &object.name.value);
        self.kind.written = names.cloned().collect();
        self.kind.constants = Arc::new(self.constants.clone());
        let mut scope = Scope::inside(&self.kind.constants);
        let random = self.limited(&document.random, "a structure");
        self.kind.variables = self.variables(random, &mut scope, FIRST, false).into();
        let initial = document.initial.as_ref().map(|set| self.initial(set));
        for object in &document.objects {
            self.define(object);
        }
        let constants = Scope::inside(&self.kind.constants);
        let scope = UnionScope {
            drawn: constants.clone(),
            fixed: constants,
        };
        let scene = self.union(String::new(), document.scene.as_ref()?, &scope);
        self.check_names(document, &scene);
        if self.diagnostics.has_errors() {
            return None;
        }
        let whole = M::product(&scene.transforms, &[]);
        let whole_scene = Arc::clone(&scene.transforms);
        let (mut scene, _) = self.content(&scene, None);
        for instance in &mut scene {
            instance.map = whole * instance.map;
            instance.transforms = [&instance.transforms[..], &whole_scene].concat().into();
        }
        let mut objects = Vec::new();
        while let Some(&(number, level)) = self.kind.reached.get(objects.len()) {
            let union = std::mem::replace(&mut self.kind.unions[number], Union::nothing());
            let slots = self.slots(level);
            let (instances, alternatives) = self.content(&union, level);
            objects.push(ObjectDefinition {
                name: match level {
                    Some(level) => format!("{}({level})", union.name),
                    None => union.name.clone(),
                },
                map: M::product(&union.transforms, &slots),
                instances,
                alternatives,
                transforms: Arc::clone(&union.transforms),
                slots,
            });
            // Other levels may be reached later, but an object without levels once.
            if level.is_some() {
                self.kind.unions[number] = union;
            }
            if self.kind.size > MAX_INSTANCES {
                let message = format!(
                    "with all their levels the objects hold more than {MAX_INSTANCES} instances and \
                     sides of shapes; a long formula counts as several"
                );
                let last = objects.last().map_or("", |object| &object.name);
                let hint = format!(
                    "let fewer levels, or smaller objects, be instanced; {last} comes last"
                );
                self.error_with_hint(&document.metadata.place, message, hint);
            }
            if self.diagnostics.has_errors() {
                return None;
            }
        }
        self.check_all_are_reached(document);
        let mut structure = Instancing {
            metadata,
            objects,
            scene,
            initial: match initial {
                None => None,
                Some(initial) => Some(initial?),
            },
            variables: Arc::clone(&self.kind.variables),
            growing: None,
        };
        let tints = structure
            .instances()
            .any(|instance| instance.tint.is_some());
        if tints && !document.metadata.sets_colours {
            structure.metadata.style.color_by = ColorBy::Tint;
        }
        self.check_loops(document, &structure)?;
        Some(structure)
    }

    /// Resolves the initial set, which must be a single outline or shape.
    fn initial(&mut self, document: &ShapeDocument) -> Option<M::Set> {
        let mut parts = M::parts(&M::set(self, document)?);
        if parts.len() > 1 {
            let message = format!(
                "an initial set is one shape here, and this one consists of {}",
                parts.len()
            );
            let hint = "draw it as an object, or take fewer steps";
            self.error_with_hint(&document.place, message, hint);
            return None;
        }
        parts.pop()
    }

    /// Adds an object to the definitions of its name.
    fn define(&mut self, document: &ObjectDocument) {
        let name = &document.name.value;
        let number = self.kind.unions.len();
        let variable = match &document.level {
            Some(LevelDocument::Any(name)) => {
                let mut drawn = self.kind.variables.iter();
                if drawn.any(|variable| variable.name() == name.value) {
                    let message = format!("'{}' is a random variable here", name.value);
                    self.error_with_hint(&name.place, message, "give the level another name");
                }
                Some(name.value.as_str())
            }
            _ => None,
        };
        let scope = self.scope(variable);
        let union = self.union(name.clone(), &document.union, &scope);
        self.kind.unions.push(union);
        let level = match &document.level {
            Some(LevelDocument::One(number)) => match self.constant(number) {
                Some(level) => Some(level),
                None => return,
            },
            _ => None,
        };
        let known = self.kind.names.entry(name.clone()).or_default();
        let twice = match (&document.level, level) {
            (_, Some(level)) => known.levels.insert(bits(level), number).is_some(),
            (Some(_), None) => known.any.replace(number).is_some(),
            (None, None) => known.plain.replace(number).is_some(),
        };
        let mixed = known.plain.is_some() && known.has_levels();
        if twice {
            let message = format!("there is an object '{name}' of this level already");
            self.error(&document.name.place, message);
        } else if mixed {
            let message = format!("'{name}' is written with a level and without");
            let hint = "an object has a level everywhere, or nowhere";
            self.error_with_hint(&document.name.place, message, hint);
        }
    }

    /// Returns the names that an object's formulas may use; `level` is that of its level.
    fn scope(&mut self, level: Option<&str>) -> UnionScope {
        let mut fixed = Scope::inside(&self.kind.constants);
        if let Some(level) = level {
            self.used.insert(level.to_owned());
            fixed.variable(level, 0);
        }
        let mut drawn = fixed.clone();
        for (slot, variable) in (FIRST..).zip(&*self.kind.variables) {
            drawn.variable(variable.name(), slot);
        }
        UnionScope { fixed, drawn }
    }

    fn union(&mut self, name: String, document: &UnionDocument, scope: &UnionScope) -> Union<M> {
        let mut union = Union {
            name,
            instances: document
                .instances
                .iter()
                .map(|instance| self.prepared(instance, scope))
                .collect(),
            alternatives: Vec::new(),
            place: (!document.alternatives.is_empty()).then(|| document.place.first_line()),
            transforms: self.transforms(&document.transforms, &scope.fixed),
        };
        for alternative in &document.alternatives {
            let whole = self.transforms(&alternative.transforms, &scope.drawn);
            for instance in &alternative.instances {
                let mut prepared = self.prepared(instance, scope);
                prepared.transforms = [&prepared.transforms[..], &whole].concat().into();
                let forms = alternative.transforms.iter().map(form);
                prepared.forms = prepared.forms.iter().copied().chain(forms).collect();
                union.instances.push(prepared);
            }
            let weight = alternative.weight.as_ref();
            union.alternatives.push(PreparedAlternative {
                weight: weight.map(|number| self.weight(number, &scope.fixed)),
                count: alternative.instances.len(),
            });
        }
        union
    }

    fn prepared(&mut self, document: &InstanceDocument, scope: &UnionScope) -> Prepared<M> {
        let master = document.master.as_ref().and_then(|master| match master {
            MasterDocument::Shape(shape) => {
                let set = M::set(self, shape)?;
                Some(PreparedMaster::Shape(Box::new(set)))
            }
            MasterDocument::Object { name, level } => {
                let is_free = level.is_none() && !self.kind.written.contains(&name.value);
                let primitive = is_free.then(|| M::primitive(&name.value)).flatten();
                Some(match primitive {
                    Some(primitive) => PreparedMaster::Shape(Box::new(primitive)),
                    None => PreparedMaster::Object {
                        name: name.value.clone(),
                        level: level
                            .as_ref()
                            .map(|level| self.program(level, &scope.fixed)),
                        place: name.place.clone(),
                    },
                })
            }
        });
        let tint = { document.tint.as_deref() }.map(|tint| Box::new(self.tint(tint, &scope.fixed)));
        let transforms = self.transforms(&document.transforms, &scope.drawn);
        Prepared {
            master,
            work: M::work(&transforms) / SHORT,
            transforms,
            forms: document.transforms.iter().map(form).collect(),
            tint,
            place: document.place.clone(),
        }
    }

    fn transforms(&mut self, documents: &[TransformDocument], scope: &Scope) -> Arc<[M::Written]> {
        let transforms = documents.iter();
        { transforms.filter_map(|document| M::transform(self, document, scope)) }.collect()
    }

    /// Reports unknown names of objects and missing or superfluous levels, also in objects that are not
    /// reached.
    fn check_names(&mut self, document: &InstancingDocument, scene: &Union<M>) {
        if self.incomplete {
            return;
        }
        let unions = std::mem::take(&mut self.kind.unions);
        for prepared in unions
            .iter()
            .chain([scene])
            .flat_map(|union| &union.instances)
        {
            let Some(PreparedMaster::Object { name, level, place }) = &prepared.master else {
                continue;
            };
            let Some(known) = self.kind.names.get(name) else {
                if M::primitive(name).is_some() {
                    let message = format!("'{name}' has no level");
                    self.error_with_hint(place, message, format!("write {name}"));
                    continue;
                }
                let names = document
                    .objects
                    .iter()
                    .map(|object| object.name.value.as_str());
                let all = names.clone().chain(M::PRIMITIVES.iter().copied());
                let hint = { self.suggestion(name, all) }
                    .unwrap_or_else(|| format!("the objects are: {}", listed(names)));
                let message = format!("there is no object '{name}'");
                self.error_with_hint(place, message, hint);
                continue;
            };
            match (level, known.plain) {
                (None, None) => {
                    let message = format!("'{name}' needs a level");
                    self.error_with_hint(place, message, format!("{name}(10)"));
                }
                (Some(_), Some(_)) if !known.has_levels() => {
                    let message = format!("'{name}' has no level");
                    self.error_with_hint(place, message, format!("write {name}"));
                }
                _ => {}
            }
        }
        self.kind.unions = unions;
    }

    /// Warns of objects that are not reached from the scene.
    fn check_all_are_reached(&mut self, document: &InstancingDocument) {
        let reached: BTreeSet<usize> = self.kind.reached.iter().map(|(union, _)| *union).collect();
        for (number, object) in document.objects.iter().enumerate() {
            if !reached.contains(&number) {
                let message = format!("the scene does not lead to '{}'", object.name.place.text());
                let hint = "leave the object out, or instance it";
                self.warn(&object.name.place, message, hint);
            }
        }
    }
}

impl<M: StructureMap> Union<M> {
    fn nothing() -> Self {
        Self {
            name: String::new(),
            instances: Vec::new(),
            alternatives: Vec::new(),
            place: None,
            transforms: Arc::default(),
        }
    }
}
