//! Descent of a graph into the depth buffer of a tile: nearest first, and nothing that is hidden.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::geometry::{DAffine3, DVec3};
use crate::instancing::Appearance;

use super::buffer::{Buffer, SIDE};
use super::copies::Copies;
use super::forms::{Form, class};
use super::gathered::Gathered;
use super::lit::{Classes, FINE, intensity};
use super::roots::Roots;
use super::scene::{ClassBy, ends};
use super::solid::{Body, Pencil, View};
use super::stamp::{Placed, Stamp, WHOLE};
use super::tints::Tints;

/// Samples along a side from which instances are visited from near to far, one by one.
const LARGE: usize = SIDE / 2;

/// Number of instances that wait, or of their forms, from which the others of a tile are not visited one by one.
const MAX_LARGE: usize = 1 << 14;

/// Properties on which the colour of an instance depends.
#[derive(Clone, Copy, Default)]
pub(super) struct Paint {
    pub(super) class: u16,
    /// Number of its appearance, where colours are by tints.
    pub(super) appearance: u32,
}

/// An instance that may be seen on the tile.
#[derive(Clone, Copy)]
struct Node {
    /// Middle of the box around the subtree.
    at: DVec3,
    /// Number of its form; those of the descent follow the known ones.
    form: usize,
    paint: Paint,
    /// Depth of its nearest point.
    nearest: u32,
    /// The samples of the tile that it may meet.
    rectangle: [usize; 4],
    /// Forms and appearances up to those of its siblings.
    known: Known,
}

/// Numbers of the forms and of the appearances that a descent knows.
#[derive(Clone, Copy, Default)]
struct Known {
    forms: usize,
    appearances: usize,
}

impl Node {
    /// Returns whether the instance may meet a large part of the tile.
    fn is_large(&self) -> bool {
        let [left, top, right, bottom] = self.rectangle;
        (right - left).max(bottom - top) >= LARGE
    }
}

/// A node in a queue, from which the nearest is taken first.
struct Nearest(Node);

impl PartialEq for Nearest {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Nearest {}

impl PartialOrd for Nearest {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Nearest {
    fn cmp(&self, other: &Self) -> Ordering {
        let place = |node: &Self| node.0.at.to_array();
        let by_place = place(other).into_iter().zip(place(self));
        // The order of those that are equally near does not depend on the tile.
        let by_place = by_place.map(|(other, own)| other.total_cmp(&own));
        { other.0.nearest.cmp(&self.0.nearest) }
            .then_with(|| by_place.fold(Ordering::Equal, Ordering::then))
    }
}

/// State of the descent into a tile; memory is reused from tile to tile.
#[derive(Default)]
pub(super) struct Descent {
    stack: Vec<Node>,
    /// Instances of the initiator and in large instances, of which the nearest is visited next.
    large: BinaryHeap<Nearest>,
    /// Forms that are not known before: those of nodes that wait or are on the stack, and of their siblings.
    own: Vec<Form>,
    /// Instances in a form that may be seen, with the z of their nearest points.
    inner: Vec<(f64, Node)>,
    pencil: Pencil,
    copies: Option<Copies>,
    pub(super) tints: Tints,
    /// Number of solids that were drawn.
    pub(super) drawn: u64,
    /// Greatest number of steps of a solid that was drawn.
    pub(super) deepest: u32,
}

impl Descent {
    /// Draws all that is seen on a tile. `start` are the instances of the initiator that may be seen there.
    pub(super) fn run(
        &mut self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        start: &[usize],
    ) {
        self.stack.clear();
        self.large.clear();
        self.own.clear();
        self.tints.clear();
        if roots.overlap {
            self.copies.get_or_insert_with(Copies::new).begin();
        }
        let forms = roots.forms;
        for step in start.iter().map(|number| &forms.start[*number]) {
            let form = &forms.known[step.form];
            let named = (step.form, form.half);
            if let Some(mut node) = node(roots, view, buffer, named, step.offset) {
                node.paint = self.paint(roots, Paint::default(), roots.tint(form), None);
                self.stack.push(node);
            }
        }
        let mut own = std::mem::take(&mut self.own);
        // Large instances overlap in depth: the nearest of all is visited next. The instances in a small one are visited
        // before any other.
        self.large.extend(self.stack.drain(..).map(Nearest));
        while let Some(Nearest(node)) = self.large.pop() {
            // Forms and appearances up to here belong to nodes that wait.
            let kept = self.known(&own);
            if node.is_large() && self.large.len().max(kept.forms) < MAX_LARGE {
                self.visit_seen(roots, view, buffer, &node, &mut own);
                self.large.extend(self.stack.drain(..).map(Nearest));
                continue;
            }
            self.stack.push(Node {
                known: kept,
                ..node
            });
            while let Some(node) = self.stack.pop() {
                // All that follow belonged to nodes that are done.
                own.truncate(node.known.forms);
                self.tints.truncate(node.known.appearances);
                let rest = self.stack.len();
                self.visit_seen(roots, view, buffer, &node, &mut own);
                let known = self.known(&own);
                { self.stack[rest..].iter_mut() }.for_each(|inner| inner.known = known);
            }
            own.truncate(kept.forms);
            self.tints.truncate(kept.appearances);
        }
        self.own = own;
    }

