//! Scene of a picture in space: the graph, prepared for descents.

use crate::extent::{Bounded, bounding_box};
use crate::geometry::{Bounds, DAffine3, DMat3, DVec3, Frame, Frame3, Solid};
use crate::graph::{Graph, Instance, Object, Replacement};
use crate::grow::Growth;
use crate::instancing::Appearance;
use crate::style::ColorBy;

use super::SpaceError;
use super::forms::Form;

/// Tolerance of boxes that contain images of boxes.
const SLACK: f64 = 1e-9;

/// Shares of the extent of an approximant by which its box may be too large where no other is known: the first that takes
/// little work.
const LOOSE: [f64; 3] = [1.0 / 512.0, 1.0 / 128.0, 1.0 / 32.0];

/// Limit of the number of elements that are visited for the box of an approximant.
const MAX_WALKED: u64 = 1_000_000;

/// A convex set that contains the subtree of an object.
#[derive(Clone, Copy, Debug)]
pub(super) enum Hull {
    /// A box: its middle and its half sides.
    Cuboid(DVec3, DVec3),
    /// A ball: its centre and its radius.
    Ball(DVec3, f64),
}

impl Hull {
    fn of(bounds: &Bounds<DVec3>) -> Self {
        let half = bounds.size() / 2.0;
        Self::Cuboid(bounds.min() + half, half)
    }

    /// Returns the middle and the half sides of the box of the image under a linear map.
    #[inline]
    pub(super) fn image(&self, linear: &DMat3) -> (DVec3, DVec3) {
        match self {
            Self::Cuboid(middle, half) => {
                let half = linear.x_axis.abs() * half.x
                    + linear.y_axis.abs() * half.y
                    + linear.z_axis.abs() * half.z;
                (*linear * *middle, half)
            }
            Self::Ball(middle, radius) => {
                let rows = linear.transpose();
                let along = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.length());
                (*linear * *middle, DVec3::from_array(along) * *radius)
            }
        }
    }

    /// Returns the distance from the origin within which the set lies.
    pub(super) fn reach(&self) -> f64 {
        match self {
            Self::Cuboid(middle, half) => (middle.abs() + *half).length(),
            Self::Ball(middle, radius) => middle.length() + radius,
        }
    }
}

/// An instance in the place of an object.
pub(super) struct Child {
    pub(super) map: DAffine3,
    /// Upper bound of the stretch.
    pub(super) length: f64,
    pub(super) object: usize,
}

/// An object of the graph.
pub(super) struct Part {
    pub(super) children: Vec<Child>,
    /// Whether the object is replaced.
    pub(super) is_replaced: bool,
    /// Solid that is drawn for it, if it is visible.
    pub(super) solid: Option<Solid>,
    /// Box of its subtree, which stands for it where it is too small to be replaced, if it is not visible itself.
    pub(super) stand_in: Option<Solid>,
    pub(super) hull: Hull,
    /// Tint of its subtree.
    pub(super) appearance: Appearance,
    /// Number of the map that is applied first, from 1 if [`draws_unmade`].
    pub(super) origin: Option<usize>,
    /// Number that objects share which draw the same, but for classes.
    pub(super) kind: usize,
}

impl Part {
    /// Returns the solid that is drawn for an object that is not replaced.
    pub(super) fn drawn(&self, level: u32, end: &End) -> Option<&Solid> {
        let stand_in = self.stand_in.as_ref().filter(|_| level < end.steps);
        self.solid.as_ref().or(stand_in)
    }
}

/// End of a descent.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// Number of steps.
    pub(super) steps: u32,
    /// Length in samples below which nothing is replaced; 0 if there is none.
    pub(super) detail: f64,
    /// Length of an element whose frame is the unit frame.
    pub(super) unit: f64,
}

/// Returns whether a form is not replaced, whatever its size.
pub(super) fn ends(parts: &[Part], form: &Form, end: &End) -> bool {
    !parts[form.object].is_replaced || form.level == end.steps
}

/// Property that the class of a solid depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClassBy {
    Nothing,
    FirstMap,
    LastMap,
    Step,
    Tint,
    /// The normal of a face.
    Normal,
}

impl ClassBy {
    pub(super) fn of(by: ColorBy) -> Result<Self, SpaceError> {
        match by {
            ColorBy::None => Ok(Self::Nothing),
            ColorBy::FirstMap | ColorBy::Generator => Ok(Self::FirstMap),
            ColorBy::LastMap => Ok(Self::LastMap),
            ColorBy::Step => Ok(Self::Step),
            ColorBy::Tint => Ok(Self::Tint),
            ColorBy::Normal => Ok(Self::Normal),
            other => Err(SpaceError::ColorBy(other)),
        }
    }
}

