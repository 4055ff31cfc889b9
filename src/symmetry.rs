//! Symmetry groups under which a picture is repeated: the cyclic groups C_n and the dihedral groups D_n about a centre, and,
//! as [tilings](Tiling), the wallpaper and frieze groups.
//!
//! The picture of a model with a symmetry is the union of the images of its set under the isometries of the group
//! (Field & Golubitsky, *Symmetry in Chaos*, 2nd edition 2009). The set itself, its similarity
//! dimension and its numbers of steps are those of the model without it. Every image starts a fractal of its own, in
//! which indices count from 1 and the draws are those of the first. Images may coincide.

mod groups;
mod tiling;

pub use groups::TilingGroup;
pub use tiling::{Tiling, TooManyCopies};

use std::fmt;

use crate::expression::{AffineOf, Arithmetic, Precise, Precision, Program, degrees};
use crate::geometry::{DAffine2, DMat2, DVec2, Homothety};

/// Largest order of the rotations of a group.
pub(crate) const MOST_TURNS: u32 = 360;

/// Cyclic or dihedral group of isometries of the plane that keep a centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetry {
    pub(crate) rotate: u32,
    pub(crate) mirror: bool,
    pub(crate) centre: DVec2,
    pub(crate) axis: f64,
    /// The coordinates of the centre and the angle of the axis as written.
    pub(crate) written: [Program; 3],
}

impl Symmetry {
    /// Creates the group of the rotations by multiples of 360/`rotate` degrees about a centre, and with `axis` of as many
    /// reflections: in the line through the centre at that angle to the x axis, in degrees counter-clockwise, and in those
    /// at multiples of 180/`rotate` degrees to it. The order of the rotations is limited to 1 to 360.
    #[must_use]
    pub fn new(rotate: u32, axis: Option<f64>, centre: DVec2) -> Self {
        let angle = axis.unwrap_or(90.0);
        Self {
            rotate: rotate.clamp(1, MOST_TURNS),
            mirror: axis.is_some(),
            centre,
            axis: angle,
            written: [centre.x, centre.y, angle].map(Program::constant),
        }
    }

    /// Returns the number of isometries.
    #[must_use]
    pub fn order(&self) -> u32 {
        self.rotate * if self.mirror { 2 } else { 1 }
    }

    /// Returns the centre, which all isometries keep.
    #[must_use]
    pub fn centre(&self) -> DVec2 {
        self.centre
    }

    /// Returns the isometries: the rotations, of which the first is the identity, then the reflections.
    ///
    /// Entries of linear parts are exact where they are representable, as those of multiples of 90 degrees are.
    #[must_use]
    pub fn isometries(&self) -> Vec<DAffine2> {
        let isometry = |(is_mirrored, turn): (bool, u32)| {
            if !is_mirrored && turn == 0 {
                return DAffine2::IDENTITY;
            }
            let turn = 360.0 * f64::from(turn) / f64::from(self.rotate);
            let linear = match is_mirrored {
                false => linear(turn, 1.0),
                true => linear(2.0 * self.axis + turn, -1.0),
            };
            DAffine2::from_mat2_translation(linear, self.centre - linear * self.centre)
        };
        self.elements().map(isometry).collect()
    }

    /// Returns an isometry by its number in [`isometries`](Self::isometries), in numbers of a precision.
    pub(crate) fn precise(&self, of: &mut Precision, number: u32) -> Option<AffineOf<Precise>> {
        let (is_mirrored, turn) = self.elements().nth(number as usize)?;
        let [x, y, axis] = { self.written.each_ref() }.map(|number| number.evaluate(of, &[]));
        let full = of.decimal(360.0 * f64::from(turn));
        let rotate = of.decimal(self.rotate.into());
        let turn = of.divide(&full, &rotate);
        let linear = if is_mirrored {
            let twice = of.add(&axis, &axis);
            let angle = of.add(&twice, &turn);
            let [cosine, sine] = of.turn(&angle);
            let back = of.negate(&cosine);
            AffineOf::linear(of, [[cosine, sine.clone()], [sine, back]])
        } else {
            let turned = of.turn(&turn);
            AffineOf::rotation(of, turned)
        };
        Some(linear.about(of, &[x, y]))
    }

