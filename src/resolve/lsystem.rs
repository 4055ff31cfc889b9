//! Resolution of L-systems.

mod alphabet;
mod check;
mod space;
mod stamps;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::Place;
use crate::document::{
    LSystemDocument, ModuleDocument, ProductionDocument, WordDocument, Written, WrittenNumber,
};
use crate::expression::{Program, Scope, is_reserved};
use crate::lsystem::{Action, Context, LSystem, Module, Origin, Production, Symbol, Template};
use crate::metadata::Metadata;
use crate::readable::grouped;
use crate::style::ColorBy;

use super::Resolver;

/// Maximum nesting depth of branches in a right context, which are matched by recursion.
const MAX_BRANCHES: i32 = 64;

/// Limit of the actions of all modules of a file together, with those that symbols list.
const MAX_ACTIONS: usize = 100_000;

/// State that is specific to L-systems.
#[derive(Default)]
pub(super) struct OfLSystem {
    symbols: Vec<Symbol>,
    /// Number of actions of the modules and lists so far; at most one more than the limit.
    actions: usize,
    numbers: BTreeMap<(char, usize), usize>,
    is_in_space: bool,
    /// Names of the stamps, with the numbers of their base elements.
    stamps: Vec<(String, Range<usize>)>,
    /// Numbers of the stamps by name.
    stamp_numbers: BTreeMap<String, usize>,
    /// Symbols that place stamps, by stamp and number of arguments besides its name.
    placing: BTreeMap<(usize, usize), usize>,
    /// The file's own interpretations of symbols.
    own: BTreeMap<(char, usize), Arc<[Action]>>,
    /// Angle increment of `+` and `-`, in degrees.
    angle: f64,
    /// Factor by which `!` multiplies the width.
    thinning: f64,
    /// Parameters of the file.
    constants: Arc<Scope>,
}

impl Resolver<OfLSystem> {
    /// Resolves words and productions. Reports mistakes and returns `None`.
    fn lsystem(&mut self, document: &LSystemDocument, metadata: Metadata) -> Option<LSystem> {
        self.kind.constants = Arc::new(self.constants.clone());
        self.kind.angle = self.number_or(document.angle.as_ref(), 90.0);
        self.kind.thinning = self.number_or(document.thinning.as_ref(), 0.7);
        let start = self.number_or(document.start.as_ref(), 0.0);
        let length = self.number_or(document.length.as_ref(), 1.0);
        if let Some(number) = &document.length
            && length <= 0.0
        {
            self.error(&number.place, "the length of a step is above 0");
        }
        if let Some(number) = &document.thinning
            && self.kind.thinning < 0.0
        {
            self.error(&number.place, "a width cannot be negative");
        }
        for symbol in &document.symbols {
            self.define(symbol);
        }
        let random = self.checked_variables(&document.random);
        let axiom = document.axiom.as_ref().map(|word| self.axiom(word));
        let productions: Vec<_> = { &document.productions }
            .iter()
            .filter_map(|production| self.production(production, random))
            .collect();
        if productions.len() < document.productions.len() || self.diagnostics.has_errors() {
            return None;
        }
        let ignored: BTreeSet<char> = document.ignored.iter().copied().collect();
        for symbol in &mut self.kind.symbols {
            symbol.ignored = ignored.contains(&symbol.character);
        }
        for with_context in [true, false] {
            for (number, production) in productions.iter().enumerate() {
                if production.has_context() == with_context {
                    let of = &mut self.kind.symbols[production.predecessor].productions;
                    of.push(number);
                }
            }
        }
        let mut system = LSystem {
            metadata,
            start,
            length,
            symbols: std::mem::take(&mut self.kind.symbols),
            axiom: axiom?,
            productions,
            stamps: Vec::new(),
            in_limit: false,
            growing: None,
        };
        if system.has_colours() && !document.metadata.sets_colours {
            system.metadata.style.color_by = ColorBy::Tint;
        }
        self.check_weights(document, &system);
        self.warn_of_unused(document, &system);
        Some(system)
    }

