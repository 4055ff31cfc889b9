//! Exact systems near a fitted one: simple ratios, angles and shifts.

mod lattice;
mod ratio;

use std::sync::atomic::AtomicBool;

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::random::Pcg;

use super::attractor::Attractor;
use super::candidate::fixed_point;
use super::cma::Cma;
use super::orbit::{Level, Orbit};
use super::{Candidate, FitError, Shape};
use lattice::Lattice;
pub(super) use ratio::nearest as nearest_ratio;

/// Offset in pixels within which a shift is replaced by a number of a lattice.
const NEAR: f64 = 3.0;
/// Complexity that a shift by a pixel is worth.
const FAR: f64 = 6.0;
/// Largest relative change of a ratio.
const RATIO: f64 = 0.03;
/// Largest change of an angle, in degrees.
const ANGLE: f64 = 3.0;
/// Steps of a pixel to which places are rounded, if the picture stays exact.
const ROUND: [f64; 6] = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125];
/// Number of exact pictures that are drawn to find a place, if at most a pixel in this many is wrong.
const DRAWN: usize = 150;
const FEW: usize = 40;
/// Number of snapped systems whose place is searched.
const TRIED: usize = 3;

/// A similarity of the complex plane, z → factor z + shift, or factor conj z + shift.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Similar {
    factor: DVec2,
    shift: DVec2,
    flips: bool,
}

/// A system in the coordinates of a frame, which has its origin at a fixed point of the system and its unit at another.
#[derive(Clone, Debug)]
struct Snapped {
    maps: Vec<Similar>,
    /// Origin and unit of the frame, in pixels.
    frame: [DVec2; 2],
    loss: f64,
    complexity: usize,
}

/// Returns an exact system near a candidate of similarities, if there is one whose picture is no worse than an
/// intersection over union `before`.
///
/// The attractor's picture decides: simple numbers are kept only if the intersection over union does not fall.
pub(super) fn snap(
    shape: &Shape,
    level: &Level,
    found: &Candidate,
    before: f64,
    cancel: Option<&AtomicBool>,
) -> Result<Option<(Candidate, Attractor)>, FitError> {
    let mut orbit = Orbit::new(level);
    let iou = |drawn: &Attractor| super::score::iou(shape.bits(), &drawn.pixels);
    let mut all: Vec<Snapped> = Vec::new();
    for lattice in Lattice::ALL {
        let numbers = lattice.numbers();
        for [one, other] in frames(found) {
            let Some(snapped) = snapped(found, [one, other], lattice, &numbers) else {
                continue;
            };
            let loss = orbit.loss(&snapped.placed(snapped.frame), level);
            all.push(Snapped { loss, ..snapped });
        }
    }
    // Rough frames hide good systems: all near the best are kept, the simplest first.
    let least = all.iter().map(|it| it.loss).fold(f64::INFINITY, f64::min);
    all.retain(|it| it.loss < 2.0 * least + 0.1);
    all.sort_by_key(|it| it.complexity);
    let mut known: Vec<Vec<Similar>> = Vec::new();
    let mut best: Option<(f64, Candidate, Attractor)> = None;
    for snapped in all {
        if known.contains(&snapped.maps) {
            continue;
        }
        if known.len() == TRIED {
            break;
        }
        known.push(snapped.maps.clone());
        let frame = snapped.settled(shape, level, &mut orbit);
        let (candidate, drawn) = snapped.polished(shape, frame, cancel)?;
        let own = iou(&drawn);
        if drawn.is(shape.bits()) {
            return Ok(Some((candidate, drawn)));
        }
        if own >= before && best.as_ref().is_none_or(|best| own > best.0) {
            best = Some((own, candidate, drawn));
        }
    }
    Ok(best.map(|(_, candidate, drawn)| (candidate, drawn)))
}

/// Returns simple ratios near ratios, of which near ones share one; `None` if a ratio is not near a simple one.
pub(super) fn shared_ratios(ratios: &[f64]) -> Option<Vec<f64>> {
    ratio::shared(ratios, RATIO)
}

