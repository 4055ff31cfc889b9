//! Joining of strokes into trails.

use super::points::Point;
use super::strokes::{Strokes, is_closed};

/// Joins strokes where their ends meet. The results are ordered by their first strokes; closed strokes are
/// not joined.
///
/// Strokes are edges of a graph, and the results are trails in it. Trails that begin at a point where an odd
/// number of ends meet continue as far as possible, and end at another such point. The number of open
/// strokes is therefore minimal: half the number of such points.
pub(super) fn merged(strokes: &Strokes) -> Strokes {
    let mut junctions = Junctions::of(strokes);
    let mut trails = Vec::new();
    for only_odd in [true, false] {
        for number in 0..strokes.len() {
            if junctions.used[number] || (is_closed(strokes.get(number)) && only_odd) {
                continue;
            }
            let [from, to] = ends(strokes, number);
            let backwards = if junctions.is_odd(from) {
                false
            } else if junctions.is_odd(to) {
                true
            } else if only_odd {
                continue;
            } else {
                false
            };
            trails.push(junctions.trail(strokes, number, backwards));
        }
    }
    trails.sort_by_key(|trail| trail.iter().map(|part| part.number).min());
    let mut merged = Strokes::default();
    for trail in trails {
        let Some(first) = trail.first() else { continue };
        let [from, to] = ends(strokes, first.number);
        merged.begin(if first.backwards { to } else { from });
        for part in &trail {
            let points = strokes.get(part.number).iter();
            if part.backwards {
                points.rev().for_each(|&point| merged.go_on(point));
            } else {
                points.for_each(|&point| merged.go_on(point));
            }
        }
    }
    merged.end();
    merged
}

/// Stroke of a trail.
struct TrailStroke {
    number: usize,
    backwards: bool,
}

fn ends(strokes: &Strokes, number: usize) -> [Point; 2] {
    let stroke = strokes.get(number);
    [stroke[0], stroke[stroke.len() - 1]]
}

/// Points where ends of open strokes meet.
struct Junctions {
    /// All ends, sorted by their points.
    ends: Vec<(Point, u32)>,
    /// For the first end of a point: the number of ends at the point that have been examined, and the number
    /// of ends that are on trails.
    looked_at: Vec<[u32; 2]>,
    used: Vec<bool>,
}

impl Junctions {
    fn of(strokes: &Strokes) -> Self {
        let mut all = Vec::new();
        for (number, stroke) in (0..).zip(strokes.iter()) {
            if !is_closed(stroke) {
                all.extend([(stroke[0], number), (stroke[stroke.len() - 1], number)]);
            }
        }
        all.sort_unstable();
        Self {
            looked_at: vec![[0; 2]; all.len()],
            ends: all,
            used: vec![false; strokes.len()],
        }
    }

    /// Returns the index of the first end at a point, and the number of ends there.
    fn place(&self, point: Point) -> (usize, usize) {
        let first = self.ends.partition_point(|end| end.0 < point);
        let count = self.ends[first..].partition_point(|end| end.0 == point);
        (first, count)
    }

    /// Returns whether the number of unused ends at a point is odd.
    fn is_odd(&self, point: Point) -> bool {
        let (first, count) = self.place(point);
        count > 0 && (count - self.looked_at[first][1] as usize) % 2 == 1
    }

    /// Marks an end at a point as used.
    fn leave(&mut self, point: Point) {
        let (first, count) = self.place(point);
        if count > 0 {
            self.looked_at[first][1] += 1;
        }
    }

    /// Returns a stroke at a point that is not on a trail.
    fn next(&mut self, point: Point) -> Option<usize> {
        let (first, count) = self.place(point);
        let looked_at = &mut self.looked_at.get_mut(first)?[0];
        while (*looked_at as usize) < count {
            let number = self.ends[first + *looked_at as usize].1 as usize;
            if !self.used[number] {
                return Some(number);
            }
            *looked_at += 1;
        }
        None
    }

    /// Extends a trail from a stroke as far as possible.
    fn trail(&mut self, strokes: &Strokes, first: usize, backwards: bool) -> Vec<TrailStroke> {
        let mut trail = vec![TrailStroke {
            number: first,
            backwards,
        }];
        while let Some(&TrailStroke { number, backwards }) = trail.last() {
            self.used[number] = true;
            let [from, to] = ends(strokes, number);
            // Closed strokes have no ends.
            if !is_closed(strokes.get(number)) {
                [from, to].into_iter().for_each(|end| self.leave(end));
            }
            let at = if backwards { from } else { to };
            let Some(next) = self.next(at) else { break };
            trail.push(TrailStroke {
                number: next,
                backwards: ends(strokes, next)[0] != at,
            });
        }
        trail
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strokes(all: &[&[Point]]) -> Strokes {
        let mut strokes = Strokes::default();
        for stroke in all {
            strokes.begin(stroke[0]);
            stroke.iter().for_each(|&point| strokes.go_on(point));
        }
        strokes.end();
        strokes
    }

    #[test]
    fn ends_that_meet_are_joined() {
        type Lines<'a> = &'a [&'a [Point]];
        let cases: [(Lines<'_>, Lines<'_>); 4] = [
            (&[&[1, 2], &[2, 3], &[4, 3]], &[&[1, 2, 3, 4]]),
            // A loop that was cut is closed again.
            (&[&[1, 2, 3], &[3, 4, 1]], &[&[1, 2, 3, 4, 1]]),
            // A star of three rays takes two strokes.
            (&[&[0, 1], &[0, 2], &[0, 3]], &[&[0, 1], &[2, 0, 3]]),
            (&[&[1, 2, 1], &[1, 5]], &[&[1, 2, 1], &[1, 5]]),
        ];
        for (given, expected) in cases {
            let merged = merged(&strokes(given));
            let merged: Vec<_> = merged.iter().collect();
            assert_eq!(merged, expected, "{given:?}");
        }
    }

    #[test]
    fn there_are_as_few_open_strokes_as_there_can_be() {
        // The "house of Santa Claus" can be drawn in one stroke.
        const HOUSE: [[Point; 2]; 8] = [
            [1, 2],
            [2, 3],
            [3, 4],
            [4, 1],
            [1, 3],
            [2, 4],
            [3, 5],
            [5, 4],
        ];
        let lines: Vec<_> = HOUSE.iter().map(<[Point; 2]>::as_slice).collect();
        let merged = merged(&strokes(&lines));
        let open = merged.iter().filter(|stroke| !is_closed(stroke));
        assert_eq!(open.count(), 1);
        let edges = merged.iter().flat_map(|stroke| stroke.windows(2));
        let sorted = |edge: &[Point]| [edge[0].min(edge[1]), edge[0].max(edge[1])];
        let mut edges: Vec<_> = edges.map(sorted).collect();
        edges.sort_unstable();
        let mut expected = HOUSE.map(|edge| sorted(&edge));
        expected.sort_unstable();
        assert_eq!(edges, expected);
    }
}
