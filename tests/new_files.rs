//! `kfrac new` writes files that check, grow and lose nothing.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

fn kfrac(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("kfrac").unwrap();
    command.current_dir(folder).args(arguments).assert()
}

#[test]
fn every_template_checks_and_grows() {
    let folder = tempfile::tempdir().unwrap();
    let kinds = ["rule", "ifs", "instancing", "lsystem"];
    for (kind, space) in { kinds.into_iter() }.flat_map(|kind| [(kind, "2"), (kind, "3")]) {
        let file = format!("my-{kind}_{space}.yaml");
        let new = ["new", file.as_str(), "--kind", kind, "--space", space];
        kfrac(folder.path(), &new).success();
        let text = fs::read_to_string(folder.path().join(&file)).unwrap();
        assert!(
            text.contains(&format!("title: \"My {kind} {space}\"")),
            "{text}"
        );
        let check = kfrac(folder.path(), &["check", &file]).success();
        assert_eq!(check.get_output().stderr, b"", "{file}");
        let grow = [
            "grow",
            file.as_str(),
            "--steps",
            "3",
            "--size",
            "80",
            "-o",
            "x.png",
        ];
        kfrac(folder.path(), &grow).success();
        // A second call keeps the file.
        fs::write(folder.path().join(&file), "mine").unwrap();
        kfrac(folder.path(), &new).failure().code(2);
        assert_eq!(
            fs::read_to_string(folder.path().join(&file)).unwrap(),
            "mine"
        );
    }
}
