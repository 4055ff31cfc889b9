//! Sprites: the coverage of runs of small elements, and of small seeded fractals, drawn once for all that are
//! congruent.
//!
//! If the maps of a graph have few orientations, or all of a step have the same, runs differ by translations
//! only; likewise filled elements of a few lengths, and colonies of seeded fractals. They are put on a grid:
//! of 1/128 of a pixel for runs if there are enough of them, otherwise of 1/64 or 1/32, and half as fine for
//! lines and outlines, whose pens are on a grid of 1/16. This moves them by at most 1/64 of a pixel, lines by
//! 1/32. The coverage is computed on the grid, so that it does not depend on the thread that draws it first.
//! Areas and outlines are covered separately, since their colours may differ.
//!
//! Compared with drawing every element, pixels differ by less than 1.6/255 in the mean, and a single one by
//! at most 40/255, which corresponds to ten of the samples that determine its coverage.

mod colonies;
mod runs;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, RwLock};

use crate::fast_hash::FastMap;
use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::grow::Element;
use crate::render::contribution::Painted;
use crate::render::culling::own_reach;
use crate::render::paint::overhang;
use crate::render::paint::{FINE, Position, position};
use crate::render::paint_key::PathKind;
use crate::render::scene::{Pass, Scene};
use crate::render::short_cuts::ShortCut;
use crate::rule::Piece;
use crate::style::{ColorBy, Width};

use self::colonies::Colonies;
pub(in crate::render) use self::colonies::Put;
use self::runs::Runs;
use super::coverage::{Sprite, SpritePaint, SpriteSheet};
use super::raster::PlacedSprite;

/// Steps per pixel in which linear parts are quantised.
const LINEAR: f64 = 4096.0;

/// Minimum number of elements of a run that is drawn as a sprite; an element with many pieces counts as several.
const MIN_IN_RUN: u64 = 4;
/// Minimum number of elements of a picture with sprites, counted likewise.
const MIN_IN_PICTURE: u64 = 1 << 20;

/// Maximum size of a sprite, in pixels.
const LARGEST: f64 = 32.0;

/// Upper bound of the distance, in pixels, by which filled shapes are drawn beyond their outlines: shapes
/// narrower than a pixel are drawn a pixel wide.
const BROADENED: f64 = 0.75;

/// Maximum memory of all sprites, in bytes.
const MAX_MEMORY: usize = 1 << 26;

/// Number of tables with separate locks.
const TABLES: u64 = 64;

/// Properties that determine the coverage of a run or colony up to its position.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    of: Of,
    linear: [i64; 4],
    painted: Painted,
}

/// Subject of a sprite.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Of {
    /// Run, by the number of its block.
    Run(u64),
    /// Colony, by the index of its kind.
    Colony(usize),
}

/// Sprites with equal keys, by position in a pixel; `None` for sprites that could not be drawn.
type Places = [OnceLock<Option<Arc<Sprite>>>];

/// Sprites of a pass.
pub(in crate::render) struct Sprites<'a> {
    paint: SpritePaint,
    reach: Reach,
    runs: Option<Runs>,
    colonies: Option<Colonies<'a>>,
    tables: Arc<SpriteTables>,
}

/// Sprites that have been drawn for a pass.
struct SpriteTables {
    tables: Vec<RwLock<FastMap<Key, Arc<Places>>>>,
    /// Number of bytes of these sprites, and of those of other passes that are kept with them.
    bytes: Arc<AtomicUsize>,
}

impl SpriteTables {
    fn of_bytes(bytes: &Arc<AtomicUsize>) -> Arc<Self> {
        Arc::new(Self {
            tables: (0..TABLES).map(|_| RwLock::default()).collect(),
            bytes: Arc::clone(bytes),
        })
    }
}

/// Sprites of all passes, for scenes of one picture that differ in the window only.
#[derive(Default)]
pub(in crate::render) struct KeptSprites {
    passes: Mutex<Vec<(Pass, Arc<SpriteTables>)>>,
    bytes: Arc<AtomicUsize>,
}

impl KeptSprites {
    fn of(&self, pass: Pass) -> Arc<SpriteTables> {
        let mut passes = self.passes.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, tables)) = passes.iter().find(|(known, _)| *known == pass) {
            return Arc::clone(tables);
        }
        let tables = SpriteTables::of_bytes(&self.bytes);
        passes.push((pass, Arc::clone(&tables)));
        tables
    }
}

