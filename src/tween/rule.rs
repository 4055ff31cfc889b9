//! Tweens of production rules.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::expression::{Expression, Program};
use crate::geometry::{BaseElement, DVec2, Frame2, Frame3, Point as _};
use crate::rule::{
    Body, Generator, ListedAttitude, ListedElement, Move, Origin, Part, Rule, RuleFrame, Selection,
    Turn, constant, evaluated,
};
use crate::written::{Written, WrittenPoint};

use super::structure::tint_between;
use super::{Side, Tween, TweenBy, TweenError, chain, maps};

/// Frame of rules that have tweens.
pub(super) trait TweenedFrame: RuleFrame {
    /// Returns the coordinates whose expressions a function returns by their axis.
    fn coordinates(axis: impl FnMut(usize) -> Program) -> Self::Coordinates;

    /// Returns points between their places at both ends; `chains` lists those along which elements follow each other.
    fn places(tween: Tween, ends: &[[Self::Point; 2]], chains: &[Vec<usize>]) -> Vec<Self::Point>;

    /// Returns the turns between two, of which one may be missing; `None` if they have different axes.
    fn turns(tween: Tween, both: [Option<&Self::Turns>; 2]) -> Option<Self::Turns>;

    /// Returns the base element between two; `None` if they are of different shapes.
    fn base_element(tween: Tween, both: [&Self::BaseElement; 2]) -> Option<Self::BaseElement>;
}

impl TweenedFrame for Frame2 {
    fn coordinates(axis: impl FnMut(usize) -> Program) -> [Program; 2] {
        std::array::from_fn(axis)
    }

    fn places(tween: Tween, ends: &[[DVec2; 2]], chains: &[Vec<usize>]) -> Vec<DVec2> {
        chain::placed(tween, ends, chains)
    }

    fn turns(tween: Tween, both: [Option<&Program>; 2]) -> Option<Program> {
        let still = Program::constant(0.0);
        Some(tween.program(both.map(|it| it.unwrap_or(&still))))
    }

    fn base_element(tween: Tween, both: [&BaseElement; 2]) -> Option<BaseElement> {
        maps::outline(tween, both)
    }
}

impl TweenedFrame for Frame3 {
    fn coordinates(axis: impl FnMut(usize) -> Program) -> [Program; 3] {
        std::array::from_fn(axis)
    }

    fn places(tween: Tween, ends: &[[Self::Point; 2]], _chains: &[Vec<usize>]) -> Vec<Self::Point> {
        ends.iter().map(|both| tween.between(*both)).collect()
    }

    fn turns(tween: Tween, both: [Option<&Vec<Turn>>; 2]) -> Option<Vec<Turn>> {
        let still = Program::constant(0.0);
        let (axes, angles) = match both {
            [Some(a), Some(b)] => {
                let same = a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.axis == b.axis);
                let angles = a.iter().zip(b).map(|(a, b)| [&a.angle, &b.angle]);
                (a, same.then(|| angles.collect::<Vec<_>>())?)
            }
            [Some(a), None] => (a, a.iter().map(|it| [&it.angle, &still]).collect()),
            [None, Some(b)] => (b, b.iter().map(|it| [&still, &it.angle]).collect()),
            [None, None] => return Some(Vec::new()),
        };
        let turns = axes.iter().zip(angles).map(|(turn, angles)| Turn {
            axis: turn.axis.each_ref().map(Program::in_doubles),
            angle: tween.program(angles),
        });
        Some(turns.collect())
    }

    fn base_element(_: Tween, [a, b]: [&Body; 2]) -> Option<Body> {
        (a == b).then(|| a.clone())
    }
}

/// Point or base element of one of the two rules, by its number.
type Source = (Side, usize);

/// Numbers of the pairs of sources that a tween needs, in the order in which they are asked for.
#[derive(Default)]
struct Pairs {
    numbers: BTreeMap<[Source; 2], usize>,
    all: Vec<[Source; 2]>,
}

impl Pairs {
    fn number(&mut self, pair: [Source; 2]) -> usize {
        *self.numbers.entry(pair).or_insert_with(|| {
            self.all.push(pair);
            self.all.len() - 1
        })
    }
}

