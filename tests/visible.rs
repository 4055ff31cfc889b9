//! Visible faces and edges of sets in space, as SVG and as plots.

use std::num::NonZero;

use kfrac::Fractal;
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::geometry::{DVec3, Frame3};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::space::{Camera, Light, Shade, Slice, SpaceOptions, write_visible};
use kfrac::render::{Options, Picture};
use kfrac::style::Style;
use resvg::{tiny_skia, usvg};

fn compiled(text: &str) -> Graph<Frame3> {
    let source = Source::new("test.yaml", text);
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    document
        .resolve(&[])
        .unwrap()
        .0
        .compile_in_space(false)
        .unwrap()
}

/// Draws a step; returns the picture and the SVG.
fn draw(
    graph: &Graph<Frame3>,
    steps: u32,
    space: &SpaceOptions,
    change: impl FnOnce(&mut Options),
) -> (Picture, String) {
    let mut options = Options::default().threads(NonZero::<usize>::MIN);
    change(&mut options);
    let mut bytes = Vec::new();
    let growth = Growth::steps(steps);
    let picture = write_visible(graph, &growth, &options, space, &mut bytes).unwrap();
    (picture, String::from_utf8(bytes).unwrap())
}

fn menger() -> Graph<Frame3> {
    compiled("kind: ifs\nextends: menger\n")
}

fn from(from: [f64; 2]) -> SpaceOptions {
    SpaceOptions::default().camera(Camera::default().from(from))
}

#[test]
fn the_front_of_the_sponge_is_the_carpet() {
    let menger = menger();
    for steps in 0..=3 {
        let (_, svg) = draw(&menger, steps, &from([0.0, 0.0]), |_| {});
        assert_eq!(svg.matches("<path").count(), 8_usize.pow(steps));
        // The outlines of the holes, and of the whole: squares of one plane have no edge between them.
        let (picture, _) = draw(&menger, steps, &from([0.0, 0.0]), |options| {
            options.plot = true
        });
        let plotted = picture.plotted.unwrap();
        let holes = (8_u64.pow(steps) - 1) / 7;
        assert_eq!(plotted.strokes, holes + 1);
        // Holes of 3^−k are 8^(k−1), each of four sides; the whole is 1024 pixels wide.
        let sides: f64 = (1..=steps)
            .map(|k| 8f64.powi(k.cast_signed() - 1) / 3f64.powi(k.cast_signed()))
            .sum();
        let margin = 2.0 * Options::default().view.margin.unwrap_or_default();
        let expected = 4.0 * (1.0 + sides) * (1024.0 - margin) * 25.4 / 96.0;
        assert!(
            (plotted.drawn / expected - 1.0).abs() < 1e-3,
            "{plotted:?}, {expected}"
        );
    }
}

#[test]
fn a_section_of_the_sponge_is_outlined() {
    let slice = Slice::new(DVec3::ONE, 1.5);
    let space = SpaceOptions::default()
        .camera(Camera::default().from(slice.from()))
        .slice(Some(slice));
    let (picture, _) = draw(&menger(), 2, &space, |options| options.plot = true);
    // A hexagon, the star in its middle, and six smaller ones on each of two levels about it: one stroke each.
    let plotted = picture.plotted.unwrap();
    assert_eq!(plotted.strokes, 1 + 1 + 6, "{plotted:?}");
    let (_, svg) = draw(&menger(), 2, &space, |_| {});
    assert_eq!(svg.matches("<path").count() as u64, picture.elements);
}

#[test]
fn sections_of_polygons_are_lines() {
    let sheets = compiled(
        "kind: ifs\nspace: 3\nmaps: [{scale: 1/2}, {scale: 1/2, translate: [0, 0, 1]}]\n\
         initial: {polygon: [[-1, -1, 0], [1, -1, 0], [1, 1, 2], [-1, 1, 2]]}\n",
    );
    let slice = Slice::new(DVec3::Y, 0.125);
    let space = SpaceOptions::default()
        .camera(Camera::default().from(slice.from()))
        .slice(Some(slice));
    let (picture, svg) = draw(&sheets, 1, &space, |options| options.plot = true);
    assert_eq!(picture.plotted.unwrap().strokes, 2, "{svg}");
    assert_eq!(picture.elements, 2);
}

/// Lines along all axes through a cube of a third of their length: one is seen end-on, and the cube hides the middles of the
/// others.
#[test]
fn lines_are_seen_where_no_face_lies_before_them() {
    let scene = compiled(
        "kind: instancing\nspace: 3\nobjects: {all: [{box: {from: [1, 1, 1], to: [2, 2, 2]}}, \
         {segment: [[0, 1.5, 1.5], [3, 1.5, 1.5]]}, {segment: [[1.5, 0, 1.5], [1.5, 3, 1.5]]}, \
         {segment: [[1.5, 1.5, 0], [1.5, 1.5, 3]]}]}\nscene: [all]\n",
    );
    let margin = 2.0 * Options::default().view.margin.unwrap_or_default();
    for view in [[0.0, 0.0], [90.0, 0.0], [0.0, 90.0]] {
        let (picture, _) = draw(&scene, 2, &from(view), |options| options.plot = true);
        let plotted = picture.plotted.unwrap();
        assert_eq!(plotted.strokes, 1 + 4, "{plotted:?}");
        let expected = (4.0 + 4.0) / 3.0 * (1024.0 - margin) * 25.4 / 96.0;
        let difference = plotted.drawn / expected - 1.0;
        assert!(difference.abs() < 1e-3, "{plotted:?}, {expected}");
        // The face, and a path for the lines, which have one colour.
        let (picture, svg) = draw(&scene, 2, &from(view), |_| {});
        assert_eq!(svg.matches("<path").count(), 2, "{svg}");
        assert_eq!(picture.elements, 4);
    }
}

