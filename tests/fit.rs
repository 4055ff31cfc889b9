//! Systems that are fitted to pictures: measures, bounds, files and the command.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "pictures are small"
)]

mod methods;

use std::fs;
use std::num::NonZero;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use assert_cmd::Command;
use kfrac::fit::{
    Candidate, Certificate, Disk, Fit, FitError, FitOptions, FitProgress, Method, Score, Silhouette,
};
use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::about;
use kfrac::{Bits, Fractal, fit};
use proptest::collection::vec;
use proptest::{array, option, prelude::*};

/// Returns Sierpiński's gasket with its corners in a picture of 64 x 56 pixels.
fn gasket() -> Candidate {
    let half = DMat2::from_diagonal(DVec2::splat(0.5));
    let corners = [(2.3, 2.2), (61.6, 2.2), (31.95, 53.555306)];
    Candidate::of_maps(corners.map(|(x, y)| about(half, DVec2::new(x, y))).into())
}

fn picture(candidate: &Candidate, size: [usize; 2]) -> Silhouette {
    Silhouette::new(candidate.attractor(size, None).unwrap().pixels).unwrap()
}

/// Returns the picture of the gasket with its fit, which is made once.
fn quick() -> &'static (Silhouette, Fit) {
    static FITTED: OnceLock<(Silhouette, Fit)> = OnceLock::new();
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
    let dimension = found.dimension.as_ref().unwrap();
    assert_eq!(dimension.closed_form.as_deref(), Some("log(3)/log(2)"));
    assert!((72..=240).contains(&found.bits), "{}", found.bits);
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
    assert_eq!(
        Silhouette::new(Bits::new(8, 8)).unwrap_err(),
        FitError::Empty
    );
    assert_eq!(
        Silhouette::new(Bits::of(8, 8, |_, _| true)).unwrap_err(),
        FitError::Full
    );
    assert_eq!(
        Silhouette::new(Bits::of(8, 8, |x, y| x == 3 && y == 3)).unwrap_err(),
        FitError::OnePixel
    );
}

#[test]
fn huge_pictures_are_refused() {
    let huge = Silhouette::new(Bits::new(1 << 16, 2)).unwrap_err();
    assert!(matches!(huge, FitError::TooLarge { .. }), "{huge}");
}

/// The picture of an exact fit is fitted by the same maps, and that picture by the same file.
#[test]
fn a_fit_of_a_fit_is_the_same_file() {
    let options = options();
    let fitted = |candidate: &Candidate| {
        let shape = picture(candidate, [64, 56]);
        let found = fit(&shape, &options).unwrap();
        assert!(found.exact, "{found:?}");
        let file = found.yaml(&shape, "picture.png");
        (found, file)
    };
    let (first, _) = fitted(&gasket());
    let (second, file) = fitted(&first.candidate);
    let (_, again) = fitted(&second.candidate);
    assert_eq!(file, again);
    let pairs = first.candidate.maps.iter().zip(&second.candidate.maps);
    for (one, other) in pairs {
        assert!(one.abs_diff_eq(*other, 1e-9), "{one} {other}");
    }
}

/// A search that is stopped has the best system so far, one that is cancelled has none.
#[test]
fn stopped_searches_end_early() {
    let (shape, _) = quick();
    let set = Some(Arc::new(AtomicBool::new(true)));
    let whole = options().maps(2..=8).similar(false);
    let stopped = fit(shape, &whole.clone().stop(set.clone())).unwrap();
    assert_eq!(stopped.candidate.maps.len(), 2);
    let cancelled = fit(shape, &whole.cancel(set));
    assert!(matches!(cancelled, Err(FitError::Cancelled)));
}

/// The stem of a tree is the image of a flat map, as in Barnsley's fern.
#[test]
fn flat_maps_are_found() {
    let flat = DMat2::from_cols(DVec2::ZERO, DVec2::new(0.0, 0.4));
    let branch = |degrees: f64, tip: [f64; 2]| {
        let matrix = DMat2::from_angle(f64::to_radians(degrees)) * 0.55;
        let foot = DVec2::new(32.0, 2.5);
        DAffine2::from_mat2_translation(matrix, DVec2::from(tip) - matrix * foot)
    };
    let stem = about(flat, DVec2::new(32.0, 2.5));
    let tree = Candidate::of_maps(vec![
        stem,
        branch(40.0, [32.0, 22.0]),
        branch(-40.0, [32.0, 22.0]),
    ]);
    let shape = picture(&tree, [64, 56]);
    let found = fit(&shape, &options().similar(false).effort(6000)).unwrap();
    let flattest = { found.candidate.maps.iter() }
        .map(|map| map.matrix2.determinant().abs())
        .fold(f64::INFINITY, f64::min);
    assert!(flattest < 0.02 && found.score.hausdorff <= 4.0, "{found:?}");
}

