//! Signals: every command ends at once and leaves no file, unless the signal was ignored from the start.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

use rustix::process::{Pid, Signal, kill_process};

fn kfrac(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("kfrac"));
    command
        .current_dir(folder)
        .args(arguments)
        .env_remove("KFRAC_LIBRARY")
        .env("XDG_DATA_HOME", folder.join("data"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command
}

fn make_pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

/// Returns the mask of signals that a process catches or ignores.
fn mask(process: &str, of: &str) -> u64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix(of));
    mask.map_or(0, |mask| u64::from_str_radix(mask.trim(), 16).unwrap())
}

/// Returns whether the tests themselves ignore signals, which their child processes inherit.
pub(crate) fn are_ignored() -> bool {
    let bit = |signal: Signal| 1 << (signal.as_raw() - 1);
    mask("self", "SigIgn:") & (bit(Signal::INT) | bit(Signal::TERM) | bit(Signal::HUP)) != 0
}

/// Waits, up to a time that is long even on a busy machine.
fn until(what: &str, mut happens: impl FnMut() -> bool) {
    for _ in 0..6000 {
        if happens() {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("{what} does not happen");
}

fn send(child: &Child, signal: Signal) {
    kill_process(Pid::from_child(child), signal).unwrap();
}

/// Waits until a process listens to signals, and panics with its errors if it has ended by then.
fn listens(child: &mut Child) {
    let bit = 1 << (Signal::INT.as_raw() - 1);
    until("listening", || {
        if let Some(status) = child.try_wait().unwrap() {
            let mut errors = String::new();
            child
                .stderr
                .take()
                .unwrap()
                .read_to_string(&mut errors)
                .unwrap();
            panic!("{status}: {errors}");
        }
        mask(&child.id().to_string(), "SigCgt:") & bit != 0
    });
}

fn ended(child: Child) -> (ExitStatus, String) {
    let output = child.wait_with_output().unwrap();
    (output.status, String::from_utf8(output.stderr).unwrap())
}

fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = names
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn every_command_that_waits_for_input_ends_when_interrupted() {
    if are_ignored() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for name in ["rule.yaml", "file.l"] {
        make_pipe(&folder.path().join(name));
    }
    // No process writes to the pipes.
    for (arguments, signal) in [
        (&["grow", "rule.yaml"][..], Signal::INT),
        (&["grow", "rule.yaml", "--method", "chaos"], Signal::INT),
        (
            &["grow", "rule.yaml", "--zoom", "10", "--at", "0.(1)"],
            Signal::INT,
        ),
        (&["sheet", "rule.yaml"], Signal::INT),
        (&["show", "rule.yaml"], Signal::INT),
        (&["info", "rule.yaml"], Signal::INT),
        (&["count", "rule.yaml"], Signal::INT),
        (&["dim", "rule.yaml"], Signal::INT),
        (&["cat", "rule.yaml"], Signal::INT),
        (&["check", "rule.yaml"], Signal::INT),
        (&["convert", "rule.yaml", "--to", "ifs"], Signal::INT),
        (&["compare", "koch", "rule.yaml"], Signal::INT),
        (&["import", "file.l"], Signal::INT),
        (&["grow", "rule.yaml"], Signal::TERM),
        (&["grow", "rule.yaml"], Signal::HUP),
    ] {
        let mut child = kfrac(folder.path(), arguments).spawn().unwrap();
        listens(&mut child);
        send(&child, signal);
        let (status, said) = ended(child);
        assert_eq!(
            (status.code(), said.as_str()),
            (Some(130), ""),
            "{arguments:?}"
        );
    }
    assert_eq!(names(folder.path()), ["file.l", "rule.yaml"]);
}

/// A fit that keeps the best system so far writes it at the first Ctrl-C; another fit leaves no file.
#[test]
fn fits_keep_the_best_if_asked() {
    if are_ignored() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let drawn = kfrac::Fractal::named("gasket").unwrap().png(64).unwrap();
    fs::write(folder.path().join("gasket.png"), drawn).unwrap();
    let fit = [
        "fit",
        "gasket.png",
        "-o",
        "rule.yaml",
        "--effort",
        "90000000",
    ];
    let interrupted = |options: &[&str]| {
        let mut child = kfrac(folder.path(), &fit).args(options).spawn().unwrap();
        listens(&mut child);
        // The flag is registered soon after the program listens.
        std::thread::sleep(Duration::from_millis(500));
        send(&child, Signal::INT);
        ended(child)
    };
    let (status, _) = interrupted(&[]);
    assert_eq!(status.code(), Some(130));
    assert_eq!(names(folder.path()), ["gasket.png"]);
    let (status, said) = interrupted(&["--keep-best"]);
    assert!(
        status.success() && said.contains("best system so far"),
        "{said}"
    );
    kfrac::Fractal::open(folder.path().join("rule.yaml")).unwrap();
}

#[test]
fn every_command_that_works_ends_when_interrupted() {
    if are_ignored() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (arguments, writes) in [
        (&["grow", "koch", "--steps", "12", "-o", "k.csv"][..], true),
        (
            &["grow", "levy", "--zoom", "1e10000", "--at", "0.(1)"],
            false,
        ),
        (
            &[
                "grow",
                "barnsley-fern",
                "--method",
                "chaos",
                "--points",
                "1000G",
            ],
            true,
        ),
        (&["dim", "levy", "--grids", "1000"], false),
        (
            &["compare", "dragon", "twindragon", "--tolerance", "1e-8"],
            false,
        ),
        (
            &[
                "count",
                "koch",
                "--steps",
                "15",
                "--max-elements",
                "10000000000",
            ],
            false,
        ),
    ] {
        let mut child = kfrac(folder.path(), arguments).spawn().unwrap();
        listens(&mut child);
        if writes {
            until("writing", || !names(folder.path()).is_empty());
        }
        send(&child, Signal::INT);
        let (status, said) = ended(child);
        assert_eq!(status.code(), Some(130), "{arguments:?}: {said}");
        assert!(names(folder.path()).is_empty(), "{arguments:?}");
    }
}

#[test]
fn signals_that_are_ignored_from_the_start_stay_ignored() {
    let folder = tempfile::tempdir().unwrap();
    make_pipe(&folder.path().join("pipe"));
    let program = assert_cmd::cargo::cargo_bin("kfrac");
    let script = format!(
        "trap '' HUP INT; exec '{}' grow koch --steps 6 --format csv -o pipe",
        program.display()
    );
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .current_dir(folder.path())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut pipe = File::open(folder.path().join("pipe")).unwrap();
    let mut text = vec![0; 10];
    pipe.read_exact(&mut text).unwrap();
    // The command has begun to write, and waits for the pipe to be read.
    for signal in [Signal::HUP, Signal::INT] {
        let bit = 1 << (signal.as_raw() - 1);
        assert!(mask(&child.id().to_string(), "SigIgn:") & bit != 0);
        send(&child, signal);
    }
    std::thread::sleep(Duration::from_millis(50));
    assert!(child.try_wait().unwrap().is_none());
    pipe.read_to_end(&mut text).unwrap();
    let (status, said) = ended(child);
    assert_eq!(status.code(), Some(0), "{said}");
    assert_eq!(text.iter().filter(|byte| **byte == b'\n').count(), 4097);
}

#[test]
fn a_pipe_that_is_written_to_is_a_rule() {
    let folder = tempfile::tempdir().unwrap();
    make_pipe(&folder.path().join("rule.yaml"));
    let child = kfrac(folder.path(), &["dim", "rule.yaml"]).spawn().unwrap();
    let mut pipe = File::options()
        .write(true)
        .open(folder.path().join("rule.yaml"))
        .unwrap();
    pipe.write_all(b"initiator: segment\ngenerator: koch\n")
        .unwrap();
    drop(pipe);
    let (status, said) = ended(child);
    assert_eq!(status.code(), Some(0), "{said}");
}

#[test]
fn what_a_killed_run_leaves_is_removed_by_the_next() {
    if are_ignored() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let table = ["grow", "koch", "--steps", "12", "-o", "k.csv"];
    let mut runs = Vec::new();
    for count in 1..=2 {
        runs.push(kfrac(folder.path(), &table).spawn().unwrap());
        until("writing", || names(folder.path()).len() == count);
    }
    let [mut killed, alive] = <[Child; 2]>::try_from(runs).unwrap();
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert_eq!(names(folder.path()).len(), 2);
    let small = kfrac(folder.path(), &["grow", "koch", "-o", "k.svg"]).output();
    assert!(small.unwrap().status.success());
    // One of the files is that of the run that continues.
    let left = names(folder.path());
    assert_eq!(left.len(), 2, "{left:?}");
    assert!(
        left[0].starts_with(".kfrac-") && left[1] == "k.svg",
        "{left:?}"
    );
    send(&alive, Signal::INT);
    assert_eq!(ended(alive).0.code(), Some(130));
    assert_eq!(names(folder.path()), ["k.svg"]);
}
