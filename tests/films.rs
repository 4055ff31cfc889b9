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
        ("koch", "0.(1)", "81", "243", "-60", "none"),
        ("koch", "0.(0)", "81", "243", "0", "none"),
        ("dragon", "0.(0)", "32", "45.25483399593904", "-45", "none"),
        (
            "pythagoras",
            "0.(2)",
            "32",
            "45.25483399593904",
            "45",
            "step",
        ),
    ];
    for (rule, at, first, next, turn, color_by) in cases {
        let colours = format!("--color-by={color_by}");
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
        succeeds(folder, &[&film[..], &size, &[colours.as_str()]].concat());
        let white = ["--background", "white", "-o", "one.png"];
        let frame = pixels(&folder.join("zoom0.png"));
        for (zoom, turn, most) in [(first, "0", 0.0), (next, turn, 0.6)] {
            let turn = format!("--turn={turn}");
            // A step of Pythagoras' tree is one of the square root of 2, and the palette begins with its last step that
            // is as large as the picture, of 160 pixels to a detail of half a one.
            let steps = |factor: f64| 2.0 * factor.log2();
            let step = steps(zoom.parse().unwrap());
            let range = format!("--color-range={step}..{}", step + steps(320.0));
            let picture = ["grow", rule, "--zoom", zoom, "--at", at, &turn, &range];
            succeeds(
                folder,
                &[&picture[..], &size, &white, &[colours.as_str()]].concat(),
            );
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
    let rules = [
        "koch",
        "random-tree",
        "archipelago",
        "dahlia",
        "carpet",
        "pythagoras-squares",
        "mountain",
        "koch-surface",
        "menger-cubes",
        "sphere-flake",
        "random-tree-with-leaves",
        "fern",
        "koch-ifs",
        "menger",
        "meadow",
        "hart-tree",
        "koch-lsystem",
        "plant-a",
        "cordate-leaf",
        "bush-in-space",
    ];
    for rule in rules {
        let whole = list(rule, &["--steps", "3"]);
        // Tables between steps of rules in space list maps too.
        let columns = whole.lines().next().unwrap().split(',').count();
        let numbers = |text: &str| -> Vec<f64> {
            let rows = { text.lines().skip(1) }.flat_map(|row| row.split(',').take(columns));
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
        let options = ["--size", "300x100", "--margin", "0", "-o", "one.png"];
        succeeds(folder, &[&["grow", "koch"], more, &options].concat());
        pixels(&folder.join("one.png"))
    };
    let before = picture(&["--steps", "3"]);
    let start = picture(&["--steps", "4", "--between", "0"]);
    let apart = before.iter().zip(&start).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(apart.unwrap() <= 8, "{apart:?}");
}

/// Between steps that fall, elements pass back into those that they replaced; steps that are left out are passed through.
#[test]
fn lists_of_steps_are_passed_through_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (list, moments) in [
        ("2,1,0", [2.0, 1.5, 1.0, 0.5, 0.0]),
        ("0,2", [0.0, 0.5, 1.0, 1.5, 2.0]),
        ("1,2,1", [1.0, 1.5, 2.0, 1.5, 1.0]),
    ] {
        let common = ["--size", "80", "--view", "0,-0.2,1,0.8"];
        let film = ["animate", "koch", "--steps", list, "--frames", "5"];
        let more = ["--ease", "linear", "-o", "list-%d.png"];
        succeeds(folder, &[&film[..], &common, &more].concat());
        for (frame, moment) in moments.iter().enumerate() {
            let (step, share) = (f64::ceil(*moment), moment.fract());
            let steps = step.to_string();
            let between = share.to_string();
            let mut one = vec!["grow", "koch", "--steps", &steps, "-o", "one.png"];
            if share > 0.0 {
                one.extend(["--between", &between]);
            }
            succeeds(folder, &[&one[..], &common].concat());
            let frame = folder.join(format!("list-{frame}.png"));
            assert!(
                pixels(&frame) == pixels(&folder.join("one.png")),
                "{list}: {moment}"
            );
        }
        fs::read_dir(folder)
            .unwrap()
            .for_each(|it| fs::remove_file(it.unwrap().path()).unwrap());
    }
}

/// A film does not jump at a whole step: just behind it, the picture is about that of the step.
#[test]
fn whole_steps_pass_into_growth() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // The largest mean difference of a pixel, of 255: strokes round off where elements are divided. Sets in space with one
    // box at all steps are not fitted together: that takes the box of every frame.
    let rules = [
        ("koch", "step", "all", 0.2),
        ("carpet", "step", "all", 0.2),
        ("pentaflake", "step", "all", 0.2),
        ("pythagoras-squares", "step", "all", 1.0),
        ("koch-surface", "step", "each", 0.2),
        ("sphere-flake", "step", "each", 0.2),
        ("sierpinski-tetrahedron", "step", "each", 0.2),
        ("koch-lsystem", "step", "all", 0.2),
        ("plant-a", "step", "all", 0.5),
        ("bush-in-space", "none", "all", 1.0),
    ];
    for (rule, color_by, fit, most) in rules {
        let film = [
            "animate",
            rule,
            "--steps",
            "1..2",
            "--ease",
            "linear",
            "--frames",
            "1001",
            "--only",
            "0..1",
            "--size",
            "96x72",
            "--fit",
            fit,
            "--color-by",
            color_by,
            "-o",
            "%d.png",
        ];
        succeeds(folder, &film);
        let [whole, next] = ["0.png", "1.png"].map(|name| pixels(&folder.join(name)));
        let apart = whole
            .iter()
            .zip(&next)
            .map(|(a, b)| u32::from(a.abs_diff(*b)));
        let apart = f64::from(apart.sum::<u32>()) / whole.len() as f64;
        assert!(apart <= most, "{rule}: {apart}");
        for name in ["0.png", "1.png"] {
            fs::remove_file(folder.join(name)).unwrap();
        }
    }
}

