//! SVG path data of small rules, to the letter.

use crate::common;
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{self, Options, Size};

/// Returns the path elements of a picture 100 pixels wide, without the margin of strokes.
fn paths(text: &str, steps: u32) -> Vec<String> {
    let svg = picture(text, steps, "");
    let elements = svg.split("<path ").skip(1);
    elements
        .map(|element| element[..element.find("/>").unwrap()].replace('\n', " "))
        .collect()
}

fn picture(text: &str, steps: u32, style: &str) -> String {
    let style = if style.is_empty() {
        "style: {width: 0}".to_owned()
    } else {
        style.to_owned()
    };
    let text = if text.contains("style:") {
        text.to_owned()
    } else {
        format!("{text}\n{style}\n")
    };
    let rule = common::resolved(&common::document_of(&text), &[]);
    let graph = Graph::compile(&rule, steps).unwrap();
    let mut bytes = Vec::new();
    let options = Options::default()
        .size(Size::Long(100))
        .style(rule.style().clone());
    render::write(&graph, &Growth::steps(steps), &options, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

const CHAIN: &str = "initiator: segment\ngenerator: [[0, 0], [1/4, 1/4], [3/4, 1/4], [1, 0]]";

#[test]
fn a_chain_is_one_path_without_doubled_vertices() {
    assert_eq!(
        paths(CHAIN, 1),
        ["d=\"M0 2500l2500-2500 5000 0 2500 2500\""]
    );
}

#[test]
fn a_ring_is_closed_and_its_last_vertex_is_not_written_twice() {
    let square = "initiator: square\ngenerator: [[0, 0], [1/2, 0], [1, 0]]";
    assert_eq!(
        paths(square, 0),
        ["d=\"M0 10000l0-10000 10000 0 0 10000z\""]
    );
    assert_eq!(
        paths(square, 1),
        ["d=\"M0 10000l0-5000 0-5000 5000 0 5000 0 0 5000 0 5000-5000 0z\""]
    );
    // A chain that returns to its start is closed, as one with `closed: true` is.
    let written = "initiator: [[0, 0], [0, 1], [1, 1], [1, 0], [0, 0]]\ngenerator: [[0, 0], [1/2, 0], [1, 0]]";
    assert_eq!(paths(written, 1), paths(square, 1));
    let filled = format!("{square}\nstyle: {{width: 0, fill: teal}}");
    assert_eq!(
        paths(&filled, 0),
        ["fill=\"#008080\" d=\"M0 10000l0-10000 10000 0 0 10000z\""]
    );
}

#[test]
fn what_rounds_to_nothing_is_left_out() {
    let thin = "initiator: {closed: true, elements: [[0, 0], [1, 0], [0, 1e-9], [1e-9, 0]]}\n\
                generator: [[0, 0], [1/2, 0], [1, 0]]";
    assert_eq!(paths(thin, 0), ["d=\"M0 800l10000 0z\""]);
    let small = "initiator: [[0, 0], [1, 0], [1, 1e-9]]\ngenerator: [[0, 0], [1/2, 0], [1, 0]]\n\
                 base_element: {points: [[0, 0], {curve: [1, 0], control: [[1/2, 1]]}]}";
    assert_eq!(
        paths(small, 0),
        ["d=\"M0 5000c3333-6667 6667-6667 10000 0\""]
    );
}

#[test]
fn what_is_invisible_or_not_connected_breaks_the_path() {
    let with = |entry: &str| {
        let text = format!("initiator: segment\ngenerator: [[0, 0], [1/4, 1/4], {entry}, [1, 0]]");
        paths(&text, 1)
    };
    assert_eq!(
        with("{to: [3/4, 1/4], visible: false}"),
        ["d=\"M0 2500l2500-2500M7500 0l2500 2500\""]
    );
    assert_eq!(
        with("{to: [3/4, 1/4], connected: false}"),
        ["d=\"M0 2500l2500-2500M2500 0l5000 0 2500 2500\""]
    );
    // The position is equal, but written differently.
    assert_eq!(
        with("{from: [0.25, 1/4], to: [3/4, 1/4]}"),
        ["d=\"M0 2500l2500-2500M2500 0l5000 0 2500 2500\""]
    );
    assert_eq!(with("{from: [1/4, 1/4], to: [3/4, 1/4]}"), paths(CHAIN, 1));
}

#[test]
fn a_ring_with_a_gap_is_not_closed() {
    let text = "initiator: {closed: true, elements: [[0, 0], [0, 1], {to: [1, 1], visible: false}, [1, 0]]}\n\
                generator: [[0, 0], [1/2, 0], [1, 0]]";
    assert_eq!(
        paths(text, 0),
        ["d=\"M0 10000l0-10000M10000 0l0 10000-10000 0\""]
    );
}

#[test]
fn hilberts_cups_are_linked_by_lines() {
    let text = "initiator: segment\nbase_element: hilbert-cup\n\
                generator: [[0, 0], {to: [0, 1/2], direction: 2}, [1/2, 1/2], [1, 1/2], {to: [1, 0], direction: 2}]";
    assert_eq!(paths(text, 0), ["d=\"M0 10000l0-10000 10000 0 0 10000\""]);
    // Order two: sixteen vertices of a grid of four by four, one path.
    let vertices = |path: &str| {
        path.split(['l', ' ', '-'])
            .filter(|number| !number.is_empty())
            .count()
    };
    let found = paths(text, 1);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].matches('M').count(), 1);
    assert!(vertices(&found[0]) >= 16, "{found:?}");
    assert!(
        found[0]
            .starts_with("d=\"M0 10000l3333 0 0-3333-3333 0 0-3334 0-3333 3333 0 0 3333 3334 0"),
        "{found:?}"
    );
}

