//! Plots: pictures as polylines for pen plotters and cutters.
//!
//! The paths of a picture, including outlines of filled areas, become strokes. Parts that lie under filled areas are
//! removed, and areas may be hatched. Edges that repeat earlier ones are removed, strokes whose ends meet are joined, and the order of strokes is improved to shorten the
//! movements of the raised pen. Each pen has a layer, of one colour or of several similar ones. If two pens
//! draw the same edge, the layer that begins later keeps it, because it lies on top in the picture.
//!
//! A plot is held in memory: some hundred bytes for each edge.

mod areas;
mod clip;
#[cfg(feature = "contours")]
mod contours;
mod hatch;
mod merge;
mod occlusion;
mod order;
mod pens;
mod plotter;
mod points;
mod strokes;
mod tree;
mod unique;
mod visible;

use std::sync::atomic::{AtomicBool, Ordering};

use crate::geometry::DVec2;
use crate::grow::WalkError;
use crate::parallel::{Team, with_team};
use crate::style::Colour;

use super::drawing::Drawing;
use super::error::RenderError;
use super::options::Options;
use super::paint::{FINE, Paint, Pen, Position, Stroke};
use super::surface::Surface;
use super::unit::Unit;
use merge::merged;
use order::{Order, Traversal};
use pens::shared;
use plotter::{Fills, Plotter};
use points::{Point, vector};
use strokes::{Strokes, is_closed};
use unique::Unique;
use visible::Visible;

pub use hatch::{Hatch, HatchPattern};
pub use pens::Pens;

/// Extent of a plot.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Plotted {
    /// Number of strokes, each after a lift of the pen.
    pub strokes: u64,
    /// Number of layers, one for each pen.
    pub layers: u64,
    /// Number of colours of these pens.
    pub colours: u64,
    /// Distance that is drawn, in millimetres.
    pub drawn: f64,
    /// Distance that raised pens are moved, in millimetres: in every layer from the first stroke on.
    pub carried: f64,
    /// Distance that raised pens would be moved if the strokes had the order of the picture, in millimetres.
    pub carried_as_drawn: f64,
    /// The pens, in the order of drawing.
    pub pens: Vec<PlottedPen>,
    /// Number of edges, or pieces of edges, that are left out as repetitions.
    pub repeated: u64,
    /// Number of edges, and of lines of the hatching, that lie under filled areas in whole or in part.
    pub hidden: u64,
}

/// Extent of the strokes of a pen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlottedPen {
    /// Colour of the layer.
    pub colour: Colour,
    /// Number of strokes.
    pub strokes: u64,
    /// Distance that is drawn, in millimetres.
    pub drawn: f64,
    /// Distance that the raised pen is moved from the first stroke on, in millimetres.
    pub carried: f64,
}

/// The page of a plot in millimetres, with y up from its lower left corner.
#[derive(Clone, Copy)]
pub(super) struct Page {
    scale: f64,
    size: [f64; 2],
}

impl Page {
    /// Returns the page of a plot.
    pub(super) fn of(plot: &Plot, unit: Unit) -> Self {
        Self {
            scale: unit.millimetres() / FINE,
            size: plot.size.map(|side| f64::from(side) * unit.millimetres()),
        }
    }

    /// Returns width and height.
    pub(super) fn size(&self) -> [f64; 2] {
        self.size
    }

    /// Returns the coordinates of a position.
    #[expect(
        clippy::cast_precision_loss,
        reason = "positions on a picture are exact"
    )]
    pub(super) fn place(&self, [x, y]: Position) -> [f64; 2] {
        [x as f64 * self.scale, self.size[1] - y as f64 * self.scale]
    }
}

/// Plot that is ready to be written.
pub(super) struct Plot {
    size: [u32; 2],
    pen: Pen,
    places: Vec<[i32; 2]>,
    layers: Vec<Layer>,
    pub(super) plotted: Plotted,
}

/// Returns the strokes of each pen from those of each colour.
fn by_pen(layers: Vec<(Colour, Strokes)>, pens: Pens) -> Vec<(Colour, Strokes)> {
    let colours: Vec<_> = layers
        .iter()
        .map(|(colour, strokes)| (*colour, strokes.mark() as u64))
        .collect();
    let mut layers: Vec<_> = layers.into_iter().map(|(_, strokes)| strokes).collect();
    let shared = shared(&colours, pens).into_iter();
    shared
        .map(|(colour, members)| {
            let mut members = members.into_iter();
            let first = members.next().unwrap_or(0);
            let mut all = std::mem::take(&mut layers[first]);
            for member in members {
                all.append(std::mem::take(&mut layers[member]));
            }
            (colour, all)
        })
        .collect()
}

/// Strokes of a pen.
struct Layer {
    colour: Colour,
    strokes: Strokes,
    order: Order,
}

