//! Tests of solids: hulls, faces and volumes.

use super::*;

#[test]
fn hulls_of_platonic_solids() {
    let tetrahedron = [
        DVec3::ONE,
        DVec3::new(1.0, -1.0, -1.0),
        DVec3::new(-1.0, 1.0, -1.0),
        DVec3::new(-1.0, -1.0, 1.0),
        DVec3::ZERO,
    ];
    let hull = Solid::hull(&tetrahedron);
    assert_eq!((hull.faces().len(), hull.corners().len()), (4, 4));
    assert!((hull.signed_area() - 8.0 * 3f64.sqrt()).abs() < 1e-9);
    let cube = Solid::cuboid(&Bounds::new(DVec3::ZERO, DVec3::ONE));
    let hull = Solid::hull(cube.corners());
    assert_eq!((hull.faces().len(), hull.corners().len()), (6, 8));
    assert!((hull.signed_area() - 6.0).abs() < 1e-9);
    assert!((hull.support(DVec3::ONE) - 3.0).abs() < 1e-12);
}

#[test]
fn faces_turn_outwards_and_enclose_the_volume() {
    // Six times the volume, by the divergence theorem over triangles of the faces.
    let volume = |solid: &Solid| -> f64 {
        let faces = solid.polygons();
        let triangles = faces.iter().flat_map(|face| {
            let others = face[1..].windows(2);
            others.map(|pair| face[0].dot(pair[0].cross(pair[1])))
        });
        triangles.sum::<f64>() / 6.0
    };
    let cuboid = Solid::cuboid(&Bounds::new(DVec3::ONE, DVec3::new(3.0, 4.0, 2.0)));
    let faces = cuboid.polygons();
    assert_eq!(faces.iter().map(Vec::len).collect::<Vec<_>>(), [4; 6]);
    assert!((volume(&cuboid) - 6.0).abs() < 1e-9 && (cuboid.volume() - 6.0).abs() < 1e-9);
    let corners = [DVec3::X, DVec3::Y, DVec3::Z];
    let octahedron = Solid::hull(&corners.map(|it| [it, -it]).concat());
    assert_eq!(octahedron.polygons().len(), 8);
    assert!((volume(&octahedron) - 4.0 / 3.0).abs() < 1e-9);
    let flat = Solid::cuboid(&Bounds::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)));
    assert_eq!(
        flat.polygons().iter().map(Vec::len).collect::<Vec<_>>(),
        [4]
    );
    assert!(
        Solid::hull(&[DVec3::ZERO, DVec3::ONE])
            .polygons()
            .is_empty()
    );
}

#[test]
fn flat_hulls_keep_their_shape() {
    let triangle = [DVec3::X, DVec3::Y, DVec3::Z];
    let hull = Solid::hull(&triangle);
    assert_eq!((hull.faces().len(), hull.corners().len()), (5, 3));
    assert!((hull.signed_area() - 3f64.sqrt() / 2.0).abs() < 1e-9);
    assert_eq!(hull.volume(), 0.0);
    assert!(hull.place().matrix3.determinant().abs() < 1e-12);
    let line = Solid::hull(&[DVec3::ZERO, DVec3::ONE, DVec3::splat(0.25)]);
    assert_eq!(line.corners().len(), 2);
    assert!(
        line.corners()[1].abs_diff_eq(DVec3::ONE, 1e-12)
            || line.corners()[0].abs_diff_eq(DVec3::ONE, 1e-12)
    );
    let point = Solid::hull(&[DVec3::ONE; 3]);
    assert_eq!((point.support(DVec3::X), point.corners().len()), (1.0, 1));
    assert!(point.polygons().is_empty());
}
