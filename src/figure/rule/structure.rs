//! Figures of object instancing: the scene and the canonical objects side by side, each with its shapes and
//! with the bounding boxes of its instances.

use std::collections::BTreeMap;

use crate::extent::Bounded;
use crate::geometry::{BaseElement, Bounds, DAffine2, DAffine3, DMat3, DVec2, Solid};
use crate::graph::Graph;
use crate::ifs::{AffineMap, OutlineOf, PointOf};
use crate::instancing::{Instancing, Master, ObjectInstance};
use crate::render::Paint;

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::ink;
use super::lines::{bounds_of, flattened, outline};
use super::onto_panel;
use super::page::{SMALL, WORDS, lay_out, plural};
use super::space;

/// Largest side of the scene's panel, in pixels.
const SCENE: f64 = 300.0;
/// Largest side of an object's panel, in pixels.
const OBJECT: f64 = 170.0;

/// Width up to which panels stand side by side, in pixels.
const WIDTH: f64 = 640.0;

/// Limit of the number of objects shown.
const MAX_OBJECTS: usize = 24;
/// Limit of the number of levels shown of one name.
const MAX_LEVELS: usize = 3;

/// Limit of the number of instances shown in a panel.
const MAX_INSTANCES: usize = 400;
/// Limit of the number of named instances in a panel.
const MAX_NAMES: usize = 40;

/// Limit of the number of characters in a name; longer ones are truncated.
const MAX_CHARACTERS: usize = 16;

/// Limit of the coordinates that are drawn.
const FARTHEST: f64 = 1e100;

/// Lays out an instancing structure under a title.
pub(super) fn page<M: Shown>(structure: &Instancing<M>, view: M::View, title: &str) -> Block {
    let font = Font::new();
    let shown = shown(structure);
    let plan = StructureFigure {
        font: &font,
        structure,
        view,
        boxes: boxes(structure, &shown),
    };
    let panel = |name: String, instances| {
        let name = Block::text(&font, vec![name], WORDS, true);
        Block::column(vec![name, plan.panel(instances, OBJECT)], 2.0, true)
    };
    let objects = shown.iter().flat_map(|&number| {
        let object = &structure.objects()[number];
        if object.alternatives.is_empty() {
            return vec![panel(cut(&object.name), &object.instances)];
        }
        let total: f64 = object.alternatives.iter().map(|it| it.weight).sum();
        let alternatives = object.alternatives.iter().map(|it| {
            let share = 100.0 * it.weight / total;
            let name = format!("{}: {share:.0} %", cut(&object.name));
            panel(name, &object.instances[it.instances.clone()])
        });
        alternatives.collect()
    });
    let objects = Block::flow(objects.collect(), DVec2::new(22.0, 16.0), WIDTH);
    let mut columns = vec![("scene", plan.panel(structure.scene(), SCENE))];
    if !shown.is_empty() {
        columns.push((plural(shown.len(), "object", "objects"), objects));
    }
    let mut notes = Vec::new();
    let left_out = structure.objects().len() - shown.len();
    if left_out > 0 {
        notes.push(format!(
            "{left_out} more {} not shown",
            plural(left_out, "object is", "objects are")
        ));
    }
    let source = structure.metadata().description.source.as_deref();
    lay_out(
        &font,
        columns,
        [title, source.unwrap_or_default()],
        |_| Block::default(),
        &notes,
    )
}

/// Returns the indices of the objects shown; of objects that differ only by their level, the first few.
fn shown<M: AffineMap>(structure: &Instancing<M>) -> Vec<usize> {
    let mut levels: BTreeMap<&str, usize> = BTreeMap::new();
    let mut shown = Vec::new();
    for (number, object) in structure.objects().iter().enumerate() {
        let name = object.name.split('(').next().unwrap_or_default();
        let seen = levels.entry(name).or_default();
        *seen += 1;
        if *seen <= MAX_LEVELS && shown.len() < MAX_OBJECTS {
            shown.push(number);
        }
    }
    shown
}

