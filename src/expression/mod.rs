//! The expression language of rule files: `sqrt(3)/6`, `age % 2 == 0`, `uniform(-20, 20)`.
//!
//! A text is parsed into an [`Expression`], which keeps source ranges. An expression is compiled in a
//! [`Scope`] to a [`Program`], in which names are resolved, types are checked and constants are folded,
//! and which is evaluated without allocation.
//!
//! Operators in order of increasing precedence: `or`, `and`, `not`, comparisons (which do not chain),
//! `+ -`, `* / %`, negation, `^` (right-associative: `-2^2` is -4, `2^3^2` is 512). `||`, `&&` and `!`
//! are alternative spellings of `or`, `and` and `not`. Every name denotes a number; the parts of a
//! complex number `s` have the names `s.re` and `s.im`. A point may be a formula of complex numbers, such as
//! `1/(-2 + i)`, whose parts are two expressions (see `complex`). Conditions result from comparisons, `odd`,
//! `even`, `true` and `false`, and numbers and conditions never convert to each other. Trigonometric
//! functions take and return degrees and are exact where the value is representable (see `degrees`).
//!
//! Guarantees: for any text, no function of this module panics or overflows the stack; a program reads
//! only the slots of its scope; an expression has the same value, bit for bit, on every machine.

mod affine;
mod circle;
mod compile;
mod complex;
pub(crate) mod degrees;
mod functions;
mod interval;
mod lex;
mod operator;
mod parse;
mod precise;
mod print;
mod program;
mod scope;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;

use std::ops::Range;

pub use affine::AffineOf;
pub use interval::Interval;
pub(crate) use lex::{PARTS, is_name};
pub(crate) use precise::{Precise, Precision, leading};
pub(crate) use program::{Arithmetic, Doubles, Evaluation, Folding, Symbols, gcd};
pub use program::{Dependence, Program};
pub use scope::{Scope, is_reserved};

use crate::diagnostic::{Diagnostic, Place};
use functions::{Function, Meaning};
use operator::{One, Two};

/// Type of the value of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// A real number.
    Number,
    /// True or false.
    Condition,
}

/// A mistake in an expression, or a warning.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// Byte range in the text of the expression, on character boundaries.
    pub range: Range<usize>,
    /// Message.
    pub message: String,
    /// Help text.
    pub hint: Option<String>,
}

impl ExpressionError {
    fn new(range: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            range,
            message: message.into(),
            hint: None,
        }
    }

    pub(crate) fn hint(self, hint: impl Into<String>) -> Self {
        Self {
            hint: Some(hint.into()),
            ..self
        }
    }

    /// Converts the mistake to a diagnostic at a place.
    pub(crate) fn at(self, place: &Place) -> Diagnostic {
        let diagnostic = Diagnostic::error(self.message).at(place);
        self.hint.into_iter().fold(diagnostic, Diagnostic::hint)
    }
}

/// An expression as written.
///
/// Two expressions are equal if they differ only in white space, in the spelling of numbers and
/// operators (`0.5` and `.5`, `and` and `&&`), and in redundant parentheses. `Display` writes a text
/// that parses to an equal expression, provided that its numbers are finite and the text does not
/// exceed the limits of [`parse`](Self::parse).
#[derive(Clone, Debug)]
pub struct Expression {
    node: Node,
    range: Range<usize>,
}

#[derive(Clone, Debug)]
enum Node {
    /// A number, which has no sign if it was parsed.
    Number(f64),
    Truth(bool),
    Name(String),
    /// The real part (0) or the imaginary part (1) of a name, which may be real.
    Part(String, usize),
    Prefix(One, Box<Expression>),
    Infix(Two, Box<[Expression; 2]>),
    Call(&'static Function, Vec<Expression>),
    /// A placeholder for a text that could not be parsed.
    Unknown,
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        match (&self.node, &other.node) {
            (Node::Number(a), Node::Number(b)) => a.to_bits() == b.to_bits(),
            (Node::Truth(a), Node::Truth(b)) => a == b,
            (Node::Name(a), Node::Name(b)) => a == b,
            (Node::Part(a, of), Node::Part(b, other)) => of == other && a == b,
            (Node::Prefix(f, a), Node::Prefix(g, b)) => f == g && a == b,
            (Node::Infix(f, a), Node::Infix(g, b)) => f == g && a == b,
            (Node::Call(f, a), Node::Call(g, b)) => f.name == g.name && a == b,
            _ => false,
        }
    }
}

