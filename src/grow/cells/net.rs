//! Limit set of a graph, as sets that consist of images of each other.

use crate::digraph::on_infinite_paths;
use crate::geometry::{DAffine2, DVec2, Linear as _, stretch};
use crate::graph::{Graph, Instance, Object};

/// Maximum length of the addresses of points.
const MAX_LEVELS: usize = 1 << 20;

/// Stretch of a map below which the image of a set is a point.
const NEGLIGIBLE: f64 = 1e-18;

/// Maximum number of maps that are composed in one edge.
const MAX_MAPS: usize = 16;

/// Spectral radius above which a map moves many points by less than a cell.
const HARDLY_CONTRACTS: f64 = 0.95;

/// Spectral radius up to which a map needs no square.
const ENOUGH: f64 = 0.5;

/// Maximum number of squares of a map, each of the one before.
const MAX_SQUARES: usize = 32;

/// Way in which a set is part of another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub(super) map: DAffine2,
    /// Index of the other set.
    pub(super) whole: usize,
    /// Number of maps that are composed.
    pub(super) maps: usize,
}

impl Edge {
    /// Returns the number of additional steps, compared with a single map, after which elements of the image
    /// are born.
    pub(super) fn later(&self) -> u16 {
        u16::try_from(self.maps.saturating_sub(1)).unwrap_or(u16::MAX)
    }
}

/// Set of the limit, in a unit frame.
#[derive(Clone, Debug, Default)]
pub(super) struct LimitNode {
    /// Ways in which it is part of other sets.
    pub(super) images: Vec<Edge>,
    /// Maps by which outlines are parts of it, with the indices of base elements.
    pub(super) outlines: Vec<(DAffine2, usize)>,
    /// Point of the set, if it is more than outlines and their images.
    pub(super) point: Option<DVec2>,
    /// Upper bound of its stretch in the picture.
    pub(super) stretch: f64,
}

/// Sets: first the descendants of each behaviour, then the contents of each layer of a picture.
#[derive(Clone, Debug)]
pub(super) struct Net {
    pub(super) nodes: Vec<LimitNode>,
}

/// Part of a picture: objects with the maps that place them, including all their descendants.
pub(crate) type Layer = Vec<(DAffine2, usize)>;

impl Net {
    /// Creates the sets of layers, as far as anything is drawn in them.
    pub(super) fn of(graph: &Graph, layers: &[Layer]) -> Self {
        let builder = Builder {
            graph,
            drawn: graph.alive(true),
        };
        builder.run(layers)
    }
}

struct Builder<'g> {
    graph: &'g Graph,
    /// By object, whether anything of it is drawn in the limit.
    drawn: Vec<bool>,
}

impl Builder<'_> {
    fn is_replaced(&self, object: usize) -> bool {
        self.graph.objects()[object].successor().is_some()
    }

    /// Returns the behaviour of an object of which anything is drawn.
    fn node(&self, object: usize) -> Option<usize> {
        let is_drawn = self.drawn[object] && self.is_replaced(object);
        is_drawn.then(|| self.graph.objects()[object].behaviour)
    }

    fn children(&self, object: usize) -> impl Iterator<Item = &Instance> {
        let children = self.graph.children(object).map(|(_, instance)| instance);
        children.filter(|instance| self.drawn[instance.object])
    }

    fn run(&self, layers: &[Layer]) -> Net {
        let behaviours = self.graph.behaviours().count();
        let mut nodes = vec![LimitNode::default(); behaviours + layers.len()];
        let mut add = |whole: usize, map: &DAffine2, object: usize| {
            if let Some(part) = self.node(object) {
                let image = Edge {
                    map: *map,
                    whole,
                    maps: 1,
                };
                if !nodes[part].images.contains(&image) {
                    nodes[part].images.push(image);
                }
            } else if self.drawn[object] {
                let outline = (*map, self.graph.objects()[object].base_element);
                if !nodes[whole].outlines.contains(&outline) {
                    nodes[whole].outlines.push(outline);
                }
            }
        };
        for (number, object) in self.graph.behaviours_by_number() {
            for instance in self.children(number) {
                add(object.behaviour, instance.frame.map(), instance.object);
            }
        }
        for (layer, parts) in layers.iter().enumerate() {
            for (map, object) in parts {
                add(behaviours + layer, map, *object);
            }
        }
        let mut net = Net { nodes };
        net.measure(behaviours);
        self.find_points(&mut net);
        net.leave_out(behaviours);
        net
    }

    /// Finds points of sets that are replaced without end, by fixed addresses.
    fn find_points(&self, net: &mut Net) {
        let parts = |(number, _): (usize, &Object)| -> Vec<(DAffine2, usize)> {
            let children = self.children(number);
            let parts = children.map(|it| Some((*it.frame.map(), self.node(it.object)?)));
            parts.flatten().collect()
        };
        let mut parts: Vec<Vec<_>> = self.graph.behaviours_by_number().map(parts).collect();
        let targets = parts.iter();
        let targets = targets.map(|parts| parts.iter().map(|(_, part)| *part).collect());
        let lasting = on_infinite_paths(&targets.collect::<Vec<_>>());
        for parts in &mut parts {
            parts.retain(|(_, part)| lasting[*part]);
        }
        for behaviour in 0..parts.len() {
            let is_needed = net.nodes[behaviour].stretch > 0.0;
            if !is_needed || parts[behaviour].is_empty() {
                continue;
            }
            let (mut map, mut at) = (DAffine2::IDENTITY, behaviour);
            let mut turn: u32 = 0;
            for _ in 0..MAX_LEVELS {
                if stretch(&map.matrix2) <= NEGLIGIBLE {
                    break;
                }
                // Multiples of the golden section never repeat.
                turn = turn.wrapping_add(0x9e37_79b9);
                let choice = (u64::from(turn) * parts[at].len() as u64) >> 32;
                let (next, part) = parts[at][choice as usize];
                (map, at) = (map * next, part);
            }
            net.nodes[behaviour].point = Some(map.translation);
        }
    }
}

