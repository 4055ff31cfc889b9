//! Colours of samples: by class and depth.

use tiny_skia::PremultipliedColorU8;

use crate::style::{Colour, Shade, Style};

use super::buffer::{CLASS_BITS, EMPTY, SAMPLES, STEPS};
use super::lit::{Lit, intensity};
use super::scene::ClassBy;
use super::solid::depth_of;

/// Colour of what has no other: a warm yellow, as in the paper.
const INK: Colour = Colour::of_rgba([255, 214, 120, 255]);

/// Bits of a key that are its class.
const CLASS: u32 = (1 << CLASS_BITS) - 1;

/// Number of samples of a pixel.
#[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
const SAMPLES_A_PIXEL: f64 = (SAMPLES * SAMPLES) as f64;

/// Returns the colour of elements that have no other.
pub(in crate::render) fn ink(style: &Style) -> Colour {
    style.fill.or(style.stroke).unwrap_or(INK)
}

/// Returns the colours of classes in a style, which are `most`.
pub(super) fn colours(style: &Style, by: ClassBy, most: usize) -> Vec<Colour> {
    match by {
        ClassBy::Nothing | ClassBy::Tint => vec![ink(style)],
        _ => (0..most.max(1))
            .map(|class| class_colour(style, class, most))
            .collect(),
    }
}

/// Sets the colours of classes, which are steps, where `lag` of the last of them has not grown yet.
pub(super) fn let_grow(inks: &mut [Colour], style: &Style, steps: u32, lag: f64) {
    if lag == 0.0 || steps as usize >= inks.len() {
        return;
    }
    let last = f64::from(steps) - lag;
    for (step, ink) in (0..=steps).zip(inks) {
        *ink = style.colour_of_value(f64::from(step).min(last), last);
    }
}

/// The colours of classes.
pub(super) struct Inks {
    inks: Vec<[f64; 4]>,
    shade: Shade,
}

impl Inks {
    /// Creates inks of colours; with light on faces, at all levels of its intensity.
    pub(super) fn new(colours: &[Colour], lit: Option<&Lit>, shade: Shade) -> Self {
        let bits = lit.and_then(Lit::bits).unwrap_or(0);
        let levels = |colour: &Colour| {
            let [red, green, blue, alpha] = colour.rgba().map(f64::from);
            (0..1_u16 << bits).map(move |level| {
                let share = match bits {
                    0 => 1.0,
                    bits => intensity(level, bits),
                };
                [red * share, green * share, blue * share, alpha]
            })
        };
        Self {
            inks: colours.iter().flat_map(levels).collect(),
            shade,
        }
    }

    /// Returns the colour of a sample, which is transparent if it shows nothing. `tint` is its colour if it is tinted.
    #[inline]
    pub(super) fn sample(&self, key: u32, tint: Option<&Colour>) -> [f64; 4] {
        let Some(depth) = depth_of(key) else {
            return [0.0; 4];
        };
        let class = (key & CLASS) as usize;
        let ink = match tint {
            Some(colour) => colour.rgba().map(f64::from),
            None => self.inks[class % self.inks.len()],
        };
        let intensity = match self.shade.cues_depth() {
            true => 1.0 - f64::from(depth) / STEPS,
            false => 1.0,
        };
        let share = intensity * ink[3] / 255.0;
        [ink[0] * share, ink[1] * share, ink[2] * share, ink[3]]
    }

    /// Returns the colour of the samples of a pixel together, which is transparent where there are none, and
    /// the nearest key; `rows` are the keys of the rows of samples, and `tints` their colours where they are
    /// tinted.
    pub(super) fn pixel(
        &self,
        rows: [&[u32]; SAMPLES],
        tints: Option<[&[Colour]; SAMPLES]>,
    ) -> ([f64; 4], u32) {
        let nearest = nearest(rows);
        if nearest == EMPTY {
            return ([0.0; 4], EMPTY);
        }
        let of_one_class = { tints.is_none() }.then(|| self.sum_of_one_class(rows));
        let sum = of_one_class.flatten().unwrap_or_else(|| {
            let mut tints = tints.into_iter().flatten().flatten();
            let mut sum = [0.0; 4];
            for key in rows.into_iter().flatten() {
                let own = self.sample(*key, tints.next());
                sum.iter_mut().zip(own).for_each(|(sum, part)| *sum += part);
            }
            sum
        });
        (sum.map(|part| part / SAMPLES_A_PIXEL), nearest)
    }

    /// Returns the sum of the colours of samples that all show something of the same class.
    fn sum_of_one_class(&self, rows: [&[u32]; SAMPLES]) -> Option<[f64; 4]> {
        let (mut most, mut depths, mut any, mut all) = (0, 0, 0, CLASS);
        for row in rows {
            for key in row {
                most = most.max(*key);
                depths += key >> CLASS_BITS;
                any |= key & CLASS;
                all &= key;
            }
        }
        if most == EMPTY || any != all {
            return None;
        }
        let ink = self.inks[any as usize % self.inks.len()];
        let intensity = match self.shade.cues_depth() {
            true => SAMPLES_A_PIXEL - f64::from(depths) / STEPS,
            false => SAMPLES_A_PIXEL,
        };
        let share = intensity * ink[3] / 255.0;
        Some([
            ink[0] * share,
            ink[1] * share,
            ink[2] * share,
            ink[3] * SAMPLES_A_PIXEL,
        ])
    }
}

/// Returns what belongs to the samples of a pixel, in rows, of what belongs to those of a row of pixels.
#[inline]
pub(super) fn samples<T>(rows: [&[T]; SAMPLES], x: usize) -> [&[T]; SAMPLES] {
    rows.map(|row| &row[x * SAMPLES..(x + 1) * SAMPLES])
}

/// Returns the key of the nearest sample.
#[inline]
pub(super) fn nearest(rows: [&[u32]; SAMPLES]) -> u32 {
    let keys = rows.into_iter().flatten();
    keys.fold(EMPTY, |nearest, key| nearest.min(*key))
}

#[expect(clippy::cast_precision_loss, reason = "there are few classes")]
pub(super) fn class_colour(style: &Style, class: usize, most: usize) -> Colour {
    style.colour_of_value(class as f64, most.saturating_sub(1) as f64)
}

/// Rounds a premultiplied colour.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the values are clamped"
)]
pub(super) fn premultiplied(colour: [f64; 4]) -> PremultipliedColorU8 {
    let [red, green, blue, alpha] = colour.map(|value| (value + 0.5).clamp(0.0, 255.0) as u8);
    let [red, green, blue] = [red, green, blue].map(|part| part.min(alpha));
    let colour = PremultipliedColorU8::from_rgba(red, green, blue, alpha);
    colour.unwrap_or(PremultipliedColorU8::TRANSPARENT)
}

/// Returns the parts of a premultiplied colour.
pub(super) fn parts(colour: PremultipliedColorU8) -> [f64; 4] {
    [colour.red(), colour.green(), colour.blue(), colour.alpha()].map(f64::from)
}

/// Returns a colour over a background.
pub(super) fn over(
    background: Option<Colour>,
    colour: PremultipliedColorU8,
) -> PremultipliedColorU8 {
    let Some(background) = background.filter(|_| colour.alpha() < 255) else {
        return colour;
    };
    let [red, green, blue, opacity] = background.rgba().map(f64::from);
    let colour = parts(colour);
    let under = opacity / 255.0 * (1.0 - colour[3] / 255.0);
    let below = [red * under, green * under, blue * under, 255.0 * under];
    premultiplied([0, 1, 2, 3].map(|part: usize| colour[part] + below[part]))
}
