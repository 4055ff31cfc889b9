//! The server: routes, and the answers to them.

use std::convert::Infallible;
use std::io;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::extract::{DefaultBodyLimit, Query, State};
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post, put};
use axum::{Json, Router, middleware};
use futures_util::stream::{self, Stream};
use serde::Deserialize;
use serde_json::{Value, json};
use tokio::sync::watch;

use crate::cli::held::Held;
use crate::cli::watch::Watch;
use crate::diagnostic::Source;
use crate::render::Tone;
use crate::render::space::Shade;
use crate::style::{Cap, ColorBy, Join, Named, Palette};

use super::answer::Refusal;
use super::complete;
use super::drawing::{Drawn, MOST_BYTES, MOST_PIXELS, Shot};
use super::guard::{self, Guard};
use super::jobs::Jobs;
use super::library::{self, Thumbnails};
use super::look::Look;
use super::numbers::Numbers;
use super::session::Session;
use super::vary;
use super::view::Gesture;

/// Everything that requests share.
pub(super) struct App {
    pub(super) guard: Guard,
    session: Mutex<Session>,
    pictures: Jobs,
    thumbs: Jobs,
    thumbnails: Thumbnails,
    /// Number of changes, with the tab that has made the last one.
    changes: watch::Sender<(u64, String)>,
    /// Wakes the thread that watches files.
    nudge: Mutex<Option<Box<dyn Fn() + Send>>>,
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App")
            .field("guard", &self.guard)
            .finish_non_exhaustive()
    }
}

type Shared = State<Arc<App>>;
type Answer = Result<Json<Value>, Refusal>;

impl App {
    pub(super) fn new(session: Session, guard: Guard) -> Self {
        Self {
            guard,
            session: Mutex::new(session),
            pictures: Jobs::default(),
            thumbs: Jobs::default(),
            thumbnails: Thumbnails::default(),
            changes: watch::Sender::new((0, String::new())),
            nudge: Mutex::default(),
        }
    }

    fn session(&self) -> MutexGuard<'_, Session> {
        self.session.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reports a change to all tabs but the one that has made it.
    fn announce(&self, tab: &str) {
        self.changes.send_modify(|(count, by)| {
            *count += 1;
            tab.clone_into(by);
        });
    }

    /// Reads and changes the session on a thread that may take its time, and returns the state after it.
    async fn change(
        self: &Arc<Self>,
        tab: String,
        change: impl FnOnce(&mut Session) -> Result<(), Refusal> + Send + 'static,
    ) -> Answer {
        let app = Arc::clone(self);
        let changed = tokio::task::spawn_blocking(move || {
            let mut session = app.session();
            change(&mut session)?;
            let state = session.state();
            drop(session);
            app.announce(&tab);
            if let Some(nudge) = &*app.nudge.lock().unwrap_or_else(PoisonError::into_inner) {
                nudge();
            }
            Ok(Json(state))
        });
        changed.await.map_err(|error| {
            Refusal::new(
                StatusCode::INTERNAL_SERVER_ERROR,
                format!("the work has failed: {error}"),
            )
        })?
    }

    /// Follows changes of the file by other programs.
    fn follow(self: Arc<Self>) {
        let Ok(mut watch) = Watch::new() else {
            return;
        };
        *self.nudge.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(watch.nudge()));
        loop {
            let files = self.session().watched();
            // A folder that cannot be watched has no news.
            let _ = watch.set(files.iter().map(PathBuf::as_path));
            if watch.wait(Duration::from_secs(86_400)) && self.session().reread() {
                self.announce("");
            }
        }
    }
}

/// Answers requests until the process ends.
pub(super) fn serve(listener: TcpListener, app: Arc<App>) -> io::Result<()> {
    let follower = Arc::clone(&app);
    std::thread::Builder::new()
        .name("watch".into())
        .spawn(move || follower.follow())?;
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .max_blocking_threads(16)
        .build()?;
    runtime.block_on(async {
        listener.set_nonblocking(true)?;
        let listener = tokio::net::TcpListener::from_std(listener)?;
        axum::serve(listener, router(app)).await
    })
}

