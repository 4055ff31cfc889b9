//! Occlusion: elements are left out if all pixels that they would cover are covered already.

use std::sync::Arc;

use crate::geometry::DVec2;
use crate::graph::Graph;
use crate::grow::Subtree;
use crate::style::{ColorBy, Style, Width};

use super::covered::CoveredPixels;
use super::culling::own_reach;
use super::png::WIDEST_COVERED;
use super::prepass::overhang;
use super::scene::{Pass, Scene};
use super::sketch::stands_alone;

/// Maximum number of sweeps in the search for the longest descendants.
const MOST_SWEEPS: usize = 64;

/// Upper bound of the distance, in pixels, by which filled shapes are drawn beyond their outlines: shapes
/// narrower than a pixel are drawn a pixel wide.
const BROADENED: f64 = 0.75;

/// Occlusion of a pass: determines the elements that need not be drawn, since they lie where everything is
/// covered already.
///
/// The invariant is that a picture is the same to the bit whether anything is left out or not. Therefore the
/// coverage by other threads that a thread knows of does not matter, nor when it knows of it, nor the number
/// of threads. The invariant holds because
///
/// - everything that occludes has been drawn already, and is drawn once: nothing is occluded by itself, or by
///   elements that may yet be left out;
/// - complete coverage in one opaque colour neither grows nor changes; of areas and strokes in two colours,
///   which are one path, the strokes lie on top and occlude both;
/// - elements that are left out join nothing: lines that continue behind them begin where everything is
///   covered, and no caps or corners are visible there;
/// - all of them would be drawn as coverage, which has no order. Paths that are divided by the number of
///   their vertices may have seams; elements that are drawn by such paths are not left out.
pub(super) struct Occlusion {
    filled: Arc<CoveredPixels>,
    /// Layer of the first class.
    pub(super) first: u64,
    /// By object, radius of its descendants about the centre of its frame, as a multiple of its length.
    reaches: Arc<[f64]>,
    /// Distance, in pixels, by which drawing may exceed that radius.
    overhang: f64,
    /// By object, upper bound of the stroke widths of its descendants, as a multiple of its length; empty if
    /// widths are in pixels.
    widths: Vec<f64>,
}

impl Occlusion {
    /// Returns whether any elements of a pass may be left out.
    pub(super) fn may_be(scene: &Scene<'_>, pass: Pass) -> bool {
        let Scene { graph, style, .. } = scene;
        let numbers_change = match style.color_by {
            // If classes occur in order, spans of one class are recognised.
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

    /// Creates the occlusion of a scene.
    pub(super) fn new(scene: &Scene<'_>, filled: Arc<CoveredPixels>) -> Self {
        let Scene { graph, style, .. } = scene;
        let reaches = graph.reaches(|object| own_reach(graph, object, style));
        Self {
            filled,
            first: CoveredPixels::layers(scene.classes.count()),
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

    /// Returns whether all lines are narrow enough to be drawn as coverage, if widths are in pixels; if
    /// widths are relative, some may be.
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

    /// Returns an upper bound of the distance, in pixels, from the centre of an element's frame at which its
    /// descendants are drawn.
    #[inline]
    pub(super) fn reach(&self, scene: &Scene<'_>, object: usize, length: f64) -> f64 {
        self.reach_of(scene, self.reaches[object], length)
    }

    /// Returns the reach in pixels of a set whose radius is given as a multiple of its length.
    #[inline]
    pub(super) fn reach_of(&self, scene: &Scene<'_>, radius: f64, length: f64) -> f64 {
        radius * scene.canvas.scale() * length + self.overhang
    }

    /// Returns the radius about the centre of its frame of the descendants of an object, without strokes in
    /// pixels, as a multiple of its length.
    pub(super) fn radius(&self, object: usize) -> f64 {
        self.reaches[object]
    }

    /// Returns whether all descendants of an element, which are of one class, are occluded.
    #[inline]
    pub(super) fn hides(&self, scene: &Scene<'_>, subtree: &Subtree, class: u64) -> bool {
        // The image of a disc is as wide and as high as the rows of the map are long.
        let rows = subtree.frame.map().matrix2.transpose();
        let [x, y] = [rows.x_axis, rows.y_axis].map(DVec2::length);
        let reach = [x, y].map(|length| self.reach(scene, subtree.object, length));
        let middle = subtree.frame.apply(scene.graph.middle());
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

/// Returns, by object, an upper bound of the lengths of its descendants, as a multiple of its length.
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
