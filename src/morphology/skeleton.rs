//! The connected skeleton of a picture, with radii, as a graph of its branch points and branches.

mod anchors;
mod prune;
mod thinning;
mod trace;

use std::num::NonZero;

use crate::bits::Bits;

use super::distance::NoDistances;
use super::interior::Interior;

/// Options of a connected skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkeletonOptions {
    /// Least angle in degrees, from 0 to 180, between the directions to the nearest pixels outside at which a branch
    /// may end; larger angles leave fewer branches. That of a corner is 180° less its interior angle.
    pub angle: f64,
    /// Number of threads, which changes nothing in the result.
    pub threads: NonZero<usize>,
}

impl Default for SkeletonOptions {
    fn default() -> Self {
        Self {
            angle: 60.0,
            threads: NonZero::<usize>::MIN,
        }
    }
}

/// A pixel of a skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkeletonPoint {
    /// Column of the pixel.
    pub column: usize,
    /// Row of the pixel.
    pub row: usize,
    /// The skeleton function: the radius in pixels of the largest disk about the pixel's centre in the set, which is
    /// half a pixel less than the distance to the nearest centre of a pixel outside.
    pub radius: f64,
}

impl SkeletonPoint {
    /// Returns the distance of two pixels.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let columns = self.column.abs_diff(other.column);
        let rows = self.row.abs_diff(other.row);
        crate::saturating::real(columns * columns + rows * rows).sqrt()
    }
}

/// A branch point, an end, or a point that stands for a part of the skeleton without either.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonNode {
    /// The pixel of the node; of adjacent branch points, the one with the largest radius.
    pub point: SkeletonPoint,
    /// All pixels of the node: several where branch points are adjacent.
    pub points: Vec<SkeletonPoint>,
    /// Numbers of the branches that begin or end here; a loop is named twice.
    pub branches: Vec<usize>,
}

impl SkeletonNode {
    /// Returns `true` if at least three branches meet here.
    #[must_use]
    pub fn is_junction(&self) -> bool {
        self.branches.len() > 2
    }

    /// Returns `true` if at most one branch ends here.
    #[must_use]
    pub fn is_end(&self) -> bool {
        self.branches.len() < 2
    }
}

/// A line of pixels from node to node.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonBranch {
    /// Numbers of the nodes at which the branch begins and ends.
    pub ends: [usize; 2],
    /// The pixels from the first node to the last, including both.
    pub points: Vec<SkeletonPoint>,
}

impl SkeletonBranch {
    /// Returns the length of the line of pixels.
    #[must_use]
    pub fn length(&self) -> f64 {
        let pairs = self.points.windows(2);
        pairs.map(|pair| pair[0].distance(&pair[1])).sum()
    }
}

/// A connected skeleton: lines one pixel wide with as many parts and holes as the picture, and with the radii of the
/// disks about them.
///
/// Pixels are removed in the order of their distance from the outside, unless a part of the picture would be
/// separated or a branch would become shorter whose end has its nearest pixels outside in distinct directions.
/// Branches whose disks reach less than a pixel out of the disk where they begin are left out. The radius along a
/// branch need not fall: branch points need not be maxima of the distance.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    width: usize,
    height: usize,
    nodes: Vec<SkeletonNode>,
    branches: Vec<SkeletonBranch>,
}

impl Skeleton {
    /// Computes the skeleton of a picture. Pixels that share a corner are connected.
    ///
    /// # Errors
    ///
    /// Returns an error if the picture is empty, or if its diagonal is longer than 65,533 pixels.
    pub fn of(bits: &Bits, options: &SkeletonOptions) -> Result<Self, NoDistances> {
        let interior = Interior::of(bits, options.threads)?;
        let anchors = anchors::anchors(&interior, options);
        let mut pixels = thinning::thinned(&interior, &anchors);
        let (nodes, branches) = loop {
            let traced = trace::traced(&interior, &pixels);
            if !prune::prune(&interior, &traced, &mut pixels) {
                break traced;
            }
        };
        Ok(Self {
            width: bits.width(),
            height: bits.height(),
            nodes,
            branches,
        })
    }

    /// Returns the number of columns of the picture.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows of the picture.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns branch points, ends, and one point of every other part.
    #[must_use]
    pub fn nodes(&self) -> &[SkeletonNode] {
        &self.nodes
    }

    /// Returns the branches.
    #[must_use]
    pub fn branches(&self) -> &[SkeletonBranch] {
        &self.branches
    }

    /// Iterates over the pixels of all nodes and branches; nodes come more than once.
    pub fn points(&self) -> impl Iterator<Item = &SkeletonPoint> {
        let branches = self.branches.iter().flat_map(|branch| &branch.points);
        self.nodes
            .iter()
            .flat_map(|node| &node.points)
            .chain(branches)
    }

    /// Returns the branch point with the largest radius, or without branch points the node with the largest.
    #[must_use]
    pub fn centre(&self) -> Option<&SkeletonNode> {
        let largest = |one: &&SkeletonNode, other: &&SkeletonNode| {
            let junctions = one.is_junction().cmp(&other.is_junction());
            junctions.then(one.point.radius.total_cmp(&other.point.radius))
        };
        // Of several, the first.
        self.nodes.iter().rev().max_by(largest)
    }
}
