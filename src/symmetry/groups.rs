//! The 17 wallpaper groups and the 7 frieze groups, as the *International Tables for Crystallography* list them: volume A,
//! *Space-group symmetry* (2016), and volume E, *Subperiodic groups* (2010).
//!
//! Coordinates are multiples of the vectors a and b of the conventional cell. In a frieze, a alone is a period.

use crate::style::Named;

/// Shape of the conventional cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lattice {
    /// a along the x axis and b along the y axis.
    Rectangular,
    /// a along the x axis and b, of equal length, along the y axis.
    Square,
    /// a along the x axis, and b of equal length at 120 degrees to it.
    Hexagonal,
    /// a along the x axis, and no other period.
    Frieze,
}

/// Wallpaper or frieze group of isometries of the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TilingGroup(usize);

/// Definition of a group.
#[derive(Debug)]
pub(super) struct Definition {
    name: &'static str,
    pub(super) lattice: Lattice,
    /// General positions: the images of (x, y) in a cell.
    pub(super) positions: &'static [&'static str],
    /// Corners of a fundamental domain, a convex polygon, in order. In a frieze the y coordinates are 0, and -1 or 1 where the
    /// domain has no end.
    pub(super) domain: &'static [[f64; 2]],
}

const WHOLE: &[[f64; 2]] = &rectangle([0.0, 0.0], [1.0, 1.0]);
const HALF: &[[f64; 2]] = &rectangle([0.0, 0.0], [0.5, 1.0]);
const QUARTER: &[[f64; 2]] = &rectangle([0.0, 0.0], [0.5, 0.5]);
const KITE: &[[f64; 2]] = &[[0.0, 0.0], [0.5, 0.0], [2.0 / 3.0, 1.0 / 3.0], [0.5, 0.5]];

const fn rectangle([left, low]: [f64; 2], [right, high]: [f64; 2]) -> [[f64; 2]; 4] {
    [[left, low], [right, low], [right, high], [left, high]]
}

const P1: &[&str] = &["x,y"];
const P2: &[&str] = &["x,y", "-x,-y"];
const PM: &[&str] = &["x,y", "-x,y"];
const PMM: &[&str] = &["x,y", "-x,-y", "-x,y", "x,-y"];
const PMG: &[&str] = &["x,y", "-x,-y", "-x+1/2,y", "x+1/2,-y"];
const P3: &[&str] = &["x,y", "-y,x-y", "-x+y,-x"];

const fn group(
    name: &'static str,
    lattice: Lattice,
    positions: &'static [&'static str],
    domain: &'static [[f64; 2]],
) -> Definition {
    Definition {
        name,
        lattice,
        positions,
        domain,
    }
}

use Lattice::{Frieze, Hexagonal, Rectangular, Square};

