//! Order of polygons from the back to the front, in which none covers what lies before it.
//!
//! Of two polygons that overlap on the picture, the nearer is drawn later (Newell, Newell & Sancha 1972). One that
//! crosses another is split along their common line. Polygons that cover each other in a circle are divided by the
//! plane of one of them (Fuchs, Kedem & Naylor 1980), and each side is arranged by itself.

use crate::digraph::components;

use super::grid::Grid;
use super::polygon::{Order, Plane, Polygon};

/// Largest number of rounds in which crossing polygons are split; what crosses after them is a rounding error.
const MAX_ROUNDS: usize = 16;

/// A polygon with the number of the face that it is a part of.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) polygon: Polygon,
    pub(super) face: usize,
}

impl Piece {
    /// Returns the parts behind a plane and before it.
    fn split(&self, plane: &Plane) -> [Option<Self>; 2] {
        let face = self.face;
        { self.polygon.split(plane) }.map(|part| part.map(|polygon| Self { polygon, face }))
    }
}

/// Returns the pieces from the back to the front, some of them divided. Of pieces in one plane, those of the first
/// face lie on top; differences of nearness up to `tolerance` are none.
pub(super) fn arranged(mut pieces: Vec<Piece>, tolerance: f64) -> Vec<Piece> {
    let mut round = 0;
    let behind = loop {
        let (behind, crossings) = relations(&pieces, tolerance);
        if crossings.is_empty() || round == MAX_ROUNDS {
            break behind;
        }
        round += 1;
        pieces = divided(pieces, &crossings);
    };
    // No edge leads to a later component: each piece leads to those behind it.
    let component = components(&behind);
    let mut groups: Vec<Vec<Piece>> = Vec::new();
    for (piece, number) in pieces.into_iter().zip(component) {
        if groups.len() <= number {
            groups.resize_with(number + 1, Vec::new);
        }
        groups[number].push(piece);
    }
    let mut all = Vec::new();
    for group in groups {
        match group.len() {
            1 => all.extend(group),
            _ => all.extend(around_a_plane(group, tolerance)),
        }
    }
    all
}

/// Returns the pieces that each one is nearer than, and the pairs of pieces that cross.
fn relations(pieces: &[Piece], tolerance: f64) -> (Vec<Vec<usize>>, Vec<[usize; 2]>) {
    let grid = Grid::new(pieces.iter().map(|piece| *piece.polygon.bounds()));
    let (mut behind, mut crossings) = (vec![Vec::new(); pieces.len()], Vec::new());
    grid.each_pair(|[a, b]| {
        let order = pieces[a].polygon.order(&pieces[b].polygon, tolerance);
        match order {
            Order::Apart => {}
            Order::Before => behind[a].push(b),
            Order::Behind => behind[b].push(a),
            Order::Level if pieces[a].face <= pieces[b].face => behind[a].push(b),
            Order::Level => behind[b].push(a),
            Order::Crossing => crossings.push([a, b]),
        }
    });
    { behind.iter_mut() }.for_each(|all| all.sort_unstable());
    (behind, crossings)
}

/// Divides the second piece of every pair by the plane of the first.
fn divided(pieces: Vec<Piece>, crossings: &[[usize; 2]]) -> Vec<Piece> {
    let mut planes: Vec<Vec<Plane>> = vec![Vec::new(); pieces.len()];
    for &[a, b] in crossings {
        planes[b].push(*pieces[a].polygon.plane());
    }
    let divided = pieces.into_iter().zip(planes).flat_map(|(piece, planes)| {
        let mut parts = vec![piece];
        for plane in planes {
            parts = { parts.iter() }
                .flat_map(|part| part.split(&plane))
                .flatten()
                .collect();
        }
        parts
    });
    divided.collect()
}

/// Arranges pieces around the plane of the largest: those behind it, the piece, and those before it.
fn around_a_plane(mut pieces: Vec<Piece>, tolerance: f64) -> Vec<Piece> {
    let area = |piece: &Piece| {
        let size = piece.polygon.bounds().size();
        size.x * size.y
    };
    let all = pieces.iter().enumerate();
    let largest = all.max_by(|(a, first), (b, second)| {
        let areas = area(first).total_cmp(&area(second));
        areas.then(b.cmp(a))
    });
    let Some(largest) = largest.map(|(number, _)| number) else {
        return pieces;
    };
    let middle = pieces.remove(largest);
    let plane = *middle.polygon.plane();
    let (mut behind, mut before) = (Vec::new(), Vec::new());
    for piece in pieces {
        let away = { piece.polygon.corners().iter() }
            .map(|corner| corner.at.z - plane.at(corner.at.truncate()));
        let (least, most) = away.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), it| {
            (least.min(it), most.max(it))
        });
        match (least >= -tolerance, most <= tolerance) {
            (true, true) if piece.face < middle.face => before.push(piece),
            (_, true) => behind.push(piece),
            (true, false) => before.push(piece),
            (false, false) => {
                let [back, front] = piece.split(&plane);
                behind.extend(back);
                before.extend(front);
            }
        }
    }
    let mut all = arranged(behind, tolerance);
    all.push(middle);
    all.extend(arranged(before, tolerance));
    all
}
