//! The studio: the three interactive states of Kaandorp's system, in a page of the browser.
//!
//! Kaandorp's report (CWI CS-R8706, 1987, section 2.3 and figure 15) has an interactive system with three states that
//! may be freely interleaved: the design of production rules, the generation of the next approximant on demand, and
//! the manipulation of what is drawn. [`Studio`] serves these states to the browser of the same machine.
//!
//! All logic is here: the page holds no state that a reload would lose. A picture is the output of `kfrac grow` with the
//! arguments that the page shows, held in memory: byte for byte the file that the command would write.
//!
//! | module | content |
//! |---|---|
//! | `session`, `good` | text, last valid model, look, revision |
//! | `origin` | file of the text, and changes of it by other programs |
//! | `history` | texts that undo and redo bring back, byte for byte |
//! | `look` | steps, seed, parameters, style and view, as arguments of `grow` |
//! | `view`, `sight` | pan and zoom: in long decimals in the plane, and in space |
//! | `shots`, `drawing`, `jobs` | pictures, one at a time; a newer one cancels the older of its tab |
//! | `film` | key frames of the parameters, and films of them |
//! | `numbers` | forecast and dimension |
//! | `problems`, `complete` | mistakes at their places; completion from the schema |
//! | `vary`, `write` | members near the present one; values that are written into the text |
//! | `design` | points, elements and maps that a hand drags; each gesture an edit of the text |
//! | `underlay` | a picture under the design, and its collage by the maps of the system |
//! | `library` | the library, with thumbnails |
//! | `files` | where files may be written |
//! | `guard`, `server` | requests that are answered, and the answers |
//!
//! # Safety
//!
//! The server listens on 127.0.0.1 only. Every call but that for the page carries a key of 128 random bits, which is in the
//! fragment of the page's address and therefore never sent by a browser itself. `Host` must be the address of the server,
//! and `Origin`, where it is sent, too, so that neither other pages nor names that are bound anew reach it. Files are
//! written below the folder of the rule, or the current one, and the person's library only. Bodies have a limit, and work
//! a limit of time.

mod answer;
mod complete;
mod design;
mod drawing;
mod files;
mod film;
mod good;
mod guard;
mod history;
mod jobs;
mod library;
mod look;
mod numbers;
mod origin;
mod problems;
mod server;
mod session;
mod shots;
mod sight;
mod underlay;
mod vary;
mod view;
mod write;

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::diagnostic::Diagnostics;

use guard::Guard;
use server::App;
use session::Session;

/// Rule that a studio opens, and the place where it is served.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct StudioOptions {
    /// File, or name in the library; the Pythagoras tree of the library if `None`.
    pub rule: Option<PathBuf>,
    /// Catalogue in which names are looked up.
    pub catalogue: Catalogue,
    /// Folder of the person's own library, where files may be written too.
    pub library: Option<PathBuf>,
    /// Values of parameters, as `kfrac grow --set` takes them: `angle=30`.
    pub settings: Vec<String>,
    /// Seed of random draws.
    pub seed: u64,
    /// Port; any free one if 0.
    pub port: u16,
}

setters!(StudioOptions {
    rule: Option<PathBuf>,
    catalogue: Catalogue,
    library: Option<PathBuf>,
    settings: Vec<String>,
    seed: u64,
    port: u16,
});

/// Reason why a studio cannot be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudioError {
    /// There is no such file or name, or it cannot be read.
    #[error("{0}")]
    File(Diagnostics),
    /// The port cannot be used.
    #[error("port {port} of 127.0.0.1 cannot be used: {error}")]
    Port {
        /// Port.
        port: u16,
        /// Cause.
        error: std::io::Error,
    },
    /// The server failed.
    #[error("the studio cannot be served: {0}")]
    Server(#[from] std::io::Error),
    /// The system has no random numbers.
    #[error("the system gives no random numbers for a key: {0}")]
    Key(#[from] getrandom::Error),
}

/// A studio that is bound to its port.
///
/// ```no_run
/// # fn main() -> Result<(), kfrac::studio::StudioError> {
/// use kfrac::studio::{Studio, StudioOptions};
///
/// let studio = Studio::bind(StudioOptions::default().rule(Some("koch".into())))?;
/// println!("{}", studio.url());
/// studio.serve()
/// # }
/// ```
#[derive(Debug)]
pub struct Studio {
    listener: TcpListener,
    app: Arc<App>,
}

impl Studio {
    /// Opens a rule and binds the port. A rule that is not valid is opened as well: the page shows its mistakes.
    ///
    /// # Errors
    ///
    /// If there is no such rule, or the port is taken.
    pub fn bind(options: StudioOptions) -> Result<Self, StudioError> {
        let StudioOptions { port, .. } = options;
        let session = Session::open(options).map_err(StudioError::File)?;
        let bound = TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port)));
        let listener = bound.map_err(|error| StudioError::Port { port, error })?;
        let guard = Guard::new(listener.local_addr()?.port())?;
        let app = Arc::new(App::new(session, guard));
        Ok(Self { listener, app })
    }

    /// Returns the address of the page, with the key in its fragment.
    #[must_use]
    pub fn url(&self) -> String {
        self.app.guard.url()
    }

    /// Answers requests until the process ends.
    ///
    /// # Errors
    ///
    /// If the server fails.
    pub fn serve(self) -> Result<(), StudioError> {
        Ok(server::serve(self.listener, self.app)?)
    }
}
