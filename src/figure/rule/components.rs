//! Blocks of the three components of a rule: initiator, generators and base elements.

use crate::document::RuleDocument;
use crate::draws::Path;
use crate::geometry::{Bounds, DAffine2, DVec2, Point as _};
use crate::rule::{ElementContext, ListedElement, Rule, Selection};

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::page::{WORDS, shortened};
use super::panel::{Common, Extent, Panel, Shape};
use super::shown::ShownFrame;
use super::{ink, lines, words};

/// Width of text beside generators, in pixels.
const WORDS_WIDTH: f64 = 215.0;
/// Limit of the number of lines of text.
const MAX_LINES: usize = 40;

/// Number of draws shown behind the typical one of a random generator.
const DRAWS: u32 = 6;

/// Returns the block of the initiator.
pub(super) fn initiator<F: ShownFrame>(
    rule: &Rule<F>,
    common: &Common<'_>,
    view: F::View,
) -> Block {
    let points = rule.initiator_points();
    let panel = Panel {
        parts: std::slice::from_ref(rule.initiator()),
        points: points.iter().map(|it| F::seen(*it, view)).collect(),
        shapes: shapes(rule, rule.initiator().elements.iter(), points, view),
        draws: Vec::new(),
        named: Vec::new(),
        replaced: None,
        common,
    };
    let mut bounds = Bounds::EMPTY;
    let ends = { rule.initiator().elements.iter() }.flat_map(|element| [element.from, element.to]);
    ends.for_each(|end| bounds.add(panel.points[end]));
    panel.block(Extent {
        unit: 130.0 / bounds.size().max_element(),
        most: DVec2::splat(240.0),
    })
}

/// Returns the block of the generators, below each other, between the selection and their descriptions.
pub(super) fn generators<F: ShownFrame>(
    rule: &Rule<F>,
    document: &RuleDocument,
    common: &Common<'_>,
    view: F::View,
) -> Block {
    let font = &common.font;
    let several = rule.generators().len() > 1;
    let mut panels = Vec::new();
    let written = document.generators.iter().map(|(_, written)| written);
    let both = rule.generators().iter().zip(written);
    for (number, (generator, document)) in both.enumerate() {
        let moment = moment(rule, number);
        let description = words::generator(generator, document, &moment);
        let draws = if generator.is_random() { DRAWS } else { 0 };
        let draws = (0..draws).map(|draw| {
            let (mut scratch, mut points) = (Vec::new(), Vec::new());
            let path = Path::of_seed(0).child(draw);
            generator.evaluate(&moment, path, &mut scratch, &mut points);
            points.iter().map(|it| F::seen(*it, view)).collect()
        });
        let points = generator.typical(&moment);
        let side = [0.0, 1.0].map(|x| F::Point::of_coordinates([x, 0.0, 0.0]));
        let panel = Panel {
            parts: generator.parts(),
            points: points.iter().map(|it| F::seen(*it, view)).collect(),
            shapes: shapes(rule, generator.elements(), &points, view),
            draws: draws.collect(),
            named: description.named,
            replaced: Some(side.map(|end| F::seen(end, view))),
            common,
        };
        let mut drawn = panel.block(Extent {
            unit: 190.0,
            most: DVec2::new(480.0, 440.0),
        });
        if several {
            let width = drawn.size.x.max(WORDS_WIDTH);
            let name = font.wrap(&shortened(generator.name()), WORDS, width);
            let name = Block::text(font, name, WORDS, true);
            drawn = Block::column(vec![name, drawn], 2.0, true);
        }
        panels.push((drawn, paragraphs(&description.lines, font)));
    }
    let widths = panels.iter().map(|(drawn, _)| drawn.size.x);
    let widest = widths.fold(0.0, f64::max);
    // The descriptions begin at the same distance from the left.
    let rows = panels
        .into_iter()
        .map(|(drawn, words)| Block::row(vec![drawn.centred_in(widest), words], 18.0));
    let rows = Block::column(rows.collect(), 22.0, false);
    let selection = match rule.selection() {
        Selection::AtRandom(weights) => words::shares(rule.generators(), weights),
        _ => words::selection(document),
    };
    Block::row(vec![paragraphs(&selection, font), rows], 18.0)
}

