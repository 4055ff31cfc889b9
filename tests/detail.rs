//! Pictures to a detail: everything visible is drawn, and little of the invisible is grown.

use std::convert::Infallible;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use crate::common::{self, compiled, document, document_of, resolved};
use crate::laws::rules::{self, Features};
use kfrac::document::Document;
use kfrac::geometry::DVec2;
use kfrac::graph::Graph;
use kfrac::grow::{Element, Enter, FractalInfo, Growth, Subtree, Visitor, walk};
use kfrac::render::{self, Detail, Format, NoDetail, Options, Picture, RenderError, Size};
use kfrac::rule::Rule;
use kfrac::style::{ColorBy, View};
use proptest::prelude::*;

fn library(name: &str) -> Arc<Rule> {
    resolved(&document(name), &[])
}

fn read(text: &str) -> Arc<Rule> {
    let document: Document = document_of(text);
    let resolved = document.resolve(&[]);
    let (model, _) = resolved.unwrap_or_else(|e| panic!("{e}{text}"));
    model.into_rule().unwrap()
}

/// A visitor that collects elements down to a length, and the subtrees replaced by their elements.
#[derive(Default)]
struct Cut {
    shortest: f64,
    /// Residue modulo 3 of birth plus object for which subtrees are skipped, if any are.
    skipped: Option<usize>,
    replaced: Vec<Subtree>,
    fractals: Vec<(FractalInfo, Vec<Element>, bool)>,
}

impl Cut {
    fn to(shortest: f64) -> Self {
        Self {
            shortest,
            ..Self::default()
        }
    }

    fn walked(mut self, graph: &Graph, steps: u32, seed: u64) -> Self {
        let growth = Growth::steps(steps).seed(seed);
        walk(graph, &growth, &mut self).unwrap();
        self
    }

    fn elements(&self) -> impl Iterator<Item = &Element> {
        self.fractals.iter().flat_map(|(_, elements, _)| elements)
    }
}

impl Visitor for Cut {
    type Error = Infallible;

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
        self.fractals.push((fractal, Vec::new(), false));
        Ok(())
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        let number = subtree.born as usize + subtree.object;
        if self.skipped.is_some_and(|skipped| number % 3 == skipped) {
            return Enter::Skip;
        }
        if subtree.frame.length() < self.shortest {
            return Enter::Keep;
        }
        self.replaced.push(*subtree);
        Enter::Replace
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

/// Formats all properties of elements except their rank.
fn told(elements: &[Element]) -> String {
    let told = |e: &Element| {
        format!(
            "{:?}{}{}{}{}",
            e.frame, e.object, e.born, e.fertile, e.joined
        )
    };
    elements.iter().map(told).collect()
}

fn close(a: DVec2, b: DVec2) -> bool {
    a.distance(b) <= 1e-12 * (1.0 + a.length())
}

/// Asserts that joined elements meet in a point.
fn assert_joined(fractals: &[(FractalInfo, Vec<Element>, bool)]) {
    for (_, elements, end) in fractals {
        for pair in elements.windows(2).filter(|pair| pair[1].joined) {
            assert!(close(pair[0].frame.ends()[1], pair[1].frame.ends()[0]));
        }
        if let ([first, ..], [.., last], true) = (&elements[..], &elements[..], end) {
            assert!(!first.joined || close(last.frame.ends()[1], first.frame.ends()[0]));
        }
    }
}

proptest! {
    #![proptest_config(common::cases(200))]

    /// A detail finer than the elements of a walk changes nothing.
    #[test]
    fn what_is_not_small_is_not_cut(text in rules::rule(Features::ALL), steps in 0..4u32, seed in 0..3u64) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        let plain = common::grown(&graph, &Growth::steps(steps).seed(seed));
        let cut = Cut::to(1e-9).walked(&graph, steps, seed);
        prop_assert_eq!(plain.len(), cut.fractals.len());
        for (plain, (fractal, elements, _)) in plain.iter().zip(&cut.fractals) {
            prop_assert_eq!(plain.fractal, *fractal);
            prop_assert_eq!(told(&plain.elements), told(elements));
        }
    }

