//! Complex numbers: the expressions of the real and the imaginary part of an expression in `i`.
//!
//! A name may be real or complex, which is known only when it is compiled. A leaf therefore stands for a part of its value: that of a
//! real number is the number, or 0. Functions and exponents are those of real numbers.

use super::operator::{One, Two};
use super::{Expression, ExpressionError, Node, functions::Function, scope};

/// Name of the imaginary unit.
const UNIT: &str = "i";

/// Largest number of parts of an expression.
const MOST: usize = 1 << 12;

/// Largest exponent.
const MAX_POWER: u32 = 64;

/// Expressions of the real and the imaginary part.
type Parts = [Expression; 2];

impl Expression {
    /// Returns whether the imaginary unit or the name of another complex number occurs, other than in functions and exponents.
    pub(crate) fn is_complex(&self, is_complex: &dyn Fn(&str) -> bool) -> bool {
        match &self.node {
            Node::Name(name) => name == UNIT || is_complex(name),
            Node::Prefix(_, operand) => operand.is_complex(is_complex),
            Node::Infix(Two::Power, operands) => operands[0].is_complex(is_complex),
            Node::Infix(_, operands) => operands.iter().any(|it| it.is_complex(is_complex)),
            _ => false,
        }
    }

    /// Returns the expressions of the real and the imaginary part of an expression, in which `i` is the imaginary unit, and
    /// adds the number of parts of expressions that were copied on the way to `work`.
    ///
    /// # Errors
    ///
    /// Returns an error for operations that complex numbers do not have, and for powers that are not whole.
    pub(crate) fn complex_parts(&self, work: &mut usize) -> Result<[Self; 2], ExpressionError> {
        let parts = self.parts(work)?;
        let size: usize = parts.iter().map(Self::size).sum();
        match size <= MOST {
            true => Ok(parts),
            false => Err(self.too_long()),
        }
    }

    fn parts(&self, work: &mut usize) -> Result<Parts, ExpressionError> {
        let of = |node: Node| Self {
            node,
            range: self.range(),
        };
        Ok(match &self.node {
            Node::Name(name) if name == UNIT => [self.literal(0.0), self.literal(1.0)],
            Node::Name(name) if scope::constant(name).is_none() => {
                [0, 1].map(|part| of(Node::Part(name.clone(), part)))
            }
            Node::Number(_) | Node::Name(_) | Node::Part(..) | Node::Call(..) | Node::Unknown => {
                [self.clone(), self.literal(0.0)]
            }
            Node::Prefix(One::Negate, operand) => {
                operand.parts(work)?.map(|part| self.negated(part))
            }
            Node::Infix(operation, operands) => {
                let [left, right] = &**operands;
                if *operation == Two::Power {
                    return self.power(left, right, work);
                }
                let (a, b) = (left.parts(work)?, right.parts(work)?);
                match operation {
                    Two::Add => self.sum(Two::Add, a, b),
                    Two::Subtract => self.sum(Two::Subtract, a, b),
                    Two::Multiply => self.product(&a, &b, work)?,
                    Two::Divide => self.quotient(&a, &b, work)?,
                    _ => return Err(self.not_complex()),
                }
            }
            Node::Truth(_) | Node::Prefix(..) => return Err(self.not_complex()),
        })
    }

    fn power(
        &self,
        base: &Self,
        exponent: &Self,
        work: &mut usize,
    ) -> Result<Parts, ExpressionError> {
        let z = base.parts(work)?;
        if z[1].is_zero() {
            let [base, zero] = z;
            return Ok([self.joined(Two::Power, base, exponent.clone()), zero]);
        }
        let (negative, number) = match &exponent.node {
            Node::Prefix(One::Negate, number) => (true, &number.node),
            number => (false, number),
        };
        let whole = match number {
            Node::Number(number) => (0..=MAX_POWER).find(|whole| f64::from(*whole) == *number),
            _ => None,
        };
        let Some(whole) = whole else {
            let message = "a complex number has only whole powers here";
            let hint = format!("an exponent is a number from -{MAX_POWER} to {MAX_POWER}");
            return Err(ExpressionError::new(exponent.range(), message).hint(hint));
        };
        let one = [self.literal(1.0), self.literal(0.0)];
        let mut product = one.clone();
        for bit in (0..u32::BITS - whole.leading_zeros()).rev() {
            product = self.product(&product.clone(), &product, work)?;
            if whole >> bit & 1 == 1 {
                product = self.product(&product, &z, work)?;
            }
        }
        match negative {
            true => self.quotient(&one, &product, work),
            false => Ok(product),
        }
    }

