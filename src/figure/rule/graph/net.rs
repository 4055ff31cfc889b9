//! Nodes and arrows of the figure of an instancing graph, and their places.

use std::collections::{BTreeMap, BTreeSet};

use crate::geometry::{DVec2, Frame};
use crate::graph::{Graph, Replacement};

use super::Topology;

/// Distance of rows, in pixels.
const ROW: f64 = 92.0;
/// Distance of nodes in a row, where there is room, and the least distance.
const COLUMNS: [f64; 2] = [110.0, 44.0];
/// Width up to which nodes of a row keep the first of these distances.
const WIDTH: f64 = 900.0;

/// Limits of the number of nodes, and of pairs of nodes with arrows.
const MAX_NODES: usize = 400;
const MAX_EDGES: usize = 4_000;

/// Subject of a node.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Subject {
    Start,
    /// An object, with the number of steps that remain if they count.
    Object(usize, Option<u32>),
}

/// A node in its row.
pub(super) struct GraphNode {
    pub(super) subject: Subject,
    row: usize,
    /// Position across, in pixels from the middle.
    x: f64,
    /// Whether the object is replaced here.
    pub(super) is_replaced: bool,
    /// Whether one of several generators replaces it, drawn at random.
    pub(super) is_drawn: bool,
}

/// Arrows between two nodes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Link {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) seeds: bool,
}

/// Nodes and arrows of a figure.
pub(super) struct Net {
    pub(super) nodes: Vec<GraphNode>,
    pub(super) links: BTreeMap<Link, usize>,
    /// Whether nodes or arrows are left out.
    pub(super) is_cut: bool,
}

impl Net {
    /// Makes the net of a graph, for so many steps.
    pub(super) fn of<F: Frame>(graph: &Graph<F>, topology: Topology, steps: u32) -> Self {
        let mut net = Self {
            nodes: vec![GraphNode::new(Subject::Start, 0, graph)],
            links: BTreeMap::new(),
            is_cut: false,
        };
        let mut known = BTreeMap::from([(Subject::Start, 0)]);
        let mut alike = Alike::default();
        let mut next = 0;
        while next < net.nodes.len() {
            let (subject, row) = (net.nodes[next].subject, net.nodes[next].row);
            for (object, seeds) in children(graph, subject, steps, topology) {
                let remaining = match (topology, subject) {
                    (Topology::Cyclic, _) => None,
                    (_, Subject::Start) => Some(steps),
                    (_, Subject::Object(_, remaining)) => {
                        Some(remaining.unwrap_or(0).saturating_sub(1))
                    }
                };
                let subject = Subject::Object(alike.first(object, graph), remaining);
                let shared = known.get(&subject).filter(|_| topology != Topology::Tree);
                let to = match shared {
                    Some(to) => *to,
                    None if net.nodes.len() >= MAX_NODES => {
                        net.is_cut = true;
                        continue;
                    }
                    None => {
                        net.nodes.push(GraphNode::new(subject, row + 1, graph));
                        known.insert(subject, net.nodes.len() - 1);
                        net.nodes.len() - 1
                    }
                };
                let link = Link {
                    from: next,
                    to,
                    seeds,
                };
                if net.links.len() < MAX_EDGES || net.links.contains_key(&link) {
                    *net.links.entry(link).or_default() += 1;
                } else {
                    net.is_cut = true;
                }
            }
            next += 1;
        }
        match topology {
            Topology::Tree => net.spread_tree(),
            Topology::Levels => net.spread_rows(),
            Topology::Cyclic => {
                net.sink();
                net.spread_rows();
            }
        }
        net
    }

    /// Moves the objects that are not replaced below the others.
    fn sink(&mut self) {
        let replaced = self.nodes.iter().filter(|node| node.is_replaced);
        let last = replaced.map(|node| node.row).max().unwrap_or(0);
        for node in self
            .nodes
            .iter_mut()
            .skip(1)
            .filter(|node| !node.is_replaced)
        {
            node.row = last + 1;
        }
    }

    /// Spreads the nodes of every row, each under the nodes that instance it.
    fn spread_rows(&mut self) {
        let last = self.nodes.iter().map(|node| node.row).max().unwrap_or(0);
        for row in 0..=last {
            let mut own: Vec<(f64, usize)> = (0..self.nodes.len())
                .filter(|number| self.nodes[*number].row == row)
                .map(|number| (self.mean_above(number), number))
                .collect();
            own.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            #[expect(clippy::cast_precision_loss, reason = "there are few nodes")]
            let count = own.len() as f64;
            let distance = (WIDTH / count).clamp(COLUMNS[1], COLUMNS[0]);
            for (place, (_, number)) in (0_u32..).zip(own) {
                self.nodes[number].x = (f64::from(place) - (count - 1.0) / 2.0) * distance;
            }
        }
    }

    /// Returns the mean position of the nodes in the row above that lead to a node.
    fn mean_above(&self, number: usize) -> f64 {
        let row = self.nodes[number].row;
        let above = self.links.keys().filter(|link| link.to == number);
        let above: Vec<f64> = above
            .map(|link| &self.nodes[link.from])
            .filter(|node| node.row < row)
            .map(|node| node.x)
            .collect();
        #[expect(clippy::cast_precision_loss, reason = "there are few nodes")]
        let count = above.len().max(1) as f64;
        above.iter().sum::<f64>() / count
    }

