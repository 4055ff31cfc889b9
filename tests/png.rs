//! PNG and SVG show the same picture: resvg renders the SVG, which is compared with kfrac's PNG.

use std::sync::Arc;

use crate::common::{self, compiled, document, document_of, resolved};
use kfrac::grow::Growth;
use kfrac::render::{self, Format, Labels, Options, PngEncoding, Size};
use kfrac::rule::Rule;
use png::{BitDepth, ColorType};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg;

/// Tolerance of the mean difference of pixel values, of 255, on white and on black.
///
/// tiny-skia draws in a PNG what resvg draws of the SVG. The strokes of the SVG are in units of the file, a
/// hundred to a pixel, to which other corners are rounded. Coverage is closer to the true area, which resvg
/// shows at four times the size. A pixel is therefore compared with both renderings, and the nearer one
/// counts. The mean is largest where strokes fill the picture with their edges.
const MEAN: f64 = 1.0;
/// Tolerance of the largest difference: one of the four lines by which an edge is sampled.
const WORST: u8 = 48;
/// Tolerance of the largest difference with areas narrower than a pixel. They are a pixel wide in both
/// formats, but in an SVG they have round corners, and strokes whose widths are multiples of a quarter of a
/// pixel.
const WORST_OF_AREAS: u8 = 72;
const TIMES: [usize; 2] = [1, 4];

fn drawn(rule: &Arc<Rule>, steps: u32, options: &Options) -> Vec<u8> {
    let mut bytes = Vec::new();
    let graph = compiled(rule, steps);
    render::write(&graph, &Growth::steps(steps), options, &mut bytes)
        .unwrap_or_else(|error| panic!("{:?} at {steps}: {error}", rule.description().title));
    bytes
}

/// Returns the pixels of an SVG on a background, red, green and blue, rendered at a multiple of its size and
/// averaged, and its width and height.
fn read_svg(svg: &[u8], background: Color, times: usize) -> (Vec<[u8; 3]>, [u32; 2]) {
    let tree = usvg::Tree::from_data(svg, &usvg::Options::default()).unwrap();
    let size = tree.size().to_int_size();
    let [width, height] = [size.width() as usize, size.height() as usize];
    let side = |side: usize| u32::try_from(side * times).unwrap();
    let mut pixmap = Pixmap::new(side(width), side(height)).unwrap();
    pixmap.fill(background);
    let larger = Transform::from_scale(times as f32, times as f32);
    resvg::render(&tree, larger, &mut pixmap.as_mut());
    let mean = |x: usize, y: usize| {
        let mut sums = [0; 3];
        for row in 0..times {
            let start = ((y * times + row) * width + x) * times;
            for pixel in &pixmap.pixels()[start..start + times] {
                sums[0] += usize::from(pixel.red());
                sums[1] += usize::from(pixel.green());
                sums[2] += usize::from(pixel.blue());
            }
        }
        let pixels = times * times;
        sums.map(|sum| u8::try_from((sum + pixels / 2) / pixels).unwrap())
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let means = pixels.map(|(x, y)| mean(x, y)).collect();
    (means, [size.width(), size.height()])
}

/// A decoded PNG: header, texts, and red, green, blue and opacity of every pixel.
struct Read {
    colour: ColorType,
    depth: BitDepth,
    texts: Vec<(String, String)>,
    size: [u32; 2],
    rgba: Vec<[u8; 4]>,
}

fn read_png(bytes: &[u8]) -> Read {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    let header = decoder.read_header_info().unwrap();
    let (colour, depth) = (header.color_type, header.bit_depth);
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::ALPHA);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    reader.finish().unwrap();
    let rgba = match info.color_type {
        ColorType::Rgba => pixels.chunks(4).map(|p| [p[0], p[1], p[2], p[3]]).collect(),
        ColorType::GrayscaleAlpha => pixels.chunks(2).map(|p| [p[0], p[0], p[0], p[1]]).collect(),
        other => panic!("{other:?}"),
    };
    let texts = &reader.info().utf8_text;
    Read {
        colour,
        depth,
        texts: texts
            .iter()
            .map(|text| (text.keyword.clone(), text.get_text().unwrap()))
            .collect(),
        size: [info.width, info.height],
        rgba,
    }
}

