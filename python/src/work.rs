//! Work without the interpreter's lock.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
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
/// Signals can be handled by the calling thread only, which is why another one does the work.
pub(crate) fn long<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(Arc<AtomicBool>) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let cancel = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&cancel);
    let (done, interrupt) = py.detach(|| {
        let (sender, receiver) = channel::<()>();
        thread::scope(|scope| {
            let work = move || {
                // Dropped at the end of the work, which the receiver notices.
                let _ended = sender;
                catch_unwind(AssertUnwindSafe(|| work(flag)))
            };
            let worker = match thread::Builder::new().spawn_scoped(scope, work) {
                Ok(worker) => worker,
                Err(error) => return (Ok(Err(Failure::of(error))), None),
            };
            let mut interrupt = None;
            while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(PATIENCE) {
                if interrupt.is_none()
                    && let Err(raised) = Python::attach(|py| py.check_signals())
                {
                    cancel.store(true, Ordering::Relaxed);
                    interrupt = Some(raised);
                }
            }
            (worker.join().and_then(|done| done), interrupt)
        })
    });
    match interrupt {
        Some(interrupt) => Err(interrupt),
        None => finished(done),
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
