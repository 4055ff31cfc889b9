//! JSON Schema of library files for editors, generated from the shapes that also check files.
//!
//! The schema is of draft 7, the newest that every release of the YAML language servers understands. In
//! draft 7 siblings of `$ref` are ignored, hence a key has its description beside an `allOf`.
//! Definitions of values have no descriptions of their own, which an editor would show in place of the
//! key's; for the same reason nothing has a title.

mod json;
mod switch;

use crate::catalogue::{Catalogue, Shelf};

use super::KindDocument;
use super::read::{BASE_ELEMENT, DESCRIPTION, ELEMENTS, GENERATOR, INITIATOR, PARAMETER, PARAMS};
use super::repeat::{EACH, FOR};
use super::shape::{Choice, Form, Needed, Shape};
use json::{Json, Object, list};

const DRAFT: &str = "http://json-schema.org/draft-07/schema#";

// Components as files of their own, with a description and parameters.

const INITIATOR_FILE: Shape = Shape {
    keys: &[&DESCRIPTION, &[PARAMS], INITIATOR.keys[0]],
    ..INITIATOR
};

const GENERATOR_FILE: Shape = Shape {
    keys: &[&DESCRIPTION, &[PARAMS], GENERATOR.keys[0]],
    ..GENERATOR
};

const BASE_ELEMENT_FILE: Shape = Shape {
    keys: &[&DESCRIPTION, &[PARAMS], BASE_ELEMENT.keys[0]],
    ..BASE_ELEMENT
};

/// Returns the JSON Schema (draft 7) of the files of a shelf, as text.
///
/// A file that the schema rejects is rejected by [`Document::read`](super::Document::read) as well.
/// Names, expressions and dependencies between several places are checked only there. Names of the
/// embedded library are included as suggestions.
#[must_use]
pub fn schema(shelf: Shelf) -> String {
    let schema = Object::default().with("$schema", DRAFT);
    schema.and(body(shelf, "#")).to_text()
}

/// Returns the JSON Schema (draft 7) of files of every kind, as text. A file is validated by the schema
/// of its `kind`, or, without a `kind`, by that of the component to which its keys belong, or else as a
/// rule.
#[must_use]
pub fn schema_of_all() -> String {
    let schema = Object::default()
        .with("$schema", DRAFT)
        .with(
            "description",
            "A file of kfrac: a rule, a system, a structure, an L-system, or a component of rules.",
        )
        .and(switch::by_kind());
    let bodies = Shelf::all().map(|shelf| {
        let at = format!("#{}", switch::place(shelf));
        (shelf.kind().to_owned(), body(shelf, &at).into())
    });
    schema
        .with("definitions", Object(bodies.collect()))
        .to_text()
}

/// Returns the schema of the files of a shelf, located at `at` in the whole document.
fn body(shelf: Shelf, at: &str) -> Object {
    let mut definitions = Definitions {
        at: at.into(),
        alone: !Shelf::grown().contains(&shelf),
        named: Vec::new(),
    };
    let (about, body) = match shelf {
        Shelf::Fractals(kind) => {
            let table = KindDocument::table(kind);
            (table.about, definitions.grown(table.shape))
        }
        Shelf::Initiators => (
            "An initiator: what the growth starts from.",
            definitions.either(&[ELEMENTS, Form::Mapping(&INITIATOR_FILE)]),
        ),
        Shelf::Generators => (
            "A generator: what replaces an element.",
            definitions.either(&[ELEMENTS, Form::Mapping(&GENERATOR_FILE)]),
        ),
        Shelf::BaseElements => (
            "A base element: what an element looks like.",
            definitions.mapping(&BASE_ELEMENT_FILE),
        ),
    };
    Object::default()
        .with("description", about)
        .and(body)
        .with("definitions", Object(definitions.named))
}

/// The definitions of a schema, in the order of first use.
struct Definitions {
    /// JSON pointer to the schema within the whole document.
    at: String,
    named: Vec<(String, Json)>,
    /// Whether the file cannot extend another, which could supply required keys.
    alone: bool,
}

impl Definitions {
    /// Returns the schema of a complete fractal, in which the keys that a parent may supply are
    /// required only without `extends`.
    fn grown(&mut self, shape: &Shape) -> Object {
        let extends = Object::default().with("required", list(["extends"]));
        let values = Object::default().with("additionalProperties", required(&PARAMETER, true));
        let alone = required(shape, true)
            .with("properties", Object::default().with(PARAMS.name, values))
            .and(alternatives(shape, true));
        self.keys(shape)
            .with("if", extends)
            .with(
                "then",
                required(shape, false).and(alternatives(shape, false)),
            )
            .with("else", alone)
    }

