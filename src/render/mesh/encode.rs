//! Bytes of meshes in their formats.

use std::io::{self, Write};

use crate::geometry::{DAffine3, DVec3, Mesh};

use super::super::space::SpaceError;
use super::{MeshFormat, Meshed};

/// Largest number of corners of a polygon: lists of faces count them in a byte.
const MAX_CORNERS: usize = 255;

/// Mesh of a base element, prepared for a format.
pub(super) struct Shape {
    mesh: Mesh,
    /// Triangles of PLY without a colour, as they are and in a reflection; none for other formats.
    triangles: [Vec<Triangle>; 2],
}

impl Shape {
    pub(super) fn new(mesh: &Mesh, format: MeshFormat) -> Self {
        let is_long = |face: &Vec<usize>| face.len() > MAX_CORNERS;
        let mut mesh = mesh.clone();
        if format != MeshFormat::Obj || mesh.faces.iter().any(is_long) {
            mesh.faces = mesh.triangles().into_iter().map(Vec::from).collect();
        }
        let is_ply = format == MeshFormat::Ply;
        let faces = mesh.faces.iter().filter(|_| is_ply);
        let triangles = faces.filter_map(|face| <[usize; 3]>::try_from(face.as_slice()).ok());
        let reflected = triangles.clone().map(|[a, b, c]| Triangle::of([a, c, b]));
        Self {
            triangles: [triangles.map(Triangle::of).collect(), reflected.collect()],
            mesh,
        }
    }

    pub(super) fn corners(&self) -> &[DVec3] {
        &self.mesh.corners
    }

    /// Returns the number of faces.
    pub(super) fn faces(&self) -> usize {
        self.mesh.faces.len()
    }

    pub(super) fn mesh(&self) -> &Mesh {
        &self.mesh
    }
}

/// A triangle of PLY: the number of corners in 8 bits, their indices in 32 each, and the colour in 24, from the lowest.
#[derive(Clone, Copy)]
struct Triangle(u128);

impl Triangle {
    /// Number of bytes.
    const BYTES: usize = size_of::<u128>();

    /// Creates a black triangle.
    fn of(corners: [usize; 3]) -> Self {
        let [a, b, c] = corners.map(|corner| corner as u128);
        Self(3 | a << 8 | b << 40 | c << 72)
    }

    /// Returns the triangle behind `before` other corners, whose number fits with its own into 32 bits.
    fn behind(self, before: u32) -> Self {
        const ONE_EACH: u128 = 1 << 8 | 1 << 40 | 1 << 72;
        Self(self.0 + u128::from(before) * ONE_EACH)
    }

    /// Returns the triangle in a colour.
    fn coloured(self, [red, green, blue]: [u8; 3]) -> Self {
        let colour = u32::from_le_bytes([red, green, blue, 0]);
        Self(self.0 | u128::from(colour) << 104)
    }
}

/// Part of a file that is encoded by one walk.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Pass {
    /// Triangles, without corners and faces apart.
    Triangles,
    Corners,
    Faces,
}

impl Pass {
    pub(super) fn of(format: MeshFormat) -> &'static [Self] {
        match format {
            MeshFormat::Stl => &[Self::Triangles],
            MeshFormat::Obj | MeshFormat::Ply => &[Self::Corners, Self::Faces],
        }
    }
}

/// Returns the beginning of a file.
pub(super) fn head(format: MeshFormat, title: &str, size: &Meshed) -> Result<Vec<u8>, SpaceError> {
    let title: String = title
        .chars()
        .filter(|letter| !letter.is_control())
        .collect();
    let Meshed { corners, faces, .. } = size;
    let few = |number: &u64, what| {
        let limit = u64::from(u32::MAX);
        let count = u32::try_from(*number);
        count.map_err(|_| SpaceError::TooManyFaces { what, limit })
    };
    Ok(match format {
        MeshFormat::Stl => {
            let mut head = format!("kfrac {title}").into_bytes();
            head.resize(80, b' ');
            head.extend(few(faces, "triangles")?.to_le_bytes());
            head
        }
        MeshFormat::Obj => {
            few(corners, "corners")?;
            format!("# kfrac {title}\n").into_bytes()
        }
        MeshFormat::Ply => {
            few(corners, "corners")?;
            format!(
                "ply\nformat binary_little_endian 1.0\ncomment kfrac {title}\nelement vertex {corners}\n\
                 property float x\nproperty float y\nproperty float z\nelement face {faces}\n\
                 property list uchar uint vertex_indices\nproperty uchar red\nproperty uchar green\n\
                 property uchar blue\nend_header\n"
            )
            .into_bytes()
        }
    })
}

/// Encodes elements for a part of a file.
pub(super) struct Encoder {
    format: MeshFormat,
    pass: Pass,
    /// Bytes of the file; for the faces of OBJ, lists as in PLY.
    bytes: Vec<u8>,
    /// Number of corners that faces may refer to.
    corners: u32,
    /// Images of the corners of an element.
    images: Vec<DVec3>,
}

impl Encoder {
    pub(super) fn new(format: MeshFormat, pass: Pass) -> Self {
        Self {
            format,
            pass,
            bytes: Vec::new(),
            corners: 0,
            images: Vec::new(),
        }
    }

