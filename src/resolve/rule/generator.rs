//! Resolution of generators.

use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::digraph::all_loops_shrink;
use crate::document::{Entry, GeneratorDocument, Written, WrittenNumber, WrittenPoint};
use crate::expression::Scope;
use crate::geometry::Point as _;

use super::{OfRule, ResolvedFrame};
use crate::resolve::Resolver;
use crate::rule::{
    ElementContext, Generator, ListedAttitude, ListedElement, Move, Origin, Part, Placement,
    Selection, constant,
};

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    pub(super) fn generator(
        &mut self,
        name: &Written<String>,
        document: &GeneratorDocument,
        moment: &Arc<Scope>,
    ) -> Generator<F> {
        let mut scope = Scope::inside(moment);
        let slots = ElementContext::NAMES.len();
        let has_edges = F::DIRECTIONS > 4;
        let variables = self.variables(&document.random, &mut scope, slots, has_edges);
        let mut written = Vec::new();
        let mut parts = Vec::new();
        let mut ends = Vec::new();
        let mut seeding = Vec::new();
        for part in &document.parts {
            let ring = part.placement.seeds();
            let elements = self.elements(
                &part.entries,
                part.closed,
                part.connected,
                &mut written,
                ring,
            );
            let meets_frame = if ring || !part.connected {
                [false; 2]
            } else {
                let meets =
                    |element: Option<&ListedElement>, point: fn(&ListedElement) -> usize, x| {
                        element.is_some_and(|element| is_written(&written[point(element)], x))
                    };
                let first = part.entries.first().is_none_or(|entry| match entry {
                    Entry::Element(listed) => listed.connected,
                    Entry::Point(_) => true,
                });
                [
                    first && meets(elements.first(), |element| element.from, 0.0),
                    meets(elements.last(), |element| element.to, 1.0),
                ]
            };
            seeding.resize(written.len(), ring);
            if !ring {
                ends.extend(elements.first().map(|element| (element.from, false)));
                ends.extend(elements.last().map(|element| (element.to, true)));
            }
            parts.push(Part {
                placement: part.placement,
                elements,
                meets_frame,
            });
        }
        // The two ends of the replacement: the first and the last point of the parts that are not
        // seeds.
        let first = ends
            .iter()
            .find(|(_, last)| !last)
            .map(|(number, _)| *number);
        let last = ends
            .iter()
            .rfind(|(_, last)| *last)
            .map(|(number, _)| *number);
        let inner = (0..written.len())
            .filter(|number| seeding[*number] || Some(*number) != first && Some(*number) != last);
        let inner = inner.collect();
        let mut moves = self.moves(document, &scope, written.len(), inner);
        let listed = parts.iter_mut().flat_map(|part| &mut part.elements);
        self.append_vectors(listed, &mut written);
        let elements = parts.iter().flat_map(|part| &part.elements);
        move_normals(&mut moves, &normals_of(elements), written.len());
        let points: Vec<_> = written
            .iter()
            .map(|point| F::point_in(self, point, &scope))
            .collect();
        // Moves may change what is written.
        if moves.is_empty() {
            let known = points.iter().map(constant::<F>);
            let known: Vec<_> = known
                .map(|it| it.unwrap_or(F::Point::splat(f64::NAN)))
                .collect();
            let elements = parts.iter().flat_map(|part| part.elements.iter().cloned());
            self.check_attitudes(&elements.collect::<Vec<_>>(), &known, &written);
        }
        for part in &mut parts {
            self.find_corners(&mut part.elements, &points, &written, &variables, false);
        }
        self.doubt_growth(&parts, &points, &written);
        // Moves may separate points that coincide as written.
        if document.moves.is_empty() {
            self.doubt_length(&parts, &points, &written);
        }
        Generator {
            origin: Origin {
                name: name.place.clone(),
                points: written,
            },
            name: name.value.clone(),
            variables,
            points,
            moves,
            parts,
        }
    }

    /// Warns of elements without length.
    fn doubt_length(
        &mut self,
        parts: &[Part],
        points: &[F::Coordinates],
        written: &[WrittenPoint],
    ) {
        for element in parts.iter().flat_map(|part| &part.elements) {
            let from = constant::<F>(&points[element.from]);
            if from.is_some() && from == constant::<F>(&points[element.to]) {
                let place = &written[element.to].place;
                self.warn(
                    place,
                    "this element has no length",
                    "it ends where it starts",
                );
            }
        }
    }

    /// Collects warnings of fertile elements that are not shorter than those they replace.
    fn doubt_growth(
        &mut self,
        parts: &[Part],
        points: &[F::Coordinates],
        written: &[WrittenPoint],
    ) {
        let value = |number: usize| constant::<F>(&points[number]);
        let relative = parts
            .iter()
            .filter(|part| part.placement != Placement::SeedsAsInitiator);
        for element in relative
            .flat_map(|part| &part.elements)
            .filter(|element| element.fertile)
        {
            let (Some(from), Some(to)) = (value(element.from), value(element.to)) else {
                continue;
            };
            let length = (to - from).length();
            if length >= 1.0 {
                // Rounded, but not to 1.
                let mut rounded = { [1e3, 1e6, 1e9, 1e12].into_iter() }
                    .map(|unit| (length * unit).round() / unit);
                let times = rounded.find(|length| *length != 1.0);
                let times = times.map_or(String::new(), |times| format!("{times} times "));
                let message = format!(
                    "this element does not shrink: it is {times}as long as what it replaces"
                );
                let hint = "finite steps can be drawn, but there is no limit set";
                let warning = Diagnostic::warning(message)
                    .at(&written[element.to].place)
                    .hint(hint);
                self.kind.growing.push(warning);
            }
        }
    }
}

