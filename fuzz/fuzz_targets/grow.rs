//! Fuzzing of rule files from arbitrary bytes: read, printed, read again, forecast, grown, drawn and written
//! as a table.
//!
//! Checks that nothing panics; that every mistake has a message, and messages are of bounded length; that a
//! printed file is equivalent; that forecast and bounding box agree with the walk, in the plane and in space; and that
//! pictures are XML with finite numbers, or PNGs.

#![no_main]

mod mutate;
mod random;

use std::fmt::Debug;
use std::num::NonZero;
use std::sync::Arc;

use kfrac::Count;
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::{Diagnostics, Source};
use kfrac::document::Document;
use kfrac::export::{self, TableFormat};
use kfrac::extent::bounding_box;
use kfrac::geometry::{Bounds, Frame, Frame3, Point};
use kfrac::graph::{Graph, Level};
use kfrac::grow::{Elements, Growth, WalkError, Walked};
use kfrac::measure::similarity_dimension;
use kfrac::model::Model;
use kfrac::render::space::{SpaceOptions, write_space};
use kfrac::render::{self, Format, Labels, Options, SceneFormat, Size, write_scene};
use kfrac::rule::Rule;
use kfrac::style::Named;
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use mutate::mutated;
use random::Random;

/// Maximum number of elements, small enough for milliseconds per input.
const MAX_ELEMENTS: u64 = 1_000;
const MAX_STEPS: u32 = 64;

/// Maximum length of the messages about one file, in bytes.
const MAX_SAID: usize = 1 << 20;

/// Maximum distance of bounding boxes, as a multiple of the coordinates.
const TOLERANCE: f64 = 1e-9;

fuzz_target!(|bytes: &[u8]| {
    let Ok(source) = Source::read("fuzz.yaml", bytes.to_vec()) else {
        return;
    };
    let Some((document, model)) = read(&source) else {
        return;
    };
    let yaml = document.to_yaml();
    let grown = grow(&model);
    // Expanded aliases may exceed the maximum size of a file.
    if yaml.len() <= Source::MAX_BYTES {
        let (again, model) = read(&Source::new("fuzz.yaml", yaml.as_str()))
            .unwrap_or_else(|| panic!("what was printed cannot be read:\n{yaml}"));
        assert_eq!(again.to_yaml(), yaml);
        assert_eq!(
            grow(&model),
            grown,
            "what was printed grows otherwise:\n{yaml}"
        );
    }
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    let mut random = Random::new(seed);
    match str::from_utf8(&data[..size]) {
        Ok(text) if random.below(3) > 0 => {
            let text = mutated(text, &mut random);
            let size = text.len().min(max_size);
            data[..size].copy_from_slice(&text.as_bytes()[..size]);
            size
        }
        _ => fuzzer_mutate(data, size, max_size),
    }
});

fn read(source: &Arc<Source>) -> Option<(Document, Model)> {
    let read = Document::read(source, &Catalogue::embedded())
        .and_then(|document| document.resolve(&[]).map(|resolved| (document, resolved)));
    match read {
        Ok((document, (model, warnings))) => {
            assert!(!warnings.has_errors(), "{warnings}");
            said(&warnings);
            Some((document, model))
        }
        Err(errors) => {
            assert!(errors.has_errors(), "refused without an error");
            said(&errors);
            None
        }
    }
}

fn said(found: &Diagnostics) {
    assert!(found.to_string().len() < MAX_SAID, "too much is said");
}

/// Returns the table and the picture of a rule, or the numbers and the picture of a set in space; or the reason why it
/// does not grow. Other models are not grown.
fn grow(model: &Model) -> Result<[Vec<u8>; 2], String> {
    if let Some(graph) = model.compile_in_space(false) {
        return grow_in_space(model, &graph);
    }
    match model.rule() {
        Some(rule) => grow_rule(rule).map(|texts| texts.map(String::into_bytes)),
        None => Ok([Vec::new(), Vec::new()]),
    }
}

fn grow_in_space(model: &Model, graph: &Graph<Frame3>) -> Result<[Vec<u8>; 2], String> {
    let steps = model.metadata().steps.unwrap_or(2).min(MAX_STEPS);
    let limit = graph.limit_bounds();
    let bounds = graph.bounds(steps);
    if graph.check_size(steps, MAX_ELEMENTS).is_ok() {
        let growth = Growth::steps(steps).max_elements(MAX_ELEMENTS);
        let counted = Elements::of(graph, &growth).filter(Result::is_ok).count();
        if let Some(level) = forecast(graph, steps) {
            assert_eq!(level.elements, Count::from(counted as u64));
        }
        if let (Some(bounds), Ok(extent)) = (&bounds, bounding_box(graph, &growth)) {
            near(bounds, &extent);
        }
    }
    let options = Options::of(model.metadata())
        .size(Size::Long(24))
        .threads(NonZero::<usize>::MIN);
    let mut png = Vec::new();
    // The limit of maps that hardly contract has very many elements of a pixel.
    let drawn = write_space(
        graph,
        Some(steps.min(4)),
        &options,
        &SpaceOptions::default(),
        None,
        &mut png,
    );
    drawn.map_err(|error| error.to_string())?;
    assert!(png.starts_with(b"\x89PNG") && png.ends_with(b"IEND\xaeB`\x82"));
    // Scenes may be refused, but are whole where they are not.
    if graph.check_size(steps, MAX_ELEMENTS / 8).is_ok() {
        for (name, format) in SceneFormat::NAMES {
            let mut scene = Vec::new();
            let space = SpaceOptions::default();
            if write_scene(graph, steps, &options, &space, *format, None, &mut scene).is_ok() {
                assert!(scene.len() > 100, "an empty .{name}");
                if *format == SceneFormat::Glb {
                    let length: [u8; 4] = scene[8..12].try_into().expect("four bytes");
                    assert_eq!(u32::from_le_bytes(length) as usize, scene.len());
                }
            }
        }
    }
    Ok([format!("{limit:?} {bounds:?}").into_bytes(), png])
}

