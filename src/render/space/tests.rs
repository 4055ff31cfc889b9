//! Tests of pictures in space, against the plane, closed forms and drawing without culling.

use std::num::NonZero;
use std::sync::Arc;

use tiny_skia::PremultipliedColorU8;

use super::buffer::{Buffer, EMPTY, SIDE};
use super::*;
use crate::catalogue::Catalogue;
use crate::diagnostic::Source;
use crate::document::Document;
use crate::geometry::DVec3;
use crate::grow::{Elements, Growth};
use crate::model::Model;
use crate::render::Size;
use crate::style::View as Window;

mod first_tile;
mod slices;

pub(super) use first_tile::{FirstTile, Short};

fn model(text: &str) -> Model {
    let source = Source::new("test", text.to_owned());
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    document.resolve(&[]).unwrap().0
}

pub(super) fn graph_of(text: &str) -> Graph<Frame3> {
    model(text).compile_in_space(false).unwrap()
}

fn vertices(what: &str, shrink: &str) -> Graph<Frame3> {
    graph_of(&format!(
        "{{kind: ifs, space: 3, vertices: {{{what}, shrink: {shrink}}}}}"
    ))
}

/// A Menger sponge as maps rather than vertices, so that it begins with a box.
pub(super) fn sponge() -> Graph<Frame3> {
    let mut text = "kind: ifs\nspace: 3\nmaps:\n".to_owned();
    for cell in 0..27 {
        let at = [cell % 3, cell / 3 % 3, cell / 9];
        if at.iter().filter(|at| **at == 1).count() < 2 {
            let [x, y, z] = at;
            text.push_str(&format!(
                "  - {{scale: 1/3, translate: [{x}/3, {y}/3, {z}/3]}}\n"
            ));
        }
    }
    graph_of(&text)
}

fn seen(graph: &Graph<Frame3>, steps: Option<u32>, from: [f64; 2], side: u32) -> Pixmap {
    seen_by(graph, steps, Camera::default().from(from), side, 1)
}

fn seen_by(
    graph: &Graph<Frame3>,
    steps: Option<u32>,
    camera: Camera,
    side: u32,
    threads: usize,
) -> Pixmap {
    let options = Options::default()
        .size(Size::Long(side))
        .view(Window::default())
        .threads(NonZero::new(threads).unwrap());
    let space = SpaceOptions::default().camera(camera);
    draw(graph, steps, &options, &space, None).unwrap().pixmap
}

/// Returns whether each pixel is paper, in rows.
fn paper(pixmap: &Pixmap) -> Vec<bool> {
    let white = PremultipliedColorU8::from_rgba(255, 255, 255, 255);
    pixmap
        .pixels()
        .iter()
        .map(|pixel| Some(*pixel) == white)
        .collect()
}

/// Returns the share of the picture that is not paper.
fn share(pixmap: &Pixmap) -> f64 {
    let paper = paper(pixmap);
    let ink = paper.iter().filter(|is_paper| !**is_paper).count();
    ink as f64 / paper.len() as f64
}

#[test]
fn a_sponge_along_an_axis_is_the_carpet() {
    for graph in [sponge(), {
        let corners = "[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 0, 1], [0, 1, 1], [1, 1, 1]";
        let edges = "[1/2, 0, 0], [0, 1/2, 0], [0, 0, 1/2], [1/2, 1, 0], [1, 1/2, 0], [1/2, 0, 1], \
                     [1, 0, 1/2], [0, 1/2, 1], [0, 1, 1/2], [1/2, 1, 1], [1, 1/2, 1], [1, 1, 1/2]";
        vertices(&format!("points: [{corners}, {edges}]"), "1/3")
    }] {
        for from in [[0.0, 0.0], [90.0, 0.0], [0.0, 90.0], [180.0, 0.0]] {
            for steps in [None, Some(4), Some(40)] {
                let seen = seen(&graph, steps, from, 81);
                assert_eq!([seen.width(), seen.height()], [81, 81]);
                for (at, is_paper) in paper(&seen).into_iter().enumerate() {
                    let (mut x, mut y) = (at % 81, at / 81);
                    let mut is_hole = false;
                    for _ in 0..4 {
                        is_hole |= x % 3 == 1 && y % 3 == 1;
                        (x, y) = (x / 3, y / 3);
                    }
                    assert_eq!(is_paper, is_hole, "{from:?} {steps:?} {at}");
                }
            }
        }
    }
}

