//! Scenes: approximants on their canvases, drawn in one or more passes.

use std::sync::{Arc, OnceLock};

use crate::graph::{Graph, Object};
use crate::grow::{ColonyKinds, Growth, KeptBlocks};
use crate::rule::BaseElement;
use crate::style::{Colour, Style, Width};

use super::canvas::Canvas;
use super::classes::Classes;
use super::culling::{Culling, starts_rings};
use super::frame_colours::FrameColours;
use super::png::{KeptSprites, LevelOfDetail};
use super::prepass::Prepass;
use super::prepass::Ranks;
use super::short_cuts::ShortCuts;

/// Minimum average number of uses of a sprite.
const USES: u64 = 3;

/// Approximant on its canvas.
pub(crate) struct Scene<'a> {
    pub(super) graph: &'a Graph,
    pub(super) growth: &'a Growth<'a>,
    pub(super) style: &'a Style,
    pub(super) canvas: Canvas,
    pub(super) culling: Culling,
    pub(super) classes: Classes,
    /// Colours of elements by their frames, if colours are by frame.
    pub(super) frames: Option<FrameColours>,
    pub(super) passes: Vec<Pass>,
    /// Number of elements.
    pub(super) elements: u64,
    /// Ranks of elements, if colours depend on them and they are known.
    pub(super) ranks: Option<Ranks>,
    pub(super) short_cuts: ShortCuts,
    /// Kinds of colonies, computed when sprites are first made.
    pub(super) colonies: OnceLock<ColonyKinds>,
    /// Minimum number of uses of a sprite.
    pub(super) uses: u64,
    /// Whether one path fills and strokes closed chains.
    pub(super) fills_strokes: bool,
    /// Blocks of the graph, for all walks over it.
    pub(super) blocks: Arc<KeptBlocks>,
    /// Simplified outlines, computed for the first surface of pixels.
    pub(super) outlines: OnceLock<Option<LevelOfDetail>>,
    /// Sprites of all bands of the picture, if it is drawn in bands.
    pub(super) sprites: Option<Arc<KeptSprites>>,
}

/// Part of a picture that one walk paints.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Pass {
    /// Areas of fractals that are closed chains, below everything else.
    Areas,
    /// Elements of a class.
    Class(u64),
    /// Elements of all classes, which occur in order.
    Along,
}

impl<'a> Scene<'a> {
    /// Creates the scene of a measured approximant on a canvas.
    pub(crate) fn new(prepass: &Prepass<'a>, growth: &'a Growth<'a>, canvas: Canvas) -> Self {
        let (graph, style) = (prepass.graph(), prepass.style());
        let (classes, painted) = prepass.classes();
        // One path serves both if stroke and colour never change along a fractal.
        let together = graph.draws_closed_paths()
            && matches!(style.width, Width::Pixels(_))
            && graph.widest().is_none()
            && classes.keep_fractals_whole();
        let is_open = |object: &Object| !graph.base_elements()[object.base_element].is_closed();
        let has_areas = starts_rings(graph) && graph.objects().iter().any(is_open);
        let areas = (style.fill.is_some() && !together && has_areas).then_some(Pass::Areas);
        let painted = if classes.come_in_order(graph) {
            vec![Pass::Along]
        } else {
            painted.into_iter().map(Pass::Class).collect()
        };
        let passes: Vec<_> = areas.into_iter().chain(painted).collect();
        if let Some(progress) = growth.progress {
            // The prepass, and a walk for every pass.
            let walks = u64::from(prepass.walked) + passes.len() as u64;
            progress.expect(prepass.elements * walks);
        }
        Self {
            graph,
            growth,
            style,
            canvas,
            culling: prepass.culling().clone(),
            classes,
            frames: FrameColours::of(style, graph, canvas.window(), prepass.lengths),
            passes,
            elements: prepass.elements,
            ranks: prepass.ranks.clone(),
            short_cuts: prepass.short_cuts,
            colonies: OnceLock::new(),
            uses: USES,
            fills_strokes: together && style.fill.is_some(),
            blocks: Arc::clone(&prepass.blocks),
            outlines: OnceLock::new(),
            sprites: None,
        }
    }

    /// Returns whether all strokes have the same width.
    pub(super) fn has_one_width(&self) -> bool {
        matches!(self.style.width, Width::Pixels(_)) && self.graph.widest().is_none()
    }

    /// Returns the base element of an object.
    pub(super) fn base_element(&self, object: &Object) -> &'a BaseElement {
        &self.graph.base_elements()[object.base_element]
    }
}

impl Pass {
    /// Returns the colour of the pass, if colours depend on classes and it paints one class.
    pub(super) fn colour(self, scene: &Scene<'_>) -> Option<Colour> {
        match self {
            Self::Areas | Self::Along => None,
            Self::Class(class) => scene.classes.colour(class, scene.style),
        }
    }

    /// Iterates over the colours of all classes that the pass paints.
    pub(super) fn colours(self, scene: &Scene<'_>) -> impl Iterator<Item = Option<Colour>> {
        let classes = match self {
            Self::Areas => 0..0,
            Self::Class(class) => class..class + 1,
            Self::Along => scene.classes.all(),
        };
        classes.map(|class| scene.classes.colour(class, scene.style))
    }
}
