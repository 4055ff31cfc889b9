//! The colours and lines of the figure; all of them can be seen on white and on black.

use crate::render::{Paint, Pen, Stroke};
use crate::style::{Cap, Colour, Join};

/// The pen of elements.
pub(super) const PEN: Pen = Pen {
    width: 2.0,
    cap: Cap::Round,
    join: Join::Round,
    dash: 0.0,
};

const FERTILE: [u8; 3] = [58, 127, 192];
const INFERTILE: [u8; 3] = [140, 140, 140];
const SEEDS: [u8; 3] = [205, 118, 40];

/// What an element is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// It is replaced.
    Fertile,
    /// It stays.
    Infertile,
    /// It belongs to a new fractal and is replaced there.
    Seed,
    /// It belongs to a new fractal and stays.
    InfertileSeed,
}

impl Kind {
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

    /// The colour of its elements.
    pub(super) fn colour(self) -> Colour {
        of(self.rgb(), 255)
    }

    /// The line of an element.
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

    /// The outline of a base element where an element stands.
    pub(super) fn outline(self, closed: bool) -> Paint {
        Paint {
            fill: closed.then(|| of(self.rgb(), 34)),
            ..stroke(of(self.rgb(), 160), Pen { width: 1.0, ..PEN })
        }
    }

    /// One of several draws.
    pub(super) fn draw(self) -> Paint {
        stroke(of(self.rgb(), 120), Pen { width: 1.0, ..PEN })
    }
}

/// The side that a generator replaces.
pub(super) fn side() -> Paint {
    let pen = Pen {
        width: 1.0,
        cap: Cap::Butt,
        dash: 4.0,
        ..PEN
    };
    stroke(Colour::grey(140), pen)
}

/// The rings around its ends.
pub(super) fn side_end() -> Paint {
    let pen = Pen { width: 1.0, ..PEN };
    stroke(Colour::grey(140), pen)
}

/// The lines between the components.
pub(super) fn hairline() -> Paint {
    let pen = Pen { width: 1.0, ..PEN };
    stroke(of([140; 3], 170), pen)
}

/// The strokes of an asterisk.
pub(super) fn asterisk(colour: Colour, size: f64) -> Paint {
    let pen = Pen {
        width: 1.4 * size,
        ..PEN
    };
    stroke(colour, pen)
}

/// Dots of a diameter where elements begin and end.
pub(super) fn dots(colour: Colour, diameter: f64) -> Paint {
    let pen = Pen {
        width: diameter,
        ..PEN
    };
    stroke(colour, pen)
}

/// The base element itself.
pub(super) fn base_element(closed: bool) -> Paint {
    Paint {
        fill: closed.then(|| of(FERTILE, 34)),
        ..stroke(of(FERTILE, 255), PEN)
    }
}

/// What an instance holds, in its tint if it has one.
pub(super) fn instance(closed: bool, tint: Option<Colour>) -> Paint {
    let tinted = tint.map(|colour| {
        let [red, green, blue, _] = colour.rgba();
        of([red, green, blue], 60)
    });
    let own = Kind::Fertile.outline(closed);
    Paint {
        fill: own.fill.and(tinted.or(own.fill)),
        ..own
    }
}

fn stroke(colour: Colour, pen: Pen) -> Paint {
    Paint {
        fill: None,
        stroke: Some(Stroke { colour, pen }),
    }
}

fn of([red, green, blue]: [u8; 3], opacity: u8) -> Colour {
    Colour::of_rgba([red, green, blue, opacity])
}
