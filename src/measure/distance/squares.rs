//! Covers of limit sets by squares of grids: where copies overlap, each place is examined once.

use crate::geometry::{Bounds, DAffine2, DMat2, DVec2, stretch};
use crate::graph::{Graph, Instance, Replacement};
use crate::rule::BaseElement;
use crate::saturating::{ones, real, whole};

use super::cover::reaches;
use super::region::{Region, TooMany};

/// The limit sets of all objects that the initiator reaches, each covered by squares of a grid in the
/// object's own unit frame.
///
/// Where the map of an instance takes the centre of an occupied square, the square of the instancing object
/// is occupied as well; images are marked until there are no new ones. Let every point that an occupied
/// square of an object o represents lie within δ u(o) of the square's centre, let products of n maps from an
/// object c to o stretch by at most N(n) u(o) / u(c), and let S be the sum of all N(n). The centres and the
/// limit set are then within S δ u(o) of each other (Hutchinson 1981; Barnsley's collage theorem).
pub(super) struct Squares<'g> {
    graph: &'g Graph,
    /// Whether each object is drawn in the limit.
    alive: Vec<bool>,
    grids: Vec<Grid>,
    /// Index of the grid of each behaviour.
    of: Vec<Option<usize>>,
}

/// A grid of squares in tiles of 8 × 8, a word each, row by row from the lower left.
struct Grid {
    /// An object whose limit set the grid covers.
    object: usize,
    corner: DVec2,
    /// Side of a square, in the unit frame.
    side: f64,
    /// Number of tiles in a row, and number of rows of tiles.
    tiles: [usize; 2],
    /// Occupied squares.
    marked: Vec<u64>,
    /// Occupied squares whose images are not marked yet.
    fresh: Vec<u64>,
}

/// An instance that maps the squares of one grid into another grid.
struct Image {
    /// The map, in units of the squares of both grids.
    map: DAffine2,
    grid: usize,
}

/// Side of a tile, in squares.
const TILE: usize = 8;

/// Vector from the corner of a tile to its centre, in squares.
const HALF_TILE: DVec2 = DVec2::splat(4.0);

/// Maximum number of squares of all grids: 128 mebibytes for both words of each tile.
const MAX_SQUARES: f64 = (1u64 << 29) as f64;

/// Maximum number of images that are marked, as a multiple of the maximum number of points.
const MARKED_A_POINT: usize = 96;

/// Maximum distance of the centre of a square from the part of the set that it represents, as a multiple of
/// the radius of the cover. The rest of the radius remains for parts that are covered by points nearby.
const NEAR: f64 = 0.75;

impl<'g> Squares<'g> {
    /// Finds squares that cover the limit set, for points that are within a radius of it.
    ///
    /// Returns `None` where the stretch of products of maps has no known bound, or where nothing is replaced.
    ///
    /// # Errors
    ///
    /// Returns an error if it takes too many squares or images, for `most` points.
    pub(super) fn found(
        graph: &'g Graph,
        radius: f64,
        most: usize,
    ) -> Result<Option<Self>, TooMany> {
        if !graph.is_plain() || graph.depth().is_some() || graph.resets().contains(&true) {
            return Ok(None);
        }
        let Some(products) = graph.products() else {
            return Ok(None);
        };
        let mut squares = Self {
            graph,
            alive: graph.alive(true),
            grids: Vec::new(),
            of: vec![None; graph.behaviours().count()],
        };
        squares.find_objects();
        let weights = squares.grids.iter();
        let weights: Vec<f64> = weights.map(|it| products.weights[it.object]).collect();
        let stretched = squares
            .initiator()
            .map(|(grid, map)| stretch(&map.matrix2) * weights[grid]);
        let stretched = products.sum * stretched.fold(0.0, f64::max);
        if stretched <= 0.0 {
            return Ok(None);
        }
        let errors = weights.iter().map(|it| it * NEAR * radius / stretched);
        let errors: Vec<f64> = errors.collect();
        // A coarse pass finds the extents of the sets, for the grids of fine squares.
        const ROUGHER: f64 = 16.0;
        let (reaches, centre) = (reaches(graph), graph.middle());
        let disc = |grid: &Grid| {
            let reach = reaches[grid.object];
            Bounds::new(centre - reach, centre + reach)
        };
        let discs: Vec<Bounds> = squares.grids.iter().map(disc).collect();
        let rough: Vec<f64> = errors.iter().map(|error| ROUGHER * error).collect();
        squares.mark(&discs, &rough, most)?;
        let narrow = squares.grids.iter().zip(&rough);
        let narrow = narrow.map(|(grid, error)| grid.bounds(products.sum * error));
        let narrow: Vec<Bounds> = narrow.collect();
        squares.mark(&narrow, &errors, most)?;
        Ok(Some(squares))
    }

