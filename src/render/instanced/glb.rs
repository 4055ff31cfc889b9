//! Nested instances as binary glTF 2.0.
//!
//! Nodes form a tree, and only meshes are shared: the last levels of the nests are baked into one mesh for each nest,
//! and the levels above are nodes. Nodes are moved by translations, rotations and scales, so that copies under other
//! maps, sheared or singular, are baked too. Faces are flat, and have no normals.

use std::fmt::Write as _;
use std::io::Write;

use crate::geometry::{DAffine3, DMat3, DVec3};
use crate::saturating::real;
use crate::style::Colour;

use super::super::error::RenderError;
use super::super::options::Labels;
use super::super::space::SpaceError;
use super::nested::{Baked, Content, Nested, Paint, Placed, is_singular};
use super::text::{list, quoted};

/// Limit of the size of a file in bytes.
const MAX_BYTES: u32 = 1 << 28;

/// Approximate number of bytes of a node in the file.
const NODE: f64 = 128.0;

/// Number of bytes of a mesh that take a viewer as long as a node.
const NODE_WEIGHS: f64 = 1024.0;

/// Writes nested instances, of which none is without faces, as a file.
///
/// # Errors
///
/// If the file would be too large, which is computed before any of it is written.
pub(super) fn write(
    nested: &Nested<'_>,
    labels: &Labels,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    let plan = Plan::best(nested)?;
    if plan.bytes > f64::from(MAX_BYTES) {
        return Err(SpaceError::TooLarge {
            bytes: plan.bytes,
            limit: MAX_BYTES.into(),
        }
        .into());
    }
    let mut file = File::default();
    let meshes = (0..nested.nests.len()).map(|number| match plan.is_used[number] {
        true => Ok(file.mesh(&nested.bake(plan.meshed(nested, number).into_iter())?)),
        false => Ok(None),
    });
    let meshes: Vec<Option<usize>> = meshes.collect::<Result<_, RenderError>>()?;
    let nodes = plan.nodes(nested, &meshes);
    let json = file.json(&nodes, labels);
    write_chunks(json, file.binary, out)?;
    Ok(())
}

/// Division of the nests into nodes and meshes.
struct Plan {
    /// Nests that are a mesh as a whole.
    is_baked: Vec<bool>,
    /// Nests that are nodes.
    is_used: Vec<bool>,
    /// Number of nodes of every nest, with itself.
    counts: Vec<f64>,
    /// Number of bytes of all nodes and meshes.
    bytes: f64,
}

impl Plan {
    /// Returns the division that a viewer shows soonest.
    fn best(nested: &Nested<'_>) -> Result<Self, RenderError> {
        let shapes = 0..nested.shapes.len();
        let bytes = shapes.map(|shape| {
            let mesh = nested.mesh(shape)?;
            Ok(12.0 * (real(mesh.corners.len()) + real(mesh.triangles.len())))
        });
        let shapes: Vec<f64> = bytes.collect::<Result<_, RenderError>>()?;
        let mut nests: Vec<f64> = Vec::new();
        for nest in &nested.nests {
            let bytes = nest.instances.iter().map(|it| match it.content {
                Content::Nest(number) => nests[number],
                Content::Shape(number) => shapes[number],
            });
            nests.push(bytes.sum());
        }
        let exponents = 10..=MAX_BYTES.ilog2();
        let plans =
            exponents.map(|exponent| Self::of(nested, &shapes, &nests, f64::from(1 << exponent)));
        let cost = |plan: &Self| {
            plan.bytes + (NODE_WEIGHS - NODE) * plan.counts.last().copied().unwrap_or(0.0)
        };
        let best = plans.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        Ok(best.unwrap_or_else(|| Self::of(nested, &shapes, &nests, 0.0)))
    }

