//! Time-indexed graphs of L-systems: an object for every kind and number of steps that are left.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::draws::Path;
use crate::geometry::{DVec2, Frame2};
use crate::rule::{BaseElement, Piece};

use super::NotCompiled;
use super::effects::{Effects, ModuleDrawing};
use super::far::Far;
use super::paint::Paint;
use super::reader::{DrawnPart, Of, Reader};
use super::state::{StrokeAttributes, TurtleState};
use super::words::{Words, Written};
use crate::graph::{Alternative, Chain, Graph, Instance, Object, Replacement, Successor};
use crate::rule::Extent;

/// Limit of the number of objects.
const MAX_OBJECTS: usize = 1 << 17;

/// Limit of the number of modules that are read to find positions.
const MAX_WORK: u64 = 1 << 22;

/// Largest reach for which coordinates are the turtle's; beyond it, they are scaled to a reach of about
/// 1.
const FARTHEST: f64 = 1e150;

/// Identity of an object.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct ObjectKey {
    of: Master,
    paint: Paint,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Master {
    /// Kind, and the number of steps that are left.
    Subtree(usize, u32),
    /// Line, and whether its module is replaced in the next step.
    Step(bool),
    /// Polygon, by base element.
    Polygon(usize),
}

/// Builder of the objects of a time-indexed graph, from the largest number of steps left to the smallest.
struct Leveller<'e> {
    effects: &'e Effects,
    base_elements: Vec<BaseElement>,
    outlines: BTreeMap<Vec<[u64; 2]>, usize>,
    /// Numbers of the objects that are replaced, and of all others.
    numbers: [BTreeMap<ObjectKey, usize>; 2],
    /// Identities of both, in the order of their numbers.
    keys: [Vec<ObjectKey>; 2],
    /// Replacements of kinds, by the number of steps left and by colour.
    productions: BTreeMap<(usize, u32, i64), Made>,
    written: Vec<Written>,
}

/// Replacement of a kind.
enum Made {
    Fixed(Successor),
    /// Words of which one is drawn, or whose modules are random.
    Drawn(Vec<Alternative>),
}

/// First provisional number of objects that are not replaced; their final numbers follow those of all
/// others.
const LEAVES: usize = usize::MAX / 2;

impl Graph {
    /// Builds the graph whose objects are kinds with a number of steps that are left.
    pub(super) fn of_levels(effects: Effects, steps: u32) -> Result<Self, NotCompiled> {
        let leveller = Leveller {
            effects: &effects,
            base_elements: vec![BaseElement::line()],
            outlines: BTreeMap::new(),
            numbers: [const { BTreeMap::new() }; 2],
            keys: [const { Vec::new() }; 2],
            productions: BTreeMap::new(),
            written: Vec::new(),
        };
        let (mut graph, written) = leveller.run(steps)?;
        if !written.is_empty() {
            graph.draws = true;
            graph.source = Some(Arc::new(Words { effects, written }));
        }
        Ok(graph)
    }
}

