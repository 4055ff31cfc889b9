//! Limit sets drawn by cells, against random points and against the copies that come near a pixel.

use std::num::NonZero;

use super::random_systems::{Random, random_similar_system, random_system};
use super::{library, system};
use kfrac::geometry::{DAffine2, DVec2};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::ifs::System;
use kfrac::render::{self, Canvas, Detail, Format, Options, Size};

const SIZE: u32 = 64;

fn graph(system: &System) -> Graph {
    Graph::of_system(system)
}

fn options(size: u32, threads: usize) -> Options {
    Options::default()
        .format(Format::Png)
        .size(Size::Long(size))
        .detail(Some(Detail {
            pixels: 1.0,
            decides_steps: true,
        }))
        .threads(NonZero::new(threads).unwrap())
}

fn drawn(graph: &Graph, options: &Options) -> (Vec<u8>, render::Picture) {
    let mut bytes = Vec::new();
    let growth = Growth::steps(1_000_000);
    let picture = render::write(graph, &growth, options, &mut bytes).unwrap();
    (bytes, picture)
}

/// Returns the opacities of the pixels, by rows.
fn opacities(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::ALPHA);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let samples = info.color_type.samples();
    let rows = pixels.chunks(samples * info.width as usize);
    rows.map(|row| row.chunks(samples).map(|it| it[samples - 1]).collect())
        .collect()
}

/// Returns whether a pixel or a neighbour of it has visible ink.
fn is_near_ink(opacities: &[Vec<u8>], at: DVec2) -> bool {
    let around = |at: f64, most: usize| {
        (0..most).filter(move |&pixel| (pixel as f64 + 0.5 - at).abs() <= 1.5)
    };
    let mut rows = around(at.y, opacities.len());
    rows.any(|row| {
        let mut columns = around(at.x, opacities[0].len());
        columns.any(|column| opacities[row][column] >= 64)
    })
}

/// Returns whether a copy of the set that is smaller than a quarter of a pixel comes near a point.
fn is_near_set(maps: &[DAffine2], ball: (DVec2, f64), at: DVec2, near: f64, pixel: f64) -> bool {
    let mut open = vec![DAffine2::IDENTITY];
    let mut work = 0;
    while let Some(map) = open.pop() {
        let matrix = map.matrix2;
        let radius =
            ball.1 * (matrix.x_axis.length_squared() + matrix.y_axis.length_squared()).sqrt();
        let away = map.transform_point2(ball.0).distance(at);
        if away > near + radius {
            continue;
        }
        work += 1;
        if radius < pixel / 4.0 || work > 4_000 {
            return true;
        }
        open.extend(maps.iter().map(|next| map * *next));
    }
    false
}

/// Draws a system by cells, and compares the picture with points of random iteration, and ink with copies of
/// the set.
fn hold(name: &str, system: &System, points: usize) {
    let (picture, opacities) = hold_points(name, system, points, &[]);
    assert!(picture.is_limit, "{name}");
    hold_ink(name, system, &opacities);
}

/// Draws a system, and compares the picture with points of random iteration, which restarts now and then from
/// a line between two points.
fn hold_points(
    name: &str,
    system: &System,
    points: usize,
    segment: &[DVec2],
) -> (render::Picture, Vec<Vec<u8>>) {
    let graph = graph(system);
    let (bytes, picture) = drawn(&graph, &options(SIZE, 1));
    let opacities = opacities(&bytes);
    let bounds = graph.limit_bounds().unwrap();
    let canvas = Canvas::fit(&bounds, Size::Long(SIZE), 0.5).unwrap();
    let maps: Vec<DAffine2> = system.ifs().maps().iter().map(|map| map.affine).collect();
    let mut random = Random(1);
    let mut at = bounds.min();
    for point in 0..points {
        if let [from, to] = segment
            && random.below(8) == 0
        {
            at = from.lerp(*to, random.part());
        } else {
            at = maps[random.below(maps.len())].transform_point2(at);
        }
        if point < 2_000 {
            continue;
        }
        let pixel = canvas.pixel(at);
        assert!(is_near_ink(&opacities, pixel), "{name}: nothing at {pixel}");
    }
    (picture, opacities)
}

