//! Tests of the import of Fractint's files.

use std::sync::Arc;

use crate::diagnostic::{Diagnostics, Place, Source};
use crate::graph::Graph;
use crate::model::Model;

use super::commands::{self, Command, Heading};
use super::entries::{self, Entry};
use crate::import::{ImportOptions, Imported, SourceFormat};

fn read(source: &Arc<Source>, format: SourceFormat) -> (Vec<Imported>, Diagnostics) {
    crate::import::read(source, format, &ImportOptions::default())
}

fn source(text: &str) -> Arc<Source> {
    Source::new("some/test.ifs", text)
}

fn entries_of(text: &str) -> (Vec<Entry>, Diagnostics) {
    let mut stray = Diagnostics::default();
    let entries = entries::of(&source(text), &mut stray);
    (entries, stray)
}

/// Returns the messages with the texts at their places.
fn messages(found: &Diagnostics) -> Vec<(&str, &str)> {
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
        messages(&stray),
        [
            ("this belongs to no entry", "lost"),
            ("this belongs to no entry", "found")
        ]
    );
    let names: Vec<_> = entries.iter().map(|entry| &entry.name[..]).collect();
    assert_eq!(names, ["One", "Two"]);
    assert_eq!(messages(&entries[1].found), [("Two is not closed", "Two")]);
}

#[test]
fn commands_have_numbers() {
    let (entries, _) = entries_of("x { F\\36.5@iq2>10<3c1/i7|!gdm[+-]x@.5\\+/c<'1.5.2 }");
    let mut found = Diagnostics::default();
    let commands = commands::of(&entries[0].words[0], &mut found);
    assert!(found.is_empty(), "{found}");
    let written: Vec<_> = commands
        .iter()
        .map(|(_, place)| &place.source().text()[place.range()])
        .collect();
    assert_eq!(
        written,
        [
            "F", "\\36.5", "@iq2", ">10", "<3", "c1", "/i7", "|", "!", "g", "d", "m", "[", "+",
            "-", "]", "x", "@.5", "\\", "+", "/", "c", "<", "'", "1", ".", "5", ".", "2"
        ]
    );
    let formulas: Vec<_> = commands
        .iter()
        .filter_map(|(command, _)| match command {
            Command::Scale(factor) | Command::Degrees(factor) => Some(factor.formula()),
            _ => None,
        })
        .collect();
    assert_eq!(formulas, ["36.5", "1/sqrt(2)", "-1/7", "0.5", "0", "0"]);
    let step = |heading, drawn| Command::Step { heading, drawn };
    let expected = [
        step(Heading::Units, true),
        Command::Shift { by: 10, down: true },
        Command::Shift { by: 3, down: false },
        Command::Colour(1),
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
        Command::Turn(1),
        Command::Colour(0),
        Command::Shift { by: 0, down: false },
        Command::Other('\''),
    ];
    let plain = commands.into_iter().map(|(command, _)| command);
    let plain = plain.filter(|it| !matches!(it, Command::Scale(_) | Command::Degrees(_)));
    assert_eq!(plain.take(expected.len()).collect::<Vec<_>>(), expected);
}

#[test]
fn scales_without_their_numbers_are_told() {
    let (entries, _) = entries_of("x { F@xc@0F@I0F/I0 }");
    let mut found = Diagnostics::default();
    commands::of(&entries[0].words[0], &mut found);
    let expected = [
        ("@ takes a number above 0", "@"),
        ("@ takes a number above 0", "@0"),
        ("@ takes a number above 0", "@I0"),
        ("this angle is not finite", "/I0"),
    ];
    assert_eq!(messages(&found), expected);
}

#[test]
fn systems_of_maps_are_read() {
    let (imported, stray) = read(
        &source("fern { ; Barnsley\n 0 0 0 .16 0 0 .01\n .85 .04 -.04 .85 0 1.6 .85 }"),
        SourceFormat::Ifs,
    );
    assert!(
        stray.is_empty() && imported[0].found.is_empty(),
        "{imported:?}"
    );
    let document = imported[0].document.as_ref().expect("it is right");
    let (model, _) = document.resolve(&[]).expect("it is right");
    let description = &model.metadata().description;
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
    // Coefficients in the order of x' = a x + b y + e, y' = c x + d y + f.
    assert_eq!(
        maps[1].affine.to_cols_array(),
        [0.85, -0.04, 0.04, 0.85, 0.0, 1.6]
    );
}

