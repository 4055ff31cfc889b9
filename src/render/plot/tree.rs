//! A k-d tree (Bentley 1975) of integer points.

use std::ops::Range;

use crate::geometry::DVec2;

use super::points::{MEET, vector};

/// Balanced k-d tree: the median of each range divides the others, by x and by y in turn.
pub(super) struct Tree {
    /// Places with their items.
    places: Vec<([i32; 2], u32)>,
    /// Number of items that are left in a range, stored at its median.
    left: Vec<u32>,
}

impl Tree {
    pub(super) fn new(mut places: Vec<([i32; 2], u32)>) -> Self {
        divide(&mut places, 0);
        Self {
            places,
            left: Vec::new(),
        }
    }

    /// Finds the items on a line strictly between its ends, in order along it, with their positions as
    /// fractions of its length. The tolerance is the distance at which points meet.
    pub(super) fn between(&self, [from, to]: [[i32; 2]; 2], found: &mut Vec<(f64, u32)>) {
        found.clear();
        let line = [from, to].map(vector);
        self.search_between(0..self.places.len(), 0, line, line, found);
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }

    /// Searches a range, where `part` is the part of the line near it.
    fn search_between(
        &self,
        range: Range<usize>,
        axis: usize,
        line: [DVec2; 2],
        part: [DVec2; 2],
        found: &mut Vec<(f64, u32)>,
    ) {
        let Some((before, middle, after)) = halves(range) else {
            return;
        };
        let (place, item) = self.places[middle];
        let place = vector(place);
        let (by, along) = (place - line[0], line[1] - line[0]);
        let squared = along.length_squared();
        let meet = f64::from(MEET);
        // Without square roots the comparison is exact for small integers.
        let near = meet * meet * squared;
        let [before_end, after_start, off] =
            [squared - by.dot(along), by.dot(along), by.perp_dot(along)];
        let is_far = |along: f64| along > 0.0 && along * along > near;
        // A point that meets an end of the line is that end.
        if is_far(before_end) && is_far(after_start) && off * off <= near {
            found.push((after_start / squared, item));
        }
        // The addition covers rounding.
        let reach = meet + 0.001;
        for (range, side) in [(before, -1.0), (after, 1.0)] {
            if let Some(part) = beyond(part, axis, place[axis] - side * reach, side) {
                self.search_between(range, 1 - axis, line, part, found);
            }
        }
    }

    /// Marks all items as present, for [`Tree::nearest`].
    pub(super) fn fill(&mut self) {
        self.left = vec![0; self.places.len()];
        fill(&mut self.left);
    }

    /// Returns the item nearest to a place among those left, with its own place. Of equally near items, the one
    /// with the lowest number is returned.
    pub(super) fn nearest(&self, to: DVec2) -> Option<([i32; 2], u32)> {
        let mut best = None;
        self.search_near(0..self.places.len(), 0, to, &mut best);
        best.map(|(_, item, place)| (place, item))
    }

    fn search_near(
        &self,
        range: Range<usize>,
        axis: usize,
        to: DVec2,
        best: &mut Option<(f64, u32, [i32; 2])>,
    ) {
        let Some((before, middle, after)) = halves(range) else {
            return;
        };
        if self.left[middle] == 0 {
            return;
        }
        let (place, item) = self.places[middle];
        let at = vector(place);
        let others = [&before, &after].map(|half| self.left_in(half));
        if self.left[middle] > others[0] + others[1] {
            let squared = at.distance_squared(to);
            if best.is_none_or(|(least, known, _)| (squared, item) < (least, known)) {
                *best = Some((squared, item, place));
            }
        }
        let off = to[axis] - at[axis];
        let (near, far) = if off < 0.0 {
            (before, after)
        } else {
            (after, before)
        };
        self.search_near(near, 1 - axis, to, best);
        if best.is_none_or(|(least, ..)| off * off <= least) {
            self.search_near(far, 1 - axis, to, best);
        }
    }

    fn left_in(&self, range: &Range<usize>) -> u32 {
        halves(range.clone()).map_or(0, |(_, middle, _)| self.left[middle])
    }

