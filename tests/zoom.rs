//! Unlimited zooms: windows agree with exact arithmetic, at any depth.

mod command_line;
mod lattice;
mod pictures;
mod random;
mod seeds;

use std::collections::HashMap;
use std::convert::Infallible;

use crate::common::{self, document, document_of};
use kfrac::Path;
use kfrac::document::Document;
use kfrac::extent::NoLimit;
use kfrac::geometry::{DAffine2, DVec2, Frame2};
use kfrac::graph::{Graph, Replacement, Successor};
use kfrac::grow::{Element, Enter, FractalInfo, Subtree, Visitor, walk};
use kfrac::model::Model;
use kfrac::rule::{ElementContext, Rule};
use kfrac::zoom::{ZoomError, ZoomOptions, ZoomWindow, zoom};

/// Side of the picture, in pixels.
const SIDE: u32 = 512;
/// Length of the unit frame at a zoom of 1, in pixels.
const SCALE: f64 = 512.0;

fn library(name: &str) -> Model {
    model(&document(name))
}

fn read(text: &str) -> Model {
    model(&document_of(text))
}

fn model(document: &Document) -> Model {
    document.resolve(&[]).unwrap().0
}

fn window(factor: &str, at: &str) -> ZoomWindow {
    ZoomWindow {
        size: [SIDE, SIDE],
        scale: SCALE,
        margin: 2.0,
        relative_stroke: 0.0,
        areas: false,
        shortest: SHORTEST,
        factor: factor.parse().unwrap(),
        at: at.parse().unwrap(),
    }
}

/// A visitor that collects elements down to a length that may reach into a square about the middle.
struct Seen {
    half: f64,
    shortest: f64,
    /// Map from the walk's units to pixels about the middle.
    place: DAffine2,
    reaches: Vec<f64>,
    middle: DVec2,
    elements: Vec<Element>,
}

impl Seen {
    fn new(graph: &Graph, place: DAffine2, shortest: f64) -> Self {
        Self {
            half: f64::from(SIDE) / 2.0,
            shortest,
            place,
            reaches: graph.reaches(|_| 2.0),
            middle: graph.middle(),
            elements: Vec::new(),
        }
    }

    fn of(graph: &Graph, growth: &kfrac::grow::Growth<'_>, place: DAffine2, shortest: f64) -> Self {
        let mut seen = Self::new(graph, place, shortest);
        walk(graph, growth, &mut seen).unwrap();
        for element in &mut seen.elements {
            element.frame = Frame2::from(place).compose(&element.frame);
        }
        seen
    }

    /// Limits reaches that are unknown and assumed to be large.
    fn within_likely_reaches(mut self) -> Self {
        for reach in &mut self.reaches {
            *reach = reach.min(100.0);
        }
        self
    }

    fn stretch(&self, map: &DAffine2) -> f64 {
        let map = self.place.matrix2 * map.matrix2;
        map.x_axis.length().max(map.y_axis.length())
    }
}

impl Visitor for Seen {
    type Error = Infallible;

    fn begin(&mut self, _: FractalInfo) -> Result<(), Infallible> {
        Ok(())
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        let middle = subtree.frame.apply(self.middle);
        let middle = self.place.transform_point2(middle).abs().max_element();
        let length = self.stretch(subtree.frame.map());
        if middle > self.half + 2.0 * self.reaches[subtree.object] * length {
            Enter::Skip
        } else if length < self.shortest {
            Enter::Keep
        } else {
            Enter::Replace
        }
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.elements.push(*element);
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}

/// Returns the elements in the window, in pixels from its middle.
fn zoomed(of: &Model, graph: &Graph, window: &ZoomWindow, seed: u64) -> Seen {
    let growth = ZoomOptions::default().seed(seed);
    let found = zoom(of, graph, &growth, window).unwrap();
    let growth =
        kfrac::grow::Growth::steps(graph.depth().unwrap_or(found.deepest + 200)).seed(seed);
    Seen::of(&found.graph, &growth, DAffine2::IDENTITY, SHORTEST)
}

/// The square root of 2, with more digits than its powers below need.
const ROOT: &str = "1.4142135623730950488016887242096980785696718753769480731766797379907";

/// Length in pixels below which elements are not replaced.
const SHORTEST: f64 = 5.17;

/// Elements by the pixel that they start in.
struct Places(HashMap<[i64; 2], Vec<DAffine2>>);

impl Places {
    fn of(elements: &[Element]) -> Self {
        let mut places: HashMap<_, Vec<_>> = HashMap::new();
        for element in elements {
            let map = *element.frame.map();
            places.entry(cell(map.translation)).or_default().push(map);
        }
        Self(places)
    }

