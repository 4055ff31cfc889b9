//! A fit as one picture: shape, attractor, difference and copies.

use std::io::Write;

use crate::Bits;
use crate::style::Palette;

use super::{Fit, FitError, Shape};

/// Pixels between the panels, and around them.
const GAP: usize = 12;
/// Least number of pixels of the longer side of a panel.
const PANEL: usize = 320;
const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0; 3];
/// Pixels of the shape alone, of the attractor alone, and of both.
const DIFFERENCE: [[u8; 3]; 3] = [[230, 97, 1], [33, 102, 172], [190; 3]];

/// An error in writing a report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The attractor cannot be drawn.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The picture cannot be written.
    #[error("the report cannot be written")]
    Png(#[from] png::EncodingError),
}

impl Fit {
    /// Writes a PNG of four panels: the shape, the attractor, their difference (the shape alone in orange, the attractor
    /// alone in blue, both in grey), and the copies that the maps draw, in colours in the order of the maps.
    ///
    /// # Errors
    ///
    /// Returns an error if the attractor cannot be drawn or the output fails.
    pub fn report(&self, shape: &Shape, out: impl Write) -> Result<(), ReportError> {
        let drawn = self.candidate.attractor(shape.size(), None)?.pixels;
        let copies = self.copies(&drawn);
        let ink = |is_set: bool| if is_set { BLACK } else { WHITE };
        let panel = |number: usize, column: usize, row: usize| {
            let [own, other] = [shape.bits(), &drawn].map(|bits| bits.get(column, row));
            match (number, own, other) {
                (0, ..) => ink(own),
                (1, ..) => ink(other),
                (2, true, true) => DIFFERENCE[2],
                (2, true, false) => DIFFERENCE[0],
                (2, false, true) => DIFFERENCE[1],
                (2, false, false) => WHITE,
                _ => copies[row * drawn.width() + column],
            }
        };
        let [width, height] = shape.size();
        let factor = PANEL.div_ceil(width.max(height)).max(1);
        let [across, down] = [width, height].map(|side| side * factor);
        let [all_width, all_height] = [across, down].map(|side| 2 * side + 3 * GAP);
        let mut bytes = Vec::with_capacity(3 * all_width * all_height);
        for y in 0..all_height {
            for x in 0..all_width {
                let place = |at: usize, side: usize| {
                    let at = at.checked_sub(GAP)?;
                    let (panel, inside) = (at / (side + GAP), at % (side + GAP));
                    (inside < side && panel < 2).then_some((panel, inside / factor))
                };
                let colour = match (place(x, across), place(y, down)) {
                    (Some((right, column)), Some((lower, row))) => {
                        panel(2 * lower + right, column, row)
                    }
                    _ => [236; 3],
                };
                bytes.extend(colour);
            }
        }
        let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
        let mut encoder = png::Encoder::new(out, side(all_width), side(all_height));
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&bytes)?;
        Ok(writer.finish()?)
    }

    /// Returns the colour of every pixel in a picture of the copies; disks are grey.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "places outside the picture are compared with its size"
    )]
    fn copies(&self, drawn: &Bits) -> Vec<[u8; 3]> {
        let (width, height) = (drawn.width(), drawn.height());
        let palette = Palette::named("okabe-ito").unwrap_or_default();
        let mut colours = vec![WHITE; width * height];
        for [column, row] in drawn.set_boxes() {
            colours[row * width + column] = [120; 3];
        }
        for (number, map) in (0i64..).zip(&self.candidate.maps) {
            let [red, green, blue, _] = palette.entry(number).rgba();
            for place in drawn.set_boxes() {
                let image = map.transform_point2(super::shape::centre(place, height));
                let (x, y) = (image.x, height as f64 - image.y);
                let is_inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
                if is_inside && drawn.get(x as usize, y as usize) {
                    colours[y as usize * width + x as usize] = [red, green, blue];
                }
            }
        }
        colours
    }
}
