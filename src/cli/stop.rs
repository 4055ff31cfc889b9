//! Ctrl-C, and what else asks a program to end: it ends at once, and nothing half done is left.
//!
//! A thread of its own waits for the signals, takes away what is unfinished and ends the process,
//! whatever the other threads do. No command has to look whether it is to stop, so that all of them
//! end alike: those that compute, those that wait for input, and those whose reader has gone to sleep.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use indicatif::ProgressBar;

/// The exit status of a program that was interrupted.
const INTERRUPTED: i32 = 130;

static UNFINISHED: Mutex<Unfinished> = Mutex::new(Unfinished { files: Vec::new() });
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// The files that have not been finished.
pub(super) struct Unfinished {
    files: Vec<PathBuf>,
}

impl Unfinished {
    /// Names a file that is to be removed if the program ends before it is finished.
    pub(super) fn begin(&mut self, path: &Path) {
        self.files.push(path.to_path_buf());
    }

    /// Takes back that a file is unfinished: it has been finished or removed.
    pub(super) fn end(&mut self, path: &Path) {
        self.files.retain(|file| file != path);
    }
}

/// The files that have not been finished. While this is held, no signal ends the program: what is
/// made, named or removed meanwhile is never half done.
pub(super) fn unfinished() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The bar that the terminal shows. It is drawn only while this is held: so that it does not come
/// back when it has been cleared away for good.
pub(super) fn shown() -> MutexGuard<'static, Option<ProgressBar>> {
    SHOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends the program. Both locks are held to the end: nothing is begun or drawn any more.
fn interrupt() -> ! {
    let unfinished = unfinished();
    for path in &unfinished.files {
        // There is nobody left to be told that this failed.
        let _ = std::fs::remove_file(path);
    }
    let bar = shown();
    if let Some(bar) = bar.as_ref() {
        bar.finish_and_clear();
    }
    std::process::exit(INTERRUPTED)
}

/// Listens to signals from now on.
///
/// A signal that is ignored when the program starts stays ignored: `nohup` wants a program to survive
/// the end of its terminal, and a shell without job control wants those in its background to survive
/// the Ctrl-C that is meant for others.
#[cfg(unix)]
pub(super) fn listen() {
    use std::sync::atomic::AtomicBool;
    use std::sync::{Arc, mpsc};

    use signal_hook::consts::SIGXFSZ;
    use signal_hook::iterator::Signals;

    // Once there is a handler, a file that grows beyond the limit is an error like any other.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
    let (send, receive) = mpsc::channel::<Signals>();
    let listener = std::thread::Builder::new().name("signals".into());
    let listener = listener.spawn(move || {
        let Ok(mut signals) = receive.recv() else {
            return;
        };
        if signals.forever().next().is_some() {
            interrupt();
        }
    });
    // Without a thread that listens, signals had better end the program by themselves.
    if listener.is_ok()
        && let Ok(signals) = Signals::new(disposition::heard())
    {
        let _ = send.send(signals);
    }
}

/// Listens to Ctrl-C from now on.
#[cfg(not(unix))]
pub(super) fn listen() {
    // If it cannot be heard, it ends the program by itself.
    let _ = ctrlc::set_handler(|| interrupt());
}

/// The signals that are heard: those that were not ignored when the program started.
#[cfg(unix)]
mod disposition {
    /// The signals that end the program.
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

    /// Returns all but the signal that `nohup` is about, where ignored signals cannot be known.
    #[cfg(not(any(target_os = "linux", target_os = "android")))]
    pub(super) fn heard() -> Vec<i32> {
        use signal_hook::consts::{SIGINT, SIGTERM};

        vec![SIGINT, SIGTERM]
    }

    /// The mask of the signals that a process ignores, by its status as proc(5) has it: bit n − 1
    /// stands for signal n. Nothing is ignored where nothing can be read.
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
