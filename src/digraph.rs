//! Directed graphs whose vertices are numbers.

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
