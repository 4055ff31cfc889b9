//! Hits: how many elements cover every pixel.
//!
//! An element covers a pixel by the area of the pixel that lies in it: a filled shape by its own area, a line by that of each of
//! its edges. Areas are exact up to rounding, and their sums do not depend on the order of elements.

use std::io;

use tiny_skia::Pixmap;

use crate::geometry::DVec2;
use crate::parallel::Team;

use super::density::{Density, UNIT, painted};
use super::drawing::Drawing;
use super::error::RenderError;
use super::paint::{FINE, Paint, Position};
use super::png::{TooManyPixels, flattened};
use super::surface::Surface;

/// Limit of the number of pixels.
const MAX_PIXELS: usize = 1 << 28;

/// Limit of the coordinates of shapes, in pixels: farther ones are moved there.
const FAR: f64 = 1e7;

/// Window in which is drawn, in pixels of the picture.
#[derive(Clone, Copy)]
struct HitWindow {
    origin: [i64; 2],
    low: [i64; 2],
    high: [i64; 2],
}

/// Surface that counts hits.
struct Hits {
    size: [u32; 2],
    /// Hits of the pixels, in 1/[`UNIT`], in rows.
    counts: Vec<u32>,
    window: HitWindow,
    outer: Vec<HitWindow>,
    /// Whether the current path is filled; otherwise, half of the width of its line in pixels.
    is_filled: bool,
    half: f64,
    /// Vertices of the current subpath.
    contour: Vec<Position>,
    area: AreaBuffer,
}

/// Draws the hits of a drawing in the tones of a density.
pub(super) fn pixmap<'w>(
    drawing: &'w impl Drawing,
    density: &Density,
    team: &Team<'w>,
) -> Result<Pixmap, RenderError> {
    let size @ [width, height] = drawing.size();
    let count = width as usize * height as usize;
    if count > MAX_PIXELS {
        return Err(TooManyPixels { size }.into());
    }
    let mut pixmap = Pixmap::new(width, height).ok_or(TooManyPixels { size })?;
    let mut hits = Hits {
        size,
        counts: vec![0; count],
        window: HitWindow {
            origin: [0; 2],
            low: [0; 2],
            high: size.map(i64::from),
        },
        outer: Vec::new(),
        is_filled: false,
        half: 0.0,
        contour: Vec::new(),
        area: AreaBuffer::default(),
    };
    drawing.draw(&mut hits, team)?;
    painted(&mut pixmap, density, &hits.counts);
    Ok(pixmap)
}

impl Hits {
    /// Counts the current subpath.
    fn finish(&mut self, is_closed: bool) {
        let contour = std::mem::take(&mut self.contour);
        #[expect(
            clippy::cast_precision_loss,
            reason = "positions on a picture are exact"
        )]
        let place = |position: &Position| {
            let place = DVec2::new(position[0] as f64, position[1] as f64) / FINE;
            let origin = DVec2::new(self.window.origin[0] as f64, self.window.origin[1] as f64);
            (place + origin).clamp(DVec2::splat(-FAR), DVec2::splat(FAR))
        };
        let vertices: Vec<_> = contour.iter().map(place).collect();
        if self.is_filled {
            self.polygon(&vertices);
        } else {
            vertices
                .windows(2)
                .for_each(|edge| self.line(edge[0], edge[1]));
            if let (true, [from, .., to]) = (is_closed, &vertices[..]) {
                self.line(*to, *from);
            }
        }
        self.contour = contour;
        self.contour.clear();
    }

    /// Counts a line without caps; a line without length is a square.
    fn line(&mut self, from: DVec2, to: DVec2) {
        let along = (to - from).try_normalize();
        let across = self.half * along.unwrap_or(DVec2::X).perp();
        let cap = match along {
            Some(_) => DVec2::ZERO,
            None => self.half * DVec2::X,
        };
        self.polygon(&[
            from - cap - across,
            to + cap - across,
            to + cap + across,
            from - cap + across,
        ]);
    }

    /// Counts a polygon.
    fn polygon(&mut self, vertices: &[DVec2]) {
        let width = self.size[0] as usize;
        let (counts, HitWindow { low, high, .. }) = (&mut self.counts, self.window);
        self.area.cover(vertices, low, high, |x, y, share| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a share of the unit"
            )]
            let hits = (share * f64::from(UNIT)).round() as u32;
            let count = &mut counts[y * width + x];
            *count = count.saturating_add(hits);
        });
    }
}

