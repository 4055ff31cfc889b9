//! Occlusion: parts of lines that lie under areas.
//!
//! Areas are collected from the top down in a quadtree. A cell that lies within one area hides everything below; another
//! holds the edges of areas that run through it, with their winding numbers at a point of the cell. A line is therefore
//! compared with nearby edges only.

use crate::geometry::{DVec2, clip, distance_to_segment};

use super::areas::Area;
use super::points::MEET;

/// Number of edges above which a cell is divided.
const MAX_EDGES: usize = 32;

/// Side of a cell that is not divided: 0.08 units of the picture. In such cells the area at a point stands for the cell.
const LEAST_SIDE: f64 = 8.0;

/// Length below which gaps between hidden parts are hidden too.
const SHORT: f64 = 8.0;

/// Distance from an edge up to which a line runs along it.
const ALONG: f64 = MEET as f64;

/// Square cell.
#[derive(Clone, Copy)]
struct Cell {
    low: DVec2,
    side: f64,
}

impl Cell {
    fn children(self) -> [Self; 4] {
        let side = self.side / 2.0;
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| Self {
            low: self.low + side * DVec2::new(x, y),
            side,
        })
    }

    fn high(self) -> DVec2 {
        self.low + DVec2::splat(self.side)
    }

    /// Returns the point at which winding numbers are known. It is not on the lattice of positions, so that few edges
    /// run through it.
    fn reference(self) -> DVec2 {
        self.low + self.side * DVec2::new(0.381_966_011_250_105, 0.423_606_797_749_979)
    }

    /// Returns whether an edge runs through the cell or along it.
    fn meets(self, [from, to]: [DVec2; 2]) -> bool {
        let reach = DVec2::splat(ALONG + 1.0);
        clip(from, to - from, self.low - reach, self.high() + reach).is_some()
    }
}

/// Part of an area near a cell.
struct Occluder {
    /// Winding number at the reference of the cell.
    winding: i32,
    edges: Vec<[DVec2; 2]>,
}

impl Occluder {
    /// Returns the winding number at a point of the cell with a reference.
    fn winding_at(&self, point: DVec2, reference: DVec2) -> i32 {
        let way = point - reference;
        let crossings = self.edges.iter().map(|&[from, to]| {
            let [a, b] = [from, to].map(|end| way.perp_dot(end - reference));
            if (a >= 0.0) == (b >= 0.0) {
                return 0;
            }
            // The edge crosses the line of the way; it crosses the way between two points on different sides of the edge.
            let edge = to - from;
            let [start, end] = [reference, point].map(|it| edge.perp_dot(it - from) >= 0.0);
            match (start, end) {
                (false, true) => 1,
                (true, false) => -1,
                _ => 0,
            }
        });
        self.winding + crossings.sum::<i32>()
    }

    /// Returns the part near a smaller cell.
    fn within(&self, cell: Cell, child: Cell) -> Self {
        let edges = self.edges.iter().copied();
        Self {
            winding: self.winding_at(child.reference(), cell.reference()),
            edges: edges.filter(|&edge| child.meets(edge)).collect(),
        }
    }

    /// Appends the parts of a line between two parameters that lie in the area or along its outline.
    fn hide(
        &self,
        reference: DVec2,
        [from, to]: [DVec2; 2],
        [first, last]: [f64; 2],
        hidden: &mut Vec<[f64; 2]>,
    ) {
        let way = to - from;
        let length = way.length();
        let mut cuts = vec![first, last];
        let mut cut = |at: f64| {
            if first < at && at < last {
                cuts.push(at);
            }
        };
        for edge in &self.edges {
            let off = edge.map(|end| way.perp_dot(end - from) / length);
            let along = edge.map(|end| way.dot(end - from) / (length * length));
            for (off, along) in off.into_iter().zip(along) {
                if off.abs() <= ALONG {
                    cut(along);
                }
            }
            if off[0] * off[1] < 0.0 {
                cut(along[0] + (along[1] - along[0]) * (off[0] / (off[0] - off[1])));
            }
        }
        cuts.sort_unstable_by(f64::total_cmp);
        for ends in cuts.windows(2) {
            let distance = |share: f64| {
                let point = from + way * (ends[0] + (ends[1] - ends[0]) * share);
                let edges = self.edges.iter();
                let least = edges.map(|&[a, b]| distance_to_segment(point, a, b));
                (least.fold(f64::INFINITY, f64::min), point)
            };
            let samples = [0.1, 0.5, 0.9].map(distance);
            let [a, b, c] = samples;
            let furthest = [a, c]
                .into_iter()
                .fold(b, |a, b| if b.0 > a.0 { b } else { a });
            if furthest.0 <= ALONG || self.winding_at(furthest.1, reference) != 0 {
                hidden.push([ends[0], ends[1]]);
            }
        }
    }
}

enum Node {
    Hidden,
    Leaf(Vec<Occluder>),
    /// Number of the first of four children.
    Inner(usize),
}

/// Areas that hide lines.
pub(super) struct Occlusion {
    root: Cell,
    nodes: Vec<Node>,
    hidden: Vec<[f64; 2]>,
}

