//! The power diagram of disks about pixels: the reverse of the distance transform (Coeurjolly & Montanvert 2007).

use super::distance::Envelope;

/// Number of columns that are transformed together.
const BLOCK: usize = 64;

/// For every pixel, the disk with the least power: the squared distance from its centre less its squared radius.
pub(super) struct Power {
    width: usize,
    /// The disk of each pixel that a disk covers.
    disks: Vec<Option<u32>>,
}

impl Power {
    /// Computes the diagram of disks about pixels with squared radii, row by row; a radius of 0 is no disk.
    #[expect(clippy::cast_possible_truncation, reason = "indices have 32 bits")]
    pub(super) fn of(squared: &[u32], width: usize) -> Self {
        let height = squared.len() / width;
        let mut lowest = vec![(0i64, NONE); squared.len()];
        let mut envelope = Envelope::default();
        for first in (0..width).step_by(BLOCK) {
            for column in first..(first + BLOCK).min(width) {
                envelope.clear();
                for row in 0..height {
                    let weight = squared[row * width + column];
                    if weight > 0 {
                        envelope.add(0, row, -i64::from(weight), row as u32);
                    }
                }
                envelope.values(0..height, |row, value, _, owner| {
                    lowest[row * width + column] = (value, owner);
                });
            }
        }
        let mut disks = vec![None; squared.len()];
        let rows = lowest.chunks_exact(width);
        for (lowest, disks) in rows.zip(disks.chunks_exact_mut(width)) {
            envelope.clear();
            for (column, &(value, owner)) in lowest.iter().enumerate() {
                if owner != NONE {
                    envelope.add(0, column, value, owner);
                }
            }
            envelope.values(0..width, |column, value, site, owner| {
                if value < 0 {
                    disks[column] = Some(owner * width as u32 + site as u32);
                }
            });
        }
        Self { width, disks }
    }

    /// Returns `true` if a disk covers a pixel.
    pub(super) fn is_covered(&self, column: usize, row: usize) -> bool {
        self.disks[row * self.width + column].is_some()
    }

    /// Returns, for every pixel, whether its disk has the least power about some pixel that it covers.
    pub(super) fn owners(&self) -> Vec<bool> {
        let mut owners = vec![false; self.disks.len()];
        for &disk in self.disks.iter().flatten() {
            owners[disk as usize] = true;
        }
        owners
    }
}

/// Mark of a column without disks.
const NONE: u32 = u32::MAX;
