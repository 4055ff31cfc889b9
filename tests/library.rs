//! Every file of the library is loaded, grown, drawn and compared with its published dimension.

mod lsystems;
mod picture;
mod structures;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use crate::common::{self, compiled, document, document_of, grown, resolved};
use kfrac::Count;
use kfrac::catalogue::{Catalogue, LibraryFile, Shelf};
use kfrac::document::node::{Node, Value};
use kfrac::export::{self, TableFormat};
use kfrac::geometry::{Bounds, DVec2};
use kfrac::graph::Graph;
use kfrac::grow::{Elements, Growth};
use kfrac::measure::similarity_dimension;
use kfrac::render::{self, Labels, Options, Size};
use kfrac::rule::Rule;
use picture::Picture;

/// Rules that the library must contain.
const REQUIRED: [&str; 20] = [
    "koch",
    "koch-snowflake",
    "quadric-koch",
    "pythagoras",
    "pythagoras-squares",
    "random-tree",
    "self-seeding-square",
    "vegetation",
    "base-element",
    "sierpinski-arrowhead",
    "monkeys-tree",
    "sierpinski-triangles",
    "dragon",
    "spiral",
    "ramifying",
    "levy",
    "gosper",
    "hilbert",
    "terdragon",
    "carpet",
];

fn entries(shelf: Shelf) -> Vec<LibraryFile> {
    let all = Catalogue::embedded().entries();
    all.into_iter()
        .filter(|entry| entry.shelf == shelf)
        .collect()
}

/// Iterates over all rules, with their names.
fn rules() -> impl Iterator<Item = (String, Arc<Rule>)> {
    common::plane_rules().into_iter().map(|name| {
        let rule = resolved(&document(&name), &[]);
        (name, rule)
    })
}

fn steps(rule: &Rule) -> [u32; 3] {
    [0, 1, rule.steps().unwrap()]
}

fn svg_of(name: &str, rule: &Rule, graph: &Graph, steps: u32) -> Vec<u8> {
    svg_of_size(Size::Long(1024), name, rule, graph, steps)
}

fn svg_of_size(size: Size, name: &str, rule: &Rule, graph: &Graph, steps: u32) -> Vec<u8> {
    let labels = Labels {
        title: rule.description().title.clone().unwrap(),
        description: rule.description().about.clone().unwrap(),
        provenance: document(name).to_yaml(),
    };
    let options = Options::of(rule.metadata()).size(size).labels(labels);
    let mut bytes = Vec::new();
    render::write(graph, &Growth::steps(steps), &options, &mut bytes)
        .unwrap_or_else(|error| panic!("{name} at {steps}: {error}"));
    bytes
}

