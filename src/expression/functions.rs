//! Table of the functions of the expression language.

use super::operator::{One, Two};

/// A function of the expression language.
#[derive(Debug)]
pub(super) struct Function {
    pub(super) name: &'static str,
    /// Names of the arguments, for help texts.
    pub(super) arguments: &'static str,
    pub(super) meaning: Meaning,
}

/// Operation that a call denotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    One(One),
    Two(Two),
    /// A left fold over one or more arguments.
    Fold(Two),
    If,
    Distribution,
}

const fn function(name: &'static str, arguments: &'static str, meaning: Meaning) -> Function {
    Function {
        name,
        arguments,
        meaning,
    }
}

const fn one(name: &'static str, operation: One) -> Function {
    function(name, "x", Meaning::One(operation))
}

pub(super) static FUNCTIONS: [Function; 29] = [
    one("sqrt", One::Sqrt),
    one("cbrt", One::Cbrt),
    one("abs", One::Abs),
    one("sign", One::Sign),
    one("floor", One::Floor),
    one("ceil", One::Ceil),
    one("round", One::Round),
    function("min", "a, b, ...", Meaning::Fold(Two::Min)),
    function("max", "a, b, ...", Meaning::Fold(Two::Max)),
    function("hypot", "x, y", Meaning::Two(Two::Hypot)),
    one("exp", One::Exp),
    one("log", One::Ln),
    one("ln", One::Ln),
    one("log2", One::Log2),
    one("log10", One::Log10),
    one("sin", One::Sin),
    one("cos", One::Cos),
    one("tan", One::Tan),
    one("asin", One::Asin),
    one("acos", One::Acos),
    one("atan", One::Atan),
    function("atan2", "y, x", Meaning::Two(Two::Atan2)),
    one("odd", One::Odd),
    one("even", One::Even),
    function("if", "condition, then, otherwise", Meaning::If),
    function("uniform", "a, b", Meaning::Distribution),
    function("normal", "mean, deviation", Meaning::Distribution),
    function("choice", "a, b, ...", Meaning::Distribution),
    function("by_edge", "distribution", Meaning::Distribution),
];

impl Function {
    pub(super) fn find(name: &str) -> Option<&'static Self> {
        FUNCTIONS.iter().find(|function| function.name == name)
    }

    /// Returns the notation of a call.
    pub(super) fn signature(&self) -> String {
        format!("{}({})", self.name, self.arguments)
    }

    /// Returns whether the function accepts this number of arguments.
    pub(super) fn accepts(&self, count: usize) -> bool {
        if self.is_variadic() {
            count >= 1
        } else {
            count == self.arity()
        }
    }

    /// Returns the message for a wrong number of arguments.
    pub(super) fn arity_message(&self, count: usize) -> String {
        let (least, arity) = if self.is_variadic() {
            ("at least ", 1)
        } else {
            ("", self.arity())
        };
        let plural = if arity == 1 { "" } else { "s" };
        format!(
            "{} takes {least}{arity} argument{plural}, not {count}",
            self.name
        )
    }

    fn is_variadic(&self) -> bool {
        self.arguments.ends_with("...")
    }

    fn arity(&self) -> usize {
        self.arguments.split(',').count()
    }
}
