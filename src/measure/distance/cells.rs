//! Covers of limit sets by cells of grids: where copies overlap, each place is examined once.

use crate::extent::LinearOf;
use crate::geometry::{Affine, Bounds, Linear, Point};
use crate::graph::Graph;
use crate::saturating::{ones, real, whole};

use super::cover::reaches;
use super::covering::Covering;
use super::region::{Region, TooMany};
use super::words::{Objects, Words};

/// The limit sets of all objects that the initiator reaches, each covered by cells of a grid in the object's own unit frame:
/// squares in the plane, cubes in space.
///
/// Where a [word](Words) takes the centre of an occupied cell, the cell of the outer object is occupied as well; images are
/// marked until there are no new ones. Let every point that an occupied cell of an object o represents lie within δ u(o) of the
/// cell's centre, let products of n words from an object c to o stretch by at most N(n) u(o) / u(c), and let S be the sum of
/// all N(n). The centres and the limit set are then within S δ u(o) of each other (Hutchinson 1981; Barnsley's collage
/// theorem).
pub(super) struct Cells<'g, F: Covering> {
    graph: &'g Graph<F>,
    objects: Objects<'g, F>,
    words: Words<F::Map>,
    /// The grid of each object.
    grids: Vec<Grid<F>>,
}

/// A grid of cells in tiles of 64 cells, a word of memory each, row by row and layer by layer from the lowest corner.
struct Grid<F: Covering> {
    corner: F::Point,
    /// Side of a cell, in the unit frame.
    side: f64,
    /// Number of tiles along each axis; one along that which the plane lacks.
    tiles: [usize; 3],
    /// Occupied cells.
    marked: Vec<u64>,
    /// Occupied cells whose images are not marked yet.
    fresh: Vec<u64>,
}

/// A word that maps the cells of one grid into another grid.
struct Image<F: Covering> {
    /// The map, in units of the cells of both grids.
    map: F::Map,
    /// The images of the unit vectors.
    axes: [F::Point; 3],
    grid: usize,
}

/// Maximum number of cells of all grids: 128 mebibytes for both words of each tile.
const MAX_CELLS: f64 = (1u64 << 29) as f64;

/// Maximum number of images that are marked, as a multiple of the maximum number of points.
const MARKED_A_POINT: usize = 96;

impl<'g, F: Covering> Cells<'g, F> {
    /// Finds cells that cover the limit set, for points that are within a radius of it.
    ///
    /// Returns `None` where the stretch of products of maps has no known bound, or where nothing is replaced.
    ///
    /// # Errors
    ///
    /// Returns an error if it takes too many cells or images, for `most` points.
    pub(super) fn found(
        graph: &'g Graph<F>,
        radius: f64,
        most: usize,
    ) -> Result<Option<Self>, TooMany> {
        if !graph.is_plain() || graph.depth().is_some() || graph.resets().contains(&true) {
            return Ok(None);
        }
        let Some(products) = graph.products() else {
            return Ok(None);
        };
        let objects = Objects::new(graph);
        let words = Words::new(&objects, &products);
        let numbers = objects.numbers().iter();
        let weights: Vec<f64> = numbers.map(|it| products.weights[*it]).collect();
        let mut cells = Self {
            graph,
            objects,
            words,
            grids: Vec::new(),
        };
        let sum = cells.words.sum;
        let stretched = cells
            .initiator()
            .map(|(index, map)| map.linear().stretch() * weights[index]);
        let stretched = sum * stretched.fold(0.0, f64::max);
        if stretched <= 0.0 {
            return Ok(None);
        }
        let errors = weights.iter().map(|it| it * F::NEAR * radius / stretched);
        let errors: Vec<f64> = errors.collect();
        // A coarse pass finds the extents of the sets, for the grids of fine cells.
        const ROUGHER: f64 = 16.0;
        let (reaches, centre) = (reaches(graph), graph.middle());
        let ball = |number: &usize| {
            let reach = F::Point::splat(reaches[*number]);
            Bounds::new(centre - reach, centre + reach)
        };
        let balls: Vec<_> = cells.objects.numbers().iter().map(ball).collect();
        let rough: Vec<f64> = errors.iter().map(|error| ROUGHER * error).collect();
        cells.mark(&balls, &rough, most)?;
        let narrow = cells.grids.iter().zip(&rough);
        let narrow: Vec<_> = narrow
            .map(|(grid, error)| grid.bounds(sum * error))
            .collect();
        cells.mark(&narrow, &errors, most)?;
        Ok(Some(cells))
    }

