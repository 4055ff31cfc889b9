//! Colonies: seeded fractals, each together with all its descendant fractals.
//!
//! If all maps are fixed, a seeded fractal is determined by its seed, by the step of its birth and, where
//! elements below a minimum length are not replaced, by the length of the element that seeded it. A visitor
//! that draws all colonies of a kind from one of them takes them without a walk.

use std::collections::BTreeMap;

use crate::geometry::{DAffine2, DMat2, DVec2, Direction, Frame, Frame2, stretch};
use crate::graph::{Chain, Graph, Instance, Seed};

use super::start::{Start, StartChain, TraversalState};
use super::walk::walk_over;
use super::{Visitor, WalkError, Walked};

/// Maximum number of kinds of fertile elements, over all steps.
const MAX_KINDS: usize = 1 << 14;

/// Relative tolerance within which lengths are equal, and tolerance of the entries of maps.
const NEAR: f64 = 1e-10;

/// Steps of quantisation of the entries of normalised linear maps.
const TURNS: f64 = 1e6;

/// Seeded fractal with all its descendant fractals.
#[derive(Clone, Copy, Debug)]
pub struct Colony<'g, F: Frame = Frame2> {
    graph: &'g Graph<F>,
    /// Index of the object that seeded it, and of the seed in its successor.
    seed: [usize; 2],
    state: TraversalState<F>,
    born: u32,
    steps: u32,
}

/// Part of a colony that a visitor takes without a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    /// Nothing.
    Nothing,
    /// The elements of its first fractal, without the descendant fractals.
    Own {
        /// Number of these elements.
        elements: u64,
    },
    /// The whole colony.
    Whole(Walked),
    /// The whole colony, of which nothing is visible: [`Visitor::colony`] is not called.
    Unseen,
}

impl Taken {
    /// Returns the numbers of elements and fractals taken.
    pub(super) fn walked(self) -> Walked {
        match self {
            Self::Nothing | Self::Unseen => Walked::default(),
            Self::Own { elements } => Walked {
                elements,
                fractals: 1,
            },
            Self::Whole(walked) => walked,
        }
    }
}

impl<'g, F: Frame> Colony<'g, F> {
    /// Creates the colony of a fractal in approximant `steps`; `None` unless a fixed successor seeds it.
    pub(super) fn of(graph: &'g Graph<F>, start: &Start<'g, F>, steps: u32) -> Option<Self> {
        let StartChain::Fixed { seed, .. } = start.chain else {
            return None;
        };
        Some(Self {
            graph,
            seed,
            state: start.state,
            born: start.born,
            steps,
        })
    }

    /// Returns the frame of the element that seeded it.
    pub(crate) fn frame(&self) -> F {
        self.state.frame
    }

    /// Returns the step in which its first fractal is born.
    pub(crate) fn born(&self) -> u32 {
        self.born
    }

    /// Visits the elements of the first fractal, or of the whole colony.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`walk`](super::walk()).
    pub(crate) fn walk<V: Visitor<F>>(
        &self,
        is_whole: bool,
        visitor: &mut V,
    ) -> Result<Walked, WalkError<V::Error>> {
        let Some(seed) = seed_of(self.graph, self.seed) else {
            return Ok(Walked::default());
        };
        let start = Start {
            chain: StartChain::Fixed {
                chain: &seed.chain,
                seed: self.seed,
            },
            state: self.state,
            born: self.born,
            seeded: 0..0,
        };
        walk_over(self.graph, self.steps, start, is_whole, visitor)
    }
}

impl Colony<'_> {
    /// Returns the colony with the map of its frame replaced.
    pub(crate) fn moved_to(&self, map: DAffine2) -> Self {
        let mut moved = *self;
        moved.state.frame = Frame2::new(map, self.state.frame.direction());
        moved
    }
}

fn seed_of<F: Frame>(graph: &Graph<F>, [object, number]: [usize; 2]) -> Option<&Seed<F>> {
    graph.objects()[object].successor()?.seeds.get(number)
}

