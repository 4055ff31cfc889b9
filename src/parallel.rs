//! Work on many threads whose results come in order.

use std::collections::BTreeMap;
use std::io;
use std::num::NonZero;
use std::panic::{self, AssertUnwindSafe};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// The number of threads that the machine runs at once.
#[must_use]
pub fn all_cores() -> NonZero<usize> {
    thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN)
}

/// Pieces of work that are on their way, and those that are done and wait for earlier ones.
pub(crate) struct Line<'w, J> {
    work: &'w (dyn Fn(&mut J) + Sync),
    threads: Option<Threads<J>>,
    /// Pieces to be used again.
    spare: Vec<J>,
}

struct Threads<J> {
    jobs: SyncSender<(u64, J)>,
    /// What is done; nothing where a thread has panicked.
    done: Receiver<Option<(u64, J)>>,
    waiting: BTreeMap<u64, J>,
    handed_out: u64,
    taken: u64,
    /// No more pieces than this are on their way.
    most: u64,
}

/// Runs `body` beside `threads` − 1 threads that do the pieces of work that it hands to the line;
/// with one thread it does them itself.
pub(crate) fn in_order<J: Default + Send, T>(
    threads: NonZero<usize>,
    work: impl Fn(&mut J) + Sync,
    body: impl FnOnce(&mut Line<'_, J>) -> T,
) -> T {
    let workers = threads.get() - 1;
    let mut line = Line {
        work: &work,
        threads: None,
        spare: Vec::new(),
    };
    if workers == 0 {
        return body(&mut line);
    }
    thread::scope(|scope| {
        let (jobs, queue) = mpsc::sync_channel::<(u64, J)>(workers);
        let (finished, done) = mpsc::channel();
        let queue = std::sync::Arc::new(Mutex::new(queue));
        for _ in 0..workers {
            let (queue, finished, work) = (queue.clone(), finished.clone(), &work);
            scope.spawn(move || {
                loop {
                    let next = queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
                    let Ok((number, mut job)) = next else { return };
                    let worked = panic::catch_unwind(AssertUnwindSafe(|| work(&mut job)));
                    // The others must not wait for what will not come.
                    let told = finished.send(worked.is_ok().then_some((number, job)));
                    if let Err(cause) = worked {
                        panic::resume_unwind(cause);
                    }
                    if told.is_err() {
                        return;
                    }
                }
            });
        }
        drop((queue, finished));
        line.threads = Some(Threads {
            jobs,
            done,
            waiting: BTreeMap::new(),
            handed_out: 0,
            taken: 0,
            most: 4 * workers as u64,
        });
        let told = body(&mut line);
        // Nothing more is handed out: the threads end.
        drop(line);
        told
    })
}

impl<J: Default> Line<'_, J> {
    /// A piece that is to be filled: a new one, or one that has been used.
    pub(crate) fn piece(&mut self) -> J {
        self.spare.pop().unwrap_or_default()
    }

    /// Hands a piece to the threads. `take` gets what is done, in the order in which it came.
    pub(crate) fn hand_on(
        &mut self,
        mut piece: J,
        take: &mut dyn FnMut(&mut J) -> io::Result<()>,
    ) -> io::Result<()> {
        let Some(threads) = &mut self.threads else {
            (self.work)(&mut piece);
            take(&mut piece)?;
            self.spare.push(piece);
            return Ok(());
        };
        // A thread that panicked has hung up; the scope hands its panic on.
        let handed = threads.jobs.send((threads.handed_out, piece));
        handed.map_err(|_| io::Error::other("a thread has ended"))?;
        threads.handed_out += 1;
        let most = threads.most;
        self.take_until(most, take)
    }

    /// Waits for all pieces.
    pub(crate) fn finish(
        &mut self,
        take: &mut dyn FnMut(&mut J) -> io::Result<()>,
    ) -> io::Result<()> {
        self.take_until(0, take)
    }

    /// Takes what is done, and waits while more than `most` pieces are on their way.
    fn take_until(
        &mut self,
        most: u64,
        take: &mut dyn FnMut(&mut J) -> io::Result<()>,
    ) -> io::Result<()> {
        let Some(threads) = &mut self.threads else {
            return Ok(());
        };
        while threads.handed_out - threads.taken > most {
            if let Some(mut piece) = threads.waiting.remove(&threads.taken) {
                threads.taken += 1;
                take(&mut piece)?;
                self.spare.push(piece);
                continue;
            }
            match threads.done.recv() {
                Ok(Some((number, piece))) => {
                    threads.waiting.insert(number, piece);
                }
                Ok(None) | Err(_) => return Err(io::Error::other("a thread has ended")),
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_on_any_number_of_threads() {
        for threads in [1, 2, 5] {
            let square = |(number, result): &mut (u64, u64)| {
                if *number % 7 == 0 {
                    thread::yield_now();
                }
                *result = *number * *number;
            };
            let mut results = Vec::new();
            let threads = NonZero::new(threads).unwrap();
            in_order(threads, square, |line| {
                let mut take = |piece: &mut (u64, u64)| {
                    results.push(piece.1);
                    Ok(())
                };
                for number in 0..1000 {
                    let mut piece = line.piece();
                    piece.0 = number;
                    line.hand_on(piece, &mut take).unwrap();
                }
                line.finish(&mut take).unwrap();
            });
            let expected: Vec<u64> = (0..1000).map(|number| number * number).collect();
            assert_eq!(results, expected);
        }
    }

    #[test]
    fn what_fails_ends_the_work() {
        let threads = NonZero::new(3).unwrap();
        let failed = in_order(
            threads,
            |_: &mut u64| {},
            |line| {
                let mut take = |_: &mut u64| Err(io::ErrorKind::StorageFull.into());
                (0..100).try_for_each(|number| line.hand_on(number, &mut take))
            },
        );
        assert_eq!(failed.unwrap_err().kind(), io::ErrorKind::StorageFull);
    }
    #[test]
    #[should_panic(expected = "scoped thread panicked")]
    fn a_panic_ends_the_work() {
        let work = |number: &mut u64| assert!(*number != 50);
        in_order(NonZero::new(3).unwrap(), work, |line| {
            let failed = (0..10_000).try_for_each(|number| line.hand_on(number, &mut |_| Ok(())));
            assert!(failed.is_err());
        });
    }
}
