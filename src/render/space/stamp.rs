//! Stamps: small pictures of a form, of which all its instances are copies.
//!
//! A stamp knows the plane that each sample shows, so that a copy has exact depths wherever it lies. Its outline
//! is exact to an eighth of a sample: there are stamps for 4 × 4 positions relative to a sample, and solids are
//! drawn larger by the difference, so that neighbours leave no gap.

use crate::geometry::{DAffine3, DVec3};

use super::buffer::{Buffer, CLASS_BITS, MARGIN, STEPS, STRIDE};
use super::descent::Roots;
use super::forms::Form;
use super::lit::Classes;
use super::planes::Planes;
use super::solid::{View, faces};

/// Positions along a side of a sample in which there are stamps.
pub(super) const PHASES: usize = 4;

/// Samples by which solids are drawn larger than they are.
const SPREAD: f64 = 0.5 / PHASES as f64;

/// Samples along a side of a stamp.
pub(super) const WIDTH: usize = MARGIN;

/// Largest half side of a form that has stamps, in samples.
pub(super) const REACH: f64 = WIDTH as f64 / 2.0 - 0.5 - SPREAD;

/// Largest slope of a plane by which depths change from copy to copy.
const STEEPEST: f64 = 4.0;

/// Depths that differ by less, in steps, are equal.
const EQUAL: f32 = 1.0 / 64.0;

/// Samples of a piece of a row.
pub(super) const PIECE: usize = 8;

/// Pieces of a row of a stamp.
const PIECES: usize = WIDTH / PIECE;

/// Piece of a row. Depths are in steps.
#[derive(Clone)]
struct Piece {
    depth: [f32; PIECE],
    /// Change of the depth for a copy that lies a sample farther to the right, and further down.
    slope: [[f32; PIECE]; 2],
    /// Classes; all bits are set where nothing is shown.
    class: [u32; PIECE],
}

const NOTHING: Piece = Piece {
    depth: [0.0; PIECE],
    slope: [[0.0; PIECE]; 2],
    class: [u32::MAX; PIECE],
};

/// Picture of a form in a position relative to a sample.
pub(super) struct Stamp {
    /// The rows one after the other, each of as many pieces.
    pieces: Vec<Piece>,
    columns: usize,
    /// The samples that show something: left, top, right, bottom.
    extent: [usize; 4],
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

impl Stamp {
    /// Draws an instance of a form that has stamps, whose middle is at a point.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the numbers are small"
    )]
    pub(super) fn draw<'a>(
        roots: &Roots<'a>,
        view: &View<'_>,
        buffer: &mut Buffer,
        (form, at, class): (&'a Form, DVec3, u16),
    ) -> Option<&'a Self> {
        let stamps = form.stamps.as_ref()?;
        let phases = PHASES as f64;
        let fine = [at.x - view.corner[0], at.y - view.corner[1]].map(|at| at * phases);
        let near = fine.map(f64::round);
        let [x, y] = near.map(|at| at as isize);
        let phase = [x, y].map(|at| at.rem_euclid(PHASES as isize) as usize);
        let stamp = stamps[phase[1] * PHASES + phase[0]]
            .get_or_init(|| Builder::build(roots, view, form, phase));
        let depth = view.depths.exact(at.z + form.half.z);
        let base = depth.floor();
        let copy = Copy {
            base: base as i32 - bias(roots, view) as i32,
            fraction: (depth - base) as f32,
            shift: [0, 1].map(|axis| ((fine[axis] - near[axis]) / phases) as f32),
            class: u32::from(class) << roots.lit.and_then(|lit| lit.bits()).unwrap_or(0),
        };
        // The corner of the stamp, counted from that of the margin.
        let corner = [x, y].map(|at| {
            let at = at.div_euclid(PHASES as isize) + (MARGIN - WIDTH / 2) as isize;
            at.clamp(0, (STRIDE - WIDTH) as isize) as usize
        });
        let [left, top, right, bottom] = stamp.extent;
        if left < right {
            let start = (corner[1] + top) * STRIDE + corner[0] + left / PIECE * PIECE;
            let keys = &mut buffer.with_margin()[start..];
            if blit(keys, stamp.columns, &stamp.pieces, &copy) {
                let [x, y] = corner;
                buffer.refresh_with_margin([x + left, y + top, x + right, y + bottom]);
            }
        }
        Some(stamp)
    }

    /// Removes the pieces that show nothing around what is shown.
    fn crop(&mut self) {
        let [left, top, right, bottom] = self.extent;
        let columns = left / PIECE..right.div_ceil(PIECE).max(left / PIECE);
        let rows = self.pieces.chunks_exact(PIECES).take(bottom).skip(top);
        self.pieces = rows
            .flat_map(|row| &row[columns.clone()])
            .cloned()
            .collect();
        self.columns = columns.len();
    }
}

/// Returns the steps by which the depths of rows are larger than they are, so that none is negative: a copy changes
/// them by at most a sample.
fn bias(roots: &Roots<'_>, view: &View<'_>) -> f64 {
    (view.depths.steps() * (1.0 + roots.pad)).ceil()
}

