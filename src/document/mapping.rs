//! Mappings whose document, checks, reader and schema come from one table of keys.

use crate::style::{Blend, Cap, ColorBy, Colour, Iteration, Join, Tone};

use super::node::Node;
use super::reader::{Fields, Reader};
use super::style::read_colour;
use super::{Written, WrittenNumber, WrittenPoint};

/// A value that is read from a node.
pub(super) trait FromNode: Sized {
    /// Reads the value; `None` if it cannot be read, which is reported.
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self>;

    /// Returns the value of a key that is absent or cannot be read; `None` where there is no such value.
    fn absent(_fields: &Fields<'_>, _key: &'static str) -> Option<Self> {
        None
    }
}

impl Fields<'_> {
    /// Reads the value of a key, or returns the one for an absent key.
    pub(super) fn read<T: FromNode>(&self, reader: &mut Reader, key: &'static str) -> Option<T> {
        // A component under a misspelt key is not inlined, and the misspelling has been reported.
        let node = self.take(key);
        let node = node.filter(|node| !(self.holds_file(key) && reader.is_component(node)));
        let read = node.and_then(|node| T::from_node(reader, node));
        read.or_else(|| T::absent(self, key))
    }

    /// Reads the value of a key; `None` if it is absent or cannot be read.
    pub(super) fn optional<T: FromNode>(
        &self,
        reader: &mut Reader,
        key: &'static str,
    ) -> Option<T> {
        self.read(reader, key).flatten()
    }
}

impl<T: FromNode> FromNode for Option<T> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        T::from_node(reader, node).map(Some)
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(None)
    }
}

impl FromNode for bool {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        reader.flag(node)
    }

    fn absent(fields: &Fields<'_>, key: &'static str) -> Option<Self> {
        Some(fields.default_flag(key))
    }
}

impl FromNode for String {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        reader.text(node)
    }
}

impl FromNode for Written<String> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        reader.name(node)
    }
}

impl FromNode for WrittenNumber {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        Some(reader.number(node))
    }
}

impl FromNode for WrittenPoint {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        Some(reader.point(node))
    }

    fn absent(fields: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Self::unknown(fields.place))
    }
}

impl FromNode for [WrittenNumber; 2] {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        Some(reader.pair(node))
    }
}

impl FromNode for Colour {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        read_colour(reader, node)
    }
}

/// Reads names of variants, with the noun for messages; the default stands for an absent key.
macro_rules! variants {
    ($($type:ty: $noun:literal;)*) => { $(
        impl FromNode for $type {
            fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
                reader.variant(node, $noun)
            }

            fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
                Some(Self::default())
            }
        }
    )* };
}

variants! {
    Cap: "cap";
    Join: "join";
    Blend: "blend mode";
    ColorBy: "way to colour";
    Iteration: "method";
    Tone: "tone";
}

/// Makes a document, the definition of its keys, and its reader from a table: `keys!` with the type of each value
/// behind the name. `KEY as FIELD` names the field otherwise than the key. Alternative sets of keys may follow the help
/// text.
macro_rules! mapping {
    ($(#[$doc:meta])* struct $name:ident: $shape:ident = $what:literal, $hint:expr; $($table:tt)*) => {
        mapping!(@ {$(#[$doc])* $name $shape $what $hint, &[]} [] $($table)*);
    };
    (
        $(#[$doc:meta])* struct $name:ident: $shape:ident = $what:literal, $hint:expr, $alternatives:expr;
        $($table:tt)*
    ) => {
        mapping!(@ {$(#[$doc])* $name $shape $what $hint, $alternatives} [] $($table)*);
    };
    (@ $head:tt [$($done:tt)*] needed $($rest:tt)+) => {
        mapping!(# Always $head [$($done)*] $($rest)*);
    };
    (@ $head:tt [$($done:tt)*] $($rest:tt)+) => { mapping!(# Never $head [$($done)*] $($rest)*); };
    (
        # $needed:ident $head:tt [$($done:tt)*] $key:ident as $field:ident: $type:ty = $form:expr, $about:expr
        $(=> $absent:literal $(, $hint:literal)?)?; $($rest:tt)*
    ) => {
        mapping!(@ $head [
            $($done)* {$needed $key $field ($type) ($form) ($about) [$($absent $(, $hint)?)?]}
        ] $($rest)*);
    };
    (# $needed:ident $head:tt $done:tt $key:ident: $($rest:tt)*) => {
        mapping!(# $needed $head $done $key as $key: $($rest)*);
    };
    (
        @ {$(#[$doc:meta])* $name:ident $shape:ident $what:literal $hint:expr, $alternatives:expr}
        [$({
            $needed:ident $key:ident $field:ident ($type:ty) ($form:expr) ($about:expr) [$($absent:tt)*]
        })*]
    ) => {
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub struct $name {
            $(#[doc = $about] pub $field: $type,)*
            /// Source span of the mapping.
            pub place: $crate::diagnostic::Place,
        }

        pub(in $crate::document) const $shape: $crate::document::shape::Shape = $crate::document::shape::Shape {
            what: $what,
            keys: &[&[$($crate::document::shape::Member {
                name: stringify!($key),
                holds: $form,
                about: $about,
                needed: $crate::document::shape::Needed::$needed,
                absent: $crate::document::shape::keys!(? $($absent)*),
            }),*]],
            alternatives: $alternatives,
            hint: $hint,
        };

        impl $crate::document::mapping::FromNode for $name {
            fn from_node(
                reader: &mut $crate::document::reader::Reader,
                node: &$crate::document::node::Node,
            ) -> Option<Self> {
                let fields = reader.fields(node, &$shape)?;
                $(let $field = fields.read(reader, stringify!($key));)*
                Some(Self { $($field: $field?,)* place: node.place.clone() })
            }
        }
    };
}

pub(super) use {mapping, variants};
