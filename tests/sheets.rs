//! Sheets: approximants side by side, and the command that draws them.

mod several;

use std::fs;
use std::path::Path;

use crate::common::{compiled, document, resolved};
use assert_cmd::Command;
use kfrac::figure::sheet::{self, Arrangement, Cell};
use kfrac::grow::Growth;
use kfrac::render::{Options, Size};

/// Returns a sheet of some steps of a rule as SVG.
fn drawn(name: &str, steps: &[u32], columns: Option<u32>) -> (sheet::SheetSummary, String) {
    let rule = resolved(&document(name), &[]);
    let graph = compiled(&rule, *steps.iter().max().unwrap_or(&0));
    let options = Options::of(rule.metadata()).size(Size::Long(200));
    let cells: Vec<_> = steps
        .iter()
        .map(|&step| Cell {
            name: format!("step {step}"),
            graph: &graph,
            growth: Growth::steps(step),
            style: &options.style,
            view: options.view,
            detail: None,
        })
        .collect();
    let mut bytes = Vec::new();
    let arrangement = Arrangement {
        columns,
        ..Arrangement::default()
    };
    let written = sheet::write(&cells, arrangement, &options, &mut bytes).unwrap();
    (written, String::from_utf8(bytes).unwrap())
}

#[test]
fn every_approximant_has_its_window_and_its_caption() {
    let (written, svg) = drawn("koch", &[0, 1, 2, 6], Some(3));
    assert_eq!(written.elements, 1 + 4 + 16 + 4096);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let number = |node: roxmltree::Node<'_, '_>, name: &str| -> f64 {
        node.attribute(name).unwrap().parse().unwrap()
    };
    let root = document.root_element();
    assert_eq!(
        written.size.map(f64::from),
        ["width", "height"].map(|side| number(root, side))
    );
    let windows: Vec<_> = root
        .descendants()
        .skip(1)
        .filter(|node| node.has_tag_name("svg"))
        .collect();
    let corners: Vec<_> = windows
        .iter()
        .map(|&node| ["x", "y"].map(|side| number(node, side)))
        .collect();
    assert_eq!(corners.len(), 4);
    // Three in a row, and one below the first.
    assert!(corners[..3].iter().all(|corner| corner[1] == corners[0][1]));
    assert!(corners[3][1] > corners[0][1]);
    assert_eq!(corners[3][0], corners[0][0]);
    for (window, [x, y]) in windows.iter().zip(&corners) {
        let [wide, high] = ["width", "height"].map(|side| number(*window, side));
        assert!(x + wide <= 100.0 * f64::from(written.size[0]));
        assert!(y + high <= 100.0 * f64::from(written.size[1]));
        assert_eq!(wide, 20_000.0);
    }
    let captions: Vec<_> = root
        .descendants()
        .filter_map(|node| node.attribute("aria-label"))
        .collect();
    assert_eq!(
        captions,
        [
            "step 0: 1 element",
            "step 1: 4 elements",
            "step 2: 16 elements",
            "step 6: 4,096 elements"
        ]
    );
}

/// A tree that grows is at the same position in every picture.
#[test]
fn all_pictures_show_the_same_part_of_the_plane() {
    let (_, svg) = drawn("pythagoras", &[1, 2, 8], None);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let windows = document.root_element().descendants().skip(1);
    let starts: Vec<_> = windows
        .filter(|node| node.has_tag_name("svg"))
        .map(|window| {
            let path = window
                .descendants()
                .find(|node| node.has_tag_name("path"))
                .unwrap();
            let data = path.attribute("d").unwrap();
            data[..data.find('l').unwrap()].to_owned()
        })
        .collect();
    assert_eq!(starts.len(), 3);
    assert!(starts.iter().all(|start| *start == starts[0]), "{starts:?}");
}

fn run(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("kfrac").unwrap();
    command
        .current_dir(folder)
        .arg("sheet")
        .args(arguments)
        .assert()
}

