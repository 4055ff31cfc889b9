//! `kfrac dim --steps`: an approximant as it is drawn, by the pixels that it covers.

use std::collections::BTreeMap;

use crate::fractal::Fractal;
use crate::import::{Channel, Raster};
use crate::saturating::{real, whole};
use crate::style::{Colour, Style, View, Width};

use super::super::Failure;
use super::super::rule::Loaded;
use super::{Arguments, Measured, input, report};

/// Smallest and largest long side, in pixels, of a drawing whose pixels are as large as its elements.
const SIDES: [f64; 2] = [64.0, 4096.0];

/// Number of classes of lengths in every doubling.
const CLASSES: f64 = 64.0;

/// Draws the approximant of step `steps`, and measures its pixels. Sizes are in the rule's units.
pub(super) fn measure(
    arguments: &Arguments,
    loaded: &Loaded,
    steps: u32,
) -> Result<Measured, Failure> {
    if loaded.model.is_in_space() {
        let message = "--steps measures drawings of the plane: without it, the limit set in space is measured";
        return Err(Failure::Usage(message.into()));
    }
    let metadata = loaded.model.metadata();
    let own = &metadata.style;
    let style = Style {
        background: Some(Colour::TRANSPARENT),
        width: match own.width {
            Width::Pixels(width) => Width::Pixels(width.min(1.0)),
            relative @ Width::Relative(_) => relative,
        },
        ..own.clone()
    };
    let fractal = Fractal::from(loaded.model.clone())
        .steps(steps)
        .seed(arguments.seed)
        .threads(arguments.threads())
        .style(style);
    let bounds = fractal.bounds()?;
    let extent = bounds.size().max_element();
    let sides = match arguments.size {
        Some(size) => f64::from(size),
        None => (extent / typical_length(&fractal)?).clamp(SIDES[0], SIDES[1]),
    };
    let pixel = extent / sides;
    if !(pixel > 0.0 && pixel.is_finite()) {
        let mut measured = Measured::of_loaded(loaded);
        measured
            .warnings
            .push("nothing is measured: a single point has no sizes to be measured at".into());
        return Ok(measured);
    }
    // Strokes reach beyond the outlines; an excess of less than 10⁻⁶ pixels is rounding.
    let [width, height] = (bounds.size() / pixel)
        .to_array()
        .map(|side| (side - 1e-6).ceil() + 4.0);
    let middle = bounds.min().midpoint(bounds.max());
    let window = [
        middle.x - width * pixel / 2.0,
        middle.y - height * pixel / 2.0,
        width * pixel,
        height * pixel,
    ];
    let view = View {
        window: Some(window),
        margin: Some(0.0),
    };
    let size = [width, height].map(|side| u32::try_from(whole(side)).unwrap_or(u32::MAX));
    let png = fractal.view(view).png((size[0], size[1]))?;
    let channel = arguments.pixels.channel.unwrap_or(Channel::Alpha);
    let picture = Raster::read(&png, Some(channel)).map_err(anyhow::Error::from)?;
    let measured = input::of_picture(arguments, &loaded.name, picture)?;
    let titled = Measured::of_loaded(loaded);
    Ok(Measured {
        title: titled.title,
        set: format!(
            "approximant {steps} as it is drawn, {}, with sides of {}",
            measured.set,
            report::short(pixel)
        ),
        // Filled shapes may cover most of a picture.
        warnings: Vec::new(),
        unit: None,
        exact: Some(input::exact(loaded)?),
        ..measured.enlarged(pixel)
    })
}

/// Returns the median length of the fertile elements, or of all if none is fertile, in the rule's units. A tree's
/// last twigs are of the same step, and of several lengths.
fn typical_length(fractal: &Fractal) -> Result<f64, Failure> {
    let mut lengths = [BTreeMap::new(), BTreeMap::new()];
    for element in fractal.elements()? {
        let element = element?;
        let length = element.frame.length();
        if length > 0.0 {
            let class = (CLASSES * libm::log2(length)).round();
            #[expect(
                clippy::cast_possible_truncation,
                reason = "logarithms of doubles are small"
            )]
            let class = class as i32;
            let (count, sum) = lengths[usize::from(!element.fertile)]
                .entry(class)
                .or_insert((0, 0.0));
            *count += 1;
            *sum += length;
        }
    }
    // The mean of the class in which the median lies.
    let median = |classes: &BTreeMap<i32, (u64, f64)>| {
        let half = { classes.values() }.map(|(count, _)| count).sum::<u64>();
        let half = half.div_ceil(2);
        let mut below = 0;
        let mut classes = classes.values();
        let (count, sum) = classes.find(|(count, _)| {
            below += count;
            below >= half
        })?;
        Some(sum / real(usize::try_from(*count).ok()?))
    };
    let [fertile, others] = &lengths;
    Ok(median(fertile)
        .or_else(|| median(others))
        .unwrap_or_default())
}
