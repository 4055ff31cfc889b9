//! Conversions of random rules, against the originals.

use kfrac::convert::{Keeps, convert};
use kfrac::extent::NoLimit;
use kfrac::grow::Growth;
use kfrac::measure::{Subject, Subset};
use kfrac::model::Kind;
use proptest::prelude::*;

use super::{assert_same, model};
use crate::common::document_of;
use crate::common::random_systems::{random_similar_system, random_system};
use crate::laws::rules::{self, Features};

/// Asserts that conversions of a file have its approximants, and its limit set.
fn converts(text: &str) {
    let model = model(&document_of(text));
    let Ok(graph) = model.compile(3) else { return };
    for to in Kind::ALL.into_iter().filter(|to| *to != model.kind()) {
        if let Ok(document) = convert(&model, to, Keeps::Approximants) {
            let other = super::model(&document).compile(3).unwrap();
            for steps in 0..3 {
                let set = Subset::Approximant(Growth::steps(steps).max_elements(5_000));
                match [&graph, &other].map(|graph| Subject::new(graph, set).is_ok()) {
                    [true, true] => assert_same(text, [&graph, &other], set),
                    // One of them has more elements, or holds points that are too far away.
                    has => assert!(
                        steps > 0 || has[0] == has[1],
                        "{text} to {to:?}: step {steps}"
                    ),
                }
            }
        }
        if let Ok(document) = convert(&model, to, Keeps::Limit) {
            let other = super::model(&document).compile(3).unwrap();
            match other.limit() {
                Ok(_) => assert_same(text, [&graph, &other], Subset::Limit),
                Err(error) => assert!(!matches!(error, NoLimit::DoesNotShrink), "{text}: {error}"),
            }
        }
    }
}

proptest! {
    #![proptest_config(crate::common::cases(24))]

    #[test]
    fn random_rules_keep_their_sets(text in rules::rule(Features::REGULAR)) {
        converts(&text);
    }

    #[test]
    fn random_systems_keep_their_sets(seed in any::<u64>(), is_similar in any::<bool>()) {
        let system = match is_similar {
            true => random_similar_system(seed),
            false => random_system(seed),
        };
        converts(&format!("kind: ifs\n{system}"));
    }
}
