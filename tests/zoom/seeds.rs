//! Zooms of rules whose elements seed new fractals.

use std::collections::BTreeMap;
use std::convert::Infallible;

use kfrac::geometry::{DAffine2, DVec2, Frame2};
use kfrac::graph::{Graph, Instance, Replacement, Successor};
use kfrac::grow::{Element, Enter, FractalInfo, Subtree, Visitor, walk};
use kfrac::model::Model;
use kfrac::zoom::{ZoomOptions, zoom};

use super::{SCALE, SHORTEST, SIDE, Seen, assert_same, library, read, window, zoomed};

/// A rule of islands that seed islets in every third step, at random, and of open lines that seed open lines,
/// some of them backwards.
pub(super) const ISLANDS: &str = "initiator:\n  closed: true\n  elements: [[0, 0], [1/2, 3/4], [1, 0]]\ngenerators:\n  \
    break:\n    random: {out: 'uniform(-1/5, 1/5)', along: 'uniform(2/5, 3/5)'}\n    \
    elements: [[0, 0], [along, out], [1, 0]]\n  \
    throw:\n    random: {x: 'uniform(0, 1)', y: 'uniform(1/5, 4/5)', wide: 'uniform(1/5, 1/2)'}\n    \
    parts:\n      - elements: [[0, 0], {to: [1/2, wide/3], direction: 4}, [1, 0]]\n      \
      - seeds: true\n        closed: true\n        elements: [[x, y], [x + wide/5, y + wide], [x + wide, y]]\n      \
      - seeds: true\n        elements: [[x, -y], {to: [x + wide, -y], direction: 3}, [x + wide, -y - wide]]\n\
    select: [{when: age % 3 == 1 and i % 2 == 1, use: throw}, {use: break}]\n";

/// A rule in which elements consist of seed parts only, so that nothing is kept.
const VANISHING: &str = "initiator: segment\ngenerators:\n  \
    sow:\n    parts:\n      - seeds: true\n        elements: [[0, 0], [1/3, 1/4], [2/3, 0]]\n      \
      - seeds: true\n        connected: false\n        elements:\n          - {from: [2/3, 0], to: [1, 0], direction: 2}\n          \
          - {from: [1/2, 0], to: [1/2, 1/4], fertile: false}\n  \
    grow: [[0, 0], [1/2, -1/6], [1, 0]]\n\
    select: [{when: age == 2, use: sow}, {use: grow}]\n";

/// A visitor that collects elements in the order of the walk, with the steps of birth of their fractals.
struct Ordered {
    seen: Seen,
    steps: u32,
    born: u32,
    all: Vec<(Element, u32)>,
}

impl Ordered {
    fn of(graph: &Graph, growth: &kfrac::grow::Growth<'_>, place: DAffine2, shortest: f64) -> Self {
        let mut ordered = Self {
            seen: Seen::new(graph, place, shortest).within_likely_reaches(),
            steps: growth.steps,
            born: 0,
            all: Vec::new(),
        };
        walk(graph, growth, &mut ordered).unwrap();
        for (element, _) in &mut ordered.all {
            element.frame = Frame2::from(place).compose(&element.frame);
        }
        // Elements well inside the window.
        let middle = graph.middle();
        ordered
            .all
            .retain(|(element, _)| element.frame.apply(middle).length() < f64::from(SIDE) * 0.4);
        ordered
    }
}

impl Visitor for Ordered {
    type Error = Infallible;

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
        self.born = self.steps - fractal.age;
        Ok(())
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        self.seen.enter(subtree)
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.all.push((*element, self.born));
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}

fn production(graph: &Graph, object: usize) -> &Successor {
    match &graph.objects()[object].replacement {
        Replacement::Fixed(production) => production,
        other => panic!("{other:?}"),
    }
}

/// Returns an instance in an object, or in the parts that it seeds.
fn child(graph: &Graph, object: usize, position: u32) -> &Instance {
    let Successor { body, seeds } = production(graph, object);
    let chains = std::iter::once(body).chain(seeds.iter().map(|seed| &seed.chain));
    let mut instances = chains.flat_map(|chain| &chain.instances);
    instances.find(|it| it.position == position).unwrap()
}

/// Returns the point that a path of positions leads to.
fn point(graph: &Graph, way: &[u32]) -> DVec2 {
    let root = &graph.initiator(0).instances[way[0] as usize];
    let (mut map, mut object) = (*root.frame.map(), root.object);
    for &position in way[1..].iter().cycle().take(60) {
        let child = child(graph, object, position);
        map *= child.frame.map();
        object = child.object;
    }
    map.translation
}

