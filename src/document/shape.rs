//! What mappings may hold: the one list of keys, from which files are checked and their schema is
//! made.

use crate::catalogue::Shelf;
use crate::diagnostic::{Diagnostic, nearest};
use crate::style::Named;

use super::node::Key;

/// A kind of mapping.
pub(super) struct Shape {
    /// What messages call it, with its article.
    pub(super) what: &'static str,
    /// The keys that it may have, in groups.
    pub(super) keys: &'static [&'static [Member]],
    /// Sets of keys of which exactly one must be there; empty if that is all the same.
    pub(super) ways: &'static [Way],
    /// How it is written.
    pub(super) hint: &'static str,
}

/// A key that a mapping may have.
pub(super) struct Member {
    pub(super) name: &'static str,
    /// What it may hold.
    pub(super) holds: Form,
    /// What it means, for people who point at it in an editor.
    pub(super) about: &'static str,
    pub(super) needed: Needed,
}

/// When a key must be there.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Needed {
    Never,
    Always,
    /// In a file that does not extend another.
    Alone,
}

/// Keys that stand together, and keys that cannot stand with them.
pub(super) struct Way {
    pub(super) needs: &'static [&'static str],
    pub(super) excludes: &'static [&'static str],
}

/// What a value may be.
pub(super) enum Form {
    /// Text; a number is text as it is written.
    Text,
    /// `true` or `false`, with the one that is meant where the key is left out.
    Flag(bool),
    /// A number or an expression.
    Number,
    /// The same; not negative.
    Positive,
    /// The same; a whole number from the first to the second, if that is given.
    Whole(u32, Option<u32>),
    /// An expression that is never a number alone: a condition or a distribution.
    Expression,
    /// One of the names of an enumeration.
    Choice(fn() -> Choice),
    /// This number and no other.
    Exactly(u32),
    /// One of these words.
    Words(&'static [&'static str]),
    /// A colour; `none` or nothing is none.
    Colour,
    /// The name of a file of the library.
    File(Shelf),
    /// The name of a file that can be grown, or what it says.
    Grown,
    /// Two numbers.
    Point,
    /// A list of as many entries at least and, if limited, at most.
    List(&'static Form, u32, Option<u32>),
    /// A mapping of names that the file gives; as many at least.
    Names(&'static Form, u32),
    /// A mapping.
    Mapping(&'static Shape),
    /// One of several.
    Either(&'static [Form]),
}

/// The names of an enumeration.
pub(super) struct Choice {
    pub(super) names: Vec<&'static str>,
    /// The one that is meant where the key is left out.
    pub(super) default: String,
}

impl Form {
    /// One of the variants of an enumeration.
    pub(super) const fn variant<T: Named + Default + PartialEq>() -> Self {
        Self::Choice(|| Choice {
            names: T::NAMES.iter().map(|(name, _)| *name).collect(),
            default: T::default().name().into(),
        })
    }
}

/// A key that may be left out.
pub(super) const fn key(name: &'static str, holds: Form, about: &'static str) -> Member {
    Member {
        name,
        holds,
        about,
        needed: Needed::Never,
    }
}

/// A key that must be there.
pub(super) const fn needed_key(name: &'static str, holds: Form, about: &'static str) -> Member {
    Member {
        needed: Needed::Always,
        ..key(name, holds, about)
    }
}

impl Shape {
    /// The keys that it may have.
    pub(super) fn members(&self) -> impl Iterator<Item = &'static Member> + Clone + use<> {
        self.keys.iter().copied().flatten()
    }

    /// The names of the keys.
    fn names(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        self.members().map(|member| member.name)
    }

    /// The keys as they are meant: a key that is not known stands for the nearest one that is, if
    /// that is not there itself, and otherwise for none. Every one that is not known is reported.
    pub(super) fn meant<'k>(
        &self,
        keys: impl Iterator<Item = &'k Key> + Clone,
        mut report: impl FnMut(Diagnostic),
    ) -> Vec<Option<&'static str>> {
        let is = |key: &Key, known: &str| key.name == known;
        let mut taken: Vec<&str> = self.names().collect();
        taken.retain(|known| keys.clone().any(|key| is(key, known)));
        keys.map(|key| {
            if let Some(known) = self.names().find(|known| is(key, known)) {
                return Some(known);
            }
            let near = nearest(&key.name, self.names());
            let hint = match near {
                Some(near) => format!("did you mean '{near}'?"),
                None => {
                    let names: Vec<_> = self.names().collect();
                    format!("{} may have: {}", self.what, names.join(", "))
                }
            };
            let message = format!("unknown key '{}' in {}", key.name, self.what);
            report(Diagnostic::error(message).at(&key.place).hint(hint));
            let meant = self
                .names()
                .find(|known| Some(*known) == near && !taken.contains(known))?;
            taken.push(meant);
            Some(meant)
        })
        .collect()
    }
}
