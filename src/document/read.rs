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
mod transform;
mod turtle;
mod word;

pub(super) use base_element::BASE_ELEMENT;
pub use base_element::BaseElementDocument;
pub(super) use elements::{ELEMENTS, INITIATOR};
pub use elements::{InitiatorDocument, Listed};
pub(super) use generator::GENERATOR;
pub use generator::MoveDocument;
pub use instancing::TintDocument;
pub(super) use metadata::{DESCRIPTION, check_description, read_heading};
pub(super) use parameters::{PARAMETER, PARAMS};
pub(super) use rule::RULE;
pub use select::CaseDocument;
pub use set::{DiskDocument, EllipseDocument};

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
    fn read(reader: &mut Reader, fields: &Fields<'_>, heading: MetadataDocument) -> Self;
}
