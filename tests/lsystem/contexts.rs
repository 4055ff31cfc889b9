//! Contexts, by the examples of Prusinkiewicz & Lindenmayer 1990, section 1.8.

use cpu_time::ThreadTime;

use super::{MOST, system, words};

#[test]
fn a_signal_goes_through_a_string() {
    let text = "axiom: baaaa\nproductions: [b < a -> b, b -> a]\n";
    assert_eq!(words(text, 3), ["baaaa", "abaaa", "aabaa", "aaaba"]);
}

/// Figure 1.30 a: from the root to the tips.
#[test]
fn a_signal_goes_up_a_plant() {
    let text = "axiom: b[+a]a[-a]a[+a]a\nignore: +-\nproductions: [b < a -> b]\n";
    assert_eq!(
        words(text, 3)[1..],
        ["b[+b]b[-a]a[+a]a", "b[+b]b[-b]b[+a]a", "b[+b]b[-b]b[+b]b"]
    );
}

/// Figure 1.30 b: from the tips to the root, over the branches.
#[test]
fn a_signal_goes_down_a_plant() {
    let text = "axiom: a[+a]a[-a]a[+a]b\nignore: +-\nproductions: [a > b -> b]\n";
    assert_eq!(
        words(text, 3)[1..],
        ["a[+a]a[-a]b[+a]b", "a[+a]b[-a]b[+a]b", "b[+a]b[-a]b[+a]b"]
    );
}

/// The example of the text: BC < S > G[H]M in ABC[DE][SG[HI[JK]L]MNO].
#[test]
fn contexts_look_over_branches_and_into_them() {
    let replaced = |context: &str| {
        let text = format!("axiom: ABC[DE][SG[HI[JK]L]MNO]\nproductions: ['{context} -> X']\n");
        words(&text, 1)[1].contains('X')
    };
    for fits in [
        "BC < S > G[H]M",
        "ABC < S",
        "S > G[HI[J]]",
        "S > G[HI[J]L]MNO",
        "S > GM",
        "C < D",
        "G > [H]",
        "I > L",
        "GHI < J",
        "GHI < L",
    ] {
        assert!(replaced(fits), "{fits}");
    }
    for fits_not in [
        "BD < S",
        "E < S",
        "AB < S",
        "S > G[I]M",
        "S > GH",
        "S > G[H]N",
        "S > [G]",
        "L > M",
        "K > L",
        "O > X",
        "S > G[H][H]M",
    ] {
        assert!(!replaced(fits_not), "{fits_not}");
    }
}

/// A branch of a context matches the first that fits, and later ones are matched behind it.
#[test]
fn several_branches_are_looked_at_in_order() {
    let replaced = |context: &str| {
        let text = format!("axiom: 'A[B][C][D]E'\nproductions: ['{context} -> X']\n");
        words(&text, 1)[1].starts_with('X')
    };
    assert!(replaced("A > [C]E"));
    assert!(replaced("A > [B][D]E"));
    assert!(!replaced("A > [D][B]E"));
    assert!(!replaced("A > [E]"));
}

/// Section 1.10.2: contexts with arguments.
#[test]
fn contexts_have_arguments() {
    let text = "axiom: A(4)B(5)C(6)\nproductions:\n\
                - 'A(x) < B(y) > C(z) : x + y + z > 10 -> E((x + y)/2)F((y + z)/2)'\n";
    assert_eq!(words(text, 1)[1], "A(4)E(4.5)F(5.5)C(6)");
    let text = "axiom: A(1)[B(2)]A(3)C(4)\nproductions:\n\
                - 'A(u)A(v) < C(w) -> C(100*u + 10*v + w)'\n";
    assert_eq!(words(text, 1)[1], "A(1)[B(2)]A(3)C(134)");
}

#[test]
fn symbols_can_be_ignored() {
    let text = "axiom: F1+F0-F1\nignore: +-F\nproductions: ['1 < 0 > 1 -> X']\n";
    assert_eq!(words(text, 1)[1], "F1+FX-F1");
}

/// Deep and wide brackets need neither repeated scans nor the call stack.
#[test]
fn deep_and_wide_words_take_little_time() {
    let start = ThreadTime::now();
    let deep = format!("{}F{}", "F[".repeat(30_000), "]".repeat(30_000));
    let wide = format!("F{}F", "[F]".repeat(30_000));
    let flat = format!("F{}F", "+".repeat(60_000));
    for axiom in [deep, wide, flat] {
        let text = format!(
            "axiom: {axiom}\nignore: +\nproductions: ['F < F > F -> F', 'F > [F]F -> F']\n"
        );
        let system = system(&text);
        let word = system.word(3, 0, MOST).unwrap();
        assert_eq!(word.to_text(&system), axiom);
        assert!(system.draw(&word).elements.len() > 1);
    }
    assert!(start.elapsed().as_secs() < 20);
}
