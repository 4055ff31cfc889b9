//! Drawings of sets in space in vector formats: visible faces as polygons, and visible edges as lines.
//!
//! Elements are projected twice: first into samples of the nearest face, then the faces that are the nearest at a
//! sample are kept. Memory is that of what is seen. The kept faces are [arranged] from the back to the front, or
//! their edges are [cut](lines) where faces lie before them. Elements that are lines are cut likewise.

mod arrange;
mod element;
mod grid;
mod lines;
mod nearest;
mod polygon;
#[cfg(test)]
mod tests;

use std::io::{self, Write};

use crate::geometry::{BEYOND, DVec2, DVec3, Frame3, HalfSpace};
use crate::graph::Graph;
use crate::grow::{Element, Growth, Visitor, walk_in_spans};
use crate::parallel::Team;
use crate::render::colours::Colours;
use crate::render::drawing::Drawing;
use crate::render::paint::{FINE, Paint, Pen, Position, Stroke, pen, position};
use crate::render::surface::Surface;
use crate::render::write::write_in;
use crate::render::{NoRoom, Options, Picture, RenderError};
use crate::style::{Cap, ColorBy, Colour, Join, Shade, Slice};

use self::arrange::{Piece, arranged};
use self::element::{Part, Shape, Viewer};
use self::lines::Hiding;
use self::nearest::{Nearest, Visibility, retain_visible};
use self::polygon::Polygon;
use super::buffer::SAMPLES;
use super::place;
use super::scene;
use super::slice::{self, Search};
use super::{SpaceError, SpaceOptions};

/// Limit of the number of visible faces, which are held in memory.
const MAX_FACES: usize = 2_000_000;

/// Approximate number of elements that are projected at once.
const MANY: u64 = 1 << 10;

/// Width in pixels of the strokes that close the gaps which antialiasing leaves between polygons.
const SEAM: f64 = 0.5;

/// Draws an approximant in space and writes it as polygons from the back to the front, of which none hides what
/// lies before it. A plot, or a DXF file, has the visible edges instead, without those inside planes. Other pictures
/// have them too if the style has both a fill and a stroke.
///
/// A face is one polygon of one colour, with the depth of its middle; circles have 48 sides. Elements that are lines have the
/// stroke's width, and are drawn over the faces where none lies before them. [`Options::detail`] has
/// no effect. The bytes do not depend on the number of threads.
///
/// # Errors
///
/// If growing ends early, if there is nothing to draw or no room for it, if the camera is not valid, if the extent
/// of the set is not known, if more than two million faces are visible, or if `out` fails.
pub fn write_visible(
    graph: &Graph<Frame3>,
    growth: &Growth<'_>,
    options: &Options,
    space: &SpaceOptions,
    out: &mut impl Write,
) -> Result<Picture, RenderError> {
    let visible = Visible::of(graph, growth, options, space)?;
    let size = visible.size;
    let elements = visible.elements;
    let plotted = write_in(&visible, options, growth.cancel, out)?;
    Ok(Picture {
        size,
        window: None,
        steps: growth.steps,
        elements,
        is_limit: false,
        fractals: 1,
        is_part: true,
        empty: None,
        plotted,
        instanced: None,
    })
}

/// A visible face.
struct Shown {
    polygon: Polygon,
    /// Colour without shading.
    colour: Colour,
    intensity: f64,
}

/// Visible faces of an approximant.
struct Visible<'a> {
    size: [u32; 2],
    options: &'a Options,
    is_plot: bool,
    faces: Vec<Shown>,
    /// Elements that are lines, and sections of flat elements, with the colours that they are drawn in.
    lines: Vec<(Colour, [DVec3; 2])>,
    /// Number of elements of which a face or a line is visible.
    elements: u64,
    /// Largest difference of nearness that is a rounding error.
    tolerance: f64,
}

