//! Colours and lines of the figure, all visible on white and on black.

use crate::render::{Paint, Pen, Stroke};
use crate::style::{Cap, Colour, Join};

/// Pen of elements.
pub(super) const PEN: Pen = Pen {
    width: 2.0,
    cap: Cap::Round,
    join: Join::Round,
    dash: 0.0,
};

const FERTILE: [u8; 3] = [58, 127, 192];
const INFERTILE: [u8; 3] = [140, 140, 140];
const SEEDS: [u8; 3] = [205, 118, 40];

/// Kind of an element, which determines its colour and line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ElementRole {
    /// A fertile element.
    Fertile,
    /// An infertile element.
    Infertile,
    /// A fertile element of a seed part.
    Seed,
    /// An infertile element of a seed part.
    InfertileSeed,
}

impl ElementRole {
    pub(super) const ALL: [Self; 4] = [
        Self::Fertile,
        Self::Infertile,
        Self::Seed,
        Self::InfertileSeed,
    ];

    pub(super) fn of(fertile: bool, seeds: bool) -> Self {
        match (fertile, seeds) {
            (true, false) => Self::Fertile,
            (false, false) => Self::Infertile,
            (true, true) => Self::Seed,
            (false, true) => Self::InfertileSeed,
        }
    }

    fn rgb(self) -> [u8; 3] {
        match self {
            Self::Fertile => FERTILE,
            Self::Infertile => INFERTILE,
            Self::Seed | Self::InfertileSeed => SEEDS,
        }
    }

    /// Returns the colour of elements of the kind.
    pub(super) fn colour(self) -> Colour {
        of(self.rgb(), 255)
    }

    /// Returns the line of an element; dotted if invisible.
    pub(super) fn element(self, visible: bool) -> Paint {
        let thin = matches!(self, Self::Infertile | Self::InfertileSeed);
        let pen = Pen {
            width: if thin { 1.5 } else { PEN.width },
            cap: if visible { Cap::Round } else { Cap::Butt },
            dash: if visible { 0.0 } else { 2.0 },
            ..PEN
        };
        stroke(self.colour(), pen)
    }

    /// Returns the outline of a base element in the place of an element.
    pub(super) fn outline(self, closed: bool) -> Paint {
        Paint {
            fill: closed.then(|| of(self.rgb(), 34)),
            ..stroke(of(self.rgb(), 160), Pen { width: 1.0, ..PEN })
        }
    }

    /// Returns the line of elements in one of several draws.
    pub(super) fn draw(self) -> Paint {
        stroke(of(self.rgb(), 120), Pen { width: 1.0, ..PEN })
    }
}

/// Returns the line of the side that a generator replaces.
pub(super) fn side() -> Paint {
    let pen = Pen {
        width: 1.0,
        cap: Cap::Butt,
        dash: 4.0,
        ..PEN
    };
    stroke(Colour::grey(140), pen)
}

/// Returns the line of the rings around its ends.
pub(super) fn side_end() -> Paint {
    let pen = Pen { width: 1.0, ..PEN };
    stroke(Colour::grey(140), pen)
}

/// Returns the line between components.
pub(super) fn hairline() -> Paint {
    let pen = Pen { width: 1.0, ..PEN };
    stroke(of([140; 3], 170), pen)
}

/// Returns the line of the normal of an element.
pub(super) fn normal(colour: Colour) -> Paint {
    stroke(colour, Pen { width: 1.0, ..PEN })
}

/// Returns the strokes of an asterisk.
pub(super) fn asterisk(colour: Colour, size: f64) -> Paint {
    let pen = Pen {
        width: 1.4 * size,
        ..PEN
    };
    stroke(colour, pen)
}

/// Returns the dots of a diameter at the ends of elements.
pub(super) fn dots(colour: Colour, diameter: f64) -> Paint {
    let pen = Pen {
        width: diameter,
        ..PEN
    };
    stroke(colour, pen)
}

/// Returns the line and the fill of a base element.
pub(super) fn base_element(closed: bool) -> Paint {
    Paint {
        fill: closed.then(|| of(FERTILE, 34)),
        ..stroke(of(FERTILE, 255), PEN)
    }
}

/// Returns the outline of an object in the place of an instance, filled with the instance's tint if it has
/// one.
pub(super) fn instance(closed: bool, tint: Option<Colour>) -> Paint {
    let tinted = tint.map(|colour| {
        let [red, green, blue, _] = colour.rgba();
        of([red, green, blue], 60)
    });
    let own = ElementRole::Fertile.outline(closed);
    Paint {
        fill: own.fill.and(tinted.or(own.fill)),
        ..own
    }
}

/// Returns an area without a line.
pub(super) fn filled(colour: Colour) -> Paint {
    Paint {
        fill: Some(colour),
        stroke: None,
        has_holes: false,
    }
}

fn stroke(colour: Colour, pen: Pen) -> Paint {
    Paint {
        fill: None,
        stroke: Some(Stroke { colour, pen }),
        has_holes: false,
    }
}

fn of([red, green, blue]: [u8; 3], opacity: u8) -> Colour {
    Colour::of_rgba([red, green, blue, opacity])
}
