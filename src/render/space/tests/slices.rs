//! Tests of slices and cuts.

use super::*;
use crate::geometry::HalfSpace;

fn sliced(graph: &Graph<Frame3>, slice: Slice, side: u32, up: Option<DVec3>) -> Pixmap {
    let options = Options::default().size(Size::Long(side));
    let camera = Camera::default()
        .from(slice.from())
        .up(up)
        .look_at(Some(DVec3::ZERO));
    let space = SpaceOptions::default().camera(camera).slice(Some(slice));
    draw(graph, None, &options, &space, None).unwrap().pixmap
}

/// Returns the share of pixels at which a turn about the middle of a picture changes paper into ink.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the positions lie on the picture"
)]
fn change_by_turn(pixmap: &Pixmap, degrees: f64) -> f64 {
    let (width, height) = (f64::from(pixmap.width()), f64::from(pixmap.height()));
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let paper = paper(pixmap);
    let (mut ink, mut other) = (0.0, 0.0);
    for (at, is_paper) in paper.iter().enumerate() {
        let x = (at % pixmap.width() as usize) as f64 + 0.5 - width / 2.0;
        let y = (at / pixmap.width() as usize) as f64 + 0.5 - height / 2.0;
        let turned = [
            x * cosine - y * sine + width / 2.0,
            x * sine + y * cosine + height / 2.0,
        ];
        let inside =
            turned[0] >= 0.0 && turned[1] >= 0.0 && turned[0] < width && turned[1] < height;
        let there = turned[1] as usize * pixmap.width() as usize + turned[0] as usize;
        ink += f64::from(u8::from(!is_paper));
        other += f64::from(u8::from(
            !inside && !is_paper || inside && paper[there] != *is_paper,
        ));
    }
    other / ink
}

#[test]
fn a_slice_of_the_icosahedral_set_across_a_vertex_has_five_fold_symmetry() {
    let graph = vertices("solid: icosahedron", "1/(1 + phi)");
    let (_, solid) = graph.base_elements().iter().enumerate().next().unwrap();
    let vertex = solid.corners()[0];
    let slice = Slice::new(vertex, 0.0).thickness(Some(0.05));
    let seen = sliced(&graph, slice, 160, None);
    assert!(share(&seen) > 0.1);
    for turns in [1.0, 2.0] {
        let change = change_by_turn(&seen, 72.0 * turns);
        assert!(change < 0.25, "{change}");
    }
    assert!(change_by_turn(&seen, 30.0) > 0.3);
}

#[test]
fn a_slice_of_the_sponge_across_a_diagonal_has_six_fold_symmetry() {
    // About the origin, so that the camera looks at its middle.
    let mut text = "kind: ifs\nspace: 3\nmaps:\n".to_owned();
    for cell in 0..27 {
        let at = [cell % 3, cell / 3 % 3, cell / 9].map(|at| at - 1);
        if at.iter().filter(|at| **at == 0).count() < 2 {
            let [x, y, z] = at;
            text.push_str(&format!(
                "  - {{scale: 1/3, translate: [{x}/3, {y}/3, {z}/3]}}\n"
            ));
        }
    }
    let seen = sliced(&graph_of(&text), Slice::new(DVec3::ONE, 0.0), 243, None);
    let share = share(&seen);
    assert!((0.2..0.6).contains(&share), "{share}");
    assert!(change_by_turn(&seen, 60.0) < 0.12);
    assert!(change_by_turn(&seen, 30.0) > 0.3);
    // A section shows one depth.
    let colours: std::collections::HashSet<_> = seen
        .pixels()
        .iter()
        .map(|it| [it.red(), it.green(), it.blue()])
        .collect();
    assert!(colours.len() <= 17, "{}", colours.len());
}

#[test]
fn a_slice_of_the_sponge_across_an_axis_is_the_carpet_or_its_corners() {
    let graph = sponge();
    let camera = Camera::default().from([0.0, 0.0]);
    let options = Options::default().size(Size::Long(27));
    for (offset, ink) in [(0.01, 512), (0.5, 64)] {
        let slice = Slice::new(DVec3::Z, offset).thickness(Some(0.001));
        let space = SpaceOptions::default().camera(camera).slice(Some(slice));
        let seen = draw(&graph, Some(3), &options, &space, None)
            .unwrap()
            .pixmap;
        let found = paper(&seen).iter().filter(|it| !**it).count();
        assert_eq!(found, ink, "{offset}");
    }
}