    /// Adds points of the set to a region.
    pub(super) fn visit(&self, region: &mut Region<'_, F::Point>) -> Result<(), TooMany> {
        let near = F::NEAR * region.radius;
        let kept = self.graph.initiator(0).instances.iter();
        for instance in kept.filter(|it| self.objects.is_kept(it.object)) {
            let outline = self.outline_of(instance.object);
            F::add_outline(region, outline, instance.frame.map())?;
        }
        for (index, map) in self.initiator() {
            let grid = &self.grids[index];
            let map = *map * grid.places();
            let side = map.linear().stretch();
            // Points of a wide lattice come first: few of them cover filled regions.
            for cell in lattice::<F>(grid.counts(), F::APART * region.radius / side) {
                if grid.has(cell) {
                    region.add_within(map.apply(middle(cell)), near)?;
                }
            }
            for (tile, cells) in grid.marked.iter().enumerate() {
                let corner = grid.corner_of(tile);
                let centre = map.apply(corner + half::<F>());
                let around = near + half::<F>().length() * side;
                if *cells == 0 || region.covers(centre, around) {
                    continue;
                }
                for bit in ones(*cells) {
                    let middle = corner + middle::<F::Point>(place::<F>(bit));
                    region.add_within(map.apply(middle), near)?;
                }
            }
        }
        Ok(())
    }

    /// Returns the indices of the replaced instances of the initiator, and their maps.
    fn initiator(&self) -> impl Iterator<Item = (usize, &F::Map)> {
        let instances = self.graph.initiator(0).instances.iter();
        instances.filter_map(|it| Some((self.objects.index(it.object)?, it.frame.map())))
    }

    fn outline_of(&self, object: usize) -> &'g F::Outline {
        &self.graph.base_elements()[self.graph.objects()[object].base_element]
    }

    /// Marks all occupied cells of the grids, which cover the boxes `bounds`. `errors` are the maximum
    /// distances of centres from the points that their cells represent.
    fn mark(
        &mut self,
        bounds: &[Bounds<F::Point>],
        errors: &[f64],
        most: usize,
    ) -> Result<(), TooMany> {
        let too_many = TooMany { most };
        self.lay_out(bounds, errors).ok_or(too_many)?;
        self.mark_own(errors, most)?;
        let images = most.saturating_mul(MARKED_A_POINT);
        self.mark_images(images).ok_or(too_many)
    }

    /// Sizes the cells of every grid: as large as the errors permit, and half as large for an object that
    /// keeps outlines, which take the other half of the error. Images that lie outside, within the error, are
    /// marked in the cells at the border, which are nearer to all of the set. Returns `None` if there are
    /// more than [`MAX_CELLS`].
    fn lay_out(&mut self, bounds: &[Bounds<F::Point>], errors: &[f64]) -> Option<()> {
        self.grids.clear();
        let mut cells = 0.0;
        for (index, (bounds, error)) in bounds.iter().zip(errors).enumerate() {
            let has_own = self.words.kept.iter().any(|word| word.outer == index);
            let half = if has_own { error / 2.0 } else { *error };
            let side = 2.0 * half / real(F::Point::DIMENSION).sqrt();
            let tile = side * real(F::TILE[0]);
            let tiles = (bounds.size() / tile).map(f64::ceil);
            let tiles = tiles.coordinates().map(|it| it.max(1.0));
            cells += 64.0 * tiles.iter().product::<f64>();
            if cells.is_nan() || cells > MAX_CELLS {
                return None;
            }
            let tiles = tiles.map(whole);
            let marked = vec![0; tiles.iter().product()];
            self.grids.push(Grid {
                corner: bounds.min(),
                side,
                tiles,
                fresh: marked.clone(),
                marked,
            });
        }
        Some(())
    }

    /// Marks the outlines that objects keep, and one point of the limit set of each object.
    fn mark_own(&mut self, errors: &[f64], most: usize) -> Result<(), TooMany> {
        for word in &self.words.kept {
            let outline = self.outline_of(word.inner);
            let grid = &mut self.grids[word.outer];
            let places = grid.places().inverse();
            let mut mark = |point| grid.mark(places.apply(point));
            let mut region = Region::of_all(errors[word.outer] / 2.0, most, &mut mark);
            F::add_outline(&mut region, outline, &word.map)?;
        }
        for index in 0..self.grids.len() {
            if let Some(point) = self.point(index) {
                let grid = &mut self.grids[index];
                grid.mark(grid.places().inverse().apply(point));
            }
        }
        Ok(())
    }

    /// Returns a point of an object's limit set: the limit of the path of first replaced instances. Returns
    /// `None` if the path ends.
    fn point(&self, mut index: usize) -> Option<F::Point> {
        const MAX_LEVELS: usize = 100_000;
        const NEGLIGIBLE: f64 = 1e-17;
        let mut map = F::Map::IDENTITY;
        for _ in 0..MAX_LEVELS {
            let (inner, instance) = self.objects.replaced(index).next()?;
            map = map * instance;
            index = inner;
            if map.linear().stretch() <= NEGLIGIBLE {
                break;
            }
        }
        Some(map.translation())
    }

    /// Marks the images of all marked cells, and the images of these, until there are no new ones. Returns
    /// `None` if that takes more than `most` images.
    fn mark_images(&mut self, most: usize) -> Option<()> {
        let images = self.images();
        let mut left = most;
        let mut is_fresh = true;
        while is_fresh {
            is_fresh = false;
            for (index, images) in images.iter().enumerate() {
                for tile in 0..self.grids[index].fresh.len() {
                    let cells = std::mem::take(&mut self.grids[index].fresh[tile]);
                    if cells == 0 {
                        continue;
                    }
                    is_fresh = true;
                    let corner = self.grids[index].corner_of(tile);
                    for image in images {
                        let grid = &mut self.grids[image.grid];
                        if grid.holds(image, corner + half::<F>()) {
                            continue;
                        }
                        left = left.checked_sub(cells.count_ones() as usize)?;
                        let corner = image.map.apply(corner + F::Point::splat(0.5));
                        for bit in ones(cells) {
                            grid.mark(image.beyond(corner, place::<F>(bit)));
                        }
                    }
                }
            }
        }
        Some(())
    }

    /// Returns the maps that take the cells of each grid into other grids.
    fn images(&self) -> Vec<Vec<Image<F>>> {
        let mut images: Vec<Vec<Image<F>>> = self.grids.iter().map(|_| Vec::new()).collect();
        for word in &self.words.replaced {
            let places = self.grids[word.outer].places().inverse();
            let map = places * word.map * self.grids[word.inner].places();
            let mut axes = [F::Point::ZERO; 3];
            for (axis, unit) in axes.iter_mut().zip(F::Point::AXES.iter().step_by(2)) {
                *axis = map.apply(*unit) - map.translation();
            }
            images[word.inner].push(Image {
                map,
                axes,
                grid: word.outer,
            });
        }
        images
    }
}