#[test]
fn polygons_have_one_orientation_whatever_their_direction() {
    let text = "initiator: segment\nbase_element: triangle\ngenerator: {connected: false, elements: [\
                [0, 0], {to: [1/4, 0]}, {to: [1/2, 0], direction: 2}, {to: [3/4, 0], direction: 3}, \
                {to: [1, 0], direction: 4}]}";
    let found = paths(text, 1);
    assert_eq!(found.len(), 1);
    let data = found[0]
        .split(" d=\"")
        .nth(1)
        .unwrap()
        .trim_end_matches('"');
    let polygons: Vec<_> = data
        .split('z')
        .filter(|polygon| !polygon.is_empty())
        .collect();
    assert_eq!(polygons.len(), 4);
    for polygon in polygons {
        let (_, steps) = polygon.split_once('l').unwrap();
        let spaced = steps.replace('-', " -");
        let numbers: Vec<i64> = spaced
            .split_whitespace()
            .map(|number| number.parse().unwrap())
            .collect();
        let [a, b, c, d] = numbers[..] else {
            panic!("{polygon}: a triangle has two steps and a way back")
        };
        // The y axis of a picture points down, so counter-clockwise in the plane is negative.
        assert!(a * d - b * c < 0, "{polygon}");
    }
}

#[test]
fn a_path_breaks_where_its_colour_changes() {
    let style = "style: {width: 0, color_by: generator, palette: [red, blue]}";
    let text = format!(
        "initiator: segment\ngenerator: [[0, 0], {{to: [1/3, 0], fertile: false}}, [2/3, 0], \
         {{to: [1, 0], fertile: false}}]\n{style}"
    );
    assert_eq!(paths(&text, 1), ["d=\"M0 800l3333 0 3334 0 3333 0\""]);
    let by_step = text.replace("generator, palette", "step, palette");
    assert_eq!(
        paths(&by_step, 2),
        [
            "d=\"M0 800l3333 0M6667 800l3333 0\"",
            "d=\"M3333 800l1111 0 1112 0 1111 0\""
        ]
    );
    let svg = picture(&by_step, 2, "");
    assert!(svg.contains("<g stroke=\"#0000ff\">"), "{svg}");
}

/// A palette begins with the initiator only if a part of it is drawn.
#[test]
fn palettes_begin_with_what_is_drawn() {
    let strokes = |ends: &str, steps: u32| {
        let text = format!(
            "initiator: {{connected: false, elements: [{{from: [0, 0], to: [1, 0]}}{ends}]}}\n\
             generators: {{a: [[0, 0], {{to: [1/2, 1/2], use: b}}, [1, 0]], b: [[0, 0], [1/2, 0], [1, 0]]}}\n\
             select: [{{use: a}}]\nstyle: {{color_by: generator, palette: [red, lime, blue]}}"
        );
        let svg = picture(&text, steps, "");
        let groups = svg.split("<g stroke=\"").skip(1);
        let colours = groups.map(|group| group[..7].to_owned());
        colours.collect::<Vec<_>>()
    };
    assert_eq!(strokes("", 0), ["#ff0000"]);
    assert_eq!(strokes("", 1), ["#ff0000"]);
    assert_eq!(strokes("", 2), ["#ff0000", "#0000ff"]);
    let kept = ", {from: [0, 1], to: [1, 1], fertile: false}";
    assert_eq!(strokes(kept, 2), ["#ff0000", "#00ff00", "#0000ff"]);
}

/// Filled elements below a pixel are stroked so that they stay a pixel wide.
#[test]
fn specks_are_stroked() {
    let text = "initiator: segment\nbase_element: triangle\n\
                generator: [{from: [0, 0], to: [1/3, 0]}, {from: [2/3, 0], to: [1, 0]}]\nstyle: {fill: teal}";
    let widths = |steps: u32| -> Vec<f64> {
        let found = paths(text, steps);
        let strokes = found
            .iter()
            .filter_map(|path| path.split("stroke-width=\"").nth(1));
        strokes
            .map(|width| width.split('"').next().unwrap().parse().unwrap())
            .collect()
    };
    assert!(widths(2).is_empty());
    // 100/243 and 100/3^9 pixels.
    assert_eq!(widths(5), [75.0]);
    assert_eq!(widths(9), [100.0]);
}