    fn sum(&self, operation: Two, [a, b]: Parts, [c, d]: Parts) -> Parts {
        [self.joined(operation, a, c), self.joined(operation, b, d)]
    }

    /// Returns (a + b i)(c + d i).
    fn product(
        &self,
        [a, b]: &Parts,
        [c, d]: &Parts,
        work: &mut usize,
    ) -> Result<Parts, ExpressionError> {
        self.check_size([a, b, c, d], work)?;
        let times = |x: &Self, y: &Self| self.joined(Two::Multiply, x.clone(), y.clone());
        Ok([
            self.joined(Two::Subtract, times(a, c), times(b, d)),
            self.joined(Two::Add, times(a, d), times(b, c)),
        ])
    }

    /// Returns (a + b i)/(c + d i). Where d is 0, the parts are divided by c alone.
    fn quotient(
        &self,
        [a, b]: &Parts,
        [c, d]: &Parts,
        work: &mut usize,
    ) -> Result<Parts, ExpressionError> {
        self.check_size([a, b, c, d], work)?;
        let times = |x: &Self, y: &Self| self.joined(Two::Multiply, x.clone(), y.clone());
        let over = |x: Self, y: &Self| self.joined(Two::Divide, x, y.clone());
        if d.is_zero() {
            return Ok([over(a.clone(), c), over(b.clone(), c)]);
        }
        if c.is_zero() {
            return Ok([over(b.clone(), d), self.negated(over(a.clone(), d))]);
        }
        let square = self.joined(Two::Add, times(c, c), times(d, d));
        let whole = [
            self.joined(Two::Add, times(a, c), times(b, d)),
            self.joined(Two::Subtract, times(b, c), times(a, d)),
        ];
        let whole = whole.map(|part| over(part, &square));
        let Some(select) = Function::find("if") else {
            return Ok(whole);
        };
        let is_real = self.joined(Two::Equal, d.clone(), self.literal(0.0));
        let [re, im] = whole;
        Ok([(a, re), (b, im)].map(|(part, otherwise)| {
            let arguments = vec![is_real.clone(), over(part.clone(), c), otherwise];
            self.with(Node::Call(select, arguments))
        }))
    }

    /// Returns an error if parts are too long for one more operation, which copies them.
    fn check_size(&self, parts: [&Self; 4], work: &mut usize) -> Result<(), ExpressionError> {
        let size: usize = parts.into_iter().map(Self::size).sum();
        *work += size;
        match size <= MOST {
            true => Ok(()),
            false => Err(self.too_long()),
        }
    }

    /// Returns the operation on two expressions, without literal zeros and ones where they have no effect.
    fn joined(&self, operation: Two, left: Self, right: Self) -> Self {
        match operation {
            Two::Add | Two::Subtract if right.is_zero() => left,
            Two::Add if left.is_zero() => right,
            Two::Subtract if left.is_zero() => self.negated(right),
            Two::Multiply if left.is_zero() || right.is_zero() => self.literal(0.0),
            Two::Divide if left.is_zero() => left,
            Two::Multiply if left.is_one() => right,
            Two::Multiply | Two::Divide if right.is_one() => left,
            _ => self.with(Node::Infix(operation, Box::new([left, right]))),
        }
    }

    fn negated(&self, part: Self) -> Self {
        match part.node {
            Node::Prefix(One::Negate, operand) => *operand,
            _ if part.is_zero() => part,
            _ => self.with(Node::Prefix(One::Negate, Box::new(part))),
        }
    }

    fn literal(&self, value: f64) -> Self {
        self.with(Node::Number(value))
    }

    fn with(&self, node: Node) -> Self {
        let range = self.range();
        Self { node, range }
    }

    fn is_zero(&self) -> bool {
        matches!(self.node, Node::Number(0.0))
    }

    fn is_one(&self) -> bool {
        matches!(self.node, Node::Number(1.0))
    }

    /// Returns the number of parts.
    fn size(&self) -> usize {
        let mut size = 0;
        self.visit(&mut |_| size += 1);
        size
    }

    fn not_complex(&self) -> ExpressionError {
        let message = "complex numbers have + - * / and whole powers only";
        ExpressionError::new(self.range(), message).hint("a point is also written [x, y]")
    }

    fn too_long(&self) -> ExpressionError {
        let message = "this is too long when its real and imaginary parts are written out";
        ExpressionError::new(self.range(), message).hint("make a parameter of a part of it")
    }
}
