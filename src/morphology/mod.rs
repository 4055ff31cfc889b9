//! Morphology of pictures of [bits](crate::Bits): distances, erosions and dilations, skeletons.
//!
//! Pictures have columns to the right and rows from the top down; indices of pixels run along the rows. Pixels
//! outside a picture are not in its set.

mod disk;
mod distance;
mod euclid;
mod interior;
mod operation;
mod power;
mod shifts;
mod skeleton;
mod subsets;

pub use disk::DiskFamily;
pub use distance::{DistanceMap, NoDistances};
pub use operation::{NotApplied, Operation, Sequence, SequenceError};
pub use skeleton::{Skeleton, SkeletonBranch, SkeletonNode, SkeletonOptions, SkeletonPoint};
pub use subsets::{MaximalDisk, SkeletonSubsets};

#[cfg(test)]
mod tests;
