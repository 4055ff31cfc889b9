//! Resolution of random variables.

use crate::document::{Written, WrittenNumber};
use crate::draws::{Distribution, Variable};
use crate::expression::{Program, Scope, Type, is_name, is_reserved};

use super::Resolver;

/// Name of the distribution of a draw for each edge.
pub(super) const BY_EDGE: &str = "by_edge";

/// Help text with the notation of distributions.
const DISTRIBUTIONS: &str = "uniform(a, b), normal(mean, deviation) or choice(a, b, ...)";

/// Largest number of variables that are drawn for a module or an object.
const MAX_VARIABLES: usize = 100;

impl<K> Resolver<K> {
    /// Returns as many variables as there may be, and reports one that is too many. `what` is the kind of file.
    pub(super) fn limited<'d>(
        &mut self,
        random: &'d [(Written<String>, WrittenNumber)],
        what: &str,
    ) -> &'d [(Written<String>, WrittenNumber)] {
        if let Some((name, _)) = random.get(MAX_VARIABLES) {
            let message = format!("{what} draws {MAX_VARIABLES} variables at most");
            self.error(&name.place, message);
        }
        &random[..random.len().min(MAX_VARIABLES)]
    }

    /// Resolves variables, which are drawn for every replacement, and adds them to a scope from slot `slots` on.
    /// `has_edges` states that draws may belong to edges.
    pub(super) fn variables(
        &mut self,
        random: &[(Written<String>, WrittenNumber)],
        scope: &mut Scope,
        slots: usize,
        has_edges: bool,
    ) -> Vec<Variable> {
        let mut variables: Vec<Variable> = Vec::new();
        for (name, number) in random {
            if !is_name(&name.value) {
                let message = format!("'{}' cannot be a variable's name", name.value);
                self.error_with_hint(
                    &name.place,
                    message,
                    "a name has letters, digits and _, and begins with a letter",
                );
            }
            let made = match number.value.as_call() {
                Some((BY_EDGE, [inner])) => {
                    if !has_edges {
                        let message =
                            "draws belong to edges of surfaces, in rules with `space: 3` only";
                        self.error_with_hint(&number.place, message, DISTRIBUTIONS);
                    }
                    let inner = WrittenNumber {
                        value: inner.clone(),
                        place: number.place.clone(),
                    };
                    let distribution = self.distribution(&inner, scope);
                    Variable::by_edge(&name.value, &distribution).into()
                }
                _ => {
                    let distribution = self.distribution(number, scope);
                    vec![Variable::new(&name.value, distribution)]
                }
            };
            for variable in made {
                let name_of = variable.name();
                if is_reserved(name_of) || scope.contains(name_of) {
                    let message = format!("'{name_of}' already has a meaning here");
                    let hint = "give the variable another name";
                    self.error_with_hint(&name.place, message, hint);
                }
                let slot = slots + variables.len();
                scope.variable(name_of, slot);
                self.random.insert(name_of.to_owned());
                variables.push(variable);
            }
        }
        variables
    }

    fn distribution(&mut self, number: &WrittenNumber, scope: &Scope) -> Distribution {
        if number.value.is_unknown() {
            // It was reported; no other mistake follows from it.
            return Distribution::Choice(vec![Program::constant(1.0)]);
        }
        let Some((name, arguments)) = number.value.as_call() else {
            self.error_with_hint(
                &number.place,
                "a distribution is needed here",
                DISTRIBUTIONS,
            );
            return Distribution::Choice(vec![Program::unknown()]);
        };
        let programs: Vec<_> = arguments
            .iter()
            .map(|argument| self.part(number, argument, Type::Number, scope))
            .collect();
        match (name, programs.as_slice()) {
            ("uniform", [low, high]) => Distribution::Uniform(low.clone(), high.clone()),
            ("normal", [mean, deviation]) => {
                if deviation.as_constant().is_some_and(|value| value < 0.0) {
                    self.error(&number.place, "a standard deviation cannot be negative");
                }
                Distribution::Normal(mean.clone(), deviation.clone())
            }
            ("choice", [_, ..]) => Distribution::Choice(programs),
            _ => {
                let message = format!("{name} does not take {} values", programs.len());
                self.error_with_hint(&number.place, message, DISTRIBUTIONS);
                Distribution::Choice(vec![Program::constant(0.0)])
            }
        }
    }
}
