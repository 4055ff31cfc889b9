//! Curves that the library has as rules and as L-systems agree up to a similarity for each step.

use kfrac::catalogue::Catalogue;
use kfrac::document::Document;
use kfrac::geometry::DVec2;
use kfrac::grow::Growth;
use kfrac::model::Model;

use super::common::{compiled, document, grown, resolved};

fn lsystem(name: &str, steps: u32) -> Vec<[DVec2; 2]> {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule(name).unwrap();
    let (model, doubts) = Document::read(&source, &catalogue)
        .unwrap()
        .resolve(&[])
        .unwrap();
    assert!(doubts.is_empty(), "{doubts}");
    assert!(matches!(model, Model::LSystem(_)));
    let graph = model.compile(steps).unwrap();
    let grown = grown(&graph, &Growth::steps(steps));
    assert_eq!(grown.len(), 1);
    grown[0]
        .elements
        .iter()
        .map(|element| element.frame.ends())
        .collect()
}

/// Returns the ends of the elements of a rule, in the order of traversal.
fn rule(name: &str, steps: u32) -> Vec<[DVec2; 2]> {
    let rule = resolved(&document(name), &[]);
    let graph = compiled(&rule, steps);
    let grown = grown(&graph, &Growth::steps(steps));
    grown[0]
        .elements
        .iter()
        .map(|element| element.frame.ends())
        .collect()
}

/// Returns a complex product.
fn times(a: DVec2, b: DVec2) -> DVec2 {
    DVec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

fn conjugate(z: DVec2) -> DVec2 {
    DVec2::new(z.x, -z.y)
}

/// Asserts that the similarity that takes the ends of one list of points to those of another takes all
/// points.
fn assert_similar(what: &str, ours: &[DVec2], others: &[DVec2]) {
    assert_eq!(ours.len(), others.len(), "{what}");
    let chord = |points: &[DVec2]| points[points.len() - 1] - points[0];
    let (from, to) = (chord(ours), chord(others));
    let factor = times(to, conjugate(from)) / from.length_squared();
    for (number, (a, b)) in ours.iter().zip(others).enumerate() {
        let image = others[0] + times(factor, *a - ours[0]);
        let off = (image - *b).length();
        assert!(
            off < 1e-11 * to.length(),
            "{what}: point {number} is off by {off}"
        );
    }
}

#[test]
fn curves_agree_with_their_rules() {
    for (name, other) in [
        ("koch", "koch-lsystem"),
        ("dragon", "dragon-lsystem"),
        ("gosper", "gosper-lsystem"),
        ("terdragon", "terdragon-lsystem"),
        ("levy", "levy-lsystem"),
        ("sierpinski-arrowhead", "arrowhead-lsystem"),
    ] {
        for steps in 1..=6 {
            let [ours, others] = [lsystem(other, steps), rule(name, steps)];
            let what = format!("{name} at {steps}");
            assert_similar(&what, ours.as_flattened(), others.as_flattened());
        }
    }
}

/// The element of the rule is a cell, whose cup the L-system draws a step later.
#[test]
fn the_hilbert_curve_agrees_a_step_later() {
    let hilbert = resolved(&document("hilbert"), &[]);
    for steps in 1..=6 {
        let graph = compiled(&hilbert, steps);
        let grown = grown(&graph, &Growth::steps(steps));
        let mut points = Vec::new();
        for element in &grown[0].elements {
            let number = graph.objects()[element.object].base_element;
            let is_reversed = element.frame.direction().is_reversed();
            let (start, pieces) = graph.base_elements()[number].outline(is_reversed);
            let all = std::iter::once(start).chain(pieces.iter().map(|piece| piece.end()));
            points.extend(all.map(|point| element.frame.apply(point)));
        }
        let lines = lsystem("hilbert-lsystem", steps + 1);
        let ours: Vec<_> = { lines.iter().map(|[from, _]| *from) }
            .chain(lines.last().map(|[_, to]| *to))
            .collect();
        assert_similar(&format!("Hilbert at {steps}"), &ours, &points);
    }
}