    /// Returns the division where nests of up to a number of bytes are baked.
    fn of(nested: &Nested<'_>, shapes: &[f64], nests: &[f64], most: f64) -> Self {
        let is_baked: Vec<bool> = nests.iter().map(|bytes| *bytes <= most).collect();
        let mut plan = Self {
            is_used: vec![false; nests.len()],
            counts: Vec::new(),
            bytes: 0.0,
            is_baked,
        };
        for number in 0..nests.len() {
            let inner = plan.inner(nested, number).into_iter();
            let inner: f64 = inner.map(|(_, number)| plan.counts[number]).sum();
            plan.counts.push(1.0 + inner);
        }
        if let Some(whole) = plan.is_used.last_mut() {
            *whole = true;
        }
        for number in (0..nests.len()).rev().filter(|&it| nests[it] > 0.0) {
            if !plan.is_used[number] {
                continue;
            }
            for (_, inner) in plan.inner(nested, number) {
                plan.is_used[inner] = true;
            }
            let meshed = plan.meshed(nested, number).into_iter();
            let bytes = meshed.map(|(_, content)| match content {
                Content::Nest(number) => nests[number],
                Content::Shape(number) => shapes[number],
            });
            plan.bytes += bytes.sum::<f64>();
        }
        plan.bytes += NODE * plan.counts.last().copied().unwrap_or(0.0);
        plan
    }

    /// Returns whether an instance in a nest is a node.
    fn is_node(&self, nest: usize, placed: &Placed) -> bool {
        !self.is_baked[nest]
            && matches!(placed.content, Content::Nest(_))
            && Place::of(&placed.map).is_some()
    }

    /// Returns the nests that are nodes in a nest.
    fn inner(&self, nested: &Nested<'_>, nest: usize) -> Vec<(Place, usize)> {
        let (placed, _) = nested.nests[nest].placed(|it| self.is_node(nest, it));
        let nests = placed.iter().filter_map(|it| match it.content {
            Content::Nest(number) => Some((Place::of(&it.map)?, number)),
            Content::Shape(_) => None,
        });
        nests.collect()
    }

    /// Returns the contents of the mesh of a nest.
    fn meshed(&self, nested: &Nested<'_>, nest: usize) -> Vec<(DAffine3, Content)> {
        nested.nests[nest].placed(|it| self.is_node(nest, it)).1
    }

