//! Pictures of the chaos game in space: the nearest of many points in every pixel.
//!
//! The points fall into a depth buffer of one key a pixel, with the camera, the depths and the colours of the exact
//! descent.

use tiny_skia::Pixmap;

use crate::chaos::{
    DepthPicture, DepthWindow, Game, RandomPoints, Seen, WeightedMaps, play_in_space,
};
use crate::geometry::{DAffine3, DMat3, DVec3, Frame3};
use crate::graph::Graph;
use crate::render::png::TooManyPixels;
use crate::render::{Options, Pixels, RenderError};
use crate::style::{ColorBy, Colour, Style, Tone};

use super::buffer::{CLASS_BITS, EMPTY, MAX_CLASS, SAMPLES, STEPS};
use super::camera::{Placement, Projection};
use super::depth_map::DepthMap;
use super::scene::ClassBy;
use super::shade::{self, Inks, class_colour, colours};
use super::slice::Search;
use super::solid::depth_of;
use super::{SpaceError, SpaceOptions, SpacePicture, described, finish, place, scene, slice};

/// Number of points from which the extent of the ways from given starts is estimated.
const PILOT: usize = 20_000;

/// Plays the chaos game in space and draws its points as pixels in memory. `graph` is that of the system, whose limit
/// set determines the placement and the depths; walks from given starts extend them.
///
/// The classes of the game have to be those of the colours of the style. Colours by hits are placed in the palette by
/// `tone`, for the number of points of a pixel at any depth.
///
/// # Errors
///
/// As for [`write_space`](super::write_space), and if the game cannot be played.
pub fn points_in_space(
    graph: &Graph<Frame3>,
    system: &WeightedMaps<DAffine3>,
    game: &Game<'_, DVec3>,
    tone: Tone,
    options: &Options,
    space: &SpaceOptions,
) -> Result<SpacePicture, RenderError> {
    let (pixmap, depths, placement) = draw(graph, system, game, tone, options, space)?;
    let size = [pixmap.width(), pixmap.height()];
    Ok(SpacePicture {
        pixels: Pixels::of(pixmap),
        sight: placement.sight(space.camera.look_at),
        depths: depths.filter(|_| space.keeps_depths),
        picture: described(size, 0, game.points),
    })
}

/// Returns the colours of points in a style, by the number of the map that counts or of the condensation set after
/// the maps; one colour if they do not differ.
#[must_use]
pub fn colours_of_maps(
    style: &Style,
    graph: &Graph<Frame3>,
    system: &WeightedMaps<DAffine3>,
) -> Vec<Colour> {
    if !matches!(style.color_by, ColorBy::FirstMap | ColorBy::LastMap) {
        return vec![shade::ink(style)];
    }
    let maps = Maps::of(graph, system);
    let colour = |map| class_colour(style, maps.number(map), maps.count + maps.before);
    (0..system.classes()).map(colour).collect()
}

/// Numbers of maps among colours, which begin with condensation sets if there are any, as in the descent.
struct Maps {
    count: usize,
    before: usize,
}

impl Maps {
    fn of(graph: &Graph<Frame3>, system: &WeightedMaps<DAffine3>) -> Self {
        let count = graph.origins();
        Self {
            count,
            before: usize::from(system.classes() > count),
        }
    }

    fn number(&self, map: usize) -> usize {
        if map < self.count {
            map + self.before
        } else {
            0
        }
    }

    /// Returns whether the number of a map that occurs in keys is another one among colours.
    fn changes_numbers(&self) -> bool {
        self.before > 0
    }

    /// Returns a key with the number of its class.
    fn numbered(&self, key: u32) -> u32 {
        let class = self.number((key & u32::from(MAX_CLASS)) as usize);
        let class = u16::try_from(class).unwrap_or(MAX_CLASS).min(MAX_CLASS);
        key >> CLASS_BITS << CLASS_BITS | u32::from(class)
    }
}

/// A picture with the depths of its pixels, if they are needed, and its placement.
type Drawn = (Pixmap, Option<DepthMap>, Placement);

/// Draws the picture into memory.
fn draw(
    graph: &Graph<Frame3>,
    system: &WeightedMaps<DAffine3>,
    game: &Game<'_, DVec3>,
    tone: Tone,
    options: &Options,
    space: &SpaceOptions,
) -> Result<Drawn, RenderError> {
    draw_with(graph, system, game, tone, options, space, SIDE)
}

