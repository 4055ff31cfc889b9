//! The paths of a figure, as a reader of SVG sees them.

/// A path, in hundredths of a pixel.
pub(crate) struct Path {
    /// Text that the path stands for.
    pub(crate) label: Option<String>,
    pub(crate) is_filled: bool,
    /// Width of the stroke, where it differs from that of most paths.
    pub(crate) width: Option<String>,
    pub(crate) is_dashed: bool,
    /// Line segments of the path, and the chords of its curves.
    pub(crate) lines: Vec<[[i64; 2]; 2]>,
    pub(crate) min: [i64; 2],
    pub(crate) max: [i64; 2],
}

/// Returns width and height in pixels, and all paths.
pub(crate) fn read(svg: &str) -> ([i64; 2], Vec<Path>) {
    let document = roxmltree::Document::parse(svg).unwrap();
    let root = document.root_element();
    let size = ["width", "height"].map(|name| root.attribute(name).unwrap().parse().unwrap());
    let paths = root.descendants().filter(|node| node.has_tag_name("path"));
    let paths = paths.map(|node| {
        let lines = lines(node.attribute("d").unwrap());
        let all = || lines.iter().flatten();
        let bound = |side: usize| {
            let values = || all().map(move |point| point[side]);
            (values().min().unwrap(), values().max().unwrap())
        };
        let (x, y) = (bound(0), bound(1));
        Path {
            label: node.attribute("aria-label").map(Into::into),
            is_filled: node.attribute("fill").is_some(),
            width: node.attribute("stroke-width").map(Into::into),
            is_dashed: node.has_attribute("stroke-dasharray"),
            min: [x.0, y.0],
            max: [x.1, y.1],
            lines,
        }
    });
    (size, paths.collect())
}

/// Parses path data with the commands M, l, h, c and z.
fn lines(data: &str) -> Vec<[[i64; 2]; 2]> {
    let mut lines = Vec::new();
    let (mut pen, mut start) = ([0, 0], [0, 0]);
    let is_letter = |c: char| c.is_ascii_alphabetic();
    let mut rest = data;
    while let Some(command) = rest.chars().next() {
        let end = rest[1..].find(is_letter).map_or(rest.len(), |end| end + 1);
        let numbers = rest[1..end].replace('-', " -");
        let numbers: Vec<i64> = numbers
            .split_whitespace()
            .map(|number| number.parse().unwrap())
            .collect();
        rest = &rest[end..];
        // The last two numbers of a command are its end.
        let each = match command {
            'M' | 'l' | 'h' => 2,
            'c' => 6,
            'z' => 1,
            other => panic!("'{other}' in path data"),
        };
        if command == 'z' {
            lines.push([pen, start]);
            pen = start;
        }
        for step in numbers.chunks(each) {
            let by = match step {
                [.., x, y] => [*x, *y],
                _ => [0, 0],
            };
            if command == 'M' {
                (pen, start) = (by, by);
                continue;
            }
            let to = [pen[0] + by[0], pen[1] + by[1]];
            lines.push([pen, to]);
            pen = to;
        }
    }
    lines
}
