//! Panels: a list of elements in place, the initiator or a generator over the side that it replaces.

use crate::geometry::{Bounds, DAffine2, DVec2, Direction};
use crate::rule::{ListedElement, Part};

use super::super::text::Font;
use super::block::{Block, Outline};
use super::ink::ElementRole;
use super::lines::{arrowhead, flattened};
use super::marks::{self, Anchor, Mark, Obstacle};

/// Limit of the number of elements that are drawn with marks.
pub(super) const MAX_MARKS: usize = 400;

/// Limit of the coordinates that are drawn.
const FARTHEST: f64 = 1e100;

/// Base element in the place of an element, as seen.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// Outlines, from the back to the front; none for one that is just the element's line.
    pub(super) outlines: Vec<Outline>,
    pub(super) bounds: Bounds,
    /// Foot and tip of an arrow along the normal of the front, in space.
    pub(super) normal: Option<[DVec2; 2]>,
}

impl Shape {
    /// Nothing beside the line of an element.
    pub(super) const NONE: Self = Self {
        outlines: Vec::new(),
        bounds: Bounds::EMPTY,
        normal: None,
    };
}

/// Content of a panel, in the units of the rule.
pub(super) struct Panel<'a> {
    pub(super) parts: &'a [Part],
    /// Points as seen.
    pub(super) points: Vec<DVec2>,
    /// Base elements in the places of the elements, in the order of listing across parts.
    pub(super) shapes: Vec<Shape>,
    /// Points of other draws.
    pub(super) draws: Vec<Vec<DVec2>>,
    /// Indices of the points that are labelled with their numbers.
    pub(super) named: Vec<usize>,
    /// Ends of the side that a generator replaces.
    pub(super) replaced: Option<[DVec2; 2]>,
    pub(super) common: &'a Common<'a>,
}

/// Data that all panels of a figure share.
pub(super) struct Common<'a> {
    pub(super) font: Font,
    /// Whether each base element is closed.
    pub(super) closed: Vec<bool>,
    /// Names of the generators, for elements that name theirs.
    pub(super) names: Vec<&'a str>,
    /// Whether elements are labelled with their directions.
    pub(super) directions: bool,
}

/// Target size of a panel, in pixels.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    /// Length of a unit of the rule, unless elements are too short or the panel too large.
    pub(super) unit: f64,
    /// Width and height that the panel fits into, unless marks need more.
    pub(super) most: DVec2,
}

/// A drawable element.
pub(super) struct PanelElement<'a> {
    pub(super) element: &'a ListedElement,
    pub(super) shape: &'a Shape,
    pub(super) kind: ElementRole,
    pub(super) ends: [DVec2; 2],
    /// Whether the element has an arrowhead.
    pub(super) arrow: bool,
}

/// Factors of a panel's size and of its marks' size, tried in this order until marks cover nothing.
pub(super) const ATTEMPTS: [(f64, f64); 9] = [
    (1.0, 1.0),
    (1.0, 0.85),
    (1.25, 0.85),
    (1.25, 0.72),
    (1.6, 0.85),
    (1.6, 0.72),
    (2.0, 0.72),
    (2.0, 0.6),
    (2.6, 0.6),
];

/// Factors where every attempt leaves marks that cover something.
pub(super) const LAST_ATTEMPT: (f64, f64) = (2.0, 0.6);

