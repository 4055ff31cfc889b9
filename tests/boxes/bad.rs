//! Input of `kfrac dim`: formats that are read, and files that are refused.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn dim(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("kfrac"));
    command.env_remove("KFRAC_LIBRARY").current_dir(folder);
    command.arg("dim").args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Returns a greyscale PNG.
fn png(values: &[u8], width: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let height = u32::try_from(values.len()).unwrap() / width;
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder
        .write_header()
        .unwrap()
        .write_image_data(values)
        .unwrap();
    bytes
}

fn json(output: &Output) -> serde_json::Value {
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn bad_input_is_refused_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let white = png(&[255; 64], 8);
    let mut no_width = white.clone();
    no_width[16..20].fill(0);
    let mut huge = white.clone();
    huge[16..24].fill(0x7f);
    // Rows with a byte beside the coordinates, more than are read at once.
    let mut many = b"ply\nformat binary_little_endian 1.0\nelement vertex 40000\nproperty uchar red\nproperty float x\nproperty double y\nproperty float z\nend_header\n".to_vec();
    for vertex in 1..=40_000_u16 {
        let y = if vertex < 30_000 {
            f64::from(vertex)
        } else {
            f64::NAN
        };
        many.push(7);
        many.extend(1_f32.to_le_bytes());
        many.extend(y.to_le_bytes());
        many.extend(2_f32.to_le_bytes());
    }
    let cases: [(&str, &[u8], &str); 21] = [
        ("empty.csv", b"", "there are no points"),
        ("header.csv", b"x,y\n", "there are no points"),
        ("one.csv", b"1,2\n", "all points are equal"),
        ("equal.csv", b"1,2\n1,2\n1,2\n", "all points are equal"),
        (
            "nan.csv",
            b"x,y\n0,0\n1,nan\n",
            "row 3: the coordinate nan is not finite",
        ),
        (
            "infinite.csv",
            b"0,0\n1e999,2\n",
            "row 2: the coordinate 1e999 is not finite",
        ),
        ("word.csv", b"0,0\n1,two\n", "row 2: 'two' is not a number"),
        (
            "ragged.csv",
            b"0,0\n1,2\n1,2,3\n",
            "row 3: 3 columns, not 2 as in the rows before",
        ),
        (
            "four.csv",
            b"0,0,0,0\n",
            "the table has 4 columns, and points have two or three",
        ),
        (
            "cut.ply",
            b"ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\nend_header\n0123",
            "the file ends before the last of its vertices",
        ),
        (
            "flat.ply",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
            "there is no element 'vertex' with the properties x, y and z",
        ),
        (
            "type.ply",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n0\n",
            "line 4 of the header: unknown type 'half'",
        ),
        (
            "word.ply",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 one 0\n",
            "vertex 1: 'one' is not a number",
        ),
        ("infinite.ply", &many, "vertex 30000: a coordinate is not finite"),
        (
            "far.csv",
            b"-1e308,0\n1e308,0\n",
            "the points lie farther apart than numbers can tell",
        ),
        ("white.png", &white, "no pixel is dark"),
        (
            "cut.png",
            &white[..white.len() - 20],
            "the PNG cannot be read",
        ),
        ("width.png", &no_width, "the PNG cannot be read"),
        ("huge.png", &huge, "the PNG cannot be read"),
        (
            "text.png",
            b"not a picture",
            "the picture is neither PNG, JPEG, PBM, PGM nor PPM",
        ),
        (
            "cut.jpg",
            &include_bytes!("gasket.jpg")[..60],
            "the JPEG cannot be read",
        ),
    ];
    for (name, bytes, reason) in cases {
        fs::write(folder.join(name), bytes).unwrap();
        let output = dim(folder, &[name]);
        assert_eq!(output.status.code(), Some(1), "{name}: {output:?}");
        let said = said(&output);
        assert!(
            said.starts_with("error: ") && said.contains(reason),
            "{name}: {said}"
        );
        assert!(said.contains(name), "{name}: {said}");
    }
}

#[test]
fn wrong_options_are_a_wrong_command_line() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        ["koch", "--base", "1"],
        ["koch", "--columns", "x"],
        ["koch", "--threshold", "0"],
        ["koch", "--grids", "0"],
        ["koch", "--plot", "plot.gif"],
    ] {
        let output = dim(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
    }
}

#[test]
fn pictures_are_read_in_either_format_and_inverted() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Equal blocks of 8 × 8 pixels are in the JPEG.
    let dark = |place: usize| (place % 64 / 8) & (place / 64 / 8) == 0;
    let values: Vec<u8> = (0..64 * 64)
        .map(|place| if dark(place) { 10 } else { 240 })
        .collect();
    fs::write(folder.join("gasket.png"), png(&values, 64)).unwrap();
    fs::write(folder.join("gasket.jpg"), include_bytes!("gasket.jpg")).unwrap();
    let inverse: Vec<u8> = values.iter().map(|value| 255 - value).collect();
    fs::write(folder.join("inverse.png"), png(&inverse, 64)).unwrap();
    let of = |arguments: &[&str]| json(&dim(folder, arguments))["box_counting"]["boxes"].clone();
    let boxes = of(&["gasket.png", "--json"]);
    assert_eq!(boxes, of(&["gasket.jpg", "--json"]));
    assert_eq!(boxes, of(&["inverse.png", "--invert", "--json"]));
    assert_eq!(boxes[6]["count"], 27 * 64);
    assert_eq!(boxes[3]["count"], 27);
}

#[test]
fn the_json_has_what_is_promised() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..2000)
        .map(|number| format!("{},{}\n", number, 2 * number))
        .collect();
    fs::write(folder.path().join("line.csv"), rows).unwrap();
    let report = json(&dim(
        folder.path(),
        &["line.csv", "--json", "--plot", "line.svg"],
    ));
    for field in ["similarity", "hausdorff", "boundary"] {
        assert!(report[field].is_null(), "{field}");
    }
    let counting = &report["box_counting"];
    let (value, error) = (
        counting["value"].as_f64().unwrap(),
        counting["std_error"].as_f64().unwrap(),
    );
    assert!(
        (value - 1.0).abs() <= 2.0 * error && error < 0.06,
        "{value} {error}"
    );
    assert_eq!(counting["range"].as_array().unwrap().len(), 2);
    assert!(counting["r_squared"].as_f64().unwrap() > 0.999);
    assert!(counting["boxes"][0]["local_slope"].is_f64());
    assert_eq!(report["spectrum"][1]["q"], 1.0);
    let plot = fs::read_to_string(folder.path().join("line.svg")).unwrap();
    let plot = roxmltree::Document::parse(&plot).unwrap();
    assert!(
        plot.descendants()
            .filter(|node| node.has_tag_name("path"))
            .count()
            > 20
    );
}

#[test]
fn another_seed_grows_another_individual() {
    let folder = tempfile::tempdir().unwrap();
    let rule = "initiator: segment\ngenerator:\n  random: {height: \"uniform(0.1, 0.4)\"}\n  elements: [[0, 0], \
                [1/2, height], [1, 0]]\n";
    fs::write(folder.path().join("hills.yaml"), rule).unwrap();
    let boxes = |seed: &str| {
        let report = json(&dim(
            folder.path(),
            &["hills.yaml", "--seed", seed, "--json"],
        ));
        let set = report["box_counting"]["set"].as_str().unwrap();
        assert!(set.ends_with(&format!("seed {seed}")), "{set}");
        report["box_counting"]["boxes"].clone()
    };
    assert_eq!(boxes("3"), boxes("3"));
    assert_ne!(boxes("3"), boxes("4"));
}
