//! The pixels at which a branch of a skeleton may end.

use crate::bits::Bits;
use crate::parallel::for_each;

use super::super::interior::Interior;
use super::SkeletonOptions;

/// Number of rows that one thread looks at together.
const BAND: usize = 64;

/// Squared distance up to which nearest pixels outside are anchors only where they are on opposite sides.
const THIN: f64 = 2.0;

/// Finds the pixels whose nearest pixel outside lies in another direction than that of a neighbour.
///
/// Returns a flag for each pixel.
pub(super) fn anchors(interior: &Interior, options: &SkeletonOptions) -> Vec<bool> {
    let width = interior.bits.width();
    let mut anchors = Bits::new(width, interior.bits.height());
    let stride = width.div_ceil(64);
    let cosine = libm::cos(options.angle.to_radians());
    let bound = cosine * cosine.abs();
    let bands = anchors.words_mut().chunks_mut(BAND * stride).enumerate();
    for_each(bands, options.threads.get(), |(band, words)| {
        let first = band * BAND;
        let at = |row: usize| directions(interior, row.min(interior.map.height() - 1));
        let mut here = at(first);
        let mut above = vec![0; stride];
        let mut spare = vec![0; stride];
        mark(
            &at(first.saturating_sub(1)),
            &here,
            [0, 1],
            bound,
            [&mut spare, &mut above],
        );
        for (number, words) in words.chunks_exact_mut(stride).enumerate() {
            let next = at(first + number + 1);
            words.copy_from_slice(&above);
            above.fill(0);
            mark(&here, &next, [0, 1], bound, [words, &mut above]);
            spare.fill(0);
            let mut left = vec![0; stride];
            mark(&here, &here[1..], [1, 0], bound, [&mut left, &mut spare]);
            let mut carried = 0;
            for (word, (left, right)) in words.iter_mut().zip(left.iter().zip(&spare)) {
                *word |= left | right << 1 | carried;
                carried = right >> 63;
            }
            here = next;
        }
    });
    let rows = (0..anchors.height()).flat_map(|row| {
        let words = anchors.row(row).iter();
        let flags = words.flat_map(|&word| (0..64).map(move |bit| word >> bit & 1 == 1));
        flags.take(width)
    });
    let mut flags: Vec<bool> = rows.collect();
    thin_lines(interior, &mut flags);
    flags
}

/// The vector to the nearest pixel outside; 0 outside.
type Direction = [i32; 2];

/// Computes the directions of the pixels of a row.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "sides are below 2¹⁶"
)]
fn directions(interior: &Interior, row: usize) -> Vec<Direction> {
    let width = interior.map.width();
    let nearest = &interior.map.nearest()[row * width..][..width];
    let directions = nearest.iter().enumerate().map(|(column, &nearest)| {
        let [x, y] = [nearest % width as u32, nearest / width as u32];
        [x as i32 - column as i32, y as i32 - row as i32]
    });
    directions.collect()
}

/// Compares pixels with their neighbours in one direction, and marks of those that differ the one closer to the line
/// between their regions (Hesselink & Roerdink 2008): the first or the second.
fn mark(
    here: &[Direction],
    next: &[Direction],
    step: Direction,
    bound: f64,
    [first, second]: [&mut [u64]; 2],
) {
    for (column, (&one, &other)) in here.iter().zip(next).enumerate() {
        if differ(one, other, bound) {
            let reached = |from: Direction, [x, y]: Direction| square([from[0] + x, from[1] + y]);
            let back = step.map(|it| -it);
            let excess = reached(other, step) - square(one);
            let other_excess = reached(one, back) - square(other);
            let chosen = if excess <= other_excess {
                &mut *first
            } else {
                &mut *second
            };
            chosen[column / 64] |= 1 << (column % 64);
        }
    }
}

/// Returns `true` if neither vector is 0 and the angle between them is at least the one whose squared cosine, with
/// the sign of the cosine, is `bound`; of short vectors, if it is obtuse.
#[inline]
fn differ(one: Direction, other: Direction, bound: f64) -> bool {
    if one == other || one == [0, 0] || other == [0, 0] {
        return false;
    }
    let [x, y] = [0, 1].map(|axis| f64::from(one[axis]) * f64::from(other[axis]));
    let along = x + y;
    let (square, other_square) = (square(one), square(other));
    if square.max(other_square) <= THIN && along >= 0.0 {
        return false;
    }
    along * along.abs() <= bound * square * other_square
}

fn square(vector: Direction) -> f64 {
    let [x, y] = vector.map(f64::from);
    x * x + y * y
}

/// Marks the pixels of lines that are one pixel wide.
fn thin_lines(interior: &Interior, anchors: &mut [bool]) {
    for (index, squared) in interior.pixels() {
        if squared == 1 {
            let sides = interior.neighbours(index);
            anchors[index] |= [0, 2]
                .iter()
                .any(|&side| sides[side] == 0 && sides[side + 4] == 0);
        }
    }
}
