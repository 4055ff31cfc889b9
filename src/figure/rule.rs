//! Production rules as figures, in the manner of Kaandorp 1987 (figures 1 to 13): initiator,
//! generators and base element side by side.
//!
//! Fertile sides are marked with asterisks, directions by their numbers. A generator stands over
//! the side that it replaces; its name and the selection are on its left or above, its random
//! function in words on its right.

mod block;
mod components;
mod ink;
mod key;
mod lines;
mod marks;
mod page;
mod panel;
mod structure;
mod system;
mod words;

use std::io::Write;
use std::num::NonZero;

use crate::catalogue::Shelf;
use crate::document::RuleDocument;
use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::parallel::Team;
use crate::render::{
    self, Drawing, Format, Labels, Pen, RenderError, Size, Surface, write_drawing,
};
use crate::rule::Rule;
use crate::style::Colour;

use super::LABEL;
use super::text::Font;
use block::Block;

pub use structure::write_structure;
pub use system::write_system;

/// How the figure is made.
#[derive(Clone, Debug)]
pub struct Options {
    /// The format; SVG unless said otherwise.
    pub format: Format,
    /// The size; such that labels are of 13 pixels unless said otherwise.
    pub size: Option<Size>,
    /// The colour behind it; none unless said otherwise.
    pub background: Option<Colour>,
    /// What the file says of itself. The title stands above the figure.
    pub labels: Labels,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            format: Format::Svg,
            size: None,
            background: None,
            labels: Labels::default(),
        }
    }
}

/// Draws a rule and writes the figure; tells its width and height in pixels.
///
/// `document` is what `rule` was resolved from: expressions are shown as they are written. All of the rule
/// is shown, or the components of one shelf alone.
///
/// # Errors
///
/// If the picture is too large, or if `out` fails.
pub fn write(
    rule: &Rule,
    document: &RuleDocument,
    alone: Option<Shelf>,
    options: &Options,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let page = page::page(rule, document, alone, &options.labels.title);
    Figure::write(page, options, out)
}

/// The map from what lies in a box to a panel of this scale, and the panel's size.
fn onto_panel(bounds: &Bounds, scale: f64) -> (DAffine2, DVec2) {
    /// What lies around it.
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
    /// Writes a page as a figure; tells its width and height in pixels.
    fn write(
        page: Block,
        options: &Options,
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

    /// How much larger the page becomes, and where its corner lies.
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
