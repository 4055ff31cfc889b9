//! The front door against the rooms behind it.

use std::error::Error as _;
use std::num::NonZero;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::catalogue::{Catalogue, Shelf};
use crate::export::Column;
use crate::grow::WalkError;
use crate::measure::Precision;
use crate::render::space::{Camera, Light, Shade, SpaceOptions};
use crate::render::{self, Options, RenderError, ZoomTarget};
use crate::style::{Colour, View};

use super::{Error, Fractal};

/// Returns a fractal of the library.
fn named(name: &str) -> Fractal {
    match Fractal::named(name) {
        Ok(fractal) => fractal,
        Err(error) => panic!("{name}: {error}"),
    }
}

/// Returns the fractal without paper in PNG.
fn without_paper(fractal: Fractal) -> Fractal {
    let mut style = fractal.model().metadata().style.clone();
    style.background.get_or_insert(Colour::TRANSPARENT);
    fractal.style(style)
}

#[test]
fn every_file_of_the_library_has_pixels_like_its_png() {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries();
    let grown = |shelf| Shelf::grown().contains(&shelf);
    let mut drawn = 0;
    for entry in entries.iter().filter(|entry| grown(entry.shelf)) {
        let steps = if entry.name == "plus-sign" { 1 } else { 3 };
        let fractal = without_paper(named(&entry.name).steps(steps));
        // Some draw nothing yet.
        let (Ok(pixels), Ok(png)) = (fractal.pixels(64), fractal.png(64)) else {
            continue;
        };
        let decoded = tiny_skia::Pixmap::decode_png(&png).expect("it is a PNG");
        assert_eq!(pixels.size(), [decoded.width(), decoded.height()]);
        let straight = pixels.into_straight();
        let premultiplied = straight.chunks_exact(4).map(|pixel| {
            tiny_skia::ColorU8::from_rgba(pixel[0], pixel[1], pixel[2], pixel[3]).premultiply()
        });
        let is_same = premultiplied.eq(decoded.pixels().iter().copied());
        assert!(is_same, "{}", entry.name);
        drawn += 1;
    }
    assert!(drawn > 100, "{drawn}");
}

#[test]
fn results_are_those_of_the_rooms() -> Result<(), Error> {
    let dragon = named("dragon").steps(6);
    let graph = dragon.model().compile(6).expect("it is compiled");
    let description = &dragon.model().metadata().description;
    let mut svg = Vec::new();
    let options = Options {
        labels: render::Labels {
            title: description.title.clone().unwrap_or_default(),
            description: description.about.clone().unwrap_or_default(),
            ..render::Labels::default()
        },
        ..Options::of(dragon.model().metadata())
    }
    .on_paper();
    render::write(&graph, &crate::grow::Growth::steps(6), &options, &mut svg)?;
    assert!(dragon.svg()?.as_bytes() == svg);
    assert_eq!(dragon.elements()?.count(), 64);
    assert_eq!(
        dragon.forecast()?.map(|it| it.elements().to_u64()),
        Some(Some(64))
    );
    assert_eq!(dragon.bounds()?, graph.bounds(6).expect("it has a box"));
    let one = dragon.clone().threads(NonZero::<usize>::MIN);
    assert_eq!(one.png(300)?, dragon.png(300)?);
    Ok(())
}

#[test]
fn limits_and_flags_end_growing_with_an_error() {
    let koch = named("koch").steps(12).max_elements(1000);
    let error = koch.svg().expect_err("it has more elements");
    assert!(matches!(
        error,
        Error::Render(RenderError::Walk(WalkError::TooManyElements {
            limit: 1000
        }))
    ));
    let listed = koch.elements().expect("it is compiled").last();
    assert!(matches!(
        listed,
        Some(Err(Error::Walk(WalkError::TooManyElements { limit: 1000 })))
    ));
    let cancelled = named("koch")
        .steps(10)
        .cancel(Arc::new(AtomicBool::new(true)));
    let errors = [
        cancelled.pixels(100).err(),
        cancelled.svg().err(),
        cancelled.elements().err(),
        cancelled.bounds().err(),
        cancelled.dimension().err(),
    ];
    for error in errors {
        let error = error.expect("it is cancelled");
        assert!(error.is_cancelled() && error.source().is_none());
    }
    assert!(
        !named("koch")
            .steps(12)
            .max_elements(10)
            .svg()
            .is_err_and(|it| it.is_cancelled())
    );
}

