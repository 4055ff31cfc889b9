//! Marks beside elements and points: asterisks, numbers and names, placed where they cover nothing if
//! possible.

use crate::geometry::DVec2;
use crate::render::Paint;
use crate::style::Colour;

use super::super::text::Font;
use super::block::{Block, BlockItem, Outline};
use super::ink;

/// Font size of marks, in pixels.
const TEXT: f64 = 12.5;
/// Radius of asterisks, in pixels.
const ASTERISK: f64 = 4.2;
/// Space around marks, in pixels.
const CLEAR: f64 = 2.0;

/// Cost of a place where a mark would cover another one or an element.
const BLOCKED: f64 = 1000.0;

/// The element or point that a mark belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    /// An element from one point to another.
    Element(DVec2, DVec2),
    /// A single point.
    Point(DVec2),
}

/// A mark: a number, an asterisk and a name, in this order.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    pub(super) anchor: Anchor,
    pub(super) number: String,
    pub(super) fertile: bool,
    pub(super) name: String,
    pub(super) colour: Colour,
}

/// A line that marks avoid, and the cost of covering it.
pub(super) struct Obstacle {
    pub(super) ends: [DVec2; 2],
    pub(super) cost: f64,
}

impl Obstacle {
    /// Returns a line that no mark may cover.
    pub(super) fn element(from: DVec2, to: DVec2) -> Self {
        Self {
            ends: [from, to],
            cost: BLOCKED,
        }
    }
}

/// A box, given by its centre and half its size.
#[derive(Clone, Copy, Debug)]
struct Bounding {
    centre: DVec2,
    half: DVec2,
}

impl Bounding {
    fn meets(&self, other: &Self) -> bool {
        let apart = (self.centre - other.centre).abs();
        let room = self.half + other.half + CLEAR;
        apart.x < room.x && apart.y < room.y
    }

    /// Returns whether a line segment comes close to the box, by separating axes.
    fn meets_line(&self, [from, to]: [DVec2; 2]) -> bool {
        let half = self.half + CLEAR;
        let (middle, reach) = (from.midpoint(to) - self.centre, (to - from) / 2.0);
        let across = reach.perp();
        middle.x.abs() <= half.x + reach.x.abs()
            && middle.y.abs() <= half.y + reach.y.abs()
            && middle.dot(across).abs() <= half.dot(across.abs())
    }
}

impl Mark {
    /// Returns the widths of number, asterisk and name, with the gaps before the second and the third.
    fn widths(&self, font: &Font, size: f64) -> [f64; 3] {
        let width = |text: &str| font.width(text, TEXT * size);
        let (number, name) = (width(&self.number), width(&self.name));
        let star = if self.fertile {
            2.0 * ASTERISK * size
        } else {
            0.0
        };
        let gap = |before: f64, own: f64| if before > 0.0 && own > 0.0 { 1.5 } else { 0.0 };
        let star_gap = gap(number, star);
        [
            number,
            star + star_gap,
            name + 2.0 * gap(number + star, name),
        ]
    }

    fn half(&self, font: &Font, size: f64) -> DVec2 {
        let width: f64 = self.widths(font, size).iter().sum();
        let height = if self.number.is_empty() && self.name.is_empty() {
            2.0 * ASTERISK
        } else {
            // Digits, ascenders and part of the descenders.
            0.86 * TEXT
        };
        DVec2::new(width, height * size) / 2.0
    }

