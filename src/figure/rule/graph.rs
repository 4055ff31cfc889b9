//! Figures of instancing graphs (Hart 1992, figures 1 to 3, right): objects as circles, instances as arrows.
//!
//! The graph of a limit set is cyclic, that of an approximant has a level for each step, and the tree of an approximant has a node
//! for each element.

use std::collections::{BTreeMap, BTreeSet};

use crate::geometry::{Bounds, DAffine2, DAffine3, DMat3, DVec2, Frame, Frame2, Frame3};
use crate::graph::{Graph, Replacement};
use crate::render::{Paint, Pen};
use crate::rule::Piece;
use crate::style::Named;

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::ink::{self, ElementRole};
use super::lines::{flattened, outline};
use super::page::{SMALL, WORDS, lay_out};
use super::space;

/// Radius of a node, in pixels.
const RADIUS: f64 = 19.0;
/// Radius of the box of what is drawn in a node.
const INNER: f64 = 12.0;
/// Distance of rows.
const ROW: f64 = 92.0;
/// Distance of nodes in a row, where there is room, and the least distance.
const COLUMNS: [f64; 2] = [110.0, 44.0];
/// Width up to which nodes of a row keep the first of these distances.
const WIDTH: f64 = 900.0;
/// Distance of the middles of arrows between the same nodes.
const FAN: f64 = 13.0;
/// Largest number of arrows between two nodes; more of them are one arrow with their number.
const MAX_ARROWS: usize = 6;
/// Length of the head of an arrow.
const HEAD: f64 = 7.0;
/// Limits of the number of nodes, of arrows and of steps.
const MAX_NODES: usize = 400;
const MAX_EDGES: usize = 4_000;

/// Topology of an instancing graph.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Topology {
    /// Objects that instance each other, or themselves.
    #[default]
    Cyclic,
    /// Objects by the number of steps that remain, which instance those of the level below.
    Levels,
    /// A node for each instance.
    Tree,
}

impl Named for Topology {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("cyclic", Self::Cyclic),
        ("levels", Self::Levels),
        ("tree", Self::Tree),
    ];
}

/// Frames of graphs that have figures.
pub(super) trait GraphFrame: Frame {
    /// Direction of view.
    type View: Copy;

    /// Returns what is seen of an outline.
    fn seen(outline: &Self::Outline, view: Self::View) -> (Vec<Outline>, bool);
}

impl GraphFrame for Frame2 {
    type View = ();

    fn seen(element: &Self::Outline, (): ()) -> (Vec<Outline>, bool) {
        (vec![outline(element)], element.is_closed())
    }
}

impl GraphFrame for Frame3 {
    type View = DMat3;

    fn seen(solid: &Self::Outline, view: DMat3) -> (Vec<Outline>, bool) {
        let (outline, edges, _) = space::seen(solid, &DAffine3::from_mat3(view));
        let closed = outline.closed;
        (std::iter::once(outline).chain(edges).collect(), closed)
    }
}

/// Lays out the graph of a model, for so many steps, under a title.
pub(super) fn page<F: GraphFrame>(
    graph: &Graph<F>,
    topology: Topology,
    steps: u32,
    view: F::View,
    title: &str,
) -> Block {
    let font = Font::new();
    let net = Net::of(graph, topology, steps);
    let heading = match topology {
        Topology::Cyclic => "instancing graph",
        Topology::Levels => "instancing graph by levels",
        Topology::Tree => "instancing tree",
    };
    let drawn = net.draw(graph, view, &font);
    let notes = net.notes(graph);
    lay_out(
        &font,
        vec![(heading, drawn)],
        [title, ""],
        |_| Block::default(),
        &notes,
    )
}

/// Subject of a node.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Subject {
    Start,
    /// An object, with the number of steps that remain if they count.
    Object(usize, Option<u32>),
}

/// A node in its row.
struct GraphNode {
    subject: Subject,
    row: usize,
    /// Position across, in pixels from the middle.
    x: f64,
    /// Whether the object is replaced here.
    is_replaced: bool,
    /// Whether it is drawn at random what replaces it.
    is_drawn: bool,
}

/// Arrows between two nodes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Link {
    from: usize,
    to: usize,
    seeds: bool,
}

/// Nodes and arrows of a figure.
struct Net {
    nodes: Vec<GraphNode>,
    links: BTreeMap<Link, usize>,
    /// Whether nodes or arrows are left out.
    is_cut: bool,
}

