//! Nested instances as a scene in Pixar's Universal Scene Description, as text (`.usda`).
//!
//! Every object and number of remaining steps is an abstract prim, whose children are instanceable references to
//! those of the instances that replace the object. Readers keep one prototype for each, so that the size of the
//! file and of the scene in memory grow with the graph and the number of steps, not with the number of elements
//! (Hart 1992, section 2). y points up, and matrices act on rows.

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::geometry::{DAffine3, DVec3, Mesh, Round, Solid};
use crate::style::Colour;

use super::super::options::Labels;
use super::nested::{Content, Nest, Nested};
use super::text::{list, quoted};

/// Writes nested instances as a scene.
pub(super) fn write(nested: &Nested<'_>, labels: &Labels, out: &mut impl Write) -> io::Result<()> {
    out.write_all(head(labels).as_bytes())?;
    for (number, (_, colour)) in nested.shapes.iter().enumerate() {
        let shape = shape(nested.solid(number), *colour);
        write!(out, "class Xform \"e{number}\"\n{{\n{shape}}}\n\n")?;
    }
    let Some((whole, nests)) = nested.nests.split_last() else {
        return Ok(());
    };
    for (number, nest) in nests.iter().enumerate() {
        let instances = instances(nest);
        write!(out, "class Xform \"o{number}\"\n{{\n{instances}}}\n\n")?;
    }
    writeln!(out, "def Xform \"World\"\n{{\n{}}}", instances(whole))
}

fn head(labels: &Labels) -> String {
    let about = [
        ("title", &labels.title),
        ("description", &labels.description),
        ("provenance", &labels.provenance),
    ];
    let about = about.into_iter().filter(|(_, text)| !text.is_empty());
    let about: String = about
        .map(|(name, text)| format!("        string {name} = {}\n", quoted(text)))
        .collect();
    format!(
        "#usda 1.0\n(\n    customLayerData = {{\n{about}    }}\n    defaultPrim = \"World\"\n    \
         metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
    )
}

/// Returns references to the prims of the instances of a nest.
fn instances(nest: &Nest) -> String {
    let mut text = String::new();
    for (number, instance) in nest.instances.iter().enumerate() {
        let target = match instance.content {
            Content::Nest(number) => format!("o{number}"),
            Content::Shape(number) => format!("e{number}"),
        };
        let map = matrix(&instance.map);
        // A brace that closes stands on a line of its own.
        let _ = write!(
            text,
            "def \"i{number}\"(instanceable=true;references=</{target}>){{\nmatrix4d xformOp:transform={map}\n\
             uniform token[] xformOpOrder=[\"xformOp:transform\"]\n}}\n"
        );
    }
    text
}

/// Returns the prim of a convex solid.
fn shape(solid: &Solid, colour: Colour) -> String {
    let mut text = match solid.primitive() {
        Some(primitive) => round(primitive, solid.place()),
        None => polyhedron(solid),
    };
    let [red, green, blue, alpha] = colour.rgba().map(|part| f64::from(part) / 255.0);
    let _ = writeln!(
        text,
        "color3f[] primvars:displayColor=[({red:.4},{green:.4},{blue:.4})]"
    );
    if alpha < 1.0 {
        let _ = writeln!(text, "float[] primvars:displayOpacity=[{alpha:.4}]");
    }
    text + "}\n"
}

/// Returns the beginning of the prim of a round primitive. Cylinders and cones of the format have their origins in
/// the middle of their height.
fn round(primitive: Round, place: &DAffine3) -> String {
    let (shape, low) = match primitive {
        Round::Cylinder => ("Cylinder", -0.5),
        Round::Cone => ("Cone", -0.5),
        _ => ("Sphere", -1.0),
    };
    let middle = DVec3::Y * if shape == "Sphere" { 0.0 } else { 0.5 };
    let place = *place * DAffine3::from_translation(middle);
    let axis = match shape {
        "Sphere" => "",
        _ => "uniform token axis=\"Y\"\ndouble height=1\n",
    };
    let (low, high) = (DVec3::new(-1.0, low, -1.0), DVec3::new(1.0, -low, 1.0));
    format!(
        "def {shape} \"shape\"\n{{\n{axis}double radius=1\nfloat3[] extent=[{},{}]\n\
         matrix4d xformOp:transform={}\nuniform token[] xformOpOrder=[\"xformOp:transform\"]\n",
        point(low),
        point(high),
        matrix(&place)
    )
}

/// Returns the beginning of the prim of a polyhedron, or of a segment or a point.
fn polyhedron(solid: &Solid) -> String {
    let Mesh { corners, faces } = solid.into();
    let corners = match faces.is_empty() {
        true => Solid::hull(solid.corners()).corners().to_vec(),
        false => corners,
    };
    let indices: Vec<String> = faces.iter().flatten().map(usize::to_string).collect();
    let points: Vec<String> = corners.iter().map(|corner| point(*corner)).collect();
    let points = points.join(",");
    let shape = match corners.len() {
        1 => "def Points \"shape\"\n{\n".into(),
        2 => "def BasisCurves \"shape\"\n{\nint[] curveVertexCounts=[2]\nuniform token type=\"linear\"\n"
            .into(),
        _ => {
            let counts: Vec<String> = faces.iter().map(|face| face.len().to_string()).collect();
            format!(
                "def Mesh \"shape\"\n{{\nuniform bool doubleSided={}\nint[] faceVertexCounts=[{}]\n\
                 int[] faceVertexIndices=[{}]\nuniform token subdivisionScheme=\"none\"\n",
                u8::from(solid.side().map_or(faces.len() == 1, |side| side.is_double)),
                counts.join(","),
                indices.join(","),
            )
        }
    };
    let [low, high] = [DVec3::min, DVec3::max].map(|pick: fn(DVec3, DVec3) -> DVec3| {
        let corners = corners.iter().copied();
        point(corners.reduce(pick).unwrap_or_default())
    });
    format!("{shape}point3f[] points=[{points}]\nfloat3[] extent=[{low},{high}]\n")
}

fn point(point: DVec3) -> String {
    list(['(', ')'], &point.to_array())
}

/// Returns a map as a matrix that acts on rows.
fn matrix(map: &DAffine3) -> String {
    let linear = map.matrix3;
    let rows = [linear.x_axis, linear.y_axis, linear.z_axis, map.translation];
    let rows = rows.iter().zip([0.0, 0.0, 0.0, 1.0]);
    let rows = rows.map(|(row, last)| list(['(', ')'], &row.extend(last).to_array()));
    format!("({})", rows.collect::<Vec<_>>().join(","))
}
