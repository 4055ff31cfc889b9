//! `kfrac grow --tile`: wallpapers and friezes.

use std::fs;
use std::path::Path;

use kfrac::style::Named;
use kfrac::symmetry::TilingGroup;
use kfrac::{Fractal, Repetition};
use resvg::tiny_skia::Pixmap;

use crate::common::said;

fn drawn(folder: &Path, arguments: &[&str]) -> Pixmap {
    let arguments = [&["grow"], arguments, &["-o", "a.png"]].concat();
    let (status, message) = said(folder, &arguments);
    assert_eq!(status, Some(0), "{arguments:?}: {message}");
    Pixmap::load_png(folder.join("a.png")).unwrap()
}

/// Returns the number of pixels that differ by more than 40 shades, which antialiasing takes, from those at a distance along both axes, which wraps.
fn differing(picture: &Pixmap, by: [u32; 2]) -> usize {
    let [width, height] = [picture.width(), picture.height()];
    let mut wrong = 0;
    for y in 0..height {
        for x in 0..width {
            let a = picture.pixel(x, y).unwrap();
            let b = picture
                .pixel((x + by[0]) % width, (y + by[1]) % height)
                .unwrap();
            let off = [
                (a.red(), b.red()),
                (a.green(), b.green()),
                (a.blue(), b.blue()),
            ];
            wrong += usize::from(off.into_iter().any(|(a, b)| a.abs_diff(b) > 40));
        }
    }
    wrong
}

/// Two periods of each group are alike, by pixels: a picture of one period continues itself.
#[test]
fn periods_are_alike() {
    let folder = tempfile::tempdir().unwrap();
    let rule = "initiator: [[0, 0], [1, 0.3]]\ngenerator: [[0, 0], [1/3, 0.4], [1, 0]]\nsteps: 5\nstyle: {width: 3}\nview: {window: [0, 0, 1, 1], margin: 50}\n";
    fs::write(folder.path().join("motif.yaml"), rule).unwrap();
    for (name, _) in TilingGroup::NAMES {
        let one = drawn(folder.path(), &["motif.yaml", "--tile", name]);
        let [width, height] = [one.width(), one.height()];
        let is_frieze = name.starts_with("frieze");
        let (rows, size) = match is_frieze {
            true => (1, format!("{}x{height}", 2 * width)),
            false => (2, format!("{}x{}", 2 * width, 2 * height)),
        };
        // A frieze that is twice as long is not twice as high.
        let many = match is_frieze {
            true => drawn(
                folder.path(),
                &["motif.yaml", "--tile", name, "--size", &size],
            ),
            false => drawn(
                folder.path(),
                &[
                    "motif.yaml",
                    "--tile",
                    name,
                    "--size",
                    &size,
                    "--repeat",
                    "2",
                ],
            ),
        };
        assert_eq!(
            [many.width(), many.height()],
            [2 * width, rows * height],
            "{name}"
        );
        let ink = { one.pixels().iter() }
            .filter(|pixel| pixel.red() < 128)
            .count();
        assert!(ink > 500, "{name}: {ink} pixels are dark");
        assert_eq!(differing(&many, [width, 0]), 0, "{name}");
        if !is_frieze {
            let most = if name.starts_with("p3") || name.starts_with("p6") {
                20
            } else {
                0
            };
            let wrong = differing(&many, [0, height]);
            assert!(wrong <= most, "{name}: {wrong}");
        }
    }
}

/// Pictures, tables and random iteration show copies; the window and the size are free.
#[test]
fn all_outputs_have_copies() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for arguments in [
        &[
            "grow", "koch", "--tile", "p4m", "--size", "300x200", "-o", "a.svg",
        ][..],
        &[
            "grow", "koch", "--tile", "p6", "--cell", "0.7", "-o", "a.csv",
        ],
        &[
            "grow",
            "koch",
            "--tile",
            "pgg",
            "--svg",
            "instanced",
            "--steps",
            "4",
            "-o",
            "b.svg",
        ],
        &["grow", "koch", "--tile", "frieze-p2mg", "-o", "a.dxf"],
        &[
            "grow", "gasket", "--tile", "p6m", "--size", "200", "-o", "a.png",
        ],
        &[
            "grow",
            "barnsley-fern",
            "--tile",
            "cmm",
            "--method",
            "chaos",
            "--size",
            "200x100",
            "-o",
            "b.png",
        ],
        &[
            "grow",
            "random-tree",
            "--tile",
            "p31m",
            "--view",
            "0,0,9,9",
            "--size",
            "200x200",
            "-o",
            "c.png",
        ],
    ] {
        let (status, message) = said(path, arguments);
        assert_eq!(status, Some(0), "{arguments:?}: {message}");
    }
    let table = fs::read_to_string(path.join("a.csv")).unwrap();
    let (status, _) = said(path, &["grow", "koch", "-o", "one.csv"]);
    assert_eq!(status, Some(0));
    let once = fs::read_to_string(path.join("one.csv"))
        .unwrap()
        .lines()
        .count()
        - 1;
    let all = table.lines().count() - 1;
    assert!(all.is_multiple_of(once) && all > 6 * once, "{all} {once}");
}

