//! Figures of L-systems: the axiom, and every production as what the turtle draws of the module that is replaced and of
//! its successor.
//!
//! Lines of modules that are replaced are blue, others grey, as in figures of rules. A module that is replaced and draws
//! nothing is an arrow in the turtle's direction. Arguments are those of the first module that a production replaces.

use crate::document::{LSystemDocument, ModuleDocument, ProductionDocument};
use crate::geometry::{Affine as _, Bounds, DAffine2, DVec2, Point as _};
use crate::lsystem::{Context, Drawn, LSystem, Production, Turtle, TurtleFrame};

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::ink::{self, ElementRole};
use super::lines::{arrow, arrowhead, flattened};
use super::marks::{self, Anchor, Mark, Obstacle};
use super::page::{WORDS, lay_out, plural, shortened};
use super::panel::{ATTEMPTS, LAST_ATTEMPT, can_be_drawn, with_room};
use super::shown::ShownFrame;

/// Length of a step, in pixels, where there is room.
const STEP: f64 = 44.0;
/// Largest side of a word's panel, in pixels.
const MOST: f64 = 230.0;
/// Least width of the text below a production, in pixels.
const TEXT: f64 = 260.0;
/// Width up to which productions stand side by side, in pixels.
const WIDTH: f64 = 680.0;

/// Length of the arrow of a module that draws nothing, in pixels.
const ARROW: f64 = 22.0;
/// Limit of the number of marks beside a word.
const MAX_MARKS: usize = 80;

/// Distance up to which modules are in one place.
const SAME: f64 = 1e-6;

/// Limit of the number of productions shown.
const MAX_PRODUCTIONS: usize = 24;
/// Limit of the number of modules that are drawn of a word.
const MAX_MODULES: usize = 2_000;
/// Number of steps in which modules are looked for that a production replaces.
const LOOKED_FOR: u32 = 8;
/// Limit of the number of elements of these steps.
const MAX_ELEMENTS: u64 = 20_000;

/// Module of a word: the index of its symbol, with its arguments.
type Module = (usize, Vec<f64>);

/// Lays out a system under a title.
pub(super) fn page<F: ShownFrame + TurtleFrame>(
    system: &F::System,
    document: &LSystemDocument,
    view: F::View,
    title: &str,
) -> Block {
    let font = Font::new();
    let figure = Figure::<F> {
        font: &font,
        system,
        words: F::words(system),
        view,
    };
    let axiom: Vec<Module> = { figure.words.axiom().iter() }
        .map(|module| (module.symbol, module.arguments.clone()))
        .collect();
    let text = document.axiom.as_ref().map_or("", |word| word.place.text());
    let axiom = Block::column(
        vec![
            figure.panels(&[&axiom]).pop().unwrap_or_default(),
            figure.text(text, TEXT),
        ],
        6.0,
        true,
    );
    let count = document.productions.len();
    let both = figure.words.productions().iter().zip(&document.productions);
    let productions = both.take(MAX_PRODUCTIONS);
    let productions =
        productions.map(|(production, written)| figure.production(production, written));
    let mut columns = vec![("axiom", axiom)];
    if count > 0 {
        let productions = Block::flow(productions.collect(), DVec2::new(30.0, 24.0), WIDTH);
        columns.push((plural(count, "production", "productions"), productions));
    }
    let mut notes = Vec::new();
    if let Some(angle) = &document.angle {
        notes.push(format!("+ and - turn by {} degrees", angle.place.text()));
    }
    if let Some(more @ 1..) = count.checked_sub(MAX_PRODUCTIONS) {
        let are = plural(more, "production is", "productions are");
        notes.push(format!("{more} more {are} not shown"));
    }
    let source = figure.words.metadata().description.source.as_deref();
    let head = [title, source.unwrap_or_default()];
    lay_out(&font, columns, head, |_| Block::default(), &notes)
}

struct Figure<'a, F: ShownFrame + TurtleFrame> {
    font: &'a Font,
    system: &'a F::System,
    words: &'a LSystem,
    view: F::View,
}

/// Drawing of a word, as seen.
#[derive(Default)]
struct Sketch {
    lines: Vec<([DVec2; 2], ElementRole, char)>,
    shapes: Vec<(Outline, ElementRole)>,
    /// Places and directions of modules that are replaced and draw nothing, with the symbols that are there.
    modules: Vec<([DVec2; 2], String)>,
}

