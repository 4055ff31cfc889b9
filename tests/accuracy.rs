//! Measured dimensions against known ones: how far off they are, and how often their standard errors account for it.
//!
//! `KFRAC_POINTS=10000000` sets the number of points of a table, 100,000 by default.

#![expect(clippy::print_stdout, reason = "the table is what the test is run for")]

mod systems;

use std::num::NonZero;

use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::geometry::{Bounds, DAffine2, DVec2};
use kfrac::measure::exact::dimensions_of_graph;
use kfrac::measure::{Bits, BoxCounting, Estimate, Grid, LimitSet, Points};

use crate::common::{Draws, document, document_of};
use systems::Known;

const TWO: NonZero<usize> = NonZero::new(2).unwrap();

fn grids() -> Vec<Grid> {
    Grid::spread(NonZero::new(8).unwrap())
}

fn limit_set(system: &Known) -> LimitSet {
    let (model, _) = document_of(&system.text()).resolve(&[]).unwrap();
    LimitSet::of(&model.compile(3).unwrap()).unwrap()
}

/// Measures a system as a rule.
fn as_rule(system: &Known) -> Option<Estimate> {
    BoxCounting::of_limit(&limit_set(system), None, &grids(), TWO).estimate
}

/// Returns random points of a system.
fn points(system: &Known, count: usize) -> Vec<DVec2> {
    let total: f64 = system.weights.iter().sum();
    let mut draws = Draws(2026);
    let mut at = DVec2::ZERO;
    let mut next = || {
        let mut left = draws.unit() * total;
        let chosen = system.weights.iter().position(|weight| {
            left -= weight;
            left < 0.0
        });
        at = system.maps[chosen.unwrap_or(system.maps.len() - 1)].transform_point2(at);
        at
    };
    // The first points lie outside the set.
    for _ in 0..100 {
        next();
    }
    (0..count).map(|_| next()).collect()
}

/// Measures random points of a system, as a table of them.
fn as_points(system: &Known, count: usize) -> Option<Estimate> {
    let points = Points::<DAffine2>::new(points(system, count)).unwrap();
    let sample = points.sample(TWO, &grids(), TWO);
    BoxCounting::of_sample(&sample, 0.0).estimate
}

/// Measures a system as a picture of random points with 1000 pixels along the longer side.
fn as_raster(system: &Known) -> Option<Estimate> {
    const SIDE: f64 = 1000.0;
    const POINTS: usize = 1 << 20;
    let points = points(system, POINTS);
    let mut bounds = Bounds::EMPTY;
    points.iter().for_each(|&point| bounds.add(point));
    let pixel = bounds.size().max_element() * (1.0 + 1e-9) / SIDE;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "points lie in the picture"
    )]
    let whole = |at: f64| at as usize;
    let mut pixels = Bits::new(whole(SIDE), whole(SIDE));
    for point in points {
        let [column, row] = ((point - bounds.min()) / pixel).to_array().map(whole);
        pixels.set(column, row);
    }
    BoxCounting::of_pixels(&pixels, None, &grids(), TWO).estimate
}

/// Estimates beside the dimensions.
#[derive(Default)]
struct Row {
    name: &'static str,
    /// Error, and standard error, of each estimate.
    errors: Vec<[f64; 2]>,
    unmeasured: usize,
}

impl Row {
    fn of(name: &'static str, all: impl Iterator<Item = (String, Option<Estimate>, f64)>) -> Self {
        let mut row = Self {
            name,
            ..Self::default()
        };
        for (name, estimate, dimension) in all {
            let Some(estimate) = estimate else {
                println!("{:>8} {name}: not measured", row.name);
                row.unmeasured += 1;
                continue;
            };
            let Estimate {
                value, std_error, ..
            } = estimate;
            println!(
                "{:>8} {name}: {dimension:.5} {value:.5} ± {std_error:.5}",
                row.name
            );
            row.errors.push([value - dimension, std_error]);
        }
        row
    }

