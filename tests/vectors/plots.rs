//! Plots: nothing is drawn twice, nothing is omitted, and the pen is carried over short distances.

use std::collections::BTreeSet;
use std::num::NonZero;

use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{Format, Hatch, HatchPattern, Options, Pens, Size};
use kfrac::style::{ColorBy, Colour};

use super::readers::read;
use super::{Read, bounds, common, draw, length, library, plot, total, written};

const FORMATS: [Format; 5] = [
    Format::Svg,
    Format::Pdf,
    Format::Dxf,
    Format::Hpgl,
    Format::GCode,
];

/// An edge on a lattice, from its lesser end.
type Edge = [[i64; 2]; 2];

/// Returns lines between points of a lattice in its unit, relative to the lower left corner of all.
fn on_lattice(edges: impl IntoIterator<Item = [[f64; 2]; 2]>, unit: f64) -> Vec<Edge> {
    let edges: Vec<_> = edges.into_iter().collect();
    let least = |axis: usize| {
        let ends = edges.iter().flatten().map(|end| end[axis]);
        ends.fold(f64::INFINITY, f64::min)
    };
    let low = [least(0), least(1)];
    let place = |end: [f64; 2]| {
        [0, 1].map(|axis| {
            let steps = (end[axis] - low[axis]) / unit;
            let whole = steps.round();
            // HP-GL rounds to fortieths of a millimetre.
            assert!((steps - whole).abs() < 0.02, "{steps}");
            #[expect(clippy::cast_possible_truncation, reason = "a whole number")]
            let whole = whole as i64;
            whole
        })
    };
    let edge = |[from, to]: [[f64; 2]; 2]| {
        let [from, to] = [place(from), place(to)];
        [from.min(to), from.max(to)]
    };
    edges.into_iter().map(edge).collect()
}

/// Lévy's curve at step 10 has edges of one length on a lattice, many of them more than once.
#[test]
fn coincident_edges_are_drawn_once() {
    let levy = library("levy");
    let graph = Graph::compile(&levy, 10).unwrap();
    let grown = common::grown(&graph, &Growth::steps(10));
    let elements = grown.iter().flat_map(|fractal| &fractal.elements);
    let lines = elements.map(|element| element.frame.ends().map(|end| [end.x, -end.y]));
    let lines: Vec<_> = lines.collect();
    let all = on_lattice(lines.iter().copied(), 1.0 / 32.0);
    let expected: BTreeSet<_> = all.iter().copied().collect();
    assert_eq!(all.len() - expected.len(), 109);
    for format in FORMATS {
        let (picture, bytes) = plot(&levy, 10, format);
        let plotted = picture.plotted.unwrap();
        let strokes = read(format, &bytes);
        let edges: Vec<_> = strokes.iter().flat_map(Read::edges).collect();
        let unit = edges.iter().copied().map(length).sum::<f64>() / edges.len() as f64;
        let drawn = on_lattice(edges, unit);
        let once: BTreeSet<_> = drawn.iter().copied().collect();
        assert_eq!(drawn.len(), once.len(), "{format:?}");
        assert_eq!(once, expected, "{format:?}");
        assert_eq!(plotted.repeated, 109);
        assert_eq!(plotted.strokes, strokes.len() as u64);
        assert!((total(&strokes) - plotted.drawn).abs() < 1e-3 * plotted.drawn);
    }
}

#[test]
fn edges_that_overlap_in_part_are_drawn_once() {
    // From 0 to 3, and on from 2 to 5; at an angle, so that rounding matters.
    for angle in ["0", "17", "45", "61.3"] {
        let text = format!(
            "params: {{a: {angle}}}\n\
             initiator: [{{from: [0, 0], to: [3*cos(a), 3*sin(a)]}}, \
             {{from: [5*cos(a), 5*sin(a)], to: [2*cos(a), 2*sin(a)], connected: false}}]\n\
             generator: [[0, 0], [1/2, 0], [1, 0]]"
        );
        let rule = written(&text);
        for steps in [0, 3] {
            let (picture, bytes) = plot(&rule, steps, Format::Dxf);
            let strokes = read(Format::Dxf, &bytes);
            let [left, top, right, bottom] = bounds(&strokes);
            let whole = (right - left).hypot(bottom - top);
            assert!((total(&strokes) - whole).abs() < 0.02, "{angle}, {steps}");
            assert!(picture.plotted.unwrap().repeated > 0);
            assert_eq!(strokes.len(), 1, "{angle}, {steps}");
        }
    }
}

