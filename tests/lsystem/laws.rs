//! Random words and contexts, against matching by recursion on trees.

use kfrac::lsystem::LSystem;
use proptest::prelude::*;

use super::{MOST, system};

/// A branch: a sequence of letters, each with the branches after it, preceded by branches without a letter of
/// their own.
#[derive(Clone, Debug, Default)]
struct Tree {
    first: Vec<Tree>,
    rest: Vec<(char, Vec<Tree>)>,
}

impl Tree {
    fn text(&self) -> String {
        let branches = |all: &[Tree]| -> String {
            all.iter()
                .map(|tree| format!("[{}]", tree.text()))
                .collect()
        };
        let rest = self.rest.iter();
        let rest: String = rest
            .map(|(letter, all)| format!("{letter}{}", branches(all)))
            .collect();
        branches(&self.first) + &rest
    }
}

/// Generates trees of the letters a, b and c, and of + and -, which contexts ignore.
fn tree(letters: &'static str) -> impl Strategy<Value = Tree> {
    let letter = || proptest::sample::select(letters.chars().collect::<Vec<_>>());
    let leaf = proptest::collection::vec((letter(), Just(Vec::new())), 0..4);
    let leaf = leaf.prop_map(|rest| Tree {
        first: Vec::new(),
        rest,
    });
    leaf.prop_recursive(4, 24, 3, move |inner| {
        let branches = || proptest::collection::vec(inner.clone(), 0..3);
        let rest = proptest::collection::vec((letter(), branches()), 0..4);
        (branches(), rest).prop_map(|(first, rest)| Tree { first, rest })
    })
}

/// Returns a tree without the letters that contexts ignore: their branches belong to the preceding letter.
fn seen(tree: &Tree) -> Tree {
    let mut kept = Tree {
        first: tree.first.iter().map(seen).collect(),
        rest: Vec::new(),
    };
    for (letter, branches) in &tree.rest {
        let branches = branches.iter().map(seen);
        if "+-".contains(*letter) {
            let last = kept.rest.last_mut();
            last.map_or(&mut kept.first, |(_, all)| all)
                .extend(branches);
        } else {
            kept.rest.push((*letter, branches.collect()));
        }
    }
    kept
}

/// Returns whether a context fits a sequence that begins with branches and continues with letters.
fn fits(context: &Tree, branches: &[Tree], rest: &[(char, Vec<Tree>)]) -> bool {
    let mut branches = branches.iter();
    let found = context
        .first
        .iter()
        .all(|wanted| branches.any(|branch| fits(wanted, &branch.first, &branch.rest)));
    let Some(((letter, wanted), others)) = context.rest.split_first() else {
        return found;
    };
    let others = Tree {
        first: wanted.clone(),
        rest: others.to_vec(),
    };
    match rest.split_first() {
        Some(((own, behind), further)) => found && own == letter && fits(&others, behind, further),
        None => false,
    }
}

/// Appends all letters in the order of the text, with an X for each `a` with both contexts.
fn replaced(tree: &Tree, above: &str, left: &str, right: &Tree, text: &mut String) {
    let mut above = above.to_owned();
    for branch in &tree.first {
        replaced(branch, &above, left, right, text);
    }
    for (at, (letter, branches)) in tree.rest.iter().enumerate() {
        let is_one =
            *letter == 'a' && above.ends_with(left) && fits(right, branches, &tree.rest[at + 1..]);
        text.push(if is_one { 'X' } else { *letter });
        above.push(*letter);
        for branch in branches {
            replaced(branch, &above, left, right, text);
        }
    }
}

fn step(system: &LSystem) -> String {
    system.word(1, 0, MOST).unwrap().to_text(system)
}

proptest! {
    #![proptest_config(crate::common::cases(300))]

    #[test]
    fn contexts_fit_as_on_trees(word in tree("abc+-"), left in "[ab]{0,2}", right in tree("ab")) {
        let mut context = format!("a > {}", right.text());
        if right.text().is_empty() {
            context = "a".into();
        }
        if !left.is_empty() {
            context = format!("{left} < {context}");
        }
        let axiom = word.text();
        let text = format!("axiom: 'F{axiom}'\nignore: +-\nproductions: ['{context} -> X']\n");
        let grown = step(&system(&text));
        let first = ('F', word.first);
        let whole = Tree {
            first: Vec::new(),
            rest: std::iter::once(first).chain(word.rest).collect(),
        };
        let mut expected = String::new();
        replaced(&seen(&whole), "", &left, &right, &mut expected);
        let letters: String = grown.chars().filter(|c| c.is_alphabetic()).collect();
        prop_assert_eq!(letters, expected, "{}", text);
    }

    /// A word is read as it is written, and modules without a production are kept.
    #[test]
    fn words_are_read_as_they_are_written(word in tree("aF+-|")) {
        let axiom = format!("F(1, -0.5){}", word.text());
        let system = system(&format!("axiom: '{axiom}'\nproductions: {{}}\n"));
        prop_assert_eq!(step(&system), axiom);
    }
}
