//! Views: pan and zoom, in decimals as long as the magnification requires.

use std::str::FromStr;

use dashu_float::DBig;
use serde::{Deserialize, Serialize};

use crate::expression::degrees::turned;

use super::answer::Refusal;

/// Part of the plane that a picture shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct View {
    /// Coordinates of the middle in the file, before a turn, as decimals.
    pub(super) middle: [String; 2],
    /// Width in the units of the file.
    pub(super) width: f64,
    /// Width of the picture of the whole set.
    pub(super) whole: f64,
}

/// Movement of a view by a hand: a zoom about a point, and a shift.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub(super) struct Gesture {
    /// Magnification.
    pub(super) by: f64,
    /// Point that stays in its place, from the middle, in widths of the picture; y points up.
    pub(super) about: [f64; 2],
    /// Shift of the picture in widths of it; y points up.
    pub(super) shift: [f64; 2],
}

/// Smallest and largest magnification: widths stay doubles.
const LEAST: f64 = 1e-6;
const MOST: f64 = 1e280;

/// Share of its distance from the origin below which a width is too fine for a window in doubles.
const FINE: f64 = 1e-9;

impl View {
    /// Returns the view of a window of a set that is turned by a number of degrees: lower left corner, width, height.
    pub(super) fn of([x, y, width, height]: [f64; 4], turn: f64) -> Self {
        let middle = turned([x + width / 2.0, y + height / 2.0], -turn);
        Self {
            middle: middle.map(|it| it.to_string()),
            width,
            whole: width,
        }
    }

    /// Returns the magnification.
    pub(super) fn factor(&self) -> f64 {
        self.whole / self.width
    }

    /// Returns the view after a gesture, of a set that is turned by a number of degrees.
    pub(super) fn moved(&self, gesture: &Gesture, turn: f64) -> Result<Self, Refusal> {
        let Gesture { by, about, shift } = *gesture;
        let factor = (self.factor() * by).clamp(LEAST, MOST);
        let width = self.whole / factor;
        let step = [0, 1].map(|at| about[at] * (self.width - width) - shift[at] * width);
        let step = turned(step, -turn);
        let middle = [0, 1].map(|at| self.plus(&self.middle[at], step[at]));
        let [x, y] = middle;
        Ok(Self {
            middle: [x?, y?],
            width,
            whole: self.whole,
        })
    }

    /// Adds a number to a coordinate, and keeps the digits that the width requires.
    fn plus(&self, coordinate: &str, step: f64) -> Result<String, Refusal> {
        const SPARE: f64 = 24.0;
        let far = coordinate.parse().map_or(0.0, f64::abs).max(self.whole);
        let digits = libm::log10(far / self.width.min(far)) + SPARE;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a few hundred"
        )]
        let digits = digits.clamp(SPARE, 700.0) as usize;
        let [start, step] = [coordinate.to_owned(), format!("{step:e}")].map(|it| decimal(&it));
        let [start, step] = [start?, step?].map(|it| it.with_precision(digits).value());
        Ok((start + step).to_string())
    }

    /// Refuses what is no view.
    pub(super) fn check(&self) -> Result<(), Refusal> {
        const LONG: usize = 1_000;
        let is_size = |it: f64| it.is_finite() && it > 0.0;
        if !is_size(self.width) || !is_size(self.whole) {
            return Err(Refusal::wrong("the width of a view is a number above 0"));
        }
        for coordinate in &self.middle {
            if coordinate.len() > LONG {
                return Err(Refusal::wrong("a coordinate is too long"));
            }
            decimal(coordinate)?;
        }
        Ok(())
    }

    /// Returns whether doubles hold the window.
    pub(super) fn is_plain(&self) -> bool {
        let far = self
            .near()
            .map(f64::abs)
            .into_iter()
            .fold(self.whole, f64::max);
        self.width > FINE * far
    }

    fn near(&self) -> [f64; 2] {
        [0, 1].map(|at| self.middle[at].parse().unwrap_or(0.0))
    }

    /// Returns the arguments of the window of a picture of a set that is turned. `size` is that of the picture.
    pub(super) fn window(&self, [width, height]: [u32; 2], turn: f64) -> Vec<String> {
        let [x, y] = turned(self.near(), turn);
        let across = self.width * f64::from(height) / f64::from(width.max(1));
        let corner = [x - self.width / 2.0, y - across / 2.0];
        vec![
            format!("--view={},{},{},{across}", corner[0], corner[1], self.width),
            "--margin=0".into(),
        ]
    }

    /// Returns the arguments of the zoom of a picture: `whole` is the width that the whole set's picture shows.
    pub(super) fn zoom(&self, whole: f64) -> Vec<String> {
        // Short decimals would be read as doubles.
        let [x, y] = { &self.middle }
            .each_ref()
            .map(|digits| match digits.contains('.') {
                true => format!("{digits:0<24}"),
                false => format!("{:0<24}", format!("{digits}.")),
            });
        let factor = whole / self.width;
        vec![format!("--zoom={factor:e}"), format!("--at={x},{y}")]
    }
}

