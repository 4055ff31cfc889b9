//! Pictures by cells: limit sets whose copies overlap, or become flat, so that elements to a detail are
//! far more than pixels or have no area.
//!
//! What is drawn is the limit set itself, as a pen of no less than a pixel goes over a point of each
//! [cell](crate::grow::LimitCells) that it meets: all that lies within half a pixel of it.

use std::sync::atomic::AtomicBool;

use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::graph::{Graph, Object, Replacement};
use crate::grow::{Field, Found, Growth, Layer, LimitCells, Search, Stopped, WalkError};
use crate::parallel::Team;
use crate::style::{Cap, ColorBy, Colour, Join, Style, Width};
use crate::whole::whole;

use super::layout::Layout;
use super::sight::starts_rings;
use super::surface::{FINE, Paint, Pen, Stroke, Surface, position};
use super::{Canvas, Classes, Drawing, Empty, Format, NoRoom, Options, Picture, RenderError, Size};

/// Cells along a pixel: the finest of these that takes not too much work.
const FINENESS: [u8; 4] = [1, 2, 4, 8];

/// Images of points that are worth a finer look.
const WORTH: u64 = 12_000_000;

/// There are no more than so many times as many cells of half a size.
const MOST_TIMES: u64 = 4;

/// The most images of points.
const MOST_IMAGES: u64 = 400_000_000;

/// Objects that are looked into for one colour of all that becomes of them.
const MOST_PARTS: usize = 1 << 12;

/// A limit set on its canvas, by cells.
pub(super) struct Cells<'a> {
    canvas: Canvas,
    /// The number of lines and dots that are drawn.
    count: u64,
    /// The most maps that were applied to a point.
    steps: u32,
    style: &'a Style,
    pen: Pen,
    /// Of this many rows that lie within others one is drawn: more would add nothing.
    step: i64,
    /// Whether pixels are drawn, so that points are drawn where they are.
    is_exact: bool,
    /// What part of the plane can be seen.
    shown: Bounds,
    layers: Vec<(Colour, Field)>,
}

/// What is to be drawn.
struct Plan {
    layers: Vec<(Colour, Layer)>,
    pen: Pen,
}

/// What finds cells.
struct Finder<'a> {
    set: LimitCells<'a>,
    options: &'a Options,
    cancel: Option<&'a AtomicBool>,
}

impl Finder<'_> {
    /// The cells of a size; `None` where that takes too much work.
    fn find(&self, scale: f64) -> Result<Option<Found>, RenderError> {
        self.done(self.set.find(&self.search(scale)))
    }

    /// The box of the set, where the graph does not tell it.
    fn bounds(&self) -> Result<Option<Bounds>, RenderError> {
        let long = match self.options.size {
            Size::Long(side) => side,
            Size::Exactly(width, height) => width.max(height),
        };
        self.done(self.set.bounds(&self.search(1.0), long.into()))
    }

    fn search(&self, scale: f64) -> Search<'_> {
        Search {
            scale,
            most_images: MOST_IMAGES,
            threads: self.options.threads,
            cancel: self.cancel,
        }
    }

    fn done<T>(&self, found: Result<T, Stopped>) -> Result<Option<T>, RenderError> {
        match found {
            Ok(found) => Ok(Some(found)),
            Err(Stopped::TooMany) => Ok(None),
            Err(Stopped::Cancelled) => Err(RenderError::Walk(WalkError::Cancelled)),
        }
    }
}

/// Whether a limit set is drawn by cells without a look at its elements: its copies are no similar ones, and
/// become flat.
fn becomes_flat(graph: &Graph) -> bool {
    graph.is_affine() && !graph.is_similar()
}

/// The most elements of a limit set that is drawn by elements: more than its pixels could tell.
fn most_elements(options: &Options, pixels: f64) -> u64 {
    const TO_A_PIXEL: f64 = 8.0;
    let [width, height] = match options.size {
        Size::Long(side) => [side; 2],
        Size::Exactly(width, height) => [width, height],
    };
    let finest = pixels.min(1.0);
    whole(TO_A_PIXEL * f64::from(width) * f64::from(height) / (finest * finest)) as u64
}

