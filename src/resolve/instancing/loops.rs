//! Check that the loops of an instancing graph contract.

use crate::diagnostic::Diagnostic;
use crate::digraph::components;
use crate::document::InstancingDocument;
use crate::geometry::{DMat2, stretch};
use crate::ifs::{Contraction, Verdict};
use crate::instancing::{Instancing, Master};
use crate::resolve::Resolver;

use super::OfInstancing;

/// Maximum number of pairs of successive instances for which contraction is decided.
const MOST_WAYS: usize = 1_000_000;

/// Maximum number of relaxations of instances in the test by stretches.
const MOST_LOOKS: usize = 10_000_000;

const UNKNOWN: &str = "it can be grown by a number of steps, but its limit is not known";

/// An instance that lies on a loop.
struct Edge {
    from: usize,
    to: usize,
    linear: DMat2,
}

impl Edge {
    /// Returns the largest factor by which the instance stretches a vector.
    fn stretch(&self) -> f64 {
        stretch(&self.linear)
    }
}

impl Resolver<OfInstancing> {
    /// Refuses a structure with a loop that does not contract, and warns if the verdict is undecided.
    pub(super) fn check_loops(
        &mut self,
        document: &InstancingDocument,
        structure: &Instancing,
    ) -> Option<()> {
        let edges = edges(structure);
        if shrink_by_stretch(&edges, structure.objects.len()) {
            return Some(());
        }
        let linear: Vec<DMat2> = edges.iter().map(|edge| edge.linear).collect();
        // The map that is applied after an instance's map is that of an instance of its object.
        let mut outer = vec![Vec::new(); structure.objects.len()];
        for (number, edge) in edges.iter().enumerate() {
            outer[edge.to].push(number);
        }
        let ways = edges.iter().map(|edge| outer[edge.from].len());
        if ways.sum::<usize>() > MOST_WAYS {
            let message = "there are too many ways to tell whether all loops contract";
            let place = &document.heading.place;
            let warning = Diagnostic::warning(message).at(place).hint(UNKNOWN);
            self.diagnostics.push(warning);
            return Some(());
        }
        let after = edges.iter().map(|edge| outer[edge.from].clone()).collect();
        let contraction = Contraction::of(&linear, Some(after));
        let name = |edge: &usize| structure.objects[edges[*edge].from].name.as_str();
        let object = contraction.word.last().map_or("", name);
        let written = document
            .objects
            .iter()
            .find(|written| object.split('(').next() == Some(&written.name.value));
        let place = written.map_or(&document.heading.place, |written| &written.name.place);
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
                    "ways of up to {} instances do not tell whether all loops contract",
                    contraction.length
                );
                let warning = Diagnostic::warning(message).at(place).hint(UNKNOWN);
                self.diagnostics.push(warning);
                Some(())
            }
        }
    }
}

/// Returns whether every loop contracts by the largest stretches of its instances, a sufficient
/// condition: the longest paths under the logarithms of the stretches converge (Bellman 1958) if and
/// only if the product along every loop of n instances is at most the n-th power of `LEAST`.
fn shrink_by_stretch(edges: &[Edge], objects: usize) -> bool {
    /// A loop of n instances must contract by the n-th power of this factor.
    const LEAST: f64 = 1.0 - 1e-9;
    let stretches = edges.iter().map(|edge| libm::log(edge.stretch() / LEAST));
    let stretches: Vec<f64> = stretches.collect();
    let mut largest = vec![0.0; objects];
    let rounds = objects.min(MOST_LOOKS / edges.len().max(1));
    (0..=rounds).any(|_| {
        let mut has_settled = true;
        for (edge, stretch) in edges.iter().zip(&stretches) {
            let along = largest[edge.from] + stretch;
            if along > largest[edge.to] {
                largest[edge.to] = along;
                has_settled = false;
            }
        }
        has_settled
    })
}

/// Returns the instances of objects in objects that lie on loops.
fn edges(structure: &Instancing) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (from, object) in structure.objects.iter().enumerate() {
        for instance in &object.instances {
            if let Master::Object(to) = instance.master {
                let linear = structure.map_of(instance).matrix2;
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
