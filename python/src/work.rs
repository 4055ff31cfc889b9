//! Work without the interpreter's lock.

use std::any::Any;
use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::error::Failure;

/// Time between two looks at signals.
const PATIENCE: Duration = Duration::from_millis(50);

/// Does work that takes a moment, without the interpreter's lock. A panic becomes a `RuntimeError`.
pub(crate) fn quick<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(work)));
    finished(done)
}

/// Does work that may take long, without the interpreter's lock. An interrupt, such as Ctrl-C, sets the flag that the work is
/// given, and is raised when the work has ended. A panic becomes a `RuntimeError`.
///
/// Signals can be handled by the calling thread only, which is why another one does the work: one that waits for the next
/// work of its caller, since starting it takes longer than many a call.
pub(crate) fn long<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(Arc<AtomicBool>) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let cancel = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&cancel);
    let (done, interrupt) = py.detach(|| {
        let (sender, receiver) = channel();
        let work = move || {
            let done = catch_unwind(AssertUnwindSafe(|| work(flag)));
            // The caller waits for it.
            let _ = sender.send(done);
        };
        let worker = match Worker::free() {
            Ok(worker) => worker,
            Err(error) => return (Ok(Err(Failure::of(error))), None),
        };
        worker.start(Box::new(work));
        let mut interrupt = None;
        let done = loop {
            match receiver.recv_timeout(PATIENCE) {
                Ok(done) => {
                    worker.wait_for_more();
                    break done;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break Err(Box::new("the thread has ended")),
            }
            if interrupt.is_none()
                && let Err(raised) = Python::attach(|py| py.check_signals())
            {
                cancel.store(true, Ordering::Relaxed);
                interrupt = Some(raised);
            }
        };
        (done, interrupt)
    });
    match interrupt {
        Some(interrupt) => Err(interrupt),
        None => finished(done),
    }
}

type Work = Box<dyn FnOnce() + Send>;

/// A thread that does the work of another one.
struct Worker {
    work: Sender<Work>,
    /// Process in which it runs: a child process has none of its parent's threads.
    process: u32,
}

thread_local! {
    /// The worker of this thread while it waits; a handler of signals may call while it works.
    static WORKER: Cell<Option<Worker>> = const { Cell::new(None) };
}

impl Worker {
    /// Returns the worker of this thread, or a new one. It ends when it is dropped.
    fn free() -> io::Result<Self> {
        let process = std::process::id();
        match WORKER.take() {
            Some(worker) if worker.process == process => return Ok(worker),
            // Its channel may be locked by the thread that did not come along.
            Some(worker) => std::mem::forget(worker),
            None => {}
        }
        let (sender, receiver) = channel::<Work>();
        let run = move || receiver.into_iter().for_each(|work| work());
        thread::Builder::new().spawn(run)?;
        Ok(Self {
            work: sender,
            process,
        })
    }

    /// Starts work.
    fn start(&self, work: Work) {
        // If the thread has ended, the work is dropped, and what it would send is disconnected.
        let _ = self.work.send(work);
    }

    /// Keeps the worker for the next call.
    fn wait_for_more(self) {
        WORKER.set(Some(self));
    }
}

/// Returns the result of work, or its failure as an exception.
fn finished<T>(done: Result<Result<T, Failure>, Box<dyn Any + Send>>) -> PyResult<T> {
    match done {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(failure)) => Err(Python::attach(|py| failure.into_exception(py))),
        Err(panic) => {
            let message = panic.downcast_ref::<String>().map(String::as_str);
            let message = message.or_else(|| panic.downcast_ref::<&str>().copied());
            let message = message.unwrap_or("unknown");
            Err(PyRuntimeError::new_err(format!(
                "kfrac has failed, which is a mistake in kfrac itself: {message}"
            )))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_become_exceptions() {
        Python::initialize();
        Python::attach(|py| {
            let quick: PyResult<()> = quick(py, || panic!("{}", "one"));
            let long: PyResult<()> = long(py, |_| panic!("two"));
            for (result, message) in [(quick, "one"), (long, "two")] {
                let error = result.unwrap_err();
                assert!(error.is_instance_of::<PyRuntimeError>(py));
                assert!(error.to_string().ends_with(message));
            }
        });
    }
}