impl Surface for Hits {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        self.is_filled = paint.fill.is_some();
        self.half = paint.stroke.map_or(0.0, |stroke| stroke.pen.width / 2.0);
        Ok(())
    }

    fn move_to(&mut self, to: Position) {
        self.finish(false);
        self.contour.push(to);
    }

    fn line_to(&mut self, to: Position) {
        self.contour.push(to);
    }

    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        let from = self.contour.last().copied().unwrap_or(a);
        self.contour.extend(flattened([from, a, b, to]));
    }

    fn close(&mut self) {
        self.finish(true);
    }

    fn hand_on(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        self.finish(false);
        Ok(())
    }

    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool> {
        let (corner, size) = (corner.map(i64::from), size.map(i64::from));
        let before = self.window;
        let origin = [0, 1].map(|axis| before.origin[axis] + corner[axis]);
        self.outer.push(before);
        self.window = HitWindow {
            origin,
            low: [0, 1].map(|axis| before.low[axis].max(origin[axis])),
            high: [0, 1].map(|axis| before.high[axis].min(origin[axis] + size[axis])),
        };
        Ok(true)
    }

    fn leave(&mut self) -> io::Result<()> {
        self.window = self.outer.pop().unwrap_or(self.window);
        Ok(())
    }
}

/// Accumulator of the signed area of a polygon in the pixels of its bounding box: each edge adds the area between itself and the
/// right side of the box.
#[derive(Default)]
struct AreaBuffer {
    /// Differences of the area from that of the pixel to the left, in rows.
    cells: Vec<f64>,
}

