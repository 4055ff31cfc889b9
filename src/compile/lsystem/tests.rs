//! Compares compiled graphs of L-systems with derived words.

use std::convert::Infallible;
use std::sync::Arc;

use crate::catalogue::{Catalogue, Shelf};
use crate::count::Count;
use crate::diagnostic::Source;
use crate::document::Document;
use crate::extent::bounding_box;
use crate::geometry::{Bounds, DVec2, Frame2};
use crate::graph::Graph;
use crate::grow::{Element, Growth, Visitor, walk};
use crate::lsystem::LSystem;
use crate::model::Model;
use crate::style::Colour;

use super::effects::Effects;

mod limits;
mod named;
mod random;

/// Element as drawn.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) points: Vec<DVec2>,
    pub(super) joined: bool,
    pub(super) fertile: bool,
    pub(super) visible: bool,
    pub(super) direction: u8,
    pub(super) width: f64,
    pub(super) colour: Colour,
}

struct Collector<'g> {
    graph: &'g Graph,
    drawn: Vec<Drawn>,
}

impl Visitor for Collector<'_> {
    type Error = Infallible;

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        let object = &self.graph.objects()[element.object];
        let map = element.frame.map();
        let base_element = &self.graph.base_elements()[object.base_element];
        let (start, pieces) = base_element.outline(false);
        let mut points = vec![
            map.transform_point2(DVec2::ZERO),
            map.transform_point2(DVec2::X),
        ];
        points.push(map.transform_point2(start));
        points.extend(pieces.iter().map(|piece| piece.transformed(map).end()));
        self.drawn.push(Drawn {
            points,
            joined: element.joined,
            fertile: element.fertile,
            visible: object.visible,
            direction: element.frame.direction().number(),
            width: element.appearance.width(),
            colour: element.appearance.on(Colour::BLACK),
        });
        Ok(())
    }
}

pub(super) fn system(text: &str) -> Arc<LSystem> {
    let source = Source::new("test.yaml", format!("kind: lsystem\n{text}"));
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    match document.resolve(&[]).unwrap().0 {
        Model::LSystem(system) => system,
        _ => unreachable!(),
    }
}

pub(super) fn drawn(graph: &Graph, steps: u32, seed: u64) -> Vec<Drawn> {
    let mut collector = Collector {
        graph,
        drawn: Vec::new(),
    };
    let growth = Growth {
        seed,
        ..Growth::steps(steps)
    };
    walk(graph, &growth, &mut collector).unwrap();
    collector.drawn
}

/// Asserts that a compiled graph and the derived word draw equal elements at a step, in order.
pub(super) fn assert_same(name: &str, compiled: &Graph, system: &LSystem, steps: u32, seed: u64) {
    let words = Graph::of_derived_word(system, steps, seed, 1_000_000).unwrap();
    let (ours, theirs) = (drawn(compiled, steps, seed), drawn(&words, steps, seed));
    assert_eq!(ours.len(), theirs.len(), "{name} at step {steps}");
    let size = theirs.iter().flat_map(|element| &element.points);
    let size = size.map(|point| point.length()).fold(1.0, f64::max);
    // The compiled graph scales drawings beyond 1e150 to a reach of about 1; that of the word does not.
    if size > 1e147 {
        return;
    }
    for (number, (a, b)) in ours.iter().zip(&theirs).enumerate() {
        let what = format!("{name}: element {number} of step {steps}: {a:?} {b:?}");
        // Rounding decides whether a side is added to close an outline, and whether the outline has an
        // extent.
        let point = |all: &[DVec2], number: usize| all.get(number).copied().unwrap_or(all[2]);
        let is_speck = |all: &[DVec2]| all[2..].iter().all(|p| p.distance(all[2]) < 1e-9 * size);
        let points = match [a, b].iter().any(|drawn| is_speck(&drawn.points)) {
            true => 2,
            false => a.points.len().max(b.points.len()),
        };
        for number in 0..points {
            let off = point(&a.points, number) - point(&b.points, number);
            assert!(off.length() < 1e-9 * size, "{what}");
        }
        assert_eq!(a.joined, b.joined, "{what}");
        assert_eq!(a.direction, b.direction, "{what}");
        assert_eq!(a.colour, b.colour, "{what}");
        // Below the least normal number, single precision represents widths with fewer digits.
        let width = b.width.max(f32::MIN_POSITIVE.into());
        assert!((a.width - b.width).abs() <= 1e-5 * width, "{what}");
    }
}

