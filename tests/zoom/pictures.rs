//! Zoomed pictures.

use std::io::Cursor;

use kfrac::geometry::DVec2;
use kfrac::grow::Growth;
use kfrac::model::Model;
use kfrac::render::{self, Detail, Format, Options, Size, ZoomTarget};
use kfrac::style::{ColorBy, Colour, Style, View, Width};
use png::Transformations;

use super::seeds::ISLANDS;
use super::{library, point, read};

type Rule = Model;

/// Returns options of black lines on white.
fn options(rule: &Rule) -> Options {
    let style = Style {
        width: Width::Pixels(1.5),
        color_by: ColorBy::None,
        stroke: Some(Colour::BLACK),
        background: Some(Colour::grey(255)),
        ..rule.metadata().style.clone()
    };
    Options::default()
        .format(Format::Png)
        .size(Size::Exactly(200, 200))
        .style(style)
        .detail(Some(Detail {
            pixels: 1.0,
            decides_steps: true,
        }))
}

/// Returns the pixel values of a picture with one channel.
fn values(picture: Vec<u8>) -> Vec<u8> {
    let mut decoder = png::Decoder::new(Cursor::new(picture));
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut pixels).unwrap();
    let samples = frame.color_type.samples();
    pixels.chunks(samples).map(|pixel| pixel[0]).collect()
}

fn zoomed(rule: &Rule, options: &Options, factor: &str, at: &str) -> Vec<u8> {
    let graph = rule.compile(64).unwrap();
    let look = ZoomTarget {
        factor: factor.parse().unwrap(),
        at: at.parse().unwrap(),
        turn: 0.0,
    };
    let mut bytes = Vec::new();
    let growth = Growth::steps(1_000_000);
    render::write_zoomed(rule, &graph, &growth, options, &look, &mut bytes).unwrap();
    values(bytes)
}

fn drawn(rule: &Rule, factor: &str, at: &str) -> Vec<u8> {
    zoomed(rule, &options(rule), factor, at)
}

/// Returns the number of pixels that differ by more than a sixteenth between two pictures.
fn apart(a: &[u8], b: &[u8]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .filter(|(a, b)| a.abs_diff(**b) > 16)
        .count()
}

#[test]
fn a_zoom_by_a_power_of_the_ratio_shows_the_same_picture() {
    for (name, ratio, at, steps) in [
        ("koch", "3", "0.(0)", [3, 4, 2004]),
        // Eight rotations by 45 degrees are a full turn.
        (
            "dragon",
            "1.4142135623730950488016887242096980785696718753769480731766797379907",
            "0.(0)",
            [9, 17, 2009],
        ),
    ] {
        let rule = library(name);
        let [first, next, deep] = steps.map(|power| drawn(&rule, &format!("{ratio}^{power}"), at));
        let ink = first.iter().filter(|pixel| **pixel < 128).count();
        assert!(ink > 200, "{name}: {ink}");
        assert_eq!(apart(&first, &next), 0, "{name}");
        assert_eq!(apart(&first, &deep), 0, "{name}");
    }
}

/// An L-system that rewrites edges and the equal rule give equal zooms at any depth.
#[test]
fn a_rule_and_its_l_system_are_zoomed_alike() {
    let [rule, system] = ["koch", "koch-lsystem"].map(library);
    let options = options(&rule);
    for factor in ["3^4", "1e1000"] {
        let pictures = [&rule, &system].map(|it| zoomed(it, &options, factor, "0.1.(0)"));
        let ink = pictures[0].iter().filter(|pixel| **pixel < 128).count();
        assert!(ink > 200, "{ink}");
        assert_eq!(apart(&pictures[0], &pictures[1]), 0, "{factor}");
    }
}

