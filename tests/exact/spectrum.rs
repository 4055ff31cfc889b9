//! Spectra of dimensions D_q: exact where they are decided, and measured for comparison.

use std::fs;
use std::num::NonZero;

use kfrac::ifs::{Definition, Edge, Ifs, Map};
use kfrac::measure::exact::{Spectrum, dimensions_of_graph};
use kfrac::measure::{Cascade, Generalised};

use super::{common, line, near, similarity};

const ORDERS: [f64; 8] = [-2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0];

fn system(maps: &[(f64, f64, f64)]) -> Ifs {
    let maps = maps.iter();
    let maps = maps.map(|&(ratio, shift, weight)| Map::new(line(ratio, shift)).weighing(weight));
    let definition = Definition {
        maps: maps.collect(),
        ..Definition::default()
    };
    Ifs::new(definition).unwrap()
}

fn natural(name: &str) -> (Cascade, Option<Spectrum>) {
    let (model, _) = common::document(name).resolve(&[]).unwrap();
    let graph = model.compile(20).unwrap();
    let dimensions = dimensions_of_graph(&graph).dimensions.unwrap();
    (
        Cascade::natural(&graph).unwrap(),
        Spectrum::natural(&dimensions),
    )
}

/// Asserts that the measured spectrum lies within three standard errors of the exact one and close to it, and
/// does not increase.
fn assert_measured(name: &str, measure: &Cascade, exact: &Spectrum) {
    let series = NonZero::new(2).unwrap();
    let spectrum = Generalised::of_measure(measure, &ORDERS, None, series, series);
    let mut last = f64::INFINITY;
    for it in &spectrum {
        let estimate = it.estimate.unwrap();
        let off = (estimate.value - exact.at(it.order)).abs();
        let says = format!("{name}: D_{} off by {off}: {estimate:?}", it.order);
        assert!(
            off <= 0.03 && off <= 3.0 * estimate.std_error + 1e-6,
            "{says}"
        );
        assert!(estimate.value <= last, "{says}");
        last = estimate.value;
    }
}

#[test]
fn weights_on_a_cantor_set_have_their_closed_form() {
    let cantor = system(&[(1.0 / 3.0, 0.0, 1.0), (1.0 / 3.0, 2.0 / 3.0, 9.0)]);
    let spectrum = Spectrum::of_weights(&cantor).unwrap();
    for q in [-50.0, -2.0, 0.0, 0.5, 0.999, 2.0, 5.0, 50.0] {
        let sum = libm::pow(0.1, q) + libm::pow(0.9, q);
        let expected = libm::log(sum) / (1.0 - q) / libm::log(3.0);
        let found = spectrum.at(q);
        assert!((found - expected).abs() < 1e-9, "{q}: {found} {expected}");
    }
    let entropy = -(0.1 * libm::log(0.1) + 0.9 * libm::log(0.9));
    assert!(near(spectrum.at(1.0), entropy / libm::log(3.0)));
    let measure = Cascade::of_weights(&cantor).unwrap();
    assert_measured("cantor", &measure, &spectrum);
}

#[test]
fn pieces_that_touch_are_measured_with_what_lies_beside_them() {
    let binomial = system(&[(0.5, 0.0, 3.0), (0.5, 0.5, 7.0)]);
    let spectrum = Spectrum::of_weights(&binomial).unwrap();
    let measure = Cascade::of_weights(&binomial).unwrap();
    assert_measured("binomial", &measure, &spectrum);
}

