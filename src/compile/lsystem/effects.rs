//! Effects of modules on the turtle, computed from the bottom up.

use std::borrow::Cow;
use std::sync::Arc;

use crate::draws::Path;
use crate::geometry::Frame2;
use crate::lsystem::{Action, Compass, LSystem, TurtleFrame};
use crate::style::Palette;

use super::NotCompiled;
use super::far::Far;
use super::kinds::{Kinds, MAX_CLOSED, MAX_KINDS};
use super::long::{SummedFrame, Sums as _};
use super::reader::Reader;
use super::state::{Pose, StrokeAttributes, TurtleState};
use super::work;

/// Effect of a module that is derived for some steps, relative to the state of the turtle before it.
#[derive(Clone, Debug)]
pub(super) struct Effect<F: TurtleFrame = Frame2> {
    /// State of the turtle after it.
    pub(super) state: TurtleState<F>,
    /// Whether the pen is up after it, or was lifted at all if nothing is drawn.
    pub(super) lifts: bool,
    /// Whether it cuts off the rest of the branch.
    pub(super) cuts: bool,
    /// Extent and appearance of its drawing, if it draws.
    pub(super) drawn: Option<ModuleDrawing<F>>,
    /// Whether the effect is independent of draws. Otherwise it bounds the effects of all draws.
    pub(super) is_exact: bool,
    /// Whether it is certain to draw something, if it can.
    pub(super) is_sure: bool,
    /// Number of modules that are read to compute it.
    pub(super) work: u64,
}

/// Extent and appearance of a module's drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ModuleDrawing<F: TurtleFrame = Frame2> {
    /// Bound on the distance of the drawing from the start.
    pub(super) reach: Far<F::Point>,
    /// Nominal length: the distance by which it moves the turtle, but at least a fixed share of `reach`.
    pub(super) size: Far<F::Point>,
    /// Position of the part that may reach farthest.
    pub(super) tip: Far<F::Point>,
    /// Attributes of the first line.
    pub(super) first: StrokeAttributes,
    /// Attributes of the last line.
    pub(super) last: StrokeAttributes,
}

/// Least nominal length, as a share of the reach.
const SHARE: f64 = 0.25;

impl<F: TurtleFrame> ModuleDrawing<F> {
    /// Returns the nominal length if the turtle is moved to a pose.
    pub(super) fn size_of(&self, pose: &Pose<F>) -> Far<F::Point> {
        self.reach.times(SHARE).longer(pose.away())
    }
}

/// Effects of all kinds of modules, computed from the bottom up.
#[derive(Debug)]
pub(super) struct Effects<F: TurtleFrame = Frame2> {
    pub(super) system: Arc<F::System>,
    pub(super) compass: Compass,
    pub(super) kinds: Kinds,
    /// Whether symbols change colours.
    is_coloured: bool,
    /// Effects by the number of steps that are left, less 1, and by kind; most kinds have none.
    levels: Vec<Vec<Option<Box<Effect<F>>>>>,
}

impl<F: SummedFrame> Effects<F> {
    /// Computes the effects for all numbers of steps up to `steps`, of all kinds that occur within them.
    pub(super) fn of_system(system: &F::System, steps: u32) -> Result<Self, NotCompiled> {
        if F::depends_on_the_way(system) {
            return Err(NotCompiled);
        }
        let kinds = Kinds::of(F::words(system), steps, MAX_KINDS)?;
        Self::of_kinds(system, kinds, steps, work::MAX_WORK)
    }

    /// Computes the effects for all numbers of steps up to `steps`, of all kinds that ever occur.
    pub(super) fn closed(system: &F::System, steps: u32) -> Result<Self, NotCompiled> {
        let mut kinds = Kinds::of(F::words(system), u32::MAX, MAX_CLOSED)?;
        kinds.all.iter_mut().for_each(|kind| kind.born = 0);
        Self::of_kinds(system, kinds, steps, work::MAX_CLOSED_WORK)
    }

    fn of_kinds(
        system: &F::System,
        kinds: Kinds,
        steps: u32,
        most: u64,
    ) -> Result<Self, NotCompiled> {
        let words = F::words(system);
        work::check(words, &kinds, steps, most)?;
        let mut effects = Self {
            system: Arc::new(system.clone()),
            compass: Compass::of(words),
            is_coloured: words.has_colours(),
            kinds,
            levels: Vec::new(),
        };
        let mut bits = None;
        loop {
            work::check_long(effects.words(), &effects.kinds, steps, bits)?;
            let mut ways = F::Sums::new(effects.compass, bits);
            effects.levels.clear();
            let mut expanded = 0;
            for left in 1..=steps {
                let known: Result<Vec<_>, _> = (0..effects.kinds.all.len())
                    .map(|kind| effects.of_level(kind, left, steps, &mut expanded))
                    .collect();
                let mut known = known?;
                ways.advance(&effects, left, &mut known);
                effects.levels.push(known);
            }
            bits = ways.too_few();
            if bits.is_none() {
                return Ok(effects);
            }
        }
    }
}