/// Returns the bounding boxes of all objects that are instanced in a panel.
fn boxes<M: Shown>(
    structure: &Instancing<M>,
    shown: &[usize],
) -> BTreeMap<usize, Bounds<PointOf<M>>> {
    let panels = shown
        .iter()
        .map(|&number| &structure.objects()[number].instances);
    let instances = panels
        .chain([&structure.scene])
        .flat_map(|instances| instances.iter().take(MAX_INSTANCES));
    let mut numbers: Vec<usize> = instances
        .filter_map(|instance| match instance.master {
            Master::Object(number) => Some(number),
            Master::Shape(_) => None,
        })
        .collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.truncate(MAX_INSTANCES);
    let boxes = Graph::boxes_of(structure, &numbers);
    let both = numbers.into_iter().zip(boxes);
    both.filter_map(|(number, bounds)| Some((number, bounds?)))
        .collect()
}

/// Maps of structures that have figures.
pub(super) trait Shown: AffineMap<Frame: Bounded> {
    /// Direction of view.
    type View: Copy;

    /// Returns the outline of the image of a shape, the edges within it, and how near it is to the viewer.
    fn seen(shape: &OutlineOf<Self>, map: &Self, view: Self::View) -> (Outline, Vec<Outline>, f64);
}

impl Shown for DAffine2 {
    type View = ();

    fn seen(shape: &BaseElement, map: &Self, (): ()) -> (Outline, Vec<Outline>, f64) {
        (outline(shape).transformed(map), Vec::new(), 0.0)
    }
}

impl Shown for DAffine3 {
    /// Rotation to coordinates of the viewer.
    type View = DMat3;

    fn seen(shape: &Solid, map: &Self, view: DMat3) -> (Outline, Vec<Outline>, f64) {
        space::seen(shape, &(Self::from_mat3(view) * *map))
    }
}

struct StructureFigure<'a, M: Shown> {
    font: &'a Font,
    structure: &'a Instancing<M>,
    view: M::View,
    boxes: BTreeMap<usize, Bounds<PointOf<M>>>,
}

/// A drawable instance, in the coordinates of the object that contains it.
struct DrawnInstance<'a, M: Shown> {
    outline: Outline,
    edges: Vec<Outline>,
    /// Place in the order from far to near.
    near: f64,
    instance: &'a ObjectInstance<M>,
}

impl<'a, M: Shown> StructureFigure<'a, M> {
    /// Returns the panel of a list of instances, with sides of at most `side` pixels.
    fn panel(&self, instances: &'a [ObjectInstance<M>], side: f64) -> Block {
        let drawn = instances.iter().take(MAX_INSTANCES);
        let mut drawn: Vec<_> = drawn.filter_map(|instance| self.drawn(instance)).collect();
        drawn.sort_by(|a, b| a.near.total_cmp(&b.near));
        let bounds = drawn.iter().fold(Bounds::EMPTY, |mut bounds, drawn| {
            bounds.add_all(&bounds_of([&drawn.outline]));
            bounds
        });
        let mut block = Block::default();
        let mut unnamed: Vec<String> = Vec::new();
        if !bounds.is_empty() {
            let size = bounds.size();
            let (map, size) = onto_panel(&bounds, side / size.max_element().max(1e-300));
            block.size = size;
            for drawn in &drawn {
                let line = drawn.outline.transformed(&map);
                let paint = drawn.paint();
                block.items.push(BlockItem::Path(vec![line], paint, None));
                let edges: Vec<_> = { drawn.edges.iter() }
                    .map(|it| it.transformed(&map))
                    .collect();
                if !edges.is_empty() {
                    let paint = Paint {
                        fill: None,
                        ..paint
                    };
                    block.items.push(BlockItem::Path(edges, paint, None));
                }
            }
            unnamed = self.put_names(&mut block, &drawn, &map);
        }
        if drawn.len() < instances.len() {
            unnamed.push(format!("{} in all", instances.len()));
        }
        let words = self.font.wrap(&unnamed.join(", "), SMALL, side.max(120.0));
        if unnamed.is_empty() {
            return block;
        }
        Block::column(
            vec![block, Block::text(self.font, words, SMALL, true)],
            2.0,
            true,
        )
    }

