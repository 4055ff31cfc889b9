//! Commands that run within the program: their output is held in memory, and they can be cancelled.

use std::io::{self, Write};
use std::marker::PhantomData;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::estimate::SizeEstimate;
use crate::geometry::Homothety;
use crate::render::space::Sight;
use crate::render::{Canvas, Picture, PngEncoding, Spares};

use super::Failure;

/// Destination of a command that runs within the program, in place of standard output and standard error.
#[derive(Debug, Default)]
pub(crate) struct Held {
    /// Flag that ends the command soon after it is set.
    pub(crate) cancel: Arc<AtomicBool>,
    /// Encoding of PNGs.
    pub(crate) png: PngEncoding,
    /// Largest number of bytes of standard output.
    pub(crate) most: usize,
    /// Part of the numbers of a picture for which it is grown, if it need not be drawn.
    pub(crate) survey: Option<Survey>,
    /// Memory of finished pictures, for those that follow.
    pub(crate) spares: Spares,
    done: Mutex<Done>,
}

/// Numbers for which a picture is grown. It is not drawn where they are found without.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Survey {
    /// Place, size and cost.
    Place,
    /// Text from which the picture can be made again.
    Provenance,
}

/// Results of a command beside its files.
#[derive(Clone, Debug, Default)]
pub(crate) struct Done {
    /// Content of standard output.
    pub(crate) bytes: Vec<u8>,
    /// Messages, one line each.
    pub(crate) notes: Vec<String>,
    /// Number of elements of a picture that were visited.
    pub(crate) elements: Option<u64>,
    /// Number of steps of a picture.
    pub(crate) steps: Option<u32>,
    /// Part of the plane that a picture shows, in the units of its file: lower left corner, width, height.
    pub(crate) window: Option<[f64; 4]>,
    /// Middle of a picture in space.
    pub(crate) sight: Option<Sight>,
    /// Width and height of a picture.
    pub(crate) size: [u32; 2],
    /// Cost of a picture that is surveyed, where the graph determines it.
    pub(crate) estimate: Option<SizeEstimate>,
    /// Text from which a picture that is surveyed can be made again.
    pub(crate) provenance: Option<String>,
}

impl Held {
    /// Returns a destination of `most` bytes, with an encoding of PNGs.
    pub(crate) fn new(most: usize, png: PngEncoding) -> Self {
        Self {
            most,
            png,
            ..Self::default()
        }
    }

    /// Lets the output take the place of another one.
    pub(crate) fn in_place_of(self, mut bytes: Vec<u8>) -> Self {
        bytes.clear();
        self.done().bytes = bytes;
        self
    }

    /// Takes the results of the command that has ended.
    pub(crate) fn take(&self) -> Done {
        std::mem::take(&mut *self.done())
    }

    pub(super) fn done(&self) -> MutexGuard<'_, Done> {
        self.done.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records the window of a picture. `place` maps its coordinates to those of the file.
    pub(super) fn note_window(&self, canvas: &Canvas, place: &Homothety) {
        let mut done = self.done();
        done.size = canvas.size();
        done.window = Some(place.window(canvas.window()));
    }

    /// Records what lies in the middle of a picture in space.
    pub(super) fn note_sight(&self, sight: Sight) {
        self.done().sight = Some(sight);
    }

    /// Records the numbers of a picture. `place` maps the coordinates of its graph to those of the file.
    pub(super) fn note_picture(&self, picture: &Picture, place: Option<&Homothety>) {
        let mut done = self.done();
        done.elements = Some(picture.elements);
        done.steps = Some(picture.steps);
        done.size = picture.size;
        done.window = { picture.window.zip(place) }.map(|(window, place)| place.window(window));
    }
}

/// Parser of the arguments of a command that runs within the program.
pub(super) struct Parser<A> {
    command: clap::Command,
    arguments: PhantomData<fn() -> A>,
}

impl<A: clap::Args> Parser<A> {
    pub(super) fn new(command: &'static str) -> Self {
        Self {
            command: A::augment_args(clap::Command::new(command).no_binary_name(true)),
            arguments: PhantomData,
        }
    }

    pub(super) fn parse(&mut self, arguments: &[String]) -> Result<A, Failure> {
        let matches = self.command.try_get_matches_from_mut(arguments);
        { matches.and_then(|matches| A::from_arg_matches(&matches)) }
            .map_err(|error| Failure::usage(&error))
    }
}

/// Parses the arguments of a command that runs within the program.
pub(super) fn parsed<A: clap::Args>(
    command: &'static str,
    arguments: &[String],
) -> Result<A, Failure> {
    Parser::new(command).parse(arguments)
}

/// Standard output of a command that runs within the program, of limited size.
#[derive(Debug)]
pub(super) struct Memory {
    pub(super) bytes: Vec<u8>,
    most: usize,
}

impl Memory {
    /// Returns an output in empty memory.
    pub(super) fn new(bytes: Vec<u8>, most: usize) -> Self {
        Self { bytes, most }
    }
}

impl Write for Memory {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.bytes.len() + bytes.len() > self.most {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
