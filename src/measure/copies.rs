//! Graph-directed sets, made of copies of each other, and the distribution of mass among the copies.

use crate::digraph::{components, count, on_infinite_paths};
use crate::geometry::{Affine, DAffine2, Frame, Linear, Point};
use crate::graph::{Graph, Instance};
use crate::ifs::{AffineMap, Ifs};
use crate::rule::Placement;

use crate::saturating::real;

use super::perron::{Entry, beside_one, crossing, perron};

/// A copy of one set inside another: the set `from` holds the image of the set `to` under the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Copy<M = DAffine2> {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) map: M,
}

/// Sets that are made of copies of each other, and the whole, which is made of copies of them (`start`).
#[derive(Clone, Debug)]
pub(super) struct Copies<M = DAffine2> {
    pub(super) size: usize,
    pub(super) copies: Vec<Copy<M>>,
    pub(super) start: Vec<(usize, M)>,
}

/// Copies with their shares of the mass of the set that holds them, and the masses of the copies of the
/// whole.
#[derive(Clone, Debug)]
pub(super) struct WeightedCopies<M = DAffine2> {
    pub(super) copies: Copies<M>,
    pub(super) shares: Vec<f64>,
    pub(super) masses: Vec<f64>,
}

/// Maximum difference of dimensions that count as equal.
const SAME: f64 = 1e-9;

/// Dimension above which maps are taken not to contract.
const LARGEST: f64 = 64.0;

/// Maximum number of iterations of masses along the edges of a graph.
const MAX_ROUNDS: usize = 100_000;

/// A strongly connected component.
#[derive(Clone, Debug, Default)]
struct Component {
    sets: Vec<usize>,
    /// Indices of the copies between sets of the component.
    inside: Vec<usize>,
    dimension: Option<f64>,
}

impl<M: Affine> Copies<M> {
    /// Returns the copies that the limit set of a graph's fertile elements is made of; `None` if they are not
    /// made of fixed maps.
    pub(super) fn of<F: Frame<Map = M>>(graph: &Graph<F>) -> Option<Self> {
        let copies = fixed_copies(graph)?;
        let copies = copies
            .into_iter()
            .map(|(from, to, map)| Copy { from, to, map });
        let start = graph.initiator(0).instances.iter();
        let start = start.map(|instance| {
            let set = graph.objects()[instance.object].behaviour;
            (set, *instance.frame.map())
        });
        let all = Self {
            size: graph.behaviours().count(),
            copies: copies.collect(),
            start: start.collect(),
        };
        Some(all.lasting())
    }

    /// Removes the sets that contain no infinite sequence of copies.
    fn lasting(mut self) -> Self {
        let mut targets = vec![Vec::new(); self.size];
        { self.copies.iter() }.for_each(|copy| targets[copy.from].push(copy.to));
        let lasts = on_infinite_paths(&targets);
        self.copies.retain(|copy| lasts[copy.to]);
        self.start.retain(|(set, _)| lasts[*set]);
        self
    }

