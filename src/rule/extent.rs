//! Bounds on the positions and lengths of a generator's elements over all random draws.

use crate::draws::{Cells, MAX_CELLS};
use crate::expression::{Interval, Program};
use crate::geometry::DVec3;

use super::frame::{Place, RuleFrame};
use super::generator::{ElementContext, Generator, ListedElement, Move};

/// Bounds that hold for an element over all draws.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Extent {
    /// Largest distance of its midpoint from the midpoint of the unit frame.
    pub(crate) away: f64,
    /// Largest length.
    pub(crate) length: f64,
}

impl<F: RuleFrame> Generator<F> {
    /// Returns upper bounds of the power means (E[xᵖ])^(1/p), p being `power`, of the quantities x of
    /// [`Extent`], for each element by position; of their maxima over all draws if the power is infinite. They
    /// hold at all moments within the given limits, up to rounding.
    ///
    /// The bounds result from interval arithmetic on parts of the variables' ranges: smaller parts lose less
    /// by treating coordinates that depend on one variable as independent.
    pub(crate) fn extents(&self, power: f64, moment: &[Interval; 4]) -> Vec<Extent> {
        let cover = |element| self.cover(element, power, moment);
        self.elements().map(cover).collect()
    }

    fn cover(&self, element: &ListedElement, power: f64, moment: &[Interval; 4]) -> Extent {
        if element.is_stretched() {
            // Not bounded by its ends.
            return Extent {
                away: f64::INFINITY,
                length: f64::INFINITY,
            };
        }
        let ends = [element.from, element.to];
        let moves = self.moves.iter();
        let moves = moves.filter(|moving| ends.iter().any(|end| moving.points.contains(end)));
        let own = ends.iter().flat_map(|&end| self.points[end].as_ref());
        let programs = own.chain(moves.flat_map(Move::programs));
        let cells = Cells::new(
            &self.variables,
            ElementContext::NAMES.len(),
            MAX_CELLS,
            programs,
        );
        let mut means = PowerMeans::new(power);
        cells.visit(moment, |slots, likely| {
            let [from, to] = ends.map(|number| {
                let moves = self.moves.iter();
                let moves = moves.filter(|moving| moving.points.contains(&number));
                let written = place(self.points[number].as_ref(), slots, 0.0);
                moves.fold(written, |place, moving| moving.image(place, slots))
            });
            let middle = [1.0, 0.0, 0.0].map(Interval::point);
            let extent = Extent {
                away: far(minus(plus(from, to), middle)) / 2.0,
                length: far(minus(to, from)),
            };
            means.add(extent, likely);
        });
        means.extent()
    }
}

/// Power means of extents, or their maxima.
pub(crate) struct PowerMeans {
    /// Exponent; infinite for maxima.
    power: f64,
    sum: Extent,
}

impl PowerMeans {
    /// Creates power means for an exponent, which is infinite for maxima.
    pub(crate) fn new(power: f64) -> Self {
        Self {
            power,
            sum: Extent::default(),
        }
    }

    /// Adds an extent with its probability.
    pub(crate) fn add(&mut self, extent: Extent, likely: f64) {
        let power = self.power;
        let add = |sum: &mut f64, value: f64| {
            if power.is_infinite() {
                *sum = sum.max(value);
            } else {
                *sum += likely * libm::pow(value, power);
            }
        };
        add(&mut self.sum.away, extent.away);
        add(&mut self.sum.length, extent.length);
    }

    /// Returns the means.
    pub(crate) fn extent(&self) -> Extent {
        let root = |sum| match self.power.is_infinite() {
            true => sum,
            false => libm::pow(sum, 1.0 / self.power),
        };
        Extent {
            away: root(self.sum.away),
            length: root(self.sum.length),
        }
    }
}

impl<F: RuleFrame> Move<F> {
    /// Returns a box of the images of a point under the move.
    fn image(&self, point: Place, slots: &[Interval]) -> Place {
        let about = place(self.about.as_ref(), slots, 0.0);
        let scale = place(self.scale.as_ref(), slots, 1.0);
        let away = minus(point, about);
        let scaled = [0, 1, 2].map(|axis: usize| away[axis] * scale[axis]);
        let turned = F::turned(&self.rotate, scaled, slots);
        plus(plus(turned, about), place(self.shift.as_ref(), slots, 0.0))
    }
}

/// Returns the ranges of coordinates; `absent` is that of a third one in the plane.
fn place(coordinates: &[Program], slots: &[Interval], absent: f64) -> Place {
    let range = |axis: usize| coordinates.get(axis).map(|program| program.range(slots));
    [0, 1, 2].map(|axis| range(axis).unwrap_or(Interval::point(absent)))
}

fn plus(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|axis: usize| a[axis] + b[axis])
}

fn minus(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|axis: usize| a[axis] - b[axis])
}

/// Returns the largest distance of a point in a box from the origin.
fn far(place: Place) -> f64 {
    DVec3::from(place.map(Interval::magnitude)).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{Catalogue, Shelf};
    use crate::document::Document;
    use crate::draws::Path;
    use crate::geometry::DVec2;

    #[test]
    fn what_is_drawn_keeps_within_its_extents() {
        let catalogue = Catalogue::embedded();
        let entries = catalogue.entries();
        let mut drawn = 0;
        for entry in entries.iter().filter(|entry| entry.shelf == Shelf::RULES) {
            let document = Document::read(&catalogue.open(entry).unwrap(), &catalogue).unwrap();
            let Some(rule) = document.resolve(&[]).unwrap().0.into_rule() else {
                continue;
            };
            let limits = [[1.0, 9.0], [0.0, 4.0], [0.0, 4.0], [0.0, 1.0]];
            let limits = limits.map(|[low, high]| Interval::new(low, high));
            for generator in rule.generators() {
                let extents = generator.extents(f64::INFINITY, &limits);
                for number in 0..if generator.is_random() { 500 } else { 1 } {
                    let moment = ElementContext {
                        index: f64::from(number % 9 + 1),
                        age: f64::from(number % 5),
                        step: f64::from(number % 4),
                        length: f64::from(number % 7) / 6.0,
                    };
                    let path = Path::of_seed(3).child(number);
                    let (mut slots, mut points) = (Vec::new(), Vec::new());
                    generator.evaluate(&moment, path, &mut slots, &mut points);
                    for (element, extent) in generator.elements().zip(&extents) {
                        let [from, to] = [points[element.from], points[element.to]];
                        let away = (from + to - DVec2::X).length() / 2.0;
                        let length = (to - from).length();
                        let most = [extent.away, extent.length].map(|most| most * (1.0 + 1e-12));
                        assert!(away <= most[0] && length <= most[1], "{}", entry.name);
                        drawn += 1;
                    }
                }
            }
        }
        assert!(drawn > 10_000, "{drawn}");
    }

    #[test]
    fn parts_keep_in_mind_what_is_drawn_together() {
        let catalogue = Catalogue::embedded();
        for (name, generator, longest) in [("sea-fan", 0, 1.0), ("random-tree", 0, 0.9)] {
            let source = catalogue.component(Shelf::RULES, name).unwrap();
            let rule = Document::read(&source, &catalogue)
                .unwrap()
                .resolve(&[])
                .unwrap()
                .0
                .into_rule()
                .unwrap();
            let generator = &rule.generators()[generator];
            let extents = generator.extents(f64::INFINITY, &[Interval::ALL; 4]);
            for (element, extent) in generator.elements().zip(extents) {
                assert!(
                    !element.fertile || extent.length < longest,
                    "{name}: {extent:?}"
                );
            }
        }
    }
}
