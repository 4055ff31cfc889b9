//! Animated GIF with one palette for all frames: their own colours if there are at most 256, else the nearest of 256
//! that are chosen from all over the film, without dithering.

use std::collections::BTreeSet;
use std::io::{self, Read, Write};
use std::ops::Range;

use color_quant::NeuQuant;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use gif::{AnyExtension, DisposalMethod, Encoder, Frame, Repeat};

use super::{FilmEncoder, FilmOptions, changed, failed, on_white, rows, runs};
use crate::fast_hash::FastMap;
use crate::output_file::OutputFile;

/// Largest size of all frames together that wait for the palette in memory, compressed.
const MAX_HELD: usize = 1 << 23;

/// Number of pixels from which a palette is chosen.
const SAMPLES: usize = 1 << 20;

/// Number of frames from which a palette is chosen.
const SAMPLED_FRAMES: usize = 24;

/// Largest number of colours of a palette.
const COLOURS: usize = 256;

/// Largest number of frames a second; programs show faster films slowly.
const MAX_RATE: u32 = 50;

type Rgba = [u8; 4];

/// Encoder of an animated GIF.
pub(crate) struct Gif<W> {
    out: W,
    options: FilmOptions,
    spool: Spool,
    /// Colours of all frames, while they are few.
    few: Option<BTreeSet<Rgba>>,
}

/// Compressed frames that wait for the palette: in memory, or if they are many in a temporary file.
struct Spool {
    /// Number of bytes above which they lie in the file.
    most: usize,
    held: Vec<u8>,
    file: Option<OutputFile>,
    /// Places of the frames in memory or in the file.
    places: Vec<Range<usize>>,
}

impl Spool {
    fn new(most: usize) -> Self {
        Self {
            most,
            held: Vec::new(),
            file: None,
            places: Vec::new(),
        }
    }

    fn add(&mut self, pixels: &[u8]) -> io::Result<()> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(pixels)?;
        let frame = encoder.finish()?;
        let start = self.places.last().map_or(0, |place| place.end);
        let end = start + frame.len();
        if self.file.is_none() && end > self.most {
            let mut file = OutputFile::temporary()?;
            file.write_all(&std::mem::take(&mut self.held))?;
            self.file = Some(file);
        }
        match &mut self.file {
            Some(file) => file.write_all(&frame)?,
            None => self.held.extend_from_slice(&frame),
        }
        self.places.push(start..end);
        Ok(())
    }

    fn pixels(&mut self, number: usize) -> io::Result<Vec<u8>> {
        let place = self.places[number].clone();
        let mut read = Vec::new();
        let frame = match &mut self.file {
            Some(file) => {
                read.resize(place.len(), 0);
                file.read_at(place.start as u64, &mut read)?;
                &read
            }
            None => &self.held[place],
        };
        let mut pixels = Vec::new();
        ZlibDecoder::new(frame).read_to_end(&mut pixels)?;
        Ok(pixels)
    }

    /// Returns pixels from all over the film.
    fn samples(&mut self, size: [u32; 2]) -> io::Result<Vec<u8>> {
        let step = self.places.len().div_ceil(SAMPLED_FRAMES).max(1);
        let numbers = (0..self.places.len()).step_by(step);
        let [width, height] = size.map(|side| side as usize);
        let apart = (width * height * numbers.len()).div_ceil(SAMPLES).max(1);
        let mut samples = Vec::new();
        for number in numbers {
            let pixels = self.pixels(number)?;
            let seen = pixels.as_chunks::<4>().0.iter();
            let seen = seen.skip(number % apart).step_by(apart);
            samples.extend(seen.filter(|pixel| pixel[3] != 0).flatten());
        }
        Ok(samples)
    }
}

/// Colours of a film.
struct Palette {
    /// Colours; the empty one, if there is one, is the last.
    colours: Vec<Rgba>,
    /// Chosen colours, if the film has more.
    chosen: Option<NeuQuant>,
    /// Known indices.
    known: FastMap<u32, u8>,
}