#[test]
fn unequal_ratios_solve_their_equation() {
    let maps = [(0.5, 0.0, 3.0), (0.25, 0.75, 7.0)];
    let spectrum = Spectrum::of_weights(&system(&maps)).unwrap();
    // Σ p^q r^((1 − q) D_q) = 1.
    for q in [-3.0, -1.0, 0.0, 0.3, 2.0, 7.0] {
        let exponent = (1.0 - q) * spectrum.at(q);
        let part = |(ratio, _, weight): (f64, f64, f64)| {
            libm::pow(weight / 10.0, q) * libm::pow(ratio, exponent)
        };
        let sum: f64 = maps.into_iter().map(part).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{q}: {sum}");
    }
    let golden = f64::midpoint(1.0, libm::sqrt(5.0));
    assert!(near(spectrum.at(0.0), libm::log(golden) / libm::log(2.0)));
    // With the weights of the natural measure, all D_q are equal.
    let natural = [1.0 / golden, 1.0 / (golden * golden)];
    let maps = [(0.5, 0.0, natural[0]), (0.25, 0.75, natural[1])];
    let spectrum = Spectrum::of_weights(&system(&maps)).unwrap();
    for q in ORDERS {
        assert!(near(spectrum.at(q), libm::log(golden) / libm::log(2.0)));
    }
}

#[test]
fn a_recurrent_system_has_the_radius_of_a_matrix() {
    // Binary numbers without two consecutive ones; after 0, a 1 is three times as likely as a 0.
    let edge = |from, to, weight| Edge {
        from,
        to,
        weight: Some(weight),
    };
    let definition = Definition {
        maps: vec![Map::new(line(0.5, 0.0)), Map::new(line(0.5, 0.5))],
        edges: Some(vec![edge(0, 0, 1.0), edge(0, 1, 3.0), edge(1, 0, 1.0)]),
        ..Definition::default()
    };
    let ifs = Ifs::new(definition).unwrap();
    assert!(ifs.has_weights());
    let spectrum = Spectrum::of_weights(&ifs).unwrap();
    for q in [-2.0, 0.0, 0.5, 2.0, 5.0] {
        let (stay, leave) = (libm::pow(0.25, q), libm::pow(0.75, q));
        let radius = f64::midpoint(stay, libm::sqrt(stay * stay + 4.0 * leave));
        let expected = libm::log2(radius) / (1.0 - q);
        assert!(near(spectrum.at(q), expected), "{q}");
    }
    // The walk is in 0, where the next digit is drawn, four sevenths of the time.
    let entropy = -(0.25 * libm::log2(0.25) + 0.75 * libm::log2(0.75));
    assert!(near(spectrum.at(1.0), entropy * 4.0 / 7.0));
    let measure = Cascade::of_weights(&ifs).unwrap();
    assert_measured("golden", &measure, &spectrum);
}

#[test]
fn maps_that_are_listed_twice_are_one() {
    let twice = [(0.5, 0.0, 1.0), (0.5, 0.5, 7.0), (0.5, 0.0, 2.0)];
    let twice = Spectrum::of_weights(&system(&twice)).unwrap();
    let once = Spectrum::of_weights(&system(&[(0.5, 0.0, 3.0), (0.5, 0.5, 7.0)])).unwrap();
    assert!(ORDERS.into_iter().all(|q| near(twice.at(q), once.at(q))));
}

#[test]
fn weights_on_copies_that_overlap_are_not_decided() {
    let overlap = system(&[
        (1.0 / 3.0, 0.0, 1.0),
        (1.0 / 3.0, 2.0 / 9.0, 2.0),
        (1.0 / 3.0, 2.0 / 3.0, 3.0),
    ]);
    assert_eq!(Spectrum::of_weights(&overlap), None);
}

#[test]
fn natural_measures_have_one_dimension() {
    for name in [
        "gasket",
        "levy",
        "koch-snowflake",
        "koch-rings",
        "cantor",
        "plant-a",
    ] {
        let (_, spectrum) = natural(name);
        let spectrum = spectrum.unwrap();
        assert!(matches!(spectrum, Spectrum::Constant { .. }), "{name}");
        let dimension = spectrum.at(0.0);
        assert!(ORDERS.into_iter().all(|q| spectrum.at(q) == dimension));
    }
}

#[test]
fn natural_measures_are_measured() {
    // Pieces touch, coincide, or have a ratio that is not 1 / an integer.
    for name in ["gasket", "koch-rings", "pentagon"] {
        let (measure, spectrum) = natural(name);
        assert_measured(name, &measure, &spectrum.unwrap());
    }
}

