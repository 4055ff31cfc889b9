//! The library: its entries, and their thumbnails.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use serde::Serialize;

use crate::catalogue::{Catalogue, LibraryFile, Shelf};
use crate::cli::{gallery, list};
use crate::diagnostic::Source;

use super::answer::Refusal;
use super::drawing::{Shot, Wholes};

/// Largest number of bytes of thumbnails that are kept.
const MOST_BYTES: usize = 32 << 20;

/// Entry of the library.
#[derive(Clone, Serialize)]
pub(super) struct Entry {
    #[serde(flatten)]
    row: list::ListRow,
    /// Folder and name, by which the entry is opened.
    pub(super) id: String,
    /// Whether it is a component of rules.
    is_component: bool,
}

/// Returns the entries of a catalogue, in the order in which they are listed.
pub(super) fn entries(catalogue: &Catalogue) -> Vec<Entry> {
    let all = catalogue.entries();
    let entry = |file: &LibraryFile| Entry {
        row: list::row(file, catalogue),
        id: format!("{}/{}", file.shelf.folder(), file.name),
        is_component: Shelf::COMPONENTS.contains(&file.shelf),
    };
    all.iter().map(entry).collect()
}

/// Returns the source of an entry: of a component, that of a rule that shows it.
pub(super) fn source(catalogue: &Catalogue, id: &str) -> Result<Arc<Source>, Refusal> {
    let known = catalogue.entries();
    let file = known
        .iter()
        .find(|it| format!("{}/{}", it.shelf.folder(), it.name) == id);
    let Some(file) = file else {
        return Err(Refusal::wrong(format!("the library has no entry '{id}'")));
    };
    Ok(gallery::shown(file, catalogue)?)
}

/// Side of a thumbnail in pixels.
const SIDE: u32 = 192;

/// Returns everything that a thumbnail depends on.
pub(super) fn shot(catalogue: &Catalogue, source: Arc<Source>, id: &str) -> Shot {
    let name = id.rsplit('/').next().unwrap_or(id);
    let folder = id.split('/').next().unwrap_or(id);
    let shelf = Shelf::all()
        .into_iter()
        .find(|shelf| shelf.folder() == folder);
    Shot {
        catalogue: catalogue.clone(),
        source,
        rule: name.to_owned(),
        look: shelf.map(gallery::options).unwrap_or_default(),
        view: None,
        turn: 0.0,
        size: [SIDE; 2],
        wholes: Arc::new(Wholes::default()),
    }
}

/// Thumbnails that have been drawn, by the identity of their entries.
#[derive(Debug, Default)]
pub(super) struct Thumbnails(Mutex<BTreeMap<String, Arc<[u8]>>>);

impl Thumbnails {
    pub(super) fn get(&self, id: &str) -> Option<Arc<[u8]>> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .get(id)
            .cloned()
    }

    pub(super) fn set(&self, id: String, bytes: Arc<[u8]>) {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let held: usize = known.values().map(|it| it.len()).sum();
        if held + bytes.len() > MOST_BYTES {
            known.clear();
        }
        known.insert(id, bytes);
    }
}
