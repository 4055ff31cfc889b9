//! Pictures of sets in space: an exact descent of the graph into depth buffers.
//!
//! The picture is divided into tiles, each of which is drawn from the whole graph, by any thread: instances that
//! lie beside the tile or strictly behind what is drawn already are left out, and the nearest are drawn first.
//! The cost is that of the visible part, at any number of steps. Instances that differ by a translation only are
//! copies of one picture in a parallel view; small ones that turn are copies within a pixel. Elements smaller than a detail are not replaced,
//! and drawn as the convex solid that the graph has for them. Of elements that differ by a translation of less than a detail, one is drawn.
//!
//! A pixel has 4 × 4 samples, whose depths are multiples of 2⁻²² of the exact range of the set; the nearer wins,
//! and of two that are equally near the one of the first class. Threads and timing change no byte.

mod buffer;
mod camera;
mod copies;
mod depth_map;
mod descent;
mod eye;
mod forms;
mod gathered;
mod lit;
mod occlusion;
mod open;
mod options;
mod place;
mod planes;
mod points;
mod relief;
mod roots;
mod round;
mod scene;
mod shade;
mod shadows;
mod slice;
mod solid;
mod stamp;
mod tile;
mod tints;
mod turned;
mod visible;

#[cfg(feature = "cli")]
pub(crate) use camera::Sight;
pub use depth_map::DepthMap;
pub(in crate::render) use eye::Eye;
pub use options::{SpaceError, SpaceOptions, SpacePicture};
pub use points::{colours_of_maps, points_in_space};
pub(super) use shade::ink;
pub use visible::write_visible;

pub use crate::style::{Camera, CameraError, Light, Shade, Slice};

use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::geometry::Frame3;
use crate::graph::Graph;
use crate::grow::WalkError;
use crate::parallel::{for_each, with_team};
use crate::style::{ColorBy, Colour};

use self::buffer::{SAMPLES, TILE};
use self::camera::Placement;
use self::forms::Forms;
use self::lit::Lit;
use self::roots::Roots;
use self::scene::{ClassBy, End, Part};
use self::shade::Inks;
use self::shadows::Shadows;
use self::slice::Search;
use self::tile::{Scene, Tile, Workspaces};
use self::turned::Turned;
use super::png::TooManyPixels;
use super::{Options, Picture, Pixels, RenderError, Size};

/// White: the paper of pictures whose style has no background.
pub(crate) const PAPER: Colour = Colour::grey(255);

