//! `kfrac dim --seeds`: dimensions over the random draws of several seeds.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::catalogue::Catalogue;
use crate::measure::Estimate;
use crate::saturating::real;

use super::super::Failure;
use super::{Arguments, Measured, input};

/// Measurements of a rule, each with the draws of a seed.
pub(super) struct Draws {
    name: String,
    draws: Vec<(u64, Measured)>,
}

/// Mean and standard deviation of the values of several draws.
struct Spread {
    count: usize,
    mean: f64,
    /// Standard deviation of one draw, with n − 1 degrees of freedom.
    deviation: f64,
}

/// Measures a rule with `count` seeds, from the one of the command line on.
pub(super) fn measure(
    arguments: &Arguments,
    catalogue: &Catalogue,
    count: u32,
) -> Result<Draws, Failure> {
    let loaded = arguments.rules().load(catalogue, arguments.json)?;
    let name = loaded.name.clone();
    let draw = |number: u32| {
        let seed = arguments.seed.saturating_add(number.into());
        let arguments = Arguments {
            seed,
            ..arguments.clone()
        };
        Ok((seed, input::of_rule(&arguments, loaded.clone())?))
    };
    let draws = (0..count).map(draw).collect::<Result<_, Failure>>()?;
    Ok(Draws { name, draws })
}

impl Spread {
    fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = values.collect();
        let count = values.len();
        if count < 2 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / real(count);
        let squares = values.iter().map(|value| (value - mean) * (value - mean));
        let deviation = (squares.sum::<f64>() / real(count - 1)).sqrt();
        Some(Self {
            count,
            mean,
            deviation,
        })
    }

    /// Returns the standard error of the mean.
    fn error(&self) -> f64 {
        self.deviation / real(self.count).sqrt()
    }

    fn json(&self) -> Value {
        json!({
            "draws": self.count,
            "mean": self.mean,
            "deviation": self.deviation,
            "std_error": self.error(),
        })
    }
}

impl Draws {
    fn estimates(&self) -> impl Iterator<Item = (u64, Option<&Estimate>)> {
        let draws = self.draws.iter();
        draws.map(|(seed, measured)| (*seed, measured.counting.estimate.as_ref()))
    }

    /// Returns the spread of the box-counting dimension.
    fn spread(&self) -> Option<Spread> {
        Spread::of(
            self.estimates()
                .filter_map(|(_, estimate)| Some(estimate?.value)),
        )
    }

    /// Returns the spread of every D_q but D_0, the box-counting dimension.
    fn spectrum(&self) -> Vec<(f64, Spread)> {
        let orders = self.draws.iter().map(|(_, measured)| &measured.spectrum);
        let orders = orders.max_by_key(|it| it.len()).into_iter().flatten();
        let orders = orders.map(|it| it.order).filter(|&order| order != 0.0);
        let spread = orders.filter_map(|order| {
            let of_order = self.draws.iter().filter_map(|(_, measured)| {
                let mut spectrum = measured.spectrum.iter();
                let own = spectrum.find(|it| it.order == order)?;
                Some(own.estimate.as_ref()?.value)
            });
            Some((order, Spread::of(of_order)?))
        });
        spread.collect()
    }

    /// Returns the warnings of all draws, each once, and one if nothing is drawn at random.
    fn warnings(&self) -> Vec<String> {
        let mut warnings: Vec<String> = Vec::new();
        for warning in self
            .draws
            .iter()
            .flat_map(|(_, measured)| &measured.warnings)
        {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        let counts = |measured: &Measured| -> Vec<u64> {
            measured.counting.boxes.iter().map(|it| it.count).collect()
        };
        let mut all = self.draws.iter().map(|(_, measured)| counts(measured));
        let first = all.next().unwrap_or_default();
        if !first.is_empty() && all.all(|other| other == first) {
            warnings
                .push("all seeds give the same counts: nothing seems to be drawn at random".into());
        }
        warnings
    }

    pub(super) fn json(&self) -> Value {
        let draws = self.estimates().map(|(seed, estimate)| {
            json!({
                "seed": seed,
                "value": estimate.map(|it| it.value),
                "std_error": estimate.map(|it| it.std_error),
                "range": estimate.map(|it| it.range),
            })
        });
        let spectrum = self.spectrum().into_iter().map(|(order, spread)| {
            let mut value = spread.json();
            value["q"] = json!(order);
            value
        });
        json!({
            "name": self.name,
            "draws": draws.collect::<Vec<_>>(),
            "box_counting": self.spread().as_ref().map(Spread::json),
            "spectrum": spectrum.collect::<Vec<_>>(),
            "warnings": self.warnings(),
        })
    }

    pub(super) fn described(&self) -> String {
        let mut text = format!("{:>20}  {:>10}  {:>8}\n", "seed", "dimension", "± 2 s.e.");
        // Writing to a string does not fail.
        for (seed, estimate) in self.estimates() {
            let _ = match estimate {
                Some(it) => writeln!(
                    text,
                    "{seed:>20}  {:>10.4}  {:>8.4}",
                    it.value,
                    2.0 * it.std_error
                ),
                None => writeln!(text, "{seed:>20}  {:>10}", "-"),
            };
        }
        let spectrum = self.spectrum();
        if !spectrum.is_empty() {
            let _ = writeln!(text, "\n{:>20}  {:>10}  {:>8}", "q", "mean D_q", "s.d.");
            for (order, spread) in spectrum {
                let _ = writeln!(
                    text,
                    "{order:>20}  {:>10.4}  {:>8.4}",
                    spread.mean, spread.deviation
                );
            }
        }
        let _ = match self.spread() {
            Some(spread) => writeln!(
                text,
                "\nThe mean box-counting dimension of {} draws is {:.4} ± {:.4} (2 standard errors), with a standard \
                 deviation of {:.4}.",
                spread.count,
                spread.mean,
                2.0 * spread.error(),
                spread.deviation,
            ),
            None => writeln!(text, "\nThe box-counting dimension could not be measured."),
        };
        for warning in self.warnings() {
            let _ = writeln!(text, "warning: {warning}");
        }
        text
    }
}
