//! Sheets of several seeds, rules and parameters.

use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;

fn kfrac(folder: &Path, line: &str) -> Output {
    let mut command = Command::cargo_bin("kfrac").unwrap();
    let command = command.current_dir(folder).args(line.split(' '));
    command.output().unwrap()
}

/// Runs a command that succeeds, and returns its messages.
fn done(folder: &Path, line: &str) -> String {
    let output = kfrac(folder, line);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{line}: {said}");
    said
}

/// Returns captions and corners, in hundredths of a pixel, of the pictures of an SVG.
fn pictures(svg: &str) -> Vec<(String, [u32; 2])> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let all = document.root_element().descendants().skip(1);
    let captions = all.clone().filter_map(|node| node.attribute("aria-label"));
    let corners = all
        .filter(|node| node.has_tag_name("svg"))
        .map(|node| ["x", "y"].map(|side| node.attribute(side).unwrap_or("0").parse().unwrap()));
    captions.map(str::to_owned).zip(corners).collect()
}

/// Returns the number of different coordinates of corners along an axis.
fn different(pictures: &[(String, [u32; 2])], axis: usize) -> usize {
    let mut all: Vec<_> = pictures.iter().map(|(_, corner)| corner[axis]).collect();
    all.sort_unstable();
    all.dedup();
    all.len()
}

fn pixels(folder: &Path, name: &str) -> tiny_skia::Pixmap {
    tiny_skia::Pixmap::load_png(folder.join(name)).unwrap()
}

/// Asserts that the pictures of a sheet in one row are those of single files, of 64 pixels each way.
fn assert_shows(sheet: &tiny_skia::Pixmap, singles: &[tiny_skia::Pixmap]) {
    let count = u32::try_from(singles.len()).unwrap();
    let column = (sheet.width() - (count + 1) * 16) / count;
    for (number, single) in (0..).zip(singles) {
        assert_eq!([single.width(), single.height()], [64, 64]);
        let left = 16 + number * (column + 16) + (column - 64) / 2;
        for (x, y) in (0..64).flat_map(|x| (0..64).map(move |y| (x, y))) {
            // Coverage is rounded where the picture stands.
            let pixel = |of: &tiny_skia::Pixmap, x, y| {
                let pixel = of.pixel(x, y).unwrap();
                [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()]
            };
            let [shown, own] = [pixel(sheet, left + x, 16 + y), pixel(single, x, y)];
            let is_equal = shown.iter().zip(own).all(|(a, b)| a.abs_diff(b) <= 3);
            assert!(is_equal, "picture {number} at {x}, {y}: {shown:?}, {own:?}");
        }
    }
}

const ALIKE: &str = "--size 64x64 --stroke-width 1.5 --margin 4 -q";

#[test]
fn every_seed_has_the_individual_that_grow_draws() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for rule in ["stochastic-plant", "random-tree"] {
        done(
            folder,
            &format!(
                "sheet {rule} --seed 3,5..6 --steps 4 --columns 3 --fit each -o all.png {ALIKE}"
            ),
        );
        let singles = [3, 5, 6].map(|seed| {
            done(
                folder,
                &format!("grow {rule} --seed {seed} --steps 4 -o one.png {ALIKE}"),
            );
            pixels(folder, "one.png")
        });
        assert_ne!(singles[0], singles[1]);
        assert_shows(&pixels(folder, "all.png"), &singles);
    }
}