impl Gesture {
    /// Refuses what is no movement.
    pub(super) fn check(&self) -> Result<(), Refusal> {
        let Self { by, about, shift } = *self;
        let all = [by, about[0], about[1], shift[0], shift[1]];
        match all.iter().all(|it| it.is_finite() && it.abs() < 1e6) && by > 0.0 {
            true => Ok(()),
            false => Err(Refusal::wrong(
                "a gesture is a magnification, a point and a shift",
            )),
        }
    }
}

fn decimal(text: &str) -> Result<DBig, Refusal> {
    DBig::from_str(text).map_err(|_| Refusal::wrong("a coordinate is a decimal"))
}

#[cfg(test)]
mod tests {
    use super::{Gesture, View};

    #[test]
    fn a_zoom_keeps_its_point_in_place() {
        let view = View::of([0.0, 0.0, 4.0, 2.0], 0.0);
        let gesture = Gesture {
            by: 2.0,
            about: [0.25, 0.125],
            shift: [0.0; 2],
        };
        let near = view.moved(&gesture, 0.0).unwrap();
        assert_eq!(near.width, 2.0);
        let [x, y] = [0, 1].map(|at| near.middle[at].parse::<f64>().unwrap());
        // The point (3, 1.5) lies a quarter of a width right of the middle, before and after.
        assert_eq!([x + 0.25 * near.width, y + 0.125 * near.width], [3.0, 1.5]);
    }

    #[test]
    fn four_hundred_zooms_lose_no_digit() {
        let mut view = View::of([0.0, 0.0, 3.0, 3.0], 0.0);
        let mut zoom = |by| {
            for _ in 0..400 {
                let gesture = Gesture {
                    by,
                    about: [1.0 / 3.0, 0.1],
                    shift: [0.0; 2],
                };
                view = view.moved(&gesture, 0.0).unwrap();
            }
            view.clone()
        };
        let near = zoom(2.0);
        assert!(near.factor() > 1e120 && !near.is_plain());
        assert!(near.middle[0].len() > 120, "{}", near.middle[0]);
        let far = zoom(0.5);
        let x = far.middle[0].parse::<f64>().unwrap();
        assert!(
            (x - 1.5).abs() < 1e-12 && (far.width - 3.0).abs() < 1e-12,
            "{far:?}"
        );
    }

    #[test]
    fn the_middle_is_that_of_the_set_before_it_is_turned() {
        // Turned by a right angle, the window from (-2, 0) to (0, 2) shows what lies around (1, 1).
        let view = View::of([-2.0, 0.0, 2.0, 2.0], 90.0);
        assert_eq!(view.middle, ["1", "1"]);
        let right = Gesture {
            by: 1.0,
            about: [0.0; 2],
            shift: [-0.5, 0.0],
        };
        // The right of the picture is the upper side of the set.
        let moved = view.moved(&right, 90.0).unwrap();
        assert_eq!(moved.middle, ["1", "0"]);
        assert!(moved.window([10, 10], 90.0)[0].starts_with("--view=-1,0,2,2"));
    }
}
