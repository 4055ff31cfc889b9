//! Nested instances as objects of components in 3MF, the 3D Manufacturing Format (core specification 1.3).
//!
//! Components may have any map that is not singular; copies under other maps, and surfaces of elements, are meshes of
//! their own. z points up, and the object stands on z = 0 in the corner of the positive axes.

use std::io::{BufWriter, Cursor, Write};

use zip::write::{SimpleFileOptions, ZipWriter};
use zip::{CompressionMethod, DateTime};

use crate::geometry::{Bounds, DAffine3, DMat3, DVec3};
use crate::style::Colour;

use super::super::canvas::Size;
use super::super::error::RenderError;
use super::super::options::Options;
use super::super::svg::escaped;
use super::super::unit::Unit;
use super::nested::{Baked, Content, Nest, Nested, Placed, is_singular};

/// Length of the long side in millimetres, unless the options give one.
const LONG_SIDE: f64 = 100.0;

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;

const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// Bytes of the model that are compressed at once.
const CHUNK: usize = 1 << 16;

/// Number of the resource that lists the colours.
const COLOURS: usize = 1;

/// Writes nested instances, of which none is without faces, as a package.
pub(super) fn write(
    nested: &Nested<'_>,
    bounds: Option<&Bounds<DVec3>>,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    let mut package = ZipWriter::new(Cursor::new(Vec::new()));
    // Files of equal content are equal in bytes: they have no time.
    let compressed = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    let failed = |error: zip::result::ZipError| std::io::Error::other(error);
    for (name, text) in [("[Content_Types].xml", TYPES), ("_rels/.rels", RELATIONS)] {
        package.start_file(name, compressed).map_err(failed)?;
        package.write_all(text.as_bytes())?;
    }
    package
        .start_file("3D/3dmodel.model", compressed)
        .map_err(failed)?;
    // The compressor takes as long for a few bytes as for many.
    let mut text = BufWriter::with_capacity(CHUNK, &mut package);
    let model = Model {
        nested,
        colours: nested.colours(),
        is_flat: { 0..nested.shapes.len() }
            .map(|it| nested.is_flat(it))
            .collect(),
        out: &mut text,
        objects: COLOURS,
    };
    model.write(&upright(bounds, options), options)?;
    text.flush()?;
    drop(text);
    let package = package.finish().map_err(failed)?;
    out.write_all(package.get_ref())?;
    Ok(())
}

/// Returns the map of the set to millimetres, with z upwards.
fn upright(bounds: Option<&Bounds<DVec3>>, options: &Options) -> DAffine3 {
    let long = match (options.unit, options.size) {
        (Unit::Pixel, _) => LONG_SIDE,
        (unit, Size::Long(side)) => f64::from(side) * unit.millimetres(),
        (unit, Size::Exactly(width, height)) => f64::from(width.min(height)) * unit.millimetres(),
    };
    let Some(bounds) = bounds.filter(|it| it.size().max_element() > 0.0) else {
        return DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y));
    };
    let scale = long / bounds.size().max_element();
    let linear = DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y) * scale;
    let corner = DVec3::new(bounds.min().x, bounds.min().y, bounds.max().z);
    DAffine3::from_mat3_translation(linear, -(linear * corner))
}

/// Model that is being written.
struct Model<'a, W> {
    nested: &'a Nested<'a>,
    /// Colours that differ.
    colours: Vec<Colour>,
    /// Whether shapes are single faces, by number.
    is_flat: Vec<bool>,
    out: W,
    /// Number of the last resource.
    objects: usize,
}

