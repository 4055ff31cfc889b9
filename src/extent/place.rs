//! Units of graphs whose approximants outgrow their initiators.

use crate::geometry::{Bounds, DVec2, Homothety, exponent_of};
use crate::graph::Graph;
use crate::rule::Placement;

/// Growth, as an exponent of 2, up to which coordinates keep their units.
const TALL: f64 = 64.0;

/// Largest growth, as an exponent of 2; above it, sums of elements side by side would leave the range of
/// doubles.
const MAX_GROWTH: f64 = 1010.0;

impl Graph {
    /// Scales the graph to the extent of an approximant that is much larger than the initiator, because
    /// generators have parts longer than the element that they replace; `None` if the approximant leaves
    /// the range of doubles.
    pub(crate) fn in_units_of(self, steps: u32) -> Option<Self> {
        let growth = f64::from(steps) * libm::log2(self.longest_ratio());
        if growth.is_nan() || growth <= TALL || !self.is_plain() {
            return Some(self);
        }
        let growth = libm::log2(self.longest_within(steps));
        if growth <= TALL {
            return Some(self);
        }
        if growth > MAX_GROWTH {
            return None;
        }
        // Scales by the growth of the longest element, which keeps the bounds in range, then by the
        // actual extent.
        let most = in_powers_of_two(growth);
        let (before, shift) = (self.place.exponent(), self.place.point(DVec2::ZERO));
        let small = self.started_within(&Homothety::new(most, DVec2::ZERO));
        let size = small.bounds(steps).as_ref().map(Bounds::size);
        let size = size.map_or(1.0, |size| size.max_element());
        let back = if size > 0.0 { exponent_of(size) } else { 0 };
        let exponent = before + most + back;
        let fits = exponent <= Homothety::<DVec2>::MAX_EXPONENT;
        fits.then(|| Self {
            place: Homothety::new(exponent, shift),
            ..small.started_within(&Homothety::new(back, DVec2::ZERO))
        })
    }
}

impl Graph {
    /// Returns the length of the longest element within some steps, as a multiple of the initiator
    /// element's.
    fn longest_within(&self, steps: u32) -> f64 {
        let mut lengths = vec![0.0; self.objects.len()];
        for start in self.starts().flat_map(|start| &start.instances) {
            lengths[start.object] = 1.0;
        }
        let mut longest: f64 = 1.0;
        for _ in 0..steps {
            let mut next = vec![0.0; lengths.len()];
            for (object, &length) in lengths.iter().enumerate().filter(|(_, it)| **it > 0.0) {
                for (placement, instance) in self.children(object) {
                    let length = match placement {
                        Placement::SeedsAsInitiator => 1.0,
                        _ => length * instance.length,
                    };
                    let known: &mut f64 = &mut next[instance.object];
                    *known = known.max(length);
                    longest = longest.max(length);
                }
            }
            if !longest.is_finite() {
                break;
            }
            lengths = next;
        }
        longest
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the number is that of an exponent"
)]
fn in_powers_of_two(exponent: f64) -> i32 {
    exponent.ceil() as i32
}
