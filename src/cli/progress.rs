//! Progress of long work, shown on a terminal.

use std::io::IsTerminal;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::grow::Progress;

use super::stop;

/// Time before a progress bar appears.
const PATIENCE: Duration = Duration::from_millis(500);
/// Time between two updates.
const PAUSE: Duration = Duration::from_millis(100);

/// Runs `work` and shows its progress on standard error, if `wanted` and on a terminal. The progress bar is
/// cleared when the work ends.
///
/// The work itself must not write to the terminal.
pub(super) fn watched<T>(wanted: bool, work: impl FnOnce(Option<&Progress>) -> T) -> T {
    if !is_watched(wanted) {
        return work(None);
    }
    let progress = Progress::default();
    let walked = style("{spinner} {human_pos} elements walked, {elapsed}").tick_chars(r"-\|/ ");
    let update = |bar: &ProgressBar| {
        let expected = progress.expected();
        if expected.is_some() && bar.length().is_none() {
            bar.set_style(style("{percent:>3} % [{bar:30}] {eta} left").progress_chars("=> "));
        }
        bar.update(|state| {
            state.set_pos(progress.walked());
            if let Some(expected) = expected {
                state.set_len(expected);
            }
        });
    };
    beside(walked, update, || work(Some(&progress)))
}

/// Runs `work` and shows what `describe` returns meanwhile, as [`watched`] does.
pub(super) fn watched_as<T>(
    wanted: bool,
    describe: impl Fn() -> String + Sync,
    work: impl FnOnce() -> T,
) -> T {
    if !is_watched(wanted) {
        return work();
    }
    let style = style("{spinner} {msg}, {elapsed}").tick_chars(r"-\|/ ");
    beside(style, |bar| bar.set_message(describe()), work)
}

fn is_watched(wanted: bool) -> bool {
    wanted && std::io::stderr().is_terminal()
}

/// Runs `work` beside a thread that shows a progress bar.
fn beside<T>(
    style: ProgressStyle,
    update: impl Fn(&ProgressBar) + Sync,
    work: impl FnOnce() -> T,
) -> T {
    let (working, done) = mpsc::channel();
    thread::scope(|scope| {
        scope.spawn(|| show(style, &update, done));
        // The sender is moved into the scope, so that it is dropped, and the scope ends, even if the work
        // panics.
        let _working: mpsc::Sender<()> = working;
        work()
    })
}

/// Shows a progress bar until the sender of `done` is dropped.
fn show(style: ProgressStyle, update: &dyn Fn(&ProgressBar), done: Receiver<()>) {
    // The bar is created at the start because it measures the time.
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    bar.set_style(style);
    let mut pause = PATIENCE;
    while done.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
        if pause == PATIENCE {
            pause = PAUSE;
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        let mut shown = stop::shown();
        update(&bar);
        bar.tick();
        *shown = Some(bar.clone());
    }
    let mut shown = stop::shown();
    bar.finish_and_clear();
    *shown = None;
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
