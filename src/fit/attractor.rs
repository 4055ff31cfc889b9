//! The attractor of a candidate to exact pixels, by descent.

use std::collections::{BinaryHeap, VecDeque};
use std::sync::atomic::AtomicBool;

use crate::Bits;
use crate::fast_hash::FastSet;
use crate::geometry::{DAffine2, DVec2, stretch};
use crate::parallel::is_cancelled;

use super::candidate::{Disk, Metric, fixed_point};
use super::{Candidate, FitError};

/// Radii in pixels of the largest parts of an attractor that count as points; the second where the first needs too many.
const POINTS: [f64; 2] = [1.0 / 16.0, 1.0];
/// Limit of the number of parts that a descent visits.
const MAX_PARTS: usize = 1_000_000;

/// The pixels of an attractor, in the rows of a picture.
#[derive(Clone, Debug)]
pub struct Attractor {
    /// Pixels that hold a point of the attractor.
    pub pixels: Bits,
    /// Pixels that hold a point of the attractor an eighth of a pixel inside, or a part of it without a point outside.
    certain: Bits,
    /// Pixels within an eighth of a pixel of a point of the attractor.
    possible: Bits,
    /// Whether a point of the attractor lies outside the picture, by more than an eighth of a pixel.
    pub leaves: bool,
    /// Whether the descent was not cut short.
    fine: bool,
    /// Number of parts that the descent visited.
    pub(super) parts: usize,
}

impl Attractor {
    /// Returns whether a picture is that of the attractor, up to pixels that the attractor touches or leaves by at
    /// most an eighth of a pixel.
    #[must_use]
    pub fn is(&self, picture: &Bits) -> bool {
        self.fine && self.mismatches(picture) == 0
    }

    /// Returns the number of pixels in which a picture differs from that of the attractor, except for those that the
    /// attractor only touches.
    pub(super) fn mismatches(&self, picture: &Bits) -> u64 {
        let words = picture
            .words()
            .iter()
            .zip(self.certain.words())
            .zip(self.possible.words());
        let wrong = words.map(|((own, least), most)| (least & !own | own & !most).count_ones());
        wrong.map(u64::from).sum::<u64>() + u64::from(self.leaves)
    }
}

impl Candidate {
    /// Returns the attractor in a picture of `size` pixels, width and height.
    ///
    /// The attractor is divided into the images of a disk that holds it, until each of them lies in one pixel, touches
    /// only pixels that are known to hold a point, or has a radius of 1/16 of a pixel; of more if that would take millions of
    /// parts.
    ///
    /// # Errors
    ///
    /// Returns an error if the maps do not contract in any norm of ellipses, or if the work is cancelled.
    pub fn attractor(
        &self,
        size: [usize; 2],
        cancel: Option<&AtomicBool>,
    ) -> Result<Attractor, FitError> {
        let [fine, coarse] = POINTS;
        match self.drawn(size, fine, cancel)? {
            (drawn, true) => Ok(drawn),
            _ => Ok(self.drawn(size, coarse, cancel)?.0),
        }
    }

    /// Returns pixels that hold points of the attractor, by parts with a radius of a pixel: faster than
    /// [`attractor`](Self::attractor), and nearly the same.
    pub(super) fn roughly(
        &self,
        size: [usize; 2],
        cancel: Option<&AtomicBool>,
    ) -> Result<Bits, FitError> {
        Ok(self.drawn(size, POINTS[1], cancel)?.0.pixels)
    }

    /// Returns the middle and half the sides of a box that holds the attractor, and hardly more.
    pub(super) fn bounds(&self) -> Option<[DVec2; 2]> {
        Some(self.enclosing()?.bounds)
    }

    /// Returns the attractor by parts of a radius of at least `point` pixels, and whether none is left out.
    fn drawn(
        &self,
        [width, height]: [usize; 2],
        point: f64,
        cancel: Option<&AtomicBool>,
    ) -> Result<(Attractor, bool), FitError> {
        let new = || Bits::new(width, height);
        let mut descent = Descent {
            drawn: Attractor {
                pixels: new(),
                certain: new(),
                possible: new(),
                leaves: false,
                fine: point <= POINTS[0],
                parts: 0,
            },
            size: [width, height],
            point,
            candidate: self,
            whole: self.enclosing().ok_or(FitError::DoesNotContract)?,
            seen: FastSet::default(),
        };
        descent.scatter();
        // Large parts come first: most pixels are known when small parts are looked at.
        let mut queue = VecDeque::from([DAffine2::IDENTITY]);
        while let Some(map) = queue.pop_front() {
            descent.drawn.parts += 1;
            let parts = descent.drawn.parts;
            if parts > MAX_PARTS {
                return Ok((descent.drawn, false));
            }
            if parts.is_multiple_of(4096) && is_cancelled(cancel) {
                return Err(FitError::Cancelled);
            }
            if descent.divides(&map) {
                queue.extend(self.maps.iter().map(|inner| map * *inner));
            }
        }
        Ok((descent.drawn, true))
    }

