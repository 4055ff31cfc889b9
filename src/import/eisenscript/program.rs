//! Programs of EisenScript: rules with alternatives, and the settings of a construction.

use crate::diagnostic::Place;
use crate::style::Colour;

use super::colour::Colouring;
use super::motion::Motion;

/// Number of the alternative with the actions outside all rules.
pub(super) const TOP: usize = 0;

/// A program whose names are resolved.
#[derive(Debug)]
pub(super) struct Program {
    /// Alternatives of all rules; the first one has the actions outside rules.
    pub(super) alternatives: Vec<Alternative>,
    /// Numbers of the alternatives of each rule.
    pub(super) rules: Vec<Rule>,
    pub(super) settings: Settings,
}

#[derive(Debug)]
pub(super) struct Rule {
    pub(super) name: String,
    pub(super) alternatives: Vec<usize>,
}

/// A definition of a rule.
#[derive(Debug)]
pub(super) struct Alternative {
    /// Number of the rule; `None` for the actions outside rules.
    pub(super) rule: Option<usize>,
    /// Place of the name.
    pub(super) place: Place,
    /// Weight in draws, not negative.
    pub(super) weight: f64,
    /// Number of times that the alternative is applied within itself, at least 1.
    pub(super) depth: Option<u32>,
    /// Target that is applied in place of the alternative after that.
    pub(super) successor: Option<Target>,
    pub(super) actions: Vec<Action>,
}

/// A call of a rule or of a primitive, once or in loops.
#[derive(Debug)]
pub(super) struct Action {
    /// Loops, of which the last one is applied first; one without loops has none.
    pub(super) loops: Vec<Loop>,
    pub(super) target: Target,
    pub(super) place: Place,
}

/// Rule or primitive that is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Target {
    /// Rule by number.
    Rule(usize),
    Primitive(Primitive),
    /// Sides between the lower face of the cube before a transformation and that after it.
    Mesh,
}

impl Target {
    /// Returns what a name that programs do not define stands for.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        match name {
            "mesh" => Some(Self::Mesh),
            _ => Primitive::from_name(name).map(Self::Primitive),
        }
    }
}

/// A transformation that is applied once, twice and so on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Loop {
    /// Number of copies, at least 1.
    pub(super) count: u32,
    pub(super) motion: Motion,
    pub(super) colouring: Colouring,
}

/// Shape that fills the unit cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Primitive {
    Box,
    Sphere,
    Cylinder,
    Line,
    Dot,
    Grid,
}

impl Primitive {
    const NAMES: [(&str, Self); 7] = [
        ("box", Self::Box),
        ("sphere", Self::Sphere),
        ("cylinder", Self::Cylinder),
        ("line", Self::Line),
        ("dot", Self::Dot),
        ("point", Self::Dot),
        ("grid", Self::Grid),
    ];

    pub(super) fn from_name(name: &str) -> Option<Self> {
        let mut names = Self::NAMES.iter();
        names.find(|(known, _)| *known == name).map(|(_, it)| *it)
    }

    pub(super) fn name(self) -> &'static str {
        let mut names = Self::NAMES.iter();
        names
            .find(|(_, it)| *it == self)
            .map_or("", |(name, _)| name)
    }
}

/// Settings of a construction.
#[derive(Debug)]
pub(super) struct Settings {
    /// Number of generations.
    pub(super) generations: u32,
    /// Number of objects, and of calls that wait, with which no further generation begins.
    pub(super) objects: u64,
    /// Seed of random draws.
    pub(super) seed: u64,
    pub(super) background: Option<Colour>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            generations: 1000,
            objects: 100_000,
            seed: 0,
            background: None,
        }
    }
}

impl Program {
    /// Returns the alternatives of the target of an action; a primitive has none.
    pub(super) fn alternatives_of(&self, target: Target) -> &[usize] {
        match target {
            Target::Rule(rule) => &self.rules[rule].alternatives,
            Target::Primitive(_) | Target::Mesh => &[],
        }
    }

    /// Returns the alternatives that an alternative calls or gives way to.
    pub(super) fn called(&self, alternative: usize) -> impl Iterator<Item = usize> + '_ {
        let alternative = &self.alternatives[alternative];
        let actions = alternative.actions.iter().map(|action| action.target);
        let targets = actions.chain(alternative.successor);
        targets.flat_map(|target| self.alternatives_of(target).iter().copied())
    }

    /// Returns for each alternative whether it draws a mesh that depends on the transformation of its call.
    pub(super) fn looks_back(&self) -> Vec<bool> {
        let mut all = vec![false; self.alternatives.len()];
        loop {
            let looks = |alternative: &Alternative| {
                let actions = alternative.actions.iter();
                let bare = actions.filter(|it| it.loops.is_empty()).map(|it| it.target);
                { bare.chain(alternative.successor) }.any(|target| {
                    target == Target::Mesh || self.alternatives_of(target).iter().any(|it| all[*it])
                })
            };
            let next: Vec<bool> = self.alternatives.iter().map(looks).collect();
            if next == all {
                return all;
            }
            all = next;
        }
    }

    /// Returns which alternatives some of them lead to, themselves included.
    pub(super) fn reached(&self, from: impl IntoIterator<Item = usize>) -> Vec<bool> {
        let mut reached = vec![false; self.alternatives.len()];
        let mut open: Vec<usize> = from.into_iter().collect();
        while let Some(next) = open.pop() {
            if !std::mem::replace(&mut reached[next], true) {
                open.extend(self.called(next));
            }
        }
        reached
    }
}
