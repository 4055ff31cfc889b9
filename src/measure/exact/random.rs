//! The expected dimension of rules with random ratios: E Σ ratio^D = 1 (Falconer 1986, Mauldin & Williams
//! 1986), or spectral radius 1 of the matrix of these expectations.

use crate::digraph::all_loops_shrink;
use crate::draws::Distribution;
use crate::expression::{Dependence, Program};
use crate::extent::NoLimit;
use crate::geometry::Point as _;
use crate::graph::{Alternative, Graph, Instance, Replacement};
use crate::rule::{ElementContext, Generator, Placement, Rule, RuleFrame, Selection};

use crate::measure::perron::crossing;
use crate::saturating::real;

use super::spectral::dense_radius;

/// Maximum number of quadrature nodes of one generator.
const MAX_DRAWS: usize = 40_000;

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
                if push_drawn(&mut ratios, graph, (object.behaviour, alternatives))? {
                    continue;
                }
                let Some(rule) = graph.source().rule() else {
                    return Err("productions are drawn whose effects are not alike".into());
                };
                for (alternative, weight) in weighted(rule, alternatives)? {
                    let from = object.behaviour;
                    push_draws(&mut ratios, graph, rule, from, (alternative, weight))?;
                }
            }
        }
    }
    let size = graph.behaviours().count();
    let edges: Vec<_> = { ratios.iter() }
        .map(|it| (it.from, it.to, it.ratio))
        .collect();
    if !all_loops_shrink(size, &edges, size) {
        return Err(NoLimit::DoesNotShrink.to_string());
    }
    let radius = |dimension: f64| {
        let mut matrix = vec![0.0; size * size];
        for ratio in &ratios {
            let share = ratio.weight * libm::pow(ratio.ratio, dimension);
            matrix[ratio.from * size + ratio.to] += share;
        }
        dense_radius(matrix, size)
    };
    if radius(0.0) <= 1.0 {
        return Err("what is fertile does not multiply".into());
    }
    let (mut low, mut high) = (0.0, 1.0);
    while radius(high) > 1.0 {
        (low, high) = (high, 2.0 * high);
    }
    Ok(crossing(high, low, radius))
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

/// Adds the ratios of alternatives whose instances are fixed; returns `false` if they are not.
fn push_drawn<F: RuleFrame>(
    ratios: &mut Vec<Ratio>,
    graph: &Graph<F>,
    (from, alternatives): (usize, &[Alternative]),
) -> Result<bool, String> {
    let source = graph.source();
    let drawn = alternatives.iter().map(|it| source.drawn(it.generator));
    let Some(drawn) = drawn.collect::<Option<Vec<_>>>() else {
        return Ok(false);
    };
    let total: f64 = drawn.iter().map(|(_, weight)| weight).sum();
    for (alternative, (chain, weight)) in alternatives.iter().zip(drawn) {
        for (instance, &object) in chain.instances.iter().zip(&alternative.objects) {
            push_instance(ratios, graph, [from, object], instance, weight / total)?;
        }
    }
    Ok(true)
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
    for (values, share) in draws(generator, &moment)? {
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

/// Returns the nodes of all variables by slot, with weights: a product of quadratures.
fn draws<F: RuleFrame>(
    generator: &Generator<F>,
    moment: &ElementContext,
) -> Result<Vec<(Vec<f64>, f64)>, String> {
    let mut draws = vec![(moment.slots().to_vec(), 1.0)];
    for variable in generator.variables() {
        let mut next = Vec::new();
        for (slots, weight) in &draws {
            for (value, share) in nodes(variable.distribution(), slots) {
                let mut slots = slots.clone();
                slots.push(value);
                next.push((slots, weight * share));
            }
            if next.len() > MAX_DRAWS {
                return Err("too many numbers are drawn to integrate over".into());
            }
        }
        draws = next;
    }
    Ok(draws)
}

/// Returns the nodes and weights of a quadrature over a distribution.
fn nodes(distribution: &Distribution, slots: &[f64]) -> Vec<(f64, f64)> {
    match distribution {
        Distribution::Uniform(low, high) => {
            let (low, high) = (low.eval(slots), high.eval(slots));
            let place = |(at, weight)| (low + (high - low) * at, weight);
            legendre().into_iter().map(place).collect()
        }
        Distribution::Normal(mean, deviation) => {
            let (mean, deviation) = (mean.eval(slots), deviation.eval(slots));
            // The trapezoidal rule is exponentially accurate for the normal density.
            const STEP: f64 = 0.25;
            let height = STEP / std::f64::consts::TAU.sqrt();
            let node = |k: i32| {
                let at = f64::from(k) * STEP;
                (mean + deviation * at, height * libm::exp(-at * at / 2.0))
            };
            (-33..=33).map(node).collect()
        }
        Distribution::Choice(values) => {
            let weight = 1.0 / real(values.len());
            values
                .iter()
                .map(|value| (value.eval(slots), weight))
                .collect()
        }
    }
}

/// Returns the nodes and weights of Gauss–Legendre quadrature for the interval from 0 to 1.
fn legendre() -> Vec<(f64, f64)> {
    const COUNT: u32 = 20;
    let count = f64::from(COUNT);
    let node = |number: u32| {
        let mut x = libm::cos(std::f64::consts::PI * (f64::from(number) + 0.75) / (count + 0.5));
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut value, mut before) = (x, 1.0);
            for degree in 2..=COUNT {
                let n = f64::from(degree);
                (value, before) = (
                    ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n,
                    value,
                );
            }
            slope = count * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (f64::midpoint(1.0, x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..COUNT).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::{Distribution, legendre, nodes};
    use crate::expression::Program;

    #[test]
    fn moments_are_integrated() {
        let third: f64 = legendre().iter().map(|(at, weight)| weight * at * at).sum();
        assert!((third - 1.0 / 3.0).abs() < 1e-14, "{third}");
        let [mean, deviation] = [3.0, 0.5].map(Program::constant);
        let normal = nodes(&Distribution::Normal(mean, deviation), &[]);
        let square: f64 = normal.iter().map(|(at, weight)| weight * at * at).sum();
        assert!((square - 9.25).abs() < 1e-12, "{square}");
    }
}