    /// Returns a disk, in the coordinates of the [`Metric`], that holds the attractor; `None` if the maps do not
    /// contract there.
    fn enclosing(&self) -> Option<Enclosing> {
        let metric = self.metric();
        if metric.contraction >= 0.9999 || self.maps.is_empty() {
            return None;
        }
        let back = metric.there.inverse();
        let maps: Vec<DAffine2> = { self.maps.iter() }
            .map(|map| {
                let matrix = metric.there * map.matrix2 * back;
                DAffine2::from_mat2_translation(matrix, metric.there * map.translation)
            })
            .collect();
        let longest = stretch(&metric.there);
        let disks: Vec<Disk> = { self.disks.iter() }
            .map(|disk| Disk {
                centre: metric.there * disk.centre,
                radius: disk.radius * longest,
            })
            .collect();
        let fixed: Vec<DVec2> = maps.iter().filter_map(fixed_point).collect();
        let centre = middle(&maps, &fixed)?;
        // The radius holds if every image of the disk lies in the disk.
        let radius = maps.iter().map(|map| {
            (map.transform_point2(centre) - centre).length() / (1.0 - metric.contraction)
        });
        let least = disks
            .iter()
            .map(|disk| disk.centre.distance(centre) + disk.radius);
        let radius = radius.chain(least).fold(1e-9, f64::max);
        let parts = parts(&maps, &disks, centre, radius);
        let radius = parts.iter().fold(0.0, |most: f64, (point, reach)| {
            most.max(point.distance(centre) + reach)
        });
        let mut bounds = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let rows = back.transpose();
        let unit = DVec2::new(rows.x_axis.length(), rows.y_axis.length());
        for (point, reach) in &parts {
            let [point, half] = [back * *point, unit * *reach];
            bounds = [bounds[0].min(point - half), bounds[1].max(point + half)];
        }
        Some(Enclosing {
            radius,
            bounds: [(bounds[0] + bounds[1]) / 2.0, (bounds[1] - bounds[0]) / 2.0],
            metric,
            centre: back * centre,
            fixed: back * fixed.first()?,
        })
    }
}

/// Returns the middle of the box of points of an attractor.
fn middle(maps: &[DAffine2], fixed: &[DVec2]) -> Option<DVec2> {
    const POINTS: usize = 4096;
    let mut points = fixed.to_vec();
    let mut next = 0;
    while points.len() < POINTS && next < points.len() {
        let point = points[next];
        points.extend(maps.iter().map(|map| map.transform_point2(point)));
        next += 1;
    }
    let low = points.iter().copied().reduce(DVec2::min)?;
    let high = points.iter().copied().reduce(DVec2::max)?;
    Some((low + high) / 2.0)
}

/// Returns disks, by centre and radius, that hold an attractor together, given one about `centre` that does: those that
/// reach farthest are divided.
fn parts(maps: &[DAffine2], disks: &[Disk], centre: DVec2, radius: f64) -> Vec<(DVec2, f64)> {
    const DIVISIONS: usize = 1500;
    let placed = |map: &DAffine2, point: DVec2, radius: f64| {
        (map.transform_point2(point), stretch(&map.matrix2) * radius)
    };
    let mut known = vec![DAffine2::IDENTITY];
    // The bits of positive numbers are in the order of the numbers.
    let mut queue = BinaryHeap::from([(u64::MAX, 0)]);
    let mut found = Vec::new();
    for _ in 0..DIVISIONS {
        let Some((_, number)) = queue.pop() else {
            break;
        };
        let map = known[number];
        found.extend(
            disks
                .iter()
                .map(|disk| placed(&map, disk.centre, disk.radius)),
        );
        for inner in maps {
            let part = map * *inner;
            let (point, own) = placed(&part, centre, radius);
            queue.push(((point.distance(centre) + own).to_bits(), known.len()));
            known.push(part);
        }
    }
    let left = queue
        .into_iter()
        .map(|(_, number)| placed(&known[number], centre, radius));
    found.extend(left);
    found
}

