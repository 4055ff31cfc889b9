//! The schemas for editors, compared with files and with the reader by an independent validator.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::laws::rules;
use jsonschema::Validator;
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::diagnostic::{Diagnostics, Source};
use kfrac::document::{Document, schema, schema_of_all};
use proptest::prelude::*;
use serde_json::{Value, json};

fn parsed(shelf: Shelf) -> Value {
    serde_json::from_str(&schema(shelf)).unwrap()
}

fn validator(shelf: Shelf) -> Validator {
    jsonschema::draft7::new(&parsed(shelf)).unwrap()
}

/// Parses a text as editors do, by YAML 1.2.
fn yaml(text: &str) -> Option<Value> {
    let options = serde_saphyr::options! { strict_booleans: true };
    serde_saphyr::from_str_with_options(text, options).ok()
}

/// Returns the shelf of a file by its content.
fn shelf_of(value: &Value) -> Shelf {
    match value.get("kind").and_then(Value::as_str) {
        Some("ifs") => Shelf::IFS,
        Some("instancing") => Shelf::INSTANCING,
        Some("lsystem") => Shelf::LSYSTEMS,
        _ => Shelf::RULES,
    }
}

fn assert_valid(validator: &Validator, name: &str, text: &str) {
    let value = yaml(text).unwrap_or_else(|| panic!("{name} is no YAML"));
    let errors: Vec<_> = validator.iter_errors(&value).collect();
    assert!(errors.is_empty(), "{name}: {errors:#?}");
}

#[test]
fn the_files_of_the_library_say_what_the_command_prints() {
    for shelf in Shelf::all() {
        assert!(jsonschema::draft7::meta::is_valid(&parsed(shelf)));
        let path = format!("library/schema/{}.json", shelf.kind());
        if std::env::var_os("KFRAC_BLESS").is_some() {
            fs::write(&path, schema(shelf)).unwrap();
        }
        let file = fs::read_to_string(&path).unwrap_or_default();
        assert!(
            file == schema(shelf),
            "{path} is out of date (KFRAC_BLESS=1 writes it anew)"
        );
    }
}

#[test]
fn the_library_is_valid_and_leads_to_its_schema() {
    let catalogue = Catalogue::embedded();
    for entry in catalogue.entries() {
        let source = catalogue.open(&entry).unwrap();
        assert_valid(&validator(entry.shelf), source.name(), source.text());
        let first = source.text().lines().next();
        assert_eq!(first, Some(&*entry.shelf.modeline()), "{}", source.name());
        let modeline = entry.shelf.modeline();
        let (_, path) = modeline.split_once("$schema=").unwrap();
        let folder = Path::new("library").join(entry.shelf.folder());
        assert!(folder.join(path).is_file());
    }
}

fn validator_of_all() -> Validator {
    let schema = serde_json::from_str(&schema_of_all()).unwrap();
    assert!(jsonschema::draft7::meta::is_valid(&schema));
    jsonschema::draft7::new(&schema).unwrap()
}

/// Editors may apply one schema to every file of a folder.
#[test]
fn one_schema_holds_for_every_file() {
    let all = validator_of_all();
    let catalogue = Catalogue::embedded();
    for entry in catalogue.entries() {
        let source = catalogue.open(&entry).unwrap();
        assert_valid(&all, source.name(), source.text());
        // Unknown keys are underlined, and so are values of a wrong type.
        let value = yaml(source.text()).unwrap();
        let mut misspelt = value.clone();
        misspelt["titel"] = json!("Koch curve");
        let mut mistyped = value;
        mistyped["tags"] = json!(7);
        for wrong in [misspelt, mistyped] {
            assert!(!all.is_valid(&wrong), "{wrong}");
            assert!(!validator(entry.shelf).is_valid(&wrong), "{wrong}");
        }
    }
    for right in ["[[0, 0], [1/2, 1/2], [1, 0]]", "extends: koch"] {
        assert_valid(&all, right, right);
    }
    for wrong in [
        "kind: lsytem",
        "kind: [ifs]",
        "kind: ifs",
        "title: of nothing",
        "elements: [[0, 0], [1, 0]]\nstpes: 3",
        "elements: [[0, 0], [1, 0]]\ninitiator: segment",
        "7",
        "",
    ] {
        assert!(!all.is_valid(&yaml(wrong).unwrap()), "{wrong}");
    }
}

