//! Limits of the size of a file, with aliases expanded and components inlined.

use crate::diagnostic::{Diagnostic, Place};
use crate::document::node::{Node, Value};

/// Maximum nesting depth of lists and mappings, since nodes are visited recursively.
pub(super) const MAX_DEPTH: usize = 64;
/// Maximum number of values, including the copies that aliases and components make, and the operations of formulas.
pub(in crate::document) const MAX_VALUES: usize = 250_000;
/// Maximum number of bytes of text in copies that aliases and components make.
const MAX_COPIED: usize = 16 << 20;

/// Size of a node.
#[derive(Clone, Copy, Default)]
pub(in crate::document) struct Size {
    pub(in crate::document) values: usize,
    bytes: usize,
    depth: usize,
}

impl Size {
    /// Computes the size of a node with all its descendants.
    pub(in crate::document) fn of(node: &Node) -> Self {
        let mut size = Self {
            values: 1,
            bytes: 0,
            depth: 0,
        };
        match &node.value {
            Value::Text(text) => size.bytes = text.len(),
            Value::Sequence(items) => items.iter().for_each(|item| size.add_child(Self::of(item))),
            Value::Mapping(entries) => entries.iter().for_each(|(key, value)| {
                size.bytes += key.name.len();
                size.values += 1;
                size.add_child(Self::of(value));
            }),
            Value::Null | Value::Bool(_) | Value::Number(_) => {}
        }
        size
    }

    fn add_child(&mut self, child: Self) {
        self.values += child.values;
        self.bytes += child.bytes;
        self.depth = self.depth.max(child.depth + 1);
    }
}

/// The size that has been used so far.
#[derive(Default)]
pub(in crate::document) struct Budget {
    values: usize,
    copied: usize,
}

impl Budget {
    /// Counts a value of the file.
    pub(super) fn value(&mut self, place: &Place) -> Result<(), Diagnostic> {
        self.spend(1, place)
    }

    /// Counts a copy of a node within `depth` collections, made by an alias.
    pub(super) fn copy(
        &mut self,
        size: Size,
        depth: usize,
        place: &Place,
    ) -> Result<(), Diagnostic> {
        self.copied += size.bytes;
        if self.copied > MAX_COPIED {
            return Err(
                Diagnostic::error("the aliases expand to more than 16 MiB of text")
                    .at(place)
                    .hint("write out less through '*' aliases"),
            );
        }
        check_depth(depth + size.depth, place)?;
        self.spend(size.values, place)
    }

    /// Counts a file without its components.
    pub(in crate::document) fn own(&mut self, size: Size) {
        self.values += size.values;
    }

    /// Counts a component that is inlined.
    pub(in crate::document) fn component(
        &mut self,
        size: Size,
        place: &Place,
    ) -> Result<(), Diagnostic> {
        self.values += size.values;
        self.copied += size.bytes;
        let most = if self.values > MAX_VALUES {
            "250,000 values"
        } else if self.copied > MAX_COPIED {
            "16 MiB of text"
        } else {
            return Ok(());
        };
        let message =
            format!("with its components and repetitions the file holds more than {most}");
        let hint = "each counts as often as it is named or repeated";
        Err(Diagnostic::error(message).at(place).hint(hint))
    }

    fn spend(&mut self, values: usize, place: &Place) -> Result<(), Diagnostic> {
        self.values += values;
        if self.values <= MAX_VALUES {
            return Ok(());
        }
        Err(Diagnostic::error("the file holds more than 250,000 values")
            .at(place)
            .hint("each '*' alias counts as what it stands for"))
    }
}

/// Returns an error if the depth exceeds [`MAX_DEPTH`].
pub(super) fn check_depth(depth: usize, place: &Place) -> Result<(), Diagnostic> {
    if depth <= MAX_DEPTH {
        Ok(())
    } else {
        Err(too_deep(place))
    }
}

/// Returns the error for excessive nesting.
pub(super) fn too_deep(place: &Place) -> Diagnostic {
    Diagnostic::error(format!(
        "lists and mappings are nested more than {MAX_DEPTH} deep"
    ))
    .at(place)
}
