//! Instances of calls in loops.
//!
//! Copies are never written out one by one: a loop is a repetition, `for` with a formula for each transform or `repeat`, or
//! else an object for itself, whose levels are the copies or which consists of halves of the loop.

use crate::build::NumberText;
use crate::build::written::{Entries, sequence};
use crate::document::node::Value;
use crate::style::Colour;

use super::colour::{Colouring, colour_text};
use super::motion::Motion;
use super::program::Loop;

/// Largest number of copies of a repetition with formulas.
const MAX_COPIES: u32 = 200;

/// Largest number of copies of a repetition that adds transforms to each.
const MAX_REPEATED: u32 = 32;

/// Largest number of copies that are levels of an object.
const MAX_LEVELS: u32 = 200;

/// Names of values in repetitions.
pub(super) const NAMES: [&str; 3] = ["k", "l", "m"];

/// Name of a level.
pub(super) const LEVEL: &str = "n";

/// Object that is instanced, as text, and its colour.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Instanced {
    /// Name of the object, with the level if it has one.
    pub(super) object: String,
    /// Whether the level depends on that of the object that contains the instance.
    pub(super) has_level: bool,
    /// Colour of a primitive.
    pub(super) colour: Option<Colour>,
}

/// Objects that loops need.
#[derive(Debug, Default)]
pub(super) struct Loops {
    /// Loops with the instances that they repeat, and the objects that stand for them.
    known: Vec<(Instanced, Loop, Instanced)>,
    /// Names with their instances.
    pub(super) objects: Vec<(String, Value)>,
}

/// Returns an instance with transforms and a tint.
fn instance(of: &Instanced, motions: &[(&Loop, Option<&str>)], repeated: Option<Value>) -> Entries {
    let transforms = motions.iter().rev();
    let transforms = transforms.flat_map(|(it, name)| it.motion.transforms(*name));
    let transforms: Vec<_> = transforms.collect();
    let entries = Entries::default().set("object", Value::Text(of.object.clone()));
    let entries = with_transforms(entries, transforms);
    let mut tint = Vec::new();
    // Of several tints with a colour the outermost covers the others.
    for (it, name) in motions {
        tint.extend(it.colouring.tint(*name));
    }
    let own = of
        .colour
        .map(|colour| Entries::default().set("color", colour_text(colour)).value());
    tint.extend(own);
    let entries = entries.set_some("tint", merged(tint));
    entries.set_some("repeat", repeated)
}

/// Returns a mapping with transforms as its keys, or as a list if one is needed twice.
fn with_transforms(entries: Entries, transforms: Vec<(&str, Value)>) -> Entries {
    let keys: Vec<&str> = transforms.iter().map(|(key, _)| *key).collect();
    let is_unique = keys
        .iter()
        .enumerate()
        .all(|(at, key)| !keys[..at].contains(key));
    if is_unique {
        let all = transforms.into_iter();
        return all.fold(entries, |entries, (key, value)| entries.set(key, value));
    }
    let list = transforms.into_iter();
    let list = list.map(|(key, value)| Entries::default().set(key, value).value());
    entries.set("transform", sequence(list))
}

/// Returns the tint that has the keys of all tints; `None` without one.
fn merged(tints: Vec<Value>) -> Option<Value> {
    let mut all: Option<Entries> = None;
    for tint in tints {
        if let Value::Mapping(keys) = tint {
            let entries = all.unwrap_or_default();
            all = Some({ keys.into_iter() }.fold(entries, |entries, (key, node)| {
                entries.set(&key.name, node.value)
            }));
        }
    }
    all.map(Entries::value)
}

/// Returns whether the tints of several loops and of a primitive have different keys.
fn merges(loops: &[Loop], colour: Option<Colour>) -> bool {
    let tinted = loops.iter().filter(|it| it.colouring.tints()).count();
    let blends = loops.iter().any(|it| it.colouring.blend.is_some());
    tinted <= 1 && !(blends && colour.is_some())
}

impl Loops {
    /// Returns the instances of a call in loops, of which the last one is applied first.
    pub(super) fn instances(&mut self, of: &Instanced, loops: &[Loop]) -> Vec<Value> {
        let copies = { loops.iter() }.try_fold(1_u32, |all, it| all.checked_mul(it.count));
        let is_small = copies.is_some_and(|copies| copies <= MAX_COPIES);
        let repeated = loops.iter().filter(|it| it.count > 1);
        let are_simple = repeated.clone().all(|it| it.motion.is_simple());
        if merges(loops, of.colour)
            && is_small
            && are_simple
            && repeated.clone().count() <= NAMES.len()
        {
            let mut names = NAMES.iter();
            let mut values = Entries::default();
            let mut motions = Vec::new();
            for it in loops {
                let name = if it.count > 1 { names.next() } else { None };
                motions.push(match name {
                    Some(name) => {
                        values = values.set(name, Value::Text(format!("1..{}", it.count)));
                        (it, Some(*name))
                    }
                    None => (it, None),
                });
            }
            let instance = instance(of, &motions, None);
            return vec![match values.is_empty() {
                true if loops.is_empty() && of.colour.is_none() => Value::Text(of.object.clone()),
                true => instance.value(),
                false => Entries::default()
                    .set("for", values.value())
                    .and(instance)
                    .value(),
            }];
        }
        let Some((outer, inner)) = loops.split_first() else {
            return vec![instance(of, &[], None).value()];
        };
        let of = if inner.is_empty() && merges(loops, of.colour) {
            of.clone()
        } else {
            let inside = self.instances(of, inner);
            self.object(of, inside)
        };
        self.looped(&of, outer)
    }