    fn mapping(&mut self, shape: &Shape) -> Object {
        self.keys(shape)
            .and(required(shape, self.alone))
            .and(alternatives(shape, true))
    }

    /// Returns the schema of the keys of a mapping and of their values.
    fn keys(&mut self, shape: &Shape) -> Object {
        of_type("object")
            .with("properties", self.properties(shape))
            .with("additionalProperties", false)
    }

    /// Returns the schemas of the values by key.
    fn properties(&mut self, shape: &Shape) -> Object {
        let mut properties = Object::default();
        for member in shape.members() {
            let form = self.form(&member.holds);
            let form = if form.has("$ref") {
                Object::default().with("allOf", list([form]))
            } else {
                form
            };
            let about = Object::default().with("description", member.about);
            properties = properties.with(member.name, about.and(form));
        }
        properties
    }

    fn either(&mut self, forms: &[Form]) -> Object {
        let alternatives = self.alternatives(forms.iter());
        Object::default().with("anyOf", list(alternatives))
    }

    fn alternatives<'f>(&mut self, forms: impl Iterator<Item = &'f Form>) -> Vec<Object> {
        let mut alternatives = Vec::new();
        for form in forms {
            if let Form::File(shelf) = form {
                alternatives.push(Object::default().with("enum", names(&[*shelf])));
                alternatives.push(of_type("string"));
            } else {
                alternatives.push(self.form(form));
            }
        }
        alternatives
    }

    /// Returns the schema of a value.
    fn form(&mut self, form: &Form) -> Object {
        match form {
            Form::MeshFile => of_type("string"),
            Form::Text => of_types(["string", "number"]),
            Form::Flag(default) => of_type("boolean").with("default", *default),
            Form::Number => of_types(["number", "string"]),
            // The minimum applies to plain numbers; expressions are text.
            Form::Positive => self.form(&Form::Number).with("minimum", 0),
            Form::Whole(least, most) => {
                let number = of_types(["integer", "string"]).with("minimum", *least);
                match most {
                    Some(most) => number.with("maximum", *most),
                    None => number,
                }
            }
            Form::Expression => of_type("string"),
            Form::Choice(choice) => one_of(choice()),
            Form::Exactly(number) => Object::default().with("const", *number),
            Form::Words(words) => Object::default().with("enum", list(words.iter().copied())),
            Form::Colour => of_types(["string", "null"]),
            Form::File(_) => self.either(std::slice::from_ref(form)),
            Form::Grown => {
                let names = Object::default().with("enum", names(&Shelf::grown()));
                let written = [names, of_type("string"), of_type("object")];
                Object::default().with("anyOf", list(written))
            }
            Form::Point => self.defined("point", |definitions| {
                definitions.either(&[Form::List(&Form::Number, 2, Some(2)), Form::Expression])
            }),
            Form::Place => self.defined("place", |definitions| {
                definitions.either(&[Form::List(&Form::Number, 2, Some(3)), Form::Expression])
            }),
            Form::List(of, least, most) => {
                let enough =
                    Object::default().with_some("minItems", (*least > 0).then_some(*least));
                if most.is_some() {
                    let entries = of_type("array").with("items", self.form(of));
                    return entries.and(enough).with_some("maxItems", *most);
                }
                let entries = of_type("array").with("items", self.entry(of));
                if *least < 2 {
                    return entries.and(enough);
                }
                // A repetition stands for any number of entries.
                let repetition = of_type("object").with("required", list([FOR]));
                let contains = Object::default().with("contains", repetition);
                entries.with("anyOf", list([enough, contains]))
            }
            Form::Names(of, least) => {
                let names = of_type("object").with("additionalProperties", self.form(of));
                names.with_some("minProperties", (*least > 0).then_some(*least))
            }
            Form::Mapping(shape) => {
                self.defined(&name_of(shape), |definitions| definitions.mapping(shape))
            }
            Form::Either(forms) => self.either(forms),
        }
    }

    /// Returns the schema of an entry of an open list, or of its repetition: a mapping has `for` beside its own keys, and
    /// another value is that of `each` beside `for`.
    fn entry(&mut self, form: &Form) -> Object {
        let forms = match form {
            Form::Either(forms) => *forms,
            form => std::slice::from_ref(form),
        };
        let mut all = Vec::new();
        for form in forms {
            if let Form::Mapping(shape) = form {
                let name = format!("entry-{}", name_of(shape));
                all.push(self.defined(&name, |definitions| definitions.listed(shape)));
            }
        }
        let others = || {
            forms
                .iter()
                .filter(|form| !matches!(form, Form::Mapping(_)))
        };
        if others().next().is_some() {
            let each = Object::default().with("anyOf", list(self.alternatives(others())));
            let properties = self.repetition().with(EACH, each);
            all.extend(self.alternatives(others()));
            all.push(
                of_type("object")
                    .with("properties", properties)
                    .with("required", list([FOR, EACH]))
                    .with("additionalProperties", false),
            );
        }
        match <[Object; 1]>::try_from(all) {
            Ok([one]) => one,
            Err(all) => Object::default().with("anyOf", list(all)),
        }
    }

    /// Returns the schema of a mapping in a list, which may be repeated.
    fn listed(&mut self, shape: &Shape) -> Object {
        let properties = self.properties(shape).and(self.repetition());
        of_type("object")
            .with("properties", properties)
            .with("additionalProperties", false)
            .and(required(shape, self.alone))
            .and(alternatives(shape, true))
    }

    /// Returns the schema of `for` by its key.
    fn repetition(&mut self) -> Object {
        let values = self.defined("values-by-name", |definitions| {
            let values = of_type("array").with("items", definitions.form(&Form::Text));
            let either = Object::default().with("anyOf", list([of_type("string"), values]));
            of_type("object").with("additionalProperties", either)
        });
        let about = "The entry is repeated for every value of a name, over a range, {k: 0..11}, or a list, \
                     {k: [1, 3, 5]}. The keys beside it, or `each`, use the name in expressions.";
        let names = Object::default().with("description", about);
        Object::default().with(FOR, names.with("allOf", list([values])))
    }

    /// Returns a reference to a definition, which is added at its first use.
    fn defined(&mut self, name: &str, make: impl FnOnce(&mut Self) -> Object) -> Object {
        if !self.named.iter().any(|(known, _)| known == name) {
            let definition = make(self);
            self.named.push((name.into(), definition.into()));
        }
        Object::default().with("$ref", format!("{}/definitions/{name}", self.at))
    }
}

