//! Light on faces: the cosine of the angle between a normal and the light (Kaandorp 1987, section 2.4).
//!
//! The intensity of a face is a part of the class of its samples: a level of few, as many as there are classes beside the
//! colours, or, where colours are many, a colour of its own in the tile.

use crate::geometry::DVec3;
use crate::style::{Camera, CameraError, Colour, Light};

use super::buffer::MAX_CLASS;
use super::solid::whole;

/// Least number of bits of levels of intensity that are parts of classes, and that of stamps.
pub(super) const LEAST: u32 = 7;

/// Bits of the levels of intensity of colours that are classes of a tile.
pub(super) const FINE: u32 = 8;

/// Light on faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lit {
    /// Unit vector towards the light, in the coordinates of the projection.
    towards: DVec3,
    /// Unit vector upwards.
    up: DVec3,
    light: Light,
    /// Low bits of classes that are levels; `None` if colours are found tile by tile.
    bits: Option<u32>,
}

impl Lit {
    /// Returns the light in a view. `colours` is their number; `None` if it is not known.
    pub(super) fn new(
        camera: &Camera,
        light: Light,
        colours: Option<usize>,
    ) -> Result<Self, CameraError> {
        let flip = DVec3::new(1.0, -1.0, 1.0);
        let levels = colours.map(|colours| (usize::from(MAX_CLASS) + 1) / colours.max(1));
        let bits = levels.and_then(usize::checked_ilog2);
        let rotation = camera.rotation()?;
        Ok(Self {
            towards: rotation * light.towards() * flip,
            up: rotation.y_axis * flip,
            light,
            bits: bits.filter(|bits| *bits >= LEAST),
        })
    }

    /// Returns the number of the low bits of classes that are levels; `None` if colours are found tile by tile.
    pub(super) fn bits(&self) -> Option<u32> {
        self.bits
    }

    /// Returns the level of a face, of as many as there are with a number of bits: 0 is the brightest. The normal may have
    /// any length.
    pub(super) fn level(&self, normal: DVec3, bits: u32) -> u16 {
        self.level_of_cosine(normal.normalize_or_zero().dot(self.towards), bits)
    }

    /// Returns the level of a face by the cosine of the angle between its normal and the light.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "there are few levels")]
    pub(super) fn level_of_cosine(&self, cosine: f64, bits: u32) -> u16 {
        let dark = 1.0 - self.light.intensity(cosine);
        whole(dark * f64::from((1_u32 << bits) - 1) + 0.5) as u16
    }

    /// Returns the unit vector towards the light.
    pub(super) fn towards(&self) -> DVec3 {
        self.towards
    }

    /// Returns the colour of a face, of as many as colours run from downwards to upwards.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "there are few colours"
    )]
    pub(super) fn colour_of_normal(&self, normal: DVec3, colours: &[Colour]) -> Colour {
        let share = f64::midpoint(normal.normalize_or_zero().dot(self.up), 1.0);
        let last = colours.len() - 1;
        colours[((share * last as f64).round() as usize).min(last)]
    }
}

/// Returns the intensity of a level.
pub(super) fn intensity(level: u16, bits: u32) -> f64 {
    1.0 - f64::from(level) / f64::from((1_u32 << bits) - 1)
}

/// Class of the samples of a solid.
pub(super) enum Classes<'a> {
    /// All faces have the same.
    One(u16),
    /// A face has that of its level of intensity.
    OfLevels {
        lit: &'a Lit,
        /// Number of bits of a level.
        bits: u32,
        of: &'a mut dyn FnMut(u16) -> u16,
    },
    /// A face has that of its normal.
    OfNormals(&'a mut dyn FnMut(DVec3) -> u16),
}

