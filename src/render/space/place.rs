//! Placement of a set in space on a picture, by the exact extent of its projection.

use crate::geometry::{Bounds, DAffine3, DMat3, DVec2, DVec3, Frame3, HalfSpace, Solid};
use crate::graph::Graph;
use crate::render::{Canvas, NoRoom, Size};
use crate::style::Camera;

use super::SpaceError;
use super::buffer::SAMPLES;
use super::camera::{Placement, Projection};
use super::scene::extent_along;
use super::slice::Search;

/// Number of steps of the search for the extent of a perspective picture.
const MAX_ROUNDS: usize = 60;

/// Extent of a section, relative to its distance from the origin, that is a rounding error.
const FLAT: f64 = 1e-12;

/// Places what lies in all of the half-spaces `within` of a set: the limit set, and approximant `steps` if it is
/// given.
pub(super) fn place(
    graph: &Graph<Frame3>,
    search: &Search<'_>,
    camera: &Camera,
    within: &[HalfSpace],
    size: Size,
    margin: f64,
) -> Result<Placement, SpaceError> {
    place_with(graph, search, &[], camera, within, size, margin)
}

/// Places a set as [`place`] does, together with other points.
pub(super) fn place_with(
    graph: &Graph<Frame3>,
    search: &Search<'_>,
    others: &[DVec3],
    camera: &Camera,
    within: &[HalfSpace],
    size: Size,
    margin: f64,
) -> Result<Placement, SpaceError> {
    let steps = search.steps;
    camera.check()?;
    let rotation = camera.rotation()?;
    let extent = |rows: DMat3| -> Result<Bounds<DVec3>, SpaceError> {
        let mut bounds = whole(graph, steps, rows)?;
        { others.iter() }.for_each(|point| bounds.add(rows * *point));
        if bounds.is_empty() {
            let point = camera.look_at.ok_or(NoRoom::Nothing)?;
            bounds.add(rows * point);
        }
        Ok(bounds)
    };
    let bounds = match within.first() {
        None => extent(rotation)?,
        Some(first) => match search.extent(rotation, within) {
            Some(bounds) => without_rounding(&bounds),
            None => return Err(nothing_left(graph, steps, first)),
        },
    };
    let middle = bounds.min() + bounds.size() / 2.0;
    let centre = camera.look_at.map_or(middle, |point| rotation * point);
    let Some(angle) = camera.perspective else {
        let canvas = Canvas::fit(&around(&bounds, centre, camera), size, margin)?;
        let canvas = match camera.zoom {
            Some(zoom) => canvas.magnified(zoom, centre.truncate()),
            None => canvas,
        };
        let samples = canvas.scale() * SAMPLES_A_PIXEL;
        let corner = canvas.to_pixels().translation * SAMPLES_A_PIXEL;
        let linear = DMat3::from_diagonal(DVec3::new(samples, -samples, samples)) * rotation;
        return Ok(Placement {
            map: DAffine3::from_mat3_translation(linear, corner.extend(0.0)),
            projection: Projection::Parallel,
            range: [bounds.min().z * samples, bounds.max().z * samples],
            size: canvas.size(),
        });
    };
    // The sphere about the centre that contains the box of the set is seen under the angle.
    let distance_of = |centre: DVec3| {
        let away = (bounds.min() - centre)
            .abs()
            .max((bounds.max() - centre).abs());
        let distance = away.length() / crate::expression::degrees::sin(angle / 2.0);
        if distance > 0.0 { distance } else { 1.0 }
    };
    let distance = distance_of(centre);
    let viewer = centre + DVec3::Z * distance;
    // A magnification is relative to the picture of the whole set, whatever is in the middle.
    let [seen_from, away] = match camera.zoom {
        Some(_) => [middle, DVec3::Z * distance_of(middle)],
        None => [centre, DVec3::Z * distance],
    };
    let window = match within {
        [] => window(rotation, seen_from + away, &bounds, &extent)?,
        _ => window_of_box(seen_from + away, &bounds),
    };
    let flat = Bounds::new(window.min().extend(0.0), window.max().extend(0.0));
    let canvas = Canvas::fit(&around(&flat, DVec3::ZERO, camera), size, margin)?;
    let canvas = match camera.zoom {
        Some(zoom) => canvas.magnified(zoom * distance / away.z, DVec2::ZERO),
        None => canvas,
    };
    let focus = canvas.scale() * SAMPLES_A_PIXEL;
    let axis = canvas.pixel(DVec2::ZERO) * SAMPLES_A_PIXEL;
    let flip = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
    Ok(Placement {
        map: DAffine3::from_mat3_translation(flip * rotation, flip * -viewer),
        projection: Projection::Central {
            focus,
            middle: axis.to_array(),
        },
        range: [bounds.min().z - viewer.z, bounds.max().z - viewer.z],
        size: canvas.size(),
    })
}