/// Margins change nothing. A picture that is turned or doubled has a system that is turned or doubled: their pictures are
/// compared, as maps may turn by the symmetries of the set.
#[test]
fn moved_pictures_have_moved_maps() {
    let (shape, found) = quick();
    let [width, height] = shape.size();
    let bits = shape.bits();
    let moved = Bits::of(width + 9, height + 7, |column, row| {
        column >= 5
            && row >= 4
            && column < width + 5
            && row < height + 4
            && bits.get(column - 5, row - 4)
    });
    let shift = DAffine2::from_translation(DVec2::new(5.0, 3.0));
    let other = fit(&Silhouette::new(moved).unwrap(), &options()).unwrap();
    for (one, other) in found
        .candidate
        .moved(&shift)
        .maps
        .iter()
        .zip(&other.candidate.maps)
    {
        assert!(one.abs_diff_eq(*other, 1e-9), "{one} {other}");
    }
    let turned = Bits::of(height, width, |column, row| {
        bits.get(row, height - 1 - column)
    });
    let doubled = Bits::of(2 * width, 2 * height, |column, row| {
        bits.get(column / 2, row / 2)
    });
    let quarter = DAffine2::from_mat2_translation(
        DMat2::from_cols(DVec2::NEG_Y, DVec2::X),
        DVec2::new(0.0, width as f64),
    );
    let double = DAffine2::from_scale(DVec2::splat(2.0));
    for (bits, there) in [(turned, quarter), (doubled, double)] {
        let shape = Silhouette::new(bits).unwrap();
        let other = fit(&shape, &options()).unwrap();
        let moved = found.candidate.moved(&there);
        let [one, other] = [&moved, &other.candidate]
            .map(|candidate| candidate.attractor(shape.size(), None).unwrap().pixels);
        let score = Score::new(&one, &other);
        assert!(score.hausdorff <= 3.0 && score.iou > 0.6, "{score:?}");
    }
}

#[test]
fn progress_is_reported() {
    let progress = Arc::new(FitProgress::default());
    let (shape, _) = quick();
    let options = options()
        .method(Method::Collage)
        .progress(Some(progress.clone()));
    let found = fit(shape, &options).unwrap();
    assert_eq!(progress.evaluated(), found.evaluations);
    let best = progress.best().unwrap();
    assert!(best.maps == 3 && best.iou > 0.8, "{best:?}");
}

/// A line one pixel wide is a shape like any other.
#[test]
fn a_line_is_fitted() {
    let shape = Silhouette::new(Bits::of(64, 16, |x, y| (8..56).contains(&x) && y == 8)).unwrap();
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

proptest! {
    #![proptest_config(crate::common::cases(48))]

    #[test]
    fn the_bound_holds_for_any_candidate(
        maps in vec((array::uniform4(-0.65..0.65f64), array::uniform2(4.0..60.0f64)), 2..5),
        disk in option::of((array::uniform2(5.0..50.0f64), 0.0..12.0f64)),
    ) {
        let maps = maps.into_iter().map(|(matrix, fixed)| {
            about(DMat2::from_cols_array(&matrix), DVec2::from(fixed))
        });
        let mut wrong = Candidate::of_maps(maps.collect());
        wrong.disks.extend(disk.map(|(centre, radius)| Disk {
            centre: centre.into(),
            radius,
        }));
        let (shape, _) = quick();
        // Points outside the picture count for the attractor, which is drawn in a larger one.
        let roomy = DVec2::splat(128.0);
        let there = DAffine2::from_translation(roomy);
        let Ok(drawn) = wrong.moved(&there).attractor([320, 312], None) else {
            return Ok(());
        };
        prop_assume!(!drawn.leaves);
        let bits = shape.bits();
        let own = Bits::of(320, 312, |column, row| {
            (128..192).contains(&column) && (128..184).contains(&row) && bits.get(column - 128, row - 128)
        });
        let score = Score::new(&own, &drawn.pixels);
        let bound = Certificate::new(shape, &wrong).bound;
        prop_assert!(bound >= score.hausdorff, "{bound} {score:?}");
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

    let damaged = fs::read(&picture).unwrap();
    fs::write(&picture, &damaged[..damaged.len() / 2]).unwrap();
    let mut command = Command::cargo_bin("kfrac").unwrap();
    let output = command.arg("fit").arg(&picture).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("PNG cannot be read"),
        "{output:?}"
    );

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
