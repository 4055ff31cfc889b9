//! Affine maps between two, in the plane and in space.

use crate::expression::{AffineOf, Arithmetic, Doubles};
use crate::geometry::{
    Affine as _, BaseElement, DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3, Piece,
};
use crate::ifs::{AffineMap, PointOf, Shape};

use super::{Tween, TweenBy, chain};

/// Affine map that has tweens.
pub(super) trait Tweened: AffineMap {
    /// Returns the map between two.
    fn between(tween: Tween, both: [&Self; 2]) -> Self;

    /// Returns the map whose linear part is that of this map times a factor, and by which a point has the same image.
    fn shrunk(&self, factor: f64, about: PointOf<Self>) -> Self;

    /// Returns the set between two; `None` if they are of different shapes.
    fn set(tween: Tween, both: [&Self::Set; 2]) -> Option<Self::Set>;
}

impl Tweened for DAffine2 {
    fn between(tween: Tween, [a, b]: [&Self; 2]) -> Self {
        let translation = tween.between([a.translation, b.translation]);
        let linear = match tween.by {
            TweenBy::Matrix => tween.between([a.matrix2, b.matrix2]),
            TweenBy::Polar => turned(tween, [a.matrix2, b.matrix2]),
        };
        Self::from_mat2_translation(linear, translation)
    }

    fn shrunk(&self, factor: f64, about: DVec2) -> Self {
        let linear = self.matrix2 * factor;
        Self::from_mat2_translation(linear, self.apply(about) - linear * about)
    }

    fn set(tween: Tween, both: [&Shape; 2]) -> Option<Shape> {
        match both {
            [Shape::Point(a), Shape::Point(b)] => Some(Shape::Point(tween.between([*a, *b]))),
            [Shape::Outline(a), Shape::Outline(b)] => outline(tween, [a, b]).map(Shape::Outline),
            [Shape::Union(a), Shape::Union(b)] if a.len() == b.len() => {
                let all = a.iter().zip(&**b).map(|(a, b)| outline(tween, [a, b]));
                Some(Shape::Union(all.collect::<Option<_>>()?))
            }
            _ => None,
        }
    }
}

/// Returns the linear map between two: the image of the first axis turns by the smaller angle, and the angle between the
/// images of both axes changes evenly.
fn turned(tween: Tween, [a, b]: [DMat2; 2]) -> DMat2 {
    let flat = |it: DMat2| it.x_axis == DVec2::ZERO || it.y_axis == DVec2::ZERO;
    let first = chain::turned(tween, [a.x_axis, b.x_axis]);
    if flat(a) || flat(b) {
        return DMat2::from_cols(first, chain::turned(tween, [a.y_axis, b.y_axis]));
    }
    let between = |it: DMat2| libm::atan2(it.x_axis.perp_dot(it.y_axis), it.x_axis.dot(it.y_axis));
    let angle = tween.between([between(a), between(b)]);
    let turn = DVec2::new(libm::cos(angle), libm::sin(angle));
    let length = tween.between([a.y_axis.length(), b.y_axis.length()]);
    DMat2::from_cols(first, turn.rotate(first) * (length / first.length()))
}

/// Returns the outline between two; `None` if they have different pieces.
pub(super) fn outline(tween: Tween, [a, b]: [&BaseElement; 2]) -> Option<BaseElement> {
    if a == b {
        return Some(a.clone());
    }
    if a.is_closed() != b.is_closed() || a.pieces().len() != b.pieces().len() {
        return None;
    }
    let pieces = a.pieces().iter().zip(b.pieces());
    let pieces = pieces.map(|both| match both {
        (Piece::Line(a), Piece::Line(b)) => Some(Piece::Line(tween.between([*a, *b]))),
        (Piece::Cubic(a, b, c), Piece::Cubic(d, e, f)) => {
            let [first, second, end] =
                [[a, d], [b, e], [c, f]].map(|[a, b]| tween.between([*a, *b]));
            Some(Piece::Cubic(first, second, end))
        }
        _ => None,
    });
    let pieces = pieces.collect::<Option<Vec<_>>>()?;
    BaseElement::new(tween.between([a.start(), b.start()]), pieces, a.is_closed())
}

impl Tweened for DAffine3 {
    fn between(tween: Tween, [a, b]: [&Self; 2]) -> Self {
        let translation = tween.between([a.translation, b.translation]);
        let even = || tween.between([a.matrix3, b.matrix3]);
        let linear = match tween.by {
            TweenBy::Matrix => even(),
            TweenBy::Polar => rotated(tween, [a.matrix3, b.matrix3]).unwrap_or_else(even),
        };
        Self::from_mat3_translation(linear, translation)
    }

