//! Windows are details of the whole picture.

use crate::common::{compiled, document, resolved};
use kfrac::grow::Growth;
use kfrac::render::{self, Detail, Format, Options, Size};
use kfrac::style::{ColorBy, View};
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
