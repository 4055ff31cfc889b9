//! Directed graphs whose vertices are numbers.

mod ancestry;

pub(crate) use ancestry::{Ancestry, on_infinite_paths};

/// Returns the number of the strongly connected component of each vertex (Tarjan 1972); `targets` lists
/// the vertices to which the edges of each vertex lead. No edge leads to a component of a higher number.
pub(crate) fn components(targets: &[Vec<usize>]) -> Vec<usize> {
    const NONE: usize = usize::MAX;
    let size = targets.len();
    let (mut order, mut low, mut component) = (vec![NONE; size], vec![0; size], vec![NONE; size]);
    let (mut visited, mut count) = (0, 0);
    let mut open = Vec::new();
    for root in 0..size {
        if order[root] != NONE {
            continue;
        }
        // Path from the root: each vertex with the number of its targets that have been taken.
        let mut way = vec![(root, 0)];
        while let Some((vertex, taken)) = way.last_mut() {
            let vertex = *vertex;
            if *taken == 0 {
                (order[vertex], low[vertex]) = (visited, visited);
                visited += 1;
                open.push(vertex);
            }
            if let Some(&target) = targets[vertex].get(*taken) {
                *taken += 1;
                if order[target] == NONE {
                    way.push((target, 0));
                } else if component[target] == NONE {
                    low[vertex] = low[vertex].min(order[target]);
                }
                continue;
            }
            way.pop();
            if let Some((parent, _)) = way.last() {
                low[*parent] = low[*parent].min(low[vertex]);
            }
            if low[vertex] == order[vertex] {
                while let Some(member) = open.pop() {
                    component[member] = count;
                    if member == vertex {
                        break;
                    }
                }
                count += 1;
            }
        }
    }
    component
}

/// Returns the vertices in the order in which a depth-first search leaves them: every vertex after those to which it leads,
/// except around loops.
fn post_order(targets: &[Vec<usize>]) -> Vec<usize> {
    let mut order = Vec::with_capacity(targets.len());
    let mut is_met = vec![false; targets.len()];
    for root in 0..targets.len() {
        if std::mem::replace(&mut is_met[root], true) {
            continue;
        }
        // Path from the root: each vertex with the number of its targets that have been taken.
        let mut way = vec![(root, 0)];
        while let Some((vertex, taken)) = way.last_mut() {
            match targets[*vertex].get(*taken) {
                Some(&target) => {
                    *taken += 1;
                    if !std::mem::replace(&mut is_met[target], true) {
                        way.push((target, 0));
                    }
                }
                None => {
                    order.push(*vertex);
                    way.pop();
                }
            }
        }
    }
    order
}

/// Returns, for every vertex, the largest sum of lengths along a path from it, at least 0 (Bellman 1958). `edges` lists the
/// vertices to which those of each vertex lead, with lengths, to each of which `more` is added. `None` if sums exceed `most`
/// or grow along a loop, or if that takes too long to decide.
pub(crate) fn longest_paths(edges: &[Vec<(usize, f64)>], more: f64, most: f64) -> Option<Vec<f64>> {
    /// Limit of the number of vertices and edges that are looked at, after the first rounds.
    const MAX_WORK: usize = 1 << 20;
    /// Number of rounds that are made in any case.
    const FIRST: usize = 16;
    let targets = edges
        .iter()
        .map(|edges| edges.iter().map(|(target, _)| *target).collect());
    let order = post_order(&targets.collect::<Vec<_>>());
    let work = edges.len() + edges.iter().map(Vec::len).sum::<usize>();
    let rounds = (MAX_WORK / work.max(1)).max(FIRST).min(edges.len());
    let mut longest = vec![0.0f64; edges.len()];
    for _ in 0..=rounds {
        let mut has_changed = false;
        for &vertex in &order {
            let along = edges[vertex]
                .iter()
                .map(|(target, length)| length + more + longest[*target]);
            let largest = along.fold(longest[vertex], f64::max);
            has_changed |= largest > longest[vertex];
            longest[vertex] = largest;
        }
        if !has_changed {
            return Some(longest);
        }
        if longest.iter().any(|sum| *sum > most) {
            return None;
        }
    }
    None
}