impl<W: Write> Model<'_, W> {
    fn write(mut self, upright: &DAffine3, options: &Options) -> Result<(), RenderError> {
        let nested = self.nested;
        self.head(options)?;
        let mut shapes = Vec::new();
        for shape in 0..nested.shapes.len() {
            shapes.push(match self.is_flat[shape] {
                true => None,
                false => self.mesh(&nested.mesh(shape)?)?,
            });
        }
        let mut nests: Vec<Option<usize>> = Vec::new();
        for nest in &nested.nests {
            let number = self.nest(nest, &shapes, &nests)?;
            nests.push(number);
        }
        write!(self.out, "</resources>\n<build>")?;
        if let Some(whole) = nests.last().copied().flatten() {
            let map = matrix(upright);
            write!(self.out, r#"<item objectid="{whole}" transform="{map}"/>"#)?;
        }
        self.out.write_all(b"</build>\n</model>\n")?;
        Ok(())
    }

    fn head(&mut self, options: &Options) -> std::io::Result<()> {
        let labels = &options.labels;
        self.out.write_all(
            b"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" \
              xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n",
        )?;
        let application = concat!("kfrac ", env!("CARGO_PKG_VERSION")).to_owned();
        let about = [
            ("Title", &labels.title),
            ("Description", &labels.description),
            ("Application", &application),
        ];
        for (name, text) in about.into_iter().filter(|(_, text)| !text.is_empty()) {
            let text = escaped(text);
            writeln!(self.out, r#"<metadata name="{name}">{text}</metadata>"#)?;
        }
        write!(self.out, "<resources>\n<basematerials id=\"{COLOURS}\">")?;
        for colour in &self.colours {
            let [red, green, blue, alpha] = colour.rgba();
            let colour = format!("#{red:02X}{green:02X}{blue:02X}{alpha:02X}");
            write!(
                self.out,
                r#"<base name="{colour}" displaycolor="{colour}"/>"#
            )?;
        }
        self.out.write_all(b"</basematerials>\n")
    }

    /// Returns the number of a colour among the materials.
    fn material(&self, colour: Colour) -> usize {
        { self.colours.iter() }
            .position(|own| *own == colour)
            .unwrap_or(0)
    }

    /// Writes an object of triangles, and returns its number; `None` if there are none.
    fn mesh(&mut self, mesh: &Baked) -> std::io::Result<Option<usize>> {
        let Some((_, first)) = mesh.triangles.first() else {
            return Ok(None);
        };
        self.objects += 1;
        let number = self.objects;
        // A surface need not be closed.
        let kind = match mesh.is_closed() {
            true => "model",
            false => "surface",
        };
        let own = self.material(first.colour);
        writeln!(
            self.out,
            r#"<object id="{number}" type="{kind}" pid="{COLOURS}" pindex="{own}"><mesh><vertices>"#
        )?;
        for corner in &mesh.corners {
            let [x, y, z] = corner.as_vec3().to_array().map(|at| at + 0.0);
            writeln!(self.out, r#"<vertex x="{x}" y="{y}" z="{z}"/>"#)?;
        }
        self.out.write_all(b"</vertices><triangles>\n")?;
        let mut known = (first.colour, own);
        for ([a, b, c], paint) in &mesh.triangles {
            if paint.colour != known.0 {
                known = (paint.colour, self.material(paint.colour));
            }
            write!(self.out, r#"<triangle v1="{a}" v2="{b}" v3="{c}""#)?;
            if known.1 != own {
                write!(self.out, r#" pid="{COLOURS}" p1="{}""#, known.1)?;
            }
            self.out.write_all(b"/>\n")?;
        }
        self.out.write_all(b"</triangles></mesh></object>\n")?;
        Ok(Some(number))
    }

    /// Writes an object of components, behind the mesh of copies that are no components, and returns its number;
    /// `None` if there are none.
    fn nest(
        &mut self,
        nest: &Nest,
        shapes: &[Option<usize>],
        nests: &[Option<usize>],
    ) -> Result<Option<usize>, RenderError> {
        // The surfaces of an element are one mesh, which encloses its volume.
        let is_flat = |it: &Placed| match it.content {
            Content::Nest(_) => false,
            Content::Shape(number) => self.is_flat[number],
        };
        let (placed, others) = nest.placed(|it| !is_singular(&it.map) && !is_flat(it));
        let baked = self.nested.bake(others.into_iter())?;
        let baked = self.mesh(&baked)?.map(|it| (it, DAffine3::IDENTITY));
        let components = placed.iter().filter_map(|it| {
            let target = match it.content {
                Content::Nest(number) => nests[number],
                Content::Shape(number) => shapes[number],
            };
            Some((target?, it.map))
        });
        let components: Vec<(usize, DAffine3)> = components.chain(baked).collect();
        if components.is_empty() {
            return Ok(None);
        }
        self.objects += 1;
        let number = self.objects;
        writeln!(self.out, r#"<object id="{number}"><components>"#)?;
        for (target, map) in components {
            let map = matrix(&map);
            writeln!(
                self.out,
                r#"<component objectid="{target}" transform="{map}"/>"#
            )?;
        }
        self.out.write_all(b"</components></object>\n")?;
        Ok(Some(number))
    }
}

/// Returns a map as a matrix that acts on rows, without its last column.
fn matrix(map: &DAffine3) -> String {
    // The addition turns -0 into 0.
    let numbers = map.to_cols_array().map(|number| (number + 0.0).to_string());
    numbers.join(" ")
}