fn router(app: Arc<App>) -> Router {
    const SPARE: usize = 64 << 10;
    let text = |kind: &'static str, text: &'static str| {
        get(move || async move { ([(header::CONTENT_TYPE, kind)], text) })
    };
    Router::new()
        .route(
            "/",
            text("text/html; charset=utf-8", include_str!("page/studio.html")),
        )
        .route(
            "/studio.css",
            text("text/css; charset=utf-8", include_str!("page/studio.css")),
        )
        .route(
            "/studio.js",
            text(
                "text/javascript; charset=utf-8",
                include_str!("page/studio.js"),
            ),
        )
        .route(
            "/icon.svg",
            text("image/svg+xml", include_str!("page/icon.svg")),
        )
        .route("/state", get(state))
        .route("/choices", get(choices))
        .route("/text", put(set_text))
        .route("/undo", post(undo))
        .route("/redo", post(redo))
        .route("/settle", post(settle))
        .route("/picture", post(picture))
        .route("/preview", post(preview))
        .route("/numbers", get(numbers))
        .route("/vary", post(vary_all))
        .route("/take", post(take))
        .route("/library", get(entries))
        .route("/thumb", get(thumb))
        .route("/open", post(open))
        .route("/save", post(save))
        .route("/export", post(export))
        .route("/complete", post(completions))
        .route("/events", get(events))
        .layer(DefaultBodyLimit::max(Source::MAX_BYTES + SPARE))
        .layer(middleware::from_fn_with_state(
            Arc::clone(&app),
            guard::guard,
        ))
        .with_state(app)
}

async fn state(State(app): Shared) -> Json<Value> {
    Json(app.session().state())
}

/// Names and colours that controls offer.
async fn choices() -> Json<Value> {
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
    Json(json!({
        "palettes": palettes,
        "color-by": names::<ColorBy>(),
        "cap": names::<Cap>(),
        "join": names::<Join>(),
        "shade": names::<Shade>(),
        "tone": names::<Tone>(),
    }))
}

#[derive(Deserialize)]
struct TextQuery {
    revision: u64,
    #[serde(default)]
    tab: String,
}

async fn set_text(State(app): Shared, Query(query): Query<TextQuery>, body: Bytes) -> Answer {
    let text = String::from_utf8(body.into());
    let text = text.map_err(|_| Refusal::wrong("the text is not UTF-8"))?;
    let reader = app.session().reader();
    let checked = tokio::task::spawn_blocking(move || reader.check(text.into()));
    let checked = checked
        .await
        .map_err(|error| Refusal::wrong(error.to_string()))?;
    app.change(query.tab, move |session| {
        session.set_text(checked, query.revision)
    })
    .await
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct Tab {
    tab: String,
}

async fn undo(State(app): Shared, Json(Tab { tab }): Json<Tab>) -> Answer {
    app.change(tab, |session| {
        session.travel(true);
        Ok(())
    })
    .await
}

async fn redo(State(app): Shared, Json(Tab { tab }): Json<Tab>) -> Answer {
    app.change(tab, |session| {
        session.travel(false);
        Ok(())
    })
    .await
}

#[derive(Deserialize)]
struct Settle {
    #[serde(default)]
    tab: String,
    theirs: bool,
}

async fn settle(State(app): Shared, Json(Settle { tab, theirs }): Json<Settle>) -> Answer {
    app.change(tab, move |session| {
        session.settle(theirs);
        Ok(())
    })
    .await
}

/// Request for a picture.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Picture {
    tab: String,
    width: u32,
    height: u32,
    /// Whether it is one of many while a hand moves.
    #[serde(default)]
    fast: bool,
    look: Option<Look>,
    gesture: Option<Gesture>,
    /// Member near the present one to draw, of a preview.
    variant: Option<usize>,
}

