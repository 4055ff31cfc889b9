//! Stamps: small pictures of a form, of which all its instances are copies.
//!
//! A stamp knows the plane that each sample shows, or touches, so that a copy has its depths wherever it lies. Its outline
//! is exact to an eighth of a sample: there are stamps for 4 × 4 positions relative to a sample, and solids are
//! drawn larger by the difference, so that neighbours leave no gap. Of the largest forms, it is exact to a quarter. Where a tile shows more colours than a key has
//! classes, a stamp has inks, to which every copy gives classes of the tile.

mod builder;
#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use crate::geometry::DVec3;
use crate::instancing::Appearance;
use crate::style::Colour;

use super::buffer::{Buffer, CLASS_BITS, LAST_DEPTH, MARGIN, SIDE, STRIDE};
use super::descent::Paint;
use super::forms::Form;
use super::lit::{LEAST, intensity};
use super::roots::Roots;
use super::scene::ClassBy;
use super::solid::{View, whole};
use super::tints::{TABLE, Tints};

use self::builder::Builder;

/// Positions along a side of a sample in which there are stamps.
pub(super) const PHASES: usize = 4;

/// Positions along a side of a sample in which there are stamps that take much memory, or stand for what is in several places.
pub(super) const COARSE_PHASES: usize = 2;

/// Returns the samples by which solids are drawn larger than they are.
fn spread(phases: usize) -> f64 {
    0.5 / phases as f64
}

/// Samples along a side of small stamps, but for the rounding of their sides.
pub(super) const WIDTH: usize = MARGIN;

/// Largest half side of a form that has stamps, in samples, whatever it consists of.
pub(super) const REACH: f64 = WIDTH as f64 / 2.0 - 0.5 - 0.5 / PHASES as f64;

/// Largest slope of a plane by which depths change from copy to copy.
const STEEPEST: f64 = 4.0;

/// Limit of depths of a stamp and of its copies, in steps: their sum is a number of 32 bits.
const FAR: i32 = (1 << 30) - 64;

/// Samples of a piece of a row.
pub(super) const PIECE: usize = 8;

/// The whole tile: left, top, right, bottom.
pub(super) const WHOLE: [usize; 4] = [0, 0, SIDE, SIDE];

/// Piece of a row. Depths are in steps.
#[derive(Clone)]
struct Piece {
    depth: [f32; PIECE],
    /// Change of the depth for a copy that lies a sample farther to the right, and further down.
    slope: [[f32; PIECE]; 2],
    /// Classes, or numbers of inks; all bits are set where nothing is shown.
    class: [u32; PIECE],
}

/// Properties on which the colour of a sample depends, inside the form of a stamp.
#[derive(Clone, Copy, PartialEq)]
struct Ink {
    class: u16,
    appearance: Appearance,
    /// Level of the intensity of light.
    level: u16,
}

impl Ink {
    /// Returns the colour in an instance of a class and an appearance.
    fn colour(&self, roots: &Roots<'_>, (class, outer): (u16, Appearance)) -> Colour {
        let own = match roots.class_by {
            ClassBy::Tint => outer.over(self.appearance).on(roots.inks[0]),
            _ => roots.inks[usize::from(class | self.class) % roots.inks.len()],
        };
        match roots.lit {
            Some(_) => own.dimmed(intensity(self.level, LEAST)),
            None => own,
        }
    }
}

/// Stamps of a form, which are drawn when they are needed; `None` where they would have too many inks.
pub(super) struct Stamps {
    /// Positions along a side of a sample.
    phases: usize,
    /// Whether they are worth finding the part of the tile where they are seen.
    pub(super) are_large: bool,
    drawn: Box<[OnceLock<Option<Stamp>>]>,
}

impl Stamps {
    /// Creates stamps for so many positions along a side of a sample.
    pub(super) fn new(phases: usize, are_large: bool) -> Self {
        let drawn = (0..phases * phases).map(|_| OnceLock::new());
        Self {
            phases,
            are_large,
            drawn: drawn.collect(),
        }
    }
}

