//! Tufts: short thin lines that stand close together in a block, drawn as one.
//!
//! Of lines that are shorter than a pixel a picture shows no more than how much they cover and
//! where. A tuft covers as much as its lines do, and is a box with their centre and their variance
//! across and down. Combed pictures are within 2 of 255 shades of those where every line is drawn.
//! Lines of one fixed width are not combed: many of them may lie on each other, and make so much of
//! what a tuft is off.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::grow::Stick;

use super::sketch::{class_width, width_class};
use super::surface::{FINE, Pen, Tuft};

/// Lines that are wider than this, in pixels, or longer, are drawn one by one.
const THIN: f64 = 0.05;
const LONG: f64 = 1.0;

/// Lines are cut into pieces that are no longer than this, in pixels, and neither is the diagonal of
/// what a tuft holds.
const NEAR: f64 = 0.25;

/// Blocks are combed for scales that are this part of an octave apart.
const SCALES_AN_OCTAVE: f64 = 64.0;

/// Combed blocks are kept up to so many bundles together.
const MOST_KEPT: usize = 1 << 17;

/// Combs the blocks of one walk.
pub(super) struct Comb {
    /// The logarithm to base 2 of the width of a line one pixel long, in hundredths of a pixel.
    octave: f64,
    /// What caps add to a line, in widths.
    ends: f64,
    /// Lines are thinner than this, in pixels.
    below: f64,
    /// By where a block's lines are and by scale. A walk makes each block once.
    kept: Mutex<Kept>,
}

#[derive(Default)]
struct Kept {
    blocks: BTreeMap<(usize, i32), Arc<Combed>>,
    bundles: usize,
}

/// The lines of a block at a scale.
#[derive(Default)]
pub(super) struct Combed {
    bundles: Vec<Bundle>,
    /// The lines that are drawn one by one, without those between.
    pub(super) apart: Vec<Range<usize>>,
}

/// Lines of a block that make a tuft.
struct Bundle {
    centre: DVec2,
    /// Variances along x and y, and their covariance.
    spread: [f32; 3],
    /// The area and the mean width at the scale of the block, in pixels.
    area: f32,
    width: f32,
}

impl Comb {
    /// Of strokes whose width is relative, thinner than `below` pixels.
    pub(super) fn new(width: f64, pen: Pen, below: f64) -> Self {
        Self {
            octave: libm::log2(width * FINE),
            ends: 2.0 * pen.overshoot(),
            below: below.min(THIN),
            kept: Mutex::default(),
        }
    }

    /// Combs a block that stands on the picture with so many pixels to the unit. Also tells how much
    /// longer its lines are than at the scale that they have been combed for.
    pub(super) fn comb(&self, sticks: &[Stick], scale: f64) -> (Arc<Combed>, f64) {
        let octave = libm::log2(scale) * SCALES_AN_OCTAVE;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "casts from floats saturate"
        )]
        let step = (octave + 0.5).floor() as i32;
        let combed_scale = libm::exp2(f64::from(step) / SCALES_AN_OCTAVE);
        let key = (sticks.as_ptr().addr(), step);
        let kept = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let known = kept().blocks.get(&key).cloned();
        let combed = known.unwrap_or_else(|| {
            let combed = Arc::new(self.combed(sticks, combed_scale));
            let mut kept = kept();
            if kept.bundles + combed.bundles.len() < MOST_KEPT {
                kept.bundles += combed.bundles.len() + 1;
                kept.blocks.insert(key, Arc::clone(&combed));
            }
            combed
        });
        (combed, scale / combed_scale)
    }

    fn combed(&self, sticks: &[Stick], scale: f64) -> Combed {
        let octave = self.octave + libm::log2(scale);
        let mut combed = Combed::default();
        let mut open = Open::default();
        let mut before = None;
        for (number, stick) in sticks.iter().enumerate() {
            let class = width_class(octave + stick.octave);
            let width = class_width(class) / FINE;
            let length = stick.ends[0].distance(stick.ends[1]) * scale;
            let goes_on = stick.joined && before == Some(class);
            before = Some(class);
            if width >= self.below || length > LONG {
                match combed.apart.last_mut() {
                    Some(range) if range.end == number => range.end += 1,
                    _ => combed.apart.push(number..number + 1),
                }
                continue;
            }
            let ends = if goes_on { 0.0 } else { self.ends };
            let area = (length + ends * width) * width;
            let [from, to] = stick.ends;
            let pieces = (length / NEAR).ceil().max(1.0);
            let way = (to - from) / pieces;
            let mut piece = 0.0;
            while piece < pieces {
                let ends = [piece, piece + 1.0].map(|part| from + way * part);
                if !open.has_room_for(ends, NEAR / scale) {
                    combed.bundles.extend(open.take());
                }
                open.add(ends, area / pieces, width);
                piece += 1.0;
            }
        }
        combed.bundles.extend(open.take());
        combed
    }
}

