//! Check that the loops of an instancing graph contract.

use crate::digraph::{all_loops_shrink, components};
use crate::document::InstancingDocument;
use crate::geometry::Linear;
use crate::ifs::{Contraction, Verdict};
use crate::instancing::{Instancing, Master};
use crate::resolve::Resolver;

use super::{OfInstancing, StructureMap};

/// Maximum number of pairs of successive instances for which contraction is decided.
const MAX_WAYS: usize = 1_000_000;

/// Maximum number of relaxations of instances in the test by stretches.
const MAX_LOOKS: usize = 10_000_000;

const UNKNOWN: &str = "it can be grown by a number of steps, but its limit is not known";

/// An instance that lies on a loop.
struct Edge<L> {
    from: usize,
    to: usize,
    linear: L,
}

impl<M: StructureMap> Resolver<OfInstancing<M>> {
    /// Refuses a structure with a loop that does not contract, and warns if the verdict is undecided.
    pub(super) fn check_loops(
        &mut self,
        document: &InstancingDocument,
        structure: &Instancing<M>,
    ) -> Option<()> {
        let edges = edges(structure);
        let objects = structure.objects.len();
        let stretches = edges
            .iter()
            .map(|edge| (edge.from, edge.to, edge.linear.stretch()));
        let rounds = objects.min(MAX_LOOKS / edges.len().max(1));
        if all_loops_shrink(objects, &stretches.collect::<Vec<_>>(), rounds) {
            return Some(());
        }
        let linear: Vec<M::Linear> = edges.iter().map(|edge| edge.linear).collect();
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
fn edges<M: StructureMap>(structure: &Instancing<M>) -> Vec<Edge<M::Linear>> {
    let mut edges = Vec::new();
    for (from, object) in structure.objects.iter().enumerate() {
        for instance in &object.instances {
            if let Master::Object(to) = instance.master {
                let linear = structure.map_of(instance).linear();
                edges.push(Edge { from, to, linear });
            }
        }
    }
    let mut targets = vec![Vec::new(); structure.objects.len()];
    for edge in &edges {
        targets[edge.from].push(edge.to);
    }
    let component = components(&targets);
    edges.retain(|edge| component[edge.from] == component[edge.to]);
    edges
}
