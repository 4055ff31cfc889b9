//! Figures of iterated function systems in space: the initial set and its images under the maps with their
//! numbers, as seen by the camera.
//!
//! Sets are drawn as wire frames of convex solids: what the solid itself hides is dashed, or left out in the
//! images, which are drawn from the farthest to the nearest.

use std::collections::BTreeMap;

use crate::expression::degrees;
use crate::geometry::{
    Bounds, DAffine2, DAffine3, DMat3, DVec2, DVec3, Frame3, Outline as _, Solid, convex_hull,
};
use crate::graph::Graph;
use crate::ifs::{Ifs, System};
use crate::render::Paint;
use crate::rule::Piece;

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::ink::{self, ElementRole};
use super::onto_panel;
use super::page::{WORDS, lay_out, plural};
use super::system::{MAX_NUMBERS, MOST, SMALL, edges, name};

/// Lays out a system under a title. `view` is the rotation to coordinates of the viewer: x to the right, y upwards
/// and z towards the viewer.
pub(super) fn page(system: &System<DAffine3>, view: DMat3, title: &str) -> Block {
    let graph = Graph::of_system(system);
    let font = Font::new();
    let ifs = system.ifs();
    let plan = Plan::new(ifs, &graph, view);
    let mut columns = vec![
        ("initial set", plan.sets(&plan.initial)),
        (plural(ifs.maps().len(), "map", "maps"), plan.images(&font)),
    ];
    let sets = ifs.condensation().len();
    if sets > 0 {
        let drawn = plan.sets(&plan.condensation);
        let title = plural(sets, "condensation set", "condensation sets");
        columns.push((title, drawn));
    }
    let source = system.metadata.description.source.as_deref();
    lay_out(
        &font,
        columns,
        [title, source.unwrap_or_default()],
        |_| Block::default(),
        &edges(ifs),
    )
}

/// Content of the figure, and its bounds.
struct Plan<'a> {
    ifs: &'a Ifs<DAffine3>,
    view: DAffine3,
    initial: Vec<Wires>,
    condensation: Vec<Wires>,
    /// Solid whose images are shown: the initial set, or a box around it if it has several parts or is round.
    shown: Wires,
    /// Bounds of all images, as seen.
    bounds: Bounds,
}

impl<'a> Plan<'a> {
    fn new(ifs: &'a Ifs<DAffine3>, graph: &Graph<Frame3>, view: DMat3) -> Self {
        let (first, others) = (&graph.base_elements()[0], &graph.base_elements()[1..]);
        let sets = ifs.condensation().iter();
        let sets = sets.map(|set| set.shape.len()).sum::<usize>();
        let (sets, others) = others.split_at(sets.min(others.len()));
        let mut around = graph.limit_bounds().unwrap_or(Bounds::EMPTY);
        for solid in std::iter::once(first).chain(others) {
            solid.add_to(&mut around, &Frame3::UNIT, 0.0);
        }
        let shown = match others.is_empty() && !first.corners().is_empty() {
            true => Wires::of(first),
            false => Wires::of(&Solid::cuboid(&around)),
        };
        let mut plan = Self {
            ifs,
            view: DAffine3::from_mat3(view),
            initial: std::iter::once(first)
                .chain(others)
                .map(Wires::of)
                .collect(),
            condensation: sets.iter().map(Wires::of).collect(),
            bounds: Bounds::EMPTY,
            shown,
        };
        let whole = std::iter::once(DAffine3::IDENTITY);
        let images = whole.chain(ifs.maps().iter().map(|map| map.affine));
        let seen = images.flat_map(|map| plan.shown.seen(&(plan.view * map)).corners);
        let own = plan.condensation.iter();
        let own = own.flat_map(|set| set.seen(&plan.view).corners);
        let all: Vec<DVec3> = seen.chain(own).collect();
        all.iter()
            .for_each(|corner| plan.bounds.add(corner.truncate()));
        plan
    }

    /// Returns the map from the plane of view to a panel of a share of the full size, and the panel's size.
    fn panel(&self, share: f64) -> (DAffine2, DVec2) {
        let size = self.bounds.size();
        let scale = (MOST * share / size.max(DVec2::splat(1e-300))).min_element();
        onto_panel(&self.bounds, scale)
    }

