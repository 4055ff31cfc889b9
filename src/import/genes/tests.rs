//! Tests of the import of genes.

use crate::diagnostic::{Diagnostics, Source};
use crate::import::{ImportOptions, Imported, SourceFormat};

fn read(text: &str) -> (Vec<Imported>, Diagnostics) {
    let source = Source::new("some/curves.genes", text);
    crate::import::read(&source, SourceFormat::Genes, &ImportOptions::default())
}

fn yaml(imported: &Imported) -> String {
    let document = imported.document.as_ref();
    document
        .unwrap_or_else(|| panic!("{}", imported.found))
        .to_yaml()
}

#[test]
fn points_are_exact() {
    let (imported, stray) = read(
        "# two\nDragon: G 1 0 0 0  0 1 1 0 # Heighway\nE (1,0) (0,1); 1 1 1 1  0 -1 0 0  1 0 0 0\n",
    );
    assert!(stray.is_empty(), "{stray}");
    let [dragon, koch] = &imported[..] else {
        panic!("{imported:?}");
    };
    let expected = "\
title: Dragon
about: Family G(1, 1) of norm 2, gene G 1 0 0 0  0 1 1 0.
source: Dragon in curves.genes, a gene of J. Ventrella's taxonomy
initiator:
  - [0, 0]
  - [1, 0]
generator:
  - [0, 0]
  - [1/2, -1/2]
  - {to: [1, 0], direction: 4}
steps: 12
";
    assert_eq!(yaml(dragon), expected);
    assert_eq!(koch.name, "curves");
    let yaml = yaml(koch);
    let expected = "\
generator:
  - [0, 0]
  - {to: [1/3, 0], direction: 2}
  - {to: [1/2, sqrt(3)/6], direction: 3}
  - [2/3, 0]
  - [1, 0]
steps: 6
";
    assert!(yaml.ends_with(expected), "{yaml}");
}

#[test]
fn presets_are_read() {
    let (imported, stray) = read(
        "[\n  {\"name\": \"Polya Curve\", \"gene\": \"G 1 1 1 0 1 -1 1 0\", \"family\": \"G(2, 0)\"},\n  {\"name\": \"none\"},\n  \
         {\"gene\": \"G 1 x 0 0 1 0 0 0\"}\n]",
    );
    let stray: Vec<_> = stray
        .iter()
        .map(|it| (it.place().unwrap().line(), it.message()))
        .collect();
    assert_eq!(stray, [(3, "this has no gene")]);
    assert_eq!(imported[0].name, "Polya Curve");
    assert!(yaml(&imported[0]).contains("  - {to: [1/2, 1/2], direction: 4}\n"));
    let wrong = imported[1].found.iter().next().unwrap();
    let place = wrong.place().unwrap();
    assert_eq!((place.line(), place.text()), (4, "x"));
    let (imported, stray) = read("[{\"gene\": ]");
    assert!(imported.is_empty() && stray.has_errors());
}

#[test]
fn refusals_have_their_places() {
    let long = format!("G{}", " 1 0 0 0".repeat(1001));
    for (gene, place, message) in [
        ("F 1 0 0 0", "F", "a gene begins with its lattice"),
        ("name:", "", "a gene begins with its lattice"),
        ("G", "G", "this gene has no segments"),
        (
            "G 1 0 0 0 1 0 0",
            "1",
            "the last segment has 3 of 4 numbers",
        ),
        (
            "G 1 0 0 0 0 1 2 0",
            "2",
            "'2' is no whole number from 0 to 1",
        ),
        (
            "E 1 0 0 0 1 1.5 0 0",
            "1.5",
            "'1.5' is no whole number from -1000 to 1000",
        ),
        (
            "E 1 0 0 0 1001 0 0 0",
            "1001",
            "'1001' is no whole number from -1000 to 1000",
        ),
        (
            "G 1 0 0 0 0 0 0 0 0 1 0 0",
            "0 0 0 0",
            "this segment has no length",
        ),
        (
            "G 1 0 0 0 -1 0 0 0",
            "1 0 0 0",
            "this segment is not shorter than the curve, which is of the family G(0, 0)",
        ),
        (&long, &long, "this gene has more than 1000 segments"),
    ] {
        let (imported, _) = read(gene);
        let found = imported[0].found.iter().next().unwrap();
        assert_eq!(
            (found.place().unwrap().text(), found.message()),
            (place, message)
        );
        assert!(imported[0].document.is_none());
    }
}
