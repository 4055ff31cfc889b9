//! Parallel execution with results in the order of submission.

#[cfg(test)]
pub(crate) mod adversary;

use std::collections::{BTreeMap, VecDeque};
use std::num::NonZero;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender, TryRecvError};
use std::sync::{Condvar, LazyLock, Mutex, MutexGuard, PoisonError};
use std::thread;

/// Returns the number of threads that the machine runs at once; 1 if that is unknown.
#[must_use]
pub(crate) fn all_cores() -> NonZero<usize> {
    // Linux reads the limits of the process from files.
    static CORES: LazyLock<NonZero<usize>> =
        LazyLock::new(|| thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN));
    *CORES
}

/// Returns whether a flag that cancels work is set.
pub(crate) fn is_cancelled(cancel: Option<&AtomicBool>) -> bool {
    cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
}

/// Applies `work` to every item, in any order on at most `threads` threads, including the calling one.
pub(crate) fn for_each<T: Send>(
    items: impl Iterator<Item = T> + Send,
    threads: usize,
    work: impl Fn(T) + Sync,
) {
    let mut items = items.peekable();
    let first = items.next();
    let others = if items.peek().is_some() {
        threads.saturating_sub(1)
    } else {
        0
    };
    let items = Mutex::new(first.into_iter().chain(items));
    let next = || items.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work_on = || {
        while let Some(item) = next() {
            work(item);
        }
    };
    thread::scope(|scope| {
        for _ in 0..others {
            scope.spawn(work_on);
        }
        work_on();
    });
}

/// Returns the results of `work` for every item and its number, in the order of the items.
pub(crate) fn map<I: Sync, T: Send>(
    items: &[I],
    threads: usize,
    work: impl Fn(usize, &I) -> T + Sync,
) -> Vec<T> {
    let mut results: Vec<Option<T>> = items.iter().map(|_| None).collect();
    let slots = items.iter().enumerate().zip(&mut results);
    for_each(slots, threads, |((number, item), result)| {
        *result = Some(work(number, item));
    });
    results.into_iter().flatten().collect()
}

/// Returns the results of two functions. With more than one thread, the first runs on one of its own.
#[cfg(feature = "cli")]
pub(crate) fn both<A: Send, B>(
    threads: usize,
    aside: impl FnOnce() -> A + Send,
    own: impl FnOnce() -> B,
) -> (A, B) {
    if threads == 1 {
        return (aside(), own());
    }
    thread::scope(|scope| {
        let aside = scope.spawn(aside);
        let own = own();
        match aside.join() {
            Ok(aside) => (aside, own),
            Err(panic) => panic::resume_unwind(panic),
        }
    })
}

/// A pool of threads that execute submitted jobs. The thread that submits them helps while it waits.
pub(crate) struct Team<'w> {
    queue: Mutex<Queue<'w>>,
    called: Condvar,
    threads: NonZero<usize>,
}

#[derive(Default)]
struct Queue<'w> {
    jobs: VecDeque<Job<'w>>,
    is_over: bool,
}

type Job<'w> = Box<dyn FnOnce() + Send + 'w>;

/// Runs `body` with a team of `threads`, including the calling thread.
pub(crate) fn with_team<'w, T>(threads: NonZero<usize>, body: impl FnOnce(&Team<'w>) -> T) -> T {
    let team = Team {
        queue: Mutex::default(),
        called: Condvar::new(),
        threads,
    };
    thread::scope(|scope| {
        // However the body ends, no more jobs follow, and the threads end.
        let _over = Over(&team);
        for _ in 1..team.others() {
            scope.spawn(|| team.serve());
        }
        body(&team)
    })
}

struct Over<'t, 'w>(&'t Team<'w>);

impl Drop for Over<'_, '_> {
    fn drop(&mut self) {
        self.0.queue().is_over = true;
        self.0.called.notify_all();
    }
}

impl<'w> Team<'w> {
    fn queue(&self) -> MutexGuard<'_, Queue<'w>> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn call(&self, job: Job<'w>) {
        self.queue().jobs.push_back(job);
        self.called.notify_one();
    }

