//! The limit set of a graph as points or as occupied boxes, to arbitrary precision, with nothing drawn.

mod cascade;
mod cover;
mod descent;
mod facing;
mod groups;
mod moments;
mod slice;
mod states;

use crate::digraph::on_infinite_paths;
use crate::extent::{Bounded, NoLimit};
use crate::geometry::{Affine, Bounds, DAffine2, Linear, Point};
use crate::graph::{Graph, Instance};

use super::cover::{Counts, Grid};
use super::regression::Estimate;
use super::space::Space;
use crate::saturating::real;

use facing::reach;
use groups::{Shared, grouped, products, unzipped};

pub use cascade::Cascade;
pub(super) use moments::Moments;
pub use slice::SlicedSet;

/// The limit set of a graph's fertile elements: the attractor.
///
/// The limit of an element is a copy of its object's set, which is the union of the copies of its instances'
/// sets. Infertile elements are not replaced and add nothing.
#[derive(Clone, Debug)]
pub struct LimitSet<M: Affine = DAffine2> {
    objects: Vec<ObjectLimit<M>>,
    start: Vec<LimitCopy<M>>,
    bounds: Bounds<M::Point>,
    /// Whether the set is a [`SlicedSet`] by the plane z = 0, which is covered by one layer of boxes.
    is_layer: bool,
}

/// The limit set of an object, in its unit frame.
#[derive(Clone, Debug)]
struct ObjectLimit<M: Affine> {
    /// A point of the set, and the radius of a ball about it that holds the set.
    point: M::Point,
    radius: f64,
    /// Centre of a box that holds the set, and the radius of a ball about it that holds the set.
    middle: M::Point,
    reach: f64,
    children: Vec<LimitCopy<M>>,
}

/// A limit set, with the shares of its copies in the mass of their sets, and of those that the whole is made of.
struct Shares<M: Affine> {
    set: LimitSet<M>,
    shares: Vec<Vec<f64>>,
    masses: Vec<f64>,
}

/// A copy of an object's set: its map, and the largest factor by which the map lengthens a vector.
#[derive(Clone, Copy, Debug)]
struct LimitCopy<M> {
    map: M,
    scale: f64,
    /// Whether the map is a similarity.
    is_similar: bool,
    object: usize,
}

impl<M: Affine> LimitCopy<M> {
    fn new(map: M, object: usize) -> Self {
        const TOLERANCE: f64 = 1e-12;
        let linear = map.linear();
        let scale = linear.stretch();
        let volume = linear.determinant().abs();
        let cube: f64 = (0..M::Point::DIMENSION).map(|_| scale).product();
        Self {
            map,
            scale,
            is_similar: cube - volume <= TOLERANCE * volume,
            object,
        }
    }

    /// Returns the object's own set.
    fn whole(object: usize) -> Self {
        Self::new(M::IDENTITY, object)
    }

    /// Returns a copy inside this one.
    #[inline]
    fn compose(&self, inner: &Self) -> Self {
        let map = self.map * inner.map;
        let is_similar = self.is_similar && inner.is_similar;
        // Where maps are not similarities, the product of their norms far exceeds the norm of a long product
        // of maps.
        let scale = if is_similar {
            self.scale * inner.scale
        } else {
            map.linear().stretch()
        };
        Self {
            map,
            scale,
            is_similar,
            object: inner.object,
        }
    }

    /// Enlarges the copy by a factor, about 0.
    fn grow(&mut self, factor: f64) {
        self.map = M::new(self.map.linear() * factor, self.map.translation() * factor);
        self.scale *= factor;
    }

    fn moved(mut self, by: M::Point) -> Self {
        self.map = M::new(self.map.linear(), self.map.translation() + by);
        self
    }
}

/// Scale below which a copy counts as a point.
const NEGLIGIBLE: f64 = 1e-17;

/// Tolerance of bounding boxes, as a part of the size, where they are exact but for rounding.
const EXACT: f64 = 1e-13;

/// Maximum number of sweeps or levels of an iteration.
const MAX_SWEEPS: usize = 10_000;

/// Number of copies that are looked at for an extent in a direction.
const MAX_WORK: usize = 1 << 20;