/// Returns pairs of fixed points that are far from each other, as origins and units of frames.
fn frames(candidate: &Candidate) -> Vec<[DVec2; 2]> {
    const PAIRS: usize = 8;
    let fixed: Vec<DVec2> = candidate.maps.iter().filter_map(fixed_point).collect();
    let mut pairs: Vec<[DVec2; 2]> = Vec::new();
    for (number, &one) in fixed.iter().enumerate() {
        pairs.extend(fixed[..number].iter().map(|&other| [other, one]));
    }
    pairs.sort_by(|a, b| b[0].distance(b[1]).total_cmp(&a[0].distance(a[1])));
    pairs.truncate(PAIRS);
    pairs.retain(|pair| pair[0].distance(pair[1]) > 4.0);
    pairs
}

/// Returns the system with all numbers replaced by those of a lattice, in a frame.
#[expect(clippy::cast_precision_loss, reason = "complexities are small")]
fn snapped(
    candidate: &Candidate,
    [origin, end]: [DVec2; 2],
    lattice: Lattice,
    numbers: &[(DVec2, usize)],
) -> Option<Snapped> {
    let unit = end - origin;
    let length = unit.length();
    let place = DAffine2::from_cols(unit, unit.perp(), origin);
    let back = place.inverse();
    let maps: Vec<DAffine2> = candidate
        .maps
        .iter()
        .map(|map| back * *map * place)
        .collect();
    let ratios: Vec<f64> = maps.iter().map(|map| map.matrix2.x_axis.length()).collect();
    let ratios = ratio::shared(&ratios, RATIO)?;
    let mut complexity = 0;
    let mut snapped = Vec::new();
    for (map, ratio) in maps.iter().zip(ratios) {
        let angle = libm::atan2(map.matrix2.x_axis.y, map.matrix2.x_axis.x).to_degrees();
        let step = lattice.angle();
        let turned = (angle / step).round() * step;
        if (turned - angle).abs() > ANGLE {
            return None;
        }
        let mut best: Option<(f64, DVec2, usize)> = None;
        for &(number, own) in numbers {
            let away = number.distance(map.translation) * length;
            let cost = own as f64 + FAR * away * away;
            if away <= NEAR && best.is_none_or(|best| cost < best.0) {
                best = Some((cost, number, own));
            }
        }
        let (_, shift, own) = best?;
        complexity += own;
        let turned = turned.to_radians();
        snapped.push(Similar {
            factor: ratio * DVec2::new(libm::cos(turned), libm::sin(turned)),
            shift,
            flips: map.matrix2.determinant() < 0.0,
        });
    }
    Some(Snapped {
        maps: snapped,
        frame: [origin, unit],
        loss: f64::INFINITY,
        complexity,
    })
}

impl Snapped {
    /// Returns the system in pixels, in a frame.
    fn placed(&self, [origin, unit]: [DVec2; 2]) -> Candidate {
        let place = DAffine2::from_cols(unit, unit.perp(), origin);
        let maps = self.maps.iter().map(|map| {
            let across = if map.flips {
                -map.factor.perp()
            } else {
                map.factor.perp()
            };
            let matrix = DMat2::from_cols(map.factor, across);
            place * DAffine2::from_mat2_translation(matrix, map.shift) * place.inverse()
        });
        Candidate::of_maps(maps.collect())
    }

    /// Returns the frame in which the system is closest to the shape.
    fn settled(&self, shape: &Shape, level: &Level, orbit: &mut Orbit) -> [DVec2; 2] {
        let size = shape.radius() / self.frame[1].length();
        let numbers = |frame: [DVec2; 2]| {
            let [origin, unit] = frame;
            vec![origin.x, origin.y, unit.x * size, unit.y * size]
        };
        let frame = |numbers: &[f64]| {
            [
                DVec2::new(numbers[0], numbers[1]),
                DVec2::new(numbers[2], numbers[3]) / size,
            ]
        };
        let mut search = Cma::new(numbers(self.frame), 0.7, Pcg::new(11, 5));
        let found = search.minimise(400, 0.005, |numbers| {
            orbit.loss(&self.placed(frame(numbers)), level)
        });
        frame(&found.point)
    }

