//! Tweens: fractals between two of one kind, over all pairs of neighbours in the library.

use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::geometry::{DVec2, DVec3, Frame as _};
use kfrac::model::Model;
use kfrac::tween::{TweenBy, TweenError};
use kfrac::{Element, Fractal};

const COURSES: [TweenBy; 2] = [TweenBy::Polar, TweenBy::Matrix];

/// Returns the names of all fractals of the library, with their models.
fn library() -> Vec<(String, Fractal)> {
    let catalogue = Catalogue::embedded();
    let grown = Shelf::grown();
    let entries = catalogue.entries();
    let entries = entries.iter().filter(|entry| grown.contains(&entry.shelf));
    let names = entries.map(|entry| entry.name.clone());
    names
        .map(|name| (name.clone(), Fractal::named(&name).unwrap().steps(2)))
        .collect()
}

/// Returns the ends of all elements in the plane or in space.
fn ends(fractal: &Fractal) -> Vec<[DVec3; 2]> {
    if fractal.model().is_in_space() {
        let all = fractal.elements_in_space().unwrap();
        return all.map(|it| it.unwrap().frame.ends()).collect();
    }
    let flat = |element: Element| element.frame.ends().map(|it| it.extend(0.0));
    let all = fractal.elements().unwrap();
    all.map(|it| flat(it.unwrap())).collect()
}

/// Returns the largest coordinate of points.
fn size(ends: &[[DVec3; 2]]) -> f64 {
    let all = ends.iter().flatten().map(|it| it.abs().max_element());
    all.fold(1.0, f64::max)
}

#[test]
fn tweens_begin_and_end_with_their_fractals_and_do_not_jump() {
    let library = library();
    let (mut between, mut refused) = (0, Vec::new());
    for (number, (name, a)) in library.iter().enumerate() {
        let kind = |it: &Fractal| (it.model().kind(), it.model().is_in_space());
        let next = library[number + 1..].iter();
        let Some((other, b)) = { next }.find(|(_, it)| kind(it) == kind(a)) else {
            continue;
        };
        for by in COURSES {
            let at = |share: f64| a.toward(b, share, by).map(|it| it.steps(2));
            let half = match at(0.23) {
                Ok(half) => half,
                Err(error) => {
                    refused.push(format!("{name} to {other}: {error}"));
                    continue;
                }
            };
            assert_eq!(at(0.0).unwrap().model(), a.model(), "{name} to {other}");
            assert_eq!(at(1.0).unwrap().model(), b.model(), "{name} to {other}");
            let before = ends(&half);
            let after = ends(&at(0.23 + 1e-7).unwrap());
            assert_eq!(before.len(), after.len(), "{name} to {other}");
            let size = size(&before).max(size(&ends(b)));
            for (before, after) in before.iter().zip(&after) {
                let moved = [0, 1].map(|end| before[end].distance(after[end]));
                let is_near = moved.iter().all(|moved| *moved < 1e-4 * size);
                assert!(is_near, "{name} to {other}: {moved:?} of {size}");
            }
            between += 1;
        }
    }
    assert!(between > 150, "{between}");
    let others = refused.iter().filter(|it| !it.contains("L-systems"));
    let others: Vec<_> = others.collect();
    assert!(others.len() < 40, "{others:#?}");
}

#[test]
fn tweens_near_their_ends_are_near_their_fractals() {
    for (from, to) in [
        ("koch", "levy"),
        ("levy", "koch"),
        ("pythagoras", "monkeys-tree"),
        ("dragon", "koch-snowflake"),
        ("menger", "icosahedron-flake"),
        ("gasket", "barnsley-fern"),
    ] {
        let [a, b] = [from, to].map(|name| Fractal::named(name).unwrap().steps(3));
        for by in COURSES {
            for (share, end) in [(1e-9, &a), (1.0 - 1e-9, &b)] {
                let near = ends(&a.toward(&b, share, by).unwrap().steps(3));
                let end = ends(end);
                // Elements that have no counterpart are points.
                let far = |own: &[DVec3; 2]| {
                    let all = end
                        .iter()
                        .map(|it| it[0].distance(own[0]) + it[1].distance(own[1]));
                    all.fold(f64::INFINITY, f64::min)
                };
                let is_point = |it: &[DVec3; 2]| it[0].distance(it[1]) < 1e-7;
                let apart = near.iter().filter(|it| !is_point(it)).map(far);
                assert!(
                    apart.fold(0.0, f64::max) < 1e-6,
                    "{from} to {to} at {share}"
                );
            }
        }
    }
}

#[test]
fn a_chain_keeps_its_ends_and_turns_between_them() {
    let parse = |points: &str| {
        let text = format!("initiator: segment\ngenerator: [[0, 0], {points}, [1, 0]]\n");
        Fractal::parse(&text).unwrap()
    };
    let (up, down) = (parse("[0, 1/2]"), parse("[0, -1/2]"));
    let half = up.toward(&down, 0.5, TweenBy::Matrix).unwrap().steps(1);
    let middle: Vec<_> = ends(&half);
    assert_eq!(middle[0][1], DVec3::ZERO);
    // Opposite vectors turn; their chain still runs from (0, 0) to (1, 0).
    let half = up.toward(&down, 0.5, TweenBy::Polar).unwrap().steps(1);
    let turned = ends(&half);
    assert_eq!(turned[0][0], DVec3::ZERO);
    assert!(turned[0][1].distance(DVec3::ZERO) > 0.3);
    assert!((turned[1][1].truncate() - DVec2::X).length() < 1e-12);
    let small = Fractal::named("koch").unwrap();
    let reason = |a: &Fractal, b: &str| {
        let b = Fractal::named(b).unwrap();
        a.model()
            .toward(b.model(), 0.5, TweenBy::Polar)
            .unwrap_err()
    };
    assert!(matches!(reason(&small, "gasket"), TweenError::Kinds(..)));
    let plant = Fractal::named("plant-a").unwrap();
    assert!(matches!(plant.model(), Model::LSystem(_)));
    assert_eq!(reason(&plant, "bush"), TweenError::LSystems);
}
