//! The program on a terminal.

#![cfg(target_os = "linux")]
pub(crate) mod signals;

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::Read;
use std::os::unix::ffi::OsStringExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

/// A program whose standard error is a terminal, and that terminal.
struct Session {
    child: Child,
    terminal: File,
    seen: String,
}

impl Session {
    fn start(folder: &Path, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let terminal = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&terminal).unwrap();
        unlockpt(&terminal).unwrap();
        let name = OsString::from_vec(ptsname(&terminal, Vec::new()).unwrap().into_bytes());
        let stderr = File::options().write(true).open(name).unwrap();
        let child = Command::new(assert_cmd::cargo::cargo_bin("kfrac"))
            .current_dir(folder)
            .args(arguments)
            .env_clear()
            .env("TERM", "xterm-256color")
            .envs(environment.iter().copied())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(stderr)
            .spawn()
            .unwrap();
        Self {
            child,
            terminal: terminal.into(),
            seen: String::new(),
        }
    }

    /// Reads further output; returns `false` once no process can write to the terminal.
    fn read(&mut self) -> bool {
        let mut bytes = [0; 4096];
        match self.terminal.read(&mut bytes) {
            Ok(0) | Err(_) => false,
            Ok(count) => {
                self.seen += &String::from_utf8_lossy(&bytes[..count]);
                true
            }
        }
    }

    /// Returns the terminal's output, and the exit status.
    fn end(mut self) -> (String, Option<i32>) {
        while self.read() {}
        (self.seen, self.child.wait().unwrap().code())
    }
}

/// Returns the terminal's output of a command that fails in an empty folder.
fn complaint(arguments: &[&str], environment: &[(&str, &str)]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (seen, status) = Session::start(folder.path(), arguments, environment).end();
    assert!(matches!(status, Some(1 | 2)), "{seen}");
    seen
}

fn files(folder: &Path) -> usize {
    fs::read_dir(folder).unwrap().count()
}

#[test]
fn long_work_shows_how_far_it_is_and_clears_it_away() {
    let folder = tempfile::tempdir().unwrap();
    let table = ["grow", "koch", "--steps", "12", "--format", "csv"];
    let mut session = Session::start(folder.path(), &table, &[]);
    while !session.seen.contains("left") {
        assert!(session.read(), "it ended without: {}", session.seen);
    }
    assert!(session.seen.contains(" % ["), "{}", session.seen);
    let id = session.child.id();
    let killed = Command::new("sh")
        .args(["-c", &format!("kill -TERM {id}")])
        .status();
    assert!(killed.unwrap().success());
    let (seen, status) = session.end();
    assert_eq!(status, Some(130));
    assert!(seen.ends_with("\r\x1b[2K"), "{seen:?}");
    assert_eq!(files(folder.path()), 0);
}

#[test]
fn short_work_and_quiet_work_show_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (seen, status) =
        Session::start(folder.path(), &["grow", "koch", "--steps", "3"], &[]).end();
    assert_eq!(status, Some(0));
    assert!(
        seen.starts_with("koch.svg: step ") && !seen.contains('\x1b'),
        "{seen:?}"
    );
    for (option, terminal) in [("--quiet", "xterm"), ("--seed=0", "dumb")] {
        let table = ["grow", "koch", "--steps", "12", "--format", "csv", option];
        let mut session = Session::start(folder.path(), &table, &[("TERM", terminal)]);
        std::thread::sleep(std::time::Duration::from_secs(1));
        session.child.kill().unwrap();
        while session.read() {}
        assert_eq!(session.seen, "");
    }
}

#[test]
fn colours_are_for_terminals_that_want_them() {
    for wrong in [&["grow", "kosh"][..], &["grow", "koch", "--size", "0"]] {
        let coloured =
            |environment: &[(&str, &str)]| complaint(wrong, environment).contains('\x1b');
        assert!(coloured(&[]));
        assert!(!coloured(&[("NO_COLOR", "1")]));
        assert!(!coloured(&[("TERM", "dumb")]));
        assert!(coloured(&[("TERM", "dumb"), ("CLICOLOR_FORCE", "1")]));
    }
}

#[test]
fn colours_are_forced_into_a_pipe() {
    let coloured = |name: &str, value: &str| {
        let output = Command::new(assert_cmd::cargo::cargo_bin("kfrac"))
            .args(["grow", "kosh"])
            .env_remove("NO_COLOR")
            .env(name, value)
            .output();
        output.unwrap().stderr.contains(&b'\x1b')
    };
    assert!(coloured("CLICOLOR_FORCE", "1"));
    assert!(!coloured("CLICOLOR", "1"));
}
