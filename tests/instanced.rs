//! SVGs of nested instances show the pictures of plain SVGs.

mod command_line;
mod maps;
mod picture;
mod refusals;
mod scene;

use std::collections::BTreeSet;
use std::num::NonZero;

use crate::common;
use kfrac::Metadata;
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::document::Document;
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::model::Model;
use kfrac::render::{self, NotInstanced, Options, Picture, RenderError, Size};
use kfrac::style::{Cap, ColorBy, Colour, Join, Width};

fn compiled(document: &Document, steps: u32) -> (Metadata, Graph) {
    let model = document.resolve(&[]).unwrap().0;
    let by = model.metadata().style.color_by;
    let graph = match &model {
        Model::Ifs(system) if by == ColorBy::LastMap => Graph::with_last_maps(system).unwrap(),
        _ => model.compile(steps).unwrap(),
    };
    (model.metadata().clone(), graph)
}

fn options(metadata: &Metadata) -> Options {
    Options::of(metadata)
        .size(Size::Long(160))
        .threads(NonZero::<usize>::MIN)
        .instanced(true)
}

fn write(graph: &Graph, steps: u32, options: &Options) -> Result<(Picture, String), RenderError> {
    let mut bytes = Vec::new();
    let picture = render::write(graph, &Growth::steps(steps), options, &mut bytes)?;
    Ok((picture, String::from_utf8(bytes).unwrap()))
}

/// Writes a picture with instances in a style that symbols can have; `None` if there is no such style.
fn write_somehow(graph: &Graph, steps: u32, options: &mut Options) -> Option<(Picture, String)> {
    for _ in 0..4 {
        match write(graph, steps, options) {
            Ok(written) => return Some(written),
            Err(RenderError::NotInstanced(refusal)) => match refusal {
                NotInstanced::Colours { .. } => options.style.color_by = ColorBy::None,
                NotInstanced::Areas => options.style.fill = None,
                NotInstanced::Corners => {
                    (options.style.cap, options.style.join) = (Cap::Round, Join::Round);
                }
                NotInstanced::Flattened => options.style.width = Width::Pixels(1.5),
                NotInstanced::Draws => return None,
                other => panic!("{other}"),
            },
            Err(RenderError::NoRoom(_)) => return None,
            Err(other) => panic!("{other}"),
        }
    }
    panic!("refused again and again");
}

#[test]
fn the_picture_is_that_of_plain_svg() {
    let catalogue = Catalogue::embedded();
    let shelves = [Shelf::RULES, Shelf::IFS, Shelf::INSTANCING, Shelf::LSYSTEMS];
    let entries = catalogue.entries();
    let mut worst = Vec::new();
    for entry in entries.iter().filter(|it| shelves.contains(&it.shelf)) {
        let document = common::document(&entry.name);
        if document.resolve(&[]).unwrap().0.is_in_space() {
            continue;
        }
        for steps in [1, 3] {
            let (heading, graph) = compiled(&document, steps);
            let mut options = options(&heading);
            options.style.background = Some(Colour::grey(255));
            let Some((_, nested)) = write_somehow(&graph, steps, &mut options) else {
                continue;
            };
            options.instanced = false;
            let (_, plain) = write(&graph, steps, &options).unwrap();
            let what = format!("{} at {steps}", entry.name);
            picture::hold_same_frames(&plain, &nested, &what);
            let scales = matches!(options.style.width, Width::Relative(_));
            let off = picture::difference(&plain, &nested, scales);
            worst.push((off.mean, off.far, what));
        }
    }
    // Adjacent shapes are blended edge by edge, and again where lines join, which shows where lines are as
    // close as pixels.
    assert!(worst.len() > 200, "{}", worst.len());
    for (mean, far, what) in worst {
        assert!(mean < 7.0 && far < 0.02, "{what}: {mean} {far}");
    }
}

/// Colours apply to the same elements, and later classes lie on top.
#[test]
fn colours_are_those_of_plain_svg() {
    for (name, by) in [
        ("pythagoras", ColorBy::Step),
        ("monkeys-tree", ColorBy::Direction),
        ("hilbert", ColorBy::Direction),
        ("spiral", ColorBy::Step),
        ("dragon", ColorBy::Generator),
        ("self-seeding-square", ColorBy::Age),
        ("dragon-ifs", ColorBy::LastMap),
        ("dragon-ifs", ColorBy::FirstMap),
        ("pound-sign-tinted", ColorBy::Tint),
        ("sunflower", ColorBy::Tint),
        ("plant-with-flowers", ColorBy::Tint),
    ] {
        let steps = 4;
        let (heading, graph) = compiled(&common::document(name), steps);
        let mut options = options(&heading);
        options.style.color_by = by;
        options.style.background = Some(Colour::grey(255));
        (options.style.cap, options.style.join) = (Cap::Round, Join::Round);
        let (_, nested) = write(&graph, steps, &options).unwrap();
        options.instanced = false;
        let (_, plain) = write(&graph, steps, &options).unwrap();
        let colours = picture::colours(&plain);
        assert!(colours.len() > 2, "{name} by {by:?}");
        let drawn = picture::colours(&nested);
        // Tints that are composed in a different order may round to a neighbouring value.
        let is_near = |a: &[u8; 3], b: &[u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 1);
        let holds = |all: &BTreeSet<_>, some: &BTreeSet<_>| {
            some.iter()
                .all(|one| all.iter().any(|other| is_near(one, other)))
        };
        let are_same = holds(&drawn, &colours) && holds(&colours, &drawn);
        assert!(are_same, "{name} by {by:?}: {drawn:?}, not {colours:?}");
        let scales = matches!(options.style.width, Width::Relative(_));
        let off = picture::difference(&plain, &nested, scales);
        assert!(
            off.mean < 3.0 && off.far < 0.01,
            "{name} by {by:?}: {off:?}"
        );
    }
}

#[test]
fn the_file_grows_with_the_steps_and_not_with_the_elements() {
    let (heading, graph) = compiled(&common::document("koch"), 0);
    let options = options(&heading);
    let written = [100, 200, 300].map(|steps| write(&graph, steps, &options).unwrap());
    let [a, b, c] = [0, 1, 2].map(|number| written[number].1.len());
    // Names get longer by a letter each in five places.
    assert!(b.abs_diff(a).abs_diff(c.abs_diff(b)) < 700, "{a} {b} {c}");
    assert!((59_000..64_000).contains(&b), "{b}");
    let instanced = written[1].0.instanced.unwrap();
    assert_eq!(instanced.symbols, 201);
    // 4^k elements of symbols that have k steps to go, each as an element and as an instance.
    let expanded = 2.0 * (4.0_f64.powi(201) - 1.0) / 3.0;
    assert!((instanced.expanded / expanded - 1.0).abs() < 1e-9);
}
