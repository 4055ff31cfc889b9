//! The similarity dimension of a graph (Mauldin & Williams 1988): the D for which the matrix of
//! Σ ratio^D over the instances has spectral radius 1. For one object this is Moran's equation
//! (Moran 1946), Σ ratio^D = 1.

use crate::graph::{Graph, Instance, Replacement};
use crate::rule::Placement;

/// A similarity dimension, or why there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Similarity {
    /// The dimension.
    pub value: Option<f64>,
    /// What is to be said about it.
    pub note: Option<String>,
}

impl Similarity {
    fn none(note: &str) -> Self {
        Self {
            value: None,
            note: Some(note.into()),
        }
    }
}

/// The similarity dimension of what a graph's fertile elements become.
///
/// Infertile elements do not count: the trunk of a tree adds nothing. The value is exact to some
/// 14 digits; copies that overlap are counted as often as they occur.
#[must_use]
pub fn similarity_dimension(graph: &Graph) -> Similarity {
    if graph.draws() {
        return Similarity::none("the ratios may depend on draws");
    }
    if !graph.is_regular() {
        return Similarity::none("the rule is irregular");
    }
    if graph.depth().is_some() {
        return Similarity::none("the selection does not come back to what it was");
    }
    let edges = edges(graph);
    let Some(edges) = edges else {
        return Similarity::none("there is no limit set: seeds are placed as the initiator");
    };
    let size = graph.objects().len();
    if edges.iter().any(|edge| edge.ratio >= 1.0) {
        return Similarity::none("there is no limit set: a generator does not shrink");
    }
    let moran = moran_ratios(size, &edges);
    let radius = |dimension: f64| match &moran {
        Some(ratios) => ratios
            .iter()
            .map(|&ratio| libm::pow(ratio, dimension))
            .sum(),
        None => spectral_radius(size, &edges, dimension),
    };
    let at_zero = radius(0.0);
    if at_zero < 1.0 - 1e-9 {
        return Similarity::none("nothing stays fertile");
    }
    if at_zero <= 1.0 + 1e-9 {
        let note = "the limit set of the fertile elements is made of single points";
        return Similarity {
            value: Some(0.0),
            note: Some(note.into()),
        };
    }
    let (mut low, mut high) = (0.0, 1.0);
    while radius(high) > 1.0 {
        (low, high) = (high, 2.0 * high);
        if high > 1e6 {
            return Similarity::none("the ratios are too close to 1");
        }
    }
    while high - low > 1e-15 * high {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            break;
        }
        if radius(middle) > 1.0 {
            low = middle
        } else {
            high = middle
        }
    }
    Similarity {
        value: Some(low + (high - low) / 2.0),
        note: None,
    }
}

struct Edge {
    from: usize,
    to: usize,
    ratio: f64,
}

/// The instances of fertile objects; `None` if one of them is a reset.
fn edges(graph: &Graph) -> Option<Vec<Edge>> {
    let mut edges = Vec::new();
    let fertile = |object: usize| !matches!(graph.objects()[object].replacement, Replacement::Kept);
    for (from, object) in graph.objects().iter().enumerate() {
        let Replacement::Fixed(production) = &object.replacement else {
            continue;
        };
        let mut add = |instance: &Instance| {
            if fertile(instance.object) {
                edges.push(Edge {
                    from,
                    to: instance.object,
                    ratio: instance.length,
                });
            }
        };
        production.body.instances.iter().for_each(&mut add);
        for seed in &production.seeds {
            if seed.placement == Placement::SeedsAsInitiator {
                return None;
            }
            seed.chain.instances.iter().for_each(&mut add);
        }
    }
    Some(edges)
}

/// The ratios of Moran's equation, if all objects that are replaced have the same ones.
fn moran_ratios(size: usize, edges: &[Edge]) -> Option<Vec<f64>> {
    let mut ratios = vec![Vec::new(); size];
    for edge in edges {
        ratios[edge.from].push(edge.ratio);
    }
    ratios
        .iter_mut()
        .for_each(|ratios| ratios.sort_by(f64::total_cmp));
    // An object that nothing fertile comes from leads nowhere.
    let mut rows = ratios.into_iter().filter(|ratios| !ratios.is_empty());
    let first = rows.next()?;
    rows.all(|row| row == first).then_some(first)
}

/// The spectral radius of the matrix of Σ ratio^D, by power iteration on the matrix plus the
/// identity, which has one dominant eigenvalue even where the graph is periodic.
fn spectral_radius(size: usize, edges: &[Edge], dimension: f64) -> f64 {
    let weights: Vec<f64> = edges
        .iter()
        .map(|edge| libm::pow(edge.ratio, dimension))
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "a number of objects")]
    let mut vector = vec![1.0 / size as f64; size];
    let mut last = 0.0;
    for round in 0..10_000 {
        let mut next = vector.clone();
        for (edge, weight) in edges.iter().zip(&weights) {
            next[edge.from] += weight * vector[edge.to];
        }
        let norm: f64 = next.iter().sum();
        next.iter_mut().for_each(|entry| *entry /= norm);
        vector = next;
        if round > 3 && (norm - last).abs() <= 1e-16 * norm {
            return norm - 1.0;
        }
        last = norm;
    }
    last - 1.0
}
