//! Numbers of steps of models in space.

use super::{DEEPEST, MOST_PROPOSED, Model};

impl Model {
    /// Returns the number of steps for which the graph of a model in space is resolved, where `asked` steps are asked
    /// for: by default those that its file proposes. An L-system, every step of which has a graph of its own, has the
    /// deepest step up to 12 of at most 20,000 elements otherwise.
    #[must_use]
    pub fn resolved_steps_in_space(&self, asked: Option<u32>) -> u32 {
        const SOON: u32 = 16;
        let proposed = || self.metadata().steps;
        let deepest = || self.as_kind().deepest(DEEPEST, MOST_PROPOSED);
        asked.or_else(proposed).or_else(deepest).unwrap_or(SOON)
    }

    /// Returns the number of steps to which a picture of a model in space is drawn, where a number is `asked` for or a
    /// detail is; `None` for the limit set, which L-systems have only if their lines have no width and colour of their own.
    #[must_use]
    pub fn drawn_steps_in_space(&self, asked: Option<u32>, has_detail: bool) -> Option<u32> {
        match self {
            Self::LSystemInSpace(_) => {
                let is_limit =
                    asked.is_none() && has_detail && !self.of_detail().as_kind().starts_anew();
                (!is_limit).then(|| self.resolved_steps_in_space(asked))
            }
            _ => asked.or(self.metadata().steps.filter(|_| !has_detail)),
        }
    }
}