/// Draws a set in space and writes it as PNG: approximant `steps`, or the limit set. Elements of at most
/// [`Options::detail`] pixels, or of one pixel where it is not given, are not replaced.
///
/// # Errors
///
/// If there is nothing to draw or no room for it, if the camera is not valid, if the extent of the set is not
/// known, if it is cancelled, or if `out` fails.
pub fn write_space(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    options: &Options,
    space: &SpaceOptions,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<Picture, RenderError> {
    let drawn = pixels_in_space(graph, steps, options, space, cancel)?;
    drawn.pixels.write(options, out)?;
    Ok(drawn.picture)
}

/// Draws a set in space as [`write_space`] does, as pixels in memory. [`Options::format`], [`Options::labels`] and
/// [`Options::png`] have no effect.
///
/// # Errors
///
/// As for [`write_space`].
pub fn pixels_in_space(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    options: &Options,
    space: &SpaceOptions,
    cancel: Option<&AtomicBool>,
) -> Result<SpacePicture, RenderError> {
    let Drawn {
        pixmap,
        depths,
        picture,
        placement,
    } = draw(graph, steps, options, space, cancel)?;
    Ok(SpacePicture {
        pixels: Pixels::of(pixmap),
        depths: depths.filter(|_| space.keeps_depths),
        picture,
        sight: placement.sight(space.camera.look_at),
    })
}

/// Returns what lies in the middle of a picture that [`pixels_in_space`] would draw of a set that is not cut.
///
/// # Errors
///
/// If there is nothing to draw or no room for it, if the camera is not valid, or if the extent of the set is not known.
#[cfg(feature = "cli")]
pub(crate) fn sight_in_space(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    options: &Options,
    space: &SpaceOptions,
) -> Result<Sight, RenderError> {
    let placement = placement(graph, &[], steps, options, space)?;
    Ok(placement.sight(space.camera.look_at))
}

/// Picture in memory.
#[derive(Debug)]
struct Drawn {
    pixmap: Pixmap,
    depths: Option<DepthMap>,
    picture: Picture,
    placement: Placement,
}

/// Picture before it is lit by its depths, and put on its background.
struct Unlit {
    /// Pixels, if colours are seen.
    pixmap: Option<Pixmap>,
    depths: Option<DepthMap>,
    picture: Picture,
    placement: Placement,
    has_faces: bool,
}

/// Number of colours by normal.
const NORMALS: usize = 65;

/// Places the set on the picture. `parts` are needed for a set that is not whole.
fn placement(
    graph: &Graph<Frame3>,
    parts: &[Part],
    steps: Option<u32>,
    options: &Options,
    space: &SpaceOptions,
) -> Result<Placement, SpaceError> {
    let search = Search {
        parts,
        start: &scene::start(graph),
        steps,
    };
    // A section has the depths of its plane.
    let within = space.within(0.0);
    let (size, pad) = (options.size, options.view.pad());
    place::place(graph, &search, &space.camera, &within, size, pad)
}

/// Draws the picture into memory.
fn draw(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    options: &Options,
    space: &SpaceOptions,
    cancel: Option<&AtomicBool>,
) -> Result<Drawn, RenderError> {
    let Unlit {
        pixmap,
        depths,
        picture,
        placement,
        has_faces,
    } = draw_unlit(graph, steps, options, space, (true, cancel))?;
    let size = placement.size;
    let mut pixmap = pixmap.ok_or(TooManyPixels { size })?;
    // The search for the extent ends with boxes of a size, whose set may lie beside a section.
    if let Some(first) = space.within(0.0).first()
        && pixmap.pixels().iter().all(|pixel| pixel.alpha() == 0)
    {
        return Err(place::nothing_left(graph, steps, first).into());
    }
    let shadows = match &depths {
        Some(depths) if space.shadows => {
            let seen = seen_by_light(graph, steps, options, space, cancel)?;
            seen.map(|seen| Shadows::new(seen, depths))
        }
        _ => None,
    };
    let shadows = shadows.as_ref();
    finish(
        &mut pixmap,
        depths.as_ref(),
        shadows,
        has_faces,
        options,
        space,
    )?;
    Ok(Drawn {
        pixmap,
        depths,
        picture,
        placement,
    })
}

/// Draws the picture, with colours or without.
fn draw_unlit(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    options: &Options,
    space: &SpaceOptions,
    (has_colours, cancel): (bool, Option<&AtomicBool>),
) -> Result<Unlit, RenderError> {
    const MAX_STEPS: u32 = 1_000_000;
    let style = &options.style;
    let parts = scene::parts(graph, steps);
    let placement = placement(graph, &parts, steps, options, space)?;
    #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
    let cuts = space.within(SAMPLES as f64 / placement.scale());
    let cuts = cuts.iter().map(|cut| slice::mapped(cut, &placement.map));
    let start = scene::start(&scene::seen(graph, &placement.map));
    let detail = options.detail.as_ref().map_or(1.0, |detail| detail.pixels);
    #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
    let end = End {
        steps: steps.unwrap_or(MAX_STEPS),
        detail: detail * SAMPLES as f64,
        unit: graph.unit(),
    };
    let class_by = ClassBy::of(style.color_by)?;
    let classes = match class_by {
        ClassBy::Nothing | ClassBy::Tint => 1,
        ClassBy::FirstMap | ClassBy::LastMap => {
            graph.origins() + usize::from(scene::draws_unmade(graph))
        }
        ClassBy::Step => {
            let least = if style.range().is_some() { 64 } else { 16 };
            steps.unwrap_or(least).min(64) as usize + 1
        }
        ClassBy::Normal => NORMALS,
    };
    let has_faces = scene::has_faces(graph, steps);
    let is_lit = has_faces && space.shade.unwrap_or_default().lights_faces();
    let by_normal = class_by == ClassBy::Normal;
    let known = Some(classes).filter(|_| class_by != ClassBy::Tint && !by_normal);
    let light = match is_lit {
        true => space.light,
        // Faces of a colour each, of full intensity.
        false => space.light.ambient(1.0),
    };
    let lit = (is_lit || by_normal).then(|| Lit::new(&space.camera, light, known));
    let lit = lit.transpose().map_err(SpaceError::from)?;
    let mut inks = shade::colours(style, class_by, classes);
    if let (ClassBy::Step, Some(steps)) = (class_by, steps) {
        shade::let_grow(&mut inks, style, steps, graph.lag());
    }
    let pad = solid::pad(graph);
    // Stamps are shared by tiles.
    let has_stamps = !by_normal;
    let forms = Forms::find(&parts, &start, &end, class_by, &placement, pad, has_stamps);
    let is_turned = lit.is_none() && scene::is_similar(graph);
    let turned = { is_turned }
        .then(|| Turned::of(&parts, &start, &forms, &end, class_by, &placement))
        .flatten();
    let scene = Scene {
        roots: Roots {
            parts: &parts,
            forms: &forms,
            end,
            class_by,
            lit,
            inks: &inks,
            pad,
            overlap: copies::overlap(&parts),
            turned: turned.as_ref(),
        },
        cuts: cuts.collect(),
        placement,
        workspaces: Workspaces::default(),
        inks: has_colours.then(|| Inks::new(&inks, lit.as_ref(), space.shade.unwrap_or_default())),
        cancel,
    };
    let size @ [width, height] = placement.size;
    let pixmap = has_colours.then(|| Pixmap::new(width, height).ok_or(TooManyPixels { size }));
    let mut pixmap = pixmap.transpose()?;
    let mut depths = { space.needs_depths(has_faces) }.then(|| DepthMap::new(&scene.placement));
    let (mut drawn, mut deepest) = (0, 0);
    let mut take = |tile: &mut Tile<'_>| {
        if scene.is_cancelled() {
            return Err(RenderError::Walk(WalkError::Cancelled));
        }
        drawn += tile.drawn;
        deepest = deepest.max(tile.deepest);
        if let Some(depths) = &mut depths {
            depths.add(tile.at, &tile.keys);
        }
        if let Some(pixmap) = &mut pixmap {
            tile.copy(pixmap);
        }
        Ok(())
    };
    with_team(options.threads, |team| {
        let mut line = team.line(Tile::draw).ahead(TILES_A_THREAD);
        for row in 0..height.div_ceil(TILE_SIZE) {
            let start: Arc<[usize]> = scene.roots.start(&scene.view([0, row])).into();
            for column in 0..width.div_ceil(TILE_SIZE) {
                let mut tile = line.spare().unwrap_or_else(|| Tile::of(&scene));
                tile.at = [column, row];
                tile.start = Arc::clone(&start);
                line.hand_on(tile, &mut take)?;
            }
        }
        line.finish(&mut take)
    })?;
    let picture = described(size, steps.unwrap_or(deepest), drawn);
    Ok(Unlit {
        pixmap,
        depths,
        picture,
        placement: scene.placement,
        has_faces,
    })
}