    /// Returns the nodes in the format's notation, each before those that it holds.
    fn nodes(&self, nested: &Nested<'_>, meshes: &[Option<usize>]) -> Vec<String> {
        let mut nodes: Vec<String> = Vec::new();
        let mut open = vec![(Place::IDENTITY, nested.nests.len() - 1)];
        while let Some((place, nest)) = open.pop() {
            let mut parts: Vec<String> = Vec::new();
            parts.extend(meshes[nest].map(|mesh| format!(r#""mesh":{mesh}"#)));
            let inner = self.inner(nested, nest);
            if !inner.is_empty() {
                let mut next = real(nodes.len() + 1);
                let numbers = inner.iter().map(|(_, number)| {
                    let own = next;
                    next += self.counts[*number];
                    own
                });
                let numbers: Vec<f64> = numbers.collect();
                parts.push(format!(r#""children":{}"#, list(['[', ']'], &numbers)));
            }
            parts.extend(place.parts());
            nodes.push(format!("{{{}}}", parts.join(",")));
            open.extend(inner.into_iter().rev());
        }
        nodes
    }
}

/// Place of a node.
#[derive(Clone, Copy)]
struct Place {
    translation: DVec3,
    /// Rotation as a quaternion: x, y, z, w.
    rotation: [f64; 4],
    scale: DVec3,
}

impl Place {
    const IDENTITY: Self = Self {
        translation: DVec3::ZERO,
        rotation: [0.0, 0.0, 0.0, 1.0],
        scale: DVec3::ONE,
    };

    /// Returns the place of a map that scales along three axes at right angles and then rotates; `None` for others.
    fn of(map: &DAffine3) -> Option<Self> {
        /// Cosine of an angle that single precision does not distinguish from a right one.
        const ROUNDING: f64 = 1e-7;
        let linear = map.matrix3;
        if is_singular(map) {
            return None;
        }
        let mut scale = DVec3::new(
            linear.x_axis.length(),
            linear.y_axis.length(),
            linear.z_axis.length(),
        );
        if linear.determinant() < 0.0 {
            scale.x = -scale.x;
        }
        let [x, y, z] = [0, 1, 2].map(|axis| linear.col(axis) / scale[axis]);
        let cosines = [x.dot(y), y.dot(z), z.dot(x)];
        let is_sheared = cosines.iter().any(|cosine| cosine.abs() > ROUNDING);
        (!is_sheared).then(|| Self {
            translation: map.translation,
            rotation: quaternion(&DMat3::from_cols(x, y, z)),
            scale,
        })
    }

    /// Returns the properties of a node.
    fn parts(&self) -> Vec<String> {
        let own = [
            ("translation", &self.translation.to_array()[..], [0.0; 4]),
            ("rotation", &self.rotation[..], Self::IDENTITY.rotation),
            ("scale", &self.scale.to_array()[..], [1.0; 4]),
        ];
        let own = own
            .iter()
            .filter(|(_, own, none)| **own != none[..own.len()]);
        own.map(|(name, own, _)| format!("\"{name}\":{}", floats(own)))
            .collect()
    }
}

/// Returns the unit quaternion of a rotation: x, y, z, w (Shepperd 1978).
fn quaternion(rotation: &DMat3) -> [f64; 4] {
    let [a, b, c] = [rotation.x_axis, rotation.y_axis, rotation.z_axis];
    // Four times the squares of the components, of which the largest is divided by.
    let squares = [
        1.0 + a.x - b.y - c.z,
        1.0 - a.x + b.y - c.z,
        1.0 - a.x - b.y + c.z,
        1.0 + a.x + b.y + c.z,
    ];
    let (xy, yz, zx) = (a.y + b.x, b.z + c.y, c.x + a.z);
    let (x, y, z) = (b.z - c.y, c.x - a.z, a.y - b.x);
    let rows = [
        [squares[0], xy, zx, x],
        [xy, squares[1], yz, y],
        [zx, yz, squares[2], z],
        [x, y, z, squares[3]],
    ];
    let largest = (0..4).max_by(|p, q| squares[*p].total_cmp(&squares[*q]));
    let row = rows[largest.unwrap_or(3)];
    let length = row.iter().map(|it| it * it).sum::<f64>().sqrt();
    row.map(|it| it / length)
}

/// Returns a list of numbers in single precision.
fn floats(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|number| float(*number)).collect();
    format!("[{}]", numbers.join(","))
}

/// Returns the shortest text of a number in single precision.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded to single precision"
)]
fn float(number: f64) -> String {
    // The addition turns -0 into 0.
    format!("{}", number as f32 + 0.0)
}

/// Parts of a file that meshes make.
#[derive(Default)]
struct File {
    binary: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    meshes: Vec<String>,
    materials: Vec<Paint>,
}

impl File {
    /// Adds a mesh, and returns its number; `None` if it has no triangles.
    fn mesh(&mut self, mesh: &Baked) -> Option<usize> {
        let mut paints: Vec<Paint> = Vec::new();
        for (_, paint) in &mesh.triangles {
            if paints.last() != Some(paint) {
                paints.push(*paint);
            }
        }
        paints.sort_by_key(|it| (it.colour.rgba(), it.has_two_sides));
        paints.dedup();
        mesh.triangles.first()?;
        let first = mesh.corners.first()?.as_vec3();
        let (mut low, mut high) = (first, first);
        let start = self.binary.len();
        for corner in &mesh.corners {
            let corner = corner.as_vec3();
            (low, high) = (low.min(corner), high.max(corner));
            for number in corner.to_array() {
                self.binary.extend((number + 0.0).to_le_bytes());
            }
        }
        let count = mesh.corners.len();
        let [low, high] = [low, high].map(|it| floats(&it.as_dvec3().to_array()));
        let corners = self.accessor(start, 34962, 5126, count, "VEC3");
        let _ = write!(self.accessors[corners], r#","min":{low},"max":{high}}}"#);
        let mut primitives = Vec::new();
        for paint in paints {
            let start = self.binary.len();
            let own = mesh.triangles.iter().filter(|(_, own)| *own == paint);
            let mut indices = 0;
            let is_short = count <= usize::from(u16::MAX);
            for corner in own.flat_map(|(corners, _)| corners) {
                indices += 1;
                let bytes = corner.to_le_bytes();
                self.binary.extend(&bytes[..if is_short { 2 } else { 4 }]);
            }
            let kind = if is_short { 5123 } else { 5125 };
            let accessor = self.accessor(start, 34963, kind, indices, "SCALAR");
            self.accessors[accessor].push('}');
            let material = self.material(paint);
            primitives.push(format!(
                r#"{{"attributes":{{"POSITION":{corners}}},"indices":{accessor},"material":{material}}}"#
            ));
        }
        self.meshes
            .push(format!(r#"{{"primitives":[{}]}}"#, primitives.join(",")));
        Some(self.meshes.len() - 1)
    }

    /// Adds the numbers from a byte on to the end, and returns that of their accessor, which remains open.
    fn accessor(
        &mut self,
        start: usize,
        target: u32,
        kind: u32,
        count: usize,
        shape: &str,
    ) -> usize {
        let length = self.binary.len() - start;
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.views.push(format!(
            r#"{{"buffer":0,"byteOffset":{start},"byteLength":{length},"target":{target}}}"#
        ));
        self.accessors.push(format!(
            r#"{{"bufferView":{},"componentType":{kind},"count":{count},"type":"{shape}""#,
            self.views.len() - 1
        ));
        self.accessors.len() - 1
    }

    /// Returns the number of a material.
    fn material(&mut self, paint: Paint) -> usize {
        let known = self.materials.iter().position(|own| *own == paint);
        known.unwrap_or_else(|| {
            self.materials.push(paint);
            self.materials.len() - 1
        })
    }

    fn json(&self, nodes: &[String], labels: &Labels) -> String {
        let about = [
            ("title", &labels.title),
            ("description", &labels.description),
            ("provenance", &labels.provenance),
        ];
        let about = about.into_iter().filter(|(_, text)| !text.is_empty());
        let about = about.map(|(name, text)| format!("\"{name}\":{}", quoted(text)));
        let about: Vec<String> = about.collect();
        let materials: Vec<String> = self.materials.iter().map(material).collect();
        let mut json = format!(
            r#"{{"asset":{{"version":"2.0","generator":"kfrac {}","extras":{{{}}}}},"scene":0,"scenes":[{{"nodes":[0]}}]"#,
            env!("CARGO_PKG_VERSION"),
            about.join(",")
        );
        let all = [
            ("nodes", nodes),
            ("meshes", &self.meshes),
            ("materials", &materials),
            ("accessors", &self.accessors),
            ("bufferViews", &self.views),
        ];
        // Lists that are empty are invalid.
        for (name, items) in all.iter().filter(|(_, items)| !items.is_empty()) {
            let _ = write!(json, ",\n\"{name}\":[\n{}\n]", items.join(",\n"));
        }
        if !self.binary.is_empty() {
            let _ = write!(
                json,
                ",\n\"buffers\":[{{\"byteLength\":{}}}]",
                self.binary.len()
            );
        }
        json + "}\n"
    }
}

/// Returns the notation of a material. Colours are linear.
fn material(paint: &Paint) -> String {
    let linear = |part: u8| {
        let part = f64::from(part) / 255.0;
        match part <= 0.04045 {
            true => part / 12.92,
            false => libm::pow((part + 0.055) / 1.055, 2.4),
        }
    };
    let Paint {
        colour,
        has_two_sides,
    } = paint;
    let [red, green, blue, alpha] = Colour::rgba(*colour);
    let colour = floats(&[
        linear(red),
        linear(green),
        linear(blue),
        f64::from(alpha) / 255.0,
    ]);
    let blend = match alpha {
        255 => "",
        _ => r#","alphaMode":"BLEND""#,
    };
    let sides = match has_two_sides {
        true => r#","doubleSided":true"#,
        false => "",
    };
    format!(
        r#"{{"pbrMetallicRoughness":{{"baseColorFactor":{colour},"metallicFactor":0,"roughnessFactor":1}}{blend}{sides}}}"#
    )
}

/// Writes the two chunks of a file, filled to multiples of four bytes.
fn write_chunks(json: String, binary: Vec<u8>, out: &mut impl Write) -> Result<(), RenderError> {
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunks = [(json, b"JSON"), (binary, b"BIN\0")];
    let chunks = chunks.iter().filter(|(bytes, _)| !bytes.is_empty());
    let length: usize = 12
        + chunks
            .clone()
            .map(|(bytes, _)| bytes.len() + 8)
            .sum::<usize>();
    let fits = |length: usize| {
        let limit = MAX_BYTES.into();
        u32::try_from(length).map_err(|_| SpaceError::TooLarge {
            bytes: real(length),
            limit,
        })
    };
    out.write_all(b"glTF\x02\0\0\0")?;
    out.write_all(&fits(length)?.to_le_bytes())?;
    for (bytes, name) in chunks {
        out.write_all(&fits(bytes.len())?.to_le_bytes())?;
        out.write_all(*name)?;
        out.write_all(bytes)?;
    }
    Ok(())
}