impl SpriteTables {
    /// Returns the sprites of a key by position in a pixel, if there is memory for them.
    fn places(&self, key: &Key, count: usize) -> Option<Arc<Places>> {
        let number = match key.of {
            Of::Run(number) => number,
            Of::Colony(kind) => kind as u64,
        };
        let table = &self.tables[usize::try_from(number % TABLES).unwrap_or(0)];
        let known = table.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(places) = known.get(key) {
            return Some(Arc::clone(places));
        }
        drop(known);
        if !self.take(count * size_of::<OnceLock<Option<Arc<Sprite>>>>()) {
            return None;
        }
        let made = || (0..count).map(|_| OnceLock::new()).collect();
        let mut table = table.write().unwrap_or_else(PoisonError::into_inner);
        Some(Arc::clone(table.entry(key.clone()).or_insert_with(made)))
    }

    /// Reserves memory. Returns whether any was left.
    fn take(&self, bytes: usize) -> bool {
        self.bytes.fetch_add(bytes, Ordering::Relaxed) < MAX_MEMORY
    }
}

/// Extent of the descendants of elements about the centres of their frames.
struct Reach {
    /// By object, radius without strokes in pixels, as a multiple of its length.
    radii: Vec<f64>,
    /// Distance, in pixels, by which drawing may exceed that radius.
    overhang: f64,
}

impl Reach {
    fn of(scene: &Scene<'_>) -> Self {
        let Scene { graph, style, .. } = scene;
        Self {
            radii: graph.reaches(|object| own_reach(graph, object, style)),
            overhang: match style.width {
                Width::Pixels(width) => width * graph.widest().unwrap_or(1.0) * overhang(style),
                Width::Relative(_) => 0.0,
            }
            .max(BROADENED),
        }
    }

    /// Returns the distance, in pixels, at which a set may be drawn whose radius is given as a multiple of
    /// its length.
    fn pixels(&self, scene: &Scene<'_>, radius: f64, length: f64) -> f64 {
        radius * scene.canvas.scale() * length + self.overhang
    }
}

impl<'a> Sprites<'a> {
    /// Returns whether runs or colonies of a pass may be drawn as sprites: no line leads to elements of
    /// another class, and colours do not depend on the elements before.
    pub(super) fn may_be(scene: &Scene<'_>, pass: Pass) -> bool {
        let Scene { graph, style, .. } = scene;
        let numbers_change = match style.color_by {
            // If classes occur in order, runs of one class are recognised.
            ColorBy::Index => pass != Pass::Along,
            ColorBy::Fractal => graph.has_fractals(),
            ColorBy::Tint => graph.tints(),
            _ => scene.frames.is_some(),
        };
        pass != Pass::Areas && !numbers_change && !scene.fills_strokes && !graph.links()
    }

    /// Creates the sprites of a scene if many of its runs, or of its seeded fractals, are congruent.
    pub(super) fn new(
        scene: &'a Scene<'a>,
        pass: Pass,
        paint: SpritePaint,
        painted: Option<Painted>,
    ) -> Option<Self> {
        let Scene { graph, .. } = scene;
        let drawn = graph.objects().iter().filter(|object| object.visible);
        let pieces = drawn.map(|object| scene.base_element(object).pieces().len());
        let worth = (pieces.max().unwrap_or(0) as u64 / 4).max(1);
        let is_large = scene.elements.saturating_mul(worth) >= MIN_IN_PICTURE;
        if !is_large || graph.has_appearances() {
            return None;
        }
        let has_pen = paint.pen.is_some();
        let reach = Reach::of(scene);
        let has = |short_cut| scene.short_cuts.has(short_cut);
        let painted =
            painted.filter(|_| !scene.culling.is_bounded() && has(ShortCut::ColonySprites));
        let colonies = painted.and_then(|painted| Colonies::of(scene, &reach, painted, has_pen));
        let runs = Runs::of(scene, &paint, worth).filter(|_| has(ShortCut::RunSprites));
        let is_any = runs.is_some() || colonies.is_some();
        is_any.then(|| Self {
            paint,
            reach,
            runs,
            colonies,
            tables: match &scene.sprites {
                Some(kept) => kept.of(pass),
                None => SpriteTables::of_bytes(&Arc::default()),
            },
        })
    }

    /// Returns the maximum number of elements of a run, if runs are drawn as sprites.
    pub(in crate::render) fn longest_run(&self) -> Option<u64> {
        self.runs.as_ref().map(|runs| runs.longest)
    }

    /// Returns the kind of the path in which colonies are put.
    pub(in crate::render) fn kind(&self) -> PathKind {
        if self.paint.pen.is_some() && !self.paint.outlines {
            PathKind::Line
        } else {
            PathKind::Polygon
        }
    }
}