#[test]
fn systems_in_space_are_read() {
    let text = "3dfern (3D) {
  .00  .00 0 .0 .18 .0 0  0.0 0.00 0 0.0 0 .01
  .85  .00 0 .0 .85 .1 0 -0.1 0.85 0 1.6 0 .85
  .20 -.20 0 .2 .20 .0 0  0.0 0.30 0 0.8 0 .07
 -.20  .20 0 .2 .20 .0 0  0.0 0.30 0 0.8 0 .07
}
few (3d) {
 .5 0 0 0 .5 0 0 0 .5 0 0 0 .5
 .5 0 0 0 .5 0 0 0 .5 1 0 .5
 .5 0 0 0 .5 0 0 0 .5 0 1 0 .5
}
flat { .5 0 0 0 .5 0 0 0 .5 0 0 0 1 }
";
    let (imported, stray) = read(&source(text), SourceFormat::Ifs);
    let [fern, few, flat] = &imported[..] else {
        panic!("{imported:?}");
    };
    assert!(stray.is_empty() && fern.found.is_empty(), "{fern:?}");
    let document = fern.document.as_ref().expect("it is right");
    let Ok((Model::IfsInSpace(system), _)) = document.resolve(&[]) else {
        panic!("it is a system in space");
    };
    let map = &system.ifs().maps()[1];
    assert_eq!(map.weight, Some(0.85));
    // Coefficients in the order of x' = a x + b y + c z + j, and so on: the stem bends towards the viewer.
    assert_eq!(
        map.affine.to_cols_array(),
        [
            0.85, 0.0, 0.0, 0.0, 0.85, -0.1, 0.0, 0.1, 0.85, 0.0, 1.6, 0.0
        ]
    );
    assert!(few.document.is_none() && flat.document.is_none());
    let short = few.found.iter().next().expect("it has a mistake");
    let place = short.place().expect("it has a place");
    assert_eq!(
        short.message(),
        "this line has 12 numbers, and a map has 13"
    );
    assert_eq!(place.line(), 9);
    let flat = flat.found.to_string();
    assert!(flat.contains("(3D) after the name"), "{flat}");
}