    /// Adds points of the set to a region.
    pub(super) fn visit(&self, region: &mut Region<'_>) -> Result<(), TooMany> {
        // Points of a wide grid come first: few of them cover filled regions.
        const WIDE: f64 = 1.0;
        let near = NEAR * region.radius;
        let kept = self.graph.initiator(0).instances.iter();
        for instance in kept.filter(|it| self.is_kept(it.object)) {
            region.add_outline(self.outline_of(instance.object), instance.frame.map())?;
        }
        for (number, map) in self.initiator() {
            let grid = &self.grids[number];
            let map = *map * grid.places();
            let side = stretch(&map.matrix2);
            let step = whole(WIDE * region.radius / side).max(1);
            for y in (0..TILE * grid.tiles[1]).step_by(step) {
                for x in (0..TILE * grid.tiles[0]).step_by(step) {
                    if grid.has(x, y) {
                        region.add_within(map.transform_point2(middle(x, y)), near)?;
                    }
                }
            }
            for (tile, squares) in grid.marked.iter().enumerate() {
                let [x, y] = grid.corner_of(tile);
                let centre = map.transform_point2(place(x, y) + HALF_TILE);
                if *squares == 0 || region.covers(centre, near + HALF_TILE.length() * side) {
                    continue;
                }
                for bit in bits(*squares) {
                    let middle = middle(x + bit % TILE, y + bit / TILE);
                    region.add_within(map.transform_point2(middle), near)?;
                }
            }
        }
        Ok(())
    }

    /// Returns the grids of the replaced instances of the initiator, and the maps of these instances.
    fn initiator(&self) -> impl Iterator<Item = (usize, &DAffine2)> {
        let instances = self.graph.initiator(0).instances.iter();
        instances.filter_map(|it| Some((self.grid_of(it.object)?, it.frame.map())))
    }

    fn grid_of(&self, object: usize) -> Option<usize> {
        let object = &self.graph.objects()[object];
        let is_replaced = object.successor().is_some();
        self.of[object.behaviour].filter(|_| is_replaced)
    }

    /// Creates a grid for each behaviour that the initiator reaches and that is replaced and drawn in the
    /// limit.
    fn find_objects(&mut self) {
        let graph = self.graph;
        let start = graph.initiator(0).instances.iter();
        let mut open: Vec<usize> = start.map(|instance| instance.object).collect();
        while let Some(object) = open.pop() {
            let found = &graph.objects()[object];
            let is_replaced = found.successor().is_some();
            if !self.alive[object] || !is_replaced || self.of[found.behaviour].is_some() {
                continue;
            }
            self.of[found.behaviour] = Some(self.grids.len());
            self.grids.push(Grid {
                object,
                corner: DVec2::ZERO,
                side: 1.0,
                tiles: [0; 2],
                marked: Vec::new(),
                fresh: Vec::new(),
            });
            open.extend(graph.children(object).map(|(_, it)| it.object));
        }
    }

