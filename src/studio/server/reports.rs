//! Answers besides pictures: state, choices, numbers, entries, completions and events.

use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;

use axum::Json;
use axum::extract::{Query, State};
use axum::response::sse::{Event, KeepAlive, Sse};
use futures_util::stream::{self, Stream};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::cli::animate::Ease;
use crate::cli::held::Held;
use crate::fit::Method;
use crate::kind::Kind;
use crate::render::space::Shade;
use crate::style::{Cap, ColorBy, Join, Named, Palette, Tone};

use super::super::answer::Refusal;
use super::super::look::Look;
use super::super::numbers::Numbers;
use super::super::shots::Quality;
use super::super::{complete, library};
use super::{Answer, Shared, Tab, apart};

pub(super) async fn state(State(app): Shared) -> Json<Value> {
    Json(app.session().state())
}

/// Names and colours that controls offer.
pub(super) async fn choices() -> Json<Value> {
    fn names<T: Named>() -> Vec<&'static str> {
        T::NAMES.iter().map(|(name, _)| *name).collect()
    }
    const SAMPLES: u32 = 7;
    let palettes: Vec<_> = Palette::names()
        .filter_map(|name| {
            let palette = Palette::named(name).ok()?;
            let at = |number: u32| palette.at(f64::from(number) / f64::from(SAMPLES - 1));
            let colours: Vec<_> = (0..SAMPLES)
                .map(|number| format!("{:#}", at(number)))
                .collect();
            Some(json!({ "name": name, "colours": colours }))
        })
        .collect();
    let kinds = Kind::ALL.map(|kind| json!({ "name": kind.name(), "about": kind.full_name() }));
    Json(json!({
        "kinds": kinds,
        "palettes": palettes,
        "color-by": names::<ColorBy>(),
        "cap": names::<Cap>(),
        "join": names::<Join>(),
        "shade": names::<Shade>(),
        "tone": names::<Tone>(),
        "ease": names::<Ease>(),
        "methods": Method::ALL.map(Method::name),
    }))
}

pub(super) async fn numbers(State(app): Shared, Query(Tab { tab }): Query<Tab>) -> Answer {
    let (known, key, shot) = {
        let session = app.session();
        let look = Look {
            view: None,
            ..session.look.clone()
        };
        (
            session.known_numbers(),
            session.key(),
            session.shot(&look, [1024; 2], Quality::Full)?,
        )
    };
    let numbers = match known {
        Some(known) => known,
        None => {
            let held = Arc::new(Held::default());
            let name = format!("numbers {tab}");
            let computed = app
                .thumbs
                .run(&name, held, move || Numbers::of(&shot))
                .await?;
            let computed = Arc::new(computed);
            app.session().numbers = Some((key, Arc::clone(&computed)));
            computed
        }
    };
    let value = serde_json::to_value(&*numbers);
    value
        .map(Json)
        .map_err(|error| Refusal::wrong(error.to_string()))
}

pub(super) async fn entries(State(app): Shared) -> Answer {
    let catalogue = app.session().catalogue.clone();
    let listed = apart(move || json!({ "entries": library::entries(&catalogue) }));
    listed.await.map(Json)
}

#[derive(Deserialize)]
pub(super) struct Position {
    text: String,
    position: usize,
}

pub(super) async fn completions(Json(Position { text, position }): Json<Position>) -> Answer {
    let found = apart(move || json!({ "words": complete::complete(&text, position) }));
    found.await.map(Json)
}

/// Reports changes as they happen, each with the tab that has made it.
pub(super) async fn events(
    State(app): Shared,
) -> Sse<impl Stream<Item = Result<Event, Infallible>>> {
    let changes = app.changes.subscribe();
    let events = stream::unfold(changes, |mut changes| async {
        changes.changed().await.ok()?;
        let (count, tab) = changes.borrow_and_update().clone();
        let data = json!({ "change": count, "tab": tab }).to_string();
        Some((Ok(Event::default().data(data)), changes))
    });
    Sse::new(events).keep_alive(KeepAlive::new().interval(Duration::from_secs(30)))
}
