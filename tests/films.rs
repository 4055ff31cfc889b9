//! Films: every frame is a picture of `kfrac grow`, whatever the format and the number of threads.

use std::fs;
use std::path::Path;

use crate::common::said;
use assert_cmd::Command;

/// Runs the program in a folder, which must succeed.
fn succeeds(folder: &Path, arguments: &[&str]) {
    let (status, said) = said(folder, arguments);
    assert_eq!(status, Some(0), "{arguments:?}: {said}");
}

/// Returns the pixels of a PNG as red, green, blue and alpha.
fn pixels(path: &Path) -> Vec<u8> {
    tiny_skia::Pixmap::load_png(path).unwrap().take()
}

#[test]
fn frames_are_pictures_of_grow() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let cases: [(&[&str], &[&str], &[&str]); 4] = [
        (
            &["pythagoras", "--set", "angle=20..60"],
            &["pythagoras", "--set", "angle=40"],
            &["--size", "120x90", "--background", "white"],
        ),
        (
            &["random-tree", "--seed", "4..6", "--frames", "5"],
            &["random-tree", "--seed", "5"],
            &["--size", "100x130", "--background", "white"],
        ),
        (
            &["koch", "--steps", "2..4", "--ease", "linear"],
            &["koch", "--steps", "3"],
            &["--size", "200x60", "--background", "white"],
        ),
        (
            &["menger", "--from", "0..60,25"],
            &["menger", "--from", "30,25"],
            &["--size", "80x60", "--detail", "2"],
        ),
    ];
    for (film, picture, options) in cases {
        let film = [&["animate"], film, options, &["--fit", "each"]].concat();
        let mut film = [&film[..], &["-o", "frame-%02d.png"]].concat();
        if !film.contains(&"--frames") {
            film.extend(["--frames", "5"]);
        }
        succeeds(folder, &film);
        succeeds(
            folder,
            &[&["grow"], picture, options, &["-o", "one.png"]].concat(),
        );
        let frame = pixels(&folder.join("frame-02.png"));
        assert!(frame == pixels(&folder.join("one.png")), "{film:?}");
        let other = pixels(&folder.join("frame-00.png"));
        assert!(frame != other, "{film:?}");
        (0..5).for_each(|it| fs::remove_file(folder.join(format!("frame-{it:02}.png"))).unwrap());
    }
}

#[test]
fn all_formats_hold_all_frames_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let film = |file: &str, threads: &str| {
        let rule = [
            "animate",
            "pythagoras",
            "--set",
            "angle=20..70",
            "--steps",
            "6",
        ];
        let size = [
            "--frames",
            "7",
            "--size",
            "96x64",
            "--threads",
            threads,
            "-o",
            file,
        ];
        succeeds(folder, &[&rule[..], &size].concat());
    };
    let read = |file: &str, threads: &str| {
        film(file, threads);
        fs::read(folder.join(file)).unwrap()
    };
    for file in ["film.gif", "film.png", "film.y4m"] {
        assert!(read(file, "1") == read(file, "2"), "{file}");
    }
    film("frame%d.png", "2");
    let frames: Vec<Vec<u8>> = (0..7)
        .map(|it| pixels(&folder.join(format!("frame{it}.png"))))
        .collect();
    // GIF, read by its own reader: parts of frames on a screen.
    let gif = fs::read(folder.join("film.gif")).unwrap();
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut reader = options.read_info(&gif[..]).unwrap();
    let mut screen = vec![0; 4 * 96 * 64];
    for frame in &frames {
        let part = reader.read_next_frame().unwrap().unwrap();
        let across = 4 * usize::from(part.width);
        for (row, pixels) in part.buffer.chunks_exact(across).enumerate() {
            let at = 4 * (96 * (row + usize::from(part.top)) + usize::from(part.left));
            screen[at..at + across].copy_from_slice(pixels);
        }
        // Colours by step are many; those of the palette are near.
        let apart = screen
            .iter()
            .zip(frame)
            .map(|(a, b)| u32::from(a.abs_diff(*b)))
            .sum::<u32>();
        assert!(f64::from(apart) / (4.0 * 96.0 * 64.0) < 2.0, "{apart}");
    }
    assert!(reader.read_next_frame().unwrap().is_none());
    // Animated PNG: exact.
    let file = std::io::BufReader::new(fs::File::open(folder.join("film.png")).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    assert_eq!(reader.info().animation_control().unwrap().num_frames, 7);
    let mut screen = vec![0; 3 * 96 * 64];
    let mut part = vec![0; screen.len()];
    for frame in &frames {
        let read = reader.next_frame(&mut part).unwrap();
        let control = *reader.info().frame_control().unwrap();
        let across = 3 * read.width as usize;
        for (row, pixels) in part
            .chunks_exact(across)
            .take(read.height as usize)
            .enumerate()
        {
            let at = 3 * (96 * (row + control.y_offset as usize) + control.x_offset as usize);
            screen[at..at + across].copy_from_slice(pixels);
        }
        let opaque = frame.chunks_exact(4).flat_map(|it| &it[..3]);
        assert!(screen.iter().eq(opaque));
    }
    let y4m = fs::read(folder.join("film.y4m")).unwrap();
    let header = y4m.iter().position(|it| *it == b'\n').unwrap() + 1;
    assert!(y4m.starts_with(b"YUV4MPEG2 W96 H64 F30:1 Ip A1:1 C444"));
    assert_eq!(y4m.len() - header, 7 * (6 + 3 * 96 * 64));
}