    /// Reports mistakes in variables, whether a production uses them or not, and returns as many as there may be.
    fn checked_variables<'d>(
        &mut self,
        random: &'d [(Written<String>, WrittenNumber)],
    ) -> &'d [(Written<String>, WrittenNumber)] {
        let random = self.limited(random, "an L-system");
        let mut scope = Scope::inside(&self.kind.constants);
        self.variables(random, &mut scope, 0, false);
        random
    }

    fn number_or(&mut self, number: Option<&WrittenNumber>, default: f64) -> f64 {
        number.map_or(default, |number| self.constant(number).unwrap_or(default))
    }

    fn axiom(&mut self, word: &WordDocument) -> Vec<Module> {
        if word.complete && word.modules.is_empty() {
            let hint = "axiom: F";
            self.error_with_hint(&word.place, "the axiom is empty", hint);
        }
        let scope = Arc::clone(&self.kind.constants);
        let templates = self.word(word, &scope);
        let modules = templates.into_iter().map(|template| Module {
            symbol: template.symbol,
            arguments: { template.arguments.iter() }
                .map(|program| program.eval(&[]))
                .collect(),
        });
        modules.collect()
    }

    /// Counts actions at a place of the file before they are written out. Reports the place at which they become too many
    /// and returns `false` from there on.
    fn spend(&mut self, actions: usize, place: &Place) -> bool {
        if self.kind.actions > MAX_ACTIONS {
            return false;
        }
        self.kind.actions = (self.kind.actions.saturating_add(actions)).min(MAX_ACTIONS + 1);
        let fits = self.kind.actions <= MAX_ACTIONS;
        if !fits {
            let most = grouped(&MAX_ACTIONS.into());
            let message = format!("the modules up to here have more than {most} actions together");
            let hint = "shorter lists of actions under `symbols`, stamps of fewer base elements, or shorter words: a few \
                        more steps make long words";
            self.error_with_hint(place, message, hint);
        }
        fits
    }

    /// Resolves a word and checks that its brackets are balanced.
    fn word(&mut self, word: &WordDocument, scope: &Scope) -> Vec<Template> {
        let templates: Vec<_> = { word.modules.iter() }
            .map(|module| Template {
                symbol: self.symbol(module),
                arguments: { self.arguments(module).iter() }
                    .map(|number| self.program(number, scope))
                    .collect(),
            })
            .collect();
        if word.complete {
            let symbols: Vec<_> = templates.iter().map(|template| template.symbol).collect();
            self.check_balance(&word.modules, &symbols);
        }
        templates
    }

    /// Resolves a production whose successor may use the variables of `random`.
    fn production(
        &mut self,
        document: &ProductionDocument,
        random: &[(Written<String>, WrittenNumber)],
    ) -> Option<Production> {
        let mistakes = self.mistakes;
        let mut scope = Scope::inside(&self.kind.constants);
        let replaced = std::slice::from_ref(&document.predecessor);
        let sides = [&document.left[..], replaced, &document.right];
        let mut slots = 0;
        for module in sides.into_iter().flatten() {
            self.names(module, &mut scope, &mut slots);
        }
        let [left, replaced, right] =
            sides.map(|side| -> Vec<_> { side.iter().map(|module| self.symbol(module)).collect() });
        let predecessor = *replaced.first()?;
        let is_bracket = |action: &Action| {
            use Action::{Close, Open, Pop, Push};
            matches!(action, Push | Pop | Open | Close)
        };
        if { &self.kind.symbols[predecessor].meaning }
            .iter()
            .any(is_bracket)
        {
            let message = "a bracket cannot be replaced";
            self.error(&document.predecessor.place, message);
        }
        for (module, &number) in document.left.iter().zip(&left) {
            let symbol = &self.kind.symbols[number];
            if symbol.is_push() || symbol.is_pop() {
                let message = "a left context has no brackets";
                let hint = "it is what stands on the way from the root, over the brackets";
                self.error_with_hint(&module.place, message, hint);
            }
        }
        self.check_balance(&document.right, &right);
        let mut depth = 0;
        for (module, &number) in document.right.iter().zip(&right) {
            depth += i32::from(self.kind.symbols[number].is_push());
            depth -= i32::from(self.kind.symbols[number].is_pop());
            if depth > MAX_BRANCHES {
                let message = "this context is nested too deeply";
                let hint = format!("{MAX_BRANCHES} branches at most");
                self.error_with_hint(&module.place, message, hint);
                break;
            }
        }
        let condition = document.condition.as_ref();
        let condition = condition.map(|number| self.condition(number, &scope));
        let weight = document.weight.as_ref();
        let weight = weight.map(|number| self.weight(number, &scope));
        let arguments = { document.successor.modules.iter() }.flat_map(|it| self.arguments(it));
        let mut names = arguments.flat_map(|number| number.value.names());
        let draws =
            names.any(|(name, _)| random.iter().any(|(variable, _)| variable.value == name));
        let variables = match draws {
            true => self.variables(random, &mut scope, slots, false),
            false => Vec::new(),
        };
        let successor = self.word(&document.successor, &scope);
        let symbols = &self.kind.symbols;
        (self.mistakes == mistakes).then(|| Production {
            origin: Origin(document.successor.place.clone()),
            predecessor,
            left,
            right: { right.into_iter() }
                .map(|number| match &symbols[number] {
                    symbol if symbol.is_push() => Context::Open,
                    symbol if symbol.is_pop() => Context::Close,
                    _ => Context::Symbol(number),
                })
                .collect(),
            condition,
            successor,
            weight,
            variables,
        })
    }

    /// Adds the names of a module's arguments to a scope, as variables from slot `slots` on.
    fn names(&mut self, module: &ModuleDocument, scope: &mut Scope, slots: &mut usize) {
        for number in &module.arguments {
            let slot = *slots;
            *slots += 1;
            let Some(name) = number.value.as_name() else {
                if !number.value.is_unknown() {
                    let message = "arguments have names here";
                    let hint = "A(w); where one value is meant, it is written as a condition: A(w) : w == 1 -> F";
                    self.error_with_hint(&number.place, message, hint);
                }
                continue;
            };
            if is_reserved(name) {
                let message = format!("'{name}' has a meaning of its own in expressions");
                self.error_with_hint(&number.place, message, "give the argument another name");
            } else if self.kind.constants.contains(name) {
                let message = format!("'{name}' is a parameter of the file already");
                self.error_with_hint(&number.place, message, "give the argument another name");
            } else if scope.contains(name) {
                let message = format!("the name '{name}' is there twice");
                self.error_with_hint(&number.place, message, "give each argument its own name");
            }
            self.used.insert(name.to_owned());
            scope.variable(name, slot);
        }
    }

    /// Refuses a symbol whose productions with weights all have the constant weight 0.
    fn check_weights(&mut self, document: &LSystemDocument, system: &LSystem) {
        for symbol in &system.symbols {
            let weights = { symbol.productions.iter() }.filter_map(|&number| {
                let weight = system.productions[number].weight.as_ref()?;
                Some((number, weight.as_constant()))
            });
            let weights: Vec<_> = weights.collect();
            if let Some((first, _)) = weights.first()
                && weights.iter().all(|(_, weight)| *weight == Some(0.0))
                && let Some(number) = &document.productions[*first].weight
            {
                let message = format!(
                    "no production of '{}' has a weight above 0",
                    symbol.character
                );
                self.error(&number.place, message);
            }
        }
    }
}

/// Compiles an expression of the only argument, x, of a module.
fn of_argument(text: &str) -> Program {
    let mut scope = Scope::new();
    scope.variable("x", 0);
    let expression = crate::expression::Expression::parse(text);
    let program = expression.and_then(|expression| expression.compile(&scope));
    program.unwrap_or_else(|_| unreachable!("the texts are those of this file"))
}