    /// Cut elements have their frames in their own approximant, and all small elements are cut.
    #[test]
    fn what_is_cut_stands_as_in_its_approximant(text in rules::rule(Features::ALL), steps in 1..5u32, seed in 0..3u64) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        prop_assume!(!graph.counts_index());
        let cut = Cut::to(0.3).walked(&graph, steps, seed);
        for replaced in &cut.replaced {
            prop_assert!(replaced.frame.length() >= 0.3);
        }
        let approximants: Vec<_> = (0..=steps)
            .map(|step| Cut::to(0.0).walked(&graph, step, seed))
            .collect();
        for element in cut.elements() {
            let small = element.frame.length() < 0.3;
            prop_assert!(small || !element.fertile || element.born == steps);
            let mut stood = approximants[element.born as usize].elements();
            prop_assert!(stood.any(|e| (e.frame, e.object, e.born, e.fertile)
                == (element.frame, element.object, element.born, element.fertile)));
        }
        assert_joined(&cut.fractals);
    }

    /// A skipped element leaves a gap: nothing is joined across it, and nothing else is missing.
    #[test]
    fn what_is_skipped_leaves_a_gap(text in rules::rule(Features::ALL), steps in 1..4u32, skipped in 0..3usize) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        prop_assume!(!graph.counts_index());
        let gaps = Cut { skipped: Some(skipped), ..Cut::default() }.walked(&graph, steps, 0);
        let plain = Cut::default().walked(&graph, steps, 0);
        assert_joined(&gaps.fractals);
        // The visited elements keep their order; only elements inside gaps are missing.
        let mut left = plain.elements();
        for element in gaps.elements() {
            prop_assert!(left.any(|e| e.frame == element.frame && e.object == element.object));
        }
    }
}

fn drawn(rule: &Arc<Rule>, steps: u32, options: &Options) -> (Picture, Vec<u8>) {
    let mut bytes = Vec::new();
    let graph = compiled(rule, steps);
    let picture = render::write(&graph, &Growth::steps(steps), options, &mut bytes).unwrap();
    (picture, bytes)
}

/// Returns the options of a picture of a window.
fn window(rule: &Rule, window: [f64; 4], side: u32) -> Options {
    Options::of(rule.metadata())
        .format(Format::Png)
        .view(View {
            window: Some(window),
            margin: Some(0.0),
        })
        .size(Size::Exactly(side, side))
}

#[test]
fn what_lies_outside_a_window_is_not_visited() {
    let elements = |name: &str, steps, place| {
        let rule = library(name);
        drawn(&rule, steps, &window(&rule, place, 100)).0.elements
    };
    // The tip of the curve, a fiftieth of it: an 18th of 4^9 elements if they were spread evenly.
    let tip = elements("koch", 9, [0.49, 0.28, 0.02, 0.02]);
    assert!((1000..10_000).contains(&tip), "{tip}");
    assert!(elements("koch", 12, [0.4999, 0.2886, 0.0002, 0.0002]) < 10_000);
    assert_eq!(elements("koch", 1000, [2.0, 2.0, 0.02, 0.02]), 0);
    assert!(elements("pythagoras", 18, [0.0, 0.0, 0.1, 0.1]) < 100_000);
    // Seeds inside a square stay in it; seeds placed as the initiator may lie anywhere.
    assert!(elements("self-seeding-square", 4, [0.5, 0.5, 0.02, 0.02]) < 1000);
    let vegetation = library("vegetation");
    let [small, large] = [[0.0, 0.0, 0.01, 0.01], [-9.0, -9.0, 18.0, 18.0]]
        .map(|place| elements("vegetation", 4, place));
    assert_eq!(small, large, "{:?}", vegetation.description().title);
    // Elements coloured by index are counted without a visit, except in fractals.
    let mut options = window(&library("koch"), [0.49, 0.28, 0.02, 0.02], 100);
    let mut by = |color_by| {
        options.style.color_by = color_by;
        drawn(&library("koch"), 5, &options).0.elements
    };
    assert!((10..200).contains(&by(ColorBy::Index)));
    assert_eq!(by(ColorBy::Fractal), 1024);
}

