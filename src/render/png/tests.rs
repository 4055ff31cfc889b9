#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use crate::render::Labels;
use crate::render::surface::{Paint, Pen, Position, Stroke, Surface};
use crate::style::{Cap, Colour, Join};

use super::Png;

const SIZE: [u32; 2] = [80, 60];

fn stroke(width: f64) -> Paint {
    let pen = Pen {
        width,
        cap: Cap::Round,
        join: Join::Round,
        dash: 0.0,
    };
    Paint {
        stroke: Some(Stroke {
            colour: Colour::BLACK,
            pen,
        }),
        fill: None,
    }
}

/// Paths of all the ways in which something is drawn: hairs, round pens, small polygons, and what
/// is left to others.
fn paths() -> Vec<(Paint, Vec<Position>)> {
    let fill = Paint {
        fill: Some(Colour::BLACK),
        stroke: None,
    };
    let paints = [0.02, 0.2, 0.9, 2.5, 4.0].map(stroke);
    let paints = paints.iter().chain([&fill]).cycle();
    let place = |number: i64| [number * 7919 % 8000, number * 104_729 % 6000];
    let small = |number: i64| {
        let [x, y] = place(number);
        vec![[x, y], [x + 300, y + 40], [x + 90, y + 260]]
    };
    let large = |number: i64| (number..number + 3).map(place).collect();
    let all = (0..120).map(|number| {
        if number % 5 == 0 {
            large(number)
        } else {
            small(number)
        }
    });
    paints.copied().zip(all).collect()
}

fn draw(png: &mut Png, paths: &[(Paint, Vec<Position>)]) {
    for (paint, vertices) in paths {
        Surface::begin(png, paint).unwrap();
        png.move_to(vertices[0]);
        png.lines_to(&vertices[1..]);
        if paint.fill.is_some() {
            png.close();
        }
        png.end().unwrap();
    }
}

fn bytes(png: Png) -> Vec<u8> {
    let mut bytes = Vec::new();
    png.write(&Labels::default(), &mut bytes).unwrap();
    bytes
}

#[test]
fn what_forks_draw_is_the_same_picture() {
    let paths = paths();
    let begin = || Png::begin(SIZE, None).unwrap();
    let mut whole = begin();
    draw(&mut whole, &paths);
    let whole = bytes(whole);
    for count in [1, 2, 3, 7] {
        let mut joined = begin();
        let parts = paths.chunks(paths.len().div_ceil(count));
        let forks = parts.map(|part| {
            let mut fork = joined.fork().unwrap();
            draw(&mut fork, part);
            fork
        });
        let forks: Vec<Png> = forks.collect();
        for fork in forks {
            joined.join(fork, Colour::BLACK);
        }
        assert!(bytes(joined) == whole, "{count} forks");
    }
}

/// What has been covered before in another colour stays below.
#[test]
fn forks_come_on_top() {
    let fill = |colour| Paint {
        fill: Some(colour),
        stroke: None,
    };
    let below = (
        fill(Colour::of_rgba([200, 90, 0, 255])),
        vec![[100, 100], [700, 100], [100, 700]],
    );
    let above = (fill(Colour::BLACK), vec![[0, 0], [3000, 200], [200, 3000]]);
    let begin = || Png::begin(SIZE, None).unwrap();
    let (mut whole, mut joined) = (begin(), begin());
    draw(&mut whole, &[below.clone(), above.clone()]);
    draw(&mut joined, &[below]);
    let mut fork = joined.fork().unwrap();
    draw(&mut fork, &[above]);
    joined.join(fork, Colour::BLACK);
    assert!(bytes(whole) == bytes(joined));
}

#[test]
fn where_all_is_coverage_forks_have_no_order() {
    let mut paths = paths();
    paths.retain(|(paint, _)| paint.stroke.is_some_and(|stroke| stroke.pen.width < 3.0));
    let drawn = |order: [usize; 2]| {
        let mut png = Png::begin(SIZE, None).unwrap();
        draw(&mut png, &[(stroke(1.0), vec![[100, 100], [5000, 4000]])]);
        let halves: Vec<_> = paths.chunks(paths.len().div_ceil(2)).collect();
        for half in order {
            let mut fork = png.fork().unwrap();
            draw(&mut fork, halves[half]);
            png.join(fork, Colour::BLACK);
        }
        bytes(png)
    };
    assert!(drawn([0, 1]) == drawn([1, 0]));
}
