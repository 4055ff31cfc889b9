//! What people write by mistake, and what hostile people write: each ends with a message that has a
//! place and a mend, in bounded time and memory.
//!
//! `tests/bad` holds a file for each mistake and, beside it, the message that belongs to it. With
//! `KFRAC_BLESS=1` the messages are written instead of compared.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

#[path = "bad_input/hostile.rs"]
mod hostile;
#[path = "bad_input/mutations.rs"]
mod mutations;

use std::fs;
use std::path::Path;
use std::sync::Arc;

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Diagnostics;
use kfrac::document::Document;
use kfrac::graph::Graph;

/// All that `kfrac check` says of a rule.
fn check(argument: &str, catalogue: &Catalogue) -> Result<Diagnostics, Diagnostics> {
    let source = catalogue.rule(argument)?;
    let (rule, mut found) = Document::read(&source, catalogue)?.resolve(&[])?;
    let rule = Arc::new(rule);
    let steps = rule.steps().unwrap_or(1).min(16);
    if let Err(error) = Graph::compile(&rule, steps) {
        found.push(error.diagnostic(&rule));
    }
    Ok(found)
}

#[test]
fn every_mistake_has_its_message() {
    // Names in messages are as given: from the crate's root, where tests run.
    let catalogue = Catalogue::with_folders(vec!["tests/bad/library".into()]);
    let mut names: Vec<_> = fs::read_dir("tests/bad")
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".yaml"))
        .collect();
    names.sort();
    assert!(names.len() >= 60);
    let mut wrong = Vec::new();
    for name in names {
        let path = format!("tests/bad/{name}");
        let (Ok(found) | Err(found)) = check(&path, &catalogue);
        let said = format!("{found}\n");
        assert!(!found.is_empty(), "nothing is wrong with {path}");
        let expected = Path::new(&path).with_extension("txt");
        if std::env::var_os("KFRAC_BLESS").is_some() {
            fs::write(expected, said).unwrap();
        } else if fs::read_to_string(expected).unwrap_or_default() != said {
            wrong.push(format!("{path} says:\n\n{said}"));
        }
    }
    assert!(
        wrong.is_empty(),
        "{}\n(KFRAC_BLESS=1 accepts this)",
        wrong.join("\n")
    );
}

#[test]
fn errors_of_one_file_come_together() {
    let (Ok(found) | Err(found)) = check("tests/bad/several-stages.yaml", &Catalogue::embedded());
    assert_eq!(found.len(), 8, "{found}");
}