impl Palette {
    /// Returns the palette of few colours.
    fn exact(few: &BTreeSet<Rgba>) -> Self {
        let mut colours: Vec<Rgba> = few.iter().copied().collect();
        colours.sort_by_key(|colour| (colour[3] == 0, *colour));
        let numbers = (0..=u8::MAX).zip(&colours);
        Self {
            known: numbers
                .map(|(number, colour)| (u32::from_le_bytes(*colour), number))
                .collect(),
            colours,
            chosen: None,
        }
    }

    /// Returns a palette that is near to the colours of pixels.
    fn nearest(samples: &[u8], is_opaque: bool) -> Self {
        let count = COLOURS - usize::from(!is_opaque);
        let chosen = NeuQuant::new(1, count, samples);
        let map = chosen.color_map_rgba();
        let mut colours: Vec<Rgba> = map.as_chunks::<4>().0.to_vec();
        colours.truncate(count);
        let mut known = FastMap::default();
        if !is_opaque {
            known.insert(0, u8::try_from(colours.len()).unwrap_or(u8::MAX));
            colours.push([0; 4]);
        }
        Self {
            colours,
            chosen: Some(chosen),
            known,
        }
    }

    fn index(&mut self, colour: Rgba) -> u8 {
        let key = u32::from_le_bytes(colour);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let found = { self.chosen.as_ref() }.map_or(0, |chosen| chosen.index_of(&colour));
        let found = u8::try_from(found).unwrap_or_default();
        self.known.insert(key, found);
        found
    }

    /// Returns the index of the empty colour.
    fn empty(&self) -> Option<u8> {
        let last = self.colours.len().checked_sub(1)?;
        let is_empty = self.colours[last][3] == 0;
        u8::try_from(last).ok().filter(|_| is_empty)
    }
}

impl<W: Write> Gif<W> {
    /// Begins a film.
    pub(crate) fn begin(out: W, options: &FilmOptions) -> io::Result<Self> {
        if { options.size.iter() }.any(|side| u16::try_from(*side).is_err()) {
            return Err(failed("a GIF has up to 65535 pixels a side"));
        }
        if options.rate.frames > MAX_RATE * options.rate.seconds {
            return Err(failed(format!(
                "a GIF has up to {MAX_RATE} frames a second"
            )));
        }
        Ok(Self {
            out,
            options: options.clone(),
            spool: Spool::new(MAX_HELD),
            few: Some(BTreeSet::new()),
        })
    }
}

impl<W: Write> FilmEncoder for Gif<W> {
    fn add(&mut self, pixels: &[u8]) -> io::Result<()> {
        let is_opaque = self.options.is_opaque;
        let mut own: Vec<Rgba> = Vec::with_capacity(pixels.len() / 4);
        for run in runs(pixels) {
            let shown = match is_opaque || run[0][3] >= 128 {
                true => {
                    let [red, green, blue] = on_white(run[0]);
                    [red, green, blue, 255]
                }
                false => [0; 4],
            };
            own.resize(own.len() + run.len(), shown);
            if let Some(few) = &mut self.few {
                few.insert(shown);
                self.few.take_if(|few| few.len() > COLOURS);
            }
        }
        self.spool.add(own.as_flattened())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        let Self {
            mut out,
            options,
            mut spool,
            few,
        } = *self;
        let mut palette = match &few {
            Some(few) => Palette::exact(few),
            None => Palette::nearest(&spool.samples(options.size)?, options.is_opaque),
        };
        let empty = palette.empty();
        let colours: Vec<u8> = { palette.colours.iter() }
            .flat_map(|colour| &colour[..3])
            .copied()
            .collect();
        let [width, height] = options.size;
        let mut encoder =
            Encoder::new(&mut out, narrow(width), narrow(height), &colours).map_err(failed)?;
        if options.repeats {
            encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
        }
        for (_, text) in options.labels.texts() {
            let parts: Vec<&[u8]> = text.as_bytes().chunks(255).collect();
            let written = encoder.write_raw_extension(AnyExtension(0xFE), &parts);
            written.map_err(failed)?;
        }
        let mut before: Option<Vec<u8>> = None;
        for number in 0..spool.places.len() {
            let pixels = spool.pixels(number)?;
            let area = match &before {
                // An empty pixel keeps that of the frame before, which is therefore taken away as a whole.
                Some(before) if empty.is_none() => changed(before, &pixels, width),
                _ => [0, 0, width, height],
            };
            let mut indices = Vec::new();
            for run in rows(&pixels, width, area).flat_map(runs) {
                indices.resize(indices.len() + run.len(), palette.index(run[0]));
            }
            let frame = u32::try_from(number).unwrap_or(u32::MAX);
            let [start, end] = [frame, frame + 1].map(|it| options.rate.hundredths(it));
            let [left, top, across, down] = area.map(narrow);
            let frame = Frame {
                delay: u16::try_from(end - start).unwrap_or(u16::MAX),
                dispose: match empty {
                    Some(_) => DisposalMethod::Background,
                    None => DisposalMethod::Keep,
                },
                transparent: empty,
                left,
                top,
                width: across,
                height: down,
                buffer: indices.into(),
                ..Frame::default()
            };
            encoder.write_frame(&frame).map_err(failed)?;
            before = Some(pixels);
        }
        drop(encoder);
        out.flush()
    }
}

