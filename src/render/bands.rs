//! Pictures larger than memory: drawn in bands of some rows, one after another, and encoded as
//! they come.
//!
//! Every band is a walk that leaves out what lies outside, where walks can. All bands are drawn
//! twice, first to see which colours there are: these decide how pixels are written. The bytes do
//! not depend on the height of bands, so long as no path that is left to tiny-skia is so long that
//! it is drawn in pieces.

use std::io::{self, Write};
use std::ops::Range;
use std::sync::atomic::Ordering::Relaxed;

use crate::grow::{Growth, Progress, WalkError};
use crate::parallel::with_team;
use crate::style::Width;

use super::png::{BAND_ROWS, Colours, Pixmap, Png, Spare, encode_pieces};
use super::sight::Sight;
use super::survey::overhang;
use super::{Canvas, Drawing, Options, RenderError, Scene, Survey};

/// A picture that is drawn in bands.
pub(super) struct Bands<'a> {
    survey: &'a Survey<'a>,
    growth: Growth<'a>,
    /// Counts pixels, for elements are met again in every band.
    progress: Option<&'a Progress>,
    canvas: Canvas,
    options: &'a Options,
    sight: Sight,
    /// The pixels beyond a band that show in it.
    pad: f64,
    /// The rows of a band.
    rows: u32,
}

impl<'a> Bands<'a> {
    /// Bands of what a survey has seen, of no more pixels each than memory should hold.
    pub(super) fn new(
        survey: &'a Survey<'a>,
        growth: &Growth<'a>,
        canvas: Canvas,
        options: &'a Options,
    ) -> Self {
        let style = &options.style;
        let stroke = match style.width {
            Width::Pixels(width) => width * overhang(style),
            Width::Relative(_) => 0.0,
        };
        // What comes near a pixel tinges it.
        let pad = stroke + 1.0;
        let all = canvas.shown(pad);
        let sight = survey.sight().clone();
        let sight = sight.within(&all, survey.graph(), growth, style, survey.counts_ranks());
        let [width, height] = canvas.size();
        let rows = (options.band / u64::from(width)).clamp(1, height.into());
        let rows = u32::try_from(rows).unwrap_or(height);
        Self {
            survey,
            growth: Growth {
                progress: None,
                ..*growth
            },
            progress: growth.progress,
            canvas,
            options,
            sight,
            pad,
            rows: rows.next_multiple_of(BAND_ROWS),
        }
    }

    /// Draws and encodes them.
    pub(super) fn write(&self, out: &mut impl Write) -> Result<(), RenderError> {
        let Options { style, labels, .. } = self.options;
        let size = self.canvas.size();
        if let Some(progress) = self.progress {
            let [width, height] = size.map(u64::from);
            let survey = u64::from(self.survey.walked) * self.survey.elements;
            progress.expect(2 * width * height + survey);
        }
        let mut colours = Colours::none();
        let on_opaque = style.background.is_some_and(|it| it == it.opaque());
        let mut spare = Spare::default();
        for rows in self.each() {
            if colours.are_settled(on_opaque) {
                self.count(&rows);
            } else {
                self.draw(rows, &mut spare, &mut |pixels| {
                    colours.add(pixels);
                    Ok(())
                })?;
            }
        }
        let colours = colours.sorted();
        let mut out = Told { out, error: None };
        let encoded = encode_pieces(size, &colours, labels, &mut out, |encode| {
            self.each()
                .try_for_each(|rows| self.draw(rows, &mut spare, encode))
        });
        match out.error {
            Some(error) => Err(error.into()),
            None => encoded,
        }
    }

    /// The rows of every band.
    fn each(&self) -> impl Iterator<Item = Range<u32>> {
        let [_, height] = self.canvas.size();
        let tops = (0..height).step_by(self.rows as usize);
        tops.map(move |top| top..top.saturating_add(self.rows).min(height))
    }

    /// Draws a band and gives its pixels.
    fn draw(
        &self,
        rows: Range<u32>,
        spare: &mut Spare,
        give: &mut dyn FnMut(&Pixmap) -> io::Result<()>,
    ) -> Result<(), RenderError> {
        // A walk over little would not look.
        if self.growth.cancel.is_some_and(|it| it.load(Relaxed)) {
            return Err(RenderError::Walk(WalkError::Cancelled));
        }
        let shown = self.canvas.shown_in(rows.clone(), self.pad);
        let survey = self.survey.clone();
        let survey = survey.of_what_is_in(self.sight.moved_to(&shown));
        let scene = Scene::new(&survey, &self.growth, self.canvas);
        let (size, background) = (scene.size(), scene.background());
        let used = std::mem::take(spare);
        let (pixels, unused) = with_team(self.options.threads, |team| {
            let mut png = Png::begin_band(size, rows.clone(), background, used, team)?;
            scene.draw(&mut png, team)?;
            Ok::<_, RenderError>(png.into_pixels())
        })?;
        *spare = unused;
        self.count(&rows);
        Ok(give(&pixels)?)
    }

    fn count(&self, rows: &Range<u32>) {
        if let Some(progress) = self.progress {
            let [width, _] = self.canvas.size();
            progress.count(u64::from(width) * u64::from(rows.end - rows.start));
        }
    }
}

/// Keeps why it cannot be written to: an encoder would not tell.
struct Told<W> {
    out: W,
    error: Option<io::Error>,
}

impl<W: Write> Write for Told<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes).map_err(|error| {
            let kind = error.kind();
            self.error = Some(error);
            kind.into()
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
