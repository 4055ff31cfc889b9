//! The program as people run it.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use assert_cmd::Command;

fn kfrac(folder: &std::path::Path) -> Command {
    let mut command = Command::cargo_bin("kfrac").unwrap();
    command
        .current_dir(folder)
        .env_remove("KFRAC_LIBRARY")
        .env("XDG_DATA_HOME", folder);
    command
}

#[test]
fn the_main_job_works_in_an_empty_folder() {
    let folder = tempfile::tempdir().unwrap();
    let run = kfrac(folder.path())
        .args(["grow", "pythagoras.yaml", "--steps", "8"])
        .assert()
        .success();
    let said = String::from_utf8(run.get_output().stderr.clone()).unwrap();
    assert!(
        said.starts_with("pythagoras.svg: step 8 of pythagoras, 766 elements, 1024 x "),
        "{said}"
    );
    assert!(run.get_output().stdout.is_empty());
    let svg = std::fs::read_to_string(folder.path().join("pythagoras.svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
