//! Random iteration of all systems of the library, against deterministic iteration and the exact moments; and
//! on the command line.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::Arc;

use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::chaos::{Game, HistogramWindow, RandomPoints, Start, WeightedMaps, play};
use kfrac::document::Document;
use kfrac::geometry::{DMat2, DVec2};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::ifs;
use kfrac::model::Model;
use kfrac::render::{self, Canvas, Detail, Format, Options, Size};
use kfrac::style::{ColorBy, View, Width};

/// Returns all systems of the library, with their names.
fn library() -> Vec<(String, Arc<ifs::System>)> {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries().into_iter();
    let entries = entries.filter(|entry| entry.shelf == Shelf::IFS);
    let systems = entries.filter_map(|entry| {
        let document = Document::read(&catalogue.open(&entry).unwrap(), &catalogue).unwrap();
        match document.resolve(&[]).unwrap().0 {
            Model::Ifs(system) => Some((entry.name, system)),
            Model::IfsInSpace(_) => None,
            // A system whose maps are drawn.
            Model::Instancing(structure) if Graph::of_structure(&structure).draws() => None,
            other => panic!("{} is {:?}", entry.name, other.kind()),
        }
    });
    systems.collect()
}

/// In files coloured by step, large elements have the first colours of the palette.
#[test]
fn trunks_are_brown() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tree.png");
    let arguments =
        "grow tree-libeskind-hadas --method chaos --points 300k --size 200 --background none -q -o";
    let status = Command::new(env!("CARGO_BIN_EXE_kfrac"))
        .args(arguments.split(' '))
        .arg(&path)
        .status();
    assert!(status.unwrap().success());
    let mut decoder = png::Decoder::new(std::io::Cursor::new(fs::read(&path).unwrap()));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    // Red, green, blue and opacity, from the top down: browner below than above.
    let brown = |rows: &[u8]| {
        let seen = rows.chunks_exact(4).filter(|pixel| pixel[3] > 0);
        let all = seen.clone().count() as f64;
        seen.filter(|pixel| pixel[0] > pixel[1]).count() as f64 / all
    };
    let [crown, trunk] = [
        brown(&pixels[..pixels.len() / 2]),
        brown(&pixels[pixels.len() * 4 / 5..]),
    ];
    assert!(trunk > 0.7 && crown < 0.3, "{trunk} and {crown}");
}

const SIDE: u32 = 64;

/// Returns a square window around the whole attractor.
fn around(graph: &Graph) -> [f64; 4] {
    let bounds = graph.limit_bounds().unwrap();
    let side = bounds.size().max_element() * 1.1;
    let corner = bounds.min() + (bounds.size() - side) / 2.0;
    [corner.x, corner.y, side, side]
}

type Pixels = BTreeSet<[i64; 2]>;

fn pixels(hit: impl Iterator<Item = bool>) -> Pixels {
    let places = hit.zip(0..).filter(|(hit, _)| *hit);
    let width = i64::from(SIDE);
    places
        .map(|(_, place)| [place % width, place / width])
        .collect()
}

/// Returns the pixels inked by deterministic iteration to a detail of a pixel.
fn deterministic(system: &ifs::System, view: View) -> Pixels {
    let graph = Graph::of_system(system);
    let mut options = Options::of(system.metadata());
    options.format = Format::Png;
    options.view = view;
    options.size = Size::Exactly(SIDE, SIDE);
    options.style.color_by = ColorBy::None;
    options.style.background = None;
    options.style.width = Width::Pixels(1.0);
    options.detail = Some(Detail {
        pixels: 1.0,
        decides_steps: true,
    });
    let growth = Growth::steps(10_000).max_elements(50_000_000);
    let mut bytes = Vec::new();
    render::write(&graph, &growth, &options, &mut bytes).unwrap();
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::ALPHA);
    let mut reader = decoder.read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut data).unwrap();
    let channels = data.len() / (SIDE * SIDE) as usize;
    pixels(
        data.chunks_exact(channels)
            .map(|pixel| pixel[channels - 1] > 0),
    )
}

/// Returns the pixels hit by random iteration.
fn random(system: &ifs::System, view: View) -> Pixels {
    let size = Size::Exactly(SIDE, SIDE);
    let canvas = Canvas::of_window(view.window.unwrap(), &view, size).unwrap();
    let window = HistogramWindow {
        to_pixels: canvas.to_pixels(),
        size: canvas.size(),
    };
    let game = Game::default().points(1_000_000);
    let histogram = play(&WeightedMaps::of(system.ifs()).unwrap(), &window, &game).unwrap();
    assert_eq!(histogram.inside(), 1_000_000);
    pixels(histogram.counts(0).iter().map(|&count| count > 0))
}

