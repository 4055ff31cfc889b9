//! Tints of structures, systems and rules: pictures agree with the equations of Hart 1992, section 5.

use std::num::NonZero;

use crate::common::{document, document_of};
use kfrac::grow::Growth;
use kfrac::model::Model;
use kfrac::render::{self, Format, Options, Size};
use kfrac::style::{ColorBy, Colour};
use kfrac::tween::TweenBy;

fn picture(model: &Model, steps: u32, change: impl FnOnce(&mut Options)) -> Vec<u8> {
    let graph = model.compile(steps).unwrap();
    let mut options = Options::of(model.metadata()).size(Size::Long(64));
    change(&mut options);
    let mut bytes = Vec::new();
    render::write(&graph, &Growth::steps(steps), &options, &mut bytes).unwrap();
    bytes
}

fn svg(model: &Model, steps: u32) -> String {
    String::from_utf8(picture(model, steps, |_| {})).unwrap()
}

fn model(text: &str) -> Model {
    document_of(text).resolve(&[]).unwrap().0
}

/// Returns the text after each mark up to the next quotation mark.
fn values<'t>(text: &'t str, mark: &str) -> Vec<&'t str> {
    let after = text.split(mark).skip(1);
    after.map(|rest| rest.split('"').next().unwrap()).collect()
}

/// A square that is tinted twice on one path, once on another and not at all on a third.
const SQUARES: &str = "kind: instancing
objects:
  square: [{polygon: [[0, 0], [1, 0], [1, 1], [0, 1]], tint: {color: lime, alpha: 0.5}}]
  plain: [{polygon: [[0, 0], [1, 0], [1, 1]]}]
  pair:
    - {object: square, tint: {color: blue, alpha: 0.25}}
    - {object: plain, translate: [1, 0]}
    - {segment: [[0, 2], [1, 2]], tint: {color: white, alpha: 0.5}}
scene:
  - {object: pair, tint: {color: red, alpha: 0.5}}
  - {object: plain, translate: [0, 3]}