impl Occlusion {
    /// Creates an empty one for a picture of a size, in positions.
    pub(super) fn new(size: f64) -> Self {
        Self {
            root: Cell {
                low: DVec2::ZERO,
                side: size,
            },
            nodes: vec![Node::Leaf(Vec::new())],
            hidden: Vec::new(),
        }
    }

    /// Adds an area below those that have been added.
    pub(super) fn add(&mut self, area: Area<'_>) {
        let edges: Vec<_> = area.edges().collect();
        let least = edges.iter().fold(DVec2::INFINITY, |a, edge| a.min(edge[0]));
        let most = { edges.iter() }.fold(DVec2::NEG_INFINITY, |a, edge| a.max(edge[0]));
        if (most - least).min_element() <= ALONG {
            return;
        }
        // The reference of a cell that holds the picture is reached from outside along the edges.
        let outside = Occluder { winding: 0, edges };
        let start = self.root.low - DVec2::splat(self.root.side);
        let winding = outside.winding_at(self.root.reference(), start);
        let area = Occluder { winding, ..outside };
        self.add_to(0, self.root, area);
    }

    fn add_to(&mut self, node: usize, cell: Cell, area: Occluder) {
        if area.edges.is_empty() {
            if area.winding != 0 {
                self.nodes[node] = Node::Hidden;
            }
            return;
        }
        match &mut self.nodes[node] {
            Node::Hidden => {}
            Node::Leaf(areas) => {
                areas.push(area);
                let edges: usize = areas.iter().map(|area| area.edges.len()).sum();
                if edges <= MAX_EDGES {
                    return;
                }
                let areas = std::mem::take(areas);
                if cell.side > LEAST_SIDE {
                    self.nodes[node] = Node::Inner(self.nodes.len());
                    self.nodes.extend([(); 4].map(|()| Node::Leaf(Vec::new())));
                    areas.iter().for_each(|area| self.share(node, cell, area));
                } else if areas.iter().any(|area| area.winding != 0) {
                    self.nodes[node] = Node::Hidden;
                }
            }
            Node::Inner(_) => self.share(node, cell, &area),
        }
    }

    /// Adds an area to the children of a node.
    fn share(&mut self, node: usize, cell: Cell, area: &Occluder) {
        let Node::Inner(first) = self.nodes[node] else {
            return;
        };
        for (number, child) in (first..).zip(cell.children()) {
            if !matches!(self.nodes[number], Node::Hidden) {
                self.add_to(number, child, area.within(cell, child));
            }
        }
        let children = &self.nodes[first..first + 4];
        if children.iter().all(|child| matches!(child, Node::Hidden)) {
            self.nodes[node] = Node::Hidden;
        }
    }

    /// Returns the hidden parts of a line, as disjoint intervals of its parameter, in order.
    pub(super) fn hidden(&mut self, line: [DVec2; 2]) -> &[[f64; 2]] {
        let mut hidden = std::mem::take(&mut self.hidden);
        hidden.clear();
        let length = line[0].distance(line[1]);
        if length > 0.0 {
            self.search(0, self.root, line, &mut hidden);
        }
        hidden.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        hidden.dedup_by(|next, last| {
            let meets = (next[0] - last[1]) * length < SHORT;
            if meets {
                last[1] = last[1].max(next[1]);
            }
            meets
        });
        // A line that touches an area stays whole.
        hidden.retain(|&[from, to]| (to - from) * length > 2.0 * ALONG || to - from > 0.99);
        self.hidden = hidden;
        &self.hidden
    }

