//! Several pictures by one command, in files named by a template.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

use crate::common;

fn grow(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    common::said(folder, &[&["grow"], arguments].concat())
}

/// Returns the names of the files of a folder, in order.
fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

#[test]
fn each_picture_of_several_is_that_of_its_own_command() {
    for (rule, several, names, single) in [
        (
            "random-tree",
            &["--seed", "8..10", "--steps", "4", "-o", "%03s.svg"][..],
            &["008.svg", "009.svg", "010.svg"][..],
            &["--seed", "9", "--steps", "4", "-o", "009.svg"][..],
        ),
        (
            "pythagoras",
            &[
                "--set=angle=30,60",
                "--steps=2,5",
                "-o",
                "%{angle}-%n-100%%.svg",
            ],
            &[
                "30-2-100%.svg",
                "30-5-100%.svg",
                "60-2-100%.svg",
                "60-5-100%.svg",
            ],
            &["--set=angle=60", "--steps=2", "-o", "60-2-100%%.svg"],
        ),
        (
            "complex-pair",
            &[
                "--set=s=[0.3,0.2]..[0.6,0.5]",
                "--samples=3",
                "-o",
                "%{s.re}.csv",
                "--steps=3",
            ],
            &["0.3.csv", "0.45.csv", "0.6.csv"],
            &["--set=s=[0.45,0.35]", "-o", "0.45.csv", "--steps=3"],
        ),
        (
            "menger",
            &[
                "--steps=1..2",
                "-o",
                "%n.png",
                "--depth=depth-%n.png",
                "--size=60",
            ],
            &["1.png", "2.png", "depth-1.png", "depth-2.png"],
            &[
                "--steps=2",
                "-o",
                "2.png",
                "--depth=depth-2.png",
                "--size=60",
            ],
        ),
        (
            "barnsley-fern",
            &[
                "--method=chaos",
                "--points=1000",
                "--seed=1,3",
                "-o",
                "%s.csv",
            ],
            &["1.csv", "3.csv"],
            &["--method=chaos", "--points=1000", "--seed=3", "-o", "3.csv"],
        ),
    ] {
        let folders = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let [all, one] = [&folders[0], &folders[1]].map(|folder| folder.path());
        let (status, said) = grow(all, &[&[rule], several].concat());
        assert_eq!(status, Some(0), "{said}");
        assert_eq!(files(all), names);
        let (status, said) = grow(one, &[&[rule], single].concat());
        assert_eq!(status, Some(0), "{said}");
        for name in files(one) {
            let [several, single] = [all, one].map(|folder| fs::read(folder.join(&name)).unwrap());
            // All that a picture holds, its command included.
            assert!(several == single, "{name}");
        }
    }
}

#[test]
fn a_rule_from_standard_input_is_read_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_kfrac"));
    let command = command.args(["grow", "-", "--steps", "1,2", "-o", "%n.svg", "-q"]);
    let rule = "initiator: segment\ngenerator: koch\n";
    command
        .current_dir(folder.path())
        .write_stdin(rule)
        .assert()
        .success();
    assert_eq!(files(folder.path()), ["1.svg", "2.svg"]);
}

#[test]
fn names_that_do_not_differ_are_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (arguments, message) in [
        (
            &["koch", "--steps", "0..3"][..],
            "4 pictures need names that differ: write --output 'koch-%n.svg'",
        ),
        (
            &["koch", "--steps", "0..3", "--seed", "1,2", "-o", "%n.png"],
            "8 pictures need names that differ: write --output 'koch-%n-%s.png'",
        ),
        (
            &["koch", "--steps", "0..3", "-o", "-"],
            "4 pictures need names that differ",
        ),
        (
            &[
                "menger", "--steps", "1,2", "-o", "%n.png", "--depth", "d.png",
            ],
            "write --depth 'menger-depth-%n.png'",
        ),
        (
            &["koch", "--seed", "3,3", "-o", "%s.svg"],
            "two files would have the name '3.svg'",
        ),
        (
            &[
                "menger", "--steps", "1,2", "-o", "%n.png", "--depth", "%n.png",
            ],
            "two files would have the name '1.png'",
        ),
        (
            &["koch", "-o", "100%.svg"],
            "'%.' is no placeholder; write %s",
        ),
        (&["koch", "-o", "%n.svg"], "'%n' in a name needs --steps"),
        (
            &["koch", "-o", "%{x}.svg"],
            "'%{x}' in a name needs --set x=VALUE",
        ),
        (
            &["koch", "--seed", "1..100000", "-o", "%s.svg"],
            "no more than 10000 pictures are drawn at once, and 100000 are asked for",
        ),
        (
            &["koch", "--seed", "1..18446744073709551615", "-o", "%s.svg"],
            "a list has no more than 100000 numbers",
        ),
        (
            &["pythagoras", "--set", "angle=30,200", "-o", "%{angle}.svg"],
            "--set angle=200: ",
        ),
        (
            &["koch", "--seed", "1,2", "-o", "%s.svg", "--watch"],
            "--watch and --open are for a single picture",
        ),
        (
            &[
                "koch",
                "--seed",
                "1,2",
                "-o",
                "%s.svg",
                "--plot",
                "--detail",
                "1",
                "--svg",
                "instanced",
            ],
            "--",
        ),
    ] {
        let (status, said) = grow(folder, arguments);
        assert_eq!(status, Some(2), "{arguments:?}: {said}");
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
    let (status, said) = common::said(folder, &["count", "koch", "--seed", "1,2"]);
    assert_eq!(status, Some(2), "{said}");
    assert!(said.contains("for `kfrac grow`"), "{said}");
    assert!(files(folder).is_empty());
}