/// Frames in which nothing is visible are empty, where others are not.
#[test]
fn films_begin_with_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for rule in ["hilbert-lsystem", "hilbert-lsystem-in-space"] {
        let film = [
            "animate", rule, "--steps", "0..1", "--frames", "3", "--size", "40x30", "-o", "%d.png",
        ];
        succeeds(folder, &film);
        let [first, last] = ["0.png", "2.png"].map(|name| pixels(&folder.join(name)));
        assert!(first.chunks(4).all(|it| it == &first[..4]), "{rule}");
        assert!(last != first, "{rule}");
        (0..3).for_each(|number| fs::remove_file(folder.join(format!("{number}.png"))).unwrap());
    }
    let (status, said) = said(
        folder,
        &[
            "animate",
            "hilbert-lsystem",
            "--steps",
            "0",
            "--set",
            "angle=80..90",
            "-o",
            "x.gif",
        ],
    );
    assert!(status != Some(0), "{said}");
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

/// Frames of sets in space are kept as well: of whole sets, of sections, and of points.
#[test]
fn finished_frames_in_space_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let cut = ["--slice", "1,1,1=1.5"];
    let chaos = ["--method", "chaos", "--points", "5000"];
    for more in [&[][..], &cut, &chaos] {
        let film = [
            "animate", "menger", "--from", "0..90,25", "--frames", "3", "--size", "40x30", "-o",
            "%d.png",
        ];
        let film = [&film[..], more].concat();
        let (status, first) = said(folder, &film);
        assert!(status == Some(0) && !first.contains("kept"), "{first}");
        let frame = fs::read(folder.join("1.png")).unwrap();
        fs::remove_file(folder.join("1.png")).unwrap();
        let (_, again) = said(folder, &film);
        assert!(again.contains("2 of them kept"), "{again}");
        assert!(fs::read(folder.join("1.png")).unwrap() == frame);
        (0..3).for_each(|number| fs::remove_file(folder.join(format!("{number}.png"))).unwrap());
    }
}

