//! Parameters for which a point lies where a hand drags it.

/// A parameter that may move.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unknown {
    pub(super) name: String,
    pub(super) value: f64,
    pub(super) min: f64,
    pub(super) max: f64,
}

/// Largest number of parameters that move at once.
const MOST: usize = 2;

/// Returns values of at most two parameters, within their ranges, for which a point is nearest to a target: damped Gauss and
/// Newton steps of least squares from the present values. `None` if no parameter moves the point.
pub(super) fn solve(
    unknowns: &[Unknown],
    target: [f64; 2],
    place: &dyn Fn(&[f64]) -> Option<[f64; 2]>,
) -> Option<Vec<f64>> {
    let start: Vec<f64> = unknowns.iter().map(|it| it.value).collect();
    let effects = effects(unknowns, &start, place)?;
    let mut order: Vec<usize> = (0..unknowns.len()).collect();
    let strength = |index: usize| {
        let [x, y] = effects[index];
        // By the share of its range.
        libm::hypot(x, y) * span(&unknowns[index])
    };
    order.sort_by(|a, b| strength(*b).total_cmp(&strength(*a)));
    order.retain(|index| strength(*index) > 1e-9);
    order.truncate(MOST);
    if order.is_empty() {
        return None;
    }
    let error = |values: &[f64]| {
        let [x, y] = place(values)?;
        Some(libm::hypot(target[0] - x, target[1] - y))
    };
    let mut values = start;
    let mut best = error(&values)?;
    for _ in 0..40 {
        let effects = self::effects(unknowns, &values, place)?;
        let [x, y] = place(&values)?;
        let off = [target[0] - x, target[1] - y];
        let step = step(&order, &effects, off, unknowns);
        let mut factor = 1.0;
        let better = loop {
            let mut next = values.clone();
            for (index, by) in order.iter().zip(step) {
                let Unknown { min, max, .. } = unknowns[*index];
                next[*index] = (next[*index] + by * factor).clamp(min, max);
            }
            match error(&next) {
                Some(error) if error < best - 1e-15 => break Some((next, error)),
                _ if factor < 1e-6 => break None,
                _ => factor /= 2.0,
            }
        };
        let Some((next, error)) = better else { break };
        (values, best) = (next, error);
    }
    Some(values)
}

fn span(unknown: &Unknown) -> f64 {
    let span = unknown.max - unknown.min;
    if span.is_finite() {
        span
    } else {
        unknown.value.abs().max(1.0)
    }
}

/// Returns the derivatives of the point by each parameter.
fn effects(
    unknowns: &[Unknown],
    values: &[f64],
    place: &dyn Fn(&[f64]) -> Option<[f64; 2]>,
) -> Option<Vec<[f64; 2]>> {
    let all = unknowns.iter().enumerate().map(|(index, unknown)| {
        let by = span(unknown) * 1e-6;
        let at = |sign: f64| {
            let mut moved = values.to_vec();
            moved[index] = (moved[index] + sign * by).clamp(unknown.min, unknown.max);
            Some((place(&moved)?, moved[index]))
        };
        let ((after, high), (before, low)) = (at(1.0)?, at(-1.0)?);
        let width = if high > low { high - low } else { 1.0 };
        Some([0, 1].map(|axis| (after[axis] - before[axis]) / width))
    });
    all.collect()
}

/// Returns the step of least squares, slightly damped in shares of the ranges.
fn step(order: &[usize], effects: &[[f64; 2]], off: [f64; 2], unknowns: &[Unknown]) -> [f64; MOST] {
    let column = |number: usize| {
        order.get(number).map_or([0.0; 2], |index| {
            let scale = span(&unknowns[*index]);
            effects[*index].map(|it| it * scale)
        })
    };
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let (a, b) = (column(0), column(1));
    let damping = 1e-9 * (dot(a, a) + dot(b, b)).max(1e-12);
    let (aa, bb, ab) = (dot(a, a) + damping, dot(b, b) + damping, dot(a, b));
    let (ao, bo) = (dot(a, off), dot(b, off));
    let determinant = aa * bb - ab * ab;
    let shares = [
        (ao * bb - bo * ab) / determinant,
        (bo * aa - ao * ab) / determinant,
    ];
    let scale = |number: usize| {
        order
            .get(number)
            .map_or(0.0, |index| span(&unknowns[*index]))
    };
    [shares[0] * scale(0), shares[1] * scale(1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unknown(name: &str, value: f64, min: f64, max: f64) -> Unknown {
        let name = name.to_owned();
        Unknown {
            name,
            value,
            min,
            max,
        }
    }

    #[test]
    fn the_roof_of_a_tree_follows_the_hand() {
        let place = |values: &[f64]| {
            let angle = values[0].to_radians();
            Some([angle.cos().powi(2), 1.0 + angle.sin() * angle.cos()])
        };
        let unknowns = [unknown("angle", 45.0, 5.0, 85.0)];
        for wanted in [20.0, 60.0, 80.0] {
            let target = place(&[wanted]).unwrap();
            let found = solve(&unknowns, target, &place).unwrap();
            assert!((found[0] - wanted).abs() < 1e-6, "{found:?}");
        }
        // Beyond the range, it stays at its end.
        let found = solve(&unknowns, [1.1, 0.9], &place).unwrap();
        assert!((5.0..6.0).contains(&found[0]), "{found:?}");
    }

    #[test]
    fn two_parameters_reach_any_point_and_others_stay() {
        let place = |values: &[f64]| Some([values[0] * values[2], values[1] + 0.001 * values[2]]);
        let unknowns = [
            unknown("a", 0.3, 0.0, 1.0),
            unknown("b", 0.3, 0.0, 1.0),
            unknown("c", 1.0, 0.9, 1.1),
        ];
        let found = solve(&unknowns, [0.8, 0.1], &place).unwrap();
        assert!(
            found[2] == 1.0 && (found[0] - 0.8).abs() < 1e-6 && (found[1] - 0.099).abs() < 1e-6
        );
        assert!(solve(&unknowns, [1.0, 1.0], &|_| Some([0.0, 0.0])).is_none());
    }
}
