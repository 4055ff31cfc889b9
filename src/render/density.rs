//! Pictures of histograms: the number of hits of every pixel in a chaos game.

mod kernel;

use std::io::Write;

use tiny_skia::{ColorU8, Pixmap, PremultipliedColorU8};

use crate::chaos::{Histogram, RandomPoints, Start, WeightedMaps};
use crate::geometry::{Bounds, DVec2};
use crate::graph::Graph;
use crate::ifs::{System, Verdict};
use crate::parallel::all_cores;
use crate::style::{Colour, Palette, Tone, View};

use super::canvas::{Canvas, Size};
use super::error::RenderError;
use super::options::Labels;
use super::options::PngEncoding;
#[cfg(feature = "cli")]
use super::pixels::Pixels;
use super::png::{Spare, Spares, TooManyPixels, write_pixels};

/// Number of parts of a hit that covers a pixel, in counts of the hits of elements.
pub(super) const UNIT: u32 = 256;

/// Colours of a picture of a histogram.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shades {
    /// One ink, with the tone as its opacity.
    Ink(Colour),
    /// Position in a palette, given by the tone; the background for pixels that are not hit.
    Palette(Palette),
    /// One ink for each class, with the tone of all classes together as opacity; inks are mixed in proportion
    /// to the hits of a pixel. The list of inks repeats for further classes.
    Classes(Vec<Colour>),
}

/// Appearance of a histogram.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Density {
    /// Mapping of hits to tones; logarithmic by default.
    pub tone: Tone,
    /// Exponent above 0: tones are raised to its inverse; 1 by default.
    pub gamma: f64,
    /// Number of bins of the histogram across a pixel, whose colours are averaged; 1 by default.
    pub oversample: u32,
    /// Radius, in pixels, over which a point that is alone in its bin is spread. That of n points is less by the factor
    /// n^(-2/5), as in the density estimation of flam3. 0, the default, spreads nothing.
    pub kernel: f64,
    /// Colours; black ink by default.
    pub shades: Shades,
    /// Colour of the background; `None` for transparency.
    pub background: Option<Colour>,
    /// Encoding of the PNG.
    pub png: PngEncoding,
}

setters!(Density {
    tone: Tone,
    gamma: f64,
    oversample: u32,
    kernel: f64,
    shades: Shades,
    background: Option<Colour>,
    png: PngEncoding,
});

impl Default for Density {
    fn default() -> Self {
        Self {
            tone: Tone::default(),
            gamma: 1.0,
            oversample: 1,
            kernel: 0.0,
            shades: Shades::Ink(Colour::BLACK),
            background: None,
            png: PngEncoding::default(),
        }
    }
}

/// Number of points from which the extent of walks is estimated.
const PILOT: usize = 20_000;

/// Largest factor of products that keep sizes, up to rounding.
const GROWS: f64 = 1.0 + 1e-9;

/// Share of points, as a divisor, that lie outside each side of the window where some are far from all others.
const FAR: usize = 200;

/// Least margin in pixels, which keeps points on the edge of the box inside the picture.
const EDGE: f64 = 1.0 / 32.0;

/// Returns the canvas for the points of random iteration: the window of the view, or else the box of the attractor and of
/// the ways to it. The box is exact where the system determines it; otherwise, and for ways from a start, it is that of some
/// thousand points, without the few that are far from all others where maps grow.
///
/// # Errors
///
/// Returns an error if the picture has no room for the box, or if the box is not finite.
pub fn density_canvas(
    source: &System,
    system: &WeightedMaps,
    start: &Start,
    view: &View,
    size: Size,
) -> Result<Canvas, RenderError> {
    if let Some(window) = view.window {
        return Ok(Canvas::of_window(window, view, size)?);
    }
    let limit = match &source.metadata().symmetry {
        Some(group) => {
            let graph = Graph::of_system(source);
            graph.with_images(&group.isometries()).limit_bounds()
        }
        None => Graph::limit_bounds_of(source),
    };
    let mut bounds = limit.unwrap_or(Bounds::EMPTY);
    if limit.is_none() || *start != Start::Attractor {
        let points = RandomPoints::new(system, start, 0).take(PILOT);
        let points: Vec<DVec2> = points.map(|point| point.place).collect();
        // If products of maps grow, few points are far from all others.
        let contraction = source.contraction();
        let grows = contraction.verdict == Verdict::Diverges && contraction.lower > GROWS;
        let cut = if grows { points.len() / FAR } else { 0 };
        for end in middle(&points, cut) {
            bounds.add(end);
        }
    }
    Ok(Canvas::fit(&bounds, size, view.pad().max(EDGE))?)
}

