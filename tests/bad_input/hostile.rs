//! Excessive input, through the program where its exit status matters.

use std::fs;
use std::path::Path;
use std::time::Duration;

use assert_cmd::Command;
use kfrac::catalogue::Catalogue;

/// Time after which the program hangs, however busy the machine is.
const NEVER: Duration = Duration::from_secs(600);
/// Limits of the time on processors in seconds, and of the address space in KiB. The program under test is hardly
/// optimised.
const LIMITS: &str = "ulimit -t 60; ulimit -v 3000000 2> /dev/null; exec \"$0\" \"$@\"";
/// Limit of the length of the messages about one file.
const MAX_SAID: usize = 100_000;

pub(super) struct Outcome {
    pub(super) status: Option<i32>,
    pub(super) said: String,
}

pub(super) fn kfrac(folder: &Path, arguments: &[&str]) -> Outcome {
    let program = assert_cmd::cargo::cargo_bin!("kfrac");
    let mut command = match cfg!(unix) {
        true => Command::new("sh"),
        false => Command::new(program),
    };
    if cfg!(unix) {
        command.args(["-c", LIMITS]).arg(program);
    }
    let output = command
        .current_dir(folder)
        .env_remove("KFRAC_LIBRARY")
        .env("XDG_DATA_HOME", folder.join("data"))
        .args(arguments)
        .timeout(NEVER)
        .output()
        .unwrap();
    assert!(
        output.status.code().is_some(),
        "{arguments:?} takes long, or much memory"
    );
    assert!(output.stdout.len() < MAX_SAID);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.len() < MAX_SAID, "{arguments:?} says too much");
    assert!(!said.contains("panicked"), "{said}");
    Outcome {
        status: output.status.code(),
        said,
    }
}

/// Asserts that a file is refused by `check` and by `grow`, which leaves no file behind.
pub(super) fn refused(bytes: &[u8], message: &str) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.yaml"), bytes).unwrap();
    for arguments in [&["check", "bad.yaml"][..], &["grow", "bad.yaml"]] {
        let outcome = kfrac(folder.path(), arguments);
        assert_eq!(outcome.status, Some(1), "{}", outcome.said);
        assert!(outcome.said.contains(message), "{}", outcome.said);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}

const KOCH: &str = "initiator: segment\ngenerator: koch\n";

#[test]
fn what_is_too_large_is_refused_unread() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.yaml");
    let file = fs::File::create(&path).unwrap();
    file.set_len(100 << 20).unwrap();
    drop(file);
    let outcome = kfrac(folder.path(), &["grow", "bad.yaml"]);
    assert_eq!(outcome.status, Some(1));
    assert_eq!(outcome.said, "error: 'bad.yaml' is larger than 4 MiB\n");
    refused(
        "# comment\n".repeat(11 << 20).as_bytes(),
        "is larger than 4 MiB",
    );
}

#[test]
fn what_is_no_text_is_refused() {
    refused(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "is not a text file");
    refused(b"title: K\xf6ch\n", "line 1 is not UTF-8");
    refused(b"title: Koch\0\n", "is not a text file");
    refused(b"\xff\xfet\0i\0", "UTF-16");
    refused(b"title: \x1b[31mred\n", "control character U+001B");
    refused(b"", "the file is empty");
}

#[test]
fn bombs_do_not_go_off() {
    let mut bomb = String::from("a: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol, lol]\n");
    for level in 1..10 {
        let before = format!("*a{}, ", level - 1).repeat(10);
        bomb += &format!("b{level}: &a{level} [{}]\n", before.trim_end_matches(", "));
    }
    refused(bomb.as_bytes(), "250,000 values");
    refused(b"a: &a [*a]\n", "stands inside of what it refers to");
    let deep = 100_000;
    refused(
        format!("generator: {}", "[".repeat(deep)).as_bytes(),
        "nested more than 64 deep",
    );
    refused("{a: ".repeat(deep).as_bytes(), "nested more than 64 deep");
    refused("- ".repeat(deep).as_bytes(), "nested more than 64 deep");
    let lines: String = (0..1500)
        .map(|depth| format!("{}a:\n", " ".repeat(depth)))
        .collect();
    refused(lines.as_bytes(), "nested more than 64 deep");
    let brackets = |text: String| format!("{KOCH}dimension: \"{text}\"\n");
    refused(brackets("(".repeat(deep)).as_bytes(), "this is too long");
    refused(brackets("(".repeat(4000)).as_bytes(), "nested too deeply");
    refused(brackets("-".repeat(4000)).as_bytes(), "nested too deeply");
    refused(
        brackets("1+".repeat(2000) + "1").as_bytes(),
        "too many operators",
    );
    refused(
        brackets("2^".repeat(2000) + "1").as_bytes(),
        "nested too deeply",
    );
    refused(brackets("9".repeat(4000)).as_bytes(), "too large");
}

