//! Work that deciding growth and finding limit sets takes.

use std::cell::Cell;

use super::NoGrowth;

/// Limit of the number of operations: with long numbers, each takes about a microsecond.
const MAX_OPERATIONS: usize = 1 << 19;

/// Number of operations that are left. It depends on the system alone, not on the precision of numbers.
pub(super) struct Budget {
    left: Cell<usize>,
}

impl Budget {
    pub(super) fn new() -> Self {
        Self {
            left: Cell::new(MAX_OPERATIONS),
        }
    }

    /// Takes operations that follow from the budget.
    ///
    /// # Errors
    ///
    /// If fewer are left.
    pub(super) fn spend(&self, operations: usize) -> Result<(), NoGrowth> {
        let left = self.left.get().checked_sub(operations);
        self.left.set(left.ok_or(NoGrowth::Size)?);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Budget, MAX_OPERATIONS};
    use crate::lsystem::NoGrowth;

    #[test]
    fn no_more_is_spent_than_there_is() {
        let budget = Budget::new();
        assert_eq!(budget.spend(MAX_OPERATIONS - 2), Ok(()));
        assert_eq!(budget.spend(3), Err(NoGrowth::Size));
        assert_eq!(budget.spend(2), Ok(()));
        assert_eq!(budget.spend(1), Err(NoGrowth::Size));
    }
}
