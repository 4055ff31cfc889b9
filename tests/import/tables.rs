//! Import of tables of maps.

use std::fs;

use tempfile::TempDir;

use super::{assert_same, imported, kfrac, said};

const FERN: &str = "\
a,b,c,d,e,f,p
0,0,0,0.16,0,0,0.01
0.85,0.04,-0.04,0.85,0,1.6,0.85
0.2,-0.26,0.23,0.22,0,1.6,0.07
-0.15,0.28,0.26,0.24,0,0.44,0.07
";

/// Koch's curve in the order of SVG's `matrix()`: 60 degrees turn (1, 0) to (1/2, √3/2).
const KOCH: &str = "\
1/3 0 0 1/3 0 0
0.16666666666666666 0.28867513459481287 -0.28867513459481287 0.16666666666666666 1/3 0
0.16666666666666666 -0.28867513459481287 0.28867513459481287 0.16666666666666666 1/2 0.28867513459481287
1/3 0 0 1/3 2/3 0
";

#[test]
fn tables_are_the_sets_of_the_library() {
    let (folder, said) = imported("fern.csv", FERN, &[]);
    assert_eq!(said, "fern.csv: 1 written to .\n");
    assert_same(folder.path(), "fern.yaml", "barnsley-fern-four", "0.01");
    let yaml = fs::read_to_string(folder.path().join("fern.yaml")).unwrap();
    assert!(yaml.contains("weight: 0.85"), "{yaml}");
    let (folder, _) = imported("koch.txt", KOCH, &["--from", "csv", "--columns", "acbdef"]);
    assert_same(folder.path(), "koch.yaml", "koch", "0.001");
}

#[test]
fn tables_of_space_are_the_sets_of_the_library() {
    let mut table = String::from("j k l a b c d e f g h i\n");
    for place in 0..27 {
        let at = [place % 3, place / 3 % 3, place / 9];
        if at.iter().filter(|it| **it == 1).count() < 2 {
            let [x, y, z] = at;
            table += &format!("{x}/3 {y}/3 {z}/3  1/3 0 0  0 1/3 0  0 0 1/3\n");
        }
    }
    let (folder, _) = imported("sponge.csv", &table, &[]);
    assert_same(folder.path(), "sponge.yaml", "menger", "0.05");
}

#[test]
fn tables_come_from_standard_input() {
    let folder = TempDir::new().unwrap();
    let output = kfrac(folder.path())
        .args(["import", "-", "--from", "csv", "-o", "out"])
        .write_stdin(FERN)
        .output()
        .unwrap();
    assert!(output.status.success(), "{:?}", said(&output));
    let yaml = fs::read_to_string(folder.path().join("out/maps.yaml")).unwrap();
    assert!(
        yaml.starts_with("title: maps\nsource: maps, a table of maps\n"),
        "{yaml}"
    );
}

#[test]
fn refusals_name_their_lines() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("maps.csv"), "a,b,c,d,e,f\n.5,0,0,.5,0\n").unwrap();
    fs::write(folder.path().join("empty.csv"), "# none\n\n").unwrap();
    fs::write(folder.path().join("a.ifs"), "a { .5 0 0 .5 0 0 1 }").unwrap();
    let cases: [(&[&str], &str); 6] = [
        (&["maps.csv"], "maps.csv:2:1"),
        (&["maps.csv"], "this row has 5 columns, not 6"),
        (&["empty.csv"], "'empty.csv' has no entries"),
        (
            &["maps.csv", "--columns", "abc"],
            "there is no column d, e, f",
        ),
        (
            &["a.ifs", "--columns", "abcdef"],
            "--columns is for tables of maps, not for systems of maps of Fractint",
        ),
        (&["-"], "the format of standard input is not known"),
    ];
    for (arguments, expected) in cases {
        let output = kfrac(folder.path())
            .arg("import")
            .args(arguments)
            .output()
            .unwrap();
        let (_, errors) = said(&output);
        assert!(
            !output.status.success() && errors.contains(expected),
            "{arguments:?}: {errors}"
        );
    }
    assert!(!folder.path().join("maps.yaml").exists());
}
