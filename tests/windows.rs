//! Windows are details of the whole picture.

use crate::common::{compiled, document, resolved};
use crate::threads::library;
use kfrac::geometry::DVec2;
use kfrac::graph::Graph;
use kfrac::grow::{Growth, WalkError};
use kfrac::render::{self, Detail, Format, NoDetail, Options, RenderError, Size};
use kfrac::style::{ColorBy, Named, View};
use resvg::tiny_skia::Pixmap;

/// A window shows that part of the whole picture although little is visited.
#[test]
fn windows_are_cut_out_of_pictures_that_are_coloured_by_index() {
    for (name, steps, pixels) in [
        ("dragon", 14, None),
        ("gosper", 6, None),
        ("hilbert", 7, None),
        ("snowflake-sweep", 30, Some(2.0)),
        ("cesaro-sweep", 30, Some(1.5)),
        ("dragon-wreath", 30, Some(2.0)),
    ] {
        let rule = resolved(&document(name), &[]);
        let graph = compiled(&rule, steps);
        let of = |place, side| {
            let mut options = Options::of(rule.metadata())
                .format(Format::Png)
                .view(View {
                    window: Some(place),
                    margin: Some(0.0),
                })
                .size(Size::Exactly(side, side))
                .detail(pixels.map(|pixels| Detail {
                    pixels,
                    decides_steps: true,
                }));
            options.style.color_by = ColorBy::Index;
            let mut bytes = Vec::new();
            let growth = Growth::steps(steps);
            let picture = render::write(&graph, &growth, &options, &mut bytes).unwrap();
            let pixels = Pixmap::decode_png(&bytes).unwrap();
            (picture.elements, pixels)
        };
        let (all, whole) = of([-2.03, -2.01, 5.0, 5.0], 640);
        for [column, row] in [[4, 3], [3, 4], [4, 4]] {
            let [x, y] = [column, 7 - row].map(|part| 0.625 * f64::from(part));
            let (some, part) = of([x - 2.03, y - 2.01, 0.625, 0.625], 80);
            assert!(some < all, "{name}: {some} of {all}");
            for (line, pixels) in part.pixels().chunks(80).enumerate() {
                let start = (row as usize * 80 + line) * 640 + column as usize * 80;
                let same = pixels == &whole.pixels()[start..start + 80];
                assert!(same, "{name}, line {line} of {column}, {row}");
            }
        }
    }
}

/// A window of any picture of the library is the crop of the whole, or of the doubled picture, but for the rounding of
/// places: edges lie on hundredths of a pixel and on 64 samples of it.
#[test]
fn windows_of_the_library_are_crops_within_rounding() {
    let mut checked = 0;
    for (name, model, graph, steps) in library(3_000) {
        let options = Options::of(model.metadata());
        checked += u32::from(are_crops(&name, &graph, [steps; 2], &options));
    }
    assert!(checked > 120, "{checked}");
}

/// The steps of a window that is grown to a detail, and with them its colours, are those of the whole.
#[test]
fn colours_of_windows_by_step_are_those_of_the_whole() {
    let mut checked = 0;
    for (name, model, _, _) in library(3_000) {
        let Ok(graph) = model.compile_for(400, 0, 20_000) else {
            continue;
        };
        if !graph.shrinks() || graph.steps_to(0.0).is_none() || graph.is_time_indexed() {
            continue;
        }
        // Without seeds, all elements have one age.
        let has_seeds = document(&name).to_yaml().contains("seeds");
        let all = [ColorBy::Step, ColorBy::Age];
        for color_by in all.into_iter().take(1 + usize::from(has_seeds)) {
            let mut options = Options::of(model.metadata()).detail(Some(Detail {
                pixels: 3.0,
                decides_steps: true,
            }));
            options.style.color_by = color_by;
            checked += u32::from(are_crops(&name, &graph, [8, 400], &options));
        }
    }
    assert!(checked > 60, "{checked}");
}

/// Checks that windows of an approximant are crops of a picture of an earlier one's box; returns whether that has a size
/// and the steps are enough for a detail, and not too many.
fn are_crops(name: &str, graph: &Graph, [earlier, steps]: [u32; 2], options: &Options) -> bool {
    const WHOLE: usize = 160;
    const PART: usize = 80;
    let growth = Growth::steps(steps);
    let Ok(bounds) = kfrac::extent::bounding_box(graph, &Growth::steps(earlier)) else {
        return false;
    };
    let side = 1.1 * bounds.size().max_element();
    if !(side > 0.0 && side.is_finite()) {
        return false;
    }
    let corner = ((bounds.min() + bounds.max()) / 2.0) - DVec2::splat(side / 2.0);
    let draw = |corner: DVec2, side: f64, pixels: usize| {
        let options = options
            .clone()
            .view(View {
                window: Some([corner.x, corner.y, side, side]),
                margin: Some(0.0),
            })
            .size(Size::Long(u32::try_from(pixels).unwrap()));
        match render::pixels(graph, &growth, &options) {
            Err(
                RenderError::NoDetail(NoDetail::TooFewSteps { .. })
                | RenderError::Walk(WalkError::TooManyElements { .. }),
            ) => None,
            drawn => Some(drawn.unwrap_or_else(|error| panic!("{name}: {error}"))),
        }
    };
    let Some(whole) = draw(corner, side, WHOLE) else {
        return false;
    };
    for [column, row] in [[40, 40], [17, 66]] {
        // Rows are counted from the top.
        let below = WHOLE - PART - row;
        let shift = DVec2::new(column as f64, below as f64) * (side / WHOLE as f64);
        let part = draw(corner + shift, side * PART as f64 / WHOLE as f64, PART);
        let part = part.unwrap_or_else(|| panic!("{name}: a part needs more steps"));
        let mut differences = Vec::with_capacity(4 * PART * PART);
        for (line, bytes) in part.premultiplied().chunks_exact(4 * PART).enumerate() {
            let start = 4 * ((row + line) * WHOLE + column);
            let crop = &whole.premultiplied()[start..start + 4 * PART];
            differences.extend(crop.iter().zip(bytes).map(|(a, b)| a.abs_diff(*b)));
        }
        let most = differences.iter().max().copied().unwrap_or(0);
        let total: u64 = differences.iter().map(|it| u64::from(*it)).sum();
        let mean = total as f64 / differences.len() as f64;
        assert!(
            most <= 64 && mean <= 0.2,
            "{name} at step {steps} by {}: {most}, {mean} in the mean",
            options.style.color_by.name()
        );
    }
    true
}
