//! The machinery of growth in space: graphs over a frame of three dimensions.

use std::collections::BTreeSet;
use std::convert::Infallible;
use std::num::NonZero;
use std::sync::Arc;

use crate::draws::{Path, pick_by_weight};
use crate::expression::Interval;
use crate::extent::bounding_box;
use crate::geometry::{Bounds, DAffine3, DMat3, DVec3, Frame, Frame3, Solid};
use crate::graph::{
    Alternative, Buffers, Chain, CompileError, Graph, Instance, Object, Replacement, Seed, Source,
    Successor,
};
use crate::rule::{ElementContext, Extent, Part, Placement};

use super::{
    Element, Elements, Enter, FractalInfo, Growth, Seam, Subtree, Visitor, count, walk,
    walk_in_spans,
};

/// Returns the frame that shrinks the unit frame by a factor and moves it.
fn shrunk(factor: f64, origin: DVec3) -> Frame3 {
    let linear = DMat3::from_diagonal(DVec3::splat(factor));
    DAffine3::from_mat3_translation(linear, origin).into()
}

/// Returns the unit cube.
fn cube() -> Solid {
    Solid::cuboid(&Bounds::new(DVec3::ZERO, DVec3::ONE))
}

/// Returns the origins of the cubes of a Menger sponge, in thirds: the cells of a 3 × 3 × 3 cube with at most
/// one coordinate in the middle.
fn cells() -> Vec<DVec3> {
    let all = (0..27).map(|cell| [cell / 9, cell / 3 % 3, cell % 3]);
    let stays = |cell: &[u32; 3]| cell.iter().filter(|at| **at == 1).count() < 2;
    all.filter(stays)
        .map(|cell| DVec3::from_array(cell.map(f64::from)))
        .collect()
}

/// Returns the instances of an object in cells, a third as large.
fn chain(cells: &[DVec3], object: usize) -> Chain<Frame3> {
    let instances = (0..).zip(cells).map(|(position, &cell)| Instance {
        corners: None,
        frame: shrunk(1.0 / 3.0, cell / 3.0),
        length: 1.0 / 3.0,
        joined: false,
        position,
        object,
    });
    Chain::loose(instances.collect())
}

/// Returns a graph that starts with object 0 in a frame, and whose only shape is the cube.
fn graph(objects: Vec<Object<Frame3>>, start: Frame3) -> Graph<Frame3> {
    let root = Instance {
        corners: None,
        length: start.length(),
        frame: start,
        joined: false,
        position: 0,
        object: 0,
    };
    let initiator = Chain::loose(vec![root]);
    Graph {
        middle: DVec3::splat(0.5),
        ..Graph::of(objects, [cube()], vec![initiator])
    }
}

fn sponge(start: Frame3) -> Graph<Frame3> {
    let successor = Successor {
        body: chain(&cells(), 0),
        seeds: Vec::new(),
    };
    let object = Object {
        replacement: Replacement::Fixed(Arc::new(successor)),
        ..Object::kept(0)
    };
    graph(vec![object], start)
}

/// Visitor that records elements, and keeps those below a length or skips those beyond a plane.
#[derive(Clone, Default)]
struct Recorder {
    shortest: f64,
    left_of: Option<f64>,
    fractals: Vec<FractalInfo>,
    elements: Vec<Element<Frame3>>,
}

impl Visitor<Frame3> for Recorder {
    type Error = Infallible;

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
        self.fractals.push(fractal);
        Ok(())
    }

    fn enter(&mut self, subtree: &Subtree<Frame3>) -> Enter {
        let beyond = |x| subtree.frame.origin().x >= x;
        if self.left_of.is_some_and(beyond) {
            Enter::Skip
        } else if subtree.frame.stretch() < self.shortest {
            Enter::Keep
        } else {
            Enter::Replace
        }
    }

    fn cuts(&self) -> Option<f64> {
        (self.shortest > 0.0).then_some(self.shortest)
    }

    fn element(&mut self, element: &Element<Frame3>) -> Result<(), Infallible> {
        self.elements.push(*element);
        Ok(())
    }
}

fn recorded(graph: &Graph<Frame3>, growth: &Growth<'_>, mut recorder: Recorder) -> Recorder {
    walk(graph, growth, &mut recorder).unwrap();
    recorder
}

/// Records the elements of a walk on several threads.
fn recorded_by_threads(graph: &Graph<Frame3>, growth: &Growth<'_>) -> Vec<Element<Frame3>> {
    let mut all: Vec<Element<Frame3>> = Vec::new();
    let take = |recorder: &mut Recorder, seam: Seam| {
        for mut element in recorder.elements.drain(..) {
            element.index += seam.before;
            all.push(element);
        }
        Ok(())
    };
    let threads = NonZero::new(3).unwrap();
    walk_in_spans(graph, growth, threads, Some(100), Recorder::default, take).unwrap();
    all
}