/// Asserts that a zoom shows the elements of the whole in the same order, with their births, lengths,
/// directions and joints, and the births of their fractals.
fn assert_window(rule: &Model, seed: u64, point: DVec2, at: &str, factor: &str) {
    let graph = rule.compile(64).unwrap();
    let growth = ZoomOptions::default().seed(seed);
    let found = zoom(rule, &graph, &growth, &window(factor, at)).unwrap();
    let growth = kfrac::grow::Growth::steps(graph.depth().unwrap_or(200)).seed(seed);
    // Large infertile elements may be clipped.
    let own = graph.objects().len();
    let is_whole = |(element, _): &(Element, u32)| {
        let is_small = element.frame.map().matrix2.x_axis.length() < 100.0;
        element.object < own && (element.fertile || is_small)
    };
    let mut shown = Ordered::of(&found.graph, &growth, DAffine2::IDENTITY, SHORTEST).all;
    shown.retain(is_whole);
    let scale = SCALE * factor.parse::<f64>().unwrap();
    let place = DAffine2::from_scale(DVec2::splat(scale)) * DAffine2::from_translation(-point);
    let mut plain = Ordered::of(&graph, &growth, place, SHORTEST).all;
    plain.retain(is_whole);
    let what = format!("{at} of {seed} at {factor}");
    assert!(plain.len() >= 10, "{what}: {}", plain.len());
    assert_alike(&shown, &plain, 1e-12 * scale + 1e-6, &what);
}

/// Asserts that two lists have the same elements in the same order, within a tolerance in pixels.
fn assert_alike(shown: &[(Element, u32)], plain: &[(Element, u32)], off: f64, what: &str) {
    if shown.len() < plain.len() {
        // Of many elements in one place, one of the oldest fractal is shown.
        assert_eq!(oldest(shown), oldest(plain), "{what}");
        return;
    }
    assert_eq!(shown.len(), plain.len(), "{what}");
    for ((shown, shown_born), (plain, plain_born)) in shown.iter().zip(plain) {
        for corner in [DVec2::ZERO, DVec2::X, DVec2::Y] {
            let [a, b] = [shown, plain].map(|it| it.frame.apply(corner));
            assert!(a.distance(b) <= off, "{what}: {shown:?}, {plain:?}");
        }
        let told = |it: &Element| (it.born, it.frame.direction(), it.fertile, it.joined);
        assert_eq!(told(shown), told(plain), "{what}");
        assert_eq!(shown_born, plain_born, "{what}");
        assert!(
            (shown.length - plain.length).abs() <= 1e-9 * plain.length,
            "{what}"
        );
    }
}

/// Returns a position in sixteenths of a pixel, with an offset such that no coordinate is close to a
/// boundary.
#[expect(clippy::cast_possible_truncation, reason = "a small number")]
fn place(point: DVec2) -> [i64; 2] {
    point.to_array().map(|it| (it * 16.0 + 0.37).floor() as i64)
}

/// Returns the birth of the oldest fractal for each place that an element occupies.
fn oldest(elements: &[(Element, u32)]) -> BTreeMap<[[i64; 2]; 2], u32> {
    let mut oldest = BTreeMap::new();
    for (element, born) in elements {
        let map = element.frame.map();
        let ends = [map.translation, map.transform_point2(DVec2::X)];
        let least = oldest.entry(ends.map(place)).or_insert(*born);
        *least = (*born).min(*least);
    }
    oldest
}

#[test]
fn shallow_zooms_are_windows_of_the_whole() {
    let mandala = library("mandala");
    let square = library("self-seeding-square");
    let adjacent = library("self-seeding-square-adjacent");
    let vanishing = read(VANISHING);
    for (rule, way) in [
        (&square, &[0, 3][..]),
        (&square, &[1, 0, 5]),
        (&square, &[2, 4, 1, 1]),
        (&adjacent, &[0, 4, 2]),
        (&mandala, &[0, 2]),
        (&mandala, &[4, 5, 3, 2]),
        (&vanishing, &[0, 1, 0, 0]),
        (&vanishing, &[0, 0, 1, 2]),
        (&vanishing, &[0, 0, 0, 1, 0, 1, 1]),
    ] {
        let graph = rule.compile(64).unwrap();
        let repeated: Vec<_> = way[1..].iter().map(ToString::to_string).collect();
        let at = format!("{}.({})", way[0], repeated.join("."));
        for factor in ["2e1", "1e6"] {
            assert_window(rule, 0, point(&graph, way), &at, factor);
        }
    }
}