    /// Returns the natural measure, for which a copy of size r has a mass of about r^s, where s is the
    /// similarity dimension (Hutchinson 1981): shares are r^s h(to) / h(from), where h is the eigenvector, of
    /// eigenvalue 1, of the matrix of the sums of r^s (Mauldin & Williams 1988).
    ///
    /// For maps that are not similarities, the singular value function replaces r^s (Falconer 1988). Sets
    /// that do not reach a component of the largest dimension have no mass. Where several of these lie on one
    /// path, the mass stays in the first: the number of small copies in any one set beyond it is negligible
    /// against the number in it.
    ///
    /// Returns `None` where maps do not contract, or where no set holds copies of itself.
    pub(super) fn natural(self) -> Option<WeightedCopies<M>> {
        let values: Vec<SingularValues> = self
            .copies
            .iter()
            .map(|copy| SingularValues::of(&copy.map.linear()))
            .collect();
        let mut components = self.components();
        for component in &mut components {
            component.dimension = self.dimension(component, &values)?;
        }
        let dimensions = components.iter().filter_map(|it| it.dimension);
        let most = dimensions.max_by(f64::total_cmp)?;
        let sizes: Vec<f64> = values.iter().map(|it| it.cost(most)).collect();
        let mut heights = vec![0.0; self.size];
        let mut levels = vec![0; self.size];
        let mut shares = vec![0.0; self.copies.len()];
        // Copies lead to components of lower numbers only.
        let mut leaving: Vec<Vec<usize>> = vec![Vec::new(); components.len()];
        let mut component_of = vec![0; self.size];
        for (number, component) in components.iter().enumerate() {
            component
                .sets
                .iter()
                .for_each(|&set| component_of[set] = number);
        }
        for (number, copy) in self.copies.iter().enumerate() {
            if component_of[copy.from] != component_of[copy.to] {
                leaving[component_of[copy.from]].push(number);
            }
        }
        for (number, component) in components.iter().enumerate() {
            let leaving = &leaving[number];
            let below = leaving
                .iter()
                .map(|&copy| levels[self.copies[copy].to])
                .max();
            let below = below.unwrap_or(0);
            let is_largest = component.dimension.is_some_and(|own| most - own <= SAME);
            let level = below + usize::from(is_largest);
            component.sets.iter().for_each(|&set| levels[set] = level);
            if level == 0 {
                continue;
            }
            let inside = component.inside.iter().copied();
            let used: Vec<usize> = if is_largest {
                self.fill(component, &sizes, &mut heights);
                inside.collect()
            } else {
                let leaving = leaving.iter().copied();
                let leaving = leaving.filter(|&copy| levels[self.copies[copy].to] == level);
                let used: Vec<usize> = inside.chain(leaving).collect();
                self.flow(&used, &sizes, &mut heights);
                used
            };
            let mut sums = vec![0.0; self.size];
            for &copy in &used {
                let Copy { from, to, .. } = self.copies[copy];
                shares[copy] = sizes[copy] * heights[to];
                sums[from] += shares[copy];
            }
            for &copy in &used {
                let sum = sums[self.copies[copy].from];
                shares[copy] = if sum > 0.0 { shares[copy] / sum } else { 0.0 };
            }
        }
        let masses = self.masses(most, &levels, &heights)?;
        Some(WeightedCopies {
            copies: self,
            shares,
            masses,
        })
    }

    /// Returns the masses of the copies that the whole is made of.
    fn masses(&self, dimension: f64, levels: &[usize], heights: &[f64]) -> Option<Vec<f64>> {
        let level = self.start.iter().map(|(set, _)| levels[*set]).max()?;
        let mass = |(set, map): &(usize, M)| {
            let size = SingularValues::of(&map.linear()).cost(dimension);
            if level > 0 && levels[*set] == level {
                size * heights[*set]
            } else {
                0.0
            }
        };
        let masses: Vec<f64> = self.start.iter().map(mass).collect();
        let sum: f64 = masses.iter().sum();
        (sum > 0.0 && sum.is_finite()).then(|| masses.iter().map(|mass| mass / sum).collect())
    }

    fn components(&self) -> Vec<Component> {
        let mut targets = vec![Vec::new(); self.size];
        for copy in &self.copies {
            targets[copy.from].push(copy.to);
        }
        let component = components(&targets);
        let count = count(&component);
        let mut components = vec![Component::default(); count];
        for (set, &number) in component.iter().enumerate() {
            components[number].sets.push(set);
        }
        for (number, copy) in self.copies.iter().enumerate() {
            if component[copy.from] == component[copy.to] {
                components[component[copy.from]].inside.push(number);
            }
        }
        components
    }

    /// Returns the entries of a component's matrix, its sets numbered from 0.
    fn entries(&self, component: &Component, value: impl Fn(usize) -> f64) -> Vec<Entry> {
        // The sets of a component are in increasing order.
        let number = |set: usize| component.sets.binary_search(&set).unwrap_or(0);
        let inside = component.inside.iter();
        let entry = |&copy: &usize| {
            let Copy { from, to, .. } = self.copies[copy];
            (number(from), number(to), value(copy))
        };
        inside.map(entry).collect()
    }