impl<F: ShownFrame + TurtleFrame> Figure<'_, F> {
    fn production(&self, production: &Production, written: &ProductionDocument) -> Block {
        let mut slots = self.slots(production);
        for variable in &production.variables {
            let typical = variable.typical(&slots);
            slots.push(typical);
        }
        let left = self.arity(&production.left);
        let own = self.words.symbols()[production.predecessor].arity;
        let replaced = vec![(production.predecessor, slots[left..left + own].to_vec())];
        let successor = production.successor.iter().take(MAX_MODULES).map(|module| {
            let arguments = module.arguments.iter().map(|it| it.eval(&slots));
            (module.symbol, arguments.collect())
        });
        let successor: Vec<Module> = successor.collect();
        let panels = self.panels(&[&replaced, &successor]);
        let becomes = Block {
            size: DVec2::new(30.0, 12.0),
            items: vec![BlockItem::Path(
                arrow([DVec2::new(0.0, 6.0), DVec2::new(30.0, 6.0)]).into(),
                ink::hairline(),
                Some("->"),
            )],
        };
        let [before, after] = <[Block; 2]>::try_from(panels).unwrap_or_default();
        let drawn = Block::row(vec![before, becomes, after], 14.0);
        let text = self.text(&described(written), drawn.size.x.max(TEXT));
        Block::column(vec![drawn, text], 6.0, true)
    }

    fn text(&self, text: &str, width: f64) -> Block {
        let lines = self.font.wrap(&shortened(text), WORDS, width);
        Block::text(self.font, lines, WORDS, true)
    }

    fn arity(&self, symbols: &[usize]) -> usize {
        { symbols.iter() }
            .map(|symbol| self.words.symbols()[*symbol].arity)
            .sum()
    }

    /// Returns the arguments with which a production is applied first, or 1 for each if it is not applied soon. Arguments of
    /// contexts are 1.
    fn slots(&self, production: &Production) -> Vec<f64> {
        let right = production.right.iter().filter_map(|it| match it {
            Context::Symbol(symbol) => Some(*symbol),
            Context::Open | Context::Close => None,
        });
        let [left, right] = [&production.left, &right.collect()].map(|it| self.arity(it));
        let own = self.words.symbols()[production.predecessor].arity;
        let mut slots = vec![1.0; left + own + right];
        if own == 0 {
            return slots;
        }
        for steps in 0..=LOOKED_FOR {
            let mut found = None;
            let read = self
                .words
                .read(steps, 0, MAX_ELEMENTS, |symbol, arguments| {
                    if symbol == production.predecessor && found.is_none() {
                        slots[left..left + own].copy_from_slice(arguments);
                        let condition = production.condition.as_ref();
                        if condition.is_none_or(|condition| condition.holds(&slots)) {
                            found = Some(slots.clone());
                        }
                    }
                });
            if let Some(slots) = found {
                return slots;
            }
            if read.is_err() {
                break;
            }
        }
        slots[left..left + own].fill(1.0);
        slots
    }

    fn sketch(&self, word: &[Module]) -> Sketch {
        let mut turtle = Turtle::<F>::new(self.system);
        let mut sketch = Sketch::default();
        let seen = |point| F::seen(point, self.view);
        for (symbol, arguments) in word.iter().take(MAX_MODULES) {
            let at = turtle.pose().map(seen);
            turtle.read(*symbol, arguments);
            let symbol = &self.words.symbols()[*symbol];
            let fertile = !symbol.productions.is_empty();
            let role = ElementRole::of(fertile, false);
            let drawn = std::mem::take(&mut turtle.drawing.elements);
            if drawn.is_empty() && fertile {
                sketch.add_module(at, symbol.character);
            }
            for placed in drawn {
                let image = |point| seen(placed.frame.map().apply(point));
                match placed.of {
                    Drawn::Line(_) => {
                        let ends = [F::Point::ZERO, F::Point::AXES[0]].map(image);
                        sketch.lines.push((ends, role, symbol.character));
                    }
                    Drawn::Polygon(number) if turtle.drawing.empty.contains(&number) => {}
                    Drawn::Polygon(number) => {
                        let corners = F::corners(&turtle.drawing.polygons[number]);
                        let corners = corners.into_iter().map(image);
                        sketch.shapes.extend(closed(corners).map(|it| (it, role)));
                    }
                    Drawn::Stamp(number) => {
                        let stamp = &F::stamps(self.system)[number];
                        let outlines = F::outlined(stamp, &placed.frame, self.view);
                        sketch
                            .shapes
                            .extend(outlines.into_iter().map(|it| (it, role)));
                    }
                }
            }
        }
        sketch
            .lines
            .retain(|(ends, ..)| ends.iter().all(|end| can_be_drawn(*end)));
        sketch
            .modules
            .retain(|(ends, _)| ends.iter().all(|end| can_be_drawn(*end)));
        sketch
    }

    /// Returns panels of words, in one scale.
    fn panels(&self, words: &[&[Module]]) -> Vec<Block> {
        let sketches: Vec<Sketch> = words.iter().map(|word| self.sketch(word)).collect();
        let sizes = sketches
            .iter()
            .map(|sketch| sketch.bounds().size().max_element());
        let size = sizes.fold(0.0, f64::max);
        let step = STEP / self.words.length();
        let unit = if size > 0.0 {
            step.max(STEP / size).min(MOST / size)
        } else {
            step
        };
        let attempt = |(zoom, marks): (f64, f64), clear: bool| -> Option<Vec<Block>> {
            let blocks = sketches
                .iter()
                .map(|it| it.block(self.font, unit * zoom, marks, clear));
            blocks.collect()
        };
        let found = ATTEMPTS.into_iter().find_map(|it| attempt(it, true));
        let found = found.or_else(|| attempt(LAST_ATTEMPT, false));
        found.unwrap_or_default()
    }
}

