//! Pictures on paper: lengths in millimetres, and PDF as it is read.

use std::num::NonZero;

use kfrac::render::{Format, Size, Unit};
use kfrac::style::{Cap, ColorBy, Colour, Join, Width};

use super::readers::{operators, read};
use super::{Read, bounds, draw, library, total};

#[test]
fn a_pdf_has_the_paths_of_the_svg() {
    for (name, steps) in [
        ("koch", 6),
        ("monkeys-tree", 3),
        ("pythagoras", 6),
        ("hilbert", 4),
    ] {
        let rule = library(name);
        let strokes = |format| {
            let (_, bytes) = draw(&rule, steps, |options| options.format = format);
            read(format, &bytes)
        };
        let (svg, pdf) = (strokes(Format::Svg), strokes(Format::Pdf));
        assert_eq!(svg.len(), pdf.len(), "{name}");
        for (a, b) in svg.iter().zip(&pdf) {
            assert_eq!((a.vertices.len(), a.closed), (b.vertices.len(), b.closed));
            let pairs = a.vertices.iter().flatten().zip(b.vertices.iter().flatten());
            assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-3), "{name}");
        }
        let [left, top, right, bottom] = bounds(&pdf);
        assert!(left >= 0.0 && top >= 0.0 && right.max(bottom) <= 1024.0 * 25.4 / 96.0);
        assert!(total(&pdf) > 1.0);
    }
}

#[test]
fn a_pdf_has_colours_opacities_caps_and_joins() {
    let (_, bytes) = draw(&library("koch-snowflake"), 2, |options| {
        options.format = Format::Pdf;
        options.style.stroke = Some(Colour::of_rgba([255, 0, 0, 51]));
        options.style.fill = Some(Colour::of_rgba([0, 0, 255, 255]));
        options.style.background = Some(Colour::grey(51));
        options.style.width = Width::Pixels(3.0);
        options.style.cap = Cap::Square;
        options.style.join = Join::Miter;
    });
    let all = operators(&bytes);
    let of = |operator: &str| -> Vec<Vec<f64>> {
        let found = all.iter().filter(|it| it.0 == operator);
        let numbers = |operands: &Vec<lopdf::Object>| {
            let numbers = operands.iter().filter_map(|it| it.as_float().ok());
            numbers
                .map(|number| (f64::from(number) * 100.0).round() / 100.0)
                .collect()
        };
        found.map(|it| numbers(&it.1)).collect()
    };
    assert_eq!(of("rg"), [[0.2, 0.2, 0.2], [0.0, 0.0, 1.0]]);
    assert_eq!(of("RG"), [[1.0, 0.0, 0.0]]);
    assert_eq!(of("w"), [[300.0]]);
    assert_eq!(
        (of("J"), of("j"), of("M")),
        (vec![vec![2.0]], vec![vec![0.0]], vec![vec![4.0]])
    );
    // The fills are those of the background and of the snowflake, whose outline is drawn upon the latter.
    let count = |operator| of(operator).len();
    assert_eq!(["B", "f", "S", "gs"].map(count), [0, 2, 1, 1]);
    let document = lopdf::Document::load_mem(&bytes).unwrap();
    let page = document
        .get_dictionary(document.page_iter().next().unwrap())
        .unwrap();
    let resources = page.get(b"Resources").unwrap().as_dict().unwrap();
    let states = resources.get(b"ExtGState").unwrap().as_dict().unwrap();
    let (_, state) = states.iter().next().unwrap();
    let opacity = state
        .as_dict()
        .unwrap()
        .get(b"CA")
        .unwrap()
        .as_float()
        .unwrap();
    assert!((opacity - 0.2).abs() < 1e-6);
}

#[test]
fn a_translucent_outline_in_a_pdf_is_drawn_upon_its_fill() {
    // The path is longer than what is compressed at once.
    let (_, bytes) = draw(&library("koch-snowflake"), 8, |options| {
        options.format = Format::Pdf;
        options.style.stroke = Some(Colour::of_rgba([255, 0, 0, 51]));
        options.style.fill = Some(Colour::of_rgba([0, 0, 255, 255]));
    });
    let all = operators(&bytes);
    let ends = |it: &&(String, Vec<_>)| matches!(it.0.as_str(), "f" | "S" | "B");
    let found: Vec<_> = all.iter().filter(ends).map(|it| it.0.as_str()).collect();
    assert_eq!(found, ["f", "S"]);
    let paths: Vec<_> = { all.split(|it| ends(&it)) }
        .map(|path| {
            let is_drawn = |it: &&(String, Vec<_>)| matches!(it.0.as_str(), "m" | "l" | "h");
            path.iter().filter(is_drawn).collect::<Vec<_>>()
        })
        .collect();
    assert!(paths[0].len() > 3 * 4usize.pow(8) / 2);
    assert_eq!(paths[0], paths[1]);
    assert!(paths[2].is_empty());
}