    /// Removes an item at a place.
    pub(super) fn remove(&mut self, place: [i32; 2], item: u32) {
        let (mut range, mut axis) = (0..self.places.len(), 0);
        while let Some((before, middle, after)) = halves(range) {
            self.left[middle] -= 1;
            let wanted = (place[axis], place, item);
            let (here, there) = self.places[middle];
            range = match wanted.cmp(&(here[axis], here, there)) {
                std::cmp::Ordering::Less => before,
                std::cmp::Ordering::Equal => return,
                std::cmp::Ordering::Greater => after,
            };
            axis = 1 - axis;
        }
    }
}

/// Returns the median of a range, and the ranges before and after it.
fn halves(range: Range<usize>) -> Option<(Range<usize>, usize, Range<usize>)> {
    let middle = range.start + range.len() / 2;
    (!range.is_empty()).then_some((range.start..middle, middle, middle + 1..range.end))
}

fn divide(places: &mut [([i32; 2], u32)], axis: usize) {
    if places.len() < 2 {
        return;
    }
    let middle = places.len() / 2;
    places.select_nth_unstable_by_key(middle, |&(place, item)| (place[axis], place, item));
    let (before, after) = places.split_at_mut(middle);
    divide(before, 1 - axis);
    divide(&mut after[1..], 1 - axis);
}

fn fill(left: &mut [u32]) {
    let middle = left.len() / 2;
    let count = u32::try_from(left.len()).unwrap_or(u32::MAX);
    if let Some(value) = left.get_mut(middle) {
        *value = count;
        let (before, after) = left.split_at_mut(middle);
        fill(before);
        fill(&mut after[1..]);
    }
}

/// Returns the part of a line on one side of an edge: above it if `side` is 1, below it if `side` is −1.
fn beyond([from, to]: [DVec2; 2], axis: usize, edge: f64, side: f64) -> Option<[DVec2; 2]> {
    let over = |at: DVec2| side * (at[axis] - edge);
    match (over(from) >= 0.0, over(to) >= 0.0) {
        (true, true) => Some([from, to]),
        (false, false) => None,
        (starts, _) => {
            let cut = from + (to - from) * (over(from) / (over(from) - over(to)));
            Some(if starts { [from, cut] } else { [cut, to] })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places() -> Vec<([i32; 2], u32)> {
        // Some places coincide, and some are collinear.
        let place = |n: i32| [n * 7919 % 97, n * 104_729 % 61];
        (0..400).map(|n| (place(n), n.cast_unsigned())).collect()
    }

    #[test]
    fn what_lies_on_a_line_is_found() {
        let tree = Tree::new(places());
        for number in 0..50 {
            let line = [[number, 0], [90 - number, 60]];
            let [from, to] = line.map(|place| place.map(i64::from));
            let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
            let squared = dx * dx + dy * dy;
            let on = |&&(place, _): &&([i32; 2], u32)| {
                let [x, y] = [0, 1].map(|axis| i64::from(place[axis]) - from[axis]);
                let (along, off) = (x * dx + y * dy, x * dy - y * dx);
                let is_far = |along: i64| along > 0 && along * along > 4 * squared;
                is_far(along) && is_far(squared - along) && off * off <= 4 * squared
            };
            let all = places();
            let mut expected: Vec<_> = all.iter().filter(on).map(|&(_, item)| item).collect();
            expected.sort_unstable();
            let mut found = Vec::new();
            tree.between(line, &mut found);
            let mut found: Vec<_> = found.iter().map(|&(_, item)| item).collect();
            found.sort_unstable();
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn the_nearest_is_found_until_none_is_left() {
        let mut left = places();
        let mut tree = Tree::new(left.clone());
        tree.fill();
        let mut at = DVec2::new(3.0, 4.0);
        while let Some((place, item)) = tree.nearest(at) {
            let squared = |place: [i32; 2]| vector(place).distance_squared(at);
            let least = left.iter().map(|&(place, item)| (squared(place), item));
            let least = least.min_by(|a, b| a.partial_cmp(b).unwrap());
            assert_eq!(least, Some((squared(place), item)));
            left.retain(|&(_, other)| other != item);
            tree.remove(place, item);
            at = vector(place);
        }
        assert!(left.is_empty());
    }
}