#[test]
fn impossible_films_are_refused_and_leave_nothing() {
    let cases: [(&[&str], i32, &str); 15] = [
        (&["pythagoras"], 2, "nothing changes in the film"),
        (
            &["koch", "--turn", "0..90", "--at", "0.5,0.1"],
            2,
            "--at is the centre of --zoom",
        ),
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

/// Returns the texts of the style sheet of an animated SVG, after its structure has been checked by a reader of XML.
fn style_sheet(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let mut nodes = document.descendants();
    let style = nodes.find(|it| it.has_tag_name(("http://www.w3.org/2000/svg", "style")));
    style.unwrap().text().unwrap().to_owned()
}

#[test]
fn lines_of_an_svg_move_through_the_pictures_of_all_frames() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let film = [
        "animate",
        "pythagoras",
        "--set",
        "angle=30..60",
        "--steps",
        "3",
        "--frames",
        "5",
    ];
    let size = ["--size", "120x90", "--fit", "each", "-o"];
    succeeds(
        folder,
        &[
            &film[..],
            &["--bounce", "--margin", "0"],
            &size,
            &["film.svg"],
        ]
        .concat(),
    );
    let sheet = style_sheet(&folder.join("film.svg"));
    let picture = ["grow", "pythagoras", "--set", "angle=30", "--steps", "3"];
    let picture = [
        &picture[..],
        &["--size", "120x90", "--margin", "0", "-o", "one.svg"],
    ]
    .concat();
    succeeds(folder, &picture);
    let one = fs::read_to_string(folder.join("one.svg")).unwrap();
    let paths: Vec<&str> = { one.split(" d=\"").skip(1) }
        .map(|it| it.split('"').next().unwrap())
        .collect();
    assert!(!paths.is_empty());
    for data in paths {
        // The first frame, and the last moment, which returns to it.
        let key = format!("{{d:path(\"{}\")}}", data.replace('\n', " "));
        assert!(sheet.contains(&format!("0%{key}")) && sheet.contains(&format!("100%{key}")));
    }
    assert!(sheet.contains("prefers-reduced-motion"));
    // Five frames at 30 a second.
    let text = fs::read_to_string(folder.join("film.svg")).unwrap();
    assert!(text.contains(" linear 0.1667s infinite\""), "{text}");
    let nested = ["--svg", "instanced", "--size", "120", "-o", "nested.svg"];
    let nested = [&film[..], &nested].concat();
    succeeds(folder, &nested);
    assert!(style_sheet(&folder.join("nested.svg")).contains("transform:translate("));
    for (arguments, message) in [
        (&["koch", "--turn", "0..90", "--steps", "7"][..], "20000"),
        (
            &["pythagoras", "--steps", "0..3", "--cuts"],
            "does not have the lines",
        ),
        (
            &["koch", "--draw", "--turn", "0..90"],
            "changes in nothing else",
        ),
    ] {
        let all = [&["animate"], arguments, &["-o", "wrong.svg"]].concat();
        let (status, said) = said(folder, &all);
        assert!(status == Some(2) && said.contains(message), "{said}");
        assert!(!folder.join("wrong.svg").exists());
    }
}

/// A pen draws lines in their order: what it has drawn stays, and at the end all is drawn.
#[test]
fn pens_draw_to_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for rule in ["koch", "random-tree", "dragon", "pythagoras-squares"] {
        let draw = |file: &str, share: &[&str]| {
            let picture = [
                "grow",
                rule,
                "--steps",
                "4",
                "--size",
                "160x120",
                "--background",
                "white",
            ];
            succeeds(folder, &[&picture[..], share, &["-o", file]].concat());
            pixels(&folder.join(file))
        };
        let whole = draw("whole.png", &[]);
        assert!(draw("end.png", &["--drawn", "1"]) == whole, "{rule}");
        let blank = draw("start.png", &["--drawn", "0"]);
        assert!(blank.iter().all(|it| *it == 255), "{rule}");
        let inked = |pixels: &[u8]| pixels.chunks_exact(4).filter(|it| **it != [255; 4]).count();
        let shares = ["0.2", "0.5", "0.8"].map(|share| draw("part.png", &["--drawn", share]));
        let counts = shares.each_ref().map(|it| inked(it));
        assert!(counts.is_sorted() && counts[0] > 0, "{rule}: {counts:?}");
        assert!(
            counts[2] < inked(&whole) && counts[2] * 2 > inked(&whole),
            "{rule}: {counts:?}"
        );
    }
    // Half of the length of a curve is half of its lines.
    let list = [
        "grow", "koch", "--steps", "3", "--drawn", "0.5", "-o", "half.svg",
    ];
    succeeds(folder, &list);
    let half = fs::read_to_string(folder.join("half.svg")).unwrap();
    let data = half
        .split(" d=\"")
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap();
    let numbers = data.replace('-', " -").replace(['M', 'l'], " ");
    assert_eq!(numbers.split_whitespace().count(), 2 + 2 * 32);
    succeeds(
        folder,
        &[
            "animate", "koch", "--draw", "--steps", "2", "--frames", "5", "-o", "draw.svg",
        ],
    );
    let sheet = style_sheet(&folder.join("draw.svg"));
    assert!(sheet.contains("0%{visibility:hidden;stroke-dashoffset:1"));
    assert!(sheet.contains("40%{visibility:visible;stroke-dashoffset:0.5;"));
    let (status, said) = said(
        folder,
        &["grow", "koch", "--drawn", "0.5", "-o", "half.csv"],
    );
    assert!(status == Some(2) && said.contains("--drawn"), "{said}");
}

