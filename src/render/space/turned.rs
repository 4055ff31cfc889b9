//! Stamps of turned instances: small pictures of an object in one of many orientations.
//!
//! Where maps turn, hardly two instances differ by a translation only, and there are no exact
//! [stamps](super::stamp). Instances of at most three pixels are then copies of the picture in an orientation and
//! of a size near to theirs: of all their points, none is drawn more than a pixel from its place, and most within a
//! quarter of a pixel. Elements that are replaced because they are larger than the detail are never drawn so.

#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use crate::geometry::{DAffine3, DMat3, DQuat, DVec3};

use super::buffer::{
    Buffer, CLASS_BITS, EMPTY, LAST_DEPTH, MARGIN, MAX_CLASS, SAMPLES, STEPS, STRIDE,
};
use super::camera::{Placement, Projection};
use super::forms::{Form, Forms, MAX_FORMS};
use super::lit::Classes;
use super::planes::{Planes, draw_row};
use super::roots::Roots;
use super::scene::{Child, ClassBy, End, Part, ends};
use super::solid::{Body, Depths, View};
use super::stamp::{PIECE, WIDTH};

/// Longest side of the box of an instance that is a copy, in samples.
#[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
const SIDE: f64 = 3.0 * SAMPLES as f64;

/// Number of sizes between that of an element and that of the largest copy.
const SIZES: usize = 8;

/// Logarithm of the ratio of sizes.
const RATIO: f64 = 0.15;

/// Number of steps of each of the three coordinates of an orientation.
const TURNS: usize = 10;

/// Number of orientations: in each of four charts one component of the quaternion is the largest.
const ORIENTATIONS: usize = 4 * TURNS * TURNS * TURNS;

/// Number of stamps of an object, or of its mirror image: orientations and sizes.
const CELLS: usize = ORIENTATIONS * SIZES;

/// Limit of the number of objects that have stamps.
const MAX_OBJECTS: usize = 16;

/// Samples by which solids are drawn larger than they are, so that neighbours leave no gap.
const SPREAD: f64 = 0.35;

/// Curvature of the scale of coordinates of orientations, by which steps are turns of similar angles.
const BEND: f64 = 0.27;

/// Half of the range of depths of a stamp, in samples.
#[expect(clippy::cast_precision_loss, reason = "stamps are small")]
const REACH: f64 = WIDTH as f64 / 2.0;

/// Depth of samples of a stamp that show nothing.
const NOTHING: u16 = u16::MAX;

/// Number of steps of depth of a stamp between its near and its far end.
const FINE: u16 = NOTHING - 1;

/// Stamps in all orientations and sizes.
type Stamps = Box<[OnceLock<Box<TurnedStamp>>]>;

/// The stamps of all objects, which are drawn when they are needed.
pub(super) struct Turned {
    /// Number of the stamps of each object.
    sets: Vec<usize>,
    least_sizes: [f64; SIZES],
    /// Stamps of objects and of their mirror images.
    stamps: Vec<[OnceLock<Stamps>; 2]>,
}

/// Picture of an object in an orientation. There may be many thousands of them: numbers take little room.
pub(super) struct TurnedStamp {
    /// The pieces of every row from the first to the last that show something; then the depths of their samples, in steps of
    /// its own range, [`NOTHING`] where nothing is shown; then the classes of these samples, unless all are 0.
    content: Box<[u16]>,
    /// The least depth.
    nearest: u16,
    has_classes: bool,
    /// Corner of the first row, and the end of what shows something, in samples.
    corner: [u8; 2],
    end: [u8; 2],
    /// Number of solids.
    pub(super) elements: u32,
    /// Number of steps of its deepest element.
    pub(super) deepest: u32,
}

const _: () = assert!(WIDTH <= u8::MAX as usize, "a side is a small number");

/// Returns the sides above which sizes are those of cells, from the largest cell on.
#[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
fn least_sizes() -> [f64; SIZES] {
    std::array::from_fn(|size| SIDE * libm::exp(-RATIO * (size as f64 + 1.0)))
}

/// Orientation and size of an instance, rounded.
struct Cell {
    is_mirrored: bool,
    /// The component of the quaternion that is largest.
    chart: usize,
    turn: [usize; 3],
    size: usize,
}