    /// Iterates over the elements of the group: whether it is a reflection, and the number of its turns.
    fn elements(&self) -> impl Iterator<Item = (bool, u32)> + use<> {
        let (rotate, mirror) = (self.rotate, self.mirror);
        [false, true]
            .into_iter()
            .filter(move |is_mirrored| mirror || !is_mirrored)
            .flat_map(move |is_mirrored| (0..rotate).map(move |turn| (is_mirrored, turn)))
    }

    /// Returns the group whose long numbers are those of its doubles.
    pub(crate) fn in_doubles(&self) -> Self {
        let axis = self.mirror.then_some(self.axis);
        Self::new(self.rotate, axis, self.centre)
    }

    /// Returns the group in the coordinates that a homothety maps to the present ones.
    pub(crate) fn within(&self, place: &Homothety) -> Self {
        Self {
            centre: place.origin_of(self.centre),
            ..self.clone()
        }
    }
}

/// Returns the linear map whose image of (1, 0) is the unit vector at an angle in degrees, with a determinant of 1 or -1.
fn linear(angle: f64, determinant: f64) -> DMat2 {
    let along = DVec2::new(degrees::cos(angle), degrees::sin(angle));
    DMat2::from_cols(along, along.perp() * determinant)
}

/// Writes the name of the group, such as `C6` or `D6`, in Schoenflies notation.
impl fmt::Display for Symmetry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", if self.mirror { 'D' } else { 'C' }, self.rotate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups() -> impl Iterator<Item = Symmetry> {
        let centre = DVec2::new(0.5, -2.0);
        (1..=12).flat_map(move |rotate| {
            [None, Some(90.0), Some(17.0)].map(|axis| Symmetry::new(rotate, axis, centre))
        })
    }

    fn is_near(a: &DAffine2, b: &DAffine2) -> bool {
        a.abs_diff_eq(*b, 1e-12)
    }

    /// The isometries are a group: distinct, and closed under composition.
    #[test]
    fn isometries_are_a_group() {
        for group in groups() {
            let all = group.isometries();
            assert_eq!(all.len(), group.order() as usize, "{group}");
            assert_eq!(all[0], DAffine2::IDENTITY);
            for (number, a) in all.iter().enumerate() {
                assert!(
                    a.transform_point2(group.centre())
                        .abs_diff_eq(group.centre(), 1e-12)
                );
                assert!((a.matrix2.determinant().abs() - 1.0).abs() < 1e-15);
                assert!(all[..number].iter().all(|b| !is_near(a, b)), "{group}");
                for b in &all {
                    let both = *a * *b;
                    assert!(all.iter().any(|known| is_near(known, &both)), "{group}");
                }
            }
        }
    }

    #[test]
    fn quarter_turns_and_upright_mirrors_are_exact() {
        for (rotate, mirror) in [(1, true), (2, true), (4, true), (2, false), (4, false)] {
            let group = Symmetry::new(rotate, mirror.then_some(90.0), DVec2::ZERO);
            for map in group.isometries() {
                let is_exact = |entry: f64| [0.0, 1.0, -1.0].contains(&entry);
                assert!(
                    map.to_cols_array().into_iter().all(is_exact),
                    "{group}: {map}"
                );
            }
        }
        let upright = Symmetry::new(1, Some(90.0), DVec2::ZERO).isometries();
        assert_eq!(
            upright[1].transform_point2(DVec2::new(3.0, 5.0)),
            DVec2::new(-3.0, 5.0)
        );
    }

    #[test]
    fn long_numbers_agree_with_doubles() {
        for group in groups() {
            let mut of = Precision::new(200);
            for (number, map) in (0..).zip(group.isometries()) {
                let precise = group.precise(&mut of, number).unwrap();
                let near = precise.map(|number| number.near());
                let [[a, b], [c, d]] = near.axes;
                let [e, f] = near.origin;
                let near = DAffine2::from_cols_array(&[a, b, c, d, e, f]);
                assert!(is_near(&near, &map), "{group}: {near} is not {map}");
            }
            assert!(group.precise(&mut of, group.order()).is_none());
        }
    }
}