/// Draws the picture into memory, with at most so many samples along a side of a pixel.
fn draw_with(
    graph: &Graph<Frame3>,
    system: &WeightedMaps<DAffine3>,
    game: &Game<'_, DVec3>,
    tone: Tone,
    options: &Options,
    space: &SpaceOptions,
    most: u32,
) -> Result<Drawn, RenderError> {
    let ways: Vec<DVec3> = match game.start {
        crate::chaos::Start::Attractor => Vec::new(),
        crate::chaos::Start::Points { .. } => {
            let points = RandomPoints::new(system, &game.start, 0).take(PILOT);
            points.map(|point| point.place).collect()
        }
    };
    let search = Search {
        parts: &scene::parts(graph, None),
        start: &scene::start(graph),
        steps: None,
    };
    let placement = place::place_with(
        graph,
        &search,
        &ways,
        &space.camera,
        // A section has the depths of its plane.
        &space.within(0.0),
        options.size,
        options.view.pad(),
    )?;
    let size @ [width, height] = placement.size;
    let mut pixmap = Pixmap::new(width, height).ok_or(TooManyPixels { size })?;
    let style = &options.style;
    let by_hits = style.color_by == ColorBy::Hits;
    let fine = fineness(size, game.points).min(most);
    let mut window = window(&placement, fine);
    #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
    let within = space.within(SAMPLES as f64 / placement.scale());
    let within: Vec<_> = { within.iter() }
        .map(|cut| slice::mapped(cut, &window.to_window))
        .collect();
    window.within = &within;
    let played = play_in_space(system, &window, by_hits, game);
    let picture = played.map_err(SpaceError::from)?;
    let (mut keys, hits) = picture.into_keys_and_hits();
    let inks = if by_hits {
        by_tone(&mut keys, &hits, tone);
        // The colours of as many classes as there are tones.
        colours(style, ClassBy::LastMap, usize::from(MAX_CLASS) + 1)
    } else {
        let class_by = ClassBy::of(style.color_by)?;
        let maps = Maps::of(graph, system);
        if maps.changes_numbers() {
            for key in keys.iter_mut().filter(|key| **key != EMPTY) {
                *key = maps.numbered(*key);
            }
        }
        colours(style, class_by, maps.count + maps.before)
    };
    let inks = Inks::new(&inks, None, space.shade.unwrap_or_default());
    let fine = fine as usize;
    match fine {
        1 => ink::<1>(&mut pixmap, &keys, &inks),
        _ => ink::<{ SIDE as usize }>(&mut pixmap, &keys, &inks),
    }
    // Points have no normals.
    let depths = space.needs_depths(false).then(|| {
        let row = width as usize * fine;
        let pixels = keys.chunks_exact(row * fine).flat_map(|rows| {
            (0..row).step_by(fine).map(move |x| {
                let samples = rows.chunks_exact(row).flat_map(|row| &row[x..x + fine]);
                samples.min().and_then(|key| depth_of(*key))
            })
        });
        DepthMap::of(&placement, pixels)
    });
    finish(&mut pixmap, depths.as_ref(), None, false, options, space)?;
    Ok((pixmap, depths, placement))
}

/// Colours pixels by the keys of `FINE` samples along a side of each.
fn ink<const FINE: usize>(pixmap: &mut Pixmap, keys: &[u32], inks: &Inks) {
    #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
    let samples = (FINE * FINE) as f64;
    let width = pixmap.width() as usize;
    let rows = keys.chunks_exact(width * FINE * FINE);
    for (pixels, rows) in pixmap.pixels_mut().chunks_exact_mut(width).zip(rows) {
        for (x, pixel) in pixels.iter_mut().enumerate() {
            let mut sum = [0.0; 4];
            for row in rows.chunks_exact(width * FINE) {
                for key in &row[x * FINE..(x + 1) * FINE] {
                    let own = inks.sample(*key, None);
                    sum.iter_mut().zip(own).for_each(|(sum, part)| *sum += part);
                }
            }
            // Pixels are transparent until they show something.
            if sum[3] > 0.0 {
                *pixel = shade::premultiplied(sum.map(|part| part / samples));
            }
        }
    }
}

/// Number of points for each sample of a pixel from which pictures are antialiased: with fewer, samples on the set stay
/// empty by chance, and it would fade.
const DENSE: u64 = 16;

/// Number of samples along a side of a pixel of an antialiased picture.
const SIDE: u32 = 2;

/// Returns the number of samples along a side of a pixel.
fn fineness([width, height]: [u32; 2], points: u64) -> u32 {
    let samples = u64::from(SIDE * SIDE) * u64::from(width) * u64::from(height);
    match points / DENSE >= samples {
        true => SIDE,
        false => 1,
    }
}

/// Scale by which a fitted picture lies inside its edges.
const INSIDE: f64 = 1.0 - 1e-6;

/// Returns the window of a placement, in pixels or in `fine` samples along their sides.
fn window(placement: &Placement, fine: u32) -> DepthWindow<'static> {
    const { assert!(CLASS_BITS == DepthPicture::CLASS_BITS && EMPTY == DepthPicture::EMPTY) };
    #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
    let samples = SAMPLES as f64;
    let Placement {
        map,
        projection,
        range,
        size,
    } = *placement;
    let size = size.map(|side| side * fine);
    // Points on the right and lower edges belong to the last pixels.
    let across = INSIDE / samples * f64::from(fine);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number below 2²²"
    )]
    let steps = STEPS as u32;
    match projection {
        Projection::Parallel => {
            let scale = 1.0 / samples;
            let pixels = DVec3::new(across, across, scale);
            let pixels = DAffine3::from_mat3(DMat3::from_diagonal(pixels));
            DepthWindow {
                to_window: pixels * map,
                seen: Seen::Parallel,
                range: range.map(|z| z * scale),
                steps,
                size,
                within: &[],
            }
        }
        Projection::Central { focus, middle } => DepthWindow {
            to_window: map,
            seen: Seen::Central {
                focus: focus * across,
                middle: middle.map(|at| at * across),
            },
            range,
            steps,
            size,
            within: &[],
        },
    }
}

/// Replaces the classes of keys by the tones of the numbers of hits.
fn by_tone(keys: &mut [u32], hits: &[u32], tone: Tone) {
    let most = hits.iter().copied().max().unwrap_or_default().into();
    for (key, hits) in keys.iter_mut().zip(hits) {
        if *hits > 0 {
            let class = tone.of((*hits).into(), most) * f64::from(MAX_CLASS);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a tone lies between 0 and 1"
            )]
            let class = class.round() as u32;
            *key = *key >> CLASS_BITS << CLASS_BITS | class;
        }
    }
}

#[cfg(test)]
mod tests;