/// Returns a detail in pixels.
fn detail(pixels: f64, decides_steps: bool) -> Option<Detail> {
    Some(Detail {
        pixels,
        decides_steps,
    })
}

#[test]
fn elements_are_replaced_until_they_are_smaller() {
    for (name, limit) in [
        ("koch", 30),
        ("koch", 4),
        ("dragon", 40),
        ("pythagoras", 30),
        ("self-seeding-square", 10),
        ("random-tree", 40),
        ("sea-fan", 40),
    ] {
        let rule = library(name);
        let graph = compiled(&rule, limit);
        // The window is large enough for all elements, at 100 pixels a unit.
        let mut options = window(&rule, [-40.0, -40.0, 80.0, 80.0], 8000);
        options.format = Format::Svg;
        options.detail = detail(3.0, limit > 4);
        let growth = Growth::steps(limit);
        let picture = render::write(&graph, &growth, &options, &mut Vec::new()).unwrap();
        let cut = Cut::to(0.03).walked(&graph, limit, 0);
        assert_eq!(picture.elements, cut.elements().count() as u64, "{name}");
        assert_eq!(picture.fractals, cut.fractals.len() as u64, "{name}");
        let last = cut.replaced.iter().map(|replaced| replaced.born + 1).max();
        assert_eq!(Some(picture.steps), last, "{name}");
        assert!(cut.replaced.iter().all(|e| e.frame.length() >= 0.03));
        assert!(
            cut.elements()
                .all(|e| e.frame.length() < 0.03 || !e.fertile || e.born == 4)
        );
        // Growing as many steps gives an identical picture, colours by step and age included.
        let mut again = options.clone().detail(detail(3.0, false));
        for by in [ColorBy::Step, ColorBy::Age] {
            options.style.color_by = by;
            again.style.color_by = by;
            let mut pictures = [Vec::new(), Vec::new()];
            render::write(&graph, &growth, &options, &mut pictures[0]).unwrap();
            let growth = Growth::steps(picture.steps);
            render::write(&graph, &growth, &again, &mut pictures[1]).unwrap();
            assert!(pictures[0] == pictures[1], "{name} by {by:?}");
        }
    }
}

#[test]
fn the_detail_is_that_of_the_picture_as_it_comes_out() {
    // Two pixels from end to end, one pixel of margin and half of the stroke on either side.
    let options = |pixels| {
        Options::default()
            .size(Size::Exactly(732, 732))
            .detail(detail(pixels, true))
            .style(kfrac::style::Style {
                width: kfrac::style::Width::Pixels(1.0),
                ..Default::default()
            })
            .view(View {
                window: None,
                margin: Some(1.0),
            })
    };
    let koch = library("koch");
    let graph = compiled(&koch, 0);
    let steps = |pixels| {
        let growth = Growth::steps(1_000_000);
        let picture = render::write(&graph, &growth, &options(pixels), &mut Vec::new()).unwrap();
        assert_eq!(picture.elements, 4u64.pow(picture.steps));
        picture.steps
    };
    // 729 = 3⁶ pixels: strokes extend beyond the ends by half their width, or by the length of a mitre.
    let ends = (steps(1.1), steps(0.9), steps(0.37), steps(2.9), steps(3.1));
    assert_eq!(ends, (6, 7, 7, 6, 5));
}