    /// Returns a small panel with the whole set, dashed, and sets in their places.
    fn sets(&self, sets: &[Wires]) -> Block {
        let (map, size) = self.panel(SMALL);
        let mut items = Vec::new();
        if *sets != [self.shown.clone()] {
            items.extend(self.whole(&map));
        }
        for set in sets {
            let seen = set.seen(&self.view);
            let paint = ink::base_element(true);
            items.push(seen.fill(&map, paint));
            items.push(seen.lines(&map, false, ink::side()));
            items.push(seen.lines(&map, true, outline(paint)));
        }
        block(size, items)
    }

    fn whole(&self, map: &DAffine2) -> [BlockItem; 2] {
        let seen = self.shown.seen(&self.view);
        [false, true].map(|visible| seen.lines(map, visible, ink::side()))
    }

    fn images(&self, font: &Font) -> Block {
        let (map, size) = self.panel(1.0);
        let mut items: Vec<BlockItem> = self.whole(&map).into();
        let maps = self.ifs.maps().iter();
        let mut images: Vec<(usize, Seen<'_>)> = maps
            .map(|it| self.shown.seen(&(self.view * it.affine)))
            .enumerate()
            .collect();
        images.sort_by(|(_, a), (_, b)| a.middle().z.total_cmp(&b.middle().z));
        let paint = ElementRole::Fertile.outline(true);
        for (_, image) in &images {
            items.push(image.fill(&map, paint));
            items.push(image.lines(&map, true, outline(paint)));
        }
        if images.len() <= MAX_NUMBERS {
            for (number, image) in &images {
                let name = name(self.ifs, *number);
                let middle = map.transform_point2(image.middle().truncate());
                let at = middle + DVec2::new(-font.width(&name, WORDS) / 2.0, 0.36 * WORDS);
                items.push(BlockItem::Text(name, WORDS, at, super::LABEL));
            }
        }
        block(size, items)
    }
}

/// Returns the outline of the image of a solid under a map to coordinates of the viewer, the edges within it that
/// are seen, and the z of its nearest point.
pub(super) fn seen(solid: &Solid, map: &DAffine3) -> (Outline, Vec<Outline>, f64) {
    /// Number of corners of round outlines.
    const CORNERS: u32 = 48;
    let near = solid.bounds(map).max().z;
    let (around, edges) = match solid.primitive() {
        Some(primitive) => {
            let place = *map * *solid.place();
            let directions = (0..CORNERS).map(|corner| {
                let angle = 360.0 * f64::from(corner) / f64::from(CORNERS);
                DVec3::new(degrees::cos(angle), degrees::sin(angle), 0.0)
            });
            let farthest = directions.map(|direction| {
                let inside = place.matrix3.transpose() * direction;
                place.transform_point3(primitive.farthest(inside))
            });
            (farthest.map(DVec3::truncate).collect(), Vec::new())
        }
        None => {
            let wires = Wires::of(solid);
            let seen = wires.seen(map);
            let is_seen = |faces: &[usize]| faces.iter().any(|face| seen.fronts[*face]);
            let edges = wires.edges.iter().filter(|(_, faces)| is_seen(faces));
            let edges = edges.map(|([from, to], _)| {
                let [from, to] = [from, to].map(|end| seen.corners[*end].truncate());
                Outline::line(from, to)
            });
            let corners = seen.corners.iter().map(|corner| corner.truncate());
            (corners.collect::<Vec<_>>(), edges.collect())
        }
    };
    let around = convex_hull(around, 0.0);
    let start = around.first().copied().unwrap_or_default();
    let others = around.iter().skip(1).copied().chain([start]);
    let outline = Outline {
        start,
        pieces: others.map(Piece::Line).collect(),
        closed: true,
    };
    (outline, edges, near)
}

/// Returns a block of the items that draw something.
fn block(size: DVec2, mut items: Vec<BlockItem>) -> Block {
    items.retain(|item| !matches!(item, BlockItem::Path(paths, ..) if paths.is_empty()));
    Block { size, items }
}

/// Returns the paint without its fill.
fn outline(paint: Paint) -> Paint {
    Paint {
        fill: None,
        ..paint
    }
}

/// Corners, faces and edges of a solid.
#[derive(Clone, Debug, PartialEq)]
struct Wires {
    corners: Vec<DVec3>,
    /// Numbers of the corners of each face, counter-clockwise from outside.
    faces: Vec<Vec<usize>>,
    /// Numbers of the ends of each edge, with those of its faces.
    edges: BTreeMap<[usize; 2], Vec<usize>>,
}

impl Wires {
    /// Returns the wire frame of a polyhedron, or of the box around a round solid.
    fn of(solid: &Solid) -> Self {
        if solid.corners().is_empty() {
            let mut bounds = Bounds::EMPTY;
            solid.add_to(&mut bounds, &Frame3::UNIT, 0.0);
            return Self::of(&Solid::cuboid(&bounds));
        }
        let number = |corner: &DVec3| solid.corners().iter().position(|it| it == corner);
        let faces = solid.polygons();
        let faces = faces
            .iter()
            .map(|face| face.iter().filter_map(number).collect());
        let faces: Vec<Vec<usize>> = faces.collect();
        let mut edges: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (number, face) in faces.iter().enumerate() {
            let next = face.iter().skip(1).chain(face.first());
            for (&from, &to) in face.iter().zip(next) {
                let ends = [from.min(to), from.max(to)];
                edges.entry(ends).or_default().push(number);
            }
        }
        if faces.is_empty() && solid.corners().len() == 2 {
            edges.insert([0, 1], Vec::new());
        }
        Self {
            corners: solid.corners().to_vec(),
            faces,
            edges,
        }
    }