#[test]
fn a_slice_beside_the_set_is_an_error() {
    let graph = sponge();
    let options = Options::default();
    let missing = SpaceOptions::default().slice(Some(Slice::new(DVec3::ONE, 3.5)));
    let error = draw(&graph, None, &options, &missing, None).unwrap_err();
    let message = "the slice or cut leaves nothing of the set, which lies between 0.000000 and 3.000000 along its \
                   normal";
    assert_eq!(error.to_string(), message);
}

#[test]
fn a_cut_shows_what_lies_behind_its_plane() {
    let graph = vertices("solid: cube", "1/2");
    let cut = HalfSpace {
        normal: DVec3::Z,
        distance: 0.0,
    };
    let space = SpaceOptions::default()
        .camera(Camera::default().from([90.0, 0.0]))
        .cuts(vec![cut]);
    let options = Options::default().size(Size::Long(64));
    // Half of the cube, seen from aside.
    let seen = draw(&graph, None, &options, &space, None).unwrap().pixmap;
    assert_eq!([seen.width(), seen.height()], [32, 64]);
    assert_eq!(share(&seen), 1.0);
    let front = space.camera(Camera::default().from([0.0, 0.0]));
    let seen = draw(&graph, None, &options, &front, None).unwrap().pixmap;
    let nearest = seen.pixels()[0];
    assert!(seen.pixels().iter().all(|pixel| *pixel == nearest));
}

/// Turned and sheared solids are cut themselves, not boxes about them.
#[test]
fn pictures_fit_what_is_left_of_solids() {
    let ellipsoid = graph_of(
        "{kind: instancing, space: 3, objects: {b: [{sphere: {radius: 0.5}}]}, \
         scene: [{object: b, scale: [3, 1, 1], rotate: {z: 30}}]}",
    );
    let options = Options::default().size(Size::Long(200));
    let draw = |space: &SpaceOptions| {
        draw(&ellipsoid, None, &options, space, None)
            .unwrap()
            .pixmap
    };
    let half = |normal: DVec3, distance: f64| HalfSpace { normal, distance };
    let view =
        |azimuth: f64| SpaceOptions::default().camera(Camera::default().from([azimuth, 0.0]));
    let whole = draw(&view(20.0));
    // Nothing is cut off.
    let cuts = vec![half(DVec3::X, 5.0), half(DVec3::new(-1.0, 0.2, 0.3), 4.0)];
    assert_eq!(draw(&view(20.0).cuts(cuts)).data(), whole.data());
    // With [[1.75, √0.75], [√0.75, 0.75]] as its squares and products along x and y, what is left, x ≤ 0, reaches
    // from −√1.75 to 0 and from −√0.75 to √(0.75 − 0.75 / 1.75).
    let seen = draw(&view(0.0).cuts(vec![half(DVec3::X, 0.0)]));
    let tall = 0.75_f64.sqrt() + (0.75_f64 - 0.75 / 1.75).sqrt();
    let expected = 200.0 * 1.75_f64.sqrt() / tall;
    assert_eq!(seen.height(), 200);
    assert!(
        (f64::from(seen.width()) - expected).abs() <= 1.0,
        "{} {expected}",
        seen.width()
    );
    // Between two parallel planes, seen along the axis of rotation, a disk is left.
    let slab = Slice::new(DVec3::new(0.75_f64.sqrt(), 0.5, 0.0), 0.9).thickness(Some(1e-6));
    let camera = Camera::default().from(slab.from());
    let seen = draw(&SpaceOptions::default().camera(camera).slice(Some(slab)));
    assert_eq!([seen.width(), seen.height()], [200, 200]);
}

/// A gap of the set that is finer than the boxes by which the extent of a slice is found.
#[test]
fn a_slice_in_a_fine_gap_is_an_error() {
    let dust = graph_of(
        "{kind: ifs, space: 3, vertices: {points: [[-1, 0, 0], [1, 0, 0]], shrink: 0.49}}",
    );
    let middle = |levels: i32| 1.0 - 0.49_f64.powi(levels);
    let mut options = Options::default().size(Size::Long(16));
    options.detail = Some(crate::render::Detail {
        pixels: 1e-5,
        decides_steps: true,
    });
    for levels in [0, 4, 13, 16] {
        // The middle of the gap next to the end.
        let slice = Slice::new(DVec3::X, middle(levels)).thickness(Some(1e-8));
        let space = SpaceOptions::default().slice(Some(slice));
        let error = draw(&dust, None, &options, &space, None).unwrap_err();
        assert!(
            matches!(error, RenderError::Space(SpaceError::NothingLeft(_))),
            "{levels}: {error}"
        );
    }
}
