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
pub(super) use elements::{ELEMENTS, INITIATOR};
pub(super) use generator::GENERATOR;
pub(super) use ifs::IFS;
pub(super) use instancing::INSTANCING;
pub(super) use lsystem::LSYSTEM;
pub(super) use metadata::{DESCRIPTION, check_description};
pub(super) use parameters::{PARAMETER, PARAMS};
pub(super) use rule::RULE;

use crate::diagnostic::Diagnostics;
use crate::kind::Kind;

use super::KindDocument;
use super::node::Node;
use super::reader::Reader;
use super::shape::Shape;

/// Returns the keys of a kind of file.
pub(super) fn shape(kind: Kind) -> &'static Shape {
    match kind {
        Kind::Rule => &RULE,
        Kind::Ifs => &IFS,
        Kind::Instancing => &INSTANCING,
        Kind::LSystem => &LSYSTEM,
    }
}

/// Reads a file whose parents and components are inlined. `complete` states that all of them were
/// found.
pub(super) fn read(
    kind: Kind,
    node: &Node,
    complete: bool,
    diagnostics: &mut Diagnostics,
) -> Option<KindDocument> {
    let mut reader = Reader::after(diagnostics);
    let document = read_kind(&mut reader, kind, node, complete);
    diagnostics.extend(reader.diagnostics);
    document
}

fn read_kind(reader: &mut Reader, kind: Kind, node: &Node, complete: bool) -> Option<KindDocument> {
    match kind {
        Kind::Rule => rule::read_rule(reader, node, complete).map(KindDocument::Rule),
        Kind::Ifs => ifs::read_ifs(reader, node, complete).map(KindDocument::Ifs),
        Kind::Instancing => {
            instancing::read_instancing(reader, node, complete).map(KindDocument::Instancing)
        }
        Kind::LSystem => lsystem::read_lsystem(reader, node, complete).map(KindDocument::LSystem),
    }
}
