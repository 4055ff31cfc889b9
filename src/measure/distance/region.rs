//! Covers of outlines, and of the regions that they enclose, by points.

use crate::geometry::{Bounds, DAffine2, DVec2, Point};
use crate::rule::{BaseElement, Piece};
use crate::saturating::{real, whole};

/// Error of a set whose cover takes more points than are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it takes more than {most} points to resolve the set that exactly")]
pub struct TooMany {
    /// Maximum number of points.
    pub most: usize,
}

/// Places that lie within the radius of a visited point.
pub trait Covered<P> {
    /// Returns whether a ball lies in one about a visited point: `false` where that is not known.
    fn has(&self, middle: P, radius: f64) -> bool;

    /// Adds the ball about a visited point.
    fn add(&mut self, middle: P, radius: f64);
}

/// The points of a cover that have been visited so far.
pub struct Region<'a, P: Point = DVec2> {
    visit: &'a mut dyn FnMut(P),
    /// Maximum distance of the set from a point of the cover, and of a point from the set.
    pub(super) radius: f64,
    /// Maximum distance of an added point from the part of the set that it covers.
    pub(super) near: f64,
    most: usize,
    /// Number of points that have been visited.
    visited: usize,
    /// Work done so far: the number of points that were added and of copies that were examined.
    worked: usize,
    covered: Option<Box<dyn Covered<P>>>,
}

/// Maximum work, as a multiple of the maximum number of points.
const WORK_A_POINT: usize = 16;

/// Maximum distance of a point from the part of the set for which it is added, as a multiple of the radius of
/// the cover. The rest of the radius remains for parts that are covered by points nearby.
const NEAR: f64 = 0.5;

/// The squares of a grid that lie within the radius of a visited point.
pub(super) struct CoveredSquares {
    corner: DVec2,
    side: f64,
    columns: usize,
    rows: usize,
    bits: Vec<u64>,
}

impl CoveredSquares {
    /// Side of the squares, as a multiple of the radius.
    const SIDE: f64 = 0.15;

    /// Discs of this many squares across are not looked up; a row of a smaller one fits into two words.
    const WIDEST: usize = 40;

    /// Maximum number of squares: about 120 mebibytes.
    const MOST: f64 = 1e9;

    pub(super) fn new(bounds: &Bounds, radius: f64) -> Option<Self> {
        let side = Self::SIDE * radius;
        let corner = bounds.min() - radius;
        let counts = ((bounds.size() + 2.0 * radius) / side).ceil() + 1.0;
        let count = counts.x * counts.y;
        if count.is_nan() || count > Self::MOST {
            return None;
        }
        let [columns, rows] = counts.to_array().map(whole);
        Some(Self {
            corner,
            side,
            columns,
            rows,
            // A row that ends in the last word is read with the next one.
            bits: vec![0; (columns * rows).div_ceil(64) + 1],
        })
    }

    /// Returns the index of the word that holds a square, and that of its bit.
    fn place(&self, row: usize, column: usize) -> (usize, usize) {
        let square = row * self.columns + column;
        (square / 64, square % 64)
    }

    fn two(&self, word: usize) -> u128 {
        u128::from(self.bits[word]) | u128::from(self.bits[word + 1]) << 64
    }
}

impl Covered<DVec2> for CoveredSquares {
    /// Returns `true` if all squares in the bounding box of a disc are covered; `false` for discs of too many
    /// squares.
    fn has(&self, middle: DVec2, radius: f64) -> bool {
        let middle = (middle - self.corner) / self.side;
        let radius = radius / self.side;
        let [low, high] = [middle - radius, middle + radius];
        let (left, right) = (within(low.x, self.columns), within(high.x, self.columns));
        let (bottom, top) = (within(low.y, self.rows), within(high.y, self.rows));
        if right - left >= Self::WIDEST || top - bottom >= Self::WIDEST {
            return false;
        }
        let mask = (1 << (right - left + 1)) - 1;
        (bottom..=top).all(|row| {
            let (word, shift) = self.place(row, left);
            self.two(word) >> shift & mask == mask
        })
    }

