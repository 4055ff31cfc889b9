//! Pictures and dimensions are invariant under changes of scale and position.

use std::num::NonZero;

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::export::{self, TableFormat};
use kfrac::geometry::{DVec2, Homothety};
use kfrac::graph::{CompileError, Graph};
use kfrac::grow::Growth;
use kfrac::measure::{LimitSet, exact::dimensions_of_graph};
use kfrac::model::{Model, OutOfRange};
use kfrac::render::{self, Options, Size};

/// Returns the file of a fractal of a size at a position. All numbers of the file are exact.
type File = fn(f64, [f64; 2]) -> String;

/// A Koch curve, a gasket, a fern-like system with a condensation set, a recurrent system and a structure.
const FILES: [File; 5] = [koch, gasket, leaning, recurrent, structure];

fn koch(s: f64, [x, y]: [f64; 2]) -> String {
    let end = x + s;
    format!(
        "initiator: [[{x:e}, {y:e}], [{end:e}, {y:e}]]\n\
         generator: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]\n"
    )
}

/// Returns a map of ratio 1/2 without rotation about a point.
fn half(s: f64, [x, y]: [f64; 2], [a, b]: [f64; 2]) -> String {
    let (x, y) = ((x + s * a) / 2.0, (y + s * b) / 2.0);
    format!("{{matrix: [[0.5, 0], [0, 0.5]], shift: [{x:e}, {y:e}]}}")
}

const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75]];

fn gasket(s: f64, t: [f64; 2]) -> String {
    let maps = CORNERS.map(|corner| half(s, t, corner));
    format!("kind: ifs\nmaps: [{}]\n", maps.join(", "))
}

/// A system with a rotation: a map of ratio 1/2 and a quarter turn about one corner.
fn leaning(s: f64, [x, y]: [f64; 2]) -> String {
    let t = [x, y];
    let turned = format!(
        "{{matrix: [[0, -0.5], [0.5, 0]], shift: [{:e}, {:e}]}}",
        (x + s) + y / 2.0,
        y - (x + s) / 2.0
    );
    let set = format!(
        "{{polyline: [[{:e}, {:e}], [{:e}, {:e}]]}}",
        x,
        y,
        x + s,
        y + s / 4.0
    );
    let maps = [half(s, t, [0.0, 0.0]), turned];
    format!(
        "kind: ifs\nmaps: [{}]\ncondensation: [{set}]\n",
        maps.join(", ")
    )
}

fn recurrent(s: f64, t: [f64; 2]) -> String {
    let maps = CORNERS.map(|corner| half(s, t, corner));
    format!(
        "kind: ifs\nmaps: [{}]\nedges: {{1: [1, 2, 3], 2: [1, 3], 3: [1, 2]}}\n",
        maps.join(", ")
    )
}

fn structure(s: f64, [x, y]: [f64; 2]) -> String {
    let maps = CORNERS.map(|[a, b]| {
        let (x, y) = ((x + s * a) / 2.0, (y + s * b) / 2.0);
        format!("{{object: A, scale: 1/2, translate: [{x:e}, {y:e}]}}")
    });
    let square = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.25]].map(|[a, b]| {
        let (x, y) = (x + s * a, y + s * b);
        format!("[{x:e}, {y:e}]")
    });
    format!(
        "kind: instancing\nobjects: {{A: [{}, {{polygon: [{}]}}]}}\nscene: [A]\n",
        maps.join(", "),
        square.join(", ")
    )
}

