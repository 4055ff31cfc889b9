//! Approximants in space as nested instances, before they are written in a format.
//!
//! Every object and number of remaining steps is one nest, which holds the instances that replace the object: their
//! number grows with the graph and the number of steps, not with the number of elements (Hart 1992, section 2).

use std::collections::BTreeMap;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::geometry::{BEYOND, DAffine3, DVec3, Frame3, Linear, Mesh, Solid};
use crate::graph::{Graph, Instance};
use crate::grow::WalkError;
use crate::instancing::Appearance;
use crate::style::{ColorBy, Colour, Style};

use super::super::colours::Colours;
use super::super::error::RenderError;
use super::super::space::SpaceError;
use super::symbols::{Aspect, Dress, ElementSubset, Symbol, Symbols};
use super::{NotInstanced, Work, refusal};

/// Limit of the number of triangles of a mesh that stands for several elements, which are held in memory.
const MAX_TRIANGLES: usize = 1 << 23;

/// An approximant as nested instances.
pub(super) struct Nested<'g> {
    graph: &'g Graph<Frame3>,
    /// Base elements in their colours: number of the base element, and colour.
    pub(super) shapes: Vec<(usize, Colour)>,
    /// Nests, each after those that it holds. The last one is the whole; it may be empty.
    pub(super) nests: Vec<Nest>,
}

/// Instances in a common frame.
pub(super) struct Nest {
    pub(super) instances: Vec<Placed>,
    /// Number of elements and nests to which the nest expands, including itself.
    pub(super) expanded: f64,
}

impl Nest {
    /// Returns the instances whose maps a format can place, and those that it cannot, which are to be [baked](Nested::bake).
    pub(super) fn placed(
        &self,
        can_place: impl Fn(&Placed) -> bool,
    ) -> (Vec<Placed>, Vec<(DAffine3, Content)>) {
        let (placed, others): (Vec<Placed>, Vec<Placed>) =
            self.instances.iter().copied().partition(can_place);
        let others = others.iter().map(|it| (it.map, it.content));
        (placed, others.collect())
    }
}

/// An instance in a nest.
#[derive(Clone, Copy)]
pub(super) struct Placed {
    pub(super) map: DAffine3,
    pub(super) content: Content,
}

/// Content of an instance.
#[derive(Clone, Copy)]
pub(super) enum Content {
    /// Nest with a number.
    Nest(usize),
    /// Shape with a number.
    Shape(usize),
}

/// Place of an element, and a corner in its own frame.
type Key = ([u64; 12], [i64; 3]);

/// Mesh of elements with a common frame.
#[derive(Default)]
pub(super) struct Baked {
    /// Corners, those of every element apart.
    pub(super) corners: Vec<DVec3>,
    /// Triangles that have an area, counter-clockwise from outside.
    pub(super) triangles: Vec<([u32; 3], Paint)>,
    /// Numbers of the corners of surfaces, by the places of their elements.
    shared: BTreeMap<Key, u32>,
}

/// Paint of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Paint {
    pub(super) colour: Colour,
    /// Whether both sides are seen: those of a flat element, unless it is a surface with a front only.
    pub(super) has_two_sides: bool,
}