#[test]
fn a_file_appears_whole_or_not_at_all() {
    let folder = tempfile::tempdir().expect("there is room");
    let path = folder.path().join("koch.svg");
    let koch = named("koch").steps(3);
    koch.write(&path).expect("it is written");
    let before = std::fs::read(&path).expect("it is there");
    assert_eq!(before, koch.svg().expect("it is drawn").into_bytes());
    koch.max_elements(10)
        .write(&path)
        .expect_err("it has more elements");
    assert_eq!(std::fs::read(&path).expect("it is there"), before);
    let files = std::fs::read_dir(folder.path()).expect("it is there");
    assert_eq!(files.count(), 1);
    let error = named("koch").write(folder.path().join("koch.bmp"));
    assert!(error.is_err_and(|error| error.diagnostics().is_some()));
}

#[test]
fn parameters_are_checked() {
    let error = named("pythagoras")
        .set("angel", 1.0)
        .expect_err("there is none");
    assert!(
        error.to_string().contains("did you mean 'angle'?"),
        "{error}"
    );
    let error = named("koch").set("angle", 1.0).expect_err("it has none");
    assert!(error.to_string().contains("it has none"), "{error}");
    let model = named("pythagoras").model().clone();
    assert!(Fractal::from(model).set("angle", 30.0).is_err());
}

#[test]
fn a_set_in_space_is_drawn_and_measured_by_its_own_methods() -> Result<(), Error> {
    let folder = tempfile::tempdir().expect("there is room");
    let path = folder.path().join("menger.png");
    let space = SpaceOptions::default().camera(Camera::default().from([0.0, 0.0]));
    let sponge = named("menger").steps(3).size(64);
    let front = sponge.clone().space(space);
    front.write(&path)?;
    let written = std::fs::read(&path).expect("it is there");
    assert_eq!(written, front.png(64)?);
    assert_ne!(written, sponge.png(64)?);
    assert_eq!(front.svg()?.matches("<path").count(), 8 * 8 * 8);
    let forecast = sponge.forecast_in_space()?.expect("it is known");
    assert_eq!(forecast.elements().to_u64(), Some(8000));
    assert_eq!(sponge.elements_in_space()?.count(), 8000);
    assert_eq!(sponge.bounds_in_space()?.size().to_array(), [1.0; 3]);
    // Without a number of steps and without one in the file, the limit is drawn.
    assert!(named("pylon").detail(2.0).png(64).is_ok());

    let dimension = sponge.dimension()?;
    assert_eq!(dimension.closed_form.as_deref(), Some("log(20)/log(3)"));

    let window = View {
        window: Some([0.0, 0.0, 1.0, 1.0]),
        ..View::default()
    };
    let errors = [
        sponge.elements().err(),
        sponge.forecast().err(),
        sponge.bounds().err(),
        sponge.clone().view(window).pixels(64).err(),
    ];
    for error in errors {
        let error = error.expect("it lies in space");
        assert!(error.to_string().starts_with("it lies in space: "));
    }
    let koch = named("koch");
    let errors = [
        koch.elements_in_space().err(),
        koch.forecast_in_space().err(),
        koch.bounds_in_space().err(),
    ];
    for error in errors {
        let error = error.expect("it lies in the plane");
        assert!(error.to_string().starts_with("it lies in the plane: "));
    }
    let cancelled = sponge.cancel(Arc::new(AtomicBool::new(true)));
    let errors = [
        cancelled.pixels(64).err(),
        cancelled.elements_in_space().err(),
        cancelled.bounds_in_space().err(),
    ];
    assert!(errors.into_iter().flatten().all(|it| it.is_cancelled()));
    Ok(())
}

#[test]
fn elements_know_whether_they_are_drawn() {
    let text =
        "initiator: segment\ngenerator: [[0, 0], [1/3, 0], {to: [2/3, 0], visible: false}, [1, 0]]";
    let gaps = Fractal::parse(text).unwrap().steps(2);
    let visible = gaps.elements().unwrap().map(|it| it.unwrap().visible);
    // Visibility belongs to the last generator's elements: what replaces an invisible element may be visible.
    let expected = [true, false, true].repeat(3);
    assert_eq!(visible.collect::<Vec<_>>(), expected);
}

#[test]
fn the_view_of_a_file_is_that_of_its_pictures() {
    let text = "{kind: ifs, space: 3, vertices: {solid: cube, shrink: 1/3}, VIEW}";
    let parse = |view: &str| Fractal::parse(&text.replace("VIEW", view)).unwrap();
    let plain = parse("steps: 2");
    let viewed = parse("steps: 2, view: {from: side, shade: relief, light: top, perspective: 30}");
    let camera = Camera::default().from([90.0, 0.0]).perspective(Some(30.0));
    let space = SpaceOptions::default()
        .camera(camera)
        .shade(Some(Shade::Relief))
        .light(Light::default().from([0.0, 90.0]));
    let own = viewed.pixels(40).unwrap();
    assert!(own != plain.pixels(40).unwrap());
    assert!(own == plain.clone().space(space).pixels(40).unwrap());
    let default = SpaceOptions::default();
    assert!(viewed.space(default).pixels(40).unwrap() == plain.pixels(40).unwrap());
}

