//! Checks of imported entries: mistakes lie in the text, an entry has a document or an error, and a document is read
//! back as equal.

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::{Diagnostics, Source};
use kfrac::document::Document;
use kfrac::import::{ImportOptions, SourceFormat, read};

/// Maximum length of the messages about one entry, in bytes.
const MAX_SAID: usize = 1 << 20;

pub fn check(text: &str, format: SourceFormat, options: &ImportOptions) {
    let source = Source::new("fuzz.txt", text);
    // Without a byte order mark, as places count.
    let text = source.text();
    let (imported, stray) = read(&source, format, options);
    said(&stray, text);
    for entry in imported {
        said(&entry.found, text);
        let has_errors = entry.found.has_errors();
        assert_eq!(entry.document.is_none(), has_errors, "{}", entry.found);
        let Some(document) = entry.document else {
            continue;
        };
        let yaml = document.to_yaml();
        let again = Document::read(
            &Source::new("again.yaml", yaml.as_str()),
            &Catalogue::embedded(),
        );
        let again = again.unwrap_or_else(|errors| panic!("{errors}\n{yaml}"));
        assert_eq!(again.to_yaml(), yaml);
        let resolved = again.resolve(&[]);
        resolved.unwrap_or_else(|errors| panic!("{errors}\n{yaml}"));
    }
}

fn said(found: &Diagnostics, text: &str) {
    for found in found.iter() {
        let place = found.place().expect("a mistake has its place");
        assert!(text.get(place.range()).is_some(), "{}", found.message());
    }
    assert!(found.to_string().len() < MAX_SAID, "too much is said");
}