impl Sprites<'_> {
    /// Returns the sprite for a position, which is rounded to a grid of `phases` steps per pixel. The sprite is
    /// drawn if there is none yet for the position in the pixel.
    fn put(
        &self,
        key: &Key,
        at: DVec2,
        phases: f64,
        drawn: impl FnOnce(DVec2) -> Option<Sprite>,
    ) -> Option<PlacedSprite> {
        let grid = at * phases;
        let place = [grid.x, grid.y].map(whole);
        let count = whole(phases);
        let pixel = place.map(|place| place.div_euclid(count));
        let phase = place.map(|place| place.rem_euclid(count));
        let drawn = || {
            #[expect(clippy::cast_precision_loss, reason = "places in a pixel")]
            let phase = phase.map(|place| place as f64 / phases);
            drawn(DVec2::from_array(phase)).map(Arc::new)
        };
        let number = usize::try_from(phase[0] + count * phase[1]).ok()?;
        let places = self
            .tables
            .places(key, usize::try_from(count * count).ok()?);
        let known = places.as_deref().and_then(|places| places.get(number));
        let sprite = known.and_then(OnceLock::get).cloned().unwrap_or_else(|| {
            let sprite = drawn();
            let bytes = sprite.as_ref().map_or(0, |sprite| sprite.bytes());
            if let Some(known) = known.filter(|_| self.tables.take(bytes)) {
                let _ = known.set(sprite.clone());
            }
            sprite
        });
        let sprite = sprite?;
        Some(PlacedSprite { sprite, pixel })
    }

    /// Draws a sprite with a linear map at a position in a pixel, inside a disc relative to that position.
    fn drawn(
        &self,
        linear: DMat2,
        phase: DVec2,
        (middle, reach): (DVec2, f64),
        draw: impl FnOnce(DAffine2, &mut SpriteSheet),
    ) -> Option<Sprite> {
        // Everything lies on the sheet, with a pixel on every side.
        let reach = reach + 2.0;
        let corner = phase + middle - reach;
        let pixel = [-corner.x, -corner.y].map(whole);
        #[expect(clippy::cast_precision_loss, reason = "places in a small picture")]
        let shift = DVec2::new(pixel[0] as f64, pixel[1] as f64);
        let side = u32::try_from(whole(2.0 * reach) + 2).ok()?;
        let mut sheet = SpriteSheet::new([side; 2], self.paint.clone());
        let map = DAffine2 {
            matrix2: linear,
            translation: phase + shift,
        };
        draw(map, &mut sheet);
        sheet.into_sprite(pixel)
    }
}

/// Draws an element on a sheet. The frame of the element is in pixels of the sheet.
fn outline(
    scene: &Scene<'_>,
    element: &Element,
    points: &mut Vec<Position>,
    sheet: &mut SpriteSheet,
) {
    let object = &scene.graph.objects()[element.object];
    if !object.visible {
        return;
    }
    let base_element = scene.base_element(object);
    let is_closed = base_element.is_closed();
    let map = element.frame.map();
    let fine = |point: DVec2| position(map.transform_point2(point) * FINE);
    let outlines = scene.outlines.get().and_then(Option::as_ref);
    let stretch = element.frame.stretch();
    let corners = outlines.and_then(|all| all.corners(scene.graph, object.base_element, stretch));
    let trace = |points: &mut Vec<Position>, encircles: bool| {
        points.clear();
        if let Some(corners) = corners {
            points.extend(corners.iter().map(|corner| fine(*corner)));
            return;
        }
        let mut at = fine(base_element.start());
        points.push(at);
        for piece in base_element.pieces() {
            match *piece {
                Piece::Line(end) => points.push(fine(end)),
                Piece::Cubic(a, b, end) => {
                    let curve = [at, fine(a), fine(b), fine(end)];
                    SpriteSheet::add_curve(points, curve, encircles);
                }
            }
            at = fine(piece.end());
        }
        if is_closed {
            points.pop();
        }
    };
    trace(points, is_closed);
    if !is_closed {
        return sheet.line(points);
    }
    sheet.polygon(points);
    if sheet.paint.outlines {
        let is_curve = |piece: &Piece| matches!(piece, Piece::Cubic(..));
        if corners.is_none() && base_element.pieces().iter().any(is_curve) {
            trace(points, false);
        }
        sheet.outline(points);
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn whole(value: f64) -> i64 {
    (value + 0.5).floor() as i64
}

#[cfg(test)]
mod tests;