    /// Covers the squares that lie in a disc.
    fn add(&mut self, middle: DVec2, radius: f64) {
        let middle = (middle - self.corner) / self.side;
        let radius = radius / self.side;
        let (bottom, top) = (
            within(middle.y - radius, self.rows),
            within(middle.y + radius, self.rows),
        );
        for row in bottom..=top {
            let below = real(row) - middle.y;
            let away = below.abs().max((below + 1.0).abs());
            let half = (radius * radius - away * away).sqrt();
            let (left, right) = ((middle.x - half).ceil(), (middle.x + half).floor());
            // The half is NaN for a row that lies partly outside the disc.
            if right - left >= 1.0 {
                let left = within(left, self.columns);
                let count = within(right, self.columns) - left;
                let (word, shift) = self.place(row, left);
                let mask: u128 = ((1 << count) - 1) << shift;
                #[expect(clippy::cast_possible_truncation, reason = "two halves of a word")]
                let halves = [mask as u64, (mask >> 64) as u64];
                self.bits[word] |= halves[0];
                self.bits[word + 1] |= halves[1];
            }
        }
    }
}

/// Returns the index, below `count`, of the row or column that a coordinate lies in; the nearest one for
/// coordinates outside.
fn within(coordinate: f64, count: usize) -> usize {
    whole(coordinate).min(count - 1)
}

/// Returns the radius of the smallest disc about a point that holds the control points of an outline, and
/// with them the outline.
pub(super) fn radius_of(outline: &BaseElement, middle: DVec2) -> f64 {
    let points = outline.control_points();
    points
        .map(|point| (point - middle).length())
        .fold(0.0, f64::max)
}

impl<'a, P: Point> Region<'a, P> {
    /// Creates an empty cover of a set. In the end, no point of the set may be farther than `radius` from a visited
    /// point, and no visited point farther than that from the set. `covered` remembers places that are covered.
    pub(super) fn new(
        covered: Option<Box<dyn Covered<P>>>,
        radius: f64,
        most: usize,
        visit: &'a mut dyn FnMut(P),
    ) -> Self {
        Self {
            visit,
            visited: 0,
            radius,
            near: NEAR * radius,
            most,
            worked: 0,
            covered,
        }
    }

    /// Creates an empty cover in which every point is visited, including points near others.
    pub(super) fn of_all(radius: f64, most: usize, visit: &'a mut dyn FnMut(P)) -> Self {
        Self {
            visit,
            visited: 0,
            radius,
            near: radius,
            most,
            worked: 0,
            covered: None,
        }
    }

    /// Adds a point that covers a part of the set within the distance [`near`](Self::near).
    pub(super) fn add(&mut self, point: P) -> Result<(), TooMany> {
        self.add_within(point, self.near)
    }

    /// Adds a point that covers a part of the set within `near`, which is less than the radius.
    pub(super) fn add_within(&mut self, point: P, near: f64) -> Result<(), TooMany> {
        if !self.covers(point, near) {
            self.visited += 1;
            if self.visited > self.most {
                return Err(TooMany { most: self.most });
            }
            (self.visit)(point);
            if let Some(covered) = &mut self.covered {
                covered.add(point, self.radius);
            }
        }
        self.work(1)
    }

    /// Returns `true` if a disc is covered already: where copies overlap, few have to be examined.
    pub(super) fn covers(&self, middle: P, radius: f64) -> bool {
        let covered = self.covered.as_ref();
        covered.is_some_and(|covered| covered.has(middle, radius))
    }

    /// Returns the number of points that have been visited.
    pub(super) fn visited(&self) -> usize {
        self.visited
    }

    pub(super) fn work(&mut self, work: usize) -> Result<(), TooMany> {
        self.worked += work;
        if self.worked > WORK_A_POINT * self.most {
            return Err(TooMany { most: self.most });
        }
        Ok(())
    }
}

