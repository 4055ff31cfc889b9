//! Laws that hold for every rule, tested on random ones.

mod lists;
mod places;
pub(crate) mod rules;
mod space;

use std::convert::Infallible;
use std::num::NonZero;
use std::sync::Arc;

use kfrac::Count;
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::geometry::{Bounds, DVec2, Direction, Frame2};
use kfrac::graph::Graph;
use kfrac::grow::{Element, FractalInfo, Growth, Progress, Visitor, walk};
use kfrac::model::Model;
use kfrac::render::{self, Options, Size};
use kfrac::rule::Rule;
use proptest::prelude::*;
use rules::Features;

fn read(text: &str) -> Arc<Rule> {
    model(text).into_rule().unwrap()
}

fn model(text: &str) -> Model {
    let source = Source::new("random.yaml", text);
    let document =
        Document::read(&source, &Catalogue::embedded()).unwrap_or_else(|e| panic!("{e}{text}"));
    let resolved = document.resolve(&[]);
    resolved.unwrap_or_else(|e| panic!("{e}{text}")).0
}

/// A visitor that records everything that a walk reports.
#[derive(Default)]
struct Collected {
    fractals: Vec<(FractalInfo, Vec<Element>, bool)>,
}

impl Collected {
    fn elements(&self) -> impl Iterator<Item = &Element> {
        self.fractals.iter().flat_map(|(_, elements, _)| elements)
    }
}

impl Visitor for Collected {
    type Error = Infallible;

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
        self.fractals.push((fractal, Vec::new(), false));
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.fractals.last_mut().unwrap().1.push(*element);
        Ok(())
    }

    fn end(&mut self, joined: bool) -> Result<(), Infallible> {
        self.fractals.last_mut().unwrap().2 = joined;
        Ok(())
    }
}

fn collect(graph: &Graph, steps: u32, seed: u64) -> Collected {
    let mut collected = Collected::default();
    let progress = Progress::default();
    let growth = Growth::steps(steps).seed(seed).progress(Some(&progress));
    let walked = walk(graph, &growth, &mut collected).unwrap();
    assert_eq!(progress.walked(), walked.elements);
    assert_eq!(walked.elements, collected.elements().count() as u64);
    assert_eq!(walked.fractals, collected.fractals.len() as u64);
    collected
}

fn close(a: DVec2, b: DVec2) -> bool {
    a.distance(b) <= 1e-12 * (1.0 + a.length())
}

