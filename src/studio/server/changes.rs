//! Changes of the text and of its file.

use std::path::Path;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Query, State};
use serde::Deserialize;
use serde_json::json;

use crate::catalogue::Shelf;
use crate::cli::new;
use crate::diagnostic::Source;
use crate::kind::Kind;

use super::super::answer::Refusal;
use super::super::files::is_rule;
use super::super::{library, vary};
use super::{Answer, Seen, Shared, Tab, apart};

#[derive(Deserialize)]
pub(super) struct TextQuery {
    revision: u64,
    #[serde(default)]
    tab: String,
}

pub(super) async fn set_text(
    State(app): Shared,
    Query(query): Query<TextQuery>,
    body: Bytes,
) -> Answer {
    let text = String::from_utf8(body.into());
    let text = text.map_err(|_| Refusal::wrong("the text is not UTF-8"))?;
    let reader = app.session().reader();
    let checked = apart(move || reader.check(text.into())).await?;
    app.change(query.tab, move |session| {
        session.set_text(checked, query.revision)
    })
    .await
}

pub(super) async fn undo(State(app): Shared, Json(Tab { tab }): Json<Tab>) -> Answer {
    app.change(tab, |session| {
        session.travel(true);
        Ok(())
    })
    .await
}

pub(super) async fn redo(State(app): Shared, Json(Tab { tab }): Json<Tab>) -> Answer {
    app.change(tab, |session| {
        session.travel(false);
        Ok(())
    })
    .await
}

#[derive(Deserialize)]
pub(super) struct Settle {
    #[serde(default)]
    tab: String,
    theirs: bool,
}

pub(super) async fn settle(
    State(app): Shared,
    seen: Seen,
    Json(Settle { tab, theirs }): Json<Settle>,
) -> Answer {
    app.change(tab, move |session| {
        session.check_file(seen)?;
        session.settle(theirs);
        Ok(())
    })
    .await
}

#[derive(Deserialize)]
pub(super) struct Vary {
    seed: u32,
}

/// Number of members beside the present one.
const AROUND: u64 = 8;

pub(super) async fn vary_all(State(app): Shared, Json(Vary { seed }): Json<Vary>) -> Answer {
    let mut session = app.session();
    let good = session.good()?.clone();
    let seeds = (0..AROUND).map(|number| u64::from(seed) * AROUND + number);
    let set = session.look.set.clone();
    let all = seeds.filter_map(|seed| vary::variant(&good.source, &good.parameters, &set, seed));
    let variants: Vec<_> = all.collect();
    if variants.is_empty() {
        return Err(Refusal::wrong(
            "there is no number to vary: only whole ones",
        ));
    }
    let answer = json!({ "variants": variants });
    session.variants = (session.revision, variants);
    Ok(Json(answer))
}

#[derive(Deserialize)]
pub(super) struct Take {
    #[serde(default)]
    tab: String,
    variant: usize,
}

pub(super) async fn take(
    State(app): Shared,
    seen: Seen,
    Json(Take { tab, variant }): Json<Take>,
) -> Answer {
    app.change(tab, move |session| {
        session.check_file(seen)?;
        let variant = session.variant(variant)?.clone();
        session.look.set = variant.set;
        let checked = session.reader().check(variant.text);
        let revision = session.revision;
        session.set_text(checked, revision)
    })
    .await
}

#[derive(Deserialize)]
pub(super) struct Written {
    #[serde(default)]
    tab: String,
    /// Name of a parameter that is set.
    name: String,
}

/// Writes the value of a parameter that is set into the text.
pub(super) async fn write_value(
    State(app): Shared,
    seen: Seen,
    Json(Written { tab, name }): Json<Written>,
) -> Answer {
    app.change(tab, move |session| {
        session.check_file(seen)?;
        session.write_value(&name)
    })
    .await
}

#[derive(Deserialize)]
pub(super) struct Open {
    #[serde(default)]
    tab: String,
    id: String,
}

pub(super) async fn open(State(app): Shared, Json(Open { tab, id }): Json<Open>) -> Answer {
    app.change(tab, move |session| {
        let source = library::source(&session.catalogue.clone(), &id)?;
        let name = id.rsplit('/').next().unwrap_or(&id);
        session.copy(name, &source);
        Ok(())
    })
    .await
}

/// Request for a file to begin with.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Begin {
    #[serde(default)]
    tab: String,
    /// Name of the file, with or without its extension.
    name: String,
    kind: String,
    /// Whether the fractal lies in space.
    #[serde(default)]
    space: bool,
}

/// Returns the name of a file with its extension, and without it.
fn named(name: &str) -> Result<(String, String), Refusal> {
    const LONGEST: usize = 200;
    let name = name.trim();
    let is_odd = |it: char| it.is_control() || matches!(it, '/' | '\\');
    if name.is_empty()
        || name.len() > LONGEST
        || name.starts_with(['.', '-'])
        || name.contains(is_odd)
    {
        return Err(Refusal::wrong(format!(
            "a file has a name of up to {LONGEST} bytes, without a folder, which does not begin with '.' or '-'"
        )));
    }
    let (name, extension) = match name.rsplit_once('.') {
        Some((stem, extension)) if is_rule(Path::new(name)) => (stem, extension),
        _ => (name, "yaml"),
    };
    Ok((format!("{name}.{extension}"), name.to_owned()))
}

/// Opens the file that `kfrac new` writes as a copy that is not saved.
pub(super) async fn begin(State(app): Shared, Json(asked): Json<Begin>) -> Answer {
    let kind = Kind::named(&asked.kind)
        .ok_or_else(|| Refusal::wrong("there is no such kind of fractal"))?;
    let (file, stem) = named(&asked.name)?;
    let text = new::content(kind, asked.space, &file, &stem);
    app.change(asked.tab, move |session| {
        session.copy(&file, &Source::new(file.clone(), text));
        Ok(())
    })
    .await
}

#[derive(Deserialize)]
pub(super) struct Save {
    #[serde(default)]
    tab: String,
    path: Option<String>,
    #[serde(default)]
    replace: bool,
    /// Whether it is saved in the person's library.
    #[serde(default)]
    library: bool,
}

pub(super) async fn save(State(app): Shared, seen: Seen, Json(asked): Json<Save>) -> Answer {
    let Save {
        tab,
        path,
        replace,
        library,
    } = asked;
    app.change(tab, move |session| {
        session.check_file(seen)?;
        let path = match (library, path) {
            (false, path) => path,
            (true, Some(name)) => {
                let path = {
                    let shelf = Shelf::Fractals(session.kind());
                    session.roots.in_library(&name, shelf)?
                };
                Some(path.to_string_lossy().into_owned())
            }
            (true, None) => return Err(Refusal::wrong("a rule of the library has a name")),
        };
        session.save(path.as_deref(), replace).map(|_| ())
    })
    .await
}

#[derive(Deserialize)]
pub(super) struct SaveComponent {
    #[serde(default)]
    tab: String,
    panel: String,
    name: String,
}

pub(super) async fn component(
    State(app): Shared,
    seen: Seen,
    Json(SaveComponent { tab, panel, name }): Json<SaveComponent>,
) -> Answer {
    app.change(tab, move |session| {
        session.check_file(seen)?;
        session.save_component(&panel, &name)
    })
    .await
}
