//! Requests for the picture under the design, and for fits.

use std::num::NonZero;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Query, State};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde_json::json;

use crate::cli::held::Held;
use crate::diagnostic::Source;
use crate::fit::{FitOptions, FitProgress, Method};
use crate::parallel::all_cores;

use super::super::answer::Refusal;
use super::super::jobs::Jobs;
use super::super::underlay::Underlay;
use super::{Answer, Shared, Tab, apart};

/// Fits, of which one runs at a time.
#[derive(Debug)]
pub(super) struct Fits {
    jobs: Jobs,
    now: Mutex<Option<Running>>,
    /// Last one that ended, until it is opened.
    found: Mutex<Option<Found>>,
}

/// A fit that runs.
#[derive(Clone, Debug)]
struct Running {
    progress: Arc<FitProgress>,
    /// Flag that ends the search with the best system so far.
    stop: Arc<AtomicBool>,
}

/// A fitted system.
#[derive(Debug)]
struct Found {
    /// Tab that asked for it.
    tab: String,
    underlay: Underlay,
    text: String,
}

impl Default for Fits {
    fn default() -> Self {
        const LIMIT: Duration = Duration::from_secs(600);
        Self {
            jobs: Jobs::within(LIMIT),
            now: Mutex::default(),
            found: Mutex::default(),
        }
    }
}

impl Fits {
    fn running(&self) -> Option<Running> {
        let now = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        now.clone()
    }

    fn found(&self) -> MutexGuard<'_, Option<Found>> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes a fit that begins.
    fn begin(&self, running: &Running) -> Noted<'_> {
        let mut now = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        *now = Some(running.clone());
        Noted {
            fits: self,
            progress: Arc::clone(&running.progress),
        }
    }
}

/// A fit that is noted until this is dropped, as when a browser closes the connection.
struct Noted<'a> {
    fits: &'a Fits,
    progress: Arc<FitProgress>,
}

impl Drop for Noted<'_> {
    fn drop(&mut self) {
        let mut now = { self.fits.now.lock() }.unwrap_or_else(PoisonError::into_inner);
        if { now.as_ref() }.is_some_and(|it| Arc::ptr_eq(&it.progress, &self.progress)) {
            *now = None;
        }
    }
}

#[derive(Deserialize)]
pub(super) struct Named {
    #[serde(default)]
    tab: String,
    name: String,
}

/// Lays a picture under the figures.
pub(super) async fn set(
    State(app): Shared,
    Query(Named { tab, name }): Query<Named>,
    bytes: Bytes,
) -> Answer {
    const LONG: usize = 200;
    let name: String = name.chars().take(LONG).collect();
    let good = app.session().good().ok().cloned();
    let read = apart(move || Underlay::read(&name, &bytes, good.as_ref())).await?;
    let underlay = read?;
    app.change(tab, move |session| {
        session.underlay = Some(underlay);
        Ok(())
    })
    .await
}

#[derive(Deserialize)]
pub(super) struct Part {
    /// Whether the pixels of its shape are shown alone.
    #[serde(default)]
    ink: bool,
}

pub(super) async fn picture(
    State(app): Shared,
    Query(Part { ink }): Query<Part>,
) -> Result<Response, Refusal> {
    let underlay = known(app.session().underlay.as_ref())?;
    let (bytes, kind) = match ink {
        true => (apart(move || underlay.ink()).await??, "image/png"),
        false => underlay.shown,
    };
    Ok(([(header::CONTENT_TYPE, kind)], bytes.to_vec()).into_response())
}

fn known(underlay: Option<&Underlay>) -> Result<Underlay, Refusal> {
    let none = || Refusal::wrong("there is no picture: choose one, or drop it on the page");
    underlay.cloned().ok_or_else(none)
}

pub(super) async fn remove(State(app): Shared, Query(Tab { tab }): Query<Tab>) -> Answer {
    app.change(tab, |session| {
        session.underlay = None;
        Ok(())
    })
    .await
}

/// Place of the picture in the plane.
#[derive(Deserialize)]
pub(super) struct Put {
    #[serde(default)]
    tab: String,
    corner: [f64; 2],
    width: f64,
}

pub(super) async fn put(State(app): Shared, Json(asked): Json<Put>) -> Answer {
    app.change(asked.tab, move |session| match &mut session.underlay {
        Some(underlay) => underlay.put(asked.corner, asked.width),
        None => known(None).map(|_| ()),
    })
    .await
}

