//! Covers of a set by points: every point of the set is within a radius of one of them, and each of them is
//! within the radius of the set.

use crate::extent::{NoLimit, bounding_box};
use crate::geometry::{Affine, Bounds, Frame, Frame2, Linear, Point};
use crate::graph::{Graph, Replacement};
use crate::grow::{Element, Growth, Visitor, WalkError, walk};

use super::cells::Cells;
use super::covering::Covering;
use super::region::{Region, TooMany};

/// Reason why a set is not covered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoCover {
    /// The limit set does not exist, or is not known.
    #[error(transparent)]
    NoLimit(#[from] NoLimit),
    /// The cover takes more points than are allowed.
    #[error(transparent)]
    TooMany(#[from] TooMany),
    /// Too many parts of the set, which hardly shrink, are to be examined at once.
    #[error("its parts hardly shrink: more than 8 million are examined at once")]
    TooManyOpen,
    /// Growing the approximant failed.
    #[error(transparent)]
    Walk(WalkError<TooMany>),
    /// Nothing is visible in the approximant.
    #[error("nothing is drawn at this step")]
    Nothing,
}

/// The set of a graph that is compared.
#[derive(Clone, Copy, Debug)]
pub enum Subset<'a> {
    /// The limit set.
    Limit,
    /// The visible elements of an approximant.
    Approximant(Growth<'a>),
}

/// A set of points of the plane or of space that a graph defines.
///
/// Closed outlines include the region that they enclose.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a, F: Frame = Frame2> {
    graph: &'a Graph<F>,
    set: Subset<'a>,
    bounds: Bounds<F::Point>,
}

impl<'a, F: Covering> Subject<'a, F> {
    /// Creates the set of a graph.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such set.
    pub fn new(graph: &'a Graph<F>, set: Subset<'a>) -> Result<Self, NoCover> {
        let bounds = match &set {
            Subset::Limit => {
                let limit = graph.limit()?;
                limit.bounds().unwrap_or_else(|| discs(graph))
            }
            Subset::Approximant(growth) => {
                let bounds = bounding_box(graph, growth);
                bounds.map_err(|error| NoCover::Walk(error.map_visitor(|never| match never {})))?
            }
        };
        if bounds.is_empty() {
            return Err(NoCover::Nothing);
        }
        Ok(Self { graph, set, bounds })
    }

    /// Returns a box that holds the set: the smallest one, wherever the graph determines it.
    #[must_use]
    pub fn bounds(&self) -> &Bounds<F::Point> {
        &self.bounds
    }

    /// Returns points no farther than `radius` from the set, such that every point of the set is within
    /// `radius` of one of them.
    ///
    /// Copies that are small enough become one point each, in the centre of a disc that holds the copy, and
    /// of points that are near each other one is kept. Limit sets whose copies overlap heavily are covered by
    /// cells of grids instead.
    ///
    /// # Errors
    ///
    /// Returns an error if the cover takes more than `most` points.
    pub fn cover(&self, radius: f64, most: usize) -> Result<Vec<F::Point>, NoCover> {
        let mut points = Vec::new();
        self.visit(radius, most, &mut |point| points.push(point))?;
        Ok(points)
    }

    /// Visits the points of [`cover`](Self::cover) one by one, which takes little memory.
    ///
    /// # Errors
    ///
    /// Returns an error if the cover takes more than `most` points.
    pub fn visit(
        &self,
        radius: f64,
        most: usize,
        visit: &mut dyn FnMut(F::Point),
    ) -> Result<(), NoCover> {
        let covered = F::covered(&self.bounds, radius);
        let mut region = Region::new(covered, radius, most, visit);
        match &self.set {
            Subset::Limit => cover_limit(self.graph, most, &mut region)?,
            Subset::Approximant(growth) => {
                let mut visitor = Approximant {
                    graph: self.graph,
                    region: &mut region,
                };
                walk(self.graph, growth, &mut visitor).map_err(|error| match error {
                    WalkError::Visitor(error) => NoCover::TooMany(error),
                    other => NoCover::Walk(other),
                })?;
            }
        }
        Ok(())
    }
}

