//! From the initiator down to the roots of a window.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use crate::geometry::{DAffine2, DVec2, Frame};
use crate::graph::{Chain, Graph, Instance, Production, Replacement, Root};
use crate::grow::{Evaluator, Moment, Standing};
use crate::rule::BaseElement;

use super::clip::{self, Path};
use super::constants::{Constants, Parent};
use super::fixed::{Fixed, Vector};
use super::{GRAIN, Growth, SPARE, Window, Zoom, ZoomError, merge};

/// Roots are no larger than this, in pixels.
const LARGEST: f64 = (1 << 20) as f64;

/// No more instances than this are carried along.
const MOST_INSTANCES: usize = 20_000;

/// Products of words, all in all.
const MOST_WORK: u64 = 400_000_000_000;

/// Where doubles are used to leave something out, they are this much in doubt.
const DOUBT: f64 = 1e-9;

/// An instance that may show in the window.
#[derive(Clone)]
pub(super) struct Node {
    pub(super) standing: Standing,
    pub(super) object: usize,
    pub(super) level: u32,
    /// Its map, in parts of a pixel from the middle of the window.
    pub(super) map: Fixed,
    /// Whether it joins the one before it.
    pub(super) joined: bool,
}

/// What has come of it.
pub(super) enum Item {
    /// Nothing yet.
    Node(Box<Node>),
    Root(Box<Found>),
}

/// A root.
pub(super) struct Found {
    object: usize,
    frame: Frame,
    root: Root,
    pub(super) joined: bool,
    drawn: Drawn,
}

/// What is drawn of a root.
enum Drawn {
    /// What comes of its object.
    Object,
    /// This, in its frame.
    Clipped(BaseElement),
    /// A way around the window, in pixels.
    Around(Path),
}

impl Found {
    fn of(node: &Node, frame: Frame, joined: bool, drawn: Drawn) -> Self {
        let Standing {
            path, length, coat, ..
        } = node.standing;
        Self {
            object: node.object,
            frame,
            root: Root {
                level: node.level,
                path,
                length,
                coat,
            },
            joined,
            drawn,
        }
    }
}

/// What a node is in the window.
enum Look {
    Outside,
    Small(DAffine2),
    Large,
}

pub(super) struct Descent<'a, 'c> {
    graph: &'a Graph,
    growth: &'a Growth<'a>,
    window: &'a Window,
    reaches: &'a [f64],
    constants: &'c mut Constants<'a>,
    /// Half of what is seen, in pixels.
    half: DVec2,
    items: Vec<Item>,
    evaluator: Evaluator,
    work: u64,
}

impl<'a, 'c> Descent<'a, 'c> {
    pub(super) fn new(
        graph: &'a Graph,
        growth: &'a Growth<'a>,
        window: &'a Window,
        reaches: &'a [f64],
        constants: &'c mut Constants<'a>,
    ) -> Self {
        let [width, height] = window.size.map(f64::from);
        Self {
            graph,
            growth,
            window,
            reaches,
            constants,
            half: DVec2::new(width, height) / 2.0 + window.margin,
            items: Vec::new(),
            evaluator: Evaluator::default(),
            work: 0,
        }
    }

    /// Goes down until all that shows in the window is a root.
    pub(super) fn run(&mut self, centre: &Vector) -> Result<(), ZoomError> {
        let bits = self.constants.bits();
        let scale = self.window.factor.times(self.window.scale, GRAIN);
        let whole = Standing::whole(self.growth.seed);
        let scaled = |[x, y]: &Vector| [x, y].map(|it| (it * &scale) >> bits);
        for instance in &self.graph.initiator(0).instances {
            let map = self.constants.root(instance);
            let [x, y] = &map.origin;
            let map = Fixed {
                axes: [scaled(&map.axes[0]), scaled(&map.axes[1])],
                origin: scaled(&[x - &centre[0], y - &centre[1]]),
            };
            self.items.push(Item::Node(Box::new(Node {
                standing: whole.root(self.graph, instance),
                object: instance.object,
                level: 0,
                map,
                joined: instance.joined && (self.window.areas || !self.items.is_empty()),
            })));
        }
        for round in 0.. {
            check(self.growth, round)?;
            let is_done = |item: &Item| matches!(item, Item::Root(_));
            if self.items.iter().all(is_done) {
                break;
            }
            self.go_down()?;
            // Draws and tints tell apart what stands in one place, and areas need all of their chain.
            if !self.graph.draws() && !self.graph.tints() && !self.window.areas {
                merge::merge(&mut self.items);
            }
            if self.items.len() > MOST_INSTANCES {
                return Err(ZoomError::TooMany {
                    limit: MOST_INSTANCES,
                });
            }
        }
        Ok(())
    }

