//! Handles under a pointer.

use super::drag::Pointer;
use super::maps::{Grip, MapHandle};
use super::scene::Panel;

/// Pixels within which a handle is hit.
pub(super) const REACH: f64 = 12.0;

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

/// Returns the element that is hit: its middle, or its line.
pub(super) fn hit_element(panel: &Panel, event: &Pointer) -> Option<usize> {
    let to_line = |index: usize| {
        let element = &panel.elements[index];
        let [a, b] = [element.from, element.to].map(|point| panel.place(point));
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = along[0] * along[0] + along[1] * along[1];
        let [x, y] = event.place();
        let share = match length > 0.0 {
            true => (((x - a[0]) * along[0] + (y - a[1]) * along[1]) / length).clamp(0.0, 1.0),
            false => 0.0,
        };
        distance([a[0] + share * along[0], a[1] + share * along[1]], [x, y])
    };
    (0..panel.elements.len())
        .map(|index| (to_line(index), index))
        .filter(|(far, _)| *far <= REACH * event.pixel)
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, index)| index)
}

/// Returns the map that is hit, with its grip and the place of that: the nearest grip, or the body.
pub(super) fn hit_map(panel: &Panel, event: &Pointer) -> Option<(usize, Grip, [f64; 2])> {
    if let Some(index) = event.map {
        return Some((index, Grip::Body, panel.maps.get(index)?.frame[0]));
    }
    let handles = panel
        .maps
        .iter()
        .enumerate()
        .rev()
        .flat_map(|(index, map)| {
            let [o, x, y] = map.frame;
            [(Grip::Body, o), (Grip::X, x), (Grip::Y, y)].map(|(grip, place)| (index, grip, place))
        });
    let far = |&(_, _, place): &(usize, Grip, [f64; 2])| distance(place, event.place());
    // Of handles in one place, a corner of a map that is drawn above others comes first.
    let order = |it: &(usize, Grip, [f64; 2])| (far(it), !matches!(it.1, Grip::Body));
    let nearest = handles
        .filter(|handle| far(handle) <= REACH * event.pixel)
        .min_by(|a, b| {
            let ((a, x), (b, y)) = (order(a), order(b));
            a.total_cmp(&b).then(x.cmp(&y))
        });
    if nearest.is_some() {
        return nearest;
    }
    let inside = |map: &MapHandle| {
        let [o, x, y] = map.frame;
        let [u, v] = [x, y].map(|it| [it[0] - o[0], it[1] - o[1]]);
        let determinant = u[0] * v[1] - u[1] * v[0];
        let p = [event.place()[0] - o[0], event.place()[1] - o[1]];
        let a = (p[0] * v[1] - p[1] * v[0]) / determinant;
        let b = (u[0] * p[1] - u[1] * p[0]) / determinant;
        (0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b)
    };
    let index = panel.maps.iter().rposition(inside)?;
    Some((index, Grip::Body, panel.maps[index].frame[0]))
}
