//! Compilation: names and types are checked, and constants are folded into a postfix program.

use std::ops::Range;

use super::functions::Meaning;
use super::operator::{One, Two};
use super::program::{Op, Program, STACK};
use super::scope::{Named, Scope, UNKNOWN};
use super::{Expression, ExpressionError, Node, Type};

type Checked<T = ()> = Result<T, ExpressionError>;

pub(super) fn compile(expression: &Expression, result: Type, scope: &Scope) -> Checked<Program> {
    expression.check(result, scope)?;
    let mut compiler = Compiler {
        scope,
        ops: Vec::new(),
        unfolded: Vec::new(),
    };
    compiler.emit(expression)?;
    let program = Program::new(compiler.ops, compiler.unfolded);
    if program.depth() > STACK {
        let message = format!("this needs more than {STACK} intermediate values");
        let hint = "write the longest part of it first";
        return Err(ExpressionError::new(expression.range(), message).hint(hint));
    }
    Ok(program)
}

impl Expression {
    /// Checks names and types of the whole expression, in the order of the text.
    fn check(&self, needed: Type, scope: &Scope) -> Checked {
        match &self.node {
            Node::Name(name) if scope.get(name).is_none() => {
                return Err(scope.unknown(name, self.range(), true));
            }
            Node::Part(name, part) if scope.part(name, *part).is_none() => {
                return Err(scope.unknown(name, self.range(), true));
            }
            Node::Call(function, _) if function.meaning == Meaning::Distribution => {
                let message = format!("'{}' cannot be used in a formula", function.name);
                let hint = "a distribution belongs under `random:`, where it gets a name";
                return Err(ExpressionError::new(self.range(), message).hint(hint));
            }
            Node::Unknown => {}
            // The type applies to the branches.
            Node::Call(function, _) if function.meaning == Meaning::If => {}
            _ => self.check_type(needed)?,
        }
        match &self.node {
            Node::Number(_) | Node::Truth(_) | Node::Name(_) | Node::Part(..) | Node::Unknown => {
                Ok(())
            }
            Node::Prefix(operator, operand) => operand.check(operator.takes(), scope),
            Node::Infix(operator, operands) => check_all(&operands[..], operator.takes(), scope),
            Node::Call(function, arguments) => match (function.meaning, arguments.as_slice()) {
                (Meaning::If, [condition, branches @ ..]) => {
                    condition.check(Type::Condition, scope)?;
                    check_all(branches, needed, scope)
                }
                (Meaning::One(operation), _) => check_all(arguments, operation.takes(), scope),
                (Meaning::Two(operation) | Meaning::Fold(operation), _) => {
                    check_all(arguments, operation.takes(), scope)
                }
                (Meaning::If | Meaning::Distribution, _) => Ok(()),
            },
        }
    }

    fn check_type(&self, needed: Type) -> Checked {
        let (message, hint) = match (needed, self.yields()) {
            (Type::Condition, Type::Number) => (
                "a condition is needed here, this is a number",
                "compare it with something: x > 0",
            ),
            (Type::Number, Type::Condition) => (
                "a number is needed here, this is a condition",
                "if(condition, 1, 0) makes a number of it",
            ),
            (Type::Number, Type::Number) | (Type::Condition, Type::Condition) => return Ok(()),
        };
        Err(ExpressionError::new(self.range(), message).hint(hint))
    }
}

fn check_all(parts: &[Expression], needed: Type, scope: &Scope) -> Checked {
    parts.iter().try_for_each(|part| part.check(needed, scope))
}

struct Compiler<'s> {
    scope: &'s Scope,
    /// The program so far. A constant part of it is a single operation.
    ops: Vec<Op>,
    /// The program so far, without folding.
    unfolded: Vec<Op>,
}

