//! Instances that stand in each other's place.

use std::collections::HashSet;

use dashu_int::IBig;

use super::fixed::Fixed;
use super::items::{Item, Line};

/// As long as there are no more instances than this, they are drawn as they come.
const FEW: usize = 256;

/// Maps whose numbers differ by less than about this many bits are the same; rounding errors are less,
/// by far, and a pixel is more.
const SAME: usize = 36;

/// Leaves out, of instances of one object in one place, all but the first, if there are many: that of the
/// oldest fractal, which hides those of younger ones where ages tell colours.
pub(super) fn merge(lines: &mut [Line]) {
    let count: usize = lines.iter().map(|line| line.items.len()).sum();
    if count <= FEW {
        return;
    }
    let mut known = HashSet::new();
    for line in lines {
        let mut is_gap = false;
        line.items.retain_mut(|item| {
            let stays = match item {
                Item::Node(node) => {
                    let direction = node.standing.frame.direction;
                    known.insert((node.object, node.level, direction, key(&node.map)))
                }
                Item::Root(_) => true,
                Item::Seed(_) => return true,
            };
            // Nothing goes on from where something is left out.
            let was_gap = std::mem::replace(&mut is_gap, !stays);
            if let Some(joined) = item.joined() {
                *joined &= !was_gap;
            }
            stays
        });
        if is_gap {
            line.open();
        }
    }
}

fn key(map: &Fixed) -> [IBig; 6] {
    let half = IBig::ONE << (SAME - 1);
    let [[a, b], [c, d]] = &map.axes;
    let [e, f] = &map.origin;
    [a, b, c, d, e, f].map(|number| (number + &half) >> SAME)
}
