//! Checks of words, and warnings of productions and symbols without effect.

use std::collections::BTreeMap;

use crate::document::{LSystemDocument, ModuleDocument};
use crate::lsystem::{Action, LSystem, Symbol};
use crate::resolve::Resolver;

use super::{MAX_ACTIONS, OfLSystem};

/// Maximum number of unbalanced brackets that are reported in a word.
const MAX_NAMED: usize = 20;

impl Resolver<OfLSystem> {
    /// Reports unbalanced brackets and polygons in a word.
    pub(super) fn check_balance(&mut self, modules: &[ModuleDocument], symbols: &[usize]) {
        // Beyond the limit of actions, symbols have no brackets.
        if self.kind.actions > MAX_ACTIONS {
            return;
        }
        let bracket = |action: &Action| match action {
            Action::Push => 1,
            Action::Pop => -1,
            _ => 0,
        };
        self.check_pairs(modules, symbols, bracket, ["bracket", "]"]);
        let polygon = |action: &Action| match action {
            Action::Open => 1,
            Action::Close => -1,
            _ => 0,
        };
        self.check_pairs(modules, symbols, polygon, ["polygon", "}"]);
    }

    /// Reports unbalanced pairs of actions. `change` is the change of the number of open pairs by an
    /// action.
    fn check_pairs(
        &mut self,
        modules: &[ModuleDocument],
        symbols: &[usize],
        change: fn(&Action) -> i32,
        [what, closing]: [&str; 2],
    ) {
        let mut open = Vec::new();
        let mut named = 0;
        for (module, &symbol) in modules.iter().zip(symbols) {
            let meaning = &self.kind.symbols[symbol].meaning;
            let changes: Vec<_> = meaning.iter().map(change).collect();
            for change in changes {
                if change > 0 {
                    open.push(module);
                } else if change < 0 && open.pop().is_none() && named < MAX_NAMED {
                    named += 1;
                    let message = format!("no {what} is open here");
                    let hint = "what a word closes, it has opened: a successor as well";
                    self.error_with_hint(&module.place, message, hint);
                }
            }
        }
        for module in open.into_iter().take(MAX_NAMED) {
            let message = format!("this {what} is not closed");
            let hint = format!("it ends with '{closing}' in the same word");
            self.error_with_hint(&module.place, message, hint);
        }
    }

    /// Warns of symbols that never occur, of productions that never apply, and of systems that draw
    /// nothing.
    pub(super) fn warn_of_unused(&mut self, document: &LSystemDocument, system: &LSystem) {
        if self.incomplete {
            return;
        }
        let reached = reached(system);
        // The first symbol of each character that occurs.
        let mut occurring: BTreeMap<char, &Symbol> = BTreeMap::new();
        for (symbol, _) in system.symbols.iter().zip(&reached).filter(|it| *it.1) {
            occurring.entry(symbol.character).or_insert(symbol);
        }
        let places = document.productions.iter().zip(&system.productions);
        for (written, production) in places.clone() {
            let replaced = &written.predecessor;
            if !reached[production.predecessor] {
                self.never(replaced, &occurring, "its production");
                continue;
            }
            let around = written.left.iter().chain(&written.right);
            for module in around {
                let seen = |&number: &usize| system.symbols[number].ignored;
                let number = self
                    .kind
                    .numbers
                    .get(&(module.character, module.arguments.len()));
                if number.is_some_and(seen) {
                    let message = format!("contexts do not see '{}'", module.character);
                    let hint = "it is one of those to `ignore`, so that this never fits";
                    self.warn(&module.place, message, hint);
                }
            }
        }
        for written in &document.symbols {
            let symbol = &written.symbol;
            if !occurring.contains_key(&symbol.character) {
                self.never(symbol, &occurring, "its meaning");
            }
        }
        self.warn_of_hidden(document, system);
        let mut drawn = system.symbols.iter().zip(&reached);
        if !drawn.any(|(symbol, reached)| *reached && symbol.draws() > 0)
            && let Some(first) = document
                .axiom
                .as_ref()
                .and_then(|word| word.modules.first())
        {
            let hint = "F draws; symbols: {G: draw} lets another symbol draw as well";
            self.warn(&first.place, "nothing that comes of this draws", hint);
        }
    }

    /// Warns that a symbol never occurs, or occurs only with another number of arguments.
    fn never(&mut self, module: &ModuleDocument, occurring: &BTreeMap<char, &Symbol>, what: &str) {
        let character = module.character;
        let with = |arity: usize| match arity {
            0 => "without arguments".into(),
            1 => "with 1 argument".into(),
            arity => format!("with {arity} arguments"),
        };
        let (message, hint) = match occurring.get(&character) {
            Some(other) => (
                format!(
                    "'{character}' never occurs {}, but {}",
                    with(module.arguments.len()),
                    with(other.arity)
                ),
                format!("{what} is for as many arguments as are written here"),
            ),
            None => (
                format!("'{character}' never occurs"),
                format!("leave {what} out, or use the symbol"),
            ),
        };
        self.warn(&module.place, message, &hint);
    }

    /// Warns of productions that are hidden by an earlier one that always applies.
    fn warn_of_hidden(&mut self, document: &LSystemDocument, system: &LSystem) {
        for symbol in &system.symbols {
            // Whether the first production that always applies has a weight.
            let mut always: Option<bool> = None;
            for &number in &symbol.productions {
                let production = &system.productions[number];
                let weighted = production.weight.is_some();
                if always.is_some_and(|first_is_weighted| !(first_is_weighted && weighted)) {
                    let message = format!(
                        "another production of '{}' always comes before this one",
                        symbol.character
                    );
                    let hint = "give both a weight and one of them is drawn, or this one a condition \
                                and write it first";
                    self.warn(
                        &document.productions[number].predecessor.place,
                        message,
                        hint,
                    );
                } else if always.is_none()
                    && production.condition.is_none()
                    && !production.has_context()
                {
                    always = Some(weighted);
                }
            }
        }
    }
}

/// Determines for every symbol whether it can occur in a derivation, regardless of conditions and
/// contexts.
fn reached(system: &LSystem) -> Vec<bool> {
    let mut reached = vec![false; system.symbols.len()];
    let mut next: Vec<usize> = system.axiom.iter().map(|module| module.symbol).collect();
    while let Some(symbol) = next.pop() {
        if std::mem::replace(&mut reached[symbol], true) {
            continue;
        }
        for &production in &system.symbols[symbol].productions {
            let successor = system.productions[production].successor.iter();
            next.extend(successor.map(|template| template.symbol));
        }
    }
    reached
}
