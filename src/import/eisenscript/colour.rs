//! Colours of EisenScript: absolute ones, changes of hue, saturation, brightness and alpha in HSV, and pools of random ones.
//!
//! The tints of structures change colours in HSL, where the hue is the same. Colours of full brightness keep the saturation of
//! HSL while that of HSV falls by a factor f: their lightness goes the share 1 − f of the way to white. Colours of full
//! saturation, and all of a lightness up to a half, keep it while their brightness falls: their lightness goes the share 1 − f
//! of the way to black. A program that keeps to either is converted exactly.

use crate::build::NumberText;
use crate::build::written::Entries;
use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use crate::document::node::Value;
use crate::random::Pcg;
use crate::style::Colour;

use super::motion::times;

/// Colour of what no transformation colours.
pub(super) const FIRST: Colour = Colour::of_rgba([255, 0, 0, 255]);

/// The part of a transformation that colours.
#[derive(Clone, Debug, Default)]
pub(super) struct Colouring {
    /// Colour regardless of the one outside, with its changes.
    pub(super) absolute: Option<Colour>,
    pub(super) hue: f64,
    /// Factors of saturation, brightness and alpha.
    pub(super) factors: Factors,
    /// Colour with its share of a mixture, from 0 to 1.
    pub(super) blend: Option<(Colour, f64)>,
    /// Places of the words that change something.
    pub(super) places: Vec<Place>,
}

/// Factors of saturation, brightness and alpha, not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Factors(pub(super) [f64; 3]);

impl Default for Factors {
    fn default() -> Self {
        Self([1.0; 3])
    }
}

impl PartialEq for Colouring {
    fn eq(&self, other: &Self) -> bool {
        let parts = |it: &Self| (it.absolute, it.hue, it.factors, it.blend);
        parts(self) == parts(other)
    }
}

impl Colouring {
    /// Returns whether the colouring depends on the colour outside.
    pub(super) fn is_relative(&self) -> bool {
        self.absolute.is_none() && (self.hue != 0.0 || self.factors != Factors::default())
    }

    /// Returns whether the colouring is expressed by the tint of an instance.
    pub(super) fn tints(&self) -> bool {
        self.is_relative() || self.blend.is_some()
    }

    /// Completes a colouring whose parts have all been read: an absolute colour takes up its own changes.
    pub(super) fn completed(mut self) -> Self {
        if let Some(colour) = self.absolute {
            let [hue, saturation, value, alpha] = hsv(colour);
            let [of_saturation, of_value, of_alpha] = self.factors.0;
            let times = |part: f64, factor: f64| (part * factor).clamp(0.0, 1.0);
            self.absolute = Some(of_hsv([
                hue + self.hue,
                times(saturation, of_saturation),
                times(value, of_value),
                times(alpha, of_alpha),
            ]));
            self.hue = 0.0;
            self.factors = Factors::default();
        }
        self
    }

    /// Returns the tint of an instance; with the name of a value, that of as many repetitions.
    pub(super) fn tint(&self, name: Option<&str>) -> Option<Value> {
        self.tints().then(|| self.entries(name).value())
    }

    fn entries(&self, name: Option<&str>) -> Entries {
        let [saturation, value, alpha] = self.factors.0;
        let tint = match self.blend {
            None => Entries::default(),
            Some((colour, share)) => Entries::default()
                .set("color", colour_text(colour))
                .set("alpha", NumberText::from(share).0),
        };
        let tint = tint.set_some("hue", (self.hue != 0.0).then(|| times(self.hue, name)));
        let (saturation, lightness) = match self.factors.is_pale() {
            true => (None, away(saturation, name)),
            false => (towards(saturation, name), towards(value, name)),
        };
        tint.set_some("saturation", saturation)
            .set_some("lightness", lightness)
            .set_some("opacity", towards(alpha, name))
    }
}

impl Factors {
    /// Returns whether the saturation falls, and nothing changes the brightness.
    fn is_pale(self) -> bool {
        let [saturation, value, _] = self.0;
        saturation != 1.0 && value == 1.0
    }
}

/// Returns the share of the way to 0, which is negative, that has the effect of a factor up to 1; none for 1.
fn towards(factor: f64, name: Option<&str>) -> Option<Value> {
    share(factor, name, true)
}

/// Returns the share of the way to 1 of what is left of it, which has the effect of a factor up to 1; none for 1.
fn away(factor: f64, name: Option<&str>) -> Option<Value> {
    share(factor, name, false)
}

fn share(factor: f64, name: Option<&str>, is_towards_nothing: bool) -> Option<Value> {
    // A factor beyond 1 goes the other way, as far as a colour of half the full value does.
    let (factor, is_towards_nothing) = match factor {
        1.0 => return None,
        above if above > 1.0 => ((2.0 - above).max(0.0), !is_towards_nothing),
        factor => (factor, is_towards_nothing),
    };
    Some(match (name, is_towards_nothing) {
        (None, true) => NumberText::from(rounded(factor - 1.0)).0,
        (None, false) => NumberText::from(rounded(1.0 - factor)).0,
        (Some(name), true) => Value::Text(format!("{factor}^{name} - 1")),
        (Some(name), false) => Value::Text(format!("1 - {factor}^{name}")),
    })
}

/// Rounds a share to 12 decimals: 0.995 - 1 is -0.005.
fn rounded(share: f64) -> f64 {
    (share * 1e12).round() / 1e12
}

/// Returns a colour in the notation of a file.
pub(super) fn colour_text(colour: Colour) -> Value {
    Value::Text(format!("{:#}", colour.opaque()))
}