    /// Returns candidate positions of the mark's centre, each with its cost.
    fn places(&self, half: DVec2) -> Vec<(DVec2, f64)> {
        let reach = |normal: DVec2| half.dot(normal.abs());
        let mut places = Vec::new();
        match self.anchor {
            Anchor::Element(from, to) => {
                let along = to - from;
                // With y down, the left of the element is the negated perpendicular.
                let left = -along.perp().normalize_or(DVec2::Y);
                for (side, other) in [(left, 0.0), (-left, 30.0)] {
                    for off in [0.0, 4.0, 9.0, 16.0] {
                        for aside in [0.0, -0.08, 0.08, -0.16, 0.16, -0.24, 0.24, -0.32, 0.32] {
                            let at = from + along * (0.5 + aside);
                            let cost = other + off + 30.0 * f64::abs(aside);
                            places.push((at + side * (reach(side) + 5.0 + off), cost));
                        }
                    }
                }
            }
            Anchor::Point(point) => {
                for off in [0.0, 3.0, 7.0, 12.0, 20.0] {
                    for eighth in 0..16u32 {
                        let angle = f64::from(eighth) * std::f64::consts::PI / 8.0;
                        let out = DVec2::new(libm::cos(angle), -libm::sin(angle));
                        places.push((point + out * (reach(out) + 4.5 + off), off));
                    }
                }
            }
        }
        places
    }

    /// Returns the mark as a block, centred at a point.
    fn block(&self, font: &Font, size: f64, centre: DVec2) -> Block {
        let [number, star, name] = self.widths(font, size);
        let mut block = Block::default();
        let mut left = centre.x - (number + star + name) / 2.0;
        // The baseline lies half the height of a digit below the centre.
        let baseline = centre.y + 0.357 * TEXT * size;
        let mut text = |text: &str, left: f64| {
            if !text.is_empty() {
                let at = DVec2::new(left, baseline);
                block
                    .items
                    .push(BlockItem::Text(text.into(), TEXT * size, at, self.colour));
            }
        };
        text(&self.number, left);
        text(
            &self.name,
            left + number + star + name - font.width(&self.name, TEXT * size),
        );
        left += number + star;
        if self.fertile {
            let raised = if self.number.is_empty() { 0.0 } else { 1.5 };
            let at = DVec2::new(left - ASTERISK * size, centre.y - raised * size);
            let (strokes, paint) = asterisk(at, size, self.colour);
            block.items.push(BlockItem::Path(strokes, paint, Some("*")));
        }
        block
    }
}

/// Returns the strokes of an asterisk with six points, and their paint.
pub(super) fn asterisk(at: DVec2, size: f64, colour: Colour) -> (Vec<Outline>, Paint) {
    let strokes = [90.0f64, 30.0, 150.0].map(|angle| {
        let angle = angle.to_radians();
        let out = DVec2::new(libm::cos(angle), libm::sin(angle)) * (ASTERISK - 0.7) * size;
        Outline::line(at - out, at + out)
    });
    (strokes.into(), ink::asterisk(colour, size))
}

/// Marks after placement.
pub(super) struct PlacedMarks {
    pub(super) block: Block,
    /// Corners of the boxes that the marks cover.
    pub(super) corners: Vec<DVec2>,
}

/// Places marks in their order, each at the least cost. With `clear`, returns `None` if a mark would cover
/// another one or an element.
pub(super) fn place(
    font: &Font,
    marks: &[Mark],
    obstacles: &[Obstacle],
    size: f64,
    clear: bool,
) -> Option<PlacedMarks> {
    let mut taken: Vec<Bounding> = Vec::new();
    let mut placed = PlacedMarks {
        block: Block::default(),
        corners: Vec::new(),
    };
    for mark in marks {
        let half = mark.half(font, size);
        let covered = |centre: DVec2| {
            let own = Bounding { centre, half };
            let lines = obstacles.iter().filter(|it| own.meets_line(it.ends));
            let marks = taken.iter().filter(|other| own.meets(other));
            lines.map(|it| it.cost).sum::<f64>() + marks.map(|_| BLOCKED).sum::<f64>()
        };
        let mut places = mark.places(half);
        places.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut best = (DVec2::ZERO, f64::INFINITY);
        for (centre, cost) in places {
            // Later places cost more even if they cover nothing.
            if cost >= best.1 {
                break;
            }
            let cost = cost + covered(centre);
            if cost < best.1 {
                best = (centre, cost);
            }
        }
        let (centre, cost) = best;
        if clear && cost >= BLOCKED {
            return None;
        }
        placed.corners.extend([centre - half, centre + half]);
        placed
            .block
            .put(mark.block(font, size, centre), DVec2::ZERO);
        taken.push(Bounding { centre, half });
    }
    Some(placed)
}