#[test]
fn columns_are_those_of_the_elements() -> Result<(), Error> {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries();
    let grown = |shelf| Shelf::grown().contains(&shelf);
    let mut tried = 0;
    for entry in entries.iter().filter(|entry| grown(entry.shelf)) {
        let fractal = named(&entry.name).steps(3).max_elements(20_000);
        let columns = fractal.clone().threads(NonZero::new(3).unwrap()).columns();
        if fractal.model().is_in_space() {
            let elements: Result<Vec<_>, _> = fractal.elements_in_space()?.collect();
            assert_eq!(
                columns.ok().map(|it| it.rows()),
                elements.ok().map(|it| it.len())
            );
            continue;
        }
        let elements: Result<Vec<_>, _> = fractal.elements()?.collect();
        let (Ok(columns), Ok(elements)) = (columns, elements) else {
            continue;
        };
        let index = elements.iter().map(|it| i64::try_from(it.index).unwrap());
        assert_eq!(columns.get("index"), Some(&Column::Wholes(index.collect())));
        // Elements that are placed as blocks have other roundings than those that are placed one by one.
        for (name, at) in [("x0", 0), ("y0", 1), ("x1", 2), ("y1", 3)] {
            let expected = elements.iter().map(|it| {
                let [from, to] = it.frame.ends();
                [from.x, from.y, to.x, to.y][at]
            });
            let Some(Column::Reals(found)) = columns.get(name) else {
                panic!("{} has no {name}", entry.name);
            };
            assert_eq!(found.len(), elements.len());
            for (found, expected) in found.iter().zip(expected) {
                let difference = (found - expected).abs();
                assert!(
                    difference <= 1e-13 * (1.0 + expected.abs()),
                    "{}",
                    entry.name
                );
                assert!(found.is_sign_positive() || *found < 0.0);
            }
        }
        let direction = { elements.iter() }.map(|it| it.frame.direction().number());
        assert_eq!(
            columns.get("direction"),
            Some(&Column::Bytes(direction.collect()))
        );
        let joined = elements.iter().map(|it| it.joined);
        assert_eq!(
            columns.get("joined"),
            Some(&Column::Flags(joined.collect()))
        );
        tried += 1;
    }
    assert!(tried > 100, "{tried}");
    Ok(())
}

/// Where entries of products might lie beyond the range of numbers, elements are placed one by one.
#[test]
fn columns_reach_to_the_end_of_the_range() -> Result<(), Error> {
    let koch = |length: &str| {
        let text = format!("{{initiator: [[0, 0], [{length}, 0]], generator: koch}}");
        Fractal::parse(&text)?.steps(4).columns()
    };
    let (near, far) = (koch("1e140")?, koch("9e149")?);
    let [near, far] = [near, far].map(|it| match it.get("x1") {
        Some(Column::Reals(x)) => x.clone(),
        other => panic!("{other:?}"),
    });
    assert_eq!(near.len(), 256);
    for (near, far) in near.iter().zip(far) {
        assert!((near / 1e140 - far / 9e149).abs() < 1e-14);
    }
    assert!(koch("2e150").is_err());
    Ok(())
}

#[test]
fn the_file_has_the_values_that_are_set() -> Result<(), Error> {
    let text = "{kind: ifs, params: {s: [0.5, 0.25], t: {value: 1/3, min: 0}}, \
                maps: [{times: s}, {times: s, shift: [t, 0]}]}";
    let system = Fractal::parse(text)?.set_all([("s.im", 0.125), ("t", 0.75)])?;
    let again = Fractal::parse(&system.yaml().unwrap())?;
    let values = |it: &Fractal| it.model().metadata().parameters.clone();
    assert_eq!(values(&again), values(&system));
    assert_eq!(
        values(&again).iter().map(|it| it.value).collect::<Vec<_>>(),
        [0.5, 0.125, 0.75]
    );
    assert_eq!(Fractal::from(system.model().clone()).yaml(), None);
    Ok(())
}

