//! How much products of linear maps stretch, all of a length at once.

use crate::geometry::{DMat2, DVec2, convex_hull, thinned};

/// Corners that may be mapped, and the longest products.
const MOST_WORK: usize = 1 << 20;
const MOST_LENGTH: u32 = 20_000;

/// Corners nearer to a side than this multiple of the size are left out.
const FLAT: f64 = 1e-9;

/// Products of a length, of which each shrinks to less than a half.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shrinking {
    pub(crate) length: u32,
    /// The most that one of them stretches anything.
    pub(crate) stretch: f64,
    /// No less than the sum over all n of the most that products of n maps stretch anything.
    pub(crate) sum: f64,
}

impl Shrinking {
    /// The shortest length that is found. In the place of every kind there are images of others, by
    /// number.
    ///
    /// The most that products of n maps stretch is how far the images of a disc reach under all of
    /// them, so the convex hulls of the images are carried on. Once they reach less than 1/2, the rest of
    /// the sum is no more than what came before.
    pub(crate) fn found(images: &[Vec<(DMat2, usize)>]) -> Option<Self> {
        let square = [DVec2::ONE, DVec2::NEG_X + DVec2::Y];
        let square = square.into_iter().flat_map(|corner| [corner, -corner]);
        let mut polygons = vec![convex_hull(square.collect(), 0.0); images.len()];
        let (mut sum, mut most, mut lost, mut work) = (1.0, 1.0f64, 0.0, 0);
        for length in 1..=MOST_LENGTH {
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
            // What was left out may have been stretched as much as anything.
            let stretch = longest + most * lost;
            lost += dropped;
            if !stretch.is_finite() || work > MOST_WORK {
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
