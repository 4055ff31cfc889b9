//! Bounds of the stretch of products of linear maps, for all products of a length at once.

use crate::geometry::{DMat2, DVec2, Linear, convex_hull, thinned};
use crate::work;

/// Limit of the number of corners that are mapped.
const MAX_WORK: usize = 1 << 20;

/// Limit of the length of products.
const MAX_LENGTH: u32 = 20_000;

/// Distance from a side, as a share of the size, below which corners are left out.
const FLAT: f64 = 1e-9;

/// A length at which every product of linear maps shrinks to at most a half.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shrinking {
    pub(crate) length: u32,
    /// Upper bound of the stretch of a product of this length.
    pub(crate) stretch: f64,
    /// Upper bound of the sum over all n ≥ 0 of the largest stretch of a product of n maps.
    pub(crate) sum: f64,
}

impl Shrinking {
    /// Returns the shortest length at which the bound is at most 1/2; `None` if none is found within the
    /// limits. `images` lists for every kind of object the linear maps of its instances and the kinds that
    /// they instance.
    ///
    /// The largest stretch of a product of n maps is the reach of a disc's images under all such products, so
    /// the convex hulls of the images are carried on. Once they reach at most 1/2, the rest of the sum is at
    /// most the sum so far.
    pub(crate) fn found(images: &[Vec<(DMat2, usize)>]) -> Option<Self> {
        let square = [DVec2::ONE, DVec2::NEG_X + DVec2::Y];
        let square = square.into_iter().flat_map(|corner| [corner, -corner]);
        let mut polygons = vec![convex_hull(square.collect(), 0.0); images.len()];
        let (mut sum, mut most, mut lost, mut work) = (1.0, 1.0f64, 0.0, 0);
        for length in 1..=MAX_LENGTH {
            let (mut longest, mut dropped) = (0.0f64, 0.0f64);
            let next = images.iter().map(|images| {
                let points = images.iter().flat_map(|(linear, inner)| {
                    let corners = polygons[*inner].iter();
                    corners.map(|corner| *linear * *corner)
                });
                let points: Vec<DVec2> = points.collect();
                work += points.len();
                let size = points.iter().map(|point| point.length());
                let size = size.fold(0.0, f64::max);
                longest = longest.max(size);
                dropped = dropped.max(FLAT * size);
                thinned(&convex_hull(points, 0.0), FLAT * size)
            });
            polygons = next.collect();
            // The corners left out may have been stretched by as much as any product.
            let stretch = longest + most * lost;
            lost += dropped;
            if !stretch.is_finite() || work > MAX_WORK {
                return None;
            }
            if stretch <= 0.5 {
                let sum = 2.0 * sum;
                return Some(Self {
                    length,
                    stretch,
                    sum,
                });
            }
            most = most.max(stretch);
            sum += stretch;
        }
        None
    }
}

/// Limit of the number of products that are formed for a factor.
const MAX_PRODUCTS: usize = 1 << 15;

/// [Work](work) of a product that is formed.
const PRODUCT: usize = 2;

/// Returns an upper bound of the sum over all n ≥ 0 of the largest stretch of a product of n linear maps; `None` if
/// none is found. `images` lists for every kind of object the linear maps of its instances and the kinds that they
/// instance.
///
/// For a factor λ < 1, products are extended until they stretch by at most λ to the power of their length. If all end
/// so, any product consists of such pieces and the beginning of one, hence the largest stretch of n maps is at most C λⁿ,
/// where C is the largest ratio of a beginning's stretch to the power of its length (after Daubechies & Lagarias 1992).
pub(crate) fn sum_of_products<L: Linear>(images: &[Vec<(L, usize)>]) -> Option<f64> {
    const FACTORS: [f64; 7] = [0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99];
    FACTORS
        .into_iter()
        .find_map(|factor| Some(largest_beginning(images, factor)? / (1.0 - factor)))
}

/// Returns the largest ratio of the stretch of a product to λ to the power of its length, over the products that are
/// extended; `None` if there are too many.
fn largest_beginning<L: Linear>(images: &[Vec<(L, usize)>], factor: f64) -> Option<f64> {
    let mut open: Vec<(L, usize, f64)> = (0..images.len())
        .map(|kind| (L::IDENTITY, kind, 1.0))
        .collect();
    let mut largest = 1.0f64;
    let mut formed = 0;
    while let Some((product, kind, power)) = open.pop() {
        let power = power * factor;
        for (linear, inner) in &images[kind] {
            formed += 1;
            work::count(PRODUCT);
            if formed > MAX_PRODUCTS {
                return None;
            }
            let longer = product * *linear;
            let stretch = longer.stretch();
            // NaN is extended, and ends by the limit.
            if stretch <= power {
                continue;
            }
            largest = largest.max(stretch / power);
            open.push((longer, *inner, power));
        }
    }
    largest.is_finite().then_some(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DMat3;
    use crate::geometry::DVec3;

    #[test]
    fn products_of_space_shrink_as_those_of_the_plane() {
        let plane = [
            DMat2::from_cols(DVec2::new(0.0, 0.2), DVec2::new(1.5, 0.0)),
            DMat2::from_cols(DVec2::new(0.3, 0.0), DVec2::new(0.9, 0.4)),
        ];
        let in_space = |map: &DMat2| {
            let [x, y] = [map.x_axis, map.y_axis];
            DMat3::from_cols(x.extend(0.0), y.extend(0.0), DVec3::Z * 0.1)
        };
        let flat = [plane.map(|map| (map, 0)).to_vec()];
        let solid = [plane.each_ref().map(|map| (in_space(map), 0)).to_vec()];
        let tight = Shrinking::found(&flat).map(|it| it.sum);
        let [plane, space] = [sum_of_products(&flat), sum_of_products(&solid)];
        let (Some(tight), Some(plane), Some(space)) = (tight, plane, space) else {
            panic!("all are found: {tight:?}, {plane:?}, {space:?}");
        };
        assert_eq!(plane, space);
        assert!(space < 20.0 * tight, "{space} {tight}");
        // A turn never shrinks.
        assert_eq!(sum_of_products(&[vec![(DMat3::IDENTITY, 0)]]), None);
    }
}
