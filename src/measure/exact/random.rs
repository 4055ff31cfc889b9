//! The expected dimension of rules with random ratios: E Σ ratio^D = 1 (Falconer 1986, Mauldin & Williams
//! 1986), or spectral radius 1 of the matrix of these expectations.

use std::collections::BTreeMap;

use crate::digraph::{all_loops_shrink, components};
use crate::draws::nodes;
use crate::expression::{Dependence, Program};
use crate::extent::NoLimit;
use crate::geometry::Point as _;
use crate::graph::{Alternative, Graph, Instance, Replacement};
use crate::rule::{ElementContext, Placement, Rule, RuleFrame, Selection};

use crate::measure::perron::crossing;

use super::spectral::dense_radius;

/// Maximum number of behaviours that lead to each other.
const MAX_BEHAVIOURS: usize = 50;

/// Maximum number of ratios.
const MAX_RATIOS: usize = 1_000_000;

/// A ratio between objects, with its probability.
struct Ratio {
    from: usize,
    to: usize,
    ratio: f64,
    weight: f64,
}

/// Returns the dimension of a random rule, for almost all seeds if copies do not overlap, or the reason why
/// it is not known.
pub(super) fn expected_dimension<F: RuleFrame>(graph: &Graph<F>) -> Result<f64, String> {
    let mut ratios = Vec::new();
    for object in graph.behaviours() {
        match &object.replacement {
            Replacement::Kept => {}
            Replacement::Unresolved => return Err(NoLimit::Endless.to_string()),
            Replacement::Fixed(production) => {
                for (placement, instance) in production.placed_instances() {
                    if placement == Placement::SeedsAsInitiator {
                        return Err(NoLimit::Resets.to_string());
                    }
                    let place = [object.behaviour, instance.object];
                    push_instance(&mut ratios, graph, place, instance, 1.0)?;
                }
            }
            Replacement::Evaluated(alternatives) => {
                let Some(rule) = graph.source().rule() else {
                    push_drawn(&mut ratios, graph, (object.behaviour, alternatives))?;
                    continue;
                };
                for (alternative, weight) in weighted(rule, alternatives)? {
                    let from = object.behaviour;
                    push_draws(&mut ratios, graph, rule, from, (alternative, weight))?;
                }
            }
        }
    }
    let size = graph.behaviours().count();
    let mut targets = vec![Vec::new(); size];
    for ratio in &ratios {
        targets[ratio.from].push(ratio.to);
    }
    let component = components(&targets);
    // Only loops multiply without end.
    let mut loops: BTreeMap<usize, Vec<Ratio>> = BTreeMap::new();
    for ratio in ratios {
        if component[ratio.from] == component[ratio.to] {
            loops.entry(component[ratio.from]).or_default().push(ratio);
        }
    }
    let mut dimension = None;
    for mut ratios in loops.into_values() {
        let mut numbers: Vec<usize> = ratios.iter().flat_map(|it| [it.from, it.to]).collect();
        numbers.sort_unstable();
        numbers.dedup();
        if numbers.len() > MAX_BEHAVIOURS {
            return Err("too many objects lead to each other".into());
        }
        let number = |of: usize| numbers.binary_search(&of).unwrap_or_default();
        for ratio in &mut ratios {
            [ratio.from, ratio.to] = [ratio.from, ratio.to].map(number);
        }
        let own: Option<f64> = dimension_of_loops(numbers.len(), &ratios)?;
        dimension = match (dimension, own) {
            (Some(a), Some(b)) => Some(f64::max(a, b)),
            (one, other) => one.or(other),
        };
    }
    dimension.ok_or_else(|| "what is fertile does not multiply".into())
}

/// Returns the dimension of behaviours that lead to each other; `None` if they do not multiply.
fn dimension_of_loops(size: usize, ratios: &[Ratio]) -> Result<Option<f64>, String> {
    let edges = ratios.iter().map(|it| (it.from, it.to, it.ratio));
    if !all_loops_shrink(size, &edges.collect::<Vec<_>>(), size) {
        return Err(NoLimit::DoesNotShrink.to_string());
    }
    let radius = |dimension: f64| {
        let mut matrix = vec![0.0; size * size];
        for ratio in ratios {
            let share = ratio.weight * libm::pow(ratio.ratio, dimension);
            matrix[ratio.from * size + ratio.to] += share;
        }
        dense_radius(matrix, size)
    };
    if radius(0.0) <= 1.0 {
        return Ok(None);
    }
    let (mut low, mut high) = (0.0, 1.0);
    while radius(high) > 1.0 {
        (low, high) = (high, 2.0 * high);
    }
    Ok(Some(crossing(high, low, radius)))
}