/// Returns the corners of the bounding box of points without a number of them at each end of both axes.
fn middle(points: &[DVec2], cut: usize) -> [DVec2; 2] {
    let ends = |coordinate: fn(&DVec2) -> f64| {
        let mut all: Vec<f64> = points.iter().map(coordinate).collect();
        all.sort_by(f64::total_cmp);
        let kept = &all[cut..all.len() - cut];
        [kept[0], kept[kept.len() - 1]]
    };
    let ([left, right], [low, high]) = (ends(|point| point.x), ends(|point| point.y));
    [DVec2::new(left, low), DVec2::new(right, high)]
}

/// Largest number of bins of all classes whose hits are spread.
pub(super) const MAX_SPREAD: usize = 1 << 26;

/// Number of hits below which colours are tabulated.
const FEW_HITS: u64 = 4096;

/// Writes a histogram as PNG.
///
/// # Errors
///
/// Returns an error if the picture exceeds the limit of memory, or if writing to `out` fails.
pub fn write_density(
    histogram: &Histogram,
    density: &Density,
    labels: &Labels,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    write_density_with(&Spares::default(), histogram, density, labels, out)
}

/// Writes a histogram as [`write_density`] does, with the memory of finished pictures.
pub(crate) fn write_density_with(
    spares: &Spares,
    histogram: &Histogram,
    density: &Density,
    labels: &Labels,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    let pixmap = pixmap(spares, histogram, density)?;
    write_pixels(&pixmap, labels, density.png, out)?;
    spares.put(Spare::of_pixels(pixmap));
    Ok(())
}

/// Returns the pixels that [`write_density`] writes.
#[cfg(feature = "cli")]
pub(crate) fn density_pixels(
    histogram: &Histogram,
    density: &Density,
) -> Result<Pixels, RenderError> {
    let pixmap = pixmap(&Spares::default(), histogram, density)?;
    Ok(Pixels::of(pixmap))
}

/// Paints a histogram, in the memory of a finished picture if there is one.
fn pixmap(
    spares: &Spares,
    histogram: &Histogram,
    density: &Density,
) -> Result<Pixmap, RenderError> {
    let size @ [width, height] = histogram.size();
    let mut pixmap = { spares.take().take_pixels(size) }
        .or_else(|| Pixmap::new(width, height))
        .ok_or(TooManyPixels { size })?;
    let classes: Vec<_> = (0..histogram.classes())
        .map(|class| histogram.counts(class))
        .collect();
    let classes = classes.as_slice();
    let radius = density.kernel * f64::from(density.oversample);
    match classes {
        _ if radius > 0.0 => {
            let bins: usize = classes.iter().map(|counts| counts.len()).sum();
            if bins > MAX_SPREAD {
                return Err(RenderError::TooManyToSpread { bins });
            }
            let size = size.map(|side| side as usize);
            let spread = kernel::spread(size, classes, radius, all_cores().get());
            let count = classes.len();
            let hits = |place: usize| spread[place * count..][..count].iter().copied();
            paint(&mut pixmap, density, kernel::WEIGHT, hits);
        }
        [counts] => paint(&mut pixmap, density, 1, |place| {
            [u64::from(counts[place])].into_iter()
        }),
        _ => paint(&mut pixmap, density, 1, |place| {
            classes.iter().map(move |counts| u64::from(counts[place]))
        }),
    }
    match density.oversample {
        0 | 1 => Ok(pixmap),
        side => Ok(averaged(&pixmap, side)?),
    }
}

/// Paints every pixel by its hits in 1/[`UNIT`].
pub(super) fn painted(pixmap: &mut Pixmap, density: &Density, hits: &[u32]) {
    paint(pixmap, density, UNIT, |place| {
        [u64::from(hits[place])].into_iter()
    });
}

