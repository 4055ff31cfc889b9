//! Pyramids of tiles: tiles are the picture, whoever draws them, and nothing is written in part.

use std::fs;
use std::path::Path;

use resvg::tiny_skia::{Color, Pixmap};
use serde_json::Value;

use crate::common::{files, said};

/// Runs `kfrac grow` with a line of arguments in a folder; returns what it reports.
fn grow(folder: &Path, line: &str) -> String {
    let (status, said) = run(folder, line);
    assert_eq!(status, Some(0), "{line}: {said}");
    said
}

fn run(folder: &Path, line: &str) -> (Option<i32>, String) {
    let words: Vec<_> = ["grow"].into_iter().chain(line.split(' ')).collect();
    said(folder, &words)
}

/// Returns the numbers of a pyramid from its page.
fn numbers(folder: &Path) -> Value {
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    let numbers = page.split("const pyramid = ").nth(1).unwrap();
    serde_json::from_str(numbers.split(";\n").next().unwrap()).unwrap()
}

/// Joins the tiles of a level to a picture, on white where there is none. Pixels that tiles share are checked to be within
/// a difference in all of them.
fn joined(folder: &Path, name: &str, level: u32, most: u8) -> Pixmap {
    let numbers = numbers(folder);
    let number = |name: &str| u32::try_from(numbers[name].as_u64().unwrap()).unwrap();
    let (side, overlap) = (number("side"), number("overlap"));
    let ratio = 1 << (number("deepest") - level);
    let [width, height] = ["width", "height"].map(|it| number(it).div_ceil(ratio));
    let mut all = Pixmap::new(width, height).unwrap();
    all.fill(Color::WHITE);
    let mut is_drawn = vec![false; (width * height) as usize];
    let mut count = 0;
    for row in 0..height.div_ceil(side) {
        for column in 0..width.div_ceil(side) {
            let path = folder.join(format!("{name}_files/{level}/{column}_{row}.png"));
            let Ok(bytes) = fs::read(path) else { continue };
            let tile = Pixmap::decode_png(&bytes).unwrap();
            let [left, top] = [column, row].map(|it| (it * side).saturating_sub(overlap));
            let right = ((column + 1) * side + overlap).min(width);
            let bottom = ((row + 1) * side + overlap).min(height);
            assert_eq!([tile.width(), tile.height()], [right - left, bottom - top]);
            let is_white = |it: &[u8]| it.iter().all(|byte| *byte == 255);
            assert!(!is_white(tile.data()), "{column}, {row} is empty");
            for (line, pixels) in tile.data().chunks(4 * tile.width() as usize).enumerate() {
                for (place, pixel) in pixels.chunks(4).enumerate() {
                    let at = (top as usize + line) * width as usize + left as usize + place;
                    let old = &mut all.data_mut()[4 * at..4 * at + 4];
                    let differs = old.iter().zip(pixel).any(|(a, b)| a.abs_diff(*b) > most);
                    assert!(
                        !(is_drawn[at] && differs),
                        "{column}, {row}: {old:?} {pixel:?}"
                    );
                    old.copy_from_slice(pixel);
                    is_drawn[at] = true;
                }
            }
            count += 1;
        }
    }
    let found = fs::read_dir(folder.join(format!("{name}_files/{level}"))).unwrap();
    assert_eq!(found.count(), count, "other files at level {level}");
    all
}

/// Returns the largest and the mean difference of the channels of two pictures.
fn difference(a: &Pixmap, b: &Pixmap) -> (u8, f64) {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let each = || a.data().iter().zip(b.data()).map(|(a, b)| a.abs_diff(*b));
    let total: u64 = each().map(u64::from).sum();
    (each().max().unwrap(), total as f64 / a.data().len() as f64)
}

fn picture(path: &Path) -> Pixmap {
    Pixmap::decode_png(&fs::read(path).unwrap()).unwrap()
}

/// Places are rounded to hundredths of a pixel, and edges to samples of a pixel: see `windows.rs`.
const ROUNDING: (u8, f64) = (64, 0.2);