/// Colours differ by depth.
#[test]
fn lines_of_a_curve_are_drawn_one_by_one() {
    let koch = Fractal::parse(
        "kind: lsystem\nspace: 3\naxiom: F\nproductions: {F: F+F--F+F}\nangle: 60\n",
    );
    let koch = koch.unwrap().steps(3);
    let svg = koch.svg().unwrap();
    assert_eq!(svg.matches("<path").count(), 64);
}

#[test]
fn a_cube_has_three_faces_and_nine_edges() {
    let cube = compiled(
        "kind: ifs\nspace: 3\nmaps: [{scale: 1/2, translate: [1, 1, 1]}]\ninitial: {box: {from: [0, 0, 0], to: [1, 1, 1]}}\n",
    );
    for perspective in [None, Some(40.0)] {
        let camera = Camera::default().perspective(perspective);
        let space = SpaceOptions::default().camera(camera);
        let (_, svg) = draw(&cube, 0, &space, |_| {});
        assert_eq!(svg.matches("<path").count(), 3);
        let light = Light::default().from([20.0, 55.0]);
        let flat = space.clone().shade(Some(Shade::Relief)).light(light);
        let (_, svg) = draw(&cube, 0, &flat, |_| {});
        let mut fills: Vec<&str> = svg.split("fill=\"").skip(1).collect();
        { fills.iter_mut() }.for_each(|fill| *fill = &fill[..fill.find('"').unwrap()]);
        fills.retain(|fill| *fill != "none");
        fills.sort_unstable();
        fills.dedup();
        assert_eq!(fills.len(), 3, "{fills:?}");
        let (picture, svg) = draw(&cube, 0, &space, |options| options.plot = true);
        // Nine edges, four of whose ends are odd.
        assert_eq!(picture.plotted.unwrap().strokes, 2, "{svg}");
    }
}

#[test]
fn edges_are_drawn_over_faces_that_have_a_stroke() {
    let menger = menger();
    let black = |options: &mut Options| {
        let colour = kfrac::style::Colour::parse;
        options.style = Style {
            fill: colour("gold"),
            stroke: colour("#123456"),
            ..Style::default()
        };
    };
    let (_, plain) = draw(&menger, 1, &from([30.0, 25.0]), |_| {});
    let (_, lined) = draw(&menger, 1, &from([30.0, 25.0]), black);
    assert!(!plain.contains("#123456") && lined.contains("#123456"));
}

#[test]
fn threads_change_nothing() {
    let menger = menger();
    let of = |threads: usize, plot: bool| {
        let change = |options: &mut Options| {
            options.threads = NonZero::new(threads).unwrap();
            options.plot = plot;
        };
        draw(&menger, 3, &from([20.0, 40.0]), change).1
    };
    for plot in [false, true] {
        let one = of(1, plot);
        assert!(one == of(2, plot) && one == of(5, plot));
    }
}

/// Returns the share of pixels in which an SVG and a PNG of one set differ by a quarter of the range.
fn difference(name: &str, steps: u32) -> f64 {
    const SIDE: u32 = 480;
    let fractal = Fractal::named(name).unwrap().steps(steps);
    let png = tiny_skia::Pixmap::decode_png(&fractal.png(SIDE).unwrap()).unwrap();
    let svg = fractal.svg().unwrap();
    let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap();
    let mut drawn = tiny_skia::Pixmap::new(png.width(), png.height()).unwrap();
    drawn.fill(tiny_skia::Color::WHITE);
    let [x, y] = [
        png.width() as f32 / tree.size().width(),
        png.height() as f32 / tree.size().height(),
    ];
    let to_pixels = tiny_skia::Transform::from_scale(x, y);
    resvg::render(&tree, to_pixels, &mut drawn.as_mut());
    let pixels = png.data().chunks_exact(4).zip(drawn.data().chunks_exact(4));
    let differ = pixels.filter(|(a, b)| { a.iter().zip(*b) }.any(|(a, b)| a.abs_diff(*b) > 64));
    differ.count() as f64 / f64::from(png.width() * png.height())
}

/// The order of faces is that of the depth buffer: an SVG, drawn by another program, shows what a PNG shows, but for outlines.
#[test]
fn faces_hide_each_other_as_in_pixels() {
    let all = [
        ("menger-cubes", 2),
        ("koch-cube", 2),
        ("koch-surface", 2),
        ("koch-icosahedron-inwards", 2),
        ("octahedra", 3),
        ("tree-of-boxes", 6),
        ("hart-tree-lsystem", 3),
        ("hilbert-in-space", 2),
        ("mountain", 4),
        ("pound-sign-in-space", 3),
    ];
    for (name, steps) in all {
        let share = difference(name, steps);
        assert!(share < 0.035, "{name}: {share}");
    }
}
