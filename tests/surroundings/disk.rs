//! Full disks, and files that must not be replaced.

use std::fs;
use std::process::Command;

use super::{RULE, ended, files, kfrac, run};

const FORMATS: [&str; 6] = ["svg", "png", "pdf", "dxf", "csv", "json"];

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_in_all_formats() {
    let folder = tempfile::tempdir().unwrap();
    for format in FORMATS {
        let arguments = ["grow", "koch", "--format", format, "-o", "/dev/full"];
        let (status, said) = run(folder.path(), &arguments);
        let message = "error: '/dev/full' cannot be written: No space left on device";
        assert_eq!(status, Some(1), "{format}");
        assert!(said.starts_with(message), "{format}: {said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_the_size_of_files_is_an_error_in_all_formats() {
    let folder = tempfile::tempdir().unwrap();
    let program = assert_cmd::cargo::cargo_bin("kfrac");
    for format in FORMATS {
        let script = format!(
            "ulimit -f 2; exec '{}' grow koch --steps 6 --format {format} -o k.{format}",
            program.display()
        );
        let output = Command::new("sh")
            .args(["-c", &script])
            .current_dir(folder.path())
            .output();
        let (status, said) = ended(&output.unwrap());
        let message = format!("error: 'k.{format}' cannot be written: File too large");
        assert_eq!(status, Some(1), "{format}: {said}");
        assert!(said.starts_with(&message), "{format}: {said}");
        assert!(files(folder.path()).is_empty(), "{format}");
    }
}

#[test]
fn what_is_read_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("k.yaml"), RULE).unwrap();
    fs::write(path.join("bent.yaml"), "extends: k.yaml\nsteps: 2\n").unwrap();
    std::os::unix::fs::symlink("k.yaml", path.join("link")).unwrap();
    fs::create_dir(path.join("own")).unwrap();
    let part = "- [0, 0]\n- [1/2, 1/3]\n- [1, 0]\n";
    fs::create_dir(path.join("own/generators")).unwrap();
    fs::write(path.join("own/generators/mine.yaml"), part).unwrap();
    let mixed = "initiator: segment\ngenerator: mine\n";
    fs::write(path.join("mixed.yaml"), mixed).unwrap();
    fs::write(path.join("p.csv"), "0,0\n1,1\n2,3\n4,1\n5,5\n").unwrap();
    let before = files(path);
    for (arguments, output) in [
        (&["grow", "k.yaml", "--format", "svg"][..], "k.yaml"),
        (&["grow", "k.yaml", "--format", "svg"], "./own/../k.yaml"),
        (&["grow", "k.yaml", "--format", "svg"], "link"),
        (&["grow", "link", "--format", "csv"], "k.yaml"),
        (&["grow", "bent.yaml", "--format", "png"], "k.yaml"),
        (&["sheet", "k.yaml", "--format", "svg"], "k.yaml"),
        (&["convert", "k.yaml", "--to", "ifs"], "k.yaml"),
        (&["compare", "koch", "k.yaml", "--format", "svg"], "k.yaml"),
        (
            &["grow", "mixed.yaml", "--library", "own", "--format", "svg"],
            "own/generators/mine.yaml",
        ),
    ] {
        let arguments = [arguments, &["-o", output]].concat();
        let (status, said) = run(path, &arguments);
        assert_eq!(status, Some(1), "{arguments:?}: {said}");
        let target = if output == "link" { "k.yaml" } else { output };
        assert_eq!(
            said,
            format!(
                "error: '{target}' is an input file and would be overwritten by the output: \
                 write to another file\n"
            ),
            "{arguments:?}"
        );
    }
    // The source of standard input is known where the system has names for it.
    #[cfg(target_os = "linux")]
    {
        let output = kfrac(path)
            .args(["grow", "-", "--format", "svg", "-o", "k.yaml"])
            .stdin(fs::File::open(path.join("k.yaml")).unwrap())
            .output();
        assert_eq!(ended(&output.unwrap()).0, Some(1));
    }
    assert_eq!(fs::read_to_string(path.join("k.yaml")).unwrap(), RULE);
    assert_eq!(files(path), before);
    // A different name is not affected.
    assert_eq!(
        run(path, &["grow", "k.yaml", "-q", "-o", "k.svg"]).0,
        Some(0)
    );
}

#[test]
fn a_circle_of_links_is_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::os::unix::fs::symlink("loop.svg", path.join("loop.svg")).unwrap();
    let said = run(path, &["grow", "koch", "-o", "loop.svg"]);
    let message = "error: 'loop.svg' is a symbolic link that leads back to itself\n";
    assert_eq!(said, (Some(1), message.into()));
    assert!(path.join("loop.svg").is_symlink());
    let (status, said) = run(path, &["grow", "./loop.svg"]);
    assert_eq!(status, Some(1));
    assert!(
        said.starts_with("error: './loop.svg' cannot be read: "),
        "{said}"
    );
    assert_eq!(files(path), ["loop.svg"]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_may_have_no_end_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["grow", "/dev/zero"][..],
        &["info", "/dev/null"],
        &["check", "/dev/zero"],
        &["dim", "/dev/zero"],
        &["cat", "/dev/urandom"],
        &["compare", "koch", "/dev/zero"],
        &["convert", "/dev/zero", "--to", "ifs"],
    ] {
        let (status, said) = run(folder.path(), arguments);
        assert_eq!(status, Some(1), "{arguments:?}: {said}");
        assert!(
            said.contains("' is neither a file nor a pipe"),
            "{arguments:?}: {said}"
        );
    }
    // The kind of standard input does not matter, and a length beyond the limit is noticed early.
    for command in ["grow", "dim", "check"] {
        let zero = fs::File::open("/dev/zero").unwrap();
        let output = kfrac(folder.path())
            .args([command, "-"])
            .stdin(zero)
            .output();
        let (status, said) = ended(&output.unwrap());
        assert_eq!(status, Some(1), "{command}: {said}");
        assert!(said.contains("is larger than 4 MiB"), "{command}: {said}");
    }
    let endless = "yes | tr '\\n' , | '{}' dim -";
    let endless = endless.replace(
        "{}",
        &assert_cmd::cargo::cargo_bin("kfrac").display().to_string(),
    );
    let output = Command::new("sh").args(["-c", &endless]).output().unwrap();
    let (status, said) = ended(&output);
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("a row is not to have more than"), "{said}");
}