#[test]
fn a_pdf_is_the_same_on_any_number_of_threads() {
    let koch = library("koch");
    let with = |threads: usize| {
        draw(&koch, 9, |options| {
            options.format = Format::Pdf;
            options.style.color_by = ColorBy::Index;
            options.threads = NonZero::new(threads).unwrap();
        })
    };
    let one = with(1);
    // The file consists of several streams, each of which continues the preceding one.
    assert!(one.1.windows(6).filter(|it| it == b"stream").count() > 6);
    assert!(one == with(2) && one == with(3));
    let edges: usize = read(Format::Pdf, &one.1)
        .iter()
        .map(|it| Read::edges(it).len())
        .sum();
    assert!(edges > 200_000, "{edges}");
}

#[test]
fn sizes_are_what_is_asked_for() {
    for format in [Format::Svg, Format::Pdf, Format::Dxf] {
        // A page of 30 m exceeds the units of a PDF.
        for long in [1505, 300_000] {
            let (picture, bytes) = draw(&library("koch"), 3, |options| {
                options.format = format;
                options.unit = Unit::Tenth;
                options.size = Size::Long(long);
                options.style.width = Width::Pixels(3.0);
            });
            assert_eq!(picture.size[0], long);
            let [left, _, right, _] = bounds(&read(format, &bytes));
            let millimetres = f64::from(long) / 10.0;
            let off = (right - left - (millimetres - 0.3)).abs();
            assert!(off < 1e-5 * millimetres + 0.01, "{format:?} {left} {right}");
        }
    }
}

#[test]
fn the_command_line_has_millimetres() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| super::common::said(folder.path(), arguments);
    let plot = ["grow", "koch", "--steps", "3", "--plot", "--size", "200mm"];
    let (code, said) = run(&[&plot[..], &["--stroke-width", "0.3mm", "--margin", "10mm"]].concat());
    assert_eq!(code, Some(0), "{said}");
    let expected = "koch.svg: step 3 of koch, 64 elements, 200 x 72.2 mm, 1 stroke of 426 mm, \
                    0 mm from stroke to stroke (as drawn: 0 mm), 0 edges left out as drawn before, ";
    assert!(said.starts_with(expected), "{said}");
    let svg = std::fs::read_to_string(folder.path().join("koch.svg")).unwrap();
    assert!(svg.contains(r#"width="200mm" height="72.2mm" viewBox="0 0 200000 72200""#));
    assert!(svg.contains(r#"stroke-width="300""#));
    assert!(svg.contains(
        "# kfrac grow koch.yaml --steps=3 --seed=0 --plot --size=200mm --stroke-width=0.3mm --margin=10mm\n"
    ));
    let refused: [(&[&str], &str); 7] = [
        (
            &["--size", "200mm", "-o", "a.png"],
            "a PNG is sized in pixels, not in lengths",
        ),
        (&["--size", "20ft"], "a side is a whole number of pixels"),
        (&["--size", "1.23mm"], "whole tenths of a millimetre"),
        (&["--stroke-width", "3mm%"], "a percentage"),
        (&["--plot", "-o", "a.csv"], "--plot applies to pictures"),
        (&["--pens", "3", "-o", "a.svg"], "--pens applies to plots"),
        (&["--pens", "0", "--plot"], "a plot has at least one pen"),
    ];
    for (options, message) in refused {
        let (code, said) = run(&[&["grow", "koch"], options].concat());
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(message), "{said}");
    }
    // Default colours share one pen if there are many of them.
    let levy = ["grow", "levy", "--steps", "8", "-o", "levy.dxf"];
    for (options, told, note) in [
        (&[][..], " strokes of", true),
        (&["--color-by", "index"], " in 64 layers of", false),
        (&["--pens", "5"], " in 5 layers of", false),
        (
            &["--color-by", "index", "--pens", "5"],
            " in 5 layers of",
            false,
        ),
    ] {
        let (code, said) = run(&[&levy[..], options].concat());
        assert_eq!(code, Some(0), "{said}");
        assert!(said.contains(told), "{said}");
        let noted = said.starts_with("note: one pen for all 64 colours: --pens 8 gives that many");
        assert_eq!(noted, note, "{said}");
    }
    let chaos = ["grow", "barnsley-fern", "--method", "chaos", "-o"];
    let (code, said) = run(&[&chaos[..], &["a.pdf"]].concat());
    assert_eq!(code, Some(2));
    assert!(said.contains("too many for a PDF"), "{said}");
}
