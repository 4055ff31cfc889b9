//! Triangulation of polygons by their ears.

use glam::DVec2;

/// Twice the area of a triangle up to which its corners lie on a line.
const FLAT: f64 = 1e-14;

/// Returns twice the signed area of a triangle.
pub(super) fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Cuts a polygon, whose corners run counter-clockwise, into triangles by its ears (Meisters 1975), always the first one.
/// `None` if there is none, as where sides cross.
pub(super) fn ears(points: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    let mut polygon = Polygon::of(points);
    let mut ears = Vec::new();
    // No corner before it is that of an ear.
    let mut first = 0;
    while polygon.rest.len() > 2 {
        let count = polygon.rest.len();
        let at = (first..count).find(|&at| polygon.is_ear(at))?;
        let ear = polygon.around(at);
        if turn(ear.map(|corner| points[corner])).abs() > FLAT {
            ears.push(ear);
        }
        first = match polygon.cut(at) || at + 1 == count {
            true => 0,
            false => at.saturating_sub(1),
        };
    }
    Some(ears)
}

/// Polygon from which ears are cut.
struct Polygon<'p> {
    points: &'p [DVec2],
    /// Corners that are left, in order.
    rest: Vec<usize>,
    is_left: Vec<bool>,
    /// All corners, from left to right.
    by_x: Vec<usize>,
    /// For corners that are known not to be those of ears, a corner because of which they are none: one inside the triangle, or
    /// the corner itself. Unless that is cut off, or a neighbour, they still are none.
    obstacles: Vec<Option<usize>>,
    /// Whether a corner is an obstacle of others.
    is_obstacle: Vec<bool>,
}

impl<'p> Polygon<'p> {
    fn of(points: &'p [DVec2]) -> Self {
        let count = points.len();
        let mut by_x: Vec<usize> = (0..count).collect();
        by_x.sort_by(|a, b| points[*a].x.total_cmp(&points[*b].x));
        Self {
            points,
            rest: (0..count).collect(),
            is_left: vec![true; count],
            by_x,
            obstacles: vec![None; count],
            is_obstacle: vec![false; count],
        }
    }

    /// Returns a corner between its neighbours.
    fn around(&self, at: usize) -> [usize; 3] {
        let count = self.rest.len();
        let before = (at + count - 1) % count;
        [before, at, (at + 1) % count].map(|at| self.rest[at])
    }

    /// Returns whether a corner and its neighbours are an ear.
    fn is_ear(&mut self, at: usize) -> bool {
        let corner = self.rest[at];
        if self.obstacles[corner].is_some_and(|obstacle| self.is_left[obstacle]) {
            return false;
        }
        let obstacle = self.obstacle(at);
        self.obstacles[corner] = obstacle;
        if let Some(obstacle) = obstacle.filter(|obstacle| *obstacle != corner) {
            self.is_obstacle[obstacle] = true;
        }
        obstacle.is_none()
    }

    /// Returns a corner because of which another one is not that of an ear; `None` if it is.
    fn obstacle(&self, at: usize) -> Option<usize> {
        let corners = self.around(at).map(|corner| self.points[corner]);
        let [a, b, c] = corners;
        let doubled = turn(corners);
        if doubled.abs() <= FLAT {
            // A corner on a straight line, or a spike.
            return None;
        }
        let is_convex = doubled > 0.0;
        if !is_convex {
            return Some(self.rest[at]);
        }
        let holds = |point: DVec2| {
            [[a, b], [b, c], [c, a]]
                .iter()
                .all(|[from, to]| turn([*from, *to, point]) >= -FLAT)
        };
        // Barycentric coordinates of a point that it holds are not below -FLAT / doubled, but for rounding.
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        let margin = (max - min) * (4.0 * FLAT / doubled + 1e-9);
        let (min, max) = (min - margin, max + margin);
        let is_before = |corner: &usize| self.points[*corner].x < min.x;
        let from = self.by_x.partition_point(is_before);
        let others = self.by_x[from..].iter().copied();
        let mut others = others.take_while(|other| self.points[*other].x <= max.x);
        others.find(|&other| {
            let point = self.points[other];
            let is_near = point.y >= min.y && point.y <= max.y;
            is_near && self.is_left[other] && !corners.contains(&point) && holds(point)
        })
    }

