//! Import of files of other programs, through the command-line program.

mod aifs;
mod eisenscript;
mod fractasketch;
mod genes;
mod tables;

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

fn kfrac(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("kfrac").expect("it was built");
    command.current_dir(folder);
    command
}

/// Returns standard output and standard error.
fn said(output: &std::process::Output) -> (String, String) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&output.stdout), text(&output.stderr))
}

/// Writes a file, imports it with further arguments, and returns the folder and what was said.
fn imported(name: &str, text: &str, arguments: &[&str]) -> (TempDir, String) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    let output = kfrac(folder.path())
        .args(["import", name])
        .args(arguments)
        .output()
        .unwrap();
    let (_, errors) = said(&output);
    assert!(output.status.success(), "{errors}");
    (folder, errors)
}

/// Asserts that an imported file has the limit set of a fractal of the library, within a tolerance.
fn assert_same(folder: &Path, file: &str, known: &str, tolerance: &str) {
    let arguments = ["compare", file, known, "--json", "--tolerance", tolerance];
    let output = kfrac(folder).args(arguments).output().unwrap();
    let found: serde_json::Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|_| panic!("{file}: {:?}", said(&output)));
    assert_eq!(found["same"], true, "{file} is not {known}: {found}");
    assert_eq!(found["reached"], true, "{file}: {found}");
}

const CURVES: &str = "\
; two that can be read, and one that cannot
Koch1 { ; Adrian Mariano
  Angle 6
  Axiom F--F--F
  F=F+F--F+F
}
Two headings { Angle 4 Axiom F]D F=FF }
Big.H { Angle 4 Axiom [F]--F F=|[+F@iq2F] }
";

#[test]
fn every_entry_becomes_a_file_that_grows() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("curves.l"), CURVES).unwrap();
    let output = kfrac(folder.path())
        .args(["import", "curves.l", "-o", "out"])
        .output()
        .unwrap();
    let (_, errors) = said(&output);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert!(errors.contains("curves.l:7:31"), "{errors}");
    assert!(
        errors.ends_with("curves.l: 2 of 3 written to out\nnot written: Two headings\n"),
        "{errors}"
    );
    for name in ["koch1", "big-h"] {
        let grown = kfrac(&folder.path().join("out"))
            .args(["grow", &format!("{name}.yaml"), "--steps", "2", "--quiet"])
            .output()
            .unwrap();
        assert!(grown.status.success(), "{:?}", said(&grown));
    }
    let yaml = fs::read_to_string(folder.path().join("out/koch1.yaml")).unwrap();
    assert!(
        yaml.starts_with(
            "title: Koch1\nabout: Adrian Mariano\nsource: Koch1 in curves.l, for Fractint\n"
        ),
        "{yaml}"
    );
}

#[test]
fn files_that_are_there_are_kept() {
    let folder = TempDir::new().unwrap();
    let maps = "a { .5 0 0 .5 0 0 1 }\nA { .5 0 0 .5 1 0 1 }\n";
    fs::write(folder.path().join("maps.IFS"), maps).unwrap();
    fs::write(folder.path().join("a.yaml"), "mine").unwrap();
    let output = kfrac(folder.path())
        .args(["import", "maps.IFS"])
        .output()
        .unwrap();
    let (_, errors) = said(&output);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        errors.contains("'./a.yaml' exists: a is not written"),
        "{errors}"
    );
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("a.yaml"), "mine");
    assert!(read("a-2.yaml").contains("translate"));
    let output = kfrac(folder.path())
        .args(["import", "maps.IFS", "--force"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{:?}", said(&output));
    assert!(read("a.yaml").contains("maps"));
}

#[test]
fn programs_are_told_what_became_of_each() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("curves.l"), CURVES).unwrap();
    let output = kfrac(folder.path())
        .args(["import", "curves.l", "--json"])
        .output()
        .unwrap();
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(told[0]["entry"], "Koch1");
    assert_eq!(told[0]["file"], "./koch1.yaml");
    assert_eq!(told[0]["found"], serde_json::json!([]));
    assert_eq!(told[1]["file"], serde_json::Value::Null);
    assert_eq!(told[1]["found"][0]["line"], 7);
    assert_eq!(told[1]["found"][0]["severity"], "error");
}

#[test]
fn files_that_hold_nothing_are_refused() {
    let folder = TempDir::new().unwrap();
    let cases: [(&str, &[u8], &str); 4] = [
        ("none.l", b"; nothing\n", "'none.l' has no entries"),
        ("data.l", b"\0\x01", "is not a text file"),
        (
            "curves.txt",
            b"",
            "the format of 'curves.txt' is not known: --from is one of l, ifs, csv, aifs, genes, fsk, eisenscript",
        ),
        ("missing.l", b"", "there is no file 'missing.l'"),
    ];
    for (name, text, message) in cases {
        if name != "missing.l" {
            fs::write(folder.path().join(name), text).unwrap();
        }
        let output = kfrac(folder.path())
            .args(["import", name])
            .output()
            .unwrap();
        let (_, errors) = said(&output);
        assert!(
            !output.status.success() && errors.contains(message),
            "{name}: {errors}"
        );
    }
    // Some files are older than UTF-8.
    fs::write(
        folder.path().join("old.l"),
        b"L\xe9vy { ; caf\xe9\n angle 8 axiom F F=+F--F+ }",
    )
    .unwrap();
    let output = kfrac(folder.path())
        .args(["import", "old.l"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{:?}", said(&output));
    let yaml = fs::read_to_string(folder.path().join("l\u{e9}vy.yaml")).unwrap();
    assert!(yaml.contains("caf\u{e9}"), "{yaml}");
}