/// Returns mean and largest difference on a background that is white or black.
fn difference(png: &Read, svgs: &[Vec<[u8; 3]>], background: u8) -> (f64, u8) {
    let (mut sum, mut worst) = (0.0, 0);
    for (pixel, ours) in png.rgba.iter().enumerate() {
        for (channel, our) in ours[..3].iter().enumerate() {
            let over = u32::from(*our) * u32::from(ours[3])
                + u32::from(background) * u32::from(255 - ours[3]);
            let over = u8::try_from((over + 127) / 255).unwrap();
            let theirs = svgs.iter().map(|svg| svg[pixel][channel]);
            let nearest = theirs.map(|their| over.abs_diff(their)).min().unwrap();
            sum += f64::from(nearest);
            worst = worst.max(nearest);
        }
    }
    (sum / (3.0 * png.rgba.len() as f64), worst)
}

/// Asserts that a picture's two formats agree.
fn agree(name: &str, rule: &Arc<Rule>, steps: u32, size: u32) {
    let options = |format| {
        Options::of(rule.metadata())
            .format(format)
            .size(Size::Long(size))
    };
    let svg = drawn(rule, steps, &options(Format::Svg));
    let png = read_png(&drawn(rule, steps, &options(Format::Png)));
    let has_areas = compiled(rule, steps)
        .base_elements()
        .iter()
        .any(|it| it.is_closed());
    let most = if has_areas { WORST_OF_AREAS } else { WORST };
    for (background, value) in [(Color::WHITE, 255), (Color::BLACK, 0)] {
        let svgs = TIMES.map(|times| {
            let (pixels, size) = read_svg(&svg, background, times);
            assert_eq!(png.size, size);
            pixels
        });
        let (mean, worst) = difference(&png, &svgs, value);
        assert!(
            mean <= MEAN && worst <= most,
            "{name} at {steps}: {mean:.4} on average, {worst} at worst"
        );
    }
}

#[test]
fn both_formats_of_the_whole_library_are_the_same_picture() {
    for name in &common::plane_rules() {
        let rule = resolved(&document(name), &[]);
        // The lines of the quilt lie closer than pixels in a small picture.
        let size = if name == "pursuit-quilt" { 1024 } else { 256 };
        agree(name, &rule, rule.steps().unwrap_or(4).min(8), size);
    }
}

#[test]
fn both_formats_agree_on_every_style() {
    const CHAIN: &str = "initiator: triangle\ngenerator: koch\n";
    const TREE: &str = "initiator: segment\ngenerator: pythagoras\n";
    const SQUARES: &str = "initiator: segment\ngenerator: levy\nbase_element: square\n";
    const ARCS: &str = "initiator: segment\ngenerator: dragon\nbase_element: half-circle\n";
    const RINGS: &str = "initiator: square\ngenerator: {parts: [{elements: [[0, 0], {to: [1, 0], fertile: false}]}, {seeds: true, closed: true, elements: [[1/3, 1/3], [2/3, 1/3], [2/3, 2/3], [1/3, 2/3]]}]}\n";
    for (rule, style) in [
        (
            CHAIN,
            "stroke: rgb(200 0 100 / 40%), width: 9, fill: rgb(0 80 200 / 50%), join: miter",
        ),
        (
            CHAIN,
            "fill: gold, color_by: index, palette: plasma, width: 3",
        ),
        (
            CHAIN,
            "background: \"#fafae680\", stroke: navy, width: 5, join: bevel, cap: butt",
        ),
        (
            TREE,
            "width: {relative: 0.3}, cap: square, color_by: step, palette: leaf",
        ),
        (
            TREE,
            "width: {relative: 0.2}, cap: butt, join: miter, stroke: rgb(0 0 0 / 30%)",
        ),
        (TREE, "width: 0.4"),
        (TREE, "width: 0"),
        (
            SQUARES,
            "fill: rgb(20 120 20 / 30%), stroke: black, width: 2",
        ),
        (SQUARES, "color_by: direction, palette: sunset"),
        (ARCS, "width: 4, color_by: generator, palette: ice"),
        (
            RINGS,
            "fill: rgb(200 60 20 / 20%), stroke: maroon, width: 1",
        ),
    ] {
        let text = format!("{rule}style: {{{style}}}\n");
        let rule = resolved(&document_of(&text), &[]);
        agree(&text, &rule, 3, 200);
    }
}

