//! Pictures of small parts of a set at arbitrary magnification.

use std::io::Write;

use crate::expression::degrees;
use crate::geometry::DVec2;
use crate::graph::Graph;
use crate::grow::Growth;
use crate::model::Model;
use crate::style::{ColorBy, ColorProperty, Style, View, Width};
use crate::zoom::{self, Address, Factor, ZoomWindow};

use super::canvas::{Canvas, Size};
use super::culling::{NEARLY, starts_rings};
use super::error::{NoZoom, RenderError};
use super::layout::Layout;
use super::options::{Detail, Options};
use super::paint::{overhang, relative_overhang};
use super::picture::{NearestPoint, Picture};
use super::pixels::Pixels;

/// Target of a zoomed picture.
#[derive(Clone, Debug)]
pub struct ZoomTarget {
    /// Magnification relative to the picture of the whole set.
    pub factor: Factor,
    /// Point at the centre of the picture.
    pub at: Address,
    /// Angle in degrees by which the set is turned about that point, counter-clockwise.
    pub turn: f64,
}

impl ZoomTarget {
    /// Creates a target without a turn.
    #[must_use]
    pub fn new(factor: Factor, at: Address) -> Self {
        let turn = 0.0;
        Self { factor, at, turn }
    }
}

/// Writes a picture centred on a point, of the size of the picture of the whole set and magnified relative to
/// it. If the file has a window, that window is the whole.
///
/// Elements are replaced down to the detail of the options, by default a pixel. The cost does not depend on
/// the magnification, except for the length of the numbers (see [`zoom`](crate::zoom)).
///
/// # Errors
///
/// Returns an error under the conditions of [`write`](super::write), and if the point does not exist.
pub fn write_zoomed(
    model: &Model,
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
    target: &ZoomTarget,
    out: &mut impl Write,
) -> Result<Picture, RenderError> {
    let zoomed = Zoomed::find(model, graph, growth, options, target)?;
    let growth = Growth {
        steps: zoomed.steps,
        ..*growth
    };
    let mut picture = super::write(&zoomed.graph, &growth, &zoomed.options, out)?;
    picture.window = shown(&zoomed.canvas, target);
    if let (Some(empty), true, Some(middle)) =
        (&mut picture.empty, zoomed.to_limit, target.at.near())
    {
        let half = f64::from(zoomed.canvas.size().into_iter().fold(u32::MAX, u32::min)) / 2.0;
        empty.nearest = zoom::distance(graph, middle).map(|distance| NearestPoint {
            distance,
            factor: half / (distance * zoomed.canvas.scale()),
        });
    }
    Ok(picture)
}

/// Draws the picture of [`write_zoomed`] as pixels in memory.
///
/// # Errors
///
/// As for [`write_zoomed`].
pub fn pixels_zoomed(
    model: &Model,
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
    target: &ZoomTarget,
) -> Result<Pixels, RenderError> {
    let zoomed = Zoomed::find(model, graph, growth, options, target)?;
    let growth = Growth {
        steps: zoomed.steps,
        ..*growth
    };
    super::pixels(&zoomed.graph, &growth, &zoomed.options)
}

/// The part of a set about a point, as a set of its own in pixels.
struct Zoomed {
    graph: Graph,
    steps: u32,
    options: Options,
    /// Canvas of the whole set.
    canvas: Canvas,
    /// Whether elements are replaced without a limit of steps.
    to_limit: bool,
}