#[test]
fn the_pen_is_not_carried_farther_than_before() {
    for (name, steps) in [
        ("levy", 12),
        ("pythagoras", 7),
        ("monkeys-tree", 3),
        ("pythagoras-squares", 6),
    ] {
        let rule = library(name);
        let (picture, bytes) = plot(&rule, steps, Format::Dxf);
        let plotted = picture.plotted.unwrap();
        assert!(plotted.carried <= plotted.carried_as_drawn, "{name}");
        // As the reader computes it, from the first stroke on.
        let mut at = None;
        let mut carried = 0.0;
        for stroke in read(Format::Dxf, &bytes) {
            carried += at.map_or(0.0, |at| length([at, stroke.vertices[0]]));
            let closed = stroke.closed;
            at = Some(stroke.vertices[if closed { 0 } else { stroke.vertices.len() - 1 }]);
        }
        let difference = (carried - plotted.carried).abs();
        assert!(difference < 1e-3 * carried.max(1.0), "{name}");
    }
}

#[test]
fn outlines_of_what_is_filled_are_strokes() {
    let square = "initiator: segment\ngenerator: [[0, 0], [1/2, 0], [1, 0]]\n\
                  base_element: {points: [[0, 0], [1, 0], [1, 1], [0, 1]], closed: true}";
    for format in FORMATS {
        let (_, bytes) = plot(&written(square), 2, format);
        let strokes = read(format, &bytes);
        // Four squares in a row of 200 mm: 13 edges, which take three strokes.
        let side = (bounds(&strokes)[2] - bounds(&strokes)[0]) / 4.0;
        let rounding = if format == Format::Hpgl { 0.4 } else { 0.05 };
        assert!(
            (total(&strokes) - 13.0 * side).abs() < rounding,
            "{strokes:?}"
        );
    }
}

#[test]
fn colours_are_layers() {
    let rule = library("pythagoras");
    let draw = |format| {
        draw(&rule, 4, |options| {
            options.format = format;
            options.plot = true;
            options.style.color_by = ColorBy::Step;
        })
    };
    let (picture, bytes) = draw(Format::Svg);
    let layers = usize::try_from(picture.plotted.unwrap().layers).unwrap();
    assert!(layers > 1);
    let text = String::from_utf8(bytes).unwrap();
    assert_eq!(top_level_layers(&text).len(), layers);
    for format in FORMATS {
        let (_, bytes) = draw(format);
        let mut inks: Vec<_> = read(format, &bytes).into_iter().map(|it| it.ink).collect();
        inks.dedup();
        // One ink after another, each only once.
        assert_eq!(inks.len(), layers, "{format:?}");
    }
}

/// Returns the labels of a plot's layers, and asserts the conventions of programs for plotters: layers lie at
/// the top of the document, nothing else is drawn, and names begin with the number of the pen.
fn top_level_layers(svg: &str) -> Vec<String> {
    let inkscape = "http://www.inkscape.org/namespaces/inkscape";
    let document = roxmltree::Document::parse(svg).unwrap();
    let groups: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "g")))
        .collect();
    let mut labels = Vec::new();
    for (number, group) in (1..).zip(&groups) {
        assert_eq!(group.parent(), Some(document.root_element()));
        assert_eq!(group.attribute((inkscape, "groupmode")), Some("layer"));
        assert_eq!(group.attribute("id"), Some(&*format!("layer{number}")));
        let label = group.attribute((inkscape, "label")).unwrap();
        assert!(label.starts_with(&format!("{number} #")), "{label}");
        labels.push(label.to_owned());
    }
    let is_path = |node: &roxmltree::Node<'_, '_>| node.tag_name().name() == "path";
    let mut paths = document.descendants().filter(is_path);
    assert!(paths.all(|path| groups.contains(&path.parent().unwrap())));
    labels
}

