//! Fuzzing of command lines: each input is a command line, a word in each line, which the program that `KFRAC` names
//! runs in an empty folder.
//!
//! Checks that the program ends by itself with status 0, 1 or 2, within 20 s of CPU time and 3 GB of address space;
//! that a failure has a message; that a refused command line leaves no file; and that no file is left under a temporary
//! name. Words with a slash, those that begin with a dot, and commands that wait or call other programs are left out.

#![no_main]

mod random;

use std::fs;
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use random::Random;

/// Commands that are run; `studio` waits for requests.
const COMMANDS: [&str; 16] = [
    "grow", "show", "sheet", "map", "info", "count", "dim", "skeleton", "list", "cat", "check",
    "convert", "compare", "animate", "dataset", "new",
];

/// Values of options.
const VALUES: [&str; 40] = [
    "koch",
    "pythagoras",
    "fern",
    "dragon-lsystem",
    "menger",
    "no-such",
    "0",
    "1",
    "2",
    "3",
    "12",
    "-1",
    "1e9",
    "1e999",
    "nan",
    "0.01",
    "1/3",
    "100",
    "64x48",
    "0,0,1,1",
    "1:1",
    "angle=30",
    "red",
    "#12345678",
    "none",
    "a.svg",
    "a.png",
    "a.pdf",
    "a.csv",
    "a.dxf",
    "a.gif",
    "a.yaml",
    "-",
    "length",
    "step",
    "viridis",
    "chaos",
    "a4",
    "10mm",
    "",
];

fuzz_target!(|text: &str| {
    let words: Vec<&str> = text.lines().collect();
    let is_let_out = |word: &&str| {
        word.contains(['/', '\\', '\0', '~']) || word.starts_with('.') || word.contains("=.")
    };
    let waits = ["--watch", "--open", "studio", "--library"];
    let waits = |word: &&str| {
        waits
            .iter()
            .any(|it| it.starts_with(*word) || word.starts_with(it))
    };
    let is_short = words.len() <= 24 && text.len() <= 400;
    if !is_short || words.is_empty() || words.iter().any(is_let_out) || words[0].is_empty() {
        return;
    }
    if words.iter().filter(|word| word.len() > 2).any(waits) {
        return;
    }
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let output = run(&words, &folder);
    let said = String::from_utf8_lossy(&output.stderr);
    let left: Vec<String> = { fs::read_dir(&folder).expect("the folder is there") }
        .map(|entry| {
            entry
                .expect("the entry is read")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    let report = || format!("{words:?}: {:?}\n{said}\n{left:?}", output.status);
    assert!(!said.contains("panicked"), "{}", report());
    match output.status.code() {
        Some(0) => {}
        Some(status @ (1 | 2)) => {
            assert!(
                !said.is_empty(),
                "a failure without a message: {}",
                report()
            );
            assert!(said.len() < 1 << 16, "too much is said: {}", report());
            assert!(
                status == 1 || left.is_empty(),
                "a refused command line left files: {}",
                report()
            );
        }
        _ => panic!("ended by something else: {}", report()),
    }
    assert!(
        left.iter().all(|name| !name.starts_with('.')),
        "temporary files are left: {}",
        report()
    );
});

/// Runs the program with limits of time and memory.
fn run(words: &[&str], folder: &tempfile::TempDir) -> Output {
    let program = std::env::var_os("KFRAC").expect("KFRAC names the program");
    let mut command = Command::new("sh");
    command
        .args(["-c", "ulimit -t 20 -v 3000000; exec \"$0\" \"$@\""])
        .arg(program)
        .args(words);
    command
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .env("XDG_DATA_HOME", folder.path());
    command
        .stdin(Stdio::null())
        .output()
        .expect("the program starts")
}

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    let mut random = Random::new(seed);
    let text = match str::from_utf8(&data[..size]) {
        Ok(text) if random.below(8) > 0 => mutated(text, &mut random),
        _ => return fuzzer_mutate(data, size, max_size),
    };
    let size = text.len().min(max_size);
    data[..size].copy_from_slice(&text.as_bytes()[..size]);
    size
});

/// Returns a command line with up to three words inserted, exchanged or removed.
fn mutated(text: &str, random: &mut Random) -> String {
    let mut words: Vec<String> = text.lines().map(String::from).collect();
    if words.is_empty() || random.below(4) == 0 {
        let command = COMMANDS[random.below(COMMANDS.len())];
        words = vec![command.into(), VALUES[random.below(5)].into()];
    }
    for _ in 0..=random.below(3) {
        let at = 1 + random.below(words.len());
        let options = options(&words[0]);
        match random.below(6) {
            0 if at < words.len() => drop(words.remove(at)),
            1 if at < words.len() => words[at] = value(random),
            2 => words.insert(at, value(random)),
            _ if !options.is_empty() => {
                words.insert(at, options[random.below(options.len())].clone());
                words.insert(at + 1, value(random));
            }
            _ => {}
        }
    }
    words.join("\n")
}

fn value(random: &mut Random) -> String {
    random.one_of(&VALUES).unwrap_or_default().into()
}

/// Returns the options of a command, as its help lists them.
fn options(command: &str) -> &'static [String] {
    static OPTIONS: [OnceLock<Vec<String>>; COMMANDS.len()] =
        [const { OnceLock::new() }; COMMANDS.len()];
    let Some(number) = COMMANDS.iter().position(|it| *it == command) else {
        return &[];
    };
    OPTIONS[number].get_or_init(|| {
        let program = std::env::var_os("KFRAC").expect("KFRAC names the program");
        let help = Command::new(program)
            .args([command, "--help"])
            .output()
            .expect("the program starts");
        let help = String::from_utf8_lossy(&help.stdout).into_owned();
        let lines = help.lines().map(str::trim_start);
        let first = |line: &str| {
            line.split_whitespace()
                .find(|word| word.starts_with("--"))
                .map(String::from)
        };
        lines
            .filter(|line| line.starts_with('-'))
            .filter_map(|line| first(line))
            .collect()
    })
}