/// The last frame of a zoom without end is followed by the first one: a period deeper, and turned, the picture is equal.
#[test]
fn endless_zooms_close() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let cases = [
        ("koch", "0.(1)", "81", "243", "-60"),
        ("koch", "0.(0)", "81", "243", "0"),
        ("dragon", "0.(0)", "32", "45.25483399593904", "-45"),
    ];
    for (rule, at, first, next, turn) in cases {
        let size = ["--size", "160x120", "--detail", "0.5"];
        let film = [
            "animate",
            rule,
            "--zoom",
            "loop",
            "--at",
            at,
            "--frames",
            "2",
            "-o",
            "zoom%d.png",
        ];
        succeeds(folder, &[&film[..], &size].concat());
        let white = ["--background", "white", "-o", "one.png"];
        let frame = pixels(&folder.join("zoom0.png"));
        for (zoom, turn, most) in [(first, "0", 0.0), (next, turn, 0.6)] {
            let turn = format!("--turn={turn}");
            let picture = ["grow", rule, "--zoom", zoom, "--at", at, &turn];
            succeeds(folder, &[&picture[..], &size, &white].concat());
            let own = pixels(&folder.join("one.png"));
            let apart = frame
                .iter()
                .zip(&own)
                .map(|(a, b)| f64::from(a.abs_diff(*b)))
                .sum::<f64>();
            let apart = apart / frame.len() as f64;
            assert!(apart <= most, "{rule} at {at}, {zoom}: {apart}");
        }
        let other = pixels(&folder.join("zoom1.png"));
        let apart = frame
            .iter()
            .zip(&other)
            .map(|(a, b)| f64::from(a.abs_diff(*b)))
            .sum::<f64>();
        assert!(
            apart / frame.len() as f64 > 1.0,
            "{rule} at {at} moves by {apart}"
        );
        for file in ["zoom0.png", "zoom1.png"] {
            fs::remove_file(folder.join(file)).unwrap();
        }
    }
}

/// Growth begins at the step before and ends at the step itself.
#[test]
fn steps_grow_out_of_the_ones_before() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let list = |rule: &str, more: &[&str]| {
        succeeds(folder, &[&["grow", rule, "-o", "list.csv"], more].concat());
        fs::read_to_string(folder.join("list.csv")).unwrap()
    };
    for rule in ["koch", "random-tree", "archipelago", "dahlia"] {
        let whole = list(rule, &["--steps", "3"]);
        let numbers = |text: &str| -> Vec<f64> {
            let rows = text.lines().skip(1).flat_map(|row| row.split(','));
            rows.filter_map(|it| it.parse().ok()).collect()
        };
        let grown = list(rule, &["--steps", "3", "--between", "1"]);
        let pairs = numbers(&whole).into_iter().zip(numbers(&grown));
        assert!(pairs.clone().count() > 10 && whole.lines().count() == grown.lines().count());
        assert!(
            pairs
                .clone()
                .all(|(a, b)| (a - b).abs() <= 1e-12 * a.abs().max(1.0)),
            "{rule}"
        );
        assert!(
            list(rule, &["--steps", "3", "--between", "0.5"]) != whole,
            "{rule}"
        );
    }
    // At the start, the Koch curve lies on the one before. Its strokes are shorter, and round off at their joins.
    let picture = |more: &[&str]| {
        let options = [
            "--size",
            "300x100",
            "--background",
            "white",
            "-o",
            "one.png",
        ];
        succeeds(folder, &[&["grow", "koch"], more, &options].concat());
        pixels(&folder.join("one.png"))
    };
    let before = picture(&["--steps", "3"]);
    let start = picture(&["--steps", "4", "--between", "0"]);
    let apart = before.iter().zip(&start).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(apart.unwrap() <= 8, "{apart:?}");
    // Surfaces of space would tear.
    let arguments = [
        "grow",
        "koch-surface",
        "--steps",
        "3",
        "--between",
        "0.5",
        "-o",
        "space.png",
    ];
    let (status, said) = said(folder, &arguments);
    assert!(
        status == Some(2) && said.contains("rules of the plane"),
        "{said}"
    );
}

