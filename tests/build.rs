//! Fractals built in code are equal to those written in files.

mod random;
mod systems;

use crate::common;
use kfrac::Parameter;
use kfrac::build::{ElementBuilder, ElementsBuilder, GeneratorBuilder, MoveBuilder, RuleBuilder};
use kfrac::diagnostic::Severity;
use kfrac::geometry::{DVec2, Direction};
use kfrac::rule::{BaseElement, Piece, Placement, Rule, arc};
use kfrac::style::{Blend, Cap, Colour, DensityView, Iteration, Palette, Style, Tone, View, Width};

const SEGMENT: [(i32, i32); 2] = [(0, 0), (1, 0)];

fn segment() -> RuleBuilder {
    RuleBuilder::new(SEGMENT)
}

fn koch() -> [(&'static str, &'static str); 5] {
    [
        ("0", "0"),
        ("1/3", "0"),
        ("1/2", "sqrt(3)/6"),
        ("2/3", "0"),
        ("1", "0"),
    ]
}

fn polygon(points: &[(f64, f64)], closed: bool) -> BaseElement {
    let mut points = points.iter().map(|&(x, y)| DVec2::new(x, y));
    let start = points.next().unwrap();
    BaseElement::new(start, points.map(Piece::Line).collect(), closed).unwrap()
}

/// Asserts that a rule equals the library's, once it has that rule's description and style.
fn assert_is_of_the_library(name: &str, rule: RuleBuilder) {
    let expected = common::resolved(&common::document(name), &[]);
    let rule = rule
        .description(expected.description())
        .style(expected.style())
        .view(expected.view());
    assert_is(&expected, &rule);
}

fn assert_is(expected: &Rule, rule: &RuleBuilder) {
    let built = rule.build().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(built, *expected);
    let again = common::document_of(&rule.document().unwrap().to_yaml());
    assert_eq!(
        **again.resolve(&[]).unwrap().0.rule().unwrap(),
        *expected,
        "saved as YAML"
    );
}

fn assert_is_written(text: &str, rule: &RuleBuilder) {
    let expected = common::document_of(text)
        .resolve(&[])
        .unwrap()
        .0
        .into_rule()
        .unwrap();
    assert_is(&expected, rule);
}

#[test]
fn a_chain_of_points_is_a_generator() {
    let rule = segment().generator("generator", koch()).steps(5);
    assert_is_of_the_library("koch", rule.dimension("log(4)/log(3)"));
}

#[test]
fn numbers_are_those_of_their_expressions() {
    let third = 1.0 / 3.0;
    let points = [[0.0, -0.0], [third, 0.0], [2.0 * third, 0.0], [1.0, 0.0]];
    let text = "{initiator: segment, generators: {cut: [[0, 0], [1/3, 0], [2/3, 0], [1, 0]]}}";
    assert_is_written(text, &segment().generator("cut", points));
}

#[test]
fn generators_take_turns() {
    let side = |y: f64| [DVec2::ZERO, DVec2::new(0.5, y), DVec2::X];
    let rule = segment()
        .generator("gen0", side(0.5))
        .generator("gen1", side(-0.5))
        .select_by_index(["gen0", "gen1"]);
    assert_is_of_the_library("dragon", rule.steps(12).dimension(2));
}

#[test]
fn elements_have_directions() {
    let turned = |x: &str, y: &str, number| {
        let direction = Direction::from_number(number).unwrap();
        ElementBuilder::to((x, y)).direction(direction)
    };
    let generator = ElementsBuilder::new()
        .point((0, 0))
        .element(turned("1/6", "sqrt(3)/6", 2))
        .element(turned("1/3", "sqrt(3)/3", 3))
        .point(("2/3", "sqrt(3)/3"))
        .element(turned("5/6", "sqrt(3)/6", 3))
        .element(turned("2/3", "2*sqrt(3)/9", 3))
        .element(turned("1/2", "5*sqrt(3)/18", 2))
        .element(turned("1/3", "2*sqrt(3)/9", 4))
        .element(turned("1/3", "sqrt(3)/9", 4))
        .point(("1/3", 0))
        .element(turned("2/3", "0", 4))
        .point((1, 0));
    let rule = segment().generator("generator", generator).steps(3);
    assert_is_of_the_library(
        "monkeys-tree",
        rule.dimension("2*log((1 + sqrt(21))/2)/log(3)"),
    );
}

