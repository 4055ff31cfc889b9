//! Maps and sets, which conversions write differently in the plane and in space.

use crate::build::written::{Entries, sequence};
use crate::document::node::Value;
use crate::geometry::{
    DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3, MAX_HULL_POINTS, Round, Solid,
};
use crate::ifs::{AffineMap, OutlineOf};
use crate::rule::BaseElement;

use super::Refusal;
use super::number::{self, matrix, point, scale, value};
use super::structure::Structure;
use super::{copies, shape};

/// Maps of models that are converted.
pub(super) trait Convertible: AffineMap {
    /// Returns whether two maps are equal, to rounding.
    fn is_same(&self, other: &Self) -> bool;

    /// Returns the map with the rounding errors of zeros removed.
    fn settled(self) -> Self;

    /// Writes the map in its shortest form.
    fn written(&self) -> Entries;

    /// Writes the map as that of an instance, after what is instanced.
    fn placing(&self, master: Entries) -> Entries;

    /// Writes the image of an outline as a set: a mapping with one key.
    fn set(outline: &OutlineOf<Self>, map: &Self) -> Result<Entries, Refusal>;

    /// Returns the structure with its shapes replaced by instances of objects that instance themselves.
    fn with_copies(structure: &Structure<Self>) -> Result<Structure<Self>, Refusal>;
}

impl Convertible for DAffine2 {
    fn is_same(&self, other: &Self) -> bool {
        number::is_same(self, other)
    }

    fn settled(self) -> Self {
        let columns = [self.matrix2.x_axis, self.matrix2.y_axis, self.translation];
        let size = columns.map(|column| column.abs().max_element());
        let settle = settle(&size);
        let [x, y, shift] = columns.map(|column| DVec2::new(settle(column.x), settle(column.y)));
        Self::from_cols(x, y, shift)
    }

    fn written(&self) -> Entries {
        let (x, y) = (self.matrix2.x_axis, self.matrix2.y_axis);
        let entries = Entries::default();
        let linear = if let Some(factor) = scale(self.matrix2) {
            entries.set("scale", factor)
        } else if y == x.perp() {
            entries.set("times", point(x))
        } else if y == -x.perp() {
            let conjugate = Value::Bool(true);
            entries.set("times", point(x)).set("conjugate", conjugate)
        } else {
            entries.set("matrix", matrix(self.matrix2))
        };
        let shift = self.translation;
        linear.set_some("translate", (shift != DVec2::ZERO).then(|| point(shift)))
    }

    fn placing(&self, master: Entries) -> Entries {
        let turned = match scale(self.matrix2) {
            _ if self.matrix2 == DMat2::IDENTITY => master,
            Some(factor) => master.set("scale", factor),
            None => master.set("matrix", matrix(self.matrix2)),
        };
        let shift = self.translation;
        turned.set_some("translate", (shift != DVec2::ZERO).then(|| point(shift)))
    }

    fn set(outline: &BaseElement, map: &Self) -> Result<Entries, Refusal> {
        shape::set(outline, map)
    }

    fn with_copies(structure: &Structure) -> Result<Structure, Refusal> {
        copies::with_copies(structure)
    }
}

impl Convertible for DAffine3 {
    fn is_same(&self, other: &Self) -> bool {
        const ROUNDING: f64 = 1e-12;
        let size = 1.0 + self.translation.abs().max_element();
        let shift = (self.translation - other.translation).abs();
        self.matrix3.abs_diff_eq(other.matrix3, ROUNDING) && shift.max_element() <= ROUNDING * size
    }

    fn settled(self) -> Self {
        let columns = self.to_cols_array();
        let settle = settle(&columns.map(f64::abs));
        Self::from_cols_array(&columns.map(settle))
    }

    fn written(&self) -> Entries {
        let entries = match factors(&self.matrix3) {
            Some(factors) => Entries::default().set("scale", factors),
            None => Entries::default().set("matrix", rows(&self.matrix3)),
        };
        let shift = self.translation;
        entries.set_some("translate", (shift != DVec3::ZERO).then(|| place(shift)))
    }

    fn placing(&self, master: Entries) -> Entries {
        let turned = match factors(&self.matrix3) {
            _ if self.matrix3 == DMat3::IDENTITY => master,
            Some(factors) => master.set("scale", factors),
            None => master.set("matrix", rows(&self.matrix3)),
        };
        let shift = self.translation;
        turned.set_some("translate", (shift != DVec3::ZERO).then(|| place(shift)))
    }