/// Returns the table and the picture of a rule, or the reason why it does not grow.
fn grow_rule(rule: &Arc<Rule>) -> Result<[String; 2], String> {
    let steps = rule.steps().unwrap_or(3).min(MAX_STEPS);
    let graph = Graph::compile(rule, steps).map_err(|error| {
        said(&error.diagnostic(rule).into());
        error.to_string()
    })?;
    let _ = similarity_dimension(&graph);
    let _ = graph.limit_bounds();
    let bounds = graph.bounds(steps);
    let level = forecast(&graph, steps);
    let allowed = graph.check_size(steps, MAX_ELEMENTS).is_ok();
    let growth = Growth::steps(steps).max_elements(MAX_ELEMENTS);
    let mut table = Vec::new();
    let walked = export::write(
        &graph,
        &growth,
        TableFormat::Csv,
        NonZero::<usize>::MIN,
        &mut table,
    );
    if let Ok(walked) = walked {
        assert!(allowed, "refused, but grown");
        if let Some(level) = level {
            agree(&level, walked);
        }
        let extent = bounding_box(&graph, &growth).expect("the walk was complete before");
        if let Some(bounds) = bounds {
            near(&bounds, &extent);
        }
    } else if let (Some(level), Err(WalkError::TooManyElements { .. })) = (level, &walked) {
        assert!(level.elements > Count::from(MAX_ELEMENTS));
    }
    let table = text(walked.map(|_| table))?;
    Ok([table, text(picture(rule, &graph, &growth))?])
}

fn forecast<F: Frame>(graph: &Graph<F>, steps: u32) -> Option<Level> {
    let mut forecast = graph.forecast()?;
    (0..steps)
        .all(|_| forecast.advance())
        .then(|| forecast.level())
}

fn agree(level: &Level, walked: Walked) {
    assert_eq!(level.elements, Count::from(walked.elements));
    assert_eq!(level.fractals, Count::from(walked.fractals));
    assert!(level.fertile <= level.elements);
}

fn near<P: Point>(bounds: &Bounds<P>, extent: &Bounds<P>) {
    let near = |a: P, b: P| (a - b).length() <= TOLERANCE * (1.0 + a.length());
    assert!(
        near(bounds.min(), extent.min()) && near(bounds.max(), extent.max()),
        "the graph says {bounds:?}, the walk {extent:?}"
    );
}

fn text<E: Debug>(bytes: Result<Vec<u8>, E>) -> Result<String, String> {
    let bytes = bytes.map_err(|error| format!("{error:?}"))?;
    Ok(String::from_utf8(bytes).expect("what is written is text"))
}

fn picture(rule: &Rule, graph: &Graph, growth: &Growth<'_>) -> Result<Vec<u8>, String> {
    let description = rule.description();
    let mut options = Options::of(rule.metadata())
        .size(Size::Long(300))
        .labels(Labels {
            title: description.title.clone().unwrap_or_default(),
            description: description.about.clone().unwrap_or_default(),
            provenance: String::new(),
        })
        .threads(NonZero::<usize>::MIN);
    let mut svg = Vec::new();
    render::write(graph, growth, &options, &mut svg).map_err(|error| error.to_string())?;
    check_xml(&svg);
    (options.format, options.size) = (Format::Png, Size::Long(60));
    let mut png = Vec::new();
    if render::write(graph, growth, &options, &mut png).is_ok() {
        assert!(png.starts_with(b"\x89PNG") && png.ends_with(b"IEND\xaeB`\x82"));
    }
    Ok(svg)
}

fn check_xml(bytes: &[u8]) {
    let text = str::from_utf8(bytes).expect("a picture is text");
    let tree = roxmltree::Document::parse(text).expect("a picture is XML");
    for node in tree.descendants() {
        for attribute in ["d", "viewBox", "width", "height", "stroke-width"] {
            let value = node.attribute(attribute).unwrap_or_default();
            let number = |c: char| c.is_ascii_digit() || " .,-MmLlHhVvCcQqZz".contains(c);
            assert!(value.chars().all(number), "{attribute} is {value:?}");
        }
    }
}
