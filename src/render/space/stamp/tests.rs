//! Tests of large stamps, with light and tints.

use std::num::NonZero;

use tiny_skia::Pixmap;

use super::super::tests::graph_of;
use super::super::{SpaceOptions, draw};
use crate::geometry::DVec3;
use crate::render::{Options, Size};
use crate::style::{Camera, ColorBy, Colour, Shade};

/// Draws 324 pairs of a ball and a rod with tints, each of whose sizes is larger by `more`, so that they have no common form
/// where that is not 0.
fn pairs(color_by: ColorBy, shade: Shade, more: f64) -> Pixmap {
    let mut text = "kind: instancing
space: 3
objects:
  pair:
    - {sphere: {}, tint: {color: red, alpha: 1/2}}
    - {cylinder: {}, scale: [0.4, 2, 0.4], rotate: {x: 40}, tint: {color: blue, alpha: 1/2}}
    - {box: {}, translate: [0.6, -1.2, 0.3], rotate: [{x: 20}, {y: 30}]}
scene:
"
    .to_owned();
    for at in 0..324 {
        let (x, y, size) = (at % 18 * 3, at / 18 * 3, 1.0 + more * f64::from(at));
        let tint = ["tint: {color: lime, alpha: 1/4}, ", ""][at as usize % 2];
        text.push_str(&format!(
            "  - {{object: pair, {tint}scale: {size}, translate: [{x}, {y}, 0]}}\n"
        ));
    }
    let mut options = Options::default().size(Size::Long(720));
    options.style.color_by = color_by;
    let space = SpaceOptions::default()
        .camera(Camera::default().from([20.0, 30.0]))
        .shade(Some(shade));
    draw(&graph_of(&text), Some(1), &options, &space, None)
        .unwrap()
        .pixmap
}

#[test]
fn copies_are_like_what_they_are_copies_of() {
    for (color_by, shade) in [
        (ColorBy::Tint, Shade::Cosine),
        (ColorBy::Tint, Shade::Depth),
        (ColorBy::None, Shade::Cosine),
    ] {
        let [copied, drawn] = [0.0, 1e-6].map(|more| pairs(color_by, shade, more));
        assert_eq!(
            [copied.width(), copied.height()],
            [drawn.width(), drawn.height()]
        );
        let mut differ = 0;
        for (a, b) in copied.pixels().iter().zip(drawn.pixels()) {
            let parts = [
                (a.red(), b.red()),
                (a.green(), b.green()),
                (a.blue(), b.blue()),
            ];
            let most = parts.map(|(a, b)| a.abs_diff(b)).into_iter().max();
            differ += usize::from(most > Some(48));
        }
        // Outlines are larger by an eighth of a sample, and four samples are a pixel.
        assert!(
            differ > 0 && differ * 100 < copied.pixels().len(),
            "{color_by:?} {shade:?}: {differ}"
        );
    }
}

/// All depths of a flat set that is seen from the front are equal but for rounding.
#[test]
fn flat_sets_are_as_bright_as_near_ones() {
    for [turn, rise] in [
        [-46.0, 65.0],
        [0.0, 0.0],
        [44.2, 41.1],
        [-169.6, -5.8],
        [144.3, -65.8],
    ] {
        let camera = Camera::default().from([turn, rise]);
        let across = camera.rotation().unwrap().transpose();
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.3, 0.8]];
        let corners = corners.map(|[x, y]| (across * DVec3::new(x, y, 0.0)).to_array());
        let text = format!(
            "{{kind: ifs, space: 3, vertices: {{points: {corners:?}, shrink: 1/2}}, style: {{fill: white}}}}"
        );
        let mut options = Options::default().size(Size::Long(200));
        options.style.fill = Some(Colour::grey(255));
        options.style.background = Some(Colour::BLACK);
        let space = SpaceOptions::default().camera(camera);
        let seen = draw(&graph_of(&text), None, &options, &space, None).unwrap();
        // No pixel is covered as a whole.
        let brightest = seen.pixmap.pixels().iter().map(|pixel| pixel.red()).max();
        assert!(brightest > Some(150), "{turn} {rise}: {brightest:?}");
    }
}

/// A ball has more colours by its normals under a light than a tile has classes.
#[test]
fn normals_of_balls_have_colours_of_their_own() {
    let balls = "{kind: instancing, space: 3, objects: {a: [{sphere: {}}]}, scene: [a, {object: a, translate: [2, 1, 0]}]}";
    let graph = graph_of(balls);
    let seen = [1, 2, 3].map(|threads| {
        let mut options = Options::default()
            .size(Size::Long(400))
            .threads(NonZero::new(threads).unwrap());
        options.style.color_by = ColorBy::Normal;
        let space = SpaceOptions::default().shade(Some(Shade::Cosine));
        draw(&graph, Some(1), &options, &space, None)
            .unwrap()
            .pixmap
    });
    assert!(seen[0] == seen[1] && seen[0] == seen[2]);
}