/// A disk that holds the attractor, in coordinates in which the maps contract.
struct Enclosing {
    metric: Metric,
    /// Its centre in pixels.
    centre: DVec2,
    /// Its radius in the coordinates of the metric.
    radius: f64,
    /// Centre and half sides of a box that holds the attractor, in pixels.
    bounds: [DVec2; 2],
    /// A point of the attractor, in pixels.
    fixed: DVec2,
}

struct Descent<'c> {
    drawn: Attractor,
    size: [usize; 2],
    /// Radius of the largest parts that count as points.
    point: f64,
    candidate: &'c Candidate,
    whole: Enclosing,
    seen: FastSet<[[i32; 2]; 3]>,
}

/// Columns and rows of pixels, from the first to the last; possibly outside the picture.
#[derive(Clone, Copy)]
struct Pixels {
    first: [i64; 2],
    last: [i64; 2],
}

impl Descent<'_> {
    /// Marks pixels by points of the attractor, one for each quarter of a pixel: where copies overlap, few parts are left.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "places outside the picture are compared with its size"
    )]
    fn scatter(&mut self) {
        let [width, height] = self.size;
        let mut seen = Bits::new(2 * width, 2 * height);
        let mut points: Vec<DVec2> = self.candidate.fixed_points().collect();
        while let Some(point) = points.pop() {
            let (x, y) = (point.x, height as f64 - point.y);
            let is_inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
            if !is_inside || !seen.insert((2.0 * x) as usize, (2.0 * y) as usize) {
                continue;
            }
            let (column, row) = (x as usize, y as usize);
            self.drawn.pixels.set(column, row);
            self.drawn.possible.set(column, row);
            let depth = [x, y].map(|at| (at - at.floor() - 0.5).abs());
            if depth[0].max(depth[1]) < 0.5 - 2.0 * POINTS[0] {
                self.drawn.certain.set(column, row);
            }
            points.extend(
                self.candidate
                    .maps
                    .iter()
                    .map(|map| map.transform_point2(point)),
            );
        }
    }

    /// Draws the part of the attractor under a map, unless its own parts are to be drawn. Returns `true` if they are.
    fn divides(&mut self, map: &DAffine2) -> bool {
        for disk in &self.candidate.disks {
            self.draw(map, disk);
        }
        let matrix = map.matrix2 * self.whole.metric.there.inverse();
        let centre = map.transform_point2(self.whole.centre);
        let rows = matrix.transpose();
        let half = DVec2::new(rows.x_axis.length(), rows.y_axis.length()) * self.whole.radius;
        let [middle, sides] = self.whole.bounds;
        let middle = map.transform_point2(middle);
        let sides = map.matrix2.abs() * sides;
        let low = (centre - half).max(middle - sides);
        let high = (centre + half).min(middle + sides);
        let half = (high - low) / 2.0;
        let touched = self.pixels(low, high);
        let Some(inside) = self.clipped(touched) else {
            // Outside the picture, a part is drawn no further.
            self.drawn.leaves |= true;
            return false;
        };
        let is_within = inside.first == touched.first && inside.last == touched.last;
        if touched.first == touched.last {
            let [column, row] = index(touched.first);
            self.drawn.pixels.set(column, row);
            self.drawn.certain.set(column, row);
            self.drawn.possible.set(column, row);
            return false;
        }
        if (is_within || self.drawn.leaves) && self.holds(&inside) {
            return false;
        }
        if half.max_element() > self.point {
            return self.is_new(map);
        }
        let point = map.transform_point2(self.whole.fixed);
        let place = self.pixels(point, point);
        if let Some(here) = self.clipped(place) {
            let [column, row] = index(here.first);
            self.drawn.pixels.set(column, row);
        }
        for row in inside.first[1]..=inside.last[1] {
            for column in inside.first[0]..=inside.last[0] {
                let [column, row] = index([column, row]);
                self.drawn.possible.set(column, row);
            }
        }
        false
    }

    /// Returns whether no part was divided yet that is the same within a quarter of the radius of a point: parts lie upon each other where
    /// copies overlap or are flat.
    #[expect(clippy::cast_possible_truncation, reason = "parts lie in the picture")]
    fn is_new(&mut self, map: &DAffine2) -> bool {
        let quantum = self.point / 4.0;
        let [middle, sides] = self.whole.bounds;
        let middle = map.transform_point2(middle);
        let numbers = [
            middle,
            map.matrix2.x_axis * sides.x,
            map.matrix2.y_axis * sides.y,
        ];
        let rounded = numbers.map(|it| [it.x, it.y].map(|value| (value / quantum).round() as i32));
        self.seen.insert(rounded)
    }

    /// Returns the pixels that a box touches.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "what leaves the range is far outside the picture"
    )]
    fn pixels(&self, low: DVec2, high: DVec2) -> Pixels {
        let height = self.size[1] as f64;
        let [left, right] = [low.x, high.x].map(|x| x.floor() as i64);
        let [top, bottom] = [height - high.y, height - low.y].map(|y| y.floor() as i64);
        Pixels {
            first: [left, top],
            last: [right, bottom],
        }
    }

    /// Returns the part of a range that lies in the picture.
    fn clipped(&self, pixels: Pixels) -> Option<Pixels> {
        let [width, height] = self
            .size
            .map(|length| i64::try_from(length).unwrap_or(i64::MAX));
        let clipped = Pixels {
            first: pixels.first.map(|place| place.max(0)),
            last: [
                pixels.last[0].min(width - 1),
                pixels.last[1].min(height - 1),
            ],
        };
        let [columns, rows] = [0, 1].map(|axis| clipped.first[axis] <= clipped.last[axis]);
        (columns && rows).then_some(clipped)
    }

    /// Returns whether all pixels of a range are known to hold a point.
    fn holds(&self, pixels: &Pixels) -> bool {
        let area = (pixels.last[0] - pixels.first[0] + 1) * (pixels.last[1] - pixels.first[1] + 1);
        area <= 4096
            && (pixels.first[1]..=pixels.last[1]).all(|row| {
                (pixels.first[0]..=pixels.last[0]).all(|column| {
                    let [column, row] = index([column, row]);
                    self.drawn.pixels.get(column, row)
                })
            })
    }

    /// Draws the image of a disk: the pixels that it touches.
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    fn draw(&mut self, map: &DAffine2, disk: &Disk) {
        let matrix = map.matrix2 * disk.radius;
        let centre = map.transform_point2(disk.centre);
        let rows = matrix.transpose();
        let half = DVec2::new(rows.x_axis.length(), rows.y_axis.length());
        let touched = self.pixels(centre - half, centre + half);
        let Some(inside) = self.clipped(touched) else {
            return;
        };
        // The ellipse is {centre + M u, |u| ≤ 1}: at the height y it spans x from slope·y ± the rest.
        let (xy, yy) = (rows.x_axis.dot(rows.y_axis), half.y * half.y);
        let slope = if yy > 0.0 { xy / yy } else { 0.0 };
        let narrow = libm::sqrt((half.x * half.x - slope * xy).max(0.0));
        // The heights, as parts of the half height, of the points that are farthest to the right and left.
        let tilt = if half.x > 0.0 && half.y > 0.0 {
            xy / (half.x * half.y)
        } else {
            0.0
        };
        let height = self.size[1] as f64;
        for row in inside.first[1]..=inside.last[1] {
            let upper = height - row as f64 - centre.y;
            let [low, high] = [upper - 1.0, upper].map(|y| {
                if half.y > 0.0 {
                    (y / half.y).clamp(-1.0, 1.0)
                } else {
                    0.0
                }
            });
            let at = |t: f64, side: f64| {
                slope * t * half.y + side * narrow * libm::sqrt((1.0 - t * t).max(0.0))
            };
            let right = at(tilt.clamp(low, high), 1.0)
                .max(at(low, 1.0))
                .max(at(high, 1.0));
            let left = at((-tilt).clamp(low, high), -1.0)
                .min(at(low, -1.0))
                .min(at(high, -1.0));
            let y = centre.y + upper - 0.5;
            let span = self.pixels(
                DVec2::new(centre.x + left, y),
                DVec2::new(centre.x + right, y),
            );
            let first = span.first[0].max(inside.first[0]);
            for column in first..=span.last[0].min(inside.last[0]) {
                let [column, row] = index([column, row]);
                self.drawn.pixels.set(column, row);
                self.drawn.certain.set(column, row);
                self.drawn.possible.set(column, row);
            }
        }
    }
}

/// Returns the place of a pixel that lies in the picture.
fn index(pixel: [i64; 2]) -> [usize; 2] {
    pixel.map(|place| usize::try_from(place).unwrap_or(0))
}