#[test]
fn the_command_writes_svg_and_png() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, file, start) in [
        (
            &["koch", "--steps", "0..3"][..],
            "koch-sheet.svg",
            &b"<svg "[..],
        ),
        (
            &["dragon", "--format", "png"],
            "dragon-sheet.png",
            b"\x89PNG",
        ),
        (
            &["vegetation", "--steps", "4,8", "-o", "two.png"],
            "two.png",
            b"\x89PNG",
        ),
    ] {
        run(folder.path(), arguments).success();
        assert!(
            fs::read(folder.path().join(file))
                .unwrap()
                .starts_with(start)
        );
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[test]
fn a_sheet_tells_how_to_make_it_again() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "random-tree",
        "--steps=1..3,7",
        "--seed=5",
        "--set=sway=10",
        "--columns=4",
        "--stroke-width=2.5",
    ];
    run(folder.path(), &arguments).success();
    let first = fs::read_to_string(folder.path().join("random-tree-sheet.svg")).unwrap();
    let document = roxmltree::Document::parse(&first).unwrap();
    let metadata = document
        .descendants()
        .find(|node| node.has_tag_name("metadata"))
        .unwrap();
    let text = metadata.text().unwrap();
    fs::write(folder.path().join("random-tree.yaml"), text).unwrap();
    let command = text
        .lines()
        .find_map(|line| line.strip_prefix("# kfrac sheet "))
        .unwrap();
    run(
        folder.path(),
        &command
            .split(' ')
            .chain(["-o", "again.svg"])
            .collect::<Vec<_>>(),
    )
    .success();
    let again = fs::read_to_string(folder.path().join("again.svg")).unwrap();
    assert_eq!(first, again);
}

#[test]
fn what_is_wrong_with_the_command_line_is_said() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (
            &["koch", "--steps", "3..1"][..],
            "write 0..6, or a list such as 0,2,4",
        ),
        (
            &["koch", "--steps", "0..x"],
            "a number of steps is a whole number from 0",
        ),
        (
            &["koch", "--steps", "0..20000"],
            "a sheet has no more than 10000 pictures",
        ),
        (
            &["koch", "--columns", "0"],
            "a number of columns is a whole number from 1",
        ),
        (
            &["koch", "-o", "koch.csv"],
            "the format '.csv' is not known here: .svg, .png, .pdf, .dxf, .hpgl and .gcode are",
        ),
    ] {
        let failed = run(folder.path(), arguments).code(2);
        let said = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
    run(folder.path(), &["koch", "--steps", "2..30"]).code(1);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn sets_in_space_are_shown_from_several_directions() {
    let folder = tempfile::tempdir().unwrap();
    let kfrac = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("kfrac").unwrap();
        let command = command.current_dir(folder.path()).args(arguments);
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        (output.status.code(), said)
    };
    let pixels = |name: &str| {
        let pixmap = tiny_skia::Pixmap::load_png(folder.path().join(name)).unwrap();
        ([pixmap.width(), pixmap.height()], pixmap)
    };
    let sheet = [
        "sheet",
        "menger",
        "--size",
        "64",
        "--columns",
        "2",
        "--steps",
        "2",
    ];
    let from = [&sheet[..], &["--from", "front,0,90"]].concat();
    let (status, said) = kfrac(&from);
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.starts_with("menger-sheet.png: 2 pictures of menger, "),
        "{said}"
    );
    let (size, sheet_of_two) = pixels("menger-sheet.png");
    // The front view and the view from above of the sponge are equal, and as the single picture.
    let single = [
        "grow", "menger", "--size", "64", "--steps", "2", "--from", "front", "--margin", "0", "-o",
        "one.png", "-q",
    ];
    assert_eq!(kfrac(&single).0, Some(0));
    let ([64, 64], one) = pixels("one.png") else {
        panic!("the front of a cube is a square");
    };
    let column = (size[0] - 3 * 16) / 2;
    for left in [16, 32 + column] {
        let left = left + (column - 64) / 2;
        for (x, y) in (0..64).flat_map(|x| (0..64).map(move |y| (x, y))) {
            assert_eq!(sheet_of_two.pixel(left + x, 16 + y), one.pixel(x, y));
        }
    }
    let (status, said) = kfrac(&[
        "sheet",
        "cloud",
        "--set",
        "cloud=1,2",
        "--size",
        "32",
        "--steps",
        "1",
    ]);
    assert_eq!(status, Some(0), "{said}");
    for (arguments, message) in [
        (
            &["sheet", "menger", "-o", "sheet.svg"][..],
            "is drawn as .png, not as .svg",
        ),
        (
            &["sheet", "menger", "--stroke-width", "2"],
            "--stroke-width is for the plane",
        ),
        (
            &["sheet", "koch", "--from", "front"],
            "--from applies to sets in space",
        ),
        (
            &["show", "koch", "--from", "front"],
            "--from applies to sets in space",
        ),
        (
            &["grow", "menger", "--from", "front,top"],
            "kfrac sheet shows several",
        ),
        (
            &["grow", "menger", "--from", "front,30"],
            "write azimuth and elevation",
        ),
    ] {
        let (status, said) = kfrac(arguments);
        assert!(status == Some(2) && said.contains(message), "{said}");
    }
}
