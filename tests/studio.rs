//! The studio: its server in this process, with requests as a page sends them, and as an attacker would.

mod design;
mod space;
mod underlay;

use std::collections::BTreeMap;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use kfrac::catalogue::Catalogue;
use kfrac::studio::{Studio, StudioOptions};
use serde_json::{Value, json};
use tempfile::TempDir;

/// A studio that is served, with the folder of its rule.
struct Page {
    folder: TempDir,
    port: u16,
    key: String,
}

/// Answer to a request.
struct Reply {
    status: u16,
    headers: BTreeMap<String, String>,
    body: Vec<u8>,
}

impl Reply {
    fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or(Value::Null)
    }

    fn error(&self) -> String {
        self.json()["error"].as_str().unwrap_or_default().to_owned()
    }

    /// Returns the numbers of a picture.
    fn picture(&self) -> Value {
        assert_eq!(self.status, 200, "{}", self.error());
        serde_json::from_str(&self.headers["x-kfrac-picture"]).unwrap()
    }
}

const TREE: &str = "\
title: Tree # as it grows
params:
  angle: {value: 40, min: 10, max: 80}
initiator: segment
generator:
  elements:
    - {from: [0, 0], to: [1, 0], fertile: false}
    - {from: [1, 0], to: [1 + 0.6 * cos(angle), 0.6 * sin(angle)]}
    - {from: [1, 0], to: [1 + 0.6 * cos(angle), -0.6 * sin(angle)]}
";

const KOCH: &str = "\
initiator: segment
generator: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]
";

impl Page {
    /// Serves a text as `rule.yaml` in a folder of its own.
    fn of(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rule.yaml");
        fs::write(&path, text).unwrap();
        Self::serve(folder, StudioOptions::default().rule(Some(path)))
    }

    /// Serves an entry of the library.
    fn named(name: &str) -> Self {
        let options = StudioOptions::default().rule(Some(name.into()));
        Self::serve(tempfile::tempdir().unwrap(), options)
    }

    fn serve(folder: TempDir, options: StudioOptions) -> Self {
        let library = folder.path().join("library");
        let options = options
            .catalogue(Catalogue::with_folders(vec![library.clone()]))
            .library(Some(library));
        let studio = Studio::bind(options).unwrap();
        let url = studio.url();
        let (address, key) = url.split_once("/#").unwrap();
        let port = address.rsplit_once(':').unwrap().1.parse().unwrap();
        thread::spawn(move || studio.serve());
        let key = key.to_owned();
        Self { folder, port, key }
    }

    /// Sends a request with exactly these headers.
    fn send(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Reply {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(120)))
            .unwrap();
        let mut head = format!("{method} {path} HTTP/1.1\r\nconnection: close\r\n");
        for (name, value) in headers {
            head += &format!("{name}: {value}\r\n");
        }
        head += &format!("content-length: {}\r\n\r\n", body.len());
        stream.write_all(head.as_bytes()).unwrap();
        // A body that is too long is answered before it has been read.
        let _ = stream.write_all(body);
        let mut bytes = Vec::new();
        let _ = stream.read_to_end(&mut bytes);
        let end = bytes.windows(4).position(|it| it == b"\r\n\r\n").unwrap();
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        let lines = head.lines().filter_map(|line| line.split_once(": "));
        Reply {
            status,
            headers: lines
                .map(|(name, value)| (name.to_lowercase(), value.to_owned()))
                .collect(),
            body: bytes[end + 4..].to_vec(),
        }
    }

    fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// Sends a request as the page does before it knows a file.
    fn call(&self, method: &str, path: &str, body: &Value) -> Reply {
        self.call_about("", method, path, body)
    }

    /// Sends a request about a file as the page does.
    fn call_about(&self, file: &str, method: &str, path: &str, body: &Value) -> Reply {
        let text = match body {
            Value::Null => String::new(),
            Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        let host = self.host();
        let origin = format!("http://{host}");
        let headers = [
            ("host", host.as_str()),
            ("origin", &origin),
            ("sec-fetch-site", "same-origin"),
            ("x-kfrac-key", &self.key),
            ("x-kfrac-file", file),
            ("content-type", "application/json"),
        ];
        self.send(method, path, &headers, text.as_bytes())
    }

    fn state(&self) -> Value {
        self.call("GET", "/state", &Value::Null).json()
    }

    fn put(&self, text: &str) -> Reply {
        let path = format!("/text?revision={}", self.state()["revision"]);
        self.call("PUT", &path, &text.into())
    }

    fn draw(&self, more: Value) -> Reply {
        let mut asked = json!({ "tab": "a", "width": 300, "height": 200 });
        asked
            .as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        self.call("POST", "/picture", &asked)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.folder.path().join(name)).unwrap()
    }
}

/// Waits until a condition holds.
fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_secs(20), "never: {what}");
        thread::sleep(Duration::from_millis(20));
    }
}

/// Runs the command that a picture shows, in a folder, and returns the file that it writes.
fn run(command: &str, folder: &Path) -> Vec<u8> {
    let program = assert_cmd::cargo::cargo_bin("kfrac");
    let rest = command.strip_prefix("kfrac ").unwrap();
    let line = format!("'{}' {rest}", program.display());
    let output = Command::new("sh")
        .arg("-c")
        .arg(line)
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{command}: {output:?}");
    let name = rest.rsplit_once("--output=").unwrap().1;
    fs::read(folder.join(name)).unwrap()
}

