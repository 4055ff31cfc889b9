//! Gradients of Ultra Fractal.

use super::{PaletteError, check, lines, sampled, some, wrong};
use crate::style::Colour;

/// Number of places of a gradient, after which it begins again.
const PLACES: i64 = 400;

/// Reads the colours of the first gradient of a file.
pub(super) fn read(text: &str) -> Result<Vec<Colour>, PaletteError> {
    let mut stops: Vec<(f64, [f64; 3])> = Vec::new();
    let mut is_in_gradient = true;
    for (number, line) in lines(text) {
        if line == "}" && !stops.is_empty() {
            break;
        }
        if line.ends_with(':') {
            is_in_gradient = line == "gradient:";
        }
        let value = |key: &str| {
            let words = line.split_whitespace();
            let mut values = words.filter_map(|word| word.strip_prefix(key)?.strip_prefix('='));
            values.next()
        };
        let Some(index) = value("index").filter(|_| is_in_gradient) else {
            continue;
        };
        let index = index.parse::<i64>();
        let colour = value("color").and_then(|colour| colour.parse::<u32>().ok());
        let (Ok(index), Some(colour)) = (index, colour) else {
            let message = "expected a colour at an index, as in 'index=12 color=3943466'";
            return Err(wrong(number, message));
        };
        let [red, green, blue, _] = colour.to_le_bytes();
        #[expect(clippy::cast_precision_loss, reason = "there are few places")]
        let place = index.rem_euclid(PLACES) as f64;
        stops.push((place, [red, green, blue].map(f64::from)));
        check(number, stops.len())?;
    }
    let mut stops = some(stops)?;
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The gradient begins and ends between its last and its first stop.
    #[expect(clippy::cast_precision_loss, reason = "there are few places")]
    let all = PLACES as f64;
    let (first, last) = (stops[0], stops[stops.len() - 1]);
    let gap = first.0 + all - last.0;
    let share = (all - last.0) / gap;
    let seam = [0, 1, 2].map(|axis| last.1[axis] + (first.1[axis] - last.1[axis]) * share);
    stops.insert(0, (0.0, seam));
    stops.push((all, seam));
    Ok(sampled(&stops))
}