#[test]
fn pens_share_colours() {
    let levy = library("levy");
    let draw = |format, pens| {
        draw(&levy, 9, |options| {
            options.format = format;
            options.plot = true;
            options.style.color_by = ColorBy::Index;
            options.pens = pens;
        })
    };
    let at_most = |pens| Pens::AtMost(NonZero::new(pens).unwrap());
    let (whole, _) = draw(Format::Dxf, Pens::Each);
    let whole = whole.plotted.unwrap();
    assert_eq!((whole.layers, whole.colours), (64, 64));
    for (pens, layers) in [(Pens::Few, 1), (at_most(1), 1), (at_most(10), 10)] {
        for format in FORMATS {
            let (picture, bytes) = draw(format, pens);
            let plotted = picture.plotted.unwrap();
            assert_eq!((plotted.layers, plotted.colours), (layers, 64));
            assert_eq!(plotted.pens.len() as u64, layers);
            for (part, whole) in [
                (
                    plotted.pens.iter().map(|pen| pen.drawn).sum::<f64>(),
                    plotted.drawn,
                ),
                (
                    plotted.pens.iter().map(|pen| pen.carried).sum(),
                    plotted.carried,
                ),
            ] {
                assert!((part - whole).abs() < 1e-9 * whole);
            }
            // Everything is drawn.
            assert!((plotted.drawn - whole.drawn).abs() < 1e-6 * whole.drawn);
            assert!(plotted.carried <= plotted.carried_as_drawn);
            let strokes = read(format, &bytes);
            let mut inks: Vec<_> = strokes.iter().map(|it| it.ink.clone()).collect();
            inks.dedup();
            assert_eq!(inks.len() as u64, layers, "{format:?}");
            match format {
                Format::Svg => {
                    let labels = top_level_layers(std::str::from_utf8(&bytes).unwrap());
                    assert_eq!(labels.len() as u64, layers);
                }
                Format::Dxf => {
                    let starts =
                        |(number, ink): (u64, &String)| ink.starts_with(&format!("{number}_"));
                    assert!((1..).zip(&inks).all(starts), "{inks:?}");
                }
                _ => {}
            }
        }
    }
}

#[test]
fn what_lies_outside_of_the_page_is_not_drawn() {
    let koch = library("koch");
    let (_, bytes) = draw(&koch, 5, |options: &mut Options| {
        options.format = Format::Dxf;
        options.size = Size::Exactly(400, 200);
        options.view.window = Some([0.3, 0.1, 0.4, 0.2]);
    });
    let pixel = 25.4 / 96.0;
    let [left, top, right, bottom] = bounds(&read(Format::Dxf, &bytes));
    assert!(left >= -1e-6 && top >= -1e-6, "{left} {top}");
    assert!(right <= 400.0 * pixel + 1e-6 && bottom <= 200.0 * pixel + 1e-6);
    assert!(right - left > 300.0 * pixel);
}

#[test]
fn plots_are_the_same_on_any_number_of_threads() {
    let levy = library("levy");
    for format in FORMATS {
        let with = |threads: usize| {
            draw(&levy, 13, |options| {
                options.format = format;
                options.plot = true;
                options.style.stroke = Some(Colour::BLACK);
                options.threads = NonZero::new(threads).unwrap();
            })
        };
        let one = with(1);
        assert!(one == with(2) && one == with(3), "{format:?}");
    }
}

/// Machines get their own commands, and stop for a change of the pen.
#[test]
fn machines_have_their_commands() {
    let rule = library("pythagoras");
    let (picture, bytes) = draw(&rule, 4, |options| {
        options.format = Format::GCode;
        options.style.color_by = ColorBy::Step;
        options.machine.feed = 800.0;
        options.machine.pen_up = "M3 S0".into();
        options.machine.pen_down = "M3 S90".into();
    });
    let plotted = picture.plotted.unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let count = |line: &str| text.lines().filter(|it| *it == line).count() as u64;
    assert_eq!(count("M3 S90"), plotted.strokes);
    assert_eq!(count("M3 S0"), plotted.strokes + 1);
    assert_eq!(count("G1 F800"), plotted.strokes);
    assert_eq!(count("M0"), plotted.layers - 1);
    assert!(plotted.layers > 1 && !text.contains('Z'));
}

/// Squares of side 2 from (0, 0) and from (1, 1), the second above the first.
const TWO_SQUARES: &str = "initiator: [{from: [0, 0], to: [2, 0]}, {from: [1, 1], to: [3, 1], connected: false}]\n\
     generator: [[0, 0], [1/2, 0], [1, 0]]\n\
     base_element: {points: [[0, 0], [1, 0], [1, 1], [0, 1]], closed: true}";

/// Returns the length of all strokes of the two squares, in half sides.
fn drawn_of_squares(settings: impl Fn(&mut Options)) -> (f64, kfrac::render::Plotted) {
    let (picture, bytes) = draw(&written(TWO_SQUARES), 0, |options| {
        options.format = Format::Dxf;
        settings(options);
    });
    let strokes = read(Format::Dxf, &bytes);
    let [left, _, right, _] = bounds(&strokes);
    (
        total(&strokes) / ((right - left) / 3.0),
        picture.plotted.unwrap(),
    )
}