/// Asserts the same for windows about ends of elements of seeded fractals, given by coordinates.
fn assert_windows(rule: &Model, steps: u32, factors: &[&str]) {
    let graph = rule.compile(64).unwrap();
    for seed in 0..3 {
        let growth = kfrac::grow::Growth::steps(steps).seed(seed);
        let grown = Ordered::of(&graph, &growth, DAffine2::IDENTITY, 0.0).all;
        let mut later: Vec<_> = grown.iter().filter(|(_, born)| *born >= 2).collect();
        assert!(later.len() > 40, "{}", later.len());
        later.sort_by_key(|(_, born)| *born);
        for (element, _) in [later[0], later[later.len() / 2], later[later.len() - 1]] {
            let point = element.frame.origin();
            let at = format!("{},{}", point.x, point.y);
            for factor in factors {
                assert_window(rule, seed, point, &at, factor);
            }
        }
    }
}

#[test]
fn shallow_zooms_of_random_rules_are_windows_of_the_whole() {
    assert_windows(&read(ISLANDS), 7, &["2e1", "1e5"]);
}

/// Coasts of the library are drawn without bounds on their random numbers, but do not reach far.
#[test]
fn what_is_improbable_is_not_looked_for() {
    assert_windows(&library("archipelago"), 5, &["2e1", "1e3"]);
}

/// A deep zoom of a random rule shows the middle of one that is less deep: draws, ages and order do not
/// depend on where a zoom begins.
#[test]
fn deep_zooms_of_random_rules_agree() {
    let islands = read(ISLANDS);
    let graph = islands.compile(512).unwrap();
    // On a coast, on islets of islets, and on lines that are seeded by islets.
    for at in ["0.(0.1)", "0.(0.3)", "0.(0.5.1.2.1.5)", "1.(0.3.0.6)"] {
        for seed in [0, 7] {
            let [near, far] = ["1e40", "5e40"].map(|factor| {
                let growth = ZoomOptions::default().seed(seed);
                zoom(&islands, &graph, &growth, &window(factor, at)).unwrap()
            });
            let growth = kfrac::grow::Growth::steps(512).seed(seed);
            let larger = DAffine2::from_scale(DVec2::splat(5.0));
            let near = Ordered::of(&near.graph, &growth, larger, SHORTEST).all;
            let far = Ordered::of(&far.graph, &growth, DAffine2::IDENTITY, SHORTEST).all;
            let what = format!("{at} of {seed}");
            assert!(far.len() >= 10, "{what}: {}", far.len());
            assert!(far.iter().any(|(_, born)| *born > 100), "{what}");
            assert_eq!(far.len(), near.len(), "{what}");
            assert_alike(&far, &near, 1e-6, &what);
        }
    }
}

/// The point in the middle is the fixed point of a seeded child: zooms by its ratio to the power k show the
/// same for any k, rotated with it.
#[test]
fn fixed_points_of_seeds_look_the_same_at_any_depth() {
    for (name, rule, seed) in [
        ("square", library("self-seeding-square"), 3),
        ("square", library("self-seeding-square"), 5),
        ("adjacent", library("self-seeding-square-adjacent"), 4),
    ] {
        let graph = rule.compile(64).unwrap();
        let root = graph.initiator(0).instances[0].object;
        let linear = child(&graph, root, seed).frame.map().matrix2;
        let turn = DAffine2::from_mat2(linear * (1.0 / linear.determinant().abs().sqrt()));
        let at = format!("0.({seed})");
        let shallow = zoomed(&rule, &graph, &window("3^4", &at), 0);
        for more in [1, 200] {
            let factor = format!("3^{}", 4 + more);
            let deep = zoomed(&rule, &graph, &window(&factor, &at), 0);
            // Rotations are by right angles.
            let turned = (0..more % 4).fold(DAffine2::IDENTITY, |turned, _| turn * turned);
            let what = format!("{name} at {factor}");
            assert_same(&shallow, &deep, &turned, 1e-6, &what);
        }
    }
}

/// A side of a square times 3^70, and the step of birth of its fractal.
#[derive(Clone, Copy)]
struct Side {
    from: [i128; 2],
    to: [i128; 2],
    born: u32,
}

