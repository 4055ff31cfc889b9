//! Tests of colonies: walks that take them, against walks over all elements.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;

use super::{Colony, ColonyKinds, Taken};
use crate::catalogue::Catalogue;
use crate::diagnostic::Source;
use crate::document::Document;
use crate::graph::Graph;
use crate::grow::{Element, Enter, Growth, Run, Subtree, Visitor, Walked, walk};

const SHORTEST: f64 = 0.02;

/// Part of colonies that a visitor takes.
#[derive(Clone, Copy, PartialEq)]
enum By {
    Elements,
    Fractals,
    Colonies,
}

/// Collects elements, including those of colonies that it takes.
struct Collecting<'k> {
    kinds: &'k ColonyKinds,
    by: By,
    elements: BTreeMap<(usize, u32, [i64; 4]), u64>,
    /// Number of colonies taken, by kind.
    met: BTreeMap<usize, u64>,
    taken: u64,
}

impl Collecting<'_> {
    fn walked(&self, colony: &Colony<'_>, is_whole: bool) -> (Vec<Element>, Walked) {
        let mut listing = Listing(Vec::new());
        let walked = colony.walk(is_whole, &mut listing).unwrap();
        (listing.0, walked)
    }
}

impl Visitor for Collecting<'_> {
    type Error = Infallible;

    fn cuts(&self) -> Option<f64> {
        Some(SHORTEST)
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        enter(subtree)
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        let map = element.frame.map();
        let [x, y] = map.translation.to_array();
        let place = [x, y, map.matrix2.x_axis.x, map.matrix2.x_axis.y];
        let place = place.map(|part| super::round(part * 1e6));
        let key = (element.object, element.born, place);
        *self.elements.entry(key).or_default() += 1;
        Ok(())
    }

    fn run(&mut self, _: &Run<'_>) -> Result<(), Infallible> {
        unreachable!("runs are not taken")
    }

    fn takes(&self, colony: &Colony<'_>) -> Taken {
        let is_long = colony.frame().stretch() > 0.3;
        match self.by {
            By::Elements => Taken::Nothing,
            _ if is_long || self.kinds.number(colony).is_none() => Taken::Nothing,
            By::Fractals => Taken::Own {
                elements: self.walked(colony, false).1.elements,
            },
            By::Colonies => Taken::Whole(self.walked(colony, true).1),
        }
    }

    fn colony(&mut self, colony: &Colony<'_>, taken: Taken) -> Result<(), Infallible> {
        let number = self.kinds.number(colony).unwrap();
        *self.met.entry(number).or_default() += 1;
        self.taken += 1;
        let kind = &self.kinds.all[number];
        let turned = colony.moved_to(kind.turned(colony.frame().map()));
        let (elements, _) = self.walked(&turned, matches!(taken, Taken::Whole(_)));
        elements
            .iter()
            .try_for_each(|element| self.element(element))
    }
}

struct Listing(Vec<Element>);

impl Visitor for Listing {
    type Error = Infallible;

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        enter(subtree)
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.0.push(*element);
        Ok(())
    }
}

fn enter(subtree: &Subtree) -> Enter {
    if subtree.frame.stretch() < SHORTEST {
        Enter::Keep
    } else {
        Enter::Replace
    }
}

fn graph(catalogue: &Catalogue, source: &Arc<Source>) -> Graph {
    let document = Document::read(source, catalogue).unwrap();
    document.resolve(&[]).unwrap().0.compile(20).unwrap()
}

/// Rule with seeds on both sides of an element, one of them mirrored.
const ONE_SIDED: &str = "
initiator: {elements: [[0, 0], [1, 0]]}
generators:
  on:
    parts:
      - connected: false
        elements:
          - {from: [0, 0], to: [1/2, 0]}
          - {from: [1/2, 0], to: [1, 0], fertile: false}
      - seeds: true
        connected: false
        elements:
          - {from: [1/2, 0], to: [1/2, 1/3]}
          - {from: [1/2, 0], to: [1/2, -1/3], direction: 2}
select: [{use: on}]
";

#[test]
fn colonies_are_their_elements_one_by_one() {
    let catalogue = Catalogue::embedded();
    let mandala = catalogue.rule("mandala").unwrap();
    let one_sided = Source::new("one-sided", ONE_SIDED);
    for (name, source, turns) in [("mandala", mandala, 1), ("one-sided", one_sided, 4)] {
        let graph = graph(&catalogue, &source);
        let growth = Growth::steps(20);
        let kinds = ColonyKinds::of(&graph, growth.steps, SHORTEST);
        assert!(kinds.all.iter().all(|kind| kind.turns <= turns), "{name}");
        let grown = |by| {
            let mut collecting = Collecting {
                kinds: &kinds,
                by,
                elements: BTreeMap::new(),
                met: BTreeMap::new(),
                taken: 0,
            };
            let walked = walk(&graph, &growth, &mut collecting).unwrap();
            (collecting, walked)
        };
        let (one_by_one, walked) = grown(By::Elements);
        assert_eq!(one_by_one.taken, 0);
        for by in [By::Fractals, By::Colonies] {
            let (taken, same) = grown(by);
            assert!(taken.taken > 20, "{name}: {}", taken.taken);
            assert_eq!(same, walked, "{name}");
            assert!(taken.elements == one_by_one.elements, "{name}");
            if by == By::Fractals {
                for (number, count) in taken.met {
                    assert_eq!(count, kinds.all[number].count, "{name}");
                }
            }
        }
    }
}

#[test]
fn no_colonies_are_known_where_draws_decide() {
    let catalogue = Catalogue::embedded();
    let drawn = ONE_SIDED.replace("1/3]}", "part / 3]}");
    let drawn = drawn.replace(
        "  on:\n",
        "  on:\n    random: {part: \"uniform(0.5, 1)\"}\n",
    );
    for (text, is_known) in [(ONE_SIDED, true), (&drawn, false)] {
        let graph = graph(&catalogue, &Source::new("drawn", text));
        let kinds = ColonyKinds::of(&graph, 5, SHORTEST);
        assert_eq!(!kinds.all.is_empty(), is_known);
    }
}
