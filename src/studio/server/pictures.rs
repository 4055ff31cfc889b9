//! Pictures: of the session, of other looks, of the library, and in files.

use std::path::Path;
use std::sync::Arc;

use axum::Json;
use axum::body::Body;
use axum::extract::{Query, State};
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::cli::held::Held;
use crate::render::PngEncoding;

use super::super::answer::Refusal;
use super::super::drawing::{Drawn, MOST_BYTES, MOST_PIXELS, Shot};
use super::super::jobs::Jobs;
use super::super::library;
use super::super::look::Look;
use super::super::shots::Quality;
use super::super::sight::Sight;
use super::super::view::Gesture;
use super::{Answer, Seen, Shared, Tab};

/// Request for a picture.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Picture {
    tab: String,
    width: u32,
    height: u32,
    /// Whether it is one of many while a hand moves: a draft, in pixels without an encoding.
    #[serde(default)]
    draft: bool,
    look: Option<Look>,
    gesture: Option<Gesture>,
    /// Window of the plane that is shown whole: lower left corner, width, height.
    window: Option<[f64; 4]>,
    /// Member near the present one to draw, of a preview.
    variant: Option<usize>,
}

impl Picture {
    fn quality(&self) -> Quality {
        match self.draft {
            true => Quality::Draft,
            false => Quality::Full,
        }
    }

    fn size(&self) -> Result<[u32; 2], Refusal> {
        let size = [self.width, self.height];
        match size.iter().all(|side| (1..=MOST_PIXELS).contains(side)) {
            true => Ok(size),
            false => Err(Refusal::wrong(format!(
                "a side has 1 to {MOST_PIXELS} pixels"
            ))),
        }
    }
}

/// Draws the picture of the session, with a look that it keeps.
pub(super) async fn picture(
    State(app): Shared,
    seen: Seen,
    Json(asked): Json<Picture>,
) -> Result<Response, Refusal> {
    let size = asked.size()?;
    let (shot, look, file) = {
        let mut session = app.session();
        session.check_file(seen)?;
        let before = session.look.clone();
        if let Some(look) = asked.look.clone() {
            look.check()?;
            session.look = look;
        }
        if let Some(gesture) = &asked.gesture {
            session.gesture(gesture)?;
        }
        if let Some(window) = asked.window {
            session.show(window, size)?;
        }
        let look = session.look.clone();
        if let Err(refusal) = session.check_size(&look) {
            session.look = before;
            return Err(refusal);
        }
        if look != before {
            app.announce(&asked.tab);
        }
        (
            session.shot(&look, size, asked.quality())?,
            look,
            session.file,
        )
    };
    let encoding = match asked.draft {
        true => PngEncoding::raw(),
        false => PngEncoding::default(),
    };
    let drawn = draw(&app.pictures, &asked.tab, shot, encoding).await?;
    let mut session = app.session();
    if asked.draft {
        session.note_draft(&drawn);
    }
    if session.look == look && session.file == file {
        session.window = drawn.window;
        session.sight = { drawn.sight.as_ref() }.map(|drawn| Sight::of(drawn, &look));
    }
    let extra = json!({ "look": session.look, "factor": session.factor() });
    drop(session);
    let kind = match asked.draft {
        true => "application/octet-stream",
        false => "image/png",
    };
    answered(drawn, kind, &extra)
}

/// Draws a small picture of another look, which the session does not take.
pub(super) async fn preview(
    State(app): Shared,
    Json(asked): Json<Picture>,
) -> Result<Response, Refusal> {
    let size = asked.size()?;
    let shot = {
        let session = app.session();
        let mut look = asked.look.clone().unwrap_or_else(|| session.look.clone());
        match asked.variant {
            None => session.shot(&look, size, Quality::Draft)?,
            Some(number) => {
                let variant = session.variant(number)?;
                look.set.clone_from(&variant.set);
                let source = session.reader().source(&variant.text);
                session.shot_of(session.good()?, &source, &look, size, Quality::Draft)?
            }
        }
    };
    let fast = PngEncoding::default().fast(true);
    let drawn = draw(&app.thumbs, &asked.tab, shot, fast).await?;
    answered(drawn, "image/png", &Value::Null)
}

/// Request for a map of parameters.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Map {
    tab: String,
    /// Ranges, as `kfrac map --over` takes them.
    over: Vec<String>,
    width: u32,
    height: u32,
}

pub(super) async fn map(State(app): Shared, Json(asked): Json<Map>) -> Result<Response, Refusal> {
    const MOST: u32 = 1024;
    let size = [asked.width, asked.height];
    let are_short = asked.over.len() <= 2 && asked.over.iter().all(|it| it.len() <= 500);
    if !are_short || !size.iter().all(|side| (1..=MOST).contains(side)) {
        let message = format!("a map has two parameters, and a side 1 to {MOST} pixels");
        return Err(Refusal::wrong(message));
    }
    let shot = {
        let session = app.session();
        session.shot(&session.look, size, Quality::Full)?
    };
    let held = Arc::new(Held::new(MOST_BYTES, PngEncoding::default().fast(true)));
    let own = Arc::clone(&held);
    let name = format!("map {}", asked.tab);
    let bytes = {
        app.thumbs
            .run(&name, held, move || shot.map(&asked.over, &own))
    }
    .await?;
    Ok(([(header::CONTENT_TYPE, "image/png")], bytes).into_response())
}

