//! Watching of files: changes by other programs.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
#[cfg(feature = "studio")]
use std::sync::mpsc::Sender;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};

/// Time without a change after which a file is read: editors write in several steps.
const QUIET: Duration = Duration::from_millis(50);

/// Watch over files. Their folders are watched, because editors replace files by others.
pub(crate) struct Watch {
    watcher: RecommendedWatcher,
    /// Events; `None` ends the waiting.
    changes: Receiver<Option<notify::Result<notify::Event>>>,
    #[cfg(feature = "studio")]
    sender: Sender<Option<notify::Result<notify::Event>>>,
    folders: BTreeSet<PathBuf>,
    files: BTreeSet<PathBuf>,
}

impl Watch {
    /// Returns a watch over no files.
    ///
    /// # Errors
    ///
    /// If the system gives none.
    pub(crate) fn new() -> notify::Result<Self> {
        let (send, changes) = channel();
        #[cfg(feature = "studio")]
        let sender = send.clone();
        let watcher = notify::recommended_watcher(move |event| {
            // Nobody listens any more when the program ends.
            let _ = send.send(Some(event));
        })?;
        Ok(Self {
            watcher,
            changes,
            #[cfg(feature = "studio")]
            sender,
            folders: BTreeSet::new(),
            files: BTreeSet::new(),
        })
    }

    /// Watches these files, and no others. Texts that are no files are left out.
    ///
    /// # Errors
    ///
    /// If a folder cannot be watched.
    pub(crate) fn set<'p>(
        &mut self,
        files: impl IntoIterator<Item = &'p Path>,
    ) -> notify::Result<()> {
        let real = files.into_iter().filter_map(|file| {
            let folder = file.parent().filter(|folder| *folder != Path::new(""));
            let folder = folder.unwrap_or(Path::new(".")).canonicalize().ok()?;
            Some(folder.join(file.file_name()?))
        });
        self.files = real.collect();
        let folders = self.files.iter().filter_map(|file| file.parent());
        let folders: BTreeSet<_> = folders.map(Path::to_path_buf).collect();
        for folder in self.folders.difference(&folders) {
            // A folder that has gone is not watched any more.
            let _ = self.watcher.unwatch(folder);
        }
        for folder in folders.difference(&self.folders) {
            self.watcher.watch(folder, RecursiveMode::NonRecursive)?;
        }
        self.folders = folders;
        Ok(())
    }

    /// Returns a function that ends the waiting, for other threads.
    #[cfg(feature = "studio")]
    pub(crate) fn nudge(&self) -> impl Fn() + Send + use<> {
        let sender = self.sender.clone();
        move || {
            let _ = sender.send(None);
        }
    }

    /// Waits until a file has changed, `patience` at most; returns whether one has.
    pub(crate) fn wait(&self, patience: Duration) -> bool {
        let mut is_changed = false;
        let mut end = Instant::now() + patience;
        loop {
            let pause = end.saturating_duration_since(Instant::now());
            match self.changes.recv_timeout(pause) {
                Ok(None) => return is_changed,
                // Other files of the folder may be busy all the time.
                Ok(Some(event)) if self.concerns(&event) => {
                    is_changed = true;
                    end = Instant::now() + QUIET;
                }
                Ok(Some(_)) => {}
                Err(RecvTimeoutError::Timeout) => return is_changed,
                Err(RecvTimeoutError::Disconnected) => {
                    std::thread::sleep(pause);
                    return is_changed;
                }
            }
        }
    }

    fn concerns(&self, event: &notify::Result<notify::Event>) -> bool {
        match event {
            Ok(event) => {
                !matches!(event.kind, EventKind::Access(_))
                    && event.paths.iter().any(|path| self.files.contains(path))
            }
            // Changes may have been lost.
            Err(_) => true,
        }
    }
}
