//! Compiled expressions, and their evaluation in doubles, intervals and long numbers.

use std::sync::Arc;

use super::operator::{One, Two};
use super::scope::{Constant, UNKNOWN};

/// Maximum number of values on the stack of a program.
pub(super) const STACK: usize = 64;

/// A compiled expression, as a postfix program. Evaluation in doubles does not allocate.
///
/// Programs are compared by their operations in doubles: `1/2` and `0.5` are equal.
#[derive(Clone, Debug)]
pub struct Program {
    ops: Vec<Op>,
    /// Maximum number of values on the stack, at least 1.
    depth: usize,
    /// Operations with constants as written, which long numbers require, if they differ from `ops`.
    unfolded: Option<Arc<[Op]>>,
}

impl PartialEq for Program {
    fn eq(&self, other: &Self) -> bool {
        self.ops == other.ops
    }
}

/// An operation of a program, which replaces its operands on the stack by its result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    /// A number as written, or the result of folding.
    Constant(f64),
    /// A constant of the language; folded in `ops`.
    Named(Constant),
    /// A parameter, by its index in [`Metadata::numbers`](crate::metadata::Metadata); folded in `ops`.
    Parameter(usize),
    Slot(usize),
    /// `slot % divisor`, a separate operation so that [`Program::dependence`] can recognize it.
    SlotModulo(usize, u32),
    One(One),
    Two(Two),
    /// Of a condition, a and b: a if the condition holds, else b.
    Select,
}

/// Numbers with the operations of expressions.
pub(crate) trait Arithmetic {
    /// A number.
    type Number: Clone;

    /// Returns the shortest decimal that reads as a double.
    fn decimal(&mut self, value: f64) -> Self::Number;

    /// Applies an operation.
    fn one(&mut self, operation: One, x: &Self::Number) -> Self::Number;

    /// Applies an operation.
    fn two(&mut self, operation: Two, a: &Self::Number, b: &Self::Number) -> Self::Number;

    /// Returns a number with the opposite sign.
    fn negate(&mut self, x: &Self::Number) -> Self::Number {
        self.one(One::Negate, x)
    }

    /// Returns the cosine and the sine of an angle in degrees.
    fn turn(&mut self, angle: &Self::Number) -> [Self::Number; 2] {
        [One::Cos, One::Sin].map(|function| self.one(function, angle))
    }

