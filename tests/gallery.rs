//! The pictures of the gallery equal those that its commands make.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use assert_cmd::Command;

/// Tolerance of a pixel's value, of 255, for differences between processors.
const WORST: u8 = 2;

fn pixels(bytes: &[u8]) -> Vec<u8> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    pixels
}

#[test]
fn every_picture_is_what_its_command_makes() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/gallery");
    let script = fs::read_to_string(gallery.join("make.sh")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut made = BTreeSet::new();
    for line in script.lines() {
        let Some(arguments) = line.strip_prefix("kfrac ") else {
            continue;
        };
        let words: Vec<_> = arguments
            .split(' ')
            .map(|word| word.trim_matches('\''))
            .collect();
        let mut command = Command::cargo_bin("kfrac").unwrap();
        let command = command
            .current_dir(folder.path())
            .env_remove("KFRAC_LIBRARY");
        command.args(&words).arg("--quiet").assert().success();
        let file = *words.last().unwrap();
        let new = fs::read(folder.path().join(file)).unwrap();
        let old = fs::read(gallery.join(file)).unwrap();
        let help = "examples/gallery/make.sh makes the pictures anew";
        if file.ends_with(".png") {
            let (new, old) = (pixels(&new), pixels(&old));
            assert_eq!(new.len(), old.len(), "{file}: {help}");
            let worst = new
                .iter()
                .zip(&old)
                .map(|(new, old)| new.abs_diff(*old))
                .max();
            assert!(worst <= Some(WORST), "{file}: {help}");
        } else {
            assert!(new == old, "{file}: {help}");
        }
        made.insert(file.to_owned());
    }
    assert!(made.len() > 12);

    let files: BTreeSet<_> = fs::read_dir(&gallery)
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .filter(|file| file != "make.sh")
        .collect();
    assert_eq!(files, made);
    let readme = fs::read_to_string(gallery.join("../../README.md")).unwrap();
    for file in files {
        assert!(
            readme.contains(&format!("examples/gallery/{file}")),
            "{file} is not in the README"
        );
    }
}