/// Prepares the objects of a graph for descents to the limit or to a number of steps.
pub(super) fn parts(graph: &Graph<Frame3>, steps: Option<u32>) -> Vec<Part> {
    let extents = extents(graph, steps);
    let before = usize::from(draws_unmade(graph));
    let objects = graph.objects().iter().zip(extents).enumerate();
    let parts = objects.map(|(number, (object, Extent { hull, bounds }))| {
        let children = match &object.replacement {
            Replacement::Fixed(successor) => {
                let instances = successor.placed_instances();
                instances.map(|(_, instance)| child(instance)).collect()
            }
            _ => Vec::new(),
        };
        let has_stand_in = graph.is_fertile(number) && !object.visible;
        let stand_in = { Some(bounds) }
            .filter(|bounds| has_stand_in && bounds.is_finite())
            .map(|bounds| Solid::cuboid(&bounds));
        Part {
            children,
            stand_in,
            is_replaced: graph.is_fertile(number),
            solid: graph.drawn(number).cloned(),
            appearance: graph.appearance(number),
            hull,
            origin: object.origin.map(|map| map + before),
            kind: match graph.is_fertile(number) {
                true => object.behaviour,
                false => graph.objects().len() + number,
            },
        }
    });
    parts.collect()
}

/// Returns whether a graph draws what no map has moved: a condensation set. Colours by maps begin with it.
pub(super) fn draws_unmade(graph: &Graph<Frame3>) -> bool {
    let is_unmade = |object: &Object<Frame3>| object.visible && object.origin.is_none();
    { graph.objects().iter() }.any(|object| object.is_kept() && is_unmade(object))
}

/// Returns whether a picture shows elements, whose faces have normals, rather than a limit set.
pub(super) fn has_faces(graph: &Graph<Frame3>, steps: Option<u32>) -> bool {
    let mut objects = graph.objects().iter();
    steps.is_some() || objects.any(|object| object.is_kept() && object.visible)
}

/// Returns whether all maps of a graph are similarities, those of the initiator included.
pub(super) fn is_similar(graph: &Graph<Frame3>) -> bool {
    graph.is_similar() && graph.starts_similar()
}

/// Returns the instances of the initiator.
pub(super) fn start(graph: &Graph<Frame3>) -> Vec<Child> {
    let instances = &graph.initiator(0).instances;
    instances.iter().map(child).collect()
}

fn child(instance: &Instance<Frame3>) -> Child {
    Child {
        map: *instance.frame.map(),
        length: instance.length,
        object: instance.object,
    }
}

/// Sets that contain the subtree of an object.
struct Extent {
    hull: Hull,
    /// Not finite if nothing is drawn, or if no box is known.
    bounds: Bounds<DVec3>,
}

impl Extent {
    fn of(graph: &Graph<Frame3>, bounds: Bounds<DVec3>) -> Self {
        let hull = match bounds.is_empty() {
            true => Hull::Ball(graph.middle(), 0.0),
            false => Hull::of(&bounds),
        };
        Self { hull, bounds }
    }
}

/// Returns sets for every object that contain what its subtree draws: within a number of steps, or in the limit.
fn extents(graph: &Graph<Frame3>, steps: Option<u32>) -> Vec<Extent> {
    // Balls take less where there are many.
    let limits = (!graph.has_many_behaviours()).then(|| graph.limit_boxes());
    let limits = limits.flatten();
    let mut known: Vec<Option<Bounds<DVec3>>> = Vec::new();
    for (number, object) in graph.objects().iter().enumerate() {
        // Behaviours are numbered in the order of the objects.
        if object.behaviour == known.len() {
            known.push(match graph.is_fertile(number) {
                true => { limits.as_ref() }.and_then(|limits| limits.at_object(number)),
                false => None,
            });
        }
    }
    let boxes: Vec<Option<Bounds<DVec3>>> = { graph.objects().iter().enumerate() }
        .map(|(number, object)| {
            let mut bounds = match graph.is_fertile(number) {
                true => known[object.behaviour]?,
                false => Bounds::EMPTY,
            };
            if let Some(solid) = graph.drawn(number)
                && (steps.is_some() || !graph.is_fertile(number))
            {
                bounds.add_all(&solid.bounds(&DAffine3::IDENTITY));
            }
            Some(bounds)
        })
        .collect();
    // Objects that are kept stay in the limit.
    let is_kept = |number: usize| !graph.is_fertile(number) || !graph.objects()[number].visible;
    let all_stays = (0..boxes.len()).all(is_kept);
    let hold = steps.is_none() || all_stays || holds(graph, &boxes);
    if hold && boxes.iter().all(Option::is_some) {
        let all = boxes.into_iter().flatten();
        return all.map(|bounds| Extent::of(graph, bounds)).collect();
    }
    let known = { boxes.into_iter().enumerate() }
        .map(|(number, bounds)| bounds.filter(|_| hold || !graph.is_fertile(number)));
    within_balls(graph, &known.collect::<Vec<_>>())
}