#[test]
fn a_zoom_has_pixels_like_its_png() -> Result<(), Error> {
    let target = ZoomTarget::new("3^30".parse().unwrap(), "0.(1)".parse().unwrap());
    let koch = without_paper(named("koch").zoom(Some(target.clone())));
    let decoded = tiny_skia::Pixmap::decode_png(&koch.png(64)?).expect("it is a PNG");
    let pixels = koch.pixels(64)?;
    assert_eq!(pixels.size(), [decoded.width(), decoded.height()]);
    let paper = tiny_skia::Pixmap::decode_png(&named("koch").png(64)?).expect("it is a PNG");
    assert!(paper.pixels().iter().all(|pixel| pixel.alpha() == 255));
    let covered = |bytes: &[u8]| {
        bytes
            .chunks_exact(4)
            .map(|pixel| pixel[3])
            .collect::<Vec<_>>()
    };
    assert_eq!(covered(pixels.premultiplied()), covered(decoded.data()));
    assert_ne!(koch.pixels(64)?, named("koch").pixels(64)?);
    let error = named("menger").zoom(Some(target)).pixels(64).unwrap_err();
    assert!(error.to_string().starts_with("it lies in space"));
    Ok(())
}

#[test]
fn histograms_cover_the_attractor_or_the_window() -> Result<(), Error> {
    let square = "{kind: ifs, vertices: {points: [[0, 0], [1, 0], [0, 1], [1, 1]], shrink: 1/2}}";
    let square = Fractal::parse(square)?;
    let whole = square.histogram(100_000, 32)?;
    assert_eq!((whole.size(), whole.inside()), ([32, 32], 100_000));
    let window = View {
        window: Some([0.0, 0.0, 0.5, 0.5]),
        margin: Some(0.0),
    };
    let quarter = square.view(window).histogram(100_000, 32)?.inside();
    assert!(quarter.abs_diff(25_000) < 1_000, "{quarter}");
    let error = named("koch").histogram(1000, 32).unwrap_err();
    assert!(error.diagnostics().is_some());
    Ok(())
}

#[test]
fn distances_are_symmetric_and_in_the_unit_of_the_files() -> Result<(), Error> {
    let precision = Precision {
        tolerance: 0.01,
        ..Precision::default()
    };
    let curve = |size: f64| {
        let text = "{initiator: [[0, 0], [SIZE, 0]], generator: [[0, 0], [1/3, 0], [1/2, 0.3], [2/3, 0], [1, 0]]}";
        Fractal::parse(&text.replace("SIZE", &size.to_string()))
    };
    let (small, large) = (curve(1000.0)?, curve(2000.0)?);
    let there = small.compare(&large, None, &precision)?;
    let back = large.compare(&small, None, &precision)?;
    assert!((there.value() - 1000.0).abs() <= there.error, "{there:?}");
    assert!((there.value() - back.value()).abs() <= there.error + back.error);
    assert!(small.compare(&small, Some(3), &precision)?.may_be_same());
    assert!(small.compare(&named("menger"), None, &precision).is_err());
    let (sponge, coarse) = (
        named("menger"),
        Precision {
            tolerance: 0.1,
            ..precision
        },
    );
    assert!(sponge.compare(&sponge, Some(1), &coarse)?.may_be_same());
    Ok(())
}

#[test]
fn sets_in_space_are_written_for_other_programs() {
    let folder = tempfile::tempdir().unwrap();
    let sponge = named("menger").steps(2);
    let written = |name: &str| {
        let path = folder.path().join(name);
        sponge.write(&path).unwrap();
        std::fs::read(path).unwrap()
    };
    // A header of 80 bytes, the number of triangles, and 50 bytes for each: 12 of each of 400 cubes.
    let stl = written("sponge.stl");
    assert_eq!(stl[80..84], (400u32 * 12).to_le_bytes());
    assert_eq!(stl.len(), 84 + 50 * 400 * 12);
    let starts = [
        ("sponge.PLY", "ply\n"),
        ("sponge.usda", "#usda 1.0"),
        ("sponge.glb", "glTF"),
        ("sponge.3mf", "PK"),
    ];
    for (name, start) in starts {
        assert!(written(name).starts_with(start.as_bytes()), "{name}");
    }
    for name in ["sponge.obj", "sponge.pov"] {
        assert!(!written(name).is_empty(), "{name}");
    }
    let path = folder.path().join("none.stl");
    let deep = named("menger").steps(9).write(&path);
    assert!(
        matches!(deep, Err(Error::Walk(WalkError::TooManyElements { .. }))),
        "{deep:?}"
    );
    let flat = named("koch").write(&path);
    assert!(matches!(flat, Err(Error::InPlane(_))), "{flat:?}");
    assert!(!path.exists());
    // A scene of instances holds any depth.
    named("menger")
        .steps(40)
        .write(folder.path().join("deep.usda"))
        .unwrap();
}
