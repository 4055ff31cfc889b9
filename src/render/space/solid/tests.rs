//! Tests of drawn solids.

use proptest::prelude::*;

use super::super::buffer::BLOCKS_ALONG;
use super::*;
use crate::geometry::{Bounds, Round};

fn view(is_central: bool) -> View<'static> {
    const MIDDLE: f64 = SIDE as f64 / 2.0;
    View {
        projection: match is_central {
            true => Projection::Central {
                focus: 700.0,
                middle: [256.0 + MIDDLE, 512.0 + MIDDLE - 9.0],
            },
            false => Projection::Parallel,
        },
        depths: Depths::new([-1000.0, 0.0]),
        cuts: &[],
        corner: [256.0, 512.0],
    }
}

/// Returns solids of all kinds in places that meet the tile.
fn solids(is_central: bool) -> impl Strategy<Value = Vec<(Solid, DAffine3)>> {
    let kind = prop_oneof![
        Just(Solid::cuboid(&Bounds::new(-DVec3::ONE, DVec3::ONE))),
        Just(Solid::round(Round::Ball, DAffine3::IDENTITY)),
        Just(Solid::round(Round::Cylinder, DAffine3::IDENTITY)),
        Just(Solid::round(Round::Cone, DAffine3::IDENTITY)),
    ];
    let part = || prop_oneof![4 => -90.0..90.0, 1 => Just(0.0)];
    let vector = || (part(), part(), part()).prop_map(DVec3::from);
    // Some are about the viewer of a central view.
    let depth = prop_oneof![4 => -800.0..-300.0, 1 => -150.0..50.0];
    let place = (-60.0..256.0, -60.0..256.0, depth).prop_map(DVec3::from);
    let map = (vector(), vector(), vector(), place).prop_map(move |(x, y, z, at)| {
        // Rays of a central view begin at the origin, and those of a parallel one at their samples.
        let corner = if is_central {
            DVec3::ZERO
        } else {
            DVec3::new(256.0, 512.0, 0.0)
        };
        DAffine3::from_cols(x, y, z, at + corner)
    });
    proptest::collection::vec((kind, map), 2..6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Strips of eight samples are drawn whole, without a search for what may be seen.
    #[test]
    fn what_is_left_out_shows_nothing(
        (is_central, solids) in any::<bool>().prop_flat_map(|it| (Just(it), solids(it))),
        is_lit: bool,
    ) {
        let view = view(is_central);
        let mut of = |normal: DVec3| if normal.x > 0.0 { 1 } else { 2 };
        let [mut whole, mut strips] = [Buffer::new(), Buffer::new()];
        let mut pencil = Pencil::default();
        for (number, (solid, map)) in solids.iter().enumerate() {
            let mut draw = |buffer: &mut Buffer, rectangle| {
                let classes = match is_lit {
                    true => Classes::OfNormals(&mut of),
                    false => Classes::One(u16::try_from(number).unwrap_or(0)),
                };
                let body = Body::new(solid, map);
                pencil.draw(buffer, &view, &body, rectangle, classes);
            };
            draw(&mut whole, [0, 0, SIDE, SIDE]);
            for left in (0..SIDE).step_by(8) {
                draw(&mut strips, [left, 0, left + 8, SIDE]);
            }
        }
        for y in 0..SIDE {
            prop_assert_eq!(whole.row(y), strips.row(y), "row {}", y);
        }
        for row in 0..BLOCKS_ALONG {
            prop_assert_eq!(whole.blocks(row), strips.blocks(row));
        }
    }
}

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