/// Compares ink with copies of a set.
fn hold_ink(name: &str, system: &System, opacities: &[Vec<u8>]) {
    let bounds = graph(system).limit_bounds().unwrap();
    let canvas = Canvas::fit(&bounds, Size::Long(SIZE), 0.5).unwrap();
    let maps: Vec<DAffine2> = system.ifs().maps().iter().map(|map| map.affine).collect();
    let to_plane = canvas.to_pixels().inverse();
    let middle = bounds.min().midpoint(bounds.max());
    let ball = (middle, middle.distance(bounds.min()));
    let pixel = 1.0 / canvas.scale();
    // Only a sample of the pixels, for every one takes long.
    for number in (0..SIZE * SIZE).step_by(41) {
        let [x, y] = [number % SIZE, number / SIZE].map(|place| place as usize);
        let opacity = opacities.get(y).and_then(|row| row.get(x));
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let at = to_plane.transform_point2(at);
        assert!(
            opacity.is_none_or(|opacity| *opacity < 16)
                || is_near_set(&maps, ball, at, 1.75 * pixel, pixel),
            "{name}: ink at {x}, {y}"
        );
    }
}

#[test]
fn random_systems_are_drawn_where_they_are() {
    for seed in 0..8 {
        let system = system(&random_system(seed));
        hold(&format!("system {seed}"), &system, 20_000);
    }
}

/// Random systems of similarities may be drawn by elements or by cells.
#[test]
fn random_similar_systems_are_drawn_where_they_are() {
    for seed in 0..12 {
        let system = system(&random_similar_system(seed));
        hold_points(&format!("system {seed}"), &system, 20_000, &[]);
    }
}

#[test]
fn condensation_sets_are_drawn_in_random_systems() {
    let segment = [DVec2::new(0.25, -0.5), DVec2::new(0.5, 1.5)];
    let set = "condensation:\n  - {segment: [[0.25, -0.5], [0.5, 1.5]]}\n";
    for seed in 0..6 {
        for maps in [random_system(seed), random_similar_system(seed)] {
            let system = system(&(maps + set));
            hold_points(&format!("system {seed}"), &system, 20_000, &segment);
        }
    }
}

/// Maps that flatten everything to a line or a point: their images have no area.
#[test]
fn flat_copies_are_drawn() {
    let trunk = "maps:\n  - {matrix: [[0, 0], [0, 0.5]]}\n  - {times: [0.42, 0.42], shift: [0, 0.2]}\n  \
                 - {times: [0.42, -0.42], shift: [0, 0.2]}\n";
    hold("a trunk", &system(trunk), 100_000);
    let point = "maps:\n  - {matrix: [[0, 0], [0, 0]], shift: [3, 1]}\n  \
                 - {matrix: [[0.5, 0], [0, 0]]}\n  - {scale: 1/3, shift: [0, 2]}\n";
    hold("a point", &system(point), 30_000);
}

/// Systems of the library whose copies become flat.
#[test]
fn the_librarys_systems_are_drawn_where_they_are() {
    let mut drawn = 0;
    for (name, system) in library() {
        let has_sets = !system.ifs().condensation().is_empty();
        let graph = graph(&system);
        if has_sets || graph.is_similar() {
            continue;
        }
        drawn += 1;
        hold(&name, &system, 50_000);
    }
    assert!(drawn >= 3, "{drawn}");
}

