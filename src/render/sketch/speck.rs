//! Specks: closed outlines narrower than a pixel, in formats whose viewers let small areas fade. They are
//! stroked, so that area and stroke together are a pixel wide.

use crate::geometry::{DAffine2, DVec2};
use crate::render::paint_key::SPECK_WIDTHS;
use crate::rule::{BaseElement, Piece};

/// Maximum number of points of an outline that is examined.
const MAX_POINTS: usize = 32;

/// Number of points up to which directions between any two are examined; beyond it, only those of sides are.
const FEW_POINTS: usize = 8;

/// Returns the width of the stroke that makes an outline a pixel wide, in [`SPECK_WIDTHS`]; `None` if it is
/// as wide already or has too many points. `map` leads to the picture, in pixels.
pub(super) fn width(base_element: &BaseElement, map: &DAffine2) -> Option<i32> {
    let mut points = [DVec2::ZERO; MAX_POINTS];
    let mut count = 0;
    let mut add = |point: DVec2| {
        let next = points.get_mut(count)?;
        *next = map.transform_point2(point);
        count += 1;
        Some(())
    };
    add(base_element.start())?;
    for piece in base_element.pieces() {
        if let Piece::Cubic(a, b, _) = *piece {
            add(a)?;
            add(b)?;
        }
        add(piece.end())?;
    }
    let missing = 1.0 - narrowest(&points[..count]);
    // The tolerance absorbs rounding errors of rotated outlines.
    let parts = (missing * SPECK_WIDTHS - 1e-6).ceil();
    #[expect(clippy::cast_possible_truncation, reason = "no more than eight")]
    (parts > 0.0).then_some(parts as i32)
}

/// Returns the least distance between two parallel lines that enclose points; for many points, between
/// parallels to the sides.
fn narrowest(points: &[DVec2]) -> f64 {
    let mut narrowest = f64::INFINITY;
    for (number, &from) in points.iter().enumerate() {
        let others = &points[number + 1..];
        let looked_at = if points.len() > FEW_POINTS {
            1
        } else {
            FEW_POINTS
        };
        for &to in others.iter().take(looked_at) {
            let Some(along) = (to - from).try_normalize() else {
                continue;
            };
            let sides = points.iter().map(|point| along.perp_dot(*point - from));
            let [least, most] = sides.fold([0.0_f64; 2], |[least, most], side| {
                [least.min(side), most.max(side)]
            });
            narrowest = narrowest.min(most - least);
        }
    }
    if narrowest.is_finite() {
        narrowest
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::width;
    use crate::geometry::{DAffine2, DMat2, DVec2};
    use crate::rule::{BaseElement, Piece};

    #[test]
    fn strokes_make_up_for_what_is_missing_to_a_pixel() {
        let corners = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]].map(DVec2::from);
        let square = BaseElement::new(DVec2::ZERO, corners.map(Piece::Line).into(), true).unwrap();
        let of = |width: f64, height: f64| {
            let scale = DMat2::from_diagonal(DVec2::new(width, height));
            let turned = DMat2::from_angle(0.4) * scale;
            self::width(&square, &DAffine2::from_mat2(turned))
        };
        assert_eq!(of(1.01, 30.0), None);
        assert_eq!(of(0.9, 30.0), Some(1));
        assert_eq!(of(0.4, 0.9), Some(5));
        assert_eq!(of(30.0, 1e-9), Some(8));
        assert_eq!(of(1e-12, 1e-9), Some(8));
        assert_eq!(of(0.0, 0.0), Some(8));
    }
}
