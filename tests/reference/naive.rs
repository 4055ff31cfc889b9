//! A second engine, after Kaandorp's algorithm: lists of elements are replaced step by step, without a graph.
//! It uses the data of the reference and no code of kfrac.

use super::data::{Entry, Listed};

/// A point as a complex number.
pub(crate) type Point = [f64; 2];

/// An element from its first to its last point of traversal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) ends: [Point; 2],
    pub(crate) direction: u8,
    pub(crate) fertile: bool,
}

/// A fractal and the fractals that it has seeded, in the order of their birth.
pub(crate) struct Tree {
    pub(crate) born: u32,
    pub(crate) elements: Vec<Placed>,
    seeds: Vec<Tree>,
}

/// Products of directions.
const PRODUCT: [[u8; 4]; 4] = [[1, 2, 3, 4], [2, 1, 4, 3], [3, 4, 1, 2], [4, 3, 2, 1]];

impl Placed {
    /// Returns the image of a point: M(z) = p0 + (p1 − p0)·τ(z).
    pub(crate) fn map(&self, [x, y]: Point) -> Point {
        let [x, y] = match self.direction {
            1 => [x, y],
            2 => [x, -y],
            3 => [1.0 - x, y],
            _ => [1.0 - x, -y],
        };
        let [[ax, ay], [bx, by]] = self.ends;
        let (u, v) = (bx - ax, by - ay);
        [ax + u * x - v * y, ay + u * y + v * x]
    }

    fn is_reversed(&self) -> bool {
        self.direction > 2
    }

    /// Returns the elements of a list in the place of this element, in order of traversal.
    fn replaced<'a>(&self, list: impl Iterator<Item = &'a Listed>) -> Vec<Self> {
        let child = |listed: &Listed| {
            let mut ends = [[listed.0, listed.1], [listed.2, listed.3]].map(|end| self.map(end));
            if self.is_reversed() {
                ends.reverse();
            }
            let [own, other] = [self.direction, listed.4].map(|number| usize::from(number) - 1);
            Self {
                ends,
                direction: PRODUCT[own][other],
                fertile: listed.is_fertile(),
            }
        };
        let mut children: Vec<_> = list.map(child).collect();
        if self.is_reversed() {
            children.reverse();
        }
        children
    }
}

impl Tree {
    fn step(&mut self, entry: &Entry, step: u32) {
        for seed in &mut self.seeds {
            seed.step(entry, step);
        }
        let mut elements = Vec::new();
        for (rank, element) in self.elements.iter().enumerate() {
            if !element.fertile {
                elements.push(*element);
                continue;
            }
            let generator = &entry.generators[rank % entry.generators.len()];
            let part = |number| generator.iter().filter(move |listed| listed.6 == number);
            elements.extend(element.replaced(part(0)));
            for number in 1..=generator.iter().map(|listed| listed.6).max().unwrap() {
                self.seeds.push(Self {
                    born: step + 1,
                    elements: element.replaced(part(number)),
                    seeds: Vec::new(),
                });
            }
        }
        self.elements = elements;
    }

    fn flatten(self, fractals: &mut Vec<Self>) {
        let Self {
            born,
            elements,
            seeds,
        } = self;
        fractals.push(Self {
            born,
            elements,
            seeds: Vec::new(),
        });
        for seed in seeds {
            seed.flatten(fractals);
        }
    }
}

/// Returns the fractals of an approximant, in the order of the walk.
pub(crate) fn grow(entry: &Entry, steps: u32) -> Vec<Tree> {
    let unit = Placed {
        ends: [[0.0, 0.0], [1.0, 0.0]],
        direction: 1,
        fertile: true,
    };
    let mut first = Tree {
        born: 0,
        elements: unit.replaced(entry.initiator.iter()),
        seeds: Vec::new(),
    };
    for step in 0..steps {
        first.step(entry, step);
    }
    let mut fractals = Vec::new();
    first.flatten(&mut fractals);
    fractals
}
