//! Actions of the turtle.

use kfrac::geometry::DVec2;
use kfrac::lsystem::{Drawing, Placed};
use kfrac::model::Model;
use kfrac::style::{ColorBy, Palette};

use super::{MOST, system};

/// Returns the drawing of an axiom, with additional keys in the file.
fn drawn(axiom: &str, more: &str) -> Drawing {
    let system = system(&format!("axiom: \"{axiom}\"\nproductions: {{}}\n{more}"));
    system.draw(&system.word(0, 0, MOST).unwrap())
}

fn ends(placed: &Placed) -> [[f64; 2]; 2] {
    placed.frame.ends().map(|end| end.to_array())
}

/// Hart 1992, word (4): the outline of a plus sign, of area 5.
#[test]
fn a_word_outlines_a_plus_sign() {
    let drawing = drawn("F+F-F-F+F-F-F+F-F-F+F-F", "");
    assert_eq!(drawing.elements.len(), 12);
    let area: f64 = { drawing.elements.iter() }
        .map(|element| {
            let [from, to] = element.frame.ends();
            from.perp_dot(to) / 2.0
        })
        .sum();
    assert_eq!(area.abs(), 5.0);
    assert_eq!(ends(&drawing.elements[11])[1], [0.0, 0.0]);
    let joined: Vec<_> = drawing
        .elements
        .iter()
        .map(|element| element.joined)
        .collect();
    assert!(!joined[0] && joined[1..].iter().all(|joined| *joined));
}

/// 4999 turns by a sixth or a seventh of a full turn equal one such turn exactly.
#[test]
fn headings_stay_exact() {
    for (angle, turns) in [
        ("60", 4999),
        ("360/7", 4999),
        ("25.7", 3601),
        ("-0.1", 7201),
    ] {
        let more = format!("angle: {angle}\n");
        let many = drawn(&("+".repeat(turns) + "F"), &more);
        let one = drawn("+F", &more);
        assert_eq!(ends(&many.elements[0]), ends(&one.elements[0]), "{angle}");
    }
}

#[test]
fn default_symbols_are_those_of_the_book() {
    let drawing = drawn("F(2)f+F|F", "heading: 90\nlength: 10\n");
    let all: Vec<_> = drawing.elements.iter().map(ends).collect();
    assert_eq!(
        all,
        [
            [[0.0, 0.0], [0.0, 20.0]],
            [[0.0, 30.0], [-10.0, 30.0]],
            [[-10.0, 30.0], [0.0, 30.0]],
        ]
    );
    let joined: Vec<_> = drawing
        .elements
        .iter()
        .map(|element| element.joined)
        .collect();
    assert_eq!(joined, [false, false, true]);
}

#[test]
fn brackets_take_back_the_whole_state() {
    let drawing = drawn("!F['(3)!+F(2)]F'F", "angle: 30\nthinning: 0.5\n");
    let all: Vec<_> = { drawing.elements.iter() }
        .map(|element| (element.width, element.colour, element.joined))
        .collect();
    assert_eq!(
        all,
        [
            (0.5, 0, false),
            (0.25, 3, false),
            (0.5, 0, false),
            (0.5, 1, false)
        ]
    );
    assert_eq!(ends(&drawing.elements[2]), [[1.0, 0.0], [2.0, 0.0]]);
}

#[test]
fn a_reflected_turtle_turns_the_other_way_round() {
    let more = "symbols: {R: reflect, S: {scale: 1/2}}\n";
    let drawing = drawn("+FR+FS+F", more);
    let all: Vec<_> = drawing.elements.iter().map(ends).collect();
    assert_eq!(
        all,
        [
            [[0.0, 0.0], [0.0, 1.0]],
            [[0.0, 1.0], [1.0, 1.0]],
            [[1.0, 1.0], [1.0, 0.5]],
        ]
    );
}

#[test]
fn a_symbol_may_do_several_things_with_its_arguments() {
    let more = "params: {a: 90}\nsymbols: {\"B(s)\": [push, {turn: a, draw: s}, pop]}\n";
    let drawing = drawn("B(2)B(3)", more);
    let all: Vec<_> = drawing.elements.iter().map(ends).collect();
    assert_eq!(all, [[[0.0, 0.0], [0.0, 2.0]], [[0.0, 0.0], [0.0, 3.0]]]);
}