    /// Returns the dimension of a component: the s for which its matrix has the spectral radius 1, or an
    /// inner `None` if the component has no cycle. Returns `None` if there is no such s.
    #[expect(clippy::option_option, reason = "no cycle is no failure")]
    fn dimension(&self, component: &Component, values: &[SingularValues]) -> Option<Option<f64>> {
        if component.inside.is_empty() {
            return Some(None);
        }
        if component.inside.len() == component.sets.len() {
            return Some(Some(0.0));
        }
        let radius = |s: f64| {
            let entries = self.entries(component, |copy| values[copy].cost(s));
            perron(component.sets.len(), &entries, beside_one).radius
        };
        let mut high = 1.0;
        while radius(high) > 1.0 {
            high *= 2.0;
            if high > LARGEST {
                return None;
            }
        }
        Some(Some(crossing(high, 0.0, radius)))
    }

    /// Computes the eigenvector of a component's matrix for the eigenvalue 1.
    fn fill(&self, component: &Component, sizes: &[f64], heights: &mut [f64]) {
        let entries = self.entries(component, |copy| sizes[copy]);
        let vector = perron(component.sets.len(), &entries, |_| false).vector;
        for (&set, height) in component.sets.iter().zip(vector) {
            heights[set] = height;
        }
    }

    /// Propagates masses from components below, along the copies `used`, until they converge.
    fn flow(&self, used: &[usize], sizes: &[f64], heights: &mut [f64]) {
        const TOLERANCE: f64 = 1e-15;
        for _ in 0..MAX_ROUNDS {
            let mut sums = std::collections::BTreeMap::new();
            for &copy in used {
                let Copy { from, to, .. } = self.copies[copy];
                *sums.entry(from).or_insert(0.0) += sizes[copy] * heights[to];
            }
            let mut change: f64 = 0.0;
            for (set, sum) in sums {
                change = change.max((sum - heights[set]).abs() / sum);
                heights[set] = sum;
            }
            if change <= TOLERANCE || change.is_nan() {
                break;
            }
        }
    }
}

/// Logarithms of the singular values of a map, in falling order.
#[derive(Clone, Copy, Debug)]
struct SingularValues {
    logs: [f64; 3],
    dimension: usize,
}

impl SingularValues {
    fn of<L: Linear>(matrix: &L) -> Self {
        Self {
            logs: matrix.singular_values().map(libm::log),
            dimension: L::Point::DIMENSION,
        }
    }

    /// Returns the singular value function φ^s (Falconer 1988): r^s for a similarity.
    fn cost(&self, s: f64) -> f64 {
        let logs = &self.logs[..self.dimension];
        let dimension = real(self.dimension);
        // 0 times the logarithm of 0 is taken as 0.
        let times = |share: f64, log: f64| if share > 0.0 { share * log } else { 0.0 };
        if s >= dimension {
            return libm::exp(s / dimension * logs.iter().sum::<f64>());
        }
        let parts = logs.iter().enumerate();
        let parts = parts.map(|(before, log)| times((s - real(before)).min(1.0), *log));
        libm::exp(parts.sum::<f64>())
    }
}