    fn drawn(&self, instance: &'a ObjectInstance<M>) -> Option<DrawnInstance<'a, M>> {
        let map = self.structure.map_of(instance);
        let own = match &instance.master {
            Master::Object(number) => M::filling(Some(*self.boxes.get(number)?)),
            Master::Shape(shape) => M::outlines(shape).swap_remove(0),
        };
        let (outline, edges, near) = M::seen(&own, &map, self.view);
        let bounds = bounds_of([&outline]);
        let corners = [bounds.min(), bounds.max()].map(DVec2::abs);
        let can_be_drawn =
            bounds.is_finite() && corners.iter().all(|it| it.max_element() < FARTHEST);
        can_be_drawn.then_some(DrawnInstance {
            outline,
            edges,
            near,
            instance,
        })
    }

    /// Labels instances with the names of their objects where a label covers nothing; returns the names
    /// without room.
    fn put_names(
        &self,
        block: &mut Block,
        drawn: &[DrawnInstance<'_, M>],
        map: &DAffine2,
    ) -> Vec<String> {
        let objects = || drawn.iter().filter(|drawn| !drawn.is_shape());
        let lines: Vec<_> = drawn
            .iter()
            .filter(|drawn| drawn.is_shape())
            .flat_map(|drawn| flattened(&drawn.outline.transformed(map)).collect::<Vec<_>>())
            .collect();
        let mut placed: Vec<Bounds> = Vec::new();
        let mut unnamed = Vec::new();
        let is_crowded = objects().count() > MAX_NAMES;
        for drawn in objects() {
            let Master::Object(number) = drawn.instance.master else {
                continue;
            };
            let name = cut(&self.structure.objects()[number].name);
            let size = DVec2::new(self.font.width(&name, SMALL), SMALL);
            let within = bounds_of([&drawn.outline.transformed(map)]);
            let is_free = |label: &Bounds| {
                let inside =
                    label.min().cmpge(DVec2::ZERO).all() && label.max().cmple(block.size).all();
                inside
                    && !placed.iter().any(|other| overlap(label, other))
                    && !lines.iter().any(|ends| comes_near(label, ends))
            };
            let places = places(&within).map(|middle| {
                let half = size / 2.0 + 1.0;
                Bounds::new(middle - half, middle + half)
            });
            let found = (!is_crowded)
                .then(|| places.into_iter().find(is_free))
                .flatten();
            match found {
                Some(label) => {
                    let at = DVec2::new(label.min().x + 1.0, label.max().y - 0.25 * SMALL);
                    let item = BlockItem::Text(name, SMALL, at, super::LABEL);
                    block.items.push(item);
                    placed.push(label);
                }
                None if !unnamed.contains(&name) => unnamed.push(name),
                None => {}
            }
        }
        unnamed
    }
}

impl<M: Shown> DrawnInstance<'_, M> {
    fn is_shape(&self) -> bool {
        matches!(self.instance.master, Master::Shape(_))
    }

    fn paint(&self) -> Paint {
        let closed = self.outline.closed;
        if self.is_shape() {
            ink::base_element(closed)
        } else {
            ink::instance(closed, self.instance.tint.map(|tint| tint.colour))
        }
    }
}

/// Returns candidate positions of a name in a box, its middle first.
fn places(within: &Bounds) -> [DVec2; 25] {
    const STEPS: [f64; 5] = [0.5, 0.3, 0.7, 0.12, 0.88];
    let at = |x: f64, y: f64| within.min() + within.size() * DVec2::new(x, y);
    std::array::from_fn(|place| at(STEPS[place / 5], STEPS[place % 5]))
}

fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a.min().cmplt(b.max()).all() && b.min().cmplt(a.max()).all()
}

/// Returns whether a line segment passes within a few pixels of a label.
fn comes_near(label: &Bounds, [from, to]: &[DVec2; 2]) -> bool {
    const STEP: f64 = 2.0;
    let mut along = 0.0;
    let length = from.distance(*to);
    let near = Bounds::new(label.min() - STEP, label.max() + STEP);
    loop {
        let at = from.lerp(*to, if length > 0.0 { along / length } else { 0.0 });
        if at.cmpge(near.min()).all() && at.cmple(near.max()).all() {
            return true;
        }
        if along >= length {
            return false;
        }
        along = (along + STEP).min(length);
    }
}

/// Returns a name, truncated to [`MAX_CHARACTERS`] characters.
fn cut(name: &str) -> String {
    if name.chars().count() <= MAX_CHARACTERS {
        return name.into();
    }
    let start: String = name.chars().take(MAX_CHARACTERS - 1).collect();
    start + "…"
}
