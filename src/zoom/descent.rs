//! Descent from the initiator to the roots of a window.

use crate::geometry::{DAffine2, DVec2, Frame2, stretch};
use crate::graph::{Chain, Graph, Instance, Seed, Successor, is_ring};
use crate::grow::{Evaluator, ReplacementContext, TraversalState};
use crate::parallel::is_cancelled;

use super::clip::{self, Path};
use super::constants::{Constants, Parent};
use super::fixed::{Fixed, Vector};
use super::items::{FoundRoot, FractalItem, FractalPart, Node, RootDrawing};
use super::{GRAIN, SPARE, Zoom, ZoomError, ZoomOptions, ZoomWindow, merge, roots};

/// Largest extent of a root, in pixels.
const LARGEST: f64 = (1 << 20) as f64;

/// Limit of the number of instances that are kept in a step.
const MAX_INSTANCES: usize = 20_000;

/// Limit of the work: products of 64-bit words.
const MAX_WORK: u64 = 400_000_000_000;

/// Relative error of doubles that is allowed for when they decide that an instance is outside.
const DOUBT: f64 = 1e-9;

/// Relation of a node to the window.
enum Relation {
    Outside,
    Small(DAffine2),
    Large,
}

pub(super) struct Descent<'a, 'c> {
    graph: &'a Graph,
    growth: &'a ZoomOptions<'a>,
    window: &'a ZoomWindow,
    reaches: &'a [f64],
    constants: &'c mut Constants<'a>,
    /// Half the extent of the window with its margin, in pixels.
    half: DVec2,
    /// Fractals, each after the one that seeded it.
    lines: Vec<FractalPart>,
    evaluator: Evaluator,
    work: u64,
}