proptest! {
    #![proptest_config(crate::common::cases(400))]

    /// Two engines agree: the walk over the graph, and Kaandorp's algorithm on lists.
    #[test]
    fn the_walk_agrees_with_kaandorps_lists(text in rules::rule(Features::ALL), steps in 0..4u32, seed in 0..3u64) {
        let rule = read(&text);
        let graph = Graph::compile(&rule, steps).unwrap();
        let walked = collect(&graph, steps, seed);
        let grown = lists::grow(&rule, steps, seed);
        let listed = grown.all();
        prop_assert_eq!(walked.fractals.len(), listed.len());
        for ((fractal, elements, end), list) in walked.fractals.iter().zip(listed) {
            prop_assert_eq!(fractal.age, list.age);
            prop_assert_eq!(elements.len(), list.items.len());
            let drawn = |item: &lists::Item| item.listed.visible;
            for (number, (element, item)) in elements.iter().zip(&list.items).enumerate() {
                prop_assert_eq!(element.index, number as u128 + 1);
                prop_assert_eq!(element.frame.direction(), item.frame.direction());
                let [from, to] = element.frame.ends();
                let [from_, to_] = item.frame.ends();
                prop_assert!(close(from, from_) && close(to, to_));
                prop_assert!((element.length - item.length).abs() < 1e-12);
                prop_assert_eq!(element.fertile, item.listed.fertile);
                prop_assert_eq!(element.born, item.born);
                prop_assert_eq!(graph.objects()[element.object].visible, item.listed.visible);
                if number > 0 {
                    let joined = item.joined && drawn(item) && drawn(&list.items[number - 1]);
                    prop_assert_eq!(element.joined, joined, "element {} of {}", number + 1, elements.len());
                }
            }
            if let (Some(first), Some(item), Some(last)) = (elements.first(), list.items.first(), list.items.last()) {
                prop_assert_eq!(first.joined && *end, item.joined && drawn(item) && drawn(last));
            }
        }
    }

    /// The forecast of a regular rule, from powers of the replacement matrix, agrees with the counts of the
    /// walk.
    #[test]
    fn the_forecast_agrees_with_the_walk(text in rules::rule(Features::ALL), steps in 0..4u32, seed in 0..3u64) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        let Some(mut forecast) = graph.forecast() else {
            prop_assert!(!graph.is_regular() || !graph.is_plain());
            return Ok(());
        };
        for _ in 0..steps {
            prop_assert!(forecast.advance());
        }
        let level = forecast.level();
        let walked = collect(&graph, steps, seed);
        prop_assert_eq!(level.elements, Count::from(walked.elements().count()));
        prop_assert_eq!(level.fertile, Count::from(walked.elements().filter(|element| element.fertile).count()));
        prop_assert_eq!(level.fractals, Count::from(walked.fractals.len()));
        if let Some(forecast) = level.length {
            let length: f64 = walked.elements().map(|element| element.frame.length()).sum();
            prop_assert!((forecast - length).abs() < 1e-9 * (1.0 + length));
        }
    }

    /// The bounds computed from the graph are the bounds of the elements in the walk.
    #[test]
    fn the_bounds_agree_with_the_walk(text in rules::rule(Features::DETERMINISTIC), steps in 0..4u32) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        let Some(bounds) = graph.bounds(steps) else { return Ok(()) };
        let mut walked = Bounds::EMPTY;
        for element in collect(&graph, steps, 0).elements() {
            if graph.objects()[element.object].visible {
                element.frame.ends().into_iter().for_each(|end| walked.add(end));
            }
        }
        prop_assert!(close(bounds.min(), walked.min()) && close(bounds.max(), walked.max()),
            "{:?} {:?}", bounds, walked);
    }

    /// The bounds of approximants converge to those of the limit set; where approximants become empty, there
    /// is no limit set.
    #[test]
    fn the_bounds_converge_to_those_of_the_limit(text in rules::rule(Features::REGULAR)) {
        let graph = Graph::compile(&read(&text), 0).unwrap();
        let Some(limit) = graph.limit_bounds() else { return Ok(()) };
        // 60 levels of ratios up to 3/4 leave 3e-8.
        let ratios = graph.objects().iter().filter_map(|object| match &object.replacement {
            kfrac::graph::Replacement::Fixed(production) => Some(production),
            _ => None,
        });
        let longest = ratios
            .flat_map(|production| production.body.instances.iter().chain(production.seeds.iter().flat_map(|s| &s.chain.instances)))
            .filter(|instance| !matches!(graph.objects()[instance.object].replacement, kfrac::graph::Replacement::Kept))
            .map(|instance| instance.length)
            .fold(0.0, f64::max);
        prop_assume!(longest < 0.75);
        let near = |bounds: &Bounds| {
            bounds.min().distance(limit.min()) < 1e-5 && bounds.max().distance(limit.max()) < 1e-5
        };
        // A rule that alternates draws its limit set recurrently, not at every step.
        let boxes: Vec<_> = (60..66).map(|steps| graph.bounds(steps)).collect();
        prop_assert!(boxes.iter().flatten().any(near), "{:?} {:?}", limit, boxes);
    }

    /// Growing commutes with a similarity of the initiator.
    #[test]
    fn growing_commutes_with_a_similarity(
        text in rules::rule(Features { seeds: false, ..Features::ALL }),
        steps in 0..4u32,
        (x, y) in (-3..4i32, 1..4i32),
        (a, b) in (-2..3i32, -2..3i32),
    ) {
        // The map z → s z + t is applied to the initiator's points as written.
        let (sx, sy) = (f64::from(x) / 3.0, f64::from(y) / 3.0);
        let turned = turn_initiator(&text, [sx, sy], [f64::from(a), f64::from(b)]);
        let similarity = Frame2::between(
            DVec2::new(f64::from(a), f64::from(b)),
            DVec2::new(f64::from(a) + sx, f64::from(b) + sy),
            Direction::Normal,
        );
        let walk_of = |text: &str| {
            let graph = Graph::compile(&read(text), steps).unwrap();
            collect(&graph, steps, 0)
        };
        let (plain, moved) = (walk_of(&text), walk_of(&turned));
        prop_assert_eq!(plain.elements().count(), moved.elements().count());
        for (plain, moved) in plain.elements().zip(moved.elements()) {
            let expected = plain.frame.ends().map(|point| similarity.apply(point));
            let found = moved.frame.ends();
            prop_assert!(close(expected[0], found[0]) && close(expected[1], found[1]));
            prop_assert_eq!(plain.frame.direction(), moved.frame.direction());
        }
    }

    /// Joined elements meet in a point.
    #[test]
    fn connected_chains_stay_connected(text in rules::rule(Features::ALL), steps in 0..4u32) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        for (_, elements, end) in collect(&graph, steps, 1).fractals {
            for pair in elements.windows(2).filter(|pair| pair[1].joined) {
                prop_assert!(close(pair[0].frame.ends()[1], pair[1].frame.ends()[0]));
            }
            if let ([first, ..], [.., last], true) = (elements.as_slice(), elements.as_slice(), end) {
                prop_assert!(!first.joined || close(last.frame.ends()[1], first.frame.ends()[0]));
            }
        }
    }

    /// Approximant n + 1 of a random rule refines approximant n: its elements that are not new are the
    /// infertile ones of n, and new elements exist only where n has fertile ones.
    #[test]
    fn the_next_approximant_refines_this_one(text in rules::rule(Features::ALL), steps in 0..3u32, seed in 0..3u64) {
        let rule = read(&text);
        let graph = Graph::compile(&rule, steps + 1).unwrap();
        let (now, next) = (collect(&graph, steps, seed), collect(&graph, steps + 1, seed));
        let kept = |element: &&Element| !element.fertile;
        let old = |element: &&Element| element.born <= steps;
        let stands: Vec<_> = now.elements().filter(kept).map(|element| element.frame).collect();
        let stays: Vec<_> = next.elements().filter(old).map(|element| element.frame).collect();
        prop_assert_eq!(stands.len(), stays.len());
        for frame in &stays {
            prop_assert!(stands.contains(frame));
        }
        // New elements require a fertile one.
        let fertile = now.elements().filter(|element| element.fertile).count();
        let new = next.elements().filter(|element| element.born == steps + 1).count();
        prop_assert!(fertile > 0 || new == 0);
    }

    /// Equal input gives equal bytes.
    #[test]
    fn two_runs_give_the_same_bytes(text in rules::rule(Features::ALL), steps in 0..4u32, seed in 0..3u64) {
        let draw = |threads| {
            let rule = read(&text);
            let graph = Graph::compile(&rule, steps).unwrap();
            let mut bytes = Vec::new();
            let growth = Growth::steps(steps).seed(seed);
            let options = Options::of(rule.metadata()).size(Size::Long(300)).threads(threads);
            let drawn = render::write(&graph, &growth, &options, &mut bytes);
            (drawn.map_err(|error| error.to_string()), bytes)
        };
        let [one, three] = [1, 3].map(|threads| NonZero::new(threads).unwrap());
        prop_assert_eq!(draw(one), draw(three));
    }
}

