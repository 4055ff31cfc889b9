//! Descent of a graph into the depth buffer of a tile: nearest first, and nothing that is hidden.

use crate::geometry::{DAffine3, DVec3};

use super::buffer::{Buffer, MAX_CLASS};
use super::copies::Copies;
use super::forms::{Form, Forms, class};
use super::lit::{Classes, FINE, Lit, intensity};
use super::scene::{ClassBy, End, Part, ends};
use super::solid::{Pencil, View};
use super::stamp::Stamp;
use super::tints::Tints;
use super::turned::Turned;
use crate::style::Colour;

/// Properties on which the colour of an instance depends.
#[derive(Clone, Copy, Default)]
struct Paint {
    class: u16,
    /// Number of its appearance, where colours are by tints.
    appearance: u32,
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
}

/// State of the descent into a tile; memory is reused from tile to tile.
#[derive(Default)]
pub(super) struct Descent {
    stack: Vec<Node>,
    /// Forms that are not known before: those of nodes on the stack, in their order.
    own: Vec<Form>,
    /// Instances in a form, with their middles and classes.
    inner: Vec<(Form, DVec3, Paint)>,
    pencil: Pencil,
    copies: Option<Copies>,
    pub(super) tints: Tints,
    /// Number of solids that were drawn.
    pub(super) drawn: u64,
    /// Greatest number of steps of a solid that was drawn.
    pub(super) deepest: u32,
}

/// Parts of the graph into which all tiles descend.
pub(super) struct Roots<'a> {
    pub(super) parts: &'a [Part],
    pub(super) forms: &'a Forms,
    pub(super) end: End,
    pub(super) class_by: ClassBy,
    /// Light on faces.
    pub(super) lit: Option<Lit>,
    /// Colours of the classes, or of what has no tint.
    pub(super) inks: &'a [Colour],
    /// Samples by which flat solids may exceed the hulls of their objects.
    pub(super) pad: f64,
    /// Whether instances may lie in equal positions.
    pub(super) overlap: bool,
    /// Stamps of turned instances, where there are any.
    pub(super) turned: Option<&'a Turned>,
}