/// Returns hue in degrees, saturation, brightness and alpha from 0 to 1; greys have the hue 0.
pub(super) fn hsv(colour: Colour) -> [f64; 4] {
    let [red, green, blue, alpha] = colour.rgba().map(|part| f64::from(part) / 255.0);
    let most = red.max(green).max(blue);
    let range = most - red.min(green).min(blue);
    let hue = match range {
        0.0 => 0.0,
        _ if most == red => (green - blue) / range,
        _ if most == green => 2.0 + (blue - red) / range,
        _ => 4.0 + (red - green) / range,
    };
    let saturation = if most > 0.0 { range / most } else { 0.0 };
    [(60.0 * hue).rem_euclid(360.0), saturation, most, alpha]
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
fn of_hsv([hue, saturation, value, alpha]: [f64; 4]) -> Colour {
    let part = |offset: f64| {
        let at = (offset + hue / 60.0).rem_euclid(6.0);
        value * (1.0 - saturation * at.min(4.0 - at).clamp(0.0, 1.0))
    };
    let byte = |part: f64| (255.0 * part).round() as u8;
    Colour::of_rgba([part(5.0), part(3.0), part(1.0), alpha].map(byte))
}

/// Parses a colour: a name of SVG, `#rgb`, `#rrggbb`, or `#aarrggbb` with the alpha in front.
pub(super) fn parse(text: &str) -> Option<Colour> {
    if let Some(digits) = text.strip_prefix('#') {
        let is_known = matches!(digits.len(), 3 | 6 | 8);
        if !is_known || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
            return None;
        }
        return match digits.len() {
            8 => Colour::parse(&format!("#{}{}", &digits[2..], &digits[..2])),
            _ => Colour::parse(text),
        };
    }
    let is_name = text.bytes().all(|letter| letter.is_ascii_alphabetic());
    Colour::parse(text).filter(|_| is_name)
}

/// Scheme by which random colours are drawn.
#[derive(Clone, Debug, Default)]
pub(super) enum Pool {
    #[default]
    Hues,
    Rgb,
    Greys,
    List(Vec<Colour>),
}

impl Pool {
    /// Parses the name of a scheme; pictures are none.
    pub(super) fn parse(text: &str) -> Option<Self> {
        Some(match text {
            "randomhue" => Self::Hues,
            "randomrgb" => Self::Rgb,
            "greyscale" | "grayscale" => Self::Greys,
            list => {
                let colours = list.strip_prefix("list:")?.split(',').map(parse);
                Self::List(colours.collect::<Option<_>>()?)
            }
        })
    }

    /// Draws a colour.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "casts from floats saturate, and lists are short"
    )]
    pub(super) fn draw(&self, random: &mut Pcg) -> Colour {
        let mut byte = || (256.0 * random.unit()) as u8;
        match self {
            Self::Hues => of_hsv([360.0 * random.unit(), 1.0, 1.0, 1.0]),
            Self::Rgb => Colour::of_rgba([byte(), byte(), byte(), 255]),
            Self::Greys => Colour::grey(byte()),
            Self::List(colours) => {
                let at = (random.unit() * colours.len() as f64) as usize;
                colours.get(at).copied().unwrap_or(FIRST)
            }
        }
    }
}

/// The changes of colours in a program.
#[derive(Default)]
pub(super) struct Changes<'a> {
    /// Colourings with the places of their words.
    all: Vec<&'a Colouring>,
}

impl<'a> Changes<'a> {
    pub(super) fn add(&mut self, colouring: &'a Colouring) {
        self.all.push(colouring);
    }

    /// Warns of changes that differ from those in HSV.
    pub(super) fn check(&self, found: &mut Diagnostics) {
        let relative = || self.all.iter().filter(|it| it.is_relative());
        let factor = |part: usize| relative().map(move |it| it.factors.0[part]);
        let starts = || {
            let absolute = self.all.iter().filter_map(|it| it.absolute);
            absolute.chain([FIRST]).map(hsv)
        };
        let blends = self.all.iter().any(|it| it.blend.is_some());
        let changes = |part: usize| factor(part).any(|it| it != 1.0);
        let is_full = |part: usize| starts().all(|it| it[part] == 1.0) && !blends;
        let is_plain = |[_, saturation, value, _]: [f64; 4]| {
            saturation == 0.0 || saturation == 1.0 || value * (1.0 - saturation / 2.0) <= 0.5
        };
        let pale = is_full(2) && !changes(1) && factor(0).all(|it| it <= 1.0);
        let dark =
            starts().all(is_plain) && !blends && !changes(0) && factor(1).all(|it| it <= 1.0);
        let exact = [pale, dark, factor(2).all(|it| it <= 1.0)];
        for colouring in relative() {
            let Some(place) = colouring.places.first() else {
                continue;
            };
            let names = ["saturation", "brightness", "alpha"];
            for (part, name) in names.iter().enumerate() {
                let factor = colouring.factors.0[part];
                let message = if factor == 1.0 {
                    continue;
                } else if part == 2 {
                    "solids hide what is behind them, whatever their alpha".to_owned()
                } else if exact[part] {
                    continue;
                } else {
                    format!("the {name} times {factor} of HSV is approximate here, in HSL")
                };
                found.push(Diagnostic::warning(message).at(place));
            }
        }
        for colouring in self.all.iter().filter(|it| it.blend.is_some()) {
            if let Some(place) = colouring.places.first() {
                let mixed = "colours are mixed in RGB here, and in HSV there";
                found.push(Diagnostic::warning(mixed).at(place));
            }
        }
    }
}
