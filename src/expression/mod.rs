//! The expression language of rule files: `sqrt(3)/6`, `age % 2 == 0`, `uniform(-20, 20)`.
//!
//! A text is parsed once into an [`Expression`], which remembers where everything stood, and
//! compiled against a [`Scope`] into a [`Program`], which has no names, no types and no constant
//! parts left and is evaluated without allocating.
//!
//! From loosest to tightest: `or`, `and`, `not`, comparisons (which do not chain), `+ -`, `* / %`,
//! the minus sign, `^` (to the right: `-2^2` is -4, `2^3^2` is 512). `||`, `&&` and `!` are other
//! spellings of the first three. Every name is a number, those of the parts of a complex one, `s.re`
//! and `s.im`, as well; conditions come from comparisons, `odd`, `even`, `true` and `false`, and the
//! two never mix. Trigonometry takes and gives degrees and is exact where the value is (see `degrees`).
//!
//! What is guaranteed: nothing here panics or overflows the stack, whatever the text; a program
//! reads only the slots of its scope; the same expression has the same value, bit for bit, on
//! every machine.

mod circle;
mod compile;
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

pub use interval::Interval;
pub(crate) use lex::{PARTS, is_name};
pub(crate) use precise::{Precise, Precision};
pub use program::{Dependence, Program};
pub use scope::{Scope, is_reserved};

use functions::{Function, Meaning};
use operator::{One, Two};

/// What an expression yields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// A real number.
    Number,
    /// True or false.
    Condition,
}

/// A mistake in an expression, or a warning about one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// Where it is: bytes of the expression's text, on character boundaries.
    pub range: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What would be right.
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

    fn hint(self, hint: impl Into<String>) -> Self {
        Self {
            hint: Some(hint.into()),
            ..self
        }
    }
}

/// An expression as written.
///
/// Two are equal if they are written the same up to white space, the spelling of numbers and
/// operators (`0.5` and `.5`, `and` and `&&`), and parentheses that change nothing. Printing gives
/// text that parses to an equal expression, if its numbers are finite and the text is not too long.
#[derive(Clone, Debug)]
pub struct Expression {
    node: Node,
    range: Range<usize>,
}

#[derive(Clone, Debug)]
enum Node {
    /// Without a sign if it comes from a text.
    Number(f64),
    Truth(bool),
    Name(String),
    Prefix(One, Box<Expression>),
    Infix(Two, Box<[Expression; 2]>),
    Call(&'static Function, Vec<Expression>),
    /// Stands for a text that could not be read.
    Unknown,
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        match (&self.node, &other.node) {
            (Node::Number(a), Node::Number(b)) => a.to_bits() == b.to_bits(),
            (Node::Truth(a), Node::Truth(b)) => a == b,
            (Node::Name(a), Node::Name(b)) => a == b,
            (Node::Prefix(f, a), Node::Prefix(g, b)) => f == g && a == b,
            (Node::Infix(f, a), Node::Infix(g, b)) => f == g && a == b,
            (Node::Call(f, a), Node::Call(g, b)) => f.name == g.name && a == b,
            _ => false,
        }
    }
}