impl Turned {
    /// Creates stamps for systems of similarities in parallel pictures, if they have so many forms that they are not
    /// known before the descent.
    pub(super) fn of(
        parts: &[Part],
        start: &[Child],
        forms: &Forms,
        end: &End,
        class_by: ClassBy,
        placement: &Placement,
    ) -> Option<Self> {
        #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
        let pixel = SAMPLES as f64;
        let is_apt = forms.known.len() >= MAX_FORMS
            && matches!(placement.projection, Projection::Parallel)
            && class_by != ClassBy::Tint
            && (pixel..SIDE / 2.0).contains(&end.detail)
            // Stamps consist of planes.
            && parts.iter().all(|part| part.solid.as_ref().is_none_or(|it| it.primitive().is_none()));
        if !is_apt || start.is_empty() {
            return None;
        }
        let name = |part: &Part, number| match class_by {
            ClassBy::FirstMap => number,
            _ => part.kind,
        };
        let mut names = Vec::new();
        let sets = parts.iter().enumerate().map(|(number, part)| {
            let name = name(part, number);
            { names.iter() }
                .position(|known| *known == name)
                .unwrap_or_else(|| {
                    names.push(name);
                    names.len() - 1
                })
        });
        let sets: Vec<usize> = sets.collect();
        (names.len() <= MAX_OBJECTS).then(|| Self {
            sets,
            least_sizes: least_sizes(),
            stamps: names.iter().map(|_| Default::default()).collect(),
        })
    }

    /// Draws a small instance whose middle is at a point; `None` if it is too large, or replaced to the last step.
    #[expect(clippy::cast_possible_truncation, reason = "the numbers are small")]
    pub(super) fn draw(
        &self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        (form, at, class): (&Form, DVec3, u16),
    ) -> Option<&TurnedStamp> {
        let size = form.length * roots.end.unit;
        if size > SIDE || size <= roots.end.detail {
            return None;
        }
        let cell = Cell::of(&form.linear, form.length, size, &self.least_sizes)?;
        let stamps = &self.stamps[self.sets[form.object]][usize::from(cell.is_mirrored)];
        let stamps = stamps.get_or_init(|| (0..CELLS).map(|_| OnceLock::new()).collect());
        // Stamps have the hull in their middle.
        let at = at - form.middle + form.centre;
        let stamp = stamps[cell.number()].get_or_init(|| {
            let length = cell.size() / roots.end.unit;
            let form = Form::new(roots.parts, (form.object, 0), cell.turn() * length, length);
            Box::new(Builder::build(roots, &form))
        });
        let class = match roots.class_by {
            ClassBy::Step => form.level,
            _ => u32::from(class),
        };
        if form.level + stamp.deepest >= roots.end.steps
            || class + stamp.deepest > u32::from(MAX_CLASS)
        {
            return None;
        }
        let corner = [0, 1].map(|axis| {
            let at = (at[axis] - view.corner[axis] - REACH).round() as isize;
            let at = at + MARGIN.cast_signed();
            let at = at.clamp(0, (STRIDE - WIDTH).cast_signed());
            at.cast_unsigned() + usize::from(stamp.corner[axis])
        });
        let end =
            [0, 1].map(|axis| corner[axis] + usize::from(stamp.end[axis] - stamp.corner[axis]));
        let base = view.depths.exact(at.z + REACH).floor() as i32;
        let scale = 2.0 * REACH * view.depths.steps() / f64::from(FINE);
        let copy = Copy::new(base, scale, class);
        let area = [corner[0], corner[1], end[0], end[1]];
        if !stamp.content.is_empty() && buffer.shows_with_margin(area, copy.depth(stamp.nearest)) {
            let keys = &mut buffer.with_margin()[corner[1] * STRIDE + corner[0]..];
            let is_seen = match stamp.has_classes {
                false => blit::<false>(keys, stamp, &copy),
                true => blit::<true>(keys, stamp, &copy),
            };
            if is_seen {
                buffer.refresh_with_margin(area);
            }
        }
        Some(stamp)
    }
}