    fn known(&self, own: &[Form]) -> Known {
        Known {
            forms: own.len(),
            appearances: self.tints.len(),
        }
    }

    /// Visits an instance, unless it is hidden.
    fn visit_seen(
        &mut self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        node: &Node,
        own: &mut Vec<Form>,
    ) {
        if buffer.hides(node.rectangle, node.nearest) {
            return;
        }
        let known = &roots.forms.known;
        if let Some(form) = known.get(node.form) {
            self.visit_known(roots, view, buffer, form, node, own);
        } else if !self.draws_turned(roots, view, buffer, &own[node.form - known.len()], node) {
            self.visit(roots, view, buffer, node, own);
        }
    }

    fn visit_known<'a>(
        &mut self,
        roots: &Roots<'a>,
        view: &View<'_>,
        buffer: &mut Buffer,
        form: &'a Form,
        node: &Node,
        own: &mut Vec<Form>,
    ) {
        let copies = self.copies.as_mut();
        let class = node.paint.class;
        if copies.is_some_and(|copies| copies.knows(node.at, node.form, form.level, class)) {
            return;
        }
        if let Some(stamps) = &form.stamps
            && !view.cuts_through(node.at, form.half)
        {
            let seen = match stamps.are_large {
                true => buffer.open(node.rectangle, node.nearest),
                false => Some(WHOLE),
            };
            let Some(seen) = seen else {
                return;
            };
            let placed = Placed {
                form,
                number: node.form,
                at: node.at,
                paint: node.paint,
                seen,
            };
            if let Some(stamp) = Stamp::draw(roots, view, (buffer, &mut self.tints), &placed) {
                self.drawn += stamp.elements;
                self.deepest = self.deepest.max(stamp.deepest);
                return;
            }
        }
        if self.draws_turned(roots, view, buffer, form, node) {
            return;
        }
        let Some(steps) = roots.forms.steps(form) else {
            return self.visit(roots, view, buffer, node, own);
        };
        let scale = view.scale_of_box(node.at.z + form.half.z);
        if form.is_small(&roots.end, scale) {
            return self.draw(roots, view, buffer, form, node);
        }
        if let Some(gathered) = form.gathered(&roots.end, scale) {
            return self.draw_gathered(roots, view, buffer, gathered, node);
        }
        for step in steps {
            let inner = &roots.forms.known[step.form];
            let at = node.at + step.offset;
            if let Some(mut inside) = self::node(roots, view, buffer, (step.form, inner.half), at) {
                inside.paint = self.paint(roots, node.paint, roots.tint(inner), step.class);
                self.stack.push(inside);
            }
        }
    }