impl Panel<'_> {
    /// Draws the panel.
    pub(super) fn block(&self, extent: Extent) -> Block {
        let drawn = self.drawn();
        let bounds = self.bounds(&drawn);
        let unit = self.unit(&drawn, &bounds, extent);
        let attempt = |(zoom, size): (f64, f64), clear: bool| {
            let scale = DVec2::new(unit, -unit) * zoom;
            let map = DAffine2::from_scale(scale)
                * DAffine2::from_translation(-DVec2::new(bounds.min().x, bounds.max().y));
            let marks = self.marks(&drawn, &map);
            let obstacles = self.obstacles(&drawn, &map);
            let placed = marks::place(&self.common.font, &marks, &obstacles, size, clear);
            Some((placed?, map))
        };
        let found = ATTEMPTS.into_iter().find_map(|it| attempt(it, true));
        let found = found.or_else(|| attempt(LAST_ATTEMPT, false));
        let Some((placed, map)) = found else {
            unreachable!("marks need not be clear in the last attempt");
        };
        let mut items = self.lines(&drawn, &map);
        items.extend(placed.block.items);
        let size = map.matrix2 * (bounds.max() - bounds.min());
        let size = DVec2::new(size.x, -size.y);
        with_room(Block { size, items }, &placed.corners)
    }

    /// Returns the elements whose ends can be drawn.
    fn drawn(&self) -> Vec<PanelElement<'_>> {
        let mut drawn = Vec::new();
        let mut shapes = self.shapes.iter();
        for part in self.parts {
            let polygons = part
                .elements
                .iter()
                .any(|element| self.common.closed[element.base_element]);
            let chain = part.elements.iter().skip(1).all(|element| element.joined);
            let all = self.common.directions || polygons || !chain;
            for ((number, element), shape) in part.elements.iter().enumerate().zip(&mut shapes) {
                let ends = [self.points[element.from], self.points[element.to]];
                if ends.into_iter().all(can_be_drawn) {
                    drawn.push(PanelElement {
                        element,
                        shape,
                        kind: ElementRole::of(element.fertile, part.placement.seeds()),
                        ends,
                        arrow: all || number == 0,
                    });
                }
            }
        }
        drawn
    }

    fn bounds(&self, drawn: &[PanelElement<'_>]) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        let side = self.replaced.unwrap_or([DVec2::ZERO, DVec2::X]);
        if self.replaced.is_some() || drawn.is_empty() {
            side.into_iter().for_each(|end| bounds.add(end));
        }
        for element in drawn {
            element.ends.iter().for_each(|&end| bounds.add(end));
            bounds.add_all(&element.shape.bounds);
            let normal = element.shape.normal.iter().flatten();
            normal.for_each(|&end| bounds.add(end));
        }
        for kind in ElementRole::ALL {
            for points in &self.draws {
                let ends = self.ends(points, kind);
                ends.iter().flatten().for_each(|&end| bounds.add(end));
            }
        }
        bounds
    }

    /// Returns the ends of all elements of a kind at other points, where they can be drawn.
    pub(super) fn ends(&self, points: &[DVec2], kind: ElementRole) -> Vec<[DVec2; 2]> {
        let mut ends = Vec::new();
        for part in self.parts {
            let seeds = part.placement.seeds();
            let elements = part.elements.iter();
            let alike = elements.filter(|it| ElementRole::of(it.fertile, seeds) == kind);
            ends.extend(alike.map(|it| [points[it.from], points[it.to]]));
        }
        ends.retain(|ends| ends.iter().all(|&end| can_be_drawn(end)));
        ends
    }

    /// Returns the pixels in a unit: more where elements are short, fewer where the panel would be too large.
    fn unit(&self, drawn: &[PanelElement<'_>], bounds: &Bounds, extent: Extent) -> f64 {
        let mut lengths: Vec<_> = drawn
            .iter()
            .map(|element| element.ends[0].distance(element.ends[1]))
            .collect();
        lengths.sort_by(f64::total_cmp);
        let short = lengths.get(lengths.len() / 5).copied().unwrap_or(1.0);
        let room = if self.common.directions { 70.0 } else { 44.0 };
        let size = bounds.size();
        let most = (extent.most.x / size.x).min(extent.most.y / size.y);
        extent.unit.max(room / short).min(most)
    }

    fn marks(&self, drawn: &[PanelElement<'_>], map: &DAffine2) -> Vec<Mark> {
        if drawn.len() > MAX_MARKS {
            return Vec::new();
        }
        let place = |point: DVec2| map.transform_point2(point);
        let mut marks = Vec::new();
        for PanelElement {
            element,
            kind,
            ends,
            ..
        } in drawn
        {
            let number = element.direction.number().to_string();
            let name = element.generator.and_then(|it| self.common.names.get(it));
            marks.push(Mark {
                anchor: Anchor::Element(place(ends[0]), place(ends[1])),
                number: if self.common.directions {
                    number
                } else {
                    String::new()
                },
                fertile: element.fertile,
                name: name.map(|name| (*name).into()).unwrap_or_default(),
                colour: kind.colour(),
            });
        }
        marks.retain(|mark| mark.fertile || !mark.number.is_empty());
        for &number in self.named.iter().take(MAX_MARKS) {
            let point = self.points[number];
            if point.is_finite() {
                marks.push(Mark {
                    anchor: Anchor::Point(place(point)),
                    number: String::new(),
                    fertile: false,
                    name: format!("p{number}"),
                    colour: super::LABEL,
                });
            }
        }
        marks
    }

    /// Returns the lines that marks avoid.
    fn obstacles(&self, drawn: &[PanelElement<'_>], map: &DAffine2) -> Vec<Obstacle> {
        let place = |point: DVec2| map.transform_point2(point);
        let mut obstacles = Vec::new();
        for element in drawn {
            let [from, to] = element.ends.map(place);
            obstacles.push(Obstacle::element(from, to));
            let arrow = element.arrow.then(|| arrowhead([from, to])).flatten();
            let legs = arrow.iter().flat_map(flattened);
            obstacles.extend(legs.map(|[from, to]| Obstacle::element(from, to)));
            for outline in &element.shape.outlines {
                let lines = flattened(&outline.transformed(map));
                obstacles.extend(lines.map(|ends| Obstacle { ends, cost: 12.0 }));
            }
            if let Some([foot, tip]) = element.shape.normal {
                obstacles.push(Obstacle::element(place(foot), place(tip)));
            }
        }
        let draws = self.draws.iter();
        let draws = draws.flat_map(|points| ElementRole::ALL.map(|kind| self.ends(points, kind)));
        obstacles.extend(draws.flatten().map(|ends| Obstacle {
            ends: ends.map(place),
            cost: 3.0,
        }));
        if let Some(side) = self.replaced {
            let ends = side.map(place);
            obstacles.push(Obstacle { ends, cost: 25.0 });
        }
        obstacles
    }
}

/// Returns a block with room for points beyond it: equal on either side, which keeps the drawing in the middle.
pub(super) fn with_room(inside: Block, points: &[DVec2]) -> Block {
    let beyond = points.iter().fold(DVec2::ZERO, |beyond, &point| {
        beyond.max(-point).max(point - inside.size)
    });
    let room = (beyond + 5.0).ceil();
    let mut block = Block::default();
    block.put(inside, room);
    block.size += room;
    block
}

pub(super) fn can_be_drawn(point: DVec2) -> bool {
    point.is_finite() && point.abs().max_element() < FARTHEST
}

/// Returns whether an element has a direction other than normal.
pub(super) fn has_directions(parts: &[Part]) -> bool {
    let mut elements = parts.iter().flat_map(|part| &part.elements);
    elements.any(|element| element.direction != Direction::Normal)
}
