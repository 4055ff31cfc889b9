//! `kfrac morph` and `kfrac skeleton`, on pictures of all formats.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn kfrac(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("kfrac"));
    command
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = kfrac(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Returns a plain bitmap of what rows of `#` show.
fn bitmap(rows: &[&str]) -> String {
    let pixels = rows.join("\n").replace('#', "1").replace('.', "0");
    format!(
        "P1\n# drawn by hand\n{} {}\n{pixels}\n",
        rows[0].len(),
        rows.len()
    )
}

/// Returns the rows of a PNG of one bit a pixel, as in [`bitmap`].
fn rows(path: &Path) -> Vec<String> {
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    assert_eq!(reader.info().bit_depth, png::BitDepth::One);
    let (width, height) = reader.info().size();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let line = width.div_ceil(8) as usize;
    let pixel = |row: usize, column: usize| bytes[row * line + column / 8] >> (7 - column % 8) & 1;
    let row = |row| {
        let pixels = (0..width as usize).map(|column| pixel(row, column));
        pixels.map(|it| if it == 0 { '#' } else { '.' }).collect()
    };
    (0..height as usize).map(row).collect()
}

const SHAPE: [&str; 9] = [
    "............",
    ".######.....",
    ".######...#.",
    ".###.##.....",
    ".######.....",
    ".######.....",
    ".######.....",
    "............",
    "............",
];

#[test]
fn operations_follow_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("shape.pbm"), bitmap(&SHAPE)).unwrap();
    let morphed = |operations: &str, disk: &str| {
        let arguments = [
            "morph",
            "shape.pbm",
            operations,
            "--disk",
            disk,
            "-o",
            "out.png",
        ];
        succeeds(folder, &arguments);
        rows(&folder.join("out.png"))
    };
    let filled = SHAPE.map(|row| row.replace("###.##", "######"));
    assert_eq!(morphed("close:1", "square"), filled);
    let opened = filled.clone().map(|row| row.replace("...#.", "....."));
    assert_eq!(morphed("close:1, open:1", "square"), opened);
    let thinner = SHAPE.iter().enumerate().map(|(row, _)| {
        if (2..6).contains(&row) {
            "..####......"
        } else {
            "............"
        }
    });
    assert_eq!(
        morphed("close:1, erode:1", "square"),
        thinner.collect::<Vec<_>>()
    );
    // A disk of radius 1 is a plus.
    assert_eq!(morphed("erode:1", "euclid"), morphed("erode:1", "plus"));
    assert_ne!(
        morphed("dilate:1", "euclid"),
        morphed("dilate:1.5", "euclid")
    );
    assert_eq!(
        morphed("dilate:1.5", "euclid"),
        morphed("dilate:1", "square")
    );
}

/// The six formats of Netpbm and PNG hold the same picture.
#[test]
fn pictures_of_all_formats_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let all = SHAPE.concat();
    let grey: Vec<u8> = all
        .bytes()
        .map(|it| if it == b'#' { 10 } else { 200 })
        .collect();
    let plain = |values: &[u8]| {
        let values: Vec<_> = values.iter().map(u8::to_string).collect();
        values.join(" ")
    };
    let colours: Vec<u8> = grey.iter().flat_map(|&it| [it, it, it]).collect();
    let packed = SHAPE.iter().flat_map(|row| {
        let bits = |from: usize| {
            let row = row.bytes().skip(from).chain([b'.'; 8]).take(8);
            row.fold(0u8, |byte, it| byte << 1 | u8::from(it == b'#'))
        };
        [bits(0), bits(8)]
    });
    let words = grey.iter().flat_map(|&it| [it, it]);
    let with = |head: &str, bytes: Vec<u8>| [head.as_bytes(), &bytes].concat();
    for (name, bytes) in [
        ("1.pbm", bitmap(&SHAPE).into_bytes()),
        ("2.pgm", with("P2 12 9 255\n", plain(&grey).into_bytes())),
        ("3.ppm", with("P3 12 9 255\n", plain(&colours).into_bytes())),
        ("4.pbm", with("P4\n12 9\n", packed.collect())),
        ("5.pgm", with("P5 12\t9 255\n", grey.clone())),
        ("5w.pgm", with("P5 12 9\n65535\n", words.collect())),
        ("6.ppm", with("P6 12 9 255\n", colours.clone())),
    ] {
        fs::write(folder.join(name), bytes).unwrap();
        succeeds(folder, &["morph", name, "open:0", "-o", "out.png"]);
        assert_eq!(rows(&folder.join("out.png")), SHAPE, "{name}");
    }
    succeeds(folder, &["morph", "out.png", "open:0", "-o", "again.png"]);
    assert_eq!(rows(&folder.join("again.png")), SHAPE);
    let json: Value = serde_json::from_str(&succeeds(folder, &["dim", "4.pbm", "--json"])).unwrap();
    assert_eq!(
        json["box_counting"]["set"],
        "36 dark pixels of 12 x 9 (threshold 1)"
    );
}