/// Returns the share of pixels that have none of the others within a distance.
fn lonely(pixels: &Pixels, others: &Pixels, distance: i64) -> f64 {
    let range = -distance..=distance;
    let is_lonely = |[x, y]: &&[i64; 2]| {
        let mut around = range
            .clone()
            .flat_map(|dx| range.clone().map(move |dy| [dx, dy]));
        !around.any(|[dx, dy]| others.contains(&[x + dx, y + dy]))
    };
    pixels.iter().filter(is_lonely).count() as f64 / pixels.len() as f64
}

/// Every pixel hit by random iteration is next to one inked by deterministic iteration, except one in 100,
/// where more grows from an element than is drawn of it (the trunk of a tree). Conversely one in 50 may be
/// missed: pixels hit less than once in a million points, of systems with uneven weights.
#[test]
fn random_and_deterministic_iteration_draw_one_set() {
    let mut wrong = Vec::new();
    for (name, system) in library() {
        let view = View {
            window: Some(around(&Graph::of_system(&system))),
            margin: Some(0.0),
        };
        let (inked, hit) = (deterministic(&system, view), random(&system, view));
        let (strange, missed) = (lonely(&hit, &inked, 1), lonely(&inked, &hit, 2));
        if inked.len() < 20 || strange > 0.01 || missed > 0.02 {
            wrong.push(format!("{name}: {strange} strange, {missed} missed"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Returns the first and second moments about a point.
fn moments(points: impl Iterator<Item = DVec2>) -> [f64; 5] {
    let (mut count, mut sums) = (0.0, [0.0; 5]);
    for DVec2 { x, y } in points {
        count += 1.0;
        for (sum, value) in sums.iter_mut().zip([x, y, x * x, x * y, y * y]) {
            *sum += value;
        }
    }
    sums.map(|sum| sum / count)
}

/// Many walks provide their own statistical error.
#[test]
fn the_moments_of_the_library_are_those_of_its_walks() {
    const WALKS: u64 = 40;
    for (name, system) in library() {
        let exact = system.ifs().measure().unwrap().moments;
        let walked = WeightedMaps::of(system.ifs()).unwrap();
        let walks: Vec<_> = (0..WALKS)
            .map(|seed| {
                let points = RandomPoints::new(&walked, &Start::Attractor, seed).take(2_000);
                moments(points.map(|point| point.place - exact.mean))
            })
            .collect();
        let DMat2 { x_axis, y_axis } = exact.covariance;
        let expected = [0.0, 0.0, x_axis.x, x_axis.y, y_axis.y];
        let size = (x_axis.x + y_axis.y).sqrt();
        for (moment, expected) in expected.into_iter().enumerate() {
            let count = WALKS as f64;
            let mean = walks.iter().map(|walk| walk[moment]).sum::<f64>() / count;
            let squares = walks.iter().map(|walk| (walk[moment] - mean).powi(2));
            let error = (squares.sum::<f64>() / (count - 1.0) / count).sqrt();
            let rounding = 1e-12 * size.max(size * size);
            assert!(
                (mean - expected).abs() < 4.5 * error + rounding,
                "{name}: {moment} is {mean} ± {error}, not {expected}"
            );
        }
    }
}

fn kfrac(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("kfrac"));
    command.current_dir(folder).env_remove("KFRAC_LIBRARY");
    command.env("XDG_DATA_HOME", folder.join("data"));
    command.args(arguments.split_whitespace()).output().unwrap()
}

/// Returns the standard error of a command that succeeds.
#[track_caller]
fn said(folder: &Path, arguments: &str) -> String {
    let output = kfrac(folder, arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments}: {said}");
    said
}

#[test]
fn threads_do_not_tell_in_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    for options in [
        "barnsley-fern-four --color-by hits",
        "barnsley-fern",
        "pound-sign --color-by first-map",
        "gasket --color-by last-map --start 3,-1 --start 0,2 --walk 9",
    ] {
        let [one, two, three] = [1, 2, 3].map(|threads| {
            let common = "--method chaos --points 300k --size 100 -o -";
            let output = kfrac(
                folder.path(),
                &format!("grow {options} {common} --threads {threads}"),
            );
            assert!(output.status.success());
            output.stdout
        });
        assert!(one.starts_with(b"\x89PNG"));
        assert!(one == two && one == three, "{options}");
    }
}

#[test]
fn a_picture_says_how_to_make_it_again() {
    let folder = tempfile::tempdir().unwrap();
    let first = said(
        folder.path(),
        "grow gasket --method chaos --points 20k --tone plain --start -1,2.5 --start 3,0 --walk 7 \
         --color-by first-map --steps 3 --seed 5 --size 64x50 --view -2,-1,6,5 --background white \
         -o one.png",
    );
    assert!(
        first.starts_with("one.png: gasket, 20,000 points, 64 x 50 pixels, "),
        "{first}"
    );
    let bytes = fs::read(folder.path().join("one.png")).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let texts = reader.info().utf8_text.iter();
    let mut texts = texts.map(|text| (text.keyword.clone(), text.get_text().unwrap()));
    let (_, comment) = texts.find(|(keyword, _)| keyword == "Comment").unwrap();
    let command = comment.lines().nth(1).unwrap();
    let command = command.strip_prefix("# kfrac ").unwrap();
    fs::write(folder.path().join("gasket.yaml"), &comment).unwrap();
    // A shell would remove the quotes.
    let command = command.replace('\'', "");
    said(folder.path(), &format!("{command} -o two.png"));
    assert_eq!(fs::read(folder.path().join("two.png")).unwrap(), bytes);
}

#[test]
fn points_are_drawn_into_a_png_or_listed() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = said(folder.path(), "grow pound-sign --method chaos --points 10k");
    assert!(drawn.starts_with("pound-sign.png: pound-sign, 10,000 points, 1024 x 1024 pixels, "));
    let quiet = said(
        folder.path(),
        "grow pound-sign --method chaos --points 10k --quiet",
    );
    assert_eq!(quiet, "");
    let part = said(
        folder.path(),
        "grow gasket --method chaos --points 10k --view 0,0,0.5,0.5 --size 50",
    );
    assert!(
        part.contains("10,000 points, 3,9") && part.contains(" inside, 50 x 50 pixels"),
        "{part}"
    );
    let list = "grow cantor --method chaos --points 3 -o -";
    let csv = String::from_utf8(kfrac(folder.path(), &format!("{list} --format csv")).stdout);
    let csv = csv.unwrap();
    let mut rows = csv.lines();
    assert_eq!(rows.next(), Some("x,y,map"));
    for row in rows {
        let cells: Vec<_> = row.split(',').collect();
        let x: f64 = cells[0].parse().unwrap();
        assert_eq!(cells[2], if x < 0.5 { "1" } else { "2" });
    }
    assert_eq!(csv.lines().count(), 4);
    let json = String::from_utf8(kfrac(folder.path(), &format!("{list} --format json")).stdout);
    let json = json.unwrap();
    let row: serde_json::Value = serde_json::from_str(json.lines().next().unwrap()).unwrap();
    let first = csv.lines().nth(1).unwrap();
    assert_eq!(first, format!("{},{},{}", row["x"], row["y"], row["map"]));
}

/// Demko, Hodges & Naylor 1985, figure 4.5: one map, and its walks from several starts.
#[test]
fn ways_from_starts_lie_in_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("spiral.yaml"),
        "kind: ifs\nmaps: [{scale: 0.9, rotate: 20}]\n",
    )
    .unwrap();
    let from = said(
        folder.path(),
        "grow spiral.yaml --method chaos --points 50k --start 1,0 --start -1,0",
    );
    assert!(!from.contains("inside"), "{from}");
    // The attractor itself is a point.
    let bare = kfrac(
        folder.path(),
        "grow spiral.yaml --method chaos --points 50k",
    );
    assert!(bare.status.success());
}

