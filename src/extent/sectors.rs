//! Instances that can reach farthest, found once for sectors of directions.

use crate::geometry::{DVec2, Frame, Frame2};
use crate::graph::Instance;

use super::bounded::Hulls;

/// Least and largest number of instances for which sectors are worth their cost: for fewer, all are looked at.
const MANY: std::ops::RangeInclusive<usize> = 64..=4096;

/// Maximum number of sectors.
const MOST: usize = 256;

/// Maximum number of support functions that are evaluated.
const MAX_WORK: usize = 1 << 18;

/// Distance by which the others must fall short, relative to the size, so that rounding drops none.
const MARGIN: f64 = 1e-9;

/// Instances in the place of an object that may reach farthest in the limit, for each of some equal sectors of directions.
pub(super) struct Sectors {
    /// Numbers of the instances, in rising order, for each sector from the x axis on, counter-clockwise.
    contenders: Vec<Vec<u32>>,
}

impl Sectors {
    /// Examines the instances in the place of an object; `None` if they are few or too many. `within` is the error of the
    /// object's polygon.
    ///
    /// Support functions are convex: between two directions, that of an image lies below the plane through both values. An
    /// image does not contend if at both directions it reaches less far than one point of the whole, less the error.
    pub(super) fn of(
        hulls: &impl Hulls<Frame2>,
        object: usize,
        within: f64,
        instances: &[Instance],
    ) -> Option<Self> {
        if !MANY.contains(&instances.len()) {
            return None;
        }
        let sectors = MOST.min(MAX_WORK / instances.len());
        #[expect(clippy::cast_precision_loss, reason = "there are few sectors")]
        let direction = |half: usize| {
            let angle = std::f64::consts::PI * half as f64 / sectors as f64;
            DVec2::new(libm::cos(angle), libm::sin(angle))
        };
        let corners = hulls.corners(object);
        let along = |vector: DVec2| corners.iter().map(move |corner| corner.dot(vector));
        let size = along(DVec2::X).chain(along(DVec2::Y));
        let lost = within + MARGIN * size.map(f64::abs).fold(0.0, f64::max);
        let reached: Vec<Vec<f64>> = (0..sectors)
            .map(|sector| {
                let vector = direction(2 * sector);
                let reached = instances.iter().map(|instance| {
                    let [most, _] = hulls.along(instance.object, instance.frame.pullback(vector));
                    vector.dot(instance.frame.origin()) + most
                });
                reached.collect()
            })
            .collect();
        let contenders = (0..sectors).map(|sector| {
            let middle = direction(2 * sector + 1);
            let farther = |a: &&DVec2, b: &&DVec2| a.dot(middle).total_cmp(&b.dot(middle));
            let farthest = corners.iter().max_by(farther)?;
            let sides = [sector, (sector + 1) % sectors];
            let sides = sides.map(|side| {
                let least = farthest.dot(direction(2 * side)) - lost;
                (least, &reached[side])
            });
            let contends = |number: &usize| {
                let mut sides = sides.iter();
                // An image whose reach is not a number contends.
                !sides.all(|(least, reached)| reached[*number] < *least)
            };
            let numbers = (0..instances.len()).filter(contends);
            numbers.map(|number| u32::try_from(number).ok()).collect()
        });
        let contenders = contenders.collect::<Option<_>>()?;
        Some(Self { contenders })
    }

    /// Returns the numbers of the instances that may reach farthest along a vector; `None` if its coordinates are not finite.
    pub(super) fn along(&self, vector: DVec2) -> Option<&[u32]> {
        if !vector.is_finite() {
            return None;
        }
        let turns = libm::atan2(vector.y, vector.x) / std::f64::consts::TAU;
        #[expect(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "there are few sectors"
        )]
        let sector = (turns.rem_euclid(1.0) * self.contenders.len() as f64) as usize;
        let sector = sector.min(self.contenders.len() - 1);
        Some(&self.contenders[sector])
    }
}
