//! Erosion and dilation by the smallest disks, by shifts of words of 64 pixels.

use crate::bits::Bits;

/// Erosion or dilation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Both {
    Erosion,
    Dilation,
}

/// Erodes or dilates `bits` by a plus or a square of three pixels, into `result`. Pixels outside are not set.
pub(super) fn step(both: Both, is_square: bool, bits: &Bits, result: &mut Bits) {
    match (both, is_square) {
        (Both::Erosion, false) => rows::<false>(bits, result, |one, other| one & other),
        (Both::Erosion, true) => rows::<true>(bits, result, |one, other| one & other),
        (Both::Dilation, false) => rows::<false>(bits, result, |one, other| one | other),
        (Both::Dilation, true) => rows::<true>(bits, result, |one, other| one | other),
    }
}

fn rows<const SQUARE: bool>(bits: &Bits, result: &mut Bits, join: impl Fn(u64, u64) -> u64) {
    let (width, height) = (bits.width(), bits.height());
    let stride = width.div_ceil(64);
    if stride == 0 {
        return;
    }
    let mask = u64::MAX >> (width.wrapping_neg() % 64);
    let empty = vec![0; stride];
    let row = |row: usize| if row < height { bits.row(row) } else { &empty };
    // With an empty word on either side, all words have neighbours.
    let mut across = vec![0; stride + 2];
    for (number, words) in result.words_mut().chunks_exact_mut(stride).enumerate() {
        let (above, here, below) = (row(number.wrapping_sub(1)), row(number), row(number + 1));
        let three = above.iter().zip(here).zip(below);
        if SQUARE {
            for (column, ((above, here), below)) in across[1..].iter_mut().zip(three.clone()) {
                *column = join(join(*above, *here), *below);
            }
        } else {
            across[1..=stride].copy_from_slice(here);
        }
        for ((word, near), ((above, _), below)) in
            words.iter_mut().zip(across.windows(3)).zip(three)
        {
            let left = near[1] << 1 | near[0] >> 63;
            let right = near[1] >> 1 | near[2] << 63;
            let row = join(join(left, near[1]), right);
            *word = if SQUARE {
                row
            } else {
                join(join(row, *above), *below)
            };
        }
        words[stride - 1] &= mask;
    }
}
