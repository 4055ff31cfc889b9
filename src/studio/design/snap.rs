//! Snapping: where a dragged point comes to rest.

use serde::{Deserialize, Serialize};

use super::nice;
use super::scene::Panel;

/// Lattice to which points snap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Grid {
    Square,
    Triangular,
}

/// How a point snaps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Snapping {
    pub(super) grid: Option<Grid>,
    /// Number of cells in the unit length.
    pub(super) parts: u32,
    /// Whether directions are multiples of 15 degrees.
    pub(super) angles: bool,
    /// Distance within which a point snaps.
    pub(super) reach: f64,
    /// Length of a pixel.
    pub(super) pixel: f64,
}

/// A point with what is written for it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(in crate::studio) struct Snapped {
    #[serde(rename = "at")]
    pub(super) place: [f64; 2],
    pub(super) text: [String; 2],
    /// To what it snaps, in words; `None` if it is free.
    pub(super) to: Option<String>,
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

impl Snapping {
    /// Returns where a point comes to rest: on another point, or else in a direction, on the grid, at the height or beside
    /// another point. `own` is the point itself, and `before` the start of the element that ends in it.
    pub(super) fn snap(
        &self,
        panel: &Panel,
        own: Option<usize>,
        before: Option<[f64; 2]>,
        place: [f64; 2],
    ) -> Snapped {
        let others = panel.points.iter().enumerate();
        let others = others
            .filter(|(index, _)| Some(*index) != own)
            .map(|(_, it)| it);
        let near = others
            .clone()
            .filter(|it| distance([it.x, it.y], place) <= self.reach)
            .min_by(|a, b| distance([a.x, a.y], place).total_cmp(&distance([b.x, b.y], place)));
        if let Some(point) = near
            && !self.angles
        {
            let text = match point.text[1].is_empty() {
                true => [point.x, point.y].map(|value| nice::decimals(value, 1e-9)),
                false => point.text.clone(),
            };
            return Snapped {
                place: [point.x, point.y],
                text,
                to: Some("a point".into()),
            };
        }
        if let (true, Some(before)) = (self.angles, before) {
            return self.written(self.turned(before, place), "a direction");
        }
        if let Some(grid) = self.grid {
            return self.written(self.on(grid, place), "the grid");
        }
        self.aligned(others.map(|it| [it.x, it.y]), place)
    }

    fn written(&self, place: [f64; 2], to: &str) -> Snapped {
        Snapped {
            place,
            text: place.map(|value| nice::written(value, true, self.pixel)),
            to: Some(to.to_owned()),
        }
    }

    /// Returns the nearest place in a direction that is a multiple of 15 degrees, at a length that is a nice number where
    /// one is near.
    fn turned(&self, from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        let angle = (libm::atan2(y, x).to_degrees() / 15.0).round() * 15.0;
        let length = libm::hypot(x, y);
        let parts = f64::from(self.parts.max(1));
        let whole = (length * parts).round() / parts;
        let near = (length - whole).abs() <= self.reach && whole > 0.0;
        let length = if near { whole } else { length };
        let (sin, cos) = (
            crate::expression::degrees::sin(angle),
            crate::expression::degrees::cos(angle),
        );
        [from[0] + length * cos, from[1] + length * sin]
    }

    fn on(&self, grid: Grid, [x, y]: [f64; 2]) -> [f64; 2] {
        let parts = f64::from(self.parts.max(1));
        match grid {
            Grid::Square => [x, y].map(|value| (value * parts).round() / parts),
            Grid::Triangular => {
                let high = libm::sqrt(3.0) / 2.0;
                let row = (y / high * parts).round();
                let odd = 0.5 * (row.rem_euclid(2.0));
                [
                    ((x * parts - odd).round() + odd) / parts,
                    row * high / parts,
                ]
            }
        }
    }

    /// Returns a place at the height or beside other points, where there are some near.
    fn aligned(&self, others: impl Iterator<Item = [f64; 2]> + Clone, place: [f64; 2]) -> Snapped {
        let reach = self.reach / 2.0;
        let nearest = |axis: usize| {
            let all = others.clone().map(|it| it[axis]);
            all.filter(|value| (value - place[axis]).abs() <= reach)
                .min_by(|a, b| (a - place[axis]).abs().total_cmp(&(b - place[axis]).abs()))
        };
        let lines = [nearest(0), nearest(1)];
        let text = [0, 1].map(|axis| match lines[axis] {
            Some(value) => nice::written(value, true, self.pixel),
            None => nice::decimals(place[axis], self.pixel),
        });
        let words: Vec<_> = [(0, "beside a point"), (1, "the height of a point")]
            .into_iter()
            .filter(|(axis, _)| lines[*axis].is_some())
            .map(|(_, words)| words)
            .collect();
        Snapped {
            place: [0, 1].map(|axis| lines[axis].unwrap_or(place[axis])),
            text,
            to: (!words.is_empty()).then(|| words.join(", ")),
        }
    }
}
