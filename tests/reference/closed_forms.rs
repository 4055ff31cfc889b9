//! Counts, lengths and areas of approximant n in closed form.

use std::f64::consts::{PI, SQRT_2};

type Count = fn(u32) -> u64;
type Measure = fn(i32) -> f64;

/// Closed forms for a rule of the reference: its identifier, the number of elements, their total length, and
/// the area that its outlines enclose where all of them are closed.
pub(crate) type ClosedForm = (&'static str, Count, Measure, Option<Measure>);

fn sqrt3() -> f64 {
    3f64.sqrt()
}

fn phi() -> f64 {
    (1.0 + 5f64.sqrt()) / 2.0
}

/// Returns the area of a regular polygon of side 1.
fn polygon(corners: f64) -> f64 {
    corners / (4.0 * (PI / corners).tan())
}

/// Returns 1 + q + … + q^(n − 1).
fn sum(q: f64, n: i32) -> f64 {
    (0..n).map(|k| q.powi(k)).sum()
}

/// Returns the length of a tree whose two branches are q times as long as the side that they grow on, on a
/// trunk of two sides that are kept.
fn tree(q: f64, n: i32) -> f64 {
    q.powi(n) + 2.0 * sum(q, n)
}

fn tree_count(n: u32) -> u64 {
    3 * 2u64.pow(n) - 2
}

/// Closed forms of the reference. The area of a set of polygons is the sum of theirs, and that of the
/// self-seeding squares increases, for every side that seeds, by a square of side 1/3.
pub(crate) const CLOSED_FORMS: &[ClosedForm] = &[
    (
        "kaandorp_fig1_quadric_koch",
        |n| 4 * 8u64.pow(n),
        |n| 4.0 * 2f64.powi(n),
        Some(|_| 1.0),
    ),
    (
        "koch_quadric_18",
        |n| 4 * 18u64.pow(n),
        |n| 4.0 * 3f64.powi(n),
        Some(|_| 1.0),
    ),
    (
        "koch_quadric_32",
        |n| 4 * 32u64.pow(n),
        |n| 4.0 * 4f64.powi(n),
        Some(|_| 1.0),
    ),
    (
        "koch_quadratic_type1",
        |n| 4 * 5u64.pow(n),
        |n| 4.0 * (5.0 / 3f64).powi(n),
        Some(|n| 2.0 - (5.0 / 9f64).powi(n)),
    ),
    (
        "koch_snowflake",
        |n| 3 * 4u64.pow(n),
        |n| 3.0 * (4.0 / 3f64).powi(n),
        Some(|n| sqrt3() / 4.0 * (8.0 / 5.0 - 3.0 / 5.0 * (4.0 / 9f64).powi(n))),
    ),
    (
        "kaandorp_fig5_self_seeding_square",
        |n| 4 * 7u64.pow(n),
        |n| 4.0 * (7.0 / 3f64).powi(n),
        Some(|n| 1.0 + 4.0 / 9.0 * sum(7.0 / 9.0, n)),
    ),
    (
        "self_seeding_square_adjacent",
        |n| 4 * 7u64.pow(n),
        |n| 4.0 * (7.0 / 3f64).powi(n),
        Some(|n| 1.0 + 4.0 / 9.0 * sum(7.0 / 9.0, n)),
    ),
    (
        "kaandorp_fig3_simple_tree",
        tree_count,
        |n| tree(SQRT_2, n),
        None,
    ),
    (
        "simple_tree_asym_30",
        tree_count,
        |n| tree((1.0 + sqrt3()) / 2.0, n),
        None,
    ),
    ("simple_tree_345", tree_count, |n| tree(1.4, n), None),
    (
        "kaandorp_fig20_ramifying_r11_20",
        tree_count,
        |n| tree(1.1, n),
        None,
    ),
    (
        "kaandorp_fig20_ramifying_r3_5",
        tree_count,
        |n| tree(1.2, n),
        None,
    ),
    (
        "kaandorp_fig20_ramifying_r13_20",
        tree_count,
        |n| tree(1.3, n),
        None,
    ),
    (
        "kaandorp_fig20_ramifying_r7_10",
        tree_count,
        |n| tree(1.4, n),
        None,
    ),
    (
        "h_tree",
        |n| 2 * (2u64.pow(n + 1) - 1),
        |n| 2.0 * sum(SQRT_2, n + 1),
        None,
    ),
    (
        "binary_tree_60",
        |n| 2u64.pow(n + 1) - 1,
        |n| f64::from(n + 1),
        None,
    ),
    (
        "koch_curve",
        |n| 4u64.pow(n),
        |n| (4.0 / 3f64).powi(n),
        None,
    ),
    (
        "kaandorp_fig9_sierpinski_arrowhead",
        |n| 3u64.pow(n),
        |n| 1.5f64.powi(n),
        None,
    ),
    (
        "kaandorp_fig11_monkeys_tree",
        |n| 11u64.pow(n),
        |n| (2.0 + 5.0 / (3.0 * sqrt3())).powi(n),
        None,
    ),
    (
        "kaandorp_fig13_dragon_sweep",
        |n| 2u64.pow(n),
        |n| SQRT_2.powi(n),
        None,
    ),
    (
        "dragon_sweep_by_direction",
        |n| 2u64.pow(n),
        |n| SQRT_2.powi(n),
        None,
    ),
    ("levy_c", |n| 2u64.pow(n), |n| SQRT_2.powi(n), None),
    ("terdragon", |n| 3u64.pow(n), |n| sqrt3().powi(n), None),
    (
        "gosper_flowsnake",
        |n| 7u64.pow(n),
        |n| 7f64.sqrt().powi(n),
        None,
    ),
    ("hilbert", |n| 4u64.pow(n), |n| 2f64.powi(n), None),
    (
        "peano_9_mandelbrot",
        |n| 9u64.pow(n),
        |n| 3f64.powi(n),
        None,
    ),
    ("peano_switchback", |n| 9u64.pow(n), |n| 3f64.powi(n), None),
    (
        "snowflake_sweep_7",
        |n| 7u64.pow(n),
        |n| (2.0 + 1.0 / sqrt3()).powi(n),
        None,
    ),
    (
        "snowflake_sweep_13",
        |n| 13u64.pow(n),
        |n| (7.0 / 3.0 + 2.0 / sqrt3()).powi(n),
        None,
    ),
    (
        "cesaro_85",
        |n| 4u64.pow(n),
        |n| (2.0 / (1.0 + (85.0 * PI / 180.0).cos())).powi(n),
        None,
    ),
    (
        "cesaro_sweep_mandelbrot",
        |n| 2u64.pow(n),
        |n| (4.0 * PI / 17.0).cos().powi(-n),
        None,
    ),
    (
        "kaandorp_fig18_spiral",
        |n| u64::from(n) + 1,
        |n| (1.81 - 0.9 * sqrt3()).sqrt() * sum(0.9, n) + 0.9f64.powi(n),
        None,
    ),
    (
        "kaandorp_fig8_simple_base_element",
        |n| 4u64.pow(n),
        |n| (4.0 / 3f64).powi(n),
        Some(|n| polygon(3.0) * (4.0 / 9f64).powi(n)),
    ),
    (
        "kaandorp_fig12_disconnected_triangles",
        |n| 3u64.pow(n),
        |n| 1.5f64.powi(n),
        Some(|n| polygon(3.0) * 0.75f64.powi(n)),
    ),
    (
        "sierpinski_carpet",
        |n| 8u64.pow(n),
        |n| (8.0 / 3f64).powi(n),
        Some(|n| (8.0 / 9f64).powi(n)),
    ),
    (
        "vicsek_plus",
        |n| 5u64.pow(n),
        |n| (5.0 / 3f64).powi(n),
        Some(|n| (5.0 / 9f64).powi(n)),
    ),
    (
        "vicsek_saltire",
        |n| 5u64.pow(n),
        |n| (5.0 / 3f64).powi(n),
        Some(|n| (5.0 / 9f64).powi(n)),
    ),
    (
        "hexaflake",
        |n| 7u64.pow(n),
        |n| (7.0 / 3f64).powi(n),
        Some(|n| polygon(6.0) * (7.0 / 9f64).powi(n)),
    ),
    (
        "sierpinski_hexagon",
        |n| 6u64.pow(n),
        |n| 2f64.powi(n),
        Some(|n| polygon(6.0) * (2.0 / 3f64).powi(n)),
    ),
    (
        "pentaflake",
        |n| 6u64.pow(n),
        |n| (6.0 / phi().powi(2)).powi(n),
        Some(|n| polygon(5.0) * (6.0 / phi().powi(4)).powi(n)),
    ),
    (
        "sierpinski_pentagon",
        |n| 5u64.pow(n),
        |n| (5.0 / phi().powi(2)).powi(n),
        Some(|n| polygon(5.0) * (5.0 / phi().powi(4)).powi(n)),
    ),
    (
        "pythagoras_tree_squares",
        |n| 2u64.pow(n + 1) - 1,
        |n| sum(SQRT_2, n + 1),
        Some(|n| f64::from(n + 1)),
    ),
    (
        "t_square",
        |n| (4u64.pow(n + 1) - 1) / 3,
        |n| sum(2.0, n + 1),
        Some(|n| f64::from(n + 1)),
    ),
    // Each of the two sides has a triangle of 1/4 on its left at n = 1; later steps add and subtract equal
    // areas.
    (
        "twindragon",
        |n| 2 * 2u64.pow(n),
        |n| 2.0 * SQRT_2.powi(n),
        Some(|n| if n == 0 { 0.0 } else { 0.5 }),
    ),
];