impl Net {
    /// Computes the largest stretch of sets, over paths that return to no set.
    fn measure(&mut self, behaviours: usize) {
        for layer in &mut self.nodes[behaviours..] {
            layer.stretch = 1.0;
        }
        for _ in 0..=behaviours {
            let mut changes = false;
            for part in (0..behaviours).rev() {
                let images = self.nodes[part].images.iter();
                let longest = images.map(|image| {
                    let own = if image.whole == part {
                        0.0
                    } else {
                        stretch(&image.map.matrix2)
                    };
                    own * self.nodes[image.whole].stretch
                });
                let longest = longest.fold(self.nodes[part].stretch, f64::max);
                changes |= longest > self.nodes[part].stretch;
                self.nodes[part].stretch = longest;
            }
            if !changes {
                break;
            }
        }
    }

    /// Bypasses the sets that are part of exactly one other set in one way: their parts become parts of that
    /// set, so that no cells of their own are needed.
    fn leave_out(&mut self, behaviours: usize) {
        for part in 0..behaviours {
            let [edge] = self.nodes[part].images[..] else {
                continue;
            };
            if edge.whole == part {
                continue;
            }
            for node in &mut self.nodes[..behaviours] {
                let images = std::mem::take(&mut node.images);
                for mut image in images {
                    if image.whole == part && image.maps + edge.maps <= MAX_MAPS {
                        image = Edge {
                            map: edge.map * image.map,
                            whole: edge.whole,
                            maps: image.maps + edge.maps,
                        };
                    }
                    if !node.images.contains(&image) {
                        node.images.push(image);
                    }
                }
            }
        }
    }

    /// Adds squares of the maps of sets to themselves that hardly contract, of their squares, and of these in
    /// turn. Such a map may move the one point of a cell by less than a cell, or in a round through cells that
    /// are met, where its orbit would end. With the squares, few maps lead from a point to any of its iterates.
    pub(super) fn with_squares(mut self) -> Self {
        for (number, node) in self.nodes.iter_mut().enumerate() {
            let own = node.images.iter().filter(|image| image.whole == number);
            let squares: Vec<Edge> = own.flat_map(squares).collect();
            node.images.extend(squares);
        }
        self
    }

    /// Returns the largest number of maps that are composed in one edge.
    pub(super) fn max_maps(&self) -> usize {
        let images = self.nodes.iter().flat_map(|node| &node.images);
        images.map(|image| image.maps).max().unwrap_or(1)
    }
}

/// Returns the squares of a map that hardly contracts, until they do.
fn squares(edge: &Edge) -> impl Iterator<Item = Edge> {
    let radius = edge.map.matrix2.spectral_radius();
    let hardly = (HARDLY_CONTRACTS..1.0).contains(&radius);
    let first = hardly.then_some((*edge, radius));
    let all = std::iter::successors(first, |(edge, radius)| {
        let square = Edge {
            map: edge.map * edge.map,
            ..*edge
        };
        (*radius > ENOUGH).then_some((square, radius * radius))
    });
    all.skip(1).take(MAX_SQUARES).map(|(edge, _)| edge)
}
