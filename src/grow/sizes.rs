//! How many elements come of an object in a few steps.

use crate::graph::{Alternative, Graph, Object, Replacement};
use crate::whole::whole;

/// Steps beyond these are not counted.
const MOST_STEPS: usize = 64;

/// Of graphs with more objects than this no sizes are worked out.
const MOST_OBJECTS: usize = 1 << 14;

/// Lengths are told apart by so many classes an octave, up to so many classes.
const LENGTHS_AN_OCTAVE: f64 = 32.0;
const MOST_LENGTHS: usize = 640;

/// Part of a class: lengths that are as good as on its edge are on it.
const ROUNDING: f64 = 1e-6;

/// The numbers of elements that objects become in their fractals, up to some size: exact where
/// instances are fixed, the most that there can be where they are worked out.
pub(super) struct Sizes {
    /// By object and number of steps.
    counts: Vec<Vec<u64>>,
    /// By object and length, as many classes above that below which nothing is replaced.
    by_length: Vec<Vec<u64>>,
    shortest: f64,
    /// Whether objects know their number of steps: there is one number for each.
    is_levelled: bool,
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
        let count = |object: &Object, beyond: u64, now: &[u64]| match &object.replacement {
            Replacement::Kept => 1,
            Replacement::Fixed(production) => {
                let instances = production.body.instances.iter();
                sum(instances.map(|instance| instance.object), now)
            }
            Replacement::Evaluated(alternatives) => evaluated(alternatives, now),
            Replacement::Beyond => beyond,
        };
        if graph.is_levelled() {
            let mut counts = vec![1; objects.len()];
            // Objects only lead to those of larger numbers.
            for object in (0..objects.len()).rev() {
                counts[object] = count(&objects[object], 1, &counts);
            }
            let few = |count: u64| Some(count).filter(|count| *count <= most);
            let counts = counts.into_iter().map(|count| few(count).into_iter());
            return Self {
                is_levelled: true,
                ..Self::of_steps(counts.map(Iterator::collect).collect())
            };
        }
        if objects.len() > MOST_OBJECTS {
            return Self::of_steps(Vec::new());
        }
        let mut counts = vec![vec![1]; objects.len()];
        let mut now = vec![1; objects.len()];
        for steps in 1..=MOST_STEPS {
            let count = |object: &Object| count(object, u64::MAX, &now);
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
        Self::of_steps(counts)
    }

    fn of_steps(counts: Vec<Vec<u64>>) -> Self {
        Self {
            counts,
            by_length: Vec::new(),
            shortest: 0.0,
            is_levelled: false,
        }
    }

    /// Where no element is replaced that is shorter than a length: also those of what becomes no
    /// more than `most` elements down to it.
    pub(super) fn down_to(self, graph: &Graph, shortest: f64, most: u64) -> Self {
        if shortest <= 0.0 || graph.objects().len() > MOST_OBJECTS {
            return self;
        }
        // Children, and by how many classes they are shorter; those that are kept are one element,
        // however long.
        let shorter = |(object, ratio): (usize, f64)| {
            let kept = matches!(graph.objects()[object].replacement, Replacement::Kept);
            let classes = whole(ROUNDING - classes(ratio));
            (object, if kept { usize::MAX } else { classes })
        };
        let ratios = graph.ratios().into_iter().zip(graph.resets());
        let children: Vec<Option<Vec<_>>> = ratios
            .map(|(children, resets)| {
                let children = children.into_iter().map(shorter).collect();
                (!resets).then_some(children)
            })
            .collect();
        let mut by_length = vec![vec![1]; children.len()];
        for class in 1..=MOST_LENGTHS {
            let mut is_any = false;
            // What is as long as its parent must be known before.
            while lengthen(&mut by_length, &children, class, most) {
                is_any = true;
            }
            if !is_any {
                break;
            }
        }
        Self {
            by_length,
            shortest,
            ..self
        }
    }

    /// How many elements an object becomes in a number of steps, if it is replaced in the first and
    /// they are few.
    #[inline]
    pub(super) fn get(&self, object: usize, steps: u32) -> Option<u64> {
        self.counts
            .get(object)?
            .get(self.slot(steps))
            .copied()
            .filter(|_| steps > 0)
    }

    /// How many elements at most an object of a length becomes, likewise, in so many steps or
    /// before it is too short to be replaced.
    #[inline]
    pub(super) fn cut(&self, object: usize, steps: u32, length: f64) -> Option<u64> {
        let by_steps = self.get(object, steps);
        let by_length = self.by_length.get(object).and_then(|counts| {
            let class = (classes(length / self.shortest) - ROUNDING).ceil();
            counts.get(whole(class)).copied()
        });
        match (by_steps, by_length) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        }
    }

    /// Where what is known of an object in a number of steps has its place.
    #[inline]
    pub(super) fn slot(&self, steps: u32) -> usize {
        if self.is_levelled { 0 } else { steps as usize }
    }

    /// All sizes together.
    pub(super) fn sum(&self) -> u64 {
        self.counts.iter().flatten().sum()
    }

    /// By object, how many sizes are known.
    pub(super) fn slots(&self) -> impl Iterator<Item = usize> {
        self.counts.iter().map(Vec::len)
    }
}

/// Adds the sizes of a class of lengths where those of all children are known; whether there are any.
/// Children are given by object, and by how many classes they are shorter.
fn lengthen(
    by_length: &mut [Vec<u64>],
    children: &[Option<Vec<(usize, usize)>>],
    class: usize,
    most: u64,
) -> bool {
    let mut grows = false;
    for (object, children) in children.iter().enumerate() {
        let (Some(children), true) = (children, by_length[object].len() == class) else {
            continue;
        };
        let mut counts = children
            .iter()
            .map(|&(child, shorter)| by_length[child].get(class.saturating_sub(shorter)).copied());
        let count = counts.try_fold(0, |sum: u64, count| sum.checked_add(count?));
        if let Some(count) = count.filter(|&count| count <= most) {
            by_length[object].push(count.max(1));
            grows = true;
        }
    }
    grows
}

/// By how many classes a length is longer than another, from their ratio.
fn classes(ratio: f64) -> f64 {
    LENGTHS_AN_OCTAVE * libm::log2(ratio)
}

fn sum(objects: impl Iterator<Item = usize>, counts: &[u64]) -> u64 {
    let counts = objects.map(|object| counts[object]);
    counts.fold(0, u64::saturating_add)
}

#[cfg(test)]
mod tests {
    use super::Sizes;
    use crate::catalogue::Catalogue;
    use crate::document::Document;
    use crate::graph::Replacement;

    /// Branches are turned first, and shrunk in the next step.
    #[test]
    fn sizes_are_known_where_children_are_as_long() {
        let catalogue = Catalogue::embedded();
        let source = catalogue.rule("ternary-tree").unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let graph = document.resolve(&[]).unwrap().0.compile(60).unwrap();
        let sizes = Sizes::most(&graph, 4096).down_to(&graph, 0.01, 4096);
        for (number, object) in graph.objects().iter().enumerate() {
            if !matches!(object.replacement, Replacement::Kept) {
                let size = sizes.cut(number, 60, 0.012);
                assert!(size.is_some(), "{number}");
            }
        }
    }
}
