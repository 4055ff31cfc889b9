//! What mappings may hold.

use crate::diagnostic::{Diagnostic, nearest};

use super::node::Key;

/// A kind of mapping.
pub(super) struct Shape {
    /// What messages call it, with its article.
    pub(super) what: &'static str,
    /// The keys that it may have.
    pub(super) keys: &'static [&'static str],
    /// How it is written.
    pub(super) hint: &'static str,
}

impl Shape {
    /// The keys as they are meant: a key that is not known stands for the nearest one that is, if
    /// that is not there itself, and otherwise for none. Every one that is not known is reported.
    pub(super) fn meant<'k>(
        &self,
        keys: impl Iterator<Item = &'k Key> + Clone,
        mut report: impl FnMut(Diagnostic),
    ) -> Vec<Option<&'static str>> {
        let is = |key: &Key, known: &str| key.name == known;
        let mut taken: Vec<&str> = self.keys.to_vec();
        taken.retain(|known| keys.clone().any(|key| is(key, known)));
        keys.map(|key| {
            if let Some(known) = self.keys.iter().find(|known| is(key, known)) {
                return Some(*known);
            }
            let near = nearest(&key.name, self.keys.iter().copied());
            let hint = match near {
                Some(near) => format!("did you mean '{near}'?"),
                None => format!("{} may have: {}", self.what, self.keys.join(", ")),
            };
            let message = format!("unknown key '{}' in {}", key.name, self.what);
            report(Diagnostic::error(message).at(&key.place).hint(hint));
            let meant = self
                .keys
                .iter()
                .copied()
                .find(|known| Some(*known) == near && !taken.contains(known))?;
            taken.push(meant);
            Some(meant)
        })
        .collect()
    }
}
