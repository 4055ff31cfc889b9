//! Nearest-neighbour search among points, by a k-d tree (Bentley 1975).

use crate::geometry::{Bounds, Point};

/// A k-d tree of points. The tree is the order of the points: the median of a range splits it.
pub(super) struct KdTree<P> {
    points: Vec<P>,
    /// Number of the coordinate by which the point at this index splits its range.
    axes: Vec<u8>,
}

/// Ranges that remain to be searched, with the square of a lower bound of the distance of their points. The
/// memory is reused by successive searches.
pub(super) type Open = Vec<(usize, usize, f64)>;

/// Ranges of at most this many points are searched one by one.
const FEW: usize = 8;

impl<P: Point> KdTree<P> {
    pub(super) fn new(mut points: Vec<P>) -> Self {
        let mut axes = vec![0; points.len()];
        let mut open = vec![(0, points.len())];
        while let Some((start, end)) = open.pop() {
            if end - start <= FEW {
                continue;
            }
            let mut bounds = Bounds::EMPTY;
            let part = &mut points[start..end];
            part.iter().for_each(|&point| bounds.add(point));
            let size = bounds.size().coordinates();
            let longer = |axis: u8, other: u8| {
                if size[usize::from(other)] > size[usize::from(axis)] {
                    other
                } else {
                    axis
                }
            };
            let axis = longer(longer(0, 1), 2);
            let key = |point: &P| point.coordinates()[usize::from(axis)];
            let middle = part.len() / 2;
            part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
            let middle = start + middle;
            axes[middle] = axis;
            open.push((start, middle));
            open.push((middle + 1, end));
        }
        Self { points, axes }
    }

    /// Returns the points, in an order in which neighbours are mostly near each other.
    pub(super) fn points(&self) -> &[P] {
        &self.points
    }

    /// Returns the index of the nearest point and the square of its distance, or those of any point whose
    /// squared distance is at most `enough`. `guess` is the index of a point that may be near.
    pub(super) fn find(
        &self,
        point: P,
        enough: f64,
        guess: usize,
        open: &mut Open,
    ) -> (usize, f64) {
        let mut best = (guess, square(self.points[guess] - point));
        open.clear();
        open.push((0, self.points.len(), 0.0));
        while let Some((start, end, away)) = open.pop() {
            if best.1 <= enough {
                break;
            }
            if away >= best.1 {
                continue;
            }
            let mut look = |place: usize| {
                let square = square(self.points[place] - point);
                if square < best.1 {
                    best = (place, square);
                }
            };
            if end - start <= FEW {
                (start..end).for_each(look);
                continue;
            }
            let middle = start + (end - start) / 2;
            look(middle);
            let beyond = (point - self.points[middle]).coordinates();
            let beyond = beyond[usize::from(self.axes[middle])];
            let far = away.max(beyond * beyond);
            let (low, high) = ((start, middle), (middle + 1, end));
            let (near, other) = if beyond < 0.0 {
                (low, high)
            } else {
                (high, low)
            };
            open.push((other.0, other.1, far));
            open.push((near.0, near.1, away));
        }
        best
    }
}

/// Returns the square of the length of a vector.
fn square<P: Point>(vector: P) -> f64 {
    vector.dot(vector)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DVec2;

    #[test]
    fn the_nearest_point_is_found() {
        // Points on a line, on a grid, and scattered by a linear congruence.
        let line = (0..100).map(|x| DVec2::new(f64::from(x) / 7.0, 0.5));
        let grid = (0..400).map(|n| DVec2::new(f64::from(n % 20), f64::from(n / 20)));
        let scattered = (0..500u32).map(|n| {
            let n = n.wrapping_mul(2_654_435_761);
            DVec2::new(f64::from(n >> 16), f64::from(n & 0xffff)) / 4096.0
        });
        let sets: [Vec<DVec2>; 3] = [line.collect(), grid.collect(), scattered.clone().collect()];
        for set in sets {
            let tree = KdTree::new(set.clone());
            let mut open = Open::new();
            for point in scattered.clone() {
                let squares = set.iter().map(|other| (*other - point).length_squared());
                let expected = squares.fold(f64::INFINITY, f64::min);
                assert_eq!(tree.find(point, 0.0, 3, &mut open).1, expected);
                let (place, square) = tree.find(point, 4.0, 0, &mut open);
                assert!(square <= expected.max(4.0));
                assert_eq!((tree.points()[place] - point).length_squared(), square);
            }
        }
    }
}
