//! Pictures that are drawn in bands are equal to those drawn in one piece.

use std::num::NonZero;

use crate::common;
use kfrac::figure::sheet::{self, Arrangement, Cell};
use kfrac::graph::Graph;
use kfrac::grow::{Growth, Progress};
use kfrac::render::{self, Detail, Format, Options, Size};
use kfrac::style::{Cap, ColorBy, Colour, Join, Width};

/// Returns the PNG of a rule of the library, drawn in bands of a number of pixels or in one piece.
fn png(name: &str, steps: u32, band: Option<u64>, change: &dyn Fn(&mut Options)) -> Vec<u8> {
    let document = common::document(name);
    let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
    let graph = Graph::compile(&rule, steps).unwrap();
    let mut options = Options::default()
        .style(rule.style().clone())
        .format(Format::Png)
        .size(Size::Long(90))
        .threads(NonZero::<usize>::MIN);
    if let Some(band) = band {
        (options.in_one_piece, options.band) = (0, band);
    }
    change(&mut options);
    let mut bytes = Vec::new();
    render::write(&graph, &Growth::steps(steps), &options, &mut bytes).unwrap();
    bytes
}

/// Pixels of a band: all of them, and about twenty rows.
const BANDS: [u64; 2] = [u64::MAX, 1_700];

const STYLES: [fn(&mut Options); 9] = [
    |_| {},
    |options| options.style.width = Width::Pixels(0.1),
    |options| options.style.width = Width::Relative(0.05),
    |options| options.style.width = Width::Pixels(5.5),
    |options| {
        options.style.width = Width::Pixels(4.0);
        (options.style.cap, options.style.join) = (Cap::Butt, Join::Miter);
        options.style.stroke = Some(Colour::of_rgba([200, 0, 90, 120]));
        options.style.color_by = ColorBy::None;
    },
    |options| {
        options.style.fill = Some(Colour::of_rgba([0, 90, 30, 150]));
        options.style.background = Some(Colour::grey(250));
    },
    |options| options.style.color_by = ColorBy::Step,
    |options| options.style.color_by = ColorBy::Index,
    |options| {
        options.view.window = Some([0.1, 0.05, 0.5, 0.3]);
        options.detail = Some(Detail {
            pixels: 2.0,
            decides_steps: false,
        });
    },
];

#[test]
fn the_height_of_bands_does_not_show() {
    let rules = [
        ("koch-snowflake", 3),
        ("pythagoras-squares", 5),
        ("hilbert", 3),
        ("fern", 3),
        ("random-tree", 4),
    ];
    for (name, steps) in rules {
        for (number, style) in STYLES.iter().enumerate() {
            let whole = png(name, steps, Some(BANDS[0]), style);
            let drawn = png(name, steps, Some(BANDS[1]), style);
            assert!(drawn == whole, "{name}, style {number}");
        }
    }
}

/// Many small elements are drawn by sprites, which bands share.
#[test]
fn many_elements_are_the_same_in_bands() {
    for (name, steps) in [("dragon", 20), ("carpet", 7)] {
        let size = |options: &mut Options| options.size = Size::Long(300);
        let whole = png(name, steps, None, &size);
        for rows in [1_000, 40, 64] {
            assert!(
                png(name, steps, Some(300 * rows), &size) == whole,
                "{name}, {rows} rows"
            );
        }
    }
}

/// Coverage, strokes of thin round pens and small polygons, does not depend on bands.
#[test]
fn what_is_drawn_in_one_piece_is_the_same_in_bands() {
    for (name, steps) in [("koch", 5), ("levy", 8), ("gosper", 2)] {
        for width in [0.2, 1.5, 3.0] {
            let style = |options: &mut Options| options.style.width = Width::Pixels(width);
            let one = png(name, steps, None, &style);
            for band in BANDS {
                assert!(
                    png(name, steps, Some(band), &style) == one,
                    "{name}, {width}"
                );
            }
            let threads = |options: &mut Options| {
                style(options);
                options.threads = NonZero::new(3).unwrap();
            };
            assert!(
                png(name, steps, Some(1), &threads) == one,
                "{name}, {width}"
            );
        }
    }
}

/// Plots are drawn again for every band.
#[test]
fn plots_are_the_same_in_bands() {
    for (name, steps) in [("koch-snowflake", 4), ("levy", 7), ("random-tree", 4)] {
        for width in [0.2, 1.5] {
            let style = |options: &mut Options| {
                options.style.width = Width::Pixels(width);
                options.style.fill = None;
                options.plot = true;
            };
            let one = png(name, steps, None, &style);
            for band in BANDS {
                let drawn = png(name, steps, Some(band), &style);
                assert!(drawn == one, "{name}, {width}");
            }
        }
    }
}

/// Cells outside a band are skipped.
#[test]
fn sheets_do_not_know_of_bands() {
    let document = common::document("dragon-wreath");
    let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
    let graph = Graph::compile(&rule, 4).unwrap();
    for width in [1.5, 6.0] {
        let [whole, drawn] = [u64::MAX, 9_000].map(|band| {
            let mut options = Options::of(rule.metadata())
                .format(Format::Png)
                .size(Size::Long(70))
                .in_one_piece(0)
                .band(band)
                .threads(NonZero::<usize>::MIN);
            options.style.width = Width::Pixels(width);
            let cells: Vec<_> = (0..=4)
                .map(|steps| Cell {
                    name: format!("step {steps}"),
                    graph: &graph,
                    growth: Growth::steps(steps),
                    style: &options.style,
                    view: options.view,
                    detail: None,
                })
                .collect();
            let arrangement = Arrangement {
                columns: Some(2),
                ..Arrangement::default()
            };
            let mut bytes = Vec::new();
            sheet::write(&cells, arrangement, &options, &mut bytes).unwrap();
            bytes
        });
        assert!(drawn == whole, "{width}");
    }
}

#[test]
fn progress_counts_pixels() {
    let koch = common::resolved(&common::document("koch"), &[]);
    let graph = Graph::compile(&koch, 12).unwrap();
    let options = Options::default()
        .format(Format::Png)
        .in_one_piece(0)
        .band(12_000)
        .size(Size::Long(600))
        .threads(NonZero::<usize>::MIN)
        .detail(Some(Detail {
            pixels: 1.0,
            decides_steps: false,
        }));
    let progress = Progress::default();
    let growth = Growth::steps(12).progress(Some(&progress));
    let mut bytes = Vec::new();
    let picture = render::write(&graph, &growth, &options, &mut bytes).unwrap();
    // Two passes over the pixels, and the prepass.
    let [width, height] = picture.size.map(u64::from);
    assert!(progress.walked() >= 2 * width * height);
    assert!(progress.expected() >= Some(progress.walked()));
}

#[test]
fn the_command_line_says_how_long_bands_take() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "grow",
        "koch",
        "--steps",
        "3",
        "--size",
        "67200x1000",
        "-o",
        "wide.png",
    ];
    let (_, said) = common::said(folder.path(), &arguments);
    let note = "note: 67200 x 1000 pixels are drawn in bands, in about 1 s, to about 88 kB\nwide.png: step 3 of koch, ";
    assert!(said.starts_with(note), "{said}");
    let bytes = std::fs::read(folder.path().join("wide.png")).unwrap();
    // Width and height in the first chunk of a PNG.
    assert_eq!(bytes[16..24], [0, 1, 6, 128, 0, 0, 3, 232]);
}
