//! The second pass of the distance transform: the lower envelope of the parabolas of a row.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "sides are below 2¹⁶"
)]

use super::columns::NONE;

/// A pixel of the row whose column holds the nearest pixel of the set for pixels from `from` on.
#[derive(Clone, Copy)]
struct Site {
    column: i64,
    /// Squared distance to the set in the column.
    height: i64,
    /// Row of the pixel of the set.
    row: u32,
    from: i64,
}

impl Site {
    fn at(&self, column: i64) -> i64 {
        let across = column - self.column;
        across * across + self.height
    }

    /// Returns the first column that is nearer to a later site.
    fn until(&self, later: &Self) -> i64 {
        let rise = (later.column - self.column) * (later.column + self.column)
            + (later.height - self.height);
        rise.div_euclid(2 * (later.column - self.column)) + 1
    }
}

/// Sites of a part of a row, from left to right.
#[derive(Default)]
pub(super) struct Envelope(Vec<Site>);

impl Envelope {
    /// Replaces the rows of the nearest pixels in each column by the indices of the nearest pixels, and fills in
    /// their squared distances.
    pub(super) fn fill(&mut self, row: usize, squared: &mut [u32], nearest: &mut [u32]) {
        let (width, here) = (nearest.len(), row as u32);
        let mut from = 0;
        while from < width {
            if nearest[from] == here {
                squared[from] = 0;
                nearest[from] = index(width, here, from);
                from += 1;
                continue;
            }
            // A gap ends before the next pixel of the set, which belongs to it as a site.
            let gap = nearest[from..].iter().position(|&row| row == here);
            let to = gap.map_or(width, |gap| from + gap);
            self.0.clear();
            if let Some(first) = from.checked_sub(1) {
                self.add(from, first, 0, here);
            }
            for (column, &row) in (from..=to).zip(&nearest[from..]) {
                if row != NONE {
                    self.add(from, column, row.abs_diff(here), row);
                }
            }
            self.write(from..to, squared, nearest);
            from = to;
        }
    }

    /// Adds the site of the next column of a gap, and drops those that it hides.
    fn add(&mut self, gap: usize, column: usize, away: u32, row: u32) {
        let mut site = Site {
            column: column as i64,
            height: i64::from(away) * i64::from(away),
            row,
            from: gap as i64,
        };
        while let Some(last) = self.0.last() {
            if last.at(last.from) <= site.at(last.from) {
                site.from = last.until(&site);
                break;
            }
            self.0.pop();
        }
        self.0.push(site);
    }

    /// Writes the columns of a gap from right to left.
    fn write(&mut self, gap: std::ops::Range<usize>, squared: &mut [u32], nearest: &mut [u32]) {
        let width = nearest.len();
        let mut column = gap.end;
        while let Some(site) = self.0.pop() {
            let from = site.from as usize;
            let own = index(width, site.row, site.column as usize);
            while column > from {
                column -= 1;
                squared[column] = site.at(column as i64) as u32;
                nearest[column] = own;
            }
        }
    }
}

/// Returns the index of a pixel.
fn index(width: usize, row: u32, column: usize) -> u32 {
    row * width as u32 + column as u32
}
