//! Films move steadily: neighbouring frames differ by what has moved between them, and by no more than that.

use std::fs;
use std::path::Path;

use kfrac::document::Setting;
use kfrac::geometry::DVec2;
use kfrac::grow::Growth;

use crate::common::{compiled, document, grown, resolved, said};

/// Runs the program in a folder, which must succeed.
fn succeeds(folder: &Path, arguments: &[&str]) {
    let (status, said) = said(folder, arguments);
    assert_eq!(status, Some(0), "{arguments:?}: {said}");
}

/// Returns the pixels of a PNG as red, green, blue and alpha.
fn pixels(path: &Path) -> Vec<u8> {
    tiny_skia::Pixmap::load_png(path).unwrap().take()
}

/// Returns the mean difference of two pictures, in levels of a channel.
fn apart(a: &[u8], b: &[u8]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
}

/// Two Koch curves, of which a parameter turns one.
const TURNING: &str = "params: {angle: {value: 20, min: 0, max: 90}}
initiator:
  connected: false
  elements:
    - {from: [0, 0], to: [1, 0]}
    - {from: [2, 0], to: [2 + cos(angle), sin(angle)]}
generator: [[0, 0], [1/3, 0], [1/2, 0.3], [2/3, 0], [1, 0]]
steps: 3
style: {width: 1.5, color_by: index}
";

/// Pixels farther than half the width and a pixel from all that moves are equal in neighbouring frames.
#[test]
fn pixels_far_from_what_moves_are_equal() {
    const FAR: f64 = 0.75 + 1.0;
    const SIZE: [usize; 2] = [160, 120];
    const SCALE: f64 = 40.0;
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("turning.yaml"), TURNING).unwrap();
    let film = [
        "animate",
        "turning.yaml",
        "--set",
        "angle=20..40",
        "--ease",
        "linear",
    ];
    let view = [
        "--view",
        "-0.5,-0.5,4,3",
        "--size",
        "160x120",
        "--frames",
        "5",
    ];
    succeeds(folder, &[&film[..], &view, &["-o", "frame%d.png"]].concat());
    // Ends of the elements, in pixels.
    let elements = |frame: usize| -> Vec<[DVec2; 2]> {
        let angle = format!("angle={}", 20 + 5 * frame);
        let list = ["grow", "turning.yaml", "--set", &angle, "-o", "list.csv"];
        succeeds(folder, &list);
        let list = fs::read_to_string(folder.join("list.csv")).unwrap();
        let ends = |row: &str| {
            let numbers: Vec<f64> = row.split(',').filter_map(|it| it.parse().ok()).collect();
            let place = |x: f64, y: f64| DVec2::new(x + 0.5, 2.5 - y) * SCALE;
            [place(numbers[3], numbers[4]), place(numbers[5], numbers[6])]
        };
        list.lines().skip(1).map(ends).collect()
    };
    let distance = |pixel: DVec2, [from, to]: [DVec2; 2]| {
        let way = to - from;
        let share = (pixel - from).dot(way) / way.length_squared();
        pixel.distance(from + way * share.clamp(0.0, 1.0))
    };
    for frame in 0..4 {
        let [before, after] = [frame, frame + 1].map(elements);
        let pairs = before.into_iter().zip(after);
        let moved: Vec<_> = pairs
            .filter(|(a, b)| a != b)
            .flat_map(|(a, b)| [a, b])
            .collect();
        assert_eq!(moved.len(), 2 * 4 * 4 * 4);
        let [before, after] =
            [frame, frame + 1].map(|it| pixels(&folder.join(format!("frame{it}.png"))));
        let mut changed = 0;
        for (number, (a, b)) in before.chunks(4).zip(after.chunks(4)).enumerate() {
            if a == b {
                continue;
            }
            changed += 1;
            let [x, y] = [number % SIZE[0], number / SIZE[0]].map(|it| it as f64 + 0.5);
            let near = moved.iter().map(|ends| distance(DVec2::new(x, y), *ends));
            let near = near.fold(f64::INFINITY, f64::min);
            assert!(near <= FAR, "frame {frame}: {x}, {y} is {near} pixels off");
        }
        assert!(changed > 50, "frame {frame}: {changed} pixels have changed");
    }
}