/// Returns the normals of elements: the ends of the element, and the number of the normal.
fn normals_of<'a>(elements: impl Iterator<Item = &'a ListedElement>) -> Vec<([usize; 2], usize)> {
    let normals = elements.filter_map(|element| match element.attitude {
        ListedAttitude::Normal(number) => Some(([element.from, element.to], number)),
        _ => None,
    });
    normals.collect()
}

/// Lets moves take the normals of the elements both ends of which they move. Moves that share a list of points share the
/// list of normals.
fn move_normals<F: ResolvedFrame>(
    moves: &mut [Move<F>],
    normals: &[([usize; 2], usize)],
    points: usize,
) {
    if normals.is_empty() {
        return;
    }
    let mut before: Option<&Move<F>> = None;
    for moving in moves {
        moving.normals = match before {
            Some(before) if Arc::ptr_eq(&before.points, &moving.points) => {
                Arc::clone(&before.normals)
            }
            _ => {
                let mut moved = vec![false; points];
                moving
                    .points
                    .iter()
                    .for_each(|&number| moved[number] = true);
                let normals = normals.iter();
                let normals = normals.filter(|(ends, _)| ends.iter().all(|&end| moved[end]));
                normals.map(|&(_, number)| number).collect()
            }
        };
        before = Some(&*moving);
    }
}

/// Returns whether the lengths along every cycle of generators have a product below 1, for every choice
/// that the selection admits: the largest products of lengths over all paths converge (Bellman 1958).
pub(super) fn loops_shrink<F: ResolvedFrame>(
    generators: &[Generator<F>],
    selection: &Selection,
) -> bool {
    let candidates = selection.candidates();
    let mut ways = Vec::new();
    for (from, generator) in generators.iter().enumerate() {
        let parts = generator.parts.iter();
        let relative = parts.filter(|part| part.placement != Placement::SeedsAsInitiator);
        let elements = relative.flat_map(|part| &part.elements);
        for element in elements.filter(|element| element.fertile) {
            let ends = [element.from, element.to];
            let [Some(start), Some(end)] = ends.map(|it| constant::<F>(&generator.points[it]))
            else {
                return false;
            };
            let length = (end - start).length();
            match element.generator {
                Some(to) => ways.push((from, to, length)),
                None => ways.extend(candidates.iter().map(|&to| (from, to, length))),
            }
        }
    }
    all_loops_shrink(generators.len(), &ways, generators.len())
}

/// Returns whether the first coordinate of a point is written as exactly this constant, and the others as 0.
fn is_written(point: &WrittenPoint, x: f64) -> bool {
    let is = |number: &WrittenNumber, value: f64| {
        number
            .value
            .compile(&Scope::new())
            .is_ok_and(|program| program.as_constant() == Some(value))
    };
    is(&point.x, x) && is(&point.y, 0.0) && point.z.as_ref().is_none_or(|z| is(z, 0.0))
}
