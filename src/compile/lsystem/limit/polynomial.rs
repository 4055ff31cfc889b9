//! Roots of polynomials of largest absolute value.
//!
//! Common divisors are found by Euclid's algorithm, whose remainders are 0 where their residues are. A polynomial without
//! multiple roots has simple ones, which Aberth's method (1973) finds in doubles and Newton's in long numbers.

use crate::geometry::DVec2;

use super::number::{Complex, Float, Number, Numbers};

/// Coefficients by increasing degree; the last is not 0. Empty for the polynomial 0.
pub(super) type Polynomial = Vec<Number>;

/// Limit of the number of iterations in doubles.
const MAX_ITERATIONS: u32 = 400;

/// Relative difference, as a power of two, below which long numbers are equal.
pub(super) const SAME: f64 = -200.0;

/// Roots of largest absolute value.
#[derive(Debug)]
pub(super) struct Largest {
    /// Different roots of one absolute value.
    pub(super) roots: Vec<Complex>,
    /// Largest multiplicity of a root.
    pub(super) multiplicity: u32,
}

/// Returns the roots of largest absolute value of a polynomial of positive degree whose constant coefficient is not 0;
/// `None` if they are not found.
pub(super) fn largest(polynomial: &Polynomial, numbers: &Numbers) -> Option<Largest> {
    let common = common(polynomial.clone(), derivative(polynomial, numbers), numbers);
    let (simple, _) = divided(polynomial.clone(), &common, numbers);
    let mut roots = roots(&simple, numbers)?;
    let longest = roots.iter().map(Complex::log2).fold(f64::MIN, f64::max);
    // Doubles sort out, long numbers compare.
    roots.retain(|root| root.log2() > longest - 1e-9);
    let first = roots.iter().map(Complex::norm).reduce(Float::max)?;
    roots.retain(|root| super::number::log2(&(root.norm() - &first)) <= 2.0 * longest + SAME);
    let multiplicity = match common.len() {
        0 | 1 => 1,
        _ => {
            let multiple = largest(&common, numbers)?;
            let size = multiple.roots.first()?.norm();
            let is_same = super::number::log2(&(size - &first)) <= 2.0 * longest + SAME;
            1 + if is_same { multiple.multiplicity } else { 0 }
        }
    };
    Some(Largest {
        roots,
        multiplicity,
    })
}

fn derivative(polynomial: &Polynomial, numbers: &Numbers) -> Polynomial {
    let terms = (1u32..).zip(polynomial.iter().skip(1));
    terms
        .map(|(degree, factor)| numbers.times(&numbers.real(degree.into()), factor))
        .collect()
}

/// Returns the greatest common divisor.
fn common(mut a: Polynomial, mut b: Polynomial, numbers: &Numbers) -> Polynomial {
    while !b.is_empty() {
        let (_, rest) = divided(a, &b, numbers);
        (a, b) = (b, rest);
    }
    a
}

/// Returns the quotient and the remainder of a division by a polynomial other than 0.
fn divided(
    mut polynomial: Polynomial,
    by: &Polynomial,
    numbers: &Numbers,
) -> (Polynomial, Polynomial) {
    let mut quotient = Vec::new();
    let [lower @ .., leading] = by.as_slice() else {
        return (quotient, polynomial);
    };
    while polynomial.len() >= by.len() {
        let Some(last) = polynomial.pop() else { break };
        let factor = numbers.over(&last, leading);
        let place = polynomial.len() - lower.len();
        for (number, inner) in polynomial[place..].iter_mut().zip(lower) {
            *number = numbers.minus(number, &numbers.times(&factor, inner));
        }
        quotient.push(factor);
    }
    quotient.reverse();
    while polynomial.last().is_some_and(Number::is_zero) {
        polynomial.pop();
    }
    (quotient, polynomial)
}

