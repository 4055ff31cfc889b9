//! Points of a plot, identified up to rounding.

use crate::fast_hash::FastMap;
use crate::geometry::DVec2;
use crate::render::paint::Position;

/// Distance up to which positions are one point: 0.02 units of the picture, the effect of rounding on a place
/// that is computed in several ways.
pub(super) const MEET: i32 = 2;

/// Number of a point of a plot.
pub(super) type Point = u32;

/// Points of a plot.
#[derive(Default)]
pub(super) struct Points {
    places: Vec<[i32; 2]>,
    /// Points by squares of side [`MEET`], each of which holds at most one.
    squares: FastMap<u64, Point>,
}

impl Points {
    /// Returns the point at a position, which is added if it is new; `None` if the position or the number of
    /// points is out of range.
    pub(super) fn at(&mut self, position: Position) -> Option<Point> {
        let place = [
            i32::try_from(position[0]).ok()?,
            i32::try_from(position[1]).ok()?,
        ];
        let square = place.map(|value| value.div_euclid(MEET));
        if let Some(&known) = self.squares.get(&key(square)) {
            return Some(known);
        }
        let near = |by: [i32; 2]| {
            let other = [square[0] + by[0], square[1] + by[1]];
            let known = *self.squares.get(&key(other))?;
            let [x, y] = self.places[known as usize];
            let [x, y] = [i64::from(x - place[0]), i64::from(y - place[1])];
            (x * x + y * y <= i64::from(MEET * MEET)).then_some(known)
        };
        const AROUND: [[i32; 2]; 8] = [
            [-1, 0],
            [1, 0],
            [0, -1],
            [0, 1],
            [-1, -1],
            [1, -1],
            [-1, 1],
            [1, 1],
        ];
        if let Some(known) = AROUND.into_iter().find_map(near) {
            return Some(known);
        }
        let new = Point::try_from(self.places.len()).ok()?;
        self.places.push(place);
        self.squares.insert(key(square), new);
        Some(new)
    }

    /// Returns the place of a point.
    pub(super) fn place(&self, point: Point) -> [i32; 2] {
        self.places[point as usize]
    }

    /// Returns the places of all points.
    pub(super) fn places(self) -> Vec<[i32; 2]> {
        self.places
    }
}

/// Converts a place to a vector.
pub(super) fn vector([x, y]: [i32; 2]) -> DVec2 {
    DVec2::new(x.into(), y.into())
}

fn key([x, y]: [i32; 2]) -> u64 {
    u64::from(x.cast_unsigned()) << 32 | u64::from(y.cast_unsigned())
}

#[cfg(test)]
mod tests {
    use super::Points;

    #[test]
    fn what_rounding_moves_stays_one_point() {
        let mut points = Points::default();
        let first = points.at([100, -7]).unwrap();
        for near in [[101, -7], [99, -8], [102, -7], [100, -9], [98, -7]] {
            assert_eq!(points.at(near), Some(first), "{near:?}");
        }
        for far in [[104, -7], [96, -7], [100, -3]] {
            assert_ne!(points.at(far), Some(first), "{far:?}");
        }
        assert_eq!(points.at([i64::MAX, 0]), None);
    }
}