impl<'a, 'c> Descent<'a, 'c> {
    pub(super) fn new(
        graph: &'a Graph,
        growth: &'a ZoomOptions<'a>,
        window: &'a ZoomWindow,
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
            lines: Vec::new(),
            evaluator: Evaluator::default(),
            work: 0,
        }
    }

    /// Descends until all that shows in the window is a root.
    pub(super) fn run(mut self, centre: &Vector) -> Result<Zoom, ZoomError> {
        let bits = self.constants.bits();
        let scale = self.window.factor.times(self.window.scale, GRAIN);
        let whole = TraversalState::whole(self.growth.seed);
        let scaled = |[x, y]: &Vector| [x, y].map(|it| (it * &scale) >> bits);
        let initiator = self.graph.initiator(0);
        for fractal in initiator.fractals() {
            let mut items = Vec::new();
            for instance in fractal {
                let map = self.constants.root(instance);
                let [x, y] = &map.origin;
                let map = Fixed {
                    axes: [scaled(&map.axes[0]), scaled(&map.axes[1])],
                    origin: scaled(&[x - &centre[0], y - &centre[1]]),
                };
                items.push(FractalItem::Node(Box::new(Node {
                    state: whole.root(self.graph, instance),
                    object: instance.object,
                    level: 0,
                    born: 0,
                    map,
                    joined: instance.joined,
                })));
            }
            self.lines.push(FractalPart {
                born: 0,
                is_ring: is_ring(fractal),
                items,
            });
        }
        // Every round is a step: nodes that are no roots were created in the previous round.
        for round in 0.. {
            check(self.growth, round)?;
            let is_done = |item: &FractalItem| !matches!(item, FractalItem::Node(_));
            let mut items = self.lines.iter().flat_map(|line| &line.items);
            if items.all(is_done) {
                break;
            }
            for number in 0..self.lines.len() {
                self.go_down(number)?;
            }
            // Draws and tints distinguish instances at one place, and areas require the complete chain.
            if !self.graph.draws() && !self.graph.tints() && !self.window.areas {
                merge::merge(&mut self.lines);
            }
            let count: usize = self.lines.iter().map(|line| line.items.len()).sum();
            if count > MAX_INSTANCES {
                return Err(ZoomError::TooMany {
                    limit: MAX_INSTANCES,
                });
            }
        }
        roots::zoom(self.graph, self.window, self.lines)
    }

    /// Replaces all nodes of a fractal that are no roots, once.
    fn go_down(&mut self, number: usize) -> Result<(), ZoomError> {
        let old = std::mem::take(&mut self.lines[number].items);
        let mut line = FractalPart {
            items: Vec::new(),
            ..self.lines[number]
        };
        // Only a ring can lead around the window.
        let areas = self.window.areas && line.is_ring;
        // Whether the next item can join the end of the one before.
        let mut pen = line.is_ring;
        for item in old {
            let node = match item {
                FractalItem::Root(mut found) => {
                    found.joined &= pen;
                    pen = true;
                    line.add(*found);
                    continue;
                }
                FractalItem::Seed(number) => {
                    if !self.lines[number].items.is_empty() {
                        line.items.push(item);
                    }
                    continue;
                }
                FractalItem::Node(node) => node,
            };
            pen &= node.joined;
            match self.look(&node) {
                Relation::Outside if areas => {
                    line.add(self.around(&node, pen));
                    pen = true;
                }
                Relation::Outside => pen = false,
                Relation::Small(map) => {
                    let frame = Frame2::new(map, node.state.frame.direction());
                    line.add(FoundRoot::of(&node, frame, pen, RootDrawing::Object));
                    pen = true;
                }
                Relation::Large if self.stays(&node) => {
                    if let Some(found) = self.clipped(&node, areas, pen) {
                        line.add(found);
                    }
                    pen = areas;
                }
                Relation::Large => pen = self.replace(&node, areas, pen, &mut line)?,
            }
        }
        if !pen {
            line.open();
        }
        if line.is_elsewhere() {
            line.items.clear();
        }
        self.lines[number] = line;
        Ok(())
    }

    fn stays(&self, node: &Node) -> bool {
        let object = &self.graph.objects()[node.object];
        object.is_kept() || self.growth.steps == Some(node.level)
    }

    /// Returns the visible part of an element that is not replaced.
    fn clipped(&self, node: &Node, areas: bool, pen: bool) -> Option<FoundRoot> {
        let object = &self.graph.objects()[node.object];
        let outline = &self.graph.base_elements()[object.base_element];
        let (bits, radius) = (self.constants.bits(), self.half.length());
        let clipped = object
            .visible
            .then(|| clip::clipped(outline, &node.map, bits, radius));
        match clipped.flatten() {
            Some(clip::Clipped { frame, outline }) => Some(FoundRoot::of(
                node,
                frame,
                areas && pen,
                RootDrawing::Clipped(outline),
            )),
            None if areas => Some(self.around(node, pen)),
            None => None,
        }
    }

    /// Returns a path from the start of an element that is not seen to its end.
    fn around(&self, node: &Node, pen: bool) -> FoundRoot {
        let Fixed { axes, origin } = &node.map;
        let end = [&origin[0] + &axes[0][0], &origin[1] + &axes[0][1]];
        let mut ends = [origin.clone(), end];
        if node.state.frame.direction().is_reversed() {
            ends.reverse();
        }
        let mut path = Path::new(&ends[0], self.half.length());
        path.add(ends.to_vec());
        FoundRoot::of(node, Frame2::UNIT, pen, RootDrawing::Around(path))
    }

    fn look(&self, node: &Node) -> Relation {
        let (map, exponent) = node.map.near();
        if self.is_outside(&map, exponent, node.object, doubt(&map)) {
            return Relation::Outside;
        }
        let pixel = pixel(exponent);
        let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis].map(|axis| axis.length() * pixel);
        let length = x.max(y);
        if length < self.window.shortest || length * self.reaches[node.object] <= self.largest() {
            return Relation::Small(scaled(&map, pixel));
        }
        Relation::Large
    }

    /// Returns the largest extent of roots, in pixels. It is small if paths lead around the window,
    /// because they must meet the ends of the roots exactly, and if there are seeds, because seeds of
    /// many elements at one place are merged only above the roots.
    fn largest(&self) -> f64 {
        if self.window.areas || self.graph.seeds {
            self.half.length()
        } else {
            LARGEST
        }
    }

    /// Returns whether the subtree of an object lies outside the window; its map is known in multiples of
    /// 2^`exponent` parts of a pixel, with an error of up to `doubt` multiples.
    fn is_outside(&self, map: &DAffine2, exponent: usize, object: usize, doubt: f64) -> bool {
        let middle = map.transform_point2(self.graph.middle());
        let half = self.half / pixel(exponent);
        let nearest = middle.clamp(-half, half);
        let reach = self.reaches[object] * stretch(&map.matrix2);
        middle.distance(nearest) > reach * (1.0 + DOUBT) + doubt
    }

    /// Replaces a node by its children, and adds the fractals that it seeds after all others; returns
    /// whether the next item can join the end of the children.
    fn replace(
        &mut self,
        node: &Node,
        areas: bool,
        pen: bool,
        line: &mut FractalPart,
    ) -> Result<bool, ZoomError> {
        let moment = ReplacementContext {
            born: node.born,
            level: node.level,
            rank: self.graph.objects()[node.object].index.into(),
        };
        let (graph, object) = (self.graph, &self.graph.objects()[node.object]);
        if object.is_kept() || object.is_unresolved() {
            return Err(ZoomError::TooShallow { depth: node.level });
        }
        let mut made = Successor::default();
        let evaluator = &mut self.evaluator;
        let Successor { body, seeds } =
            evaluator.successor(graph, &node.state, node.object, moment, &mut made)?;
        let (map, exponent) = node.map.near();
        // The subtraction of doubles here may cancel most digits.
        let doubt = doubt(&map);
        let is_seen = |instance: &Instance| {
            let child = map * instance.frame.map();
            !self.is_outside(&child, exponent, instance.object, doubt)
        };
        let chains = || std::iter::once(body).chain(seeds.iter().map(|seed| &seed.chain));
        // A closed chain may lead around the window, wherever it lies.
        let is_whole = [areas].into_iter();
        let is_whole = is_whole.chain(chains().skip(1).map(|it| self.window.areas && it.is_ring()));
        let wanted: Vec<&Instance> = chains()
            .zip(is_whole)
            .flat_map(|(chain, is_whole)| {
                let instances = chain.instances.iter();
                instances.filter(move |instance| is_whole || is_seen(instance))
            })
            .collect();
        let parent = Parent {
            state: &node.state,
            object: node.object,
            moment,
            bits: node.map.bits() + SPARE,
        };
        let maps = self.constants.children(parent, &wanted);
        self.spend(&node.map, wanted.len())?;
        let mut made = wanted.into_iter().zip(maps).peekable();
        let bits = self.constants.bits();
        let are_similar = !self.graph.is_affine();
        let mut children = |chain: &Chain, born: u32| -> Vec<Option<Node>> {
            let child = |instance: &Instance| {
                let next = made.next_if(|(next, _)| std::ptr::eq(*next, instance));
                next.map(|(_, map)| Node {
                    state: node.state.child(self.graph, instance),
                    object: instance.object,
                    level: node.level + 1,
                    born,
                    map: node.map.after(&map, bits, are_similar),
                    joined: true,
                })
            };
            chain.instances.iter().map(child).collect()
        };
        let is_reversed = node.state.frame.direction().is_reversed();
        let [mut first, mut end] = body.meets_frame;
        if is_reversed {
            (first, end) = (end, first);
        }
        let count = body.instances.len();
        let pen = line.string(body, children(body, node.born), is_reversed, pen && first);
        for Seed { chain, .. } in seeds {
            let born = node.level + 1;
            let mut seed = FractalPart {
                born,
                is_ring: chain.is_ring(),
                items: Vec::new(),
            };
            let pen = seed.string(chain, children(chain, born), is_reversed, seed.is_ring);
            if !pen {
                seed.open();
            }
            if !seed.items.is_empty() {
                line.items.push(FractalItem::Seed(self.lines.len()));
                self.lines.push(seed);
            }
        }
        Ok(pen && end && count > 0)
    }

    /// Adds the products of big integers to the work.
    fn spend(&mut self, map: &Fixed, children: usize) -> Result<(), ZoomError> {
        let words = (map.bits() / 64 + 8) as u64;
        self.work += words * words * 12 * children as u64;
        if self.work > MAX_WORK {
            return Err(ZoomError::TooLong);
        }
        Ok(())
    }
}

/// Returns an error if the work has been cancelled; the flag is read every 16 rounds.
pub(super) fn check(growth: &ZoomOptions<'_>, round: u32) -> Result<(), ZoomError> {
    if round.is_multiple_of(16) && is_cancelled(growth.cancel) {
        return Err(ZoomError::Cancelled);
    }
    Ok(())
}

/// Returns the length of 2^`exponent` parts of a pixel in pixels; infinite beyond the range of doubles.
pub(super) fn pixel(exponent: usize) -> f64 {
    const PARTS: f64 = (1_u128 << GRAIN) as f64;
    libm::ldexp(1.0, i32::try_from(exponent).unwrap_or(i32::MAX)) / PARTS
}

/// Returns the error of positions under a map near the window.
fn doubt(map: &DAffine2) -> f64 {
    DOUBT * (map.translation.length() + stretch(&map.matrix2))
}

fn scaled(map: &DAffine2, by: f64) -> DAffine2 {
    DAffine2 {
        matrix2: map.matrix2 * by,
        translation: map.translation * by,
    }
}