/// How a picture is drawn.
pub(super) enum Way<'a> {
    Elements(Box<Layout<'a>>),
    Cells(Cells<'a>),
}

impl<'a> Way<'a> {
    /// By elements, unless what is drawn is a limit set whose elements are too many, or flat.
    pub(super) fn find(
        graph: &'a Graph,
        growth: &Growth<'a>,
        options: &'a Options,
    ) -> Result<Self, RenderError> {
        let elements = |growth: &Growth<'a>| {
            let layout = Layout::find(graph, growth, options)?;
            Ok(Self::Elements(Box::new(layout)))
        };
        let Some(detail) = options.detail.filter(|detail| detail.decides_steps) else {
            return elements(growth);
        };
        let cells = || Cells::of(graph, growth, options, detail.pixels);
        if becomes_flat(graph) {
            return match cells()? {
                Some(cells) => Ok(Self::Cells(cells)),
                None => elements(growth),
            };
        }
        let most_elements = most_elements(options, detail.pixels);
        let limited = |most_elements: u64| {
            elements(&Growth {
                most_elements,
                ..*growth
            })
        };
        let found = limited(most_elements.min(growth.most_elements));
        let mut are_too_many = has_too_many(&found);
        if are_too_many && options.format != Format::Png {
            // Paths of few elements are better drawn coarser than by cells.
            are_too_many = has_too_many(&limited(most_elements));
        }
        if !are_too_many {
            return found;
        }
        match (cells()?, found) {
            (Some(cells), _) => Ok(Self::Cells(cells)),
            (None, Ok(found)) => Ok(found),
            (None, Err(_)) => elements(growth),
        }
    }
}

/// Whether there are more elements than allowed, or than have been counted.
fn has_too_many(found: &Result<Way<'_>, RenderError>) -> bool {
    match found {
        Ok(Way::Elements(layout)) => layout.survey.has_more,
        Err(RenderError::Walk(error)) => matches!(
            error,
            WalkError::TooManyElements { .. } | WalkError::TooLong { .. }
        ),
        _ => false,
    }
}

impl<'a> Cells<'a> {
    /// What has been drawn.
    pub(super) fn picture(&self) -> Picture {
        Picture {
            size: self.canvas.size(),
            steps: self.steps,
            elements: self.count,
            has_more: false,
            fractals: 1,
            is_part: false,
            empty: (self.count == 0).then(Empty::default),
            plotted: None,
            instanced: None,
            is_limit: true,
        }
    }

    /// The limit set of a graph, where it can be drawn so.
    fn of(
        graph: &Graph,
        growth: &Growth<'_>,
        options: &'a Options,
        pixels: f64,
    ) -> Result<Option<Self>, RenderError> {
        let Some(plan) = Plan::of(graph, options, pixels) else {
            return Ok(None);
        };
        let (colours, layers): (Vec<Colour>, Vec<Layer>) = plan.layers.into_iter().unzip();
        let finder = Finder {
            set: LimitCells::new(graph, &layers),
            options,
            cancel: growth.cancel,
        };
        let bounds = match graph.limit_bounds() {
            Some(bounds) => Some(bounds),
            None => finder.bounds()?,
        };
        let Some(bounds) = bounds else {
            return Ok(None);
        };
        let canvas = match options.view.window {
            Some(window) => Canvas::of_window(window, &options.view, options.size)?,
            None => {
                let room = options.view.margin + plan.pen.width / 2.0;
                Canvas::fit(&bounds, options.size, room)?
            }
        };
        if !canvas.holds(&bounds) {
            return Err(NoRoom::TooClose.into());
        }
        let is_exact = options.format == Format::Png;
        let all: &[u8] = if is_exact { &FINENESS } else { &FINENESS[..1] };
        let mut found: Option<(u8, Found)> = None;
        let mut expected = 0;
        for &fineness in all {
            if expected > WORTH {
                break;
            }
            let scale = canvas.scale() * f64::from(fineness) / pixels.max(1.0);
            let Some(next) = finder.find(scale)? else {
                break;
            };
            let before = found.as_ref().map_or(0, |(_, found)| found.images);
            let growth = next.images.checked_div(before).unwrap_or(MOST_TIMES) + 1;
            expected = next.images * growth.min(MOST_TIMES);
            found = Some((fineness, next));
        }
        let Some((fineness, Found { fields, steps, .. })) = found else {
            return Ok(None);
        };
        let mut cells = Self {
            canvas,
            count: 0,
            steps,
            style: &options.style,
            pen: plan.pen,
            step: i64::from(fineness / 2).max(1),
            is_exact,
            shown: canvas.shown(plan.pen.width),
            layers: colours.into_iter().zip(fields).collect(),
        };
        let mut count = 0;
        for (_, field) in &cells.layers {
            cells.visit(field, |_| count += 1);
        }
        cells.count = count;
        if !is_exact && count > growth.most_elements {
            let limit = growth.most_elements;
            return Err(RenderError::Walk(WalkError::TooManyElements { limit }));
        }
        Ok(Some(cells))
    }

