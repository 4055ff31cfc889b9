//! Movements of the unit cube: the geometrical part of transformations.
//!
//! EisenScript turns, scales and reflects about the centre of the cube from 0 to 1. Here the cube is centred at the origin,
//! so that these are linear maps; translations are unaffected.

use crate::build::NumberText;
use crate::build::written::{Entries, sequence};
use crate::document::node::Value;
use crate::geometry::{DAffine3, DMat3, DVec3};

/// A movement of the cube, in the coordinates of its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Movement {
    Translate([f64; 3]),
    /// Turn about the axis x, y or z, by degrees and the right-hand rule.
    Turn(usize, f64),
    Scale([f64; 3]),
    /// Linear map, by the rows of its matrix.
    Matrix([[f64; 3]; 3]),
}

/// Movements in the order of the program: the last one is applied to the cube first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Motion(Vec<Movement>);

/// Returns a value as many times as a name in a repetition stands for; once without a name.
pub(super) fn times(value: f64, name: Option<&str>) -> Value {
    match name {
        Some(name) if value == 1.0 => Value::Text(name.into()),
        Some(name) if value == -1.0 => Value::Text(format!("-{name}")),
        Some(name) if value != 0.0 => Value::Text(format!("{value}*{name}")),
        _ => NumberText::from(value).0,
    }
}

/// Returns the power of a factor to the exponent that a name stands for; the factor itself without a name.
fn power(factor: f64, name: Option<&str>) -> Value {
    match name {
        Some(name) if factor < 0.0 => Value::Text(format!("({factor})^{name}")),
        Some(name) if factor != 1.0 => Value::Text(format!("{factor}^{name}")),
        _ => NumberText::from(factor).0,
    }
}

impl Movement {
    /// Returns the movement that has the effect of two, of which the second one is applied first.
    fn and(self, then: Self) -> Option<Self> {
        match (self, then) {
            (Self::Translate(a), Self::Translate(b)) => {
                Some(Self::Translate([0, 1, 2].map(|at: usize| a[at] + b[at])))
            }
            (Self::Scale(a), Self::Scale(b)) => {
                Some(Self::Scale([0, 1, 2].map(|at: usize| a[at] * b[at])))
            }
            (Self::Turn(axis, a), Self::Turn(other, b)) if axis == other => {
                Some(Self::Turn(axis, a + b))
            }
            _ => None,
        }
    }

    fn is_identity(self) -> bool {
        match self {
            Self::Translate(by) => by == [0.0; 3],
            Self::Turn(_, angle) => angle == 0.0,
            Self::Scale(by) => by == [1.0; 3],
            Self::Matrix(_) => false,
        }
    }

    /// Returns the movement as a map; multiples of 90 degrees are exact.
    fn map(self) -> DAffine3 {
        match self {
            Self::Translate(by) => DAffine3::from_translation(by.into()),
            Self::Scale(by) => DAffine3::from_scale(by.into()),
            Self::Matrix(rows) => DAffine3::from_mat3(DMat3::from_cols_array_2d(&rows).transpose()),
            Self::Turn(axis, angle) => {
                let quarter = libm::remquo(angle, 90.0);
                let (sine, cosine) = libm::sincos(quarter.0.to_radians());
                let (sine, cosine) = match quarter.1.rem_euclid(4) {
                    0 => (sine, cosine),
                    1 => (cosine, -sine),
                    2 => (-sine, -cosine),
                    _ => (-cosine, sine),
                };
                let mut columns = [DVec3::X, DVec3::Y, DVec3::Z];
                let [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
                let [along, across] = [columns[next], columns[last]];
                columns[next] = along * cosine + across * sine;
                columns[last] = across * cosine - along * sine;
                let [x, y, z] = columns;
                DAffine3::from_mat3(DMat3::from_cols(x, y, z))
            }
        }
    }
}

impl Motion {
    /// Appends a movement, which is applied before those that are there.
    pub(super) fn push(&mut self, movement: Movement) {
        match self
            .0
            .last_mut()
            .and_then(|last| Some((last.and(movement)?, last)))
        {
            Some((both, last)) => *last = both,
            None => self.0.push(movement),
        }
        self.0.retain(|it| !it.is_identity());
    }

    /// Returns whether lengths keep their ratios.
    pub(super) fn is_similarity(&self) -> bool {
        self.0.iter().all(|movement| match movement {
            Movement::Scale([x, y, z]) => x.abs() == y.abs() && y.abs() == z.abs(),
            Movement::Matrix(_) => false,
            _ => true,
        })
    }

