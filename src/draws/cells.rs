//! Division of the ranges of variables into cells, over which interval arithmetic bounds what depends on the draws.

use crate::expression::{Dependence, Interval, Program};

use super::Variable;

/// Largest useful number of cells.
pub(crate) const MAX_CELLS: usize = 1024;

/// Limit of the number of parts of one variable's range.
const MAX_PARTS: usize = 32;

/// Returns which variables affect the values of expressions, themselves or by the distributions of others. The first
/// variable has slot `first`.
pub(crate) fn needed<'p>(
    variables: &'p [Variable],
    first: usize,
    programs: impl IntoIterator<Item = &'p Program>,
) -> Vec<bool> {
    let mut programs: Vec<&Program> = programs.into_iter().collect();
    let mut needed = vec![false; variables.len()];
    for (number, variable) in variables.iter().enumerate().rev() {
        let slot = first + number;
        let depends = |program: &&Program| program.dependence(slot) != Dependence::None;
        if programs.iter().any(depends) {
            programs.extend(variable.programs());
            needed[number] = true;
        }
    }
    needed
}

/// Product of parts of the ranges of variables that are needed; the others may have any value.
pub(crate) struct Cells<'v> {
    variables: &'v [Variable],
    first: usize,
    /// Number of parts of each range; 0 for variables that are not needed.
    parts: Vec<usize>,
}

impl<'v> Cells<'v> {
    /// Divides the ranges of the variables that affect expressions into at most `most` cells. The first variable has slot
    /// `first`.
    pub(crate) fn new<'p>(
        variables: &'v [Variable],
        first: usize,
        most: usize,
        programs: impl IntoIterator<Item = &'p Program>,
    ) -> Self
    where
        'v: 'p,
    {
        let needed = needed(variables, first, programs);
        let mut left = most;
        let mut free = Vec::new();
        let mut parts = vec![0; variables.len()];
        for (number, variable) in variables.iter().enumerate().rev() {
            if needed[number] {
                match variable.choices() {
                    Some(choices) => parts[number] = if choices <= left { choices } else { 1 },
                    None => free.push(number),
                }
                left /= parts[number].max(1);
            }
        }
        let count = u32::try_from(free.len()).unwrap_or(u32::MAX);
        let fits = |parts: &usize| parts.checked_pow(count).is_some_and(|all| all <= left);
        let each = (2..=MAX_PARTS).rev().find(fits).unwrap_or(1);
        for number in free {
            parts[number] = each;
        }
        Self {
            variables,
            first,
            parts,
        }
    }

    /// Calls a function with the ranges of all slots and the probability of every cell. `before` are the ranges of the slots
    /// before the variables.
    pub(crate) fn visit(&self, before: &[Interval], mut visit: impl FnMut(&[Interval], f64)) {
        self.go_on(&mut before.to_vec(), 1.0, &mut visit);
    }

    /// Recurses into the parts of the next variable's range; `likely` is the probability of the parts so far.
    fn go_on(
        &self,
        slots: &mut Vec<Interval>,
        likely: f64,
        visit: &mut impl FnMut(&[Interval], f64),
    ) {
        let number = slots.len() - self.first;
        let Some(variable) = self.variables.get(number) else {
            return visit(slots, likely);
        };
        if self.parts[number] == 0 {
            slots.push(Interval::ALL);
            self.go_on(slots, likely, visit);
            slots.pop();
            return;
        }
        for (part, share) in variable.parts(slots, self.parts[number]) {
            slots.push(part);
            self.go_on(slots, likely * share, visit);
            slots.pop();
        }
    }
}
