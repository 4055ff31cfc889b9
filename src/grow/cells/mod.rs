//! Cells of the plane that hold points of a limit set, however much its copies overlap.
//!
//! A limit set consists of images of itself and of other sets of its system, and of outlines. Starting from
//! one point of each set and from points of the outlines, every map is applied to one point of each newly met
//! cell, until no new cell is met: minimal plotting (Monro & Dudbridge, "Rendering algorithms for
//! deterministic fractals", 1995), for all objects of a graph at once. Work and memory depend on the number
//! of cells, not on the number of elements of an approximant.
//!
//! Every cell that is met holds a point of the set, or lies between cells that do. A point of the set is no
//! farther than d / (1 − c) from one that is met, where d is the diagonal of a cell and c the contraction
//! factor of the maps, and rarely farther than d. Squares of maps that hardly contract are maps as well, since
//! the one point of a cell may stay in it.
//!
//! Cells are found in waves, which are divided between threads; the results are merged in the order of one
//! thread.

mod field;
mod net;
mod outline;
mod shown;
mod steps;
#[cfg(test)]
mod tests;
mod waves;

pub(crate) use field::Field;
pub(crate) use net::Layer;

use std::num::NonZero;
use std::sync::atomic::AtomicBool;

use crate::geometry::{Bounds, DVec2};
use crate::graph::Graph;
use crate::parallel::{for_each, is_cancelled};

use self::field::NoRoom;
use self::net::{Edge, LimitNode, Net};
use self::shown::LayerCells;
use self::waves::Waves;

/// Maximum number of points whose images are computed together.
const BLOCK: usize = 1 << 15;

/// Number of images that are worth another thread.
const WORTH_A_THREAD: usize = 1 << 14;

/// Numbers of finer cells along the side of a cell, with which a search is refined.
const FINER: [f64; 2] = [2.0, 4.0];
/// Maximum number of images of points for a refinement.
const FINER_WORTH: f64 = 4e6;

/// Number of rounds in which cells between others are filled.
const ROUNDS: usize = 2;

/// Reason why cells are not found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stopped {
    /// More work than is allowed.
    TooMany,
    /// Cancellation.
    Cancelled,
}

/// Limit set of a contractive graph, by the layers of a picture.
pub(crate) struct LimitCells<'g> {
    graph: &'g Graph,
    net: Net,
    /// Sets with the squares of maps that hardly contract.
    squared: Net,
    layers: usize,
}

/// Parameters of a search for cells.
#[derive(Clone, Copy)]
pub(crate) struct CellSearch<'a> {
    /// Number of cells per unit of length of the plane.
    pub(crate) scale: f64,
    /// Maximum number of images of points that are computed.
    pub(crate) max_images: u64,
    pub(crate) threads: NonZero<usize>,
    pub(crate) cancel: Option<&'a AtomicBool>,
}

impl CellSearch<'_> {
    /// Returns an error if the search was cancelled.
    fn check(&self) -> Result<(), Stopped> {
        match is_cancelled(self.cancel) {
            true => Err(Stopped::Cancelled),
            false => Ok(()),
        }
    }
}

/// Result of a search for cells.
pub(crate) struct FoundCells {
    /// Cells of every layer that hold points of it.
    pub(crate) fields: Vec<Field>,
    /// Number of images of points that were computed.
    pub(crate) images: u64,
    /// Maximum number of maps that were applied to one point, where squares of maps count as one.
    pub(crate) steps: u32,
}

impl<'g> LimitCells<'g> {
    /// Creates the limit set of a plain contractive graph, by the layers of a picture.
    pub(crate) fn new(graph: &'g Graph, layers: &[Layer]) -> Self {
        let net = Net::of(graph, layers);
        Self {
            graph,
            squared: net.clone().with_squares(),
            net,
            layers: layers.len(),
        }
    }

    /// Returns a bounding box of most of the layers, from orbits of pseudo-random maps.
    fn rough_bounds(&self) -> Bounds {
        const POINTS: usize = 1 << 16;
        let nodes = &self.net.nodes;
        let first_layer = nodes.len() - self.layers;
        let mut bounds = Bounds::EMPTY;
        for (number, node) in nodes.iter().enumerate() {
            let Some(point) = node.point.filter(|_| node.stretch > 0.0) else {
                continue;
            };
            let (mut at, mut point, mut turn) = (number, point, 0_u32);
            for _ in 0..POINTS {
                let (shown, inner): (Vec<_>, Vec<_>) = nodes[at]
                    .images
                    .iter()
                    .partition(|image| image.whole >= first_layer);
                for Edge { map, .. } in shown {
                    bounds.add(map.transform_point2(point));
                }
                // Linear congruential generator (Knuth), of which the upper bits are used.
                turn = turn.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let choice = (u64::from(turn) * inner.len() as u64) >> 32;
                let Some(Edge { map, whole, .. }) = inner.get(choice as usize) else {
                    break;
                };
                (at, point) = (*whole, map.transform_point2(point));
            }
        }
        bounds
    }

