//! Chains of elements in the plane, whose elements turn in a tween.

use std::collections::BTreeMap;

use crate::geometry::DVec2;

use super::Tween;

/// Returns the points of a tween that goes by lengths and angles, from their places at both ends. `chains` lists the
/// points along which elements follow each other.
///
/// A chain starts where the points of its start pass in a straight line, and the vectors of its elements are put together.
/// Its end is free, unless the two figures share it or another chain has placed it: then the error is distributed along
/// the chain, in proportion to the lengths of its elements. Points that coincide in both figures coincide in the tween.
pub(super) fn placed(tween: Tween, ends: &[[DVec2; 2]], chains: &[Vec<usize>]) -> Vec<DVec2> {
    let mut places: Vec<DVec2> = ends.iter().map(|both| tween.between(*both)).collect();
    let key = |number: usize| ends[number].map(|it| it.to_array().map(f64::to_bits));
    let mut known = BTreeMap::new();
    for chain in chains {
        let [Some(&first), Some(&last)] = [chain.first(), chain.last()] else {
            continue;
        };
        let start = *known.entry(key(first)).or_insert(places[first]);
        let mut ways = vec![(DVec2::ZERO, 0.0)];
        let (mut way, mut length) = (DVec2::ZERO, 0.0);
        for pair in chain.windows(2) {
            let vector = |side: usize| ends[pair[1]][side] - ends[pair[0]][side];
            let vector = turned(tween, [vector(0), vector(1)]);
            way += vector;
            length += vector.length();
            ways.push((way, length));
        }
        let is_shared = ends[last][0] == ends[last][1];
        let end = known.get(&key(last)).copied();
        let end = end.or(is_shared.then_some(places[last]));
        let missing = end.map_or(DVec2::ZERO, |end| end - start - way);
        for (&number, (way, before)) in chain.iter().zip(ways) {
            let share = if length > 0.0 { before / length } else { 0.0 };
            let place = start + way + missing * share;
            known.entry(key(number)).or_insert(place);
        }
    }
    for (number, place) in places.iter_mut().enumerate() {
        if let Some(known) = known.get(&key(number)) {
            *place = *known;
        }
    }
    places
}

/// Returns the vector between two whose length and angle lie between theirs. A vector without length has the direction
/// of the other one.
pub(super) fn turned(tween: Tween, [a, b]: [DVec2; 2]) -> DVec2 {
    let lengths = [a.length(), b.length()];
    if lengths[0] == 0.0 || lengths[1] == 0.0 {
        return tween.between([a, b]);
    }
    let angle = libm::atan2(a.perp_dot(b), a.dot(b)) * tween.share;
    let turn = DVec2::new(libm::cos(angle), libm::sin(angle));
    turn.rotate(a) * (tween.between(lengths) / lengths[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tween::TweenBy;

    fn half() -> Tween {
        Tween {
            share: 0.5,
            by: TweenBy::Polar,
        }
    }

    #[test]
    fn vectors_turn_by_the_smaller_angle() {
        let turned = |a, b| turned(half(), [a, b]);
        let middle = turned(DVec2::X, DVec2::Y * 3.0);
        assert!((middle - DVec2::splat(2.0_f64.sqrt())).length() < 1e-15);
        let behind = turned(DVec2::new(-1.0, 0.1), DVec2::new(-1.0, -0.1));
        assert!(behind.x < -1.0 && behind.y.abs() < 1e-15);
        assert_eq!(turned(DVec2::ZERO, DVec2::X), DVec2::X / 2.0);
    }

    #[test]
    fn chains_keep_the_ends_that_they_share() {
        // A tent that turns over, from (0, 0) to (1, 0), and a branch that starts at its top and is free.
        let at = DVec2::new;
        let ends = [
            [at(0.0, 0.0); 2],
            [at(0.5, 0.5), at(0.25, -0.5)],
            [at(1.0, 0.0); 2],
            [at(0.5, 0.5), at(0.25, -0.5)],
            [at(0.5, 1.5), at(1.25, -0.5)],
        ];
        let chains = [vec![0, 1, 2], vec![3, 4]];
        let places = placed(half(), &ends, &chains);
        assert_eq!([places[0], places[2]], [DVec2::ZERO, DVec2::X]);
        assert_eq!(places[1], places[3]);
        let branch = places[4] - places[3];
        assert!((branch - DVec2::splat(0.5_f64.sqrt())).length() < 1e-12);
        for (share, side) in [(0.0, 0), (1.0, 1)] {
            let tween = Tween { share, ..half() };
            let all = placed(tween, &ends, &chains);
            for (place, end) in all.iter().zip(&ends) {
                assert!((*place - end[side]).length() < 1e-12);
            }
        }
    }
}