#[test]
fn elements_apart_have_a_closed_base_element() {
    let mut cells = ElementsBuilder::new().connected(false);
    for (x, y) in [
        (0, 0),
        (1, 0),
        (2, 0),
        (0, 1),
        (2, 1),
        (0, 2),
        (1, 2),
        (2, 2),
    ] {
        let corner = |x: i32| (f64::from(x) / 3.0, f64::from(y) / 3.0);
        cells = cells.element(ElementBuilder::to(corner(x + 1)).from(corner(x)));
    }
    let square = polygon(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)], true);
    let rule = segment()
        .generator("generator", cells)
        .base_element(&square);
    assert_is_of_the_library("carpet", rule.steps(4).dimension("log(8)/log(3)"));
}

#[test]
fn random_functions_draw_from_parameters() {
    let limits = |name: &str, value, max, about: &str| Parameter {
        min: Some(0.0),
        max: Some(max),
        about: Some(about.into()),
        ..Parameter::new(name, value)
    };
    let roof = ElementsBuilder::new()
        .point((0, 0))
        .element(ElementBuilder::to((0, 1)).fertile(false))
        .point(("cos(foot)^2", "1 + sin(foot)*cos(foot)"))
        .point((1, 1))
        .element(ElementBuilder::to((1, 0)).fertile(false));
    let generator = GeneratorBuilder::new()
        .random("tilt", "uniform(-sway, sway)")
        .random("foot", "uniform(45 - spread, 45 + spread)")
        .moves(MoveBuilder::new().rotate("tilt").about((0.5, 1)))
        .part(Placement::Stays, roof);
    let turn = "largest turn of the roof, degrees";
    let change = "largest change of the foot angle, degrees";
    let rule = segment()
        .parameter(limits("sway", 15.0, 60.0, turn))
        .parameter(limits("spread", 10.0, 40.0, change))
        .generator("generator", generator);
    assert_is_of_the_library("random-tree", rule.steps(10).dimension(2));
}

#[test]
fn parts_seed_where_they_stand() {
    let side = ElementsBuilder::from([("0", 0), ("1/3", 0), ("2/3", 0), ("1", 0)]);
    let third = [
        ("1/3", "1/3"),
        ("1/3", "2/3"),
        ("2/3", "2/3"),
        ("2/3", "1/3"),
    ];
    let generator = GeneratorBuilder::new()
        .part(Placement::Stays, side)
        .part(Placement::Seeds, ElementsBuilder::from(third).closed(true));
    let square = ElementsBuilder::from([(0, 0), (0, 1), (1, 1), (1, 0)]).closed(true);
    let rule = RuleBuilder::new(square)
        .generator("generator", generator)
        .steps(3)
        .dimension("log(7)/log(3)")
        .hausdorff_dimension("log((7 + sqrt(33))/2)/log(3)");
    assert_is_of_the_library("self-seeding-square", rule);
}