#[test]
fn strokes_may_be_as_wide_as_their_elements_are_long() {
    let text = "initiator: segment\ngenerator: [[0, 0], [1/2, 0], [3/4, 0], [1, 0]]\nstyle: {width: {relative: 0.1}}";
    let found = paths(text, 1);
    // 100 pixels less the strokes' round ends, in hundredths.
    let widths: Vec<_> = found
        .iter()
        .map(|path| path.split('"').nth(1).unwrap().parse::<f64>().unwrap())
        .collect();
    assert_eq!(found.len(), 2);
    assert!((widths[0] / widths[1] - 2.0).abs() < 1e-3, "{widths:?}");
    assert!((widths[0] / 500.0).log2().abs() < 0.2, "{widths:?}");
}

#[test]
fn the_viewbox_holds_the_strokes() {
    let text = |style: &str| {
        format!("initiator: segment\ngenerator: [[0, 0], [1/2, 1/2], [1, 0]]\nstyle: {style}")
    };
    let view = |style: &str| {
        let svg = picture(&text(style), 1, "");
        let start = svg.find("width=").unwrap();
        svg[start..svg.find('>').unwrap()].to_owned()
    };
    assert_eq!(
        view("{width: 0}"),
        "width=\"100\" height=\"50\" viewBox=\"0 0 10000 5000\""
    );
    assert_eq!(
        view("{width: 10}"),
        "width=\"100\" height=\"55\" viewBox=\"0 0 10000 5500\""
    );
    assert_eq!(
        paths(&text("{width: 10}"), 1),
        ["d=\"M500 5000l4500-4500 4500 4500\""]
    );
    // A mitre may reach four half widths beyond its corner.
    assert_eq!(
        view("{width: 10, join: miter}"),
        "width=\"100\" height=\"70\" viewBox=\"0 0 10000 7000\""
    );
}

#[test]
fn round_pieces_are_curves() {
    let text = "initiator: segment\ngenerator: [[0, 0], [1/2, 0], [1, 0]]\n\
                base_element: {points: [[0, 0], {curve: [1, 0], control: [[1/2, 1]]}]}";
    // The quadratic curve through (1/2, 1/2) becomes a cubic one; the bounds are those of the curve, not of
    // its control points.
    assert_eq!(
        paths(text, 0),
        ["d=\"M0 5000c3333-6667 6667-6667 10000 0\""]
    );
    let svg = picture(text, 0, "");
    assert!(svg.contains("viewBox=\"0 0 10000 5000\""), "{svg}");
    let half_circle = text.replace(
        "{curve: [1, 0], control: [[1/2, 1]]}",
        "{arc: [1, 0], through: [1/2, 1/2]}",
    );
    let svg = picture(&half_circle, 0, "");
    assert!(svg.contains("viewBox=\"0 0 10000 5000\""), "{svg}");
    assert_eq!(paths(&half_circle, 0)[0].matches('c').count(), 1);
}

#[test]
fn relative_strokes_stay_inside_the_picture() {
    for percent in 20..60 {
        let text = format!(
            "initiator: segment\ngenerator: [[0, 0], [1/2, 0], [1, 0]]\nstyle: {{width: {{relative: {percent}/100}}}}"
        );
        let svg = picture(&text, 0, "");
        let width: f64 = svg
            .split("<path stroke-width=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .parse()
            .unwrap();
        let height: f64 = svg
            .split("viewBox=\"0 0 10000 ")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .parse()
            .unwrap();
        assert!(
            width <= height + 0.1 && width > 0.85 * height - 100.0,
            "{percent}: {width} in {height}"
        );
    }
}

#[test]
fn a_closed_chain_is_filled_whatever_strokes_it() {
    let text = |style: &str| {
        format!(
            "initiator: {{closed: true, elements: [[0, 0], [0, 1], {{to: [1, 1], visible: false}}, [1, 0]]}}\n\
             generator: [[0, 0], [1/2, 0], [1, 0]]\nstyle: {{fill: teal, {style}}}"
        )
    };
    let area = "fill=\"#008080\" d=\"M0 10000l0-10000 10000 0 0 10000z\"";
    for style in [
        "width: 0",
        "width: 0, color_by: index",
        "width: 0, color_by: direction",
    ] {
        let found = paths(&text(style), 0);
        assert_eq!(found[0], area);
        assert!(
            found[1..].iter().all(|path| !path.contains("fill")),
            "{found:?}"
        );
    }
    // Strokes of varying width are paths of their own.
    let varied = "initiator: {closed: true, elements: [[0, 0], [1/2, 1], [1, 0]]}\n\
                  generator: [[0, 0], [1/2, 0], [1, 0]]\nstyle: {fill: teal, width: {relative: 0.01}}";
    let found = paths(varied, 1);
    assert_eq!(found.iter().filter(|path| path.contains("fill")).count(), 1);
    assert!(found.len() > 2, "{found:?}");
}