/// A film leads from one rule to another one: its ends are their pictures.
#[test]
fn tweens_lead_from_rule_to_rule() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let options = ["--steps", "4", "--size", "120x60", "--background", "white"];
    let film = [
        "animate", "koch", "--to", "levy", "--fit", "each", "--frames", "3", "-o", "t%d.png",
    ];
    succeeds(folder, &[&film[..], &options].concat());
    for (rule, frame) in [("koch", "t0.png"), ("levy", "t2.png")] {
        succeeds(
            folder,
            &[&["grow", rule, "-o", "one.png"], &options[..]].concat(),
        );
        assert!(
            pixels(&folder.join(frame)) == pixels(&folder.join("one.png")),
            "{rule}"
        );
    }
    let half = [
        "grow", "koch", "--to", "levy", "--share", "0.5", "-o", "one.png",
    ];
    succeeds(folder, &[&half[..], &options].concat());
    assert!(pixels(&folder.join("t1.png")) == pixels(&folder.join("one.png")));
    let file = std::io::BufReader::new(fs::File::open(folder.join("one.png")).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    let mut texts = reader.info().utf8_text.iter();
    let comment = texts
        .find(|it| it.keyword == "Comment")
        .unwrap()
        .get_text()
        .unwrap();
    assert!(
        comment.contains("--to=levy --share=0.5") && comment.contains("title: Lévy"),
        "{comment}"
    );
    for (arguments, message) in [
        (
            &["koch", "--to", "gasket"][..],
            "a system of maps in the plane",
        ),
        (&["koch", "--to", "kock"], "'koch'"),
        (&["plant-a", "--to", "plant-b"], "L-systems have no tweens"),
    ] {
        let (status, said) = said(
            folder,
            &[&["animate"], arguments, &["-o", "no.gif"]].concat(),
        );
        assert!(
            status.is_some_and(|it| it > 0) && said.contains(message),
            "{said}"
        );
    }
}

