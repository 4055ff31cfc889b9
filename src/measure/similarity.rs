//! The similarity dimension of a graph (Mauldin & Williams 1988): the D for which the matrix of
//! Σ ratio^D over the instances has spectral radius 1. For one object this is Moran's equation
//! (Moran 1946), Σ ratio^D = 1.

use crate::digraph::{self, parts};
use crate::extent::{Bounded, NoLimit};
use crate::geometry::Frame;
use crate::graph::{Graph, Object};
use crate::saturating::real;

use super::perron::{beside_one, crossing, perron};

/// A similarity dimension, or the reason why there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Similarity {
    /// The dimension; `None` if it is not defined.
    pub value: Option<f64>,
    /// The reason why there is no dimension, or a remark on it.
    pub note: Option<String>,
}

impl Similarity {
    fn none(note: &dyn std::fmt::Display) -> Self {
        Self {
            value: None,
            note: Some(note.to_string()),
        }
    }
}

/// Computes the similarity dimension of the limit set of a graph's fertile elements.
///
/// Infertile elements do not count: the trunk of a tree adds nothing. The value is exact to about 12 digits;
/// overlapping copies are counted with their multiplicity.
#[must_use]
pub fn similarity_dimension<F: Bounded>(graph: &Graph<F>) -> Similarity {
    if graph.draws() {
        return Similarity::none(&"the ratios may depend on draws");
    }
    if let Err(reason) = graph.check_maps() {
        return Similarity::none(&reason);
    }
    if !graph.is_similar() {
        return Similarity::none(&"the maps are no similarities");
    }
    // The spectral radius of the whole is the largest of those of its strongly connected parts.
    let (_, parts) = parts(graph.behaviours().count(), &edges(graph));
    let parts = parts.into_iter().filter(|(_, edges)| !edges.is_empty());
    let parts: Vec<Component> = parts
        .map(|(size, edges)| Component { size, edges })
        .collect();
    if parts.is_empty() {
        return Similarity::none(&NoLimit::NothingFertile);
    }
    if !graph.contracts() {
        return Similarity::none(&NoLimit::DoesNotShrink);
    }
    let parts = parts.into_iter().map(Component::contracted);
    let value = parts.map(|part| part.dimension()).fold(0.0, f64::max);
    let note = (value == 0.0)
        .then(|| "the limit set of the fertile elements is made of single points".into());
    Similarity {
        value: Some(value),
        note,
    }
}

/// Returns the D with Σ ratioᴰ = 1 (Moran 1946), to about 12 digits: the similarity dimension of maps with these ratios,
/// which are at least 0 and below 1. It is 0 for a single ratio, and 0 where all but one are 0.
#[must_use]
pub fn moran_dimension(ratios: &[f64]) -> f64 {
    let ratios = ratios.iter().copied().filter(|ratio| *ratio > 0.0);
    let mut ratios: Vec<f64> = ratios.collect();
    ratios.sort_by(f64::total_cmp);
    match (ratios.first(), ratios.last()) {
        // Equal ratios have a closed form.
        (Some(least), Some(largest)) if least == largest => {
            -libm::log(real(ratios.len())) / libm::log(*largest)
        }
        (Some(_), Some(_)) => dimension_of_powers(&ratios),
        _ => 0.0,
    }
}

/// Returns the D with Σ ratioᴰ = 1, for at least two ratios in rising order: Newton's method finds it nearly, on the logarithm
/// of the sum, which is convex, and bisection to the last digit.
fn dimension_of_powers(ratios: &[f64]) -> f64 {
    const MAX_ROUNDS: usize = 64;
    let distinct = ratios.chunk_by(|a, b| a == b);
    let distinct: Vec<(f64, f64)> = distinct
        .map(|equal| (equal[0], real(equal.len())))
        .collect();
    let logarithms = distinct
        .iter()
        .map(|(ratio, count)| (libm::log(*ratio), count));
    let logarithms: Vec<_> = logarithms.collect();
    let mut near = 0.0;
    for _ in 0..MAX_ROUNDS {
        let (mut sum, mut slope) = (0.0, 0.0);
        for (logarithm, count) in &logarithms {
            let power = *count * libm::exp(near * logarithm);
            sum += power;
            slope += power * logarithm;
        }
        let next = near - sum * libm::log(sum) / slope;
        if next > near && next.is_finite() {
            near = next;
        } else {
            break;
        }
    }
    dimension_near(near, |dimension| {
        let powers = distinct
            .iter()
            .map(|(ratio, count)| count * libm::pow(*ratio, dimension));
        powers.sum()
    })
}