/// Systems that contract on average only are drawn by random iteration and refused wherever a limit set is needed; a
/// symmetric one has pictures of its symmetry.
#[test]
fn systems_that_contract_on_average_are_played() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let text = format!("kind: ifs\nmaps:\n{text}");
        fs::write(folder.path().join(name), text).unwrap();
    };
    write(
        "symmetric.yaml",
        "  - {scale: 0.55, shift: [0.4, 0.1], weight: 1}\n  - {scale: 1, rotate: 72, weight: 1}\n",
    );
    write(
        "seldom.yaml",
        "  - {scale: 1/2, shift: [1, 0], weight: 4}\n  - {scale: 2, rotate: 30, weight: 1}\n",
    );
    write(
        "never.yaml",
        "  - {scale: 1/2, shift: [1, 0], weight: 1}\n  - {scale: 2, rotate: 30, weight: 2}\n",
    );
    let exponent = 0.5 * f64::ln(0.55);
    for (name, exponent) in [("symmetric", exponent), ("seldom", 0.6 * f64::ln(0.5))] {
        let warned = said(
            folder.path(),
            &format!("grow {name}.yaml --method chaos --points 200k --size 100 -o {name}.png"),
        );
        let shown = format!("its Lyapunov exponent is {exponent:.6}");
        assert!(warned.contains(&shown), "{warned}");
        let info = kfrac(folder.path(), &format!("info {name}.yaml --json")).stdout;
        let info: serde_json::Value = serde_json::from_slice(&info).unwrap();
        let found = info["lyapunov_exponent"]["upper"].as_f64().unwrap();
        assert!((found - exponent).abs() < 1e-12);
        assert!(info["limit_bounds"].is_null() && info["contraction"]["contracts"] == false);
        for refused in [
            "grow NAME --zoom 10 --at 0.(0) -o x.png",
            "convert NAME --to instancing",
            "compare NAME NAME",
        ] {
            let command = refused.replace("NAME", &format!("{name}.yaml"));
            let output = kfrac(folder.path(), &command);
            let said = String::from_utf8(output.stderr).unwrap();
            assert!(
                !output.status.success() && said.contains("on average only"),
                "{command}: {said}"
            );
        }
        said(
            folder.path(),
            &format!("grow {name}.yaml --steps 4 -o {name}.svg"),
        );
    }
    let refused = String::from_utf8(kfrac(folder.path(), "info never.yaml").stderr).unwrap();
    assert!(refused.contains("map 2 does not contract"), "{refused}");

    // The points have the exact mean of the measure.
    let text = fs::read_to_string(folder.path().join("symmetric.yaml")).unwrap();
    let source = kfrac::diagnostic::Source::new("symmetric", text);
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    let Model::Ifs(system) = document.resolve(&[]).unwrap().0 else {
        unreachable!()
    };
    let maps = WeightedMaps::of(system.ifs()).unwrap();
    let points = RandomPoints::new(&maps, &Start::Attractor, 1).take(200_000);
    let mean = points.map(|point| point.place).sum::<DVec2>() / 200_000.0;
    let exact = system.ifs().measure().unwrap().moments.mean;
    assert!(mean.distance(exact) < 0.01, "{mean} {exact}");
}

