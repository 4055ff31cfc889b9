//! Sets in space as tables of elements and points, and as PLY files, on the command line.

use std::fs;
use std::process::{Command, Output};

use kfrac::geometry::DVec3;

fn run(arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kfrac"));
    command.args(arguments.split(' ')).output().unwrap()
}

/// Runs the program, which must succeed; returns its standard output.
fn written(arguments: &str) -> Vec<u8> {
    let output = run(arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments}: {said}");
    output.stdout
}

/// Returns the header and the rows of a table.
fn table(arguments: &str) -> (String, Vec<Vec<String>>) {
    let text = String::from_utf8(written(arguments)).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap().to_owned();
    let rows = lines.map(|line| line.split(',').map(str::to_owned).collect());
    (header, rows.collect())
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap()
}

/// Returns the corners of the cells of the Menger sponge after two steps, in 9ths: at most one digit of three is 1 in
/// each step (Jones & Campa 1992, figure 12).
fn cells() -> Vec<[u32; 3]> {
    let is_kept = |at: [u32; 3]| at.iter().filter(|at| **at == 1).count() < 2;
    let all = (0..9 * 9 * 9).map(|cell| [cell % 9, cell / 9 % 9, cell / 81]);
    all.filter(|at| is_kept(at.map(|at| at % 3)) && is_kept(at.map(|at| at / 3)))
        .collect()
}

#[test]
fn elements_of_the_sponge_are_listed() {
    let (header, rows) = table("grow menger --steps 2 --format csv -q -o -");
    let columns = "fractal,age,index,x0,y0,z0,x1,y1,z1,ux,uy,uz,fertile,direction,visible,\
                   a,b,c,d,e,f,g,h,i,j,k,l";
    assert_eq!(header, columns);
    assert_eq!(rows.len(), 400);
    let count: serde_json::Value =
        serde_json::from_slice(&written("count menger --steps 2 --json -q")).unwrap();
    assert_eq!(count["elements"], "400");
    let mut origins: Vec<[String; 3]> = Vec::new();
    for (rank, row) in (1..).zip(&rows) {
        let rank: u32 = rank;
        assert_eq!(row[2], rank.to_string());
        let values: Vec<f64> = row[3..12].iter().map(|cell| number(cell)).collect();
        let nine = |axis: usize| (values[axis] * 9.0).round();
        origins.push([0, 1, 2].map(|axis| nine(axis).to_string()));
        for axis in 0..3 {
            assert!((values[axis] * 9.0 - nine(axis)).abs() < 1e-12);
            let end = values[axis] + if axis == 0 { 1.0 / 9.0 } else { 0.0 };
            assert!((values[3 + axis] - end).abs() < 1e-15);
        }
        assert_eq!(values[6..], [0.0, 0.0, 1.0]);
        // The map moves the origin to the first end.
        assert_eq!(row[24..27], row[3..6]);
    }
    origins.sort_unstable();
    let mut expected: Vec<_> = cells()
        .into_iter()
        .map(|at| at.map(|at| at.to_string()))
        .collect();
    expected.sort_unstable();
    assert_eq!(origins, expected);
    // JSON holds equal rows, on one thread too.
    let json = written("grow menger --steps 2 --format json -q -o - --threads 1");
    let json = String::from_utf8(json).unwrap();
    for (line, row) in json.lines().zip(&rows) {
        let cells: serde_json::Value = serde_json::from_str(line).unwrap();
        for (column, cell) in columns.split(',').zip(row) {
            assert_eq!(cells[column].to_string(), *cell, "{column}");
        }
    }
    assert_eq!(json.lines().count(), 400);
}

/// Returns whether a point lies in the cells of the sponge, which have sides of a 27th.
fn is_in_sponge(point: [f64; 3]) -> bool {
    [1.0, 3.0, 9.0].iter().all(|scale| {
        // A point on the boundary of a cell belongs to both neighbours.
        let middle = point.map(|value| {
            let third = (value * scale).fract() * 3.0;
            third > 1.0 + 1e-6 && third < 2.0 - 1e-6
        });
        middle.iter().filter(|is_middle| **is_middle).count() < 2
    })
}

#[test]
fn points_of_the_sponge_lie_in_it() {
    let (header, rows) = table("grow menger --method chaos --points 3000 --format csv -q -o -");
    assert_eq!((header.as_str(), rows.len()), ("x,y,z,map", 3000));
    let mut maps = [0; 20];
    for row in &rows {
        let point = [0, 1, 2].map(|axis| number(&row[axis]));
        assert!(is_in_sponge(point), "{point:?}");
        maps[row[3].parse::<usize>().unwrap() - 1] += 1;
    }
    // Equal volumes have equal weights: 150 points on average, with a standard deviation of 12.
    assert!(
        maps.iter().all(|count| (90..210).contains(count)),
        "{maps:?}"
    );
}

#[test]
fn volumes_are_the_weights() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("parts.yaml");
    // Volumes 1/8, 1/64 and 0; the last has a twentieth of their mean.
    let text = "kind: ifs\nspace: 3\nmaps:\n  - {scale: 1/2}\n  - {scale: 1/4, translate: [1/2, 0, 0]}\n  \
                - {scale: [1/2, 0, 1/2], translate: [0, 1/2, 0]}\n";
    fs::write(&path, text).unwrap();
    let command = format!(
        "grow {} --method chaos --points 20k --format csv -q -o -",
        path.display()
    );
    let mut counts = [0.0; 3];
    for row in table(&command).1 {
        counts[row[3].parse::<usize>().unwrap() - 1] += 1.0 / 20_000.0;
    }
    let volumes = [1.0 / 8.0, 1.0 / 64.0, (1.0 / 8.0 + 1.0 / 64.0) / 60.0];
    let all: f64 = volumes.iter().sum();
    for (count, volume) in counts.iter().zip(volumes) {
        assert!((count - volume / all).abs() < 0.015, "{counts:?}");
    }
}