/// Returns sets for every object that contain what its subtree draws within any number of steps. A box that is not known is
/// that around the boxes of its instances, as far as they lie in that of a ball.
fn within_balls(graph: &Graph<Frame3>, known: &[Option<Bounds<DVec3>>]) -> Vec<Extent> {
    let middle = graph.middle();
    let radii = graph.reaches(|object| graph.outline_radius(object));
    let ball = |radius: &f64| {
        let radius = radius * (1.0 + SLACK);
        Bounds::new(middle - radius, middle + radius)
    };
    let boxes = known.iter().zip(radii.iter().map(ball));
    let mut boxes: Vec<_> = boxes.map(|(known, ball)| known.unwrap_or(ball)).collect();
    // Instances mostly have larger numbers than the objects that they are in.
    for number in (0..boxes.len()).rev() {
        let object = &graph.objects()[number];
        if let (None, Replacement::Fixed(successor)) = (known[number], &object.replacement) {
            let mut bounds = Bounds::EMPTY;
            if let Some(solid) = graph.drawn(number) {
                bounds.add_all(&solid.bounds(&DAffine3::IDENTITY));
            }
            for (_, instance) in successor.placed_instances() {
                bounds.add_all(&image(&boxes[instance.object], instance.frame.map()));
            }
            boxes[number] = boxes[number].intersection(&bounds);
        }
    }
    let extents = { known.iter().zip(boxes).zip(radii) }.map(|((known, bounds), radius)| {
        let ball = Hull::Ball(middle, radius);
        match known.is_none() && bounds.size().length() > 2.0 * radius {
            true => Extent { hull: ball, bounds },
            false => Extent::of(graph, bounds),
        }
    });
    extents.collect()
}

/// Returns the box of the image of a box, which is infinite if the box is.
fn image(bounds: &Bounds<DVec3>, map: &DAffine3) -> Bounds<DVec3> {
    if bounds.is_empty() {
        return Bounds::EMPTY;
    }
    if !bounds.is_finite() {
        return Bounds::new(DVec3::NEG_INFINITY, DVec3::INFINITY);
    }
    let (middle, half) = Hull::of(bounds).image(&map.matrix3);
    let middle = middle + map.translation;
    Bounds::new(middle - half, middle + half)
}

/// Returns whether the boxes of all objects contain the images of those of their instances, and hence all
/// approximants.
fn holds(graph: &Graph<Frame3>, boxes: &[Option<Bounds<DVec3>>]) -> bool {
    graph.objects().iter().zip(boxes).all(|(object, bounds)| {
        let (Some(bounds), Replacement::Fixed(successor)) = (bounds, &object.replacement) else {
            return bounds.is_some();
        };
        let slack =
            DVec3::splat(SLACK * (bounds.size().max_element() + bounds.max().abs().max_element()));
        successor.placed_instances().all(|(_, instance)| {
            let Some(inner) = &boxes[instance.object] else {
                return false;
            };
            let image = image(inner, instance.frame.map());
            image.is_empty()
                || image.min().cmpge(bounds.min() - slack).all()
                    && image.max().cmple(bounds.max() + slack).all()
        })
    })
}

/// Returns the graph as it is seen under a map.
pub(super) fn seen(graph: &Graph<Frame3>, map: &DAffine3) -> Graph<Frame3> {
    let mut seen = graph.clone();
    for instance in seen
        .initiators_mut()
        .iter_mut()
        .flat_map(|chain| &mut chain.instances)
    {
        instance.frame = Frame3::from(*map).compose(&instance.frame);
        instance.length = instance.frame.stretch();
    }
    seen
}

/// Returns the greatest values of three linear functionals, given as rows, on the limit set, or on an
/// approximant; and their least values.
pub(super) fn extent_along(
    graph: &Graph<Frame3>,
    rows: DMat3,
    steps: Option<u32>,
) -> Option<Bounds<DVec3>>
where
    Frame3: Bounded,
{
    let seen = seen(graph, &DAffine3::from_mat3(rows));
    match steps {
        Some(steps) => seen.bounds(steps).or_else(|| {
            let growth = Growth {
                max_elements: MAX_WALKED,
                ..Growth::steps(steps)
            };
            let loose = || { LOOSE.iter() }.find_map(|share| seen.bounds_within(steps, *share));
            bounding_box(&seen, &growth).ok().or_else(loose)
        }),
        None => match &graph.between {
            Some(between) => extent_along(&between.whole, rows, None),
            None => seen.limit_bounds(),
        },
    }
}
