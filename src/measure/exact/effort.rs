//! Limits of the computing effort for exact dimensions.

/// Effort that is spent on deciding a dimension before the search is given up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// Some tens of milliseconds where nothing is decided.
    #[default]
    Full,
    /// A sixteenth of the full effort: enough for systems with some hundred neighbour maps.
    Quick,
}

impl Effort {
    /// Returns a limit for this effort, given that for the full one.
    pub(super) fn of(self, most: usize) -> usize {
        match self {
            Self::Full => most,
            Self::Quick => most / 16,
        }
    }
}
