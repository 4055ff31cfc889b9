//! Edges backwards: vertices that lead to others, found from these.

/// Numbers in groups.
struct Groups {
    /// Place of the first number of each group, and of the end of the last one.
    firsts: Vec<usize>,
    numbers: Vec<usize>,
}

impl Groups {
    /// Collects pairs of a group, below `count`, and a number.
    fn of(count: usize, pairs: &[(usize, usize)]) -> Self {
        let mut firsts = vec![0; count + 1];
        for (group, _) in pairs {
            firsts[group + 1] += 1;
        }
        for group in 0..count {
            firsts[group + 1] += firsts[group];
        }
        let mut next = firsts.clone();
        let mut numbers = vec![0; pairs.len()];
        for (group, number) in pairs {
            numbers[next[*group]] = *number;
            next[*group] += 1;
        }
        Self { firsts, numbers }
    }

    fn get(&self, group: usize) -> &[usize] {
        &self.numbers[self.firsts[group]..self.firsts[group + 1]]
    }
}

/// The edges of a digraph, backwards. Vertices may share lists of targets.
pub(crate) struct Ancestry {
    /// Number of the list of each vertex.
    of: Vec<usize>,
    /// Vertices by list.
    members: Groups,
    /// Lists by the vertices in them; one that contains a vertex several times is listed as often.
    parents: Groups,
    /// Number of targets in each list.
    sizes: Vec<usize>,
}

impl Ancestry {
    /// Collects the edges of vertices, given the number of the list of each vertex, and the targets in each list.
    pub(crate) fn of<T: IntoIterator<Item = usize>>(
        of: Vec<usize>,
        lists: impl Iterator<Item = T>,
    ) -> Self {
        let members: Vec<_> = of
            .iter()
            .enumerate()
            .map(|(vertex, of)| (*of, vertex))
            .collect();
        let (mut parents, mut sizes) = (Vec::new(), Vec::new());
        for (number, targets) in lists.enumerate() {
            let before = parents.len();
            parents.extend(targets.into_iter().map(|target| (target, number)));
            sizes.push(parents.len() - before);
        }
        Self {
            members: Groups::of(sizes.len(), &members),
            parents: Groups::of(of.len(), &parents),
            of,
            sizes,
        }
    }

    /// Returns the vertices that are in a set or lead to one of its vertices.
    pub(crate) fn leading_to(&self, mut set: Vec<bool>) -> Vec<bool> {
        let mut open = members_of(&set);
        let mut is_met = vec![false; self.sizes.len()];
        while let Some(vertex) = open.pop() {
            for &list in self.parents.get(vertex) {
                if std::mem::replace(&mut is_met[list], true) {
                    continue;
                }
                for &parent in self.members.get(list) {
                    if !std::mem::replace(&mut set[parent], true) {
                        open.push(parent);
                    }
                }
            }
        }
        set
    }

    /// Returns the largest subset of a set in which every vertex leads to one of the subset, or is an end.
    pub(crate) fn lasting(&self, mut set: Vec<bool>, ends: impl Fn(usize) -> bool) -> Vec<bool> {
        // Number of targets of each list that are in the set.
        let mut left = self.sizes.clone();
        let is_outside = |vertex: &usize| !set[*vertex];
        let mut open: Vec<usize> = (0..set.len()).filter(is_outside).collect();
        for vertex in members_of(&set) {
            if left[self.of[vertex]] == 0 && !ends(vertex) {
                set[vertex] = false;
                open.push(vertex);
            }
        }
        while let Some(vertex) = open.pop() {
            for &list in self.parents.get(vertex) {
                left[list] -= 1;
                if left[list] > 0 {
                    continue;
                }
                for &parent in self.members.get(list) {
                    if set[parent] && !ends(parent) {
                        set[parent] = false;
                        open.push(parent);
                    }
                }
            }
        }
        set
    }
}

/// Returns the numbers of the members of a set.
fn members_of(set: &[bool]) -> Vec<usize> {
    (0..set.len()).filter(|number| set[*number]).collect()
}

/// Returns the vertices from which an infinite path starts; `targets` lists those to which the edges of each vertex lead.
pub(crate) fn on_infinite_paths(targets: &[Vec<usize>]) -> Vec<bool> {
    let lists = targets.iter().map(|targets| targets.iter().copied());
    let ancestry = Ancestry::of((0..targets.len()).collect(), lists);
    ancestry.lasting(vec![true; targets.len()], |_| false)
}
