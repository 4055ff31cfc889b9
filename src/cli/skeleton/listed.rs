//! Skeletons as JSON, as a table and in words.

use std::fmt::Write;

use serde::Serialize;

use crate::morphology::{Skeleton, SkeletonPoint, SkeletonSubsets};
use crate::saturating::real;

use super::super::pixels::PixelSet;
use super::Found;

/// A skeleton in coordinates of the picture.
#[derive(Serialize)]
pub(super) struct Listed<'a> {
    picture: Picture<'a>,
    #[serde(flatten)]
    content: Content,
}

#[derive(Serialize)]
struct Picture<'a> {
    name: &'a str,
    width: usize,
    height: usize,
    pixels: u64,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Content {
    Connected {
        nodes: Vec<Node>,
        branches: Vec<Branch>,
    },
    Disks {
        disk: &'static str,
        subsets: Vec<Subset>,
    },
}

#[derive(Serialize)]
struct Node {
    x: f64,
    y: f64,
    radius: f64,
    branches: Vec<usize>,
}

#[derive(Serialize)]
struct Branch {
    from: usize,
    to: usize,
    length: f64,
    points: Vec<[f64; 3]>,
}

#[derive(Serialize)]
struct Subset {
    size: u32,
    radius: f64,
    centres: Vec<[f64; 2]>,
}

impl<'a> Listed<'a> {
    pub(super) fn of(set: &'a PixelSet, found: &Found) -> Self {
        let height = set.bits.height();
        Self {
            picture: Picture {
                name: &set.name,
                width: set.bits.width(),
                height,
                pixels: set.bits.count(),
            },
            content: match found {
                Found::Connected(skeleton) => connected(skeleton, height),
                Found::Disks(subsets) => disks(subsets, height),
            },
        }
    }

    /// Returns a row for each node, each point of a branch, or each maximal disk.
    pub(super) fn csv(&self) -> String {
        let mut table = String::new();
        let mut row = |kind: &str, number: usize, [x, y, radius]: [f64; 3]| {
            let _ = writeln!(table, "{kind},{number},{x},{y},{radius}");
        };
        match &self.content {
            Content::Connected { nodes, branches } => {
                for (number, node) in nodes.iter().enumerate() {
                    row(node.kind(), number, [node.x, node.y, node.radius]);
                }
                for (number, branch) in branches.iter().enumerate() {
                    branch
                        .points
                        .iter()
                        .for_each(|&point| row("branch", number, point));
                }
            }
            Content::Disks { subsets, .. } => {
                for subset in subsets {
                    for &[x, y] in &subset.centres {
                        row("disk", subset.size as usize, [x, y, subset.radius]);
                    }
                }
            }
        }
        let number = match self.content {
            Content::Connected { .. } => "number",
            Content::Disks { .. } => "size",
        };
        format!("kind,{number},x,y,radius\n{table}")
    }

    /// Returns a summary with the branch points of the largest radii.
    pub(super) fn described(&self) -> String {
        const MOST: usize = 12;
        let mut text = String::new();
        match &self.content {
            Content::Disks { disk, subsets } => {
                let centres: usize = subsets.iter().map(|subset| subset.centres.len()).sum();
                let largest = subsets.last().map_or(0.0, |subset| subset.radius);
                let _ = writeln!(
                    text,
                    "{centres} maximal disks ({disk}) of {} sizes, up to {largest:.2}",
                    subsets.len()
                );
            }
            Content::Connected { nodes, branches } => {
                let mut junctions: Vec<_> = nodes
                    .iter()
                    .filter(|node| node.branches.len() > 2)
                    .collect();
                let ends = nodes.iter().filter(|node| node.branches.len() == 1).count();
                let _ = writeln!(
                    text,
                    "{} branch points, {ends} ends, {} branches",
                    junctions.len(),
                    branches.len()
                );
                junctions.sort_by(|one, other| other.radius.total_cmp(&one.radius));
                for node in junctions.iter().take(MOST) {
                    let _ = writeln!(
                        text,
                        "  at ({}, {}), radius {:.2}, {} branches",
                        node.x,
                        node.y,
                        node.radius,
                        node.branches.len()
                    );
                }
                if junctions.len() > MOST {
                    let _ = writeln!(text, "  and {} more", junctions.len() - MOST);
                }
            }
        }
        text
    }
}

impl Node {
    fn kind(&self) -> &'static str {
        match self.branches.len() {
            0 => "point",
            1 => "end",
            2 => "loop",
            _ => "junction",
        }
    }
}

/// Returns the centre of a pixel, with y up.
fn place(column: usize, row: usize, height: usize) -> [f64; 2] {
    [real(column) + 0.5, real(height - row) - 0.5]
}

fn connected(skeleton: &Skeleton, height: usize) -> Content {
    let at = |point: &SkeletonPoint| {
        let [x, y] = place(point.column, point.row, height);
        [x, y, point.radius]
    };
    let nodes = skeleton.nodes().iter().map(|node| {
        let [x, y, radius] = at(&node.point);
        Node {
            x,
            y,
            radius,
            branches: node.branches.clone(),
        }
    });
    let branches = skeleton.branches().iter().map(|branch| Branch {
        from: branch.ends[0],
        to: branch.ends[1],
        length: branch.length(),
        points: branch.points.iter().map(at).collect(),
    });
    Content::Connected {
        nodes: nodes.collect(),
        branches: branches.collect(),
    }
}

fn disks(subsets: &SkeletonSubsets, height: usize) -> Content {
    let listed = subsets.subsets().map(|disks| Subset {
        size: disks[0].size,
        radius: subsets.radius(&disks[0]),
        centres: disks
            .iter()
            .map(|disk| place(disk.column as usize, disk.row as usize, height))
            .collect(),
    });
    Content::Disks {
        disk: subsets.disk().name(),
        subsets: listed.collect(),
    }
}
