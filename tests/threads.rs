//! Many threads give the results of one, to the last bit.

use std::convert::Infallible;
use std::num::NonZero;

use crate::common::{document, document_of};
use crate::laws::rules::{self, Features};
use kfrac::catalogue::{Catalogue, LibraryFile, Shelf};
use kfrac::export;
use kfrac::extent::bounding_box;
use kfrac::geometry::DVec2;
use kfrac::graph::Graph;
use kfrac::grow::{
    Element, Enter, FractalInfo, Growth, Seam, Subtree, Visitor, WalkError, count, walk,
    walk_in_spans,
};
use kfrac::model::Model;
use kfrac::render::{self, Options, Size};
use kfrac::style::ColorBy;
use proptest::prelude::*;

const THREADS: [usize; 4] = [1, 2, 3, 8];

fn threads(number: usize) -> NonZero<usize> {
    NonZero::new(number).unwrap()
}

/// A visitor that records everything that a walk reports, to the last bit.
#[derive(Clone, Debug, Default, PartialEq)]
struct Seen {
    takes_runs: bool,
    /// Length below which nothing is replaced; elements on one side are skipped up to a larger length.
    cuts: Option<f64>,
    /// Whether the first fractal began in an earlier span.
    goes_on: bool,
    fractals: Vec<(FractalInfo, Vec<Place>, bool)>,
}

#[derive(Clone, Debug, PartialEq)]
struct Place {
    map: [f64; 6],
    direction: u8,
    length: f64,
    index: u128,
    object: usize,
    born: u32,
    fertile: bool,
    joined: bool,
}

impl Visitor for Seen {
    type Error = Infallible;

    fn takes_runs(&self) -> bool {
        self.takes_runs
    }

    fn cuts(&self) -> Option<f64> {
        self.cuts
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        let length = subtree.frame.length();
        match self.cuts {
            Some(shortest) if length < shortest => Enter::Keep,
            Some(shortest) if length < 3.0 * shortest && subtree.frame.origin().x < 0.3 => {
                Enter::Skip
            }
            _ => Enter::Replace,
        }
    }

    fn go_on(&mut self, fractal: FractalInfo) {
        self.goes_on = true;
        self.fractals.push((fractal, Vec::new(), false));
    }

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
        self.fractals.push((fractal, Vec::new(), false));
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.fractals.last_mut().unwrap().1.push(Place {
            map: element.frame.map().to_cols_array(),
            direction: element.frame.direction().number(),
            length: element.length,
            index: element.index,
            object: element.object,
            born: element.born,
            fertile: element.fertile,
            joined: element.joined,
        });
        Ok(())
    }

    fn end(&mut self, joined: bool) -> Result<(), Infallible> {
        self.fractals.last_mut().unwrap().2 = joined;
        Ok(())
    }
}

impl Seen {
    /// Appends the record of the next span.
    fn add(&mut self, span: Self, seam: Seam) {
        let mut fractals = span.fractals.into_iter();
        if span.goes_on {
            let (fractal, mut elements, end) = fractals.next().unwrap();
            let last = self.fractals.last_mut().unwrap();
            assert_eq!(last.0, fractal);
            for element in &mut elements {
                element.index += seam.before;
            }
            if let Some(first) = elements.first_mut() {
                first.joined &= seam.joined;
            }
            last.1.extend(elements);
            last.2 = end;
        }
        self.fractals.extend(fractals);
    }
}

fn in_spans(
    graph: &Graph,
    growth: &Growth<'_>,
    number: usize,
    span: Option<u64>,
    none: &Seen,
) -> Seen {
    let mut all = none.clone();
    // A visitor that sees everything continues where it was.
    let mut whole = false;
    let walked = walk_in_spans(
        graph,
        growth,
        threads(number),
        span,
        || none.clone(),
        |seen, seam| {
            if span.is_some() && !graph.counts_index() {
                all.add(std::mem::replace(seen, none.clone()), seam);
            } else {
                whole = true;
                all = seen.clone();
            }
            Ok(())
        },
    )
    .unwrap();
    assert_eq!(whole, span.is_none() || graph.counts_index());
    let elements = all
        .fractals
        .iter()
        .map(|(_, elements, _)| elements.len() as u64);
    assert_eq!(walked.elements, elements.sum::<u64>());
    assert_eq!(walked.fractals, all.fractals.len() as u64);
    all
}

