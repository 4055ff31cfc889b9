//! Shapes: the definitions of the keys of mappings, from which files are checked and their schema is
//! generated.

use crate::catalogue::Shelf;
use crate::diagnostic::{Diagnostic, nearest};
use crate::style::Named;

use super::node::Key;

/// The definition of a type of mappings.
pub(super) struct Shape {
    /// Noun for messages, with its article.
    pub(super) what: &'static str,
    /// Possible keys, in groups.
    pub(super) keys: &'static [&'static [Member]],
    /// Alternative sets of keys, of which exactly one is required; empty if there are none.
    pub(super) alternatives: &'static [KeySet],
    /// Example of the notation, as a help text.
    pub(super) hint: &'static str,
}

/// The definition of a key.
pub(super) struct Member {
    pub(super) name: &'static str,
    /// Type of the value.
    pub(super) holds: Form,
    /// Description, which editors show.
    pub(super) about: &'static str,
    pub(super) needed: Needed,
    /// Message for a mapping without the key, where reading reports one, and a help text if the mapping's own
    /// does not fit.
    pub(super) absent: Option<(&'static str, Option<&'static str>)>,
}

/// Condition under which a key is required.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Needed {
    Never,
    Always,
    /// Required in a file that does not extend another.
    Alone,
}

/// An alternative set of keys, with the keys that it excludes.
pub(super) struct KeySet {
    pub(super) needs: &'static [&'static str],
    pub(super) excludes: &'static [&'static str],
}

/// Type of a value.
pub(super) enum Form {
    /// Text; a number is text as it is written.
    Text,
    /// `true` or `false`, with the default.
    Flag(bool),
    /// A number or an expression.
    Number,
    /// A number that is not negative, or an expression.
    Positive,
    /// An integer with a minimum and possibly a maximum, or an expression.
    Whole(u32, Option<u32>),
    /// An expression that is never a plain number: a condition, a distribution or a name.
    Expression,
    /// A name of a variant of an enumeration.
    Choice(fn() -> Choice),
    /// Exactly this number.
    Exactly(u32),
    /// One of these keywords.
    Words(&'static [&'static str]),
    /// A colour; `none` or null for no colour.
    Colour,
    /// Name of a file on a shelf of the library.
    File(Shelf),
    /// Name of a file of any kind that can be grown, or its content.
    Grown,
    /// Name of a file with a mesh.
    MeshFile,
    /// A list of two numbers.
    Point,
    /// A list of two numbers, or of three in a file of space.
    Place,
    /// A list with a minimum and possibly a maximum number of entries.
    List(&'static Form, u32, Option<u32>),
    /// A mapping of arbitrary names to values, with a minimum number of entries.
    Names(&'static Form, u32),
    /// A mapping with the keys of a shape.
    Mapping(&'static Shape),
    /// One of several types.
    Either(&'static [Form]),
}

/// Names of the variants of an enumeration.
pub(super) struct Choice {
    pub(super) names: Vec<&'static str>,
    /// Name of the default.
    pub(super) default: String,
}

impl Form {
    /// Returns the type of the names of an enumeration.
    pub(super) const fn variant<T: Named + Default + PartialEq>() -> Self {
        Self::Choice(|| Choice {
            names: T::NAMES.iter().map(|(name, _)| *name).collect(),
            default: T::default().name().into(),
        })
    }
}

/// Defines an optional key.
pub(super) const fn key(name: &'static str, holds: Form, about: &'static str) -> Member {
    Member {
        name,
        holds,
        about,
        needed: Needed::Never,
        absent: None,
    }
}

/// Defines an alternative set of keys.
pub(super) const fn alternative(
    needs: &'static [&'static str],
    excludes: &'static [&'static str],
) -> KeySet {
    KeySet { needs, excludes }
}

/// Makes the definitions of keys from a table of their names, types and descriptions. A key may be
/// `needed`, or needed `alone`, without a parent; the message and the help text behind `=>` are for a mapping
/// without it. `=MEMBER` stands for a definition that several tables share.
macro_rules! keys {
    (@ [$($made:expr,)*]) => { [$($made),*] };
    (@ [$($made:expr,)*] =$member:ident; $($rest:tt)*) => {
        keys!(@ [$($made,)* $member,] $($rest)*)
    };
    (@ [$($made:expr,)*] needed $($rest:tt)*) => { keys!(# Always [$($made,)*] $($rest)*) };
    (@ [$($made:expr,)*] alone $($rest:tt)*) => { keys!(# Alone [$($made,)*] $($rest)*) };
    (@ [$($made:expr,)*] $($rest:tt)*) => { keys!(# Never [$($made,)*] $($rest)*) };
    (
        # $needed:ident [$($made:expr,)*] $name:ident: $form:expr, $about:expr
        $(=> $absent:literal $(, $hint:literal)?)?; $($rest:tt)*
    ) => {
        keys!(@ [$($made,)* $crate::document::shape::Member {
            name: stringify!($name),
            holds: $form,
            about: $about,
            needed: $crate::document::shape::Needed::$needed,
            absent: keys!(? $($absent $(, $hint)?)?),
        },] $($rest)*)
    };
    (?) => { None };
    (? $absent:literal) => { Some(($absent, None)) };
    (? $absent:literal, $hint:literal) => { Some(($absent, Some($hint))) };
    ($($table:tt)*) => { keys!(@ [] $($table)*) };
}

pub(super) use keys;

/// Words of one meaning, of which a kind of file knows one or two.
const SYNONYMS: [&[&str]; 13] = [
    &[
        "translate",
        "shift",
        "move",
        "offset",
        "position",
        "pos",
        "translation",
    ],
    &["rotate", "turn", "rotation", "angle", "rot"],
    &["scale", "size", "factor", "ratio"],
    &["weight", "probability", "prob", "chance"],
    &["maps", "transforms", "functions"],
    &["generator", "motif"],
    &["initiator", "axiom", "initial"],
    &["productions", "rules"],
    &[
        "steps",
        "iterations",
        "depth",
        "level",
        "levels",
        "order",
        "generations",
    ],
    &["stroke", "color", "colour"],
    &["width", "thickness", "linewidth", "stroke_width"],
    &["params", "parameters", "variables", "constants"],
    &["title", "name", "label"],
];

impl Shape {
    /// Iterates over the definitions of all keys.
    pub(super) fn members(&self) -> impl Iterator<Item = &'static Member> + Clone + use<> {
        self.keys.iter().copied().flatten()
    }

    /// Iterates over the names of all keys.
    fn names(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        self.members().map(|member| member.name)
    }

    /// Returns the key that has the meaning of a word of other formats.
    fn synonym(&self, word: &str) -> Option<&'static str> {
        let group = { SYNONYMS.iter() }.find(|group| group.contains(&word))?;
        self.names().find(|known| group.contains(known))
    }

    /// Maps keys to known keys. An unknown key is reported and mapped to the nearest known key if that
    /// one is absent, and to `None` otherwise.
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
            let near = nearest(&key.name, self.names()).or_else(|| self.synonym(&key.name));
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