#[test]
fn a_skeleton_is_drawn_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut square = vec![".".repeat(17); 20];
    for row in &mut square[2..13] {
        *row = format!("{}{}{}", ".".repeat(3), "#".repeat(11), ".".repeat(3));
    }
    let square: Vec<&str> = square.iter().map(String::as_str).collect();
    fs::write(folder.join("square.pbm"), bitmap(&square)).unwrap();
    let listed = succeeds(
        folder,
        &["skeleton", "square.pbm", "--json", "-o", "all.csv"],
    );
    let json: Value = serde_json::from_str(&listed).unwrap();
    assert_eq!(json["picture"]["pixels"], 121);
    let nodes = json["nodes"].as_array().unwrap();
    let centre = nodes
        .iter()
        .find(|node| node["branches"].as_array().unwrap().len() == 4);
    let centre = centre.unwrap();
    // Column 8, row 7 of 20 rows.
    assert_eq!(
        [&centre["x"], &centre["y"], &centre["radius"]],
        [8.5, 12.5, 5.5]
    );
    assert_eq!(json["branches"].as_array().unwrap().len(), 4);
    let table = fs::read_to_string(folder.join("all.csv")).unwrap();
    assert!(table.starts_with("kind,number,x,y,radius\n"), "{table}");
    assert!(
        table.contains("junction,") && table.contains("branch,3,8.5,12.5,5.5\n"),
        "{table}"
    );
    let disks = [
        "skeleton",
        "square.pbm",
        "--disk",
        "square",
        "--format",
        "csv",
        "-o",
        "-",
    ];
    assert_eq!(
        succeeds(folder, &disks),
        "kind,size,x,y,radius\ndisk,5,8.5,12.5,5\n"
    );
    let svg = succeeds(
        folder,
        &["skeleton", "square.pbm", "--format", "svg", "-o", "-"],
    );
    assert!(svg.starts_with("<svg") || svg.contains("<svg"), "{svg}");
    assert!(svg.contains("#0072b2") && svg.contains("#d55e00"), "{svg}");
    let text = succeeds(folder, &["skeleton", "square.pbm"]);
    assert!(
        text.starts_with("1 branch points, 4 ends, 4 branches\n"),
        "{text}"
    );
}

#[test]
fn mistakes_are_explained() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("shape.pbm"), bitmap(&SHAPE)).unwrap();
    fs::write(folder.join("white.pbm"), bitmap(&["...", "..."])).unwrap();
    fs::write(folder.join("cut.pgm"), b"P5 100 100 255\nabc").unwrap();
    fs::write(folder.join("huge.ppm"), b"P6 99999999 99999999 255\n").unwrap();
    fs::write(folder.join("words.pgm"), b"P2 wide 4 255\n").unwrap();
    let long = format!("P4 70000 1\n{}", "x".repeat(8750));
    fs::write(folder.join("long.pbm"), long).unwrap();
    let out = ["-o", "out.png"];
    for (arguments, code, message) in [
        (
            &["morph", "shape.pbm", "blur:2"][..],
            2,
            "\"blur\" is no operation",
        ),
        (
            &["morph", "shape.pbm", "open"],
            2,
            "write open:3 for a disk of size 3",
        ),
        (
            &["morph", "shape.pbm", "open:1.5", "--disk", "plus"],
            2,
            "the size of a plus is a whole number",
        ),
        (
            &["morph", "shape.pbm", "dilate:1e6"],
            1,
            "choose smaller disks",
        ),
        (&["morph", "white.pbm", "open:1"], 1, "no pixel is dark"),
        (
            &["morph", "cut.pgm", "open:1"],
            1,
            "it ends before its last pixel",
        ),
        (&["morph", "huge.ppm", "open:1"], 1, "more than 1073741824"),
        (
            &["morph", "words.pgm", "open:1"],
            1,
            "its width is no whole number",
        ),
        (&["morph", "none.png", "open:1"], 1, "none.png"),
        (
            &["skeleton", "long.pbm"],
            1,
            "its diagonal is longer than 65535 pixels",
        ),
        (
            &["skeleton", "shape.pbm", "--angle", "200"],
            2,
            "an angle from 0 to 180",
        ),
    ] {
        let mut arguments = arguments.to_vec();
        if arguments[0] == "morph" {
            arguments.extend(out);
        }
        let output = kfrac(folder, &arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.contains(message), "{arguments:?}: {said}");
        assert!(!folder.join("out.png").exists(), "{arguments:?}");
    }
    let output = kfrac(folder, &["morph", "shape.pbm", "open:1", "-o", "out.svg"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("the result is a .png"), "{said}");
}

/// A full picture, one pixel and a line of one pixel have skeletons.
#[test]
fn small_and_full_pictures_have_skeletons() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (rows, message) in [
        (&["#"][..], "0 branch points, 0 ends, 0 branches\n"),
        (&["#######"], "0 branch points, 2 ends, 1 branches\n"),
        (&["#########"; 9], "1 branch points, 4 ends, 4 branches\n"),
    ] {
        fs::write(folder.join("all.pbm"), bitmap(rows)).unwrap();
        let arguments = ["skeleton", "all.pbm", "--threshold", "128"];
        assert!(
            succeeds(folder, &arguments).starts_with(message),
            "{rows:?}"
        );
        for disk in ["plus", "square", "octagon", "euclid"] {
            let text = succeeds(folder, &["skeleton", "all.pbm", "--disk", disk]);
            assert!(text.contains(disk), "{text}");
        }
    }
}
