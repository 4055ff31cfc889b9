//! Pictures of histograms: how often the walks of a chaos game came to every pixel.

use std::io::Write;

use tiny_skia::{ColorU8, Pixmap, PremultipliedColorU8};

use crate::chaos::Histogram;
use crate::style::{Colour, Named, Palette};

use super::png::{TooManyPixels, write_pixels};
use super::{Labels, RenderError};

/// How a number of hits becomes a tone from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// By its logarithm: log(1 + hits) / log(1 + the most hits of a pixel).
    #[default]
    Log,
    /// In proportion to the most hits of a pixel.
    Linear,
    /// A pixel that is hit has the tone 1.
    Plain,
}

impl Named for Tone {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("log", Self::Log),
        ("linear", Self::Linear),
        ("plain", Self::Plain),
    ];
}

impl Tone {
    /// The tone of a number of hits, of which there are at most `most`.
    fn of(self, hits: u64, most: u64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a tone has 255 steps")]
        let [hits, most] = [hits, most].map(|count| count as f64);
        if hits == 0.0 {
            return 0.0;
        }
        match self {
            Self::Log => libm::log1p(hits) / libm::log1p(most),
            Self::Linear => hits / most,
            Self::Plain => 1.0,
        }
    }
}

/// The colours of a picture of a histogram.
#[derive(Clone, Debug, PartialEq)]
pub enum Shades {
    /// One ink, as opaque as the tone says.
    Ink(Colour),
    /// The tone's place in a palette. Pixels that are not hit have none.
    Palette(Palette),
    /// An ink for every class, as opaque as the tone of all classes together says, and mixed where
    /// several classes hit a pixel. Further classes begin with the first ink again.
    Classes(Vec<Colour>),
}

/// How a histogram is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    /// How hits become tones; by their logarithm unless said otherwise.
    pub tone: Tone,
    /// The colours; black ink unless said otherwise.
    pub shades: Shades,
    /// The colour behind everything; transparent if none is given.
    pub background: Option<Colour>,
}

impl Default for Density {
    fn default() -> Self {
        Self {
            tone: Tone::default(),
            shades: Shades::Ink(Colour::BLACK),
            background: None,
        }
    }
}

/// Levels of fewer hits than this are worked out once.
const FEW_HITS: u64 = 4096;

/// Writes a histogram as a PNG.
///
/// # Errors
///
/// If the picture is larger than memory may be, or if `out` fails.
pub fn write_density(
    histogram: &Histogram,
    density: &Density,
    labels: &Labels,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    let size @ [width, height] = histogram.size();
    let mut pixmap = Pixmap::new(width, height).ok_or(TooManyPixels { size })?;
    let classes: Vec<_> = (0..histogram.classes())
        .map(|class| histogram.counts(class))
        .collect();
    match classes.as_slice() {
        [counts] => paint(&mut pixmap, density, &classes, |place| counts[place].into()),
        _ => paint(&mut pixmap, density, &classes, |place| {
            let hits = classes.iter().map(|counts| u64::from(counts[place]));
            hits.sum()
        }),
    }
    // Into memory first: the encoder would not tell why `out` fails.
    let mut bytes = Vec::new();
    write_pixels(&pixmap, labels, &mut bytes)?;
    Ok(out.write_all(&bytes)?)
}

/// Paints every pixel, of whose hits, by class and all together, this tells the numbers.
fn paint(pixmap: &mut Pixmap, density: &Density, classes: &[&[u32]], hits: impl Fn(usize) -> u64) {
    let pixels = pixmap.pixels_mut();
    let most = (0..pixels.len()).map(&hits).max().unwrap_or(0);
    let colours = colours(density).map(premultiplied);
    let levels: Vec<_> = (0..most.saturating_add(1).min(FEW_HITS))
        .map(|all| level(density.tone.of(all, most)))
        .collect();
    for (place, pixel) in pixels.iter_mut().enumerate() {
        let all = hits(place);
        let known = usize::try_from(all).ok().and_then(|all| levels.get(all));
        let level = known.map_or_else(|| level(density.tone.of(all, most)), |&level| level);
        *pixel = match &density.shades {
            Shades::Classes(inks) if all > 0 && !inks.is_empty() => {
                let shares = classes.iter().map(|counts| u64::from(counts[place]));
                let ink = mean(shares.zip(inks.iter().cycle()), all);
                premultiplied(laid_on(density.background, ink, level))
            }
            _ => colours[usize::from(if all > 0 { level } else { 0 })],
        };
    }
}

fn premultiplied(colour: Colour) -> PremultipliedColorU8 {
    let [red, green, blue, opacity] = colour.rgba();
    ColorU8::from_rgba(red, green, blue, opacity).premultiply()
}

/// A tone in 255 steps; whatever is hit is seen.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
fn level(tone: f64) -> u8 {
    ((tone * 255.0).round() as u8).max(1)
}

/// The colours of all levels; of 0 where there is nothing.
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

/// An ink that is as opaque as a level says, on a background.
fn laid_on(background: Option<Colour>, ink: Colour, level: u8) -> Colour {
    let [red, green, blue, opacity] = ink.rgba();
    let over = u64::from(opacity) * u64::from(level);
    let whole = 255 * 255;
    let [under_red, under_green, under_blue, under_opacity] = background
        .unwrap_or(Colour::of_rgba([red, green, blue, 0]))
        .rgba();
    // What of the background is seen, and all that is.
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

/// The mean of inks, each with its hits.
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
    fn tones_rise_from_nothing_to_one() {
        for tone in [Tone::Log, Tone::Linear, Tone::Plain] {
            assert_eq!(tone.of(0, 9), 0.0);
            assert_eq!(tone.of(9, 9), 1.0);
            assert!(tone.of(3, 9) >= tone.of(2, 9));
        }
        assert_eq!(Tone::Linear.of(3, 9), 1.0 / 3.0);
        assert!((Tone::Log.of(2, 8) - 0.5).abs() < 1e-15);
        assert_eq!(Tone::Plain.of(1, 9), 1.0);
    }
}