impl Cell {
    /// Returns the cell of a similarity, whose stretch is given, and of the longest side of its box, by the
    /// [least sides](least_sizes) of cells.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the numbers are small"
    )]
    fn of(linear: &DMat3, length: f64, size: f64, least_sizes: &[f64; SIZES]) -> Option<Self> {
        let is_mirrored = linear.determinant() < 0.0;
        let scale = if is_mirrored { -1.0 } else { 1.0 } / length;
        let parts = DQuat::from_mat3(&(*linear * scale)).to_array();
        let chart = (0..4).fold(0, |chart, part| {
            if parts[part].abs() > parts[chart].abs() {
                part
            } else {
                chart
            }
        });
        let others = [1, 2, 3].map(|step| parts[(chart + step) % 4] / parts[chart]);
        let turn = others.map(|part| {
            let bent = part * (1.0 + BEND - BEND * part.abs());
            let step = (bent + 1.0) / 2.0 * TURNS as f64;
            (step as usize).min(TURNS - 1)
        });
        let size = least_sizes.iter().filter(|least| size <= **least).count();
        (size < SIZES).then_some(Self {
            is_mirrored,
            chart,
            turn,
            size,
        })
    }

    /// Returns the number of the stamp among those of an object, or of its mirror image.
    fn number(&self) -> usize {
        let [a, b, c] = self.turn;
        let turn = ((self.chart * TURNS + a) * TURNS + b) * TURNS + c;
        turn * SIZES + self.size
    }

    /// Returns the orientation in the middle of the cell.
    #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
    fn turn(&self) -> DMat3 {
        let mut parts = [1.0; 4];
        for (step, turn) in self.turn.iter().enumerate() {
            let bent = (*turn as f64 + 0.5) / TURNS as f64 * 2.0 - 1.0;
            let slope = 1.0 + BEND;
            let part = (slope - (slope * slope - 4.0 * BEND * bent.abs()).sqrt()) / (2.0 * BEND);
            parts[(self.chart + step + 1) % 4] = part.copysign(bent);
        }
        let turn = DMat3::from_quat(DQuat::from_array(parts).normalize());
        if self.is_mirrored { -turn } else { turn }
    }

    /// Returns the longest side of the box in the middle of the cell, in samples.
    #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
    fn size(&self) -> f64 {
        SIDE * libm::exp(-RATIO * (self.size as f64 + 0.5))
    }
}

/// A copy, in the depths of the picture.
struct Copy {
    /// Depth of what has the depth 0.
    base: i32,
    /// Depths of the picture in one of the stamp, as a multiple of a power of 2: whole numbers are multiplied at once.
    scale: u32,
    shift: u32,
    class: u32,
}

impl Copy {
    /// Creates a copy; `scale` is the number of depths of the picture in one of the stamp.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate"
    )]
    fn new(base: i32, scale: f64, class: u32) -> Self {
        /// Bits of the factor, which leave room in 32 bits for depths of 16 bits and the base.
        const BITS: u32 = 14;
        const FAR: i32 = 1 << 30;
        let largest = f64::from((1 << BITS) - 1);
        let mut shifts = (0..=BITS).rev();
        let shift = shifts.find(|shift| scale * f64::from(1 << shift) <= largest);
        let shift = shift.unwrap_or(0);
        Self {
            base: base.clamp(-FAR, FAR),
            scale: (scale * f64::from(1 << shift)).min(largest) as u32,
            shift,
            class,
        }
    }

    /// Returns the depth in the picture of a depth of the stamp.
    #[inline(always)]
    fn depth(&self, own: u16) -> u32 {
        let depth = ((u32::from(own) * self.scale) >> self.shift).cast_signed();
        (depth + self.base).clamp(0, LAST_DEPTH).cast_unsigned()
    }
}

/// Draws a copy of a stamp, which has classes if it is `CLASSED`; its corner is that of `keys`. Returns whether it is seen.
#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
fn blit<const CLASSED: bool>(keys: &mut [u32], stamp: &TurnedStamp, copy: &Copy) -> bool {
    let mut seen = 0;
    let count = usize::from(stamp.end[1] - stamp.corner[1]);
    let (ranges, samples) = stamp.content.split_at(count);
    let size = samples.len() / if CLASSED { 2 } else { 1 };
    let (depths, classes) = samples.split_at(size);
    let mut start = 0;
    for (row, range) in keys.chunks_mut(STRIDE).zip(ranges) {
        let [first, last] = range.to_le_bytes().map(|piece| usize::from(piece) * PIECE);
        let own = start..start + (last - first);
        start = own.end;
        let depths = &depths[own.clone()];
        let classes = if CLASSED { &classes[own] } else { depths };
        let own = depths.chunks_exact(PIECE).zip(classes.chunks_exact(PIECE));
        let row = &mut row[first..last];
        for (keys, (depths, classes)) in row.chunks_exact_mut(PIECE).zip(own) {
            for (key, (own, class)) in keys.iter_mut().zip(depths.iter().zip(classes)) {
                let class = if CLASSED { u32::from(*class) } else { 0 };
                let key_of_own = copy.depth(*own) << CLASS_BITS | (class + copy.class);
                let new = if *own == NOTHING { EMPTY } else { key_of_own };
                seen |= u32::from(new < *key);
                *key = (*key).min(new);
            }
        }
    }
    seen > 0
}

/// Draws the elements of a form.
struct Builder<'a> {
    roots: &'a Roots<'a>,
    end: End,
    view: View<'a>,
    planes: Planes,
    keys: Vec<u32>,
    elements: u64,
    deepest: u32,
}