#[test]
fn everything_that_a_file_says_can_be_said() {
    let text = r##"
params:
  reach: {value: 30, min: 2, max: 200, about: "how far: left, right"}
  tilt: 20
initiator: [[0, 0], {to: [1, 0], direction: 2, connected: false}, [1, 1]]
base_element: {points: [[0, 0], [1/4, 1], {curve: [1, 0], control: [[1, 1], [2, 0]]}]}
generators:
  grow:
    random:
      sway: uniform(-tilt, tilt)
      size: choice(0.5, 0.75)
    move:
      - {rotate: sway, scale: [size, 0.5], translate: [0, 0.25], about: [0.5, 0.5], points: [1, 2]}
      - {scale: 0.75, points: all}
    parts:
      - connected: false
        elements:
          - [0, 0]
          - {to: [0, 1/2], fertile: false, visible: false}
          - {to: [1/2, age/10], use: "seed: all"}
          - {to: [1, 0], base_element: {closed: true, points: [[0, 0], [1, 1], [1, 0]]}}
  "seed: all":
    random: {left: "uniform(-reach, -2)"}
    parts:
      - {seeds: true, placed: initiator, elements: [[left, 0], [left + 1, 0]]}
select:
  - {when: age >= 3 and age < 5, use: "seed: all"}
  - {use: grow}
style: {stroke: teal, fill: "#11223344", background: white, width: {relative: 0.1}, cap: butt, join: bevel, blend: screen, color_by: age, palette: ["#000000", "#ff000080"], color_range: [0, 6.5]}
view: {window: [-1, -1, 3, 2.5], margin: 4}
density: {method: chaos, points: 2500k, tone: linear, gamma: 2, oversample: 3, kernel: 4.5}
"##;
    let cup = BaseElement::new(
        DVec2::ZERO,
        vec![
            Piece::Line(DVec2::new(0.25, 1.0)),
            Piece::Cubic(DVec2::ONE, DVec2::new(2.0, 0.0), DVec2::X),
        ],
        false,
    );
    let triangle = polygon(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0)], true);
    let elements = ElementsBuilder::new()
        .point((0, 0))
        .element(ElementBuilder::to((0, 0.5)).fertile(false).visible(false))
        .element(ElementBuilder::to((0.5, "age/10")).generator("seed: all"))
        .element(ElementBuilder::to((1, 0)).base_element(&triangle));
    let grow = GeneratorBuilder::new()
        .random("sway", "uniform(-tilt, tilt)")
        .random("size", "choice(0.5, 0.75)")
        .moves(
            MoveBuilder::new()
                .rotate("sway")
                .scale(("size", 0.5))
                .translate((0, 0.25))
                .about((0.5, 0.5))
                .points([1, 2]),
        )
        .moves(MoveBuilder::new().scale((0.75, 0.75)).all_points())
        .part(Placement::Stays, elements.connected(false));
    let seed = GeneratorBuilder::new()
        .random("left", "uniform(-reach, -2)")
        .part(Placement::SeedsAsInitiator, [("left", 0), ("left + 1", 0)]);
    let colours = ["#000000", "#ff000080"].map(|text| Colour::parse(text).unwrap());
    let initiator = ElementsBuilder::new()
        .point((0, 0))
        .element(
            ElementBuilder::to((1, 0))
                .direction(Direction::YReflected)
                .connected(false),
        )
        .point((1, 1));
    let rule = RuleBuilder::new(initiator)
        .parameter(Parameter {
            min: Some(2.0),
            max: Some(200.0),
            about: Some("how far: left, right".into()),
            ..Parameter::new("reach", 30.0)
        })
        .parameter(Parameter::new("tilt", 20.0))
        .base_element(&cup.unwrap())
        .generator("grow", grow)
        .generator("seed: all", seed)
        .select_first([("age >= 3 and age < 5", "seed: all")], "grow")
        .style(&Style {
            stroke: Colour::parse("teal"),
            fill: Colour::parse("#11223344"),
            background: Colour::parse("white"),
            width: Width::Relative(0.1),
            cap: Cap::Butt,
            join: kfrac::style::Join::Bevel,
            blend: Blend::Screen,
            color_by: kfrac::style::ColorBy::Age,
            palette: Palette::of_colours("", &colours),
            color_range: Some([0.0, 6.5]),
            tube: None,
        })
        .view(&View {
            window: Some([-1.0, -1.0, 3.0, 2.5]),
            margin: Some(4.0),
        })
        .density(
            &DensityView::default()
                .method(Some(Iteration::Chaos))
                .points(Some(2_500_000))
                .tone(Some(Tone::Linear))
                .gamma(Some(2.0))
                .oversample(Some(3))
                .kernel(Some(4.5)),
        );
    assert_is_written(text, &rule);
}

#[test]
fn generators_are_drawn_by_weight() {
    let text = "{initiator: segment, generators: {a: [[0, 0], [1/2, 0], [1, 0]], \
                b: [[0, 0], [1/4, 0], [1, 0]]}, select: {at_random: {a: 3, b: 0.5}}}";
    let rule = segment()
        .generator("a", [(0.0, 0), (0.5, 0), (1.0, 0)])
        .generator("b", [(0.0, 0), (0.25, 0), (1.0, 0)])
        .select_at_random([("a", 3.0), ("b", 0.5)]);
    assert_is_written(text, &rule);
}

#[test]
fn what_is_said_last_counts() {
    let other = Style {
        width: Width::Pixels(9.0),
        ..Style::default()
    };
    let rule = segment()
        .generator("generator", koch())
        .steps(3)
        .steps(4)
        .style(&other)
        .style(&Style::default());
    assert_is_written("{initiator: segment, generator: koch, steps: 4}", &rule);
}

#[test]
fn round_base_elements_are_what_they_were() {
    let half = arc(DVec2::ZERO, DVec2::new(0.5, 0.5), DVec2::X).unwrap();
    let leaf = [Piece::Cubic(DVec2::Y, DVec2::ONE, DVec2::ZERO)];
    for (pieces, closed) in [(half.clone(), false), (half, true), (leaf.to_vec(), true)] {
        let element = BaseElement::new(DVec2::ZERO, pieces, closed).unwrap();
        let rule = segment().generator("g", koch()).base_element(&element);
        assert_eq!(rule.build().unwrap().base_elements(), [element]);
    }
}

