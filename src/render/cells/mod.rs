//! Pictures by cells: limit sets whose copies overlap or become flat, so that elements down to a detail are
//! far more numerous than pixels, or have no area.
//!
//! The picture shows the limit set itself: a pen at least a pixel wide is put on a point of each
//! [cell](crate::grow::LimitCells) that the set meets, so that it covers everything within half a pixel of
//! that point.

mod plan;

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use crate::geometry::{Bounds, DVec2};
use crate::graph::{Graph, Object, Replacement};
use crate::grow::{CellSearch, Field, FoundCells, Growth, Layer, LimitCells, Stopped, WalkError};
use crate::parallel::Team;
use crate::style::{Blend, ColorBy, Colour, Style};

use self::plan::LimitStyle;
use super::canvas::{Canvas, Size};
use super::classes::Classes;
use super::culling::NEARLY;
use super::drawing::Drawing;
use super::error::RenderError;
use super::layout::Layout;
use super::options::{Format, Options};
use super::paint::{FINE, Paint, Pen, Stroke, position};
use super::picture::{Empty, Picture};
use super::surface::Surface;

/// Numbers of cells along a pixel, in the order in which they are tried.
const FINENESS: [u8; 4] = [1, 2, 4, 8];

/// Number of images of points above which the next finer grid is not tried.
const WORTH: u64 = 12_000_000;

/// Maximum factor by which the number of cells grows when their sides are halved.
const MAX_TIMES: u64 = 4;

/// Maximum number of images of points.
const MAX_IMAGES: u64 = 400_000_000;

/// Maximum number of images of points if colours depend on steps.
const MAX_IMAGES_BY_STEPS: u64 = 250_000_000;

/// Maximum number of images of points if only a part of the set is shown, which may have few elements.
const MAX_IMAGES_ABOUT_A_WINDOW: u64 = 60_000_000;

/// Limit set on its canvas, as cells.
pub(super) struct Cells<'a> {
    canvas: Canvas,
    /// Number of lines and dots that are drawn.
    count: u64,
    /// Maximum number of maps that were applied to a point.
    steps: u32,
    style: &'a Style,
    pen: Pen,
    /// Ends of the lines and dots of each colour.
    layers: Vec<(Colour, Vec<[DVec2; 2]>)>,
}

/// Search for the cells of a picture.
struct CellFinder<'a> {
    set: LimitCells<'a>,
    options: &'a Options,
    cancel: Option<&'a AtomicBool>,
}

