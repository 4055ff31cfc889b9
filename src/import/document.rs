//! Documents of imported entries.

use std::path::Path;

use crate::build::written::Entries;
use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};
use crate::document::Document;
use crate::document::node::{Node, Value};

use super::Imported;

/// Returns the file of a text; `None` for a text that is no file, such as that of standard input.
pub(super) fn file_of(source: &Source) -> Option<&Path> {
    let is_file = !source.name().starts_with('<');
    is_file.then(|| source.path())
}

/// An entry of a text, and how it is described.
pub(super) struct Heading<'a> {
    /// Name of the entry.
    pub(super) name: &'a str,
    /// Place at which errors of the whole entry are reported.
    pub(super) place: &'a Place,
    /// Comment of the entry; may be empty.
    pub(super) about: &'a str,
    /// Origin of the entry, such as "for Fractint".
    pub(super) origin: &'a str,
}

impl Heading<'_> {
    /// Completes the keys of an entry with its title, comment and source, and reads them back. Without keys, or after an
    /// error, the entry has no document.
    pub(super) fn imported(&self, own: Option<Entries>, mut found: Diagnostics) -> Imported {
        let own = own.filter(|_| !found.has_errors());
        Imported {
            name: self.name.to_owned(),
            document: own.and_then(|own| self.document(own, &mut found)),
            found,
        }
    }

    fn document(&self, own: Entries, found: &mut Diagnostics) -> Option<Document> {
        let text = |text: &str| Value::Text(text.into());
        let file = file_of(self.place.source()).and_then(Path::file_name);
        let file = file.map_or_else(String::new, |file| format!(" in {}", file.display()));
        let about = self.about;
        let heading = Entries::default()
            .set("title", text(self.name))
            .set_some("about", (!about.is_empty()).then(|| text(about)))
            .set(
                "source",
                text(&format!("{}{file}, {}", self.name, self.origin)),
            );
        let written = Node::from(heading.and(own).value()).to_yaml();
        let read = Document::read(&Source::new("(imported)", written), &Catalogue::embedded());
        let checked = read.and_then(|document| document.resolve(&[]).map(|_| document));
        match checked {
            Ok(document) => Some(document),
            Err(mistakes) => {
                // The places of these errors are in a generated text: the entry is reported instead.
                let located = mistakes.iter().map(|mistake| {
                    let here = Diagnostic::error(mistake.message()).at(self.place);
                    mistake
                        .hint_text()
                        .iter()
                        .fold(here, |here, hint| here.hint(*hint))
                });
                found.extend(located);
                None
            }
        }
    }
}
