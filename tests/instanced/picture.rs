//! Pictures as another program renders them. The program supports instances, but non-scaling strokes only
//! as far as they are drawn here.

use std::collections::BTreeSet;

use resvg::tiny_skia::{FillRule, Paint, Pixmap, PixmapPaint, Transform};
use resvg::usvg;

/// Difference of two pictures.
#[derive(Debug)]
pub(crate) struct Difference {
    /// Mean difference of a value, of 255.
    pub(crate) mean: f64,
    /// Share of the values that differ by more than 96.
    pub(crate) far: f64,
}

pub(crate) fn difference(plain: &str, nested: &str, scales: bool) -> Difference {
    let plain = tree(plain);
    let size = plain.size().to_int_size();
    let mut expected = Pixmap::new(size.width(), size.height()).unwrap();
    resvg::render(&plain, Transform::identity(), &mut expected.as_mut());
    let mut drawn = Pixmap::new(size.width(), size.height()).unwrap();
    draw(tree(nested).root(), scales, &mut drawn);
    let pairs = expected.data().iter().zip(drawn.data());
    let differences: Vec<_> = pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).collect();
    let count = differences.len() as f64;
    Difference {
        mean: differences.iter().sum::<f64>() / count,
        far: differences.iter().filter(|&&off| off > 96.0).count() as f64 / count,
    }
}

fn tree(svg: &str) -> usvg::Tree {
    usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap()
}

/// Draws paths; strokes that do not scale have their width in pixels in every group.
fn draw(group: &usvg::Group, scales: bool, pixmap: &mut Pixmap) {
    if group.opacity().get() < 1.0 {
        let mut layer = Pixmap::new(pixmap.width(), pixmap.height()).unwrap();
        draw_children(group, scales, &mut layer);
        let paint = PixmapPaint {
            opacity: group.opacity().get(),
            ..PixmapPaint::default()
        };
        let none = Transform::identity();
        pixmap.draw_pixmap(0, 0, layer.as_ref(), &paint, none, None);
    } else {
        draw_children(group, scales, pixmap);
    }
}

fn draw_children(group: &usvg::Group, scales: bool, pixmap: &mut Pixmap) {
    for node in group.children() {
        let path = match node {
            usvg::Node::Group(inner) => {
                draw(inner, scales, pixmap);
                continue;
            }
            usvg::Node::Path(path) => path,
            _ => unreachable!("we write paths"),
        };
        let map = path.abs_transform();
        if let Some(fill) = path.fill() {
            let ink = ink(fill.paint(), fill.opacity().get());
            pixmap.fill_path(path.data(), &ink, FillRule::Winding, map, None);
        }
        let Some(stroke) = path.stroke() else {
            continue;
        };
        let ink = ink(stroke.paint(), stroke.opacity().get());
        let pen = stroke.to_tiny_skia();
        if scales {
            pixmap.stroke_path(path.data(), &ink, &pen, map, None);
        } else if let Some(path) = path.data().clone().transform(map) {
            pixmap.stroke_path(&path, &ink, &pen, Transform::identity(), None);
        }
    }
}

fn ink(paint: &usvg::Paint, opacity: f32) -> Paint<'static> {
    let usvg::Paint::Color(colour) = paint else {
        unreachable!("we write colours");
    };
    let mut ink = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    let [red, green, blue] = [colour.red, colour.green, colour.blue];
    #[expect(clippy::cast_possible_truncation, reason = "opacity is a part")]
    let opacity = (255.0 * opacity).round() as u8;
    ink.set_color_rgba8(red, green, blue, opacity);
    ink
}

/// Returns the colours of everything drawn.
pub(crate) fn colours(svg: &str) -> BTreeSet<[u8; 3]> {
    fn add(group: &usvg::Group, colours: &mut BTreeSet<[u8; 3]>) {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => add(inner, colours),
                usvg::Node::Path(path) => {
                    let fill = path.fill().map(usvg::Fill::paint);
                    let stroke = path.stroke().map(usvg::Stroke::paint);
                    colours.extend(fill.into_iter().chain(stroke).map(|paint| match paint {
                        usvg::Paint::Color(colour) => [colour.red, colour.green, colour.blue],
                        _ => unreachable!("we write colours"),
                    }));
                }
                _ => unreachable!("we write paths"),
            }
        }
    }
    let mut all = BTreeSet::new();
    add(tree(svg).root(), &mut all);
    all
}

/// Asserts that two files have the same metadata and size, and that their strokes do not scale.
pub(crate) fn hold_same_frames(plain: &str, nested: &str, what: &str) {
    let both = [plain, nested].map(|text| roxmltree::Document::parse(text).unwrap());
    let frame = |document: &roxmltree::Document<'_>| {
        let root = document.root_element();
        let attributes =
            ["width", "height", "viewBox"].map(|it| root.attribute(it).map(String::from));
        let labels = ["title", "desc", "metadata"].map(|name| {
            let label = root.children().find(|child| child.has_tag_name(name));
            label.and_then(|label| label.text()).map(String::from)
        });
        (attributes, labels)
    };
    let [plain, nested] = &both;
    assert_eq!(frame(plain), frame(nested), "{what}");
    let relative = nested
        .descendants()
        .filter(|node| node.has_tag_name("path"))
        .all(|path| path.attribute("vector-effect") == Some("non-scaling-stroke"));
    let scales = nested
        .descendants()
        .all(|node| node.attribute("vector-effect").is_none());
    assert!(relative != scales, "{what}");
}
