//! Numbers of descendants of objects over a few steps.

use crate::geometry::Frame;
use crate::graph::{Alternative, Graph, Object, Replacement};
use crate::saturating::whole;

/// Largest number of steps for which sizes are computed.
const MAX_STEPS: usize = 64;

/// Maximum number of objects of a graph; for larger graphs no sizes are computed.
const MAX_OBJECTS: usize = 1 << 14;

/// Number of classes of lengths for a factor of 2.
const LENGTHS_AN_OCTAVE: f64 = 32.0;
/// Maximum number of classes of lengths.
const MAX_LENGTHS: usize = 640;

/// Limit of the number of children that are looked at for classes of lengths.
const MAX_WORK: usize = 1 << 24;

/// Tolerance in units of a class: a length this close to the edge of a class lies on it.
const ROUNDING: f64 = 1e-6;

/// Numbers of descendants of objects in their own fractals, up to some size: exact if instances are fixed,
/// upper bounds if they are computed for each element.
pub(super) struct Sizes {
    /// Numbers by object and number of steps.
    counts: Vec<Vec<u64>>,
    /// Numbers by object and class of lengths above the length below which elements are not replaced.
    by_length: Vec<Vec<u64>>,
    shortest: f64,
    /// Whether the graph is time-indexed: an object then has a single number.
    is_time_indexed: bool,
}

impl Sizes {
    /// Computes the sizes of expansions that have fixed instances and at most `most` elements.
    pub(super) fn fixed<F: Frame>(graph: &Graph<F>, most: u64) -> Self {
        Self::of(graph, most, |_, _| u64::MAX)
    }

    /// Computes upper bounds of the sizes of expansions that cannot exceed `most` elements.
    pub(super) fn most<F: Frame>(graph: &Graph<F>, most: u64) -> Self {
        Self::of(graph, most, |alternatives, counts| {
            // Seed parts are counted as if they stayed in the fractal.
            let of = |alternative: &Alternative| sum(alternative.objects.iter().copied(), counts);
            alternatives.iter().map(of).max().unwrap_or(u64::MAX)
        })
    }

    fn of<F: Frame>(
        graph: &Graph<F>,
        most: u64,
        evaluated: impl Fn(&[Alternative], &[u64]) -> u64,
    ) -> Self {
        let objects = graph.objects();
        let count = |object: &Object<F>, beyond: u64, now: &[u64]| match &object.replacement {
            Replacement::Kept => 1,
            Replacement::Fixed(successor) => {
                let instances = successor.body.instances.iter();
                sum(instances.map(|instance| instance.object), now)
            }
            Replacement::Evaluated(alternatives) => evaluated(alternatives, now),
            Replacement::Unresolved => beyond,
        };
        if graph.is_time_indexed() {
            let mut counts = vec![1; objects.len()];
            // Objects of time-indexed graphs refer only to objects of larger numbers.
            for object in (0..objects.len()).rev() {
                counts[object] = count(&objects[object], 1, &counts);
            }
            let few = |count: u64| Some(count).filter(|count| *count <= most);
            let counts = counts.into_iter().map(|count| few(count).into_iter());
            return Self {
                is_time_indexed: true,
                ..Self::of_steps(counts.map(Iterator::collect).collect())
            };
        }
        if objects.len() > MAX_OBJECTS {
            return Self::of_steps(Vec::new());
        }
        let mut counts = vec![vec![1]; objects.len()];
        let mut now = vec![1; objects.len()];
        for steps in 1..=MAX_STEPS {
            let count = |object: &Object<F>| count(object, u64::MAX, &now);
            let next: Vec<_> = objects.iter().map(count).collect();
            let mut grows = false;
            for (object, &count) in next.iter().enumerate() {
                if graph.is_fertile(object) && counts[object].len() == steps && count <= most {
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
            is_time_indexed: false,
        }
    }

    /// Adds the sizes of expansions of at most `most` elements in which elements shorter than `shortest` are
    /// not replaced.
    pub(super) fn down_to<F: Frame>(self, graph: &Graph<F>, shortest: f64, most: u64) -> Self {
        if shortest <= 0.0 || graph.objects().len() > MAX_OBJECTS {
            return self;
        }
        // Children with the number of classes by which they are shorter. Infertile children count as one
        // element at any length.
        let shorter = |(object, ratio): (usize, f64)| {
            let classes = whole(ROUNDING - classes(ratio));
            (
                object,
                if graph.is_fertile(object) {
                    classes
                } else {
                    usize::MAX
                },
            )
        };
        let ratios = graph.ratios().into_iter().zip(graph.resets());
        let children: Vec<Option<Vec<_>>> = ratios
            .map(|(children, resets)| {
                let children = children.into_iter().map(shorter).collect();
                (!resets).then_some(children)
            })
            .collect();
        let mut by_length = vec![vec![1]; children.len()];
        let round = children.len() + children.iter().flatten().map(Vec::len).sum::<usize>();
        let mut rounds = MAX_WORK / round.max(1);
        for class in 1..=MAX_LENGTHS {
            let mut is_any = false;
            // Children of their parent's length belong to the class itself, so it is repeated until stable.
            while rounds > 0 && lengthen(&mut by_length, &children, class, most) {
                is_any = true;
                rounds -= 1;
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

    /// Returns the number of descendants of an object after a number of steps, if the object is replaced and
    /// the number is known.
    #[inline]
    pub(super) fn get(&self, object: usize, steps: u32) -> Option<u64> {
        self.counts
            .get(object)?
            .get(self.slot(steps))
            .copied()
            .filter(|_| steps > 0)
    }

    /// Returns an upper bound of the number of descendants of an object of a length after a number of steps,
    /// or when all are too short to be replaced, if a bound is known.
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

    /// Returns the index under which the data of an object are stored for a number of steps.
    #[inline]
    pub(super) fn slot(&self, steps: u32) -> usize {
        if self.is_time_indexed {
            0
        } else {
            steps as usize
        }
    }

    /// Returns the sum of all sizes.
    pub(super) fn sum(&self) -> u64 {
        self.counts.iter().flatten().sum()
    }

    /// Returns, for every object, the number of sizes that are known.
    pub(super) fn slots(&self) -> impl Iterator<Item = usize> {
        self.counts.iter().map(Vec::len)
    }
}

/// Adds the sizes of a class of lengths to objects whose children's sizes are known, and returns whether
/// there were any. Children are given with the number of classes by which they are shorter.
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

/// Returns the number of classes by which a length is longer than another, given their ratio.
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

    /// In this rule, branches turn at full length in one step and shrink in the next.
    #[test]
    fn sizes_are_known_where_children_are_as_long() {
        let catalogue = Catalogue::embedded();
        let source = catalogue.rule("ternary-tree").unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let graph = document.resolve(&[]).unwrap().0.compile(60).unwrap();
        let sizes = Sizes::most(&graph, 4096).down_to(&graph, 0.01, 4096);
        for number in 0..graph.objects().len() {
            if graph.is_fertile(number) {
                let size = sizes.cut(number, 60, 0.012);
                assert!(size.is_some(), "{number}");
            }
        }
    }
}