/// Returns paragraphs of text, wrapped; lines beyond the limit are replaced by an ellipsis.
fn paragraphs(lines: &[String], font: &Font) -> Block {
    let more = (lines.len() > MAX_LINES).then(|| "…".into());
    let blocks = lines.iter().take(MAX_LINES).chain(more.as_ref());
    let blocks = blocks.map(|line| {
        let lines = font.wrap(&shortened(line), WORDS, WORDS_WIDTH);
        Block::text(font, lines, WORDS, false)
    });
    Block::column(blocks.collect(), 5.0, false)
}

/// Returns the first moment at which a generator is selected and all of its points are finite, or else the
/// first at which they are finite.
fn moment<F: ShownFrame>(rule: &Rule<F>, generator: usize) -> ElementContext {
    let at = |step: u32, index: u32| ElementContext {
        index: index.into(),
        age: step.into(),
        step: step.into(),
        length: 1.0,
    };
    let is_finite = |moment: &ElementContext| {
        let points = rule.generators()[generator].typical(moment);
        points.iter().all(|point| point.is_finite())
    };
    let is_selected = |moment: &ElementContext| {
        let selected = rule.selection().select(moment, Path::of_seed(0));
        selected == generator && is_finite(moment)
    };
    let mut moments = (0..=20).flat_map(|step| (1..=12).map(move |index| at(step, index)));
    let found = moments.clone().find(is_selected);
    let found = found.or_else(|| moments.find(is_finite));
    found.unwrap_or(at(0, 1))
}

/// Returns the base elements in the places of elements, as seen.
fn shapes<'a, F: ShownFrame>(
    rule: &Rule<F>,
    elements: impl Iterator<Item = &'a ListedElement>,
    points: &[F::Point],
    view: F::View,
) -> Vec<Shape> {
    let turned = |element: &ListedElement| {
        let base = &rule.base_elements()[element.base_element];
        F::shape(element, points, base, view)
    };
    elements.map(turned).collect()
}

/// Returns the block of the base elements, each over the line between its ends.
pub(super) fn base_elements<F: ShownFrame>(rule: &Rule<F>, view: F::View) -> Block {
    let side = [0.0, 1.0].map(|x| F::seen(F::Point::of_coordinates([x, 0.0, 0.0]), view));
    let blocks = rule.base_elements().iter().map(|base| {
        let shape = F::alone(base, view);
        let mut bounds = shape.bounds;
        { side.iter().chain(shape.normal.iter().flatten()) }.for_each(|&end| bounds.add(end));
        let unit = (110.0 / bounds.size().x)
            .min(140.0 / bounds.size().y)
            .min(96.0);
        let pad = DVec2::splat(6.0);
        let map = DAffine2::from_translation(pad)
            * DAffine2::from_scale(DVec2::new(unit, -unit))
            * DAffine2::from_translation(-DVec2::new(bounds.min().x, bounds.max().y));
        let ends = side.map(|end| map.transform_point2(end));
        let mut items = Vec::new();
        if !F::is_line(base) {
            let side = Outline::line(ends[0], ends[1]);
            items.push(BlockItem::Path(vec![side], ink::side(), None));
        }
        for outline in &shape.outlines {
            let paint = ink::base_element(outline.closed);
            items.push(BlockItem::Path(
                vec![outline.transformed(&map)],
                paint,
                None,
            ));
        }
        if let Some(normal) = shape.normal {
            let arrow = lines::arrow(normal.map(|end| map.transform_point2(end)));
            let paint = ink::normal(ink::ElementRole::Fertile.colour());
            items.push(BlockItem::Path(arrow.into(), paint, None));
        }
        let rings = ends.map(|end| Outline::circle(end, 4.6));
        items.push(BlockItem::Path(rings.into(), ink::side_end(), None));
        Block {
            size: bounds.size() * unit + 2.0 * pad,
            items,
        }
    });
    Block::column(blocks.collect(), 18.0, true)
}