/// Draws a copy, whose corner is that of `keys`; returns whether it is seen.
#[cfg_attr(feature = "simd", multiversion::multiversion(targets("x86_64+avx2")))]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the numbers are clamped"
)]
fn blit(keys: &mut [u32], columns: usize, pieces: &[Piece], copy: &Copy) -> bool {
    const LAST: i32 = STEPS as i32;
    let mut seen = 0;
    for (row, pieces) in keys.chunks_mut(STRIDE).zip(pieces.chunks_exact(columns)) {
        for (keys, piece) in row.chunks_exact_mut(PIECE).zip(pieces) {
            for (x, key) in keys.iter_mut().enumerate() {
                let change = piece.slope[0][x] * copy.shift[0] + piece.slope[1][x] * copy.shift[1];
                let depth = (piece.depth[x] + change + copy.fraction) as i32;
                let depth = (depth + copy.base).clamp(0, LAST) as u32;
                let new = depth << CLASS_BITS | copy.class | piece.class[x];
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
    view: &'a View<'a>,
    stamp: Stamp,
    planes: Planes,
    /// The middle of the form.
    middle: [f64; 2],
    /// z of the depth 0.
    near: f64,
}

impl<'a> Builder<'a> {
    #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
    fn build(roots: &'a Roots<'a>, view: &'a View<'a>, form: &Form, phase: [usize; 2]) -> Stamp {
        let mut builder = Self {
            roots,
            view,
            stamp: Stamp {
                pieces: vec![NOTHING; WIDTH * PIECES],
                columns: PIECES,
                extent: [WIDTH, WIDTH, 0, 0],
                elements: 0,
                deepest: 0,
            },
            planes: Planes::default(),
            middle: phase.map(|phase| WIDTH as f64 / 2.0 + phase as f64 / PHASES as f64),
            near: form.half.z,
        };
        builder.add(form, DVec3::ZERO, 0);
        builder.stamp.crop();
        builder.stamp
    }

    /// Adds what is in an instance, `at` being the vector from the middle of the form of the stamp to its own.
    fn add(&mut self, form: &Form, at: DVec3, class: u16) {
        let roots = self.roots;
        match roots.forms.steps(form) {
            Some(steps) => {
                // From near to far.
                for step in steps.iter().rev() {
                    let inner = &roots.forms.known[step.form];
                    self.add(inner, at + step.offset, step.class.unwrap_or(class));
                }
            }
            None => self.add_solid(form, at, class),
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the numbers are small"
    )]
    fn add_solid(&mut self, form: &Form, at: DVec3, class: u16) {
        let roots = self.roots;
        let Some(solid) = roots.parts[form.object].drawn(form.level, &roots.end) else {
            return;
        };
        self.stamp.elements += 1;
        self.stamp.deepest = self.stamp.deepest.max(form.level);
        let class = roots.class(form, class);
        let map = DAffine3::from_mat3_translation(form.linear, at - form.middle);
        let faces = faces(solid, &map, self.view);
        let projection = self.view.projection;
        match roots.lit.and_then(|lit| Some((lit, lit.bits()?))) {
            None => self.planes.set(projection, faces, &mut Classes::One(class)),
            Some((lit, bits)) => {
                let (lit, of) = (&lit, &mut |level| class << bits | level);
                let classes = &mut Classes::OfLevels { lit, bits, of };
                self.planes.set(projection, faces, classes);
            }
        }
        let steps = self.view.depths.steps();
        let bias = bias(roots, self.view);
        let reach = form.half + roots.pad;
        let span = |axis: usize| {
            let [at, reach] = [at, reach].map(|it| it[axis]);
            let ends = [at - reach - SPREAD, at + reach + SPREAD];
            let ends = ends.map(|end| (end + self.middle[axis]).clamp(0.0, WIDTH as f64));
            ends[0].floor() as usize..ends[1].ceil() as usize
        };
        for y in span(1) {
            for x in span(0) {
                let place = [
                    x as f64 + 0.5 - self.middle[0],
                    y as f64 + 0.5 - self.middle[1],
                ];
                let Some((z, slope, class)) = self.planes.meet(place, SPREAD) else {
                    continue;
                };
                let class = u32::from(class);
                // Beyond its outline the solid is continued.
                let z = z.clamp(at.z - reach.z, at.z + reach.z);
                let depth = ((self.near - z) * steps + bias) as f32;
                let piece = &mut self.stamp.pieces[y * PIECES + x / PIECE];
                let within = x % PIECE;
                let known = piece.class[within];
                let farther = depth - piece.depth[within];
                if known == u32::MAX || farther < -EQUAL || farther <= EQUAL && class < known {
                    piece.depth[within] = depth;
                    for (own, slope) in piece.slope.iter_mut().zip(slope) {
                        own[within] = (slope.clamp(-STEEPEST, STEEPEST) * steps) as f32;
                    }
                    piece.class[within] = class;
                    let [left, top, right, bottom] = self.stamp.extent;
                    self.stamp.extent =
                        [left.min(x), top.min(y), right.max(x + 1), bottom.max(y + 1)];
                }
            }
        }
    }
}
