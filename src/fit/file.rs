//! A fit as a file that can be grown and changed.

use std::fmt::Write as _;

use crate::geometry::{DAffine2, DVec2};
use crate::measure::exact::Hausdorff;

use super::candidate::is_similar;
use super::snap::nearest_ratio;
use super::{Fit, Silhouette};

/// Digits after the decimal point of numbers in pixels.
const DIGITS: usize = 6;
/// Digits after the decimal point of factors and angles.
const FACTORS: usize = 6;

impl Fit {
    /// Returns the system as a file of the kind `ifs`, which `kfrac grow` draws in the place of the picture: its view is
    /// the frame of the picture. The unit is a pixel, and the origin the middle of the shape. The parameter `bend`, in
    /// degrees, is added to the angle of every map. `name` is the picture's, for title and source.
    #[must_use]
    pub fn yaml(&self, shape: &Silhouette, name: &str) -> String {
        let mut text = String::new();
        let name: String = name
            .chars()
            .filter(|it| !it.is_control() && !"\"\\".contains(*it))
            .collect();
        // Writing to a string does not fail.
        let _ = self.write(&mut text, shape, &name);
        text
    }

    fn write(&self, text: &mut String, shape: &Silhouette, name: &str) -> std::fmt::Result {
        let score = &self.score;
        let middle = shape.middle();
        let [width, height] = shape.size();
        let disks = match self.candidate.disks.len() {
            0 => String::new(),
            1 => " and a disk".into(),
            count => format!(" and {count} disks"),
        };
        let dimension = match &self.dimension {
            Some(dimension) => format!("; dimension {}", described(dimension)),
            None => String::new(),
        };
        writeln!(text, "title: \"Fit of {name}\"")?;
        writeln!(
            text,
            "about: \"{} maps{disks}, by {}{dimension}. Intersection over union {:.4}, Hausdorff distance {:.2} pixels; \
             collage {:.2} pixels, contraction {:.4}.\"",
            self.candidate.maps.len(),
            self.method.name(),
            score.iou,
            score.hausdorff,
            self.certificate.collage,
            self.certificate.contraction,
        )?;
        writeln!(
            text,
            "source: \"the picture {name}, {width} x {height} pixels\""
        )?;
        writeln!(text, "kind: ifs")?;
        writeln!(text, "params:")?;
        writeln!(
            text,
            "  # Degrees by which every copy is turned about the image of the origin."
        )?;
        writeln!(text, "  bend: {{value: 0, min: -180, max: 180}}")?;
        writeln!(
            text,
            "# The unit is a pixel; the origin is the middle of the shape."
        )?;
        writeln!(text, "maps:")?;
        let there = DAffine2::from_translation(-middle);
        let own = self.candidate.moved(&there);
        let names = names(&own.maps, shape.radius());
        let weights = match &self.density {
            Some(density) => density.weights.clone(),
            None => weights(&own.maps),
        };
        for ((map, name), weight) in own.maps.iter().zip(names).zip(weights) {
            writeln!(
                text,
                "  {name}: {{{}, weight: {}}}",
                written(map),
                decimal(weight, 4)
            )?;
        }
        if !own.disks.is_empty() {
            writeln!(text, "condensation:")?;
        }
        for disk in &own.disks {
            let centre = point(disk.centre);
            let radius = decimal(disk.radius, DIGITS);
            writeln!(text, "  - {{disk: {{centre: {centre}, radius: {radius}}}}}")?;
        }
        let [left, bottom] = [-middle.x, -middle.y].map(|it| decimal(it, DIGITS));
        writeln!(text, "# The frame of the picture.")?;
        writeln!(
            text,
            "view: {{window: [{left}, {bottom}, {width}, {height}], margin: 0}}"
        )
    }
}

/// Describes a dimension: its value and closed form, or its bound.
pub(super) fn described(dimension: &Hausdorff) -> String {
    let value = |value: f64| decimal(value, 6);
    match (
        dimension.value,
        &dimension.closed_form,
        dimension.upper_bound,
    ) {
        (Some(exact), Some(form), _) if *form != value(exact) => {
            format!("{form} = {}", value(exact))
        }
        (Some(exact), ..) => value(exact),
        (None, _, Some(bound)) => format!("at most {}", value(bound)),
        (None, _, None) => "unknown".into(),
    }
}

/// Returns a map as written in a file.
fn written(map: &DAffine2) -> String {
    let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis];
    let angle = libm::atan2(x.y, x.x).to_degrees();
    let flips = map.matrix2.determinant() < 0.0;
    let sign = if flips { -1.0 } else { 1.0 };
    let [along, across] = [x.length(), sign * y.length()];
    let turn = |angle: f64| format!("{} + bend", decimal(angle, FACTORS));
    let shift = point(map.translation);
    let ratio = |value: f64| {
        let simple = nearest_ratio(value.abs(), 1e-9).map(|(_, text)| text);
        let text = simple.unwrap_or_else(|| decimal(value.abs(), FACTORS));
        if value < 0.0 {
            format!("-{text}")
        } else {
            text
        }
    };
    if is_similar(&map.matrix2) && !flips {
        return format!(
            "scale: {}, rotate: {}, translate: {shift}",
            ratio(along),
            turn(angle)
        );
    }
    let other = libm::atan2(-sign * y.x, sign * y.y).to_degrees();
    let scale = format!("[{}, {}]", ratio(along), ratio(across));
    let rotate = format!("[{}, {}]", turn(angle), turn(other));
    format!("scale: {scale}, rotate: {rotate}, translate: {shift}")
}

fn point(point: DVec2) -> String {
    format!(
        "[{}, {}]",
        decimal(point.x, DIGITS),
        decimal(point.y, DIGITS)
    )
}

/// Returns a number with at most `digits` digits after the decimal point.
fn decimal(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

/// Returns the names of maps by the direction of their copies from the middle of the shape, which is the origin.
fn names(maps: &[DAffine2], radius: f64) -> Vec<String> {
    const DIRECTIONS: [&str; 8] = [
        "right",
        "upper-right",
        "top",
        "upper-left",
        "left",
        "lower-left",
        "bottom",
        "lower-right",
    ];
    let direction = |map: &DAffine2| {
        let shift = map.translation;
        if shift.length() < 0.12 * radius {
            return "middle";
        }
        let eighth = libm::atan2(shift.y, shift.x) / std::f64::consts::FRAC_PI_4;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "there are eight directions"
        )]
        let eighth = (eighth.round() as i32).rem_euclid(8);
        DIRECTIONS[usize::try_from(eighth).unwrap_or(0)]
    };
    let all: Vec<&str> = maps.iter().map(direction).collect();
    let numbered = all.iter().enumerate().map(|(number, name)| {
        let before = all[..number].iter().filter(|other| *other == name).count();
        let is_alone = all.iter().filter(|other| *other == name).count() == 1;
        if is_alone {
            (*name).to_owned()
        } else {
            format!("{name}-{}", before + 1)
        }
    });
    numbered.collect()
}

/// Returns weights in proportion to the areas of copies, none below a hundredth.
pub(super) fn weights(maps: &[DAffine2]) -> Vec<f64> {
    let areas = maps.iter().map(|map| map.matrix2.determinant().abs());
    let total: f64 = areas.clone().sum();
    areas
        .map(|area| (area / total.max(1e-12)).max(0.01))
        .collect()
}
