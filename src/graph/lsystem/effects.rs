use crate::lsystem::{Compass, LSystem};
use crate::rule::draw::Path;

use super::NotCompiled;
use super::far::Far;
use super::kinds::Kinds;
use super::reader::Reader;
use super::state::{Look, State};

/// What a module comes to in some steps, told from where the turtle meets it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Effect {
    /// How it leaves the turtle.
    pub(super) state: State,
    /// Whether the pen is up afterwards, or was in between if nothing is drawn.
    pub(super) lifts: bool,
    /// What it draws, if it does.
    pub(super) drawn: Option<Drawn>,
}

/// What a module draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Drawn {
    /// All of it lies no farther than this.
    pub(super) reach: Far,
    /// How long it counts: as far as it leads the turtle, unless it reaches much farther.
    pub(super) size: Far,
    /// Where what may be farthest stands.
    pub(super) tip: Far,
    /// How the first and the last line look.
    pub(super) first: Look,
    pub(super) last: Look,
}

/// The effects of all kinds, from the bottom up.
pub(super) struct Effects<'s> {
    pub(super) system: &'s LSystem,
    pub(super) compass: Compass,
    pub(super) kinds: Kinds,
    /// By the number of steps that are left, less 1, and by kind.
    levels: Vec<Vec<Option<Effect>>>,
}

impl<'s> Effects<'s> {
    /// Those in all numbers of steps up to one, of all kinds that are met within it.
    pub(super) fn of_system(system: &'s LSystem, steps: u32) -> Result<Self, NotCompiled> {
        Self::of_kinds(system, Kinds::of(system, steps)?, steps)
    }

    /// Those of all kinds that are ever met.
    pub(super) fn closed(system: &'s LSystem, steps: u32) -> Result<Self, NotCompiled> {
        let mut kinds = Kinds::of(system, u32::MAX)?;
        kinds.all.iter_mut().for_each(|kind| kind.born = 0);
        Self::of_kinds(system, kinds, steps)
    }

    fn of_kinds(system: &'s LSystem, kinds: Kinds, steps: u32) -> Result<Self, NotCompiled> {
        let mut effects = Self {
            system,
            compass: Compass::of(system),
            kinds,
            levels: Vec::new(),
        };
        for left in 1..=steps {
            let known: Result<Vec<_>, _> = (0..effects.kinds.all.len())
                .map(|kind| effects.of_level(kind, left, steps))
                .collect();
            effects.levels.push(known?);
        }
        Ok(effects)
    }

    /// What a kind comes to in a number of steps, if it is met with so many left.
    fn of_level(&self, kind: usize, left: u32, steps: u32) -> Result<Option<Effect>, NotCompiled> {
        let of = &self.kinds.all[kind];
        if !of.is_fertile() || of.born > steps - left {
            return Ok(None);
        }
        let mut reader = Reader::new(self, State::SAME);
        let [only] = of.alternatives.as_slice() else {
            return Err(NotCompiled);
        };
        reader.read(&only.word, left - 1, Path::of_seed(0))?;
        reader.effect().map(Some)
    }

    /// What a kind comes to in a number of steps.
    pub(super) fn of(&self, kind: usize, left: u32) -> Result<&Effect, NotCompiled> {
        self.levels[left as usize - 1][kind]
            .as_ref()
            .ok_or(NotCompiled)
    }

    /// What a kind draws in a number of steps.
    pub(super) fn drawn_by(&self, kind: usize, left: u32) -> Result<Drawn, NotCompiled> {
        self.of(kind, left)?.drawn.ok_or(NotCompiled)
    }

    /// Where the turtle is after what a kind comes to.
    pub(super) fn place_after(&self, kind: usize, left: u32) -> Far {
        let effect = self.of(kind, left);
        effect.map_or(Far::ZERO, |effect| effect.state.pose.place)
    }
}
