//! Sprites: coverage that is drawn once and put in many places.

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

use super::{CoverageBuffer, MARGIN, Position, RoundPen, bounding, cover, flattened, index};

/// Coverage of some pixels, drawn once and put in many places.
#[derive(Debug)]
pub(crate) struct Sprite {
    /// Coverage of areas.
    pub(crate) areas: Print,
    /// Coverage of lines and outlines, which may lie on top in another colour.
    pub(crate) strokes: Print,
}

impl Sprite {
    /// Returns its size in memory, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        let cells = [&self.areas, &self.strokes].map(|print| size_of_val(&*print.cells));
        size_of::<Self>() + cells[0] + cells[1]
    }
}

/// Coverage of a rectangle of pixels by one coverage buffer.
#[derive(Debug, Default)]
pub(crate) struct Print {
    /// Upper left pixel, relative to the pixel on which the print is put.
    corner: [i64; 2],
    /// Number of pixels per row.
    width: usize,
    /// Covered samples of each pixel as bits, row by row.
    cells: Box<[u64]>,
}

/// Means by which sprites are drawn: shapes are filled, and lines are drawn with the pen.
#[derive(Clone, Default)]
pub(crate) struct SpritePaint {
    /// Pen of lines and outlines.
    pub(crate) pen: Option<Arc<RoundPen>>,
    /// Whether shapes are outlined.
    pub(crate) outlines: bool,
}

/// Small coverage buffers on which a sprite is drawn.
pub(crate) struct SpriteSheet {
    /// Buffer of areas.
    areas: CoverageBuffer,
    /// Buffer of strokes, if there is a pen.
    strokes: Option<CoverageBuffer>,
    pub(crate) paint: SpritePaint,
    /// Whether everything could be drawn so far.
    is_whole: bool,
}

impl SpriteSheet {
    /// Creates an empty sheet of a size in pixels.
    pub(crate) fn new(size: [u32; 2], paint: SpritePaint) -> Self {
        let plane = || CoverageBuffer::of_rows(size, 0..size[1]);
        Self {
            areas: plane(),
            strokes: paint.pen.is_some().then(plane),
            paint,
            is_whole: true,
        }
    }

    /// Covers the area of a closed outline.
    pub(crate) fn polygon(&mut self, vertices: &[Position]) {
        self.is_whole &= self.areas.shape(vertices);
    }

    /// Covers a line through points.
    pub(crate) fn line(&mut self, points: &[Position]) {
        let (Some(pen), Some(plane)) = (&self.paint.pen, &mut self.strokes) else {
            self.is_whole = false;
            return;
        };
        let Some((&start, rest)) = points.split_first() else {
            return;
        };
        plane.dot(pen, start);
        let mut from = start;
        for &to in rest {
            plane.line(pen, from, to);
            from = to;
        }
    }

    /// Covers the outline of a polygon.
    pub(crate) fn outline(&mut self, vertices: &[Position]) {
        self.line(vertices);
        if let (Some(&start), Some(&end)) = (vertices.first(), vertices.last())
            && start != end
        {
            self.line(&[end, start]);
        }
    }

    /// Adds the points of a curve except the first to those of a line, or of the boundary of an area.
    pub(crate) fn add_curve(points: &mut Vec<Position>, curve: [Position; 4], encircles: bool) {
        if encircles {
            points.extend(bounding(curve));
        } else {
            points.extend(flattened(curve));
        }
    }

    /// Returns the sprite, if everything could be drawn. `pixel` is the pixel of the sheet that is put on the
    /// pixel of the picture.
    pub(crate) fn into_sprite(self, pixel: [i64; 2]) -> Option<Sprite> {
        let strokes = self.strokes.map(|plane| Print::of(plane, pixel));
        self.is_whole.then(|| Sprite {
            areas: Print::of(self.areas, pixel),
            strokes: strokes.unwrap_or_default(),
        })
    }
}

