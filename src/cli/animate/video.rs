//! Films by ffmpeg: frames go in, and the file comes out through pipes.

use std::io::{self, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;

use crate::film::{FilmEncoder, FilmOptions, Y4m};

/// Encoder of a film by the program ffmpeg.
pub(super) struct Video<'o> {
    out: &'o mut dyn Write,
    frames: Option<Y4m<ChildStdin>>,
    encoder: Child,
    /// Parts of the file, and errors of reading them.
    file: Receiver<io::Result<Vec<u8>>>,
    messages: Receiver<String>,
}

impl<'o> Video<'o> {
    /// Begins a film: MP4 with H.264, or WebM with VP9.
    pub(super) fn begin(
        out: &'o mut dyn Write,
        options: &FilmOptions,
        is_mp4: bool,
    ) -> io::Result<Self> {
        // A pipe has no places to go back to, hence fragments.
        let format: &[&str] = match is_mp4 {
            true => &[
                "-c:v",
                "libx264",
                "-crf",
                "18",
                "-movflags",
                "frag_keyframe+empty_moov+default_base_moof",
                "-f",
                "mp4",
            ],
            false => &[
                "-c:v",
                "libvpx-vp9",
                "-crf",
                "24",
                "-b:v",
                "0",
                "-f",
                "webm",
            ],
        };
        let mut encoder = Command::new("ffmpeg")
            .args(["-hide_banner", "-loglevel", "error", "-f", "yuv4mpegpipe", "-i", "-"])
            // Players expect halved chroma, which needs even sides.
            .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p"])
            .args(["-metadata", &format!("title={}", options.labels.title)])
            .args(["-fflags", "+bitexact", "-flags:v", "+bitexact"])
            .args(format)
            .arg("-")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| match error.kind() {
                io::ErrorKind::NotFound => io::Error::other(
                    "the program ffmpeg is not installed; without it, pipe the frames to an encoder: kfrac animate … -o - | ENCODER",
                ),
                _ => error,
            })?;
        let gone = || io::Error::other("ffmpeg has no pipes");
        let input = encoder.stdin.take().ok_or_else(gone)?;
        let output = encoder.stdout.take().ok_or_else(gone)?;
        let mut errors = encoder.stderr.take().ok_or_else(gone)?;
        let (send, messages) = mpsc::channel();
        thread::spawn(move || {
            let mut text = String::new();
            let _ = errors.read_to_string(&mut text);
            let _ = send.send(text);
        });
        Ok(Self {
            out,
            frames: Some(Y4m::begin(input, options)?),
            file: parts(output),
            encoder,
            messages,
        })
    }

    /// Writes a part of the file.
    fn take(&mut self, part: io::Result<Vec<u8>>) -> io::Result<()> {
        self.out.write_all(&part?)
    }

    /// Returns the reason why ffmpeg has ended too early.
    fn reason(&mut self) -> io::Error {
        let text = self.messages.recv().unwrap_or_default();
        let first = text.lines().next().unwrap_or("it has ended too early");
        io::Error::other(format!("ffmpeg: {first}"))
    }
}

/// Reads a pipe in parts, on a thread of its own.
fn parts(mut pipe: impl Read + Send + 'static) -> Receiver<io::Result<Vec<u8>>> {
    let (send, parts) = mpsc::channel();
    thread::spawn(move || {
        let mut buffer = vec![0; 1 << 16];
        loop {
            let part = match pipe.read(&mut buffer) {
                Ok(0) => return,
                Ok(count) => Ok(buffer[..count].to_vec()),
                Err(error) => Err(error),
            };
            let is_over = part.is_err();
            if send.send(part).is_err() || is_over {
                return;
            }
        }
    });
    parts
}

impl FilmEncoder for Video<'_> {
    fn add(&mut self, pixels: &[u8]) -> io::Result<()> {
        let added = { self.frames.as_mut() }.map_or(Ok(()), |frames| frames.add(pixels));
        if added.is_err() {
            self.frames = None;
            return Err(self.reason());
        }
        while let Ok(part) = self.file.try_recv() {
            self.take(part)?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        // The end of the pipe is the end of the film.
        self.frames = None;
        while let Ok(part) = self.file.recv() {
            self.take(part)?;
        }
        match self.encoder.wait()?.success() {
            true => Ok(()),
            false => Err(self.reason()),
        }
    }
}

impl Drop for Video<'_> {
    fn drop(&mut self) {
        // A film that has failed leaves no program behind.
        let _ = self.encoder.kill();
        let _ = self.encoder.wait();
    }
}
