//! Pan and zoom in space: the point in the middle of a picture, and what a movement of the picture makes of it.

use crate::geometry::DVec3;
use crate::render::space::Sight as Drawn;

use super::answer::Refusal;
use super::look::Look;
use super::view::Gesture;

/// The middle of the last picture of a set in space, and the directions in which it moves.
#[derive(Clone, Debug)]
pub(super) struct Sight {
    /// Point in the middle.
    middle: DVec3,
    /// Vectors along the width of the picture, to the right and upwards, at a magnification of 1.
    across: [DVec3; 2],
}

/// Least and greatest magnification.
const ZOOMS: [f64; 2] = [0.05, 1e4];

impl Sight {
    /// Returns the sight of a picture with a look.
    pub(super) fn of(drawn: &Drawn, look: &Look) -> Self {
        let zoom = zoom(look);
        Self {
            middle: drawn.middle,
            across: drawn.across.map(|side| side * zoom),
        }
    }

    /// Applies a gesture to a look.
    pub(super) fn moved(&self, gesture: &Gesture, look: &mut Look) -> Result<(), Refusal> {
        let before = zoom(look);
        let after = (before * gesture.by).clamp(ZOOMS[0], ZOOMS[1]);
        let given = look.options.get("look-at").map(|text| point(text));
        let mut middle = given.transpose()?.unwrap_or(self.middle);
        for at in 0..2 {
            let [about, shift] = [gesture.about[at], gesture.shift[at]];
            middle += self.across[at] * (about * (before.recip() - after.recip()) - shift / after);
        }
        if !middle.is_finite() {
            return Err(Refusal::wrong("the picture cannot be moved that far"));
        }
        let digits = middle.to_array().map(|it| it.to_string());
        look.options.insert("look-at".into(), digits.join(","));
        look.options.insert("zoom".into(), after.to_string());
        Ok(())
    }
}

/// Returns the magnification of a look.
pub(super) fn zoom(look: &Look) -> f64 {
    let given = look.options.get("zoom").and_then(|it| it.parse().ok());
    given
        .filter(|zoom: &f64| zoom.is_finite() && *zoom > 0.0)
        .unwrap_or(1.0)
}

fn point(text: &str) -> Result<DVec3, Refusal> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|it| it.trim().parse()).collect();
    let point = numbers.ok().and_then(|it| <[f64; 3]>::try_from(it).ok());
    let point = point.map(DVec3::from_array);
    point.ok_or_else(|| Refusal::wrong("a point in space is X,Y,Z"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_under_the_pointer_stays_there() {
        let sight = Sight {
            middle: DVec3::new(1.0, 2.0, 3.0),
            across: [DVec3::X * 4.0, DVec3::Y * 4.0],
        };
        let mut look = Look::default();
        let by = |by, about, shift| Gesture { by, about, shift };
        let gesture = by(2.0, [0.25, -0.125], [0.0; 2]);
        sight.moved(&gesture, &mut look).unwrap();
        // (2, 1.5, 3) lies a quarter of a width right of the middle, before and after.
        assert_eq!(look.options["look-at"], "1.5,1.75,3");
        assert_eq!(look.options["zoom"], "2");
        sight
            .moved(&by(1.0, [0.0; 2], [0.5, 0.0]), &mut look)
            .unwrap();
        assert_eq!(look.options["look-at"], "0.5,1.75,3");
        sight
            .moved(&by(1e30, [0.0; 2], [0.0; 2]), &mut look)
            .unwrap();
        assert_eq!(zoom(&look), 1e4);
    }
}
