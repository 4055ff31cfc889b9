//! Bounds on the positions and lengths of a generator's elements over all random draws.

use crate::expression::{Dependence, Interval, Program};
use crate::geometry::DVec3;

use super::frame::{Place, RuleFrame};
use super::generator::{ElementContext, Generator, ListedElement, Move};

/// Limit of the number of parts into which the ranges of all drawn variables together are divided.
const MAX_PARTS: usize = 1024;

/// Limit of the number of parts of one variable's range.
const MAX_PARTS_OF_ONE: usize = 32;

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
        let root = |sum| match power.is_infinite() {
            true => sum,
            false => libm::pow(sum, 1.0 / power),
        };
        let mean = |element| {
            let Extent { away, length } = self.cover(element, power, moment);
            Extent {
                away: root(away),
                length: root(length),
            }
        };
        self.elements().map(mean).collect()
    }

    fn cover(&self, element: &ListedElement, power: f64, moment: &[Interval; 4]) -> Extent {
        if element.is_stretched() {
            // Not bounded by its ends.
            return Extent {
                away: f64::INFINITY,
                length: f64::INFINITY,
            };
        }
        let mut cover = Cover {
            generator: self,
            element,
            parts: self.parts_for(element),
            power,
            extent: Extent::default(),
        };
        cover.go_on(&mut moment.to_vec(), 1.0);
        cover.extent
    }

    /// Returns the number of parts into which the range of each variable is divided: 1 for variables that
    /// do not affect the element.
    fn parts_for(&self, element: &ListedElement) -> Vec<usize> {
        let ends = [element.from, element.to];
        let moves = self.moves.iter();
        let moves = moves.filter(|moving| ends.iter().any(|end| moving.points.contains(end)));
        let own = ends.iter().flat_map(|&end| self.points[end].as_ref());
        let mut programs: Vec<&Program> = own.chain(moves.flat_map(Move::programs)).collect();
        let mut parts = vec![1; self.variables.len()];
        let mut free = 0;
        let mut left = MAX_PARTS;
        for (number, variable) in self.variables.iter().enumerate().rev() {
            let slot = ElementContext::NAMES.len() + number;
            let depends = |program: &&Program| program.dependence(slot) != Dependence::None;
            if programs.iter().any(depends) {
                programs.extend(variable.programs());
                parts[number] = match variable.choices() {
                    Some(choices) if choices <= left => choices,
                    Some(_) => 1,
                    None => 0,
                };
                free += u32::from(parts[number] == 0);
                left /= parts[number].max(1);
            }
        }
        let fits = |parts: &usize| parts.checked_pow(free).is_some_and(|all| all <= left);
        let each = (2..=MAX_PARTS_OF_ONE).rev().find(fits).unwrap_or(1);
        for parts in parts.iter_mut().filter(|parts| **parts == 0) {
            *parts = each;
        }
        parts
    }
}

/// Recursion over the parts of the variables' ranges.
struct Cover<'g, F: RuleFrame> {
    generator: &'g Generator<F>,
    element: &'g ListedElement,
    parts: Vec<usize>,
    /// Exponent of the power means; infinite for maxima.
    power: f64,
    extent: Extent,
}

impl<F: RuleFrame> Cover<'_, F> {
    /// Recurses into the parts of the next variable's range; `likely` is the probability of the parts so
    /// far.
    fn go_on(&mut self, slots: &mut Vec<Interval>, likely: f64) {
        let number = slots.len() - ElementContext::NAMES.len();
        let Some(variable) = self.generator.variables.get(number) else {
            return self.add(slots, likely);
        };
        for (part, share) in variable.parts(slots, self.parts[number]) {
            slots.push(part);
            self.go_on(slots, likely * share);
            slots.pop();
        }
    }

    fn add(&mut self, slots: &[Interval], likely: f64) {
        let [from, to] = [self.element.from, self.element.to].map(|number| {
            let moves = self.generator.moves.iter();
            let moves = moves.filter(|moving| moving.points.contains(&number));
            let written = place(self.generator.points[number].as_ref(), slots, 0.0);
            moves.fold(written, |place, moving| moving.image(place, slots))
        });
        let middle = [1.0, 0.0, 0.0].map(Interval::point);
        let away = far(minus(plus(from, to), middle)) / 2.0;
        let length = far(minus(to, from));
        let power = self.power;
        let add = |sum: &mut f64, value: f64| {
            if power.is_infinite() {
                *sum = sum.max(value);
            } else {
                *sum += likely * libm::pow(value, power);
            }
        };
        add(&mut self.extent.away, away);
        add(&mut self.extent.length, length);
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
