//! Blending: each subpath of a drawing is a path by itself, so that overlapping ones are mixed.

use std::io;

use crate::parallel::Team;
use crate::style::Blend;

use super::drawing::Drawing;
use super::error::RenderError;
use super::paint::{Paint, Position};
use super::surface::Surface;

/// Draws onto a surface, with a path for each subpath if the drawing blends.
pub(super) fn draw<'w>(
    drawing: &'w impl Drawing,
    surface: &mut impl Surface,
    team: &Team<'w>,
) -> Result<(), RenderError> {
    if drawing.blend() == Blend::Joined {
        return drawing.draw(surface, team);
    }
    let mut separator = Separator {
        surface,
        paint: Paint::default(),
        is_open: false,
        failed: Ok(()),
    };
    drawing.draw(&mut separator, team)
}

/// Surface that passes subpaths on as paths.
struct Separator<'s, S> {
    surface: &'s mut S,
    /// Paint of the current path.
    paint: Paint,
    /// Whether the surface has an open path.
    is_open: bool,
    /// Error between two subpaths, which is returned at the next opportunity.
    failed: io::Result<()>,
}

impl<S: Surface> Separator<'_, S> {
    /// Begins a path with the paint of the current one.
    fn next_path(&mut self) -> io::Result<()> {
        self.close_path()?;
        self.is_open = true;
        self.surface.begin(&self.paint)
    }

    fn close_path(&mut self) -> io::Result<()> {
        std::mem::replace(&mut self.failed, Ok(()))?;
        match std::mem::take(&mut self.is_open) {
            true => self.surface.end(),
            false => Ok(()),
        }
    }
}

impl<S: Surface> Surface for Separator<'_, S> {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        self.paint = *paint;
        if paint.has_holes {
            self.is_open = true;
            self.surface.begin(paint)?;
        }
        Ok(())
    }

    fn move_to(&mut self, to: Position) {
        if !self.paint.has_holes {
            self.failed = self.next_path();
        }
        self.surface.move_to(to);
    }

    fn line_to(&mut self, to: Position) {
        self.surface.line_to(to);
    }

    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.surface.curve_to(a, b, to);
    }

    fn close(&mut self) {
        self.surface.close();
    }

    fn hand_on(&mut self) -> io::Result<()> {
        match self.is_open {
            true => self.surface.hand_on(),
            false => Ok(()),
        }
    }

    fn end(&mut self) -> io::Result<()> {
        self.close_path()
    }

    fn broadens(&self, paint: &Paint) -> bool {
        self.surface.broadens(paint)
    }

    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool> {
        self.surface.enter(corner, size)
    }

    fn leave(&mut self) -> io::Result<()> {
        self.surface.leave()
    }

    fn label(&mut self, text: &str) {
        self.surface.label(text);
    }
}
