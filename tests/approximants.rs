//! Initiators that are approximants of other rules: growing goes on where the other rule has stopped.

use kfrac::Fractal;

/// Returns the drawing of an approximant.
fn svg(text: &str, steps: u32) -> String {
    Fractal::parse(text).unwrap().steps(steps).svg().unwrap()
}

fn mistakes(text: &str) -> String {
    Fractal::parse(text).err().unwrap().to_string()
}

#[test]
fn a_rule_goes_on_from_its_own_approximant() {
    for (name, steps, more) in [("koch", 2, 2), ("monkeys-tree", 1, 1), ("levy", 5, 3)] {
        let generator = Fractal::named(name).unwrap();
        let whole = format!("initiator: segment\ngenerator: {name}\n");
        let on = format!("initiator: {{from: {name}, steps: {steps}}}\ngenerator: {name}\n");
        assert_eq!(svg(&on, more), svg(&whole, steps + more), "{name}");
        let count = |text: &str, steps| {
            Fractal::parse(text)
                .unwrap()
                .steps(steps)
                .elements()
                .unwrap()
                .count()
        };
        assert_eq!(count(&on, 0), count(&whole, steps));
        assert_eq!(
            generator.steps(steps).elements().unwrap().count(),
            count(&on, 0)
        );
    }
}

#[test]
fn elements_keep_their_flags_and_directions() {
    // The trunk is infertile in the tree, and stays so.
    let tree = "\
initiator: segment
generator: [[0, 0], {to: [0, 1], fertile: false}, [1/2, 3/2], {to: [1, 1], direction: 3}, {to: [1, 0], visible: false, fertile: false}]
";
    let inner = tree.replace('\n', "\n  ");
    let on = format!(
        "initiator:\n  from:\n    {}\n  steps: 3\n{}",
        inner.replace("\n  ", "\n    ").trim_end(),
        &tree[tree.find("generator").unwrap()..]
    );
    for steps in 0..4 {
        assert_eq!(svg(&on, steps), svg(tree, steps + 3), "{on}");
    }
}

#[test]
fn other_rules_take_over_and_seeds_count() {
    let on = "initiator: {from: koch, steps: 1}\ngenerator: [[0, 0], [1/2, 1/2], [1, 0]]\n";
    let elements = Fractal::parse(on)
        .unwrap()
        .steps(2)
        .elements()
        .unwrap()
        .count();
    assert_eq!(elements, 16);
    let random = |seed: u32| {
        format!("initiator: {{from: random-tree, steps: 4, seed: {seed}}}\ngenerator: koch\n")
    };
    assert_eq!(svg(&random(0), 0), svg(&random(0), 0));
    assert_ne!(svg(&random(0), 0), svg(&random(1), 0));
    let grown = Fractal::named("random-tree").unwrap().seed(1).steps(4);
    assert_eq!(
        grown.elements().unwrap().count(),
        Fractal::parse(&random(1))
            .unwrap()
            .steps(0)
            .elements()
            .unwrap()
            .count()
    );
}

#[test]
fn what_is_no_approximant_is_an_error() {
    let of = |initiator: &str| mistakes(&format!("initiator: {initiator}\ngenerator: koch\n"));
    for (initiator, message) in [
        (
            "{from: koch, elements: [[0, 0], [1, 0]]}",
            "cannot stand together",
        ),
        (
            "{elements: [[0, 0], [1, 0]], steps: 3}",
            "belongs to an approximant",
        ),
        ("{from: gasket, steps: 2}", "production rule of the plane"),
        ("{from: kock, steps: 2}", "kock"),
        ("{from: koch, steps: 12}", "more than"),
        ("{closed: true}", "needs `elements`"),
    ] {
        let found = of(initiator);
        assert!(found.contains(message), "{initiator}: {found}");
    }
}
