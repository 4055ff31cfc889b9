//! Means by which a pass takes less work on a surface of pixels than by paths.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::render::contribution::ContributionMask;
use crate::render::paint_key::{PaintKey, PathKind};
use crate::render::scene::{Pass, Scene};
use crate::render::short_cuts::ShortCut;
use crate::style::{Colour, Width};

use super::batch::BatchBuilder;
use super::coverage::SpritePaint;
use super::level_of_detail::LevelOfDetail;
use super::raster::Raster;
use super::sprites::Sprites;

/// Means of a pass, each if scene and surface permit it. Without any, all elements are drawn by paths.
#[derive(Clone, Default)]
pub(in crate::render) struct Means<'a> {
    /// Builder of segment batches.
    pub(in crate::render) batches: Option<Arc<BatchBuilder>>,
    /// Simplified outlines.
    pub(in crate::render) outlines: Option<&'a LevelOfDetail>,
    /// Sprites of congruent runs and colonies.
    pub(in crate::render) sprites: Option<Arc<Sprites<'a>>>,
}

impl<'a> Means<'a> {
    /// Creates the means of a pass.
    pub(in crate::render) fn of(
        scene: &'a Scene<'a>,
        pass: Pass,
        mask: &ContributionMask,
        raster: &mut dyn Raster,
    ) -> Self {
        let has = |short_cut| scene.short_cuts.has(short_cut);
        let simplified = || LevelOfDetail::of(scene.graph);
        let outlines = || scene.outlines.get_or_init(simplified).as_ref();
        let batches = has(ShortCut::SegmentBatches).then(|| batches(scene, pass, raster));
        Self {
            batches: batches.flatten().map(Arc::new),
            outlines: has(ShortCut::LevelOfDetail).then(outlines).flatten(),
            sprites: sprites(scene, pass, mask, raster).map(Arc::new),
        }
    }
}

/// Creates the builder of segment batches, for strokes of relative width.
fn batches(scene: &Scene<'_>, pass: Pass, raster: &dyn Raster) -> Option<BatchBuilder> {
    let Width::Relative(width) = scene.style.width else {
        return None;
    };
    let paint = PaintKey::of(PathKind::Line).paint(scene, pass.colour(scene));
    let stroke = paint.stroke.filter(|_| raster.takes_batches(&paint))?;
    Some(BatchBuilder::new(width, stroke.pen, scene.graph.joins()))
}

/// Creates the sprites of a pass, if every class is painted in one opaque colour, or in two of which that of
/// strokes lies on top.
fn sprites<'a>(
    scene: &'a Scene<'a>,
    pass: Pass,
    mask: &ContributionMask,
    raster: &mut dyn Raster,
) -> Option<Sprites<'a>> {
    if !Sprites::may_be(scene, pass) {
        return None;
    }
    let kinds = kinds(scene);
    // Areas lie below the strokes of their own path only.
    let is_one_path = kinds.len() == 1 && pass != Pass::Along && scene.has_one_width();
    let most = if is_one_path { 2 } else { 1 };
    let mut all = SpritePaint::default();
    for colour in pass.colours(scene) {
        let mut inks = BTreeSet::new();
        for &kind in &kinds {
            let paint = PaintKey::of(kind).paint(scene, colour);
            let own = raster.sprite_paint(&paint)?;
            all = SpritePaint {
                pen: all.pen.or(own.pen),
                outlines: all.outlines || own.outlines,
            };
            let stroke = paint.stroke.map(|stroke| stroke.colour);
            inks.extend([paint.fill, stroke].into_iter().flatten().map(Colour::rgba));
        }
        if inks.is_empty() || inks.len() > most {
            return None;
        }
    }
    Sprites::new(scene, pass, all, mask.painted(scene, pass))
}

/// Returns the kinds of the paths that are drawn.
fn kinds(scene: &Scene<'_>) -> Vec<PathKind> {
    let drawn = scene.graph.objects().iter().filter(|object| object.visible);
    let closed: BTreeSet<bool> = drawn
        .map(|object| scene.base_element(object).is_closed())
        .collect();
    let kind = |is_closed| {
        if is_closed {
            PathKind::Polygon
        } else {
            PathKind::Line
        }
    };
    closed.into_iter().map(kind).collect()
}