    /// Returns whether a repetition of the motion is written with a formula for each movement: its movements commute.
    pub(super) fn is_simple(&self) -> bool {
        let commute = |a: &Movement, b: &Movement| match (a, b) {
            (Movement::Translate(_), Movement::Translate(_))
            | (Movement::Scale(_), Movement::Scale(_)) => true,
            (Movement::Turn(axis, _), Movement::Turn(other, _)) => axis == other,
            (Movement::Turn(axis, _), Movement::Translate(by))
            | (Movement::Translate(by), Movement::Turn(axis, _)) => {
                (0..3).all(|at| at == *axis || by[at] == 0.0)
            }
            (Movement::Turn(axis, _), Movement::Scale(by))
            | (Movement::Scale(by), Movement::Turn(axis, _)) => {
                by[(axis + 1) % 3] == by[(axis + 2) % 3]
            }
            _ => false,
        };
        let mut pairs = self.0.iter().enumerate();
        pairs.all(|(at, movement)| {
            !matches!(movement, Movement::Matrix(_))
                && self.0[at + 1..]
                    .iter()
                    .all(|other| commute(movement, other))
        })
    }

    /// Returns the transforms of an instance under the motion, in the order of their application; with the name of a value,
    /// they are repeated as many times, if the motion is simple.
    pub(super) fn transforms(&self, name: Option<&str>) -> Vec<(&'static str, Value)> {
        let mut all: Vec<(&str, Value)> = Vec::new();
        let mut turns: Vec<Value> = Vec::new();
        let flush = |turns: &mut Vec<Value>, all: &mut Vec<(&str, Value)>| {
            match turns.len() {
                0 => {}
                1 => all.extend(turns.pop().map(|turn| ("rotate", turn))),
                _ => all.push(("rotate", sequence(std::mem::take(turns)))),
            };
        };
        let number = |value: f64| NumberText::from(value).0;
        for movement in self.0.iter().rev() {
            if let Movement::Turn(axis, angle) = movement {
                let axis = ["x", "y", "z"][*axis];
                turns.push(Entries::default().set(axis, times(*angle, name)).value());
                continue;
            }
            flush(&mut turns, &mut all);
            all.push(match movement {
                Movement::Translate(by) => ("translate", sequence(by.map(|it| times(it, name)))),
                Movement::Scale([x, y, z]) if x == y && y == z => ("scale", power(*x, name)),
                Movement::Scale(by) => ("scale", sequence(by.map(|it| power(it, name)))),
                Movement::Matrix(rows) => {
                    let rows = rows.map(|row| sequence(row.map(number)));
                    ("matrix", sequence(rows))
                }
                Movement::Turn(..) => continue,
            });
        }
        flush(&mut turns, &mut all);
        all
    }

    /// Returns the motion as a map.
    pub(super) fn map(&self) -> DAffine3 {
        { self.0.iter() }.fold(DAffine3::IDENTITY, |all, it| all * it.map())
    }

    /// Returns the motion that has the effect of a number of repetitions: that of the single movements if it is simple, or
    /// else a matrix and a translation.
    pub(super) fn power(&self, times: u32) -> Self {
        if times == 1 || self.is_simple() {
            let times = f64::from(times);
            let power = |it: &Movement| match *it {
                Movement::Translate(by) => Movement::Translate(by.map(|it| it * times)),
                Movement::Turn(axis, angle) => Movement::Turn(axis, angle * times),
                Movement::Scale(by) => Movement::Scale(by.map(|it| libm::pow(it, times))),
                matrix @ Movement::Matrix(_) => matrix,
            };
            return Self(self.0.iter().map(power).collect());
        }
        let mut base = self.map();
        let (mut all, mut rest) = (DAffine3::IDENTITY, times);
        while rest > 0 {
            if rest % 2 == 1 {
                all *= base;
            }
            base *= base;
            rest /= 2;
        }
        let rows = all.matrix3.transpose().to_cols_array_2d();
        let shift = all.translation.to_array();
        Self(vec![Movement::Translate(shift), Movement::Matrix(rows)])
    }
}

/// Returns the motion of a reflection in the plane across a vector through the corner of the cube; `None` if the vector
/// is 0.
pub(super) fn reflection(across: [f64; 3]) -> Option<[Movement; 2]> {
    let normal = DVec3::from(across).try_normalize()?;
    let row = |at: usize| {
        let unit = [DVec3::X, DVec3::Y, DVec3::Z][at];
        (unit - 2.0 * normal * normal[at]).to_array()
    };
    let rows = [0, 1, 2].map(row);
    // The centre of the cube is the origin, and its corner lies on the plane.
    let shift = rows.map(|row| row.iter().sum::<f64>() / 2.0 - 0.5);
    Some([Movement::Translate(shift), Movement::Matrix(rows)])
}