#[test]
fn a_tetrahedron_along_a_two_fold_axis_is_a_square() {
    let graph = vertices("solid: tetrahedron", "1/2");
    for steps in [None, Some(0), Some(1), Some(3), Some(6)] {
        let seen = seen(&graph, steps, [0.0, 0.0], 64);
        assert_eq!(share(&seen), 1.0, "{steps:?}");
        assert_eq!([seen.width(), seen.height()], [64, 64]);
    }
}

#[test]
fn a_cube_from_a_corner_is_a_hexagon() {
    let graph = vertices("solid: cube", "1/2");
    let camera = Camera::default().from(Camera::NAMED[3].1);
    for steps in [None, Some(3)] {
        let seen = seen_by(&graph, steps, camera, 200, 1);
        // The hexagon is as high as a diagonal, and fills three quarters of its box.
        let expected = 200.0 * 3f64.sqrt() / 2.0;
        assert!((f64::from(seen.width()) - expected).abs() < 1.5);
        assert!((share(&seen) - 0.75).abs() < 0.02, "{}", share(&seen));
        let paper = paper(&seen);
        for row in paper.chunks(seen.width() as usize) {
            let changes = row.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert!(changes <= 2);
        }
    }
}

#[test]
fn threads_change_no_byte() {
    let graph = vertices("solid: icosahedron", "1/(1 + phi)");
    let camera = Camera::default();
    let one = seen_by(&graph, None, camera, 200, 1);
    for threads in [2, 5] {
        assert!(seen_by(&graph, None, camera, 200, threads) == one);
    }
}

/// Leaving out hidden instances changes no sample.
#[test]
fn a_descent_agrees_with_drawing_everything() {
    let fern = "{kind: ifs, space: 3, maps: [
        {matrix: [[0, 0, 0], [0, 0.18, 0], [0, 0, 0]], weight: 1},
        {matrix: [[0.85, 0, 0], [0, 0.85, 0.1], [0, -0.1, 0.85]], translate: [0, 1.6, 0], weight: 85},
        {matrix: [[0.2, -0.2, 0], [0.2, 0.2, 0], [0, 0, 0.3]], translate: [0, 0.8, 0], weight: 7},
        {matrix: [[-0.2, 0.2, 0], [0.2, 0.2, 0], [0, 0, 0.3]], translate: [0, 0.8, 0], weight: 7}]}";
    for (graph, steps) in [
        (vertices("solid: octahedron", "1/2"), 4),
        (sponge(), 2),
        (graph_of(fern), 5),
    ] {
        for perspective in [None, Some(50.0)] {
            let camera = Camera::default().perspective(perspective);
            let (end, picture) = (Some(steps), (&camera, 24, 0.0));
            let FirstTile {
                buffer: descended,
                view,
                seen: within,
                ..
            } = FirstTile::draw(&graph, end, picture, Short::Cut);
            let mut all = Buffer::new();
            let mut pencil = solid::Pencil::default();
            for element in Elements::of(&within, &Growth::steps(steps)) {
                let (_, element) = element.unwrap();
                let solid = within.drawn(element.object).unwrap();
                let body = solid::Body::new(solid, element.frame.map());
                let class = lit::Classes::One(0);
                pencil.draw(&mut all, &view, &body, [0, 0, 96, 96], class);
            }
            let (mut ink, mut other) = (0, 0);
            for y in 0..SIDE {
                for (a, b) in descended.row(y).iter().zip(all.row(y)) {
                    ink += usize::from(*b != EMPTY);
                    // Rounding may show at edges.
                    other += usize::from(a.abs_diff(*b) > 4 << buffer::CLASS_BITS);
                    // Stamps leave no gaps.
                    assert!(*a <= *b || *b < EMPTY && *a < EMPTY, "{y}: {a} {b}");
                }
            }
            // Outlines of stamps are exact to a quarter of a sample.
            assert!(ink > 1000 && other * 5 < ink, "{ink} {other}");
        }
    }
}

#[test]
fn the_nearest_is_the_brightest() {
    let graph = vertices("solid: cube", "1/2");
    let front = seen(&graph, Some(0), [0.0, 0.0], 16);
    let ink = PremultipliedColorU8::from_rgba(255, 214, 120, 255).unwrap();
    assert!(front.pixels().iter().all(|pixel| *pixel == ink));
    // From above and aside, the brightness falls from the nearest edge on.
    let aside = seen(&graph, Some(0), [45.0, 0.0], 64);
    let row = &aside.pixels()[..aside.width() as usize];
    let middle = row.len() / 2;
    assert!(row[middle].red() > row[middle / 2].red());
    assert!(row[middle].red() > row[middle + middle / 2].red());
}

