//! Blend modes: colours of elements that overlap.

use crate::common;
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{self, Format, Options, Size, pixels};
use kfrac::style::{Blend, Colour, View, Width};

/// Squares of side 2 from (0, 0) and from (1, 0), of one colour, and a square from (2, 1).
const SQUARES: &str = "initiator:
  - {from: [0, 0], to: [2, 0]}
  - {from: [1, 0], to: [3, 0], connected: false}
  - {from: [2, 1], to: [4, 1], connected: false}
generator: [[0, 0], [1/2, 0], [1, 0]]
base_element: {points: [[0, 0], [1, 0], [1, 1], [0, 1]], closed: true}
";

fn options(fill: &str, blend: Blend) -> Options {
    let mut options = Options::default().size(Size::Exactly(40, 30));
    options.view = View {
        window: Some([0.0, 0.0, 4.0, 3.0]),
        ..View::default()
    };
    options.style.background = Some(Colour::WHITE);
    options.style.fill = Some(Colour::parse(fill).unwrap());
    options.style.blend = blend;
    options
}

fn graph() -> Graph {
    let rule = common::resolved(&common::document_of(SQUARES), &[]);
    Graph::compile(&rule, 0).unwrap()
}

/// Returns the colours in the middle of the units of the middle row, from the left: under one square, two, two and one.
fn row(options: &Options) -> [[u8; 4]; 4] {
    let drawn = pixels(&graph(), &Growth::steps(0), options).unwrap();
    let bytes = drawn.into_straight();
    [0, 1, 2, 3].map(|x| bytes.as_chunks().0[15 * 40 + 10 * x + 5])
}

#[test]
fn overlapping_elements_are_mixed() {
    let mixed = |fill: &str, blend: Blend| {
        row(&options(fill, blend)).map(|pixel| [pixel[0], pixel[1], pixel[2]])
    };
    let near = |found: [u8; 3], expected: [u8; 3]| {
        let mut off = found.iter().zip(expected).map(|(a, b)| a.abs_diff(b));
        assert!(off.all(|off| off <= 2), "{found:?} instead of {expected:?}");
    };
    let half = "#80ff0080";
    let joined = mixed(half, Blend::Joined);
    assert_eq!(joined[0], joined[1], "one area");
    let normal = mixed(half, Blend::Normal);
    assert_eq!(normal[0], joined[0]);
    near(normal[0], [191, 255, 127]);
    near(normal[1], [159, 255, 63]);
    let multiplied = mixed("#80c0ff", Blend::Multiply);
    near(multiplied[0], [128, 192, 255]);
    near(multiplied[1], [64, 145, 255]);
    near(multiplied[3], [128, 192, 255]);
    let mut dark = options("#402010", Blend::Add);
    dark.style.background = Some(Colour::BLACK);
    let added = row(&dark);
    near([added[0][0], added[0][1], added[0][2]], [64, 32, 16]);
    near([added[1][0], added[1][1], added[1][2]], [128, 64, 32]);
    dark.style.blend = Blend::Screen;
    dark.style.fill = Some(Colour::parse("#800000").unwrap());
    let screened = row(&dark);
    near(
        [screened[1][0], screened[1][1], screened[1][2]],
        [192, 0, 0],
    );
    // Bands have the same pixels.
    let mut bands = options("#80c0ff", Blend::Multiply)
        .in_one_piece(1)
        .band(400);
    bands.format = Format::Png;
    let mut png = Vec::new();
    render::write(&graph(), &Growth::steps(0), &bands, &mut png).unwrap();
    let whole = tiny_skia::Pixmap::decode_png(&png).unwrap();
    let pixel = whole.pixel(15, 15).unwrap();
    assert_eq!([pixel.red(), pixel.green(), pixel.blue()], multiplied[1]);
}

/// The inside of an outline is mixed with what lies below the element, not with the element's own fill.
#[test]
fn an_outline_covers_the_fill_of_its_element() {
    for is_banded in [false, true] {
        let mut options = options("orange", Blend::Multiply);
        options.style.stroke = Some(Colour::parse("teal").unwrap());
        options.style.width = Width::Pixels(6.0);
        if is_banded {
            options = options.in_one_piece(1).band(400);
        }
        options.format = Format::Png;
        let mut png = Vec::new();
        render::write(&graph(), &Growth::steps(0), &options, &mut png).unwrap();
        let whole = tiny_skia::Pixmap::decode_png(&png).unwrap();
        // The left side of the upper square, where it is alone: outside, inside, and its area.
        let pixels = [18, 21, 30].map(|x| whole.pixel(x, 5).unwrap());
        let colours = pixels.map(|it| [it.red(), it.green(), it.blue()]);
        assert_eq!(colours, [[0, 128, 128], [0, 128, 128], [255, 165, 0]]);
    }
}

#[test]
fn vector_graphics_have_blend_modes() {
    let text = |format, blend| {
        let mut options = options("teal", blend);
        options.format = format;
        let mut bytes = Vec::new();
        render::write(&graph(), &Growth::steps(0), &options, &mut bytes).unwrap();
        bytes
    };
    for (blend, mode, paths) in [
        (Blend::Joined, None, 1),
        (Blend::Normal, None, 3),
        (Blend::Multiply, Some("mix-blend-mode:multiply"), 3),
        (Blend::Add, Some("mix-blend-mode:plus-lighter"), 3),
        (Blend::Screen, Some("mix-blend-mode:screen"), 3),
    ] {
        let svg = String::from_utf8(text(Format::Svg, blend)).unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let drawn = document
            .descendants()
            .filter(|node| node.has_tag_name("path"));
        assert_eq!(drawn.count(), paths, "{blend:?}");
        assert_eq!(svg.contains("mix-blend-mode"), mode.is_some());
        assert!(svg.contains(mode.unwrap_or("<path")), "{svg}");
    }
    let pdf = lopdf::Document::load_mem(&text(Format::Pdf, Blend::Multiply)).unwrap();
    let modes = pdf
        .objects
        .values()
        .filter_map(|object| object.as_dict().ok());
    let is_multiplied = |page: &lopdf::Dictionary| format!("{page:?}").contains("Multiply");
    assert!({ modes }.any(is_multiplied));
}

#[test]
fn files_and_the_command_line_have_blend_modes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let text = format!("{SQUARES}style: {{fill: teal, blend: multiply}}\nsteps: 0\n");
    std::fs::write(folder.join("squares.yaml"), text).unwrap();
    let run = |line: &str| common::run(folder, line);
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    assert!(run("grow squares.yaml -o a.svg -q").0);
    assert!(read("a.svg").contains("mix-blend-mode:multiply"));
    assert!(run("grow squares.yaml --blend screen -o b.svg -q").0);
    assert!(
        read("b.svg").contains("mix-blend-mode:screen") && read("b.svg").contains("--blend=screen")
    );
    assert!(run("grow squares.yaml --blend joined -o c.svg -q").0);
    assert!(!read("c.svg").contains("mix-blend-mode"));
    assert!(run("sheet squares.yaml koch -o d.svg -q").0);
    assert!(read("d.svg").contains("mix-blend-mode:multiply"));
    let (is_done, said) = run("grow menger --blend add -o e.png");
    assert!(!is_done && said.contains("for the plane"), "{said}");
    let (is_done, said) = run("grow koch --blend darken -o e.png");
    assert!(!is_done && said.contains("multiply"), "{said}");
}
