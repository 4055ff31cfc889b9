//! Figures of iterated function systems: the initial set, its images under the maps with their numbers, and
//! the condensation sets.

use crate::geometry::{Bounds, DAffine2, DVec2, Frame2};
use crate::graph::Graph;
use crate::ifs::{AffineMap, Ifs, System};
use crate::rule::{BaseElement, Piece};

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::ink::{self, ElementRole};
use super::lines::outline;
use super::onto_panel;
use super::page::{WORDS, lay_out, plural};

/// Largest width and height of the panel of images, in pixels.
pub(super) const MOST: DVec2 = DVec2::new(380.0, 380.0);
/// Factor of the size of the other panels.
pub(super) const SMALL: f64 = 0.55;

/// Limit of the number of maps that are drawn with numbers.
pub(super) const MAX_NUMBERS: usize = 100;

/// Lays out a system under a title.
pub(super) fn page(system: &System, title: &str) -> Block {
    let graph = Graph::of_system(system);
    let font = Font::new();
    let ifs = system.ifs();
    let plan = SystemFigure::new(ifs, &graph);
    let sets = ifs.condensation().len();
    let mut columns = vec![
        ("initial set", plan.initial()),
        (plural(ifs.maps().len(), "map", "maps"), plan.images(&font)),
    ];
    if sets > 0 {
        columns.push((
            plural(sets, "condensation set", "condensation sets"),
            plan.condensation(),
        ));
    }
    let source = system.metadata().description.source.as_deref();
    lay_out(
        &font,
        columns,
        [title, source.unwrap_or_default()],
        |_| Block::default(),
        &edges(ifs),
    )
}

/// Returns the edges of a recurrent system's digraph as text, one line for each map.
pub(super) fn edges<M: AffineMap>(ifs: &Ifs<M>) -> Vec<String> {
    let Some(edges) = ifs.edges() else {
        return Vec::new();
    };
    let mut after = vec![Vec::new(); ifs.maps().len()];
    for (edge, _) in edges {
        after[edge.from].push(name(ifs, edge.to));
    }
    let lines = after.iter().enumerate();
    lines
        .map(|(map, after)| format!("after {}: {}", name(ifs, map), after.join(", ")))
        .collect()
}

/// Returns the name of a map, or its number from 1.
pub(super) fn name<M: AffineMap>(ifs: &Ifs<M>, map: usize) -> String {
    let name = ifs.maps()[map].name.clone();
    name.unwrap_or_else(|| (map + 1).to_string())
}

/// Content of the figure, and its bounds.
struct SystemFigure<'a> {
    ifs: &'a Ifs,
    /// Outlines of the initial set.
    initial: Vec<&'a BaseElement>,
    /// Outlines of the condensation sets.
    sets: &'a [BaseElement],
    /// Shape whose images are shown: the initial set, or a box around it if it is a curve or several
    /// outlines.
    shown: BaseElement,
    bounds: Bounds,
}

impl<'a> SystemFigure<'a> {
    fn new(ifs: &'a Ifs, graph: &'a Graph) -> Self {
        let (first, others) = (&graph.base_elements()[0], &graph.base_elements()[1..]);
        let sets = ifs.condensation().iter().map(|set| set.shape.count()).sum();
        let (sets, others) = others.split_at(sets);
        let initial: Vec<_> = std::iter::once(first).chain(others).collect();
        let mut around = graph.limit_bounds().unwrap_or(Bounds::EMPTY);
        for outline in &initial {
            outline.add_to(&mut around, &Frame2::UNIT, 0.0);
        }
        let size = around.size();
        let flat = size.min_element() < 0.02 * size.max_element();
        let shown = if others.is_empty() && (first.is_closed() || flat) {
            first.clone()
        } else {
            boxed(&around).unwrap_or_else(|| first.clone())
        };
        let mut bounds = Bounds::EMPTY;
        shown.add_to(&mut bounds, &Frame2::UNIT, 0.0);
        for map in ifs.maps() {
            shown.add_to(&mut bounds, &map.affine.into(), 0.0);
        }
        for set in sets {
            set.add_to(&mut bounds, &Frame2::UNIT, 0.0);
        }
        Self {
            ifs,
            initial,
            sets,
            shown,
            bounds,
        }
    }

    /// Returns whether a box is shown around the initial set.
    fn is_boxed(&self) -> bool {
        self.initial != [&self.shown]
    }

    /// Returns the map from the plane to a panel of a share of the full size, and the panel's size.
    fn panel(&self, share: f64) -> (DAffine2, DVec2) {
        let size = self.bounds.size();
        let scale = (MOST * share / size.max(DVec2::splat(1e-300))).min_element();
        onto_panel(&self.bounds, scale)
    }

    fn initial(&self) -> Block {
        let (map, size) = self.panel(SMALL);
        let mut items = Vec::new();
        if self.is_boxed() {
            let frame = outline(&self.shown).transformed(&map);
            items.push(BlockItem::Path(vec![frame], ink::side(), None));
        }
        for initial in &self.initial {
            items.push(BlockItem::Path(
                vec![outline(initial).transformed(&map)],
                ink::base_element(initial.is_closed()),
                None,
            ));
        }
        Block { size, items }
    }

    fn images(&self, font: &Font) -> Block {
        let (map, size) = self.panel(1.0);
        let whole = outline(&self.shown).transformed(&map);
        let mut items = vec![BlockItem::Path(vec![whole], ink::side(), None)];
        let images = |shape: &BaseElement| -> Vec<Outline> {
            let maps = self.ifs.maps().iter();
            maps.map(|it| outline(shape).transformed(&(map * it.affine)))
                .collect()
        };
        items.push(BlockItem::Path(
            images(&self.shown),
            ElementRole::Fertile.outline(self.shown.is_closed()),
            None,
        ));
        if self.is_boxed() {
            items.push(BlockItem::Path(
                self.initial.iter().flat_map(|one| images(one)).collect(),
                ElementRole::Fertile.element(true),
                None,
            ));
        }
        if self.ifs.maps().len() <= MAX_NUMBERS {
            for (number, it) in self.ifs.maps().iter().enumerate() {
                let name = name(self.ifs, number);
                let mut bounds = Bounds::EMPTY;
                self.shown
                    .add_to(&mut bounds, &(map * it.affine).into(), 0.0);
                let middle = bounds.centre();
                let at = middle + DVec2::new(-font.width(&name, WORDS) / 2.0, 0.36 * WORDS);
                items.push(BlockItem::Text(name, WORDS, at, super::LABEL));
            }
        }
        Block { size, items }
    }

    fn condensation(&self) -> Block {
        let (map, size) = self.panel(SMALL);
        let whole = outline(&self.shown).transformed(&map);
        let mut items = vec![BlockItem::Path(vec![whole], ink::side(), None)];
        for set in self.sets {
            let drawn = outline(set).transformed(&map);
            items.push(BlockItem::Path(
                vec![drawn],
                ink::base_element(set.is_closed()),
                None,
            ));
        }
        Block { size, items }
    }
}

fn boxed(bounds: &Bounds) -> Option<BaseElement> {
    let (min, max) = (bounds.min(), bounds.max());
    let corners = [DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    BaseElement::new(min, corners.map(Piece::Line).into(), true)
}