    /// Returns the instances in an object's production that are kept and drawn in the limit.
    fn kept(&self, object: usize) -> impl Iterator<Item = &'g Instance> {
        let children = self.graph.children(object).map(|(_, instance)| instance);
        children.filter(|it| self.is_kept(it.object))
    }

    /// Returns the instances in an object's production that have a grid: those that are replaced and lead to
    /// visible elements.
    fn replaced(&self, object: usize) -> impl Iterator<Item = &'g Instance> {
        let children = self.graph.children(object).map(|(_, instance)| instance);
        children.filter(|it| self.grid_of(it.object).is_some())
    }

    fn is_kept(&self, object: usize) -> bool {
        let replacement = &self.graph.objects()[object].replacement;
        self.alive[object] && matches!(replacement, Replacement::Kept)
    }

    fn outline_of(&self, object: usize) -> &'g BaseElement {
        &self.graph.base_elements()[self.graph.objects()[object].base_element]
    }

    /// Marks all occupied squares of the grids, which cover the boxes `bounds`. `errors` are the maximum
    /// distances of centres from the points that their squares represent.
    fn mark(&mut self, bounds: &[Bounds], errors: &[f64], most: usize) -> Result<(), TooMany> {
        let too_many = TooMany { most };
        self.lay_out(bounds, errors).ok_or(too_many)?;
        self.mark_own(errors, most)?;
        let images = most.saturating_mul(MARKED_A_POINT);
        self.mark_images(images).ok_or(too_many)
    }

    /// Sizes the squares of every grid: as large as the errors permit, and half as large for an object that
    /// keeps outlines, which take the other half of the error. Images that lie outside, within the error, are
    /// marked in the squares at the border, which are nearer to all of the set. Returns `None` if there are
    /// more than [`MAX_SQUARES`].
    fn lay_out(&mut self, bounds: &[Bounds], errors: &[f64]) -> Option<()> {
        let mut squares = 0.0;
        for (number, (bounds, error)) in bounds.iter().zip(errors).enumerate() {
            let has_own = self.kept(self.grids[number].object).next().is_some();
            let half = if has_own { error / 2.0 } else { *error };
            let side = half * std::f64::consts::SQRT_2;
            let tile = side * place(TILE, TILE);
            let tiles = (bounds.size() / tile).ceil().max(DVec2::ONE);
            squares += 64.0 * tiles.x * tiles.y;
            if squares.is_nan() || squares > MAX_SQUARES {
                return None;
            }
            let grid = &mut self.grids[number];
            grid.corner = bounds.min();
            grid.side = side;
            grid.tiles = [whole(tiles.x), whole(tiles.y)];
            grid.marked = vec![0; grid.tiles[0] * grid.tiles[1]];
            grid.fresh = grid.marked.clone();
        }
        Some(())
    }

    /// Marks the outlines that objects keep, and one point of the limit set of each object.
    fn mark_own(&mut self, errors: &[f64], most: usize) -> Result<(), TooMany> {
        for (number, error) in errors.iter().enumerate() {
            let object = self.grids[number].object;
            let kept: Vec<&Instance> = self.kept(object).collect();
            for instance in kept {
                let outline = self.outline_of(instance.object);
                let grid = &mut self.grids[number];
                let places = grid.places().inverse();
                let mut mark = |point| grid.mark(places.transform_point2(point));
                let mut region = Region::of_all(error / 2.0, most, &mut mark);
                region.add_outline(outline, instance.frame.map())?;
            }
            let point = self.point(object);
            let grid = &mut self.grids[number];
            if let Some(point) = point {
                grid.mark(grid.places().inverse().transform_point2(point));
            }
        }
        Ok(())
    }

    /// Returns a point of an object's limit set: the limit of the path of first replaced instances. Returns
    /// `None` if the path ends.
    fn point(&self, mut object: usize) -> Option<DVec2> {
        const MAX_LEVELS: usize = 100_000;
        const NEGLIGIBLE: f64 = 1e-17;
        let mut map = DAffine2::IDENTITY;
        for _ in 0..MAX_LEVELS {
            let instance = self.replaced(object).next()?;
            map *= instance.frame.map();
            object = instance.object;
            if stretch(&map.matrix2) <= NEGLIGIBLE {
                break;
            }
        }
        Some(map.translation)
    }

    /// Marks the images of all marked squares, and the images of these, until there are no new ones. Returns
    /// `None` if that takes more than `most` images.
    fn mark_images(&mut self, most: usize) -> Option<()> {
        let images = self.images();
        let mut left = most;
        let mut is_fresh = true;
        while is_fresh {
            is_fresh = false;
            for (number, images) in images.iter().enumerate() {
                for tile in 0..self.grids[number].fresh.len() {
                    let squares = std::mem::take(&mut self.grids[number].fresh[tile]);
                    if squares == 0 {
                        continue;
                    }
                    is_fresh = true;
                    let [x, y] = self.grids[number].corner_of(tile);
                    for Image { map, grid } in images {
                        let grid = &mut self.grids[*grid];
                        if grid.holds(map, place(x, y) + HALF_TILE) {
                            continue;
                        }
                        left = left.checked_sub(squares.count_ones() as usize)?;
                        let corner = map.transform_point2(middle(x, y));
                        let DMat2 { x_axis, y_axis } = map.matrix2;
                        for bit in bits(squares) {
                            let along = place(bit % TILE, bit / TILE);
                            grid.mark(corner + along.x * x_axis + along.y * y_axis);
                        }
                    }
                }
            }
        }
        Some(())
    }

    /// Returns the maps that take the squares of each grid into other grids.
    fn images(&self) -> Vec<Vec<Image>> {
        let mut images: Vec<Vec<Image>> = self.grids.iter().map(|_| Vec::new()).collect();
        for (number, grid) in self.grids.iter().enumerate() {
            let places = grid.places().inverse();
            for instance in self.replaced(grid.object) {
                let Some(inner) = self.grid_of(instance.object) else {
                    continue;
                };
                let map = places * instance.frame.map() * self.grids[inner].places();
                images[inner].push(Image { map, grid: number });
            }
        }
        images
    }
}