    /// Returns the bounding box of the layers, to about a pixel of a picture whose longer side has `pixels`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`LimitCells::find`].
    pub(crate) fn bounds(&self, search: &CellSearch<'_>, pixels: f64) -> Result<Bounds, Stopped> {
        let mut bounds = self.rough_bounds();
        for pixels in [pixels / 4.0, pixels] {
            let scale = pixels / bounds.size().max_element();
            if !scale.is_finite() {
                break;
            }
            let found = self.find(&CellSearch { scale, ..*search })?;
            for field in &found.fields {
                bounds.add_all(&field.bounds());
            }
        }
        Ok(bounds)
    }

    /// Finds the cells of every layer that hold points of it.
    ///
    /// # Errors
    ///
    /// Returns an error if the search takes more work than is allowed, or if it is cancelled.
    pub(crate) fn find(&self, search: &CellSearch<'_>) -> Result<FoundCells, Stopped> {
        let mut found = self.find_all(search, true)?;
        let layers = found.fields.len() - self.layers;
        found.fields = finished(found.fields.split_off(layers));
        Ok(found)
    }

    /// Finds the cells of all sets, followed by those of every layer. Without outlines, only elements that
    /// are replaced without end are considered.
    fn find_all(
        &self,
        search: &CellSearch<'_>,
        with_outlines: bool,
    ) -> Result<FoundCells, Stopped> {
        let scales = { self.net.nodes.iter() }.map(|node| search.scale * node.stretch);
        let mut orbit = Orbit::new(self, search, scales, search.max_images, &[]);
        orbit.begin(with_outlines.then_some(self.graph))?;
        let mut steps = 0;
        while !orbit.waves.are_over() {
            orbit.go_on()?;
            steps += 1;
        }
        Ok(FoundCells {
            images: search.max_images - orbit.left,
            steps,
            fields: orbit.into_fields()?,
        })
    }

    /// Adds cells of all sets that one point per cell has not reached: finer cells are searched around all
    /// cells but inner ones, if that takes no more work than it is worth.
    fn refine(&self, search: &CellSearch<'_>, known: &mut FoundCells) -> Result<(), Stopped> {
        let nodes = &self.net.nodes;
        for fineness in FINER {
            let inner: Vec<Field> = known.fields.iter().map(Field::inner).collect();
            let fields = known.fields.iter();
            let counts = fields.clone().zip(&inner).zip(nodes);
            let images: usize = counts
                .map(|((field, inner), it)| field.count_without(inner) * it.images.len())
                .sum();
            if images as f64 * fineness * fineness > FINER_WORTH {
                break;
            }
            let scales = fields.clone().map(|it| it.scale() * fineness);
            let left = search.max_images.saturating_sub(known.images);
            let mut orbit = Orbit::new(self, search, scales, left, &inner);
            for (number, (field, inner)) in fields.zip(&inner).enumerate() {
                for point in field.points_without(inner) {
                    orbit.add(number, point, 0)?;
                }
            }
            while !orbit.waves.are_over() {
                orbit.go_on()?;
            }
            known.images = search.max_images - orbit.left;
            for (field, finer) in known.fields.iter_mut().zip(&orbit.into_fields()?) {
                for point in finer.points_without(&Field::new(finer.scale())) {
                    field.add(point)?;
                }
            }
        }
        Ok(())
    }
}

/// Fills the cells of layers that lie between others.
fn finished(mut layers: Vec<Field>) -> Vec<Field> {
    for _ in 0..ROUNDS {
        layers.iter_mut().for_each(Field::fill_pits);
    }
    layers
}

/// Points of all sets, one per cell.
struct Orbit<'a> {
    net: &'a Net,
    search: &'a CellSearch<'a>,
    /// Cells of sets.
    fields: Vec<Field>,
    /// Cells of layers.
    shown: LayerCells<()>,
    /// New points.
    waves: Waves<DVec2>,
    /// Number of images that may still be computed.
    left: u64,
    /// Cells from which points are not followed, by set; may be empty.
    without: &'a [Field],
}

impl<'a> Orbit<'a> {
    /// Creates empty sets and layers; `scales` are their numbers of cells per unit of length.
    fn new(
        set: &'a LimitCells<'_>,
        search: &'a CellSearch<'a>,
        scales: impl Iterator<Item = f64> + Clone,
        left: u64,
        without: &'a [Field],
    ) -> Self {
        let sets = set.net.nodes.len() - set.layers;
        Self {
            net: &set.squared,
            search,
            fields: scales.clone().take(sets).map(Field::new).collect(),
            shown: LayerCells::new(scales.skip(sets), search.threads.get()),
            waves: Waves::of(&set.squared),
            left,
            without,
        }
    }

