//! Growth of displacements in space, in doubles.
//!
//! Displacements at multiples of the period of the turns follow from each other by one linear map. Arnoldi's method (1951)
//! finds the least space that contains them and is mapped to itself: in it, displacements are followed until they recur in
//! direction. Outside of it, rounding errors would grow at rates that take no part.

use crate::geometry::{DMat3, DVec3, Frame3};
use crate::lsystem::{Compass, Heading3, NoGrowth, TurtleFrame as _};

use super::super::growth::Steps;
use super::super::pieces::ROUNDING;
use super::super::turns::{Reader, Reading, STEP, Turned, Variable};

/// Number of periods after which displacements have to recur.
const LATE: usize = 1 << 12;

/// Limit of the number of steps of the period.
const MAX_PERIOD: usize = 720;

/// Limit of the dimension of the space of displacements.
const MAX_DIMENSION: usize = 48;

/// Length below which a part of a displacement is a rounding error.
const INSIDE: f64 = 1e-10;

/// Difference of displacements that recur, relative to their length.
const RECURS: f64 = 1e-11;

/// Number of operations in doubles that take as long as one with long numbers.
const DOUBLES: usize = 16;

/// Growth by a step below which displacements that do not recur grow by no factor.
const SLOW: f64 = 1.01;

/// Growth of the displacements of variables.
pub(super) struct Growth {
    /// Number of steps of the period.
    pub(super) period: usize,
    /// Factor of one step.
    pub(super) ratio: f64,
    /// Whether the factor is 1.
    pub(super) is_one: bool,
    /// Displacements that are approached at the steps of the period, each divided by the power of the ratio; `None` for
    /// variables that decide no place.
    pub(super) ways: Vec<Vec<Option<DVec3>>>,
    /// Turns of the displacements from the first step of the period to its steps, and from one period to the next.
    pub(super) turns: Vec<DMat3>,
    pub(super) turn: DMat3,
}

/// Displacements of all variables at a step.
type Places = Vec<DVec3>;

fn length(places: &[DVec3]) -> f64 {
    dot(places, places).sqrt()
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

/// Adds a multiple of displacements to others.
fn add(to: &mut [DVec3], factor: f64, places: &[DVec3]) {
    to.iter_mut()
        .zip(places)
        .for_each(|(to, place)| *to += *place * factor);
}

#[expect(clippy::cast_precision_loss, reason = "periods are short")]
impl Growth {
    pub(super) fn of(steps: &Steps<Frame3>, reader: &Reader<'_, Frame3>) -> Result<Self, NoGrowth> {
        let course = Course {
            steps,
            reader,
            relevant: steps.relevant(reader)?,
        };
        let (space, map) = course.krylov()?;
        // Coordinates in the space after each period, of length 1, and the factors by which they have grown.
        let (mut all, mut grown) = (vec![unit(0, space.len())], Vec::new());
        for number in 0..LATE {
            let mut next = vec![0.0; space.len()];
            for (column, coordinate) in map.iter().zip(&all[number]) {
                let numbers = next.iter_mut().zip(column);
                numbers.for_each(|(next, by)| *next += coordinate * by);
            }
            let length = next.iter().map(|it| it * it).sum::<f64>().sqrt();
            if !(length > 0.0 && length.is_finite()) {
                return Err(NoGrowth::Points);
            }
            next.iter_mut().for_each(|it| *it /= length);
            all.push(next);
            grown.push(length);
        }
        let late = |times: usize| combined(&all[LATE - times], &space);
        let last = late(0);
        let recurs = |times: usize| -> Result<Option<(usize, DMat3)>, NoGrowth> {
            let before = late(times);
            let Some(turn) = rotation(&before, &last) else {
                return Ok(None);
            };
            let mut both = before.iter().zip(&last);
            let turns = both.all(|(a, b)| (turn * *a).distance(*b) <= RECURS);
            Ok((turns && course.commutes(&turn)?).then_some((times, turn)))
        };
        let most = (MAX_PERIOD / steps.period).max(1);
        let recurring = (1..=most).find_map(|times| recurs(times).transpose());
        let Some((times, turn)) = recurring.transpose()? else {
            let slow = libm::pow(SLOW, steps.period as f64);
            let is_slow = grown[LATE - 1] <= slow;
            return Err(match is_slow {
                true => NoGrowth::Slow,
                false => NoGrowth::Directions,
            });
        };
        let period = times * steps.period;
        let roots = grown[LATE - times..].iter();
        let roots = roots.map(|it| libm::pow(*it, 1.0 / period as f64));
        let ratio = simple(roots.product());
        let is_one = ratio == 1.0;
        if ratio < 1.0 {
            return Err(NoGrowth::Slow);
        }
        // Displacements, divided by the power of the ratio.
        let (mut ways, mut size) = (Vec::<Places>::new(), 1.0);
        for number in LATE - times..LATE {
            let mut places = combined(&all[number], &space);
            places.iter_mut().for_each(|place| *place *= size);
            for inner in 1..=steps.period {
                let mut next = course.next(steps.first + inner, &places)?;
                next.iter_mut().for_each(|place| *place /= ratio);
                ways.push(std::mem::replace(&mut places, next));
            }
            size *= grown[number] / libm::pow(ratio, steps.period as f64);
        }
        let longest = ways
            .iter()
            .flatten()
            .map(|way| way.length())
            .fold(0.0, f64::max);
        // Lines keep their length if they do not become points beside displacements that grow.
        let unit = if is_one {
            ways[0][STEP].length()
        } else {
            longest
        };
        if unit <= 0.0 {
            return Err(NoGrowth::Slow);
        }
        let relevant = &course.relevant;
        let ways = ways.into_iter().map(|ways| {
            let grown = |(variable, way): (Variable, DVec3)| match variable {
                _ if !relevant.contains(&variable) => None,
                STEP if !is_one => Some(DVec3::ZERO),
                _ => Some(way / unit),
            };
            ways.into_iter().enumerate().map(grown).collect()
        });
        let ways: Vec<Vec<Option<DVec3>>> = ways.collect();
        Ok(Self {
            period,
            ratio,
            is_one,
            turns: turns(&ways, &turn),
            turn,
            ways,
        })
    }
}

/// Returns the root of a whole number that differs by rounding errors only, or the number itself.
fn simple(number: f64) -> f64 {
    let root = (1..=4u32).map(f64::from).find_map(|degree| {
        let whole = libm::pow(number, degree).round();
        let root = libm::pow(whole, 1.0 / degree);
        ((root - number).abs() <= RECURS).then_some(root)
    });
    root.unwrap_or(number)
}

/// Returns displacements from their coordinates.
fn combined(coordinates: &[f64], space: &[Places]) -> Places {
    let mut places = vec![DVec3::ZERO; space[0].len()];
    for (coordinate, axis) in coordinates.iter().zip(space) {
        add(&mut places, *coordinate, axis);
    }
    places
}

/// Returns the coordinates of an axis.
fn unit(number: usize, count: usize) -> Vec<f64> {
    (0..count)
        .map(|it| f64::from(u8::from(it == number)))
        .collect()
}

/// Displacements, step by step.
struct Course<'s> {
    steps: &'s Steps<Frame3>,
    reader: &'s Reader<'s, Frame3>,
    relevant: Vec<Variable>,
}