#[test]
fn what_has_no_end_is_refused() {
    let refused = |rule: Arc<Rule>, limit| {
        let graph = compiled(&rule, limit);
        let options = Options::of(rule.metadata()).detail(detail(1.0, true));
        let growth = Growth::steps(limit);
        match render::write(&graph, &growth, &options, &mut Vec::new()) {
            Err(RenderError::NoDetail(why)) => why,
            other => panic!("{other:?}"),
        }
    };
    let counts = "initiator: segment\ngenerator: [[0, 0], [1/2 + i/99, 0], [1, 0]]";
    assert_eq!(refused(read(counts), 3), NoDetail::CountsIndex);
    assert_eq!(refused(library("vegetation"), 30), NoDetail::DoesNotShrink);
    let few = NoDetail::TooFewSteps { steps: 3 };
    assert_eq!(refused(library("koch"), 3), few);
    let shrinks = |text: &str| compiled(&read(text), 4).shrinks();
    assert!(shrinks(
        "initiator: segment\ngenerator: [[0, 0], [1/2, 1/2], [1, 0]]"
    ));
    assert!(!shrinks(
        "initiator: segment\ngenerator: [[0, 0], [0, 1], [1, 0]]"
    ));
    // Larger at every other step, but smaller in the end.
    let alternating = "initiator: {elements: [[0, 0], {to: [1, 0], use: a}]}\n\
        generators:\n  a: [[0, 0], {to: [2, 0], use: b}]\n  b: [[0, 0], {to: [SIZE, 0], use: a}]\n";
    assert!(shrinks(&alternating.replace("SIZE", "1/3")));
    assert!(!shrinks(&alternating.replace("SIZE", "1/2")));
    // Kept elements need not shrink.
    assert!(shrinks(
        "initiator: segment\ngenerator: [[0, 0], {to: [0, 3], fertile: false}, {to: [0.9, 3]}]"
    ));
}

#[test]
fn windows_may_be_as_small_as_numbers_are_precise() {
    let rule = library("koch");
    let graph = compiled(&rule, 100);
    let write = |extent: f64, decides| {
        let mut options = window(
            &rule,
            [
                0.5 - extent / 2.0,
                3f64.sqrt() / 6.0 - extent,
                extent,
                extent,
            ],
            100,
        );
        options.detail = detail(1.0, decides);
        render::write(&graph, &Growth::steps(100), &options, &mut Vec::new())
    };
    for exponent in 0..10 {
        let picture = write(10f64.powi(-exponent), true).unwrap();
        assert!(
            (20..3000).contains(&picture.elements),
            "{exponent}: {}",
            picture.elements
        );
    }
    let error = write(1e-11, true).unwrap_err().to_string();
    assert!(error.contains("not precise enough"), "{error}");
}

fn run(folder: &Path, arguments: &[&str]) -> (bool, String) {
    let (code, said) = common::said(folder, arguments);
    (code == Some(0), said)
}

#[test]
fn growth_goes_on_until_nothing_more_can_be_seen() {
    let folder = tempfile::tempdir().unwrap();
    let says = |arguments: &[&str], start: &str| {
        let (success, said) = run(folder.path(), arguments);
        assert!(success && said.starts_with(start), "{said}");
    };
    says(
        &["grow", "koch", "--detail", "0.5"],
        "koch.svg: koch to a detail of 0.5 pixels, 7 steps, 16,384 elements, 1024 x 356 pixels, ",
    );
    // A number of steps beyond all limits, cut by the detail.
    says(
        &["grow", "koch", "--steps", "40", "--detail", "1"],
        "koch.svg: step 40 of koch to a detail of 1 pixel, 16,384 elements, ",
    );
    let svg = fs::read_to_string(folder.path().join("koch.svg")).unwrap();
    assert!(svg.contains("# kfrac grow koch.yaml --steps=40 --detail=1 --seed=0"));
    let tip = ["--view", "0.49,0.28,0.02,0.02"];
    says(
        &[
            &["grow", "koch", "--steps", "20", "--detail", "2"],
            &tip[..],
        ]
        .concat(),
        "koch.svg: step 20 of koch to a detail of 2 pixels, ",
    );
    // More steps than those that a time-dependent graph is first compiled for.
    let slow = "initiator: segment\ngenerator: [[0, 0], {to: [0.3, 0], fertile: false}, \
                {to: [\"1.24 + if(step > 90, 0.01, 0)\", 0.1]}]";
    fs::write(folder.path().join("slow.yaml"), slow).unwrap();
    says(
        &["grow", "slow.yaml", "--detail", "1"],
        "slow.svg: slow to a detail of 1 pixel, 108 steps, 109 elements, ",
    );
}