    /// Executes jobs until the team ends.
    fn serve(&self) {
        loop {
            let idle = |queue: &mut Queue<'w>| queue.jobs.is_empty() && !queue.is_over;
            let waited = self.called.wait_while(self.queue(), idle);
            let mut queue = waited.unwrap_or_else(PoisonError::into_inner);
            if queue.is_over {
                return;
            }
            let job = queue.jobs.pop_front();
            drop(queue);
            job.into_iter().for_each(|job| job());
        }
    }

    /// Returns the number of threads of the team, including the calling one. With an adversary the calling
    /// thread executes all jobs.
    fn others(&self) -> usize {
        #[cfg(test)]
        if adversary::is_here() {
            return 1;
        }
        self.threads.get()
    }

    /// Executes one job that no thread has taken yet. Returns `true` if there was one.
    fn help(&self) -> bool {
        let mut queue = self.queue();
        let first = pick(queue.jobs.len());
        let job = queue.jobs.remove(first);
        drop(queue);
        job.map(|job| job()).is_some()
    }

    /// Returns the number of threads.
    pub(crate) fn threads(&self) -> NonZero<usize> {
        self.threads
    }

    /// Creates a pipeline that applies `work` to pieces.
    pub(crate) fn line<J: Send + 'w>(&self, work: fn(&mut J)) -> Pipeline<'_, 'w, J> {
        let (finished, done) = mpsc::channel();
        Pipeline {
            team: self,
            work,
            finished,
            done,
            waiting: BTreeMap::new(),
            handed_out: 0,
            taken: 0,
            spare: Vec::new(),
            ahead: PIECES_A_THREAD,
        }
    }
}

/// Returns the index of the piece of work, or place for one, to take where any may be taken: the first.
#[cfg(not(test))]
#[inline]
pub(crate) fn pick(_: usize) -> usize {
    0
}

/// Returns `true` if a piece of work is to be submitted while still small, which only an adversary does.
#[cfg(not(test))]
#[inline]
pub(crate) fn is_cut_short() -> bool {
    false
}

#[cfg(test)]
pub(crate) use adversary::{is_cut_short, pick};

/// A pipeline: pieces of work that are in progress, and finished ones that wait for earlier ones.
pub(crate) struct Pipeline<'t, 'w, J> {
    team: &'t Team<'w>,
    work: fn(&mut J),
    /// Finished pieces; `None` where the work has panicked.
    finished: Sender<Option<(u64, J)>>,
    done: Receiver<Option<(u64, J)>>,
    waiting: BTreeMap<u64, J>,
    handed_out: u64,
    taken: u64,
    /// Pieces to be reused.
    spare: Vec<J>,
    /// Maximum number of pieces in progress per thread.
    ahead: u64,
}

/// Usual maximum number of pieces in progress per thread.
const PIECES_A_THREAD: u64 = 2;

impl<'w, J: Send + 'w> Pipeline<'_, 'w, J> {
    /// Returns the pipeline with another maximum number of pieces in progress per thread.
    pub(crate) fn ahead(self, ahead: u64) -> Self {
        Self { ahead, ..self }
    }

    /// Returns a piece that can be reused, if there is one.
    pub(crate) fn spare(&mut self) -> Option<J> {
        self.spare.pop()
    }

    /// Returns `true` if no pieces are in progress.
    pub(crate) fn is_idle(&self) -> bool {
        self.handed_out == self.taken
    }

    /// Submits a piece. Finished pieces are passed to `take`, in the order in which they were submitted.
    pub(crate) fn hand_on<E>(
        &mut self,
        mut piece: J,
        take: &mut dyn FnMut(&mut J) -> Result<(), E>,
    ) -> Result<(), E> {
        let threads = self.team.threads.get() as u64;
        let work = self.work;
        if threads == 1 {
            work(&mut piece);
            let taken = take(&mut piece);
            self.spare.push(piece);
            return taken;
        }
        let (number, finished) = (self.handed_out, self.finished.clone());
        self.team.call(Box::new(move || {
            let worked = panic::catch_unwind(AssertUnwindSafe(|| work(&mut piece)));
            // The receiver must not wait for a piece that has panicked. It may be gone already, which is no
            // error.
            let _ = finished.send(worked.is_ok().then_some((number, piece)));
            if let Err(cause) = worked {
                panic::resume_unwind(cause);
            }
        }));
        self.handed_out += 1;
        // With an adversary, jobs may be executed at once, as by other threads.
        while pick(3) > 0 && self.team.help() {}
        self.take_until(self.ahead * threads, take)
    }