fn places(elements: &[Element<Frame3>]) -> Vec<(Frame3, u128)> {
    elements.iter().map(|it| (it.frame, it.index)).collect()
}

#[test]
fn a_sponge_is_forecast() {
    let graph = sponge(Frame3::UNIT);
    let mut forecast = graph.forecast().unwrap();
    let mut expected = 1u128;
    for step in 0..=28 {
        let level = forecast.level();
        assert_eq!(level.elements.to_string(), expected.to_string(), "{step}");
        // Every cube has six faces, a ninth as large in each step.
        let cubes = 20f64.powi(step);
        let area = level.area.unwrap() / (6.0 * cubes * 9f64.powi(-step));
        let length = level.length.unwrap() / (cubes * 3f64.powi(-step));
        assert!((area - 1.0).abs() < 1e-12 && (length - 1.0).abs() < 1e-12);
        expected *= 20;
        forecast.advance();
    }
    assert_eq!(graph.check_size(3, 8_000), Ok(Some(8_000)));
    assert_eq!(graph.check_size(4, 8_000).unwrap_err().deepest, Some(3));
    let [start, ratio] = graph.even_lengths().unwrap();
    assert_eq!([start, ratio], [1.0, 1.0 / 3.0]);
}

#[test]
fn a_sponge_is_bounded() {
    let start = shrunk(2.0, DVec3::new(1.0, -3.0, 0.5));
    let graph = sponge(start);
    let corner = start.origin();
    let expected = Bounds::new(corner, corner + 2.0);
    let is_near = |bounds: Bounds<DVec3>| {
        bounds.min().abs_diff_eq(expected.min(), 1e-14)
            && bounds.max().abs_diff_eq(expected.max(), 1e-14)
    };
    for steps in [0, 1, 2, 60] {
        assert!(is_near(graph.bounds(steps).unwrap()), "{steps}");
    }
    assert!(is_near(graph.limit_bounds().unwrap()));
    assert_eq!(graph.limit().unwrap().drawn(), [true]);
    for steps in [2, 3] {
        let growth = Growth::steps(steps);
        let counted = count(&graph, &growth, NonZero::new(2).unwrap()).unwrap();
        assert!(is_near(counted.bounds), "{steps}");
        assert!(is_near(bounding_box(&graph, &growth).unwrap()), "{steps}");
    }
    let reaches = graph.reaches(|object| graph.outline_radius(object));
    let radius = 3f64.sqrt() / 2.0;
    assert!((radius..1.01 * radius).contains(&reaches[0]));
}

#[test]
fn a_sponge_is_walked_in_order() {
    let graph = sponge(Frame3::UNIT);
    let mut expected = vec![Frame3::UNIT];
    for _ in 0..3 {
        let replaced = expected.iter().flat_map(|frame| {
            let cells = cells().into_iter();
            cells.map(|cell| frame.compose(&shrunk(1.0 / 3.0, cell / 3.0)))
        });
        expected = replaced.collect();
    }
    let expected: Vec<(Frame3, u128)> = expected.into_iter().zip(1..).collect();
    let growth = Growth::steps(3);
    let walked = recorded(&graph, &growth, Recorder::default());
    assert_eq!(walked.fractals.len(), 1);
    assert!(places(&walked.elements) == expected);
    let iterated: Vec<_> = Elements::of(&graph, &growth)
        .map(|it| it.unwrap().1)
        .collect();
    assert!(places(&iterated) == expected);
    assert!(places(&recorded_by_threads(&graph, &growth)) == expected);
    // No two cubes are one.
    let corners = expected.iter().map(|(frame, _)| {
        let [x, y, z] = (frame.origin() * 27.0).round().to_array();
        [x.to_bits(), y.to_bits(), z.to_bits()]
    });
    assert_eq!(corners.collect::<BTreeSet<_>>().len(), 8_000);
}

#[test]
fn a_sponge_is_cut_and_culled() {
    let graph = sponge(Frame3::UNIT);
    let growth = Growth::steps(40);
    let short = Recorder {
        shortest: 0.04,
        ..Recorder::default()
    };
    assert_eq!(recorded(&graph, &growth, short).elements.len(), 8_000);
    // A layer of the sponge is a Sierpinski carpet of 8³ cubes.
    let layer = Recorder {
        left_of: Some(1.0 / 54.0),
        ..Recorder::default()
    };
    let layer = recorded(&graph, &Growth::steps(3), layer);
    let left = layer
        .elements
        .iter()
        .filter(|it| it.frame.origin().x < 0.01);
    assert_eq!(left.count(), 512);
}

