//! Nested instances as a scene in Pixar's Universal Scene Description, as text (`.usda`).
//!
//! Every object and number of remaining steps is an abstract prim, whose children are instanceable references to
//! those of the instances that replace the object. Readers keep one prototype for each, so that the size of the
//! file and of the scene in memory grow with the graph and the number of steps, not with the number of elements
//! (Hart 1992, section 2). y points up, and matrices act on rows.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::geometry::{DAffine3, DVec3, Frame3, Mesh, Round, Solid};
use crate::graph::{Chain, Graph};
use crate::grow::WalkError;
use crate::instancing::Appearance;
use crate::style::Colour;

use super::super::colours::Colours;
use super::super::error::RenderError;
use super::super::options::Options;
use super::super::picture::Instanced;
use super::symbols::{Aspect, Dress, Part, Symbol, Symbols};
use super::{MAX_SYMBOLS, NotInstanced, refusal};

/// Writes approximant `steps` of a set in space as nested instances: a scene in Universal Scene Description, as
/// text. Of the options, the style's colours and the labels apply.
///
/// # Errors
///
/// If instances cannot represent the approximant or its colours, if it is cancelled, or if `out` fails.
pub fn write_usda(
    graph: &Graph<Frame3>,
    steps: u32,
    options: &Options,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<Instanced, RenderError> {
    let style = &options.style;
    refusal::check(graph, style, steps)?;
    let colours = Colours::of(style, graph, steps)?;
    let start = Aspect {
        // The initiator replaces a virtual object that has one more step.
        steps: steps + 1,
        part: Part::All,
        dress: Dress(Appearance::NONE),
    };
    let symbols = Symbols::new(graph, style.color_by, colours.classes());
    let initiator = graph.initiator(steps);
    let all = symbols.collect(initiator, [start].into_iter(), MAX_SYMBOLS);
    let all = all.ok_or(NotInstanced::TooManySymbols)?;
    let mut scene = Scene {
        graph,
        steps,
        options,
        colours,
        symbols,
        written: BTreeMap::new(),
        shapes: BTreeMap::new(),
        text: String::new(),
    };
    scene.head();
    for symbol in all {
        if cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
            return Err(RenderError::Walk(WalkError::Cancelled));
        }
        scene.define(symbol);
        out.write_all(scene.text.as_bytes())?;
        scene.text.clear();
    }
    let (world, expanded) = scene.children(initiator, &start);
    writeln!(out, "{}def Xform \"World\"\n{{\n{world}}}", scene.text)?;
    Ok(Instanced {
        symbols: scene.written.len() as u64,
        expanded,
    })
}

/// Prim that represents a symbol.
#[derive(Clone, Copy)]
struct Prim {
    number: usize,
    /// Number of elements and instances to which it expands, including itself.
    expanded: f64,
}

/// Scene that is being written.
struct Scene<'a> {
    graph: &'a Graph<Frame3>,
    steps: u32,
    options: &'a Options,
    colours: Colours<'a>,
    symbols: Symbols<'a, Frame3>,
    /// Prims of symbols that are not empty.
    written: BTreeMap<Symbol, Prim>,
    /// Numbers of prims of base elements, by number and colour.
    shapes: BTreeMap<(usize, [u8; 4]), usize>,
    text: String,
}

impl Scene<'_> {
    fn head(&mut self) {
        let labels = &self.options.labels;
        let about = [
            ("title", &labels.title),
            ("description", &labels.description),
            ("provenance", &labels.provenance),
        ];
        let about = about.into_iter().filter(|(_, text)| !text.is_empty());
        let about: String = about
            .map(|(name, text)| format!("        string {name} = {}\n", quoted(text)))
            .collect();
        self.text = format!(
            "#usda 1.0\n(\n    customLayerData = {{\n{about}    }}\n    defaultPrim = \"World\"\n    \
             metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
        );
    }

    /// Writes the prim of a symbol of an object that is replaced, unless nothing is drawn for it.
    fn define(&mut self, symbol: Symbol) {
        let Some(successor) = self.symbols.successor(&symbol) else {
            return;
        };
        let (children, expanded) = self.children(&successor.body, &symbol.aspect);
        if children.is_empty() {
            return;
        }
        let prim = Prim {
            number: self.written.len(),
            expanded: expanded + 1.0,
        };
        let name = prim.number;
        self.text
            .push_str(&format!("class Xform \"o{name}\"\n{{\n{children}}}\n\n"));
        self.written.insert(symbol, prim);
    }

    /// Returns references to the prims of the instances of a chain, and the number of elements and instances to
    /// which they expand. Writes the prims of base elements that are new.
    fn children(&mut self, chain: &Chain<Frame3>, of: &Aspect) -> (String, f64) {
        let (mut text, mut expanded) = (String::new(), 0.0);
        for instance in &chain.instances {
            let Some(symbol) = self.symbols.child(instance, of, false) else {
                continue;
            };
            let target = if self.symbols.successor(&symbol).is_some() {
                let Some(prim) = self.written.get(&symbol) else {
                    continue;
                };
                expanded += prim.expanded + 1.0;
                format!("o{}", prim.number)
            } else {
                expanded += 2.0;
                format!("e{}", self.shape(&symbol, self.steps + 1 - of.steps))
            };
            let map = matrix(instance.frame.map());
            let position = instance.position;
            // A brace that closes stands on a line of its own.
            let _ = write!(
                text,
                "def \"i{position}\"(instanceable=true;references=</{target}>){{\nmatrix4d xformOp:transform={map}\n\
                 uniform token[] xformOpOrder=[\"xformOp:transform\"]\n}}\n"
            );
        }
        (text, expanded)
    }

    /// Returns the number of the prim of an element that is born in a step, and writes it if it is new.
    fn shape(&mut self, symbol: &Symbol, born: u32) -> usize {
        let object = &self.graph.objects()[symbol.object];
        let Dress(appearance) = symbol.aspect.dress;
        let colour = self.colours.at(object, born, appearance);
        let element = object.base_element;
        let next = self.shapes.len();
        let number = *self.shapes.entry((element, colour.rgba())).or_insert(next);
        if number == next {
            let shape = shape(&self.graph.base_elements()[element], colour);
            self.text
                .push_str(&format!("class Xform \"e{number}\"\n{{\n{shape}}}\n\n"));
        }
        number
    }
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
                u8::from(faces.len() == 1),
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
    let [x, y, z] = point.to_array().map(|number| number + 0.0);
    format!("({x},{y},{z})")
}

/// Returns a map as a matrix that acts on rows.
fn matrix(map: &DAffine3) -> String {
    let linear = map.matrix3;
    let rows = [linear.x_axis, linear.y_axis, linear.z_axis, map.translation];
    let rows = rows.iter().zip([0, 0, 0, 1]).map(|(row, last)| {
        // The addition turns -0 into 0.
        let [x, y, z] = row.to_array().map(|number| number + 0.0);
        format!("({x},{y},{z},{last})")
    });
    format!("({})", rows.collect::<Vec<_>>().join(","))
}

/// Returns a text as a string of one line.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            '\n' => quoted.push_str("\\n"),
            '\r' => quoted.push_str("\\r"),
            '\t' => quoted.push_str("\\t"),
            _ => quoted.push(letter),
        }
    }
    quoted + "\""
}
