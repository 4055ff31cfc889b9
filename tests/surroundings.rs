//! Unusual names, folders, devices and pipes.

#![cfg(unix)]
mod disk;

use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const RULE: &str = "initiator: segment\ngenerator: koch\n";

fn kfrac(folder: &Path) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("kfrac"));
    command
        .current_dir(folder)
        .env_remove("KFRAC_LIBRARY")
        .env("XDG_DATA_HOME", folder.join("data"));
    command
}

/// Returns exit status and standard error.
fn ended(output: &Output) -> (Option<i32>, String) {
    let said = String::from_utf8(output.stderr.clone()).unwrap();
    (output.status.code(), said)
}

fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    ended(&kfrac(folder).args(arguments).output().unwrap())
}

fn files(folder: &Path) -> Vec<OsString> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    names
}

fn bytes(name: &[u8]) -> &OsStr {
    OsStr::from_bytes(name)
}

/// File systems that refuse such names are not affected.
#[cfg(target_os = "linux")]
#[test]
fn names_of_files_need_not_be_text() {
    let folder = tempfile::tempdir().unwrap();
    let rule = bytes(b"k\xff.yaml");
    fs::write(folder.path().join(rule), RULE).unwrap();
    let own = folder.path().join(bytes(b"own\xff"));
    fs::create_dir(&own).unwrap();
    fs::write(own.join("base.yaml"), RULE).unwrap();
    fs::write(own.join("bent.yaml"), "extends: base.yaml\n").unwrap();

    // The picture has the name of the rule, to the byte.
    let grown = kfrac(folder.path())
        .args([OsStr::new("grow"), rule])
        .output();
    let (status, said) = ended(&grown.unwrap());
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.starts_with("k\u{fffd}.svg: step 7 of k\u{fffd}, "),
        "{said}"
    );
    let picture = fs::read_to_string(folder.path().join(bytes(b"k\xff.svg"))).unwrap();
    assert!(picture.contains("# kfrac grow 'k\u{fffd}.yaml' --steps=7"));

    // A folder of the user's, a parent beside the file, an output.
    let from_own = kfrac(folder.path())
        .args([
            OsStr::new("grow"),
            "bent".as_ref(),
            "--library".as_ref(),
            own.as_os_str(),
        ])
        .args([OsStr::new("-o"), bytes(b"o\xfe.csv")])
        .output();
    assert_eq!(ended(&from_own.unwrap()).0, Some(0));
    let table = fs::read_to_string(folder.path().join(bytes(b"o\xfe.csv"))).unwrap();
    assert!(table.starts_with("fractal,"));

    let checked = kfrac(folder.path())
        .args([OsStr::new("check"), rule, bytes(b"none\xff")])
        .output()
        .unwrap();
    assert_eq!(checked.stdout, "k\u{fffd}.yaml: ok\n".as_bytes());
    let (status, said) = ended(&checked);
    assert_eq!(status, Some(1));
    assert!(
        said.contains("there is no rule 'none\u{fffd}' in the library"),
        "{said}"
    );
    let format = kfrac(folder.path())
        .args([OsStr::new("grow"), rule, "-o".as_ref(), bytes(b"k.\xff")])
        .output();
    assert_eq!(ended(&format.unwrap()).0, Some(2));
}

#[test]
fn a_name_stays_on_its_line() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a\n\x1b'b.yaml"), RULE).unwrap();
    let (status, said) = run(folder.path(), &["grow", "a\n\x1b'b.yaml"]);
    assert_eq!((status, said.lines().count()), (Some(0), 1), "{said}");
    assert!(!said.contains('\x1b'));
    let picture = fs::read_to_string(folder.path().join("a\n\x1b'b.svg")).unwrap();
    let command = r"# kfrac grow $'a\u000a\u001b\'b.yaml' --steps=7 --seed=0 --size=1024";
    assert!(picture.lines().any(|line| line == command), "{picture}");
}

#[test]
fn what_names_nothing_is_a_wrong_command_line() {
    let folder = tempfile::tempdir().unwrap();
    for wrong in [
        &["grow", ""][..],
        &["cat", ""],
        &["info", ""],
        &["check", "koch", ""],
        &["grow", "koch", "-o", ""],
        &["grow", "koch", "--library", ""],
        &["grow", "koch", "--size", "0"],
        &["grow", "koch", "--size", "5000000"],
    ] {
        let (status, said) = run(folder.path(), wrong);
        assert_eq!(status, Some(2), "{wrong:?}: {said}");
    }
    assert!(files(folder.path()).is_empty());
}

#[test]
fn folders_are_no_files() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("folder")).unwrap();
    fs::write(folder.path().join("file"), RULE).unwrap();
    for (arguments, message) in [
        (
            &["grow", "koch", "-o", "folder"][..],
            "'folder' is a folder",
        ),
        (&["grow", "koch", "-o", "folder/"], "'folder/' is a folder"),
        (&["grow", "koch", "-o", "new/"], "there is no folder 'new/'"),
        (
            &["grow", "koch", "-o", "new/k.svg"],
            "there is no folder 'new'",
        ),
        (
            &["grow", "koch", "-o", "file/k.svg"],
            "'file/k.svg' cannot be written: not a directory",
        ),
        (&["grow", "folder"], "'folder' is a folder, not a rule file"),
        (
            &["info", "folder/"],
            "'folder/' is a folder, not a rule file",
        ),
        (&["cat", "folder"], "'folder' is a folder, not a rule file"),
        (
            &["check", "folder"],
            "'folder' is a folder, not a rule file",
        ),
        (&["grow", "file/k.yaml"], "there is no file 'file/k.yaml'"),
    ] {
        let ended = run(folder.path(), arguments);
        assert_eq!(
            ended,
            (Some(1), format!("error: {message}\n")),
            "{arguments:?}"
        );
    }
    assert_eq!(files(folder.path()), ["file", "folder"]);
}

#[test]
fn a_folder_that_is_read_only_gets_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mode = |mode| fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode)).unwrap();
    mode(0o555);
    if File::create(folder.path().join("probe")).is_ok() {
        // Root may write everywhere.
        return;
    }
    let ended = run(folder.path(), &["grow", "koch"]);
    mode(0o755);
    let message = "error: 'koch.svg' cannot be written: permission denied\n";
    assert_eq!(ended, (Some(1), message.into()));
    assert!(files(folder.path()).is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_said_to_be_standard_output() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["list"][..],
        &["cat", "koch"],
        &["info", "koch", "--json"],
        &["check", "koch"],
        &["grow", "koch", "-o", "-"],
        &["--help"],
        &["--version"],
    ] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = kfrac(folder.path()).args(arguments).stdout(full).output();
        let (status, said) = ended(&output.unwrap());
        assert_eq!(status, Some(1), "{arguments:?}");
        assert!(
            said.starts_with("error: standard output cannot be written: "),
            "{arguments:?}: {said}"
        );
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["list"][..],
        &["--help"],
        &["grow", "koch", "--steps", "9", "--format", "csv", "-o", "-"],
    ] {
        let mut child = kfrac(folder.path())
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut first = String::new();
        let mut reader = BufReader::with_capacity(16, child.stdout.take().unwrap());
        reader.read_line(&mut first).unwrap();
        drop(reader);
        assert!(!first.is_empty());
        let output = child.wait_with_output().unwrap();
        assert_eq!(ended(&output), (Some(0), String::new()), "{arguments:?}");
    }
}
