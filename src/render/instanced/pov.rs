//! Nested instances as a scene for POV-Ray, as text: with a camera that shows what a picture of the set shows, and a
//! light.
//!
//! Round solids are primitives, others meshes. The text grows with the graph; POV-Ray itself expands what it reads.
//! Its matrices must not be singular, so that copies under other maps are meshes of their own.

use std::io::{self, Write};

use crate::geometry::{DAffine3, DVec3, Round};
use crate::style::Colour;

use super::super::error::RenderError;
use super::super::options::Options;
use super::super::space::{Eye, PAPER};
use super::nested::{Baked, Content, Nest, Nested, is_singular};
use super::text::list;

/// Writes nested instances, of which none is without faces, as a scene.
pub(super) fn write(
    nested: &Nested<'_>,
    eye: &Eye,
    ambient: f64,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    head(eye, ambient, options, out)?;
    for shape in 0..nested.shapes.len() {
        write!(out, "#declare E{shape} = ")?;
        declare_shape(nested, shape, out)?;
    }
    let Some((whole, nests)) = nested.nests.split_last() else {
        return Ok(());
    };
    for (number, nest) in nests.iter().enumerate() {
        if !nest.instances.is_empty() {
            write!(out, "#declare O{number} = ")?;
            union(nested, nest, out)?;
        }
    }
    union(nested, whole, out)
}

fn head(eye: &Eye, ambient: f64, options: &Options, out: &mut impl Write) -> io::Result<()> {
    let labels = &options.labels;
    for text in [&labels.title, &labels.description] {
        let line: String = text.chars().filter(|it| !it.is_control()).collect();
        writeln!(out, "// {line}")?;
    }
    let [width, height] = eye.size;
    let kind = match eye.is_parallel {
        true => "orthographic",
        false => "perspective",
    };
    let [right, up] = eye.sides.map(vector);
    let paper = options.style.background.unwrap_or(PAPER);
    let light = eye.location + eye.light * (eye.far * 100.0);
    write!(
        out,
        "// povray +W{width} +H{height} +A FILE\n#version 3.7;\nglobal_settings {{ assumed_gamma 1 }}\n\
         background {{ {} }}\n#default {{ finish {{ ambient {ambient} diffuse 1 }} }}\n\
         // Right-handed: x to the right, y upwards, z towards the viewer.\n\
         camera {{\n  {kind}\n  location {}\n  direction {}\n  right {right}\n  up {up}\n}}\n\
         light_source {{ {} color rgb 1 parallel point_at {} }}\n",
        colour(paper),
        vector(eye.location),
        vector(eye.ahead),
        vector(light),
        vector(eye.location),
    )
}

/// Writes the rest of the declaration of a shape.
fn declare_shape(
    nested: &Nested<'_>,
    shape: usize,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    let solid = nested.solid(shape);
    let Some(primitive) = solid.primitive().filter(|_| !is_singular(solid.place())) else {
        return mesh(&nested.mesh(shape)?, out);
    };
    let text = match primitive {
        Round::Ball => "sphere { 0, 1",
        Round::Cylinder => "cylinder { 0, y, 1",
        Round::Cone => "cone { 0, 1, y, 0",
    };
    let (_, own) = nested.shapes[shape];
    let (place, own) = (matrix(solid.place()), pigment(own));
    writeln!(out, "{text} matrix {place} {own} }}")?;
    Ok(())
}

/// Writes a mesh, or nothing if it has no triangles.
fn mesh(mesh: &Baked, out: &mut impl Write) -> Result<(), RenderError> {
    if mesh.triangles.is_empty() {
        return Ok(());
    }
    let mut colours: Vec<Colour> = Vec::new();
    let mut number = |own: Colour| {
        let known = colours.iter().rposition(|colour| *colour == own);
        known.unwrap_or_else(|| {
            colours.push(own);
            colours.len() - 1
        })
    };
    let numbers = mesh.triangles.iter().map(|(_, paint)| number(paint.colour));
    let numbers: Vec<usize> = numbers.collect();
    writeln!(out, "mesh2 {{ vertex_vectors {{ {}", mesh.corners.len())?;
    for corner in &mesh.corners {
        write!(out, ",{}", vector(corner.as_vec3().as_dvec3()))?;
    }
    writeln!(out, "\n}} texture_list {{ {}", colours.len())?;
    for colour in &colours {
        write!(out, ",texture {{ {} }}", pigment(*colour))?;
    }
    writeln!(out, "\n}} face_indices {{ {}", mesh.triangles.len())?;
    for (([a, b, c], _), number) in mesh.triangles.iter().zip(numbers) {
        write!(out, ",<{a},{b},{c}>,{number}")?;
    }
    out.write_all(b"\n} }\n")?;
    Ok(())
}

/// Writes the union of the instances of a nest.
fn union(nested: &Nested<'_>, nest: &Nest, out: &mut impl Write) -> Result<(), RenderError> {
    out.write_all(b"union {\n")?;
    let (placed, others) = nest.placed(|it| !is_singular(&it.map));
    for instance in &placed {
        let (letter, number) = match instance.content {
            Content::Nest(number) => ('O', number),
            Content::Shape(number) => ('E', number),
        };
        let map = matrix(&instance.map);
        writeln!(out, "object {{ {letter}{number} matrix {map} }}")?;
    }
    mesh(&nested.bake(others.into_iter())?, out)?;
    out.write_all(b"}\n")?;
    Ok(())
}

fn vector(vector: DVec3) -> String {
    list(['<', '>'], &vector.to_array())
}

/// Returns a map as a matrix that acts on rows, without its last column.
fn matrix(map: &DAffine3) -> String {
    list(['<', '>'], &map.to_cols_array())
}

fn pigment(own: Colour) -> String {
    format!("pigment {{ {} }}", colour(own))
}

fn colour(colour: Colour) -> String {
    let [red, green, blue, alpha] = colour.rgba().map(|part| f64::from(part) / 255.0);
    format!(
        "color srgbt <{red:.4},{green:.4},{blue:.4},{:.4}>",
        1.0 - alpha
    )
}