#[test]
fn systems_that_cannot_be_told_are_named_and_the_others_read() {
    let (imported, _) = read(
        &source(
            "space (3D) { 1 }\nodd (4D) { 1 }\nword { 1 two 3 4 5 6 7 }\nshort { .5 0 0 .5 0 0 1 .5 0 }\n\
             grows { 2 0 0 2 0 0 1 }\nnone { }\nnever { .5 0 0 .5 0 0 1 .5 0 0 .5 1 0 0 }\ninf { .5 0 0 .5 inf 1e999 1 }",
        ),
        SourceFormat::Ifs,
    );
    let read: Vec<_> = imported
        .iter()
        .map(|entry| {
            (
                &entry.name[..],
                entry.document.is_some(),
                messages(&entry.found),
            )
        })
        .collect();
    let expected = [
        (
            "space",
            false,
            vec![("the last map has 1 of 13 numbers", "1")],
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
    assert_eq!(read, expected);
}

/// Returns the only entry of an L-system file as YAML, from `angle` on.
fn lsystem(text: &str) -> String {
    let (imported, stray) = read(&Source::new("test.l", text), SourceFormat::LSystems);
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
    for text in [
        "Dragon {\nAngle 8 ; 45 degrees\nAxiom FX\nF=\ny=+FX--FY+\nx = -FX++FY-\n}",
        "Dragon { angle 8 axiom fx F= Y=+fx--fy+ X =-fx++fy- }",
    ] {
        assert_eq!(lsystem(text), dragon);
    }
    // Long rules are split into parts.
    let koch = "angle: 360/6\naxiom: F\nproductions: {F: F+F--F+F}\n";
    assert_eq!(lsystem("Koch { axiom F F=F+F F=--F+F\n angle 6 }"), koch);
    assert_eq!(lsystem("Koch { axiom F\n F F+F--F+F\n angle = 6 }"), koch);
    let kept = "angle: 360/6\naxiom: \"[F]\"\nproductions: {F: F}\n";
    assert_eq!(lsystem("Kept { angle 6 axiom [F] X=F+ }"), kept);
}

#[test]
fn commands_become_symbols_with_meanings() {
    assert_eq!(
        lsystem("a { angle 6 axiom F[@IQ2!GF]|FX F=F@2F X={.F Y=F }"),
        "angle: 360/6\naxiom: F[@(1/sqrt(2))!GF]|FX\nproductions: {F: F@(2)F, X: \"{.F\"}\nsymbols:\n  \
         \"@(s)\": {scale: s}\n  \"!\": reflect\n  G: move\n  \"{\": nothing\n  .: nothing\n"
    );
    // A half turn is no multiple of an odd fraction of a turn: the largest turn below is taken.
    assert_eq!(
        lsystem("a { angle 5 axiom F|F F=FF }"),
        "angle: 360/5\naxiom: F|F\nproductions: {F: FF}\nsymbols:\n  \"|\": {turn: -180 + 180/5}\n"
    );
    // The half turn is not reversed, other turns are.
    assert_eq!(
        lsystem("a { angle 5 axiom F|!F F=FF }"),
        "angle: 360/5\naxiom: F|!F\nproductions: {F: FF}\nsymbols:\n  \"|\": {rotate: -180 + 180/5}\n  \
         \"!\": reflect\n"
    );
    // The other heading turns by degrees.
    assert_eq!(
        lsystem("a { angle 5 axiom D\\36.5M/12D+ D=DD }"),
        "angle: 360/5\naxiom: D+(36.5)M-(12)D\nproductions: {D: DD}\nsymbols: {D: draw, M: move}\n"
    );
    assert_eq!(
        lsystem("a { angle 5 axiom D\\36.5+ D=DD +=D }"),
        "angle: 360/5\naxiom: D/(36.5)+\nproductions: {D: DD, +: D}\nsymbols:\n  D: draw\n  \
         /(a): {turn: a}\n  +: nothing\n"
    );
    assert_eq!(
        lsystem("a { angle 4 axiom F+D/30M D=DD }"),
        "angle: 360/4\naxiom: F+D/(-30)M\nproductions: {D: DD}\nsymbols:\n  D: [swap, draw, swap]\n  \
         /(a):\n    - swap\n    - {turn: a}\n    - swap\n  M: [swap, move, swap]\n"
    );
    // Commands with numbers may have rules, and keep their meaning in the last step.
    let system = |text: &str| match lsystem(text).split_once("style:") {
        Some((system, _)) => system.to_string(),
        None => panic!("{text} has colours"),
    };
    assert_eq!(
        system("a { angle 4 axiom F<1>2 F=F<1F@2 <= @=F }"),
        "angle: 360/4\naxiom: F;(1)h(-2)\nproductions: {F: F;(1)F@(2), ;(n): \"\", \"@(s)\": F}\nsymbols:\n  \
         ;(n): {shift_colour: n}\n  h(n): {shift_colour: n}\n  \"@(s)\": {scale: s}\n"
    );
    assert_eq!(
        system("a { angle 4 axiom D\\30D/60 /=D D=DC2D C=D }"),
        "angle: 360/4\naxiom: D/(30)Dg(-60)\nproductions: {g(a): D, D: D'(1)D, \"'(n)\": D}\nsymbols:\n  D: \
         draw\n  /(a): {turn: a}\n  g(a): {turn: a}\n"
    );
    // Symbols without a meaning may have rules.
    assert_eq!(
        lsystem("a { angle 4 axiom F(F),'F: F=FF (=F) '=F+F :=F }"),
        "angle: 360/4\naxiom: FaFbcdFe\nproductions: {F: FF, a: Fb, d: F+F, e: F}\n"
    );
}

#[test]
fn colours_are_those_of_the_palette() {
    assert_eq!(
        lsystem("a { angle 4 axiom FC1FC12F F=Fc267F }"),
        "angle: 360/4\naxiom: F'(1)F'(3)F\nproductions: {F: F'(2)F}\nstyle:\n  \
         background: \"#000000\"\n  palette: [\"#ffffff\", \"#0000aa\", \"#55ffff\", \"#ff5555\"]\n"
    );
    // Where commands add to the index, any colour may occur.
    let shifted = lsystem("a { angle 4 axiom c7F<2F>3F<0F F=FF }");
    assert!(shifted.contains("'(248)F;(2)F;(-3)FF"), "{shifted}");
    assert!(shifted.contains(";(n): {shift_colour: n}"), "{shifted}");
    let colours = shifted
        .match_indices('#')
        .map(|(at, _)| &shifted[at..at + 7]);
    let colours: Vec<_> = colours.collect();
    assert_eq!(colours.len(), 1 + 256);
    assert_eq!(colours[..4], ["#000000", "#ffffff", "#000000", "#141414"]);
}

#[test]
fn the_step_that_is_taken_draws_something() {
    for (entry, most, step) in [
        ("F F=", 20_000, 0),
        ("F F=X X=F", 20_000, 12),
        ("X F=X X=F", 20_000, 11),
        ("X X=Y Y=FFFFFF", 5, 2),
        ("X X=Y Y=FFFFFF", 6, 12),
        ("X F=FF X=+", 20_000, 12),
    ] {
        let text = format!("a {{ angle 4 axiom {entry} }}");
        let (imported, _) = read(&Source::new("test.l", text), SourceFormat::LSystems);
        let document = imported[0].document.as_ref().expect("it is right");
        let (Model::LSystem(system), _) = document.resolve(&[]).expect("it is right") else {
            panic!("it is an L-system");
        };
        assert_eq!(system.deepest(12, most), step, "{entry}");
    }
}

/// The two headings are independent; both are saved, and both are reversed.
#[test]
fn the_turtle_has_two_headings() {
    let (imported, _) = read(
        &Source::new("test.l", "a { angle 4 axiom F+\\45D[+F\\45D]FD!+\\45FD|F }"),
        SourceFormat::LSystems,
    );
    assert!(imported[0].found.is_empty(), "{}", imported[0].found);
    let document = imported[0].document.as_ref().expect("it is right");
    let (Model::LSystem(system), _) = document.resolve(&[]).expect("it is right") else {
        panic!("it is an L-system");
    };
    let word = system.word(0, 0, 1000).expect("it is short");
    let drawn = system.draw(&word).elements;
    let degrees = drawn.iter().map(|line| {
        let [from, to] = line.frame.ends();
        let along = to - from;
        libm::round(along.y.atan2(along.x).to_degrees()) + 0.0
    });
    let expected = [0.0, 45.0, 180.0, 90.0, 90.0, 45.0, 0.0, 0.0, 180.0];
    assert_eq!(degrees.collect::<Vec<_>>(), expected);
    // The graph grows the lines that the turtle draws.
    let graph = Graph::of_lsystem(&system, 0, 0, 1000).expect("it is short");
    assert_eq!(graph.initiators.len(), 1);
    let grown = graph.initiators[0].instances.iter().map(|it| it.frame);
    assert!(grown.eq(drawn.iter().map(|line| line.frame)));
}

#[test]
fn lsystems_that_cannot_be_told_are_named_and_the_others_read() {
    let text = "nothing { }\nunangled { axiom F }\nsharp { angle 2 axiom F }\n\
                extra { angle 4 axiom F F F=F + F }\n\
                bracket { angle 4 axiom F]F F=F[[F }\n\
                good { angle 4 axiom F F=FF }\nturned { angle 4 axiom F\\10F F=FF }\ncoloured { angle 4 axiom c3[F] F=FF }\n\
                quote { angle 4 axiom F'F }\ntwo { angle 4 axiom FD }\nback { angle 5 axiom F|!F }";
    let (imported, _) = read(&Source::new("test.l", text), SourceFormat::LSystems);
    let read = imported.iter().map(|entry| {
        (
            &entry.name[..],
            entry.document.is_some(),
            messages(&entry.found),
        )
    });
    let expected = [
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
            "extra",
            false,
            vec![
                ("'F' is not understood", "F"),
                ("'+' is not understood", "+"),
                ("'F' is not understood", "F"),
            ],
        ),
        (
            "bracket",
            false,
            vec![
                ("no bracket is open here", "]"),
                ("this bracket is not closed", "["),
                ("this bracket is not closed", "["),
            ],
        ),
        ("good", true, vec![]),
        ("turned", true, vec![]),
        ("coloured", true, vec![]),
        ("quote", true, vec![]),
        ("two", true, vec![]),
        ("back", true, vec![]),
    ];
    assert_eq!(read.collect::<Vec<_>>(), expected);
    // Errors are reported at the character, not at the entry.
    let places = imported[4].found.iter().map(|found| {
        let place = found.place().expect("every mistake has its place");
        (place.line(), place.column())
    });
    assert_eq!(places.collect::<Vec<_>>(), [(5, 26), (5, 32), (5, 33)]);
}