/// Infertile elements much larger than the window are drawn as far as they are visible in it.
#[test]
fn large_infertile_elements_are_clipped() {
    let line = "initiator: segment\ngenerator:\n  - [0, 0]\n  - [1/3, 0]\n  \
                - {from: [-1, -1], to: [1, 1], fertile: false}\n  - {from: [-1/2, 1/3], to: [1/7, 1/3], fertile: false}\n";
    for factor in ["10", "1e6", "1e12", "1e300"] {
        let pixels = drawn(&read(line), factor, "0.(0)");
        // A diagonal through the middle.
        for place in [5, 60, 99, 140, 190] {
            assert!(
                pixels[(199 - place) * 200 + place] < 160,
                "{factor} at {place}"
            );
            assert!(
                pixels[(199 - place) * 200 + (place + 100) % 200] > 200,
                "{factor} at {place}"
            );
        }
    }
    // The middle lies inside the filled half of one square, on its lower side.
    let square = "initiator: segment\nstyle: {fill: black}\ngenerator:\n  - [0, 0]\n  - [1/3, 0]\n  \
                  - {from: [-1, 0], to: [1, 0], fertile: false, base_element: square}\n";
    for factor in ["10", "1e6", "1e300"] {
        let pixels = drawn(&read(square), factor, "0.(0)");
        assert!(
            pixels[50 * 200 + 20] < 60 && pixels[50 * 200 + 180] < 60,
            "{factor}"
        );
        assert!(
            pixels[150 * 200 + 20] > 200 && pixels[150 * 200 + 180] > 200,
            "{factor}"
        );
    }
}

/// Returns the options for a square window.
fn within(options: &Options, [x, y, side]: [f64; 3]) -> Options {
    options.clone().view(View {
        window: Some([x - side / 2.0, y - side / 2.0, side, side]),
        margin: Some(0.0),
    })
}

/// A closed chain encloses in a zoom the area that it encloses in a window of the whole.
#[test]
fn areas_are_those_of_the_whole() {
    let rule = library("koch-snowflake");
    let graph = rule.compile(64).unwrap();
    let p = point(&graph, &[0, 1, 2]);
    let base = options(&rule).style(Style {
        fill: Some(Colour::BLACK),
        ..options(&rule).style
    });
    let view = |window| within(&base, window);
    for (factor, at) in [
        ("5", p),
        ("1e3", p),
        ("1e5", p),
        ("30", DVec2::new(0.5, 0.1)),
    ] {
        let side = 2.0 / factor.parse::<f64>().unwrap();
        let mut plain = Vec::new();
        let window = view([at.x, at.y, side]);
        render::write(&graph, &Growth::steps(1_000), &window, &mut plain).unwrap();
        let address = format!("{},{}", at.x, at.y);
        let shown = zoomed(&rule, &view([0.0, 0.0, 2.0]), factor, &address);
        let plain = values(plain);
        let filled = plain.iter().filter(|value| **value < 128).count();
        assert!(filled > 8_000, "{factor}: {filled}");
        assert!(
            apart(&shown, &plain) <= 4,
            "{factor}: {}",
            apart(&shown, &plain)
        );
    }
}

/// Seeded fractals are coloured by their ages and filled as in a window of the whole, in the same order.
#[test]
fn seeds_are_drawn_as_in_the_whole() {
    let square = library("self-seeding-square");
    let islands = read(ISLANDS);
    let filled = |rule: &Rule, width, color_by| Style {
        fill: Some(Colour::grey(120)),
        width: Width::Pixels(width),
        color_by,
        ..options(rule).style
    };
    let aged = Style {
        color_by: ColorBy::Age,
        width: Width::Pixels(4.0),
        ..options(&square).style
    };
    let plain_islands = filled(&islands, 1.0, ColorBy::None);
    let islands_by_step = filled(&islands, 3.0, ColorBy::Step);
    for (rule, style, factor, at) in [
        (&square, aged.clone(), "4", [0.3217, 1.1113]),
        (&square, aged, "2e1", [0.3217, 1.1113]),
        (&islands, plain_islands, "4", [0.5127, 0.7321]),
        (&islands, islands_by_step, "2e1", [0.5127, 0.7321]),
    ] {
        let graph = rule.compile(64).unwrap();
        let base = options(rule).style(style);
        let side = 2.0 / factor.parse::<f64>().unwrap();
        let mut plain = Vec::new();
        let window = within(&base, [at[0], at[1], side]);
        render::write(&graph, &Growth::steps(64), &window, &mut plain).unwrap();
        let address = format!("{},{}", at[0], at[1]);
        let shown = zoomed(rule, &within(&base, [0.0, 0.0, 2.0]), factor, &address);
        let plain = values(plain);
        let paper = plain.iter().filter(|value| **value == 255).count();
        assert!((2_000..38_000).contains(&paper), "{factor}: {paper}");
        assert!(
            apart(&shown, &plain) <= 4,
            "{factor}: {}",
            apart(&shown, &plain)
        );
    }
}
