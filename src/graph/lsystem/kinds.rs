use std::collections::BTreeMap;

use crate::lsystem::{Action, LSystem};
use crate::rule::draw::{Path, pick_by_weight};

use super::NotCompiled;

/// No more kinds of modules than this are told apart,
pub(super) const MOST_KINDS: usize = 1 << 14;

/// nor than this where all that are ever met must come back.
pub(super) const MOST_CLOSED: usize = 1 << 8;

/// Words are no longer than this, all together.
const MOST_MODULES: usize = 1 << 18;

/// A module with its arguments.
#[derive(Debug)]
pub(super) struct Kind {
    pub(super) symbol: usize,
    pub(super) arguments: Vec<f64>,
    /// What may replace it; nothing does if there is none.
    pub(super) alternatives: Vec<Alternative>,
    /// The first step that makes one.
    pub(super) born: u32,
}

/// What may replace a module.
#[derive(Debug)]
pub(super) struct Alternative {
    weight: f64,
    /// The modules, by kind.
    pub(super) word: Vec<usize>,
}

/// All kinds of modules that are met within some steps: the predecessors of productions without contexts
/// need no more than their arguments to be replaced.
#[derive(Debug)]
pub(super) struct Kinds {
    pub(super) all: Vec<Kind>,
    pub(super) axiom: Vec<usize>,
}

struct Finder<'s> {
    system: &'s LSystem,
    most: usize,
    all: Vec<Kind>,
    numbers: BTreeMap<(usize, Vec<u64>), usize>,
    modules: usize,
}

impl Kinds {
    pub(super) fn of(system: &LSystem, steps: u32, most: usize) -> Result<Self, NotCompiled> {
        if !system.is_context_free() || system.depends_on_the_way() {
            return Err(NotCompiled);
        }
        let mut finder = Finder {
            system,
            most,
            all: Vec::new(),
            numbers: BTreeMap::new(),
            modules: 0,
        };
        let axiom = system.axiom().iter();
        let axiom = axiom.map(|module| finder.kind(module.symbol, &module.arguments, 0));
        let axiom = axiom.collect::<Result<_, _>>()?;
        let mut next = 0;
        // Kinds are found in the order of the steps that make them.
        while next < finder.all.len() {
            if finder.all[next].born < steps {
                finder.all[next].alternatives = finder.alternatives(next)?;
            }
            next += 1;
        }
        Ok(Self {
            all: finder.all,
            axiom,
        })
    }
}

impl Finder<'_> {
    fn kind(&mut self, symbol: usize, arguments: &[f64], born: u32) -> Result<usize, NotCompiled> {
        if !arguments.iter().all(|value| value.is_finite()) {
            return Err(NotCompiled);
        }
        let bits = arguments.iter().map(|value| value.to_bits()).collect();
        let made = self.all.len();
        let number = *self.numbers.entry((symbol, bits)).or_insert(made);
        self.modules += 1;
        if number == made {
            self.all.push(Kind {
                symbol,
                arguments: arguments.to_vec(),
                alternatives: Vec::new(),
                born,
            });
        }
        if made >= self.most || self.modules > MOST_MODULES {
            return Err(NotCompiled);
        }
        Ok(number)
    }

    /// The productions of which one replaces a kind: the first that fits or, if that has a weight, all
    /// that have one.
    fn alternatives(&mut self, number: usize) -> Result<Vec<Alternative>, NotCompiled> {
        let system = self.system;
        let Kind { symbol, born, .. } = self.all[number];
        let arguments = self.all[number].arguments.clone();
        let all = system.symbols()[symbol].productions.iter();
        let mut fitting = all.filter(|&&number| {
            let condition = system.productions()[number].condition.as_ref();
            condition.is_none_or(|condition| condition.holds(&arguments))
        });
        let Some(&first) = fitting.next() else {
            return Ok(Vec::new());
        };
        // Brackets that are replaced end and begin elsewhere.
        let encloses = |action: &Action| {
            matches!(
                action,
                Action::Push | Action::Pop | Action::Open | Action::Close
            )
        };
        if system.symbols()[symbol].meaning.iter().any(encloses) {
            return Err(NotCompiled);
        }
        let mut numbers = vec![first];
        if system.productions()[first].weight.is_some() {
            numbers.extend(fitting.filter(|&&other| system.productions()[other].weight.is_some()));
        }
        let mut alternatives = Vec::new();
        for production in numbers {
            let written = &system.productions()[production];
            let mut word = Vec::with_capacity(written.successor.len());
            for template in &written.successor {
                let values = template
                    .arguments
                    .iter()
                    .map(|value| value.eval(&arguments));
                let values: Vec<f64> = values.collect();
                word.push(self.kind(template.symbol, &values, born + 1)?);
            }
            let weight = written.weight.as_ref();
            alternatives.push(Alternative {
                weight: weight.map_or(1.0, |weight| weight.eval(&arguments).max(0.0)),
                word,
            });
        }
        Ok(alternatives)
    }
}

impl Kind {
    /// Whether it is replaced.
    pub(super) fn is_fertile(&self) -> bool {
        !self.alternatives.is_empty()
    }

    /// The number of what replaces it at a path.
    pub(super) fn drawn(&self, path: Path) -> usize {
        match self.alternatives.as_slice() {
            [_] => 0,
            all => pick_by_weight(path, all.iter().map(|alternative| alternative.weight)),
        }
    }
}