/// Returns the message of the only error in a rule.
fn mistake(rule: &RuleBuilder) -> String {
    let errors = rule.build().unwrap_err();
    let mut wrong = errors
        .iter()
        .filter(|error| error.severity() == Severity::Error);
    let error = wrong.next().unwrap();
    assert!(wrong.next().is_none(), "{errors}");
    assert!(error.place().is_some(), "{errors}");
    error.message().to_owned()
}

#[test]
fn every_mistake_has_its_message() {
    let rule = || segment().generator("koch", koch());
    let with = |generator: GeneratorBuilder| mistake(&segment().generator("g", generator));
    let none: [(i32, i32); 0] = [];
    let no_list = "there is no element in this list";
    assert_eq!(mistake(&segment()), "the rule has no generator");
    assert_eq!(
        mistake(&RuleBuilder::new(none).generator("koch", koch())),
        no_list
    );
    assert_eq!(with(ElementsBuilder::new().into()), no_list);
    assert_eq!(with([(0, 0)].into()), no_list);
    assert_eq!(
        with(GeneratorBuilder::new()),
        "there is no part in this list"
    );
    assert_eq!(
        with(
            ElementsBuilder::new()
                .element(ElementBuilder::to((1, 0)))
                .into()
        ),
        "the first element has no start point"
    );
    assert_eq!(
        with(ElementsBuilder::from(SEGMENT).closed(true).into()),
        "only a part that seeds can be closed"
    );
    assert_eq!(
        mistake(&RuleBuilder::new([(1, 0), (1, 0)]).generator("koch", koch())),
        "this element of the initiator has no length"
    );
    assert_eq!(
        mistake(&rule().generator("other", koch())),
        "the rule has several generators and no selection among them"
    );
    assert_eq!(
        mistake(&rule().generator("koch", koch())),
        "the key 'koch' is already in line 5"
    );
    assert_eq!(
        mistake(&rule().select_by_index(["coch"])),
        "there is no generator 'coch'"
    );
    assert_eq!(
        mistake(&rule().select_by_index(Vec::<String>::new())),
        "there is no generator in this list"
    );
    assert_eq!(
        mistake(&rule().select_first([("age", "koch")], "koch")),
        "a condition is needed here, this is a number"
    );
    assert_eq!(
        mistake(&rule().select_at_random([("koch", 0)])),
        "no generator has a weight above 0"
    );
    let parameter = Parameter {
        min: Some(3.0),
        ..Parameter::new("a", 2.0)
    };
    assert_eq!(
        mistake(&rule().parameter(parameter)),
        "'a' is 2, below its least value 3"
    );
    assert_eq!(
        mistake(&rule().steps(u32::MAX)),
        "a number of steps is a whole number from 0 to 1,000,000"
    );
    let moving = GeneratorBuilder::from(koch()).moves(MoveBuilder::new().points([9]));
    assert_eq!(
        with(moving),
        "there is no point 9: points are numbered 0 to 4"
    );
    assert_eq!(
        with([(0, "0"), (1, "1/(2 - 2)")].into()),
        "division by zero"
    );
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let rule = || segment().generator("g", koch());
        let view = View {
            margin: Some(value),
            ..View::default()
        };
        for rule in [
            RuleBuilder::new([(0.0, 0.0), (1.0, value)]).generator("g", koch()),
            segment().generator("g", [(0.0, 0.0), (value, 1.0), (1.0, 0.0)]),
            // No parameter can give such a number a meaning.
            rule()
                .dimension(value)
                .parameter(Parameter::new("inf", 1.0)),
            rule().parameter(Parameter::new("a", value)),
            rule().view(&view),
            rule().select_at_random([("g", value)]),
        ] {
            assert_eq!(mistake(&rule), "this number is not finite");
        }
    }
}

#[test]
fn messages_show_the_rule_as_a_file() {
    let rule = segment().generator("koch", [("0", 0), ("sqrt(2)*x", 0), ("1", 0)]);
    let expected = "\
error: unknown name 'x'
 --> (built):7:16
  |
7 |     - [sqrt(2)*x, 0]
  |                ^
  |
  = help: what can be used here: age, i, length, step, pi, phi, e";
    assert_eq!(rule.build().unwrap_err().to_string(), expected);
}
