//! Elements of equal faces that follow each other, of which a mesh is written without a further walk.

use std::io::{self, Write};
use std::num::NonZero;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::grow::WalkError;
use crate::parallel::with_team;

use super::MeshFormat;
use super::encode::{Encoder, Pass, Shape};

/// Largest number of repeats that are kept, of 32 bytes each.
const MAX_KEPT: usize = 1 << 16;

/// Number of faces that are encoded at once, unless an element has more.
const MANY: u64 = 1 << 12;

/// Faces of an element, up to the numbers of their corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Faces {
    /// Index of the shape.
    pub(super) shape: usize,
    pub(super) is_mirrored: bool,
    pub(super) colour: [u8; 3],
}

/// Elements in order of traversal, of which those that follow each other with equal faces are one repeat.
#[derive(Debug)]
pub(super) struct Repeats {
    /// Faces, and the number of elements that have them; `None` if they are not kept.
    kept: Option<Vec<(Faces, u64)>>,
}

impl Repeats {
    /// Returns no elements; elements that are added are kept if `are_kept`.
    pub(super) fn new(are_kept: bool) -> Self {
        Self {
            kept: are_kept.then(Vec::new),
        }
    }

    /// Adds `count` elements.
    pub(super) fn add(&mut self, faces: Faces, count: u64) {
        let Some(kept) = &mut self.kept else {
            return;
        };
        if let Some((last, number)) = kept.last_mut()
            && *last == faces
        {
            *number += count;
        } else if kept.len() < MAX_KEPT {
            kept.push((faces, count));
        } else {
            self.kept = None;
        }
    }

    /// Moves the elements of a span behind those of the spans before.
    pub(super) fn append(&mut self, span: &mut Self) {
        match &mut span.kept {
            Some(all) => all
                .drain(..)
                .for_each(|(faces, count)| self.add(faces, count)),
            None => self.kept = None,
        }
    }

    /// Returns whether all elements are kept.
    pub(super) fn are_kept(&self) -> bool {
        self.kept.is_some()
    }

    /// Writes the faces of all elements.
    pub(super) fn write(
        &self,
        shapes: &[Shape],
        format: MeshFormat,
        threads: NonZero<usize>,
        cancel: Option<&AtomicBool>,
        out: &mut impl Write,
    ) -> Result<(), WalkError<io::Error>> {
        let mut take =
            |batch: &mut Batch<'_>| batch.encoder.pass_on(out).map_err(WalkError::Visitor);
        with_team(threads, |team| {
            let mut line = team.line(Batch::encode);
            let fresh = || Batch {
                shapes,
                encoder: Encoder::new(format, Pass::Faces),
                repeats: Vec::new(),
                before: 0,
            };
            let mut batch = fresh();
            // Faces of the batch, and corners of the elements that are handed out.
            let (mut many, mut before) = (0, 0);
            for &(faces, count) in self.kept.iter().flatten() {
                let shape = &shapes[faces.shape];
                let of_one = (shape.faces() as u64).max(1);
                let mut left = count;
                while left > 0 {
                    let own = left.min(((MANY - many) / of_one).max(1));
                    batch.repeats.push((faces, own));
                    left -= own;
                    many += own * of_one;
                    before += own * u64::from(shape.count());
                    if many < MANY {
                        continue;
                    }
                    if cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                        return Err(WalkError::Cancelled);
                    }
                    let next = line.spare().unwrap_or_else(fresh);
                    line.hand_on(std::mem::replace(&mut batch, next), &mut take)?;
                    // The number of all corners fits into 32 bits.
                    batch.before = u32::try_from(before).unwrap_or(u32::MAX);
                    many = 0;
                }
            }
            line.hand_on(batch, &mut take)?;
            line.finish(&mut take)
        })
    }
}

/// Elements whose faces are encoded at once.
struct Batch<'a> {
    shapes: &'a [Shape],
    encoder: Encoder,
    repeats: Vec<(Faces, u64)>,
    /// Number of corners of the elements before.
    before: u32,
}

impl Batch<'_> {
    fn encode(&mut self) {
        self.encoder.start(self.before);
        for (faces, count) in self.repeats.drain(..) {
            let shape = &self.shapes[faces.shape];
            self.encoder
                .repeat(shape, faces.is_mirrored, faces.colour, count);
        }
        self.encoder.refer(0);
    }
}