#[test]
fn seeds_are_in_captions_with_the_counts_of_their_individuals() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let said = done(folder, "sheet stochastic-plant --seed 1..4");
    assert!(
        said.starts_with("stochastic-plant-sheet.svg: 4 pictures of stochastic-plant, "),
        "{said}"
    );
    let svg = fs::read_to_string(folder.join("stochastic-plant-sheet.svg")).unwrap();
    let all = pictures(&svg);
    assert_eq!(all.len(), 4);
    for (seed, (caption, _)) in (1..).zip(&all) {
        let counted = kfrac(
            folder,
            &format!("count stochastic-plant --steps 5 --seed {seed} --json -q"),
        );
        let json: serde_json::Value = serde_json::from_slice(&counted.stdout).unwrap();
        let elements = json["elements"].as_str().unwrap().replace(',', "");
        let written = caption.replace(',', "");
        assert_eq!(written, format!("seed {seed}: {elements} elements"));
    }
    // A row for each seed, a column for each step.
    done(
        folder,
        "sheet stochastic-plant --seed 7,9 --steps 1..3 -o rows.svg",
    );
    let all = pictures(&fs::read_to_string(folder.join("rows.svg")).unwrap());
    assert_eq!([different(&all, 0), different(&all, 1)], [3, 2]);
    assert!(all[3].0.starts_with("seed 9, step 1: "), "{all:?}");
}

#[test]
fn every_rule_is_fitted_as_grow_does() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let rules = ["koch", "dragon-wreath", "sierpinski-pentagon"];
    let all = rules.join(" ");
    done(
        folder,
        &format!("sheet {all} --steps 3 --columns 3 --format png {ALIKE}"),
    );
    let singles = rules.map(|rule| {
        done(folder, &format!("grow {rule} --steps 3 -o one.png {ALIKE}"));
        pixels(folder, "one.png")
    });
    assert_shows(&pixels(folder, "sheet.png"), &singles);
    // Each rule has the steps that it proposes, or at most those of a light SVG.
    done(folder, "sheet koch dragon pythagoras -o each.svg");
    let each = fs::read_to_string(folder.join("each.svg")).unwrap();
    let captions: Vec<_> = pictures(&each).into_iter().map(|it| it.0).collect();
    let starts = ["koch, step ", "dragon, step ", "pythagoras, step "];
    assert_eq!(captions.len(), 3);
    for (caption, start) in captions.iter().zip(starts) {
        assert!(caption.starts_with(start), "{caption}");
    }
    // At one scale, the pictures are others.
    done(folder, "sheet koch dragon pythagoras --fit all -o all.svg");
    assert_ne!(each, fs::read_to_string(folder.join("all.svg")).unwrap());
    // Values are a row for each rule.
    done(
        folder,
        "sheet binary-tree pythagoras --set angle=20,30,40 --steps 3 --size 64x64 -o rows.svg",
    );
    let rows = pictures(&fs::read_to_string(folder.join("rows.svg")).unwrap());
    // Of the four elements of a trunk, two are fertile: 2^n + 2 (2^n - 1).
    assert_eq!(rows[3].0, "pythagoras, angle = 20, step 3: 22 elements");
    assert_eq!(different(&rows, 1), 2);
}

/// A picture has the background of its rule.
#[test]
fn rules_keep_their_backgrounds() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let night = "extends: koch\nstyle: {background: \"#102030\", stroke: \"#ffffff\"}\n";
    fs::write(folder.join("night.yaml"), night).unwrap();
    done(
        folder,
        "sheet koch night.yaml --size 64x64 --columns 2 --steps 2 -o two.png",
    );
    let sheet = pixels(folder, "two.png");
    let column = (sheet.width() - 3 * 16) / 2;
    let left = 16 + (column - 64) / 2;
    let at = |x: u32| {
        let pixel = sheet.pixel(x, 17).unwrap();
        [pixel.red(), pixel.green(), pixel.blue()]
    };
    assert_eq!(at(left + 1), [255, 255, 255]);
    assert_eq!(at(left + column + 16 + 1), [16, 32, 48]);
}

