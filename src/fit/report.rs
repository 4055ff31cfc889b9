//! A fit as one picture: shape, skeleton, attractor, difference, copies and collage.

use std::io::Write;

use crate::Bits;
use crate::geometry::DVec2;
use crate::morphology::{Skeleton, SkeletonOptions, SkeletonPoint};
use crate::saturating::{real, whole};
use crate::style::Palette;

use super::shape::centre;
use super::{Disk, Fit, FitError, Silhouette};

/// Pixels between the panels, and around them.
const GAP: usize = 12;
/// Least number of pixels of the longer side of a panel.
const PANEL: usize = 320;
/// Panels beside each other, and below each other.
const COLUMNS: usize = 3;
const ROWS: usize = 2;
const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0; 3];
/// Disks.
const GREY: [u8; 3] = [120; 3];
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
    /// Writes a PNG of six panels. Above: the shape; its skeleton, with its branch points, and the largest disks about those that
    /// lie in no larger one; the attractor. Below: the difference (the shape alone in orange, the attractor alone in blue, both in
    /// grey); the copies that the maps draw, in colours in the order of the maps; the collage, the images of the shape, in
    /// the same colours.
    ///
    /// # Errors
    ///
    /// Returns an error if the attractor cannot be drawn or the output fails.
    pub fn report(&self, shape: &Silhouette, out: impl Write) -> Result<(), ReportError> {
        let drawn = self.candidate.attractor(shape.size(), None)?.pixels;
        let skeleton = skeleton(shape);
        let copies = self.copies(&drawn, &drawn);
        let collage = self.copies(shape.bits(), &everywhere(shape));
        let width = drawn.width();
        let ink = |is_set: bool| if is_set { BLACK } else { WHITE };
        let panel = |number: usize, column: usize, row: usize| {
            let [own, other] = [shape.bits(), &drawn].map(|bits| bits.get(column, row));
            let index = row * width + column;
            match (number, own, other) {
                (0, ..) => ink(own),
                (1, ..) => skeleton[index],
                (2, ..) => ink(other),
                (3, true, true) => DIFFERENCE[2],
                (3, true, false) => DIFFERENCE[0],
                (3, false, true) => DIFFERENCE[1],
                (3, false, false) => WHITE,
                (4, ..) => copies[index],
                _ => collage[index],
            }
        };
        let [width, height] = shape.size();
        let factor = PANEL.div_ceil(width.max(height)).max(1);
        let [across, down] = [width, height].map(|side| side * factor);
        let all_width = COLUMNS * across + (COLUMNS + 1) * GAP;
        let all_height = ROWS * down + (ROWS + 1) * GAP;
        let mut bytes = Vec::with_capacity(3 * all_width * all_height);
        for y in 0..all_height {
            for x in 0..all_width {
                let place = |at: usize, side: usize, panels: usize| {
                    let at = at.checked_sub(GAP)?;
                    let (panel, inside) = (at / (side + GAP), at % (side + GAP));
                    (inside < side && panel < panels).then_some((panel, inside / factor))
                };
                let colour = match (place(x, across, COLUMNS), place(y, down, ROWS)) {
                    (Some((right, column)), Some((lower, row))) => {
                        panel(COLUMNS * lower + right, column, row)
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

    /// Returns the colour of every pixel in a picture of the copies of a set under the maps, within another; disks are grey.
    fn copies(&self, set: &Bits, within: &Bits) -> Vec<[u8; 3]> {
        let (width, height) = (set.width(), set.height());
        let palette = Palette::named("okabe-ito").unwrap_or_default();
        let mut colours = vec![WHITE; width * height];
        let mut fill = |point: DVec2, colour: [u8; 3]| {
            let (x, y) = (point.x, real(height) - point.y);
            if x >= 0.0 && y >= 0.0 && x < real(width) && y < real(height) {
                let [column, row] = [whole(x), whole(y)];
                if within.get(column, row) {
                    colours[row * width + column] = colour;
                }
            }
        };
        for [column, row] in within.set_boxes() {
            let point = centre([column, row], height);
            let is_in = |disk: &Disk| disk.centre.distance(point) <= disk.radius;
            if self.candidate.disks.iter().any(is_in) {
                fill(point, GREY);
            }
        }
        for (number, map) in (0i64..).zip(&self.candidate.maps) {
            let [red, green, blue, _] = palette.entry(number).rgba();
            for place in set.set_boxes() {
                fill(
                    map.transform_point2(centre(place, height)),
                    [red, green, blue],
                );
            }
        }
        colours
    }
}

/// Returns all pixels of a picture.
fn everywhere(shape: &Silhouette) -> Bits {
    let [width, height] = shape.size();
    Bits::new(width, height).complement()
}

/// Returns the colour of every pixel in a picture of a shape's skeleton, with its branch points and their disks.
fn skeleton(shape: &Silhouette) -> Vec<[u8; 3]> {
    let [width, height] = shape.size();
    let mut colours = vec![WHITE; width * height];
    for [column, row] in shape.bits().set_boxes() {
        colours[row * width + column] = [205; 3];
    }
    // A shape has pixels; where it is too large for distances, it is shown without a skeleton.
    let Ok(skeleton) = Skeleton::of(shape.bits(), &SkeletonOptions::default()) else {
        return colours;
    };
    let mut junctions: Vec<_> = { skeleton.nodes().iter() }
        .filter(|node| node.is_junction())
        .map(|node| node.point)
        .collect();
    junctions.sort_by(|one, other| other.radius.total_cmp(&one.radius));
    let mut apart: Vec<SkeletonPoint> = Vec::new();
    for point in junctions {
        if apart
            .iter()
            .all(|other| other.distance(&point) > other.radius)
        {
            apart.push(point);
        }
    }
    for point in &apart {
        let middle = centre([point.column, point.row], height);
        for place in shape.bits().set_boxes() {
            let away = centre(place, height).distance(middle);
            if (away - point.radius).abs() <= 0.5 {
                colours[place[1] * width + place[0]] = GREY;
            }
        }
    }
    for point in skeleton.points() {
        colours[point.row * width + point.column] = BLACK;
    }
    for node in skeleton.nodes().iter().filter(|node| node.is_junction()) {
        colours[node.point.row * width + node.point.column] = DIFFERENCE[0];
    }
    colours
}