fn compiled(system: &LSystem, steps: u32) -> Graph {
    let effects = Effects::of_system(system, steps).unwrap();
    Graph::of_levels(effects, steps).unwrap()
}

/// Systems that rewrite edges draw the elements of their words, up to a similarity for each step.
#[test]
fn edges_draw_what_words_draw() {
    for text in [
        "angle: 60\naxiom: F--F--F\nproductions: {F: F+F--F+F}\n",
        "angle: 90\naxiom: F\nsymbols: {G: draw}\nproductions: {F: F+G, G: F-G}\n",
        "angle: 60\naxiom: A\nsymbols: {A: draw, B: draw}\nproductions: {A: A-B--B+A++AA+B-, B: +A-BB--B-A++A+B}\n",
        "angle: 120\nheading: 30\nlength: 2\naxiom: F\nproductions: {F: F+F-F}\n",
        "angle: 25\naxiom: F\nproductions: {F: 'F[+F]F'}\n",
        "angle: 60\naxiom: F\nproductions: {F: FfF, f: fff}\n",
        "angle: 45\naxiom: F\nsymbols: {R: reflect}\nproductions: {F: '+RFR-[-F]-RFR+'}\n",
        "angle: 60\naxiom: \"'(1)F--!(3)F--'F\"\nproductions: {F: F+F--F+F}\n",
        "angle: 25\naxiom: F\nproductions: {F: \"F['!+F]F\"}\n",
        "angle: 60\naxiom: F\nsymbols: {G: draw}\nproductions: {F: \"'(1)!(1)F+'(2)!(2)G--'(1)!(1)F+'(2)F\", G: \"'(3)!(1)G+'(4)!(2)F--'(5)!(1)F+'(3)!(2)G\"}\n",
    ] {
        let system = system(text);
        let graph = Graph::of_edges(&system).expect(text);
        for steps in 0..=4 {
            let words = Graph::of_derived_word(&system, steps, 0, 1_000_000).unwrap();
            let (ours, theirs) = (drawn(&graph, steps, 0), drawn(&words, steps, 0));
            assert_eq!(ours.len(), theirs.len(), "{text} at {steps}");
            // Applies the similarity that maps the first line to (0, 0) and (1, 0).
            let ratio = |all: &[Drawn], point: DVec2| {
                let [from, to] = [all[0].points[0], all[0].points[1]];
                let along = to - from;
                DVec2::new(along.x, -along.y).rotate(point - from) / along.length_squared()
            };
            for (a, b) in ours.iter().zip(&theirs) {
                for (x, y) in a.points.iter().zip(&b.points) {
                    let off = ratio(&ours, *x) - ratio(&theirs, *y);
                    assert!(off.length() < 1e-6, "{text} at {steps}: {off}");
                }
                assert_eq!((a.joined, a.direction), (b.joined, b.direction));
                assert_eq!(a.colour, b.colour, "{text} at {steps}");
                assert!(
                    (a.width - b.width).abs() < 1e-5 * b.width,
                    "{text} at {steps}"
                );
            }
        }
    }
}