impl Region<'_> {
    /// Adds the image of an outline, and the enclosed region if it is closed.
    pub(super) fn add_outline(
        &mut self,
        outline: &BaseElement,
        map: &DAffine2,
    ) -> Result<(), TooMany> {
        // The inside is covered only up to half the distance from the outline, which must be covered to the
        // other half.
        let radius = if outline.is_closed() {
            self.near / 2.0
        } else {
            self.near
        };
        let mut from = map.transform_point2(outline.start());
        let mut corners = vec![from];
        for piece in outline.pieces() {
            let piece = piece.transformed(map);
            match piece {
                Piece::Line(end) => self.add_line(from, end, radius)?,
                Piece::Cubic(a, b, end) => {
                    self.add_curve([from, a, b, end], radius, &mut corners)?;
                }
            }
            from = piece.end();
            corners.push(from);
        }
        if outline.is_closed() {
            self.add_inside(&corners)?;
        }
        Ok(())
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of parts, which saturates"
    )]
    fn add_line(&mut self, from: DVec2, to: DVec2, radius: f64) -> Result<(), TooMany> {
        let length = (to - from).length();
        let parts = (length / (2.0 * radius)).ceil().max(1.0);
        for part in 0..parts as u64 {
            #[expect(
                clippy::cast_precision_loss,
                reason = "there are fewer parts than that"
            )]
            let at = (part as f64 + 0.5) / parts;
            self.add(from.lerp(to, at))?;
        }
        Ok(())
    }

    /// Adds points of a cubic Bézier curve, in their order along it. The curve is halved (de Casteljau) until
    /// a disc about its midpoint holds all control points, and with them the curve.
    fn add_curve(
        &mut self,
        curve: [DVec2; 4],
        radius: f64,
        corners: &mut Vec<DVec2>,
    ) -> Result<(), TooMany> {
        let mut open = vec![curve];
        while let Some([a, b, c, d]) = open.pop() {
            let (ab, bc, cd) = (a.midpoint(b), b.midpoint(c), c.midpoint(d));
            let (abc, bcd) = (ab.midpoint(bc), bc.midpoint(cd));
            let middle = abc.midpoint(bcd);
            let away = [a, b, c, d].map(|point| (point - middle).length());
            if away.into_iter().fold(0.0, f64::max) <= radius {
                corners.push(middle);
                self.add(middle)?;
            } else {
                open.push([middle, bcd, cd, d]);
                open.push([a, ab, abc, middle]);
            }
        }
        Ok(())
    }

    /// Adds the points of a grid that lie in a polygon, by the nonzero rule. Every place in the polygon is
    /// within half of [`near`](Self::near) of a point of the grid or of the outline.
    fn add_inside(&mut self, corners: &[DVec2]) -> Result<(), TooMany> {
        let step = self.near * std::f64::consts::FRAC_1_SQRT_2;
        let mut bounds = Bounds::EMPTY;
        corners.iter().for_each(|&corner| bounds.add(corner));
        let (min, max) = (bounds.min(), bounds.max());
        let mut crossings: Vec<(f64, i32)> = Vec::new();
        let mut y = min.y + step / 2.0;
        while y < max.y {
            crossings.clear();
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            for (&from, &to) in sides {
                if (from.y <= y) != (to.y <= y) {
                    let x = from.x + (to.x - from.x) * ((y - from.y) / (to.y - from.y));
                    crossings.push((x, if to.y > from.y { 1 } else { -1 }));
                }
            }
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut turns = 0;
            for pair in crossings.windows(2) {
                turns += pair[0].1;
                if turns == 0 {
                    continue;
                }
                // The first point of the grid that is not left of the crossing.
                let mut x = min.x + ((pair[0].0 - min.x) / step).ceil() * step;
                while x <= pair[1].0 {
                    self.add(DVec2::new(x, y))?;
                    x += step;
                }
            }
            y += step;
            self.work(corners.len())?;
        }
        Ok(())
    }
}
