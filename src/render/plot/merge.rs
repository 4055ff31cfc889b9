use super::points::Point;
use super::strokes::{Strokes, is_closed};

/// Strokes put together where their ends meet, in the order of what comes first in them. Closed
/// ones stay as they are.
///
/// They are edges of a graph, and what is drawn are trails in it. Those that begin where an odd number
/// of ends meet go on as far as they can and end in such a place; so there are as few open strokes
/// as there can be, half as many as such places.
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

/// A stroke on a trail.
struct Part {
    number: usize,
    backwards: bool,
}

fn ends(strokes: &Strokes, number: usize) -> [Point; 2] {
    let stroke = strokes.get(number);
    [stroke[0], stroke[stroke.len() - 1]]
}

/// Where ends of open strokes meet.
struct Junctions {
    /// Every end, by its point.
    ends: Vec<(Point, u32)>,
    /// At the first end of a point: how many of its ends have been looked at, and how many are on
    /// trails.
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

    /// The first end at a point, and how many there are.
    fn place(&self, point: Point) -> (usize, usize) {
        let first = self.ends.partition_point(|end| end.0 < point);
        let count = self.ends[first..].partition_point(|end| end.0 == point);
        (first, count)
    }

    /// Whether an odd number of ends is left at a point.
    fn is_odd(&self, point: Point) -> bool {
        let (first, count) = self.place(point);
        count > 0 && (count - self.looked_at[first][1] as usize) % 2 == 1
    }

    /// Uses an end at a point.
    fn leave(&mut self, point: Point) {
        let (first, count) = self.place(point);
        if count > 0 {
            self.looked_at[first][1] += 1;
        }
    }

    /// A stroke at a point that is on no trail yet.
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

    /// Goes on from a stroke as far as there is a way.
    fn trail(&mut self, strokes: &Strokes, first: usize, backwards: bool) -> Vec<Part> {
        let mut trail = vec![Part {
            number: first,
            backwards,
        }];
        while let Some(&Part { number, backwards }) = trail.last() {
            self.used[number] = true;
            let [from, to] = ends(strokes, number);
            // Ends of closed strokes do not count.
            if !is_closed(strokes.get(number)) {
                [from, to].into_iter().for_each(|end| self.leave(end));
            }
            let at = if backwards { from } else { to };
            let Some(next) = self.next(at) else { break };
            trail.push(Part {
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
        // The house of Santa Claus, which is drawn in one.
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
