//! Limits of the work on exact dimensions.

/// The work that is spent on deciding a dimension before it is given up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// Some tens of milliseconds where nothing is decided.
    #[default]
    Full,
    /// A sixteenth of that: enough for systems with some hundred neighbour maps.
    Quick,
}

impl Effort {
    /// What is left of a limit.
    pub(super) fn of(self, most: usize) -> usize {
        match self {
            Self::Full => most,
            Self::Quick => most / 16,
        }
    }
}