#[test]
fn sets_that_hold_infinitely_many_copies_of_a_larger_one_are_not_decided() {
    use kfrac::measure::exact::{GraphDirectedSystem, dimensions};
    let quarter = |x, y| similarity(0.5, 0.0, false, [x, y]);
    let gasket = [quarter(0.0, 0.0), quarter(0.5, 0.0), quarter(0.25, 0.4)];
    let copies = gasket.map(|map| (1, 1, map));
    // A Cantor set of gaskets, and a single one beside it.
    let dust = [
        (0, 0, line(0.25, 0.0)),
        (0, 0, line(0.25, 3.0)),
        (0, 1, line(1.0, 1.0)),
    ];
    let held =
        dimensions(&GraphDirectedSystem::plane(dust.into_iter().chain(copies)).unwrap()).unwrap();
    assert!(held.hausdorff.value.is_some() && !held.regular);
    let beside = [(0, 1, line(1.0, 1.0)), (0, 1, line(1.0, 5.0))];
    let beside =
        dimensions(&GraphDirectedSystem::plane(beside.into_iter().chain(copies)).unwrap()).unwrap();
    assert!(beside.regular);
}

#[test]
fn the_program_tells_what_is_exact_beside_what_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let file =
        "kind: ifs\nmaps: [{scale: 1/3, weight: 1}, {scale: 1/3, shift: [2/3, 0], weight: 9}]\n";
    fs::write(folder.path().join("weighted.yaml"), file).unwrap();
    let run = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
        let output = command
            .current_dir(folder.path())
            .args(arguments)
            .output()
            .unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap()
    };
    let report = run(&[
        "dim",
        "weighted.yaml",
        "--json",
        "--grids",
        "2",
        "--orders",
        "1,-1",
    ]);
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["measure"], "weights");
    let information = &report["spectrum"][0];
    let [exact, value] = ["exact", "value"].map(|field| information[field].as_f64().unwrap());
    assert!((exact - 0.295_903_274_3).abs() < 1e-9, "{exact}");
    assert!((value - exact).abs() < 0.01, "{value}");
    let text = run(&["dim", "weighted.yaml", "--grids", "2", "--orders", "1"]);
    assert!(
        text.contains("of the measure given by the weights"),
        "{text}"
    );
    assert!(text.contains("0.295903"), "{text}");
}

#[test]
fn info_tells_similarity_dimensions_from_those_of_sets() {
    let folder = tempfile::tempdir().unwrap();
    let info = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
        let output = command
            .current_dir(folder.path())
            .arg("info")
            .args(arguments)
            .output();
        String::from_utf8(output.unwrap().stdout).unwrap()
    };
    for (name, similarity, own) in [
        ("ternary-tree", "10.618847905562", "at most 2 ("),
        ("plant-c", "3", "at most 2 ("),
        ("maple-leaf-chaos", "2.728515527250", "at most 2 ("),
        ("levy", "2", "2"),
        ("gasket", "1.584962500721", "1.584962500721 = log(3)/log(2)"),
        ("koch-rings", "1.806179973984", "1.556302500767"),
    ] {
        let text = info(&[name]);
        let similarity = similarity.trim_end_matches('0');
        assert!(
            text.contains(&format!("similarity dimension {similarity}")),
            "{text}"
        );
        assert!(
            text.contains(&format!("Hausdorff dimension {own}")),
            "{text}"
        );
        let json: serde_json::Value = serde_json::from_str(&info(&[name, "--json"])).unwrap();
        let hausdorff = &json["dimension"]["hausdorff"];
        assert!(
            hausdorff["upper_bound"].as_f64().unwrap() <= 2.0,
            "{hausdorff}"
        );
        assert_eq!(
            hausdorff["value"].is_null(),
            own.starts_with("at most"),
            "{name}"
        );
    }
}
