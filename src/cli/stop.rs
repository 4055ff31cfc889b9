//! Ctrl-C: the first asks the work to end, so that nothing half done is left; the second ends it.

use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// The flag that Ctrl-C sets from now on.
pub(super) fn flag() -> &'static AtomicBool {
    // A second handler is refused; the first one does the same.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    &STOP
}