impl<M: Space> LimitSet<M> {
    /// Creates the limit set of a graph's fertile elements.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no limit set, or if the graph does not determine it.
    pub fn of<F: Bounded<Map = M>>(graph: &Graph<F>) -> Result<Self, NoLimit> {
        graph.check_maps()?;
        if !graph.shrinks() {
            return Err(NoLimit::DoesNotShrink);
        }
        // Objects of one behaviour have equal sets.
        let firsts: Vec<usize> = graph.behaviours_by_number().map(|it| it.0).collect();
        let behaviour = |instance: &Instance<F>| graph.objects()[instance.object].behaviour;
        let fertile = |number: usize| graph.children(firsts[number]).map(|(_, instance)| instance);
        // Behaviours from which an infinite fertile path starts.
        let targets = (0..firsts.len()).map(|number| fertile(number).map(behaviour).collect());
        let lasting = on_infinite_paths(&targets.collect::<Vec<_>>());
        let kept = |instance: &&Instance<F>| lasting[behaviour(instance)];
        let placed = |instance: &Instance<F>| {
            let copy = LimitCopy::new(*instance.frame.map(), behaviour(instance));
            (copy, 1.0)
        };
        let children = |number| fertile(number).filter(kept).map(placed).collect();
        let children = (0..firsts.len()).map(children).collect();
        let start = graph.initiator(0).instances.iter();
        let start: Vec<_> = start.filter(kept).map(placed).collect();
        if start.is_empty() {
            return Err(NoLimit::NothingFertile);
        }
        let Shares { set, .. } = Self::of_copies(children, start).ok_or(NoLimit::ShrinksLate)?;
        Ok(set)
    }

    /// Creates the limit set from the copies in every object's set, and those that the whole is made of, each with its
    /// share. `None` if copies enlarge before they shrink, in products of too many.
    ///
    /// Precondition: objects that are copied contain copies in turn, and cycles contract.
    fn of_copies(mut children: Vec<Vec<Shared<M>>>, start: Vec<Shared<M>>) -> Option<Shares<M>> {
        loop {
            let own = children.len();
            let (objects, whole) = grouped(children.clone(), start.clone());
            let (objects, shares) = objects.into_iter().map(unzipped).unzip();
            let (whole, masses) = unzipped(whole);
            if let Some(set) = Self::of_groups(objects, own, whole) {
                return Some(Shares {
                    set,
                    shares,
                    masses,
                });
            }
            children = products(&children)?;
        }
    }

    /// Creates the limit set from the copies in every object's set; the objects from `own` on are groups.
    fn of_groups(
        children: Vec<Vec<LimitCopy<M>>>,
        own: usize,
        start: Vec<LimitCopy<M>>,
    ) -> Option<Self> {
        let part = |children| ObjectLimit {
            point: M::Point::ZERO,
            radius: 0.0,
            middle: M::Point::ZERO,
            reach: 0.0,
            children,
        };
        let mut set = Self {
            objects: children.into_iter().map(part).collect(),
            start,
            bounds: Bounds::EMPTY,
            is_layer: false,
        };
        set.find_points();
        set.find_radii(own)?;
        set.bounds = Self::extent(&set.objects, &set.start, EXACT, MAX_WORK);
        // A single point has no extent except by rounding.
        const ROUNDING: f64 = 1e-12;
        let scale = set.start.iter().map(|copy| copy.scale).fold(0.0, f64::max);
        if set.bounds.size().max_element() <= ROUNDING * scale {
            set.bounds = Bounds::new(set.bounds.min(), set.bounds.min());
        }
        Some(set)
    }

    /// Returns the bounding box of the set, to about 12 digits.
    #[must_use]
    pub fn bounds(&self) -> Bounds<M::Point> {
        self.bounds
    }

    /// Visits points of the set such that every point of it is within `distance` of one of them, until
    /// `visit` returns `false`.
    pub fn visit(&self, distance: f64, mut visit: impl FnMut(M::Point) -> bool) {
        let mut stack: Vec<_> = self.start.iter().rev().copied().collect();
        while let Some(copy) = stack.pop() {
            let part = &self.objects[copy.object];
            if part.radius * copy.scale <= distance {
                if !visit(copy.map.apply(part.point)) {
                    return;
                }
                continue;
            }
            let children = part.children.iter().rev();
            stack.extend(children.map(|inner| copy.compose(inner)));
        }
    }

