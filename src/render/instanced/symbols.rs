//! Symbols of a picture: one for each object, number of steps, and subset of painted elements.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use crate::geometry::{Direction, Frame, Frame2, Outline};
use crate::graph::{Chain, Graph, Instance, Replacement, Successor};
use crate::instancing::Appearance;
use crate::style::ColorBy;

use super::super::classes::Classes;
use super::Work;

/// Subset of the elements of an expanded object that are painted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ElementSubset {
    All,
    /// Elements born this many steps after the object.
    Born(u32),
    /// Elements of the object's own fractal.
    Own,
    /// Elements of fractals seeded this many steps later, at least 1.
    Seeded(u32),
    /// Elements of a class that their object determines.
    Class(u64),
    /// Elements of a direction relative to the object's.
    Heading(Direction),
}

/// Number of steps, subset and appearance of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Aspect {
    /// Number of remaining steps.
    pub(super) steps: u32,
    pub(super) part: ElementSubset,
    /// Appearance, including the object's own change.
    pub(super) dress: Dress,
}

/// Appearance as a key: ordered by the bits of its fields.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dress(pub(super) Appearance);

impl PartialEq for Dress {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Dress {}

impl PartialOrd for Dress {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Dress {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.bits().cmp(&other.0.bits())
    }
}

/// Symbol: an object expanded by a number of steps, or a subset of its elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Symbol {
    // The derived order puts symbols with fewer remaining steps, of which others consist, first.
    pub(super) aspect: Aspect,
    pub(super) object: usize,
}

/// Returns whether lines link joined elements, because base elements do not end at their end points.
pub(super) fn link<F: Frame>(graph: &Graph<F>) -> bool {
    let mut visible = graph.objects().iter().filter(|object| object.visible);
    visible.any(|object| {
        let base_element = &graph.base_elements()[object.base_element];
        !base_element.is_closed() && base_element.ends_meet_frame() != [true; 2]
    })
}

/// Source of the symbols of a graph.
pub(super) struct Symbols<'g, F: Frame = Frame2> {
    graph: &'g Graph<F>,
    by: ColorBy,
    classes: Classes,
    /// For every object, the first object with an equal subtree.
    alike: Vec<usize>,
    /// Whether lines link neighbours.
    pub(super) links: bool,
}

impl<'g, F: Frame> Symbols<'g, F> {
    pub(super) fn new(graph: &'g Graph<F>, by: ColorBy, classes: Classes) -> Self {
        let mut first = BTreeMap::new();
        let objects = graph.objects().iter().enumerate();
        let alike = objects
            .map(|(number, object)| {
                // Objects of equal behaviour may differ in their last maps, on which colours may depend.
                let becomes = (object.behaviour, object.last_map);
                *first.entry(becomes).or_insert(number)
            })
            .collect();
        Self {
            graph,
            by,
            classes,
            alike,
            links: link(graph),
        }
    }

    /// Returns whether an element belongs to a subset.
    pub(super) fn paints(
        &self,
        object: usize,
        born: u32,
        direction: Direction,
        part: ElementSubset,
    ) -> bool {
        let object = &self.graph.objects()[object];
        match part {
            ElementSubset::All | ElementSubset::Own => true,
            ElementSubset::Seeded(_) => false,
            ElementSubset::Born(steps) => born == steps,
            ElementSubset::Class(class) => self.classes.of_object(object).unwrap_or(0) == class,
            ElementSubset::Heading(heading) => direction == heading,
        }
    }

    /// Returns the symbol of an object; `None` if it is known to be empty.
    fn symbol(&self, object: usize, aspect: Aspect) -> Option<Symbol> {
        let Aspect { steps, part, .. } = aspect;
        let replacement = &self.graph.objects()[object].replacement;
        if steps == 0 || matches!(replacement, Replacement::Kept) {
            let is_painted = self.graph.objects()[object].visible
                && self.paints(object, 0, Direction::Normal, part);
            let aspect = Aspect {
                steps: 0,
                part: ElementSubset::All,
                ..aspect
            };
            return is_painted.then_some(Symbol { aspect, object });
        }
        let steps = match part {
            ElementSubset::Born(0) => return None,
            // Of the elements born before the last step, only infertile ones remain, after any number of
            // further steps; the lines that link them to others depend on that number.
            ElementSubset::Born(born) if !self.links => steps.min(born + 1),
            _ => steps,
        };
        Some(Symbol {
            aspect: Aspect { steps, ..aspect },
            object: self.alike[object],
        })
    }

    /// Returns the symbol of an instance in a symbol with the aspect `of`; `seeded` is whether the instance
    /// starts a new fractal.
    pub(super) fn child(
        &self,
        instance: &Instance<F>,
        of: &Aspect,
        seeded: bool,
    ) -> Option<Symbol> {
        let part = match of.part {
            ElementSubset::Born(steps) => ElementSubset::Born(steps.checked_sub(1)?),
            ElementSubset::Heading(heading) => {
                ElementSubset::Heading(heading * instance.frame.direction())
            }
            ElementSubset::Own if seeded => return None,
            ElementSubset::Seeded(1) => {
                return self
                    .dressed(instance, of, ElementSubset::Own)
                    .filter(|_| seeded);
            }
            ElementSubset::Seeded(steps) => ElementSubset::Seeded(steps - 1),
            other => other,
        };
        self.dressed(instance, of, part)
    }

    fn dressed(&self, instance: &Instance<F>, of: &Aspect, part: ElementSubset) -> Option<Symbol> {
        let Dress(appearance) = of.dress;
        let dress = Dress(if self.graph.has_appearances() {
            let appearance = appearance.over(self.graph.appearance(instance.object));
            match self.by {
                ColorBy::Tint => appearance,
                _ => appearance.without_colour(),
            }
        } else {
            appearance
        });
        let steps = of.steps.checked_sub(1)?;
        self.symbol(instance.object, Aspect { steps, part, dress })
    }

    /// Returns the successor that replaces a symbol's object.
    pub(super) fn successor(&self, symbol: &Symbol) -> Option<&'g Successor<F>> {
        match &self.graph.objects()[symbol.object].replacement {
            Replacement::Fixed(successor) if symbol.aspect.steps > 0 => Some(successor),
            _ => None,
        }
    }

    /// Returns all symbols that occur in a chain with one of several aspects, each after those of which it
    /// consists; `None` if they take more work than is left.
    pub(super) fn collect(
        &self,
        chain: &Chain<F>,
        aspects: impl Iterator<Item = Aspect>,
        work: &mut Work,
    ) -> Option<Vec<Symbol>> {
        let mut open = BTreeSet::new();
        for of in aspects {
            if !work.take(chain.instances.len()) {
                return None;
            }
            let instances = chain.instances.iter();
            open.extend(instances.filter_map(|instance| self.child(instance, &of, false)));
        }
        let mut all = Vec::new();
        while let Some(symbol) = open.pop_last() {
            if all.len() + open.len() > work.symbols {
                return None;
            }
            if let Some(successor) = self.successor(&symbol) {
                if !work.take(successor.placed_instances().count()) {
                    return None;
                }
                let instances = successor.placed_instances();
                open.extend(instances.filter_map(|(placement, instance)| {
                    self.child(instance, &symbol.aspect, placement.seeds())
                }));
            }
            all.push(symbol);
        }
        all.reverse();
        Some(all)
    }
}