    /// Returns the image under a map to coordinates of the viewer.
    fn seen(&self, map: &DAffine3) -> Seen<'_> {
        let corners = self.corners.iter().map(|it| map.transform_point3(*it));
        let corners: Vec<DVec3> = corners.collect();
        let turn = if map.matrix3.determinant() < 0.0 {
            -1.0
        } else {
            1.0
        };
        let is_front = |face: &Vec<usize>| {
            let next = face.iter().skip(1).chain(face.first());
            let areas = face
                .iter()
                .zip(next)
                .map(|(&from, &to)| corners[from].truncate().perp_dot(corners[to].truncate()));
            // The one face of a flat solid has no back.
            self.faces.len() == 1 || areas.sum::<f64>() * turn > 0.0
        };
        let fronts: Vec<bool> = self.faces.iter().map(is_front).collect();
        Seen {
            wires: self,
            fronts,
            corners,
        }
    }
}

/// Wire frame in coordinates of the viewer.
struct Seen<'a> {
    wires: &'a Wires,
    corners: Vec<DVec3>,
    /// Whether each face is seen from outside.
    fronts: Vec<bool>,
}

impl Seen<'_> {
    #[expect(clippy::cast_precision_loss, reason = "there are few corners")]
    fn middle(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / self.corners.len() as f64
    }

    /// Returns the faces that are seen, filled.
    fn fill(&self, map: &DAffine2, paint: Paint) -> BlockItem {
        let faces = self.wires.faces.iter().zip(&self.fronts);
        let seen = faces.filter(|(_, is_front)| **is_front).map(|(face, _)| {
            let start = face.first().map(|it| self.place(map, *it));
            let others = face.iter().skip(1).map(|it| self.place(map, *it));
            Outline {
                start: start.unwrap_or_default(),
                // A closed outline ends where it starts.
                pieces: others.chain(start).map(Piece::Line).collect(),
                closed: true,
            }
        });
        let paint = Paint {
            stroke: None,
            ..paint
        };
        BlockItem::Path(seen.collect(), paint, None)
    }

    /// Returns the edges that are seen, or those that the solid itself hides.
    fn lines(&self, map: &DAffine2, visible: bool, paint: Paint) -> BlockItem {
        let is_seen = |faces: &[usize]| {
            faces.iter().any(|face| self.fronts[*face]) || !self.fronts.contains(&true)
        };
        let edges = self.wires.edges.iter();
        let edges = edges.filter(|(_, faces)| is_seen(faces) == visible);
        let lines = edges
            .map(|([from, to], _)| Outline::line(self.place(map, *from), self.place(map, *to)));
        BlockItem::Path(lines.collect(), paint, None)
    }

    fn place(&self, map: &DAffine2, corner: usize) -> DVec2 {
        map.transform_point2(self.corners[corner].truncate())
    }
}
