//! Figures of instancing graphs (Hart 1992, figures 1 to 3, right): objects as circles, instances as arrows.
//!
//! The graph of a limit set is cyclic, that of an approximant has a level for each step, and the tree of an approximant has a node
//! for each element.

mod net;

use crate::geometry::{Bounds, DAffine2, DAffine3, DMat3, DVec2, Frame, Frame2, Frame3};
use crate::graph::Graph;
use crate::render::{Paint, Pen};
use crate::rule::Piece;
use crate::style::Named;

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::ink::{self, ElementRole};
use super::lines::{bounds_of, outline};
use super::page::{SMALL, WORDS, lay_out};
use super::space;
use net::{GraphNode, Link, Net, Subject};

/// Radius of a node, in pixels.
const RADIUS: f64 = 19.0;
/// Radius of the box of what is drawn in a node.
const INNER: f64 = 12.0;
/// Distance of the middles of arrows between the same nodes.
const FAN: f64 = 13.0;
/// Largest number of arrows between two nodes; more of them are one arrow with their number.
const MAX_ARROWS: usize = 6;
/// Length of the head of an arrow.
const HEAD: f64 = 7.0;

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

impl Net {
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
                let aside = if !from.is_above(to) || is_both {
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
            let label = Some("instance");
            let filled = ink::filled(role_of(link.seeds).colour());
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
            let paint = ink::filled(ElementRole::Fertile.colour());
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
            let bounds = bounds_of(&outlines);
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

/// Returns the role of the elements to which arrows lead.
fn role_of(seeds: bool) -> ElementRole {
    ElementRole::of(true, seeds)
}

/// Returns the line of arrows.
fn paint_of(seeds: bool, is_drawn: bool) -> Paint {
    let pen = Pen {
        width: 1.2,
        dash: if is_drawn { 4.0 } else { 0.0 },
        ..ink::PEN
    };
    let mut paint = role_of(seeds).element(true);
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
            BlockItem::Path(outlines, ..) => bounds.add_all(&bounds_of(outlines)),
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
