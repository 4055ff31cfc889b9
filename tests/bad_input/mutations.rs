//! Files of the library with random mistakes.

use std::fs;
use std::time::Duration;

use cpu_time::ThreadTime;

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::{Diagnostics, Source};
use kfrac::document::Document;
use kfrac::grow::Growth;
use kfrac::model::{DrawnError, Model};
use kfrac::style::ColorBy;
use proptest::prelude::*;
use proptest::sample::Index;

/// Fragments that mistakes are made of, which have a meaning in rule files.
const PIECES: [&str; 58] = [
    "",
    " ",
    "\n",
    "\n  ",
    "\n- ",
    "\t",
    ":",
    ": ",
    ",",
    "[",
    "]",
    "{",
    "}",
    "(",
    ")",
    "&a ",
    "*a",
    "!t ",
    "#",
    " #",
    "\"",
    "'",
    "-",
    "+",
    "*",
    "/",
    "^",
    "%",
    "0",
    "1",
    "-1",
    "1e9",
    "1e308",
    "0.5",
    "i",
    "age",
    "step",
    "length",
    "sqrt",
    "generator",
    "initiator",
    "select",
    "use",
    "from",
    "to",
    "closed",
    "space: 3",
    "space: 2",
    ", 1/2",
    "[0, 0, 1]",
    "maps",
    "vertices",
    "solid",
    "scale",
    "rotate",
    "matrix",
    "true",
    "null",
];

/// Splits a text into words, signs and white space.
fn tokens(text: &str) -> Vec<String> {
    let class = |c: char| {
        if c.is_alphanumeric() || "_.".contains(c) {
            0
        } else if c == ' ' {
            1
        } else {
            2
        }
    };
    let mut tokens: Vec<String> = Vec::new();
    for character in text.chars() {
        match tokens.last_mut() {
            Some(last)
                if class(character) < 2 && last.chars().all(|c| class(c) == class(character)) =>
            {
                last.push(character);
            }
            _ => tokens.push(character.into()),
        }
    }
    tokens
}

#[derive(Clone, Debug)]
enum Mistake {
    Delete,
    Duplicate,
    Replace(&'static str),
    Insert(&'static str),
    Move(Index),
    Byte(u8),
}

fn mistake() -> impl Strategy<Value = Mistake> {
    let piece = || proptest::sample::select(PIECES.to_vec());
    prop_oneof![
        Just(Mistake::Delete),
        Just(Mistake::Duplicate),
        piece().prop_map(Mistake::Replace),
        piece().prop_map(Mistake::Insert),
        any::<Index>().prop_map(Mistake::Move),
        (32_u8..128).prop_map(Mistake::Byte),
    ]
}

fn rules() -> Vec<String> {
    let folders =
        ["rules", "lsystems", "ifs", "instancing"].map(|shelf| format!("library/{shelf}"));
    let files = folders.map(|folder| fs::read_dir(folder).unwrap());
    let mut paths: Vec<_> = { files.into_iter().flatten() }
        .map(|file| file.unwrap().path())
        .collect();
    paths.sort();
    paths
        .iter()
        .map(|path| fs::read_to_string(path).unwrap())
        .collect()
}

fn with_mistakes(text: &str, mistakes: &[(Index, Mistake)]) -> String {
    let mut tokens = tokens(text);
    for (at, mistake) in mistakes {
        if tokens.is_empty() {
            break;
        }
        let at = at.index(tokens.len());
        match mistake {
            Mistake::Delete => drop(tokens.remove(at)),
            Mistake::Duplicate => tokens.insert(at, tokens[at].clone()),
            Mistake::Replace(piece) => tokens[at] = (*piece).into(),
            Mistake::Insert(piece) => tokens.insert(at, (*piece).into()),
            Mistake::Move(to) => {
                let token = tokens.remove(at);
                tokens.insert(to.index(tokens.len() + 1), token);
            }
            Mistake::Byte(byte) => {
                let mut token: Vec<char> = tokens[at].chars().collect();
                if let Some(last) = token.last_mut() {
                    *last = char::from(*byte);
                }
                tokens[at] = token.into_iter().collect();
            }
        }
    }
    tokens.concat()
}

/// Reads, resolves and compiles a text; messages must have lines of bounded length.
fn digest(text: &str) -> Result<(), Diagnostics> {
    let catalogue = Catalogue::embedded();
    let source = Source::new("mutated.yaml", text);
    let (model, _) = Document::read(&source, &catalogue)?.resolve(&[])?;
    let growth = Growth::steps(2).max_elements(10_000);
    match model.drawn_in_space(Some(2), &growth, ColorBy::LastMap) {
        None => {}
        Some(Ok(drawn)) => {
            // Neither the limit nor a step of a set in space panics or hangs.
            let bounds = [drawn.graph.limit_bounds(), drawn.graph.bounds(2)];
            assert!(bounds.iter().flatten().all(|it| !it.min().is_nan()));
            return Ok(());
        }
        Some(Err(DrawnError::Compile(error))) => return Err(model.diagnostic(&error).into()),
        // It has too many elements to be held, or points that are not finite.
        Some(Err(_)) => return Ok(()),
    }
    match (model.compile(2), &model) {
        // An L-system that grows too long has no place in the file.
        (Ok(_), _) | (Err(_), Model::LSystem(_)) => Ok(()),
        (Err(error), _) => Err(model.diagnostic(&error).into()),
    }
}

proptest! {
    #![proptest_config(crate::common::cases(400))]

    #[test]
    fn no_mistake_panics_or_hangs(
        file in any::<Index>(),
        mistakes in proptest::collection::vec((any::<Index>(), mistake()), 1..4),
    ) {
        let rules = rules();
        let text = with_mistakes(&rules[file.index(rules.len())], &mistakes);
        let start = ThreadTime::now();
        if let Err(found) = digest(&text) {
            prop_assert!(found.has_errors());
            let said = found.to_string();
            prop_assert!(said.len() < 1 << 20, "{}", said);
            // A place is in the file or in the library.
            prop_assert!(found.iter().all(|one| one.place().is_some()), "{}\n{}", text, said);
            let mut places: Vec<_> = found.iter().map(|one| format!("{one:?}")).collect();
            places.sort();
            places.dedup();
            prop_assert_eq!(places.len(), found.len(), "{}\n{}", text, said);
        }
        prop_assert!(start.elapsed() < Duration::from_secs(60));
    }
}
