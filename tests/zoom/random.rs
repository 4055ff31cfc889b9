//! Zooms into structures and systems whose instances are drawn.

use kfrac::geometry::{DAffine2, DVec2};
use kfrac::grow::{Elements, Growth};
use kfrac::zoom::{ZoomOptions, zoom};

use super::{SCALE, SHORTEST, Seen, assert_same, read, window, zoomed};

const TEXTS: [&str; 2] = [
    "kind: ifs
at_random:
  - [{scale: 1/2}, {scale: 1/2, translate: [1/2, 0]}, {scale: 1/2, translate: [0, 1/2]}, {scale: 1/2, translate: [1/2, 1/2]}]
  - weight: 3
    maps:
      - {scale: 1/3}
      - {scale: 1/3, translate: [1/3, 1/3]}
      - {scale: 1/3, translate: [2/3, 0]}
      - {scale: 1/3, translate: [2/3, 2/3]}
      - {scale: 1/3, translate: [0, 2/3]}
initial: {polygon: [[0, 0], [1, 0], [1, 1], [0, 1]]}
",
    "kind: instancing
random: {s: 'uniform(0.4, 0.5)', t: 'uniform(-50, 50)', u: 'choice(1, -1)'}
objects:
  A(n):
    at_random:
      - [{object: A(1 - n), scale: s, rotate: t}, {object: A(n), scale: [s, 0.4], rotate: u*t, translate: [n/2, s]}, {object: A(n), scale: s, translate: [s, 0]}]
      - {weight: 1/2, union: [{object: A(n), scale: s, translate: [0, s/2]}, {object: A(1 - n), scale: s, translate: [t/100, s/2]}]}
    rotate: 10
initial: {segment: [[0, 0], [1, 0]]}
scene: [A(0), {object: A(1), translate: [1, 0]}]
",
];

#[test]
fn shallow_zooms_are_windows_of_the_whole() {
    // Elements of these steps are some times as large as those that end the zoom.
    for (text, steps, factor) in [(TEXTS[0], 5, 1e4), (TEXTS[1], 11, 1e3)] {
        let model = read(text);
        let graph = model.compile(60).unwrap();
        for seed in 0..3 {
            let grown = Elements::of(&graph, &Growth::steps(steps).seed(seed));
            let grown: Vec<_> = grown.map(|element| element.unwrap().1).collect();
            for element in [&grown[0], &grown[grown.len() / 2], &grown[grown.len() - 1]] {
                let point = element.frame.map().translation;
                let at = format!("{},{}", point.x, point.y);
                let near = zoomed(&model, &graph, &window(&format!("{factor}"), &at), seed);
                let larger = DAffine2::from_scale(DVec2::splat(factor * SCALE));
                let place = larger * DAffine2::from_translation(-point);
                let whole = Seen::of(&graph, &Growth::steps(60).seed(seed), place, SHORTEST);
                assert_same(&near, &whole, &DAffine2::IDENTITY, 1e-3, &at);
            }
        }
    }
}

/// A deep zoom shows the middle of one that is less deep.
#[test]
fn deep_zooms_agree() {
    for text in TEXTS {
        let model = read(text);
        let graph = model.compile(60).unwrap();
        for at in ["0.(0)", "0.(1.0)"] {
            let growth = Growth::steps(600).seed(4);
            let [near, far] = ["1e40", "5e40"].map(|factor| {
                let options = ZoomOptions::default().seed(4);
                zoom(&model, &graph, &options, &window(factor, at)).unwrap()
            });
            let larger = DAffine2::from_scale(DVec2::splat(5.0));
            let near = Seen::of(&near.graph, &growth, larger, SHORTEST);
            let far = Seen::of(&far.graph, &growth, DAffine2::IDENTITY, SHORTEST);
            assert_same(&far, &near, &DAffine2::IDENTITY, 1e-3, at);
        }
    }
}
