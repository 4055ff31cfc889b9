//! Palettes: continuous colour scales with numbered entries.

use std::fmt;
use std::sync::Arc;

use colorgrad::{Gradient, GradientBuilder, LinearGradient, preset};

use super::Colour;

/// A colour scale over 0 to 1, with numbered entries.
#[derive(Clone)]
pub struct Palette {
    name: String,
    /// The colours that define the scale; empty for a preset of `colorgrad`.
    colours: Vec<Colour>,
    gradient: Arc<dyn Gradient + Send + Sync>,
    /// Whether the scale runs from its end to its beginning.
    is_reversed: bool,
}

/// Error: no palette has the given name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no palette of this name")]
pub struct UnknownPalette;

/// The palettes of this crate: evenly spaced colours, interpolated in Oklab.
const OWN: &[(&str, &[&str])] = &[
    (
        "earth-to-leaf",
        &["#8a6244", "#96783f", "#88963c", "#5fa04e", "#8fc46a"],
    ),
    ("leaf", &["#2f6b3f", "#5fa04e", "#a5c957"]),
    ("bark", &["#8a6648", "#a58460", "#c2a680"]),
    ("fire", &["#8c1c13", "#d1491b", "#f2921d", "#f7c64a"]),
    ("ice", &["#2b5c8a", "#4c94b8", "#8fc7d6"]),
    ("sunset", &["#4b3f8f", "#a0458f", "#e0605f", "#f2a65a"]),
    ("ink", &["#3a4a5a", "#6f8191"]),
];

type Preset = fn() -> Arc<dyn Gradient + Send + Sync>;

/// The presets of `colorgrad`, by their established names.
const PRESETS: &[(&str, Preset)] = &[
    ("viridis", || Arc::new(preset::viridis())),
    ("magma", || Arc::new(preset::magma())),
    ("inferno", || Arc::new(preset::inferno())),
    ("plasma", || Arc::new(preset::plasma())),
    ("cividis", || Arc::new(preset::cividis())),
    ("turbo", || Arc::new(preset::turbo())),
    ("spectral", || Arc::new(preset::spectral())),
    ("rainbow", || Arc::new(preset::rainbow())),
    ("sinebow", || Arc::new(preset::sinebow())),
    ("warm", || Arc::new(preset::warm())),
    ("cool", || Arc::new(preset::cool())),
    ("blues", || Arc::new(preset::blues())),
    ("greens", || Arc::new(preset::greens())),
    ("oranges", || Arc::new(preset::oranges())),
    ("purples", || Arc::new(preset::purples())),
    ("reds", || Arc::new(preset::reds())),
];

impl Palette {
    /// Iterates over the names of all palettes.
    pub fn names() -> impl Iterator<Item = &'static str> {
        let own = OWN.iter().map(|(name, _)| *name);
        own.chain(PRESETS.iter().map(|(name, _)| *name))
    }

    /// Returns the palette of the given name.
    ///
    /// # Errors
    ///
    /// Returns [`UnknownPalette`] if no palette has the name.
    pub fn named(name: &str) -> Result<Self, UnknownPalette> {
        if let Some((_, colours)) = OWN.iter().find(|(own, _)| *own == name) {
            let colours: Vec<_> = colours
                .iter()
                .filter_map(|text| Colour::parse(text))
                .collect();
            return Ok(Self::of_colours(name, &colours));
        }
        let (name, preset) = PRESETS
            .iter()
            .find(|(preset, _)| *preset == name)
            .ok_or(UnknownPalette)?;
        Ok(Self {
            name: (*name).into(),
            colours: Vec::new(),
            gradient: preset(),
            is_reversed: false,
        })
    }

    /// Creates a palette of evenly spaced colours, interpolated in Oklab; black if `colours` is empty.
    #[must_use]
    pub fn of_colours(name: &str, colours: &[Colour]) -> Self {
        let colours = match colours {
            [] => vec![Colour::BLACK; 2],
            [only] => vec![*only; 2],
            several => several.to_vec(),
        };
        let stops: Vec<_> = colours
            .iter()
            .map(|colour| {
                let [red, green, blue, opacity] = colour.rgba();
                colorgrad::Color::from_rgba8(red, green, blue, opacity)
            })
            .collect();
        let gradient = GradientBuilder::new()
            .colors(&stops)
            .mode(colorgrad::BlendMode::Oklab)
            .build::<LinearGradient>()
            .unwrap_or_else(|_| unreachable!("two colours or more make a gradient"));
        Self {
            name: name.into(),
            colours,
            gradient: Arc::new(gradient),
            is_reversed: false,
        }
    }

    /// Returns the name; empty for a palette that a file defines by a list of colours.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the colours that define the palette, two or more; empty for a preset.
    #[must_use]
    pub fn colours(&self) -> &[Colour] {
        &self.colours
    }

    /// Returns the entry of the given number, modulo [`Palette::entries`]: one of the defining colours,
    /// or one of eight evenly spaced colours of a preset.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_wrap,
        clippy::cast_possible_truncation,
        reason = "palettes have few colours"
    )]
    pub fn entry(&self, number: i64) -> Colour {
        let place = number.rem_euclid(self.entries() as i64);
        match self.colours.get(place as usize) {
            Some(colour) => *colour,
            None => self.at(place as f64 / 7.0),
        }
    }

    /// Returns the number of entries: that of the defining colours, or 8 for a preset.
    #[must_use]
    pub fn entries(&self) -> usize {
        match self.colours.len() {
            0 => 8,
            count => count,
        }
    }

    /// Reverses the scale. The entries of a palette with defining colours keep their numbers.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self {
            is_reversed: !self.is_reversed,
            ..self
        }
    }

    /// Returns the colour at `place`, which is clamped to 0 to 1.
    #[must_use]
    pub fn at(&self, place: f64) -> Colour {
        let place = if self.is_reversed { 1.0 - place } else { place };
        #[expect(
            clippy::cast_possible_truncation,
            reason = "colours need no more than f32"
        )]
        let place = place.clamp(0.0, 1.0) as f32;
        Colour(self.gradient.at(place).to_rgba8())
    }
}

impl Default for Palette {
    fn default() -> Self {
        Self {
            name: "viridis".into(),
            colours: Vec::new(),
            gradient: Arc::new(preset::viridis()),
            is_reversed: false,
        }
    }
}

impl PartialEq for Palette {
    fn eq(&self, other: &Self) -> bool {
        let samples = [0.0, 0.25, 0.5, 0.75, 1.0];
        self.name == other.name
            && samples
                .iter()
                .all(|&place| self.at(place) == other.at(place))
    }
}

/// Writes the name, or the colours of a palette without one, separated by commas.
impl fmt::Display for Palette {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.name.is_empty() {
            return f.write_str(&self.name);
        }
        for (number, colour) in self.colours.iter().enumerate() {
            let comma = if number > 0 { "," } else { "" };
            write!(f, "{comma}{colour:#}")?;
        }
        Ok(())
    }
}

impl fmt::Debug for Palette {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Palette").field(&self.name).finish()
    }
}
