//! Interruption by Ctrl-C and other signals: the process ends at once and leaves no unfinished files.
//!
//! A separate thread waits for signals, removes unfinished files and ends the process, whatever the other
//! threads do. Commands need not check for interruption, so that all of them end alike: those that compute,
//! those that wait for input, and those whose reader has stopped reading. A command that is asked to keep what it has
//! gets the first Ctrl-C as a [flag](kept), and ends at the second.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use indicatif::ProgressBar;

use crate::output_file::unfinished;

/// Exit status of an interrupted process.
const INTERRUPTED: i32 = 130;

static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);
static KEPT: Mutex<Option<Arc<AtomicBool>>> = Mutex::new(None);

/// Locks the progress bar that the terminal shows. It is drawn only while the lock is held, so that it does
/// not reappear after it has been cleared for good.
pub(super) fn shown() -> MutexGuard<'static, Option<ProgressBar>> {
    SHOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns a flag that the first Ctrl-C sets instead of ending the process.
pub(super) fn kept() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = Some(flag.clone());
    flag
}

/// Sets the flag of a command that keeps what it has; `false` if there is none, or it is set already.
fn is_kept() -> bool {
    let flag = KEPT.lock().unwrap_or_else(PoisonError::into_inner).take();
    flag.is_some_and(|flag| {
        flag.store(true, Ordering::Relaxed);
        true
    })
}

/// Ends the process. Both locks are held to the end: no file is begun and no progress bar drawn any more.
fn interrupt() -> ! {
    let unfinished = unfinished();
    for path in unfinished.iter() {
        // A failure cannot be reported any more.
        let _ = std::fs::remove_file(path);
    }
    let bar = shown();
    if let Some(bar) = bar.as_ref() {
        bar.finish_and_clear();
    }
    std::process::exit(INTERRUPTED)
}

/// Begins to handle signals.
///
/// A signal that is ignored when the program starts stays ignored: `nohup` requires a program to survive the
/// end of its terminal, and a shell without job control requires its background processes to survive a Ctrl-C
/// that is meant for others.
#[cfg(unix)]
pub(super) fn listen() {
    use std::sync::mpsc;

    use signal_hook::consts::{SIGINT, SIGXFSZ};
    use signal_hook::iterator::Signals;

    // With a handler, a file that exceeds the size limit is an error like any other.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
    let (send, receive) = mpsc::channel::<Signals>();
    let listener = std::thread::Builder::new().name("signals".into());
    let listener = listener.spawn(move || {
        let Ok(mut signals) = receive.recv() else {
            return;
        };
        for signal in signals.forever() {
            if signal != SIGINT || !is_kept() {
                interrupt();
            }
        }
    });
    // Without a listening thread, signals keep their default effect of ending the process.
    if listener.is_ok()
        && let Ok(signals) = Signals::new(disposition::heard())
    {
        let _ = send.send(signals);
    }
}

/// Begins to handle Ctrl-C.
#[cfg(not(unix))]
pub(super) fn listen() {
    // Without a handler, Ctrl-C ends the process by default.
    let _ = ctrlc::set_handler(|| {
        if !is_kept() {
            interrupt();
        }
    });
}

/// Signals that are handled: those that were not ignored when the program started.
#[cfg(unix)]
mod disposition {
    /// Returns the signals that end the program.
    #[cfg(any(target_os = "linux", target_os = "android"))]
    pub(super) fn heard() -> Vec<i32> {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = ignored(&status);
        let is_heard = |signal: &i32| ignored >> (signal - 1) & 1 == 0;
        [SIGINT, SIGTERM, SIGHUP]
            .into_iter()
            .filter(is_heard)
            .collect()
    }

    /// Returns all signals except SIGHUP, which `nohup` ignores, because ignored signals cannot be determined
    /// here.
    #[cfg(not(any(target_os = "linux", target_os = "android")))]
    pub(super) fn heard() -> Vec<i32> {
        use signal_hook::consts::{SIGINT, SIGTERM};

        vec![SIGINT, SIGTERM]
    }

    /// Returns the mask of the signals that a process ignores, from its status as in proc(5): bit n − 1
    /// stands for signal n. The mask is 0 if it cannot be read.
    #[cfg(any(target_os = "linux", target_os = "android"))]
    fn ignored(status: &str) -> u64 {
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
            .unwrap_or(0)
    }

    #[cfg(all(test, any(target_os = "linux", target_os = "android")))]
    mod tests {
        use super::ignored;

        #[test]
        fn the_status_has_a_mask_of_ignored_signals() {
            let status = "Name:\tkfrac\nSigBlk:\t0000000000000002\nSigIgn:\t0000000000001001\n";
            assert_eq!(ignored(status), 1 << 12 | 1);
            assert_eq!(ignored("Name:\tkfrac\n"), 0);
            assert_eq!(ignored("SigIgn:\tmany\n"), 0);
        }
    }
}