impl<F: TurtleFrame> Effects<F> {
    /// Returns the symbols, words and productions of the system.
    pub(super) fn words(&self) -> &LSystem {
        F::words(&self.system)
    }

    /// Returns the colours that symbols change, if any does.
    pub(super) fn palette(&self) -> Option<&Palette> {
        let palette = &self.words().metadata().style.palette;
        Some(palette).filter(|_| self.is_coloured)
    }

    /// Computes the effect of a kind with `left` steps left; `None` if it is not replaced, or does not
    /// occur with so many left. `expanded` counts modules of words that are expanded.
    fn of_level(
        &self,
        kind: usize,
        left: u32,
        steps: u32,
        expanded: &mut u64,
    ) -> Result<Option<Box<Effect<F>>>, NotCompiled> {
        let of = &self.kinds.all[kind];
        if !of.is_fertile() || of.born > steps - left {
            return Ok(None);
        }
        let effects = of.alternatives.iter().map(|alternative| {
            let mut reader = Reader::new(self, TurtleState::SAME, false);
            reader.read(&alternative.word, left - 1, Path::of_seed(0))?;
            work::spend(expanded, reader.expanded, work::MAX_WORK)?;
            reader.effect()
        });
        let effects: Vec<Effect<F>> = effects.collect::<Result<_, _>>()?;
        match effects.as_slice() {
            [only] => Ok(Some(Box::new(only.clone()))),
            _ => Ok(Some(Box::new(Effect::of_any(&effects)?))),
        }
    }

    /// Returns the effect of a kind at a path.
    pub(super) fn of_path(
        &self,
        kind: usize,
        left: u32,
        path: Path,
    ) -> Result<Cow<'_, Effect<F>>, NotCompiled> {
        let known = self.of(kind, left)?;
        if known.is_exact {
            return Ok(Cow::Borrowed(known));
        }
        let of = &self.kinds.all[kind];
        let mut reader = Reader::new(self, TurtleState::SAME, true);
        reader.read(&of.alternatives[of.drawn(path)].word, left - 1, path)?;
        let mut effect = reader.effect()?;
        // The nominal length must be independent of the path.
        effect.drawn = effect.drawn.map(|drawn| ModuleDrawing {
            reach: known.drawn.map_or(drawn.reach, |drawn| drawn.reach),
            size: known.drawn.map_or(drawn.size, |drawn| drawn.size),
            ..drawn
        });
        Ok(Cow::Owned(effect))
    }

    /// Returns the effect of a kind with `left` steps left.
    pub(super) fn of(&self, kind: usize, left: u32) -> Result<&Effect<F>, NotCompiled> {
        self.levels[left as usize - 1][kind]
            .as_deref()
            .ok_or(NotCompiled)
    }

    /// Returns whether a kind is a closing bracket.
    pub(super) fn pops(&self, kind: usize) -> bool {
        let meaning = &self.words().symbols()[self.kinds.all[kind].symbol].meaning;
        matches!(meaning.first(), Some(Action::Pop))
    }

    /// Returns the drawing of a kind with `left` steps left.
    pub(super) fn drawn_by(&self, kind: usize, left: u32) -> Result<ModuleDrawing<F>, NotCompiled> {
        self.of(kind, left)?.drawn.ok_or(NotCompiled)
    }

    /// Returns the position of the turtle after a kind with `left` steps left.
    pub(super) fn place_after(&self, kind: usize, left: u32) -> Far<F::Point> {
        let effect = self.of(kind, left);
        effect.map_or(Far::ZERO, |effect| effect.state.pose.place)
    }
}

impl<F: TurtleFrame> Effect<F> {
    /// Returns an effect that bounds several alternatives: with the largest reach, and only their common
    /// properties.
    fn of_any(all: &[Self]) -> Result<Self, NotCompiled> {
        let [first, others @ ..] = all else {
            return Err(NotCompiled);
        };
        let mut any = first.clone();
        any.is_exact = false;
        for other in others {
            let (a, b) = (&mut any.state, &other.state);
            // The objects of later modules must not depend on draws.
            let (looks, other_looks) = ((a.attributes, a.joint), (b.attributes, b.joint));
            if looks != other_looks || a.pose.scale != b.pose.scale || any.cuts != other.cuts {
                return Err(NotCompiled);
            }
            let way = a.pose.away().longer(b.pose.away());
            a.pose.is_rough |= !a.pose.is_like(&b.pose);
            a.pose.way = way;
            any.lifts |= other.lifts;
            any.is_sure &= other.is_sure && any.drawn.is_some() == other.drawn.is_some();
            any.work = any.work.max(other.work);
            any.drawn = match (any.drawn, other.drawn) {
                (Some(a), Some(b)) => Some(ModuleDrawing {
                    reach: a.reach.longer(b.reach),
                    size: a.size.longer(b.size),
                    ..a
                }),
                (a, b) => a.or(b),
            };
        }
        Ok(any)
    }
}