#[test]
fn filled_shapes_hide_what_lies_under_them() {
    let (drawn, plotted) = drawn_of_squares(|_| {});
    assert!((drawn - 14.0).abs() < 0.01, "{drawn}");
    assert_eq!(plotted.hidden, 2);
    let (drawn, plotted) = drawn_of_squares(|options| options.occlude = false);
    assert!((drawn - 16.0).abs() < 0.01, "{drawn}");
    assert_eq!(plotted.hidden, 0);
    // Translucent fills hide nothing, and lines are not areas.
    let clear = |options: &mut Options| {
        options.style.fill = Some(Colour::parse("#ff000080").unwrap());
    };
    assert_eq!(drawn_of_squares(clear).1.hidden, 0);
    let levy = library("levy");
    assert_eq!(plot(&levy, 8, Format::Dxf).0.plotted.unwrap().hidden, 0);
}

/// The visible area of the two squares is 7 squares of half the side.
#[test]
fn hatching_covers_what_is_visible() {
    let outlines = drawn_of_squares(|_| {}).0;
    // A side of a half takes 512 units.
    let size = |options: &mut Options, spacing: f64| {
        options.size = Size::Long(1536);
        options.hatch.as_mut().unwrap().spacing = spacing;
    };
    for (directions, times) in [(vec![45.0], 1.0), (vec![0.0, 30.0, 117.0], 3.0)] {
        let (drawn, _) = drawn_of_squares(|options| {
            options.hatch = Some(Hatch::new(HatchPattern::Lines(directions.clone()), 1.0));
            size(options, 8.0);
        });
        let covered = (drawn - outlines) * 8.0 / 512.0;
        assert!((covered / (7.0 * times) - 1.0).abs() < 0.02, "{covered}");
    }
    // Contours of the squares at 1/8 of a half side; the second hides a quarter of those of the first.
    let (drawn, _) = drawn_of_squares(|options| {
        options.hatch = Some(Hatch::new(HatchPattern::Contour, 1.0));
        size(options, 64.0);
    });
    let sides = (1..8).map(|ring| 8.0 - f64::from(ring)).sum::<f64>();
    let expected = outlines + sides * (1.0 + 3.0 / 4.0);
    assert!((drawn - expected).abs() < 0.05, "{drawn} of {expected}");
    // Areas in the colour of the paper stay empty.
    let (drawn, plotted) = drawn_of_squares(|options| {
        options.hatch = Some(Hatch::new(HatchPattern::Contour, 8.0));
        options.style.fill = Some(Colour::WHITE);
    });
    assert!((drawn - outlines).abs() < 0.01);
    assert_eq!(plotted.hidden, 2);
}

#[test]
fn the_command_line_hatches() {
    let folder = tempfile::tempdir().unwrap();
    let run = |line: &str| common::run(folder.path(), line);
    let (is_done, said) = run(
        "grow pythagoras-squares --steps 6 --plot --hatch 30,120deg --hatch-spacing 2mm -o a.svg",
    );
    assert!(
        is_done && said.contains("hidden in whole or in part"),
        "{said}"
    );
    let svg = std::fs::read_to_string(folder.path().join("a.svg")).unwrap();
    assert!(svg.contains("--hatch=30deg,120deg") && svg.contains("--hatch-spacing=2mm"));
    let (is_done, said) = run("grow a.svg --occlude no -o b.hpgl");
    assert!(is_done && !said.contains("hidden"), "{said}");
    for (line, expected) in [
        (
            "menger --plot --hatch cross -o a.svg",
            "is not for its faces",
        ),
        ("koch --hatch 45deg -o a.svg", "applies to plots"),
        (
            "koch --plot --hatch-spacing 1mm -o a.svg",
            "add --hatch 45deg",
        ),
        (
            "koch --plot --hatch tartan -o a.svg",
            "or cross, or contour",
        ),
        ("koch --plot --occlude maybe -o a.svg", "expected yes or no"),
        (
            "koch --plot --hatch cross --hatch-spacing 0 -o a.svg",
            "at least 0.1 pixels",
        ),
    ] {
        let (is_done, said) = run(&format!("grow {line}"));
        assert!(!is_done && said.contains(expected), "{line}: {said}");
    }
}