/// Returns names of the embedded library as suggestions; other libraries may have further ones.
fn names(shelves: &[Shelf]) -> Json {
    let entries = Catalogue::embedded().entries().into_iter();
    let entries = entries.filter(|entry| shelves.contains(&entry.shelf));
    list(entries.map(|entry| entry.name))
}

/// Returns the name of the definition of a mapping.
fn name_of(shape: &Shape) -> String {
    shape.what.split(' ').skip(1).collect::<Vec<_>>().join("-")
}

/// Returns the constraint for required keys.
fn required(shape: &Shape, alone: bool) -> Object {
    let needed = |needed| needed == Needed::Always || (alone && needed == Needed::Alone);
    let members = shape.members().filter(|member| needed(member.needed));
    let names: Vec<_> = members.map(|member| member.name).collect();
    let names = (!names.is_empty()).then(|| list(names));
    Object::default().with_some("required", names)
}

/// Returns the constraint for alternative sets of keys: one set is required if `needed`, and its
/// exclusions apply in any case.
fn alternatives(shape: &Shape, needed: bool) -> Object {
    let alternatives = shape.alternatives.iter().map(|keys| {
        let needs = needed.then(|| list(keys.needs.iter().copied()));
        let excluded = keys.excludes.iter();
        let excluded = excluded.map(|key| ((*key).to_owned(), false.into()));
        Object::default()
            .with_some("required", needs)
            .with("properties", Object(excluded.collect()))
    });
    let alternatives = (!shape.alternatives.is_empty()).then(|| list(alternatives));
    Object::default().with_some("anyOf", alternatives)
}

fn of_type(name: &str) -> Object {
    Object::default().with("type", name)
}

fn of_types(names: [&str; 2]) -> Object {
    Object::default().with("type", list(names))
}

/// Returns the schema of a name of an enumeration. With a name `none`, null is accepted as well.
fn one_of(choice: Choice) -> Object {
    let none = choice.names.contains(&"none").then_some(Json::Null);
    let names = choice.names.into_iter().map(Json::from).chain(none);
    Object::default()
        .with("enum", list(names))
        .with("default", choice.default)
}