#[test]
fn two_parameters_are_a_grid() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let grid = "sheet binary-tree --set angle=20,30,40 --set ratio=0.5,0.6 --steps 3 --grid";
    done(folder, &format!("{grid} -o grid.svg"));
    let svg = fs::read_to_string(folder.join("grid.svg")).unwrap();
    let all = pictures(&svg);
    let names: Vec<_> = { all.iter() }
        .map(|(caption, _)| caption.split(": ").next().unwrap())
        .collect();
    assert_eq!(
        names,
        [
            "angle = 20, ratio = 0.5",
            "angle = 30, ratio = 0.5",
            "angle = 40, ratio = 0.5",
            "angle = 20, ratio = 0.6",
            "angle = 30, ratio = 0.6",
            "angle = 40, ratio = 0.6",
        ]
    );
    assert_eq!([different(&all, 0), different(&all, 1)], [3, 2]);
    // Each picture is that of its values.
    done(
        folder,
        &format!("{grid} --fit each --columns 6 -o row.png {ALIKE}"),
    );
    let singles = [("20", "0.5"), ("30", "0.5"), ("40", "0.5")]
        .into_iter()
        .chain([("20", "0.6"), ("30", "0.6"), ("40", "0.6")])
        .map(|(angle, ratio)| {
            let set = format!("--set angle={angle} --set ratio={ratio}");
            done(
                folder,
                &format!("grow binary-tree {set} --steps 3 -o one.png {ALIKE}"),
            );
            pixels(folder, "one.png")
        });
    assert_shows(&pixels(folder, "row.png"), &singles.collect::<Vec<_>>());
}

/// The file has the command and all rules.
#[test]
fn a_sheet_of_several_is_drawn_again_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for line in [
        "koch dragon --steps 2..3",
        "random-tree --seed 3,5 --set sway=5..20 --samples 3 --steps 4",
        "binary-tree --set angle=20,30 --set ratio=0.5,0.6 --grid --fit each",
        "koch dragon pythagoras",
        "complex-pair --set s=[0.3,0.2]..[0.5,0.4] --samples 3 --steps 3",
    ] {
        done(folder, &format!("sheet {line} -o first.svg"));
        let first = fs::read_to_string(folder.join("first.svg")).unwrap();
        let document = roxmltree::Document::parse(&first).unwrap();
        let mut nodes = document.descendants();
        let metadata = nodes.find(|node| node.has_tag_name("metadata")).unwrap();
        let text = metadata.text().unwrap();
        let command = { text.lines() }
            .find_map(|line| line.strip_prefix("# kfrac sheet "))
            .unwrap();
        let names = command.split(' ').filter(|word| !word.starts_with("--"));
        for (name, rule) in names.zip(text.split("\n---\n")) {
            fs::write(folder.join(name), rule).unwrap();
        }
        done(
            folder,
            &format!("sheet {} -o again.svg", command.replace('\'', "")),
        );
        let again = fs::read_to_string(folder.join("again.svg")).unwrap();
        assert!(first == again, "{line}");
    }
}

#[test]
fn every_format_has_several() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (extension, start) in [
        ("svg", "<svg "),
        ("png", "\u{fffd}PNG"),
        ("pdf", "%PDF-"),
        ("dxf", "999\n"),
        ("hpgl", "IN;"),
        ("gcode", ";"),
    ] {
        for line in [
            "random-tree --seed 1..3 --steps 3",
            "koch dragon --steps 3",
            "binary-tree --set angle=20,30 --set ratio=0.5,0.6 --grid --steps 2 --fit each",
        ] {
            let file = format!("several.{extension}");
            done(folder, &format!("sheet {line} -o {file}"));
            let bytes = fs::read(folder.join(file)).unwrap();
            let text = String::from_utf8_lossy(&bytes);
            let head: String = text.chars().take(20).collect();
            assert!(text.starts_with(start), "{extension}: {head}");
        }
    }
}

#[test]
fn rules_and_seeds_in_space_are_pictures_of_one_sheet() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let said = done(
        folder,
        "sheet menger sphere-flake --steps 1,2 --size 48 --from front,iso",
    );
    assert!(
        said.starts_with("sheet.png: 8 pictures of menger, sphere-flake, "),
        "{said}"
    );
    for (line, message) in [
        (
            "sheet koch menger",
            "menger lies in space and koch in the plane: a sheet shows sets of one of them",
        ),
        (
            "sheet menger sphere-flake --fit all",
            "menger lies in space, and --fit is for the plane",
        ),
    ] {
        let output = kfrac(folder, line);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.code() == Some(2) && said.contains(message),
            "{said}"
        );
    }
}