/// Returns the roots of a polynomial of positive degree that has no multiple ones.
fn roots(polynomial: &Polynomial, numbers: &Numbers) -> Option<Vec<Complex>> {
    let leading = &polynomial.last()?.value;
    let monic: Vec<Complex> = { polynomial.iter() }
        .map(|factor| factor.value.over(leading))
        .collect();
    let degree = monic.len() - 1;
    // Scaled by a power of two, the roots are at most 2.
    let size = |(less, factor): (u32, &Complex)| factor.log2() / f64::from(less);
    let sizes = (1..).zip(monic.iter().rev().skip(1)).map(size);
    let scale = sizes.fold(f64::MIN, f64::max).ceil();
    #[expect(
        clippy::cast_possible_truncation,
        reason = "exponents of long numbers fit"
    )]
    let scale = scale as isize;
    let power = |less: usize| scale * isize::try_from(less).unwrap_or(0);
    let near: Vec<DVec2> = { monic.iter().enumerate() }
        .map(|(number, factor)| factor.near(power(degree - number)))
        .collect();
    let bits = numbers.bits();
    let found = aberth(&near)?.into_iter().map(|start| {
        let start = Complex::of(start, bits);
        let start = Complex {
            re: start.re << scale,
            im: start.im << scale,
        };
        newton(&monic, start, bits)
    });
    let roots: Vec<Complex> = found.collect::<Option<_>>()?;
    // Different starts that lead to one root leave another one out.
    let differ = |(a, b): (&Complex, &Complex)| (a - b).log2() > a.log2() + SAME;
    let mut pairs = (1..degree).flat_map(|a| (0..a).map(move |b| (a, b)));
    { pairs.all(|(a, b)| differ((&roots[a], &roots[b]))) }.then_some(roots)
}

/// Returns the value and the derivative of a polynomial at a point.
fn values(factors: &[Complex], at: &Complex, bits: usize) -> [Complex; 2] {
    let zero = || Complex::real(0.0, bits);
    let mut values = [zero(), zero()];
    for factor in factors.iter().rev() {
        values[1] = &(&values[1] * at) + &values[0];
        values[0] = &(&values[0] * at) + factor;
    }
    values
}

/// Refines a root; `None` if it does not converge.
fn newton(factors: &[Complex], mut root: Complex, bits: usize) -> Option<Complex> {
    const MAX_STEPS: u32 = 64;
    for _ in 0..MAX_STEPS {
        let [value, slope] = values(factors, &root, bits);
        let step = value.over(&slope);
        let size = root.log2();
        root = &root - &step;
        if step.log2() <= size + 2.0 * SAME {
            return Some(root);
        }
    }
    None
}

/// Returns approximations of the roots of a monic polynomial whose roots are at most 2.
fn aberth(factors: &[DVec2]) -> Option<Vec<DVec2>> {
    let degree = factors.len().checked_sub(1)?;
    let over = |a: DVec2, b: DVec2| DVec2::new(b.x, -b.y).rotate(a) / b.length_squared();
    let start = |number: usize| {
        #[expect(clippy::cast_precision_loss, reason = "degrees are small")]
        let angle = number as f64 * std::f64::consts::TAU / degree as f64 + 0.4;
        0.9 * DVec2::new(libm::cos(angle), libm::sin(angle))
    };
    let mut roots: Vec<DVec2> = (0..degree).map(start).collect();
    for _ in 0..MAX_ITERATIONS {
        let mut longest: f64 = 0.0;
        for number in 0..degree {
            let at = roots[number];
            let (mut value, mut slope) = (DVec2::ZERO, DVec2::ZERO);
            for factor in factors.iter().rev() {
                slope = slope.rotate(at) + value;
                value = value.rotate(at) + *factor;
            }
            if value == DVec2::ZERO {
                continue;
            }
            let newton = over(slope, value);
            let others = { roots.iter().enumerate() }.filter(|(other, _)| *other != number);
            let repelled: DVec2 = { others.map(|(_, root)| over(DVec2::X, at - *root)) }
                .filter(|it| it.is_finite())
                .sum();
            let step = over(DVec2::X, newton - repelled);
            if step.is_finite() {
                roots[number] = at - step;
                longest = longest.max(step.length() / at.length().max(f64::MIN_POSITIVE));
            }
        }
        if longest < 1e-12 {
            break;
        }
    }
    roots.iter().all(|root| root.is_finite()).then_some(roots)
}
