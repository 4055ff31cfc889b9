//! Strokes as other programs read them.

use kfrac::render::Format;
use resvg::tiny_skia::{PathSegment, Point};
use resvg::usvg;

use super::Read;

/// Length of a CSS pixel in millimetres.
const PIXEL: f64 = 25.4 / 96.0;
/// Length of a point in millimetres.
const INCH_72: f64 = 25.4 / 72.0;

pub(crate) fn read(format: Format, bytes: &[u8]) -> Vec<Read> {
    match format {
        Format::Svg => svg(bytes),
        Format::Pdf => pdf(bytes),
        Format::Dxf => dxf(bytes),
        Format::Hpgl => hpgl(bytes),
        Format::GCode => gcode(bytes),
        _ => panic!("{format:?} has no strokes that are read here"),
    }
}

pub(crate) fn svg(bytes: &[u8]) -> Vec<Read> {
    let tree = usvg::Tree::from_data(bytes, &usvg::Options::default()).unwrap();
    let mut strokes = Vec::new();
    group(tree.root(), &mut strokes);
    strokes
}

fn group(of: &usvg::Group, strokes: &mut Vec<Read>) {
    for node in of.children() {
        match node {
            usvg::Node::Group(inner) => group(inner, strokes),
            usvg::Node::Path(path) => {
                let map = path.abs_transform();
                let ink = path.stroke().map(|stroke| format!("{:?}", stroke.paint()));
                for segment in path.data().segments() {
                    let place = |at: Point| {
                        let (x, y) = (f64::from(at.x), f64::from(at.y));
                        let x = x * f64::from(map.sx) + f64::from(map.tx);
                        let y = y * f64::from(map.sy) + f64::from(map.ty);
                        [x * PIXEL, y * PIXEL]
                    };
                    match segment {
                        PathSegment::MoveTo(to) => strokes.push(Read {
                            vertices: vec![place(to)],
                            closed: false,
                            ink: ink.clone().unwrap_or_default(),
                        }),
                        PathSegment::LineTo(to) | PathSegment::CubicTo(.., to) => {
                            strokes.last_mut().unwrap().vertices.push(place(to));
                        }
                        PathSegment::QuadTo(..) => unreachable!("we write none"),
                        PathSegment::Close => strokes.last_mut().unwrap().closed = true,
                    }
                }
            }
            _ => unreachable!("we write paths"),
        }
    }
}

/// Returns the operators on a PDF's only page, with their operands, and its resources.
pub(crate) fn operators(bytes: &[u8]) -> Vec<(String, Vec<lopdf::Object>)> {
    let document = lopdf::Document::load_mem(bytes).unwrap();
    let page = document.page_iter().next().unwrap();
    let content = lopdf::content::Content::decode(&document.get_page_content(page)).unwrap();
    let operations = content.operations.into_iter();
    operations.map(|it| (it.operator, it.operands)).collect()
}

pub(crate) fn pdf(bytes: &[u8]) -> Vec<Read> {
    let document = lopdf::Document::load_mem(bytes).unwrap();
    let page = document.page_iter().next().unwrap();
    let page = document.get_dictionary(page).unwrap();
    let number = |object: &lopdf::Object| f64::from(object.as_float().unwrap());
    let media = page.get(b"MediaBox").unwrap().as_array().unwrap();
    let unit = page.get(b"UserUnit").map_or(1.0, number);
    let top = number(&media[3]);
    // Only maps that scale and translate occur.
    let mut map = [1.0, 0.0, 1.0, 0.0];
    let mut outer = Vec::new();
    let mut strokes = Vec::<Read>::new();
    let mut ink = String::new();
    let mut painted = 0;
    for (operator, operands) in operators(bytes) {
        let numbers: Vec<_> = match operator.as_str() {
            "gs" | "d" => Vec::new(),
            _ => operands.iter().map(number).collect(),
        };
        let place = || {
            let [x, y] = [numbers[numbers.len() - 2], numbers[numbers.len() - 1]];
            let [x, y] = [map[0] * x + map[1], map[2] * y + map[3]];
            [x * unit * INCH_72, (top - y) * unit * INCH_72]
        };
        match operator.as_str() {
            "q" => outer.push(map),
            "Q" => map = outer.pop().unwrap(),
            "cm" => {
                assert_eq!([numbers[1], numbers[2]], [0.0; 2]);
                map = [
                    map[0] * numbers[0],
                    map[0] * numbers[4] + map[1],
                    map[2] * numbers[3],
                    map[2] * numbers[5] + map[3],
                ];
            }
            "m" => strokes.push(Read {
                vertices: vec![place()],
                ..Read::default()
            }),
            "l" | "c" => strokes.last_mut().unwrap().vertices.push(place()),
            "h" => strokes.last_mut().unwrap().closed = true,
            "RG" | "rg" => ink = format!("{numbers:.2?}"),
            "S" | "f" | "B" | "n" => {
                strokes[painted..]
                    .iter_mut()
                    .for_each(|it| it.ink = ink.clone());
                painted = strokes.len();
            }
            "w" | "J" | "j" | "M" | "d" | "gs" | "re" | "W" => {}
            other => unreachable!("{other}"),
        }
    }
    assert_eq!(painted, strokes.len());
    strokes
}

