//! Mistakes of users and hostile input: each ends with a diagnostic that has a place and a hint, in bounded
//! time and memory.
//!
//! `tests/bad` holds a file for each mistake and, beside it, the expected diagnostics. With `KFRAC_BLESS=1`
//! the diagnostics are written instead of compared.

mod budgets;
mod costly;
mod estimates;
mod hostile;
mod lsystems;
mod messages;
mod mutations;

use std::fs;
use std::path::Path;

use kfrac::Parameter;
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::{Diagnostics, Source};
use kfrac::document::Document;

/// Returns all diagnostics that `kfrac check` reports for a rule.
fn check(argument: &str, catalogue: &Catalogue) -> Result<Diagnostics, Diagnostics> {
    let source = catalogue.rule(argument)?;
    let (model, mut found) = Document::read(&source, catalogue)?.resolve(&[])?;
    let steps = model.metadata().steps.unwrap_or(1).min(16);
    if let Err(error) = model.compile(steps) {
        found.push(model.diagnostic(&error));
    }
    Ok(found)
}

#[test]
fn every_mistake_has_its_message() {
    // Paths in messages are as given: relative to the crate's root, where tests run.
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

#[test]
fn round_outlines_may_end_where_they_start() {
    for (outline, pieces) in [
        // A circle, a leaf and a loop. An arc of 180 degrees is drawn in eight pieces.
        (
            "[[0, 0], {arc: [1, 0], through: [1/2, 1/2]}, {arc: [0, 0], through: [1/2, -1/2]}]",
            16,
        ),
        (
            "[[0, 0], {curve: [1, 0], control: [[1/2, 1/2]]}, {curve: [0, 0], control: [[1/2, -1/2]]}]",
            2,
        ),
        ("[[0, 0], {curve: [0, 0], control: [[1, 1], [-1, 1]]}]", 1),
    ] {
        let text = format!(
            "initiator: segment\ngenerator: koch\nbase_element:\n  closed: true\n  points: {outline}\n"
        );
        let source = Source::new("round.yaml", text);
        let document = Document::read(&source, &Catalogue::embedded()).unwrap();
        let (model, doubts) = document.resolve(&[]).unwrap();
        assert!(doubts.is_empty(), "{doubts}");
        let base_element = &model.rule().unwrap().base_elements()[0];
        assert!(base_element.is_closed());
        assert_eq!(base_element.pieces().len(), pieces, "{outline}");
        assert_eq!(
            base_element.pieces()[pieces - 1].end(),
            base_element.start()
        );
    }
}

/// Creates a folder with files.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn read(path: &Path, catalogue: &Catalogue) -> Document {
    let source = catalogue.rule(path.to_str().unwrap()).unwrap();
    Document::read(&source, catalogue).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

#[test]
fn a_rule_sets_the_parameters_of_its_parents_components() {
    let folder = folder(&[
        ("tree.yaml", "extends: random-tree\nparams: {sway: 5}\n"),
        (
            "sub/tree.yaml",
            "extends: ../tree.yaml\nparams: {spread: {max: 20}}\n",
        ),
        ("other.yaml", "extends: random-tree\ngenerator: koch\n"),
    ]);
    let catalogue = Catalogue::embedded();
    let parameters = |name: &str| {
        let (model, _) = read(&folder.path().join(name), &catalogue)
            .resolve(&[])
            .unwrap();
        let of = |parameter: &Parameter| {
            (
                parameter.name.clone(),
                parameter.value,
                parameter.min,
                parameter.max,
            )
        };
        model
            .metadata()
            .parameters
            .iter()
            .map(of)
            .collect::<Vec<_>>()
    };
    let sway = ("sway".to_owned(), 5.0, Some(0.0), Some(60.0));
    let spread = |most| ("spread".to_owned(), 10.0, Some(0.0), Some(most));
    assert_eq!(parameters("tree.yaml"), [sway.clone(), spread(40.0)]);
    assert_eq!(parameters("sub/tree.yaml"), [spread(20.0), sway]);
    assert!(parameters("other.yaml").is_empty());
}

#[test]
fn a_rule_extends_a_file_beside_it_and_the_rule_that_it_hides() {
    let folder = folder(&[
        (
            "rules/koch.yaml",
            "extends: koch\ngenerator: koch\ntitle: Mine\n",
        ),
        ("rules/other.yml", "extends: koch.yaml\ntitle: Other\n"),
        ("generators/koch.yml", "elements: [[0, 0], [1/2, 0]]\n"),
    ]);
    let catalogue = Catalogue::with_folders(vec![folder.path().into()]);
    for name in ["koch", "koch.yml", "other", "other.yaml"] {
        let document = read(Path::new(name), &catalogue);
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        // The embedded rule uses a generator of the folder's library.
        assert_eq!(rule.generators()[0].parts()[0].elements.len(), 1);
        assert_eq!(
            rule.description().source.as_deref(),
            Some("H. von Koch 1904")
        );
        let title = if name.starts_with("koch") {
            "Mine"
        } else {
            "Other"
        };
        assert_eq!(rule.description().title.as_deref(), Some(title));
    }
    let own = catalogue
        .entries()
        .into_iter()
        .filter(|entry| entry.path.is_some());
    let names: Vec<_> = own.map(|entry| entry.name).collect();
    assert_eq!(names, ["koch", "other", "koch"]);
}
