//! Prepass without a walk: prepasses that the graph determines.

use std::collections::BTreeSet;
use std::convert::Infallible;
use std::num::NonZero;
use std::sync::Arc;

use crate::extent::Limits;
use crate::geometry::{Bounds, Direction};
use crate::graph::{Graph, Object, Replacement};
use crate::grow::{Census, Growth, WalkError};
use crate::rule::Placement;
use crate::style::{ColorBy, ColorProperty, Style};

use super::classes::Classes;
use super::prepass::Prepass;

/// Size of a set, relative to the unit length and to its coordinates, below which it is measured by a walk.
const SPECK: f64 = 1e-6;

/// Maximum number of steps for which the ages of seeded fractals are computed.
const MAX_AGES: u32 = 256;

/// Purpose of what is known of an approximant, on which the work that it may take depends.
#[derive(Clone, Copy)]
pub(super) enum Purpose<'b> {
    /// Drawing: all that is known is exact, and found if that is possible at all.
    Drawing,
    /// Estimate of the size of a file, which is not made if it takes much work. The boxes of approximants are known by their
    /// steps, about.
    Estimate(&'b dyn Fn(u32) -> Option<Bounds>),
}

impl Purpose<'_> {
    /// Returns the number of kinds of children that may be looked at.
    fn most_kinds(self) -> usize {
        match self {
            Self::Drawing => usize::MAX,
            Self::Estimate(_) => 1 << 18,
        }
    }

    /// Returns the limits of a search for the bounding box.
    fn limits(self) -> Limits {
        match self {
            Self::Drawing => Limits::DRAWING,
            Self::Estimate(_) => Limits::ESTIMATE,
        }
    }

    /// Returns the bounding box of an approximant, with padding around every object, if the graph determines it.
    fn padded_bounds(
        self,
        graph: &Graph,
        steps: u32,
        pad: impl Fn(&Object) -> f64,
    ) -> Option<Bounds> {
        match self {
            Self::Estimate(bounds) if graph.objects().iter().all(|it| pad(it) == 0.0) => {
                bounds(steps)
            }
            _ => graph.padded_bounds(steps, pad),
        }
    }
}

impl<'g> Prepass<'g> {
    /// Makes the prepass of an approximant: from the graph if it determines everything, otherwise by a walk.
    /// Colours that depend on steps span `steps` of them.
    pub(crate) fn of(
        graph: &'g Graph,
        growth: &Growth<'_>,
        style: &'g Style,
        steps: u32,
        threads: NonZero<usize>,
    ) -> Result<Self, WalkError<Infallible>> {
        match Self::known(graph, growth, style, steps) {
            Some(known) => Ok(known),
            None => Self::new(graph, style, steps).walked(growth, threads),
        }
    }

    /// Computes the prepass of an approximant from the graph, if that determines all of it; if the colour
    /// depends on steps, its classes span `steps` of them.
    pub(super) fn known(
        graph: &'g Graph,
        growth: &Growth<'_>,
        style: &'g Style,
        steps: u32,
    ) -> Option<Self> {
        let level = level(graph, growth)?;
        let seeds = level.fractals > 1;
        let mut prepass = Self::outlined(graph, growth, style, steps, seeds, Purpose::Drawing)?;
        prepass.elements = level.elements;
        prepass.fractals = level.fractals;
        if style.color_by == ColorBy::Index {
            let census = Census::of(graph, growth.steps, 0.0);
            return prepass.count_ranks(census, growth.steps).then_some(prepass);
        }
        Some(prepass)
    }

    /// Computes the prepass without the numbers of elements, which may exceed all limits.
    pub(super) fn outlined(
        graph: &'g Graph,
        growth: &Growth<'_>,
        style: &'g Style,
        steps: u32,
        seeds: bool,
        purpose: Purpose<'_>,
    ) -> Option<Self> {
        let mut prepass = Self::new(graph, style, steps);
        if prepass.needs_lengths() {
            return None;
        }
        let with_ages = style.color_by == ColorBy::Age && seeds;
        let stands = ElementKinds::at(graph, growth.steps, with_ages, purpose.most_kinds())?;
        prepass.bounds = prepass.known_bounds(growth, purpose)?;
        let used: Vec<u128> = match style.color_by.property() {
            ColorProperty::Uniform | ColorProperty::Tint | ColorProperty::Frame => vec![0],
            ColorProperty::Age if seeds => {
                stands.values(|stands| (growth.steps - stands.seeded).into())
            }
            ColorProperty::Age => vec![growth.steps.into()],
            ColorProperty::Fractal | ColorProperty::Index => Vec::new(),
            ColorProperty::Step => stands.values(|stands| stands.born.into()),
            ColorProperty::Object => {
                let classes = Classes::before_survey(style, graph, steps);
                let value = |object: usize| classes.value_of_object(&graph.objects()[object]);
                stands.values(|stands| value(stands.object).unwrap_or(0))
            }
            ColorProperty::Direction => {
                stands.values(|stands| u128::from(stands.direction.number()) - 1)
            }
        };
        for value in used {
            prepass.use_value(value);
        }
        prepass.strokes = stands
            .0
            .iter()
            .any(|stands| prepass.is_stroked(&graph.objects()[stands.object]));
        Some(prepass)
    }