impl CellFinder<'_> {
    /// Finds the cells of a grid of `scale` cells per unit; by steps, if elements are replaced down to a
    /// length. `None` if that takes too much work.
    fn find(&self, scale: f64, shortest: Option<f64>) -> Result<Option<FoundCells>, RenderError> {
        let search = self.search(scale);
        self.done(match shortest {
            Some(shortest) => self.set.find_steps(&search, shortest),
            None => self.set.find(&search),
        })
    }

    /// Finds the bounding box of the set, for graphs that do not determine it. `None` if that takes too much
    /// work.
    fn bounds(&self) -> Result<Option<Bounds>, RenderError> {
        let long = match self.options.size {
            Size::Long(side) => side,
            Size::Exactly(width, height) => width.max(height),
        };
        self.done(self.set.bounds(&self.search(1.0), long.into()))
    }

    fn search(&self, scale: f64) -> CellSearch<'_> {
        CellSearch {
            scale,
            max_images: match self.options.view.window {
                Some(_) => MAX_IMAGES_ABOUT_A_WINDOW,
                None if self.options.style.color_by == ColorBy::Step => MAX_IMAGES_BY_STEPS,
                None => MAX_IMAGES,
            },
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

/// Returns whether a limit set is drawn by cells regardless of the number of its elements: its maps are
/// affine but not similarities, so that elements become flat.
fn becomes_flat(graph: &Graph) -> bool {
    graph.is_affine() && !graph.is_similar()
}

/// Returns the maximum number of elements of a limit set that is drawn by elements; pixels could not show
/// more.
fn max_elements(graph: &Graph, options: &Options, pixels: f64) -> f64 {
    let is_closed = |object: &Object| graph.base_elements()[object.base_element].is_closed();
    let mut drawn = graph.objects().iter().filter(|object| object.visible);
    // Lines are drawn in long runs, so that more of them are affordable.
    let to_a_pixel = if drawn.all(is_closed) { 2.0 } else { 8.0 };
    let [width, height] = match options.size {
        Size::Long(side) => [side; 2],
        Size::Exactly(width, height) => [width, height],
    };
    let finest = pixels.min(1.0);
    to_a_pixel * f64::from(width) * f64::from(height) / (finest * finest)
}

/// Estimates whether a graph of similarities has more than `most` elements down to a length, from their
/// numbers by object and logarithm of the length.
fn exceeds(graph: &Graph, shortest: f64, most: f64) -> bool {
    const AN_OCTAVE: f64 = 64.0;
    const MAX_WORK: usize = 4_000_000;
    let steps = |length: f64| (libm::log2(length) * AN_OCTAVE).round();
    let end = steps(shortest);
    // An outline of many pieces takes as long as several simple ones.
    let pieces = graph.base_elements().iter().map(|it| it.pieces().len());
    let worth: Vec<f64> = pieces
        .map(|pieces| (pieces as f64 / 4.0).max(1.0))
        .collect();
    let mut level: BTreeMap<(usize, i64), f64> = BTreeMap::new();
    let add = |level: &mut BTreeMap<_, _>, object: usize, at: f64, count: f64| -> f64 {
        let is_replaced = matches!(graph.objects()[object].replacement, Replacement::Fixed(_));
        if !is_replaced || at < end {
            return count * worth[graph.objects()[object].base_element];
        }
        #[expect(clippy::cast_possible_truncation, reason = "logarithms are small")]
        let sum: &mut f64 = level.entry((object, at as i64)).or_insert(0.0);
        *sum += count;
        0.0
    };
    let (mut stand, mut work) = (0.0, 0);
    for instance in &graph.initiator(0).instances {
        let at = steps(instance.frame.stretch());
        stand += add(&mut level, instance.object, at, 1.0);
    }
    while !level.is_empty() && stand <= most {
        for ((object, at), count) in std::mem::take(&mut level) {
            for (_, instance) in graph.children(object) {
                work += 1;
                #[expect(clippy::cast_precision_loss, reason = "logarithms are small")]
                let at = at as f64 + steps(instance.length);
                stand += add(&mut level, instance.object, at, count);
            }
        }
        if work > MAX_WORK {
            break;
        }
    }
    stand > most
}

/// Method by which a picture is drawn.
pub(super) enum DrawingMethod<'a> {
    Elements(Box<Layout<'a>>),
    Cells(Cells<'a>),
}

impl<'a> DrawingMethod<'a> {
    /// Chooses elements, unless the picture shows a limit set whose elements are too many or flat.
    pub(super) fn find(
        graph: &'a Graph,
        growth: &Growth<'a>,
        options: &'a Options,
    ) -> Result<Self, RenderError> {
        let elements = |growth: &Growth<'a>| {
            let layout = Layout::find(graph, growth, options)?;
            Ok(Self::Elements(Box::new(layout)))
        };
        // Cells do not know how many elements cover them.
        let is_joined = options.density().is_none() && options.style.blend == Blend::Joined;
        let detail = options.detail.filter(|_| is_joined);
        let Some(detail) = detail.filter(|detail| detail.decides_steps) else {
            return elements(growth);
        };
        let Some(mut plan) = LimitStyle::of(graph, options, detail.pixels) else {
            return elements(growth);
        };
        let shows_all = options.view.window.is_none();
        let by_cells = becomes_flat(graph)
            || shows_all && {
                let scale = plan.canvas(graph, options)?.map(|canvas| canvas.scale());
                let most = max_elements(graph, options, detail.pixels);
                scale.is_none_or(|scale| {
                    exceeds(graph, detail.pixels / (scale * graph.unit()), most)
                })
            };
        let mut cells = || Cells::of(graph, growth, options, &mut plan, detail.pixels);
        if by_cells && let Some(cells) = cells()? {
            return Ok(Self::Cells(cells));
        }
        match elements(growth) {
            Err(error) if options.format == Format::Png && !by_cells && is_too_much(&error) => {
                match cells()? {
                    Some(cells) => Ok(Self::Cells(cells)),
                    None => Err(error),
                }
            }
            found => found,
        }
    }
}

/// Returns whether an error refuses the number of elements.
fn is_too_much(error: &RenderError) -> bool {
    matches!(
        error,
        RenderError::Walk(WalkError::TooManyElements { .. } | WalkError::TooLong { .. })
    )
}

impl<'a> Cells<'a> {
    /// Describes the finished picture.
    pub(super) fn picture(&self) -> Picture {
        Picture {
            size: self.canvas.size(),
            window: Some(self.canvas.window()),
            steps: self.steps,
            elements: self.count,
            fractals: 1,
            is_part: false,
            empty: (self.count == 0).then(Empty::default),
            plotted: None,
            instanced: None,
            is_limit: true,
        }
    }

    /// Finds the cells of the limit set of a graph; `None` if that takes too much work.
    fn of(
        graph: &Graph,
        growth: &Growth<'_>,
        options: &'a Options,
        plan: &mut LimitStyle,
        pixels: f64,
    ) -> Result<Option<Self>, RenderError> {
        let canvas = plan.canvas(graph, options)?;
        let (colours, layers): (Vec<Colour>, Vec<Layer>) =
            std::mem::take(&mut plan.layers).into_iter().unzip();
        let finder = CellFinder {
            set: LimitCells::new(graph, &layers),
            options,
            cancel: growth.cancel,
        };
        let canvas = match canvas {
            Some(canvas) => canvas,
            None => match finder.bounds()? {
                Some(bounds) => plan.canvas_of(&bounds, options)?,
                None => return Ok(None),
            },
        };
        let is_exact = options.format == Format::Png;
        // If colours depend on steps, every cell is a pixel of one colour.
        let all: &[u8] = if is_exact && !plan.by_steps {
            &FINENESS
        } else {
            &FINENESS[..1]
        };
        let shortest = plan
            .by_steps
            .then(|| NEARLY * pixels / (canvas.scale() * graph.unit()));
        let mut found: Option<(u8, FoundCells)> = None;
        let mut expected = 0;
        for &fineness in all {
            if expected > WORTH {
                break;
            }
            let scale = canvas.scale() * f64::from(fineness) / pixels.max(1.0);
            let Some(next) = finder.find(scale, shortest)? else {
                break;
            };
            let before = found.as_ref().map_or(0, |(_, found)| found.images);
            let growth = next.images.checked_div(before).unwrap_or(MAX_TIMES) + 1;
            expected = next.images * growth.min(MAX_TIMES);
            found = Some((fineness, next));
        }
        let Some((fineness, FoundCells { fields, steps, .. })) = found else {
            return Ok(None);
        };
        let shown = canvas.shown(plan.pen.width);
        let is_shown = |[from, to]: [DVec2; 2]| shown.meets(&Bounds::new(from, to));
        let mut layers = Vec::new();
        if plan.by_steps {
            // As in approximants, colours do not depend on the window.
            let last = shortest.and_then(|it| graph.steps_to(libm::log2(it)));
            layers = labelled(&fields, graph, &options.style, last, is_shown);
            let shift = to_pixels(&canvas, pixels, &fields);
            let marks = layers.iter_mut().flat_map(|(_, marks)| marks);
            marks.flatten().for_each(|end| *end += shift);
        } else {
            for (colour, field) in colours.into_iter().zip(&fields) {
                // The pen covers the inner cells of the rows between.
                let step = i64::from(fineness / 2).max(1);
                let mut marks = Vec::new();
                for row in field.rows() {
                    let visit = |ends| marks.extend(is_shown(ends).then_some(ends));
                    if is_exact {
                        row.visit_points(row.number() % step == 0, visit);
                    } else {
                        row.visit_runs(visit);
                    }
                }
                layers.push((colour, marks));
            }
        }
        let count = layers.iter().map(|(_, marks)| marks.len() as u64).sum();
        if count > growth.max_elements {
            let limit = growth.max_elements;
            return Err(RenderError::Walk(WalkError::TooManyElements { limit }));
        }
        Ok(Some(Self {
            canvas,
            count,
            steps,
            style: &options.style,
            pen: plan.pen,
            layers,
        }))
    }
}

/// Returns the shift, by at most half a pixel along each axis, that moves the centres of cells to those of
/// pixels if both have the same size, so that each pixel has one colour.
fn to_pixels(canvas: &Canvas, pixels: f64, fields: &[Field]) -> DVec2 {
    let Some(field) = fields.first().filter(|_| pixels <= 1.0) else {
        return DVec2::ZERO;
    };
    let pixel = canvas.pixel(DVec2::splat(0.5 / field.scale()));
    let way = (pixel.floor() + 0.5 - pixel) / canvas.scale();
    DVec2::new(way.x, -way.y)
}

/// Returns the marks by class, in the order of the classes; labels are steps, the last of which is that of the whole set
/// where it is known.
fn labelled(
    fields: &[Field],
    graph: &Graph,
    style: &Style,
    last: Option<u32>,
    is_shown: impl Fn([DVec2; 2]) -> bool,
) -> Vec<(Colour, Vec<[DVec2; 2]>)> {
    let mut marks: Vec<(u16, [DVec2; 2])> = Vec::new();
    for row in fields.iter().flat_map(Field::rows) {
        row.visit_labels(|label, ends| marks.extend(is_shown(ends).then_some((label, ends))));
    }
    let labels = marks.iter().map(|(label, _)| u32::from(*label));
    let last = labels.chain(last).max().unwrap_or(0);
    let classes = Classes::before_survey(style, graph, last);
    let mut layers: Vec<(Colour, Vec<[DVec2; 2]>)> = { classes.all() }
        .map(|class| {
            (
                classes.colour(class, style).unwrap_or(style.polygons()),
                Vec::new(),
            )
        })
        .collect();
    for (label, ends) in marks {
        if let Ok(class) = usize::try_from(classes.of_value(label.into())) {
            layers[class].1.push(ends);
        }
    }
    layers.retain(|(_, marks)| !marks.is_empty());
    layers
}

impl Drawing for Cells<'_> {
    fn size(&self) -> [u32; 2] {
        self.canvas.size()
    }

    fn background(&self) -> Option<Colour> {
        self.style.ground()
    }

    fn pen(&self) -> Pen {
        self.pen
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let place = |point: DVec2| position(self.canvas.pixel(point) * FINE);
        for (colour, marks) in &self.layers {
            let (colour, pen) = (*colour, self.pen);
            surface.begin(&Paint {
                fill: None,
                stroke: Some(Stroke { colour, pen }),
                has_holes: false,
            })?;
            for ends in marks {
                let [from, to] = ends.map(place);
                surface.move_to(from);
                surface.line_to(to);
                surface.hand_on()?;
            }
            surface.end()?;
        }
        Ok(())
    }
}
