//! Systems that are fitted to pictures: measures, bounds, files and the command.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "pictures are small"
)]

use std::fs;
use std::num::NonZero;
use std::sync::OnceLock;

use assert_cmd::Command;
use kfrac::fit::{Candidate, Certificate, Fit, FitError, FitOptions, Score, Shape};
use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::about;
use kfrac::{Bits, Fractal, fit};

/// Returns Sierpiński's gasket with its corners in a picture of 64 x 56 pixels.
fn gasket() -> Candidate {
    let half = DMat2::from_diagonal(DVec2::splat(0.5));
    let corners = [(2.3, 2.2), (61.6, 2.2), (32.1, 53.4)];
    Candidate::of_maps(corners.map(|(x, y)| about(half, DVec2::new(x, y))).into())
}

fn picture(candidate: &Candidate, size: [usize; 2]) -> Shape {
    Shape::new(candidate.attractor(size, None).unwrap().pixels).unwrap()
}

/// Returns the picture of the gasket with its fit, which is made once.
fn quick() -> &'static (Shape, Fit) {
    static FITTED: OnceLock<(Shape, Fit)> = OnceLock::new();
    FITTED.get_or_init(|| {
        let shape = picture(&gasket(), [64, 56]);
        let fitted = fit(&shape, &options().threads(NonZero::<usize>::MIN)).unwrap();
        (shape, fitted)
    })
}

fn options() -> FitOptions {
    FitOptions::default().maps(3..=3).similar(true).effort(2000)
}

#[test]
fn the_gasket_is_found() {
    let (_, found) = quick();
    assert!(
        found.score.iou > 0.9 && found.score.hausdorff < 2.0,
        "{found:?}"
    );
    assert!(found.certificate.bound >= found.score.hausdorff);
    let mut ratios = found
        .candidate
        .maps
        .iter()
        .map(|map| map.matrix2.determinant().abs().sqrt());
    assert!(ratios.all(|ratio| (ratio - 0.5).abs() < 1e-12), "{found:?}");
    assert!(found.exact, "{found:?}");
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let (shape, found) = quick();
    let other = fit(shape, &options().threads(NonZero::new(3).unwrap())).unwrap();
    assert_eq!(found.yaml(shape, "x.png"), other.yaml(shape, "x.png"));
}

/// Every point of the attractor has its pixel.
#[test]
fn attractors_are_exact() {
    let turned = DMat2::from_angle(0.7) * 0.6;
    let candidate = Candidate::of_maps(vec![
        about(turned, DVec2::new(20.0, 22.0)),
        about(
            DMat2::from_diagonal(DVec2::new(0.5, -0.4)),
            DVec2::new(38.0, 31.0),
        ),
    ]);
    let pixels = candidate.attractor([64, 64], None).unwrap().pixels;
    let mut points = vec![DVec2::new(20.0, 22.0)];
    for _ in 0..16 {
        points = points
            .iter()
            .flat_map(|p| candidate.maps.iter().map(|map| map.transform_point2(*p)))
            .collect();
    }
    // A part of a sixteenth of a pixel may lie in two pixels, of which one is drawn.
    let away = [0.0, 0.125, -0.125];
    for point in points {
        let mut around = away
            .iter()
            .flat_map(|x| away.map(|y| point + DVec2::new(*x, y)));
        assert!(
            around.any(|it| pixels.get(it.x as usize, (64.0 - it.y) as usize)),
            "{point}"
        );
    }
}

#[test]
fn scores_are_those_of_known_sets() {
    let square = |from: usize, to: usize| {
        Bits::of(40, 40, |column, row| {
            (from..to).contains(&column) && (10..20).contains(&row)
        })
    };
    let score = Score::new(&square(10, 20), &square(15, 25));
    assert_eq!(score.iou, 1.0 / 3.0);
    assert_eq!(score.hausdorff, 5.0);
    assert_eq!(score.mean_distance, 1.5);
    assert_eq!(score.coverage, 0.7);
}