/// Class of colonies that are congruent.
#[derive(Clone, Debug)]
pub(crate) struct ColonyKind {
    seed: [usize; 2],
    /// Frame of the element that seeded the first one found.
    pub(crate) frame: Frame2,
    born: u32,
    steps: u32,
    /// Number of colonies of the kind.
    pub(crate) count: u64,
    /// Number of their orientations, modulo the symmetries of the first fractal.
    pub(crate) turns: u64,
    /// Maps of the unit frame, including the identity, that preserve the first fractal.
    symmetries: Vec<DAffine2>,
}

impl ColonyKind {
    /// Returns one of the colonies.
    pub(crate) fn example<'g>(&self, graph: &'g Graph) -> Colony<'g> {
        let state = TraversalState {
            frame: self.frame,
            ..TraversalState::whole(0)
        };
        Colony {
            graph,
            seed: self.seed,
            state,
            born: self.born,
            steps: self.steps,
        }
    }

    /// Returns the instances that the first fractal starts with, in the unit frame of the seeding element.
    pub(crate) fn instances<'g>(&self, graph: &'g Graph) -> &'g [Instance] {
        let seed = seed_of(graph, self.seed);
        seed.map_or(&[], |seed| &seed.chain.instances)
    }

    /// Returns the canonical one of the maps that differ from `map` by a symmetry.
    pub(crate) fn turned(&self, map: &DAffine2) -> DAffine2 {
        turned(map, &self.symmetries)
    }
}

/// Kinds of the colonies of an approximant.
#[derive(Debug, Default)]
pub(crate) struct ColonyKinds {
    pub(crate) all: Vec<ColonyKind>,
    /// Indices of the kinds by key.
    numbers: BTreeMap<Key, Vec<usize>>,
}

/// Seed, step of birth and direction: kinds with equal keys differ in length.
type Key = ([usize; 2], u32, Direction);

/// Linear maps and numbers of fertile elements, by object, direction, length and orientation.
type Fertile = BTreeMap<(usize, Direction, i64, [i64; 4]), (DMat2, u64)>;

impl ColonyKinds {
    /// Computes the kinds for approximant `steps`, in which elements shorter than `shortest` are not
    /// replaced. The result is empty if successors are not fixed, or if there are too many kinds.
    pub(crate) fn of(graph: &Graph, steps: u32, shortest: f64) -> Self {
        let is_known = graph.seeds
            && graph.is_plain()
            && graph.is_similar()
            && !graph.counts_index()
            && !graph.is_time_indexed()
            && !graph.draws()
            && !graph.has_appearances()
            && graph.roots.elements.is_empty()
            && !graph.resets().contains(&true);
        if !is_known {
            return Self::default();
        }
        let leads = graph.leads_to_seeds();
        let mut kinds = Self::default();
        let mut turns: Vec<BTreeMap<[i64; 4], u64>> = Vec::new();
        let mut state = Fertile::new();
        let add = |state: &mut Fertile, from: (Direction, DMat2, u64), chain: &Chain| {
            let (direction, linear, count) = from;
            for instance in chain.instances.iter().filter(|it| leads[it.object]) {
                let linear = linear * instance.frame.map().matrix2;
                let direction = direction * instance.frame.direction();
                let length = round(libm::log2(stretch(&linear)) * TURNS);
                let key = (instance.object, direction, length, turn(&linear));
                state.entry(key).or_insert((linear, 0)).1 += count;
            }
        };
        let start = (Direction::Normal, DMat2::IDENTITY, 1);
        add(&mut state, start, graph.initiator(steps));
        let mut visited = 0;
        for step in 0..steps {
            visited += state.len();
            if visited > MAX_KINDS {
                return Self::default();
            }
            let mut next = Fertile::new();
            for ((object, direction, ..), (linear, count)) in state {
                let Some(successor) = graph.objects()[object].successor() else {
                    continue;
                };
                if stretch(&linear) < shortest {
                    continue;
                }
                let from = (direction, linear, count);
                add(&mut next, from, &successor.body);
                for (number, seed) in successor.seeds.iter().enumerate() {
                    add(&mut next, from, &seed.chain);
                    let frame = Frame2::new(DAffine2::from_mat2(linear), direction);
                    let seeded = ColonyKind {
                        seed: [object, number],
                        frame,
                        born: step + 1,
                        steps,
                        count: 0,
                        turns: 0,
                        symmetries: Vec::new(),
                    };
                    let kind = kinds.kind(seeded, &seed.chain);
                    turns.resize_with(kinds.all.len(), BTreeMap::new);
                    let turned = turned(frame.map(), &kinds.all[kind].symmetries);
                    *turns[kind].entry(turn(&turned.matrix2)).or_default() += count;
                }
            }
            state = next;
        }
        for (kind, turns) in kinds.all.iter_mut().zip(turns) {
            kind.turns = turns.len() as u64;
            kind.count = turns.values().sum();
        }
        kinds
    }