    fn set(solid: &Solid, map: &Self) -> Result<Entries, Refusal> {
        let set = match solid.primitive() {
            Some(round) => of_round(round, &(*map * *solid.place())),
            None => of_polyhedron(solid, map),
        };
        set.ok_or(Refusal::Solid)
    }

    fn with_copies(_: &Structure<Self>) -> Result<Structure<Self>, Refusal> {
        Err(Refusal::ShapesInPart)
    }
}

/// Returns a function that replaces numbers by 0 that are rounding errors beside the largest of several.
fn settle(sizes: &[f64]) -> impl Fn(f64) -> f64 + use<> {
    const ROUNDING: f64 = 1e-15;
    let size = sizes.iter().copied().fold(0.0, f64::max);
    move |value: f64| {
        if value.abs() <= ROUNDING * size {
            0.0
        } else {
            value
        }
    }
}

fn place(point: DVec3) -> Value {
    sequence(point.to_array().map(value))
}

fn rows(matrix: &DMat3) -> Value {
    sequence([0, 1, 2].map(|row| place(matrix.row(row))))
}

/// Writes the factor or the three factors of a diagonal matrix; `None` for any other matrix.
fn factors(matrix: &DMat3) -> Option<Value> {
    let factors = DVec3::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z);
    let is_diagonal = *matrix == DMat3::from_diagonal(factors);
    let are_equal = factors == DVec3::splat(factors.x);
    is_diagonal.then(|| {
        if are_equal {
            value(factors.x)
        } else {
            place(factors)
        }
    })
}

/// Writes the image of a round primitive: a ball or an ellipsoid along the axes, or a cylinder or a cone that is upright
/// on a disk. `None` for other images.
fn of_round(round: Round, map: &DAffine3) -> Option<Entries> {
    const ROUNDING: f64 = 1e-12;
    let linear = map.matrix3;
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let is_even = |a: DVec3, b: DVec3| (a.length() - b.length()).abs() <= ROUNDING * a.length();
    let is_right = |a: DVec3, b: DVec3| a.dot(b).abs() <= ROUNDING * a.length() * b.length();
    let is_upright = is_right(x, y) && is_right(y, z) && is_right(z, x);
    let number = |length: f64| value(length);
    let (name, form) = match round {
        Round::Ball => {
            let form = Entries::default().set("centre", place(map.translation));
            let axes = DVec3::new(x.x, y.y, z.z);
            if is_upright && is_even(x, y) && is_even(y, z) {
                ("sphere", form.set("radius", number(x.length())))
            } else if linear == DMat3::from_diagonal(axes) {
                ("ellipsoid", form.set("axes", place(axes.abs())))
            } else {
                return None;
            }
        }
        Round::Cylinder | Round::Cone => {
            if !is_upright || !is_even(x, z) {
                return None;
            }
            let form = Entries::default()
                .set("from", place(map.translation))
                .set("to", place(map.translation + y))
                .set("radius", number(x.length()));
            let name = match round {
                Round::Cone => "cone",
                _ => "cylinder",
            };
            (name, form)
        }
    };
    Some(Entries::default().set(name, form.value()))
}

/// Writes the image of a polyhedron: a point, a line, a polygon, a box along the axes, or a convex hull. `None` for one of
/// too many corners.
fn of_polyhedron(solid: &Solid, map: &DAffine3) -> Option<Entries> {
    let placed = |corner: &DVec3| map.transform_point3(*corner);
    let points = |corners: &[DVec3]| sequence(corners.iter().map(|it| place(placed(it))));
    let (corners, faces) = (solid.corners(), solid.polygons());
    let entry = |name, value| Some(Entries::default().set(name, value));
    match (corners, &faces[..]) {
        ([point], _) => return entry("point", place(placed(point))),
        ([_, _], _) => return entry("segment", points(corners)),
        (_, [face]) => return entry("polygon", points(face)),
        _ => {}
    }
    let placed: Vec<DVec3> = corners.iter().map(placed).collect();
    let low = placed.iter().copied().reduce(DVec3::min)?;
    let high = placed.iter().copied().reduce(DVec3::max)?;
    let is_end = |corner: &DVec3| {
        let ends = corner.cmpeq(low) | corner.cmpeq(high);
        ends.all()
    };
    if corners.len() == 8 && faces.len() == 6 && placed.iter().all(is_end) {
        let form = Entries::default()
            .set("from", place(low))
            .set("to", place(high));
        return entry("box", form.value());
    }
    let is_hull = !faces.is_empty() && corners.len() <= MAX_HULL_POINTS as usize;
    is_hull.then(|| Entries::default().set("hull", points(corners)))
}