#[test]
fn a_perspective_picture_is_fitted_exactly() {
    let graph = vertices("solid: icosahedron", "1/(1 + phi)");
    let camera = Camera::default().perspective(Some(60.0));
    let seen = seen_by(&graph, None, camera, 120, 2);
    let (width, height) = (seen.width() as usize, seen.height() as usize);
    let paper = paper(&seen);
    let column = |x: usize| (0..height).any(|y| !paper[y * width + x]);
    let row = |y: usize| paper[y * width..(y + 1) * width].contains(&false);
    assert!(
        [column(0), column(width - 1), row(0), row(height - 1)]
            .iter()
            .all(|it| *it)
    );
}

#[test]
fn wrong_cameras_and_colours_of_the_plane_are_errors() {
    let graph = sponge();
    let options = Options::default();
    let up = Camera::default().from([0.0, 90.0]).up(Some(DVec3::Y));
    let angle = Camera::default().perspective(Some(170.0));
    for camera in [up, angle] {
        let space = SpaceOptions::default().camera(camera);
        let error = draw(&graph, None, &options, &space, None).unwrap_err();
        assert!(
            matches!(error, RenderError::Space(SpaceError::Camera(_))),
            "{error}"
        );
    }
    let space = SpaceOptions::default();
    let mut by_index = Options::default();
    by_index.style.color_by = ColorBy::Index;
    let error = draw(&graph, None, &by_index, &space, None).unwrap_err();
    assert!(matches!(
        error,
        RenderError::Space(SpaceError::ColorBy(ColorBy::Index))
    ));
    let cancelled = Arc::new(AtomicBool::new(true));
    let error = draw(&graph, None, &options, &space, Some(&cancelled)).unwrap_err();
    assert!(matches!(error, RenderError::Walk(WalkError::Cancelled)));
}

/// The depth of a ball is that of a sphere, and grey levels fall from 65535 at the nearest point to 1 at the farthest.
#[test]
fn a_depth_map_of_a_ball_is_analytic() {
    let graph = graph_of("{kind: instancing, space: 3, objects: {a: [{sphere: {}}]}, scene: [a]}");
    let options = Options::default().size(Size::Long(101));
    let space = SpaceOptions::default().keeps_depths(true);
    let drawn = pixels_in_space(&graph, Some(1), &options, &space, None).unwrap();
    let depths = drawn.depths.unwrap();
    assert_eq!(depths.size(), [101, 101]);
    let mut file = Vec::new();
    depths.write(&mut file).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(
        (info.color_type, info.bit_depth),
        (png::ColorType::Grayscale, png::BitDepth::Sixteen)
    );
    for (at, grey) in (0u32..).zip(bytes.chunks_exact(2)) {
        let grey = f64::from(u16::from_be_bytes([grey[0], grey[1]]));
        let [x, y] = [at % 101, at / 101];
        // The nearest of the samples of a pixel, from the middle of the picture in units of the radius.
        let across = [x, y].map(|at| ((f64::from(at) - 50.0).abs() - 0.375).max(0.125) / 50.5);
        let square = across[0] * across[0] + across[1] * across[1];
        match depths.depth([x, y]) {
            Some(depth) => {
                let expected = (1.0 - (1.0 - square).sqrt()) / 2.0;
                assert!(
                    (depth - expected).abs() < 1e-6,
                    "{x} {y}: {depth} {expected}"
                );
                assert!((grey - (65535.0 - depth * 65534.0)).abs() <= 0.5);
            }
            None => assert!(square > 1.0 - 1e-9 && grey == 0.0, "{x} {y}"),
        }
    }
}

