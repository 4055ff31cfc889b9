//! Jobs: one at a time in each queue. A newer request cancels the older one of its tab.

use std::collections::BTreeMap;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::http::StatusCode;
use tokio::sync::Semaphore;

use crate::cli::held::Held;

use super::answer::Refusal;

/// Longest time of a job.
const LIMIT: Duration = Duration::from_secs(60);

/// Largest number of jobs that run or wait.
const MOST: usize = 64;

/// Queue of jobs that draw.
#[derive(Debug)]
pub(super) struct Jobs {
    turn: Semaphore,
    /// Jobs that run or wait, by the name of their tab.
    known: Mutex<BTreeMap<String, Arc<Held>>>,
}

/// Job that is cancelled when it is dropped, as when a browser closes the connection.
struct Job<'a> {
    jobs: &'a Jobs,
    tab: String,
    held: Arc<Held>,
}

impl Drop for Job<'_> {
    fn drop(&mut self) {
        self.held.cancel.store(true, Ordering::Relaxed);
        let mut known = self
            .jobs
            .known
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if known
            .get(&self.tab)
            .is_some_and(|held| Arc::ptr_eq(held, &self.held))
        {
            known.remove(&self.tab);
        }
    }
}

impl Default for Jobs {
    fn default() -> Self {
        Self {
            turn: Semaphore::new(1),
            known: Mutex::default(),
        }
    }
}

impl Jobs {
    /// Runs `work` on a thread of its own when it is its turn. The older job of the same tab is cancelled.
    pub(super) async fn run<T: Send + 'static>(
        &self,
        tab: &str,
        held: Arc<Held>,
        work: impl FnOnce() -> Result<T, Refusal> + Send + 'static,
    ) -> Result<T, Refusal> {
        let job = self.begin(tab, &held)?;
        let is_over = || held.cancel.load(Ordering::Relaxed);
        let turn = self.turn.acquire().await.map_err(|_| Refusal::replaced())?;
        if is_over() {
            return Err(Refusal::replaced());
        }
        let mut work = tokio::task::spawn_blocking(work);
        let done = match tokio::time::timeout(LIMIT, &mut work).await {
            Ok(done) => done,
            Err(_) => {
                held.cancel.store(true, Ordering::Relaxed);
                // Work that cannot be cancelled keeps its turn until it has ended.
                let _ = work.await;
                return Err(Refusal::wrong(format!(
                    "it takes longer than {} seconds: fewer steps, a coarser detail or a smaller picture may do",
                    LIMIT.as_secs()
                )));
            }
        };
        drop(turn);
        let was_over = is_over();
        drop(job);
        match done {
            Ok(Err(_)) if was_over => Err(Refusal::replaced()),
            Ok(done) => done,
            Err(error) => Err(Refusal::new(
                StatusCode::INTERNAL_SERVER_ERROR,
                format!("the work has failed: {error}"),
            )),
        }
    }

    fn begin(&self, tab: &str, held: &Arc<Held>) -> Result<Job<'_>, Refusal> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if known.len() >= MOST && !known.contains_key(tab) {
            let message = "too many requests wait for their turn";
            return Err(Refusal::new(StatusCode::TOO_MANY_REQUESTS, message));
        }
        if let Some(older) = known.insert(tab.to_owned(), Arc::clone(held)) {
            older.cancel.store(true, Ordering::Relaxed);
        }
        Ok(Job {
            jobs: self,
            tab: tab.to_owned(),
            held: Arc::clone(held),
        })
    }
}
