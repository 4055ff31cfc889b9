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
}

impl Shape {
    pub(super) fn new(mesh: &Mesh, format: MeshFormat) -> Self {
        let is_long = |face: &Vec<usize>| face.len() > MAX_CORNERS;
        let mut mesh = mesh.clone();
        if format != MeshFormat::Obj || mesh.faces.iter().any(is_long) {
            mesh.faces = mesh.triangles().into_iter().map(Vec::from).collect();
        }
        Self { mesh }
    }

    pub(super) fn corners(&self) -> &[DVec3] {
        &self.mesh.corners
    }

    /// Returns the number of corners.
    pub(super) fn count(&self) -> u32 {
        u32::try_from(self.mesh.corners.len()).unwrap_or(u32::MAX)
    }

    /// Returns the number of faces.
    pub(super) fn faces(&self) -> usize {
        self.mesh.faces.len()
    }

    pub(super) fn mesh(&self) -> &Mesh {
        &self.mesh
    }
}

/// Bytes of a triangle in PLY: the number of corners, their indices, and the colour.
const TRIANGLE: usize = 1 + 3 * 4 + 3;

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
    /// Bytes of the file; for [`Pass::Faces`], lists as in PLY.
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
        is_mirrored: bool,
        colour: impl Fn(usize) -> [u8; 3],
    ) -> bool {
        let Mesh { corners, faces } = &shape.mesh;
        let images = corners.iter().map(|corner| map.transform_point3(*corner));
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
            Pass::Corners => {
                for image in images {
                    is_finite &= image.as_vec3().is_finite();
                    match self.format {
                        MeshFormat::Obj => push_line(&mut self.bytes, image),
                        _ => push(&mut self.bytes, image),
                    }
                }
            }
            Pass::Faces => {
                self.faces(shape, is_mirrored, colour);
                return true;
            }
        }
        self.corners += shape.count();
        is_finite
    }

    /// Adds the faces of `count` elements of a shape and a colour.
    pub(super) fn repeat(&mut self, shape: &Shape, is_mirrored: bool, colour: [u8; 3], count: u64) {
        if self.format == MeshFormat::Obj {
            for _ in 0..count {
                self.faces(shape, is_mirrored, |_| colour);
            }
            return;
        }
        /// A one at the place of each number of a triangle.
        const ONES: u128 = 1 << 8 | 1 << 40 | 1 << 72;
        let start = self.bytes.len();
        self.faces(shape, is_mirrored, |_| colour);
        let first = { self.bytes[start..].as_chunks::<TRIANGLE>().0.iter() }.copied();
        let mut triangles: Vec<u128> = first.map(u128::from_le_bytes).collect();
        let further = ONES * u128::from(shape.count());
        for _ in 1..count {
            for triangle in &mut triangles {
                *triangle += further;
                self.bytes.extend_from_slice(&triangle.to_le_bytes());
            }
            self.corners += shape.count();
        }
    }

    /// Adds the faces of a shape, which refer to the corners that follow.
    fn faces(&mut self, shape: &Shape, is_mirrored: bool, colour: impl Fn(usize) -> [u8; 3]) {
        for (number, face) in shape.mesh.faces.iter().enumerate() {
            self.face(face, is_mirrored, colour(number));
        }
        self.corners += shape.count();
    }

    /// Starts with faces that refer to corners behind `before` others.
    pub(super) fn start(&mut self, before: u32) {
        self.corners = before;
    }

    /// Writes the bytes.
    pub(super) fn pass_on(&mut self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(&self.bytes)?;
        self.bytes.clear();
        Ok(())
    }

    /// Adds a list of corners with its colour.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "lists have no more than 255 corners, and the number of all corners fits into 32 bits"
    )]
    fn face(&mut self, face: &[usize], is_mirrored: bool, colour: [u8; 3]) {
        let before = self.corners;
        let index = |corner: &usize| (before + *corner as u32).to_le_bytes();
        if let &[a, b, c] = face {
            let [b, c] = if is_mirrored { [c, b] } else { [b, c] };
            let mut triangle = [3; TRIANGLE];
            for (bytes, corner) in triangle[1..].chunks_exact_mut(4).zip([a, b, c]) {
                bytes.copy_from_slice(&index(&corner));
            }
            triangle[TRIANGLE - 3..].copy_from_slice(&colour);
            self.bytes.extend_from_slice(&triangle);
            return;
        }
        self.bytes.push(face.len() as u8);
        match is_mirrored {
            false => self.bytes.extend(face.iter().flat_map(index)),
            true => self.bytes.extend(face.iter().rev().flat_map(index)),
        }
        self.bytes.extend(colour);
    }

    /// Adds a triangle of STL, with its normal.
    fn triangle(&mut self, face: &[usize], is_mirrored: bool) {
        let turn = |point: DVec3| DVec3::new(point.x, -point.z, point.y);
        let [a, b, c] = [0, 1, 2].map(|corner: usize| turn(self.images[face[corner]]));
        let [b, c] = if is_mirrored { [c, b] } else { [b, c] };
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for vector in [normal, a, b, c] {
            push(&mut self.bytes, vector);
        }
        self.bytes.extend([0, 0]);
    }

    /// Writes the bytes of a span, behind `before` corners of earlier ones, and starts another; returns the number
    /// of corners with those of the span.
    pub(super) fn give(&mut self, before: u32, out: &mut impl Write) -> io::Result<u32> {
        if self.pass == Pass::Faces {
            self.refer(before);
        }
        self.pass_on(out)?;
        // STL, which has no corners apart, may have more than are counted here.
        Ok(before.wrapping_add(std::mem::take(&mut self.corners)))
    }

    /// Lets faces refer to corners behind `before` others, in the way of the format.
    pub(super) fn refer(&mut self, before: u32) {
        let of = |bytes: &[u8]| bytes.try_into().map_or(0, u32::from_le_bytes);
        if self.format != MeshFormat::Obj {
            if before == 0 {
                return;
            }
            // All are triangles.
            for triangle in self.bytes.chunks_exact_mut(TRIANGLE) {
                for index in triangle[1..TRIANGLE - 3].chunks_exact_mut(4) {
                    index.copy_from_slice(&(before + of(index)).to_le_bytes());
                }
            }
            return;
        }
        let mut text = Vec::new();
        let mut number = itoa::Buffer::new();
        let mut at = 0;
        while let Some(&corners) = self.bytes.get(at) {
            let end = at + 1 + 4 * usize::from(corners);
            text.push(b'f');
            for index in self.bytes[at + 1..end].chunks_exact(4) {
                // Corners are counted from 1.
                text.push(b' ');
                let corner = u64::from(before) + u64::from(of(index)) + 1;
                text.extend_from_slice(number.format(corner).as_bytes());
            }
            text.push(b'\n');
            at = end + 3;
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

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded to single precision"
)]
fn push(bytes: &mut Vec<u8>, point: DVec3) {
    let mut place = [0; 12];
    for (bytes, number) in place.chunks_exact_mut(4).zip(point.to_array()) {
        bytes.copy_from_slice(&(number as f32 + 0.0).to_le_bytes());
    }
    bytes.extend_from_slice(&place);
}
