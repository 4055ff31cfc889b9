//! L-systems: words by published derivations, and drawings of the turtle.

mod contexts;
mod laws;
mod looks;
mod rules;
mod space;
mod stamps;
mod turtle;

use std::sync::Arc;

use crate::common::{self, document_of};
use kfrac::lsystem::{LSystem, RewriteError};
use kfrac::model::Model;

/// Limit of the number of elements.
const MOST: u64 = 1_000_000;

/// Returns an L-system from text.
fn system(text: &str) -> Arc<LSystem> {
    let (model, _) = document_of(&format!("kind: lsystem\n{text}"))
        .resolve(&[])
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    match model {
        Model::LSystem(system) => system,
        other => panic!("{text} is a {}", other.kind().name()),
    }
}

/// Returns the words of the first steps.
fn words(text: &str, steps: u32) -> Vec<String> {
    let system = system(text);
    let word = |step| system.word(step, 0, MOST).unwrap().to_text(&system);
    (0..=steps).map(word).collect()
}

/// Prusinkiewicz & Lindenmayer 1990, section 1.2.
#[test]
fn algae_grow_as_in_the_book() {
    let words = words("axiom: B\nproductions: {A: AB, B: A}\n", 5);
    assert_eq!(words, ["B", "A", "AB", "ABA", "ABAAB", "ABAABABA"]);
}

#[test]
fn blanks_mean_nothing_and_productions_have_two_spellings() {
    let one = words("axiom: ' F  + F'\nproductions: {F: 'F - [F ]'}\n", 2);
    let other = words("axiom: F+F\nproductions: ['F->F-[F]']\n", 2);
    assert_eq!(one, other);
    assert_eq!(one[1], "F-[F]+F-[F]");
}

/// Prusinkiewicz & Lindenmayer 1990, section 1.10.1: the derivation of the first parametric L-system.
#[test]
fn parameters_are_as_in_the_book() {
    let text = "axiom: B(2)A(4,4)\nproductions:\n\
                - 'A(x,y) : y <= 3 -> A(x*2, x+y)'\n\
                - 'A(x,y) : y > 3 -> B(x)A(x/y, 0)'\n\
                - 'B(x) : x < 1 -> C'\n\
                - 'B(x) : x >= 1 -> B(x-1)'\n";
    assert_eq!(
        words(text, 4),
        [
            "B(2)A(4, 4)",
            "B(1)B(4)A(1, 0)",
            "B(0)B(3)A(2, 1)",
            "CB(2)A(4, 3)",
            "CB(1)A(8, 7)",
        ]
    );
}

#[test]
fn what_no_production_fits_is_kept() {
    let text = "axiom: A(3)B\nproductions: ['A(n) : n > 1 -> A(n - 1)']\n";
    assert_eq!(words(text, 5)[5], "A(1)B");
}

#[test]
fn successors_may_be_empty() {
    let words = words("axiom: ABA\nproductions: {A: '', B: 'ABA'}\n", 2);
    assert_eq!(words, ["ABA", "ABA", "ABA"]);
}

/// The first production that fits is taken, those with contexts before those without.
#[test]
fn the_order_of_productions_decides() {
    let text = "axiom: XAA(2)\nproductions:\n\
                - 'A -> B'\n\
                - 'X < A -> C'\n\
                - 'A(n) : n == 2 -> D'\n\
                - 'A(n) : n > 1 -> E'\n";
    assert_eq!(words(text, 1)[1], "XCD");
}

/// Productions with weights 3, 1 and 0 are drawn within four standard errors of their shares.
#[test]
fn draws_have_the_frequencies_of_their_weights() {
    const COUNT: usize = 40_000;
    let axiom = "F".repeat(COUNT);
    let text = format!(
        "axiom: {axiom}\nproductions: {{F: [{{to: A, weight: 3}}, B, {{to: C, weight: 0}}]}}\n"
    );
    let system = system(&text);
    assert!(!system.is_deterministic());
    let word = system.word(1, 5, MOST).unwrap().to_text(&system);
    let count = |of| word.chars().filter(|c| *c == of).count();
    #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
    let off = (count('A') as f64 / COUNT as f64 - 0.75).abs();
    assert!(off < 4.0 * (0.75f64 * 0.25).sqrt() / 200.0, "{off}");
    assert_eq!(count('A') + count('B'), COUNT);
    assert_ne!(word, system.word(1, 6, MOST).unwrap().to_text(&system));
}