/// Number of pixels along the long side of a picture from the light, beside that of the picture.
const LIGHT_SIDE: u32 = 2048;

/// Returns the depths of a set from the direction of the light.
fn seen_by_light(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    options: &Options,
    space: &SpaceOptions,
    cancel: Option<&AtomicBool>,
) -> Result<Option<DepthMap>, RenderError> {
    let (Size::Long(side) | Size::Exactly(side, _)) = options.size;
    let mut options = options
        .clone()
        .size(Size::Long(LIGHT_SIDE.max(side.min(2 * LIGHT_SIDE))));
    options.view.margin = None;
    options.style.color_by = ColorBy::None;
    let space = SpaceOptions::default()
        .camera(Camera::default().from(space.light.from))
        .slice(space.slice)
        .cuts(space.cuts.clone())
        .shade(Some(Shade::None))
        .keeps_depths(true);
    Ok(draw_unlit(graph, steps, &options, &space, (false, cancel))?.depths)
}

/// Lights the pixels by their depths, and puts them on the background.
fn finish(
    pixmap: &mut Pixmap,
    depths: Option<&DepthMap>,
    shadows: Option<&Shadows>,
    has_faces: bool,
    options: &Options,
    space: &SpaceOptions,
) -> Result<(), RenderError> {
    let threads = options.threads.get();
    if let Some(depths) = depths {
        relief::light(pixmap, depths, shadows, has_faces, space, threads)
            .map_err(SpaceError::from)?;
    }
    let background = Some(options.style.background.unwrap_or(PAPER));
    let empty = shade::over(background, PremultipliedColorU8::TRANSPARENT);
    let width = pixmap.width() as usize;
    let rows = pixmap.pixels_mut().chunks_mut(width);
    for_each(rows, threads, |row| {
        for pixel in row {
            *pixel = match pixel.alpha() {
                0 => empty,
                _ => shade::over(background, *pixel),
            };
        }
    });
    Ok(())
}

/// Describes a picture of elements or points.
fn described(size: [u32; 2], steps: u32, elements: u64) -> Picture {
    Picture {
        size,
        window: None,
        steps,
        elements,
        is_limit: false,
        fractals: 1,
        is_part: true,
        empty: None,
        plotted: None,
        instanced: None,
    }
}

/// Number of tiles in progress per thread: behind one that takes long, others must not wait.
const TILES_A_THREAD: u64 = 4;

#[expect(clippy::cast_possible_truncation, reason = "tiles are small")]
const TILE_SIZE: u32 = TILE as u32;

#[cfg(test)]
mod tests;