    /// Draws an instance as a turned stamp, if it may be one.
    fn draws_turned(
        &mut self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        form: &Form,
        node: &Node,
    ) -> bool {
        let Some(turned) = roots
            .turned
            .filter(|_| !view.cuts_through(node.at, form.half))
        else {
            return false;
        };
        let Some(stamp) = turned.draw(roots, view, buffer, (form, node.at, node.paint.class))
        else {
            return false;
        };
        self.drawn += u64::from(stamp.elements);
        self.deepest = self.deepest.max(form.level + stamp.deepest);
        true
    }

    /// Visits an instance of a form the forms in which are not known.
    fn visit(
        &mut self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        node: &Node,
        own: &mut Vec<Form>,
    ) {
        let form = form(roots, own, node.form);
        let scale = view.scale_of_box(node.at.z + form.half.z);
        if ends(roots.parts, form, &roots.end) || form.is_small(&roots.end, scale) {
            return self.draw(roots, view, buffer, form, node);
        }
        self.inner.clear();
        let level = form.level;
        for child in &roots.parts[form.object].children {
            let form = self::form(roots, own, node.form);
            let inner = form.inner(roots.parts, child);
            let at = node.at + form.offset(child, &inner);
            let number = roots.forms.known.len() + own.len();
            let Some(mut inside) = self::node(roots, view, buffer, (number, inner.half), at) else {
                continue;
            };
            let class = match (roots.class_by, level) {
                (ClassBy::LastMap, 0) => Some(class(roots.parts[child.object].origin)),
                _ => None,
            };
            inside.paint = self.paint(roots, node.paint, roots.tint(&inner), class);
            self.inner.push((at.z + inner.half.z, inside));
            own.push(inner);
        }
        // From far to near; of those that are equally near the last first.
        let order = |(a, one): &(f64, Node), (b, other): &(f64, Node)| {
            a.total_cmp(b).then(other.form.cmp(&one.form))
        };
        self.inner.sort_unstable_by(order);
        self.stack
            .extend(self.inner.drain(..).map(|(_, node)| node));
    }

    /// Returns what the colour of an instance in another depends on; `class` is its class if it has one of its own.
    fn paint(
        &mut self,
        roots: &Roots<'_>,
        outer: Paint,
        appearance: Appearance,
        class: Option<u16>,
    ) -> Paint {
        Paint {
            class: class.unwrap_or(outer.class),
            appearance: match roots.class_by {
                ClassBy::Tint => self.tints.inside(outer.appearance, appearance),
                _ => outer.appearance,
            },
        }
    }

    /// Draws an instance that is not replaced.
    fn draw(
        &mut self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        form: &Form,
        node: &Node,
    ) {
        self.draw_grown(roots, view, buffer, (form, node), 0.0);
    }

    /// Draws the forms that stand for all that is in an instance, within its box.
    fn draw_gathered(
        &mut self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        gathered: &[Gathered],
        node: &Node,
    ) {
        for own in gathered {
            let form = &roots.forms.known[own.form];
            let named = (own.form, form.half + own.reach());
            let at = node.at + own.offset();
            let Some(mut inside) = self::node(roots, view, buffer, named, at) else {
                continue;
            };
            inside.paint = self.paint(roots, node.paint, own.appearance, own.class);
            let [a, b] = [inside.rectangle, node.rectangle];
            inside.rectangle = [
                a[0].max(b[0]),
                a[1].max(b[1]),
                a[2].min(b[2]),
                a[3].min(b[3]),
            ];
            let [left, top, right, bottom] = inside.rectangle;
            if left < right && top < bottom {
                self.draw_grown(roots, view, buffer, (form, &inside), own.reach());
            }
        }
    }

