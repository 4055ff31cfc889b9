//! Tests of flat maps of solids.

use super::*;

#[test]
fn flat_maps_become_as_thick_as_a_sample() {
    let flat = DMat3::from_diagonal(DVec3::new(5.0, 3.0, 0.0));
    let thick = thickened(&flat, 0.5);
    assert!(
        thick.abs_diff_eq(DMat3::from_diagonal(DVec3::new(5.0, 3.0, 0.5)), 1e-12)
            || thick.abs_diff_eq(DMat3::from_diagonal(DVec3::new(5.0, 3.0, -0.5)), 1e-12)
    );
    assert!((thickened(&DMat3::ZERO, 1.0).determinant().abs() - 1.0).abs() < 1e-12);
    let fine = DMat3::from_diagonal(DVec3::splat(2.0));
    assert_eq!(thickened(&fine, 0.3), fine);
}
