//! Random rules, some of them valid.

use std::sync::Arc;

use kfrac::Parameter;
use kfrac::build::{
    ElementBuilder, ElementsBuilder, GeneratorBuilder, MoveBuilder, NumberText, RuleBuilder,
};
use kfrac::geometry::{DVec2, Direction};
use kfrac::graph::Graph;
use kfrac::rule::Placement;
use proptest::collection::vec;
use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL};
use proptest::prelude::*;

use super::common;

/// A number or expression, of which one in thirty is arbitrary text or an arbitrary number.
fn number() -> impl Strategy<Value = NumberText> {
    prop_oneof![
        12 => (-2..3i32).prop_map(NumberText::from),
        12 => (-2.0..2.0).prop_map(NumberText::from),
        4 => prop::sample::select(&["1/3", "cos(7)"][..]).prop_map(NumberText::from),
        1 => prop::num::f64::ANY.prop_map(NumberText::from),
        1 => ".{0,6}".prop_map(NumberText::from),
    ]
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof![12 => Just("a".to_owned()), 1 => "(.|\n){0,6}"]
}

fn elements() -> impl Strategy<Value = ElementsBuilder> {
    let flags = (
        0..4usize,
        any::<[bool; 4]>(),
        proptest::option::weighted(0.2, name()),
    );
    let element = (
        number(),
        number(),
        flags,
        proptest::option::weighted(0.2, (number(), number())),
    );
    (vec(element, 0..4), 0..9u8).prop_map(|(list, ends)| {
        let start = ElementsBuilder::new().point((0, 0));
        let elements = list.into_iter().fold(start, |all, (x, y, flags, from)| {
            let (direction, [plain, fertile, visible, connected], generator) = flags;
            if plain {
                return all.point((x, y));
            }
            let mut element = ElementBuilder::to((x, y))
                .direction(Direction::ALL[direction])
                .fertile(fertile)
                .visible(visible)
                .connected(connected);
            if let Some(from) = from {
                element = element.from(from);
            }
            if let Some(name) = generator.filter(|_| fertile) {
                element = element.generator(name);
            }
            all.element(element)
        });
        match ends {
            0 => elements.closed(true),
            _ => elements.point((1, 0)),
        }
    })
}

fn generator() -> impl Strategy<Value = GeneratorBuilder> {
    let placement = prop::sample::select(
        &[
            Placement::Stays,
            Placement::Seeds,
            Placement::SeedsAsInitiator,
        ][..],
    );
    let parts = vec((placement, elements()), 1..3);
    let distribution = prop_oneof![
        9 => Just(NumberText::from("uniform(-1, 1)")),
        1 => number(),
    ];
    let variables = vec(("[s-z]", distribution), 0..2);
    let moves = vec((number(), number(), vec(0..5u32, 0..2)), 0..2);
    (parts, variables, moves).prop_map(|(parts, variables, moves)| {
        let generator = GeneratorBuilder::new();
        let generator = parts
            .into_iter()
            .fold(generator, |all, (placement, elements)| {
                all.part(placement, elements)
            });
        let generator = variables
            .into_iter()
            .fold(generator, |all, (name, number)| all.random(name, number));
        moves.into_iter().fold(generator, |all, (a, b, points)| {
            all.moves(
                MoveBuilder::new()
                    .rotate(a.clone())
                    .scale((a, b))
                    .points(points),
            )
        })
    })
}

fn rule() -> impl Strategy<Value = RuleBuilder> {
    let parts = (elements(), vec(generator(), 1..3), name());
    let parameters = vec(("[p-z]", -2.0..2.0), 0..2);
    let select = (
        0..4u8,
        vec((name(), number()), 1..3),
        ".{0,5}",
        0..2_000_000u32,
    );
    (parts, parameters, select).prop_map(|((initiator, generators, name), parameters, select)| {
        let rule = RuleBuilder::new(initiator);
        let names = ["a".to_owned(), name].into_iter();
        let rule = names.zip(generators).fold(rule, |all, (name, generator)| {
            all.generator(name, generator)
        });
        let rule = parameters.into_iter().fold(rule, |all, (name, value)| {
            all.parameter(Parameter::new(name, value))
        });
        let (kind, entries, condition, steps) = select;
        let names = entries.iter().map(|(name, _)| name.clone());
        match kind {
            0 => rule.select_by_index(names),
            1 => rule.select_at_random(entries),
            2 => rule.select_first(names.map(|name| (condition.clone(), name)), "a"),
            _ => rule.steps(steps),
        }
    })
}

proptest! {
    #![proptest_config(common::cases(512))]

    /// A rule that builds can be saved and compiled; any other is refused with errors.
    #[test]
    fn nothing_that_is_built_panics(rule in rule()) {
        match rule.build() {
            Ok(built) => {
                let text = rule.document().unwrap().to_yaml();
                let again = common::document_of(&text).resolve(&[]).unwrap().0;
                prop_assert_eq!(&**again.rule().unwrap(), &built);
                let _may_not_be_finite = Graph::compile(&Arc::new(built), 2);
            }
            Err(errors) => prop_assert!(errors.has_errors()),
        }
    }

    #[test]
    fn numbers_stay_the_same_to_the_last_bit(
        points in vec(prop::array::uniform2(NORMAL | SUBNORMAL | POSITIVE | NEGATIVE), 2..6)
    ) {
        let rule = RuleBuilder::new(points.clone()).generator("a", [(0, 0), (1, 0)]).build().unwrap();
        let points: Vec<_> = points.into_iter().map(DVec2::from).collect();
        prop_assert_eq!(rule.initiator_points(), points);
    }
}