impl Compiler<'_> {
    /// Appends the operations of an expression whose names and types have been checked.
    fn emit(&mut self, expression: &Expression) -> Checked {
        let range = expression.range();
        match &expression.node {
            Node::Number(value) => {
                self.unfolded.push(Op::Constant(*value));
                self.constant(*value, range)
            }
            Node::Truth(value) => {
                let value = if *value { 1.0 } else { 0.0 };
                self.unfolded.push(Op::Constant(value));
                self.constant(value, range)
            }
            Node::Name(name) => self.named(self.scope.get(name), name, range),
            Node::Part(name, part) => self.named(self.scope.part(name, *part), name, range),
            Node::Unknown => self.slot(UNKNOWN),
            Node::Prefix(operation, operand) => self.one(*operation, operand, expression),
            Node::Infix(operation, operands) => {
                let [left, right] = &**operands;
                self.two(*operation, left, right, range)
            }
            Node::Call(function, arguments) => match (function.meaning, arguments.as_slice()) {
                (Meaning::One(operation), [x]) => self.one(operation, x, expression),
                (Meaning::Two(operation), [x, y]) => self.two(operation, x, y, range),
                (Meaning::Fold(operation), [first, rest @ ..]) => {
                    let start = self.ops.len();
                    self.emit(first)?;
                    for next in rest {
                        let middle = self.ops.len();
                        self.emit(next)?;
                        self.join(operation, start, middle, &range)?;
                    }
                    Ok(())
                }
                (Meaning::If, [condition, then, otherwise]) => {
                    self.select(condition, then, otherwise)
                }
                // The parser refuses wrong numbers of arguments, and `check` refuses distributions.
                _ => Err(ExpressionError::new(range, "this call has no value")),
            },
        }
    }

    fn named(&mut self, found: Option<Named>, name: &str, range: Range<usize>) -> Checked {
        match found {
            Some(Named::Constant(value, written)) => {
                self.unfolded.push(written);
                self.constant(value, range)
            }
            Some(Named::Slot(slot)) => self.slot(slot),
            None => Err(self.scope.unknown(name, range, true)),
        }
    }

    fn one(&mut self, operation: One, operand: &Expression, whole: &Expression) -> Checked {
        let start = self.ops.len();
        self.emit(operand)?;
        self.unfolded.push(Op::One(operation));
        match (operation, &self.ops[start..]) {
            (_, &[Op::Constant(x)]) => {
                let value = operation.apply(x);
                if value.is_nan() && !x.is_nan() {
                    return Err(not_real(whole, x));
                }
                self.ops.truncate(start);
                self.constant(value, whole.range())
            }
            (One::Odd | One::Even, &[Op::Slot(slot)]) => {
                let remainder = if operation == One::Odd { 1.0 } else { 0.0 };
                self.ops[start] = Op::SlotModulo(slot, 2);
                self.ops.push(Op::Constant(remainder));
                self.ops.push(Op::Two(Two::Equal));
                Ok(())
            }
            _ => {
                self.ops.push(Op::One(operation));
                Ok(())
            }
        }
    }

    fn two(
        &mut self,
        operation: Two,
        left: &Expression,
        right: &Expression,
        range: Range<usize>,
    ) -> Checked {
        let start = self.ops.len();
        self.emit(left)?;
        let middle = self.ops.len();
        // An operand that a constant condition excludes is not folded: `n != 0 and 1/n < 2` is valid
        // for n = 0.
        match (operation, &self.ops[start..]) {
            (Two::And, [Op::Constant(0.0)]) | (Two::Or, [Op::Constant(1.0)]) => return Ok(()),
            _ => {}
        }
        self.emit(right)?;
        if let (Two::Divide | Two::Modulo, [Op::Constant(0.0)]) = (operation, &self.ops[middle..]) {
            let error = ExpressionError::new(right.range(), "division by zero");
            return Err(match right.node {
                Node::Number(_) => error,
                _ => error.hint(format!("{right} is 0 here")),
            });
        }
        self.join(operation, start, middle, &range)
    }

    /// Appends an operation on the results of the operations from `start` and from `middle`.
    fn join(
        &mut self,
        operation: Two,
        start: usize,
        middle: usize,
        range: &Range<usize>,
    ) -> Checked {
        self.unfolded.push(Op::Two(operation));
        match (operation, &self.ops[start..middle], &self.ops[middle..]) {
            (_, &[Op::Constant(a)], &[Op::Constant(b)]) => {
                let value = operation.apply(a, b);
                if operation == Two::Power && value.is_nan() {
                    let message = format!("({a})^({b}) is not a real number");
                    let hint =
                        "a number below zero has only whole powers; cbrt(x) is its cube root";
                    return Err(ExpressionError::new(range.clone(), message).hint(hint));
                }
                self.ops.truncate(start);
                return self.constant(value, range.clone());
            }
            (Two::Modulo, &[Op::Slot(slot)], &[Op::Constant(divisor)]) => {
                if let Some(divisor) = positive_whole(divisor) {
                    self.ops.truncate(start);
                    self.ops.push(Op::SlotModulo(slot, divisor));
                    return Ok(());
                }
            }
            _ => {}
        }
        self.ops.push(Op::Two(operation));
        Ok(())
    }

    fn select(
        &mut self,
        condition: &Expression,
        then: &Expression,
        otherwise: &Expression,
    ) -> Checked {
        let (start, written) = (self.ops.len(), self.unfolded.len());
        self.emit(condition)?;
        // As with `and`: `if(n == 0, 1, 1/n)` is valid for n = 0.
        if let &[Op::Constant(value)] = &self.ops[start..] {
            self.ops.truncate(start);
            self.unfolded.truncate(written);
            return self.emit(if value == 0.0 { otherwise } else { then });
        }
        self.emit(then)?;
        self.emit(otherwise)?;
        self.ops.push(Op::Select);
        self.unfolded.push(Op::Select);
        Ok(())
    }

    fn slot(&mut self, slot: usize) -> Checked {
        self.ops.push(Op::Slot(slot));
        self.unfolded.push(Op::Slot(slot));
        Ok(())
    }

    fn constant(&mut self, value: f64, range: Range<usize>) -> Checked {
        if value.is_finite() {
            self.ops.push(Op::Constant(value));
            Ok(())
        } else {
            Err(ExpressionError::new(
                range,
                "the value of this is not finite",
            ))
        }
    }
}

/// Returns the error of a function that is not defined at `x`.
fn not_real(call: &Expression, x: f64) -> ExpressionError {
    let name = match &call.node {
        Node::Call(function, _) => function.name,
        _ => "",
    };
    let hint = match name {
        "asin" | "acos" => format!("{name} takes numbers from -1 to 1"),
        _ => format!("{name} takes no numbers below 0"),
    };
    let message = format!("{name}({x}) is not a real number");
    ExpressionError::new(call.range(), message).hint(hint)
}

/// Returns the value as an integer if it is a positive one.
fn positive_whole(value: f64) -> Option<u32> {
    // Parsed from its digits, because the standard library has no checked conversion.
    let whole = value.to_string().parse().ok()?;
    (whole > 0).then_some(whole)
}