/// Source that replaces an element by the whole sponge or by its corners, at random.
#[derive(Debug)]
struct Coin;

impl Source<Frame3> for Coin {
    fn evaluate(
        &self,
        alternatives: &[Alternative],
        path: Path,
        _: &ElementContext,
        _: &mut Buffers<Frame3>,
        successor: &mut Successor<Frame3>,
    ) -> Result<(), CompileError> {
        let drawn = pick_by_weight(path, [1.0, 2.0].into_iter());
        let is_corner = |cell: &DVec3| cell.to_array().iter().all(|at| *at != 1.0);
        let cells = cells().into_iter();
        let cells: Vec<DVec3> = match alternatives[drawn].generator {
            0 => cells.collect(),
            _ => cells.filter(is_corner).collect(),
        };
        successor.body = chain(&cells, 0);
        Ok(())
    }

    fn parts(&self, _: usize) -> &[Part] {
        &[]
    }

    fn extents(&self, _: usize, _: f64, _: &[Interval; 4], _: DVec3) -> Vec<Extent> {
        let extent = Extent {
            away: 3f64.sqrt() / 3.0,
            length: 1.0 / 3.0,
        };
        vec![extent; 20]
    }
}

#[test]
fn draws_in_space_hang_on_the_path() {
    let alternatives = [(0, 20), (1, 8)].map(|(generator, count)| Alternative {
        generator,
        objects: vec![0; count],
    });
    let object = Object {
        replacement: Replacement::Evaluated(alternatives.into()),
        ..Object::kept(0)
    };
    let graph = Graph {
        source: Some(Arc::new(Coin)),
        draws: true,
        ..graph(vec![object], Frame3::UNIT)
    };
    let growth = |steps, seed| Growth {
        seed,
        ..Growth::steps(steps)
    };
    let of = |steps, seed| recorded(&graph, &growth(steps, seed), Recorder::default()).elements;
    let [coarse, fine, other] = [of(2, 1), of(3, 1), of(3, 2)];
    assert!(places(&fine) != places(&other));
    assert!(places(&recorded_by_threads(&graph, &growth(3, 1))) == places(&fine));
    // Every element of a step replaces one of the step before, and each is replaced.
    let parents = fine.iter().map(|element| {
        let middle = element.frame.apply(DVec3::splat(0.5));
        let holds = |parent: &Element<Frame3>| {
            let from = parent.frame.origin();
            middle.cmpge(from).all() && middle.cmple(from + 1.0 / 9.0).all()
        };
        coarse.iter().position(holds).unwrap()
    });
    let mut parents: Vec<usize> = parents.collect();
    assert!(parents.is_sorted());
    parents.dedup();
    assert_eq!(parents.len(), coarse.len());
    assert!(graph.reaches(|_| 1.0)[0] < 2.0);
    let searched = bounding_box(&graph, &growth(3, 1)).unwrap();
    let counted = count(&graph, &growth(3, 1), NonZero::new(1).unwrap()).unwrap();
    assert_eq!(searched, counted.bounds);
}

#[test]
fn seeds_in_space_are_fractals() {
    let seed = |placement| Seed {
        placement,
        chain: chain(&[DVec3::splat(2.0)], 0),
    };
    let successor = Successor {
        body: chain(&[DVec3::ZERO], 0),
        seeds: vec![seed(Placement::Seeds), seed(Placement::SeedsAsInitiator)],
    };
    let object = Object {
        replacement: Replacement::Fixed(Arc::new(successor)),
        ..Object::kept(0)
    };
    let graph = Graph {
        seeds: true,
        ..graph(vec![object], shrunk(0.5, DVec3::ONE))
    };
    let walked = recorded(&graph, &Growth::steps(2), Recorder::default());
    let ages: Vec<u32> = walked.fractals.iter().map(|fractal| fractal.age).collect();
    assert_eq!(ages, [2, 1, 0, 0, 1, 0, 0, 0, 0]);
    let mut forecast = graph.forecast().unwrap();
    forecast.advance();
    forecast.advance();
    assert_eq!(forecast.elements().to_u64(), Some(9));
    assert_eq!(forecast.fractals().to_u64(), Some(9));
    // A seed that is placed as the initiator is as large as the first one, a third of the root.
    let lengths = walked.elements.iter().map(|element| element.frame.length());
    let seeded: Vec<f64> = lengths.collect();
    let largest = seeded.iter().copied().fold(0.0, f64::max);
    assert!((largest - 0.5 / 3.0).abs() < 1e-15, "{seeded:?}");
}