/// Returns the picture whose pixels are the means of squares of pixels. Sides that are no multiples lose their last pixels.
fn averaged(bins: &Pixmap, side: u32) -> Result<Pixmap, TooManyPixels> {
    let size @ [width, height] = [bins.width(), bins.height()].map(|length| length / side);
    let mut pixmap = Pixmap::new(width, height).ok_or(TooManyPixels { size })?;
    let [across, step, columns] = [bins.width(), side, width].map(|count| count as usize);
    let count = side * side;
    for (place, pixel) in pixmap.pixels_mut().iter_mut().enumerate() {
        let first = place / columns * step * across + place % columns * step;
        let mut sums = [0; 4];
        for row in bins.pixels()[first..].chunks(across).take(step) {
            for bin in &row[..step] {
                let channels = [bin.red(), bin.green(), bin.blue(), bin.alpha()];
                for (sum, channel) in sums.iter_mut().zip(channels) {
                    *sum += u32::from(channel);
                }
            }
        }
        let mean = |sum: u32| byte(((sum + count / 2) / count).into());
        let [red, green, blue, alpha] = sums.map(mean);
        *pixel = PremultipliedColorU8::from_rgba(red, green, blue, alpha).unwrap_or(*pixel);
    }
    Ok(pixmap)
}

/// Paints every pixel. `hits` returns the numbers of hits of a pixel in 1/`unit`, for every class.
fn paint<I: Iterator<Item = u64>>(
    pixmap: &mut Pixmap,
    density: &Density,
    unit: u32,
    hits: impl Fn(usize) -> I,
) {
    let pixels = pixmap.pixels_mut();
    let sum = |place: usize| hits(place).sum::<u64>();
    let most = (0..pixels.len()).map(sum).max().unwrap_or(0);
    let colours = colours(density).map(premultiplied);
    #[expect(clippy::cast_precision_loss, reason = "a tone has 255 steps")]
    let whole = |count: u64| count as f64 / f64::from(unit);
    let level = |all: u64| match all {
        0 => 0,
        _ => level(density.tone_of(whole(all), whole(most))),
    };
    let few: Vec<_> = (0..most.saturating_add(1).min(FEW_HITS))
        .map(|all| (level(all), colours[usize::from(level(all))]))
        .collect();
    for (place, pixel) in pixels.iter_mut().enumerate() {
        let all = sum(place);
        let known = usize::try_from(all).ok().and_then(|all| few.get(all));
        *pixel = match (&density.shades, known) {
            (Shades::Classes(inks), _) if all > 0 && !inks.is_empty() => {
                let ink = mean(hits(place).zip(inks.iter().cycle()), all);
                let level = known.map_or_else(|| level(all), |(level, _)| *level);
                premultiplied(laid_on(density.background, ink, level))
            }
            (_, Some((_, colour))) => *colour,
            (_, None) => colours[usize::from(level(all))],
        };
    }
}

impl Density {
    /// Returns the tone of a number of hits, where `most` is the largest number.
    fn tone_of(&self, hits: f64, most: f64) -> f64 {
        let tone = self.tone.of(hits, most);
        match self.gamma {
            1.0 => tone,
            gamma => libm::pow(tone, 1.0 / gamma),
        }
    }
}

fn premultiplied(colour: Colour) -> PremultipliedColorU8 {
    let [red, green, blue, opacity] = colour.rgba();
    ColorU8::from_rgba(red, green, blue, opacity).premultiply()
}

/// Quantises a tone to 255 levels; the lowest is 1, so that every hit is visible.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
pub(super) fn level(tone: f64) -> u8 {
    ((tone * 255.0).round() as u8).max(1)
}

/// Returns the colours of all levels; level 0 is the background.
fn colours(density: &Density) -> [Colour; 256] {
    let none = density.background.unwrap_or(Colour::of_rgba([0; 4]));
    let mut levels = 0..=u8::MAX;
    std::array::from_fn(|_| match (&density.shades, levels.next().unwrap_or(0)) {
        (_, 0) => none,
        (Shades::Ink(ink), level) => laid_on(density.background, *ink, level),
        (Shades::Palette(palette), level) => {
            let ink = palette.at(f64::from(level) / 255.0);
            laid_on(density.background, ink, 255)
        }
        (Shades::Classes(_), level) => laid_on(density.background, Colour::BLACK, level),
    })
}