pub(crate) fn dxf(bytes: &[u8]) -> Vec<Read> {
    let drawing = dxf::Drawing::load(&mut std::io::Cursor::new(bytes)).unwrap();
    assert_eq!(drawing.header.version, dxf::enums::AcadVersion::R12);
    let top = drawing.header.maximum_drawing_extents.y;
    let layers: Vec<_> = drawing.layers().map(|layer| layer.name.clone()).collect();
    let read = |entity: &dxf::entities::Entity| {
        assert!(layers.contains(&entity.common.layer));
        let dxf::entities::EntityType::Polyline(line) = &entity.specific else {
            unreachable!("we write polylines")
        };
        let vertices = line.vertices().map(|vertex| &vertex.location);
        Read {
            vertices: vertices.map(|at| [at.x, top - at.y]).collect(),
            closed: line.is_closed(),
            ink: entity.common.layer.clone(),
        }
    };
    drawing.entities().map(read).collect()
}

/// Reads the strokes of HP-GL, with y down from the origin.
pub(crate) fn hpgl(bytes: &[u8]) -> Vec<Read> {
    const UNIT: f64 = 1.0 / 40.0;
    let text = std::str::from_utf8(bytes).unwrap();
    let mut instructions = text.split(';').map(str::trim);
    assert_eq!(instructions.next(), Some("IN"));
    let mut strokes: Vec<Read> = Vec::new();
    let (mut ink, mut at) = (String::new(), [0.0; 2]);
    let mut is_down = false;
    for instruction in instructions.filter(|it| !it.is_empty()) {
        let (name, parameters) = instruction.split_at(2);
        let numbers = || {
            parameters
                .split(',')
                .filter(|it| !it.is_empty())
                .map(|it| it.parse::<i32>().unwrap())
        };
        match name {
            "SP" => ink = parameters.into(),
            "PU" | "PD" => {
                let numbers: Vec<_> = numbers().map(|number| f64::from(number) * UNIT).collect();
                assert!(numbers.len().is_multiple_of(2) && numbers.len() <= 128);
                for to in numbers.chunks_exact(2) {
                    let to = [to[0], -to[1]];
                    if name == "PD" && !is_down {
                        strokes.push(Read {
                            vertices: vec![at],
                            closed: false,
                            ink: ink.clone(),
                        });
                    }
                    is_down = name == "PD";
                    if is_down {
                        strokes.last_mut().unwrap().vertices.push(to);
                    }
                    at = to;
                }
                is_down = name == "PD";
            }
            other => unreachable!("{other}"),
        }
    }
    assert_eq!(ink, "0", "the pen is put away");
    strokes
}

/// Reads the strokes of G-code with the commands of the default machine, with y down from the upper edge.
pub(crate) fn gcode(bytes: &[u8]) -> Vec<Read> {
    let text = std::str::from_utf8(bytes).unwrap();
    let size = text
        .lines()
        .find_map(|line| line.strip_prefix("; ")?.split_once(" mm, "));
    let top: f64 = size
        .unwrap()
        .0
        .split_once(" x ")
        .unwrap()
        .1
        .parse()
        .unwrap();
    let mut strokes: Vec<Read> = Vec::new();
    let (mut ink, mut at, mut is_down) = (String::new(), [0.0, top], false);
    let mut lines = text.lines().filter(|line| !line.is_empty());
    for line in lines.by_ref() {
        if let Some(comment) = line.strip_prefix("; ") {
            ink = comment.into();
            continue;
        }
        let mut words = line
            .split(' ')
            .map(|word| (&word[..1], word[1..].parse::<f64>().unwrap()));
        let command = words.next().unwrap();
        let words: std::collections::BTreeMap<_, _> = words.collect();
        match command {
            ("G", 21.0 | 90.0) | ("M", 0.0) => assert!(!is_down),
            ("F", feed) => assert!(feed > 0.0 && !is_down),
            ("M", 2.0) => break,
            ("G", 0.0 | 1.0) => {
                if let Some(z) = words.get("Z") {
                    is_down = *z <= 0.0;
                    if is_down {
                        strokes.push(Read {
                            vertices: vec![at],
                            closed: false,
                            ink: ink.clone(),
                        });
                    }
                }
                if let (Some(x), Some(y)) = (words.get("X"), words.get("Y")) {
                    assert_eq!(is_down, command.1 == 1.0, "{line}");
                    at = [*x, top - y];
                    if is_down {
                        strokes.last_mut().unwrap().vertices.push(at);
                    }
                }
            }
            other => unreachable!("{other:?}"),
        }
    }
    assert!(!is_down && lines.next().is_none(), "the program ends");
    strokes
}
