//! Edge rewriting: if the successor of a module is similar to itself at every step, one object represents
//! the kind for any number of steps, and its frames are derived from chords.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::draws::Path;
use crate::geometry::{DVec2, Direction, Frame2};
use crate::graph::{Chain, Graph, Instance, Object, Replacement};
use crate::lsystem::{Action, LSystem};
use crate::rule::BaseElement;

use super::NotCompiled;
use super::effects::Effects;
use super::far::Far;
use super::paint::Paint;
use super::reader::{DrawnPart, Of, Reader};
use super::state::{Pose, StrokeAttributes, TurtleState};

/// Limit of the number of steps within which the state of all kinds must recur.
const MAX_STEPS: u32 = 32;

/// Number of steps that are tried at first if words are long: the state of most systems recurs sooner.
const FEW_STEPS: u32 = 4;

/// Number of modules from which words are long.
const LONG: usize = 1 << 12;

/// Relative difference that is attributed to rounding.
const ROUNDING: f64 = 1e-9;

/// Parts of a word's drawing by their chords, relative to the chord of the whole.
#[derive(Debug)]
struct Shape {
    links: Vec<Link>,
    meets: [bool; 2],
}

#[derive(Debug)]
struct Link {
    kind: usize,
    /// Stroke attributes relative to those of the whole.
    attributes: StrokeAttributes,
    ends: [DVec2; 2],
    mirrored: bool,
    joined: bool,
    /// Position among the lines of the word.
    position: u32,
}

impl Shape {
    fn is_like(&self, other: &Self) -> bool {
        let alike = |(a, b): (&Link, &Link)| {
            let near = a.ends.iter().zip(b.ends);
            let is_alike = (a.kind, a.mirrored, a.joined) == (b.kind, b.mirrored, b.joined);
            is_alike && a.attributes == b.attributes && { near }
                .all(|(a, b)| a.distance(b) <= ROUNDING * (1.0 + a.length()))
        };
        self.meets == other.meets
            && self.links.len() == other.links.len()
            && self.links.iter().zip(&other.links).all(alike)
    }

    /// Returns the instances of the shape, where the whole has a colour.
    fn chain(&self, edges: &Edges, objects: &Objects, colour: i64) -> Result<Chain, NotCompiled> {
        let instance = |link: &Link| {
            let direction = if link.mirrored {
                Direction::YReflected
            } else {
                Direction::Normal
            };
            let [from, to] = link.ends;
            Some(Instance {
                corners: None,
                frame: Frame2::between(from, to, direction),
                length: from.distance(to),
                joined: link.joined,
                position: link.position,
                object: *objects.get(&edges.key(link.kind, link.attributes, colour))?,
            })
        };
        let instances: Option<Vec<_>> = self.links.iter().map(instance).collect();
        Ok(Chain {
            meets_frame: self.meets,
            ..Chain::loose(instances.ok_or(NotCompiled)?)
        })
    }
}

/// Identity of an object.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ObjectKey {
    pub(super) kind: usize,
    paint: Paint,
}

/// Numbers of objects.
pub(super) type Objects = BTreeMap<ObjectKey, usize>;

/// Limit of the number of objects.
const MAX_OBJECTS: usize = 1 << 12;

/// TurtleState of the turtle after each replaced kind at one number of steps, with the displacement relative to the
/// longest.
#[derive(Debug)]
struct Stage {
    kinds: Vec<(DVec2, TurtleState)>,
    /// Longest displacement, if there are modules of constant length.
    size: Option<Far>,
}

impl Stage {
    /// Returns whether the stages are equal up to rounding and, unless there are modules of constant
    /// length, up to size.
    fn is_like(&self, other: &Self) -> bool {
        let sizes = self.size.zip(other.size);
        let grows = |(a, b): (Far, Far)| (a.over(b).x - 1.0).abs() > ROUNDING;
        if sizes.is_some_and(grows) {
            return false;
        }
        self.kinds
            .iter()
            .zip(&other.kinds)
            .all(|((a, state), (b, others))| {
                let (pose, other) = (&state.pose, &others.pose);
                a.distance(*b) <= ROUNDING
                    && state.attributes == others.attributes
                    && (pose.heading, pose.mirrored) == (other.heading, other.mirrored)
                    && (pose.scale / other.scale - 1.0).abs() <= ROUNDING
            })
    }
}