impl Course<'_> {
    /// Returns the displacements at a step from those of the step before. Lines do not change.
    fn next(&self, step: usize, before: &[DVec3]) -> Result<Places, NoGrowth> {
        self.spend(self.steps.terms(step, &self.relevant))?;
        let mut next = vec![DVec3::ZERO; before.len()];
        for &variable in &self.relevant {
            next[variable] = if variable == STEP {
                before[STEP]
            } else {
                let reading = self.steps.reading(step, variable);
                let terms = reading.terms(reading.end);
                terms
                    .map(|term| turned(self.reader.compass, term, before[term.of]))
                    .sum()
            };
        }
        Ok(next)
    }

    /// Takes operations in doubles, which are shorter than those with long numbers.
    fn spend(&self, operations: usize) -> Result<(), NoGrowth> {
        self.reader.budget.spend(operations.div_ceil(DOUBLES))
    }

    /// Returns whether the turns and reflections of all words of the period commute with a rotation.
    fn commutes(&self, turn: &DMat3) -> Result<bool, NoGrowth> {
        if turn.abs_diff_eq(DMat3::IDENTITY, ROUNDING) {
            return Ok(true);
        }
        let Steps { first, period, .. } = *self.steps;
        let commutes = |it: &Turned<Heading3>| {
            let linear = linear(self.reader.compass, it);
            (linear * *turn).abs_diff_eq(*turn * linear, ROUNDING)
        };
        let all = |reading: &Reading<Heading3>| {
            let mut turned = reading.sums.iter().chain(&reading.parts);
            turned.all(commutes)
        };
        for step in first + 1..=first + period {
            let axiom =
                { self.reader }.read(&self.reader.kinds.axiom, Some(self.steps.effects(step)))?;
            if !all(&axiom) {
                return Ok(false);
            }
            for variable in 1..=self.reader.fertile.len() {
                let reading = self.steps.reading(step, variable);
                self.spend(reading.sums.len() + reading.parts.len())?;
                if !all(reading) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// Returns orthonormal displacements, of which the first is that of the first step of the period but for its length, and
    /// the columns of the map of one period in their coordinates.
    fn krylov(&self) -> Result<(Vec<Places>, Vec<Vec<f64>>), NoGrowth> {
        let mut first = vec![DVec3::ZERO; self.reader.fertile.len() + 1];
        first[STEP] = DVec3::X;
        for step in 0..=self.steps.first {
            let lines = first[STEP];
            first = self.next(step, &first)?;
            // Modules that are not replaced consist of lines.
            first[STEP] = lines;
        }
        if !self.relevant.contains(&STEP) {
            first[STEP] = DVec3::ZERO;
        }
        let size = length(&first);
        if !(size > 0.0 && size.is_finite()) {
            return Err(NoGrowth::Points);
        }
        first.iter_mut().for_each(|place| *place /= size);
        let (mut space, mut map) = (vec![first], Vec::new());
        while map.len() < space.len() {
            let mut image = space[map.len()].clone();
            for step in 1..=self.steps.period {
                image = self.next(self.steps.first + step, &image)?;
            }
            let size = length(&image);
            let mut column = vec![0.0; space.len()];
            // Once more, for what rounding leaves.
            for _ in 0..2 {
                for (coordinate, axis) in column.iter_mut().zip(&space) {
                    let along = dot(axis, &image);
                    add(&mut image, -along, axis);
                    *coordinate += along;
                }
            }
            let outside = length(&image);
            if !size.is_finite() || space.len() > MAX_DIMENSION {
                return Err(NoGrowth::Size);
            }
            if outside > INSIDE * size {
                image.iter_mut().for_each(|place| *place /= outside);
                column.push(outside);
                space.push(image);
            }
            map.push(column);
        }
        Ok((space, map))
    }
}

/// Returns a displacement as a term of a sum.
pub(super) fn turned(compass: Compass, term: &Turned<Heading3>, way: DVec3) -> DVec3 {
    Frame3::outward(compass, term.turn.heading, term.turn.mirrored, way) * term.turn.scale
}

/// Returns the linear map of a part, with its turn, its reflection and its scale.
pub(super) fn linear(compass: Compass, part: &Turned<Heading3>) -> DMat3 {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turned(compass, part, axis));
    DMat3::from_cols(x, y, z)
}

/// Returns the rotation that takes all displacements at the first step to those at each step, if its powers do and the last
/// is the rotation of the period, and no turns otherwise.
fn turns(ways: &[Vec<Option<DVec3>>], last: &DMat3) -> Vec<DMat3> {
    let none = || vec![DMat3::IDENTITY; ways.len()];
    let known = ways
        .iter()
        .map(|ways| ways.iter().copied().flatten().collect());
    let ways: Vec<Vec<DVec3>> = known.collect();
    let [first, second, ..] = &ways[..] else {
        return none();
    };
    let Some(turn) = rotation(first, second) else {
        return none();
    };
    let mut powers = vec![DMat3::IDENTITY];
    for _ in &ways {
        powers.push(turn * powers[powers.len() - 1]);
    }
    let leads = |(power, later): (&DMat3, &Vec<DVec3>)| {
        let mut both = first.iter().zip(later);
        both.all(|(from, to)| to.distance(*power * *from) <= ROUNDING)
    };
    let is_last = |power: &DMat3| power.abs_diff_eq(*last, ROUNDING);
    let ends = powers.pop().as_ref().is_some_and(is_last);
    match powers.iter().zip(&ways).all(leads) && ends {
        true => powers,
        false => none(),
    }
}

/// Returns the rotation that takes vectors to others, the least one if there are several; `None` if there is none.
pub(super) fn rotation(from: &[DVec3], to: &[DVec3]) -> Option<DMat3> {
    let pairs = || from.iter().zip(to);
    let (a, b) = pairs().max_by(|one, other| one.0.length().total_cmp(&other.0.length()))?;
    let across = |(c, d): (&DVec3, &DVec3)| (a.cross(*c), b.cross(*d));
    let (mut c, mut d) =
        { pairs().map(across) }.max_by(|one, other| one.0.length().total_cmp(&other.0.length()))?;
    if c.length() <= ROUNDING * a.length_squared() {
        // All vectors lie on one line.
        let axis = a.cross(*b);
        c = match axis.length() <= ROUNDING * a.length_squared() {
            true => a.any_orthogonal_vector(),
            false => axis,
        };
        d = c;
    }
    let base = |along: DVec3, across: DVec3| -> Option<DMat3> {
        let (x, z) = (along.try_normalize()?, across.try_normalize()?);
        Some(DMat3::from_cols(x, z.cross(x), z))
    };
    let turn = base(*b, d)? * base(*a, c)?.transpose();
    Some(turn)
}
