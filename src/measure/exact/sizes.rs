//! Pieces of comparable size: the ratios as powers of one number.
//!
//! A piece with the ratio ρ^k waits k − 1 generations before it is replaced. All pieces of generation n
//! therefore have sizes between ρ^n and a constant multiple of it.

use glam::DAffine3;

use super::hull::Flat;
use super::system::ratio;

/// A piece: the set that it is a copy of, and the number of generations that it still waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Piece {
    pub(super) set: usize,
    pub(super) wait: u32,
}

/// A piece that replaces another one, or a part of it, in the next generation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) piece: Piece,
    pub(super) map: DAffine3,
    pub(super) inverse: DAffine3,
    pub(super) ratio: f64,
}

impl Step {
    fn new(piece: Piece, map: DAffine3) -> Self {
        Self {
            piece,
            map,
            inverse: map.inverse(),
            ratio: ratio(map.matrix3),
        }
    }
}

/// A system of similarities by generations.
#[derive(Clone, Debug)]
pub(super) struct Generations {
    /// log 1/ρ.
    pub(super) depth: f64,
    /// Unit of every set, as a multiple of that of the system.
    pub(super) scale: Vec<f64>,
    /// Steps of a piece that does not wait, by set.
    steps: Vec<Vec<Step>>,
    /// Step of a piece that waits, by piece.
    waits: Vec<Vec<Step>>,
}

/// Maximum k; a larger one is not evidence of commensurable ratios.
const MAX_POWER: f64 = 64.0;

/// Difference up to which logarithms count as equal.
const EQUAL: f64 = 1e-10;

/// Maximum number of steps of a set, after sets of size ρ⁰ are expanded.
const MAX_STEPS: usize = 4_096;

impl Generations {
    /// Divides a system into generations. Returns `None` where ratios are not powers of one number along all
    /// cycles, or where there are too many steps.
    ///
    /// Precondition: the system is strongly connected.
    pub(super) fn of(flat: &Flat) -> Option<Self> {
        let logs: Vec<f64> = flat
            .copies
            .iter()
            .map(|copy| -libm::log(ratio(copy.map.matrix3)))
            .collect();
        let (units, depth) = match common_measure(&logs) {
            Some(depth) => (vec![0.0; flat.size], depth),
            None => units(flat, &logs)?,
        };
        let powers = over(flat, &logs, &units);
        let scale: Vec<f64> = units.iter().map(|&unit| libm::exp(-unit)).collect();
        let mut direct: Vec<Vec<(usize, u32, DAffine3)>> = vec![Vec::new(); flat.size];
        for (copy, power) in flat.copies.iter().zip(powers) {
            let (outer, inner) = (scale[copy.from], scale[copy.to]);
            let map = DAffine3 {
                matrix3: copy.map.matrix3 * (outer / inner),
                translation: copy.map.translation * outer,
            };
            direct[copy.from].push((copy.to, whole(power / depth), map));
        }
        let steps = (0..flat.size)
            .map(|set| expanded(&direct, set))
            .collect::<Option<Vec<_>>>()?;
        let longest = steps.iter().flatten().map(|step| step.piece.wait).max()?;
        let waiting = (0..flat.size).flat_map(|set| {
            let pieces = (0..longest).map(move |wait| Piece { set, wait });
            pieces.map(|piece| vec![Step::new(piece, DAffine3::IDENTITY)])
        });
        Some(Self {
            depth,
            scale,
            steps,
            waits: waiting.collect(),
        })
    }

    /// Returns the number of sets.
    pub(super) fn size(&self) -> usize {
        self.steps.len()
    }

    /// Returns the copies that each set is made of: set and map.
    pub(super) fn first_steps(&self) -> Vec<Vec<(usize, DAffine3)>> {
        let copies = |steps: &Vec<Step>| {
            let steps = steps.iter();
            steps.map(|step| (step.piece.set, step.map)).collect()
        };
        self.steps.iter().map(copies).collect()
    }

    /// Returns the pieces that replace a piece in the next generation.
    pub(super) fn steps(&self, piece: Piece) -> &[Step] {
        let Some(wait) = piece.wait.checked_sub(1) else {
            return &self.steps[piece.set];
        };
        let longest = self.waits.len() / self.steps.len();
        &self.waits[piece.set * longest + wait as usize]
    }
}

