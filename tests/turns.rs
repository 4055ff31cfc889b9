//! `--turn` turns what is grown, and `--zoom` magnifies sets in space.

use std::fs;
use std::path::Path;

use crate::common::said;
use resvg::tiny_skia::Pixmap;

/// Returns the file that a command writes.
fn written(folder: &Path, arguments: &[&str], name: &str) -> Vec<u8> {
    let arguments = [arguments, &["-o", name]].concat();
    let (status, message) = said(folder, &arguments);
    assert_eq!(status, Some(0), "{arguments:?}: {message}");
    fs::read(folder.join(name)).unwrap()
}

/// Returns the ends of the elements that a command lists.
fn ends(folder: &Path, arguments: &[&str]) -> Vec<[f64; 4]> {
    let text = String::from_utf8(written(folder, arguments, "a.csv")).unwrap();
    let mut lines = text.lines();
    let head: Vec<_> = lines.next().unwrap().split(',').collect();
    let at = ["x0", "y0", "x1", "y1"].map(|name| head.iter().position(|it| *it == name).unwrap());
    let row = |line: &str| {
        let row: Vec<_> = line.split(',').collect();
        at.map(|at| row[at].parse().unwrap())
    };
    lines.map(row).collect()
}

#[test]
fn every_element_turns_about_the_origin() {
    let folder = tempfile::tempdir().unwrap();
    let far = "initiator: [[1e7, 3e7], [1e7 + 2, 3e7]]\ngenerator: [[0, 0], [1/2, 1/3], [1, 0]]\n";
    fs::write(folder.path().join("far.yaml"), far).unwrap();
    for rule in [
        "koch",
        "far.yaml",
        "meadow",
        "barnsley-fern",
        "gasket",
        "hilbert-lsystem",
    ] {
        let plain = ends(folder.path(), &["grow", rule, "--steps", "3"]);
        let turned = ends(
            folder.path(),
            &["grow", rule, "--steps", "3", "--turn", "-30"],
        );
        assert!(!plain.is_empty() && plain.len() == turned.len(), "{rule}");
        let (sine, cosine) = (-0.5, 0.75_f64.sqrt());
        for (a, b) in plain.iter().zip(&turned) {
            let far = a.iter().fold(1.0_f64, |far, at| far.max(at.abs()));
            for (x, y) in [(0, 1), (2, 3)] {
                let image = [cosine * a[x] - sine * a[y], sine * a[x] + cosine * a[y]];
                let off = (image[0] - b[x]).abs().max((image[1] - b[y]).abs());
                assert!(off < 1e-14 * far, "{rule}: {a:?} {b:?}");
            }
        }
    }
}

/// Returns the share of pixels that differ by more than antialiasing does.
fn differing(a: &Pixmap, b: impl Fn(usize, usize) -> [u8; 4]) -> f64 {
    let (width, height) = (a.width() as usize, a.height() as usize);
    let bytes = |x: usize, y: usize| -> [u8; 4] {
        let at = 4 * (y * width + x);
        a.data()[at..at + 4].try_into().unwrap()
    };
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let differs = |(x, y): &(usize, usize)| {
        let pairs = bytes(*x, *y).into_iter().zip(b(*x, *y));
        pairs.into_iter().any(|(a, b)| a.abs_diff(b) > 24)
    };
    all.filter(differs).count() as f64 / (width * height) as f64
}

fn pixel(image: &Pixmap, x: usize, y: usize) -> [u8; 4] {
    let at = 4 * (y * image.width() as usize + x);
    image.data()[at..at + 4].try_into().unwrap()
}

#[test]
fn a_quarter_turn_turns_the_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let shown: [(&str, &[&str]); 4] = [
        ("--view=0,-0.3,1,1", &["--steps=4"]),
        ("--zoom=1000", &["--at=0.1.(2)"]),
        ("--zoom=1e400", &["--at=0.1.(2)"]),
        ("--detail=1", &["--steps=40"]),
    ];
    for (part, more) in shown {
        let of = |own: &[&str], name: &str| {
            let all = [
                &["grow", "koch", "--background=white", "--size=200x200"],
                more,
                own,
            ];
            Pixmap::decode_png(&written(folder.path(), &all.concat(), name)).unwrap()
        };
        let plain = of(&[part], "a.png");
        // A window is one of the set that is turned.
        let part = match part.starts_with("--view") {
            true => "--view=-0.7,0,1,1",
            false => part,
        };
        let turned = of(&[part, "--turn=90"], "b.png");
        // Counter-clockwise: the upper row is the left column.
        let share = differing(&turned, |x, y| pixel(&plain, 199 - y, x));
        assert!(share < 0.002, "{part}: {share}");
        let ink = differing(&plain, |_, _| [255; 4]);
        assert!(ink > 0.02, "{part}: {ink}");
    }
}

#[test]
fn a_zoom_in_space_is_a_detail_of_a_larger_picture() {
    let folder = tempfile::tempdir().unwrap();
    for more in [&[][..], &["--perspective=50"]] {
        let of = |rest: &[&str], name: &str| {
            let arguments = [
                &["grow", "menger", "--steps=3", "--from=20,30", "--margin=0"],
                more,
                rest,
            ];
            Pixmap::decode_png(&written(folder.path(), &arguments.concat(), name)).unwrap()
        };
        let large = of(&["--size=480x480", "--zoom=1"], "a.png");
        let part = of(&["--size=120x120", "--zoom=4"], "b.png");
        let share = differing(&part, |x, y| pixel(&large, x + 180, y + 180));
        assert!(share < 0.01, "{more:?}: {share}");
    }
    // Another point in the middle moves the picture, and leaves its scale.
    let of = |at: &str| {
        let arguments = [
            "grow",
            "menger",
            "--steps=3",
            "--from=0,0",
            "--margin=0",
            "--size=120x120",
            "--zoom=4",
            at,
        ];
        Pixmap::decode_png(&written(folder.path(), &arguments, "a.png")).unwrap()
    };
    let [middle, right] = ["--look-at=0.5,0.5,0.5", "--look-at=0.625,0.5,0.5"].map(of);
    let share = differing(&right, |x, y| match x < 60 {
        true => pixel(&middle, x + 60, y),
        false => pixel(&right, x, y),
    });
    assert!(share < 0.001, "{share}");
    assert!(differing(&right, |x, y| pixel(&middle, x, y)) > 0.1);
    for arguments in [
        &["grow", "menger", "--zoom=1e6", "-o", "a.png"][..],
        &["grow", "menger", "--zoom=2", "--at=0.(1)", "-o", "a.png"],
        &["grow", "menger", "--zoom=2", "-o", "a.svg"],
        &["grow", "menger", "--turn=20", "-o", "a.png"],
        &["grow", "koch", "--zoom=2", "-o", "a.png"],
        &["grow", "koch", "--turn=round", "-o", "a.png"],
        &[
            "grow",
            "barnsley-fern",
            "--method=chaos",
            "--turn=20",
            "-o",
            "a.png",
        ],
    ] {
        let (status, message) = said(folder.path(), arguments);
        assert!(
            status != Some(0) && message.starts_with("error: "),
            "{arguments:?}: {message}"
        );
    }
}