/// Asserts that walks in spans of all sizes agree with one that is not divided.
fn spans_agree(graph: &Graph, growth: &Growth<'_>, sizes: &[Option<u64>]) {
    for (takes_runs, cuts) in [(false, None), (true, None), (false, Some(0.04))] {
        let none = Seen {
            takes_runs,
            cuts,
            ..Seen::default()
        };
        let mut sequential = none.clone();
        walk(graph, growth, &mut sequential).unwrap();
        for &span in sizes {
            for number in THREADS {
                let divided = in_spans(graph, growth, number, span, &none);
                let what = format!("{span:?} on {number}, {takes_runs}, {cuts:?}");
                assert!(divided == sequential, "{what}");
            }
        }
    }
}

/// Asserts that counts agree with elements counted one by one.
fn counts_agree(graph: &Graph, growth: &Growth<'_>) {
    let counted = count(graph, growth, threads(1)).unwrap();
    assert_eq!(count(graph, growth, threads(3)).unwrap(), counted);
    let mut seen = Seen::default();
    assert_eq!(walk(graph, growth, &mut seen).unwrap(), counted.walked);
    let elements = || seen.fractals.iter().flat_map(|(_, elements, _)| elements);
    let fertile = elements().filter(|element| element.fertile).count();
    assert_eq!(counted.fertile, fertile as u64);
    let length = |place: &Place| DVec2::new(place.map[0], place.map[1]).length();
    let length: f64 = elements().map(length).sum();
    assert!((counted.length - length).abs() <= 1e-9 * (1.0 + length));
    let bounds = bounding_box(graph, growth).unwrap();
    assert_eq!(counted.bounds.is_empty(), bounds.is_empty());
    if !bounds.is_empty() {
        let far = |a: DVec2, b: DVec2| a.distance(b) / (1.0 + b.length());
        assert!(far(counted.bounds.min(), bounds.min()) < 1e-12);
        assert!(far(counted.bounds.max(), bounds.max()) < 1e-12);
    }
}

/// Iterates over all fractals of the library with their graphs, at the deepest step within a limit of
/// elements.
pub(crate) fn library(max_elements: u64) -> impl Iterator<Item = (String, Model, Graph, u32)> {
    let catalogue = Catalogue::embedded();
    let mut entries = catalogue.entries();
    entries.retain(|entry| Shelf::grown().contains(&entry.shelf));
    let models = entries.into_iter().map(|LibraryFile { name, .. }| {
        let model = document(&name).resolve(&[]).unwrap().0;
        (name, model)
    });
    let models = models.filter(|(_, model)| !model.is_in_space());
    models.filter_map(move |(name, model)| {
        let compile = |steps| model.compile_for(steps, 0, max_elements).ok();
        let fits = |steps| {
            let graph = compile(steps)?;
            // An element may be a whole fractal.
            let pieces = graph.base_elements().iter().map(|it| it.pieces().len());
            let pieces = pieces.max().unwrap_or(1) as u64;
            let most = (20 * max_elements / pieces).min(max_elements);
            match graph.check_size(steps, most) {
                Ok(Some(_)) => Some((graph, steps)),
                // The draws decide the counts.
                Ok(None) => {
                    let steps = model.metadata().steps.unwrap_or(4);
                    Some((compile(steps)?, steps))
                }
                Err(_) => None,
            }
        };
        // Entries that consist of whole fractals may have too many pieces at any step.
        let (graph, steps) = (0..=14).rev().find_map(fits)?;
        Some((name, model, graph, steps))
    })
}

#[test]
fn spans_of_the_library_are_the_whole_walk() {
    for (_, _, graph, steps) in library(6_000) {
        let growth = Growth::steps(steps).seed(3);
        spans_agree(&graph, &growth, &[None, Some(100), Some(4096)]);
        counts_agree(&graph, &growth);
    }
}

#[test]
fn files_of_the_library_do_not_depend_on_the_number_of_threads() {
    const PICTURES: [render::Format; 4] = [
        render::Format::Svg,
        render::Format::Png,
        render::Format::Pdf,
        render::Format::Dxf,
    ];
    // More than one span of a table; pictures have longer ones, and tests of their own below.
    for ((name, model, graph, steps), number) in library(5_000).zip(0..) {
        let growth = Growth::steps(steps);
        // Formats take turns with the numbers of threads, from another one on for each entry.
        let mut others = THREADS[1..].iter().cycle().skip(number % 3);
        let mut one_and_others = |write: &dyn Fn(NonZero<usize>) -> Vec<u8>, what: &str| {
            let one = write(threads(1));
            assert!(!one.is_empty());
            let number = *others.next().unwrap();
            let many = write(threads(number));
            assert!(many == one, "{name} as {what} on {number} threads");
        };
        for format in [export::TableFormat::Csv, export::TableFormat::JsonLines] {
            let write = |threads| {
                let mut bytes = Vec::new();
                export::write(&graph, &growth, format, threads, &mut bytes).unwrap();
                bytes
            };
            one_and_others(&write, &format!("{format:?}"));
        }
        let own = Options::of(model.metadata());
        let mut by_index = own.clone();
        by_index.style.color_by = ColorBy::Index;
        let mut pictures = PICTURES.map(|format| (format, &own)).to_vec();
        // Every colour takes a walk: some of the rules suffice.
        if number % 5 == 0 {
            pictures.push((render::Format::Svg, &by_index));
        }
        for (format, options) in pictures {
            let write = |threads| {
                let options = options
                    .clone()
                    .format(format)
                    .threads(threads)
                    .size(Size::Long(100));
                let mut bytes = Vec::new();
                render::write(&graph, &growth, &options, &mut bytes).unwrap();
                bytes
            };
            let what = format!("{format:?} by {:?}", options.style.color_by);
            one_and_others(&write, &what);
        }
    }
}