/// Returns a unit for every set, as a logarithm, in which the ratios are powers ρ⁰, ρ¹, …, and log 1/ρ.
///
/// `logs` are those of 1/ratio, by copy.
fn units(flat: &Flat, logs: &[f64]) -> Option<(Vec<f64>, f64)> {
    // Along a tree all ratios may be 1: the remaining ones are those of cycles.
    let mut units = vec![None; flat.size];
    units[0] = Some(0.0);
    let mut left = flat.size - 1;
    // Every round finds a unit: the system is connected.
    for _ in 0..flat.size {
        if left == 0 {
            break;
        }
        for (copy, log) in flat.copies.iter().zip(logs) {
            match (units[copy.from], units[copy.to]) {
                (Some(unit), None) => units[copy.to] = Some(unit + log),
                (None, Some(unit)) => units[copy.from] = Some(unit - log),
                _ => continue,
            }
            left -= 1;
        }
    }
    let mut units: Vec<f64> = units.into_iter().map(|unit| unit.unwrap_or(0.0)).collect();
    let logs = over(flat, logs, &units);
    let depth = common_measure(&logs)?;
    // The shortest paths from the first set (Bellman 1958) make all powers non-negative.
    let mut shortest = vec![f64::INFINITY; flat.size];
    shortest[0] = 0.0;
    for _ in 0..flat.size {
        let mut is_still = true;
        for (copy, log) in flat.copies.iter().zip(&logs) {
            let way = shortest[copy.from] + (log / depth).round();
            if way < shortest[copy.to] {
                shortest[copy.to] = way;
                is_still = false;
            }
        }
        if is_still {
            break;
        }
    }
    for (unit, shortest) in units.iter_mut().zip(&shortest) {
        *unit += shortest * depth;
    }
    Some((units, depth))
}

/// Returns the logarithms of the ratios between sets in their units.
fn over(flat: &Flat, logs: &[f64], units: &[f64]) -> Vec<f64> {
    let copies = flat.copies.iter().zip(logs);
    copies
        .map(|(copy, log)| units[copy.from] + log - units[copy.to])
        .collect()
}

/// Returns the steps of a set, in which sets of its own size are replaced by their steps; `None` if there are
/// too many.
fn expanded(direct: &[Vec<(usize, u32, DAffine3)>], set: usize) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    let mut open: Vec<_> = direct[set].iter().rev().copied().collect();
    while let Some((to, power, map)) = open.pop() {
        match power.checked_sub(1) {
            Some(wait) => steps.push(Step::new(Piece { set: to, wait }, map)),
            None => open.extend(
                direct[to]
                    .iter()
                    .rev()
                    .map(|&(next, power, inner)| (next, power, map * inner)),
            ),
        }
        if steps.len() + open.len() > MAX_STEPS {
            return None;
        }
    }
    Some(steps)
}

/// Returns the largest number of which all values are integer multiples, to about 12 digits.
fn common_measure(values: &[f64]) -> Option<f64> {
    let sizes = || {
        values
            .iter()
            .map(|value| value.abs())
            .filter(|&size| size > EQUAL)
    };
    let largest = sizes().fold(0.0, f64::max);
    let mut measure = 0.0;
    for value in sizes() {
        let (mut larger, mut smaller) = (value, measure);
        while smaller > EQUAL {
            if smaller < largest / (2.0 * MAX_POWER) {
                return None;
            }
            let rest = larger - smaller * (larger / smaller).round();
            (larger, smaller) = (smaller, rest.abs());
        }
        measure = larger;
    }
    if measure == 0.0 {
        return None;
    }
    let multiples: f64 = sizes().map(|size| (size / measure).round()).sum();
    let measure = sizes().sum::<f64>() / multiples;
    let fits = sizes().all(|size| {
        let multiple = (size / measure).round();
        multiple <= MAX_POWER && (size - multiple * measure).abs() <= EQUAL
    });
    fits.then_some(measure)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number from 0 to a small multiple of the largest power, rounded"
)]
fn whole(power: f64) -> u32 {
    power.round() as u32
}
