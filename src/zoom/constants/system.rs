//! Maps of an iterated function system.

use std::sync::Arc;

use crate::document::{
    IfsDocument, InterpolationDocument, LinearDocument, MapDocument, MapsDocument, Scales,
};
use crate::expression::Precise;
use crate::graph::{Graph, Instance};
use crate::ifs::System;
use crate::zoom::fixed::{Fixed, Vector, product};

use super::Numbers;

/// Maps of an iterated function system.
pub(super) struct OfSystem<'a> {
    system: &'a System,
    maps: Vec<Arc<Fixed>>,
}

impl<'a> OfSystem<'a> {
    pub(super) fn new(
        document: &IfsDocument,
        system: &'a System,
        omitted: &[u32],
        numbers: &mut Numbers,
    ) -> Self {
        let written = match &document.maps {
            Some(MapsDocument::Listed(maps)) => maps.iter().map(|it| numbers.map(it)).collect(),
            Some(MapsDocument::Vertices { points, shrink }) => {
                let toward = |point| {
                    let factor = numbers.fixed(shrink, &[]);
                    let mut map = Fixed::identity(numbers.bits());
                    (map.axes[0][0], map.axes[1][1]) = (factor.clone(), factor);
                    about(map, &numbers.point(point, &[]), numbers.bits())
                };
                points.iter().map(toward).collect()
            }
            Some(MapsDocument::Interpolated(document)) => numbers.interpolated(document, system),
            None => Vec::new(),
        };
        let stays = |number: &u32| !omitted.contains(number);
        let left = (1..).zip(written).filter(|(number, _)| stays(number));
        Self {
            system,
            maps: left.map(|(_, map)| Arc::new(map)).collect(),
        }
    }

    pub(super) fn child(&self, graph: &Graph, instance: &Instance, bits: usize) -> Arc<Fixed> {
        let origin = graph.objects()[instance.object].origin;
        let maps = self.system.ifs().maps();
        // The instance of a condensation set may have the origin of a map without being under it.
        let map = origin.filter(|&map| maps[map].affine == *instance.frame.map());
        map.map_or_else(
            || Arc::new(Fixed::identity(bits)),
            |map| Arc::clone(&self.maps[map]),
        )
    }
}

/// Returns a linear map about a point, which it fixes.
fn about(map: Fixed, point: &Vector, bits: usize) -> Fixed {
    let [x, y] = map.image(point, bits);
    Fixed {
        origin: [&point[0] - x, &point[1] - y],
        ..map
    }
}

impl Numbers {
    fn map(&mut self, document: &MapDocument) -> Fixed {
        let bits = self.bits();
        let mut map = Fixed::identity(bits);
        match &document.linear {
            Some(LinearDocument::Matrix([first, second])) => {
                let [[a, c], [b, d]] = [first, second].map(|row| self.point(row, &[]));
                map.axes = [[a, b], [c, d]];
            }
            Some(LinearDocument::Axes { scale, rotate }) => {
                for axis in 0..2 {
                    let factor = self.fixed(&scale[axis], &[]);
                    let of = &mut map.axes[axis];
                    match rotate {
                        Some(angles) => {
                            let [cosine, sine] = self.turn(&angles[axis], &[]);
                            let turned = if axis == 0 {
                                [cosine, sine]
                            } else {
                                [-sine, cosine]
                            };
                            *of = turned.map(|part| product(&part, &factor, bits));
                        }
                        None => of[axis] = factor,
                    }
                }
            }
            Some(LinearDocument::Complex { times, conjugate }) => {
                let [u, v] = self.point(times, &[]);
                let across = [-&v, u.clone()];
                map.axes = if *conjugate {
                    let [a, b] = across;
                    [[u, v], [-a, -b]]
                } else {
                    [[u, v], across]
                };
            }
            None => {}
        }
        match (&document.shift, &document.fixed) {
            (_, Some(fixed)) => about(map, &self.point(fixed, &[]), bits),
            (Some(shift), None) => {
                let origin = self.point(shift, &[]);
                Fixed { origin, ..map }
            }
            (None, None) => map,
        }
    }

    /// Evaluates the maps of [`interpolate`](crate::ifs::interpolate). A factor derived from a dimension
    /// keeps its value as a double.
    fn interpolated(&mut self, document: &InterpolationDocument, system: &System) -> Vec<Fixed> {
        let bits = self.bits();
        let points = document.points.iter();
        let points: Vec<Vector> = points.map(|it| self.point(it, &[])).collect();
        let scales: Vec<_> = match &document.scale {
            Some(Scales::One(number)) => vec![self.fixed(number, &[])],
            Some(Scales::Each(all)) => all.iter().map(|it| self.fixed(it, &[])).collect(),
            None => {
                let found = system.ifs().maps().first();
                let scale = found.map_or(0.0, |map| map.affine.matrix2.y_axis.y);
                vec![Precise::of(scale).fixed(bits)]
            }
        };
        let (first, last) = (&points[0], &points[points.len() - 1]);
        let whole = [&last[0] - &first[0], &last[1] - &first[1]];
        let maps = points.windows(2).zip(scales.iter().cycle());
        maps.map(|(ends, scale)| {
            let piece = [&ends[1][0] - &ends[0][0], &ends[1][1] - &ends[0][1]];
            let rise = &piece[1] - product(scale, &whole[1], bits);
            let along = [&piece[0], &rise].map(|part| (part << bits) / &whole[0]);
            let mut map = Fixed::identity(bits);
            map.axes = [along, [0.into(), scale.clone()]];
            let [x, y] = map.image(first, bits);
            map.origin = [&ends[0][0] - x, &ends[0][1] - y];
            map
        })
        .collect()
    }
}
