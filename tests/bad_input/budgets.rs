//! Budgets that all parts of a file share.

use super::costly::{CHECK, accepted};
use super::hostile::refused;

/// Returns a system with condensation sets.
fn with_sets(sets: impl IntoIterator<Item = String>) -> String {
    let sets: String = sets
        .into_iter()
        .map(|set| format!("  - {{fractal: {set}}}\n"))
        .collect();
    format!("kind: ifs\nmaps: [{{scale: 1/2}}]\ncondensation:\n{sets}")
}

/// Each set alone is within its own limits.
#[test]
fn all_sets_that_are_fractals_share_a_budget() {
    let nearly_turns = |number: usize| {
        let map = |number: usize| {
            let (angle, along) = (37 * number % 360, number % 9);
            format!(
                "{{matrix: [[0.99*cos({angle}), -1.4*sin({angle})], [0.69*sin({angle}), 0.99*cos({angle})]], \
                 translate: [{along}/9, 1]}}"
            )
        };
        let maps: Vec<String> = (0..12).map(|other| map(12 * number + other)).collect();
        format!(
            "{{kind: ifs, maps: [{}], steps: 0}}, map: {{scale: 1/9}}",
            maps.join(", ")
        )
    };
    accepted(&with_sets([nearly_turns(0)]), &CHECK);
    let too_many = with_sets((0..500).map(nearly_turns));
    refused(too_many.as_bytes(), "growing the sets of the file");
    let ferns = (0..100).map(|number| format!("fern, steps: 2, map: {{scale: 1/{}}}", number + 1));
    accepted(&with_sets(ferns), &CHECK);
}

#[test]
fn sets_in_space_share_it_too() {
    let text = |sets: String| {
        format!("kind: ifs\nspace: 3\nmaps: [{{scale: 1/2}}]\ncondensation:\n{sets}")
    };
    let set = |content: String| format!("  - {{fractal: {content}}}\n");
    let romanesco =
        |number: usize| format!("romanesco, steps: 0, map: {{scale: 1/{}}}", number + 1);
    accepted(&text((0..5).map(|it| set(romanesco(it))).collect()), &CHECK);
    let many: String = (0..900).map(|it| set(romanesco(it))).collect();
    refused(text(many).as_bytes(), "growing the sets of the file");
}

/// Choosing by index looks at one generator, and few conditions take no time to speak of.
#[test]
fn long_cycles_and_few_conditions_are_walked() {
    let names: Vec<String> = (0..64).map(|number| format!("g{number}")).collect();
    let generators = names
        .iter()
        .map(|name| format!("{name}: koch"))
        .collect::<Vec<_>>();
    let cycle = format!(
        "{{initiator: segment, generators: {{{}}}, select: {{by_index: [{}]}}}}, steps: 8",
        generators.join(", "),
        names.join(", ")
    );
    accepted(&with_sets([cycle]), &CHECK);
    let cases: String = (0..20)
        .map(|step| format!("{{when: i == {step}, use: levy}}, "))
        .collect();
    let cases = format!(
        "{{initiator: segment, generators: {{koch: koch, levy: levy}}, select: [{cases}{{use: koch}}]}}, steps: 8"
    );
    accepted(&with_sets([cases]), &CHECK);
}

#[test]
fn approximants_count_the_conditions_of_their_rules() {
    let rule = |cases: usize, operations: usize| {
        let cases = (0..cases).map(|number| {
            let sum = vec![format!("sin({number}*i)"); operations].join(" + ");
            format!("{{when: {sum} > {operations}, use: a}}")
        });
        let cases = cases.collect::<Vec<_>>().join(", ");
        format!(
            "initiator:\n  from: {{initiator: segment, generators: {{a: koch, b: levy}}, \
             select: [{cases}, {{use: b}}]}}\n  steps: 12\ngenerator: koch\n"
        )
    };
    accepted(&rule(3, 3), &CHECK);
    refused(rule(900, 40).as_bytes(), "choosing the generators");
}

#[test]
fn complex_formulas_count_as_they_are_written_out() {
    let rule = |count: usize, power: usize| {
        let point = format!("  - a^{power}/9 + b\n");
        format!(
            "params: {{a: [0.5, 0.3], b: [0.2, 0.7]}}\ninitiator: segment\ngenerator:\n  - [0, 0]\n{}  - [1, 0]\n",
            point.repeat(count)
        )
    };
    accepted(&rule(100, 3), &CHECK);
    refused(rule(9_000, 6).as_bytes(), "250,000 values");
}
