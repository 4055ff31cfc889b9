//! Largest stroke width in graphs whose objects change widths.

use crate::geometry::Frame;
use crate::instancing::Thickness;

use super::{Graph, Replacement};

impl<F: Frame> Graph<F> {
    /// Computes the largest factor of stroke widths, if any object changes them; it is infinite if an
    /// object leads back to itself with a larger width.
    pub(crate) fn find_widths(&mut self) {
        if !{ &self.objects }
            .iter()
            .any(|object| object.thickness.is_some())
        {
            return;
        }
        // Largest width in the subtree of each object, as a factor of the enclosing width, and as a width
        // set regardless of it.
        let mut most = vec![[1.0f64, 0.0]; self.objects.len()];
        // Objects of time-indexed graphs lead to objects of larger numbers: one backward sweep suffices.
        // With cycles, more sweeps than objects are needed only if widths grow along a cycle (Bellman
        // 1958).
        let mut sweeps = 0..=self.objects.len();
        let settled = sweeps.any(|_| !self.widen(&mut most));
        let starts = self.initiators.iter().flat_map(|start| &start.instances);
        let widest = starts.flat_map(|instance| most[instance.object]);
        let widest = widest.fold(0.0, f64::max);
        self.widest = Some(if settled { widest } else { f64::INFINITY });
    }

    /// Performs one backward sweep; returns whether any width grows.
    fn widen(&self, most: &mut [[f64; 2]]) -> bool {
        let mut grows = false;
        for (number, object) in self.objects.iter().enumerate().rev() {
            let mut inner = [1.0f64, 0.0f64];
            let mut add = |child: usize| {
                for (own, child) in inner.iter_mut().zip(most[child]) {
                    *own = own.max(child);
                }
            };
            match &object.replacement {
                Replacement::Fixed(successor) => {
                    let instances = &successor.body.instances;
                    instances.iter().for_each(|instance| add(instance.object));
                }
                Replacement::Evaluated(alternatives) => {
                    let objects = alternatives.iter().flat_map(|all| &all.objects);
                    objects.for_each(|&object| add(object));
                }
                Replacement::Kept | Replacement::Unresolved => {}
            }
            let widths = match object.thickness {
                None => inner,
                Some(Thickness::Times(width)) => [width * inner[0], inner[1]],
                Some(Thickness::Set(width)) => [0.0, inner[1].max(width * inner[0])],
            };
            grows |= widths.iter().zip(most[number]).any(|(a, b)| *a > b);
            most[number] = widths;
        }
        grows
    }
}
