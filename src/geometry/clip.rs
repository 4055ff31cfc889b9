//! Clipping of lines to boxes.

use super::DVec2;

/// Returns the first and the last point of a line that lie in a box, from 0 at `start` to 1 at `start + along`
/// (Liang & Barsky 1984); `None` if the line lies outside.
pub(crate) fn clip(start: DVec2, along: DVec2, low: DVec2, high: DVec2) -> Option<[f64; 2]> {
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let [low, high] = [low, high].map(|edge| edge[axis] - start[axis]);
        if along[axis] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (enters, leaves) = (low / along[axis], high / along[axis]);
        first = first.max(enters.min(leaves));
        last = last.min(enters.max(leaves));
    }
    (first <= last).then_some([first, last])
}