/// Edge of a directed graph, of any kind.
pub(crate) trait Edge: Clone {
    /// Returns the vertices that the edge leads from and to.
    fn ends(&self) -> [usize; 2];

    /// Returns the edge between other vertices.
    fn between(&self, ends: [usize; 2]) -> Self;
}

impl Edge for [usize; 2] {
    fn ends(&self) -> [usize; 2] {
        *self
    }

    fn between(&self, ends: [usize; 2]) -> Self {
        ends
    }
}

/// Strongly connected part of a graph: its number of vertices, and the edges between them.
pub(crate) type Part<E> = (usize, Vec<E>);

/// Returns the number of the [component](components) of each vertex, and the graph within every component,
/// whose vertices are numbered in order.
pub(crate) fn parts<E: Edge>(size: usize, edges: &[E]) -> (Vec<usize>, Vec<Part<E>>) {
    let mut targets = vec![Vec::new(); size];
    for [from, to] in edges.iter().map(E::ends) {
        targets[from].push(to);
    }
    let component = components(&targets);
    let mut parts: Vec<Part<E>> = vec![(0, Vec::new()); count(&component)];
    let number = |&part: &usize| {
        parts[part].0 += 1;
        parts[part].0 - 1
    };
    let numbers: Vec<usize> = component.iter().map(number).collect();
    // A single part has all edges.
    if let [(_, all)] = &mut parts[..] {
        all.reserve_exact(edges.len());
    }
    for edge in edges {
        let ends = edge.ends();
        let [from, to] = ends.map(|vertex| component[vertex]);
        if from == to {
            parts[from]
                .1
                .push(edge.between(ends.map(|vertex| numbers[vertex])));
        }
    }
    (component, parts)
}

/// Returns the number of components.
pub(crate) fn count(component: &[usize]) -> usize {
    component.iter().max().map_or(0, |most| most + 1)
}

/// Returns whether the product of the factors along every loop is below 1, after so many rounds of relaxation;
/// an edge leads from a vertex to another by a factor. `false` if that is not certain.
pub(crate) fn all_loops_shrink(
    vertices: usize,
    edges: &[(usize, usize, f64)],
    rounds: usize,
) -> bool {
    /// Below 1 by so much that rounding does not matter.
    const LEAST: f64 = 1.0 - 1e-9;
    let logarithms = edges.iter().map(|(.., factor)| libm::log(factor / LEAST));
    let logarithms: Vec<f64> = logarithms.collect();
    let mut largest = vec![0.0; vertices];
    (0..=rounds).any(|_| {
        let mut has_settled = true;
        for (&(from, to, _), logarithm) in edges.iter().zip(&logarithms) {
            let along = largest[from] + logarithm;
            if along > largest[to] {
                largest[to] = along;
                has_settled = false;
            }
        }
        has_settled
    })
}

/// Loop with a large mean of the values of its vertices.
#[derive(Debug)]
pub(crate) struct LargeLoop {
    /// Vertices in the order in which edges lead to them.
    pub(crate) vertices: Vec<usize>,
    /// Mean of the values of the vertices.
    pub(crate) mean: f64,
    /// Upper bound of the means of all loops; infinite if the search took too long.
    pub(crate) most: f64,
}

