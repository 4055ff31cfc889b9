//! Matrices without negative entries: spectral radius and eigenvector (Perron 1907, Frobenius 1912).

/// An entry of a matrix: row, column, value.
pub(super) type Entry = (usize, usize, f64);

/// Spectral radius of a matrix, and its eigenvector.
#[derive(Clone, Debug)]
pub(super) struct Perron {
    pub(super) radius: f64,
    /// The eigenvector: positive, with its largest entry near 1.
    pub(super) vector: Vec<f64>,
}

/// Maximum number of iterations.
const MAX_ROUNDS: usize = 100_000;

/// Maximum number of entries that all iterations together multiply.
const MAX_WORK: usize = 1_000_000_000;

/// Number of iterations without a narrower enclosure after which only rounding is left, if the enclosure is as narrow as
/// [`ROUNDING`]. No iteration widens it, but for rounding.
const PATIENCE: usize = 16;

/// Relative width at which an enclosure counts as a value.
const NARROW: f64 = 4e-16;

/// Relative width of an enclosure that rounding may cause.
const ROUNDING: f64 = 1e-11;

/// Computes the spectral radius of a strongly connected matrix, by power iteration on the matrix plus the
/// identity, which has one dominant eigenvalue even where the matrix is periodic. The quotients of successive
/// vectors enclose it (Collatz 1942, Wielandt 1950).
///
/// The enclosure is narrowed until `enough` returns `true` for its lower and upper bounds, as far as rounding allows, and
/// as far as a limit of work does.
pub(super) fn perron(size: usize, entries: &[Entry], enough: impl Fn([f64; 2]) -> bool) -> Perron {
    let mut vector = vec![1.0; size];
    let mut enclosed = [0.0, f64::INFINITY];
    let (mut narrowest, mut since) = (f64::INFINITY, 0);
    for _ in 0..MAX_ROUNDS.min(MAX_WORK / entries.len().max(1)) {
        let mut next = vector.clone();
        // Entries of a row are next to each other, as a rule, and are summed without stores.
        for entries in entries.chunk_by(|a, b| a.0 == b.0) {
            let products = entries.iter();
            let products = products.map(|(_, column, value)| value * vector[*column]);
            next[entries[0].0] += products.sum::<f64>();
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
        let width = high - low;
        since = if width < narrowest { 0 } else { since + 1 };
        narrowest = narrowest.min(width);
        let is_rounding = since >= PATIENCE && width <= ROUNDING * (1.0 + high);
        if width <= NARROW * (1.0 + high) || is_rounding || enough(enclosed) {
            break;
        }
        vector = next;
    }
    Perron {
        radius: f64::midpoint(enclosed[0], enclosed[1]),
        vector,
    }
}

/// Returns `true` if an enclosure decides on which side of 1 a radius lies.
pub(super) fn beside_one([low, high]: [f64; 2]) -> bool {
    low > 1.0 || high < 1.0
}

/// Finds the argument at which a function crosses 1, by bisection to the precision of a double, between
/// `below`, where the function is not above 1, and `above`, where it is.
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