impl Graph {
    /// Builds the graph of a system that rewrites edges. Approximants are aligned: each runs from the
    /// start of approximant 0 to its end.
    ///
    /// All steps are similar if the state of all kinds recurs up to its size, because the following steps
    /// depend on nothing else.
    pub(super) fn of_edges(system: &LSystem) -> Result<Self, NotCompiled> {
        let of_steps = |steps| {
            let effects = Effects::closed(system, steps)?;
            Ok(Edges { effects })
        };
        // Most systems that do not rewrite edges draw other things than lines, whatever follows.
        let none = of_steps(0)?;
        none.draws()?;
        let kinds = &none.effects.kinds;
        let alternatives = || kinds.all.iter().map(|kind| &kind.alternatives);
        if alternatives().any(|alternatives| alternatives.len() > 1) {
            return Err(NotCompiled);
        }
        let words = alternatives()
            .flatten()
            .map(|alternative| &alternative.word);
        let modules = words.chain([&kinds.axiom]).map(|word| word.len());
        if modules.sum::<usize>() >= LONG
            && let Some(graph) = of_steps(FEW_STEPS)?.run(FEW_STEPS)?
        {
            return Ok(graph);
        }
        of_steps(MAX_STEPS)?.run(MAX_STEPS)?.ok_or(NotCompiled)
    }

    /// Returns whether an L-system rewrites edges: whether one graph describes it for all numbers of
    /// steps.
    #[must_use]
    pub fn rewrites_edges(system: &LSystem) -> bool {
        !system.in_limit && Self::of_edges(system).is_ok()
    }
}

pub(super) struct Edges {
    pub(super) effects: Effects,
}

impl Edges {
    /// Returns the graph; `None` if the state does not recur within so many steps.
    fn run(&self, steps: u32) -> Result<Option<Graph>, NotCompiled> {
        let kinds = &self.effects.kinds;
        let draws = self.draws()?;
        let first =
            |kind: usize| self.shape(&kinds.all[kind].alternatives[0].word, 0, Some((kind, 1)));
        let mut shapes = Vec::new();
        for (kind, draws) in draws.iter().enumerate() {
            let replaced = *draws && kinds.all[kind].is_fertile();
            shapes.push(if replaced { Some(first(kind)?) } else { None });
        }
        let start = self.shape(&kinds.axiom, 0, None)?;
        let mut stages: Vec<Stage> = Vec::new();
        for left in 0..steps {
            // The shapes of this stage must equal those of the first.
            for (kind, shape) in shapes.iter().enumerate() {
                let Some(shape) = shape else { continue };
                let word = &kinds.all[kind].alternatives[0].word;
                if !self
                    .shape(word, left, Some((kind, left + 1)))?
                    .is_like(shape)
                {
                    return Err(NotCompiled);
                }
            }
            if !self.shape(&kinds.axiom, left, None)?.is_like(&start) {
                return Err(NotCompiled);
            }
            let stage = self.stage(left)?;
            if stages.iter().any(|before| before.is_like(&stage)) {
                return self.graph(&shapes).map(Some);
            }
            stages.push(stage);
        }
        Ok(None)
    }

    /// Returns, for every kind, whether it draws. Fails unless each kind that does draws exactly one
    /// line, from the position before it to the position after it, until it is replaced.
    pub(super) fn draws(&self) -> Result<Vec<bool>, NotCompiled> {
        let mut draws = Vec::new();
        for (kind, of) in self.effects.kinds.all.iter().enumerate() {
            if !of.is_fertile() && self.effects.system.symbols()[of.symbol].draws() == 0 {
                draws.push(false);
                continue;
            }
            let mut reader = Reader::new(&self.effects, TurtleState::SAME, false);
            reader.read(&[kind], 0, Path::of_seed(0))?;
            let place = reader.state.pose.place;
            draws.push(match reader.parts.as_slice() {
                [] => false,
                [part] if part.pose.place.is_zero() => {
                    let end = self.end(&part.of, &reader.parts[0].pose, kind, 0)?;
                    let off = end.plus(place.times(-1.0)).length();
                    if !off.is_zero() && off.over(place.length()).x > ROUNDING {
                        return Err(NotCompiled);
                    }
                    true
                }
                _ => return Err(NotCompiled),
            });
        }
        Ok(draws)
    }