    fn shrunk(&self, factor: f64, about: DVec3) -> Self {
        let linear = self.matrix3 * factor;
        Self::from_mat3_translation(linear, self.apply(about) - linear * about)
    }

    fn set(_: Tween, [a, b]: [&Self::Set; 2]) -> Option<Self::Set> {
        (a == b).then(|| a.clone())
    }
}

/// Returns the linear map between two, whose rotations turn about one axis and whose stretches change evenly; `None`
/// where a map is flat or only one is mirrored.
fn rotated(tween: Tween, both: [DMat3; 2]) -> Option<DMat3> {
    let [a, b] = [rotation_of(both[0])?, rotation_of(both[1])?];
    let relative = a.transpose() * b;
    if relative.determinant() < 0.0 {
        return None;
    }
    let twice_sine = DVec3::new(
        relative.y_axis.z - relative.z_axis.y,
        relative.z_axis.x - relative.x_axis.z,
        relative.x_axis.y - relative.y_axis.x,
    );
    let trace = relative.x_axis.x + relative.y_axis.y + relative.z_axis.z;
    let angle = libm::atan2(twice_sine.length(), trace - 1.0);
    let turn = match twice_sine.try_normalize() {
        None if trace > 0.0 => DMat3::IDENTITY,
        // Half a turn, about any of its axes.
        None => return None,
        Some(axis) => {
            let angle = (angle * tween.share).to_degrees();
            let turn = Doubles.turn(&angle);
            let turn = AffineOf::rotation_about(&mut Doubles, &axis.to_array(), &turn);
            DMat3::from_cols_array_2d(&turn.axes)
        }
    };
    let stretches = [a.transpose() * both[0], b.transpose() * both[1]];
    Some(a * turn * tween.between(stretches))
}

/// Returns the orthogonal factor of the polar decomposition (Higham 1986, Newton's iteration); `None` for a flat map.
fn rotation_of(linear: DMat3) -> Option<DMat3> {
    const STEPS: usize = 60;
    let mut rotation = linear;
    for _ in 0..STEPS {
        let next = (rotation + rotation.inverse().transpose()) * 0.5;
        let change = next - rotation;
        rotation = next;
        if change.to_cols_array().iter().all(|it| it.abs() < 1e-15) {
            break;
        }
    }
    rotation.is_finite().then_some(rotation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rotation;

    fn at(share: f64) -> Tween {
        Tween {
            share,
            by: TweenBy::Polar,
        }
    }

    #[test]
    fn maps_turn_evenly() {
        let turn = |degrees: f64, scale: f64| {
            let angle = degrees.to_radians();
            DMat2::from_angle(angle) * scale
        };
        let a = DAffine2::from_mat2_translation(turn(10.0, 0.5), DVec2::X);
        let b = DAffine2::from_mat2_translation(turn(-70.0, 1.0), DVec2::Y);
        let middle = DAffine2::between(at(0.25), [&a, &b]);
        let expected = turn(-10.0, 0.625);
        assert!((middle.matrix2 - expected).determinant().abs() < 1e-15);
        assert_eq!(middle.translation, DVec2::new(0.75, 0.25));
        // A mirrored map passes through a flat one.
        let mirrored = DMat2::from_diagonal(DVec2::new(1.0, -1.0));
        let flat = turned(at(0.5), [DMat2::IDENTITY, mirrored]);
        assert!(flat.determinant().abs() < 1e-15 && flat.x_axis == DVec2::X);
        let grown = turned(at(0.5), [DMat2::ZERO, turn(40.0, 0.8)]);
        assert!((grown - turn(40.0, 0.4)).determinant().abs() < 1e-15);
    }

    #[test]
    fn maps_of_space_turn_about_one_axis() {
        let axis = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let turn = |angle: f64| rotation(axis, angle.cos(), angle.sin());
        let stretch = DMat3::from_diagonal(DVec3::new(0.5, 0.25, 0.75));
        let (a, b) = (turn(0.3) * stretch, turn(1.7) * stretch);
        let middle = rotated(at(0.5), [a, b]).unwrap();
        let error = middle - turn(1.0) * stretch;
        assert!(error.to_cols_array().iter().all(|it| it.abs() < 1e-14));
        let same = rotated(at(0.4), [a, a]).unwrap() - a;
        assert!(same.to_cols_array().iter().all(|it| it.abs() < 1e-15));
        assert!(rotated(at(0.5), [a, -a]).is_none());
        assert!(rotated(at(0.5), [a, DMat3::ZERO]).is_none());
    }
}
