//! Lists of many instances that are not replaced, such as the faces of a mesh, gathered by frame.

use std::sync::Arc;

use crate::fast_hash::FastMap;
use crate::geometry::{Frame, Outline, Point};
use crate::graph::{Graph, Instance, Replacement, Successor};

/// Number of instances from which a list is gathered.
const MANY: usize = 64;

/// Number of instances for each part from which a list is gathered.
const CROWDED: usize = 4;

/// Rounding error of the bounds of a functional, relative to its terms.
const ROUNDING: f64 = 1e-12;

/// Ball that contains outlines.
#[derive(Clone, Copy)]
struct Ball<P> {
    centre: P,
    radius: f64,
}

impl<P: Point> Ball<P> {
    /// Returns the smallest of the known balls about an outline.
    fn about<F: Frame<Point = P>>(outline: &F::Outline) -> Self {
        let mut ends = [P::ZERO; 2];
        for (number, &axis) in P::AXES.iter().enumerate() {
            ends[number % 2] = ends[number % 2] + axis * outline.support(axis);
        }
        let centre = (ends[0] + ends[1]) * 0.5;
        Self {
            centre,
            radius: outline.radius_about(centre),
        }
    }

    /// Returns an upper bound of a linear functional on the ball.
    fn most(&self, vector: P, length: f64, offset: f64) -> f64 {
        let error = offset.abs() + length * (self.centre.length() + self.radius);
        offset + vector.dot(self.centre) + length * self.radius + ROUNDING * error
    }
}

/// Instances in one frame that are not replaced.
pub(super) struct Crowd<F: Frame> {
    frame: F,
    whole: Ball<F::Point>,
    /// Balls about the outlines, and the numbers of these.
    outlines: Vec<(Ball<F::Point>, usize)>,
}

impl<F: Frame> Crowd<F> {
    /// Returns the number of the instances.
    pub(super) fn len(&self) -> usize {
        self.outlines.len()
    }

    /// Returns the greatest value of a linear functional on the outlines, if it is above a known one, or else that.
    pub(super) fn farthest(
        &self,
        base_elements: &[F::Outline],
        outer: F::Point,
        offset: f64,
        known: f64,
    ) -> f64 {
        let vector = self.frame.pullback(outer);
        let offset = offset + outer.dot(self.frame.origin());
        let length = vector.length();
        if self.whole.most(vector, length, offset) <= known {
            return known;
        }
        let mut farthest = known;
        for (ball, outline) in &self.outlines {
            if ball.most(vector, length, offset) > farthest {
                farthest = farthest.max(offset + base_elements[*outline].support(vector));
            }
        }
        farthest
    }

    /// Encloses all outlines.
    fn close(&mut self) {
        let balls = || self.outlines.iter().map(|(ball, _)| *ball);
        let corner = |ball: Ball<F::Point>| ball.centre;
        let min = balls().map(corner).fold(F::Point::INFINITY, F::Point::min);
        let max = { balls().map(corner) }.fold(F::Point::NEG_INFINITY, F::Point::max);
        let centre = (min + max) * 0.5;
        let reach = balls().map(|ball| (ball.centre - centre).length() + ball.radius);
        let radius = reach.fold(0.0, f64::max);
        self.whole = Ball { centre, radius };
    }
}

/// Part of a list of instances that take the place of an object.
pub(super) enum Part<F: Frame> {
    /// An instance that is replaced, by its number.
    Replaced(usize),
    /// Instances that are not.
    Crowd(Crowd<F>),
}

/// Long lists of instances, in parts.
pub(super) struct Crowds<F: Frame> {
    lists: Vec<Vec<Part<F>>>,
    /// Number of the list in the place of each object.
    of_objects: Vec<Option<usize>>,
}

impl<F: Frame> Crowds<F> {
    /// Gathers the instances that are drawn in the limit.
    pub(super) fn of(graph: &Graph<F>, alive: &[bool]) -> Self {
        let mut balls = FastMap::default();
        let mut known = FastMap::default();
        let mut lists = Vec::new();
        let of_objects = graph.objects().iter().map(|object| {
            let Replacement::Fixed(successor) = &object.replacement else {
                return None;
            };
            let instances = &successor.body.instances;
            if instances.len() < MANY || !successor.seeds.is_empty() {
                return None;
            }
            *known.entry(Arc::as_ptr(successor)).or_insert_with(|| {
                let parts = parts(graph, alive, instances, &mut balls);
                let is_crowded = parts.len() <= instances.len() / CROWDED;
                is_crowded.then(|| {
                    lists.push(parts);
                    lists.len() - 1
                })
            })
        });
        let of_objects = of_objects.collect();
        Self { lists, of_objects }
    }