    /// Returns the end point of a part of a word.
    fn end(&self, of: &Of, pose: &Pose, kind: usize, left: u32) -> Result<Far, NotCompiled> {
        let compass = self.effects.compass;
        let mut pose = *pose;
        match of {
            Of::Step { .. } => pose.go(compass, 1.0),
            Of::Subtree(..) => {
                let effect = self.effects.of(kind, left)?;
                pose = pose.then(compass, &effect.state.pose);
            }
            Of::Polygon(_) | Of::Stamp(_) => return Err(NotCompiled),
        }
        Ok(pose.place)
    }

    /// Returns the drawing of a word whose modules are to be replaced for `left` more steps, relative to
    /// the chord of a kind (`saturating`), or to that of its first part.
    fn shape(
        &self,
        word: &[usize],
        left: u32,
        whole: Option<(usize, u32)>,
    ) -> Result<Shape, NotCompiled> {
        let mut reader = Reader::new(&self.effects, TurtleState::SAME, false);
        reader.read(word, left, Path::of_seed(0))?;
        let mut ends = Vec::new();
        for part in &reader.parts {
            let kind = word[part.position as usize];
            ends.push([part.pose.place, self.end(&part.of, &part.pose, kind, left)?]);
        }
        let [from, to] = match whole {
            Some((kind, left)) => [Far::ZERO, self.effects.place_after(kind, left)],
            None => *ends.first().ok_or(NotCompiled)?,
        };
        let chord = to.plus(from.times(-1.0));
        let length = chord.length();
        if length.is_zero() {
            return Err(NotCompiled);
        }
        let along = chord.over(length);
        let back = DVec2::new(along.x, -along.y);
        let seen = |place: Far| back.rotate(place.plus(from.times(-1.0)).over(length));
        let parts = reader.parts.iter().zip(ends).zip(0..);
        let links = parts.map(|((part, ends), position)| Link {
            kind: word[part.position as usize],
            attributes: part.attributes,
            ends: ends.map(seen),
            mirrored: part.pose.mirrored,
            joined: part.joined,
            position,
        });
        Ok(Shape {
            links: links.collect(),
            meets: reader.meets(),
        })
    }

    /// Returns the states after all kinds that are replaced for `left` steps.
    fn stage(&self, left: u32) -> Result<Stage, NotCompiled> {
        let mut states = Vec::new();
        let all = self.effects.kinds.all.iter().enumerate();
        for (kind, _) in all.filter(|(_, kind)| kind.is_fertile()) {
            let mut reader = Reader::new(&self.effects, TurtleState::SAME, false);
            reader.read(&[kind], left, Path::of_seed(0))?;
            states.push(reader.state);
        }
        let poses = || states.iter().map(|state| &state.pose);
        let longest = poses().map(|pose| pose.place.length());
        let longest = longest.reduce(Far::longer).ok_or(NotCompiled)?;
        // Without reflections, a common rotation of all displacements does not matter.
        let turns = !self.reflects();
        let mut first = poses().map(|pose| pose.place.over(longest));
        let first = first.find(|place| place.length() > ROUNDING);
        let back = match first.filter(|_| turns) {
            Some(along) => DVec2::new(along.x, -along.y) / along.length(),
            None => DVec2::X,
        };
        let kinds = states
            .iter()
            .map(|state| (back.rotate(state.pose.place.over(longest)), *state));
        Ok(Stage {
            kinds: kinds.collect(),
            size: self.keeps_lengths().then_some(longest),
        })
    }

    /// Returns the initial state of the turtle.
    pub(super) fn start(&self) -> TurtleState {
        let Effects {
            system, compass, ..
        } = &self.effects;
        let mut state = TurtleState::SAME;
        state.pose.heading = compass.of_degrees(system.start());
        state.pose.scale = system.length();
        state
    }

