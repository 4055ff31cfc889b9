//! How far long work is, on a terminal.

use std::io::IsTerminal;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::grow::Progress;

use super::stop;

/// Work that is done sooner shows nothing.
const PATIENCE: Duration = Duration::from_millis(500);
/// The time between two looks at how far the work is.
const PAUSE: Duration = Duration::from_millis(100);

/// Does some work and shows on standard error how far it is, if `wanted` and on a terminal; what is
/// shown is gone when the work is done.
///
/// The work itself must not write to the terminal.
pub(super) fn watched<T>(wanted: bool, work: impl FnOnce(Option<&Progress>) -> T) -> T {
    if !wanted || !std::io::stderr().is_terminal() {
        return work(None);
    }
    let progress = Progress::default();
    let (working, done) = mpsc::channel();
    thread::scope(|scope| {
        scope.spawn(|| show(&progress, done));
        // Moved in here, so that it is dropped, and the scope ends, even if the work panics.
        let _working: mpsc::Sender<()> = working;
        work(Some(&progress))
    })
}

/// Shows a bar until nobody is working any more.
fn show(progress: &Progress, done: Receiver<()>) {
    // From the start, for it measures the time.
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    bar.set_style(style("{spinner} {human_pos} elements walked, {elapsed}").tick_chars(r"-\|/ "));
    let mut pause = PATIENCE;
    while done.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
        let expected = progress.expected();
        if expected.is_some() && bar.length().is_none() {
            bar.set_style(style("{percent:>3} % [{bar:30}] {eta} left").progress_chars("=> "));
        }
        if pause == PATIENCE {
            pause = PAUSE;
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        let mut shown = stop::shown();
        bar.update(|state| {
            state.set_pos(progress.walked());
            if let Some(expected) = expected {
                state.set_len(expected);
            }
        });
        *shown = Some(bar.clone());
    }
    let mut shown = stop::shown();
    bar.finish_and_clear();
    *shown = None;
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
