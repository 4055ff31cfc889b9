//! Hits: pictures of the numbers of elements that cover pixels.

use std::num::NonZero;

use crate::common::{self, run};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{Options, Size, pixels};
use kfrac::style::{ColorBy, Colour, Palette, Tone, View};

/// Squares of side 2 from (0, 0), from (1, 1) and, twice, from (2, 0).
const SQUARES: &str = "initiator:
  - {from: [0, 0], to: [2, 0]}
  - {from: [1, 1], to: [3, 1], connected: false}
  - {from: [2, 0], to: [4, 0], connected: false}
  - {from: [2, 0], to: [4, 0], connected: false}
generator: [[0, 0], [1/2, 0], [1, 0]]
base_element: {points: [[0, 0], [1, 0], [1, 1], [0, 1]], closed: true}
";

/// Draws step 0 of a rule on a picture of four units, of 10 pixels each; returns the pixel in the middle of every unit, from
/// the upper left.
fn units(text: &str, change: impl FnOnce(&mut Options)) -> Vec<[u8; 4]> {
    let rule = common::resolved(&common::document_of(text), &[]);
    let graph = Graph::compile(&rule, 0).unwrap();
    let mut options = Options::default().size(Size::Exactly(40, 30));
    options.view = View {
        window: Some([0.0, 0.0, 4.0, 3.0]),
        ..View::default()
    };
    options.style.background = Some(Colour::WHITE);
    options.tone = Some(Tone::Linear);
    change(&mut options);
    let drawn = pixels(&graph, &Growth::steps(0), &options).unwrap();
    let bytes = drawn.into_straight();
    let middles = (0..3).flat_map(|y| (0..4).map(move |x| (10 * y + 5) * 40 + 10 * x + 5));
    middles.map(|at| bytes.as_chunks().0[at]).collect()
}

#[test]
fn overlapping_shapes_add_up() {
    // From the top: the numbers of squares over each unit.
    const COUNTS: [u8; 12] = [0, 1, 1, 0, 1, 2, 3, 2, 1, 1, 2, 2];
    let grey = |tone: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a tone"
        )]
        let level = 255 - (tone * 255.0).round() as u8;
        [level, level, level, 255]
    };
    let found = units(SQUARES, |_| {});
    assert_eq!(found, COUNTS.map(|count| grey(f64::from(count) / 3.0)));
    let found = units(SQUARES, |options| options.tone = Some(Tone::Log));
    let log = |count: u8| f64::from(count).ln_1p() / 3.0_f64.ln_1p();
    assert_eq!(found, COUNTS.map(|count| grey(log(count))));
    let found = units(SQUARES, |options| options.tone = Some(Tone::Plain));
    assert_eq!(found, COUNTS.map(|count| grey(f64::from(count.min(1)))));
    // By a palette, from its first colour on.
    let colours = ["#0000ff", "#ff0000"].map(|text| Colour::parse(text).unwrap());
    let palette = Palette::of_colours("", &colours);
    let found = units(SQUARES, |options| {
        options.style.color_by = ColorBy::Hits;
        options.style.palette = palette.clone();
    });
    assert_eq!(found[0], [255; 4]);
    assert_eq!(found[6], [255, 0, 0, 255]);
    let middle = palette.at((255.0_f64 / 3.0 * 2.0).round() / 255.0).rgba();
    assert_eq!(found[5], middle);
}

/// Lévy's curve draws many edges twice or more: in one path, which other pictures draw as one.
#[test]
fn edges_of_one_curve_add_up() {
    let rule = common::resolved(&common::document("levy"), &[]);
    let graph = Graph::compile(&rule, 10).unwrap();
    let mut options = Options::default().size(Size::Long(320));
    options.tone = Some(Tone::Linear);
    options.style.background = Some(Colour::WHITE);
    let draw = |options: &Options| pixels(&graph, &Growth::steps(10), options).unwrap();
    let bytes = draw(&options).into_straight();
    let darkness: Vec<u8> = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|pixel| 255 - pixel[0])
        .collect();
    assert_eq!(darkness.iter().max(), Some(&255));
    let faint = darkness.iter().filter(|it| (1..140).contains(*it)).count();
    assert!(faint > 2000, "{faint} pixels of single edges are fainter");
    options.threads = NonZero::new(3).unwrap();
    assert!(draw(&options).into_straight() == bytes);
}

#[test]
fn the_command_line_has_tones_of_elements() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for line in [
        "grow dragon --steps 8 --tone log",
        "grow pythagoras --tone linear --palette #fff,teal,navy -o tree.png",
        "grow binary-tree --detail 1 --tone log --color-by hits --size 300 -o detail.png",
        "grow koch --zoom 9 --at 0.(1) --tone plain --size 200 -o zoomed.png",
    ] {
        let (is_done, said) = run(folder, line);
        assert!(is_done, "{line}: {said}");
    }
    assert!(folder.join("dragon.png").exists());
    let (_, said) = run(folder, "grow detail.png --size 100 -o again.png");
    assert!(said.contains("100 x"), "{said}");
    for (line, expected) in [
        ("grow dragon --tone log -o a.svg", "write a .png"),
        ("grow dragon --tone log --plot -o a.png", "without --plot"),
        (
            "grow dragon --tone log --color-by step -o a.png",
            "--color-by hits",
        ),
        ("grow dragon --color-by hits -o a.png", "add --method chaos"),
        ("grow menger --tone log -o a.png", "for the plane"),
        ("sheet dragon --tone log", "add --method chaos"),
    ] {
        let (is_done, said) = run(folder, line);
        assert!(!is_done && said.contains(expected), "{line}: {said}");
    }
}