/// Returns a loop with the largest mean of the values of its vertices, by policy iteration (Howard, "Dynamic Programming
/// and Markov Processes", 1960, as by Dasdan, "Experimental analysis of the fastest optimum cycle ratio and mean
/// algorithms", 2004). `targets` lists the vertices to which the edges of each vertex lead. `None` if a vertex has none.
pub(crate) fn loop_of_largest_mean(values: &[f64], targets: &[Vec<usize>]) -> Option<LargeLoop> {
    /// Limit of the number of vertices and edges that are looked at.
    const MAX_WORK: usize = 10_000_000;
    /// Least value that is distinguished from others: below the logarithm of any number.
    const LEAST: f64 = -1e4;
    let bounded: Vec<f64> = values.iter().map(|value| value.max(LEAST)).collect();
    // The choice of each vertex among its targets.
    let chosen: Option<Vec<usize>> = targets.iter().map(|all| all.first().copied()).collect();
    let mut chosen = chosen?;
    let work = targets.len() + targets.iter().map(Vec::len).sum::<usize>();
    let mut sums = bounded.clone();
    let mut best = largest_chosen(&bounded, &chosen)?;
    for _ in 0..(MAX_WORK / work).max(1) {
        // The sums along the chosen edges as far as the loop, less the mean at every vertex.
        let mut leading: Vec<Vec<usize>> = vec![Vec::new(); chosen.len()];
        for (vertex, target) in chosen.iter().enumerate() {
            leading[*target].push(vertex);
        }
        let root = best.vertices[0];
        let mut open = vec![root];
        while let Some(target) = open.pop() {
            for &vertex in leading[target].iter().filter(|vertex| **vertex != root) {
                sums[vertex] = bounded[vertex] - best.mean + sums[target];
                open.push(vertex);
            }
        }
        let largest = sums.iter().fold(1.0, |most: f64, sum| most.max(sum.abs()));
        let rounding = 4.0 * f64::EPSILON * largest;
        let mut is_better = false;
        for (vertex, all) in targets.iter().enumerate() {
            for &target in all {
                let sum = bounded[vertex] - best.mean + sums[target];
                if sum > sums[vertex] {
                    is_better |= sum > sums[vertex] + rounding;
                    sums[vertex] = sum;
                    chosen[vertex] = target;
                }
            }
        }
        if !is_better {
            best.most = best.mean + 2.0 * rounding;
            break;
        }
        let next = largest_chosen(&bounded, &chosen)?;
        if next.mean >= best.mean {
            best = next;
        }
    }
    let exact = best.vertices.iter().map(|vertex| values[*vertex]);
    best.mean = exact.sum::<f64>() / best.vertices.len() as f64;
    Some(best)
}