    /// Returns the system with its exact picture, moved until their pixels are those of the shape, or as many as can be.
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    fn polished(
        &self,
        shape: &Shape,
        mut frame: [DVec2; 2],
        cancel: Option<&AtomicBool>,
    ) -> Result<(Candidate, Attractor), FitError> {
        const STEPS: [f64; 5] = [0.5, 0.25, 0.12, 0.06, 0.03];
        let draw = |frame| -> Result<_, FitError> {
            let candidate = self.placed(frame);
            let drawn = candidate.attractor(shape.size(), cancel)?;
            Ok((drawn.mismatches(shape.bits()), candidate, drawn))
        };
        let upright = upright(frame[1]);
        let mut best = draw(frame)?;
        let straight = draw([frame[0], upright])?;
        if straight.0 <= best.0 {
            (frame[1], best) = (upright, straight);
        }
        let size = frame[1].length() / shape.radius();
        for step in STEPS {
            let mut moves = 0;
            while best.0 > 0 && moves < 10 {
                let mut moved = false;
                let ways = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
                let along = frame[1].normalize_or_zero();
                let tried =
                    ways.iter()
                        .map(|way| [frame[0] + step * *way, frame[1]])
                        .chain([along, -along].map(|way| {
                            [frame[0] - step * way / 2.0, frame[1] + step * size * way]
                        }));
                let turned = [along.perp(), -along.perp()]
                    .map(|way| [frame[0], frame[1] + step * size * way]);
                for tried in tried.chain(turned).collect::<Vec<_>>() {
                    let drawn = draw(tried)?;
                    if drawn.0 < best.0 {
                        (best, frame, moved) = (drawn, tried, true);
                    }
                }
                if !moved {
                    break;
                }
                moves += 1;
            }
        }
        let few = shape.points().len() / FEW;
        if best.0 > 0 && best.0 <= few as u64 {
            let mut failed = None;
            let numbers = |numbers: &[f64]| {
                let along = (
                    frame[1].normalize_or_zero(),
                    frame[1].perp().normalize_or_zero(),
                );
                let origin = frame[0] + DVec2::new(numbers[0], numbers[1]);
                let unit = frame[1] + size * (numbers[2] * along.0 + numbers[3] * along.1);
                [origin, unit]
            };
            let mut search = Cma::new(vec![0.0; 4], 0.1, Pcg::new(13, 5));
            let found = search.minimise(DRAWN, 0.005, |point| match draw(numbers(point)) {
                Ok(drawn) => drawn.0 as f64,
                Err(error) => {
                    failed = Some(error);
                    0.0
                }
            });
            if let Some(error) = failed {
                return Err(error);
            }
            let moved = numbers(&found.point);
            let drawn = draw(moved)?;
            if drawn.0 < best.0 {
                (best, frame) = (drawn, moved);
            }
        }
        // Of the frames with the same picture, one with round numbers.
        for step in ROUND {
            if best.0 > 0 {
                break;
            }
            let round = |point: DVec2| (point / step).round() * step;
            let [origin, unit] = frame;
            let end = round(origin + unit);
            let upright = [origin.x - (origin + unit).x, origin.y - (origin + unit).y];
            let rounded = match upright.map(|away| away.abs() < 1e-9) {
                // Upright frames stay upright.
                [true, _] | [_, true] => [round(origin), end - round(origin)],
                _ => [round(origin), unit],
            };
            let drawn = draw(rounded)?;
            if drawn.0 == 0 {
                best = drawn;
                break;
            }
        }
        Ok((best.1, best.2))
    }
}

/// Returns a vector turned to the nearest multiple of 15 degrees, if it is within a degree.
fn upright(unit: DVec2) -> DVec2 {
    let angle = libm::atan2(unit.y, unit.x).to_degrees();
    let nearest = (angle / 15.0).round() * 15.0;
    if (angle - nearest).abs() > 1.0 {
        return unit;
    }
    let turned = nearest.to_radians();
    unit.length() * DVec2::new(libm::cos(turned), libm::sin(turned))
}
