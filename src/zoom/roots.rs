//! Construction of the graph that starts from the results of a descent.

use std::collections::VecDeque;

use crate::graph::{Chain, Graph, Instance, Replacement, Roots, SeededFractal};
use crate::rule::BaseElement;

use super::items::{FoundRoot, FractalItem, FractalPart, RootDrawing};
use super::{Zoom, ZoomError, ZoomWindow};

/// Graph under construction.
struct Rooted {
    graph: Graph,
    base_elements: Vec<BaseElement>,
    /// Number of behaviours.
    behaviours: usize,
    roots: Roots,
    deepest: u32,
}

/// Builds the graph of the roots in the fractals `lines`, each of which is listed after the one that
/// seeded it.
pub(super) fn zoom(
    graph: &Graph,
    window: &ZoomWindow,
    mut lines: Vec<FractalPart>,
) -> Result<Zoom, ZoomError> {
    let mut rooted = Rooted {
        base_elements: graph.base_elements().to_vec(),
        behaviours: graph.behaviours().count(),
        graph: graph.clone(),
        roots: Roots::default(),
        deepest: 0,
    };
    let mut shows = vec![false; lines.len()];
    for (number, line) in lines.iter().enumerate().rev() {
        shows[number] = line.items.iter().any(|item| match item {
            FractalItem::Node(_) => false,
            FractalItem::Root(_) => true,
            FractalItem::Seed(seed) => shows[*seed],
        });
    }
    let mut chains = Vec::new();
    // Queue of fractals, each with the number of the one that seeded it and the number of roots before
    // it. The initiator is the first; images of it come next, of which some do not show.
    let images = (0..graph.initiator(0).count()).filter(|&image| image == 0 || shows[image]);
    let mut open: VecDeque<_> = images.map(|image| (image, 0, 0)).collect();
    let images = open.len();
    while let Some((number, by, before)) = open.pop_front() {
        let FractalPart { born, items, .. } = &mut lines[number];
        let mut chain = Chain::default();
        let mut seeds = Vec::new();
        for item in std::mem::take(items) {
            match item {
                FractalItem::Node(_) => {}
                FractalItem::Root(found) => rooted.add(*found, window, &mut chain)?,
                FractalItem::Seed(seed) if shows[seed] => seeds.push((seed, rooted.position())),
                FractalItem::Seed(_) => {}
            }
        }
        let born = *born;
        // A stable sort keeps the order of the seeds of one step.
        seeds.sort_by_key(|(seed, _)| lines[*seed].born);
        let place = chains.len();
        open.extend(
            seeds
                .into_iter()
                .map(|(seed, before)| (seed, place, before)),
        );
        chains.push(SeededFractal {
            by,
            before,
            born,
            chain,
        });
    }
    let mut graph = rooted.graph;
    graph.base_elements = rooted.base_elements.into();
    rooted.roots.seeded = chains.split_off(images);
    let mut initiator = Chain::default();
    for (image, fractal) in chains.into_iter().enumerate() {
        if image > 0 {
            initiator.breaks.push(initiator.instances.len());
        }
        initiator.instances.extend(fractal.chain.instances);
    }
    *graph.initiators_mut() = vec![initiator];
    graph.listed = None;
    graph.roots = rooted.roots.into();
    Ok(Zoom {
        graph,
        deepest: rooted.deepest,
    })
}

impl Rooted {
    /// Returns the position of the next root.
    fn position(&self) -> u32 {
        u32::try_from(self.roots.elements.len()).unwrap_or(u32::MAX)
    }

    /// Adds a root to a chain.
    fn add(
        &mut self,
        found: FoundRoot,
        window: &ZoomWindow,
        chain: &mut Chain,
    ) -> Result<(), ZoomError> {
        let parts = match found.drawn {
            RootDrawing::Object => vec![(found.frame, None)],
            RootDrawing::Clipped(outline) => vec![(found.frame, Some(outline))],
            RootDrawing::Around(path) => {
                let ways = path.ways().into_iter();
                ways.map(|way| (way.frame, Some(way.outline))).collect()
            }
        };
        for (number, (frame, drawn)) in parts.into_iter().enumerate() {
            let mut object = found.object;
            if let Some(outline) = drawn {
                if window.relative_stroke > 0.0 {
                    return Err(ZoomError::WideStroke);
                }
                object = self.drawn(object, outline);
            }
            chain.instances.push(Instance {
                corners: None,
                frame,
                length: frame.stretch(),
                joined: found.joined || number > 0,
                position: self.position(),
                object,
            });
            self.deepest = self.deepest.max(found.root.level);
            self.roots.elements.push(found.root);
        }
        Ok(())
    }

    /// Creates an infertile copy of an object with another outline.
    fn drawn(&mut self, object: usize, outline: BaseElement) -> usize {
        let mut of = self.graph.objects()[object].clone();
        of.base_element = self.base_elements.len();
        of.behaviour = self.behaviours;
        of.replacement = Replacement::Kept;
        self.base_elements.push(outline);
        self.behaviours += 1;
        self.graph.objects.push(of);
        self.graph.objects.len() - 1
    }
}
