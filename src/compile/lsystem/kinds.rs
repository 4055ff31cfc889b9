//! Kinds of modules: the symbols with arguments that occur in the derivation of a context-free L-system.

use std::collections::BTreeMap;

use crate::draws::{Path, pick_by_weight};
use crate::expression::Program;
use crate::lsystem::{Action, LSystem};

use super::NotCompiled;

/// Limit of the number of kinds.
pub(super) const MAX_KINDS: usize = 1 << 14;

/// Limit of the number of kinds where all that ever occur are required.
pub(super) const MAX_CLOSED: usize = 1 << 8;

/// Number of arguments that count as a module.
const ARGUMENTS: usize = 8;

/// Limit of the total length of the words.
const MAX_MODULES: usize = 1 << 18;

/// Module with its arguments.
#[derive(Debug)]
pub(super) struct ModuleKind {
    pub(super) symbol: usize,
    pub(super) arguments: Vec<f64>,
    /// Words of which one replaces it; empty if it is not replaced.
    pub(super) alternatives: Vec<Alternative>,
    /// First step that yields one.
    pub(super) born: u32,
}

/// Word that may replace a module.
#[derive(Debug)]
pub(super) struct Alternative {
    weight: f64,
    /// Modules of the word, by kind.
    pub(super) word: Vec<usize>,
}

/// All kinds of modules that occur within some steps. Productions without contexts depend only on the
/// arguments of their predecessors.
#[derive(Debug)]
pub(super) struct Kinds {
    pub(super) all: Vec<ModuleKind>,
    pub(super) axiom: Vec<usize>,
}

struct KindFinder<'s> {
    system: &'s LSystem,
    most: usize,
    all: Vec<ModuleKind>,
    numbers: BTreeMap<(usize, Vec<u64>), usize>,
    modules: usize,
}

impl Kinds {
    pub(super) fn of(system: &LSystem, steps: u32, most: usize) -> Result<Self, NotCompiled> {
        if !system.is_context_free() || system.depends_on_the_way() {
            return Err(NotCompiled);
        }
        let mut finder = KindFinder {
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
        // Kinds are found in the order of the steps that yield them.
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

impl KindFinder<'_> {
    fn kind(&mut self, symbol: usize, arguments: &[f64], born: u32) -> Result<usize, NotCompiled> {
        if !arguments.iter().all(|value| value.is_finite()) {
            return Err(NotCompiled);
        }
        let bits = arguments.iter().map(|value| value.to_bits()).collect();
        let made = self.all.len();
        let number = *self.numbers.entry((symbol, bits)).or_insert(made);
        self.modules += 1 + arguments.len() / ARGUMENTS;
        if number == made {
            self.all.push(ModuleKind {
                symbol,
                arguments: arguments.to_vec(),
                alternatives: Vec::new(),
                born,
            });
        }
        if made >= self.most || self.modules > MAX_MODULES {
            return Err(NotCompiled);
        }
        Ok(number)
    }

    /// Returns the successors of a kind: that of the first production that applies or, if it has a
    /// weight, those of all applicable productions with weights.
    fn alternatives(&mut self, number: usize) -> Result<Vec<Alternative>, NotCompiled> {
        let system = self.system;
        let ModuleKind { symbol, born, .. } = self.all[number];
        let arguments = self.all[number].arguments.clone();
        let all = system.symbols()[symbol].productions.iter();
        let conditions = all
            .clone()
            .filter_map(|number| system.productions()[*number].condition.as_ref());
        self.modules += conditions.map(Program::work).sum::<usize>();
        let mut fitting = all.filter(|&&number| {
            let condition = system.productions()[number].condition.as_ref();
            condition.is_none_or(|condition| condition.holds(&arguments))
        });
        let Some(&first) = fitting.next() else {
            return Ok(Vec::new());
        };
        // The brackets of replaced modules would begin and end in different words.
        let encloses = |action: &Action| {
            matches!(
                action,
                Action::Push | Action::Pop | Action::Open | Action::Close | Action::Cut
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
            // A module is another kind with every draw.
            if !written.variables.is_empty() {
                return Err(NotCompiled);
            }
            let mut word = Vec::with_capacity(written.successor.len());
            for template in &written.successor {
                self.modules += template.arguments.iter().map(Program::work).sum::<usize>();
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

impl ModuleKind {
    /// Returns whether the kind is replaced.
    pub(super) fn is_fertile(&self) -> bool {
        !self.alternatives.is_empty()
    }

    /// Draws the number of the word that replaces the kind at a path.
    pub(super) fn drawn(&self, path: Path) -> usize {
        match self.alternatives.as_slice() {
            [_] => 0,
            all => pick_by_weight(path, all.iter().map(|alternative| alternative.weight)),
        }
    }
}