#[test]
fn levels_draw_what_words_draw() {
    for text in [
        "angle: 60\naxiom: F--F--F\nproductions: {F: F+F--F+F}\n",
        "angle: 90\naxiom: FX\nproductions: {X: X+YF+, Y: -FX-Y}\n",
        "angle: 25.7\naxiom: X\nproductions: {X: 'F[+X][-X]FX', F: FF}\n",
        "angle: 22.5\nheading: 90\nlength: 0.3\naxiom: X\nproductions: {X: 'F-[[X]+X]+F[+FX]-X', F: FF}\n",
        "angle: 30\naxiom: A\nsymbols: {R: reflect, S: {scale: 2/3}}\nproductions: {A: 'F[RS+A]S-A'}\n",
        "angle: 20\naxiom: A\nproductions: {A: \"!F['+A][-A]fA\"}\n",
        "angle: 45\naxiom: A\nproductions: {A: '[+A{.-FFF-F+f}.]FA'}\n",
        "axiom: '[A]f[B]'\nangle: 17.3\nproductions: {A: 'FBA', B: '+fF-[A]'}\n",
        "axiom: A(1)\nangle: 40\nproductions:\n- 'A(l) : l > 1/8 -> !(l)F(l)[+(40)A(l/2)][-(20)A(3/4*l)]'\n",
    ] {
        let system = system(text);
        for steps in 0..=5 {
            let graph = compiled(&system, steps.max(4));
            assert_same(text, &graph, &system, steps, 0);
            let mut forecast = graph.forecast().unwrap();
            for _ in 0..steps {
                assert!(forecast.advance());
            }
            let found = drawn(&graph, steps, 0);
            let level = forecast.level();
            assert_eq!(level.elements.to_u64(), Some(found.len() as u64));
            let fertile = found.iter().filter(|element| element.fertile).count();
            assert_eq!(level.fertile.to_u64(), Some(fertile as u64));
        }
    }
}

/// Random productions yield equal individuals in both ways.
#[test]
fn drawn_productions_draw_what_words_draw() {
    for text in [
        "angle: 25.7\naxiom: F\nproductions: {F: ['F[+F]F[-F]F', 'F[+F]F', {to: 'F[-F]F', weight: 2}]}\n",
        "angle: 30\naxiom: '[X]f[X]f(2)[+X]'\nproductions: {X: ['F[+X]-X', 'FX', '[!X]', 'F{.+f-f-f.}X', ''], F: FF}\n",
        "angle: 20\naxiom: A\nsymbols: {R: reflect}\nproductions:\n- 'A -> F[RB]-A'\n- {production: 'B -> F+B', weight: 1/3}\n- {production: 'B -> fA', weight: 2/3}\n",
        "angle: 45\naxiom: A(1)\nproductions:\n- {production: \"A(l) : l > 1/9 -> F(l)['+A(l/2)]-A(l/2)F\", weight: 1}\n- {production: 'A(l) : l > 1/5 -> F(l)-A(l/2)', weight: 2}\n",
    ] {
        let system = system(text);
        for steps in 0..=5 {
            let graph = compiled(&system, steps.max(4));
            assert!(graph.draws());
            for seed in 0..4 {
                assert_same(text, &graph, &system, steps, seed);
            }
        }
    }
}

/// For all L-systems of the library that can be compiled, forecasts and bounds match the walks, and
/// drawings match the words.
#[test]
fn library() {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries();
    let mut counts = [0; 2];
    let mut words = Vec::new();
    for entry in entries
        .iter()
        .filter(|entry| entry.shelf == Shelf::LSYSTEMS)
    {
        let document = Document::read(&catalogue.open(entry).unwrap(), &catalogue).unwrap();
        // Systems in space are held against their words in `tests/lsystem/space.rs`.
        let Model::LSystem(system) = document.resolve(&[]).unwrap().0 else {
            continue;
        };
        let name = &entry.name;
        counts[0] += usize::from(Graph::of_edges(&system).is_ok());
        let levels = |steps| {
            let effects = Effects::<Frame2>::of_system(&system, steps)?;
            Graph::of_levels(effects, steps)
        };
        let most = system.deepest(6, 1_000);
        let Ok(graph) = levels(most) else {
            words.push(name.as_str());
            continue;
        };
        counts[1] += 1;
        for steps in 0..=most {
            assert_same(name, &graph, &system, steps, 1);
        }
        assert_reported(&graph, most);
        if let Ok(edges) = Graph::of_edges(&system) {
            assert_reported(&edges, most);
        }
    }
    // Systems with drawn numbers and with contexts are not compiled.
    assert_eq!(words, ["rowan", "signals-a", "signals-e"]);
    assert!(counts[0] >= 7 && counts[1] >= 25, "{counts:?}");
}