impl Zoomed {
    fn find(
        model: &Model,
        graph: &Graph,
        growth: &Growth<'_>,
        options: &Options,
        target: &ZoomTarget,
    ) -> Result<Self, RenderError> {
        let style = &options.style;
        zoom::check(model, graph)?;
        check(style)?;
        let canvas = whole(graph, growth, options)?;
        let (stroke, relative_stroke) = match style.width {
            Width::Pixels(width) => (width * overhang(style), 0.0),
            Width::Relative(width) => (0.0, width * graph.unit() * relative_overhang(style)),
        };
        let size = canvas.size();
        let pixels = options.detail.map_or(1.0, |detail| detail.pixels);
        let window = ZoomWindow {
            // A window that is turned lies in the square around its circle.
            size: match target.turn == 0.0 {
                true => size,
                false => around(size),
            },
            scale: canvas.scale(),
            margin: stroke + 2.0,
            relative_stroke,
            areas: style.fill.is_some() && starts_rings(graph) && graph.keeps_lines(),
            shortest: pixels,
            factor: target.factor.clone(),
            at: target.at.clone(),
        };
        let steps = options.detail.filter(|detail| !detail.decides_steps);
        let to_limit = steps.is_none();
        let zoom_growth = zoom::ZoomOptions {
            seed: growth.seed,
            steps: steps.map(|_| growth.steps),
            cancel: growth.cancel,
        };
        let found = zoom::zoom(model, graph, &zoom_growth, &window)?;
        // Colours by step are those of the whole at this magnification, as far as it determines them.
        let of_whole = || {
            let pixel = canvas.scale() * graph.unit();
            let shortest = libm::log2(NEARLY * pixels / pixel) - target.factor.log2();
            graph.steps_to(shortest)
        };
        let (steps, decides_steps) = match (steps, graph.depth()) {
            (Some(_), _) => (growth.steps, false),
            (None, Some(depth)) => (depth, true),
            (None, None) => match of_whole() {
                Some(steps) => (steps.max(found.deepest), false),
                None => (found.deepest.saturating_add(growth.steps), true),
            },
        };
        let [width, height] = size.map(f64::from);
        let options = Options {
            view: View {
                window: Some([-width / 2.0, -height / 2.0, width, height]),
                margin: None,
            },
            size: Size::Exactly(size[0], size[1]),
            detail: Some(Detail {
                pixels,
                decides_steps,
            }),
            ..options.clone()
        };
        Ok(Self {
            graph: found.graph.turned(target.turn),
            steps,
            options,
            canvas,
            to_limit,
        })
    }
}

/// Returns the square around the circle around a picture, in pixels.
fn around([width, height]: [u32; 2]) -> [u32; 2] {
    let across = libm::hypot(width.into(), height.into()).ceil();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "beyond the range is the largest number"
    )]
    let across = across as u32;
    [across; 2]
}

/// Returns the window about a point, where doubles hold it.
fn shown(canvas: &Canvas, look: &ZoomTarget) -> Option<[f64; 4]> {
    let middle = look.at.near()?;
    let middle = DVec2::from_array(degrees::turned(middle.into(), look.turn));
    let scale = canvas.scale() * libm::exp2(look.factor.log2());
    let [width, height] = canvas.size().map(|side| f64::from(side) / scale);
    let window = [
        middle.x - width / 2.0,
        middle.y - height / 2.0,
        width,
        height,
    ];
    window.iter().all(|it| it.is_finite()).then_some(window)
}

/// Returns the canvas of the whole set: of the limit set if its bounding box is known, otherwise of an
/// approximant to a rough detail.
fn whole(graph: &Graph, growth: &Growth<'_>, options: &Options) -> Result<Canvas, RenderError> {
    let Options {
        style, view, size, ..
    } = options;
    if let Some(window) = view.window {
        return Ok(Canvas::of_window(window, view, *size)?);
    }
    if let (Some(bounds), Width::Pixels(width)) = (graph.limit_bounds(), style.width) {
        let pad = view.pad() + width * overhang(style);
        return Ok(Canvas::fit(&bounds, *size, pad)?);
    }
    let rough = Options {
        detail: Some(Detail {
            pixels: ROUGH * size.long_side(),
            decides_steps: true,
        }),
        ..options.clone()
    };
    Ok(Layout::find(graph, growth, &rough)?.canvas)
}

/// Detail of that approximant, as a fraction of the picture's longer side.
const ROUGH: f64 = 1.0 / 256.0;

fn check(style: &Style) -> Result<(), RenderError> {
    if matches!(style.color_by, ColorBy::Index | ColorBy::Fractal) {
        return Err(NoZoom::Numbers.into());
    }
    let is_by_frame = style.color_by.property() == ColorProperty::Frame;
    if is_by_frame && style.color_by != ColorBy::Angle && style.color_range.is_some() {
        return Err(NoZoom::Range.into());
    }
    Ok(())
}
