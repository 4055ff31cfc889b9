//! Colours of samples: by class and depth.

use tiny_skia::PremultipliedColorU8;

use crate::style::{Colour, Named, Palette, Style};

use super::buffer::{EMPTY, SAMPLES, STEPS};
use super::camera::direction;
use super::scene::ClassBy;
use super::solid::depth_of;
use crate::geometry::DVec3;

/// Shading of sets in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Shade {
    /// Depth cueing (Jones & Campa 1992): the intensity falls linearly from the nearest point of the set to its
    /// farthest.
    #[default]
    Depth,
    /// The cosine of the angle between the light and normals that are taken from neighbouring depths.
    Relief,
    /// Depth cueing, times relief.
    Both,
    /// None: colours alone.
    None,
}

impl Named for Shade {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("depth", Self::Depth),
        ("relief", Self::Relief),
        ("both", Self::Both),
        ("none", Self::None),
    ];
}

/// Light for relief.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Light {
    /// Azimuth and elevation of the light, in degrees; 0 and 45 by default.
    pub from: [f64; 2],
    /// Intensity of what the light does not reach, from 0 to 1; 0.15 by default.
    pub ambient: f64,
}

setters!(Light {
    from: [f64; 2],
    ambient: f64,
});

impl Default for Light {
    fn default() -> Self {
        Self {
            from: [0.0, 45.0],
            ambient: 0.15,
        }
    }
}

impl Light {
    /// Returns the unit vector towards the light.
    pub(super) fn towards(&self) -> DVec3 {
        direction(self.from)
    }

    /// Returns the intensity on a surface: `cosine` is that of the angle between its normal and the light.
    pub(super) fn intensity(&self, cosine: f64) -> f64 {
        let ambient = self.ambient.clamp(0.0, 1.0);
        ambient + (1.0 - ambient) * cosine.max(0.0)
    }
}

impl Shade {
    /// Returns whether the picture has depth cues.
    pub(super) fn cues_depth(self) -> bool {
        matches!(self, Self::Depth | Self::Both)
    }

    /// Returns whether the picture needs normals.
    pub(super) fn has_relief(self) -> bool {
        matches!(self, Self::Relief | Self::Both)
    }
}

/// Colour of what has no other: a warm yellow, as in the paper.
const INK: Colour = Colour::of_rgba([255, 214, 120, 255]);

/// Returns the colour of elements that have no other.
pub(in crate::render) fn ink(style: &Style) -> Colour {
    style.fill.or(style.stroke).unwrap_or(INK)
}

/// The colours of classes.
pub(super) struct Inks {
    inks: Vec<[f64; 4]>,
    shade: Shade,
}

impl Inks {
    /// Returns the colours of a style. `most` is the number of classes.
    pub(super) fn of(style: &Style, by: ClassBy, most: usize, shade: Shade) -> Self {
        let colours: Vec<Colour> = match by {
            ClassBy::Nothing | ClassBy::Tint => vec![ink(style)],
            _ => (0..most.max(1))
                .map(|class| class_colour(&style.palette, class, most))
                .collect(),
        };
        Self {
            inks: colours
                .iter()
                .map(|colour| colour.rgba().map(f64::from))
                .collect(),
            shade,
        }
    }

    /// Returns the colour of a sample, which is transparent if it shows nothing. `tint` is its colour if it is tinted.
    #[inline]
    pub(super) fn sample(&self, key: u32, tint: Option<&Colour>) -> [f64; 4] {
        let Some(depth) = depth_of(key) else {
            return [0.0; 4];
        };
        let class = (key & ((1 << super::buffer::CLASS_BITS) - 1)) as usize;
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
    /// the least depth; `rows` are the keys of the rows of samples, and `tints` their colours where they are
    /// tinted.
    pub(super) fn pixel(
        &self,
        rows: [&[u32]; SAMPLES],
        tints: Option<[&[Colour]; SAMPLES]>,
    ) -> ([f64; 4], Option<u32>) {
        let mut sum = [0.0; 4];
        let mut nearest = EMPTY;
        let mut tints = tints.into_iter().flatten().flatten();
        for key in rows.into_iter().flatten() {
            let tint = tints.next();
            if *key == EMPTY {
                continue;
            }
            nearest = nearest.min(*key);
            let own = self.sample(*key, tint);
            sum.iter_mut().zip(own).for_each(|(sum, part)| *sum += part);
        }
        #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
        let all = (SAMPLES * SAMPLES) as f64;
        (sum.map(|part| part / all), depth_of(nearest))
    }
}

#[expect(clippy::cast_precision_loss, reason = "there are few classes")]
pub(super) fn class_colour(palette: &Palette, class: usize, most: usize) -> Colour {
    let last = most.saturating_sub(1).max(1);
    palette.at(class as f64 / last as f64)
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
