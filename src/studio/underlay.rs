//! A picture under the figures of a design, and its collage by the maps of the system.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use serde_json::{Value, json};

use crate::cli::pixels::{PixelArguments, PixelSet};
use crate::document::Setting;
use crate::document::node::{Node, Value as Content};
use crate::fit::{Candidate, Disk, Silhouette};
use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::import::Raster;
use crate::kind::Kind;
use crate::model::Model;
use crate::saturating::real;

use super::answer::Refusal;
use super::design::Names;
use super::good::Good;
use super::look::Look;
use super::vary;

/// Largest number of bytes of a picture.
pub(super) const MOST_BYTES: usize = 64 << 20;

/// Largest number of pixels of a picture.
const MOST_PIXELS: usize = 100_000_000;

/// Number of pixels of the longer side of the picture whose collage is measured.
const MEASURED: usize = 512;

/// Picture under the figures of a design.
#[derive(Clone, Debug)]
pub(super) struct Underlay {
    name: String,
    /// Hash of the bytes.
    id: String,
    /// Picture as browsers show it, with its media type.
    pub(super) shown: (Arc<[u8]>, &'static str),
    /// Its pixels that are dark or opaque, or the reason why they are no shape.
    shape: Result<Shape, String>,
    /// Number, quality and threshold of the pixels.
    about: String,
    size: [usize; 2],
    place: Place,
}

/// Shape of a picture.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) silhouette: Arc<Silhouette>,
    /// The shape in fewer pixels, with the factor of its coordinates.
    reduced: Arc<(Silhouette, f64)>,
}

/// Place of a picture in the plane: its lower left corner, and its width.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    corner: DVec2,
    width: f64,
}

impl Underlay {
    /// Reads a picture.
    pub(super) fn read(name: &str, bytes: &[u8], good: Option<&Good>) -> Result<Self, Refusal> {
        let raster = Raster::read(bytes, None);
        let raster = raster.map_err(|error| Refusal::wrong(chain(&error)))?;
        let size = [raster.width, raster.height];
        if size[0].saturating_mul(size[1]) > MOST_PIXELS {
            let message = format!("a picture has {MOST_PIXELS} pixels at most");
            return Err(Refusal::wrong(message));
        }
        let shown = match browser_type(bytes) {
            Some(kind) => (bytes.into(), kind),
            None => {
                let light: Vec<u8> = raster.values.iter().map(|dark| 255 - dark).collect();
                (png(&light, size, png::ColorType::Grayscale)?, "image/png")
            }
        };
        let set = PixelArguments::default().decide(name.to_owned(), raster);
        let (shape, about) = match set {
            Ok(set) => (Shape::of(&set), set.description),
            Err(failure) => (Err(failure.message()), String::new()),
        };
        let mut hasher = DefaultHasher::new();
        bytes.hash(&mut hasher);
        Ok(Self {
            name: name.to_owned(),
            id: format!("{:016x}", hasher.finish()),
            shown,
            shape,
            about,
            size,
            place: Place::first(size, good),
        })
    }

    /// Returns what the page shows of it.
    pub(super) fn state(&self) -> Value {
        json!({
            "name": self.name,
            "id": self.id,
            "size": self.size,
            "corner": self.place.corner.to_array(),
            "width": self.place.width,
            "about": self.about,
            "why": self.shape.as_ref().err(),
        })
    }

    /// Returns the name of the file without its ending.
    pub(super) fn stem(&self) -> &str {
        let (stem, _) = self.name.rsplit_once('.').unwrap_or((&self.name, ""));
        if stem.is_empty() { "picture" } else { stem }
    }

    /// Returns whether it shows the picture that another one shows.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.id == other.id
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Returns the shape that is fitted.
    pub(super) fn shape(&self) -> Result<&Shape, Refusal> {
        self.shape.as_ref().map_err(Refusal::wrong)
    }

    /// Moves the picture.
    pub(super) fn put(&mut self, corner: [f64; 2], width: f64) -> Result<(), Refusal> {
        let all = [corner[0], corner[1], width];
        if !all.iter().all(|it| it.is_finite() && it.abs() < 1e9) || width < 1e-9 {
            return Err(Refusal::wrong(
                "a picture has a corner, and a width above 0",
            ));
        }
        self.place = Place {
            corner: corner.into(),
            width,
        };
        Ok(())
    }

    /// Puts the picture where a text has its view.
    pub(super) fn align(&mut self, good: &Good) {
        self.place = Place::first(self.size, Some(good));
    }

    /// Returns the map of the unit square to the picture's rectangle.
    pub(super) fn frame(&self) -> DAffine2 {
        let [across, down] = self.size.map(real);
        let size = DVec2::new(self.place.width, self.place.width * down / across);
        DAffine2::from_mat2_translation(DMat2::from_diagonal(size), self.place.corner)
    }

