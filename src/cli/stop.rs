//! Ctrl-C, and what else asks a program to end: the first asks the work to end, so that nothing half
//! done is left; the second ends it.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

static STOP: AtomicBool = AtomicBool::new(false);

/// The unfinished file, if there is one.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// The flag that Ctrl-C sets from now on.
pub(super) fn flag() -> &'static AtomicBool {
    // A second handler is refused; the first one does the same.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(path) = unfinished.as_ref() {
                // There is nobody left to be told that this failed.
                let _ = std::fs::remove_file(path);
            }
            std::process::exit(130);
        }
    });
    &STOP
}

/// Names the file that is to be removed if the program ends before it is finished.
pub(super) fn remove_at_exit(path: Option<&Path>) {
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    *unfinished = path.map(Path::to_path_buf);
}