    /// Returns the number above 1 of which all ratios are powers, if there is one: the structure of the set
    /// repeats at sizes that differ by this factor.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        const LEAST: f64 = 0.05;
        const TOLERANCE: f64 = 1e-9;
        let copies = self.objects.iter().flat_map(|part| &part.children);
        let mut common: f64 = 0.0;
        for copy in copies {
            // Euclid's algorithm on logarithms.
            let mut other = -libm::log(copy.scale);
            if other < -TOLERANCE {
                return None;
            }
            while other > TOLERANCE {
                (common, other) = (other, common.rem_euclid(other));
                if other > common - TOLERANCE {
                    other = 0.0;
                }
            }
        }
        (common > LEAST).then(|| libm::exp(common))
    }

    /// Returns the smallest factor by which a copy in an object's set is smaller, except for copies that are points.
    ///
    /// Sizes whose quotients are all larger show less than one generation of the set.
    #[must_use]
    pub fn smallest_scale(&self) -> f64 {
        let copies = self.objects.iter().flat_map(|part| &part.children);
        let scales = copies.map(|copy| copy.scale).filter(|scale| *scale > 0.0);
        scales.fold(1.0, f64::min)
    }

    /// Returns an estimate if its sizes span at least one generation of the smallest copies.
    pub(super) fn believed(&self, estimate: Estimate) -> Option<Estimate> {
        let [finest, coarsest] = estimate.range;
        let spans = estimate.sizes == 0 || finest <= coarsest * self.smallest_scale();
        spans.then_some(estimate)
    }

    /// Returns the dimension of the space, or of the plane of a slice.
    pub(super) fn space(&self) -> usize {
        M::Point::DIMENSION - usize::from(self.is_layer)
    }

    /// Returns the numbers of boxes along the axes of a box that is divided by a base.
    fn parts(&self, base: usize) -> Counts {
        match self.is_layer {
            true => [base, base, 1],
            false => M::boxes(base),
        }
    }

    /// Returns the translation that takes the layer in the middle of a divided box to the first one.
    fn to_layer(&self, base: usize) -> M::Point {
        match self.is_layer {
            true => M::Point::of_coordinates([0.0, 0.0, (1.0 - real(base)) / 2.0]),
            false => M::Point::ZERO,
        }
    }

    /// Returns the bounding box of the set, turned as a grid requires, to about 9 digits.
    pub(super) fn turned_bounds(&self, grid: &Grid<M>) -> Bounds<M::Point> {
        const TOLERANCE: f64 = 1e-9;
        let turn = M::new(grid.linear(), M::Point::ZERO);
        let turned = |copy: &LimitCopy<M>| LimitCopy {
            map: turn * copy.map,
            ..*copy
        };
        let start: Vec<_> = self.start.iter().map(turned).collect();
        let bounds = Self::extent(&self.objects, &start, TOLERANCE, MAX_WORK);
        match self.is_layer {
            true => Bounds::new(flattened(bounds.min()), flattened(bounds.max())),
            false => bounds,
        }
    }

    /// Finds a point of every object's set: the limit of a fixed aperiodic address, which is not a corner.
    fn find_points(&mut self) {
        for start in 0..self.objects.len() {
            let mut copy = LimitCopy::whole(start);
            for level in 0..MAX_SWEEPS {
                let children = &self.objects[copy.object].children;
                if children.is_empty() || copy.scale <= NEGLIGIBLE {
                    break;
                }
                // Multiples of the golden section do not repeat.
                let turn = (0x9e37_79b9_7f4a_7c15u64.wrapping_mul(level as u64 + 1) >> 33) as usize;
                copy = copy.compose(&children[turn % children.len()]);
            }
            self.objects[start].point = copy.map.translation();
        }
    }

    /// Computes the discs about all points and all centres; `None` if they are not bounded. The objects from
    /// `own` on are groups.
    fn find_radii(&mut self, own: usize) -> Option<()> {
        let points: Vec<M::Point> = self.objects.iter().map(|part| part.point).collect();
        let radii = self.radii_about(&points)?;
        for (part, radius) in self.objects.iter_mut().zip(radii) {
            part.radius = radius;
        }
        // The middles are those of discs, which need not be the smallest.
        let most_work = (4 * MAX_WORK / own.max(1)).max(MAX_WORK >> 12);
        let middle = |object| {
            const TOLERANCE: f64 = 1e-3;
            let whole = [LimitCopy::whole(object)];
            Self::extent(&self.objects, &whole, TOLERANCE, most_work).centre()
        };
        let lasting = |object: &usize| !self.objects[*object].children.is_empty();
        let middles =
            (0..own).map(|object| Some(object).filter(lasting).map_or(M::Point::ZERO, middle));
        let mut middles: Vec<M::Point> = middles.collect();
        middles.extend_from_slice(&points[own..]);
        let mut reaches = self.radii_about(&middles)?;
        if own < middles.len() {
            // The boxes of groups are those of the discs of their members, of which the inner ones come first.
            for (group, part) in self.objects.iter().enumerate().skip(own) {
                let mut bounds = Bounds::EMPTY;
                for copy in &part.children {
                    let around = M::Point::splat(copy.scale * reaches[copy.object]);
                    let at = copy.map.apply(middles[copy.object]);
                    bounds.add(at - around);
                    bounds.add(at + around);
                }
                middles[group] = bounds.centre();
                reaches[group] = bounds.size().length() / 2.0;
            }
            reaches = self.radii_about(&middles)?;
        }
        let discs = middles.into_iter().zip(reaches);
        for (part, (middle, reach)) in self.objects.iter_mut().zip(discs) {
            (part.middle, part.reach) = (middle, reach);
        }
        Some(())
    }

    /// Returns the smallest radii that solve r(o) = max |p(o) − f(p(c))| + ‖f‖ r(c) over the instances f of
    /// c, approached from below, for points p; larger ones where they are approached slowly. `None` if none are found.
    fn radii_about(&self, points: &[M::Point]) -> Option<Vec<f64>> {
        const TOLERANCE: f64 = 1e-9;
        const ROUNDING: f64 = 1e-6;
        let away = |object: usize, copy: &LimitCopy<M>| {
            (copy.map.apply(points[copy.object]) - points[object]).length()
        };
        let mut radii = vec![0.0; points.len()];
        let copies: usize = { self.objects.iter() }
            .map(|part| part.children.len())
            .sum();
        let sweeps = ((MAX_WORK << 6) / copies.max(1)).clamp(64, MAX_SWEEPS);
        for _ in 0..sweeps {
            let mut change: f64 = 0.0;
            for object in (0..self.objects.len()).rev() {
                let children = self.objects[object].children.iter();
                let reach =
                    children.map(|copy| away(object, copy) + copy.scale * radii[copy.object]);
                let radius = reach.fold(0.0, f64::max);
                change = change.max(radius - radii[object]);
                radii[object] = radius;
            }
            if change <= TOLERANCE {
                let larger = radii.iter().map(|radius| radius * (1.0 + ROUNDING));
                return Some(larger.collect());
            }
            if !change.is_finite() {
                return None;
            }
        }
        // The sum of a geometric series bounds all radii.
        let (mut farthest, mut largest) = (0.0, 0.0);
        for (object, part) in self.objects.iter().enumerate() {
            for copy in &part.children {
                farthest = f64::max(farthest, away(object, copy));
                largest = f64::max(largest, copy.scale);
            }
        }
        let radius = farthest / (1.0 - largest);
        (largest < 1.0).then(|| vec![radius * (1.0 + ROUNDING); points.len()])
    }

    /// Returns the bounding box of copies, to a part of their size, if about `most_work` copies suffice in every direction.
    fn extent(
        objects: &[ObjectLimit<M>],
        copies: &[LimitCopy<M>],
        tolerance: f64,
        most_work: usize,
    ) -> Bounds<M::Point> {
        let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
        for (axis, both) in M::Point::AXES.chunks_exact(2).enumerate() {
            high[axis] = reach(objects, copies, both[0], tolerance, most_work);
            low[axis] = -reach(objects, copies, both[1], tolerance, most_work);
        }
        Bounds::new(
            M::Point::of_coordinates(low),
            M::Point::of_coordinates(high),
        )
    }
}

