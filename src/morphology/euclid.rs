//! Erosion and dilation by Euclidean disks, by the first pass of a distance transform and spans of pixels.

use std::num::NonZero;

use crate::bits::Bits;
use crate::parallel::for_each;
use crate::saturating::{real, whole};

use super::distance::{BAND, Columns};

/// Returns the pixels at a distance of at most `radius` from a set; the time does not depend on the radius.
///
/// In each row, the nearest set pixel of a column covers a span of pixels about the column.
pub(super) fn dilated(set: &Bits, radius: f64, threads: NonZero<usize>) -> Bits {
    let (width, height) = (set.width(), set.height());
    let mut dilated = Bits::new(width, height);
    let stride = width.div_ceil(64);
    if stride == 0 {
        return dilated;
    }
    let half = half_widths(radius, height);
    let bands = dilated.words_mut().chunks_mut(BAND * stride).enumerate();
    for_each(bands, threads.get(), |(band, words)| {
        let first = band * BAND;
        let mut nearest = vec![0; words.len() / stride * width];
        Columns::fill(set, first, &mut nearest);
        let rows = words
            .chunks_exact_mut(stride)
            .zip(nearest.chunks_exact(width));
        let mut spans = vec![0; width];
        for (row, (words, nearest)) in rows.enumerate() {
            for (span, &nearest) in spans.iter_mut().zip(nearest) {
                let away = (nearest as usize).abs_diff(first + row);
                *span = half.get(away).copied().unwrap_or_default();
            }
            cover(&spans, words);
        }
    });
    dilated
}

/// Returns the pixels whose distance to every pixel outside a set is more than `radius`.
pub(super) fn eroded(set: &Bits, radius: f64, threads: NonZero<usize>) -> Bits {
    // Pixels around the picture are outside as well.
    let (width, height) = (set.width(), set.height());
    let outside = set.window([-1, -1], width + 2, height + 2).complement();
    let kept = dilated(&outside, radius, threads).complement();
    kept.window([1, 1], width, height)
}

/// Returns the half widths, plus 1, of the rows of a disk by their distance from its centre.
fn half_widths(radius: f64, height: usize) -> Vec<u32> {
    let rows = whole(radius).min(height);
    let half = |row| {
        let row = real(row);
        let half = whole((radius * radius - row * row).max(0.0).sqrt());
        u32::try_from(half.saturating_add(1)).unwrap_or(u32::MAX)
    };
    (0..=rows).map(half).collect()
}

/// Sets the pixels that spans of a half width about their columns cover; a span of 0 covers nothing.
fn cover(spans: &[u32], words: &mut [u64]) {
    let mut reach = 0;
    for (word, spans) in words.iter_mut().zip(spans.chunks(64)) {
        let mut bits = 0;
        for (bit, &span) in spans.iter().enumerate() {
            reach = span.max(reach);
            bits |= u64::from(reach > 0) << bit;
            reach = reach.saturating_sub(1);
        }
        *word = bits;
    }
    reach = 0;
    for (word, spans) in words.iter_mut().zip(spans.chunks(64)).rev() {
        let mut bits = 0;
        for (bit, &span) in spans.iter().enumerate().rev() {
            reach = span.max(reach);
            bits |= u64::from(reach > 0) << bit;
            reach = reach.saturating_sub(1);
        }
        *word |= bits;
    }
}