fn model(text: &str) -> Model {
    let source = Source::new("place.yaml", text);
    let document =
        Document::read(&source, &Catalogue::embedded()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let resolved = document.resolve(&[]);
    resolved.unwrap_or_else(|e| panic!("{e:?}\n{text}")).0
}

fn near(text: &str, steps: u32) -> Graph {
    let model = model(text);
    let graph = model.compile_normalised(steps, 0, Model::MAX_ELEMENTS);
    graph.unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const STEPS: u32 = 4;

fn picture(graph: &Graph, format: render::Format) -> Vec<u8> {
    let options = Options::default()
        .format(format)
        .size(Size::Long(64))
        .threads(NonZero::<usize>::MIN);
    let mut bytes = Vec::new();
    render::write(graph, &Growth::steps(STEPS), &options, &mut bytes).unwrap();
    bytes
}

fn rows(graph: &Graph) -> Vec<Vec<f64>> {
    let mut text = Vec::new();
    let threads = NonZero::<usize>::MIN;
    export::write(
        graph,
        &Growth::steps(2),
        TableFormat::Csv,
        threads,
        &mut text,
    )
    .unwrap();
    let text = String::from_utf8(text).unwrap();
    let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
    let rows = text.lines().skip(1);
    rows.map(|row| row.split(',').map(number).collect())
        .collect()
}

fn dimension(graph: &Graph) -> Option<f64> {
    dimensions_of_graph(graph).dimensions?.hausdorff.value
}

#[test]
fn scale_and_place_change_no_picture_and_no_dimension() {
    let two = |exponent: i32| 2f64.powi(exponent);
    for file in FILES {
        let here = near(&file(1.0, [0.0; 2]), STEPS);
        assert!(here.place().is_identity());
        let pictures =
            [render::Format::Png, render::Format::Svg].map(|it| (it, picture(&here, it)));
        let boxes = LimitSet::of(&here).map(|set| set.bounds().size());
        for (s, t) in [
            (two(-995), [0.0; 2]),
            (two(-500), [0.0; 2]),
            (two(-67), [two(-50), -two(-49)]),
            (1.0, [two(38), -two(36)]),
            (two(50), [two(70), two(80)]),
            (two(512), [0.0; 2]),
            (two(995), [0.0, two(1010)]),
        ] {
            let text = file(s, t);
            let there = near(&text, STEPS);
            for (format, expected) in &pictures {
                let drawn = picture(&there, *format);
                assert!(drawn == *expected, "{format:?} of\n{text}");
            }
            assert_eq!(dimension(&there), dimension(&here), "{text}");
            let set = LimitSet::of(&there).map(|set| set.bounds().size());
            assert_eq!(set, boxes, "{text}");
        }
    }
}

#[test]
fn numbers_in_tables_are_those_of_the_file() {
    let (s, t) = (2f64.powi(-900), [2f64.powi(-890), 2f64.powi(-880)]);
    for file in FILES {
        let here = rows(&near(&file(1.0, [0.0; 2]), STEPS));
        let there = near(&file(s, t), STEPS);
        assert!(!there.place().is_identity());
        let bounds = there.bounds(2).map(|bounds| there.place().bounds(&bounds));
        if let Some(bounds) = bounds {
            assert!((bounds.min().x / s - 1024.0).abs() < 2.0, "{bounds:?}");
        }
        for (one, other) in here.iter().zip(rows(&there)) {
            // The images of (0, 0) and (1, 0) of the file's plane depend on the linear parts, not on the
            // position.
            if one.len() > 10 {
                assert_eq!(one[10..14], other[10..14]);
                let linear = [[one[10], one[12]], [one[11], one[13]]];
                for (row, (shift, linear)) in one[14..].iter().zip(linear).enumerate() {
                    let moved = linear[0] * t[0] + linear[1] * t[1];
                    let expected = shift * s + t[row] - moved;
                    assert!((other[14 + row] - expected).abs() <= 1e-9 * s, "{other:?}");
                }
                continue;
            }
            for column in [3, 4, 5, 6] {
                let expected = one[column] * s + t[(column + 1) % 2];
                assert!((other[column] - expected).abs() < 1e-9 * s, "{other:?}");
            }
        }
    }
}

#[test]
fn windows_are_those_of_the_file() {
    let place = Homothety::new(-40, DVec2::new(0.5, -0.25));
    let view = kfrac::style::View {
        window: Some([0.5, -0.25, 2f64.powi(-40), 2f64.powi(-41)]),
        margin: Some(3.0),
    };
    assert_eq!(view.within(&place).window, Some([0.0, 0.0, 1.0, 0.5]));
}

#[test]
fn what_doubles_do_not_hold_is_refused() {
    for file in FILES {
        for (s, t) in [(1e301, 0.0), (1e-301, 0.0), (1.0, 3e12), (1e-20, 1e-7)] {
            let error = model(&file(s, [t, 0.0])).place().unwrap_err();
            match error {
                OutOfRange::Size { size } => assert!(t == 0.0 && (size / s - 1.0).abs() < 0.5),
                OutOfRange::Distance { distance, .. } => assert!(t > 0.0 && distance < 1.1 * t),
                _ => panic!("{error}"),
            }
        }
        assert!(model(&file(1e-300, [0.0; 2])).place().is_ok());
        assert!(model(&file(1e300, [0.0; 2])).place().is_ok());
        assert!(model(&file(1.0, [2e11, 0.0])).place().is_ok());
    }
}

#[test]
fn what_grows_beyond_the_range_of_numbers_is_refused() {
    let text = "initiator: segment\ngenerator:\n  - {from: [0, 0], to: [1/2, 0], fertile: false}\n  \
                - {from: [1/2, 0], to: [1e10, 1e10]}\n";
    let model = model(text);
    let options = |format| Options::default().format(format).size(Size::Long(64));
    let draw = |graph: &Graph, steps, format| {
        let mut bytes = Vec::new();
        let growth = Growth::steps(steps);
        render::write(graph, &growth, &options(format), &mut bytes).map(|picture| picture.size)
    };
    // Every step is 10^10 times as large as the preceding one, and rotated by an eighth of a turn.
    let shape = |steps| {
        let graph = model
            .compile_normalised(steps, 0, Model::MAX_ELEMENTS)
            .unwrap();
        draw(&graph, steps, render::Format::Png).unwrap()
    };
    assert_eq!(shape(2), [16, 64]);
    assert_eq!(shape(18), [16, 64]);
    assert_eq!(shape(26), [16, 64]);
    // There is no graph, and so no file of any format.
    for steps in [31, 33, 40, 200] {
        let error = model.compile_normalised(steps, 0, Model::MAX_ELEMENTS);
        let refused = CompileError::OutOfRange(OutOfRange::Growth { step: steps });
        assert_eq!(error.unwrap_err(), refused);
    }
    // Where numbers are drawn, the grown elements decide.
    let drawn = text.replace(
        "generator:\n",
        "generator:\n  random:\n    r: uniform(0, 1)\n  elements:\n",
    );
    let drawn = drawn.replace("1e10, 1e10", "1e10, 1e10 + r");
    let graph = near(&drawn, 40);
    for format in [render::Format::Png, render::Format::Svg] {
        let error = draw(&graph, 40, format).unwrap_err().to_string();
        assert!(error.contains("beyond the range of numbers"), "{error}");
    }
    let (threads, growth) = (NonZero::<usize>::MIN, Growth::steps(40));
    let error = export::write(&graph, &growth, TableFormat::Csv, threads, &mut Vec::new());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("beyond the range of numbers"), "{error}");
}