impl Print {
    /// Creates the print of a buffer whose pixel `pixel` is its origin.
    fn of(plane: CoverageBuffer, pixel: [i64; 2]) -> Self {
        let [rows, columns] = plane.cells_in(plane.touched);
        let stride = plane.stride;
        let first = |number: usize| i64::try_from(number).unwrap_or(i64::MAX);
        let cells = rows.clone().flat_map(|row| {
            let start = row * stride;
            &plane.cells[start + columns.start..start + columns.end]
        });
        Self {
            cells: cells.map(|cell| cell.load(Relaxed)).collect(),
            width: columns.len(),
            corner: [
                first(columns.start) - MARGIN - pixel[0],
                first(rows.start) - MARGIN - pixel[1],
            ],
        }
    }
}

impl CoverageBuffer {
    /// Covers the samples of a print whose origin is put on a pixel.
    pub(crate) fn sprite(&mut self, sprite: &Print, pixel: [i64; 2]) {
        let Print { corner, width, .. } = *sprite;
        if width == 0 {
            return;
        }
        let [left, top] = [0, 1].map(|axis| pixel[axis] + corner[axis]);
        let side = |count: usize| i64::try_from(count).unwrap_or(i64::MAX);
        let height = sprite.cells.len() / width;
        // Position in cells of the buffer.
        let (x, y) = (left + MARGIN, top - self.top + MARGIN);
        let within = |from: i64, count: usize, most: i64| {
            let first = (-from).clamp(0, side(count));
            let last = (most - from).clamp(first, side(count));
            index(first)..index(last)
        };
        let columns = within(x, width, self.size[0] + 2 * MARGIN);
        let rows = within(y, height, self.size[1] + 2 * MARGIN);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        for row in rows {
            let start = index(y + side(row)) * self.stride + index(x + side(columns.start));
            let cells = &self.cells[start..start + columns.len()];
            let placed = &sprite.cells[row * width..][columns.clone()];
            for (cell, &samples) in cells.iter().zip(placed) {
                cover(cell, samples);
            }
        }
        self.touched.add(
            [left, left + side(width) - 1],
            [top, top + side(height) - 1],
        );
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::FINE;
    use super::{CoverageBuffer, RoundPen, SpritePaint, SpriteSheet};

    #[test]
    fn a_sprite_covers_what_was_drawn_wherever_it_is_put() {
        let pen = Arc::new(RoundPen::new(1.0));
        let paint = SpritePaint {
            pen: Some(Arc::clone(&pen)),
            outlines: true,
        };
        let square = [[310, 290], [370, 300], [360, 360], [300, 350]];
        let line = [[120, 150], [310, 480], [150, 600]];
        for pixel in [[3, 4], [0, 0], [-3, 2], [9, 9], [40, 4], [-20, -20]] {
            let mut sheet = SpriteSheet::new([8, 8], paint.clone());
            sheet.polygon(&square);
            sheet.line(&line);
            sheet.outline(&square);
            let sprite = sheet.into_sprite([2, 2]).unwrap();
            let mut placed = [CoverageBuffer::new([12, 12]), CoverageBuffer::new([12, 12])];
            placed[0].sprite(&sprite.areas, pixel);
            placed[1].sprite(&sprite.strokes, pixel);
            let moved = |point: [i64; 2]| [0, 1].map(|a| point[a] + (pixel[a] - 2) * FINE);
            let mut drawn = [CoverageBuffer::new([12, 12]), CoverageBuffer::new([12, 12])];
            let [square, line] = [square.map(moved).to_vec(), line.map(moved).to_vec()];
            drawn[0].shape(&square);
            let ring = [&square[..], &square[..1]].concat();
            for line in [line, ring] {
                drawn[1].dot(&pen, line[0]);
                for ends in line.windows(2) {
                    drawn[1].line(&pen, ends[0], ends[1]);
                }
            }
            assert_eq!(
                placed.each_mut().map(CoverageBuffer::drained),
                drawn.each_mut().map(CoverageBuffer::drained),
                "{pixel:?}"
            );
        }
    }

    #[test]
    fn what_cannot_be_drawn_makes_no_sprite() {
        let mut sheet = SpriteSheet::new([8, 8], SpritePaint::default());
        sheet.polygon(&[[100, 100], [50_000, 100], [300, 20_000], [400, 60_000]]);
        assert!(sheet.into_sprite([0, 0]).is_none());
        let mut sheet = SpriteSheet::new([8, 8], SpritePaint::default());
        sheet.line(&[[100, 100], [500, 100]]);
        assert!(sheet.into_sprite([0, 0]).is_none());
    }
}