#[test]
fn tiles_of_the_deepest_level_are_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, options) in [
        (
            "koch",
            "--steps 6 --stroke-width 3 --size 700 --tile-size 128",
        ),
        (
            "dragon",
            "--steps 12 --color-by index --size 601x400 --tile-size 128 --overlap 1",
        ),
        (
            "dragon",
            "--detail 1 --size 500 --tile-size 64 --margin 7 --overlap 1",
        ),
        (
            "pythagoras",
            "--steps 9 --size 640 --tile-size 256 --turn 20",
        ),
        ("barnsley-fern", "--detail 1 --size 600 --tile-size 128"),
        ("koch-snowflake", "--steps 4 --size 300 --view 0,0,0.5,0.4"),
        ("gosper", "--steps 3 --size 400 --stroke-width 10% --seed 4"),
    ] {
        let tiles = format!("{name} {options} --tiles tiles");
        let said = grow(folder, &tiles);
        assert!(said.contains("levels"), "{said}");
        let single: Vec<_> = options
            .split(" --")
            .filter(|it| {
                !it.trim_start_matches("--").starts_with("tile-size") && !it.starts_with("overlap")
            })
            .collect();
        grow(
            folder,
            &format!("{name} {} -o whole.png", single.join(" --")),
        );
        let deepest = u32::try_from(numbers(&folder.join("tiles"))["deepest"].as_u64().unwrap());
        let whole = picture(&folder.join("whole.png"));
        let joined = joined(&folder.join("tiles"), name, deepest.unwrap(), ROUNDING.0);
        let (most, mean) = difference(&joined, &whole);
        assert!(
            most <= ROUNDING.0 && mean <= ROUNDING.1,
            "{tiles}: {most}, {mean}"
        );
        fs::remove_dir_all(folder.join("tiles")).unwrap();
    }
}

/// Lines are as wide at every level, and a detail is one of the level.
#[test]
fn a_level_is_the_picture_of_its_size() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let view = "--view=-0.1,-0.4,1.2,0.8";
    for options in [
        "--steps 7 --stroke-width 2",
        "--detail 2",
        "--steps 30 --detail 3 --color-by step",
    ] {
        grow(
            folder,
            &format!("koch {options} {view} --size 768x512 --tiles tiles --tile-size 64"),
        );
        for level in [9, 8, 6] {
            let size = format!("{}x{}", 768 >> (10 - level), 512 >> (10 - level));
            grow(
                folder,
                &format!("koch {options} {view} --size {size} -o whole.png"),
            );
            let joined = joined(&folder.join("tiles"), "koch", level, ROUNDING.0);
            let (most, mean) = difference(&joined, &picture(&folder.join("whole.png")));
            assert!(
                most <= ROUNDING.0 && mean <= ROUNDING.1,
                "{options}, {level}: {most}, {mean}"
            );
        }
        let tiny = joined(&folder.join("tiles"), "koch", 0, 0);
        assert_eq!((tiny.width(), tiny.height()), (1, 1));
        fs::remove_dir_all(folder.join("tiles")).unwrap();
    }
}

const LINE: &str = "dragon --detail 1 --size 900 --tile-size 64 --overlap 1";

#[test]
fn threads_parts_and_levels_make_the_same_files() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let said = grow(folder, &format!("{LINE} --threads 1 --tiles one"));
    let one = files(&folder.join("one"));
    let tiles = one.keys().filter(|name| name.ends_with(".png")).count();
    assert!(said.contains(&format!(", {tiles} tiles and ")), "{said}");
    assert!(said.contains(" empty ones in 11 levels"), "{said}");
    assert_eq!(one.len(), tiles + 3);
    let dzi = String::from_utf8(one["dragon.dzi"].clone()).unwrap();
    assert!(
        dzi.contains("Format=\"png\" Overlap=\"1\" TileSize=\"64\""),
        "{dzi}"
    );
    assert!(dzi.contains("<Size Width=\"900\" Height=\""), "{dzi}");
    grow(folder, &format!("{LINE} --threads 4 --tiles four"));
    assert!(files(&folder.join("four")) == one);

    // The page and the description appear with the last part.
    for part in ["3/3", "1/3", "2/3"] {
        assert!(!folder.join("parts/dragon.dzi").exists());
        assert!(!folder.join("parts/dragon_files").exists());
        grow(folder, &format!("{LINE} --shard {part} --tiles parts"));
    }
    assert!(files(&folder.join("parts")) == one);
    // A part that is repeated afterwards changes nothing.
    let said = grow(folder, &format!("{LINE} --shard 2/3 --tiles parts"));
    assert!(said.contains("complete already"), "{said}");
    assert!(files(&folder.join("parts")) == one);

    grow(folder, &format!("{LINE} --level 0..8 --tiles levels"));
    grow(
        folder,
        &format!("{LINE} --level 9,10 --shard 1/2 --tiles levels"),
    );
    assert!(!folder.join("levels/index.html").exists());
    grow(
        folder,
        &format!("{LINE} --level 9,10 --shard 2/2 --tiles levels"),
    );
    assert!(files(&folder.join("levels")) == one);
}

