//! Contents of objects at their levels: instances, with the alternatives among them.

use std::sync::Arc;

use crate::diagnostic::Place;
use crate::instancing::{FIRST, Master, ObjectAlternative, ObjectInstance};
use crate::resolve::Resolver;

use super::{MAX_OBJECTS, OfInstancing, Prepared, PreparedMaster, StructureMap, Union, bits};

impl<M: StructureMap> Resolver<OfInstancing<M>> {
    /// Returns the instances of a union at a level, and the alternatives among them. New objects are marked as reached.
    pub(super) fn content(
        &mut self,
        union: &Union<M>,
        level: Option<f64>,
    ) -> (Vec<ObjectInstance<M>>, Vec<ObjectAlternative>) {
        let mut instances = Vec::with_capacity(union.instances.len());
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

    /// Returns the slots of a level: representative values of random variables follow it.
    pub(super) fn slots(&self, level: Option<f64>) -> Vec<f64> {
        let mut slots: Vec<f64> = level.into_iter().collect();
        if !self.kind.variables.is_empty() {
            slots.resize(FIRST, 0.0);
        }
        for variable in &*self.kind.variables {
            slots.push(variable.typical(&slots));
        }
        slots
    }

    /// Adds some instances of a union at a level.
    fn add_instances(
        &mut self,
        all: &[Prepared<M>],
        union: &Union<M>,
        level: Option<f64>,
        instances: &mut Vec<ObjectInstance<M>>,
    ) {
        let slots = self.slots(level);
        let whole = M::product(&union.transforms, &slots);
        for prepared in all {
            let map = M::product(&prepared.transforms, &slots);
            self.kind.size += prepared.work;
            if !(whole * map).is_finite() {
                let at = level.map_or_else(String::new, |level| format!(" at level {level}"));
                let message = format!("the transform of this instance is not finite{at}");
                self.error(&prepared.place, message);
                continue;
            }
            let tint = { prepared.tint.as_deref() }
                .and_then(|tint| self.tint_at(tint, &slots, &prepared.place));
            let masters = match &prepared.master {
                Some(PreparedMaster::Shape(shape)) => {
                    let parts = M::parts(shape).into_iter();
                    parts.map(|part| Master::Shape(Box::new(part))).collect()
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
                let forms = Arc::clone(&prepared.forms);
                instances.push(ObjectInstance {
                    map,
                    master,
                    tint,
                    transforms,
                    forms,
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
}