impl Side {
    /// Returns the sides that replace this one in a step of the self-seeding square, and those of the square
    /// that it seeds.
    fn children(self, step: u32) -> [Self; 7] {
        let Self { from, to, born } = self;
        let [x, y] = [0, 1].map(|axis| (to[axis] - from[axis]) / 3);
        // Coordinates in thirds along the side and to its left.
        let at =
            |along: i128, up: i128| [from[0] + along * x - up * y, from[1] + along * y + up * x];
        let side = |[from, to]: [[i128; 2]; 2], born| Self {
            from: at(from[0], from[1]),
            to: at(to[0], to[1]),
            born,
        };
        let square = [[1, 1], [1, 2], [2, 2], [2, 1]];
        let sides = [0, 1, 2, 3].map(|it| side([square[it], square[(it + 1) % 4]], step + 1));
        let stay = [0, 1, 2].map(|it| side([[it, 0], [it + 1, 0]], born));
        [
            stay[0], stay[1], stay[2], sides[0], sides[1], sides[2], sides[3],
        ]
    }
}

/// Sides of step 70 have the positions that integer arithmetic gives, and belong to squares of the right age.
#[test]
fn sides_of_step_70_stand_where_whole_numbers_say() {
    const STEPS: u32 = 70;
    let rule = library("self-seeding-square");
    let graph = rule.compile(STEPS).unwrap();
    let whole = 3_i128.pow(STEPS);
    let corners = [[0, 0], [0, whole], [whole, whole], [whole, 0]];
    let square = [0, 1, 2, 3].map(|it| Side {
        from: corners[it],
        to: corners[(it + 1) % 4],
        born: 0,
    });
    for repeated in [vec![3, 5], vec![0, 6, 1], vec![4]] {
        let way: Vec<usize> = repeated.iter().copied().cycle().take(130).collect();
        let (mut on_way, mut near) = (square[0], square.to_vec());
        for (step, &position) in (0..STEPS).zip(&way) {
            on_way = on_way.children(step)[position];
            let length = (whole / 3_i128.pow(step + 1)) as f64;
            let mut places = BTreeMap::new();
            for side in near.iter().flat_map(|side| side.children(step)) {
                let away = [0, 1].map(|axis| (side.from[axis] - on_way.from[axis]) as f64);
                if away[0].hypot(away[1]) < 14.0 * length {
                    let born = places.entry((side.from, side.to)).or_insert(side.born);
                    *born = side.born.min(*born);
                }
            }
            let sides = places.into_iter();
            near = sides
                .map(|((from, to), born)| Side { from, to, born })
                .collect();
        }
        // The path continues in numbers within the range of doubles: sides of step 70 are 19 pixels long.
        let pixel = SCALE / 27.0;
        let mut map = DAffine2::from_scale(DVec2::splat(pixel));
        let along = [0, 1].map(|axis| (on_way.to[axis] - on_way.from[axis]) as f64);
        map *= DAffine2::from_mat2(kfrac::geometry::DMat2::from_cols_array(&[
            along[0], along[1], -along[1], along[0],
        ]));
        let root = graph.initiator(0).instances[0].object;
        for &position in &way[STEPS as usize..] {
            map *= child(&graph, root, u32::try_from(position).unwrap())
                .frame
                .map();
        }
        let limit = map.translation;
        let ways: Vec<String> = repeated.iter().map(ToString::to_string).collect();
        let at = format!("0.({})", ways.join("."));
        let window = window("3^67", &at);
        let growth = ZoomOptions::default().steps(Some(STEPS));
        let found = zoom(&rule, &graph, &growth, &window).unwrap();
        let growth = kfrac::grow::Growth::steps(STEPS);
        let shown = Ordered::of(&found.graph, &growth, DAffine2::IDENTITY, 0.0).all;
        let shown = oldest(&shown);
        assert!(shown.len() > 40, "{}", shown.len());
        let known: BTreeMap<_, _> = near
            .iter()
            .map(|side| {
                let ends = [side.from, side.to].map(|end| {
                    let [x, y] = [0, 1].map(|axis| (end[axis] - on_way.from[axis]) as f64);
                    place(DVec2::new(x, y) * pixel - limit)
                });
                (ends, side.born)
            })
            .collect();
        for (place, born) in &shown {
            assert_eq!(known.get(place), Some(born), "{at}: {place:?}");
        }
    }
}