    /// Returns the instances of a single loop.
    fn looped(&mut self, of: &Instanced, it: &Loop) -> Vec<Value> {
        let plain = it.count == 1 || it.motion.is_simple() && it.count <= MAX_COPIES;
        if plain && merges(std::slice::from_ref(it), of.colour) {
            return self.instances(of, std::slice::from_ref(it));
        }
        let once = (it, None);
        if it.count <= MAX_REPEATED && !it.colouring.tints() && it.motion != Motion::default() {
            let count = ("count", NumberText::from(f64::from(it.count)).0);
            let step = it.motion.transforms(None);
            let step = with_transforms(Entries::default().set(count.0, count.1), step);
            return vec![instance(of, &[once], Some(step.value())).value()];
        }
        if let Some((.., known)) = self.known.iter().find(|(a, b, _)| (a, b) == (of, it)) {
            return vec![Value::Text(known.object.clone())];
        }
        let written = match !of.has_level && it.count <= MAX_LEVELS {
            true => self.levels(of, it),
            false => self.halves(of, it),
        };
        self.known.push((of.clone(), it.clone(), written.clone()));
        vec![Value::Text(written.object)]
    }

    /// Adds an object with a level for each copy of a loop.
    fn levels(&mut self, of: &Instanced, it: &Loop) -> Instanced {
        let name = self.name(of);
        let once = [(it, None)];
        let inner = Instanced {
            object: format!("{name}({LEVEL} - 1)"),
            has_level: true,
            colour: None,
        };
        let first = instance(of, &once, None).value();
        let further = instance(&inner, &once, None).value();
        let last = sequence([first.clone()]);
        self.objects.push((format!("{name}(1)"), last));
        let all = sequence([first, further]);
        self.objects.push((format!("{name}({LEVEL})"), all));
        Instanced {
            object: format!("{name}({})", it.count),
            has_level: false,
            colour: None,
        }
    }

    /// Adds objects with powers of 2 of copies, and one of those that make up a loop.
    fn halves(&mut self, of: &Instanced, it: &Loop) -> Instanced {
        let power = |times: u32| Loop {
            count: 1,
            motion: it.motion.power(times),
            colouring: it.colouring.power(times),
        };
        let step = |loops: &mut Self, of: &Instanced, times: u32| {
            let power = power(times);
            let moved = instance(of, &[(&power, None)], None);
            let instances = vec![Value::Text(of.object.clone()), moved.value()];
            loops.object(of, instances)
        };
        let first = power(1);
        let mut half = {
            let moved = instance(of, &[(&first, None)], None).value();
            self.object(of, vec![moved])
        };
        let mut all = Vec::new();
        let (mut rest, mut copies, mut done) = (it.count, 1_u32, 0);
        loop {
            if rest % 2 == 1 {
                let power = power(done);
                all.push(match done {
                    0 => Value::Text(half.object.clone()),
                    _ => instance(&half, &[(&power, None)], None).value(),
                });
                done += copies;
            }
            rest /= 2;
            if rest == 0 {
                return self.object(of, all);
            }
            half = step(self, &half, copies);
            copies *= 2;
        }
    }

    /// Adds an object of instances, at the level of what they contain.
    fn object(&mut self, of: &Instanced, instances: Vec<Value>) -> Instanced {
        let name = self.name(of);
        let object = match of.has_level {
            true => format!("{name}({LEVEL})"),
            false => name,
        };
        self.objects.push((object.clone(), sequence(instances)));
        Instanced {
            object,
            has_level: of.has_level,
            colour: None,
        }
    }

    /// Returns a new name for copies of an object.
    fn name(&self, of: &Instanced) -> String {
        let name = of.object.split('(').next().unwrap_or_default();
        let name = name.split("__x").next().unwrap_or_default();
        format!("{name}__x{}", self.objects.len() + 1)
    }
}

impl Colouring {
    /// Returns the colouring that has the effect of a number of repetitions.
    pub(super) fn power(&self, times: u32) -> Self {
        let mut power = self.clone();
        power.hue *= f64::from(times);
        for factor in &mut power.factors.0 {
            *factor = libm::pow(*factor, f64::from(times));
        }
        if let Some((_, share)) = &mut power.blend {
            *share = 1.0 - libm::pow(1.0 - *share, f64::from(times));
        }
        power
    }
}