/// Returns the projection of a point to the plane z = 0.
fn flattened<P: Point>(point: P) -> P {
    let [x, y, _] = point.coordinates();
    P::of_coordinates([x, y, 0.0])
}

/// Merges items whose copies are of one object and have nearly equal maps: `join` adds the later item to the
/// earlier one.
fn merge<M: Affine, T>(
    items: &mut Vec<T>,
    copy: impl Fn(&T) -> &LimitCopy<M>,
    join: impl Fn(&mut T, &T),
) {
    const SAME: f64 = 1e-5;
    // Equal maps take a point to equal places along a line. Point and line are in general position: maps that differ rarely
    // do, even where they flatten the set or leave a point in place.
    const POINT: [f64; 3] = [
        0.618_033_988_749_894_9,
        0.754_877_666_246_692_7,
        0.819_172_513_396_164_4,
    ];
    const LINE: [f64; 3] = [
        0.569_840_290_998_053_2,
        0.671_043_606_703_789_2,
        0.430_159_709_001_946_7,
    ];
    const WIDTH: f64 = 6.0 * SAME;
    let place = |item: &T| {
        let image = copy(item).map.apply(M::Point::of_coordinates(POINT));
        image.dot(M::Point::of_coordinates(LINE))
    };
    let mut places: Vec<(f64, usize)> = items.iter().map(place).zip(0..).collect();
    places.sort_unstable_by(|(a, first), (b, second)| a.total_cmp(b).then(first.cmp(second)));
    let mut kept: Vec<(f64, usize)> = Vec::with_capacity(places.len());
    let mut is_joined = vec![false; items.len()];
    for (place, number) in places {
        let own = copy(&items[number]);
        let near = kept.iter().rev();
        let mut near = near.take_while(|(other, _)| place - other <= WIDTH);
        let is_same = |(_, other): &&(f64, usize)| {
            let it = copy(&items[*other]);
            it.object == own.object && it.map.is_near(&own.map, SAME)
        };
        let Some(&(_, same)) = near.find(is_same) else {
            kept.push((place, number));
            continue;
        };
        is_joined[number] = true;
        if let Ok([same, own]) = items.get_disjoint_mut([same, number]) {
            join(same, own);
        }
    }
    let mut is_joined = is_joined.into_iter();
    items.retain(|_| !is_joined.next().unwrap_or_default());
}
