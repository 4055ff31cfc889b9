//! How wide strokes become where objects change widths.

use crate::instancing::Thickness;

use super::{Graph, Replacement};

impl Graph {
    /// Works out the most that strokes are widened, if any object changes widths: for graphs in which
    /// objects lead to those of larger numbers only.
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
            most[number] = match object.thickness {
                None => inner,
                Some(Thickness::Times(width)) => [width * inner[0], inner[1]],
                Some(Thickness::Set(width)) => [0.0, inner[1].max(width * inner[0])],
            };
        }
        let starts = self.initiators.iter().flat_map(|start| &start.instances);
        let widest = starts.flat_map(|instance| most[instance.object]);
        self.widest = Some(widest.fold(0.0, f64::max));
    }
}