    /// Computes the bounding box from the graph, or by a search.
    fn known_bounds(&self, growth: &Growth<'_>, purpose: Purpose<'_>) -> Option<Bounds> {
        let pad = |object: &Object| self.pad(object);
        if let Some(bounds) = purpose.padded_bounds(self.graph(), growth.steps, pad) {
            // The precision of the box is relative to the unit length and to the coordinates, not to its size.
            let corners = [bounds.min(), bounds.max()];
            let far = corners.map(|corner| corner.abs().max_element());
            let is_speck = bounds.size().max_element() < SPECK * (1.0 + far[0].max(far[1]));
            return (!is_speck).then_some(bounds);
        }
        let glimpsed = self
            .clone()
            .glimpsed(growth, &self.reaches(), purpose.limits())?;
        Some(glimpsed.bounds)
    }
}

/// Numbers of elements and fractals of an approximant.
struct Numbers {
    elements: u64,
    fractals: u64,
}

fn level(graph: &Graph, growth: &Growth<'_>) -> Option<Numbers> {
    if graph.counts_index() {
        return None;
    }
    let mut forecast = graph.forecast()?;
    for _ in 0..growth.steps {
        if !forecast.advance() {
            return None;
        }
    }
    let level = forecast.level();
    let elements = level.elements.to_u64()?;
    (elements <= growth.max_elements).then_some(Numbers {
        elements,
        fractals: level.fractals.to_u64()?,
    })
}

/// Kind of visible elements of an approximant.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct ElementKind {
    object: usize,
    direction: Direction,
    born: u32,
    /// Step of birth of its fractal, if ages are computed; otherwise 0.
    seeded: u32,
}

/// All kinds of visible elements of an approximant.
struct ElementKinds(BTreeSet<ElementKind>);

impl ElementKinds {
    /// Computes the kinds, with the births of their fractals if `with_ages`; `None` if they depend on draws,
    /// if there may be many ages, or if more than `most` children have to be looked at. Elements that are replaced alike
    /// count as one, and steps with the kinds of the step before take no work.
    fn at(graph: &Graph, steps: u32, with_ages: bool, most: usize) -> Option<Self> {
        if with_ages && (steps > MAX_AGES || !graph.roots.elements.is_empty()) {
            return None;
        }
        let mut stand = BTreeSet::new();
        let mut looked = 0;
        let initiator = graph.initiator(steps).instances.iter();
        let mut born: BTreeSet<Descendant> = initiator
            .map(|instance| (instance.object, instance.frame.direction(), 0))
            .collect();
        // Whether all later steps have the kinds of this one, because the step before has.
        let mut is_settled = false;
        for level in 0..=steps {
            let mut parents = BTreeSet::new();
            for &(object, direction, seeded) in &born {
                let own = &graph.objects()[object];
                if level < steps && !own.is_kept() {
                    if is_settled {
                        continue;
                    }
                    // Successors are shared by reference.
                    let successor = own.successor().map(|it| Arc::as_ptr(it).addr());
                    parents.insert((successor.ok_or(object), direction, seeded, object));
                } else if own.visible {
                    stand.insert(ElementKind {
                        object,
                        direction,
                        born: level,
                        seeded,
                    });
                }
                looked += 1;
            }
            if looked > most {
                return None;
            }
            if level == steps || is_settled {
                continue;
            }
            let mut next = BTreeSet::new();
            let mut before = None;
            for (successor, direction, seeded, object) in parents {
                let parent = Some((successor, direction, seeded));
                if parent == before {
                    continue;
                }
                before = parent;
                looked += add_children(
                    graph,
                    (object, direction, seeded),
                    level,
                    with_ages,
                    &mut next,
                )?;
                if looked > most {
                    return None;
                }
            }
            is_settled = next == born;
            born = next;
        }
        Some(Self(stand))
    }

    fn values(&self, value: impl Fn(&ElementKind) -> u128) -> Vec<u128> {
        self.0.iter().map(value).collect()
    }
}

/// Object, direction and step of birth of the fractal of an element, the last only if ages are computed.
type Descendant = (usize, Direction, u32);

