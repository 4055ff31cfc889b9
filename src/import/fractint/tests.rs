use std::sync::Arc;

use crate::diagnostic::{Diagnostics, Place, Source};
use crate::model::Model;

use super::commands::{self, Command, Heading};
use super::entries::{self, Entry};
use super::{Fractint, read};

fn source(text: &str) -> Arc<Source> {
    Source::new("some/test.ifs", text)
}

fn entries_of(text: &str) -> (Vec<Entry>, Diagnostics) {
    let mut stray = Diagnostics::default();
    let entries = entries::of(&source(text), &mut stray);
    (entries, stray)
}

/// Messages with the texts that they are about.
fn said(found: &Diagnostics) -> Vec<(&str, &str)> {
    let text = |place: &Place| -> std::ops::Range<usize> { place.range() };
    found
        .iter()
        .map(|found| {
            let place = found.place().expect("every mistake has its place");
            (found.message(), &place.source().text()[text(place)])
        })
        .collect()
}

#[test]
fn entries_have_names_remarks_words_and_comments() {
    let (entries, stray) = entries_of(
        "; a file\n First (3D) { ; the first\n a=B c ;; of two \n d }  Second{e}\ncomment { is no entry }\n",
    );
    assert!(stray.is_empty(), "{stray}");
    let [first, second] = &entries[..] else {
        panic!("{entries:?}");
    };
    assert_eq!(first.name, "First");
    assert_eq!(first.remark.as_deref(), Some("3D"));
    assert_eq!(first.comment(), "the first\nof two");
    let words = |entry: &Entry| -> Vec<_> {
        let words = entry.words.iter();
        words
            .map(|word| (word.text.clone(), word.starts_line))
            .collect()
    };
    let expected = [
        ("A", true),
        ("=", false),
        ("B", false),
        ("C", false),
        ("D", true),
    ];
    assert_eq!(
        words(first),
        expected.map(|(text, starts)| (text.to_owned(), starts))
    );
    assert_eq!(second.name, "Second");
    assert_eq!(second.remark, None);
    assert_eq!(words(second), [("E".to_owned(), true)]);
}

#[test]
fn what_belongs_to_no_entry_is_told() {
    let (entries, stray) = entries_of("lost\nOne { 1\n; { no brace\r\n } found\rTwo { 2");
    assert_eq!(
        said(&stray),
        [
            ("this belongs to no entry", "lost"),
            ("this belongs to no entry", "found")
        ]
    );
    let names: Vec<_> = entries.iter().map(|entry| &entry.name[..]).collect();
    assert_eq!(names, ["One", "Two"]);
    assert_eq!(said(&entries[1].found), [("Two is not closed", "Two")]);
}

#[test]
fn commands_have_numbers() {
    let (entries, _) = entries_of("x { F\\36.5@iq2>10<3c1/7|!gdm[+-]x@.5 }");
    let mut found = Diagnostics::default();
    let mut commands = commands::of(&entries[0].words[0], &mut found);
    assert!(found.is_empty(), "{found}");
    let formulas: Vec<_> = commands
        .extract_if(.., |command| matches!(command, Command::Scale(_)))
        .filter_map(|command| match command {
            Command::Scale(factor) => Some(factor.formula()),
            _ => None,
        })
        .collect();
    assert_eq!(formulas, ["1/sqrt(2)", "0.5"]);
    let step = |heading, drawn| Command::Step { heading, drawn };
    let expected = [
        step(Heading::Units, true),
        Command::Degrees(36.5),
        Command::Shift(-10.0),
        Command::Shift(3.0),
        Command::Colour(1.0),
        Command::Degrees(-7.0),
        Command::Back,
        Command::Reverse,
        step(Heading::Units, false),
        step(Heading::Degrees, true),
        step(Heading::Degrees, false),
        Command::Push,
        Command::Turn(1),
        Command::Turn(-1),
        Command::Pop,
        Command::Other('X'),
    ];
    assert_eq!(commands, expected);
}

