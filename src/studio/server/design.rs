//! Gestures of the design.

use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use serde_json::Value;

use super::super::answer::Refusal;
use super::super::design::{self, Act, Pointer};
use super::{Answer, Seen, Shared};

/// An event of a pointer, from a tab.
#[derive(Deserialize)]
pub(super) struct Event {
    #[serde(default)]
    tab: String,
    pointer: Pointer,
    /// Revision of the text on which it is based.
    revision: Option<u64>,
}

pub(super) async fn pointer(State(app): Shared, seen: Seen, Json(event): Json<Event>) -> Answer {
    let at = std::sync::Arc::new(std::sync::Mutex::new(None));
    let own = std::sync::Arc::clone(&at);
    let answer = app.change(event.tab, move |session| {
        session.check_file(seen)?;
        check(session.revision, event.revision)?;
        let place = design::pointer(session, &event.pointer)?;
        *own.lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner) = place;
        Ok(())
    });
    let Json(mut state) = answer.await?;
    let place = at
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
        .take();
    if let (Some(place), Value::Object(state)) = (place, &mut state) {
        state.insert("place".into(), serde_json::json!(place));
    }
    Ok(Json(state))
}

fn check(now: u64, asked: Option<u64>) -> Result<(), Refusal> {
    match asked.is_none_or(|asked| asked == now) {
        true => Ok(()),
        false => Err(Refusal::changed()),
    }
}

/// View of figures in space, from a tab.
#[derive(Deserialize)]
pub(super) struct Viewed {
    #[serde(default)]
    tab: String,
    view: design::View,
}

pub(super) async fn view(State(app): Shared, Json(Viewed { tab, view }): Json<Viewed>) -> Answer {
    app.change(tab, move |session| {
        session.drop_draft();
        session.hand.view = view;
        Ok(())
    })
    .await
}

/// A gesture, from a tab.
#[derive(Deserialize)]
pub(super) struct Gesture {
    #[serde(default)]
    tab: String,
    gesture: Act,
    revision: Option<u64>,
}

pub(super) async fn act(State(app): Shared, seen: Seen, Json(asked): Json<Gesture>) -> Answer {
    app.change(asked.tab, move |session| {
        session.check_file(seen)?;
        check(session.revision, asked.revision)?;
        session.act(&asked.gesture)
    })
    .await
}