    fn search(&self, node: usize, cell: Cell, line: [DVec2; 2], hidden: &mut Vec<[f64; 2]>) {
        let [from, to] = line;
        let Some([first, last]) = clip(from, to - from, cell.low, cell.high()) else {
            return;
        };
        if first >= last {
            return;
        }
        match &self.nodes[node] {
            Node::Hidden => hidden.push([first, last]),
            Node::Leaf(areas) => {
                for area in areas {
                    area.hide(cell.reference(), line, [first, last], hidden);
                }
            }
            Node::Inner(children) => {
                for (number, child) in (*children..).zip(cell.children()) {
                    self.search(number, child, line, hidden);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::plot::areas::{AreaPaint, Areas};
    use crate::render::plot::points::vector;

    const SIZE: i64 = 10_000;

    /// Returns areas with contours of a number of vertices, many of which cross themselves.
    fn areas(count: usize, vertices: i64, spread: i64) -> (Areas, usize) {
        let mut areas = Areas::default();
        let mut kept = 0;
        for number in (0..).take(count) {
            let (x, y) = (number * 7919 % SIZE, number * 104_729 % SIZE);
            let vertex = |turn: i64| {
                let seed = number * 31 + turn;
                [x + seed * 6151 % spread, y + seed * 12_289 % spread]
            };
            let contour: Vec<_> = (0..vertices).map(vertex).collect();
            areas.add(&contour, [[0, 0], [SIZE, SIZE]]);
            let area = areas.finish(AreaPaint {
                hides: true,
                hatched: None,
            });
            kept += usize::from(area.is_some());
        }
        (areas, kept)
    }

    /// Returns the distance of a point from the nearest edge of areas, and whether it lies in one.
    fn inside(areas: &[Area<'_>], point: DVec2) -> (f64, bool) {
        let mut least = f64::INFINITY;
        let mut is_inside = false;
        for area in areas {
            let mut angle = 0.0;
            for [from, to] in area.edges() {
                least = least.min(distance_to_segment(point, from, to));
                let [a, b] = [from - point, to - point];
                angle += libm::atan2(a.perp_dot(b), a.dot(b));
            }
            is_inside |= angle.abs() > 1.0;
        }
        (least, is_inside)
    }

    #[test]
    fn lines_are_hidden_where_they_lie_in_areas() {
        for (count, vertices, spread) in [(40, 5, 3000), (400, 4, 300), (3, 40, 9000)] {
            let (all, count) = areas(count, vertices, spread);
            let areas: Vec<_> = (0..count).map(|number| all.get(number)).collect();
            #[expect(clippy::cast_precision_loss, reason = "a small picture")]
            let mut occlusion = Occlusion::new(SIZE as f64);
            areas.iter().for_each(|&area| occlusion.add(area));
            let (mut hidden, mut compared) = (0, 0);
            for number in 0..60 {
                let place = |by: i32| vector([number * 2741 % 10_000, number * by % 10_000]);
                let line = [place(4201), place(6007) + DVec2::new(0.0, 900.0)];
                let line = line.map(|it| it.min(DVec2::splat(10_000.0)));
                let parts = occlusion.hidden(line).to_vec();
                for sample in 1..200 {
                    let at = f64::from(sample) / 200.0;
                    let (distance, expected) = inside(&areas, line[0] + (line[1] - line[0]) * at);
                    // Short gaps are filled.
                    if distance < 12.0 {
                        continue;
                    }
                    let found = parts.iter().any(|part| part[0] <= at && at <= part[1]);
                    assert_eq!(found, expected, "{line:?} at {at}");
                    hidden += i32::from(found);
                    compared += 1;
                }
            }
            let share = f64::from(hidden) / f64::from(compared);
            assert!(
                compared > 500 && (0.001..0.98).contains(&share),
                "{share} of {compared}"
            );
        }
    }

    #[test]
    fn lines_along_an_outline_are_hidden_and_lines_that_touch_it_are_not() {
        let mut areas = Areas::default();
        let square = [[2000, 2000], [6000, 2000], [6000, 6000], [2000, 6000]];
        areas.add(&square, [[0, 0], [SIZE, SIZE]]);
        let paint = AreaPaint {
            hides: true,
            hatched: None,
        };
        areas.finish(paint);
        let mut occlusion = Occlusion::new(8192.0);
        occlusion.add(areas.get(0));
        let mut parts = |from: [i32; 2], to: [i32; 2]| -> Vec<[f64; 2]> {
            let hidden = occlusion.hidden([vector(from), vector(to)]).iter();
            hidden
                .map(|part| part.map(|at| (at * 1000.0).round() / 1000.0))
                .collect()
        };
        assert_eq!(parts([2000, 2000], [6000, 2000]), [[0.0, 1.0]]);
        assert_eq!(parts([6000, 2001], [2000, 2001]), [[0.0, 1.0]]);
        assert_eq!(parts([1000, 2000], [5000, 2000]), [[0.25, 1.0]]);
        assert_eq!(parts([1000, 3000], [7000, 3000]), [[0.167, 0.833]]);
        assert_eq!(parts([1000, 3000], [3000, 1000]), [[0.0; 2]; 0]);
        assert_eq!(parts([0, 1990], [8000, 1990]), [[0.0; 2]; 0]);
        assert_eq!(parts([0, 6000], [2000, 6000]), [[0.0; 2]; 0]);
        assert_eq!(parts([3000, 3000], [5000, 5000]), [[0.0, 1.0]]);
    }

    #[test]
    fn areas_that_meet_in_one_place_take_little_memory() {
        // Thousands of narrow areas around a point, none of which covers the smallest cells.
        let mut areas = Areas::default();
        for number in 0..4000 {
            let y = 3000 + number % 2000;
            let contour = [[5000, 5000], [9000, y], [9000, y + 9], [5000, 5003]];
            areas.add(&contour, [[0, 0], [SIZE, SIZE]]);
            areas.finish(AreaPaint {
                hides: true,
                hatched: None,
            });
        }
        let mut occlusion = Occlusion::new(8192.0);
        (0..4000).for_each(|number| occlusion.add(areas.get(number)));
        assert!(occlusion.nodes.len() < 100_000);
        let held = occlusion.nodes.iter().map(|node| match node {
            Node::Leaf(areas) => areas.iter().map(|area| area.edges.len()).sum(),
            _ => 0,
        });
        let held: usize = held.sum();
        assert!(held < 1_000_000, "{held}");
    }
}