impl Net {
    fn of<F: Frame>(graph: &Graph<F>, topology: Topology, steps: u32) -> Self {
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

    fn draw<F: GraphFrame>(&self, graph: &Graph<F>, view: F::View, font: &Font) -> Block {
        let mut block = Block::default();
        for (link, count) in &self.links {
            self.arrows(*link, *count, &mut block);
        }
        for node in &self.nodes {
            self.node(node, graph, view, font, &mut block);
        }
        framed(block, font)
    }

    fn arrows(&self, link: Link, count: usize, block: &mut Block) {
        let [from, to] = [link.from, link.to].map(|number| &self.nodes[number]);
        let opposite = Link {
            from: link.to,
            to: link.from,
            ..link
        };
        let is_both = link.from != link.to && self.links.contains_key(&opposite);
        let drawn = if count > MAX_ARROWS { 1 } else { count };
        let paint = paint_of(link.seeds, from.is_drawn);
        for number in 0..drawn {
            #[expect(clippy::cast_precision_loss, reason = "there are few arrows")]
            let (number, drawn) = (number as f64, drawn as f64);
            let curve = if link.from == link.to {
                loop_of(from.centre(), number)
            } else {
                // Arrows to the same row or upwards, and those with arrows back, keep to one side.
                let aside = if from.row >= to.row || is_both {
                    30.0
                } else {
                    0.0
                };
                let bend = aside + (number - (drawn - 1.0) / 2.0) * FAN;
                curve_between([from, to], bend)
            };
            let middle = at_middle(&curve);
            let [_, _, before, end] = curve;
            let way = (end - before).normalize_or_zero();
            let neck = end - way * HEAD;
            let shaft = Outline {
                start: curve[0],
                pieces: vec![Piece::Cubic(curve[1], curve[2], neck)],
                closed: false,
            };
            block.items.push(BlockItem::Path(vec![shaft], paint, None));
            let side = way.perp() * HEAD * 0.38;
            let head = Outline {
                start: end,
                pieces: [neck + side, neck - side, end].map(Piece::Line).into(),
                closed: true,
            };
            let colour = paint.stroke.map(|stroke| stroke.colour);
            let filled = Paint {
                fill: colour,
                stroke: None,
                has_holes: false,
            };
            let label = Some("instance");
            block.items.push(BlockItem::Path(vec![head], filled, label));
            if count > MAX_ARROWS {
                let text = format!("×{count}");
                let at = middle + DVec2::new(6.0, 4.0);
                block
                    .items
                    .push(BlockItem::Text(text, SMALL, at, super::LABEL));
            }
        }
    }

    fn node<F: GraphFrame>(
        &self,
        node: &GraphNode,
        graph: &Graph<F>,
        view: F::View,
        font: &Font,
        block: &mut Block,
    ) {
        let centre = node.centre();
        let Subject::Object(number, _) = node.subject else {
            let name = "initiator";
            let at = centre - DVec2::new(font.width(name, WORDS) / 2.0, 8.0);
            block
                .items
                .push(BlockItem::Text(name.into(), WORDS, at, super::LABEL));
            let dot = Outline::circle(centre, 4.0);
            let paint = Paint {
                fill: Some(ElementRole::Fertile.colour()),
                stroke: None,
                has_holes: false,
            };
            block.items.push(BlockItem::Path(vec![dot], paint, None));
            return;
        };
        let object = &graph.objects()[number];
        let role = ElementRole::of(node.is_replaced, false);
        let ring = Outline::circle(centre, RADIUS);
        let label = Some("object");
        block
            .items
            .push(BlockItem::Path(vec![ring], role.element(true), label));
        if object.visible {
            let (outlines, closed) = F::seen(&graph.base_elements()[object.base_element], view);
            let mut bounds = Bounds::EMPTY;
            for [from, to] in outlines.iter().flat_map(flattened) {
                bounds.add(from);
                bounds.add(to);
            }
            let size = bounds.size().max_element();
            if size > 0.0 && size.is_finite() {
                let map = DAffine2::from_translation(centre)
                    * DAffine2::from_scale(DVec2::new(1.0, -1.0) * 2.0 * INNER / size)
                    * DAffine2::from_translation(-bounds.centre());
                let drawn = outlines.iter().map(|it| it.transformed(&map)).collect();
                block
                    .items
                    .push(BlockItem::Path(drawn, role.outline(closed), None));
            }
        }
        if self.has_numbers() {
            let name = (number + 1).to_string();
            let left = -RADIUS * 0.75 - font.width(&name, SMALL);
            let at = centre + DVec2::new(left, RADIUS + 7.0);
            block
                .items
                .push(BlockItem::Text(name, SMALL, at, super::LABEL));
        }
    }

    /// Returns whether there are several objects, which have numbers.
    fn has_numbers(&self) -> bool {
        let objects = self.nodes.iter().filter_map(|node| match node.subject {
            Subject::Object(number, _) => Some(number),
            Subject::Start => None,
        });
        objects.collect::<BTreeSet<_>>().len() > 1
    }

    fn notes<F: Frame>(&self, graph: &Graph<F>) -> Vec<String> {
        let mut notes = vec![
            "A circle is an object: what it draws, and the union of the instances to which arrows lead, each with a map of its own."
                .to_owned(),
        ];
        if self
            .nodes
            .iter()
            .any(|node| matches!(node.subject, Subject::Object(..)) && !node.is_replaced)
        {
            notes.push("Grey objects are not replaced.".into());
        }
        if self.links.keys().any(|link| link.seeds) {
            notes.push("Orange arrows lead to new fractals.".into());
        }
        if self.nodes.iter().any(|node| node.is_drawn) {
            notes.push("Dashed arrows belong to one or another generator, which is chosen for each element.".into());
        }
        if self.is_cut {
            notes.push(format!(
                "There are more objects, of {}.",
                graph.objects().len()
            ));
        }
        notes
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

    fn centre(&self) -> DVec2 {
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

/// Returns the line of arrows.
fn paint_of(seeds: bool, is_drawn: bool) -> Paint {
    let role = if seeds {
        ElementRole::Seed
    } else {
        ElementRole::Fertile
    };
    let pen = Pen {
        width: 1.2,
        dash: if is_drawn { 4.0 } else { 0.0 },
        ..ink::PEN
    };
    let mut paint = role.element(true);
    if let Some(stroke) = &mut paint.stroke {
        stroke.pen = pen;
    }
    paint
}

/// Returns the curve of an arrow from the border of one node to that of another, whose middle is beside the straight line.
fn curve_between(ends: [&GraphNode; 2], bend: f64) -> [DVec2; 4] {
    let [from, to] = ends.map(GraphNode::centre);
    let way = to - from;
    let side = way.normalize_or_zero().perp() * bend * 4.0 / 3.0;
    let (a, b) = (from + way / 3.0 + side, from + way * (2.0 / 3.0) + side);
    let border = match ends[0].subject {
        Subject::Start => 5.0,
        Subject::Object(..) => RADIUS + 1.0,
    };
    let start = from + (a - from).normalize_or_zero() * border;
    let end = to + (b - to).normalize_or_zero() * (RADIUS + 3.0);
    [start, a, b, end]
}

/// Returns the curve of an arrow from a node to itself, on its right side.
fn loop_of(centre: DVec2, number: f64) -> [DVec2; 4] {
    let reach = 34.0 + 12.0 * number;
    let rise = 10.0 + 4.0 * number;
    let at = |x: f64, y: f64| centre + DVec2::new(x, y);
    let start = at(RADIUS * 0.94, -RADIUS * 0.4);
    let end = at(RADIUS * 1.02, RADIUS * 0.44);
    [
        start,
        at(RADIUS + reach, -rise - 12.0),
        at(RADIUS + reach, rise + 12.0),
        end,
    ]
}

/// Returns the point of a curve at half of its parameter.
fn at_middle([a, b, c, d]: &[DVec2; 4]) -> DVec2 {
    (*a + *d) / 8.0 + (*b + *c) * (3.0 / 8.0)
}

/// Moves what is drawn into a block of its size.
fn framed(block: Block, font: &Font) -> Block {
    const PAD: f64 = 6.0;
    let mut bounds = Bounds::EMPTY;
    for item in &block.items {
        match item {
            BlockItem::Path(outlines, ..) => {
                for [from, to] in outlines.iter().flat_map(flattened) {
                    bounds.add(from);
                    bounds.add(to);
                }
            }
            BlockItem::Text(text, size, at, _) => {
                bounds.add(*at + DVec2::new(0.0, -size));
                bounds.add(*at + DVec2::new(font.width(text, *size), 0.3 * size));
            }
        }
    }
    if bounds.is_empty() {
        return Block::default();
    }
    let mut whole = Block::default();
    let size = bounds.size() + 2.0 * PAD;
    whole.put(block, DVec2::splat(PAD) - bounds.min());
    whole.size = size.ceil();
    whole
}
