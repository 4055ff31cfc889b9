//! Help, manual pages and completions.

use std::fs;
use std::path::Path;
use std::process::Command;

fn kfrac() -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("kfrac"));
    command.env_remove("KFRAC_LIBRARY");
    command
}

/// Returns the standard output of a command, which must succeed.
fn printed(arguments: &[&str]) -> String {
    let output = kfrac().args(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Returns the subcommands that the help lists, except those of clap.
fn commands() -> Vec<String> {
    let help = printed(&["--help"]);
    let list = help.split("Commands:\n").nth(1).unwrap();
    let list = list.lines().take_while(|line| !line.is_empty());
    let names = list.map(|line| line.split_whitespace().next().unwrap().to_owned());
    names.filter(|name| name != "help").collect()
}

/// Returns the examples of a help text: its lines that are commands.
fn examples(help: &str) -> Vec<&str> {
    let lines = help.lines().filter_map(|line| line.strip_prefix("  "));
    lines.filter(|line| line.starts_with("kfrac ")).collect()
}

/// Every example is a command that works, as far as it concerns kfrac.
#[test]
fn examples_work() {
    let folder = tempfile::tempdir().unwrap();
    let rules = folder.path().join("rules");
    fs::create_dir(&rules).unwrap();
    let rule = printed(&["cat", "koch"]);
    for path in [folder.path().join("mine.yaml"), rules.join("other.yaml")] {
        fs::write(path, &rule).unwrap();
    }
    let set = "{kind: dataset, categories: {systems: {rule: gasket}}, picture: {size: 32}}";
    fs::write(folder.path().join("set.yaml"), set).unwrap();
    let curve = "Koch { Angle 6 Axiom F F=F+F--F+F }";
    let maps = "Dust { .5 0 0 .5 0 0 1 .3 0 0 .3 1 0 1 }";
    let tiles = "@\n$dim=2\nA=2^-1*([1, 0]|[0, 1]|[0, 0])*A\n";
    let curves = "[{\"name\": \"Dragon\", \"gene\": \"G 1 0 0 0 0 1 1 0\"}]";
    let table = ".5 0 0 0 .5 0 1\n.5 0 .5 0 .5 .5 1\n";
    for (name, text) in [
        ("fractint.l", curve),
        ("other.ifs", maps),
        ("maple.txt", table),
        ("tiles.aifs", tiles),
        ("tower.es", "3 * { y 1 } box"),
        ("curves.json", curves),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    for picture in ["leaf.png", "gasket.png"] {
        let drawn = kfrac::Fractal::named("gasket").unwrap().png(24).unwrap();
        fs::write(folder.path().join(picture), drawn).unwrap();
    }
    let island = kfrac::Fractal::named("koch-snowflake").unwrap().png(150);
    fs::write(folder.path().join("island.png"), island.unwrap()).unwrap();
    let mut pages = vec![printed(&["--help"])];
    pages.extend(commands().iter().map(|name| printed(&[name, "--help"])));
    for page in &pages {
        let examples = examples(page);
        assert!(examples.len() > 1, "{page}");
        for example in examples {
            let own = example.split(['|', '>']).next().unwrap();
            let words = own.split_whitespace().skip(1);
            let words = words.map(|word| word.replace('*', "other").replace('\'', ""));
            // These go on until they are interrupted: tests/studio.rs runs them.
            if example.starts_with("kfrac studio") || example.contains(" --watch") {
                continue;
            }
            // As large as it takes to be drawn in bands, as many frames as it takes to zoom, a part of the library, and a
            // worse fit: the whole takes minutes without optimisation.
            let words = words.map(|word| match word.as_str() {
                "60000" => "4900".into(),
                "30000" => "1500".into(),
                "900" => "90".into(),
                _ => word,
            });
            if example.starts_with("kfrac fit leaf.png") {
                // Another example has drawn a large leaf.
                let small = folder.path().join("gasket.png");
                fs::copy(small, folder.path().join("leaf.png")).unwrap();
            }
            let sooner = match example {
                fit if fit.starts_with("kfrac fit ") && !fit.contains("--maps") => {
                    &["--effort", "200", "--maps", "3"][..]
                }
                "kfrac list --html gallery" => &["tree"],
                _ => &[],
            };
            let words = words.chain(sooner.iter().map(|word| (*word).to_owned()));
            let output = kfrac().args(words).current_dir(folder.path()).output();
            let output = output.unwrap();
            assert!(output.status.success(), "{example}: {output:?}");
        }
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    // The folder is created.
    let path = folder.path().join("new/man1");
    assert_eq!(printed(&["man", "--dir", path.to_str().unwrap()]), "");
    let sections = |page: &str| {
        let headings = page.lines().filter_map(|line| line.strip_prefix(".SH "));
        headings
            .map(|heading| heading.replace('"', ""))
            .collect::<Vec<_>>()
    };
    let main = printed(&["man"]);
    assert_eq!(
        sections(&main),
        [
            "NAME",
            "SYNOPSIS",
            "DESCRIPTION",
            "OPTIONS",
            "COMMANDS",
            "EXAMPLES",
            "EXIT STATUS",
            "ENVIRONMENT",
            "FILES"
        ]
    );
    assert_eq!(read(&path, "kfrac.1"), main);
    for command in commands() {
        let page = printed(&["man", &command]);
        assert_eq!(read(&path, &format!("kfrac-{command}.1")), page);
        let title = format!(".TH KFRAC-{} 1 ", command.to_uppercase());
        assert!(page.starts_with(&title), "{page}");
        assert!(page.contains(&format!("kfrac\\-{command} \\- ")), "{page}");
        let sections = sections(&page);
        for section in [
            "NAME",
            "SYNOPSIS",
            "DESCRIPTION",
            "OPTIONS",
            "EXAMPLES",
            "SEE ALSO",
        ] {
            assert!(
                sections.iter().any(|found| found == section),
                "{command}: {section}"
            );
        }
    }
    let count = fs::read_dir(&path).unwrap().count();
    assert_eq!(count, commands().len() + 1);
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
fn a_page_of_no_command_is_a_wrong_command_line() {
    let output = kfrac().args(["man", "grwo"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        said,
        "error: kfrac has no command 'grwo' (did you mean 'grow'?)\n"
    );
}

#[test]
fn shells_learn_commands_options_and_rules() {
    for (shell, rules) in [
        ("bash", "koch koch-cube koch-cube-inwards"),
        ("fish", "using_subcommand check\" -a \"archipelago "),
        ("zsh", "'rules:rule:(archipelago "),
        ("elvish", "--color-by"),
        ("powershell", "--color-by"),
    ] {
        let script = printed(&["completions", shell]);
        assert!(
            script.contains("color-by") && script.contains(rules),
            "{shell}"
        );
    }
    let zsh = printed(&["completions", "zsh"]);
    assert_eq!(zsh.matches(":_kfrac_rules' \\").count(), 12);
    assert_eq!(zsh.matches(":_kfrac_components' \\").count(), 3);
}

#[cfg(target_os = "linux")]
#[test]
fn bash_completes() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("kfrac.bash");
    fs::write(&script, printed(&["completions", "bash"])).unwrap();
    for (words, completed) in [
        ("kfrac gr", "grow"),
        ("kfrac grow pythagoras-3", "pythagoras-30 pythagoras-345"),
        ("kfrac grow koch --palette vi", "viridis"),
        ("kfrac grow koch --cap ''", "round butt square"),
        (
            "kfrac check hilbert-",
            "hilbert-in-space hilbert-lsystem hilbert-lsystem-in-space hilbert-cup",
        ),
        ("kfrac cat swaying-", "swaying-roof"),
        (
            "kfrac show generators/ko",
            "generators/koch generators/koch-quadratic",
        ),
        ("kfrac grow swaying-", ""),
        ("kfrac man compl", "completions"),
        ("kfrac grow no-such-rule", ""),
        ("kfrac grow pythagoras --set an", "angle="),
        ("kfrac grow --steps 3 complex-pair --set ''", "s="),
        ("kfrac grow koch --set an", ""),
    ] {
        let ask = format!(
            "source '{}'; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); \
             _kfrac kfrac \"${{COMP_WORDS[COMP_CWORD]}}\" \"${{COMP_WORDS[COMP_CWORD - 1]}}\"; \
             echo \"${{COMPREPLY[*]}}\"",
            script.display()
        );
        let output = Command::new("bash")
            .args(["--norc", "-c", &ask])
            .env("PATH", path_of_shell())
            .output()
            .unwrap();
        assert_eq!(
            String::from_utf8(output.stdout).unwrap().trim_end(),
            completed,
            "{words}"
        );
    }
}

/// Returns the shell's path with the program's folder at its front.
#[cfg(target_os = "linux")]
fn path_of_shell() -> std::ffi::OsString {
    let program = assert_cmd::cargo::cargo_bin("kfrac");
    let known = std::env::var_os("PATH").unwrap_or_default();
    let folders = program.parent().map(Path::to_path_buf).into_iter();
    std::env::join_paths(folders.chain(std::env::split_paths(&known))).unwrap()
}

#[test]
fn the_parameters_of_a_rule_are_listed_for_shells() {
    for (line, listed) in [
        (
            "kfrac grow --steps 3 pythagoras --set",
            "angle=\tfoot angle of the roof, degrees\n",
        ),
        ("kfrac grow koch --set", ""),
        ("kfrac grow no-such-rule --set", ""),
        ("kfrac grow --set", ""),
        ("kfrac grow -", ""),
        ("kfrac list pythagoras", ""),
        (
            "kfrac sheet complex-pair --set",
            "s=\twhat both maps multiply by",
        ),
        ("kfrac compare koch pythagoras --set", "angle="),
    ] {
        let words = ["completions", "--parameters", "--"].into_iter();
        let words: Vec<_> = words.chain(line.split(' ')).collect();
        let found = printed(&words);
        assert!(
            found.starts_with(listed) && found.is_empty() == listed.is_empty(),
            "{line}: {found}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn fish_and_zsh_complete_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let has = |shell: &str| Command::new(shell).arg("--version").output().is_ok();
    let run = |shell: &str, script: &str| {
        let output = Command::new(shell)
            .args(["-c", script])
            .current_dir(folder.path())
            .env("PATH", path_of_shell())
            .env("HOME", folder.path())
            .output()
            .unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    // A shell that is not installed is not tested.
    if has("fish") {
        let script =
            "kfrac completions fish | source; complete -C 'kfrac grow pythagoras --set an'";
        assert!(run("fish", script).starts_with("angle=\t"));
    }
    if has("zsh") {
        // Without a terminal, candidates are inspected where zsh collects them.
        let script = "autoload -U compinit && compinit -u -D; \
             eval \"$(kfrac completions zsh)\" 2>/dev/null; \
             compadd() { shift 3; print -l -- $@ }; \
             words=(grow pythagoras --set ''); _kfrac_parameters";
        assert_eq!(run("zsh", script), "angle=\n");
    }
}
