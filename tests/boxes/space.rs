//! Boxes of sets in space.

use std::fs;
use std::path::Path;

use kfrac::geometry::{DAffine3, DVec3};
use kfrac::measure::{BoxCounting, Cascade, Generalised, Grid, LimitSet, Masses, Scale};

use super::{assert_is, common, number};

fn text(text: &str) -> LimitSet<DAffine3> {
    let (model, _) = common::document_of(text).resolve(&[]).unwrap();
    LimitSet::of(&model.compile_in_space(false).unwrap()).unwrap()
}

fn named(name: &str) -> LimitSet<DAffine3> {
    let (model, _) = common::document(name).resolve(&[]).unwrap();
    LimitSet::of(&model.compile_in_space(false).unwrap()).unwrap()
}

/// Returns the counts of cubes with sides of the extent divided by powers of a base.
fn counts(set: &LimitSet<DAffine3>, base: usize) -> Vec<u64> {
    let scales = set.sampled_scales(number(base), &[Grid::ALONG], number(1));
    assert!(scales.iter().all(|scale| !scale.sampled));
    scales.iter().map(|scale| scale.count).collect()
}

#[test]
fn cubes_of_a_sponge_are_counted_exactly() {
    let sponge = counts(&named("menger"), 3);
    let powers: Vec<u64> = (1..=12).map(|level| 20u64.pow(level)).collect();
    assert_eq!(sponge, powers);
    let cube = counts(&named("solid-cube"), 2);
    let powers: Vec<u64> = (1..20).map(|level| 8u64.pow(level)).collect();
    assert_eq!(cube[..19], powers);
}

/// Counts by states agree with covers, whose boxes are marked one by one.
#[test]
fn counts_by_states_are_those_of_covers() {
    for name in ["octahedron-flake", "sierpinski-tetrahedron"] {
        let set = named(name);
        let by_states = counts(&set, 2);
        let covers: Vec<Scale> = set.scales(2.0, 300, &[Grid::ALONG], number(1));
        assert!(covers.len() > 3);
        for (cover, count) in covers.iter().zip(by_states) {
            assert_eq!(cover.count, count, "{name} {}", cover.size);
        }
    }
}

/// A flat carpet in a common side of cubes is covered once, and a segment too.
#[test]
fn flat_sets_are_covered_once() {
    let square = "kind: ifs\nspace: 3\nvertices: {points: [[0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5]], shrink: 1/2}\n";
    let expected: Vec<u64> = (1..=10).map(|level| 4u64.pow(level)).collect();
    assert_eq!(counts(&text(square), 2)[..10], expected);
    let segment = "kind: ifs\nspace: 3\nvertices: {points: [[0, 0, 0], [3, 3, 3]], shrink: 1/2}\n";
    let expected: Vec<u64> = (1..=10).map(|level| 2u64.pow(level)).collect();
    assert_eq!(counts(&text(segment), 2)[..10], expected);
}

/// A recurrent system: eight halves of a cube, none of which follows itself.
#[test]
fn recurrent_sets_have_the_cubes_of_their_graph() {
    let mut sign = "kind: ifs\nspace: 3\nmaps:\n".to_owned();
    for corner in 0..8 {
        let at = [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 0.5 } else { -0.5 });
        sign += &format!("  - {{scale: 1/2, translate: {at:?}}}\n");
    }
    sign += "edges:\n";
    for corner in 1..=8 {
        let others: Vec<usize> = (1..=8).filter(|other| *other != corner).collect();
        sign += &format!("  {corner}: {others:?}\n");
    }
    let set = text(&sign);
    assert!((set.bounds().size().x - 2.0).abs() < 1e-9);
    let own: Vec<u64> = (0..8).map(|level| 8 * 7u64.pow(level)).collect();
    assert_eq!(counts(&set, 2)[..8], own);
}

#[test]
fn turned_sets_are_measured_from_samples() {
    let turned = "kind: ifs\nspace: 3\nmaps:\n  - {scale: 0.5, rotate: {axis: [1, 2, 3], angle: 40}}\n  \
                  - {scale: 0.5, translate: [1, 0, 0]}\n  - {scale: 0.5, translate: [0, 1, 0]}\n";
    let set = text(turned);
    let estimate = BoxCounting::of_limit(&set, None, &Grid::spread(number(3)), number(2)).estimate;
    let estimate = estimate.unwrap();
    let dimension = 3f64.ln() / 2f64.ln();
    assert!(
        (estimate.value - dimension).abs() < 3.0 * estimate.std_error + 0.02,
        "{estimate:?}"
    );
}

#[test]
fn spectra_and_lacunarity_in_space() {
    let (model, _) = common::document("sierpinski-tetrahedron")
        .resolve(&[])
        .unwrap();
    let graph = model.compile_in_space(false).unwrap();
    let measure = Cascade::natural(&graph).unwrap();
    for it in Generalised::of_measure(&measure, &[0.0, 2.0], None, number(1), number(2)) {
        assert_is(&it.estimate.unwrap(), 2.0, 0.02);
    }
    let masses = Masses::of_limit(measure.set(), &Grid::ALONG, 32).unwrap();
    let lacunarity = masses.lacunarity();
    // 4^5 of 32³ boxes are met: ⟨m²⟩ / ⟨m⟩² is 2^5 for single boxes, and 1 for the whole.
    assert!((lacunarity[0].value - 32.0).abs() < 1e-9, "{lacunarity:?}");
    assert!((lacunarity[5].value - 1.0).abs() < 1e-9, "{lacunarity:?}");
}