/// Returns the box of a set under a map: of the limit set, and of approximant `steps` if it is given.
fn whole(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    rows: DMat3,
) -> Result<Bounds<DVec3>, SpaceError> {
    let mut bounds = extent_along(graph, rows, None);
    if let Some(steps) = steps {
        let own = extent_along(graph, rows, Some(steps)).ok_or(SpaceError::NoBounds)?;
        bounds.get_or_insert(Bounds::EMPTY).add_all(&own);
    }
    bounds.ok_or(SpaceError::NoBounds)
}

/// Returns the error of a picture confined to half-spaces, of which the first is given, that hold nothing of a set.
pub(super) fn nothing_left(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    first: &HalfSpace,
) -> SpaceError {
    let normal = DMat3::from_cols(first.normal, DVec3::ZERO, DVec3::ZERO);
    match whole(graph, steps, normal.transpose()) {
        Ok(along) => SpaceError::NothingLeft([along.min().x, along.max().x]),
        Err(error) => error,
    }
}

/// Returns a box without extents that are rounding errors.
fn without_rounding(bounds: &Bounds<DVec3>) -> Bounds<DVec3> {
    let (min, max) = (bounds.min(), bounds.max());
    let largest = min.abs().max(max.abs()).max_element();
    let is_flat = (max - min).cmple(DVec3::splat(FLAT * largest));
    Bounds::new(min, DVec3::select(is_flat, min, max))
}

/// Returns the extent of a perspective picture of a box, in units at distance 1.
fn window_of_box(viewer: DVec3, bounds: &Bounds<DVec3>) -> Bounds {
    let mut window = Bounds::EMPTY;
    for corner in Solid::cuboid(bounds).corners() {
        let away = *corner - viewer;
        window.add(away.truncate() / -away.z);
    }
    window
}

#[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
const SAMPLES_A_PIXEL: f64 = SAMPLES as f64;

/// Returns the box of the picture: that of the projection, made symmetric about the centre if the camera looks
/// at a point without a magnification.
fn around(bounds: &Bounds<DVec3>, centre: DVec3, camera: &Camera) -> Bounds {
    let (min, max) = (bounds.min().truncate(), bounds.max().truncate());
    if camera.look_at.is_none() || camera.zoom.is_some() {
        return Bounds::new(min, max);
    }
    let centre = centre.truncate();
    let half = (min - centre).abs().max((max - centre).abs());
    Bounds::new(centre - half, centre + half)
}

/// Returns the extent of a perspective picture, in units at distance 1: the greatest x/w and y/w, w being the
/// distance along the direction of view, and the least.
///
/// The greatest x/w is the t at which the greatest value of x − t w is 0 (Dinkelbach 1967); that value is a
/// support function of the set, and falls with t.
fn window(
    rotation: DMat3,
    viewer: DVec3,
    bounds: &Bounds<DVec3>,
    extent: &impl Fn(DMat3) -> Result<Bounds<DVec3>, SpaceError>,
) -> Result<Bounds, SpaceError> {
    let rows = rotation.transpose();
    let nearest = viewer.z - bounds.max().z;
    let far = (bounds.min() - viewer)
        .abs()
        .max((bounds.max() - viewer).abs());
    let most = far.x.max(far.y) / nearest;
    let ends = [
        (rows.x_axis, viewer.x, 1.0),
        (rows.x_axis, viewer.x, -1.0),
        (rows.y_axis, viewer.y, 1.0),
        (rows.y_axis, viewer.y, -1.0),
    ];
    let mut found = [0.0; 4];
    for (end, (axis, at, sign)) in found.iter_mut().zip(ends) {
        // The functional sign (x − at) − t (viewer.z − z).
        let value = |t: f64| -> Result<f64, SpaceError> {
            let row = axis * sign + rows.z_axis * t;
            let seen = extent(DMat3::from_cols(row, DVec3::ZERO, DVec3::ZERO).transpose())?;
            Ok(seen.max().x - sign * at - t * viewer.z)
        };
        let (mut low, mut high) = (-most, most);
        let (mut at_low, mut at_high) = (value(low)?, value(high)?);
        for _ in 0..MAX_ROUNDS {
            if high - low <= 1e-12 * most {
                break;
            }
            // The chord of a convex function meets 0 beyond its root; every other step halves.
            let chord = low + (high - low) * at_low / (at_low - at_high);
            let middle = f64::midpoint(low, high);
            for t in [chord, middle] {
                if t > low && t < high {
                    let there = value(t)?;
                    if there > 0.0 {
                        (low, at_low) = (t, there);
                    } else {
                        (high, at_high) = (t, there);
                    }
                }
            }
        }
        *end = sign * f64::midpoint(low, high);
    }
    let [right, left, top, bottom] = found;
    Ok(Bounds::new(
        DVec2::new(left, bottom),
        DVec2::new(right, top),
    ))
}