/// Asserts that forecast and bounds match the elements of a walk.
fn assert_reported(graph: &Graph, steps: u32) {
    let found = drawn(graph, steps, 1);
    if let Some(mut forecast) = graph.forecast() {
        for _ in 0..steps {
            assert!(forecast.advance());
        }
        let level = forecast.level();
        assert_eq!(level.elements.to_u64(), Some(found.len() as u64));
        let fertile = found.iter().filter(|element| element.fertile).count();
        assert_eq!(level.fertile.to_u64(), Some(fertile as u64));
    } else {
        assert!(graph.draws());
    }
    let mut all = Bounds::EMPTY;
    // Fertile elements are drawn in the last step, polygons without extent never.
    let shown = found.iter().filter(|element| element.visible);
    let points = shown.flat_map(|element| &element.points[2..]);
    points.for_each(|point| all.add(*point));
    if all.is_empty() {
        return;
    }
    let growth = Growth {
        seed: 1,
        ..Growth::steps(steps)
    };
    let both = [graph.bounds(steps), bounding_box(graph, &growth).ok()];
    assert!(both[0].is_some() || graph.draws());
    for bounds in both.into_iter().flatten() {
        let off = (bounds.min() - all.min()).length() + (bounds.max() - all.max()).length();
        assert!(off <= 1e-9 * all.size().length(), "{bounds:?} {all:?}");
    }
}

/// Counts and headings are exact at any step: the heading of Koch's curve is multiplied by 4 at each
/// step.
#[test]
fn a_thousand_steps_are_exact() {
    let dragon = system("axiom: FX\nproductions: {X: X+YF+, Y: -FX-Y}\n");
    let graph = compiled(&dragon, 1000);
    let mut forecast = graph.forecast().unwrap();
    let mut power = Count::from(1u64);
    for _ in 0..1000 {
        assert!(forecast.advance());
        let same = power.clone();
        power += &same;
    }
    assert_eq!(forecast.elements(), power);
    // The figure recurs after eight steps, with twice the width for every two.
    let [last, before] = [990, 982].map(|steps| graph.bounds(steps).unwrap());
    let ratio = last.size() / before.size();
    assert!((ratio - 16.0).abs().max_element() < 1e-9, "{ratio}");

    let koch = system("angle: 360/7\naxiom: F\nproductions: {F: F+F--F+F+}\n");
    let effects = Effects::<Frame2>::of_system(&koch, 1000).unwrap();
    let mut heading = 0;
    for left in 1..=1000 {
        heading = (4 * heading + 1) % 7;
        let parts = effects.compass.parts();
        let pose = effects.of(0, left).unwrap().state.pose;
        assert_eq!(pose.heading, heading * (parts / 7));
    }
}

/// The displacements of the Penrose tiling nearly cancel; doubles would lose all digits by step 60.
#[test]
fn deep_steps_look_as_shallow_ones() {
    let productions = "{1: '', 6: '81++91----71[-81----61]++', 7: '+81--91[---61--71]+', \
                       8: '-61++71[+++81++91]-', 9: '--81++++61[+91++++71]--71'}";
    let system = system(&format!(
        "angle: 36\naxiom: '[7]++[7]++[7]++[7]++[7]'\nsymbols: {{1: draw}}\nproductions: {productions}\n"
    ));
    let proportions = |steps| {
        let graph = Graph::of_lsystem(&system, steps, 0, 1_000_000).unwrap();
        let size = graph.bounds(steps).unwrap().size();
        size.y / size.x
    };
    let shallow = proportions(24);
    for steps in [60, 100, 400, 1000] {
        let deep = proportions(steps);
        assert!(
            (deep - shallow).abs() < 1e-4,
            "{deep} at step {steps}, not {shallow}"
        );
    }
}
