//! Boundary of the union of elements that meet in whole faces.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::iter::repeat_n;

use crate::geometry::{BEYOND, DAffine3, DVec3, Frame3, Mesh};
use crate::grow::{Element, Visitor};

use super::super::error::RenderError;
use super::super::options::Options;
use super::super::space::SpaceError;
use super::encode::{Encoder, Pass, Shape, head};
use super::{MeshFormat, Meshed, Walk};

/// Limit of the number of faces that are held in memory.
const MAX_FACES: usize = 20_000_000;

/// Largest distance of coordinates that are equal, relative to the size of the mesh.
const ROUNDING: f64 = 1e-9;

/// Faces that remain where those that cancel are left out.
pub(super) struct Shell {
    mesh: Mesh,
    /// Colours of the faces.
    colours: Vec<[u8; 3]>,
}

impl Shell {
    /// Collects the shell of all visible elements, and returns their number.
    pub(super) fn of(walk: &Walk<'_>) -> Result<(Self, u64), RenderError> {
        let mut soup = Soup::default();
        let mut elements = 0;
        let fresh = || Collector {
            walk,
            elements: 0,
            soup: Soup::default(),
        };
        let mut is_too_large = false;
        let walked = walk.each(fresh, |collector| {
            elements += std::mem::take(&mut collector.elements);
            soup.append(&mut collector.soup);
            is_too_large |= soup.colours.len() > MAX_FACES;
            match is_too_large {
                true => Err(io::ErrorKind::FileTooLarge.into()),
                false => Ok(()),
            }
        });
        if is_too_large {
            let error = SpaceError::TooManyFaces {
                what: "faces in a shell",
                limit: MAX_FACES as u64,
            };
            return Err(error.into());
        }
        walked?;
        Ok((soup.shell(), elements))
    }

    /// Writes the mesh.
    pub(super) fn write(
        self,
        format: MeshFormat,
        options: &Options,
        elements: u64,
        out: &mut impl Write,
    ) -> Result<Meshed, RenderError> {
        let shape = Shape::new(&self.mesh, format);
        let size = Meshed {
            elements,
            corners: shape.corners().len() as u64,
            faces: shape.faces() as u64,
        };
        out.write_all(&head(format, &options.labels.title, &size)?)?;
        let colours = match shape.faces() == self.mesh.faces.len() {
            true => self.colours,
            // Triangles have the colours of their faces.
            false => {
                let faces = self.mesh.faces.iter().zip(self.colours);
                let triangles =
                    faces.flat_map(|(face, colour)| repeat_n(colour, face.len().saturating_sub(2)));
                triangles.collect()
            }
        };
        for &pass in Pass::of(format) {
            let mut encoder = Encoder::new(format, pass);
            let colour = |face: usize| colours.get(face).copied().unwrap_or_default();
            if !encoder.add(&shape, &DAffine3::IDENTITY, false, colour) {
                return Err(io::Error::new(io::ErrorKind::InvalidData, BEYOND).into());
            }
            encoder.give(0, out)?;
        }
        Ok(size)
    }
}

/// Whether a face runs in the direction of its key, its corners, and its colour.
type OpenFace = (bool, Vec<u32>, [u8; 3]);

/// Faces with corners of their own.
#[derive(Default)]
struct Soup {
    corners: Vec<DVec3>,
    /// Number of corners of every face.
    sides: Vec<usize>,
    colours: Vec<[u8; 3]>,
}

impl Soup {
    fn append(&mut self, other: &mut Self) {
        self.corners.append(&mut other.corners);
        self.sides.append(&mut other.sides);
        self.colours.append(&mut other.colours);
    }

