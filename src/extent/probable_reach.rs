//! Probable radii of the subtrees of objects, for rules whose draws are unbounded.

use crate::geometry::Frame;

use crate::graph::{Graph, Object, Replacement};

/// Exponents of the moments that are tried.
const POWERS: [f64; 5] = [8.0, 16.0, 24.0, 36.0, 54.0];

/// Probability, as a negative exponent of 2, with which a subtree exceeds its radius.
const NEVER: f64 = 64.0;

/// Limit of the number of sweeps that update all norms.
const MAX_SWEEPS: usize = 200;

/// Limit beyond which norms are taken to diverge.
const MOST: f64 = 1e6;

impl<F: Frame> Graph<F> {
    /// Returns radii as [`reaches`](Graph::reaches) does, for all but improbable draws: the probability
    /// that the subtree of an object exceeds its radius is below 2⁻⁶⁴. Infinite where the graph gives no
    /// bound.
    ///
    /// Let M(o) be the radius of the random subtree of an object, and c the objects in its place. Then
    /// M(o) ≤ max(own(o), away(c) + ratio(c) · M(c)), where M(c) is independent of the draws at o. For
    /// the norms ‖x‖ = E(x^q)^(1/q), Minkowski's inequality yields ‖M(o)‖^q ≤ own(o)^q + Σ (‖away(c)‖ +
    /// ‖ratio(c)‖ · ‖M(c)‖)^q. Numbers that satisfy this inequality in place of the norms are upper
    /// bounds of them; by Markov's inequality M(o) exceeds t with a probability of at most (‖M(o)‖ /
    /// t)^q.
    pub(crate) fn probable_radii(&self, own: impl Fn(&Object<F>) -> f64) -> Vec<f64> {
        let own: Vec<f64> = self.objects.iter().map(own).collect();
        let mut reaches = vec![f64::INFINITY; own.len()];
        if self.resets().contains(&true) {
            return reaches;
        }
        for power in POWERS {
            let Some(norms) = self.norms(&own, power) else {
                continue;
            };
            let rare = libm::exp2(NEVER / power);
            for (object, reach) in reaches.iter_mut().enumerate() {
                let is_drawn = matches!(
                    self.objects[object].replacement,
                    Replacement::Fixed(_) | Replacement::Evaluated(_)
                );
                let likely = if is_drawn {
                    norms[object] * rare
                } else {
                    own[object]
                };
                *reach = reach.min(likely);
            }
        }
        reaches
    }

    /// Returns upper bounds of the norms of the radii, or `None` if none are found.
    fn norms(&self, own: &[f64], power: f64) -> Option<Vec<f64>> {
        // Relative growth below which iteration stops.
        const TOLERANCE: f64 = 1e-3;
        let edges = self.edges(power);
        let next = |norms: &[f64], object: usize, known: &mut [Option<f64>]| {
            let inner = edges.shared(object, known, |edges| {
                let inner = edges.iter().map(|edge| {
                    let far = edge.away + edge.length * norms[edge.object];
                    libm::pow(far, power)
                });
                inner.sum::<f64>()
            });
            libm::pow(libm::pow(own[object], power) + inner, 1.0 / power)
        };
        let unknown = || vec![None; edges.lists()];
        let mut norms = own.to_vec();
        for _ in 0..MAX_SWEEPS {
            let (mut grows, mut known) = (false, unknown());
            for object in (0..own.len()).rev() {
                let norm = next(&norms, object, &mut known);
                grows |= norm > norms[object] * (1.0 + TOLERANCE);
                norms[object] = norms[object].max(norm);
            }
            if !norms.iter().all(|norm| *norm < MOST) {
                return None;
            }
            if !grows {
                let above: Vec<f64> = norms
                    .iter()
                    .map(|norm| norm * (1.0 + 20.0 * TOLERANCE))
                    .collect();
                let mut known = unknown();
                let holds =
                    (0..own.len()).all(|object| next(&above, object, &mut known) <= above[object]);
                return holds.then_some(above);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use crate::catalogue::Catalogue;
    use crate::document::Document;
    use crate::geometry::DVec2;
    use crate::graph::{Graph, Replacement, Successor};
    use crate::grow::{Evaluator, ReplacementContext, TraversalState};

    /// Returns the largest distance of end points in the subtree of an element from its middle, down to
    /// elements of length 0.01.
    fn reached(graph: &Graph, state: &TraversalState, object: usize, level: u32) -> f64 {
        let middle = state.frame.apply(graph.middle());
        let mut evaluator = Evaluator::default();
        let mut farthest: f64 = 0.0;
        let mut open = vec![(*state, object, level, level)];
        while let Some((state, object, born, level)) = open.pop() {
            for end in state.frame.ends() {
                farthest = farthest.max(end.distance(middle));
            }
            if state.frame.stretch() < 1e-2 {
                continue;
            }
            let mut made = Successor::default();
            let successor = match &graph.objects()[object].replacement {
                Replacement::Fixed(successor) => successor,
                Replacement::Evaluated(_) => {
                    let moment = ReplacementContext {
                        born,
                        level,
                        rank: 0,
                    };
                    let evaluated = evaluator.evaluate(graph, &state, object, moment, &mut made);
                    evaluated.unwrap();
                    &made
                }
                _ => continue,
            };
            for (placement, instance) in successor.placed_instances() {
                let born = if placement.seeds() { level + 1 } else { born };
                open.push((
                    state.child(graph, instance),
                    instance.object,
                    born,
                    level + 1,
                ));
            }
        }
        farthest
    }

    #[test]
    fn what_is_drawn_keeps_within_likely_reaches() {
        let catalogue = Catalogue::embedded();
        let source = catalogue.rule("archipelago").unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let graph = document.resolve(&[]).unwrap().0.compile(40).unwrap();
        let own = |object: &_| graph.outline_radius(object);
        assert!(graph.reaches(own).contains(&f64::INFINITY));
        let reaches = graph.probable_radii(own);
        assert!(reaches.iter().all(|reach| *reach < 50.0), "{reaches:?}");
        let mut farthest: f64 = 0.0;
        let object = graph.initiator(0).instances[0].object;
        for seed in 0..2_000 {
            let mut state: TraversalState = TraversalState::whole(seed);
            state.frame = state.frame.moved_to(DVec2::new(0.5, 0.25));
            let reached = reached(&graph, &state, object, 0);
            assert!(reached <= reaches[object], "{seed}: {reached}");
            farthest = farthest.max(reached);
        }
        // The bound is not trivial.
        assert!(
            farthest > reaches[object] / 16.0,
            "{farthest}, {}",
            reaches[object]
        );
    }
}