/// Measures the collage of the picture by the maps of the system.
pub(super) async fn collage(State(app): Shared, Query(Tab { tab }): Query<Tab>) -> Answer {
    let collage = {
        let session = app.session();
        let underlay = known(session.underlay.as_ref())?;
        underlay.collage(session.good()?, &session.look)
    };
    let Some(collage) = collage else {
        return Ok(Json(json!({})));
    };
    let name = format!("collage {tab}");
    let held = Arc::new(Held::default());
    let measured = app.thumbs.run(&name, held, move || Ok(collage.measured()));
    Ok(Json(measured.await?))
}

/// Request for a fit.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Fitted {
    #[serde(default)]
    tab: String,
    /// Least and largest number of maps.
    maps: [usize; 2],
    method: String,
    #[serde(default)]
    similar: bool,
    #[serde(default)]
    disks: usize,
}

/// Fits a system to the picture. It is kept until the page [opens](open) it, which may have a text to send before.
pub(super) async fn fit(State(app): Shared, Json(asked): Json<Fitted>) -> Answer {
    const MOST_DISKS: usize = 32;
    let named = Method::ALL.into_iter().find(|it| it.name() == asked.method);
    let method = named.ok_or_else(|| Refusal::wrong("there is no such method of fitting"))?;
    if asked.disks > MOST_DISKS {
        let message = format!("a fit has up to {MOST_DISKS} disks");
        return Err(Refusal::wrong(message));
    }
    let underlay = known(app.session().underlay.as_ref())?;
    let shape = Arc::clone(&underlay.shape()?.silhouette);
    let running = Running {
        progress: Arc::default(),
        stop: Arc::default(),
    };
    let held = Arc::new(Held::default());
    let [least, most] = asked.maps;
    // A core stays for pictures while the fit runs.
    let threads = NonZero::new(all_cores().get() - 1).unwrap_or(NonZero::<usize>::MIN);
    let options = FitOptions::default()
        .threads(threads)
        .maps(least..=most)
        .method(method)
        .similar(asked.similar)
        .disks(asked.disks)
        .progress(Some(Arc::clone(&running.progress)))
        .stop(Some(Arc::clone(&running.stop)))
        .cancel(Some(Arc::clone(&held.cancel)));
    let noted = app.fits.begin(&running);
    let name = underlay.name().to_owned();
    let found = app.fits.jobs.run("fit", held, move || {
        let fit = crate::fit(&shape, &options);
        let fit = fit.map_err(|error| Refusal::wrong(error.to_string()))?;
        Ok(fit.yaml(&shape, &name))
    });
    let text = found.await?;
    drop(noted);
    *app.fits.found() = Some(Found {
        tab: asked.tab,
        underlay,
        text,
    });
    Ok(Json(json!({})))
}

/// Opens the system that was fitted last as a copy that is not saved.
pub(super) async fn open(State(app): Shared, Json(Tab { tab }): Json<Tab>) -> Answer {
    let found = app.fits.found().take_if(|found| found.tab == tab);
    let Found { underlay, text, .. } = found.ok_or_else(Refusal::replaced)?;
    app.change(tab, move |session| {
        let stem = underlay.stem();
        session.copy(stem, &Source::new(format!("{stem}.yaml"), text));
        let good = session.good()?.clone();
        // Another picture may have been laid meanwhile.
        if let Some(laid) = &mut session.underlay
            && laid.is(&underlay)
        {
            laid.align(&good);
        }
        Ok(())
    })
    .await
}

/// Reports the best system so far of the fit that runs.
pub(super) async fn progress(State(app): Shared) -> Answer {
    let running = app.fits.running();
    let best = running.as_ref().and_then(|it| it.progress.best());
    Ok(Json(json!({
        "evaluated": running.map(|it| it.progress.evaluated()),
        "best": best.map(|best| json!({
            "maps": best.maps,
            "disks": best.disks,
            "method": best.method.name(),
            "iou": best.iou,
        })),
    })))
}

/// Ends the fit that runs with the best system so far.
pub(super) async fn stop(State(app): Shared) -> Answer {
    if let Some(running) = app.fits.running() {
        running.stop.store(true, Ordering::Relaxed);
    }
    Ok(Json(json!({})))
}