impl<M: Affine> WeightedCopies<M> {
    /// Returns the measure that the weights of a system define: that of random iteration without condensation
    /// sets (Demko, Hodges & Naylor 1985; of recurrent systems: Barnsley, Elton & Hardin 1989).
    ///
    /// In a recurrent system, the set of a map holds the images, under that map, of the sets of its
    /// predecessors. The share of i in the set of j is π_i p_ij / π_j, where p_ij is the probability of a
    /// step from i to j and π is the stationary distribution. Returns `None` where that depends on the start
    /// of the walk.
    pub(super) fn of_weights(ifs: &Ifs<M>) -> Option<Self>
    where
        M: AffineMap,
    {
        let maps = ifs.maps();
        let Some(edges) = ifs.edges() else {
            let all: f64 = ifs.weights().iter().sum();
            let copies = maps.iter().zip(ifs.weights());
            let copies = copies.map(|(map, weight)| ((0, 0, map.affine), weight / all));
            let whole = vec![(0, M::IDENTITY)];
            return Some(Self::joined(1, copies, whole, vec![1.0]));
        };
        let edges: Vec<(usize, usize, f64)> = edges
            .map(|(edge, weight)| (edge.from, edge.to, weight))
            .collect();
        let mut sums = vec![0.0; maps.len()];
        edges
            .iter()
            .for_each(|&(from, _, weight)| sums[from] += weight);
        let mut targets = vec![Vec::new(); maps.len()];
        edges
            .iter()
            .for_each(|&(from, to, _)| targets[from].push(to));
        let component = components(&targets);
        // Steps lead to components of lower numbers only, and component 0 is never left.
        let is_left = |part: usize| {
            edges
                .iter()
                .any(|&(from, to, _)| component[from] == part && component[to] != part)
        };
        let count = count(&component);
        if (1..count).any(|part| !is_left(part)) {
            return None;
        }
        let stay: Vec<usize> = (0..maps.len()).filter(|&map| component[map] == 0).collect();
        let number = |map: usize| stay.binary_search(&map).unwrap_or(0);
        let steps = edges.iter().filter(|(from, ..)| component[*from] == 0);
        let steps: Vec<Entry> = steps
            .map(|&(from, to, weight)| (number(to), number(from), weight / sums[from]))
            .collect();
        let often = perron(stay.len(), &steps, |_| false).vector;
        let copies = steps.iter().map(|&(to, from, probability)| {
            let map = maps[stay[to]].affine;
            ((to, from, map), often[from] * probability / often[to])
        });
        let all: f64 = often.iter().sum();
        let start = (0..stay.len()).map(|set| (set, M::IDENTITY));
        let masses = often.iter().map(|often| often / all);
        Some(Self::joined(
            stay.len(),
            copies,
            start.collect(),
            masses.collect(),
        ))
    }

    /// Joins equal copies, whose shares are added.
    fn joined(
        size: usize,
        copies: impl Iterator<Item = ((usize, usize, M), f64)>,
        start: Vec<(usize, M)>,
        masses: Vec<f64>,
    ) -> Self {
        let (mut kept, mut shares): (Vec<Copy<M>>, Vec<f64>) = (Vec::new(), Vec::new());
        for ((from, to, map), share) in copies {
            let copy = Copy { from, to, map };
            match kept.iter().position(|known| *known == copy) {
                Some(known) => shares[known] += share,
                None => {
                    kept.push(copy);
                    shares.push(share);
                }
            }
        }
        Self {
            copies: Copies {
                size,
                copies: kept,
                start,
            },
            shares,
            masses,
        }
    }
}

/// Returns the copies that the fertile elements of a graph are made of, by the numbers of behaviours: the set
/// that holds a copy, the set that is copied, and the map. Returns `None` if the graph is not a list of fixed
/// maps, or has resets.
pub(super) fn fixed_copies<F: Frame>(graph: &Graph<F>) -> Option<Vec<(usize, usize, F::Map)>> {
    if !graph.is_regular() || !graph.is_plain() || graph.depth().is_some() {
        return None;
    }
    let fertile = |instance: &Instance<F>| {
        let object = &graph.objects()[instance.object];
        !object.is_kept()
    };
    let mut copies = Vec::new();
    // Objects of one behaviour are replaced alike.
    for object in graph.behaviours() {
        let Some(production) = object.successor() else {
            continue;
        };
        for (placement, instance) in production.placed_instances() {
            if !fertile(instance) {
                continue;
            }
            if placement == Placement::SeedsAsInitiator {
                return None;
            }
            let to = graph.objects()[instance.object].behaviour;
            copies.push((object.behaviour, to, *instance.frame.map()));
        }
    }
    Some(copies)
}