/// Picture of a form in a position relative to a sample.
pub(super) struct Stamp {
    /// The rows one after the other, each of as many pieces.
    pieces: Vec<Piece>,
    columns: usize,
    /// The first sample, counted from the one in which the middle of the form lies.
    corner: [isize; 2],
    /// The samples that show something: left, top, right, bottom.
    extent: [usize; 4],
    /// Inks, if colours are found tile by tile.
    inks: Vec<Ink>,
    /// Number of solids.
    pub(super) elements: u64,
    /// Number of steps of its deepest element.
    pub(super) deepest: u32,
}

/// A copy, in the units of pieces.
struct Copy {
    /// Depth of what has the depth 0, and its fraction.
    base: i32,
    fraction: f32,
    shift: [f32; 2],
    class: u32,
}

impl Copy {
    /// Returns the key of a sample of a piece, without its class.
    #[inline(always)]
    fn key(&self, piece: &Piece, x: usize) -> u32 {
        let change = piece.slope[0][x] * self.shift[0] + piece.slope[1][x] * self.shift[1];
        let depth = whole(f64::from(piece.depth[x] + change + self.fraction)).cast_signed();
        depth
            .wrapping_add(self.base)
            .clamp(0, LAST_DEPTH)
            .cast_unsigned()
            << CLASS_BITS
    }
}

/// Instance of a form that has stamps.
pub(super) struct Placed<'a> {
    pub(super) form: &'a Form,
    /// Number of the form.
    pub(super) number: usize,
    /// Middle of the box around it.
    pub(super) at: DVec3,
    pub(super) paint: Paint,
    /// Part of the tile on which it may be seen.
    pub(super) seen: [usize; 4],
}

impl Stamp {
    /// Draws an instance; returns its stamp, if it has one.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_precision_loss,
        reason = "the numbers are small"
    )]
    pub(super) fn draw<'a>(
        roots: &Roots<'a>,
        view: &View<'_>,
        (buffer, tints): (&mut Buffer, &mut Tints),
        placed: &Placed<'a>,
    ) -> Option<&'a Self> {
        let &Placed {
            form, at, paint, ..
        } = placed;
        let stamps = form.stamps.as_ref()?;
        let count = stamps.phases;
        let phases = count as f64;
        let fine = [at.x - view.corner[0], at.y - view.corner[1]].map(|at| at * phases);
        let near = fine.map(f64::round);
        let [x, y] = near.map(|at| at as isize);
        let phase = [x, y].map(|at| at.rem_euclid(count as isize) as usize);
        let own = phase[1] * count + phase[0];
        let draw = || Builder::build(roots, view, form, (phase, count));
        let stamp = stamps.drawn[own].get_or_init(draw);
        let stamp = stamp.as_ref()?;
        let depth = view.depths.exact(at.z + form.half.z);
        let base = depth.floor();
        let far = f64::from(FAR);
        let copy = Copy {
            base: (base - bias(roots, view, count)).clamp(-far, far) as i32,
            fraction: (depth - base) as f32,
            shift: [0, 1].map(|axis| ((fine[axis] - near[axis]) / phases) as f32),
            class: u32::from(paint.class) << roots.lit.and_then(|lit| lit.bits()).unwrap_or(0),
        };
        let corner = [x, y].map(|at| at.div_euclid(count as isize));
        let corner = [corner[0] + stamp.corner[0], corner[1] + stamp.corner[1]];
        let Some(part) = stamp.part(corner, placed.seen) else {
            return Some(stamp);
        };
        let is_seen = if stamp.inks.is_empty() {
            let keys = &mut buffer.with_margin()[part.start..];
            blit(keys, stamp, &part, &copy)
        } else {
            let outer = tints.appearance(paint.appearance);
            let name = (
                placed.number * PHASES * PHASES + own,
                paint.class,
                outer.bits(),
            );
            let colours = { stamp.inks.iter() }.map(|ink| ink.colour(roots, (paint.class, outer)));
            let classes = tints.table(name, buffer, colours);
            let keys = &mut buffer.with_margin()[part.start..];
            blit_with_inks(keys, stamp, &part, &copy, classes)
        };
        if is_seen {
            buffer.refresh(part.refreshed);
        }
        Some(stamp)
    }

    /// Returns the part of a copy within an area of the tile, if there is one. `corner` is the place of its first sample.
    #[expect(
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        reason = "the numbers are small"
    )]
    fn part(&self, [x, y]: [isize; 2], seen: [usize; 4]) -> Option<Part> {
        let piece = PIECE as isize;
        let [left, top, right, bottom] = self.extent.map(|at| at as isize);
        let seen = seen.map(|at| at as isize);
        let area = [
            seen[0].max(x + left),
            seen[1].max(y + top),
            seen[2].min(x + right),
            seen[3].min(y + bottom),
        ];
        if area[0] >= area[2] || area[1] >= area[3] {
            return None;
        }
        // Pieces may reach into the margin.
        let columns = [(area[0] - x) / piece, (area[2] - x + piece - 1) / piece];
        let margin = MARGIN as isize;
        let start = (area[1] + margin) * STRIDE as isize + x + columns[0] * piece + margin;
        Some(Part {
            rows: [area[1] - y, area[3] - y].map(|at| at as usize),
            columns: columns.map(|at| at as usize),
            start: start as usize,
            refreshed: area.map(|at| at as usize),
        })
    }
}