    /// Returns the shape, in few pixels, and the maps and disks of the system in its coordinates. `None` where the text is
    /// no system of maps that any map may follow, with disks as condensation sets.
    pub(super) fn collage(&self, good: &Good, look: &Look) -> Option<Collage> {
        let shape = Arc::clone(&self.shape.as_ref().ok()?.reduced);
        let candidate = candidate(good, look)?;
        let factor = real(self.size[0]) / self.place.width * shape.1;
        let there = DAffine2::from_scale(DVec2::splat(factor))
            * DAffine2::from_translation(-self.place.corner);
        let candidate = candidate.moved(&there);
        Some(Collage { shape, candidate })
    }

    /// Returns the shape as a PNG: black on nothing.
    pub(super) fn ink(&self) -> Result<Arc<[u8]>, Refusal> {
        let bits = self.shape()?.silhouette.bits();
        let rows = 0..bits.height();
        let pixels = rows.flat_map(|row| (0..bits.width()).map(move |column| (column, row)));
        let ink: Vec<u8> = pixels
            .flat_map(|(column, row)| [0, if bits.get(column, row) { 255 } else { 0 }])
            .collect();
        png(&ink, self.size, png::ColorType::GrayscaleAlpha)
    }
}

impl Shape {
    fn of(set: &PixelSet) -> Result<Self, String> {
        let silhouette = Silhouette::new(set.bits.clone()).map_err(|error| error.to_string())?;
        Ok(Self {
            reduced: Arc::new(silhouette.reduced(MEASURED)),
            silhouette: Arc::new(silhouette),
        })
    }
}

impl Place {
    /// Returns the window of a text where it has the form of the picture. Otherwise, a system has the picture on the unit
    /// square, and a rule on the unit segment.
    fn first([width, height]: [usize; 2], good: Option<&Good>) -> Self {
        let aspect = real(height) / real(width);
        let window = good.and_then(|good| good.document.metadata().view.window);
        if let Some([x, y, wide, high]) = window
            && wide > 0.0
            && (high / wide / aspect - 1.0).abs() < 0.01
        {
            return Self {
                corner: DVec2::new(x, y),
                width: wide,
            };
        }
        let is_system = good.is_some_and(|good| good.kind == Kind::Ifs);
        Self {
            corner: DVec2::new(0.0, if is_system { 0.0 } else { -aspect / 2.0 }),
            width: 1.0,
        }
    }
}

/// A shape, and a system in its coordinates.
#[derive(Clone, Debug)]
pub(super) struct Collage {
    shape: Arc<(Silhouette, f64)>,
    candidate: Candidate,
}

impl Collage {
    /// Returns intersection over union of the shape and its collage, and their distance in pixels of the picture.
    pub(super) fn measured(&self) -> Value {
        let (shape, factor) = &*self.shape;
        let error = self.candidate.collage_error(shape);
        json!({ "iou": error.iou, "distance": error.distance / factor })
    }
}

/// Returns the maps and disks of a system, with the values that are set.
fn candidate(good: &Good, look: &Look) -> Option<Candidate> {
    if good.kind != Kind::Ifs || good.is_in_space {
        return None;
    }
    let is_set = |name: Option<&String>| name.is_some_and(|name| look.set.contains_key(name));
    let settings = good.parameters.iter();
    let settings = settings.filter(|it| is_set(Some(&it.name)) || is_set(it.whole.as_ref()));
    let settings: Vec<_> = settings
        .map(|it| Setting::from((it.name.as_str(), vary::value_of(it, &look.set))))
        .collect();
    let (model, _) = good.document.resolve(&settings).ok()?;
    let Model::Ifs(system) = model else {
        return None;
    };
    let names = Names::of(&good.parameters, &look.set);
    let disks: Option<Vec<Disk>> = match good.document.node().get("condensation") {
        Some(Node {
            value: Content::Sequence(sets),
            ..
        }) => sets.iter().map(|set| disk(set, &names)).collect(),
        Some(_) => None,
        None => Some(Vec::new()),
    };
    let ifs = &system.ifs;
    (!ifs.is_recurrent()).then_some(Candidate {
        maps: ifs.maps().iter().map(|map| map.affine).collect(),
        disks: disks?,
    })
}

/// Returns a condensation set that is a disk.
fn disk(set: &Node, names: &Names) -> Option<Disk> {
    let disk = set.get("disk")?;
    let centre = match disk.get("centre") {
        Some(node) => names.point(node)?.0,
        None => [0.0; 2],
    };
    let (radius, _) = names.value(disk.get("radius")?)?;
    Some(Disk {
        centre: centre.into(),
        radius,
    })
}

/// Returns an error with its causes.
fn chain(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    let all: Vec<_> = causes.map(ToString::to_string).collect();
    all.join(": ")
}

/// Returns the media type of a picture that browsers show.
fn browser_type(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some("image/png"),
        [0xff, 0xd8, ..] => Some("image/jpeg"),
        _ => None,
    }
}

/// Returns pixels of eight bits as a PNG.
fn png(pixels: &[u8], size: [usize; 2], colours: png::ColorType) -> Result<Arc<[u8]>, Refusal> {
    let [width, height] = size.map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(colours);
    encoder.set_compression(png::Compression::Fast);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(pixels)?;
        writer.finish()
    });
    written.map_err(|error| Refusal::wrong(error.to_string()))?;
    Ok(bytes.into())
}