#[test]
fn the_rules_of_the_reference_are_valid() {
    let rules = include_str!("../library/README.md")
        .split("```yaml\n")
        .skip(1);
    let mut number = 0;
    for rule in rules {
        let rule = rule.split("```").next().unwrap();
        let shelf = shelf_of(&yaml(rule).unwrap());
        assert_valid(&validator(shelf), &format!("rule {number}"), rule);
        number += 1;
    }
    assert!(number >= 10, "only {number} whole rules were found");
}

proptest! {
    #![proptest_config(crate::common::cases(64))]

    #[test]
    fn random_rules_are_valid(text in rules::rule(rules::Features::ALL)) {
        assert_valid(&validator(Shelf::RULES), &text, &text);
    }
}

/// Returns whether a message concerns a key or the type of a value, which a schema covers, and not an
/// expression.
fn is_of_structure(said: &str) -> bool {
    let mut errors = said.lines().filter(|line| line.starts_with("error: "));
    errors.any(|error| {
        error.contains("unknown key")
            || error.contains("cannot stand together")
            || error.contains("` does not belong to ")
            || error.contains("` belongs to ")
            || error.contains(" is needed here, this is ") && !error.contains("a condition")
    })
}

#[test]
fn what_people_write_by_mistake_is_refused() {
    // The errors are in another file.
    const ACCEPTED: [&str; 1] = ["mistakes-in-a-component.yaml"];
    let validator = validator(Shelf::RULES);
    let mut accepted = Vec::new();
    for file in fs::read_dir("tests/bad").unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "yaml") {
            continue;
        }
        let said = fs::read_to_string(path.with_extension("txt")).unwrap();
        let Some(value) = yaml(&fs::read_to_string(&path).unwrap()) else {
            continue;
        };
        if is_of_structure(&said) && validator.is_valid(&value) {
            accepted.push(path.file_name().unwrap().to_owned());
        }
    }
    assert_eq!(accepted, ACCEPTED);
}

/// Appends all places in a value, as JSON pointers.
fn places(value: &Value, at: &str, places: &mut Vec<String>) {
    places.push(at.into());
    match value {
        Value::Array(list) => {
            for (index, value) in list.iter().enumerate() {
                self::places(value, &format!("{at}/{index}"), places);
            }
        }
        Value::Object(entries) => {
            for (key, value) in entries {
                self::places(value, &format!("{at}/{key}"), places);
            }
        }
        _ => {}
    }
}

/// Returns the value with one place changed in all the ways that are tried; `keys` are added to mappings.
fn changes(value: &Value, keys: &BTreeMap<String, Value>) -> Vec<Value> {
    let mut all = Vec::new();
    places(value, "", &mut all);
    let mut changed = Vec::new();
    for place in all {
        let mut change = |change: &dyn Fn(&mut Value)| {
            let mut copy = value.clone();
            change(copy.pointer_mut(&place).unwrap());
            changed.push(copy);
        };
        for other in [
            Value::Null,
            json!(true),
            json!(7),
            json!(-0.5),
            json!("1/2"),
            json!("none"),
            json!([]),
            json!([0, 0]),
            json!([[0, 0], [1, 0]]),
            json!({}),
        ] {
            change(&|value| *value = other.clone());
        }
        match value.pointer(&place).unwrap() {
            Value::Array(list) => {
                change(&|value| value.as_array_mut().unwrap().push(json!(7)));
                for index in 0..list.len() {
                    change(&|value| drop(value.as_array_mut().unwrap().remove(index)));
                }
            }
            Value::Object(entries) => {
                // Mappings inside others are many: each gets other keys.
                let (first, stride) = match place.as_str() {
                    "" => (0, 1),
                    inner => (inner.len() % STRIDE, STRIDE),
                };
                for (key, other) in keys.iter().skip(first).step_by(stride) {
                    change(&|value| value[key] = other.clone());
                }
                for key in entries.keys() {
                    change(&|value| drop(value.as_object_mut().unwrap().remove(key)));
                }
            }
            _ => {}
        }
    }
    changed
}