#[test]
fn limits_and_failures_are_met_on_any_number_of_threads() {
    let rule = document("koch")
        .resolve(&[])
        .unwrap()
        .0
        .into_rule()
        .unwrap();
    let graph = Graph::compile(&rule, 8).unwrap();
    let growth = Growth::steps(8).max_elements(40_000);
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let cancelled = Growth::steps(8).cancel(Some(&cancel));
    for number in THREADS {
        let met = count(&graph, &growth, threads(number));
        assert_eq!(met, Err(WalkError::TooManyElements { limit: 40_000 }));
        let met = count(&graph, &cancelled, threads(number));
        assert_eq!(met, Err(WalkError::Cancelled));
        let mut taken = 0;
        let fails = Growth::steps(8);
        let failed = walk_in_spans(
            &graph,
            &fails,
            threads(number),
            Some(1000),
            || Fails { seen: 0 },
            |_, _| {
                taken += 1;
                Ok(())
            },
        );
        assert_eq!(failed, Err(WalkError::Visitor("here")));
        // In order: results before the error are taken, later ones are not.
        assert_eq!(taken, 0);
    }
}

/// A visitor that fails in every span.
struct Fails {
    seen: u64,
}

impl Visitor for Fails {
    type Error = &'static str;

    fn begin(&mut self, _: FractalInfo) -> Result<(), Self::Error> {
        Ok(())
    }

    fn element(&mut self, _: &Element) -> Result<(), Self::Error> {
        self.seen += 1;
        if self.seen > 100 { Err("here") } else { Ok(()) }
    }

    fn end(&mut self, _: bool) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// Pictures of several spans: lines, closed paths, small polygons, thin lines of relative width.
#[test]
fn pictures_of_many_elements_do_not_depend_on_the_number_of_threads() {
    let cases = [
        ("koch", 8),
        ("dragon", 15),
        ("binary-tree", 15),
        ("sierpinski-triangles", 9),
    ];
    for (name, steps) in cases {
        let document = document(name);
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, steps).unwrap();
        let mut options = Options::of(rule.metadata());
        options.size = Size::Long(200);
        options.style.color_by = ColorBy::None;
        for format in [render::Format::Svg, render::Format::Png] {
            let write = |number| {
                let options = options.clone().format(format).threads(threads(number));
                let mut bytes = Vec::new();
                render::write(&graph, &Growth::steps(steps), &options, &mut bytes).unwrap();
                bytes
            };
            let one = write(1);
            for number in &THREADS[1..] {
                assert!(
                    write(*number) == one,
                    "{name} as {format:?} on {number} threads"
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(crate::common::cases(200))]

    #[test]
    fn spans_are_the_whole_walk(text in rules::rule(Features::ALL), steps in 0..5u32, seed in 0..3u64) {
        let rule = document_of(&text).resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, steps).unwrap();
        let growth = Growth::steps(steps).seed(seed);
        spans_agree(&graph, &growth, &[None, Some(1), Some(7), Some(60)]);
        counts_agree(&graph, &growth);
    }

    /// Seams fall into the middle of paths, in rules of all kinds.
    #[test]
    fn files_do_not_depend_on_the_number_of_threads(text in rules::rule(Features::ALL), seed in 0..3u64) {
        let rule = document_of(&text).resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, 6).unwrap();
        let growth = Growth::steps(6).seed(seed).max_elements(30_000);
        let write = |number| {
            let options = Options::of(rule.metadata()).size(Size::Long(300)).threads(threads(number));
            let mut bytes = Vec::new();
            let drawn = render::write(&graph, &growth, &options, &mut bytes);
            (drawn.map_err(|error| error.to_string()), bytes)
        };
        prop_assert!(write(1) == write(3));
    }
}
