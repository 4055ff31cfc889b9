//! Refinement of a candidate on its attractor.

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::random::Pcg;

use super::candidate::Disk;
use super::cma::{Budget, Cma};
use super::collage::{Form, clamped};
use super::orbit::{Level, Orbit};
use super::{Candidate, Silhouette};

/// Numbers that describe a candidate, all of them of the size of pixels: images of two or three points of the shape
/// under each map, and centres and radii of disks.
pub(super) struct Numbers {
    middle: DVec2,
    radius: f64,
    form: Form,
    /// Whether each map reflects.
    flips: Vec<bool>,
    disks: usize,
}

impl Numbers {
    /// Describes the candidates for a shape that have the form of a candidate.
    pub(super) fn new(shape: &Silhouette, candidate: &Candidate, form: Form) -> Self {
        let flips = candidate
            .maps
            .iter()
            .map(|map| map.matrix2.determinant() < 0.0);
        Self {
            middle: shape.middle(),
            radius: shape.radius().max(1.0),
            form,
            flips: flips.collect(),
            disks: candidate.disks.len(),
        }
    }

    /// Returns the numbers of a candidate.
    pub(super) fn of(&self, candidate: &Candidate) -> Vec<f64> {
        let mut numbers = Vec::new();
        for map in &candidate.maps {
            let image = map.transform_point2(self.middle);
            numbers.extend([image.x, image.y]);
            let axes = [map.matrix2.x_axis, map.matrix2.y_axis].map(|axis| axis * self.radius);
            numbers.extend(axes[0].to_array());
            if self.form == Form::Affine {
                numbers.extend(axes[1].to_array());
            }
        }
        for disk in &candidate.disks {
            numbers.extend([disk.centre.x, disk.centre.y, disk.radius]);
        }
        numbers
    }

    /// Returns the candidate that numbers describe; maps that stretch too much are shrunk.
    pub(super) fn candidate(&self, numbers: &[f64]) -> Candidate {
        let size = match self.form {
            Form::Similar => 4,
            Form::Affine => 6,
        };
        let (maps, disks) = numbers.split_at(numbers.len() - 3 * self.disks);
        let maps = maps
            .chunks_exact(size)
            .zip(&self.flips)
            .map(|(numbers, &flips)| {
                let image = DVec2::new(numbers[0], numbers[1]);
                let x_axis = DVec2::new(numbers[2], numbers[3]) / self.radius;
                let y_axis = match self.form {
                    Form::Similar if flips => -x_axis.perp(),
                    Form::Similar => x_axis.perp(),
                    Form::Affine => DVec2::new(numbers[4], numbers[5]) / self.radius,
                };
                let matrix = clamped(DMat2::from_cols(x_axis, y_axis));
                DAffine2::from_mat2_translation(matrix, image - matrix * self.middle)
            });
        let disks = disks.chunks_exact(3).map(|numbers| Disk {
            centre: DVec2::new(numbers[0], numbers[1]),
            radius: numbers[2].abs(),
        });
        Candidate {
            maps: maps.collect(),
            disks: disks.collect(),
        }
    }
}

/// A candidate with its loss at a level.
#[derive(Clone, Debug)]
pub(super) struct Refined {
    pub(super) candidate: Candidate,
    pub(super) form: Form,
    pub(super) loss: f64,
    pub(super) evaluations: usize,
}

/// Minimises the loss of a candidate, with steps of `step` pixels at first.
pub(super) fn refine(
    shape: &Silhouette,
    level: &Level,
    start: &Candidate,
    form: Form,
    step: f64,
    budget: Budget<'_>,
    random: Pcg,
) -> Refined {
    let numbers = Numbers::new(shape, start, form);
    let mut orbit = Orbit::new(level);
    let mut count = 0;
    let mut search = Cma::new(numbers.of(start), step, random);
    let found = search.minimise(budget, 0.01, |point| {
        count += 1;
        orbit.loss(&numbers.candidate(point), level)
    });
    Refined {
        candidate: numbers.candidate(&found.point),
        form,
        loss: found.value,
        evaluations: count,
    }
}