/// Returns the loop of largest mean if one edge leads from each vertex.
fn largest_chosen(values: &[f64], targets: &[usize]) -> Option<LargeLoop> {
    const NONE: usize = usize::MAX;
    let mut best: Option<LargeLoop> = None;
    // The first vertex from which each was met.
    let mut met = vec![NONE; targets.len()];
    for first in 0..targets.len() {
        let mut vertex = first;
        while met[vertex] == NONE {
            met[vertex] = first;
            vertex = targets[vertex];
        }
        if met[vertex] != first {
            continue;
        }
        let mut vertices = vec![vertex];
        let mut next = targets[vertex];
        while next != vertex {
            vertices.push(next);
            next = targets[next];
        }
        let sum: f64 = vertices.iter().map(|vertex| values[*vertex]).sum();
        let mean = sum / vertices.len() as f64;
        if best.as_ref().is_none_or(|best| mean > best.mean) {
            best = Some(LargeLoop {
                vertices,
                mean,
                most: f64::INFINITY,
            });
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn longest_paths_end_unless_loops_grow() {
        // Ways 0 → 1 → 3 and 0 → 2 → 3, and a loop of 3.
        let edges = |around: f64| {
            vec![
                vec![(1, 1.0), (2, -1.0)],
                vec![(3, 2.0)],
                vec![(3, 7.0)],
                vec![(3, around)],
            ]
        };
        let longest = Some(vec![6.0, 2.0, 7.0, 0.0]);
        assert_eq!(longest_paths(&edges(-0.5), 0.0, 100.0), longest);
        assert_eq!(longest_paths(&edges(0.0), 0.0, 100.0), longest);
        assert_eq!(longest_paths(&edges(-0.5), 0.0, 6.5), None);
        assert_eq!(longest_paths(&edges(0.1), 0.0, f64::INFINITY), None);
        assert_eq!(longest_paths(&edges(-0.5), 1.0, f64::INFINITY), None);
        // All lengths of a long loop but one shrink a little, and that one makes up for less, or for more.
        let ring = |last: f64| -> Vec<_> {
            let length = |vertex: usize| if vertex == 0 { last } else { -1.0 };
            (0..5_000)
                .map(|vertex| vec![((vertex + 1) % 5_000, length(vertex))])
                .collect()
        };
        let longest = longest_paths(&ring(4_998.0), 0.0, f64::INFINITY);
        assert_eq!(
            longest.map(|it| [it[0], it[1], it[4_999]]),
            Some([4_998.0, 0.0, 4_997.0])
        );
        assert_eq!(longest_paths(&ring(5_000.0), 0.0, f64::INFINITY), None);
    }

    #[test]
    fn the_largest_mean_of_long_loops_is_found() {
        let ring = |length: usize| -> Vec<Vec<usize>> {
            (0..length)
                .map(|vertex| vec![(vertex + 1) % length])
                .collect()
        };
        let found = loop_of_largest_mean(&vec![0.0; 20_000], &ring(20_000)).unwrap();
        assert_eq!((found.vertices.len(), found.mean), (20_000, 0.0));
        assert!(found.most < 1e-14);
        // Chords across a ring that shrinks, and one short loop that does not.
        let mut targets = ring(5_000);
        targets.iter_mut().enumerate().for_each(|(vertex, all)| {
            all.push(vertex * 7 % 5_000);
        });
        let mut values: Vec<f64> = (0..5_000)
            .map(|vertex| -1.0 - f64::from(vertex % 13))
            .collect();
        targets[4_000].push(3_999);
        (values[3_999], values[4_000]) = (-3.0, 3.5);
        let found = loop_of_largest_mean(&values, &targets).unwrap();
        let mut vertices = found.vertices.clone();
        vertices.sort_unstable();
        assert_eq!((vertices, found.mean), (vec![3_999, 4_000], 0.25));
        assert!(found.most < 0.25 + 1e-9);
        assert!(loop_of_largest_mean(&[0.0], &[vec![]]).is_none());
        // A loop with a zero.
        let found = loop_of_largest_mean(&[f64::NEG_INFINITY, 1.0], &ring(2)).unwrap();
        assert_eq!(found.mean, f64::NEG_INFINITY);
    }

    proptest! {
        #[test]
        fn the_largest_mean_is_that_of_all_loops(
            rows in vec(vec(any::<bool>(), 7), 1..7),
            values in vec(-4..4i32, 7),
        ) {
            let values: Vec<f64> = values.into_iter().map(f64::from).collect();
            let size = rows.len();
            let targets = rows.iter().enumerate().map(|(vertex, row)| {
                let mut targets: Vec<usize> = (0..size).filter(|to| row[*to]).collect();
                if targets.is_empty() {
                    targets.push((vertex + 1) % size);
                }
                targets
            });
            let targets: Vec<Vec<usize>> = targets.collect();
            let found = loop_of_largest_mean(&values[..size], &targets).unwrap();
            // The largest sums along closed ways of each length (Karp 1978).
            let mut largest = f64::NEG_INFINITY;
            for start in 0..size {
                let mut sums = vec![f64::NEG_INFINITY; size];
                sums[start] = 0.0;
                for length in 1..=size {
                    let mut next = vec![f64::NEG_INFINITY; size];
                    for (from, all) in targets.iter().enumerate() {
                        for to in all {
                            next[*to] = next[*to].max(sums[from] + values[from]);
                        }
                    }
                    sums = next;
                    largest = largest.max(sums[start] / length as f64);
                }
            }
            prop_assert!((found.mean - largest).abs() < 1e-9, "{found:?} {largest}");
            prop_assert!(found.most >= largest && found.most < largest + 1e-9);
        }

        #[test]
        fn post_order_follows_targets(rows in vec(vec(any::<bool>(), 12), 1..12)) {
            // Edges lead to larger numbers only, but for loops of a vertex, so that there are no other loops.
            let edges = |from: usize, row: &Vec<bool>| (from..rows.len()).filter(|to| row[*to]).collect();
            let targets: Vec<Vec<usize>> = rows.iter().enumerate().map(|(from, row)| edges(from, row)).collect();
            let order = post_order(&targets);
            let mut ranks = vec![usize::MAX; rows.len()];
            for (rank, vertex) in order.iter().enumerate() {
                prop_assert_eq!(std::mem::replace(&mut ranks[*vertex], rank), usize::MAX);
            }
            prop_assert_eq!(order.len(), rows.len());
            for (from, targets) in targets.iter().enumerate() {
                prop_assert!(targets.iter().all(|to| *to == from || ranks[*to] < ranks[from]));
            }
        }
    }
}
