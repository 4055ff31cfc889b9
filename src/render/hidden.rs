use std::sync::Arc;

use crate::geometry::DVec2;
use crate::grow::Subtree;
use crate::style::{ColorBy, Width};

use super::filled::Filled;
use super::scene::{Pass, Scene};
use super::sight::own_reach;
use super::sketch::stands_alone;
use super::survey::overhang;

/// Tells what need not be drawn, since it lies where all is covered already.
///
/// Coverage of one colour neither grows nor changes where it is whole, and what is left out joins
/// nothing: the picture stays the same to the bit.
pub(super) struct Hidden {
    filled: Arc<Filled>,
    /// The layer of the first class.
    pub(super) first: u64,
    /// How far what becomes of an object reaches from the middle of its frame, by object,
    reaches: Arc<[f64]>,
    /// and how many pixels further it is drawn.
    overhang: f64,
}

impl Hidden {
    /// Whether anything may be left out of a pass for that reason.
    pub(super) fn may_be(scene: &Scene<'_>, pass: Pass) -> bool {
        let Scene { graph, style, .. } = scene;
        let numbers_change = match style.color_by {
            // Spans of one class are told apart where they come in order.
            ColorBy::Index => pass != Pass::Along,
            ColorBy::Fractal => graph.seeds,
            ColorBy::Tint => graph.tints(),
            _ => false,
        };
        pass != Pass::Areas && !numbers_change && !scene.fills_strokes && stands_alone(scene)
    }

    /// What is hidden of a scene.
    pub(super) fn new(scene: &Scene<'_>, filled: Arc<Filled>) -> Self {
        let Scene { graph, style, .. } = scene;
        let reaches = graph.reaches(|object| own_reach(graph, object, style));
        Self {
            filled,
            first: Filled::layers(scene.classes.count()),
            reaches: reaches.into(),
            overhang: match style.width {
                Width::Pixels(width) => width * graph.widest().unwrap_or(1.0) * overhang(style),
                Width::Relative(_) => 0.0,
            },
        }
    }

    /// How many pixels from the middle of its frame what becomes of an object of a length is drawn at
    /// most.
    #[inline]
    pub(super) fn reach(&self, scene: &Scene<'_>, object: usize, length: f64) -> f64 {
        self.reaches[object] * scene.canvas.scale() * length + self.overhang
    }

    /// Whether all that becomes of an element of a class is.
    #[inline]
    pub(super) fn hides(&self, scene: &Scene<'_>, subtree: &Subtree, class: u64) -> bool {
        // What a disc becomes is as wide and as high as the rows of the map are long.
        let rows = subtree.frame.map.matrix2.transpose();
        let [x, y] = [rows.x_axis, rows.y_axis].map(DVec2::length);
        let reach = [x, y].map(|length| self.reach(scene, subtree.object, length));
        let middle = subtree.frame.map.transform_point2(scene.graph.middle());
        let layer = self.first + class;
        self.filled
            .is_full(layer, scene.canvas.pixel(middle), reach)
    }
}
