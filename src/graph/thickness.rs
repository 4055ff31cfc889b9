//! How wide strokes become where objects change widths.

use crate::instancing::Thickness;

use super::{Graph, Replacement};

impl Graph {
    /// Works out the most that strokes are widened, if any object changes widths: without bound where an
    /// object comes to itself again, and wider.
    pub(super) fn find_widths(&mut self) {
        if !{ &self.objects }
            .iter()
            .any(|object| object.thickness.is_some())
        {
            return;
        }
        // What an object comes to is at most so many times as wide as what it stands in is, or so wide
        // whatever it stands in.
        let mut most = vec![[1.0f64, 0.0]; self.objects.len()];
        // Objects of levels lead to those of larger numbers, so that one sweep from the back finds all. Where
        // there are cycles, they are longer than the graph only if widths grow along them (Bellman 1958).
        let mut sweeps = 0..=self.objects.len();
        let settled = sweeps.any(|_| !self.widen(&mut most));
        let starts = self.initiators.iter().flat_map(|start| &start.instances);
        let widest = starts.flat_map(|instance| most[instance.object]);
        let widest = widest.fold(0.0, f64::max);
        self.widest = Some(if settled { widest } else { f64::INFINITY });
    }

    /// Takes one sweep from the back; whether anything becomes wider.
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
                Replacement::Fixed(production) => {
                    let instances = &production.body.instances;
                    instances.iter().for_each(|instance| add(instance.object));
                }
                Replacement::Evaluated(alternatives) => {
                    let objects = alternatives.iter().flat_map(|all| &all.objects);
                    objects.for_each(|&object| add(object));
                }
                Replacement::Kept | Replacement::Beyond => {}
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
