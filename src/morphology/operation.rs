//! Sequences of erosions, dilations, openings and closings.

use std::fmt;
use std::num::NonZero;
use std::str::FromStr;

use crate::bits::Bits;

use super::disk::DiskFamily;
use super::euclid;
use super::shifts::Both;

/// Largest number of pixels of a picture with room for all that is dilated.
const MAX_PIXELS: usize = 1 << 31;

/// A morphological operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A ⊖ B: the pixels whose disk lies in the set.
    Erode,
    /// A ⊕ B: the pixels of all disks about pixels of the set.
    Dilate,
    /// (A ⊖ B) ⊕ B: the union of the disks that lie in the set.
    Open,
    /// (A ⊕ B) ⊖ B: the pixels that are in no disk outside the set.
    Close,
}

impl Operation {
    /// All operations.
    pub const ALL: [Self; 4] = [Self::Erode, Self::Dilate, Self::Open, Self::Close];

    /// Returns the name of the operation in sequences.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Erode => "erode",
            Self::Dilate => "dilate",
            Self::Open => "open",
            Self::Close => "close",
        }
    }

    /// Returns the erosions and dilations that the operation consists of.
    fn parts(self) -> &'static [Both] {
        match self {
            Self::Erode => &[Both::Erosion],
            Self::Dilate => &[Both::Dilation],
            Self::Open => &[Both::Erosion, Both::Dilation],
            Self::Close => &[Both::Dilation, Both::Erosion],
        }
    }
}

/// Operations with the sizes of their disks, as in `open:3, close:2, erode:1`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence(Vec<(Operation, f64)>);

/// A mistake in a sequence of operations.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct SequenceError(String);

/// The reason for which a sequence cannot be applied.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotApplied {
    /// The size of a discrete disk is not whole.
    #[error("{operation}:{size}: the size of a {disk} is a whole number; fractions are those of --disk euclid", operation = .operation.name(), disk = .disk.name())]
    Fraction {
        /// The operation.
        operation: Operation,
        /// Its size.
        size: f64,
        /// The disk.
        disk: DiskFamily,
    },
    /// The picture with all that is dilated has too many pixels.
    #[error(
        "with {margin} pixels around it, into which it is dilated, the picture has more than {MAX_PIXELS} pixels: choose smaller disks"
    )]
    TooLarge {
        /// Number of pixels added on each side.
        margin: usize,
    },
}

impl Sequence {
    /// Creates a sequence of one operation with a disk of a size, 0 or larger.
    #[must_use]
    pub fn one(operation: Operation, size: f64) -> Self {
        Self(vec![(operation, size.max(0.0))])
    }

    /// Applies the operations in order, as in the whole plane: pixels outside are not set, sets are dilated beyond
    /// the picture's sides where a later erosion brings them back, and the result has the picture's size.
    ///
    /// The size of a disk is its radius in pixels for [`DiskFamily::Euclid`], or else the number r of r D.
    ///
    /// # Errors
    ///
    /// Returns an error if a discrete disk has a fraction, or if the room for dilations is too large.
    pub fn apply(
        &self,
        bits: &Bits,
        disk: DiskFamily,
        threads: NonZero<usize>,
    ) -> Result<Bits, NotApplied> {
        let mut margin = 0usize;
        for &(operation, size) in &self.0 {
            if disk != DiskFamily::Euclid && size.fract() != 0.0 {
                return Err(NotApplied::Fraction {
                    operation,
                    size,
                    disk,
                });
            }
            if matches!(operation, Operation::Dilate | Operation::Close) {
                margin = margin.saturating_add(disk.reach(size));
            }
        }
        let with_room = |side: usize| side.checked_add(margin.checked_mul(2)?);
        let size = with_room(bits.width()).zip(with_room(bits.height()));
        let is_small = |(width, height): &(usize, usize)| {
            width
                .checked_mul(*height)
                .is_some_and(|it| it <= MAX_PIXELS)
        };
        let too_large = NotApplied::TooLarge { margin };
        let (width, height) = size.filter(is_small).ok_or(too_large)?;
        let away = margin.cast_signed();
        let mut result = bits.window([-away, -away], width, height);
        for &(operation, size) in &self.0 {
            for &both in operation.parts() {
                result = applied(both, result, disk, size, threads);
            }
        }
        Ok(result.window([away, away], bits.width(), bits.height()))
    }
}

/// Erodes or dilates by the disk of a size.
fn applied(
    both: Both,
    mut bits: Bits,
    disk: DiskFamily,
    size: f64,
    threads: NonZero<usize>,
) -> Bits {
    if disk == DiskFamily::Euclid {
        return match both {
            Both::Erosion => euclid::eroded(&bits, size, threads),
            Both::Dilation => euclid::dilated(&bits, size, threads),
        };
    }
    // Nothing changes further once the disk is larger than the picture.
    let most = bits.width().max(bits.height()) * 2;
    let mut spare = Bits::new(bits.width(), bits.height());
    for _ in 0..crate::saturating::whole(size).min(most) {
        disk.once(both, &mut bits, &mut spare);
    }
    bits
}

impl FromStr for Sequence {
    type Err = SequenceError;

    fn from_str(text: &str) -> Result<Self, SequenceError> {
        let operations = text.split(',').map(parse);
        operations.collect::<Result<_, _>>().map(Self)
    }
}

fn parse(text: &str) -> Result<(Operation, f64), SequenceError> {
    let text = text.trim();
    let names = Operation::ALL.map(Operation::name).join(", ");
    let wrong = |message: String| SequenceError(message);
    if text.is_empty() {
        return Err(wrong(format!(
            "an operation is missing: write one of {names} with a size, as in open:3, close:2"
        )));
    }
    let (name, size) = text.split_once(':').unwrap_or((text, ""));
    let (name, size) = (name.trim(), size.trim());
    let operation = Operation::ALL.into_iter().find(|it| it.name() == name);
    let Some(operation) = operation else {
        return Err(wrong(format!(
            "{name:?} is no operation: write one of {names}"
        )));
    };
    match size.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok((operation, number)),
        _ if size.is_empty() => Err(wrong(format!(
            "{name} has no size: write {name}:3 for a disk of size 3"
        ))),
        _ => Err(wrong(format!(
            "{name}:{size}: a size is a number of pixels, 0 or more"
        ))),
    }
}

impl fmt::Display for Sequence {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, (operation, size)) in self.0.iter().enumerate() {
            let comma = if number > 0 { ", " } else { "" };
            write!(formatter, "{comma}{}:{size}", operation.name())?;
        }
        Ok(())
    }
}