impl Expression {
    /// Parses an expression.
    ///
    /// # Errors
    ///
    /// Returns the first mistake of syntax: an unknown function, a wrong number of arguments, more than
    /// 4096 bytes, 64 levels of nesting or 256 operators, and so on. Names and types are checked by
    /// [`compile`](Self::compile).
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        parse::parse(text)
    }

    /// Creates the expression of a number. Compilation fails if the number is not finite.
    #[must_use]
    pub fn number(value: f64) -> Self {
        // In parsed texts a negative number is a negation.
        let node = if value.is_sign_negative() && !value.is_nan() {
            Node::Prefix(One::Negate, Box::new(Self::number(-value)))
        } else {
            Node::Number(value)
        };
        let mut number = Self { node, range: 0..0 };
        number.range = 0..number.to_string().len();
        number
    }

    /// Returns a placeholder for an expression that could not be parsed, which causes no further
    /// diagnostics. The placeholder compiles to a program without a value and is not equal to any
    /// expression.
    #[must_use]
    pub fn unknown() -> Self {
        Self {
            node: Node::Unknown,
            range: 0..0,
        }
    }

    /// Returns whether this is [`Expression::unknown`].
    #[must_use]
    pub fn is_unknown(&self) -> bool {
        matches!(self.node, Node::Unknown)
    }

    /// Returns the name if the expression is a single name.
    #[must_use]
    pub fn as_name(&self) -> Option<&str> {
        match &self.node {
            Node::Name(name) => Some(name),
            _ => None,
        }
    }

    /// Returns the name and the arguments of a distribution, `uniform`, `normal` or `choice`, if the
    /// expression is a call of one. The parser has checked the number of arguments: two, two, at least
    /// one, one.
    #[must_use]
    pub fn as_call(&self) -> Option<(&str, &[Self])> {
        match &self.node {
            Node::Call(function, arguments) if function.meaning == Meaning::Distribution => {
                Some((function.name, arguments))
            }
            _ => None,
        }
    }

    /// Returns the byte range in the parsed text, including parentheses.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.range.clone()
    }

    /// Returns the type of the value, provided that the types of the parts are right, which
    /// [`compile`](Self::compile) checks.
    #[must_use]
    pub fn yields(&self) -> Type {
        match &self.node {
            Node::Number(_) | Node::Name(_) | Node::Part(..) | Node::Unknown => Type::Number,
            Node::Truth(_) => Type::Condition,
            Node::Prefix(operator, _) => operator.yields(),
            Node::Infix(operator, _) => operator.yields(),
            Node::Call(function, arguments) => match function.meaning {
                Meaning::One(operator) => operator.yields(),
                Meaning::Two(operator) | Meaning::Fold(operator) => operator.yields(),
                Meaning::If => arguments.get(1).map_or(Type::Number, Self::yields),
                Meaning::Distribution => Type::Number,
            },
        }
    }

    /// Returns all names with their ranges, in the order of the text: parameters, variables and the
    /// constants `pi`, `phi` and `e`, but not functions. A part of a complex number has the name of the number.
    #[must_use]
    pub fn names(&self) -> Vec<(&str, Range<usize>)> {
        let mut names = Vec::new();
        self.visit(&mut |expression| {
            if let Node::Name(name) | Node::Part(name, _) = &expression.node {
                names.push((name.as_str(), expression.range()));
            }
        });
        names
    }

    /// Returns the number of operations and of calls of functions.
    pub(crate) fn operations(&self) -> usize {
        let mut operations = 0;
        self.visit(&mut |expression| {
            operations += match expression.node {
                Node::Prefix(..) | Node::Infix(..) | Node::Call(..) => 1,
                Node::Number(_)
                | Node::Truth(_)
                | Node::Name(_)
                | Node::Part(..)
                | Node::Unknown => 0,
            }
        });
        operations
    }

    /// Returns warnings of trigonometric functions whose arguments contain `pi` and hence are probably
    /// in radians.
    #[must_use]
    pub fn warnings(&self) -> Vec<ExpressionError> {
        let mut warnings = Vec::new();
        self.visit(&mut |expression| {
            if let Node::Call(function, arguments) = &expression.node
                && matches!(
                    function.meaning,
                    Meaning::One(One::Sin | One::Cos | One::Tan)
                )
                && let [argument] = arguments.as_slice()
                && argument.names().iter().any(|(name, _)| *name == "pi")
            {
                let name = function.name;
                let hint = argument.in_degrees().map_or_else(
                    || format!("write {name}(60), not {name}(pi/3)"),
                    |angle| format!("write {name}({angle}), not {expression}"),
                );
                let message = "trigonometry takes degrees here";
                warnings.push(ExpressionError::new(expression.range(), message).hint(hint));
            }
        });
        warnings
    }

    /// Converts a constant angle in radians to degrees, rounded to nine decimals. Returns `None` if the
    /// expression is not constant.
    fn in_degrees(&self) -> Option<f64> {
        let radians = self.compile(&Scope::new()).ok()?.as_constant()?;
        Some((radians.to_degrees() * 1e9).round() / 1e9)
    }

    /// Compiles an expression of type number: checks names and types and folds constants.
    ///
    /// # Errors
    ///
    /// Returns an error for an unknown name, a condition in place of a number or the reverse, a
    /// distribution, a constant part that is not finite, a division by a constant zero, or more than 64
    /// intermediate values.
    pub fn compile(&self, scope: &Scope) -> Result<Program, ExpressionError> {
        compile::compile(self, Type::Number, scope)
    }

    /// Compiles an expression of type condition: checks names and types and folds constants.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`compile`](Self::compile).
    pub fn compile_condition(&self, scope: &Scope) -> Result<Program, ExpressionError> {
        compile::compile(self, Type::Condition, scope)
    }

    /// Returns all mistakes in a scope: each unknown name once, or, if there is none, the mistake that
    /// [`compile`](Self::compile) or [`compile_condition`](Self::compile_condition) returns.
    #[must_use]
    pub fn mistakes(&self, result: Type, scope: &Scope) -> Vec<ExpressionError> {
        { self.compiled(result, scope, usize::MAX).err() }.unwrap_or_default()
    }

    /// Compiles an expression. Returns all mistakes as [`mistakes`](Self::mistakes) does, the first `suggestions` of
    /// them with similar names, which take time.
    pub(crate) fn compiled(
        &self,
        result: Type,
        scope: &Scope,
        suggestions: usize,
    ) -> Result<Program, Vec<ExpressionError>> {
        let mut unknown: Vec<(&str, ExpressionError)> = Vec::new();
        self.visit(&mut |expression| {
            let (name, is_known) = match &expression.node {
                Node::Name(name) => (name, scope.get(name).is_some()),
                Node::Part(name, part) => (name, scope.part(name, *part).is_some()),
                _ => return,
            };
            if !is_known && unknown.iter().all(|(known, _)| known != name) {
                let suggests = unknown.len() < suggestions;
                unknown.push((name, scope.unknown(name, expression.range(), suggests)));
            }
        });
        if unknown.is_empty() {
            return compile::compile(self, result, scope).map_err(|error| vec![error]);
        }
        Err(unknown.into_iter().map(|(_, error)| error).collect())
    }

    /// Calls `f` for the expression and all its parts, in the order of the text.
    fn visit<'a>(&'a self, f: &mut impl FnMut(&'a Self)) {
        f(self);
        match &self.node {
            Node::Number(_) | Node::Truth(_) | Node::Name(_) | Node::Part(..) | Node::Unknown => {}
            Node::Prefix(_, operand) => operand.visit(f),
            Node::Infix(_, operands) => operands.iter().for_each(|part| part.visit(f)),
            Node::Call(_, arguments) => arguments.iter().for_each(|part| part.visit(f)),
        }
    }
}
