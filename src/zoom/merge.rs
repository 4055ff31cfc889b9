//! Instances that stand in each other's place.

use std::collections::HashSet;

use dashu_int::IBig;

use super::descent::Item;
use super::fixed::Fixed;

/// As long as there are no more instances than this, they are drawn as they come.
const FEW: usize = 256;

/// Maps whose numbers differ by less than about this many bits are the same; rounding errors are less,
/// by far, and a pixel is more.
const SAME: usize = 36;

/// Leaves out, of instances of one object in one place, all but the first, if there are many.
pub(super) fn merge(items: &mut Vec<Item>) {
    if items.len() <= FEW {
        return;
    }
    let mut known = HashSet::new();
    let mut is_gap = false;
    items.retain_mut(|item| {
        let (stays, joined) = match item {
            Item::Node(node) => {
                let direction = node.standing.frame.direction;
                let key = (node.object, node.level, direction, key(&node.map));
                (known.insert(key), &mut node.joined)
            }
            Item::Root(found) => (true, &mut found.joined),
        };
        // Nothing goes on from where something is left out.
        *joined &= !std::mem::replace(&mut is_gap, !stays);
        stays
    });
}

fn key(map: &Fixed) -> [IBig; 6] {
    let half = IBig::ONE << (SAME - 1);
    let [[a, b], [c, d]] = &map.axes;
    let [e, f] = &map.origin;
    [a, b, c, d, e, f].map(|number| (number + &half) >> SAME)
}