/// A file describes its film, and the command line has the last word.
#[test]
fn files_describe_their_films() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let rule = "params: {angle: {value: 30, min: 5, max: 80}}
initiator: segment
generator: [[0, 0], [1/3, 0], [1/2, tan(angle)/6], [2/3, 0], [1, 0]]
steps: 3
animation: {set: {angle: 10..60}, frames: 4, loop: true, ease: linear}
";
    fs::write(folder.join("mine.yaml"), rule).unwrap();
    let film = |arguments: &[&str]| {
        let size = ["--size", "60x40", "-o", "film.png"];
        succeeds(folder, &[&["animate"], arguments, &size].concat());
        fs::read(folder.join("film.png")).unwrap()
    };
    let own = film(&["mine.yaml"]);
    // The options of the file are among those of the film.
    let reader = png::Decoder::new(std::io::Cursor::new(&own))
        .read_info()
        .unwrap();
    let mut texts = reader.info().utf8_text.iter();
    let comment = texts
        .find(|it| it.keyword == "Comment")
        .unwrap()
        .get_text()
        .unwrap();
    assert!(comment.contains("kfrac animate mine.yaml"), "{comment}");
    for option in [
        "--set=angle=10..60",
        "--frames=4",
        "--loop ",
        "--size=60x40",
    ] {
        assert!(comment.contains(option), "{option}: {comment}");
    }
    let plain = rule.split("animation").next().unwrap();
    fs::write(folder.join("plain.yaml"), plain).unwrap();
    let frames = |bytes: &[u8]| {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let count = reader.info().animation_control().unwrap().num_frames;
        let mut all = Vec::new();
        let mut part = vec![0; 4 * 60 * 40];
        for _ in 0..count {
            let read = reader.next_frame(&mut part).unwrap();
            all.push(part[..read.buffer_size()].to_vec());
        }
        all
    };
    let options = [
        "--set",
        "angle=10..60",
        "--frames",
        "4",
        "--loop",
        "--ease",
        "linear",
    ];
    let given = film(&[&["plain.yaml"], &options[..]].concat());
    assert!(frames(&own) == frames(&given) && frames(&own).len() == 4);
    let other = film(&["mine.yaml", "--frames", "6", "--bounce"]);
    assert_eq!(frames(&other).len(), 6);
    for (line, message) in [
        ("{set: {angel: 10..60}}", "there is no parameter 'angel'"),
        ("{set: {angle: 10..x}}", "set:"),
        ("{turn: 0..3..4}", "turn:"),
        ("{turm: 0..90}", "did you mean 'turn'?"),
        ("{frames: many}", "frames"),
    ] {
        fs::write(
            folder.join("wrong.yaml"),
            format!("{plain}animation: {line}\n"),
        )
        .unwrap();
        for command in ["check", "animate"] {
            let (status, said) = said(folder, &[command, "wrong.yaml"]);
            assert!(
                status == Some(1) && said.contains(message),
                "{command} {line}: {said}"
            );
            assert!(said.contains("wrong.yaml:5:"), "{said}");
        }
    }
}

/// Where no graph determines the cost of frames, some of them are drawn for the forecast.
#[test]
fn films_of_every_kind_are_forecast() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for line in [
        "pythagoras --set angle=20..60",
        "koch --zoom 1..1e9 --at 0.(1) --detail 1",
        "barnsley-fern --method chaos --points 1k --seed 1..24",
        "sierpinski-tetrahedron --from 0..90,20",
    ] {
        let film = "--frames 24 --size 160x120 -o film.y4m";
        let line = format!("animate {line} {film}");
        let (status, said) = said(folder, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(status, Some(0), "{line}: {said}");
        let note = said
            .lines()
            .find(|line| line.starts_with("note: 24 frames"));
        // Three bytes a pixel.
        assert!(note.is_some_and(|it| it.ends_with(", 1.4 MB")), "{said}");
    }
}

/// Draws a film of frames in files, and returns the pixels of its frames.
fn frames(folder: &Path, film: &[&str], count: usize) -> Vec<Vec<u8>> {
    succeeds(folder, &[&["animate"], film, &["-o", "of-%d.png"]].concat());
    let frame = |number: usize| pixels(&folder.join(format!("of-{number}.png")));
    (0..count).map(frame).collect()
}

#[test]
fn colours_that_are_not_by_steps_keep_their_range() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let look = ["--size=200x60", "--background=white", "--palette=sinebow"];
    for color_by in ["angle", "x", "length", "step"] {
        let color_by = format!("--color-by={color_by}");
        let look = [&look[..], &[&color_by]].concat();
        let film = [
            "koch",
            "--steps=2..4",
            "--frames=3",
            "--fit=each",
            "--ease=linear",
        ];
        let all = frames(folder, &[&film[..], &look].concat(), 3);
        succeeds(
            folder,
            &[&["grow", "koch", "--steps=4", "-o", "one.png"], &look[..]].concat(),
        );
        assert!(all[2] == pixels(&folder.join("one.png")), "{color_by}");
    }
}