    /// Returns the index of a kind, which is added if it is new.
    fn kind(&mut self, kind: ColonyKind, chain: &Chain) -> usize {
        let key = (kind.seed, kind.born, kind.frame.direction());
        if let Some(number) = self.find(&key, &kind.frame) {
            return number;
        }
        let number = self.all.len();
        self.all.push(ColonyKind {
            symmetries: symmetries(chain),
            ..kind
        });
        self.numbers.entry(key).or_default().push(number);
        number
    }

    /// Returns the index of the kind of a colony; `None` if the kind is unknown.
    #[inline]
    pub(crate) fn number(&self, colony: &Colony<'_>) -> Option<usize> {
        let frame = colony.frame();
        self.find(&(colony.seed, colony.born, frame.direction()), &frame)
    }

    fn find(&self, key: &Key, frame: &Frame2) -> Option<usize> {
        let length = frame.stretch();
        let mut alike = self.numbers.get(key)?.iter().copied();
        alike.find(|&number| {
            let other = self.all[number].frame.stretch();
            (other - length).abs() <= NEAR * length
        })
    }
}

/// Computes the maps that permute the instances of a chain, starting with the identity.
fn symmetries(chain: &Chain) -> Vec<DAffine2> {
    /// Maximum number of instances of a chain that is examined.
    const MOST: usize = 64;
    let all = &chain.instances;
    let is_looked_at = all.len() <= MOST && all.iter().all(|instance| !instance.joined);
    let (Some(first), true) = (all.first(), is_looked_at) else {
        return vec![DAffine2::IDENTITY];
    };
    let same = |a: &Instance, b: &Instance| {
        a.object == b.object && a.frame.direction() == b.frame.direction()
    };
    let is_at = |a: &DAffine2, b: &DAffine2| a.abs_diff_eq(*b, NEAR);
    let back = first.frame.map().inverse();
    let candidates = all.iter().filter(|instance| same(instance, first));
    let maps = candidates.map(|instance| instance.frame.map() * back);
    let stays = |map: &DAffine2| {
        all.iter().all(|from| {
            let to = *map * from.frame.map();
            let mut all = all.iter();
            all.any(|other| same(from, other) && is_at(&to, other.frame.map()))
        })
    };
    let mut found = vec![DAffine2::IDENTITY];
    for map in maps.filter(stays) {
        if !found.iter().any(|known| is_at(known, &map)) {
            found.push(map);
        }
    }
    found
}

/// Returns the product of the map and the symmetry whose first axis has the largest x coordinate.
fn turned(map: &DAffine2, symmetries: &[DAffine2]) -> DAffine2 {
    // Differences below this are rounding errors.
    let slack = map.matrix2.x_axis.length() / TURNS;
    let all = symmetries.iter().map(|symmetry| {
        let axis = map.matrix2 * symmetry.matrix2.x_axis;
        (axis, symmetry)
    });
    let further = |(a, _): &(DVec2, _), (b, _): &(DVec2, _)| {
        let is_as_far = (a.x - b.x).abs() <= slack;
        b.x > a.x + slack || is_as_far && b.y > a.y + slack
    };
    let found = all.reduce(|a, b| if further(&a, &b) { b } else { a });
    found.map_or(*map, |(_, symmetry)| *map * *symmetry)
}

/// Returns the quantised entries of a linear map, normalised to stretch 1.
fn turn(linear: &DMat2) -> [i64; 4] {
    let unit = *linear * stretch(linear).recip();
    unit.to_cols_array().map(|part| round(part * TURNS))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn round(value: f64) -> i64 {
    (value + 0.5).floor() as i64
}

#[cfg(test)]
mod tests;
