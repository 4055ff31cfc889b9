//! Thinning in the order of distances, which keeps the connected parts and the holes of a set (Pudney 1998).

use super::super::interior::{Interior, around};

/// Whether a pixel with certain neighbours can be removed without a change of parts (connected by sides or corners)
/// and holes (connected by sides); a bit for each neighbour, round the pixel from the right.
const SIMPLE: [bool; 256] = {
    let mut table = [false; 256];
    let mut neighbours: usize = 0;
    while neighbours < 256 {
        // Runs of neighbours round the pixel that begin beside a side that is not set (Yokoi's number).
        let mut runs = 0;
        let mut side = 0;
        while side < 8 {
            let next = [side, side + 1, (side + 2) % 8];
            let is_side_set = neighbours >> next[0] & 1 == 1;
            let is_other_set = neighbours >> next[1] & 1 == 1 || neighbours >> next[2] & 1 == 1;
            if !is_side_set && is_other_set {
                runs += 1;
            }
            side += 2;
        }
        table[neighbours] = runs == 1;
        neighbours += 1;
    }
    table
};

/// Removes pixels until the set is a skeleton, and returns the indices of those that are left, in order.
pub(super) fn thinned(interior: &Interior, anchors: &[bool]) -> Vec<usize> {
    let width = interior.map.width();
    let mut set: Vec<bool> = interior.map.squared().iter().map(|&it| it > 0).collect();
    let mut remains = |pixel: usize| {
        let mut neighbours = 0;
        for (bit, place) in around(pixel, width).into_iter().enumerate() {
            neighbours |= usize::from(set[place]) << bit;
        }
        let is_end = neighbours.is_power_of_two();
        let remains = !SIMPLE[neighbours] || is_end && anchors[pixel];
        set[pixel] = remains;
        remains
    };
    let mut pixels = in_order(interior, anchors);
    loop {
        let before = pixels.len();
        pixels.retain(|&pixel| remains(pixel as usize));
        if pixels.len() == before {
            break;
        }
    }
    pixels.sort_unstable();
    pixels.into_iter().map(|pixel| pixel as usize).collect()
}

/// Returns the pixels of the set by their distance, of one distance those that are no anchors first, then by index.
#[expect(clippy::cast_possible_truncation, reason = "indices have 32 bits")]
fn in_order(interior: &Interior, anchors: &[bool]) -> Vec<u32> {
    let rank = |index: usize, squared: u32| 2 * squared as usize + usize::from(anchors[index]);
    let mut starts = vec![0u32; 2 * interior.largest() as usize + 3];
    for (index, squared) in interior.pixels() {
        starts[rank(index, squared) + 1] += 1;
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut pixels = vec![0; sum as usize];
    for (index, squared) in interior.pixels() {
        let start = &mut starts[rank(index, squared)];
        pixels[*start as usize] = index as u32;
        *start += 1;
    }
    pixels
}
