//! Resolution of instancing structures. Objects with levels are expanded to one object for each level
//! that the scene reaches.

mod loops;
mod maps;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::diagnostic::{Place, listed};
use crate::document::{
    AlternativeDocument, InstanceDocument, InstancingDocument, LevelDocument, MasterDocument,
    ObjectDocument, ShapeDocument, TransformDocument, UnionDocument,
};
use crate::expression::{Program, Scope};
use crate::instancing::{Instancing, Master, ObjectAlternative, ObjectDefinition, ObjectInstance};
use crate::metadata::Metadata;
use crate::style::ColorBy;

use super::Resolver;
use super::tint::PreparedTint;
pub(super) use maps::StructureMap;

/// Maximum number of objects after the expansion of levels.
const MAX_OBJECTS: usize = 20_000;

/// Maximum number of instances in all objects, where sides of shapes count as well.
const MAX_INSTANCES: usize = 250_000;

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
    /// Number of instances and of the sides of shapes among them.
    size: usize,
    /// Parameters of the file.
    constants: Arc<Scope>,
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

/// A union with compiled expressions, whose first slot is the level.
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

struct Prepared<M: StructureMap> {
    master: Option<PreparedMaster<M>>,
    transforms: Arc<[M::Written]>,
    tint: Option<PreparedTint>,
    place: Place,
}