#[test]
fn windows_show_the_same_part() {
    let text = "initiator: segment\ngenerator: koch\nview: {window: [0.3, 0.1, 0.02, 0.015]}\nstyle: {width: 2}\n";
    agree(text, &resolved(&document_of(text), &[]), 7, 200);
}

/// The path has more vertices than are drawn at once, in a colour that would show overlaps.
#[test]
fn long_paths_are_drawn_as_one() {
    let text =
        "initiator: segment\ngenerator: levy\nstyle: {width: 1.2, stroke: rgb(0 60 120 / 40%)}\n";
    agree(text, &resolved(&document_of(text), &[]), 18, 700);
}

/// The pixels of a picture are stored as grey, with a palette, or in full.
#[test]
fn pixels_take_no_more_bits_than_they_need() {
    let squares = "initiator: square\ngenerator: carpet\nbase_element: square\n";
    let chain = "initiator: triangle\ngenerator: koch\n";
    for (text, expected) in [
        (
            format!("{chain}style: {{background: white}}"),
            (ColorType::Grayscale, BitDepth::Eight),
        ),
        (
            format!("{chain}style: {{stroke: navy}}"),
            (ColorType::Indexed, BitDepth::Eight),
        ),
        (
            format!("{chain}style: {{width: 0, background: tan}}"),
            (ColorType::Indexed, BitDepth::One),
        ),
        (
            format!("{squares}style: {{color_by: index, palette: spectral}}"),
            (ColorType::Rgba, BitDepth::Eight),
        ),
        (
            format!("{squares}style: {{color_by: index, palette: spectral, background: snow}}"),
            (ColorType::Rgb, BitDepth::Eight),
        ),
    ] {
        let rule = resolved(&document_of(&text), &[]);
        let options = Options::of(rule.metadata())
            .format(Format::Png)
            .size(Size::Long(300));
        let read = read_png(&drawn(&rule, 3, &options));
        assert_eq!((read.colour, read.depth), expected, "{text}");
    }
}

#[test]
fn a_png_is_fast_or_grey_where_asked() {
    for (background, colour) in [
        ("snow", ColorType::Grayscale),
        ("none", ColorType::GrayscaleAlpha),
    ] {
        let text = format!(
            "initiator: square\ngenerator: [[0, 0], [1/3, 1/4], [1, 0]]\nstyle: {{color_by: index, \
             palette: spectral, background: {background}}}\n"
        );
        let rule = resolved(&document_of(&text), &[]);
        let options = Options::of(rule.metadata())
            .format(Format::Png)
            .size(Size::Long(300));
        let encoded = |encoding| {
            let one = drawn(&rule, 4, &options.clone().png(encoding));
            let bands = options.clone().png(encoding).in_one_piece(0).band(9000);
            assert!(one == drawn(&rule, 4, &bands));
            read_png(&one)
        };
        let plain = encoded(PngEncoding::default());
        let fast = encoded(PngEncoding::default().fast(true));
        assert_eq!((fast.colour, &fast.rgba), (plain.colour, &plain.rgba));
        let grey = encoded(PngEncoding::default().grey(true));
        assert_eq!((grey.colour, grey.depth), (colour, BitDepth::Eight));
        for (grey, full) in grey.rgba.iter().zip(&plain.rgba) {
            let [red, green, blue] = [full[0], full[1], full[2]].map(f64::from);
            let luma = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
            assert!((f64::from(grey[0]) - luma).abs() < 0.51 && grey[3] == full[3]);
        }
    }
}

