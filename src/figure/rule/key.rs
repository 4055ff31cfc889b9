//! The key of a figure: samples of its lines, and notes.

use crate::catalogue::Shelf;
use crate::geometry::{DVec2, Direction};
use crate::rule::Rule;

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::ink::{self, ElementRole};
use super::page::SMALL;
use super::panel::MAX_MARKS;
use super::shown::ShownFrame;
use super::{lines, marks, words};

/// Returns samples of the lines that occur, each with its meaning, for all components or for those of one
/// shelf.
pub(super) fn key<F: ShownFrame>(
    rule: &Rule<F>,
    alone: Option<Shelf>,
    font: &Font,
    width: f64,
) -> Block {
    let (from, to) = (DVec2::new(1.0, 8.0), DVec2::new(31.0, 8.0));
    let line = || vec![Outline::line(from, to)];
    let mut entries: Vec<(Vec<BlockItem>, &str)> = Vec::new();
    let is_shown = |shelf| alone.is_none_or(|alone| alone == shelf);
    let lists = || {
        let shown = is_shown(Shelf::Generators);
        let generators = rule.generators().iter().filter(move |_| shown);
        let initiator = is_shown(Shelf::Initiators).then(|| rule.initiator());
        generators.flat_map(|it| it.parts()).chain(initiator)
    };
    let has = |kind: ElementRole| {
        lists().any(|part| {
            let mut elements = part.elements.iter();
            elements.any(|it| ElementRole::of(it.fertile, part.placement.seeds()) == kind)
        })
    };
    for (kind, meaning) in [
        (ElementRole::Fertile, "fertile"),
        (ElementRole::Infertile, "infertile"),
        (ElementRole::Seed, "seeds a new fractal"),
        (ElementRole::InfertileSeed, "seeds a new fractal, infertile"),
    ] {
        if has(kind) {
            let mut items = vec![BlockItem::Path(line(), kind.element(true), None)];
            if matches!(kind, ElementRole::Fertile | ElementRole::Seed) {
                let at = from.midpoint(to) - DVec2::new(0.0, 6.5);
                let (strokes, paint) = marks::asterisk(at, 0.85, kind.colour());
                items.push(BlockItem::Path(strokes, paint, None));
            }
            entries.push((items, meaning));
        }
    }
    let mut elements = lists().flat_map(|part| &part.elements);
    if elements.any(|element| !element.visible) {
        let dotted = BlockItem::Path(line(), ElementRole::Fertile.element(false), None);
        entries.push((vec![dotted], "invisible"));
    }
    let side = BlockItem::Path(line(), ink::side(), None);
    let rings = [from, to].map(|end| Outline::circle(end, 3.0));
    let ends = BlockItem::Path(rings.into(), ink::side_end(), None);
    if is_shown(Shelf::Generators) {
        entries.push((vec![side, ends], "the side that is replaced"));
    } else if is_shown(Shelf::BaseElements) {
        entries.push((vec![side, ends], "the element that is drawn so"));
    }
    if rule.base_elements().iter().any(F::has_front) {
        let arrow = lines::arrow([from, to]);
        let paint = ink::normal(ElementRole::Fertile.colour());
        entries.push((
            vec![BlockItem::Path(arrow.into(), paint, None)],
            "normal of the front",
        ));
    }
    let blocks = entries.into_iter().map(|(items, meaning)| {
        let sample = Block {
            size: DVec2::new(34.0, 16.0),
            items,
        };
        let text = Block::text(font, vec![meaning.into()], SMALL, false);
        Block::row(vec![sample, text], 5.0)
    });
    Block::flow(blocks.collect(), DVec2::new(22.0, 2.0), width)
}

/// Returns the notes below the figure: directions, parameters, random functions, and missing marks.
pub(super) fn notes<F: ShownFrame>(rule: &Rule<F>) -> Vec<String> {
    let mut notes = Vec::new();
    let elements = rule.generators().iter().flat_map(|it| it.elements());
    let elements: Vec<_> = elements.chain(&rule.initiator().elements).collect();
    let used = Direction::ALL
        .into_iter()
        .filter(|direction| elements.iter().any(|it| it.direction == *direction));
    let used: Vec<_> = used.collect();
    if used.iter().any(|&direction| direction != Direction::Normal) {
        let names = used.iter().map(|direction| {
            let name = match direction {
                Direction::Normal => "normal",
                Direction::YReflected => "y reflected",
                Direction::XReflected => "x reflected",
                Direction::BothReflected => "x and y reflected",
                Direction::ZReflected => "z reflected",
                Direction::YZReflected => "y and z reflected",
                Direction::XZReflected => "x and z reflected",
                Direction::AllReflected => "all reflected",
            };
            format!("{} {name}", direction.number())
        });
        let names: Vec<_> = names.collect();
        notes.push(format!("Directions: {}.", names.join(", ")));
    }
    if !rule.parameters().is_empty() {
        let values = words::parameters(rule.parameters());
        notes.push(format!("Drawn for {values}."));
    }
    if rule.generators().iter().any(|it| it.is_random()) {
        let how =
            "Random functions are drawn at the middle of their draws, with some draws behind.";
        notes.push(how.into());
    }
    let generators = rule.generators().iter().map(|it| it.elements().count());
    let mut counts = generators.chain([rule.initiator().elements.len()]);
    if counts.any(|count| count > MAX_MARKS) {
        notes.push(format!(
            "Components of more than {MAX_MARKS} elements have no marks."
        ));
    }
    notes
}