impl<F: Covering> Image<F> {
    /// Returns a place moved by the image of a vector.
    #[inline]
    fn beyond(&self, place: F::Point, [x, y, z]: [usize; 3]) -> F::Point {
        place + self.axes[0] * real(x) + self.axes[1] * real(y) + self.axes[2] * real(z)
    }
}

impl<F: Covering> Grid<F> {
    /// Returns the map from coordinates in units of cells to the unit frame.
    fn places(&self) -> F::Map {
        F::Map::new(LinearOf::<F>::IDENTITY * self.side, self.corner)
    }

    /// Returns a box that holds the tiles with occupied cells and a margin `around` them.
    fn bounds(&self, around: f64) -> Bounds<F::Point> {
        let mut bounds = Bounds::EMPTY;
        let places = self.places();
        for (tile, cells) in self.marked.iter().enumerate() {
            if *cells != 0 {
                let corner = self.corner_of(tile);
                bounds.add(places.apply(corner));
                bounds.add(places.apply(corner + half::<F>() * 2.0));
            }
        }
        let around = F::Point::splat(around);
        Bounds::new(bounds.min() - around, bounds.max() + around)
    }

    /// Returns the numbers of columns, rows and layers of cells.
    #[inline]
    fn counts(&self) -> [usize; 3] {
        let ([a, b, c], [columns, rows, layers]) = (F::TILE, self.tiles);
        [a * columns, b * rows, c * layers]
    }

    /// Returns the lowest corner of a tile.
    fn corner_of(&self, tile: usize) -> F::Point {
        let [columns, rows, _] = self.tiles;
        let tiles = [tile % columns, tile / columns % rows, tile / columns / rows];
        F::Point::of_coordinates([0, 1, 2].map(|axis| real(F::TILE[axis] * tiles[axis])))
    }