    /// Shares corners, and removes pairs of faces with opposite directions.
    fn shell(self) -> Shell {
        let (ids, corners) = self.shared();
        let mut open: BTreeMap<Vec<u32>, Vec<OpenFace>> = BTreeMap::new();
        let mut from = 0;
        for (sides, colour) in self.sides.iter().zip(self.colours) {
            let face = &ids[from..from + sides];
            from += sides;
            let (key, is_forward) = cycle(face);
            let all = open.entry(key).or_default();
            match all.iter().position(|(forward, ..)| *forward != is_forward) {
                Some(opposite) => {
                    all.swap_remove(opposite);
                }
                None => all.push((is_forward, face.to_vec(), colour)),
            }
        }
        let mut shell = Shell {
            mesh: Mesh::default(),
            colours: Vec::new(),
        };
        let mut numbers = vec![None; corners.len()];
        for (_, face, colour) in open.into_values().flatten() {
            let number = |corner: u32| {
                *numbers[corner as usize].get_or_insert_with(|| {
                    shell.mesh.corners.push(corners[corner as usize]);
                    shell.mesh.corners.len() - 1
                })
            };
            let face = face.into_iter().map(number).collect();
            shell.mesh.faces.push(face);
            shell.colours.push(colour);
        }
        shell
    }

    /// Returns the numbers of the corners, where those that are equal up to rounding have one number, and the
    /// place of each number.
    fn shared(&self) -> (Vec<u32>, Vec<DVec3>) {
        let size =
            { self.corners.iter() }.fold(0.0, |size: f64, it| size.max(it.abs().max_element()));
        let axes = [0, 1, 2].map(|axis| ranks(&self.corners, axis, size * ROUNDING));
        let mut known: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        let mut places = Vec::new();
        let ids = self.corners.iter().enumerate().map(|(number, corner)| {
            let key = [0, 1, 2].map(|axis: usize| axes[axis][number]);
            *known.entry(key).or_insert_with(|| {
                places.push(*corner);
                u32::try_from(places.len() - 1).unwrap_or(u32::MAX)
            })
        });
        (ids.collect(), places)
    }
}

/// Returns the rank of the coordinate of every point along an axis. Coordinates that follow each other within a
/// tolerance have equal ranks.
fn ranks(points: &[DVec3], axis: usize, tolerance: f64) -> Vec<u32> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| points[*a][axis].total_cmp(&points[*b][axis]));
    let mut ranks = vec![0; points.len()];
    let (mut rank, mut last) = (0, f64::NEG_INFINITY);
    for point in order {
        let value = points[point][axis];
        rank += u32::from(value - last > tolerance);
        last = value;
        ranks[point] = rank;
    }
    ranks
}

/// Returns a face from its smallest corner on towards the smaller of the two next to it, and whether that is its
/// own direction.
fn cycle(face: &[u32]) -> (Vec<u32>, bool) {
    let count = face.len();
    let first = (0..count).min_by_key(|corner| face[*corner]).unwrap_or(0);
    let [next, previous] = [1, count - 1].map(|step| face[(first + step) % count]);
    let is_forward = next <= previous;
    let corner = |number| match is_forward {
        true => face[(first + number) % count],
        false => face[(first + count - number) % count],
    };
    ((0..count).map(corner).collect(), is_forward)
}

/// Collects the faces of a span.
struct Collector<'a> {
    walk: &'a Walk<'a>,
    elements: u64,
    soup: Soup,
}

impl Visitor<Frame3> for Collector<'_> {
    type Error = io::Error;

    fn element(&mut self, element: &Element<Frame3>) -> io::Result<()> {
        let Some((shape, colour)) = self.walk.shape(element) else {
            return Ok(());
        };
        let shape = &self.walk.shapes[shape];
        self.elements += 1;
        let map = element.frame.map();
        let is_mirrored = map.matrix3.determinant() < 0.0;
        for (number, face) in shape.mesh().faces.iter().enumerate() {
            let from = self.soup.corners.len();
            let images = face
                .iter()
                .map(|corner| map.transform_point3(shape.corners()[*corner]));
            self.soup.corners.extend(images);
            if is_mirrored {
                self.soup.corners[from..].reverse();
            }
            self.soup.sides.push(face.len());
            let colour = self.walk.colour_of_face(shape, number, map, colour);
            self.soup.colours.push(colour);
        }
        Ok(())
    }

    fn end(&mut self, _: bool) -> io::Result<()> {
        Ok(())
    }
}
