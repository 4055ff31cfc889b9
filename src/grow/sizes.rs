//! How many elements come of an object in a few steps.

use crate::graph::{Alternative, Graph, Object, Replacement};

/// Steps beyond these are not counted.
const MOST_STEPS: usize = 64;

/// Of graphs with more objects than this no sizes are worked out.
const MOST_OBJECTS: usize = 1 << 14;

/// The numbers of elements that objects become in their fractals, up to some size: exact where
/// instances are fixed, the most that there can be where they are worked out.
pub(super) struct Sizes {
    /// By object and number of steps.
    counts: Vec<Vec<u64>>,
}

impl Sizes {
    /// Of what becomes no more than `most` elements by fixed instances.
    pub(super) fn fixed(graph: &Graph, most: u64) -> Self {
        Self::of(graph, most, |_, _| u64::MAX)
    }

    /// Of what cannot become more than `most` elements.
    pub(super) fn most(graph: &Graph, most: u64) -> Self {
        Self::of(graph, most, |alternatives, counts| {
            // Seeds are counted as if they stayed.
            let of = |alternative: &Alternative| sum(alternative.objects.iter().copied(), counts);
            alternatives.iter().map(of).max().unwrap_or(u64::MAX)
        })
    }

    fn of(graph: &Graph, most: u64, evaluated: impl Fn(&[Alternative], &[u64]) -> u64) -> Self {
        let objects = graph.objects();
        if objects.len() > MOST_OBJECTS {
            return Self { counts: Vec::new() };
        }
        let mut counts = vec![vec![1]; objects.len()];
        let mut now = vec![1; objects.len()];
        for steps in 1..=MOST_STEPS {
            let count = |object: &Object| match &object.replacement {
                Replacement::Kept => 1,
                Replacement::Fixed(production) => {
                    let instances = production.body.instances.iter();
                    sum(instances.map(|instance| instance.object), &now)
                }
                Replacement::Evaluated(alternatives) => evaluated(alternatives, &now),
                Replacement::Beyond => u64::MAX,
            };
            let next: Vec<_> = objects.iter().map(count).collect();
            let mut grows = false;
            for (object, &count) in next.iter().enumerate() {
                let is_kept = matches!(objects[object].replacement, Replacement::Kept);
                if !is_kept && counts[object].len() == steps && count <= most {
                    counts[object].push(count);
                    grows = true;
                }
            }
            if !grows {
                break;
            }
            now = next;
        }
        Self { counts }
    }

    /// How many elements an object becomes in a number of steps, if it is replaced in the first and
    /// they are few.
    #[inline]
    pub(super) fn get(&self, object: usize, steps: u32) -> Option<u64> {
        self.counts
            .get(object)?
            .get(steps as usize)
            .copied()
            .filter(|_| steps > 0)
    }

    /// All sizes together.
    pub(super) fn sum(&self) -> u64 {
        self.counts.iter().flatten().sum()
    }

    /// By object, the most steps whose size is known.
    pub(super) fn steps(&self) -> impl Iterator<Item = usize> {
        self.counts.iter().map(|counts| counts.len() - 1)
    }
}

fn sum(objects: impl Iterator<Item = usize>, counts: &[u64]) -> u64 {
    let counts = objects.map(|object| counts[object]);
    counts.fold(0, u64::saturating_add)
}