#[test]
fn commands_without_their_numbers_are_told() {
    let (entries, _) = entries_of("x { F@xc\\I3@0F }");
    let mut found = Diagnostics::default();
    commands::of(&entries[0].words[0], &mut found);
    let expected = [
        ("@ takes a number", "@"),
        ("C takes a number", "c"),
        ("\\ takes a number", "\\I3"),
        ("@ takes a number", "@0"),
    ];
    assert_eq!(said(&found), expected);
}

#[test]
fn systems_of_maps_are_read() {
    let (imported, stray) = read(
        &source("fern { ; Barnsley\n 0 0 0 .16 0 0 .01\n .85 .04 -.04 .85 0 1.6 .85 }"),
        Fractint::Ifs,
    );
    assert!(
        stray.is_empty() && imported[0].found.is_empty(),
        "{imported:?}"
    );
    let document = imported[0].document.as_ref().expect("it is right");
    let (model, _) = document.resolve(&[]).expect("it is right");
    let description = &model.heading().description;
    assert_eq!(description.title.as_deref(), Some("fern"));
    assert_eq!(description.about.as_deref(), Some("Barnsley"));
    assert_eq!(
        description.source.as_deref(),
        Some("fern in test.ifs, for Fractint")
    );
    let Model::Ifs(system) = model else {
        panic!("it is a system");
    };
    let maps = system.ifs().maps();
    assert_eq!(maps.len(), 2);
    // x' = a x + b y + e, y' = c x + d y + f.
    assert_eq!(
        maps[1].affine.to_cols_array(),
        [0.85, -0.04, 0.04, 0.85, 0.0, 1.6]
    );
}

#[test]
fn systems_that_cannot_be_told_are_named_and_the_others_read() {
    let (imported, _) = read(
        &source(
            "space (3D) { 1 }\nodd (4D) { 1 }\nword { 1 two 3 4 5 6 7 }\nshort { .5 0 0 .5 0 0 1 .5 0 }\n\
             grows { 2 0 0 2 0 0 1 }\nnone { }\nnever { .5 0 0 .5 0 0 1 .5 0 0 .5 1 0 0 }\ninf { .5 0 0 .5 inf 1e999 1 }",
        ),
        Fractint::Ifs,
    );
    let told: Vec<_> = imported
        .iter()
        .map(|entry| {
            (
                &entry.name[..],
                entry.document.is_some(),
                said(&entry.found),
            )
        })
        .collect();
    let expected = [
        (
            "space",
            false,
            vec![("the maps are of space", "space (3D)")],
        ),
        ("odd", false, vec![("'(4D)' is not understood", "odd (4D)")]),
        ("word", false, vec![("'two' is not a number", "two")]),
        (
            "short",
            false,
            vec![("the last map has 2 of 7 numbers", ".5")],
        ),
        (
            "grows",
            false,
            vec![(
                "map 1 does not contract: over and over, it grows by the factor 2.000000",
                "grows",
            )],
        ),
        ("none", false, vec![("none has no maps", "none")]),
        (
            "never",
            true,
            vec![(
                "the probability 0 is not positive: this map is left out",
                "0",
            )],
        ),
        (
            "inf",
            false,
            vec![
                ("'inf' is not a number", "inf"),
                ("'1e999' is not a number", "1e999"),
            ],
        ),
    ];
    assert_eq!(told, expected);
}

/// The only entry of an L-system file as YAML, from `angle` on.
fn lsystem(text: &str) -> String {
    let (imported, stray) = read(&Source::new("test.l", text), Fractint::LSystems);
    assert!(stray.is_empty(), "{stray}");
    let [entry] = &imported[..] else {
        panic!("{imported:?}");
    };
    assert!(!entry.found.has_errors(), "{}", entry.found);
    let yaml = entry.document.as_ref().expect("it is right").to_yaml();
    yaml[yaml.find("angle").expect("it has an angle")..].to_owned()
}

#[test]
fn lsystems_are_read_line_by_line_or_word_by_word() {
    let dragon = "angle: 360/8\naxiom: FX\nproductions: {F: \"\", Y: +FX--FY+, X: -FX++FY-}\n";
    assert_eq!(
        lsystem("Dragon {\nAngle 8 ; 45 degrees\nAxiom FX\nF=\ny=+FX--FY+\nx = -FX++FY-\n}"),
        dragon
    );
    assert_eq!(
        lsystem("Dragon { angle 8 axiom fx F= Y=+fx--fy+ X =-fx++fy- }"),
        dragon
    );
    // Long rules come in parts.
    let koch = "angle: 360/6\naxiom: F\nproductions: {F: F+F--F+F}\n";
    assert_eq!(lsystem("Koch { axiom F F=F+F F=--F+F\n angle 6 }"), koch);
    assert_eq!(lsystem("Koch { axiom F\n F F+F--F+F\n angle = 6 }"), koch);
}