    /// Returns the cells of all sets, followed by those of every layer.
    fn into_fields(self) -> Result<Vec<Field>, NoRoom> {
        let mut fields = self.fields;
        fields.extend(self.shown.into_fields()?);
        Ok(fields)
    }

    /// Adds a point to which `maps` maps lead from a point of the last wave.
    fn add(&mut self, node: usize, point: DVec2, maps: usize) -> Result<(), NoRoom> {
        if self.leaves_out(node, point) {
            return Ok(());
        }
        let Some(field) = self.fields.get_mut(node) else {
            return self.shown.push(node - self.fields.len(), point, ());
        };
        if field.add(point)? && !self.net.nodes[node].images.is_empty() {
            self.waves.push(maps, node, point);
        }
        Ok(())
    }

    /// Returns the number of cells per unit of length of a set or layer.
    fn scale_of(&self, node: usize) -> f64 {
        let field = self.fields.get(node);
        field.map_or_else(|| self.shown.scale(node - self.fields.len()), Field::scale)
    }

    fn leaves_out(&self, node: usize, point: DVec2) -> bool {
        self.without.get(node).is_some_and(|it| it.holds(point))
    }

    /// Takes images from the remaining ones. Returns an error if there are too few, or if the search was
    /// cancelled.
    fn take(&mut self, images: usize) -> Result<(), Stopped> {
        self.left = { self.left.checked_sub(images as u64) }.ok_or(Stopped::TooMany)?;
        self.search.check()
    }

    /// Adds points of the sets themselves and, if a graph is given, of their outlines.
    fn begin(&mut self, outlines: Option<&Graph>) -> Result<(), Stopped> {
        let net = self.net;
        for (number, node) in net.nodes.iter().enumerate() {
            if node.stretch == 0.0 {
                continue;
            }
            if let Some(graph) = outlines {
                let scale = self.scale_of(number);
                let points = outlined(graph, node, scale, self.left)?;
                self.take(points.len())?;
                for point in points {
                    self.add(number, point, 0)?;
                }
            }
            if let Some(point) = node.point {
                self.add(number, point, 0)?;
            }
        }
        Ok(())
    }

    /// Applies all maps to the points of the next wave.
    fn go_on(&mut self) -> Result<(), Stopped> {
        let net = self.net;
        let wave = self.waves.next();
        for (node, points) in net.nodes.iter().zip(&wave) {
            let edges = &node.images;
            for block in points.chunks(BLOCK) {
                let images = block.len() * edges.len();
                self.take(images)?;
                let threads = self.search.threads.get().min(images / WORTH_A_THREAD);
                if threads < 2 {
                    for point in block {
                        for edge in edges {
                            self.add(edge.whole, edge.map.transform_point2(*point), edge.maps)?;
                        }
                    }
                    continue;
                }
                let this = &*self;
                let is_new = |whole: usize, image: DVec2| {
                    let is_known = this.fields.get(whole).is_some_and(|it| it.holds(image));
                    !is_known && !this.leaves_out(whole, image)
                };
                let found = looked_for(block, threads, |point, found| {
                    let images = edges.iter();
                    let images = images.map(|edge| (edge, edge.map.transform_point2(*point)));
                    found.extend(images.filter(|(edge, image)| is_new(edge.whole, *image)));
                });
                for (edge, image) in found {
                    self.add(edge.whole, image, edge.maps)?;
                }
            }
        }
        Ok(())
    }
}

/// Returns points of the outlines of a set, or an error if there are more than `most`.
fn outlined(graph: &Graph, node: &LimitNode, scale: f64, most: u64) -> Result<Vec<DVec2>, Stopped> {
    let mut points = Vec::new();
    for (map, base_element) in &node.outlines {
        let base_element = &graph.base_elements()[*base_element];
        let are_all = outline::visit(base_element, map, scale, &mut |point| {
            points.push(point);
            points.len() as u64 <= most
        });
        if !are_all {
            return Err(Stopped::TooMany);
        }
    }
    Ok(points)
}

/// Collects the results of `look` for each of some points, in the order of the points, on `threads` threads.
fn looked_for<P: Sync, T: Send>(
    points: &[P],
    threads: usize,
    look: impl Fn(&P, &mut Vec<T>) + Sync,
) -> Vec<T> {
    let parts = points.chunks(points.len().div_ceil(threads.max(1)).max(1));
    let mut parts: Vec<_> = parts.map(|part| (part, Vec::new())).collect();
    for_each(parts.iter_mut(), threads, |(part, found)| {
        part.iter().for_each(|point| look(point, found));
    });
    parts.into_iter().flat_map(|(_, found)| found).collect()
}
