//! AIFS, the text format of IFStile and of the collection ifsdb.
//!
//! A text consists of blocks, `@ID:ParentID`, which inherit the definitions of their parents. Expressions compute maps of a
//! space of `$dim` dimensions: `[1, 0]` is a translation, `[0, -1, 1, 0]` a matrix by rows, `f*g` a composition, `f^-1` an
//! inverse, `f|g` a union, `$companion([1, -1])` the companion matrix of 1 − x + x². A definition that refers to itself, such
//! as `A=(f|g)*A` or `A=f*A|g*B`, is a set, and `$subspace` projects sets to an eigenspace of a matrix, in the coordinates of
//! a left eigenvector whose first coordinate is 1. The format is described in the manual of IFStile, and by D. Mekhontsev, "An
//! algebraic framework for finding and analyzing self-affine tiles and fractals", 2019, appendix E.
//!
//! Each block with a set that is not hidden becomes a document of its set `$root`, or else its first one: a system, or a
//! structure where the set refers to others. Templates, which stand for what a search is to find, JavaScript, calls of
//! blocks and lists that generate themselves are refused.

mod affine;
mod blocks;
mod eigen;
mod evaluate;
mod functions;
mod subspace;
mod syntax;
mod value;
mod write;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use crate::build::written::Entries;
use crate::diagnostic::{Diagnostic, Diagnostics, Source};

use super::Imported;
use super::document::{Heading, file_of};
use blocks::Block;
use evaluate::Scope;
use syntax::Parsed;
use value::wrong;

/// Largest number of multiplications in a file: about a second.
const MAX_MULTIPLICATIONS: u64 = 1 << 29;

/// Largest number of blocks that inherit from each other.
const MAX_ANCESTORS: usize = 64;

/// Identifier of a block with the settings of the program.
const SETTINGS: &str = "IFStile";

/// Reads the blocks of a text that have sets and are not hidden.
pub(super) fn read(source: &Arc<Source>) -> (Vec<Imported>, Diagnostics) {
    let mut stray = Diagnostics::default();
    let blocks = blocks::of(source, &mut stray);
    let mut by_id: BTreeMap<&str, &Block> = BTreeMap::new();
    for block in &blocks {
        if let Some(id) = &block.id
            && by_id.insert(id, block).is_some()
        {
            let twice = format!("there are two blocks '{id}': the last one counts");
            stray.push(Diagnostic::warning(twice).at(&block.place));
        }
    }
    let parents = blocks.iter().filter_map(|block| block.parent.as_ref());
    let parents: BTreeSet<&str> = parents.map(|(parent, _)| &parent[..]).collect();
    let budget = Cell::new(MAX_MULTIPLICATIONS);
    let mut imported = Vec::new();
    for block in &blocks {
        if block.is_hidden || block.id.as_deref() == Some(SETTINGS) {
            continue;
        }
        let mut found = block.found.clone();
        let own = if found.has_errors() {
            None
        } else {
            let own = converted(block, &by_id, &budget);
            let own = own.map_err(|mistake| found.push(*mistake));
            match own {
                Ok(None) => {
                    let is_parent = block.id.as_deref().is_some_and(|id| parents.contains(id));
                    if !is_parent {
                        let none = "this block has no set, such as A=(f|g)*A";
                        stray.push(Diagnostic::warning(none).at(&block.place));
                    }
                    continue;
                }
                Ok(own) => own,
                Err(()) => None,
            }
        };
        let stem = file_of(source).and_then(Path::file_stem);
        let stem = stem.map_or_else(|| "set".into(), |stem| stem.to_string_lossy().into_owned());
        let heading = Heading {
            name: block.name.as_ref().or(block.id.as_ref()).unwrap_or(&stem),
            place: &block.place,
            about: "",
            origin: "for IFStile",
        };
        imported.push(heading.imported(own, found));
    }
    (imported, stray)
}

/// Returns the keys of the document of a block; `None` if the block has no set.
fn converted(
    block: &Block,
    by_id: &BTreeMap<&str, &Block>,
    budget: &Cell<u64>,
) -> Parsed<Option<Entries>> {
    let mut chain = vec![block];
    let mut youngest = block;
    while let Some((parent, place)) = &youngest.parent {
        let Some(next) = by_id.get(&parent[..]) else {
            return wrong(format!("there is no block '{parent}'"), place);
        };
        if chain.len() == MAX_ANCESTORS {
            let message = format!("this block inherits from more than {MAX_ANCESTORS} others");
            return wrong(message, place);
        }
        if let Some(mistake) = next.found.iter().next() {
            return Err(mistake.clone().into());
        }
        chain.push(next);
        youngest = next;
    }
    let mut scope = Scope::new(&chain, budget)?;
    write::set(&mut scope)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;
