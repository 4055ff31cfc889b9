//! Matrices without negative entries: spectral radius and eigenvector (Perron 1907, Frobenius 1912).

/// An entry of a matrix: row, column, value.
pub(super) type Entry = (usize, usize, f64);

/// The spectral radius of a matrix, and the vector that it lengthens by that.
#[derive(Clone, Debug)]
pub(super) struct Perron {
    pub(super) radius: f64,
    /// Positive, the largest of its entries about 1.
    pub(super) vector: Vec<f64>,
}

/// Rounds that narrow the enclosure, at most.
const MOST_ROUNDS: usize = 100_000;

/// An enclosure that is so narrow, relatively, is a value.
const NARROW: f64 = 4e-16;

/// The spectral radius of a strongly connected matrix, by power iteration on the matrix plus the
/// identity, which has one dominant eigenvalue even where the matrix is periodic. The quotients of
/// successive vectors enclose it (Collatz 1942, Wielandt 1950).
///
/// It is narrowed until it is `enough`, or to all digits.
pub(super) fn perron(size: usize, entries: &[Entry], enough: impl Fn([f64; 2]) -> bool) -> Perron {
    let mut vector = vec![1.0; size];
    let mut enclosed = [0.0, f64::INFINITY];
    for _ in 0..MOST_ROUNDS {
        let mut next = vector.clone();
        for &(row, column, value) in entries {
            next[row] += value * vector[column];
        }
        let quotients = next
            .iter()
            .zip(&vector)
            .map(|(next, entry)| next / entry - 1.0);
        enclosed = quotients.fold([f64::INFINITY, 0.0], |[low, high], quotient| {
            [low.min(quotient), high.max(quotient)]
        });
        let largest = next.iter().copied().fold(0.0, f64::max);
        next.iter_mut().for_each(|entry| *entry /= largest);
        let [low, high] = enclosed;
        if high - low <= NARROW * (1.0 + high) || enough(enclosed) {
            break;
        }
        vector = next;
    }
    Perron {
        radius: f64::midpoint(enclosed[0], enclosed[1]),
        vector,
    }
}

/// Whether an enclosure decides on which side of 1 a radius lies.
pub(super) fn beside_one([low, high]: [f64; 2]) -> bool {
    low > 1.0 || high < 1.0
}

/// Where a function of a number crosses 1, by halving what lies between a number where it does not
/// lie above 1 and another one where it does, to all digits.
pub(super) fn crossing(mut below: f64, mut above: f64, radius: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = below + (above - below) / 2.0;
        if middle <= below.min(above) || middle >= below.max(above) {
            return below;
        }
        if radius(middle) > 1.0 {
            above = middle;
        } else {
            below = middle;
        }
    }
}
