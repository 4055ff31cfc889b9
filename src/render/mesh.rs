//! Elements in space as meshes of polygons, for modelling, printing and rendering.
//!
//! Coordinates are in single precision, and faces are counter-clockwise from outside. Elements are written in the
//! order of traversal, each with corners of its own, in memory that does not depend on their number; a
//! [shell](MeshOptions::shell) is collected first.

mod encode;
mod repeats;
mod shell;

use std::io::{self, Write};

use crate::geometry::{BEYOND, DAffine3, Frame3};
use crate::graph::Graph;
use crate::grow::{Element, Growth, Visitor, WalkError, walk_in_spans};
use crate::style::{ColorBy, Named};

use super::colours::Colours;
use super::error::RenderError;
use super::options::Options;
use super::space::SpaceError;
use encode::{Encoder, Pass, Shape};
use repeats::{Faces, Repeats};
use shell::Shell;

/// Format of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshFormat {
    /// Binary STL: triangles. z points up, as printers expect: (x, y, z) becomes (x, −z, y).
    Stl,
    /// Wavefront OBJ: polygons as text. y points up.
    Obj,
    /// Binary PLY: triangles with colours, as not all readers take other polygons. y points up.
    Ply,
}

impl Named for MeshFormat {
    const NAMES: &'static [(&'static str, Self)] =
        &[("stl", Self::Stl), ("obj", Self::Obj), ("ply", Self::Ply)];
}

/// Options of a mesh, beside those of all pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshOptions {
    /// Format; STL by default.
    pub format: MeshFormat,
    /// Whether faces of two elements that cancel are left out, and corners are shared: the mesh is the boundary
    /// of the union of elements that meet in whole faces. All faces are held in memory, some 200 bytes each.
    pub shell: bool,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self {
            format: MeshFormat::Stl,
            shell: false,
        }
    }
}

setters!(MeshOptions {
    format: MeshFormat,
    shell: bool,
});

/// Size of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Meshed {
    /// Number of elements.
    pub elements: u64,
    /// Number of corners; those that several elements have in common are counted once for each, except in a
    /// shell.
    pub corners: u64,
    /// Number of faces; in STL and PLY, of triangles.
    pub faces: u64,
}

/// Approximate number of elements that are encoded at once.
const MANY: u64 = 1 << 10;

/// Grows a graph in space and writes the visible elements of the approximant as a mesh. Of the options, the style's
/// colours, the labels and the number of threads apply; the bytes do not depend on the threads.
///
/// # Errors
///
/// If growing ends early, if no element has faces, if coordinates exceed single precision, if there are more faces than the
/// format can count, if colours depend on more than an element itself, or if `out` fails.
pub fn write_mesh(
    graph: &Graph<Frame3>,
    growth: &Growth<'_>,
    options: &Options,
    mesh: MeshOptions,
    out: &mut impl Write,
) -> Result<Meshed, RenderError> {
    let colours = Colours::of(&options.style, graph, growth.steps)?;
    let format = mesh.format;
    let shapes = graph.base_elements().iter().map(|solid| {
        // Faces of a shell are compared whole, and only then divided for the format.
        let format = if mesh.shell { MeshFormat::Obj } else { format };
        Shape::new(&solid.into(), format)
    });
    let shapes: Vec<Shape> = shapes.collect();
    let mut visible = graph.objects().iter().filter(|it| it.visible).peekable();
    if visible.peek().is_some() && visible.all(|it| shapes[it.base_element].faces() == 0) {
        return Err(SpaceError::NoFaces.into());
    }
    let walk = Walk {
        graph,
        growth,
        options,
        shapes: &shapes,
        colours: &colours,
    };
    if mesh.shell {
        let (shell, elements) = Shell::of(&walk)?;
        return shell.write(format, options, elements, out);
    }
    let size = match walk.forecast() {
        Some(size) => size,
        None => walk.counted()?,
    };
    out.write_all(&encode::head(format, &options.labels.title, &size)?)?;
    let mut repeats = Repeats::new(options.style.color_by != ColorBy::Normal);
    for &pass in Pass::of(format) {
        if pass == Pass::Faces && repeats.are_kept() {
            repeats.write(&shapes, format, options.threads, growth.cancel, out)?;
            continue;
        }
        let are_kept = pass == Pass::Corners && repeats.are_kept();
        // Corners of the elements before a span.
        let mut before = 0;
        let fresh = || Collector {
            walk: &walk,
            encoder: Encoder::new(format, pass),
            repeats: Repeats::new(are_kept),
        };
        walk.each(fresh, |collector| {
            repeats.append(&mut collector.repeats);
            before = collector.encoder.give(before, out)?;
            Ok(())
        })?;
    }
    Ok(size)
}

