//! The server: routes, and the answers to them.

mod changes;
mod design;
mod pictures;
mod reports;
mod underlay;

use std::convert::Infallible;
use std::io;
use std::net::TcpListener;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use axum::extract::{DefaultBodyLimit, FromRequestParts, State};
use axum::http::request::Parts;
use axum::http::{StatusCode, header};
use axum::routing::{get, post, put};
use axum::{Json, Router, middleware};
use serde::Deserialize;
use serde_json::Value;
use tokio::sync::watch;

use crate::cli::watch::Watch;
use crate::diagnostic::Source;

use super::answer::Refusal;
use super::guard::{self, Guard};
use super::jobs::Jobs;
use super::library::Thumbnails;
use super::session::Session;
use super::underlay::MOST_BYTES;
use underlay::Fits;

/// Everything that requests share.
pub(super) struct App {
    pub(super) guard: Guard,
    session: Mutex<Session>,
    pictures: Jobs,
    thumbs: Jobs,
    fits: Fits,
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

/// Tab of the browser that asks.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Tab {
    tab: String,
}

/// File that a request is about: `file` of the state that the page shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen(pub(super) Option<u64>);

impl<S: Sync> FromRequestParts<S> for Seen {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        let file = parts.headers.get("x-kfrac-file");
        let file = file.and_then(|file| file.to_str().ok()?.parse().ok());
        Ok(Self(file))
    }
}

/// Runs work that may take its time on a thread of its own.
async fn apart<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Result<T, Refusal> {
    let done = tokio::task::spawn_blocking(work).await;
    done.map_err(|error| {
        let message = format!("the work has failed: {error}");
        Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, message)
    })
}

impl App {
    pub(super) fn new(session: Session, guard: Guard) -> Self {
        Self {
            guard,
            session: Mutex::new(session),
            pictures: Jobs::default(),
            thumbs: Jobs::default(),
            fits: Fits::default(),
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
        apart(move || {
            let mut session = app.session();
            change(&mut session)?;
            let state = session.state();
            drop(session);
            app.announce(&tab);
            if let Some(nudge) = &*app.nudge.lock().unwrap_or_else(PoisonError::into_inner) {
                nudge();
            }
            Ok(Json(state))
        })
        .await?
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
            "/film.js",
            text(
                "text/javascript; charset=utf-8",
                include_str!("page/film.js"),
            ),
        )
        .route(
            "/underlay.js",
            text(
                "text/javascript; charset=utf-8",
                include_str!("page/underlay.js"),
            ),
        )
        .route(
            "/design.js",
            text(
                "text/javascript; charset=utf-8",
                include_str!("page/design.js"),
            ),
        )
        .route("/pointer", post(design::pointer))
        .route("/edit", post(design::act))
        .route("/design/view", post(design::view))
        .route(
            "/icon.svg",
            text("image/svg+xml", include_str!("page/icon.svg")),
        )
        .route("/state", get(reports::state))
        .route("/choices", get(reports::choices))
        .route("/text", put(changes::set_text))
        .route("/undo", post(changes::undo))
        .route("/redo", post(changes::redo))
        .route("/settle", post(changes::settle))
        .route("/picture", post(pictures::picture))
        .route("/preview", post(pictures::preview))
        .route("/map", post(pictures::map))
        .route("/figure", get(pictures::figure))
        .route("/film", post(pictures::film))
        .route("/numbers", get(reports::numbers))
        .route("/vary", post(changes::vary_all))
        .route("/take", post(changes::take))
        .route("/write", post(changes::write_value))
        .route("/library", get(reports::entries))
        .route("/thumb", get(pictures::thumb))
        .route("/open", post(changes::open))
        .route("/new", post(changes::begin))
        .route("/save", post(changes::save))
        .route("/component", post(changes::component))
        .route("/export", post(pictures::export))
        .route(
            "/underlay",
            put(underlay::set)
                .layer(DefaultBodyLimit::max(MOST_BYTES))
                .get(underlay::picture)
                .delete(underlay::remove),
        )
        .route("/underlay/place", post(underlay::put))
        .route("/underlay/collage", get(underlay::collage))
        .route(
            "/fit",
            post(underlay::fit)
                .get(underlay::progress)
                .delete(underlay::stop),
        )
        .route("/fit/open", post(underlay::open))
        .route("/complete", post(reports::completions))
        .route("/events", get(reports::events))
        .layer(DefaultBodyLimit::max(Source::MAX_BYTES + SPARE))
        .layer(middleware::from_fn_with_state(
            Arc::clone(&app),
            guard::guard,
        ))
        .with_state(app)
}