/// Distance of the keys that are added to a mapping inside another one.
const STRIDE: usize = 3;

/// Returns the diagnostics of the reader for a rule, or for a rule that names the component; both are written
/// as JSON, which is also YAML.
fn read(shelf: Shelf, value: &Value, library: &Path) -> Diagnostics {
    let catalogue = Catalogue::with_folders(vec![library.into()]);
    let text = value.to_string();
    let rule = match shelf {
        Shelf::Initiators => "initiator: changed\ngenerator: koch\n".into(),
        Shelf::Generators => "initiator: segment\ngenerator: changed\n".into(),
        Shelf::BaseElements => {
            "initiator: segment\ngenerator: koch\nbase_element: changed\n".into()
        }
        _ => text.clone(),
    };
    if !Shelf::grown().contains(&shelf) {
        let folder = library.join(shelf.folder());
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("changed.yaml"), text).unwrap();
    }
    let document = Document::read(&Source::new("changed.yaml", rule), &catalogue);
    let (Ok(said) | Err(said)) =
        document.and_then(|document| document.resolve(&[]).map(|(_, doubts)| doubts));
    said
}

#[test]
fn the_schemas_and_the_reader_agree() {
    let library = tempfile::tempdir().unwrap();
    let rules = yaml(include_str!("schema/samples.yaml")).unwrap();
    let mut keys = BTreeMap::new();
    collect_keys(&rules, &mut keys);
    let rules = rules.as_object().unwrap().values().cloned();
    let mut samples: Vec<_> = rules.map(|file| (shelf_of(&file), file)).collect();
    for (shelf, name) in [
        (Shelf::Initiators, "triangle"),
        (Shelf::Generators, "swaying-roof"),
        (Shelf::BaseElements, "half-circle"),
    ] {
        let source = Catalogue::embedded().component(shelf, name).unwrap();
        samples.push((shelf, yaml(source.text()).unwrap()));
    }
    let all = validator_of_all();
    for (shelf, sample) in samples {
        let validator = validator(shelf);
        let is_of_shelf = |value: &Value| match value.get("kind") {
            Some(kind) => kind == shelf.kind(),
            None => shelf == Shelf::RULES && value.get("initiator").is_some(),
        };
        let said = read(shelf, &sample, library.path());
        assert!(
            validator.is_valid(&sample) && said.is_empty(),
            "{said}{sample}"
        );
        for changed in changes(&sample, &keys) {
            let said = read(shelf, &changed, library.path());
            if is_of_shelf(&changed) {
                assert_eq!(
                    all.is_valid(&changed),
                    validator.is_valid(&changed),
                    "{changed}"
                );
            }
            if validator.is_valid(&changed) {
                assert!(!is_of_structure(&said.to_string()), "{said}{changed}");
            } else {
                assert!(said.has_errors(), "only the schema refuses {changed}");
            }
        }
    }
}

/// Collects all keys in a value, each with an example of its value.
fn collect_keys(value: &Value, keys: &mut BTreeMap<String, Value>) {
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                keys.insert(key.clone(), value.clone());
                collect_keys(value, keys);
            }
        }
        Value::Array(list) => list.iter().for_each(|value| collect_keys(value, keys)),
        _ => {}
    }
}

/// Collects all keys that a schema defines.
fn collect_properties(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(entries) => {
            let keys = entries.get("properties").and_then(Value::as_object);
            found.extend(keys.into_iter().flat_map(|keys| keys.keys().cloned()));
            let schemas = entries.values();
            schemas.for_each(|schema| collect_properties(schema, found));
        }
        Value::Array(list) => list
            .iter()
            .for_each(|schema| collect_properties(schema, found)),
        _ => {}
    }
}

#[test]
fn the_samples_have_every_key() {
    let mut written = BTreeMap::new();
    collect_keys(
        &yaml(include_str!("schema/samples.yaml")).unwrap(),
        &mut written,
    );
    let mut known = BTreeSet::new();
    for shelf in Shelf::grown() {
        collect_properties(&parsed(shelf), &mut known);
    }
    known.retain(|key| !written.contains_key(key));
    assert!(known.is_empty(), "{known:?}");
}