/// The limit holds for all pictures together, whether their numbers are known in advance or not.
#[test]
fn the_limit_of_elements_is_that_of_the_sheet() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // 1 + 4 + 16 + 64 + 256 elements.
    done(
        folder,
        "sheet koch --steps 0..4 --max-elements 341 -o koch.svg",
    );
    let output = kfrac(
        folder,
        "sheet koch --steps 0..4 --max-elements 340 -o less.svg",
    );
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        said.contains("the pictures have more than 340 elements together"),
        "{said}"
    );
    let svg = "sheet stochastic-plant --seed 1..4 --steps 4";
    done(folder, &format!("{svg} -o plants.svg"));
    let all = pictures(&fs::read_to_string(folder.join("plants.svg")).unwrap());
    let counts = all.iter().map(|(caption, _)| {
        let (_, count) = caption.split_once(": ").unwrap();
        let count = count.split(' ').next().unwrap();
        count.replace(',', "").parse::<u64>().unwrap()
    });
    let sum: u64 = counts.sum();
    done(folder, &format!("{svg} --max-elements {sum} -o sum.svg"));
    let output = kfrac(
        folder,
        &format!("{svg} --max-elements {} -o less.svg", sum - 1),
    );
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("--max-elements allows more"), "{said}");
    assert!(!folder.join("less.svg").exists());
}

#[test]
fn mistakes_in_several_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (line, status, message) in [
        (
            "sheet random-tree --seed 5..3",
            2,
            "write 0..6, or a list such as 0,2,4",
        ),
        (
            "sheet random-tree --seed 1..",
            2,
            "a seed is a whole number from 0",
        ),
        (
            "sheet random-tree --seed 1,,2",
            2,
            "a seed is a whole number from 0",
        ),
        (
            "sheet random-tree --seed 1..1000000000",
            2,
            "a list has no more than 100000 numbers",
        ),
        (
            "sheet random-tree --seed 1..20000",
            2,
            "a sheet has no more than 10000 pictures",
        ),
        (
            "sheet random-tree koch --seed 1..100 --steps 0..99",
            2,
            "a sheet has no more than 10000 pictures",
        ),
        (
            "sheet binary-tree --set angle=20..30 --set ratio=0.4..0.5 --samples 1000 --grid",
            2,
            "a sheet has no more than 10000 pictures",
        ),
        ("sheet koch dragn minkowski", 1, "dragn"),
        (
            "sheet koch pythagoras --set angle=30,40",
            2,
            "koch has no parameter 'angle'",
        ),
        (
            "sheet binary-tree --set angle=1,2 --set ratio=0.4,0.5,0.6",
            2,
            "kfrac sheet --grid",
        ),
        (
            "sheet binary-tree --set angle=1,2 --set angle=3,4 --grid",
            2,
            "angle is swept already",
        ),
        (
            "sheet binary-tree --set angle=1,2 --grid",
            2,
            "--grid has columns and rows for two parameters",
        ),
        ("sheet koch --fit some", 2, "all, each"),
        (
            "count random-tree --seed 1..3",
            2,
            "several seeds are for `kfrac sheet`",
        ),
    ] {
        let output = kfrac(folder, line);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(status), "{line}: {said}");
        assert!(said.contains(message), "{line}: {said}");
    }
    assert_eq!(fs::read_dir(folder).unwrap().count(), 0);
}

