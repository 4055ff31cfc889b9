//! Tests of stamps of turned instances.

use super::super::tests::{FirstTile, Short, graph_of};
use super::*;
use crate::geometry::{Bounds, Solid};
use crate::style::Camera;

/// Greatest distance of a point from its place, in samples, before it is rounded to samples.
const AWAY: f64 = SAMPLES as f64 - std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn cells_are_near_to_what_they_stand_for() {
    let corners = Solid::cuboid(&Bounds::new(DVec3::splat(-0.5), DVec3::splat(0.5)));
    let (mut farthest, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    for number in 0..20_000 {
        let part = |step: u32| (f64::from(number) * 0.618_034 * f64::from(step)).fract() - 0.5;
        let turn = DQuat::from_xyzw(part(1), part(2), part(3), part(4));
        let size = 4.01 + (SIDE - 4.01) * (part(5) + 0.5);
        let sign = if number % 2 == 0 { size } else { -size };
        let linear = DMat3::from_quat(turn.normalize()) * sign;
        let cell = Cell::of(&linear, size, size, &least_sizes()).unwrap();
        let own = cell.turn() * cell.size();
        for corner in corners.corners() {
            let away = (own * *corner - linear * *corner).length();
            farthest = farthest.max(away);
            sum += away;
            count += 1.0;
        }
    }
    assert!(farthest < AWAY && sum < 1.5 * count, "{farthest}, {sum}");
}

/// Samples of copies have one of a similar depth within half a pixel of the exact picture. The other way, copies
/// close gaps that are finer than a pixel.
#[test]
fn copies_are_drawn_where_they_belong() {
    for text in [
        include_str!("../../../../library/ifs/lotus.yaml"),
        include_str!("../../../../library/ifs/romanesco.yaml"),
    ] {
        let graph = graph_of(text);
        let [exact, copied] = [Short::Exact, Short::Cut].map(|short| {
            let picture = (&Camera::default(), 64, SAMPLES as f64);
            FirstTile::draw(&graph, None, picture, short)
        });
        for (one, other, most) in [(&copied, &exact, 0.02), (&exact, &copied, 0.08)] {
            let (ink, share) = one.away_from(other, SAMPLES / 2);
            assert!(ink > 20_000 && share < most, "{share} of {ink}");
        }
        // Copies show elements that are hidden, too.
        assert!(copied.drawn > exact.drawn, "{}", copied.drawn);
    }
}
