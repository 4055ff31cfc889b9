//! The second pass of the distance transform: the lower envelope of the parabolas of a row.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "sides are below 2¹⁶"
)]

use super::columns::NONE;

/// A place whose parabola is the lowest from `from` on.
#[derive(Clone, Copy)]
struct Site {
    column: i64,
    /// Least value of the parabola.
    height: i64,
    owner: u32,
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

/// The parabolas (x − column)² + height that are the lowest in a part of a row, from left to right.
#[derive(Default)]
pub(in crate::morphology) struct Envelope(Vec<Site>);

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
                    self.add(from, column, squared_away(row, here), row);
                }
            }
            self.values(from..to, |column, value, site, row| {
                squared[column] = value as u32;
                nearest[column] = index(width, row, site);
            });
            from = to;
        }
    }

    /// Drops all parabolas.
    pub(in crate::morphology) fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds the parabola of a column, to the right of all others, and drops those that it hides from column `from`
    /// on, where the part of the row begins.
    pub(in crate::morphology) fn add(
        &mut self,
        from: usize,
        column: usize,
        height: i64,
        owner: u32,
    ) {
        let mut site = Site {
            column: column as i64,
            height,
            owner,
            from: from as i64,
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

    /// Passes the columns of the part from right to left, each with the value of the envelope, and with the column
    /// and the owner of the parabola that is the lowest.
    pub(in crate::morphology) fn values(
        &mut self,
        part: std::ops::Range<usize>,
        mut pass: impl FnMut(usize, i64, usize, u32),
    ) {
        let mut column = part.end;
        while let Some(site) = self.0.pop() {
            let from = site.from as usize;
            while column > from {
                column -= 1;
                pass(
                    column,
                    site.at(column as i64),
                    site.column as usize,
                    site.owner,
                );
            }
        }
    }
}

fn squared_away(row: u32, here: u32) -> i64 {
    let away = i64::from(row) - i64::from(here);
    away * away
}

/// Returns the index of a pixel.
fn index(width: usize, row: u32, column: usize) -> u32 {
    row * width as u32 + column as u32
}