/// Returns a side that has been found to fit.
fn narrow(side: u32) -> u16 {
    u16::try_from(side).unwrap_or(u16::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Rate;
    use crate::render::Labels;

    const SIZE: [u32; 2] = [40, 30];

    fn options(frames: u32, is_opaque: bool) -> FilmOptions {
        FilmOptions {
            size: SIZE,
            frames,
            rate: Rate {
                frames: 30,
                seconds: 1,
            },
            repeats: true,
            is_opaque,
            labels: Labels::default(),
        }
    }

    /// Returns the frames that a reader shows.
    fn shown(bytes: &[u8]) -> Vec<Vec<u8>> {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).unwrap();
        let mut screen = vec![0; 4 * 40 * 30];
        let mut all = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            if frame.dispose == DisposalMethod::Background {
                screen.fill(0);
            }
            let stride = 4 * usize::from(frame.width);
            for (row, pixels) in frame.buffer.chunks_exact(stride).enumerate() {
                let at = 4 * (40 * (row + usize::from(frame.top)) + usize::from(frame.left));
                screen[at..at + stride].copy_from_slice(pixels);
            }
            all.push(screen.clone());
        }
        all
    }

    fn film(frames: &[Vec<u8>], is_opaque: bool) -> Vec<u8> {
        spooled(frames, is_opaque, MAX_HELD)
    }

    /// Returns a film of whose frames up to a number of bytes wait in memory.
    fn spooled(frames: &[Vec<u8>], is_opaque: bool, most: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        let count = u32::try_from(frames.len()).unwrap();
        let mut gif = Gif::begin(&mut bytes, &options(count, is_opaque)).unwrap();
        gif.spool = Spool::new(most);
        frames.iter().for_each(|frame| gif.add(frame).unwrap());
        Box::new(gif).finish().unwrap();
        bytes
    }

    fn frames(colour: impl Fn(usize, usize) -> Rgba) -> Vec<Vec<u8>> {
        let frame = |number| (0..40 * 30).flat_map(|at| colour(number, at)).collect();
        (0..5).map(frame).collect()
    }

    #[test]
    fn few_colours_are_exact() {
        let grey = |number: usize, at: usize| {
            let level = u8::try_from((at * number + at / 7) % 250).unwrap();
            [level, level, level / 2, 255]
        };
        let frames = frames(grey);
        assert_eq!(shown(&film(&frames, true)), frames);
        // Parts without ink are empty where the film is not opaque.
        let spots = |number: usize, at: usize| match (at + number) % 9 {
            0 => [200, 30, 0, 255],
            _ => [0; 4],
        };
        let frames = self::frames(spots);
        assert_eq!(shown(&film(&frames, false)), frames);
    }

    #[test]
    fn many_colours_are_near() {
        let mixed = |number: usize, at: usize| {
            let part = |value: usize| u8::try_from(value % 256).unwrap();
            [
                part(6 * (at % 40)),
                part(8 * (at / 40)),
                part(40 * number),
                255,
            ]
        };
        let frames = frames(mixed);
        let shown = shown(&film(&frames, true));
        let pairs = frames.concat().into_iter().zip(shown.concat());
        let apart = pairs.map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>();
        assert!(apart / (4.0 * 40.0 * 30.0 * 5.0) < 8.0, "{apart}");
        for most in [0, 1000] {
            assert!(spooled(&frames, true, most) == film(&frames, true));
        }
    }
}
