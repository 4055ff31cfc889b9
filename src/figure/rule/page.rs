//! Layout of a page: title, components side by side, and a key.

use crate::catalogue::Shelf;
use crate::document::RuleDocument;
use crate::geometry::DVec2;
use crate::rule::Rule;

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::panel::{self, Common};
use super::shown::ShownFrame;
use super::{components, ink, key};

/// Font size of the title, in pixels.
const TITLE: f64 = 21.0;
/// Font size of the headings of columns, in pixels.
const HEADING: f64 = 14.0;
/// Font size of text beside components, in pixels.
pub(super) const WORDS: f64 = 13.0;
/// Font size of the source and of notes, in pixels.
pub(super) const SMALL: f64 = 11.5;

/// Margin around the page, in pixels.
const MARGIN: f64 = 20.0;
/// Space on either side of the line between columns, in pixels.
const GUTTER: f64 = 26.0;
/// Least width of a page without its margins, in pixels.
const MIN_WIDTH: f64 = 480.0;
/// Least width of a column, in pixels.
const MIN_COLUMN: f64 = 96.0;

/// Limit of the number of characters in a text; longer ones are truncated.
const MAX_CHARACTERS: usize = 600;

/// Lays out a rule, or the components of one shelf, under a title.
pub(super) fn page<F: ShownFrame>(
    rule: &Rule<F>,
    document: &RuleDocument,
    alone: Option<Shelf>,
    view: F::View,
    title: &str,
) -> Block {
    let lists = rule.generators().iter().map(|generator| generator.parts());
    let mut lists = lists.chain([std::slice::from_ref(rule.initiator())]);
    let common = Common {
        font: Font::new(),
        closed: rule.base_elements().iter().map(F::is_closed).collect(),
        names: rule.generators().iter().map(|it| it.name()).collect(),
        directions: lists.any(panel::has_directions),
    };
    let font = &common.font;
    let (generators, bases) = (rule.generators().len(), rule.base_elements().len());
    let is_shown = |shelf| alone.is_none_or(|alone| alone == shelf);
    let mut columns = Vec::new();
    if is_shown(Shelf::Initiators) {
        columns.push(("initiator", components::initiator(rule, &common, view)));
    }
    if is_shown(Shelf::Generators) {
        let heading = plural(generators, "generator", "generators");
        let generators = components::generators(rule, document, &common, view);
        columns.push((heading, generators));
    }
    if is_shown(Shelf::BaseElements) {
        let heading = plural(bases, "base element", "base elements");
        columns.push((heading, components::base_elements(rule, view)));
    }
    let source = rule.description().source.as_deref().unwrap_or_default();
    let key = |width| key::key(rule, alone, font, width);
    lay_out(font, columns, [title, source], key, &key::notes(rule))
}

/// Lays out columns under a title and a source, with a key as wide as the columns, and notes.
pub(super) fn lay_out(
    font: &Font,
    columns: Vec<(&str, Block)>,
    [title, source]: [&str; 2],
    key: impl Fn(f64) -> Block,
    notes: &[String],
) -> Block {
    let columns = beside(columns, font);
    let width = columns.size.x.max(MIN_WIDTH);
    let paragraph = |text: &str, size: f64| {
        let lines = font.wrap(&shortened(text), size, width);
        Block::text(font, lines, size, false)
    };
    let head = vec![paragraph(title, TITLE), paragraph(source, SMALL)];
    let mut foot = vec![key(width)];
    foot.extend(notes.iter().map(|note| paragraph(note, SMALL)));
    let content = vec![
        Block::column(head, 2.0, false),
        across(width),
        columns.centred_in(width),
        across(width),
        Block::column(foot, 4.0, false),
    ];
    let mut page = Block::default();
    page.put(Block::column(content, 12.0, false), DVec2::splat(MARGIN));
    page.size = (page.size + MARGIN).ceil();
    page
}

pub(super) fn plural(count: usize, one: &'static str, several: &'static str) -> &'static str {
    if count == 1 { one } else { several }
}

/// Returns a text, truncated to [`MAX_CHARACTERS`] characters and an ellipsis.
pub(super) fn shortened(text: &str) -> String {
    let mut shortened: String = text.chars().take(MAX_CHARACTERS).collect();
    if shortened.len() < text.len() {
        shortened.push('…');
    }
    shortened
}

/// Returns a horizontal line.
fn across(width: f64) -> Block {
    let line = Outline::line(DVec2::new(0.0, 0.5), DVec2::new(width, 0.5));
    Block {
        size: DVec2::new(width, 1.0),
        items: vec![BlockItem::Path(vec![line], ink::hairline(), None)],
    }
}

/// Lays out columns side by side with their headings, and lines between them.
fn beside(columns: Vec<(&str, Block)>, font: &Font) -> Block {
    let heights = columns.iter().map(|(_, block)| block.size.y);
    let height = heights.fold(0.0, f64::max).ceil();
    let top = (1.4 * HEADING).round() + 12.0;
    let mut row = Block::default();
    for (heading, block) in columns {
        if row.size.x > 0.0 {
            let x = row.size.x.round() + GUTTER + 0.5;
            let line = Outline::line(DVec2::new(x, 0.0), DVec2::new(x, top + height));
            let line = BlockItem::Path(vec![line], ink::hairline(), None);
            row.items.push(line);
            row.size.x = x + GUTTER;
        }
        let heading = Block::text(font, vec![heading.into()], HEADING, true);
        let width = block.size.x.max(heading.size.x).max(MIN_COLUMN);
        let left = row.size.x;
        let down = top + ((height - block.size.y) / 2.0).round();
        row.put(heading.centred_in(width), DVec2::new(left, 0.0));
        row.put(block.centred_in(width), DVec2::new(left, down));
        row.size.y = top + height;
    }
    row
}
