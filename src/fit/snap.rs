//! Exact systems near a fitted one: simple ratios, angles and shifts.

mod canonical;
mod lattice;
mod ratio;

use std::sync::atomic::AtomicBool;

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::random::Pcg;

use super::attractor::Attractor;
use super::candidate::fixed_point;
use super::cma::Cma;
use super::orbit::{Level, Orbit};
use super::{Candidate, FitError, Silhouette};
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
/// Number of exact pictures that are drawn to find a place, if at most a pixel in this many is wrong.
const DRAWN: usize = 150;
const FEW: usize = 40;
/// Number of parts of attractors that are visited to find a place, and where the first picture has wrong pixels of more than a
/// quarter of the shape.
const WORK: usize = 8_000_000;
const LITTLE_WORK: usize = 1_000_000;
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

/// A system in a place, with its picture.
struct Placed {
    frame: [DVec2; 2],
    candidate: Candidate,
    drawn: Attractor,
    /// Number of pixels in which the picture differs from the shape.
    wrong: u64,
}

/// Returns an exact system near a candidate of similarities, if there is one whose picture is no worse than an
/// intersection over union `before`.
///
/// The attractor's picture decides: simple numbers are kept only if the intersection over union does not fall.
pub(super) fn snap(
    shape: &Silhouette,
    level: &Level,
    found: &Candidate,
    before: f64,
    cancel: Option<&AtomicBool>,
) -> Result<Option<(Candidate, Attractor)>, FitError> {
    let mut orbit = Orbit::new(level);
    let iou = |drawn: &Attractor| super::score::iou(shape.bits(), &drawn.pixels);
    let found = &found.clone().ordered(shape.middle());
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
    all.sort_by_key(|it| (it.complexity, it.place()));
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
        let placed = snapped.found(shape, level, &mut orbit, cancel)?;
        let own = iou(&placed.drawn);
        if placed.wrong == 0 {
            let placed = snapped.canonical(shape, placed, cancel)?;
            return Ok(Some((placed.candidate, placed.drawn)));
        }
        if own >= before && best.as_ref().is_none_or(|best| own > best.0) {
            best = Some((own, placed.candidate, placed.drawn));
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

    /// Returns the direction of the frame in degrees, and its origin in units of four pixels: of equally simple systems, the
    /// first is upright, if one is.
    #[expect(clippy::cast_possible_truncation, reason = "pictures are small")]
    fn place(&self) -> [i64; 3] {
        let [origin, unit] = self.frame;
        let turn = libm::atan2(unit.y, unit.x).to_degrees().round() as i64;
        let [x, y] = (origin / 4.0).to_array().map(|it| it.round() as i64);
        [turn.rem_euclid(360), x, y]
    }

    /// Returns the frame in which the system is closest to the shape.
    fn settled(&self, shape: &Silhouette, level: &Level, orbit: &mut Orbit) -> [DVec2; 2] {
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

    /// Returns the system with its exact picture, moved, and turned if `turns`, until its pixels are those of the shape, or as
    /// many as can be.
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    fn polished(
        &self,
        shape: &Silhouette,
        mut frame: [DVec2; 2],
        turns: bool,
        cancel: Option<&AtomicBool>,
    ) -> Result<Placed, FitError> {
        const STEPS: [f64; 5] = [0.5, 0.25, 0.12, 0.06, 0.03];
        let draw = |frame| self.drawn(shape, frame, cancel);
        let upright = upright(frame[1]).unwrap_or(frame[1]);
        let mut best = draw(frame)?;
        let straight = draw([frame[0], upright])?;
        if straight.wrong <= best.wrong {
            (frame[1], best) = (upright, straight);
        }
        let size = frame[1].length() / shape.radius();
        let most = match 4 * best.wrong > shape.points().len() as u64 {
            true => LITTLE_WORK,
            false => WORK,
        };
        let mut work = 0;
        for step in STEPS {
            let mut moves = 0;
            while best.wrong > 0 && moves < 10 && work < most {
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
                let turned = turned.into_iter().filter(|_| turns);
                for tried in tried.chain(turned).collect::<Vec<_>>() {
                    let drawn = draw(tried)?;
                    work += drawn.drawn.parts;
                    if drawn.wrong < best.wrong {
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
        if best.wrong > 0 && best.wrong <= few as u64 && work < most {
            let mut failed = None;
            let turn = if turns { 1.0 } else { 0.0 };
            let numbers = |numbers: &[f64]| {
                let along = (
                    frame[1].normalize_or_zero(),
                    frame[1].perp().normalize_or_zero(),
                );
                let origin = frame[0] + DVec2::new(numbers[0], numbers[1]);
                let unit = frame[1] + size * (numbers[2] * along.0 + turn * numbers[3] * along.1);
                [origin, unit]
            };
            let mut search = Cma::new(vec![0.0; 4], 0.1, Pcg::new(13, 5));
            let found = search.minimise(DRAWN, 0.005, |point| match draw(numbers(point)) {
                Ok(drawn) => drawn.wrong as f64,
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
            if drawn.wrong < best.wrong {
                best = drawn;
            }
        }
        Ok(best)
    }

    /// Returns the system with its exact picture in a frame.
    fn drawn(
        &self,
        shape: &Silhouette,
        frame: [DVec2; 2],
        cancel: Option<&AtomicBool>,
    ) -> Result<Placed, FitError> {
        let candidate = self.placed(frame);
        let drawn = candidate.attractor(shape.size(), cancel)?;
        Ok(Placed {
            wrong: drawn.mismatches(shape.bits()),
            frame,
            candidate,
            drawn,
        })
    }
}

/// Returns a vector turned to the nearest multiple of 15 degrees, if it is within a degree.
fn upright(unit: DVec2) -> Option<DVec2> {
    let angle = libm::atan2(unit.y, unit.x).to_degrees();
    let nearest = (angle / 15.0).round() * 15.0;
    if (angle - nearest).abs() > 1.0 {
        return None;
    }
    let turned = nearest.to_radians();
    // Zeros and halves of upright vectors are exact.
    let exact = |value: f64| match (2.0 * value).round() / 2.0 {
        near if (near - value).abs() < 1e-9 => near,
        _ => value,
    };
    let turned = DVec2::new(exact(libm::cos(turned)), exact(libm::sin(turned)));
    Some(unit.length() * turned)
}