/// Tween of two lists of elements: of initiators, or of generators.
struct Figure<'p> {
    tween: Tween,
    /// Side by which elements name their generators.
    selecting: Side,
    points: Pairs,
    base_elements: &'p mut Pairs,
}

impl Figure<'_> {
    /// Returns the elements of the parts of both sides; a part that is missing is empty.
    fn elements(&mut self, both: [&[ListedElement]; 2]) -> Vec<ListedElement> {
        let count = both[0].len().max(both[1].len());
        let element = |at: usize| match both.map(|it| it.get(at)) {
            [Some(a), Some(b)] => Some(self.paired([a, b])),
            [Some(own), None] => Some(self.grown(0, own, both[1].last())),
            [None, Some(own)] => Some(self.grown(1, own, both[0].last())),
            [None, None] => None,
        };
        (0..count).filter_map(element).collect()
    }

    /// Returns the element between two.
    fn paired(&mut self, both: [&ListedElement; 2]) -> ListedElement {
        let [a, b] = both;
        let nearer = self.tween.pick(both);
        let sources = |of: fn(&ListedElement) -> usize| [(0, of(a)), (1, of(b))];
        let [from, to] =
            [sources(|it| it.from), sources(|it| it.to)].map(|it| self.points.number(it));
        ListedElement {
            from,
            to,
            attitude: self.attitude(both.map(|it| &it.attitude)),
            joined: a.joined && b.joined,
            generator: both[self.selecting].generator,
            base_element: self.base_elements.number(sources(|it| it.base_element)),
            tint: tint_between(self.tween, both.map(|it| it.tint)),
            ..nearer.clone()
        }
    }

    /// Returns an element of one side without a counterpart: it grows out of the end of the last element of the other
    /// side, or else out of its own start.
    fn grown(
        &mut self,
        side: Side,
        own: &ListedElement,
        last: Option<&ListedElement>,
    ) -> ListedElement {
        let point = last.map_or((side, own.from), |last| (1 - side, last.to));
        let mut ends = [own.from, own.to].map(|number| {
            let mut pair = [point; 2];
            pair[side] = (side, number);
            self.points.number(pair)
        });
        let [from, to] = &mut ends;
        ListedElement {
            from: *from,
            to: *to,
            attitude: self.kept(side, &own.attitude),
            generator: own.generator.filter(|_| self.selecting == side),
            base_element: self.base_elements.number([(side, own.base_element); 2]),
            ..own.clone()
        }
    }

    /// Returns the attitude between two; the nearer one if they are of different forms.
    fn attitude(&mut self, both: [&ListedAttitude; 2]) -> ListedAttitude {
        match both {
            [ListedAttitude::Normal(a), ListedAttitude::Normal(b)] => {
                ListedAttitude::Normal(self.points.number([(0, *a), (1, *b)]))
            }
            [ListedAttitude::Roll(a), ListedAttitude::Roll(b)] => {
                ListedAttitude::Roll(self.points.number([(0, *a), (1, *b)]))
            }
            [ListedAttitude::Face(a), ListedAttitude::Face(b)] if a.len() == b.len() => {
                let pairs = a.iter().zip(b).map(|(a, b)| [(0, *a), (1, *b)]);
                ListedAttitude::Face(pairs.map(|it| self.points.number(it)).collect())
            }
            _ => self.kept(self.tween.nearer(), self.tween.pick(both)),
        }
    }

    /// Returns an attitude of one side as it is.
    fn kept(&mut self, side: Side, own: &ListedAttitude) -> ListedAttitude {
        let mut number = |number: usize| self.points.number([(side, number); 2]);
        match own {
            ListedAttitude::Least => ListedAttitude::Least,
            ListedAttitude::Normal(own) => ListedAttitude::Normal(number(*own)),
            ListedAttitude::Roll(own) => ListedAttitude::Roll(number(*own)),
            ListedAttitude::Face(own) => {
                ListedAttitude::Face(own.iter().map(|it| number(*it)).collect())
            }
            ListedAttitude::Corners { points, third, up } => ListedAttitude::Corners {
                points: points.map(&mut number),
                third: *third,
                up: up.map(number),
            },
        }
    }

    /// Returns the points of the tween: programs of the points of both sides, or their places where these are known.
    fn placed<F: TweenedFrame>(
        &self,
        both: [&[F::Coordinates]; 2],
        elements: &[&[ListedElement]],
    ) -> Vec<F::Coordinates> {
        let programs = |pair: &[Source; 2]| pair.map(|(side, number)| &both[side][number]);
        let places = { self.points.all.iter() }.map(|pair| {
            let [a, b] = programs(pair).map(constant::<F>);
            Some([a?, b?])
        });
        if let (TweenBy::Polar, Some(places)) = (self.tween.by, places.collect::<Option<Vec<_>>>())
        {
            let chains: Vec<_> = elements.iter().flat_map(|it| chains(it)).collect();
            let placed = F::places(self.tween, &places, &chains);
            let fixed = placed.iter().map(|place| {
                let values = place.coordinates();
                F::coordinates(|axis| Program::constant(values[axis]))
            });
            return fixed.collect();
        }
        let pairs = self.points.all.iter();
        pairs
            .map(|pair| between::<F>(self.tween, programs(pair)))
            .collect()
    }
}