impl Leveller<'_> {
    fn run(mut self, steps: u32) -> Result<(Graph, Vec<Written>), NotCompiled> {
        let mut initiators = Vec::new();
        let mut done = 0;
        for left in (0..=steps).rev() {
            initiators.push(self.initiator(left)?);
            while let Some(&key) = self.keys[0].get(done) {
                let Master::Subtree(kind, level) = key.of else {
                    break;
                };
                if level < left {
                    break;
                }
                done += 1;
                let replaced = (kind, level, key.paint.colour);
                if !self.productions.contains_key(&replaced) {
                    let production = self.production(kind, level, key.paint.colour)?;
                    self.productions.insert(replaced, production);
                }
            }
        }
        initiators.reverse();
        Ok(self.finish(initiators, steps))
    }

    /// Returns the chain of the axiom with `left` steps left.
    fn initiator(&mut self, left: u32) -> Result<Chain, NotCompiled> {
        let effects = self.effects;
        let mut start = TurtleState {
            attributes: StrokeAttributes::START,
            ..TurtleState::SAME
        };
        let compass = effects.compass;
        start.pose.heading = compass.of_degrees(effects.system.start());
        start.pose.scale = effects.system.length();
        let mut reader = Reader::new(effects, start, false);
        reader.read(&effects.kinds.axiom, left, Path::of_seed(0))?;
        let effect = reader.effect()?;
        // The positions of the initiator's instances must not depend on draws.
        let is_rough = reader.parts.iter().any(|part| part.pose.is_rough);
        if is_rough || !effect.is_exact && effect.work > MAX_WORK {
            return Err(NotCompiled);
        }
        let unit = match effect.drawn {
            Some(ModuleDrawing { reach, .. })
                if reach.longer(Far::of_length(FARTHEST)) == reach =>
            {
                reach
            }
            _ => Far::of_length(1.0),
        };
        let instances = self.instances(&reader.parts, left, unit, 0)?;
        Ok(Chain::loose(instances))
    }

    /// Returns the replacement of a kind with `left` steps left, where the turtle has a colour.
    fn production(&mut self, kind: usize, left: u32, colour: i64) -> Result<Made, NotCompiled> {
        let effects = self.effects;
        let unit = effects.drawn_by(kind, left)?.size;
        let is_exact = effects.of(kind, left)?.is_exact;
        let mut words = Vec::new();
        for alternative in &effects.kinds.all[kind].alternatives {
            let mut reader = Reader::new(effects, TurtleState::SAME, false);
            reader.read(&alternative.word, left - 1, Path::of_seed(0))?;
            let instances = self.instances(&reader.parts, left - 1, unit, colour)?;
            if is_exact {
                let meets_frame = reader.meets();
                let body = Chain {
                    instances,
                    meets_frame,
                };
                return Ok(Made::Fixed(body.into()));
            }
            let placed = reader.parts.iter().zip(&instances);
            let extent = |(part, instance): (&DrawnPart, &Instance)| Extent {
                away: part.pose.away().over(unit).x,
                length: instance.length,
            };
            words.push(Alternative {
                generator: self.written.len(),
                objects: instances.iter().map(|instance| instance.object).collect(),
            });
            self.written.push(Written {
                kind,
                left,
                unit,
                positions: instances.iter().map(|instance| instance.position).collect(),
                extents: placed.map(extent).collect(),
            });
        }
        Ok(Made::Drawn(words))
    }

    fn instances(
        &mut self,
        parts: &[DrawnPart],
        left: u32,
        unit: Far,
        colour: i64,
    ) -> Result<Vec<Instance>, NotCompiled> {
        let all = parts
            .iter()
            .map(|part| self.instance(part, left, unit, colour));
        all.collect()
    }

    fn instance(
        &mut self,
        part: &DrawnPart,
        left: u32,
        unit: Far,
        colour: i64,
    ) -> Result<Instance, NotCompiled> {
        let (steps, of) = match &part.of {
            Of::Subtree(kind, drawn) => (drawn.size, Master::Subtree(*kind, left)),
            Of::Step { fertile } => (Far::of_length(1.0), Master::Step(*fertile)),
            Of::Polygon(vertices) => {
                let number = self.outline(vertices);
                (Far::of_length(1.0), Master::Polygon(number))
            }
        };
        let frame: Frame2 = part.pose.frame(self.effects.compass, steps, unit);
        let paint = Paint::of(&self.effects.system, part.attributes, colour);
        let object = self.object(ObjectKey { of, paint })?;
        Ok(Instance {
            corners: None,
            joined: part.joined,
            ..Instance::new(object, frame, part.position)
        })
    }

    /// Returns the number of an object, which is created if it is new.
    fn object(&mut self, key: ObjectKey) -> Result<usize, NotCompiled> {
        let (shelf, first) = match key.of {
            Master::Subtree(..) => (0, 0),
            Master::Step(_) | Master::Polygon(_) => (1, LEAVES),
        };
        let made = self.keys[shelf].len();
        let number = *self.numbers[shelf].entry(key).or_insert(made);
        if number == made {
            self.keys[shelf].push(key);
        }
        if made > MAX_OBJECTS {
            return Err(NotCompiled);
        }
        Ok(first + number)
    }

    /// Returns the base element of a polygon, which is created if it is new.
    fn outline(&mut self, vertices: &[DVec2]) -> usize {
        let bits = vertices
            .iter()
            .map(|vertex| vertex.to_array().map(f64::to_bits));
        let next = self.base_elements.len();
        let number = *self.outlines.entry(bits.collect()).or_insert(next);
        if number == next {
            let pieces = vertices[1..].iter().copied().map(Piece::Line);
            // A polygon without extent is drawn as a line.
            let outline = BaseElement::new(vertices[0], pieces.collect(), true);
            let outline = outline.unwrap_or_else(BaseElement::line);
            self.base_elements.push(outline);
        }
        number
    }

    fn finish(mut self, mut initiators: Vec<Chain>, steps: u32) -> (Graph, Vec<Written>) {
        let count = self.keys[0].len();
        let number = |object: &mut usize| {
            if *object >= LEAVES {
                *object = *object - LEAVES + count;
            }
        };
        let renumber = |chain: &mut Chain| {
            let instances = chain.instances.iter_mut();
            instances.for_each(|instance| number(&mut instance.object));
        };
        initiators.iter_mut().for_each(renumber);
        let made = std::mem::take(&mut self.productions).into_iter();
        let replacement = |made| match made {
            Made::Fixed(mut production) => {
                renumber(&mut production.body);
                Replacement::Fixed(Arc::new(production))
            }
            Made::Drawn(mut words) => {
                let objects = words.iter_mut().flat_map(|word| &mut word.objects);
                objects.for_each(number);
                Replacement::Evaluated(words.into())
            }
        };
        let replacements: BTreeMap<_, _> =
            made.map(|(key, made)| (key, replacement(made))).collect();
        let keys: Vec<ObjectKey> = self.keys.concat();
        let system = &*self.effects.system;
        let mut behaviours = BTreeMap::new();
        let mut objects = Vec::with_capacity(keys.len());
        for key in keys {
            let (base_element, behaves, replacement) = match key.of {
                Master::Subtree(kind, left) => {
                    let replaced = (kind, left, key.paint.colour);
                    let replacement = replacements[&replaced].clone();
                    let behaves = (Master::Subtree(kind, left), key.paint.colour);
                    (self.way(kind, left), behaves, replacement)
                }
                Master::Step(true) => (0, (key.of, 0), Replacement::Unresolved),
                Master::Step(false) => (0, (Master::Step(false), 0), Replacement::Kept),
                Master::Polygon(number) => (number, (Master::Step(false), 0), Replacement::Kept),
            };
            let next = behaviours.len();
            objects.push(Object {
                behaviour: *behaviours.entry(behaves).or_insert(next),
                replacement,
                ..key.paint.object(system, base_element)
            });
        }
        let mut graph = Graph {
            depth: Some(steps),
            tints: system.has_colours(),
            ..Graph::of(objects, self.base_elements, initiators)
        };
        graph.find_widths();
        (graph, self.written)
    }

    /// Adds the base element that represents a kind until it is replaced: the line from the position of
    /// the turtle before it to that after it, or to the position of its farthest part.
    fn way(&mut self, kind: usize, left: u32) -> usize {
        let effects = self.effects;
        let Ok(drawn) = effects.drawn_by(kind, left) else {
            return 0;
        };
        let place = effects.place_after(kind, left);
        let ends = [place, drawn.tip].map(|place| place.over(drawn.size));
        // A displacement within the rounding error has no direction.
        const SHORT: f64 = 1e-9;
        let end = ends.into_iter().find(|end| end.length() > SHORT);
        let line = BaseElement::new(
            DVec2::ZERO,
            vec![Piece::Line(end.unwrap_or(DVec2::X))],
            false,
        );
        self.base_elements
            .push(line.unwrap_or_else(BaseElement::line));
        self.base_elements.len() - 1
    }
}
