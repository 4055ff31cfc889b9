//! Entries of lists with `for` are the entries that they stand for.

use kfrac::Fractal;
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;

/// Returns the SVG of a file at a number of steps, with values of parameters.
fn svg(text: &str, steps: u32, settings: &[(&str, f64)]) -> String {
    let mut fractal = Fractal::parse(text).unwrap_or_else(|error| panic!("{text}\n{error}"));
    for (name, value) in settings {
        fractal = fractal.set(name, *value).unwrap();
    }
    fractal.steps(steps).svg().unwrap()
}

#[test]
fn repetitions_are_the_entries_that_they_stand_for() {
    for (repeated, written, steps) in [
        (
            "kind: ifs\nmaps:\n  - {for: {k: 0..2}, scale: 1/2, translate: [cos(120*k), sin(120*k)]}\n  - {scale: 0.2}",
            "kind: ifs\nmaps:\n  - {scale: 1/2, translate: [cos(0), sin(0)]}\n  - {scale: 1/2, translate: [cos(120), \
             sin(120)]}\n  - {scale: 1/2, translate: [cos(240), sin(240)]}\n  - {scale: 0.2}",
            4,
        ),
        (
            "initiator: {elements: [[0, -1], {for: {k: 0..3}, to: [cos(90*k), sin(90*k)]}]}\ngenerator:\n  - [0, 0]\n  - {for: \
             {x: [1/3, 2/3], y: [0.1]}, each: [x, y]}\n  - [1, 0]",
            "initiator: {elements: [[0, -1], {to: [cos(0), sin(0)]}, {to: [cos(90), sin(90)]}, {to: [cos(180), sin(180)]}, \
             {to: [cos(270), sin(270)]}]}\ngenerator: [[0, 0], [1/3, 0.1], [2/3, 0.1], [1, 0]]",
            3,
        ),
        (
            "kind: instancing\nobjects:\n  dot: [{disk: {radius: 0.3}}]\n  row(0): [dot]\n  row(n): [{for: {x: 0..2, y: \
             0..x}, object: row(n - 1), scale: 1/4, translate: [x, -y]}]\nscene: [row(2)]",
            "kind: instancing\nobjects:\n  dot: [{disk: {radius: 0.3}}]\n  row(0): [dot]\n  row(n):\n    - {object: row(n - \
             1), scale: 1/4}\n    - {object: row(n - 1), scale: 1/4, translate: [1, 0]}\n    - {object: row(n - 1), scale: \
             1/4, translate: [1, -1]}\n    - {object: row(n - 1), scale: 1/4, translate: [2, 0]}\n    - {object: row(n - \
             1), scale: 1/4, translate: [2, -1]}\n    - {object: row(n - 1), scale: 1/4, translate: [2, -2]}\nscene: \
             [row(2)]",
            4,
        ),
        // Each instance is transformed once more than the one before, after its own transforms.
        (
            "kind: instancing\nparams: {n: 4}\nobjects:\n  leaf: [{polygon: [[0, 0], [1, 0.2], [1, -0.2]]}]\n  fan: [{object: \
             leaf, translate: [1, 0], repeat: {count: n - 1, rotate: 40, scale: 0.8}}]\nscene: [fan, {fractal: koch, scale: \
             0.5, repeat: {count: 2, transform: [{rotate: 90}, {translate: [1, 0]}]}}]",
            "kind: instancing\nobjects:\n  leaf: [{polygon: [[0, 0], [1, 0.2], [1, -0.2]]}]\n  fan:\n    - {object: leaf, \
             translate: [1, 0]}\n    - {object: leaf, transform: [{translate: [1, 0]}, {rotate: 40}, {scale: 0.8}]}\n    - \
             {object: leaf, transform: [{translate: [1, 0]}, {rotate: 40}, {scale: 0.8}, {rotate: 40}, {scale: 0.8}]}\n\
             scene: [fan, {fractal: koch, scale: 0.5}, {fractal: koch, transform: [{scale: 0.5}, {rotate: 90}, {translate: \
             [1, 0]}]}]",
            5,
        ),
        // A range that ends before it starts has no values, and repetitions lie within each other.
        (
            "kind: ifs\nmaps:\n  - {for: {k: 1..0}, scale: 1/2}\n  - {for: {k: 0..1}, scale: 1/2, translate: [k, 0]}\n\
             condensation:\n  - polygon: [[0, 0], {for: {k: 1..2}, each: [k, 1]}]",
            "kind: ifs\nmaps:\n  - {scale: 1/2}\n  - {scale: 1/2, translate: [1, 0]}\ncondensation:\n  - polygon: [[0, 0], \
             [1, 1], [2, 1]]",
            3,
        ),
    ] {
        assert_eq!(
            svg(repeated, steps, &[]),
            svg(written, steps, &[]),
            "{repeated}"
        );
        let catalogue = Catalogue::embedded();
        let document = Document::read(&Source::new("a", repeated), &catalogue).unwrap();
        let again = document.to_yaml();
        assert!(
            again.contains("for:") || again.contains("repeat:"),
            "{again}"
        );
        assert_eq!(svg(&again, steps, &[]), svg(written, steps, &[]), "{again}");
    }
}

#[test]
fn ranges_depend_on_parameters() {
    let repeated = |range: &str| {
        format!(
            "kind: ifs\nparams: {{n: 5, half: n/2}}\nmaps:\n  - {{for: {{k: {range}}}, scale: 1/4, translate: [k, k/2]}}"
        )
    };
    let written = |count: usize| {
        let map = |k: usize| format!("  - {{scale: 1/4, translate: [{k}, {k}/2]}}\n");
        "kind: ifs\nmaps:\n".to_owned() + &(0..count).map(map).collect::<String>()
    };
    for (range, n, count) in [("0..n - 1", 8, 8), ("0..n - 1", 2, 2), ("0..2*half", 6, 7)] {
        let text = repeated(range);
        let settings = [("n", f64::from(n))];
        assert_eq!(
            svg(&text, 3, &settings),
            svg(&written(count), 3, &[]),
            "{range} for {n}"
        );
    }
    // A parameter that only ranges use is used, and one that makes a range wrong is refused.
    let text = repeated("0..n - 1").replace(", half: n/2", "");
    let document =
        Document::read(&Source::new("a", text.as_str()), &Catalogue::embedded()).unwrap();
    assert!(document.resolve(&[]).unwrap().1.is_empty());
    let error = document.resolve(&[("n", 2.5).into()]).unwrap_err();
    assert!(
        error.to_string().contains("'n - 1' is no whole number"),
        "{error}"
    );
}
