//! Rules, systems, structures and L-systems as figures; production rules in the manner of Kaandorp 1987 (figures 1 to 13): initiator,
//! generators and base element side by side.
//!
//! Fertile sides are marked with asterisks, directions by their numbers. A generator is drawn over the side
//! that it replaces, with its name above, the selection on its left and its random function in words on its
//! right.

mod block;
mod components;
mod graph;
mod ink;
mod key;
mod lines;
mod lsystem;
mod marks;
mod page;
mod panel;
mod shown;
mod space;
mod structure;
mod system;
mod words;

use std::io::Write;
use std::num::NonZero;

use crate::catalogue::Shelf;
use crate::document::Document;
use crate::geometry::{Bounds, DAffine2, DVec2, Frame2, Frame3};
use crate::graph::Graph;
use crate::model::Model;
use crate::parallel::Team;
use crate::render::space::{Camera, SpaceError};
use crate::render::{
    self, Drawing, Format, Labels, Pen, RenderError, Size, Surface, write_drawing,
};
use crate::style::Colour;

use super::LABEL;
use super::text::Font;
use block::Block;
pub use graph::Topology;

/// Options of a figure.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RuleFigureOptions {
    /// Format of the file; SVG by default.
    pub format: Format,
    /// Size of the figure; by default, text has a font size of 13 pixels.
    pub size: Option<Size>,
    /// Background colour; none by default.
    pub background: Option<Colour>,
    /// Direction from which a system in space is seen; figures are parallel projections.
    pub camera: Camera,
    /// Metadata of the file. The title stands above the figure.
    pub labels: Labels,
}

setters!(RuleFigureOptions {
    format: Format,
    size: Option<Size>,
    background: Option<Colour>,
    camera: Camera,
    labels: Labels,
});

impl Default for RuleFigureOptions {
    fn default() -> Self {
        Self {
            format: Format::Svg,
            size: None,
            background: None,
            camera: Camera::default(),
            labels: Labels::default(),
        }
    }
}

/// Draws the figure of a rule, a system, a structure or an L-system and writes it; returns width and height in pixels.
///
/// `document` is the document that `model` was resolved from: expressions of rules and productions are shown as written in
/// it. With `alone`, only the components of that shelf are shown.
///
/// # Errors
///
/// Returns an error if the document is of another kind than the model, if the camera is not valid, if the picture is too large, or if
/// `out` fails.
pub fn write(
    model: &Model,
    document: &Document,
    alone: Option<Shelf>,
    options: &RuleFigureOptions,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let title = &options.labels.title;
    let view = || options.camera.rotation().map_err(SpaceError::from);
    let page = match (model, document.rule(), document.lsystem()) {
        (Model::Rule(rule), Some(document), _) => page::page(rule, document, alone, (), title),
        (Model::RuleInSpace(rule), Some(document), _) => {
            page::page(rule, document, alone, view()?, title)
        }
        (Model::Ifs(system), ..) => system::page(system, title),
        (Model::IfsInSpace(system), ..) => space::page(system, view()?, title),
        (Model::Instancing(structure), ..) => structure::page(structure, (), title),
        (Model::InstancingInSpace(structure), ..) => structure::page(structure, view()?, title),
        (Model::LSystem(system), _, Some(document)) => {
            lsystem::page::<Frame2>(system, document, (), title)
        }
        (Model::LSystemInSpace(system), _, Some(document)) => {
            lsystem::page::<Frame3>(system, document, view()?, title)
        }
        _ => return Err(RenderError::NoFigure(model.kind())),
    };
    Figure::write(page, options, out)
}

/// Draws the instancing graph of a model of the plane and writes it; returns width and height in pixels. The levels and the tree are
/// those of approximant `steps`.
///
/// # Errors
///
/// Returns an error if the picture is too large, or if `out` fails.
pub fn write_graph(
    graph: &Graph,
    topology: Topology,
    steps: u32,
    options: &RuleFigureOptions,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let page = graph::page(graph, topology, steps, (), &options.labels.title);
    Figure::write(page, options, out)
}

/// Draws the instancing graph of a model in space as [`write_graph`] does.
///
/// # Errors
///
/// As for [`write_graph`], and if the camera is not valid.
pub fn write_graph_in_space(
    graph: &Graph<Frame3>,
    topology: Topology,
    steps: u32,
    options: &RuleFigureOptions,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let view = options.camera.rotation().map_err(SpaceError::from)?;
    let page = graph::page(graph, topology, steps, view, &options.labels.title);
    Figure::write(page, options, out)
}

/// Returns the map of a box onto a panel of the given scale, and the panel's size.
fn onto_panel(bounds: &Bounds, scale: f64) -> (DAffine2, DVec2) {
    /// Margin around the box, in pixels.
    const PAD: DVec2 = DVec2::splat(8.0);
    let map = DAffine2::from_translation(PAD)
        * DAffine2::from_scale(DVec2::new(scale, -scale))
        * DAffine2::from_translation(-DVec2::new(bounds.min().x, bounds.max().y));
    (map, bounds.size() * scale + 2.0 * PAD)
}

struct Figure {
    page: Block,
    size: Option<Size>,
    background: Option<Colour>,
}

impl Figure {
    /// Writes a page as a figure; returns width and height in pixels.
    fn write(
        page: Block,
        options: &RuleFigureOptions,
        out: &mut impl Write,
    ) -> Result<[u32; 2], RenderError> {
        let figure = Self {
            page,
            size: options.size,
            background: options.background,
        };
        let options = render::Options {
            format: options.format,
            labels: options.labels.clone(),
            // A figure is small.
            threads: NonZero::<usize>::MIN,
            ..render::Options::default()
        };
        write_drawing(&figure, &options, out)?;
        Ok(figure.size())
    }

    /// Returns the factor that scales the page, and the position of its corner.
    fn fit(&self) -> (f64, DVec2) {
        let own = self.page.size;
        match self.size {
            None => (1.0, DVec2::ZERO),
            Some(Size::Long(side)) => (f64::from(side) / own.max_element(), DVec2::ZERO),
            Some(Size::Exactly(width, height)) => {
                let size = DVec2::new(width.into(), height.into());
                let scale = (size / own).min_element();
                (scale, (size - own * scale) / 2.0)
            }
        }
    }
}

impl Drawing for Figure {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate"
    )]
    fn size(&self) -> [u32; 2] {
        if let Some(Size::Exactly(width, height)) = self.size {
            return [width, height];
        }
        let size = self.page.size * self.fit().0;
        [size.x, size.y].map(|side| side.round().max(1.0) as u32)
    }

    fn background(&self) -> Option<Colour> {
        self.background
    }

    fn pen(&self) -> Pen {
        ink::PEN
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let (scale, corner) = self.fit();
        self.page.draw(surface, &Font::new(), scale, corner)
    }
}
