//! Compiled expressions.

use super::operator::{One, Two, modulo};
use super::scope::UNKNOWN;

/// The most intermediate values that a program may hold at a time.
pub(super) const STACK: usize = 64;

/// A compiled expression: a postfix program. Evaluation allocates nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    ops: Vec<Op>,
    /// Values held at a time, from 1 to [`STACK`].
    depth: usize,
}

/// A step of a program. Operands are taken from the stack and the result is put back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    Constant(f64),
    Slot(usize),
    /// `slot % divisor`, a step of its own because it is what [`Program::dependence`] looks for.
    SlotModulo(usize, u32),
    One(One),
    Two(Two),
    /// Of condition, a and b: a if the condition holds, else b.
    Select,
}

/// How the value of a [`Program`] depends on a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dependence {
    /// Not at all.
    None,
    /// For whole numbers in the slot, only on their remainder by this number, which is at least 1.
    Modulo(u32),
    /// In a way that is not known.
    Free,
}

impl Program {
    /// The program that yields this value.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self {
            ops: vec![Op::Constant(value)],
            depth: 1,
        }
    }

    /// The program that stands in for one that is wrong: nothing is known of its value.
    #[must_use]
    pub fn unknown() -> Self {
        Self {
            ops: vec![Op::Slot(UNKNOWN)],
            depth: 1,
        }
    }

    /// A program of these steps, which leave one value; nothing if they hold more than [`STACK`]
    /// values at a time.
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

    /// The value, if it is the same for all slots.
    #[must_use]
    pub fn as_constant(&self) -> Option<f64> {
        match self.ops.as_slice() {
            [Op::Constant(value)] => Some(*value),
            _ => None,
        }
    }

    /// The value for these slots; 1 or 0 for a condition.
    ///
    /// It may be infinite or NaN: callers check. A slot beyond the end is NaN.
    #[must_use]
    pub fn eval(&self, slots: &[f64]) -> f64 {
        match self.ops.as_slice() {
            [Op::Constant(value)] => *value,
            // Clearing a large stack would take longer than most programs.
            _ if self.depth <= 8 => self.run::<8>(slots),
            _ => self.run::<STACK>(slots),
        }
    }

    /// Whether the condition holds for these slots.
    #[must_use]
    pub fn holds(&self, slots: &[f64]) -> bool {
        self.eval(slots) != 0.0
    }

    /// How the value depends on a slot: `Modulo` with the least common multiple of the `c` if the
    /// slot occurs only as `slot % c` with positive whole constants `c`, or in `odd(slot)` and
    /// `even(slot)`, which count as 2.
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

    /// The steps, in postfix order.
    pub(super) fn ops(&self) -> &[Op] {
        &self.ops
    }

    fn run<const N: usize>(&self, slots: &[f64]) -> f64 {
        let mut stack = [0.0; N];
        let mut below = 0;
        // The top of the stack; what is below it, and one value of no meaning, is in the array.
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
    /// This dependence and one on the remainder by `divisor`.
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