/// Returns a box around discs that hold the limit set of every instance of the initiator.
fn discs<F: Covering>(graph: &Graph<F>) -> Bounds<F::Point> {
    let reaches = reaches(graph);
    let mut bounds = Bounds::EMPTY;
    for instance in &graph.initiator(0).instances {
        let middle = instance.frame.apply(graph.middle());
        let reach = instance.frame.stretch() * reaches[instance.object];
        bounds.add(middle - F::Point::splat(reach));
        bounds.add(middle + F::Point::splat(reach));
    }
    bounds
}

/// Returns, for each object, the radius of a disc about the graph's centre that holds the object's limit set.
pub(super) fn reaches<F: Covering>(graph: &Graph<F>) -> Vec<f64> {
    let middle = graph.middle();
    graph.reaches(|object| match object.replacement {
        Replacement::Kept => F::radius_of(&graph.base_elements()[object.base_element], middle),
        _ => 0.0,
    })
}

/// Number of copies examined per point of the cover beyond which copies overlap too much. Ferns, with about
/// ten, take less time and a fifth of the points by copies.
const OVERLAPPING: usize = 12;

/// Number of copies that are examined before overlaps are judged.
const FEW: usize = 4096;

/// Maximum number of copies that are kept to be examined: half a gigabyte in the plane.
const MAX_OPEN: usize = 1 << 23;

/// Covers a limit set by its copies that are as small as the radius, or by cells of grids where copies overlap
/// heavily.
fn cover_limit<F: Covering>(
    graph: &Graph<F>,
    most: usize,
    region: &mut Region<'_, F::Point>,
) -> Result<(), NoCover> {
    let alive = graph.alive(true);
    let middle = graph.middle();
    let reaches = reaches(graph);
    let mut open: Vec<(usize, F::Map)> = Vec::new();
    let initiator = graph.initiator(0).instances.iter().rev();
    open.extend(initiator.map(|instance| (instance.object, *instance.frame.map())));
    let (mut looked_at, mut may_be_cells) = (0, true);
    while let Some((number, map)) = open.pop() {
        looked_at += 1;
        if may_be_cells && looked_at > FEW + OVERLAPPING * region.visited() {
            may_be_cells = false;
            // Where cells fail because there are too many of them, copies may suffice.
            if let Ok(Some(cells)) = Cells::found(graph, region.radius, most) {
                return cells.visit(region).map_err(NoCover::TooMany);
            }
        }
        if !alive[number] {
            continue;
        }
        let object = &graph.objects()[number];
        let (middle, reach) = (map.apply(middle), map.linear().stretch() * reaches[number]);
        if region.covers(middle, reach) {
            region.work(1)?;
            continue;
        }
        if reach <= region.near {
            region.add(middle)?;
            continue;
        }
        match &object.replacement {
            Replacement::Fixed(production) => {
                let children = production.placed_instances();
                open.extend(
                    children.map(|(_, instance)| (instance.object, map * *instance.frame.map())),
                );
                region.work(1)?;
                if open.len() > MAX_OPEN {
                    return Err(NoCover::TooManyOpen);
                }
            }
            _ => F::add_outline(region, &graph.base_elements()[object.base_element], &map)?,
        }
    }
    Ok(())
}

struct Approximant<'a, 'v, F: Frame> {
    graph: &'a Graph<F>,
    region: &'a mut Region<'v, F::Point>,
}

impl<F: Covering> Visitor<F> for Approximant<'_, '_, F> {
    type Error = TooMany;

    fn element(&mut self, element: &Element<F>) -> Result<(), TooMany> {
        let object = &self.graph.objects()[element.object];
        if !object.visible {
            return Ok(());
        }
        let outline = &self.graph.base_elements()[object.base_element];
        F::add_outline(self.region, outline, element.frame.map())
    }
}