/// Surroundings do not darken a plane from any direction of view; they darken the bottom of a pit.
#[test]
fn a_pit_is_occluded_and_a_plane_is_not() {
    let wall = |from: &str, to: &str| format!("{{box: {{from: {from}, to: {to}}}}}");
    let plate = wall("[-4, -4, -1]", "[4, 4, 0]");
    let walls = [
        wall("[-1, -1, 0]", "[1, -0.3, 0.4]"),
        wall("[-1, 0.3, 0]", "[1, 1, 0.4]"),
        wall("[-1, -1, 0]", "[-0.3, 1, 0.4]"),
        wall("[0.3, -1, 0]", "[1, 1, 0.4]"),
    ];
    let brightness = |scene: &str, camera: Camera| {
        let graph = graph_of(&format!(
            "{{kind: instancing, space: 3, objects: {{a: [{scene}]}}, scene: [a]}}"
        ));
        let options = Options::default().size(Size::Long(200));
        let space = SpaceOptions::default()
            .camera(camera.look_at(Some(DVec3::ZERO)))
            .shade(Some(Shade::None))
            .occlusion(true);
        let seen = draw(&graph, Some(1), &options, &space, None)
            .unwrap()
            .pixmap;
        let middle = (seen.height() / 2 * seen.width() + seen.width() / 2) as usize;
        seen.pixels()[middle].red()
    };
    for camera in [
        Camera::default().from([0.0, 0.0]),
        Camera::default().from([50.0, 20.0]),
        Camera::default().from([0.0, 60.0]).perspective(Some(50.0)),
    ] {
        let seen = brightness(&plate, camera);
        assert!(seen >= 254, "{camera:?}: {seen}");
    }
    let pit = format!("{plate}, {}", walls.join(", "));
    let dark = brightness(&pit, Camera::default().from([0.0, 0.0]));
    assert!((40..180).contains(&dark), "{dark}");
}

/// Beyond the poles the viewer goes on over the top, upside down, and the eye is never within the set.
#[test]
fn cameras_go_over_the_poles() {
    let graph = vertices("solid: cube", "1/2");
    let over = Camera::default().from([20.0, 120.0]);
    let behind = Camera::default().from([200.0, 60.0]);
    let [over, behind] = [over, behind].map(|camera| seen_by(&graph, Some(1), camera, 60, 1));
    assert!(over.pixels().iter().eq(behind.pixels().iter().rev()));
    // Any point that the camera looks at lies in the picture, before the viewer.
    for at in [DVec3::ZERO, DVec3::splat(40.0)] {
        let camera = Camera::default().perspective(Some(150.0)).look_at(Some(at));
        assert!(share(&seen_by(&graph, Some(1), camera, 300, 1)) > 0.0);
    }
}

/// A ball above a plate throws a round shadow on it, away from the light.
#[test]
fn a_ball_throws_a_shadow_on_a_plate() {
    let graph = graph_of(
        "{kind: instancing, space: 3, scene: [a], objects: {a: [
           {box: {from: [-4, -1, -4], to: [4, 0, 4]}}, {sphere: {centre: [0, 3, 0], radius: 1}}]}}",
    );
    let light = Light::default().from([90.0, 45.0]).ambient(0.0);
    let options = Options::default().size(Size::Long(200));
    let drawn = |shade: Shade, threads: usize| {
        let camera = Camera::default()
            .from([0.0, 60.0])
            .look_at(Some(DVec3::ZERO));
        let space = SpaceOptions::default()
            .camera(camera)
            .light(light)
            .shade(Some(shade))
            .shadows(true);
        let options = options.clone().threads(NonZero::new(threads).unwrap());
        draw(&graph, Some(1), &options, &space, None)
            .unwrap()
            .pixmap
    };
    let seen = drawn(Shade::Cosine, 1);
    assert!(seen == drawn(Shade::Cosine, 3));
    let scale = f64::from(seen.width()) / 8.0;
    let rotation = Camera::default().from([0.0, 60.0]).rotation().unwrap();
    let at = |point: DVec3| {
        let view = rotation * point * scale;
        let [x, y] = [
            f64::from(seen.width()) / 2.0 + view.x,
            f64::from(seen.height()) / 2.0 - view.y,
        ];
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the points lie on the picture"
        )]
        let pixel = seen.pixel(x as u32, y as u32).unwrap();
        pixel.red()
    };
    // The light comes from the right: the shadow of the middle is 3 to the left, an ellipse of half axes √2 and 1.
    for (x, z, is_dark) in [
        (-3.0, 0.0, true),
        (-3.8, 0.0, true),
        (-3.0, 0.85, true),
        (-1.75, 0.0, true),
        (-1.4, 0.0, false),
        (-3.0, 1.2, false),
        (-3.9, 0.95, false),
        (2.0, 0.0, false),
        (2.0, 3.0, false),
    ] {
        let red = at(DVec3::new(x, 0.0, z));
        assert_eq!(red < 20, is_dark, "{x} {z}: {red}");
        assert!(is_dark || red > 170, "{x} {z}: {red}");
    }
}
