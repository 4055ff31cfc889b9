//! Cells that tell the step in which what covers them is born.
//!
//! Elements of a later step cover those of earlier ones, so that a point goes on from a cell once in every
//! step, and as long as what it is a point of is replaced.

use super::field::{Field, TooFar};
use super::{BLOCK, Found, LimitCells, Search, Stopped, WORTH_A_THREAD};
use super::{finished, looked_for, outlined};
use crate::geometry::{DAffine2, DMat2, DVec2, stretch};

/// A point of an outline, and the linear part of the map of the element in whose place that stands.
#[derive(Clone, Copy)]
struct Drawn {
    at: DVec2,
    linear: DMat2,
}

impl Drawn {
    #[inline]
    fn mapped(&self, map: &DAffine2) -> Self {
        Self {
            at: map.transform_point2(self.at),
            linear: map.matrix2 * self.linear,
        }
    }
}

impl LimitCells<'_> {
    /// Finds the cells of every layer that what is not replaced meets, by the last steps in which it is
    /// born. Elements are replaced down to a length.
    ///
    /// # Errors
    ///
    /// If that takes more work or more steps than are allowed, or if it is cancelled.
    pub(crate) fn find_steps(&self, search: &Search<'_>, shortest: f64) -> Result<Found, Stopped> {
        let nodes = &self.net.nodes;
        let first_layer = nodes.len() - self.layers;
        let new = |scale: f64| Field::new(search.scale * scale);
        // What is met in the next step, and at last in each layer.
        let mut met: Vec<Field> = { nodes.iter() }.map(|node| new(node.stretch)).collect();
        let mut layers = met.split_off(first_layer);
        let mut left = search.most_images;
        let mut take = |images: usize| -> Result<u64, Stopped> {
            search.check()?;
            left = left.checked_sub(images as u64).ok_or(Stopped::TooMany)?;
            Ok(left)
        };
        let mut wave: Vec<Vec<Drawn>> = Vec::new();
        for (number, node) in nodes.iter().enumerate() {
            let points = if node.stretch > 0.0 {
                outlined(self.graph, node, search.scale * node.stretch, take(0)?)?
            } else {
                Vec::new()
            };
            take(points.len())?;
            if number >= first_layer {
                for at in points {
                    layers[number - first_layer].label(at, 0)?;
                }
                continue;
            }
            let linear = DMat2::IDENTITY;
            let mut drawn = Vec::new();
            for at in points {
                if met[number].add(at)? {
                    drawn.push(Drawn { at, linear });
                }
            }
            wave.push(drawn);
        }
        let is_long = |drawn: &Drawn, scale: f64| stretch(&drawn.linear) * scale >= shortest;
        let mut step: u8 = 0;
        while wave.iter().any(|points| !points.is_empty()) {
            step = step.checked_add(1).ok_or(Stopped::TooMany)?;
            met.iter_mut().for_each(Field::clear);
            let mut next: Vec<Vec<Drawn>> = vec![Vec::new(); wave.len()];
            for (node, points) in nodes.iter().zip(&wave) {
                for block in points.chunks(BLOCK) {
                    let images = block.len() * node.images.len();
                    take(images)?;
                    let (met_before, layers_before) = (&met, &layers);
                    let is_new = |whole: usize, drawn: &Drawn| {
                        let scale = nodes[whole].stretch;
                        is_long(drawn, scale)
                            && match whole.checked_sub(first_layer) {
                                Some(layer) => !layers_before[layer].has_label(drawn.at, step),
                                None => !met_before[whole].holds(drawn.at),
                            }
                    };
                    let threads = search.threads.get().min(images / WORTH_A_THREAD);
                    let found = looked_for(block, threads, |drawn, found| {
                        let images = node.images.iter();
                        let images = images.map(|(map, whole)| (*whole, drawn.mapped(map)));
                        found.extend(images.filter(|(whole, image)| is_new(*whole, image)));
                    });
                    for (whole, image) in found {
                        match whole.checked_sub(first_layer) {
                            Some(layer) => layers[layer].label(image.at, step)?,
                            None if met[whole].add(image.at)? => next[whole].push(image),
                            None => {}
                        }
                    }
                }
            }
            wave = next;
        }
        Ok(Found {
            fields: finished(layers),
            images: search.most_images - take(0)?,
            steps: step.into(),
        })
    }
}

impl From<TooFar> for Stopped {
    fn from(_: TooFar) -> Self {
        Self::TooMany
    }
}