/// Returns the dimension at which a falling function crosses 1, which is probably near a known one.
fn dimension_near(near: f64, radius: impl Fn(f64) -> f64) -> f64 {
    /// Relative distance within which the known one is trusted at first.
    const NEAR: f64 = 4.0 * f64::EPSILON;
    let mut apart = NEAR;
    while apart < 1.0 && near > 0.0 {
        let [low, high] = [1.0 - apart, 1.0 + apart].map(|factor| near * factor);
        if radius(low) > 1.0 && radius(high) <= 1.0 {
            return crossing(high, low, radius);
        }
        apart *= 16.0;
    }
    dimension_between(radius)
}

/// Returns the dimension at which a falling function crosses 1.
fn dimension_between(radius: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while radius(high) > 1.0 {
        (low, high) = (high, 2.0 * high);
    }
    crossing(high, low, radius)
}

/// Returns the similarity dimension of a strongly connected part, given the ratios between its objects, and
/// whether it follows from Moran's equation: whether all objects have the same ratios.
pub(super) fn dimension_of_part(
    size: usize,
    ratios: impl Iterator<Item = (usize, usize, f64)>,
) -> (f64, bool) {
    let edges = ratios.map(|(from, to, ratio)| Edge { from, to, ratio });
    let edges = edges.collect();
    let part = Component { size, edges }.contracted();
    (part.dimension(), part.moran_ratios().is_some())
}

#[derive(Clone)]
struct Edge {
    from: usize,
    to: usize,
    ratio: f64,
}

impl digraph::Edge for Edge {
    fn ends(&self) -> [usize; 2] {
        [self.from, self.to]
    }

    fn between(&self, [from, to]: [usize; 2]) -> Self {
        Self { from, to, ..*self }
    }
}

/// Returns the fertile instances of fertile objects as edges between behaviours: objects of one behaviour are
/// replaced alike.
fn edges<F: Frame>(graph: &Graph<F>) -> Vec<Edge> {
    let of = |(number, object): (usize, &Object<F>)| {
        let children = graph.children(number).map(|(_, instance)| instance);
        let fertile = children.filter(|instance| graph.is_fertile(instance.object));
        let from = object.behaviour;
        let edges = fertile.map(move |instance| Edge {
            from,
            to: graph.objects()[instance.object].behaviour,
            ratio: instance.length,
        });
        edges.collect::<Vec<_>>()
    };
    graph.behaviours_by_number().flat_map(of).collect()
}

/// Ends every ring of objects that pass to each other at its largest object.
fn keep_one_of_rings(passes: &mut [Option<(usize, f64)>]) {
    // The first object of the walk that has met an object.
    let mut met = vec![None; passes.len()];
    for start in 0..passes.len() {
        let mut at = start;
        while let (None, Some((to, _))) = (met[at], passes[at]) {
            met[at] = Some(start);
            at = to;
        }
        if met[at] == Some(start) {
            let ring =
                std::iter::successors(passes[at], |(to, _)| passes[*to].filter(|_| *to != at));
            let largest = ring.map(|(to, _)| to).max();
            largest
                .into_iter()
                .for_each(|largest| passes[largest] = None);
        }
    }
}

/// Lets an object, and those on the way, pass to the object at the end of its way at once. There are no rings.
fn follow(passes: &mut [Option<(usize, f64)>], object: usize) {
    let way = std::iter::successors(Some(object), |at| passes[*at].map(|(to, _)| to));
    let mut way: Vec<usize> = way.collect();
    way.pop();
    let mut known = None;
    for at in way.into_iter().rev() {
        if let (Some((_, own)), Some((to, ratio))) = (passes[at], known) {
            passes[at] = Some((to, own * ratio));
        }
        known = passes[at];
    }
}