impl<'a> Visible<'a> {
    fn of(
        graph: &Graph<Frame3>,
        growth: &Growth<'_>,
        options: &'a Options,
        space: &SpaceOptions,
    ) -> Result<Self, RenderError> {
        let parts = scene::parts(graph, Some(growth.steps));
        let search = Search {
            parts: &parts,
            start: &scene::start(graph),
            steps: Some(growth.steps),
        };
        let placement = place::place(
            graph,
            &search,
            &space.camera,
            // A section has the depths of its plane.
            &space.within(0.0),
            options.size,
            options.view.pad(),
        )?;
        let is_section = |slice: &&Slice| slice.thickness.is_none();
        let section = space.slice.as_ref().filter(is_section);
        let cuts = match section {
            Some(_) => space.cuts.clone(),
            None => space.within(0.0),
        };
        let mapped = |cut: &HalfSpace| slice::mapped(cut, &placement.map);
        #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
        let samples = SAMPLES as f64;
        let viewer = Viewer {
            placement: &placement,
            cuts: cuts.iter().map(mapped).collect(),
            section: section.map(|slice| mapped(&slice.half_spaces(0.0)[0])),
            shade: space.shade.unwrap_or(Shade::Both),
            light: space.light,
            normals: placement.map.matrix3.transpose(),
            samples,
        };
        let shapes: Vec<Shape> = graph.base_elements().iter().map(Shape::new).collect();
        let colours = Colours::of(&options.style, graph, growth.steps)?;
        let walk = Walk {
            graph,
            viewer: &viewer,
            shapes: &shapes,
            colours: &colours,
        };
        let each = |nearest: Option<&Nearest>, take: &mut dyn FnMut(&mut Projector<'_>)| {
            let fresh = || Projector {
                walk: &walk,
                nearest,
                shown: Vec::new(),
                lines: Vec::new(),
                elements: 0,
            };
            let take = |projector: &mut Projector<'_>, _| {
                take(projector);
                Ok(())
            };
            walk_in_spans(graph, growth, options.threads, Some(MANY), fresh, take)
        };
        let tolerance = viewer.tolerance();
        let mut nearest = Nearest::new(placement.size, tolerance);
        each(None, &mut |projector| {
            projector.lines.clear();
            { projector.shown.drain(..) }.for_each(|(it, _)| nearest.add(&it.polygon));
        })?;
        let (mut faces, mut lines, mut elements) = (Vec::new(), Vec::new(), 0);
        each(Some(&nearest), &mut |projector| {
            elements += std::mem::take(&mut projector.elements);
            if faces.len() + lines.len() <= MAX_FACES {
                faces.append(&mut projector.shown);
                lines.append(&mut projector.lines);
            }
        })?;
        if faces.len() + lines.len() > MAX_FACES {
            return Err(SpaceError::TooManyFaces {
                what: "visible faces",
                limit: MAX_FACES as u64,
            }
            .into());
        }
        retain_visible(&mut faces, tolerance, |it: &Shown| &it.polygon);
        let faces: Vec<Shown> = faces.into_iter().map(|(it, _)| it).collect();
        if faces.is_empty() && lines.is_empty() {
            return Err(SpaceError::from(NoRoom::Nothing).into());
        }
        Ok(Self {
            size: placement.size,
            options,
            is_plot: options.plot || options.format.is_plot(),
            faces,
            lines,
            elements,
            tolerance,
        })
    }

    fn strokes<'s, S: Surface>(&self, surface: &'s mut S) -> Strokes<'s, S> {
        Strokes {
            surface,
            pen: self.pen(),
            colour: None,
        }
    }

    /// Draws the faces, from the back to the front.
    fn fill(&self, surface: &mut impl Surface) -> io::Result<()> {
        let pieces = self.faces.iter().enumerate().map(|(face, shown)| Piece {
            polygon: shown.polygon.clone(),
            face,
        });
        for piece in arranged(pieces.collect(), self.tolerance) {
            let Shown {
                colour, intensity, ..
            } = &self.faces[piece.face];
            let colour = darkened(*colour, *intensity);
            surface.begin(&Paint {
                fill: Some(colour),
                stroke: Some(Stroke {
                    colour,
                    pen: Pen {
                        width: SEAM,
                        cap: Cap::Round,
                        join: Join::Round,
                        dash: 0.0,
                    },
                }),
                has_holes: false,
            })?;
            let mut last = None;
            for corner in piece.polygon.corners() {
                let at = placed(corner.at.truncate());
                match last {
                    None => surface.move_to(at),
                    Some(last) if last == at => {}
                    Some(_) => surface.line_to(at),
                }
                last = Some(at);
            }
            surface.close();
            surface.end()?;
        }
        Ok(())
    }

    /// Draws the visible edges, and the visible parts of lines, in a colour or in those of their elements.
    fn outline(&self, surface: &mut impl Surface, colour: Option<Colour>) -> io::Result<()> {
        let of = |face: usize| colour.unwrap_or(self.faces[face].colour);
        let is_alike = |a: usize, b: usize| of(a) == of(b);
        let mut strokes = self.strokes(surface);
        let mut hiding = self.hiding();
        hiding.edges(is_alike, |face, ends| strokes.draw(of(face), ends))?;
        self.draw_lines(&mut hiding, &mut strokes, colour)?;
        strokes.end()
    }

    fn hiding(&self) -> Hiding<'_> {
        let faces = self.faces.iter().map(|shown| &shown.polygon);
        Hiding::of(faces.collect(), self.tolerance)
    }

    fn draw_lines(
        &self,
        hiding: &mut Hiding<'_>,
        strokes: &mut Strokes<'_, impl Surface>,
        colour: Option<Colour>,
    ) -> io::Result<()> {
        for (own, ends) in &self.lines {
            hiding.line(*ends, |ends| strokes.draw(colour.unwrap_or(*own), ends))?;
        }
        Ok(())
    }
}

