//! The dragon's points at step 200 are integers in a suitable unit: exact arithmetic gives their positions.

use kfrac::geometry::DAffine2;
use kfrac::grow::Growth;
use kfrac::zoom::{ZoomOptions as ZoomGrowth, zoom};

use super::{SCALE, Seen, library, window};

/// A point times 2^100.
type Point = [i128; 2];

/// An element: from one point to another, replaced on its left or on its right.
#[derive(Clone, Copy)]
struct Element {
    from: Point,
    to: Point,
    left: bool,
}

impl Element {
    /// Returns the two elements of the next step, as the rule lists them; both run to the corner or from it.
    fn children(self) -> [Self; 2] {
        let [x, y] = [self.to[0] - self.from[0], self.to[1] - self.from[1]];
        let [across, up] = if self.left { [-y, x] } else { [y, -x] };
        let corner = [self.from[0] + (x + across) / 2, self.from[1] + (y + up) / 2];
        [
            Self {
                to: corner,
                left: true,
                ..self
            },
            Self {
                from: corner,
                left: false,
                ..self
            },
        ]
    }

    /// Returns the distance between the starts of two elements.
    fn away(self, other: Self) -> f64 {
        let [x, y] = [0, 1].map(|axis| (self.from[axis] - other.from[axis]) as f64);
        x.hypot(y)
    }
}

#[test]
fn elements_of_step_200_stand_where_whole_numbers_say() {
    const STEPS: u32 = 200;
    let rule = library("dragon");
    let graph = rule.compile(STEPS).unwrap();
    let whole = Element {
        from: [0, 0],
        to: [1 << 100, 0],
        left: is_left(&graph),
    };
    for repeated in [vec![0, 1], vec![1], vec![0, 0, 1]] {
        let way: Vec<usize> = repeated
            .iter()
            .copied()
            .cycle()
            .take(STEPS as usize)
            .collect();
        // Along the path, and beside it the elements that may be near its end.
        let (mut on_way, mut near) = (whole, vec![whole]);
        for (step, &position) in way.iter().enumerate() {
            on_way = on_way.children()[position];
            let length = (2.0_f64).powf(100.0 - (step as f64 + 1.0) / 2.0);
            near = near.into_iter().flat_map(Element::children).collect();
            near.retain(|element| element.away(on_way) < 14.0 * length);
        }
        let ways: Vec<String> = repeated.iter().map(ToString::to_string).collect();
        let at = format!("0.({})", ways.join("."));
        // At a zoom of 2^96, elements of step 200 are 32 pixels long.
        let window = window("2^96", &at);
        let growth = ZoomGrowth::default().steps(Some(STEPS));
        let found = zoom(&rule, &graph, &growth, &window).unwrap();
        let seen = Seen::of(&found.graph, &Growth::steps(STEPS), DAffine2::IDENTITY, 0.0);
        let pixel = SCALE * (2.0_f64).powi(-4);
        // The limit point lies within the element; all other positions are relative to it.
        let ends = |from: Point, to: Point, origin: Point| {
            [from, to].map(|point| [0, 1].map(|axis| ((point[axis] - origin[axis]) as f64) * pixel))
        };
        let shown: Vec<[[f64; 2]; 2]> = seen
            .elements
            .iter()
            .filter(|element| element.frame.origin().length() < 150.0)
            .map(|element| {
                let map = element.frame.map();
                [map.translation, map.translation + map.matrix2.x_axis].map(|it| [it.x, it.y])
            })
            .collect();
        assert!(shown.len() > 20, "{}", shown.len());
        assert!(seen.elements.iter().all(|element| element.born == STEPS));
        let limit = limit(&repeated, on_way, pixel);
        for [from, to] in &shown {
            let stands = near.iter().any(|element| {
                let known = ends(element.from, element.to, on_way.from);
                let is = |a: &[f64; 2], b: [f64; 2]| {
                    (a[0] - (b[0] - limit[0])).abs() < 1e-6
                        && (a[1] - (b[1] - limit[1])).abs() < 1e-6
                };
                is(from, known[0]) && is(to, known[1]) || is(from, known[1]) && is(to, known[0])
            });
            assert!(stands, "{at}: {from:?} to {to:?}");
        }
    }
}

/// Returns the end of the path relative to the start of an element, in pixels: the path continues as it
/// began.
fn limit(repeated: &[usize], element: Element, pixel: f64) -> [f64; 2] {
    let mut point = [0.0; 2];
    let mut along = [0, 1].map(|axis| (element.to[axis] - element.from[axis]) as f64 * pixel);
    let mut left = element.left;
    // The path continues after a whole number of periods, or where it stopped.
    let start = 200 % repeated.len();
    for &position in repeated.iter().cycle().skip(start).take(120) {
        let [x, y] = along;
        let [across, up] = if left { [-y, x] } else { [y, -x] };
        let half = [(x + across) / 2.0, (y + up) / 2.0];
        if position == 0 {
            along = half;
        } else {
            point = [point[0] + half[0], point[1] + half[1]];
            along = [x - half[0], y - half[1]];
        }
        left = position == 0;
    }
    point
}

/// Returns whether the first element is replaced on its left.
fn is_left(graph: &kfrac::graph::Graph) -> bool {
    let root = graph.initiator(0).instances[0].object;
    super::production(graph, root).body.instances[0]
        .frame
        .map()
        .matrix2
        .x_axis
        .y
        > 0.0
}