#[test]
fn long_lists_are_read_or_refused_soon() {
    let long = format!("{KOCH}title: [{}]\n", "[0, 0], ".repeat(200_000));
    refused(long.as_bytes(), "250,000 values");
    let points: String = (0..60_000).map(|i| format!("- [{i}/60000, 0]\n")).collect();
    let folder = tempfile::tempdir().unwrap();
    let many = format!("initiator: segment\nsteps: 1\ngenerator:\n{points}");
    fs::write(folder.path().join("many.yaml"), many).unwrap();
    assert_eq!(
        kfrac(folder.path(), &["check", "many.yaml"]).status,
        Some(0)
    );
    let keys: String = (0..10_000).map(|i| format!("k{i}: 0\n")).collect();
    refused((KOCH.to_owned() + &keys).as_bytes(), "more");
    let params: String = (0..20_000).map(|i| format!("  a{i}: {i}\n")).collect();
    let params = format!("{KOCH}params:\n{params}  last: a1 + missing\n");
    refused(params.as_bytes(), "unknown name 'missing'");
    let line = "x".repeat(3 << 20);
    refused(
        format!("{KOCH}title: Koch\n{line}: 3\n").as_bytes(),
        "error",
    );
    refused(
        format!("{KOCH}steps: {line}\n").as_bytes(),
        "this is too long",
    );
}

#[test]
fn names_are_compared_with_few_others() {
    // More unknown names than get a suggestion, then more generators than are compared with one.
    for (generators, uses) in [(100, 50_000), (5_000, 20)] {
        let named: String = (0..generators)
            .map(|i| format!("  g{i}: [[0, 0], [1/2, 0]]\n"))
            .collect();
        let select = "nothing, ".repeat(uses);
        let text =
            format!("initiator: segment\ngenerators:\n{named}select: {{by_index: [{select}]}}\n");
        refused(text.as_bytes(), "there is no generator 'nothing'");
    }
}

#[test]
fn many_moves_missing_components_and_unused_parameters_cost_little() {
    let points = "[1/2, 1/4], ".repeat(20_000);
    let moves = "{rotate: 1}, ".repeat(20_000);
    let moved = format!(
        "initiator: segment\ngenerator:\n  elements: [[0, 0], {points}[1, 0]]\n  move: [{moves}]\n"
    );
    refused(moved.as_bytes(), "1,000 moves at most");
    let named: String = (0..20_000)
        .map(|i| format!("  - {{to: [1/2, 0], base_element: missing{i}}}\n"))
        .collect();
    let missing = format!("initiator: segment\ngenerator:\n  - [0, 0]\n{named}");
    refused(
        missing.as_bytes(),
        "no base element 'missing0' in the library",
    );
    let params: String = (0..20_000)
        .map(|i| format!("  a{i}: a{}/2\n", i / 2))
        .collect();
    let params = format!(
        "{KOCH}params:\n  last: 1\n{}",
        params.replacen("a0/2", "0", 1)
    );
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("unused.yaml"), params).unwrap();
    let outcome = kfrac(folder.path(), &["check", "unused.yaml"]);
    assert!(outcome.said.contains("nothing uses the parameter 'last'"));
}

#[test]
fn of_many_mistakes_the_first_are_said() {
    let wrong = format!("{KOCH}generators:\n  a:\n{}", "  - [1]\n".repeat(20_000));
    refused(wrong.as_bytes(), "more");
    let wrong = format!(
        "initiator: segment\ngenerator:\n{}",
        "- [x, y]\n".repeat(20_000)
    );
    refused(wrong.as_bytes(), "\nand 900 more");
    let wrong = format!("{KOCH}tags: [{}]\n", "max(1, 2), ".repeat(20_000));
    refused(wrong.as_bytes(), "\nand 19900 more");
}

#[cfg(unix)]
#[test]
fn a_device_is_not_extended() {
    refused(b"extends: /dev/null\n", "'/dev/null' is no regular file");
}

