//! Formatting of expressions with the necessary parentheses only.

use std::fmt::{self, Display, Formatter};

use super::lex::PARTS;
use super::operator::{ATOM, One, Two};
use super::{Expression, Node};

impl Display for Expression {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.node {
            Node::Number(value) => write_number(f, *value),
            Node::Truth(value) => write!(f, "{value}"),
            Node::Name(name) => f.write_str(name),
            Node::Part(name, part) => write!(f, "{name}{}", PARTS[*part]),
            Node::Unknown => f.write_str("?"),
            Node::Prefix(operator, operand) => {
                f.write_str(if *operator == One::Not { "not " } else { "-" })?;
                operand.write_bound(f, operator.precedence())
            }
            Node::Infix(operator, operands) => {
                let [left, right] = &**operands;
                let precedence = operator.precedence();
                let chains = *operator != Two::Power && !operator.is_comparison();
                left.write_bound(f, if chains { precedence } else { precedence + 1 })?;
                f.write_str(operator.symbol())?;
                match operator {
                    // The exponent may begin with a minus sign: 2^-1.
                    Two::Power => right.write_bound(f, One::Negate.precedence()),
                    _ => right.write_bound(f, precedence + 1),
                }
            }
            Node::Call(function, arguments) => {
                write!(f, "{}(", function.name)?;
                for (i, argument) in arguments.iter().enumerate() {
                    let comma = if i == 0 { "" } else { ", " };
                    write!(f, "{comma}{argument}")?;
                }
                f.write_str(")")
            }
        }
    }
}

impl Expression {
    /// Writes the expression, in parentheses if its precedence is lower than `precedence`.
    fn write_bound(&self, f: &mut Formatter<'_>, precedence: u8) -> fmt::Result {
        let own = match &self.node {
            Node::Prefix(operator, _) => operator.precedence(),
            Node::Infix(operator, _) => operator.precedence(),
            Node::Number(_)
            | Node::Truth(_)
            | Node::Name(_)
            | Node::Part(..)
            | Node::Call(..)
            | Node::Unknown => ATOM,
        };
        if own < precedence {
            write!(f, "({self})")
        } else {
            write!(f, "{self}")
        }
    }
}

/// Writes the shortest decimal that parses to the same number.
fn write_number(f: &mut Formatter<'_>, value: f64) -> fmt::Result {
    if value == 0.0 || (1e-5..1e16).contains(&value.abs()) {
        write!(f, "{value}")
    } else {
        write!(f, "{value:e}")
    }
}
