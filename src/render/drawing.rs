//! Drawings, which any format takes.

use crate::parallel::Team;
use crate::style::{Blend, Colour};

use super::error::RenderError;
use super::options::Labels;
use super::paint::Pen;
use super::surface::Surface;
use super::unit::Unit;

/// Drawing that any format takes.
pub(crate) trait Drawing {
    /// Width and height in pixels.
    fn size(&self) -> [u32; 2];
    /// Colour of the background.
    fn background(&self) -> Option<Colour>;
    /// Pen of most strokes.
    fn pen(&self) -> Pen;
    /// Returns whether all is black because no colour is given.
    fn has_default_ink(&self) -> bool {
        false
    }
    /// Mixing of paths that overlap.
    fn blend(&self) -> Blend {
        Blend::Joined
    }
    /// Draws onto a surface.
    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError>;
}

/// Head of a vector graphic.
#[derive(Clone, Copy)]
pub(super) struct Page<'a> {
    pub(super) size: [u32; 2],
    pub(super) unit: Unit,
    pub(super) background: Option<Colour>,
    /// The pen of most strokes.
    pub(super) pen: Pen,
    pub(super) labels: &'a Labels,
    pub(super) blend: Blend,
    /// Whether black becomes white on dark pages.
    pub(super) has_default_ink: bool,
    /// Whether every colour occurs once, as a layer.
    pub(super) has_layers: bool,
}