#[test]
fn interrupted_work_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    grow(folder, &format!("{LINE} --tiles whole"));
    let whole = files(&folder.join("whole"));
    grow(folder, &format!("{LINE} --level 10 --tiles tiles"));
    // A tile of a level that is not done is kept, and one that is missing is drawn.
    let level = folder.join("tiles/dragon_files.part/10");
    fs::remove_file(level.join("1-of-1.json")).unwrap();
    let mut tiles: Vec<_> = fs::read_dir(&level)
        .unwrap()
        .map(|it| it.unwrap().path())
        .collect();
    tiles.sort();
    fs::write(&tiles[0], "kept").unwrap();
    fs::remove_file(&tiles[1]).unwrap();
    grow(folder, &format!("{LINE} --tiles tiles"));
    let mut found = files(&folder.join("tiles"));
    let name = format!(
        "dragon_files/10/{}",
        tiles[0].file_name().unwrap().display()
    );
    assert_eq!(found[&name], b"kept");
    found.insert(name.clone(), whole[&name].clone());
    assert!(found == whole);
}

#[test]
fn other_contents_are_refused_or_replaced_as_a_whole() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    grow(folder, "koch --steps 3 --size 300 --tiles tiles --level 3");
    let (status, said) = run(folder, "koch --steps 4 --size 300 --tiles tiles");
    assert_eq!(status, Some(1));
    assert!(
        said.contains("koch_files.part' holds a part of other tiles: remove it"),
        "{said}"
    );
    grow(folder, "koch --steps 3 --size 300 --tiles tiles");
    let old = files(&folder.join("tiles"));
    grow(folder, "koch --steps 4 --size 300 --tiles tiles");
    let new = files(&folder.join("tiles"));
    assert!(old != new);
    grow(folder, "koch --steps 4 --size 300 --tiles again");
    assert!(files(&folder.join("again")) == new);

    fs::create_dir_all(folder.join("foreign/koch_files")).unwrap();
    fs::write(folder.join("foreign/koch_files/mine.txt"), "mine").unwrap();
    let (status, said) = run(folder, "koch --tiles foreign");
    assert_eq!(status, Some(1));
    assert!(said.contains("is no folder of tiles of kfrac"), "{said}");
    assert_eq!(files(&folder.join("foreign")).len(), 1);
    fs::write(folder.join("file"), "").unwrap();
    let (status, said) = run(folder, "koch --tiles file");
    assert_eq!(status, Some(1));
    assert!(
        said.contains("the folder 'file' cannot be created"),
        "{said}"
    );
}

#[test]
fn bad_input_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (line, status, reason) in [
        ("koch --tiles t -o koch.png", 2, "give only one of them"),
        ("koch --tiles t --format svg", 2, "--tiles writes PNGs"),
        (
            "koch --tiles t --plot",
            2,
            "--plot applies to single pictures",
        ),
        (
            "koch --tiles t --zoom 10",
            2,
            "--zoom applies to single pictures",
        ),
        (
            "koch --tiles t --watch",
            2,
            "--watch applies to single pictures",
        ),
        (
            "koch --tiles t --open --shard 1/2",
            2,
            "--open shows the page",
        ),
        (
            "barnsley-fern --tiles t --method chaos",
            2,
            "--method chaos draws points",
        ),
        ("menger --tiles t", 2, "menger lies in space"),
        ("koch --tiles t --size a4", 2, "sized in pixels"),
        ("koch --tiles t --overlap 2", 2, "--overlap"),
        ("koch --tiles t --tile-size 10", 2, "--tile-size"),
        ("koch --tiles t --shard 3/2", 2, "K from 1 to N"),
        ("koch --tiles t --level 11", 2, "have the levels 0 to 10"),
        ("koch --shard 1/2", 2, "--tiles"),
        (
            "koch --tiles t --detail 1 --color-by step",
            2,
            "give --steps too",
        ),
        ("koch --tiles t --seed 1..3", 2, "names that differ"),
        (
            "koch --tiles t --detail 1 --size 100000 --max-tiles 100",
            1,
            "; --max-tiles allows more",
        ),
        ("koch --tiles t --steps 30", 1, "--detail 0.5"),
        ("koch --tiles t --margin 600", 1, "leave no room"),
        (
            "koch --tiles t --steps 3 --view 0,0,1e-15,1e-15",
            1,
            "the window is too small",
        ),
    ] {
        let (found, said) = run(folder, line);
        assert_eq!(found, Some(status), "{line}: {said}");
        assert!(said.contains(reason), "{line}: {said}");
        assert_eq!(fs::read_dir(folder).unwrap().count(), 0, "{line}");
    }
}