    /// Replaces all that is no root, once.
    fn go_down(&mut self) -> Result<(), ZoomError> {
        let items = std::mem::take(&mut self.items);
        // Whether what comes next can go on where what came before has ended.
        let mut pen = self.window.areas;
        for item in items {
            let node = match item {
                Item::Root(mut found) => {
                    found.joined &= pen;
                    pen = true;
                    self.add(*found);
                    continue;
                }
                Item::Node(node) => node,
            };
            pen &= node.joined;
            match self.look(&node) {
                Look::Outside if self.window.areas => {
                    self.lead_around(&node, pen);
                    pen = true;
                }
                Look::Outside => pen = false,
                Look::Small(map) => {
                    let frame = Frame {
                        map,
                        direction: node.standing.frame.direction,
                    };
                    self.add(Found::of(&node, frame, pen, Drawn::Object));
                    pen = true;
                }
                Look::Large if self.stays(&node) => {
                    self.add_clipped(&node, pen);
                    pen = self.window.areas;
                }
                Look::Large => pen = self.replace(&node, pen)?,
            }
        }
        Ok(())
    }

    fn stays(&self, node: &Node) -> bool {
        let object = &self.graph.objects()[node.object];
        matches!(object.replacement, Replacement::Kept) || self.growth.steps == Some(node.level)
    }

    /// Adds a root; ways around the window that follow each other are one.
    fn add(&mut self, found: Found) {
        if let (Some(Item::Root(last)), Drawn::Around(next), true) =
            (self.items.last_mut(), &found.drawn, found.joined)
            && let Drawn::Around(path) = &mut last.drawn
        {
            path.append(next);
            return;
        }
        self.items.push(Item::Root(Box::new(found)));
    }

    /// Adds what is seen of an element that stays as it is.
    fn add_clipped(&mut self, node: &Node, pen: bool) {
        let object = &self.graph.objects()[node.object];
        let areas = self.window.areas;
        let outline = &self.graph.base_elements()[object.base_element];
        let (bits, radius) = (self.constants.bits(), self.half.length());
        let clipped = object
            .visible
            .then(|| clip::clipped(outline, &node.map, bits, radius));
        match clipped.flatten() {
            Some(clip::Clipped { frame, outline }) => {
                self.add(Found::of(
                    node,
                    frame,
                    areas && pen,
                    Drawn::Clipped(outline),
                ));
            }
            None if areas => self.lead_around(node, pen),
            None => {}
        }
    }

    /// Adds a way from the start of an element that is not seen to its end.
    fn lead_around(&mut self, node: &Node, pen: bool) {
        let Fixed { axes, origin } = &node.map;
        let end = [&origin[0] + &axes[0][0], &origin[1] + &axes[0][1]];
        let mut ends = [origin.clone(), end];
        if node.standing.frame.direction.is_reversed() {
            ends.reverse();
        }
        let mut path = Path::new(&ends[0], self.half.length());
        path.add(ends.to_vec());
        self.add(Found::of(node, Frame::UNIT, pen, Drawn::Around(path)));
    }