#[test]
fn a_png_says_what_it_is() {
    let rule = resolved(&document("koch"), &[]);
    let options = Options::of(rule.metadata())
        .format(Format::Png)
        .labels(Labels {
            title: "Koch curve".into(),
            description: "Step 2 of koch.".into(),
            provenance: "# kfrac grow 'Schöne Regel.yaml'\ninitiator: segment\n".into(),
        });
    let texts = read_png(&drawn(&rule, 2, &options)).texts;
    let expected = [
        ("Title", options.labels.title),
        ("Description", options.labels.description),
        ("Software", format!("kfrac {}", env!("CARGO_PKG_VERSION"))),
        ("Comment", options.labels.provenance),
    ];
    assert_eq!(
        texts,
        expected.map(|(keyword, text)| (keyword.to_owned(), text))
    );
}

#[test]
fn pieces_that_are_too_large_are_refused_with_the_memory_they_would_take() {
    let rule = resolved(&document("koch"), &[]);
    let options = Options::of(rule.metadata())
        .format(Format::Png)
        .size(Size::Exactly(200_000, 100_000))
        .in_one_piece(u64::MAX);
    let mut bytes = Vec::new();
    let error =
        render::write(&compiled(&rule, 1), &Growth::steps(1), &options, &mut bytes).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a PNG of 200000 x 100000 pixels takes 80.0 GB of memory, and 2.1 GB is the most; an SVG of this size takes none"
    );
    assert!(bytes.is_empty());
}

/// Strokes thinner than the distance of samples are compared only with the picture rendered at four times the
/// size, which shows them best. The difference is largest at the ends of hairs, which tiny-skia lengthens by
/// half a pixel at any width.
#[test]
fn thin_strokes_are_their_supersampled_picture() {
    const KOCH: &str = "initiator: triangle\ngenerator: koch\n";
    const DRAGON: &str = "initiator: segment\ngenerator: dragon\n";
    const TREE: &str = "initiator: segment\ngenerator: {connected: false, elements: [{from: [0, 0], to: [1, 0], fertile: false}, {from: [1, 0], to: [1.6, 0.4]}, {from: [1, 0], to: [1.55, -0.45]}]}\n";
    for (rule, width, steps, (most, far)) in [
        (KOCH, "0.03", 4, (0.1, 6)),
        (KOCH, "0.1", 4, (0.2, 12)),
        (KOCH, "0.2", 5, (0.5, 20)),
        (KOCH, "0.249", 2, (0.3, 30)),
        (DRAGON, "0.2", 10, (0.3, 10)),
        (TREE, "{relative: 0.02}", 6, (0.3, 24)),
        (TREE, "{relative: 0.1}", 8, (0.6, 36)),
    ] {
        let text = format!("{rule}style: {{width: {width}, background: white}}\n");
        let rule = resolved(&document_of(&text), &[]);
        let options = |format| {
            Options::of(rule.metadata())
                .format(format)
                .size(Size::Long(200))
        };
        let svg = drawn(&rule, steps, &options(Format::Svg));
        let png = read_png(&drawn(&rule, steps, &options(Format::Png)));
        let (pixels, _) = read_svg(&svg, Color::WHITE, 4);
        let (mean, worst) = difference(&png, &[pixels], 255);
        assert!(
            mean <= most && worst <= far,
            "{text} at {steps}: {mean:.3} on average, {worst} at worst"
        );
    }
}

/// Filled elements smaller than a pixel keep their ink at every step.
#[test]
fn nothing_fades() {
    let ink = |name: &str, steps: u32| {
        let rule = resolved(&document(name), &[]);
        let options = Options::of(rule.metadata())
            .format(Format::Png)
            .size(Size::Long(64));
        let read = read_png(&drawn(&rule, steps, &options));
        read.rgba
            .iter()
            .map(|pixel| f64::from(pixel[3]) / 255.0)
            .sum::<f64>()
    };
    let mut before = ink("sierpinski-triangles", 6);
    for steps in 7..=9 {
        let ink = ink("sierpinski-triangles", steps);
        assert!(
            ink > 0.9 * before && ink < 2.0 * before,
            "{ink} at {steps}, {before} before"
        );
        before = ink;
    }
}