/// Adds the ratio of a fertile element, from a behaviour to an object.
fn push<F: RuleFrame>(
    ratios: &mut Vec<Ratio>,
    graph: &Graph<F>,
    place: [usize; 2],
    ratio: f64,
    weight: f64,
) {
    let [from, object] = place;
    let object = &graph.objects()[object];
    if !object.is_kept() {
        ratios.push(Ratio {
            from,
            to: object.behaviour,
            ratio,
            weight,
        });
    }
}

/// Adds the ratio of an instance, whose map is a similarity if its object is fertile.
fn push_instance<F: RuleFrame>(
    ratios: &mut Vec<Ratio>,
    graph: &Graph<F>,
    place: [usize; 2],
    instance: &Instance<F>,
    weight: f64,
) -> Result<(), String> {
    let is_fertile = !graph.objects()[place[1]].is_kept();
    if is_fertile && graph.is_affine() && !instance.frame.is_similarity(instance.length) {
        return Err("not all maps are similarities".into());
    }
    push(ratios, graph, place, instance.length, weight);
    Ok(())
}

/// Adds the ratios of alternatives whose instances depend on draws alone.
fn push_drawn<F: RuleFrame>(
    ratios: &mut Vec<Ratio>,
    graph: &Graph<F>,
    (from, alternatives): (usize, &[Alternative]),
) -> Result<(), String> {
    let source = graph.source();
    let weights = alternatives.iter().map(|it| source.weight(it.generator));
    let total: f64 = weights.sum();
    for Alternative { generator, objects } in alternatives {
        if source.weight(*generator) == 0.0 {
            continue;
        }
        let is_wanted = |number: usize| graph.is_fertile(objects[number]);
        source.visit_draws(*generator, &is_wanted, &mut |number, instance, weight| {
            if ratios.len() >= MAX_RATIOS {
                return Err("too many numbers are drawn to integrate over".into());
            }
            let place = [from, objects[number]];
            push_instance(ratios, graph, place, instance, weight / total)
        })?;
    }
    Ok(())
}

/// Returns generators with their probabilities.
fn weighted<'a, F: RuleFrame>(
    rule: &Rule<F>,
    alternatives: &'a [Alternative],
) -> Result<Vec<(&'a Alternative, f64)>, String> {
    if let [only] = alternatives {
        return Ok(vec![(only, 1.0)]);
    }
    let Selection::AtRandom(entries) = rule.selection() else {
        return Err("generators are selected by more than draws".into());
    };
    let total: f64 = entries.iter().map(|(weight, _)| weight).sum();
    let weight = |alternative: &Alternative| -> f64 {
        let own = entries
            .iter()
            .filter(|entry| entry.1 == alternative.generator);
        own.map(|(weight, _)| weight / total).sum()
    };
    Ok(alternatives.iter().map(|all| (all, weight(all))).collect())
}

/// Adds the ratios of a generator for the nodes of a quadrature over its draws.
fn push_draws<F: RuleFrame>(
    ratios: &mut Vec<Ratio>,
    graph: &Graph<F>,
    rule: &Rule<F>,
    from: usize,
    (alternative, weight): (&Alternative, f64),
) -> Result<(), String> {
    let generator = &rule.generators()[alternative.generator];
    let moments = [
        ElementContext::INDEX,
        ElementContext::AGE,
        ElementContext::STEP,
        ElementContext::LENGTH,
    ];
    let depends = |program: &Program| {
        let mut slots = moments.iter();
        slots.any(|&slot| program.dependence(slot) != Dependence::None)
    };
    if generator.programs().any(depends) {
        return Err("ratios depend on more than draws".into());
    }
    let moment = ElementContext {
        index: 1.0,
        age: 0.0,
        step: 0.0,
        length: 1.0,
    };
    let (mut scratch, mut points) = (Vec::new(), Vec::new());
    let needed = vec![true; generator.variables().len()];
    let Some(nodes) = nodes(generator.variables(), &needed, &moment.slots()) else {
        return Err("too many numbers are drawn to integrate over".into());
    };
    for (values, share) in nodes {
        let draw = |_: &_, slots: &[f64]| values[slots.len()];
        generator.evaluate_with(&moment, draw, &mut scratch, &mut points);
        let elements = generator.elements().zip(&alternative.objects);
        for (element, &object) in elements {
            let ratio = (points[element.to] - points[element.from]).length();
            push(ratios, graph, [from, object], ratio, weight * share);
        }
        let mut parts = generator.parts().iter();
        if parts.any(|part| part.placement == Placement::SeedsAsInitiator) {
            return Err(NoLimit::Resets.to_string());
        }
    }
    Ok(())
}
