//! Contours: lines at equal distances inside the outline of an area.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::IntOverlayOptions;
use i_overlay::core::simplify::Simplify;
use i_overlay::i_float::int::angle::Angle;
use i_overlay::i_float::int::point::IntPoint;
use i_overlay::mesh::int::arc::ArcOptions;
use i_overlay::mesh::int::outline::offset::IntOutlineOffset;
use i_overlay::mesh::int::style::{IntLineJoin, IntOutlineStyle};

use crate::geometry::{DVec2, thinned};

use super::areas::Area;

/// Parts into which a unit of positions is divided, so that rounding does not add up.
const PARTS: i64 = 64;

/// Largest distance of a contour from its simplification, in positions.
const TOLERANCE: f64 = 0.1;

/// Largest angle of a chord of an arc, in 2⁻³² of a turn: 1/64 of a turn, whose middle is 0.1 % of the radius too near.
const ARC: u32 = 1 << 26;

type Contour = Vec<IntPoint<i64>>;

/// Calls `draw` for the contours of an area at multiples of a spacing in positions, from the outermost on. A contour ends
/// where it begins.
pub(super) fn contours(area: &Area<'_>, spacing: f64, mut draw: impl FnMut(&[DVec2])) {
    let point = |&[x, y]: &[i32; 2]| IntPoint::new(i64::from(x) * PARTS, i64::from(y) * PARTS);
    let contours = area.contours();
    let contours: Vec<Contour> = contours.map(|it| it.iter().map(point).collect()).collect();
    let mut area = contours.simplify(FillRule::NonZero, IntOverlayOptions::default());
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "positions on a picture are exact, and casts from floats saturate"
    )]
    let spacing = (spacing * PARTS as f64).round() as i64;
    let arc = ArcOptions {
        max_step: Angle::from_bits(ARC),
        ..ArcOptions::default()
    };
    let style = IntOutlineStyle::new(-spacing).line_join(IntLineJoin::Round(arc));
    // Each is the one before, made smaller by a spacing. Arcs would have more vertices every time.
    while let Ok(shapes) = area.outline(&style)
        && !shapes.is_empty()
    {
        area = shapes;
        for contour in area.iter_mut().flatten() {
            let vertices: Vec<_> = contour.iter().map(vector).collect();
            let mut kept = thinned(&vertices, TOLERANCE);
            *contour = kept.iter().map(|&at| integer(at)).collect();
            kept.extend(kept.first().copied());
            draw(&kept);
        }
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "positions on a picture are exact"
)]
fn vector(point: &IntPoint<i64>) -> DVec2 {
    DVec2::new(point.x as f64, point.y as f64) / PARTS as f64
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "positions on a picture are exact"
)]
fn integer(place: DVec2) -> IntPoint<i64> {
    let [x, y] = (place * PARTS as f64).to_array();
    IntPoint::new(x.round() as i64, y.round() as i64)
}
