//! Instances whose maps are drawn at random.

use crate::draws::{Cells, MAX_CELLS, Path, Variable, needed, pick_by_weight};
use crate::expression::{AffineOf, Interval, Program};
use crate::geometry::{DMat3, DVec3, Linear as _, Point as _};
use crate::ifs::{AffineMap, PointOf};
use crate::rule::{Extent, PowerMeans};

use super::{Instancing, ObjectDefinition, ObjectInstance};

/// Slot of the first random variable; before it is that of the level.
pub(crate) const FIRST: usize = 1;

/// Returns the number of cells into which the ranges of draws are divided for each of some instances.
pub(crate) fn cells_of_each(instances: usize) -> usize {
    const MAX_OF_ALL: usize = 1 << 19;
    (MAX_OF_ALL / instances.max(1)).clamp(1, MAX_CELLS)
}

/// Form of the linear part of a map as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LinearForm {
    /// A rotation.
    Rotation,
    /// A scaling of the axes.
    Scaling,
    /// Any linear map.
    Any,
}

impl<M: AffineMap> ObjectInstance<M> {
    /// Returns which of the variables its map depends on.
    pub(crate) fn needed(&self, variables: &[Variable]) -> Vec<bool> {
        if variables.is_empty() {
            return Vec::new();
        }
        let maps = self.in_space();
        needed(variables, FIRST, maps.iter().flat_map(AffineOf::numbers))
    }

    /// Returns its maps as written, of the plane as maps of space.
    fn in_space(&self) -> Vec<AffineOf<Program, 3>> {
        self.transforms.iter().map(M::written_in_space).collect()
    }

    /// Returns upper bounds of the power means, for all draws of `variables`, of the distance by which the map of an
    /// instance at a level moves a point, and of its stretch; of their maxima if the power is infinite. The ranges of the
    /// draws are divided into at most `most` cells. `inner` is the map that the object which is instanced applies to itself.
    pub(crate) fn extent_of_draws(
        &self,
        inner: &M,
        (variables, level, most): (&[Variable], f64, usize),
        power: f64,
        point: PointOf<M>,
    ) -> Extent {
        let maps = self.in_space();
        let cells = Cells::new(
            variables,
            FIRST,
            most,
            maps.iter().flat_map(AffineOf::numbers),
        );
        let start = inner.apply(point).coordinates();
        let mut means = PowerMeans::new(power);
        cells.visit(&[Interval::point(level)], |slots, likely| {
            let mut place = start.map(Interval::point);
            let mut length = inner.linear().stretch();
            for (map, form) in maps.iter().zip(&*self.forms) {
                let map = map.map(|program| program.range(slots));
                length *= match form {
                    LinearForm::Rotation => 1.0,
                    LinearForm::Scaling => {
                        let factors = [0, 1, 2].map(|axis: usize| map.axes[axis][axis]);
                        factors
                            .map(Interval::magnitude)
                            .into_iter()
                            .fold(0.0, f64::max)
                    }
                    LinearForm::Any => stretch(&map.axes),
                };
                place = [0, 1, 2].map(|row| {
                    let terms = [0, 1, 2].map(|axis: usize| map.axes[axis][row] * place[axis]);
                    terms[0] + terms[1] + terms[2] + map.origin[row]
                });
            }
            let from = point.coordinates();
            let moved = [0, 1, 2].map(|axis: usize| place[axis] - Interval::point(from[axis]));
            let away = DVec3::from(moved.map(Interval::magnitude)).length();
            means.add(Extent { away, length }, likely);
        });
        means.extent()
    }
}

impl<M: AffineMap> Instancing<M> {
    /// Returns the instances that are drawn when an object is replaced, and the slots of their maps.
    pub(crate) fn drawn(&self, object: usize, path: Path) -> (&[ObjectInstance<M>], Vec<f64>) {
        let object = &self.objects[object];
        let weights = object.alternatives.iter().map(|it| it.weight);
        let union = match object.alternatives.is_empty() {
            true => &object.instances[..],
            false => {
                let drawn = pick_by_weight(path, weights);
                &object.instances[object.alternatives[drawn].instances.clone()]
            }
        };
        let mut slots = object.slots.clone();
        if !self.variables.is_empty() {
            let needed = vec![true; self.variables.len()];
            draw_into(&mut slots, (&self.variables, &needed), object.level(), path);
        }
        (union, slots)
    }
}

impl<M: AffineMap> ObjectDefinition<M> {
    /// Returns the level of the object, 0 if it has none.
    pub(crate) fn level(&self) -> f64 {
        self.slots.first().copied().unwrap_or_default()
    }
}

/// Returns a bound of the stretch of the linear maps with these columns: that of the map in the middle, and of the
/// differences from it.
fn stretch(columns: &[[Interval; 3]; 3]) -> f64 {
    let ends = |end: fn(&Interval) -> f64| {
        DMat3::from_cols_array_2d(&columns.each_ref().map(|it| it.each_ref().map(end)))
    };
    let (low, high) = (ends(|it| it.low), ends(|it| it.high));
    let middle = low * 0.5 + high * 0.5;
    let differences = (high * 0.5 - low * 0.5).to_cols_array();
    let difference: f64 = differences.iter().map(|it| it * it).sum();
    let bound = middle.stretch() + difference.sqrt();
    if bound.is_nan() { f64::INFINITY } else { bound }
}

/// Draws the variables that are needed for a path, after the level; others have the value 0.
pub(crate) fn draw_into(
    slots: &mut Vec<f64>,
    (variables, needed): (&[Variable], &[bool]),
    level: f64,
    path: Path,
) {
    slots.clear();
    slots.push(level);
    for (variable, &is_needed) in variables.iter().zip(needed) {
        let value = match is_needed {
            true => variable.draw(path, slots),
            false => 0.0,
        };
        slots.push(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_bounded() {
        let turned = |from: f64, to: f64| {
            let [c, s] = [
                Interval::new(from, to).cosine(),
                Interval::new(from, to).sine(),
            ];
            let zero = Interval::point(0.0);
            let minus = zero - s;
            [[c, s, zero], [minus, c, zero], [zero; 3]]
        };
        assert!((stretch(&turned(20.0, 20.0)) - 1.0).abs() < 1e-15);
        let bound = stretch(&turned(20.0, 21.0));
        assert!((1.0..1.02).contains(&bound), "{bound}");
        let all = [[Interval::ALL; 3]; 3];
        assert!(stretch(&all).is_infinite());
    }
}
