//! Options that decide which pixels of a picture belong to a set, and the pictures that they are read from.

use std::io::{self, Read};
use std::path::Path;

use anyhow::{Context, anyhow};
use clap::builder::PossibleValue;

use crate::Bits;
use crate::catalogue::open_file;
use crate::import::{Channel, Raster};

use super::{Failure, input};

/// Options for pictures.
#[derive(clap::Args, Clone, Copy, Default)]
#[command(next_help_heading = "Pictures")]
pub(crate) struct PixelArguments {
    /// Property of a pixel that decides whether it belongs to the set [default: opacity, if any pixel is
    /// transparent, or else darkness]
    #[arg(long, value_parser = channel())]
    pub(super) channel: Option<Channel>,
    /// Least darkness or opacity, from 1 to 255, of a pixel of the set; or otsu, for the best separation of the pixels
    /// (Otsu 1979) [default: otsu]
    #[arg(long, value_name = "T", value_parser = threshold)]
    pub(super) threshold: Option<Threshold>,
    /// Takes the light or transparent pixels instead
    #[arg(long)]
    pub(super) invert: bool,
}

/// The least value of a pixel of the set.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Threshold {
    #[default]
    Otsu,
    Value(u8),
}

fn threshold(text: &str) -> Result<Threshold, String> {
    match text.parse() {
        _ if text == "otsu" => Ok(Threshold::Otsu),
        Ok(value @ 1..) => Ok(Threshold::Value(value)),
        _ => Err("expected otsu or a number from 1 to 255".into()),
    }
}

fn channel() -> impl clap::builder::TypedValueParser<Value = Channel> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    let values = [
        PossibleValue::new("darkness").help("The darkness of the pixel on white"),
        PossibleValue::new("alpha").help("The opacity of the pixel"),
    ];
    PossibleValuesParser::new(values).map(|name| match name.as_str() {
        "alpha" => Channel::Alpha,
        _ => Channel::Darkness,
    })
}

/// Largest size of a picture file in bytes.
pub(super) const MAX_BYTES: u64 = 1 << 31;

/// A set of pixels.
pub(crate) struct PixelSet {
    /// The name of the picture.
    pub(super) name: String,
    pub(crate) bits: Bits,
    /// Darkness or opacity of every pixel, in rows from the top.
    pub(super) values: Vec<u8>,
    /// Least value of a pixel of the set.
    pub(super) threshold: u8,
    /// Number, quality and threshold of the pixels.
    pub(crate) description: String,
    /// A remark if most of the picture belongs to the set.
    pub(super) warning: Option<String>,
}

impl PixelArguments {
    /// Returns an option that is given.
    pub(super) fn given(&self) -> Option<&'static str> {
        let given = [
            ("--channel", self.channel.is_some()),
            ("--threshold", self.threshold.is_some()),
            ("--invert", self.invert),
        ];
        given
            .into_iter()
            .find_map(|(option, is_given)| is_given.then_some(option))
    }

    /// Reads the set of pixels of a picture file, or of standard input for `-`.
    pub(super) fn read(&self, path: &Path) -> Result<PixelSet, Failure> {
        let is_standard = path == Path::new("-");
        let name = match is_standard {
            true => "standard input".into(),
            false => path.display().to_string(),
        };
        input::note(path);
        let input: Box<dyn Read> = match is_standard {
            true => Box::new(io::stdin().lock()),
            false => Box::new(open_file(path)?),
        };
        let mut bytes = Vec::new();
        let read = input.take(MAX_BYTES).read_to_end(&mut bytes);
        read.with_context(|| format!("{name} cannot be read"))?;
        let picture = Raster::read(&bytes, self.channel).with_context(|| name.clone())?;
        drop(bytes);
        self.decide(name, picture)
    }

    /// Decides which pixels belong to the set. A set without pixels is an error.
    pub(crate) fn decide(&self, name: String, picture: Raster) -> Result<PixelSet, Failure> {
        let picture = match self.invert {
            true => picture.inverted(),
            false => picture,
        };
        let asked = self.threshold.unwrap_or_default();
        let threshold = match asked {
            Threshold::Otsu => picture.otsu(),
            Threshold::Value(value) => value,
        };
        let (width, height) = (picture.width, picture.height);
        let bits = Bits::of_bytes(&picture.values, width, height, threshold);
        let (set, all) = (bits.count(), picture.values.len() as u64);
        let quality = match (picture.channel, self.invert) {
            (Channel::Darkness, false) => "dark",
            (Channel::Darkness, true) => "light",
            (Channel::Alpha, false) => "opaque",
            (Channel::Alpha, true) => "transparent",
        };
        if set == 0 {
            let message = format!(
                "{name}: no pixel is {quality} (threshold {threshold}): try --invert or --threshold"
            );
            return Err(anyhow!(message).into());
        }
        let is_most = set > all / 2 && asked == Threshold::Otsu;
        let warning = is_most.then(|| {
            format!(
                "{:.0} % of all pixels are {quality}: with --invert, the others are taken",
                part(set, all)
            )
        });
        Ok(PixelSet {
            name,
            bits,
            values: picture.values,
            threshold,
            description: format!(
                "{set} {quality} pixels of {width} x {height} (threshold {threshold})"
            ),
            warning,
        })
    }
}

#[expect(clippy::cast_precision_loss, reason = "two digits are shown")]
fn part(some: u64, all: u64) -> f64 {
    100.0 * some as f64 / all as f64
}