impl Classes<'_> {
    /// Returns the class of a face of a normal.
    pub(super) fn of(&mut self, normal: DVec3) -> u16 {
        match self {
            Self::One(class) => *class,
            Self::OfLevels { lit, bits, of } => of(lit.level(normal, *bits)),
            Self::OfNormals(of) => of(normal),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::num::NonZero;

    use tiny_skia::Pixmap;

    use crate::geometry::{DVec3, Frame3};
    use crate::graph::Graph;
    use crate::render::space::tests::{graph_of, sponge};
    use crate::render::space::{SpaceOptions, draw};
    use crate::render::{Options, Size};
    use crate::style::{Camera, ColorBy, Colour, Light, Palette, Shade};

    fn lit(graph: &Graph<Frame3>, steps: u32, side: u32, change: impl Fn(&mut Options)) -> Pixmap {
        let mut options = Options::default().size(Size::Long(side));
        options.style.fill = Some(Colour::grey(255));
        options.style.background = Some(Colour::of_rgba([0, 0, 255, 255]));
        change(&mut options);
        let space = SpaceOptions::default()
            .camera(Camera::default().from(Camera::NAMED[3].1))
            .light(light())
            .shade(Some(Shade::Cosine));
        draw(graph, Some(steps), &options, &space, None)
            .unwrap()
            .pixmap
    }

    fn light() -> Light {
        Light::default().from([20.0, 50.0]).ambient(0.0)
    }

    fn scene(what: &str) -> Graph<Frame3> {
        graph_of(&format!(
            "{{kind: instancing, space: 3, objects: {{a: [{what}]}}, scene: [a]}}"
        ))
    }

    #[test]
    fn a_cube_has_three_intensities() {
        for what in ["{box: {}}", "{solid: cube}"] {
            let seen = lit(&scene(what), 1, 120, |_| {});
            let mut counts: BTreeMap<[u8; 3], usize> = BTreeMap::new();
            for pixel in seen.pixels() {
                *counts
                    .entry([pixel.red(), pixel.green(), pixel.blue()])
                    .or_default() += 1;
            }
            let mut most: Vec<_> = counts.into_iter().collect();
            most.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
            // The three faces are equally large, and the paper is a quarter.
            let mut found: Vec<u8> = most[..4].iter().map(|(colour, _)| colour[0]).collect();
            assert!(most[..4].iter().all(|(_, count)| *count > 2000), "{most:?}");
            assert!(most[4].1 < 200, "{most:?}");
            found.sort_unstable();
            let [x, y, z] = light().towards().to_array();
            let expected = [0.0, x, z, y].map(|cosine| 255.0 * cosine);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!(
                    (f64::from(found) - expected).abs() < 0.7,
                    "{found} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_ball_has_the_cosines_of_its_normals() {
        let seen = lit(&scene("{sphere: {}}"), 1, 201, |_| {});
        let rotation = Camera::default()
            .from(Camera::NAMED[3].1)
            .rotation()
            .unwrap();
        let towards = rotation * light().towards();
        for (at, pixel) in (0_u32..).zip(seen.pixels()) {
            let [x, y] = [at % 201, at / 201].map(|at| (f64::from(at) - 100.0) / 100.5);
            let square = x * x + y * y;
            if square < 0.9 {
                let normal = DVec3::new(x, -y, (1.0 - square).sqrt());
                let expected = 255.0 * normal.dot(towards).max(0.0);
                assert!((f64::from(pixel.red()) - expected).abs() < 2.0, "{x} {y}");
            }
        }
    }

    /// As many colours as maps leave no room for levels in classes, and are found tile by tile.
    #[test]
    fn colours_of_tiles_and_levels_of_classes_agree() {
        let graph = sponge();
        let colours = |color_by| {
            move |options: &mut Options| {
                options.style.color_by = color_by;
                options.style.palette = Palette::of_colours("", &[Colour::grey(255)]);
            }
        };
        let [levels, tiles] =
            [ColorBy::None, ColorBy::LastMap].map(|by| lit(&graph, 2, 300, colours(by)));
        for (a, b) in levels.pixels().iter().zip(tiles.pixels()) {
            assert!(a.red().abs_diff(b.red()) <= 1, "{a:?} {b:?}");
        }
        // Small elements are stamps, which are a little larger.
        let [levels, tiles] =
            [ColorBy::None, ColorBy::LastMap].map(|by| lit(&graph, 4, 300, colours(by)));
        let pairs = levels.pixels().iter().zip(tiles.pixels());
        let other = pairs
            .filter(|(a, b)| a.red().abs_diff(b.red()) > 24)
            .count();
        assert!(other * 50 < levels.pixels().len(), "{other}");
    }

    #[test]
    fn threads_change_no_byte() {
        let tree = scene("{sphere: {}}, {cone: {}, translate: [1, 0, 0], tint: {color: red}}");
        for (graph, color_by) in [(&sponge(), ColorBy::LastMap), (&tree, ColorBy::Tint)] {
            let [one, more] = [1, 3].map(|threads| {
                lit(graph, 3, 200, |options| {
                    options.threads = NonZero::new(threads).unwrap();
                    options.style.color_by = color_by;
                })
            });
            assert!(one == more);
        }
    }
}
