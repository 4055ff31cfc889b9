//! Kaandorp's algorithm (1987, section 2.2) on lists: every fractal of an approximant is held in memory and
//! replaced as a whole. Slow, and simple enough to be compared with the paper.

use kfrac::Path;
use kfrac::geometry::{Direction, Frame2, Point as _};
use kfrac::rule::{ElementContext, ListedElement, Part, Placement, Rule, RuleFrame};

/// An element of a list.
#[derive(Clone, Debug)]
pub(crate) struct Item<F: RuleFrame = Frame2> {
    pub listed: ListedElement,
    pub frame: F,
    pub length: f64,
    pub born: u32,
    /// Frame of the initiator element that it descends from.
    root: F,
    path: Path,
    /// Whether the element is joined to the preceding one (the first to the last), by structure alone.
    pub joined: bool,
}

/// A fractal: a list of elements of one age, and the fractals that it has seeded.
#[derive(Clone, Debug)]
pub(crate) struct Grown<F: RuleFrame = Frame2> {
    pub age: u32,
    pub items: Vec<Item<F>>,
    seeds: Vec<Grown<F>>,
}

impl<F: RuleFrame> Grown<F> {
    /// Returns the fractal and its seeds, depth-first.
    pub(crate) fn all(&self) -> Vec<&Self> {
        let mut all = vec![self];
        all.extend(self.seeds.iter().flat_map(Self::all));
        all
    }
}

/// Returns approximant `steps` of a rule.
pub(crate) fn grow<F: RuleFrame>(rule: &Rule<F>, steps: u32, seed: u64) -> Grown<F> {
    let points = rule.initiator_points();
    let items = rule
        .initiator()
        .elements
        .iter()
        .zip(0..)
        .map(|(listed, position)| {
            let frame = F::placed(listed, points);
            Item {
                listed: listed.clone(),
                frame,
                length: 1.0,
                born: 0,
                root: frame,
                path: Path::of_seed(seed).child(position),
                joined: listed.joined,
            }
        });
    let mut first = Grown {
        age: 0,
        items: items.collect(),
        seeds: Vec::new(),
    };
    for step in 0..steps {
        replace(rule, &mut first, step);
    }
    first
}

fn replace<F: RuleFrame>(rule: &Rule<F>, fractal: &mut Grown<F>, step: u32) {
    for seed in &mut fractal.seeds {
        replace(rule, seed, step);
    }
    let mut next: Vec<Item<F>> = Vec::new();
    let mut broken = false;
    for (item, rank) in std::mem::take(&mut fractal.items).into_iter().zip(1u32..) {
        // `broken`: the preceding list does not reach the start of this element.
        let joined = item.joined && !broken;
        if !item.listed.fertile {
            next.push(Item { joined, ..item });
            broken = false;
        } else {
            let moment = ElementContext {
                index: f64::from(rank),
                age: f64::from(fractal.age),
                step: f64::from(step),
                length: item.length,
            };
            let number = item
                .listed
                .generator
                .unwrap_or_else(|| rule.selection().select(&moment, item.path));
            let generator = &rule.generators()[number];
            let mut points = Vec::new();
            generator.evaluate(&moment, item.path, &mut Vec::new(), &mut points);
            let mut position = 0;
            let mut body = Vec::new();
            let mut ends = [false; 2];
            for part in generator.parts() {
                match part.placement {
                    Placement::Stays => {
                        if body.is_empty() {
                            ends[0] = part.meets_frame[0];
                        }
                        ends[1] = part.meets_frame[1];
                        body.extend(place(part, &points, &item, &mut position, step + 1));
                    }
                    placement => {
                        let mut parent = item.clone();
                        if placement == Placement::SeedsAsInitiator {
                            let [origin, _] = item.frame.ends();
                            parent.length = 1.0;
                            parent.frame = item.root.moved_to(origin);
                        }
                        let mut items = place(part, &points, &parent, &mut position, step + 1);
                        turn(&mut items, parent.frame.direction());
                        fractal.seeds.push(Grown {
                            age: 0,
                            items,
                            seeds: Vec::new(),
                        });
                    }
                }
            }
            if let Some(first) = body.first_mut() {
                first.joined = false;
            }
            turn(&mut body, item.frame.direction());
            if item.frame.direction().is_reversed() {
                ends.reverse();
            }
            if let Some(first) = body.first_mut() {
                first.joined = joined && ends[0];
            }
            broken = body.is_empty() || !ends[1];
            next.extend(body);
        }
    }
    if let Some(first) = next.first_mut() {
        // The first element of a ring is joined to the last.
        first.joined &= !broken;
    }
    fractal.items = next;
    fractal.age += 1;
}

fn place<F: RuleFrame>(
    part: &Part,
    points: &[F::Point],
    parent: &Item<F>,
    position: &mut u32,
    born: u32,
) -> Vec<Item<F>> {
    let mut items = Vec::new();
    for listed in &part.elements {
        let (from, to) = (points[listed.from], points[listed.to]);
        items.push(Item {
            listed: listed.clone(),
            frame: parent.frame.compose(&F::placed(listed, points)),
            length: parent.length * (to - from).length(),
            born,
            root: parent.root,
            path: parent.path.child(*position),
            joined: listed.joined,
        });
        *position += 1;
    }
    items
}

/// Puts a list into the order of traversal: backwards for directions 3, 4, 7 and 8. Joints are reversed with their
/// elements.
fn turn<F: RuleFrame>(items: &mut [Item<F>], direction: Direction) {
    if direction.is_reversed() {
        let mut joined: Vec<bool> = items.iter().map(|item| item.joined).collect();
        let count = joined.len().min(1);
        joined.rotate_left(count);
        items.reverse();
        joined.reverse();
        for (item, joined) in items.iter_mut().zip(joined) {
            item.joined = joined;
        }
    }
}
