//! Densities of files: hits of random iteration and of elements, with their tones.

use std::fs;
use std::path::Path;

use crate::common::{self, run};

const SYSTEM: &str = "kind: ifs
maps: [{times: 0.5 + 0.3*i, translate: [1, 0]}, {scale: 0.6, rotate: 70}]
steps: 6
";

/// Writes a file and draws it; returns the bytes of the picture, without its texts if it is a PNG.
fn drawn(folder: &Path, text: &str, options: &str, output: &str) -> Vec<u8> {
    fs::write(folder.join("set.yaml"), text).unwrap();
    let line = format!("grow set.yaml --size 120 -q -o {output} {options}");
    assert!(run(folder, line.trim()).0, "{line}");
    let bytes = fs::read(folder.join(output)).unwrap();
    if !output.ends_with(".png") {
        return bytes;
    }
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    pixels
}

#[test]
fn a_file_is_drawn_as_its_density_states() {
    let folder = tempfile::tempdir().unwrap();
    let draw =
        |text: &str, options: &str, output: &str| drawn(folder.path(), text, options, output);
    let whole =
        "density: {method: chaos, points: 50k, tone: linear, gamma: 2, oversample: 2, kernel: 3}\n";
    let file = format!("{SYSTEM}{whole}");
    let options = "--method chaos --points 50k --tone linear --gamma 2 --oversample 2 --kernel 3";
    let expected = draw(SYSTEM, options, "a.png");
    assert!(draw(&file, "", "b.png") == expected);
    // Options take precedence, one by one.
    let plain = draw(
        SYSTEM,
        &options.replace("--kernel 3", "--kernel 1"),
        "c.png",
    );
    assert!(plain != expected && draw(&file, "--kernel 1", "d.png") == plain);
    // Options of elements, another method and other formats draw elements.
    let elements = draw(SYSTEM, "", "e.png");
    for options in ["--steps 6", "--method deterministic"] {
        assert!(draw(&file, options, "f.png") == elements, "{options}");
    }
    assert!(draw(&file, "--detail 2", "f.png") == draw(SYSTEM, "--detail 2", "g.png"));
    assert!(elements != expected);
    let svg = draw(SYSTEM, "", "h.svg");
    let lines = |svg: &[u8]| {
        let text = String::from_utf8(svg.to_vec()).unwrap();
        text.lines()
            .filter(|line| line.starts_with("<path"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(lines(&draw(&file, "", "i.svg")), lines(&svg));
}

#[test]
fn a_tone_of_elements_is_that_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let rule = "initiator: segment\ngenerator: levy\nsteps: 8\n";
    let file = format!("{rule}density: {{tone: linear, gamma: 1.5}}\n");
    let expected = drawn(folder.path(), rule, "--tone linear --gamma 1.5", "a.png");
    assert!(drawn(folder.path(), &file, "", "b.png") == expected);
    assert!(drawn(folder.path(), rule, "", "c.png") != expected);
    let by_hits = format!("{file}style: {{color_by: hits, palette: [white, teal, black]}}\n");
    let palette = "--tone linear --gamma 1.5 --palette white,teal,black";
    let expected = drawn(folder.path(), rule, palette, "d.png");
    assert!(drawn(folder.path(), &by_hits, "", "e.png") == expected);
}

#[test]
fn options_of_densities_are_refused_where_they_have_no_effect() {
    let folder = tempfile::tempdir().unwrap();
    for (line, expected) in [
        (
            "grow koch --kernel 3 -o x.png",
            "--kernel applies to random iteration",
        ),
        (
            "grow koch --gamma 2 -o x.png",
            "--gamma applies to random iteration",
        ),
        ("grow gasket --method chaos --kernel 0 -o x.png", "above 0"),
        ("grow gasket --method chaos --oversample 5 -o x.png", "1"),
        (
            "grow menger --method chaos --gamma 2 -o x.png",
            "pictures of the plane",
        ),
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let (status, said) = common::said(folder.path(), &arguments);
        assert_ne!(status, Some(0), "{line}");
        assert!(said.contains(expected), "{line}: {said}");
    }
}

/// Colours of elements that are held in memory are those of the range.
#[test]
fn ranges_of_colours_hold_for_random_rules_in_space() {
    let folder = tempfile::tempdir().unwrap();
    let rule = "space: 3
initiator: [[0, 0, 0], [0, 1, 0]]
generator:
  random: {turn: 'uniform(20, 40)'}
  elements: [[0, 0, 0], {to: [1/2, 0, 0], fertile: false}, {from: [1/2, 0, 0], to: ['1/2 + cos(turn)/2', 'sin(turn)/2', 0]}]
base_element: {solid: bar, width: 0.2}
steps: 5
style: {color_by: step, palette: [red, lime]}
view: {shade: none}
";
    let draw = |options: &str| drawn(folder.path(), rule, options, "x.png");
    let whole = draw("");
    // No element has a step of the range, and all have its first colour.
    let before = draw("--color-range 100..200");
    let red = rule.replace("palette: [red, lime]", "palette: [red]");
    let one = drawn(folder.path(), &red, "", "y.png");
    assert!(whole != before && before == one);
}

/// A system that is derived word by word is known at one step only.
#[test]
fn the_steps_before_are_not_listed_as_the_last_one() {
    let folder = tempfile::tempdir().unwrap();
    let text = "kind: lsystem
params: {most: 260}
axiom: A(0)
productions:
  - 'A(k) : k < most -> F(1/most)[+(60 + 20*sin(k))B(0, k)][-(60 + 20*sin(k))B(0, k)]A(k + 1)'
  - 'B(j, k) : j < 100 -> F(0.2/most)+(1 + sin(k*j))B(j + 1, k)'
steps: 360
";
    fs::write(folder.path().join("feather.yaml"), text).unwrap();
    let (status, said) = common::said(folder.path(), &["grow", "feather.yaml", "-o", "x.svg"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("is drawn instead of 360"), "{said}");
}
