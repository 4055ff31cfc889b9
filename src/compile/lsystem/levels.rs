//! Time-indexed graphs of L-systems: an object for every kind and number of steps that are left.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::draws::Path;
use crate::geometry::{Frame2, Point as _};
use crate::lsystem::{TubePart, TurtleFrame};
use crate::style::Tube;

use super::NotCompiled;
use super::effects::{Effects, ModuleDrawing};
use super::far::Far;
use super::long::SummedFrame;
use super::paint::Paint;
use super::reader::{DrawnPart, Of, Reader};
use super::state::{Joint, StrokeAttributes, TurtleState};
use super::words::{Words, Written};
use super::work;
use super::worn::Worn;
use crate::graph::{Alternative, Chain, Graph, Instance, Object, Replacement, Successor};
use crate::rule::Extent;

/// Limit of the number of objects.
const MAX_OBJECTS: usize = 1 << 17;

/// Limit of the number of modules that are read to find positions.
const MAX_WORK: u64 = 1 << 22;

/// Largest reach for which coordinates are the turtle's; beyond it, they are scaled to a reach of about
/// 1.
const FARTHEST: f64 = 1e150;

/// Extent of a subtree, as a share of that of the approximant, below which its tubes have the colour and the widths of the
/// turtle's start. Every level may inherit others, and nothing shows them: positions are rounded to larger shares.
const LEAST: f64 = 1.0 / (1_u64 << 40) as f64;

/// Identity of an object.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct ObjectKey {
    of: Master,
    paint: Paint,
    /// State that tubes inherit from the line before.
    worn: Worn,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Master {
    /// Kind, and the number of steps that are left.
    Subtree(usize, u32),
    /// Line, and whether its module is replaced in the next step.
    Step(bool),
    /// Polygon, stamp or part of a tube, by base element.
    Body(usize),
}

/// Builder of the objects of a time-indexed graph, from the largest number of steps left to the smallest.
struct Leveller<'e, F: TurtleFrame> {
    effects: &'e Effects<F>,
    tube: Option<Tube>,
    /// Extent of the approximant, in steps of the turtle.
    whole: Far<F::Point>,
    base_elements: Vec<F::BaseElement>,
    outlines: BTreeMap<Vec<[u64; 3]>, usize>,
    /// Base elements of polygons without extent, which are not visible.
    empty: BTreeSet<usize>,
    stamps: BTreeMap<usize, usize>,
    tubes: BTreeMap<TubePart, usize>,
    /// Numbers of the objects that are replaced, and of all others.
    numbers: [BTreeMap<ObjectKey, usize>; 2],
    /// Identities of both, in the order of their numbers.
    keys: [Vec<ObjectKey>; 2],
    /// Replacements of kinds, by the number of steps left and by what they inherit.
    productions: BTreeMap<(usize, u32, Worn), Made<F>>,
    written: Vec<Written<F>>,
    /// Number of modules of expanded words inside polygons of the axiom.
    expanded: u64,
    /// Number of modules of the words that replace objects.
    modules: u64,
}

/// Replacement of a kind.
enum Made<F: TurtleFrame> {
    Fixed(Successor<F>),
    /// Words of which one is drawn, or whose modules are random.
    Drawn(Vec<Alternative>),
}

/// First provisional number of objects that are not replaced; their final numbers follow those of all
/// others.
const LEAVES: usize = usize::MAX / 2;

/// Graph of an L-system, with the base elements of which it knows the outlines.
pub(super) type Levels<F> = (Graph<F>, Vec<<F as crate::rule::RuleFrame>::BaseElement>);

impl Graph<Frame2> {
    /// Builds the graph whose objects are kinds with a number of steps that are left.
    pub(super) fn of_levels(effects: Effects, steps: u32) -> Result<Self, NotCompiled> {
        levels(effects, steps, None).map(|(graph, _)| graph)
    }
}

/// Builds the graph whose objects are kinds with a number of steps that are left. Lines are tubes if these are given,
/// and not replaced; nothing may depend on draws then.
pub(super) fn levels<F: SummedFrame>(
    effects: Effects<F>,
    steps: u32,
    tube: Option<Tube>,
) -> Result<Levels<F>, NotCompiled> {
    let leveller = Leveller {
        effects: &effects,
        tube,
        whole: Far::of_length(1.0),
        base_elements: vec![F::line()],
        outlines: BTreeMap::new(),
        empty: BTreeSet::new(),
        stamps: BTreeMap::new(),
        tubes: BTreeMap::new(),
        numbers: [const { BTreeMap::new() }; 2],
        keys: [const { Vec::new() }; 2],
        productions: BTreeMap::new(),
        written: Vec::new(),
        expanded: 0,
        modules: 0,
    };
    let (mut graph, base_elements, written) = leveller.run(steps)?;
    if !written.is_empty() {
        graph.draws = true;
        graph.source = Some(Arc::new(Words { effects, written }));
    }
    Ok((graph, base_elements))
}