fn table_of(graph: &Graph, steps: u32, format: TableFormat) -> String {
    let mut bytes = Vec::new();
    let growth = Growth::steps(steps);
    export::write(
        graph,
        &growth,
        format,
        Options::default().threads,
        &mut bytes,
    )
    .unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Returns the rule that a text is read as.
fn read_again(text: &str) -> Rule {
    Arc::into_inner(resolved(&document_of(text), &[])).unwrap()
}

#[test]
fn the_promised_rules_exist() {
    let names: BTreeSet<_> = entries(Shelf::RULES)
        .into_iter()
        .map(|entry| entry.name)
        .collect();
    for name in REQUIRED {
        assert!(names.contains(name), "{name}");
    }
}

#[test]
fn every_file_of_the_folder_is_found_by_its_name() {
    let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("library");
    let mut found = 0;
    for shelf in Shelf::all() {
        for file in fs::read_dir(library.join(shelf.folder())).unwrap() {
            let path = file.unwrap().path();
            assert_eq!(path.extension().unwrap(), "yaml", "{path:?}");
            let name = path.file_stem().unwrap().to_str().unwrap();
            let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            assert!(name.chars().all(is_plain), "{name}");
            let source = Catalogue::embedded().component(shelf, name).unwrap();
            assert_eq!(source.text(), fs::read_to_string(&path).unwrap(), "{name}");
            found += 1;
        }
    }
    assert_eq!(found, Catalogue::embedded().entries().len());
}

#[test]
fn every_file_says_what_it_is() {
    let mut titles = BTreeSet::new();
    for entry in Catalogue::embedded().entries() {
        let name = format!("{} {}", entry.shelf.noun(), entry.name);
        let node = Node::parse(&Catalogue::embedded().open(&entry).unwrap()).unwrap();
        let text = |key| match node.get(key).map(|node| &node.value) {
            Some(Value::Text(text)) => text.trim().to_owned(),
            _ => String::new(),
        };
        assert!(!text("title").is_empty(), "{name}: title");
        assert!(
            titles.insert((entry.shelf, text("title"))),
            "{name}: title of another file"
        );
        assert!(text("about").ends_with('.'), "{name}: about");
        assert!(!text("source").is_empty(), "{name}: source");
        let Some(Value::Sequence(tags)) = node.get("tags").map(|node| &node.value) else {
            panic!("{name}: tags")
        };
        assert!(!tags.is_empty(), "{name}: tags");
        let mut seen = BTreeSet::new();
        for tag in tags.iter().map(|tag| tag.written().unwrap()) {
            assert!(
                tag == tag.to_lowercase() && seen.insert(tag),
                "{name}: tag {tag}"
            );
        }
    }
}

#[test]
fn every_component_can_be_used() {
    for entry in Catalogue::embedded().entries() {
        let name = &entry.name;
        let source = Catalogue::embedded().open(&entry).unwrap();
        let space = match source.text().contains("\nspace: 3\n") {
            true => "space: 3\n",
            false => "",
        };
        let text = match entry.shelf {
            Shelf::Initiators => format!("initiator: {name}\ngenerator: koch\n"),
            Shelf::Generators => format!("initiator: segment\ngenerator: {name}\n"),
            Shelf::BaseElements => {
                format!("initiator: segment\ngenerator: koch\nbase_element: {name}\n")
            }
            _ => continue,
        };
        let text = format!("{space}{text}");
        if !space.is_empty() {
            let (model, warnings) = document_of(&text).resolve(&[]).unwrap();
            assert!(warnings.is_empty(), "{text} {warnings:?}");
            let graph = model.graph_in_space(2).unwrap().unwrap();
            let growth = Growth::steps(2);
            assert!(Elements::of(&graph, &growth).count() > 1, "{text}");
            continue;
        }
        let rule = resolved(&document_of(&text), &[]);
        let graph = compiled(&rule, 3);
        let fractals = grown(&graph, &Growth::steps(2));
        let count: usize = fractals.iter().map(|fractal| fractal.elements.len()).sum();
        assert!(count > rule.initiator().elements.len(), "{text}");
        assert!(
            similarity_dimension(&graph).value.is_some() != rule.is_random(),
            "{text}"
        );
        assert_eq!(read_again(&document_of(&text).to_yaml()), *rule, "{text}");
    }
}

#[test]
fn every_rule_grows_as_forecast() {
    for (name, rule) in rules() {
        for steps in steps(&rule) {
            let graph = compiled(&rule, steps);
            let table = table_of(&graph, steps, TableFormat::Csv);
            let mut rows = table.lines();
            let header = "fractal,age,index,x0,y0,x1,y1,fertile,direction,visible";
            assert_eq!(rows.next().unwrap(), header);
            let rows: Vec<Vec<_>> = rows.map(|row| row.split(',').collect()).collect();
            assert!(rows.len() < 50_000, "{name}: a library is to be quick");
            let Some(mut forecast) = graph.forecast() else {
                assert!(rule.is_random(), "{name}: no forecast");
                continue;
            };
            for _ in 0..steps {
                assert!(forecast.advance());
            }
            let level = forecast.level();
            assert_eq!(Count::from(rows.len()), level.elements, "{name} at {steps}");
            let fertile = rows.iter().filter(|row| row[7] == "true").count();
            assert_eq!(Count::from(fertile), level.fertile, "{name} at {steps}");
        }
    }
}

#[test]
fn a_table_of_objects_has_the_same_rows() {
    for (name, rule) in rules() {
        let graph = compiled(&rule, 1);
        let csv = table_of(&graph, 1, TableFormat::Csv);
        let columns: Vec<_> = csv.lines().next().unwrap().split(',').collect();
        let objects = table_of(&graph, 1, TableFormat::JsonLines);
        assert_eq!(objects.lines().count(), csv.lines().count() - 1, "{name}");
        for (row, object) in csv.lines().skip(1).zip(objects.lines()) {
            let object: serde_json::Value = serde_json::from_str(object).unwrap();
            for (column, cell) in columns.iter().zip(row.split(',')) {
                let cell: serde_json::Value = serde_json::from_str(cell).unwrap();
                assert_eq!(object[column], cell, "{name}: {column}");
            }
        }
    }
}

/// In a small picture many vertices round to the same position.
#[test]
fn every_rule_is_drawn_within_its_picture() {
    for (name, rule) in rules() {
        for steps in steps(&rule) {
            let graph = compiled(&rule, steps);
            for size in [1024, 24] {
                let text = svg_of_size(Size::Long(size), &name, &rule, &graph, steps);
                let picture = Picture::read(std::str::from_utf8(&text).unwrap());
                let what = format!("{name} at {steps}, {size} pixels");
                assert_eq!(
                    picture.title,
                    rule.description().title.as_deref().unwrap(),
                    "{what}"
                );
                check_paths(&what, &picture, rule.metadata().view.window.is_some());
            }
        }
    }
}

/// Checks that the paths of a picture lie within it, or, if a window shows a part, that some of them do.
fn check_paths(what: &str, picture: &Picture, has_window: bool) {
    assert!(!picture.subpaths.is_empty(), "{what}");
    let [wide, high] = picture.extent;
    let is_within = |&[x, y]: &[i64; 2]| (0..=wide).contains(&x) && (0..=high).contains(&y);
    let mut vertices = picture.subpaths.iter().flat_map(|it| &it.vertices);
    match has_window {
        true => assert!(vertices.any(is_within), "{what}"),
        false => assert!(vertices.all(is_within), "{what}"),
    }
    for subpath in &picture.subpaths {
        let vertices = &subpath.vertices;
        // A curve may return to its start, a line may not.
        for (pair, &is_curved) in vertices.windows(2).zip(&subpath.is_curved) {
            assert!(is_curved || pair[0] != pair[1], "{what}: a vertex twice");
        }
        assert_eq!(subpath.is_dot, vertices.len() == 1, "{what}: a dot");
        let ends_curved = subpath.is_curved.last() == Some(&true);
        if subpath.is_closed && !ends_curved && vertices.len() > 2 {
            assert_ne!(
                vertices.first(),
                vertices.last(),
                "{what}: the first vertex twice"
            );
        }
    }
}

#[test]
fn pictures_of_lines_have_the_length_that_is_forecast() {
    for (name, rule) in rules() {
        let steps = rule.steps().unwrap();
        let graph = compiled(&rule, steps);
        let Some(bounds) = graph.bounds(steps) else {
            continue;
        };
        if !rule
            .base_elements()
            .iter()
            .all(|base_element| base_element.is_line())
        {
            continue;
        }
        let picture = svg_of(&name, &rule, &graph, steps);
        let picture = Picture::read(std::str::from_utf8(&picture).unwrap());
        let mut drawn = Bounds::EMPTY;
        let mut length = 0.0;
        let mut vertices = 0.0;
        for subpath in &picture.subpaths {
            #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
            let mut points: Vec<DVec2> = subpath
                .vertices
                .iter()
                .map(|v| v.map(|c| c as f64).into())
                .collect();
            points.iter().for_each(|point| drawn.add(*point));
            if subpath.is_closed {
                points.push(points[0]);
            }
            length += points
                .windows(2)
                .map(|pair| (pair[1] - pair[0]).length())
                .sum::<f64>();
            vertices += f64::from(u32::try_from(points.len()).unwrap());
        }
        // Every vertex is rounded to whole units.
        let scale = drawn.size().max_element() / bounds.size().max_element();
        assert!(
            (drawn.size() - scale * bounds.size()).abs().max_element() <= 2.0,
            "{name}"
        );
        let mut forecast = graph.forecast().unwrap();
        for _ in 0..steps {
            forecast.advance();
        }
        let expected = scale * forecast.level().length.unwrap();
        let off = (length - expected).abs();
        assert!(
            off <= 1.5 * vertices + 1e-4 * expected,
            "{name}: {length}, not {expected}"
        );
    }
}

#[test]
fn two_runs_give_the_same_bytes() {
    for (name, rule) in rules() {
        let again = resolved(&document(&name), &[]);
        let steps = rule.steps().unwrap();
        let [one, two] = [&rule, &again].map(|rule| compiled(rule, steps));
        let table = |graph| table_of(graph, steps, TableFormat::Csv);
        assert!(table(&one) == table(&two), "{name}: tables differ");
        let pictures = [
            svg_of(&name, &rule, &one, steps),
            svg_of(&name, &again, &two, steps),
        ];
        assert!(pictures[0] == pictures[1], "{name}: pictures differ");
    }
}

#[test]
fn printing_and_reading_again_is_the_identity() {
    for (name, rule) in rules() {
        let printed = document(&name).to_yaml();
        let again = document_of(&printed);
        assert_eq!(read_again(&printed), *rule, "{name}");
        assert_eq!(again.to_yaml(), printed, "{name}");
    }
}

#[test]
fn a_base_element_that_is_named_twice_is_printed_twice_and_read_as_one() {
    let text = "initiator: segment\nbase_element: square\ngenerator:\n  \
                - {from: [0, 0], to: [1/2, 0], base_element: triangle}\n  \
                - {from: [1/2, 0], to: [1, 0], base_element: triangle}\n  \
                - {from: [0, 1/2], to: [1/2, 1/2], base_element: square}\n";
    let document = document_of(text);
    let rule = resolved(&document, &[]);
    assert_eq!(rule.base_elements().len(), 2);
    assert_eq!(read_again(&document.to_yaml()), *rule);
}

#[test]
fn a_picture_holds_the_rule_that_it_was_made_from() {
    for (name, rule) in rules() {
        let picture = svg_of(&name, &rule, &compiled(&rule, 1), 1);
        let picture = Picture::read(std::str::from_utf8(&picture).unwrap());
        assert_eq!(read_again(&picture.metadata), *rule, "{name}");
    }
}

#[test]
fn published_dimensions_are_those_that_are_computed() {
    for (name, rule) in rules() {
        let steps = rule.steps().unwrap();
        let graph = compiled(&rule, steps);
        if let Some(computed) = similarity_dimension(&graph).value {
            let published = rule
                .dimension()
                .unwrap_or_else(|| panic!("{name} tells no dimension"));
            let off = (computed - published).abs();
            assert!(
                off <= 1e-12 * published.max(1.0),
                "{name}: {computed}, not {published}"
            );
        } else if !rule.is_random() {
            // Rules that select by step or by length have no dimension, and publish none.
            assert!(graph.depth().is_some(), "{name}: no dimension");
            assert_eq!(
                rule.dimension(),
                None,
                "{name}: no dimension to hold it against"
            );
        }
        if let Some(own) = rule.hausdorff_dimension() {
            assert!(own < rule.dimension().unwrap(), "{name}: copies overlap");
        }
    }
}
