//! Descriptions of library files: their titles, texts, sources and tags.

use super::{Catalogue, LibraryFile, embedded};
use crate::diagnostic::Source;
use crate::document::node::{Node, Value};
use crate::metadata::Description;

impl Catalogue {
    /// Returns title, description, source and tags of a library file, without checking the rest of it. A file that cannot be
    /// read has none.
    ///
    /// ```
    /// use kfrac::catalogue::Catalogue;
    ///
    /// let library = Catalogue::embedded();
    /// let entries = library.entries();
    /// let is_plant = |it: &&_| library.description(it).tags.contains(&"plant".into());
    /// assert!(entries.iter().filter(is_plant).any(|it| it.name == "barnsley-fern"));
    /// ```
    #[must_use]
    pub fn description(&self, entry: &LibraryFile) -> Description {
        let source = match embedded(entry.shelf, &entry.name) {
            Some(text) if entry.path.is_none() => Some(Source::new("(described)", described(text))),
            _ => self.open(entry).ok(),
        };
        let node = source.and_then(|source| Node::parse(&source).ok());
        let get = |key| Some(&node.as_ref()?.get(key)?.value);
        let text = |key| match get(key) {
            Some(Value::Text(text)) => Some(text.trim_end().to_owned()),
            _ => None,
        };
        Description {
            title: text("title"),
            about: text("about"),
            source: text("source"),
            tags: match get("tags") {
                Some(Value::Sequence(tags)) => {
                    let tags = tags.iter().filter_map(Node::written);
                    tags.map(str::to_owned).collect()
                }
                _ => Vec::new(),
            },
        }
    }
}

/// Returns the lines of an embedded file that describe it. In the files of the library, keys begin lines, and their values
/// are indented.
fn described(text: &str) -> String {
    const KEYS: [&str; 4] = ["title:", "about:", "source:", "tags:"];
    let mut lines = String::new();
    let mut is_kept = false;
    for line in text.split_inclusive('\n') {
        if !line.starts_with([' ', '\n']) {
            is_kept = KEYS.iter().any(|key| line.starts_with(key));
        }
        if is_kept {
            lines.push_str(line);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::EMBEDDED;
    use super::{Catalogue, described};
    use crate::diagnostic::Source;
    use crate::document::node::Node;

    #[test]
    fn lines_that_describe_embedded_files_have_their_descriptions() {
        for (path, text) in EMBEDDED {
            let [whole, lines] = [*text, &described(text)]
                .map(|text| Node::parse(&Source::new("file", text)).unwrap());
            for key in ["title", "about", "source", "tags"] {
                let [whole, lines] = [&whole, &lines].map(|node| node.get(key));
                let is_same = match (whole, lines) {
                    (Some(whole), Some(lines)) => whole.same_value(lines),
                    (whole, lines) => whole.is_none() && lines.is_none(),
                };
                assert!(is_same, "{path}, {key}");
            }
        }
        let library = Catalogue::embedded();
        let entries = library.entries();
        let titled = { entries.iter() }
            .filter(|entry| library.description(entry).title.is_some())
            .count();
        assert!(titled > 200, "{titled}");
    }
}