/// A walk over the visible elements.
struct Walk<'a> {
    graph: &'a Graph<Frame3>,
    growth: &'a Growth<'a>,
    options: &'a Options,
    shapes: &'a [Shape],
    colours: &'a Colours<'a>,
}

impl Walk<'_> {
    /// Walks with visitors that `take` receives in order.
    fn each<V: Visitor<Frame3, Error = io::Error> + Send>(
        &self,
        fresh: impl FnMut() -> V,
        mut take: impl FnMut(&mut V) -> io::Result<()>,
    ) -> Result<(), WalkError<io::Error>> {
        let threads = self.options.threads;
        let take = |visitor: &mut V, _| take(visitor);
        walk_in_spans(self.graph, self.growth, threads, Some(MANY), fresh, take)?;
        Ok(())
    }

    /// Returns the size of the mesh if it is known without a walk, and within the limit of growth.
    fn forecast(&self) -> Option<Meshed> {
        if self.graph.counts_index() || self.graph.is_of_one_step() {
            return None;
        }
        let mut forecast = self.graph.forecast()?;
        for _ in 0..self.growth.steps {
            if !forecast.advance() {
                return None;
            }
        }
        let elements = forecast.elements().to_u64()?;
        let mut size = (elements <= self.growth.max_elements).then(Meshed::default)?;
        for population in forecast.populations()? {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number within the limit of growth"
            )]
            size.add(self, population.object, population.count as u64);
        }
        Some(size)
    }

    /// Returns the size of the mesh from a walk.
    fn counted(&self) -> Result<Meshed, WalkError<io::Error>> {
        let mut size = Meshed::default();
        self.each(
            || Sizes(Meshed::default(), self),
            |Sizes(of_span, _)| {
                let one = std::mem::take(of_span);
                size.elements += one.elements;
                size.corners += one.corners;
                size.faces += one.faces;
                Ok(())
            },
        )?;
        Ok(size)
    }

    /// Returns the index of the shape of an element and its colour, if it is visible.
    fn shape(&self, element: &Element<Frame3>) -> Option<(usize, [u8; 3])> {
        let object = &self.graph.objects()[element.object];
        object.visible.then(|| {
            let [red, green, blue, _] = self
                .colours
                .at(object, element.born, element.appearance)
                .rgba();
            (object.base_element, [red, green, blue])
        })
    }
}

impl Walk<'_> {
    /// Returns the colour of a face of an element under a map, if that of the element is `own`.
    fn colour_of_face(&self, shape: &Shape, face: usize, map: &DAffine3, own: [u8; 3]) -> [u8; 3] {
        let style = self.colours.style();
        if style.color_by != ColorBy::Normal {
            return own;
        }
        let colour = style.colour_of_normal(shape.mesh().normal(face, map));
        colour.map_or(own, |colour| {
            let [red, green, blue, _] = colour.rgba();
            [red, green, blue]
        })
    }
}

impl Meshed {
    /// Adds elements of an object, if they are visible.
    fn add(&mut self, walk: &Walk<'_>, object: usize, count: u64) {
        let object = &walk.graph.objects()[object];
        if object.visible {
            let shape = &walk.shapes[object.base_element];
            self.elements += count;
            self.corners += count * shape.corners().len() as u64;
            self.faces += count * shape.faces() as u64;
        }
    }
}

/// Counts the faces of a span.
struct Sizes<'a>(Meshed, &'a Walk<'a>);

impl Visitor<Frame3> for Sizes<'_> {
    type Error = io::Error;

    fn element(&mut self, element: &Element<Frame3>) -> io::Result<()> {
        let Self(size, walk) = self;
        size.add(walk, element.object, 1);
        Ok(())
    }

    fn end(&mut self, _: bool) -> io::Result<()> {
        Ok(())
    }
}

/// Encodes the elements of a span.
struct Collector<'a> {
    walk: &'a Walk<'a>,
    encoder: Encoder,
    repeats: Repeats,
}

impl Visitor<Frame3> for Collector<'_> {
    type Error = io::Error;

    fn takes_runs(&self) -> bool {
        true
    }

    fn element(&mut self, element: &Element<Frame3>) -> io::Result<()> {
        if let Some((number, own)) = self.walk.shape(element) {
            let shape = &self.walk.shapes[number];
            let map = element.frame.map();
            let is_mirrored = map.matrix3.determinant() < 0.0;
            let colour = |face| self.walk.colour_of_face(shape, face, map, own);
            let is_finite = self.encoder.add(shape, map, is_mirrored, colour);
            let faces = Faces {
                shape: number,
                is_mirrored,
                colour: own,
            };
            self.repeats.add(faces, 1);
            if !is_finite {
                return Err(io::Error::new(io::ErrorKind::InvalidData, BEYOND));
            }
        }
        Ok(())
    }

    fn end(&mut self, _: bool) -> io::Result<()> {
        Ok(())
    }
}