/// A strongly connected part of the graph: objects that reach each other.
struct Component {
    size: usize,
    /// Edges between the part's objects, numbered from 0.
    edges: Vec<Edge>,
}

impl Component {
    /// Returns the part without the objects that have one instance only: an edge to such an object is
    /// replaced by one to the object that it instances, with the product of the ratios. The dimension is
    /// unchanged.
    fn contracted(self) -> Self {
        let mut leaving = vec![0_usize; self.size];
        self.edges.iter().for_each(|edge| leaving[edge.from] += 1);
        let mut passes: Vec<Option<(usize, f64)>> = vec![None; self.size];
        for edge in &self.edges {
            if leaving[edge.from] == 1 && edge.to != edge.from {
                passes[edge.from] = Some((edge.to, edge.ratio));
            }
        }
        keep_one_of_rings(&mut passes);
        for object in 0..self.size {
            follow(&mut passes, object);
        }
        let mut number = 0;
        let numbers = passes.iter().map(|passes| {
            number += usize::from(passes.is_none());
            number - usize::from(passes.is_none())
        });
        let numbers: Vec<usize> = numbers.collect();
        let edges = self
            .edges
            .into_iter()
            .filter(|edge| passes[edge.from].is_none());
        let edges = edges.map(|edge| {
            let (to, ratio) = passes[edge.to].unwrap_or((edge.to, 1.0));
            Edge {
                from: numbers[edge.from],
                to: numbers[to],
                ratio: edge.ratio * ratio,
            }
        });
        Self {
            edges: edges.collect(),
            size: number,
        }
    }

    /// Returns the D for which the part's matrix has spectral radius 1.
    fn dimension(&self) -> f64 {
        // The limit set of a cycle without branches is a point.
        if self.edges.len() == self.size {
            return 0.0;
        }
        match self.moran_ratios() {
            Some(ratios) => dimension_of_powers(&ratios),
            None => self.dimension_of_spectrum(),
        }
    }

    /// Returns the ratios of Moran's equation, if all objects have the same ones.
    fn moran_ratios(&self) -> Option<Vec<f64>> {
        let mut ratios = vec![Vec::new(); self.size];
        for edge in &self.edges {
            ratios[edge.from].push(edge.ratio);
        }
        ratios
            .iter_mut()
            .for_each(|ratios| ratios.sort_by(f64::total_cmp));
        let first = ratios.first()?.clone();
        ratios
            .iter()
            .all(|ratios| *ratios == first)
            .then_some(first)
    }

    /// Returns the D for which the part's matrix has spectral radius 1: the secant method finds it nearly, on the logarithm of
    /// the radius, which is convex, and bisection to the last digit.
    fn dimension_of_spectrum(&self) -> f64 {
        const MAX_ROUNDS: usize = 32;
        let logarithm = |dimension| libm::log(self.spectral_radius(dimension, |_| false));
        let mut last = (0.0, logarithm(0.0));
        let mut near = (1.0, logarithm(1.0));
        for _ in 0..MAX_ROUNDS {
            let next = near.0 - near.1 * (near.0 - last.0) / (near.1 - last.1);
            // Neither a quotient of zeros nor a number below 0 is a dimension.
            if !(next.is_finite() && next > 0.0) {
                break;
            }
            let is_still = (next - near.0).abs() <= 2.0 * f64::EPSILON * next;
            (last, near) = (near, (next, logarithm(next)));
            if is_still {
                break;
            }
        }
        dimension_near(near.0, |dimension| {
            self.spectral_radius(dimension, beside_one)
        })
    }

    /// Returns the spectral radius of the matrix of Σ ratio^D; `enough` is that of [`perron`].
    fn spectral_radius(&self, dimension: f64, enough: impl Fn([f64; 2]) -> bool) -> f64 {
        let edges = self.edges.iter();
        let entries = edges.map(|edge| (edge.from, edge.to, libm::pow(edge.ratio, dimension)));
        perron(self.size, &entries.collect::<Vec<_>>(), enough).radius
    }
}