#[test]
fn what_is_no_file_is_said() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("rules.yaml")).unwrap();
    let says = |argument: &str, message: &str| {
        let outcome = kfrac(folder.path(), &["grow", argument, "-o", "a.svg"]);
        assert_eq!(outcome.status, Some(1), "{}", outcome.said);
        assert!(outcome.said.contains(message), "{}", outcome.said);
    };
    says("rules.yaml", "'rules.yaml' is a folder, not a rule file");
    says("missing/koch.yaml", "there is no file 'missing/koch.yaml'");
    says("kohc", "did you mean 'koch'?");
    #[cfg(unix)]
    {
        use std::os::unix::fs::{PermissionsExt, symlink};
        symlink("loop.yaml", folder.path().join("loop.yaml")).unwrap();
        let outcome = kfrac(folder.path(), &["grow", "loop.yaml"]);
        assert_eq!(outcome.status, Some(1), "{}", outcome.said);
        let locked = folder.path().join("locked.yaml");
        fs::write(&locked, KOCH).unwrap();
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o000)).unwrap();
        // A privileged user may read the file.
        if fs::read(&locked).is_err() {
            says("locked.yaml", "'locked.yaml' cannot be read");
        }
    }
    assert!(!folder.path().join("a.svg").exists());
}

#[test]
fn a_wrong_setting_is_a_wrong_command_line() {
    let folder = tempfile::tempdir().unwrap();
    for (setting, message) in [
        ("angel=30", "did you mean 'angle'?"),
        ("angle=900", "above its largest value"),
        ("angle=1/0", "division by zero"),
        ("angle=", "an expression is missing"),
        ("angle", "NAME=VALUE"),
        ("angle=x", "unknown name 'x'"),
        ("angle=1e999", "too large"),
        ("=3", "has no parameter ''"),
    ] {
        let outcome = kfrac(folder.path(), &["grow", "pythagoras", "--set", setting]);
        assert_eq!(outcome.status, Some(2), "{setting}: {}", outcome.said);
        assert!(
            outcome.said.contains(message),
            "{setting}: {}",
            outcome.said
        );
    }
    let huge = format!("angle={}", "(".repeat(5000));
    let outcome = kfrac(folder.path(), &["grow", "pythagoras", "--set", &huge]);
    assert_eq!(outcome.status, Some(2));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn of_a_setting_only_errors_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let long = "params: {a: {value: 1, max: 2}}\ninitiator: segment\ngenerator: [[0, 0], [2, 0]]\n";
    fs::write(folder.path().join("long.yaml"), long).unwrap();
    let outcome = kfrac(folder.path(), &["grow", "long.yaml", "--set", "a=3"]);
    assert_eq!(outcome.status, Some(2));
    let said = "error: --set a=3: 'a' is 3, above its largest value 2\n";
    assert_eq!(outcome.said, said);
}

#[test]
fn a_library_that_is_given_must_be_there() {
    let folder = tempfile::tempdir().unwrap();
    let outcome = kfrac(folder.path(), &["--library", "lib", "list"]);
    assert_eq!(outcome.status, Some(2));
    assert_eq!(outcome.said, "error: --library: there is no folder 'lib'\n");
    fs::create_dir(folder.path().join("lib")).unwrap();
    let outcome = kfrac(folder.path(), &["--library", "lib", "check", "koch.yml"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.said);
}

#[test]
fn parents_and_components_may_be_hostile_too() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    for number in 0..40 {
        let text = format!("extends: r{}\n", number + 1);
        write(&format!("rules/r{number}.yaml"), &text);
    }
    write("generators/koch.yaml", "generator: koch\n");
    write("generators/broken.yaml", "elements: [[0, 0");
    let catalogue = Catalogue::with_folders(vec![folder.path().into()]);
    let says = |text: &str| {
        write("rules/mine.yaml", text);
        let found = super::check("mine", &catalogue).unwrap_err();
        let text = found.to_string();
        (found.len(), text)
    };
    let (count, said) = says("extends: r0\n");
    assert!(
        count == 1 && said.contains("more than 32 rules extend each other"),
        "{said}"
    );
    let (count, said) = says("extends: mine\n");
    assert!(
        count == 1 && said.contains("'mine' extends itself"),
        "{said}"
    );
    // A generator that extends itself is refused: components do not contain components.
    let (count, said) = says(KOCH);
    assert!(
        count == 2 && said.contains("unknown key 'generator' in a generator"),
        "{said}"
    );
    let (count, said) = says("initiator: segment\ngenerators: {a: broken, b: broken}\n");
    assert!(count == 1 && said.contains("never closed"), "{said}");
}
