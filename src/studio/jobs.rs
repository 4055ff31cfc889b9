//! Jobs: one at a time in each queue. A newer request cancels the older one of its tab.

use std::collections::BTreeMap;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::http::StatusCode;
use tokio::sync::Semaphore;

use crate::cli::held::Held;

use super::answer::Refusal;

/// Longest time of a job of the studio.
const LIMIT: Duration = Duration::from_secs(60);

/// Largest number of jobs that run or wait.
const MOST: usize = 64;

/// Queue of jobs that draw.
#[derive(Debug)]
pub(super) struct Jobs {
    turn: Semaphore,
    /// Longest time of a job.
    limit: Duration,
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
        Self::within(LIMIT)
    }
}

impl Jobs {
    /// Returns a queue of jobs that take no longer than a limit.
    pub(super) fn within(limit: Duration) -> Self {
        Self {
            turn: Semaphore::new(1),
            limit,
            known: Mutex::default(),
        }
    }

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
        let done = match tokio::time::timeout(self.limit, &mut work).await {
            Ok(done) => done,
            Err(_) => {
                held.cancel.store(true, Ordering::Relaxed);
                // Work that cannot be cancelled keeps its turn until it has ended.
                let _ = work.await;
                return Err(Refusal::wrong(format!(
                    "it takes longer than {} seconds: fewer steps, a coarser detail or a smaller picture may do",
                    self.limit.as_secs()
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

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::catalogue::Catalogue;
    use crate::cli::grow;
    use crate::render::PngEncoding;

    /// Draws a rule with options by a job.
    async fn draw(jobs: &Jobs, tab: &str, rule: &str, options: &[&str]) -> Result<(), Refusal> {
        let catalogue = Catalogue::embedded();
        let source = catalogue.rule(std::path::Path::new(rule))?;
        let mut arguments = vec![rule.to_owned(), "--format=png".into(), "--output=-".into()];
        arguments.extend(options.iter().map(|&option| option.to_owned()));
        let held = Arc::new(Held::new(64 << 20, PngEncoding::default()));
        let own = Arc::clone(&held);
        let work = move || Ok(grow::hold(&arguments, &source, &catalogue, own)?);
        jobs.run(tab, held, work).await.map(|_| ())
    }

    /// Work of minutes, of each kind of picture.
    const LONG: [(&str, &[&str]); 4] = [
        ("dragon", &["--steps=34", "--max-elements=100000000000"]),
        (
            "random-tree",
            &["--steps=30", "--max-elements=100000000000"],
        ),
        ("barnsley-fern", &["--method=chaos", "--points=100G"]),
        ("romanesco", &["--size=8000", "--detail=0.05"]),
    ];

    #[test]
    fn work_ends_at_its_limit_and_gives_way() {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build();
        runtime.unwrap().block_on(async {
            let jobs = Jobs::within(Duration::from_millis(300));
            for (rule, options) in LONG {
                let start = Instant::now();
                let refused = draw(&jobs, "a", rule, options).await.unwrap_err();
                let message = &refused.message;
                assert!(
                    message.contains("it takes longer than"),
                    "{rule}: {message}"
                );
                // The work itself has ended, not only the wait for it: the next one has its turn.
                draw(&jobs, "a", "koch", &["--steps=2"]).await.unwrap();
                assert!(start.elapsed() < Duration::from_secs(20), "{rule}");
            }
            assert!(jobs.known.lock().unwrap().is_empty());
        });
    }

    #[test]
    fn too_many_jobs_are_refused() {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build();
        runtime.unwrap().block_on(async {
            let jobs = Jobs::default();
            let held = || Arc::new(Held::default());
            let waiting: Vec<_> = (0..MOST)
                .map(|number| jobs.begin(&number.to_string(), &held()))
                .collect();
            assert!(waiting.iter().all(Result::is_ok));
            let refused = jobs.run("one more", held(), || Ok(())).await.unwrap_err();
            assert_eq!(refused.status, StatusCode::TOO_MANY_REQUESTS);
            drop(waiting);
            jobs.run("one more", held(), || Ok(())).await.unwrap();
        });
    }
}