    /// Returns the index of a cell's tile, and the mask of its bit.
    #[inline]
    fn find(&self, [x, y, z]: [usize; 3]) -> (usize, u64) {
        let [a, b, c] = F::TILE;
        let tile = (z / c * self.tiles[1] + y / b) * self.tiles[0] + x / a;
        (tile, 1 << ((z % c * b + y % b) * a + x % a))
    }

    /// Returns the cell that a point lies in, or the nearest one.
    #[inline]
    fn nearest(&self, place: F::Point) -> [usize; 3] {
        let [x, y, z] = place.coordinates();
        let [columns, rows, layers] = self.counts();
        [within(x, columns), within(y, rows), within(z, layers)]
    }

    /// Returns `true` if all tiles that the image of a tile meets are filled, which is frequent inside filled
    /// regions. `tile` is the centre of the tile; images that are too large return `false`.
    fn holds(&self, image: &Image<F>, tile: F::Point) -> bool {
        const MOST: usize = 4;
        let middle = image.map.apply(tile);
        let sizes = half::<F>().coordinates();
        let sides = image.axes.iter().zip(sizes);
        let half = sides.fold(F::Point::ZERO, |all, (axis, half)| all + axis.abs() * half);
        let [low, high] = [middle - half, middle + half].map(|corner| {
            let cell = self.nearest(corner);
            [0, 1, 2].map(|axis| cell[axis] / F::TILE[axis])
        });
        if (0..3).any(|axis| high[axis] - low[axis] >= MOST) {
            return false;
        }
        let is_full = |row: usize| {
            let row = &self.marked[row * self.tiles[0]..];
            row[low[0]..=high[0]].iter().all(|cells| *cells == u64::MAX)
        };
        (low[2]..=high[2])
            .all(|layer| (low[1]..=high[1]).all(|row| is_full(layer * self.tiles[1] + row)))
    }

    fn has(&self, cell: [usize; 3]) -> bool {
        let (tile, bit) = self.find(cell);
        self.marked[tile] & bit != 0
    }

    /// Marks the cell of a point, which is fresh if it was not marked before.
    #[inline]
    fn mark(&mut self, place: F::Point) {
        let (tile, bit) = self.find(self.nearest(place));
        let is_new = bit & !self.marked[tile];
        self.marked[tile] |= is_new;
        self.fresh[tile] |= is_new;
    }
}

/// Iterates over cells, balls of a radius about which cover space with little overlap: those of a hexagonal lattice in the
/// plane, and of a body-centred one in space (Conway & Sloane 1999, chapter 2). The radius is measured in cells.
fn lattice<F: Covering>(
    [columns, rows, layers]: [usize; 3],
    radius: f64,
) -> impl Iterator<Item = [usize; 3]> {
    let is_plane = F::Point::DIMENSION == 2;
    // Distances within a slice of the lattice, and between slices; every other slice is shifted by half of the first.
    let [wide, high] = match is_plane {
        true => [3.0f64.sqrt(), 1.5],
        false => [4.0 / 5.0f64.sqrt(), 2.0 / 5.0f64.sqrt()],
    }
    .map(|it| whole(radius * it).max(1));
    let slices = if is_plane { rows } else { layers };
    (0..slices).step_by(high).flat_map(move |slice| {
        let start = slice / high % 2 * (wide / 2);
        let across = match is_plane {
            true => slice..slice + 1,
            false => start..rows,
        };
        across.step_by(wide).flat_map(move |row| {
            let layer = if is_plane { 0 } else { slice };
            (start..columns)
                .step_by(wide)
                .map(move |it| [it, row, layer])
        })
    })
}

/// Returns the vector from the corner of a tile to its centre, in cells.
fn half<F: Covering>() -> F::Point {
    F::Point::of_coordinates(F::TILE.map(|side| real(side) / 2.0))
}

/// Returns the place of a bit in its tile.
#[inline]
fn place<F: Covering>(bit: u32) -> [usize; 3] {
    let ([columns, rows, _], bit) = (F::TILE, bit as usize);
    [bit % columns, bit / columns % rows, bit / columns / rows]
}

/// Returns the centre of a cell.
#[inline]
fn middle<P: Point>(cell: [usize; 3]) -> P {
    P::of_coordinates(cell.map(real)) + P::splat(0.5)
}

/// Returns the cell along an axis that a coordinate lies in, or the nearest one.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "rows of cells are short, and casts from floats saturate"
)]
fn within(coordinate: f64, count: usize) -> usize {
    (coordinate as i32).clamp(0, count as i32 - 1) as usize
}
