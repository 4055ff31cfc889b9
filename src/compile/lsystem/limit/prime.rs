//! Fields of a prime number of elements that have roots of unity.

/// Field of p elements, p prime and below 2⁶², with the powers of a root of unity of some order.
pub(super) struct Field {
    prime: u64,
    root: u64,
}

/// Bound of the primes.
const MOST: u64 = 1 << 61;

impl Field {
    /// Returns a field that has roots of unity of an order; `None` for the order 0.
    pub(super) fn with_roots(order: u64) -> Option<Self> {
        let last = (MOST - 1).checked_div(order)?;
        let primes = (1..=last).rev().map(|times| times * order + 1);
        let prime = primes.into_iter().find(|&number| is_prime(number))?;
        let factors = factors(order);
        let mut field = Self { prime, root: 1 };
        // The power of a primitive element is a root of the order; one element of two or so is fit.
        let is_fit = |&root: &u64| factors.iter().all(|&f| field.power(root, order / f) != 1);
        let roots = (2..prime).map(|base| field.power(base, (prime - 1) / order));
        field.root = { roots }.find(is_fit)?;
        Some(field)
    }

    pub(super) fn sum(&self, a: u64, b: u64) -> u64 {
        (a + b) % self.prime
    }

    pub(super) fn difference(&self, a: u64, b: u64) -> u64 {
        (a + self.prime - b) % self.prime
    }

    pub(super) fn product(&self, a: u64, b: u64) -> u64 {
        product(a, b, self.prime)
    }

    fn power(&self, base: u64, exponent: u64) -> u64 {
        power(base, exponent, self.prime)
    }

    /// Returns the inverse; 0 for 0.
    pub(super) fn inverse(&self, a: u64) -> u64 {
        self.power(a, self.prime - 2)
    }

    /// Returns a power of the root of unity.
    pub(super) fn root(&self, exponent: u64) -> u64 {
        self.power(self.root, exponent)
    }

    /// Returns the residue of a double, which is a whole number times a power of two.
    pub(super) fn of(&self, value: f64) -> u64 {
        /// Number of bits of a double's mantissa.
        const DIGITS: i32 = 53;
        let (mantissa, exponent) = libm::frexp(value.abs());
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is a whole number of 53 bits"
        )]
        let mantissa = libm::ldexp(mantissa, DIGITS) as u64;
        let exponent = exponent - DIGITS;
        let two = self.power(2, exponent.unsigned_abs().into());
        let two = if exponent < 0 { self.inverse(two) } else { two };
        let residue = self.product(mantissa % self.prime, two);
        if value < 0.0 {
            self.difference(0, residue)
        } else {
            residue
        }
    }
}

fn product(a: u64, b: u64, modulus: u64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the remainder is below the modulus"
    )]
    {
        (u128::from(a) * u128::from(b) % u128::from(modulus)) as u64
    }
}

fn power(base: u64, mut exponent: u64, modulus: u64) -> u64 {
    let (mut base, mut power) = (base % modulus, 1);
    while exponent > 0 {
        if exponent & 1 == 1 {
            power = product(power, base, modulus);
        }
        base = product(base, base, modulus);
        exponent >>= 1;
    }
    power
}

/// Returns whether a number above 37 is prime, by the test of Miller and Rabin for the bases that decide it below 2⁶⁴
/// (Sorenson & Webster 2015).
fn is_prime(number: u64) -> bool {
    const BASES: [u64; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    if number <= 37 || BASES.iter().any(|base| number.is_multiple_of(*base)) {
        return BASES.contains(&number);
    }
    let twos = (number - 1).trailing_zeros();
    BASES.iter().all(|&base| {
        let mut residue = power(base, (number - 1) >> twos, number);
        let mut passes = residue == 1 || residue == number - 1;
        for _ in 1..twos {
            residue = product(residue, residue, number);
            passes |= residue == number - 1;
        }
        passes
    })
}

/// Returns the prime factors of a number.
fn factors(mut number: u64) -> Vec<u64> {
    let mut factors = Vec::new();
    let mut factor = 2;
    while factor * factor <= number {
        if number.is_multiple_of(factor) {
            factors.push(factor);
            while number.is_multiple_of(factor) {
                number /= factor;
            }
        }
        factor += 1;
    }
    if number > 1 {
        factors.push(number);
    }
    factors
}

#[cfg(test)]
mod tests {
    use super::{Field, is_prime};

    #[test]
    fn roots_of_unity_have_their_order() {
        for order in [1, 2, 4, 6, 8, 10, 72, 360, 3600, 1_000_003] {
            let field = Field::with_roots(order).unwrap();
            assert!(is_prime(field.prime) && field.prime % order == 1 % order);
            let first = (1..=order.min(4000)).find(|&it| field.root(it) == 1);
            assert_eq!(first.unwrap_or(order), order);
            assert_eq!(field.root(order), 1);
        }
        assert!(Field::with_roots(0).is_none());
    }

    #[test]
    fn residues_of_doubles_add_and_multiply() {
        let field = Field::with_roots(12).unwrap();
        let of = |value| field.of(value);
        assert_eq!(field.sum(of(0.375), of(-1.5)), of(-1.125));
        assert_eq!(field.product(of(0.375), of(-1.5)), of(-0.5625));
        assert_eq!(field.product(of(-0.5), field.inverse(of(-0.5))), 1);
    }
}