    /// Returns a sum.
    fn add(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number {
        self.two(Two::Add, a, b)
    }

    /// Returns a difference.
    fn subtract(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number {
        self.two(Two::Subtract, a, b)
    }

    /// Returns a product.
    fn multiply(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number {
        self.two(Two::Multiply, a, b)
    }

    /// Returns a quotient.
    fn divide(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number {
        self.two(Two::Divide, a, b)
    }
}

/// Arithmetic in which programs are evaluated.
pub(crate) trait Evaluation: Arithmetic {
    /// Whether constants are evaluated as written, not as folded to doubles.
    const UNFOLDED: bool = false;

    /// Returns the value of a slot that is missing.
    fn unknown(&mut self) -> Self::Number;

    /// Returns a constant of the language.
    fn named(&mut self, constant: Constant) -> Self::Number {
        self.decimal(constant.value())
    }

    /// Returns a parameter, which occurs in unfolded programs only.
    fn parameter(&mut self, _number: usize) -> Self::Number {
        self.unknown()
    }

    /// Returns one of two numbers, depending on a condition.
    fn select(&mut self, condition: &Self::Number, branches: [&Self::Number; 2]) -> Self::Number;
}

/// Arithmetic of doubles.
pub(crate) struct Doubles;

impl Arithmetic for Doubles {
    type Number = f64;

    #[inline]
    fn decimal(&mut self, value: f64) -> f64 {
        value
    }

    #[inline]
    fn one(&mut self, operation: One, x: &f64) -> f64 {
        operation.apply(*x)
    }

    #[inline]
    fn two(&mut self, operation: Two, a: &f64, b: &f64) -> f64 {
        operation.apply(*a, *b)
    }
}

impl Evaluation for Doubles {
    #[inline]
    fn unknown(&mut self) -> f64 {
        f64::NAN
    }

    #[inline]
    fn select(&mut self, condition: &f64, [then, otherwise]: [&f64; 2]) -> f64 {
        if *condition == 0.0 { *otherwise } else { *then }
    }
}

/// Arithmetic of programs: an operation makes the program that applies it.
pub(crate) struct Symbols;

impl Arithmetic for Symbols {
    type Number = Program;

    fn decimal(&mut self, value: f64) -> Program {
        Program::constant(value)
    }

    fn one(&mut self, operation: One, x: &Program) -> Program {
        let folded = x.as_constant().map(|x| operation.apply(x));
        Program::join(&[x], Op::One(operation), folded)
    }

    fn two(&mut self, operation: Two, a: &Program, b: &Program) -> Program {
        let values = a.as_constant().zip(b.as_constant());
        let folded = values.map(|(a, b)| operation.apply(a, b));
        Program::join(&[a, b], Op::Two(operation), folded)
    }
}

/// Arithmetic of programs that computes with constants in doubles, for numbers that are never evaluated as long ones.
pub(crate) struct Folding;

impl Arithmetic for Folding {
    type Number = Program;

    fn decimal(&mut self, value: f64) -> Program {
        Program::constant(value)
    }

    fn one(&mut self, operation: One, x: &Program) -> Program {
        match x.as_constant() {
            Some(x) => Program::constant(operation.apply(x)),
            None => Symbols.one(operation, x),
        }
    }

    fn two(&mut self, operation: Two, a: &Program, b: &Program) -> Program {
        match (a.as_constant(), b.as_constant()) {
            (Some(a), Some(b)) => Program::constant(operation.apply(a, b)),
            _ => Symbols.two(operation, a, b),
        }
    }
}

/// Dependence of the value of a [`Program`] on a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dependence {
    /// No dependence.
    None,
    /// For integers in the slot, dependence only on the remainder by this number, which is at least 1.
    Modulo(u32),
    /// Unknown dependence.
    Free,
}

impl Program {
    /// Creates a program with a constant value: in long numbers, the shortest decimal that reads as it.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self::of(Op::Constant(value))
    }

    /// Creates the program whose value is that of a slot.
    #[must_use]
    pub(crate) fn slot(slot: usize) -> Self {
        Self::of(Op::Slot(slot))
    }

    /// Creates the placeholder for an invalid program, whose value is unknown.
    #[must_use]
    pub fn unknown() -> Self {
        Self::of(Op::Slot(UNKNOWN))
    }

    /// Returns the program without its operations as written: long numbers evaluate those of doubles.
    pub(crate) fn in_doubles(&self) -> Self {
        Self {
            unfolded: None,
            ..self.clone()
        }
    }

    fn of(op: Op) -> Self {
        Self {
            ops: vec![op],
            depth: 1,
            unfolded: None,
        }
    }

    /// Creates a program from operations that leave one value, folded and as written.
    pub(super) fn new(ops: Vec<Op>, unfolded: Vec<Op>) -> Self {
        let depth = depth(&ops);
        let unfolded = (unfolded != ops).then(|| unfolded.into());
        Self {
            ops,
            depth,
            unfolded,
        }
    }

    /// Returns the maximum number of values on the stack.
    pub(super) fn depth(&self) -> usize {
        self.depth
    }

    /// Returns the operations as written.
    fn unfolded(&self) -> &[Op] {
        self.unfolded.as_deref().unwrap_or(&self.ops)
    }

    /// Creates the program that applies an operation to the values of programs, with its value if that is
    /// constant.
    fn join(operands: &[&Self], op: Op, folded: Option<f64>) -> Self {
        let joined = |all: fn(&Self) -> &[Op]| {
            let ops = operands.iter().flat_map(|it| all(it)).copied();
            ops.chain([op]).collect::<Vec<_>>()
        };
        let ops = match folded {
            Some(value) => vec![Op::Constant(value)],
            None => joined(|it| &it.ops),
        };
        Self::new(ops, joined(Self::unfolded))
    }

    /// Returns the value if the program is a constant.
    #[must_use]
    pub fn as_constant(&self) -> Option<f64> {
        match self.ops.as_slice() {
            [Op::Constant(value)] => Some(*value),
            _ => None,
        }
    }

    /// Evaluates the program for the given slots; a condition gives 1 or 0.
    ///
    /// The result may be infinite or NaN, which the caller checks for. A missing slot is NaN.
    #[must_use]
    pub fn eval(&self, slots: &[f64]) -> f64 {
        match self.ops.as_slice() {
            [Op::Constant(value)] => *value,
            // Clearing a large stack would take longer than most programs.
            ops if self.depth <= 8 => run(ops, &mut Doubles, slots, &mut [0.0; 8]),
            ops if self.depth <= STACK => run(ops, &mut Doubles, slots, &mut [0.0; STACK]),
            ops => run(ops, &mut Doubles, slots, &mut vec![0.0; self.depth]),
        }
    }

    /// Evaluates the program for slots of an arithmetic.
    pub(crate) fn evaluate<A: Evaluation>(&self, of: &mut A, slots: &[A::Number]) -> A::Number {
        let ops = if A::UNFOLDED {
            self.unfolded()
        } else {
            &self.ops
        };
        let mut stack = vec![of.unknown(); depth(ops)];
        run(ops, of, slots, &mut stack)
    }

    /// Returns the work of the program beyond that of a few operations, as a number of short programs.
    pub(crate) fn work(&self) -> usize {
        /// Number of operations of a short program.
        const OPERATIONS: usize = 4;
        self.ops.len() / OPERATIONS
    }

    /// Returns whether the condition holds for the given slots.
    #[must_use]
    pub fn holds(&self, slots: &[f64]) -> bool {
        self.eval(slots) != 0.0
    }

    /// Returns the dependence of the value on a slot: `Modulo` with the least common multiple of all
    /// `c` if the slot occurs only as `slot % c` with positive integers `c`, or in `odd(slot)` and
    /// `even(slot)`, which count as c = 2.
    #[must_use]
    pub fn dependence(&self, slot: usize) -> Dependence {
        self.ops
            .iter()
            .fold(Dependence::None, |dependence, op| match *op {
                Op::Slot(other) if other == slot => Dependence::Free,
                Op::SlotModulo(other, divisor) if other == slot => dependence.and(divisor),
                _ => dependence,
            })
    }
}

/// Returns the maximum number of values on the stack of operations, at least 1.
fn depth(ops: &[Op]) -> usize {
    let (mut held, mut depth) = (0_usize, 1);
    for op in ops {
        match op {
            Op::One(_) => {}
            Op::Two(_) => held -= 1,
            Op::Select => held -= 2,
            _ => held += 1,
        }
        depth = depth.max(held);
    }
    depth
}

/// Runs operations that leave one value, with a stack of at least their depth.
#[inline]
fn run<A: Evaluation>(
    ops: &[Op],
    arithmetic: &mut A,
    slots: &[A::Number],
    stack: &mut [A::Number],
) -> A::Number {
    let mut below = 0;
    // The top of the stack is kept apart; the slice has the values below it and an unused first value.
    let mut top = arithmetic.unknown();
    for op in ops {
        let pushed = match *op {
            Op::Constant(value) => arithmetic.decimal(value),
            Op::Named(constant) => arithmetic.named(constant),
            Op::Parameter(number) => arithmetic.parameter(number),
            Op::Slot(slot) => read(arithmetic, slots, slot),
            Op::SlotModulo(slot, divisor) => {
                let value = read(arithmetic, slots, slot);
                let divisor = arithmetic.decimal(divisor.into());
                arithmetic.two(Two::Modulo, &value, &divisor)
            }
            Op::One(operation) => {
                top = arithmetic.one(operation, &top);
                continue;
            }
            Op::Two(operation) => {
                below -= 1;
                top = arithmetic.two(operation, &stack[below], &top);
                continue;
            }
            Op::Select => {
                below -= 2;
                top = arithmetic.select(&stack[below], [&stack[below + 1], &top]);
                continue;
            }
        };
        stack[below] = top;
        below += 1;
        top = pushed;
    }
    top
}

#[inline]
fn read<A: Evaluation>(arithmetic: &mut A, slots: &[A::Number], slot: usize) -> A::Number {
    let value = slots.get(slot).cloned();
    value.unwrap_or_else(|| arithmetic.unknown())
}

impl Dependence {
    /// Combines the dependence with one on the remainder by `divisor`.
    fn and(self, divisor: u32) -> Self {
        match self {
            Self::None => Self::Modulo(divisor),
            Self::Modulo(other) => {
                let [a, b] = [other, divisor].map(u64::from);
                u32::try_from(a / gcd(a, b) * b).map_or(Self::Free, Self::Modulo)
            }
            Self::Free => Self::Free,
        }
    }
}

/// Returns the greatest common divisor.
pub(crate) fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