impl<'a> Builder<'a> {
    fn build(roots: &'a Roots<'a>, form: &Form) -> TurnedStamp {
        let mut builder = Self {
            roots,
            end: End {
                steps: u32::MAX,
                ..roots.end
            },
            view: View {
                projection: Projection::Parallel,
                depths: Depths::new([-REACH, REACH]),
                cuts: &[],
                corner: [0.0; 2],
            },
            planes: Planes::default(),
            keys: vec![EMPTY; WIDTH * WIDTH],
            elements: 0,
            deepest: 0,
        };
        builder.add(form, DVec3::new(REACH, REACH, 0.0));
        builder.stamp()
    }

    /// Adds what is in an instance, whose middle is given.
    fn add(&mut self, form: &Form, at: DVec3) {
        let parts = self.roots.parts;
        if ends(parts, form, &self.end) || form.is_small(&self.end, 1.0) {
            return self.add_solid(form, at);
        }
        for child in &parts[form.object].children {
            let inner = form.inner(parts, child);
            self.add(&inner, at + form.offset(child, &inner));
        }
    }

    fn add_solid(&mut self, form: &Form, at: DVec3) {
        let Some(solid) = self.roots.parts[form.object].drawn(form.level, &self.end) else {
            return;
        };
        self.elements += 1;
        self.deepest = self.deepest.max(form.level);
        let reach = form.half + self.roots.pad + SPREAD;
        let Some([left, top, right, bottom]) = self.view.rectangle(at, reach) else {
            return;
        };
        let map = DAffine3::from_mat3_translation(form.linear, at - form.middle);
        let body = Body::new(solid, &map).grown(SPREAD);
        let class = self.roots.class(form, 0);
        self.planes.set(
            Projection::Parallel,
            body.faces(&self.view),
            &mut Classes::One(class),
        );
        for y in top..bottom.min(WIDTH) {
            let row = &mut self.keys[y * WIDTH..(y + 1) * WIDTH];
            let row = &mut row[left.min(WIDTH)..right.min(WIDTH)];
            draw_row::<false>(&self.planes, row, &self.view, [left, y], class);
        }
    }

    /// Returns the stamp, without what shows nothing around what is shown.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "classes are the low bits, and sides are small"
    )]
    fn stamp(self) -> TurnedStamp {
        let (mut corner, mut end) = ([WIDTH; 2], [0; 2]);
        let is_shown = |key: &u32| *key != EMPTY;
        for (y, row) in self.keys.chunks_exact(WIDTH).enumerate() {
            if let Some(first) = row.iter().position(is_shown) {
                let last = row.iter().rposition(is_shown).unwrap_or(first);
                corner = [corner[0].min(first), corner[1].min(y)];
                end = [end[0].max(last + 1), y + 1];
            }
        }
        corner = [corner[0].min(end[0]), corner[1].min(end[1])];
        // Rows consist of pieces.
        let columns = (end[0] - corner[0]).next_multiple_of(PIECE);
        let corner = [corner[0].min(WIDTH - columns), corner[1]];
        let rows = { self.keys.chunks_exact(WIDTH) }
            .take(end[1])
            .skip(corner[1])
            .map(|row| &row[corner[0]..corner[0] + columns]);
        let (mut ranges, mut keys) = (Vec::new(), Vec::new());
        for row in rows {
            let shows = |piece: &[u32]| piece.iter().any(is_shown);
            let pieces = row.chunks_exact(PIECE);
            let first = pieces.clone().position(shows).unwrap_or(0);
            let last = pieces.clone().rposition(shows).map_or(0, |last| last + 1);
            ranges.push(u16::from_le_bytes([first as u8, last as u8]));
            keys.extend_from_slice(&row[first * PIECE..last * PIECE]);
        }
        let depths = keys.iter().map(|key| depth_in_stamp(*key));
        let classes = keys.iter().map(|key| match *key {
            EMPTY => 0,
            key => key as u16 & MAX_CLASS,
        });
        let nearest = depths.clone().fold(NOTHING, u16::min);
        let has_classes = classes.clone().any(|class| class > 0);
        let kinds = if has_classes { 2 } else { 1 };
        let mut content = Vec::with_capacity(ranges.len() + kinds * keys.len());
        content.extend(ranges);
        content.extend(depths);
        if has_classes {
            content.extend(classes);
        }
        TurnedStamp {
            content: content.into(),
            nearest,
            has_classes,
            corner: corner.map(|at| at as u8),
            end: end.map(|at| at as u8),
            elements: u32::try_from(self.elements).unwrap_or(u32::MAX),
            deepest: self.deepest,
        }
    }
}

/// Returns the depth of a key in steps of a stamp.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the numbers are small"
)]
fn depth_in_stamp(key: u32) -> u16 {
    match key {
        EMPTY => NOTHING,
        key => (f64::from(key >> CLASS_BITS) * f64::from(FINE) / STEPS) as u16,
    }
}
