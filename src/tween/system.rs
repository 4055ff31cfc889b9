//! Tweens of systems of maps.

use crate::ifs::{Condensation, Definition, Edge, Ifs, Map, System, Verdict};

use super::maps::Tweened;
use super::structure::tint_between;
use super::{Side, Tween, TweenError};

/// Returns the system between two.
pub(super) fn tween<M: Tweened>(
    tween: Tween,
    a: &System<M>,
    b: &System<M>,
) -> Result<System<M>, TweenError> {
    let systems = [a.ifs(), b.ifs()];
    let count = systems.map(|it| it.maps().len());
    let maps: Vec<_> = (0..count[0].max(count[1]))
        .filter_map(|number| map(tween, systems.map(|it| it.maps().get(number))))
        .collect();
    let definition = Definition {
        edges: edges(tween, systems, maps.len())?,
        maps,
        condensation: condensation(tween, systems),
        initial: set::<M>(tween, systems.map(Ifs::initial)),
    };
    let written = definition.maps.iter().map(|it| it.affine.into());
    let written = written.collect();
    let ifs = Ifs::new(definition).map_err(|errors| {
        let messages: Vec<_> = errors.iter().map(ToString::to_string).collect();
        TweenError::Invalid(messages.join("; "))
    })?;
    let contraction = ifs.contraction();
    if contraction.verdict == Verdict::Diverges {
        return Err(TweenError::Diverges);
    }
    Ok(System {
        metadata: tween.metadata([&a.metadata, &b.metadata]),
        ifs,
        written,
        chained: a.chained && b.chained,
        interpolates: false,
        growing: None,
        contraction,
    })
}

/// Returns the map between two; one that is alone grows out of its fixed point.
fn map<M: Tweened>(tween: Tween, both: [Option<&Map<M>>; 2]) -> Option<Map<M>> {
    let weight = |weights: [Option<f64>; 2]| match weights {
        [Some(a), Some(b)] => Some(tween.between([a, b])),
        _ => None,
    };
    Some(match both {
        [Some(a), Some(b)] => Map {
            name: tween.pick([&a.name, &b.name]).clone(),
            affine: M::between(tween, [&a.affine, &b.affine]),
            weight: weight([a.weight, b.weight]),
            tint: tint_between(tween, [a.tint, b.tint]),
        },
        [Some(own), None] => grown(tween, 0, own),
        [None, Some(own)] => grown(tween, 1, own),
        [None, None] => return None,
    })
}

/// Returns a map of one side that grows out of its fixed point.
fn grown<M: Tweened>(tween: Tween, side: Side, own: &Map<M>) -> Map<M> {
    let share = tween.of(side);
    let point = own.affine.fixed_point().unwrap_or_default();
    Map {
        name: own.name.clone(),
        affine: own.affine.shrunk(share, point),
        weight: own.weight.map(|weight| weight * share),
        tint: own.tint,
    }
}

/// Returns the edges between those of two systems, of `count` maps; `None` where any map may follow any.
fn edges<M: Tweened>(
    tween: Tween,
    systems: [&Ifs<M>; 2],
    count: usize,
) -> Result<Option<Vec<Edge>>, TweenError> {
    let listed = systems.map(|it| it.edges().map(Iterator::collect::<Vec<_>>));
    if let [Some(a), Some(b)] = &listed {
        let ends = |it: &[(Edge, f64)]| -> Vec<_> {
            it.iter().map(|(edge, _)| (edge.from, edge.to)).collect()
        };
        if ends(a) == ends(b) {
            let between = a.iter().zip(b).map(|((edge, a), (_, b))| Edge {
                weight: Some(tween.between([*a, *b])),
                ..*edge
            });
            return Ok(Some(between.collect()));
        }
    }
    if listed.iter().all(Option::is_none) {
        return Ok(None);
    }
    if systems.iter().any(|it| it.maps().len() != count) {
        return Err(TweenError::Edges);
    }
    let nearer = tween.pick(listed);
    Ok(nearer.map(|all| all.into_iter().map(|(edge, _)| edge).collect()))
}

/// Returns the condensation sets between those of two systems: the nearer ones, if they are of different shapes.
fn condensation<M: Tweened>(tween: Tween, systems: [&Ifs<M>; 2]) -> Vec<Condensation<M>> {
    let [a, b] = systems.map(Ifs::condensation);
    let between = |(a, b): (&Condensation<M>, &Condensation<M>)| {
        let weight = match [a.weight, b.weight] {
            [Some(a), Some(b)] => Some(tween.between([a, b])),
            weights => tween.pick(weights),
        };
        let shape = M::set(tween, [&a.shape, &b.shape])?;
        Some(Condensation { shape, weight })
    };
    let all = a.iter().zip(b).map(between).collect::<Option<Vec<_>>>();
    all.filter(|_| a.len() == b.len())
        .unwrap_or_else(|| tween.pick([a, b]).to_vec())
}

/// Returns the set between two; the nearer one, if they are of different shapes or one is missing.
pub(super) fn set<M: Tweened>(tween: Tween, both: [Option<&M::Set>; 2]) -> Option<M::Set> {
    let between = match both {
        [Some(a), Some(b)] => M::set(tween, [a, b]),
        _ => None,
    };
    between.or_else(|| tween.pick(both).cloned())
}