const GROUPS: [Definition; 24] = [
    group("p1", Rectangular, P1, WHOLE),
    group("p2", Rectangular, P2, HALF),
    group("pm", Rectangular, PM, HALF),
    group("pg", Rectangular, &["x,y", "-x,y+1/2"], HALF),
    group(
        "cm",
        Rectangular,
        &["x,y", "-x,y", "x+1/2,y+1/2", "-x+1/2,y+1/2"],
        QUARTER,
    ),
    group("pmm", Rectangular, PMM, QUARTER),
    group(
        "pmg",
        Rectangular,
        PMG,
        &rectangle([-0.25, 0.0], [0.25, 0.5]),
    ),
    group(
        "pgg",
        Rectangular,
        &["x,y", "-x,-y", "-x+1/2,y+1/2", "x+1/2,-y+1/2"],
        QUARTER,
    ),
    group(
        "cmm",
        Rectangular,
        &[
            "x,y",
            "-x,-y",
            "-x,y",
            "x,-y",
            "x+1/2,y+1/2",
            "-x+1/2,-y+1/2",
            "-x+1/2,y+1/2",
            "x+1/2,-y+1/2",
        ],
        &rectangle([0.0, 0.0], [0.25, 0.5]),
    ),
    group("p4", Square, &["x,y", "-x,-y", "-y,x", "y,-x"], QUARTER),
    group(
        "p4m",
        Square,
        &[
            "x,y", "-x,-y", "-y,x", "y,-x", "-x,y", "x,-y", "y,x", "-y,-x",
        ],
        &[[0.0, 0.0], [0.5, 0.0], [0.5, 0.5]],
    ),
    group(
        "p4g",
        Square,
        &[
            "x,y",
            "-x,-y",
            "-y,x",
            "y,-x",
            "-x+1/2,y+1/2",
            "x+1/2,-y+1/2",
            "y+1/2,x+1/2",
            "-y+1/2,-x+1/2",
        ],
        &[[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]],
    ),
    group(
        "p3",
        Hexagonal,
        P3,
        &[
            [0.0, 0.0],
            [1.0 / 3.0, -1.0 / 3.0],
            [2.0 / 3.0, 1.0 / 3.0],
            [1.0 / 3.0, 2.0 / 3.0],
        ],
    ),
    group(
        "p3m1",
        Hexagonal,
        &["x,y", "-y,x-y", "-x+y,-x", "-y,-x", "-x+y,y", "x,x-y"],
        &[[0.0, 0.0], [2.0 / 3.0, 1.0 / 3.0], [1.0 / 3.0, 2.0 / 3.0]],
    ),
    group(
        "p31m",
        Hexagonal,
        &["x,y", "-y,x-y", "-x+y,-x", "y,x", "x-y,-y", "-x,-x+y"],
        KITE,
    ),
    group(
        "p6",
        Hexagonal,
        &["x,y", "-y,x-y", "-x+y,-x", "-x,-y", "y,-x+y", "x-y,x"],
        KITE,
    ),
    group(
        "p6m",
        Hexagonal,
        &[
            "x,y", "-y,x-y", "-x+y,-x", "-x,-y", "y,-x+y", "x-y,x", "-y,-x", "-x+y,y", "x,x-y",
            "y,x", "x-y,-y", "-x,-x+y",
        ],
        &[[0.0, 0.0], [0.5, 0.0], [2.0 / 3.0, 1.0 / 3.0]],
    ),
    group("frieze-p1", Frieze, P1, &rectangle([0.0, -1.0], [1.0, 1.0])),
    group(
        "frieze-p11g",
        Frieze,
        &["x,y", "x+1/2,-y"],
        &rectangle([0.0, 0.0], [1.0, 1.0]),
    ),
    group(
        "frieze-p1m1",
        Frieze,
        PM,
        &rectangle([0.0, -1.0], [0.5, 1.0]),
    ),
    group("frieze-p2", Frieze, P2, &rectangle([0.0, 0.0], [1.0, 1.0])),
    group(
        "frieze-p2mg",
        Frieze,
        PMG,
        &rectangle([-0.25, 0.0], [0.25, 1.0]),
    ),
    group(
        "frieze-p11m",
        Frieze,
        &["x,y", "x,-y"],
        &rectangle([0.0, 0.0], [1.0, 1.0]),
    ),
    group(
        "frieze-p2mm",
        Frieze,
        PMM,
        &rectangle([0.0, 0.0], [0.5, 1.0]),
    ),
];

impl TilingGroup {
    /// Returns the definition.
    pub(super) fn definition(self) -> &'static Definition {
        const DEFINITIONS: &[Definition; 24] = &GROUPS;
        &DEFINITIONS[self.0]
    }
}

impl Named for TilingGroup {
    const NAMES: &'static [(&'static str, Self)] = &{
        let mut names = [("", Self(0)); GROUPS.len()];
        let mut number = 0;
        while number < names.len() {
            names[number] = (GROUPS[number].name, Self(number));
            number += 1;
        }
        names
    };
}

/// Image of a point: an integral matrix, by rows, and a translation.
pub(super) type Position = ([[f64; 2]; 2], [f64; 2]);

/// Reads a general position, such as `-x+1/2,y`.
pub(super) fn position(text: &str) -> Position {
    let mut rows = [[0.0; 2]; 2];
    let mut shift = [0.0; 2];
    for ((part, row), shift) in text.split(',').zip(&mut rows).zip(&mut shift) {
        let part = match part.strip_suffix("+1/2") {
            Some(rest) => {
                *shift = 0.5;
                rest
            }
            None => part,
        };
        let mut sign = 1.0;
        for symbol in part.chars() {
            match symbol {
                'x' => row[0] = sign,
                'y' => row[1] = sign,
                _ => {}
            }
            sign = if symbol == '-' { -1.0 } else { 1.0 };
        }
    }
    (rows, shift)
}
