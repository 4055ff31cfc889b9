//! Fits by the skeleton and by moments.

use kfrac::fit::{BranchPoints, Candidate, Disk, FitOptions, Method, Silhouette};
use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::about;
use kfrac::{Bits, fit};

/// Figures 5 and 6 of Libeskind-Hadas & Maragos (1987): the Koch island of circumradius 69, without a click.
#[test]
fn the_koch_island_is_found_by_its_skeleton() {
    const SIDE: usize = 150;
    const RADIUS: f64 = 69.0;
    let mut island: Vec<DVec2> = (0..3)
        .map(|corner| RADIUS * DVec2::from_angle((90.0 - 120.0 * f64::from(corner)).to_radians()))
        .collect();
    for _ in 0..5 {
        let sides = island.iter().zip(island.iter().cycle().skip(1));
        island = sides
            .flat_map(|(&from, &to)| {
                let third = (to - from) / 3.0;
                let tip = from + 1.5 * third + 0.75f64.sqrt() * third.perp();
                [from, from + third, tip, to - third]
            })
            .collect();
    }
    let middle = DVec2::splat(75.0);
    let is_inside = |column: usize, row: usize| {
        let point = DVec2::new(column as f64 + 0.5, 150.0 - row as f64 - 0.5) - middle;
        let sides = island.iter().zip(island.iter().cycle().skip(1));
        let crossed = sides.filter(|(from, to)| {
            (from.y <= point.y) != (to.y <= point.y)
                && point.x < from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x)
        });
        crossed.count() % 2 == 1
    };
    let shape = Silhouette::new(Bits::of(SIDE, SIDE, is_inside)).unwrap();
    let options = FitOptions::default().method(Method::Skeleton).similar(true);
    let found = fit(&shape, &options).unwrap();
    assert_eq!(found.candidate.maps.len(), 6);
    let mut places: Vec<usize> = Vec::new();
    for map in &found.candidate.maps {
        let ratio = map.matrix2.determinant().sqrt();
        assert!((ratio - 1.0 / 3.0).abs() <= 0.005, "{ratio}");
        let shift = map.transform_point2(middle) - middle;
        let near = |place: &usize| {
            let exact = 46.0 * DVec2::from_angle((30.0 + 60.0 * *place as f64).to_radians());
            shift.distance(exact) <= 0.01 * RADIUS
        };
        places.extend((0..6).find(near));
    }
    places.sort_unstable();
    assert_eq!(places, [0, 1, 2, 3, 4, 5]);
    let [disk] = found.candidate.disks[..] else {
        panic!("{:?}", found.candidate.disks)
    };
    assert!((disk.radius - 39.84).abs() <= 0.5, "{disk:?}");
    assert!(
        found.score.iou > 0.9 && found.bits_per_pixel(&shape) < 0.05,
        "{found:?}"
    );
    // A person points at two of the six, roughly.
    let points = BranchPoints {
        centre: Some(DVec2::new(74.0, 76.0)),
        branches: [[75.0, 122.0], [35.0, 98.0]].map(DVec2::from).into(),
    };
    let found = fit(&shape, &options.branch_points(points)).unwrap();
    let shifts = found
        .candidate
        .maps
        .iter()
        .map(|map| map.transform_point2(middle));
    let shifts: Vec<DVec2> = shifts.collect();
    assert!(
        shifts[0].distance(DVec2::new(75.0, 121.0)) < 0.7,
        "{shifts:?}"
    );
    assert!(
        shifts[1].distance(DVec2::new(35.16, 98.0)) < 0.7,
        "{shifts:?}"
    );
}

/// Algorithm 1 finds the angles of copies that are turned at random, but for few.
#[test]
fn algorithm_one_finds_angles() {
    let middle = DVec2::splat(80.0);
    let places = [
        (0.4, 10.0f64, 46.0),
        (0.36, 80.0, 44.0),
        (0.32, 150.0, 43.0),
    ];
    // Has another solution that is nearly as close.
    let ambiguous = [0.0, 71.79976912286777, 334.3089102906664];
    let golden = (5f64.sqrt() - 1.0) / 2.0;
    let spread = (1..30).map(|case| {
        [1, 2, 3].map(|copy| {
            360.0 * (f64::from(copy * case) * golden + f64::from(case * case) / 7.0).fract()
        })
    });
    let mut missed = Vec::new();
    for angles in spread.chain([ambiguous]) {
        let maps = places
            .into_iter()
            .zip(angles)
            .map(|((ratio, toward, away), angle)| {
                let matrix = DMat2::from_angle(angle.to_radians()) * ratio;
                let image = middle + away * DVec2::from_angle(toward.to_radians());
                DAffine2::from_mat2_translation(matrix, image - matrix * middle)
            });
        let candidate = Candidate {
            maps: maps.collect(),
            disks: vec![Disk {
                centre: middle,
                radius: 34.0,
            }],
        };
        let shape = Silhouette::new(candidate.attractor([160, 160], None).unwrap().pixels).unwrap();
        let points = BranchPoints {
            centre: Some(middle),
            branches: candidate
                .maps
                .iter()
                .map(|map| map.transform_point2(middle))
                .collect(),
        };
        let options = FitOptions::default().similar(true).branch_points(points);
        let found = fit(&shape, &options).unwrap();
        assert_eq!(found.method, Method::Skeleton);
        assert!(found.score.iou > 0.93, "{angles:?} {:?}", found.score);
        let turned_alike = found
            .candidate
            .maps
            .iter()
            .zip(&candidate.maps)
            .all(|(map, exact)| {
                let turn = map.matrix2 * exact.matrix2.inverse();
                let away = turn.x_axis.y.atan2(turn.x_axis.x).to_degrees().abs();
                let ratio = turn.determinant().abs().sqrt();
                away < 8.0 && (ratio - 1.0).abs() < 0.1
            });
        if !turned_alike {
            missed.push(angles);
        }
    }
    assert!(missed.len() <= 2, "{missed:?}");
}