impl Expression {
    /// Reads an expression.
    ///
    /// # Errors
    ///
    /// The first place that is not in the grammar: an unknown function, a wrong number of
    /// arguments, more than 4096 bytes, 64 levels of nesting or 256 operators, and the like.
    /// Names and types are left to [`compile`](Self::compile).
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        parse::parse(text)
    }

    /// The expression that is this number. One that is not finite fails to compile.
    #[must_use]
    pub fn number(value: f64) -> Self {
        // A text has no negative numbers, only a minus sign before one.
        let node = if value.is_sign_negative() && !value.is_nan() {
            Node::Prefix(One::Negate, Box::new(Self::number(-value)))
        } else {
            Node::Number(value)
        };
        let mut number = Self { node, range: 0..0 };
        number.range = 0..number.to_string().len();
        number
    }

    /// Stands in for an expression that could not be read, so that nothing more is said of it: it
    /// compiles to a program without a value and is equal to no other.
    #[must_use]
    pub fn unknown() -> Self {
        Self {
            node: Node::Unknown,
            range: 0..0,
        }
    }

    /// Whether it is [`Expression::unknown`].
    #[must_use]
    pub fn is_unknown(&self) -> bool {
        matches!(self.node, Node::Unknown)
    }

    /// The name, if it is nothing but a name.
    #[must_use]
    pub fn as_name(&self) -> Option<&str> {
        match &self.node {
            Node::Name(name) => Some(name),
            _ => None,
        }
    }

    /// The name and arguments of the outermost call, if it is a distribution: `uniform`, `normal`
    /// or `choice`. Their number is right: two, two, at least one.
    #[must_use]
    pub fn as_call(&self) -> Option<(&str, &[Self])> {
        match &self.node {
            Node::Call(function, arguments) if function.meaning == Meaning::Distribution => {
                Some((function.name, arguments))
            }
            _ => None,
        }
    }

    /// Where it stands in the text that was parsed, its parentheses included.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.range.clone()
    }

    /// What it yields if its parts have the right types, which [`compile`](Self::compile) checks.
    #[must_use]
    pub fn yields(&self) -> Type {
        match &self.node {
            Node::Number(_) | Node::Name(_) | Node::Unknown => Type::Number,
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

    /// Every name in it, with its range, in the order of the text: parameters, variables and the
    /// constants `pi`, `phi`, `e`, but not functions.
    #[must_use]
    pub fn names(&self) -> Vec<(&str, Range<usize>)> {
        let mut names = Vec::new();
        self.visit(&mut |expression| {
            if let Node::Name(name) = &expression.node {
                names.push((name.as_str(), expression.range()));
            }
        });
        names
    }

    /// What is allowed but probably not meant: radians given to trigonometry.
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

    /// The angle in degrees if this is an angle in radians without variables, to nine decimals.
    fn in_degrees(&self) -> Option<f64> {
        let radians = self.compile(&Scope::new()).ok()?.as_constant()?;
        Some((radians.to_degrees() * 1e9).round() / 1e9)
    }

    /// Checks names and types and folds what is constant, for an expression that is a number.
    ///
    /// # Errors
    ///
    /// An unknown name, a condition in a number's place or the reverse, a distribution, a constant
    /// part that is not finite, a division by a constant zero, or more than 64 intermediate values.
    pub fn compile(&self, scope: &Scope) -> Result<Program, ExpressionError> {
        compile::compile(self, Type::Number, scope)
    }

    /// Checks names and types and folds what is constant, for an expression that is a condition.
    ///
    /// # Errors
    ///
    /// As [`compile`](Self::compile).
    pub fn compile_condition(&self, scope: &Scope) -> Result<Program, ExpressionError> {
        compile::compile(self, Type::Condition, scope)
    }

    /// All that is wrong with it in a scope: each of its unknown names, or the one mistake that
    /// [`compile`](Self::compile) or [`compile_condition`](Self::compile_condition) reports.
    #[must_use]
    pub fn mistakes(&self, result: Type, scope: &Scope) -> Vec<ExpressionError> {
        let mut unknown: Vec<(&str, ExpressionError)> = Vec::new();
        for (name, range) in self.names() {
            if scope.get(name).is_none() && unknown.iter().all(|(known, _)| *known != name) {
                unknown.push((name, scope.unknown(name, range)));
            }
        }
        if unknown.is_empty() {
            return compile::compile(self, result, scope)
                .err()
                .into_iter()
                .collect();
        }
        unknown.into_iter().map(|(_, error)| error).collect()
    }

    /// Calls `f` for this expression and all its parts, in the order of the text.
    fn visit<'a>(&'a self, f: &mut impl FnMut(&'a Self)) {
        f(self);
        match &self.node {
            Node::Number(_) | Node::Truth(_) | Node::Name(_) | Node::Unknown => {}
            Node::Prefix(_, operand) => operand.visit(f),
            Node::Infix(_, operands) => operands.iter().for_each(|part| part.visit(f)),
            Node::Call(_, arguments) => arguments.iter().for_each(|part| part.visit(f)),
        }
    }
}