steps: 2
style: {stroke: \"#404040\", fill: none}
";

/// Returns c and α by the paper's equations, from the outermost tint to the innermost, which is opaque.
fn composed(tints: &[([f64; 3], f64)]) -> String {
    let (mut colour, mut alpha) = ([0.0; 3], 0.0);
    for (own, weight) in tints {
        for (value, own) in colour.iter_mut().zip(own) {
            *value += weight * (1.0 - alpha) * own;
        }
        alpha += weight * (1.0 - alpha);
    }
    assert!((alpha - 1.0f64).abs() < 1e-12);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "colours are from 0 to 255"
    )]
    let [red, green, blue] = colour.map(|value| (value + 0.5).floor() as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[test]
fn tints_are_composed_from_the_outermost_inwards() {
    let text = svg(&model(SQUARES), 2);
    let (red, lime, blue) = ([255.0, 0.0, 0.0], [0.0, 255.0, 0.0], [0.0, 0.0, 255.0]);
    let (white, own) = ([255.0; 3], [64.0; 3]);
    let expected = [
        composed(&[(red, 0.5), (blue, 0.25), (lime, 0.5), (own, 1.0)]),
        composed(&[(red, 0.5), (own, 1.0)]),
        "#404040".into(),
    ];
    assert_eq!(values(&text, "<path fill=\""), expected);
    let line = composed(&[(red, 0.5), (white, 0.5), (own, 1.0)]);
    assert_eq!(values(&text, "<g stroke=\""), [line]);
}

#[test]
fn colours_that_are_asked_for_are_not_tinted() {
    let tinted = model(SQUARES);
    assert_eq!(tinted.metadata().style.color_by, ColorBy::Tint);
    let plain = picture(&tinted, 2, |options| options.style.color_by = ColorBy::None);
    let plain = String::from_utf8(plain).unwrap();
    assert!(
        values(&plain, "fill=\"#")
            .iter()
            .all(|colour| *colour == "404040")
    );
    let written = SQUARES.replace("fill: none", "fill: none, color_by: none");
    let written = model(&written);
    assert_eq!(written.metadata().style.color_by, ColorBy::None);
    assert_eq!(svg(&written, 2), plain);
    // Without tints there are no colours to draw by.
    let bare = model("kind: instancing\nobjects: {a: [{point: [0, 0]}]}\nscene: [a]\n");
    assert_eq!(bare.metadata().style.color_by, ColorBy::None);
}

/// Drifts add up along the path of an instance: ten squares, each turned by 36 degrees of hue against the one before.
#[test]
fn drifts_add_up_inwards() {
    let row = |tint: &str, scene: &str| {
        model(&format!(
            "kind: instancing
objects:
  square: [{{polygon: [[0, 0], [1, 0], [1, 1], [0, 1]]}}]
  row(0): [square]
  row(n): [square, {{object: row(n - 1), scale: 0.9, translate: [1, 0], tint: {{{tint}}}}}]
scene: [{{object: row(9), tint: {{{scene}}}}}]
style: {{fill: navy}}
"
        ))
    };
    let turned = |degrees: i32| {
        let colour = Colour::parse(&format!("hsl({degrees}, 100%, 50%)")).unwrap();
        colour.to_string()
    };
    // The scene covers the colour of the style, and the row starts from it.
    let text = svg(&row("hue: 36", "color: red"), 12);
    let expected: Vec<_> = (0..10).map(|number| turned(36 * number)).collect();
    assert_eq!(values(&text, "<path fill=\""), expected);
    // Shares of the way to white leave 0.8^k of it.
    let text = svg(&row("lightness: 0.2", "color: black, alpha: 1"), 12);
    let grey = |number: i32| {
        let value = (255.0 * (1.0 - 0.8f64.powi(number))).round();
        format!("rgb({value}, {value}, {value})")
    };
    let expected: Vec<_> = (0..10)
        .map(|number| Colour::parse(&grey(number)).unwrap().to_string())
        .collect();
    assert_eq!(values(&text, "<path fill=\""), expected);
    let text = svg(&row("opacity: -1/2", "color: red"), 12);
    assert_eq!(
        values(&text, "fill-opacity=\"").len(),
        9,
        "all but the first are translucent: {text}"
    );
    // A drift of the scene starts from the colour of the style.
    let text = svg(&row("hue: 0", "hue: 120, lightness: 0.5"), 12);
    assert_eq!(values(&text, "<path fill=\""), ["#ff4040"]);
    let text = svg(&row("saturation: -1", "hue: 120, lightness: -1"), 12);
    assert_eq!(values(&text, "<path fill=\""), ["#000000"]);
}

#[test]
fn drifts_pass_from_one_value_to_the_other() {
    let square = |tint: &str| {
        let square = format!("{{polygon: [[0, 0], [1, 0], [1, 1]]{tint}}}");
        model(&format!(
            "kind: instancing\nobjects: {{a: [{square}]}}\nscene: [a]\n\
             style: {{fill: red, color_by: tint}}\n"
        ))
    };
    let turned = square(", tint: {hue: 120}");
    let blue = square(", tint: {color: blue}");
    // Half of the turn, of red, or of half red and half blue.
    for (other, expected) in [(square(""), "#ffff00"), (blue, "#800000")] {
        let between = turned.toward(&other, 0.5, TweenBy::Polar).unwrap();
        assert_eq!(values(&svg(&between, 2), "<path fill=\""), [expected]);
    }
}

/// Elements arrive in blocks where nothing is cut, one by one where a detail cuts, and from spans on several
/// threads.
#[test]
fn however_a_structure_is_walked_its_colours_are_the_same() {
    for name in ["pound-sign-tinted", "ternary-tree-levels", "sunflower"] {
        let model = document(name).resolve(&[]).unwrap().0;
        let steps = model.metadata().steps.unwrap();
        for format in [Format::Svg, Format::Png] {
            let with = |threads: usize, detail: bool| {
                picture(&model, steps, |options| {
                    options.format = format;
                    options.threads = NonZero::new(threads).unwrap();
                    options.detail = detail.then_some(render::Detail {
                        pixels: 1e-9,
                        decides_steps: false,
                    });
                })
            };
            let one = with(1, false);
            assert!(one == with(4, false), "{name} on four threads");
            let fills = |bytes: &[u8]| {
                let text = String::from_utf8_lossy(bytes);
                let fills = values(&text, "fill=\"#");
                fills.into_iter().map(str::to_owned).collect::<Vec<_>>()
            };
            let cut = with(1, true);
            if format == Format::Svg {
                assert!(fills(&one).len() > 20, "{name} has colours");
                assert_eq!(fills(&one), fills(&cut), "{name} one by one");
            }
        }
    }
}

/// Hart's figure 5 in the plane: the colour of a quadrant is that of its instance.
#[test]
fn the_pound_sign_has_a_colour_for_every_quadrant() {
    let model = document("pound-sign-tinted").resolve(&[]).unwrap().0;
    let text = svg(&model, 0);
    let fills = values(&text, "<path fill=\"");
    let tints = ["#1d3557", "#d62828", "#2a9d8f", "#f4d35e"];
    assert_eq!(fills.len(), tints.len());
    for (fill, tint) in fills.iter().zip(tints) {
        let value = |text: &str, at: usize| u8::from_str_radix(&text[at..at + 2], 16).unwrap();
        for at in [1, 3, 5] {
            // Half of the tint on black.
            assert_eq!(
                value(fill, at),
                value(tint, at).div_ceil(2),
                "{fill} of {tint}"
            );
        }
    }
}

/// Returns the fills of a step, each with its number.
fn fills(model: &Model, steps: u32) -> Vec<(String, usize)> {
    let graph = model.compile(steps).unwrap();
    assert!(graph.tints());
    let text = svg(model, steps);
    // Successive shapes of one colour share a path.
    let mut counts: Vec<(String, usize)> = Vec::new();
    for path in text.split("<path ").skip(1) {
        let fill = path
            .split("fill=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap();
        let shapes = path
            .split(" d=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap();
        let shapes = shapes.matches(['M', 'm']).count();
        match counts.iter_mut().find(|(known, _)| known == fill) {
            Some((_, count)) => *count += shapes,
            None => counts.push((fill.to_owned(), shapes)),
        }
    }
    counts.sort();
    counts
}

fn hue(degrees: i32) -> String {
    let colour = Colour::parse(&format!("hsl({degrees}, 100%, 50%)")).unwrap();
    colour.to_string()
}

/// Tints of maps and of elements apply at every step: of step n, the binomial coefficient of n and k shapes have the k-fold
/// drift.
#[test]
fn maps_and_elements_drift_at_every_step() {
    let square = "polygon: [[0, 0], [1, 0], [1, 1], [0, 1]]";
    let system = model(&format!(
        "kind: ifs
maps: [{{scale: 1/2}}, {{scale: 1/2, shift: [1/2, 1/3], tint: {{hue: 36}}}}]
initial: {{{square}}}
style: {{fill: red}}
"
    ));
    let rule = model(
        "initiator: segment
generator: [[0, 0], {to: [1/2, 0.1]}, {to: [1, 0], tint: {hue: 36}}]
base_element: {points: [[0, 0], [1, 0], [1, 1/5], [0, 1/5]], closed: true}
style: {fill: red}
",
    );
    for drawn in [&system, &rule] {
        assert_eq!(drawn.metadata().style.color_by, ColorBy::Tint);
        let mut expected: Vec<_> = (0..=4).zip([1, 4, 6, 4, 1]).collect::<Vec<_>>();
        let mut expected: Vec<(String, usize)> = expected
            .drain(..)
            .map(|(times, count)| (hue(36 * times), count))
            .collect();
        expected.sort();
        assert_eq!(fills(drawn, 4), expected);
    }
    // A condensation set inside the maps has the drifts of all of them, once each.
    let row = model(&format!(
        "kind: ifs
maps: [{{scale: 0.9, shift: [1, 0], tint: {{hue: 36}}}}]
condensation: [{{{square}}}]
style: {{fill: red}}
"
    ));
    let mut expected: Vec<_> = (0..10).map(|number| (hue(36 * number), 1)).collect();
    expected.sort();
    assert_eq!(fills(&row, 9), expected);
    // An initial set beside it is drawn in its place at the last step.
    let both = model(&format!(
        "kind: ifs
maps: [{{scale: 0.5, shift: [1, 0], tint: {{hue: 36}}}}]
condensation: [{{{square}}}]
initial: {{{square}}}
style: {{fill: red}}
"
    ));
    let found = fills(&both, 3);
    assert_eq!(
        found.iter().map(|(_, count)| count).sum::<usize>(),
        4,
        "{found:?}"
    );
    assert!(
        [0, 1, 2, 3]
            .iter()
            .all(|k| found.iter().any(|(fill, _)| *fill == hue(36 * k)))
    );
    // Equal maps with different tints are not one.
    let equal = model(&format!(
        "kind: ifs
maps: [{{scale: 1/2}}, {{scale: 1/2, tint: {{hue: 120}}}}]
initial: {{{square}}}
style: {{fill: red}}
"
    ));
    assert_eq!(
        fills(&equal, 1),
        [("#00ff00".into(), 1), ("#ff0000".into(), 1)]
    );
}

#[test]
fn tints_of_maps_and_elements_are_in_space_too() {
    for text in [
        "kind: ifs\nspace: 3\nmaps: [{scale: 1/2}, {scale: 1/2, shift: [1/2, 0, 0], tint: {hue: 120}}]\nstyle: {fill: red}\n",
        "space: 3\ninitiator: [[0, 0, 0], [1, 0, 0]]\ngenerator: [[0, 0, 0], [1/2, 0, 1/5], {to: [1, 0, 0], tint: {color: lime}}]\n",
    ] {
        let model = model(text);
        assert_eq!(model.metadata().style.color_by, ColorBy::Tint);
        assert!(model.graph_in_space(3).unwrap().unwrap().tints(), "{text}");
    }
}

#[test]
fn mistakes_in_tints_of_maps_and_elements_are_reported() {
    for (text, expected) in [
        (
            "kind: ifs\nmaps: [{scale: 1/2, tint: {}}]\n",
            "a tint needs a `color`",
        ),
        (
            "kind: ifs\nmaps: [{scale: 1/2, tint: {saturation: -3}}]\n",
            "the saturation of this tint is -3",
        ),
        (
            "initiator: segment\ngenerator: [[0, 0], {to: [1/2, 0], tint: {alpha: 1/2}}]\n",
            "`alpha` goes with `color`",
        ),
        (
            "initiator: segment\ngenerator: [[0, 0], {to: [1/2, 0], tint: {lightness: 2}}]\n",
            "the lightness of this tint is 2",
        ),
    ] {
        let source = kfrac::diagnostic::Source::new("test.yaml", text);
        let catalogue = kfrac::catalogue::Catalogue::embedded();
        let read = kfrac::document::Document::read(&source, &catalogue);
        let diagnostics = read.and_then(|it| it.resolve(&[]).map(|_| ())).unwrap_err();
        assert!(
            diagnostics.to_string().contains(expected),
            "{text}: {diagnostics}"
        );
    }
}
