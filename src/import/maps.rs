//! Systems of affine maps from rows of numbers.

use crate::build::NumberText;
use crate::build::written::{Entries, sequence};
use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use crate::document::node::Value;

/// Layout of a map: a matrix by rows, and a translation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    /// Number of coordinates of a point.
    pub(super) axes: usize,
    /// Letters of the numbers of a map, without that of its probability.
    pub(super) letters: &'static str,
}

impl Layout {
    /// x' = a x + b y + e, y' = c x + d y + f.
    pub(super) const PLANE: Self = Self {
        axes: 2,
        letters: "abcdef",
    };

    /// x' = a x + b y + c z + j, y' = d x + e y + f z + k, z' = g x + h y + i z + l.
    pub(super) const SPACE: Self = Self {
        axes: 3,
        letters: "abcdefghijkl",
    };

    /// Returns the number of numbers of a map.
    pub(super) fn numbers(self) -> usize {
        self.letters.len()
    }
}

/// A system of maps under construction.
pub(super) struct System {
    layout: Layout,
    maps: Vec<Value>,
}

impl System {
    pub(super) fn new(layout: Layout) -> Self {
        let maps = Vec::new();
        Self { layout, maps }
    }

    /// Adds a map, the numbers of its matrix by rows and of its translation. A weight that is not positive is reported at
    /// its place, and leaves the map out.
    pub(super) fn push(
        &mut self,
        map: Vec<NumberText>,
        weight: Option<(f64, &Place)>,
        found: &mut Diagnostics,
    ) {
        if let Some((weight, place)) = weight.filter(|(weight, _)| *weight <= 0.0) {
            let message = format!("the probability {weight} is not positive: this map is left out");
            found.push(Diagnostic::warning(message).at(place));
            return;
        }
        let weight = weight.map(|(weight, _)| NumberText::from(weight).0);
        let (matrix, shift) = matrix_and_shift(map, self.layout.axes);
        let map = Entries::default()
            .set("matrix", matrix)
            .set_some("translate", shift)
            .set_some("weight", weight);
        self.maps.push(map.value());
    }

    /// Returns the keys of the system; a system without maps is reported at a place.
    pub(super) fn entries(self, name: &str, place: &Place, found: &mut Diagnostics) -> Entries {
        if self.maps.is_empty() && !found.has_errors() {
            found.push(Diagnostic::error(format!("{name} has no maps")).at(place));
        }
        let kind = Entries::default().set("kind", Value::Text("ifs".into()));
        let space = (self.layout.axes == 3).then_some(Value::Number(3.0));
        kind.set_some("space", space)
            .set("maps", sequence(self.maps))
    }
}

/// Returns the rows of a map's matrix, and its translation unless that is 0.
pub(super) fn matrix_and_shift(map: Vec<NumberText>, axes: usize) -> (Value, Option<Value>) {
    let mut numbers: Vec<Value> = map.into_iter().map(|number| number.0).collect();
    let shift = numbers.split_off(axes * axes);
    let moves = shift.iter().any(|it| *it != Value::Number(0.0));
    let matrix = sequence(numbers.chunks(axes).map(|row| sequence(row.to_vec())));
    (matrix, moves.then(|| sequence(shift)))
}