/// Draws belong to places in the tree of replacements: while a parameter moves, no branch jumps. Displacements shrink with
/// the step of the parameter, as those of a function with a derivative do.
#[test]
fn draws_stay_with_their_branches() {
    let cases = [
        ("archipelago", "relief", 0.1, 0.05),
        ("fern", "wind", 2.0, 1.0),
        ("forest-edge", "reach", 2.0, 0.5),
        ("sea-fan", "spread", 15.0, 2.0),
        ("vegetation", "reach", 20.0, 5.0),
    ];
    let mut steps_taken = 0;
    for (name, parameter, value, step) in cases {
        let document = document(name);
        let ends = |value: f64| -> Vec<[DVec2; 2]> {
            let rule = resolved(&document, &[Setting::from((parameter, value))]);
            let growth = Growth::steps(4).seed(7);
            let fractals = grown(&compiled(&rule, 4), &growth);
            let elements = fractals.iter().flat_map(|it| &it.elements);
            elements.map(|it| it.frame.ends()).collect()
        };
        let start = ends(value);
        let farthest = |step: f64| {
            let moved = ends(value + step);
            assert_eq!(moved.len(), start.len(), "{name}");
            let pairs = start.iter().flatten().zip(moved.iter().flatten());
            pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
        };
        let whole = farthest(step);
        assert!(whole > 0.0 && start.len() > 10, "{name}: {whole}");
        for parts in [4.0, 16.0] {
            let part = farthest(step / parts);
            assert!(part <= 1.5 * whole / parts, "{name}: {part} of {whole}");
            steps_taken += 1;
        }
    }
    assert_eq!(steps_taken, 10);
}

/// From the last frame to the first, a zoom without end changes as much as between any others, in its colours, too.
#[test]
fn endless_zooms_do_not_jump() {
    let cases = [
        ("koch", "0.(1)", "none"),
        ("pythagoras", "0.(2)", "step"),
        ("dragon", "0.(0)", "direction"),
    ];
    for (rule, at, color_by) in cases {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let film = [
            "animate",
            rule,
            "--zoom",
            "loop",
            "--at",
            at,
            "--color-by",
            color_by,
        ];
        let size = ["--size", "120x90", "--detail", "0.5", "--frames", "16"];
        succeeds(folder, &[&film[..], &size, &["-o", "zoom%d.png"]].concat());
        let frames: Vec<_> = (0..16)
            .map(|frame| pixels(&folder.join(format!("zoom{frame}.png"))))
            .collect();
        let next = |frame: usize| apart(&frames[frame], &frames[(frame + 1) % 16]);
        let most = (0..15).map(next).fold(0.0, f64::max);
        let wrap = next(15);
        assert!(
            most > 0.5 && wrap <= 1.2 * most,
            "{rule} at {at}: {wrap} after {most}"
        );
    }
}

/// Random iteration is drawn frame by frame as elements are, as pixels for any format.
#[test]
fn films_of_random_iteration_hold_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let film = [
        "animate",
        "barnsley-fern-four",
        "--method",
        "chaos",
        "--points",
        "20k",
    ];
    let seeds = ["--seed", "4..6", "--size", "80x100"];
    for file in ["film.y4m", "film%d.png"] {
        succeeds(folder, &[&film[..], &seeds, &["-o", file]].concat());
    }
    let y4m = fs::read(folder.join("film.y4m")).unwrap();
    let mut start = y4m.iter().position(|it| *it == b'\n').unwrap() + 1;
    assert_eq!(y4m.len() - start, 3 * (6 + 3 * 80 * 100));
    for frame in 0..3 {
        let own = pixels(&folder.join(format!("film{frame}.png")));
        start += 6;
        let luma = &y4m[start..start + 80 * 100];
        start += 3 * 80 * 100;
        for (pixel, luma) in own.chunks(4).zip(luma) {
            let [red, green, blue] = [0, 1, 2].map(|it| f64::from(pixel[it]));
            let expected = 16.0 + (65.481 * red + 128.553 * green + 24.966 * blue) / 255.0;
            assert!(
                (f64::from(*luma) - expected).abs() < 1.0,
                "{luma}, {expected}"
            );
        }
    }
}