    /// Waits for all pieces, and passes them to `take`.
    pub(crate) fn finish<E>(
        &mut self,
        take: &mut dyn FnMut(&mut J) -> Result<(), E>,
    ) -> Result<(), E> {
        self.take_until(0, take)
    }

    /// Passes finished pieces to `take`, and helps or waits while more than `most` pieces are in progress.
    fn take_until<E>(
        &mut self,
        most: u64,
        take: &mut dyn FnMut(&mut J) -> Result<(), E>,
    ) -> Result<(), E> {
        while self.handed_out - self.taken > most {
            if let Some(mut piece) = self.waiting.remove(&self.taken) {
                self.taken += 1;
                take(&mut piece)?;
                self.spare.push(piece);
                continue;
            }
            let done = match self.done.try_recv() {
                Err(TryRecvError::Empty) if self.team.help() => continue,
                Err(_) => self.done.recv().ok().flatten(),
                Ok(done) => done,
            };
            let Some((number, piece)) = done else {
                // The scope propagates the panic once the other threads have ended.
                panic::resume_unwind(Box::new("a thread has panicked"));
            };
            self.waiting.insert(number, piece);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;

    #[test]
    fn results_come_in_order_on_any_number_of_threads() {
        for threads in [1, 2, 5] {
            let square = |(number, result): &mut (u64, u64)| {
                if number.is_multiple_of(7) {
                    thread::yield_now();
                }
                *result = *number * *number;
            };
            let mut results = Vec::new();
            with_team(NonZero::new(threads).unwrap(), |team| {
                let mut line = team.line(square);
                let mut take = |piece: &mut (u64, u64)| {
                    results.push(piece.1);
                    io::Result::Ok(())
                };
                for number in 0..1000 {
                    let mut piece = line.spare().unwrap_or_default();
                    piece.0 = number;
                    line.hand_on(piece, &mut take).unwrap();
                }
                line.finish(&mut take).unwrap();
            });
            let expected: Vec<u64> = (0..1000).map(|number| number * number).collect();
            assert_eq!(results, expected);
        }
    }

    /// The results of one pipeline are submitted to another, served by the same threads.
    #[test]
    fn lines_may_feed_lines() {
        for threads in [1, 2, 5] {
            let mut results = Vec::new();
            with_team(NonZero::new(threads).unwrap(), |team| {
                let mut doubled = team.line(|number: &mut u64| *number *= 2);
                let mut raised = team.line(|number: &mut u64| *number += 1);
                let mut keep = |number: &mut u64| {
                    results.push(*number);
                    io::Result::Ok(())
                };
                for number in 0..1000 {
                    let mut hand_on = |number: &mut u64| raised.hand_on(*number, &mut keep);
                    doubled.hand_on(number, &mut hand_on).unwrap();
                }
                let mut hand_on = |number: &mut u64| raised.hand_on(*number, &mut keep);
                doubled.finish(&mut hand_on).unwrap();
                raised.finish(&mut keep).unwrap();
            });
            let expected: Vec<u64> = (0..1000).map(|number| 2 * number + 1).collect();
            assert_eq!(results, expected);
        }
    }

    #[test]
    fn what_fails_ends_the_work() {
        let failed: io::Result<()> = with_team(NonZero::new(3).unwrap(), |team| {
            let mut line = team.line(|_: &mut u64| {});
            let mut take = |_: &mut u64| Err(io::ErrorKind::StorageFull.into());
            (0..100).try_for_each(|number| line.hand_on(number, &mut take))
        });
        assert_eq!(failed.unwrap_err().kind(), io::ErrorKind::StorageFull);
    }

    #[test]
    #[should_panic(expected = "panicked")]
    fn a_panic_ends_the_work() {
        let work = |number: &mut u64| assert!(*number != 50, "the work panicked");
        with_team(NonZero::new(3).unwrap(), |team| {
            let mut line = team.line(work);
            let mut take = |_: &mut u64| io::Result::Ok(());
            let all = (0..10_000).try_for_each(|number| line.hand_on(number, &mut take));
            assert!(all.is_ok(), "the work should have been missed");
        });
    }
}
