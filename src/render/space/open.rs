//! Parts of a tile on which a convex solid may be seen: between its sides, and not behind what is drawn.

use super::buffer::{BLOCK, BLOCKS_ALONG, Buffer};
use super::planes::{LANES, Planes};
use super::solid::View;

/// Calls `draw` with the parts of rows of samples on which a solid may be seen, the sides of which are known, and with the
/// place of their first samples. They start a whole number of lanes after the left end of `rectangle`, so that samples are
/// computed alike; the first few may be behind all that is drawn. The buffer is [refreshed](Buffer::refresh).
pub(super) fn draw_open(
    buffer: &mut Buffer,
    view: &View<'_>,
    planes: &Planes,
    rectangle @ [left, top, right, bottom]: [usize; 4],
    mut draw: impl FnMut(&mut [u32], [usize; 2]),
) {
    let mut drawn = None;
    for row in top / BLOCK..bottom.div_ceil(BLOCK) {
        let rows = top.max(row * BLOCK)..bottom.min((row + 1) * BLOCK);
        let spans: [[usize; 2]; BLOCK] = std::array::from_fn(|y| {
            let y = row * BLOCK + y;
            match rows.contains(&y) {
                true => planes.seen_on_row(view, y, [left, right]),
                false => [right, left],
            }
        });
        let [first, last] = (spans.iter().filter(|[first, last]| first < last))
            .fold([right, left], |[a, b], [c, d]| [a.min(*c), b.max(*d)]);
        if first >= last {
            continue;
        }
        let columns = [first / BLOCK, last.div_ceil(BLOCK)];
        let open = planes.open_blocks(view, row, columns, buffer.blocks(row));
        for [start, end] in runs(open) {
            let [start, end] = [start * BLOCK, end * BLOCK];
            for y in rows.clone() {
                let [first, last] = spans[y - row * BLOCK];
                let first = first.max(left + start.saturating_sub(left) / LANES * LANES);
                let last = last.min(end);
                if first < last {
                    draw(&mut buffer.row_mut(y)[first..last], [first, y]);
                }
            }
            let [a, b, c, d] = drawn.unwrap_or([right, bottom, left, top]);
            drawn = Some([a.min(start), b.min(rows.start), c.max(end), d.max(rows.end)]);
        }
    }
    if let Some([first, top, last, bottom]) = drawn {
        let [left, _, right, _] = rectangle;
        buffer.refresh([first.max(left), top, last.min(right), bottom]);
    }
}

/// Iterates over the runs of ones of a number: the first bit of each, and that behind its last.
fn runs(mut bits: u64) -> impl Iterator<Item = [usize; 2]> {
    const { assert!(BLOCKS_ALONG == u64::BITS as usize) };
    let mut at = 0;
    std::iter::from_fn(move || {
        if bits == 0 {
            return None;
        }
        let start = at + bits.trailing_zeros();
        bits = bits.unbounded_shr(start - at);
        let end = start + bits.trailing_ones();
        bits = bits.unbounded_shr(end - start);
        at = end;
        Some([start as usize, end as usize])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_those_of_ones() {
        for (bits, expected) in [
            (0, vec![]),
            (1, vec![[0, 1]]),
            (0b1_0110, vec![[1, 3], [4, 5]]),
            (u64::MAX, vec![[0, 64]]),
            (1 << 63 | 3, vec![[0, 2], [63, 64]]),
        ] {
            assert_eq!(runs(bits).collect::<Vec<_>>(), expected, "{bits:b}");
        }
    }
}