/// Lines, of which successive ones of a colour are one path.
struct Strokes<'a, S> {
    surface: &'a mut S,
    pen: Pen,
    /// Colour of the path that has begun.
    colour: Option<Colour>,
}

impl<S: Surface> Strokes<'_, S> {
    fn draw(&mut self, colour: Colour, ends: [DVec2; 2]) -> io::Result<()> {
        let [from, to] = ends.map(placed);
        if from == to {
            return Ok(());
        }
        if self.colour != Some(colour) {
            self.end()?;
            self.colour = Some(colour);
            let pen = self.pen;
            self.surface.begin(&Paint {
                fill: None,
                stroke: Some(Stroke { colour, pen }),
                has_holes: false,
            })?;
        }
        self.surface.move_to(from);
        self.surface.line_to(to);
        self.surface.hand_on()
    }

    fn end(&mut self) -> io::Result<()> {
        match self.colour.take() {
            Some(_) => self.surface.end(),
            None => Ok(()),
        }
    }
}

fn placed(point: DVec2) -> Position {
    position(point * FINE)
}

/// Returns a colour with a share of its intensity.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the values are between 0 and 255"
)]
fn darkened(colour: Colour, intensity: f64) -> Colour {
    let [red, green, blue, alpha] = colour.rgba();
    let [red, green, blue] =
        [red, green, blue].map(|part| (f64::from(part) * intensity + 0.5) as u8);
    Colour::of_rgba([red, green, blue, alpha])
}

impl Drawing for Visible<'_> {
    fn size(&self) -> [u32; 2] {
        self.size
    }

    fn background(&self) -> Option<Colour> {
        self.options.style.ground()
    }

    fn pen(&self) -> Pen {
        pen(&self.options.style)
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let style = &self.options.style;
        let line = match style.color_by {
            ColorBy::None => Some(style.stroke.unwrap_or(Colour::BLACK)),
            _ => None,
        };
        if self.is_plot {
            return Ok(self.outline(surface, line)?);
        }
        self.fill(surface)?;
        match (style.stroke, style.fill) {
            (Some(stroke), Some(_)) => self.outline(surface, Some(stroke))?,
            _ => {
                let mut strokes = self.strokes(surface);
                self.draw_lines(&mut self.hiding(), &mut strokes, None)?;
                strokes.end()?;
            }
        }
        Ok(())
    }
}

/// A walk over the visible elements.
struct Walk<'a> {
    graph: &'a Graph<Frame3>,
    viewer: &'a Viewer<'a>,
    shapes: &'a [Shape],
    colours: &'a Colours<'a>,
}

/// Projects the elements of a span.
struct Projector<'a> {
    walk: &'a Walk<'a>,
    /// Nearest faces, by which hidden ones are left out.
    nearest: Option<&'a Nearest>,
    shown: Vec<(Shown, Visibility)>,
    lines: Vec<(Colour, [DVec3; 2])>,
    elements: u64,
}

impl Visitor<Frame3> for Projector<'_> {
    type Error = io::Error;

    fn element(&mut self, element: &Element<Frame3>) -> io::Result<()> {
        if !element.visible {
            return Ok(());
        }
        let map = element.frame.map();
        if !map.is_finite() {
            return Err(io::Error::new(io::ErrorKind::InvalidData, BEYOND));
        }
        let object = &self.walk.graph.objects()[element.object];
        let shape = &self.walk.shapes[object.base_element];
        let mut colour = None;
        let before = self.shown.len() + self.lines.len();
        let colours = self.walk.colours;
        let style = colours.style();
        let mut colour = || {
            let of_element = || colours.at(object, element.born, element.appearance);
            *colour.get_or_insert_with(of_element)
        };
        self.walk.viewer.faces(shape, map, |part| match part {
            Part::Line(ends, intensity) => self.lines.push((darkened(colour(), intensity), ends)),
            Part::Face(polygon, intensity, normal) => {
                let visibility = { self.nearest }
                    .map_or(Visibility::Unknown, |nearest| nearest.visibility(&polygon));
                if visibility != Visibility::Hidden {
                    let shown = Shown {
                        polygon,
                        colour: style.colour_of_normal(normal).unwrap_or_else(&mut colour),
                        intensity,
                    };
                    self.shown.push((shown, visibility));
                }
            }
        });
        self.elements += u64::from(self.shown.len() + self.lines.len() > before);
        Ok(())
    }

    fn end(&mut self, _: bool) -> io::Result<()> {
        Ok(())
    }
}
