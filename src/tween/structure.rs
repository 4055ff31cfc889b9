//! Tweens of structures of objects.

use std::sync::Arc;

use crate::draws::Variable;
use crate::ifs::PointOf;
use crate::instancing::{Drift, Instancing, Master, ObjectDefinition, ObjectInstance, Tint};

use super::maps::Tweened;
use super::{Side, Tween, style, system};

/// Returns the structure between two, or one of them if they have different random variables.
pub(super) fn tween<M: Tweened>(
    tween: Tween,
    a: &Instancing<M>,
    b: &Instancing<M>,
) -> Instancing<M> {
    let metadata = tween.metadata([&a.metadata, &b.metadata]);
    if a.variables != b.variables {
        let own = tween.pick([a, b]).clone();
        return Instancing { metadata, ..own };
    }
    let count = a.objects.len().max(b.objects.len());
    let object = |number: usize| match [a, b].map(|it| it.objects.get(number)) {
        [Some(one), Some(other)] => Some(object(tween, [one, other], &a.variables)),
        [one, other] => one.or(other).cloned(),
    };
    Instancing {
        metadata,
        objects: (0..count).filter_map(object).collect(),
        scene: instances(tween, [&a.scene, &b.scene]),
        initial: system::set::<M>(tween, [a.initial.as_ref(), b.initial.as_ref()]),
        variables: Arc::clone(&a.variables),
        growing: None,
    }
}

/// Returns the object between two, or one of them if their instances are drawn differently.
fn object<M: Tweened>(
    tween: Tween,
    both: [&ObjectDefinition<M>; 2],
    variables: &[Variable],
) -> ObjectDefinition<M> {
    let [a, b] = both.map(|it| &it.alternatives);
    let mut written = both.iter().flat_map(|it| &it.instances);
    if a != b || written.any(|it| it.needed(variables).contains(&true)) {
        return tween.pick(both).clone();
    }
    let map = M::between(tween, both.map(|it| &it.map));
    ObjectDefinition {
        name: tween.pick(both).name.clone(),
        alternatives: a.clone(),
        instances: instances(tween, both.map(|it| it.instances.as_slice())),
        transforms: [map.into()].into(),
        slots: tween.pick(both).slots.clone(),
        map,
    }
}

/// Returns the instances between those of two objects, or of two scenes.
fn instances<M: Tweened>(tween: Tween, both: [&[ObjectInstance<M>]; 2]) -> Vec<ObjectInstance<M>> {
    let count = both[0].len().max(both[1].len());
    let instance = |number: usize| match both.map(|it| it.get(number)) {
        [Some(a), Some(b)] => Some(between(tween, [a, b])),
        [Some(own), None] => Some(grown(tween, 0, own)),
        [None, Some(own)] => Some(grown(tween, 1, own)),
        [None, None] => None,
    };
    (0..count).filter_map(instance).collect()
}

/// Returns the instance between two.
fn between<M: Tweened>(tween: Tween, both: [&ObjectInstance<M>; 2]) -> ObjectInstance<M> {
    let map = M::between(tween, both.map(|it| &it.map));
    let shape = match both.map(|it| &it.master) {
        [Master::Shape(a), Master::Shape(b)] => {
            M::set(tween, [a, b]).map(|set| Master::Shape(Box::new(set)))
        }
        _ => None,
    };
    ObjectInstance {
        master: shape.unwrap_or_else(|| tween.pick(both).master.clone()),
        tint: tint_between(tween, both.map(|it| it.tint)),
        transforms: [map.into()].into(),
        forms: Arc::default(),
        map,
    }
}

/// Returns the tint between two; one that is alone fades.
pub(super) fn tint_between(tween: Tween, both: [Option<Tint>; 2]) -> Option<Tint> {
    match both {
        [Some(a), Some(b)] => Some(tint(tween, [a, b])),
        [Some(a), None] => Some(fading(a, tween.of(0))),
        [None, Some(b)] => Some(fading(b, tween.of(1))),
        [None, None] => None,
    }
}

/// Returns the tint between two. The colour of one that covers nothing does not count.
fn tint(tween: Tween, both: [Tint; 2]) -> Tint {
    let [a, b] = both.map(|it| it.drift.changes());
    let colours = both.map(|it| it.colour);
    Tint {
        colour: match both.map(|it| it.alpha > 0.0) {
            [true, false] => colours[0],
            [false, true] => colours[1],
            _ => style::colour(tween, colours),
        },
        alpha: tween.between(both.map(|it| it.alpha)),
        drift: Drift::of(std::array::from_fn(|at| tween.between([a[at], b[at]]))),
    }
}

/// Returns a tint with a share of its coverage and of its drift.
fn fading(tint: Tint, share: f64) -> Tint {
    Tint {
        alpha: tint.alpha * share,
        drift: tint.drift.times(share),
        ..tint
    }
}

/// Returns an instance of one side that grows out of the image of its origin.
fn grown<M: Tweened>(tween: Tween, side: Side, own: &ObjectInstance<M>) -> ObjectInstance<M> {
    let map = own.map.shrunk(tween.of(side), PointOf::<M>::default());
    ObjectInstance {
        transforms: [map.into()].into(),
        forms: Arc::default(),
        map,
        ..own.clone()
    }
}