#[test]
fn finished_frames_are_kept_while_they_are_right() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let rule = "params: {angle: {value: 30, min: 5, max: 80}}
initiator: segment
generator: [[0, 0], [1/3, 0], [1/2, tan(angle)/6], [2/3, 0], [1, 0]]
steps: 3
";
    fs::write(folder.join("mine.yaml"), rule).unwrap();
    let film = [
        "animate",
        "mine.yaml",
        "--set",
        "angle=10..60",
        "--frames",
        "4",
        "--size",
        "60x40",
    ];
    let film = [&film[..], &["-o", "f%d.png"]].concat();
    let kept = || {
        let (status, said) = said(folder, &film);
        assert_eq!(status, Some(0), "{said}");
        said.contains("of them kept")
            .then(|| said.split(", ").nth(1).unwrap().to_owned())
    };
    assert_eq!(kept(), None);
    let first = fs::read(folder.join("f2.png")).unwrap();
    fs::remove_file(folder.join("f2.png")).unwrap();
    assert_eq!(kept().as_deref(), Some("3 of them kept"));
    assert_eq!(fs::read(folder.join("f2.png")).unwrap(), first);
    fs::write(folder.join("f1.png"), &first[..first.len() - 20]).unwrap();
    fs::write(folder.join("f3.png"), &first).unwrap();
    assert_eq!(kept().as_deref(), Some("2 of them kept"));
    fs::write(folder.join("mine.yaml"), rule.replace("1/3", "0.3")).unwrap();
    assert_eq!(kept(), None);
}

#[test]
fn impossible_films_are_refused_and_leave_nothing() {
    let cases: [(&[&str], i32, &str); 14] = [
        (&["pythagoras"], 2, "nothing changes in the film"),
        (
            &["pythagoras", "--set", "angle=20..70", "--size", "100mm"],
            2,
            "pixels",
        ),
        (
            &["pythagoras", "--set", "angle=20..70", "--size", "90000"],
            2,
            "larger than",
        ),
        (&["pythagoras", "--set", "angle=20..700"], 2, "angle"),
        (&["pythagoras", "--set", "angel=20..70"], 2, "angle"),
        (
            &["pythagoras", "--set", "angle=20..70", "--fps", "60"],
            1,
            "50 frames a second",
        ),
        (
            &["pythagoras", "--set", "angle=20..70", "--only", "3"],
            2,
            "film-%04d.png",
        ),
        (&["koch", "--zoom", "loop"], 2, "--at with a period"),
        (
            &["koch", "--zoom", "loop", "--at", "0.5,0"],
            2,
            "a point has none",
        ),
        (
            &["random-tree", "--zoom", "loop", "--at", "0.(1)"],
            2,
            "without random draws",
        ),
        (&["menger", "--turn", "0..90"], 2, "--from turns it"),
        (&["koch", "--from", "0..90,20"], 2, "--turn turns it"),
        (&["koch", "--steps", "0..90"], 1, "elements"),
        (
            &[
                "koch", "--zoom", "1..1e9", "--at", "0.(1)", "--steps", "1..3",
            ],
            2,
            "whole steps",
        ),
    ];
    for (arguments, status, message) in cases {
        let folder = tempfile::tempdir().unwrap();
        let all = [&["animate"], arguments, &["-o", "film.gif"]].concat();
        let (found, said) = said(folder.path(), &all);
        assert_eq!(found, Some(status), "{arguments:?}: {said}");
        assert!(said.contains(message), "{arguments:?}: {said}");
        assert_eq!(
            fs::read_dir(folder.path()).unwrap().count(),
            0,
            "{arguments:?}"
        );
    }
    let folder = tempfile::tempdir().unwrap();
    let (status, said) = said(
        folder.path(),
        &["animate", "koch", "--turn", "0..90", "-o", "film-%x.png"],
    );
    assert!(status == Some(2) && said.contains("%04d"), "{said}");
}

/// A film by ffmpeg, or the reason why there is none.
#[test]
fn videos_need_their_program() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::cargo_bin("kfrac").unwrap();
    let without = command
        .current_dir(folder.path())
        .env("PATH", folder.path())
        .args([
            "animate", "koch", "--turn", "0..90", "--frames", "3", "-o", "film.mp4",
        ])
        .output()
        .unwrap();
    let said = String::from_utf8(without.stderr).unwrap();
    assert_eq!(without.status.code(), Some(1));
    assert!(
        said.contains("ffmpeg is not installed") && said.contains("-o - |"),
        "{said}"
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