#[test]
fn what_cannot_be_played_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let one_way = "kind: ifs\nmaps: [{scale: 1/2}, {scale: 1/2, shift: [1, 0]}]\n\
                   edges: {1: [1, 2], 2: [2]}\n";
    fs::write(folder.path().join("one-way.yaml"), one_way).unwrap();
    for (arguments, status, says) in [
        (
            "gasket --points 5",
            2,
            "--points applies to random iteration: add --method chaos",
        ),
        ("gasket --color-by hits", 2, "add --method chaos, or --tone"),
        (
            "gasket --method chaos --points 0",
            2,
            "a whole number from 1",
        ),
        (
            "gasket --method chaos --points -5",
            2,
            "a whole number from 1",
        ),
        (
            "gasket --method chaos --points 2000G",
            2,
            "the limit is 1000G",
        ),
        ("gasket --method chaos --start 1", 2, "expected a point X,Y"),
        (
            "gasket --method chaos --start 1,NaN",
            2,
            "expected a point X,Y",
        ),
        ("gasket --method chaos --walk 3", 2, "--start"),
        (
            "gasket --method chaos --start 1,1 --walk 0",
            2,
            "a number of steps is a whole number from 1",
        ),
        ("gasket --method chaos -o x.svg", 2, "too many for an SVG"),
        (
            "gasket --method chaos --detail 1",
            2,
            "--detail applies to elements",
        ),
        (
            "gasket --method chaos --steps 3",
            2,
            "--points is the number of points",
        ),
        (
            "gasket --method chaos --color-by age",
            2,
            "hits, last-map or first-map",
        ),
        (
            "gasket --method chaos --cap butt",
            2,
            "--cap applies to lines",
        ),
        (
            "gasket --method dice",
            2,
            "[possible values: deterministic, chaos]",
        ),
        (
            "koch --method chaos",
            2,
            "needs a system of maps (kind: ifs), and koch is of the kind rule",
        ),
        (
            "one-way.yaml --method chaos",
            1,
            "map 1 never comes after map 2",
        ),
        ("gasket --method chaos --start 1e300,0", 1, ""),
        (
            "gasket --method chaos --format csv --points 60M",
            1,
            "--max-elements 50000000",
        ),
        (
            "gasket --method chaos --size 20000",
            1,
            "take more than 268435456 counters, with one for each class (1); use a smaller --size, or \
             --method deterministic, which draws large pictures in bands",
        ),
    ] {
        let output = kfrac(folder.path(), &format!("grow {arguments}"));
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(status), "{arguments}: {said}");
        assert!(said.contains(says), "{arguments}: {said}");
        assert!(said.starts_with("error: "), "{arguments}: {said}");
    }
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(left.len(), 1);
    let sheet = kfrac(folder.path(), "sheet gasket --color-by hits");
    assert_eq!(sheet.status.code(), Some(2));
}
