//! Compiled expressions.

use super::operator::{One, Two, modulo};
use super::scope::UNKNOWN;

/// Maximum number of values on the stack of a program.
pub(super) const STACK: usize = 64;

/// A compiled expression, as a postfix program. Evaluation does not allocate.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    ops: Vec<Op>,
    /// Maximum number of values on the stack, from 1 to [`STACK`].
    depth: usize,
}

/// An operation of a program, which replaces its operands on the stack by its result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    Constant(f64),
    Slot(usize),
    /// `slot % divisor`, a separate operation so that [`Program::dependence`] can recognize it.
    SlotModulo(usize, u32),
    One(One),
    Two(Two),
    /// Of a condition, a and b: a if the condition holds, else b.
    Select,
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
    /// Creates a program with a constant value.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self {
            ops: vec![Op::Constant(value)],
            depth: 1,
        }
    }

    /// Creates the placeholder for an invalid program, whose value is unknown.
    #[must_use]
    pub fn unknown() -> Self {
        Self {
            ops: vec![Op::Slot(UNKNOWN)],
            depth: 1,
        }
    }

    /// Creates a program from operations that leave one value. Returns `None` if they need more than
    /// [`STACK`] values on the stack.
    pub(super) fn new(ops: Vec<Op>) -> Option<Self> {
        let (mut held, mut depth) = (0_usize, 0);
        for op in &ops {
            match op {
                Op::Constant(_) | Op::Slot(_) | Op::SlotModulo(..) => held += 1,
                Op::One(_) => {}
                Op::Two(_) => held -= 1,
                Op::Select => held -= 2,
            }
            depth = depth.max(held);
        }
        (depth <= STACK).then_some(Self { ops, depth })
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
            _ if self.depth <= 8 => self.run::<8>(slots),
            _ => self.run::<STACK>(slots),
        }
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

    /// Returns the operations, in postfix order.
    pub(super) fn ops(&self) -> &[Op] {
        &self.ops
    }

    fn run<const N: usize>(&self, slots: &[f64]) -> f64 {
        let mut stack = [0.0; N];
        let mut below = 0;
        // The top of the stack is kept apart; the array has the values below it and an unused first
        // value.
        let mut top = 0.0;
        for op in &self.ops {
            let pushed = match *op {
                Op::Constant(value) => value,
                Op::Slot(slot) => read(slots, slot),
                Op::SlotModulo(slot, divisor) => modulo(read(slots, slot), f64::from(divisor)),
                Op::One(operation) => {
                    top = operation.apply(top);
                    continue;
                }
                Op::Two(operation) => {
                    below -= 1;
                    top = operation.apply(stack[below], top);
                    continue;
                }
                Op::Select => {
                    below -= 2;
                    if stack[below] != 0.0 {
                        top = stack[below + 1];
                    }
                    continue;
                }
            };
            stack[below] = top;
            below += 1;
            top = pushed;
        }
        top
    }
}

impl Dependence {
    /// Combines the dependence with one on the remainder by `divisor`.
    fn and(self, divisor: u32) -> Self {
        match self {
            Self::None => Self::Modulo(divisor),
            Self::Modulo(other) => (other / gcd(other, divisor))
                .checked_mul(divisor)
                .map_or(Self::Free, Self::Modulo),
            Self::Free => Self::Free,
        }
    }
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[inline]
fn read(slots: &[f64], slot: usize) -> f64 {
    slots.get(slot).copied().unwrap_or(f64::NAN)
}
