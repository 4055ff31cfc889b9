use std::sync::Arc;

use crate::geometry::DVec2;
use crate::graph::Graph;
use crate::grow::Subtree;
use crate::style::{ColorBy, Style, Width};

use super::filled::Filled;
use super::png::WIDEST_COVERED;
use super::scene::{Pass, Scene};
use super::sight::own_reach;
use super::sketch::stands_alone;
use super::survey::overhang;

/// Longer and longer descendants are looked for so many times.
const MOST_SWEEPS: usize = 64;

/// Filled shapes that are narrower than a pixel are drawn as wide, which is less than so many pixels beyond
/// their outlines.
const BROADENED: f64 = 0.75;

/// Tells what need not be drawn, since it lies where all is covered already.
///
/// The law: a picture is the same to the bit whether anything is hidden or not. So it does not matter
/// what a thread knows of that which others have covered, nor when, nor how many they are. It holds
/// since
///
/// - all that hides has been drawn already, and is drawn once: nothing is hidden by itself, or by what
///   may yet be left out;
/// - coverage of one opaque colour neither grows nor changes where it is whole; of areas and strokes in two
///   colours, which are one path, the strokes lie on top and hide both;
/// - what is left out joins nothing: lines that go on behind it begin where all is covered, and no caps
///   or corners show there;
/// - all of it would be drawn as coverage, which has no order. Paths that are drawn in pieces, by the
///   number of their vertices, may have seams; what is drawn as such is not hidden.
pub(super) struct Hidden {
    filled: Arc<Filled>,
    /// The layer of the first class.
    pub(super) first: u64,
    /// How far what becomes of an object reaches from the middle of its frame, by object,
    reaches: Arc<[f64]>,
    /// and how many pixels further it is drawn.
    overhang: f64,
    /// How wide strokes of what becomes of an object are at most, as a multiple of its length, by object.
    widths: Vec<f64>,
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
        pass != Pass::Areas
            && !numbers_change
            && !scene.fills_strokes
            && stands_alone(scene)
            && Self::is_narrow(graph, style)
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
            }
            .max(BROADENED),
            widths: match style.width {
                Width::Pixels(_) => Vec::new(),
                Width::Relative(width) => {
                    let width = width * graph.widest().unwrap_or(1.0) * graph.unit();
                    let longest = longest(graph).into_iter();
                    longest.map(|longest| longest * width).collect()
                }
            },
        }
    }

    /// Whether all lines are narrow enough to be drawn as coverage where they are as wide as `style` says
    /// in pixels; where widths are relative, some may be.
    fn is_narrow(graph: &Graph, style: &Style) -> bool {
        let mut drawn = graph.objects().iter().filter(|object| object.visible);
        let draws_lines = style.outlines_polygons()
            || drawn.any(|object| !graph.base_elements()[object.base_element].is_closed());
        match style.width {
            Width::Pixels(width) if draws_lines => {
                width * graph.widest().unwrap_or(1.0) <= WIDEST_COVERED
            }
            Width::Pixels(_) | Width::Relative(_) => true,
        }
    }

    /// How many pixels from the middle of its frame what becomes of an object of a length is drawn at
    /// most.
    #[inline]
    pub(super) fn reach(&self, scene: &Scene<'_>, object: usize, length: f64) -> f64 {
        self.reach_of(scene, self.reaches[object], length)
    }

    /// Returns the reach in pixels of a set whose radius is given as a multiple of its length.
    #[inline]
    pub(super) fn reach_of(&self, scene: &Scene<'_>, radius: f64, length: f64) -> f64 {
        radius * scene.canvas.scale() * length + self.overhang
    }

    /// Returns the radius about the middle of its frame of the descendants of an object, without strokes, as a
    /// multiple of its length.
    pub(super) fn radius(&self, object: usize) -> f64 {
        self.reaches[object]
    }

    /// Whether all that becomes of an element of a class is.
    #[inline]
    pub(super) fn hides(&self, scene: &Scene<'_>, subtree: &Subtree, class: u64) -> bool {
        // What a disc becomes is as wide and as high as the rows of the map are long.
        let rows = subtree.frame.map.matrix2.transpose();
        let [x, y] = [rows.x_axis, rows.y_axis].map(DVec2::length);
        let reach = [x, y].map(|length| self.reach(scene, subtree.object, length));
        let middle = subtree.frame.map.transform_point2(scene.graph.middle());
        let length = subtree.frame.stretch() * scene.canvas.scale();
        let width = self.widths.get(subtree.object);
        if width.is_some_and(|width| width * length > WIDEST_COVERED) {
            return false;
        }
        let layer = self.first + class;
        self.filled
            .is_full(layer, scene.canvas.pixel(middle), reach)
    }
}

/// By object, the most that what becomes of it is long, as a multiple of its length.
fn longest(graph: &Graph) -> Vec<f64> {
    let ratios = graph.ratios();
    let mut longest = vec![1.0; ratios.len()];
    for _ in 0..MOST_SWEEPS {
        let mut changes = false;
        for (object, children) in ratios.iter().enumerate().rev() {
            let lengths = children
                .iter()
                .map(|&(child, ratio)| ratio * longest[child]);
            let most = lengths.fold(longest[object], f64::max);
            changes |= most > longest[object];
            longest[object] = most;
        }
        if !changes {
            return longest;
        }
    }
    vec![f64::INFINITY; ratios.len()]
}

#[cfg(test)]
mod tests;