    /// Adds a shape in its place, with a colour for every face; returns whether its coordinates are finite.
    pub(super) fn add(
        &mut self,
        shape: &Shape,
        map: &DAffine3,
        colour: impl Fn(usize) -> [u8; 3],
    ) -> bool {
        let Mesh { corners, faces } = &shape.mesh;
        let images = corners.iter().map(|corner| map.transform_point3(*corner));
        let is_mirrored = map.matrix3.determinant() < 0.0;
        let mut is_finite = true;
        match self.pass {
            Pass::Triangles => {
                self.images.clear();
                self.images.extend(images);
                is_finite = self.images.iter().all(|image| image.as_vec3().is_finite());
                for face in faces {
                    self.triangle(face, is_mirrored);
                }
            }
            Pass::Corners if self.format == MeshFormat::Obj => {
                for image in images {
                    is_finite &= image.as_vec3().is_finite();
                    push_line(&mut self.bytes, image);
                }
            }
            Pass::Corners => {
                let places = add_chunks(&mut self.bytes, corners.len());
                for (place, image) in places.iter_mut().zip(images) {
                    is_finite &= image.as_vec3().is_finite();
                    *place = single(image);
                }
            }
            Pass::Faces if self.format == MeshFormat::Ply => {
                let triangles = &shape.triangles[usize::from(is_mirrored)];
                let places = add_chunks(&mut self.bytes, triangles.len());
                for (number, (place, triangle)) in places.iter_mut().zip(triangles).enumerate() {
                    let triangle = triangle.behind(self.corners).coloured(colour(number));
                    *place = triangle.0.to_le_bytes();
                }
            }
            Pass::Faces => {
                for face in faces {
                    self.face(face, is_mirrored);
                }
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "a shape has few corners")]
        let own = corners.len() as u32;
        self.corners += own;
        is_finite
    }

    /// Adds a list of corners.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "lists have no more than 255 corners, and the number of all corners fits into 32 bits"
    )]
    fn face(&mut self, face: &[usize], is_mirrored: bool) {
        let before = self.corners;
        let index = |corner: &usize| (before + *corner as u32).to_le_bytes();
        self.bytes.push(face.len() as u8);
        match is_mirrored {
            false => self.bytes.extend(face.iter().flat_map(index)),
            true => self.bytes.extend(face.iter().rev().flat_map(index)),
        }
    }

    /// Adds a triangle of STL, with its normal.
    fn triangle(&mut self, face: &[usize], is_mirrored: bool) {
        let turn = |point: DVec3| DVec3::new(point.x, -point.z, point.y);
        let [a, b, c] = [0, 1, 2].map(|corner: usize| turn(self.images[face[corner]]));
        let [b, c] = if is_mirrored { [c, b] } else { [b, c] };
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for vector in [normal, a, b, c] {
            self.bytes.extend_from_slice(&single(vector));
        }
        self.bytes.extend([0, 0]);
    }

    /// Writes the bytes of a span, behind `before` corners of earlier ones, and starts another; returns the number
    /// of corners with those of the span.
    pub(super) fn give(&mut self, before: u32, out: &mut impl Write) -> io::Result<u32> {
        if self.pass == Pass::Faces {
            self.refer(before);
        }
        out.write_all(&self.bytes)?;
        self.bytes.clear();
        // STL, which has no corners apart, may have more than are counted here.
        Ok(before.wrapping_add(std::mem::take(&mut self.corners)))
    }

    /// Lets faces refer to corners behind `before` others, in the way of the format.
    fn refer(&mut self, before: u32) {
        if self.format == MeshFormat::Ply {
            for bytes in self.bytes.as_chunks_mut::<{ Triangle::BYTES }>().0 {
                let triangle = Triangle(u128::from_le_bytes(*bytes));
                *bytes = triangle.behind(before).0.to_le_bytes();
            }
            return;
        }
        let mut text = Vec::new();
        let mut number = itoa::Buffer::new();
        let mut at = 0;
        while let Some(&corners) = self.bytes.get(at) {
            let (first, end) = (at + 1, at + 1 + 4 * usize::from(corners));
            text.push(b'f');
            for index in self.bytes[first..end].as_chunks().0 {
                // Corners are counted from 1.
                text.push(b' ');
                let corner = u64::from(before) + u64::from(u32::from_le_bytes(*index)) + 1;
                text.extend_from_slice(number.format(corner).as_bytes());
            }
            text.push(b'\n');
            at = end;
        }
        self.bytes = text;
    }
}

/// Writes a corner as a line of OBJ.
fn push_line(bytes: &mut Vec<u8>, point: DVec3) {
    let mut buffer = zmij::Buffer::new();
    bytes.push(b'v');
    for number in point.as_vec3().to_array() {
        bytes.push(b' ');
        // Adding zero turns −0 into 0.
        let text = buffer.format_finite(number + 0.0);
        bytes.extend_from_slice(text.strip_suffix(".0").unwrap_or(text).as_bytes());
    }
    bytes.push(b'\n');
}

/// Adds chunks of zeros, and returns them.
fn add_chunks<const BYTES: usize>(bytes: &mut Vec<u8>, count: usize) -> &mut [[u8; BYTES]] {
    let start = bytes.len();
    bytes.resize(start + count * BYTES, 0);
    bytes[start..].as_chunks_mut().0
}

/// Returns the coordinates of a point in single precision.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded to single precision"
)]
fn single(point: DVec3) -> [u8; 12] {
    let mut bytes = [0; 12];
    for (bytes, number) in bytes.as_chunks_mut().0.iter_mut().zip(point.to_array()) {
        // Adding zero turns −0 into 0.
        *bytes = (number as f32 + 0.0).to_le_bytes();
    }
    bytes
}