    fn look(&self, node: &Node) -> Look {
        let (map, exponent) = node.map.near();
        if self.is_outside(&map, exponent, node.object, doubt(&map)) {
            return Look::Outside;
        }
        let pixel = pixel(exponent);
        let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis].map(|axis| axis.length() * pixel);
        if x.max(y) * self.reaches[node.object] <= self.largest() {
            return Look::Small(scaled(&map, pixel));
        }
        Look::Large
    }

    /// How large roots are at most, in pixels. Where ways lead around the window, they must come to the
    /// very ends of the roots.
    fn largest(&self) -> f64 {
        if self.window.areas {
            self.half.length()
        } else {
            LARGEST
        }
    }

    /// Whether all that becomes of an object lies outside the window, whose map is known in multiples
    /// of 2^`exponent` parts of a pixel, give or take `doubt` of them.
    fn is_outside(&self, map: &DAffine2, exponent: usize, object: usize, doubt: f64) -> bool {
        let middle = map.transform_point2(self.graph.middle());
        let half = self.half / pixel(exponent);
        let nearest = middle.clamp(-half, half);
        let frame = Frame {
            map: *map,
            ..Frame::UNIT
        };
        let reach = self.reaches[object] * frame.stretch();
        middle.distance(nearest) > reach * (1.0 + DOUBT) + doubt
    }

    /// Puts what replaces a node into its place; tells whether what comes next can go on there.
    fn replace(&mut self, node: &Node, mut pen: bool) -> Result<bool, ZoomError> {
        let moment = Moment {
            born: 0,
            level: node.level,
            rank: 0,
        };
        let production = match &self.graph.objects()[node.object].replacement {
            Replacement::Fixed(production) => Arc::clone(production),
            Replacement::Evaluated(_) => {
                let mut made = Production::default();
                let evaluator = &mut self.evaluator;
                evaluator.evaluate(self.graph, &node.standing, node.object, moment, &mut made)?;
                Arc::new(made)
            }
            Replacement::Kept | Replacement::Beyond => {
                return Err(ZoomError::TooShallow { depth: node.level });
            }
        };
        let Chain {
            instances,
            meets_frame,
        } = &production.body;
        let reversed = node.standing.frame.direction.is_reversed();
        let [mut first, mut end] = *meets_frame;
        if reversed {
            (first, end) = (end, first);
        }
        let (map, exponent) = node.map.near();
        // Doubles subtract here what may be much larger than what is left.
        let doubt = doubt(&map);
        let is_seen = |instance: &&Instance| {
            let child = map * instance.frame.map;
            self.window.areas || !self.is_outside(&child, exponent, instance.object, doubt)
        };
        let seen: Vec<&Instance> = instances.iter().filter(is_seen).collect();
        let parent = Parent {
            standing: &node.standing,
            object: node.object,
            moment,
            bits: node.map.bits() + SPARE,
        };
        let maps = self.constants.children(parent, &seen);
        let mut made = seen.into_iter().zip(maps).peekable();
        let mut children: Vec<Option<Node>> = Vec::with_capacity(instances.len());
        let bits = self.constants.bits();
        let are_similar = !self.graph.is_affine();
        for instance in instances {
            let next = made.next_if(|(next, _)| std::ptr::eq(*next, instance));
            children.push(next.map(|(_, map)| Node {
                standing: node.standing.child(self.graph, instance),
                object: instance.object,
                level: node.level + 1,
                map: node.map.after(&map, bits, are_similar),
                joined: true,
            }));
        }
        self.spend(&node.map, children.iter().flatten().count())?;
        pen &= first;
        let count = children.len();
        for turn in 0..count {
            let listed = if reversed { count - 1 - turn } else { turn };
            if turn > 0 {
                let link = if reversed { listed + 1 } else { listed };
                pen &= instances[link].joined;
            }
            match children[listed].take() {
                Some(mut child) => {
                    child.joined = pen;
                    self.items.push(Item::Node(Box::new(child)));
                    pen = true;
                }
                None => pen = false,
            }
        }
        Ok(pen && end && count > 0)
    }

    /// Counts products of long numbers.
    fn spend(&mut self, map: &Fixed, children: usize) -> Result<(), ZoomError> {
        let words = (map.bits() / 64 + 8) as u64;
        self.work += words * words * 12 * children as u64;
        if self.work > MOST_WORK {
            return Err(ZoomError::TooLong);
        }
        Ok(())
    }

    /// The graph that starts from the roots.
    pub(super) fn zoom(self) -> Result<Zoom, ZoomError> {
        let mut graph = self.graph.clone();
        let mut base_elements = graph.base_elements().to_vec();
        let mut chain = Chain::default();
        let mut roots = Vec::new();
        let mut deepest = 0;
        let mut behaviour = graph.behaviours().count();
        let position = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        for item in self.items {
            let Item::Root(found) = item else { continue };
            let parts = match found.drawn {
                Drawn::Object => vec![(found.frame, None)],
                Drawn::Clipped(outline) => vec![(found.frame, Some(outline))],
                Drawn::Around(path) => {
                    let ways = path.ways().into_iter();
                    ways.map(|way| (way.frame, Some(way.outline))).collect()
                }
            };
            for (number, (frame, drawn)) in parts.into_iter().enumerate() {
                let mut object = found.object;
                if let Some(outline) = drawn {
                    if self.window.relative_stroke > 0.0 {
                        return Err(ZoomError::WideStroke);
                    }
                    let mut of = graph.objects()[object].clone();
                    of.base_element = base_elements.len();
                    of.behaviour = behaviour;
                    of.replacement = Replacement::Kept;
                    base_elements.push(outline);
                    behaviour += 1;
                    object = graph.objects().len();
                    graph.objects.push(of);
                }
                chain.instances.push(Instance {
                    frame,
                    length: frame.stretch(),
                    joined: found.joined || number > 0,
                    position: position(roots.len()),
                    object,
                });
                deepest = deepest.max(found.root.level);
                roots.push(found.root);
            }
        }
        graph.base_elements = base_elements.into();
        graph.initiators = vec![chain];
        graph.roots = roots.into();
        Ok(Zoom { graph, deepest })
    }
}

/// Whether the work is to go on, asked now and then.
pub(super) fn check(growth: &Growth<'_>, round: u32) -> Result<(), ZoomError> {
    let is_cancelled = |flag: &std::sync::atomic::AtomicBool| flag.load(Ordering::Relaxed);
    if round.is_multiple_of(16) && growth.cancel.is_some_and(is_cancelled) {
        return Err(ZoomError::Cancelled);
    }
    Ok(())
}

/// 2^`exponent` parts of a pixel, in pixels; infinite where that is more than doubles hold.
pub(super) fn pixel(exponent: usize) -> f64 {
    const PARTS: f64 = (1_u128 << GRAIN) as f64;
    libm::ldexp(1.0, i32::try_from(exponent).unwrap_or(i32::MAX)) / PARTS
}

/// The doubt about the places of what a map holds that stands somewhere near the window.
fn doubt(map: &DAffine2) -> f64 {
    let frame = Frame {
        map: *map,
        ..Frame::UNIT
    };
    DOUBT * (map.translation.length() + frame.stretch())
}

fn scaled(map: &DAffine2, by: f64) -> DAffine2 {
    DAffine2 {
        matrix2: map.matrix2 * by,
        translation: map.translation * by,
    }
}
