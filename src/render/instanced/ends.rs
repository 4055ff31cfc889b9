//! End points of expanded objects, for the lines that link neighbours.

use crate::geometry::{DVec2, Direction};
use crate::graph::{Chain, Graph, Instance, Replacement};
use crate::instancing::Appearance;
use crate::rule::Piece;

/// First or last element of an expanded object, if another element can be joined to it there.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// End of its outline, in the object's unit frame.
    pub(super) point: DVec2,
    /// Whether that is the end point of its frame.
    pub(super) meets_frame: bool,
    /// Number of the element's own object.
    pub(super) object: usize,
    pub(super) length: f64,
    pub(super) direction: Direction,
    /// Step of its birth, relative to the object's.
    pub(super) born: u32,
    /// Appearance composed of its own and those of its ancestors below the object.
    pub(super) appearance: Appearance,
}

impl End {
    fn within(self, instance: &Instance, appearance: Appearance) -> Self {
        Self {
            point: instance.frame.apply(self.point),
            length: self.length * instance.length,
            direction: self.direction * instance.frame.direction(),
            born: self.born + 1,
            appearance: appearance.over(self.appearance),
            ..self
        }
    }
}

/// Ends of all objects after a number of steps.
pub(super) struct Ends<'g> {
    graph: &'g Graph,
    steps: u32,
    /// By object: the end at (0, 0) and the end at (1, 0).
    all: Vec<[Option<End>; 2]>,
}

impl<'g> Ends<'g> {
    /// Creates the ends of objects that are not expanded.
    pub(super) fn new(graph: &'g Graph) -> Self {
        let objects = 0..graph.objects().len();
        Self {
            graph,
            steps: 0,
            all: objects.map(|object| own(graph, object)).collect(),
        }
    }

    /// Advances to a number of steps.
    pub(super) fn advance(&mut self, steps: u32) {
        while self.steps < steps {
            let objects = self.graph.objects().iter().enumerate();
            let next = objects.map(|(number, object)| match &object.replacement {
                Replacement::Kept => self.all[number],
                Replacement::Fixed(successor) => self.of_chain(&successor.body),
                Replacement::Evaluated(_) | Replacement::Unresolved => [None; 2],
            });
            self.all = next.collect();
            self.steps += 1;
        }
    }

    fn of_chain(&self, chain: &Chain) -> [Option<End>; 2] {
        let [starts, ends] = chain.meets_frame;
        let first = chain.instances.first().filter(|_| starts);
        let last = chain.instances.last().filter(|_| ends);
        [
            first.and_then(|instance| self.of(instance)[0]),
            last.and_then(|instance| self.of(instance)[1]),
        ]
    }

    /// Returns the ends of an expanded instance, in the order of listing and in its parent's frame.
    pub(super) fn of(&self, instance: &Instance) -> [Option<End>; 2] {
        let appearance = self.graph.appearance(instance.object);
        let within = |end: Option<End>| end.map(|end| end.within(instance, appearance));
        let [start, end] = self.all[instance.object].map(within);
        if instance.frame.direction().is_reversed() {
            [end, start]
        } else {
            [start, end]
        }
    }
}

/// Returns the ends of an object's own outline.
fn own(graph: &Graph, number: usize) -> [Option<End>; 2] {
    let object = &graph.objects()[number];
    let base_element = &graph.base_elements()[object.base_element];
    if !object.visible || base_element.is_closed() {
        return [None; 2];
    }
    let start = base_element.start();
    let points = [
        start,
        base_element.pieces().last().map_or(start, Piece::end),
    ];
    let meet = base_element.ends_meet_frame();
    [0, 1].map(|end| {
        Some(End {
            point: points[end],
            meets_frame: meet[end],
            object: number,
            length: 1.0,
            direction: Direction::Normal,
            born: 0,
            appearance: Appearance::NONE,
        })
    })
}