#[test]
fn a_picture_is_the_file_that_its_command_writes() {
    let views = |look: &mut Value| look["steps"] = 4.into();
    let plane = Page::of(TREE);
    assert_eq!(plane.call("GET", "/numbers", &Value::Null).status, 200);
    let mut look = plane.state()["look"].clone();
    for change in 0..6 {
        match change {
            1 => look["set"] = json!({ "angle": "180/7" }),
            2 => {
                look["options"] = json!({ "stroke": "teal", "stroke-width": "3", "color-by": "step", "palette": "fire", "background": "#fffefa" })
            }
            3 => views(&mut look),
            4 => look["detail"] = 2.into(),
            5 => look["seed"] = "18446744073709551615".into(),
            _ => {}
        }
        let reply = plane.draw(json!({ "look": look }));
        let command = reply.picture()["command"].as_str().unwrap().to_owned();
        assert_eq!(reply.body, run(&command, plane.folder.path()), "{command}");
    }
    let gesture = json!({ "by": 3.0, "about": [0.1, 0.2], "shift": [0.05, 0.0] });
    for _ in 0..3 {
        let reply = plane.draw(json!({ "gesture": gesture }));
        let command = reply.picture()["command"].as_str().unwrap().to_owned();
        assert!(command.contains("--view="), "{command}");
        assert_eq!(reply.body, run(&command, plane.folder.path()), "{command}");
    }
    for name in ["menger", "barnsley-fern", "dragon"] {
        let page = Page::named(name);
        let reply = page.draw(json!({}));
        let command = reply.picture()["command"].as_str().unwrap().to_owned();
        assert_eq!(reply.body, run(&command, page.folder.path()), "{command}");
    }
}