/// The leaf of figure 1.25 is a hexagon that closes itself; inside a polygon no lines are drawn.
#[test]
fn polygons_are_filled() {
    let drawing = drawn("F{-f+f+f-|-f+f+f}F[+{F+F+F}]", "angle: 60\n");
    let polygons: Vec<_> = drawing
        .elements
        .iter()
        .filter(|it| it.polygon().is_some())
        .collect();
    assert_eq!((drawing.elements.len(), polygons.len()), (4, 2));
    let leaf = &drawing.polygons[polygons[0].polygon().unwrap()];
    assert_eq!(leaf.pieces().len(), 6);
    assert!(leaf.is_closed());
    let area = leaf.signed_area().abs();
    assert!((area - 6.75f64.sqrt()).abs() < 1e-12, "{area}");
    assert_eq!(polygons[0].frame.origin(), DVec2::X);
}

/// Equal polygons share an outline, regardless of their frames.
#[test]
fn equal_polygons_are_one() {
    let word = "{f+f+f}f+S{f+f+f}R{f+f+f}[{ff+f+f}]";
    let more = "angle: 120\nsymbols: {R: reflect, S: {scale: 0.3}}\n";
    let drawing = drawn(word, more);
    assert_eq!((drawing.elements.len(), drawing.polygons.len()), (4, 2));
}

/// Figure 5.5: brackets end while polygons that began in them are open.
#[test]
fn polygons_and_brackets_may_cross() {
    let drawing = drawn("[+{.]G.+G.}", "symbols: {G: glide}\n");
    assert_eq!(drawing.polygons.len(), 1);
    let placed = drawing.elements[0];
    let outline = &drawing.polygons[0];
    let start = placed.frame.apply(outline.start());
    let others = outline.pieces().iter();
    let all: Vec<_> = others.map(|p| placed.frame.apply(p.end())).collect();
    assert_eq!(start, DVec2::ZERO);
    assert_eq!(all, [DVec2::X, DVec2::ONE, DVec2::ZERO]);
}

#[test]
fn what_has_no_extent_is_no_element() {
    let drawing = drawn("F(0){f}{}{ff}F", "");
    assert_eq!(drawing.elements.len(), 1);
}

/// Colours are those of the palette, with indices that wrap around, and the file is drawn with them.
#[test]
fn colours_are_those_of_the_palette() {
    let drawn = |palette: &str| {
        let text = format!(
            "axiom: \"F'F'(-1)F'(4)F\"\nproductions: {{}}\nstyle: {{palette: {palette}}}\n"
        );
        let model = Model::LSystem(system(&text));
        let graph = model.compile(0).unwrap();
        assert_eq!(model.metadata().style.color_by, ColorBy::Tint);
        let instances = graph.initiator(0).instances.iter();
        let colour = |object: usize| graph.objects()[object].paint.unwrap().to_string();
        instances
            .map(|instance| colour(instance.object))
            .collect::<Vec<_>>()
    };
    let [red, lime, blue] = ["#ff0000", "#00ff00", "#0000ff"];
    assert_eq!(drawn("[red, lime, blue]"), [red, lime, blue, lime]);
    assert_eq!(
        drawn("viridis")[1],
        Palette::named("viridis").unwrap().at(1.0 / 7.0).to_string()
    );
}

/// A symbol whose meaning is a whole polygon differs from another such symbol.
#[test]
fn polygons_of_one_symbol_are_told_apart() {
    let outline = |corners: u16| {
        let sides = format!("draw, {{turn: {}}}, ", 360 / corners).repeat(corners.into());
        format!("[open, {sides}close]")
    };
    let symbols = format!("symbols: {{P: {}, Q: {}}}\n", outline(3), outline(4));
    let drawing = drawn("PQP", &symbols);
    let numbers = drawing.elements.iter().map(|element| element.polygon());
    assert_eq!(numbers.collect::<Vec<_>>(), [Some(0), Some(1), Some(0)]);
    assert_eq!(drawing.polygons.len(), 2);
}

/// A polygon of fewer than three vertices is ignored, and the lines before and after it do not meet.
#[test]
fn ignored_polygons_lift_the_pen() {
    for (text, steps) in [
        ("axiom: \"F{+F-}F\"\nproductions: [\"A -> B\"]", 0),
        (
            "axiom: \"AF{+F-}F\"\nproductions: [\"F < A -> B\", \"A -> A\"]",
            1,
        ),
        ("axiom: \"A{+A-}A\"\nproductions: [\"A -> F\"]", 1),
    ] {
        let text = format!("kind: lsystem\nangle: 90\n{text}\n");
        let svg = kfrac::Fractal::parse(&text)
            .unwrap()
            .steps(steps)
            .svg()
            .unwrap();
        let paths = svg
            .split(" d=\"")
            .skip(1)
            .map(|it| it.split('"').next().unwrap());
        let lines: usize = paths.map(|path| path.matches(['M', 'm']).count()).sum();
        assert_eq!(lines, 2, "{svg}");
    }
}