/// Returns the expressions between those of two points.
fn between<F: TweenedFrame>(tween: Tween, both: [&F::Coordinates; 2]) -> F::Coordinates {
    F::coordinates(|axis| tween.program(both.map(|it| &it.as_ref()[axis])))
}

/// Returns the points of runs of elements of which each starts where the one before it ends.
fn chains(elements: &[ListedElement]) -> Vec<Vec<usize>> {
    let mut chains: Vec<Vec<usize>> = Vec::new();
    for element in elements {
        match chains.last_mut() {
            Some(chain) if chain.last() == Some(&element.from) => chain.push(element.to),
            _ => chains.push(vec![element.from, element.to]),
        }
    }
    chains
}

/// Returns the rule between two.
pub(super) fn tween<F: TweenedFrame>(
    tween: Tween,
    a: &Rule<F>,
    b: &Rule<F>,
) -> Result<Rule<F>, TweenError> {
    let rules = [a, b];
    // One generator replaces all elements, whatever selects it.
    let selecting = match rules.map(|it| it.generators.len() == 1) {
        [true, false] => 1,
        [false, true] => 0,
        _ => tween.nearer(),
    };
    let mut base_elements = Pairs::default();
    // The base element of the rule comes first.
    base_elements.number([(0, 0), (1, 0)]);
    let mut drawn = Figure {
        tween,
        selecting,
        points: Pairs::default(),
        base_elements: &mut base_elements,
    };
    let elements = drawn.elements(rules.map(|it| it.initiator.elements.as_slice()));
    let written_points = drawn.placed::<F>(
        rules.map(|it| it.written_points.as_slice()),
        &[elements.as_slice()],
    );
    let points = written_points.iter().map(|it| evaluated::<F>(it, &[]));
    let points = points.collect();
    let initiator = Part {
        elements,
        placement: a.initiator.placement,
        meets_frame: std::array::from_fn(|end| {
            rules.iter().all(|it| it.initiator.meets_frame[end])
        }),
    };
    let count = a.generators.len().max(b.generators.len());
    let generators = (0..count).map(|number| {
        let pair = rules.map(|it| &it.generators[number.min(it.generators.len() - 1)]);
        let figure = Figure {
            tween,
            selecting,
            points: Pairs::default(),
            base_elements: &mut base_elements,
        };
        generator(figure, pair)
    });
    let generators = generators.collect::<Result<_, _>>()?;
    let shapes = base_elements.all.iter().map(|pair| {
        let both = pair.map(|(side, number)| &rules[side].base_elements[number]);
        let between = F::base_element(tween, both);
        between.unwrap_or_else(|| tween.pick(both).clone())
    });
    Ok(Rule {
        metadata: tween.metadata(rules.map(|it| &it.metadata)),
        points,
        written_points,
        initiator,
        generators,
        selection: selection(&rules[selecting].selection),
        base_elements: shapes.collect(),
        growing: None,
    })
}

/// Returns a selection without the parameters of its file.
fn selection(own: &Selection) -> Selection {
    match own {
        Selection::ByCondition { cases, otherwise } => Selection::ByCondition {
            cases: { cases.iter() }
                .map(|(condition, generator)| (condition.in_doubles(), *generator))
                .collect(),
            otherwise: *otherwise,
        },
        own => own.clone(),
    }
}

