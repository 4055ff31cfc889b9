//! Which symbols a picture has: one an object and number of steps, and of what is painted.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use crate::geometry::Direction;
use crate::graph::{Chain, Graph, Instance, Production, Replacement};
use crate::instancing::Coat;
use crate::style::ColorBy;

use super::super::Classes;

/// What of all that stands for an object is painted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    All,
    /// What is born so many steps later.
    Born(u32),
    /// What is of the object's own fractal.
    Own,
    /// What is of fractals that are seeded so many steps later, one at least.
    Seeded(u32),
    /// What is of a class that its object tells.
    Class(u64),
    /// What has a direction relative to the object's.
    Heading(Direction),
}

/// What of an object is shown, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Aspect {
    /// The steps that it has to go.
    pub(super) steps: u32,
    pub(super) part: Part,
    /// What it is tinted with, its own tint included.
    pub(super) dress: Dress,
}

/// A coat that can be told from others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dress(pub(super) Coat);

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

/// A symbol: what stands for an object after a number of steps, or a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Symbol {
    /// The first field: symbols are made of others that have fewer steps to go.
    pub(super) aspect: Aspect,
    pub(super) object: usize,
}

/// Whether lines link elements that are joined.
pub(super) fn link(graph: &Graph) -> bool {
    let mut visible = graph.objects().iter().filter(|object| object.visible);
    visible.any(|object| {
        let base_element = &graph.base_elements()[object.base_element];
        !base_element.is_closed() && base_element.ends_meet_frame() != [true; 2]
    })
}

/// What tells symbols.
pub(super) struct Symbols<'g> {
    graph: &'g Graph,
    by: ColorBy,
    classes: Classes,
    /// The first object that becomes the same, by object.
    alike: Vec<usize>,
    /// Whether lines link neighbours.
    pub(super) links: bool,
}

impl<'g> Symbols<'g> {
    pub(super) fn new(graph: &'g Graph, by: ColorBy, classes: Classes) -> Self {
        let mut first = BTreeMap::new();
        let objects = graph.objects().iter().enumerate();
        let alike = objects
            .map(|(number, object)| {
                // What becomes of an object tells its last map as well.
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

    /// Whether an element is of a part.
    pub(super) fn paints(
        &self,
        object: usize,
        born: u32,
        direction: Direction,
        part: Part,
    ) -> bool {
        let object = &self.graph.objects()[object];
        match part {
            Part::All | Part::Own => true,
            Part::Seeded(_) => false,
            Part::Born(steps) => born == steps,
            Part::Class(class) => self.classes.of_object(object).unwrap_or(0) == class,
            Part::Heading(heading) => direction == heading,
        }
    }

    /// The symbol of an object; `None` if it is known to be empty.
    fn symbol(&self, object: usize, aspect: Aspect) -> Option<Symbol> {
        let Aspect { steps, part, .. } = aspect;
        let replacement = &self.graph.objects()[object].replacement;
        if steps == 0 || matches!(replacement, Replacement::Kept) {
            let is_painted = self.graph.objects()[object].visible
                && self.paints(object, 0, Direction::Normal, part);
            let aspect = Aspect {
                steps: 0,
                part: Part::All,
                ..aspect
            };
            return is_painted.then_some(Symbol { aspect, object });
        }
        let steps = match part {
            Part::Born(0) => return None,
            // Of what is born sooner than in the end, infertile elements are left, however many steps
            // follow; where lines link them to others, it matters where those have come to.
            Part::Born(born) if !self.links => steps.min(born + 1),
            _ => steps,
        };
        Some(Symbol {
            aspect: Aspect { steps, ..aspect },
            object: self.alike[object],
        })
    }

    /// The symbol of an instance in something of which an aspect is shown; whether it is seeded.
    pub(super) fn child(&self, instance: &Instance, of: &Aspect, seeded: bool) -> Option<Symbol> {
        let part = match of.part {
            Part::Born(steps) => Part::Born(steps.checked_sub(1)?),
            Part::Heading(heading) => Part::Heading(heading * instance.frame.direction),
            Part::Own if seeded => return None,
            Part::Seeded(1) => return self.dressed(instance, of, Part::Own).filter(|_| seeded),
            Part::Seeded(steps) => Part::Seeded(steps - 1),
            other => other,
        };
        self.dressed(instance, of, part)
    }

    fn dressed(&self, instance: &Instance, of: &Aspect, part: Part) -> Option<Symbol> {
        let Dress(coat) = of.dress;
        let dress = Dress(if self.graph.coats() {
            let coat = coat.over(self.graph.coat(instance.object));
            match self.by {
                ColorBy::Tint => coat,
                _ => coat.without_colour(),
            }
        } else {
            coat
        });
        let steps = of.steps.checked_sub(1)?;
        self.symbol(instance.object, Aspect { steps, part, dress })
    }

    /// What takes the place of a symbol's object.
    pub(super) fn production(&self, symbol: &Symbol) -> Option<&'g Production> {
        match &self.graph.objects()[symbol.object].replacement {
            Replacement::Fixed(production) if symbol.aspect.steps > 0 => Some(production),
            _ => None,
        }
    }

    /// All symbols that aspects of something lead to that has a chain in its place, each after those
    /// that it is made of; `None` if there are more than `most`.
    pub(super) fn collect(
        &self,
        chain: &Chain,
        aspects: impl Iterator<Item = Aspect>,
        most: usize,
    ) -> Option<Vec<Symbol>> {
        let mut open = BTreeSet::new();
        for of in aspects {
            let instances = chain.instances.iter();
            open.extend(instances.filter_map(|instance| self.child(instance, &of, false)));
        }
        let mut all = Vec::new();
        while let Some(symbol) = open.pop_last() {
            if all.len() + open.len() > most {
                return None;
            }
            if let Some(production) = self.production(&symbol) {
                let instances = production.placed_instances();
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
