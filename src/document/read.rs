//! Conversion of nodes to documents. Mistakes are collected and placeholders take the place of
//! unreadable values, so that one pass reports all mistakes.

mod base_element;
mod elements;
mod generator;
mod ifs;
mod instancing;
mod lsystem;
mod metadata;
mod parameters;
mod rule;
mod select;
mod set;
mod solid;
mod space;
mod tint;
mod transform;
mod turtle;
mod vertices;
mod word;

pub(super) use base_element::BASE_ELEMENT;
pub use base_element::{BaseElementDocument, SurfaceDocument};
pub(super) use elements::{ELEMENTS, INITIATOR};
pub use elements::{InitiatorDocument, Listed};
pub(super) use generator::GENERATOR;
pub use generator::{MoveDocument, RotateDocument};
pub(super) use metadata::{DESCRIPTION, check_description, read_metadata};
pub(super) use parameters::{PARAMETER, PARAMS};
pub(super) use rule::RULE;
pub use select::CaseDocument;
pub use set::{DiskDocument, EllipseDocument};
pub use solid::{CuboidDocument, EllipsoidDocument, ShaftDocument, SphereDocument};
pub use space::InSpace;
pub(super) use space::SPACE_OF_COMPONENT;
pub(crate) use space::corners_of_solid;
pub use tint::TintDocument;
pub(super) use transform::TRANSFORMS;

use super::MetadataDocument;
use super::reader::{Fields, Reader};
use super::shape::Shape;

/// The definition of a kind of document.
pub(super) struct KindTable {
    pub(super) shape: &'static Shape,
    /// Description of its files, which editors show.
    pub(super) about: &'static str,
    /// Content that stands in for a missing parent and causes no further diagnostics.
    pub(super) stand_in: &'static str,
}

/// The document of a kind.
pub(super) trait OfKind {
    const TABLE: &'static KindTable;

    /// Reads the keys that only this kind has.
    fn read(reader: &mut Reader, fields: &Fields<'_>, metadata: MetadataDocument) -> Self;
}

#[cfg(test)]
mod tests {
    use crate::diagnostic::{Place, Source};
    use crate::document::KindDocument;
    use crate::document::node::Node;
    use crate::document::reader::Reader;
    use crate::kind::Kind;

    #[test]
    fn stand_ins_are_read_without_diagnostics() {
        for kind in Kind::ALL {
            let stand_in = KindDocument::table(kind).stand_in;
            let place = Place::new(&Source::new("extends", "gone"), 0..4);
            let node = Node::made(stand_in, &place);
            let mut reader = Reader::default();
            let read = KindDocument::read(&mut reader, kind, &node, true);
            assert!(read.is_some_and(|it| it.metadata().complete), "{stand_in}");
            assert!(reader.diagnostics.is_empty(), "{}", reader.diagnostics);
        }
    }
}