/// A sample of the tiles has about the size that all of them turn out to have, and a picture is not changed by it.
#[test]
fn many_tiles_have_an_estimate() {
    const LINE: &str = "dragon --detail 4 --size 4096 --tile-size 64 --shard 2/3";
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let said = grow(folder, &format!("{LINE} --tiles noted"));
    let note = said.lines().next().unwrap();
    let (count, rest) = { note.strip_prefix("note: up to ").unwrap() }
        .split_once(" tiles of 64 pixels are drawn, in about ")
        .unwrap();
    assert!(rest.contains(" s, to about "), "{note}");
    let bytes = rest.split(", to about ").nth(1).unwrap();
    let (bytes, unit) = bytes.split_once(' ').unwrap();
    let unit = match unit {
        "kB" => 1e3,
        "MB" => 1e6,
        other => panic!("{other}"),
    };
    let bytes = bytes.parse::<f64>().unwrap() * unit;
    grow(folder, &format!("{LINE} --quiet --tiles quiet"));
    let tiles = |folder: &Path| {
        let mut files = files(folder);
        files.retain(|name, _| name.ends_with(".png"));
        files
    };
    let tiles = [folder.join("noted"), folder.join("quiet")].map(|it| tiles(&it));
    assert!(tiles[0] == tiles[1]);
    let all: usize = tiles[0].values().map(Vec::len).sum();
    let ratio = bytes / all as f64;
    assert!((0.5..2.0).contains(&ratio), "{note}, and {all} bytes");
    let count: usize = count.replace(',', "").parse().unwrap();
    assert!(count > tiles[0].len(), "{count}");
}

/// Only tiles have more than a million pixels on a side.
#[test]
fn pyramids_have_up_to_a_billion_pixels_a_side() {
    const LINE: &str = "carpet --detail 1 --size 1073741824";
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (status, said) = run(folder, LINE);
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("at most 1000000 pixels; --tiles allows 1073741824"),
        "{said}"
    );
    let part = "--level 30 --shard 1234567890/4294967295 --tile-size 1024";
    grow(folder, &format!("{LINE} {part} --tiles t"));
    let drawn = files(&folder.join("t"));
    let drawn = drawn.keys().filter(|name| name.ends_with(".png")).count();
    assert!((30..100).contains(&drawn), "{drawn}");
}

/// Rules that pictures hold are drawn as tiles, and folders of tiles hold their rule.
#[test]
fn tiles_and_pictures_hold_their_rule() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    grow(folder, "koch --steps 3 --stroke red -o koch.svg");
    grow(folder, "koch.svg --size 200 --tiles again");
    grow(
        folder,
        "koch --steps 3 --stroke red --size 200 --tiles tiles",
    );
    let tile = |path: &str| picture(&folder.join(path)).data().to_vec();
    assert!(tile("again/koch_files/8/0_0.png") == tile("tiles/koch_files/8/0_0.png"));
    let text = fs::read_to_string(folder.join("tiles/koch_files/pyramid.json")).unwrap();
    let description: Value = serde_json::from_str(&text).unwrap();
    let made_from = description["made_from"].as_str().unwrap();
    let line = made_from
        .lines()
        .nth(1)
        .unwrap()
        .strip_prefix("# kfrac grow ")
        .unwrap();
    fs::write(folder.join("koch.yaml"), made_from).unwrap();
    let old = files(&folder.join("tiles"));
    fs::remove_dir_all(folder.join("tiles")).unwrap();
    grow(folder, &line.replace('\'', ""));
    let mut new = files(&folder.join("tiles"));
    // The text of the file has grown by the lines about the picture.
    new.insert("koch_files/pyramid.json".into(), text.into_bytes());
    assert!(new == old);
}

/// A title cannot end the script of the page, and names are those of files.
#[test]
fn pages_hold_any_title_and_name() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let rule = "title: a </script><b> & title\ninitiator: segment\ngenerator: [[0, 0], [1/2, 1/4], [1, 0]]\n";
    fs::write(folder.join("a <b>.yaml"), rule).unwrap();
    let (status, said) = said(
        folder,
        &["grow", "a <b>.yaml", "--size", "90", "--tiles", "t"],
    );
    assert_eq!(status, Some(0), "{said}");
    let page = fs::read_to_string(folder.join("t/index.html")).unwrap();
    assert_eq!(page.matches("</script>").count(), 1);
    assert!(page.contains("<title>a &lt;/script&gt;&lt;b&gt; &amp; title</title>"));
    assert_eq!(numbers(&folder.join("t"))["files"], "a <b>_files");
    assert!(folder.join("t/a <b>.dzi").is_file());
    assert!(!page.contains("http"));
}
