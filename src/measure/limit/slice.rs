//! Slices of limit sets by planes, covered by layers of cubes.

use crate::bits::Bits;
use crate::geometry::DAffine2;
use crate::geometry::{Affine, Bounds, DAffine3, DMat3, DVec3};
use crate::measure::box_counting::whole_power;
use crate::measure::cover::Grid;
use crate::measure::space::Space;
use crate::saturating::{real, whole};
use std::num::NonZero;

use super::{EXACT, LimitCopy, LimitSet, MAX_WORK};

/// The slice of a limit set by a plane.
///
/// It is covered by cubes with two faces parallel to the plane, which halves them: for every size, by the layer of
/// cubes about the plane. The set that the layers converge to is the slice; a cube of a layer that meets the set
/// beside the plane counts, until it becomes too small.
#[derive(Clone, Debug)]
pub struct SlicedSet {
    pub(super) set: LimitSet<DAffine3>,
}

impl LimitSet<DAffine3> {
    /// Returns the slice by the plane of the points x with `normal` · x = `offset`.
    ///
    /// # Errors
    ///
    /// Returns the range of `normal` · x over the set, if the plane lies outside.
    pub fn slice(&self, normal: DVec3, offset: f64) -> Result<SlicedSet, [f64; 2]> {
        /// Distance, relative to the set, up to which a plane beside the set touches it.
        const ROUNDING: f64 = 1e-9;
        let length = normal.length();
        let across = normal / length;
        // Along an axis, the other two are those of space.
        let (right, up) = match across.abs().to_array() {
            [_, _, 1.0] => (DVec3::X, DVec3::Y * across.z),
            [_, 1.0, _] => (DVec3::Z * across.y, DVec3::X),
            [1.0, _, _] => (DVec3::Y, DVec3::Z * across.x),
            _ => across.any_orthonormal_pair(),
        };
        let turn = DMat3::from_cols(right, up, right.cross(up)).transpose();
        let turn = DAffine3::new(turn, DVec3::new(0.0, 0.0, -offset / length));
        let start = self.start.iter();
        let start: Vec<LimitCopy<DAffine3>> = start
            .map(|copy| LimitCopy {
                map: turn * copy.map,
                ..*copy
            })
            .collect();
        let bounds = Self::extent(&self.objects, &start, EXACT, MAX_WORK);
        let slack = ROUNDING * bounds.size().max_element();
        let (low, high) = (bounds.min().z, bounds.max().z);
        if low > slack || high < -slack {
            return Err([low, high].map(|at| at * length + offset));
        }
        let flat = |corner: DVec3| corner.with_z(0.0);
        Ok(SlicedSet {
            set: Self {
                objects: self.objects.clone(),
                start,
                bounds: Bounds::new(flat(bounds.min()), flat(bounds.max())),
                is_layer: true,
            },
        })
    }
}

impl SlicedSet {
    /// Returns the slice as a set that is covered by layers.
    pub(in crate::measure) fn set(&self) -> &LimitSet<DAffine3> {
        &self.set
    }

    /// Returns the squares of the plane that the slice meets, row by row from the lower left, and their side: some 200
    /// to 600 in a row, whose number is a power of the factor at which the set repeats itself, or of 2. Returns `None`
    /// where too many copies overlap, or if the slice is a point.
    #[must_use]
    pub fn squares(&self) -> Option<(Bits, f64)> {
        const MOST: f64 = 600.0;
        let base = NonZero::new(whole(whole_power(self.set.period())))?;
        let levels = (libm::log(MOST) / libm::log(real(base.get()))).floor();
        let levels = u32::try_from(whole(levels)).ok()?;
        let is_wide = self.set.bounds().size().max_element() > 0.0;
        is_wide.then(|| self.set.raster(base, levels))?
    }

    /// Returns grids that are turned and shifted in the plane.
    pub(in crate::measure) fn grids(count: NonZero<usize>) -> Vec<Grid<DAffine3>> {
        let plane = Grid::<DAffine2>::spread(count).into_iter();
        let in_space = |grid: Grid<DAffine2>| {
            let turn = DAffine2::new(DAffine2::rotation(&grid.turn), glam::DVec2::ZERO);
            Grid {
                turn: turn.in_space().matrix3,
                shift: grid.shift.extend(0.0),
            }
        };
        plane.map(in_space).collect()
    }
}