/// Returns points of the Sierpinski tetrahedron, by the chaos game.
fn points(count: usize) -> Vec<[f32; 3]> {
    let corners = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let mut at = [1.0f32; 3];
    let mut state = 1u64;
    let point = |_| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let corner = corners[(state >> 62) as usize];
        for axis in 0..3 {
            at[axis] = (at[axis] + corner[axis]) / 2.0;
        }
        at
    };
    (0..count).map(point).collect()
}

fn measured(folder: &Path, name: &str, bytes: &[u8]) -> String {
    fs::write(folder.join(name), bytes).unwrap();
    let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
    let arguments = ["dim", name, "--grids", "2", "--orders", "0,2", "--json"];
    let output = command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Tables and PLY files of the same points have the same boxes, in any order of bytes.
#[test]
fn points_in_space_from_tables_and_from_ply() {
    let folder = tempfile::tempdir().unwrap();
    let points = points(20_000);
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment points\nelement face 2\nproperty list uchar int vertex_indices\n\
             element vertex {}\nproperty float x\nproperty uchar shade\nproperty float y\nproperty float z\nend_header\n",
            points.len()
        )
    };
    let mut table = "x,y,z,shade\n".to_owned();
    let mut text = header("ascii") + "3 0 1 2\n2 0 1\n";
    let mut little = header("binary_little_endian").into_bytes();
    let mut big = header("binary_big_endian").into_bytes();
    for face in [&[0i32, 1, 2][..], &[0, 1]] {
        let length = u8::try_from(face.len()).unwrap();
        little.push(length);
        big.push(length);
        for corner in face {
            little.extend(corner.to_le_bytes());
            big.extend(corner.to_be_bytes());
        }
    }
    for [x, y, z] in &points {
        // All digits of a number of 32 bits.
        let [long_x, long_y, long_z] = [*x, *y, *z].map(f64::from);
        table += &format!("{long_x},{long_y},{long_z},7\n");
        text += &format!("{long_x} 7 {long_y} {long_z}\n");
        for (bytes, of) in [
            (&mut little, f32::to_le_bytes as fn(f32) -> [u8; 4]),
            (&mut big, f32::to_be_bytes),
        ] {
            bytes.extend(of(*x));
            bytes.push(7);
            bytes.extend(of(*y));
            bytes.extend(of(*z));
        }
    }
    let of_table = measured(folder.path(), "points.csv", table.as_bytes());
    for (name, bytes) in [
        ("text.ply", text.as_bytes()),
        ("little.ply", &little),
        ("big", &big),
    ] {
        assert_eq!(measured(folder.path(), name, bytes), of_table, "{name}");
    }
    let json: serde_json::Value = serde_json::from_str(&of_table).unwrap();
    let value = json["box_counting"]["value"].as_f64().unwrap();
    let error = json["box_counting"]["std_error"].as_f64().unwrap();
    assert!((value - 2.0).abs() < 2.0 * error + 0.05, "{value} {error}");
    assert!(json["lacunarity"].as_array().unwrap().len() > 3);
}

/// Layers of cubes about planes through a sponge: a carpet in its side, four cubes in each in its middle.
#[test]
fn slices_are_covered_by_layers() {
    let set = named("menger");
    let measured = |normal: DVec3, offset: f64| {
        let slice = set.slice(normal, offset).unwrap();
        BoxCounting::of_slice(&slice, Some(3.0), number(1), number(1))
    };
    for (normal, offset, parts) in [
        (DVec3::Z, 0.0, 8u64),
        (DVec3::Z, 0.5, 4),
        (-2.0 * DVec3::X, -1.0, 4),
        (DVec3::Y, 1.0, 8),
    ] {
        let counting = measured(normal, offset);
        for (level, it) in (1..).zip(&counting.boxes) {
            assert_eq!(it.count, parts.pow(level), "{normal} {offset}");
        }
        let dimension = (parts as f64).ln() / 3f64.ln();
        assert_is(&counting.estimate.unwrap(), dimension, 0.001);
    }
    let misses = set.slice(2.0 * DVec3::Z, 3.0).unwrap_err();
    assert!(
        misses[0].abs() < 1e-9 && (misses[1] - 2.0).abs() < 1e-9,
        "{misses:?}"
    );
}

#[test]
fn slices_have_squares_dimensions_of_all_orders_and_lacunarity() {
    let set = named("menger");
    // A face is Sierpinski's carpet, the middle a product of Cantor sets.
    for (offset, base) in [(0.0, 8), (0.5, 4)] {
        let slice = set.slice(DVec3::Z, offset).unwrap();
        let (squares, side) = slice.squares().unwrap();
        assert_eq!(squares.width(), 243);
        assert!((side - 1.0 / 243.0).abs() < 1e-9);
        assert_eq!(squares.count(), u64::pow(base, 5), "{offset}");
        let counting = BoxCounting::of_slice(&slice, None, number(1), number(1));
        let spectrum = Generalised::of_pixels(
            &squares,
            counting.estimate,
            &[1.0, 2.0],
            &Grid::spread(number(4)),
            number(1),
        );
        let expected = f64::from(u32::try_from(base).unwrap()).ln() / 3f64.ln();
        for it in spectrum {
            let estimate = it.estimate.unwrap();
            let off = (estimate.value - expected).abs();
            assert!(off < 2.0 * estimate.std_error, "{offset}: {estimate:?}");
        }
    }
}
