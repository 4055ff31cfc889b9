//! Merging of instances at equal places.

use std::collections::HashSet;

use dashu_int::IBig;

use super::fixed::Fixed;
use super::items::{FractalItem, FractalPart};

/// Number of instances up to which none are merged.
const FEW: usize = 256;

/// Number of low bits in which the maps of merged instances may differ: far more than rounding errors,
/// and less than a pixel.
const SAME: usize = 36;

/// Of several instances of one object at one place, drops all but the first, if there are many instances
/// in total. The first is that of the oldest fractal, which hides those of younger ones where ages
/// determine colours.
pub(super) fn merge(lines: &mut [FractalPart]) {
    let count: usize = lines.iter().map(|line| line.items.len()).sum();
    if count <= FEW {
        return;
    }
    let mut known = HashSet::new();
    for line in lines {
        let mut is_gap = false;
        line.items.retain_mut(|item| {
            let stays = match item {
                FractalItem::Node(node) => {
                    let direction = node.state.frame.direction();
                    known.insert((node.object, node.level, direction, key(&node.map)))
                }
                FractalItem::Root(_) => true,
                FractalItem::Seed(_) => return true,
            };
            // An item does not join one that was dropped.
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
