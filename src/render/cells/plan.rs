//! Plan of a picture by cells: whether cells can show a limit set, their colours, and the pen.

use crate::geometry::{Bounds, DAffine2};
use crate::graph::{Graph, Object, Replacement};
use crate::grow::Layer;
use crate::render::canvas::{Canvas, NoRoom};
use crate::render::classes::Classes;
use crate::render::culling::starts_rings;
use crate::render::error::RenderError;
use crate::render::options::Options;
use crate::render::paint::Pen;
use crate::style::{Cap, ColorBy, ColorProperty, Colour, Join, Width};

/// Maximum number of instances that are examined in the search for layers of one class.
const MAX_PARTS: usize = 1 << 12;

/// Colours, layers and pen of a picture.
pub(super) struct LimitStyle {
    pub(super) layers: Vec<(Colour, Layer)>,
    pub(super) pen: Pen,
    /// Whether colours depend on steps.
    pub(super) by_steps: bool,
}

impl LimitStyle {
    /// Returns the canvas of the limit set, if the graph determines its bounding box.
    pub(super) fn canvas(
        &self,
        graph: &Graph,
        options: &Options,
    ) -> Result<Option<Canvas>, RenderError> {
        let bounds = graph.limit_bounds();
        bounds.map(|it| self.canvas_of(&it, options)).transpose()
    }

    pub(super) fn canvas_of(
        &self,
        bounds: &Bounds,
        options: &Options,
    ) -> Result<Canvas, RenderError> {
        let Options { view, size, .. } = options;
        let canvas = match view.window {
            Some(window) => Canvas::of_window(window, view, *size)?,
            None => Canvas::fit(bounds, *size, view.pad() + self.pen.width / 2.0)?,
        };
        if !canvas.holds(bounds) {
            return Err(NoRoom::TooClose.into());
        }
        Ok(canvas)
    }

    pub(super) fn of(graph: &Graph, options: &Options, pixels: f64) -> Option<Self> {
        let style = &options.style;
        let is_known = graph.is_plain()
            && graph.depth().is_none()
            && !graph.is_time_indexed()
            && graph.roots.elements.is_empty()
            && !graph.resets().contains(&true);
        let is_determined = match style.color_by.property() {
            ColorProperty::Uniform | ColorProperty::Object | ColorProperty::Step => true,
            ColorProperty::Tint => !graph.tints(),
            _ => false,
        };
        let fills_rings = style.fill.is_some() && starts_rings(graph);
        let is_much = graph.has_many_behaviours();
        if !is_known
            || !is_determined
            || fills_rings
            || options.plot
            || is_much
            || !graph.contracts()
        {
            return None;
        }
        let drawn = graph.objects().iter().filter(|object| object.visible);
        let is_closed = |object: &&Object| graph.base_elements()[object.base_element].is_closed();
        let is_kept = |object: &&Object| matches!(object.replacement, Replacement::Kept);
        let all_closed = drawn.clone().all(|object| is_closed(&object));
        let any_closed = drawn.clone().any(|object| is_closed(&object));
        // In the limit, an element that is always replaced is a dot.
        let kept: Vec<&Object> = drawn.filter(is_kept).collect();
        let outlines = any_closed && style.outlines_polygons();
        let has_two_colours = !all_closed && any_closed && style.lines() != style.polygons();
        let is_linked = |object: &&Object| {
            let base_element = &graph.base_elements()[object.base_element];
            !base_element.is_closed() && base_element.ends_meet_frame() != [true; 2]
        };
        let are_linked = graph.joins() && kept.iter().any(is_linked);
        if has_two_colours || are_linked || outlines && kept.iter().any(is_closed) {
            return None;
        }
        let has_own_widths = graph.widest().is_some() && !kept.is_empty();
        let least = pixels.max(1.0);
        let width = match style.width {
            _ if all_closed && !outlines => least,
            _ if has_own_widths => return None,
            Width::Pixels(width) => width.max(least),
            Width::Relative(_) if kept.is_empty() => least,
            Width::Relative(_) => return None,
        };
        // Steps are distinguished within a layer.
        let classes = Classes::before_survey(style, graph, 0);
        let layers = layers(graph, &classes)?;
        let own = if all_closed && !outlines {
            style.polygons()
        } else {
            style.lines()
        };
        let layers = layers.into_iter();
        Some(Self {
            layers: layers
                .map(|(class, layer)| (classes.colour(class, style).unwrap_or(own), layer))
                .collect(),
            pen: Pen {
                width,
                cap: Cap::Round,
                join: Join::Round,
                dash: 0.0,
            },
            by_steps: style.color_by == ColorBy::Step,
        })
    }
}

/// Returns the layers of each class, in the order of the classes. A layer consists of instances whose
/// descendants are all of one class. `None` if there are too many, or if classes are not known by object.
fn layers(graph: &Graph, classes: &Classes) -> Option<Vec<(u64, Layer)>> {
    let of_object = |object: usize| match classes.count() {
        1 => Some(0),
        _ => classes.of_object(&graph.objects()[object]),
    };
    let start = graph.initiator(0).instances.iter();
    let mut open: Vec<(DAffine2, usize)> = start.map(|it| (*it.frame.map(), it.object)).collect();
    let own: Option<Vec<u64>> = (0..graph.objects().len()).map(of_object).collect();
    let own = own?;
    let leading: Vec<Vec<bool>> = classes
        .all()
        .map(|class| {
            graph.leading_to(|object| graph.objects()[object].visible && own[object] == class)
        })
        .collect();
    let mut layers: Vec<(u64, Layer)> = classes.all().map(|class| (class, Vec::new())).collect();
    let mut looked_at = 0;
    while let Some((map, object)) = open.pop() {
        looked_at += 1;
        if looked_at > MAX_PARTS {
            return None;
        }
        let mut of = (0..).zip(&leading).filter(|(_, leading)| leading[object]);
        match (of.next(), of.next()) {
            (None, _) => {}
            (Some((class, _)), None) => layers[class].1.push((map, object)),
            _ => match &graph.objects()[object].replacement {
                Replacement::Fixed(_) => {
                    let children = graph.children(object);
                    open.extend(children.map(|(_, it)| (map * it.frame.map(), it.object)));
                }
                _ => return None,
            },
        }
    }
    layers.retain(|(_, layer)| !layer.is_empty());
    Some(layers)
}