#[test]
fn pictures_without_a_shape_are_refused() {
    assert_eq!(Shape::new(Bits::new(8, 8)).unwrap_err(), FitError::Empty);
    assert_eq!(
        Shape::new(Bits::of(8, 8, |_, _| true)).unwrap_err(),
        FitError::Full
    );
    assert_eq!(
        Shape::new(Bits::of(8, 8, |x, y| x == 3 && y == 3)).unwrap_err(),
        FitError::OnePixel
    );
}

/// A line one pixel wide is a shape like any other.
#[test]
fn a_line_is_fitted() {
    let shape = Shape::new(Bits::of(64, 16, |x, y| (8..56).contains(&x) && y == 8)).unwrap();
    let found = fit(&shape, &FitOptions::default().maps(2..=2).effort(1500)).unwrap();
    assert!(found.score.hausdorff <= 2.0, "{found:?}");
}

/// The file draws the attractor in the place of the picture.
#[test]
fn files_are_grown_in_place() {
    let (shape, found) = quick();
    let fractal = Fractal::parse(&found.yaml(shape, "gasket.png")).unwrap();
    let drawn = fractal.pixels((64, 56)).unwrap();
    let mut rows = drawn.premultiplied().chunks_exact(4 * 64);
    let mut grown = Bits::new(64, 56);
    for row in 0..56 {
        let pixels = rows.next().unwrap().chunks_exact(4);
        pixels
            .enumerate()
            .filter(|(_, pixel)| pixel[3] > 0)
            .for_each(|(column, _)| grown.set(column, row));
    }
    let score = Score::new(shape.bits(), &grown);
    assert!(score.hausdorff <= 3.0, "{score:?}");
    assert!(fractal.set("bend", 10.0).is_ok());
}

#[test]
fn the_bound_holds_for_any_candidate() {
    let shape = picture(&gasket(), [64, 56]);
    for (number, factor) in [0.5, 0.7, 0.9].into_iter().enumerate() {
        let turn = DMat2::from_angle(number as f64) * factor;
        let wrong = Candidate::of_maps(vec![
            about(turn, DVec2::new(20.0, 20.0)),
            about(
                DMat2::from_cols(DVec2::new(0.4, 0.3), DVec2::new(-0.6, 0.1)),
                DVec2::new(40.0, 30.0),
            ),
        ]);
        let drawn = wrong.attractor([64, 56], None).unwrap().pixels;
        let score = Score::new(shape.bits(), &drawn);
        let bound = Certificate::new(&shape, &wrong).bound;
        assert!(bound >= score.hausdorff, "{bound} {score:?}");
    }
}

#[test]
fn the_command_writes_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let [picture, rule] = ["gasket.png", "rule.yaml"].map(|name| folder.path().join(name));
    let drawn = Fractal::named("gasket").unwrap().png(64).unwrap();
    fs::write(&picture, drawn).unwrap();
    let mut command = Command::cargo_bin("kfrac").unwrap();
    command.arg("fit").arg(&picture).arg("-o").arg(&rule);
    let output = command
        .args(["--maps", "3", "--effort", "2000", "--json"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["maps"], 3);
    assert!(report["iou"].as_f64().unwrap() > 0.7, "{report}");
    assert!(report["bound"].as_f64() >= report["hausdorff"].as_f64());
    Fractal::open(&rule).unwrap();

    fs::write(&picture, Fractal::named("gasket").unwrap().svg().unwrap()).unwrap();
    let mut command = Command::cargo_bin("kfrac").unwrap();
    let output = command.arg("fit").arg(&picture).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("neither PNG, JPEG"),
        "{output:?}"
    );
}

/// A map of the plane moves a candidate and its picture alike.
#[test]
fn candidates_are_moved() {
    let there = DAffine2::from_translation(DVec2::new(3.0, -1.0));
    let moved = gasket().moved(&there);
    let shape = picture(&gasket(), [64, 56]);
    let other = picture(&moved, [67, 57]);
    // Pixels that the attractor only touches may be drawn or not.
    let [count, other] = [shape.points().len(), other.points().len()];
    assert!(count.abs_diff(other) * 20 < count, "{count} {other}");
}
