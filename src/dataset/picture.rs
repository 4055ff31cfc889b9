//! Pictures of a data set: from hits to levels, patterns, flips and colours.

use crate::document::Mode;
use crate::draws::Path;
use crate::render::{Levels, Pixels};
use crate::style::{Palette, Tone};

use super::random::{below, uniform};

/// Colours of the pictures of a data set.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Colouring {
    /// Grey levels on black.
    #[default]
    Grey,
    /// Hues on black: the level as a hue, from a reference hue; saturation from 0.3 to 1 and value from 0.5 to 1. All three are
    /// drawn for the picture (Anderson & Farrell 2022).
    Hsv,
    /// Position in a palette, given by the level, on black.
    Palette(Palette),
}

/// Levels of a square picture, from which it is made.
pub(super) struct Plain {
    size: u32,
    levels: Vec<u8>,
}

impl Plain {
    /// Returns the levels of points that were counted in the pixels of a square.
    pub(super) fn of_hits(hits: &[u32], size: u32, mode: Mode) -> Self {
        let levels = match mode {
            Mode::Hits => Levels::of_counts(hits, [size; 2], Tone::Log).into_bytes(),
            Mode::Binary | Mode::Patch3 => {
                let levels = hits.iter().map(|&hits| if hits > 0 { 255 } else { 0 });
                levels.collect()
            }
        };
        Self { size, levels }
    }

    /// Returns the opacities of a drawing.
    pub(super) fn of_pixels(pixels: &Pixels, mode: Mode) -> Self {
        let opacities = pixels.premultiplied().chunks_exact(4).map(|pixel| pixel[3]);
        let levels = match mode {
            Mode::Hits => opacities.collect(),
            Mode::Binary | Mode::Patch3 => opacities
                .map(|opacity| if opacity >= 128 { 255 } else { 0 })
                .collect(),
        };
        let [size, _] = pixels.size();
        Self { size, levels }
    }

    /// Puts a pattern of 3 × 3 pixels, of which at least one is set, in place of every pixel that is set. The pattern is
    /// drawn for the picture.
    pub(super) fn patterned(self, path: Path) -> Self {
        let pattern = 1 + below(&mut path.random("pattern"), 511);
        let side = self.size as usize;
        let mut levels = vec![0; self.levels.len()];
        for bit in (0..9).filter(|bit| pattern >> bit & 1 == 1) {
            let (down, right) = (bit / 3, bit % 3);
            // Rows and columns are moved by −1, 0 or 1.
            for row in 0..side {
                let Some(to) = (row + down).checked_sub(1).filter(|to| *to < side) else {
                    continue;
                };
                let from = &self.levels[row * side..(row + 1) * side];
                let to = &mut levels[to * side..(to + 1) * side];
                let (to, from) = match right {
                    0 => (&mut to[..side - 1], &from[1..]),
                    1 => (to, from),
                    _ => (&mut to[1..], &from[..side - 1]),
                };
                for (to, from) in to.iter_mut().zip(from) {
                    *to |= from;
                }
            }
        }
        Self { levels, ..self }
    }

    /// Flips the picture: 1 from top to bottom, 2 from left to right, 3 both.
    pub(super) fn flipped(mut self, flip: u8) -> Self {
        let side = self.size as usize;
        if flip & 2 != 0 {
            self.levels.chunks_exact_mut(side).for_each(<[u8]>::reverse);
        }
        if flip & 1 != 0 {
            let rows = self.levels.chunks_exact(side).rev();
            self.levels = rows.flatten().copied().collect();
        }
        self
    }

    /// Colours the picture.
    pub(super) fn coloured(self, colouring: &Colouring, path: Path) -> Option<Levels> {
        let size = [self.size; 2];
        let colours = match colouring {
            Colouring::Grey => return Levels::grey(size, self.levels),
            Colouring::Hsv => hues(path),
            Colouring::Palette(palette) => shades(palette),
        };
        let colours = self
            .levels
            .iter()
            .flat_map(|&level| colours[usize::from(level)]);
        Levels::rgb(size, colours.collect())
    }
}

/// Returns the colours of levels as hues.
fn hues(path: Path) -> Vec<[u8; 3]> {
    let mut random = path.random("hues");
    let reference = random.unit();
    let saturation = uniform(&mut random, 0.3, 1.0);
    let value = uniform(&mut random, 0.5, 1.0);
    let colour = |level: u32| match level {
        0 => [0; 3],
        level => {
            let hue = (f64::from(level) / 256.0 + reference).fract() * 6.0;
            // Each channel is full within one sixth of the circle of its own hue, and falls over the next.
            [0.0, 4.0, 2.0].map(|shift: f64| {
                let apart = ((hue + shift).rem_euclid(6.0) - 3.0).abs() - 1.0;
                let full = apart.clamp(0.0, 1.0);
                byte(value * (1.0 - saturation * (1.0 - full)))
            })
        }
    };
    (0..256).map(colour).collect()
}

/// Returns the colours of levels in a palette.
fn shades(palette: &Palette) -> Vec<[u8; 3]> {
    let colour = |level: u32| match level {
        0 => [0; 3],
        level => {
            let [red, green, blue, _] = palette.at(f64::from(level) / 255.0).rgba();
            [red, green, blue]
        }
    };
    (0..256).map(colour).collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
fn byte(value: f64) -> u8 {
    (value * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(levels: &[u8]) -> Plain {
        Plain {
            size: 3,
            levels: levels.to_vec(),
        }
    }

    #[test]
    fn flips_are_those_of_a_rectangle() {
        let picture = || plain(&[1, 2, 3, 4, 5, 6, 7, 8, 9]);
        assert_eq!(picture().flipped(1).levels, [7, 8, 9, 4, 5, 6, 1, 2, 3]);
        assert_eq!(picture().flipped(2).levels, [3, 2, 1, 6, 5, 4, 9, 8, 7]);
        assert_eq!(picture().flipped(3).levels, [9, 8, 7, 6, 5, 4, 3, 2, 1]);
    }

    #[test]
    fn patterns_are_put_around_pixels() {
        let middle = plain(&[0, 0, 0, 0, 255, 0, 0, 0, 0]);
        let corner = plain(&[255, 0, 0, 0, 0, 0, 0, 0, 0]);
        let mut seen = std::collections::BTreeSet::new();
        for seed in 0..40 {
            let path = Path::of_seed(seed);
            let pattern = Plain {
                levels: middle.levels.clone(),
                size: 3,
            }
            .patterned(path)
            .levels;
            assert!(pattern.contains(&255));
            // About a corner, the part of the pattern that lies inside remains.
            let moved = Plain {
                levels: corner.levels.clone(),
                size: 3,
            }
            .patterned(path)
            .levels;
            for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                assert_eq!(moved[3 * row + column], pattern[3 * (row + 1) + column + 1]);
            }
            assert_eq!(moved[2], 0);
            seen.insert(pattern);
        }
        assert!(seen.len() > 30);
    }

    #[test]
    fn hues_keep_the_background() {
        let colours = hues(Path::of_seed(1));
        assert_eq!(colours[0], [0; 3]);
        let most = |colour: &[u8; 3]| *colour.iter().max().unwrap();
        let value = most(&colours[1]);
        assert!(value >= 127);
        assert!(colours[1..].iter().all(|colour| most(colour) == value));
        // The hues of all levels go around the circle once: each channel is the largest in a third of them.
        for channel in 0..3 {
            let largest = colours[1..]
                .iter()
                .filter(|it| it[channel] == most(it))
                .count();
            assert!((80..=95).contains(&largest), "{largest}");
        }
    }
}