/// Returns the generator between two.
fn generator<F: TweenedFrame>(
    mut figure: Figure<'_>,
    both: [&Generator<F>; 2],
) -> Result<Generator<F>, TweenError> {
    let tween = figure.tween;
    let [a, b] = both;
    let draws = || TweenError::Draws(a.name.clone(), b.name.clone());
    let variables = match both.map(|it| it.variables.as_slice()) {
        [own, []] | [[], own] => own,
        [own, other] if own == other => own,
        _ => return Err(draws()),
    };
    let count = a.parts.len().max(b.parts.len());
    let parts: Vec<Part> = (0..count)
        .map(|number| {
            let parts = both.map(|it| it.parts.get(number));
            let elements = parts.map(|it| it.map_or(&[][..], |part| &part.elements));
            let known = parts.iter().flatten();
            let nearer = tween.pick(parts).or(parts[0]).or(parts[1]);
            Part {
                placement: nearer.map_or(a.parts[0].placement, |it| it.placement),
                elements: figure.elements(elements),
                meets_frame: std::array::from_fn(|end| known.clone().all(|it| it.meets_frame[end])),
            }
        })
        .collect();
    let lists: Vec<_> = parts.iter().map(|it| it.elements.as_slice()).collect();
    let points = figure.placed::<F>(both.map(|it| it.points.as_slice()), &lists);
    let moves = moves(&figure, both).ok_or_else(draws)?;
    Ok(Generator {
        origin: Origin {
            name: tween.pick(both).origin.name.clone(),
            points: written(&points, a),
        },
        name: tween.pick(both).name.clone(),
        variables: { variables.iter() }.map(|it| it.in_doubles()).collect(),
        points,
        moves,
        parts,
    })
}

/// Returns the moves between those of two generators; `None` if they move different points.
fn moves<F: TweenedFrame>(figure: &Figure<'_>, both: [&Generator<F>; 2]) -> Option<Vec<Move<F>>> {
    let count = match both.map(|it| it.moves.len()) {
        [0, count] | [count, 0] => count,
        [a, b] if a == b => a,
        _ => return None,
    };
    let moved = |number: usize| {
        let moves = both.map(|it| it.moves.get(number));
        let vector = |of: fn(&Move<F>) -> &F::Coordinates, still: f64| {
            let still = F::coordinates(|_| Program::constant(still));
            between::<F>(figure.tween, moves.map(|it| it.map_or(&still, of)))
        };
        // A point moves if all generators that have moves move it.
        let numbers = |of: fn(&Move<F>) -> &[usize]| -> Arc<[usize]> {
            let moves_it =
                |(side, number): &Source| moves[*side].is_none_or(|it| of(it).contains(number));
            let pairs = figure.points.all.iter().enumerate();
            let moving = pairs.filter(|(_, pair)| pair.iter().all(moves_it));
            moving.map(|(number, _)| number).collect()
        };
        // A move that is alone grows about its own centre.
        let [a, b] = moves.map(|it| it.or(moves[0]).or(moves[1]));
        Some(Move {
            rotate: F::turns(figure.tween, moves.map(|it| it.map(|it| &it.rotate)))?,
            scale: vector(|it| &it.scale, 1.0),
            shift: vector(|it| &it.shift, 0.0),
            about: between::<F>(figure.tween, [&a?.about, &b?.about]),
            points: numbers(|it| &it.points),
            normals: numbers(|it| &it.normals),
        })
    };
    (0..count).map(moved).collect()
}

/// Returns points as they could be written in a file.
fn written<F: TweenedFrame>(points: &[F::Coordinates], from: &Generator<F>) -> Vec<WrittenPoint> {
    let place = &from.origin.name;
    let number = |program: Option<&Program>| Written {
        value: { program.and_then(Program::as_constant) }
            .map_or_else(Expression::unknown, Expression::number),
        place: place.clone(),
    };
    let point = |it: &F::Coordinates| {
        let all = it.as_ref();
        WrittenPoint {
            x: number(all.first()),
            y: number(all.get(1)),
            z: all.get(2).map(|z| number(Some(z)).into()),
            place: place.clone(),
        }
    };
    points.iter().map(point).collect()
}