/// Graph, base elements, and the words that draws select.
type Finished<F> = (
    Graph<F>,
    Vec<<F as crate::rule::RuleFrame>::BaseElement>,
    Vec<Written<F>>,
);

impl<F: TurtleFrame> Leveller<'_, F> {
    fn run(mut self, steps: u32) -> Result<Finished<F>, NotCompiled> {
        let mut initiators = Vec::new();
        let mut done = 0;
        // With tubes, the graph is drawn, and no other number of steps is asked for.
        let least = if self.tube.is_some() { steps } else { 0 };
        for left in (least..=steps).rev() {
            initiators.push(self.initiator(left)?);
            while let Some(&key) = self.keys[0].get(done) {
                let Master::Subtree(kind, level) = key.of else {
                    break;
                };
                if level < left && left > least {
                    break;
                }
                done += 1;
                let replaced = (kind, level, key.worn);
                if !self.productions.contains_key(&replaced) {
                    let production = self.production(kind, level, key.worn)?;
                    self.productions.insert(replaced, production);
                }
            }
        }
        initiators.reverse();
        Ok(self.finish(initiators, steps))
    }

    /// Returns the chain of the axiom with `left` steps left.
    fn initiator(&mut self, left: u32) -> Result<Chain<F>, NotCompiled> {
        let effects = self.effects;
        let mut start = TurtleState {
            attributes: StrokeAttributes::START,
            joint: Joint::START,
            ..TurtleState::SAME
        };
        start.pose.heading = F::start(&effects.system, effects.compass);
        start.pose.scale = effects.words().length();
        let mut reader = Reader::new(effects, start, false);
        reader.read(&effects.kinds.axiom, left, Path::of_seed(0))?;
        work::spend(&mut self.expanded, reader.expanded, work::MAX_WORK)?;
        let effect = reader.effect()?;
        // The positions of the initiator's instances must not depend on draws.
        let is_rough = reader.parts.iter().any(|part| part.pose.is_rough);
        if is_rough || !effect.is_exact && effect.work > MAX_WORK {
            return Err(NotCompiled);
        }
        if let Some(drawn) = &effect.drawn {
            self.whole = drawn.reach;
        }
        let unit = match effect.drawn {
            Some(ModuleDrawing { reach, .. })
                if reach.longer(Far::of_length(FARTHEST)) == reach =>
            {
                reach
            }
            _ => Far::of_length(1.0),
        };
        let instances = self.instances(&reader.parts, left, unit, Worn::START)?;
        Ok(Chain::loose(instances))
    }

    /// Returns the replacement of a kind with `left` steps left, where the turtle has a colour.
    fn production(&mut self, kind: usize, left: u32, worn: Worn) -> Result<Made<F>, NotCompiled> {
        let effects = self.effects;
        let unit = effects.drawn_by(kind, left)?.size;
        let is_exact = effects.of(kind, left)?.is_exact;
        if !is_exact && self.tube.is_some() {
            return Err(NotCompiled);
        }
        let mut words = Vec::new();
        for alternative in &effects.kinds.all[kind].alternatives {
            let modules = work::OBJECT + alternative.word.len() as u64;
            work::spend(&mut self.modules, modules, work::MAX_INHERITED)?;
            let mut reader = Reader::new(effects, TurtleState::SAME, false);
            reader.read(&alternative.word, left - 1, Path::of_seed(0))?;
            let instances = self.instances(&reader.parts, left - 1, unit, worn)?;
            if is_exact {
                let meets_frame = reader.meets();
                let body = Chain {
                    meets_frame,
                    ..Chain::loose(instances)
                };
                return Ok(Made::Fixed(body.into()));
            }
            let placed = reader.parts.iter().zip(&instances);
            let extent = |(part, instance): (&DrawnPart<F>, &Instance<F>)| Extent {
                away: part.pose.away().ratio(unit),
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
        parts: &[DrawnPart<F>],
        left: u32,
        unit: Far<F::Point>,
        worn: Worn,
    ) -> Result<Vec<Instance<F>>, NotCompiled> {
        let mut instances = Vec::new();
        for part in parts {
            self.add(part, left, unit, worn, &mut instances)?;
        }
        Ok(instances)
    }

    /// Adds the instance of a part; for a line that is a tube, those of its parts.
    fn add(
        &mut self,
        part: &DrawnPart<F>,
        left: u32,
        unit: Far<F::Point>,
        worn: Worn,
        instances: &mut Vec<Instance<F>>,
    ) -> Result<(), NotCompiled> {
        let one = Far::of_length(1.0);
        let (steps, of) = match &part.of {
            Of::Subtree(kind, drawn) => (drawn.size, Master::Subtree(*kind, left)),
            Of::Step { fertile } => (one, Master::Step(*fertile)),
            Of::Polygon(vertices) => (one, Master::Body(self.outline(vertices))),
            Of::Stamp(number) => (one, Master::Body(self.stamp(*number))),
        };
        let effects = self.effects;
        let frame: F = part.pose.frame(effects.compass, steps, unit);
        let attributes = match self.tube {
            // Tubes have their widths.
            Some(_) => StrokeAttributes {
                width: StrokeAttributes::SAME.width,
                ..part.attributes
            },
            None => part.attributes,
        };
        let mut key = ObjectKey {
            of,
            paint: Paint::of(effects.palette(), attributes, worn.colour),
            worn: Worn::START,
        };
        let mut push = |object: usize, frame: F, joined: bool| {
            instances.push(Instance {
                joined,
                ..Instance::new(object, frame, part.position)
            });
        };
        match (&part.of, self.tube) {
            (Of::Subtree(_, drawn), Some(_)) => {
                let inside = worn.inside(part);
                let share = inside.step() * drawn.size.ratio(self.whole);
                if share < LEAST {
                    key.paint = Paint::of(effects.palette(), StrokeAttributes::SAME, 0);
                } else {
                    key.worn = inside;
                }
            }
            (Of::Step { .. }, Some(tube)) => {
                for (piece, stretch) in tube.parts(&worn.line(part)) {
                    key.of = Master::Body(self.tube_part(tube, piece));
                    let object = self.object(key)?;
                    push(object, frame.stretched(stretch), false);
                }
                return Ok(());
            }
            _ => {}
        }
        key.worn.colour = key.paint.colour;
        push(self.object(key)?, frame, part.joined);
        Ok(())
    }

    /// Returns the number of an object, which is created if it is new.
    fn object(&mut self, key: ObjectKey) -> Result<usize, NotCompiled> {
        let (shelf, first) = match key.of {
            Master::Subtree(..) => (0, 0),
            Master::Step(_) | Master::Body(_) => (1, LEAVES),
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
    fn outline(&mut self, vertices: &[F::Point]) -> usize {
        let bits = vertices
            .iter()
            .map(|vertex| vertex.coordinates().map(f64::to_bits));
        let next = self.base_elements.len();
        let number = *self.outlines.entry(bits.collect()).or_insert(next);
        if number == next {
            let outline = F::polygon(vertices);
            if outline.is_none() {
                self.empty.insert(number);
            }
            self.base_elements.push(outline.unwrap_or_else(F::line));
        }
        number
    }

    /// Returns the base element of a stamp of the system, which is added if it is new.
    fn stamp(&mut self, number: usize) -> usize {
        let next = self.base_elements.len();
        let known = *self.stamps.entry(number).or_insert(next);
        if known == next {
            let stamps = F::stamps(&self.effects.system);
            self.base_elements.push(stamps[number].clone());
        }
        known
    }

    /// Returns the base element of a part of a tube, which is created if it is new.
    fn tube_part(&mut self, tube: Tube, part: TubePart) -> usize {
        let next = self.base_elements.len();
        let known = *self.tubes.entry(part).or_insert(next);
        if known == next {
            self.base_elements.push(F::tube_part(tube, part));
        }
        known
    }

    fn finish(mut self, mut initiators: Vec<Chain<F>>, steps: u32) -> Finished<F> {
        let count = self.keys[0].len();
        let number = |object: &mut usize| {
            if *object >= LEAVES {
                *object = *object - LEAVES + count;
            }
        };
        let renumber = |chain: &mut Chain<F>| {
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
        let palette = self.effects.palette();
        let mut behaviours = BTreeMap::new();
        let mut objects = Vec::with_capacity(keys.len());
        for key in keys {
            let (base_element, behaves, replacement) = match key.of {
                Master::Subtree(kind, left) => {
                    let replaced = (kind, left, key.worn);
                    let replacement = replacements[&replaced].clone();
                    let behaves = (Master::Subtree(kind, left), key.worn);
                    (self.way(kind, left), behaves, replacement)
                }
                Master::Step(true) => (0, (key.of, Worn::START), Replacement::Unresolved),
                Master::Step(false) | Master::Body(_) => {
                    let kept = (Master::Step(false), Worn::START);
                    let number = match key.of {
                        Master::Body(number) => number,
                        _ => 0,
                    };
                    (number, kept, Replacement::Kept)
                }
            };
            let next = behaviours.len();
            let is_empty = matches!(key.of, Master::Body(number) if self.empty.contains(&number));
            let object = key.paint.object(palette, base_element);
            objects.push(Object {
                behaviour: *behaviours.entry(behaves).or_insert(next),
                replacement,
                visible: object.visible && !is_empty,
                ..object
            });
        }
        let mut graph = Graph {
            depth: Some(steps),
            tints: palette.is_some(),
            affine: self.tube.is_some(),
            ..Graph::of(objects, F::outlines(&self.base_elements), initiators)
        };
        graph.find_widths();
        (graph, self.base_elements, self.written)
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
        let line = end.and_then(F::line_to).unwrap_or_else(F::line);
        self.base_elements.push(line);
        self.base_elements.len() - 1
    }
}