    /// Draws the solid of an instance, larger by a distance.
    fn draw_grown(
        &mut self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        (form, node): (&Form, &Node),
        more: f64,
    ) {
        let Some(rectangle) = buffer.open(node.rectangle, node.nearest) else {
            return;
        };
        if let Some(solid) = roots.parts[form.object].drawn(form.level, &roots.end) {
            let map = DAffine3::from_mat3_translation(form.linear, node.at - form.middle);
            let body = Body::new(solid, &map).grown(more);
            let (pencil, tints) = (&mut self.pencil, &mut self.tints);
            let mut draw = |buffer: &mut Buffer, classes: Classes<'_>| {
                pencil.draw(buffer, view, &body, rectangle, classes);
            };
            let class = match roots.class_by {
                ClassBy::Tint => 0,
                _ => roots.class(form, node.paint.class),
            };
            match roots.lit {
                None if roots.class_by == ClassBy::Tint => {
                    tints.make_room(1, buffer);
                    let colour = tints.colour(node.paint.appearance, roots.inks[0]);
                    draw(buffer, Classes::One(tints.class(colour)));
                }
                None => draw(buffer, Classes::One(class)),
                Some(lit) => match lit.bits() {
                    Some(bits) => {
                        let (lit, of) = (&lit, &mut |level| class << bits | level);
                        draw(buffer, Classes::OfLevels { lit, bits, of });
                    }
                    None => {
                        let colour = match roots.class_by {
                            ClassBy::Tint => tints.colour(node.paint.appearance, roots.inks[0]),
                            _ => roots.inks[usize::from(class) % roots.inks.len()],
                        };
                        let is_round = solid.primitive().is_some();
                        if roots.class_by == ClassBy::Normal {
                            let mut draw = |tints: &mut Tints, most: usize, rectangle| {
                                tints.make_room(most + view.cuts.len(), buffer);
                                let mut of = |normal| {
                                    let level = lit.level(normal, FINE);
                                    let colour = lit.colour_of_normal(normal, roots.inks);
                                    tints.class(colour.dimmed(intensity(level, FINE)))
                                };
                                let classes = Classes::OfNormals(&mut of);
                                pencil.draw(buffer, view, &body, rectangle, classes);
                            };
                            if is_round {
                                // Each sample of a row may have a class of its own.
                                let [left, top, right, bottom] = rectangle;
                                for y in top..bottom {
                                    draw(tints, right - left, [left, y, right, y + 1]);
                                }
                            } else {
                                draw(tints, solid.faces().len(), rectangle);
                            }
                        } else {
                            let most = if is_round {
                                1 << FINE
                            } else {
                                solid.faces().len()
                            };
                            tints.make_room(most + view.cuts.len(), buffer);
                            let mut known = [None; 1 << FINE];
                            let mut of = |level| {
                                *known[usize::from(level)].get_or_insert_with(|| {
                                    tints.class(colour.dimmed(intensity(level, FINE)))
                                })
                            };
                            let (lit, bits, of) = (&lit, FINE, &mut of);
                            draw(buffer, Classes::OfLevels { lit, bits, of });
                        }
                    }
                },
            }
            self.drawn += 1;
            self.deepest = self.deepest.max(form.level);
        }
    }
}

/// Returns the form of a number; `own` are those that are not known before the descent.
fn form<'f>(roots: &'f Roots<'_>, own: &'f [Form], number: usize) -> &'f Form {
    let known = &roots.forms.known;
    known
        .get(number)
        .unwrap_or_else(|| &own[number - known.len()])
}

/// Returns an instance of a form, which is given by its number and the half sides of its box, if it may be seen.
fn node(
    roots: &Roots<'_>,
    view: &View<'_>,
    buffer: &Buffer,
    (form, half): (usize, DVec3),
    at: DVec3,
) -> Option<Node> {
    if view.cuts_off(at, half) {
        return None;
    }
    let near = at.z + half.z;
    let pad = roots.pad / view.scale_of_box(near);
    let rectangle = view.rectangle(at, half + pad)?;
    // One less for rounding.
    let nearest = view.depths.of(near + pad).saturating_sub(1);
    (!buffer.hides(rectangle, nearest)).then_some(Node {
        at,
        form,
        paint: Paint::default(),
        nearest,
        rectangle,
        known: Known::default(),
    })
}