impl<'g> Nested<'g> {
    /// Collects the nests of approximant `steps`.
    ///
    /// # Errors
    ///
    /// If instances cannot represent the approximant or its colours, or if it is cancelled.
    pub(super) fn of(
        graph: &'g Graph<Frame3>,
        steps: u32,
        style: &Style,
        cancel: Option<&AtomicBool>,
    ) -> Result<Self, RenderError> {
        refusal::check(graph, style, steps)?;
        if style.color_by == ColorBy::Normal {
            return Err(SpaceError::FaceColours.into());
        }
        let colours = Colours::of(style, graph, steps)?;
        let start = Aspect {
            // The initiator replaces a virtual object that has one more step.
            steps: steps + 1,
            part: ElementSubset::All,
            dress: Dress(Appearance::NONE),
        };
        let symbols = Symbols::new(graph, style.color_by, colours.classes());
        let initiator = graph.initiator(steps);
        let mut work = Work::FILE;
        let all = symbols.collect(initiator, [start].into_iter(), &mut work);
        let all = all.ok_or(NotInstanced::TooManySymbols)?;
        let mut collector = Collector {
            steps,
            colours,
            symbols,
            numbers: BTreeMap::new(),
            shapes: BTreeMap::new(),
            nested: Self {
                graph,
                shapes: Vec::new(),
                nests: Vec::new(),
            },
        };
        for symbol in all {
            if cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                return Err(RenderError::Walk(WalkError::Cancelled));
            }
            let Some(successor) = collector.symbols.successor(&symbol) else {
                continue;
            };
            let instances = successor.placed_instances();
            let instances = instances.map(|(placement, it)| (it, placement.seeds()));
            let nest = collector.nest(instances, &symbol.aspect);
            if !nest.instances.is_empty() {
                let number = collector.nested.nests.len();
                collector.numbers.insert(symbol, number);
                collector.nested.nests.push(nest);
            }
        }
        let instances = initiator.instances.iter().map(|it| (it, false));
        let whole = collector.nest(instances, &start);
        collector.nested.nests.push(whole);
        Ok(collector.nested)
    }

    /// Returns the solid of a shape.
    pub(super) fn solid(&self, shape: usize) -> &Solid {
        &self.graph.base_elements()[self.shapes[shape].0]
    }

    /// Returns whether a shape is a single face.
    #[cfg(feature = "threemf")]
    pub(super) fn is_flat(&self, shape: usize) -> bool {
        Mesh::from(self.solid(shape)).faces.len() == 1
    }

    /// Returns the colours of all shapes, each once.
    #[cfg(feature = "threemf")]
    pub(super) fn colours(&self) -> Vec<Colour> {
        let mut colours: Vec<Colour> = self.shapes.iter().map(|(_, colour)| *colour).collect();
        colours.sort_by_key(|colour| colour.rgba());
        colours.dedup();
        colours
    }

    /// Returns the nests without shapes that have no faces: segments and points.
    ///
    /// # Errors
    ///
    /// If there are shapes, and none of them has faces.
    pub(super) fn with_faces(&self) -> Result<Self, SpaceError> {
        let shapes = 0..self.shapes.len();
        let has_faces = |shape: usize| !Mesh::from(self.solid(shape)).faces.is_empty();
        let has_faces: Vec<bool> = shapes.map(has_faces).collect();
        let mut nests: Vec<Nest> = Vec::new();
        for nest in &self.nests {
            let kept = nest.instances.iter().filter(|it| match it.content {
                Content::Nest(number) => !nests[number].instances.is_empty(),
                Content::Shape(number) => has_faces[number],
            });
            let instances = kept.copied().collect();
            nests.push(Nest { instances, ..*nest });
        }
        let is_empty = |nests: &[Nest]| nests.last().is_none_or(|it| it.instances.is_empty());
        if is_empty(&nests) && !is_empty(&self.nests) {
            return Err(SpaceError::NoFaces);
        }
        Ok(Self {
            graph: self.graph,
            shapes: self.shapes.clone(),
            nests,
        })
    }

    /// Returns the mesh of a shape.
    ///
    /// # Errors
    ///
    /// As [`bake`](Self::bake).
    pub(super) fn mesh(&self, shape: usize) -> Result<Baked, RenderError> {
        self.bake([(DAffine3::IDENTITY, Content::Shape(shape))].into_iter())
    }

    /// Returns the mesh of all elements of contents in places of a common frame.
    ///
    /// # Errors
    ///
    /// If there are more triangles than are held in memory, or if coordinates exceed single precision.
    pub(super) fn bake(
        &self,
        placed: impl Iterator<Item = (DAffine3, Content)>,
    ) -> Result<Baked, RenderError> {
        let mut baked = Baked::default();
        let mut open: Vec<(DAffine3, Content)> = placed.collect();
        open.reverse();
        let mut meshes = BTreeMap::new();
        while let Some((map, content)) = open.pop() {
            match content {
                Content::Nest(number) => {
                    let inner = self.nests[number].instances.iter().rev();
                    open.extend(inner.map(|it| (map * it.map, it.content)));
                }
                Content::Shape(number) => {
                    let solid = self.solid(number);
                    let mesh = meshes.entry(number).or_insert_with(|| Mesh::from(solid));
                    let paint = Paint {
                        colour: self.shapes[number].1,
                        has_two_sides: match solid.side() {
                            Some(side) => side.is_double,
                            None => mesh.faces.len() == 1 || is_singular(&map),
                        },
                    };
                    baked.add(mesh, &map, paint)?;
                }
            }
        }
        Ok(baked)
    }
}