enum PreparedMaster<M: StructureMap> {
    Shape(M::Set),
    Object {
        name: String,
        level: Option<Program>,
        place: Place,
    },
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
        let initial = document.initial.as_ref().map(|set| self.initial(set));
        for object in &document.objects {
            self.define(object);
        }
        let scene = self.union(String::new(), document.scene.as_ref()?, None);
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
        while let Some(&(union, level)) = self.kind.reached.get(objects.len()) {
            let union = std::mem::replace(&mut self.kind.unions[union], Union::nothing());
            let number = self.kind.reached[objects.len()].0;
            let slots: Vec<f64> = level.into_iter().collect();
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
            self.kind.unions[number] = union;
            if self.kind.size > MAX_INSTANCES {
                let message = format!(
                    "with all their levels the objects hold more than {MAX_INSTANCES} instances and \
                     sides of shapes"
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
            Some(LevelDocument::Any(name)) => Some(name.value.as_str()),
            _ => None,
        };
        let union = self.union(name.clone(), &document.union, variable);
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

    fn union(
        &mut self,
        name: String,
        document: &UnionDocument,
        variable: Option<&str>,
    ) -> Union<M> {
        let mut scope = Scope::inside(&self.kind.constants);
        if let Some(variable) = variable {
            self.used.insert(variable.to_owned());
            scope.variable(variable, 0);
        }
        let mut union = Union {
            name,
            instances: document
                .instances
                .iter()
                .map(|instance| self.prepared(instance, &scope))
                .collect(),
            alternatives: Vec::new(),
            place: (!document.alternatives.is_empty()).then(|| document.place.first_line()),
            transforms: self.transforms(&document.transforms, &scope),
        };
        for alternative in &document.alternatives {
            let whole = self.transforms(&alternative.transforms, &scope);
            for instance in &alternative.instances {
                let mut prepared = self.prepared(instance, &scope);
                prepared.transforms = [&prepared.transforms[..], &whole].concat().into();
                union.instances.push(prepared);
            }
            union.alternatives.push(PreparedAlternative {
                weight: self.weight(alternative, &scope),
                count: alternative.instances.len(),
            });
        }
        union
    }

    fn weight(&mut self, document: &AlternativeDocument, scope: &Scope) -> Option<Program> {
        let number = document.weight.as_ref()?;
        let weight = self.program(number, scope);
        if weight.as_constant().is_some_and(|value| value < 0.0) {
            self.error(&number.place, "a weight cannot be negative");
        }
        Some(weight)
    }

    fn prepared(&mut self, document: &InstanceDocument, scope: &Scope) -> Prepared<M> {
        let master = document.master.as_ref().and_then(|master| match master {
            MasterDocument::Shape(shape) => M::set(self, shape).map(PreparedMaster::Shape),
            MasterDocument::Object { name, level } => {
                let is_free = level.is_none() && !self.kind.written.contains(&name.value);
                let primitive = is_free.then(|| M::primitive(&name.value)).flatten();
                Some(match primitive {
                    Some(primitive) => PreparedMaster::Shape(primitive),
                    None => PreparedMaster::Object {
                        name: name.value.clone(),
                        level: level.as_ref().map(|level| self.program(level, scope)),
                        place: name.place.clone(),
                    },
                })
            }
        });
        let tint = { document.tint.as_deref() }.map(|tint| self.tint(tint, scope));
        Prepared {
            master,
            transforms: self.transforms(&document.transforms, scope),
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

    /// Returns the instances of a union at a level, and the alternatives among them. New objects are marked as reached.
    fn content(
        &mut self,
        union: &Union<M>,
        level: Option<f64>,
    ) -> (Vec<ObjectInstance<M>>, Vec<ObjectAlternative>) {
        let mut instances = Vec::new();
        if union.alternatives.is_empty() {
            self.add_instances(&union.instances, union, level, &mut instances);
        }
        let mut rest = &union.instances[..];
        let alternatives = { union.alternatives.iter() }.map(|alternative| {
            let (own, others) = rest.split_at(alternative.count);
            rest = others;
            let first = instances.len();
            self.add_instances(own, union, level, &mut instances);
            let weight = alternative.weight.as_ref();
            let weight = weight.map_or(1.0, |weight| weight.eval(level.as_slice()));
            ObjectAlternative {
                weight: weight.max(0.0),
                instances: first..instances.len(),
            }
        });
        let alternatives: Vec<ObjectAlternative> = alternatives.collect();
        let total: f64 = alternatives.iter().map(|it| it.weight).sum();
        if let Some(place) = &union.place
            && !(total > 0.0 && total.is_finite())
        {
            let at = level.map_or_else(String::new, |level| format!(" at level {level}"));
            let message = format!("the sum of the weights is {total}{at}");
            let hint = "at least one of several alternatives has a weight above 0";
            self.error_with_hint(place, message, hint);
        }
        (instances, alternatives)
    }

    /// Adds some instances of a union at a level.
    fn add_instances(
        &mut self,
        all: &[Prepared<M>],
        union: &Union<M>,
        level: Option<f64>,
        instances: &mut Vec<ObjectInstance<M>>,
    ) {
        let slots: Vec<f64> = level.into_iter().collect();
        let whole = M::product(&union.transforms, &slots);
        for prepared in all {
            let map = M::product(&prepared.transforms, &slots);
            if !(whole * map).is_finite() {
                let at = level.map_or_else(String::new, |level| format!(" at level {level}"));
                let message = format!("the transform of this instance is not finite{at}");
                self.error(&prepared.place, message);
                continue;
            }
            let tint = { prepared.tint.as_ref() }
                .and_then(|tint| self.tint_at(tint, &slots, &prepared.place));
            let masters = match &prepared.master {
                Some(PreparedMaster::Shape(shape)) => {
                    M::parts(shape).into_iter().map(Master::Shape).collect()
                }
                Some(PreparedMaster::Object { name, level, place }) => {
                    let level = level.as_ref().map(|level| level.eval(&slots));
                    let object = self.object(name, level, place).map(Master::Object);
                    object.into_iter().collect()
                }
                None => Vec::new(),
            };
            for master in masters {
                self.kind.size += match &master {
                    Master::Shape(shape) => M::sides(shape) + 1,
                    Master::Object(_) => 1,
                };
                let transforms = Arc::clone(&prepared.transforms);
                instances.push(ObjectInstance {
                    map,
                    master,
                    tint,
                    transforms,
                });
            }
        }
    }

    /// Returns the index of an object at a level, and marks the object as reached.
    fn object(&mut self, name: &str, level: Option<f64>, place: &Place) -> Option<usize> {
        let known = self.kind.names.get(name)?;
        let union = match level {
            None => known.plain,
            Some(level) => known.levels.get(&bits(level)).copied().or(known.any),
        };
        let level = level.map(|level| level + 0.0);
        let Some(union) = union else {
            let level = level.unwrap_or_default();
            let message = format!("there is no object '{name}({level})'");
            let hint = format!("write one, or {name}(n) for all levels");
            self.error_with_hint(place, message, hint);
            return None;
        };
        if level.is_some_and(|level| !level.is_finite()) {
            let message = format!("the level of '{name}' is not finite here");
            self.error(place, message);
            return None;
        }
        let key = (union, level.map_or(0, bits));
        if let Some(&known) = self.kind.numbers.get(&key) {
            return Some(known);
        }
        let number = self.kind.reached.len();
        if number >= MAX_OBJECTS {
            if !self.kind.is_too_many {
                self.kind.is_too_many = true;
                let message = format!("'{name}' leads to more than {MAX_OBJECTS} levels of itself");
                let hint = format!("an object of one level ends it: {name}(0)");
                self.error_with_hint(place, message, hint);
            }
            return None;
        }
        self.kind.reached.push((union, level));
        self.kind.numbers.insert(key, number);
        Some(number)
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
