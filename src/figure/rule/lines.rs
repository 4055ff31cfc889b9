//! Lines of a panel: sides, elements, base elements, arrowheads and dots.

use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::rule::{BaseElement, Piece};

use super::block::{BlockItem, Outline};
use super::ink::{self, ElementRole};
use super::panel::{Panel, PanelElement};

impl Panel<'_> {
    /// Returns the lines of a panel, back to front.
    pub(super) fn lines(&self, drawn: &[PanelElement<'_>], map: &DAffine2) -> Vec<BlockItem> {
        let place = |point: DVec2| map.transform_point2(point);
        let mut items = Vec::new();
        let ends = self.replaced;
        if let Some([from, to]) = ends.filter(|side| !drawn.iter().any(|it| it.ends == *side)) {
            let side = Outline::line(place(from), place(to));
            items.push(BlockItem::Path(vec![side], ink::side(), None));
        }
        // The kinds and visibilities that occur, in order of first occurrence.
        let mut styles: Vec<(ElementRole, bool)> = Vec::new();
        for element in drawn {
            let style = (element.kind, element.element.visible);
            if !styles.contains(&style) {
                styles.push(style);
            }
        }
        let of = |(kind, visible): (ElementRole, bool)| {
            let is = move |it: &&PanelElement<'_>| it.kind == kind && it.element.visible == visible;
            drawn.iter().filter(is)
        };
        for &style in &styles {
            let draws = self
                .draws
                .iter()
                .flat_map(|points| self.ends(points, style.0));
            let draws: Vec<_> = draws
                .map(|[from, to]| Outline::line(place(from), place(to)))
                .collect();
            if !draws.is_empty() {
                items.push(BlockItem::Path(draws, style.0.draw(), None));
            }
        }
        for &style in &styles {
            for closed in [true, false] {
                let outlines = of(style).flat_map(|element| &element.shape.outlines);
                let outlines = outlines.filter(|outline| outline.closed == closed);
                let outlines: Vec<_> = outlines.map(|it| it.transformed(map)).collect();
                if !outlines.is_empty() {
                    items.push(BlockItem::Path(outlines, style.0.outline(closed), None));
                }
            }
        }
        for &style in &styles {
            let ends = || of(style).map(|element| (element, element.ends.map(place)));
            let lines = ends().map(|(_, [from, to])| Outline::line(from, to));
            items.push(BlockItem::Path(
                lines.collect(),
                style.0.element(style.1),
                None,
            ));
            let arrows = ends().filter(|(element, _)| element.arrow);
            let arrows: Vec<_> = arrows.filter_map(|(_, ends)| arrowhead(ends)).collect();
            if !arrows.is_empty() {
                items.push(BlockItem::Path(arrows, style.0.element(true), None));
            }
            let mut points: Vec<_> = ends().flat_map(|(_, ends)| ends).collect();
            points.dedup();
            let dots = points.into_iter().map(|point| Outline::line(point, point));
            let dots = dots.collect();
            let paint = ink::dots(style.0.colour(), 4.6);
            items.push(BlockItem::Path(dots, paint, None));
        }
        for &style in &styles {
            let normals = of(style).filter_map(|element| element.shape.normal);
            let arrows: Vec<_> = { normals }
                .flat_map(|ends| arrow(ends.map(place)))
                .collect();
            if !arrows.is_empty() {
                items.push(BlockItem::Path(arrows, ink::normal(style.0.colour()), None));
            }
        }
        if let Some(side) = self.replaced {
            let rings = side.map(|end| Outline::circle(place(end), 4.6));
            items.push(BlockItem::Path(rings.into(), ink::side_end(), None));
        }
        items
    }
}

/// Returns the outline of a base element in the unit frame.
pub(super) fn outline(base: &BaseElement) -> Outline {
    Outline {
        start: base.start(),
        pieces: base.pieces().to_vec(),
        closed: base.is_closed(),
    }
}

/// Returns an arrow from one point to another: its shaft and its head.
pub(super) fn arrow([foot, tip]: [DVec2; 2]) -> [Outline; 2] {
    const SIZE: f64 = 4.5;
    let along = (tip - foot).normalize_or_zero();
    let size = SIZE.min(foot.distance(tip) / 2.0);
    let (back, aside) = (tip - along * size, along.perp() * 0.6 * size);
    let head = Outline {
        start: back + aside,
        pieces: vec![Piece::Line(tip), Piece::Line(back - aside)],
        closed: false,
    };
    [Outline::line(foot, tip), head]
}

/// Returns an open arrowhead behind the middle of an element; `None` if the element is too short.
pub(super) fn arrowhead([from, to]: [DVec2; 2]) -> Option<Outline> {
    const SIZE: f64 = 5.5;
    let along = (to - from).normalize_or_zero();
    let tip = from.lerp(to, 0.6) + along * 0.4 * SIZE;
    let (back, aside) = (tip - along * SIZE, along.perp() * 0.7 * SIZE);
    (from.distance(to) > 3.0 * SIZE).then(|| Outline {
        start: back + aside,
        pieces: vec![Piece::Line(tip), Piece::Line(back - aside)],
        closed: false,
    })
}

/// Returns the bounding box of outlines.
pub(super) fn bounds_of<'a>(outlines: impl IntoIterator<Item = &'a Outline>) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    let ends = { outlines.into_iter() }.flat_map(flattened).flatten();
    ends.for_each(|end| bounds.add(end));
    bounds
}

/// Iterates over line segments along an outline; a cubic becomes eight.
pub(super) fn flattened(outline: &Outline) -> impl Iterator<Item = [DVec2; 2]> + use<> {
    let mut points = vec![outline.start];
    let mut from = outline.start;
    for piece in &outline.pieces {
        if let Piece::Cubic(a, b, to) = *piece {
            points.extend((1..8u32).map(|eighth| {
                let t = f64::from(eighth) / 8.0;
                let (p, q, r) = (from.lerp(a, t), a.lerp(b, t), b.lerp(to, t));
                p.lerp(q, t).lerp(q.lerp(r, t), t)
            }));
        }
        from = piece.end();
        points.push(from);
    }
    let next = points.clone().into_iter().skip(1);
    points.into_iter().zip(next).map(|(a, b)| [a, b])
}
