//! The morphological skeleton: centres of maximal disks, by their sizes, from which a picture is reconstructed.

use std::num::NonZero;

use crate::bits::Bits;

use super::disk::DiskFamily;
use super::distance::NoDistances;
use super::interior::Interior;
use super::power::Power;
use super::shifts::Both;

/// A centre of a maximal disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaximalDisk {
    /// Column of the centre.
    pub column: u32,
    /// Row of the centre.
    pub row: u32,
    /// Size of the disk: r of r D, or for [`DiskFamily::Euclid`] the squared distance to the nearest pixel outside. The
    /// Euclidean disk has the pixels that are nearer than this.
    pub size: u32,
}

/// The skeleton subsets S_r of a picture (Lantuéjoul's formula; Libeskind-Hadas & Maragos 1987): the centres of the
/// disks in the picture that no larger disk of the family in the picture contains.
///
/// The union of the disks is the picture. The skeleton may be disconnected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SkeletonSubsets {
    width: usize,
    height: usize,
    disk: DiskFamily,
    disks: Vec<MaximalDisk>,
}

impl SkeletonSubsets {
    /// Computes the skeleton subsets of a picture.
    ///
    /// For discrete disks, S_r = (A ⊖ r D) − (A ⊖ r D) ∘ D by n + 1 erosions, where n is the largest size. For
    /// Euclidean ones, a pixel belongs to the skeleton if its disk is the deepest, by the power distance, about some
    /// pixel of the picture (the reduced discrete medial axis of Coeurjolly & Montanvert 2007): centres of maximal
    /// disks, without those that the others make unnecessary.
    ///
    /// # Errors
    ///
    /// Returns an error if the picture is empty, or too large for Euclidean distances.
    pub fn of(bits: &Bits, disk: DiskFamily, threads: NonZero<usize>) -> Result<Self, NoDistances> {
        let disks = match disk {
            _ if bits.is_empty() => return Err(NoDistances::Empty),
            DiskFamily::Euclid => euclidean(&Interior::of(bits, threads)?),
            _ => discrete(bits, disk),
        };
        Ok(Self {
            width: bits.width(),
            height: bits.height(),
            disk,
            disks,
        })
    }

    /// Returns the family of the disks.
    #[must_use]
    pub fn disk(&self) -> DiskFamily {
        self.disk
    }

    /// Returns all maximal disks, from the smallest, and of one size row by row.
    #[must_use]
    pub fn disks(&self) -> &[MaximalDisk] {
        &self.disks
    }

    /// Iterates over the subsets that are not empty, from the smallest size, each with its disks.
    pub fn subsets(&self) -> impl Iterator<Item = &[MaximalDisk]> {
        self.disks.chunk_by(|one, other| one.size == other.size)
    }

    /// Returns the skeleton function of a maximal disk: its radius in pixels, or r for a discrete one.
    #[must_use]
    pub fn radius(&self, disk: &MaximalDisk) -> f64 {
        match self.disk {
            DiskFamily::Euclid => f64::from(disk.size).sqrt(),
            _ => f64::from(disk.size),
        }
    }

    /// Returns the centres of all maximal disks.
    #[must_use]
    pub fn centres(&self) -> Bits {
        let mut bits = Bits::new(self.width, self.height);
        for disk in &self.disks {
            bits.set(disk.column as usize, disk.row as usize);
        }
        bits
    }

    /// Returns the union of all disks: the picture.
    #[must_use]
    pub fn reconstruction(&self) -> Bits {
        let mut bits = Bits::new(self.width, self.height);
        if self.disk == DiskFamily::Euclid {
            let mut weights = vec![0; self.width * self.height];
            for disk in &self.disks {
                weights[disk.row as usize * self.width + disk.column as usize] = disk.size;
            }
            let power = Power::of(&weights, self.width);
            return Bits::of(self.width, self.height, |column, row| {
                power.is_covered(column, row)
            });
        }
        let mut spare = bits.clone();
        let mut size = self.disks.last().map_or(0, |disk| disk.size);
        for subset in self
            .disks
            .chunk_by(|one, other| one.size == other.size)
            .rev()
        {
            for _ in subset[0].size..size {
                self.disk.once(Both::Dilation, &mut bits, &mut spare);
            }
            size = subset[0].size;
            for disk in subset {
                bits.set(disk.column as usize, disk.row as usize);
            }
        }
        for _ in 0..size {
            self.disk.once(Both::Dilation, &mut bits, &mut spare);
        }
        bits
    }
}

fn discrete(bits: &Bits, disk: DiskFamily) -> Vec<MaximalDisk> {
    let mut disks = Vec::new();
    let mut eroded = bits.clone();
    let (mut next, mut opened) = (eroded.clone(), eroded.clone());
    let mut spare = eroded.clone();
    for size in 0.. {
        if eroded.is_empty() {
            break;
        }
        next.clone_from(&eroded);
        disk.once(Both::Erosion, &mut next, &mut spare);
        opened.clone_from(&next);
        disk.once(Both::Dilation, &mut opened, &mut spare);
        eroded.remove(&opened);
        disks.extend(eroded.set_boxes().map(|place| centre(place, size)));
        std::mem::swap(&mut eroded, &mut next);
    }
    disks
}

fn euclidean(interior: &Interior) -> Vec<MaximalDisk> {
    let owners = Power::of(interior.map.squared(), interior.map.width()).owners();
    let disks = interior.pixels().filter(|&(index, _)| owners[index]);
    let mut disks: Vec<_> = disks
        .map(|(index, squared)| centre(interior.place(index), squared))
        .collect();
    disks.sort_by_key(|disk| disk.size);
    disks
}

#[expect(clippy::cast_possible_truncation, reason = "sides are below 2³²")]
fn centre([column, row]: [usize; 2], size: u32) -> MaximalDisk {
    MaximalDisk {
        column: column as u32,
        row: row as u32,
        size,
    }
}