    /// Cuts off a corner. Returns whether it was an obstacle.
    fn cut(&mut self, at: usize) -> bool {
        let [before, corner, after] = self.around(at);
        self.rest.remove(at);
        self.is_left[corner] = false;
        self.obstacles[before] = None;
        self.obstacles[after] = None;
        self.is_obstacle[corner]
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Returns the same triangles as [`ears`], looking at every corner again after each.
    fn by_definition(points: &[DVec2]) -> Option<Vec<[usize; 3]>> {
        let mut rest: Vec<usize> = (0..points.len()).collect();
        let mut ears = Vec::new();
        while rest.len() > 2 {
            let count = rest.len();
            let around = |at: usize| [at + count - 1, at, at + 1].map(|at| rest[at % count]);
            let is_ear = |at: usize| {
                let corners @ [a, b, c] = around(at).map(|corner| points[corner]);
                let doubled = turn(corners);
                let holds = |point: DVec2| {
                    let sides = [[a, b], [b, c], [c, a]];
                    sides
                        .iter()
                        .all(|[from, to]| turn([*from, *to, point]) >= -FLAT)
                };
                let mut others = rest.iter().map(|&corner| points[corner]);
                let mut held = others
                    .by_ref()
                    .filter(|it| !corners.contains(it) && holds(*it));
                doubled.abs() <= FLAT || doubled > 0.0 && held.next().is_none()
            };
            let at = (0..count).find(|&at| is_ear(at))?;
            let ear = around(at);
            if turn(ear.map(|corner| points[corner])).abs() > FLAT {
                ears.push(ear);
            }
            rest.remove(at);
        }
        Some(ears)
    }

    /// Returns a number from 0 to 1.
    fn random(state: &mut u64) -> f64 {
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (*state >> 11) as f64 / 2f64.powi(53)
    }

    /// Returns a polygon about the origin, a comb, a spiral, or one whose sides cross.
    fn polygon(kind: usize, count: usize, state: &mut u64) -> Vec<DVec2> {
        let ray = |angle: f64, radius: f64| DVec2::new(libm::cos(angle), libm::sin(angle)) * radius;
        let share = |at: usize| at as f64 / count as f64;
        match kind {
            0 => (0..count)
                .map(|at| ray(TAU * share(at), 0.2 + random(state)))
                .collect(),
            1 => (0..count)
                .map(|at| DVec2::new(1.0 - share(at), if at % 2 == 0 { 1.0 } else { 0.1 }))
                .chain([DVec2::new(0.0, -1.0), DVec2::X - DVec2::Y])
                .collect(),
            2 => {
                let arm = |at: usize, width: f64| ray(3.0 * TAU * share(at), share(at) + width);
                let back = (0..count).rev().map(|at| arm(at, 0.2));
                (0..count).map(|at| arm(at, 0.3)).chain(back).collect()
            }
            _ => (0..count)
                .map(|_| DVec2::new(random(state), random(state)))
                .collect(),
        }
    }

    #[test]
    fn ears_are_the_first_ones() {
        let mut state = 1;
        let mut found = 0;
        for number in 0..1200 {
            let count = 3 + number % 60;
            let mut points = polygon(number / 60 % 4, count, &mut state);
            if number % 3 == 0 {
                // Many corners lie on lines, and some at one place.
                points
                    .iter_mut()
                    .for_each(|it| *it = (*it * 8.0).round() / 8.0);
            }
            let ears = ears(&points);
            assert_eq!(ears, by_definition(&points), "{points:?}");
            found += usize::from(ears.is_some());
        }
        assert!((600..1200).contains(&found), "{found}");
    }

    #[test]
    fn polygons_of_two_thousand_corners_take_little() {
        let mut state = 7;
        let started = std::time::Instant::now();
        for kind in 0..4 {
            let count = if kind == 2 { 1000 } else { 2000 };
            let points = polygon(kind, count, &mut state);
            for _ in 0..5 {
                assert!(ears(&points).is_some() || kind == 3);
            }
        }
        let taken = started.elapsed().as_secs_f64();
        assert!(taken < 2.0, "{taken} s");
    }
}
