//! Sequences of turns.

use kfrac::grow::Growth;

use super::common::grown;
use super::data::reference;
use super::elements;

/// Returns for each element of the path, except the first, whether the path turns left there.
fn left_turns(id: &str, steps: u32) -> Vec<bool> {
    let reference = reference();
    let entry = reference.rules.iter().find(|entry| entry.id == id).unwrap();
    let fractals = grown(&entry.graph(steps), &Growth::steps(steps));
    let ways = elements(&fractals).map(|element| element.frame.ends());
    let ways: Vec<_> = ways.map(|[p0, p1]| p1 - p0).collect();
    let crosses = ways.windows(2).map(|pair| pair[0].perp_dot(pair[1]));
    crosses
        .inspect(|cross| assert!(cross.abs() > 1e-9, "{id} goes straight on"))
        .map(|cross| cross > 0.0)
        .collect()
}

#[track_caller]
fn assert_turns(name: &str, turns: &[bool], left: u8) {
    let expected = &reference().turns[name];
    let turns: Vec<_> = turns.iter().take(expected.len()).collect();
    let expected: Vec<_> = expected.iter().map(|&turn| turn == left).collect();
    assert_eq!(turns, expected.iter().collect::<Vec<_>>(), "{name}");
}

#[test]
fn the_dragon_turns_as_folded_paper() {
    for id in ["kaandorp_fig13_dragon_sweep", "dragon_sweep_by_direction"] {
        let turns = left_turns(id, 10);
        assert_eq!(turns.len(), 1023);
        assert_turns("dragon_A014577_right1_first32", &turns, 0);
        for (n, left) in (1u32..).zip(turns) {
            assert_eq!(left, (n >> n.trailing_zeros()) % 4 == 3, "{id}: turn {n}");
        }
    }
}

#[test]
fn the_koch_curve_turns_left_after_an_even_number_of_zeros() {
    let turns = left_turns("koch_curve", 5);
    assert_eq!(turns.len(), 1023);
    assert_turns("koch_A035263_left1_first32", &turns, 1);
    for (n, left) in (1u32..).zip(turns) {
        assert_eq!(left, n.trailing_zeros() % 2 == 0, "turn {n}");
    }
}

#[test]
fn the_terdragon_turns_by_the_lowest_digit_that_is_not_zero() {
    let turns = left_turns("terdragon", 6);
    assert_eq!(turns.len(), 728);
    assert_turns("terdragon_A060236_first27", &turns, 2);
    for (n, left) in (1u32..).zip(turns) {
        let mut odd = n;
        while odd % 3 == 0 {
            odd /= 3;
        }
        assert_eq!(left, odd % 3 == 2, "turn {n}");
    }
}

#[test]
fn the_arrowhead_turns_as_the_reference_says() {
    let turns = left_turns("kaandorp_fig9_sierpinski_arrowhead", 3);
    assert_eq!(turns.len(), 26);
    assert_turns("arrowhead_turns_n3_left1", &turns, 1);
}