impl Grid {
    /// Returns the map from coordinates in units of squares to the unit frame.
    fn places(&self) -> DAffine2 {
        DAffine2::from_scale_angle_translation(DVec2::splat(self.side), 0.0, self.corner)
    }

    /// Returns a box that holds the tiles with occupied squares and a margin `around` them.
    fn bounds(&self, around: f64) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for (tile, squares) in self.marked.iter().enumerate() {
            if *squares != 0 {
                let [x, y] = self.corner_of(tile);
                for corner in [place(x, y), place(x + TILE, y + TILE)] {
                    bounds.add(self.places().transform_point2(corner));
                }
            }
        }
        Bounds::new(bounds.min() - around, bounds.max() + around)
    }

    /// Returns the column and row of a tile's first square.
    fn corner_of(&self, tile: usize) -> [usize; 2] {
        [TILE * (tile % self.tiles[0]), TILE * (tile / self.tiles[0])]
    }

    /// Returns the index of a square's tile, and the mask of its bit.
    #[inline]
    fn find(&self, x: usize, y: usize) -> (usize, u64) {
        let tile = y / TILE * self.tiles[0] + x / TILE;
        (tile, 1 << (y % TILE * TILE + x % TILE))
    }

    /// Returns the square that a point lies in, or the nearest one.
    #[inline]
    fn nearest(&self, place: DVec2) -> [usize; 2] {
        let [columns, rows] = self.tiles;
        [within(place.x, columns), within(place.y, rows)]
    }

    /// Returns `true` if all tiles that the image of a tile meets are filled, which is frequent inside filled
    /// regions. `tile` is the centre of the tile; images that are too large return `false`.
    fn holds(&self, map: &DAffine2, tile: DVec2) -> bool {
        const MOST: usize = 4;
        let middle = map.transform_point2(tile);
        let half = map.matrix2.abs() * HALF_TILE;
        let [left, bottom] = self.nearest(middle - half);
        let [right, top] = self.nearest(middle + half);
        let (columns, rows) = (left / TILE..=right / TILE, bottom / TILE..=top / TILE);
        let is_full = |row: usize| {
            let row = &self.marked[row * self.tiles[0]..];
            row[columns.clone()]
                .iter()
                .all(|squares| *squares == u64::MAX)
        };
        columns.end() - columns.start() < MOST
            && rows.end() - rows.start() < MOST
            && rows.clone().all(is_full)
    }

    fn has(&self, x: usize, y: usize) -> bool {
        let (tile, bit) = self.find(x, y);
        self.marked[tile] & bit != 0
    }

    /// Marks the square of a point, which is fresh if it was not marked before.
    #[inline]
    fn mark(&mut self, place: DVec2) {
        let [x, y] = self.nearest(place);
        let (tile, bit) = self.find(x, y);
        let is_new = bit & !self.marked[tile];
        self.marked[tile] |= is_new;
        self.fresh[tile] |= is_new;
    }
}

/// Returns the lower left corner of a square.
#[inline]
fn place(x: usize, y: usize) -> DVec2 {
    DVec2::new(real(x), real(y))
}

fn middle(x: usize, y: usize) -> DVec2 {
    place(x, y) + 0.5
}

/// Iterates over the indices of the bits that are set.
fn bits(word: u64) -> impl Iterator<Item = usize> {
    ones(word).map(|bit| bit as usize)
}

/// Returns the square along a row of tiles that a coordinate lies in, or the nearest one.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "rows of squares are short, and casts from floats saturate"
)]
fn within(coordinate: f64, tiles: usize) -> usize {
    (coordinate as i32).clamp(0, (TILE * tiles) as i32 - 1) as usize
}
