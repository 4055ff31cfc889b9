//! Check that the loops of an instancing graph contract.

use std::collections::BTreeSet;

use crate::digraph::{all_loops_shrink, components};
use crate::document::InstancingDocument;
use crate::geometry::{Linear, Point as _};
use crate::ifs::{Contraction, PointOf, Verdict};
use crate::instancing::{Instancing, Master, ObjectInstance, cells_of_each};
use crate::resolve::Resolver;

use super::{OfInstancing, StructureMap};

/// Maximum number of pairs of successive instances for which contraction is decided.
const MAX_WAYS: usize = 1_000_000;

/// Maximum number of relaxations of instances in the test by stretches.
const MAX_LOOKS: usize = 10_000_000;

const UNKNOWN: &str = "it can be grown by a number of steps, but its limit is not known";

/// An instance that lies on a loop.
struct Edge<'s, M: StructureMap> {
    from: usize,
    to: usize,
    /// Number of the strongly connected component of its ends.
    component: usize,
    instance: &'s ObjectInstance<M>,
    /// Whether its map is drawn.
    is_drawn: bool,
}

impl<M: StructureMap> Resolver<OfInstancing<M>> {
    /// Refuses a structure with a loop that does not contract, and warns if the verdict is undecided.
    pub(super) fn check_loops(
        &mut self,
        document: &InstancingDocument,
        structure: &Instancing<M>,
    ) -> Option<()> {
        let mut edges = edges(structure);
        let objects = structure.objects.len();
        let cells = cells_of_each(edges.iter().filter(|edge| edge.is_drawn).count());
        let stretches =
            { edges.iter() }.map(|edge| (edge.from, edge.to, stretch(structure, edge, cells)));
        let rounds = objects.min(MAX_LOOKS / edges.len().max(1));
        if all_loops_shrink(objects, &stretches.collect::<Vec<_>>(), rounds) {
            return Some(());
        }
        // Loops with drawn maps are decided by their largest stretches, others by their maps.
        let is_drawn: BTreeSet<usize> = { edges.iter().filter(|edge| edge.is_drawn) }
            .map(|edge| edge.component)
            .collect();
        let drawn = edges.extract_if(.., |edge| is_drawn.contains(&edge.component));
        let drawn: Vec<_> = { drawn }
            .map(|edge| (edge.from, edge.to, stretch(structure, &edge, cells)))
            .collect();
        if !all_loops_shrink(objects, &drawn, rounds) {
            let message = "draws do not let it be decided whether all loops contract";
            self.warn(&document.metadata.place.first_line(), message, UNKNOWN);
        }
        if edges.is_empty() {
            return Some(());
        }
        let linear: Vec<M::Linear> = { edges.iter() }
            .map(|edge| structure.map_of(edge.instance).linear())
            .collect();
        // The map that is applied after an instance's map is that of an instance of its object.
        let mut outer = vec![Vec::new(); structure.objects.len()];
        for (number, edge) in edges.iter().enumerate() {
            outer[edge.to].push(number);
        }
        let ways = edges.iter().map(|edge| outer[edge.from].len());
        if ways.sum::<usize>() > MAX_WAYS {
            let message = "there are too many ways to decide whether all loops contract";
            let place = &document.metadata.place;
            self.warn(place, message, UNKNOWN);
            return Some(());
        }
        let after = edges.iter().map(|edge| outer[edge.from].clone()).collect();
        let contraction = Contraction::of::<M>(&linear, Some(after));
        let name = |edge: &usize| structure.objects[edges[*edge].from].name.as_str();
        let object = contraction.word.last().map_or("", name);
        let written = document
            .objects
            .iter()
            .find(|written| object.split('(').next() == Some(&written.name.value));
        let place = written.map_or(&document.metadata.place, |written| &written.name.place);
        match contraction.verdict {
            Verdict::Contracts => Some(()),
            Verdict::Diverges => {
                let way = contraction.word.iter().rev().map(name).chain([object]);
                let way = way.collect::<Vec<_>>().join(" > ");
                let message = format!("an instancing loop does not contract: {way}");
                let hint = "what leads back to an object must become smaller on the way";
                self.error_with_hint(place, message, hint);
                None
            }
            Verdict::Undecided => {
                let message = format!(
                    "ways of up to {} instances do not decide whether all loops contract",
                    contraction.length
                );
                self.warn(place, message, UNKNOWN);
                Some(())
            }
        }
    }
}

/// Returns the instances of objects in objects that lie on loops.
fn edges<M: StructureMap>(structure: &Instancing<M>) -> Vec<Edge<'_, M>> {
    let mut edges = Vec::new();
    for (from, object) in structure.objects.iter().enumerate() {
        for instance in &object.instances {
            if let Master::Object(to) = instance.master {
                edges.push(Edge {
                    from,
                    to,
                    component: 0,
                    instance,
                    is_drawn: instance.needed(&structure.variables).contains(&true),
                });
            }
        }
    }
    let mut targets = vec![Vec::new(); structure.objects.len()];
    for edge in &edges {
        targets[edge.from].push(edge.to);
    }
    let component = components(&targets);
    edges.retain(|edge| component[edge.from] == component[edge.to]);
    for edge in &mut edges {
        edge.component = component[edge.from];
    }
    edges
}

/// Returns the stretch of an instance's map, or an upper bound of it if the map is drawn, by a number of cells of the draws.
fn stretch<M: StructureMap>(structure: &Instancing<M>, edge: &Edge<'_, M>, cells: usize) -> f64 {
    let map = structure.map_of(edge.instance);
    if !edge.is_drawn {
        return map.linear().stretch();
    }
    let inner = &structure.objects[edge.to].map;
    let level = structure.objects[edge.from].level();
    let drawn = (structure.variables(), level, cells);
    let extent = edge
        .instance
        .extent_of_draws(inner, drawn, f64::INFINITY, PointOf::<M>::ZERO);
    extent.length
}