/// A draw depends only on the path: neither the rest of the word nor being kept changes it.
#[test]
fn draws_hang_on_the_path() {
    let grow = |axiom: &str, x: &str| {
        let text = format!(
            "axiom: {axiom}\nproductions: {{F: ['F[+F]', 'FF', '[-F]F'], X: {x}}}\nsymbols: {{X: nothing}}\n"
        );
        let system = system(&text);
        let word = system.word(6, 1, MOST).unwrap().to_text(&system);
        word.replace(['X', 'Y', 'Z'], "")
    };
    assert_eq!(grow("XF", "X"), grow("XF", "YZ"));
    assert_eq!(grow("XF", "X"), grow("YF", "X"));
    assert_ne!(grow("XF", "X"), grow("F", "X"));
}

#[test]
fn lengths_are_told_before_anything_is_written() {
    let koch = system("axiom: F\nproductions: {F: F+F--F+F}\n");
    let error = koch.word(900, 0, 1024).unwrap_err();
    let (step, most, what) = (6, 1024, "elements");
    assert_eq!(error, RewriteError::TooLong { step, most, what });
    let said = "the word of step 6 has more than 1,024 elements; step 5 is the deepest";
    assert_eq!(error.to_string(), said);
    assert_eq!(koch.deepest(12, 1024), 5);
    // Nothing is drawn, but the word grows exponentially.
    let silent = system("axiom: A\nproductions: {A: AA}\n");
    let error = silent.word(1000, 0, MOST).unwrap_err();
    assert!(error.to_string().contains("modules"), "{error}");
}

/// Where lengths depend on arguments, growth ends where the limit is met.
#[test]
fn what_cannot_be_told_before_ends_at_the_limit() {
    let text = "axiom: F(1)\nproductions: ['F(x) : x > 0 -> F(x)F(x)']\n";
    let error = system(text).word(1000, 0, 1000).unwrap_err();
    let (step, most, what) = (10, 1000, "elements");
    assert_eq!(error, RewriteError::TooLong { step, most, what });
    let text = "axiom: F(1)\nproductions: ['F(x) -> F(1/(x - 3))F(x + 1)']\n";
    let error = system(text).word(5, 0, 1000).unwrap_err();
    assert!(matches!(
        error,
        RewriteError::NotFinite {
            step: 3,
            character: 'F',
            production: 0
        }
    ));
    let said = "step 3 makes an argument of 'F' that is not finite";
    assert_eq!(error.to_string(), said);
}

/// The word read module by module equals the one rewritten step by step, and fails at the same step.
#[test]
fn words_are_read_as_they_are_written() {
    for text in [
        "axiom: FX\nproductions: {X: X+YF+, Y: -FX-Y}\n",
        "axiom: F\nproductions: {F: [{to: 'F[+F]F', weight: 2}, 'F[-F]F', {to: FF, weight: 0.5}]}\n",
        "axiom: 'A(1)F(2)'\nproductions: ['A(l) : l < 40 -> F(l)[+A(l * 1.7)]A(l + 3)', 'F(l) : l > 5 -> F(l / 2)']\n",
        "axiom: AB\nproductions: {A: B, B: AB}\nsymbols: {A: draw, B: draw}\n",
        "axiom: 'F(3)'\nproductions: ['F(x) -> F(x / 2)F(1 / (x - 0.75))']\n",
        "axiom: baaa\nproductions: ['b < a -> b', 'b -> aa']\nsymbols: {a: draw, b: draw}\n",
    ] {
        let system = system(text);
        for (step, seed) in (0..14).zip([0, 1].into_iter().cycle()) {
            let mut modules = Vec::new();
            let read = system.read(step, seed, 2_000, |symbol, arguments| {
                modules.push((symbol, arguments.to_vec()));
            });
            match system.word(step, seed, 2_000) {
                Ok(word) => {
                    let written = word.modules(&system);
                    let written = written.map(|(symbol, arguments)| (symbol, arguments.to_vec()));
                    assert!(modules.into_iter().eq(written), "{text} at step {step}");
                }
                Err(error) => assert_eq!(read.unwrap_err(), error, "{text} at step {step}"),
            }
        }
    }
}

#[test]
fn what_changes_no_more_is_written_soon() {
    let kept = system("axiom: F\nproductions: {F: F}\n");
    assert_eq!(kept.word(1_000_000, 0, MOST).unwrap().len(), 1);
}