impl Baked {
    fn add(&mut self, mesh: &Mesh, map: &DAffine3, paint: Paint) -> Result<(), RenderError> {
        let mut numbers = Vec::new();
        for own in &mesh.corners {
            let corner = map.transform_point3(*own);
            if !corner.as_vec3().is_finite() {
                return Err(io::Error::new(io::ErrorKind::InvalidData, BEYOND).into());
            }
            let next = u32::try_from(self.corners.len()).unwrap_or(u32::MAX);
            // Surfaces of an element share its place and their corners.
            let number = match mesh.faces.len() {
                1 => *self.shared.entry(key(map, *own)).or_insert(next),
                _ => next,
            };
            if number == next {
                self.corners.push(corner);
            }
            numbers.push(number);
        }
        let is_mirrored = map.matrix3.determinant() < 0.0;
        for [a, b, c] in mesh.triangles() {
            let [b, c] = if is_mirrored { [c, b] } else { [b, c] };
            let triangle = [a, b, c].map(|corner| numbers[corner]);
            if is_flat(triangle.map(|corner| self.corners[corner as usize])) {
                continue;
            }
            if self.triangles.len() == MAX_TRIANGLES {
                return Err(too_many_triangles().into());
            }
            self.triangles.push((triangle, paint));
        }
        Ok(())
    }

    /// Returns whether the triangles enclose a volume: every side of one is a side of one other, in the opposite
    /// direction.
    #[cfg(feature = "threemf")]
    pub(super) fn is_closed(&self) -> bool {
        let mut sides = BTreeMap::new();
        for ([a, b, c], _) in &self.triangles {
            for side in [[a, b], [b, c], [c, a]] {
                *sides.entry(side).or_insert(0u32) += 1;
            }
        }
        { sides.iter() }
            .all(|([from, to], count)| *count == 1 && sides.get(&[*to, *from]) == Some(&1))
    }
}

/// Returns the place of an element and a corner in its own frame, up to rounding.
#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn key(map: &DAffine3, corner: DVec3) -> Key {
    const ROUNDING: f64 = 1e-9;
    let place = map.to_cols_array().map(f64::to_bits);
    (
        place,
        corner.to_array().map(|at| (at / ROUNDING).round() as i64),
    )
}

/// Returns whether a triangle has no area.
fn is_flat([a, b, c]: [DVec3; 3]) -> bool {
    const ROUNDING: f64 = 1e-12;
    let (along, across) = (b - a, c - a);
    let longest = along.length().max(across.length());
    along.cross(across).length() <= ROUNDING * longest * longest
}

/// Returns whether a map is singular, to within the precision of formats.
pub(super) fn is_singular(map: &DAffine3) -> bool {
    const THINNEST: f64 = 1e-7;
    let [longest, _, shortest] = map.matrix3.singular_values();
    shortest <= THINNEST * longest
}

/// Returns the error of a mesh that is too large.
pub(super) fn too_many_triangles() -> SpaceError {
    SpaceError::TooManyFaces {
        what: "triangles of copies that this format cannot place, which a .usda holds in any number",
        limit: MAX_TRIANGLES as u64,
    }
}

/// Nests that are being collected.
struct Collector<'s, 'g> {
    steps: u32,
    colours: Colours<'s>,
    symbols: Symbols<'g, Frame3>,
    /// Numbers of the nests of symbols that are not empty.
    numbers: BTreeMap<Symbol, usize>,
    /// Numbers of shapes, by base element and colour.
    shapes: BTreeMap<(usize, [u8; 4]), usize>,
    nested: Nested<'g>,
}

impl Collector<'_, '_> {
    /// Returns the nest of instances, each with whether it starts a new fractal.
    fn nest<'a>(
        &mut self,
        instances: impl Iterator<Item = (&'a Instance<Frame3>, bool)>,
        of: &Aspect,
    ) -> Nest {
        let mut nest = Nest {
            instances: Vec::new(),
            expanded: 1.0,
        };
        for (instance, seeded) in instances {
            let Some(symbol) = self.symbols.child(instance, of, seeded) else {
                continue;
            };
            let content = if self.symbols.successor(&symbol).is_some() {
                let Some(&number) = self.numbers.get(&symbol) else {
                    continue;
                };
                nest.expanded += self.nested.nests[number].expanded + 1.0;
                Content::Nest(number)
            } else {
                nest.expanded += 2.0;
                Content::Shape(self.shape(&symbol, self.steps + 1 - of.steps))
            };
            nest.instances.push(Placed {
                map: *instance.frame.map(),
                content,
            });
        }
        nest
    }

    /// Returns the number of the shape of an element that is born in a step.
    fn shape(&mut self, symbol: &Symbol, born: u32) -> usize {
        let object = &self.nested.graph.objects()[symbol.object];
        let Dress(appearance) = symbol.aspect.dress;
        let colour = self.colours.at(object, born, appearance);
        let element = object.base_element;
        let next = self.nested.shapes.len();
        let number = *self.shapes.entry((element, colour.rgba())).or_insert(next);
        if number == next {
            self.nested.shapes.push((element, colour));
        }
        number
    }
}