    /// Puts leaves side by side, and every other node over the middle of its children.
    fn spread_tree(&mut self) {
        let mut children = vec![Vec::new(); self.nodes.len()];
        for link in self.links.keys() {
            children[link.from].push(link.to);
        }
        let leaves = children.iter().filter(|own| own.is_empty()).count();
        #[expect(clippy::cast_precision_loss, reason = "there are few nodes")]
        let distance = (WIDTH / leaves.max(1) as f64).clamp(COLUMNS[1], COLUMNS[0]);
        let mut place = 0.0;
        // Leaves come in the order of the walk, depth first.
        let mut stack = vec![(0, false)];
        while let Some((number, is_done)) = stack.pop() {
            let own = &children[number];
            if own.is_empty() {
                self.nodes[number].x = place;
                place += distance;
            } else if is_done {
                let ends = [own[0], own[own.len() - 1]].map(|child| self.nodes[child].x);
                self.nodes[number].x = f64::midpoint(ends[0], ends[1]);
            } else {
                stack.push((number, true));
                stack.extend(own.iter().rev().map(|child| (*child, false)));
            }
        }
        let middle = (place - distance) / 2.0;
        for node in &mut self.nodes {
            node.x -= middle;
        }
    }

    /// Returns whether there are several objects, which have numbers.
    pub(super) fn has_numbers(&self) -> bool {
        let objects = self.nodes.iter().filter_map(|node| match node.subject {
            Subject::Object(number, _) => Some(number),
            Subject::Start => None,
        });
        objects.collect::<BTreeSet<_>>().len() > 1
    }
}

/// Objects that draw and are replaced alike, of which the first stands for all: those that differ by the generator or the map
/// that has made them.
#[derive(Default)]
struct Alike(BTreeMap<(Option<usize>, usize, bool), Vec<usize>>);

impl Alike {
    fn first<F: Frame>(&mut self, number: usize, graph: &Graph<F>) -> usize {
        let object = &graph.objects()[number];
        let behaviour = match object.replacement {
            Replacement::Kept => None,
            _ => Some(object.behaviour),
        };
        let group = self
            .0
            .entry((behaviour, object.base_element, object.visible));
        let group = group.or_default();
        let is_alike = |other: &&usize| {
            let other = &graph.objects()[**other];
            other.tint == object.tint
                && other.paint == object.paint
                && other.thickness == object.thickness
        };
        if let Some(first) = group.iter().find(is_alike) {
            return *first;
        }
        group.push(number);
        number
    }
}

impl GraphNode {
    fn new<F: Frame>(subject: Subject, row: usize, graph: &Graph<F>) -> Self {
        let replacement = match subject {
            Subject::Start => None,
            Subject::Object(_, Some(0)) => None,
            Subject::Object(number, _) => Some(&graph.objects()[number].replacement),
        };
        Self {
            subject,
            row,
            x: 0.0,
            is_replaced: matches!(
                replacement,
                Some(Replacement::Fixed(_) | Replacement::Evaluated(_) | Replacement::Unresolved)
            ),
            is_drawn: matches!(replacement, Some(Replacement::Evaluated(all)) if all.len() > 1),
        }
    }

    /// Returns whether the node is in a row above that of another.
    pub(super) fn is_above(&self, other: &Self) -> bool {
        self.row < other.row
    }

    /// Returns the position of the middle, in pixels.
    pub(super) fn centre(&self) -> DVec2 {
        #[expect(clippy::cast_precision_loss, reason = "there are few rows")]
        let row = self.row as f64;
        DVec2::new(self.x, row * ROW)
    }
}

/// Returns the objects of the instances of a node, and whether they start new fractals.
fn children<F: Frame>(
    graph: &Graph<F>,
    subject: Subject,
    steps: u32,
    topology: Topology,
) -> Vec<(usize, bool)> {
    let number = match subject {
        Subject::Start => {
            let start = graph.initiator(steps).instances.iter();
            return start.map(|instance| (instance.object, false)).collect();
        }
        Subject::Object(_, Some(0)) if topology != Topology::Cyclic => return Vec::new(),
        Subject::Object(number, _) => number,
    };
    match &graph.objects()[number].replacement {
        Replacement::Fixed(successor) => {
            let placed = successor.placed_instances();
            placed
                .map(|(placement, instance)| (instance.object, placement.seeds()))
                .collect()
        }
        Replacement::Evaluated(alternatives) => {
            let listed = alternatives.iter().flat_map(|alternative| {
                let parts = graph.parts(alternative).iter();
                let seeds = parts.flat_map(|part| {
                    let seeds = part.placement.seeds();
                    part.elements.iter().map(move |_| seeds)
                });
                let seeds = seeds.chain(std::iter::repeat(false));
                alternative.objects.iter().copied().zip(seeds)
            });
            listed.collect()
        }
        Replacement::Kept | Replacement::Unresolved => Vec::new(),
    }
}