#[test]
fn mistakes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (&["koch", "--tile", "p5"][..], "p4m"),
        (&["koch", "--cell", "2"], "--tile"),
        (&["koch", "--tile", "p1", "--cell", "0"], "factor"),
        (&["koch", "--tile", "p1", "--repeat", "0"], "1 to 100"),
        (
            &["koch", "--tile", "p1", "--zoom", "9", "--at", "0.(1)"],
            "--tile",
        ),
        (&["menger", "--tile", "p1"], "space"),
        (&["koch", "--tile", "p1", "--view", "0,0,1e9,1e9"], "copies"),
        (
            &["koch", "--tile", "p4", "--view", "0,0,1,1", "--repeat", "3"],
            "give only one of them",
        ),
        (
            &["koch", "--view", "0,0,1,1", "-o", "x.csv"],
            "a table holds all elements",
        ),
    ] {
        let arguments = [&["grow"], arguments].concat();
        let (status, said) = said(folder.path(), &arguments);
        assert_ne!(status, Some(0), "{arguments:?}");
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
}

/// Pictures of the façade are those of the command line; sets in space have no wallpapers.
#[test]
fn programs_repeat_sets_as_the_command_line_does() {
    let folder = tempfile::tempdir().unwrap();
    let group = TilingGroup::from_name("cmm").unwrap();
    let repeated = Repetition::from(group).cell(1.2).periods(2);
    for (options, steps) in [("dragon --steps 8", Some(8)), ("barnsley-fern", None)] {
        let mut arguments: Vec<&str> = options.split(' ').collect();
        arguments.extend(["--tile", "cmm", "--cell", "1.2", "--repeat", "2"]);
        let expected = drawn(folder.path(), &arguments);
        let mut fractal = Fractal::named(arguments[0]).unwrap().repeat(Some(repeated));
        if let Some(steps) = steps {
            fractal = fractal.steps(steps);
        }
        let png = fractal.png(1024).unwrap();
        assert_eq!(
            Pixmap::decode_png(&png).unwrap().data(),
            expected.data(),
            "{options}"
        );
        fractal.write(folder.path().join("b.svg")).unwrap();
        let text = fs::read_to_string(folder.path().join("b.svg")).unwrap();
        assert_eq!(text, fractal.svg().unwrap());
        let size = format!(
            "width=\"{}\" height=\"{}\"",
            expected.width(),
            expected.height()
        );
        assert!(text.contains(&size), "{options}: no {size}");
        // Numbers are those of the set itself.
        assert_eq!(
            fractal.bounds().unwrap(),
            fractal.clone().repeat(None).bounds().unwrap()
        );
    }
    let small = Repetition::from(group).cell(0.02).periods(100);
    let koch = Fractal::named("koch").unwrap();
    let error = koch
        .clone()
        .repeat(Some(small))
        .png(300)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("more than 20000 copies meet the window"),
        "{error}"
    );
    for cell in [f64::NAN, 0.0, 2000.0] {
        let error = koch.clone().repeat(Some(small.cell(cell))).png(300);
        let error = error.unwrap_err().to_string();
        assert_eq!(
            error,
            "the distance of copies has a factor from 0.01 to 1000"
        );
    }
    let sponge = Fractal::named("menger")
        .unwrap()
        .steps(1)
        .repeat(Some(repeated));
    let error = sponge.png(100).unwrap_err().to_string();
    assert!(
        error.contains("wallpapers and friezes lie in the plane"),
        "{error}"
    );
}