#[test]
fn films_in_space_show_all_of_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let films: [&[&str]; 3] = [
        &[
            "menger",
            "--from=0..360,20..80",
            "--perspective=80",
            "--steps=1",
            "--frames=6",
        ],
        &[
            "ternary-tree-in-space",
            "--steps=1..4",
            "--cuts",
            "--frames=4",
        ],
        &[
            "hilbert-lsystem-in-space",
            "--steps=1..3",
            "--cuts",
            "--ease=linear",
            "--frames=4",
        ],
    ];
    const SIZE: [usize; 2] = [128, 96];
    for film in films {
        let film = [film, &["--size=128x96", "--margin=2", "--background=white"]].concat();
        let count = if film[0] == "menger" { 6 } else { 4 };
        let mut widest = 0;
        for (number, frame) in frames(folder, &film, count).iter().enumerate() {
            let pixels = frame.as_chunks::<4>().0;
            let inked = (0..pixels.len()).filter(|at| pixels[*at][..3].iter().any(|it| *it < 200));
            let places: Vec<[usize; 2]> = inked.map(|at| [at % SIZE[0], at / SIZE[0]]).collect();
            let mut sides = [0; 2];
            for axis in [0, 1] {
                let least = places.iter().map(|it| it[axis]).min().unwrap();
                let most = places.iter().map(|it| it[axis]).max().unwrap();
                assert!(
                    least > 0 && most < SIZE[axis] - 1,
                    "{film:?}, frame {number}: {least} to {most}"
                );
                sides[axis] = most - least;
            }
            widest = widest
                .max(100 * sides[0] / SIZE[0])
                .max(100 * sides[1] / SIZE[1]);
        }
        assert!(widest > 65, "{film:?} fills {widest} % of its frames");
    }
}

#[test]
fn elements_that_cover_the_first_frame_leave_later_ones_transparent() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let square = "params: {x: 0}\ninitiator: [[0, 0], [1, 0]]\ngenerator: [[0, 0], [1/2, 0], [1, 0]]\nsteps: 0\nstyle: {fill: teal}\nbase_element: {closed: true, points: [[x, -1], [x + 1, -1], [x + 1, 1], [x, 1]]}\n";
    fs::write(folder.join("square.yaml"), square).unwrap();
    let film = [
        "animate",
        "square.yaml",
        "--set=x=0..3",
        "--frames=2",
        "--background=none",
        "--view=0.2,-0.5,0.6,0.6",
        "--size=16",
    ];
    succeeds(folder, &[&film[..], &["-o", "film.png"]].concat());
    let file = std::io::BufReader::new(fs::File::open(folder.join("film.png")).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; 4 * 16 * 16];
    reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.as_chunks::<4>().0.iter().all(|it| it[3] == 255));
    reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.as_chunks::<4>().0.iter().all(|it| it[3] == 0));
}

#[test]
fn lists_of_steps_and_seeds_go_back() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let look = ["--size=90x40", "--background=white"];
    let film = [
        "koch",
        "--steps=0,4,2",
        "--loop",
        "--frames=6",
        "--fit=each",
    ];
    let all = frames(folder, &[&film[..], &look].concat(), 6);
    for (frame, step) in [(0, "0"), (2, "4"), (3, "3"), (4, "2"), (5, "1")] {
        succeeds(
            folder,
            &[
                &["grow", "koch", "--steps", step, "-o", "one.png"],
                &look[..],
            ]
            .concat(),
        );
        assert!(
            all[frame] == pixels(&folder.join("one.png")),
            "frame {frame}"
        );
    }
    let film = [
        "random-tree",
        "--seed=1..3",
        "--bounce",
        "--frames=6",
        "--steps=4",
    ];
    let all = frames(folder, &[&film[..], &look].concat(), 6);
    assert!(all[4] == all[2] && all[5] == all[0] && all[3] != all[2] && all[2] != all[0]);
}

#[test]
fn films_of_svg_are_white_on_dark_pages() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let roof = "params: {h: 0.3}\ninitiator: segment\ngenerator: [[0, 0], [1/2, h], [1, 0]]\n";
    fs::write(folder.join("roof.yaml"), roof).unwrap();
    for change in ["--set=h=0.1..0.4", "--draw"] {
        let film = [
            "animate",
            "roof.yaml",
            change,
            "--steps=3",
            "--frames=3",
            "-o",
            "film.svg",
        ];
        succeeds(folder, &film);
        let written = fs::read_to_string(folder.join("film.svg")).unwrap();
        assert!(
            written.contains("@media(prefers-color-scheme:dark)"),
            "{film:?}"
        );
    }
    // Plots are no films.
    let (status, said) = said(
        folder,
        &[
            "animate",
            "koch",
            "--steps=0..2",
            "--hatch=45deg",
            "-o",
            "x.gif",
        ],
    );
    assert!(
        status == Some(2) && said.contains("unexpected argument"),
        "{said}"
    );
}