#[test]
fn a_detail_that_cannot_be_had_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let flat = "initiator: segment\ngenerator: [[0, 0], {to: [\"if(step < 3, 1/2, 1)\", 0]}]";
    fs::write(folder.path().join("flat.yaml"), flat).unwrap();
    let vanishing = "initiator: segment\ngenerator: [[0, 0], [1/2, 1/4]]";
    fs::write(folder.path().join("vanishing.yaml"), vanishing).unwrap();
    for (arguments, message) in [
        (
            &["vegetation", "--detail", "1"][..],
            "error: vegetation cannot be grown to a detail, only by a number of --steps: its \
             elements do not get smaller than any length\n",
        ),
        (
            &["vanishing.yaml", "--detail", "1"],
            "error: vanishing cannot be grown to a detail, only by a number of --steps: all that \
             is drawn gets as small as its elements\n",
        ),
        (
            &["flat.yaml", "--detail", "1"],
            "error: flat cannot be grown to a detail, only by a number of --steps: 131072 steps \
             are not enough\n",
        ),
        (
            &["dragon", "--detail", "0.1", "--max-elements", "1000"],
            "error: dragon has more than 1,000 elements; --max-elements allows more\n",
        ),
        (
            &["koch", "--detail", "1", "--format", "csv"],
            "error: --detail is a size in pixels, and only pictures have pixels\n",
        ),
        (
            &["koch", "--detail", "0"],
            "error: invalid value '0' for '--detail <PX>'",
        ),
    ] {
        let (success, said) = run(folder.path(), &[&["grow"], arguments].concat());
        assert!(!success && said.starts_with(message), "{said}");
    }
}

/// Where there is no limit set, the file gives the number of steps, for the detail cannot decide it.
#[test]
fn steps_that_start_anew_are_those_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    for (name, said) in [
        (
            "honda-tree",
            "step 12 of honda-tree to a detail of 0.5 pixels, ",
        ),
        ("plant-f", "plant-f to a detail of 0.5 pixels, 10 steps, "),
        (
            "signals-e",
            "step 26 of signals-e to a detail of 0.5 pixels, 824 elements",
        ),
        (
            "koch-lsystem",
            "koch-lsystem to a detail of 0.5 pixels, 7 steps, ",
        ),
    ] {
        let arguments = ["grow", name, "--detail", "0.5", "-o", "x.png"];
        let (success, told) = run(folder.path(), &arguments);
        assert!(success && told.contains(said), "{told}");
    }
}

/// Where all elements of a step have equal lengths, a detail amounts to a number of steps.
#[test]
fn a_detail_of_even_elements_is_a_number_of_steps() {
    for name in [
        "koch",
        "dragon",
        "hilbert",
        "carpet",
        "self-seeding-square",
        "gosper",
    ] {
        let rule = library(name);
        let mut options = Options::of(rule.metadata())
            .size(Size::Long(100))
            .detail(detail(4.0, true));
        let (picture, bytes) = drawn(&rule, 1000, &options);
        options.detail = None;
        assert!(picture.steps > 1, "{name}");
        assert!(
            drawn(&rule, picture.steps, &options) == (picture, bytes),
            "{name}"
        );
    }
}
