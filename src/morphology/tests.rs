//! Morphology against definitions, pixel by pixel, and skeletons of shapes that are known.

use std::num::NonZero;

use proptest::prelude::*;

use super::*;
use crate::bits::Bits;
use crate::bits::tests::random_bits;

const ONE: NonZero<usize> = NonZero::<usize>::MIN;

fn threads(count: usize) -> NonZero<usize> {
    NonZero::new(count).unwrap()
}

/// Returns whether a vector lies in the disk r D.
fn is_in(disk: DiskFamily, size: f64, x: usize, y: usize) -> bool {
    let (x, y) = (x as f64, y as f64);
    match disk {
        DiskFamily::Plus => x + y <= size,
        DiskFamily::Square => x.max(y) <= size,
        DiskFamily::Octagon => x.max(y) <= 2.0 * size && x + y <= 3.0 * size,
        DiskFamily::Euclid => x * x + y * y <= size * size,
    }
}

/// Dilates pixel by pixel, with room on all sides.
fn dilated(bits: &Bits, disk: DiskFamily, size: f64) -> Bits {
    let set: Vec<_> = bits.set_boxes().collect();
    Bits::of(bits.width(), bits.height(), |column, row| {
        let near = |[x, y]: &[usize; 2]| is_in(disk, size, x.abs_diff(column), y.abs_diff(row));
        set.iter().any(near)
    })
}

fn eroded(bits: &Bits, disk: DiskFamily, size: f64) -> Bits {
    dilated(&bits.complement(), disk, size).complement()
}

fn roomy(bits: &Bits, margin: usize) -> Bits {
    let away = -margin.cast_signed();
    let (width, height) = (bits.width() + 2 * margin, bits.height() + 2 * margin);
    bits.window([away, away], width, height)
}

fn applied(text: &str, bits: &Bits, disk: DiskFamily) -> Bits {
    let sequence: Sequence = text.parse().unwrap();
    let result = sequence.apply(bits, disk, threads(3)).unwrap();
    assert_eq!(result, sequence.apply(bits, disk, ONE).unwrap());
    result
}