/// The gasket with weights, as the mass of each pixel.
fn weighted(weights: [f64; 3]) -> (Bits, Vec<u8>) {
    let half = DMat2::from_diagonal(DVec2::splat(0.5));
    let corners = [(2.3, 2.2), (61.6, 2.2), (31.95, 53.555306)];
    let maps = corners.map(|(x, y)| about(half, DVec2::new(x, y)));
    let mut masses = vec![0.0; 64 * 56];
    let mut parts = vec![(DVec2::new(32.0, 20.0), 1.0, 0)];
    while let Some((point, mass, depth)) = parts.pop() {
        if depth == 9 {
            masses[(56.0 - point.y) as usize * 64 + point.x as usize] += mass;
            continue;
        }
        let next = maps.iter().zip(weights);
        parts.extend(
            next.map(|(map, weight)| (map.transform_point2(point), mass * weight, depth + 1)),
        );
    }
    let most = masses.iter().fold(0.0f64, |most, mass| most.max(*mass));
    let values: Vec<u8> = { masses.iter() }
        .map(|mass| (255.0 * mass / most).ceil() as u8)
        .collect();
    let bits = Bits::of(64, 56, |column, row| masses[row * 64 + column] > 0.0);
    (bits, values)
}

/// Weights of the maps are those of the picture, whose values are rounded.
#[test]
fn densities_are_found() {
    let weights = [0.45, 0.3, 0.25];
    let (bits, values) = weighted(weights);
    let shape = Silhouette::new(bits).unwrap().with_values(&values).unwrap();
    let options = FitOptions::default().maps(3..=3).similar(true).effort(2000);
    let found = fit(&shape, &options.method(Method::Collage)).unwrap();
    let density = found.density.as_ref().unwrap();
    let mut own = density.weights.clone();
    own.sort_by(|a, b| b.total_cmp(a));
    for (own, weight) in own.iter().zip(weights) {
        assert!((own - weight).abs() < 0.03, "{density:?}");
    }
    assert!(density.distance < 0.1, "{density:?}");
    let total: f64 = density.weights.iter().sum();
    assert!((total - 1.0).abs() < 1e-9);
}

#[test]
fn methods_are_compared() {
    let (bits, _) = weighted([1.0 / 3.0; 3]);
    let shape = Silhouette::new(bits).unwrap();
    let options = FitOptions::default().maps(3..=3).similar(true).effort(6000);
    let moments = fit(&shape, &options.clone().method(Method::Moments)).unwrap();
    assert_eq!(moments.method, Method::Moments);
    assert!(
        moments.score.iou > 0.35 && moments.others.is_empty(),
        "{moments:?}"
    );
    let found = fit(&shape, &options.disks(0)).unwrap();
    // An exact collage ends the search.
    assert!(found.exact != found.margin().is_some(), "{found:?}");
    assert!(found.description <= moments.description);
}

/// Figure 7 of Libeskind-Hadas & Maragos (1987): the maple leaf, without a click. Its maps are not identifiable.
#[test]
fn the_maple_leaf_is_found_by_its_skeleton() {
    let printed = [
        ([0.7, 0.7], 0.0, [2.0, 15.0]),
        ([0.4, 0.8], -0.92, [17.0, -8.0]),
        ([0.4, 0.7], 0.79, [-15.0, -7.0]),
    ];
    let maps = printed.map(|(factors, angle, shift)| {
        let matrix = DMat2::from_angle(angle) * DMat2::from_diagonal(DVec2::from(factors));
        DAffine2::from_mat2_translation(matrix, DVec2::from(shift))
    });
    let mut leaf = Candidate::of_maps(maps.into());
    leaf.disks.push(Disk {
        centre: DVec2::new(0.0, -3.0),
        radius: 20.0,
    });
    let place =
        DAffine2::from_scale_angle_translation(DVec2::splat(2.94), 0.0, DVec2::new(98.0, 91.0));
    let drawn = leaf.moved(&place).attractor([200, 200], None).unwrap();
    let shape = Silhouette::new(drawn.pixels).unwrap();
    let options = FitOptions::default().method(Method::Skeleton).maps(2..=3);
    let found = fit(&shape, &options).unwrap();
    assert!(
        found.score.iou > 0.9 && found.score.hausdorff < 16.0,
        "{found:?}"
    );
    assert_eq!(found.candidate.maps.len(), 3);
}