/// Returns the colour of an ink over a background, with a level as the ink's opacity.
fn laid_on(background: Option<Colour>, ink: Colour, level: u8) -> Colour {
    let [red, green, blue, opacity] = ink.rgba();
    let over = u64::from(opacity) * u64::from(level);
    let whole = 255 * 255;
    let [under_red, under_green, under_blue, under_opacity] = background
        .unwrap_or(Colour::of_rgba([red, green, blue, 0]))
        .rgba();
    // Weight of the background, and the sum of both weights.
    let under = u64::from(under_opacity) * (whole - over) / 255;
    let all = (over + under).max(1);
    let mixed = |ink: u8, below: u8| {
        let sum = u64::from(ink) * over + u64::from(below) * under;
        byte((sum + all / 2) / all)
    };
    Colour::of_rgba([
        mixed(red, under_red),
        mixed(green, under_green),
        mixed(blue, under_blue),
        byte((over + under + 127) / 255),
    ])
}

/// Returns the mean of inks, weighted by their hits.
fn mean<'a>(inks: impl Iterator<Item = (u64, &'a Colour)>, all: u64) -> Colour {
    let mut sums = [0u128; 4];
    for (hits, ink) in inks {
        for (sum, value) in sums.iter_mut().zip(ink.rgba()) {
            *sum += u128::from(hits) * u128::from(value);
        }
    }
    let all = u128::from(all);
    Colour::of_rgba(sums.map(|sum| u8::try_from((sum + all / 2) / all).unwrap_or(u8::MAX)))
}

fn byte(value: u64) -> u8 {
    u8::try_from(value).unwrap_or(u8::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inks_are_mixed_with_what_is_below() {
        let white = Some(Colour::grey(255));
        let ink = Colour::of_rgba([200, 100, 0, 255]);
        assert_eq!(laid_on(white, ink, 255), ink);
        assert_eq!(laid_on(white, ink, 0), Colour::grey(255));
        let half = laid_on(white, Colour::BLACK, 51);
        assert_eq!(half, Colour::grey(204));
        assert_eq!(laid_on(None, ink, 51).rgba(), [200, 100, 0, 51]);
        let inks = [Colour::BLACK, Colour::grey(100)];
        assert_eq!(mean([1, 3].into_iter().zip(&inks), 4), Colour::grey(75));
    }

    #[test]
    fn pixels_are_means_of_bins() {
        let mut bins = Pixmap::new(4, 2).unwrap();
        let levels = [0, 40, 255, 255, 80, 120, 255, 255];
        for (pixel, level) in bins.pixels_mut().iter_mut().zip(levels) {
            *pixel = premultiplied(Colour::of_rgba([level, 0, 0, 255]));
        }
        let mean = averaged(&bins, 2).unwrap();
        let reds: Vec<u8> = mean.pixels().iter().map(|pixel| pixel.red()).collect();
        assert_eq!((mean.width(), mean.height(), reds), (2, 1, vec![60, 255]));
    }

    #[test]
    fn gamma_lifts_low_tones() {
        let density = Density::default().tone(Tone::Linear).gamma(2.0);
        assert_eq!(density.tone_of(9.0, 9.0), 1.0);
        assert!((density.tone_of(1.0, 4.0) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn tones_rise_from_nothing_to_one() {
        for tone in [Tone::Log, Tone::Linear, Tone::Plain] {
            assert_eq!(tone.of(0.0, 9.0), 0.0);
            assert_eq!(tone.of(9.0, 9.0), 1.0);
            assert!(tone.of(3.0, 9.0) >= tone.of(2.0, 9.0));
        }
        assert_eq!(Tone::Linear.of(3.0, 9.0), 1.0 / 3.0);
        assert!((Tone::Log.of(2.0, 8.0) - 0.5).abs() < 1e-15);
        assert_eq!(Tone::Plain.of(1.0, 9.0), 1.0);
    }
}
