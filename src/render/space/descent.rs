//! Descent of a graph into the depth buffer of a tile: nearest first, and nothing that is hidden.

use crate::geometry::DAffine3;

use super::buffer::{Buffer, MAX_CLASS};
use super::copies::Copies;
use super::scene::{Child, ClassBy, End, Part};
use super::solid::{Pencil, View};

/// Relative tolerance of lengths: a cell of exactly a pixel is not replaced.
const ROUNDING: f64 = 1e-9;

/// An instance that may be seen on the tile.
struct Node {
    map: DAffine3,
    object: usize,
    level: u32,
    /// Upper bound of the stretch of the map, in samples.
    length: f64,
    class: u16,
    /// Whether it is too small to be replaced.
    is_small: bool,
    /// Depth of its nearest point.
    nearest: u32,
    near: f64,
    /// The samples of the tile that it may meet.
    rectangle: [usize; 4],
}

/// State of the descent into a tile; memory is reused from tile to tile.
#[derive(Default)]
pub(super) struct Descent {
    stack: Vec<Node>,
    pencil: Pencil,
    copies: Option<Copies>,
    /// Number of solids that were drawn.
    pub(super) drawn: u64,
    /// Greatest number of steps of a solid that was drawn.
    pub(super) deepest: u32,
}

/// Parts of the graph into which all tiles descend.
pub(super) struct Roots<'a> {
    pub(super) parts: &'a [Part],
    /// The instances of the initiator, in the coordinates of the projection, with their lengths in units.
    pub(super) start: &'a [Child],
    pub(super) end: End,
    pub(super) class_by: ClassBy,
    /// Length of an element whose frame is the unit frame.
    pub(super) unit: f64,
    /// Samples by which flat solids may exceed the hulls of their objects.
    pub(super) pad: f64,
    /// Whether instances may lie in equal positions.
    pub(super) overlap: bool,
}

impl Descent {
    /// Draws all that is seen on a tile.
    pub(super) fn run(&mut self, roots: &Roots<'_>, view: &View<'_>, buffer: &mut Buffer) {
        self.stack.clear();
        if roots.overlap {
            self.copies.get_or_insert_with(Copies::new).clear();
        }
        for child in roots.start {
            let node = self.node(
                roots,
                view,
                buffer,
                child.map,
                (child.object, 0, child.length, 0),
            );
            self.stack.extend(node);
        }
        self.sort_from(0);
        while let Some(node) = self.stack.pop() {
            if buffer.hides(node.rectangle, node.nearest) {
                continue;
            }
            let part = &roots.parts[node.object];
            let kind = match roots.class_by {
                ClassBy::FirstMap => node.object,
                _ => part.kind,
            };
            let is_known = self
                .copies
                .as_mut()
                .is_some_and(|copies| copies.knows(&node.map, kind, node.level, node.class));
            if is_known {
                continue;
            }
            if !part.is_replaced || node.is_small || node.level == roots.end.steps {
                if let Some(solid) = &part.solid {
                    let class = match roots.class_by {
                        ClassBy::Step => u16::try_from(node.level).unwrap_or(MAX_CLASS),
                        ClassBy::FirstMap => class(part.origin),
                        _ => node.class,
                    };
                    let class = class.min(MAX_CLASS);
                    self.pencil
                        .draw(buffer, view, solid, &node.map, node.rectangle, class);
                    self.drawn += 1;
                    self.deepest = self.deepest.max(node.level);
                }
                continue;
            }
            let first = self.stack.len();
            for child in &part.children {
                let of_child = match (roots.class_by, node.level) {
                    (ClassBy::LastMap, 0) => class(roots.parts[child.object].origin),
                    _ => node.class,
                };
                let length = node.length * child.length;
                let placed = (child.object, node.level + 1, length, of_child);
                let node = self.node(roots, view, buffer, node.map * child.map, placed);
                self.stack.extend(node);
            }
            self.sort_from(first);
        }
    }

    /// Returns an instance, if it may be seen.
    fn node(
        &self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &Buffer,
        map: DAffine3,
        (object, level, length, class): (usize, u32, f64, u16),
    ) -> Option<Node> {
        let (middle, half) = roots.parts[object].hull.image(&map);
        for (normal, distance) in view.cuts {
            // All of it lies beyond the cut.
            if normal.dot(middle) - normal.abs().dot(half) > *distance {
                return None;
            }
        }
        let near = middle.z + half.z;
        let half = half + roots.pad / view.scale_of_box(near);
        let near = middle.z + half.z;
        let rectangle = view.rectangle(middle, half)?;
        // One less for rounding.
        let nearest = view.depths.of(near).saturating_sub(1);
        if buffer.hides(rectangle, nearest) {
            return None;
        }
        let scale = view.scale_of_box(near);
        let across = 2.0 * half.x.max(half.y) * scale;
        let longest = length * roots.unit * scale;
        Some(Node {
            map,
            object,
            level,
            length,
            class,
            is_small: across.min(longest) <= roots.end.detail * (1.0 + ROUNDING),
            nearest,
            near,
            rectangle,
        })
    }

    /// Sorts the nodes from a place on: the nearest last; of those that are equally near, the first.
    fn sort_from(&mut self, first: usize) {
        let nodes = &mut self.stack[first..];
        nodes.reverse();
        nodes.sort_by(|a, b| a.near.total_cmp(&b.near));
    }
}

/// Returns the class of a map.
fn class(map: Option<usize>) -> u16 {
    map.map_or(0, |map| u16::try_from(map).unwrap_or(MAX_CLASS))
}