/// Draws the figure of the rule.
pub(super) async fn figure(
    State(app): Shared,
    Query(Tab { tab }): Query<Tab>,
) -> Result<Response, Refusal> {
    let shot = {
        let session = app.session();
        session.shot(&session.look, [1; 2], Quality::Full)?
    };
    let held = Arc::new(Held::new(MOST_BYTES, PngEncoding::default()));
    let own = Arc::clone(&held);
    let name = format!("figure {tab}");
    let bytes = app.thumbs.run(&name, held, move || shot.figure(&own));
    Ok(([(header::CONTENT_TYPE, "image/svg+xml")], bytes.await?).into_response())
}

/// Request for the frames of a film.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FrameRequest {
    tab: String,
    look: Look,
}

pub(super) async fn film(State(app): Shared, Json(asked): Json<FrameRequest>) -> Answer {
    let FrameRequest { tab, look } = asked;
    let shot = app.session().shot(&look, [1024, 768], Quality::Full)?;
    let held = Arc::new(Held::new(MOST_BYTES, PngEncoding::default()));
    let own = Arc::clone(&held);
    let name = format!("film {tab}");
    let found = { app.thumbs.run(&name, held, move || shot.film(&look, &own)) }.await?;
    Ok(Json(found))
}

async fn draw(jobs: &Jobs, tab: &str, shot: Shot, encoding: PngEncoding) -> Result<Drawn, Refusal> {
    let held = Arc::new(Held::new(MOST_BYTES, encoding));
    let own = Arc::clone(&held);
    jobs.run(tab, held, move || shot.draw(&own)).await
}

/// Answers with a picture, and with its numbers in a header.
fn answered(drawn: Drawn, kind: &'static str, extra: &Value) -> Result<Response, Refusal> {
    let mut numbers = serde_json::to_value(&drawn).unwrap_or_default();
    numbers["session"] = extra.clone();
    let numbers = HeaderValue::from_str(&ascii(&numbers.to_string()));
    let numbers = numbers.map_err(|error| Refusal::wrong(error.to_string()))?;
    let mut response = Response::new(Body::from(drawn.bytes));
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    headers.insert("x-kfrac-picture", numbers);
    Ok(response)
}

/// Escapes what is not ASCII in JSON, for a header.
fn ascii(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    let mut units = [0; 2];
    for letter in json.chars() {
        match letter {
            ' '..='~' => text.push(letter),
            _ => { letter.encode_utf16(&mut units).iter() }
                .for_each(|unit| text.push_str(&format!("\\u{unit:04x}"))),
        }
    }
    text
}

#[derive(Deserialize)]
pub(super) struct Id {
    id: String,
}

pub(super) async fn thumb(
    State(app): Shared,
    Query(Id { id }): Query<Id>,
) -> Result<Response, Refusal> {
    let bytes = match app.thumbnails.get(&id) {
        Some(known) => known,
        None => {
            let catalogue = app.session().catalogue.clone();
            let source = library::source(&catalogue, &id)?;
            let shot = library::shot(&catalogue, source, &id);
            let encoding = PngEncoding::default();
            let drawn = draw(&app.thumbs, &format!("thumb {id}"), shot, encoding).await?;
            let bytes: Arc<[u8]> = drawn.bytes.into();
            app.thumbnails.set(id, Arc::clone(&bytes));
            bytes
        }
    };
    Ok(([(header::CONTENT_TYPE, "image/png")], bytes.to_vec()).into_response())
}

/// Request for a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Export {
    tab: String,
    path: String,
    width: u32,
    height: u32,
    #[serde(default)]
    replace: bool,
    #[serde(default)]
    plot: bool,
    /// Whether the film of the key frames is written.
    #[serde(default)]
    film: bool,
}

pub(super) async fn export(State(app): Shared, seen: Seen, Json(asked): Json<Export>) -> Answer {
    const MOST: u32 = 100_000;
    let size = [asked.width, asked.height];
    if !size.iter().all(|side| (1..=MOST).contains(side)) {
        return Err(Refusal::wrong(format!("a side has 1 to {MOST} pixels")));
    }
    let (shot, look, path) = {
        let session = app.session();
        session.check_file(seen)?;
        let path = session.roots.allowed(Path::new(&asked.path))?;
        let look = session.look.clone();
        (session.shot(&look, size, Quality::Full)?, look, path)
    };
    if path.exists() && !asked.replace {
        return Err(Refusal::conflict(format!("'{}' exists", path.display())));
    }
    let options: Vec<String> = asked.plot.then(|| "--plot".into()).into_iter().collect();
    let held = Arc::new(Held::new(MOST_BYTES, PngEncoding::default()));
    let (own, to) = (Arc::clone(&held), path.clone());
    let name = format!("export {}", asked.tab);
    let (summary, done) = {
        app.pictures.run(&name, held, move || match asked.film {
            true => shot.export_film(&look, &to, &own),
            false => shot.export(&to, &options, &own),
        })
    }
    .await?;
    Ok(Json(
        json!({ "path": path, "summary": summary, "notes": done.notes }),
    ))
}