impl Roots<'_> {
    /// Returns the instances of the initiator that may be seen in the row of tiles of a view.
    pub(super) fn start(&self, view: &View<'_>) -> Vec<usize> {
        let may_be_seen = |number: &usize| {
            let step = &self.forms.start[*number];
            let half = self.forms.known[step.form].half;
            let pad = self.pad / view.scale_of_box(step.offset.z + half.z);
            view.has_in_row(step.offset, half + pad)
        };
        (0..self.forms.start.len()).filter(may_be_seen).collect()
    }

    /// Returns whether the classes of samples are colours that are found tile by tile.
    pub(super) fn finds_colours(&self) -> bool {
        let by_face = self.lit.is_some_and(|lit| lit.bits().is_none());
        self.class_by == ClassBy::Tint || by_face
    }

    /// Returns the class of an element; `outer` is that of the instance that contains it.
    pub(super) fn class(&self, form: &Form, outer: u16) -> u16 {
        let class = match self.class_by {
            ClassBy::Step => u16::try_from(form.level).unwrap_or(MAX_CLASS),
            ClassBy::FirstMap => class(self.parts[form.object].origin),
            ClassBy::LastMap | ClassBy::Nothing | ClassBy::Tint | ClassBy::Normal => outer,
        };
        class.min(MAX_CLASS)
    }
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
        self.own.clear();
        self.tints.clear();
        if roots.overlap {
            self.copies.get_or_insert_with(Copies::new).clear();
        }
        let forms = roots.forms;
        for step in start.iter().map(|number| &forms.start[*number]) {
            let form = &forms.known[step.form];
            let paint = self.paint(roots, Paint::default(), form.object, None);
            let form = (form, step.form);
            let node = node(roots, view, buffer, form, step.offset, paint);
            self.stack.extend(node);
        }
        while let Some(node) = self.stack.pop() {
            let known = forms.known.get(node.form);
            let own = match known {
                Some(_) => None,
                None => {
                    // The forms that follow belonged to nodes that are done.
                    self.own.truncate(node.form + 1 - forms.known.len());
                    self.own.pop()
                }
            };
            if buffer.hides(node.rectangle, node.nearest) {
                continue;
            }
            if let Some(form) = known {
                self.visit_known(roots, view, buffer, form, &node);
            } else if let Some(form) = own
                && !self.draws_turned(roots, view, buffer, &form, &node)
            {
                self.visit(roots, view, buffer, &form, &node);
            }
        }
    }

    fn visit_known<'a>(
        &mut self,
        roots: &Roots<'a>,
        view: &View<'_>,
        buffer: &mut Buffer,
        form: &'a Form,
        node: &Node,
    ) {
        let copies = self.copies.as_mut();
        let class = node.paint.class;
        if copies.is_some_and(|copies| copies.knows(node.at, node.form, form.level, class)) {
            return;
        }
        if !view.cuts_through(node.at, form.half)
            && let Some(stamp) = Stamp::draw(roots, view, buffer, (form, node.at, class))
        {
            self.drawn += stamp.elements;
            self.deepest = self.deepest.max(stamp.deepest);
            return;
        }
        if self.draws_turned(roots, view, buffer, form, node) {
            return;
        }
        let Some(steps) = roots.forms.steps(form) else {
            return self.visit(roots, view, buffer, form, node);
        };
        if form.is_small(&roots.end, view.scale_of_box(node.at.z + form.half.z)) {
            return self.draw(roots, view, buffer, form, node);
        }
        for step in steps {
            let inner = &roots.forms.known[step.form];
            let paint = self.paint(roots, node.paint, inner.object, step.class);
            let at = node.at + step.offset;
            let inner = (inner, step.form);
            self.stack
                .extend(self::node(roots, view, buffer, inner, at, paint));
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
        self.drawn += stamp.elements;
        self.deepest = self.deepest.max(form.level + stamp.deepest);
        true
    }

    /// Visits an instance of a form the forms in which are not known.
    fn visit(
        &mut self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        form: &Form,
        node: &Node,
    ) {
        let scale = view.scale_of_box(node.at.z + form.half.z);
        if ends(roots.parts, form, &roots.end) || form.is_small(&roots.end, scale) {
            return self.draw(roots, view, buffer, form, node);
        }
        self.inner.clear();
        for child in &roots.parts[form.object].children {
            let inner = form.inner(roots.parts, child);
            let at = node.at + form.offset(child, &inner);
            let class = match (roots.class_by, form.level) {
                (ClassBy::LastMap, 0) => Some(class(roots.parts[child.object].origin)),
                _ => None,
            };
            let paint = self.paint(roots, node.paint, child.object, class);
            self.inner.push((inner, at, paint));
        }
        self.inner.reverse();
        let near = |(form, at, _): &(Form, DVec3, Paint)| at.z + form.half.z;
        self.inner.sort_by(|a, b| near(a).total_cmp(&near(b)));
        for (form, at, paint) in self.inner.drain(..) {
            let number = roots.forms.known.len() + self.own.len();
            if let Some(node) = self::node(roots, view, buffer, (&form, number), at, paint) {
                self.stack.push(node);
                self.own.push(form);
            }
        }
    }

    /// Returns what the colour of an instance of an object in another depends on; `class` is its class if it has
    /// one of its own.
    fn paint(
        &mut self,
        roots: &Roots<'_>,
        outer: Paint,
        object: usize,
        class: Option<u16>,
    ) -> Paint {
        Paint {
            class: class.unwrap_or(outer.class),
            appearance: match roots.class_by {
                ClassBy::Tint => self
                    .tints
                    .inside(outer.appearance, roots.parts[object].appearance),
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
        let Some(rectangle) = buffer.open(node.rectangle, node.nearest) else {
            return;
        };
        if let Some(solid) = roots.parts[form.object].drawn(form.level, &roots.end) {
            let map = DAffine3::from_mat3_translation(form.linear, node.at - form.middle);
            let (pencil, tints) = (&mut self.pencil, &mut self.tints);
            let mut draw = |buffer: &mut Buffer, classes: Classes<'_>| {
                pencil.draw(buffer, view, solid, &map, rectangle, classes);
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
                        let faces = match solid.primitive() {
                            Some(_) => 1 << FINE,
                            None => solid.faces().len(),
                        };
                        tints.make_room(faces + view.cuts.len(), buffer);
                        if roots.class_by == ClassBy::Normal {
                            let mut of = |normal| {
                                let level = lit.level(normal, FINE);
                                let colour = lit.colour_of_normal(normal, roots.inks);
                                tints.class(colour.dimmed(intensity(level, FINE)))
                            };
                            draw(buffer, Classes::OfNormals(&mut of));
                        } else {
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

/// Returns an instance of a form, which is given with its number, if it may be seen.
fn node(
    roots: &Roots<'_>,
    view: &View<'_>,
    buffer: &Buffer,
    (form, number): (&Form, usize),
    at: DVec3,
    paint: Paint,
) -> Option<Node> {
    if view.cuts_off(at, form.half) {
        return None;
    }
    let near = at.z + form.half.z;
    let pad = roots.pad / view.scale_of_box(near);
    let rectangle = view.rectangle(at, form.half + pad)?;
    // One less for rounding.
    let nearest = view.depths.of(near + pad).saturating_sub(1);
    (!buffer.hides(rectangle, nearest)).then_some(Node {
        at,
        form: number,
        paint,
        nearest,
        rectangle,
    })
}