/// Returns the pixels of a picture: red, green, blue and alpha.
fn pixels(reply: &Reply) -> Vec<u8> {
    reply.picture();
    let mut decoder = png::Decoder::new(std::io::Cursor::new(&reply.body));
    decoder.set_transformations(
        png::Transformations::normalize_to_color8() | png::Transformations::ALPHA,
    );
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    match info.color_type {
        png::ColorType::Rgba => pixels,
        png::ColorType::GrayscaleAlpha => pixels
            .chunks(2)
            .flat_map(|grey| [grey[0], grey[0], grey[0], grey[1]])
            .collect(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn drafts_have_the_same_pixels() {
    let page = Page::of(KOCH);
    let draft = |more: Value| {
        let reply = page.draw(more);
        assert_eq!(reply.picture()["size"], json!([300, 200]));
        assert_eq!(reply.body.len(), 4 * 300 * 200);
        reply.body
    };
    page.call("GET", "/numbers", &Value::Null);
    for options in [
        json!({}),
        json!({ "background": "teal" }),
        json!({ "stroke": "#12345678" }),
    ] {
        let look = json!({ "steps": 4, "options": options });
        let whole = page.draw(json!({ "look": look }));
        assert!(draft(json!({ "draft": true })) == pixels(&whole), "{look}");
    }
    // A draft of a step of 16 million elements has those that are seen.
    let look = json!({ "steps": 12 });
    let size = |reply: Value| reply["elements"].as_u64().unwrap();
    let reply = page.draw(json!({ "look": look, "draft": true }));
    assert!(size(reply.picture()) < 100_000, "{}", reply.picture());
    assert_eq!(page.state()["look"]["steps"], 12, "the look stays");
}

#[test]
fn zooms_go_beyond_doubles() {
    let page = Page::of(KOCH);
    page.draw(json!({})).picture();
    // Towards the left end of the curve, at the origin.
    let mut factor = 1.0;
    for _ in 0..=14 {
        let view = page.state()["look"]["view"].clone();
        let gesture = match view["width"].as_f64() {
            None => json!({ "by": 1.0, "about": [0.0, 0.0], "shift": [0.0, 0.0] }),
            Some(width) => {
                let about = [0, 1].map(|at| {
                    let middle = view["middle"][at].as_str().unwrap();
                    -middle.parse::<f64>().unwrap() / width
                });
                json!({ "by": 10.0, "about": about, "shift": [0.0, 0.0] })
            }
        };
        let reply = page.draw(json!({ "gesture": gesture }));
        factor = reply.picture()["session"]["factor"].as_f64().unwrap();
    }
    assert!(factor > 0.9e14, "{factor}");
    let reply = page.draw(json!({}));
    let command = reply.picture()["command"].as_str().unwrap().to_owned();
    assert!(command.contains("--zoom="), "{command}");
    assert!(
        reply.picture()["elements"].as_u64().unwrap() > 10,
        "the end of the curve is in sight"
    );
    assert_eq!(reply.body, run(&command, page.folder.path()), "{command}");
}

#[test]
fn strangers_are_refused() {
    let page = Page::of(KOCH);
    let (host, key) = (page.host(), page.key.clone());
    let origin = format!("http://{host}");
    let local = format!("localhost:{}", page.port);
    let other_key = "0".repeat(key.len());
    let allowed: [&[(&str, &str)]; 3] = [
        &[("host", &host), ("x-kfrac-key", &key)],
        &[("host", &local), ("x-kfrac-key", &key)],
        &[("host", &host), ("origin", &origin), ("x-kfrac-key", &key)],
    ];
    for headers in allowed {
        assert_eq!(
            page.send("GET", "/state", headers, b"").status,
            200,
            "{headers:?}"
        );
    }
    let refused: [&[(&str, &str)]; 14] = [
        &[("host", &host)],
        &[("host", &host), ("x-kfrac-key", "")],
        &[("host", &host), ("x-kfrac-key", &other_key)],
        &[("host", &host), ("x-kfrac-key", &key[1..])],
        &[("host", "evil.example"), ("x-kfrac-key", &key)],
        &[("host", "127.0.0.1"), ("x-kfrac-key", &key)],
        &[("host", "127.0.0.1:1"), ("x-kfrac-key", &key)],
        &[("host", "localhost.evil.example"), ("x-kfrac-key", &key)],
        &[
            ("host", &host),
            ("host", "evil.example"),
            ("x-kfrac-key", &key),
        ],
        &[
            ("host", &host),
            ("origin", "http://evil.example"),
            ("x-kfrac-key", &key),
        ],
        &[("host", &host), ("origin", "null"), ("x-kfrac-key", &key)],
        &[
            ("host", &host),
            ("origin", "https://127.0.0.1"),
            ("x-kfrac-key", &key),
        ],
        &[
            ("host", &host),
            ("sec-fetch-site", "cross-site"),
            ("x-kfrac-key", &key),
        ],
        &[
            ("host", &host),
            ("sec-fetch-site", "same-site"),
            ("x-kfrac-key", &key),
        ],
    ];
    let calls = [
        ("GET", "/state"),
        ("GET", "/events"),
        ("GET", "/library"),
        ("PUT", "/text?revision=1"),
        ("POST", "/picture"),
        ("POST", "/save"),
        ("POST", "/export"),
        ("OPTIONS", "/state"),
        ("GET", "/none"),
    ];
    for headers in refused {
        for (method, path) in calls {
            let reply = page.send(method, path, headers, b"{}");
            // Two hosts are no request at all.
            assert!(
                [403, 400].contains(&reply.status),
                "{method} {path} {headers:?}: {}",
                reply.status
            );
        }
    }
    // The page itself has no key yet, but no other host either, and no answer is for other origins.
    for path in ["/", "/studio.css", "/studio.js", "/design.js", "/film.js"] {
        assert_eq!(
            page.send("GET", path, &[("host", "evil.example")], b"")
                .status,
            403
        );
        let reply = page.send("GET", path, &[("host", &host)], b"");
        assert_eq!(reply.status, 200);
        let policy = &reply.headers["content-security-policy"];
        assert!(
            policy.starts_with("default-src 'self';") && !policy.contains("unsafe"),
            "{policy}"
        );
        assert!(!reply.headers.contains_key("access-control-allow-origin"));
        let text = String::from_utf8(reply.body).unwrap();
        assert!(!text.contains(&key) && !text.contains("https://"), "{path}");
    }
    assert!(page.state()["text"] == KOCH);
}

#[test]
fn keys_have_128_bits_and_differ() {
    let pages = [Page::of(KOCH), Page::of(KOCH)];
    for page in &pages {
        assert_eq!(page.key.len(), 32);
        assert!(page.key.bytes().all(|byte| byte.is_ascii_hexdigit()));
        let other = TcpStream::connect_timeout(
            &(std::net::Ipv4Addr::new(127, 0, 0, 2), page.port).into(),
            Duration::from_millis(300),
        );
        assert!(other.is_err(), "it listens on 127.0.0.1 only");
    }
    assert_ne!(pages[0].key, pages[1].key);
}

#[test]
fn files_are_written_below_the_folder_only() {
    let page = Page::of(KOCH);
    let outside = tempfile::tempdir().unwrap();
    let path = |name: &str| outside.path().join(name).to_string_lossy().into_owned();
    fs::write(path("there.yaml"), "mine").unwrap();
    for to in [
        path("new.yaml"),
        path("there.yaml"),
        "../up.yaml".into(),
        "/etc/kfrac.yaml".into(),
        "rule.yaml/../../x.yaml".into(),
        ".hidden.yaml".into(),
        "program.sh".into(),
        "\0.yaml".into(),
    ] {
        let reply = page.call("POST", "/save", &json!({ "path": to, "replace": true }));
        assert!([403, 422].contains(&reply.status), "{to}: {}", reply.status);
        let asked = json!({ "tab": "a", "path": to.replace(".yaml", ".svg"), "width": 100, "height": 100, "replace": true });
        if !to.ends_with(".sh") {
            let reply = page.call("POST", "/export", &asked);
            assert!([403, 422].contains(&reply.status), "{to}: {}", reply.status);
        }
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(outside.path(), page.folder.path().join("link")).unwrap();
        std::os::unix::fs::symlink(path("there.yaml"), page.folder.path().join("a.yaml")).unwrap();
        for to in ["link/b.yaml", "a.yaml"] {
            let reply = page.call("POST", "/save", &json!({ "path": to, "replace": true }));
            assert_eq!(reply.status, 403, "{to}");
        }
    }
    assert_eq!(fs::read_dir(outside.path()).unwrap().count(), 1);
    assert_eq!(fs::read_to_string(path("there.yaml")).unwrap(), "mine");
    // A file that exists is replaced only if that is asked for.
    fs::write(page.folder.path().join("other.yaml"), "other").unwrap();
    let reply = page.call("POST", "/save", &json!({ "path": "other.yaml" }));
    assert_eq!(reply.status, 409);
    assert_eq!(page.read("other.yaml"), "other");
    let reply = page.call(
        "POST",
        "/save",
        &json!({ "path": "other.yaml", "replace": true }),
    );
    assert_eq!(reply.status, 200, "{}", reply.error());
    assert_eq!(page.read("other.yaml"), KOCH);
    let reply = page.call(
        "POST",
        "/save",
        &json!({ "path": "own.yaml", "library": true }),
    );
    assert_eq!(reply.status, 200, "{}", reply.error());
    assert_eq!(page.read("library/rules/own.yaml"), KOCH);
}

#[test]
fn bodies_and_pictures_are_bounded() {
    let page = Page::of(KOCH);
    let long = "#".repeat(5 << 20);
    let reply = page.put(&long);
    assert_eq!(reply.status, 413);
    for (width, height) in [
        (0_u32, 10_u32),
        (10, 0),
        (100_000, 100),
        (4_000_000_000, 4_000_000_000),
    ] {
        let reply = page.draw(json!({ "width": width, "height": height }));
        assert_eq!(reply.status, 422, "{width} {height}");
    }
    for look in [
        json!({ "options": { "output": "/tmp/x.png" } }),
        json!({ "options": { "threads": "1000" } }),
        json!({ "options": { "stroke": "x".repeat(1_000) } }),
        json!({ "set": { "angle": "1".repeat(1_000) } }),
        json!({ "view": { "middle": ["NaN", "0"], "width": 1.0, "whole": 1.0 } }),
        json!({ "view": { "middle": ["0", "0"], "width": -1.0, "whole": 1.0 } }),
        json!({ "options": { "stroke": "no colour" } }),
        json!({ "other": 1 }),
    ] {
        let reply = page.draw(json!({ "look": look }));
        assert_eq!(reply.status, 422, "{look}");
    }
    page.draw(json!({ "look": {} })).picture();
    assert_eq!(page.call("POST", "/picture", &"{".into()).status, 400);
}

#[test]
fn a_step_beyond_the_budget_is_refused_with_its_size() {
    let page = Page::of(KOCH);
    let numbers = page.call("GET", "/numbers", &Value::Null).json();
    let steps = numbers["steps"].as_array().unwrap();
    assert_eq!(steps[5]["elements"], "1,024");
    assert!(
        steps[12]["fits"] == true && steps[13]["fits"] == false,
        "{steps:?}"
    );
    assert!(steps[13]["seconds"].is_string() && steps[13]["bytes"].is_string());
    assert!(
        numbers["dimension"].to_string().contains("1.2618"),
        "{numbers}"
    );
    let reply = page.draw(json!({ "look": { "steps": 13 } }));
    assert_eq!(reply.status, 422);
    assert!(
        reply.error().contains("67,108,864 elements"),
        "{}",
        reply.error()
    );
    page.draw(json!({ "look": { "steps": 13, "detail": 0.5 } }))
        .picture();
    page.draw(json!({ "look": { "steps": 3 } })).picture();
}

#[test]
fn a_broken_text_keeps_the_last_picture_and_marks_its_mistakes() {
    let page = Page::of(TREE);
    let before = page.draw(json!({})).body;
    let broken = TREE.replace("initiator: segment", "initiator: segmet # 🌲");
    let state = page.put(&broken).json();
    assert_eq!(state["isGood"], false);
    let [from, to] = [0, 1]
        .map(|at| usize::try_from(state["problems"][0]["range"][at].as_u64().unwrap()).unwrap());
    let wide: Vec<u16> = broken.encode_utf16().collect();
    assert_eq!(String::from_utf16(&wide[from..to]).unwrap(), "segmet");
    assert!(
        state["problems"][0]["hint"]
            .as_str()
            .unwrap()
            .contains("segment")
    );
    assert_eq!(page.draw(json!({})).body, before);
    let state = page.put(TREE).json();
    assert_eq!(
        (&state["isGood"], &state["problems"]),
        (&true.into(), &json!([]))
    );
    // From the beginning, too.
    let page = Page::of("initiator: segmet\n");
    assert_eq!(page.state()["hasGood"], false);
    assert_eq!(page.draw(json!({})).status, 422);
    page.put(KOCH);
    page.draw(json!({})).picture();
}

#[test]
fn undo_and_redo_are_byte_exact_across_reloads() {
    let start = "\u{feff}".to_owned() + &KOCH.replace('\n', "\r\n");
    let page = Page::of(&start);
    let texts = [
        start.clone(),
        start.replace("1/3", "0.3"),
        KOCH.into(),
        "oops: [\n".into(),
        TREE.into(),
    ];
    for text in &texts[1..] {
        assert_eq!(page.put(text).status, 200);
    }
    for text in texts.iter().rev().skip(1) {
        let state = page.call("POST", "/undo", &json!({})).json();
        assert_eq!(state["text"], **text);
        assert_eq!(page.state()["text"], **text, "a reload finds it");
    }
    assert_eq!(page.state()["canUndo"], false);
    assert_eq!(page.state()["isSaved"], true);
    for text in &texts[1..] {
        assert_eq!(
            page.call("POST", "/redo", &json!({})).json()["text"],
            **text
        );
    }
    page.call("POST", "/undo", &json!({}));
    assert_eq!(page.call("POST", "/save", &json!({})).status, 200);
    assert_eq!(page.read("rule.yaml"), texts[3]);
}

#[test]
fn two_tabs_see_each_other() {
    let page = Page::of(KOCH);
    let mut events = TcpStream::connect(("127.0.0.1", page.port)).unwrap();
    events
        .set_read_timeout(Some(Duration::from_secs(20)))
        .unwrap();
    let head = format!(
        "GET /events HTTP/1.1\r\nhost: {}\r\nx-kfrac-key: {}\r\n\r\n",
        page.host(),
        page.key
    );
    events.write_all(head.as_bytes()).unwrap();
    let mut heard = String::new();
    let mut hear = |word: &str| {
        let mut bytes = [0; 4096];
        while !heard.contains(word) {
            let count = events.read(&mut bytes).unwrap();
            heard.push_str(&String::from_utf8_lossy(&bytes[..count]));
        }
    };
    hear("text/event-stream");
    let revision = page.state()["revision"].as_u64().unwrap();
    let first = page.call(
        "PUT",
        &format!("/text?revision={revision}&tab=one"),
        &TREE.into(),
    );
    assert_eq!(first.status, 200);
    hear("\"tab\":\"one\"");
    // The other tab has not seen it yet: nothing is lost.
    let second = page.call(
        "PUT",
        &format!("/text?revision={revision}&tab=two"),
        &KOCH.into(),
    );
    assert_eq!(second.status, 409);
    assert_eq!(page.state()["text"], TREE);
    page.draw(json!({ "tab": "two", "look": { "steps": 2 } }))
        .picture();
    hear("\"tab\":\"two\"");
    assert_eq!(page.state()["look"]["steps"], 2);
}

#[test]
fn a_newer_request_cancels_the_older_one_of_its_tab() {
    let page = Page::named("dragon");
    let slow = json!({ "tab": "a", "width": 4000, "height": 4000, "look": { "steps": 24, "detail": 0.01 } });
    thread::scope(|scope| {
        let older = scope.spawn(|| page.call("POST", "/picture", &slow));
        thread::sleep(Duration::from_millis(150));
        let start = Instant::now();
        page.draw(json!({ "look": { "steps": 4 } })).picture();
        let patience = start.elapsed();
        assert!([410, 200].contains(&older.join().unwrap().status));
        assert!(patience < Duration::from_secs(20), "{patience:?}");
    });
}

#[test]
fn changes_of_the_file_arrive() {
    let page = Page::of(KOCH);
    let path = page.folder.path().join("rule.yaml");
    page.draw(json!({})).picture();
    // As editors do: a new file takes the place of the old one.
    let replace = |text: &str| {
        let part = page.folder.path().join("rule.part");
        fs::write(&part, text).unwrap();
        fs::rename(&part, &path).unwrap();
    };
    // The folder is watched soon after the start.
    until("the first change", || {
        replace(TREE);
        thread::sleep(Duration::from_millis(150));
        page.state()["text"] == TREE
    });
    assert_eq!(page.state()["isSaved"], true);
    assert_eq!(page.call("POST", "/undo", &json!({})).json()["text"], KOCH);
    // Now both differ: neither is lost.
    let theirs = TREE.replace("Tree", "Bush");
    replace(&theirs);
    until("the conflict", || page.state()["theirs"] == *theirs);
    assert_eq!(page.state()["text"], KOCH);
    assert_eq!(page.call("POST", "/save", &json!({})).status, 409);
    assert_eq!(page.read("rule.yaml"), theirs);
    assert_eq!(
        page.call("POST", "/save", &json!({ "path": "mine.yaml" }))
            .status,
        200
    );
    assert_eq!(page.read("mine.yaml"), KOCH);
    // The other file is followed from now on.
    until("a change of the new file", || {
        fs::write(page.folder.path().join("mine.yaml"), TREE).unwrap();
        thread::sleep(Duration::from_millis(150));
        page.state()["text"] == TREE
    });
    fs::write(page.folder.path().join("mine.yaml"), [0xff, 0xfe, 0]).unwrap();
    thread::sleep(Duration::from_millis(200));
    assert_eq!(page.state()["text"], TREE, "what is no text is left alone");
    assert_eq!(page.put(KOCH).status, 200);
    assert_eq!(page.call("POST", "/save", &json!({})).status, 409);
    let kept = fs::read(page.folder.path().join("mine.yaml")).unwrap();
    assert_eq!(kept, [0xff, 0xfe, 0], "and not replaced");
}

/// A text that was typed before another program saved the file is in conflict with it.
#[test]
fn what_was_typed_upon_an_older_file_replaces_nothing() {
    let page = Page::of(KOCH);
    let revision = page.state()["revision"].as_u64().unwrap();
    let path = page.folder.path().join("rule.yaml");
    until("the change", || {
        fs::write(&path, TREE).unwrap();
        thread::sleep(Duration::from_millis(150));
        page.state()["text"] == TREE
    });
    let mine = KOCH.replace("1/3", "0.3");
    let typed = || {
        let place = format!("/text?revision={revision}&tab=one");
        page.call("PUT", &place, &mine.as_str().into())
    };
    let state = typed().json();
    assert_eq!(
        (&state["text"], &state["theirs"]),
        (&json!(mine), &json!(TREE))
    );
    assert_eq!(page.call("POST", "/save", &json!({})).status, 409);
    assert_eq!(page.read("rule.yaml"), TREE);
    let settled = page
        .call("POST", "/settle", &json!({ "theirs": true }))
        .json();
    assert_eq!(
        (&settled["text"], &settled["isSaved"]),
        (&json!(TREE), &json!(true))
    );
    // The own text, once that is decided.
    assert_eq!(typed().status, 200);
    let settled = page
        .call("POST", "/settle", &json!({ "theirs": false }))
        .json();
    assert_eq!(settled["text"], json!(mine));
    assert_eq!(page.call("POST", "/save", &json!({})).status, 200);
    assert_eq!(page.read("rule.yaml"), mine);
}

#[test]
fn members_near_the_present_one_are_drawn_and_taken() {
    let page = Page::of(KOCH);
    let found = page.call("POST", "/vary", &json!({ "seed": 5 })).json();
    assert_eq!(found["variants"].as_array().unwrap().len(), 8);
    let size = json!({ "tab": "p", "width": 120, "height": 90, "variant": 3 });
    let preview = page.call("POST", "/preview", &size);
    preview.picture();
    assert_eq!(page.state()["text"], KOCH, "a preview changes nothing");
    let state = page.call("POST", "/take", &json!({ "variant": 3 })).json();
    assert!(state["text"] != KOCH && state["isGood"] == true, "{state}");
    let taken = page.draw(json!({ "width": 120, "height": 90 }));
    assert_eq!(pixels(&taken), pixels(&preview));
    assert_eq!(page.call("POST", "/undo", &json!({})).json()["text"], KOCH);
    // Parameters are set, and the text stays.
    let page = Page::of(TREE);
    page.call("POST", "/vary", &json!({ "seed": 5 }));
    let state = page.call("POST", "/take", &json!({ "variant": 0 })).json();
    let angle: f64 = state["look"]["set"]["angle"]
        .as_str()
        .unwrap()
        .parse()
        .unwrap();
    assert!(angle != 40.0 && (angle - 40.0).abs() <= 3.5, "{angle}");
    assert_eq!(state["text"], TREE);
}

#[test]
fn the_library_opens_as_a_copy() {
    let page = Page::of(KOCH);
    let all = page.call("GET", "/library", &Value::Null).json();
    let ids: Vec<_> = all["entries"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it["id"].as_str().unwrap())
        .collect();
    for id in [
        "rules/pythagoras",
        "ifs/menger",
        "lsystems/gosper-lsystem",
        "generators/koch",
    ] {
        assert!(ids.contains(&id), "{id}");
    }
    for id in [
        "rules/pythagoras",
        "ifs/menger",
        "generators/koch",
        "initiators/segment",
    ] {
        let thumb = page.call("GET", &format!("/thumb?id={id}"), &Value::Null);
        assert!(
            thumb.status == 200 && thumb.body.starts_with(b"\x89PNG"),
            "{id}: {}",
            thumb.error()
        );
    }
    assert_eq!(
        page.call("GET", "/thumb?id=../../etc/passwd", &Value::Null)
            .status,
        422
    );
    let state = page
        .call("POST", "/open", &json!({ "id": "rules/pythagoras" }))
        .json();
    assert_eq!(
        (&state["path"], &state["isSaved"], &state["isGood"]),
        (&Value::Null, &false.into(), &true.into())
    );
    page.draw(json!({})).picture();
    assert_eq!(page.read("rule.yaml"), KOCH);
    assert_eq!(
        page.call("POST", "/save", &json!({})).status,
        422,
        "it has no file yet"
    );
    assert_eq!(
        page.call("POST", "/save", &json!({ "path": "copy.yaml" }))
            .status,
        200
    );
    assert!(page.read("copy.yaml").contains("Pythagoras"));
    assert_eq!(page.call("POST", "/undo", &json!({})).json()["text"], KOCH);
}

#[test]
fn a_file_of_every_kind_is_begun() {
    let page = Page::of(KOCH);
    for kind in ["rule", "ifs", "instancing", "lsystem"] {
        for space in [false, true] {
            // The extension may be left out.
            let name = format!("odd-{kind}{}", if space { ".json" } else { "" });
            let begun = json!({ "name": name, "kind": kind, "space": space });
            let state = page.call("POST", "/new", &begun).json();
            assert_eq!(
                [&state["path"], &state["isSaved"], &state["isGood"]],
                [&Value::Null, &false.into(), &true.into()],
                "{kind} {space}"
            );
            let file = format!("odd-{kind}.{}", if space { "json" } else { "yaml" });
            assert_eq!(state["name"], file);
            let text = state["text"].as_str().unwrap();
            let sign = match kind {
                "rule" => "\ninitiator:".to_owned(),
                kind => format!("\nkind: {kind}\n"),
            };
            assert!(text.contains(&sign), "{text}");
            assert!(text.contains(&format!("\"Odd {kind}\"")), "{text}");
            assert!(text.contains(&format!("grow {file}")), "{text}");
            assert_eq!(text.contains("space: 3"), space, "{text}");
            page.draw(json!({})).picture();
        }
    }
    let long = "long".repeat(51);
    for name in [
        " ", ".yaml", ".mine", "-mine", "a/b", "a\\b", "a\nb", "../mine", &long,
    ] {
        let wrong = json!({ "name": name, "kind": "rule" });
        let reply = page.call("POST", "/new", &wrong);
        assert_eq!(reply.status, 422, "{name}");
    }
    for wrong in [
        json!({ "name": "mine", "kind": "figure" }),
        json!({ "kind": "rule" }),
        json!({}),
    ] {
        assert_eq!(page.call("POST", "/new", &wrong).status, 422);
    }
    // Words of the template in a name.
    let begun = json!({ "name": "TITLE of FILE", "kind": "rule" });
    let state = page.call("POST", "/new", &begun).json();
    let text = state["text"].as_str().unwrap();
    assert!(text.contains("\ntitle: \"TITLE of FILE\"\n"), "{text}");
    assert!(text.contains("grow TITLE of FILE.yaml"), "{text}");
    page.draw(json!({})).picture();
}

#[test]
fn undo_leads_back_to_the_file_that_was_left_and_to_its_look() {
    let page = Page::of(KOCH);
    let back = || page.call("POST", "/undo", &json!({})).json();
    let path = page.state()["path"].clone();
    let name = page.state()["name"].clone();
    page.draw(json!({ "look": { "steps": 2 } })).picture();
    let changed = format!("title: Mine\n{KOCH}");
    assert_eq!(page.put(&changed).status, 200);
    let opened = json!({ "id": "rules/pythagoras" });
    let state = page.call("POST", "/open", &opened).json();
    assert_eq!([&state["path"], &state["look"]["steps"]], [&Value::Null; 2]);
    page.draw(json!({ "look": { "steps": 5 } })).picture();

    let state = back();
    assert_eq!(state["text"], changed);
    assert_eq!([&state["path"], &state["name"]], [&path, &name]);
    assert_eq!(state["isSaved"], false);
    assert_eq!(state["look"]["steps"], 2);
    page.draw(json!({})).picture();
    assert_eq!(page.call("POST", "/save", &json!({})).status, 200);
    assert_eq!(page.read("rule.yaml"), changed);

    // Forth again, to the copy, which is saved.
    let state = page.call("POST", "/redo", &json!({})).json();
    assert_eq!(state["path"], Value::Null);
    assert_eq!(state["name"], "pythagoras");
    assert_eq!(state["look"]["steps"], 5);
    let to = json!({ "path": "copy.yaml" });
    assert_eq!(page.call("POST", "/save", &to).status, 200);

    // Another program changes both files meanwhile, which is settled; neither the own texts nor the other file are lost.
    let saved = page.state()["text"].clone();
    fs::write(page.folder.path().join("rule.yaml"), TREE).unwrap();
    let state = back();
    let is = |state: &Value, text: &str, theirs: Value| {
        assert_eq!((&state["text"], &state["theirs"]), (&text.into(), &theirs));
    };
    is(&state, &changed, TREE.into());
    assert_eq!([&state["path"], &state["canRedo"]], [&path, &true.into()]);
    assert_eq!(page.call("POST", "/save", &json!({})).status, 409);
    // A change that arrives while it is shown is settled, too.
    let bush = TREE.replace("Tree", "Bush");
    until("the conflict", || {
        fs::write(page.folder.path().join("rule.yaml"), &bush).unwrap();
        thread::sleep(Duration::from_millis(150));
        page.state()["theirs"] == *bush
    });
    is(&back(), KOCH, bush.into());
    assert_eq!(page.state()["canUndo"], false);
    fs::write(page.folder.path().join("copy.yaml"), KOCH).unwrap();
    let forth = || page.call("POST", "/redo", &json!({})).json();
    assert_eq!(forth()["text"], changed);
    let saved = saved.as_str().unwrap();
    is(&forth(), saved, KOCH.into());
    assert_eq!(page.call("POST", "/save", &json!({})).status, 409);
    let settled = page
        .call("POST", "/settle", &json!({ "theirs": true }))
        .json();
    is(&settled, KOCH, Value::Null);
    is(&back(), saved, Value::Null);
}

/// A file that is opened after undo does not end what redo leads to, if that is another file.
#[test]
fn no_file_is_lost_by_opening_another_one() {
    let page = Page::of(KOCH);
    let call = |path: &str, asked: Value| page.call("POST", path, &asked).json();
    call("/open", json!({ "id": "rules/pythagoras" }));
    assert_eq!(page.put(TREE).status, 200);
    page.draw(json!({ "look": { "steps": 3 } })).picture();
    for _ in 0..2 {
        call("/undo", json!({}));
    }
    assert_eq!(page.state()["text"], KOCH);
    call("/open", json!({ "id": "rules/dragon" }));
    let state = call("/undo", json!({}));
    assert_eq!(
        (&state["text"], &state["name"]),
        (&TREE.into(), &"pythagoras".into())
    );
    assert_eq!(state["look"]["steps"], 3);
    call("/undo", json!({}));
    assert_eq!(call("/undo", json!({}))["text"], KOCH);
    assert_eq!(page.state()["canUndo"], false);
}

/// Requests that were sent while another file was shown change nothing.
#[test]
fn what_was_asked_of_a_file_that_was_left_has_no_effect() {
    let page = Page::of(KOCH);
    page.draw(json!({ "look": { "steps": 2 } })).picture();
    let opened = json!({ "id": "rules/pythagoras" });
    let left = page.call("POST", "/open", &opened).json();
    let back = page.call("POST", "/undo", &json!({})).json();
    assert!(left["file"] != back["file"]);
    assert_eq!(back["isSaved"], true);
    page.call("POST", "/vary", &json!({ "seed": 5 })).json();
    let place = format!("/text?revision={}", left["revision"]);
    let replaced = page.call("PUT", &place, &left["text"]);
    assert_eq!(replaced.status, 409);
    let pointer =
        json!({ "phase": "double", "panel": "generator", "x": 0.5, "y": 0.1, "pixel": 0.01 });
    for (path, asked) in [
        (
            "/edit",
            json!({ "gesture": { "act": "split", "panel": "generator", "element": 0 } }),
        ),
        ("/pointer", json!({ "pointer": pointer })),
        ("/write", json!({ "name": "angle" })),
        ("/take", json!({ "variant": 0 })),
        ("/save", json!({ "path": "other.yaml" })),
        ("/settle", json!({ "theirs": true })),
        (
            "/component",
            json!({ "panel": "generator", "name": "mine" }),
        ),
        (
            "/export",
            json!({ "tab": "a", "path": "a.png", "width": 30, "height": 20 }),
        ),
        (
            "/picture",
            json!({ "tab": "a", "width": 30, "height": 20, "look": { "steps": 5 } }),
        ),
    ] {
        let file = left["file"].to_string();
        let reply = page.call_about(&file, "POST", path, &asked);
        assert_eq!(reply.status, 409, "{path}");
    }
    let state = page.state();
    assert_eq!(state["text"], KOCH);
    assert_eq!(state["look"]["steps"], 2);
    assert!(!page.folder.path().join("other.yaml").exists());
    // Members near a text that has changed.
    page.call("POST", "/vary", &json!({ "seed": 5 })).json();
    assert_eq!(page.put(TREE).status, 200);
    assert_eq!(
        page.call("POST", "/take", &json!({ "variant": 3 })).status,
        409
    );
    let preview = json!({ "tab": "p", "width": 120, "height": 90, "variant": 3 });
    assert_eq!(page.call("POST", "/preview", &preview).status, 409);
    assert_eq!(page.state()["text"], TREE);
}

#[test]
fn every_kind_of_file_is_drawn_stepped_turned_and_moved() {
    for (name, is_in_space) in [
        ("koch", false),
        ("gasket", false),
        ("ternary-tree", false),
        ("gosper-lsystem", false),
        ("fern-in-space", true),
        ("pound-sign-in-space", true),
        ("tree-of-boxes", true),
    ] {
        let page = Page::named(name);
        let state = page.state();
        assert_eq!(state["isInSpace"], is_in_space, "{name}");
        let numbers = page.call("GET", "/numbers", &Value::Null).json();
        assert!(numbers["proposed"].is_u64(), "{name}: {numbers}");
        let mut last = page.draw(json!({})).body;
        let mut differs = |what: &str, asked: Value| {
            let reply = page.draw(asked);
            let command = reply.picture()["command"].as_str().unwrap().to_owned();
            assert!(reply.body != last, "{name}: {what}");
            assert_eq!(reply.body, run(&command, page.folder.path()), "{command}");
            last = reply.body;
            command
        };
        differs("a step", json!({ "look": { "steps": 2 } }));
        let turn = match is_in_space {
            true => json!({ "from": "10,20", "light": "-40,30" }),
            false => json!({ "turn": "37" }),
        };
        differs("a turn", json!({ "look": { "steps": 2, "options": turn } }));
        let gesture = json!({ "by": 2.0, "about": [0.1, 0.2], "shift": [0.0, 0.0] });
        let zoomed = differs("a zoom", json!({ "gesture": gesture }));
        let gesture = json!({ "by": 1.0, "about": [0.0, 0.0], "shift": [0.1, 0.05] });
        let moved = differs("a shift", json!({ "gesture": gesture }));
        let [part, own] = match is_in_space {
            true => ["--look-at=", "--zoom=2"],
            false => ["--view=", "--turn=37"],
        };
        assert!(
            [&zoomed, &moved]
                .iter()
                .all(|it| it.contains(part) && it.contains(own)),
            "{moved}"
        );
        assert_eq!(page.state()["factor"], 2.0);
    }
}

#[test]
fn a_window_is_shown_whole() {
    let page = Page::of(KOCH);
    page.draw(json!({})).picture();
    let reply = page.draw(json!({ "window": [0.0, 0.0, 0.5, 0.5] }));
    let command = reply.picture()["command"].as_str().unwrap().to_owned();
    assert!(command.contains("--view=-0.125,0,0.75,0.5"), "{command}");
    for wrong in [json!([0, 0, 0, 1]), json!([0, 0, 1, -1])] {
        assert_eq!(page.draw(json!({ "window": wrong })).status, 422);
    }
}

#[test]
fn a_value_is_written_into_the_text() {
    let page = Page::of(TREE);
    page.draw(json!({ "look": { "set": { "angle": "25.5" } } }))
        .picture();
    let write = |name: &str| page.call("POST", "/write", &json!({ "name": name }));
    let state = write("angle").json();
    assert_eq!(state["text"], TREE.replace("value: 40", "value: 25.5"));
    assert_eq!(state["look"]["set"], json!({}));
    assert_eq!(write("angle").status, 422, "nothing is set");
    let state = page.call("POST", "/undo", &json!({})).json();
    assert_eq!(state["text"], TREE);
    assert_eq!(state["look"]["set"], json!({ "angle": "25.5" }));
    let state = page.call("POST", "/redo", &json!({})).json();
    assert_eq!(state["look"]["set"], json!({}));
}

#[test]
fn whole_numbers_are_known() {
    let are_integers = |text: &str| {
        let parameters = Page::of(text).state()["parameters"].clone();
        let all = parameters.as_array().unwrap().clone();
        let all = all.iter().map(|it| it["is_integer"].as_bool().unwrap());
        all.collect::<Vec<_>>()
    };
    let ring = "kind: ifs\nparams: {n: {value: 5, min: 3, max: 9}, r: {value: 1, min: 0, max: 2}}\nmaps:\n  - {for: {k: 1..n}, scale: 1/n, shift: [r*k, 0]}\n";
    assert_eq!(are_integers(ring), [true, false]);
    let levels = "params:\n  levels: {value: 4, min: 1, max: 9}\n";
    let steps = format!("{}steps: levels\n", TREE.replace("params:\n", levels));
    assert_eq!(are_integers(&steps), [true, false]);
    assert_eq!(
        are_integers(include_str!("../library/instancing/poppies.yaml")),
        [false, true]
    );
}

#[test]
fn every_format_is_exported() {
    let export = |page: &Page, name: &str, status: u16| {
        let asked = json!({ "tab": "a", "path": name, "width": 200, "height": 200 });
        let reply = page.call("POST", "/export", &asked);
        assert_eq!(reply.status, status, "{name}: {}", reply.error());
    };
    let page = Page::of(include_str!("../library/ifs/menger.yaml"));
    page.draw(json!({ "look": { "steps": 2 } })).picture();
    for format in [
        "png", "svg", "pdf", "dxf", "usda", "3mf", "glb", "pov", "stl", "obj", "ply", "csv", "json",
    ] {
        let name = format!("a.{format}");
        export(&page, &name, 200);
        assert!(!fs::read(page.folder.path().join(name)).unwrap().is_empty());
    }
    let page = Page::of(TREE);
    page.draw(json!({ "look": { "steps": 4 } })).picture();
    for name in ["a.svg", "a.png", "a.pdf", "a.dxf", "a.csv", "a.json"] {
        export(&page, name, 200);
        assert!(!fs::read(page.folder.path().join(name)).unwrap().is_empty());
        export(&page, name, 409);
    }
    export(&page, "a.glb", 422);
    assert!(!page.folder.path().join("a.glb").exists());
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_with_130() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.yaml"), KOCH).unwrap();
    let mut studio = Command::new(assert_cmd::cargo::cargo_bin("kfrac"))
        .args(["studio", "mine.yaml", "--no-open"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = std::io::BufReader::new(studio.stdout.take().unwrap());
    let mut line = String::new();
    std::io::BufRead::read_line(&mut out, &mut line).unwrap();
    assert!(
        line.starts_with("http://127.0.0.1:") && line.contains("/#"),
        "{line}"
    );
    interrupt(&mut studio);
}

/// Program that does not outlive its test.
#[cfg(unix)]
struct Ended(std::process::Child);

#[cfg(unix)]
impl Drop for Ended {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

/// Ends a program as Ctrl-C does; by force where programs inherit from the tests that it is ignored.
#[cfg(unix)]
fn interrupt(program: &mut std::process::Child) {
    #[cfg(target_os = "linux")]
    if crate::terminal::signals::are_ignored() {
        program.kill().unwrap();
        return;
    }
    let interrupt = Command::new("kill")
        .args(["-INT", &program.id().to_string()])
        .status();
    assert!(interrupt.unwrap().success());
    assert_eq!(program.wait().unwrap().code(), Some(130));
}

#[cfg(unix)]
#[test]
fn a_watched_rule_is_drawn_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("mine.yaml"), KOCH).unwrap();
    let program = assert_cmd::cargo::cargo_bin("kfrac");
    let watching = Command::new(&program)
        .args([
            "grow",
            "mine.yaml",
            "--watch",
            "--steps",
            "2",
            "-o",
            "mine.svg",
        ])
        .current_dir(folder.path())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut watching = Ended(watching);
    until("the first picture", || path("mine.svg").exists());
    let first = fs::read(path("mine.svg")).unwrap();
    until("the second picture", || {
        fs::write(path("mine.yaml"), KOCH.replace("sqrt(3)/6", "1/2")).unwrap();
        thread::sleep(Duration::from_millis(150));
        fs::read(path("mine.svg")).unwrap() != first
    });
    let second = fs::read(path("mine.svg")).unwrap();
    fs::write(path("mine.yaml"), "initiator: segmet\n").unwrap();
    thread::sleep(Duration::from_millis(400));
    assert_eq!(
        fs::read(path("mine.svg")).unwrap(),
        second,
        "a mistake leaves it as it is"
    );
    fs::write(path("mine.yaml"), KOCH).unwrap();
    until("the first picture again", || {
        fs::read(path("mine.svg")).unwrap() == first
    });
    interrupt(&mut watching.0);
    let (status, message) = crate::common::said(folder.path(), &["grow", "koch", "--watch"]);
    assert!(
        status == Some(2) && message.contains("is none"),
        "{message}"
    );
    let refused = ["grow", "mine.yaml", "--watch", "-o", "-"];
    assert_eq!(crate::common::said(folder.path(), &refused).0, Some(2));
}

#[test]
fn what_cannot_be_opened_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let said = |arguments: &[&str]| crate::common::said(folder.path(), arguments);
    let (status, message) = said(&["studio", "pythagras"]);
    assert!(
        status == Some(1) && message.contains("did you mean 'pythagoras'?"),
        "{message}"
    );
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let (status, message) = said(&["studio", "--no-open", "--port", &port]);
    assert!(
        status == Some(1) && message.contains(&format!("port {port}")),
        "{message}"
    );
    assert_eq!(said(&["studio", "--port", "0"]).0, Some(2));
    assert_eq!(said(&["studio", "--set", "angle"]).0, Some(2));
}
