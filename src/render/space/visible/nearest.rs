//! Nearest polygons at the samples of a picture, by which hidden ones are left out.

use super::grid::Grid;
use super::polygon::Polygon;
use crate::geometry::{Bounds, DVec2};

/// Largest number of samples along the side of a pixel.
const SAMPLES: f64 = 2.0;

/// Share of the tolerance up to which polygons are equally near at a sample: faces between elements that touch are
/// hidden but at their edges, on which no sample may fall.
const SAME: f64 = 1e-4;

/// Largest number of samples.
const MAX_SAMPLES: f64 = 16_777_216.0;

/// The greatest nearness of polygons at every sample.
pub(super) struct Nearest {
    columns: usize,
    rows: usize,
    /// Samples along the side of a pixel.
    scale: f64,
    samples: Vec<f64>,
    tolerance: f64,
}

/// Visibility of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Visibility {
    Visible,
    Hidden,
    /// The polygon is too small for samples, and those around it do not hide it.
    Unknown,
}

impl Nearest {
    /// Creates the samples of a picture; differences of nearness up to `tolerance` are none.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "pictures are small"
    )]
    pub(super) fn new(size: [u32; 2], tolerance: f64) -> Self {
        let sides = size.map(f64::from);
        let scale = SAMPLES.min((MAX_SAMPLES / (sides[0] * sides[1])).sqrt());
        let [columns, rows] = sides.map(|side| (side * scale).ceil() as usize);
        Self {
            columns,
            rows,
            scale,
            samples: vec![f64::NEG_INFINITY; columns * rows],
            tolerance: SAME * tolerance,
        }
    }

    pub(super) fn add(&mut self, polygon: &Polygon) {
        for (at, nearness) in self.of(polygon) {
            let sample = &mut self.samples[at];
            *sample = sample.max(nearness);
        }
    }

    /// Returns whether a polygon is the nearest at one of its samples.
    pub(super) fn visibility(&self, polygon: &Polygon) -> Visibility {
        let mut samples = self.of(polygon).peekable();
        if samples.peek().is_none() {
            let corners = polygon.corners().iter();
            let nearest = corners
                .map(|corner| corner.at.z)
                .fold(f64::NEG_INFINITY, f64::max);
            let is_hidden = { self.around(polygon.middle().truncate()).into_iter() }
                .all(|at| self.samples[at] > nearest + self.tolerance);
            return match is_hidden {
                true => Visibility::Hidden,
                false => Visibility::Unknown,
            };
        }
        match samples.any(|(at, nearness)| nearness >= self.samples[at] - self.tolerance) {
            true => Visibility::Visible,
            false => Visibility::Hidden,
        }
    }

    /// Returns the four samples around a point.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts saturate"
    )]
    fn around(&self, point: DVec2) -> [usize; 4] {
        let at = point * self.scale - 0.5;
        let place = |x: f64, y: f64| {
            let column = (x as usize).min(self.columns - 1);
            (y as usize).min(self.rows - 1) * self.columns + column
        };
        let [x, y] = at.floor().to_array();
        [
            place(x, y),
            place(x + 1.0, y),
            place(x, y + 1.0),
            place(x + 1.0, y + 1.0),
        ]
    }

    /// Iterates over the samples of a polygon: their places, and its nearness there.
    fn of<'p>(&self, polygon: &'p Polygon) -> impl Iterator<Item = (usize, f64)> + use<'p> {
        let (columns, rows, scale) = (self.columns, self.rows, self.scale);
        #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
        let middle = move |sample: usize| (sample as f64 + 0.5) / scale;
        let [top, bottom] = [polygon.bounds().min().y, polygon.bounds().max().y];
        between([top * scale, bottom * scale], rows).flat_map(move |row| {
            let y = middle(row);
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for ([from, to], _) in polygon.edges() {
                if (from.y <= y) != (to.y <= y) {
                    let x = from.x + (to.x - from.x) * ((y - from.y) / (to.y - from.y));
                    left = left.min(x);
                    right = right.max(x);
                }
            }
            between([left * scale, right * scale], columns).map(move |column| {
                let nearness = polygon.plane().at([middle(column), y].into());
                (row * columns + column, nearness)
            })
        })
    }
}

/// Returns the numbers of the samples between two positions in samples.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts saturate"
)]
fn between(ends: [f64; 2], most: usize) -> std::ops::Range<usize> {
    let [low, high] = ends.map(|end| ((end + 0.5).floor() as usize).min(most));
    low..high.max(low)
}

/// Leaves out polygons of unknown visibility whose middle lies behind a visible one.
pub(super) fn retain_visible<T>(
    all: &mut Vec<(T, Visibility)>,
    tolerance: f64,
    polygon: impl Fn(&T) -> &Polygon,
) {
    let visible: Vec<&Polygon> = { all.iter() }
        .filter(|(_, visibility)| *visibility == Visibility::Visible)
        .map(|(it, _)| polygon(it))
        .collect();
    let grid = Grid::new(visible.iter().map(|it| *it.bounds()));
    let is_visible = |it: &T, visibility: Visibility| {
        if visibility == Visibility::Visible {
            return true;
        }
        let middle = polygon(it).middle();
        let at = middle.truncate();
        let mut is_hidden = false;
        grid.each_near(&Bounds::new(at, at), |other| {
            let other = visible[other];
            is_hidden |= other.contains(at) && other.plane().at(at) > middle.z + tolerance;
        });
        !is_hidden
    };
    let kept: Vec<bool> = all
        .iter()
        .map(|(it, known)| is_visible(it, *known))
        .collect();
    let mut kept = kept.into_iter();
    all.retain(|_| kept.next().unwrap_or_default());
}