/// A point of a PLY file: coordinates, normal and colour.
type PlyPoint = (DVec3, DVec3, [u8; 3]);

/// Reads the binary PLY files of this program, with the checks that other readers make.
fn ply(bytes: &[u8]) -> Vec<PlyPoint> {
    let end = b"end_header\n";
    let header = bytes
        .windows(end.len())
        .position(|part| part == end)
        .unwrap()
        + end.len();
    let text = std::str::from_utf8(&bytes[..header]).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("ply"));
    assert_eq!(lines.next(), Some("format binary_little_endian 1.0"));
    let mut lines = lines.filter(|line| !line.starts_with("comment "));
    let count = lines
        .next()
        .unwrap()
        .strip_prefix("element vertex ")
        .unwrap();
    let properties: Vec<&str> = lines.take_while(|line| *line != "end_header").collect();
    let floats = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}"));
    let bytes_of = ["red", "green", "blue"].map(|name| format!("property uchar {name}"));
    let expected: Vec<&str> = floats.iter().chain(&bytes_of).map(String::as_str).collect();
    assert_eq!(properties, expected);
    let count: usize = count.parse().unwrap();
    let body = &bytes[header..];
    assert_eq!(body.len(), 27 * count);
    let vector = |bytes: &[u8]| {
        let values: Vec<f64> = bytes
            .chunks_exact(4)
            .map(|value| f32::from_le_bytes(value.try_into().unwrap()).into())
            .collect();
        DVec3::from_slice(&values)
    };
    body.chunks_exact(27)
        .map(|point| {
            let colour = point[24..].try_into().unwrap();
            (vector(&point[..12]), vector(&point[12..24]), colour)
        })
        .collect()
}

#[test]
fn ply_files_have_the_points_of_tables() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.ply");
    let text = "kind: ifs\nspace: 3\nvertices: {solid: cube, shrink: 1/2}\n";
    let file = folder.path().join("cube.yaml");
    fs::write(&file, text).unwrap();
    let file = file.display();
    let mut files = Vec::new();
    for threads in [1, 3] {
        let out = path.display();
        written(&format!(
            "grow {file} --points 5000 --color-by last-map -q --threads {threads} -o {out}"
        ));
        files.push(fs::read(&path).unwrap());
    }
    assert_eq!(files[0], files[1]);
    let points = ply(&files[0]);
    let (_, rows) = table(&format!(
        "grow {file} --method chaos --points 5000 --format csv -q -o -"
    ));
    assert_eq!(points.len(), rows.len());
    let mut colours = vec![None; 8];
    for ((place, normal, colour), row) in points.into_iter().zip(&rows) {
        let listed = DVec3::from_array([0, 1, 2].map(|axis| number(&row[axis])));
        assert!(place.abs_diff_eq(listed, 1e-6));
        let map = row[3].parse::<usize>().unwrap() - 1;
        assert_eq!(*colours[map].get_or_insert(colour), colour);
        assert!((normal.length() - 1.0).abs() < 1e-5);
        // On a face of the filled cube, away from its edges, the normal is that of the face.
        let deep = place.abs();
        let (min, max) = (deep.min_element(), deep.max_element());
        let middle = deep.x + deep.y + deep.z - min - max;
        if max > 0.99 && middle < 0.8 {
            let face = [DVec3::X, DVec3::Y, DVec3::Z]
                .into_iter()
                .find(|axis| place.dot(*axis).abs() == max)
                .unwrap();
            let outward = face * place.dot(face).signum();
            // Normals are estimated from densities.
            assert!(normal.dot(outward) > 0.9, "{place} {normal}");
        }
    }
    colours.dedup();
    assert_eq!(colours.len(), 8);
}

#[test]
fn wrong_tables_and_clouds_are_refused() {
    for (arguments, status, message) in [
        ("gasket --points 10 -o x.ply", 2, "lies in the plane"),
        ("menger --points 10 -o x.csv", 2, "add --method chaos"),
        ("menger --method chaos -o x.svg", 2, "too many for an SVG"),
        ("menger --method chaos -o x.usda", 2, "draws points"),
        (
            "menger --method chaos --steps 3 -o x.png",
            2,
            "--points is the number",
        ),
        (
            "menger --method chaos --color-by step -o x.png",
            2,
            "draws points",
        ),
        (
            "menger --points 10 --color-by hits -o x.ply",
            2,
            "use last-map or first-map",
        ),
        (
            "menger --points 60M -o x.ply",
            1,
            "more rows than --max-elements",
        ),
        ("menger --steps 9 -o x.csv", 1, "5 is the deepest step"),
        (
            "menger --detail 1 -o x.svg",
            2,
            "give --steps, or write a .png",
        ),
        (
            "menger --view 0,0,1,1 -o x.dxf",
            2,
            "--view is not for its faces",
        ),
        ("menger --occlusion -o x.pdf", 2, "write a .png"),
        ("menger --steps 9 -o x.svg", 1, "5 is the deepest step"),
        (
            "gasket --method chaos --start 1,2,3 -o x.png",
            2,
            "in the plane: a point is X,Y",
        ),
        ("menger --method chaos --start 1e300,0,0 -o x.png", 1, ""),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_kfrac"));
        let output = command
            .current_dir(folder.path())
            .arg("grow")
            .args(arguments.split(' '))
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(status), "{arguments}: {said}");
        assert!(said.contains(message), "{arguments}: {said}");
        assert_eq!(
            fs::read_dir(folder.path()).unwrap().count(),
            0,
            "{arguments}"
        );
    }
}
