//! Frames of a film: each is a picture of `kfrac grow`, drawn on a thread of its own.

use std::num::NonZero;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::cli::held::{Done, Held, Survey};
use crate::parallel::with_team;
use crate::render::{PngEncoding, Spares};

use super::super::{Failure, grow};

/// Largest number of bytes of a frame.
const MAX_BYTES: usize = 1 << 30;

/// Rule of a film, with the arguments of every frame.
pub(super) struct Frames<'a> {
    pub(super) runs: grow::Runs<'a>,
    /// Arguments of `kfrac grow`, by frame.
    pub(super) arguments: Vec<Vec<String>>,
    pub(super) threads: NonZero<usize>,
    /// Number of frames that have been drawn.
    pub(super) drawn: AtomicU32,
    /// Memory of finished frames, for those that follow.
    pub(super) spares: Spares,
}

/// Purpose for which frames are grown.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Purpose {
    /// Pixels without an encoding.
    Pixels,
    /// PNGs, as `kfrac grow` writes them.
    Png,
    /// Lines, as SVG.
    Lines,
    /// Numbers of the pictures.
    Survey,
    /// Numbers of PNGs, with their provenance.
    PngSurvey,
}

/// Frame that is drawn by any thread.
struct Job<'f> {
    frames: &'f Frames<'f>,
    number: usize,
    purpose: Purpose,
    more: &'f [String],
    /// The frame, once it is drawn; until then, memory for it.
    done: Done,
    failure: Option<Failure>,
}

impl Frames<'_> {
    /// Draws frames, with more arguments, and passes them on in their order.
    pub(super) fn draw(
        &self,
        numbers: impl IntoIterator<Item = usize>,
        purpose: Purpose,
        more: &[String],
        mut take: impl FnMut(usize, &mut Done) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        with_team(self.threads, |team| {
            let mut line = team.line(Job::run);
            let mut take = |job: &mut Job<'_>| {
                job.failure.take().map_or(Ok(()), Err)?;
                self.drawn.fetch_add(1, Ordering::Relaxed);
                take(job.number, &mut job.done)
            };
            for number in numbers {
                let job = Job {
                    frames: self,
                    number,
                    purpose,
                    more,
                    done: line.spare().map_or_else(Done::default, |job| job.done),
                    failure: None,
                };
                line.hand_on(job, &mut take)?;
            }
            line.finish(&mut take)
        })
    }
}

impl Job<'_> {
    fn run(&mut self) {
        self.failure = self.grow().err();
    }

    fn grow(&mut self) -> Result<(), Failure> {
        let frames = self.frames;
        let encoding = match self.purpose {
            Purpose::Png | Purpose::PngSurvey => PngEncoding::default(),
            Purpose::Pixels | Purpose::Lines | Purpose::Survey => PngEncoding::raw(),
        };
        let mut held = Held::new(MAX_BYTES, encoding);
        held.survey = match self.purpose {
            Purpose::Survey => Some(Survey::Place),
            Purpose::PngSurvey => Some(Survey::Provenance),
            Purpose::Pixels | Purpose::Png | Purpose::Lines => None,
        };
        held.spares = frames.spares.clone();
        let held = held.in_place_of(std::mem::take(&mut self.done.bytes));
        let held = Arc::new(held);
        let mut arguments = [&frames.arguments[self.number], self.more].concat();
        if self.purpose == Purpose::Lines {
            arguments.push("--format=svg".into());
        } else {
            arguments.retain(|it| !it.starts_with("--svg="));
            arguments.push("--format=png".into());
        }
        match frames.runs.hold(&arguments, Arc::clone(&held)) {
            // A frame may be empty where others are not.
            Err(failure) if self.purpose == Purpose::Survey && failure.draws_nothing() => {}
            held => held?,
        }
        self.done = held.take();
        Ok(())
    }
}
