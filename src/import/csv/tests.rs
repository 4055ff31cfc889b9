//! Tests of the import of tables of maps.

use crate::diagnostic::{Diagnostics, Severity, Source};
use crate::geometry::DAffine2;
use crate::import::{ImportOptions, Imported, SourceFormat};
use crate::model::Model;

use super::{ColumnsError, MapColumns};

fn read_with(text: &str, columns: Option<&str>) -> Imported {
    let columns = columns.map(|columns| columns.parse().unwrap());
    let options = ImportOptions { columns };
    let source = Source::new("some/maple.csv", text);
    let (mut imported, stray) = crate::import::read(&source, SourceFormat::Csv, &options);
    assert!(stray.is_empty(), "{stray}");
    assert_eq!(imported.len(), 1);
    imported.remove(0)
}

/// Returns the maps of a table with their weights.
fn maps(imported: &Imported) -> Vec<(DAffine2, f64)> {
    let document = imported.document.as_ref();
    let document = document.unwrap_or_else(|| panic!("{}", imported.found));
    let Model::Ifs(system) = document.resolve(&[]).unwrap().0 else {
        panic!("it is a system of the plane");
    };
    let affine = system.ifs().maps().iter().map(|map| map.affine);
    affine.zip(system.ifs().weights().iter().copied()).collect()
}

/// Returns the messages with the texts at their places.
fn messages(found: &Diagnostics) -> Vec<(Severity, &str, &str)> {
    let message = |found| {
        let found: &crate::diagnostic::Diagnostic = found;
        let place = found.place().unwrap();
        let text = &place.source().text()[place.range()];
        (found.severity(), found.message(), text)
    };
    found.iter().map(message).collect()
}

/// x' = 0.1 x + 0.2 y + 0.5, y' = 0.3 x + 0.4 y + 0.6, and a half.
const BY_ROWS: [f64; 6] = [0.1, 0.3, 0.2, 0.4, 0.5, 0.6];
const HALF: [f64; 6] = [0.5, 0.0, 0.0, 0.5, 0.0, 0.0];

#[test]
fn orders_and_separators_are_those_of_the_table() {
    let cases = [
        ("a,b,c,d,e,f\n.1,.2,.3,.4,.5,.6\n.5,0,0,.5,0,0\n", None),
        (
            "F; E; D; C; B; A\r\n.6;.5;.4;.3;.2;.1\r\n0;0;.5;0;0;.5",
            None,
        ),
        (
            "\"a\"\t\"d\"\t\"b\"\t\"c\"\t\"e\"\t\"f\"\n.1\t.4\t.2\t.3\t.5\t.6\n.5\t.5\t0\t0\t0\t0",
            None,
        ),
        (
            "# x' before y'\n .1  .2 .5 .3 .4 .6 # one\n\n 1/2 0 0 0 1/2 0",
            Some("abecdf"),
        ),
        (".1 .3 .2 .4 .5 .6\n.5 0 0 .5 0 0", Some("acbdef")),
        (
            "map,x,y\n1,.1,.2,.3,.4,.5,.6\n2,.5,0,0,.5,0,0",
            Some("-abcdef"),
        ),
    ];
    for (text, columns) in cases {
        let imported = read_with(text, columns);
        assert!(imported.found.is_empty(), "{text}: {}", imported.found);
        let maps: Vec<_> = maps(&imported).into_iter().map(|(map, _)| map).collect();
        let expected = [BY_ROWS, HALF].map(|map| DAffine2::from_cols_array(&map));
        assert_eq!(maps, expected, "{text}");
    }
}

#[test]
fn probabilities_are_weights() {
    let imported = read_with(
        "Probability,a,b,c,d,e,f,label\n3,.5,0,0,.5,0,0,u\n1,.5,0,0,.5,1/2,0,v\n0,.5,0,0,.5,0,1,w\n",
        None,
    );
    let weights: Vec<_> = maps(&imported)
        .into_iter()
        .map(|(_, weight)| weight)
        .collect();
    assert_eq!(weights, [3.0, 1.0]);
    let expected = [
        (Severity::Warning, "the column 'label' is left out", "label"),
        (
            Severity::Warning,
            "the probability 0 is not positive: this map is left out",
            "0",
        ),
    ];
    assert_eq!(messages(&imported.found), expected);
}

#[test]
fn an_order_that_is_not_stated_is_reported() {
    let imported = read_with(".1 .2 .3 .4 .5 .6 1\n.5 0 0 .5 0 0 1\n", None);
    let message = "the order of the columns is not stated: abcdefp is assumed";
    let first = ".1 .2 .3 .4 .5 .6 1";
    assert_eq!(
        messages(&imported.found),
        [(Severity::Warning, message, first)]
    );
    assert_eq!(maps(&imported)[0].0, DAffine2::from_cols_array(&BY_ROWS));
    let space = ".5 0 0 0 .5 0 0 0 .5 0 0 0\n.5 0 0 0 .5 0 0 0 .5 1 2 3\n";
    let imported = read_with(space, None);
    let yaml = imported.document.unwrap().to_yaml();
    assert!(
        yaml.contains("space: 3") && yaml.contains("translate: [1, 2, 3]"),
        "{yaml}"
    );
}

#[test]
fn refusals_have_their_lines() {
    let error = |text, columns| {
        let imported = read_with(text, columns);
        assert!(imported.document.is_none(), "{text}");
        let errors = imported
            .found
            .iter()
            .filter(|it| it.severity() == Severity::Error);
        let errors = errors.map(|it| (it.place().unwrap().line(), it.message().to_owned()));
        errors.collect::<Vec<_>>()
    };
    let one = |line, message: &str| vec![(line, message.to_owned())];
    assert_eq!(
        error("1 2 3\n", None),
        one(1, "this row has 3 columns, and a map has 6 or 7")
    );
    assert_eq!(
        error("a,b,c,d,e,f\n.5,0,0,.5,0,0\n.5,0,0\n", None),
        one(3, "this row has 3 columns, not 6")
    );
    assert_eq!(
        error(
            "a,b,c,d,e,f\n.5,,0,.5,0,0\n.5,0,0,inf,0,0,\n.5,0,0,1/0,0,0",
            None
        ),
        [
            (2, "'' is not a number".to_owned()),
            (3, "this row has 7 columns, not 6".to_owned()),
            (4, "'1/0' is not a number".to_owned()),
        ]
    );
    assert_eq!(
        error("a,b,c,d,tx,ty\n", None),
        one(1, "there is no column e, f")
    );
    assert_eq!(
        error("a,a,c,d,e,f\n", None),
        one(1, "there are two columns 'a'")
    );
    assert_eq!(error("a,b,c,d,e,f\n", None), one(1, "maple has no maps"));
    let grows = error("2 0 0 2 0 0\n", Some("abcdef"));
    assert!(grows[0].1.contains("contract"), "{grows:?}");
}

#[test]
fn columns_are_letters() {
    let columns = |text: &str| text.parse::<MapColumns>();
    assert_eq!(columns("a, b c,def p"), columns("abcdefp"));
    assert_eq!(columns("abcdex"), Err(ColumnsError::Unknown("x".into())));
    assert_eq!(columns("abcdefa"), Err(ColumnsError::Twice('a')));
    assert_eq!(
        columns("abcefg"),
        Err(ColumnsError::Missing("d, h, i, j, k, l".into()))
    );
    assert!(columns("pabcdefghijkl").is_ok());
}
