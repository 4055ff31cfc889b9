//! Pictures in SVG, as far as tests need them.

/// A picture as a reader of SVG sees it.
pub(crate) struct Picture {
    pub(crate) title: String,
    pub(crate) metadata: String,
    /// Width and height in units of the coordinates.
    pub(crate) extent: [i64; 2],
    /// Subpaths of all paths.
    pub(crate) subpaths: Vec<Subpath>,
}

#[derive(Default)]
pub(crate) struct Subpath {
    /// Vertices; a curve may lie between two of them, whose control points are dropped.
    pub(crate) vertices: Vec<[i64; 2]>,
    /// Whether each vertex except the first ends a curve.
    pub(crate) is_curved: Vec<bool>,
    pub(crate) is_closed: bool,
    /// Whether the subpath is written as one of length 0.
    pub(crate) is_dot: bool,
}

impl Picture {
    /// Reads a file, which must be well-formed and contain nothing but what kfrac writes.
    pub(crate) fn read(text: &str) -> Self {
        let document = roxmltree::Document::parse(text).unwrap();
        let root = document.root_element();
        assert_eq!(root.tag_name().name(), "svg");
        assert_eq!(
            root.tag_name().namespace(),
            Some("http://www.w3.org/2000/svg")
        );
        let text = |name| {
            let mut nodes = root
                .children()
                .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", name)));
            let node = nodes.next().unwrap_or_else(|| panic!("no {name}"));
            assert!(nodes.next().is_none(), "one {name}");
            node.text().unwrap_or_default().to_owned()
        };
        let numbers = |attribute| -> Vec<i64> {
            let text = root.attribute(attribute).unwrap();
            text.split(' ')
                .map(|number| number.parse().unwrap())
                .collect()
        };
        let [0, 0, wide, high] = numbers("viewBox")[..] else {
            panic!("viewBox starts at 0 0")
        };
        assert_eq!(
            [wide, high],
            [100 * numbers("width")[0], 100 * numbers("height")[0]]
        );
        let paths = root
            .descendants()
            .filter(|node| node.tag_name().name() == "path");
        Self {
            title: text("title"),
            metadata: text("metadata"),
            extent: [wide, high],
            subpaths: paths
                .flat_map(|path| subpaths(path.attribute("d").unwrap()))
                .collect(),
        }
    }
}

/// Parses path data with the commands M, l, h, c and z.
fn subpaths(data: &str) -> Vec<Subpath> {
    let mut subpaths: Vec<Subpath> = Vec::new();
    let mut rest = data;
    let mut command = ' ';
    while let Some(first) = rest.chars().next() {
        // Long paths continue on a new line, which XML turns into a space, with a new command letter.
        let line = rest.strip_prefix(' ');
        if let Some(line) = line.filter(|line| line.starts_with(char::is_alphabetic)) {
            rest = line;
            continue;
        }
        if first.is_ascii_alphabetic() {
            command = first;
            rest = &rest[1..];
        }
        let mut number = || {
            rest = rest.trim_start_matches([' ', '\n']);
            let sign = usize::from(rest.starts_with('-'));
            let digits = rest[sign..].find(|c: char| !c.is_ascii_digit());
            let (number, after) = rest.split_at(digits.map_or(rest.len(), |count| sign + count));
            rest = after;
            number
                .parse::<i64>()
                .unwrap_or_else(|_| panic!("'{number}' before '{after:.20}'"))
        };
        if command == 'M' {
            subpaths.push(Subpath {
                vertices: vec![[number(), number()]],
                ..Subpath::default()
            });
            // A second pair of numbers would be a line.
            command = ' ';
            continue;
        }
        let subpath = subpaths.last_mut().unwrap();
        assert!(!subpath.is_closed, "a subpath goes on after z");
        let [x, y] = *subpath.vertices.last().unwrap();
        match command {
            'l' => {
                subpath.vertices.push([x + number(), y + number()]);
                subpath.is_curved.push(false);
            }
            'c' => {
                let [a, b, c, d, e, f] = std::array::from_fn(|_| number());
                assert_ne!([a, b, c, d, e, f], [0; 6], "a curve of no extent");
                subpath.vertices.push([x + e, y + f]);
                subpath.is_curved.push(true);
            }
            'h' => {
                assert_eq!(number(), 0);
                subpath.is_dot = true;
            }
            'z' => {
                subpath.is_closed = true;
                command = ' ';
            }
            other => panic!("'{other}' in path data"),
        }
    }
    subpaths
}