impl Combed {
    /// Whether all lines are drawn one by one.
    pub(super) fn is_bald(&self) -> bool {
        self.bundles.is_empty()
    }

    /// The tufts of a block on the picture, with lines that are so much longer.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate; single precision is enough"
    )]
    pub(super) fn tufts(&self, map: DAffine2, longer: f64) -> impl Iterator<Item = Tuft> {
        let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis].map(|axis| axis * FINE);
        let [along, across, both] = [x * x, y * y, x * y * 2.0].map(|square| {
            // Twelve times the variance of a line that is spread out evenly is its square.
            (square * 12.0).to_array().map(|square| square as f32)
        });
        self.bundles.iter().map(move |bundle| {
            let middle = map.transform_point2(bundle.centre) * (2.0 * FINE) + 0.5;
            let [xx, yy, xy] = bundle.spread;
            let width = bundle.width * FINE as f32 + 0.5;
            let extent = [0, 1].map(|axis| {
                let square = along[axis] * xx + across[axis] * yy + both[axis] * xy;
                (square.sqrt() + width) as u32
            });
            Tuft {
                middle: [middle.x as i32, middle.y as i32],
                extent,
                area: bundle.area * longer as f32,
                width: bundle.width,
            }
        })
    }
}

/// A bundle that is being made.
#[derive(Default)]
struct Open {
    bounds: Option<Bounds>,
    /// Sums of areas, and of those times widths, places and products of places from `origin`.
    area: f64,
    width: f64,
    origin: DVec2,
    places: DVec2,
    squares: [f64; 3],
}

impl Open {
    /// Whether a line lies near enough to those that it has.
    fn has_room_for(&self, ends: [DVec2; 2], near: f64) -> bool {
        self.bounds.as_ref().is_none_or(|bounds| {
            let mut all = *bounds;
            ends.into_iter().for_each(|end| all.add(end));
            all.size().length() <= near
        })
    }

    fn add(&mut self, ends: [DVec2; 2], area: f64, width: f64) {
        let [from, to] = ends;
        if self.bounds.is_none() {
            self.origin = from;
        }
        let bounds = self.bounds.get_or_insert(Bounds::EMPTY);
        ends.into_iter().for_each(|end| bounds.add(end));
        let (middle, way) = ((from + to) / 2.0 - self.origin, to - from);
        self.area += area;
        self.width += area * width;
        self.places += middle * area;
        let square =
            |a: f64, b: f64, along: f64, across: f64| (a * b + along * across / 12.0) * area;
        self.squares[0] += square(middle.x, middle.x, way.x, way.x);
        self.squares[1] += square(middle.y, middle.y, way.y, way.y);
        self.squares[2] += square(middle.x, middle.y, way.x, way.y);
    }

    /// What there is, if it covers anything.
    fn take(&mut self) -> Option<Bundle> {
        let done = std::mem::take(self);
        let area = done.area;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "single precision is enough"
        )]
        (area > 0.0).then(|| {
            let mean = done.places / area;
            let [xx, yy, xy] = done.squares.map(|square| square / area);
            let [xx, yy] = [xx - mean.x * mean.x, yy - mean.y * mean.y];
            Bundle {
                centre: done.origin + mean,
                spread: [xx.max(0.0), yy.max(0.0), xy - mean.x * mean.y].map(|part| part as f32),
                area: area as f32,
                width: (done.width / area) as f32,
            }
        })
    }
}