impl AreaBuffer {
    /// Calls `hit` with the column and the row of every pixel between two corners that a polygon covers, and the covered share,
    /// under the nonzero rule but for pixels in which parts of different winding numbers meet.
    fn cover(
        &mut self,
        vertices: &[DVec2],
        low: [i64; 2],
        high: [i64; 2],
        mut hit: impl FnMut(usize, usize, f64),
    ) {
        let least = vertices.iter().fold(DVec2::INFINITY, |a, b| a.min(*b));
        let most = vertices.iter().fold(DVec2::NEG_INFINITY, |a, b| a.max(*b));
        #[expect(
            clippy::cast_possible_truncation,
            reason = "vertices are within limits"
        )]
        let range = |axis: usize| {
            let [first, last] = [least[axis].floor() as i64, most[axis].ceil() as i64];
            (
                first.clamp(low[axis], high[axis]),
                last.clamp(low[axis], high[axis]),
            )
        };
        let ((left, right), (top, bottom)) = (range(0), range(1));
        let [columns, rows] =
            [right - left, bottom - top].map(|it| usize::try_from(it).unwrap_or(0));
        if columns == 0 || rows == 0 {
            return;
        }
        // One more column takes what lies to the right.
        let stride = columns + 1;
        self.cells.clear();
        self.cells.resize(stride * rows, 0.0);
        #[expect(clippy::cast_precision_loss, reason = "a picture is small")]
        let corner = DVec2::new(left as f64, top as f64);
        let next = vertices.iter().cycle().skip(1);
        for (from, to) in vertices.iter().zip(next) {
            self.edge([*from - corner, *to - corner], stride, rows);
        }
        let [left, top] = [left, top].map(|it| usize::try_from(it).unwrap_or(0));
        for (y, row) in self.cells.chunks_exact(stride).enumerate() {
            let mut sum = 0.0;
            for (x, cell) in row[..columns].iter().enumerate() {
                sum += cell;
                let share = f64::min(f64::abs(sum), 1.0);
                if share > 0.0 {
                    hit(left + x, top + y, share);
                }
            }
        }
    }

    /// Adds an edge. Parts beside the box are moved to its sides.
    fn edge(&mut self, [from, to]: [DVec2; 2], stride: usize, rows: usize) {
        #[expect(clippy::cast_precision_loss, reason = "a picture is small")]
        let last = (stride - 1) as f64;
        let way = to - from;
        let mut cuts = [0.0, last].map(|side| ((side - from.x) / way.x).clamp(0.0, 1.0));
        if cuts[0] > cuts[1] {
            cuts.reverse();
        }
        let place = |share: f64| {
            let place = if share < 1.0 { from + way * share } else { to };
            DVec2::new(place.x.clamp(0.0, last), place.y)
        };
        let ends = match cuts.iter().all(|cut| cut.is_finite()) {
            true => [0.0, cuts[0], cuts[1], 1.0],
            false => [0.0, 0.0, 1.0, 1.0],
        };
        for part in ends.windows(2).filter(|part| part[0] < part[1]) {
            self.part([place(part[0]), place(part[1])], stride, rows);
        }
    }

    /// Adds a part of an edge between the sides of the box.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "within the bounding box"
    )]
    fn part(&mut self, [from, to]: [DVec2; 2], stride: usize, rows: usize) {
        let sign = if from.y < to.y { 1.0 } else { -1.0 };
        let (upper, lower) = if from.y < to.y {
            (from, to)
        } else {
            (to, from)
        };
        let slope = (lower.x - upper.x) / (lower.y - upper.y);
        let last = stride - 1;
        let (first, end) = (upper.y.max(0.0), lower.y.min(rows as f64));
        if first >= end {
            return;
        }
        for row in first as usize..(end.ceil() as usize).min(rows) {
            let y = [first.max(row as f64), end.min(row as f64 + 1.0)];
            let height = y[1] - y[0];
            if height <= 0.0 {
                continue;
            }
            let [least, most] = [from.x.min(to.x), from.x.max(to.x)];
            let x = y.map(|y| (upper.x + (y - upper.y) * slope).clamp(least, most));
            let [near, far] = [x[0].min(x[1]), x[0].max(x[1])];
            let cells = &mut self.cells[row * stride..(row + 1) * stride];
            let signed = sign * height;
            let begin = (near as usize).min(last);
            if far <= begin as f64 + 1.0 {
                // In one pixel: the area to the right of the edge.
                let share = 1.0 - ((near + far) / 2.0 - begin as f64);
                cells[begin] += signed * share;
                cells[(begin + 1).min(last)] += signed * (1.0 - share);
                continue;
            }
            let finish = (far.ceil() as usize).min(last);
            // Area to the right of the edge within the columns up to each border.
            let right_of = |border: f64| {
                let within = (border - near).clamp(0.0, far - near);
                let beyond = (border - far).max(0.0);
                signed * (within * within / (2.0 * (far - near)) + beyond)
            };
            let mut before = 0.0;
            let mut sum = 0.0;
            for (column, cell) in cells.iter_mut().enumerate().take(finish + 1).skip(begin) {
                let area = right_of(column as f64 + 1.0);
                // Of this column alone, less what the columns before add.
                let own = area - sum;
                *cell += own - before;
                (before, sum) = (own, area);
            }
            if let Some(cell) = cells.get_mut(finish + 1) {
                *cell += signed - before;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(vertices: &[[f64; 2]], size: usize) -> Vec<f64> {
        let vertices: Vec<_> = vertices.iter().map(|it| DVec2::from_array(*it)).collect();
        let mut shares = vec![0.0; size * size];
        let high = [i64::try_from(size).unwrap(); 2];
        let mut area = AreaBuffer::default();
        // Twice, for the memory is kept.
        for _ in 0..2 {
            shares.fill(0.0);
            area.cover(&vertices, [0; 2], high, |x, y, share| {
                shares[y * size + x] += share
            });
        }
        shares
    }

    #[test]
    fn polygons_cover_their_areas() {
        let cases: [(&[[f64; 2]], f64); 5] = [
            (&[[1.25, 1.5], [3.75, 1.5], [3.75, 4.0], [1.25, 4.0]], 6.25),
            (&[[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]], 32.0),
            (&[[0.5, 7.5], [7.3, 3.1], [2.9, 0.2]], 0.0),
            // Parts outside do not count.
            (&[[-3.0, 2.0], [20.0, 2.0], [20.0, 3.5], [-3.0, 3.5]], 12.0),
            (&[[2.0, -9.0], [3.0, -9.0], [3.0, 9.0], [2.0, 9.0]], 8.0),
        ];
        for (vertices, expected) in cases {
            let next = vertices.iter().cycle().skip(1);
            let doubled = vertices
                .iter()
                .zip(next)
                .map(|(a, b)| a[0] * b[1] - b[0] * a[1]);
            let expected = match expected {
                0.0 => doubled.sum::<f64>().abs() / 2.0,
                known => known,
            };
            for reversed in [false, true] {
                let mut vertices = vertices.to_vec();
                if reversed {
                    vertices.reverse();
                }
                let shares = covered(&vertices, 8);
                let sum: f64 = shares.iter().sum();
                assert!(
                    (sum - expected).abs() < 1e-9,
                    "{vertices:?}: {sum} of {expected}"
                );
                assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)));
            }
        }
    }

    /// Each pixel is compared with samples.
    #[test]
    fn every_pixel_has_its_share() {
        let triangle = [[0.7, 6.9], [7.6, 4.4], [1.3, 0.6]];
        let shares = covered(&triangle, 8);
        for (at, share) in shares.iter().enumerate() {
            let inside = |&(i, j): &(u32, u32)| {
                #[expect(clippy::cast_precision_loss, reason = "small numbers")]
                let corner = [(at % 8) as f64, (at / 8) as f64];
                let point = [
                    corner[0] + (f64::from(i) + 0.5) / 64.0,
                    corner[1] + (f64::from(j) + 0.5) / 64.0,
                ];
                (0..3).all(|side| {
                    let (a, b) = (triangle[side], triangle[(side + 1) % 3]);
                    (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) <= 0.0
                })
            };
            let samples = (0..64).flat_map(|i| (0..64).map(move |j| (i, j)));
            let count = u32::try_from(samples.filter(inside).count()).unwrap();
            let expected = f64::from(count) / 4096.0;
            assert!((share - expected).abs() < 0.02, "{at}: {share}, {expected}");
        }
    }
}
