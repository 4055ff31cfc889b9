//! Frames of a film: each is a picture of `kfrac grow`, drawn on a thread of its own.

use std::num::NonZero;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::catalogue::Catalogue;
use crate::cli::held::{Done, Held};
use crate::diagnostic::Source;
use crate::parallel::with_team;
use crate::render::PngEncoding;

use super::super::{Failure, grow};

/// Largest number of bytes of a frame.
const MAX_BYTES: usize = 1 << 30;

/// Rule of a film, with the arguments of every frame.
pub(super) struct Frames<'a> {
    pub(super) catalogue: &'a Catalogue,
    pub(super) source: Arc<Source>,
    /// Arguments of `kfrac grow`, by frame.
    pub(super) arguments: Vec<Vec<String>>,
    pub(super) threads: NonZero<usize>,
    /// Number of frames that have been drawn.
    pub(super) drawn: AtomicU32,
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
    /// Numbers of the pictures, without pixels in the plane.
    Survey,
}

/// Frame that is drawn by any thread.
struct Job<'f> {
    frames: &'f Frames<'f>,
    number: usize,
    purpose: Purpose,
    more: &'f [String],
    result: Option<Result<Done, Failure>>,
}

impl Frames<'_> {
    /// Draws frames, with more arguments, and passes them on in their order.
    pub(super) fn draw(
        &self,
        numbers: impl IntoIterator<Item = usize>,
        purpose: Purpose,
        more: &[String],
        mut take: impl FnMut(usize, Done) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        with_team(self.threads, |team| {
            let mut line = team.line(Job::run);
            let mut take = |job: &mut Job<'_>| match job.result.take() {
                Some(result) => {
                    let done = result?;
                    self.drawn.fetch_add(1, Ordering::Relaxed);
                    take(job.number, done)
                }
                None => Ok(()),
            };
            for number in numbers {
                let job = Job {
                    frames: self,
                    number,
                    purpose,
                    more,
                    result: None,
                };
                line.hand_on(job, &mut take)?;
            }
            line.finish(&mut take)
        })
    }

    fn grow(&self, number: usize, purpose: Purpose, more: &[String]) -> Result<Done, Failure> {
        let encoding = match purpose {
            Purpose::Png => PngEncoding::default(),
            Purpose::Pixels | Purpose::Lines | Purpose::Survey => PngEncoding::raw(),
        };
        let mut held = Held::new(MAX_BYTES, encoding);
        held.surveys = purpose == Purpose::Survey;
        let held = Arc::new(held);
        let mut arguments = [&self.arguments[number], more].concat();
        if purpose == Purpose::Lines {
            arguments.push("--format=svg".into());
        } else {
            arguments.retain(|it| !it.starts_with("--svg="));
            arguments.push("--format=png".into());
        }
        grow::hold(&arguments, &self.source, self.catalogue, Arc::clone(&held))?;
        Ok(held.take())
    }
}

impl Job<'_> {
    fn run(&mut self) {
        self.result = Some(self.frames.grow(self.number, self.purpose, self.more));
    }
}