/// Returns the rule with z → s z + t applied to the initiator's points, in their expressions.
fn turn_initiator(text: &str, [sx, sy]: [f64; 2], [tx, ty]: [f64; 2]) -> String {
    let (initiator, rest) = text.split_once("generators:").unwrap();
    let mut turned = String::new();
    let mut left = initiator;
    while let Some(start) = left.find('[') {
        let end = left.find(']').unwrap();
        let (x, y) = left[start + 1..end].split_once(", ").unwrap();
        turned.push_str(&left[..start]);
        turned.push_str(&format!(
            "[({sx})*({x}) - ({sy})*({y}) + ({tx}), ({sy})*({x}) + ({sx})*({y}) + ({ty})]"
        ));
        left = &left[end + 1..];
    }
    format!("{turned}{left}generators:{rest}")
}

#[test]
fn directions_multiply_like_the_klein_four_group() {
    use Direction::{BothReflected, Normal, XReflected, YReflected};
    let table = [
        [Normal, YReflected, XReflected, BothReflected],
        [YReflected, Normal, BothReflected, XReflected],
        [XReflected, BothReflected, Normal, YReflected],
        [BothReflected, XReflected, YReflected, Normal],
    ];
    for (a, row) in Direction::ALL.into_iter().zip(table) {
        for (b, product) in Direction::ALL.into_iter().zip(row) {
            assert_eq!(a * b, product);
            // The maps of the directions multiply alike, with elements from 0 to 1.
            let frames =
                [a, b, product].map(|direction| Frame2::between(DVec2::ZERO, DVec2::X, direction));
            assert!(
                frames[0]
                    .compose(&frames[1])
                    .map()
                    .abs_diff_eq(*frames[2].map(), 1e-15)
            );
        }
    }
}

