//! The graph of a skeleton of pixels.

use std::collections::VecDeque;

use super::super::interior::{Interior, around};
use super::{SkeletonBranch, SkeletonNode, SkeletonPoint};

/// Nodes and branches of a skeleton.
pub(super) type Traced = (Vec<SkeletonNode>, Vec<SkeletonBranch>);

/// Traces lines of pixels, given by their indices in order, from node to node.
pub(super) fn traced(interior: &Interior, pixels: &[usize]) -> Traced {
    let mut tracer = Tracer {
        interior,
        pixels,
        links: links(interior, pixels),
        owners: vec![NONE; pixels.len()],
        towards: vec![NONE; pixels.len()],
        nodes: Vec::new(),
        branches: Vec::new(),
    };
    for pixel in 0..pixels.len() {
        if tracer.links[pixel].len() != 2 && tracer.owners[pixel] == NONE {
            tracer.node(pixel);
        }
    }
    for pixel in 0..pixels.len() {
        if tracer.is_node(pixel) {
            tracer.leave(pixel);
        }
    }
    // Closed lines without a node begin at their first pixel.
    for pixel in 0..pixels.len() {
        if tracer.owners[pixel] == NONE {
            tracer.node(pixel);
            tracer.leave(pixel);
        }
    }
    (tracer.nodes, tracer.branches)
}

/// Owner of a pixel that is in no node or branch.
const NONE: usize = usize::MAX;

/// Owner of a pixel in a branch.
const BRANCH: usize = usize::MAX - 1;

struct Tracer<'a> {
    interior: &'a Interior,
    pixels: &'a [usize],
    links: Vec<Vec<usize>>,
    /// The node of each pixel, [`BRANCH`] or [`NONE`].
    owners: Vec<usize>,
    /// The next pixel on the way to the point of its node, of each pixel of a node but that point.
    towards: Vec<usize>,
    nodes: Vec<SkeletonNode>,
    branches: Vec<SkeletonBranch>,
}

impl Tracer<'_> {
    fn is_node(&self, pixel: usize) -> bool {
        self.owners[pixel] < BRANCH
    }

    fn point(&self, pixel: usize) -> SkeletonPoint {
        point(self.interior, self.pixels[pixel])
    }

    /// Adds a node of a pixel and, if it is a branch point, of the branch points beside it.
    fn node(&mut self, pixel: usize) {
        let number = self.nodes.len();
        let mut members = vec![pixel];
        self.owners[pixel] = number;
        let mut at = 0;
        while let Some(&pixel) = members.get(at) {
            at += 1;
            for &next in &self.links[pixel] {
                let both = [pixel, next].iter().all(|&it| self.links[it].len() > 2);
                if both && self.owners[next] == NONE {
                    self.owners[next] = number;
                    members.push(next);
                }
            }
        }
        let points: Vec<_> = members.iter().map(|&pixel| self.point(pixel)).collect();
        let largest = |best: usize, at: usize| match points[at].radius > points[best].radius {
            true => at,
            false => best,
        };
        let best = (0..points.len()).fold(0, largest);
        self.nodes.push(SkeletonNode {
            point: points[best],
            points,
            branches: Vec::new(),
        });
        self.connect(number, members[best]);
        // Branch points around a hole.
        for &pixel in &members {
            for next in self.links[pixel].clone() {
                let is_way = self.towards[pixel] == next || self.towards[next] == pixel;
                let is_own = pixel < next && self.owners[next] == number;
                if is_own && !is_way && !self.is_filled(pixel, next) {
                    self.join(pixel, next, Vec::new());
                }
            }
        }
    }

    /// Finds the ways of the pixels of a node to one of them.
    fn connect(&mut self, node: usize, root: usize) {
        let mut found = VecDeque::from([root]);
        while let Some(pixel) = found.pop_front() {
            for &next in &self.links[pixel] {
                if next != root && self.owners[next] == node && self.towards[next] == NONE {
                    self.towards[next] = pixel;
                    found.push_back(next);
                }
            }
        }
    }

    /// Returns whether two linked pixels are a side of a square of four.
    fn is_filled(&self, pixel: usize, next: usize) -> bool {
        let width = self.interior.map.width();
        let [pixel, next] = [pixel, next].map(|it| self.pixels[it]);
        let holds = |place: usize| self.pixels.binary_search(&place).is_ok();
        let across = match next.abs_diff(pixel) {
            1 => width,
            apart if apart == width => 1,
            _ => return false,
        };
        holds(pixel + across) && holds(next + across)
            || holds(pixel - across) && holds(next - across)
    }

    /// Returns the points on the way from a pixel of a node to the node's point.
    fn way(&self, pixel: usize) -> Vec<SkeletonPoint> {
        let next = |pixel: &usize| Some(self.towards[*pixel]).filter(|it| *it != NONE);
        let way = std::iter::successors(Some(pixel), next);
        way.map(|pixel| self.point(pixel)).collect()
    }

    /// Follows the branches that begin at a pixel of a node.
    fn leave(&mut self, pixel: usize) {
        let node = self.owners[pixel];
        for next in self.links[pixel].clone() {
            match self.owners[next] {
                NONE => self.follow(pixel, next),
                BRANCH => {}
                other if other > node => self.join(pixel, next, Vec::new()),
                _ => {}
            }
        }
    }

    /// Follows a branch from a pixel of a node over the next pixel to a node.
    fn follow(&mut self, from: usize, next: usize) {
        let (mut before, mut here) = (from, next);
        let mut line = Vec::new();
        while !self.is_node(here) {
            line.push(self.point(here));
            self.owners[here] = BRANCH;
            let ahead = self.links[here].iter().copied().find(|&it| it != before);
            let Some(ahead) = ahead else { return };
            (before, here) = (here, ahead);
        }
        self.join(from, here, line);
    }

    /// Adds a branch over a line of pixels, from a pixel of a node to one of a node.
    fn join(&mut self, from: usize, to: usize, line: Vec<SkeletonPoint>) {
        let number = self.branches.len();
        let mut points = self.way(from);
        points.reverse();
        points.extend(line);
        points.extend(self.way(to));
        points.dedup();
        let [from, to] = [from, to].map(|pixel| self.owners[pixel]);
        self.nodes[from].branches.push(number);
        self.nodes[to].branches.push(number);
        self.branches.push(SkeletonBranch {
            ends: [from, to],
            points,
        });
    }
}

/// Returns the point of a pixel of the padded picture.
pub(super) fn point(interior: &Interior, index: usize) -> SkeletonPoint {
    let [column, row] = interior.place(index);
    SkeletonPoint {
        column,
        row,
        radius: f64::from(interior.map.squared()[index]).sqrt() - 0.5,
    }
}

/// Returns the neighbours of each pixel: those beside it, and those at its corners to which no pixel beside it leads.
fn links(interior: &Interior, pixels: &[usize]) -> Vec<Vec<usize>> {
    let width = interior.map.width();
    let links = pixels.iter().map(|&pixel| {
        let found = around(pixel, width).map(|place| pixels.binary_search(&place).ok());
        let mut links = Vec::new();
        for side in 0..8 {
            let sides = [found[(side + 7) % 8], found[(side + 1) % 8]];
            if side % 2 == 0 || sides == [None; 2] {
                links.extend(found[side]);
            }
        }
        links
    });
    links.collect()
}