impl Sketch {
    /// Adds a module that draws nothing: to others in its place and direction, if there are any.
    fn add_module(&mut self, at: [DVec2; 2], symbol: char) {
        let mut modules = self.modules.iter_mut();
        let same = modules.find(|(known, _)| {
            let mut ends = known.iter().zip(at);
            ends.all(|(a, b)| a.distance(b) <= SAME)
        });
        match same {
            Some((_, symbols)) if symbols.contains(symbol) => {}
            Some((_, symbols)) => symbols.push(symbol),
            None => self.modules.push((at, symbol.into())),
        }
    }

    fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        bounds.add(DVec2::ZERO);
        let lines = self.lines.iter().flat_map(|(ends, ..)| *ends);
        let shapes = self.shapes.iter();
        let shapes = shapes.flat_map(|(outline, _)| flattened(outline).flatten());
        let modules = self.modules.iter().map(|([at, _], _)| *at);
        lines
            .chain(shapes)
            .chain(modules)
            .for_each(|point| bounds.add(point));
        bounds
    }

    /// Draws the sketch with a number of pixels in a unit and a size of marks; `None` if marks have to be `clear` and are
    /// not.
    fn block(&self, font: &Font, unit: f64, size: f64, clear: bool) -> Option<Block> {
        let bounds = self.bounds();
        let map = DAffine2::from_scale(DVec2::new(unit, -unit))
            * DAffine2::from_translation(-DVec2::new(bounds.min().x, bounds.max().y));
        let place = |point: DVec2| map.transform_point2(point);
        let start = place(DVec2::ZERO);
        let mut items = Vec::new();
        for (outline, role) in &self.shapes {
            let outline = outline.transformed(&map);
            let paint = role.outline(outline.closed);
            items.push(BlockItem::Path(vec![outline], paint, None));
        }
        let (mut marks, mut obstacles) = (Vec::new(), Vec::new());
        let mark = |anchor, name: String| Mark {
            anchor,
            number: String::new(),
            fertile: false,
            name,
            colour: ElementRole::Fertile.colour(),
        };
        for role in [ElementRole::Infertile, ElementRole::Fertile] {
            let of = self.lines.iter().filter(|(_, it, _)| *it == role);
            let mut lines = Vec::new();
            for (ends, _, character) in of {
                let [from, to] = ends.map(place);
                lines.push(Outline::line(from, to));
                obstacles.push(Obstacle::element(from, to));
                if role == ElementRole::Fertile {
                    lines.extend(arrowhead([from, to]));
                    marks.push(mark(Anchor::Element(from, to), character.to_string()));
                }
            }
            if !lines.is_empty() {
                items.push(BlockItem::Path(lines, role.element(true), None));
            }
        }
        let mut tips = Vec::new();
        for ([at, ahead], symbols) in &self.modules {
            let [from, to] = [*at, *ahead].map(place);
            let tip = from + (to - from).normalize_or_zero() * ARROW;
            items.push(BlockItem::Path(
                arrow([from, tip]).into(),
                ink::normal(ElementRole::Fertile.colour()),
                None,
            ));
            obstacles.push(Obstacle::element(from, tip));
            marks.push(mark(Anchor::Element(from, tip), symbols.clone()));
            tips.push(tip);
        }
        let ring = vec![Outline::circle(start, 4.0)];
        items.push(BlockItem::Path(ring, ink::side_end(), None));
        if marks.len() > MAX_MARKS {
            marks.clear();
        }
        let mut corners = vec![start - 4.0, start + 4.0];
        corners.extend(tips);
        let placed = marks::place(font, &marks, &obstacles, size, clear)?;
        items.extend(placed.block.items);
        corners.extend(placed.corners);
        let size = bounds.size() * unit;
        Some(with_room(Block { size, items }, &corners))
    }
}

/// Returns the closed outline through points.
fn closed(mut points: impl Iterator<Item = DVec2>) -> Option<Outline> {
    let start = points.next()?;
    let pieces = points.chain([start]).map(crate::rule::Piece::Line);
    Some(Outline {
        start,
        pieces: pieces.collect(),
        closed: true,
    })
}

/// Returns a production as it is written.
fn described(written: &ProductionDocument) -> String {
    fn module(module: &ModuleDocument) -> &str {
        module.place.text()
    }
    let context = |modules: &[ModuleDocument]| modules.iter().map(module).collect::<String>();
    let mut text = module(&written.predecessor).to_owned();
    if !written.left.is_empty() {
        text = format!("{} < {text}", context(&written.left));
    }
    if !written.right.is_empty() {
        text.push_str(&format!(" > {}", context(&written.right)));
    }
    if let Some(condition) = &written.condition {
        text.push_str(&format!(" : {}", condition.place.text()));
    }
    let successor = &written.successor.place;
    if successor.range() == written.predecessor.place.range() {
        // A production in a folded text has the place of all of it.
        text = successor.text().to_owned();
    } else {
        text.push_str(&format!(" -> {}", successor.text()));
    }
    if let Some(weight) = &written.weight {
        text.push_str(&format!(" (weight {})", weight.place.text()));
    }
    text
}
