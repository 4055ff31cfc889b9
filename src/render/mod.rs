//! Pictures of approximants.
//!
//! A picture begins with a prepass over the elements to draw, their number and their box, from the graph where it
//! determines them and by a walk elsewhere. One walk for every class of colour follows, or one for all where
//! classes do not interleave, so that no element is held in memory. Any thread sketches spans of it; a painter
//! joins the sketches, in order, to paths in whole hundredths of a pixel, equal for every format.
//!
//! A plot takes the paths as strokes, and draws them in another order; large PNGs are drawn in bands. An SVG
//! of nested instances is made from the graph, without a walk.
//!
//! Limit sets are drawn without a walk, by `cells`, where a detail takes more elements than there are pixels, or
//! elements have no area.
//!
//! Walks leave out subtrees that cannot be seen, outside a window or below a detail; and where colours distinguish
//! steps, maps or generators, subtrees without elements of the class that is painted. None of this changes a
//! pixel, and neither threads nor timing show in any byte. A window is the crop of the whole picture of the same scale
//! and number of steps but for rounding: places are in hundredths of a pixel, and edges are cut at the border. Where a
//! detail decides the number of steps, it is that of the whole, and so are colours by step and age, but for random elements and
//! seeds placed as the initiator. In PNGs, small runs of elements in equal positions may be drawn as sprites, with small
//! differences: see `png::sprites`. Code for pixels alone lies in `png`, behind one method of surfaces.

mod bands;
mod blended;
mod canvas;
mod cells;
mod census;
mod classes;
mod colours;
mod contribution;
mod culling;
mod density;
mod display;
mod drawing;
mod dxf;
mod error;
mod frame_colours;
mod gcode;
mod hits;
mod hpgl;
mod instanced;
mod known;
mod layout;
mod levels;
mod mesh;
mod options;
mod paint;
mod paint_key;
mod painter;
mod passes;
mod pdf;
mod pen_way;
mod picture;
mod pixels;
mod plot;
mod png;
mod prepass;
mod scene;
mod short_cuts;
mod sketch;
pub mod space;
mod surface;
mod svg;
mod tracer;
mod unit;
mod write;
mod zoomed;

pub use canvas::{Canvas, NoRoom, Size};
pub use density::{Density, Shades, density_canvas, write_density};
#[cfg(feature = "cli")]
pub(crate) use density::{density_pixels, write_density_with};
pub(crate) use drawing::Drawing;
pub use error::{NoDetail, NoZoom, Remedy, RenderError};
pub use gcode::Machine;
pub(crate) use instanced::length as instanced_length;
pub use instanced::{NotInstanced, SceneFormat, write_scene};
pub(crate) use layout::Layout;
pub use levels::Levels;
pub use mesh::{MeshFormat, MeshOptions, Meshed, write_mesh};
pub use options::{Detail, Format, Labels, Options, PngEncoding};
pub(crate) use paint::{FINE, Paint, Pen, Position, Stroke, pen, position};
pub use picture::{Empty, Instanced, NearestPoint, Picture};
pub(crate) use pixels::draw_paths;
pub(crate) use pixels::survey;
pub use pixels::{Pixels, pixels};
pub use plot::{Hatch, HatchPattern, Pens, Plotted, PlottedPen};
#[cfg(feature = "cli")]
pub(crate) use png::Spares;
pub use png::TooManyPixels;
pub(crate) use prepass::Prepass;
pub(crate) use scene::Scene;
pub use short_cuts::{ShortCut, ShortCuts};
pub(crate) use surface::Surface;
#[cfg(feature = "cli")]
pub(crate) use svg::escaped;
pub(crate) use tracer::Tracer;
pub use unit::Unit;
pub use write::write;
pub(crate) use write::write_drawing;
pub use zoomed::{ZoomTarget, pixels_zoomed, write_zoomed};