/// Adds the children of an element that is replaced in a step, and returns the number of those that were looked at; `None`
/// if they depend on draws.
fn add_children(
    graph: &Graph,
    (object, direction, seeded): Descendant,
    level: u32,
    with_ages: bool,
    next: &mut BTreeSet<Descendant>,
) -> Option<usize> {
    let is_seeded = |placement: Placement| with_ages && placement.seeds();
    let mut looked = 0;
    // The direction is wrong for parts placed as the initiator, but their bounding box is unknown.
    match &graph.objects()[object].replacement {
        Replacement::Fixed(production) => {
            next.extend(production.placed_instances().map(|(placement, child)| {
                looked += 1;
                let seeded = if is_seeded(placement) {
                    level + 1
                } else {
                    seeded
                };
                (child.object, direction * child.frame.direction(), seeded)
            }));
        }
        Replacement::Evaluated(alternatives) => {
            let ([only], Some(rule)) = (&alternatives[..], graph.source().rule()) else {
                return None;
            };
            let mut parts = graph.parts(only).iter();
            if parts.any(|part| is_seeded(part.placement)) {
                return None;
            }
            let elements = rule.generators()[only.generator].elements();
            let directions = elements.map(|element| direction * element.direction);
            let children = only.objects.iter().zip(directions);
            looked += only.objects.len();
            next.extend(children.map(|(&object, direction)| (object, direction, seeded)));
        }
        Replacement::Kept | Replacement::Unresolved => {}
    }
    Some(looked)
}

#[cfg(test)]
mod tests {
    use std::num::NonZero;

    use super::Prepass;
    use crate::catalogue::{Catalogue, Shelf};
    use crate::diagnostic::Source;
    use crate::document::Document;
    use crate::geometry::DVec2;
    use crate::graph::Graph;
    use crate::grow::{Growth, walk};
    use crate::style::{ColorBy, Named, Style, Width};

    #[test]
    fn what_the_graph_tells_is_what_a_walk_finds() {
        let catalogue = Catalogue::embedded();
        let entries = catalogue.entries();
        let [mut compared, mut aged] = [0; 2];
        for entry in entries.iter().filter(|entry| entry.shelf == Shelf::RULES) {
            let source = catalogue.open(entry).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            let Some(rule) = document.resolve(&[]).unwrap().0.into_rule() else {
                continue;
            };
            let graph = Graph::compile(&rule, 3).unwrap();
            for (_, color_by) in ColorBy::NAMES {
                for width in [Width::Pixels(1.0), Width::Relative(0.2)] {
                    let style = Style {
                        width,
                        color_by: *color_by,
                        ..rule.style().clone()
                    };
                    for steps in [0, 1, 3] {
                        let growth = Growth::steps(steps);
                        let Some(known) = Prepass::known(&graph, &growth, &style, 3) else {
                            continue;
                        };
                        compared += 1;
                        aged += u32::from(graph.seeds && *color_by == ColorBy::Age);
                        let mut walked = Prepass::new(&graph, &style, 3);
                        walk(&graph, &growth, &mut walked).unwrap();
                        let what = format!("{} at {steps} by {color_by:?}", entry.name);
                        let far = |a: DVec2, b: DVec2| (a - b).length();
                        assert!(
                            far(known.bounds.min(), walked.bounds.min()) < 1e-12,
                            "{what}"
                        );
                        assert!(
                            far(known.bounds.max(), walked.bounds.max()) < 1e-12,
                            "{what}"
                        );
                        assert_eq!(known.elements, walked.elements, "{what}");
                        assert_eq!(known.fractals, walked.fractals, "{what}");
                        assert_eq!(known.strokes, walked.strokes, "{what}");
                        assert_eq!(known.classes(), walked.classes(), "{what}");
                    }
                }
            }
        }
        assert!(compared > 1000 && aged > 10, "{compared}, {aged} of ages");
    }
    /// The cases are elements that are drawn in some steps only, and a set that has shrunk to a speck.
    #[test]
    fn what_the_graph_does_not_tell_is_left_to_the_walk() {
        let spine = "initiator: [[0, 0], {to: [1, 0], fertile: false}, {from: [1, 0], to: [1.5, 0]}]\n\
                     generators:\n  a: [{from: [1, 0], to: [1.5, 0], visible: false}]\n  \
                     b: [{from: [1, 0], to: [1.5, 0]}]\n\
                     select: [{when: age % 2 == 1, use: b}, {use: a}]\n";
        let speck = "initiator: segment\nbase_element: triangle\ngenerator: [[0, 0], {to: [0.33, -0.04]}]\n";
        for text in [spine, speck] {
            let source = Source::new("test.yaml", text);
            let document = Document::read(&source, &Catalogue::embedded()).unwrap();
            let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
            for steps in [2, 20, 60, 80] {
                let graph = Graph::compile(&rule, steps).unwrap();
                let growth = Growth::steps(steps);
                let style = Style::default();
                let known =
                    Prepass::of(&graph, &growth, &style, steps, NonZero::<usize>::MIN).unwrap();
                let mut walked = Prepass::new(&graph, &style, steps);
                walk(&graph, &growth, &mut walked).unwrap();
                let off = known.bounds.size() - walked.bounds.size();
                let size = walked.bounds.size().max_element();
                assert!(off.abs().max_element() <= 1e-9 * size, "{text} at {steps}");
            }
        }
    }
}