    /// Returns whether a module that is not replaced moves the turtle.
    fn keeps_lengths(&self) -> bool {
        let symbols = self.effects.system.symbols();
        let mut kept = { self.effects.kinds.all.iter() }.filter(|kind| !kind.is_fertile());
        let goes = |action: &Action| {
            matches!(action, Action::Draw(_) | Action::Move(_) | Action::Glide(_))
        };
        kept.any(|kind| symbols[kind.symbol].meaning.iter().any(goes))
    }

    fn reflects(&self) -> bool {
        let symbols = self.effects.system.symbols();
        let used = self
            .effects
            .kinds
            .all
            .iter()
            .map(|kind| &symbols[kind.symbol]);
        let mut actions = used.flat_map(|symbol| &symbol.meaning);
        actions.any(|action| matches!(action, Action::Reflect))
    }

    /// Returns the identity of an object of a kind, whose attributes are relative to a whole with a
    /// colour.
    fn key(&self, kind: usize, attributes: StrokeAttributes, colour: i64) -> ObjectKey {
        ObjectKey {
            kind,
            paint: Paint::of(self.effects.palette(), attributes, colour),
        }
    }

    /// Returns the objects in order: those of the axiom, and their descendants.
    pub(super) fn objects(&self) -> Result<Objects, NotCompiled> {
        let kinds = &self.effects.kinds;
        let keys = |word: &[usize], colour: i64| -> Result<Vec<ObjectKey>, NotCompiled> {
            let mut reader = Reader::new(&self.effects, TurtleState::SAME, false);
            reader.read(word, 0, Path::of_seed(0))?;
            let parts = reader.parts.iter();
            let key =
                |part: &DrawnPart| self.key(word[part.position as usize], part.attributes, colour);
            Ok(parts.map(key).collect())
        };
        let mut open = keys(&kinds.axiom, 0)?;
        let mut found = BTreeSet::new();
        while let Some(key) = open.pop() {
            if !found.insert(key) {
                continue;
            }
            if found.len() > MAX_OBJECTS {
                return Err(NotCompiled);
            }
            let kind = &kinds.all[key.kind];
            if kind.is_fertile() {
                open.extend(keys(&kind.alternatives[0].word, key.paint.colour)?);
            }
        }
        Ok(found.into_iter().zip(0..).collect())
    }

    fn graph(&self, shapes: &[Option<Shape>]) -> Result<Graph, NotCompiled> {
        let objects = self.objects()?;
        let palette = self.effects.palette();
        let axiom = &self.effects.kinds.axiom;
        let mut reader = Reader::new(&self.effects, self.start(), false);
        reader.read(axiom, 0, Path::of_seed(0))?;
        let unit = Far::of_length(1.0);
        let mut links = Vec::new();
        for (position, part) in (0..).zip(&reader.parts) {
            let kind = axiom[part.position as usize];
            let to = self.end(&part.of, &part.pose, kind, 0)?;
            links.push(Link {
                kind,
                attributes: part.attributes,
                ends: [part.pose.place, to].map(|place| place.over(unit)),
                mirrored: part.pose.mirrored,
                joined: part.joined,
                position,
            });
        }
        let start = Shape {
            links,
            meets: [false; 2],
        };
        let mut behaviours = BTreeMap::new();
        let mut made = Vec::new();
        for key in objects.keys() {
            let next = behaviours.len();
            let behaves = (key.kind, key.paint.colour);
            let replacement = match &shapes[key.kind] {
                Some(shape) => {
                    let body = shape.chain(self, &objects, key.paint.colour)?;
                    Replacement::Fixed(Arc::new(body.into()))
                }
                None => Replacement::Kept,
            };
            made.push(Object {
                behaviour: *behaviours.entry(behaves).or_insert(next),
                replacement,
                ..key.paint.object(palette, 0)
            });
        }
        let start = start.chain(self, &objects, 0)?;
        let mut graph = Graph {
            tints: palette.is_some(),
            middle: DVec2::new(0.5, 0.0),
            ..Graph::of(made, [BaseElement::line()], vec![start])
        };
        graph.find_widths();
        // Unbounded widths require a time-indexed graph.
        let is_bounded = graph.widest.is_none_or(f64::is_finite);
        is_bounded.then_some(graph).ok_or(NotCompiled)
    }
}