/// Part of a copy.
struct Part {
    rows: [usize; 2],
    /// First piece of the rows, and the one behind the last.
    columns: [usize; 2],
    /// Place of its first sample in the buffer with its margin.
    start: usize,
    /// The samples of the tile, but for those of pieces beside the area.
    refreshed: [usize; 4],
}

impl Part {
    /// Iterates over the rows of pieces.
    #[inline(always)]
    fn rows<'s>(&self, stamp: &'s Stamp) -> impl Iterator<Item = &'s [Piece]> {
        let [[top, bottom], [left, right]] = [self.rows, self.columns];
        let rows =
            stamp.pieces[top * stamp.columns..bottom * stamp.columns].chunks_exact(stamp.columns);
        rows.map(move |row| &row[left..right])
    }
}

/// Returns the steps by which the depths of rows are larger than they are, so that none is negative.
fn bias(roots: &Roots<'_>, view: &View<'_>, phases: usize) -> f64 {
    let change = 2.0 * STEEPEST * spread(phases);
    (view.depths.steps() * (change + roots.pad)).ceil()
}

/// Draws a part of a copy, whose corner is that of `keys`; returns whether it is seen.
#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
fn blit(keys: &mut [u32], stamp: &Stamp, part: &Part, copy: &Copy) -> bool {
    let mut seen = 0;
    for (row, pieces) in keys.chunks_mut(STRIDE).zip(part.rows(stamp)) {
        for (keys, piece) in row.chunks_exact_mut(PIECE).zip(pieces) {
            for (x, key) in keys.iter_mut().enumerate() {
                let new = copy.key(piece, x) | copy.class | piece.class[x];
                seen |= u32::from(new < *key);
                *key = (*key).min(new);
            }
        }
    }
    seen > 0
}

/// Draws a part of a copy as [`blit`] does, with the class of each ink.
#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
fn blit_with_inks(
    keys: &mut [u32],
    stamp: &Stamp,
    part: &Part,
    copy: &Copy,
    classes: &[u32; TABLE],
) -> bool {
    let mut seen = 0;
    for (row, pieces) in keys.chunks_mut(STRIDE).zip(part.rows(stamp)) {
        for (keys, piece) in row.chunks_exact_mut(PIECE).zip(pieces) {
            for (x, key) in keys.iter_mut().enumerate() {
                let new = copy.key(piece, x) | classes[piece.class[x] as usize % TABLE];
                seen |= u32::from(new < *key);
                *key = (*key).min(new);
            }
        }
    }
    seen > 0
}
