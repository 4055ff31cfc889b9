//! Polygons in space as convex pieces.

mod ears;

use glam::{DVec2, DVec3};

use self::ears::{ears, turn};
use super::{Bounds, Outline, Solid};

/// Largest distance of a polygon's points from a plane, relative to its size.
const FLAT: f64 = 1e-9;

/// Relative difference of areas that are equal.
const EQUAL: f64 = 1e-7;

/// Largest number of points of a polygon that is not convex.
pub const MAX_POINTS: usize = 2000;

/// Reason why points are not the corners of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonError {
    /// All points lie on a line.
    #[error("the polygon has no extent")]
    NoExtent,
    /// A point, by number from 0, lies beside the plane of the others.
    #[error("the points of this polygon do not lie in a plane")]
    NotFlat(usize),
    /// Sides cross, or there are more than [`MAX_POINTS`] points of a polygon that is not convex.
    #[error("the sides of this polygon cross")]
    Crosses,
}

/// Returns the polygon with some corners, in order, as one convex solid, or as triangles if it is not convex. Their corners
/// run around in the same direction.
///
/// # Errors
///
/// If the points do not lie in a plane, to within 1e-9 of their extent, or are not the corners of a simple polygon.
pub fn polygon(points: &[DVec3]) -> Result<Vec<Solid>, PolygonError> {
    let Some(first) = points.first().copied() else {
        return Err(PolygonError::NoExtent);
    };
    let mut bounds = Bounds::EMPTY;
    points.iter().for_each(|point| bounds.add(*point));
    let size = bounds.size().max_element();
    let near: Vec<DVec3> = points.iter().map(|it| (*it - first) / size).collect();
    // Newell's normal: the sum of those of the triangles at the first point.
    let normal: DVec3 = near.windows(2).map(|pair| pair[0].cross(pair[1])).sum();
    let area = normal.length() / 2.0;
    let hull = Solid::hull(points);
    let whole = hull.signed_area() / (size * size);
    let unit = normal
        .try_normalize()
        .filter(|_| area > 1e-12 && whole > 0.0);
    let Some(unit) = unit else {
        return Err(PolygonError::NoExtent);
    };
    let beside = |point: &DVec3| point.dot(unit).abs() > FLAT;
    if let Some(number) = near.iter().position(beside) {
        return Err(PolygonError::NotFlat(number));
    }
    // Of simple polygons, only a convex one is as large as its hull; the surface of that has two sides.
    if hull.corners().len() <= points.len() && (whole - area).abs() <= EQUAL * area {
        return Ok(vec![hull.facing(unit)]);
    }
    if points.len() > MAX_POINTS {
        return Err(PolygonError::Crosses);
    }
    let right = unit.any_orthonormal_vector();
    let up = unit.cross(right);
    let flat: Vec<DVec2> = { near.iter() }
        .map(|point| DVec2::new(point.dot(right), point.dot(up)))
        .collect();
    let ears = ears(&flat).ok_or(PolygonError::Crosses)?;
    let doubled = ears.iter().map(|ear| turn(ear.map(|corner| flat[corner])));
    if (doubled.sum::<f64>() / 2.0 - area).abs() > EQUAL * area {
        return Err(PolygonError::Crosses);
    }
    let triangle = |ear: &[usize; 3]| Solid::hull(&ear.map(|corner| points[corner])).facing(unit);
    Ok(ears.iter().map(triangle).collect())
}

/// Returns a polygon as convex pieces, also where its corners do not lie in a plane: then as triangles, by the ears of
/// its projection along Newell's normal, or as a fan around the first corner where sides of that cross. Empty if the
/// corners lie on a line.
pub(crate) fn triangulated(points: &[DVec3]) -> Vec<Solid> {
    match polygon(points) {
        Ok(pieces) => return pieces,
        Err(PolygonError::NoExtent) if points.len() < 4 => return Vec::new(),
        Err(_) => {}
    }
    let first = points[0];
    let normal: DVec3 = { points.windows(2) }
        .map(|pair| (pair[0] - first).cross(pair[1] - first))
        .sum();
    let fan = || (2..points.len()).map(|at| [0, at - 1, at]).collect();
    let triangles: Vec<[usize; 3]> = match normal.try_normalize() {
        Some(unit) if points.len() <= MAX_POINTS => {
            let right = unit.any_orthonormal_vector();
            let up = unit.cross(right);
            let size = points.iter().map(|it| (*it - first).length());
            let size = size.fold(0.0, f64::max);
            let flat = points.iter().map(|point| {
                let away = (*point - first) / size;
                DVec2::new(away.dot(right), away.dot(up))
            });
            ears(&flat.collect::<Vec<_>>()).unwrap_or_else(fan)
        }
        _ => fan(),
    };
    let solids = triangles
        .iter()
        .map(|it| Solid::hull(&it.map(|corner| points[corner])).facing(normal));
    solids.filter(|it| it.corners().len() == 3).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_slope(points: &[[f64; 2]]) -> Vec<DVec3> {
        let place = |[x, y]: &[f64; 2]| DVec3::new(3.0 + x, *y, 2.0 * x - y);
        points.iter().map(place).collect()
    }

    fn area(pieces: &[Solid]) -> f64 {
        pieces.iter().map(|piece| piece.signed_area()).sum()
    }

    #[test]
    fn polygons_become_convex_pieces() {
        let slope = 6f64.sqrt();
        let square = on_slope(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]]);
        let pieces = polygon(&square).unwrap();
        assert_eq!(pieces.len(), 1);
        assert!((area(&pieces) - 4.0 * slope).abs() < 1e-9);
        let mut arrow = on_slope(&[[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]]);
        for _ in 0..2 {
            let pieces = polygon(&arrow).unwrap();
            assert_eq!(pieces.len(), 2);
            assert!((area(&pieces) - slope).abs() < 1e-9);
            arrow.reverse();
        }
        let comb: Vec<[f64; 2]> = (0..40)
            .map(|at| [f64::from(at), if at % 2 == 0 { 9.0 } else { 1.0 }])
            .chain([[40.0, 0.0], [-1.0, 0.0]])
            .collect();
        let pieces = polygon(&on_slope(&comb)).unwrap();
        assert_eq!(pieces.len(), 40);
    }

    #[test]
    fn what_is_no_polygon_is_refused() {
        let crossing = on_slope(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 3.0]]);
        assert_eq!(polygon(&crossing), Err(PolygonError::Crosses));
        let line = on_slope(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]);
        assert_eq!(polygon(&line), Err(PolygonError::NoExtent));
        let mut bent = on_slope(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        bent[3].z += 0.1;
        assert!(matches!(polygon(&bent), Err(PolygonError::NotFlat(_))));
    }
}