    /// Visits what the pen draws: lines, or dots.
    fn visit(&self, field: &Field, mut visit: impl FnMut([DVec2; 2])) {
        let mut see = |[from, to]: [DVec2; 2]| {
            if self.shown.meets(&Bounds::new(from, to)) {
                visit([from, to]);
            }
        };
        for row in field.rows() {
            if self.is_exact {
                row.visit_points(row.number() % self.step == 0, &mut see);
            } else {
                row.visit_runs(&mut see);
            }
        }
    }
}

impl Plan {
    fn of(graph: &Graph, options: &Options, pixels: f64) -> Option<Self> {
        let style = &options.style;
        let is_known = graph.is_plain()
            && graph.depth().is_none()
            && !graph.is_levelled()
            && graph.roots.elements.is_empty()
            && !graph.resets().contains(&true);
        let is_told = match style.color_by {
            ColorBy::None | ColorBy::Hits => true,
            ColorBy::Tint => !graph.tints(),
            ColorBy::Generator | ColorBy::FirstMap | ColorBy::LastMap => true,
            ColorBy::Step
            | ColorBy::Age
            | ColorBy::Fractal
            | ColorBy::Index
            | ColorBy::Direction => false,
        };
        let fills_rings = style.fill.is_some() && starts_rings(graph);
        if !is_known || !is_told || fills_rings || options.plot || !graph.contracts() {
            return None;
        }
        let drawn = graph.objects().iter().filter(|object| object.visible);
        let is_closed = |object: &&Object| graph.base_elements()[object.base_element].is_closed();
        let is_kept = |object: &&Object| matches!(object.replacement, Replacement::Kept);
        let all_closed = drawn.clone().all(|object| is_closed(&object));
        let any_closed = drawn.clone().any(|object| is_closed(&object));
        // What is replaced is a dot in the end.
        let kept: Vec<&Object> = drawn.filter(is_kept).collect();
        let outlines = any_closed && style.outlines_polygons();
        let has_two_colours = !all_closed && any_closed && style.lines() != style.polygons();
        if has_two_colours || outlines && kept.iter().any(is_closed) {
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
        let classes = Classes::before_survey(style.color_by, graph, 0);
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
        })
    }
}

/// What is drawn of each class, in the order of the classes: objects all of whose becoming is of one.
fn layers(graph: &Graph, classes: &Classes) -> Option<Vec<(u64, Layer)>> {
    let of_object = |object: usize| match classes.count() {
        1 => Some(0),
        _ => classes.of_object(&graph.objects()[object]),
    };
    let start = graph.initiator(0).instances.iter();
    let mut open: Vec<(DAffine2, usize)> = start.map(|it| (it.frame.map, it.object)).collect();
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
        if looked_at > MOST_PARTS {
            return None;
        }
        let mut of = (0..).zip(&leading).filter(|(_, leading)| leading[object]);
        match (of.next(), of.next()) {
            (None, _) => {}
            (Some((class, _)), None) => layers[class].1.push((map, object)),
            _ => match &graph.objects()[object].replacement {
                Replacement::Fixed(_) => {
                    let children = graph.children(object);
                    open.extend(children.map(|(_, it)| (map * it.frame.map, it.object)));
                }
                _ => return None,
            },
        }
    }
    layers.retain(|(_, layer)| !layer.is_empty());
    Some(layers)
}

impl Drawing for Cells<'_> {
    fn size(&self) -> [u32; 2] {
        self.canvas.size()
    }

    fn background(&self) -> Option<Colour> {
        self.style.background
    }

    fn pen(&self) -> Pen {
        self.pen
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let place = |point: DVec2| position(self.canvas.pixel(point) * FINE);
        for (colour, field) in &self.layers {
            let (colour, pen) = (*colour, self.pen);
            surface.begin(&Paint {
                fill: None,
                stroke: Some(Stroke { colour, pen }),
            })?;
            let mut drawn = Ok(());
            self.visit(field, |ends| {
                let [from, to] = ends.map(place);
                surface.move_to(from);
                surface.line_to(to);
                if drawn.is_ok() {
                    drawn = surface.hand_on();
                }
            });
            drawn?;
            surface.end()?;
        }
        Ok(())
    }
}
