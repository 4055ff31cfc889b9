//! Tests of connectedness: closed forms, and one algorithm against the other.

use super::*;
use crate::geometry::{DMat2, DVec2};
use crate::ifs::{about, complex};

fn pair(s: DVec2) -> Vec<DAffine2> {
    let map = |t: f64| complex(s, DVec2::new(t, 0.0));
    [1.0, -1.0].map(map).into()
}

/// Determines the verdict by the descent for any maps.
fn by_pieces(maps: &[DAffine2], depth: u32) -> Connectedness {
    let mut budget = ConnectednessSearch::BUDGET;
    let centred = Centred::of(&Shrunk::of(maps).unwrap(), &mut budget).unwrap();
    let mut pieces = Pieces::default();
    bottleneck(
        maps.len(),
        |[i, j]| meet_by_theorem(&maps[i], &maps[j]),
        |pair| pieces.meeting(&centred, pair, depth, &mut budget),
    )
}

#[test]
fn both_descents_agree_on_pairs() {
    let mut search = ConnectednessSearch::new(16);
    let mut counts = [0; 3];
    for column in 0..40 {
        for row in 0..40 {
            let s = DVec2::new(f64::from(column) / 57.1, f64::from(row) / 57.3);
            let found = search.of(&pair(s));
            match by_pieces(&pair(s), 16) {
                // Octagons certify more than discs.
                Connectedness::NotCertified | Connectedness::Undecided => assert!(
                    [Connectedness::NotCertified, Connectedness::Disconnected(16)].contains(&found),
                    "{s}: {found:?}"
                ),
                by_pieces => assert_eq!(found, by_pieces, "{s}"),
            }
            match found {
                Connectedness::Disconnected(_) => counts[0] += 1,
                Connectedness::Connected => counts[1] += 1,
                Connectedness::NotCertified => counts[2] += 1,
                other => panic!("{s}: {other:?}"),
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
}

#[test]
fn gaskets_are_dust_below_one_half() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.3, 0.9], [1e3, 7.0]];
    let maps = |count: usize, ratio: f64| -> Vec<DAffine2> {
        let corners = corners[..count].iter();
        let linear = DMat2::from_diagonal(DVec2::splat(ratio));
        corners.map(|it| about(linear, (*it).into())).collect()
    };
    for count in 2..=4 {
        for ratio in [0.1, 0.3, 0.45, 0.49] {
            let found = ConnectednessSearch::new(32).of(&maps(count, ratio));
            assert!(
                matches!(found, Connectedness::Disconnected(_)),
                "{count} {ratio}: {found:?}"
            );
        }
        let found = ConnectednessSearch::new(32).of(&maps(count, 0.5));
        assert_eq!(found, Connectedness::Connected, "{count}");
    }
}

/// One piece that is apart from all others disconnects the attractor, whether these meet or not.
#[test]
fn one_distant_piece_disconnects_a_chain() {
    let third = |at: f64| complex(DVec2::new(1.0 / 3.0, 0.0), DVec2::new(at, 0.0));
    let search = |maps: &[DAffine2]| ConnectednessSearch::new(24).of(maps);
    let segment = [third(0.0), third(1.0 / 3.0), third(2.0 / 3.0)];
    assert_eq!(search(&segment), Connectedness::NotCertified);
    let more = [segment[0], segment[1], segment[2], third(3.0)];
    assert_eq!(search(&more), Connectedness::Disconnected(1));
}

#[test]
fn any_affine_maps_are_searched() {
    // A fern whose leaves touch, and maps that shrink only two by two.
    let matrix =
        |a: [f64; 4], t: [f64; 2]| DAffine2::from_cols_array(&[a[0], a[1], a[2], a[3], t[0], t[1]]);
    let fern = [
        matrix([0.0, 0.0, 0.0, 0.16], [0.0, 0.0]),
        matrix([0.85, -0.04, 0.04, 0.85], [0.0, 1.6]),
        matrix([0.2, 0.23, -0.26, 0.22], [0.0, 1.6]),
        matrix([-0.15, 0.26, 0.28, 0.24], [0.0, 0.44]),
    ];
    let mut search = ConnectednessSearch::new(24);
    assert_eq!(search.of(&fern), Connectedness::NotCertified);
    let leaves = [matrix([0.2, 0.23, -0.26, 0.22], [9.0, 1.6]), fern[3]];
    let found = search.of(&leaves);
    assert!(matches!(found, Connectedness::Disconnected(_)), "{found:?}");
    let sheared = [
        matrix([0.3, 1.5, 0.0, 0.3], [1.0, 0.0]),
        matrix([0.3, 1.4, 0.01, 0.3], [-1.0, 9.0]),
    ];
    let found = search.of(&sheared);
    assert!(matches!(found, Connectedness::Disconnected(_)), "{found:?}");
    let growing = [fern[1], matrix([1.0, 0.0, 0.0, 0.2], [0.0, 0.0])];
    assert_eq!(search.of(&growing), Connectedness::DoesNotContract);
    // Each contracts by itself, and one after the other does not.
    let diverging = [
        matrix([0.0, 0.0, 3.0, 0.0], [0.0, 0.0]),
        matrix([0.0, 3.0, 0.0, 0.0], [1.0, 0.0]),
    ];
    assert_eq!(search.of(&diverging), Connectedness::DoesNotContract);
}

#[test]
fn the_sum_of_two_ratios_is_not_rounded() {
    let pair = |r: f64, q: f64| {
        let map = |s: f64, t: f64| complex(DVec2::new(s, 0.0), DVec2::new(t, 0.0));
        ConnectednessSearch::new(60).of(&[map(r, 1.0), map(q, -1.0)])
    };
    assert_eq!(pair(0.5, 0.5), Connectedness::Connected);
    assert_eq!(pair(0.25, -0.75), Connectedness::Connected);
    assert_ne!(pair(0.5, 0.5_f64.next_down()), Connectedness::Connected);
}

#[test]
fn a_budget_ends_the_search() {
    // Inside the set, where the whole depth is searched.
    let maps = pair(DVec2::new(0.5, 0.49));
    let tiny = ConnectednessSearch::new(200).budget(10).of(&maps);
    assert_eq!(tiny, Connectedness::Undecided);
}
