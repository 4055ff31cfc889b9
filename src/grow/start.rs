//! Placement of elements, and the chains from which fractals start.

use std::ops::Range;

use crate::draws::Path;
use crate::geometry::{Frame, Frame2};
use crate::graph::{Chain, Graph, Instance, Root};
use crate::instancing::Appearance;
use crate::rule::Placement;

/// Placement of an element with all that its descendants inherit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TraversalState<F: Frame = Frame2> {
    pub(crate) frame: F,
    /// Length relative to that of the initiator's element from which it descends.
    pub(crate) length: f64,
    /// Position of that element in the initiator.
    pub(crate) root: u32,
    pub(crate) path: Path,
    /// Appearance composed of its own and those of its ancestors.
    pub(crate) appearance: Appearance,
}

impl<F: Frame> TraversalState<F> {
    /// Returns the placement of the initiator.
    pub(crate) fn whole(seed: u64) -> Self {
        Self {
            frame: F::UNIT,
            length: 1.0,
            root: 0,
            path: Path::of_seed(seed),
            appearance: Appearance::NONE,
        }
    }

    /// Returns the placement of an instance of the initiator.
    #[inline]
    pub(crate) fn root(&self, graph: &Graph<F>, instance: &Instance<F>) -> Self {
        let child = Self {
            length: 1.0,
            root: instance.position,
            ..self.placed(graph, instance, graph.listed_position(instance.position))
        };
        match graph.roots.elements.get(instance.position as usize) {
            None => child,
            Some(&Root {
                path,
                length,
                appearance,
                ..
            }) => Self {
                path,
                length,
                appearance,
                ..child
            },
        }
    }

    /// Returns the placement of an instance that replaces part of this element.
    #[inline]
    pub(crate) fn child(&self, graph: &Graph<F>, instance: &Instance<F>) -> Self {
        self.placed(graph, instance, instance.position)
    }

    /// Returns the placement of an instance in this element; draws see it at a position.
    #[inline]
    fn placed(&self, graph: &Graph<F>, instance: &Instance<F>, position: u32) -> Self {
        Self {
            frame: self.frame.compose(&instance.frame),
            length: self.length * instance.length,
            root: self.root,
            path: if graph.draws() {
                let path = self.path.child(position);
                match &instance.corners {
                    Some(corners) => path.with_corners(self.path, corners),
                    None => path,
                }
            } else {
                self.path
            },
            appearance: if graph.has_appearances() {
                self.appearance.over(graph.appearance(instance.object))
            } else {
                self.appearance
            },
        }
    }
}

/// Chain from which a fractal starts, and its placement.
#[derive(Clone, Debug)]
pub(super) struct Start<'g, F: Frame = Frame2> {
    pub(super) chain: StartChain<'g, F>,
    pub(super) state: TraversalState<F>,
    /// Step in which the fractal is born.
    pub(super) born: u32,
    /// Fractals that it seeded before the growth of this graph: range in [`Roots::seeded`](crate::graph::Roots).
    pub(super) seeded: Range<usize>,
}

#[derive(Clone, Debug)]
pub(super) enum StartChain<'g, F: Frame = Frame2> {
    /// Initiator, an image of it, or a fractal seeded before: its instances are roots.
    Initiator(&'g [Instance<F>]),
    /// Seed of a fixed successor, with the indices of the object and of the seed.
    Fixed {
        chain: &'g Chain<F>,
        seed: [usize; 2],
    },
    Evaluated(Chain<F>),
}

impl<'g, F: Frame> Start<'g, F> {
    /// Returns the start of growth by a number of steps.
    pub(super) fn initiator(graph: &'g Graph<F>, steps: u32, seed: u64) -> Self {
        Self::image(graph, steps, seed, 0)
    }

    /// Returns the starts of growth by a number of steps: the initiator and its images.
    pub(super) fn all(graph: &'g Graph<F>, steps: u32, seed: u64) -> Vec<Self> {
        let images = 0..graph.initiator(steps).count();
        images
            .map(|image| Self::image(graph, steps, seed, image))
            .collect()
    }

    fn image(graph: &'g Graph<F>, steps: u32, seed: u64, image: usize) -> Self {
        Self {
            chain: StartChain::Initiator(graph.initiator(steps).fractal(image)),
            state: TraversalState::whole(seed),
            born: 0,
            seeded: graph.roots.seeded_by(image),
        }
    }

    /// Returns the start of a fractal that was seeded before.
    pub(super) fn seeded(graph: &'g Graph<F>, number: usize) -> Self {
        let seeded = &graph.roots.seeded[number];
        Self {
            chain: StartChain::Initiator(&seeded.chain.instances),
            // Each root has its own path, so the seed is unused.
            state: TraversalState::whole(0),
            born: seeded.born,
            seeded: graph.roots.seeded_by(graph.initiator(0).count() + number),
        }
    }

    /// Returns the first step after `step` in which roots are born, or in which elements that seeded
    /// fractals before were replaced.
    pub(super) fn next_after(&self, graph: &Graph<F>, step: u32) -> Option<u32> {
        let StartChain::Initiator(roots) = self.chain else {
            return None;
        };
        let roots = roots.iter().filter_map(|it| birth(graph, it));
        let seeded = graph.roots.seeded[self.seeded.clone()].iter();
        let all = roots.chain(seeded.map(|seeded| seeded.born - 1));
        all.filter(|&next| next > step).min()
    }

    pub(super) fn instances(&self) -> &[Instance<F>] {
        match &self.chain {
            StartChain::Initiator(instances) => instances,
            StartChain::Fixed { chain, .. } => &chain.instances,
            StartChain::Evaluated(chain) => &chain.instances,
        }
    }
}

/// Returns the step in which a root was born, if growth begins with later approximants.
pub(super) fn birth<F: Frame>(graph: &Graph<F>, instance: &Instance<F>) -> Option<u32> {
    let root = graph.roots.elements.get(instance.position as usize);
    root.map(|root| root.level)
}

/// Returns the placement of a part that an element seeds.
pub(crate) fn seed_placement<F: Frame>(
    graph: &Graph<F>,
    state: &TraversalState<F>,
    placement: Placement,
) -> TraversalState<F> {
    if placement != Placement::SeedsAsInitiator {
        return *state;
    }
    // Positions in the initiator count from 0 in the order of listing.
    let root = graph.initiator(0).instances[state.root as usize].frame;
    let [origin, _] = state.frame.ends();
    TraversalState {
        frame: root.moved_to(origin),
        length: 1.0,
        ..*state
    }
}