/// A visitor that receives elements in blocks.
struct Blocks(Collected);

impl Visitor for Blocks {
    type Error = Infallible;

    fn takes_runs(&self) -> bool {
        true
    }

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
        self.0.begin(fractal)
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.0.element(element)
    }

    fn end(&mut self, joined: bool) -> Result<(), Infallible> {
        self.0.end(joined)
    }
}

/// Asserts that a walk by blocks agrees with one by elements.
fn blocks_agree(graph: &Graph, growth: &Growth<'_>) {
    let (mut single, mut blocks) = (Collected::default(), Blocks(Collected::default()));
    let walked = walk(graph, growth, &mut single).unwrap();
    assert_eq!(walk(graph, growth, &mut blocks).unwrap(), walked);
    assert_eq!(single.fractals.len(), blocks.0.fractals.len());
    for ((fractal, elements, end), (fractal_, elements_, end_)) in
        single.fractals.iter().zip(&blocks.0.fractals)
    {
        assert_eq!(
            (fractal, end, elements.len()),
            (fractal_, end_, elements_.len())
        );
        for (element, block) in elements.iter().zip(elements_) {
            let same = |e: &Element| {
                (
                    e.frame.direction(),
                    e.index,
                    e.object,
                    e.born,
                    e.fertile,
                    e.joined,
                )
            };
            assert_eq!(same(element), same(block));
            let ([from, to], [from_, to_]) = (element.frame.ends(), block.frame.ends());
            assert!(close(from, from_) && close(to, to_));
            let size = element.frame.map().matrix2.y_axis;
            assert!(close(size, block.frame.map().matrix2.y_axis));
            assert!((element.length - block.length).abs() <= 1e-12 * element.length);
        }
    }
}

#[test]
fn blocks_of_the_library_are_the_elements_one_by_one() {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries();
    for entry in entries.iter().filter(|entry| entry.shelf == Shelf::RULES) {
        let source = catalogue.open(entry).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let Some(rule) = document.resolve(&[]).unwrap().0.into_rule() else {
            continue;
        };
        let steps = rule.steps().unwrap_or(6);
        let graph = Graph::compile(&rule, steps).unwrap();
        blocks_agree(&graph, &Growth::steps(steps).seed(3));
    }
}

proptest! {
    #![proptest_config(crate::common::cases(200))]

    #[test]
    fn blocks_are_the_elements_one_by_one(text in rules::rule(Features::ALL), steps in 0..5u32, seed in 0..3u64) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        blocks_agree(&graph, &Growth::steps(steps).seed(seed));
    }
}