#[test]
fn commands_become_symbols_with_meanings() {
    assert_eq!(
        lsystem("a { angle 6 axiom F[@IQ2!GF]|F F=F@2F X={.F }"),
        "angle: 360/6\naxiom: F[@(1/sqrt(2))!GF]|F\nproductions: {F: F@(2)F, X: \"{.F\"}\nsymbols:\n  \
         \"@(s)\": {scale: s}\n  \"!\": reflect\n  G: move\n  \"{\": nothing\n  .: nothing\n"
    );
    // Half a turn is not whole in parts of an odd number: it is the largest turn below.
    assert_eq!(
        lsystem("a { angle 5 axiom F|F F=FF }"),
        "angle: 360/5\naxiom: F|F\nproductions: {F: FF}\nsymbols:\n  \"|\": {turn: -180 + 180/5}\n"
    );
    // The other heading is in degrees.
    assert_eq!(
        lsystem("a { angle 5 axiom D\\36.5M/12D D=DD }"),
        "angle: 360/5\naxiom: D+(36.5)M-(12)D\nproductions: {D: DD}\nsymbols: {D: draw, M: move}\n"
    );
    assert_eq!(
        lsystem("a { angle 4 axiom c7F<2F>3F F=FF }"),
        "angle: 360/4\naxiom: \"'(7)F;(2)F;(-3)F\"\nproductions: {F: FF}\nsymbols:\n  ;(n): {shift_colour: n}\n"
    );
}

#[test]
fn lsystems_that_cannot_be_told_are_named_and_the_others_read() {
    let text = "two { angle 4 axiom FD }\nnothing { }\nunangled { axiom F }\nsharp { angle 2 axiom F }\n\
                reserved { angle 4 axiom F +=F }\nextra { angle 4 axiom F F F=F + F }\n\
                back { angle 5 axiom F|!F }\nbracket { angle 4 axiom F] F=FF }\nquote { angle 4 axiom F'F }\n\
                good { angle 4 axiom F F=FF }\nturned { angle 4 axiom F\\10F F=FF }\ncoloured { angle 4 axiom c3[F] F=FF }";
    let (imported, _) = read(&Source::new("test.l", text), Fractint::LSystems);
    let told = imported.iter().map(|entry| {
        (
            &entry.name[..],
            entry.document.is_some(),
            said(&entry.found),
        )
    });
    let expected = [
        (
            "two",
            false,
            vec![("F or G and D or M have headings of their own", "two")],
        ),
        ("nothing", false, vec![("nothing has no axiom", "nothing")]),
        (
            "unangled",
            false,
            vec![("unangled has no angle", "unangled")],
        ),
        (
            "sharp",
            false,
            vec![("the angle '2' is not a whole number from 3", "2")],
        ),
        (
            "reserved",
            false,
            vec![("+ is a command and has no rule", "+")],
        ),
        (
            "extra",
            false,
            vec![
                ("'F' is not understood", "F"),
                ("'+' is not understood", "+"),
                ("'F' is not understood", "F"),
            ],
        ),
        (
            "back",
            false,
            vec![(
                "| of an odd angle always turns the same way, also after !",
                "back",
            )],
        ),
        (
            "bracket",
            false,
            vec![("no bracket is open here", "bracket")],
        ),
        (
            "quote",
            false,
            vec![("parentheses, commas and quotes cannot be symbols", "quote")],
        ),
        ("good", true, vec![]),
        (
            "turned",
            true,
            vec![("\\ and / do not turn F and G: they are left out", "turned")],
        ),
        (
            "coloured",
            true,
            vec![("colours are taken back at ], as headings are", "coloured")],
        ),
    ];
    assert_eq!(told.collect::<Vec<_>>(), expected);
}