fn any_disk() -> impl Strategy<Value = DiskFamily> {
    prop::sample::select(DiskFamily::ALL.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn operations_are_those_of_the_plane(bits in random_bits(90, 40), disk in any_disk(), size in 0..4u32) {
        let margin = 24;
        let all = roomy(&bits, margin);
        let size = f64::from(size);
        let naive = |steps: &[fn(&Bits, DiskFamily, f64) -> Bits]| {
            let result = steps.iter().fold(all.clone(), |bits, step| step(&bits, disk, size));
            result.window([margin.cast_signed(); 2], bits.width(), bits.height())
        };
        for (name, steps) in [
            ("erode", &[eroded as fn(&Bits, DiskFamily, f64) -> Bits][..]),
            ("dilate", &[dilated]),
            ("open", &[eroded, dilated]),
            ("close", &[dilated, eroded]),
        ] {
            prop_assert_eq!(applied(&format!("{name}:{size}"), &bits, disk), naive(steps), "{}", name);
        }
    }

    #[test]
    fn a_radius_may_have_a_fraction(bits in random_bits(70, 40), size in 0.0..6.0f64) {
        let naive = dilated(&bits, DiskFamily::Euclid, size);
        prop_assert_eq!(applied(&format!("dilate:{size}"), &bits, DiskFamily::Euclid), naive);
    }

    #[test]
    fn a_skeleton_reconstructs_its_picture(bits in random_bits(140, 90), disk in any_disk()) {
        let Ok(subsets) = SkeletonSubsets::of(&bits, disk, ONE) else {
            prop_assert!(bits.is_empty());
            return Ok(());
        };
        prop_assert_eq!(subsets.reconstruction(), bits);
    }

    #[test]
    fn subsets_are_those_of_the_formula(bits in random_bits(36, 24)) {
        for disk in [DiskFamily::Plus, DiskFamily::Square, DiskFamily::Octagon] {
            let Ok(subsets) = SkeletonSubsets::of(&bits, disk, ONE) else { break };
            let all = roomy(&bits, 4);
            let mut found = Vec::new();
            for size in 0..60u32 {
                let mut inner = eroded(&all, disk, size.into());
                let opened = dilated(&eroded(&inner, disk, 1.0), disk, 1.0);
                if inner.is_empty() {
                    break;
                }
                inner.remove(&opened);
                found.extend(inner.set_boxes().map(|[column, row]| (column - 4, row - 4, size)));
            }
            let place = |it: &MaximalDisk| (it.column as usize, it.row as usize, it.size);
            let own: Vec<_> = subsets.disks().iter().map(place).collect();
            prop_assert_eq!(own, found);
        }
    }

    /// As many parts and holes as the picture, lines one pixel wide, and radii that are distances.
    #[test]
    fn a_connected_skeleton_has_the_topology_of_its_picture(bits in random_bits(70, 40)) {
        let Ok(skeleton) = Skeleton::of(&bits, &SkeletonOptions::default()) else {
            prop_assert!(bits.is_empty());
            return Ok(());
        };
        let several = SkeletonOptions { threads: threads(3), ..SkeletonOptions::default() };
        prop_assert_eq!(&skeleton, &Skeleton::of(&bits, &several).unwrap());
        let mut lines = Bits::new(bits.width(), bits.height());
        skeleton.points().for_each(|point| lines.set(point.column, point.row));
        let parts = |bits: &Bits| parts(&roomy(bits, 1), true);
        let holes = |bits: &Bits| self::parts(&roomy(bits, 1).complement(), false);
        prop_assert_eq!(parts(&lines), parts(&bits));
        prop_assert_eq!(holes(&lines), holes(&bits));
        let outside = roomy(&bits, 1).complement();
        for point in skeleton.points() {
            prop_assert!(bits.get(point.column, point.row));
            let squares = outside.set_boxes().map(|[column, row]| {
                let [x, y] = [column.abs_diff(point.column + 1), row.abs_diff(point.row + 1)];
                x * x + y * y
            });
            let nearest = (squares.min().unwrap() as f64).sqrt() - 0.5;
            prop_assert_eq!(nearest, point.radius);
        }
        for branch in skeleton.branches() {
            let [from, to] = branch.ends.map(|node| skeleton.nodes()[node].point);
            prop_assert_eq!(branch.points.first(), Some(&from));
            prop_assert_eq!(branch.points.last(), Some(&to));
            // Branches do not jump, within their nodes either.
            prop_assert!(branch.points.windows(2).all(|pair| pair[0].distance(&pair[1]) < 1.5));
        }
    }
}

/// Counts the connected parts of a set.
fn parts(bits: &Bits, with_corners: bool) -> usize {
    let mut left = bits.clone();
    let mut parts = 0;
    loop {
        let first = left.set_boxes().next();
        let Some(first) = first else { break parts };
        parts += 1;
        left.assign(first[0], first[1], false);
        let mut found = vec![first];
        while let Some([column, row]) = found.pop() {
            for [x, y] in (0..9).map(|side| [side % 3, side / 3]) {
                let is_corner = x != 1 && y != 1;
                let [Some(x), Some(y)] = [(column + x).checked_sub(1), (row + y).checked_sub(1)]
                else {
                    continue;
                };
                let is_inside = x < bits.width() && y < bits.height();
                if is_inside && (with_corners || !is_corner) && left.get(x, y) {
                    left.assign(x, y, false);
                    found.push([x, y]);
                }
            }
        }
    }
}

/// Returns the nodes as column, row, radius and number of branches.
fn nodes(bits: &Bits) -> Vec<(usize, usize, f64, usize)> {
    let skeleton = Skeleton::of(bits, &SkeletonOptions::default()).unwrap();
    let nodes = skeleton.nodes().iter();
    nodes
        .map(|node| {
            let point = node.point;
            (point.column, point.row, point.radius, node.branches.len())
        })
        .collect()
}

#[test]
fn skeletons_of_simple_shapes_are_known() {
    let disk = Bits::of(61, 61, |x, y| {
        x.abs_diff(30).pow(2) + y.abs_diff(30).pow(2) <= 400
    });
    assert_eq!(nodes(&disk), [(30, 30, 401f64.sqrt() - 0.5, 0)]);
    // A square has its diagonals.
    let square = Bits::of(61, 61, |x, y| {
        (10..51).contains(&x) && (10..51).contains(&y)
    });
    let corners = |right, bottom| [(11, 11), (right, 11), (11, bottom), (right, bottom)];
    let ends = |nodes: &[(usize, usize, f64, usize)]| {
        let ends = nodes.iter().filter(|node| node.3 == 1);
        ends.map(|&(x, y, radius, _)| {
            assert_eq!(radius, 1.5);
            (x, y)
        })
        .collect::<Vec<_>>()
    };
    let found = nodes(&square);
    assert_eq!(ends(&found), corners(49, 49));
    assert!(found.contains(&(30, 30, 20.5, 4)) && found.len() == 5);
    // The middle line of a rectangle ends where two bisectors of corners meet.
    let rectangle = Bits::of(90, 61, |x, y| {
        (10..81).contains(&x) && (10..51).contains(&y)
    });
    let found = nodes(&rectangle);
    assert_eq!(ends(&found), corners(79, 49));
    assert!(found.contains(&(30, 30, 20.5, 3)) && found.contains(&(60, 30, 20.5, 3)));
}

#[test]
fn thin_sets_are_their_own_skeletons() {
    let line = Bits::of(90, 9, |x, y| y == 4 && (4..80).contains(&x));
    assert_eq!(nodes(&line), [(4, 4, 0.5, 1), (79, 4, 0.5, 1)]);
    let column = Bits::of(9, 90, |x, y| (4..6).contains(&x) && (4..80).contains(&y));
    let found = nodes(&column);
    assert_eq!(found.len(), 2);
    assert!(found[1].1 - found[0].1 >= 73, "{found:?}");
    let pixel = Bits::of(1, 1, |_, _| true);
    assert_eq!(nodes(&pixel), [(0, 0, 0.5, 0)]);
    let ring = Bits::of(91, 91, |x, y| {
        let square = x.abs_diff(45).pow(2) + y.abs_diff(45).pow(2);
        (400..900).contains(&square)
    });
    let skeleton = Skeleton::of(&ring, &SkeletonOptions::default()).unwrap();
    let [branch] = skeleton.branches() else {
        panic!("a ring is a loop")
    };
    assert_eq!(branch.ends, [0, 0]);
    // A circle of radius 25, along pixels.
    assert!(
        (145.0..175.0).contains(&branch.length()),
        "{}",
        branch.length()
    );
}

/// Branch points that surround a hole are one node, from which a branch leads around it.
#[test]
fn holes_within_a_node_are_loops() {
    let rows = [
        "...#...", "...#...", "...#...", "###.###", "...#...", "...#...", "...#...",
    ];
    let cross = Bits::of(7, 7, |x, y| rows[y].as_bytes()[x] == b'#');
    let skeleton = Skeleton::of(&cross, &SkeletonOptions::default()).unwrap();
    let (nodes, branches) = (skeleton.nodes(), skeleton.branches());
    assert_eq!(branches.len() + 1 - nodes.len(), 1);
    let loops: Vec<_> = branches
        .iter()
        .filter(|it| it.ends[0] == it.ends[1])
        .collect();
    let [around] = loops[..] else {
        panic!("there is one hole, and {} loops", loops.len())
    };
    assert!((around.length() - 4.0 * 2f64.sqrt()).abs() < 1e-12);
    let listed = branches.iter().flat_map(|it| &it.points);
    let listed: std::collections::BTreeSet<_> = listed.map(|it| (it.column, it.row)).collect();
    assert_eq!(listed.len(), 12);
}

/// A disk larger than any picture leaves nothing.
#[test]
fn disks_of_any_size_erode() {
    let bits = Bits::of(7, 7, |x, y| x > 0 && y > 0);
    for size in ["3", "7.5", "1e9", "1.9e19", "1e300"] {
        let eroded = applied(&format!("erode:{size}"), &bits, DiskFamily::Euclid);
        assert!(eroded.is_empty(), "{size}");
    }
}

#[test]
fn larger_angles_leave_fewer_branches() {
    let square = Bits::of(41, 41, |_, _| true);
    let ends = |angle| {
        let options = SkeletonOptions {
            angle,
            ..SkeletonOptions::default()
        };
        let skeleton = Skeleton::of(&square, &options).unwrap();
        skeleton.nodes().iter().filter(|node| node.is_end()).count()
    };
    assert_eq!([80.0, 100.0].map(ends), [4, 1]);
}

#[test]
fn mistakes_have_remedies() {
    let message = |text: &str| text.parse::<Sequence>().unwrap_err().to_string();
    assert_eq!(
        message("blur:3"),
        "\"blur\" is no operation: write one of erode, dilate, open, close"
    );
    assert_eq!(
        message("open"),
        "open has no size: write open:3 for a disk of size 3"
    );
    assert_eq!(
        message("open:-1"),
        "open:-1: a size is a number of pixels, 0 or more"
    );
    assert!(message("open:1,").starts_with("an operation is missing"));
    let full = Bits::of(9, 9, |_, _| true);
    let apply = |text: &str, disk| {
        let sequence: Sequence = text.parse().unwrap();
        sequence
            .apply(&full, disk, ONE)
            .map_err(|error| error.to_string())
    };
    let message = apply("open:1.5", DiskFamily::Plus).unwrap_err();
    assert!(
        message.starts_with("open:1.5: the size of a plus is a whole number"),
        "{message}"
    );
    let message = apply("dilate:1e9", DiskFamily::Euclid).unwrap_err();
    assert!(message.contains("choose smaller disks"), "{message}");
    assert_eq!(
        apply("close:3, open:2", DiskFamily::Square),
        Ok(full.clone())
    );
    assert!(apply("erode:1e9", DiskFamily::Square).unwrap().is_empty());
    let sequence: Sequence = " open:3,close:2.5 ,erode:1".parse().unwrap();
    assert_eq!(sequence.to_string(), "open:3, close:2.5, erode:1");
}