    /// Returns whether an element has this map, within a tolerance in pixels.
    fn hold(&self, map: &DAffine2, off: f64) -> bool {
        let [x, y] = cell(map.translation);
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let mut others = around.filter_map(|cell| self.0.get(&cell)).flatten();
        others.any(|other| {
            let corners = [DVec2::ZERO, DVec2::X, DVec2::Y];
            corners.iter().all(|corner| {
                let apart = map.transform_point2(*corner) - other.transform_point2(*corner);
                apart.abs().max_element() <= off
            })
        })
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn cell(point: DVec2) -> [i64; 2] {
    [point.x, point.y].map(|it| it.floor() as i64)
}

/// Asserts that all elements well inside one window are in another, rotated one, and conversely.
fn assert_same(a: &Seen, b: &Seen, turn: &DAffine2, off: f64, what: &str) {
    let near = |element: &&Element| {
        let middle = element.frame.apply(a.middle);
        middle.length() < f64::from(SIDE) * 0.4
    };
    let back = turn.inverse();
    let mut count = 0;
    for (from, to, turn) in [(a, b, turn), (b, a, &back)] {
        let places = Places::of(&to.elements);
        for element in from.elements.iter().filter(near) {
            count += 1;
            let map = *turn * element.frame.map();
            assert!(places.hold(&map, off), "{what}: {element:?}");
        }
    }
    assert!(count >= 20, "{what}: {count}");
}

fn production(graph: &Graph, object: usize) -> &Successor {
    match &graph.objects()[object].replacement {
        Replacement::Fixed(production) => production,
        other => panic!("{other:?}"),
    }
}

/// The point in the middle is the fixed point of a child, away from the rest: zooms by the child's ratio to
/// the power k show the same for any k, rotated and mirrored with it.
#[test]
fn fixed_points_look_the_same_at_any_depth() {
    let fern = "kind: ifs\nmaps:\n  - {scale: 4/5, rotate: 12, fixed: [1/3, 1/7]}\n  \
                - {scale: 3/10, rotate: 70, shift: [2, 1]}\n  \
                - {scale: [3/10, -3/10], rotate: -50, shift: [2, -1]}\ninitial: {polyline: [[0, 0], [1, 1/9]]}\n";
    let mirrored = "initiator: segment\ngenerator:\n  - [0, 0]\n  - {to: [1/3, 0], direction: 2}\n  \
                    - [1/2, sqrt(3)/6]\n  - [2/3, 0]\n  - {to: [1, 0], direction: 4}\n";
    let trunks = "initiator: segment\ngenerator:\n  - [0, 0]\n  - {to: [0, 1], fertile: false}\n  \
                  - [1/3, 1]\n  - {to: [2/3, 1], fertile: false}\n  - [1, 1]\n  \
                  - {to: [1, 0], fertile: false}\n";
    // The rule, the child, its ratio as written, and the first power, for which the window is small enough.
    let cases = [
        ("koch", library("koch"), 0, "3", 3),
        ("dragon", library("dragon"), 0, ROOT, 9),
        ("trunks", read(trunks), 1, "3", 3),
        ("fern", read(fern), 0, "1.25", 21),
        ("koch-lsystem", library("koch-lsystem"), 0, "3", 3),
        ("dragon-lsystem", library("dragon-lsystem"), 0, ROOT, 9),
        ("mirrored", read(mirrored), 0, "3", 3),
    ];
    for (name, rule, child, ratio, first) in cases {
        let graph = rule.compile(64).unwrap();
        let root = &graph.initiator(0).instances[0];
        let production = production(&graph, root.object);
        let linear = production.body.instances[child].frame.map().matrix2;
        let child = production.body.instances[child].position;
        let turn = DAffine2::from_mat2(linear * (1.0 / linear.determinant().abs().sqrt()));
        let at = format!("0.({child})");
        let shallow = zoomed(&rule, &graph, &window(&format!("{ratio}^{first}"), &at), 0);
        for more in [1, 1999, 2000] {
            let factor = format!("{ratio}^{}", first + more);
            let deep = zoomed(&rule, &graph, &window(&factor, &at), 0);
            // Rounding errors of repeated rotations would accumulate.
            let mut turned = DAffine2::IDENTITY;
            for _ in 0..more {
                turned = turn * turned;
                let x = turned.matrix2.x_axis.normalize();
                let sign = turned.matrix2.determinant().signum();
                turned.matrix2.x_axis = x;
                turned.matrix2.y_axis = x.perp() * sign;
            }
            assert_same(
                &shallow,
                &deep,
                &turned,
                1e-6,
                &format!("{name} at {factor}"),
            );
        }
    }
}

/// Returns the point that a path of positions leads to, in doubles.
fn point(graph: &Graph, positions: &[usize]) -> DVec2 {
    let root = &graph.initiator(0).instances[positions[0]];
    let (mut map, mut object) = (*root.frame.map(), root.object);
    for &position in positions[1..].iter().cycle().take(190) {
        let instances = &production(graph, object).body.instances;
        let child = instances.iter().find(|it| it.position as usize == position);
        let child = child.unwrap();
        map *= child.frame.map();
        object = child.object;
    }
    map.translation
}

/// A rule with different points at every age, and different generators.
const AGES: &str = "initiator: segment\ngenerators:\n  \
                    a: [[0, 0], ['if(age % 3 == 0, 1/3, 1/4)', 1/(4 + age)], [1, 0]]\n  \
                    b: [[0, 0], [1/2, 'if(odd(step), -1/5, -1/6)'], {to: [1, 0], direction: 2}]\n\
                    select: [{when: step % 4 == 2, use: b}, {use: a}]\n";

/// A rule with different points for every third element.
const PLACES: &str = "initiator: segment\ngenerator:\n  \
                      [[0, 0], ['if(i % 3 == 1, 1/3, 1/5)', '1/(3 + i % 3)'], {to: [3/5, '(i % 3)/7'], direction: 3}, [1, 0]]\n";

/// A structure in which one set, a fractal, stands for several instances, before those of an object.
const SETS: &str = "kind: instancing\nobjects:\n  A:\n    \
                    - {fractal: cantor, steps: 2, map: {scale: 1/9, shift: [1/3, 1/5]}}\n    \
                    - {object: A, scale: 1/3}\n    \
                    - {object: A, scale: 1/3, rotate: 20, translate: [2/3, 0]}\nscene: [A]\n";

/// A zoom within the range of doubles shows the elements that plain growing shows there, with births, lengths
/// and directions.
#[test]
fn shallow_zooms_are_windows_of_the_whole() {
    for (name, way) in [
        ("koch", vec![0, 1, 3]),
        ("dragon", vec![0, 0, 1]),
        ("levy", vec![0, 0, 1]),
        ("gosper", vec![0, 2, 5]),
        ("monkeys-tree", vec![0, 3, 5]),
        ("hilbert", vec![0, 0, 2]),
        ("pythagoras-345", vec![0, 1, 1]),
        ("terdragon", vec![0, 0, 1, 1]),
        ("barnsley-fern", vec![0, 0, 1]),
        ("gasket", vec![0, 0, 1, 2]),
        ("koch-ifs", vec![0, 1, 2]),
        ("gosper-lsystem", vec![0, 5]),
        ("koch-lsystem", vec![0, 1, 2]),
        ("koch-island", vec![2, 1]),
        ("blancmange", vec![0, 0, 1]),
        ("gasket-recursive", vec![0, 0, 1]),
        ("ages", vec![0, 1, 0]),
        ("places", vec![0, 1, 0, 2]),
        ("sets", vec![0, 4, 5]),
    ] {
        let rule = match name {
            "ages" => read(AGES),
            "places" => read(PLACES),
            "sets" => read(SETS),
            _ => library(name),
        };
        let graph = rule.compile(200).unwrap();
        let p = point(&graph, &way);
        let repeated: Vec<_> = way[1..].iter().map(ToString::to_string).collect();
        let at = format!("{}.({})", way[0], repeated.join("."));
        for factor in ["2e1", "1e4", "1e8"] {
            let zoomed = zoomed(&rule, &graph, &window(factor, &at), 0);
            let scale = SCALE * factor.parse::<f64>().unwrap();
            let place = DAffine2::from_scale(DVec2::splat(scale)) * DAffine2::from_translation(-p);
            let growth = kfrac::grow::Growth::steps(graph.depth().unwrap_or(1_000));
            let plain = Seen::of(&graph, &growth, place, SHORTEST);
            let what = format!("{name} at {factor}");
            assert_same(
                &zoomed,
                &plain,
                &DAffine2::IDENTITY,
                1e-13 * scale + 1e-6,
                &what,
            );
        }
    }
}

/// In a rule that draws numbers, the seed, paths, births and lengths of a zoom are those of the whole, too.
#[test]
fn shallow_zooms_of_random_rules_are_windows_of_the_whole() {
    let text = "initiator: segment\ngenerators:\n  a:\n    \
                random: {tilt: 'uniform(-20, 20)', at: 'uniform(1/4, 1/3)'}\n    \
                move: {rotate: tilt, about: [1/2, 1/5]}\n    \
                elements: [[0, 0], [at, 1/5], [1 - at, 1/9], [1, 0]]\n  \
                b: {elements: [[0, 0], [1/3, -1/4], {to: [1, 0], direction: 2}]}\n\
                select: {at_random: {a: 2, b: 1}}\n";
    let rule = read(text);
    let graph = rule.compile(64).unwrap();
    for seed in 0..4 {
        for (at, way) in [("0.(0)", vec![0; 70]), ("0.1.(1)", vec![1; 70])] {
            let way: Vec<u32> = std::iter::once(0).chain(way).collect();
            let p = random_point(rule.rule().unwrap(), seed, &way);
            for factor in ["3e1", "1e4", "1e7"] {
                let scale = SCALE * factor.parse::<f64>().unwrap();
                let seen = zoomed(&rule, &graph, &window(factor, at), seed);
                let growth = kfrac::grow::Growth::steps(1_000).seed(seed);
                let place =
                    DAffine2::from_scale(DVec2::splat(scale)) * DAffine2::from_translation(-p);
                let plain = Seen::of(&graph, &growth, place, SHORTEST);
                let what = format!("{at} of {seed} at {factor}");
                let off = 1e-12 * scale + 1e-6;
                assert_same(&seen, &plain, &DAffine2::IDENTITY, off, &what);
                for element in &seen.elements {
                    let apart =
                        |it: &&Element| (it.frame.origin() - element.frame.origin()).length();
                    let twins = plain.elements.iter().filter(|it| it.born == element.born);
                    let twin = twins.min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap();
                    if apart(&twin) < off && element.frame.origin().length() < 200.0 {
                        assert!((twin.length - element.length).abs() <= 1e-9 * element.length);
                        assert_eq!(twin.frame.direction(), element.frame.direction(), "{what}");
                    }
                }
            }
        }
    }
}

/// Returns the point that a path into a random rule leads to, replacement by replacement.
fn random_point(rule: &Rule, seed: u64, way: &[u32]) -> DVec2 {
    let listed = &rule.initiator().elements[way[0] as usize];
    let [from, to] = [listed.from, listed.to].map(|point| rule.initiator_points()[point]);
    let mut frame = Frame2::between(from, to, listed.direction);
    let (mut path, mut length) = (Path::of_seed(seed).child(way[0]), 1.0);
    let (mut scratch, mut points) = (Vec::new(), Vec::new());
    for (step, &position) in way[1..].iter().enumerate() {
        let moment = ElementContext {
            index: 1.0,
            age: step as f64,
            step: step as f64,
            length,
        };
        let generator = &rule.generators()[rule.selection().select(&moment, path)];
        generator.evaluate(&moment, path, &mut scratch, &mut points);
        let listed = generator.elements().nth(position as usize).unwrap();
        let [from, to] = [listed.from, listed.to].map(|point| points[point]);
        frame = frame.compose(&Frame2::between(from, to, listed.direction));
        length *= (to - from).length();
        path = path.child(position);
    }
    frame.origin()
}

/// Copies with equal maps are drawn once, regardless of their number.
#[test]
fn exact_overlaps_are_met_once() {
    let map = |x: u32, y: u32| format!("  - {{scale: 1/3, shift: [{x}/3, {y}/3]}}\n");
    let maps: String = (0..3)
        .flat_map(|x| (0..3).map(move |y| (x, y)))
        .map(|(x, y)| map(x, y))
        .collect();
    let rule = read(&format!(
        "kind: ifs\nmaps:\n{maps}{maps}{maps}initial: {{polygon: [[0, 0], [1, 0], [1, 1]]}}\n"
    ));
    let graph = rule.compile(1).unwrap();
    let found = zoom(
        &rule,
        &graph,
        &ZoomOptions::default(),
        &window("1e200", "0.(4.2)"),
    )
    .unwrap();
    let roots = &found.graph.initiator(0).instances;
    assert!((1..2_000).contains(&roots.len()), "{}", roots.len());
}

#[test]
fn what_has_no_point_is_refused() {
    let said = |rule: &Model, factor: &str, at: &str| -> ZoomError {
        let graph = rule.compile(64).unwrap();
        zoom(rule, &graph, &ZoomOptions::default(), &window(factor, at)).unwrap_err()
    };
    let koch = library("koch");
    let error = said(&koch, "10", "0.1.(4)");
    assert!(matches!(
        error,
        ZoomError::NoSuchPosition {
            position: 4,
            depth: 2,
            count: 4,
            ..
        }
    ));
    let error = said(&koch, "10", "1.(0)");
    assert!(matches!(
        error,
        ZoomError::NoSuchPosition {
            position: 1,
            depth: 0,
            count: 1,
            ..
        }
    ));
    let error = said(&library("pythagoras"), "10", "0.1.(0)");
    assert!(
        matches!(error, ZoomError::Infertile { depth: 2, .. }),
        "{error}"
    );
    assert!(matches!(
        said(&koch, "1e30", "0.5,0.25"),
        ZoomError::TooFine { .. }
    ));
    let grows = read("initiator: segment\ngenerator: [[0, 0], [1/2, 1], [1, 0]]\n");
    assert!(matches!(said(&grows, "10", "0.(0)"), ZoomError::NoLimit(_)));
    assert!(matches!(
        said(&library("meadow"), "10", "0.(0)"),
        ZoomError::NoLimit(NoLimit::Resets)
    ));
    let by_index = "initiator: segment\ngenerator: [[0, 0], ['1/3 + 1/(9*i)', 1/5], [1, 0]]\n";
    assert_eq!(said(&read(by_index), "10", "0.(0)"), ZoomError::CountsIndex);
}
