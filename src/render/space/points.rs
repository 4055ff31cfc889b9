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
    let (pixmap, depths) = draw(graph, system, game, tone, options, space)?;
    let size = [pixmap.width(), pixmap.height()];
    Ok(SpacePicture {
        pixels: Pixels::of(pixmap),
        sight: depths.placement().sight(space.camera.look_at),
        depths: Some(depths).filter(|_| space.keeps_depths),
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

/// Draws the picture into memory.
fn draw(
    graph: &Graph<Frame3>,
    system: &WeightedMaps<DAffine3>,
    game: &Game<'_, DVec3>,
    tone: Tone,
    options: &Options,
    space: &SpaceOptions,
) -> Result<(Pixmap, DepthMap), RenderError> {
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
) -> Result<(Pixmap, DepthMap), RenderError> {
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
    // The samples of a pixel.
    let all = &keys;
    let samples = |at: usize| {
        let (fine, width) = (fine as usize, width as usize);
        let (x, y) = (at % width * fine, at / width * fine);
        let row = width * fine;
        let rows = (y..y + fine).map(move |y| y * row + x);
        rows.flat_map(move |start| &all[start..start + fine])
    };
    for (at, pixel) in pixmap.pixels_mut().iter_mut().enumerate() {
        let mut sum = [0.0; 4];
        for key in samples(at).filter(|key| **key != EMPTY) {
            let own = inks.sample(*key, None);
            sum.iter_mut().zip(own).for_each(|(sum, part)| *sum += part);
        }
        // Pixels are transparent until they show something.
        if sum[3] > 0.0 {
            *pixel = shade::premultiplied(sum.map(|part| part / f64::from(fine * fine)));
        }
    }
    let pixels = width as usize * height as usize;
    let nearest = (0..pixels).map(|at| samples(at).min().and_then(|key| depth_of(*key)));
    let depths = DepthMap::of(&placement, nearest);
    // Points have no normals.
    finish(&mut pixmap, Some(&depths), None, false, options, space)?;
    Ok((pixmap, depths))
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
mod tests {
    use std::num::NonZero;

    use super::*;
    use crate::catalogue::Catalogue;
    use crate::chaos::{ClassBy as Classes, Start};
    use crate::diagnostic::Source;
    use crate::document::Document;
    use crate::geometry::HalfSpace;
    use crate::model::Model;
    use crate::render::Size;
    use crate::render::space::{Camera, Shade, pixels_in_space};
    use crate::style::Colour;

    const FERN: &str = "{kind: ifs, space: 3, maps: [
        {matrix: [[0, 0, 0], [0, 0.18, 0], [0, 0, 0]], weight: 1},
        {matrix: [[0.85, 0, 0], [0, 0.85, 0.1], [0, -0.1, 0.85]], translate: [0, 1.6, 0], weight: 85},
        {matrix: [[0.2, -0.2, 0], [0.2, 0.2, 0], [0, 0, 0.3]], translate: [0, 0.8, 0], weight: 7},
        {matrix: [[-0.2, 0.2, 0], [0.2, 0.2, 0], [0, 0, 0.3]], translate: [0, 0.8, 0], weight: 7}]}";
    const TETRAHEDRON: &str = "{kind: ifs, space: 3, vertices: {solid: tetrahedron, shrink: 1/2}}";
    /// Cubes in a row, larger and larger, none of which touches the next.
    const RECURRENT: &str = "{kind: ifs, space: 3, vertices: {solid: cube, shrink: 0.4}}";

    fn of(text: &str) -> (Graph<Frame3>, WeightedMaps<DAffine3>) {
        let source = Source::new("test", text.to_owned());
        let document = Document::read(&source, &Catalogue::embedded()).unwrap();
        let model = document.resolve(&[]).unwrap().0;
        let graph = model.compile_in_space(false).unwrap();
        let Model::IfsInSpace(system) = model else {
            panic!("not in space");
        };
        (graph, WeightedMaps::of(system.ifs()).unwrap())
    }

    fn options(side: u32, color_by: ColorBy) -> Options {
        let mut options = Options::default().size(Size::Long(side));
        options.style.background = Some(Colour::BLACK);
        options.style.fill = Some(Colour::grey(255));
        options.style.color_by = color_by;
        options.view.margin = None;
        options
    }

    /// Depth as brightness: a point is drawn where the descent draws, and at its depth.
    #[test]
    fn points_are_drawn_where_the_descent_draws() {
        const SIDE: u32 = 64;
        /// Size of the exact picture, whose pixels are means, relative to that of points.
        const FINE: usize = 8;
        let cut = |y: f64| HalfSpace {
            normal: DVec3::new(0.2, 1.0, 0.4),
            distance: y,
        };
        for (text, covered, cut) in [
            (TETRAHEDRON, 0.97, cut(0.3)),
            (RECURRENT, 0.97, cut(0.3)),
            (FERN, 0.8, cut(6.0)),
        ] {
            let (graph, system) = of(text);
            for (perspective, cuts) in [
                (None, vec![]),
                (Some(50.0), vec![]),
                (None, vec![cut]),
                (Some(50.0), vec![cut]),
            ] {
                let coarse = options(SIDE, ColorBy::None);
                let camera = Camera::default().perspective(perspective);
                let space = SpaceOptions::default().camera(camera).cuts(cuts.clone());
                let game = Game::default().points(400_000);
                let points = draw_with(&graph, &system, &game, Tone::Log, &coarse, &space, 1);
                let points = points.unwrap().0;
                let fine = options(SIDE * 8, ColorBy::None);
                let pixels_of = |space: &SpaceOptions| {
                    let drawn = pixels_in_space(&graph, None, &fine, space, None);
                    drawn.unwrap().pixels
                };
                let descent = pixels_of(&space);
                // White ink on black: the share of a pixel that is covered.
                let cover = pixels_of(&space.clone().shade(Some(Shade::None)));
                let (width, height) = (points.width() as usize, points.height() as usize);
                let [columns, rows] = descent.size().map(|side| side as usize);
                // Greatest brightness within a pixel, of the part that is covered.
                let exact = |x: usize, y: usize| {
                    let near = (FINE * y..(FINE * (y + 1)).min(rows)).flat_map(|y| {
                        (FINE * x..(FINE * (x + 1)).min(columns))
                            .map(move |x| 4 * (y * columns + x))
                    });
                    let bright = near.map(|at| {
                        let [own, cover] =
                            [&descent, &cover].map(|it| i32::from(it.premultiplied()[at]));
                        own * 255 / cover.max(1)
                    });
                    bright.max().unwrap_or(0)
                };
                let (mut ink, mut hits, mut far) = (0, 0, 0);
                for (at, pixel) in points.pixels().iter().enumerate() {
                    let (x, y) = (at % width, at / width);
                    let own = exact(x, y);
                    ink += u32::from(own > 24);
                    if pixel.red() == 0 {
                        continue;
                    }
                    let columns = x.saturating_sub(1)..(x + 2).min(width);
                    let near = columns.flat_map(|x| {
                        (y.saturating_sub(1)..(y + 2).min(height)).map(move |y| exact(x, y))
                    });
                    let most = near.max().unwrap();
                    // Two pixels in depth; nothing is nearer than the exact picture has it.
                    let pixels = 2 * 255 / i32::try_from(SIDE).unwrap();
                    let seen = i32::from(pixel.red());
                    assert!(
                        most > 0 && seen <= most + pixels,
                        "{text} {x} {y}: {seen} {most}"
                    );
                    hits += u32::from(own > 24);
                    far += u32::from(own > 24 && seen < own - 2 * pixels);
                }
                let share = f64::from(hits) / f64::from(ink);
                assert!(
                    ink > 500 && share > covered - 0.02 * cuts.len() as f64,
                    "{text} {perspective:?} {cuts:?}: {ink} {share}"
                );
                assert!(
                    f64::from(far) < 0.05 * f64::from(ink),
                    "{text} {cuts:?}: {far} of {ink}"
                );
            }
        }
    }

    #[test]
    fn threads_do_not_change_a_picture() {
        let (graph, system) = of(FERN);
        for (color_by, classes) in [
            (ColorBy::LastMap, Classes::Map { ago: 0 }),
            (ColorBy::FirstMap, Classes::Map { ago: 5 }),
            (ColorBy::Hits, Classes::One),
        ] {
            let mut options = options(48, color_by);
            options.style.palette = crate::style::Palette::default();
            let drawn = [1, 3].map(|threads| {
                let game = Game::default()
                    .points(3_000_000)
                    .classes(classes)
                    .threads(NonZero::new(threads).unwrap());
                let space = SpaceOptions::default();
                let drawn = draw(&graph, &system, &game, Tone::Log, &options, &space);
                drawn.unwrap().0
            });
            assert!(drawn[0] == drawn[1]);
        }
    }

    #[test]
    fn ways_from_starts_are_in_the_picture() {
        let (graph, system) = of(TETRAHEDRON);
        let start = Start::Points {
            points: vec![DVec3::new(9.0, 0.0, 0.0)],
            steps: NonZero::new(8).unwrap(),
        };
        let game = Game::default().points(200_000).start(start);
        let space = SpaceOptions::default().camera(Camera::default().from([0.0, 0.0]));
        let drawn = draw(
            &graph,
            &system,
            &game,
            Tone::Log,
            &options(64, ColorBy::None),
            &space,
        );
        let drawn = drawn.unwrap().0;
        // The first step leads to x = (9 ± 1)/2, and the set reaches from −1 to 1: 6 wide, 2 high.
        assert_eq!(
            [drawn.width(), drawn.height()],
            [64, (64 * 2_u32).div_ceil(6)]
        );
        let last = drawn
            .pixels()
            .chunks_exact(64)
            .filter(|row| row[63].red() > 0);
        assert!(last.count() > 0);
    }

    /// Many points leave no sample on the set empty, and edges are as in the exact picture.
    #[test]
    fn dense_points_are_antialiased() {
        let (graph, system) = of("{kind: ifs, space: 3, vertices: {solid: cube, shrink: 1/2}}");
        let options = options(40, ColorBy::None);
        let space = SpaceOptions::default().shade(Some(Shade::None));
        let exact = pixels_in_space(&graph, None, &options, &space, None).unwrap();
        let play = |points| {
            let game = Game::default().points(points);
            let drawn = draw(&graph, &system, &game, Tone::Log, &options, &space).unwrap();
            let pairs = drawn.0.data().chunks_exact(4);
            let pairs = pairs.zip(exact.pixels.premultiplied().chunks_exact(4));
            let away = pairs.map(|(a, b)| u64::from(a[0].abs_diff(b[0])));
            (away.sum::<u64>(), drawn.0)
        };
        let [sparse, dense] = [90_000, 400_000].map(play);
        let greys = |pixmap: &Pixmap| {
            let between =
                |pixel: &&tiny_skia::PremultipliedColorU8| (1..255).contains(&pixel.red());
            pixmap.pixels().iter().filter(between).count()
        };
        assert_eq!(greys(&sparse.1), 0);
        assert!(greys(&dense.1) > 40, "{}", greys(&dense.1));
        assert!(dense.0 * 3 < sparse.0 * 2, "{} {}", dense.0, sparse.0);
    }
}
