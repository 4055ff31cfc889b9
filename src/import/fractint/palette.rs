//! Default palette of Fractint.

use crate::style::Colour;

/// The number of colours.
pub(super) const COLOURS: i64 = 256;

/// Index of the initial colour: white, on black.
pub(super) const FIRST: i64 = 15;

/// Levels of a colour component in 63rds, from the least to the greatest in quarters, for every group of 24
/// hues after the greys.
const GROUPS: [[u8; 5]; 9] = [
    [0, 16, 31, 47, 63],
    [31, 39, 47, 55, 63],
    [45, 49, 54, 58, 63],
    [0, 7, 14, 21, 28],
    [14, 17, 21, 24, 28],
    [20, 22, 24, 26, 28],
    [0, 4, 8, 12, 16],
    [8, 10, 12, 14, 16],
    [11, 12, 13, 15, 16],
];

const GREYS: [u8; 16] = [0, 5, 8, 11, 14, 17, 20, 24, 28, 32, 36, 40, 45, 50, 56, 63];

/// Returns a colour of the VGA's default palette of 256; indices wrap around. The palette consists of the 16
/// colours of the EGA, 16 greys, nine rings of 24 hues from blue over red and green, and black.
pub(super) fn vga(number: i64) -> Colour {
    let number = usize::try_from(number.rem_euclid(COLOURS)).unwrap_or(0);
    let parts = match number {
        0..16 => ega(number),
        16..32 => [GREYS[number - 16]; 3],
        32..248 => hue(GROUPS[(number - 32) / 24], (number - 32) % 24),
        _ => [0; 3],
    };
    // Six bits become eight.
    let [red, green, blue] = parts.map(|part| part << 2 | part >> 4);
    Colour::of_rgba([red, green, blue, 255])
}

/// Returns a colour of the EGA: one bit for each of red, green and blue, and one for all of them; dark yellow
/// is brown.
fn ega(number: usize) -> [u8; 3] {
    let part = |bit: usize| 42 * u8::from(number & bit != 0) + 21 * u8::from(number & 8 != 0);
    let [red, green, blue] = [4, 2, 1].map(part);
    [red, if number == 6 { 21 } else { green }, blue]
}

/// Returns a hue of a ring: one component after another rises or falls in four steps.
fn hue(levels: [u8; 5], number: usize) -> [u8; 3] {
    let level = |at: usize| levels[at];
    let (step, [least, _, _, _, most]) = (number % 4, levels);
    match number / 4 {
        0 => [level(step), least, most],
        1 => [most, least, level(4 - step)],
        2 => [most, level(step), least],
        3 => [level(4 - step), most, least],
        4 => [least, most, level(step)],
        _ => [least, level(4 - step), most],
    }
}

#[cfg(test)]
mod tests {
    use super::vga;

    #[test]
    fn the_palette_is_that_of_the_vga() {
        for (number, colour) in [
            (0, "#000000"),
            (1, "#0000aa"),
            (6, "#aa5500"),
            (7, "#aaaaaa"),
            (8, "#555555"),
            (14, "#ffff55"),
            (15, "#ffffff"),
            (17, "#141414"),
            (31, "#ffffff"),
            (32, "#0000ff"),
            (33, "#4100ff"),
            (36, "#ff00ff"),
            (40, "#ff0000"),
            (44, "#ffff00"),
            (48, "#00ff00"),
            (52, "#00ffff"),
            (55, "#0041ff"),
            (104, "#000071"),
            (247, "#2c3041"),
            (255, "#000000"),
            (256, "#000000"),
            (-1, "#000000"),
            (271, "#ffffff"),
        ] {
            assert_eq!(vga(number).to_string(), colour, "{number}");
        }
    }
}