#[test]
fn pictures_of_a_detail_are_those_that_grow_draws() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    done(
        folder,
        &format!(
            "sheet binary-tree --set ratio=0.5..0.7 --samples 3 --detail 2 --fit each --columns 3 -o all.png {ALIKE}"
        ),
    );
    let singles = ["0.5", "0.6", "0.7"].map(|ratio| {
        let line =
            format!("grow binary-tree --set ratio={ratio} --detail 2 -o {ratio}.png {ALIKE}");
        done(folder, &line);
        pixels(folder, &format!("{ratio}.png"))
    });
    assert_shows(&pixels(folder, "all.png"), &singles);
    // At one scale, smaller pictures take fewer elements.
    let line = "sheet koch gasket dragon --detail 3 --size 200 -o each.svg -q";
    done(folder, line);
    let counts = |name: &str| -> Vec<u64> {
        let all = pictures(&fs::read_to_string(folder.join(name)).unwrap());
        let count = |caption: &str| {
            let digits = caption.rsplit(": ").next().unwrap().replace(',', "");
            digits.split(' ').next().unwrap().parse().unwrap()
        };
        all.iter().map(|(caption, _)| count(caption)).collect()
    };
    let each = counts("each.svg");
    assert_eq!(each.len(), 3);
    let line =
        "sheet binary-tree --set ratio=0.4..0.7 --samples 4 --detail 3 --size 200 -o one.svg -q";
    done(folder, line);
    let one = counts("one.svg");
    let line = line.replace("one.svg", "each.svg") + " --fit each";
    done(folder, &line);
    let each = counts("each.svg");
    assert!(
        one[0] < each[0] && one.windows(2).all(|two| two[0] <= two[1]),
        "{one:?}, {each:?}"
    );
    assert!(
        one[3] <= each[3] && 4 * one[3] > each[3],
        "{one:?}, {each:?}"
    );
    // Steps with a detail.
    let said = done(
        folder,
        "sheet koch --steps 2,9 --detail 4 --size 200 -o steps.svg",
    );
    let steps = counts("steps.svg");
    assert_eq!(steps[0], 16, "{said}");
    assert!((100..4_u64.pow(9)).contains(&steps[1]), "{steps:?}");
    // A detail that takes more steps than a search begins with.
    let line = "sheet cantor-gaps --detail 0.5 --size 64 -o gaps.png -q";
    done(folder, line);
}

#[test]
fn random_iteration_has_sheets() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let game = "--method chaos --points 20k --tone linear --size 64x64 --margin 3 -q";
    done(
        folder,
        &format!("sheet barnsley-fern gasket --seed 3,4 --columns 4 -o all.png {game}"),
    );
    let singles = ["barnsley-fern", "gasket"].map(|rule| {
        [3, 4].map(|seed| {
            let name = format!("{rule}-{seed}.png");
            done(
                folder,
                &format!("grow {rule} --seed {seed} -o {name} {game}"),
            );
            pixels(folder, &name)
        })
    });
    let all = pixels(folder, "all.png");
    assert_shows(&all, &singles.concat());
    // With one part of the plane, a smaller set is smaller.
    let text = "kind: ifs\nparams: {side: {value: 1, min: 0.1, max: 2}}\n\
                maps: [{scale: 1/2}, {scale: 1/2, shift: [side/2, 0]}, {scale: 1/2, shift: [0, side/2]}]\n";
    fs::write(folder.join("corner.yaml"), text).unwrap();
    done(
        folder,
        &format!("sheet corner.yaml --set side=0.5,1 -o pair.png {game}"),
    );
    let pair = pixels(folder, "pair.png");
    let inked = |columns: std::ops::Range<u32>| {
        let is_inked = |&(x, y): &(u32, u32)| pair.pixel(x, y).unwrap().red() < 250;
        let all = columns.flat_map(|x| (16..80).map(move |y| (x, y)));
        all.filter(is_inked).count()
    };
    let half = pair.width() / 2;
    assert!(inked(0..half) * 2 < inked(half..pair.width()));
    for (line, expected) in [
        (
            "sheet koch --method chaos -o a.png",
            "needs a system of maps",
        ),
        ("sheet gasket --method chaos -o a.svg", "write a .png"),
        (
            "sheet gasket --method chaos --detail 2",
            "applies to elements",
        ),
        ("sheet gasket --points 10k", "add --method chaos"),
    ] {
        let output = kfrac(folder, line);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            !output.status.success() && said.contains(expected),
            "{line}: {said}"
        );
    }
}