impl Picture {
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
async fn picture(State(app): Shared, Json(asked): Json<Picture>) -> Result<Response, Refusal> {
    let size = asked.size()?;
    let (shot, look) = {
        let mut session = app.session();
        let before = session.look.clone();
        if let Some(look) = asked.look.clone() {
            look.check()?;
            session.look = look;
        }
        if let Some(gesture) = &asked.gesture {
            session.gesture(gesture)?;
        }
        let look = session.look.clone();
        if let Err(refusal) = session.check_size(&look) {
            session.look = before;
            return Err(refusal);
        }
        if look != before {
            app.announce(&asked.tab);
        }
        (session.shot(&look, size)?, look)
    };
    let drawn = draw(&app.pictures, &asked.tab, shot, asked.fast).await?;
    let mut session = app.session();
    if session.look == look {
        session.window = drawn.window;
    }
    let extra = json!({ "look": session.look, "factor": session.look.view.as_ref().map(super::view::View::factor) });
    drop(session);
    answered(drawn, &extra)
}

/// Draws a small picture of another look, which the session does not take.
async fn preview(State(app): Shared, Json(asked): Json<Picture>) -> Result<Response, Refusal> {
    let size = asked.size()?;
    let shot = {
        let session = app.session();
        let mut look = asked.look.clone().unwrap_or_else(|| session.look.clone());
        match asked.variant {
            None => session.shot(&look, size)?,
            Some(number) => {
                let Some(variant) = session.variants.get(number) else {
                    return Err(Refusal::wrong("there is no such member"));
                };
                look.set.clone_from(&variant.set);
                let source = session.reader().source(&variant.text);
                session.shot_of(session.good()?, &source, &look, size)?
            }
        }
    };
    answered(
        draw(&app.thumbs, &asked.tab, shot, true).await?,
        &Value::Null,
    )
}

async fn draw(jobs: &Jobs, tab: &str, shot: Shot, is_fast: bool) -> Result<Drawn, Refusal> {
    let held = Arc::new(Held::new(MOST_BYTES, is_fast));
    let own = Arc::clone(&held);
    jobs.run(tab, held, move || shot.draw(&own)).await
}

/// Answers with a picture, and with its numbers in a header.
fn answered(drawn: Drawn, extra: &Value) -> Result<Response, Refusal> {
    let mut numbers = serde_json::to_value(&drawn).unwrap_or_default();
    numbers["session"] = extra.clone();
    let numbers = HeaderValue::from_str(&ascii(&numbers.to_string()));
    let numbers = numbers.map_err(|error| Refusal::wrong(error.to_string()))?;
    let mut response = Response::new(Body::from(drawn.bytes));
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("image/png"));
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

async fn numbers(State(app): Shared, Query(Tab { tab }): Query<Tab>) -> Answer {
    let (known, key, shot) = {
        let session = app.session();
        let look = Look {
            view: None,
            ..session.look.clone()
        };
        (
            session.known_numbers(),
            session.key(),
            session.shot(&look, [1024; 2])?,
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

#[derive(Deserialize)]
struct Vary {
    seed: u32,
}

/// Number of members beside the present one.
const AROUND: u64 = 8;

async fn vary_all(State(app): Shared, Json(Vary { seed }): Json<Vary>) -> Answer {
    let mut session = app.session();
    let good = session.good()?.clone();
    let seeds = (0..AROUND).map(|number| u64::from(seed) * AROUND + number);
    let set = session.look.set.clone();
    let all = seeds.filter_map(|seed| vary::variant(&good.source, &good.parameters, &set, seed));
    session.variants = all.collect();
    if session.variants.is_empty() {
        return Err(Refusal::wrong(
            "there is no number to vary: only whole ones",
        ));
    }
    Ok(Json(json!({ "variants": session.variants })))
}

#[derive(Deserialize)]
struct Take {
    #[serde(default)]
    tab: String,
    variant: usize,
}

async fn take(State(app): Shared, Json(Take { tab, variant }): Json<Take>) -> Answer {
    app.change(tab, move |session| {
        let Some(variant) = session.variants.get(variant).cloned() else {
            return Err(Refusal::wrong("there is no such member"));
        };
        session.look.set = variant.set;
        let checked = session.reader().check(variant.text);
        let revision = session.revision;
        session.set_text(checked, revision)
    })
    .await
}

async fn entries(State(app): Shared) -> Answer {
    let catalogue = app.session().catalogue.clone();
    let listed =
        tokio::task::spawn_blocking(move || json!({ "entries": library::entries(&catalogue) }));
    listed
        .await
        .map(Json)
        .map_err(|error| Refusal::wrong(error.to_string()))
}

#[derive(Deserialize)]
struct Id {
    id: String,
}

async fn thumb(State(app): Shared, Query(Id { id }): Query<Id>) -> Result<Response, Refusal> {
    let bytes = match app.thumbnails.get(&id) {
        Some(known) => known,
        None => {
            let catalogue = app.session().catalogue.clone();
            let source = library::source(&catalogue, &id)?;
            let shot = library::shot(&catalogue, source, &id);
            let drawn = draw(&app.thumbs, &format!("thumb {id}"), shot, false).await?;
            let bytes: Arc<[u8]> = drawn.bytes.into();
            app.thumbnails.set(id, Arc::clone(&bytes));
            bytes
        }
    };
    Ok(([(header::CONTENT_TYPE, "image/png")], bytes.to_vec()).into_response())
}

#[derive(Deserialize)]
struct Open {
    #[serde(default)]
    tab: String,
    id: String,
}

async fn open(State(app): Shared, Json(Open { tab, id }): Json<Open>) -> Answer {
    app.change(tab, move |session| {
        let source = library::source(&session.catalogue.clone(), &id)?;
        let name = id.rsplit('/').next().unwrap_or(&id);
        session.copy(name, &source);
        Ok(())
    })
    .await
}

#[derive(Deserialize)]
struct Save {
    #[serde(default)]
    tab: String,
    path: Option<String>,
    #[serde(default)]
    replace: bool,
    /// Whether it is saved in the person's library.
    #[serde(default)]
    library: bool,
}

async fn save(State(app): Shared, Json(asked): Json<Save>) -> Answer {
    let Save {
        tab,
        path,
        replace,
        library,
    } = asked;
    app.change(tab, move |session| {
        let path = match (library, path) {
            (false, path) => path,
            (true, Some(name)) => {
                let path = session.roots.in_library(&name, session.kind())?;
                Some(path.to_string_lossy().into_owned())
            }
            (true, None) => return Err(Refusal::wrong("a rule of the library has a name")),
        };
        session.save(path.as_deref(), replace).map(|_| ())
    })
    .await
}

/// Request for a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Export {
    tab: String,
    path: String,
    width: u32,
    height: u32,
    #[serde(default)]
    replace: bool,
    #[serde(default)]
    plot: bool,
}

async fn export(State(app): Shared, Json(asked): Json<Export>) -> Answer {
    const MOST: u32 = 100_000;
    let size = [asked.width, asked.height];
    if !size.iter().all(|side| (1..=MOST).contains(side)) {
        return Err(Refusal::wrong(format!("a side has 1 to {MOST} pixels")));
    }
    let (shot, path) = {
        let session = app.session();
        let path = session.roots.allowed(Path::new(&asked.path))?;
        (session.shot(&session.look, size)?, path)
    };
    if path.exists() && !asked.replace {
        return Err(Refusal::conflict(format!("'{}' exists", path.display())));
    }
    let options: Vec<String> = asked.plot.then(|| "--plot".into()).into_iter().collect();
    let held = Arc::new(Held::new(MOST_BYTES, false));
    let (own, to) = (Arc::clone(&held), path.clone());
    let name = format!("export {}", asked.tab);
    let (summary, done) = {
        app.pictures
            .run(&name, held, move || shot.export(&to, &options, &own))
    }
    .await?;
    Ok(Json(
        json!({ "path": path, "summary": summary, "notes": done.notes }),
    ))
}

#[derive(Deserialize)]
struct Position {
    text: String,
    position: usize,
}

async fn completions(Json(Position { text, position }): Json<Position>) -> Answer {
    let found = tokio::task::spawn_blocking(
        move || json!({ "words": complete::complete(&text, position) }),
    );
    found
        .await
        .map(Json)
        .map_err(|error| Refusal::wrong(error.to_string()))
}

/// Reports changes as they happen, each with the tab that has made it.
async fn events(State(app): Shared) -> Sse<impl Stream<Item = Result<Event, Infallible>>> {
    let changes = app.changes.subscribe();
    let events = stream::unfold(changes, |mut changes| async {
        changes.changed().await.ok()?;
        let (count, tab) = changes.borrow_and_update().clone();
        let data = json!({ "change": count, "tab": tab }).to_string();
        Some((Ok(Event::default().data(data)), changes))
    });
    Sse::new(events).keep_alive(KeepAlive::new().interval(Duration::from_secs(30)))
}