    /// Returns the parts of the list in the place of an object, if that is gathered.
    pub(super) fn in_place_of(&self, object: usize) -> Option<&[Part<F>]> {
        Some(&self.lists[self.of_objects[object]?])
    }

    /// Returns those instances in the place of an object that may be replaced.
    pub(super) fn replaced<'g>(
        &self,
        object: usize,
        successor: &'g Successor<F>,
    ) -> Vec<&'g Instance<F>> {
        let Some(parts) = self.in_place_of(object) else {
            return { successor.placed_instances() }.map(|(_, it)| it).collect();
        };
        let replaced = parts.iter().filter_map(|part| match part {
            Part::Replaced(number) => Some(&successor.body.instances[*number]),
            Part::Crowd(_) => None,
        });
        replaced.collect()
    }
}

/// Returns a list in parts: instances that are replaced, and between these, all others, by frame.
fn parts<F: Frame>(
    graph: &Graph<F>,
    alive: &[bool],
    instances: &[Instance<F>],
    balls: &mut FastMap<usize, Ball<F::Point>>,
) -> Vec<Part<F>> {
    let mut parts: Vec<Part<F>> = Vec::new();
    // The first crowd after the last instance that is replaced, and that of the last instance.
    let (mut first, mut last) = (0, 0);
    for (number, instance) in instances.iter().enumerate() {
        let object = &graph.objects()[instance.object];
        if !alive[instance.object] {
            continue;
        }
        if matches!(object.replacement, Replacement::Fixed(_)) {
            parts.push(Part::Replaced(number));
            (first, last) = (parts.len(), parts.len());
            continue;
        }
        let Some(outline) = graph.drawn(instance.object) else {
            continue;
        };
        let ball = balls.entry(object.base_element);
        let ball = *ball.or_insert_with(|| Ball::about::<F>(outline));
        let next = (ball, object.base_element);
        // Outlines follow each other in one frame, or each in all frames in turn.
        let turn = [
            last,
            if last + 1 < parts.len() {
                last + 1
            } else {
                first
            },
        ];
        let is_in_frame = |at: &usize| match parts.get(*at) {
            Some(Part::Crowd(crowd)) => crowd.frame == instance.frame,
            _ => false,
        };
        last = turn.into_iter().find(is_in_frame).unwrap_or(parts.len());
        match parts.get_mut(last) {
            Some(Part::Crowd(crowd)) => crowd.outlines.push(next),
            _ => parts.push(Part::Crowd(Crowd {
                frame: instance.frame,
                whole: ball,
                outlines: vec![next],
            })),
        }
    }
    for part in &mut parts {
        if let Part::Crowd(crowd) = part {
            crowd.close();
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

    use std::fmt::Write;

    use super::super::Balls;
    use super::*;
    use crate::Fractal;

    /// Boxes of a mesh are the same where its faces are looked at one by one.
    #[test]
    fn crowds_reach_as_far_as_their_instances() {
        let mut text = "kind: ifs\nspace: 3\nmaps:\n  - {scale: 0.6, translate: [0, 1, 0]}\n  - {scale: 0.7, \
                        rotate: [{z: 35}, {y: 120}], translate: [0, 1, 0]}\ncondensation:\n  - mesh:\n      points: ["
            .to_owned();
        for number in 0..100 {
            let at = f64::from(number);
            let [x, y, z] = [0.754, 0.569, 0.37].map(|step| at * step % 1.0);
            write!(text, "[{x}, {y}, {z}], ").unwrap();
        }
        text += "]\n      faces: [";
        for number in 0..98 {
            write!(text, "[{number}, {}, {}], ", number + 1, number + 2).unwrap();
        }
        text += "]\n  - {sphere: {radius: 0.2}}\n";
        let model = Fractal::parse(&text).unwrap();
        let graph = model.model().compile_in_space(false).unwrap();
        let mut balls = Balls::of(&graph);
        let crowded = { balls.crowds.of_objects.iter() }.filter(|it| it.is_some());
        assert_eq!((crowded.count(), balls.crowds.lists.len()), (3, 1));
        let gathered = { balls.crowds.lists[0].iter() }.map(|part| match part {
            Part::Replaced(_) => 1,
            Part::Crowd(crowd) => crowd.len(),
        });
        // Three faces lie on lines; the sphere is in the frames of the others.
        assert_eq!(gathered.collect::<Vec<_>>(), [1, 1, 96, 96]);
        let start = &graph.initiator(0).instances;
        let found = graph.limit_bounds_by(&balls, start);
        let looked = balls.looked.take();
        balls.crowds.of_objects.fill(None);
        assert_eq!(graph.limit_bounds_by(&balls, start), found);
        assert_eq!(balls.looked.get(), looked);
        assert!(found.is_some() && looked > 1000);
    }
}
