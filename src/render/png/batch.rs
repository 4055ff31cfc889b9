//! Segment batches: short thin lines close together, drawn as one shape.
//!
//! Of lines shorter than a pixel, a picture shows only the area that they cover, and its position. A batch
//! covers the same area as its lines: it is a box with their centroid and with their variances along x and y.
//! Pictures with batches are within 2 of 255 shades of those in which every line is drawn. Lines of a fixed
//! width do not form batches: many of them may coincide, and a batch would count the area of each.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::grow::LineElement;
use crate::render::paint::{FINE, Pen};
use crate::render::paint_key::{class_width, width_class};

use super::coverage::SegmentBatch;

/// Maximum width of the lines of batches, in pixels; wider lines are drawn one by one.
const THIN: f64 = 0.05;
/// Maximum length of such lines, in pixels.
const LONG: f64 = 1.0;

/// Maximum length of the pieces into which lines are cut, and maximum diagonal of the lines of a batch, in
/// pixels.
const NEAR: f64 = 0.25;

/// Number of scales per octave for which batches are computed.
const SCALES_AN_OCTAVE: f64 = 64.0;

/// Maximum number of batches and of lines apart that are kept, over all blocks and scales.
const MAX_KEPT: usize = 1 << 17;

/// Combines the lines of the runs of one walk into segment batches.
pub(in crate::render) struct BatchBuilder {
    /// Logarithm to base 2 of the stroke width of a line of one pixel, in hundredths of a pixel.
    octave: f64,
    /// Length that the caps add to a line, in widths.
    ends: f64,
    /// Whether lines may join others.
    joins: bool,
    /// Results, by number of the run's block and by scale.
    kept: Mutex<Kept>,
}

#[derive(Default)]
struct Kept {
    blocks: BTreeMap<(u64, i32), Arc<Batched>>,
    /// Number of batches and lines.
    size: usize,
}

/// Lines of a run at a scale.
#[derive(Default)]
pub(in crate::render) struct Batched {
    bundles: Vec<Bundle>,
    /// Numbers of the lines that are drawn one by one; the others are in bundles. If no line joins another, they are in the
    /// order of their widths.
    pub(in crate::render) apart: Vec<u32>,
}

/// Lines that form a batch.
struct Bundle {
    centre: DVec2,
    /// Variances along x and y, and covariance.
    spread: [f32; 3],
    /// Area and mean width at the scale of the run, in pixels.
    area: f32,
    width: f32,
}

impl BatchBuilder {
    /// Creates a builder for strokes of relative width. `joins` states whether lines may join others.
    pub(super) fn new(width: f64, pen: Pen, joins: bool) -> Self {
        Self {
            octave: libm::log2(width * FINE),
            ends: 2.0 * pen.overshoot(),
            joins,
            kept: Mutex::default(),
        }
    }

    /// Combines the lines of block `number`, which is drawn at `scale` pixels per unit. Returns the result and
    /// the ratio of that scale to the one for which it was computed.
    pub(in crate::render) fn batched(
        &self,
        number: u64,
        sticks: &[LineElement],
        scale: f64,
    ) -> (Arc<Batched>, f64) {
        let octave = libm::log2(scale) * SCALES_AN_OCTAVE;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "casts from floats saturate"
        )]
        let step = (octave + 0.5).floor() as i32;
        let own_scale = libm::exp2(f64::from(step) / SCALES_AN_OCTAVE);
        let key = (number, step);
        let kept = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let known = kept().blocks.get(&key).cloned();
        let batched = known.unwrap_or_else(|| {
            let batched = Arc::new(self.at(sticks, own_scale));
            let mut kept = kept();
            let size = batched.bundles.len() + batched.apart.len();
            if kept.size + size < MAX_KEPT {
                kept.size += size + 1;
                kept.blocks.insert(key, Arc::clone(&batched));
            }
            batched
        });
        (batched, scale / own_scale)
    }

    fn at(&self, sticks: &[LineElement], scale: f64) -> Batched {
        let octave = self.octave + libm::log2(scale);
        let mut batched = Batched::default();
        let mut open = OpenBundle::default();
        let mut before = None;
        for (number, stick) in (0..).zip(sticks) {
            let class = width_class(octave + stick.octave);
            let width = class_width(class) / FINE;
            let length = stick.ends[0].distance(stick.ends[1]) * scale;
            let goes_on = stick.joined && before == Some(class);
            before = Some(class);
            if width >= THIN || length > LONG {
                batched.apart.push(number);
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
                    batched.bundles.extend(open.take());
                }
                open.add(ends, area / pieces, width);
                piece += 1.0;
            }
        }
        batched.bundles.extend(open.take());
        if !self.joins {
            // Pixels do not depend on the order: lines of one width share a path.
            let octave = |number: &u32| sticks[*number as usize].octave;
            batched
                .apart
                .sort_by(|a, b| octave(a).total_cmp(&octave(b)));
        }
        batched
    }
}

impl Batched {
    /// Returns whether all lines are drawn one by one.
    pub(in crate::render) fn is_empty(&self) -> bool {
        self.bundles.is_empty()
    }

    /// Iterates over the batches of a run that `map` places on the picture, with lines `longer` times as long.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate; single precision is enough"
    )]
    pub(in crate::render) fn placed(
        &self,
        map: DAffine2,
        longer: f64,
    ) -> impl Iterator<Item = SegmentBatch> {
        let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis].map(|axis| axis * FINE);
        let [along, across, both] = [x * x, y * y, x * y * 2.0].map(|square| {
            // The square of a line's length is twelve times its variance.
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
            SegmentBatch {
                middle: [middle.x as i32, middle.y as i32],
                extent,
                area: bundle.area * longer as f32,
                width: bundle.width,
            }
        })
    }
}

/// Bundle under construction.
#[derive(Default)]
struct OpenBundle {
    bounds: Option<Bounds>,
    /// Sums of areas, and of areas times widths, times positions relative to `origin`, and times products of
    /// the coordinates of these.
    area: f64,
    width: f64,
    origin: DVec2,
    places: DVec2,
    squares: [f64; 3],
}

impl OpenBundle {
    /// Returns whether a line lies close enough to the lines of the bundle.
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

    /// Completes the bundle; `None` if it covers no area.
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
