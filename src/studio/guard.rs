//! Requests that are answered: those of the page, from this machine, with the key.

use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::header::{HOST, HeaderValue, ORIGIN};
use axum::http::{HeaderMap, HeaderName, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::answer::Refusal;
use super::server::App;

/// Header that carries the key.
const KEY: &str = "x-kfrac-key";

/// Address and key of a server.
#[derive(Debug)]
pub(super) struct Guard {
    port: u16,
    /// Key in hexadecimal digits.
    key: String,
}

impl Guard {
    /// Makes a key for the server at a port.
    pub(super) fn new(port: u16) -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        let key = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { port, key })
    }

    /// Returns the address of the page. Browsers do not send the fragment.
    pub(super) fn url(&self) -> String {
        format!("http://127.0.0.1:{}/#{}", self.port, self.key)
    }

    /// Returns why a request is refused, if it is.
    fn refuse(&self, headers: &HeaderMap, needs_key: bool) -> Option<&'static str> {
        let names = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        let only = |header: HeaderName| {
            let mut all = headers.get_all(header).iter();
            (all.next(), all.next().is_some())
        };
        let is = |value: &HeaderValue, all: &[String]| {
            all.iter().any(|own| own.as_bytes() == value.as_bytes())
        };
        match only(HOST) {
            (Some(host), false) if is(host, &names) => {}
            _ => return Some("the host is not this studio"),
        }
        let origins = names.map(|name| format!("http://{name}"));
        match only(ORIGIN) {
            (None, _) => {}
            (Some(origin), false) if is(origin, &origins) => {}
            _ => return Some("the request comes from another page"),
        }
        let site = headers.get("sec-fetch-site");
        if site.is_some_and(|site| site == "cross-site" || site == "same-site") && needs_key {
            return Some("the request comes from another page");
        }
        let key = headers.get(KEY).map(HeaderValue::as_bytes);
        if needs_key && !key.is_some_and(|key| is_same(key, self.key.as_bytes())) {
            return Some("the key is missing or wrong: open the address that kfrac studio printed");
        }
        None
    }
}

/// Compares in a time that does not depend on the content.
fn is_same(a: &[u8], b: &[u8]) -> bool {
    let differs = a.iter().zip(b).fold(0, |differs, (a, b)| differs | (a ^ b));
    a.len() == b.len() && differs == 0
}

/// Headers of every answer.
const HEADERS: [(&str, &str); 6] = [
    (
        "content-security-policy",
        "default-src 'self'; img-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    ("x-content-type-options", "nosniff"),
    ("referrer-policy", "no-referrer"),
    ("cross-origin-resource-policy", "same-origin"),
    ("cross-origin-opener-policy", "same-origin"),
    ("cache-control", "no-store"),
];

/// Answers what may be answered, and adds the headers that confine the page.
pub(super) async fn guard(State(app): State<Arc<App>>, request: Request, next: Next) -> Response {
    let is_page = matches!(
        request.uri().path(),
        "/" | "/studio.css"
            | "/studio.js"
            | "/design.js"
            | "/underlay.js"
            | "/film.js"
            | "/icon.svg"
    );
    let mut response = match app.guard.refuse(request.headers(), !is_page) {
        Some(reason) => Refusal::new(StatusCode::FORBIDDEN, reason).into_response(),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in HEADERS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}