impl Plot {
    /// Creates a plot of a drawing.
    pub(super) fn of(
        drawing: &impl Drawing,
        options: &Options,
        cancel: Option<&AtomicBool>,
    ) -> Result<Self, RenderError> {
        let Options {
            unit,
            threads,
            pens,
            ..
        } = *options;
        let size = drawing.size();
        let fills = Fills::new(options, drawing.background());
        let Plotter {
            mut points,
            mut layers,
            fills,
            ..
        } = with_team(threads, |team| -> Result<_, RenderError> {
            let mut plotter = Plotter::new(size, fills);
            drawing.draw(&mut plotter, team)?;
            Ok(plotter)
        })?;
        let go_on = || match cancel {
            Some(cancel) if cancel.load(Ordering::Relaxed) => {
                Err(RenderError::Walk(WalkError::Cancelled))
            }
            _ => Ok(()),
        };
        let mut hidden = 0;
        if !fills.areas.is_empty() {
            let (colours, mut strokes): (Vec<_>, Vec<_>) = layers.into_iter().unzip();
            let side = f64::from(size[0].max(size[1])) * FINE;
            let hatch = options.hatch.as_ref();
            hidden = Visible::find(&mut strokes, &fills.areas, hatch, &mut points, side, go_on)?;
            layers = colours.into_iter().zip(strokes).collect();
        }
        drop(fills);
        let mut plot = Self {
            size,
            pen: drawing.pen(),
            places: points.places(),
            layers: Vec::new(),
            plotted: Plotted::default(),
        };
        plot.plotted.colours = layers.len() as u64;
        let layers = by_pen(layers, pens);
        let places = plot.places.as_slice();
        let mut unique = Unique::new(places);
        let scale = unit.millimetres() / FINE;
        // Layers are processed from the top down.
        for (colour, strokes) in layers.into_iter().rev() {
            let mut kept = Strokes::default();
            for stroke in strokes.iter() {
                go_on()?;
                unique.add(stroke, &mut kept);
            }
            drop(strokes);
            if kept.len() == 0 {
                continue;
            }
            let strokes = merged(&kept);
            go_on()?;
            let as_drawn = Order::as_drawn(&strokes, places);
            plot.plotted.carried_as_drawn += scale * as_drawn.travel;
            let order = as_drawn.shortened(&strokes, places);
            let vertices = |stroke: &'_ [Point]| -> Vec<DVec2> {
                let places = stroke.iter().map(|&point| vector(places[point as usize]));
                places.collect()
            };
            let length = |stroke| -> f64 {
                let vertices = vertices(stroke);
                let edges = vertices.windows(2).map(|edge| edge[0].distance(edge[1]));
                edges.sum()
            };
            plot.plotted.pens.push(PlottedPen {
                colour,
                strokes: strokes.len() as u64,
                drawn: scale * strokes.iter().map(length).sum::<f64>(),
                carried: scale * order.travel,
            });
            plot.layers.push(Layer {
                colour,
                strokes,
                order,
            });
        }
        plot.layers.reverse();
        let plotted = &mut plot.plotted;
        plotted.pens.reverse();
        plotted.repeated = unique.repeated;
        plotted.hidden = hidden;
        plotted.layers = plotted.pens.len() as u64;
        plotted.strokes = plotted.pens.iter().map(|pen| pen.strokes).sum();
        plotted.drawn = plotted.pens.iter().map(|pen| pen.drawn).sum();
        plotted.carried = plotted.pens.iter().map(|pen| pen.carried).sum();
        Ok(plot)
    }

    /// Iterates over the colours of the layers.
    pub(super) fn colours(&self) -> impl Iterator<Item = Colour> {
        self.layers.iter().map(|layer| layer.colour)
    }

    /// Calls `draw` for every stroke, in the order of drawing, with the number of its layer, its vertices and
    /// whether it is closed. The first vertex of a closed stroke is not repeated at the end.
    pub(super) fn each<E>(
        &self,
        mut draw: impl FnMut(usize, &[Position], bool) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut vertices = Vec::new();
        for (number, layer) in self.layers.iter().enumerate() {
            for turn in &layer.order.turns {
                let stroke = layer.strokes.get(turn.stroke);
                let place = |&point: &Point| self.places[point as usize].map(i64::from);
                vertices.clear();
                vertices.extend(stroke.iter().map(place));
                let closed = is_closed(stroke);
                if closed {
                    vertices.pop();
                }
                match turn.traversal {
                    Traversal::Forwards => {}
                    Traversal::Backwards => vertices.reverse(),
                    Traversal::From(vertex) => vertices.rotate_left(vertex),
                }
                draw(number, &vertices, closed)?;
            }
        }
        Ok(())
    }
}

impl Drawing for Plot {
    fn size(&self) -> [u32; 2] {
        self.size
    }

    fn background(&self) -> Option<Colour> {
        None
    }

    fn pen(&self) -> Pen {
        self.pen
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let paint = |colour| Paint {
            fill: None,
            stroke: Some(Stroke {
                colour,
                pen: self.pen,
            }),
            has_holes: false,
        };
        let paints: Vec<_> = self.colours().map(paint).collect();
        self.each(|layer, vertices, closed| {
            surface.begin(&paints[layer])?;
            surface.move_to(vertices[0]);
            for vertices in vertices[1..].chunks(1 << 8) {
                surface.lines_to(vertices);
                surface.hand_on()?;
            }
            if closed {
                surface.close();
            }
            Ok(surface.end()?)
        })
    }
}
