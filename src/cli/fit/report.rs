//! The measures of a fit, as text and JSON.

use std::fmt::Write as _;

use serde::Serialize;

use crate::fit::{Fit, Rival, Silhouette};

use super::super::pixels::PixelSet;

#[derive(Serialize)]
pub(super) struct Report<'a> {
    picture: &'a str,
    width: usize,
    height: usize,
    threshold: u8,
    pixels: u64,
    method: &'static str,
    maps: usize,
    disks: usize,
    exact: bool,
    iou: f64,
    boundary_iou: f64,
    hausdorff: f64,
    hausdorff95: f64,
    mean_distance: f64,
    coverage: f64,
    collage: f64,
    contraction: f64,
    bound: f64,
    bits: u64,
    bits_per_pixel: f64,
    evaluations: usize,
    seed: u64,
    description: f64,
    dimension: Dimension<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    density: Option<Density<'a>>,
    others: Vec<Other>,
    #[serde(skip)]
    dimension_in_words: Option<String>,
}

/// The dimension of the attractor.
#[derive(Serialize)]
struct Dimension<'a> {
    value: Option<f64>,
    closed_form: Option<&'a str>,
    upper_bound: Option<f64>,
}

/// The weights of the maps, and the distance of their measure.
#[derive(Serialize)]
struct Density<'a> {
    weights: &'a [f64],
    distance: f64,
}

/// The result of a method that another one surpassed.
#[derive(Serialize)]
struct Other {
    method: &'static str,
    maps: usize,
    disks: usize,
    iou: f64,
    hausdorff: f64,
    description: f64,
}

impl<'a> Report<'a> {
    pub(super) fn new(set: &'a PixelSet, shape: &Silhouette, fit: &'a Fit, seed: u64) -> Self {
        let dimension = fit.dimension.as_ref();
        let [width, height] = shape.size();
        let score = &fit.score;
        Self {
            picture: &set.name,
            width,
            height,
            threshold: set.threshold,
            pixels: shape.bits().count(),
            method: fit.method.name(),
            maps: fit.candidate.maps.len(),
            disks: fit.candidate.disks.len(),
            exact: fit.exact,
            iou: score.iou,
            boundary_iou: score.boundary_iou,
            hausdorff: score.hausdorff,
            hausdorff95: score.hausdorff95,
            mean_distance: score.mean_distance,
            coverage: score.coverage,
            collage: fit.certificate.collage,
            contraction: fit.certificate.contraction,
            bound: fit.certificate.bound,
            bits: fit.bits,
            bits_per_pixel: fit.bits_per_pixel(shape),
            evaluations: fit.evaluations,
            seed,
            description: fit.description,
            dimension: Dimension {
                value: dimension.and_then(|it| it.value),
                closed_form: dimension.and_then(|it| it.closed_form.as_deref()),
                upper_bound: dimension.and_then(|it| it.upper_bound),
            },
            density: fit.density.as_ref().map(|density| Density {
                weights: &density.weights,
                distance: density.distance,
            }),
            others: { fit.others.iter() }.map(Other::of).collect(),
            dimension_in_words: fit.dimension_in_words(),
        }
    }

    /// Returns the numbers of maps and disks in words.
    pub(super) fn system(&self) -> String {
        system(self.maps, self.disks)
    }

    /// Describes the fit in text.
    pub(super) fn described(&self, shape: &str) -> String {
        let mut text = String::new();
        let mut line = |label: &str, value: &str| {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{label:<14}{value}");
        };
        line("shape", shape);
        line("system", &format!("{}, by {}", self.system(), self.method));
        for (number, other) in self.others.iter().enumerate() {
            let label = if number == 0 { "others" } else { "" };
            line(label, &other.described(self.description));
        }
        let exact = if self.exact { ": the same picture" } else { "" };
        line(
            "overlap",
            &format!(
                "{:.4} of the union, {:.4} along the boundaries{exact}",
                self.iou, self.boundary_iou
            ),
        );
        line(
            "distance",
            &format!(
                "{:.2} pixels at most, {:.2} for 95 %, {:.3} in the mean",
                self.hausdorff, self.hausdorff95, self.mean_distance
            ),
        );
        line(
            "collage",
            &format!(
                "{:.2} pixels, contraction {:.4}: at most {:.2} pixels by the collage theorem",
                self.collage, self.contraction, self.bound
            ),
        );
        line(
            "size",
            &format!("{} bits, {:.4} a pixel", self.bits, self.bits_per_pixel),
        );
        if let Some(dimension) = &self.dimension_in_words {
            line("dimension", dimension);
        }
        if let Some(density) = &self.density {
            let away = 100.0 * density.distance;
            line(
                "density",
                &format!("{away:.1} % of the mass lies elsewhere, in squares of 1/16"),
            );
        }
        line("evaluations", &self.evaluations.to_string());
        text
    }
}

impl Other {
    fn of(rival: &Rival) -> Self {
        Self {
            method: rival.method.name(),
            maps: rival.candidate.maps.len(),
            disks: rival.candidate.disks.len(),
            iou: rival.score.iou,
            hausdorff: rival.score.hausdorff,
            description: rival.description,
        }
    }

    /// Describes by how much the result is worse than the best one, whose description has a number of bits.
    fn described(&self, best: f64) -> String {
        format!(
            "{}: {}, overlap {:.4}, distance {:.2}, {:.0} bits longer",
            self.method,
            system(self.maps, self.disks),
            self.iou,
            self.hausdorff,
            self.description - best
        )
    }
}

fn system(maps: usize, disks: usize) -> String {
    let maps = match maps {
        1 => "1 map".into(),
        count => format!("{count} maps"),
    };
    match disks {
        0 => maps,
        1 => format!("{maps} and a disk"),
        count => format!("{maps} and {count} disks"),
    }
}