/// Trunks that each carry two lower ones, in colours by step.
#[test]
fn cells_tell_steps() {
    let tree = system(
        "maps:\n  - {matrix: [[0.5, 0], [0, 0.45]], shift: [-0.3, 1]}\n  \
         - {matrix: [[0.5, 0], [0, 0.45]], shift: [0.3, 1]}\ncondensation:\n  \
         - {polygon: [[-0.1, 0], [0.1, 0], [0.1, 1], [-0.1, 1]]}\nstyle: {color_by: step, palette: \
         [\"#ff0000\", \"#0000ff\"]}\n",
    );
    let graph = graph(&tree);
    let mut options = options(200, 1);
    options.style = tree.metadata().style.clone();
    let (bytes, picture) = drawn(&graph, &options);
    assert!(picture.is_limit);
    let mut decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::ALPHA);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let canvas = Canvas::fit(&graph.limit_bounds().unwrap(), Size::Long(200), 0.5).unwrap();
    let colour = |x: f64, y: f64| -> Vec<u8> {
        let at = canvas.pixel(DVec2::new(x, y));
        let [column, row] =
            [at.x, at.y].map(|at| (0..200).find(|it| f64::from(it + 1) > at).unwrap());
        let at = 4 * (row * info.width + column) as usize;
        pixels[at..at + 4].to_vec()
    };
    assert_eq!(colour(0.0, 0.5), [255, 0, 0, 255]);
    // One and two maps further up.
    let [first, second] = [colour(-0.3, 1.2), colour(-0.45, 1.53)];
    assert!(first[2] > 0 && first[2] < second[2], "{first:?} {second:?}");
    assert_eq!([first[3], second[3]], [255; 2]);
    assert_eq!(colour(-0.3, 0.5)[3], 0);
}

/// Where many copies overlap, nearly all pixels have the colour of the last step; the trunk, which copies do
/// not cover, keeps its own.
#[test]
fn cells_tell_the_steps_of_copies_that_overlap() {
    let style = "style: {color_by: step, palette: [\"#ff0000\", \"#0000ff\"]}\n";
    let crown = "maps:\n  - {scale: 0.9, rotate: 19, shift: [0, 1]}\n  - {scale: 0.9, shift: [0, 1]}\n  \
                 - {scale: 0.9, rotate: -19, shift: [0, 1]}\n";
    let trunk = "condensation:\n  - {polygon: [[-0.03, 0], [0.03, 0], [0.03, 1], [-0.03, 1]]}\n";
    let blues = |text: &str| -> (render::Picture, [usize; 2]) {
        let tree = system(text);
        let mut options = options(160, 1);
        options.style = tree.metadata().style.clone();
        let (bytes, picture) = drawn(&graph(&tree), &options);
        let mut decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
        decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::ALPHA);
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let drawn = pixels.chunks(4).filter(|pixel| pixel[3] == 255);
        let (blue, red): (Vec<&[u8]>, Vec<_>) = drawn.partition(|pixel| pixel[2] > pixel[0]);
        (picture, [blue.len(), red.len()])
    };
    let (picture, [blue, red]) = blues(&format!("{crown}{trunk}{style}"));
    assert!(picture.is_limit);
    assert!(blue > 5_000 && red > 10, "{blue} {red}");
    // The last steps alone.
    let (picture, [blue, red]) = blues(&format!("{crown}{style}"));
    assert!(picture.is_limit);
    assert!(blue > 5_000 && red < blue / 100, "{blue} {red}");
}

#[test]
fn threads_do_not_show_in_cells() {
    let style = "style: {color_by: step}\n";
    for seed in [1, 4] {
        for style in ["", style] {
            let system = system(&(random_system(seed) + style));
            let graph = graph(&system);
            let options =
                |threads: usize| options(300, threads).style(system.metadata().style.clone());
            let (expected, _) = drawn(&graph, &options(1));
            for threads in [2, 3, 8] {
                let (bytes, _) = drawn(&graph, &options(threads));
                assert!(bytes == expected, "{seed} on {threads} threads");
            }
        }
    }
}
