//! Bounds of the stretch of products of linear maps, for all products of a length at once.

use crate::geometry::{DMat2, DVec2, convex_hull, thinned};

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