    /// Returns the share of estimates that are at most some standard errors off. Rounding is no error.
    fn coverage(&self, times: f64) -> f64 {
        const ROUNDING: f64 = 1e-9;
        let covered = self.errors.iter();
        let covered = covered.filter(|[off, error]| off.abs() <= times * error + ROUNDING);
        covered.count() as f64 / self.errors.len() as f64
    }

    fn bias(&self) -> f64 {
        self.errors.iter().map(|[off, _]| off).sum::<f64>() / self.errors.len() as f64
    }

    fn median(&self) -> f64 {
        let mut off: Vec<f64> = self.errors.iter().map(|[off, _]| off.abs()).collect();
        off.sort_by(f64::total_cmp);
        off[off.len() / 2]
    }

    fn print(&self) {
        println!(
            "| {} | {} | {:.0} % | {:.0} % | {:.0} % | {:+.4} | {:.4} |",
            self.name,
            self.errors.len(),
            100.0 * self.coverage(1.0),
            100.0 * self.coverage(2.0),
            100.0 * self.coverage(3.0),
            self.bias(),
            self.median()
        );
    }

    /// Checks the row: the median error, and the coverage by two and by three standard errors.
    fn hold(&self, median: f64, [by_two, by_three]: [f64; 2]) {
        assert!(self.unmeasured == 0, "{}", self.name);
        assert!(self.median() <= median, "{}: {}", self.name, self.median());
        let coverage = [2.0, 3.0].map(|times| self.coverage(times));
        assert!(
            coverage[0] >= by_two && coverage[1] >= by_three,
            "{}: {coverage:?}",
            self.name
        );
        // An error that is as large for all sets would be a mistake of the method.
        assert!(
            self.bias().abs() <= median,
            "{}: {}",
            self.name,
            self.bias()
        );
    }
}

/// Returns the entries of the library whose dimensions are decided exactly, with what is measured of them.
fn library() -> Vec<(String, Option<Estimate>, f64)> {
    let entries = Catalogue::embedded().entries().into_iter();
    let grown = entries.filter(|entry| Shelf::grown().contains(&entry.shelf));
    let measured = grown.filter_map(|entry| {
        let (model, _) = document(&entry.name).resolve(&[]).unwrap();
        let graph = match model.is_in_space() {
            true => return None,
            false => model.compile(12).ok()?,
        };
        let set = LimitSet::of(&graph).ok()?;
        let exact = dimensions_of_graph(&graph).dimensions?.hausdorff.value?;
        let counting = BoxCounting::of_limit(&set, None, &grids(), TWO);
        Some((entry.name, counting.estimate, exact))
    });
    measured.collect()
}

#[test]
fn measured_dimensions_are_known_ones_within_their_errors() {
    let count = std::env::var("KFRAC_POINTS").map_or(100_000, |text| text.parse().unwrap());
    let systems = systems::all();
    assert!(systems.len() >= 40);
    let of = |name, measure: &dyn Fn(&Known) -> Option<Estimate>| {
        let all = systems.iter();
        let all = all.map(|system| (system.name.clone(), measure(system), system.dimension));
        Row::of(name, all)
    };
    let rows = [
        Row::of("library", library().into_iter()),
        of("rules", &as_rule),
        of("points", &|system| as_points(system, count)),
        of("rasters", &as_raster),
    ];
    println!("| measured | sets | 1 standard error | 2 | 3 | bias | median error |");
    rows.iter().for_each(Row::print);
    let all = Row {
        name: "all",
        errors: rows.iter().flat_map(|row| row.errors.clone()).collect(),
        unmeasured: 0,
    };
    all.print();
    for (row, (median, coverage)) in rows.iter().zip([
        (0.003, [0.95, 0.98]),
        (0.005, [0.95, 0.98]),
        (0.005, [0.92, 0.95]),
        (0.04, [0.9, 0.93]),
    ]) {
        row.hold(median, coverage);
    }
}
