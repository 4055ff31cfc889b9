//! The graph of touching pieces, and pieces that meet by a theorem.

use super::Connectedness;
use crate::geometry::{DAffine2, DMat2};

/// Whether two pieces meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meeting {
    /// They are disjoint: all pairs of smaller pieces are apart, under compositions of at most this number of maps.
    Apart(u32),
    /// Smaller pieces are not all apart at the greatest depth.
    Unknown,
    /// The budget is exceeded.
    Exceeded,
}

/// Maps that are joined by pieces that meet.
struct Joined(Vec<usize>);

impl Joined {
    /// Returns the representative of the maps to which a map is joined.
    fn of(&self, mut map: usize) -> usize {
        while self.0[map] != map {
            map = self.0[map];
        }
        map
    }

    /// Joins two maps. Returns whether they were not joined before.
    fn join(&mut self, [i, j]: [usize; 2]) -> bool {
        let [i, j] = [self.of(i), self.of(j)];
        self.0[j.max(i)] = i.min(j);
        i != j
    }

    fn is_one(&self) -> bool {
        (1..self.0.len()).all(|map| self.of(map) == 0)
    }
}

/// Determines whether an attractor is connected, from the pairs of its pieces that meet.
///
/// The graph of the pieces that are not yet apart loses its last connection at the depth that is the least in a spanning
/// tree of the greatest depths.
pub(super) fn bottleneck(
    count: usize,
    meet_by_theorem: impl Fn([usize; 2]) -> bool,
    mut meeting: impl FnMut([usize; 2]) -> Meeting,
) -> Connectedness {
    let mut joined = Joined((0..count).collect());
    let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| [i, j]));
    for pair in pairs.clone().filter(|pair| meet_by_theorem(*pair)) {
        joined.join(pair);
    }
    if joined.is_one() {
        return Connectedness::Connected;
    }
    let (mut apart, mut is_exceeded) = (Vec::new(), false);
    for pair in pairs {
        if joined.of(pair[0]) == joined.of(pair[1]) {
            continue;
        }
        match meeting(pair) {
            Meeting::Apart(depth) => apart.push((depth, pair)),
            other => {
                is_exceeded |= other == Meeting::Exceeded;
                joined.join(pair);
            }
        }
    }
    if joined.is_one() {
        return match is_exceeded {
            true => Connectedness::Undecided,
            false => Connectedness::NotCertified,
        };
    }
    apart.sort_by_key(|(depth, _)| std::cmp::Reverse(*depth));
    let mut last = 0;
    for (depth, pair) in apart {
        if joined.join(pair) {
            last = depth;
        }
    }
    Connectedness::Disconnected(last)
}

/// Returns whether the pieces of two maps meet by a theorem: see [`ConnectednessSearch::of`](super::ConnectednessSearch::of).
pub(super) fn meet_by_theorem(f: &DAffine2, g: &DAffine2) -> bool {
    /// Margin for the rounding errors of determinants.
    const MARGIN: f64 = 1e-14;
    if f == g {
        return true;
    }
    let areas = [f, g].map(|map| map.matrix2.determinant().abs());
    if areas[0] + areas[1] >= 1.0 + MARGIN {
        return true;
    }
    match [f, g].map(|map| ratio(&map.matrix2)) {
        [Some(one), Some(other)] => is_at_least_one(one.abs(), other.abs()),
        _ => false,
    }
}

/// Returns the factor of a multiple of the identity.
fn ratio(linear: &DMat2) -> Option<f64> {
    let (x, y) = (linear.x_axis, linear.y_axis);
    (x.y == 0.0 && y.x == 0.0 && x.x == y.y).then_some(x.x)
}

/// Returns whether the sum of two numbers from 0 is at least 1, without rounding (Dekker 1971).
fn is_at_least_one(a: f64, b: f64) -> bool {
    let (small, large) = (a.min(b), a.max(b));
    let sum = large + small;
    let lost = small - (sum - large);
    sum > 1.0 || (sum == 1.0 && lost >= 0.0)
}
